//! The scan in which two programs differ, made of the values for which their formulas do, and confirmed by running both
//! programs with them.

use crate::logic::{
    Atom, Bounds, Formulas, Moment, Path, Place, Real, Scan, State, Step, Storage, Term, WIDE, evaluate,
    real_at, wholes,
};
use crate::target::iec::{ElementaryType, real_spelled};
use crate::target::{Device, DirectAddress, Model, Operand, Width};
use crate::text::{Message, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// A scan in which two programs differ.
#[derive(Clone, PartialEq, Debug)]
pub struct Counterexample {
    /// Inputs and states at its start, by name.
    pub inputs: BTreeMap<String, Value>,
    /// What was otherwise one scan before, where that matters.
    pub before: BTreeMap<String, Value>,
    /// What differs: a variable, or an action that only one does.
    pub what: String,
    /// What it is on either side.
    pub sides: [Value; 2],
    /// The rungs on either side that differ, or where the stretch starts that does.
    pub at: [Option<Span>; 2],
    /// What programs that name it otherwise call what is named here: names of one address have its spelling.
    pub keys: BTreeMap<String, SmolStr>,
    /// Whether the simulated PLC shows it.
    pub shown: Shown,
}

/// Whether the simulated PLC shows a difference. Proofs are made without it; who tells of them has it tried.
#[derive(Clone, PartialEq, Debug)]
pub enum Shown {
    /// Nobody has tried.
    Untried,
    /// Both programs show it when they are run so.
    Runs(Run),
    /// They do not, for this reason.
    Not(Message),
}

/// How programs are run to show a difference, from the moment when the PLC is switched on: some scans, the one before
/// if there is something to set in it, the one that begins with the inputs, and some more.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Run {
    /// Scans before anything is set.
    pub lead: u64,
    /// Scans behind the one that begins with the inputs. The last one shows the difference.
    pub hold: u64,
    /// From one scan to the next, in nanoseconds.
    pub scan_ns: i64,
}

impl Counterexample {
    /// A difference of which nothing is known but where the programs part.
    pub fn unknown(at: [Option<Span>; 2]) -> Counterexample {
        Counterexample {
            inputs: BTreeMap::new(),
            before: BTreeMap::new(),
            what: String::new(),
            sides: [Value::Bit(false), Value::Bit(true)],
            at,
            keys: BTreeMap::new(),
            shown: Shown::Untried,
        }
    }

    /// How the simulated PLC shows it, if it does.
    pub fn run(&self) -> Option<Run> {
        match self.shown {
            Shown::Runs(run) => Some(run),
            Shown::Untried | Shown::Not(_) => None,
        }
    }
}

/// A value at the start of a scan.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// Of a bit.
    Bit(bool),
    /// Of a word.
    Word(i64),
    /// Of a real number.
    Real(f64),
    /// Of a time, in nanoseconds.
    Time(i64),
    /// Of an enumerated type, a text or a date, as people write it.
    Named(String),
}

impl fmt::Display for Value {
    /// As a literal: `true`, `5`, `1.5`, `T#1500ms`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Bit(value) => write!(f, "{value}"),
            Value::Word(value) => write!(f, "{value}"),
            Value::Real(value) => f.write_str(&real_spelled(*value)),
            Value::Time(nanoseconds) => write!(f, "T#{}ms", nanoseconds / 1_000_000),
            Value::Named(name) => f.write_str(name),
        }
    }
}

/// What a counterexample says of a state.
pub(super) struct Inputs {
    pub inputs: BTreeMap<String, Value>,
    pub before: BTreeMap<String, Value>,
    pub keys: BTreeMap<String, SmolStr>,
}

/// Inputs and states by the names that `paths` have for them, and bits as they were before, as a counterexample has
/// them. Bits of a word are shown with the word.
pub(super) fn inputs(
    state: &State,
    paths: [&[&Path]; 2],
    type_of: &dyn Fn(&str) -> Option<ElementaryType>,
) -> Inputs {
    let names = names_of_addresses(paths);
    let mut keys = BTreeMap::new();
    let mut named = |key: &str, is_bit: bool| {
        let name = names.get(key).map_or_else(|| simulated(key, is_bit), SmolStr::to_string);
        keys.insert(name.clone(), SmolStr::from(key));
        name
    };
    let mut words = state.words.clone();
    for (key, value) in &state.bits {
        if let Some((word, bit)) = bit_of_word(key) {
            let pattern = words.entry(word.into()).or_insert(0);
            *pattern |= i64::from(*value) << bit;
        }
    }
    let bits = state.bits.iter().filter(|(key, _)| bit_of_word(key).is_none());
    let mut inputs: BTreeMap<String, Value> =
        bits.map(|(key, value)| (named(key, true), Value::Bit(*value))).collect();
    // The relays of a group are there as bits.
    for (key, value) in words.iter().filter(|(key, _)| !is_literal(key) && group(key).is_none()) {
        let own = key.trim_start_matches(WIDE);
        let is_time = matches!(type_of(own), Some(ElementaryType::Time | ElementaryType::Ltime));
        inputs.insert(named(key, false), if is_time { Value::Time(*value) } else { Value::Word(*value) });
    }
    inputs.extend(state.reals.iter().map(|(key, real)| (named(key, false), Value::Real(real.value))));
    let before = state.before.iter().map(|(key, value)| (named(key, true), Value::Bit(*value))).collect();
    Inputs { inputs, before, keys }
}

/// What people call a device in the simulator: the contact of a timer or counter is not its value, and a pair of
/// registers not the first of them.
fn simulated(key: &str, is_bit: bool) -> String {
    let own = key.trim_start_matches(WIDE);
    match Operand::read(own, Model::Fx3u) {
        Operand::Device(device) if is_bit && device.kind.has_preset() => {
            format!("{}S{}", device.kind.letter(), device.number)
        }
        Operand::Device(device) if own.len() < key.len() && !device.kind.has_preset() => format!("{own}:32"),
        _ => own.to_string(),
    }
}

/// The key of the word that the bit with this key is a part of, and its number in it.
fn bit_of_word(key: &str) -> Option<(&str, u32)> {
    let (word, number) = key.rsplit_once('.').filter(|(word, _)| !word.starts_with('%'))?;
    let digits = number.trim_start_matches(['%', 'x']);
    // Of the FX family in hexadecimal digits.
    let radix = if key.starts_with(|letter: char| letter.is_ascii_uppercase()) { 16 } else { 10 };
    u32::from_str_radix(digits, radix).ok().filter(|bit| *bit < 63).map(|bit| (word, bit))
}

/// The variables that programs have at addresses, by the keys of these: the first name of each, unless another place
/// has the same.
fn names_of_addresses(paths: [&[&Path]; 2]) -> FxHashMap<SmolStr, SmolStr> {
    let (mut keys, mut names) = (FxHashMap::default(), FxHashMap::default());
    for term in paths.into_iter().flatten().flat_map(|path| path.terms()) {
        let key = term.key();
        let is_own = *keys.entry(term.text.clone()).or_insert_with(|| key.clone()) == key;
        if term.address().is_some() && is_own {
            names.entry(key).or_insert_with(|| term.text.clone());
        }
    }
    names
}

/// A state in which two programs are confirmed to differ at `place`, and what that is in each of them: `state`, or one
/// in which one bit is another. What formulas leave open, such as what an instruction makes of bits, may be the only
/// thing that is wrong with a state.
pub(super) fn confirmed_near(
    state: State,
    paths: [&[&Path]; 2],
    place: &Place,
) -> Option<(State, [bool; 2])> {
    if let Some(values) = confirmed(&state, paths, place) {
        return Some((state, values));
    }
    let groups = state.words.keys().filter_map(|key| group(key));
    let grouped: BTreeSet<SmolStr> = groups.flatten().collect();
    // The bits of a word that the counterexample shows as a number stay as they are.
    let own = state.bits.keys().filter(|key| !grouped.contains(*key)).take(RETRIES_MAX);
    own.cloned().collect::<Vec<_>>().into_iter().find_map(|key| {
        let mut other = state.clone();
        other.bits.entry(key).and_modify(|bit| *bit = !*bit);
        let values = confirmed(&other, paths, place)?;
        Some((other, values))
    })
}

/// So many states near to one that is not confirmed are looked at.
const RETRIES_MAX: usize = 32;

/// What `place` is in each of two programs when they are run from `state`, if it differs. Where something is guessed of
/// what units of the program leave behind, it must differ whatever that is.
fn confirmed(state: &State, paths: [&[&Path]; 2], place: &Place) -> Option<[bool; 2]> {
    let scans = paths.map(|paths| evaluate(paths, state));
    let guesses: BTreeSet<u32> = scans.iter().flat_map(|scan| scan.guesses.iter().copied()).collect();
    let found = differing(&scans, place)?;
    let left = |event: &u32| state.left_behind.get(event);
    if scans.iter().any(|scan| scan.guesses_words) {
        return None;
    }
    let bits = guesses.iter().flat_map(|event| {
        let keys = left(event).into_iter().flat_map(|left| left.bits.keys());
        keys.map(|key| (*event, key.clone()))
    });
    let bits: Vec<(u32, SmolStr)> = bits.collect();
    let differs = |values: u32| {
        let mut state = state.clone();
        for (place, (event, key)) in bits.iter().enumerate() {
            let left = state.left_behind.entry(*event).or_default();
            left.bits.insert(key.clone(), values >> place & 1 == 1);
        }
        differing(&paths.map(|paths| evaluate(paths, &state)), place).is_some()
    };
    (bits.len() <= GUESSES_MAX && (0..1 << bits.len()).all(differs)).then_some(found)
}

/// Whether each number is one that a variable of its type can have; `type_of` tells that of a key. Texts, dates and
/// values of enumerated types have none.
pub(super) fn is_possible(state: &State, type_of: &dyn Fn(&str) -> Option<ElementaryType>) -> bool {
    use ElementaryType::{Ltime, Time};
    let left = state.left_behind.values().flat_map(|left| &left.words);
    state.words.iter().chain(left).all(|(key, value)| {
        let key = key.trim_start_matches(WIDE);
        match type_of(key) {
            Some(Time | Ltime) => true,
            Some(kind) => kind.integers().is_some_and(|range| range.contains(&i128::from(*value))),
            // Names of variables are in small letters, those of devices are not.
            None => {
                let is_name = key.starts_with(|letter: char| letter.is_lowercase() || letter == '_');
                !is_name || !matches!(Operand::read(key, Model::Iec), Operand::Variable)
            }
        }
    })
}

/// Whether running these with plain values is what a PLC does: no elements of arrays are used of which nobody knows
/// which are the same, no whole beside its parts, and no two variables of different sizes share memory.
pub(super) fn is_plain(paths: &[&Path]) -> bool {
    let variables = paths.iter().flat_map(|path| path.terms());
    let variables = variables.filter(|term| term.operand == Operand::Variable);
    if variables
        .clone()
        .any(|term| term.is_element() && !(term.is_fixed() && term.storage != Storage::Anywhere))
    {
        return false;
    }
    let wholes: FxHashSet<SmolStr> = variables
        .clone()
        .filter(|term| term.is_element())
        .flat_map(|term| wholes(&term.key()).map(SmolStr::from).collect::<Vec<_>>())
        .collect();
    if variables.into_iter().any(|term| wholes.contains(&term.key())) {
        return false;
    }
    let terms = paths.iter().flat_map(|path| path.terms());
    let addresses: FxHashSet<DirectAddress> = terms.filter_map(Term::address).collect();
    let (bits, words): (Vec<_>, Vec<_>) = addresses.into_iter().partition(|at| at.width == Width::Bit);
    let is_shared = |word: &DirectAddress| {
        let has_other =
            words.iter().any(|other| other.location == word.location && other.width != word.width);
        has_other || bits.iter().any(|bit| may_hold(*word, *bit))
    };
    !words.iter().any(is_shared)
}

/// All values of so many guessed bits are tried.
const GUESSES_MAX: usize = 8;

fn differing(scans: &[Scan<'_>; 2], place: &Place) -> Option<[bool; 2]> {
    let [left, right] = scans.each_ref().map(|scan| match place {
        Place::Bit(key) => Some(scan.bit(key)),
        Place::Event(number) => scan.events.get((*number as usize).checked_sub(1)?).copied(),
    });
    let values = [left?, right?];
    (values[0] != values[1]).then_some(values)
}

/// The state of the PLC in which atoms have these values; nothing if there is none, as words are numbers.
pub(super) fn state(formulas: &Formulas, values: &BTreeMap<u32, bool>) -> Option<State> {
    let mut state = State::default();
    let mut idle = Vec::new();
    for (atom, value) in values {
        match formulas.atom_at(*atom) {
            Atom::Bit(of) => match event(formulas, of) {
                None => _ = state.bits.insert(of.name.clone(), *value),
                Some(event) => {
                    let left = state.left_behind.entry(event).or_default();
                    left.bits.insert(of.name.clone(), *value);
                }
            },
            Atom::Edge { of, value: driven, rising } if *value => {
                if driven.is_none() && of.since == 0 {
                    state.bits.insert(of.name.clone(), *rising);
                }
                state.before.insert(of.name.clone(), !rising);
            }
            Atom::Edge { of, value: driven, rising } => idle.push((of, *driven, *rising)),
            Atom::Behind(event) => state.left_behind.entry(*event).or_default().passes = *value,
            // What a PLC makes of it, nobody knows.
            Atom::NoNumber(_) if *value => return None,
            Atom::NoNumber(_)
            | Atom::SingleEdge(_)
            | Atom::Rail
            | Atom::Reaches { .. }
            | Atom::AtLeast { .. } => {}
        }
    }
    for (of, driven, rising) in idle {
        // A bit that did not change has no edge of either kind.
        let now = match driven {
            Some(driven) => {
                let value = |atom: u32| values.get(&atom).copied().unwrap_or(false);
                formulas.evaluate(&[driven], value)[0]
            }
            None => state.bits.get(&of.name).copied().unwrap_or(rising),
        };
        state.before.entry(of.name.clone()).or_insert(now);
    }
    for (word, number) in Bounds::of(formulas, values, true).solved()? {
        let real = formulas.type_of(&word.name).and_then(|kind| Some((real_at(number, kind)?, kind)));
        match (event(formulas, &word), real) {
            (None, Some((value, kind))) => {
                let single = kind == ElementaryType::Real;
                state.reals.insert(word.name, Real { value, single });
            }
            (None, None) => {
                spread(&mut state, &word.name, number);
                state.words.insert(word.name, number);
            }
            (Some(_), Some(_)) => return None,
            (Some(event), None) => {
                state.left_behind.entry(event).or_default().words.insert(word.name, number);
            }
        }
    }
    // What an event leaves as it found it was so before, unless that is known to be otherwise.
    for left in state.left_behind.values() {
        for (name, value) in &left.bits {
            state.bits.entry(name.clone()).or_insert(*value);
        }
        for (name, value) in &left.words {
            state.words.entry(name.clone()).or_insert(*value);
        }
    }
    (!has_halves(&state) && has_its_bits(&state)).then_some(state)
}

/// Whether a 32-bit value is there beside its own halves, or words of several sizes in one area of memory, of which
/// nobody made sure that they fit.
fn has_halves(state: &State) -> bool {
    let addresses = state.words.keys().filter_map(|name| match Operand::read(name, Model::Iec) {
        Operand::Direct(address) => Some(address),
        _ => None,
    });
    let addresses: Vec<DirectAddress> = addresses.collect();
    let in_one = |one: &DirectAddress| {
        addresses.iter().any(|other| one.location == other.location && one.width != other.width)
    };
    if addresses.iter().any(in_one) {
        return true;
    }
    let is_half = |number: u32, kind| {
        let half = Device::new(kind, number).to_string();
        state.words.contains_key(half.as_str())
    };
    state.words.keys().filter_map(|name| name.strip_prefix(WIDE)).any(|name| {
        match Operand::read(name, Model::Fx3u) {
            Operand::Device(device) => {
                is_half(device.number, device.kind) || is_half(device.number + 1, device.kind)
            }
            _ => false,
        }
    })
}

/// Whether bits that are parts of words are what the numbers of these say, as far as both are known, and no bit lies at
/// an address where a word may lie, too: which bits are whose, the PLC decides.
fn has_its_bits(state: &State) -> bool {
    let is_known = |key: &str| match Operand::read(key, Model::Iec) {
        Operand::Direct(bit) => !state.words.keys().any(|word| match Operand::read(word, Model::Iec) {
            Operand::Direct(word) => may_hold(word, bit),
            _ => false,
        }),
        _ => true,
    };
    // One bit of a word may have two names: `w.1` and `w.%X1`.
    let mut known: FxHashMap<(&str, u32), bool> = FxHashMap::default();
    state.bits.iter().all(|(key, value)| match bit_of_word(key) {
        Some(bit) if *known.entry(bit).or_insert(*value) != *value => false,
        Some((word, bit)) if state.words.contains_key(word) => (state.words[word] >> bit & 1 == 1) == *value,
        _ => is_known(key),
    })
}

/// Whether a bit may be a part of a word, whether words are counted in words or in bytes.
fn may_hold(word: DirectAddress, bit: DirectAddress) -> bool {
    let bytes = match word.width {
        Width::Bit => return false,
        Width::Byte => 1,
        Width::Word => 2,
        Width::Double => 4,
        Width::Long => 8,
    };
    let ([Some(word_at), None, ..], [Some(byte), Some(_), None, None]) = (word.path, bit.path) else {
        return word.location == bit.location;
    };
    let holds = |first: u32| (first..first.saturating_add(bytes)).contains(&byte);
    word.location == bit.location && (holds(word_at) || holds(word_at.saturating_mul(bytes)))
}

/// The event after which a device is read; nothing if that is its value at the start, or what was driven tells it.
fn event(formulas: &Formulas, of: &Moment) -> Option<u32> {
    match formulas.step_at(of.since)? {
        Step::Event { number, .. } => Some(*number),
        Step::Driven { .. } | Step::Asked { .. } => None,
    }
}

/// A word of bits gives them their values, as far as they have none.
fn spread(state: &mut State, name: &str, number: i64) {
    for (bit, key) in group(name).into_iter().flatten().enumerate() {
        state.bits.entry(key).or_insert(number >> bit & 1 == 1);
    }
}

/// The keys of the bits that a word is made of, from the lowest on; nothing if it is not made of relays.
fn group(name: &str) -> Option<impl Iterator<Item = SmolStr> + use<>> {
    let name = name.trim_start_matches(WIDE);
    let Operand::Nibbles { digits, first, index: None } = Operand::read(name, Model::Fx3u) else {
        return None;
    };
    let device = move |bit| Device::new(first.kind, first.number + bit).to_string().into();
    Some((0..u32::from(digits) * 4).map(device))
}

/// Whether a word of IEC 61131-3 is a literal.
fn is_literal(name: &str) -> bool {
    matches!(Operand::read(name, Model::Iec), Operand::Literal(_))
}
