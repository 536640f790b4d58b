//! Structural edits of ladder drawings: insert, delete, branch, move, mend.
//!
//! An edit is made on the shape of the rung, the rung is drawn again as it was drawn before, and the answer is given
//! only if what was drawn reads as the graph that was meant and everything around it as before.

mod assemble;
mod cells;
mod in_place;
mod look;
mod mend;
pub(super) mod object;
mod operation;
mod parts;
mod proof;
pub(super) mod ranges;
pub(super) mod redrawn;
mod rungs;
mod site;
pub(super) mod typing;

use crate::document::{Document, Notation};
use crate::ide::Style;
use crate::ladder::{Element, Graph};
use crate::text::{Message, Span, TextEdit};
use look::Look;
pub use object::{Object, ObjectKind};
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
    let within = |offset: u32| (offset as usize).min(document.len());
    let span = Span::new(within(span.start), within(span.end));
    if matches!(kind, EditKind::InsertRung | EditKind::InsertRungAbove) {
        return rungs::insert(document, span.start as usize, kind == EditKind::InsertRungAbove, style);
    }
    let site = Site::at(document, span.start as usize).ok_or_else(|| Message::new("edit.no-rung"))?;
    if kind == EditKind::Mend {
        return mend::mend(&site, span, style);
    }
    let intended = operation::intended(&site, span, kind, operand);
    let look = Look::of(&site, style.ladder().kind);
    let ask = Ask { site, span, kind, operand, look };
    // A drawing that is not in the canonical form was laid out by its author, and stays as far as it can.
    let is_canonical = ask.look.redraws(&ask.site);
    let in_place = if is_canonical { None } else { ask.in_place(intended.as_ref().ok()) };
    match in_place {
        Some(edited) => Ok(edited),
        None => ask.redrawn(&intended?),
    }
}

/// An edit that is asked for.
struct Ask<'d, 'o> {
    site: Site<'d>,
    span: Span,
    kind: EditKind,
    operand: Option<&'o str>,
    look: Look,
}

impl Ask<'_, '_> {
    fn edited(&self, proved: &Proved, focus: Option<(&Element, usize)>) -> Edited {
        let selection = match focus {
            Some((element, chunk)) => cursor_at(proved, element, chunk, self.operand.is_some()),
            None => same_place(&self.site, proved, self.span.start as usize),
        };
        Edited { edits: proved.edits(), selection }
    }

    /// The rung drawn anew as intended, in its own look.
    fn redrawn(&self, intended: &Intended) -> Result<Edited, Message> {
        let site = &self.site;
        let lines = self.look.draw(&intended.plan, &intended.source, site)?;
        let removed: Vec<&Element> = intended.removed.iter().map(|id| site.element(*id)).collect();
        if !keeps_words(site, &removed, &lines) {
            return Err(Message::new("edit.words-lost"));
        }
        let mut old = site.lines().shifted(site.start);
        // A line of bare rails above, where names go, is taken for them.
        if let Some(above) = rungs::rails_above(site, &lines) {
            old.start = above as u32;
        }
        let proved = prove(site, old, &lines, &intended.plan.graph(), &intended.source);
        let proved = proved.ok_or_else(|| Message::new("edit.not-the-same"))?;
        let focus = intended.focus.and_then(|id| proved.element(&intended.plan, id));
        Ok(self.edited(&proved, focus))
    }

    /// The rung with the cells of one element changed; nothing where that is not enough.
    fn in_place(&self, intended: Option<&Intended>) -> Option<Edited> {
        let site = &self.site;
        let old = site.lines().shifted(site.start);
        if let Some((new, name)) = operation::inserted(site, self.kind, self.operand) {
            let wire = operation::wire_at(site, self.span).ok()?;
            let (element, drawing) = parts::element(new, &name, site.document.target()).ok()?;
            let offset = self.span.start as usize;
            let (lines, row, column) =
                in_place::with_element(site, &self.look, wire, offset, (&element, &name))?;
            let proved = match intended {
                Some(intended) => prove(site, old, &lines, &intended.plan.graph(), &intended.source)?,
                None => {
                    let source = [site.text, "\n", &drawing].concat();
                    let element = parts::shifted(&element, site.text.len() + 1);
                    prove(site, old, &lines, &operation::in_wire(site, wire, &element)?, &source)?
                }
            };
            let focus = proved.element_at(row, column);
            return Some(self.edited(&proved, focus));
        }
        let intended = intended?;
        let lines = match self.kind {
            EditKind::DeleteElement => in_place::without_elements(site, &intended.removed)?,
            EditKind::Negate => in_place::with_kinds(site, &intended.changed)?,
            _ => return None,
        };
        let proved = prove(site, old, &lines, &intended.plan.graph(), &intended.source)?;
        Some(self.edited(&proved, None))
    }
}

/// The proof that the lines of a rung (`old`, in bytes of the document) can be replaced.
fn prove(site: &Site<'_>, old: Span, lines: &str, wanted: &Graph, source: &str) -> Option<Proved> {
    let window = Window::around(site.document, site.start)?;
    let number = window.rung_number(site.start, site.number);
    window.prove(window.with(old, lines), number, wanted, source, false)
}

/// The structural edits that make sense at the cursor or selection `span`. Whether the result can be drawn is known
/// only when it is asked for, so this is cheap.
pub fn applicable_edits(document: &Document, span: Span) -> Vec<EditKind> {
    if document.notation() != Notation::Ladder {
        return Vec::new();
    }
    let Some(site) = Site::at(document, span.start as usize) else { return Vec::new() };
    let makes_sense = |kind: &EditKind| match kind {
        EditKind::InsertRung | EditKind::InsertRungAbove => true,
        EditKind::Mend => mend::is_ragged(&site),
        // The same as a branch beside the element at the cursor.
        EditKind::WrapInBranch if span.is_empty() => false,
        kind => operation::intended(&site, span, *kind, None).is_ok(),
    };
    EditKind::all().filter(makes_sense).collect()
}

/// The cursor over the open name of an element, or behind it.
fn cursor_at(proved: &Proved, element: &Element, chunk: usize, named: bool) -> Span {
    let (new, start) = proved.text();
    let is_open = |span: &Span| new.get(chunk - start..).is_some_and(|text| span.of(text).contains('?'));
    let instance = element.block().and_then(|block| block.instance).filter(is_open);
    let words = element.operands.iter().map(|operand| operand.span);
    // A block that was given its type has open places all the same.
    let open = instance.or_else(|| words.filter(is_open).reduce(Span::to).filter(|_| !named));
    open.unwrap_or(Span::at(element.span.end as usize)).shifted(chunk)
}

/// The same line and column as a byte of the document before, as far as the rung goes.
fn same_place(site: &Site<'_>, proved: &Proved, offset: usize) -> Span {
    let (new, start) = proved.text();
    let offset = offset.saturating_sub(site.start).min(site.text.len());
    let rung = proved.rung_span();
    let line = site.line_of(offset).saturating_sub(site.rung.lines.0) as usize;
    let column = site.column(offset);
    let first = rung.start as usize - start;
    let first = new.get(..first).and_then(|head| head.rfind('\n')).map_or(0, |end| end + 1);
    let rest = new.get(first..rung.end as usize - start).unwrap_or("");
    let at = first + rest.split_inclusive('\n').take(line).map(str::len).sum::<usize>();
    let text = new.get(at..rung.end as usize - start).and_then(|rest| rest.lines().next()).unwrap_or("");
    Span::at(start + at + site::byte_of_column(text, column))
}
