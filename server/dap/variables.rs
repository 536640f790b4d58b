//! What the program uses, in groups that people can open.

use super::debuggee::Debuggee;
use super::program::{File, Program};
use crate::document::Symbol;
use crate::simulate::{Code, Touch, Value, Variable};
use crate::target::{Device, DeviceKind, Operand};
use crate::text::{Language, Message};
use serde_json::{Value as Json, json};
use std::collections::BTreeSet;

/// The groups of a program, and what is in them.
#[derive(Default)]
pub(super) struct Variables {
    groups: Vec<Group>,
    /// Timers and counters, of which each is a group of its own.
    parts: Vec<Device>,
}

struct Group {
    title: Message,
    names: Vec<String>,
}

/// The numbers by which the protocol names groups begin here.
const FIRST_GROUP: i64 = 1;
/// And those of timers and counters here.
const FIRST_PART: i64 = 1 << 20;

/// The kinds of devices in the order in which they are shown, with the titles of their groups.
const KINDS: [(&[DeviceKind], &str); 7] = [
    (&[DeviceKind::X], "debug.inputs"),
    (&[DeviceKind::Y], "debug.outputs"),
    (&[DeviceKind::M], "debug.relays"),
    (&[DeviceKind::S], "debug.states"),
    (&[DeviceKind::T], "debug.timers"),
    (&[DeviceKind::C], "debug.counters"),
    (&[DeviceKind::D, DeviceKind::R, DeviceKind::V, DeviceKind::Z], "debug.registers"),
];

impl Variables {
    /// What a program uses.
    pub(super) fn of(program: &Program) -> Variables {
        let code = &program.code;
        let mut named = Vec::new();
        for name in code.named() {
            let device = device_of(&name, code);
            named.push((name, device));
        }
        let mut groups = Vec::new();
        for (kinds, title) in KINDS {
            let own =
                named.iter().filter_map(|(_, device)| device.filter(|device| kinds.contains(&device.kind)));
            let names: Vec<String> = own.map(|device| device.to_string()).collect();
            groups.push(Group { title: Message::new(title), names });
        }
        let special = special(program).into_iter().filter(|device| code.layout.has(*device));
        let names = special.map(|device| device.to_string()).collect();
        groups.push(Group { title: Message::new("debug.special"), names });
        // Variables by the program unit that declares them.
        for (name, _) in named.iter().filter(|(_, device)| device.is_none()) {
            let title = match name.split_once('.') {
                Some((unit, _)) => Message::new("debug.variables-of").with("unit", unit),
                None => Message::new("debug.variables"),
            };
            match groups.iter_mut().find(|group| group.title == title) {
                Some(group) => group.names.push(name.clone()),
                None => groups.push(Group { title, names: vec![name.clone()] }),
            }
        }
        groups.retain(|group| !group.names.is_empty());
        let parts = named.iter().filter_map(|(_, device)| device.filter(|device| device.kind.has_preset()));
        Variables { parts: parts.collect(), groups }
    }

    /// The groups, as the protocol wants them.
    pub(super) fn scopes(&self, language: Language) -> Vec<Json> {
        let scope = |(number, group): (i64, &Group)| {
            json!({
                "name": group.title.render(language),
                "variablesReference": number,
                "namedVariables": group.names.len(),
                "expensive": false,
            })
        };
        (FIRST_GROUP..).zip(&self.groups).map(scope).collect()
    }

    /// The names in a group, or of the parts of a timer or counter.
    pub(super) fn names(&self, reference: i64) -> Vec<String> {
        if let Some(number) = reference.checked_sub(FIRST_PART).filter(|number| *number >= 0) {
            let part = self.parts.get(number as usize);
            return part.map(|part| parts(*part)).unwrap_or_default();
        }
        let number = reference.checked_sub(FIRST_GROUP).and_then(|number| usize::try_from(number).ok());
        number.and_then(|number| self.groups.get(number)).map(|group| group.names.clone()).unwrap_or_default()
    }

    /// All names that can be asked for.
    pub(super) fn all(&self) -> impl Iterator<Item = &String> {
        self.groups.iter().flat_map(|group| &group.names)
    }

    /// A variable as the protocol wants it.
    pub(super) fn shown(
        &self,
        name: &str,
        debuggee: &Debuggee,
        program: &Program,
        language: Language,
    ) -> Option<Json> {
        let code = debuggee.code();
        let variable = code.variable(name)?;
        let part = self.parts.iter().position(|part| part.to_string() == name);
        let reference = part.map_or(0, |number| FIRST_PART + number as i64);
        Some(json!({
            "name": name,
            "evaluateName": name,
            "value": value_of(variable, debuggee, language),
            "type": meaning(name, variable, program, language),
            "variablesReference": reference,
        }))
    }
}

/// The contact, the coil and the current value.
fn parts(device: Device) -> Vec<String> {
    ["S", "C", "N"].map(|part| format!("{}{part}{}", device.kind.letter(), device.number)).to_vec()
}

/// The device that a name of [`Code::named`] means.
fn device_of(name: &str, code: &Code) -> Option<Device> {
    let read = |name: &str| match Operand::read(name, code.target.model) {
        Operand::Device(device) => Some(device),
        _ => None,
    };
    let contact = || {
        let number = name.strip_prefix("TS").map(|number| format!("T{number}"));
        read(&number.or_else(|| name.strip_prefix("CS").map(|number| format!("C{number}")))?)
    };
    code.target.is_fx().then(|| read(name).or_else(contact)).flatten()
}

fn special(program: &Program) -> BTreeSet<Device> {
    let mut special = BTreeSet::new();
    for file in &program.files {
        for at in file.document.chunks() {
            special.extend(at.chunk.mentions().iter().filter_map(|mention| match mention.symbol {
                Symbol::Device(device) if device.is_special() => Some(device),
                _ => None,
            }));
        }
    }
    special
}

/// A value with what people must know of it: that it is forced, or what arrives before the next scan.
pub(super) fn value_of(variable: Variable, debuggee: &Debuggee, language: Language) -> String {
    let machine = debuggee.machine();
    let value = match debuggee.here() {
        Some(_) => machine.value_inside(variable, 0),
        None => machine.value(variable, 0),
    };
    if machine.is_forced(variable) {
        return Message::new("debug.forced").with("value", value).render(language);
    }
    let device = variable.release(debuggee.code());
    let arriving = debuggee.arriving().filter_map(|touch| match touch {
        Touch::Set(own, on) | Touch::Force(own, on) => Some((own, Value::Bit(on))),
        Touch::SetWord(own, number) | Touch::ForceWord(own, number) => Some((own, Value::Number(number))),
        _ => None,
    });
    match arriving.filter(|(own, _)| Some(Touch::Release(*own)) == device).last() {
        Some((_, next)) => {
            Message::new("debug.arriving").with("value", value).with("next", next).render(language)
        }
        None => value.to_string(),
    }
}

/// What a variable is, and what the project says about it.
fn meaning(name: &str, variable: Variable, program: &Program, language: Language) -> String {
    let kind = Message::new(match variable {
        Variable::Relay(_) => "debug.bit",
        _ => "debug.word",
    });
    let kind = kind.render(language);
    match comment_of(name, program) {
        Some(comment) => format!("{kind} · {comment}"),
        None => kind,
    }
}

/// What the project says about a device.
pub(super) fn comment_of(name: &str, program: &Program) -> Option<String> {
    let device = device_of(name, &program.code)?;
    let own = |file: &File| {
        let row = file.document.comments().of_device(device)?;
        let words = [row.symbol.as_str(), row.comment.as_str()];
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        (!words.is_empty()).then(|| words.join(": "))
    };
    program.files.iter().find_map(own)
}
