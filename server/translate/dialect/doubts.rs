//! What a rung names that is not the same in the other language though its words are: a variable that is on at first,
//! one that is kept while the PLC is off where the device is not, a timer that a jump may leave out.

use super::counted::{Instances, declares_preset};
use super::first_scan::Initials;
use super::{devices_at, guarded};
use crate::document::{Document, Scopes, Variable};
use crate::il::iec::{PouKind, SectionKind};
use crate::logic::{Action, Deed, Path, Term};
use crate::target::{Device, DeviceKind, Latches, Operand, Target};
use crate::text::{Message, folded};
use crate::translate::{Source, declared};
use smol_str::SmolStr;

/// For each rung why it is doubtful whether it does the same in the other language; nothing where it is not. The
/// devices are those of `family`, `instances` those of a program of IEC 61131-3, and `initials` the variables there
/// that a rung gives their values.
pub(super) fn all(
    document: &Document,
    sources: &[Source],
    family: &Target,
    (instances, initials): (&Instances, &Initials),
) -> Vec<Option<Message>> {
    let plc = Plc { family, latches: document.comments().latches() };
    let doubts = sources.iter().zip(guarded::are(sources)).map(|(source, is_guarded)| {
        let path = source.path()?;
        match document.target().is_fx() {
            true => of_devices(path, plc, is_guarded),
            false => of_variables(path, (document.scopes(), source.pou), plc, (instances, initials)),
        }
    });
    let mut doubts: Vec<Option<Message>> = doubts.collect();
    // What no rung names may be seen from outside.
    if let Some(first) = sources.iter().position(|source| source.path().is_some())
        && doubts[first].is_none()
    {
        doubts[first] = configuration(document).or_else(|| first_value(document.scopes(), family, initials));
    }
    doubts
}

/// The PLC of the FX family that a program is for, or becomes one for.
#[derive(Clone, Copy)]
struct Plc<'a> {
    family: &'a Target,
    latches: &'a Latches,
}

impl Plc<'_> {
    /// Whether it keeps a device while it is off.
    fn keeps(self, device: Device) -> bool {
        self.latches.keep(device, self.family)
    }
}

/// What decides when, how often and with what the programs of IEC 61131-3 run. An FX list runs in each scan, from its
/// beginning to its end.
fn configuration(document: &Document) -> Option<Message> {
    let scopes = document.scopes();
    let programs = scopes.own_pous().iter().filter(|pou| pou.kind == PouKind::Program).count();
    if programs > 1 {
        return Some(doubt("translate.configuration", "PROGRAM"));
    }
    declared::configurations(document).iter().find_map(|words| {
        let words: Vec<&str> = words.split(' ').collect();
        let deciding = ["single", "retain"].into_iter().find(|word| words.contains(word));
        let runs: Vec<usize> = (0..words.len()).filter(|at| words[*at] == "program").collect();
        // What its inputs and outputs are connected to stands behind its type.
        let is_connected =
            |at: &usize| words[*at..].iter().take_while(|word| **word != ";").any(|word| *word == "(");
        let is_plain = runs.len() == 1 && !runs.iter().any(is_connected);
        let word = deciding.map(str::to_uppercase).or((!is_plain).then(|| "PROGRAM".into()))?;
        Some(doubt("translate.configuration", word))
    })
}

/// The first variable of a program, or known to all, that is a device and has a value at first.
fn first_value(scopes: &Scopes, family: &Target, initials: &Initials) -> Option<Message> {
    let units = scopes.own_pous().iter().enumerate();
    let programs = units.filter(|(_, pou)| pou.kind == PouKind::Program);
    let own = programs.flat_map(|(unit, pou)| pou.variables.iter().map(move |own| (Some(unit), own)));
    let mut variables = own.chain(scopes.globals.values().map(|global| (None, global)));
    let is_doubtful = |(unit, variable): &(Option<usize>, &Variable)| {
        is_doubtful(variable, scopes, (*unit, initials)) && !devices(variable, family).is_empty()
    };
    variables.find(is_doubtful).map(|(_, variable)| doubt("translate.initial", &variable.name))
}

fn doubt(key: &'static str, word: impl AsRef<str>) -> Message {
    Message::new(key).with("word", word.as_ref())
}

/// What the devices of a rung make doubtful.
fn of_devices(path: &Path, plc: Plc<'_>, is_guarded: bool) -> Option<Message> {
    let timed = |action: &&Action| matches!((&action.deed, &action.terms[..]), (Deed::Coil(_), [_, _]));
    let timers =
        path.actions().into_iter().filter(timed).filter_map(|action| action.terms[0].operand.device());
    let mut left_out = timers.filter(|device| is_guarded && device.kind == DeviceKind::T);
    let jumped = left_out.next().map(|timer| doubt("translate.jumped-timer", timer.to_string()));
    let devices = || path.terms().into_iter().filter_map(|term| term.operand.device());
    jumped.or_else(|| devices().find_map(|device| latched_counter(device, plc)))
}

/// What a latched counter remembers of its input while the PLC is off, nobody says alike.
fn latched_counter(device: Device, plc: Plc<'_>) -> Option<Message> {
    let is_latched = device.kind == DeviceKind::C && plc.keeps(device);
    is_latched.then(|| doubt("translate.latched-counter", device.to_string()))
}

/// What the declarations of the variables of a rung make doubtful.
fn of_variables(
    path: &Path,
    (scopes, unit): (&Scopes, Option<usize>),
    plc: Plc<'_>,
    (instances, initials): (&Instances, &Initials),
) -> Option<Message> {
    let called = path.actions().into_iter().find_map(|action| match (&action.deed, action.terms.first()) {
        (Deed::Call(call), Some(instance)) => {
            let is_left_out = call.block.is_standard("TON") && instances.may_be_left_out(&instance.text);
            is_left_out.then(|| doubt("translate.jumped-timer", &instance.text))
        }
        _ => None,
    });
    called.or_else(|| {
        path.terms().into_iter().find_map(|term| of_variable(term, scopes, (unit, initials), plc))
    })
}

fn of_variable(
    term: &Term,
    scopes: &Scopes,
    (unit, initials): (Option<usize>, &Initials),
    plc: Plc<'_>,
) -> Option<Message> {
    if term.operand != Operand::Variable {
        return None;
    }
    let name = &term.text[..term.text.find(['.', '[', '^']).unwrap_or(term.text.len())];
    let mut variable = scopes.variable(unit, name)?;
    if variable.section == SectionKind::External {
        variable = scopes.variable(None, name).unwrap_or(variable);
    }
    if variable.section == SectionKind::Temporary {
        return Some(doubt("translate.temporary", name));
    }
    if is_doubtful(variable, scopes, (unit, initials)) {
        return Some(doubt("translate.initial", name));
    }
    let devices = devices(variable, plc.family);
    // Inputs are read anew in each scan.
    let mut kept = devices.iter().filter(|device| device.kind != DeviceKind::X);
    let is_kept = variable.is_retained();
    if let Some(device) = kept.find(|device| plc.keeps(**device) != is_kept) {
        let key = if is_kept { "translate.retained" } else { "translate.not-retained" };
        return Some(doubt(key, name).with("device", device.to_string()));
    }
    if is_kept && devices.is_empty() {
        return Some(doubt("translate.retained-alone", name));
    }
    devices.into_iter().find_map(|device| latched_counter(device, plc))
}

/// Whether a variable has a value at first that nothing gives it in the other language.
fn is_doubtful(variable: &Variable, scopes: &Scopes, (unit, initials): (Option<usize>, &Initials)) -> bool {
    has_value(variable, scopes) && !declares_preset(variable) && !initials.have(scopes, unit, &variable.name)
}

/// The devices that a variable stands for.
pub(super) fn devices(variable: &Variable, family: &Target) -> Vec<Device> {
    match variable.address {
        Some(address) => devices_at(address).collect(),
        None => match Operand::read(&variable.name, family.model) {
            Operand::Device(device) => vec![device],
            _ => Vec::new(),
        },
    }
}

/// Whether a variable is something else than off or 0 at first, by its declaration, its type or VAR_CONFIG.
pub(super) fn has_value(variable: &Variable, scopes: &Scopes) -> bool {
    let says =
        |words: &str| words.split_once(":=").is_some_and(|(_, value)| !matches!(value.trim(), "false" | "0"));
    let name = folded(&variable.name);
    let is_it = |path: &str| path.rsplit(' ').next() == Some(&name);
    if says(&variable.words) || scopes.configured.iter().any(|(path, words)| is_it(path) && says(words)) {
        return true;
    }
    let mut waiting: Vec<SmolStr> = vec![variable.words.clone()];
    let mut seen: Vec<SmolStr> = Vec::new();
    while let Some(words) = waiting.pop() {
        for word in words.split(' ').filter_map(|word| scopes.type_words.get(word)) {
            if says(word) {
                return true;
            }
            if !seen.contains(word) {
                seen.push(word.clone());
                waiting.push(word.clone());
            }
        }
    }
    false
}
