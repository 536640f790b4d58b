//! What power does in a rung: conditions that it passes, and what it drives behind them.

use super::{Call, Computation, Expression, Term, Test};
use crate::document::{Scopes, coil_form};
use crate::ladder::CoilKind;
use crate::target::{Access, Flow, Form, Role};
use crate::text::Span;
use std::borrow::Cow;
use std::cell::RefCell;
use std::sync::Arc;

/// A path of power from the left rail, or from where it leaves another path: it passes all gates, then it drives one
/// thing after another. A path that leaves it starts with the power behind its gates.
///
/// The power that reaches the drives is found once, however many there are.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Path {
    /// From left to right.
    pub gates: Vec<Gate>,
    /// From top to bottom, the order of execution.
    pub drives: Vec<Drive>,
}

/// What power passes, or does not.
#[derive(Clone, PartialEq, Debug)]
pub enum Gate {
    /// Power goes on where this holds.
    Pass(Expression),
    /// Power goes on where there was none: all gates before it, back to the left rail, are inverted.
    Invert,
    /// Something that power reaches and that decides by itself whether power goes on: STL, MEP, MEF, a function block.
    Through(Action),
}

/// What power drives behind the gates of a path.
#[derive(Clone, PartialEq, Debug)]
pub enum Drive {
    /// An output.
    Action(Action),
    /// A path that leaves here.
    Path(Path),
}

/// Something done with the power that reaches it.
#[derive(Clone, PartialEq, Debug)]
pub struct Action {
    /// What is done.
    pub deed: Deed,
    /// With which operands, in the order in which they are written.
    pub terms: Vec<Term>,
    /// Its cells, or its line, in the chunk that it was read from.
    pub span: Span,
}

/// What an action is.
#[derive(Clone, PartialEq, Debug)]
pub enum Deed {
    /// A coil; with two operands that of a timer or counter with its preset.
    Coil(CoilKind),
    /// Any other instruction of the FX family.
    Instruction(Form),
    /// Calls a function block; the operands are the instance and those of its pins.
    Call(Arc<Call>),
    /// Stores the result of a calculation with words, or of a function of the program; the operands are its inputs and
    /// the result.
    Compute(Computation),
    /// Goes on at a network of the same program; the label is the operand.
    Jump,
    /// Leaves the program unit.
    Return,
}

impl Deed {
    /// What an FX instruction does: coils where there is one for it, so that `[SET M0]` and `(S)` are the same.
    pub fn of_form(form: Form) -> Deed {
        COILS
            .iter()
            .find(|kind| coil_form(**kind) == Some(form))
            .map_or(Deed::Instruction(form), |kind| Deed::Coil(*kind))
    }

    /// What a drawn coil does. On the FX family one that turns its device over is an instruction.
    pub fn of_coil(kind: CoilKind) -> Deed {
        match kind {
            CoilKind::Toggle => coil_form(kind).map_or(Deed::Coil(kind), Deed::Instruction),
            _ => Deed::Coil(kind),
        }
    }

    /// Whether it stands without a condition: END, MCR, NEXT and their kin.
    pub fn stands_alone(&self) -> bool {
        matches!(self, Deed::Instruction(form) if form.instruction.role == Role::Standalone)
    }

    /// Whether the program ends with it.
    pub fn ends_program(&self) -> bool {
        matches!(self, Deed::Instruction(form) if form.instruction.flow() == Flow::ProgramEnd)
    }
}

/// Coils that one instruction drives.
const COILS: [CoilKind; 5] =
    [CoilKind::Plain, CoilKind::Set, CoilKind::Reset, CoilKind::Rising, CoilKind::Falling];

impl Action {
    /// The operands that it may write, and what a call may change besides: not what a unit of the program does that
    /// it runs, see [`Action::runs_unit`].
    pub fn changes(&self) -> Vec<Cow<'_, Term>> {
        match &self.deed {
            Deed::Coil(_) => self.terms.first().map(Cow::Borrowed).into_iter().collect(),
            Deed::Compute(computation) => {
                computation.changes(&self.terms).into_iter().map(Cow::Borrowed).collect()
            }
            Deed::Call(call) => call.changes(&self.terms).into_iter().map(Cow::Owned).collect(),
            Deed::Instruction(form) => {
                let operands = self.terms.iter().zip(form.instruction.operands);
                let written = operands.filter(|(_, spec)| spec.access != Access::Read);
                written.map(|(term, _)| Cow::Borrowed(term)).collect()
            }
            Deed::Jump | Deed::Return => Vec::new(),
        }
    }

    /// Whether it runs a function block or a function that the program declares. That may look at, and change, whatever
    /// is known outside of the unit that calls it.
    pub fn runs_unit(&self) -> bool {
        match &self.deed {
            Deed::Call(call) => call.block.is_declared(),
            Deed::Compute(computation) => computation.is_declared(),
            _ => false,
        }
    }

    /// The variable from which power goes on behind the call of a function block.
    pub fn power_out(&self) -> Option<Term> {
        match &self.deed {
            Deed::Call(call) => call.output(&self.terms),
            _ => None,
        }
    }
}

impl Gate {
    /// The one condition that gates are behind the one `before` them, if there is any; or the gate that is no
    /// condition: power goes through something there, or nothing stands before an inverter.
    pub fn condition(gates: &[Gate], before: Option<Expression>) -> Result<Option<Expression>, &Gate> {
        gates.iter().try_fold(before, |before, gate| match (gate, before) {
            (Gate::Pass(more), None) => Ok(Some(more.clone())),
            (Gate::Pass(more), Some(before)) => Ok(Some(Expression::and([before, more.clone()]))),
            (Gate::Invert, Some(before)) => Ok(Some(Expression::Not(Box::new(before)))),
            (Gate::Invert, None) | (Gate::Through(_), _) => Err(gate),
        })
    }
}

impl Path {
    /// A path that drives this alone, as it stands.
    pub fn of_action(action: Action) -> Path {
        Path { gates: Vec::new(), drives: vec![Drive::Action(action)] }
    }

    /// All actions in the order of execution, those that power passes through among them.
    pub fn actions(&self) -> Vec<&Action> {
        let mut actions = Vec::new();
        self.visit(&mut |action| actions.push(action), &mut |_| {});
        actions
    }

    /// All operands, in the order of execution.
    pub fn terms(&self) -> Vec<&Term> {
        let terms = RefCell::new(Vec::new());
        self.visit(&mut |action| terms.borrow_mut().extend(&action.terms), &mut |condition| {
            condition.contacts().into_iter().for_each(|contact| terms.borrow_mut().extend(&contact.terms));
        });
        terms.into_inner()
    }

    /// The operands that are compared with each other, in the order of execution.
    pub fn compared(&self) -> Vec<&Term> {
        let compared = RefCell::new(Vec::new());
        self.visit(&mut |_| {}, &mut |condition| {
            let contacts = condition.contacts().into_iter();
            let own = contacts.filter(|contact| matches!(contact.test, Test::Compare(_)));
            own.for_each(|contact| compared.borrow_mut().extend(&contact.terms));
        });
        compared.into_inner()
    }

    /// The same with its variables where they lie as declared in program unit number `pou`.
    pub fn located(mut self, scopes: &Scopes, pou: Option<usize>) -> Path {
        if scopes.shares_storage {
            self.each_term(&mut |term| *term = term.clone().located(scopes, pou));
        }
        self
    }

    /// Calls `found` with all operands.
    pub fn each_term(&mut self, found: &mut impl FnMut(&mut Term)) {
        for gate in &mut self.gates {
            match gate {
                Gate::Pass(expression) => expression.each_term(found),
                Gate::Invert => {}
                Gate::Through(through) => through.terms.iter_mut().for_each(&mut *found),
            }
        }
        for drive in &mut self.drives {
            match drive {
                Drive::Action(driven) => driven.terms.iter_mut().for_each(&mut *found),
                Drive::Path(path) => path.each_term(found),
            }
        }
    }

    /// The same in a text in which it begins later by so many bytes.
    pub fn shifted(mut self, start: usize) -> Path {
        self.shift(start);
        self
    }

    fn shift(&mut self, start: usize) {
        let shift_action = |action: &mut Action| {
            action.span = action.span.shifted(start);
            action.terms.iter_mut().for_each(|term| term.span = term.span.shifted(start));
        };
        for gate in &mut self.gates {
            match gate {
                Gate::Pass(expression) => expression.shift(start),
                Gate::Invert => {}
                Gate::Through(through) => shift_action(through),
            }
        }
        for drive in &mut self.drives {
            match drive {
                Drive::Action(driven) => shift_action(driven),
                Drive::Path(path) => path.shift(start),
            }
        }
    }

    /// Calls `action` and `condition` with what the path consists of, in the order of execution.
    pub fn visit<'p>(
        &'p self,
        action: &mut impl FnMut(&'p Action),
        condition: &mut impl FnMut(&'p Expression),
    ) {
        for gate in &self.gates {
            match gate {
                Gate::Pass(expression) => condition(expression),
                Gate::Invert => {}
                Gate::Through(through) => action(through),
            }
        }
        for drive in &self.drives {
            match drive {
                Drive::Action(driven) => action(driven),
                Drive::Path(path) => path.visit(action, condition),
            }
        }
    }
}
