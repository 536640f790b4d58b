//! # operand-count
//!
//! The instruction has too many operands or too few. Operands are parted by blanks or commas; each has its place, so
//! with one of them missing the others mean something else than intended.
//!
//! ```fx
//! LD X0 X1
//!       ^^
//! MOV D0
//! ^^^
//! END
//! ```
//!
//! A preset belongs to timers and counters alone:
//!
//! ```fx
//! LD X0
//! OUT Y0 K50
//!        ^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! AND X1
//! MOV D0 D1
//! OUT T0 K50
//! END
//! ```
//!
//! ```lad
//! |  X0                     |
//! +--| |---[MOV K10]--------+
//!           ^^^
//! ```
//!
//! A function in IEC programs takes the current result as its first input, so one operand less than it has inputs
//! stands behind its name; and `NOT` works on the current result alone.
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Value : INT;
//!     Ready : BOOL;
//! END_VAR
//!     LD Value
//!     ABS Value
//!         ^^^^^
//!     LIMIT 5
//!     ^^^^^
//!     LD Ready
//!     NOT Ready
//!         ^^^^^
//!     ST
//!     ^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Value : INT;
//!     Ready : BOOL;
//! END_VAR
//!     LD Value
//!     ABS
//!     ST Value
//!     LD 0
//!     LIMIT Value, 100
//!     ST Value
//!     LDN Ready
//!     ST Ready
//! END_PROGRAM
//! ```

use crate::check::iec::{View, operand_counts};
use crate::check::{ChunkContext, Rule, Run};
use crate::document::{Operation, Tree};
use crate::target::{Form, Operand, OperandSpec};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "operand-count",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("operand_count.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if let Some(view) = View::of(context) {
        return operand_counts(&view, found);
    }
    // What belongs to a drawn contact or coil is decided by the drawing, whose rules report it.
    let is_drawn = matches!(context.chunk.tree(), Tree::Ladder(_));
    let mut problems: Vec<u32> = context.chunk.problems().iter().map(|problem| problem.span.start).collect();
    problems.sort_unstable();
    for operation in context.doubtful.iter().filter(|operation| operation.is_word || !is_drawn) {
        let Some(form) = operation.form else { continue };
        let (least, most) = places(form, operation.operands.first().map(|operand| &operand.value));
        let count = operation.operands.len();
        if count < least && !has_problem_behind(context.chunk.text(), &problems, operation) {
            found.push(too_few(form, operation));
        } else if count > most {
            found.push(too_many(context, form, operation, most));
        }
    }
}

/// The least and the greatest number of operands. A preset that is missing is the matter of `missing-preset`.
fn places(form: Form, first: Option<&Operand>) -> (usize, usize) {
    let specs = form.instruction.operands;
    let least = specs.iter().filter(|spec| !spec.optional).count();
    let device = first.and_then(Operand::device);
    let has_preset = device.is_none_or(|device| device.kind.has_preset());
    (least, if has_preset { specs.len() } else { least })
}

/// Whether the reader has already reported something on the line, such as a comma with nothing behind it.
/// `problems` are the places of all that it reported, in order.
fn has_problem_behind(text: &str, problems: &[u32], operation: &Operation<'_>) -> bool {
    let start = operation.symbol.start;
    let length = text.get(start as usize..).and_then(|rest| rest.find('\n')).unwrap_or(text.len());
    let next = problems.get(problems.partition_point(|&problem| problem < start));
    next.is_some_and(|&next| ((next - start) as usize) < length)
}

fn too_few(form: Form, operation: &Operation<'_>) -> Diagnostic {
    let specs = form.instruction.operands;
    let missing = specs.iter().skip(operation.operands.len()).filter(|spec| !spec.optional);
    let message = Message::new("operand-count.too-few")
        .with("instruction", form.mnemonic())
        .with_messages("missing", missing.map(described).collect());
    Diagnostic::new(RULE.code, operation.symbol, message)
}

/// A place with its meaning: `S (value to copy)`.
fn described(spec: &OperandSpec) -> Message {
    Message::new("operand-count.place").with("name", spec.name).with_phrase("meaning", spec.meaning)
}

fn too_many(context: &ChunkContext<'_>, form: Form, operation: &Operation<'_>, most: usize) -> Diagnostic {
    let text = context.chunk.text();
    let surplus = &operation.operands[most..];
    let span = surplus.iter().fold(surplus[0].span, |span, operand| span.to(operand.span));
    let takes_none = form.instruction.operands.is_empty();
    let is_preset = most < form.instruction.operands.len();
    let key = match (is_preset, takes_none) {
        (true, _) => "operand-count.no-preset",
        (_, true) => "operand-count.takes-none",
        _ => "operand-count.too-many",
    };
    let device = operation.operands.first().map_or("", |operand| operand.span.of(text));
    let names: Vec<&str> =
        form.instruction.operands.iter().filter(|spec| !spec.optional).map(|spec| spec.name).collect();
    let message = Message::new(key)
        .with("instruction", form.mnemonic())
        .with("device", device)
        .with("places", names.join(" "))
        .with("word", span.of(text));
    let before = match most.checked_sub(1).and_then(|last| operation.operands.get(last)) {
        Some(last) => last.span.end,
        None => operation.symbol.end,
    };
    let title = Message::new("operand-count.remove").with("word", span.of(text));
    let gap = Span { start: before, end: span.end };
    Diagnostic::new(RULE.code, span, message).fix(title, vec![TextEdit::new(gap, "")])
}
