//! A part of a condition as a rung of its own that drives a free relay, read in the place of the part.

use super::neighbourhood::Neighbourhood;
use super::{Change, Proposal};
use crate::document::ProjectView;
use crate::ide::bookkeeping::Book;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test};
use crate::target::{Device, DeviceKind};
use crate::text::{Message, Span};

pub(super) fn propose(
    around: &Neighbourhood<'_>,
    view: &ProjectView<'_>,
    selected: Span,
) -> Option<Proposal> {
    if !around.document.target().is_fx() {
        return None;
    }
    let start = around.rung().start as u32;
    let selected = Span { start: selected.start.checked_sub(start)?, end: selected.end.checked_sub(start)? };
    let chosen = chosen(around.path(), selected)?;
    let relay = free_relay(view)?;
    let term = || Term::of_device(relay, Span::default());
    let contact =
        Contact { test: Test::Bit(ContactKind::NormallyOpen), terms: vec![term()], span: Span::default() };
    let mut reading = around.path().clone();
    let part = taken_from_path(&mut reading, &chosen, &Expression::Contact(contact))?;
    let coil = Action { deed: Deed::Coil(CoilKind::Plain), terms: vec![term()], span: Span::default() };
    let driving = Path { gates: vec![Gate::Pass(part)], drives: vec![Drive::Action(coil)] };
    Some(Proposal {
        kind: "refactor.extract.relay",
        title: Message::new("refactor.extract").with("relay", relay),
        changes: vec![Change { first: around.here, count: 1, paths: vec![driving, reading] }],
        relay: Some(term().key()),
        must_save: false,
    })
}

/// The first relay that no file of the project uses and no comment names.
fn free_relay(view: &ProjectView<'_>) -> Option<Device> {
    let book = Book::of(view);
    let comments = view.here().comments();
    let mut ranges = view.here().target().ranges(DeviceKind::M);
    ranges.find_map(|range| book.free(range, 1, |device| comments.of_device(device).is_some()))
}

/// The places of the chosen contacts in their chunk: those that are selected or, at a cursor, those of the innermost
/// connection around it. Nothing for one contact, or for all that there is.
fn chosen(path: &Path, selected: Span) -> Option<Vec<Span>> {
    let mut conditions = Vec::new();
    path.visit(&mut |_| {}, &mut |condition| conditions.push(condition));
    let spans =
        |contacts: Vec<&Contact>| contacts.into_iter().map(|contact| contact.span).collect::<Vec<_>>();
    if selected.is_empty() {
        let found =
            conditions.into_iter().find_map(|condition| around_cursor(condition, selected.start as usize));
        return found.map(|condition| spans(condition.contacts()));
    }
    let is_meant = |span: Span| span.start < selected.end && selected.start < span.end;
    let contacts = conditions.iter().flat_map(|condition| condition.contacts());
    let meant = contacts
        .filter(|contact| is_meant(contact.span) || contact.terms.iter().any(|term| is_meant(term.span)));
    let meant: Vec<&Contact> = meant.collect();
    (meant.len() > 1).then(|| spans(meant))
}

/// The innermost connection in `condition` with a contact at the byte, but not `condition` itself.
fn around_cursor(condition: &Expression, offset: usize) -> Option<&Expression> {
    let is_at = |contact: &Contact| {
        contact.span.touches(offset) || contact.terms.iter().any(|term| term.span.touches(offset))
    };
    for part in condition.parts() {
        let deeper = around_cursor(part, offset);
        let has_it =
            || part.parts().iter().any(|one| matches!(one, Expression::Contact(contact) if is_at(contact)));
        if let Some(found) = deeper.or_else(|| has_it().then_some(part)) {
            return Some(found);
        }
    }
    None
}

/// Takes the chosen contacts out of the one condition that has all of them, with `instead` in their place.
fn taken_from_path(path: &mut Path, chosen: &[Span], instead: &Expression) -> Option<Expression> {
    for gate in &mut path.gates {
        if let Gate::Pass(condition) = gate
            && count(condition, chosen) == chosen.len()
        {
            return taken(condition, chosen, instead);
        }
    }
    let inner = path.drives.iter_mut().filter_map(|drive| match drive {
        Drive::Path(path) => Some(path),
        Drive::Action(_) => None,
    });
    inner.into_iter().find_map(|path| taken_from_path(path, chosen, instead))
}

fn count(condition: &Expression, chosen: &[Span]) -> usize {
    condition.contacts().iter().filter(|contact| chosen.contains(&contact.span)).count()
}

/// The same in a condition that has them all. They must be neighbours in one connection.
fn taken(condition: &mut Expression, chosen: &[Span], instead: &Expression) -> Option<Expression> {
    let is_whole = |part: &Expression| count(part, chosen) == part.contacts().len();
    if is_whole(condition) {
        return Some(std::mem::replace(condition, instead.clone()));
    }
    let (parts, in_series) = match condition {
        Expression::And(parts) => (parts, true),
        Expression::Or(parts) => (parts, false),
        Expression::Not(part) => return taken(part, chosen, instead),
        Expression::Contact(_) | Expression::Constant(_) => return None,
    };
    let meets = |part: &Expression| count(part, chosen) > 0;
    let first = parts.iter().position(meets)?;
    let last = parts.iter().rposition(meets)?;
    if first == last {
        return taken(&mut parts[first], chosen, instead);
    }
    if !parts[first..=last].iter().all(is_whole) {
        return None;
    }
    let part: Vec<Expression> = parts.splice(first..=last, [instead.clone()]).collect();
    Some(if in_series { Expression::and(part) } else { Expression::or(part) })
}
