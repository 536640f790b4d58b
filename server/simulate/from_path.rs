//! Compiles drawn rungs: a path of power becomes the same code as the list that would be written for it.

use super::Obstacle;
use super::builder::Position;
use super::compile::Compiler;
use super::row::Row;
use crate::document::Chunk;
use crate::logic::{self, Action, Deed, Drive, Expression, Gate, Path};
use crate::target::{Operand, Role, Target};
use crate::text::Span;

/// Compiles a chunk of a drawing for an FX.
pub(super) fn compile(compiler: &mut Compiler, chunk: &Chunk, target: &'static Target) {
    for rung in logic::rungs(chunk, target) {
        compiler.builder.rung();
        for label in &rung.labels {
            if let Operand::Device(label) = Operand::read(label, target.model) {
                compiler.label(label);
            }
        }
        // Places within a list that a drawing carries along are not known; the list is.
        let whole = rung.is_list.then_some(rung.span);
        match rung.path {
            Ok(Some(path)) => {
                compiler.rail_seen(rung.span);
                let mut circuit = Circuit { compiler, whole };
                if let Err((span, obstacle)) = circuit.path(&path) {
                    compiler.refuse(span, obstacle);
                }
            }
            Ok(None) => {}
            Err(refusal) => compiler.refuse(rung.span, Obstacle::Refusal(refusal)),
        }
    }
}

type Outcome = Result<(), (Span, Obstacle)>;

struct Circuit<'a> {
    compiler: &'a mut Compiler,
    whole: Option<Span>,
}

impl Circuit<'_> {
    /// Compiles what is behind the current result.
    fn path(&mut self, path: &Path) -> Outcome {
        for gate in &path.gates {
            match gate {
                Gate::Pass(expression) if self.compiler.builder.has_power() => self.behind(expression)?,
                Gate::Pass(expression) => self.first(expression)?,
                Gate::Invert => self.compiler.builder.invert(),
                Gate::Through(action) => self.through(action)?,
            }
        }
        let [drives @ .., last] = &path.drives[..] else { return Ok(()) };
        if let ([], Drive::Action(action)) = (drives, last) {
            return self.action(action);
        }
        let power = self.compiler.builder.settle();
        for drive in &path.drives {
            self.compiler.builder.set_power(power);
            match drive {
                Drive::Action(action) => self.action(action)?,
                Drive::Path(path) => self.path(path)?,
            }
        }
        Ok(())
    }

    fn at(&mut self, span: Span) -> Span {
        let span = self.whole.unwrap_or(span);
        self.compiler.at(span);
        span
    }

    fn action(&mut self, action: &Action) -> Outcome {
        let span = self.at(action.span);
        self.compiler.action(&action.deed, &action.terms).map_err(|obstacle| (span, obstacle))
    }

    fn through(&mut self, action: &Action) -> Outcome {
        match &action.deed {
            Deed::Instruction(form) if form.instruction.role == Role::Modify => {
                self.at(action.span);
                self.compiler.modify(*form);
                Ok(())
            }
            _ => self.action(action),
        }
    }

    /// A condition at the rail, or at the start of a block.
    fn first(&mut self, expression: &Expression) -> Outcome {
        match expression {
            Expression::Constant(value) => {
                self.compiler.builder.connect(Position::First, Row::RAIL, !value);
                Ok(())
            }
            Expression::Contact(_) => self.part(expression, Position::First),
            Expression::Not(part) => {
                self.first(part)?;
                self.compiler.builder.invert();
                Ok(())
            }
            Expression::And(parts) => self.parts(parts, Position::Series),
            Expression::Or(parts) => self.parts(parts, Position::Parallel),
        }
    }

    /// A condition that the current result passes.
    fn behind(&mut self, expression: &Expression) -> Outcome {
        match expression {
            Expression::And(parts) => parts.iter().try_for_each(|part| self.part(part, Position::Series)),
            _ => self.part(expression, Position::Series),
        }
    }

    fn parts(&mut self, parts: &[Expression], position: Position) -> Outcome {
        let [first, rest @ ..] = parts else { return Ok(()) };
        self.first(first)?;
        rest.iter().try_for_each(|part| self.part(part, position))
    }

    fn part(&mut self, part: &Expression, position: Position) -> Outcome {
        let Expression::Contact(contact) = part else {
            let before = self.compiler.builder.power();
            self.compiler.builder.forget_power();
            self.first(part)?;
            self.compiler.builder.join(before, position);
            return Ok(());
        };
        let span = self.at(contact.span);
        let done = self.compiler.builder.contact(position, contact.test, &contact.terms);
        done.map_err(|obstacle| (span, obstacle))
    }
}
