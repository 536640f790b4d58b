//! The end of the program, empty steps, and labels.

use super::specs::{operand, plain};
use crate::target::{Accepts, Access, Instruction, Opcode, Role, Semantics};

/// NOP END.
pub const ROWS: &[Instruction] = &[
    plain(
        0xFFFF,
        "NOP",
        "no operation",
        Role::Standalone,
        "Does nothing and takes one step. It keeps room for an instruction to be put in later; a \
         cleared program memory consists of it.\n\n\
         ```il\n\
         LD X0\n\
         NOP\n\
         AND X1\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    plain(
        0x000F,
        "END",
        "end of program",
        Role::Standalone,
        "Ends the program: the outputs are refreshed, the watchdog is restarted, and the next scan \
         begins at step 0. Every program needs it once, and nothing after it is executed.\n\n\
         ```il\n\
         LD X0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
];

/// The row of a label, a word such as `P0` or `I001` that stands alone on its line. A label has no mnemonic, so it is
/// not among the instructions that a word can name; it has steps, a code and a page like them.
pub static LABEL: Instruction = Instruction {
    operands: &[operand("P", "pointer", Access::Read, Accepts::P.or(Accepts::I))],
    opcode: Opcode::Label,
    semantics: Semantics::Basic,
    ..plain(
        0xB000,
        "label",
        "label",
        Role::Standalone,
        "Marks the place to which CJ jumps, or at which a subroutine (P) or an interrupt routine (I) \
         begins. It stands alone on its line before the LD of a rung. Each label is used once in a \
         program; P63 always means END and is not written. Labels of subroutines and interrupts stand \
         behind FEND.\n\n\
         ```il\n\
         LD X0\n\
         CJ P0\n\
         LD X1\n\
         OUT Y0\n\
         P0\n\
         LD X2\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
};

/// The row of a word of program memory that is no instruction, as reading a PLC can find it: `NOP? H1234`. It is
/// written back as it is. People do not write it, so it is not among the instructions of the models.
pub static UNREAD: Instruction = Instruction {
    operands: &[operand("n", "word of program memory", Access::Read, Accepts::K).within(0, 0xFFFF)],
    opcode: Opcode::Itself,
    ..plain(
        0,
        "NOP?",
        "unread word",
        Role::Standalone,
        "Stands for a word of program memory that is no instruction of the model, as far as is known. It is \
         found where a program was read from a PLC or a file, and goes back there as it is. What the PLC \
         does with it is not known, so it cannot be simulated or translated.\n\n\
         ```il\n\
         LD X0\n\
         NOP? H01FF\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
};
