//! The notification `rungwise/status`, for a status bar:
//! `{"uri", "target": "fx2n", "dialect": "ladder"|"fx"|"iec", "rungs", "steps", "capacity", "connection", "mode"}`.
//! `steps` is `null` and `capacity` 0 where programs are not counted in steps. `connection` is the port of the PLC that
//! is connected and `mode` what its CPU does, `"RUN"` or `"STOP"`; both are `null` while none is.

use super::workspace::{Open, Workspace};
use crate::ide;
use serde::{Deserialize, Serialize};
use tower_lsp::ls_types::Uri;
use tower_lsp::ls_types::notification::Notification;

/// The method.
pub(super) enum StatusMethod {}

impl Notification for StatusMethod {
    type Params = StatusNotification;
    const METHOD: &'static str = "rungwise/status";
}

/// The parameters.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub(super) struct StatusNotification {
    uri: Uri,
    target: String,
    dialect: String,
    rungs: usize,
    steps: Option<u32>,
    capacity: u32,
    #[serde(flatten)]
    line: LineStatus,
}

/// The PLC that is connected, if any.
#[derive(Clone, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
pub(super) struct LineStatus {
    /// Its port.
    pub connection: Option<String>,
    /// What its CPU does.
    pub mode: Option<String>,
}

/// What was told of the line last. Whoever sends a status holds it meanwhile, so that no older line is told behind a
/// newer one.
pub(super) type ToldLine = tokio::sync::Mutex<LineStatus>;

impl StatusNotification {
    /// Of a program, with no PLC connected.
    pub(super) fn of(open: &Open) -> StatusNotification {
        let status = ide::status(&open.document);
        StatusNotification {
            uri: open.uri.clone(),
            target: status.target.to_string(),
            dialect: status.dialect.to_string(),
            rungs: status.rungs,
            steps: status.steps,
            capacity: status.capacity,
            line: LineStatus::default(),
        }
    }

    /// With this PLC.
    pub(super) fn on(self, line: &LineStatus) -> StatusNotification {
        StatusNotification { line: line.clone(), ..self }
    }
}

impl Workspace {
    /// Tells of each program which PLC is connected now, if that is news.
    pub(super) async fn tell_line(&self, line: LineStatus) {
        let mut told = self.line.lock().await;
        if *told == line {
            return;
        }
        *told = line;
        let snapshot = self.snapshot();
        for open in snapshot.opens().filter(|open| snapshot.program(&open.uri).is_some()) {
            let status = StatusNotification::of(open).on(&told);
            self.client.send_notification::<StatusMethod>(status).await;
        }
    }
}
