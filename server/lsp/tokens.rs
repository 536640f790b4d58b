//! Semantic tokens in the protocol's relative form: whole, of a range, and as the difference to what was sent last.
//!
//! What was sent is remembered as the document that it was made from. Pages that both documents share have the same
//! tokens, and of what follows a change only the first token moves, as each is placed by the one before it. So the
//! difference is sought in a page or two, however long the document is.

use super::to_proto::Place;
use crate::document::{Document, Page};
use crate::text::{Encoding, column_of_offset};
use rustc_hash::FxHashMap;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tower_lsp::ls_types::{
    SemanticToken, SemanticTokens, SemanticTokensDelta, SemanticTokensEdit, SemanticTokensFullDeltaResult,
    Uri,
};

/// What was sent last for each document.
#[derive(Default)]
pub(super) struct SentTokens {
    sent: Mutex<FxHashMap<Uri, Sent>>,
    /// Results are numbered, so that no name of one ever means another.
    next: AtomicU64,
}

#[derive(Clone)]
struct Sent {
    id: String,
    document: Document,
    /// The number of tokens in each page.
    counts: Arc<[usize]>,
}

/// A token at its place in the document, as the client counts.
#[derive(Clone, Copy)]
struct Placed {
    line: u32,
    column: u32,
    length: u32,
    kind: u32,
    modifiers: u32,
    /// Where it starts and ends, in bytes of the document.
    bytes: (usize, usize),
}

impl SentTokens {
    /// All tokens, to be remembered for the next difference.
    pub(super) fn full(&self, uri: &Uri, place: Place<'_>) -> SemanticTokens {
        let mut relative = Relative::default();
        let mut counts = Vec::with_capacity(place.document.pages().len());
        for (page, start) in starts(place.document) {
            let before = relative.data.len();
            relative.extend(&placed(place.document, page, start, place.encoding));
            counts.push(relative.data.len() - before);
        }
        let id = self.remember(uri, place.document, counts);
        SemanticTokens { result_id: Some(id), data: relative.data }
    }

    /// The difference to result `previous`, or all tokens if that is not the last one.
    pub(super) fn delta(&self, uri: &Uri, previous: &str, place: Place<'_>) -> SemanticTokensFullDeltaResult {
        let sent = self.lock().get(uri).filter(|sent| sent.id == previous).cloned();
        match sent {
            Some(sent) => {
                let (edits, counts) = difference(&sent, place);
                let result_id = Some(self.remember(uri, place.document, counts));
                SemanticTokensFullDeltaResult::TokensDelta(SemanticTokensDelta { result_id, edits })
            }
            None => SemanticTokensFullDeltaResult::Tokens(self.full(uri, place)),
        }
    }

    /// Forgets what was sent for a document that is closed.
    pub(super) fn forget(&self, uri: &Uri) {
        self.lock().remove(uri);
    }

    fn remember(&self, uri: &Uri, document: &Document, counts: Vec<usize>) -> String {
        let id = self.next.fetch_add(1, Ordering::Relaxed).to_string();
        let sent = Sent { id: id.clone(), document: document.clone(), counts: counts.into() };
        self.lock().insert(uri.clone(), sent);
        id
    }

    fn lock(&self) -> MutexGuard<'_, FxHashMap<Uri, Sent>> {
        self.sent.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The tokens that touch the bytes of `range`; only their pages are looked at.
pub(super) fn within(place: Place<'_>, range: Range<usize>) -> SemanticTokens {
    let mut relative = Relative::default();
    for (page, start) in starts(place.document) {
        if start < range.end && range.start < start + page.bytes() {
            let mut tokens = placed(place.document, page, start, place.encoding);
            tokens.retain(|token| token.bytes.0 < range.end && range.start < token.bytes.1);
            relative.extend(&tokens);
        }
    }
    SemanticTokens { result_id: None, data: relative.data }
}

/// What turns the tokens that were sent into those of the document, and how many each of its pages has.
fn difference(sent: &Sent, place: Place<'_>) -> (Vec<SemanticTokensEdit>, Vec<usize>) {
    let (old_pages, new_pages) = (sent.document.pages(), place.document.pages());
    let same = |(old, new): &(&Arc<Page>, &Arc<Page>)| Arc::ptr_eq(old, new);
    let head = old_pages.iter().zip(new_pages).take_while(same).count();
    let tail = (old_pages[head..].iter().rev()).zip(new_pages[head..].iter().rev()).take_while(same).count();
    let old_tail = sent.counts.len() - tail;
    // The first token behind the change is placed by the last one before it.
    let behind = sent.counts[old_tail..].iter().position(|count| *count > 0).map(|page| page + 1);
    let first = sent.counts[..head].iter().rposition(|count| *count > 0);
    let region = |document: &Document, tail_start: usize| {
        let mut tokens = Relative::default();
        let mut counts = Vec::new();
        let end = tail_start + behind.unwrap_or(0);
        for (number, (page, start)) in starts(document).enumerate().take(end) {
            if number >= head || Some(number) == first {
                let mut found = placed(document, page, start, place.encoding);
                if number < head {
                    tokens.last = found.last().map_or((0, 0), |last| (last.line, last.column));
                    continue;
                }
                if number < tail_start {
                    counts.push(found.len());
                } else {
                    found.truncate(1);
                }
                tokens.extend(&found);
            }
        }
        (tokens.data, counts)
    };
    let (old, _) = region(&sent.document, old_tail);
    let (new, middle) = region(place.document, new_pages.len() - tail);
    let before: usize = sent.counts[..head].iter().sum();
    let counts = sent.counts[..head].iter().chain(&middle).chain(&sent.counts[old_tail..]);
    (edit(&old, &new, before).into_iter().collect(), counts.copied().collect())
}

/// The edit that turns `old` into `new`, which stand behind `before` tokens; none if they are equal. The protocol
/// counts the five numbers of a token one by one.
fn edit(old: &[SemanticToken], new: &[SemanticToken], before: usize) -> Option<SemanticTokensEdit> {
    let head = old.iter().zip(new).take_while(|(old, new)| old == new).count();
    let (old, new) = (&old[head..], &new[head..]);
    let tail = old.iter().rev().zip(new.iter().rev()).take_while(|(old, new)| old == new).count();
    let (old, new) = (&old[..old.len() - tail], &new[..new.len() - tail]);
    (!old.is_empty() || !new.is_empty()).then(|| SemanticTokensEdit {
        start: (before + head) as u32 * 5,
        delete_count: old.len() as u32 * 5,
        data: (!new.is_empty()).then(|| new.to_vec()),
    })
}

/// The pages of a document with the offsets of their starts.
fn starts(document: &Document) -> impl Iterator<Item = (&Arc<Page>, usize)> {
    document.pages().iter().scan(0, |end, page| {
        let start = *end;
        *end += page.bytes();
        Some((page, start))
    })
}

/// The tokens of a page that starts at byte `start`.
fn placed(document: &Document, page: &Page, start: usize, encoding: Encoding) -> Vec<Placed> {
    let text: String = page.chunks().iter().map(|chunk| chunk.text()).collect();
    let first = document.position(start, encoding);
    let (mut line, mut line_start, mut line_column) = (first.line, 0, first.column);
    let (mut at, mut chunk_start) = (0, 0);
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    for chunk in page.chunks() {
        for token in chunk.tokens() {
            let (from, to) = (chunk_start + token.span.start as usize, chunk_start + token.span.end as usize);
            while at < from {
                let ends = match bytes[at] {
                    b'\n' => true,
                    b'\r' => bytes.get(at + 1) != Some(&b'\n'),
                    _ => false,
                };
                at += 1;
                if ends {
                    (line, line_start, line_column) = (line + 1, at, 0);
                }
            }
            let width = |from: usize, to: usize| {
                text.get(from..to).map_or(0, |part| column_of_offset(part, part.len(), encoding))
            };
            let length = width(from, to);
            if length > 0 {
                found.push(Placed {
                    line,
                    column: line_column + width(line_start, from),
                    length,
                    kind: token.kind as u32,
                    modifiers: u32::from(token.modification),
                    bytes: (start + from, start + to),
                });
            }
        }
        chunk_start += chunk.len();
    }
    found
}

/// Tokens placed each by the one before it.
#[derive(Default)]
struct Relative {
    data: Vec<SemanticToken>,
    /// Line and column of the last one.
    last: (u32, u32),
}

impl Relative {
    fn extend(&mut self, tokens: &[Placed]) {
        self.data.reserve(tokens.len());
        for token in tokens {
            let (line, column) = self.last;
            self.data.push(SemanticToken {
                delta_line: token.line - line,
                delta_start: if token.line == line { token.column - column } else { token.column },
                length: token.length,
                token_type: token.kind,
                token_modifiers_bitset: token.modifiers,
            });
            self.last = (token.line, token.column);
        }
    }
}
