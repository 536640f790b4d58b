//! What folds: rungs, networks, program units, sections, comments, and the bodies of steps, loops and master controls.

use super::{Fold, FoldKind};
use crate::document::{ChunkRef, Document, Tree};
use crate::il::fx::{FxTree, LineKind};
use crate::il::iec::{IecTree, ItemKind};
use crate::ladder::LadderTree;
use crate::target::Flow;
use crate::text::Span;

pub(super) fn of(document: &Document) -> Vec<Fold> {
    let mut folding = Folding { document, folds: Vec::new(), open: Vec::new(), network: None };
    for at in document.chunks() {
        let reading = at.chunk.reading();
        match reading.tree() {
            Tree::Fx(tree) => folding.fx(at, tree),
            Tree::Ladder(tree) => folding.ladder(at, tree),
            Tree::Iec(tree) => folding.iec(at, tree),
        }
    }
    folding.end_network(document.len());
    let mut folds = folding.folds;
    folds.sort_by_key(|fold| (fold.span.start, std::cmp::Reverse(fold.span.end)));
    folds.dedup();
    folds
}

/// What a closing word closes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Opener {
    Step,
    MasterControl(Option<crate::target::Device>),
    Loop,
    Unit,
    Configuration,
}

struct Folding<'d> {
    document: &'d Document,
    folds: Vec<Fold>,
    /// Offsets of openers that have not been closed yet.
    open: Vec<(Opener, usize)>,
    /// Where the current network of a ladder starts.
    network: Option<usize>,
}

impl Folding<'_> {
    fn fx(&mut self, at: ChunkRef<'_>, tree: &FxTree) {
        self.comments(at, &tree.comments);
        if let (Some(first), Some(last)) = (tree.lines.first(), tree.lines.last()) {
            let start = first.step.map_or(first.span.start, |step| step.span.start);
            self.add(at, Span { start, end: last.span.end }, FoldKind::Region);
        }
        for line in &tree.lines {
            let LineKind::Instruction(form) = line.kind else { continue };
            let offset = at.start + line.span.start as usize;
            let nesting = || tree.operands(line).first().and_then(|operand| operand.value.device());
            match form.instruction.flow() {
                Flow::Step => {
                    self.close_before(Opener::Step, offset);
                    self.open.push((Opener::Step, offset));
                }
                Flow::StepsEnd => self.close(Opener::Step, at.start + line.span.end as usize),
                Flow::SectionBegin => self.open.push((Opener::MasterControl(nesting()), offset)),
                Flow::SectionEnd => {
                    self.close(Opener::MasterControl(nesting()), at.start + line.span.end as usize)
                }
                Flow::LoopBegin => self.open.push((Opener::Loop, offset)),
                Flow::LoopEnd => self.close(Opener::Loop, at.start + line.span.end as usize),
                _ => {}
            }
        }
    }

    fn ladder(&mut self, at: ChunkRef<'_>, tree: &LadderTree) {
        self.comments(at, &tree.comments);
        for rung in &tree.rungs {
            self.add(at, rung.span, FoldKind::Region);
        }
        if let Some(header) = &tree.header {
            let start = at.start + header.span.start as usize;
            self.end_network(at.start);
            self.network = Some(start);
        }
    }

    fn iec(&mut self, at: ChunkRef<'_>, tree: &IecTree) {
        self.comments(at, &tree.comments);
        let mut statements: Option<Span> = None;
        for item in &tree.items {
            let (start, end) = (at.start + item.span.start as usize, at.start + item.span.end as usize);
            match item.kind {
                ItemKind::Pou { .. } => self.open.push((Opener::Unit, start)),
                ItemKind::PouEnd(_) => {
                    self.end_network(start);
                    self.close(Opener::Unit, end);
                }
                ItemKind::Configuration { .. } | ItemKind::Resource { .. } => {
                    self.open.push((Opener::Configuration, start));
                }
                ItemKind::End(_) => self.close(Opener::Configuration, end),
                ItemKind::Section { .. } | ItemKind::Types { .. } => {
                    self.add(at, item.span, FoldKind::Region)
                }
                ItemKind::Task(_) | ItemKind::Instance(_) => {}
                _ => {
                    let whole = statements.map_or(item.span, |span| span.to(item.span));
                    statements = Some(whole);
                }
            }
        }
        if let Some(span) = statements {
            self.add(at, span, FoldKind::Region);
        }
    }

    /// Comments of several lines, and comments on lines of their own directly below each other.
    fn comments(&mut self, at: ChunkRef<'_>, comments: &[Span]) {
        let text = at.chunk.text();
        let mut run: Option<Span> = None;
        for &comment in comments {
            let line_start =
                text.get(..comment.start as usize).and_then(|head| head.rfind('\n')).map_or(0, |end| end + 1);
            let stands_alone =
                text.get(line_start..comment.start as usize).is_some_and(|head| head.trim().is_empty());
            let gap = |run: Span| text.get(run.end as usize..comment.start as usize).unwrap_or("x");
            run = match run {
                Some(run)
                    if stands_alone && gap(run).trim().is_empty() && gap(run).matches('\n').count() == 1 =>
                {
                    Some(run.to(comment))
                }
                _ => {
                    if let Some(run) = run {
                        self.add(at, run, FoldKind::Comment);
                    }
                    Some(comment)
                }
            };
        }
        if let Some(run) = run {
            self.add(at, run, FoldKind::Comment);
        }
    }

    /// Adds a fold inside of a chunk if it has more than one line.
    fn add(&mut self, at: ChunkRef<'_>, span: Span, kind: FoldKind) {
        let text = span.of(at.chunk.text());
        let length = text.trim_end().len();
        if text.trim_end().contains('\n') {
            let span = Span { start: span.start, end: span.start + length as u32 };
            self.folds.push(Fold { span: span.shifted(at.start), kind });
        }
    }

    fn close(&mut self, opener: Opener, end: usize) {
        if let Some(place) = self.open.iter().rposition(|(open, _)| *open == opener) {
            let (_, start) = self.open.remove(place);
            self.add_across(start, end);
        }
    }

    /// Closes a step at the one after it: the fold ends with the line before `next`.
    fn close_before(&mut self, opener: Opener, next: usize) {
        if self.open.iter().any(|(open, _)| *open == opener) {
            self.close(opener, self.content_end(next));
        }
    }

    fn end_network(&mut self, next: usize) {
        if let Some(start) = self.network.take() {
            self.add_across(start, self.content_end(next));
        }
    }

    /// The end of the last line with text before `offset`.
    fn content_end(&self, offset: usize) -> usize {
        let mut end = offset;
        while let Some(at) = end.checked_sub(1).and_then(|last| self.document.chunk_at(last)) {
            let text = at.chunk.text().get(..end.saturating_sub(at.start)).unwrap_or("");
            let content = text.trim_end().len();
            if content > 0 || at.start == 0 {
                return at.start + content;
            }
            end = at.start;
        }
        end
    }

    fn add_across(&mut self, start: usize, end: usize) {
        if start < end && self.document.line_of(start) < self.document.line_of(end) {
            self.folds.push(Fold { span: Span::new(start, end), kind: FoldKind::Region });
        }
    }
}
