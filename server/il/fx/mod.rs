//! Instruction List of the FX family: one instruction a line, never failing.
//!
//! The way of a text: [`split`] cuts it into rungs, [`parse`] reads a rung into an [`FxTree`], [`format`](format())
//! prints it canonically, [`steps`] counts its program steps.
//!
//! The language is a list of lines, a mnemonic and its words each, without nesting. So the lexer is generated, and
//! the parser behind it is a loop over tokens by hand: measured on the same texts it is much faster than parser
//! combinators, and each recovery is a line of it that can be read.

mod lexer;

mod parser;
pub use parser::parse;

mod split;
pub use split::split;

mod format;
pub use format::{FormatOptions, format, format_chunk, format_chunks};

mod tree;
pub use tree::{FxLine, FxTree, LineKind, WordKind, steps};
