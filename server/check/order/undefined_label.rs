//! # undefined-label
//!
//! A jump or a call goes to a label that stands nowhere. The PLC stops with an operation error (6701) at the moment
//! at which the jump is made, which may be long after the machine was tested. `P63` means END and needs no label.
//!
//! ```fx
//! LD X0
//! CJ P2
//!    ^^
//! LD X1
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! CJ P2
//! LD X1
//! OUT Y0
//! P2
//! LD X2
//! OUT Y1
//! END
//! ```
//!
//! ```lad
//! |  X0            |
//! +--| |------->>P3
//!                ^^
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR a : BOOL; END_VAR
//! LD a
//! JMPC nowhere
//!      ^^^^^^^
//! ST a
//! END_PROGRAM
//! ```

use super::labels::{END_POINTER, Jump, Label, Labels};
use crate::check::statements::{Statement, line_before};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Symbol;
use crate::target::iec::nearest;
use crate::target::{DeviceKind, Flow};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "undefined-label",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("undefined_label.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let target = context.target();
    let mut ends = None;
    for labels in Labels::of(context) {
        let placed = labels.placed();
        for jump in labels.jumps.iter().filter(|jump| !placed.contains(&jump.symbol)) {
            // A pointer that the model does not have is reported as such, and the one to END is always there.
            let is_reported = match jump.symbol {
                Symbol::Device(device) => {
                    device == END_POINTER || target.is_fx() && device.range_on(target).is_none()
                }
                _ => false,
            };
            if is_reported {
                continue;
            }
            let message = match jump.name.is_empty() {
                true => Message::new("undefined-label.nameless"),
                false => Message::new("undefined-label.found").with("label", &jump.name),
            };
            let mut diagnostic = Diagnostic::new(RULE.code, jump.span, message);
            let ends = ends.get_or_insert_with(|| Ends::of(context));
            if let Some(label) = meant(jump, &labels, ends) {
                let title = Message::new("undefined-label.replace").with("label", &label);
                diagnostic = diagnostic.fix(title, vec![TextEdit::new(jump.span, label)]);
            }
            if let Some((title, edit)) = added(jump, &labels, ends) {
                diagnostic = diagnostic.fix(title.with("label", &jump.name), vec![edit]);
            }
            found.push(diagnostic);
        }
    }
}

/// Where the parts of an FX program end.
struct Ends<'a> {
    /// FEND, behind which routines stand.
    main: Option<Statement<'a>>,
    program: Option<Statement<'a>>,
}

impl<'a> Ends<'a> {
    fn of(context: &ProgramContext<'a>) -> Ends<'a> {
        let first = |flow| context.executed().find(|statement| statement.flow() == Some(flow));
        Ends { main: first(Flow::MainEnd), program: first(Flow::ProgramEnd) }
    }

    /// Whether a place of the program stands behind FEND.
    fn is_behind_main(&self, offset: u32) -> bool {
        self.main.as_ref().is_some_and(|end| end.span.start < offset)
    }
}

/// The label that is meant most likely: one to which nothing else leads, or else the one with the nearest number or the
/// most similar name. A call leads behind FEND, a jump stays on its side of it.
fn meant(jump: &Jump, labels: &Labels<'_>, ends: &Ends<'_>) -> Option<String> {
    let Symbol::Device(wanted) = jump.symbol else {
        let names = || labels.declared.iter().map(|label| label.name.as_str());
        let only = || (labels.declared.len() == 1).then(|| names().next().map(str::to_string)).flatten();
        return nearest(&jump.name, names()).into_iter().next().or_else(only);
    };
    let named = labels.named();
    let is_behind = (jump.is_call && ends.main.is_some()) || ends.is_behind_main(jump.span.start);
    let rank = |label: &Label| match label.symbol {
        Symbol::Device(device) if device.kind == DeviceKind::P && device != END_POINTER => {
            let is_there = ends.is_behind_main(label.span.start) == is_behind;
            is_there.then(|| (named.contains(&label.symbol), device.number.abs_diff(wanted.number)))
        }
        _ => None,
    };
    let ranked = labels.declared.iter().filter_map(|label| Some((rank(label)?, &label.name)));
    ranked.min().map(|(_, name)| name.clone())
}

/// Puts the label where nothing is done any more: a jump to it leaves out the rest, as one to the end does; a call of
/// it runs a routine without instructions.
fn added(jump: &Jump, labels: &Labels<'_>, ends: &Ends<'_>) -> Option<(Message, TextEdit)> {
    let name = &jump.name;
    if name.is_empty() {
        return None;
    }
    if let Some((text, start, end)) = labels.end {
        let title = Message::new("undefined-label.add").with("end", end.of(text));
        return Some((title, line_before(text, end, &format!("{name}:")).shifted(start)));
    }
    let is_in_main = !jump.is_call && !ends.is_behind_main(jump.span.start);
    let end = ends.main.as_ref().filter(|_| is_in_main).or(ends.program.as_ref())?;
    let (key, lines) = match (jump.is_call, &ends.main) {
        (false, _) => ("undefined-label.add", name.clone()),
        (true, Some(_)) => ("undefined-label.add-routine", format!("{name}\nSRET")),
        (true, None) => ("undefined-label.add-routine", format!("FEND\n{name}\nSRET")),
    };
    Some((Message::new(key).with("end", end.mnemonic()), end.line_before(&lines)?))
}
