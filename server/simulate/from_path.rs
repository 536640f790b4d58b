//! Compiles drawn rungs: a path of power becomes the same code as the list that would be written for it.

use super::Obstacle;
use super::builder::{Builder, Position};
use super::compile::Compiler;
use super::from_list;
use super::row::Row;
use crate::document::{Chunk, Tree};
use crate::logic::{self, Action, Contact, Deed, Drive, Expression, Gate, Path};
use crate::target::{Flow, Operand, Role, Target};
use crate::text::Span;

/// Compiles a chunk of a drawing for an FX.
pub(super) fn compile(compiler: &mut Compiler, chunk: &Chunk, target: &'static Target) {
    for rung in logic::rungs(chunk, target) {
        // What a drawing carries along runs as the list that it is.
        if rung.is_list
            && let Some((start, list)) = chunk.box_at(rung.span.start as usize)
            && let Tree::Fx(tree) = list.tree()
        {
            compiler.inside(start, |compiler| from_list::compile(compiler, list.text(), tree));
            continue;
        }
        // What is called in the middle of a rung leaves its cells alone.
        let calls = |action: &&Action| match &action.deed {
            Deed::Instruction(form) => form.instruction.flow() == Flow::Call,
            _ => false,
        };
        let path = rung.path.as_ref().ok().and_then(Option::as_ref);
        let is_calling = path.is_some_and(|path| path.actions().iter().any(calls));
        match is_calling {
            true => compiler.builder.routine(),
            false => compiler.builder.rung(),
        }
        for label in &rung.labels {
            if let Operand::Device(label) = Operand::read(label, target.model) {
                compiler.label(label);
            }
        }
        match rung.path {
            Ok(Some(path)) => {
                compiler.rail_seen(rung.span);
                let done = Circuit { dialect: &mut Fx { compiler } }.path(&path);
                if let Err((span, obstacle)) = done {
                    compiler.refuse(span, obstacle);
                }
            }
            Ok(None) => {}
            Err(refusal) => compiler.refuse(rung.span, Obstacle::Refusal(refusal)),
        }
        if is_calling {
            compiler.builder.routine();
        }
    }
}

type Outcome = Result<(), (Span, Obstacle)>;

/// What contacts and actions of paths become.
pub(super) trait Dialect {
    fn builder(&mut self) -> &mut Builder;

    /// Notes where the next instruction stands, and gives that place.
    fn at(&mut self, span: Span) -> Span;

    /// Puts a contact into the circuit.
    fn contact(&mut self, position: Position, contact: &Contact) -> Result<(), Obstacle>;

    /// What power drives here.
    fn action(&mut self, action: &Action) -> Result<(), Obstacle>;

    /// What power goes through.
    fn through(&mut self, action: &Action) -> Result<(), Obstacle>;
}

/// Rungs of the FX family.
struct Fx<'a> {
    compiler: &'a mut Compiler,
}

impl Dialect for Fx<'_> {
    fn builder(&mut self) -> &mut Builder {
        &mut self.compiler.builder
    }

    fn at(&mut self, span: Span) -> Span {
        self.compiler.at(span);
        span
    }

    fn contact(&mut self, position: Position, contact: &Contact) -> Result<(), Obstacle> {
        self.compiler.builder.contact(position, contact.test, &contact.terms)
    }

    fn action(&mut self, action: &Action) -> Result<(), Obstacle> {
        self.compiler.action(&action.deed, &action.terms)
    }

    fn through(&mut self, action: &Action) -> Result<(), Obstacle> {
        match &action.deed {
            Deed::Instruction(form) if form.instruction.role == Role::Modify => {
                self.compiler.modify(*form);
                Ok(())
            }
            _ => self.action(action),
        }
    }
}

/// The circuit that a path is.
pub(super) struct Circuit<'a, D> {
    pub(super) dialect: &'a mut D,
}

impl<D: Dialect> Circuit<'_, D> {
    /// Compiles what is behind the current result.
    pub(super) fn path(&mut self, path: &Path) -> Outcome {
        for gate in &path.gates {
            match gate {
                Gate::Pass(expression) if self.dialect.builder().has_power() => self.behind(expression)?,
                Gate::Pass(expression) => self.first(expression)?,
                Gate::Invert => self.dialect.builder().invert(),
                Gate::Through(action) => self.through(action)?,
            }
        }
        let [drives @ .., last] = &path.drives[..] else { return Ok(()) };
        if let ([], Drive::Action(action)) = (drives, last) {
            return self.action(action);
        }
        let power = self.dialect.builder().settle();
        for drive in &path.drives {
            self.dialect.builder().set_power(power);
            match drive {
                Drive::Action(action) => self.action(action)?,
                Drive::Path(path) => self.path(path)?,
            }
        }
        Ok(())
    }

    fn action(&mut self, action: &Action) -> Outcome {
        let span = self.dialect.at(action.span);
        self.dialect.action(action).map_err(|obstacle| (span, obstacle))
    }

    fn through(&mut self, action: &Action) -> Outcome {
        let span = self.dialect.at(action.span);
        self.dialect.through(action).map_err(|obstacle| (span, obstacle))
    }

    /// A condition at the rail, or at the start of a block.
    fn first(&mut self, expression: &Expression) -> Outcome {
        match expression {
            Expression::Constant(value) => {
                self.dialect.builder().connect(Position::First, Row::RAIL, !value);
                Ok(())
            }
            Expression::Contact(_) => self.part(expression, Position::First),
            Expression::Not(part) => {
                self.first(part)?;
                self.dialect.builder().invert();
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
            let before = self.dialect.builder().power();
            self.dialect.builder().forget_power();
            self.first(part)?;
            self.dialect.builder().join(before, position);
            return Ok(());
        };
        let span = self.dialect.at(contact.span);
        self.dialect.contact(position, contact).map_err(|obstacle| (span, obstacle))
    }
}
