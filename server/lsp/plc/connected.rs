//! The PLC at the other end of the line, and what is done with it that takes many requests.

use super::super::projects::file_path;
use super::super::workspace::Workspace;
use super::answers::word_of;
use super::desk::{Reply, Way};
use super::drift::{Encoded, encoded};
use super::shown::Shown;
use super::watching::Watching;
use crate::link::{Host, LinkError, Plan, Point, Status, Transport, Uploaded};
use crate::machine_code::{Image, decode, executed};
use crate::project::{Backup, Origin};
use crate::simulate::Value;
use crate::text::Message;
use serde_json::{Value as Json, json};
use std::path::PathBuf;
use std::sync::Arc;
use tower_lsp::ls_types::Uri;

/// The PLC at the other end.
pub(super) struct Connected {
    pub(super) port: String,
    pub(super) host: Host<Box<dyn Transport>>,
    pub(super) status: Status,
    /// What is in its program memory, as far as that was read.
    pub(super) image: Option<Image>,
    /// The last download that somebody was shown and that was not begun.
    pub(super) shown: Option<Preview>,
    pub(super) watching: Option<Watching>,
}

/// A download as somebody has seen it.
pub(super) struct Preview {
    uri: Uri,
    pub(super) plan: Plan,
    /// The backup of what an earlier download began to replace.
    last: Option<PathBuf>,
}

impl Connected {
    pub(super) fn plan(
        &mut self,
        workspace: &Workspace,
        uri: &Uri,
        shown: &Shown<'_>,
    ) -> Result<(Encoded, Preview), Message> {
        let encoded = encoded(workspace, uri)?;
        self.shown = None;
        let last = file_path(uri).and_then(|path| Backup::latest(&path));
        let replaced = last.as_ref().and_then(|(_, backup)| backup.replaced());
        let (words, target) = (&encoded.words, encoded.target);
        let plan = self.host.plan_behind(replaced, words, target, &mut |progress| shown.report(progress));
        let plan = plan.map_err(|error| told(&error))?;
        let plan = with_parameters(plan, workspace, uri);
        self.image = Some(plan.before.clone());
        let last = last.map(|(path, _)| path);
        Ok((encoded, Preview { uri: uri.clone(), plan, last }))
    }

    /// The download that was shown, if it is still what the text says.
    fn previewed(
        &mut self,
        workspace: &Workspace,
        uri: &Uri,
        sum: &str,
    ) -> Option<Result<(Encoded, Preview), Message>> {
        let is_that = |shown: &Preview| shown.uri == *uri && format!("{:04X}", shown.plan.found) == sum;
        let preview = self.shown.take_if(|shown| is_that(shown))?;
        let encoded = match encoded(workspace, uri) {
            Ok(encoded) => encoded,
            Err(reason) => return Some(Err(reason)),
        };
        let plan = &preview.plan;
        let is_same = encoded.target.model == plan.model
            && executed(&encoded.words) == plan.wanted.program()
            && with_parameters(plan.clone(), workspace, uri).wanted == plan.wanted;
        Some(is_same.then_some((encoded, preview)).ok_or_else(|| Message::new("link.changed-since-shown")))
    }

    pub(super) fn download(
        &mut self,
        workspace: &Workspace,
        uri: &Uri,
        is_started: bool,
        sum: Option<&str>,
        shown: &Shown<'_>,
    ) -> Reply {
        let previewed = sum.and_then(|sum| self.previewed(workspace, uri, sum));
        let (encoded, preview) = previewed.unwrap_or_else(|| self.plan(workspace, uri, shown))?;
        let Preview { plan, last, .. } = preview;
        if sum.is_some_and(|sum| sum != format!("{:04X}", plan.found)) {
            return Err(told(&LinkError::Changed));
        }
        // What changes nothing leaves nothing to go back to.
        let backup = match plan.bytes() {
            0 => None,
            _ => {
                let path = file_path(uri).ok_or_else(|| Message::new("link.save-first"))?;
                let identity = self.host.identity();
                let from = Origin {
                    target: identity.target,
                    port: &self.port,
                    version: identity.version(),
                    replaced_by: plan.wanted.parameters().sum(),
                };
                let kept = Backup::keep(&path, &from, (&plan.before, plan.is_whole));
                Some(kept.map_err(|error| Message::new("link.cannot-back-up").with("reason", error))?)
            }
        };
        let report = self.host.download(&plan, is_started, &mut |progress| shown.report(progress));
        match report {
            Ok(report) => {
                self.image = Some(plan.wanted);
                let known = [backup.as_deref(), last.as_deref()];
                // One that still says otherwise is only read more carefully.
                let _ = Backup::note_end(known.into_iter().flatten());
                Ok(json!({
                    "written": report.written,
                    "compared": report.compared,
                    "steps": encoded.words.len(),
                    "mode": word_of(report.mode),
                    "backup": backup.map(|path| path.display().to_string()),
                }))
            }
            Err(failure) => {
                self.image = None;
                let [program, mode] = failure.state();
                let reasons = vec![failure.cause.message(), program, mode, failure.cause.help()];
                Err(Message::new("link.failed").with_messages("reasons", reasons))
            }
        }
    }

    pub(super) fn upload(&mut self, shown: &Shown<'_>) -> Reply {
        let Uploaded { image, is_whole } =
            self.host.upload(&mut |progress| shown.report(progress)).map_err(|error| told(&error))?;
        let target = self.host.identity().target;
        let listing = decode(image.program(), target.model);
        let unread = listing.lines.iter().filter(|line| !line.is_read).count();
        let answer = json!({
            "text": listing.text,
            "model": target.name,
            "steps": image.program().len(),
            "unread": unread,
            "whole": is_whole,
        });
        self.image = Some(image);
        Ok(answer)
    }

    pub(super) fn write(&mut self, name: &str, value: &Json, way: Way) -> Result<(), Message> {
        let point = self.point(name)?;
        if way == Way::Force && !point.is_bit() {
            return Err(Message::new("link.no-relay").with("device", name));
        }
        let wrong = || Message::new("link.no-value").with("device", name).with("value", value);
        let value = Value::of_json(value).ok_or_else(wrong)?;
        let number = point.number(&value).ok_or_else(wrong)?;
        let written = match (way, &mut self.watching) {
            (Way::Hold, Some(watching)) => watching.holds.hold(&mut self.host, point, number),
            (Way::Hold, None) => return Err(Message::new("link.not-monitored")),
            _ => self.host.write(point, number),
        };
        written.map_err(|error| told(&error))
    }

    pub(super) fn release(&mut self, name: &str) -> Result<(), Message> {
        let point = self.point(name)?;
        if let Some(watching) = &mut self.watching {
            watching.holds.release(point);
        }
        Ok(())
    }

    fn point(&self, name: &str) -> Result<Point, Message> {
        let unknown = || match name.trim() {
            "" => Message::new("link.nameless"),
            name => Message::new("link.no-device").with("device", name),
        };
        Point::named(name, self.host.identity().target).ok_or_else(unknown)
    }
}

/// The plan with the parameters that the project of the program names.
fn with_parameters(plan: Plan, workspace: &Workspace, uri: &Uri) -> Plan {
    let manifest = workspace.snapshot().open(uri).map(|open| Arc::clone(&open.manifest));
    let model = plan.model;
    plan.with_parameters(|own| manifest.map_or(own, |manifest| manifest.plc.applied(own, model)))
}

/// What went wrong on the line, and what helps.
pub(super) fn told(error: &LinkError) -> Message {
    Message::new("link.failed").with_messages("reasons", vec![error.message(), error.help()])
}
