//! The kinds of devices in use, and the free devices among those in use.

use super::{Usage, UsageKey, UsageRow};
use crate::document::ProjectView;
use crate::ide::devices;
use crate::target::{Device, DeviceKind, DeviceRange, Target};
use crate::text::{Language, Message};
use rustc_hash::FxHashSet;
use serde_json::{Value, json};

/// What a row of the list of used devices is, the groups of a tree of them.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum UsageKind {
    /// Devices of a kind.
    Device(DeviceKind),
    /// Direct addresses.
    Address,
    /// Variables.
    Variable,
}

/// A kind with rows in the list.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct UsedKind {
    /// The kind.
    pub kind: UsageKind,
    /// How many of it are used, devices within runs included.
    pub used: usize,
    /// The first free device of the kind, if there is one.
    pub next: Option<Device>,
}

impl UsageKind {
    /// The letter of a device, `address` or `variable`: for programs.
    pub fn word(self) -> String {
        match self {
            UsageKind::Device(kind) => kind.letter().to_string(),
            UsageKind::Address => "address".to_string(),
            UsageKind::Variable => "variable".to_string(),
        }
    }

    /// The same for people.
    pub fn name(self, language: Language) -> String {
        match self {
            UsageKind::Device(kind) => devices::kind_name(kind, language),
            UsageKind::Address => Message::new("usage.addresses").render(language),
            UsageKind::Variable => Message::new("usage.variables").render(language),
        }
    }
}

impl UsedKind {
    /// The kind for programs that read it, as the command line and the editors give it:
    /// `{"kind", "name", "used", "next"}`, where `name` is in the language of the user and `next` may be `null`.
    pub fn json(&self, language: Language) -> Value {
        json!({
            "kind": self.kind.word(),
            "name": self.kind.name(language),
            "used": self.used,
            "next": self.next.map(|device| device.to_string()),
        })
    }
}

/// Tells the kinds of `usage`, and each row the free devices behind it.
pub(super) fn find(usage: &mut Usage, view: &ProjectView<'_>) {
    let target = view.here().target();
    let used: FxHashSet<Device> = usage.rows.iter().flat_map(meant).collect();
    let comments = view.here().comments();
    let is_free = |device: Device| !used.contains(&device) && comments.of_device(device).is_none();
    let mut kinds: Vec<UsedKind> = Vec::new();
    for row in &usage.rows {
        let kind = row.key.kind();
        if kinds.last().is_none_or(|last| last.kind != kind) {
            kinds.push(UsedKind { kind, used: 0, next: next(kind, target, &is_free) });
        }
        let runs = matches!(kind, UsageKind::Device(_));
        if let Some(last) = kinds.last_mut().filter(|_| !runs) {
            last.used += 1;
        }
    }
    for device in &used {
        let own = kinds.iter_mut().find(|own| own.kind == UsageKind::Device(device.kind));
        own.into_iter().for_each(|own| own.used += 1);
    }
    usage.kinds = kinds;
    for place in 1..usage.rows.len() {
        if let [row, next] = &mut usage.rows[place - 1..=place]
            && let (UsageKey::Device(device), UsageKey::Device(next)) = (&row.key, &next.key)
        {
            row.gaps = between(*device, *next, target, &is_free);
        }
    }
}

/// The devices that the uses of a row mean.
fn meant(row: &UsageRow) -> impl Iterator<Item = Device> {
    let (first, count) = match row.key {
        UsageKey::Device(device) => (device, u32::from(row.length.max(1))),
        _ => (Device::new(DeviceKind::X, 0), 0),
    };
    (first.number..first.number.saturating_add(count)).map(move |number| Device::new(first.kind, number))
}

/// Whether the devices of `range` are for programs to choose. Those whose number has a meaning of its own are not:
/// special relays and registers, interrupt pointers, nesting levels, and the pointer to END.
fn is_to_choose(range: &DeviceRange, target: &Target) -> bool {
    let is_end = range.kind == DeviceKind::P && range.first == range.last;
    if is_end || matches!(range.kind, DeviceKind::I | DeviceKind::N) {
        return false;
    }
    let first = Device::new(range.kind, range.first);
    let behind = target.special.partition_point(|special| special.device < first);
    let special = target.special.get(behind);
    special.is_none_or(|special| special.device.kind != range.kind || special.device.number > range.last)
}

/// The first free device of `kind`.
fn next(kind: UsageKind, target: &Target, is_free: &impl Fn(Device) -> bool) -> Option<Device> {
    let UsageKind::Device(kind) = kind else { return None };
    let ranges = target.ranges(kind).filter(|range| is_to_choose(range, target));
    ranges
        .flat_map(|range| range.first..=range.last)
        .map(|number| Device::new(kind, number))
        .find(|it| is_free(*it))
}

/// The runs of free devices between two devices of a range.
fn between(
    device: Device,
    next: Device,
    target: &Target,
    is_free: &impl Fn(Device) -> bool,
) -> Vec<(Device, Device)> {
    let range = device.range_on(target).filter(|range| is_to_choose(range, target));
    if range.is_none_or(|range| next.kind != range.kind || next.number > range.last) {
        return Vec::new();
    }
    let mut gaps: Vec<(Device, Device)> = Vec::new();
    for number in device.number + 1..next.number {
        let own = Device::new(device.kind, number);
        if !is_free(own) {
            continue;
        }
        match gaps.last_mut() {
            Some((_, last)) if last.number + 1 == number => *last = own,
            _ => gaps.push((own, own)),
        }
    }
    gaps
}
