//! The symbols that a project gives to devices, and words read with them.

use super::{Device, Form, Operand, OperandProblem, Target};
use crate::text::{Message, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::sync::Arc;

/// Names that a project gives to devices: `Start` for X0. Letter case has no meaning.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Symbols {
    devices: FxHashMap<SmolStr, Device>,
}

/// Why a word cannot be the symbol of a device.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum SymbolProblem {
    /// It has other characters than letters, digits and underscores, or begins with a digit.
    NoIdentifier,
    /// It reads as a device or a constant: `M1`, `X9`, `HAD`.
    Device,
    /// It is a mnemonic, or a mark of drawings such as the `S` of a set coil.
    Instruction,
}

impl SymbolProblem {
    /// What people are told, with the place `symbol` for the name.
    pub fn message(self) -> Message {
        Message::new(match self {
            SymbolProblem::NoIdentifier => "device-comments.no-identifier",
            SymbolProblem::Device => "device-comments.reads-as-device",
            SymbolProblem::Instruction => "device-comments.is-instruction",
        })
    }
}

/// Words that mean something in the brackets of a drawing.
const MARKS: [&str; 10] = ["S", "R", "P", "N", "L", "U", "JMP", "RETURN", "V", "Z"];

impl Symbols {
    /// Of pairs; of a name that stands twice the first counts.
    pub fn new(pairs: impl IntoIterator<Item = (SmolStr, Device)>) -> Symbols {
        let mut devices = FxHashMap::default();
        for (name, device) in pairs {
            devices.entry(folded(&name)).or_insert(device);
        }
        Symbols { devices }
    }

    /// The device called `name`.
    pub fn device(&self, name: &str) -> Option<Device> {
        self.devices.get(&folded(name)).copied()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.devices.is_empty()
    }

    /// Why `word` cannot be a symbol on `target`; nothing if it can.
    pub fn problem(word: &str, target: &Target) -> Option<SymbolProblem> {
        let mut letters = word.chars();
        let starts = letters.next().is_some_and(|first| first.is_alphabetic() || first == '_');
        if !starts || !letters.all(|letter| letter.is_alphanumeric() || letter == '_') {
            return Some(SymbolProblem::NoIdentifier);
        }
        if MARKS.iter().any(|mark| mark.eq_ignore_ascii_case(word)) || Form::named(word).is_some() {
            return Some(SymbolProblem::Instruction);
        }
        // `X9` is no device, but nobody would take it for anything else.
        let numbered = word.get(1..).is_some_and(|rest| rest.bytes().all(|byte| byte.is_ascii_digit()));
        let letter = word.chars().next().is_some_and(|first| super::DeviceKind::of_letter(first).is_some());
        let reads = !matches!(Operand::read(word, target.model), Operand::Invalid(_));
        (target.is_fx() && (reads || (letter && numbered))).then_some(SymbolProblem::Device)
    }
}

impl Target {
    /// The same target with the project's `symbols`.
    pub fn with_symbols(&self, symbols: Arc<Symbols>) -> Target {
        Target { symbols: Some(symbols), ..*self }
    }

    /// Reads one operand word; one that means nothing by itself may be a symbol. Around it may stand what may stand
    /// around its device: `K4Lamps`, `LevelZ1`, `K2LampsZ0`, `Level.3`.
    pub fn read(&self, word: &str) -> Operand {
        let operand = Operand::read(word, self.model);
        match (&operand, &self.symbols) {
            (Operand::Invalid(_), Some(symbols)) => {
                let plain = symbols.device(word).map(Operand::Device);
                plain.or_else(|| self.read_around(word, symbols)).unwrap_or(operand)
            }
            _ => operand,
        }
    }

    /// A symbol with a number of groups before it, a bit or an index register behind it, or both.
    fn read_around(&self, word: &str, symbols: &Symbols) -> Option<Operand> {
        if !self.is_fx() {
            return None;
        }
        let (groups, suffix) = (groups_length(word), suffix_length(word));
        let parts = [(groups, 0), (0, suffix), (groups, suffix)];
        let mut found = None;
        for (before, behind) in parts.into_iter().filter(|(before, behind)| before + behind > 0) {
            let name = word.get(before..word.len() - behind).unwrap_or("");
            let Some(device) = symbols.device(name) else { continue };
            if found.is_some_and(|other| other != (device, before, behind)) {
                return Some(Operand::Invalid(OperandProblem::SymbolTwice));
            }
            found = Some((device, before, behind));
        }
        let (device, before, behind) = found?;
        let (prefix, suffix) = (word.get(..before)?, word.get(word.len() - behind..)?);
        Some(match Operand::read(&format!("{prefix}{device}{suffix}"), self.model) {
            Operand::Invalid(_) => Operand::Invalid(OperandProblem::SymbolForm(device)),
            operand => operand,
        })
    }
}

/// The length of the `K4` at the start of a word; 0 if there is none.
fn groups_length(word: &str) -> usize {
    let Some(rest) = word.strip_prefix(['K', 'k']) else { return 0 };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    if digits == 0 { 0 } else { 1 + digits }
}

/// The length of the `Z1` or `.3` at the end of a word; 0 if there is none. An index register needs its number here,
/// as `PumpV` is more likely a slip of the pen.
fn suffix_length(word: &str) -> usize {
    if let Some((_, bit)) = word.rsplit_once('.') {
        return if bit.len() == 1 { 2 } else { 0 };
    }
    let digits = word.bytes().rev().take_while(u8::is_ascii_digit).count();
    let is_index = word[..word.len() - digits].ends_with(['V', 'v', 'Z', 'z']);
    if digits > 0 && is_index { digits + 1 } else { 0 }
}
