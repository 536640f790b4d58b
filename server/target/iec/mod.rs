//! What IEC 61131-3 defines: elementary types, literals, operators, standard functions and function blocks.

mod types;
pub use types::{ElementaryType, GenericType};

mod literal;
pub use literal::{Literal, LiteralProblem, LiteralValue};

mod operators;
pub use operators::{Modifiers, Operator, OperatorRole};

mod functions;
pub use functions::{Function, Parameter, ParameterType};

mod blocks;
pub use blocks::FunctionBlock;
