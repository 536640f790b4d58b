//! Instruction List of the FX family: one instruction a line, never failing.

mod tree;
pub use tree::{FxLine, FxTree, LineKind};
