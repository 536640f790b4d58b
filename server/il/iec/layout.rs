//! What the tree says about the lines of a formatted chunk: where they break, how far they are indented, and which
//! words are operators.

use super::token::{Region, Token, TokenKind};
use super::{Direction, IecTree, ItemKind, ListForm, Run};
use crate::target::iec::Operator;
use crate::text::{Severity, Span};
use rustc_hash::{FxHashMap, FxHashSet};

/// How a line that starts at an offset is printed.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Steps of indentation.
    pub level: u32,
    /// Where the operator with its parenthesis, or the name of a function, ends; 0 for other lines.
    pub head: u32,
}

/// Facts about offsets of the chunk.
#[derive(Default)]
pub struct Layout {
    places: FxHashMap<u32, Place>,
    operators: FxHashSet<u32>,
    /// Offsets at which the tokens before end a line.
    ends: FxHashSet<u32>,
    /// Offsets at which a token starts a line.
    starts: FxHashSet<u32>,
    /// Stretches with a mistake.
    broken: Vec<Span>,
}

impl Layout {
    pub fn new(chunk: &str, tree: &IecTree, tokens: &[Token]) -> Layout {
        let mut layout = Layout::default();
        let errors = tree.problems.iter().filter(|problem| problem.severity == Severity::Error);
        layout.broken = errors.map(|problem| problem.span).collect();
        layout.broken.sort_unstable();
        let mut formal = FxHashSet::default();
        for item in &tree.items {
            layout.item(chunk, tree, tokens, item.span, item.depth, &item.kind, &mut formal);
        }
        layout.commas(tokens, &formal);
        layout.regions(tokens);
        layout
    }

    /// What is known about a line that starts at `offset`.
    pub fn place(&self, offset: u32) -> Option<Place> {
        self.places.get(&offset).copied()
    }

    /// Whether the word at `offset` is an operator.
    pub fn is_operator(&self, offset: u32) -> bool {
        self.operators.contains(&offset)
    }

    /// Whether a mistake touches `span`.
    pub fn is_broken(&self, span: Span) -> bool {
        // Mistakes may contain each other, so all that start before the end of the line are looked at from the back;
        // those that reach over lines are comments that do not end, of which there is one.
        let before = self.broken.partition_point(|mistake| mistake.start <= span.end);
        let reaches = |mistake: &Span| mistake.end >= span.start;
        self.broken[..before].iter().rev().take(8).any(reaches)
    }

    /// How many of `rest`, which ends a line of the source, go onto the next line of the result.
    pub fn line_length(&self, rest: &[Token]) -> usize {
        for index in 1..rest.len() {
            let (before, token) = (rest[index - 1], rest[index]);
            let breaks = self.ends.contains(&before.span.end) || self.starts.contains(&token.span.start);
            if breaks && rest[index..].iter().any(|token| !token.kind.is_trivia()) {
                return index;
            }
        }
        rest.len()
    }

    #[allow(clippy::too_many_arguments, reason = "one pass over the items with all that they are made of")]
    fn item(
        &mut self,
        chunk: &str,
        tree: &IecTree,
        tokens: &[Token],
        span: Span,
        depth: u32,
        kind: &ItemKind,
        formal: &mut FxHashSet<u32>,
    ) {
        let level = depth + 1;
        match *kind {
            ItemKind::Label { .. } => {
                self.places.insert(span.start, Place { level: 0, head: 0 });
                self.starts.insert(span.start);
                self.ends.insert(span.end);
            }
            ItemKind::Operation { operation, .. } => {
                self.instruction(operation.word, level, operation.word.end)
            }
            ItemKind::Jump { word, .. } | ItemKind::Return { word, .. } => {
                self.instruction(word, level, word.end)
            }
            ItemKind::InputOperator { input, .. } => self.instruction(input, level, input.end),
            ItemKind::Open { operation, .. } => {
                let open = parenthesis_behind(tokens, operation.word.end);
                self.instruction(operation.word, level, open.map_or(operation.word.end, |open| open.end));
                self.ends.insert(span.end);
            }
            ItemKind::Close => {
                self.places.insert(span.start, Place { level, head: 0 });
                self.starts.insert(span.start);
            }
            ItemKind::Call { word, callee, form, parameters, .. } => {
                self.instruction(word, level, word.end);
                let name = callee.map_or(word, |callee| tree.operand(callee).span);
                self.list(tree, tokens, span, level, form, parameters, name.end, formal);
            }
            ItemKind::Function { name, form, parameters } => {
                self.instruction(name, level, name.end);
                if Operator::written(name.of(chunk)).is_none() {
                    self.operators.remove(&name.start);
                }
                self.list(tree, tokens, span, level, form, parameters, name.end, formal);
            }
            ItemKind::ParameterOpen { .. } => _ = self.ends.insert(span.end),
            _ => {}
        }
    }

    fn instruction(&mut self, word: Span, level: u32, head: u32) {
        self.places.insert(word.start, Place { level, head });
        self.operators.insert(word.start);
        self.starts.insert(word.start);
    }

    #[allow(clippy::too_many_arguments, reason = "what calls of blocks and of functions have in common")]
    fn list(
        &mut self,
        tree: &IecTree,
        tokens: &[Token],
        span: Span,
        level: u32,
        form: ListForm,
        parameters: Run,
        name_end: u32,
        formal: &mut FxHashSet<u32>,
    ) {
        for parameter in parameters.of(&tree.parameters) {
            if form != ListForm::None {
                self.places.insert(parameter.span.start, Place { level: level + 1, head: 0 });
            }
            if parameter.direction == (Direction::Out { negated: true }) {
                self.operators.insert(parameter.span.start);
            }
        }
        let Some(open) = parenthesis_behind(tokens, name_end).filter(|_| form != ListForm::None) else {
            return;
        };
        let last = tokens.partition_point(|token| token.span.end < span.end);
        let close = tokens.get(last).filter(|token| token.kind == TokenKind::RightParenthesis);
        if let Some(close) = close {
            self.places.insert(close.span.start, Place { level, head: 0 });
        }
        if form == ListForm::Formal && !parameters.is_empty() {
            formal.insert(open.start);
            self.ends.insert(open.end);
            self.starts.extend(close.map(|close| close.span.start));
        }
    }

    /// A comma between named parameters ends a line.
    fn commas(&mut self, tokens: &[Token], formal: &FxHashSet<u32>) {
        let mut open = Vec::new();
        let mut brackets = 0usize;
        for token in tokens.iter().filter(|token| token.region == Region::Body) {
            match token.kind {
                TokenKind::LeftParenthesis => open.push(formal.contains(&token.span.start)),
                TokenKind::RightParenthesis => _ = open.pop(),
                TokenKind::LeftBracket => brackets += 1,
                TokenKind::RightBracket => brackets = brackets.saturating_sub(1),
                TokenKind::Newline => brackets = 0,
                TokenKind::Comma if brackets == 0 && open.last() == Some(&true) => {
                    self.ends.insert(token.span.end);
                }
                _ => {}
            }
        }
    }

    /// Declarations, and the words around sections, units and configurations, have lines of their own.
    fn regions(&mut self, tokens: &[Token]) {
        let (mut head, mut task) = (false, false);
        let mut before: Option<Token> = None;
        for token in tokens.iter().filter(|token| token.kind != TokenKind::Newline && !token.kind.is_trivia())
        {
            let kind = token.kind;
            // SINGLE, INTERVAL and PRIORITY are words of the language in a task only.
            task = kind == TokenKind::Task || task && kind != TokenKind::Semicolon;
            let setting = task && kind == TokenKind::Assign;
            if let Some(word) = before.filter(|_| setting) {
                self.operators.insert(word.span.start);
            }
            let qualifier = matches!(kind, TokenKind::Constant | TokenKind::Retain | TokenKind::NonRetain);
            let new_region = before.is_some_and(|before| before.region != token.region);
            let opens = kind.opens_section() || kind.opens_unit() || kind.closes();
            if head && !qualifier
                || new_region
                || opens
                || matches!(kind, TokenKind::Resource | TokenKind::Task)
            {
                self.starts.insert(token.span.start);
            }
            if token.region != Region::Body {
                head = kind.opens_section() || head && qualifier;
                match kind {
                    TokenKind::Semicolon | TokenKind::Struct | TokenKind::Type => {
                        self.ends.insert(token.span.end);
                    }
                    TokenKind::EndStruct => _ = self.starts.insert(token.span.start),
                    _ => {}
                }
            } else {
                head = false;
            }
            if kind.closes() {
                self.ends.insert(token.span.end);
            }
            before = Some(*token);
        }
    }
}

/// The first parenthesis at or behind `offset`.
fn parenthesis_behind(tokens: &[Token], offset: u32) -> Option<Span> {
    let from = tokens.partition_point(|token| token.span.start < offset);
    let behind = tokens.get(from..)?.iter();
    behind.take(8).find(|token| token.kind == TokenKind::LeftParenthesis).map(|token| token.span)
}
