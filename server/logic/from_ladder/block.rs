//! Reads a function block on the power line.

use crate::document::Scopes;
use crate::ladder::{Block, Element, Pin, PinWire};
use crate::logic::{Action, Call, Callee, Computation, Deed, Refusal, Term};
use crate::target::Operand;
use crate::target::iec::{EN, ENO, Function};
use crate::text::folded;
use std::sync::Arc;

/// The call that a box is, and whether power goes on behind it.
///
/// Power comes to one input of a block and goes on from its first output that is a bit, or it enables the call; the
/// other pins have operands or nothing. A box without an instance is a function that power enables. Anything else, such
/// as a circle at a pin, is refused.
pub(super) fn call(
    text: &str,
    element: &Element,
    block: &Block,
    scopes: &Scopes,
) -> Result<(Action, bool), Refusal> {
    let name = block.type_text(text).ok_or(Refusal::Element)?;
    let function = || Computation::declared(name, scopes).or_else(|| Computation::named(name));
    if block.instance.is_none()
        && let Some(computation) = function()
    {
        return Ok((self::computation(text, element, block, computation)?, false));
    }
    let is_known = Function::named(name).is_some();
    let unknown = || if is_known { Refusal::Element } else { Refusal::Callee(name.into()) };
    let row = Callee::block(name, scopes).ok_or_else(unknown)?;
    let instance = block.instance.ok_or(Refusal::Element)?;
    let instance = Term::new(Operand::Variable, instance.of(text), instance);
    let mut arguments = Vec::new();
    let mut power = None;
    let mut goes_on = false;
    for (side, pins, main) in [(0, &block.inputs, row.power_in()), (1, &block.outputs, row.power_out())] {
        let main = main.unwrap_or_default();
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
                PinWire::Power if side == 1 && (name.is_empty() || folded(name) == folded(main)) => {
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
    let (call, terms) =
        Call::new(row.clone(), power, instance, arguments).ok_or_else(|| Refusal::Parameters(name.into()))?;
    Ok((Action { deed: Deed::Call(Arc::new(call)), terms, span: element.span }, goes_on))
}

/// The calculation that a box with EN is, each of whose other pins has an operand.
fn computation(
    text: &str,
    element: &Element,
    block: &Block,
    computation: Computation,
) -> Result<Action, Refusal> {
    let operand = |pin: &Pin| match pin.wire {
        PinWire::Operand(index) if !pin.negated => {
            let operand = element.operands.get(index).ok_or(Refusal::Element)?;
            Ok(Term::new(operand.value, &element.operand_text(index, text), operand.span))
        }
        _ => Err(Refusal::Element),
    };
    let is = |pin: &Pin, name: &str| folded(pin.formal(text)) == folded(name);
    let (enable, inputs) = block.inputs.split_first().ok_or(Refusal::Element)?;
    if !is(enable, EN.name) || enable.negated || enable.wire != PinWire::Power {
        return Err(Refusal::Element);
    }
    let names = computation.inputs();
    let in_order = inputs.len() == names.len()
        && inputs.iter().zip(&names).all(|(pin, parameter)| is(pin, parameter.name) || is(pin, ""));
    // Where power goes on from ENO, something is drawn behind the box.
    let is_idle = |pin: &&Pin| is(pin, ENO.name) && pin.wire == PinWire::Open;
    let results: Vec<&Pin> = block.outputs.iter().filter(|pin| !is_idle(pin)).collect();
    let [result] = &results[..] else { return Err(Refusal::Element) };
    if !in_order || is(result, ENO.name) {
        return Err(Refusal::Element);
    }
    let mut terms = inputs.iter().map(operand).collect::<Result<Vec<_>, _>>()?;
    terms.push(operand(result)?);
    Ok(Action { deed: Deed::Compute(computation), terms, span: element.span })
}
