//! Flattens the nodes that the grammar of declarations gives into the vectors of the tree.

use super::grammar::{
    DeclarationNode, InstanceNode, SpecKind, SpecNode, TaskNode, Tokens, ValueNode, ValueNodeKind,
};
use super::reader::Reader;
use super::token::{Token, TokenKind};
use super::{
    Declaration, Direction, Edge, InitialValue, Instance, OperandId, Parameter, ParameterValue, Run, Task,
    TypeId, TypeSpec, ValueKind,
};
use crate::target::Operand;
use crate::target::iec::ElementaryType;
use crate::text::{Message, Span, Spanned};

/// Nodes count their tokens from the start of `tokens`.
pub struct Lowering<'r, 'a, 't> {
    pub reader: &'r mut Reader<'a>,
    pub tokens: &'t [Token],
}

/// Appends the records of one list, which thereby stand side by side.
pub fn append<T>(records: &mut Vec<T>, list: Vec<T>) -> Run {
    let start = records.len() as u32;
    records.extend(list);
    Run { start, end: records.len() as u32 }
}

/// From the first to the last of a range of tokens.
pub fn span_of(tokens: &[Token], range: Tokens) -> Span {
    let start = tokens.get(range.start).map_or(0, |token| token.span.start as usize);
    let last = range.end.checked_sub(1).and_then(|last| tokens.get(last));
    Span::new(start, last.map_or(start, |token| (token.span.end as usize).max(start)))
}

impl Lowering<'_, '_, '_> {
    pub fn declaration(&mut self, node: &DeclarationNode) -> Declaration {
        let names: Vec<Span> = node.names.iter().map(|name| self.token_span(*name)).collect();
        for name in &names {
            self.reader.check_name(*name);
        }
        let names = append(&mut self.reader.tree.names, names);
        let address = node.address.map(|address| self.constant((address..address + 1).into()));
        let declared = node.spec.as_ref().map(|spec| self.spec(spec));
        let (edge, writable) = match node.suffix {
            Some(TokenKind::RisingEdge) => (Some(Edge::Rising), None),
            Some(TokenKind::FallingEdge) => (Some(Edge::Falling), None),
            Some(TokenKind::ReadOnly) => (None, Some(false)),
            Some(TokenKind::ReadWrite) => (None, Some(true)),
            _ => (None, None),
        };
        let initial = self.initial(&node.initial);
        let path = node.path.map(|path| self.span(path));
        Declaration { span: self.span(node.tokens), names, address, path, declared, edge, writable, initial }
    }

    pub fn spec(&mut self, node: &SpecNode) -> TypeId {
        let span = self.span(node.tokens);
        let spec = match &node.kind {
            SpecKind::Named => self.named(node.tokens),
            SpecKind::Text { length } => self.text_type(node.tokens, *length),
            SpecKind::Subrange { base, least, greatest } => {
                let named = self.named(*base);
                let base = self.push_type(self.span(*base), named);
                let (least, greatest) = (self.constant(*least), self.constant(*greatest));
                TypeSpec::Subrange { base, least, greatest }
            }
            SpecKind::Enumeration { values } => {
                let values: Vec<Span> = values.iter().map(|name| self.token_span(*name)).collect();
                for name in &values {
                    self.reader.check_name(*name);
                }
                TypeSpec::Enumeration { values: append(&mut self.reader.tree.names, values) }
            }
            SpecKind::Array { bounds, element } => {
                let element = self.spec(element);
                let start = self.reader.tree.operands.len() as u32;
                for (least, greatest) in bounds {
                    self.constant(*least);
                    self.constant(*greatest);
                }
                let end = self.reader.tree.operands.len() as u32;
                TypeSpec::Array { bounds: Run { start, end }, element }
            }
            SpecKind::Structure { fields } => {
                let fields = fields.iter().map(|field| self.declaration(field)).collect();
                TypeSpec::Structure { fields: append(&mut self.reader.tree.declarations, fields) }
            }
            SpecKind::Reference { target } => TypeSpec::Reference { target: self.spec(target) },
        };
        self.push_type(span, spec)
    }

    pub fn task(&mut self, node: &TaskNode) -> Task {
        let name = self.token_span(node.name);
        self.reader.check_name(name);
        let mut task = Task { name: Some(name), ..Task::default() };
        for (word, source) in &node.settings {
            let word = self.token_span(*word);
            let source = self.source(*source);
            match self.reader.word(word).to_ascii_uppercase().as_str() {
                "SINGLE" => task.single = Some(source),
                "INTERVAL" => task.interval = Some(source),
                "PRIORITY" => task.priority = Some(source),
                other => {
                    let message = Message::new("syntax-error.expected")
                        .with_alternatives("expected", ["`SINGLE`", "`INTERVAL`", "`PRIORITY`"])
                        .with("found", other);
                    self.reader.problem("syntax-error", word, message);
                }
            }
        }
        if task.priority.is_none() {
            self.reader.hint(name, "lenient-form.task-priority");
        }
        task
    }

    pub fn instance(&mut self, node: &InstanceNode) -> Instance {
        let name = self.token_span(node.name);
        self.reader.check_name(name);
        let (mut parameters, mut block_tasks) = (Vec::new(), Vec::new());
        for element in &node.elements {
            let named = self.span(element.name);
            if element.sign == TokenKind::With {
                block_tasks.extend([named, self.span(element.value)]);
                continue;
            }
            let out = element.sign == TokenKind::Arrow;
            let direction = if out { Direction::Out { negated: false } } else { Direction::In };
            let value = ParameterValue::Operand(self.source(element.value));
            parameters.push(Parameter {
                span: self.span(element.tokens),
                name: Some(named),
                direction,
                value,
            });
        }
        Instance {
            name: Some(name),
            retain: node.retain.map(|word| word == TokenKind::Retain),
            task: node.task.map(|task| self.token_span(task)),
            program: Some(self.span(node.program)),
            parameters: append(&mut self.reader.tree.parameters, parameters),
            block_tasks: append(&mut self.reader.tree.names, block_tasks),
        }
    }

    fn span(&self, tokens: Tokens) -> Span {
        span_of(self.tokens, tokens)
    }

    fn token_span(&self, index: usize) -> Span {
        self.span((index..index + 1).into())
    }

    fn push_type(&mut self, span: Span, spec: TypeSpec) -> TypeId {
        self.reader.tree.types.push(Spanned::new(spec, span));
        TypeId(self.reader.tree.types.len() as u32 - 1)
    }

    fn named(&self, tokens: Tokens) -> TypeSpec {
        let word = self.reader.word(self.span(tokens));
        ElementaryType::named(word).map_or(TypeSpec::Named, TypeSpec::Elementary)
    }

    fn text_type(&mut self, tokens: Tokens, length: Option<Tokens>) -> TypeSpec {
        let wide = self.tokens.get(tokens.start).is_some_and(|token| token.kind == TokenKind::Wstring);
        let Some(length) = length else {
            return TypeSpec::Elementary(if wide { ElementaryType::Wstring } else { ElementaryType::String });
        };
        let opening = tokens.start + 1;
        if self.tokens.get(opening).is_some_and(|token| token.kind == TokenKind::LeftParenthesis) {
            let span = self.span((opening..tokens.end).into());
            self.reader.hint(span, "lenient-form.text-length");
        }
        TypeSpec::Text { wide, length: self.constant(length) }
    }

    /// A constant, the name of one, or an address.
    fn constant(&mut self, tokens: Tokens) -> OperandId {
        let span = self.span(tokens);
        self.reader.read_operand(span)
    }

    /// What feeds a task or an input: also a variable with its path, which is no single word.
    fn source(&mut self, tokens: Tokens) -> OperandId {
        if tokens.end - tokens.start > 1 {
            let span = self.span(tokens);
            return self.reader.push_operand(span, Operand::Variable);
        }
        self.constant(tokens)
    }

    fn initial(&mut self, values: &[ValueNode]) -> Option<u32> {
        let (first, last) = (values.first()?, values.last()?);
        let index = self.reader.tree.values.len() as u32;
        let bare = values.len() > 1 || matches!(first.kind, ValueNodeKind::Repeat { .. });
        if bare {
            let span = self.span(first.tokens).to(self.span(last.tokens));
            self.reader.hint(span, "lenient-form.bare-array");
            self.nest(span, None, ValueKind::Array, values);
        } else {
            self.value(first);
        }
        Some(index)
    }

    fn value(&mut self, node: &ValueNode) {
        let span = self.span(node.tokens);
        let field = node.field.map(|name| self.token_span(name));
        match &node.kind {
            ValueNodeKind::Constant => {
                let operand = self.source(node.tokens);
                self.nest(span, field, ValueKind::Constant(operand), &[]);
            }
            ValueNodeKind::Array(values) => self.nest(span, field, ValueKind::Array, values),
            ValueNodeKind::Structure(values) => self.nest(span, field, ValueKind::Structure, values),
            ValueNodeKind::Repeat { count, values } => {
                let count = self.constant((*count..*count + 1).into());
                self.nest(span, field, ValueKind::Repeat { count }, values);
            }
        }
    }

    /// A record and, behind it, those of the values inside.
    fn nest(&mut self, span: Span, field: Option<Span>, kind: ValueKind, inside: &[ValueNode]) {
        let index = self.reader.tree.values.len();
        self.reader.tree.values.push(InitialValue { span, field, kind, end: 0 });
        for value in inside {
            self.value(value);
        }
        let end = self.reader.tree.values.len() as u32;
        if let Some(record) = self.reader.tree.values.get_mut(index) {
            record.end = end;
        }
    }
}
