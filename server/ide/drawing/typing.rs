//! Typing in a drawing: a character replaces a cell of the wire or blank in which it was typed, and what it pushed
//! aside is pulled back.

use super::cells::{self, Row, is_upright, is_wire, is_word};
use super::object::element_at;
use super::rungs;
use super::site::{Site, line_of, line_start};
use super::{EditKind, edit};
use crate::document::{Document, Tree};
use crate::ide::Style;
use crate::ide::changes;
use crate::ladder::{Rung, Strokes, parse};
use crate::text::{Span, TextEdit, cell_width};

/// The edits after `typed` was typed, so that it ends at byte `offset`.
pub(in crate::ide) fn after_character(document: &Document, offset: usize, typed: char) -> Vec<TextEdit> {
    let Some(start) = offset.checked_sub(typed.len_utf8()) else { return Vec::new() };
    let Some(at) = document.chunk_at(start) else { return Vec::new() };
    let Tree::Ladder(tree) = at.chunk.tree() else { return Vec::new() };
    let (text, inside) = (at.chunk.text(), start - at.start);
    if !text.get(inside..).is_some_and(|rest| rest.starts_with(typed)) {
        return Vec::new();
    }
    let Some(keystroke) = Keystroke::read(document, text, inside, typed) else { return Vec::new() };
    // A second slash may begin a comment, but not in a contact.
    let in_comment = tree.comments.iter().any(|comment| comment.touches(inside + 1));
    if in_comment && !keystroke.is_mark() {
        return Vec::new();
    }
    let Some(rows) = keystroke.answered() else { return Vec::new() };
    let first = line_start(text, keystroke.first);
    let mut edits = Vec::new();
    let mut start = at.start + first;
    for (row, line) in rows.iter().zip(text.get(first..).unwrap_or("").split_inclusive('\n')) {
        let old = line.lines().next().unwrap_or("");
        edits.extend(changes::smallest(old, &cells::text(row), start));
        start += line.len();
    }
    edits
}

/// A line without its line end.
fn line_at(text: &str, line: u32) -> &str {
    text.get(line_start(text, line)..).and_then(|rest| rest.lines().next()).unwrap_or("")
}

/// A character typed into a rung.
struct Keystroke {
    typed: char,
    /// Cells that it fills.
    width: usize,
    /// The first line of the rung in the chunk.
    first: u32,
    /// The rows of the rung as they were before.
    rows: Vec<Row>,
    /// The row and column where it was typed.
    row: usize,
    column: usize,
}

impl Keystroke {
    /// Reads what was there before the character at byte `inside` of a chunk.
    fn read(document: &Document, text: &str, inside: usize, typed: char) -> Option<Keystroke> {
        let line = line_of(text, inside);
        let from = line_start(text, line);
        let current = line_at(text, line);
        let column = cells::row(text.get(from..inside)?)?.len();
        let own = [current.get(..inside - from)?, current.get(inside - from + typed.len_utf8()..)?].concat();
        // Nothing was pushed where nothing stands behind.
        if own.get(inside - from..)?.trim().is_empty() {
            return None;
        }
        let before = [text.get(..inside)?, text.get(inside + typed.len_utf8()..)?].concat();
        let tree = parse(&before, document.target());
        let header = tree.header.as_ref().map(|header| header.span);
        let in_header = header.is_some_and(|header| line_of(&before, header.start as usize) == line);
        let covers = |span: &Span| (span.start as usize) < inside && inside <= span.end as usize;
        if in_header || tree.comments.iter().any(covers) {
            return None;
        }
        let rung = tree.rungs.iter().find(|rung| rung.lines.0 <= line && line < rung.lines.1);
        let (first, end) = rung.map_or((line, line + 1), |rung: &Rung| rung.lines);
        let lines = before.get(line_start(&before, first)..)?.lines().take((end - first) as usize);
        let rows: Vec<Row> = lines.map(cells::row).collect::<Option<_>>()?;
        let row = (line - first) as usize;
        Some(Keystroke { typed, width: cell_width(typed), first, rows, row, column })
    }

    /// The rows as they are to be; nothing if the text is to stay as it was typed.
    fn answered(&self) -> Option<Vec<Row>> {
        if self.width == 0 {
            return None;
        }
        let mut rows = self.rows.clone();
        let own = &mut rows[self.row];
        if let Some(end) = self.room() {
            self.put(own);
            cells::remove(own, end + self.width, self.width);
            if let Some(completed) = self.completed(own) {
                *own = completed;
                self.joined(&mut rows);
            }
            return Some(rows);
        }
        // The whole rung gets wider, and narrower again where all of its rows have slack.
        if self.rows.len() == 1 && !self.rows[0].iter().any(|cell| is_upright(*cell)) {
            return None;
        }
        for (number, row) in rows.iter_mut().enumerate() {
            match number == self.row {
                true => self.put(row),
                false => cells::insert(row, self.column, self.width),
            }
        }
        if let Some(slack) = cells::slack(&rows, self.column + self.width + 1, self.width) {
            rows.iter_mut().for_each(|row| cells::remove(row, slack, self.width));
        }
        Some(rows)
    }

    fn put(&self, row: &mut Row) {
        let typed = cells::row(self.typed.encode_utf8(&mut [0; 4])).unwrap_or_else(|| vec![self.typed]);
        row.splice(self.column..self.column, typed);
    }

    /// The column (before the character is there) from which cells of the row give way; nothing if it has no room.
    fn room(&self) -> Option<usize> {
        let row = &self.rows[self.row];
        let (column, width) = (self.column, self.width);
        let next = *row.get(column)?;
        // A closing bar or bracket that is there already is typed over.
        if next == self.typed && (is_upright(next) || is_wire(next) || matches!(next, ']' | ')' | '}' | '>'))
        {
            return Some(column);
        }
        if self.is_mark() {
            return Some(column);
        }
        if is_wire(next) {
            return (run_end(row, column, is_wire) >= column + width).then_some(column);
        }
        if next == ' ' {
            return self.blank_room(row, column);
        }
        let word_end = run_end(row, column, is_word);
        if word_end > column && row.get(word_end) == Some(&' ') && !self.is_in_brackets(row) {
            return self.blank_room(row, word_end);
        }
        if self.is_in_brackets(row) {
            let close = (column..row.len()).find(|at| matches!(row[*at], ']' | ')' | '}'))?;
            let fill = *row.get(close + 1)?;
            let end = run_end(row, close + 1, |cell| cell == fill);
            let gives = (is_wire(fill) || fill == ' ') && end > close + 1 + width;
            return gives.then_some(close + 1);
        }
        None
    }

    /// Whether the character changes the kind of a contact or coil, of which it replaces the mark.
    fn is_mark(&self) -> bool {
        let row = &self.rows[self.row];
        let at = |column: Option<usize>| column.and_then(|column| row.get(column)).copied().unwrap_or(' ');
        let (before, mark, behind) =
            (at(self.column.checked_sub(1)), at(Some(self.column)), at(Some(self.column + 1)));
        let is_mark =
            |character: char| matches!(character, ' ' | '/' | '\\' | 'P' | 'N' | 'S' | 'R' | '↑' | '↓');
        let framed = is_upright(before) && is_upright(behind) || (before, behind) == ('(', ')');
        framed && is_mark(mark) && is_mark(self.typed)
    }

    /// Blanks from a column on that give way without joining a word to the next.
    fn blank_room(&self, row: &Row, column: usize) -> Option<usize> {
        let end = run_end(row, column, |cell| cell == ' ');
        let behind = row.get(end).copied().unwrap_or(' ');
        let parted = if is_word(behind) && is_word(self.typed) { self.width + 1 } else { self.width };
        (end - column >= parted || end == row.len()).then_some(column)
    }

    fn is_in_brackets(&self, row: &Row) -> bool {
        let last = row[..self.column.min(row.len())]
            .iter()
            .rev()
            .find(|c| matches!(c, '[' | ']' | '(' | ')' | '{' | '}'));
        matches!(last, Some('[' | '(' | '{'))
    }

    /// The row with a wire of which three cells were typed led on over blanks to the next bar, junction or element.
    fn completed(&self, row: &Row) -> Option<Row> {
        let end = self.column + 1;
        let is_third = is_wire(self.typed)
            && self.column >= 2
            && row[self.column - 2..end].iter().all(|cell| *cell == self.typed)
            && self.column.checked_sub(3).is_none_or(|before| !is_wire(row[before]));
        let blanks = run_end(row, end, |cell| cell == ' ');
        let goal = *row.get(blanks)?;
        if !is_third || blanks == end || is_word(goal) {
            return None;
        }
        let mut row = row.clone();
        row[end..blanks].fill(self.typed);
        Some(row)
    }

    /// Makes a junction of the bar to which the wire of the typed row leads.
    fn joined(&self, rows: &mut [Row]) {
        let row = &rows[self.row];
        let end = run_end(row, self.column, is_wire);
        if row.get(end) != Some(&'|') {
            return;
        }
        let beside =
            |row: Option<&Row>| row.and_then(|row| row.get(end)).is_some_and(|cell| is_upright(*cell));
        let above = self.row.checked_sub(1).and_then(|above| rows.get(above));
        if beside(above) || beside(rows.get(self.row + 1)) {
            rows[self.row][end] = '+';
        }
    }
}

/// One past the run of such cells that starts at a column.
fn run_end(row: &[char], from: usize, is: impl Fn(char) -> bool) -> usize {
    (from..row.len()).find(|at| !is(row[*at])).unwrap_or(row.len().max(from))
}

/// The edits after Enter, where `offset` is the cursor in its new line: a branch where an element or junction stands,
/// an empty rung behind the end of a rung, else nothing.
pub(in crate::ide) fn after_enter(document: &Document, offset: usize, style: Style) -> Vec<TextEdit> {
    let (line, start, current) = document.line_at(offset);
    let Some(head_end) = start.checked_sub(1).filter(|_| line > 0) else { return Vec::new() };
    let indent = current.get(..offset - start).unwrap_or("");
    if !indent.trim().is_empty() {
        return Vec::new();
    }
    let (_, head_start, head) = document.line_at(head_end);
    let head_end = head_start + head.trim_end_matches(['\n', '\r']).len();
    let Some(first) = document.chunk_at(head_start) else { return Vec::new() };
    let next_line = (start + current.len()).min(document.len());
    let Some(last) = document.chunk_at(next_line) else { return Vec::new() };
    let window = Span::new(first.start, (last.start + last.chunk.len()).max(next_line));
    let text = document.slice(window);
    let (cut, resume) = (head_end - first.start, offset - first.start);
    let (Some(before), Some(behind)) = (text.get(..cut), text.get(resume..)) else { return Vec::new() };
    let whole = Document::new(&[before, behind].concat(), document.notation(), document.target());
    let Some(site) = Site::at(&whole, cut) else { return Vec::new() };
    let tail = behind.lines().next().unwrap_or("");
    if behind.starts_with(['\n', '\r']) || tail.trim().is_empty() {
        return rungs::after_end(document, &site, cut, offset, style);
    }
    let cell = behind.chars().next().unwrap_or(' ');
    let on_element =
        matches!(site.spot_on(cut.saturating_sub(site.start)), Some(super::site::Spot::Element(_)));
    let Strokes { left, right, up, down } = Strokes::of(cell);
    let on_junction = (left || right) && (up || down);
    // Before the left rail, Enter makes room above the row.
    if head.trim().is_empty() || !(on_element || on_junction) {
        return Vec::new();
    }
    let Some(element) = element_at(&site, cut) else { return Vec::new() };
    let span = site.element(element).span.shifted(site.start);
    let Ok(answer) = edit(&whole, Span::at(span.start as usize), EditKind::InsertBranch, None, style) else {
        return Vec::new();
    };
    let result = TextEdit::apply_all(&answer.edits, &whole.text());
    changes::between(&text, &result, window.start as usize)
}
