//! What the rules about drawings look at: the rungs of a chunk, which of them are sound, and trials of fixes.

use super::FINDERS;
use crate::check::ChunkContext;
use crate::document::{Scopes, Tree};
use crate::ladder::{Element, ElementKind, Graph, LadderTree, Rung, TWO_READINGS, VertexKind, parse_with};
use crate::target::Target;
use crate::text::{Diagnostic, Message, Span, TextEdit};
use std::cell::Cell;

/// A chunk of a ladder document.
pub(in crate::check) struct Drawn<'a> {
    pub(in crate::check) text: &'a str,
    pub(in crate::check) tree: &'a LadderTree,
    pub(in crate::check) target: &'static Target,
    pub(in crate::check) scopes: &'a Scopes,
    /// How many fixes may still be tried, for trying one costs as much as reading the chunk.
    trials: Cell<u32>,
    /// How many mistakes there are, once it has been counted.
    mistakes: Cell<Option<usize>>,
}

/// Fixes that one rule tries in one chunk.
const TRIALS_MAX: u32 = 12;
/// Chunks larger than this get no tried fixes, so that a keystroke in them stays cheap.
const TRIAL_BYTES_MAX: usize = 32 << 10;

/// Codes of the reader after which a rung does not say what its author meant.
const BREAKING: [&str; 2] = ["unreadable-cell", "contact-on-vertical"];

impl<'a> Drawn<'a> {
    /// The drawing of a chunk; nothing if it is no ladder.
    pub(in crate::check) fn of(context: &ChunkContext<'a>) -> Option<Drawn<'a>> {
        let Tree::Ladder(tree) = context.chunk.tree() else { return None };
        let text = context.chunk.text();
        let trials = if text.len() <= TRIAL_BYTES_MAX { TRIALS_MAX } else { 0 };
        let (target, scopes) = (context.target, context.scopes);
        Some(Drawn { text, tree, target, scopes, trials: Cell::new(trials), mistakes: Cell::new(None) })
    }

    /// The rungs whose graph says what was drawn: no loose end, no junction without a way in or out, and no cell
    /// that could not be read. Only these are judged further, for one mistake is one diagnostic.
    pub(super) fn sound_rungs(&self) -> impl Iterator<Item = &'a Rung> {
        self.sound_numbered().map(|(_, rung)| rung)
    }

    /// The same with their numbers in the chunk.
    pub(in crate::check) fn sound_numbered(&self) -> impl Iterator<Item = (usize, &'a Rung)> {
        let broken = self.breaking();
        self.tree.rungs.iter().enumerate().filter(move |(_, rung)| {
            let first = broken.partition_point(|span| span.end <= rung.span.start);
            let readable = broken.get(first).is_none_or(|span| rung.span.end <= span.start);
            readable && is_wired(&rung.graph)
        })
    }

    /// The cells that broke the reading, in order.
    pub(super) fn breaking(&self) -> Vec<Span> {
        // Without the element that a word in the wire is meant to be, the rung is another one.
        let breaks = |problem: &&Diagnostic| {
            BREAKING.contains(&problem.code)
                || matches!(problem.message.key(), "stray-operand.in-wire" | TWO_READINGS)
        };
        let problems = self.tree.problems.iter().filter(breaks);
        problems.map(|problem| problem.span).collect()
    }

    /// The cells of which one is meant to be joined with a wire that has two readings: they are no loose ends of their
    /// own.
    pub(super) fn in_doubt(&self) -> Vec<Span> {
        let doubts = self.tree.problems.iter().filter(|problem| problem.message.key() == TWO_READINGS);
        doubts.flat_map(|problem| problem.related.iter().map(|related| related.span)).collect()
    }

    /// What people call an element: its device or, without one, its symbol.
    pub(super) fn name(&self, element: &Element) -> String {
        match &element.kind {
            ElementKind::Contact(_) | ElementKind::Coil(_) if !element.operands.is_empty() => {
                element.operand_text(0, self.text).into_owned()
            }
            ElementKind::Block(block) => {
                block.instance.or(block.type_name).unwrap_or(element.span).of(self.text).to_string()
            }
            _ => element.span.of(self.text).to_string(),
        }
    }

    /// Adds `edits` as a fix if the drawing is better with them: fewer mistakes, and none of another kind.
    pub(super) fn try_fix(
        &self,
        found: &mut Diagnostic,
        title: Message,
        edits: Option<Vec<TextEdit>>,
    ) -> bool {
        let Some(edits) = edits.filter(|edits| !edits.is_empty()) else { return false };
        if !self.take_trial() {
            return false;
        }
        let before = self.mistakes.get().unwrap_or_else(|| self.count());
        self.mistakes.set(Some(before));
        let text = TextEdit::apply_all(&edits, self.text);
        let tree = parse_with(&text, self.target, self.tree.names);
        let after = self.untried(&text, &tree).count();
        if after < before {
            found.fixes.push(crate::text::Fix { title, edits });
        }
        after < before
    }

    /// Adds a blank line before the line that starts at `at` as a fix, if without any mistake the drawing then is more
    /// rungs of the same elements.
    pub(super) fn try_parting(&self, found: &mut Diagnostic, title: Message, at: usize) -> bool {
        let Some((head, tail)) = self.text.split_at_checked(at) else { return false };
        if !self.take_trial() {
            return false;
        }
        let size = |tree: &LadderTree| {
            let elements: usize = tree.rungs.iter().map(|rung| rung.graph.elements.len()).sum();
            (tree.rungs.len(), elements)
        };
        let parts = [head, tail].map(|text| (text, parse_with(text, self.target, self.tree.names)));
        let (mut rungs, mut elements) = (0, 0);
        for (text, tree) in &parts {
            if self.untried(text, tree).count() > 0 {
                return false;
            }
            let (more, larger) = size(tree);
            (rungs, elements) = (rungs + more, elements + larger);
        }
        let (before, same) = size(self.tree);
        let is_better = rungs > before && elements == same;
        if is_better {
            let line_end = if head.ends_with("\r\n") { "\r\n" } else { "\n" };
            let edits = vec![TextEdit::new(Span::at(at), line_end)];
            found.fixes.push(crate::text::Fix { title, edits });
        }
        is_better
    }

    /// Counts a trial; false if there have been enough.
    fn take_trial(&self) -> bool {
        let left = self.trials.get().checked_sub(1);
        left.inspect(|left| self.trials.set(*left)).is_some()
    }

    /// Whether fixes can be tried at all.
    pub(super) fn can_try(&self) -> bool {
        self.trials.get() > 0
    }

    fn untried<'b>(&'b self, text: &'b str, tree: &'b LadderTree) -> Drawn<'b> {
        let (target, scopes) = (self.target, self.scopes);
        Drawn { text, tree, target, scopes, trials: Cell::new(0), mistakes: Cell::new(None) }
    }

    /// The number of mistakes in the drawing.
    fn count(&self) -> usize {
        let plain = self.untried(self.text, self.tree);
        let mut found = Vec::new();
        for find in FINDERS {
            find(&plain, &mut found);
        }
        found.len() + self.tree.problems.len()
    }
}

fn is_wired(graph: &Graph) -> bool {
    graph.vertices.iter().all(|vertex| match vertex.kind {
        VertexKind::LooseEnd => false,
        VertexKind::Junction => vertex.in_degree > 0 && vertex.out_degree > 0,
        VertexKind::LeftRail | VertexKind::RightRail | VertexKind::Element(_) => true,
    })
}
