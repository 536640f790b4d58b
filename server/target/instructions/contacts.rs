//! Contacts: LD, AND, OR and their kin.

use crate::target::{Accepts, Access, Instruction, Model, Opcode, OperandSpec, Role, Steps, Wide};

const ALL_FX: &[Model] = &[Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u];

const CONTACT: &[OperandSpec] = &[OperandSpec {
    name: "S",
    meaning: "bit device",
    access: Access::Read,
    accepts: Accepts::CONTACT,
    range: None,
    count: 1,
    optional: false,
}];

/// LD LDI.
pub const ROWS: &[Instruction] = &[
    Instruction {
        mnemonic: "LD",
        title: "load",
        role: Role::Load,
        wide: Wide::No,
        pulse: false,
        operands: CONTACT,
        steps: Steps::ByDevice,
        opcode: Opcode::Contact { class: 2, extended: 0x01C2 },
        models: ALL_FX,
        page: "Starts a rung or a block with a normally open contact.\n\n```il\nLD X0\nOUT Y0\nEND\n```\n",
    },
    Instruction {
        mnemonic: "LDI",
        title: "load inverse",
        role: Role::Load,
        wide: Wide::No,
        pulse: false,
        operands: CONTACT,
        steps: Steps::ByDevice,
        opcode: Opcode::Contact { class: 3, extended: 0x01C3 },
        models: ALL_FX,
        page: "Starts a rung or a block with a normally closed contact.\n\n```il\nLDI X0\nOUT Y0\nEND\n```\n",
    },
];
