//! What only the FX family has: its models with their devices, and the spelling of its operands.

mod models;
pub(super) use models::{FX1N, FX1S, FX2N, FX3U};

mod ranges;

mod special_relays;

mod special_registers;

mod special;

mod operand;
pub(super) use operand::read;
