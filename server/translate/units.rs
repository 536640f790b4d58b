//! Functions and function blocks that two programs call and neither of them declares.

use super::source::Source;
use crate::document::Document;
use crate::logic::{Deed, Path};
use crate::text::{Message, Span};
use smol_str::SmolStr;

/// Why the first unit that the programs call under one name may be another one, with the rungs that call it: it is
/// declared in one of them and in another file for the other, or in other files of different projects. What both
/// declare is a part of what is compared, and the files of one project have the same units.
pub(super) fn unlike(
    documents: [&Document; 2],
    sources: [&[Source]; 2],
) -> Option<(Message, [Option<Span>; 2])> {
    let [left, right] = documents.map(|document| document.outer().map(|(outer, _)| outer));
    let is_of_one = left.zip(right).is_some_and(|(left, right)| left.is_of_project(right));
    let is_unlike = |name: &str| {
        let [left, right] = documents.map(|document| is_own(document, name));
        left != right || !left && !is_of_one
    };
    let rungs =
        || sources.iter().enumerate().flat_map(|(side, rungs)| rungs.iter().map(move |rung| (side, rung)));
    let (side, rung, name) = rungs().find_map(|(side, rung)| {
        let name = names(documents[side], rung, is_of_one).into_iter().find(|name| is_unlike(name))?;
        Some((side, rung, name))
    })?;
    let mut at = [None, None];
    at[side] = Some(rung.span());
    let other = rungs()
        .find(|(other, rung)| *other != side && names(documents[*other], rung, is_of_one).contains(&name));
    if let Some((other, rung)) = other {
        at[other] = Some(rung.span());
    }
    Some((reason(documents, &name), at))
}

/// Why it is not known whether a unit is the same for both.
fn reason(documents: [&Document; 2], name: &str) -> Message {
    let is_known = |document: &Document| document.scopes().pou_number(name).is_some();
    let [left, right] = documents.map(|document| is_own(document, name));
    let key = match documents.into_iter().all(is_known) {
        false => "prove.unit-unknown",
        true if left != right => "prove.unit-own",
        true => "prove.unit",
    };
    Message::new(key).with("name", name)
}

/// Whether `document` declares the unit itself.
fn is_own(document: &Document, name: &str) -> bool {
    let scopes = document.scopes();
    scopes.pou_number(name).is_some_and(|number| number < scopes.own_pous().len())
}

/// The units that a rung calls. One that cannot be read, and has the same words in both programs, may call each that
/// other files declare; within one project these are the same.
fn names(document: &Document, source: &Source, is_of_one: bool) -> Vec<SmolStr> {
    match &source.rung.path {
        Ok(path) => path.iter().flat_map(Path::actions).filter_map(called).collect(),
        Err(_) if is_of_one => Vec::new(),
        Err(_) => {
            let scopes = document.scopes();
            let others = &scopes.pous[scopes.own_pous().len()..];
            others.iter().map(|pou| pou.name.clone()).collect()
        }
    }
}

fn called(action: &crate::logic::Action) -> Option<SmolStr> {
    match &action.deed {
        Deed::Call(call) if call.block.is_declared() => Some(call.block.name().into()),
        Deed::Compute(computation) if computation.is_declared() => Some(computation.name().into()),
        _ => None,
    }
}
