//! Draws a series-parallel shape in the canonical form.

use super::grid::{MOST_COLUMNS, MOST_ROWS};
use super::layout::{BlockPlace, Layout, Place, lay_out};
use super::reduce::Shape;
use super::symbol::{Figure, FigurePin, Setting, Symbol};
use super::{Graph, canvas::Canvas};
use crate::text::text_width;
use std::collections::HashSet;

/// The characters that a drawing is made of.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum StyleKind {
    /// The character form of IEC 61131-3: `| |` with names above.
    #[default]
    Iec,
    /// `[X0]` and `(Y0)`, names inside.
    Brackets,
    /// Box drawing characters, names above.
    Unicode,
}

impl StyleKind {
    /// The style called `name` in settings and on the command line.
    pub fn named(name: &str) -> Option<StyleKind> {
        match name {
            "iec" => Some(StyleKind::Iec),
            "brackets" => Some(StyleKind::Brackets),
            "unicode" => Some(StyleKind::Unicode),
            _ => None,
        }
    }
}

/// How rungs are drawn.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Style {
    /// The characters.
    pub kind: StyleKind,
    /// Displayed cells of a rung from rail to rail, both included; wider rungs take what they need.
    pub width: u32,
}

impl Style {
    /// The width if nothing else is asked for.
    pub const WIDTH: u32 = 48;
    /// The widest that may be asked for. A terminal has some hundred cells; the limit keeps a mistyped setting
    /// from filling the memory.
    pub const WIDTH_MAX: u32 = 1000;
}

impl Default for Style {
    fn default() -> Style {
        Style { kind: StyleKind::Iec, width: Style::WIDTH }
    }
}

/// A rung's drawing but for the column of its right rail, which all rungs of a document share.
#[derive(Debug)]
pub struct Drawing {
    layout: Layout,
    symbols: Vec<Symbol>,
    columns: Vec<Column>,
    /// Cell of the vertical wires of each slot.
    slots: Vec<usize>,
    kind: StyleKind,
    rail_min: usize,
}

/// A column of the grid.
#[derive(Clone, Copy, Default, Debug)]
struct Column {
    /// First cell.
    start: usize,
    /// Cells in all.
    width: usize,
    /// Cells before the symbols of contacts and coils.
    lead: usize,
}

/// Draws `shape` of `graph`, whose words stand in `source`, one line of text for each line, ended by line feeds.
///
/// Nothing if the notation has no drawing for it: an element lacks its operand, a line starts at a connector below
/// other branches, a function block's further wires would cross others, or it would be larger
/// than what is read.
pub fn print(shape: &Shape, graph: &Graph, source: &str, style: &Style) -> Option<String> {
    let drawing = Drawing::new(shape, graph, source, style.kind)?;
    let rail = drawing.rail_column_min().max(style.width.clamp(1, Style::WIDTH_MAX) - 1);
    let mut text = drawing.paint(rail)?.join("\n");
    text.push('\n');
    Some(text)
}

impl Drawing {
    /// Cells in a drawing that can still be a rung; a rung of 500 branches has a tenth of it.
    const CELLS_MAX: usize = 4_000_000;

    /// Lays `shape` out; see [`print`].
    pub fn new(shape: &Shape, graph: &Graph, source: &str, kind: StyleKind) -> Option<Drawing> {
        let symbols: Option<Vec<Symbol>> =
            graph.elements.iter().map(|element| Symbol::of(element, source, kind)).collect();
        let symbols = symbols?;
        let layout = lay_out(shape, &symbols)?;
        let mut drawing =
            Drawing { layout, symbols, columns: Vec::new(), slots: Vec::new(), kind, rail_min: 0 };
        drawing.measure_columns();
        drawing.measure_rail();
        let is_readable = drawing.rail_min < MOST_COLUMNS && drawing.lines() < MOST_ROWS;
        is_readable.then_some(drawing)
    }

    fn lines(&self) -> usize {
        (self.layout.bottom - self.first_line() + 1).max(1) as usize
    }

    /// The least column, from 0, in which the right rail can stand.
    pub fn rail_column_min(&self) -> u32 {
        self.rail_min as u32
    }

    /// The elements in the order in which the drawing shows them: row by row, left to right.
    pub fn reading_order(&self) -> Vec<u32> {
        let Layout { leaves, ends, blocks, .. } = &self.layout;
        let grid = leaves.iter().chain(blocks.iter().map(|block| &block.place)).map(|place| (place, 0));
        let mut places: Vec<(&Place, u8)> = grid.chain(ends.iter().map(|place| (place, 1))).collect();
        places.sort_by_key(|(place, end)| (place.line, *end, place.column));
        places.into_iter().map(|(place, _)| place.element).collect()
    }

    /// The line of [`Drawing::paint`], from 0, on which the power line runs through an element.
    pub fn line_of(&self, element: u32) -> Option<usize> {
        let Layout { leaves, ends, blocks, .. } = &self.layout;
        let mut places = leaves.iter().chain(ends).chain(blocks.iter().map(|block| &block.place));
        let place = places.find(|place| place.element == element)?;
        usize::try_from(place.line - self.first_line()).ok()
    }

    fn symbol(&self, place: &Place) -> &Symbol {
        &self.symbols[place.element as usize]
    }

    fn measure_columns(&mut self) {
        let mut columns = vec![Column::default(); self.layout.columns];
        for place in self.layout.leaves.iter().filter(|place| self.is_aligned(self.symbol(place))) {
            let column = &mut columns[place.column];
            column.lead = column.lead.max(lead_and_rest(self.symbol(place), self.kind).0);
        }
        for place in &self.layout.leaves {
            let symbol = self.symbol(place);
            let (own_lead, rest) = lead_and_rest(symbol, self.kind);
            let column = &mut columns[place.column];
            let lead = if self.is_aligned(symbol) { column.lead } else { own_lead };
            column.width = column.width.max(lead + rest);
        }
        for block in &self.layout.blocks {
            let symbol = self.symbol(&block.place);
            if let Some(figure) = &symbol.figure {
                let outer = Figure::outer_width(&figure.outputs).max(1);
                let width = block_lead(symbol) + figure.inner_width() + 2 + outer + 1;
                let column = &mut columns[block.place.column];
                column.width = column.width.max(width);
            }
        }
        let mut has_vertical = vec![false; columns.len() + 1];
        self.layout.verticals.iter().for_each(|(slot, ..)| has_vertical[*slot] = true);
        let mut cell = 1;
        for (number, column) in columns.iter_mut().enumerate() {
            cell += if has_vertical[number] { 2 } else { 0 };
            self.slots.push(cell - 1);
            // A column of bare wires is as wide as a short element.
            column.width = column.width.max(4);
            column.start = cell;
            cell += column.width;
        }
        cell += if has_vertical[columns.len()] { 2 } else { 0 };
        self.slots.push(cell - 1);
        self.columns = columns;
    }

    fn is_aligned(&self, symbol: &Symbol) -> bool {
        matches!(symbol.setting, Setting::Aligned | Setting::Coil)
    }

    /// First cell after a slot.
    fn after_slot(&self, slot: usize) -> usize {
        self.slots[slot] + 1
    }

    fn measure_rail(&mut self) {
        let mut rail = self.after_slot(self.layout.columns) + 1;
        for place in &self.layout.ends {
            let symbol = self.symbol(place);
            let start = self.after_slot(place.column);
            let lead = if self.is_named(symbol) { 3 } else { 2 };
            // A name may touch the rail, but not what stands to its left.
            let name = symbol.name_width();
            rail = rail.max(start + lead + text_width(&symbol.body) + 1).max(start + 1 + name);
        }
        self.rail_min = rail;
    }

    /// Whether its name stands above, which takes the longer wires of the canonical form.
    fn is_named(&self, symbol: &Symbol) -> bool {
        self.is_aligned(symbol) && self.kind != StyleKind::Brackets
    }

    /// The lines of the drawing with the right rail in this column, without trailing blanks.
    /// Nothing if two parts would fill the same cell.
    pub fn paint(&self, rail: u32) -> Option<Vec<String>> {
        let rail = (rail as usize).max(self.rail_min);
        let top = self.first_line();
        let lines = self.lines();
        if lines.saturating_mul(rail) > Drawing::CELLS_MAX {
            return None;
        }
        let mut canvas = Canvas::new(lines, rail + 1, self.kind == StyleKind::Unicode);
        let mut painter = Painter { drawing: self, canvas: &mut canvas, top, rail };
        painter.paint()?;
        Some(canvas.into_lines())
    }

    /// The first line with anything on it: an empty one would be read as the end of a rung.
    fn first_line(&self) -> i32 {
        let above = |place: &Place| place.line - self.symbol(place).above.len() as i32;
        let symbols = self.layout.leaves.iter().chain(&self.layout.ends).map(above);
        let blocks = self.layout.blocks.iter();
        let blocks = blocks.map(|block| block.borders.0 - self.symbol(&block.place).above.len() as i32);
        symbols.chain(blocks).min().unwrap_or(0).min(0)
    }
}

/// Cells from the start of its column to a symbol, and from there to the end.
fn lead_and_rest(symbol: &Symbol, kind: StyleKind) -> (usize, usize) {
    let aligned = matches!(symbol.setting, Setting::Aligned | Setting::Coil) && kind != StyleKind::Brackets;
    let (lead, trail) = if aligned { (3, 2) } else { (2, 1) };
    let (name, body) = (symbol.name_width(), text_width(&symbol.body));
    let left = (name / 2).saturating_sub(body.saturating_sub(1) / 2);
    let right = name.saturating_sub(body + left);
    // One blank at least separates a name from what stands to its left.
    (lead.max(if name > 0 { left + 1 } else { 0 }), body + trail.max(right))
}

/// Where a name of `name` cells starts, counted from the start of the symbol below.
fn name_start(name: usize, body: usize) -> isize {
    (body.saturating_sub(1) / 2) as isize - (name / 2) as isize
}

/// Cells from the start of its column to a block's left edge.
fn block_lead(symbol: &Symbol) -> usize {
    let Some(figure) = &symbol.figure else { return 2 };
    let box_width = figure.inner_width() + 2;
    let left = (symbol.name_width() / 2 + 1).saturating_sub((box_width - 1) / 2);
    (Figure::outer_width(&figure.inputs) + 1).max(2).max(left)
}

/// Paints one drawing.
struct Painter<'a> {
    drawing: &'a Drawing,
    canvas: &'a mut Canvas,
    top: i32,
    rail: usize,
}

impl Painter<'_> {
    fn paint(&mut self) -> Option<()> {
        let layout = &self.drawing.layout;
        self.canvas.rails(self.rail);
        self.verticals();
        for line in &layout.from_rail {
            let row = self.row(*line);
            self.canvas.join_left_rail(row);
            self.wire(*line, 1, self.drawing.slots[0] + 1);
        }
        for (line, from, to) in &layout.wires {
            self.wire(*line, self.drawing.after_slot(*from), self.drawing.after_slot(*to));
        }
        for (line, from) in &layout.to_rail {
            self.wire(*line, self.drawing.after_slot(*from), self.rail);
            let row = self.row(*line);
            self.canvas.join_right_rail(row, self.rail);
        }
        layout.leaves.iter().try_for_each(|place| self.leaf(place))?;
        layout.blocks.iter().try_for_each(|block| self.block(block))?;
        layout.ends.iter().try_for_each(|place| self.end(place))?;
        self.canvas.is_whole().then_some(())
    }

    fn row(&self, line: i32) -> usize {
        (line - self.top) as usize
    }

    /// Vertical wires with an arm to each side on which a line meets them.
    fn verticals(&mut self) {
        let layout = &self.drawing.layout;
        let (mut arriving, mut leaving) = (HashSet::new(), HashSet::new());
        for place in &layout.leaves {
            let setting = self.drawing.symbol(place).setting;
            if setting != Setting::Source {
                leaving.insert((place.line, place.column));
            }
            arriving.insert((place.line, place.column + 1));
        }
        leaving.extend(layout.ends.iter().map(|place| (place.line, place.column)));
        leaving.extend(layout.to_rail.iter().copied());
        arriving.extend(layout.from_rail.iter().map(|line| (*line, 0)));
        for BlockPlace { place, inputs, outputs, .. } in &layout.blocks {
            let Some(figure) = &self.drawing.symbol(place).figure else { continue };
            let wired = |(pin, line): (&FigurePin, &i32)| pin.power.then_some(*line);
            leaving
                .extend(figure.inputs.iter().zip(inputs).filter_map(wired).map(|line| (line, place.column)));
            let lines = figure.outputs.iter().zip(outputs).filter_map(wired);
            arriving.extend(lines.map(|line| (line, place.column + 1)));
        }
        for (line, from, to) in &layout.wires {
            leaving.extend((*from..*to).map(|slot| (*line, slot)));
            arriving.extend((from + 1..=*to).map(|slot| (*line, slot)));
        }
        for (slot, first, last) in &layout.verticals {
            let cell = self.drawing.slots[*slot];
            for line in *first..=*last {
                let (left, right) = (arriving.contains(&(line, *slot)), leaving.contains(&(line, *slot)));
                let row = self.row(line);
                self.canvas.vertical(row, cell, (left, right, line > *first, line < *last));
            }
        }
        // The cell before a vertical wire belongs to the line that arrives there.
        for (line, slot) in arriving {
            if slot > 0 {
                let start = self.drawing.columns[slot - 1];
                self.wire(line, start.start + start.width, self.drawing.after_slot(slot));
            }
        }
    }

    /// A wire over cells; cells that a vertical wire has keep its arms.
    fn wire(&mut self, line: i32, from: usize, to: usize) {
        let row = self.row(line);
        self.canvas.horizontal(row, from, to);
    }

    fn leaf(&mut self, place: &Place) -> Option<()> {
        let symbol = self.drawing.symbol(place);
        let column = self.drawing.columns[place.column];
        let lead = match self.drawing.is_aligned(symbol) {
            true => column.lead,
            false => lead_and_rest(symbol, self.drawing.kind).0,
        };
        let start = column.start + lead;
        let end = start + text_width(&symbol.body);
        if symbol.setting != Setting::Source {
            self.wire(place.line, column.start, start);
        }
        self.wire(place.line, end, column.start + column.width);
        self.words(symbol, place.line, start)
    }

    /// An output at the end of its line: coils and jumps at the rail, boxes where the line ends, as in the
    /// examples of the notation.
    fn end(&mut self, place: &Place) -> Option<()> {
        let symbol = self.drawing.symbol(place);
        let body = text_width(&symbol.body);
        let line_end = self.drawing.after_slot(place.column);
        let start = match symbol.setting {
            Setting::Boxed { .. } => line_end + 2,
            _ => self.rail - 1 - body,
        };
        self.wire(place.line, line_end, start);
        if symbol.setting != Setting::Sink {
            self.wire(place.line, start + body, self.rail);
            let row = self.row(place.line);
            self.canvas.join_right_rail(row, self.rail);
        }
        self.words(symbol, place.line, start)
    }

    fn words(&mut self, symbol: &Symbol, line: i32, start: usize) -> Option<()> {
        let row = self.row(line);
        self.canvas.text(row, start, &symbol.body)?;
        self.above(symbol, line, start, text_width(&symbol.body))
    }

    /// The lines above a symbol, centred over it but not over the right rail.
    fn above(&mut self, symbol: &Symbol, line: i32, start: usize, body: usize) -> Option<()> {
        for (number, words) in symbol.above.iter().rev().enumerate() {
            let cells = text_width(words);
            let centred = start.checked_add_signed(name_start(cells, body))?;
            let row = self.row(line - 1 - number as i32);
            self.canvas.text(row, centred.min(self.rail.checked_sub(cells)?), words)?;
        }
        Some(())
    }

    fn block(&mut self, block: &BlockPlace) -> Option<()> {
        let symbol = self.drawing.symbol(&block.place);
        let figure = symbol.figure.as_ref()?;
        let column = self.drawing.columns[block.place.column];
        let left = column.start + block_lead(symbol);
        let right = left + figure.inner_width() + 1;
        let (first, last) = block.borders;
        let (first_row, last_row) = (self.row(first), self.row(last));
        self.canvas.frame((first_row, left), (last_row, right));
        self.above(symbol, first, left, right - left + 1)?;
        let type_start = left + 1 + (figure.inner_width() - text_width(&figure.type_name)) / 2;
        self.canvas.text(first_row + 1, type_start, &figure.type_name)?;
        for (pin, line) in figure.inputs.iter().zip(&block.inputs) {
            let row = self.row(*line);
            self.canvas.text(row, left + 1, &pin.name)?;
            let edge = left - usize::from(pin.negated);
            if pin.negated {
                self.canvas.text(row, edge, "O")?;
            }
            if pin.power {
                self.wire(*line, column.start, edge);
            } else if !pin.operand.is_empty() {
                let wire = edge - 2;
                self.canvas.text(row, wire - text_width(&pin.operand), &pin.operand)?;
                self.wire(*line, wire, edge);
            }
        }
        for (pin, line) in figure.outputs.iter().zip(&block.outputs) {
            let row = self.row(*line);
            self.canvas.text(row, right - text_width(&pin.name), &pin.name)?;
            let edge = right + 1 + usize::from(pin.negated);
            if pin.negated {
                self.canvas.text(row, right + 1, "O")?;
            }
            if pin.power {
                self.wire(*line, edge, column.start + column.width);
            } else if !pin.operand.is_empty() {
                self.wire(*line, edge, edge + 2);
                self.canvas.text(row, edge + 2, &pin.operand)?;
            }
        }
        Some(())
    }
}
