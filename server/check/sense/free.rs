//! Devices that a program does not use, for fixes that need one.

use super::relays::is_general;
use super::uses::{Use, Uses};
use crate::check::ProgramContext;
use crate::document::{Chunk, Part};
use crate::target::{Device, DeviceKind, Model, Operand, Target};
use crate::text::{Span, TextEdit};

/// So many devices behind one are asked whether they are free.
const ASKED_MAX: u32 = 1_000;

/// The first of `count` devices in a row behind `device` in its range that nothing uses, at a multiple of `count` from
/// the start of the range.
pub(super) fn next_free(uses: &Uses<'_>, device: Device, count: u32, target: &Target) -> Option<Device> {
    let range = device.range_on(target)?;
    let is_free = |number: u32| {
        let device = Device::new(device.kind, number);
        uses.device(device).is_none() && !uses.is_read_in_row(device) && !uses.is_written_in_row(device)
    };
    let last = range.last.min(device.number.saturating_add(ASKED_MAX));
    let mut starts = (device.number + 1..=last).filter(|start| (start - range.first) % count == 0);
    let start = starts.find(|start| {
        let row = *start..start.saturating_add(count);
        row.end <= range.last + 1 && row.clone().all(is_free)
    })?;
    Some(Device::new(device.kind, start))
}

/// The word of the instruction, or the cells of the element, at which a device stands in an FX program, with its text.
pub(super) fn symbol_of(uses: &Uses<'_>, one: &Use) -> Option<(Span, String)> {
    let (start, chunk) = uses.chunk(one)?;
    let reading = chunk.reading();
    let chunk: &Chunk = &reading;
    let is_here = |span: Span| span.shifted(start) == one.span;
    let mut all = chunk.operations();
    let found = all.find(|operation| operation.operands.iter().any(|operand| is_here(operand.span)))?;
    Some((found.symbol.shifted(start), found.symbol.of(chunk.text()).to_string()))
}

/// The general devices of a kind that the program does not name, each given once.
pub(super) struct FreeDevices<'c, 'a> {
    uses: &'c Uses<'a>,
    context: &'c ProgramContext<'a>,
    kind: DeviceKind,
    next: u32,
}

impl<'c, 'a> FreeDevices<'c, 'a> {
    /// From the first number on.
    pub fn of(context: &'c ProgramContext<'a>, kind: DeviceKind) -> FreeDevices<'c, 'a> {
        FreeDevices { uses: context.uses(), context, kind, next: 0 }
    }

    /// The next one, if there is one left.
    pub fn take(&mut self) -> Option<Device> {
        loop {
            let device = Device::new(self.kind, self.next);
            device.range_on(self.context.target()).filter(|_| !device.is_special())?;
            self.next += 1;
            let is_free = is_general(device, self.context) && self.uses.device(device).is_none();
            if is_free && !self.uses.is_read_in_row(device) && !self.uses.is_written_in_row(device) {
                return Some(device);
            }
        }
    }
}

/// Writes `other` for the device at `one`, if it stands there alone. The cells of a drawing must stay where they are: a
/// shorter name is followed by blanks there, and a longer one does not fit.
pub(super) fn renamed(uses: &Uses<'_>, one: &Use, device: Device, other: Device) -> Option<TextEdit> {
    let is_plain = one.access.part == Part::Whole
        && Operand::read(&uses.words(one), Model::Fx3u) == Operand::Device(device);
    let (name, width) = (other.to_string(), one.span.len());
    let fits = uses.is_list(one) || name.len() <= width;
    let padded = if uses.is_list(one) { name } else { format!("{name:<width$}") };
    (is_plain && fits).then(|| TextEdit::new(one.span, padded))
}
