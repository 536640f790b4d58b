//! Who gives something its value: what is read of the text, and in IEC 61131-3, where much is calculated, what the
//! engine notes while a scan is run again.

use super::drivers::Driver;
use super::seen::Seen;
use super::subject::Subject;
use super::{Inquiry, Moment, writes};
use crate::simulate::{Place, Spot, Value, Variable};

/// What gives a value.
#[derive(Clone, Debug)]
pub(super) enum Writer {
    /// An instruction of which it is known how power comes to it.
    Read(Driver),
    /// One behind a calculation, by its number.
    Other(u32),
}

impl Inquiry<'_> {
    /// What wrote a value last before a moment of a scan, and the number of its sight.
    pub(super) fn writer(&self, subject: &Subject, value: &Value, moment: Moment) -> Option<(Writer, usize)> {
        let seen = self.seen(moment.scan)?;
        let Some(spot) = self.spot(subject) else {
            let written = self.drivers_of(subject).into_iter().filter_map(|driver| {
                let (at, sight) = self.saw(&seen, &driver, moment.before)?;
                writes(&driver, sight.power != 0, value).then_some((Writer::Read(driver), at))
            });
            return written.max_by_key(|(_, at)| *at);
        };
        let all = self.session.writes(moment.scan, self.time_of(moment.scan)?, self.watched, spot)?;
        let last = all.iter().rfind(|write| write.sights <= moment.before)?;
        Some((self.known(subject, last.instruction), self.sight_of(&seen, last.instruction, last.sights)))
    }

    /// All that may write something, in the order of the code.
    pub(super) fn writers_of(&self, subject: &Subject) -> Vec<Writer> {
        let Some(spot) = self.spot(subject) else {
            return self.drivers_of(subject).into_iter().map(Writer::Read).collect();
        };
        let all = self.watched.writers_of(spot).into_iter();
        all.filter(|own| self.stands(*own)).map(|own| self.known(subject, own)).collect()
    }

    /// Where something lies in an IEC 61131-3 program.
    fn spot(&self, subject: &Subject) -> Option<Spot> {
        match subject.variable {
            _ if self.watched.target.is_fx() => None,
            Variable::Relay(cell) => Some(Spot::of_cell(cell)),
            Variable::Typed(spot) | Variable::Enumerated(spot, _) => Some(spot),
            Variable::Word(_) | Variable::Pair(..) | Variable::Around(_) => None,
        }
    }

    fn known(&self, subject: &Subject, instruction: u32) -> Writer {
        let place = self.place_of(instruction);
        // A calculation of several lines ends where the value is stored.
        let ends_there = |driver: &Driver| {
            (driver.place.document, driver.place.span.end) == (place.document, place.span.end)
        };
        let is_in_body =
            |driver: &Driver| self.frame(driver).is_some_and(|frame| frame.contains(&instruction));
        let named = self.drivers_of(subject).into_iter().find(|own| is_in_body(own) && ends_there(own));
        // An element whose subscript is known at run time only is nothing that a name leads to.
        let names = self.watched.iec.names();
        let placed = || {
            let frame = names.scope_at(instruction)?;
            let found = self.drivers.of_unit(names.unit_of(frame)).find(|own| ends_there(own))?;
            Some(Driver { frame: Some(frame), ..found.clone() })
        };
        match named.or_else(placed) {
            Some(driver) => Writer::Read(driver),
            None => Writer::Other(instruction),
        }
    }

    /// Where an instruction stands.
    pub(super) fn place_of(&self, instruction: u32) -> Place {
        self.watched.places.get(instruction as usize).copied().unwrap_or(Place::START)
    }

    /// The number of what an instruction saw when it wrote something before the sight with this number. What a drawn
    /// call tells comes behind it.
    fn sight_of(&self, seen: &Seen, instruction: u32, before: usize) -> usize {
        let is_own = |number: &usize| seen.at(*number).is_some_and(|sight| sight.instruction == instruction);
        (0..before).rev().find(is_own).or_else(|| (before..seen.len()).find(is_own)).unwrap_or(before)
    }
}
