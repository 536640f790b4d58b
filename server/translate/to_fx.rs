//! Writes a path of power as FX instruction list, in as few steps as its order of contacts and outputs allows.
//!
//! A contact costs its own instruction in any place, normally open or closed: contacts are turned over where that saves
//! an inverter. Joining costs an instruction more for each connection that is not the first part of the one around it,
//! and branching one for each conditional path behind which the power is wanted again; the exhaustive search in the
//! tests finds no shorter list.

use super::stack::{self, Moves, Wants};
use crate::document::coil_form;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test};
use crate::target::{Device, Form, Limits, Operand, Role, Target};
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
pub fn lines(path: &Path, target: &Target) -> Result<Vec<Line>, Message> {
    let mut writer = Writer { lines: Vec::new(), branches: 0, limits: target.limits };
    writer.path(path, true)?;
    Ok(writer.lines)
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
    fn path(&mut self, path: &Path, is_first: bool) -> Result<(), Message> {
        let mut is_first = is_first;
        let wanted: Vec<Wants> = path.drives.iter().map(wants).collect();
        let (front, gates) = if is_first { front(&path.gates, &wanted) } else { (None, &path.gates[..]) };
        let moves = stack::moves(&wanted, front.is_some() && gates.is_empty());
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
        if is_at_step && wanted.iter().any(|wants| *wants != Wants::Power) {
            return Err(Message::new("translate.step-branch"));
        }
        if is_first {
            return path.drives.iter().try_for_each(|drive| match drive {
                Drive::Action(action) if action.deed.stands_alone() => self.action(action),
                Drive::Action(_) => Err(Message::new("translate.no-condition")),
                // What begins at the left rail is a rung of its own.
                Drive::Path(path) => self.path(path, true),
            });
        }
        self.drives(&path.drives, &wanted, moves)
    }

    fn pass(&mut self, expression: &Expression, is_first: bool) -> Result<(), Message> {
        let ways = self.limits.blocks as usize - usize::from(!is_first);
        let expression = within_blocks(expression, ways.max(1))?;
        self.expression(&expression, if is_first { Role::Load } else { Role::Series })
    }

    fn drives(&mut self, drives: &[Drive], wanted: &[Wants], moves: Moves) -> Result<(), Message> {
        for ((drive, wanted), moves) in drives.iter().zip(wanted).zip(moves.before) {
            for mnemonic in moves {
                self.bare(mnemonic)?;
                match mnemonic {
                    "MPS" => self.branches += 1,
                    "MPP" => self.branches -= 1,
                    _ => {}
                }
                if self.branches > self.limits.branches {
                    return Err(Message::new("translate.branches").with("limit", self.limits.branches));
                }
            }
            match drive {
                Drive::Action(action) => self.action(action)?,
                Drive::Path(path) if *wanted == Wants::Inverse => self.inverted(path)?,
                Drive::Path(path) => self.path(path, false)?,
            }
        }
        Ok(())
    }

    /// The outputs of a path that is but an inverter, behind its inverter.
    fn inverted(&mut self, path: &Path) -> Result<(), Message> {
        path.drives.iter().try_for_each(|drive| match drive {
            Drive::Action(action) => self.action(action),
            Drive::Path(path) => self.path(path, false),
        })
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
    let inverters = behind.iter().take_while(|gate| **gate == Gate::Invert).count();
    if inverters == 0 && !wanted.contains(&Wants::Inverse) || !is_turnable(expression) {
        return (None, gates);
    }
    let front = if inverters % 2 == 1 { expression.negated() } else { expression.clone() };
    (Some(front), &behind[inverters..])
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

fn wants(drive: &Drive) -> Wants {
    match drive {
        Drive::Action(action) if action.deed == Deed::Coil(CoilKind::Negated) => Wants::Inverse,
        Drive::Action(_) => Wants::Power,
        Drive::Path(path) => {
            let is_inverted = path.gates == [Gate::Invert];
            let is_plain = |drive: &Drive| match drive {
                Drive::Action(action) => action.deed != Deed::Coil(CoilKind::Negated),
                Drive::Path(_) => false,
            };
            match is_inverted && path.drives.iter().all(is_plain) {
                true => Wants::Inverse,
                false => Wants::Everything,
            }
        }
    }
}

/// The contact that is on in each scan of a running FX PLC, M8000, or closed instead of open, so that it never is.
pub(super) fn always(value: bool) -> Contact {
    let device = Device::ALWAYS_ON;
    let kind = if value { ContactKind::NormallyOpen } else { ContactKind::NormallyClosed };
    Contact {
        test: Test::Bit(kind),
        terms: vec![Term::new(Operand::Device(device), &device.to_string(), Span::default())],
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
