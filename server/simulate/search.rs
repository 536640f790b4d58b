//! Finds when something of the PLC changed last, a portion of the history at a time.

use super::machine::Machine;
use super::session::Session;
use std::fmt;

/// What is looked at.
type View<T> = Box<dyn Fn(&Machine<u8>) -> T + Send>;

/// A search that can be left and gone on with, back to where history begins.
pub struct ChangeSearch<T> {
    of: View<T>,
    /// The last scan that has not been looked at.
    end: u64,
    portion: Option<Portion<T>>,
}

impl<T> fmt::Debug for ChangeSearch<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ChangeSearch").field("end", &self.end).finish_non_exhaustive()
    }
}

/// The scans from a state that is kept to [`ChangeSearch::end`], run again.
struct Portion<T> {
    start: u64,
    machine: Machine<u8>,
    value: T,
    changed: Option<u64>,
}

impl<T: PartialEq> ChangeSearch<T> {
    /// The search for the last scan up to `last` after which `of` gives something else than before it.
    pub fn new(last: u64, of: impl Fn(&Machine<u8>) -> T + Send + 'static) -> ChangeSearch<T> {
        ChangeSearch { of: Box::new(of), end: last, portion: None }
    }

    /// The scan from which on nothing changed, as far as has been looked.
    pub fn end(&self) -> u64 {
        self.end
    }

    /// Looks on while `goes_on`, asked after each scan. Gives the scan once it is known, with nothing inside if nothing
    /// in the history changed.
    pub fn look(&mut self, session: &Session, mut goes_on: impl FnMut() -> bool) -> Option<Option<u64>> {
        self.end = self.end.min(session.machine().scans());
        while self.end > session.first_scan() {
            let mut portion = match self.portion.take() {
                Some(portion) => portion,
                None => match session.moment_before(self.end - 1) {
                    Some(start) => Portion {
                        start: start.scans(),
                        value: (self.of)(start),
                        machine: start.clone(),
                        changed: None,
                    },
                    None => return Some(None),
                },
            };
            let Portion { machine, value, changed, .. } = &mut portion;
            let mut is_left = false;
            session.replay(machine, self.end, |machine| {
                let now = (self.of)(machine);
                if now != *value {
                    (*value, *changed) = (now, Some(machine.scans()));
                }
                is_left = machine.scans() < self.end && !goes_on();
                !is_left
            });
            if is_left {
                self.portion = Some(portion);
                return None;
            }
            if portion.changed.is_some() {
                return Some(portion.changed);
            }
            self.end = portion.start;
        }
        Some(None)
    }
}
