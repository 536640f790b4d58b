//! What a configuration says: which programs run in which tasks, what they are connected with, and where variables of
//! instances lie.

use super::arguments::Arguments;
use super::compile::{Compiler, is_input};
use super::declarations::Configured;
use super::kind::{Declared, Kind, RecordKind};
use super::operand::{Value, said};
use super::parts::{Spot, Task};
use super::place::{At, Place as Variable};
use crate::il::iec::{Direction, ParameterValue, PouKind, SectionKind};
use crate::simulate::Obstacle;
use crate::simulate::code::{Op, Place};
use crate::simulate::row::{Cell, Row};
use crate::target::iec::{ElementaryType, LiteralValue};
use crate::target::{DirectAddress, Operand};
use crate::text::{Message, Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// The tasks, by resource and name: the relay that is on while one runs, and its priority.
type Tasks = FxHashMap<(Option<SmolStr>, SmolStr), (Cell, u64)>;

impl Compiler<'_> {
    /// What runs in a scan: programs with tasks by priority, then those without.
    pub(super) fn main(&mut self) {
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
        for (source, index) in std::mem::take(&mut self.declared.configs) {
            let declaration = self.declared.declaration(source, index);
            let place = self.declared.place(source, declaration.span);
            let path = declaration.path.map_or("", |path| self.declared.word(source, path));
            self.refuse(place, said("simulate.undeclared", path));
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
            // What is never on starts nothing.
            let is_never =
                |word: &String| ["FALSE", "BOOL#FALSE", "0"].contains(&word.to_uppercase().as_str());
            let single =
                single.filter(|word| !is_never(word)).and_then(|word| match self.global_spot(&word) {
                    Some(spot) if spot.kind == ElementaryType::Bool => Some((spot, self.builder.kept())),
                    _ => {
                        self.refuse(
                            place,
                            Obstacle::Iec(Message::new("simulate.undeclared").with("name", word)),
                        );
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

    fn global_spot(&mut self, word: &str) -> Option<Spot> {
        match self.value(word) {
            Ok(Value::Variable(variable)) => variable.spot(),
            _ => None,
        }
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
        if let Some(block) = declared.block_tasks.of(&tree.names).first() {
            let name = self.declared.word(instance.source, *block);
            let place = self.declared.place(instance.source, *block);
            return self.refuse(place, said("simulate.block-tasks", name));
        }
        let path = instance.resource.iter().cloned().chain(name.map(SmolStr::from)).collect();
        if let Some(variable) = self.instance(unit, path) {
            self.builder.at(place, 0);
            self.builder.rung();
            if let Err(obstacle) = self.connected(unit, &variable, instance, power, place) {
                self.refuse(place, obstacle);
            }
        }
    }

    /// Runs a program with what goes in before and what comes out behind it.
    fn connected(
        &mut self,
        unit: usize,
        variable: &Variable,
        instance: &Configured,
        power: Cell,
        place: Place,
    ) -> Result<(), Obstacle> {
        let tree = self.declared.sources[instance.source].tree;
        let parameters = tree.instances[instance.index as usize].parameters.of(&tree.parameters);
        if parameters.is_empty() {
            self.enter(unit, variable, Vec::new(), power, place);
            return Ok(());
        }
        let Kind::Record(record) = variable.kind.clone() else { return Err(Obstacle::Unreadable) };
        let due = (power != Row::RAIL).then_some(power);
        self.enabled(due, |own| {
            let mut arguments = Arguments::default();
            for parameter in parameters {
                let (Some(name), ParameterValue::Operand(id)) = (parameter.name, parameter.value) else {
                    return Err(Obstacle::Unreadable);
                };
                let name: SmolStr = own.declared.word(instance.source, name).into();
                let word = own.declared.operand(instance.source, id);
                let section = record.field(&name).map(|field| field.section);
                match parameter.direction {
                    Direction::Out { negated } => arguments.outputs.push((name, word.to_string(), negated)),
                    Direction::In if section == Some(SectionKind::InOut) => {
                        arguments.in_out.push((name, word.to_string()));
                    }
                    Direction::In if section.is_some_and(is_input) => match own.whole(word)? {
                        Some(whole) => arguments.wholes.push((name, whole)),
                        None => {
                            let given = own.given(word)?;
                            arguments.inputs.push((name, given));
                        }
                    },
                    Direction::In => return Err(said("simulate.no-member", &name)),
                }
            }
            let aliases = own.handed_over(variable, &mut arguments)?;
            own.enter(unit, variable, aliases, Row::RAIL, place);
            own.taken_over(variable, arguments.outputs)
        })
    }

    /// The variables of a program.
    fn instance(&mut self, unit: usize, path: Vec<SmolStr>) -> Option<Variable> {
        let record = self.record(unit);
        let base = self.take(record.size);
        let variable = Variable::new(Kind::Record(record), base);
        let bound = self.bind(&path, &variable);
        self.initial_of_variable(0, &variable, None, false);
        for (variable, declared) in bound {
            self.initial_of_variable(0, &variable, Some(declared), false);
        }
        self.name_located(&path, &variable);
        self.parts.names.add_program(path, &variable);
        Some(variable)
    }

    /// Names the variables of a program that lie at addresses.
    fn name_located(&mut self, path: &[SmolStr], variable: &Variable) {
        let Kind::Record(record) = variable.kind.clone() else { return };
        let unit = match record.what {
            RecordKind::Unit(unit) => Some(unit),
            _ => None,
        };
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
                    self.refused.insert((unit, folded(&field.name)));
                }
            }
        }
    }

    /// Lays variables of an instance where VAR_CONFIG says. Gives those that it gives a value at first.
    fn bind(&mut self, path: &[SmolStr], variable: &Variable) -> Vec<(Variable, Declared)> {
        let mut found = Vec::new();
        for (source, index) in std::mem::take(&mut self.declared.configs) {
            let declaration = self.declared.declaration(source, index);
            let words = declaration.path.map_or("", |path| self.declared.word(source, path));
            let steps: Vec<SmolStr> = words.split('.').map(|step| folded(step.trim())).collect();
            let own: Vec<SmolStr> = path.iter().map(|step| folded(step)).collect();
            let Some(steps) = steps.strip_prefix(&own[..]) else {
                self.declared.configs.push((source, index));
                continue;
            };
            let place = self.declared.place(source, declaration.span);
            let address =
                match declaration.address.map(|id| self.declared.sources[source].tree.operand(id).value) {
                    Some(Operand::Direct(address)) => Some(address),
                    _ => None,
                };
            match self.laid(variable, steps, address) {
                Ok(variable) => {
                    if declaration.initial.is_some() {
                        found.push((variable, Declared { source, index }));
                    }
                }
                Err(obstacle) => self.refuse(place, obstacle),
            }
        }
        found
    }

    /// The variable of an instance at these steps, at the address that it gets.
    fn laid(
        &mut self,
        instance: &Variable,
        steps: &[SmolStr],
        address: Option<DirectAddress>,
    ) -> Result<Variable, Obstacle> {
        let path: String = steps.iter().map(|step| format!(".{step}")).collect();
        let variable = self.within(instance.clone(), &path)?;
        if variable.index != 0 {
            return Err(Obstacle::Unreadable);
        }
        let Some(address) = address else { return Ok(variable) };
        let At::Memory(at) = variable.at else { return Err(Obstacle::Unreadable) };
        let located = self.located(address, &variable.kind)?;
        if variable.kind.elementary().is_none() {
            return Err(said("simulate.not-elementary", &steps.join(".")));
        }
        self.rebound.insert(at, located.clone());
        Ok(located)
    }
}
