//! Comments that allow what a rule would report: `// rungwise: allow(double-coil)`.
//!
//! Above a rung, a network or a block of statements, or beside its instructions, such a comment is about that piece; at
//! the top of a file, with a blank line or a declaration behind it, it is about the whole file.

use super::{Chunk, Document, Tree};
use crate::text::Span;
use std::ops::Range;
use std::sync::Arc;

/// What a comment begins with that has to say something to the checker.
pub const DIRECTIVE: &str = "rungwise:";

/// A comment that allows something.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Allowance {
    /// The whole comment with its delimiters, in the document.
    pub comment: Span,
    /// The codes of the rules, as they are written between the parentheses.
    pub codes: Vec<Span>,
    /// The bytes of the document for which it holds.
    pub covers: Range<usize>,
    /// Whether it is about the whole file.
    pub is_for_file: bool,
    /// Whether nothing else stands in the comment.
    pub is_alone: bool,
}

/// The same in a chunk, with its offsets.
#[derive(Clone, Debug)]
pub(super) struct OwnAllowance {
    comment: Span,
    codes: Vec<Span>,
    is_alone: bool,
    /// Where it stands in its chunk.
    place: Place,
}

/// Where a comment stands in its chunk.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Place {
    /// Before everything that is no comment, directly above it.
    Above,
    /// Before everything that is no comment, with a blank line between, or a declaration behind it.
    Apart,
    /// Beside or between instructions.
    Within,
    /// Behind everything, on a line of its own.
    Behind,
}

impl Chunk {
    /// Where the first thing in it that is no comment starts; `None` if there is none.
    pub fn content_start(&self) -> Option<usize> {
        Some(content(self.reading().tree())?.start as usize)
    }
}

impl Document {
    /// The comments that allow something, in the order of the text. Pages without any are passed over.
    pub fn allowances(&self) -> Vec<Allowance> {
        let mut allowances = Vec::new();
        let (mut start, mut is_top) = (0, true);
        // What stands behind its chunk is about the next one.
        let mut waiting: Vec<Allowance> = Vec::new();
        for page in self.pages() {
            let own = page.allowances();
            if own.is_empty() && waiting.is_empty() {
                is_top = is_top && page.chunks().iter().all(|chunk| chunk.is_only_comments());
                start += page.bytes();
                continue;
            }
            let mut own = own.iter().peekable();
            for (number, chunk) in page.chunks().iter().enumerate() {
                let is_only_comments = chunk.is_only_comments();
                if !is_only_comments {
                    let next = start..start + chunk.len();
                    allowances.extend(waiting.drain(..).map(|one| Allowance { covers: next.clone(), ..one }));
                }
                while let Some((_, one)) = own.next_if(|(chunk, _)| *chunk == number) {
                    let is_for_file = is_top && (one.place == Place::Apart || is_only_comments);
                    let covers = if is_for_file { 0..self.len() + 1 } else { start..start + chunk.len() };
                    let allowance = Allowance {
                        comment: one.comment.shifted(start),
                        codes: one.codes.iter().map(|code| code.shifted(start)).collect(),
                        covers,
                        is_for_file,
                        is_alone: one.is_alone,
                    };
                    let waits = !is_for_file && (one.place == Place::Behind || is_only_comments);
                    if waits { waiting.push(allowance) } else { allowances.push(allowance) }
                }
                is_top &= is_only_comments;
                start += chunk.len();
            }
        }
        // At the very end there is nothing more to allow.
        allowances.append(&mut waiting);
        allowances
    }
}

/// Those of a page, each with the number of its chunk.
pub(super) fn of_page(chunks: &[Arc<Chunk>]) -> Box<[(usize, OwnAllowance)]> {
    let numbered = chunks.iter().enumerate();
    numbered
        .flat_map(|(number, chunk)| chunk.allowances().iter().map(move |own| (number, own.clone())))
        .collect()
}

/// Offsets are those of the chunk. Nearly all chunks are passed over after one look at their text.
pub(super) fn of_chunk(chunk: &Chunk) -> Vec<OwnAllowance> {
    let text = chunk.text();
    if !text.contains(DIRECTIVE) {
        return Vec::new();
    }
    let comments = chunk.tree().comments();
    let content = content(chunk.tree());
    let read = |comment: &Span| {
        let (codes, is_alone) = codes(comment.of(text), comment.start as usize)?;
        Some(OwnAllowance {
            comment: *comment,
            codes,
            is_alone,
            place: place(text, *comment, content, chunk.declares()),
        })
    };
    comments.iter().filter_map(read).collect()
}

/// From the first to the last thing that is no comment.
fn content(tree: &Tree) -> Option<Span> {
    let ends = |first: Option<Span>, last: Option<Span>| Some(first?.to(last?));
    match tree {
        Tree::Fx(tree) => {
            ends(tree.lines.first().map(|line| line.span), tree.lines.last().map(|line| line.span))
        }
        Tree::Iec(tree) => {
            ends(tree.items.first().map(|item| item.span), tree.items.last().map(|item| item.span))
        }
        Tree::Ladder(tree) => {
            let header = tree.header.as_ref().map(|header| header.span);
            let first = header.or_else(|| tree.rungs.first().map(|rung| rung.span));
            ends(first, tree.rungs.last().map(|rung| rung.span).or(header))
        }
    }
}

/// Whether nothing is there but comments.
pub(super) fn is_only_comments(tree: &Tree) -> bool {
    content(tree).is_none()
}

fn place(text: &str, comment: Span, content: Option<Span>, declares: bool) -> Place {
    let Some(content) = content else { return Place::Apart };
    if comment.start > content.end {
        let between = text.get(content.end as usize..comment.start as usize).unwrap_or("");
        return if between.contains('\n') { Place::Behind } else { Place::Within };
    }
    if comment.start >= content.start {
        return Place::Within;
    }
    let between = text.get(comment.end as usize..content.start as usize).unwrap_or("");
    let mut lines: Vec<&str> = between.split('\n').skip(1).collect();
    // What stands before the first word in its own line is no blank line.
    lines.pop();
    let is_apart = declares || lines.iter().any(|line| line.trim().is_empty());
    if is_apart { Place::Apart } else { Place::Above }
}

/// The codes in `rungwise: allow(a, b)`, and whether the comment has no other words.
fn codes(comment: &str, start: usize) -> Option<(Vec<Span>, bool)> {
    let directive = comment.find(DIRECTIVE)?;
    let rest = &comment[directive + DIRECTIVE.len()..];
    let inside = rest.trim_start().strip_prefix("allow")?.trim_start().strip_prefix('(')?;
    let first = comment.len() - inside.len();
    let end = inside.find(')')?;
    let mut codes = Vec::new();
    let mut at = first;
    for word in inside[..end].split(',') {
        let code = word.trim();
        if !code.is_empty() {
            let from = start + at + (word.len() - word.trim_start().len());
            codes.push(Span::new(from, from + code.len()));
        }
        at += word.len() + 1;
    }
    let is_sign = |c: char| c.is_whitespace() || "/;(*)".contains(c);
    let is_alone = comment[..directive].chars().all(is_sign) && inside[end + 1..].chars().all(is_sign);
    Some((codes, is_alone))
}
