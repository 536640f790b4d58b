//! Text objects: the element, branch, rung or network at the cursor.

use super::operation::{innermost_branch, marked};
use super::parts::part_at;
use super::site::{Site, Spot, byte_of_column, cells_of, line_of, line_start};
use crate::document::{ChunkRef, Document, Tree};
use crate::ladder::reduce::{Shape, reduce};
use crate::ladder::{Element, ElementId, Strokes, VertexKind, column_after};
use crate::text::Span;

/// What a text object is.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ObjectKind {
    /// A contact, coil or box; around it with the name on another row.
    Element,
    /// A branch of a parallel: its elements; around them with the wires to the vertical wires at both ends.
    Branch,
    /// The rung's lines; around them with the comments above and the blank lines below.
    Rung,
    /// The rungs up to the next network header; around them with the header.
    Network,
}

/// A text object.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Object {
    /// From its first to its last byte in the document; of a rectangle, from its upper left to its lower right cell.
    pub span: Span,
    /// Whether it is a rectangle of cells.
    pub blockwise: bool,
}

/// A rectangle of cells: lines of the chunk and displayed columns, the ends not included.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    lines: (u32, u32),
    columns: (u32, u32),
}

/// The text object at a byte of the document.
pub(in crate::ide) fn at(
    document: &Document,
    offset: usize,
    kind: ObjectKind,
    around: bool,
) -> Option<Object> {
    match kind {
        ObjectKind::Element => {
            let site = Site::at(document, offset)?;
            let element = site.element(element_at(&site, offset)?);
            if !around && element.block().is_none() {
                return Some(Object { span: element.span.shifted(site.start), blockwise: false });
            }
            let rectangle = site.rectangle(&[element])?;
            let blockwise = rectangle.lines.0 + 1 < rectangle.lines.1;
            Some(Object { span: site.span_of(rectangle), blockwise })
        }
        ObjectKind::Branch => {
            let site = Site::at(document, offset)?;
            let elements = branch_at(&site, offset)?;
            let elements: Vec<&Element> = elements.iter().map(|id| site.element(*id)).collect();
            let mut rectangle = site.rectangle(&elements)?;
            if around {
                let row = elements.iter().map(|element| element.row).min()?;
                rectangle.columns = site.up_to_verticals(row, rectangle.columns);
            }
            Some(Object { span: site.span_of(rectangle), blockwise: true })
        }
        ObjectKind::Rung => rung(&Site::at(document, offset)?, around),
        ObjectKind::Network => network(document, offset, around),
    }
}

/// The element at the cursor; at a wire, the one to which it leads.
pub(super) fn element_at(site: &Site<'_>, offset: usize) -> Option<ElementId> {
    match site.spot(offset)? {
        Spot::Element(id) => Some(id),
        Spot::Wire(wire) => {
            let graph = &site.rung.graph;
            let arc = graph.arc(wire);
            [arc.head, arc.tail].into_iter().find_map(|vertex| match graph.vertex(vertex).kind {
                VertexKind::Element(id) => Some(id),
                _ => None,
            })
        }
    }
}

/// The elements of the innermost branch at the cursor.
pub(super) fn branch_at(site: &Site<'_>, offset: usize) -> Option<Vec<ElementId>> {
    let mut graph = site.rung.graph.clone();
    let (id, is_mark) = marked(site, &mut graph, offset)?;
    let shape = reduce(&graph).ok()?;
    let (mut path, branch) = innermost_branch(&shape, id)?;
    path.push(branch);
    let mut elements = part_at(&shape, &path).map(Shape::elements)?;
    elements.retain(|element| !(is_mark && *element == id));
    (!elements.is_empty()).then_some(elements)
}

fn rung(site: &Site<'_>, around: bool) -> Option<Object> {
    let lines = site.lines();
    let (mut start, mut end) = (lines.start as usize, lines.end as usize);
    if around {
        // A comment directly above moves with its rung.
        for comment in site.tree.comments.iter().rev().filter(|comment| comment.end <= lines.start) {
            let first = site.line_start(site.line_of(comment.start as usize));
            let before = site.text.get(first..comment.start as usize).unwrap_or("");
            let behind = site.text.get(comment.end as usize..start).unwrap_or("");
            if !before.trim().is_empty() || !behind.trim().is_empty() || behind.matches('\n').count() > 1 {
                break;
            }
            start = first;
        }
        for line in site.text.get(end..).unwrap_or("").split_inclusive('\n') {
            if !line.trim().is_empty() {
                break;
            }
            end += line.len();
        }
    }
    Some(Object { span: Span::new(start, end).shifted(site.start), blockwise: false })
}

/// From the chunk with the header, or the first of the document or program, to the one before the next header.
fn network(document: &Document, offset: usize, around: bool) -> Option<Object> {
    let mut at = document.chunk_at(offset)?;
    let is_drawing = |at: &ChunkRef<'_>| matches!(at.chunk.tree(), Tree::Ladder(_));
    let header = |at: &ChunkRef<'_>| match at.chunk.tree() {
        Tree::Ladder(tree) => tree.header.as_ref().map(|header| header.span),
        _ => None,
    };
    if !is_drawing(&at) {
        return None;
    }
    let mut end = at.start + at.chunk.len();
    while let Some(next) = document.chunk_at(end).filter(|next| next.start >= end && !next.chunk.is_empty()) {
        if !is_drawing(&next) || header(&next).is_some() {
            break;
        }
        end = next.start + next.chunk.len();
    }
    while header(&at).is_none() {
        match document.chunk_before(at.start).filter(|before| before.start < at.start && is_drawing(before)) {
            Some(before) => at = before,
            None => break,
        }
    }
    let start = match header(&at) {
        Some(header) if !around => {
            let line = line_of(at.chunk.text(), header.end as usize);
            at.start + line_start(at.chunk.text(), line + 1)
        }
        _ => at.start,
    };
    Some(Object { span: Span::new(start.min(end), end), blockwise: false })
}

impl Site<'_> {
    /// The smallest rectangle with all cells of some elements.
    fn rectangle(&self, elements: &[&Element]) -> Option<Rectangle> {
        let cells: Vec<Span> = elements.iter().flat_map(|element| cells_of(element)).collect();
        let lines = cells.iter().map(|span| self.line_of(span.start as usize));
        let starts = cells.iter().map(|span| self.column(span.start as usize));
        let ends = cells.iter().map(|span| self.column(span.end as usize));
        Some(Rectangle {
            lines: (lines.clone().min()?, lines.max()? + 1),
            columns: (starts.min()?, ends.max()?),
        })
    }

    /// Columns widened over the wires of a row on both sides.
    fn up_to_verticals(&self, row: u32, (first, last): (u32, u32)) -> (u32, u32) {
        let line = self.line(row);
        let mut column = 0;
        let mut cells = Vec::with_capacity(line.len());
        for character in line.chars() {
            cells.push((column, character));
            column = column_after(column, character);
        }
        let is_wire = |(_, character): &&(u32, char)| {
            let Strokes { left, right, up, down } = Strokes::of(*character);
            (left || right) && !up && !down
        };
        let before = cells.iter().rev().skip_while(|(at, _)| *at >= first).take_while(is_wire).last();
        let behind = cells.iter().skip_while(|(at, _)| *at < last).take_while(is_wire).last();
        (before.map_or(first, |(at, _)| *at), behind.map_or(last, |(at, _)| at + 1))
    }

    /// The bytes of the document from a rectangle's first to its last cell.
    fn span_of(&self, rectangle: Rectangle) -> Span {
        let byte = |line: u32, column: u32| self.line_start(line) + byte_of_column(self.line(line), column);
        let start = byte(rectangle.lines.0, rectangle.columns.0);
        let end = byte(rectangle.lines.1.saturating_sub(1), rectangle.columns.1);
        Span::new(start, end.max(start)).shifted(self.start)
    }
}
