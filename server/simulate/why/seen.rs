//! What the instructions of one scan saw, found by their places.

use crate::simulate::{Code, Place, Sight};
use crate::text::Span;
use rustc_hash::FxHashMap;
use std::cell::OnceCell;
use std::ops::Range;

/// What was seen in a scan, in the order of execution.
pub(super) struct Seen {
    sights: Vec<Sight<u8>>,
    by_place: OnceCell<FxHashMap<Place, Vec<usize>>>,
}

impl Seen {
    pub(super) fn new(sights: Vec<Sight<u8>>) -> Seen {
        Seen { sights, by_place: OnceCell::new() }
    }

    pub(super) fn len(&self) -> usize {
        self.sights.len()
    }

    pub(super) fn at(&self, number: usize) -> Option<Sight<u8>> {
        self.sights.get(number).copied()
    }

    /// Whether an instruction with one of these numbers was executed before the sight with this one.
    pub(super) fn has_begun(&self, body: &Range<u32>, before: usize) -> bool {
        self.sights.iter().take(before).any(|sight| body.contains(&sight.instruction))
    }

    /// What the instruction at a place saw last before the sight with this number, and the number of that; of a body
    /// that has these instructions, if one is given. What stands in several lines of a list is seen at the last of
    /// them.
    pub(super) fn last(
        &self,
        code: &Code,
        place: Place,
        frame: Option<Range<u32>>,
        before: usize,
    ) -> Option<(usize, Sight<u8>)> {
        let by_place = self.by_place.get_or_init(|| {
            let mut by_place: FxHashMap<Place, Vec<usize>> = FxHashMap::default();
            for (number, sight) in self.sights.iter().enumerate() {
                if let Some(place) = code.places.get(sight.instruction as usize) {
                    by_place.entry(*place).or_default().push(number);
                    by_place.entry(end_of(*place)).or_default().push(number);
                }
            }
            by_place
        });
        let own =
            by_place.get(&place).or_else(|| by_place.get(&end_of(place)).filter(|_| frame.is_some()))?;
        let earlier = own.get(..own.partition_point(|number| *number < before))?.iter().rev();
        let mut sights = earlier.filter_map(|number| Some((*number, self.at(*number)?)));
        sights.find(|(_, sight)| frame.as_ref().is_none_or(|frame| frame.contains(&sight.instruction)))
    }
}

fn end_of(place: Place) -> Place {
    Place { span: Span { start: place.span.end, ..place.span }, ..place }
}
