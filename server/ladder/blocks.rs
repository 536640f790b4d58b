//! Function blocks drawn as boxes of `+`, `-` and `|`.

use super::content::Wants;
use super::glyph::{Arms, continues_word, is_operator, starts_word};
use super::grid::{Grid, JUNCTIONS, WIDE};
use super::scan::Symbol;
use super::{Block, Element, ElementKind, OperandPlace, Pin, PinWire};
use crate::target::{Operand, Target};
use crate::text::{Span, Spanned};

/// Higher boxes are not looked for, which bounds the search.
const MOST_ROWS: usize = 64;

/// One row of a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockRow {
    pub(super) row: usize,
    /// One past the last column.
    pub(super) end: usize,
    /// The first column.
    pub(super) start: usize,
    pub(super) symbol: usize,
}

/// The corners of a box.
#[derive(Clone, Copy, Debug)]
struct Frame {
    top: usize,
    bottom: usize,
    left: usize,
    /// The column of the right border.
    right: usize,
}

/// Finds all boxes, reads them, and marks their cells in the grid as taken, outside operands as blank.
pub(super) fn find_blocks(grid: &mut Grid, text: &str, target: &Target) -> (Vec<Symbol>, Vec<BlockRow>) {
    let mut symbols = Vec::new();
    let mut rows = Vec::new();
    for top in 0..grid.height() {
        let mut column = 0;
        if !grid.may_have(top, JUNCTIONS) {
            continue;
        }
        while let Some(corner) = grid.find(top, column, |character| Arms::of(character).is_junction()) {
            let Some(frame) = frame_at(grid, top, corner) else {
                column = corner + 1;
                continue;
            };
            let number = symbols.len();
            symbols.push(read_block(grid, frame, text, target));
            for row in frame.top..=frame.bottom {
                grid.take(row, frame.left..frame.right + 1);
                rows.push(BlockRow { row, start: frame.left, end: frame.right + 1, symbol: number });
            }
            column = frame.right + 1;
        }
    }
    rows.sort_by_key(|row| (row.row, row.start));
    (symbols, rows)
}

/// The box whose upper left corner is at a cell. No wire leads to its corners, its border has no junction above and
/// below, and inside are words only; anything else with that outline is wiring.
fn frame_at(grid: &Grid, top: usize, left: usize) -> Option<Frame> {
    let upright = |row: usize, column: usize| grid.arms(row, column).is_upright();
    let lined = |row: usize, column: usize| grid.arms(row, column).is_line();
    let corner = |row: usize, column: usize| grid.arms(row, column).is_junction();
    let free_above = |column: usize| top == 0 || !upright(top - 1, column);
    let free_left = |row: usize| left == 0 || !lined(row, left - 1);
    if !corner(top, left) || !grid.arms(top, left).down() || !free_left(top) || !free_above(left) {
        return None;
    }
    let right = border_end(grid, top, left)?;
    if !grid.arms(top, right).down() || lined(top, right + 1) || !free_above(right) {
        return None;
    }
    let mut worded = false;
    for row in top + 1..(top + MOST_ROWS).min(grid.height()) {
        if !upright(row, left) || !upright(row, right) {
            return None;
        }
        if corner(row, left) && border_end(grid, row, left) == Some(right) {
            let free = free_left(row) && !lined(row, right + 1);
            let free = free && !grid.arms(row + 1, left).up() && !grid.arms(row + 1, right).up();
            return (free && worded).then_some(Frame { top, bottom: row, left, right });
        }
        for column in left + 1..right {
            let character = grid.at(row, column);
            let drawn = upright(row, column) || matches!(character, '(' | ')' | '[' | ']');
            if drawn && character != '!'
                || (grid.arms(row, column).is_line() && !matches!(character, '_' | '='))
            {
                return None;
            }
            worded |= starts_word(character) || is_operator(character) || character == '&';
        }
    }
    None
}

/// The junction at the other end of the horizontal border that starts in a cell.
fn border_end(grid: &Grid, row: usize, left: usize) -> Option<usize> {
    let mut right = left + 1;
    while grid.arms(row, right).is_horizontal() {
        right += 1;
    }
    (right > left + 2 && grid.arms(row, right).is_junction()).then_some(right)
}

/// A word inside a box.
#[derive(Clone, Copy)]
struct Inside {
    start: usize,
    end: usize,
}

fn read_block(grid: &mut Grid, frame: Frame, text: &str, target: &Target) -> Symbol {
    let row_span = |row: usize| grid.span(row, frame.left, frame.right + 1);
    let mut block = Block {
        instance: None,
        type_name: None,
        rows: (frame.top..=frame.bottom).map(row_span).collect(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        ldmicro: None,
    };
    let mut operands = Vec::new();
    let mut power_row = None;
    for row in frame.top + 1..frame.bottom {
        let mut words = words_inside(grid, row, frame);
        if block.type_name.is_none() && !words.is_empty() {
            // The type stands in the middle of the first line with words.
            let middle = frame.left + frame.right;
            let distance = |word: &Inside| (word.start + word.end - 1).abs_diff(middle);
            let nearest = (0..words.len()).min_by_key(|word| distance(&words[*word])).unwrap_or(0);
            let word = words.remove(nearest);
            block.type_name = Some(grid.span(row, word.start, word.end));
        }
        if let Some(parameter) = parameter(grid, row, &words, (text, target)) {
            match parameter {
                Parameter::Instance(name) => block.instance = block.instance.or(Some(name)),
                Parameter::Input(name, operand) => {
                    operands.push(operand);
                    let wire = PinWire::Operand(operands.len() - 1);
                    block.inputs.push(Pin {
                        name: Some(name),
                        implied: "",
                        negated: false,
                        row: grid.line(row),
                        wire,
                    });
                }
            }
            words.clear();
        }
        let (input, output) = match words[..] {
            [] => (None, None),
            [word] if word.start - frame.left <= frame.right + 1 - word.end => (Some(word), None),
            [word] => (None, Some(word)),
            [first, .., last] => (Some(first), Some(last)),
        };
        let name = |word: Option<Inside>, grid: &Grid| word.map(|word| grid.span(row, word.start, word.end));
        let (input, output) = (name(input, grid), name(output, grid));
        let input = read_pin(grid, frame, row, (Side::Left, input), &mut operands, (text, target));
        let output = read_pin(grid, frame, row, (Side::Right, output), &mut operands, (text, target));
        if input.as_ref().is_some_and(|pin| pin.wire == PinWire::Power) {
            power_row = power_row.or(Some(row));
        }
        block.inputs.extend(input);
        block.outputs.extend(output);
    }
    let row = power_row.unwrap_or(frame.top + 1);
    let span = grid.span(frame.top, frame.left, frame.right + 1);
    let columns = (frame.left as u32, frame.right as u32 + 1);
    let mut element = Element::new(ElementKind::Block(Box::new(block)), span, grid.line(row), columns);
    element.operands = operands;
    element.place = OperandPlace::Beside;
    Symbol {
        row,
        start: frame.left,
        end: frame.right + 1,
        element,
        wants: Wants::Instance,
        depth: row - frame.top,
    }
}

/// The pin on one side of a row, if there is a name or anything is connected.
fn read_pin(
    grid: &mut Grid,
    frame: Frame,
    row: usize,
    (side, name): (Side, Option<Span>),
    operands: &mut Vec<Spanned<Operand>>,
    (text, target): (&str, &Target),
) -> Option<Pin> {
    let (wire, negated) = outside(grid, frame, row, side, name.is_some(), text);
    let wire = match wire {
        Outside::Wire => PinWire::Power,
        Outside::Nothing => PinWire::Open,
        Outside::Word(span) => {
            operands.push(Spanned::new(target.read(span.of(text)), span));
            PinWire::Operand(operands.len() - 1)
        }
    };
    let present = name.is_some() || wire != PinWire::Open;
    present.then(|| Pin { name, implied: "", negated, row: grid.line(row), wire })
}

/// What a line inside a box says that stands for itself.
enum Parameter {
    /// `Timer T4`
    Instance(Span),
    /// `PT = 500 ms`, `Preset 30`
    Input(Span, Spanned<Operand>),
}

/// The parameter written on a line inside a box.
fn parameter(
    grid: &Grid,
    row: usize,
    words: &[Inside],
    (text, target): (&str, &Target),
) -> Option<Parameter> {
    let (name, rest) = words.split_first()?;
    let assigned = rest.first().is_some_and(|sign| grid.span(row, sign.start, sign.end).of(text) == "=");
    let value = if assigned { &rest[1..] } else { rest };
    let (first, last) = (value.first()?, value.last()?);
    let span = grid.span(row, first.start, last.end);
    let name = grid.span(row, name.start, name.end);
    let is = |word: &str| name.of(text).eq_ignore_ascii_case(word);
    if !assigned && (is("Timer") || is("Counter")) && value.len() == 1 {
        return Some(Parameter::Instance(span));
    }
    if !assigned && !span.of(text).starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    // `500 ms` is a time, though IEC 61131-3 would have it written `T#500ms`.
    let written: String = span.of(text).split_whitespace().collect();
    let plain = target.read(&written);
    let time = || target.read(&format!("T#{written}"));
    let value = if matches!(plain, Operand::Invalid(_)) { time() } else { plain };
    Some(Parameter::Input(name, Spanned::new(value, span)))
}

fn words_inside(grid: &Grid, row: usize, frame: Frame) -> Vec<Inside> {
    let mut words = Vec::new();
    let mut column = frame.left + 1;
    while column < frame.right {
        let character = grid.at(row, column);
        let part: fn(char) -> bool = if starts_word(character) || character == '_' {
            |c| continues_word(c) || c == WIDE
        } else if is_operator(character) || character == '&' {
            |c| is_operator(c) || c == '&' || c.is_ascii_digit()
        } else {
            column += 1;
            continue;
        };
        let end = (column..frame.right).find(|at| !part(grid.at(row, *at))).unwrap_or(frame.right);
        words.push(Inside { start: column, end: end.max(column + 1) });
        column = end.max(column + 1);
    }
    words
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

/// What stands outside beside a pin.
enum Outside {
    Wire,
    Word(Span),
    Nothing,
}

/// What is connected to a side of a row, and whether there is a negation circle. The cells of a circle are taken into
/// the box, those of an operand and of the wire between are blanked.
fn outside(
    grid: &mut Grid,
    frame: Frame,
    row: usize,
    side: Side,
    named: bool,
    text: &str,
) -> (Outside, bool) {
    let edge = if side == Side::Left { frame.left } else { frame.right };
    // The cell at a distance from the edge, 1 for the neighbour; blank past the left border of the drawing.
    let column = |distance: usize| match side {
        Side::Left => edge.checked_sub(distance),
        Side::Right => Some(edge + distance),
    };
    let at = |distance: usize, grid: &Grid| column(distance).map_or(' ', |column| grid.at(row, column));
    let is_wire = |distance: usize, grid: &Grid| Arms::of(at(distance, grid)).is_horizontal();
    let negated = matches!(at(1, grid), 'O' | 'o') && is_wire(2, grid);
    let first = 1 + usize::from(negated);
    let mut distance = first;
    while is_wire(distance, grid) {
        distance += 1;
    }
    // An operand may stand one blank away from the edge of a named pin, or from the end of its wire.
    let wired = distance > first;
    if (wired || named) && at(distance, grid) == ' ' {
        distance += 1;
    }
    let word = word_beside(grid, row, column(distance), side, text);
    let blanks = |grid: &mut Grid, from: usize, to: usize| {
        if let (Some(from), Some(to)) = (column(from), column(to)) {
            grid.clear(row, from.min(to)..from.max(to) + 1);
        }
    };
    if let Some((far, span)) = word {
        blanks(grid, 1, edge.abs_diff(far));
        return (Outside::Word(span), negated);
    }
    if negated {
        // The wire leads up to the box.
        grid.bridge(row, column(1));
    }
    let joined = Arms::of(at(first, grid)).is_line();
    (if wired || joined { Outside::Wire } else { Outside::Nothing }, negated)
}

/// The word that ends (left of a box) or starts (right of it) at `column`: its far column and its bytes. A word that
/// another wire touches on its far side stands on that wire and is no operand.
fn word_beside(
    grid: &Grid,
    row: usize,
    column: Option<usize>,
    side: Side,
    text: &str,
) -> Option<(usize, Span)> {
    let near = column?;
    let part = |column: usize| {
        let character = grid.at(row, column);
        continues_word(character) || character == WIDE || matches!(character, '\'' | '"' | '?')
    };
    let (mut first, mut last) = (near, near);
    if side == Side::Left && grid.at(row, near) == ']' {
        first = subscript(grid, row, near, side).filter(|open| *open > 0 && part(open - 1))?;
    } else if !part(near) {
        return None;
    }
    match side {
        Side::Left => {
            while first > 0 {
                first = match grid.at(row, first - 1) {
                    ']' => match subscript(grid, row, first - 1, side) {
                        Some(open) => open,
                        None => break,
                    },
                    _ if part(first - 1) => first - 1,
                    _ => break,
                };
            }
            // `K-5`, `T#-1s`
            let sign = first > 1
                && matches!(grid.at(row, first - 1), '-' | '+')
                && grid.at(row, first).is_ascii_digit()
                && matches!(grid.at(row, first - 2), 'K' | 'k' | 'E' | 'e' | '#');
            if sign {
                first -= 2;
                while first > 0 && part(first - 1) {
                    first -= 1;
                }
            }
            // ` -5`: a hyphen alone before a number is no wire.
            let alone = first > 0
                && grid.at(row, first - 1) == '-'
                && grid.at(row, first).is_ascii_digit()
                && (first == 1 || grid.at(row, first - 2) == ' ');
            first -= usize::from(alone);
        }
        Side::Right => loop {
            last = match grid.at(row, last + 1) {
                '[' => match subscript(grid, row, last + 1, side) {
                    Some(close) => close,
                    None => break,
                },
                _ if part(last + 1) => last + 1,
                _ => break,
            };
        },
    }
    let beyond = match side {
        Side::Left => first.checked_sub(1).map_or(' ', |column| grid.at(row, column)),
        Side::Right => grid.at(row, last + 1),
    };
    let span = grid.span(row, first, last + 1);
    let far = if side == Side::Left { first } else { last };
    let arms = Arms::of(beyond);
    // The circle of the next box touches that box.
    let circle = arms.is_upright() && first == last && matches!(grid.at(row, first), 'O' | 'o');
    (!circle && !arms.is_horizontal() && !span.of(text).is_empty()).then_some((far, span))
}

/// The other bracket of the subscript of an array whose near bracket stands at `column`: `[1]`, `[n,-2]`.
fn subscript(grid: &Grid, row: usize, column: usize, side: Side) -> Option<usize> {
    let is_inside = |column: usize| {
        let character = grid.at(row, column);
        let is_sign = character == '-' && matches!(grid.at(row, column - 1), '[' | ',');
        continues_word(character) || character == ',' || is_sign
    };
    let (far, bracket) = match side {
        Side::Left => ((1..column).rev().find(|at| !is_inside(*at))?, '['),
        Side::Right => ((column + 1..).find(|at| !is_inside(*at))?, ']'),
    };
    (grid.at(row, far) == bracket && far.abs_diff(column) > 1).then_some(far)
}
