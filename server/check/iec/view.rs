//! An IEC chunk with the scopes around it, and the types of its operands.

use crate::check::{ChunkContext, ProgramContext, ProgramFile};
use crate::document::{DeclaredType, Pou, Scopes, Variable};
use crate::il::iec::{Direction, IecTree, ItemKind, OperandId, Parameter, ParameterValue, PouKind};
use crate::target::iec::{ElementaryType, FunctionBlock, Literal, LiteralValue, OperatorRole};
use crate::target::{Operand, Width};
use crate::text::{Severity, Span};
use smol_str::SmolStr;

/// A chunk of IEC text in its surroundings. Offsets are those of the chunk.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The text of the chunk.
    pub text: &'a str,
    /// What it says.
    pub tree: &'a IecTree,
    /// What the document declares.
    pub scopes: &'a Scopes,
    /// The number of the POU in which it stands.
    pub pou: Option<usize>,
}

/// What is known about the type of a value.
#[derive(Clone, PartialEq, Debug)]
pub enum ValueType {
    /// An elementary type.
    Elementary(ElementaryType),
    /// A constant, which takes on the type that is expected if it fits.
    Literal(Literal),
    /// An instance of the function block with this folded name.
    Instance(SmolStr),
    /// Nothing, or a type that the rules do not judge.
    Unknown,
}

/// What a path such as `T1.Q` leads to.
#[derive(Clone, PartialEq, Debug)]
pub enum Place {
    /// A value of this type.
    Typed(DeclaredType),
    /// The first name is not declared.
    Undeclared,
    /// The last name of `span`, which ends with it, is no member of the type before it.
    NoMember {
        /// The name.
        member: Span,
        /// The type that lacks it.
        owner: DeclaredType,
    },
    /// Not known.
    Unknown,
}

/// What the first name of a path stands for.
#[derive(Clone, Copy, Debug)]
pub enum Root<'a> {
    /// A variable.
    Variable(&'a Variable),
    /// The result of the function in which the chunk stands.
    Result,
    /// Nothing that is declared.
    Undeclared,
}

impl<'a> View<'a> {
    /// The view of a chunk; `None` if it is not IEC text.
    pub fn of(context: &ChunkContext<'a>) -> Option<View<'a>> {
        let tree = context.chunk.iec()?;
        Some(View { text: context.chunk.text(), tree, scopes: context.scopes, pou: context.pou })
    }

    /// The POU in which it stands.
    pub fn pou(&self) -> Option<&'a Pou> {
        self.scopes.pous.get(self.pou?).map(|pou| &**pou)
    }

    /// The text of an operand.
    pub fn word(&self, id: OperandId) -> &'a str {
        self.tree.operand(id).span.of(self.text)
    }

    /// What the first name of `path` stands for.
    pub fn root(&self, path: &str) -> Root<'a> {
        let name = path.get(..root_length(path)).unwrap_or(path);
        match self.scopes.variable(self.pou, name) {
            Some(variable) => Root::Variable(variable),
            None => {
                let is_result =
                    |pou: &Pou| pou.kind == PouKind::Function && pou.name.eq_ignore_ascii_case(name);
                if self.pou().is_some_and(is_result) { Root::Result } else { Root::Undeclared }
            }
        }
    }

    /// Where the path that is operand `id` leads; only for variables.
    pub fn place(&self, id: OperandId) -> Place {
        let span = self.tree.operand(id).span;
        let path = span.of(self.text);
        if path.contains(|c: char| c.is_whitespace() || "*^(".contains(c)) {
            return Place::Unknown;
        }
        if let Some(declared) = self.scopes.type_of(self.pou, path) {
            return Place::Typed(declared);
        }
        let mut known = match self.root(path) {
            Root::Undeclared => return Place::Undeclared,
            _ => self.scopes.type_of(self.pou, &path[..root_length(path)]),
        };
        // The first member that is unknown is the one to speak about.
        for end in member_ends(path) {
            match self.scopes.type_of(self.pou, &path[..end]) {
                Some(declared) => known = Some(declared),
                None => {
                    let Some(owner) = known else { return Place::Unknown };
                    let start = path[..end].rfind(['.', '[']).unwrap_or(0);
                    let at = span.start as usize;
                    let is_member = path[start..].starts_with('.') && self.members_are_known(&owner);
                    return match is_member {
                        true => Place::NoMember { member: Span::new(at + start + 1, at + end), owner },
                        false => Place::Unknown,
                    };
                }
            }
        }
        Place::Unknown
    }

    /// Whether all members of a value of this type are known.
    fn members_are_known(&self, declared: &DeclaredType) -> bool {
        match declared {
            DeclaredType::Structure(_) => true,
            DeclaredType::Named(name) => self.is_block(name),
            _ => false,
        }
    }

    /// Whether `name`, folded, is a function block, standard or declared.
    pub fn is_block(&self, name: &str) -> bool {
        FunctionBlock::named(name).is_some()
            || self.scopes.pou_named(name).is_some_and(|pou| pou.kind == PouKind::FunctionBlock)
    }

    /// The type of a value that is declared so.
    pub fn value_of(&self, declared: DeclaredType) -> ValueType {
        match self.scopes.resolved(declared) {
            Some(DeclaredType::Elementary(kind)) => ValueType::Elementary(kind),
            Some(DeclaredType::Named(name)) if self.is_block(&name) => ValueType::Instance(name),
            _ => ValueType::Unknown,
        }
    }

    /// The type of operand `id`.
    pub fn value(&self, id: OperandId) -> ValueType {
        match self.tree.operand(id).value {
            Operand::Literal(Literal { value: LiteralValue::Enumerated, .. }) => ValueType::Unknown,
            Operand::Literal(literal) => ValueType::Literal(literal),
            // Wider addresses hold whatever type is written there.
            Operand::Direct(address) if address.width == Width::Bit => {
                ValueType::Elementary(ElementaryType::Bool)
            }
            Operand::Variable => match self.place(id) {
                Place::Typed(declared) => self.value_of(declared),
                _ => ValueType::Unknown,
            },
            _ => ValueType::Unknown,
        }
    }

    /// The operands that the chunk writes, with the words of what writes them. Positional outputs are not among them.
    pub fn written(&self) -> impl Iterator<Item = OperandId> + 'a {
        let tree = self.tree;
        let stores = tree.items.iter().filter_map(|item| match item.kind {
            ItemKind::Operation { operation, operand } => operand.filter(|_| {
                matches!(operation.operator.role, OperatorRole::Store | OperatorRole::Latch { .. })
            }),
            _ => None,
        });
        let lists = tree.items.iter().filter_map(|item| match item.kind {
            ItemKind::Call { parameters, .. } | ItemKind::Function { parameters, .. } => Some(parameters),
            _ => None,
        });
        let is_output = |parameter: &&Parameter| matches!(parameter.direction, Direction::Out { .. });
        let outputs = lists.flat_map(|run| run.of(&tree.parameters)).filter(is_output);
        let outputs = outputs.filter_map(|parameter| match parameter.value {
            ParameterValue::Operand(id) => Some(id),
            _ => None,
        });
        stores.chain(outputs)
    }

    /// Whether the reader has reported something in `span` or directly behind it, up to the end of the line.
    pub fn has_problem(&self, span: Span) -> bool {
        let end = span.end as usize;
        let rest = self.text.get(end..).and_then(|rest| rest.find('\n')).map_or(self.text.len(), |n| end + n);
        let problems = &self.tree.problems;
        let from = problems.partition_point(|problem| problem.span.start < span.start);
        let near = problems[from..].iter().take_while(|problem| problem.span.start as usize <= rest);
        near.into_iter().any(|problem| problem.severity == Severity::Error)
    }

    /// Whether the reader has reported something that starts where `span` does.
    pub fn has_problem_at(&self, span: Span) -> bool {
        self.tree.problems.binary_search_by_key(&span.start, |problem| problem.span.start).is_ok()
    }

    /// How many blanks and tabs stand before the first word of the line of `offset`.
    pub fn indentation(&self, offset: u32) -> &'a str {
        let head = self.text.get(..offset as usize).unwrap_or("");
        let line = &head[head.rfind('\n').map_or(0, |end| end + 1)..];
        &line[..line.len() - line.trim_start_matches([' ', '\t']).len()]
    }
}

impl ValueType {
    /// In words for a message: `INT`, `the constant 5` as `word`, `an instance of TON`.
    pub fn title(&self, word: &str) -> String {
        match self {
            ValueType::Elementary(kind) => kind.name().to_string(),
            ValueType::Literal(literal) => match literal.natural_type() {
                Some(kind) => kind.name().to_string(),
                None => word.to_string(),
            },
            ValueType::Instance(name) => name.to_ascii_uppercase(),
            ValueType::Unknown => "?".to_string(),
        }
    }
}

/// Length of the first name of a path.
pub fn root_length(path: &str) -> usize {
    path.find(|c: char| ".[^".contains(c) || c.is_whitespace()).unwrap_or(path.len())
}

/// The offsets at which members and subscripts of a path end, outside of brackets.
fn member_ends(path: &str) -> Vec<usize> {
    let mut open = 0u32;
    let mut ends = Vec::new();
    for (offset, character) in path.char_indices() {
        if open == 0 && (character == '.' || character == '[') {
            ends.push(offset);
        }
        match character {
            '[' => open += 1,
            ']' => open = open.saturating_sub(1),
            _ => {}
        }
    }
    ends.push(path.len());
    ends
}

/// Every IEC chunk of a program with its start. Numbers of POUs are those of the scopes of its own file.
pub fn views<'a>(context: &ProgramContext<'a>) -> impl Iterator<Item = (usize, View<'a>)> + use<'a> {
    context.files().to_vec().into_iter().flat_map(views_of)
}

/// Every IEC chunk of a file of a program.
pub fn views_of(file: ProgramFile<'_>) -> impl Iterator<Item = (usize, View<'_>)> {
    let scopes: &Scopes = file.document.scopes();
    file.document.iec_chunks().filter_map(move |(at, started)| {
        let view = View { text: at.chunk.text(), tree: at.chunk.iec()?, scopes, pou: started.checked_sub(1) };
        Some((at.start + file.start, view))
    })
}
