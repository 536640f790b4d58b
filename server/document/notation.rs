//! Which language a document is written in.

use crate::target::iec::Operator;
use crate::target::{Form, Model, Operand, Target};

/// The language of a document.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Notation {
    /// Ladder drawn in characters (`.lad`).
    Ladder,
    /// Instruction List of the FX family.
    FxIl,
    /// Instruction List of IEC 61131-3.
    IecIl,
}

impl Notation {
    /// The instruction list that `fx` or `iec`, in any letter case, asks for.
    pub fn of_dialect(word: &str) -> Option<Notation> {
        match word.to_ascii_lowercase().as_str() {
            "fx" => Some(Notation::FxIl),
            "iec" => Some(Notation::IecIl),
            _ => None,
        }
    }
}

/// The dialect that a first-line comment asks for: `dialect: fx` or `dialect: iec` after any comment sign.
pub fn dialect_comment(text: &str) -> Option<Notation> {
    let line = text.lines().next()?.trim_start_matches('\u{feff}').trim_start();
    let comment = ["//", "(*", ";"].iter().find_map(|sign| line.strip_prefix(sign))?;
    let (key, value) = comment.split_once(':')?;
    let value = value.trim_end_matches("*)").trim();
    Notation::of_dialect(value).filter(|_| key.trim().eq_ignore_ascii_case("dialect"))
}

/// The dialect of an `.il` text by its content: POU keywords and IEC-only operators speak for IEC, FX-only mnemonics
/// and devices for FX. Looks at the first thousand lines; with nothing decisive it is FX, the older habit of `.il`.
pub fn detect_notation(text: &str) -> Notation {
    if let Some(language) = dialect_comment(text) {
        return language;
    }
    let mut balance = 0i32;
    for line in text.lines().take(1000) {
        let mut words =
            line.split(|c: char| c.is_whitespace() || c == ',' || c == '(').filter(|word| !word.is_empty());
        let first = match words.next() {
            Some(word) if word.bytes().all(|byte| byte.is_ascii_digit()) => words.next().unwrap_or(word),
            Some(word) => word,
            None => continue,
        };
        if is_declaration_keyword(first) {
            return Notation::IecIl;
        }
        let operand = words.next().map(|word| Operand::read(word, Model::Fx2n));
        balance += match (Form::named(first).is_some(), Operator::written(first).is_some()) {
            (true, false) => 1,
            (false, true) => -1,
            (true, true) => match operand {
                Some(Operand::Invalid(_)) => -1,
                Some(_) => 1,
                None => 0,
            },
            (false, false) => 0,
        };
    }
    if balance < 0 { Notation::IecIl } else { Notation::FxIl }
}

/// The target of a ladder that stands alone: FX devices mean an FX2N, other names IEC, unless there are more than twice
/// as many devices. A mistyped device (`X8`, `MO`) or mnemonic is still meant for the FX, and so is one odd name among
/// devices, so that it is reported and not taken for a variable.
pub fn detect_ladder_target(text: &str) -> &'static Target {
    // Most lines of a drawing begin with a rail.
    let mut worded =
        text.lines().filter(|line| line.trim_start().starts_with(|c: char| c.is_ascii_alphabetic()));
    let header = worded.any(|line| line.split_whitespace().next().is_some_and(is_declaration_keyword));
    let exported =
        text.trim_start_matches('\u{feff}').lines().take(3).any(|line| line.starts_with("LDmicro export "));
    let foreign = || {
        let (mut names, mut devices) = (0, 0);
        for word in drawing_words(text).filter(|word| word.chars().any(char::is_alphabetic)) {
            match Operand::read(word, Model::Fx3u) {
                Operand::Invalid(_) if resembles_device(word) || Form::named(word).is_some() => {}
                Operand::Invalid(_) => names += 1,
                _ => devices += 1,
            }
        }
        names > 0 && 2 * names >= devices
    };
    if header || exported || foreign() { Target::of(Model::Iec) } else { Target::of(Model::Fx2n) }
}

/// The words of a drawing that can be operands: comments, network headers, the letters of symbols and the mnemonics
/// of boxes left out.
fn drawing_words(text: &str) -> impl Iterator<Item = &str> {
    let mut in_comment = false;
    text.lines()
        .filter(move |line| {
            let (opens, closes) = match line.contains('*') {
                true => (line.rfind("(*"), line.rfind("*)")),
                false => (None, None),
            };
            let starts_inside = in_comment;
            in_comment = match (opens, closes) {
                (Some(open), Some(close)) => open > close,
                (Some(_), None) => true,
                (None, Some(_)) => false,
                (None, None) => in_comment,
            };
            let head = line.trim_start();
            let aside = ["(*", "//", ";", "{", "NETWORK"].iter().any(|sign| head.starts_with(sign));
            !(starts_inside || opens.is_some() || closes.is_some() || aside || head.trim_end().ends_with(':'))
        })
        .take(2000)
        .flat_map(operand_words)
}

fn operand_words(line: &str) -> impl Iterator<Item = &str> {
    let part = |c: char| c.is_alphanumeric() || "_.%#".contains(c);
    let line = line.split("//").next().unwrap_or("");
    line.split(move |c: char| !part(c)).filter(|word| !word.is_empty()).filter(move |word| {
        let start = word.as_ptr() as usize - line.as_ptr() as usize;
        let (before, after) = (&line[..start], &line[start + word.len()..]);
        let beside = |sign: Option<char>| sign.is_some_and(|sign| "()[]{}|!┤├│┃".contains(sign));
        let mark = word.len() == 1 && "SRLUPNsrlupn".contains(word);
        let single = mark && (beside(before.chars().next_back()) || beside(after.chars().next()));
        // `[D>= D0 K5]` compares 32 bits.
        let is_wide = word.eq_ignore_ascii_case("D") && after.starts_with(['<', '>', '=']);
        let mnemonic = before.trim_end().ends_with(['[', '(', '{']) && after.trim_start().starts_with(part);
        !(single || mnemonic || is_wide)
    })
}

/// Whether a word that names no device looks like a slip in one: a digit that its kind does not have, or a letter
/// that looks like a digit.
fn resembles_device(word: &str) -> bool {
    let Some(rest) = word.strip_prefix(|c: char| "XYMSTCDKxymstcdk".contains(c)) else { return false };
    let lookalike = |c: char| c.is_ascii_digit() || matches!(c, 'O' | 'o' | 'I' | 'l');
    let like_number = !rest.is_empty() && rest.chars().all(lookalike);
    let with_digit = rest.contains(|c: char| c.is_ascii_digit());
    like_number && (with_digit || (word.starts_with(['X', 'Y', 'M']) && rest == "O"))
}

fn is_declaration_keyword(word: &str) -> bool {
    let word = word.trim_end_matches(';');
    ["PROGRAM", "FUNCTION", "FUNCTION_BLOCK", "CONFIGURATION", "TYPE"]
        .iter()
        .any(|key| word.eq_ignore_ascii_case(key))
        || word.get(..3).is_some_and(|head| head.eq_ignore_ascii_case("VAR"))
            && (word.len() == 3 || word.as_bytes()[3] == b'_')
}
