//! Where in a drawing an editor's cursor or selection is: the rung, and the element or wire.

use crate::document::{Document, Tree};
use crate::ladder::{ArcId, Element, ElementId, LadderTree, Rung, VertexKind, column_after};
use crate::text::{Diagnostic, Span};

/// A rung with its surroundings.
#[derive(Clone, Debug)]
pub(super) struct Site<'d> {
    pub document: &'d Document,
    /// Where the chunk starts in the document.
    pub start: usize,
    /// The chunk.
    pub text: &'d str,
    pub tree: &'d LadderTree,
    /// The rung's number in the chunk.
    pub number: usize,
    pub rung: &'d Rung,
    /// First bytes of the chunk's lines.
    starts: Vec<usize>,
}

/// What the cursor is at.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Spot {
    Element(ElementId),
    Wire(ArcId),
}

impl<'d> Site<'d> {
    /// The rung at a byte of the document; none in comments, between rungs and outside of drawings.
    pub fn at(document: &'d Document, offset: usize) -> Option<Site<'d>> {
        let at = document.chunk_at(offset)?;
        let Tree::Ladder(tree) = at.chunk.tree() else { return None };
        let text = at.chunk.text();
        let line = line_of(text, offset.saturating_sub(at.start));
        let (number, rung) =
            tree.rungs.iter().enumerate().find(|(_, rung)| rung.lines.0 <= line && line < rung.lines.1)?;
        let starts = [0].into_iter().chain(text.match_indices('\n').map(|(end, _)| end + 1)).collect();
        Some(Site { document, start: at.start, text, tree, number, rung, starts })
    }

    /// The line of the chunk, from 0, in which a byte of it lies.
    pub fn line_of(&self, offset: usize) -> u32 {
        self.starts.partition_point(|start| *start <= offset).saturating_sub(1) as u32
    }

    /// The first byte of a line of the chunk; its end if there is no such line.
    pub fn line_start(&self, line: u32) -> usize {
        self.starts.get(line as usize).copied().unwrap_or(self.text.len())
    }

    /// A line of the chunk without its line end.
    pub fn line(&self, line: u32) -> &'d str {
        let text = self.text.get(self.line_start(line)..self.line_start(line + 1)).unwrap_or("");
        text.trim_end_matches(['\n', '\r'])
    }

    /// The bytes of the rung's lines in the chunk, line ends included.
    pub fn lines(&self) -> Span {
        let start = self.line_start(self.rung.lines.0);
        Span::new(start, self.line_start(self.rung.lines.1).max(start))
    }

    /// What was reported about the rung's lines.
    pub fn problems(&self) -> impl Iterator<Item = &'d Diagnostic> + use<'d> {
        let lines = self.lines();
        let inside = move |span: Span| span.start < lines.end && lines.start <= span.end;
        self.tree.problems.iter().filter(move |problem| inside(problem.span))
    }

    /// What a byte of the document is at; what is nearest where it is at nothing.
    pub fn spot(&self, offset: usize) -> Option<Spot> {
        let offset = offset.saturating_sub(self.start).min(self.text.len());
        self.spot_on(offset).or_else(|| self.spot_in_row(offset)).or_else(|| self.spot_in_column(offset))
    }

    /// The element whose symbol or words are at a byte of the chunk, or the wire whose cells are.
    pub fn spot_on(&self, offset: usize) -> Option<Spot> {
        let inside = |span: &Span| (span.start as usize) <= offset && offset < span.end as usize;
        let found = self.elements().find(|(_, element)| cells_of(element).iter().any(inside));
        if let Some((id, _)) = found {
            return Some(Spot::Element(id));
        }
        let wire = self.wires().find(|(_, cells)| cells.iter().any(inside));
        if let Some((arc, _)) = wire {
            return Some(Spot::Wire(arc));
        }
        let touching = |element: &Element| cells_of(element).iter().any(|span| span.touches(offset));
        self.elements().find(|(_, element)| touching(element)).map(|(id, _)| Spot::Element(id))
    }

    /// What is nearest in the line of a byte; of two, what is on the left.
    fn spot_in_row(&self, offset: usize) -> Option<Spot> {
        let line = self.line_of(offset);
        let start = self.line_start(line);
        let bounds = start..self.line_start(line + 1).max(start);
        let distance = |span: &Span| match span {
            span if span.end as usize <= offset => 2 * (offset - span.end as usize),
            span => 2 * (span.start as usize).saturating_sub(offset) + 1,
        };
        let in_line = |span: &&Span| bounds.contains(&(span.start as usize));
        let elements = self.elements().filter_map(|(id, element)| {
            let near = cells_of(element).iter().filter(in_line).map(distance).min()?;
            Some((near, Spot::Element(id)))
        });
        let wires = self.wires().filter_map(|(arc, cells)| {
            Some((cells.iter().filter(in_line).map(distance).min()?, Spot::Wire(arc)))
        });
        // Where an element touches a junction, the wire between them has no cell.
        elements.chain(wires).min_by_key(|(distance, _)| *distance).map(|(_, spot)| spot)
    }

    /// What is nearest below, else above, in the column of a byte.
    fn spot_in_column(&self, offset: usize) -> Option<Spot> {
        let row = self.line_of(offset);
        let column = self.column(offset);
        let distance = |line: u32| if line >= row { (line - row) * 2 } else { (row - line) * 2 + 1 };
        let covers = |span: &&Span| {
            self.column(span.start as usize) <= column && column < self.column(span.end as usize)
        };
        let elements = self
            .elements()
            .filter(|(_, element)| element.columns.0 <= column && column < element.columns.1)
            .map(|(id, element)| (distance(element.row), Spot::Element(id)));
        let wires = self.wires().filter_map(|(arc, cells)| {
            let cells = cells.iter().filter(covers);
            let near = cells.map(|span| distance(self.line_of(span.start as usize))).min()?;
            Some((near, Spot::Wire(arc)))
        });
        elements.chain(wires).min_by_key(|(distance, _)| *distance).map(|(_, spot)| spot)
    }

    /// The elements with a cell or a word in `span` of the document.
    pub fn elements_in(&self, span: Span) -> Vec<ElementId> {
        let (start, end) = (span.start as usize, span.end as usize);
        let meets = |cells: &Span| {
            self.start + (cells.start as usize) < end && start < self.start + cells.end as usize
        };
        let inside = self.elements().filter(|(_, element)| cells_of(element).iter().any(meets));
        inside.map(|(id, _)| id).collect()
    }

    pub fn element(&self, id: ElementId) -> &'d Element {
        &self.rung.graph.elements[id.0 as usize]
    }

    fn elements(&self) -> impl Iterator<Item = (ElementId, &'d Element)> + use<'d> {
        (0..).map(ElementId).zip(&self.rung.graph.elements)
    }

    fn wires(&self) -> impl Iterator<Item = (ArcId, &'d [Span])> + use<'d> {
        let graph = &self.rung.graph;
        (0..).map(ArcId).zip(&graph.arcs).map(|(id, arc)| (id, graph.cells(arc.cells)))
    }

    /// The wire before (or after) an element: that of its first wired pin.
    pub fn wire_beside(&self, id: ElementId, before: bool) -> Option<ArcId> {
        let graph = &self.rung.graph;
        let is = |vertex: &crate::ladder::VertexId| graph.vertex(*vertex).kind == VertexKind::Element(id);
        let vertex = graph.vertex_ids().find(is)?;
        match before {
            true => graph.incoming(vertex).min_by_key(|arc| graph.arc(*arc).head_pin),
            false => graph.outgoing(vertex).min_by_key(|arc| graph.arc(*arc).tail_pin),
        }
    }

    /// The displayed column of a byte of the chunk.
    pub fn column(&self, offset: usize) -> u32 {
        let start = self.line_start(self.line_of(offset));
        let head = self.text.get(start..offset).unwrap_or("");
        head.chars().fold(0, column_after)
    }
}

/// The cells of an element: its symbol, all rows of a block, and its words.
pub(super) fn cells_of(element: &Element) -> Vec<Span> {
    let mut cells = vec![element.span];
    cells.extend(element.operands.iter().map(|operand| operand.span));
    cells.extend(element.name_lines.iter().chain(&element.notes));
    if let Some(block) = element.block() {
        cells.extend(block.rows.iter().chain(&block.instance));
    }
    cells
}

/// The line, from 0, in which a byte lies.
pub(super) fn line_of(text: &str, offset: usize) -> u32 {
    let head = text.as_bytes().get(..offset).unwrap_or(text.as_bytes());
    head.iter().filter(|byte| **byte == b'\n').count() as u32
}

/// The first byte of a line; the end of the text if there is no such line.
pub(super) fn line_start(text: &str, line: u32) -> usize {
    match line.checked_sub(1) {
        None => 0,
        Some(before) => {
            text.match_indices('\n').nth(before as usize).map_or(text.len(), |(offset, _)| offset + 1)
        }
    }
}

/// The byte of a line at which a displayed column starts; the end of a shorter line.
pub(super) fn byte_of_column(line: &str, column: u32) -> usize {
    let mut at = 0;
    for (offset, character) in line.char_indices() {
        let next = column_after(at, character);
        if next > column {
            return offset;
        }
        at = next;
    }
    line.len()
}
