//! The special relays and registers of each model, chosen from one list while compiling.

use super::special_registers::REGISTERS;
use super::special_relays::RELAYS;
use crate::target::{Device, DeviceKind, SpecialDevice};

/// A special device and the models that have it.
#[derive(Clone, Copy)]
pub struct Row {
    device: SpecialDevice,
    models: u8,
}

/// FX1S.
pub static FX1S: [SpecialDevice; count(ON_FX1S)] = select(ON_FX1S);
/// FX1N.
pub static FX1N: [SpecialDevice; count(ON_FX1N)] = select(ON_FX1N);
/// FX2N.
pub static FX2N: [SpecialDevice; count(ON_FX2N)] = select(ON_FX2N);
/// FX3U.
pub static FX3U: [SpecialDevice; count(ON_FX3U)] = select(ON_FX3U);

const ON_FX1S: u8 = 1;
const ON_FX1N: u8 = 2;
const ON_FX2N: u8 = 4;
const ON_FX3U: u8 = 8;

/// A relay that the program only reads.
pub const fn relay(number: u32, meaning: &'static str) -> Row {
    Row {
        device: SpecialDevice { device: Device::new(DeviceKind::M, number), meaning, writable: false },
        models: 15,
    }
}

/// A register that the program only reads.
pub const fn register(number: u32, meaning: &'static str) -> Row {
    Row {
        device: SpecialDevice { device: Device::new(DeviceKind::D, number), meaning, writable: false },
        models: 15,
    }
}

impl Row {
    /// The program may write it.
    pub const fn writable(self) -> Row {
        Row { device: SpecialDevice { writable: true, ..self.device }, ..self }
    }

    /// Not on the FX1S.
    pub const fn fx1n_up(self) -> Row {
        Row { models: ON_FX1N | ON_FX2N | ON_FX3U, ..self }
    }

    /// On FX2N and FX3U.
    pub const fn fx2n_up(self) -> Row {
        Row { models: ON_FX2N | ON_FX3U, ..self }
    }

    /// On FX3U only.
    pub const fn fx3u(self) -> Row {
        Row { models: ON_FX3U, ..self }
    }

    /// On FX1S and FX1N only.
    pub const fn fx1(self) -> Row {
        Row { models: ON_FX1S | ON_FX1N, ..self }
    }

    /// On FX1S only.
    pub const fn fx1s(self) -> Row {
        Row { models: ON_FX1S, ..self }
    }
}

const fn count(model: u8) -> usize {
    let mut found = 0;
    let mut row = 0;
    while row < RELAYS.len() + REGISTERS.len() {
        if row_at(row).models & model != 0 {
            found += 1;
        }
        row += 1;
    }
    found
}

const fn select<const COUNT: usize>(model: u8) -> [SpecialDevice; COUNT] {
    let mut chosen = [RELAYS[0].device; COUNT];
    let mut found = 0;
    let mut row = 0;
    while row < RELAYS.len() + REGISTERS.len() {
        if row_at(row).models & model != 0 {
            chosen[found] = row_at(row).device;
            found += 1;
        }
        row += 1;
    }
    chosen
}

/// Relays before registers: the order of `Device`, which look-ups rely on.
const fn row_at(row: usize) -> Row {
    if row < RELAYS.len() { RELAYS[row] } else { REGISTERS[row - RELAYS.len()] }
}
