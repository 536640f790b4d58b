//! The notification `rungwise/monitor`: what of a program that runs is on the screen.

use super::super::to_proto::Place;
use super::forced::forced;
use crate::simulate::{Code, EnergisedKind, Lanes, Machine, Sight, Variable, power_flow};
use crate::target::Operand;
use serde::{Deserialize, Serialize};
use serde_json::{Value as Json, json};
use std::ops::Range as Bytes;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::{Range, Uri};

/// The method.
pub(super) enum MonitorMethod {}

impl Notification for MonitorMethod {
    type Params = Picture;
    const METHOD: &'static str = "rungwise/monitor";
}

/// The parameters.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub(super) struct Picture {
    pub(super) uri: Uri,
    pub(super) version: i32,
    #[serde(skip_deserializing)]
    pub(super) source: &'static str,
    #[serde(skip_deserializing)]
    pub(super) mode: &'static str,
    pub(super) scan: u64,
    pub(super) time_ms: f64,
    pub(super) edition: u64,
    pub(super) branch: u64,
    pub(super) elements: Vec<Json>,
    pub(super) values: Vec<Json>,
    pub(super) errors: Vec<Json>,
}

/// What the client shows.
#[derive(Default)]
pub(super) struct Monitor {
    ranges: Vec<Range>,
    names: Vec<String>,
    /// The ranges as bytes of the document, whole chunks each.
    windows: Vec<Bytes<usize>>,
    document: u32,
}

impl Monitor {
    /// Whether nothing is shown.
    pub(super) fn is_empty(&self) -> bool {
        self.ranges.is_empty() && self.names.is_empty()
    }

    /// Whether lines of the text are shown.
    pub(super) fn has_text(&self) -> bool {
        !self.ranges.is_empty()
    }

    /// Shows other ranges, or other names; what is not given stays.
    pub(super) fn watch(&mut self, ranges: Option<Vec<Range>>, names: Option<Vec<String>>) {
        self.ranges = ranges.unwrap_or_else(|| std::mem::take(&mut self.ranges));
        self.names = names.unwrap_or_else(|| std::mem::take(&mut self.names));
    }

    /// Finds the bytes that are shown.
    pub(super) fn place(&mut self, number: u32, place: Place<'_>) {
        let document = place.document;
        self.document = number;
        let windows = self.ranges.iter().map(|range| {
            let span = place.span(*range);
            let (start, end) = (span.start as usize, span.end as usize);
            let first = document.chunk_at(start).map_or(start, |at| at.start);
            let last = document.chunk_at(end).map_or(end, |at| at.start + at.chunk.len());
            first..last
        });
        self.windows = windows.collect();
    }

    /// The instructions that are shown.
    pub(super) fn instructions(&self, code: &Code) -> Bytes<u32> {
        let all = self.windows.iter().map(|window| code.instructions_in(self.document, window.clone()));
        all.reduce(|one, other| one.start.min(other.start)..one.end.max(other.end)).unwrap_or(0..0)
    }

    /// Power, and the values of registers, timers and counters, in what is shown.
    pub(super) fn elements(
        &self,
        place: Place<'_>,
        code: &Code,
        sights: &[Sight<u8>],
        machine: &Machine<u8>,
    ) -> Vec<Json> {
        let mut elements = Vec::new();
        for window in &self.windows {
            for shown in power_flow(place.document, self.document, code, sights, window.clone()) {
                let (kind, conducts) = match shown.kind {
                    EnergisedKind::Wire => ("wire", None),
                    EnergisedKind::Contact(conducts) => ("contact", Some(conducts)),
                    EnergisedKind::Output => ("output", None),
                    EnergisedKind::Line => ("line", None),
                };
                let mut element =
                    json!({ "range": place.range(shown.span), "kind": kind, "energised": shown.energised });
                if let Some(conducts) = conducts {
                    element["conducts"] = conducts.into();
                }
                elements.push(element);
            }
            elements.extend(words(place, window, machine));
            elements.extend(forced(place, self.document, window, code, machine));
        }
        elements
    }

    /// The values of these names, or of those that are watched.
    pub(super) fn values(&self, names: Option<Vec<String>>, machine: &Machine<u8>) -> Vec<Json> {
        let names = names.as_deref().unwrap_or(&self.names).iter();
        let known = names.filter_map(|name| {
            let variable = machine.code().variable(name)?;
            let value = machine.value(variable, 0);
            let mut known =
                json!({ "device": name, "value": value.json(), "forced": machine.is_forced(variable) });
            let wired = machine.wired(variable).map(|wired| wired.lane(0));
            if let Some(wired) = wired.filter(|wired| Some(*wired) != value.as_bit()) {
                known["wired"] = wired.into();
            }
            Some(known)
        });
        known.collect()
    }
}

/// The values of words, beside the operands that name them.
fn words(place: Place<'_>, window: &Bytes<usize>, machine: &Machine<u8>) -> Vec<Json> {
    let mut elements = Vec::new();
    let layout = &machine.code().layout;
    let shown = place.document.chunks().skip_while(|at| at.start < window.start);
    for at in shown.take_while(|at| at.start < window.end) {
        let reading = at.chunk.reading();
        for operand in reading.operations().flat_map(|operation| operation.operands) {
            let Operand::Device(device) = operand.value else { continue };
            let Some(slot) = layout.slot(device) else { continue };
            elements.push(json!({
                "range": place.range(operand.span.shifted(at.start)),
                "kind": "value",
                "energised": false,
                "value": machine.value(Variable::Word(slot), 0).json(),
            }));
        }
    }
    elements
}
