//! Programs in IEC 61131-3: instruction lists and drawings with declared variables.
//!
//! Every instance of a program unit has its variables and a body of its own, so places are known when the program is
//! compiled: BOOL variables are cells, and contacts between them are rows as those of relays. What is no BOOL is done
//! by the formulas of `target`, one calculation at a time. VAR_IN_OUT is another name for what is handed over.

mod kind;

mod place;

mod parts;
pub(super) use parts::Parts;
pub use parts::{Lies, Spot};

mod quick;

mod image;

mod names;
pub(super) use names::Leaf;

mod members;
pub use members::{HandedOver, Member, UnitVariables, joined};

mod scopes;

mod run;
pub(super) use run::{call_block, compute, copy, initialise, of_pattern, put, read, result_before, schedule};

mod written;

mod declarations;

mod kinds;

mod initial;

mod operand;

mod current;

mod list;

mod arguments;

mod call;

mod drawing;

mod configuration;

mod compile;
pub(super) use compile::compile;

mod adopt;
pub(super) use adopt::{adopt, blocks};
