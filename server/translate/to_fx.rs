//! Writes a path of power as FX instruction list, in as few steps as its order of contacts and outputs allows.
//!
//! A contact costs its own instruction in any place, normally open or closed: contacts are turned over where that saves
//! an inverter. Joining costs an instruction more for each connection that is not the first part of the one around it,
//! and branching one for each conditional path behind which the power is wanted again; the exhaustive search in the
//! tests finds no shorter list.

use super::stack::{self, Moves, Wants};
use crate::document::coil_form;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{
    Action, Comparison, Contact, Deed, Drive, Expression, Formulas, Gate, Path, Term, Test, compare,
};
use crate::target::{Device, Form, Limits, Role, Target};
use crate::text::{Message, Span};
use std::borrow::Cow;
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
    let mut writer = Writer { lines: Vec::new(), branches: 0, limits: target.limits };
    paths.iter().try_for_each(|path| writer.path(&path.gates, &path.drives, true))?;
    Ok(writer.lines)
}

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
    /// How many powers are kept on the branch stack.
    branches: u32,
    limits: Limits,
}

impl Writer {
    /// `is_first` if nothing is loaded yet.
    fn path(&mut self, gates: &[Gate], drives: &[Drive], is_first: bool) -> Result<(), Message> {
        let mut is_first = is_first;
        let (gates, is_inverted) = inverters(gates, <[Gate]>::split_last);
        let mut stops = Vec::with_capacity(drives.len());
        add_stops(drives, is_inverted, &mut stops);
        let mut wanted: Vec<Wants> = stops.iter().map(|stop| stop.wants).collect();
        let (mut front, gates) = if is_first { front(gates, &wanted) } else { (None, gates) };
        let may_turn = front.is_some() && gates.is_empty();
        // What the first output wants is the power, so that a list does not depend on how its contacts were turned.
        if may_turn && wanted.first().is_some_and(|wants| wants.inverse) {
            wanted.iter_mut().for_each(|wants| wants.inverse = !wants.inverse);
            front = front.map(|front| front.negated());
        }
        let moves = stack::moves(&wanted, may_turn);
        if let Some(front) = front {
            self.pass(&if moves.is_turned { front.negated() } else { front }, true)?;
            is_first = false;
        }
        // Behind a step there is no current result: outputs may follow, and contacts begin anew.
        let mut is_at_step = false;
        for gate in gates {
            match gate {
                Gate::Pass(expression) => self.pass(expression, is_first || is_at_step)?,
                Gate::Invert if is_at_step => return Err(Message::new("translate.step-branch")),
                Gate::Invert => self.bare("INV")?,
                Gate::Through(action) => self.action(action)?,
            }
            is_at_step = matches!(gate, Gate::Through(action) if is_step(action));
            is_first = false;
        }
        if is_at_step && wanted.iter().any(|wants| wants.inverse || wants.for_good) {
            return Err(Message::new("translate.step-branch"));
        }
        if is_first {
            return drives.iter().try_for_each(|drive| match drive {
                Drive::Action(action) if action.deed.stands_alone() => self.action(action),
                Drive::Action(_) => Err(Message::new("translate.no-condition")),
                // What begins at the left rail is a rung of its own.
                Drive::Path(path) => self.path(&path.gates, &path.drives, true),
            });
        }
        self.drives(&stops, moves)
    }

    fn pass(&mut self, expression: &Expression, is_first: bool) -> Result<(), Message> {
        let ways = self.limits.blocks as usize - usize::from(!is_first);
        let expression = within_blocks(expression, ways.max(1))?;
        self.expression(&expression, if is_first { Role::Load } else { Role::Series })
    }

    fn drives(&mut self, stops: &[Stop<'_>], moves: Moves) -> Result<(), Message> {
        for (stop, moves) in stops.iter().zip(moves.before) {
            for mnemonic in moves {
                self.bare(mnemonic)?;
                match mnemonic {
                    "MPS" => self.branches += 1,
                    "MPP" => self.branches -= 1,
                    _ => {}
                }
                if self.branches > self.limits.branches {
                    return Err(Message::new(TOO_MANY_BRANCHES).with("limit", self.limits.branches));
                }
            }
            match stop.drive {
                Drive::Action(action) => self.action(action)?,
                Drive::Path(path) => self.path(stop.gates, &path.drives, false)?,
            }
        }
        Ok(())
    }

    /// Writes `expression` as `role` says: as a block of its own, or joined with the current result.
    fn expression(&mut self, expression: &Expression, role: Role) -> Result<(), Message> {
        match (expression, role) {
            (Expression::Contact(contact), _) => self.contact(contact, role),
            (Expression::Constant(value), _) => self.contact(&always(*value), role),
            (Expression::And(parts), Role::Series) | (Expression::Or(parts), Role::Parallel) => {
                parts.iter().try_for_each(|part| self.expression(part, role))
            }
            (Expression::And(parts) | Expression::Or(parts), Role::Load) => {
                let joined =
                    if matches!(expression, Expression::And(_)) { Role::Series } else { Role::Parallel };
                parts.iter().enumerate().try_for_each(|(number, part)| {
                    self.expression(part, if number == 0 { Role::Load } else { joined })
                })
            }
            (Expression::Not(part), _) if is_turnable(part) => self.expression(&part.negated(), role),
            (Expression::Not(part), Role::Load) => {
                self.expression(part, Role::Load)?;
                self.bare("INV")
            }
            (_, Role::Series) => {
                self.expression(expression, Role::Load)?;
                self.bare("ANB")
            }
            _ => {
                self.expression(expression, Role::Load)?;
                self.bare("ORB")
            }
        }
    }

    fn contact(&mut self, contact: &Contact, role: Role) -> Result<(), Message> {
        let form = contact.test.form().and_then(|load| load.placed(role));
        let form = form.ok_or_else(|| Message::new("translate.no-instruction"))?;
        self.lines.push(Line { form, terms: contact.terms.clone() });
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

/// The contacts at the left rail together with the inverters behind them, where turning these contacts over saves
/// inverters; and the gates that are left.
fn front<'g>(gates: &'g [Gate], wanted: &[Wants]) -> (Option<Expression>, &'g [Gate]) {
    let [Gate::Pass(expression), behind @ ..] = gates else { return (None, gates) };
    let (left, inverts) = inverters(behind, <[Gate]>::split_first);
    let wants_inverse = wanted.iter().any(|wants| wants.inverse);
    if left.len() == behind.len() && !wants_inverse || !is_turnable(expression) {
        return (None, gates);
    }
    (Some(if inverts { expression.negated() } else { expression.clone() }), left)
}

fn is_step(action: &Action) -> bool {
    matches!(action.deed, Deed::Instruction(form) if form.instruction.role == Role::StepLoad)
}

/// Whether there is an inverse instruction for each contact; edges have none.
fn is_turnable(expression: &Expression) -> bool {
    match expression {
        Expression::Constant(_) => true,
        Expression::Contact(contact) => contact.test.opposite().is_some(),
        Expression::Not(_) => false,
        Expression::And(parts) | Expression::Or(parts) => parts.iter().all(is_turnable),
    }
}

/// Something that the power behind the gates of a path comes to.
struct Stop<'p> {
    wants: Wants,
    drive: &'p Drive,
    /// What power passes before the outputs of a conditional path, but for the inverters that `wants` tells of.
    gates: &'p [Gate],
}

/// What power comes to behind the gates of a path. Paths that are but inverters are passed over: what they drive wants
/// the inverse.
fn add_stops<'p>(drives: &'p [Drive], is_inverted: bool, stops: &mut Vec<Stop<'p>>) {
    for drive in drives {
        match drive {
            Drive::Action(action) => {
                let inverse = is_inverted != (action.deed == Deed::Coil(CoilKind::Negated));
                stops.push(Stop { wants: Wants { inverse, for_good: false }, drive, gates: &[] });
            }
            Drive::Path(path) => {
                let (gates, turns) = inverters(&path.gates, <[Gate]>::split_first);
                let inverse = is_inverted != turns;
                match gates.is_empty() {
                    true => add_stops(&path.drives, inverse, stops),
                    false => stops.push(Stop { wants: Wants { inverse, for_good: true }, drive, gates }),
                }
            }
        }
    }
}

/// `gates` without the inverters at the end where `split` takes one off, and whether these invert.
fn inverters<'g>(
    mut gates: &'g [Gate],
    split: impl Fn(&'g [Gate]) -> Option<(&'g Gate, &'g [Gate])>,
) -> (&'g [Gate], bool) {
    let mut inverts = false;
    while let Some((Gate::Invert, rest)) = split(gates) {
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

/// `expression`, with its parts in such an order that at most `most` blocks are open at a time. The drawn order stays
/// where it can.
fn within_blocks(expression: &Expression, most: usize) -> Result<Cow<'_, Expression>, Message> {
    if blocks(expression) <= most {
        return Ok(Cow::Borrowed(expression));
    }
    let sorted = deepest_first(expression);
    match blocks(&sorted) <= most {
        true => Ok(Cow::Owned(sorted)),
        false => Err(Message::new("translate.blocks").with("limit", most)),
    }
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

fn deepest_first(expression: &Expression) -> Expression {
    let sorted = |parts: &[Expression]| {
        let mut parts: Vec<Expression> = parts.iter().map(deepest_first).collect();
        let deepest = (0..parts.len()).max_by_key(|number| (blocks(&parts[*number]), usize::MAX - number));
        let first = parts.remove(deepest.unwrap_or(0));
        parts.insert(0, first);
        parts
    };
    match expression {
        Expression::And(parts) => Expression::And(sorted(parts)),
        Expression::Or(parts) => Expression::Or(sorted(parts)),
        Expression::Not(part) => Expression::Not(Box::new(deepest_first(part))),
        leaf => leaf.clone(),
    }
}
