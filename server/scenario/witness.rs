//! A difference between two programs as the simulated PLC shows it.
//!
//! A proof finds a state in which two programs differ. A person wants more: values to set, in a PLC that was just
//! switched on, so that something differs that can be seen; nothing among them that does not matter, and nothing left
//! out that does. So both programs are run: from the values of the proof, then from others near to them, with a limit
//! on work that no clock gives. What is shown in the end has been seen.

use super::mutant::lot;
use crate::document::{DeclaredType, Document, Scopes};
use crate::il::iec::PouKind;
use crate::logic::is_helper_name;
use crate::simulate::{Code, Machine, Outcome, Value, Variable, compile};
use crate::target::{Device, DeviceKind};
use crate::text::{Message, folded};
use crate::translate::{Counterexample, Proof, Run, Shown, Value as Held, device_called, variable_called};
use smol_str::{SmolStr, ToSmolStr};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Instructions that are executed at most, some tenths of a second; each scan counts as some more.
const WORK: usize = 30_000_000;
/// The same where no proof says that there is a difference.
const WORK_UNASKED: usize = WORK / 5;
/// What making a PLC counts as.
const WORK_OF_START: usize = 20_000;
/// So many states near to that of the proof are tried.
const TRIES: u64 = 600;
/// Scans that are looked at behind the one that begins with the inputs.
const MOST_HOLD: u64 = 6;
/// From one scan to the next in a scenario that says nothing of it, in nanoseconds.
pub(super) const USUAL_SCAN_NS: i64 = 10_000_000;
/// The same with what lets timers run out.
const SCANS_NS: [i64; 3] = [USUAL_SCAN_NS, 1_000_000_000, 60_000_000_000];
/// Where clocks are used also these, in a few scans of which each is seen on and off: M8011 to M8014, which change each
/// 5 ms, 50 ms, half second and half minute.
const SCANS_OF_CLOCKS_NS: [i64; 3] = [3_000_000, 273_000_000, 17_273_000_000];
const CLOCKS: std::ops::RangeInclusive<u32> = 8011..=8014;
/// The current value of a timer that has run out, whatever its preset.
const RUN_OUT: i64 = i16::MAX as i64;

/// `proof` with the difference, if there is one, as the two programs show it on the simulated PLC. Where nothing was
/// proved, a difference that they show is one all the same.
pub fn shown(proof: Proof, documents: [&Document; 2], names: &[String; 2]) -> Proof {
    let seen = |found: &Counterexample| Trial::of(found, documents, names)?.shown(found);
    match proof {
        Proof::Equal { .. } => proof,
        Proof::Different(found) => Proof::Different(Box::new(match seen(&found) {
            Ok(told) => told,
            Err(reason) => Counterexample { shown: Shown::Not(reason), ..*found },
        })),
        Proof::Undecided { ref suspect, at, .. } => {
            // Programs of two families have timers and memory of different kinds.
            let is_mixed = !documents[0].target().is_kin_of(documents[1].target());
            let nothing = Counterexample::unknown(at);
            let found = suspect.as_deref().or((!is_mixed).then_some(&nothing));
            found.and_then(|found| seen(found).ok()).map_or(proof, |told| Proof::Different(Box::new(told)))
        }
    }
}

/// Two programs that are tried.
struct Trial {
    codes: [Arc<Code>; 2],
    /// What both have, in the order of names.
    handles: Vec<Handle>,
    /// What must differ, most wanted first: what the proof says, then what else can be seen.
    wanted: Vec<usize>,
    /// So many of them are what the proof says.
    own: usize,
    /// Numbers that the first program names, and those beside them.
    numbers: Vec<i64>,
    /// From one scan to the next.
    scans_ns: Vec<i64>,
    work: usize,
    /// What went wrong last in a scan that would have shown a difference.
    error: Option<Message>,
}

/// Something that can be set in the first program, and seen if the second has it, too.
struct Handle {
    /// What the first program calls it.
    name: String,
    own: Variable,
    /// Whether it can be set; only the program drives coils of timers and counters.
    is_settable: bool,
    /// In the second one, which does not care if it is of the other family and has no such variable.
    other: Option<Variable>,
}

impl Handle {
    /// The variable of a side.
    fn side(&self, side: usize) -> Option<Variable> {
        if side == 0 { Some(self.own) } else { self.other }
    }
}

/// Values by the numbers of handles.
type Values = BTreeMap<usize, Value>;

/// How both programs are run.
#[derive(Clone, Debug)]
struct Attempt {
    run: Run,
    /// What is set one scan before.
    before: Values,
    now: Values,
}

/// Looks at both PLCs behind a scan, and says whether that was enough.
type Look<'l> = dyn FnMut(&Trial, u64, &[Machine<u8>; 2]) -> bool + 'l;

/// What differed.
#[derive(Clone, PartialEq, Debug)]
struct Seen {
    hold: u64,
    handle: usize,
    values: [Value; 2],
}

impl Trial {
    fn of(
        found: &Counterexample,
        documents: [&Document; 2],
        programs: &[String; 2],
    ) -> Result<Trial, Message> {
        let code = |side: usize| {
            let reason = |problems: Vec<crate::simulate::Problem>| {
                let reasons = problems.first().map(|problem| problem.obstacle.message());
                let message = Message::new("prove.not-run").with("program", &programs[side]);
                message.with_messages("reason", reasons.into_iter().collect())
            };
            compile(&[documents[side]], false).map(Arc::new).map_err(reason)
        };
        let codes = [code(0)?, code(1)?];
        let finder = [0, 1].map(|side| Finder::new(&codes[side], documents[side], found, side));
        let is_mixed = !codes[0].target.is_kin_of(codes[1].target);
        let mut handles: BTreeMap<String, (Variable, Option<Variable>)> = BTreeMap::new();
        let shared = [0, 1].map(|side| {
            let names = codes[side].named().into_iter().flat_map(|name| parts_of(&name));
            names.map(|name| (finder[side].key(&name), name)).collect::<Vec<_>>()
        });
        let told = found.inputs.keys().chain(found.before.keys()).chain([&found.what]);
        let told =
            told.map(|name| (found.keys.get(name).unwrap_or(&SmolStr::from(name)).clone(), name.clone()));
        let names = told.chain(shared.into_iter().flatten());
        for (key, name) in names.filter(|(_, name)| is_first_scan(name).is_none()) {
            let sides = finder.each_ref().map(|finder| finder.find(&name, &key));
            let [Some((own, first)), second] = sides else { continue };
            let second = second.map(|(_, variable)| variable);
            let is_relay = |variable| matches!(variable, Variable::Relay(_));
            let is_alike = second.map_or(is_mixed, |second| {
                is_relay(first) == is_relay(second) && first.range(&codes[0]) == second.range(&codes[1])
            });
            if is_alike && !handles.values().any(|known| known.0 == first) {
                handles.insert(own, (first, second));
            }
        }
        let handles = handles.into_iter().map(|(name, (own, other))| {
            let is_relay = matches!(own, Variable::Relay(_));
            // Without a state from a proof to begin with, only those are set that any values go together of.
            let is_lone = || !name.contains('.') && parts_of(&name).get(1).is_none_or(|own| *own == name);
            let is_loose = || is_lone() || finder[0].is_count(&name);
            let last = name.rsplit('.').next().unwrap_or(&name);
            let is_free = !documents[0].scopes().is_constant(last) && (!found.what.is_empty() || is_loose());
            let is_settable = is_free && (!is_relay || own.set(&codes[0], &Value::Bit(false)).is_some());
            Handle { name, own, is_settable, other }
        });
        let handles: Vec<Handle> = handles.collect();
        let (own, others) = wanted(found, &handles, &finder[0]);
        let key = found.keys.get(&found.what).map_or(found.what.as_str(), SmolStr::as_str);
        let lacking = (0..2).find(|side| finder[*side].find(&found.what, key).is_none());
        let error = lacking.filter(|_| own.is_empty()).map(|side| {
            Message::new("prove.not-there").with("name", &found.what).with("program", &programs[side])
        });
        let numbers = numbers_in(&documents[0].text());
        let has_clock = handles.iter().any(|handle| is_clock(&handle.name));
        let clocked = SCANS_OF_CLOCKS_NS.into_iter().filter(|_| has_clock);
        let scans_ns = SCANS_NS.into_iter().chain(clocked).collect();
        let (wanted, own) = (own.iter().chain(&others).copied().collect(), own.len());
        let work = if found.what.is_empty() { WORK_UNASKED } else { WORK };
        Ok(Trial { codes, handles, wanted, own, numbers, scans_ns, work, error })
    }

    /// The difference as it is seen.
    ///
    /// # Errors
    /// With the reason, if it is not seen.
    fn shown(&mut self, found: &Counterexample) -> Result<Counterexample, Message> {
        let Some((mut attempt, mut seen)) = self.search(found) else {
            return Err(self.error.take().unwrap_or(Message::new("prove.not-reached")));
        };
        // However long it took to find, it is told with nothing in it that does not matter.
        self.work = WORK;
        attempt.run.hold = seen.hold;
        self.simplify(&mut attempt, &seen);
        self.complete(&mut attempt, &seen);
        // What was only left over from the scan before is set now.
        self.simplify(&mut attempt, &seen);
        seen.values = self.last(&attempt, &seen).unwrap_or(seen.values);
        let name = |handle: usize| self.handles[handle].name.clone();
        let mut inputs: BTreeMap<String, Held> =
            attempt.now.iter().map(|(handle, value)| (name(*handle), held(value))).collect();
        let is_first = attempt.run.lead == 0 && attempt.before.is_empty();
        for name in found.inputs.keys() {
            if let Some(on_at_first) = is_first_scan(name) {
                inputs.insert(name.clone(), Held::Bit(on_at_first == is_first));
            }
        }
        let before = attempt.before.iter().map(|(handle, value)| (name(*handle), held(value)));
        Ok(Counterexample {
            inputs,
            before: before.collect(),
            what: name(seen.handle),
            sides: seen.values.each_ref().map(held),
            at: found.at,
            keys: BTreeMap::new(),
            shown: Shown::Runs(attempt.run),
        })
    }

    /// A way to run both programs so that they differ: as the proof says, with timers that have run out, a few scans
    /// later, or with other values.
    fn search(&mut self, found: &Counterexample) -> Option<(Attempt, Seen)> {
        let at = |name: &String| {
            let is_it = |handle: &Handle| handle.is_settable && handle.name.eq_ignore_ascii_case(name);
            self.handles.iter().position(is_it)
        };
        let values = |of: &BTreeMap<String, Held>| -> Values {
            of.iter().filter_map(|(name, value)| Some((at(name)?, given(value)))).collect()
        };
        let (mut before, now) = (values(&found.before), values(&found.inputs));
        // What did not change needs no scan before.
        if before.iter().all(|(handle, value)| now.get(handle) == Some(value)) {
            before.clear();
        }
        let mut full = now.clone();
        for (number, current) in self.currents() {
            if now.get(&number).and_then(Value::as_bit) == Some(true) {
                full.insert(current, Value::Number(RUN_OUT));
            }
        }
        let mut spare = None;
        let runs = [0, MOST_HOLD].into_iter().flat_map(|hold| {
            let leads = move |scan_ns| (0..2).map(move |lead| Run { lead, hold, scan_ns });
            self.scans_ns.clone().into_iter().flat_map(leads)
        });
        for run in runs.collect::<Vec<_>>() {
            for now in [&now, &full] {
                let attempt = Attempt { run, before: before.clone(), now: now.clone() };
                if let Some(shown) = self.tried(attempt, &mut spare) {
                    return Some(shown);
                }
            }
        }
        for number in 0..TRIES {
            let attempt = self.other(number, [&before, &full]);
            if let Some(shown) = self.tried(attempt, &mut spare) {
                return Some(shown);
            }
        }
        spare
    }

    /// The attempt if it shows what the proof says; if it shows something else, it may be of use later.
    fn tried(&mut self, attempt: Attempt, spare: &mut Option<(Attempt, Seen)>) -> Option<(Attempt, Seen)> {
        let seen = self.run(&attempt)?;
        if self.wanted[..self.own].contains(&seen.handle) {
            return Some((attempt, seen));
        }
        spare.get_or_insert((attempt, seen));
        None
    }

    /// Contacts of timers and counters with their current values.
    fn currents(&self) -> Vec<(usize, usize)> {
        let at = |name: &str| self.handles.iter().position(|handle| handle.name == name);
        let own = self.handles.iter().enumerate();
        let pairs = own.filter_map(|(number, handle)| {
            let [_, current, _] = <[String; 3]>::try_from(parts_of(&handle.name)).ok()?;
            Some((number, at(&current)?))
        });
        pairs.collect()
    }

    /// The state number `number` near to one.
    fn other(&self, number: u64, [before, now]: [&Values; 2]) -> Attempt {
        let draw = |place: u64| lot(number, place);
        // The first ones change little, the last ones all.
        let is_kept = |place: u64| draw(place) % 16 >= number % 17;
        let mut attempt = Attempt {
            run: Run {
                lead: draw(1) % 2,
                hold: MOST_HOLD,
                scan_ns: self.scans_ns[(draw(2) % self.scans_ns.len() as u64) as usize],
            },
            before: before.clone(),
            now: now.clone(),
        };
        let has_before = match draw(3) % 3 {
            0 => {
                attempt.before.clear();
                false
            }
            // A scan with the same values, where nothing else is said.
            kind => {
                let words = now.iter().filter(|_| kind == 2);
                let missing = words.filter(|(handle, _)| !before.contains_key(handle));
                attempt.before.extend(missing.map(|(handle, value)| (*handle, value.clone())));
                true
            }
        };
        for handle in (0..self.handles.len()).filter(|handle| self.handles[*handle].is_settable) {
            let place = 8 * handle as u64 + 8;
            if !is_kept(place) {
                attempt.now.insert(handle, self.value(handle, draw(place + 1)));
            }
            if has_before && !is_kept(place + 2) {
                attempt.before.insert(handle, self.value(handle, draw(place + 3)));
            }
        }
        attempt
    }

    /// A value for a variable, by a random number.
    fn value(&self, handle: usize, draw: u64) -> Value {
        let own = self.handles[handle].own;
        let number = match own {
            Variable::Relay(_) => return Value::Bit(draw % 2 == 1),
            _ if draw.is_multiple_of(7) => RUN_OUT,
            _ => self.numbers[(draw / 8 % self.numbers.len() as u64) as usize],
        };
        // A value that it cannot have would spoil the scan for all others.
        let range = own.range(&self.codes[0]);
        Value::Number(range.map_or(number, |range| number.clamp(*range.start(), *range.end())))
    }

    /// The first difference of what is wanted, from the scan that begins with the inputs on. Scans in which something
    /// goes wrong show nothing.
    fn run(&mut self, attempt: &Attempt) -> Option<Seen> {
        let first = attempt.first();
        let mut seen = None;
        self.scans(attempt, &mut |trial, scan, machines| {
            if scan < first {
                return false;
            }
            let differing = trial.wanted.iter().find_map(|handle| {
                let values = trial.values(*handle, machines);
                let hold = scan - first;
                (values[0] != values[1]).then_some(Seen { hold, handle: *handle, values })
            });
            seen = differing;
            seen.is_some()
        })?;
        seen
    }

    /// Runs both programs and lets `look` see them behind each scan, until it has seen enough. Nothing if something
    /// goes wrong in a scan, or if that is too much work.
    fn scans(&mut self, attempt: &Attempt, look: &mut Look<'_>) -> Option<()> {
        let first = attempt.first();
        let effort: usize = self.codes.iter().map(|code| code.instructions() + 100).sum();
        let effort = effort * (first + attempt.run.hold + 1) as usize + WORK_OF_START;
        self.work = self.work.checked_sub(effort)?;
        let mut machines = self.codes.each_ref().map(|code| Machine::new(Arc::clone(code)));
        for scan in 0..=first + attempt.run.hold {
            let set = match scan {
                _ if scan == first => Some(&attempt.now),
                _ if scan + 1 == first && scan == attempt.run.lead => Some(&attempt.before),
                _ => None,
            };
            for (side, machine) in machines.iter_mut().enumerate() {
                for (handle, value) in set.into_iter().flatten() {
                    if let Some(variable) = self.handles[*handle].side(side) {
                        variable.set(&self.codes[side], value)?.apply(machine);
                    }
                }
                let Outcome { errors, .. } = machine.scan((scan as i64).saturating_mul(attempt.run.scan_ns));
                if let Some(error) = errors.first() {
                    self.error = Some(error.kind.message());
                    return None;
                }
            }
            if look(self, scan, &machines) {
                break;
            }
        }
        Some(())
    }

    fn values(&self, handle: usize, machines: &[Machine<u8>; 2]) -> [Value; 2] {
        let Handle { own, other, .. } = &self.handles[handle];
        let value = machines[0].value(*own, 0);
        [value.clone(), other.map_or(value, |other| machines[1].value(other, 0))]
    }

    /// Whether an attempt shows the same as another one did: that value in the first program, another in the second.
    fn shows(&mut self, attempt: &Attempt, seen: &Seen) -> bool {
        self.is_same(attempt, seen) == Some(true)
    }

    /// The same; nothing if something goes wrong on the way.
    fn is_same(&mut self, attempt: &Attempt, seen: &Seen) -> Option<bool> {
        let [left, right] = self.last(attempt, seen)?;
        Some(left == seen.values[0] && left != right)
    }

    /// What the variable that differs is in the last scan of an attempt; nothing if something goes wrong.
    fn last(&mut self, attempt: &Attempt, seen: &Seen) -> Option<[Value; 2]> {
        let last = attempt.first() + seen.hold;
        let mut values = None;
        self.scans(attempt, &mut |trial, scan, machines| {
            values = (scan == last).then(|| trial.values(seen.handle, machines));
            values.is_some()
        })?;
        values
    }

    /// Leaves out what does not matter: what shows the same when it is not set, and when it is set to something else.
    fn simplify(&mut self, attempt: &mut Attempt, seen: &Seen) {
        let mut least = attempt.clone();
        least.run.scan_ns = SCANS_NS[0];
        least.run.lead = 0;
        for shorter in [Attempt { before: Values::new(), ..least.clone() }, least] {
            if self.shows(&shorter, seen) {
                *attempt = shorter;
                break;
            }
        }
        for handle in attempt.before.keys().copied().collect::<Vec<_>>() {
            let mut without = attempt.clone();
            without.before.remove(&handle);
            // The last one keeps the scan in its place.
            if without.before.is_empty() {
                without.run.lead += 1;
            }
            if self.shows(&without, seen) {
                *attempt = without;
            }
        }
        // Without the one another may not matter any more.
        let mut known = usize::MAX;
        while attempt.now.len() < known {
            known = attempt.now.len();
            for handle in attempt.now.keys().copied().collect::<Vec<_>>() {
                let mut without = attempt.clone();
                let value = without.now.remove(&handle);
                if self.shows(&without, seen) && !self.matters(&without, seen, handle, value.as_ref()) {
                    *attempt = without;
                }
            }
        }
    }

    /// Adds what matters though nobody set it, with the value that it has.
    fn complete(&mut self, attempt: &mut Attempt, seen: &Seen) {
        let first = attempt.first();
        for handle in 0..self.handles.len() {
            let is_settable = self.handles[handle].is_settable;
            if !is_settable || attempt.now.contains_key(&handle) || !self.matters(attempt, seen, handle, None)
            {
                continue;
            }
            let mut value = None;
            let known = Attempt { now: Values::new(), ..attempt.clone() };
            let start = self.codes.each_ref().map(|code| Machine::<u8>::new(Arc::clone(code)));
            if first == 0 {
                value = Some(self.values(handle, &start)[0].clone());
            } else {
                let _ = self.scans(&known, &mut |trial, scan, machines| {
                    value = (scan + 1 == first).then(|| trial.values(handle, machines)[0].clone());
                    value.is_some()
                });
            }
            let Some(value) = value else { continue };
            let mut with = attempt.clone();
            with.now.insert(handle, value);
            if self.shows(&with, seen) {
                *attempt = with;
            }
        }
    }

    /// Whether it makes a difference to set a variable to something else than it is, or than `value`.
    fn matters(&mut self, attempt: &Attempt, seen: &Seen, handle: usize, value: Option<&Value>) -> bool {
        let others = match self.handles[handle].own {
            Variable::Relay(_) => vec![Value::Bit(false), Value::Bit(true)],
            Variable::Enumerated(..) => (0..4).map(Value::Number).collect(),
            _ => match value {
                Some(Value::Number(number)) => {
                    [0, 1, RUN_OUT, number + 1, number - 1].map(Value::Number).to_vec()
                }
                _ => [0, 1, RUN_OUT].map(Value::Number).to_vec(),
            },
        };
        others.into_iter().any(|other| {
            let mut changed = attempt.clone();
            changed.now.insert(handle, other);
            self.is_same(&changed, seen) == Some(false)
        })
    }
}

impl Attempt {
    /// The scan that begins with the inputs.
    fn first(&self) -> u64 {
        self.run.lead + u64::from(!self.before.is_empty())
    }
}

/// Finds the variables of a program by the names of a proof.
struct Finder<'c> {
    code: &'c Code,
    scopes: &'c Scopes,
    /// The unit of the rungs that differ.
    unit: Option<usize>,
    /// What may stand around a name: the program of the rungs that differ, or the instances of their block.
    around: Vec<String>,
}

impl<'c> Finder<'c> {
    fn new(code: &'c Code, document: &'c Document, found: &Counterexample, side: usize) -> Finder<'c> {
        let scopes = document.scopes();
        let number = found.at[side].and_then(|span| document.unit_at(span.start as usize).number);
        let around = match number.and_then(|number| scopes.pous.get(number)) {
            Some(unit) if unit.kind == PouKind::Program => vec![unit.name.to_string()],
            Some(unit) => {
                let name = folded(&unit.name);
                let programs = scopes.pous.iter().filter(|pou| pou.kind == PouKind::Program);
                let instances = programs.flat_map(|program| {
                    let own = program.variables.iter().filter(|one| folded(&one.words) == name);
                    own.map(|one| format!("{}.{}", program.name, one.name))
                });
                instances.collect()
            }
            None => Vec::new(),
        };
        Finder { code, scopes, unit: number, around }
    }

    /// What a proof calls the variable with this name.
    fn key(&self, name: &str) -> SmolStr {
        let address = self.scopes.variable(self.unit, name).and_then(|variable| variable.address);
        match address.filter(|_| !self.code.target.is_fx()) {
            Some(address) => address.to_smolstr(),
            None if self.code.target.is_fx() => name.into(),
            None => folded(name),
        }
    }

    /// Whether a name is that of the current value of a counter, whatever unit has it. It may be any: the counter
    /// compares it at each call.
    fn is_count(&self, name: &str) -> bool {
        let Some((path, "CV")) = name.rsplit_once('.') else { return false };
        let counter = path.rsplit('.').next().unwrap_or(path);
        let is_counter = |unit: usize| {
            let declared = self.scopes.type_of(Some(unit), counter);
            matches!(declared, Some(DeclaredType::Named(block)) if ["ctu", "ctd", "ctud"].contains(&block.as_str()))
        };
        (0..self.scopes.pous.len()).any(is_counter)
    }

    /// The variable that a proof calls `name`, or in the words of the other family `key`, with what it is called here.
    /// A pair of registers is no register.
    fn find(&self, name: &str, key: &str) -> Option<(String, Variable)> {
        let around = self.around.iter().map(|around| format!("{around}.{name}"));
        let [first, last] = match self.code.target.is_fx() {
            true => [device_called(key), None],
            false => [None, variable_called(key).or(Some(key.to_string()))],
        };
        let names = first.into_iter().chain([name.to_string()]).chain(around).chain(last);
        names.into_iter().find_map(|name| self.code.variable(&name).map(|variable| (name, variable)))
    }
}

/// Which of the handles must differ, most wanted first: what the proof says, and what else can be seen.
fn wanted(found: &Counterexample, handles: &[Handle], finder: &Finder<'_>) -> (Vec<usize>, Vec<usize>) {
    let key = found.keys.get(&found.what).map_or(found.what.as_str(), SmolStr::as_str);
    let named = finder.find(&found.what, key).map(|(name, _)| name);
    let words: Vec<String> =
        found.what.split(' ').flat_map(parts_of).map(|word| folded(&word).to_string()).collect();
    let instance = format!("{}.", folded(&found.what));
    let is_own = |handle: &Handle| {
        let name = folded(&handle.name);
        named.as_ref() == Some(&handle.name)
            || words.iter().any(|word| *word == *name)
            || name.starts_with(&instance)
            || name.contains(&format!(".{instance}"))
    };
    let is_helper = |handle: &Handle| is_helper_name(handle.name.rsplit('.').next().unwrap_or(&handle.name));
    // No instruction reads the coil of a timer or a counter.
    let is_coil = |handle: &Handle| {
        let number = ["TC", "CC"].iter().find_map(|coil| handle.name.strip_prefix(coil));
        number.is_some_and(|number| number.parse::<u32>().is_ok())
    };
    let shared = (0..handles.len()).filter(|number| handles[*number].other.is_some());
    let shared = shared.filter(|number| !is_coil(&handles[*number]));
    let (own, others): (Vec<usize>, Vec<usize>) = shared.partition(|number| is_own(&handles[*number]));
    (own, others.into_iter().filter(|number| !is_helper(&handles[*number])).collect())
}

/// What can be seen of a device: of a timer or counter its contact, its current value, and its coil.
fn parts_of(name: &str) -> Vec<String> {
    let mut letters = name.chars();
    let kind = letters.next().and_then(DeviceKind::of_letter).filter(|kind| kind.has_preset());
    let Some(kind) = kind else { return vec![name.to_string()] };
    let rest = letters.as_str();
    let number = rest.strip_prefix(['S', 's']).unwrap_or(rest);
    let letter = kind.letter();
    match number.parse::<u32>() {
        Ok(number) => {
            vec![format!("{letter}S{number}"), format!("{letter}{number}"), format!("{letter}C{number}")]
        }
        Err(_) => vec![name.to_string()],
    }
}

/// Whether a name is that of the relay that is on in the first scan alone, or of the one that is off in it.
pub(super) fn is_first_scan(name: &str) -> Option<bool> {
    let is = |device: Device| name.eq_ignore_ascii_case(&device.to_string());
    is(Device::FIRST_SCAN).then_some(true).or_else(|| is(Device::OFF_AT_FIRST).then_some(false))
}

/// Whether a name is that of a relay that goes on and off by itself.
fn is_clock(name: &str) -> bool {
    CLOCKS.map(|number| Device::new(DeviceKind::M, number)).any(|clock| clock.to_string() == name)
}

/// The whole numbers in a text, those beside them, and 0.
fn numbers_in(text: &str) -> Vec<i64> {
    let runs = text.split(|letter: char| !letter.is_ascii_digit());
    let numbers: BTreeSet<i64> = runs.filter_map(|run| run.parse::<i16>().ok()).map(i64::from).collect();
    let near = numbers.into_iter().flat_map(|number| [number - 1, number, number + 1, -number]);
    let near: BTreeSet<i64> = near.chain([0]).collect();
    near.into_iter().collect()
}

fn given(value: &Held) -> Value {
    match value {
        Held::Bit(value) => Value::Bit(*value),
        Held::Word(value) => Value::Number(*value),
        Held::Real(value) => Value::Real(*value),
        Held::Time(value) => Value::Time(*value),
        Held::Named(name) => Value::read(name).unwrap_or_else(|| Value::Name(name.into())),
    }
}

fn held(value: &Value) -> Held {
    match value {
        Value::Bit(value) => Held::Bit(*value),
        Value::Number(value) => Held::Word(*value),
        Value::Real(value) => Held::Real(*value),
        Value::Time(value) => Held::Time(*value),
        other => Held::Named(other.to_string()),
    }
}
