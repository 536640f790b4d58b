//! Where in a manifest the cursor is. What is being typed is seldom TOML, so words are read one by one, with the lexer
//! of the TOML reader, and what does not belong anywhere is passed over.

use crate::text::Span;
use rustc_hash::FxHashSet;
use toml_parser::Source;
use toml_parser::lexer::{Token, TokenKind};

/// What stands at the cursor.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Site {
    /// A header such as `[format]`: its names up to the cursor, the one at the cursor, all of it with its brackets.
    Header { path: Vec<String>, word: Span, span: Span },
    /// A key, or the place of one: the table, the names before it with dots, the word, and whether a `=` follows.
    Key { table: Vec<String>, before: Vec<String>, word: Span, has_value: bool, starts_line: bool },
    /// A value, or the place of one: the keys, the word without quotes, whether it has some, whether it is in a list.
    Value { path: Vec<String>, word: Span, is_quoted: bool, in_list: bool },
    /// A comment, or a place where nothing belongs.
    Nowhere,
}

/// No manifest has names of more parts, or more lists and tables within each other.
const MOST_DEPTH: usize = 16;

/// A manifest, as far as the cursor and proposals need it.
pub(super) struct Reading {
    pub site: Site,
    /// The table in which the cursor is, as the number of its header.
    here: usize,
    /// Keys with all their names, each with the number of the header above it, but for the one at the cursor.
    keys: Vec<(usize, Vec<String>)>,
    /// The names of tables that have a header.
    tables: Vec<String>,
    /// Words that are values, with their keys.
    values: Vec<(usize, Vec<String>, String)>,
}

impl Reading {
    /// Reads `text` with the cursor at byte `offset`.
    pub fn of(text: &str, offset: usize) -> Reading {
        let mut walk = Walk {
            text,
            offset,
            reading: Reading {
                site: Site::Nowhere,
                here: 0,
                keys: Vec::new(),
                tables: Vec::new(),
                values: Vec::new(),
            },
            table: Vec::new(),
            number: 0,
            nest: Vec::new(),
            entry: Vec::new(),
            state: State::Start,
            is_found: false,
            is_line_start: true,
        };
        let tokens: Vec<Token> =
            Source::new(text).lex().filter(|token| token.kind() != TokenKind::Whitespace).collect();
        for (index, token) in tokens.iter().enumerate() {
            walk.take(token, &tokens[index + 1..]);
        }
        walk.reading
    }

    /// Whether the table has a header somewhere.
    pub fn has_table(&self, name: &str) -> bool {
        self.tables.iter().any(|table| table == name)
    }

    /// Whether the table with the cursor has the key.
    pub fn has_key(&self, path: &[String]) -> bool {
        self.keys.iter().any(|(number, key)| *number == self.here && key == path)
    }

    /// The values that the key has already.
    pub fn listed(&self, path: &[String]) -> FxHashSet<&str> {
        let own = self.values.iter().filter(|(number, key, _)| *number == self.here && key == path);
        own.map(|(_, _, value)| value.as_str()).collect()
    }
}

/// What comes next.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    /// A key or a header, on a line of its own.
    Start,
    /// A name of a header that began at this byte.
    Header(usize),
    /// A key, behind a dot or in an inline table.
    Key,
    /// `.` or `=`.
    AfterKey,
    Value,
    /// The end of the line, or what goes on with a list.
    Done,
}

/// What is open around the place.
enum Nest {
    List,
    /// An inline table, with the table and the entry around it.
    Table(Vec<String>, Vec<String>),
}

struct Walk<'t> {
    text: &'t str,
    offset: usize,
    reading: Reading,
    table: Vec<String>,
    number: usize,
    nest: Vec<Nest>,
    /// The names of the key of the entry.
    entry: Vec<String>,
    state: State,
    is_found: bool,
    /// Whether nothing stands in the line yet.
    is_line_start: bool,
}

impl Walk<'_> {
    fn take(&mut self, token: &Token, rest: &[Token]) {
        let (start, end) = (token.span().start(), token.span().end());
        // What closes a list or a table leaves the place right before it to what belongs there.
        let closes = matches!(
            token.kind(),
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket | TokenKind::Comma
        );
        let is_before = self.offset == start && closes && !matches!(self.state, State::Header(_));
        if !self.is_found && (self.offset < start || is_before) {
            self.gap(true);
        }
        let is_string = matches!(token.kind(), TokenKind::BasicString | TokenKind::LiteralString);
        match token.kind() {
            TokenKind::Comment => self.is_found |= start < self.offset && self.offset <= end,
            TokenKind::MlBasicString | TokenKind::MlLiteralString => {
                self.is_found |= start < self.offset && self.offset < end;
                self.state = State::Done;
            }
            TokenKind::Newline | TokenKind::Eof => {
                if !self.is_found && self.offset <= start {
                    self.gap(false);
                }
                self.line_end();
            }
            _ if is_string || token.kind() == TokenKind::Atom => self.word(token, rest),
            TokenKind::LeftSquareBracket => self.open_bracket(start, rest),
            TokenKind::LeftCurlyBracket if self.nest.len() >= MOST_DEPTH => self.state = State::Done,
            TokenKind::RightSquareBracket => self.close_bracket(),
            TokenKind::LeftCurlyBracket if self.state == State::Value => {
                let path = self.path();
                let around = std::mem::replace(&mut self.table, path);
                self.nest.push(Nest::Table(around, std::mem::take(&mut self.entry)));
                self.state = State::Key;
            }
            TokenKind::RightCurlyBracket => {
                if let Some(Nest::Table(..)) = self.nest.last()
                    && let Some(Nest::Table(table, entry)) = self.nest.pop()
                {
                    (self.table, self.entry) = (table, entry);
                }
                self.state = State::Done;
            }
            TokenKind::Comma => match self.nest.last() {
                Some(Nest::List) => self.state = State::Value,
                Some(Nest::Table(..)) => {
                    self.entry.clear();
                    self.state = State::Key;
                }
                None => self.state = State::Done,
            },
            TokenKind::Dot if self.state == State::AfterKey => self.state = State::Key,
            TokenKind::Equals if self.state == State::AfterKey => {
                if !self.is_at(&self.entry) {
                    self.reading.keys.push((self.number, self.path()));
                }
                self.state = State::Value;
            }
            _ => {}
        }
        self.is_line_start = token.kind() == TokenKind::Newline;
    }

    /// Whether the cursor was found in the key of the entry that is being read.
    fn is_at(&self, entry: &[String]) -> bool {
        match &self.reading.site {
            Site::Key { before, word, .. } if self.reading.here == self.number => {
                let name = word.of(self.text);
                entry.split_last().is_some_and(|(last, head)| last == name && head == before)
            }
            _ => false,
        }
    }

    /// The names of the entry's key with those of its table.
    fn path(&self) -> Vec<String> {
        [&self.table[..], &self.entry[..]].concat()
    }

    fn line_end(&mut self) {
        // A list or an inline table goes on in the next line.
        if self.nest.is_empty() {
            self.entry.clear();
            self.state = State::Start;
        }
    }

    /// A list or table that was never closed ends where an entry or a header begins.
    fn give_up(&mut self) {
        while let Some(nest) = self.nest.pop() {
            if let Nest::Table(table, _) = nest {
                self.table = table;
            }
        }
        self.entry.clear();
        self.state = State::Start;
    }

    fn open_bracket(&mut self, start: usize, rest: &[Token]) {
        if self.is_line_start && !self.nest.is_empty() {
            self.give_up();
        }
        match self.state {
            State::Start => {
                let closed = rest.iter().take_while(|token| token.kind() != TokenKind::Newline);
                let closed = closed.filter(|token| token.kind() == TokenKind::RightSquareBracket).last();
                self.number += 1;
                self.table.clear();
                self.entry.clear();
                self.state = State::Header(start);
                let end = closed.map_or(start + 1, |token| token.span().end());
                // Before the first name there is nothing but brackets.
                let next = rest.iter().find(|token| token.kind() != TokenKind::LeftSquareBracket);
                let is_before = next.is_none_or(|next| match next.kind() {
                    TokenKind::Atom | TokenKind::BasicString | TokenKind::LiteralString => {
                        self.offset < next.span().start()
                    }
                    _ => self.offset <= next.span().start(),
                });
                if !self.is_found && start < self.offset && is_before {
                    let span = Span::new(start, end.max(self.offset));
                    self.found(Site::Header { path: Vec::new(), word: Span::at(self.offset), span });
                }
            }
            State::Value if self.nest.len() < MOST_DEPTH => self.nest.push(Nest::List),
            _ => {}
        }
    }

    fn close_bracket(&mut self) {
        if let State::Header(_) = self.state {
            let is_here =
                matches!(self.reading.site, Site::Header { .. }) && self.reading.here == self.number;
            if let [name] = &self.table[..]
                && !is_here
            {
                self.reading.tables.push(name.clone());
            }
            self.state = State::Done;
        } else if let Some(Nest::List) = self.nest.last() {
            self.nest.pop();
            self.state = State::Done;
        }
    }

    fn found(&mut self, site: Site) {
        self.is_found = true;
        self.reading.here = self.number;
        self.reading.site = site;
    }

    /// The cursor is in no word; `is_followed` if something stands behind it in the same line.
    fn gap(&mut self, is_followed: bool) {
        let word = Span::at(self.offset);
        let in_list = matches!(self.nest.last(), Some(Nest::List));
        let starts_line = self.state == State::Start;
        match self.state {
            // What stands in the line already is the key.
            State::Start | State::Key if !is_followed || !starts_line => {
                let (table, before) = (self.table.clone(), self.entry.clone());
                self.found(Site::Key { table, before, word, has_value: false, starts_line });
            }
            State::Value => {
                self.found(Site::Value { path: self.path(), word, is_quoted: false, in_list });
            }
            State::Header(start) => {
                let path = self.table.clone();
                self.found(Site::Header { path, word, span: Span::new(start, self.offset) });
            }
            _ => self.is_found = true,
        }
    }

    fn word(&mut self, token: &Token, rest: &[Token]) {
        let (start, end) = (token.span().start(), token.span().end());
        let follows = rest.first().map(Token::kind);
        // In a list nothing is assigned: the list was not closed, and this is the next key.
        if matches!(self.nest.last(), Some(Nest::List)) && follows == Some(TokenKind::Equals) {
            self.give_up();
        }
        let raw = &self.text[start..end];
        let quote = raw.chars().next().filter(|first| matches!(first, '"' | '\''));
        let is_closed = quote.is_some_and(|quote| raw.len() > 1 && raw.ends_with(quote));
        let inside = usize::from(quote.is_some());
        let word = Span::new(start + inside, end - usize::from(is_closed));
        let name = word.of(self.text).to_string();
        let is_here = !self.is_found && start + inside <= self.offset && self.offset <= word.end as usize;
        let in_list = matches!(self.nest.last(), Some(Nest::List));
        let starts_line = self.state == State::Start;
        match self.state {
            State::Header(open) => {
                push(&mut self.table, name);
                if is_here {
                    let brackets =
                        rest.iter().take_while(|token| token.kind() == TokenKind::RightSquareBracket);
                    let end = brackets.last().map_or(end, |token| token.span().end());
                    self.found(Site::Header { path: self.table.clone(), word, span: Span::new(open, end) });
                }
            }
            State::Start | State::Key => {
                if is_here {
                    let has_value = matches!(follows, Some(TokenKind::Equals | TokenKind::Dot));
                    let (table, before) = (self.table.clone(), self.entry.clone());
                    self.found(Site::Key { table, before, word, has_value, starts_line });
                }
                push(&mut self.entry, name);
                self.state = State::AfterKey;
            }
            State::Value => {
                let path = self.path();
                if is_here {
                    let is_quoted = quote.is_some();
                    self.found(Site::Value { path, word, is_quoted, in_list });
                } else {
                    self.reading.values.push((self.number, path, name));
                }
                self.state = State::Done;
            }
            State::AfterKey | State::Done => self.is_found |= is_here,
        }
    }
}

/// What has more parts than any name of a manifest is none of them, however it goes on.
fn push(names: &mut Vec<String>, name: String) {
    if names.len() < MOST_DEPTH {
        names.push(name);
    }
}
