//! Where a file is cut into chunks.
//!
//! A chunk is the header of a program unit, one section of variables, one TYPE block, one configuration, or a piece of
//! a body from one load at parenthesis depth 0 to the next. Comments and labels directly above go with what follows.
//!
//! The cuts are found in one pass, line by line, and the pass is in the same state after every cut as at the start of
//! a text. Whether there is a cut at an offset therefore depends on nothing before the cut before it and nothing after
//! the chunk that starts there. That is what makes an incremental document possible: after an edit, cutting a window
//! that starts at a cut with an untouched chunk behind it, and going on until an old cut with an untouched chunk
//! behind it appears, yields what cutting the whole file would.

use super::scan::{Scanner, ends_open_list, leaves_parentheses};
use super::token::{Region, Token, TokenKind};
use crate::target::iec::{Operator, OperatorRole};

/// The ends of the chunks of `text`: the last one is `text.len()`; an empty text has none.
///
/// ```
/// # use rungwise::il::iec::split;
/// assert_eq!(split("LD a\nST b\n(* then *)\nLD c\nST d\n"), [10, 31]);
/// ```
pub fn split(text: &str) -> Vec<usize> {
    let mut cutter = Cutter { text, ..Cutter::default() };
    let mut line = Vec::new();
    let mut start = 0;
    for token in Scanner::new(text) {
        if token.kind != TokenKind::Newline {
            line.push(token);
            continue;
        }
        cutter.line(start, &line);
        line.clear();
        start = token.span.end as usize;
    }
    cutter.line(start, &line);
    if !text.is_empty() {
        cutter.ends.push(text.len());
    }
    cutter.ends
}

/// What a line is to the cutter.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Line {
    Blank,
    Comment,
    /// A label alone.
    Label,
    /// LD or LDN at depth 0, perhaps behind a label.
    Load,
    /// The first word of a unit, a section, a TYPE block or a configuration.
    Block,
    Other,
}

/// What a parenthesis encloses.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Parenthesis {
    /// Not known before the next word: `ADD(` starts an expression or a call with named parameters.
    Unknown,
    Instructions,
    Parameters,
}

#[derive(Default)]
struct Cutter<'a> {
    text: &'a str,
    ends: Vec<usize>,
    /// Whether anything but comments and blank lines stands in the chunk, above `candidate`.
    content: bool,
    /// Whether the last word of the chunk closed a section, a unit, a TYPE block or a configuration.
    closed: bool,
    /// The start of the comments and labels directly above the current line.
    candidate: Option<usize>,
    /// Whether there is a label among them, which binds across blank lines.
    labelled: bool,
    parentheses: Vec<Parenthesis>,
}

impl Cutter<'_> {
    fn line(&mut self, start: usize, line: &[Token]) {
        let trivia = line.iter().any(|token| token.kind.is_trivia());
        let words: Vec<Token>;
        let line = if trivia {
            words = line.iter().copied().filter(|token| !token.kind.is_trivia()).collect();
            &words
        } else {
            line
        };
        match self.classify(line, trivia) {
            Line::Blank if self.labelled => {}
            Line::Blank => self.candidate = None,
            Line::Comment => _ = self.candidate.get_or_insert(start),
            Line::Label => {
                let start = *self.candidate.get_or_insert(start);
                if self.closed {
                    self.cut(start);
                }
                self.labelled = true;
            }
            Line::Load | Line::Block => self.statement(start, true),
            Line::Other => self.statement(start, self.closed),
        }
        if !line.is_empty() {
            let last = line.iter().rev().find(|token| token.kind != TokenKind::Semicolon);
            self.closed = last.is_some_and(|last| last.kind.closes() && is_last_word(last));
        }
        self.follow_parentheses(line);
    }

    fn classify(&mut self, line: &[Token], trivia: bool) -> Line {
        let Some(first) = line.first() else { return if trivia { Line::Comment } else { Line::Blank } };
        if starts_block(first) {
            self.parentheses.clear();
            return Line::Block;
        }
        if first.region != Region::Body {
            return Line::Other;
        }
        self.close_what_is_open(line);
        let label = matches!(line.get(1), Some(token) if token.kind == TokenKind::Colon)
            && first.kind == TokenKind::Word;
        let instruction = if label { line.get(2..).unwrap_or(&[]) } else { line };
        match instruction.first() {
            _ if !self.parentheses.is_empty() => Line::Other,
            None => Line::Label,
            Some(word) if word.kind == TokenKind::Word && self.is_load(word) => Line::Load,
            Some(_) => Line::Other,
        }
    }

    fn is_load(&self, word: &Token) -> bool {
        Operator::written(word.span.of(self.text))
            .is_some_and(|written| written.operator.role == OperatorRole::Load)
    }

    /// A line that is neither comment nor lone label; a chunk starts with it, or with what stands above it, if `cuts`.
    fn statement(&mut self, start: usize, cuts: bool) {
        let start = self.candidate.take().unwrap_or(start);
        if cuts {
            self.cut(start);
        }
        self.content = true;
        self.labelled = false;
    }

    fn cut(&mut self, at: usize) {
        if std::mem::take(&mut self.content) {
            self.ends.push(at);
        }
    }

    /// Parentheses that this line shows to be forgotten are closed before it.
    fn close_what_is_open(&mut self, line: &[Token]) {
        let Some(innermost) = self.parentheses.last_mut() else { return };
        if *innermost == Parenthesis::Unknown {
            let named = names_parameter(line, self.text);
            *innermost = if named { Parenthesis::Parameters } else { Parenthesis::Instructions };
        }
        if leaves_parentheses(line, self.text) {
            self.parentheses.clear();
        } else if *innermost == Parenthesis::Parameters && ends_open_list(line, self.text) {
            self.parentheses.pop();
        }
    }

    fn follow_parentheses(&mut self, line: &[Token]) {
        for (index, token) in line.iter().enumerate() {
            match token.kind {
                _ if token.region != Region::Body => self.parentheses.clear(),
                kind if kind.opens_unit() || kind.closes() => self.parentheses.clear(),
                TokenKind::RightParenthesis => _ = self.parentheses.pop(),
                TokenKind::LeftParenthesis => {
                    let before = line.get(..index).unwrap_or(&[]);
                    let after = line.get(index + 1..).unwrap_or(&[]);
                    self.parentheses.push(self.kind_of_parenthesis(before, after));
                }
                _ => {}
            }
        }
    }

    fn kind_of_parenthesis(&self, before: &[Token], after: &[Token]) -> Parenthesis {
        match before.last() {
            Some(token) if token.kind == TokenKind::Assign => Parenthesis::Instructions,
            Some(token) if Operator::written(token.span.of(self.text)).is_some() => match after {
                [] => Parenthesis::Unknown,
                after if names_parameter(after, self.text) => Parenthesis::Parameters,
                _ => Parenthesis::Instructions,
            },
            _ => Parenthesis::Parameters,
        }
    }
}

fn starts_block(first: &Token) -> bool {
    let kind = first.kind;
    match first.region {
        Region::Body => kind.opens_unit(),
        Region::Section => kind.opens_section(),
        Region::Types => kind == TokenKind::Type,
        Region::Configuration => kind == TokenKind::Configuration,
    }
}

/// Whether the word that closes something closes the region that it stands in.
fn is_last_word(token: &Token) -> bool {
    match token.region {
        Region::Body => true,
        Region::Section => token.kind == TokenKind::EndVar,
        Region::Types => token.kind == TokenKind::EndType,
        Region::Configuration => token.kind == TokenKind::EndConfiguration,
    }
}

/// `name :=`, `name =>`, `NOT name =>`.
pub(super) fn names_parameter(tokens: &[Token], text: &str) -> bool {
    use TokenKind::{Arrow, Assign, Word};
    match tokens {
        [name, sign, ..] if name.kind == Word && matches!(sign.kind, Assign | Arrow) => true,
        [not, name, sign, ..] => {
            not.span.of(text).eq_ignore_ascii_case("NOT") && name.kind == Word && sign.kind == Arrow
        }
        _ => false,
    }
}
