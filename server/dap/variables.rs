//! What the program uses, in groups that people can open.

use super::debuggee::Debuggee;
use super::program::{File, Program};
use crate::document::Symbol;
use crate::simulate::{Code, HandedOver, Member, Touch, UnitVariables, Variable, joined};
use crate::target::{Device, DeviceKind, Operand};
use crate::text::{Language, Message};
use serde_json::{Value as Json, json};
use std::collections::BTreeSet;

/// The groups of a program, and what is in them.
#[derive(Default)]
pub(super) struct Variables {
    groups: Vec<Group>,
    /// What has parts of its own: timers and counters, instances, arrays.
    nodes: Vec<Node>,
}

struct Group {
    title: Message,
    /// What names begin with that are in it; empty for devices and global variables.
    owner: String,
    names: Vec<String>,
    /// Of what is handed over to the body of a unit which body that is, and what the names are called there.
    handed: Option<(usize, Vec<String>)>,
}

/// A variable with parts, by whole names.
struct Node {
    name: String,
    parts: Vec<String>,
}

/// The numbers by which the protocol names groups begin here.
const FIRST_GROUP: i64 = 1;
/// And those of variables with parts here.
const FIRST_NODE: i64 = 1 << 20;
/// So many parts are told of where their variable is shown.
const TOLD_PARTS: usize = 4;

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
        match program.code.target.is_fx() {
            true => Variables::of_devices(program),
            false => {
                let mut variables = Variables::of_units(program.code.variables_by_unit());
                variables.groups.extend(program.code.handed_over().into_iter().map(Group::handed_over));
                variables
            }
        }
    }

    fn of_devices(program: &Program) -> Variables {
        let code = &program.code;
        let named: Vec<Device> = code.named().iter().filter_map(|name| device_of(name, code)).collect();
        let group = |title, names: Vec<String>| Group {
            title: Message::new(title),
            owner: String::new(),
            names,
            handed: None,
        };
        let mut groups = Vec::new();
        for (kinds, title) in KINDS {
            let own = named.iter().filter(|device| kinds.contains(&device.kind));
            groups.push(group(title, own.map(|device| device.to_string()).collect()));
        }
        let special = special(program).into_iter().filter(|device| code.layout.has(*device));
        groups.push(group("debug.special", special.map(|device| device.to_string()).collect()));
        groups.retain(|group| !group.names.is_empty());
        let counting = named.iter().filter(|device| device.kind.has_preset());
        let nodes = counting.map(|device| Node { name: device.to_string(), parts: parts(*device) }).collect();
        Variables { groups, nodes }
    }

    fn of_units(units: Vec<UnitVariables>) -> Variables {
        let mut variables = Variables::default();
        for UnitVariables { name: owner, members } in units {
            let title = match owner.is_empty() {
                true => Message::new("debug.variables"),
                false => Message::new("debug.variables-of").with("unit", &owner),
            };
            let names = variables.add(&owner, &members);
            variables.groups.push(Group { title, owner, names, handed: None });
        }
        variables
    }

    /// Adds what is in a variable; gives the names of that.
    fn add(&mut self, around: &str, members: &[Member]) -> Vec<String> {
        let mut names = Vec::new();
        for member in members {
            let name = joined(around, &member.name);
            if !member.members.is_empty() {
                let parts = self.add(&name, &member.members);
                self.nodes.push(Node { name: name.clone(), parts });
            }
            names.push(name);
        }
        names
    }

    /// The groups, as the protocol wants them; those of the unit `owner` come first, with what is handed over to its
    /// body number `body`.
    pub(super) fn scopes(&self, owner: Option<&str>, body: Option<usize>, language: Language) -> Vec<Json> {
        let scope = |number: i64, title: String, count: usize| {
            json!({
                "name": title, "variablesReference": number, "namedVariables": count, "expensive": false,
            })
        };
        let mut scopes: Vec<Json> = Vec::new();
        let mut own = 0;
        if let Some((number, node)) = owner.and_then(|owner| self.node(owner)) {
            let title = Message::new("debug.variables-of").with("unit", &node.name).render(language);
            scopes.push(scope(number, title, node.parts.len()));
            own = 1;
        }
        for (number, group) in (FIRST_GROUP..).zip(&self.groups) {
            let shown = scope(number, group.title.render(language), group.names.len());
            let is_own = match &group.handed {
                Some((of, _)) if Some(*of) == body => true,
                Some(_) => continue,
                None => owner == Some(group.owner.as_str()),
            };
            scopes.insert(if is_own { own } else { scopes.len() }, shown);
        }
        scopes
    }

    /// What a name is called in a group or in a variable with parts.
    fn called<'n>(&'n self, reference: i64, name: &'n str) -> &'n str {
        let group = reference
            .checked_sub(FIRST_GROUP)
            .and_then(|number| self.groups.get(usize::try_from(number).ok()?));
        if let Some(Group { names, handed: Some((_, called)), .. }) = group
            && let Some(at) = names.iter().position(|own| own == name)
        {
            return &called[at];
        }
        label(name, self.inside(reference).map_or("", |(around, _)| around))
    }

    fn node(&self, name: &str) -> Option<(i64, &Node)> {
        let mut nodes = (FIRST_NODE..).zip(&self.nodes);
        nodes.find(|(_, node)| node.name.eq_ignore_ascii_case(name))
    }

    /// What is in a group or in a variable with parts: its name, and whole names.
    fn inside(&self, reference: i64) -> Option<(&str, &[String])> {
        let at = |first: i64| reference.checked_sub(first).and_then(|number| usize::try_from(number).ok());
        if let Some(node) = at(FIRST_NODE).and_then(|number| self.nodes.get(number)) {
            return Some((&node.name, &node.parts));
        }
        let group = at(FIRST_GROUP).and_then(|number| self.groups.get(number))?;
        Some((&group.owner, &group.names))
    }

    /// The whole names in a group, or of the parts of a variable.
    pub(super) fn names(&self, reference: i64) -> &[String] {
        self.inside(reference).map_or(&[], |(_, names)| names)
    }

    /// The whole name of what a group or variable shows as `name`.
    pub(super) fn whole(&self, reference: i64, name: &str) -> String {
        let own = self.names(reference).iter().find(|own| self.called(reference, own) == name);
        own.map_or(name, |own| own).to_string()
    }

    /// All names that can be asked for.
    pub(super) fn all(&self) -> impl Iterator<Item = &String> {
        let parts = self.nodes.iter().flat_map(|node| &node.parts);
        self.groups.iter().flat_map(|group| &group.names).chain(parts)
    }

    /// A variable as the protocol wants it, in what has the number `reference` or by itself.
    pub(super) fn shown(
        &self,
        reference: Option<i64>,
        name: &str,
        debuggee: &Debuggee,
        program: &Program,
        language: Language,
    ) -> Option<Json> {
        let node = self.node(name);
        let variable = debuggee.code().variable(name);
        let value = match (variable, node) {
            (Some(variable), _) => value_of(variable, debuggee, language),
            (None, Some((_, node))) => self.told(node, debuggee, language),
            (None, None) => return None,
        };
        Some(json!({
            "name": reference.map_or(name, |reference| self.called(reference, name)),
            "evaluateName": name,
            "value": value,
            "type": variable.map(|variable| meaning(name, variable, program, language)),
            "variablesReference": node.map_or(0, |(number, _)| number),
        }))
    }

    /// The first parts of a variable with their values.
    fn told(&self, node: &Node, debuggee: &Debuggee, language: Language) -> String {
        let told = |part: &String| {
            let variable = debuggee.code().variable(part)?;
            Some(format!("{} {}", label(part, &node.name), value_of(variable, debuggee, language)))
        };
        let first: Vec<String> = node.parts.iter().filter_map(told).take(TOLD_PARTS).collect();
        let rest = if node.parts.len() > first.len() { ", …" } else { "" };
        if first.is_empty() { "…".to_string() } else { first.join(", ") + rest }
    }
}

impl Group {
    fn handed_over(HandedOver { scope, owner, names }: HandedOver) -> Group {
        let title = Message::new("debug.handed-over").with("unit", owner);
        let (called, names) = names.into_iter().map(|(called, name)| (called.to_string(), name)).unzip();
        Group { title, owner: String::new(), names, handed: Some((scope, called)) }
    }
}

/// How a part is called in what is around it.
fn label<'n>(name: &'n str, around: &str) -> &'n str {
    match name.strip_prefix(around) {
        Some(rest) if rest.starts_with(['.', '[']) => rest.trim_start_matches('.'),
        _ => name,
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
    let arriving = debuggee.arriving().filter_map(|touch| match touch {
        Touch::Write(own, next) | Touch::Hold(own, next) if *own == variable => Some(next),
        _ => None,
    });
    match arriving.last() {
        Some(next) => Message::new("debug.arriving").with("value", value).with("next", next).render(language),
        None => value.to_string(),
    }
}

/// What a variable is, and what the project says about it.
fn meaning(name: &str, variable: Variable, program: &Program, language: Language) -> String {
    let kind = match (variable, variable.declared()) {
        (_, Some(declared)) => declared.to_string(),
        (Variable::Relay(_), _) if !program.code.target.is_fx() => "BOOL".to_string(),
        (Variable::Relay(_), _) => Message::new("debug.bit").render(language),
        _ => Message::new("debug.word").render(language),
    };
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
