//! A part of a condition as a rung of its own that drives a free relay, read in the place of the part.
//!
//! That is of use to somebody where the part is a word of its own: at least two contacts that ask something, for what
//! is always on or off needs no relay. A cursor means the innermost such connection around it; all that a gate lets
//! pass, inverted or not, is only meant by who selects it. And what a rung does with nothing but one plain coil has
//! its relay already: that coil, or its inverse.

use super::declaration::Declaration;
use super::neighbourhood::Neighbourhood;
use super::{Change, Proposal};
use crate::document::{ProjectView, Symbol};
use crate::ide::bookkeeping::Book;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test};
use crate::target::iec::{FunctionBlock, Operator};
use crate::target::{Device, DeviceKind, Model, Operand};
use crate::text::{Message, Span, folded};
use rustc_hash::FxHashSet;
use smol_str::{SmolStr, format_smolstr};

/// What the names of new relays begin with where relays are variables.
const RELAY: &str = "Relay";

pub(super) fn propose(around: &Neighbourhood<'_>, selected: Span) -> Option<Proposal> {
    let start = around.rung().start as u32;
    let selected = Span { start: selected.start.checked_sub(start)?, end: selected.end.checked_sub(start)? };
    let chosen = chosen(around.path(), meant(around, selected))?;
    let is_fx = around.document.target().is_fx();
    let relay = if is_fx {
        Term::of_device(free_device(around.view)?, Span::default())
    } else {
        free_variable(around)?
    };
    let contact = Contact {
        test: Test::Bit(ContactKind::NormallyOpen),
        terms: vec![relay.clone()],
        span: Span::default(),
    };
    let mut reading = around.path().clone();
    let part = taken_from_path(&mut reading, &chosen, &Expression::Contact(contact))?;
    let coil =
        Action { deed: Deed::Coil(CoilKind::Plain), terms: vec![relay.clone()], span: Span::default() };
    let driving = Path { gates: vec![Gate::Pass(part)], drives: vec![Drive::Action(coil)] };
    let title = Message::new("refactor.extract").with("relay", &relay);
    let changes = vec![Change { first: around.here, count: 1, paths: vec![driving, reading] }];
    // Without a program unit variables are declared by their use.
    let needs_declaration = !is_fx && around.unit.number.is_some();
    let declaration = || Declaration { name: relay.text.clone(), type_name: "BOOL" };
    Some(Proposal {
        relay: Some(relay.key()),
        declarations: needs_declaration.then(declaration).into_iter().collect(),
        ..Proposal::of("refactor.extract.relay", title, changes)
    })
}

/// What is selected, in the rung's chunk. The operand of an instruction of IEC 61131-3 is a contact, and the cursor may
/// stand on its operator.
fn meant(around: &Neighbourhood<'_>, selected: Span) -> Span {
    let chunk = &around.rung().chunk;
    let Some(tree) = chunk.iec().filter(|_| selected.is_empty()) else { return selected };
    let line = |offset: usize| chunk.text()[..offset].rfind('\n').map_or(0, |end| end + 1);
    let Some(place) = chunk.text().get(..selected.start as usize).map(|before| line(before.len())) else {
        return selected;
    };
    let on_line = tree.items.iter().filter(|item| line(item.span.start as usize) == place);
    let operands = tree.operands.iter().map(|operand| operand.span);
    let mut on_line = on_line.filter(|item| item.span.touches(selected.start as usize));
    let item = on_line.next().map(|item| item.span);
    let inside = |item: Span| {
        let mut operands = operands;
        operands.find(|own| item.start <= own.start && own.end <= item.end)
    };
    item.and_then(inside).map_or(selected, |operand| Span::at(operand.start as usize))
}

/// The first relay that no file of the project uses and no comment names.
fn free_device(view: &ProjectView<'_>) -> Option<Device> {
    let book = Book::of(view);
    let comments = view.here().comments();
    let mut ranges = view.here().target().ranges(DeviceKind::M);
    ranges.find_map(|range| book.free(range, 1, |device| comments.of_device(device).is_some()))
}

/// A variable with a name that means nothing in the program unit.
fn free_variable(around: &Neighbourhood<'_>) -> Option<Term> {
    let scopes = around.document.scopes();
    let own = around.unit.number.and_then(|number| scopes.own_pous().get(number));
    let numbers = own.iter().flat_map(|pou| &pou.variables).filter_map(|variable| {
        let (stem, number) = variable.name.split_at_checked(RELAY.len())?;
        number.parse::<u32>().ok().filter(|_| stem.eq_ignore_ascii_case(RELAY))
    });
    let numbers: FxHashSet<u32> = numbers.collect();
    let is_free = |name: &SmolStr| {
        let is_named = |symbol| around.unit.tally(around.document, &symbol).mentions > 0;
        let operand = Operand::read(name, Model::Iec);
        operand == Operand::Variable
            && scopes.variable(around.unit.number, name).is_none()
            && scopes.pou_named(name).is_none()
            && !scopes.is_type(name)
            && FunctionBlock::named(name).is_none()
            && Operator::written(name).is_none()
            && !is_named(Symbol::variable(name))
            && !is_named(Symbol::Label(folded(name)))
    };
    let name = (1..u32::MAX)
        .filter(|number| !numbers.contains(number))
        .map(|number| format_smolstr!("{RELAY}{number}"))
        .find(is_free)?;
    Some(Term::new(Operand::Variable, &name, Span::default()))
}

/// The places of the chosen contacts in their chunk: those that are selected or, at a cursor, those of the innermost
/// connection around it that is worth a relay. Nothing if nothing is.
fn chosen(path: &Path, selected: Span) -> Option<Vec<Span>> {
    let mut conditions = Vec::new();
    path.visit(&mut |_| {}, &mut |condition| conditions.push(condition));
    let all = || conditions.iter().flat_map(|condition| condition.contacts());
    let chosen: Vec<&Contact> = if selected.is_empty() {
        let at = |condition| around_cursor(whole(condition), selected.start as usize);
        conditions.iter().copied().find_map(at)?.contacts()
    } else {
        let is_meant = |span: Span| span.start < selected.end && selected.start < span.end;
        let is_meant = |contact: &&Contact| {
            is_meant(contact.span) || contact.terms.iter().any(|term| is_meant(term.span))
        };
        all().filter(is_meant).collect()
    };
    let asking = chosen.iter().filter(|contact| asks(contact)).count();
    let is_all = || all().filter(|contact| asks(contact)).count() == asking;
    let is_worth_it = asking > 1 && !(drives_one_plain_coil(path) && is_all());
    is_worth_it.then(|| chosen.into_iter().map(|contact| contact.span).collect())
}

/// Whether a contact is not always on or off.
fn asks(contact: &Contact) -> bool {
    let is_constant = |term: &Term| {
        matches!(term.operand, Operand::Literal(_) | Operand::Constant { .. }) || term.always().is_some()
    };
    !contact.terms.iter().all(is_constant)
}

/// Whether the path drives one bit that is what its condition is, or its inverse; a timer or a counter, which has a
/// preset besides, is not.
fn drives_one_plain_coil(path: &Path) -> bool {
    match path.actions()[..] {
        [action] => {
            let is_plain = matches!(action.deed, Deed::Coil(CoilKind::Plain | CoilKind::Negated));
            is_plain && action.terms.len() == 1
        }
        _ => false,
    }
}

/// What an inversion inverts, or the condition itself.
fn whole(condition: &Expression) -> &Expression {
    let mut whole = condition;
    while let Expression::Not(part) = whole {
        whole = part;
    }
    whole
}

/// The innermost connection of several contacts in `condition` around the byte, but not `condition` itself.
fn around_cursor(condition: &Expression, offset: usize) -> Option<&Expression> {
    let is_at = |contact: &&Contact| {
        contact.span.touches(offset) || contact.terms.iter().any(|term| term.span.touches(offset))
    };
    condition.parts().iter().map(whole).find_map(|part| {
        let contacts = part.contacts();
        let is_worth_it = || contacts.iter().filter(|contact| asks(contact)).count() > 1;
        let is_meant = contacts.iter().any(is_at);
        is_meant.then(|| around_cursor(part, offset).or_else(|| is_worth_it().then_some(part)))?
    })
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
    // An inversion stays where it is.
    if let Expression::Not(part) = condition {
        return taken(part, chosen, instead);
    }
    let is_whole = |part: &Expression| count(part, chosen) == part.contacts().len();
    if is_whole(condition) {
        return Some(std::mem::replace(condition, instead.clone()));
    }
    let (parts, in_series) = match condition {
        Expression::And(parts) => (parts, true),
        Expression::Or(parts) => (parts, false),
        Expression::Not(_) | Expression::Contact(_) | Expression::Constant(_) => return None,
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
