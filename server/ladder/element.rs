//! What stands on the wires of a rung.

use super::ldmicro::{BoxKind, time_literal};
use crate::target::iec::{Literal, LiteralValue};
use crate::target::{Device, Form, Operand, Role};
use crate::text::{Span, Spanned};
use std::borrow::Cow;

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
    /// The lines of a name that is written over several lines, top to bottom, the last one being the first operand's
    /// span; empty for a name on one line. [`Element::operand_text`] joins them.
    pub name_lines: Vec<Span>,
    /// Further words above or below that are no operands, such as a description over a device.
    pub notes: Vec<Span>,
}

impl Element {
    /// An element without operands.
    pub fn new(kind: ElementKind, span: Span, row: u32, columns: (u32, u32)) -> Element {
        Element {
            kind,
            span,
            row,
            columns,
            operands: Vec::new(),
            place: OperandPlace::Above,
            name_lines: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The device of a contact or coil, the first operand's device of an instruction box.
    pub fn device(&self) -> Option<Device> {
        self.operands.first().and_then(|operand| operand.value.device())
    }

    /// Whether it acts on the program and passes power on unchanged: coils, instruction boxes, jumps, returns and
    /// outgoing connectors. Function blocks stand between conditions and outputs and are neither.
    pub fn is_output(&self) -> bool {
        match &self.kind {
            ElementKind::Coil(_)
            | ElementKind::Jump(_)
            | ElementKind::Return
            | ElementKind::ConnectorOut(_) => true,
            ElementKind::Instruction { form, .. } => {
                form.is_none_or(|form| matches!(form.instruction.role, Role::Output | Role::Standalone))
            }
            _ => false,
        }
    }

    /// Whether it is a condition: a contact, also a comparing one.
    pub fn is_contact(&self) -> bool {
        matches!(self.kind, ElementKind::Contact(_) | ElementKind::Compare(_))
    }

    /// The function block, if it is one.
    pub fn block(&self) -> Option<&Block> {
        match &self.kind {
            ElementKind::Block(block) => Some(block),
            _ => None,
        }
    }

    /// The words of operand `index` in `chunk`. A name over several lines is joined by `_`,
    /// so that `START` over `BUTTON` is the variable `START_BUTTON`.
    pub fn operand_text<'t>(&self, index: usize, chunk: &'t str) -> Cow<'t, str> {
        if index > 0 || self.name_lines.len() < 2 {
            let Some(operand) = self.operands.get(index) else { return Cow::Borrowed("") };
            let word = operand.span.of(chunk);
            return match operand.value {
                // An LDmicro export writes `1.000 s` and draws a gap for a contact that is never on.
                Operand::Literal(Literal { value: LiteralValue::Time(_), .. }) if !word.contains('#') => {
                    time_literal(word).map_or(Cow::Borrowed(word), Cow::Owned)
                }
                Operand::Literal(Literal { value: LiteralValue::Bool(false), .. })
                    if word.starts_with('+') =>
                {
                    Cow::Borrowed("FALSE")
                }
                _ => Cow::Borrowed(word),
            };
        }
        let mut name = String::new();
        for line in &self.name_lines {
            if !name.is_empty() && !name.ends_with(['_', '.']) {
                name.push('_');
            }
            name.push_str(line.of(chunk));
        }
        Cow::Owned(name)
    }
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

impl ElementKind {
    /// Whether power starts at this element without a wire to it.
    pub fn is_source(&self) -> bool {
        match self {
            ElementKind::ConnectorIn(_) => true,
            ElementKind::Block(block) => block.inputs.iter().all(|pin| pin.wire != PinWire::Power),
            _ => false,
        }
    }

    /// Whether power may end at this element without a wire from it.
    pub fn is_sink(&self) -> bool {
        match self {
            ElementKind::Jump(_) | ElementKind::Return | ElementKind::ConnectorOut(_) => true,
            ElementKind::Block(block) => block.outputs.iter().all(|pin| pin.wire != PinWire::Power),
            _ => false,
        }
    }
}

impl ContactKind {
    /// All of them, the commonest first.
    pub const ALL: [ContactKind; 4] =
        [ContactKind::NormallyOpen, ContactKind::NormallyClosed, ContactKind::Rising, ContactKind::Falling];

    /// The character that tells it in a drawing; a blank for a normally open one.
    pub fn mark(self) -> char {
        match self {
            ContactKind::NormallyOpen => ' ',
            ContactKind::NormallyClosed => '/',
            ContactKind::Rising => 'P',
            ContactKind::Falling => 'N',
        }
    }
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
    /// `(T)`: turns its device over when power comes, as the toggling coil of LDmicro and ALTP do.
    Toggle,
}

impl CoilKind {
    /// All of them, the plain one first.
    pub const ALL: [CoilKind; 7] = [
        CoilKind::Plain,
        CoilKind::Negated,
        CoilKind::Set,
        CoilKind::Reset,
        CoilKind::Rising,
        CoilKind::Falling,
        CoilKind::Toggle,
    ];

    /// The character that tells it in a drawing; a blank for a plain one.
    pub fn mark(self) -> char {
        match self {
            CoilKind::Plain => ' ',
            CoilKind::Negated => '/',
            CoilKind::Set => 'S',
            CoilKind::Reset => 'R',
            CoilKind::Rising => 'P',
            CoilKind::Falling => 'N',
            CoilKind::Toggle => 'T',
        }
    }
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

impl CompareOperator {
    /// The operator and function of IEC 61131-3 that compares so.
    pub const fn iec_name(self) -> &'static str {
        match self {
            CompareOperator::Equal { .. } => "EQ",
            CompareOperator::NotEqual { .. } => "NE",
            CompareOperator::Greater { .. } => "GT",
            CompareOperator::Less { .. } => "LT",
            CompareOperator::GreaterOrEqual { .. } => "GE",
            CompareOperator::LessOrEqual { .. } => "LE",
        }
    }

    /// All of them, each in both widths.
    pub const ALL: [CompareOperator; 12] = {
        use CompareOperator::*;
        [
            Equal { wide: false },
            Equal { wide: true },
            NotEqual { wide: false },
            NotEqual { wide: true },
            Greater { wide: false },
            Greater { wide: true },
            Less { wide: false },
            Less { wide: true },
            GreaterOrEqual { wide: false },
            GreaterOrEqual { wide: true },
            LessOrEqual { wide: false },
            LessOrEqual { wide: true },
        ]
    };

    /// The operator that holds where this one does not.
    pub fn opposite(self) -> CompareOperator {
        use CompareOperator::*;
        match self {
            Equal { wide } => NotEqual { wide },
            NotEqual { wide } => Equal { wide },
            Greater { wide } => LessOrEqual { wide },
            Less { wide } => GreaterOrEqual { wide },
            GreaterOrEqual { wide } => Less { wide },
            LessOrEqual { wide } => Greater { wide },
        }
    }

    /// What it compares for, as the LD>= family of instructions spells it; the 32-bit form has a D before it.
    pub fn sign(self) -> &'static str {
        match self {
            CompareOperator::Equal { .. } => "=",
            CompareOperator::NotEqual { .. } => "<>",
            CompareOperator::Greater { .. } => ">",
            CompareOperator::Less { .. } => "<",
            CompareOperator::GreaterOrEqual { .. } => ">=",
            CompareOperator::LessOrEqual { .. } => "<=",
        }
    }

    /// The same for numbers of 32 bits, or of 16.
    pub fn in_width(self, wide: bool) -> CompareOperator {
        use CompareOperator::*;
        match self {
            Equal { .. } => Equal { wide },
            NotEqual { .. } => NotEqual { wide },
            Greater { .. } => Greater { wide },
            Less { .. } => Less { wide },
            GreaterOrEqual { .. } => GreaterOrEqual { wide },
            LessOrEqual { .. } => LessOrEqual { wide },
        }
    }

    /// Whether it compares 32 bits.
    pub fn is_wide(self) -> bool {
        use CompareOperator::*;
        let (Equal { wide }
        | NotEqual { wide }
        | Greater { wide }
        | Less { wide }
        | GreaterOrEqual { wide }
        | LessOrEqual { wide }) = self;
        wide
    }
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
    /// Which box of an LDmicro export it is, if it is one: its cells are brackets, not a frame.
    pub ldmicro: Option<&'static BoxKind>,
}

impl Block {
    /// The name of its type or function.
    pub fn type_text<'t>(&self, chunk: &'t str) -> Option<&'t str> {
        match self.ldmicro {
            Some(kind) => Some(kind.type_name),
            None => self.type_name.map(|name| name.of(chunk)),
        }
    }
}

/// A pin of a function block.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pin {
    /// The formal name inside the box, if written.
    pub name: Option<Span>,
    /// The formal name that the box stands for without writing it; empty where there is none.
    pub implied: &'static str,
    /// Whether a negation circle `O` stands at the edge.
    pub negated: bool,
    /// The line of the chunk, from 0.
    pub row: u32,
    /// What is connected.
    pub wire: PinWire,
}

impl Pin {
    /// The formal name, written or implied; empty if it has none.
    pub fn formal<'t>(&self, chunk: &'t str) -> &'t str {
        self.name.map_or(self.implied, |name| name.of(chunk))
    }
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
