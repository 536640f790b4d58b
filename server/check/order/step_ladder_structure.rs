//! # step-ladder-structure
//!
//! A step ladder is a run of states, each begun by `STL`, and ends with one `RET`. Without the `RET` the rungs behind
//! it belong to the last state and run only while that is on. Each state is begun once. Master controls do not go
//! together with steps, nor do subroutines and interrupt routines contain them.
//!
//! ```fx
//! LD M8002
//! SET S0
//! STL S0
//! LD X0
//! SET S20
//! STL S20
//! ^^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! STL S20
//! OUT Y0
//! LD X0
//! MC N0 M100
//! ^^
//! LD X1
//! OUT Y1
//! MCR N0
//! STL S20
//!     ^^^
//! OUT Y2
//! RET
//! RET
//! ^^^
//! END
//! ```
//!
//! ```fx
//! LD M8002
//! SET S0
//! STL S0
//! LD X0
//! SET S20
//! STL S20
//! OUT Y0
//! LD X1
//! SET S0
//! RET
//! END
//! ```

use super::labels::Labels;
use crate::check::statements::{Statement, StatementKind};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Symbol;
use crate::target::{Device, DeviceKind, Flow};
use crate::text::{Diagnostic, Message, Severity, Span};
use rustc_hash::{FxHashMap, FxHashSet};

pub(super) const RULE: Rule = Rule {
    code: "step-ladder-structure",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("step_ladder_structure.rs"),
};

/// Where the walk through the program stands.
#[derive(Default)]
struct Place<'a> {
    /// The last STL without a RET behind it.
    step: Option<Statement<'a>>,
    /// Master controls that were opened in a step.
    sections: u32,
    /// FEND has been passed.
    behind_main: bool,
    /// The label of the subroutine or interrupt routine.
    routine: Option<Statement<'a>>,
    /// Where each state is begun.
    states: FxHashMap<Device, Span>,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let called = called(context);
    let mut place = Place::default();
    for statement in context.executed() {
        match statement.kind {
            StatementKind::Label(label) if place.behind_main && called.contains(&label) => {
                place.routine = Some(statement);
            }
            StatementKind::Instruction(flow) => place.instruction(flow, statement, found),
            _ => {}
        }
    }
    if let Some(step) = place.step {
        found.push(without_return(&step, None));
    }
}

/// The pointers at which routines begin: those that CALL names, and those of interrupts.
fn called(context: &ProgramContext<'_>) -> FxHashSet<Device> {
    let calls = context.executed().filter(|statement| statement.flow() == Some(Flow::Call));
    let mut called: FxHashSet<Device> = calls.filter_map(|call| call.device()).collect();
    for label in Labels::of(context).iter().flat_map(|labels| &labels.declared) {
        if let Symbol::Device(device) = label.symbol
            && device.kind == DeviceKind::I
        {
            called.insert(device);
        }
    }
    called
}

impl<'a> Place<'a> {
    fn instruction(&mut self, flow: Flow, statement: Statement<'a>, found: &mut Vec<Diagnostic>) {
        match flow {
            Flow::Step => self.begin_step(statement, found),
            Flow::StepsEnd => {
                if self.step.take().is_none() {
                    found.push(lone_return(&statement));
                }
                self.sections = 0;
            }
            Flow::SectionBegin | Flow::SectionEnd => self.section(flow, statement, found),
            Flow::SubroutineEnd | Flow::InterruptEnd => self.routine = None,
            Flow::MainEnd | Flow::ProgramEnd => {
                found.extend(self.step.take().map(|step| without_return(&step, Some(&statement))));
                self.behind_main = true;
                self.routine = None;
            }
            _ => {}
        }
    }

    fn begin_step(&mut self, statement: Statement<'a>, found: &mut Vec<Diagnostic>) {
        if let Some(routine) = self.routine {
            let message = Message::new("step-ladder-structure.routine").with("label", routine.mnemonic());
            let related = Message::new("step-ladder-structure.routine-here");
            found.push(Diagnostic::new(RULE.code, statement.word, message).related(routine.word, related));
        }
        self.step = Some(statement);
        self.sections = 0;
        let (Some(state), Some(operand)) = (statement.device(), statement.first) else { return };
        let first = *self.states.entry(state).or_insert(operand.span);
        if first != operand.span {
            let message = Message::new("step-ladder-structure.twice").with("state", state);
            let related = Message::new("step-ladder-structure.first").with("state", state);
            found.push(Diagnostic::new(RULE.code, operand.span, message).related(first, related));
        }
    }

    /// Master controls in a step. An MCR is reported only where its MC is not.
    fn section(&mut self, flow: Flow, statement: Statement<'a>, found: &mut Vec<Diagnostic>) {
        let Some(step) = self.step else { return };
        let is_begin = flow == Flow::SectionBegin;
        if is_begin || self.sections == 0 {
            let message =
                Message::new("step-ladder-structure.section").with("instruction", statement.mnemonic());
            let related = Message::new("step-ladder-structure.step").with("step", step.text());
            found.push(Diagnostic::new(RULE.code, statement.word, message).related(step.span, related));
        }
        self.sections = if is_begin { self.sections + 1 } else { self.sections.saturating_sub(1) };
    }
}

fn lone_return(statement: &Statement<'_>) -> Diagnostic {
    let diagnostic =
        Diagnostic::new(RULE.code, statement.word, Message::new("step-ladder-structure.lone-return"));
    match statement.removal() {
        Some(removal) => diagnostic.fix(Message::new("step-ladder-structure.remove"), vec![removal]),
        None => diagnostic,
    }
}

fn without_return(step: &Statement<'_>, end: Option<&Statement<'_>>) -> Diagnostic {
    let message = Message::new("step-ladder-structure.no-return").with("step", step.text());
    let diagnostic = Diagnostic::new(RULE.code, step.word, message);
    let Some(end) = end else { return diagnostic };
    let diagnostic = diagnostic.related(end.span, Message::new("step-ladder-structure.before"));
    match end.line_before("RET") {
        Some(edit) => {
            let title = Message::new("step-ladder-structure.close").with("end", end.mnemonic());
            diagnostic.fix(title, vec![edit])
        }
        None => diagnostic,
    }
}
