//! # for-next-balance
//!
//! `FOR` begins a loop and `NEXT` ends it, one for one, within the same part of the program: before `FEND`, or before
//! the `SRET` of the subroutine. Without its half the PLC cannot know what to repeat, and it does not run.
//!
//! ```fx
//! FOR K10
//! ^^^
//! LD M8000
//! INC D0
//! END
//! ```
//!
//! ```fx
//! LD M8000
//! INC D0
//! NEXT
//! ^^^^
//! END
//! ```
//!
//! ```fx
//! FOR K10
//! LD M8000
//! INC D0
//! NEXT
//! END
//! ```

use crate::check::statements::Statement;
use crate::check::{ProgramContext, Rule, Run};
use crate::target::Flow;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "for-next-balance",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("for_next_balance.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut open: Vec<Statement<'_>> = Vec::new();
    for statement in context.executed() {
        match statement.flow() {
            Some(Flow::LoopBegin) => open.push(statement),
            Some(Flow::LoopEnd) => {
                let begin = open.pop();
                found.extend(begin.is_none().then(|| without_begin(&statement)));
            }
            Some(Flow::MainEnd | Flow::ProgramEnd | Flow::SubroutineEnd | Flow::InterruptEnd) => {
                found.extend(open.drain(..).map(|begin| without_end(&begin, Some(&statement))));
            }
            _ => {}
        }
    }
    found.extend(open.iter().map(|begin| without_end(begin, None)));
}

fn without_begin(next: &Statement<'_>) -> Diagnostic {
    let diagnostic = Diagnostic::new(RULE.code, next.word, Message::new("for-next-balance.no-begin"));
    match next.removal() {
        Some(removal) => diagnostic.fix(Message::new("for-next-balance.remove"), vec![removal]),
        None => diagnostic,
    }
}

fn without_end(begin: &Statement<'_>, end: Option<&Statement<'_>>) -> Diagnostic {
    let diagnostic = Diagnostic::new(RULE.code, begin.word, Message::new("for-next-balance.no-end"));
    let Some(end) = end else { return diagnostic };
    let diagnostic = diagnostic.related(end.span, Message::new("for-next-balance.before"));
    match end.line_before("NEXT") {
        Some(edit) => {
            let title = Message::new("for-next-balance.close").with("end", end.mnemonic());
            diagnostic.fix(title, vec![edit])
        }
        None => diagnostic,
    }
}
