//! # missing-preset
//!
//! The coil of a timer or counter has no preset: the value at which its contact closes. It is a constant or a data
//! register, in units of the timer (0.1 s for T0 to T199) or in counts. The PLC refuses such a program (error 6503).
//!
//! ```fx
//! LD X0
//! OUT T0
//!     ^^
//! LD X1
//! OUT C0
//!     ^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT T0 K50
//! LD X1
//! OUT C0 D10
//! END
//! ```
//!
//! ```lad
//! |  X0                T5   |
//!                      ^^
//! +--| |---------------( )--+
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::document::Tree;
use crate::target::{Device, DeviceKind};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "missing-preset",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("missing_preset.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if !context.target.is_fx() {
        return;
    }
    for operation in &context.doubtful {
        let specs = operation.form.map_or(&[][..], |form| form.instruction.operands);
        let [operand] = operation.operands else { continue };
        if !specs.get(1).is_some_and(|spec| spec.optional) {
            continue;
        }
        let Some(device) = operand.value.device() else { continue };
        let key = match device.kind {
            DeviceKind::T => "missing-preset.timer",
            DeviceKind::C => "missing-preset.counter",
            _ => continue,
        };
        let unit_ms = device.range_on(context.target).map_or(0, |range| range.timer_unit_ms);
        let message = Message::new(key).with("device", device).with("unit", seconds(unit_ms));
        let diagnostic = Diagnostic::new(RULE.code, operand.span, message);
        // In a drawing the preset has a place of its own, which is found by eye.
        let is_drawn = matches!(context.chunk.tree(), Tree::Ladder(_));
        found.push(if is_drawn { diagnostic } else { with_preset(diagnostic, device, unit_ms) });
    }
}

fn with_preset(diagnostic: Diagnostic, device: Device, unit_ms: u32) -> Diagnostic {
    let key =
        if device.kind == DeviceKind::T { "missing-preset.add-time" } else { "missing-preset.add-count" };
    let title = Message::new(key).with("time", seconds(unit_ms * 10));
    let end = Span::at(diagnostic.span.end as usize);
    diagnostic.fix(title, vec![TextEdit::new(end, " K10")])
}

/// Milliseconds as people write them: 100 is `0.1 s`, 1 is `0.001 s`.
fn seconds(ms: u32) -> String {
    format!("{} s", f64::from(ms) / 1000.0)
}
