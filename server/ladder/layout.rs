//! Where everything of a rung stands: grid columns and text lines for each part of its shape.
//!
//! Columns hold elements, slots between them hold vertical wires: slot `n` stands left of column `n`. Lines count
//! from the main power line, 0, downwards; names of the first row have negative lines. Outputs at the end of a line
//! have a line, but no column of their own, because the right rail decides where they stand.

use super::reduce::{BlockShape, Shape};
use super::symbol::{Figure, Setting, Symbol};

/// The places of all parts of a rung.
#[derive(Debug, Default)]
pub(super) struct Layout {
    /// Symbols in the grid.
    pub leaves: Vec<Place>,
    /// Outputs that end their line at the right rail.
    pub ends: Vec<Place>,
    /// Function blocks in the grid.
    pub blocks: Vec<BlockPlace>,
    /// Bare wires on a line, from one slot to another.
    pub wires: Vec<(i32, usize, usize)>,
    /// Bare wires on a line from a slot to the right rail.
    pub to_rail: Vec<(i32, usize)>,
    /// Lines that start at the left rail.
    pub from_rail: Vec<i32>,
    /// Vertical wires in a slot, from line to line.
    pub verticals: Vec<(usize, i32, i32)>,
    /// Number of columns.
    pub columns: usize,
    /// Last line.
    pub bottom: i32,
}

/// A symbol's place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Index of the element.
    pub element: u32,
    /// Its column; for an output at the end, the column where its line would go on.
    pub column: usize,
    /// Its line.
    pub line: i32,
}

/// A function block's place, with the line of each pin.
#[derive(Clone, Debug)]
pub(super) struct BlockPlace {
    /// The block; the line is that of its main pins.
    pub place: Place,
    /// Lines of the borders.
    pub borders: (i32, i32),
    /// Lines of the input pins.
    pub inputs: Vec<i32>,
    /// Lines of the output pins.
    pub outputs: Vec<i32>,
}

/// Where a part may be placed.
#[derive(Clone, Copy)]
struct At {
    column: usize,
    line: i32,
    /// Whether it ends at the right rail.
    tail: bool,
    /// Whether column 0 starts at the left rail, not at a vertical wire beside it.
    rail: bool,
    /// The last line that is taken further left.
    floor: i32,
}

/// What a placed part covers.
#[derive(Clone, Copy)]
struct Placed {
    /// The slot at its right.
    end: usize,
    /// Its last line.
    bottom: i32,
}

/// Places `shape`, whose elements are drawn as `symbols`. Nothing if the notation has no drawing for it.
pub(super) fn lay_out(shape: &Shape, symbols: &[Symbol]) -> Option<Layout> {
    let mut planner = Planner { symbols, layout: Layout::default() };
    let whole = At { column: 0, line: 0, tail: true, rail: true, floor: i32::MIN };
    let placed = match shape {
        // Rows that only the rails join would be rungs of their own, so a vertical wire beside the rail joins them.
        Shape::Parallel(branches) => {
            planner.layout.from_rail.push(0);
            planner.parallel(branches, At { rail: false, ..whole })?
        }
        _ => planner.place(shape, whole)?,
    };
    planner.layout.bottom = placed.bottom;
    Some(planner.layout)
}

struct Planner<'a> {
    symbols: &'a [Symbol],
    layout: Layout,
}

impl Planner<'_> {
    fn place(&mut self, shape: &Shape, at: At) -> Option<Placed> {
        match shape {
            Shape::Wire => {
                self.start(at);
                if at.tail {
                    self.layout.to_rail.push((at.line, at.column));
                }
                Some(Placed { end: at.column, bottom: at.line })
            }
            Shape::Element(element) => self.element(element.0, at),
            Shape::Block(block) => {
                let (index, placed) = self.block(block, at)?;
                let bottom = placed.bottom.max(self.finish_block(block, index, at.line)?);
                Some(Placed { bottom, ..placed })
            }
            Shape::Series(parts) => self.series(parts, at),
            Shape::Parallel(branches) => self.parallel(branches, at),
        }
    }

    fn start(&mut self, at: At) {
        if at.column == 0 && at.rail {
            self.layout.from_rail.push(at.line);
        }
    }

    fn element(&mut self, element: u32, at: At) -> Option<Placed> {
        let symbol = self.symbols.get(element as usize)?;
        if symbol.figure.is_some() {
            let block =
                BlockShape { element: super::ElementId(element), inputs: Vec::new(), outputs: Vec::new() };
            return self.block(&block, at).map(|(_, placed)| placed);
        }
        let place = Place { element, column: at.column, line: at.line };
        match symbol.setting {
            // Power comes to such an element from its name alone: it must be the first of a line of its own.
            Setting::Source if at.column > 0 || !at.rail => return None,
            Setting::Source => {}
            Setting::Sink if !at.tail => return None,
            _ => self.start(at),
        }
        let ends = matches!(symbol.setting, Setting::Coil | Setting::Sink | Setting::Boxed { output: true });
        if at.tail && ends {
            self.layout.ends.push(place);
            return Some(Placed { end: at.column, bottom: at.line });
        }
        self.layout.leaves.push(place);
        self.after(at.column + 1, at);
        Some(Placed { end: at.column + 1, bottom: at.line })
    }

    /// Notes that columns are used up to slot `end`, and leads the line on to the rail if it ends there.
    fn after(&mut self, end: usize, at: At) {
        self.layout.columns = self.layout.columns.max(end);
        if at.tail {
            self.layout.to_rail.push((at.line, end));
        }
    }

    fn series(&mut self, parts: &[Shape], at: At) -> Option<Placed> {
        let mut placed = Placed { end: at.column, bottom: at.line };
        let mut blocks: Vec<(&BlockShape, usize, i32)> = Vec::new();
        for (number, part) in parts.iter().enumerate() {
            let tail = at.tail && number + 1 == parts.len();
            let floor = if number == 0 { at.floor } else { at.floor.max(placed.bottom) };
            let part_at = At { column: placed.end, tail, floor, ..at };
            let part_placed = match part {
                Shape::Block(block) => self.block(block, part_at)?,
                _ => (usize::MAX, self.place(part, part_at)?),
            };
            let (index, part_placed) = part_placed;
            blocks.iter_mut().for_each(|(.., below)| *below = part_placed.bottom.max(*below));
            if let Shape::Block(block) = part {
                blocks.push((block, index, at.line));
            }
            placed = Placed { end: part_placed.end, bottom: placed.bottom.max(part_placed.bottom) };
        }
        // Further outputs of a block run to the rail below everything that follows on its main line.
        for (block, index, below) in blocks.into_iter().rev() {
            placed.bottom = placed.bottom.max(self.finish_block(block, index, below)?);
        }
        Some(placed)
    }

    fn parallel(&mut self, branches: &[Shape], at: At) -> Option<Placed> {
        let mut lines = Vec::with_capacity(branches.len());
        let mut ends = Vec::with_capacity(branches.len());
        let mut bottom = at.line;
        for (number, branch) in branches.iter().enumerate() {
            let line = if number == 0 { at.line } else { bottom + self.ascent(branch) + 1 };
            let placed = self.place(branch, At { line, ..at })?;
            bottom = placed.bottom.max(line);
            lines.push(line);
            ends.push(placed.end);
        }
        let last = lines.last().copied().unwrap_or(at.line);
        if at.column > 0 || !at.rail {
            self.layout.verticals.push((at.column, at.line, last));
        }
        let mut end = ends.iter().copied().max().unwrap_or(at.column);
        if !at.tail {
            // Wires alone need a column between their two vertical wires.
            end = end.max(at.column + 1);
            self.layout.columns = self.layout.columns.max(end);
            self.layout.verticals.push((end, at.line, last));
            for (line, from) in lines.iter().zip(&ends).filter(|(_, from)| **from < end) {
                self.layout.wires.push((*line, *from, end));
            }
        }
        Some(Placed { end, bottom })
    }

    /// Lines that a part needs above its main line.
    fn ascent(&self, shape: &Shape) -> i32 {
        match shape {
            Shape::Wire => 1,
            Shape::Element(element) => self.symbol_ascent(element.0),
            Shape::Block(block) => self.symbol_ascent(block.element.0),
            Shape::Series(parts) => parts.iter().map(|part| self.ascent(part)).max().unwrap_or(1),
            Shape::Parallel(branches) => branches.first().map_or(1, |branch| self.ascent(branch)),
        }
    }

    fn symbol_ascent(&self, element: u32) -> i32 {
        let Some(symbol) = self.symbols.get(element as usize) else { return 1 };
        let names = symbol.above.len() as i32;
        match &symbol.figure {
            // Two frames with a corner in the same column would be read as wiring.
            Some(figure) => names.max(1) + 2 + pins_above(figure),
            // One line at least, in which vertical wires are seen to run.
            None => names.max(1),
        }
    }

    /// Places a block's box and its further inputs; further outputs follow in [`Planner::finish_block`].
    fn block(&mut self, block: &BlockShape, at: At) -> Option<(usize, Placed)> {
        let figure = self.symbols.get(block.element.0 as usize)?.figure.as_ref()?;
        let main_input = Figure::main_pin(&figure.inputs);
        let main_output = Figure::main_pin(&figure.outputs);
        if main_output.is_none() && !at.tail || main_input.is_none() && (at.column > 0 || !at.rail) {
            return None;
        }
        let top = at.line - pins_above(figure);
        let mut column = at.column;
        let mut floor = at.floor.max(at.line);
        let mut sides = Vec::new();
        let mut inputs = pin_lines(main_input, at.line);
        for pin in inputs.len()..figure.inputs.len() {
            let side = block.inputs.iter().find(|(number, _)| *number as usize == pin);
            let line = match side {
                None => inputs.last().map_or(top, |line| line + 1),
                Some((_, shape)) => {
                    let line = floor.max(inputs.last().copied().unwrap_or(top)) + 1 + self.ascent(shape);
                    let side_at = At { column: 0, line, tail: false, rail: true, floor };
                    let placed = self.place(shape, side_at)?;
                    floor = placed.bottom;
                    column = column.max(placed.end);
                    sides.push((line, placed.end));
                    line
                }
            };
            inputs.push(line);
        }
        let wires = sides.into_iter().chain(main_input.map(|_| (at.line, at.column)));
        let wires: Vec<_> = wires.filter(|(_, from)| *from < column).collect();
        for (line, from) in wires {
            self.layout.wires.push((line, from, column));
        }
        if main_input.is_some() {
            self.start(at);
        }
        let mut outputs = pin_lines(main_output, at.line);
        while outputs.len() < figure.outputs.len() {
            outputs.push(outputs.last().map_or(top, |line| line + 1));
        }
        let last = inputs.iter().chain(&outputs).copied().max().unwrap_or(at.line).max(at.line);
        let place = Place { element: block.element.0, column, line: at.line };
        self.layout.blocks.push(BlockPlace { place, borders: (top - 2, last + 1), inputs, outputs });
        let end = column + 1;
        self.layout.columns = self.layout.columns.max(end);
        if main_output.is_some() {
            self.after(end, at);
        }
        Some((self.layout.blocks.len() - 1, Placed { end, bottom: floor.max(last + 1) }))
    }

    /// Places the lines from a block's further outputs to the right rail, below the lines that are taken at its
    /// right. Returns the last line.
    fn finish_block(&mut self, block: &BlockShape, index: usize, below: i32) -> Option<i32> {
        if block.outputs.is_empty() {
            return Some(below);
        }
        let BlockPlace { place, borders, mut outputs, .. } = self.layout.blocks.get(index)?.clone();
        let mut floor = below;
        let first = block.outputs.iter().map(|(pin, _)| *pin as usize).min().unwrap_or(0);
        for pin in first..outputs.len() {
            let side = block.outputs.iter().find(|(number, _)| *number as usize == pin);
            let above = if pin == 0 { place.line } else { outputs[pin - 1] };
            outputs[pin] = match side {
                None => above + 1,
                Some((_, shape)) => {
                    let line = floor.max(above) + 1 + self.ascent(shape);
                    let at = At { column: place.column + 1, line, tail: true, rail: false, floor };
                    floor = self.place(shape, at)?.bottom;
                    line
                }
            };
        }
        let last = outputs.iter().copied().max().unwrap_or(place.line);
        let bottom = borders.1.max(last + 1);
        if let Some(placed) = self.layout.blocks.get_mut(index) {
            placed.borders.1 = bottom;
            placed.outputs = outputs;
        }
        Some(floor.max(bottom))
    }
}

/// Pins drawn above the power line, so that the main input and the main output face each other on it.
fn pins_above(figure: &Figure) -> i32 {
    let main = |pins| Figure::main_pin(pins).unwrap_or(0);
    main(&figure.inputs).max(main(&figure.outputs)) as i32
}

/// The lines of the pins of one side down to its main pin, which is on the power line; none if it has no main pin.
fn pin_lines(main: Option<usize>, line: i32) -> Vec<i32> {
    let Some(main) = main else { return Vec::new() };
    (0..=main as i32).map(|pin| line - main as i32 + pin).collect()
}
