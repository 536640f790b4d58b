//! Finds when a variable changed last, a portion of the history at a time.

use super::machine::Machine;
use super::session::Session;
use super::{Value, Variable};

/// A search that can be left and gone on with, from the present back to where history begins.
#[derive(Debug)]
pub struct ChangeSearch {
    variable: Variable,
    /// The last scan that has not been looked at.
    end: u64,
    portion: Option<Portion>,
}

/// The scans from a state that is kept to [`ChangeSearch::end`], run again.
#[derive(Debug)]
struct Portion {
    start: u64,
    machine: Machine<u8>,
    value: Value,
    changed: Option<u64>,
}

impl ChangeSearch {
    /// The search for the last change of `variable`.
    pub fn new(session: &Session, variable: Variable) -> ChangeSearch {
        ChangeSearch { variable, end: session.machine().scans(), portion: None }
    }

    /// Looks on while `goes_on`, asked after each scan. Gives the scan after which the variable was another than before
    /// it once that is known, with nothing inside if it never changed.
    pub fn look(&mut self, session: &Session, mut goes_on: impl FnMut() -> bool) -> Option<Option<u64>> {
        while self.end > session.first_scan() {
            let mut portion = match self.portion.take() {
                Some(portion) => portion,
                None => match session.moment_before(self.end - 1) {
                    Some(start) => Portion {
                        start: start.scans(),
                        value: start.value(self.variable, 0),
                        machine: start.clone(),
                        changed: None,
                    },
                    None => return Some(None),
                },
            };
            let Portion { machine, value, changed, .. } = &mut portion;
            let mut is_left = false;
            session.replay(machine, self.end, |machine| {
                let now = machine.value(self.variable, 0);
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
