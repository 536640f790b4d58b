//! Calls of function blocks and functions, and the bodies that they run.

use super::arguments::Arguments;
use super::compile::Compiler;
use super::current::{Current, Given};
use super::declarations::Part;
use super::kind::{Extent, Field, Kind, RecordKind};
use super::operand::{Value, cell_spot, said};
use super::parts::{BlockCall, Copying, Input, Spot};
use super::place::{At, Place as Variable, lies};
use crate::il::iec::{PouKind, SectionKind};
use crate::simulate::code::{Op, Place};
use crate::simulate::row::Row;
use crate::simulate::{Cell, Obstacle};
use crate::target::iec::semantics::NOTES;
use crate::target::iec::{ElementaryType, Function};
use crate::text::{Message, folded};
use smol_str::SmolStr;

impl Compiler<'_> {
    /// Compiles the body with this number.
    pub(super) fn body(&mut self, number: usize) {
        self.now = number;
        self.temporaries.clear();
        self.parked = None;
        self.builder.routine();
        let start = self.builder.here();
        self.starts.push(start);
        let unit = self.bodies[number].unit;
        let place = self.declared.units[unit].place.unwrap_or(Place::START);
        self.builder.at(place, 0);
        let (first, base) = (self.builder.instruction(), self.bodies[number].base);
        let name = self.declared.units[unit].name.clone();
        self.parts.names.bodies.push(super::names::Body { first, unit, name, base });
        self.edges();
        self.renew(number);
        let parts = self.declared.units[unit].body.clone();
        for part in &parts {
            if let Part::List { source, items } = part {
                self.find_labels(*source, items.clone());
            }
        }
        let mut current = Current::Nothing;
        for part in parts {
            current = match part {
                Part::List { source, items } => self.list(source, items, current),
                Part::Drawing { document, chunk, scopes, pous } => {
                    self.drawing(document, chunk, scopes, pous);
                    Current::Nothing
                }
            };
        }
        self.builder.forget_power();
        self.land();
        self.builder.op(Op::Return);
    }

    /// Variables that begin anew at each call: VAR_TEMP. Those of functions begin where they are called.
    fn renew(&mut self, number: usize) {
        let (unit, base) = (self.bodies[number].unit, self.bodies[number].base);
        if self.declared.units[unit].kind == Some(PouKind::Function) {
            return;
        }
        let record = self.record(unit);
        let list = self.parts.initials.len();
        self.parts.initials.push(Vec::new());
        for field in record.fields.iter().filter(|field| field.section == SectionKind::Temporary) {
            let variable = Variable::new(field.kind.clone(), base.plus(field.at));
            self.initial_of_variable(list, &variable, field.declared, true);
        }
        match self.parts.initials[list].is_empty() {
            true => _ = self.parts.initials.pop(),
            false => _ = self.builder.op(Op::Initialise(list as u32)),
        }
    }

    /// The variable that an operand names, if it has parts.
    pub(super) fn whole(&mut self, word: &str) -> Result<Option<Variable>, Obstacle> {
        Ok(match self.value(word)? {
            Value::Variable(variable) if variable.kind.elementary().is_none() => Some(variable),
            _ => None,
        })
    }

    /// A copy of a value that nothing else writes.
    pub(super) fn set_aside(&mut self, given: Given) -> Given {
        let Input::At(from) = given.input else { return given };
        let place = self.take(Extent { cells: 1, words: 1, texts: 1 });
        let to = Spot { kind: given.kind, lies: lies(place, given.kind, u32::MAX as usize), index: 0 };
        self.copy(Input::At(from), given.kind, to);
        Given::at(to)
    }

    /// Where a current result waits at a label.
    pub(super) fn parking(&mut self, kind: ElementaryType) -> Spot {
        let place = match self.parked {
            Some(place) => place,
            None => {
                let place = self.take(Extent { cells: 1, words: 1, texts: 1 });
                *self.parked.insert(place)
            }
        };
        Spot { kind, lies: lies(place, kind, u32::MAX as usize), index: 0 }
    }

    /// Copies a value with parts.
    pub(super) fn copy_whole(&mut self, from: &Variable, to: &Variable) -> Result<(), Obstacle> {
        let (At::Memory(source), At::Memory(target)) = (from.at, to.at) else {
            return Err(Obstacle::Unreadable);
        };
        if !from.kind.is_same(&to.kind) {
            return Err(Obstacle::Iec(Message::new("simulate.other-type").with("name", "")));
        }
        let size = from.kind.size();
        let copying = Copying { from: (source, from.index), to: (target, to.index), size };
        self.parts.copies.push(copying);
        let number = self.parts.copies.len() as u32 - 1;
        self.builder.op(Op::Copy { power: Row::RAIL, number });
        Ok(())
    }

    /// Does what `inside` compiles while a cell is on.
    fn enabled(
        &mut self,
        enable: Option<Cell>,
        inside: impl FnOnce(&mut Self) -> Result<(), Obstacle>,
    ) -> Result<(), Obstacle> {
        let Some(enable) = enable else { return inside(self) };
        let off = self.inverse(enable);
        let skip = self.builder.op(Op::Jump { power: off, to: 0 });
        inside(self)?;
        let here = self.builder.here();
        self.send(skip, here);
        Ok(())
    }

    /// Hands over what a call gives. Gives what is handed over to be changed.
    fn handed_over(
        &mut self,
        variable: &Variable,
        arguments: &mut Arguments,
    ) -> Result<Vec<(SmolStr, Variable)>, Obstacle> {
        let Kind::Record(record) = variable.kind.clone() else { return Err(Obstacle::Unreadable) };
        let part = |field: &Field| variable.part(field.kind.clone(), field.at).ok_or(Obstacle::Unreadable);
        for (name, given) in std::mem::take(&mut arguments.inputs) {
            let field = input(&record.fields, &name)?;
            let spot = part(field)?.spot().ok_or_else(|| said("simulate.not-elementary", &name))?;
            self.stored(given, spot)?;
        }
        for (name, whole) in std::mem::take(&mut arguments.wholes) {
            let field = input(&record.fields, &name)?;
            self.copy_whole(&whole, &part(field)?)?;
        }
        let mut aliases = Vec::new();
        for field in record.fields.iter().filter(|field| field.section == SectionKind::InOut) {
            let own = arguments.in_out.iter().find(|(name, _)| folded(name) == folded(&field.name));
            let (name, word) = own.ok_or_else(|| said("simulate.in-out", &field.name))?;
            let handed = self.variable(word)?;
            if !handed.kind.is_same(&field.kind) {
                return Err(said("simulate.other-type", word));
            }
            let handed = self.frozen(handed);
            aliases.push((folded(name), handed));
        }
        Ok(aliases)
    }

    /// Writes outputs to variables behind a call.
    fn taken_over(
        &mut self,
        variable: &Variable,
        outputs: Vec<(SmolStr, String, bool)>,
    ) -> Result<(), Obstacle> {
        let Kind::Record(record) = variable.kind.clone() else { return Err(Obstacle::Unreadable) };
        for (name, word, negated) in outputs {
            let unknown = || said("simulate.no-member", &name);
            let field = record.field(&name).filter(|field| field.section == SectionKind::Output);
            let field = field.ok_or_else(unknown)?;
            let from = variable.part(field.kind.clone(), field.at).ok_or_else(unknown)?;
            let to = self.written(&word)?;
            match (from.spot(), to.spot()) {
                (Some(from), Some(to)) => {
                    let given = match negated {
                        true => self.complement(Given::at(from), 0)?,
                        false => Given::at(from),
                    };
                    self.stored(given, to)?;
                }
                _ => self.copy_whole(&from, &to)?,
            }
        }
        Ok(())
    }

    /// A variable that may be written.
    pub(super) fn written(&mut self, word: &str) -> Result<Variable, Obstacle> {
        match self.value(word)? {
            Value::Variable(variable) if !variable.is_constant => Ok(variable),
            _ => Err(said("simulate.not-written", word)),
        }
    }

    /// Calls a function block; power is as before behind it.
    pub(super) fn called_block(
        &mut self,
        variable: &Variable,
        mut arguments: Arguments,
        place: Place,
    ) -> Result<(), Obstacle> {
        let Kind::Record(record) = variable.kind.clone() else { return Err(Obstacle::Unreadable) };
        let enabled = arguments.enabled.take();
        let enable = arguments.enable;
        self.enabled(enable, |own| {
            let aliases = own.handed_over(variable, &mut arguments)?;
            match record.what {
                RecordKind::Block(block) => {
                    let At::Memory(base) = variable.at else { return Err(Obstacle::Unreadable) };
                    let pins = |section| {
                        let own = record.fields.iter().filter(move |field| field.section == section);
                        own.filter_map(|field| variable.part(field.kind.clone(), field.at)?.spot()).collect()
                    };
                    let notes = base.words + record.size.words - NOTES as u32;
                    let (inputs, outputs) = (pins(SectionKind::Input), pins(SectionKind::Output));
                    own.parts.blocks.push(BlockCall { block, inputs, outputs, notes, index: variable.index });
                    let number = own.parts.blocks.len() as u32 - 1;
                    own.builder.op(Op::Block { power: Row::RAIL, number });
                }
                RecordKind::Unit(_) if variable.index != 0 => {
                    return Err(Obstacle::Iec(Message::new("simulate.open-instance")));
                }
                RecordKind::Unit(unit) => own.enter(unit, variable, aliases, Row::RAIL, place),
                RecordKind::Structure => return Err(Obstacle::Unreadable),
            }
            own.taken_over(variable, std::mem::take(&mut arguments.outputs))
        })?;
        self.tell_enabled(enable.unwrap_or(Row::RAIL), enabled)
    }

    /// Writes ENO to its variable.
    fn tell_enabled(&mut self, enable: Cell, enabled: Option<(String, bool)>) -> Result<(), Obstacle> {
        let Some((word, negated)) = enabled else { return Ok(()) };
        let to = self.written(&word)?.spot().ok_or_else(|| said("simulate.no-bit", &word))?;
        let cell = if negated { self.inverse(enable) } else { enable };
        self.stored(Given::at(cell_spot(cell)), to)
    }

    /// Calls a function of the program, and gives the place of its result.
    pub(super) fn called_function(
        &mut self,
        unit: usize,
        mut arguments: Arguments,
        depth: usize,
        place: Place,
    ) -> Result<Option<Spot>, Obstacle> {
        let record = self.record(unit);
        let is_new = !self.functions.contains_key(&unit);
        let base = match self.functions.get(&unit) {
            Some(base) => *base,
            None => {
                let base = self.take(record.size);
                self.functions.insert(unit, base);
                base
            }
        };
        let variable = Variable::new(Kind::Record(record.clone()), base);
        if is_new {
            let name = self.declared.units[unit].name.clone();
            self.parts.names.add_function(name, &variable);
        }
        let result = record.fields.iter().find(|field| {
            folded(&field.name) == folded(&self.declared.units[unit].name)
                && self.declared.units[unit].result.is_some()
        });
        let (enable, enabled) = (arguments.enable, arguments.enabled.take());
        self.enabled(enable, |own| {
            let list = own.parts.initials.len();
            own.parts.initials.push(Vec::new());
            own.initial_of_variable(list, &variable, None, true);
            own.builder.op(Op::Initialise(list as u32));
            let aliases = own.handed_over(&variable, &mut arguments)?;
            own.enter(unit, &variable, aliases, Row::RAIL, place);
            own.taken_over(&variable, std::mem::take(&mut arguments.outputs))
        })?;
        self.tell_enabled(enable.unwrap_or(Row::RAIL), enabled)?;
        let Some(field) = result else { return Ok(None) };
        let from = variable.part(field.kind.clone(), field.at).and_then(|part| part.spot());
        let from = from.ok_or_else(|| said("simulate.not-elementary", &field.name))?;
        // The next call has its result in the same place.
        let to = self.temporary(from.kind, depth);
        self.copy(Input::At(from), from.kind, to);
        Ok(Some(to))
    }

    /// Calls a standard function that EN may enable.
    pub(super) fn applied_enabled(
        &mut self,
        function: &'static Function,
        given: Vec<Given>,
        expected: Option<ElementaryType>,
        depth: usize,
        enable: Option<Cell>,
        enabled: Option<(String, bool)>,
    ) -> Result<Spot, Obstacle> {
        let to = self.applied(function, given, expected, |own, kind| own.temporary(kind, depth))?;
        if enable.is_some() || enabled.is_some() {
            let ok = self.builder.scratch();
            self.builder.only_with(enable.unwrap_or(Row::RAIL));
            if let Some(computing) = self.parts.computings.last_mut() {
                computing.ok = Some(ok);
            }
            if let Some((word, negated)) = enabled {
                self.tell_enabled(ok, Some((word, negated)))?;
            }
        }
        Ok(to)
    }

    /// Stores the power in a cell to a BOOL variable, wherever it lies.
    pub(super) fn drive(&mut self, power: Cell, to: &Variable, negated: bool) -> Result<(), Obstacle> {
        match (to.cell(), to.spot()) {
            (Some(cell), _) => {
                self.builder.out(cell, negated);
                Ok(())
            }
            (None, Some(spot)) => {
                let from = if negated { self.inverse(power) } else { power };
                self.stored(Given::at(cell_spot(from)), spot)
            }
            _ => Err(Obstacle::Unreadable),
        }
    }

    /// Puts the result of a standard function into a place while a cell is on.
    pub(super) fn applied_to(
        &mut self,
        function: &'static Function,
        given: Vec<Given>,
        to: Spot,
        types: Option<ElementaryType>,
        power: Cell,
    ) -> Result<(), Obstacle> {
        let Some(kind) = types else {
            self.applied(function, given, Some(to.kind), |_, _| to)?;
            let made = self.parts.computings.last().map_or(to.kind, |computing| computing.result);
            self.fitted(Given::at(Spot { kind: made, ..to }), to.kind)?;
            self.builder.only_with(power);
            return Ok(());
        };
        // Numbers are joined as patterns, or multiplied to wider ones: the result has the type of its variable.
        let mut inputs = Vec::new();
        for value in given {
            inputs.push(self.fitted(value, kind)?);
        }
        self.compute_with(function.formula, inputs, to.kind, to, power, None);
        Ok(())
    }
}

/// The input with a name.
fn input<'f>(fields: &'f [Field], name: &str) -> Result<&'f Field, Obstacle> {
    let own = fields.iter().find(|field| folded(&field.name) == folded(name));
    own.filter(|field| field.section == SectionKind::Input).ok_or_else(|| said("simulate.no-member", name))
}
