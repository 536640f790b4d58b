//! Programs of which each contact is executed once in each scan.

use crate::logic::{Action, Deed, Path};
use crate::target::{Device, DeviceKind, Flow};
use crate::translate::source::Source;

/// Whether a rung is executed once in each scan if all rungs are such, and leaves to the CPU what tells of the scan.
pub(super) fn is_straight(source: &Source) -> bool {
    let is_plain = |action: &Action| match &action.deed {
        Deed::Jump | Deed::Return => false,
        Deed::Instruction(form) => {
            matches!(form.instruction.flow(), Flow::Straight | Flow::Nothing | Flow::ProgramEnd)
        }
        _ => !action.runs_unit(),
    };
    let is_of_scans = |device: Device| {
        device.kind == DeviceKind::M && (Device::ALWAYS_ON.number..=8003).contains(&device.number)
    };
    let drives =
        |action: &Action| action.changes().iter().any(|term| term.operand.device().is_some_and(is_of_scans));
    let is_such = |path: &Path| path.actions().into_iter().all(|action| is_plain(action) && !drives(action));
    source.rung.labels.is_empty() && source.rung.path.as_ref().is_ok_and(|path| path.iter().all(is_such))
}
