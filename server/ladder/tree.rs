//! What a chunk of a ladder document says.

use super::{Element, Graph};
use crate::target::Operand;
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
    /// What this chunk tells of the document's habit of placing names.
    pub names: NameHabit,
}

/// Where a drawing puts its names, counted by the names for which only one place is possible.
///
/// A document adds up the habits of its chunks and passes the sum as a hint to [`parse_with`](super::parse_with);
/// only chunks that are [undecided](NameHabit::decided) themselves read differently for it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct NameHabit {
    /// Names that can only belong to an element below them.
    pub above: u32,
    /// Names that can only belong to an element above them.
    pub below: u32,
}

impl NameHabit {
    /// Whether names stand below their elements; nothing if as many speak for the one as for the other.
    pub fn decided(self) -> Option<bool> {
        (self.above != self.below).then_some(self.below > self.above)
    }
}

impl std::ops::AddAssign for NameHabit {
    fn add_assign(&mut self, other: NameHabit) {
        self.above += other.above;
        self.below += other.below;
    }
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

/// An operand where it stands in a rung.
#[derive(Clone, Copy, Debug)]
pub struct Mention<'t> {
    /// The element that it belongs to.
    pub element: &'t Element,
    /// Its place in the element's operands, from 0.
    pub index: usize,
    /// The operand and its cells.
    pub operand: &'t Spanned<Operand>,
}

impl Rung {
    /// All operands, element by element in the order in which the elements were drawn: row by row, left to right.
    pub fn mentions(&self) -> impl Iterator<Item = Mention<'_>> {
        self.graph.elements.iter().flat_map(|element| {
            let operands = element.operands.iter().enumerate();
            operands.map(move |(index, operand)| Mention { element, index, operand })
        })
    }
}

impl LadderTree {
    /// All operands of all rungs, top to bottom.
    pub fn mentions(&self) -> impl Iterator<Item = Mention<'_>> {
        self.rungs.iter().flat_map(Rung::mentions)
    }
}
