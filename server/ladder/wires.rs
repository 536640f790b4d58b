//! Tokens to links: which wire leads from where to where.

use super::grid::Grid;
use super::ragged::{ASIDE, TWO_READINGS};
use super::scan::{Token, Tokens, What};
use super::uprights::{Cell, Role, Upright, Uprights};
use super::{ElementKind, PinWire};
use crate::text::{Diagnostic, Message, Span, Spanned};
use rustc_hash::FxHashSet;

/// An end of a wire.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Node {
    LeftRail,
    RightRail,
    /// A vertical wire by its number.
    Upright(usize),
    /// A symbol by its number, and the pin of a function block, else 0.
    Symbol(usize, u16),
    /// A loose end by its number.
    Loose(usize),
}

/// A wire.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub(super) row: usize,
    pub(super) tail: Node,
    pub(super) head: Node,
    /// Range in [`Wiring::cells`].
    pub(super) cells: (usize, usize),
}

/// Where a wire ends without meeting anything.
#[derive(Clone, Copy, Debug)]
pub(super) struct LooseEnd {
    /// Its cell.
    pub(super) span: Span,
    /// The column, for ends on the left.
    pub(super) column: usize,
}

/// All wires of a drawing, row by row.
#[derive(Debug, Default)]
pub(super) struct Wiring {
    pub(super) links: Vec<Link>,
    pub(super) loose: Vec<LooseEnd>,
    pub(super) cells: Vec<Span>,
    /// The right rail's column and cell in each wire row that has one, with the row.
    pub(super) right_rail: Vec<(usize, Spanned<u32>)>,
}

/// Follows the wires of all rows.
pub(super) struct Tracer<'a> {
    grid: &'a Grid,
    tokens: &'a Tokens,
    uprights: &'a Uprights,
    wiring: Wiring,
    row: usize,
    /// One past the column of the last token.
    end: usize,
    /// Where the wire that is being followed comes from.
    tail: Option<Node>,
    /// Its cells: they are the last ones of `wiring.cells`, from here on.
    start: usize,
    problems: &'a mut Vec<Diagnostic>,
    /// Elements that have been reported to stand on a vertical wire.
    reported: FxHashSet<Span>,
    /// Ends of vertical wires that can be read in two ways.
    in_doubt: FxHashSet<Span>,
    /// The column of the left rail, if there is one.
    left_rail: Option<usize>,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(
        grid: &'a Grid,
        tokens: &'a Tokens,
        uprights: &'a Uprights,
        problems: &'a mut Vec<Diagnostic>,
    ) -> Tracer<'a> {
        let wiring = Wiring::default();
        let on_vertical = problems.iter().filter(|problem| problem.code == "contact-on-vertical");
        let reported = on_vertical.map(|problem| problem.span).collect();
        let two = problems.iter().filter(|problem| problem.message.key() == TWO_READINGS);
        let in_doubt = two.map(|problem| problem.span).collect();
        let rails = || uprights.all.iter().filter(|upright| upright.role == Role::LeftRail);
        let column = |cell: &Cell| tokens.rows[cell.row][cell.token].start;
        let wired = rails().flat_map(|rail| &rail.cells).filter(|cell| cell.right).map(column).min();
        let left_rail = wired.or_else(|| rails().flat_map(|rail| &rail.cells).map(column).min());
        Tracer {
            grid,
            tokens,
            uprights,
            wiring,
            row: 0,
            end: 0,
            tail: None,
            start: 0,
            problems,
            reported,
            in_doubt,
            left_rail,
        }
    }

    /// The wires of all rows.
    pub(super) fn trace(mut self) -> Wiring {
        for row in 0..self.tokens.rows.len() {
            self.row = row;
            self.end = 0;
            for number in 0..self.tokens.rows[row].len() {
                let token = self.tokens.rows[row][number];
                if token.start != self.end {
                    self.finish();
                }
                match token.what {
                    What::Wire => self.wire(token),
                    What::Symbol(symbol) => self.symbol(token, symbol),
                    What::Upright(_) => self.upright(token, number),
                    What::Word | What::Unreadable => self.finish(),
                }
                self.end = token.end;
            }
            self.finish();
        }
        self.wiring
    }

    fn wire(&mut self, token: Token) {
        if self.tail.is_none() {
            let end = self.left_end(token);
            self.follow(end);
        }
        self.add_cells(token);
    }

    /// Adds the token's cells to the wire, in one span with what touches it.
    fn add_cells(&mut self, token: Token) {
        let span = self.grid.span(self.row, token.start, token.end);
        let wire = self.wiring.cells.get_mut(self.start..).and_then(|cells| cells.last_mut());
        match wire.filter(|last| last.end == span.start) {
            Some(last) => last.end = span.end,
            None => self.wiring.cells.push(span),
        }
    }

    fn symbol(&mut self, token: Token, symbol: usize) {
        let element = &self.tokens.symbols[symbol].element;
        let Some(block) = element.block() else {
            if self.tail.is_none() {
                // A connector brings its own power; it stands at the left rail as every start of a path.
                let starts = matches!(element.kind, ElementKind::ConnectorIn(_));
                let end = if starts { Node::LeftRail } else { self.left_end(token) };
                self.follow(end);
            }
            self.link(Node::Symbol(symbol, 0));
            self.follow(Node::Symbol(symbol, 0));
            return;
        };
        let line = self.grid.line(self.row);
        let pin = |pins: &[super::Pin]| {
            pins.iter().position(|pin| pin.row == line && pin.wire == PinWire::Power).map(|pin| pin as u16)
        };
        let (input, output) = (pin(&block.inputs), pin(&block.outputs));
        match (self.tail, input) {
            (Some(_), Some(input)) => self.link(Node::Symbol(symbol, input)),
            _ => self.finish(),
        }
        self.tail = None;
        if let Some(output) = output {
            self.follow(Node::Symbol(symbol, output));
        }
    }

    fn upright(&mut self, token: Token, number: usize) {
        let Some((id, upright, cell)) = self.uprights.of(self.row, number) else { return };
        if cell.crossed {
            return;
        }
        match upright.role {
            Role::Wire => self.wire(token),
            Role::LeftRail => {
                self.finish();
                self.follow(Node::LeftRail);
            }
            Role::RightRail => {
                if self.tail.is_some() && cell.left {
                    self.link(Node::RightRail);
                    let span = self.grid.span(self.row, token.start, token.end);
                    self.wiring.right_rail.push((self.row, Spanned::new(token.start as u32, span)));
                }
                self.finish();
            }
            Role::Stray | Role::Separator => self.finish(),
            Role::Loose => {
                let end = self.loose(token.start);
                if cell.left {
                    self.link(end);
                } else {
                    self.finish();
                    self.follow(end);
                }
            }
            Role::Junction => {
                if cell.left {
                    self.link(Node::Upright(id));
                } else {
                    self.finish();
                }
                if !cell.left && !cell.right {
                    self.open_end(id, upright, cell, token);
                } else if cell.right {
                    self.follow(Node::Upright(id));
                }
            }
        }
    }

    /// An end of a vertical wire that no wire reaches is a loose end.
    fn open_end(&mut self, id: usize, upright: &Upright, cell: &Cell, token: Token) {
        let top = cell.row == upright.cells[0].row;
        if !top && cell.row != upright.cells[upright.cells.len() - 1].row {
            return;
        }
        let end = self.loose(token.start);
        self.follow(Node::Upright(id));
        self.link(end);
        let beyond = if top { cell.row.checked_sub(1) } else { Some(cell.row + 1) };
        let over = beyond.and_then(|row| self.tokens.over(row, token.start..token.end));
        if let Some(What::Symbol(symbol)) = over.map(|(_, over)| over.what) {
            self.report_on_vertical(symbol, self.grid.span(cell.row, token.start, token.end));
        }
    }

    fn report_on_vertical(&mut self, symbol: usize, wire: Span) {
        let element = &self.tokens.symbols[symbol].element;
        if element.block().is_some() || self.in_doubt.contains(&wire) || !self.reported.insert(element.span) {
            return;
        }
        let message = Message::new("contact-on-vertical.element");
        let problem = Diagnostic::new("contact-on-vertical", element.span, message);
        self.problems.push(problem.related(wire, Message::new("contact-on-vertical.wire")));
    }

    /// Where a wire or an element comes from that nothing leads to: the left rail, if that was only left out in this
    /// row, else nothing.
    fn left_end(&mut self, token: Token) -> Node {
        let first = self.tokens.extent(self.row).drawn.is_some_and(|(first, _)| first == token.start);
        match self.left_rail {
            Some(rail) if first && token.start <= rail + ASIDE => {
                let span = self.grid.span(self.row, token.start, token.start + 1);
                let message = Message::new("ragged-drawing.no-rail");
                self.problems.push(Diagnostic::new("ragged-drawing", span, message));
                Node::LeftRail
            }
            _ => self.loose(token.start),
        }
    }

    /// A loose end in a cell of this row.
    fn loose(&mut self, column: usize) -> Node {
        let span = self.grid.span(self.row, column, column + 1);
        self.wiring.loose.push(LooseEnd { span, column });
        Node::Loose(self.wiring.loose.len() - 1)
    }

    fn follow(&mut self, tail: Node) {
        self.tail = Some(tail);
        self.start = self.wiring.cells.len();
    }

    /// Ends the wire at `head`.
    fn link(&mut self, head: Node) {
        if let Some(tail) = self.tail.take() {
            let cells = (self.start, self.wiring.cells.len());
            self.wiring.links.push(Link { row: self.row, tail, head, cells });
        }
        self.start = self.wiring.cells.len();
    }

    /// Ends the wire where nothing is. After an output it reaches the right rail all the same.
    fn finish(&mut self) {
        let Some(tail) = self.tail else { return };
        let wired = self.wiring.cells.len() > self.start;
        let head = match tail {
            Node::Symbol(symbol, _) => {
                let symbol = &self.tokens.symbols[symbol];
                match (symbol.element.is_output(), symbol.element.block().is_some()) {
                    (true, _) => Some(Node::RightRail),
                    (_, true) if !wired => None,
                    _ => Some(self.loose_here()),
                }
            }
            _ if wired => Some(self.loose_here()),
            _ => None,
        };
        match head {
            Some(head) => self.link(head),
            None => self.tail = None,
        }
    }

    /// A loose end in the last cell that was followed.
    fn loose_here(&mut self) -> Node {
        let span = self.grid.span(self.row, self.end.saturating_sub(1), self.end);
        self.wiring.loose.push(LooseEnd { span, column: usize::MAX });
        Node::Loose(self.wiring.loose.len() - 1)
    }
}
