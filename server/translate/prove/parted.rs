//! Rungs cut where that changes nothing, so that it makes no difference whether what comes before a jump stands in the
//! rung of the jump or in one of its own.

use super::may_overlap;
use crate::ladder::ContactKind;
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test, touches_bits};
use crate::target::{Device, DeviceKind, Flow, Operand};
use crate::translate::source::Source;

/// The rungs, those with a jump or the like cut behind the blocks that power goes through, before the jump and behind
/// it. A part stands where its first drive does.
pub(super) fn parted(rungs: Vec<Source>) -> Vec<Source> {
    rungs.into_iter().flat_map(behind_blocks).flat_map(parts).flat_map(behind_blocks).collect()
}

/// What power drives behind a block goes on from the output of that, which may be asked in a rung of its own.
fn behind_blocks(mut source: Source) -> Vec<Source> {
    if let Ok(Some(path)) = &mut source.rung.path {
        join_gates(path);
    }
    let touches = |path: &Path| path.actions().into_iter().any(touches_bits);
    let cut = source.path().filter(|path| touches(path)).and_then(|path| {
        let through = |gate: &Gate| matches!(gate, Gate::Through(_));
        let at = path.gates.iter().rposition(through)?;
        let Gate::Through(block) = &path.gates[at] else { return None };
        let (output, start) = (block.power_out()?, start_of(path.drives.first()?));
        let is_behind = source.rung.span.start < start;
        let asked =
            Contact { test: Test::Bit(ContactKind::NormallyOpen), terms: vec![output], span: block.span };
        let asked = Gate::Pass(Expression::Contact(asked));
        let gates = std::iter::once(asked).chain(path.gates[at + 1..].iter().cloned()).collect();
        let call = Path { gates: path.gates[..at].to_vec(), drives: vec![Drive::Action(block.clone())] };
        is_behind.then(|| (call, Path { gates, drives: path.drives.clone() }, start))
    });
    let Some((call, rest, start)) = cut else { return vec![source] };
    let mut behind = source.clone();
    behind.rung.span.start = start;
    behind.rung.labels.clear();
    behind.rung.path = Ok(Some(rest));
    let mut before = source;
    before.rung.path = Ok(Some(call));
    behind_blocks(before).into_iter().chain([behind]).collect()
}

fn parts(source: Source) -> Vec<Source> {
    let Some(path) = source.path().filter(|path| path.drives.len() > 1 && is_cut_anywhere(path)) else {
        return vec![source];
    };
    let gates: Vec<Term> = path.gates.iter().flat_map(read).collect();
    let mut groups: Vec<Vec<Drive>> = Vec::new();
    let mut starts = Vec::new();
    let (mut is_steady, mut was_steering) = (true, false);
    for drive in &path.drives {
        let actions = actions(drive);
        let touches = actions.iter().any(|action| touches_bits(action));
        let start = start_of(drive);
        let is_behind = starts.last().is_some_and(|last| *last < start) && source.rung.span.start < start;
        match groups.last_mut() {
            Some(group) if !(is_steady && is_behind && (touches || was_steering)) => {
                group.push(drive.clone())
            }
            _ => {
                groups.push(vec![drive.clone()]);
                starts.push(if groups.len() == 1 { source.rung.span.start } else { start });
            }
        }
        is_steady &= actions.iter().all(|action| leaves_alone(action, &gates));
        was_steering = touches;
    }
    let part = |(number, (drives, start)): (usize, (Vec<Drive>, u32))| {
        let mut part = source.clone();
        part.rung.path = Ok(Some(Path { gates: path.gates.clone(), drives }));
        part.rung.span.start = start;
        if number > 0 {
            part.rung.labels.clear();
        }
        part
    };
    groups.into_iter().zip(starts).enumerate().map(part).collect()
}

/// Makes one path of a path that drives nothing but another one.
fn join_gates(path: &mut Path) {
    while let [Drive::Path(inner)] = &mut path.drives[..] {
        let inner = std::mem::take(inner);
        path.gates.extend(inner.gates);
        path.drives = inner.drives;
    }
}

/// Whether a drive of it looks at more than its condition, and its condition is the same however often it is asked.
fn is_cut_anywhere(path: &Path) -> bool {
    let is_single = |term: &Term| matches!(term.operand, Operand::Device(device) if device.has_single_edge());
    let is_passed = |gate: &Gate| !matches!(gate, Gate::Through(_)) && !read(gate).iter().any(is_single);
    path.gates.iter().all(is_passed) && path.drives.iter().flat_map(actions).any(touches_bits)
}

/// What a gate reads, of a value of 32 bits both halves.
fn read(gate: &Gate) -> Vec<Term> {
    let Gate::Pass(condition) = gate else { return Vec::new() };
    let mut read = Vec::new();
    for contact in condition.contacts() {
        read.extend_from_slice(&contact.terms);
        if matches!(contact.test, Test::Compare(operator) if operator.is_wide()) {
            let lower = contact.terms.iter().filter_map(|term| device_of(term).zip(Some(term.span)));
            let upper = |device: Device| Device { number: device.number.saturating_add(1), ..device };
            read.extend(lower.map(|(device, span)| Term::of_device(upper(device), span)));
        }
    }
    read
}

fn actions(drive: &Drive) -> Vec<&Action> {
    match drive {
        Drive::Action(action) => vec![action],
        Drive::Path(path) => path.actions(),
    }
}

fn start_of(drive: &Drive) -> u32 {
    actions(drive).iter().map(|action| action.span.start).min().unwrap_or_default()
}

fn device_of(term: &Term) -> Option<Device> {
    match term.operand {
        Operand::Device(device) => Some(device),
        _ => None,
    }
}

/// Whether an action changes nothing that one of these may be: it jumps, or what it writes is something else.
fn leaves_alone(action: &Action, terms: &[Term]) -> bool {
    match action.deed {
        Deed::Jump | Deed::Return => true,
        Deed::Instruction(form) if form.instruction.flow() == Flow::Jump => true,
        // It sets flags besides.
        Deed::Instruction(form) if form.instruction.flow() == Flow::Straight => {
            let is_register = |device: Device| device.kind == DeviceKind::D && !device.is_special();
            let is_relay =
                |term: &Term| term.is_lone() && device_of(term).is_some_and(|own| !own.is_special());
            let mut changes = action.changes().into_iter();
            changes.all(|own| device_of(&own).is_some_and(is_register)) && terms.iter().all(is_relay)
        }
        Deed::Coil(_) if !touches_bits(action) => action.changes().iter().all(|own| {
            let kind = |term: &Term| term.operand.device().map(|device| device.kind);
            let is_counted = |term: &Term| kind(term).is_some_and(|kind| kind.has_preset());
            terms.iter().all(|term| {
                let is_kin = is_counted(own) && kind(own) == kind(term);
                !is_kin && !own.may_cover(term) && !term.may_cover(own) && !may_overlap(own, term)
            })
        }),
        _ => false,
    }
}
