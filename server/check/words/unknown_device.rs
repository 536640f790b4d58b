//! # unknown-device
//!
//! The word is no device, constant or pointer of this PLC: its letter names no kind of device, or no number follows.
//! The PLC cannot run the rung, and a typing mistake in a device name is the most common cause of a rung that does
//! nothing.
//!
//! ```fx
//! LD Q0
//!    ^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD M0
//! OUT Y0
//! END
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::target::{Operand, OperandProblem};
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "unknown-device",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("unknown_device.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    for operand in context.chunk.operations().flat_map(|operation| operation.operands) {
        let unknown = match operand.value {
            Operand::Invalid(OperandProblem::UnknownDevice | OperandProblem::Unreadable) => true,
            Operand::Device(device) => {
                context.target.is_fx() && context.target.ranges(device.kind).next().is_none()
            }
            _ => false,
        };
        if unknown {
            let message = Message::new("unknown-device.found")
                .with("word", operand.span.of(context.chunk.text()))
                .with("target", context.target.title);
            found.push(Diagnostic::new(RULE.code, operand.span, message));
        }
    }
}
