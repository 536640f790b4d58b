//! # unknown-device
//!
//! The word is no device, constant or pointer of this PLC: its letter names no kind of device, or no number follows.
//! The PLC cannot run the rung, and a typing mistake in a device name is the most common cause of a rung that does
//! nothing.
//!
//! A symbol of the device comments file stands for its device, also inside an operand: `K4Lamps` is `K4M0` if `Lamps`
//! is M0, `LevelZ1` is `D0Z1` and `Level.3` is `D0.3` if `Level` is D0. The index register has its number there. A
//! form that the device does not have, such as `K4Level`, is reported here, and so is a word that can be put together
//! of two symbols in two ways.
//!
//! ```fx
//! LD Q0
//!    ^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD M0
//! OUT Y0
//! END
//! ```

//! Letters that look like digits are the usual slip, and are offered as a fix.
//!
//! ```fx
//! LD XO
//!    ^^
//! OUT Y0
//! END
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::target::{Operand, OperandProblem, Target};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "unknown-device",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("unknown_device.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    // What stands behind an unknown word may be anything; the word itself is reported.
    let known = context.doubtful.iter().filter(|operation| operation.form.is_some());
    for operand in known.flat_map(|operation| operation.operands) {
        let word = operand.span.of(context.chunk.text());
        if let Some(message) = symbol_problem(&operand.value, word) {
            found.push(Diagnostic::new(RULE.code, operand.span, message.with("word", word)));
            continue;
        }
        if !is_unknown(&operand.value, context.target) {
            continue;
        }
        let message =
            Message::new("unknown-device.found").with("word", word).with("target", context.target.title);
        let mut diagnostic = Diagnostic::new(RULE.code, operand.span, message);
        if let Some(plain) = with_digits(word, context.target) {
            let title = Message::new("unknown-device.digits").with("device", &plain);
            diagnostic = diagnostic.fix(title, vec![TextEdit::new(operand.span, plain)]);
        }
        found.push(diagnostic);
    }
}

/// What is wrong with a symbol of the project that stands in a form such as `K4Level`.
fn symbol_problem(operand: &Operand, word: &str) -> Option<Message> {
    let message = match operand {
        Operand::Invalid(OperandProblem::SymbolForm(device)) => {
            let is_group = word
                .strip_prefix(['K', 'k'])
                .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
            let key = match () {
                () if word.contains('.') => "unknown-device.symbol-bit",
                () if is_group => "unknown-device.symbol-group",
                () => "unknown-device.symbol-index",
            };
            Message::new(key).with("device", device)
        }
        Operand::Invalid(OperandProblem::SymbolTwice) => Message::new("unknown-device.symbol-twice"),
        _ => return None,
    };
    Some(message)
}

fn is_unknown(operand: &Operand, target: &Target) -> bool {
    match operand {
        Operand::Invalid(problem) => {
            matches!(problem, OperandProblem::UnknownDevice | OperandProblem::Unreadable)
        }
        _ => operand.device().is_some_and(|d| target.is_fx() && target.ranges(d.kind).next().is_none()),
    }
}

/// The word with the letters O, I and L read as digits, if that makes a device of the target.
fn with_digits(word: &str, target: &Target) -> Option<String> {
    let mut letters = word.chars();
    let first = letters.next()?;
    let digit = |letter: char| match letter.to_ascii_uppercase() {
        'O' => '0',
        'I' | 'L' => '1',
        other => other,
    };
    let plain: String = std::iter::once(first).chain(letters.map(digit)).collect();
    let device = Operand::read(&plain, target.model).device()?;
    (plain != word && device.range_on(target).is_some()).then_some(plain)
}
