//! Why a program cannot be run.

use super::code::Place;
use crate::logic::Refusal;
use crate::target::{Device, Form};
use crate::text::Message;

/// Something that keeps a program from running.
#[derive(Clone, PartialEq, Debug)]
pub struct Problem {
    /// Where it stands.
    pub place: Place,
    /// What it is.
    pub obstacle: Obstacle,
}

/// What keeps a program from running.
#[derive(Clone, PartialEq, Debug)]
pub enum Obstacle {
    /// A rung that says nothing that could be run.
    Refusal(Refusal),
    /// What stands there is no instruction, as this sentence says.
    Unread(Message),
    /// A word or an operand that cannot be read, or that the instruction does not take.
    Unreadable,
    /// A contact without anything that it could be in series or in parallel with.
    NoCurrentResult,
    /// ANB or ORB without a block.
    Blocks,
    /// MRD or MPP without MPS.
    Branches,
    /// FOR without NEXT, or NEXT without FOR.
    Loop,
    /// The PLC has no such device.
    NoDevice(Device),
    /// A jump to a label that is not there.
    NoLabel(Device),
    /// A timer or counter without a preset.
    NoPreset,
    /// The simulator does not know what this instruction does.
    NoSimulation(Form),
    /// Something of a program in IEC 61131-3, said by this sentence.
    Iec(Message),
    /// What comes of another problem that is told, such as a variable whose declaration is refused. It is never told.
    Follows,
    /// The program has more contacts that remember something than fit into memory.
    TooLarge,
}

impl Obstacle {
    /// The sentence that says it.
    pub fn message(&self) -> Message {
        match self {
            Obstacle::Refusal(refusal) => refusal.message(),
            Obstacle::Unreadable | Obstacle::Follows => Message::new("simulate.unreadable"),
            Obstacle::NoCurrentResult => Refusal::NoCurrentResult.message(),
            Obstacle::Blocks => Refusal::Blocks.message(),
            Obstacle::Branches => Refusal::Branches.message(),
            Obstacle::Loop => Message::new("simulate.loop"),
            Obstacle::NoDevice(device) => Message::new("simulate.no-device").with("device", device),
            Obstacle::NoLabel(label) => Message::new("simulate.no-label").with("label", label),
            Obstacle::NoPreset => Message::new("simulate.no-preset"),
            Obstacle::NoSimulation(form) => {
                Message::new("simulate.no-simulation").with("word", form.mnemonic())
            }
            Obstacle::Unread(message) | Obstacle::Iec(message) => message.clone(),
            Obstacle::TooLarge => Message::new("simulate.too-large"),
        }
    }
}
