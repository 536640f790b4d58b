//! Draws a function block on the power line.

use super::Planner;
use crate::ladder::reduce::Shape;
use crate::ladder::{Block, Element, ElementKind, Pin, PinWire};
use crate::logic::{Action, Call, Computation, Term};
use crate::target::iec::{EN, ENO};
use crate::text::{Message, Span, Spanned};

impl Planner {
    /// The box of a call. Its pins are drawn up to the last one with an operand; power `goes_on` from its first output
    /// or ends at the box.
    pub(super) fn block(&mut self, action: &Action, call: &Call, goes_on: bool) -> Result<Shape, Message> {
        let instance = action.terms.first().ok_or_else(|| Message::new("translate.no-drawing"))?;
        let instance = self.word(&instance.text);
        let type_name = self.word(call.block.name());
        let mut element = Element::new(ElementKind::Invert, Span::default(), 0, (0, 0));
        let mut inputs = self.pins(&mut element, action, call, false, true);
        let mut outputs = self.pins(&mut element, action, call, true, goes_on);
        let arguments = call.arguments(&action.terms);
        let enabled = arguments.last().filter(|last| last.is_output && last.name == ENO.name);
        let enabled = enabled.map(|argument| self.operand(&mut element, &argument.term));
        if call.is_enabled() {
            inputs.insert(0, self.pin(EN.name, PinWire::Power));
            outputs.insert(0, self.pin(ENO.name, enabled.unwrap_or(PinWire::Open)));
        } else if let Some(wire) = enabled {
            outputs.push(self.pin(ENO.name, wire));
        }
        element.kind = ElementKind::Block(Box::new(Block {
            instance: Some(instance),
            type_name: Some(type_name),
            rows: Vec::new(),
            inputs,
            outputs,
            ldmicro: None,
        }));
        Ok(self.add(element))
    }

    /// The box of a calculation, which power enables.
    pub(super) fn computation(
        &mut self,
        action: &Action,
        computation: &Computation,
    ) -> Result<Shape, Message> {
        let (inputs, result) =
            computation.operands(&action.terms).ok_or_else(|| Message::new("translate.no-drawing"))?;
        let type_name = self.word(computation.name());
        let mut element = Element::new(ElementKind::Invert, Span::default(), 0, (0, 0));
        let mut left = vec![self.pin(EN.name, PinWire::Power)];
        for (parameter, term) in computation.inputs().iter().zip(inputs) {
            let wire = self.operand(&mut element, term);
            left.push(self.pin(parameter.name, wire));
        }
        let wire = self.operand(&mut element, result);
        let right = vec![self.pin(ENO.name, PinWire::Open), self.pin(Computation::RESULT, wire)];
        element.kind = ElementKind::Block(Box::new(Block {
            instance: None,
            type_name: Some(type_name),
            rows: Vec::new(),
            inputs: left,
            outputs: right,
            ldmicro: None,
        }));
        Ok(self.add(element))
    }

    /// What stands beside a pin of `element`.
    fn operand(&mut self, element: &mut Element, term: &Term) -> PinWire {
        let span = self.word(&term.text);
        element.operands.push(Spanned::new(term.operand, span));
        PinWire::Operand(element.operands.len() - 1)
    }

    fn pin(&mut self, name: &str, wire: PinWire) -> Pin {
        Pin { name: Some(self.word(name)), implied: "", negated: false, row: 0, wire }
    }

    /// The pins of one side. The first has the power, if there is any.
    fn pins(
        &mut self,
        element: &mut Element,
        action: &Action,
        call: &Call,
        is_output: bool,
        has_power: bool,
    ) -> Vec<Pin> {
        let arguments = call.arguments(&action.terms);
        let argument = |name: &str| {
            arguments.iter().find(|argument| argument.is_output == is_output && argument.name == name)
        };
        let power = if is_output { call.power_out() } else { call.power_in() };
        let mut pins = Vec::new();
        for parameter in if is_output { call.block.outputs() } else { call.block.inputs() } {
            let wire = match argument(parameter.name) {
                Some(argument) => self.operand(element, &argument.term),
                None if has_power && parameter.name == power => PinWire::Power,
                None => PinWire::Open,
            };
            pins.push(self.pin(parameter.name, wire));
        }
        pins
    }
}
