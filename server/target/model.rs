//! The PLC models, with their device ranges and limits.

use super::{DeviceKind, DeviceRange, SpecialDevice, Symbols};
use std::sync::Arc;

/// A PLC model, or the vendor-neutral language of IEC 61131-3.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Model {
    /// FX1S: 2,000 steps.
    Fx1s,
    /// FX1N: 8,000 steps.
    Fx1n,
    /// FX2N and FX2NC: 8,000 steps, 16,000 with a cassette.
    Fx2n,
    /// FX3U and FX3UC: 64,000 steps.
    Fx3u,
    /// IEC 61131-3 without a maker's devices.
    Iec,
}

/// What a program is written for: one of the rows of [`Target::ALL`].
#[derive(Debug)]
pub struct Target {
    /// The model.
    pub model: Model,
    /// The name in `rungwise.toml` and on the command line: `fx2n`, `iec`.
    pub name: &'static str,
    /// The name that people use: `FX2N`.
    pub title: &'static str,
    /// The ranges of each device kind, in reading order; empty for `iec`.
    pub devices: &'static [DeviceRange],
    /// Where the ranges of each device kind begin among `devices`, and behind the last kind where they end.
    pub(super) first_ranges: FirstRanges,
    /// The special relays and registers (M8000…, D8000…), sorted by device.
    pub special: &'static [SpecialDevice],
    /// The limits of programs.
    pub limits: Limits,
    /// The names that a project gives to devices; `None` in the rows of [`Target::ALL`].
    pub symbols: Option<Arc<Symbols>>,
}

/// The limits of programs for a model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Program steps that fit; 0 where the notion has no meaning.
    pub steps: u32,
    /// Program steps that fit with the largest memory cassette.
    pub steps_at_most: u32,
    /// Contacts in series that the maker's tool can show in one line, without the output.
    pub contacts_in_series: u32,
    /// Rows of a rung that the maker's tool can show.
    pub rows: u32,
    /// LD blocks that may wait for ANB or ORB.
    pub blocks: u32,
    /// MPS levels.
    pub branches: u32,
    /// Master control levels.
    pub master_controls: u32,
    /// FOR levels.
    pub loops: u32,
    /// CALL levels.
    pub calls: u32,
}

impl Target {
    /// The target called `name`, letter case aside.
    pub fn named(name: &str) -> Option<&'static Target> {
        Target::ALL.iter().copied().find(|target| target.name.eq_ignore_ascii_case(name))
    }

    /// The target for `model`.
    pub fn of(model: Model) -> &'static Target {
        match model {
            Model::Fx1s => &super::fx::FX1S,
            Model::Fx1n => &super::fx::FX1N,
            Model::Fx2n => &super::fx::FX2N,
            Model::Fx3u => &super::fx::FX3U,
            Model::Iec => &IEC,
        }
    }

    /// All targets.
    pub const ALL: [&'static Target; 5] =
        [&super::fx::FX1S, &super::fx::FX1N, &super::fx::FX2N, &super::fx::FX3U, &IEC];

    /// Whether programs use the FX family's devices and instructions.
    pub fn is_fx(&self) -> bool {
        self.model != Model::Iec
    }

    /// Whether both are of the FX family, or both of IEC 61131-3, so that programs have the same words.
    pub fn is_kin_of(&self, other: &Target) -> bool {
        self.is_fx() == other.is_fx()
    }

    /// The ranges of `kind` on this target; empty if it has no such device.
    pub fn ranges(&self, kind: DeviceKind) -> impl Iterator<Item = &'static DeviceRange> {
        let first = usize::from(self.first_ranges[kind as usize]);
        let end = usize::from(self.first_ranges[kind as usize + 1]);
        self.devices.get(first..end).unwrap_or_default().iter()
    }
}

/// A place among the ranges for each device kind, and one for the end.
pub(super) type FirstRanges = [u8; DeviceKind::ALL.len() + 1];

/// Where the ranges of each kind begin, as every operand of a program is looked up there. They are in reading order.
pub(super) const fn first_ranges(devices: &[DeviceRange]) -> FirstRanges {
    let mut first = [0; DeviceKind::ALL.len() + 1];
    let mut place = 0;
    while place < devices.len() {
        let mut later = devices[place].kind as usize + 1;
        assert!(place == 0 || later > devices[place - 1].kind as usize, "the ranges are in reading order");
        place += 1;
        while later < first.len() {
            first[later] = place as u8;
            later += 1;
        }
    }
    first
}

/// IEC 61131-3: no maker's devices, and no limits but those of a screen.
static IEC: Target = Target {
    model: Model::Iec,
    name: "iec",
    title: "IEC 61131-3",
    devices: &[],
    first_ranges: first_ranges(&[]),
    special: &[],
    limits: Limits {
        steps: 0,
        steps_at_most: 0,
        contacts_in_series: 11,
        rows: 24,
        blocks: 8,
        branches: 11,
        master_controls: 8,
        loops: 5,
        calls: 5,
    },
    symbols: None,
};
