//! The notification `rungwise/monitor`: what of a program that runs is on the screen.

use super::super::to_proto::Place;
use super::forced::forced;
use crate::document::Tree;
use crate::ide;
use crate::il::iec::{ItemKind, ParameterValue, Run};
use crate::simulate::{Code, EnergisedKind, Lanes, Machine, Sight, Value, Variable, power_flow};
use crate::target::Operand;
use crate::text::Span;
use serde::{Deserialize, Serialize};
use serde_json::{Value as Json, json};
use std::ops::Range as Bytes;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::{Range, Uri};

/// The method.
pub(in crate::lsp) enum MonitorMethod {}

impl Notification for MonitorMethod {
    type Params = Picture;
    const METHOD: &'static str = "rungwise/monitor";
}

/// The parameters.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub(in crate::lsp) struct Picture {
    pub(in crate::lsp) uri: Uri,
    pub(in crate::lsp) version: i32,
    #[serde(skip_deserializing)]
    pub(in crate::lsp) source: &'static str,
    #[serde(skip_deserializing)]
    pub(in crate::lsp) mode: &'static str,
    pub(in crate::lsp) scan: u64,
    pub(in crate::lsp) time_ms: f64,
    pub(in crate::lsp) edition: u64,
    pub(in crate::lsp) branch: u64,
    /// How many moments the values are of: exchanges on the line to a PLC.
    pub(in crate::lsp) exchanges: u64,
    pub(in crate::lsp) elements: Vec<Json>,
    pub(in crate::lsp) values: Vec<Json>,
    pub(in crate::lsp) errors: Vec<Json>,
}

/// What the client shows.
#[derive(Default)]
pub(in crate::lsp) struct Monitor {
    ranges: Vec<Range>,
    names: Vec<String>,
    /// The ranges as bytes of the document, whole chunks each.
    windows: Vec<Bytes<usize>>,
    document: u32,
}

impl Monitor {
    /// Whether nothing is shown.
    pub(in crate::lsp) fn is_empty(&self) -> bool {
        self.ranges.is_empty() && self.names.is_empty()
    }

    /// Whether lines of the text are shown.
    pub(in crate::lsp) fn has_text(&self) -> bool {
        !self.ranges.is_empty()
    }

    /// Shows other ranges, or other names; what is not given stays.
    pub(in crate::lsp) fn watch(&mut self, ranges: Option<Vec<Range>>, names: Option<Vec<String>>) {
        self.ranges = ranges.unwrap_or_else(|| std::mem::take(&mut self.ranges));
        self.names = names.unwrap_or_else(|| std::mem::take(&mut self.names));
    }

    /// Finds the bytes that are shown.
    pub(in crate::lsp) fn place(&mut self, number: u32, place: Place<'_>) {
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

    /// Whether something of these bytes is shown.
    pub(in crate::lsp) fn shows(&self, bytes: &Bytes<usize>) -> bool {
        self.windows.iter().any(|window| bytes.start < window.end && window.start < bytes.end)
    }

    /// The instructions that are shown.
    pub(in crate::lsp) fn instructions(&self, code: &Code) -> Bytes<u32> {
        let all = self.windows.iter().map(|window| code.instructions_in(self.document, window.clone()));
        all.reduce(|one, other| one.start.min(other.start)..one.end.max(other.end)).unwrap_or(0..0)
    }

    /// Power, and the values of registers, timers and counters, in what is shown.
    pub(in crate::lsp) fn elements(
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
        }
        elements
    }

    /// The marks of what is forced, in what is shown.
    pub(in crate::lsp) fn forced(
        &self,
        place: Place<'_>,
        code: &Code,
        held: &impl Fn(Variable) -> Option<Value>,
    ) -> Vec<Json> {
        self.windows.iter().flat_map(|window| forced(place, window, code, held)).collect()
    }

    /// The values of these names, or of those that are watched.
    pub(in crate::lsp) fn values(&self, names: Option<Vec<String>>, machine: &Machine<u8>) -> Vec<Json> {
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
    let code = machine.code();
    let shown = place.document.chunks().skip_while(|at| at.start < window.start);
    for at in shown.take_while(|at| at.start < window.end) {
        let reading = at.chunk.reading();
        let mut show = |span: Span, variable: Variable| {
            let value = match machine.value(variable, 0) {
                // As programs spell it: milliseconds would look like a number.
                value @ (Value::Time(_) | Value::Text(_)) => value.to_string().into(),
                value => value.json(),
            };
            elements.push(json!({
                "range": place.range(span.shifted(at.start)),
                "kind": "value",
                "energised": false,
                "value": value,
            }));
        };
        if code.target.is_fx() {
            for operand in reading.operations().flat_map(|operation| operation.operands) {
                let Operand::Device(device) = operand.value else { continue };
                let word = code.layout.slot(device).map(Variable::Word);
                word.into_iter().for_each(|word| show(operand.span, word));
            }
            continue;
        }
        let unit = unit_at(place, at.start);
        for span in operands(reading.tree()) {
            let word = span.of(reading.text());
            // Of an instance that is called what it counts.
            let counted =
                || ["ET", "CV"].into_iter().find_map(|pin| code.variable_at(unit, &format!("{word}.{pin}")));
            let variable = code.variable_at(unit, word).or_else(counted);
            let is_word = |own: &Variable| matches!(own, Variable::Typed(_) | Variable::Enumerated(..));
            variable.filter(is_word).into_iter().for_each(|word| show(span, word));
        }
    }
    elements
}

/// The name of the program unit at an offset; empty outside of all.
pub(super) fn unit_at(place: Place<'_>, offset: usize) -> &str {
    let unit = ide::pou_at(place.document, offset);
    unit.and_then(|number| place.document.scopes().pous.get(number)).map_or("", |unit| &unit.name)
}

/// Where operands of instructions and of drawn elements stand.
fn operands(tree: &Tree) -> Vec<Span> {
    match tree {
        Tree::Ladder(tree) => {
            let elements = tree.rungs.iter().flat_map(|rung| &rung.graph.elements);
            elements.flat_map(|element| &element.operands).map(|operand| operand.span).collect()
        }
        Tree::Iec(tree) => {
            let own = tree.items.iter().flat_map(|item| {
                let (first, parameters) = match item.kind {
                    ItemKind::Operation { operand, .. } | ItemKind::Open { operand, .. } => {
                        (operand, Run::default())
                    }
                    ItemKind::Call { callee, parameters, .. } => (callee, parameters),
                    ItemKind::InputOperator { instance, .. } => (Some(instance), Run::default()),
                    ItemKind::Function { parameters, .. } => (None, parameters),
                    _ => (None, Run::default()),
                };
                let handed = parameters.of(&tree.parameters).iter().filter_map(|given| match given.value {
                    ParameterValue::Operand(id) => Some(id),
                    ParameterValue::Instructions | ParameterValue::Missing => None,
                });
                first.into_iter().chain(handed)
            });
            own.map(|id| tree.operand(id).span).collect()
        }
        Tree::Fx(_) => Vec::new(),
    }
}
