//! The PLC as data: models, devices and their ranges, and one table row for every instruction.
//!
//! Everything that depends on what a PLC can do reads these tables; no other place matches on mnemonics.
//! The text of programs never enters, only single words: a mnemonic, an operand.

mod model;
pub use model::{Limits, Model, Target};

mod device;
pub use device::{Device, DeviceKind, DeviceRange, SpecialDevice};

mod latches;
pub use latches::{Latch, Latches};

mod operand;
pub use operand::{Constant, DirectAddress, Location, Operand, OperandProblem, Width};

mod symbols;
pub use symbols::{SymbolProblem, Symbols};

mod accepts;
pub use accepts::Accepts;

mod instruction;
pub use instruction::{
    Access, Counting, DeviceCodes, Drive, Extent, Form, Instruction, Opcode, OperandSpec, Role, Steps, Wide,
};

mod flow;
pub use flow::Flow;

pub mod outside;
pub use outside::{Outside, Port, PortKind};

pub mod semantics;
pub use semantics::{Execution, Fault, Semantics};

pub mod instructions;

mod fx;

pub mod iec;
