//! Writes a path of power as FX instruction list, in as few steps as its order of contacts and outputs allows.
//!
//! A contact costs its own instruction in any place, normally open or closed: contacts are turned over where that saves
//! an inverter, see `turning`. Joining costs an instruction more for each connection that is not the first part of the
//! one around it, and branching one for each conditional path behind which the power is wanted again, see `stack`; the
//! exhaustive search in the tests finds no shorter list.

use super::stack::{self, Moves, NEVER, Wants};
use super::turning::{Chain, Joins, Sense, Turns, Writes};
use crate::document::coil_form;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{
    Action, Comparison, Contact, Deed, Drive, Expression, Formulas, Gate, Path, Term, Test, compare,
};
use crate::target::{Device, Form, Limits, Role, Target};
use crate::text::{Message, Span};
use std::fmt;

/// An instruction with its operands.
#[derive(Clone, Debug)]
pub struct Line {
    /// The instruction.
    pub form: Form,
    /// Its operands in order.
    pub terms: Vec<Term>,
}

impl Line {
    /// The program steps that it takes.
    pub fn steps(&self) -> u32 {
        self.form.steps(self.terms.first().map(|term| term.operand).as_slice())
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.form.mnemonic())?;
        self.terms.iter().try_for_each(|term| write!(f, " {term}"))
    }
}

/// The instructions of `path`, or why there are none for it on `target`.
///
/// What branches deeper than the target keeps powers is written output by output, where that is proved to be the same.
pub fn lines(path: &Path, target: &Target) -> Result<Vec<Line>, Message> {
    let reason = match written(std::slice::from_ref(path), target) {
        Err(reason) if reason.key() == TOO_MANY_BRANCHES => reason,
        written => return written,
    };
    let mut single = Vec::new();
    one_by_one(path, &mut Vec::new(), &mut single).ok_or_else(|| reason.clone())?;
    let all: Vec<&Path> = single.iter().collect();
    match compare(&[path], &all, &mut Formulas::default()) {
        Comparison::Same { .. } => written(&single, target),
        _ => Err(reason),
    }
}

const TOO_MANY_BRANCHES: &str = "translate.branches";

fn written(paths: &[Path], target: &Target) -> Result<Vec<Line>, Message> {
    let write = |paths: &[Path]| -> Result<Vec<Line>, Message> {
        let mut writer = Writer { lines: Vec::new(), blocks: 0, branches: 0, limits: target.limits };
        paths.iter().try_for_each(|path| writer.rung(path))?;
        Ok(writer.lines)
    };
    match write(paths) {
        // The drawn order stays where it can.
        Err(reason) if reason.key() == TOO_MANY_BLOCKS => {
            write(&paths.iter().map(deepest_first).collect::<Vec<_>>()).map_err(|_| reason)
        }
        written => written,
    }
}

const TOO_MANY_BLOCKS: &str = "translate.blocks";

/// A path for each output, with all that leads to it; nothing where power goes through something on the way.
fn one_by_one(path: &Path, before: &mut Vec<Gate>, found: &mut Vec<Path>) -> Option<()> {
    if path.gates.iter().any(|gate| matches!(gate, Gate::Through(_))) {
        return None;
    }
    let start = before.len();
    before.extend(path.gates.iter().cloned());
    for drive in &path.drives {
        match drive {
            Drive::Action(_) => found.push(Path { gates: before.clone(), drives: vec![drive.clone()] }),
            Drive::Path(path) => one_by_one(path, before, found)?,
        }
    }
    before.truncate(start);
    Some(())
}

/// `lines`, if `target` has all of their instructions and devices; else what it lacks.
pub fn on_model(lines: Vec<Line>, target: &Target) -> Result<Vec<Line>, Message> {
    let lacks = |word: &dyn fmt::Display| {
        Message::new("translate.model-lacks").with("word", word).with("model", target.title)
    };
    for Line { form, terms } in &lines {
        if !form.is_on(target.model) {
            return Err(lacks(&form.mnemonic()));
        }
        for (place, term) in terms.iter().enumerate() {
            let device = term.operand.device();
            let is_there = device.is_none_or(|device| device.range_on(target).is_some());
            if !is_there || !form.takes(place, &term.operand, target.model) {
                return Err(lacks(term));
            }
        }
    }
    Ok(lines)
}

struct Writer {
    lines: Vec<Line>,
    /// How many blocks are open.
    blocks: u32,
    /// How many powers are kept on the branch stack.
    branches: u32,
    limits: Limits,
}

/// A path with the fewest instructions for it, behind either sense of the power that it leaves.
struct Plan<'p> {
    /// Up to the last gate that is no condition.
    head: &'p [Gate],
    /// What is asked behind that, for each sense of the power before it; nothing where there is no current result.
    ways: Vec<(Turns<'p>, Moves)>,
    stops: Vec<Stop<'p>>,
    /// What the first drive gets is called the power, so that a list does not depend on how its contacts were turned.
    is_turned: bool,
}

impl<'p> Plan<'p> {
    /// `is_first` if nothing is loaded before `gates`.
    fn of(gates: &'p [Gate], drives: &'p [Drive], is_first: bool) -> Plan<'p> {
        let through = gates.iter().rposition(|gate| matches!(gate, Gate::Through(_)));
        let (head, gates) = gates.split_at(through.map_or(0, |last| last + 1));
        let begins = match head.last() {
            Some(Gate::Through(action)) => is_step(action),
            _ => is_first,
        };
        let mut stops = Vec::with_capacity(drives.len());
        let is_empty = begins && !matches!(gates.first(), Some(Gate::Pass(_)));
        add_stops(drives, is_empty && head.is_empty(), is_empty && !gates.is_empty(), &mut stops);
        if is_empty {
            return Plan { head, ways: Vec::new(), stops, is_turned: false };
        }
        let is_turned = stops.first().is_some_and(|stop| stop.is_inverse);
        let wanted: Vec<Wants> = stops.iter().map(|stop| stop.wants(is_turned)).collect();
        // Behind nothing there is but one way, and what decides by itself whether power goes on takes no inverse.
        let senses = if begins || !head.is_empty() { 1 } else { 2 };
        let ways = (0..senses).map(|before: Sense| {
            let mut costs = [NEVER; 2];
            costs[before] = 0;
            let turns = Turns::of(Chain::of(gates, begins), (!begins).then_some(costs));
            let [power, inverse] = turns.costs;
            let moves = stack::moves(&wanted, if is_turned { [inverse, power] } else { [power, inverse] });
            (turns, moves)
        });
        Plan { head, ways: ways.collect(), stops, is_turned }
    }

    /// What it costs behind the power, and behind the inverse of that.
    fn costs(&self) -> [usize; 2] {
        let cost = |sense: Sense| self.ways.get(sense).map_or(NEVER, |(_, moves)| moves.cost.min(NEVER));
        if self.ways.is_empty() { [0, NEVER] } else { [cost(0), cost(1)] }
    }
}

impl Writer {
    fn rung(&mut self, path: &Path) -> Result<(), Message> {
        self.blocks = 0;
        self.path(&Plan::of(&path.gates, &path.drives, true), None)
    }

    /// Writes what `plan` says behind this sense of the power that it leaves, if there is any.
    fn path(&mut self, plan: &Plan<'_>, before: Option<Sense>) -> Result<(), Message> {
        let mut is_first = before.is_none();
        for gate in plan.head {
            match gate {
                Gate::Pass(expression) => {
                    let gates = [Gate::Pass(expression.clone())];
                    let before = (!is_first).then_some([0, NEVER]);
                    Turns::of(Chain::of(&gates, is_first), before).write(
                        0,
                        (!is_first).then_some(0),
                        self,
                    )?;
                }
                Gate::Invert => self.bare("INV")?,
                Gate::Through(action) => self.action(action)?,
            }
            // Behind a step there is no current result: outputs may follow, and contacts begin anew.
            is_first = matches!(gate, Gate::Through(action) if is_step(action));
            if is_first {
                self.blocks = 0;
            }
        }
        let Some((turns, moves)) = plan.ways.get(before.unwrap_or(0)) else {
            return self.without_condition(plan);
        };
        let sense = usize::from(moves.is_turned != plan.is_turned);
        turns.write(sense, (!is_first).then_some(before.unwrap_or(0)), self)?;
        for (stop, (mnemonics, is_inverse)) in plan.stops.iter().zip(&moves.before) {
            for mnemonic in *mnemonics {
                self.bare(mnemonic)?;
                match *mnemonic {
                    "MPS" => self.branches += 1,
                    "MPP" => self.branches -= 1,
                    _ => {}
                }
                if self.branches > self.limits.branches {
                    return Err(Message::new(TOO_MANY_BRANCHES).with("limit", self.limits.branches));
                }
            }
            let sense = usize::from(*is_inverse != (plan.is_turned != stop.is_inverse));
            match &stop.drive {
                Driven::Action(action) => self.action(action)?,
                Driven::Path(plan) => self.path(plan, Some(sense))?,
            }
        }
        Ok(())
    }

    /// Writes the drives of a path that asks for nothing: behind a step, or at the left rail.
    fn without_condition(&mut self, plan: &Plan<'_>) -> Result<(), Message> {
        let is_at_step = !plan.head.is_empty();
        for stop in &plan.stops {
            match &stop.drive {
                Driven::Action(action) if is_at_step && !stop.is_inverse => self.action(action)?,
                _ if is_at_step => return Err(Message::new("translate.step-branch")),
                Driven::Action(action) if action.deed.stands_alone() => self.action(action)?,
                Driven::Action(_) => return Err(Message::new("translate.no-condition")),
                // What begins at the left rail is a rung of its own.
                Driven::Path(plan) => {
                    self.blocks = 0;
                    self.path(plan, None)?;
                }
            }
        }
        Ok(())
    }

    fn action(&mut self, action: &Action) -> Result<(), Message> {
        let form = match action.deed {
            Deed::Coil(kind) => coil_form(kind),
            Deed::Instruction(form) => Some(form),
            Deed::Call(_) | Deed::Compute(_) | Deed::Jump | Deed::Return => None,
        };
        let form = form.ok_or_else(|| Message::new("translate.no-instruction"))?;
        self.lines.push(Line { form, terms: action.terms.clone() });
        Ok(())
    }

    fn bare(&mut self, mnemonic: &str) -> Result<(), Message> {
        let form = Form::named(mnemonic).ok_or_else(|| Message::new("translate.no-instruction"))?;
        self.lines.push(Line { form, terms: Vec::new() });
        Ok(())
    }
}

impl Writes for Writer {
    type Error = Message;

    fn contact(&mut self, contact: &Contact, is_opposite: bool, joins: Joins) -> Result<(), Message> {
        let role = match joins {
            Joins::Loaded => Role::Load,
            Joins::InSeries => Role::Series,
            Joins::InParallel => Role::Parallel,
        };
        if role == Role::Load {
            self.blocks += 1;
            if self.blocks > self.limits.blocks {
                return Err(Message::new(TOO_MANY_BLOCKS).with("limit", self.limits.blocks));
            }
        }
        let test = if is_opposite { contact.test.opposite() } else { Some(contact.test) };
        let form = test.and_then(Test::form).and_then(|load| load.placed(role));
        let form = form.ok_or_else(|| Message::new("translate.no-instruction"))?;
        self.lines.push(Line { form, terms: contact.terms.clone() });
        Ok(())
    }

    fn join(&mut self, in_series: bool) -> Result<(), Message> {
        self.blocks -= 1;
        self.bare(if in_series { "ANB" } else { "ORB" })
    }

    fn invert(&mut self) -> Result<(), Message> {
        self.bare("INV")
    }
}

fn is_step(action: &Action) -> bool {
    matches!(action.deed, Deed::Instruction(form) if form.instruction.role == Role::StepLoad)
}

/// Something that the power behind the gates of a path comes to.
struct Stop<'p> {
    drive: Driven<'p>,
    /// It stands behind inverters, and so wants the inverse.
    is_inverse: bool,
}

enum Driven<'p> {
    Action(&'p Action),
    Path(Box<Plan<'p>>),
}

impl Stop<'_> {
    /// What it wants; of the inverse of the power if `is_turned`.
    fn wants(&self, is_turned: bool) -> Wants {
        let [power, inverse] = match &self.drive {
            Driven::Action(_) => [0, NEVER],
            Driven::Path(plan) => plan.costs(),
        };
        let costs = if self.is_inverse == is_turned { [power, inverse] } else { [inverse, power] };
        Wants { costs, for_good: matches!(self.drive, Driven::Path(_)) }
    }
}

/// What power comes to behind the gates of a path, which loads nothing if `is_first`. Paths that are but inverters are
/// passed over: what they drive wants the inverse.
fn add_stops<'p>(drives: &'p [Drive], is_first: bool, is_inverse: bool, stops: &mut Vec<Stop<'p>>) {
    for drive in drives {
        match drive {
            Drive::Action(action) => {
                let is_inverse = is_inverse != (action.deed == Deed::Coil(CoilKind::Negated));
                stops.push(Stop { drive: Driven::Action(action), is_inverse });
            }
            Drive::Path(path) => {
                let (gates, turns) = inverters(&path.gates);
                let is_inverse = is_inverse != turns;
                match gates.is_empty() {
                    true => add_stops(&path.drives, is_first, is_inverse, stops),
                    false => {
                        let plan = Plan::of(gates, &path.drives, is_first);
                        stops.push(Stop { drive: Driven::Path(Box::new(plan)), is_inverse });
                    }
                }
            }
        }
    }
}

/// `gates` without the inverters before them, and whether these invert.
fn inverters(mut gates: &[Gate]) -> (&[Gate], bool) {
    let mut inverts = false;
    while let [Gate::Invert, rest @ ..] = gates {
        (gates, inverts) = (rest, !inverts);
    }
    (gates, inverts)
}

/// The contact that is on in each scan of a running FX PLC, M8000, or closed instead of open, so that it never is.
pub(super) fn always(value: bool) -> Contact {
    let kind = if value { ContactKind::NormallyOpen } else { ContactKind::NormallyClosed };
    Contact {
        test: Test::Bit(kind),
        terms: vec![Term::of_device(Device::ALWAYS_ON, Span::default())],
        span: Span::default(),
    }
}

/// `path` with the parts of its conditions in such an order that the fewest blocks are open at a time.
fn deepest_first(path: &Path) -> Path {
    let gates = path.gates.iter().map(|gate| match gate {
        Gate::Pass(expression) => Gate::Pass(sorted(expression)),
        gate => gate.clone(),
    });
    let drives = path.drives.iter().map(|drive| match drive {
        Drive::Path(path) => Drive::Path(deepest_first(path)),
        drive => drive.clone(),
    });
    Path { gates: gates.collect(), drives: drives.collect() }
}

/// How many blocks are open at a time when `expression` is written as a block.
fn blocks(expression: &Expression) -> usize {
    match expression {
        Expression::Contact(_) | Expression::Constant(_) => 1,
        Expression::Not(part) => blocks(part),
        Expression::And(parts) | Expression::Or(parts) => {
            let open = parts.iter().enumerate().map(|(number, part)| match part {
                Expression::Contact(_) | Expression::Constant(_) => 1,
                part => blocks(part) + usize::from(number > 0),
            });
            open.max().unwrap_or(1)
        }
    }
}

fn sorted(expression: &Expression) -> Expression {
    let all = |parts: &[Expression]| {
        let mut parts: Vec<Expression> = parts.iter().map(sorted).collect();
        let deepest = (0..parts.len()).max_by_key(|number| (blocks(&parts[*number]), usize::MAX - number));
        let first = parts.remove(deepest.unwrap_or(0));
        parts.insert(0, first);
        parts
    };
    match expression {
        Expression::And(parts) => Expression::And(all(parts)),
        Expression::Or(parts) => Expression::Or(all(parts)),
        Expression::Not(part) => Expression::Not(Box::new(sorted(part))),
        leaf => leaf.clone(),
    }
}
