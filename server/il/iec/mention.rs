//! Where a chunk names things: for references, rename, and the rules about declarations.

use super::scan::Scanner;
use super::token::TokenKind;
use super::{
    Direction, IecTree, ItemKind, OperandId, ParameterValue, PouKind, Run, SectionKind, TypeId, TypeSpec,
    ValueKind,
};
use crate::target::Operand;
use crate::target::iec::{Literal, LiteralValue, OperatorRole};
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
        let mut collector = Collector { tree: self, chunk, found: Vec::with_capacity(self.items.len()) };
        for item in &self.items {
            collector.item(&item.kind);
        }
        // Parameters are found with their call, before the instructions between them.
        collector.found.sort_by_key(|mention| mention.span);
        collector.found.into_iter()
    }
}

struct Collector<'a> {
    tree: &'a IecTree,
    chunk: &'a str,
    found: Vec<Mention>,
}

impl Collector<'_> {
    fn item(&mut self, kind: &ItemKind) {
        match *kind {
            ItemKind::Pou { kind, name, result } => {
                self.add(name, MentionRole::DeclaresPou(kind));
                self.type_spec(result);
            }
            ItemKind::Section { kind, declarations, .. } => self.section(kind, declarations),
            ItemKind::Types { declarations } => self.declarations(declarations, MentionRole::DeclaresType),
            ItemKind::Configuration { name } => self.add(name, MentionRole::DeclaresRuntime),
            ItemKind::Resource { name, on } => {
                self.add(name, MentionRole::DeclaresRuntime);
                self.add(on, MentionRole::NamesRuntime);
            }
            ItemKind::Task(index) => self.task(index),
            ItemKind::Instance(index) => self.instance(index),
            ItemKind::Label { name } => self.add(Some(name), MentionRole::DeclaresLabel),
            ItemKind::Operation { operation, operand } => {
                self.operand(operand, use_by(operation.operator.role))
            }
            ItemKind::Open { operand, .. } => self.operand(operand, MentionRole::Reads),
            ItemKind::Jump { label, .. } => self.add(label, MentionRole::Jumps),
            ItemKind::Call { callee, parameters, .. } => {
                self.operand(callee, MentionRole::Calls);
                self.parameters(parameters);
            }
            ItemKind::Function { name, parameters, .. } => {
                // `FB.Method` starts with an instance.
                let method = name.of(self.chunk).contains('.');
                self.path(name, if method { MentionRole::Calls } else { MentionRole::CallsFunction });
                self.parameters(parameters);
            }
            ItemKind::InputOperator { input, instance } => {
                self.add(Some(input), MentionRole::NamesMember);
                self.operand(Some(instance), MentionRole::Calls);
            }
            ItemKind::PouEnd(_)
            | ItemKind::End(_)
            | ItemKind::Close
            | ItemKind::Return { .. }
            | ItemKind::ParameterOpen { .. } => {}
        }
    }

    fn add(&mut self, name: Option<Span>, role: MentionRole) {
        self.found.extend(name.map(|span| Mention { span, role }));
    }

    fn section(&mut self, kind: SectionKind, declarations: Run) {
        for declaration in declarations.of(&self.tree.declarations) {
            if let Some(path) = declaration.path {
                let written = kind == SectionKind::Config;
                self.path(path, if written { MentionRole::Writes } else { MentionRole::Reads });
            }
        }
        self.declarations(declarations, MentionRole::DeclaresVariable);
    }

    fn declarations(&mut self, declarations: Run, role: MentionRole) {
        for declaration in declarations.of(&self.tree.declarations) {
            for name in declaration.names.of(&self.tree.names) {
                self.add(Some(*name), role);
            }
            self.type_spec(declaration.declared);
            if let Some(initial) = declaration.initial {
                self.initial(initial);
            }
        }
    }

    /// Types nest no deeper than the grammar lets them.
    fn type_spec(&mut self, id: Option<TypeId>) {
        let Some(id) = id else { return };
        let written = self.tree.type_spec(id);
        match written.value {
            TypeSpec::Elementary(_) => {}
            TypeSpec::Named => self.path(written.span, MentionRole::NamesType),
            TypeSpec::Text { length, .. } => self.operand(Some(length), MentionRole::Reads),
            TypeSpec::Subrange { base, least, greatest } => {
                self.type_spec(Some(base));
                self.operand(Some(least), MentionRole::Reads);
                self.operand(Some(greatest), MentionRole::Reads);
            }
            TypeSpec::Enumeration { values } => {
                for name in values.of(&self.tree.names) {
                    self.add(Some(*name), MentionRole::DeclaresEnumerator);
                }
            }
            TypeSpec::Array { bounds, element } => {
                for bound in bounds.start..bounds.end {
                    self.operand(Some(OperandId(bound)), MentionRole::Reads);
                }
                self.type_spec(Some(element));
            }
            TypeSpec::Structure { fields } => self.declarations(fields, MentionRole::DeclaresField),
            TypeSpec::Reference { target } => self.type_spec(Some(target)),
        }
    }

    fn initial(&mut self, index: u32) {
        let end = self.tree.values.get(index as usize).map_or(0, |value| value.end);
        for value in self.tree.values.get(index as usize..end as usize).unwrap_or(&[]) {
            self.add(value.field, MentionRole::NamesParameter);
            if let ValueKind::Constant(operand) = value.kind {
                self.operand(Some(operand), MentionRole::Reads);
            }
        }
    }

    fn task(&mut self, index: u32) {
        let Some(task) = self.tree.tasks.get(index as usize) else { return };
        self.add(task.name, MentionRole::DeclaresRuntime);
        for source in [task.single, task.interval, task.priority] {
            self.operand(source, MentionRole::Reads);
        }
    }

    fn instance(&mut self, index: u32) {
        let Some(instance) = self.tree.instances.get(index as usize) else { return };
        self.add(instance.name, MentionRole::DeclaresRuntime);
        self.add(instance.task, MentionRole::NamesRuntime);
        self.add(instance.program, MentionRole::NamesType);
        self.parameters(instance.parameters);
        for pair in instance.block_tasks.of(&self.tree.names).chunks(2) {
            self.add(pair.first().copied(), MentionRole::NamesParameter);
            self.add(pair.get(1).copied(), MentionRole::NamesRuntime);
        }
    }

    fn parameters(&mut self, run: Run) {
        for parameter in run.of(&self.tree.parameters) {
            self.add(parameter.name, MentionRole::NamesParameter);
            let ParameterValue::Operand(operand) = parameter.value else { continue };
            let written = matches!(parameter.direction, Direction::Out { .. });
            self.operand(Some(operand), if written { MentionRole::Writes } else { MentionRole::Reads });
        }
    }

    fn operand(&mut self, operand: Option<OperandId>, role: MentionRole) {
        let Some(operand) = operand.map(|id| self.tree.operand(id)) else { return };
        match operand.value {
            Operand::Variable => self.path(operand.span, role),
            // `Colour#Red` names a type.
            Operand::Literal(Literal { value: LiteralValue::Enumerated, .. }) => {
                let length = operand.span.of(self.chunk).find('#').unwrap_or(0);
                let start = operand.span.start as usize;
                self.add(Some(Span::new(start, start + length)), MentionRole::NamesType);
            }
            _ => {}
        }
    }

    /// The names in `a[i].b`: `a` has the role, `i` is read, `b` is a member.
    fn path(&mut self, span: Span, role: MentionRole) {
        let mut next = role;
        for token in Scanner::new(span.of(self.chunk)) {
            match token.kind {
                TokenKind::Word => {
                    self.add(Some(token.span.shifted(span.start as usize)), next);
                    next = MentionRole::Reads;
                }
                TokenKind::Dot => next = MentionRole::NamesMember,
                // Keywords and bits behind a point name nothing that could be looked up.
                _ => next = MentionRole::Reads,
            }
        }
    }
}

fn use_by(role: OperatorRole) -> MentionRole {
    match role {
        OperatorRole::Store | OperatorRole::Latch { .. } => MentionRole::Writes,
        _ => MentionRole::Reads,
    }
}
