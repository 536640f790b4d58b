//! Runs a rung of instruction list with conditions in place of the current result.

mod call;
pub(in crate::logic) use call::detects_rise;
mod held;

use super::{Source, ValueKind};
use crate::il::iec::{Condition, Item, ItemKind, OperandId, Operation};
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::logic::block::Block;
use crate::logic::builder::Builder;
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Refusal, Storage, Term, Test};
use crate::target::Role;
use crate::target::iec::OperatorRole;
use crate::text::{Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::ops::Range;

/// The current result.
enum Value {
    Nothing,
    /// An operand was loaded, and what follows tells whether it is a bit.
    Loaded(OperandId, ContactKind),
    Block(Block),
    /// The power behind all gates.
    Power,
}

/// An open parenthesis.
struct Frame {
    operation: Operation,
    /// The current result before it.
    before: Value,
}

/// A detector that is an edge contact.
#[derive(Clone, Copy)]
struct Edge {
    operand: OperandId,
    /// The call.
    called_at: usize,
}

pub(super) struct Reader<'s, 'a> {
    source: &'s Source<'a>,
    pou: Option<usize>,
    span: Span,
    builder: Builder,
    value: Value,
    frames: Vec<Frame>,
    /// Detectors that are edge contacts here, by folded name.
    edges: FxHashMap<SmolStr, Edge>,
    /// The keys of what was driven, with the number of the last instruction that did it.
    driven: FxHashMap<SmolStr, usize>,
    /// The last instruction that ran a unit of the program, which may drive what others know, too.
    ran: Option<usize>,
    /// The places whose power is kept, by the folded names of the helpers that keep it.
    held: FxHashMap<SmolStr, usize>,
    /// The instruction that is read, and the end of those of the rung.
    at: usize,
    end: usize,
    /// The instance whose power was just stored, folded.
    fed: Option<SmolStr>,
    /// Whether the current result is the inverse of the power.
    is_inverted: bool,
    /// Whether a jump ends the rung.
    has_ended: bool,
}

impl<'s, 'a> Reader<'s, 'a> {
    /// A reader of the instructions in `span`.
    pub(super) fn new(source: &'s Source<'a>, pou: Option<usize>, span: Span) -> Reader<'s, 'a> {
        Reader {
            source,
            pou,
            span,
            builder: Builder::new(),
            value: Value::Nothing,
            frames: Vec::new(),
            edges: FxHashMap::default(),
            driven: FxHashMap::default(),
            ran: None,
            held: FxHashMap::default(),
            at: 0,
            end: 0,
            fed: None,
            is_inverted: false,
            has_ended: false,
        }
    }

    pub(super) fn read(mut self, items: Range<usize>) -> Result<Path, Refusal> {
        let mut index = items.start;
        self.end = items.end;
        while index < items.end {
            if self.has_ended {
                return Err(Refusal::NotBoolean);
            }
            let item = self.source.item(index);
            self.at = index;
            if self.is_fresh()
                && let Some(items) = self.calculation(index)?
            {
                index += items;
                continue;
            }
            index += 1;
            match item.kind {
                ItemKind::Jump { .. } if let Some(label) = self.skipped(index - 1, items.end) => {
                    self.skip(index..label)?;
                    index = label + 1;
                }
                ItemKind::Operation { operation, operand } => {
                    self.operation(index - 1, item, operation, operand)?
                }
                ItemKind::Open { operation, operand } => {
                    let inner =
                        operand.map_or(Value::Nothing, |id| Value::Loaded(id, ContactKind::NormallyOpen));
                    let before = std::mem::replace(&mut self.value, inner);
                    self.frames.push(Frame { operation, before });
                }
                ItemKind::Close => self.close()?,
                ItemKind::Jump { condition, label, .. } => {
                    let label = label.ok_or(Refusal::Unreadable)?;
                    let term = Term::new(crate::target::Operand::Variable, label.of(self.source.text), label);
                    self.leave(Deed::Jump, vec![term], condition, item.span)?;
                }
                ItemKind::Return { condition, .. } => {
                    self.leave(Deed::Return, Vec::new(), condition, item.span)?
                }
                ItemKind::InputOperator { input, instance } if self.frames.is_empty() => {
                    self.input_operator(input.of(self.source.text), instance, item.span)?;
                }
                ItemKind::Call { condition, callee: Some(callee), parameters, .. } => {
                    index += match condition {
                        Condition::Always => self.call(item, callee, parameters)?,
                        _ => self.conditional_call(item, callee, parameters, condition)?,
                    };
                }
                ItemKind::Function { name, .. } => return Err(self.uncalled(name.of(self.source.text))),
                _ => return Err(Refusal::NotBoolean),
            }
        }
        self.finish()
    }

    fn finish(self) -> Result<Path, Refusal> {
        if !self.frames.is_empty() {
            return Err(Refusal::Unreadable);
        }
        match self.value {
            Value::Loaded(..) | Value::Block(_) => return Err(Refusal::WithoutOutput),
            Value::Nothing | Value::Power => {}
        }
        self.builder.finish().map(straightened).ok_or(Refusal::WithoutOutput)
    }

    fn operation(
        &mut self,
        index: usize,
        item: &Item,
        operation: Operation,
        operand: Option<OperandId>,
    ) -> Result<(), Refusal> {
        let operator = operation.operator;
        if operator.role == OperatorRole::Complement {
            return if operand.is_none() { self.complement() } else { Err(Refusal::Unreadable) };
        }
        let id = operand.ok_or(Refusal::Unreadable)?;
        let kind = if operation.negated { ContactKind::NormallyClosed } else { ContactKind::NormallyOpen };
        match operator.role {
            OperatorRole::Load if self.frames.is_empty() && self.goes_back(id)? => Ok(()),
            OperatorRole::Load
                if matches!(self.value, Value::Nothing)
                    && (self.builder.is_empty() || !self.frames.is_empty()) =>
            {
                self.value = Value::Loaded(id, kind);
                Ok(())
            }
            OperatorRole::Combine { comparison: true } => self.compare(operator.name, id, item.span),
            OperatorRole::Combine { comparison: false } => {
                let contact = self.condition(id, kind)?;
                self.combine(operator.name, contact)
            }
            OperatorRole::Store | OperatorRole::Latch { .. } if self.frames.is_empty() => {
                let word = operation.word.of(self.source.text);
                let latches = matches!(operator.role, OperatorRole::Latch { .. });
                if latches && self.block_of(id).is_some() {
                    return self.input_operator(word, id, item.span);
                }
                if word.ends_with('?') {
                    return Err(Refusal::NotBoolean);
                }
                self.settle()?;
                if self.source.feeds(self.pou, index) {
                    return self.feed(id, operation.negated);
                }
                if operator.role == OperatorRole::Store && self.holds(id, operation.negated)? {
                    return Ok(());
                }
                let coil = match operator.role {
                    OperatorRole::Latch { on: true } => CoilKind::Set,
                    OperatorRole::Latch { on: false } => CoilKind::Reset,
                    // The inverse needs no inverter.
                    _ if operation.negated != self.is_inverted => CoilKind::Negated,
                    _ => CoilKind::Plain,
                };
                if matches!(operator.role, OperatorRole::Latch { .. }) {
                    self.invert()?;
                }
                let term = self.bit(id)?;
                self.driven.insert(term.key(), self.at);
                let action = Action { deed: Deed::Coil(coil), terms: vec![term], span: item.span };
                self.builder.drive(action);
                Ok(())
            }
            _ => Err(Refusal::NotBoolean),
        }
    }

    fn complement(&mut self) -> Result<(), Refusal> {
        match std::mem::replace(&mut self.value, Value::Nothing) {
            Value::Nothing => return Err(Refusal::NoCurrentResult),
            Value::Power => {
                self.value = Value::Power;
                self.is_inverted = !self.is_inverted;
            }
            loaded => self.value = Value::Block(inverted(self.block(loaded)?)?),
        }
        Ok(())
    }

    fn compare(&mut self, name: &str, right: OperandId, span: Span) -> Result<(), Refusal> {
        let operator = comparison(name).ok_or(Refusal::NotBoolean)?;
        let left = match std::mem::replace(&mut self.value, Value::Nothing) {
            Value::Loaded(left, ContactKind::NormallyOpen) => left,
            Value::Nothing => return Err(Refusal::NoCurrentResult),
            _ => return Err(Refusal::NotBoolean),
        };
        let terms = vec![self.word(left)?, self.word(right)?];
        let span = self.source.tree.operand(left).span.to(span);
        self.value = Value::Block(Block::of(Contact { test: Test::Compare(operator), terms, span }));
        Ok(())
    }

    fn close(&mut self) -> Result<(), Refusal> {
        let Frame { operation, before } = self.frames.pop().ok_or(Refusal::Unreadable)?;
        let inner = std::mem::replace(&mut self.value, before);
        let OperatorRole::Combine { comparison } = operation.operator.role else {
            return Err(Refusal::NotBoolean);
        };
        if comparison {
            let Value::Loaded(right, ContactKind::NormallyOpen) = inner else {
                return Err(Refusal::NotBoolean);
            };
            return self.compare(operation.operator.name, right, operation.word);
        }
        let mut block = match inner {
            Value::Nothing | Value::Power => return Err(Refusal::NoCurrentResult),
            inner => self.block(inner)?,
        };
        if operation.negated {
            block = inverted(block)?;
        }
        self.combine(operation.operator.name, block)
    }

    /// Joins a condition with the current result.
    fn combine(&mut self, name: &str, block: Block) -> Result<(), Refusal> {
        let role = match name {
            "AND" | "&" => Role::BlockSeries,
            "OR" => Role::BlockParallel,
            "XOR" => Role::Modify,
            _ => return Err(Refusal::NotBoolean),
        };
        match std::mem::replace(&mut self.value, Value::Nothing) {
            Value::Nothing => return Err(Refusal::NoCurrentResult),
            Value::Power => {
                self.value = Value::Power;
                self.invert()?;
                return match role {
                    Role::BlockSeries => self.builder.pass(block.condition).ok_or(Refusal::TooDeep),
                    Role::BlockParallel => {
                        self.builder.in_parallel(block.condition).ok_or(Refusal::ParallelToBranch)
                    }
                    _ => Err(Refusal::ParallelToBranch),
                };
            }
            loaded => {
                let mut before = self.block(loaded)?;
                match role {
                    Role::Modify => before.exclude(block)?,
                    role => before.join(block, role)?,
                }
                self.value = Value::Block(before);
            }
        }
        Ok(())
    }

    /// The condition that a current result is.
    fn block(&self, value: Value) -> Result<Block, Refusal> {
        match value {
            Value::Block(block) => Ok(block),
            Value::Loaded(id, kind) => self.condition(id, kind),
            Value::Nothing | Value::Power => Err(Refusal::NotBoolean),
        }
    }

    /// The condition loaded so far becomes the way from the left rail.
    fn settle(&mut self) -> Result<(), Refusal> {
        match std::mem::replace(&mut self.value, Value::Power) {
            Value::Nothing => Err(Refusal::NoCurrentResult),
            Value::Power => Ok(()),
            loaded => {
                let block = self.block(loaded)?;
                self.builder.pass(block.condition).ok_or(Refusal::TooDeep)
            }
        }
    }

    /// Two inversions without anything between them are none.
    fn invert(&mut self) -> Result<(), Refusal> {
        match std::mem::take(&mut self.is_inverted) {
            true => self.builder.gate(Gate::Invert).ok_or(Refusal::TooDeep),
            false => Ok(()),
        }
    }

    /// A jump or a return, which ends the rung: what a drawing has beside a jump is done before it.
    fn leave(
        &mut self,
        deed: Deed,
        terms: Vec<Term>,
        condition: Condition,
        span: Span,
    ) -> Result<(), Refusal> {
        if !self.frames.is_empty() {
            return Err(Refusal::NotBoolean);
        }
        match condition {
            Condition::Always if self.is_fresh() => {}
            Condition::Always => return Err(Refusal::NotBoolean),
            Condition::IfTrue | Condition::IfFalse => {
                self.settle()?;
                self.is_inverted ^= condition == Condition::IfFalse;
                self.invert()?;
            }
        }
        self.builder.drive(Action { deed, terms, span });
        self.has_ended = true;
        Ok(())
    }

    /// The label behind the calculations that the jump at item `index` skips, if both stand before item `end`.
    fn skipped(&self, index: usize, end: usize) -> Option<usize> {
        self.source.skips.label(index).filter(|label| *label < end && self.frames.is_empty())
    }

    /// Calculations that are done if the current result is on.
    fn skip(&mut self, items: Range<usize>) -> Result<(), Refusal> {
        self.settle()?;
        self.invert()?;
        self.value = Value::Nothing;
        let mut index = items.start;
        while index < items.end {
            self.at = index;
            index += self.calculation(index)?.ok_or(Refusal::NotBoolean)?;
        }
        Ok(())
    }

    /// Drives the calculation that begins at item `index`; how many items it takes, if there is one.
    fn calculation(&mut self, index: usize) -> Result<Option<usize>, Refusal> {
        let Some(found) = self.source.calculation(self.pou, index) else { return Ok(None) };
        let terms = found.operands.iter().map(|id| self.term(*id)).collect::<Result<Vec<_>, _>>()?;
        let span = self.source.item(index).span.to(self.source.item(index + found.items - 1).span);
        let action = Action { deed: Deed::Compute(found.computation), terms, span };
        self.note(&action, index);
        self.builder.drive(action);
        Ok(Some(found.items))
    }

    fn is_fresh(&self) -> bool {
        self.builder.is_empty() && matches!(self.value, Value::Nothing) && self.frames.is_empty()
    }

    /// The condition that an operand is, or its inverse.
    fn condition(&self, id: OperandId, kind: ContactKind) -> Result<Block, Refusal> {
        let contact = self.contact(id, kind)?;
        let is_edge = contact.test.opposite().is_none();
        let mut block = Block::of(contact);
        if is_edge && kind == ContactKind::NormallyClosed {
            block.invert()?;
        }
        Ok(block)
    }

    /// The contact that an operand is; that of an edge has no opposite.
    fn contact(&self, id: OperandId, kind: ContactKind) -> Result<Contact, Refusal> {
        let operand = self.source.tree.operand(id);
        let word = operand.span.of(self.source.text);
        if let Some((instance, _)) = word.rsplit_once('.')
            && let Some(edge) = self.edges.get(&folded(instance))
        {
            let term = self.bit(edge.operand)?;
            // What drives the variable behind the call of the detector, it did not see.
            let ran = self.ran.filter(|_| term.storage != Storage::Local);
            let driven = self.driven.get(&term.key()).copied();
            let is_late = driven.max(ran).is_some_and(|driven| driven > edge.called_at);
            return match !is_late {
                true => Ok(Contact {
                    test: Test::Bit(ContactKind::Rising),
                    terms: vec![term],
                    span: operand.span,
                }),
                false => Err(Refusal::NotBoolean),
            };
        }
        Ok(Contact { test: Test::Bit(kind), terms: vec![self.bit(id)?], span: operand.span })
    }

    /// An operand that is, or may be, a bit.
    fn bit(&self, id: OperandId) -> Result<Term, Refusal> {
        self.operand(id, &[ValueKind::Bit, ValueKind::Unknown])
    }

    /// An operand that is, or may be, more than a bit.
    fn word(&self, id: OperandId) -> Result<Term, Refusal> {
        self.operand(id, &[ValueKind::Word, ValueKind::Unknown])
    }

    /// Any operand.
    fn term(&self, id: OperandId) -> Result<Term, Refusal> {
        self.operand(id, &[ValueKind::Bit, ValueKind::Word, ValueKind::Unknown])
    }

    fn operand(&self, id: OperandId, kinds: &[ValueKind]) -> Result<Term, Refusal> {
        let operand = self.source.tree.operand(id);
        let word = operand.span.of(self.source.text);
        let is_edge = word.rsplit_once('.').is_some_and(|(root, _)| self.edges.contains_key(&folded(root)));
        match self.source.value_kind(self.pou, &operand.value, word) {
            ValueKind::Invalid => Err(Refusal::Unreadable),
            kind if kinds.contains(&kind) && !is_edge => Ok(self.source.term(self.pou, id)),
            _ => Err(Refusal::NotBoolean),
        }
    }
}

/// The comparison that an operator makes.
fn comparison(name: &str) -> Option<CompareOperator> {
    let wide = false;
    Some(match name {
        "GT" => CompareOperator::Greater { wide },
        "GE" => CompareOperator::GreaterOrEqual { wide },
        "EQ" => CompareOperator::Equal { wide },
        "NE" => CompareOperator::NotEqual { wide },
        "LE" => CompareOperator::LessOrEqual { wide },
        "LT" => CompareOperator::Less { wide },
        _ => return None,
    })
}

/// The block inverted; a single contact is its opposite.
fn inverted(mut block: Block) -> Result<Block, Refusal> {
    if let Expression::Contact(contact) = &block.condition
        && let (Test::Bit(_), Some(test)) = (contact.test, contact.test.opposite())
    {
        return Ok(Block::of(Contact { test, ..contact.clone() }));
    }
    if let Expression::Not(inner) = block.condition {
        block.condition = *inner;
        return Ok(block);
    }
    block.invert()?;
    Ok(block)
}

/// `JMPCN` behind one contact alone is a jump behind its opposite.
fn straightened(mut path: Path) -> Path {
    if let ([Gate::Pass(Expression::Contact(contact))], [Drive::Path(inner)]) =
        (&path.gates[..], &path.drives[..])
        && inner.gates == [Gate::Invert]
        && let Some(test) = contact.test.opposite()
    {
        let contact = Contact { test, ..contact.clone() };
        return Path { gates: vec![Gate::Pass(Expression::Contact(contact))], drives: inner.drives.clone() };
    }
    if let [Gate::Pass(Expression::Contact(contact)), Gate::Invert] = &mut path.gates[..]
        && let Some(test) = contact.test.opposite()
    {
        contact.test = test;
        path.gates.pop();
    }
    path
}
