//! Reads bodies: labels, instructions, parentheses and calls.
//!
//! Written by hand, not with the grammar's combinators, for two reasons: parentheses nest to any depth and must not
//! use the stack, and almost every line is one word with one operand, for which looking at two tokens is all it takes.

use super::configure::read_configuration;
use super::declare::{Block, read_result, read_section, read_types};
use super::reader::Reader;
use super::scan::{ends_open_list, leaves_parentheses};
use super::token::{Region, Token, TokenKind};
use super::{ItemKind, ListForm, Parameter, PouKind};
use crate::text::{Fix, Message, Span, TextEdit};

/// The parser of a chunk.
pub struct BodyReader<'a> {
    /// Tokens and tree.
    pub reader: Reader<'a>,
    /// What is open around the next token, innermost last.
    pub frames: Vec<Frame>,
    /// For each token that is a parenthesis, the index of the other one of the pair.
    pub partners: Vec<Option<u32>>,
}

/// An open parenthesis.
pub struct Frame {
    pub kind: FrameKind,
    /// The parenthesis, and the index of its token.
    pub open: Span,
    pub token: usize,
}

/// What an open parenthesis encloses.
pub enum FrameKind {
    /// `AND(`: instructions.
    Expression,
    /// `name := (`: instructions whose result is the value of a parameter.
    Value,
    /// `CAL T1(`, `LIMIT(`: parameters.
    List(List),
}

/// A list of parameters that is being read.
pub struct List {
    /// Index of the call among the items.
    pub item: usize,
    pub form: ListForm,
    pub parameters: Vec<Parameter>,
    /// The items that open the value of a parameter, with the number of that parameter in this list.
    pub values: Vec<(usize, usize)>,
    /// Whether something stands otherwise than the standard has it; said once for each list.
    pub lenient: bool,
}

impl<'a> BodyReader<'a> {
    pub fn new(reader: Reader<'a>) -> BodyReader<'a> {
        let partners = partners(&reader.tokens);
        BodyReader { reader, frames: Vec::new(), partners }
    }

    /// Reads everything.
    pub fn read(mut self) -> Reader<'a> {
        while let Some(token) = self.reader.peek() {
            if self.frames.is_empty() && self.read_outside(token) {
                continue;
            }
            let at_end = token.region != Region::Body || token.kind.opens_unit() || token.kind.closes();
            if at_end && !self.frames.is_empty() {
                self.close_all();
            } else if matches!(self.frames.last(), Some(Frame { kind: FrameKind::List(_), .. })) {
                self.read_parameter(token);
            } else {
                self.read_line(token);
            }
        }
        self.close_all();
        self.reader
    }

    /// What stands outside of bodies; tells whether it was that.
    fn read_outside(&mut self, token: Token) -> bool {
        match token.region {
            Region::Section => {
                let block = Block::take(&mut self.reader);
                let mut at = 0;
                while at < block.kinds.len() {
                    at = read_section(&mut self.reader, &block, at);
                }
            }
            Region::Types => {
                let block = Block::take(&mut self.reader);
                read_types(&mut self.reader, &block);
            }
            Region::Configuration => {
                let block = Block::take(&mut self.reader);
                read_configuration(&mut self.reader, &block);
            }
            Region::Body if token.kind.opens_unit() => self.read_header(token),
            Region::Body if token.kind.closes_unit() => {
                self.reader.at += 1;
                self.reader.push_item(token.span, 0, ItemKind::PouEnd(unit_kind(token.kind)));
                self.finish_line();
            }
            Region::Body => return false,
        }
        true
    }

    fn read_header(&mut self, token: Token) {
        self.reader.at += 1;
        let name = self.reader.peek().filter(|next| {
            next.region == Region::Body && (next.kind == TokenKind::Word || next.kind.is_keyword())
        });
        let mut result = None;
        match name {
            Some(name) => {
                self.reader.check_name(name.span);
                if token.kind == TokenKind::Function && self.reader.kind(1) == Some(TokenKind::Colon) {
                    result = read_result(&mut self.reader);
                } else {
                    self.reader.at += 1;
                }
            }
            None => {
                let next = self.reader.peek();
                self.reader.expected(next, TokenKind::Word.name());
                self.skip_line();
            }
        }
        let end = self.last_word_before(self.reader.at);
        let name = name.map(|name| name.span);
        let kind = ItemKind::Pou { kind: unit_kind(token.kind), name, result };
        self.reader.push_item(token.span.to(end), 0, kind);
        self.finish_line();
    }

    /// A line of instructions, or what is left of one.
    fn read_line(&mut self, token: Token) {
        match token.kind {
            TokenKind::Newline => self.reader.at += 1,
            TokenKind::Semicolon => {
                self.reader.stray_semicolon(token.span);
                self.reader.at += 1;
            }
            TokenKind::RightParenthesis => self.close(token),
            TokenKind::Word => self.read_statement(token),
            TokenKind::Number if self.reader.kind(1) == Some(TokenKind::Colon) => {
                let message = Message::new("syntax-error.numeric-label");
                self.reader.problem("syntax-error", token.span, message);
                self.reader.at += 2;
            }
            TokenKind::LeftParenthesis => {
                self.reader.expected(Some(token), "instruction");
                self.skip_pair();
                self.skip_line();
            }
            _ => {
                self.reader.expected(Some(token), "instruction");
                self.reader.at += 1;
                self.skip_line();
            }
        }
    }

    /// After an instruction comes the end of its line.
    pub fn finish_line(&mut self) {
        let Some(next) = self.reader.peek() else { return };
        match next.kind {
            _ if next.region != Region::Body || next.kind.opens_unit() || next.kind.closes() => {}
            TokenKind::Newline => self.reader.at += 1,
            TokenKind::RightParenthesis => {
                if self.frames.is_empty() {
                    self.close(next);
                }
            }
            TokenKind::Semicolon => {
                self.reader.stray_semicolon(next.span);
                self.reader.at += 1;
            }
            _ => {
                self.reader.expected(Some(next), TokenKind::Newline.name());
                self.skip_line();
            }
        }
    }

    /// Goes to the end of the line, over whole pairs of parentheses, but not past one that closes what is open.
    pub fn skip_line(&mut self) {
        while let Some(token) = self.reader.peek() {
            let partner = self.partners[self.reader.at].map(|partner| partner as usize);
            match token.kind {
                TokenKind::Newline => break,
                _ if token.region != Region::Body || token.kind.opens_unit() || token.kind.closes() => break,
                TokenKind::LeftParenthesis => self.reader.at = partner.unwrap_or(self.reader.at),
                TokenKind::RightParenthesis
                    if partner.is_some_and(|partner| {
                        self.frames.iter().rev().any(|frame| frame.token == partner)
                    }) =>
                {
                    break;
                }
                _ => {}
            }
            self.reader.at += 1;
        }
    }

    /// Over a pair of parentheses, or the one that has no partner.
    pub fn skip_pair(&mut self) {
        self.reader.at = self.partners[self.reader.at].map_or(self.reader.at, |partner| partner as usize) + 1;
    }

    /// The last word before token `index`.
    pub fn last_word_before(&self, index: usize) -> Span {
        let before = self.reader.tokens.get(..index).unwrap_or(&[]);
        let word = before.iter().rev().find(|token| token.kind != TokenKind::Newline);
        word.map_or(Span::at(0), |token| token.span)
    }

    pub fn open(&mut self, kind: FrameKind, open: Span, token: usize) {
        // A parenthesis that should not be there need not be closed.
        let reported = self.reader.tree.problems.last().is_some_and(|problem| problem.span == open);
        if self.partners[token].is_none() && !reported {
            self.reader.problem("unclosed-parenthesis", open, Message::new("unclosed-parenthesis.open"));
        }
        self.frames.push(Frame { kind, open, token });
    }

    /// A closing parenthesis, the next token.
    pub fn close(&mut self, token: Token) {
        self.reader.at += 1;
        let depth = self.frames.len().saturating_sub(1);
        match self.frames.pop() {
            None => {
                let message = Message::new("syntax-error.stray-parenthesis");
                self.reader.problem("syntax-error", token.span, message);
                self.skip_line();
            }
            Some(Frame { kind: FrameKind::List(list), .. }) => {
                self.finish_list(list, token);
                self.finish_line();
            }
            Some(Frame { kind: FrameKind::Expression, .. }) => {
                if !self.reader.starts_line(self.reader.at - 1) {
                    self.reader.hint(token.span, "lenient-form.parenthesis-line");
                }
                self.reader.push_item(token.span, depth, ItemKind::Close);
                self.finish_line();
            }
            // What follows is the next parameter or the end of the list.
            Some(Frame { kind: FrameKind::Value, .. }) => {
                self.reader.push_item(token.span, depth, ItemKind::Close);
                self.finish_parameter();
            }
        }
    }

    /// Everything that is open ends without its parenthesis.
    pub fn close_all(&mut self) {
        while !self.frames.is_empty() {
            self.close_innermost();
        }
    }

    /// The innermost list ends without its parenthesis; that was reported when it was opened, unless another
    /// parenthesis seemed to be its own.
    pub fn close_innermost(&mut self) {
        let Some(frame) = self.frames.pop() else { return };
        if self.partners[frame.token].is_some() {
            self.reader.problem(
                "unclosed-parenthesis",
                frame.open,
                Message::new("unclosed-parenthesis.open"),
            );
        }
        self.offer_parenthesis(&frame);
        if let FrameKind::List(list) = frame.kind {
            let last = self.reader.tokens[self.reader.at.saturating_sub(1)];
            self.finish_list(list, last);
        }
    }

    /// Adds to what was reported of an open parenthesis the one that closes it here: that of a deferred operation on a
    /// line of its own, as the standard wants it. The outermost ones get theirs; more are closed once these are.
    fn offer_parenthesis(&mut self, frame: &Frame) {
        if self.frames.len() >= MOST_OFFERED {
            return;
        }
        let Some(last) = self.reader.at.checked_sub(1).and_then(|at| self.reader.tokens.get(..=at)) else {
            return;
        };
        let Some(last) = last.iter().rev().find(|token| token.kind != TokenKind::Newline) else { return };
        let text = self.reader.text;
        let line = text.get(..frame.open.start as usize).unwrap_or("");
        let line = &text[line.rfind('\n').map_or(0, |newline| newline + 1)..];
        let margin = &line[..line.len() - line.trim_start_matches([' ', '\t']).len()];
        let rest = text.get(frame.open.end as usize..).unwrap_or("");
        let is_crlf = rest.find('\n').is_some_and(|newline| rest[..newline].ends_with('\r'));
        let newline = if is_crlf { "\r\n" } else { "\n" };
        let close = match frame.kind {
            FrameKind::Expression => format!("{newline}{margin})"),
            FrameKind::Value | FrameKind::List(_) => ")".to_string(),
        };
        let problems = self.reader.tree.problems.iter_mut().rev();
        let mut inside = problems.take_while(|one| one.span.start >= frame.open.start);
        if let Some(problem) = inside.find(|one| one.code == "unclosed-parenthesis" && one.span == frame.open)
        {
            let edits = vec![TextEdit::new(Span::at(last.span.end as usize), close)];
            problem.fixes.push(Fix { title: Message::new("unclosed-parenthesis.close"), edits });
        }
    }

    /// Whether the next line shows that the innermost list lacks its parenthesis.
    pub fn list_is_forgotten(&self) -> bool {
        self.reader.starts_line(self.reader.at)
            && (ends_open_list(self.reader.rest_of_line(), self.reader.text)
                || leaves_parentheses(self.reader.rest_of_line(), self.reader.text))
    }
}

/// So many parentheses that wait for each other are closed by fixes.
const MOST_OFFERED: usize = 32;

fn unit_kind(kind: TokenKind) -> PouKind {
    match kind {
        TokenKind::Program | TokenKind::EndProgram => PouKind::Program,
        TokenKind::FunctionBlock | TokenKind::EndFunctionBlock => PouKind::FunctionBlock,
        _ => PouKind::Function,
    }
}

/// The pairs of parentheses in bodies; units and regions end what is open.
fn partners(tokens: &[Token]) -> Vec<Option<u32>> {
    let mut partners = vec![None; tokens.len()];
    let mut open = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        match token.kind {
            _ if token.region != Region::Body => open.clear(),
            kind if kind.opens_unit() || kind.closes() => open.clear(),
            TokenKind::LeftParenthesis => open.push(index),
            TokenKind::RightParenthesis => {
                if let Some(partner) = open.pop() {
                    partners[index] = Some(partner as u32);
                    partners[partner] = Some(index as u32);
                }
            }
            _ => {}
        }
    }
    partners
}
