//! Names of LDmicro as identifiers of IEC 61131-3, and what each is declared as.

use super::table::NameKind;
use crate::target::iec::{ElementaryType, Function, FunctionBlock, is_identifier, is_keyword};
use rustc_hash::{FxHashMap, FxHashSet};

/// The names of a program, in the order in which they are met.
#[derive(Debug, Default)]
pub(super) struct Names {
    names: Vec<Name>,
    numbers: FxHashMap<String, usize>,
    /// Identifiers that are given away, without letter case.
    taken: FxHashSet<String>,
    /// The number to try first behind an identifier; those that are numbered in any case begin with 1, not 2.
    next: FxHashMap<(String, bool), usize>,
}

/// A name and its declaration.
#[derive(Debug)]
pub(super) struct Name {
    /// As LDmicro spells it; empty for instances that have no name there.
    pub original: String,
    /// As it is declared.
    pub identifier: String,
    /// The type that it is declared with.
    pub declared: String,
    /// The words of the table about it: type and pin.
    pub kind: String,
    pub pin: String,
}

impl Names {
    /// The names, in the order in which they were met.
    pub fn all(&self) -> impl Iterator<Item = &Name> {
        self.names.iter()
    }

    /// The number of the name that LDmicro spells `original`.
    pub fn of(&mut self, original: &str) -> usize {
        if let Some(number) = self.numbers.get(original) {
            return *number;
        }
        let declared = match NameKind::of(original) {
            NameKind::Input | NameKind::Output | NameKind::Relay => "BOOL",
            _ => "INT",
        };
        let number = self.add(original, original, declared);
        self.numbers.insert(original.to_string(), number);
        number
    }

    /// A new instance of `declared` with a name that begins with `stem`.
    pub fn instance(&mut self, stem: &str, declared: &str) -> usize {
        self.add("", stem, declared)
    }

    /// The number of the label that LDmicro spells `original`. Labels are no variables, but share their names.
    pub fn label(&mut self, original: &str) -> usize {
        let key = format!(":{original}");
        if let Some(number) = self.numbers.get(&key) {
            return *number;
        }
        let number = self.add(original, original, "");
        self.numbers.insert(key, number);
        number
    }

    /// The identifier of the program itself, which no variable takes.
    pub fn instance_named(&mut self, wanted: &str) -> String {
        let plain = identifier(wanted);
        self.push("", plain.clone(), "");
        plain
    }

    fn add(&mut self, original: &str, wanted: &str, declared: &str) -> usize {
        let identifier = self.free(&identifier(wanted), original.is_empty());
        self.push(original, identifier, declared)
    }

    fn push(&mut self, original: &str, identifier: String, declared: &str) -> usize {
        self.taken.insert(identifier.to_lowercase());
        let [original, declared] = [original, declared].map(str::to_string);
        self.names.push(Name { original, identifier, declared, kind: String::new(), pin: String::new() });
        self.names.len() - 1
    }

    pub fn get(&self, number: usize) -> &Name {
        &self.names[number]
    }

    pub fn get_mut(&mut self, number: usize) -> &mut Name {
        &mut self.names[number]
    }

    /// `wanted`, or with a number behind it if that is taken or `numbered`.
    fn free(&mut self, wanted: &str, numbered: bool) -> String {
        let folded = wanted.to_lowercase();
        if !numbered && !self.taken.contains(&folded) {
            return wanted.to_string();
        }
        let first = self.next.entry((folded.clone(), numbered)).or_insert(if numbered { 1 } else { 2 });
        let is_free = |number: &usize| !self.taken.contains(&format!("{folded}_{number}"));
        let number = (*first..).find(is_free).unwrap_or(*first);
        *first = number + 1;
        format!("{wanted}_{number}")
    }
}

/// The nearest identifier: other characters and runs of underscores become one underscore, none ends it.
fn identifier(name: &str) -> String {
    let mut found = String::new();
    for character in name.chars() {
        let character = if character.is_alphanumeric() { character } else { '_' };
        if !(character == '_' && found.ends_with('_')) {
            found.push(character);
        }
    }
    let mut found = found.trim_end_matches('_').to_string();
    let reserved = |name: &str| {
        is_keyword(name)
            || ElementaryType::named(name).is_some()
            || FunctionBlock::named(name).is_some()
            || Function::named(name).is_some()
    };
    if !is_identifier(&found) || reserved(&found) {
        found = format!("v_{}", found.trim_start_matches('_'));
    }
    if is_identifier(&found) { found } else { "v".to_string() }
}

/// The number `word` as the standard writes it: `0x1F` as `16#1F`, `'A'` as `65`. Nothing if it is none.
pub(super) fn number(word: &str) -> Option<String> {
    let (sign, digits) = match word.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", word.strip_prefix('+').unwrap_or(word)),
    };
    if !digits.is_empty() && digits.len() <= 20 && digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return Some(format!("{sign}{digits}"));
    }
    if let [b'\'', character, b'\''] = word.as_bytes() {
        return Some(character.to_string());
    }
    let based = [("0x", 16), ("0X", 16), ("0b", 2), ("0B", 2), ("0o", 8), ("0O", 8)];
    let (digits, base) =
        based.iter().find_map(|(prefix, base)| Some((digits.strip_prefix(prefix)?, *base)))?;
    let fits = (1..=16).contains(&digits.len()) && digits.chars().all(|c| c.is_digit(base));
    if !fits {
        return None;
    }
    // Literals with a base have no sign.
    match sign {
        "" => Some(format!("{base}#{}", digits.to_uppercase())),
        _ => Some(format!("-{}", u64::from_str_radix(digits, base).ok()?)),
    }
}
