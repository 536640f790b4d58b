//! The law of structural edits: what is answered reads as exactly what was meant, and as nothing else than before
//! everywhere around.

use super::assemble::Plan;
use super::site::Site;
use crate::document::{ChunkRef, Document, Tree};
use crate::ide::changes;
use crate::ladder::reduce::reduce;
use crate::ladder::{Element, Graph, LadderTree, Rung, parse, split};
use crate::text::{Span, TextEdit};

/// A chunk with those before and after it: as far as an edit can be felt.
#[derive(Debug)]
pub(super) struct Window<'d> {
    /// Where it starts in the document.
    pub start: usize,
    pub text: String,
    chunks: Vec<ChunkRef<'d>>,
    document: &'d Document,
}

/// A window after an edit, read again.
#[derive(Debug)]
pub(super) struct Proved {
    /// Where the window starts in the document, before and after.
    start: usize,
    old: String,
    new: String,
    /// The edited rung, with its chunk's place in the new window.
    rung: Rung,
    chunk: Span,
}

impl<'d> Window<'d> {
    /// The window around the chunk at a byte of the document.
    pub fn around(document: &'d Document, offset: usize) -> Option<Window<'d>> {
        let at = document.chunk_at(offset)?;
        let before = document.chunk_before(offset).filter(|before| before.start < at.start);
        let end = at.start + at.chunk.len();
        let after = document.chunk_at(end).filter(|after| after.start >= end);
        let chunks: Vec<ChunkRef<'d>> = before.into_iter().chain([at]).chain(after).collect();
        let start = chunks.first().map_or(0, |chunk| chunk.start);
        let text = chunks.iter().map(|at| at.chunk.text()).collect();
        Some(Window { start, text, chunks, document })
    }

    /// The number of a rung, given its chunk's start in the document and its number there, among the window's.
    pub fn rung_number(&self, chunk_start: usize, number: usize) -> usize {
        let before = self.chunks.iter().take_while(|at| at.start < chunk_start);
        before.map(|at| tree_of(at).map_or(0, |tree| tree.rungs.len())).sum::<usize>() + number
    }

    /// How many of its rungs start before a byte of the document.
    pub fn rungs_before(&self, offset: usize) -> usize {
        let starts = self.chunks.iter().flat_map(|at| {
            let rungs = tree_of(at).map_or(&[][..], |tree| &tree.rungs);
            rungs.iter().map(|rung| at.start + rung.span.start as usize)
        });
        starts.filter(|start| *start < offset).count()
    }

    /// The text with a part of it, in bytes of the document, replaced.
    pub fn with(&self, span: Span, replacement: &str) -> String {
        let (start, end) = (span.start as usize - self.start, span.end as usize - self.start);
        let (head, tail) = (self.text.get(..start).unwrap_or(""), self.text.get(end..).unwrap_or(""));
        [head, replacement, tail].concat()
    }

    /// Proves that `new` reads as this window with rung `number` saying `wanted`, whose words stand in `source`; with
    /// `added` that rung is a new one. All other rungs, all comments, headers and numbers must be the same.
    pub fn prove(
        &self,
        new: String,
        number: usize,
        wanted: &Graph,
        source: &str,
        added: bool,
    ) -> Option<Proved> {
        let target = self.document.target();
        let mut start = 0;
        let mut read = Vec::new();
        for end in split(&new) {
            let chunk = new.get(start..end)?;
            read.push((Span::new(start, end), parse(chunk, target)));
            start = end;
        }
        let old_trees = self.chunks.iter().filter_map(|at| Some((at.chunk.text(), tree_of(at)?)));
        let old: Vec<(&str, &LadderTree)> = old_trees.collect();
        let again: Vec<(&str, &LadderTree)> = read.iter().map(|(span, tree)| (span.of(&new), tree)).collect();
        if !same_surroundings(&old, &again) {
            return None;
        }
        let rungs = |trees: &[(&'_ str, &'_ LadderTree)]| {
            trees.iter().map(|(_, tree)| tree.rungs.len()).sum::<usize>()
        };
        if rungs(&again) != rungs(&old) + usize::from(added) {
            return None;
        }
        let mut old_rungs =
            old.iter().flat_map(|(text, tree)| tree.rungs.iter().map(move |rung| (*text, rung)));
        let mut found = None;
        let mut at = 0;
        for (span, tree) in &read {
            let text = span.of(&new);
            for rung in &tree.rungs {
                if at == number {
                    let before = if added { None } else { old_rungs.next() };
                    let same_number = before.is_none_or(|(_, old)| number_of(old) == number_of(rung));
                    if !same_number || !rung.graph.same_logic(text, wanted, source) {
                        return None;
                    }
                    found = Some((rung.clone(), *span));
                } else {
                    let (old_text, old) = old_rungs.next()?;
                    if number_of(old) != number_of(rung) || !old.graph.same_logic(old_text, &rung.graph, text)
                    {
                        return None;
                    }
                }
                at += 1;
            }
        }
        let (rung, chunk) = found?;
        Some(Proved { start: self.start, old: self.text.clone(), new, rung, chunk })
    }
}

fn tree_of<'d>(at: &ChunkRef<'d>) -> Option<&'d LadderTree> {
    match at.chunk.tree() {
        Tree::Ladder(tree) => Some(tree),
        _ => None,
    }
}

fn number_of(rung: &Rung) -> Option<u32> {
    rung.number.map(|number| number.value)
}

/// Whether comments and headers are the same, and no more problems.
fn same_surroundings(old: &[(&str, &LadderTree)], new: &[(&str, &LadderTree)]) -> bool {
    fn comments<'t>(trees: &'t [(&'t str, &'t LadderTree)]) -> Vec<&'t str> {
        let all = trees.iter().flat_map(|(text, tree)| tree.comments.iter().map(move |span| span.of(text)));
        all.flat_map(str::split_whitespace).collect()
    }
    fn headers<'t>(trees: &'t [(&'t str, &'t LadderTree)]) -> Vec<&'t str> {
        trees.iter().filter_map(|(text, tree)| Some(tree.header.as_ref()?.span.of(text))).collect()
    }
    let problems =
        |trees: &[(&str, &LadderTree)]| trees.iter().map(|(_, tree)| tree.problems.len()).sum::<usize>();
    comments(old) == comments(new) && headers(old) == headers(new) && problems(new) <= problems(old)
}

impl Proved {
    /// The smallest edits, in bytes of the document.
    pub fn edits(&self) -> Vec<TextEdit> {
        changes::between(&self.old, &self.new, self.start)
    }

    /// The element of the new drawing that is element number `id` of the plan, and where its chunk starts in the
    /// edited document.
    pub fn element(&self, plan: &Plan, id: crate::ladder::ElementId) -> Option<(&Element, usize)> {
        let place = plan.shape.elements().iter().position(|element| *element == id)?;
        let shape = reduce(&self.rung.graph).ok()?;
        let found = *shape.elements().get(place)?;
        let element = self.rung.graph.elements.get(found.0 as usize)?;
        Some((element, self.start + self.chunk.start as usize))
    }

    /// The element that starts in a column of a line of the edited rung, and where its chunk starts in the edited
    /// document.
    pub fn element_at(&self, line: u32, column: u32) -> Option<(&Element, usize)> {
        let row = self.rung.lines.0 + line;
        let found = self.rung.graph.elements.iter().find(|e| e.row == row && e.columns.0 == column)?;
        Some((found, self.start + self.chunk.start as usize))
    }

    /// The edited rung's place in the edited document.
    pub fn rung_span(&self) -> Span {
        self.rung.span.shifted(self.start + self.chunk.start as usize)
    }

    /// The new window, and where it starts in the document.
    pub fn text(&self) -> (&str, usize) {
        (&self.new, self.start)
    }
}

/// Whether all words of the old rung are drawn again, but for those of elements that were removed.
pub(super) fn keeps_words(site: &Site<'_>, removed: &[&Element], new_lines: &str) -> bool {
    let mut counts = std::collections::HashMap::new();
    let words = |text: &str| -> Vec<String> {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        text.split(|c| !is_part(c))
            .filter(|word| word.chars().any(char::is_alphanumeric))
            .map(str::to_string)
            .collect()
    };
    for word in words(site.lines().of(site.text)) {
        *counts.entry(word).or_insert(0i32) += 1;
    }
    let gone = removed.iter().flat_map(|element| super::site::cells_of(element));
    for span in gone {
        for word in words(span.of(site.text)) {
            *counts.entry(word).or_insert(0) -= 1;
        }
    }
    for word in words(new_lines) {
        *counts.entry(word).or_insert(0) -= 1;
    }
    counts.values().all(|count| *count <= 0)
}
