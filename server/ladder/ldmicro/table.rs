//! The tables behind the drawing: names with their types and pins.

use crate::text::Span;
use rustc_hash::FxHashSet;

/// A row of the I/O table or the list of variables.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TableRow {
    /// The name.
    pub name: Span,
    /// What the table calls its type, in the language of the program that wrote it.
    pub kind: Option<Span>,
    /// The number of its pin, if one is assigned.
    pub pin: Option<Span>,
    /// From the name to the last word.
    pub span: Span,
}

/// What a name is by its first letter, which LDmicro gives meaning; letter case counts.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum NameKind {
    /// `X`: a digital input.
    Input,
    /// `Y`: a digital output.
    Output,
    /// `R`: an internal relay.
    Relay,
    /// `T`: a timer.
    Timer,
    /// `C`: a counter.
    Counter,
    /// Everything else: a number of 16 bits. Analog inputs (`A`) and PWM outputs (`P`) are of this kind.
    Number,
}

impl NameKind {
    /// The kind of `name`.
    pub fn of(name: &str) -> NameKind {
        match name.chars().next() {
            Some('X') => NameKind::Input,
            Some('Y') => NameKind::Output,
            Some('R') => NameKind::Relay,
            Some('T') => NameKind::Timer,
            Some('C') => NameKind::Counter,
            _ => NameKind::Number,
        }
    }
}

/// The rows of the tables in `chunk`: those of the I/O table, and names of the list of variables that it lacks.
pub fn table_rows(chunk: &str) -> Vec<TableRow> {
    let mut rows: Vec<TableRow> = Vec::new();
    let mut names: FxHashSet<&str> = FxHashSet::default();
    let mut in_table = false;
    let mut offset = 0;
    for line in chunk.split_inclusive(['\n', '\r']) {
        let start = offset;
        offset += line.len();
        if is_rule(line.trim()) {
            in_table = true;
        } else if is_title(line.trim()) {
            in_table = false;
        } else if let Some(row) = variable(line, start) {
            if names.insert(row.name.of(chunk)) {
                rows.push(row);
            }
        } else if in_table && let Some(row) = io_row(line, start) {
            names.insert(row.name.of(chunk));
            rows.push(row);
        }
    }
    rows
}

/// Whether `words` are the title of a table: `I/O ASSIGNMENT:` in whatever language, or `VAR LIST:`. A title has a
/// stroke, as "in and out" has in every language, and nothing that could be a part of a drawing.
pub(in crate::ladder) fn is_title(words: &str) -> bool {
    let Some(title) = words.strip_suffix(':') else { return false };
    let title = title.trim_end();
    let plain = |c: char| c.is_alphabetic() || matches!(c, ' ' | '/' | '\u{a0}' | '\'');
    let stroke = title.split('/').count() == 2 && !title.starts_with('/') && !title.ends_with('/');
    title == "VAR LIST" || (stroke && title.chars().all(plain))
}

/// Whether `words` are a line between the title of a table and its end.
pub(in crate::ladder) fn is_row(words: &str) -> bool {
    let first = words.chars().next().unwrap_or(' ');
    let names = first.is_alphanumeric() || matches!(first, '_' | '#' | '$');
    let cells = names && words.contains(" | ") && !words.contains("--");
    let bare = names && words.contains(" |") && words.ends_with('|') && !words.contains("--");
    cells || bare || is_rule(words) || is_title(words) || words == "END" || variable(words, 0).is_some()
}

/// `-----+-----`
fn is_rule(words: &str) -> bool {
    words.contains("-+-") && words.chars().all(|c| matches!(c, '-' | '+'))
}

fn io_row(line: &str, start: usize) -> Option<TableRow> {
    let mut cells = Vec::new();
    let mut at = start;
    for cell in line.split('|') {
        let inner = cell.trim();
        let first = at + (cell.len() - cell.trim_start().len());
        cells.push((!inner.is_empty()).then(|| Span::new(first, first + inner.len())));
        at += cell.len() + 1;
    }
    let span = Span { start: (*cells.first()?)?.start, end: cells.iter().rev().find_map(|cell| *cell)?.end };
    let cell = |number: usize| cells.get(number).copied().flatten();
    (cells.len() > 1).then_some(TableRow { name: cell(0)?, kind: cell(1), pin: cell(2), span })
}

/// `  2 bytes Speed`, a line of the list of variables; a remark may follow.
fn variable(line: &str, start: usize) -> Option<TableRow> {
    let mut words = line.split_whitespace();
    let (size, unit, name) = (words.next()?, words.next()?, words.next()?);
    if size.parse::<u32>().is_err() || !matches!(unit, "byte" | "bytes") {
        return None;
    }
    let at = start + (name.as_ptr() as usize - line.as_ptr() as usize);
    let name = Span::new(at, at + name.len());
    Some(TableRow { name, kind: None, pin: None, span: name })
}
