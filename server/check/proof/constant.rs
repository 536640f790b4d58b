//! Outputs whose condition is the same in every scan, whatever the inputs are.

use super::contradiction_on_path::Contradiction;
use super::rung::{ProofRung, decided, devices_of, name_of};
use super::{always_energised, never_energised};
use crate::logic::{
    self, Action, Contact, Deed, Drive, Effort, Expression, Formula, Formulas, Gate, Path, equal,
};
use crate::target::Flow;
use crate::text::{Diagnostic, Message, Span};
use rustc_hash::FxHashMap;

/// The conditions before an action, from the left rail on.
pub(super) struct Way<'p> {
    pub action: &'p Action,
    pub conditions: Vec<&'p Expression>,
    /// Whether power only passes contacts on its way, and no inverter and no block.
    is_plain: bool,
}

/// The way to each action, in the order in which a run does them.
pub(super) fn ways(path: &Path) -> Vec<Way<'_>> {
    let mut ways = Vec::new();
    collect(path, &mut Vec::new(), true, &mut ways);
    ways
}

fn collect<'p>(path: &'p Path, before: &mut Vec<&'p Expression>, is_plain: bool, ways: &mut Vec<Way<'p>>) {
    let (start, mut is_plain) = (before.len(), is_plain);
    for gate in &path.gates {
        match gate {
            Gate::Pass(expression) => before.push(expression),
            Gate::Invert => is_plain = false,
            Gate::Through(action) => {
                ways.push(Way { action, conditions: before.clone(), is_plain });
                is_plain = false;
            }
        }
    }
    for drive in &path.drives {
        match drive {
            Drive::Action(action) => ways.push(Way { action, conditions: before.clone(), is_plain }),
            Drive::Path(path) => collect(path, before, is_plain, ways),
        }
    }
    before.truncate(start);
}

/// The outputs of a rung that are never or always on.
pub(super) fn find(
    rung: &ProofRung,
    contradictions: &[Contradiction<'_>],
    effort: &mut Effort,
) -> Vec<Diagnostic> {
    effort.ask(|formulas| among(rung, contradictions, formulas))
}

fn among(rung: &ProofRung, contradictions: &[Contradiction<'_>], formulas: &mut Formulas) -> Vec<Diagnostic> {
    let mut run = logic::Run::new();
    run.path(&rung.path, formulas);
    let mut decided: FxHashMap<Formula, Option<bool>> = FxHashMap::default();
    let mut found = Vec::new();
    for (effect, way) in run.effects.iter().zip(ways(&rung.path)) {
        if way.conditions.is_empty() || !is_output(way.action) {
            continue;
        }
        let value = *decided.entry(effect.guard).or_insert_with(|| value_of(effect.guard, formulas));
        match value {
            Some(false) => found.push(never_energised::diagnostic(&way, never(&way, contradictions))),
            // Instructions that are executed in each scan are nothing to wonder about.
            Some(true) if matches!(way.action.deed, Deed::Coil(_)) => {
                found.push(always_energised::diagnostic(&way, always(&way)));
            }
            _ => {}
        }
    }
    found
}

/// The one value of a formula, if it has but one.
pub(super) fn value_of(formula: Formula, formulas: &mut Formulas) -> Option<bool> {
    [Formulas::FALSE, Formulas::TRUE]
        .into_iter()
        .find(|constant| equal(formulas, formula, *constant) == logic::Verdict::Equal)
        .map(|constant| constant == Formulas::TRUE)
}

/// Whether it drives or does something, and does not steer the program.
pub(super) fn is_output(action: &Action) -> bool {
    match action.deed {
        Deed::Coil(_) => true,
        Deed::Instruction(form) => {
            let steers = !matches!(form.instruction.flow(), Flow::Straight | Flow::Refresh);
            !steers && !action.terms.is_empty()
        }
        Deed::Call(_) | Deed::Compute(_) | Deed::Jump | Deed::Return => false,
    }
}

/// Where an output names what it drives.
pub(super) fn place_of(action: &Action) -> Span {
    let named = action.terms.first().map(|term| term.span).filter(|span| !span.is_empty());
    named.unwrap_or(action.span)
}

/// Why an output is constant, and where that is seen.
pub(super) struct Reason {
    pub message: Message,
    pub places: Vec<(Span, Message)>,
}

impl Reason {
    /// `diagnostic`, with the places.
    pub fn added_to(self, diagnostic: Diagnostic) -> Diagnostic {
        self.places.into_iter().fold(diagnostic, |found, (span, message)| found.related(span, message))
    }
}

fn at(contact: &Contact) -> (Span, Message) {
    (contact.span, Message::new("energised.place").with("name", name_of(contact)))
}

fn never(way: &Way<'_>, contradictions: &[Contradiction<'_>]) -> Reason {
    let mut contacts = Vec::new();
    way.conditions.iter().for_each(|condition| condition.visit(&mut |contact| contacts.push(contact)));
    let is_here = |contact: &Contact| contacts.iter().any(|own| std::ptr::eq(*own, contact));
    let mut total = contradictions.iter().filter(|one| one.is_total && is_here(one.first));
    if let Some(one) = total.find(|one| is_here(one.second)).filter(|_| way.is_plain) {
        let (first, second) = (name_of(one.first), name_of(one.second));
        let message = Message::new("energised.in-series").with("first", first).with("second", second);
        return Reason { message, places: vec![at(one.first), at(one.second)] };
    }
    if let Some(contact) = contacts.iter().find(|contact| decided(contact) == Some(false)) {
        let message = Message::new("energised.decided").with("name", name_of(contact));
        return Reason { message, places: vec![at(contact)] };
    }
    whatever(way)
}

fn always(way: &Way<'_>) -> Reason {
    let [Expression::Or(branches)] = way.conditions[..] else { return whatever(way) };
    let contacts: Vec<&Contact> = branches
        .iter()
        .filter_map(|branch| match branch {
            Expression::Contact(contact) => Some(contact),
            _ => None,
        })
        .collect();
    let is_inverse =
        |one: &Contact, other: &Contact| one.test.opposite() == Some(other.test) && one.terms == other.terms;
    for (number, one) in contacts.iter().enumerate() {
        if let Some(other) = contacts[number + 1..].iter().find(|other| is_inverse(one, other)) {
            let message = Message::new("energised.in-parallel");
            let message = message.with("first", name_of(one)).with("second", name_of(other));
            return Reason { message, places: vec![at(one), at(other)] };
        }
    }
    whatever(way)
}

fn whatever(way: &Way<'_>) -> Reason {
    let devices = devices_of(way.conditions.iter().copied());
    Reason { message: Message::new("energised.whatever").with("devices", devices), places: Vec::new() }
}
