//! `rungwise.plc.…`: a PLC on a line, beside the editor.
//!
//! Nothing is said to a PLC but by these commands (`workspace/executeCommand`). Each takes an object, which may be left
//! out where no member is needed:
//!
//! ```text
//! rungwise.plc.ports        { uri? }                     → { ports: { name, description }[], project?: port }
//! rungwise.plc.connect      { uri?, port?: string, timeout?: ms = 1000 }   // the port of the project of `uri`
//! rungwise.plc.disconnect   { }
//! rungwise.plc.state        { uri? }                     // with what of `uri` is not in the PLC as it stands there
//! rungwise.plc.plan         { uri }                      → { same, bytes, steps, sum,
//!                             form: "ladder" | "fx", before, after, parameters: string[] }
//! rungwise.plc.verify       { uri }                      // the same
//! rungwise.plc.download     { uri, start?: boolean, confirmed?: boolean, sum? }
//!                                                        → { written, compared, steps, mode, backup? }
//! rungwise.plc.upload       { }                          → { text, model, steps, unread }
//! rungwise.plc.start        { confirmed?: boolean }
//! rungwise.plc.stop         { }
//! rungwise.plc.monitor      { uri, ranges?: Range[], names?: string[] }
//! rungwise.plc.unmonitor    { }
//! rungwise.plc.write        { name, value }              // "D0", 5; "T0", 0; "M5", true
//! rungwise.plc.force        { name, value }              // of a relay alone
//! rungwise.plc.hold         { name, value }              // while a program is monitored
//! rungwise.plc.release      { name? }                    // one, or all
//! rungwise.plc.panel        { names?: string[] }         → { rows, … }   // of the program that is monitored
//! rungwise.plc.trace        { names, from?: ms, to?: ms, most?: points = 2000 }
//!                                                        → { from, to, branch, signals }
//! rungwise.plc.export       { format: "vcd" | "csv", names?: string[] }  → { from, to, text }
//! ```
//!
//! `sum` is that of the program in the PLC; a download that is told one is refused if another program is there
//! meanwhile.
//! `parameters` are sentences about the title and the latched ranges that `[plc]` of `rungwise.toml` changes.
//! `before` and `after` are what is in the PLC and what shall be, as drawings where `uri` is one, else as instruction
//! lists. Whoever does not send
//! `confirmed` is asked by the server before a PLC is written or started. A request that is cancelled ends at the next
//! exchange on the line; what has become of the PLC is then told in a message. The others answer the state, which is
//! also the notification `rungwise/plc` when it changes:
//!
//! ```text
//! { connected: boolean, port?, model?, version?, mode?: "RUN" | "STOP", capacity?, sum?, scan_time_ms?,
//!   errors?: { register, code }[], monitoring?: uri, match?: "same" | "different" | "unknown", drift?: Range[],
//!   held?: { device, value }[], reason? }                 // why the line is gone
//! ```
//!
//! The protocol has no hold: what is held is written again with each look that finds something else, and the program
//! may write in between. All is let go, and the person told, when nothing is monitored any more, before a download,
//! when the PLC is stopped, and when the line is gone; the PLC keeps the values that were written last. `held` of the
//! state says what is held.
//!
//! `panel`, `trace` and `export` are as those of `rungwise.simulate.…`, with milliseconds from the first look on in the
//! place of scans. What was looked at is recorded, as many changes as `record` under `[monitor]` in `rungwise.toml`
//! says, until something is monitored again, also if the line is gone; what is asked for by `trace` is read from then
//! on. `branch` is another number when a recording began anew.
//!
//! `drift` are the instructions of `uri` that are not so in the PLC, as far as that is known: from the last upload,
//! download or comparison. While a program is monitored, `rungwise/monitor` comes as in a simulation, with
//! `source: "plc"`: values are those that were read in one exchange, and the power is computed from them.

mod answers;

mod connected;

mod desk;

mod drift;

mod recording;

mod shown;

mod watching;

use super::answering::{refused, snapshot, wrong_argument};
use super::capabilities::COMMANDS;
use super::workspace::Workspace;
use crate::link::transport::ports;
use crate::text::Message;
use desk::{Desk, Order, Way};
use recording::SharedRecording;
use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{LSPAny, MessageActionItem, MessageType, NumberOrString, Range, Uri};

/// What all commands begin with; [`COMMANDS`](super::capabilities::COMMANDS) has them.
pub(super) const PREFIX: &str = "rungwise.plc.";

/// The argument of any of them.
#[derive(Clone, Debug, Default, Deserialize)]
struct Asked {
    uri: Option<Uri>,
    port: Option<String>,
    timeout: Option<u64>,
    #[serde(default)]
    start: bool,
    #[serde(default)]
    confirmed: bool,
    name: Option<String>,
    value: Option<Value>,
    ranges: Option<Vec<Range>>,
    names: Option<Vec<String>>,
    from: Option<u64>,
    to: Option<u64>,
    most: Option<usize>,
    format: Option<String>,
    sum: Option<String>,
}

/// How long an answer may take to begin if nobody says otherwise.
const PATIENCE_MS: u64 = 1_000;

/// The PLC that is connected, if any.
#[derive(Default)]
pub(super) struct Plcs {
    desk: Mutex<Option<Desk>>,
    recording: SharedRecording,
}

impl Plcs {
    /// Answers a command; `token` is where the client shows how far it is.
    pub(super) async fn answer(
        &self,
        command: &str,
        argument: Option<&Value>,
        token: Option<NumberOrString>,
        workspace: &Arc<Workspace>,
    ) -> Result<Option<LSPAny>> {
        let wrong = |reason: String| refused(wrong_argument(command, reason));
        let none = json!({});
        let asked =
            Asked::deserialize(argument.unwrap_or(&none)).map_err(|reason| wrong(reason.to_string()))?;
        let verb = command.strip_prefix(PREFIX).unwrap_or_default();
        if verb == "ports" {
            let ports = tokio::task::spawn_blocking(ports).await.unwrap_or_default();
            let ports =
                ports.iter().map(|port| json!({ "name": port.name, "description": port.description }));
            let project = port_of(asked.uri.as_ref());
            return Ok(Some(json!({ "ports": ports.collect::<Vec<_>>(), "project": project })));
        }
        // The thread that has the line is not asked for what it has seen.
        match verb {
            "trace" => return Ok(Some(self.recording.trace(&asked))),
            "export" => return self.recording.export(&asked).map(Some).map_err(refused),
            _ => {}
        }
        if !COMMANDS.contains(&command) {
            return Err(refused(Message::new("request.no-command").with("command", command)));
        }
        let desk = self.desk(verb, workspace);
        let Some(desk) = desk else {
            return match verb {
                "state" | "disconnect" => Ok(Some(json!({ "connected": false }))),
                _ => Err(refused(Message::new("link.not-connected"))),
            };
        };
        let order = order(command, verb, &asked).map_err(refused)?;
        if let Some(question) = order.question().filter(|_| !asked.confirmed)
            && !is_confirmed(workspace, question).await
        {
            return Err(refused(Message::new("link.cancelled")));
        }
        if matches!(order, Order::Plan { .. } | Order::Download { .. }) {
            // A program is never downloaded without files of it that are not known yet.
            workspace.settled().await;
        }
        let answer = desk.ask(order, token).await;
        if verb == "disconnect" || !desk.is_alive() {
            self.desk.lock().unwrap_or_else(PoisonError::into_inner).take_if(|own| !own.is_alive());
        }
        answer.map(Some).map_err(refused)
    }

    /// The desk that orders go to; a new one for who connects.
    fn desk(&self, verb: &str, workspace: &Arc<Workspace>) -> Option<Desk> {
        let mut desk = self.desk.lock().unwrap_or_else(PoisonError::into_inner);
        desk.take_if(|own| !own.is_alive());
        if verb == "connect" && desk.is_none() {
            *desk = Some(Desk::new(workspace, &self.recording));
        }
        desk.clone()
    }
}

fn order(command: &str, verb: &str, asked: &Asked) -> std::result::Result<Order, Message> {
    let missing = |member: &str| wrong_argument(command, member);
    let uri = || asked.uri.clone().ok_or_else(|| missing("uri"));
    let set = |way| {
        let name = asked.name.clone().ok_or_else(|| missing("name"))?;
        let value = asked.value.clone().ok_or_else(|| missing("value"))?;
        Ok(Order::Write { name, value, way })
    };
    Ok(match verb {
        "connect" => {
            let port = asked.port.clone().or_else(|| port_of(asked.uri.as_ref()));
            let port = port.ok_or_else(|| Message::new("link.which-port"))?;
            Order::Connect { port, patience: Duration::from_millis(asked.timeout.unwrap_or(PATIENCE_MS)) }
        }
        "disconnect" => Order::Disconnect,
        "plan" | "verify" => Order::Plan { uri: uri()? },
        "download" => Order::Download { uri: uri()?, is_started: asked.start, sum: asked.sum.clone() },
        "upload" => Order::Upload,
        "start" => Order::Start,
        "stop" => Order::Stop,
        "monitor" => Order::Monitor { uri: uri()?, ranges: asked.ranges.clone(), names: asked.names.clone() },
        "unmonitor" => Order::Unmonitor,
        "write" => set(Way::Write)?,
        "force" => set(Way::Force)?,
        "hold" => set(Way::Hold)?,
        "release" => Order::Release { name: asked.name.clone() },
        "panel" => Order::Panel { more: asked.names.clone().unwrap_or_default() },
        "state" => Order::State { uri: asked.uri.clone() },
        _ => return Err(Message::new("request.no-command").with("command", command)),
    })
}

/// The port that the project of a document names.
fn port_of(uri: Option<&Uri>) -> Option<String> {
    snapshot().open(uri?)?.manifest.port.clone()
}

/// Asks the person at the editor.
async fn is_confirmed(workspace: &Workspace, question: Message) -> bool {
    let language = workspace.snapshot().manner.language;
    let action =
        |key| MessageActionItem { title: Message::new(key).render(language), properties: Default::default() };
    let (yes, no) = (action("link.yes"), action("link.no"));
    let text = question.render(language);
    let actions = Some(vec![yes.clone(), no]);
    let chosen = workspace.client.show_message_request(MessageType::WARNING, text, actions).await;
    chosen.ok().flatten().is_some_and(|chosen| chosen.title == yes.title)
}
