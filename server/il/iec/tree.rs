//! The tree of a chunk: flat records with offsets, no heap node for each token.
//!
//! Lists that belong to an item stand in one vector for each kind of record, and the item names its [`Run`] there.
//! Parentheses are not nested records but pairs of items, so that no depth of nesting can exhaust the stack.

use crate::target::Operand;
use crate::target::iec::{ElementaryType, Operator};
use crate::text::{Diagnostic, Span, Spanned};
use std::fmt;

/// One chunk of an IEC file. All spans are offsets into the chunk, all indices point into this tree.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct IecTree {
    /// Declarations and instructions in order; blank and comment lines leave no record.
    pub items: Vec<Item>,
    /// The operands of all instructions, addresses, bounds and constants.
    pub operands: Vec<Spanned<Operand>>,
    /// The parameters of all calls.
    pub parameters: Vec<Parameter>,
    /// The declarations of all sections, TYPE blocks and structures.
    pub declarations: Vec<Declaration>,
    /// Names declared together, `a` and `b` in `a, b : BOOL;`, and the names of enumerations.
    pub names: Vec<Span>,
    /// Types as written.
    pub types: Vec<Spanned<TypeSpec>>,
    /// Initial values, each record followed by those inside it.
    pub values: Vec<InitialValue>,
    /// TASK declarations.
    pub tasks: Vec<Task>,
    /// PROGRAM declarations of configurations.
    pub instances: Vec<Instance>,
    /// Comments, delimiters included, in order.
    pub comments: Vec<Span>,
    /// Pragmas, braces included, in order.
    pub pragmas: Vec<Span>,
    /// What could not be read, and what is read although the standard's grammar does not allow it.
    pub problems: Vec<Diagnostic>,
}

/// A range in one of the vectors of the tree.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Run {
    /// Index of the first record.
    pub start: u32,
    /// One past the last.
    pub end: u32,
}

/// Index in [`IecTree::operands`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct OperandId(pub u32);

/// Index in [`IecTree::types`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct TypeId(pub u32);

/// A declaration, an instruction, or the start or end of something.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Item {
    /// All of it: for sections and calls to the closing word or parenthesis, if there is one.
    pub span: Span,
    /// How many parentheses are open around it; 0 outside of any. `(` counts for what follows it, not for itself.
    pub depth: u32,
    /// What it is.
    pub kind: ItemKind,
}

/// What an item is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ItemKind {
    /// `PROGRAM name`, `FUNCTION_BLOCK name`, `FUNCTION name : type`.
    Pou {
        /// Which keyword.
        kind: PouKind,
        /// The name, unless it is missing.
        name: Option<Span>,
        /// The type of a function's result.
        result: Option<TypeId>,
    },
    /// `END_PROGRAM` and its kin.
    PouEnd(PouKind),
    /// A section of variables, `VAR` to `END_VAR`.
    Section {
        /// Which keyword.
        kind: SectionKind,
        /// `CONSTANT`.
        constant: bool,
        /// `RETAIN` is true, `NON_RETAIN` false.
        retain: Option<bool>,
        /// In [`IecTree::declarations`].
        declarations: Run,
    },
    /// `TYPE` to `END_TYPE`; each declaration has one name and its type.
    Types {
        /// In [`IecTree::declarations`].
        declarations: Run,
    },
    /// `CONFIGURATION name`.
    Configuration {
        /// The name, unless it is missing.
        name: Option<Span>,
    },
    /// `RESOURCE name ON type`.
    Resource {
        /// The name, unless it is missing.
        name: Option<Span>,
        /// The type of the resource.
        on: Option<Span>,
    },
    /// A TASK; index in [`IecTree::tasks`].
    Task(u32),
    /// A PROGRAM of a configuration; index in [`IecTree::instances`].
    Instance(u32),
    /// `END_CONFIGURATION`, `END_RESOURCE`.
    End(FileKeyword),
    /// `name:` before an instruction or alone; the span of the item includes the colon.
    Label {
        /// The name.
        name: Span,
    },
    /// An operator with its operand, if it has one: `LD a`, `ANDN b`, `S Motor`, `NOT`.
    Operation {
        /// The operator.
        operation: Operation,
        /// The operand.
        operand: Option<OperandId>,
    },
    /// `AND(` or `AND( a`; a [`ItemKind::Close`] at the same depth ends it.
    Open {
        /// The operator, done at the closing parenthesis.
        operation: Operation,
        /// What a load inside the parentheses would load first.
        operand: Option<OperandId>,
    },
    /// `)` of an operator or of a parameter; not that of a call. An unclosed one has none.
    Close,
    /// `JMP label`.
    Jump {
        /// The word.
        word: Span,
        /// When it is done.
        condition: Condition,
        /// The label, unless it is missing.
        label: Option<Span>,
    },
    /// `RET`.
    Return {
        /// The word.
        word: Span,
        /// When it is done.
        condition: Condition,
    },
    /// `CAL instance (…)`. The items of parameters that are instruction lists follow it.
    Call {
        /// The word.
        word: Span,
        /// When it is done.
        condition: Condition,
        /// The instance, or a function called so.
        callee: Option<OperandId>,
        /// How the parameters are written.
        form: ListForm,
        /// In [`IecTree::parameters`].
        parameters: Run,
    },
    /// `LIMIT a, 5` or `LIMIT(MN := 1, …)`: a function, or a word that is none. Its result is the current result.
    /// The items of parameters that are instruction lists follow it.
    Function {
        /// The name; members before it (`FB.Method`) included.
        name: Span,
        /// How the parameters are written. [`ListForm::None`] stands for operands without parentheses, whose first
        /// parameter is the current result; in the other forms it is not passed.
        form: ListForm,
        /// In [`IecTree::parameters`].
        parameters: Run,
    },
    /// `CU C10`: calls the block with this one input set to the current result. `S` and `R` are operations, for only
    /// the operand's type tells.
    InputOperator {
        /// The name of the input.
        input: Span,
        /// The instance.
        instance: OperandId,
    },
    /// The start of a parameter that is an instruction list, after its call; a [`ItemKind::Close`] at the same depth
    /// ends it. The value of the parameter is the current result there.
    ParameterOpen {
        /// Index in [`IecTree::parameters`].
        parameter: u32,
    },
}

/// Kinds of program organisation units.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum PouKind {
    /// `PROGRAM`
    Program,
    /// `FUNCTION_BLOCK`
    FunctionBlock,
    /// `FUNCTION`
    Function,
}

/// What encloses resources.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum FileKeyword {
    /// `CONFIGURATION`
    Configuration,
    /// `RESOURCE`
    Resource,
}

/// Kinds of variable sections.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum SectionKind {
    /// `VAR`
    Local,
    /// `VAR_INPUT`
    Input,
    /// `VAR_OUTPUT`
    Output,
    /// `VAR_IN_OUT`
    InOut,
    /// `VAR_EXTERNAL`
    External,
    /// `VAR_TEMP`
    Temporary,
    /// `VAR_GLOBAL`
    Global,
    /// `VAR_ACCESS`
    Access,
    /// `VAR_CONFIG`
    Config,
}

impl SectionKind {
    /// Whether callers see its variables.
    pub fn is_parameter(self) -> bool {
        matches!(self, SectionKind::Input | SectionKind::Output | SectionKind::InOut)
    }

    /// Whether its variables are those of the whole program: declared for all, or taken from there.
    pub fn is_global(self) -> bool {
        matches!(self, SectionKind::Global | SectionKind::External)
    }
}

/// An operator as written.
#[derive(Clone, Copy)]
pub struct Operation {
    /// The row of the table.
    pub operator: &'static Operator,
    /// The modifier `N`.
    pub negated: bool,
    /// The word as written, modifier included, parenthesis left out.
    pub word: Span,
}

impl PartialEq for Operation {
    fn eq(&self, other: &Operation) -> bool {
        self.operator.name == other.operator.name && self.negated == other.negated && self.word == other.word
    }
}

impl fmt::Debug for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}@{:?}", self.operator.name, if self.negated { "N" } else { "" }, self.word)
    }
}

/// When a jump, call or return is done.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Condition {
    /// Always.
    Always,
    /// `C`: if the current result is 1.
    IfTrue,
    /// `CN`: if the current result is 0.
    IfFalse,
}

/// How a list of parameters is written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ListForm {
    /// No parentheses.
    None,
    /// Values in the order of the declaration: `(a, b)`.
    NonFormal,
    /// Names with values: `(IN := a, Q => b)`; also the empty pair.
    Formal,
}

/// One parameter of a call.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Parameter {
    /// All of it, without the comma.
    pub span: Span,
    /// The name in a formal list.
    pub name: Option<Span>,
    /// Which way the value goes.
    pub direction: Direction,
    /// The value.
    pub value: ParameterValue,
}

/// Which way the value of a parameter goes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Direction {
    /// `name := value`, or an operand of a non-formal list: outputs are positional too, only the declaration tells.
    In,
    /// `name => variable`, and `NOT name => variable`.
    Out {
        /// `NOT`.
        negated: bool,
    },
}

/// The value of a parameter.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ParameterValue {
    /// An operand; for [`Direction::Out`] a variable.
    Operand(OperandId),
    /// The instruction list that an [`ItemKind::ParameterOpen`] starts.
    Instructions,
    /// Nothing could be read.
    Missing,
}

/// One declaration: names with a type.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Declaration {
    /// From the first name to the last word, without the semicolon.
    pub span: Span,
    /// In [`IecTree::names`]; empty for `VAR_CONFIG`.
    pub names: Run,
    /// `AT %IX0.0`.
    pub address: Option<OperandId>,
    /// The variable that `VAR_ACCESS` opens or `VAR_CONFIG` configures: `resource.program.block.variable`.
    pub path: Option<Span>,
    /// The type, unless it could not be read.
    pub declared: Option<TypeId>,
    /// `R_EDGE`, `F_EDGE`.
    pub edge: Option<Edge>,
    /// `READ_ONLY` is false, `READ_WRITE` true.
    pub writable: Option<bool>,
    /// The initial value, index in [`IecTree::values`].
    pub initial: Option<u32>,
}

/// The edge that an input detects.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Edge {
    /// `R_EDGE`
    Rising,
    /// `F_EDGE`
    Falling,
}

/// A type as written; the span beside it is the whole of it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum TypeSpec {
    /// `BOOL`, and `STRING` without length.
    Elementary(ElementaryType),
    /// The name of a type or a function block; the span is the name.
    Named,
    /// `STRING[20]`, `WSTRING[20]`.
    Text {
        /// `WSTRING`.
        wide: bool,
        /// The length.
        length: OperandId,
    },
    /// `INT(0..9)`.
    Subrange {
        /// The type before the parenthesis.
        base: TypeId,
        /// Least value.
        least: OperandId,
        /// Greatest value.
        greatest: OperandId,
    },
    /// `(Red, Green)`.
    Enumeration {
        /// In [`IecTree::names`].
        values: Run,
    },
    /// `ARRAY[0..3, 1..2] OF INT`.
    Array {
        /// In [`IecTree::operands`]: pairs of least and greatest index, one pair for each dimension.
        bounds: Run,
        /// The type of the elements.
        element: TypeId,
    },
    /// `STRUCT` to `END_STRUCT`.
    Structure {
        /// In [`IecTree::declarations`].
        fields: Run,
    },
    /// `REF_TO INT`, of the third edition.
    Reference {
        /// The type referred to.
        target: TypeId,
    },
}

/// An initial value; the records of what is inside it follow it directly.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct InitialValue {
    /// All of it.
    pub span: Span,
    /// The name of the field, inside a structure.
    pub field: Option<Span>,
    /// What it is.
    pub kind: ValueKind,
    /// Index in [`IecTree::values`] one past the last record inside it.
    pub end: u32,
}

/// What an initial value is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ValueKind {
    /// A constant or an enumerated value.
    Constant(OperandId),
    /// `[1, 2, 3(0)]`, or `1, 2, 3(0)` without brackets as older texts write it.
    Array,
    /// `3(0)` inside an array: the values inside it are repeated. None inside stands for the default.
    Repeat {
        /// How often.
        count: OperandId,
    },
    /// `(x := 1, y := 2)`.
    Structure,
}

/// `TASK name (SINGLE := …, INTERVAL := …, PRIORITY := …);`
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Task {
    /// The name, unless it is missing.
    pub name: Option<Span>,
    /// Runs on the rising edge of this.
    pub single: Option<OperandId>,
    /// Runs with this period.
    pub interval: Option<OperandId>,
    /// 0 is the most urgent.
    pub priority: Option<OperandId>,
}

/// `PROGRAM name [WITH task] : type [(…)];`
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Instance {
    /// The name, unless it is missing.
    pub name: Option<Span>,
    /// `RETAIN` is true, `NON_RETAIN` false.
    pub retain: Option<bool>,
    /// The task.
    pub task: Option<Span>,
    /// The program.
    pub program: Option<Span>,
    /// In [`IecTree::parameters`]: `in := source`, `out => sink`; `block WITH task` is in `block_tasks`.
    pub parameters: Run,
    /// In [`IecTree::names`]: pairs of a function block instance and its task.
    pub block_tasks: Run,
}

impl Run {
    /// The records of the run in the vector that it belongs to.
    pub fn of<T>(self, records: &[T]) -> &[T] {
        records.get(self.start as usize..self.end as usize).unwrap_or(&[])
    }

    /// How many.
    pub fn len(self) -> usize {
        self.end.saturating_sub(self.start) as usize
    }

    /// Whether there are none.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }
}

impl IecTree {
    /// An operand of this tree.
    pub fn operand(&self, id: OperandId) -> Spanned<Operand> {
        self.operands[id.0 as usize]
    }

    /// A type of this tree.
    pub fn type_spec(&self, id: TypeId) -> Spanned<TypeSpec> {
        self.types[id.0 as usize]
    }

    /// The value records directly inside record `index` of [`IecTree::values`].
    pub fn values_inside(&self, index: u32) -> impl Iterator<Item = u32> + '_ {
        let end = self.values.get(index as usize).map_or(0, |value| value.end);
        std::iter::successors(Some(index + 1), |at| self.values.get(*at as usize).map(|value| value.end))
            .take_while(move |at| *at < end)
    }
}
