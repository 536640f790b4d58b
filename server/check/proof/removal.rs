//! Parts of a rung without which it does the same.

use super::rung::{ProofRung, decided, devices_of, name_of, share_a_device};
use super::{redundant_branch, redundant_contact, rewrite};
use crate::check::ChunkContext;
use crate::ladder::ContactKind;
use crate::logic::{
    self, Comparison, Contact, Drive, Effort, Expression, Formula, Formulas, Gate, Path, Test, compare,
    is_never,
};
use crate::text::{Diagnostic, Message};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::hash::{BuildHasher, Hasher};

/// A contact in series, which may be taken for a wire, or a branch, which may be taken away.
struct Part<'p> {
    expression: &'p Expression,
    is_branch: bool,
    /// The condition of the gate in which it stands.
    gate: &'p Expression,
    /// What else stands in series with it, from the left rail on.
    series: Vec<&'p Expression>,
    /// The branches beside the one in which it stands.
    beside: Vec<&'p Expression>,
    /// The gates before that one.
    before: Vec<&'p Gate>,
}

/// Rungs with more parts are not searched.
const PARTS_MAX: usize = 300;
/// So many parts of a rung are proved at most.
const PROOFS_MAX: usize = 16;
/// So many parts of a rung are told; the others are once these are mended.
const TOLD_MAX: usize = 4;

/// What makes no difference in a rung: branches before contacts, the later before the earlier.
pub(super) fn find(rung: &ProofRung, context: &ChunkContext<'_>, effort: &mut Effort) -> Vec<Diagnostic> {
    let (mut parts, mut found) = (Vec::new(), Vec::new());
    collect(&rung.path, &mut Vec::new(), &mut parts);
    if parts.len() > PARTS_MAX {
        return found;
    }
    let contacts: Vec<&Contact> = parts.iter().flat_map(|part| part.gate.contacts()).collect();
    let samples = Samples::of(&contacts);
    let mut removed: Vec<&Expression> = Vec::new();
    let mut proofs = 0;
    for is_branch in [true, false] {
        for part in parts.iter().rev().filter(|part| part.is_branch == is_branch) {
            if !part.may_be_redundant(&contacts, &samples) || part.is_within(&removed) {
                continue;
            }
            proofs += 1;
            if proofs > PROOFS_MAX || removed.len() == TOLD_MAX {
                return found;
            }
            let mut without = removed.clone();
            without.push(part.expression);
            let alone = taken(&rung.path, &[part.expression]);
            let mut is_proved = |path: &Path| {
                let same = effort.ask(|formulas| compare(&[&rung.path], &[path], formulas));
                matches!(same, Comparison::Same { .. })
            };
            if !is_proved(&alone) || (without.len() > 1 && !is_proved(&taken(&rung.path, &without))) {
                continue;
            }
            removed = without;
            found.push(part.diagnostic(rewrite::edits(context, rung, &alone), effort));
        }
    }
    found
}

fn collect<'p>(path: &'p Path, before: &mut Vec<&'p Gate>, parts: &mut Vec<Part<'p>>) {
    let start = before.len();
    for gate in &path.gates {
        if let Gate::Pass(expression) = gate {
            let mut series = Vec::new();
            for gate in before.iter() {
                match gate {
                    Gate::Pass(passed) => series.push(passed),
                    // What was passed before it says nothing about the power behind.
                    Gate::Invert | Gate::Through(_) => series.clear(),
                }
            }
            let collector = Collector { gate: expression, before: before.clone() };
            collector.series(expression, &series, &[], parts);
        }
        before.push(gate);
    }
    for drive in &path.drives {
        if let Drive::Path(path) = drive {
            collect(path, before, parts);
        }
    }
    before.truncate(start);
}

struct Collector<'p> {
    gate: &'p Expression,
    before: Vec<&'p Gate>,
}

impl<'p> Collector<'p> {
    fn series(
        &self,
        expression: &'p Expression,
        around: &[&'p Expression],
        beside: &[&'p Expression],
        parts: &mut Vec<Part<'p>>,
    ) {
        let inner = match expression {
            Expression::And(inner) => inner.as_slice(),
            _ => std::slice::from_ref(expression),
        };
        for (number, part) in inner.iter().enumerate() {
            let others = inner.iter().enumerate().filter(|(other, _)| *other != number);
            let series: Vec<&Expression> =
                around.iter().copied().chain(others.map(|(_, part)| part)).collect();
            match part {
                Expression::Contact(_) => parts.push(self.part(part, false, series, beside.to_vec())),
                Expression::Or(branches) => {
                    for (number, branch) in branches.iter().enumerate() {
                        let beside = branches.iter().enumerate().filter(|(other, _)| *other != number);
                        let beside: Vec<&Expression> = beside.map(|(_, branch)| branch).collect();
                        parts.push(self.part(branch, true, series.clone(), beside.clone()));
                        if matches!(branch, Expression::And(_)) {
                            self.series(branch, &series, &beside, parts);
                        }
                        if parts.len() > PARTS_MAX {
                            return;
                        }
                    }
                }
                _ => {}
            }
        }
    }

    fn part(
        &self,
        expression: &'p Expression,
        is_branch: bool,
        series: Vec<&'p Expression>,
        beside: Vec<&'p Expression>,
    ) -> Part<'p> {
        Part { expression, is_branch, gate: self.gate, series, beside, before: self.before.clone() }
    }
}

impl<'p> Part<'p> {
    /// Whether a device of it is asked for elsewhere, too, and no sample tells the difference.
    fn may_be_redundant(&self, all: &[&Contact], samples: &Samples) -> bool {
        let is_shared = |contact: &Contact| {
            decided(contact).is_some()
                || all.iter().any(|other| other.span != contact.span && share_a_device(other, contact))
        };
        if !self.expression.contacts().into_iter().any(is_shared) {
            return false;
        }
        samples.are_blind || {
            let mut power = [u64::MAX; SAMPLES];
            for gate in &self.before {
                power = match gate {
                    Gate::Pass(expression) => both(power, samples.of_expression(expression, None)),
                    Gate::Invert => power.map(|word| !word),
                    Gate::Through(_) => [u64::MAX; SAMPLES],
                };
            }
            let taken = Some((self.expression, !self.is_branch));
            both(power, samples.of_expression(self.gate, None))
                == both(power, samples.of_expression(self.gate, taken))
        }
    }

    fn is_within(&self, removed: &[&Expression]) -> bool {
        removed.iter().any(|outer| {
            let mut waiting = vec![*outer];
            while let Some(expression) = waiting.pop() {
                if std::ptr::eq(expression, self.expression) {
                    return true;
                }
                waiting.extend(expression.parts());
            }
            false
        })
    }

    fn diagnostic(&self, edits: Option<Vec<crate::text::TextEdit>>, effort: &mut Effort) -> Diagnostic {
        let first = self.expression.contacts().first().map(|contact| contact.span).unwrap_or_default();
        let (why, place) = effort.ask(|formulas| self.reason(formulas));
        let name = self.name();
        let (code, key, fix) = match self.is_branch {
            true => (
                redundant_branch::RULE.code,
                Message::new("redundant-branch.found"),
                Message::new("redundant-branch.remove"),
            ),
            false => (
                redundant_contact::RULE.code,
                Message::new("redundant-contact.found"),
                Message::new("redundant-contact.remove"),
            ),
        };
        let message = key.with("name", &name).with_messages("why", vec![why]);
        let mut diagnostic = Diagnostic::new(code, first, message);
        if let Some(contact) = place {
            let related = Message::new("energised.place").with("name", name_of(contact));
            diagnostic = diagnostic.related(contact.span, related);
        }
        match edits {
            Some(edits) => diagnostic.fix(fix.with("name", name), edits),
            None => diagnostic,
        }
    }

    fn name(&self) -> String {
        words(self.expression)
    }

    /// Why it makes no difference, in one line, and the contact that does its work.
    fn reason(&self, formulas: &mut Formulas) -> (Message, Option<&'p Contact>) {
        let mut run = logic::Run::new();
        let mut of = |expression: &Expression| run.condition(expression, formulas);
        let own = of(self.expression);
        let series: Vec<Formula> = self.series.iter().map(|part| of(part)).collect();
        let beside: Vec<Formula> = self.beside.iter().map(|branch| of(branch)).collect();
        let mut implies = |left: Vec<Formula>, right: Formula| {
            let inverse = formulas.not(right);
            let against = formulas.and(left.into_iter().chain([inverse]));
            is_never(formulas, against) == Some(true)
        };
        let contact_in = |expression: &'p Expression| match expression {
            Expression::Contact(contact) => Some(contact),
            _ => None,
        };
        if self.is_branch {
            let covers = beside.iter().position(|branch| implies(vec![own], *branch));
            if let Some(covering) = covers.map(|number| self.beside[number]) {
                let message = Message::new("redundant-branch.covered").with("other", words(covering));
                return (message, contact_in(covering));
            }
            return (Message::new("redundant-branch.together"), None);
        }
        if let Some(number) = series.iter().position(|part| implies(vec![*part], own)) {
            let other = self.series[number];
            let message = Message::new("redundant-contact.implied").with("other", words(other));
            return (message, contact_in(other));
        }
        if implies(series, own) {
            let devices = devices_of(self.series.iter().copied());
            return (Message::new("redundant-contact.reached").with("devices", devices), None);
        }
        let devices = devices_of(self.beside.iter().copied());
        match devices.is_empty() {
            true => (Message::new("redundant-contact.same"), None),
            false => (Message::new("redundant-contact.covered").with("devices", devices), None),
        }
    }
}

/// A condition in a few words: contacts in series have a dot between them.
fn words(expression: &Expression) -> String {
    const SHOWN: usize = 4;
    match expression {
        Expression::Contact(contact) => name_of(contact),
        Expression::And(parts)
            if parts.len() <= SHOWN && parts.iter().all(|part| matches!(part, Expression::Contact(_))) =>
        {
            parts.iter().map(words).collect::<Vec<_>>().join(" · ")
        }
        _ => expression.contacts().first().map_or(String::new(), |contact| format!("{} …", name_of(contact))),
    }
}

/// The path with each of `parts` taken away: contacts in series become wire, branches nothing.
fn taken(path: &Path, parts: &[&Expression]) -> Path {
    let mut gates = Vec::new();
    for gate in &path.gates {
        match gate {
            Gate::Pass(expression) => match without(expression, parts, true) {
                Expression::Constant(true) => {}
                kept => gates.push(Gate::Pass(kept)),
            },
            gate => gates.push(gate.clone()),
        }
    }
    let mut drives = Vec::new();
    for drive in &path.drives {
        match drive {
            Drive::Action(_) => drives.push(drive.clone()),
            Drive::Path(inner) => {
                let inner = taken(inner, parts);
                match inner.gates.is_empty() {
                    true => drives.extend(inner.drives),
                    false => drives.push(Drive::Path(inner)),
                }
            }
        }
    }
    Path { gates, drives }
}

/// `in_series` says what a contact that is taken away becomes: wire in a series, nothing among branches.
fn without(expression: &Expression, parts: &[&Expression], in_series: bool) -> Expression {
    if parts.iter().any(|part| std::ptr::eq(*part, expression)) {
        return Expression::Constant(in_series);
    }
    match expression {
        Expression::And(inner) => Expression::and(inner.iter().map(|part| without(part, parts, true))),
        Expression::Or(inner) => Expression::or(inner.iter().map(|part| without(part, parts, false))),
        other => other.clone(),
    }
}

/// Words of samples for each contact.
const SAMPLES: usize = 4;
type Words = [u64; SAMPLES];

fn both(left: Words, right: Words) -> Words {
    std::array::from_fn(|place| left[place] & right[place])
}

/// Values of the contacts of a rung in a few hundred samples.
struct Samples {
    of: FxHashMap<SmolStr, Words>,
    /// Whether contacts depend on each other in ways that samples know nothing of.
    are_blind: bool,
}

impl Samples {
    fn of(contacts: &[&Contact]) -> Samples {
        let mut samples = Samples { of: FxHashMap::default(), are_blind: false };
        for contact in contacts {
            let is_plain =
                matches!(contact.test, Test::Bit(ContactKind::NormallyOpen | ContactKind::NormallyClosed));
            let depends = |other: &&&Contact| other.span != contact.span && share_a_device(other, contact);
            samples.are_blind |= !is_plain && contacts.iter().any(|other| depends(&other));
            samples.are_blind |= decided(contact).is_some();
            let number = samples.of.len();
            samples.of.entry(key(contact)).or_insert_with(|| values(number));
        }
        samples
    }

    fn of_expression(&self, expression: &Expression, taken: Option<(&Expression, bool)>) -> Words {
        if let Some((part, value)) = taken
            && std::ptr::eq(part, expression)
        {
            return [if value { u64::MAX } else { 0 }; SAMPLES];
        }
        let parts = || expression.parts().iter().map(|part| self.of_expression(part, taken));
        match expression {
            Expression::Constant(value) => [if *value { u64::MAX } else { 0 }; SAMPLES],
            Expression::Contact(contact) => {
                let words = self.of.get(&key(contact)).copied().unwrap_or_default();
                match contact.test {
                    Test::Bit(ContactKind::NormallyClosed) => words.map(|word| !word),
                    _ => words,
                }
            }
            Expression::Not(_) => parts().next().unwrap_or_default().map(|word| !word),
            Expression::And(_) => parts().fold([u64::MAX; SAMPLES], both),
            Expression::Or(_) => parts()
                .fold([0; SAMPLES], |left, right| std::array::from_fn(|place| left[place] | right[place])),
        }
    }
}

/// A bit is the same however it is asked for.
fn key(contact: &Contact) -> SmolStr {
    match (contact.test, &contact.terms[..]) {
        (Test::Bit(ContactKind::NormallyOpen | ContactKind::NormallyClosed), [term]) => term.key(),
        _ => name_of(contact).into(),
    }
}

/// The values of the device of this number: all combinations of the first six, and for the others ones that are on in
/// half of the samples, seldom, often, and nearly always, so that long series conduct in some of them.
fn values(number: usize) -> Words {
    const COMBINATIONS: [u64; 6] = [
        0xAAAA_AAAA_AAAA_AAAA,
        0xCCCC_CCCC_CCCC_CCCC,
        0xF0F0_F0F0_F0F0_F0F0,
        0xFF00_FF00_FF00_FF00,
        0xFFFF_0000_FFFF_0000,
        0xFFFF_FFFF_0000_0000,
    ];
    let random = |salt: u64| {
        let mut hasher = rustc_hash::FxBuildHasher.build_hasher();
        hasher.write_u64((number as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ salt);
        let hash = hasher.finish();
        hash ^ (hash >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9)
    };
    let half = COMBINATIONS.get(number).copied().unwrap_or_else(|| random(1));
    [
        half,
        random(2) & random(3) & random(4),
        random(5) | random(6) | random(7),
        random(8) | random(9) | random(10) | random(11) | random(12),
    ]
}
