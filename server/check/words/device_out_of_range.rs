//! # device-out-of-range
//!
//! The model has devices of this kind, but not this one. The PLC would refuse the program (error 6505), or an
//! instruction that works on a run of devices would reach beyond the last one and stop with an operation error.
//! The message says which numbers there are, and which model has the one that is written.
//!
//! ```fx fx1n
//! LD M2000
//!    ^^^^^
//! MOV K4M1530 D0
//!     ^^^^^^^
//! END
//! ```
//!
//! ```fx fx2n
//! LD M2000
//! MOV K4M1530 D0
//! END
//! ```
//!
//! ```lad fx1s
//! |  X0                M600 |
//!                      ^^^^
//! +--| |---------------( )--+
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::document::{Chunk, Symbol, Tree, Use};
use crate::il::fx::LineKind;
use crate::target::{Device, DeviceKind, DeviceRange, Form, Operand, Target};
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "device-out-of-range",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("device_out_of_range.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let target = context.target;
    if !target.is_fx() {
        return;
    }
    for operation in &context.doubtful {
        for (place, operand) in operation.operands.iter().enumerate() {
            let run = run_of(operation.form, place, &operand.value);
            found.extend(run.and_then(|(first, last)| outside(first, last, operand.span, target)));
            found.extend(
                index_of(&operand.value).and_then(|index| outside(index, index, operand.span, target)),
            );
        }
    }
    if !declares_devices(context.chunk) {
        return;
    }
    for mention in context.chunk.mentions().iter().filter(|mention| mention.usage == Use::Declare) {
        if let Symbol::Device(label) = mention.symbol {
            found.extend(outside(label, label, mention.span, target));
        }
    }
}

/// Whether any of a chunk's mentions may declare a device, which lists do with labels only.
fn declares_devices(chunk: &Chunk) -> bool {
    match chunk.tree() {
        Tree::Fx(tree) => tree.lines.iter().any(|line| matches!(line.kind, LineKind::Label(_))),
        Tree::Ladder(tree) => tree.header.as_ref().is_some_and(|header| header.label.is_some()),
        Tree::Iec(_) => true,
    }
}

/// The first and the last device that an operand stands for.
fn run_of(form: Option<Form>, place: usize, operand: &Operand) -> Option<(Device, Device)> {
    let first = operand.device()?;
    let spec = form.and_then(|form| form.instruction.operands.get(place));
    let fixed = spec.map_or(1, |spec| u32::from(spec.count));
    let count = match operand {
        // Inputs and outputs beyond the terminals have memory behind them up to the end of the group.
        Operand::Nibbles { first, .. } if matches!(first.kind, DeviceKind::X | DeviceKind::Y) => 1,
        Operand::Nibbles { digits, index: None, .. } => u32::from(*digits) * 4,
        Operand::Device(device) if matches!(device.kind, DeviceKind::D | DeviceKind::R) => {
            fixed.max(if form.is_some_and(|form| form.wide) { 2 } else { 1 })
        }
        Operand::Device(_) => fixed,
        _ => 1,
    };
    Some((first, Device::new(first.kind, first.number.saturating_add(count.saturating_sub(1)))))
}

fn index_of(operand: &Operand) -> Option<Device> {
    match *operand {
        Operand::Indexed { index, .. } => Some(index),
        Operand::Nibbles { index, .. } | Operand::Constant { index, .. } => index,
        _ => None,
    }
}

fn outside(first: Device, last: Device, span: Span, target: &Target) -> Option<Diagnostic> {
    let within = |range: &DeviceRange| range.first <= first.number && last.number <= range.last;
    // Nearly all devices lie in one range, for which nothing has to be joined.
    if target.ranges(first.kind).any(within) {
        return None;
    }
    let runs = runs(first.kind, target);
    let holds = |device: Device, &(least, most): &(u32, u32)| (least..=most).contains(&device.number);
    if runs.is_empty() || runs.iter().any(|run| holds(first, run) && holds(last, run)) {
        return None;
    }
    let device = |number| Device::new(first.kind, number).to_string();
    let written: Vec<String> = runs
        .iter()
        .map(|&(least, most)| match least == most {
            true => device(least),
            false => format!("{}–{}", device(least), device(most)),
        })
        .collect();
    let elsewhere: Vec<&str> = Target::ALL
        .into_iter()
        .filter(|other| first.range_on(other).is_some() && last.range_on(other).is_some())
        .map(|other| other.title)
        .collect();
    let reaches = runs.iter().any(|run| holds(first, run));
    let key = match (reaches, elsewhere.is_empty()) {
        (true, _) => "device-out-of-range.reaches",
        (false, false) => "device-out-of-range.elsewhere",
        (false, true) => "device-out-of-range.found",
    };
    let message = Message::new(key)
        .with("device", first)
        .with("last", last)
        .with("target", target.title)
        .with("ranges", written.join(", "))
        .with("models", elsewhere.join(", "));
    Some(Diagnostic::new(RULE.code, span, message))
}

/// The numbers of `kind` that the target has, neighbouring ranges joined. Special devices from 8000 on are no
/// continuation of the ordinary ones.
fn runs(kind: DeviceKind, target: &Target) -> Vec<(u32, u32)> {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for range in target.ranges(kind) {
        let special = matches!(kind, DeviceKind::M | DeviceKind::D) && range.first == 8000;
        match runs.last_mut() {
            Some(run) if run.1 + 1 == range.first && !special => run.1 = range.last,
            _ => runs.push((range.first, range.last)),
        }
    }
    runs
}
