//! # read-never-written
//!
//! A relay, an output, a timer, a counter or a register is read, but nothing in the program ever writes it. Its contact
//! never changes, its value is always 0. A number that is wrong by one looks like that, and so does a rung that was
//! deleted although others still need it.
//!
//! What may be written from elsewhere is left out: inputs, special and latched devices, addresses in memory, and
//! variables with an initial value. Where most relays or registers of a program are never written, a panel does it, and
//! nothing is reported. A single relay that a panel writes looks like a mistake all the same; write
//! `// rungwise: allow(read-never-written)` above the rung.
//!
//! ```fx
//! LD M20
//!    ^^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT M20
//! LD M20
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  T5        Y0  |
//!    ^^
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! |  X0     T5 K50 |
//! +--| |-------( )-+
//! |                |
//! |  T5        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Motor AT %QX0.0 : BOOL;
//!     Ready : BOOL;
//! END_VAR
//!     LD Ready
//!        ^^^^^
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Ready : BOOL;
//! END_VAR
//!     LD Start
//!     ST Ready
//!     LD Ready
//!     ST Motor
//! END_PROGRAM
//! ```

use super::free::renamed;
use super::relays::{Wiring, is_general};
use super::rungs::MOST_MENDED;
use super::uses::{Key, Name, Use, Uses};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{Act, Part};
use crate::target::iec::nearest;
use crate::target::{Device, DeviceKind};
use crate::text::{Diagnostic, Message, Severity, TextEdit};
use rustc_hash::FxHashMap;

pub(super) const RULE: Rule = Rule {
    code: "read-never-written",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("read_never_written.rs"),
};

/// So many relays or registers of a kind that nothing writes, and as many as the others, are a panel's.
const MANY: usize = 3;

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    let mut unwritten: Vec<(Option<DeviceKind>, Diagnostic)> = Vec::new();
    let mut written: FxHashMap<DeviceKind, usize> = FxHashMap::default();
    let wiring = Wiring::of(context);
    let is_own = |name: &Name<'_>| may_only_the_program_write(context, &wiring, name);
    for (number, name) in uses.names().filter(|(_, name)| is_own(name)) {
        if !uses.acts(number).has(&[Act::Read, Act::ReadOff, Act::ReadEdge]) {
            continue;
        }
        let Some(read) = uses.of_name(number).find(is_read) else { continue };
        let kind = match name.key {
            Key::Device(device) => Some(device.kind),
            _ => None,
        };
        if is_written(uses, number, name, &read) {
            kind.into_iter().for_each(|kind| *written.entry(kind).or_default() += 1);
            continue;
        }
        let message = Message::new(match kind {
            Some(kind) if kind.has_preset() => "read-never-written.undriven",
            _ => "read-never-written.found",
        });
        let message = message.with("name", uses.words(&read));
        let diagnostic = Diagnostic::new(RULE.code, read.span, message);
        let meant = (unwritten.len() < MOST_MENDED).then(|| meant(context, number, name)).flatten();
        let diagnostic = match meant.and_then(|meant| replaced(uses, number, name, meant)) {
            Some((title, edits)) => diagnostic.fix(title.with("name", uses.words(&read)), edits),
            None => diagnostic,
        };
        unwritten.push((kind, diagnostic));
    }
    // Where most relays or registers are never written, something outside of the program does it.
    let is_panels = |kind: &Option<DeviceKind>| {
        let count = unwritten.iter().filter(|(other, _)| other == kind).count();
        let relay = kind.filter(|kind| matches!(kind, DeviceKind::M | DeviceKind::D));
        relay.is_some_and(|kind| count >= MANY && count >= written.get(&kind).copied().unwrap_or(0))
    };
    let panels = [DeviceKind::M, DeviceKind::D].map(|kind| (Some(kind), is_panels(&Some(kind))));
    let is_mistake = |kind: Option<DeviceKind>| !panels.contains(&(kind, true));
    found.extend(unwritten.into_iter().filter(|(kind, _)| is_mistake(*kind)).map(|(_, found)| found));
}

fn is_read(one: &Use) -> bool {
    let reads = matches!(one.access.act, Act::Read | Act::ReadOff | Act::ReadEdge);
    reads && (one.access.part == Part::Pair || one.access.count == 1)
}

fn is_written(uses: &Uses<'_>, number: u32, name: &Name<'_>, read: &Use) -> bool {
    let acts = uses.acts(number);
    if acts.writes_but(&[]) || acts.has(&[Act::DeclareValue]) {
        return true;
    }
    let Key::Device(device) = name.key else { return false };
    let second = Device::new(device.kind, device.number.saturating_add(1));
    // Half of a pair may be written on its own.
    let half = || uses.device(second).is_some_and(|other| uses.acts(other).writes_but(&[]));
    uses.is_written_in_row(device) || (read.access.part == Part::Pair && half())
}

fn may_only_the_program_write(context: &ProgramContext<'_>, wiring: &Wiring, name: &Name<'_>) -> bool {
    match name.key {
        Key::Device(device) => match device.kind {
            DeviceKind::Y | DeviceKind::T | DeviceKind::C | DeviceKind::V | DeviceKind::Z => {
                device.range_on(context.target()).is_some()
            }
            DeviceKind::M | DeviceKind::D => is_general(device, context),
            _ => false,
        },
        _ => wiring.is_inside(name) && name.variable.is_some_and(|variable| !variable.constant),
    }
}

/// What is written and was meant most likely: what nothing reads before what is read, and of these the next in number;
/// of variables one of the same unit and type with nearly the same name.
fn meant(context: &ProgramContext<'_>, number: u32, name: &Name<'_>) -> Option<u32> {
    let uses = context.uses();
    let is_written = |other: u32| other != number && uses.acts(other).writes_but(&[]);
    match name.key {
        Key::Device(device) => {
            let rank = |(other, one): (u32, &Name<'_>)| {
                let Key::Device(found) = one.key else { return None };
                let (acts, distance) = (uses.acts(other), found.number.abs_diff(device.number));
                // Outputs are for the machine, and need no reader.
                let is_idle = device.kind != DeviceKind::Y && !acts.reads();
                let near = if is_idle { NEAR_IDLE } else { 1 };
                let fits = found.kind == device.kind && is_written(other) && distance <= near;
                (fits && found.range_on(context.target()).is_some()).then_some((!is_idle, distance, other))
            };
            uses.names().filter_map(rank).min().map(|(_, _, other)| other)
        }
        Key::Local(file, unit, _) => {
            let own = name.variable?;
            let is_like = |one: &Name<'_>| {
                matches!(one.key, Key::Local(f, u, _) if (f, u) == (file, unit))
                    && one.variable.is_some_and(|variable| variable.declared == own.declared)
            };
            let alike = || uses.names().filter(|(other, one)| is_written(*other) && is_like(one));
            let names = alike().filter_map(|(_, one)| Some(one.variable?.name.as_str()));
            let near = nearest(&own.name, names).into_iter().next()?;
            let mut found = alike().filter(|(_, one)| one.variable.is_some_and(|own| own.name == near));
            found.next().map(|(other, _)| other)
        }
        _ => None,
    }
}

/// A relay or register that is written and read nowhere may be meant from so far away.
const NEAR_IDLE: u32 = 16;
/// What is read in more places is replaced by hand.
const MOST_PLACES: usize = 100;

/// Reads the name with the number `meant` in all places instead.
fn replaced(uses: &Uses<'_>, number: u32, name: &Name<'_>, meant: u32) -> Option<(Message, Vec<TextEdit>)> {
    let written = uses.of_name(meant).find(|one| one.access.act.writes())?;
    let edit = |one: &Use| match (name.key, uses.name(meant)?.key) {
        (Key::Device(device), Key::Device(other)) => renamed(uses, one, device, other),
        _ => uses.is_list(one).then(|| TextEdit::new(one.span, uses.words(&written))),
    };
    let reads = uses.of_name(number).filter(|one| one.access.act.reads());
    let places: Vec<Use> = reads.take(MOST_PLACES + 1).collect();
    let edits =
        places.iter().filter(|_| places.len() <= MOST_PLACES).map(edit).collect::<Option<Vec<_>>>()?;
    let title = Message::new("read-never-written.replace").with("other", uses.words(&written));
    (!edits.is_empty()).then(|| (title.with("rung", written.rung), edits))
}
