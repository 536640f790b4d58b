//! Lines of a document: where they end, what in them is comment, and what kind of line each is.

use super::glyph::Arms;
use super::ldmicro::is_title;
use crate::text::{Span, cell_width};
use memchr::memchr2;

/// A line of the text with the comments in it.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Line {
    /// Its bytes, without the line ending.
    pub(super) span: Span,
    /// The start of the next line.
    pub(super) next: usize,
    /// The parts of it that are comments or pragmas.
    pub(super) comments: Vec<Span>,
    /// Whether it starts inside a comment that an earlier line opened.
    pub(super) continues: bool,
    /// Whether it is a comment between the double rails of an LDmicro export.
    pub(super) railed: bool,
}

/// A comment that is open at the end of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum OpenComment {
    /// `(*` at this offset.
    Comment(usize),
    /// `{` at this offset.
    Pragma(usize),
}

impl OpenComment {
    /// Where it was opened, delimiter included.
    pub(super) fn start(self) -> usize {
        match self {
            OpenComment::Comment(start) | OpenComment::Pragma(start) => start,
        }
    }
}

/// Goes through the lines of a text. Comments and pragmas may span lines.
pub(super) struct Lines<'t> {
    text: &'t str,
    offset: usize,
    /// The comment that is open where the next line starts.
    pub(super) open: Option<OpenComment>,
    /// Whether no comment is in the text.
    is_plain: bool,
}

impl<'t> Lines<'t> {
    /// The lines of `text`, which starts outside any comment.
    pub(super) fn new(text: &'t str) -> Lines<'t> {
        Lines { text, offset: 0, open: None, is_plain: !may_begin_comment(text.as_bytes()) }
    }
}

/// The lines of a text with their ends, as [`Lines`] has them.
pub(super) fn ended_lines(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let (line, behind) = rest.split_at(end_of_line(rest.as_bytes(), 0).1);
        rest = behind;
        (!line.is_empty()).then_some(line)
    })
}

/// One past the last byte of the line that begins at `start`, and where the next one begins: behind a line feed, a
/// carriage return, or both.
fn end_of_line(bytes: &[u8], start: usize) -> (usize, usize) {
    let end = memchr2(b'\n', b'\r', &bytes[start..]).map_or(bytes.len(), |length| start + length);
    let ending = if bytes[end..].starts_with(b"\r\n") { 2 } else { usize::from(end < bytes.len()) };
    (end, end + ending)
}

impl Iterator for Lines<'_> {
    type Item = Line;

    fn next(&mut self) -> Option<Line> {
        let bytes = self.text.as_bytes();
        let start = self.offset;
        if start >= bytes.len() {
            return None;
        }
        let (end, next) = end_of_line(bytes, start);
        let suspicious = !self.is_plain && (self.open.is_some() || may_begin_comment(&bytes[start..end]));
        self.offset = next;
        let continues = self.open.is_some();
        let railed = suspicious && !continues;
        let railed = railed.then(|| railed_comment(self.text.get(start..end)?, start)).flatten();
        let comments = match railed {
            Some(comment) => vec![comment],
            None if suspicious => self.comments(start, end),
            None => Vec::new(),
        };
        let span = Span::new(start, end);
        Some(Line { span, next: self.offset, comments, continues, railed: railed.is_some() })
    }
}

impl Lines<'_> {
    /// The comments of the line `start..end`; leaves open what it does not close.
    fn comments(&mut self, start: usize, end: usize) -> Vec<Span> {
        let bytes = &self.text.as_bytes()[..end];
        let mut found = Vec::new();
        let mut at = start;
        let mut only_blanks = true;
        loop {
            if let Some(open) = self.open {
                let close = match open {
                    OpenComment::Comment(opened) => close_of_comment(bytes, at.max(opened + 2)),
                    OpenComment::Pragma(opened) => close_of_pragma(bytes, at.max(opened + 1)),
                };
                let from = open.start().max(start);
                let Some(close) = close else {
                    found.push(Span::new(from, end));
                    return found;
                };
                found.push(Span::new(from, close));
                self.open = None;
                at = close;
            }
            let Some(byte) = bytes.get(at) else { return found };
            match byte {
                b'(' if bytes[at..].starts_with(b"(*") => self.open = Some(OpenComment::Comment(at)),
                // Only as the first thing on a line: inside a rung braces are a box of the LDmicro export.
                b'{' if only_blanks => self.open = Some(OpenComment::Pragma(at)),
                b'/' if bytes[at..].starts_with(b"//") => {
                    found.push(Span::new(at, end));
                    return found;
                }
                b';' if only_blanks => {
                    found.push(Span::new(at, end));
                    return found;
                }
                _ => {
                    only_blanks &= matches!(byte, b' ' | b'\t');
                    at += 1;
                }
            }
        }
    }
}

/// Whether a comment or a pragma may begin in `bytes`. All of them are looked at, since a loop without a way out looks
/// at many at a time.
pub(super) fn may_begin_comment(bytes: &[u8]) -> bool {
    let single = |byte: &u8| matches!(byte, b'{' | b';');
    let double =
        |first: &u8, second: &u8| (*first == b'/') & (*second == b'/') | (*first == b'(') & (*second == b'*');
    let behind = bytes.get(1..).unwrap_or_default();
    bytes.iter().fold(false, |any, byte| any | single(byte))
        || bytes.iter().zip(behind).fold(false, |any, (first, second)| any | double(first, second))
}

/// The comment of a line such as ` 3 ||  ; text    ||`, which an LDmicro export draws between its double rails.
fn railed_comment(line: &str, start: usize) -> Option<Span> {
    let inner = line.trim_start_matches(|c: char| c == ' ' || c.is_ascii_digit()).strip_prefix("||")?;
    let comment = inner.trim_start_matches(' ');
    let comment = comment.strip_prefix(';').map(|_| comment)?;
    let at = start + line.len() - comment.len();
    let comment = comment.trim_end();
    let comment = comment.strip_suffix("||").unwrap_or(comment).trim_end();
    Some(Span::new(at, at + comment.len()))
}

/// One past the first `*)` from `at` on.
fn close_of_comment(bytes: &[u8], at: usize) -> Option<usize> {
    let tail = bytes.get(at..)?;
    tail.windows(2).position(|pair| pair == b"*)").map(|found| at + found + 2)
}

/// One past the first `}` from `at` on that no backslash precedes.
fn close_of_pragma(bytes: &[u8], at: usize) -> Option<usize> {
    let mut at = at;
    loop {
        match bytes.get(at)? {
            b'\\' => at += 2,
            b'}' => return Some(at + 1),
            _ => at += 1,
        }
    }
}

/// What a line is, comments aside.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum LineKind {
    /// Nothing.
    Blank,
    /// Comments or pragmas only.
    Comment,
    /// `NETWORK …` or `LABEL:`
    Header(HeaderLine),
    /// A keyword of a declaration, with the keyword that closes the section, if it opens one.
    Declaration(Option<&'static str>),
    /// The first line of an LDmicro export; its head goes on to the line that [`LDMICRO_DRAWING`] starts.
    Ldmicro,
    /// The title of a table behind the drawing of an LDmicro export.
    Table,
    /// Bars and blanks only: the columns of the bars, neighbours taken together.
    Bars(Vec<u32>),
    /// Anything else belongs to a drawing.
    Drawing,
}

/// Starts the line below which the drawing of an LDmicro export begins.
pub(super) const LDMICRO_DRAWING: &str = "LADDER DIAGRAM:";

/// The parts of a line that starts a network.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct HeaderLine {
    /// `NETWORK` and what follows, or the label with its colon.
    pub(super) span: Span,
    /// The digits after `NETWORK`.
    pub(super) number: Option<Span>,
    /// The title without quotes.
    pub(super) title: Option<Span>,
    /// The label.
    pub(super) label: Option<Span>,
}

impl Line {
    /// What kind of line it is.
    pub(super) fn kind(&self, text: &str) -> LineKind {
        let Some(content) = self.content(text) else {
            return if self.comments.is_empty() && !self.continues {
                LineKind::Blank
            } else {
                LineKind::Comment
            };
        };
        if self.railed {
            return LineKind::Comment;
        }
        let words = content.of(text);
        // A number may stand beside a double rail, also beside one with nothing to its right.
        let number = words.len() - words.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let numbered = number > 0 && words[number..].trim_start().starts_with("||");
        if numbered || Arms::of(words.chars().next().unwrap_or(' ')).is_upright() {
            let from = content.start as usize + number;
            let is_bar = |character: char| is_blank(character) || Arms::of(character).is_vertical();
            if self.comments.is_empty() && !words[number..].chars().all(is_bar) {
                return LineKind::Drawing;
            }
            return self.bars(text, from).map_or(LineKind::Drawing, LineKind::Bars);
        }
        if let Some(header) = read_header(words, content.start as usize) {
            return LineKind::Header(header);
        }
        if let Some(section) = declaration(words) {
            return LineKind::Declaration(section);
        }
        if words.starts_with("LDmicro export ") {
            LineKind::Ldmicro
        } else if is_title(words) {
            LineKind::Table
        } else {
            LineKind::Drawing
        }
    }

    /// From the first to the last character that is neither blank nor comment.
    pub(super) fn content(&self, text: &str) -> Option<Span> {
        let mut content: Option<Span> = None;
        let mut at = self.span.start as usize;
        let ends = self.comments.iter().map(|comment| (comment.start as usize, comment.end as usize));
        for (gap_end, resume) in ends.chain([(self.span.end as usize, 0)]) {
            let gap = text.get(at..gap_end).unwrap_or("");
            let inner = gap.trim_start_matches(is_blank);
            if !inner.is_empty() {
                let start = at + (gap.len() - inner.len());
                let inner = inner.trim_end_matches(is_blank);
                let part = Span::new(start, start + inner.len());
                content = Some(content.map_or(part, |content| content.to(part)));
            }
            at = resume;
        }
        content
    }

    /// The columns of its bars, if it consists of bars and blanks only from the byte `from` on.
    fn bars(&self, text: &str, from: usize) -> Option<Vec<u32>> {
        let mut bars = Vec::new();
        let mut last = None;
        for (column, offset, character) in self.cells(text) {
            if is_blank(character) || offset < from {
                continue;
            }
            if !Arms::of(character).is_vertical() {
                return None;
            }
            if last.is_none_or(|last| last + 1 != column) {
                bars.push(column);
            }
            last = Some(column);
        }
        Some(bars)
    }

    /// The displayed cells: column, byte offset and character, comments as blanks. Characters without width are
    /// left out, tabs count as one blank at their first column.
    pub(super) fn cells<'a>(&'a self, text: &'a str) -> impl Iterator<Item = (u32, usize, char)> + 'a {
        let start = self.span.start as usize;
        let mut column = 0;
        let mut comments = self.comments.iter().peekable();
        self.span.of(text).char_indices().filter_map(move |(at, character)| {
            let offset = start + at;
            while comments.next_if(|comment| comment.end as usize <= offset).is_some() {}
            let commented = comments.peek().is_some_and(|comment| comment.start as usize <= offset);
            let first = column;
            column = column_after(first, character);
            let width = column - first;
            let shown = if commented { ' ' } else { character };
            (width > 0).then_some((first, offset, shown))
        })
    }
}

/// The displayed column behind a character in `column`, from 0: a tab goes on to the next multiple of 8.
pub fn column_after(column: u32, character: char) -> u32 {
    match character {
        '\t' => column + 8 - column % 8,
        _ => column + display_width(character),
    }
}

/// The displayed column, from 0, of byte `offset` in its line of `text`.
pub fn column_of(text: &str, offset: u32) -> u32 {
    let before = text.get(..offset as usize).unwrap_or("");
    let line = before.rsplit('\n').next().unwrap_or("");
    line.chars().fold(0, column_after)
}

/// Displayed cells of a character other than a tab; a byte-order mark has none.
pub(super) fn display_width(character: char) -> u32 {
    if character == '\u{FEFF}' { 0 } else { cell_width(character) as u32 }
}

/// Characters that show nothing.
pub(super) fn is_blank(character: char) -> bool {
    character.is_whitespace() || character == '\u{FEFF}'
}

fn read_header(words: &str, start: usize) -> Option<HeaderLine> {
    let span = Span::new(start, start + words.len());
    if let Some(label) = words.strip_suffix(':') {
        let label = label.trim_end();
        let named = !label.is_empty() && label.chars().all(|c| c.is_alphanumeric() || c == '_');
        if named {
            let label = Some(Span::new(start, start + label.len()));
            return Some(HeaderLine { span, label, ..HeaderLine::default() });
        }
    }
    let (keyword, rest) = words.split_at_checked("NETWORK".len())?;
    if !keyword.eq_ignore_ascii_case("NETWORK")
        || rest.chars().next().is_some_and(super::glyph::continues_word)
    {
        return None;
    }
    let mut header = HeaderLine { span, ..HeaderLine::default() };
    let part = |from: &str, taken: &str| {
        let at = start + words.len() - from.len();
        Span::new(at, at + taken.len())
    };
    let mut rest = rest.trim_start();
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    if digits > 0 {
        header.number = Some(part(rest, &rest[..digits]));
        rest = rest[digits..].trim_start();
    }
    // A colon or a full stop between number and title is punctuation.
    rest = rest.trim_start_matches([':', '.']).trim_start();
    let title = match rest.chars().next() {
        Some(quote @ ('\'' | '"')) => {
            rest = &rest[1..];
            rest.strip_suffix(quote).unwrap_or(rest)
        }
        _ => rest,
    };
    header.title = (!title.is_empty()).then(|| part(rest, title));
    Some(header)
}

/// Keywords that start a line of declarations, with the keyword that ends their section.
const DECLARATIONS: &[(&str, Option<&str>)] = &[
    ("PROGRAM", None),
    ("FUNCTION", None),
    ("FUNCTION_BLOCK", None),
    ("END_PROGRAM", None),
    ("END_FUNCTION", None),
    ("END_FUNCTION_BLOCK", None),
    ("END_VAR", None),
    ("END_TYPE", None),
    ("END_RESOURCE", None),
    ("END_CONFIGURATION", None),
    ("VAR", Some("END_VAR")),
    ("VAR_INPUT", Some("END_VAR")),
    ("VAR_OUTPUT", Some("END_VAR")),
    ("VAR_IN_OUT", Some("END_VAR")),
    ("VAR_GLOBAL", Some("END_VAR")),
    ("VAR_EXTERNAL", Some("END_VAR")),
    ("VAR_TEMP", Some("END_VAR")),
    ("VAR_CONFIG", Some("END_VAR")),
    ("VAR_ACCESS", Some("END_VAR")),
    ("TYPE", Some("END_TYPE")),
    ("RESOURCE", Some("END_RESOURCE")),
    ("CONFIGURATION", Some("END_CONFIGURATION")),
];

fn declaration(words: &str) -> Option<Option<&'static str>> {
    let end = words.find(|c: char| !super::glyph::continues_word(c)).unwrap_or(words.len());
    let keyword = &words[..end];
    let (_, section) = DECLARATIONS.iter().find(|(name, _)| name.eq_ignore_ascii_case(keyword))?;
    let is_pou =
        ["PROGRAM", "FUNCTION", "FUNCTION_BLOCK"].iter().any(|name| name.eq_ignore_ascii_case(keyword));
    if is_pou && is_heading(&words[end..]) {
        return None;
    }
    Some(section.filter(|last| !has_word(&words[end..], last)))
}

/// Whether what stands behind the keyword of a POU makes it a heading in prose: more words than the name, and none of
/// them begins a section.
fn is_heading(rest: &str) -> bool {
    let plain = rest.chars().all(|c| super::glyph::continues_word(c) || is_blank(c));
    let mut words = rest.split_whitespace().skip(1).peekable();
    let declares = |word: &str| DECLARATIONS.iter().any(|(name, _)| name.eq_ignore_ascii_case(word));
    plain && words.peek().is_some() && !words.any(declares)
}

/// Whether `word` stands in `line`, letter case aside.
pub(super) fn has_word(line: &str, word: &str) -> bool {
    line.split(|c: char| !super::glyph::continues_word(c)).any(|part| part.eq_ignore_ascii_case(word))
}
