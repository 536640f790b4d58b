//! The parameter block before a program.

use super::bits;
use crate::target::{Device, DeviceKind, Latch, Latches, Model, Target};
use std::ops::Range;

/// The 46 words from 8000h on: how much memory there is, and what of the devices keeps its value without power.
///
/// | words | what |
/// |---|---|
/// | 0 | capacity in 1,000 steps |
/// | 1 | sum of the words of program memory |
/// | 4–7 | keyword, 8 characters, blanks for none |
/// | 8–23 | title, 32 characters |
/// | 24–33 | first and last latched M, S, 16-bit C, 32-bit C, D |
/// | 36, 37 | file registers: start, blocks |
/// | 38, 39 | comments: start, blocks |
/// | 40 | input for RUN |
///
/// The others are 0 in all recorded blocks; they are kept as they are.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct ParameterBlock {
    words: [u16; ParameterBlock::WORDS],
}

impl Latch {
    fn words(self) -> Range<usize> {
        let first = LATCHES + 2 * self as usize;
        first..first + 2
    }

    fn device(self, word: u16) -> Option<Device> {
        match self {
            Latch::Registers => Some(Device::new(DeviceKind::D, u32::from(word / 2))),
            _ => bits::device(word),
        }
    }

    fn word(self, device: Device) -> Option<u16> {
        match self {
            _ if device.kind != self.devices().0 => None,
            Latch::Registers => u16::try_from(device.number.checked_mul(2)?).ok(),
            _ => bits::number(device),
        }
    }
}

const CAPACITY: usize = 0;
const SUM: usize = 1;
const KEYWORD: Range<usize> = 4..8;
const TITLE: Range<usize> = 8..24;
const LATCHES: usize = 24;
const FILE_REGISTERS: usize = 36;
const COMMENTS: usize = 38;

/// Steps that a block of file registers (500 points) or of comments (50 comments of 20 bytes) takes of the capacity.
const BLOCK_STEPS: u32 = 500;

/// The latched ranges of a new PLC, recorded from an FX1S, an FX1N and an FX2N: M500–M1023, S500–S999, C100–C199,
/// C220–C255, D200–D511.
const LATCHED: [u16; 10] = [0x09F4, 0x0BFF, 0x01F4, 0x03E7, 0x0E64, 0x0EC7, 0x0EDC, 0x0EFF, 0x0190, 0x03FE];

impl ParameterBlock {
    /// How many words it has.
    pub const WORDS: usize = 46;

    /// The block of a new PLC, its sum being 0.
    pub fn new(model: Model) -> ParameterBlock {
        let mut block = ParameterBlock { words: [0; ParameterBlock::WORDS] };
        block.words[CAPACITY] = (Target::of(model).limits.steps / 1000) as u16;
        block.words[KEYWORD.start..TITLE.end].fill(u16::from_le_bytes(*b"  "));
        block.words[LATCHES..LATCHES + LATCHED.len()].copy_from_slice(&LATCHED);
        block
    }

    /// The block in these words, whatever they are; behind their end they count as 0.
    pub fn from_words(words: &[u16]) -> ParameterBlock {
        let mut block = ParameterBlock { words: [0; ParameterBlock::WORDS] };
        block.words.iter_mut().zip(words).for_each(|(to, from)| *to = *from);
        block
    }

    /// Its words as they lie in memory.
    pub fn to_words(&self) -> [u16; ParameterBlock::WORDS] {
        self.words
    }

    /// All of its memory in steps: program, comments and file registers.
    pub fn capacity(&self) -> u32 {
        u32::from(self.words[CAPACITY]) * 1000
    }

    /// With memory for this many thousands of steps.
    pub fn with_capacity(mut self, thousands: u16) -> ParameterBlock {
        self.words[CAPACITY] = thousands;
        self
    }

    /// What is left of its memory for the program, in steps.
    pub fn program_steps(&self) -> u32 {
        let blocks = u32::from(self.file_register_blocks()) + u32::from(self.comment_blocks());
        self.capacity().saturating_sub(blocks * BLOCK_STEPS)
    }

    /// The sum as it is written there; [`sum`](super::sum()) computes it.
    pub fn sum(&self) -> u16 {
        self.words[SUM]
    }

    /// With this sum.
    pub fn with_sum(mut self, sum: u16) -> ParameterBlock {
        self.words[SUM] = sum;
        self
    }

    /// Whether a keyword protects the PLC.
    pub fn has_keyword(&self) -> bool {
        self.words[KEYWORD] != [u16::from_le_bytes(*b"  "); KEYWORD.end - KEYWORD.start]
    }

    /// The title without the blanks behind it; characters other than those of ASCII as `?`.
    pub fn title(&self) -> String {
        let bytes = self.words[TITLE].iter().flat_map(|word| word.to_le_bytes());
        let shown = |byte: u8| if (b' '..=b'~').contains(&byte) { char::from(byte) } else { '?' };
        bytes.map(shown).collect::<String>().trim_end().to_string()
    }

    /// With this title; nothing if it has more than 32 characters or others than those of ASCII.
    pub fn with_title(mut self, title: &str) -> Option<ParameterBlock> {
        let most = 2 * TITLE.len();
        if title.len() > most || !title.bytes().all(|byte| (b' '..=b'~').contains(&byte)) {
            return None;
        }
        let filled = format!("{title:most$}");
        for (word, pair) in self.words[TITLE].iter_mut().zip(filled.as_bytes().chunks_exact(2)) {
            *word = u16::from_le_bytes([pair[0], pair[1]]);
        }
        Some(self)
    }

    /// The first and the last device that keep their values without power, if the words name devices.
    pub fn latched(&self, latch: Latch) -> Option<(Device, Device)> {
        let [first, last] = self.words[latch.words()] else { return None };
        Some((latch.device(first)?, latch.device(last)?))
    }

    /// With another latched range; nothing if these are no devices of that kind.
    pub fn with_latched(mut self, latch: Latch, first: Device, last: Device) -> Option<ParameterBlock> {
        self.words[latch.words()].copy_from_slice(&[latch.word(first)?, latch.word(last)?]);
        Some(self)
    }

    /// Which devices keep their values without power. Words that name no devices of their kind set nothing.
    pub fn latches(&self) -> Latches {
        Latch::ALL.into_iter().fold(Latches::default(), |latches, latch| match self.latched(latch) {
            Some((first, last)) if [first, last].map(|device| device.kind) == [latch.devices().0; 2] => {
                latches.with(latch, first, last)
            }
            _ => latches,
        })
    }

    /// With the title and the latched ranges of another block.
    pub fn with_settings_of(mut self, other: &ParameterBlock) -> ParameterBlock {
        for words in [TITLE, LATCHES..LATCHES + LATCHED.len()] {
            self.words[words.clone()].copy_from_slice(&other.words[words]);
        }
        self
    }

    /// Blocks of 500 file registers.
    pub fn file_register_blocks(&self) -> u16 {
        self.words[FILE_REGISTERS + 1]
    }

    /// Blocks of 50 device comments.
    pub fn comment_blocks(&self) -> u16 {
        self.words[COMMENTS + 1]
    }
}
