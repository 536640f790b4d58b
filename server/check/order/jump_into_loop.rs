//! # jump-into-loop
//!
//! A jump goes from outside into a loop between `FOR` and `NEXT`. The loop was never begun, so its count is whatever
//! the last one left, and `NEXT` may run the rungs any number of times; a watchdog error is the mild outcome. Jump to
//! the `FOR`, or out of a loop, which is allowed.
//!
//! ```fx
//! LD X0
//! CJ P1
//!    ^^
//! FOR K10
//! LD X1
//! INC D0
//! P1
//! LD X2
//! INC D1
//! NEXT
//! END
//! ```
//!
//! ```fx
//! LD X0
//! CJ P1
//! LD X1
//! OUT Y0
//! P1
//! FOR K10
//! LD X2
//! INC D1
//! NEXT
//! END
//! ```

use crate::check::statements::{Statement, StatementKind};
use crate::check::{ProgramContext, Rule, Run};
use crate::target::{Device, Flow};
use crate::text::{Diagnostic, Message, Severity, Span};
use rustc_hash::FxHashMap;

pub(super) const RULE: Rule = Rule {
    code: "jump-into-loop",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("jump_into_loop.rs"),
};

/// A loop: the offsets of its FOR and of its NEXT.
struct Loop<'a> {
    begin: Statement<'a>,
    end: u32,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut loops: Vec<Loop<'_>> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let mut labels: FxHashMap<Device, (Span, Option<usize>)> = FxHashMap::default();
    let mut jumps: Vec<(Device, Span)> = Vec::new();
    for statement in context.executed() {
        match statement.kind {
            StatementKind::Instruction(Flow::LoopBegin) => {
                open.push(loops.len());
                // A loop without an end is reported by its own rule; nothing jumps into it from behind.
                loops.push(Loop { begin: statement, end: u32::MAX });
            }
            StatementKind::Instruction(Flow::LoopEnd) => {
                if let Some(closed) = open.pop() {
                    loops[closed].end = statement.span.end;
                }
            }
            StatementKind::Label(device) => {
                labels.entry(device).or_insert((statement.word, open.last().copied()));
            }
            StatementKind::Instruction(Flow::Jump) => {
                let operand = statement.first.map_or(statement.word, |operand| operand.span);
                jumps.extend(statement.device().map(|device| (device, operand)));
            }
            _ => {}
        }
    }
    for (device, jump) in jumps {
        let Some(&(label, Some(innermost))) = labels.get(&device) else { continue };
        let Loop { begin, end } = &loops[innermost];
        if jump.start < begin.span.start || *end < jump.start {
            let message = Message::new("jump-into-loop.found").with("label", device);
            found.push(
                Diagnostic::new(RULE.code, jump, message)
                    .related(begin.span, Message::new("jump-into-loop.loop"))
                    .related(label, Message::new("jump-into-loop.label")),
            );
        }
    }
}
