//! Between the FX family and IEC 61131-3: devices become located variables and back.
//!
//! | device | variable |
//! |---|---|
//! | `X12` (octal) | `X12 AT %IX1.2 : BOOL`: byte and bit of the number |
//! | `Y12` (octal) | `Y12 AT %QX1.2 : BOOL` |
//! | `M20` | `M20 AT %MX2.4 : BOOL` |
//! | `S20` | `S20 AT %MX1102.4 : BOOL`, from byte 1,100 on, behind the auxiliary relays |
//! | `D20` | `D20 AT %MW1020 : INT`, from word 1,000 on, behind the states |
//! | `D20` and `D21` as 32 bits | `D20 AT %MD510 : DINT`, the double word over both |
//! | `D21` and `D22` as 32 bits | `D21 AT %MD10021 : DINT`: no double word lies over both, so they have their own |
//! | `M500`, `S500`, `D200` … that the model keeps while it is off | the same in `VAR RETAIN` |
//! | `OUT T0 K50` | the instance `T0 : TON`, called with `PT := T#5s` by the unit of the timer; contact `T0.Q` |
//! | `OUT C0 K10` | the instance `C0 : CTU`, called with `PV := 10`; contact `C0.Q`, value `C0.CV` beside a constant |
//! | `RST C0` | `R C0`, a call of the block with this input alone; `C0 : CTU := (PV := 10)` |
//! | `LDP M0`, `PLS M0` | `Rise1 : R_TRIG`; `PLS_M0 : R_TRIG`, the output stored in `M0` |
//! | `LDF M0`, `PLF M0` | two variables that find the falling edge, as F_TRIG is on in its first call |
//! | an `F_TRIG` that is called in each scan | `LDF X0` in parallel with `LD M8002`, `ANI X0` |
//! | `CJ P0` | `JMPC P0` |
//! | `CJ P63`, `END` before other rungs | `RETC`, `RET` |
//! | `LD>=`, `LDD>=` and their kin | `GE` and its kin on variables of type INT, DINT |
//! | `MOV`, `ADD`, `SUB`, `DMOV` … | `LD`, `ADD`, `SUB`, `ST`, jumped over where power does not reach them |
//! | `INC D0`, `DEC D0`, `DINC D0` … | the same with the operand `1`; `INT#1` is the `K1` of an ADD or SUB |
//! | `RST D0` | a store of `0` in an INT; `INT#0` stands for the `K0` of a MOV |
//! | `NEG D0` | the difference of `0` and the variable; `INT#0` stands for the `K0` of a SUB |
//! | `WAND`, `WOR`, `WXOR`, `CML` | `AND`, `OR`, `XOR`, `NOT` between `INT_TO_WORD` and `WORD_TO_INT` |
//! | `MUL` | `MUL` behind `INT_TO_DINT`, stored in the pair |
//! | `DIV D0 K7 D2` | `DIV` stored in `D2`, `MOD` stored in `D3` |
//! | `CMP`, `ZCP` | three comparisons that each set and reset a relay; these come back as they are |
//! | `ZRST`, `FMOV`, `BMOV` | one reset or store for each device, up to 16; these come back as they are |
//! | `MOVP` and the like | the same behind an instance `Pulse1 : R_TRIG` |
//! | `M8000`, `M8001` | `TRUE`, `FALSE` |
//! | `M8002`, `M8003` | the variable `M8002`, which the first rung switches: see `first_scan` |
//! | `LD M8002`, `SET M5`, `MOV K7 D0` as the first rung | from `M5 AT %MX0.5 : BOOL := TRUE` and the like |
//!
//! `END` is dropped and put back. What has no counterpart keeps its words in a comment: retentive timers, counters of
//! 32 bits, special relays, steps, groups of bits, and applied instructions for which IEC 61131-3 has no operator that
//! does exactly the same. Nor have 32 bits one half of which is used in another way, too, for IEC 61131-3 leaves open
//! how words lie in a double word. The way back takes variables by their addresses, and by their names where they
//! have none and these are names of devices that nothing else is.

mod counted;
mod doubts;
mod first_scan;
mod guarded;
mod kept;
mod lack;
mod registers;
mod to_devices;
mod to_variables;

use self::counted::{Coils, Instances};
use self::first_scan::Initials;
use self::guarded::Open;
pub use self::kept::{KEPT, KEPT_FORMS};
use self::lack::{Lack, single_edge, without};
use self::registers::Registers;
use super::source::{self, Program, Source};
use super::{To, Translated};
use crate::document::Document;
use crate::il::iec::PouKind;
use crate::logic::{Action, Deed, Drive, Path, Refusal, Term};
use crate::target::{Device, DeviceKind, DirectAddress, Form, Location, Model, Operand, Target, Width};
use crate::text::{Message, Span};
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::sync::Arc;

/// What stands for an applied instruction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Work {
    /// A function of the same operands.
    Function(&'static str),
    /// One of a register and 1, stored there.
    Step(&'static str),
    /// 0 without a register, stored there.
    Negate,
    /// A function of patterns.
    Bits(&'static str),
    /// A product of 32 bits.
    Multiply,
    /// A quotient and a remainder.
    Divide,
    /// Three relays that tell how two numbers compare.
    Compare,
    /// Three relays that tell where a number lies.
    Zone,
    /// Resets from one device to another.
    Clear,
    /// Copies of one word.
    Fill,
    /// Copies of a row of words.
    Block,
}

/// The plain mnemonics of the instructions that are something else there.
const WORKS: [(&str, Work); 17] = [
    ("MOV", Work::Function("MOVE")),
    ("ADD", Work::Function("ADD")),
    ("SUB", Work::Function("SUB")),
    ("INC", Work::Step("ADD")),
    ("DEC", Work::Step("SUB")),
    ("NEG", Work::Negate),
    ("WAND", Work::Bits("AND")),
    ("WOR", Work::Bits("OR")),
    ("WXOR", Work::Bits("XOR")),
    ("CML", Work::Bits("NOT")),
    ("MUL", Work::Multiply),
    ("DIV", Work::Divide),
    ("CMP", Work::Compare),
    ("ZCP", Work::Zone),
    ("ZRST", Work::Clear),
    ("FMOV", Work::Fill),
    ("BMOV", Work::Block),
];

impl Work {
    /// That of an instruction, in any of its forms.
    fn of(form: Form) -> Option<Work> {
        WORKS.iter().find(|(mnemonic, _)| *mnemonic == form.instruction.mnemonic).map(|(_, work)| *work)
    }

    /// The instruction that does it with 16 or 32 bits.
    fn form(self, wide: bool) -> Option<Form> {
        let (mnemonic, _) = WORKS.iter().find(|(_, work)| *work == self)?;
        Form::named(mnemonic).map(|form| Form { wide, ..form })
    }
}

/// The pointer that stands for END.
const END_POINTER: &str = "P63";

/// What the instances begin with that detect the power of a pulse form.
const PULSE: &str = "Pulse";

/// The first byte of the states, in bits, and the first word of the data registers.
const STATES: u32 = 1100 * 8;
const REGISTERS: u32 = 1000;
/// The first double word of the pairs of registers that begin with an odd number.
const ODD_PAIRS: u32 = 10_000;

/// What the result of a translation is written for: the document's target where it is of the same family. An FX list
/// can be `wanted` for another model.
pub(super) fn target(document: &Document, to: To, wanted: Option<Model>) -> &'static Target {
    let own = document.target();
    match (to, wanted.map(Target::of).filter(|wanted| wanted.is_fx())) {
        (To::Iec, _) => Target::of(Model::Iec),
        (To::Fx, Some(wanted)) => wanted,
        (To::Fx, None) if !own.is_fx() => Target::of(Model::Fx2n),
        _ => own,
    }
}

/// What a program is put into other words for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To be written; the whole of it, or a part.
    Text {
        /// Whether it is the whole.
        is_whole: bool,
    },
    /// To be compared with a program of the other family. What is doubtful is refused, and the relay of the first scan
    /// stays what it is.
    Proof,
}

/// Puts the rungs of `program`, which is `document` or a part of it, into the words of `target`. Those that have none
/// there are refused.
pub(super) fn convert(
    document: &Document,
    (to, target): (To, &'static Target),
    program: &mut Program,
    purpose: Purpose,
) {
    if to == To::Iec {
        end(&mut program.rungs);
    }
    if document.target().is_kin_of(target) {
        return;
    }
    let is_whole = purpose != Purpose::Text { is_whole: false };
    if target.is_fx() && is_whole {
        first_scan::take_relay(document, &mut program.rungs);
    }
    // What timers and counters do depends on all that is done with them.
    let whole = (!is_whole && program.rungs.iter().any(counts)).then(|| match document.target().is_fx() {
        true => source::deciding(document, &counted(&program.rungs)),
        false => source::program(document, None).rungs,
    });
    let all = whole.as_deref().unwrap_or(&program.rungs);
    let coils = Coils::of(all);
    let instances = Instances::of(document, all);
    let family = if target.is_fx() { target } else { document.target() };
    let presets = coils.declared();
    let pulses = Cell::new(0);
    let registers = match target.is_fx() {
        true => Registers::of_variables(document.scopes(), program, target),
        false => Registers::of_devices(document, program, is_whole),
    };
    let names = to_devices::Names::of(program, document.scopes(), target);
    let convert_path = |path: &Path, unit: Option<usize>| match target.is_fx() {
        false => to_variables::path(path, (document.target(), purpose), (&registers, &coils), &pulses),
        // What a function or a block does it does for whoever calls it.
        true if !is_of_program(document, unit) => {
            let unit = unit.and_then(|unit| document.scopes().pous.get(unit));
            Err(unit.map_or(Lack::Unnamed, |unit| Lack::Word(unit.name.clone())))
        }
        true => to_devices::path(path, target, (&names, &registers, &instances), (document.scopes(), unit)),
    };
    let initials = match is_whole {
        true => Initials::of(document, family, |path, unit| convert_path(path, unit).is_ok()),
        false => Initials::default(),
    };
    let doubts: FxHashMap<Span, Message> = doubts::all(document, all, family, (&instances, &initials))
        .into_iter()
        .zip(all)
        .filter_map(|(doubt, source)| Some((source.span(), doubt?)))
        .collect();
    if target.is_fx() {
        join_divisions(document, target, (&names, &registers, &instances), program);
    }
    initials.put_before(&mut program.rungs);
    let guards = guarded::all(&program.rungs);
    let mut open = Open::default();
    for (source, own) in program.rungs.iter_mut().zip(guards) {
        let guard = open.enter(source);
        source.doubt = doubts.get(&source.span()).cloned();
        if target.is_fx() {
            source.rung.labels.iter_mut().for_each(|label| *label = names.of_label(label));
        }
        // The words of the other language are no list in this one.
        source.rung.is_list = false;
        let converted = match (&source.rung.path, guard) {
            (Ok(None), _) => continue,
            (Err(_), _) => None,
            (Ok(Some(_)), Some(guard)) => Some(Err(guard)),
            (Ok(Some(_)), None) if purpose == Purpose::Proof && source.doubt.is_some() => {
                Some(Err(source.doubt.clone().unwrap_or_else(|| Lack::Unnamed.message())))
            }
            (Ok(Some(path)), None) => Some(convert_path(path, source.pou).map_err(|lack| lack.message())),
        };
        if let Some(converted) = converted {
            source.note = converted.as_ref().err().cloned();
            source.rung.path = converted.map(Some).map_err(|_| Refusal::NoCounterpart);
        }
        if source.rung.path.is_err() {
            open.set_up(own);
        }
    }
    if purpose == (Purpose::Text { is_whole: true }) && !target.is_fx() {
        first_scan::put_relay_before(&mut program.rungs);
    }
    program.presets = presets;
}

/// Keeps as they are the rungs that depend on one that was kept when it was `written`; gives whether there are any.
pub(super) fn keep_guarded(sources: &mut [Source], written: &[Translated]) -> bool {
    let mut has_more = false;
    let guards = guarded::all(sources);
    let mut open = Open::default();
    for ((source, own), written) in sources.iter_mut().zip(guards).zip(written) {
        let guard = open.enter(source);
        if let (Ok(Some(_)), Some(guard)) = (&source.rung.path, guard) {
            has_more |= !written.is_kept;
            source.note = Some(guard);
            source.rung.path = Err(Refusal::NoCounterpart);
        }
        if written.is_kept || source.rung.path.is_err() {
            open.set_up(own);
        }
    }
    has_more
}

/// Whether what lies at an address is kept while the PLC of a document of the FX family is off.
pub(super) fn is_kept(address: DirectAddress, document: &Document) -> bool {
    devices_at(address).any(|device| document.keeps(device))
}

/// Drops the END behind all other rungs, and makes a return of one before others.
fn end(sources: &mut [Source]) {
    let is_end = |source: &Source| source.path().is_some_and(to_variables::is_end);
    let does = |source: &Source| !matches!(source.rung.path, Ok(None)) && !is_end(source);
    let last = sources.iter().rposition(does).map_or(0, |last| last + 1);
    for (number, source) in sources.iter_mut().enumerate().filter(|(_, source)| is_end(source)) {
        let leaves = |span| Path::of_action(Action { deed: Deed::Return, terms: Vec::new(), span });
        source.rung.path = Ok((number < last).then(|| leaves(source.rung.span)));
    }
}

/// The timers and counters that rungs name.
fn counted(sources: &[Source]) -> Vec<Device> {
    let terms = sources.iter().filter_map(Source::path).flat_map(Path::terms);
    let mut devices: Vec<Device> = terms.filter_map(|term| term.operand.device()).collect();
    devices.retain(|device| device.kind.has_preset());
    devices.sort_unstable();
    devices.dedup();
    devices
}

/// Whether a rung has a timer, a counter or the instance of a block.
fn counts(source: &Source) -> bool {
    let Some(path) = source.path() else { return false };
    let is_counted = |term: &Term| term.operand.device().is_some_and(|device| device.kind.has_preset());
    path.terms().into_iter().any(is_counted)
        || path.actions().into_iter().any(|action| matches!(action.deed, Deed::Call(_)))
        || path.terms().into_iter().any(|term| term.operand == Operand::Variable && term.text.contains('.'))
}

/// Makes one rung of a quotient and a remainder that are two, each without a condition, where one instruction writes
/// both.
fn join_divisions(
    document: &Document,
    target: &Target,
    known: (&to_devices::Names, &Registers, &Instances),
    program: &mut Program,
) {
    for second in 1..program.rungs.len() {
        let [one, other] = [&program.rungs[second - 1], &program.rungs[second]];
        let is_apart = one.pou != other.pou || !Arc::ptr_eq(&one.chunk, &other.chunk);
        if is_apart || !is_of_program(document, one.pou) || !other.rung.labels.is_empty() {
            continue;
        }
        let (Some([first]), Some([next])) = (computed(one), computed(other)) else { continue };
        let place = (&**document.scopes(), one.pou);
        if !to_devices::is_division([first, next], target, known, place) {
            continue;
        }
        let (next, span) = (next.clone(), one.rung.span.to(other.rung.span));
        program.rungs[second].rung.path = Ok(None);
        let joined = &mut program.rungs[second - 1].rung;
        // If it is kept after all, it is kept with both.
        joined.span = span;
        if let Ok(Some(path)) = &mut joined.path {
            path.drives.push(next);
        }
    }
}

/// What a rung calculates, if that is all that it does and it has no condition.
fn computed(source: &Source) -> Option<&[Drive]> {
    let path = source.path().filter(|path| path.gates.is_empty())?;
    let computes = |drive: &Drive| matches!(drive, Drive::Action(Action { deed: Deed::Compute(_), .. }));
    path.drives.iter().all(computes).then_some(&path.drives[..])
}

/// Makes a rung of each calculation that has no condition, as a list of IEC 61131-3 has them.
pub(super) fn part_calculations(program: &mut Program) {
    let parted = program.rungs.drain(..).flat_map(|source| {
        let drives = computed(&source).map(<[Drive]>::to_vec).unwrap_or_default();
        if drives.len() < 2 {
            return vec![source];
        }
        let rung = |(number, drive): (usize, Drive)| {
            let mut part = source.clone();
            part.rung.path = Ok(Some(Path { gates: Vec::new(), drives: vec![drive] }));
            if number > 0 {
                part.rung.labels.clear();
            }
            part
        };
        drives.into_iter().enumerate().map(rung).collect()
    });
    program.rungs = parted.collect();
}

/// Takes out of a program of IEC 61131-3 the rungs that mean another thing than the same words would on a model of the
/// FX `family`: types decide how numbers compare and divide, declarations what there is at first. An F_TRIG becomes
/// what it is there, and so do values at first.
pub(super) fn refuse_others(document: &Document, family: &Target, sources: &mut Vec<Source>) {
    if document.target().is_fx() {
        return;
    }
    first_scan::take_relay(document, sources);
    let instances = Instances::of(document, sources);
    let is_written = |path: &Path, unit| to_devices::is_of_family(path, document.scopes(), unit);
    let initials = Initials::of(document, family, is_written);
    let doubts = doubts::all(document, sources, family, (&instances, &initials));
    for (source, doubt) in sources.iter_mut().zip(doubts) {
        let Ok(Some(path)) = &source.rung.path else { continue };
        let other = match to_devices::is_of_family(path, document.scopes(), source.pou) {
            true => doubt.map(Some).or_else(|| to_devices::counted(path, &instances).map(Some)),
            false => Some(None),
        };
        source.rung.path = match other {
            Some(note) => {
                source.note = note;
                Err(Refusal::NoCounterpart)
            }
            None => Ok(Some(to_devices::with_first_scan(path, &instances))),
        };
    }
    initials.put_before(sources);
}

/// Whether a rung belongs to a program, not to a function or a block.
fn is_of_program(document: &Document, pou: Option<usize>) -> bool {
    let pou = pou.and_then(|pou| document.scopes().pous.get(pou));
    pou.is_none_or(|pou| pou.kind == PouKind::Program)
}

/// The address of the variable that stands for a device, if it is located. The CPU's own relays and registers are not.
pub(super) fn address(device: Device) -> Option<DirectAddress> {
    if device.is_special() {
        return None;
    }
    let bit = |location: Location, number: u32| DirectAddress {
        location,
        width: Width::Bit,
        path: [Some(number / 8), Some(number % 8), None, None],
    };
    Some(match device.kind {
        DeviceKind::X => bit(Location::Input, device.number),
        DeviceKind::Y => bit(Location::Output, device.number),
        DeviceKind::M => bit(Location::Memory, device.number),
        DeviceKind::S => bit(Location::Memory, STATES + device.number),
        DeviceKind::D => DirectAddress {
            location: Location::Memory,
            width: Width::Word,
            path: [Some(REGISTERS + device.number), None, None, None],
        },
        _ => return None,
    })
}

/// What people call the device for which a variable stands whose key is `key`: `X0` for `%IX0.0`, `TS0` for `t0.q`, the
/// contact of a timer, `D0:32` for the double word over two registers.
pub fn device_called(key: &str) -> Option<String> {
    if let Operand::Direct(address) = Operand::read(key, Model::Iec) {
        let pair = || pair_at(address).map(|first| format!("{first}:32"));
        return device_at(address).map(|device| device.to_string()).or_else(pair);
    }
    let (instance, output) = key.split_once('.')?;
    let Operand::Device(device) = Operand::read(instance, Model::Fx3u) else { return None };
    let letter = device.kind.letter();
    match output {
        "q" if device.kind.has_preset() => Some(format!("{letter}S{}", device.number)),
        "cv" if device.kind == DeviceKind::C => Some(device.to_string()),
        _ => None,
    }
}

/// What people call the variable that stands for the device which they call `name`, if nothing else has that name: the
/// way back from [`device_called`].
pub fn variable_called(name: &str) -> Option<String> {
    if let Some(first) = name.strip_suffix(":32") {
        let Operand::Device(device) = Operand::read(first, Model::Fx3u) else { return None };
        return pair_address(device).map(|address| address.to_string());
    }
    if let Operand::Device(device) = Operand::read(name, Model::Fx3u) {
        let value = || (device.kind == DeviceKind::C).then(|| format!("{device}.CV"));
        return address(device).map(|address| address.to_string()).or_else(value);
    }
    let timer = |letter: &str| Some(format!("{letter}{}.Q", name.strip_prefix(letter)?.strip_prefix('S')?));
    timer("T").or_else(|| timer("C"))
}

/// The address of the variable that stands for a data register and the next one as 32 bits.
fn pair_address(first: Device) -> Option<DirectAddress> {
    if first.kind != DeviceKind::D || Device::new(first.kind, first.number + 1).is_special() {
        return None;
    }
    let word = REGISTERS + first.number;
    let place = if word.is_multiple_of(2) { word / 2 } else { ODD_PAIRS + first.number };
    let path = [Some(place), None, None, None];
    Some(DirectAddress { location: Location::Memory, width: Width::Double, path })
}

/// The first register of the pair at an address: the way back from [`pair_address`].
fn pair_at(address: DirectAddress) -> Option<Device> {
    let [Some(place), None, None, None] = address.path else { return None };
    let number = match place.checked_sub(ODD_PAIRS) {
        Some(number) => number,
        None => place.checked_mul(2)?.checked_sub(REGISTERS)?,
    };
    let first = Device::new(DeviceKind::D, number);
    (pair_address(first) == Some(address)).then_some(first)
}

/// The devices at an address.
fn devices_at(address: DirectAddress) -> impl Iterator<Item = Device> {
    let pair = pair_at(address).map(|first| [first, Device::new(first.kind, first.number + 1)]);
    device_at(address).into_iter().chain(pair.into_iter().flatten())
}

/// The device at an address: the way back from [`address`].
pub(super) fn device_at(address: DirectAddress) -> Option<Device> {
    let device = match (address.width, address.path) {
        (Width::Bit, [Some(byte), Some(bit), None, None]) if bit < 8 => {
            let number = byte.checked_mul(8)?.checked_add(bit)?;
            match address.location {
                Location::Input => Device::new(DeviceKind::X, number),
                Location::Output => Device::new(DeviceKind::Y, number),
                Location::Memory if number >= STATES => Device::new(DeviceKind::S, number - STATES),
                Location::Memory => Device::new(DeviceKind::M, number),
            }
        }
        (Width::Word, [Some(word), None, None, None]) if address.location == Location::Memory => {
            Device::new(DeviceKind::D, word.checked_sub(REGISTERS)?)
        }
        _ => return None,
    };
    (self::address(device) == Some(address)).then_some(device)
}
