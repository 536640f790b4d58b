//! What could be written at a place.

use super::{Completion, CompletionKind};
use crate::document::{Chunk, Document, Notation, ProjectView, Tree};
use crate::text::{Language, Span, TextEdit};

mod instructions;

mod operands;

mod ladder;

mod iec;

mod allowed;

pub(super) fn at(view: &ProjectView<'_>, offset: usize, language: Language) -> Vec<Completion> {
    let document = view.here();
    let offset = offset.min(document.len());
    let chunk = document.chunk_at(offset);
    let start = chunk.map_or(0, |at| at.start);
    let text = chunk.map_or("", |at| at.chunk.text());
    let Some(head) = text.get(..offset - start) else { return Vec::new() };
    let in_comment = chunk.is_some_and(|at| in_comment(at.chunk, offset - start));
    let line_start = head.rfind('\n').map_or(0, |end| end + 1);
    let mut place = Place {
        view,
        document,
        chunk: chunk.map(|at| at.chunk.as_ref()),
        chunk_start: start,
        offset,
        head: &head[line_start..],
        line: text[line_start..].lines().next().unwrap_or(""),
        language,
        found: Vec::new(),
    };
    match document.notation() {
        _ if in_comment => allowed::complete(&mut place),
        Notation::FxIl => instructions::complete(&mut place),
        Notation::Ladder if place.is_drawing() => ladder::complete(&mut place),
        Notation::Ladder | Notation::IecIl => iec::complete(&mut place),
    }
    place.found
}

/// Where the cursor stands, and what was found for it.
struct Place<'d> {
    view: &'d ProjectView<'d>,
    document: &'d Document,
    /// `None` in an empty document.
    chunk: Option<&'d Chunk>,
    chunk_start: usize,
    offset: usize,
    /// The line up to the cursor.
    head: &'d str,
    /// All of the line.
    line: &'d str,
    language: Language,
    found: Vec<Completion>,
}

/// A proposal without its edit.
struct Proposal {
    label: String,
    kind: CompletionKind,
    detail: String,
    documentation: String,
    /// What is inserted, where that is not the label: a snippet.
    snippet: Option<String>,
    /// What people may type for it beside the label: a symbol, the words of a comment.
    search: String,
    rank: u16,
}

impl Proposal {
    fn new(label: impl Into<String>, kind: CompletionKind, detail: impl Into<String>, rank: u16) -> Proposal {
        let (label, detail) = (label.into(), detail.into());
        Proposal {
            label,
            kind,
            detail,
            documentation: String::new(),
            snippet: None,
            search: String::new(),
            rank,
        }
    }

    fn snippet(self, snippet: impl Into<String>) -> Proposal {
        Proposal { snippet: Some(snippet.into()), ..self }
    }
}

impl<'d> Place<'d> {
    /// Adds `proposal` if `typed`, the text directly before the cursor that it replaces, is the start of a way to
    /// spell it.
    fn propose(&mut self, typed: &str, proposal: Proposal) {
        if !is_abbreviation(typed, &proposal.label) && !is_found_by(typed, &proposal.search) {
            return;
        }
        let starts_so =
            proposal.label.get(..typed.len()).is_some_and(|head| head.eq_ignore_ascii_case(typed));
        let span = Span::new(self.offset - typed.len(), self.offset);
        let is_snippet = proposal.snippet.is_some();
        self.found.push(Completion {
            edit: TextEdit::new(span, proposal.snippet.unwrap_or_else(|| proposal.label.clone())),
            filter: match proposal.search.as_str() {
                "" => String::new(),
                words => format!("{} {words}", proposal.label),
            },
            label: proposal.label,
            kind: proposal.kind,
            detail: proposal.detail,
            documentation: proposal.documentation,
            is_snippet,
            // What starts as typed comes before what only contains the letters.
            rank: proposal.rank.saturating_add(if starts_so { 0 } else { 10_000 }),
        });
    }

    /// The characters of `is_part` directly before the cursor.
    fn typed(&self, is_part: impl Fn(char) -> bool) -> &'d str {
        &self.head[self.head.trim_end_matches(is_part).len()..]
    }

    /// Whether a ladder document is drawn here and not declared.
    fn is_drawing(&self) -> bool {
        let declares = matches!(self.chunk.map(Chunk::tree), Some(Tree::Iec(_)));
        !declares
    }
}

/// Whether the letters of `typed` occur in `word` in this order, the first one at its start; case aside.
pub(super) fn is_abbreviation(typed: &str, word: &str) -> bool {
    let same = |left: char, right: char| left.eq_ignore_ascii_case(&right);
    let mut letters = word.chars();
    let mut typed = typed.chars();
    match (typed.next(), letters.next()) {
        (None, _) => true,
        (Some(first), Some(letter)) if same(first, letter) => {
            typed.all(|wanted| letters.any(|letter| same(wanted, letter)))
        }
        _ => false,
    }
}

/// Whether one of `words` begins with `typed`, or contains it where the script has no blanks between words; case aside.
fn is_found_by(typed: &str, words: &str) -> bool {
    if typed.is_empty() || words.is_empty() {
        return false;
    }
    let (typed, words) = (typed.to_lowercase(), words.to_lowercase());
    if !typed.is_ascii() {
        return words.contains(&typed);
    }
    words.split(|c: char| !c.is_alphanumeric()).any(|word| word.starts_with(&typed))
        || words.split_whitespace().any(|word| word.starts_with(&typed))
}

/// `text` where a snippet wants its signs escaped.
fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('$', "\\$").replace('}', "\\}")
}

/// Whether `offset` lies inside of a comment; at the end of one that ends with its line too.
fn in_comment(chunk: &Chunk, offset: usize) -> bool {
    let comments = chunk.tree().comments();
    let after = comments.partition_point(|comment| (comment.start as usize) < offset);
    let Some(comment) = after.checked_sub(1).and_then(|last| comments.get(last)) else { return false };
    let is_closed = comment.of(chunk.text()).ends_with("*)");
    offset < comment.end as usize || (offset == comment.end as usize && !is_closed)
}
