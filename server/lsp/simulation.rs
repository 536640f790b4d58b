//! `rungwise.simulate.…`: programs run on a simulated PLC beside the editor.
//!
//! Commands (`workspace/executeCommand`), each with one argument, an object with `uri`, the address of a program. Files
//! of a project that are one program with it run with it, in one simulation, whichever of them is named; `watch` is
//! about the one that is. The members that each takes besides:
//!
//! ```text
//! rungwise.simulate.start     { scanTime?: ms = 10, speed?: number = 1, paused?: boolean }   // speed 0: no limit
//! rungwise.simulate.stop      { }
//! rungwise.simulate.pause     { }
//! rungwise.simulate.run       { speed?: number }                  // goes on
//! rungwise.simulate.step      { count?: scans = 1 }               // and pauses
//! rungwise.simulate.stepBack  { count?: scans = 1, changeOf?: name }   // or back to the last change of a device
//! rungwise.simulate.reset     { }                                 // as if just switched on, paused or not as before;
//!                                                                 // inputs and what is forced stay, also at start
//! rungwise.simulate.set       { name, value }                     // "X0", true or 1; "D0", 25
//! rungwise.simulate.force     { name, value }                     // holds it
//! rungwise.simulate.release   { name? }                           // one, or all
//! rungwise.simulate.watch     { ranges?: Range[], names?: string[] }   // what the client shows
//! rungwise.simulate.state     { names?: string[] }
//! rungwise.simulate.panel     { names?: string[] }                // more than the program uses
//! rungwise.simulate.trace     { names: string[], from?: scan, to?: scan, most?: points = 2000 }
//! rungwise.simulate.export    { format: "vcd" | "csv", names?: string[], from?: scan, to?: scan }
//! rungwise.simulate.record    { names?: string[] }                // what was done so far as a scenario test
//! rungwise.simulate.why       { name | position, scan?: number }  // from 0 on; the last one if left out
//! ```
//!
//! `record` answers `{ uri, name, text }`: what the file could be called, and what stands in it. What is expected in it
//! are the changes of `names`, of the outputs where they are left out. `why` answers a tree, the fewest contacts that
//! hold a device on or keep it off, each with the reasons for it:
//!
//! ```text
//! { text, scan, time_ms, uri?, range?, because: … [] }
//! ```
//!
//! Each of the others answers the state, `panel`, `trace` and `export` with more members:
//!
//! ```text
//! { uri, files: Uri[], mode: "running" | "paused" | "stopped", scan, first_scan, time_ms, scan_ms, speed, edition,
//!   branch, forced: string[], values: { device, value, forced, wired? }[], errors: { range, message }[] }
//! ```
//!
//! `values` are those of `names`, or of what is watched; `wired` is what an input will be in the next scan, if that is
//! something else. `files` are all those of the program, in the order of execution, and `errors` and what is watched
//! are of the one at `uri`. `edition` is another number whenever the program is another,
//! as by an edit, and `branch` whenever scans of before have been taken back.
//!
//! `panel` says with `rows` what belongs on a panel of the program, group by group:
//!
//! ```text
//! { name, label, type: "bit" | "word", symbol, comment, reads, writes,
//!   group: "inputs" | "outputs" | "timers" | "counters" | "states" | "relays" | "registers" | "variables",
//!   least?, greatest?,                    // of a word
//!   contact?, preset?, preset_of?, unit_ms? }   // of a timer or counter, whose current value `name` is
//! ```
//!
//! `name`, `contact` and `preset_of`, which is where the preset lies, are names for the other commands; `preset` is the
//! constant of the program. `unit_ms` is what a timer counts.
//!
//! `trace` says what variables were, and records them from then on:
//!
//! ```text
//! { from, to, signals: { name, known_from: scan, points: [scan, value][] }[] }
//! ```
//!
//! The first point has the value at `from`, or at `known_from` if that is later; each other one is a change. Of more
//! changes than `most` those are kept that show the least and the greatest value in each of equal spans of time. What
//! was before a variable was recorded is found bit by bit: whoever wants it asks again. A chart that is kept up to date
//! asks from the last scan that it has, and for everything again when `branch` is another number.
//!
//! `export` has the `text` of a file with every change, and `from` and `to`, which scans it tells of.
//!
//! While a simulation runs, the notification `rungwise/monitor` tells what is watched, of each file in which something
//! is, at most thirty times a second, when something may have changed:
//!
//! ```text
//! { uri, version, source: "simulator", mode, scan, time_ms, edition, branch,
//!   elements: { range, kind: "wire" | "contact" | "output" | "line" | "value" | "forced", energised, conducts?,
//!     value? }[],
//!   values: { device, value, forced, wired? }[], errors: { range, message }[] }
//! ```
//!
//! A `forced` element is the name of something that is forced, wherever it stands; its `value` is what it is held at.
//!
//! Values that a variable cannot have are refused, and scan times other than 0.001 to 60000 ms and speeds below 0.
//!
//! A step of many scans and a search for the last change end where they are as soon as another order comes; `state`,
//! `watch`, `panel`, `trace`, `export`, `record` and `why` are answered meanwhile. A simulation stops when the last
//! document of its program is closed; the last `rungwise/monitor` then has `mode: "stopped"`, as after `stop`.
//!
//! `scan` counts from 0. What an edit made of the program is taken over as soon as it can be run; until then the old
//! program goes on and `elements` is empty. An edit after which the program does the same leaves its history; any other
//! begins a new one, and devices and instructions around the edit keep what they remember.

mod chart;

mod forced;

mod monitor;

mod panel;

mod runner;

mod screens;

mod why;

use super::answering::{refused, snapshot, wrong_argument};
use super::workspace::Workspace;
use crate::text::Message;
use chart::Wanted;
pub(super) use monitor::{Monitor, MonitorMethod, Picture};
pub(super) use panel::rows as panel_rows;
use runner::{About, Deed, Order, Question, Runner};
pub(super) use runner::{compiled, files_around};
use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::{Arc, Mutex, PoisonError};
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{LSPAny, Position, Range, Uri};

/// What all commands begin with; [`COMMANDS`](super::capabilities::COMMANDS) has them.
pub(super) const PREFIX: &str = "rungwise.simulate.";

/// The argument of any of them.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asked {
    uri: Uri,
    scan_time: Option<f64>,
    speed: Option<f64>,
    #[serde(default)]
    paused: bool,
    count: Option<u64>,
    change_of: Option<String>,
    name: Option<String>,
    value: Option<Value>,
    ranges: Option<Vec<Range>>,
    names: Option<Vec<String>>,
    from: Option<u64>,
    to: Option<u64>,
    most: Option<usize>,
    format: Option<String>,
    position: Option<Position>,
    scan: Option<u64>,
}

/// The simulations that run, one for a program, of however many files it is.
#[derive(Default)]
pub(super) struct Simulations(Mutex<Vec<Runner>>);

impl Simulations {
    /// Answers a command.
    pub(super) async fn answer(
        &self,
        command: &str,
        argument: Option<&Value>,
        workspace: &Arc<Workspace>,
    ) -> Result<Option<LSPAny>> {
        let wrong = |reason: String| refused(wrong_argument(command, reason));
        let argument = argument.ok_or_else(|| wrong("arguments[0]".to_string()))?;
        let asked = Asked::deserialize(argument).map_err(|reason| wrong(reason.to_string()))?;
        let uri = asked.uri.clone();
        let order = order(command, asked).map_err(refused)?;
        if matches!(order, Order::Start { .. }) && snapshot().program(&uri).is_none() {
            return Err(refused(Message::new("request.no-document").with("command", command)));
        }
        let is_state = matches!(order, Order::Do(Deed::Stop) | Order::Ask(Question::State { .. }));
        let stopped = || json!({ "uri": uri, "mode": "stopped" });
        let runner = match order {
            Order::Start { .. } => {
                Some(self.of(&uri, workspace).unwrap_or_else(|| self.begin(&uri, workspace)))
            }
            Order::Do(Deed::Stop) => self.take(&uri, workspace),
            _ => self.of(&uri, workspace),
        };
        match runner {
            Some(runner) => match runner.ask(uri.clone(), order).await {
                // It ended meanwhile.
                Err(_) if is_state && !runner.is_alive() => Ok(Some(stopped())),
                answer => answer.map(Some).map_err(refused),
            },
            None if is_state => Ok(Some(stopped())),
            None => Err(refused(Message::new("simulate.not-running"))),
        }
    }
}

impl Simulations {
    /// The simulation of the program that the file at `uri` is a part of.
    fn of(&self, uri: &Uri, workspace: &Workspace) -> Option<Runner> {
        let running = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        found(&running, uri, workspace).map(|at| running[at].clone())
    }

    /// The same, which is one of them no more.
    fn take(&self, uri: &Uri, workspace: &Workspace) -> Option<Runner> {
        let mut running = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        found(&running, uri, workspace).map(|at| running.swap_remove(at))
    }

    /// A new one.
    fn begin(&self, uri: &Uri, workspace: &Arc<Workspace>) -> Runner {
        let files = files_around(workspace, uri).unwrap_or_default().into_iter().map(|(file, ..)| file);
        let mut running = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        running.retain(Runner::is_alive);
        let runner = Runner::new(files.collect(), workspace);
        running.push(runner.clone());
        runner
    }

    /// Why what stands at a position is on or off, in Markdown; nothing unless its program is being simulated.
    pub(super) async fn brief(&self, uri: &Uri, position: Position, workspace: &Workspace) -> Option<String> {
        let runner = self.of(uri, workspace)?;
        let order = Order::Ask(Question::Why { about: About::At(position), scan: None, is_brief: true });
        runner.ask(uri.clone(), order).await.ok()?.as_str().map(str::to_string)
    }
}

/// Which of them runs the program of the file at `uri`, which may have been opened a moment ago.
fn found(running: &[Runner], uri: &Uri, workspace: &Workspace) -> Option<usize> {
    let runs = |uri: &Uri| running.iter().position(|runner| runner.is_alive() && runner.runs(uri));
    runs(uri).or_else(|| files_around(workspace, uri)?.iter().find_map(|(file, ..)| runs(file)))
}

fn order(command: &str, asked: Asked) -> std::result::Result<Order, Message> {
    let verb = command.strip_prefix(PREFIX).unwrap_or_default();
    let missing = |member: &str| wrong_argument(command, member);
    let name = asked.name.clone().ok_or_else(|| missing("name"));
    let value = asked.value.clone().ok_or_else(|| missing("value"));
    let wanted = Wanted {
        names: asked.names.clone().unwrap_or_default(),
        from: asked.from,
        to: asked.to,
        most: asked.most,
    };
    Ok(match verb {
        "start" => Order::Start { scan_ms: asked.scan_time, speed: asked.speed, is_paused: asked.paused },
        "stop" => Order::Do(Deed::Stop),
        "pause" => Order::Do(Deed::Pause),
        "run" => Order::Do(Deed::Run { speed: asked.speed }),
        "step" => Order::Do(Deed::Step { count: asked.count.unwrap_or(1) }),
        "stepBack" => {
            Order::Do(Deed::StepBack { count: asked.count.unwrap_or(1), change_of: asked.change_of })
        }
        "reset" => Order::Do(Deed::Reset),
        "set" => Order::Do(Deed::Set { name: name?, value: value?, is_force: false }),
        "force" => Order::Do(Deed::Set { name: name?, value: value?, is_force: true }),
        "release" => Order::Do(Deed::Release { name: asked.name }),
        "record" => Order::Ask(Question::Record { names: asked.names }),
        "why" => {
            let about = asked.position.map(About::At);
            Order::Ask(Question::Why {
                about: about.map_or_else(|| name.map(About::Name), Ok)?,
                scan: asked.scan,
                is_brief: false,
            })
        }
        "watch" => Order::Ask(Question::Watch { ranges: asked.ranges, names: asked.names }),
        "panel" => Order::Ask(Question::Panel { more: asked.names.unwrap_or_default() }),
        "trace" => Order::Ask(Question::Trace { wanted }),
        "export" => {
            Order::Ask(Question::Export { wanted, format: asked.format.ok_or_else(|| missing("format"))? })
        }
        "state" => Order::Ask(Question::State { names: asked.names }),
        _ => return Err(Message::new("request.no-command").with("command", command)),
    })
}
