//! Whether the program in a PLC stays the one that somebody takes it for, seen beside other requests.

use super::{Comparison, Host};
use crate::link::{LinkError, Transport};
use crate::machine_code::{Image, ParameterBlock};

/// The program in a PLC, looked at in one request now and then.
///
/// A sum that changes says that another program is there. Equal sums are no proof, so where the program is known that
/// should be there, it is compared word for word each time that the sum has become its own.
#[derive(Clone, Debug, Default)]
pub struct Drift {
    /// What should be there; nothing if nobody knows.
    wanted: Option<Image>,
    /// Whether there is something that should be there, even if this PLC has no room for it.
    is_wanted: bool,
    comparison: Option<Comparison>,
    sum: Option<u16>,
    is_same: Option<bool>,
    is_refused: bool,
    /// Whether nobody was told of that yet.
    is_untold: bool,
}

/// What was found of the program in a PLC.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum DriftNews {
    /// It is the one that should be there, word for word.
    Same,
    /// It is another one than the one that should be there.
    Other,
    /// It has changed; what it should be nobody has said.
    Changed,
    /// The PLC does not let anybody read it.
    Unreadable,
}

impl Drift {
    /// From the program of these words, in a PLC with these parameters. The default is from whatever is there.
    pub fn from(wanted: &[u16], parameters: ParameterBlock) -> Drift {
        Drift { wanted: Image::new(parameters, wanted), is_wanted: true, ..Drift::default() }
    }

    /// From a program that the PLC does not even let anybody read the parameters of.
    pub fn unreadable() -> Drift {
        Drift { is_wanted: true, is_refused: true, is_untold: true, ..Drift::default() }
    }

    /// Whether the program is the one that should be there, as far as is known.
    pub fn is_same(&self) -> Option<bool> {
        self.is_same
    }

    /// Whether it is being compared, so that each further look brings more.
    pub fn is_comparing(&self) -> bool {
        self.comparison.is_some() || (self.is_wanted && self.sum.is_none() && !self.is_refused)
    }

    /// The sum that was seen last.
    pub fn sum(&self) -> Option<u16> {
        self.sum
    }

    /// Takes note of the sum; gives what that says.
    fn note(&mut self, sum: u16) -> Option<DriftNews> {
        let before = self.sum.replace(sum);
        if before == Some(sum) {
            return None;
        }
        self.is_same = None;
        match &self.wanted {
            Some(wanted) if wanted.parameters().sum() == sum => {
                self.comparison = Some(Comparison::new(wanted));
                None
            }
            _ if self.is_wanted => self.judged(false),
            _ => before.map(|_| DriftNews::Changed),
        }
    }

    fn judged(&mut self, is_same: bool) -> Option<DriftNews> {
        self.comparison = None;
        self.is_same = Some(is_same);
        Some(if is_same { DriftNews::Same } else { DriftNews::Other })
    }
}

impl<T: Transport> Host<T> {
    /// Looks at the program once more, in one request; gives what is new.
    ///
    /// # Errors
    /// If the line fails.
    pub fn look_at_program(&mut self, drift: &mut Drift) -> Result<Option<DriftNews>, LinkError> {
        if drift.is_refused {
            return Ok(std::mem::take(&mut drift.is_untold).then_some(DriftNews::Unreadable));
        }
        let found = match &mut drift.comparison {
            Some(comparison) => self.compare(comparison).map(|compared| match compared {
                Some(is_same) => drift.judged(is_same),
                None => None,
            }),
            None => self.sum().map(|sum| drift.note(sum)),
        };
        match found {
            // Its devices may be read nevertheless.
            Err(LinkError::Refused { .. }) => {
                (drift.comparison, drift.is_refused) = (None, true);
                Ok(drift.is_wanted.then_some(DriftNews::Unreadable))
            }
            found => found,
        }
    }
}
