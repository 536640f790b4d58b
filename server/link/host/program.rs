//! Reading the program of a PLC.

use super::{Dialect, Host, Progress, Stage};
use crate::link::address::{Address, Plain, Program};
use crate::link::frame::MOST_DATA;
use crate::link::{Command, LinkError, Reply, Transport};
use crate::machine_code::{BLANK, END, Image, PARAMETER_ADDRESS, PROGRAM_ADDRESS, ParameterBlock, words_of};
use std::time::Duration;

/// Readings of a program before the line is given up.
const MOST_READINGS: usize = 3;
/// The most steps that addresses of 16 bits reach, in whole thousands.
const MOST_STEPS: u32 = 16_000;

/// A download that may not have ended.
#[derive(Clone, Copy)]
pub(super) struct Cut<'a> {
    /// The program that it began to replace. It was cut if the PLC still has the sum of that one, and other words,
    /// which may have the same sum.
    pub(super) replaced: &'a [u16],
    /// Steps that it may have written.
    pub(super) steps: usize,
}

/// What was read from a PLC.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Uploaded {
    /// Parameters and program.
    pub image: Image,
    /// Whether their sum is the one that the PLC keeps. That of a download that did not end is not.
    pub is_whole: bool,
}

/// What was read once.
struct Reading {
    image: Image,
    /// As the PLC has computed it.
    sum: u16,
    /// Whether that is what a download left that did not end.
    is_cut: bool,
}

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
    pub fn upload(&mut self, tell: &mut dyn FnMut(Progress)) -> Result<Uploaded, LinkError> {
        self.read_memory(None, tell).map(|(image, is_whole)| Uploaded { image, is_whole })
    }

    /// Parameters and program of the PLC, and whether they are whole: their sum is the one that the PLC has computed,
    /// and they are not what a download left that did not end.
    ///
    /// What is behind END is read only if the sum is another: that of memory with something behind END, or of a
    /// download that did not end. Where `cut` knows what the latter had begun to replace, only what it may have
    /// written is read.
    ///
    /// # Errors
    /// If the line fails, or does not say the same twice; if no PLC of this model can have such parameters.
    pub(super) fn read_memory(
        &mut self,
        cut: Option<Cut<'_>>,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<(Image, bool), LinkError> {
        let mut last: Option<Image> = None;
        let mut is_all = false;
        for _ in 0..MOST_READINGS {
            let troubles = self.line().troubles();
            let reading = self.read_image(is_all, cut, tell)?;
            let is_summed = reading.image.parameters().sum() == reading.sum;
            let is_quiet = self.line().troubles() == troubles;
            let is_enough = is_summed || is_all || reading.is_cut;
            if (is_quiet && is_enough) || last.as_ref() == Some(&reading.image) {
                return Ok((reading.image, is_summed && !reading.is_cut));
            }
            is_all |= !is_enough;
            last = Some(reading.image);
        }
        Err(LinkError::Noise)
    }

    /// One reading up to END, or of all memory, and the sum that the PLC has computed.
    fn read_image(
        &mut self,
        is_all: bool,
        cut: Option<Cut<'_>>,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<Reading, LinkError> {
        let since = self.line().now();
        let parameters = self.parameters()?;
        let sum = parameters.sum();
        let sum_of = |words: &[u16]| Image::new(parameters, words).map(|image| image.parameters().sum());
        let mut cut = cut.filter(|cut| !is_all && sum_of(cut.replaced) == Some(sum));
        let capacity = 2 * parameters.capacity() as usize;
        // Where END is tells only how long it will take: a firmware is known that answers something else.
        let hint = match self.end()?.filter(|_| !is_all) {
            Some(end) => (end as usize + 2).saturating_sub(PROGRAM_ADDRESS as usize).min(capacity),
            None => cut.map_or(capacity, |cut| (2 * cut.steps).min(capacity)),
        };
        let mut teller = Teller::new(Stage::Reading, hint, since, tell);
        let mut words: Vec<u16> = Vec::with_capacity(hint / 2);
        let mut end = None;
        while 2 * words.len() < capacity {
            let done = 2 * words.len();
            let piece = piece(done, if done < hint { hint } else { capacity });
            let bytes = self.read_program(PROGRAM_ADDRESS + done as u32, piece, &mut |_, _| {})?;
            let read = words_of(&bytes).ok_or(LinkError::Noise)?;
            let is_blank = read.iter().all(|word| *word == BLANK);
            words.extend(read);
            teller.add(piece, self.line.now());
            if end.is_none() {
                end = words.iter().position(|word| *word == END).map(|end| end + 1);
                // What is as it was is no download that did not end.
                cut = cut.filter(|cut| end.is_none_or(|end| words[..end] != *cut.replaced));
            }
            let is_enough = match cut {
                Some(cut) => is_blank && words.len() >= cut.steps,
                None => end.is_some() && !is_all,
            };
            if is_enough {
                break;
            }
        }
        if let Some(end) = end.filter(|_| !is_all && cut.is_none()) {
            words.truncate(end);
        }
        let image = Image::new(parameters, &words).ok_or(LinkError::Noise)?;
        Ok(Reading { image, sum, is_cut: cut.is_some() })
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
        Ok(ParameterBlock::from_words(&words_of(&block).ok_or(LinkError::Noise)?))
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
pub(super) fn piece(done: usize, total: usize) -> usize {
    let pair = 2 * MOST_DATA - 2;
    let most = if done.is_multiple_of(pair) { MOST_DATA } else { MOST_DATA - 2 };
    most.min(total - done)
}
