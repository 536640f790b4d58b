//! Words that belong to no element and elements without a name: brought together where there is one reading, reported
//! otherwise.

use super::{Candidate, Named, Naming, Word};
use crate::ladder::ElementKind;
use crate::ladder::scan::{Symbol, Token, What};
use crate::target::Operand;
use crate::text::{Diagnostic, Message, Span, TextEdit, text_width};
use rustc_hash::{FxHashMap, FxHashSet};

impl Naming<'_> {
    /// The words of a line that has several, none of them a name and nothing drawn between.
    fn line_of_text(&self, word: &Word, words: &[Word]) -> Option<Span> {
        let tokens = &self.tokens.rows[word.row];
        let inner = |token: &Token| matches!(token.what, What::Wire | What::Symbol(_));
        let from = words.partition_point(|other| other.row < word.row);
        let own = words[from..].iter().take_while(|other| other.row == word.row);
        let (mut count, mut last) = (0, word.end);
        for other in own {
            if other.owner.is_some() || self.nameless_near(other, 4).next().is_some() {
                return None;
            }
            (count, last) = (count + 1, other.end);
        }
        let prose = count > 2 && !tokens.iter().any(inner);
        prose.then(|| self.grid.span(word.row, words[from].start, last))
    }

    /// The text behind everything that is drawn, from `word` on: a remark beside the right rail.
    fn text_behind(&self, word: &Word, words: &[Word]) -> Option<Span> {
        let line = &self.tokens.rows[word.row];
        let before = line[..line.partition_point(|token| token.start < word.start)].last()?;
        let rows = self.tokens.rows[word.row.saturating_sub(1)..].iter().take(3);
        let drawn = rows.flatten().filter(|token| token.is_drawn()).map(|token| token.end).max()?;
        let behind = matches!(before.what, What::Upright(_) | What::Wire) && before.end < word.start;
        if !behind || drawn > word.start {
            return None;
        }
        let last = words.iter().rev().find(|other| other.row == word.row)?;
        last.owner.is_none().then(|| self.grid.span(word.row, word.start, last.end))
    }

    /// In a line that has as many names as the line of elements beside it, the names are those of the elements in
    /// their order, although one may stand beside its element or over two.
    pub(super) fn mend_in_order(&mut self, words: &mut [Word], named: &mut Named, names_below: bool) {
        const ASIDE: usize = 8;
        let mut start = 0;
        while start < words.len() {
            let row = words[start].row;
            let end = start + words[start..].partition_point(|word| word.row == row);
            let (line, first) = (&words[start..end], start);
            start = end;
            if line.iter().all(|word| word.owner.is_some()) {
                continue;
            }
            let near = if names_below { row.checked_sub(1) } else { Some(row + 1) };
            let Some(tokens) = near.and_then(|near| self.tokens.rows.get(near)) else { continue };
            let symbols: Vec<usize> = tokens
                .iter()
                .filter_map(|token| match token.what {
                    What::Symbol(symbol) => Some(symbol),
                    _ => None,
                })
                .collect();
            let fits = |(word, symbol): (&Word, &usize)| {
                let found = &self.tokens.symbols[*symbol];
                let gap = found.start.saturating_sub(word.end).max(word.start.saturating_sub(found.end));
                match word.owner {
                    Some(owner) => owner == *symbol,
                    None => is_nameless(found) && gap <= ASIDE,
                }
            };
            if line.len() != symbols.len() || !line.iter().zip(&symbols).all(fits) {
                continue;
            }
            for (number, symbol) in (first..end).zip(symbols) {
                if words[number].owner.is_none() {
                    self.give_aside(number, symbol, words, named);
                }
            }
        }
    }

    /// Gives words that miss their element by a column or two to it, if there is only one reading.
    pub(super) fn mend(&mut self, words: &mut [Word], named: &mut Named) {
        const ASIDE: usize = 2;
        let mut wanted: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
        for (number, word) in words.iter().enumerate() {
            let unclear =
                matches!(word.below, Candidate::Two(..)) || matches!(word.above, Candidate::Two(..));
            if word.owner.is_some() || unclear {
                continue;
            }
            let mut near: Vec<usize> = self.nameless_near(word, ASIDE).collect();
            near.dedup();
            if let [symbol] = near[..] {
                wanted.entry(symbol).or_default().push(number);
            }
        }
        let mut wanted: Vec<_> = wanted.into_iter().filter(|(_, words)| words.len() == 1).collect();
        wanted.sort_unstable();
        for (symbol, numbers) in wanted {
            self.give_aside(numbers[0], symbol, words, named);
        }
    }

    /// Gives a word to a symbol beside which it stands, and says so.
    fn give_aside(&mut self, number: usize, symbol: usize, words: &mut [Word], named: &mut Named) {
        let word = words[number];
        words[number].owner = Some(symbol);
        let rows = &mut named.rows[symbol];
        *rows = Some(rows.map_or((word.row, word.row), |(a, b)| (a.min(word.row), b.max(word.row))));
        self.give(symbol, std::iter::once(word));
        let span = self.grid.span(word.row, word.start, word.end);
        let found = &self.tokens.symbols[symbol];
        let message = Message::new("ragged-drawing.operand").with("text", span.of(self.text));
        let mut problem = Diagnostic::new("ragged-drawing", span, message)
            .related(found.element.span, Message::new("stray-operand.element"));
        if let Some(edit) = self.moved(&word, found) {
            let title = Message::new("stray-operand.move").with("text", span.of(self.text));
            problem = problem.fix(title, vec![edit]);
        }
        self.problems.push(problem);
    }

    pub(super) fn report_stray(&mut self, words: &[Word], names_below: bool) {
        let stray: Vec<&Word> = words.iter().filter(|word| word.owner.is_none()).collect();
        let mut row = None;
        let mut prose = false;
        for word in &stray {
            if row != Some(word.row) {
                row = Some(word.row);
                let line = self.line_of_text(word, words);
                prose = line.is_some();
                if let Some(line) = line {
                    // One finding for a line of prose, not one for each word.
                    let message = Message::new("unreadable-cell.text");
                    self.problems.push(Diagnostic::new("unreadable-cell", line, message));
                }
            }
            if prose {
                continue;
            }
            if let Some(line) = self.text_behind(word, words) {
                prose = true;
                let title = Message::new("stray-operand.comment");
                let problem = Diagnostic::new("stray-operand", line, Message::new("stray-operand.behind"));
                self.problems
                    .push(problem.fix(title, vec![TextEdit::new(Span::at(line.start as usize), "// ")]));
                continue;
            }
            let span = self.grid.span(word.row, word.start, word.end);
            let wanted = if names_below { word.above } else { word.below };
            let text = span.of(self.text);
            if let Candidate::Two(first, second, _) = wanted {
                let mut problem = Diagnostic::new(
                    "stray-operand",
                    span,
                    Message::new("stray-operand.two").with("text", text),
                );
                for symbol in [first, second] {
                    let symbol = &self.tokens.symbols[symbol];
                    problem = problem.related(symbol.element.span, Message::new("stray-operand.element"));
                    if let Some(edit) = self.moved(word, symbol) {
                        let column = symbol.start + 1;
                        let title =
                            Message::new("stray-operand.move-to").with("text", text).with("column", column);
                        problem = problem.fix(title, vec![edit]);
                    }
                }
                self.problems.push(without(problem, text));
                continue;
            }
            let message = Message::new("stray-operand.nothing").with("text", text);
            let mut problem = Diagnostic::new("stray-operand", span, message);
            let gap = |symbol: &usize| {
                let symbol = &self.tokens.symbols[*symbol];
                symbol.start.saturating_sub(word.end).max(word.start.saturating_sub(symbol.end))
            };
            if let Some(symbol) = self.nameless_near(word, usize::MAX / 2).min_by_key(gap) {
                let symbol = &self.tokens.symbols[symbol];
                problem = problem.related(symbol.element.span, Message::new("stray-operand.nearest"));
                if let Some(edit) = self.moved(word, symbol) {
                    let title = Message::new("stray-operand.move").with("text", text);
                    problem = problem.fix(title, vec![edit]);
                }
            } else if let Some(edit) = self.contact_at(word, names_below) {
                let title = Message::new("stray-operand.draw").with("text", text);
                problem = problem.fix(title, vec![edit]);
            }
            self.problems.push(without(problem, text));
        }
    }

    /// The edit that draws a contact for `word` where there is but wire beside it.
    fn contact_at(&self, word: &Word, names_below: bool) -> Option<TextEdit> {
        const CONTACT: usize = 3;
        let name = self.grid.span(word.row, word.start, word.end).of(self.text);
        if matches!(self.target.read(name), Operand::Invalid(_) | Operand::Constant { .. }) {
            return None;
        }
        let row = if names_below { word.row.checked_sub(1)? } else { word.row + 1 };
        // As names are printed: one of two cells begins where its contact does.
        let start = (word.start + word.end + 1).checked_sub(CONTACT)? / 2;
        let mut around = start.checked_sub(1)?..start + CONTACT + 1;
        let is_wire = |column: usize| self.grid.arms(row, column).is_horizontal();
        let is_free = row < self.grid.height() && around.all(is_wire);
        let symbol = if self.grid.is_ascii() { "| |" } else { "┤ ├" };
        is_free.then(|| TextEdit::new(self.grid.span(row, start, start + CONTACT), symbol))
    }

    /// Elements without a name, one line away and at most `aside` columns to the side.
    fn nameless_near(&self, word: &Word, aside: usize) -> impl Iterator<Item = usize> {
        let (start, end) = (word.start, word.end);
        let rows = [Some(word.row + 1), word.row.checked_sub(1)].into_iter().flatten();
        let near = rows.filter_map(|row| self.tokens.rows.get(row)).flat_map(move |line| {
            let from = line.partition_point(|token| token.end + aside < start);
            line[from..].iter().take_while(move |token| token.start <= end + aside)
        });
        near.filter_map(|token| match token.what {
            What::Symbol(symbol) if is_nameless(&self.tokens.symbols[symbol]) => Some(symbol),
            _ => None,
        })
    }

    /// The edit that centres `word` over `symbol`, if there is nothing but blanks on the way.
    fn moved(&self, word: &Word, symbol: &Symbol) -> Option<TextEdit> {
        let width = word.end - word.start;
        let start = ((symbol.start + symbol.end).saturating_sub(width)) / 2;
        let (from, to) = (start.min(word.start), (start + width).max(word.end));
        let blank = |column: usize| self.grid.at(word.row, column) == ' ';
        let free = (from..word.start).chain(word.end..to).all(blank);
        let apart = (from == word.start || from == 0 || blank(from - 1)) && (to == word.end || blank(to));
        if !free || !apart || to > self.grid.width(word.row) {
            return None;
        }
        let name = self.grid.span(word.row, word.start, word.end).of(self.text);
        let moved = format!("{}{name}{}", " ".repeat(start - from), " ".repeat(to - start - width));
        Some(TextEdit::new(self.grid.span(word.row, from, to), moved))
    }

    pub(super) fn report_missing(&mut self, words: &[Word]) {
        // A name over two elements is one mistake, not three.
        let shared: FxHashSet<usize> = words
            .iter()
            .filter(|word| word.owner.is_none())
            .flat_map(|word| [word.below, word.above])
            .flat_map(|over| match over {
                Candidate::Two(first, second, _) => vec![first, second],
                _ => Vec::new(),
            })
            .collect();
        for (number, symbol) in self.tokens.symbols.iter().enumerate() {
            if is_nameless(symbol) && !shared.contains(&number) {
                let span = symbol.element.span;
                let kind = match &symbol.element.kind {
                    ElementKind::Contact(_) => Message::new("missing-operand.contact"),
                    ElementKind::Compare(_) => Message::new("missing-operand.compare"),
                    _ => Message::new("missing-operand.coil"),
                };
                self.problems.push(Diagnostic::new("missing-operand", span, kind));
            }
        }
    }
}

/// A problem with a word that may be left out: `text`, for which there are blanks then.
pub(in crate::ladder) fn without(problem: Diagnostic, text: &str) -> Diagnostic {
    let blanks = " ".repeat(text_width(text));
    let edit = TextEdit::new(problem.span, blanks);
    problem.fix(Message::new("stray-operand.remove").with("text", text), vec![edit])
}

/// Whether the element lacks an operand that it must have.
fn is_nameless(symbol: &Symbol) -> bool {
    let least = match symbol.element.kind {
        ElementKind::Contact(_) | ElementKind::Coil(_) => 1,
        ElementKind::Compare(_) => 2,
        _ => 0,
    };
    symbol.element.operands.len() < least
}
