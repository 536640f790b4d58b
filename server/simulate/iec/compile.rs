//! Makes code of programs in IEC 61131-3: which programs run in which scans, and each unit's body in its turn.

use super::declarations::{Configured, Declarations};
use super::image::{Ground, Image};
use super::kind::{Extent, Kind, Record};
use super::list::Jumps;
use super::parts::{Computing, Input, Parts, Spot, Task};
use super::place::Place as Variable;
use crate::document::Document;
use crate::il::iec::{PouKind, SectionKind};
use crate::simulate::builder::Builder;
use crate::simulate::code::{Code, Op, Place};
use crate::simulate::row::{Cell, Row};
use crate::simulate::{Layout, Obstacle, Problem};
use crate::target::iec::{Datum, ElementaryType, Formula, LiteralValue};
use crate::target::{Operand, Target};
use crate::text::{Message, Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::sync::Arc;

/// Compiles documents that are one program in IEC 61131-3.
pub(in crate::simulate) fn compile(
    documents: &[&Document],
    target: &'static Target,
    is_watched: bool,
) -> Result<Code, Vec<Problem>> {
    let mut compiler = Compiler::new(Declarations::of(documents), target, is_watched);
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
            builder: Builder::new(target, Arc::new(Layout::new(target)), is_watched),
            declared,
            parts: Parts { initials: vec![Vec::new()], ..Parts::default() },
            image: Image::default(),
            problems: Vec::new(),
            kinds: FxHashMap::default(),
            records: FxHashMap::default(),
            open: Vec::new(),
            globals: FxHashMap::default(),
            undeclared: FxHashMap::default(),
            bodies: Vec::new(),
            functions: FxHashMap::default(),
            calls: Vec::new(),
            starts: Vec::new(),
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
    pub(super) fn located(
        &mut self,
        address: crate::target::DirectAddress,
        kind: &Kind,
    ) -> Result<Variable, Obstacle> {
        let wrong = || Obstacle::Iec(Message::new("simulate.address").with("address", address.to_string()));
        let elementary = kind.elementary().ok_or_else(wrong)?;
        let mut ground = (&mut self.builder, &mut self.parts);
        let lies = self.image.place(address, elementary, &mut ground).ok_or_else(wrong)?;
        Ok(Variable { kind: kind.clone(), at: super::place::At::Other(lies), index: 0, is_constant: false })
    }

    /// The global variables.
    fn globals(&mut self) {
        for place in std::mem::take(&mut self.declared.configs) {
            self.refuse(place, Obstacle::Iec(Message::new("simulate.var-config")));
        }
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

    /// What runs in a scan: programs with tasks by priority, then those without.
    fn main(&mut self) {
        let instances = std::mem::take(&mut self.declared.instances);
        let tasks = self.tasks();
        if instances.is_empty() {
            for number in 0..self.declared.units.len() {
                if matches!(self.declared.units[number].kind, Some(PouKind::Program) | None) {
                    let name = self.declared.units[number].name.clone();
                    let path = if name.is_empty() { Vec::new() } else { vec![name] };
                    if let Some(variable) = self.instance(number, path) {
                        self.builder.rung();
                        self.enter(number, &variable, Vec::new(), Row::RAIL, Place::START);
                    }
                }
            }
        } else {
            let mut runs: Vec<(u64, usize)> = Vec::new();
            for (number, instance) in instances.iter().enumerate() {
                let declared = self.declared.sources[instance.source].tree.instances[instance.index as usize];
                let priority = declared.task.map(|task| {
                    let name = folded(self.declared.word(instance.source, task));
                    tasks
                        .get(&(instance.resource.clone().map(|it| folded(&it)), name))
                        .map_or(u64::MAX - 1, |it| it.1)
                });
                runs.push((priority.unwrap_or(u64::MAX), number));
            }
            runs.sort_by_key(|(priority, _)| *priority);
            for (_, number) in runs {
                self.configured(&instances[number], &tasks);
            }
        }
        self.builder.op(Op::End);
    }

    /// The tasks, by resource and name: the relay that is on while one runs, and its priority.
    fn tasks(&mut self) -> Tasks {
        let mut tasks = Tasks::default();
        for one in std::mem::take(&mut self.declared.tasks) {
            let task = self.declared.sources[one.source].tree.tasks[one.index as usize];
            let place = self.declared.place(one.source, one.span);
            let name =
                task.name.map_or(SmolStr::default(), |name| folded(self.declared.word(one.source, name)));
            let interval = task.interval.map(|id| self.declared.sources[one.source].tree.operand(id).value);
            let interval_ns = match interval {
                Some(Operand::Literal(literal)) => match literal.value {
                    LiteralValue::Time(time) => (time > 0).then_some(time),
                    _ => None,
                },
                None => None,
                Some(_) => {
                    self.refuse(place, Obstacle::Iec(Message::new("simulate.interval")));
                    None
                }
            };
            let single = task.single.map(|id| self.declared.operand(one.source, id).to_string());
            let single = single.and_then(|word| match self.global_spot(&word) {
                Some(spot) if spot.kind == ElementaryType::Bool => Some((spot, self.builder.kept())),
                _ => {
                    self.refuse(place, Obstacle::Iec(Message::new("simulate.undeclared").with("name", word)));
                    None
                }
            });
            let priority = task.priority.and_then(|id| self.declared.operand(one.source, id).parse().ok());
            let (next, due) = (self.builder.words(1), self.builder.kept());
            let number = self.parts.tasks.len() as u32;
            self.parts.tasks.push(Task { interval_ns, next, single, due });
            self.builder.at(place, 0);
            self.builder.op(Op::Task(number));
            let resource = one.resource.map(|it| folded(&it));
            tasks.insert((resource, name), (due, priority.unwrap_or(0)));
        }
        tasks
    }

    /// A PROGRAM of a configuration.
    fn configured(&mut self, instance: &Configured, tasks: &Tasks) {
        let tree = self.declared.sources[instance.source].tree;
        let declared = tree.instances[instance.index as usize];
        let place = self.declared.place(instance.source, instance.span);
        let word = |span: Option<Span>| span.map(|span| self.declared.word(instance.source, span));
        let (name, program, task) = (word(declared.name), word(declared.program), word(declared.task));
        let unit = program.and_then(|program| self.declared.unit(program, PouKind::Program));
        let Some(unit) = unit else {
            let message = Message::new("simulate.no-unit").with("name", program.unwrap_or_default());
            return self.refuse(place, Obstacle::Iec(message));
        };
        let power = match task {
            None => Row::RAIL,
            Some(task) => match tasks.get(&(instance.resource.as_deref().map(folded), folded(task))) {
                Some((due, _)) => *due,
                None => {
                    let message = Message::new("simulate.no-unit").with("name", task);
                    return self.refuse(place, Obstacle::Iec(message));
                }
            },
        };
        if !declared.parameters.is_empty() || !declared.block_tasks.is_empty() {
            return self.refuse(place, Obstacle::Iec(Message::new("simulate.program-parameters")));
        }
        let path = instance.resource.iter().cloned().chain(name.map(SmolStr::from)).collect();
        if let Some(variable) = self.instance(unit, path) {
            self.builder.at(place, 0);
            self.builder.rung();
            self.enter(unit, &variable, Vec::new(), power, place);
        }
    }

    /// The variables of a program.
    fn instance(&mut self, unit: usize, path: Vec<SmolStr>) -> Option<Variable> {
        let record = self.record(unit);
        let base = self.take(record.size);
        let variable = Variable::new(Kind::Record(record), base);
        self.initial_of_variable(0, &variable, None, false);
        self.name_located(&path, &variable);
        self.parts.names.add_program(path, &variable);
        Some(variable)
    }

    /// Names the variables of a program that lie at addresses.
    fn name_located(&mut self, path: &[SmolStr], variable: &Variable) {
        let Kind::Record(record) = variable.kind.clone() else { return };
        for field in &record.fields {
            let Some(address) = field.address else { continue };
            match self.located(address, &field.kind) {
                Ok(place) => {
                    let path = path.iter().cloned().chain([field.name.clone()]).collect();
                    self.parts.names.add(path, &place);
                }
                Err(obstacle) => {
                    let place = field.declared.map(|at| {
                        let span = self.declared.declaration(at.source, at.index).span;
                        self.declared.place(at.source, span)
                    });
                    self.refuse(place.unwrap_or(Place::START), obstacle);
                }
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
        let super::place::At::Memory(base) = variable.at else { return };
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
        let (inputs, kinds) = inputs.into_iter().unzip();
        let number = self.parts.computings.len() as u32;
        self.parts.computings.push(Computing { formula, inputs, kinds, result, to, ok });
        self.builder.op(Op::Compute { power, number });
    }

    /// Copies an elementary value.
    pub(super) fn copy(&mut self, from: Input, kind: ElementaryType, to: Spot) {
        self.compute(copied, vec![(from, kind)], to.kind, to);
    }

    fn global_spot(&mut self, word: &str) -> Option<Spot> {
        if let Operand::Direct(address) = Operand::read(word, crate::target::Model::Iec) {
            let kind = super::image::kind_of(address.width);
            return self.located(address, &Kind::of(kind)).ok()?.spot();
        }
        self.globals.get(&folded(word))?.spot()
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
            self.problems.sort_by_key(|problem| problem.place);
            self.problems.dedup();
            return Err(self.problems);
        }
        self.parts.names.finish(self.image);
        let mut code =
            self.builder.finish().map_err(|obstacle| vec![Problem { place: Place::START, obstacle }])?;
        if code.slots > MOST_WORDS || self.parts.texts > MOST_WORDS {
            return Err(vec![Problem { place: Place::START, obstacle: Obstacle::TooLarge }]);
        }
        code.iec = self.parts;
        Ok(code)
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

type Tasks = FxHashMap<(Option<SmolStr>, SmolStr), (Cell, u64)>;

/// More words than that are refused.
const MOST_WORDS: usize = 1 << 24;

/// The formula of a copy.
pub(super) fn copied(inputs: &crate::target::iec::Inputs<'_>) -> Result<Datum, crate::target::Fault> {
    inputs.values.first().cloned().ok_or(crate::target::Fault::Value(0))
}

/// Whether the callers of a unit see its variables of a section.
pub(super) fn is_input(section: SectionKind) -> bool {
    matches!(section, SectionKind::Input | SectionKind::InOut)
}
