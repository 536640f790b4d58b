//! Special relays and registers that the CPU writes by itself.

use super::{Lanes, Machine, annunciators, clock};
use crate::target::{Device, DeviceKind, Model, Port};
use std::sync::Arc;

/// Where an FX1S and FX1N have the positions of their trimmers.
const TRIMMERS: u32 = 8030;

impl<L: Lanes> Machine<L> {
    /// Special relays and registers that the CPU writes at the start of a scan.
    pub(super) fn special(&mut self) {
        let layout = Arc::clone(&self.code.layout);
        let is_first = self.scans == 1;
        let half = |ms: i64| clock::is_second_half(ms, self.now_ns, self.scan_ns, self.scans);
        let relays = [
            (8000, true),
            (8001, false),
            (8002, is_first),
            (8003, !is_first),
            (8011, half(10)),
            (8012, half(100)),
            (8013, half(1000)),
            (8014, half(60_000)),
        ];
        for (number, on) in relays {
            if let Some(cell) = layout.cell(Device::new(DeviceKind::M, number)) {
                self.memory.set_cell(cell, L::all(on));
            }
        }
        if is_first && layout.has(Device::new(DeviceKind::D, 8001)) {
            self.identify();
        }
        // These CPUs have two trimmers of their own.
        if matches!(self.code.target.model, Model::Fx1s | Model::Fx1n) {
            for number in 0..2 {
                let Some(slot) = layout.slot(Device::new(DeviceKind::D, TRIMMERS + number)) else { continue };
                for (lane, outside) in self.outside.iter().enumerate() {
                    self.memory.set_word(slot, lane, outside.number(Port::Trimmer(number as u8)));
                }
            }
        }
        clock::advance(&mut self.memory, &layout, self.scans, self.scan_ns);
        annunciators::monitor(&mut self.memory, &layout);
        // In tenths of a millisecond: the present scan time, the least and the greatest so far.
        let Some(slot) = layout.slot(Device::new(DeviceKind::D, 8010)) else { return };
        let tenths = i64::from((self.scan_ns / 100_000).min(i64::from(i16::MAX)) as i16);
        for lane in 0..L::COUNT {
            let (least, greatest) = (self.memory.word(slot + 1, lane), self.memory.word(slot + 2, lane));
            self.memory.set_word(slot, lane, tenths);
            if self.scans > 1 {
                let least = if self.scans == 2 { tenths } else { least.min(tenths) };
                self.memory.set_word(slot + 1, lane, least);
                self.memory.set_word(slot + 2, lane, greatest.max(tenths));
            }
        }
    }
}
