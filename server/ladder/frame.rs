//! Frames: lines drawn around a whole figure, which are no rails and carry no power.
//!
//! A frame of box drawing is recognised by a line of its own, `┌───┐` or `└───┘`; its dividers `├───┤` and captions go
//! with it. Networks inside one frame are read one by one, so a chunk may have only a piece of the frame. A frame of
//! ASCII characters must be whole, since `+---+` alone is a rung without an element. Where wires reach the
//! sides, these are rails with a cap.

use super::glyph::Arms;
use super::grid::Grid;

/// A row that is one line from end to end.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Border {
    row: usize,
    left: usize,
    right: usize,
    /// `┌───┐` or `└───┘`; a divider or an ASCII line otherwise.
    corners: bool,
    box_drawing: bool,
}

/// Blanks out the frame around the figure, if there is one. Returns the rows in which only a caption is left.
pub(super) fn take_frame(grid: &mut Grid) -> Vec<usize> {
    let borders: Vec<Border> = (0..grid.height()).filter_map(|row| border(grid, row)).collect();
    let Some(first) = borders.iter().find(|border| border.corners).or(borders.first()).copied() else {
        return Vec::new();
    };
    let (left, right) = (first.left, first.right);
    let own: Vec<Border> =
        borders.into_iter().filter(|border| (border.left, border.right) == (left, right)).collect();
    let is_border = |row: usize| own.iter().any(|border| border.row == row);
    let inner = || (0..grid.height()).filter(|row| !is_border(*row));
    let whole = is_border(0) && is_border(grid.height() - 1) && own.len() > 1;
    let drawn = match first.box_drawing {
        true => own.iter().any(|border| border.corners),
        // The rows between are enclosed, or the lines are rungs of their own.
        false => whole,
    };
    let side = |row: usize, column: usize| grid.arms(row, column).is_upright();
    let closed = inner().all(|row| {
        let blank = grid.content(row).is_none();
        let last = grid.width(row).checked_sub(1);
        let beyond = (right + 1..grid.width(row)).any(|column| grid.at(row, column) != ' ');
        blank || (side(row, left) && side(row, right) && !beyond && last >= Some(right))
    });
    if !drawn || !closed {
        return Vec::new();
    }
    let wire = |row: usize, column: usize| grid.arms(row, column).is_horizontal();
    let is_frame = inner().all(|row| {
        !wire(row, left + 1)
            && !wire(row, right - 1)
            && grid.arms(row, left).is_vertical()
            && grid.arms(row, right).is_vertical()
    });
    if !is_frame && !first.box_drawing {
        return Vec::new();
    }
    let inner: Vec<usize> = inner().collect();
    for border in &own {
        grid.clear(border.row, left..right + 1);
    }
    if is_frame {
        for row in &inner {
            grid.clear(*row, left..left + 1);
            grid.clear(*row, right..right + 1);
        }
    }
    let is_caption = |row: &usize| {
        let inside = (left + 1..right).map(|column| grid.at(*row, column));
        let mut letters = inside.filter(|c| *c != ' ').peekable();
        letters.peek().is_some() && letters.all(|c| !Arms::of(c).is_upright() && !matches!(c, '[' | ']'))
    };
    let alone = |row: usize| {
        let beside = [row.checked_sub(1), Some(row + 1)];
        beside.into_iter().flatten().all(|row| is_border(row) || grid.content(row).is_none())
    };
    inner.iter().copied().filter(|row| is_caption(row) && alone(*row)).collect()
}

/// The line that fills a row from its first to its last character.
fn border(grid: &Grid, row: usize) -> Option<Border> {
    let drawn = |column: &usize| grid.at(row, *column) != ' ';
    let left = (0..grid.width(row)).find(drawn)?;
    let right = (left..grid.width(row)).rev().find(drawn)?;
    let (first, last) = (grid.arms(row, left), grid.arms(row, right));
    // `┌` and `└` have one arm of two upwards and downwards, `├` and `+` have both.
    let corner = |arms: Arms| arms.is_junction() && arms.up() != arms.down();
    let line = (left + 1..right).all(|column| grid.arms(row, column).is_horizontal());
    if right < left + 4 || !line || !first.is_junction() || !last.is_junction() {
        return None;
    }
    let box_drawing = grid.at(row, left) != '+' && grid.at(row, left) != '*';
    Some(Border { row, left, right, corners: corner(first) && corner(last), box_drawing })
}
