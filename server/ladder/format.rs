//! Puts the rungs of a document into the canonical form and leaves everything else as it is.
//!
//! Only rungs that were read without doubt are redrawn: a rung with a problem, a loose end, a bridge, a comment
//! in its midst, or outputs that would change their order stays as it was drawn, but for blanks at the ends of
//! lines. Lines and names that are off by a column or two are straightened where they have one reading. What was
//! redrawn is read again, and taken only if the logic is the same.

use super::lines::ended_lines;
use super::ragged::TWO_READINGS;
use super::reduce::{NotSeriesParallel, reduce};
use super::{
    Drawing, Element, ElementKind, LadderTree, NameHabit, Rung, Style, StyleKind, parse, parse_with, split,
};
use crate::target::Target;
use crate::text::{BYTE_ORDER_MARK, Diagnostic, Span, text_width};

/// Whether redrawing mends a problem. Every other one means that the rung may not say what its author meant.
fn is_mended(problem: &Diagnostic) -> bool {
    problem.code == "ragged-rail"
        || (problem.code == "ragged-drawing" && problem.message.key() != TWO_READINGS)
}

/// What all rungs of a document share.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Page {
    /// The characters of drawings.
    pub kind: StyleKind,
    /// The column of the right rail, from 0, counted from the left rail.
    pub rail: u32,
    /// Cells to the left of the left rail, for rung numbers; 0 if no rung has one.
    pub margin: u32,
    /// How the document's first line ends, and so the lines of a rung that has only one, without an end.
    pub line_end: &'static str,
}

impl Page {
    /// The page for the chunks of a document with their trees: wide enough for its widest rung that can be drawn.
    pub fn of<'a>(chunks: impl IntoIterator<Item = (&'a str, &'a LadderTree)>, style: &Style) -> Page {
        let rail = style.width.clamp(1, Style::WIDTH_MAX) - 1;
        let mut page = Page { kind: style.kind, rail, margin: 0, line_end: "\n" };
        let mut first_line_end = None;
        for (chunk, tree) in chunks {
            if first_line_end.is_none() {
                first_line_end = chunk.find('\n').map(|end| chunk[..end].ends_with('\r'));
            }
            let lines = Lines::of(chunk);
            for rung in &tree.rungs {
                if let Some(number) = rung.number {
                    page.margin = page.margin.max(text_width(number.span.of(chunk)) as u32 + 1);
                }
                if let Ok(drawing) = drawing(chunk, tree, rung, &lines, style.kind) {
                    page.rail = page.rail.max(drawing.rail_column_min());
                }
            }
        }
        if first_line_end == Some(true) {
            page.line_end = "\r\n";
        }
        page
    }
}

/// The document in canonical form. `text` is that of a ladder document as `target` reads it.
pub fn format(text: &str, target: &Target, style: &Style) -> String {
    let mut start = 0;
    let mut habit = NameHabit::default();
    let mut chunks = Vec::new();
    for end in split(text) {
        let chunk = text.get(start..end).unwrap_or("");
        let tree = parse(chunk, target);
        habit += tree.names;
        chunks.push((chunk, tree));
        start = end;
    }
    for (chunk, tree) in chunks.iter_mut().filter(|(_, tree)| tree.names.decided().is_none()) {
        *tree = parse_with(chunk, target, habit);
    }
    let page = Page::of(chunks.iter().map(|(chunk, tree)| (*chunk, tree)), style);
    let mut formatted = String::with_capacity(text.len() + text.len() / 4);
    for (chunk, tree) in &chunks {
        match format_chunk(chunk, tree, target, &page) {
            Some(chunk) => formatted.push_str(&chunk),
            None => formatted.push_str(chunk),
        }
    }
    formatted
}

/// The chunk in canonical form, or nothing if it is already.
pub fn format_chunk(chunk: &str, tree: &LadderTree, target: &Target, page: &Page) -> Option<String> {
    let lines = Lines::of(chunk);
    let drawn: Vec<Option<Vec<String>>> =
        drawn_rungs(chunk, tree, &lines, target, page).into_iter().map(Result::ok).collect();
    let formatted = lines.with_rungs(tree, &drawn, page);
    (formatted != chunk).then_some(formatted)
}

/// Why a rung stays as it was drawn.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Kept {
    /// Something of it could not be read, or is connected with nothing.
    Mistake,
    /// A comment stands in its midst, where a new drawing has no place for it.
    Comment,
    /// A word in it, or one of it elsewhere, would be lost.
    Words,
    /// It is neither series nor parallel.
    Bridge,
    /// Its outputs would come to be evaluated in another order.
    Order,
    /// With what stands around it, such as a frame, the new drawing would be read otherwise.
    Surroundings,
}

/// The rungs that [`format_chunk`] leaves as they were drawn, with the reasons.
pub fn kept_rungs(chunk: &str, tree: &LadderTree, target: &Target, page: &Page) -> Vec<(Span, Kept)> {
    let drawn = drawn_rungs(chunk, tree, &Lines::of(chunk), target, page);
    let kept = drawn.into_iter().map(Result::err).zip(&tree.rungs);
    kept.filter_map(|(kept, rung)| Some((rung.span, kept?))).collect()
}

/// The rungs of a chunk in canonical form, where they may be put into it.
fn drawn_rungs(
    chunk: &str,
    tree: &LadderTree,
    lines: &Lines<'_>,
    target: &Target,
    page: &Page,
) -> Vec<Result<Vec<String>, Kept>> {
    let paint = |rung: &Rung| {
        let drawing = drawing(chunk, tree, rung, lines, page.kind)?;
        let mut text = drawing.paint(page.rail).ok_or(Kept::Surroundings)?;
        for (row, comment) in line_comments(chunk, tree, rung, lines).ok_or(Kept::Comment)? {
            let line = text.get_mut(line_of(rung, &drawing, row)).ok_or(Kept::Comment)?;
            line.push_str("  ");
            line.push_str(comment);
        }
        Ok(text)
    };
    let mut drawn: Vec<Result<Vec<String>, Kept>> = tree.rungs.iter().map(paint).collect();
    leave_entangled_rungs(&tree.rungs, &mut drawn);
    // Where the reader would take a drawing for another, the search halves, so that it does not keep the rest.
    let mut taken = vec![None; drawn.len()];
    let mut waiting = vec![(0, drawn.len())];
    while let Some((first, end)) = waiting.pop() {
        if drawn[first..end].iter().all(Result::is_err) {
            continue;
        }
        let before = taken.clone();
        for (taken, drawn) in taken[first..end].iter_mut().zip(&drawn[first..end]) {
            *taken = drawn.as_ref().ok().cloned();
        }
        if !same(chunk, tree, &lines.with_rungs(tree, &taken, page), target) {
            taken = before;
            let middle = first.midpoint(end);
            if end - first > 1 {
                waiting.extend([(middle, end), (first, middle)]);
            }
        }
    }
    let pairs = taken.into_iter().zip(drawn);
    pairs.map(|(taken, drawn)| drawn.and_then(|_| taken.ok_or(Kept::Surroundings))).collect()
}

/// Whether `formatted` reads as the same rungs with the same notes, with no further problem and all comments.
pub(super) fn same(chunk: &str, tree: &LadderTree, formatted: &str, target: &Target) -> bool {
    same_but((chunk, tree), (formatted, &parse(formatted, target)), None)
}

/// The same of two trees with their texts, but for what the rung of one number says.
pub(super) fn same_but(
    (chunk, tree): (&str, &LadderTree),
    (formatted, again): (&str, &LadderTree),
    but: Option<usize>,
) -> bool {
    again.rungs.len() == tree.rungs.len()
        && again.problems.len() <= tree.problems.len()
        && again.comments.len() == tree.comments.len()
        && tree
            .comments
            .iter()
            .zip(&again.comments)
            .all(|(a, b)| words(a.of(chunk)).eq(words(b.of(formatted))))
        && tree.rungs.iter().zip(&again.rungs).enumerate().all(|(number, (rung, again))| {
            let says_the_same = || {
                notes(rung, chunk) == notes(again, formatted)
                    && rung.graph.same_logic(chunk, &again.graph, formatted)
            };
            rung.number.map(|number| number.value) == again.number.map(|number| number.value)
                && (but == Some(number) || says_the_same())
        })
}

/// The words at a rung's elements that are no operands, in alphabetical order. One more than was drawn is a word of
/// another line, which the next drawing would take along.
fn notes<'t>(rung: &Rung, chunk: &'t str) -> Vec<&'t str> {
    let spans = rung.graph.elements.iter().flat_map(|element| &element.notes);
    let mut notes: Vec<&str> = spans.map(|note| note.of(chunk)).collect();
    notes.sort_unstable();
    notes
}

/// A text but for its blanks, which may be trimmed at the ends of lines.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split_whitespace()
}

/// Rungs that share lines with others cannot be replaced by lines of their own.
fn leave_entangled_rungs(rungs: &[Rung], drawn: &mut [Result<Vec<String>, Kept>]) {
    for number in 1..rungs.len() {
        if rungs[number].lines.0 < rungs[number - 1].lines.1 {
            drawn[number] = Err(Kept::Surroundings);
            drawn[number - 1] = Err(Kept::Surroundings);
        }
    }
}

/// The comments behind a rung's lines, each with its line. Nothing if a comment stands anywhere else in the rung.
fn line_comments<'t>(
    chunk: &'t str,
    tree: &LadderTree,
    rung: &Rung,
    lines: &Lines<'_>,
) -> Option<Vec<(u32, &'t str)>> {
    let (start, end) = lines.bytes(rung.lines);
    let inside = |comment: &&Span| (comment.start as usize) < end && (comment.end as usize) > start;
    let behind_line = |comment: &Span| {
        let line = lines.starts.partition_point(|start| *start <= comment.start as usize) - 1;
        let (line_start, line_end) = lines.bytes((line as u32, line as u32 + 1));
        let before = chunk.get(line_start..comment.start as usize)?;
        let after = chunk.get(comment.end as usize..line_end)?;
        (!before.trim().is_empty() && after.trim().is_empty())
            .then(|| (line as u32, comment.of(chunk).trim_end()))
    };
    tree.comments.iter().filter(inside).map(behind_line).collect()
}

/// The line of a drawing that shows what was drawn on line `row` of the chunk, or below it if no element was there.
fn line_of(rung: &Rung, drawing: &Drawing, row: u32) -> usize {
    let elements = (0u32..).zip(&rung.graph.elements);
    let below =
        elements.clone().filter(|(_, element)| element.row >= row).min_by_key(|(_, element)| element.row);
    let nearest = below.or(elements.max_by_key(|(_, element)| element.row));
    nearest.and_then(|(id, _)| drawing.line_of(id)).unwrap_or(0)
}

/// The drawing of a rung that may be redrawn.
pub(super) fn drawing(
    chunk: &str,
    tree: &LadderTree,
    rung: &Rung,
    lines: &Lines<'_>,
    kind: StyleKind,
) -> Result<Drawing, Kept> {
    may_be_redrawn(chunk, tree, rung, lines)?;
    let shape = reduce(&rung.graph).map_err(|reason| match reason {
        NotSeriesParallel::Bridge(_) | NotSeriesParallel::SharedPin(_) => Kept::Bridge,
        _ => Kept::Mistake,
    })?;
    let drawing = Drawing::new(&shape, &rung.graph, chunk, kind).ok_or(Kept::Mistake)?;
    if keeps_order(rung, &drawing) { Ok(drawing) } else { Err(Kept::Order) }
}

/// Whether a rung says what its author meant, as far as one can see, and a new drawing of it would lose no word.
pub(super) fn may_be_redrawn(
    chunk: &str,
    tree: &LadderTree,
    rung: &Rung,
    lines: &Lines<'_>,
) -> Result<(), Kept> {
    let (start, end) = lines.bytes(rung.lines);
    match () {
        () if is_doubtful(tree, rung, lines) => Err(Kept::Mistake),
        () if line_comments(chunk, tree, rung, lines).is_none() => Err(Kept::Comment),
        () if !keeps_words(chunk, tree, rung, (start, end)) => Err(Kept::Words),
        () => Ok(()),
    }
}

/// Whether there is a mistake in a rung, or in the lines that follow it or go before it without a blank one: what is
/// stray there may have been meant for it.
fn is_doubtful(tree: &LadderTree, rung: &Rung, lines: &Lines<'_>) -> bool {
    let mut mistakes = tree.problems.iter().filter(|problem| !is_mended(problem)).peekable();
    if mistakes.peek().is_none() {
        return false;
    }
    let is_near = |line: u32| {
        let of_another = tree.rungs.iter().any(|other| other.lines.0 <= line && line < other.lines.1);
        !of_another && lines.lines.get(line as usize).is_some_and(|line| !line.trim().is_empty())
    };
    let (mut first, mut behind) = rung.lines;
    while first > 0 && is_near(first - 1) {
        first -= 1;
    }
    while is_near(behind) {
        behind += 1;
    }
    let (start, end) = lines.bytes((first, behind));
    // An empty span marks the place between two cells.
    mistakes.any(|problem| {
        (problem.span.start as usize) < end && problem.span.end.max(problem.span.start + 1) as usize > start
    })
}

/// Whether the lines of a rung, at these bytes, hold all its words and no letter that is not drawn again.
fn keeps_words(chunk: &str, tree: &LadderTree, rung: &Rung, (start, end): (usize, usize)) -> bool {
    let elements = &rung.graph.elements;
    let words: Vec<Span> = elements.iter().flat_map(words_of).collect();
    // A name on a line of another rung would be drawn here and stay there.
    if !words.iter().all(|word| start <= word.start as usize && word.end as usize <= end) {
        return false;
    }
    let boxes = elements.iter().filter_map(Element::block).flat_map(|block| block.rows.iter().copied());
    let symbols = elements.iter().map(|element| element.span).chain(boxes);
    let number = rung.number.map(|number| number.span);
    let mut known: Vec<Span> =
        words.into_iter().chain(symbols).chain(number).chain(tree.comments.clone()).collect();
    known.sort_unstable();
    let negated = elements
        .iter()
        .filter_map(Element::block)
        .any(|block| block.inputs.iter().chain(&block.outputs).any(|pin| pin.negated));
    let mut known = known.into_iter().peekable();
    let mut known_end = 0;
    chunk.get(start..end).unwrap_or("").char_indices().all(|(offset, character)| {
        let offset = start + offset;
        while let Some(span) = known.next_if(|span| span.start as usize <= offset) {
            known_end = known_end.max(span.end as usize);
        }
        let circle = negated && matches!(character, 'O' | 'o');
        offset < known_end || circle || !character.is_alphanumeric()
    })
}

/// Where the words of an element stand.
fn words_of(element: &Element) -> Vec<Span> {
    let mut words: Vec<Span> = element.operands.iter().map(|operand| operand.span).collect();
    words.extend(element.name_lines.iter().chain(&element.notes));
    match &element.kind {
        ElementKind::Block(block) => {
            let pins = block.inputs.iter().chain(&block.outputs);
            words.extend(
                block.instance.into_iter().chain(block.type_name).chain(pins.filter_map(|pin| pin.name)),
            );
        }
        ElementKind::Instruction { mnemonic: word, .. }
        | ElementKind::Jump(word)
        | ElementKind::ConnectorOut(word)
        | ElementKind::ConnectorIn(word) => words.push(*word),
        _ => {}
    }
    words
}

/// Whether outputs and function blocks, which act in the order in which they are drawn, keep that order.
fn keeps_order(rung: &Rung, drawing: &Drawing) -> bool {
    let acts = |id: &u32| {
        let element = &rung.graph.elements[*id as usize];
        element.is_output() || element.block().is_some()
    };
    let place = |id: &u32| {
        let element = &rung.graph.elements[*id as usize];
        (element.row, element.columns)
    };
    let order: Vec<u32> = drawing.reading_order().into_iter().filter(acts).collect();
    order.is_sorted_by_key(place)
}

/// The lines of a chunk.
pub(super) struct Lines<'t> {
    text: &'t str,
    pub(super) lines: Vec<&'t str>,
    /// Offset of each line and of the end.
    pub(super) starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    pub(super) fn of(chunk: &'t str) -> Lines<'t> {
        let lines: Vec<&str> = ended_lines(chunk).collect();
        let mut starts = vec![0];
        let mut offset = 0;
        for line in &lines {
            offset += line.len();
            starts.push(offset);
        }
        Lines { text: chunk, lines, starts }
    }

    /// The bytes of lines from the first of `range` to before the second.
    fn bytes(&self, range: (u32, u32)) -> (usize, usize) {
        let start = |line: u32| self.starts.get(line as usize).or(self.starts.last()).copied().unwrap_or(0);
        (start(range.0), start(range.1))
    }

    /// The chunk with the lines of rungs replaced by their drawings, where there are any.
    pub(super) fn with_rungs(&self, tree: &LadderTree, drawn: &[Option<Vec<String>>], page: &Page) -> String {
        let mut text = String::new();
        let mut line = 0;
        // Between rungs that stay as drawn, rails stay where those rungs have theirs.
        let redrawn = drawn.iter().any(Option::is_some);
        let rails = redrawn.then_some(page);
        for (rung, drawing) in tree.rungs.iter().zip(drawn) {
            let first = (rung.lines.0 as usize).clamp(line, self.lines.len());
            let end = (rung.lines.1 as usize).clamp(first, self.lines.len());
            self.lines[line..first].iter().for_each(|line| push_line_between(&mut text, line, rails));
            match drawing {
                Some(drawing) => {
                    self.push_drawing(&mut text, rung, drawing, page, &self.lines[first..end]);
                    if first == 0 && self.lines.first().is_some_and(|line| line.starts_with(BYTE_ORDER_MARK))
                    {
                        text.insert(0, BYTE_ORDER_MARK);
                    }
                }
                // Blanks at the ends of lines are no part of a drawing.
                None => {
                    self.lines[first..end].iter().for_each(|line| push_line_between(&mut text, line, None))
                }
            }
            line = end;
        }
        self.lines[line..].iter().for_each(|line| push_line_between(&mut text, line, rails));
        text
    }

    /// The rung's number stands beside its first power line.
    fn push_drawing(&self, text: &mut String, rung: &Rung, drawing: &[String], page: &Page, before: &[&str]) {
        let line_end = match before.first() {
            Some(line) if line.ends_with("\r\n") => "\r\n",
            Some(line) if line.ends_with('\n') => "\n",
            Some(line) if line.ends_with('\r') => "\r",
            _ => page.line_end,
        };
        let ended = before.last().is_some_and(|line| line.ends_with(['\n', '\r']));
        let margin = page.margin as usize;
        // As it was written: leading zeros are kept.
        let mut number = rung.number.map(|number| number.span.of(self.text));
        for (row, line) in drawing.iter().enumerate() {
            let leaves_rail = line.starts_with(['+', '├']) || !line.starts_with(['|', '│']);
            match number.take_if(|_| leaves_rail || row + 1 == drawing.len()) {
                Some(number) => {
                    let blanks = margin.saturating_sub(number.len() + 1);
                    text.extend(std::iter::repeat_n(' ', blanks));
                    text.push_str(number);
                    text.push(' ');
                }
                None => text.extend(std::iter::repeat_n(' ', margin)),
            }
            text.push_str(line);
            if row + 1 < drawing.len() || ended {
                text.push_str(line_end);
            }
        }
    }
}

/// A line that belongs to no rung: kept but for blanks at its end; rails without anything between follow the page
/// if there is one.
fn push_line_between(text: &mut String, line: &str, page: Option<&Page>) {
    let content = line.trim_end_matches(['\n', '\r']);
    let ending = &line[content.len()..];
    let content = content.trim_end_matches([' ', '\t']);
    // Counts that an LDmicro export writes beside its rails stay there.
    let number = content.trim_start().trim_start_matches(|c: char| c.is_ascii_digit());
    let number = &content[..content.len() - number.len()];
    let rails =
        content[number.len()..].split([' ', '\t']).filter(|word| !word.is_empty()).collect::<Vec<_>>();
    let is_rail = |word: &&str| matches!(*word, "|" | "||" | "│" | "││" | "┃" | "!");
    match (rails.as_slice(), page) {
        ([left, right], Some(page)) if is_rail(left) && is_rail(right) && left == right => {
            let number = number.trim();
            text.extend(std::iter::repeat_n(' ', (page.margin as usize).saturating_sub(number.len() + 1)));
            text.push_str(number);
            text.extend(std::iter::repeat_n(' ', (page.margin as usize).min(1)));
            let rail = if page.kind == StyleKind::Unicode { '│' } else { '|' };
            text.push(rail);
            text.extend(std::iter::repeat_n(' ', (page.rail as usize).saturating_sub(1)));
            text.push(rail);
        }
        _ => text.push_str(content),
    }
    text.push_str(ending);
}
