//! Runs a rung of instruction list with conditions in place of the current result.

use super::{Source, ValueKind, output_of};
use crate::il::iec::{
    Condition, Direction, Item, ItemKind, OperandId, Operation, Parameter, ParameterValue, Run,
};
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::logic::block::Block;
use crate::logic::builder::Builder;
use crate::logic::{Action, Call, Contact, Deed, Drive, Expression, Gate, Path, Refusal, Term, Test};
use crate::target::Role;
use crate::target::iec::{FunctionBlock, OperatorRole};
use crate::text::{Span, folded};
use rustc_hash::{FxHashMap, FxHashSet};
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

pub(super) struct Reader<'s, 'a> {
    source: &'s Source<'a>,
    pou: Option<usize>,
    span: Span,
    builder: Builder,
    value: Value,
    frames: Vec<Frame>,
    /// Detectors that are edge contacts here, by folded name.
    edges: FxHashMap<SmolStr, (OperandId, ContactKind)>,
    /// The keys of what was driven.
    driven: FxHashSet<SmolStr>,
    /// The instance whose power was just stored, folded.
    fed: Option<SmolStr>,
    /// Whether the current result is the inverse of the power.
    is_inverted: bool,
    /// Whether a jump or a call ends the rung.
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
            driven: FxHashSet::default(),
            fed: None,
            is_inverted: false,
            has_ended: false,
        }
    }

    pub(super) fn read(mut self, items: Range<usize>) -> Result<Path, Refusal> {
        let mut index = items.start;
        while index < items.end {
            if self.has_ended {
                return Err(Refusal::NotBoolean);
            }
            let item = self.source.item(index);
            index += 1;
            match item.kind {
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
                    self.settle()?;
                    self.input_operator(input.of(self.source.text), instance, item.span)?;
                }
                ItemKind::Call { condition: Condition::Always, callee: Some(callee), parameters, .. } => {
                    let next = (index < items.end).then(|| self.source.item(index));
                    index += usize::from(self.call(item, callee, parameters, next)?);
                }
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
            OperatorRole::Load if matches!(self.value, Value::Nothing) => {
                self.value = Value::Loaded(id, kind);
                Ok(())
            }
            OperatorRole::Combine { comparison: true } => self.compare(operator.name, id, item.span),
            OperatorRole::Combine { comparison: false } => {
                let contact = Block::of(self.contact(id, kind)?);
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
                if self.source.feeds(index) {
                    return self.feed(id, operation.negated);
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
                self.driven.insert(term.key());
                let action = Action { deed: Deed::Coil(coil), terms: vec![term], span: item.span };
                self.builder.drive(action);
                Ok(())
            }
            _ => Err(Refusal::NotBoolean),
        }
    }

    fn block_of(&self, instance: OperandId) -> Option<&'static FunctionBlock> {
        let name = self.source.tree.operand(instance).span.of(self.source.text);
        self.source.block(self.pou, name)
    }

    /// `R C1`: calls the block with this input alone. Nothing is known of the current result behind it.
    fn input_operator(&mut self, input: &str, instance: OperandId, span: Span) -> Result<(), Refusal> {
        let block = self.block_of(instance).ok_or(Refusal::Element)?;
        self.settle()?;
        self.invert()?;
        let called = self.source.tree.operand(instance);
        let term = Term::new(called.value, called.span.of(self.source.text), called.span);
        let call = Call::new(block, input, term, std::iter::empty::<(&str, bool, Term)>());
        let (call, terms) = call.filter(|(call, _)| call.is_input_operator()).ok_or(Refusal::NotBoolean)?;
        self.builder.drive(Action { deed: Deed::Call(call), terms, span });
        self.has_ended = true;
        Ok(())
    }

    /// Power is stored for the block that is called next.
    fn feed(&mut self, id: OperandId, negated: bool) -> Result<(), Refusal> {
        let path = self.source.tree.operand(id).span.of(self.source.text);
        let (instance, pin) = path.rsplit_once('.').ok_or(Refusal::NotBoolean)?;
        let block = self.source.block(self.pou, instance).ok_or(Refusal::NotBoolean)?;
        if !block.inputs.first().is_some_and(|first| first.name.eq_ignore_ascii_case(pin)) {
            return Err(Refusal::NotBoolean);
        }
        self.is_inverted ^= negated;
        self.invert()?;
        self.fed = Some(folded(instance));
        Ok(())
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
            Value::Loaded(id, kind) => self.contact(id, kind).map(Block::of),
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

    fn is_fresh(&self) -> bool {
        self.builder.is_empty() && matches!(self.value, Value::Nothing) && self.frames.is_empty()
    }

    /// A call; tells whether `next`, the load of its output, goes on from it.
    fn call(
        &mut self,
        item: &Item,
        callee: OperandId,
        parameters: Run,
        next: Option<&Item>,
    ) -> Result<bool, Refusal> {
        let text = self.source.text;
        let called = self.source.tree.operand(callee);
        let instance = called.span.of(text);
        let block = self.source.block(self.pou, instance).ok_or(Refusal::Element)?;
        let parameters = parameters.of(&self.source.tree.parameters);
        let fed = self.fed.take();
        if fed.as_ref().is_some_and(|fed| *fed != folded(instance)) || fed.is_none() && !self.is_fresh() {
            return Err(Refusal::NotBoolean);
        }
        let mut power = None;
        let mut arguments = Vec::with_capacity(parameters.len());
        for (place, parameter) in parameters.iter().enumerate() {
            let (name, is_output, id) =
                argument(parameter, text, || block.inputs.get(place).map(|pin| pin.name))?;
            let is_power = block.inputs.first().is_some_and(|first| first.name.eq_ignore_ascii_case(name));
            match is_power && !is_output {
                true => power = Some(id),
                false => arguments.push((name, is_output, self.term(id)?)),
            }
        }
        match (power, fed) {
            (Some(id), None) => {
                let is_edge = arguments.is_empty() && self.source.is_edge(self.pou, instance, self.span);
                if is_edge && let Some(kind) = edge_kind(block.name) {
                    self.bit(id)?;
                    self.edges.insert(folded(instance), (id, kind));
                    return Ok(false);
                }
                let contact = self.contact(id, ContactKind::NormallyOpen)?;
                self.builder.pass(Expression::Contact(contact)).ok_or(Refusal::TooDeep)?;
            }
            (None, Some(_)) => {}
            _ => return Err(Refusal::Element),
        }
        let power_in = block.inputs.first().map_or("", |pin| pin.name);
        let instance_term = Term::new(called.value, instance, called.span);
        let (call, terms) = Call::new(block, power_in, instance_term, arguments).ok_or(Refusal::Element)?;
        self.driven.extend(call.changes(&terms).iter().map(Term::key));
        let action = Action { deed: Deed::Call(call), terms, span: item.span };
        match next.and_then(|next| self.loads(next, &output_of(block, instance))) {
            None => {
                self.builder.drive(action);
                self.has_ended = true;
                Ok(false)
            }
            Some(negated) => {
                self.builder.gate(Gate::Through(action)).ok_or(Refusal::TooDeep)?;
                if negated {
                    self.builder.gate(Gate::Invert).ok_or(Refusal::TooDeep)?;
                }
                self.value = Value::Power;
                Ok(true)
            }
        }
    }

    /// Whether `item` loads `word`, and if so whether negated.
    fn loads(&self, item: &Item, word: &str) -> Option<bool> {
        let ItemKind::Operation { operation, operand: Some(id) } = item.kind else { return None };
        let operand = self.source.tree.operand(id).span.of(self.source.text);
        let is_it = operation.operator.role == OperatorRole::Load && operand.eq_ignore_ascii_case(word);
        is_it.then_some(operation.negated)
    }

    fn contact(&self, id: OperandId, kind: ContactKind) -> Result<Contact, Refusal> {
        let operand = self.source.tree.operand(id);
        let word = operand.span.of(self.source.text);
        if let Some((instance, _)) = word.rsplit_once('.')
            && let Some((id, edge)) = self.edges.get(&folded(instance))
        {
            let term = self.bit(*id)?;
            // The detector saw its variable before this rung drove anything.
            return match kind == ContactKind::NormallyOpen && !self.driven.contains(&term.key()) {
                true => Ok(Contact { test: Test::Bit(*edge), terms: vec![term], span: operand.span }),
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
            kind if kinds.contains(&kind) && !is_edge => Ok(Term::new(operand.value, word, operand.span)),
            _ => Err(Refusal::NotBoolean),
        }
    }
}

/// A parameter with the name of its pin, whether that is an output, and its operand.
fn argument<'t>(
    parameter: &Parameter,
    text: &'t str,
    positional: impl FnOnce() -> Option<&'t str>,
) -> Result<(&'t str, bool, OperandId), Refusal> {
    let ParameterValue::Operand(id) = parameter.value else { return Err(Refusal::NotBoolean) };
    let is_output = match parameter.direction {
        Direction::In => false,
        Direction::Out { negated: false } => true,
        Direction::Out { negated: true } => return Err(Refusal::NotBoolean),
    };
    let name = parameter.name.map(|name| name.of(text)).or_else(positional);
    Ok((name.ok_or(Refusal::Element)?, is_output, id))
}

/// The contact for which the call of a detector stands.
fn edge_kind(block: &str) -> Option<ContactKind> {
    match block {
        "R_TRIG" => Some(ContactKind::Rising),
        "F_TRIG" => Some(ContactKind::Falling),
        _ => None,
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
