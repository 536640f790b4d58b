//! # master-control-order
//!
//! `MC` opens a section that has power only while its contacts are on, and `MCR` with the same level closes it.
//! Sections are nested from N0 upwards, and closed from the inside; an `MCR` closes its level and all above it. If one
//! half is missing, whole parts of the machine lose their power, or never do.
//!
//! ```fx
//! LD X0
//! MC N1 M100
//! LD X1
//! MC N0 M101
//!    ^^
//! LD X2
//! OUT Y0
//! MCR N0
//! MCR N1
//!     ^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! MC N0 M100
//!    ^^
//! LD X2
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! MC N0 M100
//! LD X1
//! MC N1 M101
//! LD X2
//! OUT Y0
//! MCR N1
//! MCR N0
//! END
//! ```

use crate::check::statements::Statement;
use crate::check::{ProgramContext, Rule, Run};
use crate::target::{DeviceKind, Flow};
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "master-control-order",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("master_control_order.rs"),
};

/// A section that is open, with its level.
type Section<'a> = (u32, Statement<'a>);

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut open: Vec<Section<'_>> = Vec::new();
    for statement in context.executed() {
        match statement.flow() {
            Some(Flow::SectionBegin) => begin(statement, &mut open, found),
            Some(Flow::SectionEnd) => end(statement, &mut open, found),
            Some(Flow::MainEnd | Flow::ProgramEnd | Flow::SubroutineEnd | Flow::InterruptEnd) => {
                leave_open(&mut open, Some(statement), found);
            }
            _ => {}
        }
    }
    leave_open(&mut open, None, found);
}

fn begin<'a>(statement: Statement<'a>, open: &mut Vec<Section<'a>>, found: &mut Vec<Diagnostic>) {
    let Some((level, span)) = level_of(&statement) else { return };
    if let Some((outer_level, outer)) = open.last().filter(|(outer_level, _)| *outer_level >= level) {
        let message =
            Message::new("master-control-order.inside").with("level", level).with("outer", outer_level);
        let related = Message::new("master-control-order.opened").with("level", outer_level);
        found.push(Diagnostic::new(RULE.code, span, message).related(outer.span, related));
    }
    open.push((level, statement));
}

fn end(statement: Statement<'_>, open: &mut Vec<Section<'_>>, found: &mut Vec<Diagnostic>) {
    let Some((level, span)) = level_of(&statement) else { return };
    let opened = open.iter().rposition(|(other, _)| *other == level);
    match opened {
        // Everything at this level and above is closed with it.
        Some(_) => open.retain(|(other, _)| *other < level),
        None => {
            let message = Message::new("master-control-order.not-open").with("level", level);
            let mut diagnostic = Diagnostic::new(RULE.code, span, message);
            if let Some(removal) = statement.removal() {
                let title = Message::new("master-control-order.remove").with("level", level);
                diagnostic = diagnostic.fix(title, vec![removal]);
            }
            found.push(diagnostic);
        }
    }
}

/// Sections that are still open at the end of a part of the program.
fn leave_open(open: &mut Vec<Section<'_>>, end: Option<Statement<'_>>, found: &mut Vec<Diagnostic>) {
    for (level, section) in open.drain(..) {
        let message = Message::new("master-control-order.never-closed").with("level", level);
        let span = level_of(&section).map_or(section.word, |(_, span)| span);
        let mut diagnostic = Diagnostic::new(RULE.code, span, message);
        if let Some(end) = end {
            let related = Message::new("master-control-order.before").with("level", level);
            diagnostic = diagnostic.related(end.span, related);
            if let Some(edit) = end.line_before(&format!("MCR N{level}")) {
                let title = Message::new("master-control-order.close")
                    .with("level", level)
                    .with("end", end.mnemonic());
                diagnostic = diagnostic.fix(title, vec![edit]);
            }
        }
        found.push(diagnostic);
    }
}

fn level_of(statement: &Statement<'_>) -> Option<(u32, Span)> {
    let device = statement.device().filter(|device| device.kind == DeviceKind::N)?;
    Some((device.number, statement.first?.span))
}
