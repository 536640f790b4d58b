//! Whose name each word outside a symbol is.

mod strays;
pub(super) use strays::without;

use super::content::{Wants, is_preset};
use super::grid::Grid;
use super::scan::{Symbol, Token, Tokens, What};
use super::{Block, ElementKind, NameHabit, OperandPlace};
use crate::target::{Operand, Target};
use crate::text::{Diagnostic, Message, Spanned};

/// Names stand at most this many lines from their element.
const FARTHEST: usize = 3;

/// A word outside all symbols.
#[derive(Clone, Copy, Debug)]
struct Word {
    row: usize,
    start: usize,
    end: usize,
    /// The symbols that it could name, standing below it and above it.
    below: Candidate,
    above: Candidate,
    /// Whose name it is.
    owner: Option<usize>,
}

/// What a word overlaps in the nearest row with symbols, in one direction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Candidate {
    None,
    /// One symbol, at a distance in rows.
    One(usize, usize),
    /// Two symbols, the one that it overlaps more first, at a distance in rows.
    Two(usize, usize, usize),
}

impl Candidate {
    fn symbol(self) -> Option<usize> {
        match self {
            Candidate::One(symbol, _) => Some(symbol),
            _ => None,
        }
    }
}

/// Gives every word outside the symbols to an element.
pub(super) struct Naming<'a> {
    pub(super) grid: &'a Grid,
    pub(super) text: &'a str,
    pub(super) target: &'a Target,
    pub(super) tokens: &'a mut Tokens,
    /// The leftmost column in which a line is drawn; words left of it are rung numbers.
    pub(super) left: usize,
    pub(super) problems: &'a mut Vec<Diagnostic>,
}

/// What came of it.
#[derive(Debug, Default)]
pub(super) struct Named {
    pub(super) habit: NameHabit,
    /// For each symbol, the first and last row of its names.
    pub(super) rows: Vec<Option<(usize, usize)>>,
}

impl Naming<'_> {
    /// Matches words and symbols. `hint` is the habit of the document, for drawings that do not show their own.
    pub(super) fn run(mut self, hint: NameHabit) -> Named {
        let mut words = self.words();
        let mut habit = NameHabit::default();
        for (number, word) in words.iter().enumerate() {
            // What takes no name says nothing about names, and the first of two words hangs over its element's side.
            let takes = |symbol: usize| self.tokens.symbols[symbol].wants != Wants::Nothing;
            let in_phrase =
                words.get(number + 1).is_some_and(|next| next.row == word.row && word.end + 1 == next.start);
            match (word.below, word.above) {
                (Candidate::One(symbol, _), Candidate::None) if takes(symbol) => habit.above += 1,
                (Candidate::None, Candidate::One(symbol, _)) if takes(symbol) && !in_phrase => {
                    habit.below += 1
                }
                _ => {}
            }
        }
        let names_below = habit.decided().or(hint.decided()).unwrap_or(false);
        self.own(&mut words, names_below);
        let mut named = Named { habit, rows: vec![None; self.tokens.symbols.len()] };
        let mut owned: Vec<(usize, Word)> =
            words.iter().filter_map(|word| Some((word.owner?, *word))).collect();
        owned.sort_by_key(|(owner, _)| *owner);
        for words in owned.chunk_by(|(left, _), (right, _)| left == right) {
            let (owner, first) = words[0];
            let last = words.iter().map(|(_, word)| word.row).max().unwrap_or(first.row);
            named.rows[owner] = Some((first.row, last));
            self.give(owner, words.iter().map(|(_, word)| *word));
        }
        self.mend_in_order(&mut words, &mut named, names_below);
        self.mend(&mut words, &mut named);
        self.report_stray(&words, names_below);
        self.report_missing(&words);
        named
    }

    /// All words that can be names, in reading order, with their candidates.
    fn words(&self) -> Vec<Word> {
        let mut words = Vec::new();
        for (row, line) in self.tokens.rows.iter().enumerate() {
            for (number, token) in line.iter().enumerate() {
                let before = number.checked_sub(1).and_then(|before| line.get(before));
                let after = line.get(number + 1);
                let margin = number == 0 && token.end <= self.left && after.is_some_and(Token::is_drawn);
                let numbered = margin && self.is_number(row, token);
                if token.what != What::Word
                    || numbered
                    || self.belongs_to_problem(row, token, [before, after])
                {
                    continue;
                }
                let (start, end) = (token.start, token.end);
                let mut word =
                    Word { row, start, end, below: Candidate::None, above: Candidate::None, owner: None };
                let is_wire = |other: &&Token| other.what == What::Wire;
                let wired = before.filter(is_wire).is_some_and(|before| before.end == start)
                    || after.filter(is_wire).is_some_and(|after| after.start == end);
                // A word between wires names nothing.
                if !wired {
                    let rows = self.tokens.rows.len();
                    word.below = self.candidate(&word, row + 1..rows.min(row + 1 + FARTHEST));
                    word.above = self.candidate(&word, (row.saturating_sub(FARTHEST)..row).rev());
                }
                words.push(word);
            }
        }
        words
    }

    /// Whether the word is the name of something that could not be read and has been reported: it stands beside an
    /// element on a vertical wire, or over a bracket without partner.
    fn belongs_to_problem(&self, row: usize, token: &Token, beside: [Option<&Token>; 2]) -> bool {
        let turned = |other: &Token| {
            let wide = other.end - other.start > 2 && matches!(other.what, What::Upright(_));
            wide && other.end + 1 >= token.start && token.end + 1 >= other.start
        };
        let unreadable = |row: usize| {
            let over = self.tokens.over(row, token.start..token.end);
            // A word in the wire has been bridged.
            let bridged = |over: &Token| {
                let mut shared = token.start.max(over.start)..token.end.min(over.end);
                over.what == What::Wire && shared.any(|column| !self.grid.arms(row, column).is_horizontal())
            };
            over.is_some_and(|(_, over)| over.what == What::Unreadable || bridged(over))
        };
        beside.into_iter().flatten().any(turned)
            || unreadable(row + 1)
            || row.checked_sub(1).is_some_and(unreadable)
    }

    fn is_number(&self, row: usize, token: &Token) -> bool {
        (token.start..token.end).all(|column| self.grid.at(row, column).is_ascii_digit())
    }

    /// What `word` overlaps in the first of `rows` where something is drawn over its columns.
    fn candidate(&self, word: &Word, rows: impl Iterator<Item = usize>) -> Candidate {
        for (distance, row) in rows.enumerate() {
            let line = &self.tokens.rows[row];
            let from = line.partition_point(|token| token.end <= word.start);
            let over = line[from..]
                .iter()
                .take_while(|token| token.start < word.end)
                .filter(|token| token.is_drawn());
            let mut blocked = false;
            // Cells of overlap and symbol, the largest overlap first; symbols that take no name come last.
            let mut first = (0, 0);
            let mut second = (0, 0);
            for token in over {
                blocked = true;
                let What::Symbol(symbol) = token.what else { continue };
                let found = &self.tokens.symbols[symbol];
                if found.element.block().is_some() && !self.is_border(row, token, symbol) {
                    continue;
                }
                let cells = 2 * (token.end.min(word.end) - token.start.max(word.start));
                let overlap = if found.wants == Wants::Nothing { 1 } else { cells };
                if overlap > first.0 {
                    second = std::mem::replace(&mut first, (overlap, symbol));
                } else if overlap > second.0 {
                    second = (overlap, symbol);
                }
            }
            // One cell is not enough to be in doubt, unless it is one for each.
            let doubtful = second.0 > 2 || (second.0 == 2 && first.0 == 2);
            match (first, second) {
                ((0, _), _) if blocked => return Candidate::None,
                ((0, _), _) => {}
                ((_, first), (_, second)) if doubtful => return Candidate::Two(first, second, distance + 1),
                ((_, first), _) => return Candidate::One(first, distance + 1),
            }
        }
        Candidate::None
    }

    /// Whether the token is the top border of a function block, above which the instance name stands.
    fn is_border(&self, row: usize, token: &Token, symbol: usize) -> bool {
        let above = row.checked_sub(1).and_then(|row| self.tokens.rows.get(row)).map_or(&[][..], |line| line);
        let same = |other: &Token| other.what == What::Symbol(symbol) && other.start == token.start;
        let from = above.partition_point(|other| other.start < token.start);
        !above.get(from).is_some_and(same)
    }

    /// Decides whose each word is.
    fn own(&self, words: &mut [Word], names_below: bool) {
        let takes = |symbol: usize| self.tokens.symbols[symbol].wants != Wants::Nothing;
        let mut counts = vec![0usize; self.tokens.symbols.len()];
        for word in words.iter_mut() {
            let wanted = if names_below { word.above } else { word.below };
            word.owner = wanted.symbol();
            if let Some(owner) = word.owner {
                counts[owner] += 1;
            }
        }
        // A name over two elements is clear if one of them has another name.
        for word in words.iter_mut() {
            let wanted = if names_below { &mut word.above } else { &mut word.below };
            let Candidate::Two(first, second, distance) = *wanted else { continue };
            let owner = match (counts[first], counts[second]) {
                (_, 1..) => first,
                (1.., 0) => second,
                (0, 0) => continue,
            };
            *wanted = Candidate::One(owner, distance);
            word.owner = Some(owner);
            counts[owner] += 1;
        }
        self.second_operands(words, &mut counts, names_below);
        self.presets(words, &mut counts);
        for word in words.iter_mut().filter(|word| word.owner.is_none()) {
            // Against the habit, but there is only one reading.
            let other = if names_below { word.below } else { word.above };
            let wanted = if names_below { word.above } else { word.below };
            if let (Candidate::None, Candidate::One(symbol, _)) = (wanted, other)
                && counts[symbol] == 0
                && takes(symbol)
            {
                word.owner = Some(symbol);
                counts[symbol] += 1;
            }
        }
        self.join_phrases(words);
    }

    /// The second operand of a comparison may stand on the other side. It can be told from the upper line of a name
    /// only if the element there has a nearer name.
    fn second_operands(&self, words: &mut [Word], counts: &mut [usize], names_below: bool) {
        if !self.tokens.symbols.iter().any(|symbol| symbol.wants == Wants::TwoOperands) {
            return;
        }
        let nearest = nearest_words(words, names_below);
        for (number, word) in words.iter_mut().enumerate() {
            let other = if names_below { word.below } else { word.above };
            let Candidate::One(symbol, 1) = other else { continue };
            let free = word.owner.is_none_or(|owner| owner != symbol && nearest.get(&owner) != Some(&number));
            if self.tokens.symbols[symbol].wants == Wants::TwoOperands && counts[symbol] == 1 && free {
                counts[symbol] += 1;
                if let Some(owner) = word.owner.replace(symbol) {
                    counts[owner] -= 1;
                }
            }
        }
    }

    /// The preset of a timer or counter that has none may stand on the other side of its coil, or behind it.
    fn presets(&self, words: &mut [Word], counts: &mut [usize]) {
        if !self.target.is_fx() || words.iter().all(|word| word.owner.is_some()) {
            return;
        }
        let read = |word: &Word| self.read(word).value;
        let mut devices: rustc_hash::FxHashMap<usize, Operand> = rustc_hash::FxHashMap::default();
        for word in words.iter() {
            if let Some(owner) = word.owner.filter(|owner| counts[*owner] == 1) {
                devices.insert(owner, read(word));
            }
        }
        for word in words.iter_mut().filter(|word| word.owner.is_none()) {
            let preset = read(word);
            let waits = |symbol: &usize| {
                let element = &self.tokens.symbols[*symbol].element;
                let inside = element.operands.first().map(|operand| operand.value);
                let device = inside.or_else(|| devices.get(symbol).copied());
                matches!(element.kind, ElementKind::Coil(_))
                    && element.operands.len() < 2
                    && counts[*symbol] < 2 - element.operands.len()
                    && device.is_some_and(|device| is_preset(&device, &preset))
            };
            let sides = [word.above.symbol(), word.below.symbol(), self.symbol_before(word)];
            if let Some(symbol) = sides.into_iter().flatten().find(waits) {
                word.owner = Some(symbol);
                counts[symbol] += 1;
            }
        }
    }

    /// The word as an operand.
    fn read(&self, word: &Word) -> Spanned<Operand> {
        let span = self.grid.span(word.row, word.start, word.end);
        Spanned::new(self.target.read(span.of(self.text)), span)
    }

    /// The symbol on the left of a word, at most two blanks away.
    fn symbol_before(&self, word: &Word) -> Option<usize> {
        let line = self.tokens.rows.get(word.row)?;
        let before = line[..line.partition_point(|token| token.start < word.start)].last()?;
        match before.what {
            What::Symbol(symbol) if before.end + 2 >= word.start => Some(symbol),
            _ => None,
        }
    }

    /// `T0 K50` over a coil: a word over nothing, one blank away from a name of a coil, belongs to that name.
    fn join_phrases(&self, words: &mut [Word]) {
        let phrases = |symbol: usize| {
            matches!(
                self.tokens.symbols[symbol].wants,
                Wants::DeviceAndPreset | Wants::TwoOperands | Wants::Operands
            )
        };
        for number in 0..words.len() {
            let word = words[number];
            let over_nothing = word.below == Candidate::None || word.above == Candidate::None;
            if word.owner.is_some() || !over_nothing {
                continue;
            }
            let left =
                number.checked_sub(1).map(|left| words[left]).filter(|left| left.end + 1 == word.start);
            let right = words.get(number + 1).copied().filter(|right| word.end + 1 == right.start);
            let near = [left, right].into_iter().flatten().filter(|near| near.row == word.row);
            words[number].owner = near.filter_map(|near| near.owner).find(|owner| phrases(*owner));
        }
    }

    /// Makes operands of the words of a symbol, which come in reading order.
    fn give(&mut self, number: usize, words: impl Iterator<Item = Word> + Clone) {
        let Some(first) = words.clone().next() else { return };
        let target = self.target;
        let operands: Vec<Spanned<Operand>> = words.clone().map(|word| self.read(&word)).collect();
        let one_line = words.clone().all(|word| word.row == first.row);
        let symbol = &mut self.tokens.symbols[number];
        let place = if first.row < symbol.row { OperandPlace::Above } else { OperandPlace::Below };
        let mut surplus = Vec::new();
        match symbol.wants {
            Wants::Nothing => match (&symbol.element.kind, &symbol.element.operands[..], &operands[..]) {
                // `(T0)` with its preset outside.
                (ElementKind::Coil(_), [device], [preset])
                    if target.is_fx() && is_preset(&device.value, &preset.value) =>
                {
                    symbol.element.operands.push(*preset);
                }
                _ => surplus = operands,
            },
            Wants::Instance => {
                if let ElementKind::Block(block) = &mut symbol.element.kind {
                    surplus = name_instance(block, operands);
                }
            }
            Wants::Operands => symbol.element.operands = operands,
            Wants::TwoOperands => {
                surplus = operands.get(2..).map_or(Vec::new(), <[_]>::to_vec);
                symbol.element.operands = operands.into_iter().take(2).collect();
            }
            Wants::Device | Wants::DeviceAndPreset if operands.len() == 1 => {
                symbol.element.operands = operands
            }
            Wants::Device | Wants::DeviceAndPreset => {
                let preset = matches!(&operands[..], [device, preset] if is_preset(&device.value, &preset.value)
                    || (!target.is_fx() && one_line));
                if symbol.wants == Wants::DeviceAndPreset && preset {
                    symbol.element.operands = operands;
                } else {
                    let rows: Vec<usize> = words.map(|word| word.row).collect();
                    surplus = name_device(symbol, &operands, &rows, place, (self.text, target));
                }
            }
        }
        if symbol.wants != Wants::Nothing && symbol.wants != Wants::Instance {
            symbol.element.place = place;
        }
        let is_note =
            |operand: &Spanned<Operand>| target.is_fx() && matches!(operand.value, Operand::Invalid(_));
        for operand in surplus {
            if is_note(&operand) {
                symbol.element.notes.push(operand.span);
                continue;
            }
            let text = operand.span.of(self.text);
            let message = Message::new("stray-operand.surplus").with("text", text);
            let related = Message::new("stray-operand.element");
            let problem = Diagnostic::new("stray-operand", operand.span, message);
            self.problems.push(without(problem.related(symbol.element.span, related), text));
        }
    }
}

/// For each symbol, its word nearest to it.
fn nearest_words(words: &[Word], names_below: bool) -> rustc_hash::FxHashMap<usize, usize> {
    let mut nearest = rustc_hash::FxHashMap::default();
    for (number, word) in words.iter().enumerate() {
        let wanted = if names_below { word.above } else { word.below };
        if let Candidate::One(symbol, distance) = wanted {
            let best = nearest.entry(symbol).or_insert((distance, number));
            if distance < best.0 {
                *best = (distance, number);
            }
        }
    }
    nearest.into_iter().map(|(symbol, (_, number))| (symbol, number)).collect()
}

/// The instance is the last word, next to the border; returns the others.
fn name_instance(block: &mut Block, mut operands: Vec<Spanned<Operand>>) -> Vec<Spanned<Operand>> {
    block.instance = operands.pop().map(|name| name.span);
    operands
}

/// Gives a contact or a coil its device; returns the words that are not part of it.
///
/// Of several lines a device or an address is the operand and the rest is description; identifiers are one name
/// over several lines.
fn name_device(
    symbol: &mut Symbol,
    operands: &[Spanned<Operand>],
    rows: &[usize],
    place: OperandPlace,
    (text, target): (&str, &Target),
) -> Vec<Spanned<Operand>> {
    let addressed = |operand: &Spanned<Operand>| {
        !matches!(operand.value, Operand::Invalid(_) | Operand::Variable | Operand::Literal(_))
    };
    let lines_differ = rows.windows(2).all(|pair| pair[0] != pair[1]);
    let all_names = !operands.iter().any(addressed);
    if operands.len() > 1 && operands.len() <= FARTHEST && lines_differ && all_names && !target.is_fx() {
        symbol.element.name_lines = operands.iter().map(|operand| operand.span).collect();
        symbol.element.operands = operands.last().copied().into_iter().collect();
        let name = symbol.element.operand_text(0, text).into_owned();
        for operand in &mut symbol.element.operands {
            operand.value = target.read(&name);
        }
        return Vec::new();
    }
    // Nearest line first, and in it left to right.
    let mut order: Vec<usize> = (0..operands.len()).collect();
    order.sort_by_key(|number| match place {
        OperandPlace::Above => usize::MAX - rows[*number],
        _ => rows[*number],
    });
    let chosen =
        order.iter().copied().find(|number| addressed(&operands[*number])).or(order.first().copied());
    symbol.element.operands = chosen.map(|chosen| operands[chosen]).into_iter().collect();
    (0..operands.len()).filter(|number| Some(*number) != chosen).map(|number| operands[number]).collect()
}
