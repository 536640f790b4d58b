//! Comparing what is in a PLC with a program, a piece at a time, so that other requests go between.

use super::Host;
use super::program::piece;
use crate::link::{LinkError, Transport};
use crate::machine_code::{Image, PROGRAM_ADDRESS};

/// A comparison that goes on.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The program in bytes, up to END.
    wanted: Vec<u8>,
    /// That of all of its memory.
    sum: u16,
    done: usize,
}

impl Comparison {
    /// With this program in the memory of the PLC.
    pub fn new(image: &Image) -> Comparison {
        let wanted = image.program().iter().flat_map(|word| word.to_le_bytes()).collect();
        Comparison { wanted, sum: image.parameters().sum(), done: 0 }
    }
}

impl<T: Transport> Host<T> {
    /// Compares the next piece, in one request; at the end the sum, so that nothing lies behind the program. Gives
    /// whether all is the same, or nothing as long as there is more to compare.
    ///
    /// # Errors
    /// If the line fails.
    pub fn compare(&mut self, comparison: &mut Comparison) -> Result<Option<bool>, LinkError> {
        let Comparison { wanted, sum, done } = comparison;
        if *done == wanted.len() {
            return Ok(Some(self.sum()? == *sum));
        }
        let piece = piece(*done, wanted.len());
        let read = self.read_program(PROGRAM_ADDRESS + *done as u32, piece, &mut |_, _| {})?;
        let is_same = wanted.get(*done..*done + piece) == Some(&read[..]);
        *done += piece;
        Ok((!is_same).then_some(false))
    }
}
