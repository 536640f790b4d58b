//! Comments that name what must never be on together: `// rungwise: never Y0 & Y1`.

use super::allowance::DIRECTIVE;
use super::{Chunk, Document, Tree};
use crate::il::iec::{Item, ItemKind};
use crate::text::Span;
use std::sync::Arc;

/// A comment that says of some devices or variables that no two of them are ever on at the end of a scan.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Exclusion {
    /// From the word `never` to the last name, in the document.
    pub span: Span,
    /// The names as they are written, in order.
    pub names: Vec<Span>,
    /// How many program units have started at the comment; nothing if it stands in none and is about all of them.
    pub unit: Option<usize>,
}

impl Exclusion {
    /// The same at its place among what stands before it.
    fn moved(&self, start: usize, units: usize) -> Exclusion {
        Exclusion {
            span: self.span.shifted(start),
            names: self.names.iter().map(|name| name.shifted(start)).collect(),
            unit: self.unit.map(|unit| unit + units),
        }
    }
}

/// The word behind the directive.
const WORD: &str = "never";

/// The places of the names in `A & B & C`, and where the last one ends. What follows without a `&` is no part of it.
pub fn exclusive_names(text: &str) -> (Vec<Span>, usize) {
    let (mut names, mut at) = (Vec::new(), 0);
    loop {
        let start = at + blanks(&text[at..]);
        let length = text[start..].find(|c: char| !is_of_name(c)).unwrap_or(text.len() - start);
        if length == 0 {
            break;
        }
        names.push(Span::new(start, start + length));
        let behind = start + length + blanks(&text[start + length..]);
        if !text[behind..].starts_with('&') {
            break;
        }
        at = behind + 1;
    }
    let end = names.last().map_or(0, |name| name.end as usize);
    (names, end)
}

fn blanks(text: &str) -> usize {
    text.len() - text.trim_start_matches([' ', '\t']).len()
}

/// Devices, symbols, variables and direct addresses consist of these.
fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '.' | '%')
}

impl Document {
    /// The comments that exclude something, in the order of the text.
    pub fn exclusions(&self) -> Vec<Exclusion> {
        let mut exclusions = Vec::new();
        let (mut start, mut pous) = (0, 0);
        for page in self.pages() {
            exclusions.extend(page.exclusions().iter().map(|own| own.moved(start, pous)));
            start += page.bytes();
            pous += page.pou_starts();
        }
        exclusions
    }
}

/// Those of a page, with its offsets. Nearly all chunks have none.
pub(super) fn of_page(chunks: &[Arc<Chunk>]) -> Box<[Exclusion]> {
    let mut exclusions = Vec::new();
    let (mut start, mut pous) = (0, 0);
    for chunk in chunks {
        exclusions.extend(chunk.exclusions().iter().map(|own| own.moved(start, pous)));
        start += chunk.len();
        pous += chunk.pou_starts();
    }
    exclusions.into()
}

/// Offsets are those of the chunk.
pub(super) fn of_chunk(chunk: &Chunk) -> Box<[Exclusion]> {
    let text = chunk.text();
    if !text.contains(DIRECTIVE) {
        return Box::default();
    }
    let read = |comment: &Span| {
        let words = comment.of(text);
        let start = words.find(DIRECTIVE)? + DIRECTIVE.len();
        let start = start + blanks(&words[start..]);
        let rest = words[start..].strip_prefix(WORD)?;
        if rest.starts_with(is_of_name) {
            return None;
        }
        let (names, end) = exclusive_names(rest);
        let at = comment.start as usize + start;
        let names_at = at + WORD.len();
        Some(Exclusion {
            span: Span::new(at, names_at + end),
            names: names.iter().map(|name| name.shifted(names_at)).collect(),
            unit: unit(chunk.tree(), comment.start),
        })
    };
    chunk.tree().comments().iter().filter_map(read).collect()
}

/// How many units have started at `offset`, since the start of the chunk; nothing behind the end of the last one, and
/// where the next one begins.
fn unit(tree: &Tree, offset: u32) -> Option<usize> {
    let Tree::Iec(tree) = tree else { return Some(0) };
    let is_start = |item: &&Item| matches!(item.kind, ItemKind::Pou { .. });
    let before = tree.items.iter().take_while(|item| item.span.start < offset);
    let units = before.clone().filter(is_start).count();
    let has_ended = before.last().is_some_and(|item| matches!(item.kind, ItemKind::PouEnd(_)));
    let begins = units == 0 && tree.items.iter().any(|item| is_start(&item));
    (!has_ended && !begins).then_some(units)
}
