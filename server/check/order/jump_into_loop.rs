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
    // With the loops around each, the outermost first.
    let mut labels: FxHashMap<Device, (Statement<'_>, Vec<usize>)> = FxHashMap::default();
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
                labels.entry(device).or_insert_with(|| (statement, open.clone()));
            }
            StatementKind::Instruction(Flow::Jump) => {
                let operand = statement.first.map_or(statement.word, |operand| operand.span);
                jumps.extend(statement.device().map(|device| (device, operand)));
            }
            _ => {}
        }
    }
    for (device, jump) in &jumps {
        let Some((label, around)) = labels.get(device) else { continue };
        let Some(innermost) = around.last().map(|innermost| &loops[*innermost]) else { continue };
        if !innermost.is_entered_by(*jump) {
            continue;
        }
        let message = Message::new("jump-into-loop.found").with("label", device);
        let diagnostic = Diagnostic::new(RULE.code, *jump, message)
            .related(innermost.begin.span, Message::new("jump-into-loop.loop"))
            .related(label.word, Message::new("jump-into-loop.label"));
        // Jumps within the loop go on with its next round, and must stay there.
        let entered = around.iter().map(|outer| &loops[*outer]).find(|outer| outer.is_entered_by(*jump));
        let mut others = jumps.iter().filter(|(other, _)| other == device);
        let entered = entered.filter(|entered| others.all(|(_, other)| entered.is_entered_by(*other)));
        let moved = entered
            .and_then(|entered| Some(vec![entered.begin.line_before(label.text())?, label.removal()?]));
        found.push(match moved {
            Some(edits) => {
                let title = Message::new("jump-into-loop.move").with("label", device);
                diagnostic.fix(title, edits)
            }
            None => diagnostic,
        });
    }
}

impl Loop<'_> {
    /// Whether a jump to a label in it comes from outside.
    fn is_entered_by(&self, jump: Span) -> bool {
        jump.start < self.begin.span.start || self.end < jump.start
    }
}
