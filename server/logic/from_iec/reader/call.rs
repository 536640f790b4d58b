//! Calls of function blocks, and edge contacts.

use super::super::{is_pulse_name, output_of};
use super::{Edge, Reader, Value};
use crate::il::iec::{Condition, Direction, Item, ItemKind, OperandId, Parameter, ParameterValue, Run};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Call, Callee, Computation, Deed, Expression, Gate, Refusal, Term};
use crate::target::iec::{EN, Function, OperatorRole};
use crate::text::{Span, folded};
use std::sync::Arc;

impl<'a> Reader<'_, 'a> {
    /// Power is stored for the block that is called next.
    pub(super) fn feed(&mut self, id: OperandId, negated: bool) -> Result<(), Refusal> {
        let path = self.source.tree.operand(id).span.of(self.source.text);
        let (instance, _) = path.rsplit_once('.').ok_or(Refusal::NotBoolean)?;
        self.source.block(self.pou, instance).ok_or(Refusal::NotBoolean)?;
        self.is_inverted ^= negated;
        self.invert()?;
        self.fed = Some(folded(instance));
        Ok(())
    }

    pub(super) fn block_of(&self, instance: OperandId) -> Option<Callee> {
        let name = self.source.tree.operand(instance).span.of(self.source.text);
        self.source.block(self.pou, name)
    }

    /// The block that is called, or the name by which nothing known is.
    fn called(&self, callee: OperandId) -> Result<Callee, Refusal> {
        self.block_of(callee).ok_or_else(|| Refusal::Callee(self.name(callee).into()))
    }

    fn name(&self, operand: OperandId) -> &'a str {
        self.source.tree.operand(operand).span.of(self.source.text)
    }

    /// `R C1`, `IN T1`: calls the block with this input alone, which power drives; `PT T1` hands over the number that
    /// was loaded. Nothing is known of the current result behind it.
    pub(super) fn input_operator(
        &mut self,
        input: &str,
        instance: OperandId,
        span: Span,
    ) -> Result<(), Refusal> {
        let block = self.called(instance)?;
        let has_operator = matches!(&block, Callee::Block(block) if block.has_input_operator(input));
        let is_bit = block.inputs().iter().any(|formal| formal.is_called(input) && formal.is_bit());
        let term = self.source.term(self.pou, instance);
        let call = match self.value {
            Value::Loaded(id, ContactKind::NormallyOpen) if !is_bit => {
                let is_first = self.builder.is_empty();
                let given = self.term(id)?;
                self.value = Value::Nothing;
                Call::new(block, EN.name, term, [(input, false, given)]).filter(|_| is_first)
            }
            _ => {
                self.settle()?;
                self.invert()?;
                Call::new(block, input, term, std::iter::empty::<(&str, bool, Term)>())
            }
        };
        let (call, terms) = call.filter(|_| has_operator).ok_or(Refusal::NotBoolean)?;
        let action = Action { deed: Deed::Call(Arc::new(call)), terms, span };
        self.note(&action, self.at);
        self.builder.drive(action);
        self.value = Value::Nothing;
        Ok(())
    }

    /// A call; tells how many of the items behind it belong to it: the load of its output, which goes on from it, and
    /// for a coil of an edge the store, too.
    pub(super) fn call(&mut self, item: &Item, callee: OperandId, parameters: Run) -> Result<usize, Refusal> {
        let text = self.source.text;
        let called = self.source.tree.operand(callee);
        let instance = called.span.of(text);
        let block = self.called(callee)?;
        let parameters = parameters.of(&self.source.tree.parameters);
        let fed = self.fed.take();
        if fed.is_none() && self.is_edge(instance, parameters)? {
            return Ok(0);
        }
        if fed.is_some() && parameters.is_empty() && self.pulse(instance, &block, item)? {
            return Ok(2);
        }
        if fed.as_ref().is_some_and(|fed| *fed != folded(instance)) || fed.is_none() && !self.is_fresh() {
            return Err(Refusal::NotBoolean);
        }
        let mut power = None;
        let mut enable = None;
        let mut arguments = Vec::with_capacity(parameters.len());
        let power_in = block.power_in().unwrap_or_default();
        for (place, parameter) in parameters.iter().enumerate() {
            let (name, is_output, id) = argument(parameter, text, (&block, place))?;
            match folded(name) == folded(power_in) && !is_output {
                _ if name.eq_ignore_ascii_case(EN.name) && !is_output => enable = Some(id),
                true => power = Some(id),
                false => arguments.push((name, is_output, self.term(id)?)),
            }
        }
        let (wired, power_in) = match (power, fed.is_some(), enable) {
            (Some(id), false, None) => (Some(id), power_in),
            (None, true, None) => (None, power_in),
            (power, false, enable) => {
                if let Some(id) = power {
                    arguments.push((power_in, false, self.term(id)?));
                }
                (enable, EN.name)
            }
            _ => return Err(Refusal::Element),
        };
        if let Some(id) = wired {
            let contact = self.contact(id, ContactKind::NormallyOpen)?;
            self.builder.pass(Expression::Contact(contact)).ok_or(Refusal::TooDeep)?;
        }
        let own = self.source.term(self.pou, callee);
        let call = Call::new(block.clone(), power_in, own, arguments);
        let (call, terms) = call.ok_or_else(|| Refusal::Parameters(instance.into()))?;
        // An output that is written to an operand is no wire as well.
        let is_given = call.arguments(&terms).iter().any(|one| one.is_output && one.name == call.power_out());
        let output = self.next(1).filter(|_| !call.is_enabled() && !is_given);
        let action = Action { deed: Deed::Call(Arc::new(call)), terms, span: item.span };
        self.note(&action, self.at);
        match output.and_then(|next| self.loads(next, &output_of(&block, instance))) {
            None => {
                self.builder.drive(action);
                self.value = Value::Nothing;
                Ok(0)
            }
            Some(negated) => {
                self.builder.gate(Gate::Through(action)).ok_or(Refusal::TooDeep)?;
                if negated {
                    self.builder.gate(Gate::Invert).ok_or(Refusal::TooDeep)?;
                }
                self.value = Value::Power;
                Ok(1)
            }
        }
    }

    /// `CALC`, `CALCN`: the current result enables the call. Nothing is known of it behind that.
    pub(super) fn conditional_call(
        &mut self,
        item: &Item,
        callee: OperandId,
        parameters: Run,
        condition: Condition,
    ) -> Result<usize, Refusal> {
        if !self.frames.is_empty() {
            return Err(Refusal::NotBoolean);
        }
        let block = self.called(callee)?;
        let mut arguments = Vec::new();
        for (place, parameter) in parameters.of(&self.source.tree.parameters).iter().enumerate() {
            let (name, is_output, id) = argument(parameter, self.source.text, (&block, place))?;
            arguments.push((name, is_output, self.term(id)?));
        }
        self.settle()?;
        self.is_inverted ^= condition == Condition::IfFalse;
        self.invert()?;
        let own = self.source.term(self.pou, callee);
        let call = Call::new(block.clone(), EN.name, own, arguments);
        let call = call.filter(|(call, _)| !call.tells_enable());
        let (call, terms) = call.ok_or_else(|| Refusal::Parameters(self.name(callee).into()))?;
        let action = Action { deed: Deed::Call(Arc::new(call)), terms, span: item.span };
        self.note(&action, self.at);
        self.builder.drive(action);
        self.value = Value::Nothing;
        Ok(0)
    }

    /// Why a function is no box here: nobody knows it, or it is a part of a calculation that has no drawing.
    pub(super) fn uncalled(&self, name: &str) -> Refusal {
        let is_known =
            Function::named(name).is_some() || Computation::declared(name, self.source.scopes).is_some();
        if is_known { Refusal::NotBoolean } else { Refusal::Callee(name.into()) }
    }

    /// Notes what the instruction at item `index` may change, which is this action.
    pub(super) fn note(&mut self, action: &Action, index: usize) {
        self.driven.extend(action.changes().iter().map(|term| (term.key(), index)));
        self.ran = if action.runs_unit() { Some(index) } else { self.ran };
    }

    /// The item of the rung that stands so many behind the one that is read.
    fn next(&self, count: usize) -> Option<&'a Item> {
        let index = self.at + count;
        (index < self.end).then(|| self.source.item(index))
    }

    /// Drives the coil of an edge that the call of a detector is whose output is stored and nothing else; tells
    /// whether it is that.
    fn pulse(&mut self, instance: &str, block: &Callee, item: &Item) -> Result<bool, Refusal> {
        if !detects_rise(block) {
            return Ok(false);
        }
        let coil = CoilKind::Rising;
        let is_loaded = self.next(1).and_then(|next| self.loads(next, &output_of(block, instance)));
        let Some(store) = self.next(2) else { return Ok(false) };
        let ItemKind::Operation { operation, operand: Some(id) } = store.kind else { return Ok(false) };
        let word = operation.word.of(self.source.text);
        let stores =
            operation.operator.role == OperatorRole::Store && !operation.negated && !word.ends_with('?');
        let variable = self.source.tree.operand(id).span.of(self.source.text);
        // What goes on with the output sees more of it than the coil.
        let goes_on = self.next(3).is_some_and(|next| match next.kind {
            ItemKind::Operation { operation, .. } => operation.operator.role != OperatorRole::Load,
            _ => true,
        });
        if is_loaded != Some(false)
            || !stores
            || goes_on
            || !is_pulse_name(instance, coil, variable)
            || !self.source.is_pulse(self.pou, instance)
        {
            return Ok(false);
        }
        let term = self.bit(id)?;
        self.driven.insert(term.key(), self.at + 2);
        let span = item.span.to(store.span);
        self.builder.drive(Action { deed: Deed::Coil(coil), terms: vec![term], span });
        self.value = Value::Nothing;
        Ok(true)
    }

    /// Whether `item` loads `word`, and if so whether negated.
    fn loads(&self, item: &Item, word: &str) -> Option<bool> {
        let ItemKind::Operation { operation, operand: Some(id) } = item.kind else { return None };
        let operand = self.source.tree.operand(id).span.of(self.source.text);
        let is_it = operation.operator.role == OperatorRole::Load && operand.eq_ignore_ascii_case(word);
        is_it.then_some(operation.negated)
    }

    /// Whether a call is that of a detector which is an edge contact here.
    fn is_edge(&mut self, instance: &str, parameters: &[Parameter]) -> Result<bool, Refusal> {
        let block = self.source.block(self.pou, instance).ok_or(Refusal::Element)?;
        let ([parameter], true) = (parameters, detects_rise(&block)) else { return Ok(false) };
        if !self.frames.is_empty() || !self.source.is_edge(self.pou, instance, self.span) {
            return Ok(false);
        }
        let (name, is_output, operand) = argument(parameter, self.source.text, (&block, 0))?;
        if is_output || !name.eq_ignore_ascii_case("CLK") {
            return Ok(false);
        }
        self.bit(operand)?;
        self.edges.insert(folded(instance), Edge { operand, called_at: self.at });
        Ok(true)
    }
}

/// A parameter with its formal name, whether that is an output, and its operand. Without a name its place in the list
/// tells: inputs, then outputs.
fn argument<'t>(
    parameter: &Parameter,
    text: &'t str,
    (block, place): (&'t Callee, usize),
) -> Result<(&'t str, bool, OperandId), Refusal> {
    let ParameterValue::Operand(id) = parameter.value else { return Err(Refusal::NotBoolean) };
    let is_output = match parameter.direction {
        Direction::In => false,
        Direction::Out { negated: false } => true,
        Direction::Out { negated: true } => return Err(Refusal::NotBoolean),
    };
    if let Some(name) = parameter.name {
        return Ok((name.of(text), is_output, id));
    }
    let inputs = block.inputs();
    let is_output = place >= inputs.len();
    let formal = if is_output {
        block.outputs().into_iter().nth(place - inputs.len())
    } else {
        inputs.into_iter().nth(place)
    };
    Ok((formal.ok_or(Refusal::Element)?.name, is_output, id))
}

/// Whether a block is the one whose call stands for the contact of a rising edge. `F_TRIG` is none of a falling one:
/// its memory begins as if its input had been on, so that its first call may be on without an edge (IEC 61131-3, table
/// of edge detection).
pub(in crate::logic) fn detects_rise(block: &Callee) -> bool {
    block.is_standard("R_TRIG")
}
