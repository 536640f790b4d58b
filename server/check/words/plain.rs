//! Instructions that are right at one look, which most are. The rules about words look at the others only.

use crate::document::Operation;
use crate::target::{Access, Constant, Device, DeviceKind, Form, Opcode, Operand, OperandSpec, Target};
use crate::text::Spanned;

/// Whether no rule about words and operands has anything to say about `operation`: a form that the model has, with as
/// many operands as it takes, each an ordinary device or number within its limits. What is right in a rarer way is not
/// plain, and left to the rules.
pub(in crate::check) fn is_plain(operation: &Operation<'_>, target: &Target) -> bool {
    let Some(form) = operation.form.filter(|form| target.is_fx() && form.is_on(target.model)) else {
        return false;
    };
    if form.instruction.opcode == Opcode::Itself {
        return false;
    }
    let operands = operation.operands;
    let first = operands.first().map(|first| first.value);
    let specs = match (form.instruction.operands, first.and_then(|first| first.device())) {
        (specs, Some(Device { kind: DeviceKind::T | DeviceKind::C, .. })) => specs,
        // OUT takes a preset for timers and counters only.
        ([driven @ .., preset], _) if preset.optional => driven,
        (specs, _) => specs,
    };
    let is_plain = |(place, (operand, spec)): (usize, (&Spanned<Operand>, &OperandSpec))| {
        spec.accepts.on(target.model).takes(&operand.value)
            && match operand.value {
                Operand::Device(device) => is_plain_device(device, form, spec, target),
                Operand::Constant { value: Constant::Real(_), .. } => false,
                Operand::Constant { value, index: None } => {
                    form.constant_fits(place, value, first.as_slice())
                }
                _ => false,
            }
    };
    operands.len() == specs.len() && operands.iter().zip(specs).enumerate().all(is_plain)
}

/// Whether all devices that an operand stands for lie in one range, and none has a part of its own: inputs and special
/// devices are not for writing, 32-bit counters not for all instructions.
fn is_plain_device(device: Device, form: Form, spec: &OperandSpec, target: &Target) -> bool {
    let is_special = match device.kind {
        DeviceKind::X => spec.access != Access::Read,
        DeviceKind::M => spec.access != Access::Read && device.number >= 8000,
        DeviceKind::C => device.number >= 200,
        _ => false,
    };
    let count = u32::from(spec.count).max(if form.wide { 2 } else { 1 });
    let last = device.number.saturating_add(count - 1);
    let mut ranges = target.ranges(device.kind);
    !is_special && ranges.any(|range| range.first <= device.number && last <= range.last)
}
