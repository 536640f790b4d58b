//! # branch-stack
//!
//! `MPS` remembers the current result for several branches, `MRD` goes back to it, and `MPP` goes back to it for the
//! last branch and forgets it. Each `MPS` has exactly one `MPP`. If it is missing, the memory of the CPU for branches
//! fills up with every scan, so the PLC refuses the program (error 6616).
//!
//! ```fx
//! LD X0
//! MPS
//! ^^^
//! AND X1
//! OUT Y0
//! MRD
//! AND X2
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT Y0
//! MPP
//! ^^^
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! LD X0
//! MPS
//! AND X1
//! OUT Y0
//! MPP
//! AND X2
//! OUT Y1
//! END
//! ```

use super::rung::Finding;
use crate::check::statements::removal;
use crate::check::{ChunkContext, Rule, Run};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "branch-stack",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("branch_stack.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some((tree, findings)) = context.rung() else { return };
    let text = context.chunk.text();
    for finding in findings {
        match *finding {
            Finding::NoBranch { line } => {
                let line = &tree.lines[line];
                let message = Message::new("branch-stack.nothing").with("word", line.mnemonic.of(text));
                found.push(Diagnostic::new(RULE.code, line.mnemonic, message));
            }
            Finding::OpenBranch { line, last_read } => {
                let word = tree.lines[line].mnemonic;
                let message = Message::new("branch-stack.open");
                let diagnostic = Diagnostic::new(RULE.code, word, message);
                found.push(match last_read.map(|read| tree.lines[read].mnemonic) {
                    Some(read) => diagnostic
                        .related(read, Message::new("branch-stack.last"))
                        .fix(Message::new("branch-stack.make-last"), vec![TextEdit::new(read, "MPP")]),
                    None => diagnostic
                        .fix(Message::new("branch-stack.remove"), vec![removal(text, tree.lines[line].span)]),
                });
            }
            _ => {}
        }
    }
}
