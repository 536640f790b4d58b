//! # address-overlap
//!
//! Two variables lie on the same bits of the outputs or the memory: writing one changes the other. Where this is not
//! meant, an output follows a calculation that has nothing to do with it.
//!
//! The layout of addresses is the maker's matter. In `%QX2.5` the first number is a byte everywhere; `%QW1` is bytes
//! 2 and 3 where words are counted, and bytes 1 and 2 where bytes are counted. Only what overlaps in both layouts is
//! reported. Inputs may be read as bits and words at once, and one address declared in several program units is
//! shared on purpose; both are left alone.
//!
//! ```iec
//! PROGRAM Lamps
//! VAR
//!     Row    AT %QW0   : WORD;
//!     Signal AT %QX0.1 : BOOL;
//!               ^^^^^^
//! END_VAR
//!     LD Row
//!     NE 0
//!     ST Signal
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Lamps
//! VAR
//!     Row    AT %QW0   : WORD;
//!     Signal AT %QX4.1 : BOOL;
//! END_VAR
//!     LD Row
//!     NE 0
//!     ST Signal
//! END_PROGRAM
//! ```

use crate::check::iec::views_of;
use crate::check::{ProgramContext, Rule, Run};
use crate::il::iec::{ItemKind, SectionKind};
use crate::target::{DirectAddress, Location, Operand, Width};
use crate::text::{Diagnostic, Message, Severity, Span};
use std::ops::Range;

pub(super) const RULE: Rule = Rule {
    code: "address-overlap",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("address_overlap.rs"),
};

/// A variable with an address.
struct Located<'a> {
    name: &'a str,
    /// The address in the text.
    span: Span,
    location: Location,
    /// Its bits where words are counted, and where bytes are counted.
    counted: Range<u64>,
    by_bytes: Range<u64>,
    /// The file and POU; none for global variables.
    pou: Option<(usize, Option<usize>)>,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut located = Vec::new();
    let views = context.files().iter().flat_map(|file| views_of(*file).map(|at| (file.number, at)));
    for (file, (start, view)) in views {
        for item in &view.tree.items {
            let ItemKind::Section { kind, declarations, .. } = item.kind else { continue };
            for declaration in declarations.of(&view.tree.declarations) {
                let (Some(id), Some(name)) =
                    (declaration.address, declaration.names.of(&view.tree.names).first())
                else {
                    continue;
                };
                let operand = view.tree.operand(id);
                let Operand::Direct(address) = operand.value else { continue };
                let (Some(counted), Some(by_bytes)) = (bits(address, true), bits(address, false)) else {
                    continue;
                };
                if address.location != Location::Input {
                    located.push(Located {
                        name: name.of(view.text),
                        span: operand.span.shifted(start),
                        location: address.location,
                        counted,
                        by_bytes,
                        pou: if kind == SectionKind::Global { None } else { Some((file, view.pou)) },
                    });
                }
            }
        }
    }
    located.sort_by_key(|one| (one.location, one.counted.start, one.span));
    // The variable that reaches furthest so far is the one that a later one can meet.
    let mut furthest: Option<&Located<'_>> = None;
    for one in &located {
        if let Some(other) = furthest.filter(|other| overlap(other, one)) {
            found.push(diagnostic(other, one));
        }
        let reaches =
            |other: &&Located<'_>| other.location == one.location && other.counted.end >= one.counted.end;
        furthest = furthest.filter(reaches).or(Some(one));
    }
}

fn overlap(left: &Located<'_>, right: &Located<'_>) -> bool {
    let meet = |left: &Range<u64>, right: &Range<u64>| left.start < right.end && right.start < left.end;
    let shared = left.counted == right.counted && left.pou != right.pou;
    left.location == right.location
        && !shared
        && meet(&left.counted, &right.counted)
        && meet(&left.by_bytes, &right.by_bytes)
}

/// The later one in the text is reported.
fn diagnostic(left: &Located<'_>, right: &Located<'_>) -> Diagnostic {
    let (first, second) = if left.span < right.span { (left, right) } else { (right, left) };
    let message = Message::new("address-overlap.found").with("name", second.name).with("other", first.name);
    let related = Message::new("address-overlap.other").with("other", first.name);
    Diagnostic::new(RULE.code, second.span, message).related(first.span, related)
}

/// The bits that an address covers; nothing for forms whose meaning is the maker's: more levels, or none.
fn bits(address: DirectAddress, counts_words: bool) -> Option<Range<u64>> {
    let size: u64 = match address.width {
        Width::Bit => 1,
        Width::Byte => 8,
        Width::Word => 16,
        Width::Double => 32,
        Width::Long => 64,
    };
    let start = match (address.width, address.path) {
        (Width::Bit, [Some(byte), Some(bit @ 0..=7), None, None]) => u64::from(byte) * 8 + u64::from(bit),
        (Width::Bit, _) => return None,
        (_, [Some(number), None, None, None]) => u64::from(number) * if counts_words { size } else { 8 },
        _ => return None,
    };
    Some(start..start + size)
}
