//! # no-current-result
//!
//! An instruction works on the current result, the power that the contacts before it let through, and there is none:
//! a rung begins with `LD` or one of its kin. The PLC refuses the program, since it cannot know what drives the
//! output.
//!
//! ```fx
//! AND X0
//! ^^^
//! OUT Y0
//! END
//! ```
//!
//! Behind `MC` every rung begins anew, and in a step the first contact is an `LD`; only outputs may follow `STL`
//! directly.
//!
//! ```fx
//! LD X0
//! MC N0 M100
//! OUT Y0
//! ^^^
//! MCR N0
//! STL S20
//! AND X1
//! ^^^
//! SET S21
//! RET
//! END
//! ```
//!
//! ```fx
//! LD X0
//! MC N0 M100
//! LD X2
//! OUT Y0
//! MCR N0
//! STL S20
//! OUT Y1
//! LD X1
//! SET S21
//! RET
//! END
//! ```
//!
//! In Instruction List of IEC 61131-3 the same holds where a body starts, inside a parenthesis, and behind an
//! unconditional `JMP` or `RET` as long as no label follows. A function without parentheses takes the current result
//! as its first input: `ADD 1` adds to what was loaded.
//!
//! ```iec
//! PROGRAM Press
//! VAR
//!     Ready, Closed, Stroke : BOOL;
//!     Count : INT;
//! END_VAR
//!     AND Ready
//!     ^^^
//!     ST Stroke
//!     LD Ready
//!     AND(
//!         OR Closed
//!         ^^
//!     )
//!     ST Stroke
//!     RET
//!     ST Closed
//!     ^^
//! END_PROGRAM
//!
//! PROGRAM Counting
//! VAR
//!     Count : INT;
//! END_VAR
//!     ADD Count, 1
//!     ^^^
//!     ST Count
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Press
//! VAR
//!     Ready, Closed, Stroke : BOOL;
//!     Count : INT;
//! END_VAR
//!     LD Ready
//!     JMPCN Open
//!     AND(
//!         LD Closed
//!         OR Stroke
//!     )
//!     ST Stroke
//! Open:
//!     LD Count
//!     ADD 1
//!     ST Count
//! END_PROGRAM
//! ```

use super::rung::{After, Finding};
use crate::check::iec::{View, follow};
use crate::check::statements::line_before;
use crate::check::{ChunkContext, Rule, Run};
use crate::il::fx::{FxLine, FxTree, LineKind};
use crate::target::{Form, Role};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "no-current-result",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("no_current_result.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if let Some(view) = View::of(context) {
        // One walk finds what four rules report: the type of the current result is known where it exists.
        return found.extend(follow(view).0);
    }
    let Some((tree, findings)) = context.rung() else { return };
    for finding in findings {
        if let &Finding::NoResult { line, after } = finding {
            found.push(diagnostic(context.chunk.text(), tree, &tree.lines[line], after));
        }
    }
}

fn diagnostic(text: &str, tree: &FxTree, line: &FxLine, after: After) -> Diagnostic {
    let key = match after {
        After::Start => "no-current-result.start",
        After::Section(_) => "no-current-result.section",
        After::Step(_) => "no-current-result.step",
    };
    let word = line.mnemonic.of(text);
    let mut diagnostic = Diagnostic::new(RULE.code, line.mnemonic, Message::new(key).with("word", word));
    if let After::Section(other) | After::Step(other) = after {
        let other = tree.lines[other].span;
        diagnostic =
            diagnostic.related(other, Message::new("no-current-result.here").with("word", other.of(text)));
    }
    let LineKind::Instruction(form) = line.kind else { return diagnostic };
    match form.instruction.role {
        Role::Output => {
            let title = Message::new("no-current-result.always").with("word", word);
            diagnostic.fix(title, vec![line_before(text, line.mnemonic, "LD M8000")])
        }
        Role::Series | Role::Parallel => match load_for(form) {
            Some(load) => {
                let title = Message::new("no-current-result.begin").with("load", &load);
                diagnostic.fix(title, vec![TextEdit::new(line.mnemonic, load)])
            }
            None => diagnostic,
        },
        _ => diagnostic,
    }
}

/// The contact of the same kind that begins a rung: LDI for ANI and ORI, LD= for AND=.
fn load_for(form: Form) -> Option<String> {
    let mnemonic = form.mnemonic();
    let kind = ["AND", "AN", "OR"].iter().find_map(|head| mnemonic.strip_prefix(head))?;
    let load = format!("LD{kind}");
    Form::named(&load).filter(|form| form.instruction.role == Role::Load).map(|_| load)
}
