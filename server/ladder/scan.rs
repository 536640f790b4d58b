//! Cells to tokens: wires, bars and junctions, elements, words.

use super::blocks::BlockRow;
use super::content::{Reading, Wants, pieces, read_braces, read_brackets, read_parentheses};
use super::glyph::{Arms, contact_mark, continues_word, is_operator, starts_word};
use super::grid::{Grid, TAKEN, WIDE};
use super::names::without;
use super::ragged::ASIDE;
use super::{Element, ElementKind, OperandPlace};
use crate::target::{DeviceKind, Location, Operand, OperandProblem, Target, Width};
use crate::text::{Diagnostic, Fix, Message, Span, TextEdit};
use std::cell::OnceCell;

/// A piece of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token {
    /// First column.
    pub(super) start: usize,
    /// One past the last column.
    pub(super) end: usize,
    pub(super) what: What,
}

/// What a token is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum What {
    /// A run of horizontal wire.
    Wire,
    /// A bar or a junction, with the directions in which it runs.
    Upright(Arms),
    /// A row of the symbol with this number.
    Symbol(usize),
    /// A word.
    Word,
    /// What could not be read and has been reported.
    Unreadable,
}

/// An element that was found in the drawing.
#[derive(Debug)]
pub(super) struct Symbol {
    /// The row of its power line.
    pub(super) row: usize,
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) element: Element,
    pub(super) wants: Wants,
    /// How many rows of it lie above `row`.
    pub(super) depth: usize,
}

/// The tokens of every row, left to right, and the symbols.
#[derive(Debug, Default)]
pub(super) struct Tokens {
    pub(super) rows: Vec<Vec<Token>>,
    pub(super) symbols: Vec<Symbol>,
    extents: Vec<Extent>,
}

/// How far the drawing reaches in a row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    /// Start of the first and of the last token that is drawn.
    pub(super) drawn: Option<(usize, usize)>,
    /// Start of the first symbol, start and end of the last one.
    pub(super) symbols: Option<(usize, usize, usize)>,
    /// One past the last wire or symbol and what is joined to it.
    pub(super) wires: Option<usize>,
}

impl Tokens {
    /// How far the drawing reaches in `row`.
    pub(super) fn extent(&self, row: usize) -> Extent {
        self.extents.get(row).copied().unwrap_or_default()
    }

    /// The token that covers a column of a row, with its number.
    pub(super) fn over(&self, row: usize, columns: std::ops::Range<usize>) -> Option<(usize, &Token)> {
        let line = self.rows.get(row)?;
        let number = line.partition_point(|token| token.end <= columns.start);
        line.get(number).filter(|token| token.start < columns.end).map(|token| (number, token))
    }
}

impl Token {
    /// Whether it is part of the drawing, not a word in it.
    pub(super) fn is_drawn(&self) -> bool {
        !matches!(self.what, What::Word | What::Unreadable)
    }
}

/// Reads the rows of a grid, in which function blocks have been found already.
pub(super) struct Scanner<'a> {
    pub(super) grid: &'a Grid,
    pub(super) text: &'a str,
    pub(super) target: &'a Target,
    /// The leftmost column in which a line is drawn.
    pub(super) left: usize,
    /// The rightmost column in which a row ends with a bar or a corner, once this is asked for.
    pub(super) right: OnceCell<usize>,
    pub(super) symbols: Vec<Symbol>,
    pub(super) problems: &'a mut Vec<Diagnostic>,
}

impl Scanner<'_> {
    /// The tokens of all rows; `blocks` are the rows of function blocks in reading order.
    pub(super) fn scan(mut self, blocks: &[BlockRow]) -> Tokens {
        let mut rows = Vec::with_capacity(self.grid.height());
        let mut blocks = blocks.iter().peekable();
        for row in 0..self.grid.height() {
            let mut tokens = Vec::with_capacity(self.grid.width(row) / 4 + 1);
            let mut column = 0;
            while let Some(start) = self.grid.find(row, column, |character| character != ' ') {
                let token = match self.grid.at(row, start) {
                    TAKEN => {
                        while blocks.next_if(|block| (block.row, block.end) <= (row, start)).is_some() {}
                        blocks.peek().map(|block| Token {
                            start,
                            end: block.end,
                            what: What::Symbol(block.symbol),
                        })
                    }
                    character => {
                        Some(self.token(row, start, character).unwrap_or_else(|| self.no_token(row, start)))
                    }
                };
                column = token.map_or(start + 1, |token| token.end.max(start + 1));
                tokens.extend(token);
            }
            rows.push(tokens);
        }
        let extents = rows.iter().map(|line| extent(line)).collect();
        Tokens { rows, symbols: self.symbols, extents }
    }

    /// Reports a run of cells that cannot be read. In the middle of a wire the wire goes on behind it, so that one
    /// wrong character is one finding.
    fn no_token(&mut self, row: usize, start: usize) -> Token {
        let starts = |c: char| {
            matches!(c, ' ' | TAKEN | '[' | ']' | '(' | '{' | '<' | '>' | '/' | '\\')
                || Arms::of(c).is_line()
                || c.is_alphanumeric()
        };
        let mut end = start + 1;
        while end < self.grid.width(row) && !starts(self.grid.at(row, end)) {
            end += 1;
        }
        let span = self.grid.span(row, start, end);
        self.unreadable(span, Message::new("unreadable-cell.character").with("text", span.of(self.text)));
        let wire = |column: usize| self.grid.arms(row, column).is_horizontal();
        let bridged = start > 0 && wire(start - 1) && wire(end);
        if let Some(problem) = self.problems.last_mut().filter(|_| bridged) {
            let wire = self.grid.at(row, start - 1).to_string().repeat(end - start);
            let edits = vec![TextEdit::new(span, wire)];
            problem.fixes.push(Fix { title: Message::new("unreadable-cell.wire"), edits });
        }
        Token { start, end, what: if bridged { What::Wire } else { What::Unreadable } }
    }

    fn unreadable(&mut self, span: Span, message: Message) {
        self.problems.push(Diagnostic::new("unreadable-cell", span, message));
    }

    /// The token that starts at a cell which is not blank; nothing if the cell cannot be read.
    fn token(&mut self, row: usize, column: usize, character: char) -> Option<Token> {
        let arms = Arms::of(character);
        if let Some(end) = self.turned_contact_end(row, column) {
            return Some(self.on_vertical(row, column, end));
        }
        if arms.is_upright() {
            return Some(self.contact(row, column).unwrap_or_else(|| self.upright(row, column, arms)));
        }
        if let Some(end) = self.word_end(row, column) {
            return Some(self.word(row, column, end));
        }
        if arms.is_horizontal() {
            return Some(self.wire(row, column));
        }
        match character {
            '[' => self.bracketed(row, column, &[']'], read_brackets),
            ']' => self.bracketed(row, column, &['['], read_brackets),
            '(' => self.bracketed(row, column, &[')'], read_parentheses),
            '{' => self.bracketed(row, column, &['}'], read_braces),
            '<' | '>' => self.arrow(row, column, character),
            '/' | '\\' => self.invert(row, column),
            _ => None,
        }
    }

    /// A word. In the middle of a wire it stands where an element belongs; the wire goes on behind it, so that it is
    /// one finding. Right before the right rail it can only be an output.
    fn word(&mut self, row: usize, start: usize, end: usize) -> Token {
        let wire = |column: usize| self.grid.arms(row, column).is_horizontal();
        let after_wire = start > 0 && wire(start - 1);
        let last = after_wire && self.is_last(row, end);
        if !after_wire || !(wire(end) || last) {
            return Token { start, end, what: What::Word };
        }
        let span = self.grid.span(row, start, end);
        let word = span.of(self.text);
        let coil = last && can_be_driven(&self.target.read(word));
        let (title, open, close) = match coil {
            true => (Message::new("stray-operand.draw-coil"), '(', ')'),
            false => (Message::new("stray-operand.contact"), '[', ']'),
        };
        // Where the wire is long enough, the brackets take a cell of it on each side, else both on the left.
        let to = end + usize::from(wire(end) && wire(end + 1));
        let most = 2 - (to - end);
        let before = (1..=most + 1).take_while(|cells| *cells <= start && wire(start - cells)).count();
        let from = start - before.saturating_sub(1);
        let edit = TextEdit::new(self.grid.span(row, from, to), format!("{open}{word}{close}"));
        let problem =
            Diagnostic::new("stray-operand", span, Message::new("stray-operand.in-wire").with("text", word))
                .fix(title.with("text", word), vec![edit]);
        self.problems.push(problem);
        Token { start, end, what: What::Wire }
    }

    /// Whether nothing but wire stands between a column and the right rail of its row.
    fn is_last(&self, row: usize, column: usize) -> bool {
        let width = self.grid.width(row);
        let end = (column..width).find(|at| !self.grid.arms(row, *at).is_horizontal());
        let Some(end) = end.filter(|end| self.grid.arms(row, *end).is_upright()) else { return false };
        // A rail may be drawn double.
        let mut behind = end + 1..width;
        behind.all(|at| self.grid.at(row, at) == ' ' || self.grid.arms(row, at).is_vertical())
            && end + ASIDE >= *self.right.get_or_init(|| right_column(self.grid))
    }

    /// The end of the word that starts at a cell, if one does.
    fn word_end(&self, row: usize, column: usize) -> Option<usize> {
        let at = |column: usize| self.grid.at(row, column);
        let first = at(column);
        if !(starts_word(first) || matches!(first, '_' | '?')) {
            return None;
        }
        let after_wire = column > 0 && Arms::of(at(column - 1)).is_horizontal();
        // `???` stands where a name is still to be given.
        if first == '?' && at(column + 1) == '?' {
            return (column..=self.grid.width(row)).find(|c| at(*c) != '?');
        }
        let named = first == '_' && !after_wire && at(column + 1).is_alphanumeric();
        let address = first != '%' || at(column + 1).is_alphabetic();
        if !(named || starts_word(first) && address) {
            return None;
        }
        if matches!(first, '\'' | '"') {
            let close = (column + 1..self.grid.width(row)).find(|c| at(*c) == first)?;
            return Some(close + 1);
        }
        let mut end = column + 1;
        loop {
            let character = at(end);
            // `K-5`, `T#-1s`, `E1.5+3`: a sign belongs to a number that goes on behind it.
            let signs = matches!(character, '-' | '+') && at(end + 1).is_ascii_digit() && {
                let before = at(end - 1);
                before == '#'
                    || (end == column + 1 && matches!(first, 'K' | 'k' | 'E' | 'e'))
                    || (matches!(first, 'E' | 'e') && before.is_ascii_digit())
            };
            // A single hyphen inside a word is no wire, whatever becomes of the word.
            let hyphen = character == '-' && at(end - 1).is_alphanumeric() && at(end + 1).is_alphabetic();
            let signs = signs || hyphen;
            // A name does not end in a run of underscores that is a wire.
            let wire = character == '_' && !continues_word(at(end + 1)) && at(end + 1) != ' ';
            let wire = wire || (character == '_' && at(end + 1) == '_');
            if (continues_word(character) && !wire) || character == WIDE || signs {
                end += 1;
            } else if character == '[' {
                match self.subscript_end(row, end) {
                    Some(close) => end = close,
                    None => return Some(end),
                }
            } else {
                return Some(end);
            }
        }
    }

    /// One past the `]` of a subscript such as `[3,i]`, which holds no blank.
    fn subscript_end(&self, row: usize, open: usize) -> Option<usize> {
        let inside = |c: char| continues_word(c) || c == ',';
        let close = (open + 1..self.grid.width(row)).find(|c| !inside(self.grid.at(row, *c)))?;
        (close > open + 1 && self.grid.at(row, close) == ']').then_some(close + 1)
    }

    /// A run of wire. An end of it that has a bar directly above or below is the corner with that bar.
    fn wire(&self, row: usize, column: usize) -> Token {
        let horizontal = |column: usize| self.grid.arms(row, column).is_horizontal();
        let corner = |column: usize| {
            let bar = |row: usize| self.grid.arms(row, column).is_vertical() && !self.in_contact(row, column);
            (row > 0 && bar(row - 1)) || bar(row + 1)
        };
        let junction =
            |column: usize| Token { start: column, end: column + 1, what: What::Upright(Arms::of('+')) };
        let open = |column: usize| matches!(self.grid.at(row, column), ' ');
        if (column == 0 || open(column - 1)) && corner(column) {
            return junction(column);
        }
        // Of all that draws wire only an underscore can begin a name.
        let ends = |character| !Arms::of(character).is_horizontal() || character == '_';
        let mut end = column + 1;
        loop {
            end = self.grid.find(row, end, ends).unwrap_or(self.grid.width(row));
            if !horizontal(end) || self.word_end(row, end).is_some() {
                break;
            }
            end += 1;
        }
        if open(end) && end - column > 1 && corner(end - 1) {
            end -= 1;
        } else if open(end) && corner(end - 1) {
            return junction(column);
        }
        Token { start: column, end, what: What::Wire }
    }

    fn upright(&self, row: usize, column: usize, arms: Arms) -> Token {
        // `||` is one bar: a rail drawn double.
        let double = arms.is_vertical() && self.grid.arms(row, column + 1).is_vertical();
        Token { start: column, end: column + 1 + usize::from(double), what: What::Upright(arms) }
    }

    /// A contact drawn with bars, if the bar at `column` opens one.
    fn contact(&mut self, row: usize, column: usize) -> Option<Token> {
        let end = self.contact_end(row, column)?;
        let linked = [column, end - 1].map(|bar| self.linked(row, bar));
        let outer = [column > 0 && self.leads(row, column - 1), self.leads(row, end)];
        let blank = self.grid.at(row, column + 1) == ' ' || end == column + 2;
        let (some_linked, all_linked) = (linked[0] || linked[1], linked[0] && linked[1]);
        if column == self.left || (blank && all_linked) || (some_linked && outer != [true, true]) {
            return None;
        }
        let inside = pieces(self.grid, row, column + 1, end - 1, self.text);
        let reading = read_brackets(&inside, self.target);
        let token = self.symbol(row, column, end, reading);
        if some_linked {
            let span = self.grid.span(row, column, end);
            let message = Message::new("contact-on-vertical.bar").with("element", span.of(self.text));
            let mut problem = Diagnostic::new("contact-on-vertical", span, message);
            let bar = if linked[0] { column } else { end - 1 };
            for near in [row.checked_sub(1), Some(row + 1)].into_iter().flatten() {
                if self.grid.arms(near, bar).is_upright() {
                    let wire = self.grid.span(near, bar, bar + 1);
                    problem = problem.related(wire, Message::new("contact-on-vertical.wire"));
                }
            }
            self.problems.push(problem);
        }
        Some(token)
    }

    /// One past the closing bar of `| |`, `|/|`, `┤P├` or `|>= INT|`, by the shape alone.
    fn contact_end(&self, row: usize, column: usize) -> Option<usize> {
        let (left, right) = (self.grid.arms(row, column), |at: usize| self.grid.arms(row, at));
        let opens = left.is_vertical() || (left.is_left_tee() && !self.linked_raw(row, column));
        let closes = |at: usize| right(at).is_vertical() || right(at).is_right_tee();
        if !opens {
            return None;
        }
        let mark = self.grid.at(row, column + 1);
        let wire = |column: usize| self.grid.arms(row, column).is_horizontal();
        // `--||--`: two bars in the middle of a wire that belong to nothing above and below.
        let touching = column > 0 && closes(column + 1) && wire(column - 1) && wire(column + 2);
        if touching && !self.linked_raw(row, column) && !self.linked_raw(row, column + 1) {
            return Some(column + 2);
        }
        let end = if contact_mark(mark).is_some() && closes(column + 2) {
            column + 3
        } else if is_operator(mark) {
            const LONGEST: usize = 12;
            let close = (column + 2..column + LONGEST).find(|at| closes(*at))?;
            close + 1
        } else {
            return None;
        };
        let outer = (column > 0 && self.leads(row, column - 1)) || self.leads(row, end);
        outer.then_some(end)
    }

    /// Whether the cell is a bar of a contact with wires on both sides.
    fn in_contact(&self, row: usize, column: usize) -> bool {
        [Some(column), column.checked_sub(2)].into_iter().flatten().any(|start| {
            start > 0
                && self.leads(row, start - 1)
                && self
                    .contact_end(row, start)
                    .is_some_and(|end| (column == start || column + 1 == end) && self.leads(row, end))
        })
    }

    /// Whether a wire, a junction or another element is at this cell, to which an element can be joined.
    fn leads(&self, row: usize, column: usize) -> bool {
        let arms = self.grid.arms(row, column);
        arms.is_horizontal()
            || arms.is_junction()
            || matches!(self.grid.at(row, column), ')' | '(' | '[' | ']')
    }

    /// Whether a vertical wire goes up or down from this cell.
    fn linked(&self, row: usize, column: usize) -> bool {
        let above = row > 0 && self.grid.arms(row - 1, column).down() && !self.in_contact(row - 1, column);
        let below = || {
            self.grid.arms(row + 1, column).up()
                && !self.in_contact(row + 1, column)
                && !self.tops_rail(row + 1, column)
        };
        above || below()
    }

    /// Whether the bars from a cell down are the right rail of narrower rungs, which only touches what is above it:
    /// their rows end there, and whatever wire reaches it comes from an output.
    fn tops_rail(&self, row: usize, column: usize) -> bool {
        let mut is_reached = false;
        for row in row..self.grid.height() {
            if !self.grid.arms(row, column).up() {
                break;
            }
            let is_last = self.grid.find(row, column + 1, |character| character != ' ').is_none();
            if !is_last || !self.grid.arms(row, self.left).is_upright() {
                return false;
            }
            if column > 0 && self.leads(row, column - 1) {
                if !self.ends_in_output(row, column) {
                    return false;
                }
                is_reached = true;
            }
        }
        is_reached
    }

    /// Whether the last thing in a row before a column, wires aside, is a coil or an instruction with operands.
    fn ends_in_output(&self, row: usize, column: usize) -> bool {
        let drawn = self.grid.span(row, 0, column).of(self.text);
        let drawn = drawn.trim_end_matches(|character| Arms::of(character).is_horizontal());
        match drawn.strip_suffix(']') {
            Some(inside) => {
                let inside = inside.rsplit(['[', ']']).next().unwrap_or("");
                inside.split_whitespace().count() > 1 && !inside.contains(is_operator)
            }
            None => drawn.ends_with(')'),
        }
    }

    fn linked_raw(&self, row: usize, column: usize) -> bool {
        (row > 0 && self.grid.arms(row - 1, column).down()) || self.grid.arms(row + 1, column).up()
    }

    fn bracketed(
        &mut self,
        row: usize,
        column: usize,
        close: &[char],
        read: fn(&[super::content::Piece], &Target) -> Reading,
    ) -> Option<Token> {
        let open = self.grid.at(row, column);
        let mut at = column + 1;
        let close = loop {
            let character = self.grid.at(row, at);
            if at >= self.grid.width(row) || character == TAKEN {
                break None;
            }
            if close.contains(&character) {
                break Some(at);
            }
            if character == '[' && open != ']' && self.subscript_end(row, at).is_some() {
                at = self.subscript_end(row, at)?;
            } else if matches!(character, '[' | ']' | '(' | ')' | '{' | '}')
                || Arms::of(character).is_junction()
            {
                break None;
            } else {
                at += 1;
            }
        };
        let Some(close) = close else {
            let span = self.grid.span(row, column, column + 1);
            self.unreadable(span, Message::new("unreadable-cell.bracket").with("text", span.of(self.text)));
            return Some(Token { start: column, end: self.torn_end(row, column), what: What::Unreadable });
        };
        let inside = pieces(self.grid, row, column + 1, close, self.text);
        let reading = read(&inside, self.target);
        if self.stands_on_vertical(row, column, close + 1) {
            return Some(self.on_vertical(row, column, close + 1));
        }
        Some(self.symbol(row, column, close + 1, reading))
    }

    /// One past what stands behind a bracket without partner: words, operators and commas belong to it.
    fn torn_end(&self, row: usize, open: usize) -> usize {
        let (mut column, mut end) = (open + 1, open + 1);
        while column < self.grid.width(row) {
            let character = self.grid.at(row, column);
            if let Some(word_end) = self.word_end(row, column) {
                column = word_end;
            } else if matches!(character, ' ' | ',') || is_operator(character) {
                column += 1;
            } else {
                break;
            }
            if character != ' ' || self.grid.arms(row, column).is_horizontal() {
                end = column;
            }
        }
        end
    }

    /// One past the end of `| |` without wires beside it, but with a vertical wire above and below.
    fn turned_contact_end(&self, row: usize, column: usize) -> Option<usize> {
        let bar = |at: usize| self.grid.arms(row, at).is_vertical();
        let marked = bar(column) && bar(column + 2) && contact_mark(self.grid.at(row, column + 1)).is_some();
        let middle = column + 1;
        let held = |row: usize| self.grid.arms(row, middle).is_upright() && !self.in_contact(row, middle);
        let on = marked && row > 0 && held(row - 1) && held(row + 1) && !self.linked_raw(row, column);
        (on && self.stands_on_vertical(row, column, column + 3)).then_some(column + 3)
    }

    /// Whether a vertical wire ends above and below the cells `start..end`, and no wire beside them.
    fn stands_on_vertical(&self, row: usize, start: usize, end: usize) -> bool {
        let beside = (start > 0 && self.leads(row, start - 1)) || self.leads(row, end);
        let held = |row: usize| {
            (start..end).any(|at| self.grid.arms(row, at).is_upright() && !self.in_contact(row, at))
        };
        !beside && row > 0 && held(row - 1) && held(row + 1)
    }

    /// Reports an element in the middle of a vertical wire, and reads it as a part of the wire.
    fn on_vertical(&mut self, row: usize, start: usize, end: usize) -> Token {
        let span = self.grid.span(row, start, end);
        let mut problem =
            Diagnostic::new("contact-on-vertical", span, Message::new("contact-on-vertical.element"));
        for near in [row - 1, row + 1] {
            if let Some(at) = (start..end).find(|at| self.grid.arms(near, *at).is_upright()) {
                let wire = self.grid.span(near, at, at + 1);
                problem = problem.related(wire, Message::new("contact-on-vertical.wire"));
            }
        }
        self.problems.push(problem);
        Token { start, end, what: What::Upright(Arms::of('|')) }
    }

    /// `>>LABEL`, `>NAME>` or `<RETURN>`.
    fn arrow(&mut self, row: usize, column: usize, character: char) -> Option<Token> {
        let double = character == '>' && self.grid.at(row, column + 1) == '>';
        let mut start = column + 1 + usize::from(double);
        if double && self.grid.at(row, start) == ' ' {
            start += 1;
        }
        let end = self.word_end(row, start)?;
        let name = self.grid.span(row, start, end);
        let closed = self.grid.at(row, end) == '>';
        let after_wire = column > 0 && self.leads(row, column - 1);
        let (kind, end) = match character {
            '<' if closed => (ElementKind::Return, end + 1),
            '>' if double => (ElementKind::Jump(name), end),
            '>' if closed && after_wire => (ElementKind::ConnectorOut(name), end + 1),
            '>' if closed => (ElementKind::ConnectorIn(name), end + 1),
            _ => return None,
        };
        let is_return =
            kind != ElementKind::Return || name.of(self.text).to_ascii_uppercase().starts_with("RET");
        let reading = Reading { kind, operands: Vec::new(), surplus: Vec::new(), wants: Wants::Nothing };
        is_return.then(|| self.symbol(row, column, end, reading))
    }

    /// `/` between two wires.
    fn invert(&mut self, row: usize, column: usize) -> Option<Token> {
        let wire = |column: usize| self.grid.arms(row, column).is_horizontal();
        if column == 0 || !wire(column - 1) || !wire(column + 1) {
            return None;
        }
        let kind = ElementKind::Invert;
        let reading = Reading { kind, operands: Vec::new(), surplus: Vec::new(), wants: Wants::Nothing };
        Some(self.symbol(row, column, column + 1, reading))
    }

    fn symbol(&mut self, row: usize, start: usize, end: usize, reading: Reading) -> Token {
        let span = self.grid.span(row, start, end);
        for surplus in reading.surplus {
            let text = surplus.of(self.text);
            let message = Message::new("stray-operand.inside").with("text", text);
            self.problems.push(without(Diagnostic::new("stray-operand", surplus, message), text));
        }
        let columns = (start as u32, end as u32);
        let mut element = Element::new(reading.kind, span, self.grid.line(row), columns);
        if !reading.operands.is_empty() {
            element.place = OperandPlace::Inside;
        }
        element.operands = reading.operands;
        self.symbols.push(Symbol { row, start, end, element, wants: reading.wants, depth: 0 });
        Token { start, end, what: What::Symbol(self.symbols.len() - 1) }
    }
}

/// The rightmost column in which a row ends with a bar or a corner.
fn right_column(grid: &Grid) -> usize {
    let last = |row: usize| (0..grid.width(row)).rev().find(|column| grid.at(row, *column) != ' ');
    let end = |row: usize| last(row).filter(|column| grid.arms(row, *column).is_upright());
    (0..grid.height()).filter_map(end).max().unwrap_or(0)
}

/// Whether a coil can drive what a word says. An unknown name is taken for something that it can drive.
fn can_be_driven(operand: &Operand) -> bool {
    use DeviceKind::{C, M, S, T, Y};
    match operand {
        Operand::Device(device) | Operand::Indexed { device, .. } => {
            matches!(device.kind, Y | M | S | T | C)
        }
        Operand::Direct(address) => address.location != Location::Input && address.width == Width::Bit,
        Operand::Variable | Operand::WordBit { .. } => true,
        Operand::Invalid(problem) => *problem == OperandProblem::UnknownDevice,
        _ => false,
    }
}

fn extent(line: &[Token]) -> Extent {
    let mut extent = Extent::default();
    for token in line.iter().filter(|token| token.is_drawn()) {
        extent.drawn = Some((extent.drawn.map_or(token.start, |(first, _)| first), token.start));
        if let What::Symbol(_) = token.what {
            let first = extent.symbols.map_or(token.start, |(first, ..)| first);
            extent.symbols = Some((first, token.start, token.end));
        }
        if matches!(token.what, What::Symbol(_) | What::Wire) || extent.wires == Some(token.start) {
            extent.wires = Some(token.end);
        }
    }
    extent
}
