//! # block-stack
//!
//! Each `LD` begins a block, and a second one before the output must be joined with the first: `ANB` puts the two in
//! series, `ORB` in parallel. A block that is left open at the output, or an `ANB` without two blocks, is an error of
//! the circuit (6611), and no PLC runs it. A forgotten output shows itself in the same way: the next rung then looks
//! like a second block.
//!
//! ```fx
//! LD X0
//! OR X1
//! LD X2
//! ^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! ANB
//! ^^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OR X1
//! LD X2
//! OR X3
//! ANB
//! OUT Y0
//! END
//! ```

use super::rung::Finding;
use crate::check::statements::{line_before, removal};
use crate::check::{ChunkContext, Rule, Run};
use crate::il::fx::{FxLine, FxTree, LineKind};
use crate::target::{Form, Role};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "block-stack",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("block_stack.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some((tree, findings)) = context.rung() else { return };
    let text = context.chunk.text();
    for finding in findings {
        match finding {
            &Finding::TooFewBlocks { line, blocks } => {
                let line = &tree.lines[line];
                let word = line.mnemonic.of(text);
                let message = Message::new("block-stack.too-few").with("word", word).with("blocks", blocks);
                let title = Message::new("block-stack.remove").with("word", word);
                let diagnostic = Diagnostic::new(RULE.code, line.mnemonic, message);
                found.push(diagnostic.fix(title, vec![removal(text, line.span)]));
            }
            Finding::OpenBlocks { begun, output } => found.push(open_blocks(text, tree, begun, *output)),
            _ => {}
        }
    }
}

/// More of the blocks below help nobody.
const MOST_RELATED: usize = 8;

/// Blocks that nothing joins. The upper one is marked, since that is where an output or a contact is missing.
fn open_blocks(text: &str, tree: &FxTree, begun: &[usize], output: usize) -> Diagnostic {
    let upper = begun.last().copied().unwrap_or(output);
    let (line, driven) = (&tree.lines[upper], &tree.lines[output]);
    let message = Message::new("block-stack.open")
        .with("block", line.span.of(text))
        .with("output", driven.span.of(text))
        .with("missing", begun.len() - 1);
    let mut diagnostic = Diagnostic::new(RULE.code, line.mnemonic, message);
    for &other in begun[..begun.len() - 1].iter().take(MOST_RELATED) {
        let other = tree.lines[other].span;
        diagnostic =
            diagnostic.related(other, Message::new("block-stack.other").with("block", other.of(text)));
    }
    if begun.len() != 2 {
        return diagnostic;
    }
    if output == upper + 1
        && let Some(series) = series_for(line)
    {
        let title = Message::new("block-stack.series").with("word", &series);
        diagnostic = diagnostic.fix(title, vec![TextEdit::new(line.mnemonic, series)]);
    }
    for join in ["ANB", "ORB"] {
        let title = Message::new("block-stack.join").with("word", join).with("output", driven.span.of(text));
        diagnostic = diagnostic.fix(title, vec![line_before(text, driven.mnemonic, join)]);
    }
    diagnostic
}

/// The contact of the same kind in series: AND for LD, ANI for LDI, AND= for LD=.
fn series_for(line: &FxLine) -> Option<String> {
    let LineKind::Instruction(form) = line.kind else { return None };
    let mnemonic = form.mnemonic();
    let kind = mnemonic.strip_prefix("LD")?;
    let written = ["AND", "AN"].map(|head| format!("{head}{kind}"));
    written
        .into_iter()
        .find(|name| Form::named(name).is_some_and(|form| form.instruction.role == Role::Series))
}
