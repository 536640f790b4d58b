//! Master control and step ladder.

use super::specs::{operand, plain};
use crate::target::{Accepts, Access, Drive, Instruction, Opcode, OperandSpec, Role, Steps};

const LEVEL: OperandSpec = operand("n", "nesting level", Access::Read, Accepts::N);

const fn with(
    instruction: Instruction,
    operands: &'static [OperandSpec],
    steps: u8,
    opcode: Opcode,
) -> Instruction {
    Instruction { operands, steps: Steps::Fixed(steps), opcode, ..instruction }
}

/// MC MCR STL RET.
pub const ROWS: &[Instruction] = &[
    with(
        plain(
            0,
            "MC",
            "master control",
            Role::Output,
            "Opens a section that has power only while the result is on, like a rail behind a main \
         contact; MCR with the same level closes it. While it is off, everything in the section runs \
         with its contacts off: coils and ordinary timers go off, while SET devices, counters and \
         retentive timers keep what they have. Levels are nested from N0 to N7, and a section must \
         not begin inside a state of a step ladder.\n\n\
         ```il\n\
         LD X0\n\
         MC N0 M0\n\
         LD X1\n\
         OUT Y0\n\
         LD X2\n\
         OUT Y1\n\
         MCR N0\n\
         END\n\
         ```\n",
        ),
        &[
            LEVEL,
            operand("D", "relay of the section", Access::Write, Accepts::Y.or(Accepts::M))
                .driven(Drive::Coil),
        ],
        3,
        Opcode::Device(0x000A),
    ),
    with(
        plain(
            0,
            "MCR",
            "master control reset",
            Role::Standalone,
            "Closes the section that MC opened with the same level, and all levels above it. It stands by \
         itself, without contacts before it.\n\n\
         ```il\n\
         LD X0\n\
         MC N0 M0\n\
         LD X1\n\
         MC N1 M1\n\
         LD X2\n\
         OUT Y0\n\
         MCR N1\n\
         LD X3\n\
         OUT Y1\n\
         MCR N0\n\
         END\n\
         ```\n",
        ),
        &[LEVEL],
        2,
        Opcode::Device(0x000B),
    ),
    with(
        plain(
            0,
            "STL",
            "step ladder state",
            Role::StepLoad,
            "Begins what is done in a state of the step ladder: everything up to the next STL or RET is \
         executed only while the state is on. A transfer with SET to the next state, or with OUT to a \
         state further away, leaves this one. Coils switched on by OUT go off when their state is \
         left, so the same output may be driven in several states. The whole sequence ends with one \
         RET, and states 0 to 9 are the ones to begin with.\n\n\
         ```il\n\
         LD M8002\n\
         SET S0\n\
         STL S0\n\
         LD X0\n\
         SET S20\n\
         STL S20\n\
         OUT Y0\n\
         LD X1\n\
         OUT S0\n\
         RET\n\
         END\n\
         ```\n",
        ),
        &[operand("S", "state", Access::Read, Accepts::S)],
        1,
        Opcode::Contact { class: 15, extended: 0 },
    ),
    plain(
        0xF7FF,
        "RET",
        "end of the step ladder",
        Role::Standalone,
        "Ends the step ladder and goes back to the ordinary rungs. It stands once after the last \
         state, not after each one, and without contacts before it.\n\n\
         ```il\n\
         LD M8002\n\
         SET S0\n\
         STL S0\n\
         LD X0\n\
         SET S20\n\
         STL S20\n\
         OUT Y0\n\
         LDI X0\n\
         OUT S0\n\
         RET\n\
         LD X1\n\
         OUT Y1\n\
         END\n\
         ```\n",
    ),
];
