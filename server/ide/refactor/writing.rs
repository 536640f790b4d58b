//! Writes refactored rungs in the words of the document: its notation, margins and line ends, comments kept.

mod iec;

use super::declaration::{self, Declaration};
use super::neighbourhood::Neighbourhood;
use super::{Change, Proposal};
use crate::document::{Document, Notation, Tree};
use crate::ide::changes::{between, smallest};
use crate::ide::{Style, drawing};
use crate::il::fx::{FxLine, FxTree, LineKind};
use crate::logic::Path;
use crate::target::Flow;
use crate::text::{Span, TextEdit};
use crate::translate::Source;
use crate::translate::{to_fx, to_ladder};

/// Writes paths in the place of rungs: the bytes of these in the document, and the new text.
type Writer<'w> = dyn Fn(&[Source], &[Path]) -> Option<(Span, String)> + 'w;

/// A proposal as edits of the document.
pub(super) struct Written {
    /// In order.
    pub edits: Vec<TextEdit>,
    /// The variables that they declare.
    pub declarations: Vec<Declaration>,
}

/// The edits that write a proposal; nothing where something would be lost.
pub(super) fn edits(around: &Neighbourhood<'_>, proposal: &Proposal, style: Style) -> Option<Written> {
    let document = around.document;
    let mut declarations = proposal.declarations.clone();
    let changes = &proposal.changes;
    let each = |write: &Writer<'_>| {
        let write = |change: &Change| write(around.replaced(change)?, &change.paths);
        changes.iter().map(write).collect::<Option<Vec<_>>>()
    };
    let written = match document.notation() {
        Notation::IecIl => iec::lists(around, changes, proposal.keeps_forms, &mut declarations)?,
        Notation::FxIl => each(&|rungs, paths| list(document, rungs, paths))?,
        Notation::Ladder => each(&|rungs, paths| drawn(document, rungs, paths, style))?,
    };
    let mut edits = Vec::new();
    for (old, new) in written {
        let (text, start) = (document.slice(old), old.start as usize);
        match document.notation() {
            // Between two edits a parenthesis could be open, and what is open reaches to the end of the program unit.
            Notation::IecIl => edits.extend(smallest(&text, &new, start)),
            _ => edits.extend(between(&text, &new, start)),
        }
    }
    if !declarations.is_empty() {
        edits.insert(0, declaration::edit(around, &declarations)?);
    }
    Some(Written { edits, declarations })
}

/// The lines of instructions of `rungs`, in bytes of the document, and `paths` in their place.
fn list(document: &Document, rungs: &[Source], paths: &[Path]) -> Option<(Span, String)> {
    let first = Lines::of(rungs.first()?)?;
    let last = Lines::of(rungs.last()?)?;
    for (number, placed) in rungs.iter().enumerate() {
        let lines = Lines::of(placed)?;
        // A label or a comment between rungs has no place in one rung.
        let begins_plainly =
            number == 0 || (placed.rung.labels.is_empty() && placed.rung.comments.is_empty());
        if !begins_plainly || (rungs.len() > 1 && lines.has_comments()) {
            return None;
        }
    }
    let old = Span { start: first.span().start, end: last.span().end };
    if paths.is_empty() {
        return (!first.has_comments()).then(|| (without_gap(document, old), String::new()));
    }
    let line_end = if document.slice(old).contains("\r\n") { "\r\n" } else { "\n" };
    let mut written = Vec::new();
    for path in paths {
        written.extend(to_fx::lines(path, document.target()).ok()?);
    }
    let comments = first.carried(&written)?;
    let mut new = String::new();
    for (line, comment) in written.iter().zip(&comments) {
        for own in &comment.above {
            new += &format!("{}{own}{line_end}", first.margin);
        }
        new += &format!("{}{line}", first.margin);
        if let Some(behind) = &comment.behind {
            new += &format!(" {behind}");
        }
        new += line_end;
    }
    if !document.slice(old).ends_with('\n') {
        new.truncate(new.len() - line_end.len());
    }
    Some((old, new))
}

/// The mark at the beginning of a file that says how its characters are stored.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Whether an instruction behind this stands at the beginning of its line.
fn is_margin(before: &str) -> bool {
    margin_of(before).trim().is_empty()
}

/// The blanks of it.
fn margin_of(before: &str) -> &str {
    before.trim_start_matches(BYTE_ORDER_MARK)
}

/// Lines of `document` that are to go, with the blank lines behind them if there is one before them or nothing: what
/// parted them from their neighbours need not stand there twice.
fn without_gap(document: &Document, lines: Span) -> Span {
    let before = (lines.start as usize).checked_sub(1).map(|end| document.line_at(end).2);
    match before.is_none_or(|before| margin_of(&before).trim().is_empty()) {
        true => with_blank_lines(document, lines),
        false => lines,
    }
}

/// Lines of `document` with the blank lines behind them.
fn with_blank_lines(document: &Document, lines: Span) -> Span {
    let mut end = lines.end as usize;
    while end < document.len() {
        let (_, start, line) = document.line_at(end);
        if start != end || !line.trim().is_empty() {
            break;
        }
        end += line.len();
    }
    Span::new(lines.start as usize, end)
}

/// The instructions of a rung of a list.
struct Lines<'a> {
    placed: &'a Source,
    text: &'a str,
    /// First byte in the chunk of each line with an instruction, where it ends, and whether it names something.
    lines: Vec<(usize, usize)>,
    /// What stands before the first instruction.
    margin: &'a str,
    /// The comments from the first instruction to the end of the last one's line.
    comments: Vec<Span>,
}

/// The comments of a written line.
#[derive(Clone, Default)]
struct Carried<'a> {
    above: Vec<&'a str>,
    behind: Option<&'a str>,
}

impl<'a> Lines<'a> {
    /// Nothing if there are lines that would be lost or would be wrong: NOP, step numbers, labels between.
    fn of(placed: &'a Source) -> Option<Lines<'a>> {
        let text = placed.chunk.text();
        let reading = placed.chunk.reading();
        let Tree::Fx(tree) = reading.tree() else { return None };
        let instructions = instructions(tree)?;
        let line = |line: &FxLine| {
            let start = text[..line.span.start as usize].rfind('\n').map_or(0, |end| end + 1);
            let end = text[line.span.end as usize..].find('\n');
            (start, end.map_or(text.len(), |end| line.span.end as usize + end + 1))
        };
        let mut lines: Vec<(usize, usize)> =
            instructions.iter().map(|instruction| line(instruction)).collect();
        let (start, end) = (lines.first()?.0, lines.last()?.1);
        let before = text.get(start..instructions.first()?.span.start as usize)?;
        if !is_margin(before) {
            return None;
        }
        let margin = margin_of(before);
        if let Some(first) = lines.first_mut() {
            first.0 += before.len() - margin.len();
        }
        let comments = tree.comments.iter().copied();
        let comments =
            comments.filter(|comment| start <= comment.start as usize && comment.start as usize <= end);
        let comments = comments.collect();
        Some(Lines { placed, text, lines, margin, comments })
    }

    /// In bytes of the document, line ends included.
    fn span(&self) -> Span {
        let start = self.lines.first().map_or(0, |line| line.0);
        Span::new(start, self.lines.last().map_or(start, |line| line.1)).shifted(self.placed.start)
    }

    fn has_comments(&self) -> bool {
        !self.comments.is_empty()
    }

    /// The comments at `written` lines: each stays with the operands beside or below it. Nothing if one has no place.
    fn carried(&self, written: &[to_fx::Line]) -> Option<Vec<Carried<'a>>> {
        let mut carried: Vec<Carried<'a>> = vec![Carried::default(); written.len()];
        for comment in &self.comments {
            let words = comment.of(self.text).trim_end();
            if words.contains('\n') {
                return None;
            }
            let at = comment.start as usize;
            let beside = self.lines.iter().find(|(start, end)| *start <= at && at < *end);
            let (start, end) = beside.or_else(|| self.lines.iter().find(|(start, _)| at < *start))?;
            let stands_there = |line: &to_fx::Line| {
                let term = line.terms.first().filter(|term| !term.span.is_empty());
                term.is_some_and(|term| (*start..*end).contains(&(term.span.start as usize)))
            };
            let place = &mut carried[written.iter().position(stands_there)?];
            match beside {
                Some(_) if place.behind.is_some() => return None,
                Some(_) => place.behind = Some(words),
                None => place.above.push(words),
            }
        }
        Some(carried)
    }
}

/// The instructions behind the labels; nothing if there are others than those that a path keeps.
fn instructions(tree: &FxTree) -> Option<Vec<&FxLine>> {
    let is_label = |line: &&FxLine| matches!(line.kind, LineKind::Label(_));
    let instructions: Vec<&FxLine> = tree.lines.iter().skip_while(is_label).collect();
    let is_plain = |line: &&FxLine| match line.kind {
        LineKind::Instruction(form) => line.step.is_none() && form.instruction.flow() != Flow::Nothing,
        _ => false,
    };
    instructions.iter().all(is_plain).then_some(instructions)
}

/// The lines of drawn `rungs`, in bytes of the document, and `paths` in their place.
fn drawn(document: &Document, rungs: &[Source], paths: &[Path], style: Style) -> Option<(Span, String)> {
    let model = document.target().model;
    let plans: Option<Vec<to_ladder::Plan>> =
        paths.iter().map(|path| to_ladder::plan(path, model).ok()).collect();
    let places: Vec<usize> = rungs.iter().map(|placed| placed.span().start as usize).collect();
    drawing::redrawn::in_place_of(document, &places, plans?, style)
}
