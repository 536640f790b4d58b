//! Cuts a program into chunks, which are rungs, by the first word of each line alone.

use crate::target::{Flow, Form, Role};

/// The ends of the chunks of `text` as byte offsets, increasing; the last is `text.len()`. Empty text has none.
///
/// A chunk is a rung with the comments and blank lines before it. It begins with a load, a label, STL or an
/// instruction that stands without contacts, if the rung before is complete: its last instruction was an output or
/// again one without contacts. A load that begins a rung may turn out to belong to the rung before: when ANB or
/// ORB, before the first output, needs a block that the rung itself has not loaded.
/// What opens but does not close a rung (contacts, branches, labels) never lets a boundary follow it, so a rung
/// that is just being typed takes the next one in until it has its output.
///
/// # Splitting again after an edit
///
/// A boundary stands at the end of a line, outside of comments. It depends on the last instruction before it and on
/// the text after it up to the first output, nothing else: each chunk can be split as if it began the text.
/// So after an edit take a window from the chunk *before* the first touched one (a chunk whose end the edit meets
/// is touched) to the chunk after the last touched one, and split that. If a boundary inside the window, behind
/// the edit, is also an old boundary, everything from there on is as it was. If none is, because a rung lost its
/// output or a comment its end, lengthen the window and split again.
pub fn split(text: &str) -> Vec<usize> {
    let mut lines = Lines { bytes: text.as_bytes(), position: 0 };
    let mut effects = Effects::new();
    let mut rungs = Rungs::default();
    let mut significant_end = 0;
    while let Some(line) = lines.next_line(&mut effects) {
        let Some(first) = line.label.or(line.instruction) else { continue };
        rungs.begin(first, significant_end);
        if let Some(effect) = line.label {
            rungs.apply(effect);
        }
        if let Some(effect) = line.instruction {
            rungs.apply(effect);
        }
        significant_end = lines.position;
    }
    rungs.settle();
    if rungs.ends.last().copied().unwrap_or(0) < text.len() {
        rungs.ends.push(text.len());
    }
    rungs.ends
}

/// What a word means for rungs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Effect {
    /// Pushes a block, and begins a rung if the one before is complete.
    Load,
    /// Begins a rung and waits for more: labels and STL.
    Open,
    /// Begins a rung and completes it: END, NEXT, MCR …
    Alone,
    /// Joins two blocks.
    Join,
    /// A contact or a branch: there is more to come.
    Contact,
    /// Completes the rung. Unknown words count as outputs, so that a half-typed word parts what it stands between
    /// no more than a finished one.
    Output,
    /// NOP: as good as a blank line.
    Nothing,
}

impl Effect {
    fn of(mnemonic: &str) -> Effect {
        let Some(form) = Form::named(mnemonic) else { return Effect::Output };
        match form.instruction.role {
            Role::Load => Effect::Load,
            Role::StepLoad => Effect::Open,
            Role::BlockSeries | Role::BlockParallel => Effect::Join,
            Role::Series | Role::Parallel | Role::Modify => Effect::Contact,
            Role::BranchPush | Role::BranchRead | Role::BranchPop => Effect::Contact,
            Role::Output => Effect::Output,
            // FFFFh is unwritten program memory, which may lie between a contact and its output.
            Role::Standalone if form.instruction.flow() == Flow::Nothing => Effect::Nothing,
            Role::Standalone => Effect::Alone,
        }
    }
}

/// The state between two lines.
#[derive(Default)]
struct Rungs {
    ends: Vec<usize>,
    /// The last instruction was an output or one that stands alone.
    complete: bool,
    /// A boundary before a load that has not met an output yet.
    tentative: Option<usize>,
    /// Blocks loaded since the boundary.
    blocks: u32,
}

impl Rungs {
    /// Sets a boundary at `end`, the end of the last line with an instruction, if `first` begins a rung.
    fn begin(&mut self, first: Effect, end: usize) {
        if !self.complete || !matches!(first, Effect::Load | Effect::Open | Effect::Alone) {
            return;
        }
        self.blocks = 0;
        self.complete = false;
        match first {
            Effect::Load => self.tentative = Some(end),
            _ => self.ends.push(end),
        }
    }

    fn apply(&mut self, effect: Effect) {
        match effect {
            Effect::Nothing => return,
            Effect::Load => self.blocks += 1,
            Effect::Join if self.blocks < 2 => self.tentative = None,
            Effect::Join => self.blocks -= 1,
            Effect::Output | Effect::Alone => self.settle(),
            Effect::Open | Effect::Contact => {}
        }
        self.complete = matches!(effect, Effect::Output | Effect::Alone);
    }

    fn settle(&mut self) {
        self.ends.extend(self.tentative.take());
    }
}

/// The words of a line that matter here. A line that a `(* … *)` continues is one line.
#[derive(Default)]
struct Line {
    label: Option<Effect>,
    instruction: Option<Effect>,
}

/// A word at the beginning of a line.
#[derive(Clone, Copy)]
struct Word {
    start: usize,
    end: usize,
    /// A step number.
    is_number: bool,
    /// A letter of a pointer and digits.
    is_label: bool,
}

struct Lines<'a> {
    bytes: &'a [u8],
    position: usize,
}

impl Lines<'_> {
    fn next_line(&mut self, effects: &mut Effects) -> Option<Line> {
        self.bytes.get(self.position)?;
        let mut line = Line::default();
        let mut word = self.word_after_number();
        while word.is_some_and(|word| word.is_label) {
            line.label = Some(Effect::Open);
            self.skip_blanks();
            if self.byte(0) == b':' {
                self.position += 1;
            }
            word = self.word_after_number();
        }
        if let Some(word) = word {
            let effect = effects.of(self.bytes, word, self.comparison());
            line.instruction = Some(effect).filter(|effect| *effect != Effect::Nothing);
        }
        self.finish();
        Some(line)
    }

    /// The byte at `offset` from here; line feeds follow the text.
    fn byte(&self, offset: usize) -> u8 {
        self.bytes.get(self.position + offset).copied().unwrap_or(b'\n')
    }

    fn word_after_number(&mut self) -> Option<Word> {
        self.skip_blanks();
        let word = self.word();
        if word.is_some_and(|word| word.is_number) {
            self.skip_blanks();
            return self.word();
        }
        word
    }

    /// Passes blanks, block comments, and bytes that no word contains.
    fn skip_blanks(&mut self) {
        while self.position < self.bytes.len() {
            match CLASSES[self.byte(0) as usize] {
                Class::Blank => self.position += 1,
                Class::Open if self.byte(1) == b'*' => self.skip_comment(),
                _ => return,
            }
        }
    }

    /// Passes the comment that opens here.
    fn skip_comment(&mut self) {
        let body = self.bytes.get(self.position + 2..).unwrap_or(&[]);
        let close = body.windows(2).position(|pair| pair == b"*)");
        self.position = close.map_or(self.bytes.len(), |close| self.position + 2 + close + 2);
    }

    fn word(&mut self) -> Option<Word> {
        let start = self.position;
        let mut digits = 0;
        while CLASSES[self.byte(0) as usize] == Class::Word {
            digits += usize::from(self.byte(0).is_ascii_digit());
            self.position += 1;
        }
        let length = self.position - start;
        let is_pointer = matches!(self.bytes.get(start), Some(b'P' | b'p' | b'I' | b'i'));
        (length > 0).then_some(Word {
            start,
            end: self.position,
            is_number: digits == length,
            is_label: is_pointer && digits > 0 && digits + 1 == length,
        })
    }

    /// The comparison sign after a word, with or without blanks between.
    fn comparison(&mut self) -> (usize, usize) {
        while matches!(self.byte(0), b' ' | b'\t') {
            self.position += 1;
        }
        let start = self.position;
        while matches!(self.byte(0), b'=' | b'<' | b'>') {
            self.position += 1;
        }
        (start, self.position)
    }

    /// Goes behind the end of the line.
    fn finish(&mut self) {
        while let Some(byte) = self.bytes.get(self.position) {
            match CLASSES[*byte as usize] {
                Class::LineFeed => {
                    self.position += 1;
                    return;
                }
                Class::Return => {
                    self.position += if self.byte(1) == b'\n' { 2 } else { 1 };
                    return;
                }
                Class::Open if self.byte(1) == b'*' => self.skip_comment(),
                Class::Quote => self.skip_text(*byte),
                Class::Semicolon => self.skip_to_line_end(),
                Class::Slash if self.byte(1) == b'/' => self.skip_to_line_end(),
                _ => self.position += 1,
            }
        }
    }

    /// Passes a text in quotes; without the closing quote it ends with the line.
    fn skip_text(&mut self, quote: u8) {
        self.position += 1;
        while self.position < self.bytes.len() && !matches!(self.byte(0), b'\n' | b'\r') {
            self.position += 1;
            if self.bytes[self.position - 1] == quote {
                return;
            }
        }
    }

    fn skip_to_line_end(&mut self) {
        let rest = self.bytes.get(self.position..).unwrap_or(&[]);
        let length = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        self.position += length.unwrap_or(rest.len());
    }
}

/// What a byte can begin; the same classes as the lexer's.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Blank,
    Word,
    LineFeed,
    Return,
    Semicolon,
    Slash,
    Open,
    Quote,
    Other,
}

const CLASSES: [Class; 256] = {
    let mut classes = [Class::Other; 256];
    let mut byte = 0;
    while byte < 256 {
        classes[byte] = match byte as u8 {
            b'\n' => Class::LineFeed,
            b'\r' => Class::Return,
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' => Class::Word,
            b'_' | b'$' | b'%' | b'#' | b'@' | b'.' | b'+' | b'-' | b'\\' => Class::Word,
            b';' => Class::Semicolon,
            b'/' => Class::Slash,
            b'(' => Class::Open,
            b'"' | b'\'' => Class::Quote,
            0..=b' ' | 127.. => Class::Blank,
            _ => Class::Other,
        };
        byte += 1;
    }
    classes
};

/// The effects of the words met so far. Programs repeat a dozen short words, and a look-up here costs a fraction
/// of one in the instruction table.
struct Effects {
    known: [(u64, Effect); 64],
}

impl Effects {
    fn new() -> Effects {
        Effects { known: [(0, Effect::Output); 64] }
    }

    /// The effect of `word` with the comparison sign at `sign`.
    fn of(&mut self, bytes: &[u8], word: Word, sign: (usize, usize)) -> Effect {
        let length = word.end - word.start + sign.1 - sign.0;
        let parts = [&bytes[word.start..word.end], &bytes[sign.0..sign.1]];
        if length > 8 {
            let mnemonic: String = parts.concat().into_iter().map(char::from).collect();
            return Effect::of(&mnemonic);
        }
        let folded = |key: u64, byte: &u8| key << 8 | u64::from(byte.to_ascii_uppercase());
        let key = parts.into_iter().fold(0, |key, part| part.iter().fold(key, folded));
        // The upper bits of a product with an odd constant mix all bits of the key.
        let slot = (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 58) as usize;
        if self.known[slot].0 != key {
            let mnemonic: String = key.to_be_bytes().into_iter().skip(8 - length).map(char::from).collect();
            self.known[slot] = (key, Effect::of(&mnemonic));
        }
        self.known[slot].1
    }
}
