//! Instruction List in both dialects: text to tree. Ladder is unknown here.

pub mod fx;

pub mod iec;
