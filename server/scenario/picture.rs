//! Timing pictures: what variables were, a column for each scan in which something changed.

use crate::simulate::{Trace, TraceRow, Value, milliseconds};
use crate::text::{Language, Message, text_width};

/// Columns of a picture that stand side by side.
const PICTURE_WIDTH: usize = 100;

/// What a variable should have been in a scan.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Mark {
    /// The scan.
    pub scan: u64,
    /// The variable, as the trace calls it.
    pub name: String,
    /// What it should have been, as people write it.
    pub expected: String,
}

/// A timing picture of `trace`. Below a variable with marks stands what was expected of it, and `^` below that.
pub fn picture(trace: &Trace, marks: &[Mark], language: Language) -> String {
    let mut text = String::new();
    let columns: Vec<Column> = trace.rows.iter().map(|row| Column::of(row, trace, marks)).collect();
    let lines = Lines::of(trace, marks, language);
    let mut rest = &columns[..];
    while !rest.is_empty() {
        let mut width = 0;
        let fits = rest.iter().take_while(|column| {
            width += column.width;
            width <= PICTURE_WIDTH
        });
        let (now, later) = rest.split_at(fits.count().max(1));
        lines.write(&mut text, now);
        rest = later;
        if !rest.is_empty() {
            text.push('\n');
        }
    }
    text
}

/// The scans around the first that has a mark, as many as are read at one look.
pub fn around(trace: &Trace, marks: &[Mark]) -> Trace {
    let Some(first) = marks.iter().map(|mark| mark.scan).min() else { return trace.clone() };
    let mut rows = trace.rows.clone();
    for scan in marks.iter().map(|mark| mark.scan) {
        let behind = rows.partition_point(|row| row.scan <= scan);
        let Some(before) = behind.checked_sub(1).and_then(|at| rows.get(at)).cloned() else { continue };
        if before.scan != scan {
            // Nothing changed in it: its values are those of the row before, its time lies between its neighbours'.
            let step_ns =
                trace.rows.iter().find(|row| row.scan > 0).map_or(0, |row| row.time_ns / row.scan as i64);
            rows.insert(behind, TraceRow { scan, time_ns: scan as i64 * step_ns, ..before });
        }
    }
    let at = rows.partition_point(|row| row.scan < first);
    let start = at.saturating_sub(SHOWN_BEFORE);
    let end = (at + 1 + SHOWN_BEHIND).min(rows.len());
    let mut shown = trace.clone();
    shown.rows = rows.get(start..end).unwrap_or_default().to_vec();
    shown
}

/// Changes that are shown before the place of a difference, and behind it.
const SHOWN_BEFORE: usize = 9;
const SHOWN_BEHIND: usize = 2;

/// The cells of a scan.
struct Column<'t> {
    row: &'t TraceRow,
    head: [String; 2],
    /// What was expected of variables, by their numbers.
    marks: Vec<(usize, &'t str)>,
    width: usize,
}

impl<'t> Column<'t> {
    fn of(row: &'t TraceRow, trace: &Trace, marks: &'t [Mark]) -> Column<'t> {
        let head = [row.scan.to_string(), milliseconds(row.time_ns)];
        let own = marks.iter().filter(|mark| mark.scan == row.scan).filter_map(|mark| {
            let number = trace.names.iter().position(|name| *name == mark.name)?;
            Some((number, mark.expected.as_str()))
        });
        let own: Vec<(usize, &str)> = own.collect();
        let values = row.values.iter().map(Value::to_string);
        let widths = values.chain(head.iter().cloned()).map(|cell| text_width(&cell));
        let width = widths.chain(own.iter().map(|(_, cell)| text_width(cell))).max().unwrap_or(0) + 2;
        Column { row, head, marks: own, width }
    }

    fn expected(&self, number: usize) -> Option<&'t str> {
        self.marks.iter().find(|(own, _)| *own == number).map(|(_, expected)| *expected)
    }
}

/// The names at the left of a picture.
struct Lines<'t> {
    names: &'t [String],
    heads: [String; 2],
    expected: String,
    margin: usize,
    /// Which variables have marks.
    is_marked: Vec<bool>,
}

impl<'t> Lines<'t> {
    fn of(trace: &'t Trace, marks: &[Mark], language: Language) -> Lines<'t> {
        let heads = ["cli.run-scan", "cli.run-time"].map(|key| Message::new(key).render(language));
        let expected = format!("  {}", Message::new("scenario.expected").render(language));
        let names = &trace.names[..];
        let is_marked: Vec<bool> =
            names.iter().map(|name| marks.iter().any(|mark| mark.name == *name)).collect();
        let told = heads.iter().chain(is_marked.contains(&true).then_some(&expected));
        // A blank parts a name from its line, which may begin at once.
        let widths = names.iter().map(|name| text_width(name) + 1);
        let margin = widths.chain(told.map(|word| text_width(word))).max().unwrap_or(0);
        Lines { names, heads, expected, margin, is_marked }
    }

    fn write(&self, text: &mut String, columns: &[Column<'_>]) {
        let mut line = |name: &str, cell: &dyn Fn(&Column<'_>) -> String| {
            let margin = " ".repeat(self.margin - text_width(name));
            let cells: String = columns.iter().map(cell).collect();
            *text += format!("{name}{margin}{cells}").trim_end();
            text.push('\n');
        };
        for (number, head) in self.heads.iter().enumerate() {
            line(head, &|column| right(&column.head[number], column.width));
        }
        for (number, name) in self.names.iter().enumerate() {
            line(name, &|column| match column.row.values.get(number) {
                Some(Value::Bit(on)) => level(*on).repeat(column.width),
                Some(value) => right(&value.to_string(), column.width),
                None => String::new(),
            });
            if !self.is_marked[number] {
                continue;
            }
            let is_bit = |column: &Column<'_>| matches!(column.row.values.get(number), Some(Value::Bit(_)));
            line(&self.expected, &|column| match column.expected(number) {
                Some("1") if is_bit(column) => level(true).repeat(column.width),
                Some("0") if is_bit(column) => level(false).repeat(column.width),
                Some(expected) => right(expected, column.width),
                None => " ".repeat(column.width),
            });
            line("", &|column| {
                if column.expected(number).is_some() { "^" } else { " " }.repeat(column.width)
            });
        }
    }
}

fn level(on: bool) -> &'static str {
    if on { "▆" } else { "_" }
}

fn right(cell: &str, width: usize) -> String {
    format!("{}{cell}", " ".repeat(width.saturating_sub(text_width(cell))))
}
