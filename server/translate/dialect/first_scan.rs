//! What is at first. A value that a declaration says becomes a rung of the first scan of an FX list, which knows no
//! such declarations; the relay of that scan becomes a variable of a program of IEC 61131-3, which knows no such relay.

use super::counted::declares_preset;
use super::doubts::{devices, has_value};
use crate::document::{Document, Notation, Scopes, Variable};
use crate::il::iec::{PouKind, SectionKind};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Rung, Storage, Term, Test};
use crate::target::iec::LiteralValue;
use crate::target::{Device, DeviceKind, Model, Operand, Target};
use crate::text::{Span, folded};
use crate::translate::Source;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;
use std::sync::Arc;

/// The variable that is on in the first scan alone.
const RELAY: &str = "M8002";
/// The one that keeps it from coming on again.
const DONE: &str = "M8002_Done";

/// The variables of a program of IEC 61131-3 that a rung of the first scan can give the values which they have.
#[derive(Default)]
pub(super) struct Initials {
    /// The program, by its number; nothing for a variable that all know.
    variables: FxHashSet<(Option<usize>, SmolStr)>,
    outputs: Vec<Action>,
    unit: Option<usize>,
}

impl Initials {
    /// Those of `document`, if it has one program, that are devices of `family`; `is_written` says which rungs there
    /// have words.
    pub(super) fn of(
        document: &Document,
        family: &Target,
        is_written: impl Fn(&Path, Option<usize>) -> bool,
    ) -> Initials {
        let scopes = document.scopes();
        let mut programs =
            scopes.own_pous().iter().enumerate().filter(|(_, pou)| pou.kind == PouKind::Program);
        let (Some((unit, program)), None, false) =
            (programs.next(), programs.next(), document.target().is_fx())
        else {
            return Initials::default();
        };
        let mut globals: Vec<&Variable> = scopes.globals.values().collect();
        globals.sort_by(|one, other| one.name.cmp(&other.name));
        let global = globals.into_iter().map(|variable| (None, variable));
        let own = program.variables.iter().filter(|variable| variable.section == SectionKind::Local);
        let mut initials = Initials { unit: Some(unit), ..Initials::default() };
        for (scope, variable) in global.chain(own.map(|variable| (Some(unit), variable))) {
            let is_output = |device: &Device| device.kind != DeviceKind::X;
            let devices = devices(variable, family);
            let is_one = !devices.is_empty() && devices.iter().all(is_output);
            let is_plain =
                is_one && !variable.constant && !variable.is_retained() && !declares_preset(variable);
            if !is_plain || !has_value(variable, scopes) {
                continue;
            }
            let Some(output) = at_first(document, unit, variable) else { continue };
            let path = |action: Action| in_first_scan(vec![Drive::Action(action)]);
            if output.as_ref().is_none_or(|action| is_written(&path(action.clone()), Some(unit))) {
                initials.variables.insert((scope, folded(&variable.name)));
                initials.outputs.extend(output);
            }
        }
        initials
    }

    /// Whether the variable is given its value, as program unit number `unit` knows it.
    pub(super) fn have(&self, scopes: &Scopes, unit: Option<usize>, name: &str) -> bool {
        let own = scopes.variable(unit, name).is_some_and(|variable| variable.section == SectionKind::Local);
        self.variables.contains(&(unit.filter(|_| own), folded(name)))
    }

    /// Puts the rung that gives them their values before the others of the program.
    pub(super) fn put_before(self, sources: &mut Vec<Source>) {
        if self.outputs.is_empty() {
            return;
        }
        let Some(first) = sources.iter().position(|source| source.pou == self.unit) else { return };
        // They stand nowhere, but one behind the other.
        let places = sources[first].rung.span.start as usize + 1..;
        let outputs = self.outputs.into_iter().zip(places);
        let outputs =
            outputs.map(|(action, place)| Drive::Action(Action { span: Span::at(place), ..action }));
        let path = in_first_scan(outputs.collect());
        insert(sources, first, path);
    }
}

/// The output that gives a variable what it has at first; nothing inside if it has that anyway, nothing at all if that
/// is not told by one literal.
fn at_first(document: &Document, unit: usize, variable: &Variable) -> Option<Option<Action>> {
    let (_, value) = variable.words.split_once(":=")?;
    let text = format!("LD {}\nST {}\n", value.trim(), variable.name);
    let chunk = Arc::new(Document::new("", Notation::IecIl, document.target()).chunk_of(&text));
    let mut read = Source::of_chunk(document, 0, &chunk, unit + 1).into_iter();
    let (Some(source), None) = (read.next(), read.next()) else { return None };
    let path = source.path()?;
    let [Drive::Action(action)] = &path.drives[..] else { return None };
    match (&path.gates[..], &action.deed) {
        ([], Deed::Compute(_)) if action.terms.len() == 2 => {
            let literal = matches!(action.terms[0].operand, Operand::Literal(_));
            literal.then(|| Some(action.clone()))
        }
        ([Gate::Pass(condition)], Deed::Coil(CoilKind::Plain)) => match constant(condition)? {
            true => Some(Some(Action { deed: Deed::Coil(CoilKind::Set), ..action.clone() })),
            false => Some(None),
        },
        _ => None,
    }
}

/// The value of a condition that is a literal.
fn constant(condition: &Expression) -> Option<bool> {
    match condition {
        Expression::Constant(value) => Some(*value),
        Expression::Contact(Contact { test: Test::Bit(ContactKind::NormallyOpen), terms, .. }) => {
            bit_of(terms.first()?)
        }
        _ => None,
    }
}

/// The value of a literal of type BOOL.
pub(super) fn bit_of(term: &Term) -> Option<bool> {
    let Operand::Literal(literal) = term.operand else { return None };
    match literal.value {
        LiteralValue::Bool(value) => Some(value),
        LiteralValue::Integer(number @ 0..=1) if literal.named_type.is_none() => Some(number == 1),
        _ => None,
    }
}

fn in_first_scan(drives: Vec<Drive>) -> Path {
    let relay = Term::of_device(Device::FIRST_SCAN, Span::at(0));
    Path { gates: vec![pass(ContactKind::NormallyOpen, relay)], drives }
}

fn pass(kind: ContactKind, term: Term) -> Gate {
    Gate::Pass(Expression::Contact(Contact { test: Test::Bit(kind), terms: vec![term], span: Span::at(0) }))
}

/// Puts a rung before the one at a place among `sources`, behind the declarations that stand there.
fn insert(sources: &mut Vec<Source>, place: usize, path: Path) {
    let Some(next) = sources.get_mut(place) else { return };
    let rung = Rung {
        labels: Vec::new(),
        network: None,
        comments: Vec::new(),
        span: Span::at(next.rung.span.start as usize),
        is_list: false,
        path: Ok(Some(path)),
    };
    let declarations = std::mem::take(&mut next.declarations);
    let source = Source { rung, declarations, note: None, doubt: None, ..next.clone() };
    sources.insert(place, source);
}

/// What a relay that tells the first scan from others is in it; nothing for any other term.
pub(super) fn value_in(term: &Term) -> Option<bool> {
    match term.operand {
        Operand::Device(Device::FIRST_SCAN) => Some(true),
        Operand::Device(Device::OFF_AT_FIRST) => Some(false),
        _ => None,
    }
}

/// The contact that is there for one of the relay of the first scan, or of the one that is off in it.
pub(super) fn contact(kind: ContactKind, term: &Term) -> Option<(ContactKind, Term)> {
    let is_open = match kind {
        ContactKind::NormallyOpen => true,
        ContactKind::NormallyClosed => false,
        ContactKind::Rising | ContactKind::Falling => return None,
    };
    let kind = match value_in(term)? == is_open {
        true => ContactKind::NormallyOpen,
        false => ContactKind::NormallyClosed,
    };
    Some((kind, Term::new(Operand::Variable, RELAY, term.span)))
}

/// Puts the rung that switches the variable of the first scan before the others, if one of them asks for it.
pub(super) fn put_relay_before(sources: &mut Vec<Source>) {
    let asks = |source: &Source| {
        source.path().is_some_and(|path| path.terms().iter().any(|term| term.text == RELAY))
    };
    if !sources.iter().any(asks) {
        return;
    }
    let [relay, done] = [RELAY, DONE].map(|name| Term::new(Operand::Variable, name, Span::at(0)));
    let output = |kind, term: &Term| {
        Drive::Action(Action { deed: Deed::Coil(kind), terms: vec![term.clone()], span: Span::at(0) })
    };
    let drives = vec![output(CoilKind::Plain, &relay), output(CoilKind::Set, &done)];
    insert(sources, 0, Path { gates: vec![pass(ContactKind::NormallyClosed, done)], drives });
}

/// Makes the relay of the first scan of a variable which the first rung of its program switches as such, and nobody
/// else: the way back from [`put_relay_before`], whatever the two variables are called.
pub(super) fn take_relay(document: &Document, sources: &mut [Source]) {
    let scopes = document.scopes();
    let is_program = |source: &Source| {
        let unit = source.pou.and_then(|unit| scopes.pous.get(unit));
        source.path().is_some() && unit.is_some_and(|unit| unit.kind == PouKind::Program)
    };
    let Some(first) = sources.iter().position(is_program) else { return };
    let unit = sources[first].pou;
    let Some([relay, done]) = sources[first].path().and_then(|path| relay_of(path, scopes, unit)) else {
        return;
    };
    let uses =
        |name: &SmolStr, path: &Path| path.terms().iter().filter(|term| folded(&term.text) == *name).count();
    let writes = |path: &Path| {
        path.actions().iter().any(|action| action.terms.iter().any(|term| folded(&term.text) == relay))
    };
    for (number, source) in sources.iter().enumerate().filter(|(_, source)| source.pou == unit) {
        let is_first = number == first;
        let is_known = match &source.rung.path {
            Ok(Some(path)) => is_first || uses(&done, path) == 0 && !writes(path),
            Ok(None) => true,
            // Whatever a rung does that cannot be read.
            Err(_) => false,
        };
        if !is_known || is_first && !source.rung.labels.is_empty() {
            return;
        }
    }
    sources[first].rung.path = Ok(None);
    for path in sources
        .iter_mut()
        .filter(|source| source.pou == unit)
        .filter_map(|source| source.rung.path.as_mut().ok()?.as_mut())
    {
        path.each_term(&mut |term| {
            if folded(&term.text) == relay {
                *term = Term::of_device(Device::FIRST_SCAN, term.span);
            }
        });
    }
}

/// The two variables of a rung that switches the first one on in the first scan, by their folded names.
fn relay_of(path: &Path, scopes: &Scopes, unit: Option<usize>) -> Option<[SmolStr; 2]> {
    let [Gate::Pass(Expression::Contact(contact))] = &path.gates[..] else { return None };
    let [Drive::Action(on), Drive::Action(done)] = &path.drives[..] else { return None };
    let is_right = contact.test == Test::Bit(ContactKind::NormallyClosed)
        && on.deed == Deed::Coil(CoilKind::Plain)
        && done.deed == Deed::Coil(CoilKind::Set);
    let ([asked], [relay], [set]) = (&contact.terms[..], &on.terms[..], &done.terms[..]) else { return None };
    let names = [relay, set].map(|term| folded(&term.text));
    let is_own = |term: &Term| {
        let variable = scopes.variable(unit, &term.text);
        term.storage == Storage::Local
            && variable.is_some_and(|own| own.address.is_none() && !own.has_value() && !own.is_retained())
    };
    let is_it = is_right && folded(&asked.text) == names[1] && names[0] != names[1];
    (is_it && is_own(relay) && is_own(set) && Operand::read(&relay.text, Model::Iec) == Operand::Variable)
        .then_some(names)
}
