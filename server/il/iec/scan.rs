//! Text to tokens, by a scanner that knows in what kind of text it is.

use super::token::{Region, Token, TokenKind};
use crate::target::iec::Operator;
use crate::text::Span;
use logos::{Lexer, Logos};

/// Reads tokens and keeps track of the region, which decides what a semicolon means.
///
/// A scanner that starts at the end of a chunk is in the state of one that came there: outside of everything.
#[derive(Clone)]
pub struct Scanner<'a> {
    lexer: Lexer<'a, TokenKind>,
    region: Region,
    /// Whether the region ends with the token just read.
    leaves: bool,
    /// Whether no word of the line stands before the next token, words that close a region aside.
    fresh: bool,
    /// The last token that is no comment.
    previous: Option<(TokenKind, usize)>,
}

impl<'a> Scanner<'a> {
    /// A scanner of `text`.
    pub fn new(text: &'a str) -> Scanner<'a> {
        let lexer = TokenKind::lexer(text);
        Scanner { lexer, region: Region::Body, leaves: false, fresh: true, previous: None }
    }

    /// A scanner of `text`, which stands in a text of this kind.
    pub fn inside(text: &'a str, region: Region) -> Scanner<'a> {
        Scanner { region, ..Scanner::new(text) }
    }

    fn complete(&mut self, kind: TokenKind) -> TokenKind {
        use TokenKind::*;
        let start = self.lexer.span().start;
        let rest = self.lexer.remainder();
        match kind {
            Comment => match comment_length(self.lexer.slice(), rest) {
                Some(length) => self.bump(length, Comment),
                None => self.bump(rest.len(), UnclosedComment),
            },
            Pragma => match rest.find('}') {
                Some(close) => self.bump(close + 1, Pragma),
                None => self.bump(rest.len(), UnclosedPragma),
            },
            Semicolon if self.region == Region::Body && self.semicolon_starts_comment(start, rest) => {
                let end = rest.find(['\r', '\n']).unwrap_or(rest.len());
                self.bump(end, SemicolonComment)
            }
            // `1.` and `.5` are no reals, but they are one word, which the reader of literals rejects.
            Number if rest.starts_with('.') && !rest.starts_with("..") => self.bump(1, Number),
            Dot if self.previous.is_none_or(|(_, end)| end != start) && starts_with_digit(rest) => {
                let digits = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
                self.bump(digits, Number)
            }
            kind => kind,
        }
    }

    fn bump(&mut self, length: usize, kind: TokenKind) -> TokenKind {
        self.lexer.bump(length);
        kind
    }

    /// Instructions have no terminator, so a semicolon behind a blank starts a comment in the texts of many tools.
    /// One that is glued to an operand, or with nothing behind it, is a stray terminator.
    fn semicolon_starts_comment(&self, start: usize, rest: &str) -> bool {
        let line = rest.trim_start_matches([' ', '\t', '\r']);
        let blank =
            line.is_empty() || ["\n", "(*", "//", "/*", "{"].iter().any(|open| line.starts_with(open));
        let glued = self.previous.is_some_and(|(kind, end)| end == start || kind.closes());
        !blank && !glued
    }

    /// The kind of the next token that is no comment.
    fn peek(&self) -> Option<TokenKind> {
        let mut ahead = self.clone();
        std::iter::from_fn(move || ahead.next_kind()).find(|kind| !kind.is_trivia())
    }

    fn next_kind(&mut self) -> Option<TokenKind> {
        let kind = self.lexer.next()?.unwrap_or(TokenKind::Unexpected);
        Some(self.complete(kind))
    }

    /// Whether `kind`, the first word of its line, cannot belong to the region, which therefore lacks its end.
    fn ends_region(&self, kind: TokenKind) -> bool {
        use TokenKind::*;
        match self.region {
            Region::Body => false,
            Region::Section => {
                let loads = || {
                    let word = self.lexer.slice();
                    (word.eq_ignore_ascii_case("LD") || word.eq_ignore_ascii_case("LDN"))
                        && self.peek().is_some_and(TokenKind::starts_operand)
                };
                kind.opens_section()
                    || kind.opens_unit()
                    || kind.closes_unit()
                    || matches!(kind, Type | Configuration)
                    || (kind == Word && loads())
            }
            Region::Types => {
                kind.opens_section()
                    || kind.opens_unit()
                    || kind.closes_unit()
                    || matches!(kind, Type | Configuration)
            }
            Region::Configuration => match kind {
                Program => !self.is_instance(),
                VarGlobal | VarAccess | VarConfig => false,
                Configuration | Type | Function | FunctionBlock => true,
                kind => kind.opens_section() || kind.closes_unit(),
            },
        }
    }

    /// Whether the `PROGRAM` just read is one of a configuration: `PROGRAM name WITH`, `PROGRAM name :`.
    fn is_instance(&self) -> bool {
        let mut ahead = self.clone();
        let mut kinds = std::iter::from_fn(move || ahead.next_kind())
            .filter(|kind| !kind.is_trivia() && !matches!(kind, TokenKind::Retain | TokenKind::NonRetain));
        // While the name is still being typed, the configuration goes on.
        match kinds.next() {
            Some(TokenKind::Word) => matches!(kinds.next(), Some(TokenKind::With | TokenKind::Colon)),
            _ => true,
        }
    }

    fn enter_region(&mut self, kind: TokenKind) {
        use TokenKind::*;
        let member = matches!(self.previous, Some((Dot, end)) if end == self.lexer.span().start);
        self.region = match kind {
            _ if member => Region::Body,
            kind if kind.opens_section() => Region::Section,
            Type if self.fresh => Region::Types,
            Configuration if self.fresh => Region::Configuration,
            _ => Region::Body,
        };
    }
}

impl Iterator for Scanner<'_> {
    type Item = Token;

    fn next(&mut self) -> Option<Token> {
        use TokenKind::*;
        if std::mem::take(&mut self.leaves) {
            self.region = Region::Body;
        }
        let kind = self.next_kind()?;
        let span = Span::new(self.lexer.span().start, self.lexer.span().end);
        if kind.is_trivia() {
            return Some(Token { kind, span, region: self.region });
        }
        if self.fresh && self.ends_region(kind) {
            self.region = Region::Body;
        }
        if self.region == Region::Body {
            self.enter_region(kind);
        }
        self.leaves = match self.region {
            Region::Body => false,
            Region::Section => kind == EndVar,
            Region::Types => kind == EndType,
            Region::Configuration => kind == EndConfiguration,
        };
        self.fresh = match kind {
            Newline => true,
            Semicolon => self.fresh,
            kind => kind.closes(),
        };
        // A line starts as a text does, so that a chunk reads alone as it reads in its file.
        self.previous = (kind != Newline).then_some((kind, span.end as usize));
        Some(Token { kind, span, region: self.region })
    }
}

/// How many bytes of `rest` belong to the comment that starts with `open`, or nothing if it does not end.
///
/// Comments of one kind nest, as the third edition has it.
fn comment_length(open: &str, rest: &str) -> Option<usize> {
    let (open, close) = match open {
        "(*" => (b"(*", b"*)"),
        "/*" => (b"/*", b"*/"),
        _ => return Some(rest.find(['\r', '\n']).unwrap_or(rest.len())),
    };
    let bytes = rest.as_bytes();
    let (mut depth, mut at) = (1, 0);
    while let Some(pair) = bytes.get(at..at + 2) {
        at += 2;
        if pair == close {
            depth -= 1;
            if depth == 0 {
                return Some(at);
            }
        } else if pair == open {
            depth += 1;
        } else {
            at -= 1;
        }
    }
    None
}

fn starts_with_digit(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit())
}

/// Whether the line that starts with `line` shows that the list of parameters around it lacks its parenthesis: two
/// words side by side, or a label. `before` is the token before the line.
///
/// While a call is being typed, the instructions below it must not be swallowed as its parameters.
pub fn ends_open_list(line: &[Token], text: &str) -> bool {
    let [first, second, ..] = line else { return false };
    let negation = first.span.of(text).eq_ignore_ascii_case("NOT");
    first.kind == TokenKind::Word
        && !negation
        && (second.kind.starts_operand() || second.kind == TokenKind::Colon)
}

/// Whether the line that starts with `line` cannot stand inside parentheses of any kind: a jump, a call, a return or
/// a label.
pub fn leaves_parentheses(line: &[Token], text: &str) -> bool {
    use crate::target::iec::OperatorRole::{Call, Jump, Return};
    let Some(first) = line.first().filter(|token| token.kind == TokenKind::Word) else { return false };
    let second = line.get(1).map(|token| token.kind);
    match second {
        Some(TokenKind::Colon) => true,
        // A parameter may be called `RET`.
        Some(TokenKind::Assign | TokenKind::Arrow) => false,
        _ => Operator::written(first.span.of(text))
            .is_some_and(|written| matches!(written.operator.role, Jump | Call | Return)),
    }
}
