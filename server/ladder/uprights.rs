//! Vertical wires: which bars and junctions belong together, and what each of them is.

use super::Choice;
use super::glyph::Arms;
use super::grid::Grid;
use super::ragged::{Mender, is_left_rail, report_left_rail};
use super::scan::{Token, Tokens, What};
use crate::text::{Diagnostic, Message};

/// A bar or junction in its row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) row: usize,
    /// Its number among the row's tokens.
    pub(super) token: usize,
    /// Joined to what touches it on the left.
    pub(super) left: bool,
    /// Joined to what touches it on the right.
    pub(super) right: bool,
    /// A wire passes through without connection.
    pub(super) crossed: bool,
}

/// A maximal vertical wire.
#[derive(Debug)]
pub(super) struct Upright {
    /// Top to bottom, one in each row.
    pub(super) cells: Vec<Cell>,
    pub(super) role: Role,
}

/// What a vertical wire is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Role {
    LeftRail,
    RightRail,
    /// It joins wires.
    Junction,
    /// A `+` between two wires and nothing else: wire.
    Wire,
    /// A corner that only one wire reaches.
    Loose,
    /// It joins nothing.
    Stray,
    /// A line between the parts of a figure, such as conditions and outputs: every wire passes through.
    Separator,
}

/// The vertical wires of a drawing.
#[derive(Debug, Default)]
pub(super) struct Uprights {
    pub(super) all: Vec<Upright>,
    /// For each token of each row, the upright and the cell in it; unused for other tokens.
    of_token: Vec<Vec<(u32, u32)>>,
}

impl Uprights {
    /// The upright of a token, and its cell there.
    pub(super) fn of(&self, row: usize, token: usize) -> Option<(usize, &Upright, &Cell)> {
        let (upright, cell) = *self.of_token.get(row)?.get(token)?;
        let found = self.all.get(upright as usize)?;
        Some((upright as usize, found, found.cells.get(cell as usize)?))
    }

    /// Finds the vertical wires of `tokens`. `left` is the leftmost column in which a line is drawn.
    pub(super) fn find(
        grid: &Grid,
        tokens: &Tokens,
        left: usize,
        choice: Option<Choice>,
        problems: &mut Vec<Diagnostic>,
    ) -> Uprights {
        let mut found = Uprights::linked(tokens);
        Mender::new(&mut found, (grid, tokens), left, choice, problems).mend();
        let right =
            tokens.rows.iter().flatten().filter(|token| token.is_drawn()).map(|t| t.end).max().unwrap_or(0);
        for upright in found.all.iter_mut().filter(|upright| !upright.cells.is_empty()) {
            join(upright, tokens);
            if is_separator(upright, tokens) {
                for cell in &mut upright.cells {
                    (cell.crossed, cell.left, cell.right) = (cell.crossed || cell.left, false, false);
                }
                upright.role = Role::Separator;
                continue;
            }
            upright.role = role_of(upright, tokens, left, right);
        }
        found.take_right_rails(grid, tokens, problems);
        report_left_rail(&found, grid, tokens, problems);
        found
    }

    /// Rows of names carry no power, so the one bar behind the names is a piece of the right rail in whatever column
    /// it stands, if the rows of elements beside it have a rail and no corner that could seek the bar.
    fn take_right_rails(&mut self, grid: &Grid, tokens: &Tokens, problems: &mut Vec<Diagnostic>) {
        for number in 0..self.all.len() {
            let upright = &self.all[number];
            if upright.role != Role::Stray || upright.cells.is_empty() || !self.ends_names(upright, tokens) {
                continue;
            }
            for cell in &upright.cells {
                let token = tokens.rows[cell.row][cell.token];
                let span = grid.span(cell.row, token.start, token.end);
                let message = Message::new("ragged-drawing.right-rail");
                problems.push(Diagnostic::new("ragged-drawing", span, message));
            }
            self.all[number].role = Role::RightRail;
        }
    }

    /// Whether each cell of a bar ends a row of names, beside rows of elements that end at the right rail.
    fn ends_names(&self, upright: &Upright, tokens: &Tokens) -> bool {
        let has_role = |row: usize, number: usize, role: Role| {
            self.of(row, number).is_some_and(|(_, upright, _)| upright.role == role)
        };
        let ends_row = |cell: &Cell| {
            let line = &tokens.rows[cell.row];
            let is_other = |number: usize| {
                let token = &line[number];
                number != cell.token && token.is_drawn() && !has_role(cell.row, number, Role::LeftRail)
            };
            let named = line.iter().any(|token| token.what == What::Word);
            named && cell.token + 1 == line.len() && !(0..line.len()).any(is_other)
        };
        let is_railed = |row: &usize| {
            let uprights = || {
                let line = tokens.rows[*row].iter().enumerate();
                line.filter(|(_, token)| matches!(token.what, What::Upright(_))).map(|(number, _)| number)
            };
            let joined = |number: usize| self.of(*row, number).is_some_and(|(.., cell)| cell.left);
            uprights().any(|number| has_role(*row, number, Role::RightRail) && joined(number))
                && uprights().all(|number| {
                    [Role::LeftRail, Role::RightRail].iter().any(|role| has_role(*row, number, *role))
                })
        };
        let (first, last) = (upright.cells[0].row, upright.cells[upright.cells.len() - 1].row);
        let beside = [first.checked_sub(1), Some(last + 1)].into_iter().flatten();
        let wired: Vec<usize> = beside.filter(|row| tokens.extent(*row).wires.is_some()).collect();
        !wired.is_empty() && upright.cells.iter().all(ends_row) && wired.iter().all(is_railed)
    }

    /// Joins the upright `lower` to the end of `upper`.
    pub(super) fn append(&mut self, upper: usize, lower: usize) {
        let cells = std::mem::take(&mut self.all[lower].cells);
        for cell in cells {
            self.of_token[cell.row][cell.token] = (upper as u32, self.all[upper].cells.len() as u32);
            self.all[upper].cells.push(cell);
        }
    }

    /// Bars and junctions that touch from row to row.
    fn linked(tokens: &Tokens) -> Uprights {
        let mut found = Uprights::default();
        for (row, line) in tokens.rows.iter().enumerate() {
            found.of_token.push(vec![(u32::MAX, 0); line.len()]);
            let above =
                row.checked_sub(1).and_then(|above| tokens.rows.get(above)).map_or(&[][..], |line| line);
            let mut candidates = above.iter().enumerate().peekable();
            for (number, token) in line.iter().enumerate() {
                let What::Upright(arms) = token.what else { continue };
                while candidates.next_if(|(_, upper)| upper.end <= token.start).is_some() {}
                let upper = candidates.peek().filter(|(_, upper)| {
                    let down = matches!(upper.what, What::Upright(upper) if upper.down());
                    upper.start < token.end && down && arms.up()
                });
                let cell = Cell { row, token: number, left: false, right: false, crossed: false };
                let joined = upper.map(|(upper, _)| found.of_token[row - 1][*upper].0);
                let upright = joined.unwrap_or(found.all.len() as u32);
                if joined.is_none() {
                    found.all.push(Upright { cells: Vec::new(), role: Role::Stray });
                }
                let cells = &mut found.all[upright as usize].cells;
                cells.push(cell);
                found.of_token[row][number] = (upright, cells.len() as u32 - 1);
            }
        }
        found
    }

    /// Reports bars that join nothing.
    pub(super) fn report(&self, grid: &Grid, tokens: &Tokens, problems: &mut Vec<Diagnostic>) {
        for upright in &self.all {
            let bare = |cell: &&Cell| upright.role == Role::Stray || is_bare(upright, cell, tokens);
            for cell in upright.cells.iter().filter(bare) {
                let token = tokens.rows[cell.row][cell.token];
                let span = grid.span(cell.row, token.start, token.end);
                let message = Message::new("unreadable-cell.bar");
                problems.push(Diagnostic::new("unreadable-cell", span, message));
            }
        }
    }
}

/// A single bar with wires on both sides and nothing above or below: no crossing, no contact.
fn is_bare(upright: &Upright, cell: &Cell, tokens: &Tokens) -> bool {
    upright.role == Role::Wire && arms(tokens, cell).is_vertical()
}

fn arms(tokens: &Tokens, cell: &Cell) -> Arms {
    match tokens.rows[cell.row][cell.token].what {
        What::Upright(arms) => arms,
        _ => Arms::of(' '),
    }
}

/// Decides at each cell which wires are joined. Two wires at a bar that goes on above and below only cross it.
fn join(upright: &mut Upright, tokens: &Tokens) {
    let last = upright.cells.len() - 1;
    for number in 0..=last {
        let cell = upright.cells[number];
        let line = &tokens.rows[cell.row];
        let token = line[cell.token];
        let own = arms(tokens, &cell);
        let joins = |other: Option<&Token>| {
            other.is_some_and(|other| match other.what {
                What::Wire | What::Symbol(_) => true,
                What::Upright(arms) => arms.is_junction() || own.is_junction(),
                What::Word | What::Unreadable => false,
            })
        };
        let before = cell.token.checked_sub(1).and_then(|before| line.get(before));
        let left = joins(before.filter(|before| before.end == token.start));
        let right = joins(line.get(cell.token + 1).filter(|after| after.start == token.end));
        let crossed = own.is_vertical() && left && right && number > 0 && number < last;
        let cell = &mut upright.cells[number];
        (cell.left, cell.right, cell.crossed) = (left && !crossed, right && !crossed, crossed);
    }
}

/// Whether a line of bars only crosses wires, and at most one that it could join with nothing but its own loose end.
fn is_separator(upright: &Upright, tokens: &Tokens) -> bool {
    let cells = &upright.cells;
    let bars = cells.len() > 1 && cells.iter().all(|cell| arms(tokens, cell).is_vertical());
    let passed = |cell: &&Cell| cell.crossed || (cell.left && cell.right);
    let bare = |cell: &&Cell| !cell.crossed && !cell.left && !cell.right;
    bars && cells.iter().any(|cell| passed(&cell))
        && cells.iter().any(|cell| bare(&cell))
        && cells.iter().all(|cell| passed(&cell) || bare(&cell))
        && cells.iter().filter(|cell| cell.left).count() <= 1
}

fn role_of(upright: &Upright, tokens: &Tokens, left: usize, right: usize) -> Role {
    let first = &upright.cells[0];
    if tokens.rows[first.row][first.token].start <= left || is_left_rail(upright, tokens, left) {
        return Role::LeftRail;
    }
    let any_left = upright.cells.iter().any(|cell| cell.left);
    let any_right = upright.cells.iter().any(|cell| cell.right);
    let nothing_beyond = || {
        let last = |cell: &Cell| tokens.extent(cell.row).drawn.map(|(_, last)| last);
        upright.cells.iter().all(|cell| last(cell) == Some(tokens.rows[cell.row][cell.token].start))
    };
    let looks_like_rail = |cell: &Cell| {
        let arms = arms(tokens, cell);
        let token = &tokens.rows[cell.row][cell.token];
        cell.left
            && (arms.is_vertical()
                || arms.is_left_tee()
                || token.end == right
                || reached_from_output(tokens, cell.row, cell.token))
    };
    if any_left && !any_right && nothing_beyond() && upright.cells.iter().any(looks_like_rail) {
        return Role::RightRail;
    }
    if !any_left && !any_right {
        return stray_or_rail(upright, tokens, nothing_beyond());
    }
    match upright.cells.len() {
        1 if any_left && any_right => Role::Wire,
        1 => Role::Loose,
        _ => Role::Junction,
    }
}

/// Whether the wire that reaches a token of a row from the left comes from an output.
pub(super) fn reached_from_output(tokens: &Tokens, row: usize, number: usize) -> bool {
    let line = &tokens.rows[row];
    let mut edge = line[number].start;
    for token in line[..number].iter().rev() {
        match token.what {
            _ if token.end != edge => return false,
            What::Wire => edge = token.start,
            What::Symbol(symbol) => {
                return tokens.symbols.get(symbol).is_some_and(|symbol| symbol.element.is_output());
            }
            _ => return false,
        }
    }
    false
}

/// A bar that no wire reaches is a piece of a rail, if everything in the nearest wire rows lies on its other side.
fn stray_or_rail(upright: &Upright, tokens: &Tokens, nothing_beyond: bool) -> Role {
    let (first, last) = (&upright.cells[0], &upright.cells[upright.cells.len() - 1]);
    let column = tokens.rows[first.row][first.token].start;
    // Names stand at most three lines away from their element.
    const NEAR: usize = 4;
    let symbols = |row: usize| tokens.extent(row).symbols;
    let above = (first.row.saturating_sub(NEAR)..first.row).rev().find_map(symbols);
    let below = (last.row + 1..last.row + 1 + NEAR).find_map(symbols);
    let within = upright.cells.iter().filter_map(|cell| symbols(cell.row));
    let (mut all_left, mut all_right) = (true, true);
    for (start, last_start, _) in within.chain(above).chain(below) {
        // A rail beside names may stand over the end of the last element, if that one is wider.
        all_left &= last_start < column;
        all_right &= column < start;
    }
    if nothing_beyond && all_left {
        return Role::RightRail;
    }
    let first_drawn = |cell: &Cell| tokens.extent(cell.row).drawn.map(|(first, _)| first);
    let start = |cell: &Cell| Some(tokens.rows[cell.row][cell.token].start);
    if all_right && upright.cells.iter().all(|cell| first_drawn(cell) == start(cell)) {
        return Role::LeftRail;
    }
    Role::Stray
}
