//! # code-after-end
//!
//! Instructions stand behind `END`. The PLC never reaches them: the scan starts again at step 0. Mostly `END` was left
//! where a program once ended, and the rungs added behind it do nothing on the machine. Subroutines stand before
//! `END`, between it and `FEND`. Where a project lists its files in the order of execution, `END` stands in the last of
//! them alone.
//!
//! ```fx
//! LD X0
//! OUT Y0
//! END
//! LD X1
//! ^^^^^
//! OUT Y1
//! ```
//!
//! ```fx
//! LD X0
//! OUT Y0
//! LD X1
//! OUT Y1
//! END
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//! +--| |-------( )-+
//!
//! |                |
//! +--------[END]---+
//!
//! |  X1        Y1  |
//! +--| |-------( )-+
//!    ^^^
//! ```

use crate::check::statements::Statement;
use crate::check::{ProgramContext, Rule, Run};
use crate::target::Flow;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "code-after-end",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("code_after_end.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut end: Option<Statement<'_>> = None;
    let mut behind: Option<Statement<'_>> = None;
    let (mut count, mut last) = (0, None);
    for statement in context.statements() {
        match (end, statement.flow()) {
            (_, Some(Flow::Nothing)) => {}
            (None, Some(Flow::ProgramEnd)) => end = Some(statement),
            (None, _) => {}
            (Some(_), _) => {
                behind.get_or_insert(statement);
                last = Some(statement);
                count += statement.count;
            }
        }
    }
    let (Some(end), Some(first)) = (end, behind) else { return };
    let message = Message::new("code-after-end.found").with("count", count);
    let mut diagnostic =
        Diagnostic::new(RULE.code, first.span, message).related(end.span, Message::new("code-after-end.end"));
    // Where the last instruction is an END itself, the first one goes; else it moves there.
    let moved = match last {
        Some(last) if last.flow() != Some(Flow::ProgramEnd) => last.line_behind(end.text()).map(Some),
        _ => Some(None),
    };
    if let (Some(removal), Some(moved)) = (end.removal(), moved) {
        let key = if moved.is_some() { "code-after-end.move-end" } else { "code-after-end.remove-end" };
        diagnostic = diagnostic.fix(Message::new(key), std::iter::once(removal).chain(moved).collect());
    }
    found.push(diagnostic);
}
