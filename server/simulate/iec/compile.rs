//! Makes code of programs in IEC 61131-3: which programs run in which scans, and each unit's body in its turn.

use super::declarations::Declarations;
use super::image::{Ground, Image};
use super::kind::{Extent, Kind, Record};
use super::list::Jumps;
use super::parts::{Computing, Input, Parts, Spot};
use super::place::{At, Place as Variable};
use super::quick::Quick;
use super::scopes::Scope;
use crate::document::Document;
use crate::il::iec::SectionKind;
use crate::simulate::builder::Builder;
use crate::simulate::code::{Code, Op, Place};
use crate::simulate::row::{Cell, Row};
use crate::simulate::{Layout, Obstacle, Problem};
use crate::target::iec::{ElementaryType, Formula};
use crate::target::{DirectAddress, Latches, Target};
use crate::text::{Message, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;
use std::ops::Range;
use std::sync::Arc;

/// Compiles documents that are one program in IEC 61131-3.
pub(in crate::simulate) fn compile(
    documents: &[&Document],
    target: &'static Target,
    is_watched: bool,
) -> Result<Code, Vec<Problem>> {
    let mut compiler = Compiler::new(Declarations::of(documents), target, is_watched);
    compiler.reserve();
    compiler.globals();
    compiler.main();
    let mut next = 0;
    while next < compiler.bodies.len() {
        compiler.body(next);
        next += 1;
    }
    compiler.finish()
}

/// A program that is being compiled.
pub(super) struct Compiler<'a> {
    pub(super) builder: Builder,
    pub(super) declared: Declarations<'a>,
    pub(super) parts: Parts,
    pub(super) image: Image,
    pub(super) problems: Vec<Problem>,
    /// The types that have names, by folded name.
    pub(super) kinds: FxHashMap<SmolStr, Kind>,
    /// The variables of units, by their numbers.
    pub(super) records: FxHashMap<usize, Arc<Record>>,
    /// Types and units whose parts are being looked at.
    pub(super) open: Vec<SmolStr>,
    pub(super) globals: FxHashMap<SmolStr, Variable>,
    /// Variables of instances that VAR_CONFIG lays at addresses, by where they would lie.
    pub(super) rebound: FxHashMap<Extent, Variable>,
    /// Variables whose declaration is refused, and told to be: folded names, with the unit that they are of.
    pub(super) refused: FxHashSet<(Option<usize>, SmolStr)>,
    /// Variables that nothing declares, of what stands outside of all units.
    pub(super) undeclared: FxHashMap<SmolStr, Cell>,
    /// The bodies of units with their variables, as far as something calls them.
    pub(super) bodies: Vec<Body>,
    /// Where the variables of functions lie.
    pub(super) functions: FxHashMap<usize, Extent>,
    /// Ops that go to bodies.
    pub(super) calls: Vec<(u32, usize)>,
    /// Where bodies begin.
    pub(super) starts: Vec<u32>,
    /// The instructions of each body, by their numbers among the places of the code.
    pub(super) instructions: Vec<Range<u32>>,
    /// The body that is being compiled.
    pub(super) now: usize,
    /// Places for current results of that body, by the depth of parentheses.
    pub(super) temporaries: Vec<Extent>,
    /// The place in which it takes current results to labels.
    pub(super) parked: Option<Extent>,
    pub(super) jumps: Jumps,
    /// Which bodies call which, and where.
    pub(super) called: Vec<(usize, usize, Place)>,
}

/// The body of a unit with the variables that it works on.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) unit: usize,
    pub(super) base: Extent,
    /// What is handed over as VAR_IN_OUT, by folded name.
    pub(super) aliases: Vec<(SmolStr, Variable)>,
}

impl Ground for (&mut Builder, &mut Parts) {
    fn take(&mut self, size: Extent) -> Extent {
        let texts = self.1.texts as u32;
        self.1.texts = self.1.texts.saturating_add(size.texts as usize);
        Extent { cells: self.0.kept_row(size.cells), words: self.0.words(size.words), texts }
    }
}

impl<'a> Compiler<'a> {
    fn new(declared: Declarations<'a>, target: &'static Target, is_watched: bool) -> Compiler<'a> {
        Compiler {
            builder: Builder::new(target, Arc::new(Layout::new(target, &Latches::default())), is_watched),
            declared,
            parts: Parts { initials: vec![Vec::new()], ..Parts::default() },
            image: Image::default(),
            problems: Vec::new(),
            kinds: FxHashMap::default(),
            records: FxHashMap::default(),
            open: Vec::new(),
            globals: FxHashMap::default(),
            rebound: FxHashMap::default(),
            refused: FxHashSet::default(),
            undeclared: FxHashMap::default(),
            bodies: Vec::new(),
            functions: FxHashMap::default(),
            calls: Vec::new(),
            starts: Vec::new(),
            instructions: Vec::new(),
            now: usize::MAX,
            temporaries: Vec::new(),
            parked: None,
            jumps: Jumps::default(),
            called: Vec::new(),
        }
    }

    pub(super) fn refuse(&mut self, place: Place, obstacle: Obstacle) {
        self.problems.push(Problem { place, obstacle });
    }

    pub(super) fn take(&mut self, size: Extent) -> Extent {
        (&mut self.builder, &mut self.parts).take(size)
    }

    /// Where a located variable lies.
    pub(super) fn located(&mut self, address: DirectAddress, kind: &Kind) -> Result<Variable, Obstacle> {
        let wrong = || Obstacle::Iec(Message::new("simulate.address").with("address", address.to_string()));
        let mut ground = (&mut self.builder, &mut self.parts);
        let at = match kind.elementary() {
            Some(elementary) => self.image.place(address, elementary, &mut ground).map(At::Other),
            None => self.image.row(address, kind, &mut ground).map(At::Image),
        };
        let has_structure = |kind: &Kind| match kind {
            Kind::Array(_, element) => matches!(**element, Kind::Record(_)),
            kind => matches!(kind, Kind::Record(_)),
        };
        let at = match at {
            None if has_structure(kind) => {
                let message = Message::new("simulate.address-structure");
                return Err(Obstacle::Iec(message.with("address", address.to_string())));
            }
            at => at.ok_or_else(wrong)?,
        };
        let variable = Variable { kind: kind.clone(), at, index: 0, is_constant: false };
        let here = self.parts.names.around.located.entry(address).or_default();
        if !here.iter().any(|own| own.kind.is_same(kind)) {
            here.push(variable.clone());
        }
        Ok(variable)
    }

    /// The variable itself, where VAR_CONFIG lays the one of an instance at an address.
    pub(super) fn bound_to(&self, variable: Variable) -> Variable {
        let own = match variable.at {
            At::Memory(at) if variable.kind.elementary().is_some() => self.rebound.get(&at),
            _ => None,
        };
        own.cloned().unwrap_or(variable)
    }

    /// The global variables.
    pub(super) fn globals(&mut self) {
        for section in std::mem::take(&mut self.declared.globals) {
            for mut field in self.fields(section, None) {
                let declared = field.declared.take();
                let place = match field.address {
                    Some(address) => self.located(address, &field.kind),
                    None => Ok(Variable::new(field.kind.clone(), self.take(field.kind.size()))),
                };
                let mut variable = match place {
                    Ok(variable) => variable,
                    Err(obstacle) => {
                        let span = declared
                            .map(|at| (at.source, self.declared.declaration(at.source, at.index).span));
                        let place = span.map(|(source, span)| self.declared.place(source, span));
                        self.refuse(place.unwrap_or(Place::START), obstacle);
                        self.refused.insert((None, folded(&field.name)));
                        continue;
                    }
                };
                self.initial_of_variable(0, &variable, declared, false);
                variable.is_constant = field.is_constant;
                let name = folded(&field.name);
                self.parts.names.add(vec![field.name], &variable);
                self.globals.entry(name).or_insert(variable);
            }
        }
    }

    /// Calls the body of a unit with these variables.
    pub(super) fn enter(
        &mut self,
        unit: usize,
        variable: &Variable,
        aliases: Vec<(SmolStr, Variable)>,
        power: Cell,
        place: Place,
    ) {
        let At::Memory(base) = variable.at else { return };
        let is_same = |body: &Body| {
            let same = |own: &(SmolStr, Variable), other: &(SmolStr, Variable)| {
                own.0 == other.0 && own.1.at == other.1.at && own.1.index == other.1.index
            };
            body.unit == unit
                && body.base == base
                && body.aliases.len() == aliases.len()
                && body.aliases.iter().zip(&aliases).all(|(own, other)| same(own, other))
        };
        let number = self.bodies.iter().position(is_same).unwrap_or_else(|| {
            self.bodies.push(Body { unit, base, aliases });
            self.bodies.len() - 1
        });
        let op = self.builder.op(Op::Call { power, to: 0 });
        self.calls.push((op, number));
        self.called.push((self.now, number, place));
    }

    /// Puts a calculation behind what was before.
    pub(super) fn compute(
        &mut self,
        formula: Formula,
        inputs: Vec<(Input, ElementaryType)>,
        result: ElementaryType,
        to: Spot,
    ) {
        self.compute_with(formula, inputs, result, to, Row::RAIL, None);
    }

    /// The same with power from a cell, and a relay that tells whether it went well.
    pub(super) fn compute_with(
        &mut self,
        formula: Formula,
        inputs: Vec<(Input, ElementaryType)>,
        result: ElementaryType,
        to: Spot,
        power: Cell,
        ok: Option<Cell>,
    ) {
        let (inputs, kinds): (Vec<_>, Vec<_>) = inputs.into_iter().unzip();
        let number = self.parts.computings.len() as u32;
        let quick = Quick::of(formula, (&inputs, &kinds), result, to);
        self.parts.computings.push(Computing { quick, formula, inputs, kinds, result, to, ok });
        self.builder.op(Op::Compute { power, number });
    }

    /// Copies an elementary value.
    pub(super) fn copy(&mut self, from: Input, kind: ElementaryType, to: Spot) {
        self.compute(Formula::COPY, vec![(from, kind)], to.kind, to);
    }

    fn finish(mut self) -> Result<Code, Vec<Problem>> {
        for (op, body) in std::mem::take(&mut self.calls) {
            let start = self.starts.get(body).copied().unwrap_or(0);
            if let Some(Op::Call { to, .. }) = self.builder.op_mut(op) {
                *to = start;
            }
        }
        self.refuse_recursion();
        if !self.problems.is_empty() {
            self.problems.retain(|problem| problem.obstacle != Obstacle::Follows);
            self.problems.sort_by_key(|problem| problem.place);
            self.problems.dedup();
            return Err(self.problems);
        }
        self.scopes();
        self.parts.names.finish(self.image, &self.kinds, self.rebound);
        let mut code =
            self.builder.finish().map_err(|obstacle| vec![Problem { place: Place::START, obstacle }])?;
        if code.slots > MOST_WORDS || self.parts.texts > MOST_WORDS {
            return Err(vec![Problem { place: Place::START, obstacle: Obstacle::TooLarge }]);
        }
        code.iec = self.parts;
        Ok(code)
    }

    /// Notes what names mean in each body.
    fn scopes(&mut self) {
        for (number, body) in std::mem::take(&mut self.bodies).into_iter().enumerate() {
            let (record, unit) = (self.record(body.unit), &self.declared.units[body.unit]);
            self.parts.names.scopes.push(Scope {
                unit: folded(&unit.name),
                kind: unit.kind,
                record,
                base: body.base,
                aliases: body.aliases,
                instructions: self.instructions.get(number).cloned().unwrap_or_default(),
                callers: self
                    .called
                    .iter()
                    .filter(|(_, called, _)| *called == number)
                    .map(|(caller, _, place)| (*caller, *place))
                    .collect(),
            });
        }
        self.parts.names.around.globals = std::mem::take(&mut self.globals);
    }

    /// A unit that calls itself, through others or not, would need variables for each call.
    fn refuse_recursion(&mut self) {
        for (number, place) in self.called.iter().map(|(_, to, place)| (*to, *place)).collect::<Vec<_>>() {
            let mut reached = vec![false; self.bodies.len()];
            let mut waiting = vec![number];
            while let Some(from) = waiting.pop() {
                for (_, to, _) in self.called.iter().filter(|(caller, ..)| *caller == from) {
                    if !std::mem::replace(&mut reached[*to], true) {
                        waiting.push(*to);
                    }
                }
            }
            if reached[number] {
                let name = self.declared.units[self.bodies[number].unit].name.clone();
                self.refuse(place, Obstacle::Iec(Message::new("simulate.recursion").with("name", name)));
            }
        }
    }
}

/// More words than that are refused.
const MOST_WORDS: usize = 1 << 24;

/// Whether the callers of a unit see its variables of a section.
pub(super) fn is_input(section: SectionKind) -> bool {
    matches!(section, SectionKind::Input | SectionKind::InOut)
}
