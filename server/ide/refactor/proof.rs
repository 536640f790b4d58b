//! The law of refactorings: what was written is read again, and does the same; everything around it stands as before.

use super::declaration::adds_only;
use super::neighbourhood::Neighbourhood;
use super::unit::is_member;
use super::writing::Written;
use super::{Change, Proposal, silent};
use crate::document::{Document, Edit, Notation, Symbol};
use crate::logic::{Comparison, Formulas, Path, compare, compare_but, stretch};
use crate::text::{Span, TextEdit};
use crate::translate::Source;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// Whether the document with the edits is the one without, but for the changed rungs, and these do the same.
pub(super) fn holds(around: &Neighbourhood<'_>, proposal: &Proposal, written: &Written) -> bool {
    proved(around, proposal, written).is_some()
}

fn proved(around: &Neighbourhood<'_>, proposal: &Proposal, written: &Written) -> Option<()> {
    let mut after = around.document.clone();
    let reversed = written.edits.iter().rev();
    let applied = reversed.map(|edit| Edit { range: Some(edit.span.range()), text: edit.text.clone() });
    after.apply(&applied.collect::<Vec<_>>());
    let (first, last) = (proposal.changes.first()?, proposal.changes.last()?);
    let window = window(around, first.first, last.first + last.count)?;
    let new_window = moved(window, &written.edits)?;
    let is_iec_list = around.document.notation() == Notation::IecIl;
    let (old, ends) = match is_iec_list {
        true => (around.rungs.clone(), ends_rungs(&after, new_window, around.unit.number)),
        false => (Source::within(around.document, window), ends_chunk(&after, new_window)),
    };
    let declared = [around.document.scopes(), after.scopes()];
    if !ends || !adds_only(declared[0], declared[1], around.unit.number, &written.declarations) {
        return None;
    }
    let new = Source::within(&after, new_window);
    if !same_comments(&old, &new) {
        return None;
    }
    // How many rungs stand before the window.
    let skipped = around.rungs.iter().take_while(|placed| placed.start < window.start as usize).count();
    same_around(&proposal.changes, skipped, &old, &new)?;
    let behind = old.len() - (last.first + last.count - skipped);
    let changed = |placed| rungs_between(placed, first.first - skipped, behind);
    let (old, new) = (changed(&old)?, changed(&new)?);
    if is_iec_list && !keeps_to_itself(around, (&after, new_window), old, new) {
        return None;
    }
    let (left, right) = (paths(old)?, paths(new)?);
    match &proposal.relay {
        None => matches!(compare(&left, &right, &mut Formulas::default()), Comparison::Same { .. }),
        Some(relay) => same_but_for(relay, &left, &right),
    }
    .then_some(())
}

/// Where the window lies behind the edits; declarations may stand before it.
fn moved(window: Span, edits: &[TextEdit]) -> Option<Span> {
    let growth = |edit: &TextEdit| edit.text.len() as i64 - i64::from(edit.span.end - edit.span.start);
    let before: i64 = edits.iter().filter(|edit| edit.span.end < window.start).map(growth).sum();
    let all: i64 = edits.iter().map(growth).sum();
    let at = |offset: u32, by: i64| u32::try_from(i64::from(offset) + by).ok();
    Some(Span { start: at(window.start, before)?, end: at(window.end, all)? })
}

/// Whether the rungs of a window are the same but for `changes`, whose numbers count `skipped` rungs before it.
fn same_around(changes: &[Change], skipped: usize, old: &[Source], new: &[Source]) -> Option<()> {
    let changes = changes.iter().map(|change| (change.first - skipped, change.count, change.paths.len()));
    let (mut old_at, mut new_at) = (0, 0);
    for (first, count, instead) in changes.chain([(old.len(), 0, 0)]) {
        while old_at < first {
            same_rung(old.get(old_at)?, new.get(new_at)?)?;
            (old_at, new_at) = (old_at + 1, new_at + 1);
        }
        if let (Some(before), Some(then)) = (old.get(old_at), new.get(new_at).filter(|_| instead > 0)) {
            same_head(before, then)?;
        }
        (old_at, new_at) = (old_at + count, new_at + instead);
    }
    (new_at == new.len()).then_some(())
}

/// What rungs do; nothing if one of them cannot be read.
fn paths(placed: &[Source]) -> Option<Vec<&Path>> {
    let paths = placed.iter().map(|placed| placed.rung.path.as_ref().ok());
    Some(paths.collect::<Option<Vec<_>>>()?.into_iter().flatten().collect())
}

/// The rungs without so many at the beginning and the end.
fn rungs_between(placed: &[Source], before: usize, behind: usize) -> Option<&[Source]> {
    placed.get(before..placed.len().checked_sub(behind)?)
}

/// The bytes of the chunks of these rungs, with a chunk before and one behind. In lists of IEC 61131-3 it takes more
/// chunks to tell what a rung is.
fn window(around: &Neighbourhood<'_>, first: usize, end: usize) -> Option<Span> {
    if around.document.notation() == Notation::IecIl {
        return Some(around.span);
    }
    let (first, last) = (around.rungs.get(first)?, around.rungs.get(end.checked_sub(1)?)?);
    let before = around.document.chunk_before(first.start).filter(|before| before.start < first.start);
    let end = last.start + last.chunk.len();
    let behind = around.document.chunk_at(end).filter(|behind| behind.start == end);
    let end = behind.map_or(end, |behind| end + behind.chunk.len());
    Some(Span::new(before.map_or(first.start, |before| before.start), end))
}

/// Whether chunks start where the window does and where it ends.
fn ends_chunk(document: &Document, window: Span) -> bool {
    let starts = |offset: u32| {
        let at = document.chunk_at(offset as usize);
        offset as usize == document.len() || at.is_some_and(|at| at.start == offset as usize)
    };
    starts(window.start) && starts(window.end)
}

/// Whether rungs of a list begin where the window does and where it ends.
fn ends_rungs(document: &Document, window: Span, pou: Option<usize>) -> bool {
    let begins = |offset: u32| stretch::begins_rung(document, offset as usize, pou);
    begins(window.start) && begins(window.end)
}

/// Whether the names that the paths of old or new rungs do not show mean nothing to other rungs: they are named nowhere
/// else, or they are helpers that each rung stores to before it reads them.
fn keeps_to_itself(
    around: &Neighbourhood<'_>,
    (after, window): (&Document, Span),
    old: &[Source],
    new: &[Source],
) -> bool {
    let unit = after.unit_at(window.start as usize);
    let inside = |start: usize| window.range().contains(&start);
    let is_seen = |symbol: &Symbol| matches!(symbol, Symbol::Variable(name) if is_member(around.view, name));
    let is_private = |symbol: &Symbol| match silent::helper(symbol) {
        Some(name) => {
            around.is_stored_outside(name) && silent::is_stored_wherever_read(after, unit, name, &inside)
        }
        None => silent::is_named_only_in(after, unit, symbol, new) && !is_seen(symbol),
    };
    old.iter().chain(new).flat_map(silent::names).all(|symbol| is_private(&symbol))
}

fn same_rung(left: &Source, right: &Source) -> Option<()> {
    same_head(left, right)?;
    (left.text() == right.text()).then_some(())
}

/// The labels, the network and the program unit of a rung.
fn same_head(left: &Source, right: &Source) -> Option<()> {
    (left.pou == right.pou
        && left.rung.labels == right.rung.labels
        && left.rung.network == right.rung.network)
        .then_some(())
}

fn same_comments(left: &[Source], right: &[Source]) -> bool {
    let comments = |placed: &[Source]| {
        let all = placed.iter().flat_map(|placed| {
            let comments = placed.rung.comments.iter();
            comments.map(|comment| comment.of(placed.chunk.text()).trim_end().to_string())
        });
        let mut all: Vec<String> = all.collect();
        // Comments behind lines go with their lines.
        all.sort_unstable();
        all
    };
    comments(left) == comments(right)
}

/// Whether both do the same if nobody looks at the relay with this key, which one of them drives.
fn same_but_for(relay: &SmolStr, left: &[&Path], right: &[&Path]) -> bool {
    let relays = FxHashSet::from_iter([relay.clone()]);
    [(left, right), (right, left)].into_iter().any(|(without, with)| {
        let comparison = compare_but(without, with, &relays, &mut Formulas::default());
        matches!(comparison, Comparison::Same { .. })
    })
}
