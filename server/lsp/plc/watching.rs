//! What of a program in a PLC is on the screen: the devices there are watched, and power is computed from their values.

use super::super::alarms::Watchman;
use super::super::simulation::{Monitor, Picture, compiled, files_around, panel_rows};
use super::super::to_proto::Place;
use super::super::workspace::Workspace;
use super::drift::{encoded, not_open};
use super::recording::SharedRecording;
use crate::document::Document;
use crate::link::{
    Comparison, Holds, Host, LinkError, Mode, NamesOfPlc, Part, Point, Status, Transport, Watch,
};
use crate::machine_code::Image;
use crate::simulate::{Code, Machine, Names, Value, Variable};
use crate::target::{Device, Flow, Operand, Target};
use crate::text::{Message, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use serde_json::{Value as Json, json};
use std::collections::BTreeSet;
use std::sync::Arc;
use tower_lsp::ls_types::{Range, Uri};

/// A program that is watched in a PLC.
pub(super) struct Watching {
    uri: Uri,
    files: Vec<(Uri, i32, Document)>,
    code: Option<Arc<Code>>,
    monitor: Monitor,
    names: Vec<String>,
    /// What of the names can be read.
    known: Vec<(String, Point)>,
    alarms: Watchman<Point>,
    /// What is held at which values.
    pub(super) holds: Holds,
    recording: SharedRecording,
    /// What the recording wanted last.
    recorded: Vec<String>,
    watch: Watch,
    /// Which variable of the code each point is.
    variables: Vec<Option<Variable>>,
    /// What was read last.
    values: FxHashMap<Point, Value>,
    /// The program in a PLC that has what was read, for what contacts of edges saw before.
    machine: Option<Machine<u8>>,
    looks: u64,
    /// The text in the memory of this PLC.
    image: Option<Image>,
    /// How far it is compared with what is there.
    comparison: Option<Comparison>,
    /// Whether something else is there, although its sum is the same.
    is_other: bool,
    /// Bytes of rungs that depend on something that is not read.
    unknown: Vec<std::ops::Range<usize>>,
    edition: u64,
    /// When the first look was, and the last one.
    started_ns: Option<i64>,
    now_ns: i64,
}

/// The longest list of devices; each 64 bytes of values are an exchange of their own.
const MOST_POINTS: usize = 400;

impl Watching {
    /// Nothing of this program yet.
    pub(super) fn new(uri: Uri, recording: SharedRecording) -> Watching {
        Watching {
            uri,
            files: Vec::new(),
            code: None,
            monitor: Monitor::default(),
            names: Vec::new(),
            known: Vec::new(),
            alarms: Watchman::new("plc"),
            holds: Holds::default(),
            recording,
            recorded: Vec::new(),
            watch: Watch::default(),
            variables: Vec::new(),
            values: FxHashMap::default(),
            machine: None,
            looks: 0,
            image: None,
            comparison: None,
            is_other: false,
            unknown: Vec::new(),
            edition: 0,
            started_ns: None,
            now_ns: 0,
        }
    }

    /// The document.
    pub(super) fn uri(&self) -> &Uri {
        &self.uri
    }

    /// Shows other ranges, or other names; what is not given stays.
    pub(super) fn watch(&mut self, ranges: Option<Vec<Range>>, names: Option<Vec<String>>) {
        if let Some(names) = &names {
            self.names = names.clone();
        }
        self.monitor.watch(ranges, names);
    }

    /// Takes over the text as it is now, and finds what is to be read.
    ///
    /// # Errors
    /// If the program has no FX devices, or names what the PLC does not have.
    pub(super) fn follow(
        &mut self,
        workspace: &Workspace,
        target: &'static Target,
        status: &Status,
    ) -> Result<(), Message> {
        let gone = || not_open(&self.uri);
        let files = files_around(workspace, &self.uri).ok_or_else(gone)?;
        let is_known = |(uri, _, document): &(Uri, i32, Document)| {
            self.files.iter().any(|(known, _, before)| known == uri && is_same(document, before))
        };
        let is_another = files.len() != self.files.len() || !files.iter().all(is_known);
        self.edition += u64::from(is_another);
        self.files = files;
        let number = self.number().ok_or_else(gone)?;
        let document = &self.files[number].2;
        if !document.target().is_fx() {
            return Err(Message::new("link.no-monitor-iec"));
        }
        self.monitor.place(number as u32, Place::new(document, workspace.snapshot().manner));
        // A text that cannot be run, or is not what the PLC runs, shows values, and no power.
        let encoded = encoded(workspace, &self.uri).ok();
        let image = encoded.and_then(|encoded| Image::new(status.parameters, &encoded.words));
        if image != self.image {
            (self.image, self.comparison, self.is_other) = (image, None, false);
        }
        self.code = compiled(&self.files, true).ok();
        self.unknown.clear();
        let names = NamesOfPlc(target);
        let named = self.names.iter().filter_map(|name| Some((name.clone(), names.variable(name)?)));
        self.known = named.collect();
        self.alarms.follow(workspace, &self.uri, &names);
        self.recorded = self.recording.wanted();
        let mut points: Vec<Point> = self.holds.held().iter().map(|(point, _)| *point).collect();
        points.extend(self.known.iter().map(|(_, point)| *point));
        points.extend(self.alarms.variables());
        points.extend(self.recorded.iter().filter_map(|name| names.variable(name)));
        // What was asked for by name is read in any case.
        let most = MOST_POINTS.max(points.len());
        points.extend(self.shown().filter(|point| point.is_reached(target)));
        let mut seen = FxHashSet::default();
        points.retain(|point| seen.insert(*point));
        if points.len() > most {
            points.truncate(most);
            // More than is read: what is shown depends on something that is not.
            self.unknown.push(0..usize::MAX);
        }
        let code = self.code.as_ref();
        let variable = |point: &Point| code.and_then(|code| code.variable(&point.to_string()));
        self.variables = points.iter().map(variable).collect();
        self.watch = Watch::new(points);
        self.machine = None;
        Ok(())
    }

    /// What the text on the screen depends on; notes which rungs of it depend on something that is not read.
    fn shown(&mut self) -> impl Iterator<Item = Point> + use<> {
        let number = self.number();
        let mut shown = BTreeSet::new();
        for (file, (_, _, document)) in self.files.iter().enumerate() {
            let is_own = Some(file) == number;
            for at in document.chunks() {
                let span = at.start..at.start + at.chunk.len();
                let is_shown = is_own && self.monitor.shows(&span);
                let reading = at.chunk.reading();
                // Power in what is shown depends on the sections and steps around it.
                let is_wanted = is_shown
                    || reading.operations().any(|operation| {
                        let flow = operation.form.map(|form| form.instruction.flow());
                        flow.is_some_and(|flow| {
                            !matches!(flow, Flow::Straight | Flow::Nothing | Flow::ProgramEnd)
                        })
                    });
                let is_known = |operation: crate::document::Operation<'_>| {
                    let operands = operation.operands.iter();
                    !operands.clone().any(|operand| is_computed(&operand.value))
                };
                if is_shown && !reading.operations().all(is_known) {
                    self.unknown.push(span);
                }
                if is_wanted {
                    shown.extend(reading.operations().flat_map(|operation| devices(operation.operands)));
                }
            }
        }
        shown.into_iter().flat_map(points_of)
    }

    fn number(&self) -> Option<usize> {
        self.files.iter().position(|(file, ..)| *file == self.uri)
    }

    /// Whether the editor still has the document.
    pub(super) fn is_open(&self, workspace: &Workspace) -> bool {
        workspace.snapshot().open(&self.uri).is_some_and(|open| open.is_open)
    }

    /// Whether what is read is what is to be read.
    fn is_up_to_date(&self, workspace: &Workspace) -> bool {
        let is_as_read = |(uri, version, document): &(Uri, i32, Document)| {
            let snapshot = workspace.snapshot();
            snapshot
                .open(uri)
                .is_none_or(|open| open.version == *version && is_same(&open.document, document))
        };
        let is_read = |(point, _): &(Point, i64)| self.watch.points().contains(point);
        self.files.iter().all(is_as_read)
            && !self.alarms.is_outdated(workspace, &self.uri)
            && self.recorded == self.recording.wanted()
            && self.holds.held().iter().all(is_read)
    }

    /// Takes over what has changed in the editor.
    ///
    /// # Errors
    /// See [`Watching::follow`].
    pub(super) fn keep_up(
        &mut self,
        workspace: &Workspace,
        target: &'static Target,
        status: &Status,
    ) -> Result<(), Message> {
        if self.is_up_to_date(workspace) { Ok(()) } else { self.follow(workspace, target, status) }
    }

    /// Compares the text with what is in the PLC, a piece in each look, where their sums are the same; gives what is
    /// there once that is known to be the text.
    ///
    /// # Errors
    /// If the line fails.
    pub(super) fn compare<T: Transport>(
        &mut self,
        host: &mut Host<T>,
        status: &Status,
    ) -> Result<Option<Image>, LinkError> {
        let sum = status.parameters.sum();
        let Some(own) = self.image.as_ref().filter(|own| own.parameters().sum() == sum) else {
            (self.comparison, self.is_other) = (None, false);
            return Ok(None);
        };
        if self.is_other {
            return Ok(None);
        }
        let compared = match host.compare(self.comparison.get_or_insert_with(|| Comparison::new(own))) {
            // What nobody may read is not known to be the same.
            Err(LinkError::Refused { .. }) => Some(false),
            compared => compared?,
        };
        let Some(is_same) = compared else { return Ok(None) };
        (self.comparison, self.is_other) = (None, !is_same);
        Ok(is_same.then(|| own.clone()))
    }

    /// Whether the PLC executes the text, where `held` is known to be in its memory.
    fn is_executed(&self, status: &Status, held: Option<&Image>) -> bool {
        let is_text = |held: &&Image| self.image.as_ref().is_some_and(|own| own.program() == held.program());
        let held = held.filter(is_text);
        status.mode == Mode::Run
            && held.is_some_and(|held| held.parameters().sum() == status.parameters.sum())
    }

    /// Reads what is watched, if somebody has a use for it, and writes again what is held; whether that was so.
    ///
    /// # Errors
    /// If the line fails.
    pub(super) fn look<T: Transport>(
        &mut self,
        host: &mut Host<T>,
        workspace: &Workspace,
    ) -> Result<bool, LinkError> {
        let target = host.identity().target;
        let is_unwatched = self.monitor.is_empty() && self.alarms.is_empty();
        if is_unwatched && self.recorded.is_empty() && self.holds.held().is_empty() {
            return Ok(false);
        }
        let numbers = host.poll(&mut self.watch)?;
        self.now_ns = host.line().now().as_nanos() as i64;
        if self.started_ns.is_none() {
            self.started_ns = Some(self.now_ns);
            let most = workspace.snapshot().open(&self.uri).and_then(|open| open.manifest.monitor.record);
            self.recording.begin(target, most);
        }
        self.looks += 1;
        let points = self.watch.points().iter();
        self.values = points.zip(numbers).map(|(point, number)| (*point, point.value(number))).collect();
        let read = &self.values;
        self.recording.note(self.time_ns(), read.iter().map(|(point, value)| (*point, value)));
        self.alarms.look(self.time_ns(), &|point| read.get(&point).cloned().unwrap_or(point.value(0)));
        self.holds.rewrite(host, &|point| point.number(read.get(&point)?))?;
        Ok(true)
    }

    /// The time since the first look, in nanoseconds.
    fn time_ns(&self) -> i64 {
        self.started_ns.map_or(0, |started| self.now_ns - started)
    }

    /// Tells which alarms are raised or gone.
    pub(super) fn tell_alarms(&mut self, tokio: &tokio::runtime::Handle, workspace: &Workspace) {
        self.alarms.tell(tokio, workspace, &self.uri);
    }

    /// Nobody watches any more: its alarms are told as gone, and what was held is given.
    pub(super) fn end(&mut self, tokio: &tokio::runtime::Handle, workspace: &Workspace) -> Vec<(Point, i64)> {
        self.alarms.end(self.time_ns());
        self.tell_alarms(tokio, workspace);
        self.holds.release_all()
    }

    /// What belongs on a panel of the program, and of what is named besides, as far as the port reaches it; see
    /// `rungwise.simulate.panel` for the JSON.
    ///
    /// # Errors
    /// If the text cannot be run.
    pub(super) fn panel(
        &self,
        workspace: &Workspace,
        target: &'static Target,
        more: &[String],
    ) -> Result<Json, Message> {
        let gone = || not_open(&self.uri);
        let code = compiled(&self.files, false)?;
        let snapshot = workspace.snapshot();
        let around = snapshot.around(snapshot.open(&self.uri).ok_or_else(gone)?);
        let names = NamesOfPlc(target);
        let mut rows = panel_rows(&around.view(), &Machine::new(code), more);
        rows.retain(|row| row["name"].as_str().is_some_and(|name| names.variable(name).is_some()));
        Ok(json!({ "rows": rows }))
    }

    /// What the client is to show of the last look; `held` is what is known to be in the PLC.
    pub(super) fn picture(
        &mut self,
        workspace: &Workspace,
        status: &Status,
        held: Option<&Image>,
    ) -> Option<Picture> {
        let is_executed = self.is_executed(status, held);
        let mode = status.mode;
        let (_, version, document) = &self.files[self.number()?];
        let place = Place::new(document, workspace.snapshot().manner);
        let mut elements = Vec::new();
        if let Some(code) = &self.code {
            let machine = self.machine.get_or_insert_with(|| Machine::new(Arc::clone(code)));
            let read = self.variables.iter().zip(self.watch.points());
            let read =
                read.filter_map(|(variable, point)| Some(((*variable)?, self.values.get(point)?.clone())));
            machine.hold_only(read);
            let shown = self.monitor.instructions(code);
            let mut sights = Vec::new();
            // No power flows in a program that is not executed, as far as anybody knows.
            if is_executed {
                let time_ns = self.started_ns.map_or(0, |started| self.now_ns - started);
                machine.scan_watched(time_ns, &mut |sight| {
                    if shown.contains(&sight.instruction) {
                        sights.push(sight);
                    }
                    true
                });
            }
            elements = self.monitor.elements(place, code, &sights, machine);
            if !self.holds.held().is_empty() {
                let held = |variable| {
                    let at = self.variables.iter().position(|own| *own == Some(variable))?;
                    let point = *self.watch.points().get(at)?;
                    self.holds.of(point).map(|number| point.value(number))
                };
                elements.extend(self.monitor.forced(place, code, &held));
            }
            let unknown: Vec<Range> = self
                .unknown
                .iter()
                .map(|bytes| place.range(Span::new(bytes.start, bytes.end.min(document.len()))))
                .collect();
            elements.retain(|element| {
                let line = element["range"]["start"]["line"].as_u64().unwrap_or(0) as u32;
                element["kind"] == "value"
                    || element["kind"] == "forced"
                    || !unknown.iter().any(|range| range.start.line <= line && line < range.end.line.max(1))
            });
        }
        let values = self.known.iter().filter_map(|(name, point)| {
            let value = self.values.get(point)?.json();
            Some(json!({ "device": name, "value": value, "forced": self.holds.of(*point).is_some() }))
        });
        Some(Picture {
            uri: self.uri.clone(),
            version: *version,
            source: "plc",
            mode: if mode == Mode::Run { "running" } else { "stopped" },
            scan: self.looks - 1,
            time_ms: self.time_ns() as f64 / 1e6,
            edition: self.edition,
            branch: self.recording.branch(),
            exchanges: self.watch.exchanges(),
            elements,
            values: values.collect(),
            errors: Vec::new(),
        })
    }
}

/// Whether nothing has changed between two versions of a document: neither the text nor what devices are called.
fn is_same(one: &Document, other: &Document) -> bool {
    one.is_instance(other) && one.comments().symbols() == other.comments().symbols()
}

/// The devices that operands name.
fn devices(operands: &[crate::text::Spanned<Operand>]) -> impl Iterator<Item = Device> {
    operands.iter().filter_map(|operand| match operand.value {
        Operand::Device(device) => Some(device),
        _ => None,
    })
}

/// What is read of a device: of timers and counters the contact, the coil and the current value.
fn points_of(device: Device) -> Vec<Point> {
    match device.kind.has_preset() {
        true => vec![Point::Bit(device, Part::Contact), Point::Bit(device, Part::Coil), Point::Word(device)],
        false => Point::of_device(device).into_iter().collect(),
    }
}

/// Whether which devices an operand reads depends on its digits or an index: those are not read.
fn is_computed(operand: &Operand) -> bool {
    matches!(operand, Operand::Indexed { .. } | Operand::Nibbles { .. })
}
