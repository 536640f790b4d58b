//! Which data registers a program uses two by two, as numbers of 32 bits, and which alone.

use super::super::source::{self, Program};
use super::{Work, device_at, pair_at};
use crate::document::{DeclaredType, Document, Scopes, Variable};
use crate::il::iec::SectionKind;
use crate::logic::{Action, Deed, Expression, Path, Term, Test};
use crate::target::iec::ElementaryType;
use crate::target::{Constant, Device, DeviceKind, Form, Operand, Target};
use rustc_hash::{FxHashMap, FxHashSet};

/// What the data registers of a program are used as.
#[derive(Default, Debug)]
pub(super) struct Registers {
    uses: FxHashMap<u32, Use>,
    /// Those that are used in several ways.
    torn: FxHashSet<u32>,
    /// Whether something is said to drive M8024, which turns the direction of BMOV.
    pub turns_blocks: bool,
}

/// What a register is used as.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Use {
    /// A word of 16 bits.
    Alone,
    /// One half of the 32 bits that begin with the register of this number.
    Pair(u32),
}

/// How many devices an operand covers, and how.
#[derive(Clone, Copy)]
enum Extent {
    Words(u32),
    Pairs(u32),
}

impl Registers {
    /// Those of a program of the FX family. Of a part the whole is asked where it matters.
    pub fn of_devices(document: &Document, program: &Program, is_whole: bool) -> Registers {
        let mut registers = Registers::default();
        let paths = |program: &Program, registers: &mut Registers| {
            program.rungs.iter().filter_map(|source| source.path()).for_each(|path| registers.path(path));
        };
        paths(program, &mut registers);
        let has_blocks = || {
            let actions = program.rungs.iter().filter_map(|source| source.path()).flat_map(Path::actions);
            actions.into_iter().any(|action| work(action).is_some_and(|(work, _)| work == Work::Block))
        };
        let has_pairs = registers.uses.values().any(|own| matches!(own, Use::Pair(_)));
        if !is_whole && (has_pairs || has_blocks()) {
            paths(&source::program(document, None), &mut registers);
        }
        registers
    }

    /// Those that stand for the variables of a program of IEC 61131-3.
    pub fn of_variables(scopes: &Scopes, program: &Program, target: &Target) -> Registers {
        let mut registers = Registers::default();
        let own = scopes.own_pous().iter().flat_map(|pou| &pou.variables);
        own.chain(scopes.globals.values()).for_each(|variable| registers.variable(variable, target));
        for term in program.rungs.iter().filter_map(|source| source.path()).flat_map(Path::terms) {
            if let Operand::Direct(address) = term.operand {
                registers.place(device_at(address), pair_at(address));
            }
        }
        registers
    }

    /// Whether the register of this number and the next one are nothing but 32 bits.
    pub fn is_pair(&self, first: u32) -> bool {
        [first, first + 1].iter().all(|register| {
            self.uses.get(register) == Some(&Use::Pair(first)) && !self.torn.contains(register)
        })
    }

    /// Whether a register is, or may be, one half of 32 bits.
    pub fn is_half(&self, register: u32) -> bool {
        matches!(self.uses.get(&register), Some(Use::Pair(_))) || self.torn.contains(&register)
    }

    fn note(&mut self, register: u32, usage: Use) {
        if *self.uses.entry(register).or_insert(usage) != usage {
            self.torn.insert(register);
        }
    }

    fn pair(&mut self, first: u32) {
        self.note(first, Use::Pair(first));
        self.note(first + 1, Use::Pair(first));
    }

    fn place(&mut self, word: Option<Device>, pair: Option<Device>) {
        if let Some(word) = word.filter(|device| device.kind == DeviceKind::D) {
            self.note(word.number, Use::Alone);
        }
        if let Some(first) = pair {
            self.pair(first.number);
        }
    }

    fn variable(&mut self, variable: &Variable, target: &Target) {
        use ElementaryType::{Dint, Dword, Udint};
        if let Some(address) = variable.address {
            return self.place(device_at(address), pair_at(address));
        }
        let Operand::Device(device) = Operand::read(&variable.name, target.model) else { return };
        if device.kind != DeviceKind::D || variable.section != SectionKind::Local {
            return;
        }
        match variable.declared {
            DeclaredType::Elementary(Dint | Udint | Dword) => self.pair(device.number),
            _ => self.note(device.number, Use::Alone),
        }
    }

    fn path(&mut self, path: &Path) {
        let registers = std::cell::RefCell::new(self);
        path.visit(&mut |action| registers.borrow_mut().action(action), &mut |expression: &Expression| {
            expression.visit(&mut |contact| {
                let wide = matches!(contact.test, Test::Compare(operator) if operator.is_wide());
                let extent = if wide { Extent::Pairs(1) } else { Extent::Words(1) };
                contact.terms.iter().for_each(|term| registers.borrow_mut().term(term, extent));
            });
        });
    }

    fn action(&mut self, action: &Action) {
        let is_direction = |term: &Term| term.operand == Operand::Device(Device::new(DeviceKind::M, 8024));
        self.turns_blocks |= action.changes().iter().any(|term| is_direction(term));
        let Some((work, form)) = work(action) else {
            // The preset of a counter of 32 bits has as many.
            let counts_wide =
                action.terms.first().and_then(|term| term.operand.device()).is_some_and(is_wide_counter);
            let wide = counts_wide || matches!(action.deed, Deed::Instruction(form) if form.wide);
            let extent = if wide { Extent::Pairs(1) } else { Extent::Words(1) };
            return action.terms.iter().for_each(|term| self.term(term, extent));
        };
        let count = action.terms.get(2).and_then(whole).unwrap_or(1);
        for (place, term) in action.terms.iter().enumerate() {
            let count = match (work, place) {
                (Work::Multiply, 2) if !form.wide => {
                    self.term(term, Extent::Pairs(1));
                    continue;
                }
                (Work::Multiply | Work::Divide, 2) => 2,
                (Work::Fill, 1) | (Work::Block, 0 | 1) => count,
                // What lies between is whatever others make of it.
                (Work::Clear, _) => continue,
                _ => 1,
            };
            self.term(term, if form.wide { Extent::Pairs(count) } else { Extent::Words(count) });
        }
    }

    fn term(&mut self, term: &Term, extent: Extent) {
        let device = match term.operand {
            Operand::Device(device) | Operand::Indexed { device, .. } => device,
            Operand::WordBit { word, .. } => word,
            _ => return,
        };
        if device.kind != DeviceKind::D || device.is_special() {
            return;
        }
        match extent {
            Extent::Words(count) => (0..count).for_each(|more| self.note(device.number + more, Use::Alone)),
            Extent::Pairs(count) => (0..count).for_each(|more| self.pair(device.number + 2 * more)),
        }
    }
}

/// What an action is that has another form there.
fn work(action: &Action) -> Option<(Work, Form)> {
    match action.deed {
        Deed::Instruction(form) => Work::of(form).map(|work| (work, form)),
        _ => None,
    }
}

/// Whether it counts up and down in 32 bits.
pub(super) fn is_wide_counter(device: Device) -> bool {
    device.kind == DeviceKind::C && device.number >= 200
}

/// How many a constant says, as far as anybody counts.
fn whole(term: &Term) -> Option<u32> {
    match term.operand {
        Operand::Constant { value: Constant::Decimal(value), index: None } => {
            u32::try_from(value).ok().map(|count| count.min(512))
        }
        _ => None,
    }
}
