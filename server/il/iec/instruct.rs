//! Reads one instruction: a label, an operator with its operand, a jump, a function, an input of a block.

use super::body::{BodyReader, FrameKind};
use super::scan::leaves_parentheses;
use super::token::{Region, Token, TokenKind};
use super::{Condition, ItemKind, ListForm, OperandId, Operation};
use crate::target::iec::{FunctionBlock, Operator, OperatorRole, Written};
use crate::target::{Model, Operand};
use crate::text::{Message, Span};

impl BodyReader<'_> {
    pub fn read_statement(&mut self, first: Token) {
        if !self.frames.is_empty() && leaves_parentheses(self.reader.rest_of_line(), self.reader.text) {
            if self.frames.iter().all(|frame| self.partners[frame.token].is_some()) {
                self.reader.problem(
                    "syntax-error",
                    first.span,
                    Message::new("syntax-error.inside-parentheses"),
                );
            } else {
                self.close_all();
            }
        }
        if self.reader.kind(1) == Some(TokenKind::Colon) {
            self.reader.check_name(first.span);
            let colon = self.reader.tokens[self.reader.at + 1].span;
            let depth = self.frames.len();
            self.reader.push_item(first.span.to(colon), depth, ItemKind::Label { name: first.span });
            self.reader.at += 2;
            let next = self.reader.peek();
            return match next {
                // The instruction behind a label stands on its line; another label does not.
                Some(next) if next.kind == TokenKind::Word && next.region == Region::Body => {
                    if self.reader.kind(1) == Some(TokenKind::Colon) {
                        self.finish_line();
                    } else {
                        self.read_instruction(next);
                    }
                }
                _ => self.finish_line(),
            };
        }
        self.read_instruction(first);
    }

    fn read_instruction(&mut self, first: Token) {
        if matches!(self.reader.kind(1), Some(TokenKind::Assign | TokenKind::Arrow)) {
            let found = self.reader.tokens.get(self.reader.at + 1).copied();
            self.reader.expected(found, "operand, `(`, end of line");
            return self.skip_line();
        }
        let Some(written) = Operator::written(self.reader.word(first.span)) else {
            return self.read_named(first);
        };
        match written.operator.role {
            OperatorRole::Jump => self.read_jump(first, written),
            OperatorRole::Return => {
                self.reader.at += 1;
                let item = ItemKind::Return { word: first.span, condition: condition(written) };
                self.reader.push_item(first.span, self.frames.len(), item);
                self.finish_line();
            }
            OperatorRole::Call => self.read_call(first, written),
            _ if self.reader.kind(1) == Some(TokenKind::LeftParenthesis) => self.read_open(first, written),
            _ => self.read_operation(first, written),
        }
    }

    fn read_jump(&mut self, first: Token, written: Written) {
        self.reader.at += 1;
        let label = match self.reader.peek().filter(|next| next.region == Region::Body) {
            Some(label) if label.kind == TokenKind::Word || label.kind.is_keyword() => {
                self.reader.check_name(label.span);
                self.reader.at += 1;
                Some(label.span)
            }
            Some(label) if label.kind == TokenKind::Number => {
                let message = Message::new("syntax-error.numeric-label");
                self.reader.problem("syntax-error", label.span, message);
                self.reader.at += 1;
                None
            }
            other => {
                self.reader.expected(other, "label");
                None
            }
        };
        let span = label.map_or(first.span, |label| first.span.to(label));
        let item = ItemKind::Jump { word: first.span, condition: condition(written), label };
        self.reader.push_item(span, self.frames.len(), item);
        self.finish_line();
    }

    fn read_operation(&mut self, first: Token, written: Written) {
        let mut word = first.span;
        self.reader.at += 1;
        // `ST?` of the third edition assigns if the types allow it.
        if written.operator.role == OperatorRole::Store
            && let Some(question) = self.reader.take(TokenKind::Question)
        {
            word = word.to(question.span);
        }
        let operand = self.read_operand();
        let strange = |kind: TokenKind| matches!(kind, TokenKind::Unexpected | TokenKind::LeftBracket);
        if operand.is_none() && self.reader.kind(0).is_some_and(strange) {
            let found = self.reader.peek();
            self.reader.expected(found, "operand");
            self.skip_line();
        }
        // The names of most operators are also names of functions, which take several operands.
        let is_function = matches!(written.operator.role, OperatorRole::Combine { .. })
            && word_is_name(self.reader.word(word))
            && !written.negate;
        if let Some(operand) = operand
            && is_function
            && self.reader.kind(0) == Some(TokenKind::Comma)
        {
            return self.read_operands(word, Some(operand));
        }
        let operation = Operation { operator: written.operator, negated: written.negate, word };
        let span = operand.map_or(word, |operand| word.to(self.reader.tree.operand(operand).span));
        self.reader.push_item(span, self.frames.len(), ItemKind::Operation { operation, operand });
        self.finish_line();
    }

    /// An operator before a parenthesis.
    fn read_open(&mut self, first: Token, written: Written) {
        let function =
            self.names_parameter_behind(self.reader.at + 2) || self.lists_behind(self.reader.at + 2);
        if function && word_is_name(self.reader.word(first.span)) {
            return self.read_function(first.span, 1);
        }
        if !written.operator.modifiers.defer {
            let message = Message::new("syntax-error.no-parenthesis")
                .with("operator", self.reader.word(first.span).to_ascii_uppercase());
            let open = self.reader.tokens[self.reader.at + 1].span;
            self.reader.problem("syntax-error", open, message);
        }
        self.reader.at += 1;
        let (open, token) = (self.reader.tokens[self.reader.at].span, self.reader.at);
        self.reader.at += 1;
        // `AND( LD a` on one line: the instruction stands where an operand may.
        let instruction = self.instruction_follows();
        let operand = if instruction { None } else { self.read_operand() };
        let operation = Operation { operator: written.operator, negated: written.negate, word: first.span };
        let span = operand.map_or(open, |operand| self.reader.tree.operand(operand).span);
        let item = ItemKind::Open { operation, operand };
        self.reader.push_item(first.span.to(span), self.frames.len(), item);
        self.open(FrameKind::Expression, open, token);
        if instruction {
            let next = self.reader.peek().map_or(open, |next| next.span);
            self.reader.hint(next, "lenient-form.line-after-parenthesis");
        } else {
            self.finish_line();
        }
    }

    /// A word that is no operator: a function, an input of a block, or something unknown.
    fn read_named(&mut self, first: Token) {
        let (name, length) = self.path_at(self.reader.at);
        let input = FunctionBlock::all_input_operators()
            .iter()
            .any(|input| input.eq_ignore_ascii_case(self.reader.word(first.span)));
        if self.reader.kind(length) == Some(TokenKind::LeftParenthesis) {
            return self.read_function(name, length);
        }
        self.reader.at += length;
        let operand = self.read_operand();
        match operand {
            Some(instance) if input && self.reader.kind(0) != Some(TokenKind::Comma) => {
                let span = name.to(self.reader.tree.operand(instance).span);
                let item = ItemKind::InputOperator { input: name, instance };
                self.reader.push_item(span, self.frames.len(), item);
                self.finish_line();
            }
            operand => self.read_operands(name, operand),
        }
    }

    /// The operands of a function without parentheses, the first of which is read.
    fn read_operands(&mut self, name: Span, first: Option<OperandId>) {
        let mut parameters = Vec::new();
        let mut next = first;
        while let Some(operand) = next.take() {
            parameters.push(self.positional(operand));
            if self.reader.take(TokenKind::Comma).is_some() {
                next = self.read_operand();
                if next.is_none() {
                    let found = self.reader.peek();
                    self.reader.expected(found, "operand");
                }
            }
        }
        let span = parameters.last().map_or(name, |last| name.to(last.span));
        let parameters = super::lower::append(&mut self.reader.tree.parameters, parameters);
        let item = ItemKind::Function { name, form: ListForm::None, parameters };
        self.reader.push_item(span, self.frames.len(), item);
        self.finish_line();
    }

    /// The next operand, if there is one. A reserved word is read as one, and rules say that it is none.
    pub fn read_operand(&mut self) -> Option<OperandId> {
        let first = self.reader.peek().filter(|token| token.region == Region::Body)?;
        if first.kind == TokenKind::Word {
            let problems = self.reader.tree.problems.len();
            let (span, length) = self.path_at(self.reader.at);
            self.reader.at += length;
            let broken = self.reader.tree.problems.len() > problems;
            // What is wrong with a broken path is said already.
            if broken {
                return Some(self.reader.push_operand(span, Operand::Variable));
            }
            if length == 1 {
                return Some(self.reader.read_operand(span));
            }
            // Blanks and comments may stand inside a path; the reader of operands takes one word.
            let words = &self.reader.tokens[self.reader.at - length..self.reader.at];
            let word: String = words.iter().map(|token| self.reader.word(token.span)).collect();
            let operand = Operand::read(&word, Model::Iec);
            return Some(self.reader.push_operand(span, operand));
        }
        if first.kind.starts_operand() || first.kind.is_keyword() {
            self.reader.at += 1;
            return Some(self.reader.read_operand(first.span));
        }
        None
    }

    /// The variable that starts at token `index`, `a[3].b^`, and its number of tokens. Bounded by its line.
    pub fn path_at(&mut self, index: usize) -> (Span, usize) {
        let kind = |at: usize| self.reader.tokens.get(at).map(|token| token.kind);
        let mut at = index + 1;
        let mut missing = None;
        loop {
            match kind(at) {
                Some(TokenKind::Dot) => match kind(at + 1) {
                    Some(TokenKind::Word | TokenKind::Number | TokenKind::Address) => at += 2,
                    Some(keyword) if keyword.is_keyword() => at += 2,
                    _ => {
                        missing = Some(TokenKind::Word);
                        at += 1;
                        break;
                    }
                },
                Some(TokenKind::Caret) => at += 1,
                Some(TokenKind::LeftBracket) => match self.subscripts_end(at) {
                    Ok(end) => at = end,
                    Err(end) => {
                        missing = Some(TokenKind::RightBracket);
                        at = end;
                        break;
                    }
                },
                _ => break,
            }
        }
        if let Some(missing) = missing {
            let found = self.reader.tokens.get(at).copied();
            self.reader.expected(found, missing.name());
        }
        let tokens = &self.reader.tokens[index..at];
        let end = tokens.last().map_or(Span::at(0), |token| token.span);
        (tokens[0].span.to(end), at - index)
    }

    /// The index behind the bracket that closes the one at `open`; as an error, where the line ends without it.
    fn subscripts_end(&self, open: usize) -> Result<usize, usize> {
        let mut depth = 0usize;
        for (at, token) in self.reader.tokens.iter().enumerate().skip(open) {
            match token.kind {
                TokenKind::LeftBracket => depth += 1,
                TokenKind::RightBracket if depth == 1 => return Ok(at + 1),
                TokenKind::RightBracket => depth -= 1,
                TokenKind::Newline | TokenKind::Semicolon | TokenKind::LeftParenthesis => return Err(at),
                TokenKind::RightParenthesis | TokenKind::Assign | TokenKind::Arrow => return Err(at),
                _ if token.region != Region::Body => return Err(at),
                _ => {}
            }
        }
        Err(self.reader.tokens.len())
    }

    /// Whether the next two tokens are an operator and its operand, not an operand.
    fn instruction_follows(&self) -> bool {
        let Some(first) = self.reader.peek().filter(|token| token.kind == TokenKind::Word) else {
            return false;
        };
        Operator::written(self.reader.word(first.span)).is_some()
            && self
                .reader
                .kind(1)
                .is_some_and(|kind| kind.starts_operand() || kind == TokenKind::LeftParenthesis)
    }

    /// Whether the tokens from `index` on, behind ends of lines, name a parameter.
    pub fn names_parameter_behind(&self, index: usize) -> bool {
        let words = || self.reader.tokens[index.min(self.reader.tokens.len())..].iter();
        let mut kinds = words().map(|token| token.kind).skip_while(|kind| *kind == TokenKind::Newline);
        let first = words().position(|token| token.kind != TokenKind::Newline).map(|skipped| index + skipped);
        let named = |second: Option<TokenKind>, third: Option<TokenKind>| match second {
            Some(TokenKind::Assign | TokenKind::Arrow) => true,
            Some(TokenKind::Word) => third == Some(TokenKind::Arrow),
            _ => false,
        };
        match kinds.next() {
            Some(TokenKind::Word) => {
                let (second, third) = (kinds.next(), kinds.next());
                named(second, third)
                    && (second != Some(TokenKind::Word) || first.is_some_and(|at| self.reader.is_not(at)))
            }
            _ => false,
        }
    }

    /// Whether an operand and a comma follow: a list of operands in parentheses.
    fn lists_behind(&self, index: usize) -> bool {
        let rest = self.reader.tokens.get(index..).unwrap_or(&[]);
        let operand = rest.iter().position(|token| {
            !matches!(token.kind, TokenKind::Dot | TokenKind::LeftBracket | TokenKind::RightBracket)
                && !token.kind.starts_operand()
        });
        rest.first().is_some_and(|token| token.kind.starts_operand())
            && operand.is_some_and(|at| rest[at].kind == TokenKind::Comma)
    }
}

/// `C`, `CN` or neither.
pub fn condition(written: Written) -> Condition {
    match written.condition {
        None => Condition::Always,
        Some(true) => Condition::IfTrue,
        Some(false) => Condition::IfFalse,
    }
}

/// `&` is an operator but no name of a function.
fn word_is_name(word: &str) -> bool {
    !word.starts_with('&')
}
