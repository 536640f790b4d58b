//! Program sense: what reads like a program and does something else than its author meant.

use super::Rule;

mod uses;
pub(super) use uses::{Key, Name, Use, Uses};

mod regions;
pub(super) use regions::{Region, Regions};

mod rungs;

mod free;

mod coils;

mod double_coil;

mod coil_and_set_reset;

mod relays;
pub(super) use relays::is_general;

mod set_without_reset;

mod reset_without_set;

mod read_before_write;

mod read_never_written;

mod written_never_read;

mod again;

mod reused_timer;

mod reused_counter;

mod overlapping_words;

mod unreachable_code;

mod edge_in_skipped_code;

mod latched_range;

mod special_device_written;

mod program_too_large;
pub(super) use program_too_large::WITH_CASSETTE;

mod unused_suppression;
pub(super) use unused_suppression::unused;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[
    &double_coil::RULE,
    &coil_and_set_reset::RULE,
    &set_without_reset::RULE,
    &reset_without_set::RULE,
    &read_before_write::RULE,
    &read_never_written::RULE,
    &written_never_read::RULE,
    &reused_timer::RULE,
    &reused_counter::RULE,
    &overlapping_words::RULE,
    &unreachable_code::RULE,
    &edge_in_skipped_code::RULE,
    &latched_range::RULE,
    &special_device_written::RULE,
    &program_too_large::RULE,
    &unused_suppression::RULE,
];
