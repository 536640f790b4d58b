//! What a chunk of a ladder document says.

use super::Graph;
use crate::text::{Diagnostic, Span, Spanned};

/// One chunk: at most one network header, the comments above, and the rungs of one block of drawing lines.
/// All spans are offsets into the chunk.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct LadderTree {
    /// `NETWORK 3 'title'` or `LABEL:`.
    pub header: Option<NetworkHeader>,
    /// Comments and pragmas, delimiters included, in order.
    pub comments: Vec<Span>,
    /// The rungs, top to bottom.
    pub rungs: Vec<Rung>,
    /// What could not be read, found while reading.
    pub problems: Vec<Diagnostic>,
}

/// The line that starts and names a network.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct NetworkHeader {
    /// All of it.
    pub span: Span,
    /// The number after `NETWORK`.
    pub number: Option<Spanned<u32>>,
    /// The title, without quotes.
    pub title: Option<Span>,
    /// The label that jumps name, without colon.
    pub label: Option<Span>,
}

/// A rung: rows that vertical wires join.
#[derive(Clone, PartialEq, Debug)]
pub struct Rung {
    /// Vertices, wires and elements.
    pub graph: Graph,
    /// The number in the left margin, if written.
    pub number: Option<Spanned<u32>>,
    /// From the first cell of its first row to the last cell of its last row, names above included.
    pub span: Span,
    /// Lines of the chunk, from 0: first, and one past the last.
    pub lines: (u32, u32),
    /// The displayed column of the right rail in each wire row that has one, with its cell.
    pub right_rail: Vec<Spanned<u32>>,
}
