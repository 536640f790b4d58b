//! Instruction List of IEC 61131-3: declarations and bodies, never failing.
//!
//! A document is cut into chunks by [`split`]; each chunk is read alone by [`parse`] into an [`IecTree`], whose flat
//! items of all chunks, one after the other, are the file. A program starts in one chunk and ends in a later one, so
//! no tree knows in which program unit it stands: whoever walks the items of a file in order does.

mod tree;
pub use tree::{
    Condition, Declaration, Direction, Edge, FileKeyword, IecTree, InitialValue, Instance, Item, ItemKind,
    ListForm, OperandId, Operation, Parameter, ParameterValue, PouKind, Run, SectionKind, Task, TypeId,
    TypeSpec, ValueKind,
};

mod mention;
pub use mention::{Mention, MentionRole, fold_case, same_name};

mod token;

mod scan;

mod grammar;

mod reader;

mod lower;

mod declare;

mod configure;

mod body;

mod instruct;

mod call;

mod split;
pub use split::split;

mod words;
pub use words::{words, words_of_body};

mod section;
pub use section::{SectionEnd, section_end};

mod parse;
pub use parse::parse;

mod layout;

mod format;
pub use format::{FormatOptions, format_chunk};
