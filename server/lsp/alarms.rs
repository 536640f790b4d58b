//! Tells what is raised and what is gone of the alarms of a project (`[[alarm]]` in `rungwise.toml`), while its program
//! is watched in a PLC or runs in the simulator: a message to the person, and the notification `rungwise/alarm`:
//!
//! ```text
//! { uri, source: "plc" | "simulator", when, message, severity: "error" | "warning" | "hint", raised: boolean,
//!   ended: boolean,          // gone because nobody watches any more
//!   time_ms, at_ms }         // of the picture, and since 1970
//! ```

use super::workspace::Workspace;
use crate::simulate::{Alarm, AlarmChange, Alarms, Names, Value, WithSymbols};
use crate::target::Symbols;
use crate::text::{Message, Severity};
use rustc_hash::FxHashMap;
use serde_json::{Value as Json, json};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::{MessageType, Uri};

/// The notification.
enum AlarmMethod {}

impl Notification for AlarmMethod {
    type Params = Json;
    const METHOD: &'static str = "rungwise/alarm";
}

/// An alarm that comes again sooner brings no message to the person again.
const AGAIN: Duration = Duration::from_secs(5);

/// The alarms of one program that is watched.
pub(super) struct Watchman<V> {
    source: &'static str,
    alarms: Alarms<V>,
    /// What the alarms are made of, and what the project calls the devices in them.
    wanted: Vec<Alarm>,
    symbols: Arc<Symbols>,
    /// What was not told yet.
    changes: Vec<AlarmChange>,
    refused: Vec<(Alarm, Message)>,
    /// Whether nobody watches any more.
    is_over: bool,
    shown: FxHashMap<String, Instant>,
}

impl<V: Copy> Watchman<V> {
    /// No alarm yet, of a PLC or of the simulator.
    pub(super) fn new(source: &'static str) -> Watchman<V> {
        Watchman {
            source,
            alarms: Alarms::default(),
            wanted: Vec::new(),
            symbols: Arc::default(),
            changes: Vec::new(),
            refused: Vec::new(),
            is_over: false,
            shown: FxHashMap::default(),
        }
    }

    /// Whether the project wants other alarms than these, or calls devices otherwise.
    pub(super) fn is_outdated(&self, workspace: &Workspace, uri: &Uri) -> bool {
        let snapshot = workspace.snapshot();
        snapshot.open(uri).is_some_and(|open| {
            let wanted = &open.manifest.alarms;
            wanted.len() != self.wanted.len()
                || open.manifest.alarms() != self.wanted
                || *open.document.comments().symbols() != self.symbols
        })
    }

    /// Watches the alarms of the project around `uri`, with the names as they are now; what is raised stays so.
    pub(super) fn follow(&mut self, workspace: &Workspace, uri: &Uri, names: &impl Names<Variable = V>) {
        let snapshot = workspace.snapshot();
        let of_project = snapshot
            .open(uri)
            .map(|open| (open.manifest.alarms(), open.document.comments().symbols().clone()));
        let (wanted, symbols) = of_project.unwrap_or_default();
        let (mut alarms, refused) = Alarms::new(&wanted, &WithSymbols { names, symbols: &symbols });
        alarms.take_over(&self.alarms);
        if wanted != self.wanted || symbols != self.symbols {
            self.refused = refused;
        }
        (self.alarms, self.wanted, self.symbols) = (alarms, wanted, symbols);
    }

    /// What is to be looked at.
    pub(super) fn variables(&self) -> Vec<V> {
        self.alarms.variables()
    }

    /// Whether there is nothing to look at.
    pub(super) fn is_empty(&self) -> bool {
        self.alarms.is_empty()
    }

    /// Looks at the values of a moment.
    pub(super) fn look(&mut self, time_ns: i64, of: &impl Fn(V) -> Value) {
        for change in self.alarms.look(time_ns, of) {
            self.note(change);
        }
    }

    /// Nobody watches any more.
    pub(super) fn end(&mut self, time_ns: i64) {
        self.is_over = true;
        let gone = self.alarms.end(time_ns);
        self.changes.extend(gone);
    }

    /// Of what comes and goes faster than it is told, the last time is kept.
    fn note(&mut self, change: AlarmChange) {
        if self.changes.iter().filter(|known| known.alarm == change.alarm).count() > 1 {
            self.changes.retain(|known| known.alarm != change.alarm);
        }
        self.changes.push(change);
    }

    /// Tells what was not told yet, in its order.
    pub(super) fn tell(&mut self, tokio: &tokio::runtime::Handle, workspace: &Workspace, uri: &Uri) {
        if self.changes.is_empty() && self.refused.is_empty() {
            return;
        }
        let language = workspace.snapshot().manner.language;
        let mut told = Vec::new();
        for (alarm, reason) in std::mem::take(&mut self.refused) {
            let text = Message::new("simulate.alarm-refused").with("when", &alarm.when);
            let text = text.with_messages("reason", vec![reason]).render(language);
            told.push((None, Some((MessageType::ERROR, text))));
        }
        for change in std::mem::take(&mut self.changes) {
            let is_shown = change.is_raised && self.is_time(&change.alarm);
            let message = is_shown.then(|| {
                let AlarmChange { alarm, .. } = &change;
                let key = if self.source == "plc" { "link.alarm" } else { "simulate.alarm" };
                let text = Message::new(key).with("message", &alarm.message).with("when", &alarm.when);
                (kind(alarm.severity), text.render(language))
            });
            told.push((Some(self.json(&change, uri)), message));
        }
        let client = workspace.client.clone();
        tokio.block_on(async move {
            for (change, message) in told {
                if let Some(change) = change {
                    client.send_notification::<AlarmMethod>(change).await;
                }
                if let Some((kind, text)) = message {
                    client.show_message(kind, text).await;
                }
            }
        });
    }

    /// Whether an alarm is told to the person now.
    fn is_time(&mut self, alarm: &Alarm) -> bool {
        let before = self.shown.get(&alarm.when);
        let is_time = before.is_none_or(|shown| shown.elapsed() >= AGAIN);
        if is_time {
            self.shown.insert(alarm.when.clone(), Instant::now());
        }
        is_time
    }

    fn json(&self, change: &AlarmChange, uri: &Uri) -> Json {
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        json!({
            "uri": uri,
            "source": self.source,
            "when": change.alarm.when,
            "message": change.alarm.message,
            "severity": change.alarm.severity.word(),
            "raised": change.is_raised,
            "ended": self.is_over,
            "time_ms": change.time_ns as f64 / 1e6,
            "at_ms": since_1970.as_millis() as u64,
        })
    }
}

fn kind(severity: Severity) -> MessageType {
    match severity {
        Severity::Error => MessageType::ERROR,
        Severity::Warning => MessageType::WARNING,
        Severity::Hint => MessageType::INFO,
    }
}
