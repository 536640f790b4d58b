//! What an instruction does to the order of execution: jumps, loops, sections, steps, the end.

use super::{Instruction, Opcode, Role};

/// The part of an instruction in the structure of a program.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Flow {
    /// CJ: goes on at a label.
    Jump,
    /// CALL: executes the subroutine at a label.
    Call,
    /// SRET: ends a subroutine.
    SubroutineEnd,
    /// IRET: ends an interrupt routine.
    InterruptEnd,
    /// EI: allows interrupts.
    InterruptsAllowed,
    /// FOR.
    LoopBegin,
    /// NEXT.
    LoopEnd,
    /// MC.
    SectionBegin,
    /// MCR.
    SectionEnd,
    /// STL.
    Step,
    /// RET.
    StepsEnd,
    /// FEND: ends the main program.
    MainEnd,
    /// END.
    ProgramEnd,
    /// REF, REFF: reads inputs, or sends outputs, in the middle of the scan.
    Refresh,
    /// NOP: does nothing and may stand anywhere; a word that is no instruction is taken for one.
    Nothing,
    /// Everything else: executed in its turn.
    Straight,
}

impl Instruction {
    /// Its part in the structure of a program, told by its code.
    pub fn flow(&self) -> Flow {
        match self.opcode {
            Opcode::Function(0) => Flow::Jump,
            Opcode::Function(1) => Flow::Call,
            Opcode::Function(2) => Flow::SubroutineEnd,
            Opcode::Function(3) => Flow::InterruptEnd,
            Opcode::Function(4) => Flow::InterruptsAllowed,
            Opcode::Function(6) => Flow::MainEnd,
            Opcode::Function(8) => Flow::LoopBegin,
            Opcode::Function(9) => Flow::LoopEnd,
            Opcode::Function(50 | 51) => Flow::Refresh,
            Opcode::Device(0x000A) => Flow::SectionBegin,
            Opcode::Device(0x000B) => Flow::SectionEnd,
            Opcode::Contact { class: 15, .. } => Flow::Step,
            Opcode::Word(0xF7FF) => Flow::StepsEnd,
            Opcode::Word(0x000F) => Flow::ProgramEnd,
            Opcode::Word(0xFFFF) | Opcode::Itself => Flow::Nothing,
            _ => Flow::Straight,
        }
    }

    /// Whether it writes its first operand to its last one, as it is: MOV, told by its code.
    pub fn copies(&self) -> bool {
        self.opcode == Opcode::Function(12)
    }

    /// Whether it switches off what it names: ZRST, told by its code.
    pub fn clears(&self) -> bool {
        self.opcode == Opcode::Function(40)
    }

    /// Whether it is a contact that conducts while its device is off: LDI, ANI, ORI, told by their code.
    pub fn is_inverse_contact(&self) -> bool {
        matches!(self.opcode, Opcode::Contact { class: 3 | 5 | 7, .. })
    }

    /// Whether it is a contact that compares its device with that of its last execution: LDP, ANDF and their kin,
    /// told by their code.
    pub fn is_edge_contact(&self) -> bool {
        matches!(self.role, Role::Load | Role::Series | Role::Parallel)
            && matches!(self.opcode, Opcode::Device(_))
    }
}
