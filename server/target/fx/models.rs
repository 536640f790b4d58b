//! The models of the family.

use super::{ranges, special};
use crate::target::model::first_ranges;
use crate::target::{Limits, Model, Target};

/// FX1S: one compact unit, 30 inputs and outputs at most.
pub static FX1S: Target = Target {
    model: Model::Fx1s,
    name: "fx1s",
    title: "FX1S",
    devices: ranges::FX1S,
    first_ranges: first_ranges(ranges::FX1S),
    special: &special::FX1S,
    limits: Limits { steps: 2000, steps_at_most: 2000, ..LIMITS },
    symbols: None,
};

/// FX1N: compact unit that can be extended.
pub static FX1N: Target = Target {
    model: Model::Fx1n,
    name: "fx1n",
    title: "FX1N",
    devices: ranges::FX1N,
    first_ranges: first_ranges(ranges::FX1N),
    special: &special::FX1N,
    limits: Limits { steps: 8000, steps_at_most: 8000, ..LIMITS },
    symbols: None,
};

/// FX2N and FX2NC with the memory that is built in.
pub static FX2N: Target = Target {
    model: Model::Fx2n,
    name: "fx2n",
    title: "FX2N",
    devices: ranges::FX2N,
    first_ranges: first_ranges(ranges::FX2N),
    special: &special::FX2N,
    limits: Limits { steps: 8000, steps_at_most: 16_000, ..LIMITS },
    symbols: None,
};

/// FX3U and FX3UC.
pub static FX3U: Target = Target {
    model: Model::Fx3u,
    name: "fx3u",
    title: "FX3U",
    devices: ranges::FX3U,
    first_ranges: first_ranges(ranges::FX3U),
    special: &special::FX3U,
    limits: Limits { steps: 64_000, steps_at_most: 64_000, ..LIMITS },
    symbols: None,
};

/// What all models of the family have in common; only the memory differs.
const LIMITS: Limits = Limits {
    steps: 0,
    steps_at_most: 0,
    contacts_in_series: 11,
    rows: 24,
    blocks: 8,
    branches: 11,
    master_controls: 8,
    loops: 5,
    calls: 5,
};
