//! What `rungwise monitor` tells of the program in the PLC.

use super::connection::AnyHost;
use super::status::StatusFormat;
use crate::cli::input::{remark, say};
use crate::link::{Drift, DriftNews, LinkError};
use crate::target::Target;
use crate::text::{Language, Message};
use serde_json::json;
use std::path::Path;
use std::time::Duration;

/// The program in the PLC, beside the devices that are watched.
pub(super) struct ProgramWatch<'a> {
    drift: Drift,
    /// The file that should be there.
    file: Option<&'a Path>,
    /// When it is looked at again.
    due: Duration,
}

/// A program that should be in a PLC: its file, its words, and what they are for.
pub(super) type Wanted<'a> = (&'a Path, Vec<u16>, &'static Target);

/// From one look at a program that is known to the next.
const PAUSE: Duration = Duration::from_secs(1);

impl<'a> ProgramWatch<'a> {
    /// Of the PLC of `host`.
    ///
    /// # Errors
    /// If the program is for another model, or the line fails.
    pub(super) fn new(host: &mut AnyHost, wanted: Option<&Wanted<'a>>) -> Result<Self, LinkError> {
        let mut watch = ProgramWatch { drift: Drift::default(), file: None, due: Duration::ZERO };
        let Some((file, words, target)) = wanted else { return Ok(watch) };
        let found = host.identity().target;
        if found.model != target.model {
            return Err(LinkError::WrongModel { wanted: target.title, found: found.title });
        }
        watch.drift = match host.status() {
            Ok(status) => Drift::from(words, status.parameters),
            Err(LinkError::Refused { .. }) => Drift::unreadable(),
            Err(error) => return Err(error),
        };
        watch.file = Some(file);
        Ok(watch)
    }

    /// Whether another program than that of the file is in the PLC, as far as was seen.
    pub(super) fn is_other(&self) -> bool {
        self.drift.is_same() == Some(false)
    }

    /// How long nothing is to be asked of it.
    pub(super) fn pause(&self) -> Duration {
        if self.drift.is_comparing() { Duration::ZERO } else { PAUSE }
    }

    /// Looks at it if it is time, `time_ns` after the beginning, and tells what is new.
    ///
    /// # Errors
    /// If the line fails.
    pub(super) fn look(
        &mut self,
        host: &mut AnyHost,
        time_ns: i64,
        (format, language): (StatusFormat, Language),
    ) -> Result<(), LinkError> {
        let now = host.line().now();
        if now < self.due && !self.drift.is_comparing() {
            return Ok(());
        }
        self.due = now + PAUSE;
        let Some(news) = host.look_at_program(&mut self.drift)? else { return Ok(()) };
        let text = match format {
            StatusFormat::Json => {
                let sum = self.drift.sum().map(|sum| format!("{sum:04X}"));
                let program = json!({ "same": self.drift.is_same(), "sum": sum });
                json!({ "time_ms": time_ns / 1_000_000, "program": program }).to_string()
            }
            StatusFormat::Text => {
                let told = self.told(news).render(language);
                format!("{:.1} ms  {told}", time_ns as f64 / 1e6)
            }
        };
        say(&format!("{text}\n"));
        Ok(())
    }

    fn told(&self, news: DriftNews) -> Message {
        let key = match news {
            DriftNews::Same => "link.monitor-same",
            DriftNews::Other => "link.monitor-other",
            DriftNews::Changed => "link.monitor-changed",
            DriftNews::Unreadable => "link.monitor-unreadable",
        };
        let sum = self.drift.sum().unwrap_or_default();
        let file = self.file.map(|file| file.display().to_string()).unwrap_or_default();
        Message::new(key).with("sum", format!("{sum:04X}")).with("path", file)
    }

    /// Says so at the end if it was not seen whether the program of the file is there.
    pub(super) fn end(&self, language: Language) {
        if let Some(file) = self.file.filter(|_| self.drift.is_same().is_none()) {
            remark(&Message::new("link.monitor-unknown").with("path", file.display()).render(language));
        }
    }
}
