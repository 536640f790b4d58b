//! The boolean form of the output under the pointer: as drawn, and shorter where there is a shorter one.

use crate::document::Chunk;
use crate::ladder::ContactKind;
use crate::logic::{
    self, Action, Atom, Contact, Deed, Drive, Expression, Formulas, Gate, Moment, Path, Run, Term, Test,
    sum_of_products,
};
use crate::target::Target;
use crate::text::{Language, Message};
use crate::translate::to_boolean::{Notation, equations};

/// The search for a shorter equation is so much work at most, as a pointer does not rest for long.
const EFFORT: usize = 20_000;

/// A longer equation says less than the drawing.
const LENGTH_MAX: usize = 400;

/// The equation of the coil at byte `inside` of a chunk, in Markdown; nothing where there is no coil, or no equation.
pub fn of_output(chunk: &Chunk, inside: usize, target: &Target, language: Language) -> Option<String> {
    let rungs = logic::rungs(chunk, target);
    let paths = rungs.iter().filter_map(|rung| rung.path.as_ref().ok()?.as_ref());
    let (path, place) = paths.into_iter().find_map(|path| {
        let is_here = |action: &&Action| {
            let touches = |term: &Term| term.span.touches(inside);
            let names = action.terms.first().is_some_and(touches) || action.span.touches(inside);
            // The preset of a timer has words of its own.
            matches!(action.deed, Deed::Coil(_)) && names && !action.terms.iter().skip(1).any(touches)
        };
        Some((path, path.actions().iter().position(is_here)?))
    })?;
    let all = equations(path, Notation::Algebra).ok()?;
    let drawn = all.get(place).filter(|equation| equation.len() <= LENGTH_MAX)?;
    let mut words = format!("`{drawn}`");
    if let Some((minimal, contacts)) = minimal(path, place)
        && Some(contacts) < contacts_before(path, &mut { place })
    {
        let message = Message::new("hover-form.minimal").with("equation", minimal);
        words += &format!("  \n{}", message.render(language));
    }
    Some(words)
}

/// How many contacts power passes on its way to an action; `place` counts down to it.
fn contacts_before(path: &Path, place: &mut usize) -> Option<usize> {
    let conditions = path.gates.iter().map(|gate| match gate {
        Gate::Pass(condition) => condition.contacts().len(),
        Gate::Invert | Gate::Through(_) => 0,
    });
    let own: usize = conditions.sum();
    for drive in &path.drives {
        match drive {
            Drive::Path(inner) => {
                if let Some(contacts) = contacts_before(inner, place) {
                    return Some(own + contacts);
                }
            }
            Drive::Action(_) if *place == 0 => return Some(own),
            Drive::Action(_) => *place -= 1,
        }
    }
    None
}

/// The equation with the shortest sum of products, and how many contacts it has.
fn minimal(path: &Path, place: usize) -> Option<(String, usize)> {
    let mut formulas = Formulas::limited(EFFORT);
    let mut run = Run::new();
    run.path(path, &mut formulas);
    let effect = run.effects.get(place)?;
    let sum = sum_of_products(&mut formulas, effect.guard)?;
    let contacts = sum.iter().map(Vec::len).sum();
    let products = sum.into_iter().map(|product| {
        let literals = product.into_iter().map(|(atom, holds)| literal(path, formulas.atom_at(atom), holds));
        Some(Expression::and(literals.collect::<Option<Vec<_>>>()?))
    });
    let products: Vec<Expression> = products.collect::<Option<_>>()?;
    let sum = match products.contains(&Expression::Constant(true)) {
        true => Expression::Constant(true),
        false => Expression::or(products),
    };
    let drives = vec![Drive::Action(Action { deed: effect.deed(), ..effect.action.clone() })];
    let equation =
        equations(&Path { gates: vec![Gate::Pass(sum)], drives }, Notation::Algebra).ok()?.pop()?;
    Some((equation, contacts))
}

/// A contact that conducts where the atom holds, or where it does not; nothing for what the rung has no contact for.
fn literal(path: &Path, atom: &Atom, holds: bool) -> Option<Expression> {
    let (moment, kind) = match atom {
        Atom::Bit(moment) if holds => (moment, ContactKind::NormallyOpen),
        Atom::Bit(moment) => (moment, ContactKind::NormallyClosed),
        Atom::Edge { of, value: None, rising: true } => (of, ContactKind::Rising),
        Atom::Edge { of, value: None, rising: false } => (of, ContactKind::Falling),
        _ => return None,
    };
    let Moment { name, since: 0 } = moment else { return None };
    let mut conditions = Vec::new();
    path.visit(&mut |_| {}, &mut |condition| conditions.push(condition));
    let mut contacts = conditions.iter().flat_map(|condition| condition.contacts());
    let of_name = contacts.find(|contact| contact.terms.len() == 1 && contact.terms[0].key() == *name)?;
    let contact = Expression::Contact(Contact { test: Test::Bit(kind), ..of_name.clone() });
    match (atom, holds) {
        (Atom::Edge { .. }, false) => Some(Expression::Not(Box::new(contact))),
        _ => Some(contact),
    }
}
