//! Calls of function blocks and functions, and the bodies that they run.

use super::arguments::Arguments;
use super::compile::Compiler;
use super::current::{Current, Given};
use super::declarations::Part;
use super::kind::{Extent, Field, Kind, Record, RecordKind, count};
use super::operand::{Value, cell_spot, said, word_spot};
use super::parts::{BlockCall, Copying, Input, Spot};
use super::place::{At, Place as Variable, lies};
use crate::il::iec::{PouKind, SectionKind};
use crate::simulate::builder::Position;
use crate::simulate::code::{Op, Place};
use crate::simulate::row::Row;
use crate::simulate::{Cell, Obstacle};
use crate::target::iec::semantics::NOTES;
use crate::target::iec::{Datum, EN, ENO, ElementaryType, Formula, Function, Parameter};
use crate::text::{Message, folded};
use smol_str::SmolStr;
use std::iter::repeat;

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
        let first = self.builder.instruction();
        self.edges();
        self.renew(number);
        let parts = self.declared.units[unit].body.clone();
        for part in &parts {
            match part {
                Part::List { source, items } => self.find_labels(*source, items.clone()),
                Part::Drawing { lists, .. } => {
                    lists.clone().for_each(|source| self.find_labels(source, self.declared.items(source)));
                }
            }
        }
        let mut current = Current::Nothing;
        for part in parts {
            current = match part {
                Part::List { source, items } => self.list(source, items, current),
                Part::Drawing { document, chunk, scopes, pous, lists } => {
                    self.drawing(document, chunk, (scopes, pous), lists);
                    Current::Nothing
                }
            };
        }
        self.builder.forget_power();
        self.land();
        self.builder.op(Op::Return);
        self.instructions.push(first..self.builder.last_instruction() + 1);
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
        let to = Spot::new(given.kind, lies(place, given.kind, u32::MAX as usize));
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
        Spot::new(kind, lies(place, kind, u32::MAX as usize))
    }

    /// Copies a value with parts; `name` is what people call the variable that it goes to.
    pub(super) fn copy_whole(&mut self, from: &Variable, to: &Variable, name: &str) -> Result<(), Obstacle> {
        if !from.kind.is_same(&to.kind) {
            return Err(said("simulate.other-type", name));
        }
        let (At::Memory(source), At::Memory(target)) = (from.at, to.at) else {
            return self.copy_elements(from, to);
        };
        let size = from.kind.size();
        let copying = Copying { from: (source, from.index), to: (target, to.index), size };
        self.parts.copies.push(copying);
        let number = self.parts.copies.len() as u32 - 1;
        self.builder.op(Op::Copy { power: Row::RAIL, number });
        Ok(())
    }

    /// The same one by one, for an array at an address.
    fn copy_elements(&mut self, from: &Variable, to: &Variable) -> Result<(), Obstacle> {
        match (from.kind.clone(), from.spot(), to.spot()) {
            (_, Some(from), Some(to)) => self.stored(Given::at(from), to),
            (Kind::Array(bounds, element), ..) => {
                let part = |whole: &Variable, number| {
                    whole.part((*element).clone(), whole.size_of(&element).times(number))
                };
                for number in 0..count(&bounds) {
                    let (Some(from), Some(to)) = (part(from, number), part(to, number)) else {
                        return Err(Obstacle::Unreadable);
                    };
                    self.copy_elements(&from, &to)?;
                }
                Ok(())
            }
            _ => Err(Obstacle::Unreadable),
        }
    }

    /// Does what `inside` compiles while a cell is on.
    pub(super) fn enabled(
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
    pub(super) fn handed_over(
        &mut self,
        variable: &Variable,
        arguments: &mut Arguments,
    ) -> Result<Vec<(SmolStr, Variable)>, Obstacle> {
        let Kind::Record(record) = variable.kind.clone() else { return Err(Obstacle::Unreadable) };
        let part = |field: &Field| variable.part(field.kind.clone(), field.at).ok_or(Obstacle::Unreadable);
        for (name, given) in std::mem::take(&mut arguments.inputs) {
            let field = input(&record, &name)?;
            let spot = part(field)?.spot().ok_or_else(|| said("simulate.not-elementary", &name))?;
            self.stored(given, spot)?;
        }
        for (name, whole) in std::mem::take(&mut arguments.wholes) {
            let field = input(&record, &name)?;
            self.copy_whole(&whole, &part(field)?, &name)?;
        }
        let mut aliases = Vec::new();
        for field in record.fields.iter().filter(|field| field.section == SectionKind::InOut) {
            let own = arguments.in_out.iter().find(|(name, _)| folded(name) == folded(&field.name));
            let (name, word) = own.ok_or_else(|| said("simulate.in-out", &field.name))?;
            let handed = self.variable(word)?;
            if !handed.kind.is_like(&field.kind) {
                return Err(said("simulate.other-type", word));
            }
            let handed = self.frozen(handed);
            aliases.push((folded(name), handed));
        }
        Ok(aliases)
    }

    /// Writes outputs to variables behind a call.
    pub(super) fn taken_over(
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
                _ => self.copy_whole(&from, &to, &word)?,
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
        let enable = self.enabling(variable, arguments.enable)?;
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
                RecordKind::Unit(unit) if variable.index != 0 => {
                    own.enter_one(unit, variable, &aliases, place)?;
                }
                RecordKind::Unit(unit) => own.enter(unit, variable, aliases, Row::RAIL, place),
                RecordKind::Structure => return Err(Obstacle::Unreadable),
            }
            own.taken_over(variable, std::mem::take(&mut arguments.outputs))
        })?;
        let told = self.flag(variable, &ENO)?.map(|told| self.cell_of(told));
        let told = told.or(enable).unwrap_or(Row::RAIL);
        self.tell_enabled(told, enabled)
    }

    /// Calls the body of that instance of an array that its subscripts say. Each instance has a body of its own.
    fn enter_one(
        &mut self,
        unit: usize,
        variable: &Variable,
        aliases: &[(SmolStr, Variable)],
        place: Place,
    ) -> Result<(), Obstacle> {
        let At::Memory(base) = variable.at else { return Err(Obstacle::Unreadable) };
        let frozen = self.frozen(variable.clone());
        let indices = self.parts.indices[frozen.index as usize - 1].clone();
        let lengths: Vec<u64> =
            indices.iter().map(|index| (index.greatest - index.least + 1) as u64).collect();
        let all = lengths.iter().fold(1_u64, |all, length| all.saturating_mul(*length));
        if all > MOST_INSTANCES {
            return Err(Obstacle::Iec(Message::new("simulate.open-instance").with("most", MOST_INSTANCES)));
        }
        let equal = Function::named("EQ").ok_or(Obstacle::Unreadable)?;
        for number in 0..all {
            let (mut rest, mut at) = (number, base);
            let mut is_it = Vec::new();
            for (index, length) in indices.iter().zip(&lengths) {
                let own = rest % length;
                rest /= length;
                at = at.plus(index.stride.times(own));
                let to = self.builder.scratch();
                let subscript = (Input::At(word_spot(index.word)), ElementaryType::Lint);
                let wanted = Input::Constant(Datum::Whole(i128::from(index.least) + i128::from(own)));
                let inputs = vec![subscript, (wanted, ElementaryType::Lint)];
                self.compute(equal.formula, inputs, ElementaryType::Bool, cell_spot(to));
                is_it.push(to);
            }
            self.builder.forget_power();
            for (cell, position) in
                is_it.into_iter().zip([Position::First].into_iter().chain(repeat(Position::Series)))
            {
                self.builder.connect(position, cell, false);
            }
            let power = self.builder.settle();
            let instance = Variable { at: At::Memory(at), index: 0, ..variable.clone() };
            self.enter(unit, &instance, aliases.to_vec(), power, place);
        }
        self.builder.forget_power();
        self.look(&frozen)
    }

    /// Reads something of an instance, so that a subscript that is out of bounds is told.
    fn look(&mut self, variable: &Variable) -> Result<(), Obstacle> {
        let mut part = variable.clone();
        while part.spot().is_none() {
            let (kind, behind) = match &part.kind {
                Kind::Record(record) => match record.fields.iter().find(|field| field.has_place()) {
                    Some(field) => (field.kind.clone(), field.at),
                    None => return Ok(()),
                },
                Kind::Array(_, element) => ((**element).clone(), Extent::default()),
                _ => return Ok(()),
            };
            part = part.part(kind, behind).ok_or(Obstacle::Unreadable)?;
        }
        if let Some(spot) = part.spot() {
            let place = self.take(Kind::of(spot.kind).size());
            self.copy(Input::At(spot), spot.kind, Spot::new(spot.kind, lies(place, spot.kind, 0)));
        }
        Ok(())
    }

    /// The relay that enables a call of a declared unit, and its EN and ENO made ready where it declares them: EN is
    /// what is given, or what the variable has; ENO is on unless the unit is not enabled, or says so itself.
    fn enabling(&mut self, variable: &Variable, given: Option<Cell>) -> Result<Option<Cell>, Obstacle> {
        let (input, output) = (self.flag(variable, &EN)?, self.flag(variable, &ENO)?);
        if let (Some(input), Some(given)) = (input, given) {
            self.copy(Input::At(cell_spot(given)), ElementaryType::Bool, input);
        }
        let enable = input.map(|input| self.cell_of(input)).or(given);
        if let Some(output) = output {
            let from = cell_spot(enable.unwrap_or(Row::RAIL));
            self.copy(Input::At(from), ElementaryType::Bool, output);
        }
        Ok(enable)
    }

    /// A relay that is as the BOOL at a place is now.
    fn cell_of(&mut self, spot: Spot) -> Cell {
        let to = self.builder.scratch();
        self.copy(Input::At(spot), ElementaryType::Bool, cell_spot(to));
        to
    }

    /// EN or ENO as a unit of the program declares it.
    fn flag(&mut self, variable: &Variable, parameter: &Parameter) -> Result<Option<Spot>, Obstacle> {
        let Kind::Record(record) = &variable.kind else { return Ok(None) };
        let field = match record.what {
            RecordKind::Unit(_) => record.field(parameter.name),
            _ => None,
        };
        let wrong = || said("simulate.no-bit", parameter.name);
        let part = |field: &Field| {
            let spot = variable.part(field.kind.clone(), field.at)?.spot()?;
            (spot.kind == ElementaryType::Bool).then_some(spot)
        };
        field.map(|field| part(field).ok_or_else(wrong)).transpose()
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
        let enabled = arguments.enabled.take();
        // Also the result of a function that is not executed is what its variable has at first.
        let list = self.parts.initials.len();
        self.parts.initials.push(Vec::new());
        self.initial_of_variable(list, &variable, None, true);
        self.builder.op(Op::Initialise(list as u32));
        let enable = self.enabling(&variable, arguments.enable)?;
        self.enabled(enable, |own| {
            let aliases = own.handed_over(&variable, &mut arguments)?;
            own.enter(unit, &variable, aliases, Row::RAIL, place);
            own.taken_over(&variable, std::mem::take(&mut arguments.outputs))
        })?;
        let told = self.flag(&variable, &ENO)?.map(|told| self.cell_of(told));
        let told = told.or(enable).unwrap_or(Row::RAIL);
        self.tell_enabled(told, enabled)?;
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
            if let Some(enable) = enable {
                // What is not executed has the result that a variable of its type has at first.
                let off = self.inverse(enable);
                let nothing = vec![(Input::Constant(Datum::default_of(to.kind)), to.kind)];
                self.compute_with(Formula::COPY, nothing, to.kind, to, off, None);
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

/// Arrays with more instances are not called by subscripts that are known at run time only.
const MOST_INSTANCES: u64 = 256;

/// The input with a name.
fn input<'r>(record: &'r Record, name: &str) -> Result<&'r Field, Obstacle> {
    let own = record.field(name);
    own.filter(|field| field.section == SectionKind::Input).ok_or_else(|| said("simulate.no-member", name))
}
