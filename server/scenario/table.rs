//! Tables of a file with scenario tests, with the place of each key and value.

use super::Flaw;
use crate::target::iec::nearest;
use crate::text::{Message, Span};
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// A value with its place.
#[derive(Clone, Copy)]
pub(super) struct Entry<'a> {
    pub value: &'a DeValue<'a>,
    pub span: Span,
    pub key: Span,
}

/// What reads a file, and what is wrong with it so far.
pub(super) struct Reading<'t> {
    pub text: &'t str,
    pub flaws: Vec<Flaw>,
}

/// More flaws of a file are not told.
const MOST_FLAWS: usize = 50;

impl Reading<'_> {
    /// Notes a flaw.
    pub fn flaw(&mut self, span: Span, message: Message) {
        if self.flaws.len() < MOST_FLAWS {
            self.flaws.push(Flaw { message, span });
        }
    }

    /// The span of what the reader of TOML means; it may mean a byte inside a character.
    pub fn span(&self, range: Range<usize>) -> Span {
        let at = |offset: usize| {
            let offset = offset.min(self.text.len());
            (0..=offset).rev().find(|offset| self.text.is_char_boundary(*offset)).unwrap_or(0)
        };
        Span::new(at(range.start), at(range.end))
    }

    /// The entries of a table in the order of the text.
    pub fn entries<'a>(&self, table: &'a DeTable<'a>) -> Vec<(String, Entry<'a>)> {
        let mut entries: Vec<(String, Entry<'a>)> = table
            .iter()
            .map(|(key, value)| {
                let entry = Entry {
                    value: value.get_ref(),
                    span: self.span(value.span()),
                    key: self.span(key.span()),
                };
                (key.get_ref().to_string(), entry)
            })
            .collect();
        entries.sort_by_key(|(_, entry)| entry.key.start);
        entries
    }

    /// Tells of the keys of a table that are none of `keys`.
    pub fn known(&mut self, table: &DeTable<'_>, keys: &[&str]) {
        for (key, entry) in self.entries(table) {
            if keys.contains(&key.as_str()) {
                continue;
            }
            let near = nearest(&key, keys.iter().copied());
            let message = match near.first() {
                Some(near) => Message::new("scenario.near-key").with("near", near),
                None => Message::new("manifest.unknown-key").with_words("words", keys.iter().copied(), ", "),
            };
            self.flaw(entry.key, message.with("word", &key));
        }
    }

    /// The entry of this key.
    pub fn entry<'a>(&self, table: &'a DeTable<'a>, key: &str) -> Option<Entry<'a>> {
        let (written, value) = table.get_key_value(key)?;
        Some(Entry { value: value.get_ref(), span: self.span(value.span()), key: self.span(written.span()) })
    }

    /// The text under a key, with its place without quotes.
    pub fn text_of(&mut self, entry: Entry<'_>) -> Option<(String, Span)> {
        match entry.value {
            DeValue::String(text) => Some((text.to_string(), self.within_quotes(entry.span))),
            _ => {
                self.flaw(entry.span, Message::new("manifest.text"));
                None
            }
        }
    }

    /// The table under a key.
    pub fn table_of<'a>(&mut self, entry: Entry<'a>) -> Option<&'a DeTable<'a>> {
        let table = entry.value.as_table();
        if table.is_none() {
            self.flaw(entry.span, Message::new("manifest.table"));
        }
        table
    }

    /// The things in a list under a key.
    pub fn list_of<'a>(&mut self, entry: Entry<'a>) -> Vec<Entry<'a>> {
        let Some(list) = entry.value.as_array() else {
            self.flaw(entry.span, Message::new("manifest.list"));
            return Vec::new();
        };
        let place = |value: &'a toml::Spanned<DeValue<'a>>| {
            let span = self.span(value.span());
            Entry { value: value.get_ref(), span, key: span }
        };
        list.iter().map(place).collect()
    }

    /// The number under a key.
    pub fn number_of(&mut self, entry: Entry<'_>) -> Option<f64> {
        let number = match entry.value {
            DeValue::Integer(number) => {
                i64::from_str_radix(number.as_str(), number.radix()).ok().map(|n| n as f64)
            }
            DeValue::Float(number) => number.as_str().parse().ok(),
            _ => None,
        };
        let number = number.filter(|number: &f64| number.is_finite());
        if number.is_none() {
            self.flaw(entry.span, Message::new("scenario.number"));
        }
        number
    }

    /// Whether `true` stands under a key.
    pub fn is_true(&mut self, entry: Entry<'_>) -> bool {
        match entry.value {
            DeValue::Boolean(value) => *value,
            _ => {
                self.flaw(entry.span, Message::new("scenario.true-or-false"));
                false
            }
        }
    }

    /// A word is meant without its quotes.
    fn within_quotes(&self, span: Span) -> Span {
        let is_quoted = span.of(self.text).starts_with(['"', '\'']) && span.end - span.start >= 2;
        match is_quoted {
            true => Span::new(span.start as usize + 1, span.end as usize - 1),
            false => span,
        }
    }
}
