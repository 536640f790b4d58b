//! Why instructions were not executed: a jump led past them, or nothing called the routine or unit in which they stand.

use super::drivers::Driver;
use super::seen::Seen;
use super::subject::Subject;
use super::{Inquiry, Moment, Reason};
use crate::logic::Deed;
use crate::simulate::{Place, Sight};
use crate::target::{Device, DeviceKind, Flow};
use crate::text::Message;
use smol_str::ToSmolStr;
use std::ops::Range;

impl Inquiry<'_> {
    /// What kept an instruction of a body from being executed in a scan before a moment; nothing where it was executed,
    /// where its turn had not come, or where that is not known.
    pub(super) fn skipped(
        &self,
        place: Place,
        frame: Option<usize>,
        moment: Moment,
        asked: &mut Vec<Subject>,
    ) -> Option<Reason> {
        let seen = self.seen(moment.scan)?;
        let body = self.body(frame);
        let own = self.number_of(place, &body)?;
        if let Some((number, jump)) = self.jump_past(&seen, own, &body, moment.before) {
            let jump = Driver { frame, ..jump.clone() };
            let because = self.power(&jump, Moment { before: number, ..moment }, true, asked);
            let message = Message::new("why.led-past").with("instruction", self.words(jump.place));
            return Some(self.reason(message, Some(jump.place), moment.scan, because));
        }
        if seen.has_begun(&(own..own + 1), moment.before) {
            return None;
        }
        let callers = match frame {
            Some(frame) if !seen.has_begun(&body, moment.before) => self.callers_of(frame),
            Some(_) => return None,
            None => {
                let label = self.label_above(own)?;
                if label.kind == DeviceKind::I {
                    let message = Message::new("why.no-interrupt").with("name", label);
                    return Some(self.reason(message, None, moment.scan, Vec::new()));
                }
                self.drivers.calls_of(label)
            }
        };
        callers.into_iter().find_map(|call| self.idle_call(&call, &seen, moment, asked))
    }

    /// The numbers of the instructions of a body, or of all.
    fn body(&self, frame: Option<usize>) -> Range<u32> {
        let all = 0..self.watched.places.len() as u32;
        frame.map_or(all, |frame| self.watched.iec.names().instructions_of(frame))
    }

    /// The number of the instruction at a place; of a calculation in several lines that of the last one.
    fn number_of(&self, place: Place, body: &Range<u32>) -> Option<u32> {
        let places = self.watched.places.get(body.start as usize..body.end as usize)?;
        let found = places.iter().position(|other| *other == place);
        let found = found.or_else(|| places.iter().position(|other| ends_with(*other, place)));
        found.map(|number| body.start + number as u32)
    }

    /// The jump that was the last to lead past an instruction, and the number of its sight.
    fn jump_past(&self, seen: &Seen, own: u32, body: &Range<u32>, before: usize) -> Option<(usize, &Driver)> {
        let mut found = None;
        let mut last: Option<(usize, Sight<u8>)> = None;
        let sights = (0..before).filter_map(|number| Some((number, seen.at(number)?)));
        for (number, sight) in sights.filter(|(_, sight)| body.contains(&sight.instruction)) {
            if sight.instruction == own {
                found = None;
            } else if let Some((number, before)) = last
                && before.instruction < own
                && own < sight.instruction
            {
                found = self.taken(before).map(|jump| (number, jump)).or(found);
            }
            last = Some((number, sight));
        }
        // One that leaves the body, or the scan.
        match last {
            Some((number, sight)) if sight.instruction < own => {
                let is_over = number + 1 < before || before == seen.len();
                self.taken(sight).filter(|_| is_over).map(|jump| (number, jump))
            }
            _ => found,
        }
    }

    /// The jump that saw this, if it is one and was made.
    fn taken(&self, sight: Sight<u8>) -> Option<&Driver> {
        let jump = self.drivers.leaving(self.place_of(sight.instruction))?;
        let is_jump = match &jump.action.deed {
            Deed::Jump | Deed::Return => true,
            Deed::Instruction(form) => form.instruction.flow() == Flow::Jump,
            _ => false,
        };
        // A list tells whether its condition holds, and the current result where it has none.
        let is_made = match sight.conducts {
            Some(holds) => holds != 0,
            None => sight.power != 0 || self.is_in_list(jump.place),
        };
        (is_jump && is_made).then_some(jump)
    }

    /// The calls of a body of IEC 61131-3.
    fn callers_of(&self, frame: usize) -> Vec<Driver> {
        let names = self.watched.iec.names();
        let callers = names.callers_of(frame).iter().filter_map(|(caller, place)| {
            let mut own = self.drivers.of_unit(names.unit_of(*caller));
            let call = own.find(|driver| ends_with(driver.place, *place))?;
            Some(Driver { frame: Some(*caller), ..call.clone() })
        });
        callers.collect()
    }

    /// The label of the routine of an FX program in which an instruction stands. Jumps have labels as well.
    fn label_above(&self, own: u32) -> Option<Device> {
        let begins = |label: Device| label.kind == DeviceKind::I || !self.drivers.calls_of(label).is_empty();
        let labels = self.watched.labels().filter(|label| begins(*label));
        let first = |label: Device| self.watched.entries(&label.to_smolstr()).first().copied();
        let firsts = labels.filter_map(|label| Some((first(label)?, label)));
        let (first, label) = firsts.filter(|(first, _)| *first <= own).max()?;
        let is_within = !self.drivers.ends_between(self.place_of(first), self.place_of(own));
        is_within.then_some(label)
    }

    /// Why a call was not made.
    fn idle_call(
        &self,
        call: &Driver,
        seen: &Seen,
        moment: Moment,
        asked: &mut Vec<Subject>,
    ) -> Option<Reason> {
        let Some((number, sight)) = self.saw(seen, call, moment.before) else {
            let message = Message::new("why.not-executed").with("instruction", self.words(call.place));
            let because = self.skipped(call.place, call.frame, moment, asked)?;
            return Some(self.reason(message, Some(call.place), moment.scan, vec![because]));
        };
        if sight.conducts.unwrap_or(sight.power) != 0 {
            return None;
        }
        let because = self.power(call, Moment { before: number, ..moment }, false, asked);
        let message = Message::new("why.unpowered").with("instruction", self.words(call.place));
        Some(self.reason(message, Some(call.place), moment.scan, because))
    }
}

fn ends_with(one: Place, other: Place) -> bool {
    (one.document, one.span.end) == (other.document, other.span.end)
}
