//! Edits that change only the cells of one element: for rungs whose drawing is not the canonical one and shall stay.

use super::cells::{self, Row, is_wire};
use super::look::Look;
use super::site::{Site, cells_of};
use crate::ladder::{ArcId, Element, ElementId, ElementKind, OperandPlace, StyleKind};
use crate::text::Span;

/// The rows of a rung while cells of them are changed.
struct Sketch<'s, 'd> {
    site: &'s Site<'d>,
    rows: Vec<Row>,
    line_ends: Vec<&'d str>,
}

impl<'s, 'd> Sketch<'s, 'd> {
    /// Nothing if columns cannot be told from the lines alone.
    fn of(site: &'s Site<'d>) -> Option<Sketch<'s, 'd>> {
        let mut sketch = Sketch { site, rows: Vec::new(), line_ends: Vec::new() };
        for line in site.lines().of(site.text).split_inclusive('\n') {
            let content = line.trim_end_matches(['\n', '\r']);
            sketch.rows.push(cells::row(content)?);
            sketch.line_ends.push(&line[content.len()..]);
        }
        Some(sketch)
    }

    fn text(&self) -> String {
        let line = |(row, end): (&Row, &&str)| format!("{}{end}", cells::text(row));
        self.rows.iter().zip(&self.line_ends).map(line).collect()
    }

    /// Row and columns of a span of the chunk; nothing outside of the rung.
    fn place(&self, span: Span) -> Option<(usize, usize, usize)> {
        let line = self.site.line_of(span.start as usize).checked_sub(self.site.rung.lines.0)? as usize;
        let row = self.rows.get(line)?;
        let (start, end) =
            (self.site.column(span.start as usize) as usize, self.site.column(span.end as usize) as usize);
        (start <= end && end <= row.len()).then_some((line, start, end))
    }
}

/// How a rung spells its contacts, or its coils.
struct Spelling {
    open: char,
    close: char,
    place: OperandPlace,
}

impl Spelling {
    /// As the nearest element of the same sort has it; that of the look if there is none.
    fn of(site: &Site<'_>, look: &Look, element: &Element, near: u32) -> Spelling {
        let is_coil = matches!(element.kind, ElementKind::Coil(_));
        let elements = site.rung.graph.elements.iter().filter(|other| match other.kind {
            ElementKind::Coil(_) => is_coil,
            ElementKind::Contact(_) => !is_coil,
            _ => false,
        });
        let nearest = elements.min_by_key(|other| (other.row.abs_diff(near), other.columns.0));
        let frame = nearest.and_then(|other| {
            let symbol = other.span.of(site.text);
            Some((symbol.chars().next()?, symbol.chars().next_back()?, other.place))
        });
        let bars = match look.kind {
            _ if is_coil => ('(', ')'),
            StyleKind::Iec => ('|', '|'),
            StyleKind::Unicode => ('┤', '├'),
            StyleKind::Brackets => ('[', ']'),
        };
        let inside = look.kind == StyleKind::Brackets;
        let plain = if inside { OperandPlace::Inside } else { OperandPlace::Above };
        let (open, close, place) = frame.unwrap_or((bars.0, bars.1, plain));
        Spelling { open, close, place }
    }

    /// The body of a contact or coil.
    fn body(&self, element: &Element, name: &str) -> Option<String> {
        let mark = mark_of(&element.kind)?;
        let (open, close) = (self.open, self.close);
        Some(match (self.place == OperandPlace::Inside, mark) {
            (false, _) => format!("{open}{mark}{close}"),
            (true, ' ') => format!("{open}{name}{close}"),
            (true, '/') => format!("{open}/{name}{close}"),
            (true, _) => format!("{open}{mark} {name}{close}"),
        })
    }
}

/// The mark of a contact or coil; nothing for what has none.
fn mark_of(kind: &ElementKind) -> Option<char> {
    match kind {
        ElementKind::Contact(kind) => Some(kind.mark()),
        ElementKind::Coil(kind) => Some(kind.mark()),
        _ => None,
    }
}

/// The rung's lines with a contact or coil, named `name`, in the wire in which the cursor is; and its line in the rung
/// and its column.
pub(super) fn with_element(
    site: &Site<'_>,
    look: &Look,
    wire: ArcId,
    offset: usize,
    (element, name): (&Element, &str),
) -> Option<(String, u32, u32)> {
    let mut sketch = Sketch::of(site)?;
    let graph = &site.rung.graph;
    let inside = offset.saturating_sub(site.start);
    let spans = graph.cells(graph.arc(wire).cells);
    let near =
        |span: &&Span| (span.start as usize).abs_diff(inside).min((span.end as usize).abs_diff(inside));
    let run = spans.iter().find(|span| span.touches(inside)).or_else(|| spans.iter().min_by_key(near))?;
    let (row, mut first, mut last) = sketch.place(*run)?;
    while first > 0 && is_wire(sketch.rows[row][first - 1]) {
        first -= 1;
    }
    while sketch.rows[row].get(last).copied().is_some_and(is_wire) {
        last += 1;
    }
    let spelling = Spelling::of(site, look, element, site.rung.lines.0 + row as u32);
    let body = cells::row(&spelling.body(element, name)?)?;
    let above = if spelling.place == OperandPlace::Inside { Row::new() } else { cells::row(name)? };
    let left = (above.len() / 2).saturating_sub(body.len().saturating_sub(1) / 2);
    let right = above.len().saturating_sub(body.len() + left);
    // A wire on each side, and a blank before and behind the name.
    let need = body.len() + (left + 1).max(1) + (right + 1).max(1);
    let missing = need.saturating_sub(last - first);
    if missing > 0 {
        for row in &mut sketch.rows {
            cells::insert(row, last.saturating_sub(1).max(first), missing);
        }
        last += missing;
        if let Some(slack) = cells::slack(&sketch.rows, last + 1, missing) {
            sketch.rows.iter_mut().for_each(|row| cells::remove(row, slack, missing));
        }
    }
    let column = site.column(inside) as usize;
    let start = column.clamp(first + left + 1, (last - right - 1 - body.len()).max(first + left + 1));
    sketch.rows[row].get_mut(start..start + body.len())?.copy_from_slice(&body);
    if !above.is_empty() {
        let line = if spelling.place == OperandPlace::Below { row + 1 } else { row.checked_sub(1)? };
        let names = sketch.rows.get_mut(line)?;
        let from = start - left + usize::from(left == 0) * name_shift(above.len(), body.len());
        let to = from + above.len();
        if names.len() < to {
            names.resize(to, ' ');
        }
        let room = from.checked_sub(1)?..(to + 1).min(names.len());
        names[room].iter().all(|cell| *cell == ' ').then_some(())?;
        names[from..from + above.len()].copy_from_slice(&above);
    }
    Some((sketch.text(), row as u32, start as u32))
}

/// Cells by which a short name stands inside its symbol.
fn name_shift(name: usize, body: usize) -> usize {
    (body.saturating_sub(1) / 2).saturating_sub(name / 2)
}

/// The rung's lines with wire in the place of some elements and blanks in that of their names.
pub(super) fn without_elements(site: &Site<'_>, gone: &[ElementId]) -> Option<String> {
    let mut sketch = Sketch::of(site)?;
    for element in gone.iter().map(|id| site.element(*id)) {
        if element.block().is_some() {
            return None;
        }
        let (row, first, last) = sketch.place(element.span)?;
        for span in cells_of(element) {
            let (row, first, last) = sketch.place(span)?;
            sketch.rows[row][first..last].fill(' ');
        }
        let cells = &mut sketch.rows[row];
        let mut beside =
            [first.checked_sub(1), Some(last)].into_iter().flatten().filter_map(|at| cells.get(at).copied());
        let wire =
            beside.rfind(|cell| is_wire(*cell)).or_else(|| cells.iter().copied().find(|c| is_wire(*c)))?;
        cells[first..last].fill(wire);
    }
    Some(sketch.text())
}

/// The rung's lines with another kind of contact or coil in the place of some.
pub(super) fn with_kinds(site: &Site<'_>, changed: &[(ElementId, ElementKind)]) -> Option<String> {
    let mut sketch = Sketch::of(site)?;
    for (id, kind) in changed {
        let old = site.element(*id);
        let (row, first, last) = sketch.place(old.span)?;
        let mark = mark_of(kind)?;
        if last - first == 3 && !cells::is_word(sketch.rows[row][first + 1]) {
            sketch.rows[row][first + 1] = mark;
            continue;
        }
        let cells = &mut sketch.rows[row];
        if mark == '/' && cells.get(last).copied().is_some_and(is_wire) {
            cells.remove(last);
            cells.insert(first + 1, '/');
        } else if mark == ' ' && cells[first + 1] == '/' && cells.get(last).copied().is_some_and(is_wire) {
            let wire = cells[last];
            cells.insert(last, wire);
            cells.remove(first + 1);
        } else {
            return None;
        }
    }
    Some(sketch.text())
}
