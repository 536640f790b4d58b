//! Reads a function block on the power line.

use crate::ladder::{Block, Element, PinWire};
use crate::logic::{Action, Call, Deed, Refusal, Term};
use crate::target::Operand;
use crate::target::iec::FunctionBlock;

/// The call that a box is, and whether power goes on behind it.
///
/// Power comes to one input of a standard block and goes on from its first output; the other pins have operands
/// or nothing. Anything else, such as a box with EN or a circle at a pin, is refused.
pub(super) fn call(text: &str, element: &Element, block: &Block) -> Result<(Action, bool), Refusal> {
    let row = block.type_text(text).and_then(FunctionBlock::named).ok_or(Refusal::Element)?;
    let instance = block.instance.ok_or(Refusal::Element)?;
    let instance = Term::new(Operand::Variable, instance.of(text), instance);
    let mut arguments = Vec::new();
    let mut power = None;
    let mut goes_on = false;
    for (side, pins, own) in [(0, &block.inputs, row.inputs), (1, &block.outputs, row.outputs)] {
        let main = own.first().map_or("", |pin| pin.name);
        for pin in pins {
            let name = pin.formal(text);
            if pin.negated {
                return Err(Refusal::Element);
            }
            match pin.wire {
                // A pin without a name is the main one.
                PinWire::Power if side == 0 && power.is_none() => {
                    power = Some(if name.is_empty() { main } else { name });
                }
                PinWire::Power if side == 1 && (name.is_empty() || name.eq_ignore_ascii_case(main)) => {
                    goes_on = true;
                }
                PinWire::Power => return Err(Refusal::Element),
                PinWire::Open => {}
                PinWire::Operand(index) => {
                    let operand = element.operands.get(index).ok_or(Refusal::Element)?;
                    let term = Term::new(operand.value, &element.operand_text(index, text), operand.span);
                    arguments.push((name, side == 1, term));
                }
            }
        }
    }
    let power = power.ok_or(Refusal::Element)?;
    let (call, terms) = Call::new(row, power, instance, arguments).ok_or(Refusal::Element)?;
    Ok((Action { deed: Deed::Call(call), terms, span: element.span }, goes_on))
}
