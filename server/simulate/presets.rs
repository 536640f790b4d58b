//! The timers and counters of a program with the presets that their coils have.

use super::code::{Code, Op, Preset};
use super::layout::Layout;
use super::row::Cell;
use crate::target::Device;

/// A timer or counter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Counted {
    /// Which.
    pub device: Device,
    /// Its preset; nothing if an instruction finds it while the program runs.
    pub preset: Option<CountedPreset>,
    /// What a timer counts, in milliseconds.
    pub unit_ms: Option<u32>,
}

/// Where a preset is from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CountedPreset {
    /// It stands in the program, in units.
    Constant(i64),
    /// A register has it.
    Register(Device),
}

impl Code {
    /// The timers and counters whose coils the program has, in its order; one with several coils as often.
    pub fn counted(&self) -> Vec<Counted> {
        let layout = &self.layout;
        let counted = |contact: Cell, preset: Preset, unit_ms| {
            let device = layout.device_of_cell(contact)?;
            Some(Counted { device, preset: preset.named(layout), unit_ms })
        };
        let found = self.ops.iter().filter_map(|op| match op {
            Op::Timer { timer, .. } => counted(timer.contact, timer.preset, Some(timer.unit_ms)),
            Op::Counter { counter, .. } | Op::HighSpeed { counter, .. } => {
                counted(counter.contact, counter.preset, None)
            }
            _ => None,
        });
        found.collect()
    }
}

impl Preset {
    fn named(self, layout: &Layout) -> Option<CountedPreset> {
        match self {
            Preset::Constant(value) => Some(CountedPreset::Constant(value)),
            Preset::Word(slot) | Preset::Pair(slot, _) => {
                layout.device_of_slot(slot).map(CountedPreset::Register)
            }
        }
    }
}
