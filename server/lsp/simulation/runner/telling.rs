//! What a simulation tells of the program that it runs.

use super::super::super::projects::file_path;
use super::super::super::to_proto::{Manner, Place};
use super::super::super::workspace::Workspace;
use super::super::monitor::{Monitor, Picture};
use super::super::{chart, panel, why};
use super::program::around;
use super::{About, PICTURE, Question, Reply, Running};
use crate::document::Document;
use crate::scenario::Bench;
use crate::simulate::{Code, Drivers, Inquiry};
use crate::text::{Language, Message};
use serde_json::{Value as Json, json};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tower_lsp::ls_types::Uri;

/// So long the history is looked through for one answer to why, while scans wait.
const PATIENCE: Duration = Duration::from_millis(1_000);
/// The same for the short one, which a hover begins with.
const BRIEF_PATIENCE: Duration = Duration::from_millis(100);

impl Running {
    /// Answers a question.
    pub(super) fn answer(&mut self, question: Question, workspace: &Workspace, uri: &Uri) -> Reply {
        let around = || around(workspace, uri).ok_or_else(|| Message::new("simulate.not-running"));
        let (names, more) = match question {
            Question::State { names } => (names, None),
            Question::Watch { ranges, names } => {
                self.screens.of_mut(uri).watch(ranges, names);
                // What was seen was of other lines.
                self.sights.clear();
                self.is_news = true;
                self.locate(workspace);
                (None, None)
            }
            Question::Panel { more } => {
                let rows = panel::rows(&around()?.view(), self.session.machine(), &more);
                (None, Some(json!({ "rows": rows })))
            }
            Question::Trace { wanted } => {
                (None, Some(chart::changes(&mut self.recorder, &self.session, &wanted)))
            }
            Question::Export { wanted, format } => {
                (None, Some(chart::file(&self.session, &around()?.view(), &wanted, &format)?))
            }
            Question::Record { names } => {
                let language = workspace.snapshot().manner.language;
                return self.record(uri, &names.unwrap_or_default(), language);
            }
            Question::Why { about, scan, is_brief } => {
                return self.why(workspace, uri, about, scan, is_brief);
            }
        };
        let mut state = self.state(workspace, uri, names);
        if let (Some(state), Some(Json::Object(more))) = (state.as_object_mut(), more) {
            state.extend(more);
        }
        Ok(state)
    }

    /// What was done since the program began as a scenario test.
    fn record(&self, uri: &Uri, names: &[String], language: Language) -> Reply {
        if self.recording.is_empty() {
            return Err(Message::new("scenario.recorded-nothing"));
        }
        let documents: Vec<&Document> = self.files.iter().map(|(_, _, document)| document).collect();
        let bench = Bench::new(&documents).map_err(|_| Message::new("simulate.not-running"))?;
        let path = file_path(uri);
        let name =
            path.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned());
        let name =
            name.unwrap_or_else(|| uri.path().as_str().rsplit('/').next().unwrap_or_default().to_string());
        let length = (self.session.machine().scans(), self.scan_ns);
        let recorded = self.recording.written((&name, &bench), length, names, language);
        Ok(json!({ "uri": uri, "name": recorded.name, "text": recorded.text }))
    }

    pub(super) fn mode(&self) -> &'static str {
        match (self.is_over, self.is_paused) {
            (true, _) => "stopped",
            (false, true) => "paused",
            (false, false) => "running",
        }
    }

    /// What the client is to show of each file, if it is time for that.
    pub(super) fn pictures(&mut self, workspace: &Workspace) -> Vec<Picture> {
        let is_time = self.is_over || self.since_picture() >= PICTURE;
        if !self.is_news || !is_time || self.screens.shown().next().is_none() {
            return Vec::new();
        }
        (self.is_news, self.shown) = (false, Some(Instant::now()));
        let has_text = self.screens.has_text() && !self.is_outdated;
        let watched = match has_text {
            true => self.watched(),
            false => Arc::clone(self.session.machine().code()),
        };
        if has_text && self.sights.is_empty() {
            let scans = self.session.machine().scans();
            self.sights = self.session.sights(scans, &watched).unwrap_or_default();
        }
        let manner = workspace.snapshot().manner;
        let shown = self.screens.shown();
        shown.filter_map(|(uri, monitor)| self.picture(uri, monitor, &watched, manner)).collect()
    }

    fn picture(&self, uri: &Uri, monitor: &Monitor, watched: &Code, manner: Manner) -> Option<Picture> {
        let number = self.files.iter().position(|(file, ..)| file == uri)?;
        let (_, version, document) = &self.files[number];
        let place = Place::new(document, manner);
        let machine = self.session.machine();
        let elements = match self.is_outdated {
            true => Vec::new(),
            false => {
                let mut elements = monitor.elements(place, watched, &self.sights, machine);
                if machine.is_any_forced() {
                    let held = |own| machine.is_forced(own).then(|| machine.value(own, 0));
                    elements.extend(monitor.forced(place, watched, &held));
                }
                elements
            }
        };
        Some(Picture {
            uri: uri.clone(),
            version: *version,
            source: "simulator",
            mode: self.mode(),
            scan: machine.scans().saturating_sub(1),
            time_ms: machine.now_ns() as f64 / 1e6,
            edition: self.edition,
            branch: self.branch,
            exchanges: 1,
            elements,
            values: monitor.values(None, machine),
            errors: self.errors_of(place, number as u32),
        })
    }

    /// Why a device is on or off after a scan, or now.
    fn why(
        &mut self,
        workspace: &Workspace,
        uri: &Uri,
        about: About,
        scan: Option<u64>,
        is_brief: bool,
    ) -> Reply {
        let gone = || Message::new("simulate.not-running");
        if self.is_outdated {
            return Err(Message::new("why.outdated"));
        }
        let watched = self.watched();
        let number = self.files.iter().position(|(file, ..)| file == uri).ok_or_else(gone)?;
        let here = Place::new(&self.files[number].2, workspace.snapshot().manner);
        let name = match about {
            About::Name(name) => name,
            About::At(position) => {
                let name = why::name_at(here.document, here.offset(position));
                name.ok_or_else(|| Message::new("why.no-name"))?
            }
        };
        let begin = self.session.first_scan();
        if scan.is_some_and(|scan| scan < begin) {
            return Err(Message::new("why.forgotten").with("scan", begin));
        }
        let documents: Vec<&Document> = self.files.iter().map(|(_, _, document)| document).collect();
        let drivers = self.drivers.get_or_insert_with(|| Drivers::of(&documents));
        let (asked, patience) = (Instant::now(), if is_brief { BRIEF_PATIENCE } else { PATIENCE });
        let goes_on = || asked.elapsed() < patience;
        let inquiry = Inquiry::new(&self.session, &watched, &documents, drivers).patient(&goes_on);
        let reason = inquiry.why(&name, scan);
        let reason = reason.ok_or_else(|| Message::new("why.unknown").with("name", &name))?;
        Ok(match is_brief {
            true => why::brief(&reason, here.language).into(),
            false => why::told(&reason, &self.files, here),
        })
    }

    pub(super) fn errors_of(&self, place: Place<'_>, number: u32) -> Vec<Json> {
        let own = self.errors.iter().filter_map(|error| {
            let at = error.place.filter(|at| at.document == number)?;
            let message = error.kind.message().render(place.language);
            Some(json!({ "range": place.range(at.span), "message": message }))
        });
        own.collect()
    }

    pub(super) fn state(&self, workspace: &Workspace, uri: &Uri, names: Option<Vec<String>>) -> Json {
        let machine = self.session.machine();
        let unwatched = Monitor::default();
        let monitor = self.screens.of(uri).unwrap_or(&unwatched);
        let number = self.files.iter().position(|(file, ..)| file == uri).unwrap_or(0);
        let errors = self.files.get(number).map(|(_, _, document)| {
            self.errors_of(Place::new(document, workspace.snapshot().manner), number as u32)
        });
        json!({
            "uri": uri,
            "files": self.files.iter().map(|(file, ..)| file).collect::<Vec<_>>(),
            "mode": self.mode(),
            "scan": machine.scans().saturating_sub(1),
            "first_scan": self.session.first_scan().saturating_sub(1),
            "time_ms": machine.now_ns() as f64 / 1e6,
            "scan_ms": self.scan_ns as f64 / 1e6,
            "speed": self.speed,
            "edition": self.edition,
            "branch": self.branch,
            "forced": machine.forced(),
            "values": monitor.values(names, machine),
            "errors": errors,
        })
    }
}
