//! What IEC 61131-3 defines: elementary types, literals, operators, standard functions and function blocks.

mod types;
pub use types::{ElementaryType, GenericType};

mod names;
pub use names::{KEYWORDS, is_identifier, is_keyword};

mod literal;
pub use literal::{Literal, LiteralProblem, LiteralValue, characters_of, real_spelled, shortest, spelled};

mod operand;
pub(super) use operand::read_operand;

mod page;

mod operators;
pub use operators::{Modifiers, Operator, OperatorRole, Written};

mod functions;
pub use functions::{EN, ENO, Function, Parameter, ParameterType};

mod conversions;

mod blocks;
pub use blocks::FunctionBlock;

pub mod semantics;
pub use semantics::{Datum, Formula, Inputs, Instance, Kernel, Working};

mod suggest;
pub use suggest::{nearest, suggestions};

/// What `find` knows about `word` in upper case. Names here are ASCII and at most 32 bytes long; other words are
/// not looked up, so no look-up allocates.
fn folded<T>(word: &str, find: impl FnOnce(&str) -> Option<T>) -> Option<T> {
    let mut upper = [0u8; 32];
    let upper = upper.get_mut(..word.len())?;
    upper.copy_from_slice(word.as_bytes());
    upper.make_ascii_uppercase();
    find(std::str::from_utf8(upper).ok()?)
}
