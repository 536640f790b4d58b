//! Reads calls of function blocks and functions with their lists of parameters.

use super::body::{BodyReader, Frame, FrameKind, List};
use super::instruct::condition;
use super::lower::append;
use super::token::{Region, Token, TokenKind};
use super::{Direction, ItemKind, ListForm, OperandId, Parameter, ParameterValue, Run};
use crate::target::iec::{Function, Written};
use crate::text::Span;

impl BodyReader<'_> {
    /// `CAL instance`, with or without parameters.
    pub fn read_call(&mut self, first: Token, written: Written) {
        self.reader.at += 1;
        let callee = self.read_operand();
        let mut span = first.span;
        match callee {
            Some(callee) => {
                let called = self.reader.tree.operand(callee).span;
                span = span.to(called);
                if Function::named(self.reader.word(called)).is_some() {
                    self.reader.hint(called, "lenient-form.call-of-function");
                }
            }
            None => {
                let found = self.reader.peek();
                self.reader.expected(found, "function block instance");
            }
        }
        let item = ItemKind::Call {
            word: first.span,
            condition: condition(written),
            callee,
            form: ListForm::None,
            parameters: Run::default(),
        };
        let item = self.reader.push_item(span, self.frames.len(), item);
        match self.reader.peek() {
            Some(open) if open.kind == TokenKind::LeftParenthesis && open.region == Region::Body => {
                self.open_list(item);
            }
            _ => self.finish_line(),
        }
    }

    /// A function whose name, `length` tokens long, stands before a parenthesis.
    pub fn read_function(&mut self, name: Span, length: usize) {
        let item = ItemKind::Function { name, form: ListForm::Formal, parameters: Run::default() };
        let item = self.reader.push_item(name, self.frames.len(), item);
        self.reader.at += length;
        self.open_list(item);
        let Some(Frame { kind: FrameKind::List(list), open, .. }) = self.frames.last_mut() else { return };
        if list.form == ListForm::NonFormal {
            list.lenient = true;
            let open = *open;
            self.reader.hint(open, "lenient-form.operands-in-parentheses");
        }
    }

    /// The parenthesis of a list, the next token.
    fn open_list(&mut self, item: usize) {
        let (open, token) = (self.reader.tokens[self.reader.at].span, self.reader.at);
        self.reader.at += 1;
        let first =
            self.reader.tokens[self.reader.at..].iter().find(|token| token.kind != TokenKind::Newline);
        let empty = first.is_none_or(|token| token.kind == TokenKind::RightParenthesis);
        let formal = empty || self.names_parameter_behind(self.reader.at);
        let form = if formal { ListForm::Formal } else { ListForm::NonFormal };
        let list = List { item, form, parameters: Vec::new(), values: Vec::new(), lenient: false };
        self.open(FrameKind::List(list), open, token);
        let line_ends = self.reader.kind(0).is_none_or(|kind| kind == TokenKind::Newline);
        if !empty && formal != line_ends {
            self.hint_layout(open);
        }
    }

    /// Formal lists stand on one line for each parameter, others on one line in all. Said once for each list.
    fn hint_layout(&mut self, at: Span) {
        let Some(Frame { kind: FrameKind::List(list), .. }) = self.frames.last_mut() else { return };
        if std::mem::replace(&mut list.lenient, true) {
            return;
        }
        let formal = list.form == ListForm::Formal;
        self.reader
            .hint(at, if formal { "lenient-form.formal-lines" } else { "lenient-form.operands-on-lines" });
    }

    /// The next parameter of the innermost list, or its end.
    pub fn read_parameter(&mut self, token: Token) {
        match token.kind {
            TokenKind::Newline => self.reader.at += 1,
            TokenKind::RightParenthesis => self.close(token),
            _ if self.list_is_forgotten() => self.close_innermost(),
            TokenKind::Word if self.names_parameter_behind(self.reader.at) => {
                self.read_named_parameter(token)
            }
            kind if kind.starts_operand() || kind.is_keyword() => {
                let Some(operand) = self.read_operand() else { return };
                let parameter = self.positional(operand);
                let formal = self.list_form() == Some(ListForm::Formal);
                self.push_parameter(parameter);
                if formal {
                    let found = self.reader.peek();
                    self.reader.expected(found, "`:=`, `=>`");
                    self.skip_parameter();
                } else {
                    self.finish_parameter();
                }
            }
            _ => {
                self.reader.expected(Some(token), "parameter, `)`");
                self.skip_parameter();
            }
        }
    }

    /// `name := value`, `name := ( … )`, `NOT name => variable`.
    fn read_named_parameter(&mut self, first: Token) {
        let negation = self.reader.kind(1) == Some(TokenKind::Word);
        self.reader.at += usize::from(negation);
        let name = self.reader.tokens[self.reader.at].span;
        let sign = self.reader.tokens[self.reader.at + 1];
        self.reader.at += 2;
        let direction = match sign.kind {
            TokenKind::Arrow => Direction::Out { negated: negation },
            _ => Direction::In,
        };
        let mut parameter = Parameter {
            span: first.span.to(sign.span),
            name: Some(name),
            direction,
            value: ParameterValue::Missing,
        };
        if self.list_form() == Some(ListForm::NonFormal) {
            self.reader.expected(Some(sign), "`,`, `)`");
        }
        if self.reader.kind(0) == Some(TokenKind::LeftParenthesis) && direction == Direction::In {
            return self.open_value(parameter);
        }
        match self.read_operand() {
            Some(operand) => {
                parameter.value = ParameterValue::Operand(operand);
                parameter.span = parameter.span.to(self.reader.tree.operand(operand).span);
            }
            None => {
                let found = self.reader.peek();
                let expected = if direction == Direction::In { "operand, `(`" } else { "variable" };
                self.reader.expected(found, expected);
            }
        }
        self.push_parameter(parameter);
        self.finish_parameter();
    }

    /// A value that is an instruction list; its parenthesis is the next token.
    fn open_value(&mut self, mut parameter: Parameter) {
        let (open, token) = (self.reader.tokens[self.reader.at].span, self.reader.at);
        self.reader.at += 1;
        parameter.value = ParameterValue::Instructions;
        let number = self.push_parameter(parameter);
        let item = ItemKind::ParameterOpen { parameter: 0 };
        let item = self.reader.push_item(parameter.span.to(open), self.frames.len(), item);
        if let Some(Frame { kind: FrameKind::List(list), .. }) = self.frames.last_mut() {
            list.values.push((item, number));
        }
        self.open(FrameKind::Value, open, token);
        if self.reader.kind(0).is_some_and(|kind| kind != TokenKind::Newline) {
            self.reader.hint(open, "lenient-form.line-after-parenthesis");
        }
    }

    /// After a parameter comes a comma, or the end of the list, perhaps on the next line.
    pub fn finish_parameter(&mut self) {
        let Some(next) = self.reader.peek() else { return };
        let formal = self.list_form() == Some(ListForm::Formal);
        if next.region != Region::Body {
            return;
        }
        match next.kind {
            TokenKind::Comma => {
                self.reader.at += 1;
                let line_ends = self.reader.kind(0).is_none_or(|kind| kind == TokenKind::Newline);
                if formal != line_ends {
                    self.hint_layout(next.span);
                }
                let rest = &self.reader.tokens[self.reader.at..];
                let behind = rest.iter().find(|token| token.kind != TokenKind::Newline).copied();
                if let Some(end) = behind.filter(|token| token.kind == TokenKind::RightParenthesis) {
                    self.reader.expected(Some(end), "parameter");
                }
            }
            TokenKind::RightParenthesis if formal => self.hint_layout(next.span),
            TokenKind::RightParenthesis => {}
            TokenKind::Newline => {
                self.reader.at += 1;
                while self.reader.take(TokenKind::Newline).is_some() {}
                match self.reader.peek() {
                    Some(end) if end.kind == TokenKind::RightParenthesis && formal => {}
                    Some(end) if end.kind == TokenKind::RightParenthesis => self.hint_layout(end.span),
                    Some(_) if self.list_is_forgotten() => {}
                    Some(next)
                        if next.region == Region::Body && !next.kind.closes() && !next.kind.opens_unit() =>
                    {
                        let before = self.last_word_before(self.reader.at);
                        self.reader.expected_at_end(before, "`,`, `)`");
                    }
                    _ => {}
                }
            }
            kind if kind.opens_unit() || kind.closes() => {}
            _ => {
                self.reader.expected(Some(next), "`,`, `)`");
                self.skip_parameter();
            }
        }
    }

    /// The end of a list: its parameters get their places side by side.
    pub fn finish_list(&mut self, list: List, last: Token) {
        let run = append(&mut self.reader.tree.parameters, list.parameters);
        for (item, number) in list.values {
            if let Some(item) = self.reader.tree.items.get_mut(item) {
                item.kind = ItemKind::ParameterOpen { parameter: run.start + number as u32 };
            }
        }
        let Some(item) = self.reader.tree.items.get_mut(list.item) else { return };
        item.span = item.span.to(last.span);
        if let ItemKind::Call { form, parameters, .. } | ItemKind::Function { form, parameters, .. } =
            &mut item.kind
        {
            *form = list.form;
            *parameters = run;
        }
    }

    /// An operand without a name.
    pub fn positional(&self, operand: OperandId) -> Parameter {
        Parameter {
            span: self.reader.tree.operand(operand).span,
            name: None,
            direction: Direction::In,
            value: ParameterValue::Operand(operand),
        }
    }

    fn list_form(&self) -> Option<ListForm> {
        match self.frames.last() {
            Some(Frame { kind: FrameKind::List(list), .. }) => Some(list.form),
            _ => None,
        }
    }

    /// Adds a parameter to the innermost list; gives its number there.
    fn push_parameter(&mut self, parameter: Parameter) -> usize {
        match self.frames.last_mut() {
            Some(Frame { kind: FrameKind::List(list), .. }) => {
                list.parameters.push(parameter);
                list.parameters.len() - 1
            }
            _ => 0,
        }
    }

    /// To the next comma, the end of the line or the end of the list; at least one token.
    fn skip_parameter(&mut self) {
        let start = self.reader.at;
        while let Some(token) = self.reader.peek() {
            match token.kind {
                TokenKind::Newline | TokenKind::RightParenthesis => break,
                TokenKind::Comma => {
                    self.reader.at += 1;
                    break;
                }
                _ if token.region != Region::Body || token.kind.opens_unit() || token.kind.closes() => break,
                TokenKind::LeftParenthesis => self.skip_pair(),
                _ => self.reader.at += 1,
            }
        }
        // A token that stops the skipping is handled by whoever reads on; anything else was passed.
        debug_assert!(
            self.reader.at > start || self.reader.peek().is_none_or(|token| !token.kind.starts_operand())
        );
    }
}
