//! Tree to canonical text.
//!
//! Keywords and operators in upper case, names as spelled. Labels stand alone at the first column, operators are
//! indented by one step and one more for each open parenthesis, operands start at one fixed column behind: a chunk is
//! formatted alone, so no column can depend on the rest of its program unit. Named parameters and declarations stand
//! on lines of their own; the colons and values of neighbouring declarations are aligned. Comments stay where they
//! are, those behind code at one column. Lines with a mistake are left alone.

use super::layout::Layout;
use super::scan::Scanner;
use super::token::{Region, Token, TokenKind};
use super::{IecTree, ItemKind, parse, split};
use crate::target::iec::is_keyword;
use crate::target::{Model, Target};
use crate::text::{Severity, Span};
use std::borrow::Cow;
use std::mem::{Discriminant, discriminant};

/// Columns from an operator to its operand.
const OPERAND_COLUMN: usize = 8;

/// Where comments behind code start, if the code is shorter.
const COMMENT_COLUMN: usize = 40;

/// How a chunk is formatted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FormatOptions {
    /// Columns of one step of indentation; 4 unless the editor says otherwise.
    pub indent: usize,
}

impl Default for FormatOptions {
    fn default() -> FormatOptions {
        FormatOptions { indent: 4 }
    }
}

/// The canonical text of `chunk`, whose tree is `tree`: formatting it again changes nothing, and it has the same tree.
pub fn format_chunk(chunk: &str, tree: &IecTree, options: &FormatOptions) -> String {
    let formatted = Printer::new(chunk, tree, options).print();
    // A broken text may read otherwise once it is moved; then it stays as it is, for a formatter must change nothing.
    let target = Target::of(Model::Iec);
    let again = parse(&formatted, target);
    let stable = match split(&formatted)[..] {
        [_] => formatted == Printer::new(&formatted, &again, options).print(),
        // What stood on one line may be several chunks on lines of its own.
        ref ends => {
            let mut start = 0;
            ends.iter().all(|end| {
                let part = &formatted[std::mem::replace(&mut start, *end)..*end];
                part == Printer::new(part, &parse(part, target), options).print()
            })
        }
    };
    if stable && meaning(chunk, tree).eq(meaning(&formatted, &again)) { formatted } else { chunk.to_string() }
}

/// One thing that must not change.
#[derive(PartialEq)]
enum Meaning<'t> {
    Word(Cow<'t, str>),
    Item(Discriminant<ItemKind>, u32),
    Mistake(&'static str, Cow<'t, str>),
}

/// What must not change: the words, the kinds and depths of the items, and the mistakes.
fn meaning<'t>(chunk: &'t str, tree: &'t IecTree) -> impl Iterator<Item = Meaning<'t>> {
    let words = Scanner::new(chunk)
        .filter(|token| token.kind != TokenKind::Newline && !is_stray_semicolon(token))
        .map(|token| {
            let text = token.span.of(chunk);
            Meaning::Word(if token.kind.is_trivia() { text.into() } else { upper(text) })
        });
    let items = tree.items.iter().map(|item| Meaning::Item(discriminant(&item.kind), item.depth));
    let errors = tree.problems.iter().filter(|problem| problem.severity == Severity::Error);
    let errors = errors.map(|problem| Meaning::Mistake(problem.code, upper(problem.span.of(chunk))));
    words.chain(items).chain(errors)
}

/// A semicolon in a body, which ends nothing and is left out.
fn is_stray_semicolon(token: &Token) -> bool {
    token.kind == TokenKind::Semicolon && token.region == Region::Body
}

/// Most words are capitals already.
fn upper(text: &str) -> Cow<'_, str> {
    let is_upper = text.bytes().all(|byte| byte.is_ascii() && !byte.is_ascii_lowercase());
    if is_upper { text.into() } else { text.to_uppercase().into() }
}

/// One line of the result, before neighbours are aligned.
enum Line {
    /// As it stands in the source.
    Source(String),
    Code {
        indent: usize,
        code: String,
        comment: Option<String>,
    },
    Declaration {
        indent: usize,
        names: String,
        declared: String,
        value: String,
        comment: Option<String>,
    },
}

struct Printer<'a> {
    chunk: &'a str,
    options: &'a FormatOptions,
    layout: Layout,
    tokens: Vec<Token>,
    lines: Vec<Line>,
    /// Inside VAR … END_VAR, CONFIGURATION, RESOURCE, and how many STRUCT.
    section: bool,
    configuration: bool,
    resource: bool,
    structures: usize,
    /// Whether the last line left a declaration open.
    continues: bool,
}

impl<'a> Printer<'a> {
    fn new(chunk: &'a str, tree: &IecTree, options: &'a FormatOptions) -> Printer<'a> {
        let tokens: Vec<Token> = Scanner::new(chunk).collect();
        let layout = Layout::new(chunk, tree, &tokens);
        Printer {
            chunk,
            options,
            layout,
            tokens,
            lines: Vec::new(),
            section: false,
            configuration: false,
            resource: false,
            structures: 0,
            continues: false,
        }
    }

    fn print(mut self) -> String {
        let tokens = std::mem::take(&mut self.tokens);
        let mut start = 0;
        let mut first = 0;
        for index in 0..=tokens.len() {
            let end = match tokens.get(index) {
                Some(token) if token.kind == TokenKind::Newline => token.span,
                Some(_) => continue,
                None => Span::at(self.chunk.len()),
            };
            self.source_line(Span::new(start, end.start as usize), &tokens[first..index]);
            start = end.end as usize;
            first = index + 1;
        }
        self.place_comments();
        self.join()
    }

    /// One line of the source, which may become several.
    fn source_line(&mut self, span: Span, tokens: &[Token]) {
        let source = span.of(self.chunk).trim_end_matches(['\r', ' ', '\t']).to_string();
        if self.layout.is_broken(span) {
            self.follow(tokens);
            self.lines.push(Line::Source(source));
            return;
        }
        let code: Vec<Token> = tokens.iter().copied().filter(|token| !is_stray_semicolon(token)).collect();
        let mut rest: &[Token] = &code;
        if rest.iter().all(|token| token.kind.is_trivia()) {
            self.lines.push(Line::Source(source));
            return;
        }
        while !rest.is_empty() {
            let length = self.layout.line_length(rest);
            let (line, behind) = rest.split_at(length);
            self.line(line);
            rest = behind;
        }
    }

    fn line(&mut self, line: &[Token]) {
        let tail = line.iter().rev().take_while(|token| token.kind.is_trivia()).count();
        let (code, comments) = line.split_at(line.len() - tail);
        let comment = (!comments.is_empty()).then(|| self.joined(comments));
        let Some(first) = code.iter().find(|token| !token.kind.is_trivia()).copied() else {
            self.lines.push(Line::Source(comment.unwrap_or_default()));
            return;
        };
        if first.region == Region::Body {
            let (indent, code) = self.body_line(first, code);
            self.lines.push(Line::Code { indent, code, comment });
            return;
        }
        let level = self.level(first.kind) + usize::from(self.continues);
        let indent = level * self.options.indent;
        let declares = (self.section || first.region == Region::Types)
            && !self.continues
            && first.kind == TokenKind::Word;
        let colon = code.iter().position(|token| token.kind == TokenKind::Colon).filter(|_| declares);
        let line = match colon {
            Some(colon) => {
                let assign = code.iter().position(|token| token.kind == TokenKind::Assign);
                let assign = assign.filter(|assign| *assign > colon).unwrap_or(code.len());
                Line::Declaration {
                    indent,
                    names: self.joined(&code[..colon]),
                    declared: self.joined(&code[colon..assign]),
                    value: self.joined(&code[assign..]),
                    comment,
                }
            }
            None => Line::Code { indent, code: self.joined(code), comment },
        };
        self.lines.push(line);
        self.follow(code);
    }

    fn body_line(&self, first: Token, code: &[Token]) -> (usize, String) {
        let Some(place) = self.layout.place(first.span.start) else {
            // The words around program units stand at the left; what else starts no item goes on with one.
            let unit = first.kind.opens_unit() || first.kind.closes();
            return (if unit { 0 } else { 2 * self.options.indent }, self.joined(code));
        };
        // Past this depth a step to the right only makes lines long.
        let indent = (place.level.min(16) as usize) * self.options.indent;
        let head = code.iter().take_while(|token| token.span.start < place.head).count();
        if head == 0 {
            return (indent, self.joined(code));
        }
        let (head, operands) = code.split_at(head);
        let mut text = self.joined(head);
        let glued = operands.first().is_none_or(|token| token.kind == TokenKind::LeftParenthesis);
        if !glued {
            let width = text.chars().count();
            text.extend(std::iter::repeat_n(' ', OPERAND_COLUMN.saturating_sub(width).max(1)));
        }
        text.push_str(&self.joined(operands));
        (indent, text)
    }

    /// The level of a line outside of bodies that starts with `first`.
    fn level(&self, first: TokenKind) -> usize {
        let runtime = usize::from(self.configuration) + usize::from(self.resource);
        match first {
            TokenKind::Type | TokenKind::EndType | TokenKind::Configuration | TokenKind::EndConfiguration => {
                0
            }
            TokenKind::Resource | TokenKind::EndResource => 1,
            TokenKind::EndVar => runtime,
            kind if kind.opens_section() => runtime,
            TokenKind::EndStruct => runtime + self.structures,
            _ => {
                let types = !self.section && !self.configuration;
                runtime + usize::from(self.section || types) + self.structures
            }
        }
    }

    /// Keeps track of what is open outside of bodies.
    fn follow(&mut self, code: &[Token]) {
        for token in code.iter().filter(|token| token.region != Region::Body) {
            match token.kind {
                TokenKind::Configuration => {
                    self.section = false;
                    (self.configuration, self.resource) = (true, false);
                }
                TokenKind::EndConfiguration => (self.configuration, self.resource) = (false, false),
                TokenKind::Resource => self.resource = true,
                TokenKind::EndResource => self.resource = false,
                TokenKind::EndVar => self.section = false,
                TokenKind::Type => (self.section, self.structures) = (false, 0),
                TokenKind::Struct => self.structures += 1,
                TokenKind::EndStruct => self.structures = self.structures.saturating_sub(1),
                kind if kind.opens_section() => {
                    self.configuration &= token.region == Region::Configuration;
                    self.resource &= self.configuration;
                    (self.section, self.structures) = (true, 0);
                }
                _ => {}
            }
        }
        let Some(last) = code.iter().rev().find(|token| !token.kind.is_trivia()) else { return };
        let starts = code.iter().any(|token| {
            token.kind.opens_section() || matches!(token.kind, TokenKind::Configuration | TokenKind::Resource)
        });
        let ends = matches!(last.kind, TokenKind::Semicolon | TokenKind::Struct | TokenKind::Type);
        self.continues = last.region != Region::Body && !starts && !ends && !last.kind.closes();
    }

    /// Tokens with the blanks that belong between them.
    fn joined(&self, tokens: &[Token]) -> String {
        let mut text = String::new();
        for (index, token) in tokens.iter().enumerate() {
            let before = index.checked_sub(1).map(|before| tokens[before]);
            if before.is_some_and(|before| self.is_apart(before, *token)) {
                text.push(' ');
            }
            let word = token.span.of(self.chunk);
            let member = before.is_some_and(|before| before.kind == TokenKind::Dot);
            let capital = !member
                && (token.kind.is_keyword()
                    || token.kind == TokenKind::Address
                    || self.layout.is_operator(token.span.start)
                    || token.kind == TokenKind::Word && is_keyword(word));
            if capital {
                text.push_str(&word.to_ascii_uppercase());
            } else {
                text.push_str(word);
            }
        }
        text
    }

    /// Whether a blank stands between two tokens.
    fn is_apart(&self, before: Token, token: Token) -> bool {
        use TokenKind::*;
        if before.kind.is_trivia() || token.kind.is_trivia() {
            return true;
        }
        match (before.kind, token.kind) {
            (LeftParenthesis | LeftBracket | Caret, Word | Number | Typed | Text | Address)
            | (LeftParenthesis | LeftBracket, _)
            | (Dot | Dots, _) => false,
            // `1.` before `..` would become another number.
            (Number, Dots) => before.span.of(self.chunk).ends_with('.'),
            (_, Comma | Semicolon | RightParenthesis | RightBracket | Dot | Dots | Caret | Question) => false,
            (Assign | Arrow | Colon | Comma | Of | At, LeftParenthesis | LeftBracket) => true,
            (_, LeftBracket) => false,
            (_, LeftParenthesis) => false,
            (_, Colon) => token.region != Region::Body || self.layout.place(before.span.start).is_none(),
            _ => true,
        }
    }

    /// Comments on lines of their own stand above what they go with, or at the end of it; those that span lines stay.
    fn place_comments(&mut self) {
        let mut indent = None;
        for line in self.lines.iter_mut().rev() {
            match line {
                Line::Source(text) => {
                    let comment = text.trim_start();
                    let alone = ["(*", "//", "/*", "{", ";"].iter().any(|open| comment.starts_with(open));
                    if let Some(indent) = indent
                        && alone
                        && !text.contains('\n')
                    {
                        *text = format!("{}{comment}", " ".repeat(indent));
                    } else if !comment.is_empty() {
                        indent = None;
                    }
                }
                Line::Code { indent: place, code, .. } => {
                    let ends = code.get(..4).is_some_and(|word| word.eq_ignore_ascii_case("END_"));
                    indent = Some(if ends { *place + self.options.indent } else { *place });
                }
                Line::Declaration { indent: place, .. } => indent = Some(*place),
            }
        }
    }

    fn join(self) -> String {
        let newline = if self.chunk.contains("\r\n") { "\r\n" } else { "\n" };
        let widths = self.widths();
        let mut text = String::with_capacity(self.chunk.len() * 2);
        for (index, line) in self.lines.iter().enumerate() {
            if index > 0 {
                text.push_str(newline);
            }
            let (code, comment) = match line {
                Line::Source(source) => {
                    text.push_str(source);
                    continue;
                }
                Line::Code { indent, code, comment } => (format!("{}{code}", " ".repeat(*indent)), comment),
                Line::Declaration { indent, names, declared, value, comment } => {
                    let (names_width, declared_width) = widths[index];
                    let mut code = format!("{}{names:names_width$} {declared}", " ".repeat(*indent));
                    if !value.is_empty() {
                        let padding = declared_width.saturating_sub(declared.chars().count());
                        code.push_str(&format!("{} {value}", " ".repeat(padding)));
                    }
                    (code, comment)
                }
            };
            text.push_str(&code);
            if let Some(comment) = comment {
                let width = code.chars().count();
                text.push_str(&" ".repeat(COMMENT_COLUMN.saturating_sub(width).max(1)));
                text.push_str(comment);
            }
        }
        text
    }

    /// For each line the widest names and types among the declarations around it; comments and blank lines between
    /// declarations do not part them.
    fn widths(&self) -> Vec<(usize, usize)> {
        let mut widths = vec![(0, 0); self.lines.len()];
        let mut group: Vec<usize> = Vec::new();
        let mut most = (0, 0);
        let mut group_indent = 0;
        for (index, line) in self.lines.iter().enumerate() {
            let own = match line {
                Line::Source(_) => continue,
                Line::Code { .. } => None,
                Line::Declaration { indent, names, declared, value, .. } => {
                    let declared = if value.is_empty() { 0 } else { declared.chars().count() };
                    Some((*indent, names.chars().count(), declared))
                }
            };
            if own.is_none_or(|(indent, ..)| indent != group_indent) {
                for member in group.drain(..) {
                    widths[member] = most;
                }
                most = (0, 0);
            }
            if let Some((indent, names, declared)) = own {
                group_indent = indent;
                most = (most.0.max(names), most.1.max(declared));
                group.push(index);
            }
        }
        for member in group {
            widths[member] = most;
        }
        widths
    }
}
