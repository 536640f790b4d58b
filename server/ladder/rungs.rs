//! Links to graphs: which rows are a rung, and its vertices and arcs.

use super::grid::Grid;
use super::scan::{Symbol, Tokens, What};
use super::uprights::{Role, Uprights};
use super::wires::{Link, Node, Wiring};
use super::{Graph, Rung, VertexId, VertexKind};
use crate::text::{Span, Spanned};

/// The rungs of a drawing, top to bottom. Rows that a vertical wire or a function block joins are one rung, with the
/// rows between them, so that no two rungs share a line. `names` has the first and last row of each symbol's names.
pub(super) fn build_rungs(
    grid: &Grid,
    text: &str,
    tokens: Tokens,
    uprights: &Uprights,
    wiring: &Wiring,
    names: &[Option<(usize, usize)>],
    left: usize,
) -> Vec<Rung> {
    let has_rail = uprights
        .all
        .iter()
        .any(|upright| upright.role == Role::LeftRail && upright.cells.iter().any(|cell| cell.right));
    let groups = row_groups(&tokens, uprights);
    let Tokens { rows, symbols, .. } = tokens;
    let mut places = Places { uprights: vec![None; uprights.all.len()], symbols: vec![None; symbols.len()] };
    let mut symbols: Vec<Option<Symbol>> = symbols.into_iter().map(Some).collect();
    let mut rungs = Vec::with_capacity(groups.len());
    let mut links = wiring.links.as_slice();
    let mut rails = wiring.right_rail.as_slice();
    let mut free_from = 0;
    for (number, &(first, last)) in groups.iter().enumerate() {
        let count = links.iter().take_while(|link| link.row <= last).count();
        let (own, rest) = links.split_at(count);
        links = rest;
        let group = &rows[first..=last];
        // Without a left rail the leftmost wires of a rung are joined to it all the same.
        let edge = match has_rail {
            true => None,
            false => group.iter().flatten().filter(|token| token.is_drawn()).map(|token| token.start).min(),
        };
        let mut lines = (first, last);
        let numbers = group.iter().flatten().filter_map(|token| match token.what {
            What::Symbol(symbol) => Some(symbol),
            _ => None,
        });
        let mut members: Vec<usize> = numbers.collect();
        members.sort_unstable();
        members.dedup();
        for symbol in &members {
            if let Some((above, below)) = names[*symbol] {
                lines = (lines.0.min(above), lines.1.max(below));
            }
        }
        let mut builder = Builder {
            graph: Graph::with_room(members.len(), own.len()),
            rung: number,
            places: &mut places,
            grid,
            rows: &rows,
            uprights,
            wiring,
            edge,
            symbols: &mut symbols,
        };
        for link in own {
            builder.add(link);
        }
        // A function block without wires is still there.
        for symbol in members {
            builder.place(symbol);
        }
        // No line belongs to two rungs, whatever names stand between them.
        let free_to = groups.get(number + 1).map_or(grid.height(), |next| next.0);
        let lines = (lines.0.max(free_from).min(first), lines.1.min(free_to.saturating_sub(1)).max(last));
        free_from = lines.1 + 1;
        let beside = |mut lines: std::ops::RangeInclusive<usize>| {
            lines.find_map(|row| margin_number(grid, &rows, row, left, text))
        };
        let number = beside(first..=last).or_else(|| beside(lines.0..=lines.1));
        let count = rails.iter().take_while(|(row, _)| *row <= last).count();
        let (own_rails, rest) = rails.split_at(count);
        rails = rest;
        rungs.push(Rung {
            graph: builder.graph,
            number,
            span: content(grid, lines.0).to(content(grid, lines.1)),
            lines: (grid.line(lines.0), grid.line(lines.1) + 1),
            right_rail: own_rails.iter().map(|(_, rail)| *rail).collect(),
        });
    }
    rungs
}

fn content(grid: &Grid, row: usize) -> Span {
    grid.content(row).unwrap_or_else(|| grid.span(row, 0, 0))
}

/// First and last row of each rung.
fn row_groups(tokens: &Tokens, uprights: &Uprights) -> Vec<(usize, usize)> {
    // How far down something that starts in a row reaches.
    let mut reach: Vec<usize> = (0..tokens.rows.len()).collect();
    for upright in uprights.all.iter().filter(|upright| upright.role == Role::Junction) {
        let (first, last) = (upright.cells[0].row, upright.cells[upright.cells.len() - 1].row);
        reach[first] = reach[first].max(last);
    }
    for symbol in &tokens.symbols {
        let height = symbol.element.block().map_or(0, |block| block.rows.len());
        let first = symbol.row.saturating_sub(symbol.depth);
        reach[first] = reach[first].max(symbol.row).max(first + height.saturating_sub(1));
    }
    let live =
        |row: usize| tokens.rows[row].iter().any(|token| matches!(token.what, What::Wire | What::Symbol(_)));
    let mut groups: Vec<(usize, usize)> = Vec::new();
    let mut reached = None;
    for (row, reaches) in reach.into_iter().enumerate() {
        let joined = reached.is_some_and(|reached| row <= reached);
        if joined {
            if let Some(group) = groups.last_mut() {
                group.1 = row;
            }
        } else if live(row) || reaches > row {
            groups.push((row, row));
        } else {
            continue;
        }
        reached = reached.max(Some(reaches));
    }
    groups
}

/// The number left of the rail in a row.
fn margin_number(
    grid: &Grid,
    rows: &[Vec<super::scan::Token>],
    row: usize,
    left: usize,
    text: &str,
) -> Option<Spanned<u32>> {
    let [number, rail, ..] = rows.get(row)?.as_slice() else { return None };
    if number.what != What::Word || number.end > left || !matches!(rail.what, What::Upright(_)) {
        return None;
    }
    let span = grid.span(row, number.start, number.end);
    Some(Spanned::new(span.of(text).parse().ok()?, span))
}

/// The vertices of a drawing's uprights and symbols, each with the number of its rung.
struct Places {
    uprights: Vec<Option<(usize, VertexId)>>,
    symbols: Vec<Option<(usize, VertexId)>>,
}

/// Builds the graph of one rung.
struct Builder<'a> {
    graph: Graph,
    /// The number of the rung.
    rung: usize,
    places: &'a mut Places,
    grid: &'a Grid,
    rows: &'a [Vec<super::scan::Token>],
    uprights: &'a Uprights,
    wiring: &'a Wiring,
    /// The column where loose ends are joined to the left rail, in a drawing without one.
    edge: Option<usize>,
    symbols: &'a mut [Option<Symbol>],
}

impl Builder<'_> {
    fn add(&mut self, link: &Link) {
        let tail = self.vertex(link.tail);
        let head = self.vertex(link.head);
        let cells = self.wiring.cells.get(link.cells.0..link.cells.1).unwrap_or(&[]);
        self.graph.add_arc(tail, head, cells);
    }

    /// The vertex of a node with the pin number.
    fn vertex(&mut self, node: Node) -> (VertexId, u16) {
        match node {
            Node::LeftRail => (Graph::LEFT_RAIL, 0),
            Node::RightRail => (Graph::RIGHT_RAIL, 0),
            Node::Loose(end) => {
                let end = self.wiring.loose[end];
                if self.edge == Some(end.column) {
                    return (Graph::LEFT_RAIL, 0);
                }
                (self.graph.add_vertex(VertexKind::LooseEnd, &[end.span]), 0)
            }
            Node::Upright(upright) => {
                if let Some((_, vertex)) =
                    self.places.uprights[upright].filter(|(rung, _)| *rung == self.rung)
                {
                    return (vertex, 0);
                }
                let cells = &self.uprights.all[upright].cells;
                let span = |cell: &super::uprights::Cell| {
                    let token = self.rows[cell.row][cell.token];
                    self.grid.span(cell.row, token.start, token.end)
                };
                let cells: Vec<Span> = cells.iter().map(span).collect();
                let vertex = self.graph.add_vertex(VertexKind::Junction, &cells);
                self.places.uprights[upright] = Some((self.rung, vertex));
                (vertex, 0)
            }
            Node::Symbol(symbol, pin) => (self.place(symbol), pin),
        }
    }

    /// The vertex of a symbol, added when it is met first.
    fn place(&mut self, number: usize) -> VertexId {
        if let Some((_, vertex)) = self.places.symbols[number].filter(|(rung, _)| *rung == self.rung) {
            return vertex;
        }
        // Each symbol belongs to one rung, and is moved into its graph once.
        let Some(symbol) = self.symbols.get_mut(number).and_then(Option::take) else {
            return Graph::LEFT_RAIL;
        };
        let vertex = self.graph.add_element(symbol.element);
        self.places.symbols[number] = Some((self.rung, vertex));
        vertex
    }
}
