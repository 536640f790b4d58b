//! A rung as the logic sees it, whatever it was written in.

use super::Path;
use crate::text::{Message, Span};
use smol_str::SmolStr;

/// A rung, or what stands between two. All spans are offsets into its chunk.
#[derive(Clone, PartialEq, Debug)]
pub struct Rung {
    /// The labels at its start, as jumps name them.
    pub labels: Vec<SmolStr>,
    /// The number and the title of the network that it begins, if it begins one.
    pub network: Option<Network>,
    /// The comments before and inside it, delimiters included, in order.
    pub comments: Vec<Span>,
    /// All of it without the comments and labels before it.
    pub span: Span,
    /// Whether it is written as instruction list, also where a drawing carries it along in a box `{il … }`.
    pub is_list: bool,
    /// What it does; nothing if there are only comments and labels.
    pub path: Result<Option<Path>, Refusal>,
}

/// How a network is named.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Network {
    /// Its number, if written.
    pub number: Option<u32>,
    /// Its title, empty if there is none.
    pub title: SmolStr,
}

/// Why a rung has no [`Path`].
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Refusal {
    /// A word, a cell or an operand of it cannot be read.
    Unreadable,
    /// An instruction wants a current result, and nothing is loaded.
    NoCurrentResult,
    /// ANB or ORB has no two blocks, or a block is left open at an output.
    Blocks,
    /// MPS, MRD and MPP do not pair.
    Branches,
    /// Something is put in parallel with what already drives an output, or has left a branch.
    ParallelToBranch,
    /// Contacts lead to no output.
    WithoutOutput,
    /// Connections nest deeper than any PLC takes.
    TooDeep,
    /// A wire that meets nothing.
    OpenCircuit,
    /// A branch of wire alone.
    ShortCircuit,
    /// Neither series nor parallel.
    Bridge,
    /// An output stands before contacts, or its branch joins others behind it.
    BehindOutput,
    /// A function block or a connector, which this reader does not take.
    Element,
    /// It calls by this name what nothing declares.
    Callee(SmolStr),
    /// It calls the block or function of this name with other parameters than are declared.
    Parameters(SmolStr),
    /// Arithmetic on the current result, a jump into a block, and what else has no drawing.
    NotBoolean,
    /// It has a device or an instruction for which the other language has nothing.
    NoCounterpart,
}

impl Refusal {
    /// The sentence that says it.
    pub fn message(&self) -> Message {
        Message::new(match self {
            Refusal::Callee(word) => return Message::new("logic.callee").with("word", word),
            Refusal::Parameters(word) => return Message::new("logic.parameters").with("word", word),
            Refusal::Unreadable => "logic.unreadable",
            Refusal::NoCurrentResult => "logic.no-current-result",
            Refusal::Blocks => "logic.blocks",
            Refusal::Branches => "logic.branches",
            Refusal::ParallelToBranch => "logic.parallel-to-branch",
            Refusal::WithoutOutput => "logic.without-output",
            Refusal::TooDeep => "logic.too-deep",
            Refusal::OpenCircuit => "logic.open-circuit",
            Refusal::ShortCircuit => "logic.short-circuit",
            Refusal::Bridge => "logic.bridge",
            Refusal::BehindOutput => "logic.behind-output",
            Refusal::Element => "logic.element",
            Refusal::NotBoolean => "logic.not-boolean",
            Refusal::NoCounterpart => "logic.no-counterpart",
        })
    }
}
