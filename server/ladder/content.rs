//! What stands between brackets, parentheses or bars: which element it is, and its operands.

use super::glyph::is_operator;
use super::grid::Grid;
use super::{CoilKind, CompareOperator, ContactKind, ElementKind};
use crate::target::{Constant, Flow, Form, Operand, Target};
use crate::text::{Span, Spanned};

/// A word or an operator inside a symbol.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'t> {
    pub(super) text: &'t str,
    pub(super) span: Span,
    operator: bool,
}

/// A symbol as read, and what it still wants from outside.
#[derive(Debug)]
pub(super) struct Reading {
    pub(super) kind: ElementKind,
    pub(super) operands: Vec<Spanned<Operand>>,
    /// Words that are too many.
    pub(super) surplus: Vec<Span>,
    pub(super) wants: Wants,
}

/// Which names an element takes from outside.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Wants {
    /// None.
    Nothing,
    /// A device; without it the element is incomplete.
    Device,
    /// A device, and for timers and counters the preset.
    DeviceAndPreset,
    /// Both sides of a comparison.
    TwoOperands,
    /// Operands, if there are any: an instruction of which only the mnemonic stands inside.
    Operands,
    /// The instance of a function block.
    Instance,
}

impl Reading {
    fn new(kind: ElementKind, operands: Vec<Spanned<Operand>>, wants: Wants) -> Reading {
        let wants = if operands.is_empty() { wants } else { Wants::Nothing };
        Reading { kind, operands, surplus: Vec::new(), wants }
    }
}

/// The pieces of the cells `first..last` of a row, separated by blanks, commas and comparison operators.
pub(super) fn pieces<'t>(
    grid: &Grid,
    row: usize,
    first: usize,
    last: usize,
    text: &'t str,
) -> Vec<Piece<'t>> {
    let mut pieces = Vec::new();
    let mut start = first;
    let mut column = first;
    let mut add = |from: usize, to: usize, operator: bool| {
        if from < to {
            let span = grid.span(row, from, to);
            pieces.push(Piece { text: span.of(text), span, operator });
        }
    };
    while column < last {
        let character = grid.at(row, column);
        match character {
            ' ' | ',' => add(start, column, false),
            '\'' | '"' if start == column => {
                let close = (column + 1..last).find(|at| grid.at(row, *at) == character);
                column = close.unwrap_or(last - 1);
                add(start, column + 1, false);
            }
            // `/X0`: a mark stands at the front and needs no blank.
            '/' | '\\' | '↑' | '↓' if start == column => add(start, column + 1, false),
            _ if is_operator(character) && !(column > first && grid.at(row, column - 1) == ':') => {
                add(start, column, false);
                let end = (column..last).find(|at| !is_operator(grid.at(row, *at))).unwrap_or(last);
                add(column, end, true);
                column = end - 1;
            }
            _ => {
                column += 1;
                continue;
            }
        }
        column += 1;
        start = column;
    }
    add(start, last, false);
    pieces
}

/// `[…]`, `]…[` and `|…|`.
pub(super) fn read_brackets(pieces: &[Piece], target: &Target) -> Reading {
    let contact = |kind, operands| Reading::new(ElementKind::Contact(kind), operands, Wants::Device);
    if let Some(compare) = read_compare(pieces, target) {
        return compare;
    }
    match pieces {
        [] => contact(ContactKind::NormallyOpen, Vec::new()),
        [mark] if contact_kind(mark).is_some() => {
            contact(contact_kind(mark).unwrap_or(ContactKind::NormallyOpen), Vec::new())
        }
        [mark, operand] if contact_kind(mark).is_some() => contact(
            contact_kind(mark).unwrap_or(ContactKind::NormallyOpen),
            vec![read_operand(operand, target)],
        ),
        // `[ANI X1]`: an instruction list written into contacts.
        [word, operand] if contact_mnemonic(word).is_some() => contact(
            contact_mnemonic(word).unwrap_or(ContactKind::NormallyOpen),
            vec![read_operand(operand, target)],
        ),
        [word] if word.text.eq_ignore_ascii_case("INV") => {
            Reading::new(ElementKind::Invert, Vec::new(), Wants::Nothing)
        }
        [word, label] if word.text.eq_ignore_ascii_case("JMP") => {
            Reading::new(ElementKind::Jump(label.span), Vec::new(), Wants::Nothing)
        }
        [word, rest @ ..] => {
            if let Some(instruction) = read_instruction(pieces, target) {
                return instruction;
            }
            let operand = read_operand(word, target);
            // `[ T1 K10 ]`: a timer with its preset is driven, not asked.
            if let [preset] = rest
                && target.is_fx()
                && is_preset(&operand.value, &target.read(preset.text))
            {
                let operands = vec![operand, read_operand(preset, target)];
                return Reading::new(ElementKind::Coil(CoilKind::Plain), operands, Wants::Nothing);
            }
            let is_operand = !target.is_fx() || !matches!(operand.value, Operand::Invalid(_));
            if rest.is_empty() || (target.is_fx() && is_operand) {
                let mut reading = contact(ContactKind::NormallyOpen, vec![operand]);
                reading.surplus = rest.iter().map(|piece| piece.span).collect();
                return reading;
            }
            let kind = ElementKind::Instruction { form: None, mnemonic: word.span };
            Reading::new(kind, read_operands(rest, target), Wants::Nothing)
        }
    }
}

/// `(…)`
pub(super) fn read_parentheses(pieces: &[Piece], target: &Target) -> Reading {
    let coil = |kind, operands| Reading::new(ElementKind::Coil(kind), operands, Wants::DeviceAndPreset);
    let Some((first, rest)) = pieces.split_first() else { return coil(CoilKind::Plain, Vec::new()) };
    if let Some(kind) = coil_kind(first, rest.is_empty()) {
        return coil(kind, read_operands(rest, target));
    }
    if let Some(instruction) = read_instruction(pieces, target) {
        return instruction;
    }
    // `(OTE Y0)`: a word of letters before an operand is meant for a mnemonic.
    if target.is_fx()
        && !rest.is_empty()
        && first.text.len() > 1
        && first.text.chars().all(char::is_alphabetic)
        && matches!(target.read(first.text), Operand::Invalid(_))
    {
        let kind = ElementKind::Instruction { form: None, mnemonic: first.span };
        return Reading::new(kind, read_operands(rest, target), Wants::Nothing);
    }
    coil(CoilKind::Plain, read_operands(pieces, target))
}

/// `{…}`, a box of the LDmicro export.
pub(super) fn read_braces(pieces: &[Piece], target: &Target) -> Reading {
    if let Some(instruction) = read_instruction(pieces, target) {
        return instruction;
    }
    let mnemonic = pieces.first().map_or(Span::default(), |piece| piece.span);
    let operands = read_operands(pieces.get(1..).unwrap_or(&[]), target);
    Reading::new(ElementKind::Instruction { form: None, mnemonic }, operands, Wants::Operands)
}

/// A mnemonic of the target with its operands. A word that names a device is no mnemonic.
fn read_instruction(pieces: &[Piece], target: &Target) -> Option<Reading> {
    let (word, rest) = pieces.split_first()?;
    let form = Form::named(word.text)?;
    // Exports end with `[END]`, whatever they were made for; other instructions are those of the FX family.
    let ends = rest.is_empty() && form.instruction.flow() == Flow::ProgramEnd;
    if !target.is_fx() && !ends {
        return None;
    }
    if rest.is_empty() && !ends && !matches!(target.read(word.text), Operand::Invalid(_)) {
        return None;
    }
    let wants = if form.instruction.operands.is_empty() { Wants::Nothing } else { Wants::Operands };
    let kind = ElementKind::Instruction { form: Some(form), mnemonic: word.span };
    Some(Reading::new(kind, read_operands(rest, target), wants))
}

/// `>= D0 K10`, `D>= D0 K10`, `LD>= D0 K10`, `D0 >= K10`, `>= INT`, `>=`
fn read_compare(pieces: &[Piece], target: &Target) -> Option<Reading> {
    let at = pieces.iter().position(|piece| piece.operator)?;
    let (before, after) = (&pieces[..at], &pieces[at + 1..]);
    let compare = |wide, operands: &[Piece]| {
        let operator = compare_operator(pieces[at].text, wide)?;
        let operands = read_operands(operands, target);
        Some(Reading::new(ElementKind::Compare(operator), operands, Wants::TwoOperands))
    };
    match (before, after) {
        ([], []) => compare(false, &[]),
        ([], [word]) if is_number_type(word.text) => compare(false, &[]),
        ([], operands) if operands.iter().all(|piece| !piece.operator) => compare(false, operands),
        ([prefix], [_, _, ..]) => {
            const NARROW: [&str; 3] = ["LD", "AND", "OR"];
            const WIDE: [&str; 4] = ["D", "LDD", "ANDD", "ORD"];
            let is = |name: &&str| prefix.text.eq_ignore_ascii_case(name);
            let wide = WIDE.iter().any(is);
            if wide || NARROW.iter().any(is) { compare(wide, after) } else { None }
        }
        ([left], [right]) => compare(false, &[*left, *right]),
        _ => None,
    }
}

pub(super) fn compare_operator(text: &str, wide: bool) -> Option<CompareOperator> {
    Some(match text {
        "=" | "==" => CompareOperator::Equal { wide },
        "<>" | "!=" | "/=" | "≠" => CompareOperator::NotEqual { wide },
        ">" => CompareOperator::Greater { wide },
        "<" => CompareOperator::Less { wide },
        ">=" | "=>" | "≥" => CompareOperator::GreaterOrEqual { wide },
        "<=" | "=<" | "≤" => CompareOperator::LessOrEqual { wide },
        _ => return None,
    })
}

/// The types that a comparison contact may name, `|>= INT|`.
fn is_number_type(word: &str) -> bool {
    const TYPES: [&str; 14] = [
        "INT", "SINT", "DINT", "LINT", "UINT", "USINT", "UDINT", "ULINT", "REAL", "LREAL", "BYTE", "WORD",
        "DWORD", "TIME",
    ];
    TYPES.iter().any(|name| name.eq_ignore_ascii_case(word))
}

fn contact_kind(mark: &Piece) -> Option<ContactKind> {
    let mut characters = mark.text.chars();
    let kind = super::glyph::contact_mark(characters.next()?);
    if characters.next().is_none() { kind } else { None }
}

/// The contact that an instruction in series draws.
fn contact_mnemonic(word: &Piece) -> Option<ContactKind> {
    const MNEMONICS: [(&str, ContactKind); 12] = [
        // Examine if closed, examine if open: the words of Allen-Bradley.
        ("XIC", ContactKind::NormallyOpen),
        ("XIO", ContactKind::NormallyClosed),
        ("LD", ContactKind::NormallyOpen),
        ("AND", ContactKind::NormallyOpen),
        ("LDI", ContactKind::NormallyClosed),
        ("ANI", ContactKind::NormallyClosed),
        ("LDN", ContactKind::NormallyClosed),
        ("ANDN", ContactKind::NormallyClosed),
        ("LDP", ContactKind::Rising),
        ("ANDP", ContactKind::Rising),
        ("LDF", ContactKind::Falling),
        ("ANDF", ContactKind::Falling),
    ];
    let found = MNEMONICS.iter().find(|(name, _)| name.eq_ignore_ascii_case(word.text));
    found.map(|(_, kind)| *kind)
}

/// The words that give a coil its kind, whatever follows them.
const COIL_MARKS: [(&str, CoilKind); 13] = [
    ("/", CoilKind::Negated),
    ("S", CoilKind::Set),
    ("L", CoilKind::Set),
    ("R", CoilKind::Reset),
    ("U", CoilKind::Reset),
    ("P", CoilKind::Rising),
    ("N", CoilKind::Falling),
    ("T", CoilKind::Toggle),
    ("↑", CoilKind::Rising),
    ("↓", CoilKind::Falling),
    // Output energise, latch, unlatch: the words of Allen-Bradley.
    ("OTE", CoilKind::Plain),
    ("OTL", CoilKind::Set),
    ("OTU", CoilKind::Reset),
];

/// Mnemonics of the same meaning; alone they could be names.
const COIL_MNEMONICS: [(&str, CoilKind); 5] = [
    ("OUT", CoilKind::Plain),
    ("SET", CoilKind::Set),
    ("RST", CoilKind::Reset),
    ("PLS", CoilKind::Rising),
    ("PLF", CoilKind::Falling),
];

/// All words that may stand before the name in the parentheses of a coil, with the kind that each of them gives it.
/// A coil without any is a plain one.
pub fn coil_words() -> impl Iterator<Item = (&'static str, CoilKind)> {
    COIL_MARKS.into_iter().chain(COIL_MNEMONICS)
}

/// The kind that the first word in parentheses gives a coil; `alone` if nothing follows it.
fn coil_kind(word: &Piece, alone: bool) -> Option<CoilKind> {
    let known = if alone { COIL_MARKS.len() } else { usize::MAX };
    let mut words = coil_words().take(known);
    words.find(|(name, _)| name.eq_ignore_ascii_case(word.text)).map(|(_, kind)| kind)
}

fn read_operand(piece: &Piece, target: &Target) -> Spanned<Operand> {
    Spanned::new(target.read(piece.text), piece.span)
}

fn read_operands(pieces: &[Piece], target: &Target) -> Vec<Spanned<Operand>> {
    pieces.iter().map(|piece| read_operand(piece, target)).collect()
}

/// Whether `second` can be the preset of the timer or counter `first`.
pub(super) fn is_preset(first: &Operand, second: &Operand) -> bool {
    let counts = |device: &Operand| device.device().is_some_and(|device| device.kind.has_preset());
    let number =
        matches!(second, Operand::Constant { value: Constant::Decimal(_) | Constant::Hexadecimal(_), .. });
    counts(first) && (number || second.device().is_some_and(|device| device.kind.is_word()))
}
