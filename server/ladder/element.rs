//! What stands on the wires of a rung.

use crate::target::{Form, Operand};
use crate::text::{Span, Spanned};

/// Index of an element in its graph.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct ElementId(pub u32);

/// One element of a rung with its operands.
#[derive(Clone, PartialEq, Debug)]
pub struct Element {
    /// What it is.
    pub kind: ElementKind,
    /// The cells of its symbol on the wire row (for a function block, of its first row), without operands above.
    pub span: Span,
    /// The line of the chunk, from 0, on which the power line runs through it.
    pub row: u32,
    /// Displayed cells of the symbol in that row, from 0: first, and one past the last.
    pub columns: (u32, u32),
    /// Its operands in order: the device of a contact or coil and, for timers and counters, the preset;
    /// both sides of a comparison; all operands of an instruction box.
    pub operands: Vec<Spanned<Operand>>,
    /// Where the operands stand.
    pub place: OperandPlace,
}

/// What an element is.
#[derive(Clone, PartialEq, Debug)]
pub enum ElementKind {
    /// A contact; one operand.
    Contact(ContactKind),
    /// A comparison of two operands, on for as long as it holds.
    Compare(CompareOperator),
    /// Inverts the power that reaches it.
    Invert,
    /// A coil; the device, and for timers and counters the preset.
    Coil(CoilKind),
    /// An instruction box, `[MOV K10 D0]`; `None` where the mnemonic is not known, its span beside it.
    Instruction {
        /// The instruction, if the table has it.
        form: Option<Form>,
        /// The mnemonic's cells.
        mnemonic: Span,
    },
    /// A function block drawn as a box.
    Block(Box<Block>),
    /// `-->>LABEL`, the label's cells.
    Jump(Span),
    /// `--<RETURN>`
    Return,
    /// `-->NAME>`: power goes on at the connector of that name.
    ConnectorOut(Span),
    /// `>NAME>--`: power comes from the connector of that name.
    ConnectorIn(Span),
}

/// Kinds of contact.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ContactKind {
    /// `| |`
    NormallyOpen,
    /// `|/|`
    NormallyClosed,
    /// `|P|`
    Rising,
    /// `|N|`
    Falling,
}

/// Kinds of coil.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum CoilKind {
    /// `( )`
    Plain,
    /// `(/)`
    Negated,
    /// `(S)`
    Set,
    /// `(R)`
    Reset,
    /// `(P)`
    Rising,
    /// `(N)`
    Falling,
}

/// Comparison operators; `wide` is the 32-bit form (`[D>= D0 K10]`).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum CompareOperator {
    Equal { wide: bool },
    NotEqual { wide: bool },
    Greater { wide: bool },
    Less { wide: bool },
    GreaterOrEqual { wide: bool },
    LessOrEqual { wide: bool },
}

/// A function block or function drawn as a box.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Block {
    /// The instance name above the box; `None` for a function.
    pub instance: Option<Span>,
    /// The type name on its first inside line.
    pub type_name: Option<Span>,
    /// All cells of the box, one span a row, top border first.
    pub rows: Vec<Span>,
    /// Input pins, top to bottom.
    pub inputs: Vec<Pin>,
    /// Output pins, top to bottom.
    pub outputs: Vec<Pin>,
}

/// A pin of a function block.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pin {
    /// The formal name inside the box, if written.
    pub name: Option<Span>,
    /// Whether a negation circle `O` stands at the edge.
    pub negated: bool,
    /// The line of the chunk, from 0.
    pub row: u32,
    /// What is connected.
    pub wire: PinWire,
}

/// What is connected to a pin.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum PinWire {
    /// A wire: the arc of the graph with this vertex and pin number.
    Power,
    /// A constant or variable written outside, beside the pin: index into the element's `operands`.
    Operand(usize),
    /// Nothing.
    Open,
}

/// Where the operands of an element stand.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum OperandPlace {
    /// Above the symbol (canonical for contacts and coils).
    Above,
    /// Below it.
    Below,
    /// Inside its brackets.
    Inside,
    /// Beside it on the wire row, as in function blocks.
    Beside,
}
