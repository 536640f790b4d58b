//! Reading the program of a PLC.

use super::{Dialect, Host, Progress, Stage};
use crate::link::address::{Address, Plain, Program};
use crate::link::frame::MOST_DATA;
use crate::link::{Command, LinkError, Reply, Transport};
use crate::machine_code::{END, Image, PARAMETER_ADDRESS, PROGRAM_ADDRESS, ParameterBlock};
use std::time::Duration;

/// Readings of a program before the line is given up.
const MOST_READINGS: usize = 3;

/// Tells how far something long is, at most once for each request.
pub(super) struct Teller<'a> {
    stage: Stage,
    done: usize,
    total: usize,
    since: Duration,
    tell: &'a mut dyn FnMut(Progress),
}

impl<'a> Teller<'a> {
    pub(super) fn new(
        stage: Stage,
        total: usize,
        since: Duration,
        tell: &'a mut dyn FnMut(Progress),
    ) -> Teller<'a> {
        Teller { stage, done: 0, total, since, tell }
    }

    pub(super) fn add(&mut self, bytes: usize, now: Duration) {
        self.done += bytes;
        let left = self.total.saturating_sub(self.done);
        let remaining = now.saturating_sub(self.since).mul_f64(left as f64 / self.done.max(1) as f64);
        let total = self.total.max(self.done);
        (self.tell)(Progress { stage: self.stage, done: self.done, total, remaining });
    }
}

impl<T: Transport> Host<T> {
    /// Parameters and program of the PLC, read until what was read is certain: its sum is the one that the PLC has
    /// computed, and nothing went wrong on the line; or two readings say the same.
    ///
    /// # Errors
    /// If the line fails, or does not say the same twice.
    pub fn upload(&mut self, tell: &mut dyn FnMut(Progress)) -> Result<Image, LinkError> {
        let mut last: Option<Image> = None;
        for _ in 0..MOST_READINGS {
            let troubles = self.line().troubles();
            let (image, sum) = self.read_image(tell)?;
            let is_summed = image.parameters().sum() == sum;
            let is_quiet = self.line().troubles() == troubles;
            if (is_summed && is_quiet) || last.as_ref() == Some(&image) {
                return Ok(image);
            }
            last = Some(image);
        }
        Err(LinkError::Noise)
    }

    /// One reading, and the sum that the PLC has computed. What is behind END is not read.
    fn read_image(&mut self, tell: &mut dyn FnMut(Progress)) -> Result<(Image, u16), LinkError> {
        let since = self.line().now();
        let block = self.read_program(PARAMETER_ADDRESS, 2 * ParameterBlock::WORDS, &mut |_, _| {})?;
        let parameters = self.usable(&block);
        let capacity = 2 * parameters.capacity() as usize;
        let length = match self.end()? {
            Some(end) => (end as usize + 2).saturating_sub(PROGRAM_ADDRESS as usize).min(capacity),
            None => capacity,
        };
        let mut teller = Teller::new(Stage::Reading, length, since, tell);
        let mut bytes: Vec<u8> = Vec::with_capacity(length);
        while bytes.len() < length && !has_end(&bytes) {
            let piece = piece(bytes.len(), length);
            let at = PROGRAM_ADDRESS + bytes.len() as u32;
            bytes.extend(self.read_program(at, piece, &mut |_, _| {})?);
            teller.add(piece, self.line.now());
        }
        let words: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|word| u16::from_le_bytes(*word)).collect();
        let used = words.iter().position(|word| *word == END).map_or(words.len(), |end| end + 1);
        let sum = ParameterBlock::from_words(&words_of(&block)).sum();
        let image = Image::new(parameters, &words[..used]).ok_or(LinkError::Noise)?;
        Ok((image, sum))
    }

    /// The parameters, if a PLC of this model can have them; else those of a new one.
    fn usable(&self, block: &[u8]) -> ParameterBlock {
        let target = self.identity.target;
        let own = ParameterBlock::from_words(&words_of(block));
        let is_usable = (1..=target.limits.steps_at_most).contains(&own.capacity());
        if is_usable { own } else { ParameterBlock::new(target.model) }
    }

    /// The address of END, where the PLC can look for it.
    fn end(&mut self) -> Result<Option<u16>, LinkError> {
        if self.dialect() == Dialect::Plain {
            return Ok(None);
        }
        let from = PROGRAM_ADDRESS as u16;
        match self.line.ask(&Command::Search { from, word: END.to_le_bytes() })? {
            Reply::Found(found) => Ok(found.filter(|end| *end >= from)),
            _ => Err(LinkError::Noise),
        }
    }

    /// Bytes of program memory; `done` is told how many have come, and when.
    pub(super) fn read_program(
        &mut self,
        address: u32,
        length: usize,
        done: &mut dyn FnMut(usize, Duration),
    ) -> Result<Vec<u8>, LinkError> {
        let mut bytes = Vec::with_capacity(length);
        while bytes.len() < length {
            let piece = piece(bytes.len(), length);
            let at = (address as u16).wrapping_add(bytes.len() as u16);
            let command = match self.dialect() {
                Dialect::Plain => Address::<Plain>::new(at).read(piece),
                Dialect::Extended => Address::<Program>::new(at).read(piece),
            };
            bytes.extend(self.line.read(&command)?);
            done(piece, self.line.now());
        }
        Ok(bytes)
    }

    /// Writes bytes of program memory, at most as many as a frame takes.
    pub(super) fn write_program(&mut self, address: u32, bytes: &[u8]) -> Result<(), LinkError> {
        let at = address as u16;
        let command = match self.dialect() {
            Dialect::Plain => Address::<Plain>::new(at).write(bytes),
            Dialect::Extended => Address::<Program>::new(at).write(bytes),
        };
        self.line.ask(&command).map(|_| ())
    }
}

/// The length of the next piece: a full frame, and every other time two bytes less, so that the answer to the piece
/// before, should it come twice, is not taken for this one.
fn piece(done: usize, total: usize) -> usize {
    let pair = 2 * MOST_DATA - 2;
    let most = if done.is_multiple_of(pair) { MOST_DATA } else { MOST_DATA - 2 };
    most.min(total - done)
}

fn has_end(bytes: &[u8]) -> bool {
    bytes.as_chunks::<2>().0.iter().any(|word| u16::from_le_bytes(*word) == END)
}

fn words_of(bytes: &[u8]) -> Vec<u16> {
    bytes.as_chunks::<2>().0.iter().map(|word| u16::from_le_bytes(*word)).collect()
}
