//! Compiles FX instruction list, line by line.

use super::Obstacle;
use super::builder::Position;
use super::compile::Compiler;
use super::row::Cell;
use crate::il::fx::{FxLine, FxTree, LineKind};
use crate::logic::{Deed, Term, Test};
use crate::target::{Flow, Form, Role};

/// Compiles a chunk.
pub(super) fn compile(compiler: &mut Compiler, text: &str, tree: &FxTree) {
    let mut list = List { compiler, text, tree, blocks: Vec::new(), branches: Vec::new(), is_lost: false };
    let calls = |line: &FxLine| match line.kind {
        LineKind::Instruction(form) => form.instruction.flow() == Flow::Call,
        _ => false,
    };
    let is_calling = tree.lines.iter().any(calls);
    match is_calling {
        true => list.compiler.builder.routine(),
        false => list.compiler.builder.rung(),
    }
    let joined = joined(tree);
    for (line, is_block) in tree.lines.iter().zip(joined) {
        list.compiler.at(line.span);
        let done = match line.kind {
            LineKind::Label(label) => {
                list.compiler.label(label);
                Ok(())
            }
            LineKind::Instruction(form) => list.instruction(form, line, is_block),
            LineKind::Unknown => Err(Obstacle::Unreadable),
        };
        match done {
            Ok(()) => list.is_lost &= !list.compiler.builder.has_power(),
            Err(obstacle) => {
                if !list.is_lost || obstacle != Obstacle::NoCurrentResult {
                    list.compiler.refuse(line.span, obstacle);
                }
                list.is_lost = true;
            }
        }
    }
    if is_calling {
        list.compiler.builder.routine();
    }
}

/// Which loads begin a block that ANB or ORB joins with what stands before; others begin a rung.
fn joined(tree: &FxTree) -> Vec<bool> {
    let mut joined = vec![false; tree.lines.len()];
    let mut loads = Vec::new();
    for (number, line) in tree.lines.iter().enumerate() {
        let LineKind::Instruction(form) = line.kind else { continue };
        match form.instruction.role {
            Role::Load => loads.push(number),
            Role::BlockSeries | Role::BlockParallel => {
                if let Some(load) = loads.pop() {
                    joined[load] = true;
                }
            }
            _ => {}
        }
    }
    joined
}

struct List<'a> {
    compiler: &'a mut Compiler,
    text: &'a str,
    tree: &'a FxTree,
    /// What blocks are joined with, in cells.
    blocks: Vec<Cell>,
    /// What MPS keeps.
    branches: Vec<Cell>,
    /// Whether there is no power because a contact before was refused, which is told once.
    is_lost: bool,
}

impl List<'_> {
    fn instruction(&mut self, form: Form, line: &FxLine, is_block: bool) -> Result<(), Obstacle> {
        let terms = self.terms(line);
        let builder = &mut self.compiler.builder;
        match form.instruction.role {
            Role::Load => {
                if is_block {
                    let before = if self.blocks.is_empty() && !builder.has_power() {
                        // Where a step or a master control begins, the block is joined with the rail.
                        builder.settle()
                    } else {
                        builder.power()
                    };
                    self.blocks.push(before);
                }
                builder.forget_power();
                self.contact(Position::First, form, &terms)
            }
            Role::Series => self.contact(Position::Series, form, &terms),
            Role::Parallel => self.contact(Position::Parallel, form, &terms),
            Role::BlockSeries => {
                let block = self.blocks.pop().ok_or(Obstacle::Blocks)?;
                builder.join(block, Position::Series);
                builder.seen();
                Ok(())
            }
            Role::BlockParallel => {
                let block = self.blocks.pop().ok_or(Obstacle::Blocks)?;
                builder.join(block, Position::Parallel);
                builder.seen();
                Ok(())
            }
            Role::BranchPush => {
                let power = builder.settle();
                self.branches.push(power);
                builder.seen();
                Ok(())
            }
            Role::BranchRead | Role::BranchPop => {
                let is_last = form.instruction.role == Role::BranchPop;
                let branch = if is_last { self.branches.pop() } else { self.branches.last().copied() };
                builder.set_power(branch.ok_or(Obstacle::Branches)?);
                builder.seen();
                Ok(())
            }
            Role::Modify => {
                if !builder.has_power() {
                    return Err(Obstacle::NoCurrentResult);
                }
                self.compiler.modify(form);
                Ok(())
            }
            Role::Output if !builder.has_power() && !self.compiler.is_in_step() => {
                Err(Obstacle::NoCurrentResult)
            }
            Role::StepLoad | Role::Output | Role::Standalone => {
                self.compiler.action(&Deed::of_form(form), &terms)
            }
        }
    }

    fn contact(&mut self, position: Position, form: Form, terms: &[Term]) -> Result<(), Obstacle> {
        let builder = &mut self.compiler.builder;
        if position != Position::First && !builder.has_power() {
            return Err(Obstacle::NoCurrentResult);
        }
        let test = Test::of_form(form).ok_or(Obstacle::Unreadable)?;
        builder.contact(position, test, terms)
    }

    fn terms(&self, line: &FxLine) -> Vec<Term> {
        let operands = self.tree.operands(line).iter();
        operands.map(|operand| Term::new(operand.value, operand.span.of(self.text), operand.span)).collect()
    }
}
