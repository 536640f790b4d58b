//! The memory of a PLC that holds its program.

use super::{BLANK, END, PARAMETER_ADDRESS, ParameterBlock};
use crate::target::Model;

/// A parameter block and the program memory behind it: what lies from 8000h on, all of its capacity.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Image {
    parameters: ParameterBlock,
    /// As many words as the capacity says.
    memory: Vec<u16>,
}

/// Bytes that lie in one row in memory.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Chunk {
    /// The address of the first.
    pub address: u32,
    /// The bytes, whole words, the low byte of each first.
    pub bytes: Vec<u8>,
}

impl Image {
    /// A program with the parameters of a new PLC; nothing if it does not fit. An FX2N has 16,000 steps if it needs
    /// them.
    pub fn of(program: &[u16], model: Model) -> Option<Image> {
        let parameters = ParameterBlock::new(model);
        let larger = (model == Model::Fx2n && program.len() > parameters.capacity() as usize)
            .then(|| parameters.with_capacity(16));
        Image::new(larger.unwrap_or(parameters), program)
    }

    /// A program, or all of program memory, with these parameters, whose sum is set; nothing if it does not fit or
    /// reaches into the memory of comments and file registers.
    pub fn new(parameters: ParameterBlock, words: &[u16]) -> Option<Image> {
        let fits = words.len() <= parameters.capacity() as usize
            && program_in(words).len() <= parameters.program_steps() as usize;
        let mut memory = fits.then(|| words.to_vec())?;
        memory.resize(parameters.capacity() as usize, BLANK);
        let parameters = parameters.with_sum(sum(&memory));
        Some(Image { parameters, memory })
    }

    /// The image in bytes that were read from 8000h on. Memory that was not read counts as blank. Nothing if there is
    /// no whole parameter block, a word is cut in half, or there is more than its capacity.
    pub fn from_bytes(bytes: &[u8]) -> Option<Image> {
        let words = words_of(bytes)?;
        let (parameters, program) = words.split_at_checked(ParameterBlock::WORDS)?;
        Image::new(ParameterBlock::from_words(parameters), program)
    }

    /// All of it as it lies in memory.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.words().flat_map(u16::to_le_bytes).collect()
    }

    /// The parameters, with the sum of this memory.
    pub fn parameters(&self) -> &ParameterBlock {
        &self.parameters
    }

    /// All words of program memory.
    pub fn memory(&self) -> &[u16] {
        &self.memory
    }

    /// The same program with other parameters; nothing if it does not fit then.
    pub fn with_parameters(&self, parameters: ParameterBlock) -> Option<Image> {
        Image::new(parameters, self.program())
    }

    /// The words of the program: up to END, or without the blank memory behind it where there is no END.
    pub fn program(&self) -> &[u16] {
        program_in(&self.memory)
    }

    /// What must be written to make this image of `old`, in pieces of `most` bytes or fewer, and as few of them as
    /// possible. The sum is left to the PLC, which computes it when a download ends.
    ///
    /// Of parameters that change all are written, with a sum of 0, as the maker's tool was recorded to do.
    pub fn changed_chunks(&self, old: &Image, most: usize) -> Vec<Chunk> {
        let words: Vec<u16> = self.words().collect();
        let held: Vec<u16> = old.words().collect();
        let is_changed = |place: &usize| words.get(*place) != held.get(*place);
        let most = (most / 2).max(1);
        let mut chunks = Vec::new();
        let parameters = self.parameters.with_sum(0);
        if parameters != old.parameters.with_sum(0) {
            let mut address = PARAMETER_ADDRESS;
            for words in parameters.to_words().chunks(most) {
                let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
                let length = bytes.len() as u32;
                chunks.push(Chunk { address, bytes });
                address += length;
            }
        }
        let mut place = ParameterBlock::WORDS;
        while let Some(first) = (place..words.len()).find(is_changed) {
            let end = (first + most).min(words.len());
            let last = (first..end).rev().find(is_changed).unwrap_or(first);
            chunks.push(Chunk {
                address: PARAMETER_ADDRESS + 2 * first as u32,
                bytes: words[first..=last].iter().flat_map(|word| word.to_le_bytes()).collect(),
            });
            place = last + 1;
        }
        chunks
    }

    fn words(&self) -> impl Iterator<Item = u16> {
        self.parameters.to_words().into_iter().chain(self.memory.iter().copied())
    }
}

/// Of the words of a program those that a PLC executes: up to END, or all of them where there is none.
pub fn executed(words: &[u16]) -> &[u16] {
    let end = words.iter().position(|word| *word == END);
    end.and_then(|end| words.get(..=end)).unwrap_or(words)
}

/// The program at the beginning of memory: up to END, or without the blank words behind it where there is no END.
pub(super) fn program_in(memory: &[u16]) -> &[u16] {
    let end = memory.iter().position(|word| *word == END);
    let length = end.or_else(|| memory.iter().rposition(|word| *word != BLANK)).map_or(0, |last| last + 1);
    memory.get(..length).unwrap_or(memory)
}

/// The sum that a PLC keeps of its program memory: of all words up to the capacity, modulo 2¹⁶.
pub fn sum(memory: &[u16]) -> u16 {
    memory.iter().fold(0, |sum: u16, word| sum.wrapping_add(*word))
}

/// Words in memory order; nothing if one is cut in half.
pub fn words_of(bytes: &[u8]) -> Option<Vec<u16>> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    rest.is_empty().then(|| pairs.iter().map(|pair| u16::from_le_bytes(*pair)).collect())
}
