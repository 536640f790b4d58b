//! Outputs: OUT, SET, RST, PLS, PLF.

use super::specs::{ALL_FX, operand, source};
use crate::target::{
    Accepts, Access, Counting, DeviceCodes, Drive, Instruction, Opcode, OperandSpec, Role, Semantics, Steps,
    Wide,
};

const PRESET: OperandSpec = source("K", "preset of a timer or counter")
    .accepting(Accepts::K.or(Accepts::D).or(Accepts::R))
    .left_out();

const RESET: Accepts = Accepts::BIT_DESTINATION
    .or(Accepts::T)
    .or(Accepts::C)
    .or(Accepts::D)
    .or(Accepts::R)
    .or(Accepts::V)
    .or(Accepts::Z);

const OUT: DeviceCodes =
    DeviceCodes { class: 0xC, relay: 0x0002, state: 0x0005, counting: Counting::Preset, register: None };
const SET: DeviceCodes =
    DeviceCodes { class: 0xD, relay: 0x0003, state: 0x0006, counting: Counting::Never, register: None };
const RST: DeviceCodes = DeviceCodes {
    class: 0xE,
    relay: 0x0004,
    state: 0x0007,
    counting: Counting::Reset(0x000C),
    register: Some(0x000D),
};

const PULSED: &[OperandSpec] =
    &[operand("D", "relay", Access::Write, Accepts::Y.or(Accepts::M)).driven(Drive::Pulse)];

const fn output(
    opcode: Opcode,
    mnemonic: &'static str,
    title: &'static str,
    operands: &'static [OperandSpec],
    page: &'static str,
) -> Instruction {
    Instruction {
        mnemonic,
        title,
        role: Role::Output,
        wide: Wide::No,
        pulse: false,
        operands,
        steps: Steps::ByDevice,
        opcode,
        semantics: Semantics::Basic,
        models: ALL_FX,
        page,
    }
}

/// OUT SET RST PLS PLF.
pub const ROWS: &[Instruction] = &[
    output(
        Opcode::ByDevice(OUT),
        "OUT",
        "coil",
        &[
            operand("D", "coil", Access::Write, Accepts::BIT_DESTINATION.or(Accepts::T).or(Accepts::C))
                .driven(Drive::Coil),
            PRESET,
        ],
        "Writes the current result to the device in every scan: on while the result is on, off while \
         it is off. A timer runs while its coil is on and needs a preset in units of the timer, a \
         constant or a register; a counter counts each time its coil goes on and keeps its count \
         until RST. Several outputs may follow each other on the same result. If a program drives the \
         same device in two places, the later one wins.\n\n\
         ```il\n\
         LD X0\n\
         OUT Y0\n\
         OUT T0 K50\n\
         LD T0\n\
         OUT Y1\n\
         LD X1\n\
         RST C0\n\
         LD X2\n\
         OUT C0 K10\n\
         LD C0\n\
         OUT Y2\n\
         END\n\
         ```\n",
    ),
    output(
        Opcode::ByDevice(SET),
        "SET",
        "set and hold",
        &[operand("D", "bit device", Access::Write, Accepts::BIT_DESTINATION).driven(Drive::Set)],
        "Switches the device on when the result is on and leaves it on afterwards, until RST switches \
         it off. In a step ladder SET of a state is a transfer: the state that it stands in is left \
         in the next scan. Where SET and RST are both on, the one that comes later in the program \
         wins.\n\n\
         ```il\n\
         LD X0\n\
         SET Y0\n\
         LD X1\n\
         RST Y0\n\
         END\n\
         ```\n",
    ),
    output(
        Opcode::ByDevice(RST),
        "RST",
        "reset",
        &[operand("D", "device", Access::Write, RESET).driven(Drive::Reset)],
        "Switches the device off when the result is on and leaves it off. For a timer or a counter it \
         also clears the current value, for a register it writes 0. Counters and retentive timers \
         need it, since nothing else brings them back to 0; a counter whose RST is on does not count.\n\n\
         ```il\n\
         LD X0\n\
         RST C0\n\
         LD X1\n\
         OUT C0 K5\n\
         LD C0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    output(
        Opcode::Device(0x0008),
        "PLS",
        "pulse at the rising edge",
        PULSED,
        "Switches the relay on for exactly one scan when the result goes from off to on. It takes \
         outputs and auxiliary relays, but not the special relays from M8000 on. After a jump has \
         skipped it, the pulse comes when it is executed again and finds the result on.\n\n\
         ```il\n\
         LD X0\n\
         PLS M0\n\
         LD M0\n\
         SET Y0\n\
         LD X1\n\
         RST Y0\n\
         END\n\
         ```\n",
    )
    .taking(2),
    output(
        Opcode::Device(0x0009),
        "PLF",
        "pulse at the falling edge",
        PULSED,
        "Switches the relay on for exactly one scan when the result goes from on to off. It takes \
         outputs and auxiliary relays, but not the special relays from M8000 on.\n\n\
         ```il\n\
         LD X0\n\
         PLF M0\n\
         LD M0\n\
         SET Y0\n\
         LD X1\n\
         RST Y0\n\
         END\n\
         ```\n",
    )
    .taking(2),
];
