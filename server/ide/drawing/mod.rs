//! Structural edits of ladder drawings: insert, delete, branch, move, mend.
//!
//! An edit is made on the shape of the rung, the rung is drawn again as it was drawn before, and the answer is given
//! only if what was drawn reads as the graph that was meant and everything around it as before.

mod assemble;
mod changes;
mod look;
mod operation;
mod parts;
mod proof;
mod rungs;
mod site;

use crate::document::{Document, Notation};
use crate::ide::Style;
use crate::ladder::{Element, StyleKind};
use crate::project::FormatStyle;
use crate::text::{Message, Span, TextEdit};
use look::Look;
use operation::Intended;
use proof::{Proved, Window, keeps_words};
use site::Site;

/// A structural edit.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum EditKind {
    InsertContact,
    InsertNegatedContact,
    InsertCoil,
    InsertSetCoil,
    InsertResetCoil,
    InsertBox,
    InsertBranch,
    InsertRung,
    InsertRungAbove,
    MoveBranchUp,
    MoveBranchDown,
    WrapInBranch,
    DeleteElement,
    DeleteBranch,
    Negate,
    Mend,
}

impl EditKind {
    /// All edits with their names in the protocol and their titles.
    const TABLE: &'static [(EditKind, &'static str, &'static str)] = &[
        (EditKind::InsertContact, "insertContact", "edit-title.insertContact"),
        (EditKind::InsertNegatedContact, "insertNegatedContact", "edit-title.insertNegatedContact"),
        (EditKind::InsertCoil, "insertCoil", "edit-title.insertCoil"),
        (EditKind::InsertSetCoil, "insertSetCoil", "edit-title.insertSetCoil"),
        (EditKind::InsertResetCoil, "insertResetCoil", "edit-title.insertResetCoil"),
        (EditKind::InsertBox, "insertBox", "edit-title.insertBox"),
        (EditKind::InsertBranch, "insertBranch", "edit-title.insertBranch"),
        (EditKind::InsertRung, "insertRung", "edit-title.insertRung"),
        (EditKind::InsertRungAbove, "insertRungAbove", "edit-title.insertRungAbove"),
        (EditKind::MoveBranchUp, "moveBranchUp", "edit-title.moveBranchUp"),
        (EditKind::MoveBranchDown, "moveBranchDown", "edit-title.moveBranchDown"),
        (EditKind::WrapInBranch, "wrapInBranch", "edit-title.wrapInBranch"),
        (EditKind::DeleteElement, "deleteElement", "edit-title.deleteElement"),
        (EditKind::DeleteBranch, "deleteBranch", "edit-title.deleteBranch"),
        (EditKind::Negate, "negate", "edit-title.negate"),
        (EditKind::Mend, "mend", "edit-title.mend"),
    ];

    /// All edits.
    pub fn all() -> impl Iterator<Item = EditKind> {
        EditKind::TABLE.iter().map(|(kind, ..)| *kind)
    }

    /// Its name in the protocol.
    pub fn name(self) -> &'static str {
        EditKind::TABLE.iter().find(|(kind, ..)| *kind == self).map_or("", |(_, name, _)| *name)
    }

    /// Its title in menus.
    pub fn title(self) -> Message {
        let title = EditKind::TABLE.iter().find(|(kind, ..)| *kind == self).map_or("", |(.., title)| *title);
        Message::new(title)
    }

    /// The edit called `name` in the protocol.
    pub fn named(name: &str) -> Option<EditKind> {
        EditKind::TABLE.iter().find(|(_, known, _)| *known == name).map(|(kind, ..)| *kind)
    }
}

/// The answer to a structural edit.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Edited {
    /// In order, none overlapping.
    pub edits: Vec<TextEdit>,
    /// Where the cursor goes, in bytes of the text after the edits: over the placeholder of a name, behind an element
    /// that was given its name, else where the edit was made.
    pub selection: Span,
}

/// The structural edit `kind` at the cursor or selection `span`. `operand` names what is inserted; without it
/// the name is `???`, and selected.
///
/// # Errors
/// Why it is not possible there, or that it would change more than was meant.
pub fn edit(
    document: &Document,
    span: Span,
    kind: EditKind,
    operand: Option<&str>,
    style: Style,
) -> Result<Edited, Message> {
    if document.notation() != Notation::Ladder {
        return Err(Message::new("edit.not-ladder"));
    }
    if matches!(kind, EditKind::InsertRung | EditKind::InsertRungAbove) {
        return rungs::insert(document, span.start as usize, kind == EditKind::InsertRungAbove, style);
    }
    let site = Site::at(document, span.start as usize).ok_or_else(|| Message::new("edit.no-rung"))?;
    let intended = operation::intended(&site, span, kind, operand)?;
    let (proved, intended) = redrawn(&site, intended, style)?;
    Ok(Edited {
        edits: proved.edits(),
        selection: selection(&site, &proved, &intended, span, operand.is_some()),
    })
}

/// The edits that make sense at the cursor or selection `span`. Whether the result can be drawn is known only when it
/// is asked for.
pub fn applicable(document: &Document, span: Span) -> Vec<EditKind> {
    if document.notation() != Notation::Ladder {
        return Vec::new();
    }
    let Some(site) = Site::at(document, span.start as usize) else { return Vec::new() };
    let makes_sense = |kind: &EditKind| match kind {
        EditKind::InsertRung | EditKind::InsertRungAbove => true,
        EditKind::Mend => false,
        // The same as a branch beside the element at the cursor.
        EditKind::WrapInBranch if span.is_empty() => false,
        kind => operation::intended(&site, span, *kind, None).is_ok(),
    };
    EditKind::all().filter(makes_sense).collect()
}

/// The rung drawn anew as intended, in its own look.
fn redrawn(site: &Site<'_>, intended: Intended, style: Style) -> Result<(Proved, Intended), Message> {
    let look = Look::of(site, style_kind(style));
    let lines = look.draw(&intended.plan, &intended.source, site)?;
    let removed: Vec<&Element> = intended.removed.iter().map(|id| site.element(*id)).collect();
    if !keeps_words(site, &removed, &lines) {
        return Err(Message::new("edit.words-lost"));
    }
    let window = Window::around(site.document, site.start).ok_or_else(|| Message::new("edit.no-rung"))?;
    let number = window.rung_number(site.start, site.number);
    let wanted = intended.plan.graph();
    let mut old = site.lines().shifted(site.start);
    // A line of bare rails above, where names go, is taken for them.
    if let Some(above) = rungs::rails_above(site, &lines) {
        old.start = above as u32;
    }
    let new = window.with(old, &lines);
    let proved = window.prove(new, number, &wanted, &intended.source, false);
    Ok((proved.ok_or_else(|| Message::new("edit.not-the-same"))?, intended))
}

/// Where the cursor goes.
fn selection(site: &Site<'_>, proved: &Proved, intended: &Intended, span: Span, named: bool) -> Span {
    let focus = intended.focus.and_then(|id| proved.element(&intended.plan, id));
    let (new, start) = proved.text();
    if let Some((element, chunk)) = focus {
        let is_open = |span: &Span| new.get(chunk - start..).is_some_and(|text| span.of(text).contains('?'));
        let words = element.operands.iter().map(|operand| operand.span);
        let open = words.filter(is_open).reduce(Span::to).filter(|_| !named);
        return open.unwrap_or(Span::at(element.span.end as usize)).shifted(chunk);
    }
    // The same line and column, as far as the rung goes.
    let offset = (span.start as usize).saturating_sub(site.start).min(site.text.len());
    let rung = proved.rung_span();
    let line = site::line_of(site.text, offset).saturating_sub(site.rung.lines.0) as usize;
    let column = site.column(offset);
    let first = rung.start as usize - start;
    let first = new.get(..first).and_then(|head| head.rfind('\n')).map_or(0, |end| end + 1);
    let rest = new.get(first..rung.end as usize - start).unwrap_or("");
    let mut at = first;
    for text in rest.split_inclusive('\n').take(line) {
        at += text.len();
    }
    let text = new.get(at..rung.end as usize - start).and_then(|rest| rest.lines().next()).unwrap_or("");
    Span::at(start + at + site::byte_of_column(text, column))
}

/// The characters that the settings ask for.
fn style_kind(style: Style) -> StyleKind {
    match style.kind {
        FormatStyle::Iec => StyleKind::Iec,
        FormatStyle::Brackets => StyleKind::Brackets,
        FormatStyle::Unicode => StyleKind::Unicode,
    }
}
