//! How many program steps an instruction takes. A step is one 16-bit word of program memory.

use crate::target::{Device, DeviceKind, Form, Opcode, Operand, Role, Steps};

/// Steps of `form` with these operands, as the programming manuals and the program memory of real PLCs have it.
pub fn steps(form: Form, operands: &[Operand]) -> u32 {
    match form.instruction.steps {
        Steps::Fixed(steps) => u32::from(steps),
        Steps::ByOperands => {
            let words = if form.wide { 4 } else { 2 };
            1 + words * form.instruction.operands.len() as u32
        }
        Steps::ByDevice => by_device(form, operands.first()),
    }
}

/// Basic instructions name their device in twelve bits of one word, where it has room there.
fn by_device(form: Form, operand: Option<&Operand>) -> u32 {
    let Some(operand) = operand else {
        return 1;
    };
    let device = match operand {
        Operand::Device(device) => *device,
        // Only the FX3U has these, and spells out the index or the bit in words of their own.
        Operand::Indexed { .. } | Operand::WordBit { .. } => return 3,
        _ => return 1,
    };
    match (form.instruction.opcode, form.instruction.role) {
        (Opcode::ByDevice(_), Role::Output) => match device.kind {
            DeviceKind::T | DeviceKind::C if form.instruction.operands.len() < 2 => 2,
            DeviceKind::C if device.number >= 200 => 5,
            DeviceKind::T | DeviceKind::C => 3,
            DeviceKind::D | DeviceKind::R | DeviceKind::V | DeviceKind::Z => 3,
            DeviceKind::S => 2,
            DeviceKind::M if device.number >= FIRST_EXTENDED_RELAY => 2,
            _ => 1,
        },
        // Pulse contacts and PLS are never shorter than two words.
        (Opcode::Device(_), _) => 2,
        _ if is_extended(device) => 2,
        _ => 1,
    }
}

/// M0 to M1535 have a one-word OUT.
const FIRST_EXTENDED_RELAY: u32 = 1536;

/// Whether a contact of `device` takes the two-word form: relays and states that the first models did not have.
fn is_extended(device: Device) -> bool {
    match device.kind {
        DeviceKind::M => (FIRST_EXTENDED_RELAY..8000).contains(&device.number) || device.number > 8255,
        DeviceKind::S => device.number >= 1024,
        _ => false,
    }
}
