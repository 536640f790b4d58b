//! Which of the places that drive a device undo each other.

use super::Regions;
use super::uses::{Key, Name, Use, Uses};
use crate::check::ProgramContext;
use crate::document::{Act, DeclaredType};
use crate::il::iec::SectionKind;
use crate::target::iec::ElementaryType;
use crate::target::{DeviceKind, Location, Width};

/// So many places are compared with each one. A device that is driven more often is told of well enough.
const COMPARED: usize = 16;

/// What drives relays and outputs.
pub(super) struct Coils<'c, 'a> {
    uses: &'c Uses<'a>,
    regions: &'c Regions,
}

/// A relay or an output with all that is done with it, in the order of execution.
pub(super) struct Driven {
    /// Everything.
    pub all: Vec<Use>,
    /// How often it is read before each of them, and before the end.
    reads: Vec<u32>,
    /// Whether what it is at the end of the scan goes out of the program.
    is_output: bool,
}

impl Driven {
    fn new(all: Vec<Use>, is_output: bool) -> Driven {
        let mut reads = vec![0; all.len() + 1];
        for (place, one) in all.iter().enumerate() {
            reads[place + 1] = reads[place] + u32::from(one.access.act.reads());
        }
        Driven { all, reads, is_output }
    }

    /// Whether something reads what `all[one]` writes before `all[other]` writes again.
    pub fn is_read_between(&self, one: usize, other: usize) -> bool {
        self.reads[other] > self.reads[one + 1]
    }
}

impl<'c, 'a> Coils<'c, 'a> {
    pub fn of(context: &'c ProgramContext<'a>) -> Coils<'c, 'a> {
        Coils { uses: context.uses(), regions: context.regions() }
    }

    /// The relays and outputs with which something of `acts` is done, and of `others` if there are any, in two places
    /// at least that are `wanted`.
    pub fn driven(
        &self,
        acts: &'static [Act],
        others: &'static [Act],
        wanted: impl Fn(&Use) -> bool,
    ) -> impl Iterator<Item = Driven> {
        self.uses.names().filter_map(move |(number, name)| {
            let done = self.uses.acts(number);
            let may_be = done.has(acts) && (others.is_empty() || done.has(others));
            let is_many = || self.uses.of_name(number).filter(|one| wanted(one)).take(2).count() == 2;
            (may_be && is_many() && self.is_relay(number, name))
                .then(|| Driven::new(self.uses.of_name(number).collect(), is_output(name)))
        })
    }

    /// Whether it is one bit that coils drive. Timers and counters are more than that, and OUT of a step is a transfer.
    fn is_relay(&self, number: u32, name: &Name<'_>) -> bool {
        match name.key {
            Key::Device(device) => match device.kind {
                DeviceKind::Y | DeviceKind::M => true,
                DeviceKind::S => !self.regions.has_steps,
                _ => false,
            },
            Key::Direct(address) => address.width == Width::Bit,
            Key::Global(_) | Key::Local(..) => match name.variable {
                Some(variable) => variable.declared == DeclaredType::Elementary(ElementaryType::Bool),
                // In a drawing without declarations the coil says it.
                None => self.uses.of_name(number).all(|one| !self.uses.is_list(&one)),
            },
        }
    }

    /// Whether what `driven.all[one]` writes is undone by `driven.all[other]`, which comes later, before it matters.
    fn undoes(&self, driven: &Driven, one: usize, other: usize) -> bool {
        let (first, second) = (&driven.all[one], &driven.all[other]);
        if self.regions.are_apart(first, second) {
            return false;
        }
        if self.uses.is_fx {
            return true;
        }
        // In Instruction List of IEC 61131-3 a variable is often used for one result after another, and given a value
        // that a later statement may change.
        let is_read = driven.is_read_between(one, other);
        !self.regions.may_skip(second, first) && (driven.is_output || !is_read)
    }

    /// The last of `later`, places in `driven.all`, that undoes what `one` writes.
    pub fn undone_by(&self, driven: &Driven, one: usize, later: &[usize]) -> Option<usize> {
        let from_the_end = later.iter().rev().take(COMPARED);
        let next = later.iter().take(COMPARED);
        from_the_end.chain(next).copied().find(|other| *other > one && self.undoes(driven, one, *other))
    }

    /// The last of `earlier` that undoes in the next scan what `one` writes. In IEC 61131-3 that is the way in which a
    /// default is written, and nothing to tell of.
    pub fn undoing_before(&self, driven: &Driven, one: usize, earlier: &[usize]) -> Option<usize> {
        let mut last = earlier.iter().rev().take(COMPARED).copied();
        let apart = |other: usize| self.regions.are_apart(&driven.all[other], &driven.all[one]);
        last.find(|other| self.uses.is_fx && !apart(*other))
    }
}

fn is_output(name: &Name<'_>) -> bool {
    match name.key {
        Key::Device(device) => device.kind == DeviceKind::Y,
        Key::Direct(address) => address.location == Location::Output,
        Key::Global(_) | Key::Local(..) => {
            name.variable.is_some_and(|variable| variable.section == SectionKind::Output)
        }
    }
}
