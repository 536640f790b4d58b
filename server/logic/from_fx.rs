//! Reads a rung of FX instruction list: runs it with paths in place of bits.

use super::block::Block;
use super::builder::Builder;
use super::{Action, Contact, Deed, Gate, Path, Refusal, Rung, Term, Test};
use crate::il::fx::{FxLine, FxTree, LineKind};
use crate::target::{Flow, Form, Opcode, Operand, Role};
use crate::text::{Span, Spanned};

/// The rung that a chunk of FX instruction list is.
pub(super) fn rung(text: &str, tree: &FxTree) -> Rung {
    let labels = tree.lines.iter().filter(|line| matches!(line.kind, LineKind::Label(_)));
    let is_instruction = |line: &&FxLine| !matches!(line.kind, LineKind::Label(_));
    let span = match (tree.lines.iter().find(is_instruction), tree.lines.last()) {
        (Some(first), Some(last)) => first.span.to(last.span),
        _ => Span::at(text.len()),
    };
    Rung {
        labels: labels.map(|line| line.mnemonic.of(text).to_uppercase().into()).collect(),
        network: None,
        comments: tree.comments.clone(),
        span,
        is_list: true,
        path: path(text, tree),
    }
}

fn path(text: &str, tree: &FxTree) -> Result<Option<Path>, Refusal> {
    if !tree.problems.is_empty() {
        return Err(Refusal::Unreadable);
    }
    let (builder, blocks, kept) = (Builder::new(), Vec::new(), Vec::new());
    let mut reader = Reader { text, tree, builder, blocks, kept, is_at_step: false };
    for line in &tree.lines {
        match line.kind {
            LineKind::Instruction(form) => reader.instruction(form, line)?,
            LineKind::Unknown => return Err(Refusal::Unreadable),
            LineKind::Label(_) => {}
        }
    }
    reader.finish()
}

/// What the instructions of a list do that is no rung, in order: all but its contacts.
pub fn actions(text: &str, tree: &FxTree) -> Vec<Action> {
    let action = |line: &FxLine| match line.kind {
        LineKind::Instruction(form) if Test::of_form(form).is_none() => Some(action(text, tree, form, line)),
        _ => None,
    };
    tree.lines.iter().filter_map(action).collect()
}

fn action(text: &str, tree: &FxTree, form: Form, line: &FxLine) -> Action {
    Action { deed: Deed::of_form(form), terms: terms(text, tree, line), span: line.span }
}

fn terms(text: &str, tree: &FxTree, line: &FxLine) -> Vec<Term> {
    let term = |operand: &Spanned<Operand>| Term::new(operand.value, operand.span.of(text), operand.span);
    tree.operands(line).iter().map(term).collect()
}

/// The state of the PLC while it runs the rung, with what led there in place of bits.
struct Reader<'a> {
    text: &'a str,
    tree: &'a FxTree,
    /// What leads to the current result, but for blocks that are not joined yet.
    builder: Builder,
    /// The block stack; the first block becomes the way from the left rail at the first output or branch.
    blocks: Vec<Block>,
    /// The branch stack: the places whose power is kept.
    kept: Vec<usize>,
    /// Whether a step was loaded and no contact behind it: outputs may stand there, and contacts begin anew.
    is_at_step: bool,
}

impl Reader<'_> {
    fn instruction(&mut self, form: Form, line: &FxLine) -> Result<(), Refusal> {
        let is_fresh = self.builder.is_empty() && self.blocks.is_empty();
        let role = form.instruction.role;
        if form.instruction.opcode == Opcode::Itself {
            return Err(Refusal::Unreadable);
        }
        if is_fresh && !matches!(role, Role::Load | Role::StepLoad | Role::Standalone) {
            return Err(Refusal::NoCurrentResult);
        }
        if self.is_at_step && self.blocks.is_empty() && !matches!(role, Role::Load | Role::Output) {
            return Err(Refusal::NoCurrentResult);
        }
        match role {
            Role::Load => {
                let block = Block::of(self.contact(form, line)?);
                self.blocks.push(block);
            }
            Role::Series | Role::Parallel => {
                let contact = Block::of(self.contact(form, line)?);
                self.join(contact, role)?;
            }
            Role::BlockSeries | Role::BlockParallel => {
                let block = self.blocks.pop().ok_or(Refusal::Blocks)?;
                if self.blocks.is_empty() && self.builder.is_empty() {
                    return Err(Refusal::Blocks);
                }
                self.join(block, role)?;
            }
            Role::BranchPush => {
                self.settle()?;
                self.builder.keep();
                self.kept.push(self.builder.place());
            }
            Role::BranchRead | Role::BranchPop => {
                self.settle()?;
                let place = self.kept.last().copied().ok_or(Refusal::Branches)?;
                let for_good = role == Role::BranchPop;
                self.builder.back_to(place, for_good).ok_or(Refusal::WithoutOutput)?;
                if for_good {
                    self.kept.pop();
                }
            }
            Role::Modify => self.modify(form, line)?,
            Role::StepLoad if !is_fresh => return Err(Refusal::Blocks),
            Role::StepLoad => {
                let action = self.action(form, line);
                self.builder.gate(Gate::Through(action)).ok_or(Refusal::TooDeep)?;
                self.is_at_step = true;
            }
            Role::Output => {
                self.settle()?;
                let action = self.action(form, line);
                self.builder.drive(action);
            }
            Role::Standalone if form.instruction.flow() == Flow::Nothing => {}
            Role::Standalone if is_fresh => {
                let action = self.action(form, line);
                self.builder.drive(action);
            }
            Role::Standalone => return Err(Refusal::WithoutOutput),
        }
        Ok(())
    }

    /// Joins a contact or a block with the block on top of the stack, or with what leads to the current result.
    fn join(&mut self, block: Block, role: Role) -> Result<(), Refusal> {
        if let Some(top) = self.blocks.last_mut() {
            return top.join(block, role);
        }
        match role {
            Role::Series | Role::BlockSeries => self.builder.pass(block.condition).ok_or(Refusal::TooDeep),
            _ => self.builder.in_parallel(block.condition).ok_or(Refusal::ParallelToBranch),
        }
    }

    /// The one block that begins the rung becomes the way from the left rail; others must have been joined.
    fn settle(&mut self) -> Result<(), Refusal> {
        match self.blocks.len() {
            0 => Ok(()),
            1 if self.builder.is_empty() || self.is_at_step => {
                self.is_at_step = false;
                let block = self.blocks.pop().ok_or(Refusal::Blocks)?;
                self.builder.pass(block.condition).ok_or(Refusal::TooDeep)
            }
            _ => Err(Refusal::Blocks),
        }
    }

    fn modify(&mut self, form: Form, line: &FxLine) -> Result<(), Refusal> {
        let inverts = Form::named("INV") == Some(form);
        if self.blocks.len() > 1 && !inverts {
            return Err(Refusal::NotBoolean);
        }
        if let Some(top) = self.blocks.last_mut().filter(|_| inverts) {
            return top.invert();
        }
        self.settle()?;
        let done = match inverts {
            true => self.builder.invert(),
            false => self.builder.gate(Gate::Through(self.action(form, line))),
        };
        done.ok_or(Refusal::TooDeep)
    }

    fn contact(&self, form: Form, line: &FxLine) -> Result<Contact, Refusal> {
        let test = Test::of_form(form).ok_or(Refusal::Unreadable)?;
        Ok(Contact { test, terms: terms(self.text, self.tree, line), span: line.span })
    }

    fn action(&self, form: Form, line: &FxLine) -> Action {
        action(self.text, self.tree, form, line)
    }

    fn finish(mut self) -> Result<Option<Path>, Refusal> {
        if self.builder.is_empty() && self.blocks.is_empty() {
            return Ok(None);
        }
        if !self.blocks.is_empty() {
            self.settle()?;
            return Err(Refusal::WithoutOutput);
        }
        if !self.kept.is_empty() {
            return Err(Refusal::Branches);
        }
        self.builder.finish().map(Some).ok_or(Refusal::WithoutOutput)
    }
}
