//! Reading the program of a PLC.

use super::{Dialect, Host, Progress, Stage};
use crate::link::address::{Address, Plain, Program};
use crate::link::frame::MOST_DATA;
use crate::link::{Command, LinkError, Reply, Transport};
use crate::machine_code::{END, Image, PARAMETER_ADDRESS, PROGRAM_ADDRESS, ParameterBlock};
use std::time::Duration;

/// Readings of a program before the line is given up.
const MOST_READINGS: usize = 3;
/// The most steps that addresses of 16 bits reach, in whole thousands.
const MOST_STEPS: u32 = 16_000;

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
    /// Parameters and program of the PLC, read until what was read is certain.
    ///
    /// # Errors
    /// See [`Host::read_memory`].
    pub fn upload(&mut self, tell: &mut dyn FnMut(Progress)) -> Result<Image, LinkError> {
        self.read_memory(tell).map(|(image, _)| image)
    }

    /// Parameters and program of the PLC, and whether they are whole: their sum is the one that the PLC has computed.
    ///
    /// What is behind END is read only if the sum is another. That of a download that did not end is; so is that of
    /// memory with something behind END.
    ///
    /// # Errors
    /// If the line fails, or does not say the same twice; if no PLC of this model can have such parameters.
    pub(super) fn read_memory(&mut self, tell: &mut dyn FnMut(Progress)) -> Result<(Image, bool), LinkError> {
        let mut last: Option<Image> = None;
        let mut is_all = false;
        for _ in 0..MOST_READINGS {
            let troubles = self.line().troubles();
            let (image, sum) = self.read_image(is_all, tell)?;
            let is_summed = image.parameters().sum() == sum;
            let is_quiet = self.line().troubles() == troubles;
            if (is_quiet && (is_summed || is_all)) || last.as_ref() == Some(&image) {
                return Ok((image, is_summed));
            }
            is_all |= !is_summed;
            last = Some(image);
        }
        Err(LinkError::Noise)
    }

    /// One reading up to END, or of all memory, and the sum that the PLC has computed.
    fn read_image(
        &mut self,
        is_all: bool,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<(Image, u16), LinkError> {
        let since = self.line().now();
        let parameters = self.parameters()?;
        let capacity = 2 * parameters.capacity() as usize;
        // Where END is tells only how long it will take: a firmware is known that answers something else.
        let hint = match self.end()?.filter(|_| !is_all) {
            Some(end) => (end as usize + 2).saturating_sub(PROGRAM_ADDRESS as usize).min(capacity),
            None => capacity,
        };
        let mut teller = Teller::new(Stage::Reading, hint, since, tell);
        let mut bytes: Vec<u8> = Vec::with_capacity(hint);
        let mut has_end = false;
        while bytes.len() < capacity && (is_all || !has_end) {
            let piece = piece(bytes.len(), if bytes.len() < hint { hint } else { capacity });
            let at = PROGRAM_ADDRESS + bytes.len() as u32;
            let read = self.read_program(at, piece, &mut |_, _| {})?;
            has_end |= words_of(&read).contains(&END);
            bytes.extend(read);
            teller.add(piece, self.line.now());
        }
        let mut words = words_of(&bytes);
        if let Some(end) = words.iter().position(|word| *word == END).filter(|_| !is_all) {
            words.truncate(end + 1);
        }
        let image = Image::new(parameters, &words).ok_or(LinkError::Noise)?;
        Ok((image, parameters.sum()))
    }

    /// The parameters.
    ///
    /// # Errors
    /// If the line fails, or no PLC of this model can have them.
    fn parameters(&mut self) -> Result<ParameterBlock, LinkError> {
        let own = self.raw_parameters()?;
        let most = self.identity.target.limits.steps_at_most.min(MOST_STEPS);
        match own.capacity() {
            capacity if (1..=most).contains(&capacity) => Ok(own),
            capacity => Err(LinkError::Parameters { capacity }),
        }
    }

    /// The parameters, whatever they are.
    pub(super) fn raw_parameters(&mut self) -> Result<ParameterBlock, LinkError> {
        let block = self.read_program(PARAMETER_ADDRESS, 2 * ParameterBlock::WORDS, &mut |_, _| {})?;
        Ok(ParameterBlock::from_words(&words_of(&block)))
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

fn words_of(bytes: &[u8]) -> Vec<u16> {
    bytes.as_chunks::<2>().0.iter().map(|word| u16::from_le_bytes(*word)).collect()
}
