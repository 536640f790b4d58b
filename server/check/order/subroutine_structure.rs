//! # subroutine-structure
//!
//! Subroutines and interrupt routines stand behind `FEND`, which ends the main program: a subroutine begins with the
//! label that `CALL` names and ends with `SRET`, an interrupt routine begins with its pointer and ends with `IRET`.
//! In any other order the main program runs into a subroutine that nobody called, or a subroutine never comes back.
//!
//! ```fx
//! LD X0
//! CALL P1
//! P1
//! ^^
//! LD X1
//! OUT Y0
//! SRET
//! END
//! ```
//!
//! ```fx
//! EI
//! LD X0
//! CALL P1
//! FEND
//! P1
//! ^^
//! LD X1
//! OUT Y0
//! I001
//! ^^^^
//! LD M8000
//! INC D0
//! SRET
//! END
//! ```
//!
//! ```fx
//! EI
//! LD X0
//! CALL P1
//! FEND
//! P1
//! LD X1
//! OUT Y0
//! SRET
//! I001
//! LD M8000
//! INC D0
//! IRET
//! END
//! ```

use super::labels::END_POINTER;
use crate::check::statements::{Statement, StatementKind};
use crate::check::{ProgramContext, Rule, Run};
use crate::target::{Device, DeviceKind, Flow};
use crate::text::{Diagnostic, Message, Severity};
use rustc_hash::FxHashMap;

pub(super) const RULE: Rule = Rule {
    code: "subroutine-structure",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("subroutine_structure.rs"),
};

/// A routine while it is walked through.
struct Routine<'a> {
    label: Statement<'a>,
    /// The instruction that ends it.
    end: Flow,
    /// Whether an instruction has been met since the label.
    has_body: bool,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut calls: FxHashMap<Device, Statement<'_>> = FxHashMap::default();
    for call in context.executed().filter(|statement| statement.flow() == Some(Flow::Call)) {
        match call.device() {
            Some(END_POINTER) => found.push(call_of_end(&call)),
            Some(device) => {
                calls.entry(device).or_insert(call);
            }
            None => {}
        }
    }
    let has_main_end = context.executed().any(|statement| statement.flow() == Some(Flow::MainEnd));
    let mut walk = Walk { calls, has_main_end, behind_main: false, routine: None, misplaced: false };
    for statement in context.executed() {
        walk.statement(statement, found);
    }
}

struct Walk<'a> {
    /// The first call of each pointer.
    calls: FxHashMap<Device, Statement<'a>>,
    /// FEND stands somewhere.
    has_main_end: bool,
    /// FEND has been passed.
    behind_main: bool,
    routine: Option<Routine<'a>>,
    /// A routine before FEND has been reported, and its end is no second mistake.
    misplaced: bool,
}

impl<'a> Walk<'a> {
    fn statement(&mut self, statement: Statement<'a>, found: &mut Vec<Diagnostic>) {
        match statement.kind {
            StatementKind::Label(device) => {
                let is_interrupt = device.kind == DeviceKind::I;
                if is_interrupt || self.calls.contains_key(&device) {
                    self.label(statement, device, is_interrupt, found);
                }
            }
            StatementKind::Instruction(flow @ (Flow::SubroutineEnd | Flow::InterruptEnd)) => {
                self.routine_end(statement, flow, found);
            }
            StatementKind::Instruction(Flow::MainEnd | Flow::ProgramEnd) => {
                found.extend(self.routine.take().map(|routine| unended(&routine, &statement)));
                self.behind_main = true;
                self.misplaced = false;
            }
            _ => {
                if let Some(routine) = &mut self.routine {
                    routine.has_body = true;
                }
            }
        }
    }

    fn label(
        &mut self,
        label: Statement<'a>,
        device: Device,
        is_interrupt: bool,
        found: &mut Vec<Diagnostic>,
    ) {
        if !self.behind_main {
            // Without FEND all routines stand in the wrong place; one report is enough.
            if self.has_main_end || !self.misplaced {
                found.push(self.before_main_end(&label, device));
            }
            self.misplaced = true;
            return;
        }
        if let Some(routine) = self.routine.take().filter(|routine| routine.has_body) {
            found.push(unended(&routine, &label));
        }
        let end = if is_interrupt { Flow::InterruptEnd } else { Flow::SubroutineEnd };
        self.routine = Some(Routine { label, end, has_body: false });
    }

    fn before_main_end(&self, label: &Statement<'_>, device: Device) -> Diagnostic {
        let key = match self.has_main_end {
            true => "subroutine-structure.before-main-end",
            false => "subroutine-structure.no-main-end",
        };
        let message = Message::new(key).with("label", device);
        let mut diagnostic = Diagnostic::new(RULE.code, label.word, message);
        if let Some(call) = self.calls.get(&device) {
            diagnostic = diagnostic.related(call.span, Message::new("subroutine-structure.called"));
        }
        match label.line_before("FEND").filter(|_| !self.has_main_end) {
            Some(edit) => {
                let title = Message::new("subroutine-structure.add-main-end").with("label", device);
                diagnostic.fix(title, vec![edit])
            }
            None => diagnostic,
        }
    }

    fn routine_end(&mut self, statement: Statement<'a>, flow: Flow, found: &mut Vec<Diagnostic>) {
        match self.routine.take() {
            Some(routine) if routine.end != flow => found.push(unended(&routine, &statement)),
            None if !self.behind_main && !self.misplaced => {
                let message =
                    Message::new("subroutine-structure.in-main").with("instruction", statement.mnemonic());
                let mut diagnostic = Diagnostic::new(RULE.code, statement.word, message);
                if let Some(removal) = statement.removal() {
                    let title =
                        Message::new("subroutine-structure.remove").with("word", statement.mnemonic());
                    diagnostic = diagnostic.fix(title, vec![removal]);
                }
                found.push(diagnostic);
            }
            _ => {}
        }
    }
}

/// A routine that goes on into something else.
fn unended(routine: &Routine<'_>, next: &Statement<'_>) -> Diagnostic {
    let end = if routine.end == Flow::InterruptEnd { "IRET" } else { "SRET" };
    let message = Message::new("subroutine-structure.no-end")
        .with("label", routine.label.mnemonic())
        .with("end", end)
        .with("next", next.mnemonic());
    let related = Message::new("subroutine-structure.before").with("end", end);
    let diagnostic = Diagnostic::new(RULE.code, routine.label.word, message).related(next.span, related);
    let title = Message::new("subroutine-structure.add-end").with("end", end).with("next", next.mnemonic());
    match next.line_before(end) {
        Some(edit) => diagnostic.fix(title, vec![edit]),
        None => diagnostic,
    }
}

fn call_of_end(call: &Statement<'_>) -> Diagnostic {
    let span = call.first.map_or(call.word, |operand| operand.span);
    Diagnostic::new(RULE.code, span, Message::new("subroutine-structure.call-of-end"))
}
