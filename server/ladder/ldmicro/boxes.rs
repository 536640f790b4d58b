//! Finds the boxes of an LDmicro export in a drawing, before its cells are read as anything else.
//!
//! They are told by their words and shape alone, so a chunk need not know that its document is an export.

use super::meaning::{BoxKind, Form, time_literal};
use crate::ladder::blocks::BlockRow;
use crate::ladder::content::{Wants, compare_operator};
use crate::ladder::glyph::{Arms, continues_word};
use crate::ladder::grid::{BOXES, Grid, JUNCTIONS, TAKEN};
use crate::ladder::scan::Symbol;
use crate::ladder::{Block, CoilKind, ContactKind, Element, ElementKind, OperandPlace, Pin, PinWire};
use crate::target::{Model, Operand, Target};
use crate::text::{Span, Spanned};

/// Two positions of the grid; no box is wider.
const WIDEST: usize = 34;

/// Cells `start..end` of a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Run {
    row: usize,
    start: usize,
    end: usize,
}

impl Run {
    /// Without the bracket at each end.
    fn inside(self) -> Run {
        Run { start: self.start + 1, end: self.end - 1, ..self }
    }

    fn from(self, start: usize) -> Run {
        Run { start: start.min(self.end), ..self }
    }

    fn to(self, end: usize) -> Run {
        Run { end: end.max(self.start), ..self }
    }
}

/// Finds all boxes, reads them, and marks their cells in the grid as taken.
pub(in crate::ladder) fn find_boxes(
    grid: &mut Grid,
    text: &str,
    target: &Target,
    symbols: &mut Vec<Symbol>,
    rows: &mut Vec<BlockRow>,
) {
    let mut finder = Finder { grid, text, target, symbols, rows };
    for row in 0..finder.grid.height() {
        let mut column = 0;
        let opens = |character| matches!(character, '[' | '{' | '^' | '+');
        if !finder.grid.may_have(row, BOXES | JUNCTIONS) {
            continue;
        }
        while let Some(found) = finder.grid.find(row, column, opens) {
            match finder.grid.at(row, found) {
                '[' | '{' => finder.bracket(row, found),
                '^' if finder.grid.at(row, found + 1) == ']' => finder.pull_up(row, found),
                '+' => finder.open_circuit(row, found),
                _ => {}
            }
            column = found + 1;
        }
    }
    finder.rows.sort_by_key(|row| (row.row, row.start));
}

struct Finder<'a> {
    grid: &'a mut Grid,
    text: &'a str,
    target: &'a Target,
    symbols: &'a mut Vec<Symbol>,
    rows: &'a mut Vec<BlockRow>,
}

impl Finder<'_> {
    fn bracket(&mut self, row: usize, column: usize) {
        let Some(run) = self.run_at(row, column) else { return };
        if self.is_wired(run) {
            self.one_row(run);
        } else if let Some(lower) = self.run_below(run) {
            self.two_rows(run, lower);
        }
    }

    /// The box that opens in a cell. The right half of a contact, `] [`, opens none.
    fn run_at(&self, row: usize, start: usize) -> Option<Run> {
        let at = |column: usize| self.grid.at(row, column);
        let open = at(start);
        let after_contact =
            start >= 2 && at(start - 2) == ']' && matches!(at(start - 1), ' ' | '/' | '\\' | 'P' | 'N');
        if after_contact {
            return None;
        }
        let close = if open == '[' { ']' } else { '}' };
        let last = (start + 1..(start + WIDEST).min(self.grid.width(row))).find(|column| {
            let character = at(*column);
            character == close || character == TAKEN || (open == '[' && character == '[')
        })?;
        (at(last) == close).then_some(Run { row, start, end: last + 1 })
    }

    /// Whether a wire leads to a side of the box. The upper half of a box has none, at most a bar beside it.
    fn is_wired(&self, run: Run) -> bool {
        let leads = |column: usize| {
            let arms = self.grid.arms(run.row, column);
            arms.is_horizontal() || arms.is_junction()
        };
        let before = run.start > 0 && (leads(run.start - 1) || self.prefix(run).is_some());
        before || leads(run.end)
    }

    /// The sign directly before a counter or timer: the edge that it counts.
    fn prefix(&self, run: Run) -> Option<char> {
        let column = run.start.checked_sub(1)?;
        let sign = self.grid.at(run.row, column);
        let wired = column > 0 && self.grid.arms(run.row, column - 1).is_line();
        (wired && matches!(sign, '/' | '\\' | 'o')).then_some(sign)
    }

    /// The lower half of the box whose upper half is `upper`.
    fn run_below(&self, upper: Run) -> Option<Run> {
        let open = self.grid.at(upper.row, upper.start);
        let first = upper.start.saturating_sub(WIDEST / 2);
        let starts = (first..upper.end).filter(|column| self.grid.at(upper.row + 1, *column) == open);
        let runs = starts.filter_map(|column| self.run_at(upper.row + 1, column));
        let mut over = runs.filter(|run| run.end > upper.start && self.is_wired(*run));
        over.next()
    }

    fn one_row(&mut self, run: Run) {
        let inside = self.trimmed(run.inside());
        let words = self.string(inside);
        let braces = self.grid.at(run.row, run.start) == '{';
        if words.contains('_') && words.contains(['/', '\\']) {
            let letters: String = words.chars().filter(|c| c.is_ascii_alphabetic()).collect();
            if let Some(kind) = BoxKind::named(&letters).filter(|kind| kind.form == Form::Wave) {
                self.wave(run, inside, kind);
            }
            return;
        }
        match words.as_str() {
            "END" => return self.end(run),
            "RES" if braces => {
                let kind = ElementKind::Coil(CoilKind::Reset);
                return self.add(run, kind, Vec::new(), Wants::Device, None);
            }
            "RETURN" if braces => {
                return self.add(run, ElementKind::Return, Vec::new(), Wants::Nothing, None);
            }
            "GOTO" if braces => {
                let Some(label) = self.take_name(run) else { return };
                let kind = ElementKind::Jump(self.span(label));
                return self.add(run, kind, Vec::new(), Wants::Nothing, Some(label));
            }
            _ => {}
        }
        if let Some(kind) = BoxKind::named(&words).filter(|kind| kind.form == Form::Command) {
            return self.command(run, inside, kind);
        }
        let Some(word) = words.get(..3) else { return };
        let rest = self.trimmed(inside.from(inside.start + 3));
        match BoxKind::named(word) {
            Some(kind) if kind.form == Form::Timer && words.get(3..4) == Some(" ") => {
                self.timer(run, inside.to(inside.start + 3), rest, kind);
            }
            Some(kind) if kind.form == Form::Counter => {
                self.counter(run, inside.to(inside.start + 3), rest, kind);
            }
            Some(kind) if kind.word == "PWM" && braces && words.get(3..4) == Some(" ") => {
                let operands = self.take_name(run);
                let above = operands;
                let reads = [operands, Some(rest)].into_iter().flatten().collect();
                self.block(run, inside.to(inside.start + 3), kind, reads, None, above);
            }
            _ => {}
        }
    }

    /// `[CTU C1, PV:5]`, `[TON T1, PT = 500 ms]`: the instance and the preset by its name, both inside.
    fn named(&mut self, run: Run, word: Run, rest: Run, kind: &'static BoxKind) -> bool {
        let words = self.string(rest);
        let split = || {
            let (instance, preset) = words.split_once(',')?;
            let pin = kind.reads.first()?;
            let preset = preset.trim_start();
            let value = preset.get(..pin.len()).filter(|name| name.eq_ignore_ascii_case(pin))?;
            let value = preset.get(value.len()..)?.trim_start().trim_start_matches([':', '=']).trim_start();
            let named = !instance.is_empty() && instance.chars().all(continues_word);
            let length = |text: &str| text.chars().count();
            (named && !value.is_empty()).then(|| (length(instance), length(&words) - length(value)))
        };
        let Some((instance, value)) = split() else { return false };
        let instance = self.span(rest.to(rest.start + instance));
        self.block(run, word, kind, vec![self.trimmed(rest.from(rest.start + value))], None, None);
        if let Some(symbol) = self.symbols.last_mut()
            && let ElementKind::Block(block) = &mut symbol.element.kind
        {
            block.instance = Some(instance);
            symbol.wants = Wants::Nothing;
        }
        true
    }

    fn timer(&mut self, run: Run, word: Run, delay: Run, kind: &'static BoxKind) {
        if self.named(run, word, delay, kind) {
            return;
        }
        if delay.start < delay.end {
            let run = self.with_prefix(run);
            self.block(run, word, kind, vec![delay], None, None);
        }
    }

    /// `>=5`, `>0`, `0:7`
    fn counter(&mut self, run: Run, word: Run, rest: Run, kind: &'static BoxKind) {
        if self.named(run, word, rest, kind) {
            return;
        }
        let words = self.string(rest);
        let colon = (rest.start..rest.end).find(|column| self.grid.at(rest.row, *column) == ':');
        let limit = words.len() - words.trim_start_matches(['>', '<', '=']).len();
        let mut reads = match colon {
            Some(colon) => vec![self.trimmed(rest.from(colon + 1)), self.trimmed(rest.to(colon))],
            None if limit > 0 => vec![self.trimmed(rest.from(rest.start + limit))],
            None => return,
        };
        if reads.iter().any(|run| run.start == run.end) {
            return;
        }
        let prefix = self.prefix(run);
        let run = self.with_prefix(run);
        // `C1:0`: the value at which it starts stands behind the name.
        if colon.is_none()
            && let Some(name) = self.name_above(run)
            && let Some(colon) = (name.start..name.end).find(|column| self.grid.at(name.row, *column) == ':')
        {
            reads.push(name.from(colon + 1));
        }
        let start = reads.get(1).filter(|start| start.row != run.row).copied();
        self.block(run, word, kind, reads, None, None);
        if let Some(start) = start {
            self.grid.clear(start.row, start.start - 1..start.end);
        }
        // It counts falling edges, as of the opposite of what it is given.
        if prefix == Some('\\')
            && let Some(ElementKind::Block(block)) =
                self.symbols.last_mut().map(|symbol| &mut symbol.element.kind)
            && let Some(pin) = block.inputs.first_mut()
        {
            pin.negated = true;
        }
    }

    /// The upper half of the wave are underscores in the row above, which are no wires.
    fn wave(&mut self, run: Run, inside: Run, kind: &'static BoxKind) {
        let name = |column: &usize| self.grid.at(run.row, *column).is_ascii_alphabetic();
        let Some(first) = (inside.start..inside.end).find(name) else { return };
        let word = inside.from(first).to(first + kind.word.len());
        // By hand the crests are drawn a column or two aside.
        let (start, end) = (run.start.saturating_sub(2), run.end + 2);
        let upper = run.row.checked_sub(1).map(|row| self.trimmed(Run { row, start, end }));
        let crest = |upper: &Run| {
            let mut cells = (upper.start..upper.end).map(|column| self.grid.at(upper.row, column));
            upper.start < upper.end && cells.all(|cell| matches!(cell, '_' | ' '))
        };
        let upper = upper.filter(crest);
        self.block(run, word, kind, Vec::new(), None, upper);
    }

    fn command(&mut self, run: Run, inside: Run, kind: &'static BoxKind) {
        let wants = !kind.reads.is_empty() || !kind.writes.is_empty();
        let name = if wants { self.take_name(run) } else { None };
        let (reads, writes) = match (name, kind.writes.is_empty()) {
            (Some(name), true) => (vec![name], None),
            (name, _) => (Vec::new(), name),
        };
        self.block(run, inside, kind, reads, writes, name);
    }

    fn two_rows(&mut self, upper: Run, lower: Run) {
        let (top, bottom) = (self.trimmed(upper.inside()), self.trimmed(lower.inside()));
        let words = self.string(top);
        if self.grid.at(upper.row, upper.start) == '[' {
            let operand = words.trim_end_matches(['=', '!', '<', '>', '/']);
            let left = self.trimmed(top.to(top.start + operand.chars().count()));
            let Some(operator) = compare_operator(&words[operand.len()..], false) else { return };
            if left.start == left.end || bottom.start == bottom.end {
                return;
            }
            let operands = [left, bottom].map(|run| self.operand(run)).to_vec();
            self.grid.clear(upper.row, upper.start..upper.end);
            return self.add(lower, ElementKind::Compare(operator), operands, Wants::Nothing, Some(upper));
        }
        let (first, second) = (self.first_word(top), self.first_word(bottom));
        let assigned = words.strip_suffix(":=").map(str::trim_end);
        let named =
            |word: Run| BoxKind::named(&self.string(word)).filter(|kind| kind.form == Form::Assignment);
        let (kind, word, target, value) = match (assigned, named(first), named(second)) {
            (Some(assigned), Some(kind), _) => {
                let end = top.start + assigned.chars().count();
                (kind, first, top.from(first.end).to(end), bottom)
            }
            (Some(assigned), None, Some(kind)) => {
                let end = top.start + assigned.chars().count();
                (kind, second, top.to(end), bottom.from(second.end))
            }
            _ => {
                // `{SHIFT REG}` above `{reg 0..7}`
                let Some(kind) = BoxKind::named(&words) else { return };
                let reads = vec![second, self.trimmed(bottom.from(second.end))];
                let reads = reads.into_iter().filter(|run| run.start < run.end).collect();
                return self.block(lower, top, kind, reads, None, Some(upper));
            }
        };
        let reads = self.terms(self.trimmed(value), kind);
        let target = self.trimmed(target);
        if target.start < target.end && reads.len() == kind.reads.len() {
            self.block(lower, word, kind, reads, Some(target), Some(upper));
        }
    }

    /// `a + b` as its two terms, `~a` as one.
    fn terms(&self, value: Run, kind: &BoxKind) -> Vec<Run> {
        let sign: &[&str] = match kind.word {
            "ADD" => &["+"],
            "SUB" | "NEG" => &["-"],
            "MUL" => &["*"],
            "DIV" => &["/"],
            "MOD" => &["%"],
            "AND" => &["&"],
            "OR" => &["|"],
            "XOR" => &["^"],
            "NOT" => &["~"],
            "SHL" => &["<<"],
            "SHR" => &[">>"],
            "ROL" => &[" rol "],
            "ROR" => &[" ror "],
            "SR0" => &[" sr0 "],
            _ => &[],
        };
        let words = self.string(value);
        // The first cell may be the sign of a number, which is no operator.
        let found = sign.iter().find_map(|sign| {
            let from = if kind.reads.len() == 1 { 0 } else { 1 };
            let at = words.char_indices().nth(from).map(|(at, _)| at)?;
            words.get(at..)?.find(sign).map(|found| (at + found, sign.len()))
        });
        let terms = match found {
            Some((at, length)) => {
                let column = value.start + words[..at].chars().count();
                vec![value.to(column), value.from(column + length)]
            }
            None => vec![value],
        };
        let terms = terms.into_iter().map(|term| self.trimmed(term));
        terms.filter(|term| term.start < term.end).collect()
    }

    fn block(
        &mut self,
        run: Run,
        word: Run,
        kind: &'static BoxKind,
        reads: Vec<Run>,
        writes: Option<Run>,
        upper: Option<Run>,
    ) {
        let row = self.grid.line(run.row);
        let pin = |implied, negated, wire| Pin { name: None, implied, negated, row, wire };
        let mut inputs = vec![pin(kind.power_in, false, PinWire::Power)];
        let mut outputs = vec![pin(kind.power_out, kind.negated, PinWire::Power)];
        let mut operands = Vec::new();
        for (read, name) in reads.into_iter().zip(kind.reads) {
            inputs.push(pin(name, false, PinWire::Operand(operands.len())));
            operands.push(self.operand(read));
        }
        if let Some(write) = writes {
            outputs.push(pin(kind.writes, false, PinWire::Operand(operands.len())));
            operands.push(self.operand(write));
        }
        let rows = upper.into_iter().chain([run]).map(|run| self.span(run)).collect();
        let type_name = Some(self.span(word));
        let block = Block { instance: None, type_name, rows, inputs, outputs, ldmicro: Some(kind) };
        let wants = match kind.form {
            Form::Timer | Form::Counter => Wants::Instance,
            _ => Wants::Nothing,
        };
        if let Some(upper) = upper {
            self.grid.clear(upper.row, upper.start..upper.end);
        }
        self.add(run, ElementKind::Block(Box::new(block)), operands, wants, upper);
    }

    fn add(
        &mut self,
        run: Run,
        kind: ElementKind,
        operands: Vec<Spanned<Operand>>,
        wants: Wants,
        upper: Option<Run>,
    ) {
        let columns = (run.start as u32, run.end as u32);
        let mut element = Element::new(kind, self.span(run), self.grid.line(run.row), columns);
        if !operands.is_empty() {
            element.place = OperandPlace::Inside;
        }
        element.operands = operands;
        let symbol = self.symbols.len();
        let depth = usize::from(upper.is_some());
        self.symbols.push(Symbol { row: run.row, start: run.start, end: run.end, element, wants, depth });
        self.grid.take(run.row, run.start..run.end);
        self.rows.push(BlockRow { row: run.row, end: run.end, start: run.start, symbol });
    }

    fn with_prefix(&self, run: Run) -> Run {
        Run { start: run.start - usize::from(self.prefix(run).is_some()), ..run }
    }

    /// The last line is no part of the rung above it, whatever its right rail stands under: the end needs no rail.
    fn end(&mut self, run: Run) {
        let above = |column: usize| run.row > 0 && self.grid.arms(run.row - 1, column).is_junction();
        let width = self.grid.width(run.row);
        let rail = (run.end..width).find(|column| self.grid.arms(run.row, *column).is_vertical());
        if self.has_double_rail(run.row) && rail.is_some_and(above) {
            self.grid.clear(run.row, run.end..width);
        }
    }

    /// `^] [`: a contact with a pull-up resistor. The sign says nothing about the logic.
    fn pull_up(&mut self, row: usize, column: usize) {
        if column > 0 && self.grid.arms(row, column - 1).is_horizontal() {
            self.grid.bridge(row, Some(column));
        }
    }

    /// `+      +` in a wire between double rails: a circuit that is open on purpose, a contact that is never on.
    fn open_circuit(&mut self, row: usize, column: usize) {
        let at = |column: usize| self.grid.at(row, column);
        let end = column + 8;
        let shape = column > 0
            && at(end - 1) == '+'
            && (column + 1..end - 1).all(|gap| at(gap) == ' ')
            && [column - 1, end].into_iter().all(|side| self.grid.arms(row, side).is_horizontal());
        let free = |column: usize| {
            let above = row > 0 && self.grid.arms(row - 1, column).down();
            !above && !self.grid.arms(row + 1, column).up()
        };
        if shape && free(column) && free(end - 1) && self.has_double_rail(row) {
            let run = Run { row, start: column, end };
            let off = Spanned::new(Operand::read("FALSE", Model::Iec), self.span(run));
            let kind = ElementKind::Contact(ContactKind::NormallyOpen);
            self.add(run, kind, vec![off], Wants::Nothing, None);
        }
    }

    fn has_double_rail(&self, row: usize) -> bool {
        let is_bar = |column: &usize| self.grid.at(row, *column) == '|';
        let first = (0..self.grid.width(row)).find(is_bar);
        first.is_some_and(|first| self.grid.at(row, first + 1) == '|')
    }

    /// The name in the row above, taken out of the drawing.
    fn take_name(&mut self, run: Run) -> Option<Run> {
        let name = self.name_above(run)?;
        self.grid.clear(name.row, name.start..name.end);
        Some(name)
    }

    /// The word in the row above that stands over the box.
    fn name_above(&self, run: Run) -> Option<Run> {
        let row = run.row.checked_sub(1)?;
        let part = |column: usize| {
            let character = self.grid.at(row, column);
            continues_word(character) || character == ':' || (character == '-' && !self.is_wire(row, column))
        };
        let over = (run.start..run.end).find(|column| part(*column))?;
        let (mut start, mut end) = (over, over);
        while start > 0 && part(start - 1) {
            start -= 1;
        }
        while part(end) {
            end += 1;
        }
        Some(Run { row, start, end })
    }

    /// Whether a hyphen is one of several, and so a wire.
    fn is_wire(&self, row: usize, column: usize) -> bool {
        let line = |column: usize| Arms::of(self.grid.at(row, column)).is_line();
        (column > 0 && line(column - 1)) || line(column + 1)
    }

    fn first_word(&self, run: Run) -> Run {
        let blank = |column: &usize| self.grid.at(run.row, *column) == ' ';
        run.to((run.start..run.end).find(blank).unwrap_or(run.end))
    }

    /// Without blanks at its ends.
    fn trimmed(&self, run: Run) -> Run {
        let full = |column: &usize| self.grid.at(run.row, *column) != ' ';
        let Some(start) = (run.start..run.end).find(full) else { return run.to(run.start) };
        let end = (start..run.end).rfind(full).map_or(start, |last| last + 1);
        Run { start, end, ..run }
    }

    /// The characters of the cells, one for each.
    fn string(&self, run: Run) -> String {
        (run.start..run.end).map(|column| self.grid.at(run.row, column)).collect()
    }

    fn span(&self, run: Run) -> Span {
        self.grid.span(run.row, run.start, run.end)
    }

    fn operand(&self, run: Run) -> Spanned<Operand> {
        let span = self.span(run);
        let word = span.of(self.text);
        let value = match time_literal(word) {
            Some(time) => Operand::read(&time, Model::Iec),
            None => Operand::read(word, self.target.model),
        };
        Spanned::new(value, span)
    }
}
