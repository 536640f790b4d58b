//! # read-before-write
//!
//! A relay is read in a rung that stands above the one that writes it. The rungs of a scan are executed from top to
//! bottom, so the reader sees the value of the scan before: what should happen at once happens one scan late, and a
//! pulse may come after the moment that it was meant for.
//!
//! Move the rung that writes the relay above the one that reads it. Where each of the two needs the other, as in
//! interlocks, no order is better, and nothing is reported; nor where the rung keeps the value for the next scan on
//! purpose, as to find an edge.
//!
//! ```fx
//! LD M0
//!    ^^
//! OUT Y0
//! LD X0
//! AND X1
//! OUT M0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! AND X1
//! OUT M0
//! LD M0
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  M0        Y0  |
//!    ^^
//! +--| |-------( )-+
//! |                |
//! |  X0        M0  |
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! |  X0        M0  |
//! +--| |-------( )-+
//! |                |
//! |  M0        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Ready : BOOL;
//! END_VAR
//!     LD Ready
//!        ^^^^^
//!     ST Motor
//!     LD Start
//!     ST Ready
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Ready : BOOL;
//! END_VAR
//!     LD Start
//!     ST Ready
//!     LD Ready
//!     ST Motor
//! END_PROGRAM
//! ```

use super::relays::{is_general, is_private};
use super::rungs::{MOST_MENDED, movable};
use super::uses::{Key, Name, Use, Uses};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{Act, DeclaredType};
use crate::target::DeviceKind;
use crate::target::iec::ElementaryType;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};
use rustc_hash::FxHashSet;

pub(super) const RULE: Rule = Rule {
    code: "read-before-write",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("read_before_write.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    let mut mended = 0;
    for (number, name) in uses.names().filter(|(_, name)| is_passing_relay(context, name)) {
        let Some((read, coil)) = late(uses, number) else { continue };
        let is_always_executed = |one: &Use| {
            let regions = context.regions();
            regions.at(one.span.start).is_plain() && !regions.may_be_skipped(one.span.start)
        };
        let in_row = matches!(name.key, Key::Device(device)
            if uses.is_read_in_row(device) || uses.is_written_in_row(device));
        if in_row
            || !is_always_executed(&read)
            || !is_always_executed(&coil)
            || needs_it(uses, number, &read, &coil)
        {
            continue;
        }
        let message =
            Message::new("read-before-write.found").with("name", uses.words(&read)).with("rung", coil.rung);
        let related = Message::new("read-before-write.coil").with("name", uses.words(&coil));
        let diagnostic = Diagnostic::new(RULE.code, read.span, message).related(coil.span, related);
        let moved = (mended < MOST_MENDED).then(|| moved(uses, &read, &coil)).flatten();
        mended += usize::from(moved.is_some());
        found.push(match moved {
            Some(edits) => {
                diagnostic.fix(Message::new("read-before-write.move").with("rung", coil.rung), edits)
            }
            None => diagnostic,
        });
    }
}

/// Puts the rung of `coil` before that of `read`.
fn moved(uses: &Uses<'_>, read: &Use, coil: &Use) -> Option<Vec<TextEdit>> {
    let ((before, reader), (own, text)) = (movable(uses, read)?, movable(uses, coil)?);
    let newline = if reader.contains("\r\n") { "\r\n" } else { "\n" };
    let is_list = uses.is_list(coil);
    let body = text.trim_end_matches(['\n', '\r']);
    // Rungs of a drawing are parted by a blank line.
    let text = format!("{body}{newline}{}", if is_list { "" } else { newline });
    Some(vec![TextEdit::new(Span::at(before.start as usize), text), TextEdit::new(own, "")])
}

fn is_passing_relay(context: &ProgramContext<'_>, name: &Name<'_>) -> bool {
    match name.key {
        Key::Device(device) => device.kind == DeviceKind::M && is_general(device, context),
        _ => {
            let is_bit = |variable: &&crate::document::Variable| {
                variable.declared == DeclaredType::Elementary(ElementaryType::Bool)
            };
            is_private(name) && name.variable.as_ref().is_some_and(is_bit)
        }
    }
}

/// The first place that reads it, if all that do stand above the one coil that writes it, and in the same file.
fn late(uses: &Uses<'_>, number: u32) -> Option<(Use, Use)> {
    let acts = uses.acts(number);
    let reads_and_coil = acts.has(&[Act::Coil]) && !acts.writes_but(&[Act::Coil]) && acts.reads();
    if !reads_and_coil {
        return None;
    }
    let mut writes = uses.of_name(number).filter(|one| one.access.act.writes());
    let (coil, None) = (writes.next()?, writes.next()) else { return None };
    if coil.access.act != Act::Coil || !coil.is_whole() {
        return None;
    }
    let mut others = uses.of_name(number).filter(|one| !one.in_rung_of(&coil));
    let first = others.next()?;
    let reads =
        |one: &Use| matches!(one.access.act, Act::Read | Act::ReadOff | Act::ReadEdge) && one.is_whole();
    let is_above = |one: &Use| one.span.start < coil.span.start && one.file == coil.file;
    let is_late = |one: &Use| one.access.act == Act::Declare || (reads(one) && is_above(one));
    let rest_is_late = others.all(|one| is_late(&one));
    let first = match first.access.act {
        Act::Declare => uses.of_name(number).find(|one| reads(one) && !one.in_rung_of(&coil))?,
        _ => first,
    };
    (rest_is_late && is_late(&first)).then_some((first, coil))
}

/// What so many places of a rung need is not looked for.
const LARGEST_RUNG: usize = 500;

/// Whether the rung of `coil` needs what the rungs from `read` on make, or keeps for the next scan what the rung of
/// `read` looks at itself.
fn needs_it(uses: &Uses<'_>, own: u32, read: &Use, coil: &Use) -> bool {
    if uses.in_rung(coil).take(LARGEST_RUNG).count() == LARGEST_RUNG {
        return true;
    }
    let start = uses.in_rung(read).map(|(_, one)| one.span.start).min().unwrap_or(read.span.start);
    let conditions = uses.in_rung(coil).filter(|(name, one)| *name != own && one.access.act.reads());
    let reader = uses.in_rung(read).filter(|(_, one)| one.access.act.reads());
    let reader: FxHashSet<u32> = reader.map(|(name, _)| name).collect();
    conditions.into_iter().any(|(name, _)| {
        let written = uses.written_at(name);
        let behind = written.partition_point(|offset| *offset < start);
        let is_made = written.get(behind).is_some_and(|offset| *offset < coil.span.start);
        is_made || reader.contains(&name)
    })
}
