//! Draws a function block on the power line.

use super::Planner;
use crate::ladder::reduce::Shape;
use crate::ladder::{Block, Element, ElementKind, Pin, PinWire};
use crate::logic::{Action, Call};
use crate::target::iec::Parameter;
use crate::text::{Message, Span, Spanned};

impl Planner {
    /// The box of a call. Its pins are drawn up to the last one with an operand; power `goes_on` from its first output
    /// or ends at the box.
    pub(super) fn block(&mut self, action: &Action, call: Call, goes_on: bool) -> Result<Shape, Message> {
        let instance = action.terms.first().ok_or_else(|| Message::new("translate.no-drawing"))?;
        let instance = self.word(&instance.text);
        let type_name = self.word(call.block.name);
        let mut element = Element::new(ElementKind::Invert, Span::default(), 0, (0, 0));
        let inputs = self.pins(&mut element, action, call, (call.block.inputs, false), true);
        let outputs = self.pins(&mut element, action, call, (call.block.outputs, true), goes_on);
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

    /// The pins of one side. The first has the power, if there is any.
    fn pins(
        &mut self,
        element: &mut Element,
        action: &Action,
        call: Call,
        (names, is_output): (&[Parameter], bool),
        has_power: bool,
    ) -> Vec<Pin> {
        let arguments = call.arguments(&action.terms);
        let argument = |name: &str| {
            arguments.iter().find(|argument| argument.is_output == is_output && argument.name == name)
        };
        let power = if is_output { call.power_out() } else { call.power_in() };
        let mut pins = Vec::new();
        for parameter in names {
            let wire = match argument(parameter.name) {
                Some(argument) => {
                    let span = self.word(&argument.term.text);
                    element.operands.push(Spanned::new(argument.term.operand, span));
                    PinWire::Operand(element.operands.len() - 1)
                }
                None if has_power && parameter.name == power => PinWire::Power,
                None => PinWire::Open,
            };
            let name = Some(self.word(parameter.name));
            pins.push(Pin { name, implied: "", negated: false, row: 0, wire });
        }
        pins
    }
}
