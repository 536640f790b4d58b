//! Devices that a program does not use, for fixes that need one.

use super::uses::{Use, Uses};
use crate::document::Chunk;
use crate::target::{Device, Target};
use crate::text::Span;

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
