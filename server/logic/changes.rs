//! What the events of a run may have changed, and what is known of the rest.

use super::formula::Step;
use super::{Action, Deed, Formula, Formulas, Storage, Term, wholes};
use crate::target::{Access, Device, DeviceKind, Extent, Flow, Form, Location, Operand};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, ToSmolStr};

/// One for each kind of device, one for variables, one for each area of addresses, and one for variables that may lie
/// anywhere.
const KINDS: usize = DeviceKind::ALL.len() + 5;
const VARIABLES: usize = DeviceKind::ALL.len();
const ANYWHERE: usize = KINDS - 1;
/// The index registers.
const INDEX: [usize; 2] = [DeviceKind::V as usize, DeviceKind::Z as usize];
/// A row of registers that is longer counts as all of its kind.
const ROW_MAX: u16 = 64;

/// The last event that may have changed something, for everything. Events are counted from 1, and 0 is none.
#[derive(Debug, Default)]
pub(super) struct Changes {
    events: u32,
    /// The last event that may have changed what has this key; for registers, each in a row that was written.
    named: FxHashMap<SmolStr, u32>,
    /// The last event that may have changed any device of a kind; the last places are for variables.
    kinds: [u32; KINDS],
    /// The last step that changed anything of a kind: what words made of such bits depend on.
    touched: [u32; KINDS],
    /// What has parts that were driven.
    parted: FxHashSet<SmolStr>,
    /// The last event that may have set special relays: flags of arithmetic and of completion.
    flags: u32,
    /// The last event that may have changed whatever is no plain variable of the own program unit.
    known: u32,
    /// Whether states are relays like others, as in a program without steps.
    has_plain_states: bool,
}

impl Changes {
    /// Nothing has changed yet in a program without steps, in which states are relays like others.
    pub fn without_steps() -> Changes {
        Changes { has_plain_states: true, ..Changes::default() }
    }

    /// How many events there were.
    pub fn events(&self) -> u32 {
        self.events
    }

    /// An action happens of which nobody knows what it leaves behind.
    pub fn event(&mut self, action: &Action, formulas: &mut Formulas) {
        self.events += 1;
        self.change(action, formulas);
    }

    /// Something happens that nobody can read, and that may change anything.
    pub fn unread(&mut self, formulas: &mut Formulas) {
        self.events += 1;
        self.change_all(formulas);
    }

    /// Time passes, in which the CPU may change the special relays that it owns.
    pub fn pause(&mut self) {
        self.events += 1;
        self.flags = self.events;
    }

    /// A bit by itself is driven: to `value`, where steps of different runs are not known to be the same.
    pub fn drive(&mut self, term: &Term, value: Option<Formula>, formulas: &mut Formulas) {
        let (key, place) = (term.key(), slot(term));
        self.parted.extend(wholes(&key).map(SmolStr::from));
        // A variable in a place of its own is part of no word. An element may be read by a subscript that varies.
        let is_element = term.is_element();
        for slot in [place, ANYWHERE].into_iter().filter(|slot| *slot != VARIABLES || is_element) {
            let before = self.touched[slot];
            self.touched[slot] = formulas.step(Step::Driven { before, key: key.clone(), value });
        }
    }

    /// The step that may have changed `term` last, whose key is `name`.
    pub fn since(&self, term: &Term, name: &SmolStr, formulas: &mut Formulas) -> u32 {
        // Words are made of bits, bits of words: whatever wrote to the kind counts.
        let is_apart = self.is_apart(term) || term.is_own_part();
        match is_apart && !self.parted.contains(name) {
            true => after(self.last(term, name), formulas),
            false if leads_anywhere(term) => self.since_any(),
            false => self.touched[slot(term)],
        }
    }

    /// The same of the value of 32 bits that begins there.
    pub fn since_pair(&self, term: &Term, name: &SmolStr, formulas: &mut Formulas) -> u32 {
        match term.operand {
            Operand::Device(device) if self.is_apart(term) => {
                let upper =
                    Term::of_device(Device { number: device.number.saturating_add(1), ..device }, term.span);
                after(self.last(term, name).max(self.last(&upper, &upper.key())), formulas)
            }
            _ => self.since(term, name, formulas),
        }
    }

    /// The last step that changed anything.
    pub fn since_any(&self) -> u32 {
        self.touched[ANYWHERE]
    }

    /// The last event that may have changed `term`, whose key is `name`.
    pub fn last(&self, term: &Term, name: &SmolStr) -> u32 {
        let own = match term.register() {
            Some(register) => self.named.get(&register.to_smolstr()),
            None => self.named.get(name),
        };
        let own = own.copied().unwrap_or(0);
        let around = wholes(name).filter_map(|whole| self.named.get(whole).copied()).max().unwrap_or(0);
        own.max(around).max(self.bulk(term))
    }

    /// The last event that may have changed `term` together with others.
    fn bulk(&self, term: &Term) -> u32 {
        let is_flag = matches!(term.operand, Operand::Device(device) if device.is_special());
        let known = if term.storage == Storage::Local { 0 } else { self.known };
        self.kinds[slot(term)].max(known).max(if is_flag { self.flags } else { 0 })
    }

    /// Whether it is a bit by itself, so that a coil that writes to it does nothing else.
    pub fn is_lone(&self, term: &Term) -> bool {
        let is_state = matches!(term.operand, Operand::Device(device) if device.kind == DeviceKind::S);
        term.is_lone() || (self.has_plain_states && is_state)
    }

    /// Whether nothing but writing to it changes it: a bit by itself, a register, a timer or a counter.
    fn is_apart(&self, term: &Term) -> bool {
        self.is_lone(term) || term.register().is_some() || is_timer_or_counter(term)
    }

    /// Notes what the event that just happened may have changed.
    fn change(&mut self, action: &Action, formulas: &mut Formulas) {
        match &action.deed {
            Deed::Instruction(form) if writes_operands(*form) => {
                self.change_operands(*form, &action.terms, formulas);
                self.flags = self.events;
                self.touch(ANYWHERE, formulas);
            }
            // What is done meanwhile elsewhere, nobody knows here.
            Deed::Instruction(_) => self.change_all(formulas),
            Deed::Call(call) if call.keeps_in_out() => self.change_all(formulas),
            deed => {
                if action.runs_unit() {
                    self.change_known(formulas);
                }
                if matches!(deed, Deed::Call(_)) {
                    self.touch(VARIABLES, formulas);
                }
                action.changes().iter().for_each(|term| self.change_term(term, formulas));
            }
        }
    }

    /// An instruction may have changed the operands that it writes, and rows that it reads: a flag turns BMOV round.
    fn change_operands(&mut self, form: Form, terms: &[Term], formulas: &mut Formulas) {
        let operands: Vec<Operand> = terms.iter().map(|term| term.operand).collect();
        for (place, (term, spec)) in terms.iter().zip(form.instruction.operands).enumerate() {
            if spec.access == Access::Read && spec.extent == Extent::Fixed {
                continue;
            }
            let row = || form.covered(place, &operands).filter(|count| *count <= ROW_MAX);
            match (term.operand, term.register()) {
                (Operand::Device(_), Some(first)) if let Some(count) = row() => {
                    for number in first.number..first.number + u32::from(count) {
                        self.named.insert(Device { number, ..first }.to_smolstr(), self.events);
                    }
                    self.touch(slot(term), formulas);
                }
                _ => self.change_kind(slot(term), formulas),
            }
        }
    }

    fn change_all(&mut self, formulas: &mut Formulas) {
        self.kinds = [self.events; KINDS];
        self.touched = [after(self.events, formulas); KINDS];
        self.flags = self.events;
    }

    /// Anything may have changed but the plain variables that only their program unit knows.
    fn change_known(&mut self, formulas: &mut Formulas) {
        let variables = self.kinds[VARIABLES];
        self.change_all(formulas);
        self.kinds[VARIABLES] = variables;
        self.known = self.events;
    }

    fn change_term(&mut self, term: &Term, formulas: &mut Formulas) {
        let name = term.register().map_or_else(|| term.key(), |register| register.to_smolstr());
        self.named.insert(name, self.events);
        match self.is_apart(term) {
            true => self.touch(slot(term), formulas),
            // Setting one state resets others; a word has its bits and those beside it.
            false => self.change_kind(slot(term), formulas),
        }
    }

    /// Anything of a kind may have changed. What may lie anywhere may be any variable, and in 32 bits one index
    /// register has the upper half of the other.
    fn change_kind(&mut self, slot: usize, formulas: &mut Formulas) {
        let slots: Vec<usize> = match slot {
            ANYWHERE => (VARIABLES..KINDS).collect(),
            _ if INDEX.contains(&slot) => INDEX.to_vec(),
            _ => vec![slot],
        };
        for slot in slots {
            self.kinds[slot] = self.events;
            self.touch(slot, formulas);
        }
    }

    /// The last event changed something of a kind.
    fn touch(&mut self, slot: usize, formulas: &mut Formulas) {
        for slot in [slot, ANYWHERE] {
            let step = Step::Event { number: self.events, before: self.touched[slot] };
            self.touched[slot] = formulas.step(step);
        }
    }
}

/// The step that an event is; 0 for none.
fn after(event: u32, formulas: &mut Formulas) -> u32 {
    if event == 0 { 0 } else { formulas.step(Step::Event { number: event, before: 0 }) }
}

/// Whether an instruction changes what it names and flags, and nothing else. One that names nothing to change refreshes
/// inputs, resets annunciators, or steers the program.
fn writes_operands(form: Form) -> bool {
    let is_written = form.instruction.operands.iter().any(|spec| spec.access != Access::Read);
    is_written && form.instruction.flow() == Flow::Straight
}

fn is_timer_or_counter(term: &Term) -> bool {
    matches!(term.operand, Operand::Device(device) if device.kind.has_preset())
}

/// Whether it depends on more than devices of its kind: on an index register, or on flags that instructions set.
fn leads_anywhere(term: &Term) -> bool {
    match term.operand {
        Operand::Indexed { .. }
        | Operand::Nibbles { index: Some(_), .. }
        | Operand::Constant { index: Some(_), .. } => true,
        Operand::Nibbles { first, .. } => first.is_special(),
        _ => false,
    }
}

/// The place of a term's kind.
fn slot(term: &Term) -> usize {
    let area = |location: Location| VARIABLES + 1 + location as usize;
    match (term.operand, term.storage) {
        (Operand::Direct(address), _) => area(address.location),
        (Operand::Variable, Storage::At(address)) => area(address.location),
        (Operand::Variable, Storage::Anywhere) => ANYWHERE,
        _ => term.operand.device().map_or(VARIABLES, |device| device.kind as usize),
    }
}
