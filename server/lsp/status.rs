//! The notification `rungwise/status`, for a status bar:
//! `{"uri", "target": "fx2n", "dialect": "ladder"|"fx"|"iec", "rungs", "steps", "capacity"}`.
//! `steps` is `null` and `capacity` 0 where programs are not counted in steps.

use super::workspace::Open;
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
}

impl StatusNotification {
    pub(super) fn of(open: &Open) -> StatusNotification {
        let status = ide::status(&open.document);
        StatusNotification {
            uri: open.uri.clone(),
            target: status.target.to_string(),
            dialect: status.dialect.to_string(),
            rungs: status.rungs,
            steps: status.steps,
            capacity: status.capacity,
        }
    }
}
