//! The thread that has the line to a PLC: it does what it is told, one thing after the other, and looks at what is
//! watched meanwhile.

use super::super::progress::Progress as Bar;
use super::super::simulation::MonitorMethod;
use super::super::status::LineStatus;
use super::super::workspace::Workspace;
use super::answers::{planned, word_of};
use super::connected::{Connected, told};
use super::drift::{drift, encoded, is_drawn};
use super::recording::SharedRecording;
use super::shown::Shown;
use super::watching::Watching;
use crate::link::transport;
use crate::link::{Host, Line, LinkError, Mode, Patience, Point, Stage, Status};
use crate::text::Message;
use serde_json::{Value as Json, json};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Weak};
use std::time::{Duration, Instant};
use tokio::sync::oneshot;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::{MessageType, NumberOrString, Range, Uri};

/// What is to be done with a PLC.
#[derive(Clone, Debug)]
pub(super) enum Order {
    Connect {
        port: String,
        patience: Duration,
    },
    Disconnect,
    State {
        uri: Option<Uri>,
    },
    Plan {
        uri: Uri,
    },
    /// With the sum of what somebody has seen before, if that is to be what is replaced.
    Download {
        uri: Uri,
        is_started: bool,
        sum: Option<String>,
    },
    Upload,
    Start,
    Stop,
    Monitor {
        uri: Uri,
        ranges: Option<Vec<Range>>,
        names: Option<Vec<String>>,
    },
    Unmonitor,
    Write {
        name: String,
        value: Json,
        way: Way,
    },
    Release {
        name: Option<String>,
    },
    Panel {
        more: Vec<String>,
    },
}

/// How a value is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Way {
    /// Once.
    Write,
    /// A relay, once.
    Force,
    /// Again with each look that finds something else.
    Hold,
}

impl Order {
    /// What a person is asked before it is done.
    pub(super) fn question(&self) -> Option<Message> {
        match self {
            Order::Download { is_started: true, .. } => Some(Message::new("link.ask-replace-start")),
            Order::Download { .. } => Some(Message::new("link.ask-replace")),
            Order::Start => Some(Message::new("link.ask-start")),
            _ => None,
        }
    }
}

/// The notification about the state.
pub(super) enum StateMethod {}

impl Notification for StateMethod {
    type Params = Json;
    const METHOD: &'static str = "rungwise/plc";
}

pub(super) type Reply = Result<Json, Message>;

/// An order, where it reports to, and who waits for its end.
struct Job {
    order: Order,
    bar: Bar,
    reply: oneshot::Sender<Reply>,
    /// Set when nobody waits for it any more.
    cancel: Arc<AtomicBool>,
}

/// The other end of the thread.
#[derive(Clone)]
pub(super) struct Desk {
    sender: Sender<Job>,
    is_alive: Arc<AtomicBool>,
    workspace: Weak<Workspace>,
}

/// Ends what is under way when nobody waits for it any more.
struct Waiting(Arc<AtomicBool>);

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Says when dropped, also by a panic, that the thread has ended.
struct Mark(Arc<AtomicBool>);

impl Drop for Mark {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

impl Desk {
    /// A desk without a line.
    pub(super) fn new(workspace: &Arc<Workspace>, recording: &SharedRecording) -> Desk {
        let (sender, receiver) = channel();
        let is_alive = Arc::new(AtomicBool::new(true));
        let desk = Desk { sender, is_alive: Arc::clone(&is_alive), workspace: Arc::downgrade(workspace) };
        let workspace = Arc::downgrade(workspace);
        let tokio = tokio::runtime::Handle::current();
        let recording = recording.clone();
        std::thread::spawn(move || {
            let mark = Mark(is_alive);
            Thread { workspace, tokio, recording, cancel: Arc::default(), plc: None }.run(&receiver, mark);
        });
        desk
    }

    /// Whether it still listens.
    pub(super) fn is_alive(&self) -> bool {
        self.is_alive.load(Ordering::Acquire)
    }

    /// Has something done, and gives its answer.
    pub(super) async fn ask(&self, order: Order, token: Option<NumberOrString>) -> Reply {
        let gone = || Message::new("link.not-connected");
        let workspace = self.workspace.upgrade().ok_or_else(gone)?;
        let takes_long = matches!(order, Order::Plan { .. } | Order::Download { .. } | Order::Upload);
        let title = Message::new("link.title");
        let bar = match token {
            Some(token) => {
                let title = title.render(workspace.snapshot().manner.language);
                Bar::of_request(&workspace.client, Some(token), title)
            }
            None if takes_long => workspace.progress(title).await,
            None => Bar::silent(),
        };
        let (reply, answer) = oneshot::channel();
        let cancel = Arc::<AtomicBool>::default();
        let waiting = Waiting(Arc::clone(&cancel));
        self.sender.send(Job { order, bar, reply, cancel }).map_err(|_| gone())?;
        let answer = answer.await.map_err(|_| gone())?;
        std::mem::forget(waiting);
        answer
    }
}

struct Thread {
    workspace: Weak<Workspace>,
    tokio: tokio::runtime::Handle,
    recording: SharedRecording,
    /// That of the job that is done.
    cancel: Arc<AtomicBool>,
    plc: Option<Connected>,
}

/// How often what is watched is looked at, if the line is that fast.
const PICTURE: Duration = Duration::from_millis(33);
/// How often the mode is asked for beside that.
const STATUS: Duration = Duration::from_secs(2);

impl Thread {
    fn run(&mut self, receiver: &Receiver<Job>, mark: Mark) {
        let mut asked = Instant::now();
        let mut begun = Instant::now();
        loop {
            let is_watching = self.plc.as_ref().is_some_and(|plc| plc.watching.is_some());
            // From the beginning of a look to that of the next.
            let rest = if is_watching { PICTURE.saturating_sub(begun.elapsed()) } else { STATUS };
            match receiver.recv_timeout(rest) {
                Ok(Job { order, bar, reply, cancel }) => {
                    // What nobody waits for any more is not begun.
                    if cancel.load(Ordering::Relaxed) || reply.is_closed() {
                        continue;
                    }
                    self.serve(cancel);
                    let answer = self.obey(order, &bar);
                    drop(bar);
                    let is_end = self.plc.is_none();
                    if is_end {
                        // Whoever connects again, once this is answered, gets a thread of its own.
                        mark.0.store(false, Ordering::Release);
                    }
                    // Whoever has gone is still told what has become of the PLC.
                    let is_failed = answer.is_err();
                    if let Err(Err(reason)) = reply.send(answer) {
                        self.show(&reason);
                    }
                    self.serve(Arc::default());
                    if is_failed {
                        self.ask_status();
                        self.tell(None);
                    }
                    if is_end {
                        return;
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            if self.workspace.strong_count() == 0 {
                return;
            }
            begun = Instant::now();
            let looked = self.look(&mut asked);
            if let Err(error) = looked {
                mark.0.store(false, Ordering::Release);
                self.lose(&error);
                return;
            }
            if self.plc.is_none() {
                return;
            }
        }
    }

    /// What is done from now on ends when this is set.
    fn serve(&mut self, cancel: Arc<AtomicBool>) {
        self.cancel = cancel;
        if let Some(plc) = &mut self.plc {
            plc.host.line().set_cancel(Arc::clone(&self.cancel));
        }
    }

    /// Says to the person at the editor what went wrong.
    fn show(&self, reason: &Message) {
        self.show_as(MessageType::ERROR, reason);
    }

    fn show_as(&self, kind: MessageType, reason: &Message) {
        let Some(workspace) = self.workspace.upgrade() else { return };
        let text = reason.render(workspace.snapshot().manner.language);
        let client = workspace.client.clone();
        self.tokio.spawn(async move { client.show_message(kind, text).await });
    }

    /// Looks at what is watched, and now and then at the PLC as a whole.
    fn look(&mut self, asked: &mut Instant) -> Result<(), LinkError> {
        let Some(workspace) = self.workspace.upgrade() else { return Ok(()) };
        self.keep_up(&workspace);
        self.look_at_program(&workspace)?;
        if asked.elapsed() >= STATUS {
            *asked = Instant::now();
            self.look_at_plc()?;
        }
        Ok(())
    }

    /// Takes over what has changed in the editor. Nobody sees any more what a program does whose document is closed, or
    /// no longer a program for a PLC; so nothing of it is held either.
    fn keep_up(&mut self, workspace: &Workspace) {
        let Some(plc) = &mut self.plc else { return };
        let target = plc.host.identity().target;
        let Some(watching) = &mut plc.watching else { return };
        if !watching.is_open(workspace) {
            self.unwatch();
            self.tell(None);
        } else if let Err(reason) = watching.keep_up(workspace, target, &plc.status) {
            self.unwatch();
            self.show(&reason);
            self.tell(None);
        }
    }

    fn look_at_program(&mut self, workspace: &Workspace) -> Result<(), LinkError> {
        let Some(plc) = &mut self.plc else { return Ok(()) };
        let Some(watching) = &mut plc.watching else { return Ok(()) };
        if !watching.look(&mut plc.host, workspace)? {
            return Ok(());
        }
        watching.tell_alarms(&self.tokio, workspace);
        let was_unknown = plc.image.is_none();
        if was_unknown {
            plc.image = watching.compare(&mut plc.host, &plc.status)?;
        }
        let uri = (was_unknown && plc.image.is_some()).then(|| watching.uri().clone());
        let picture = watching.picture(workspace, &plc.status, plc.image.as_ref());
        // That the program is compared is told before its power is shown.
        if uri.is_some() {
            self.tell(uri.as_ref());
        }
        if let Some(picture) = picture {
            self.tokio.block_on(workspace.client.send_notification::<MonitorMethod>(picture));
        }
        Ok(())
    }

    fn look_at_plc(&mut self) -> Result<(), LinkError> {
        let Some(plc) = &mut self.plc else { return Ok(()) };
        let status = plc.host.status()?;
        let before = std::mem::replace(&mut plc.status, status);
        let known = |status: &Status| (status.mode, status.errors.clone(), status.parameters.sum());
        let is_stopped = (before.mode, plc.status.mode) == (Mode::Run, Mode::Stop);
        if known(&before) != known(&plc.status) {
            // Somebody else has been at it.
            let sum = plc.status.parameters.sum();
            plc.image.take_if(|image| image.parameters().sum() != sum);
            if is_stopped {
                self.release_all();
            }
            self.tell(None);
        }
        Ok(())
    }

    /// Asks how the PLC is; a line that has failed is found out soon.
    fn ask_status(&mut self) {
        if let Some(plc) = &mut self.plc
            && let Ok(status) = plc.host.status()
        {
            plc.status = status;
        }
    }

    /// Shows no more of the program that is watched, if any.
    fn unwatch(&mut self) {
        let watching = self.plc.as_mut().and_then(|plc| plc.watching.take());
        if let (Some(mut watching), Some(workspace)) = (watching, self.workspace.upgrade()) {
            let held = watching.end(&self.tokio, &workspace);
            self.tell_released(&held);
        }
    }

    /// Lets go what is held, and tells so.
    fn release_all(&mut self) {
        let watching = self.plc.as_mut().and_then(|plc| plc.watching.as_mut());
        let held = watching.map(|watching| watching.holds.release_all()).unwrap_or_default();
        self.tell_released(&held);
    }

    fn tell_released(&self, held: &[(Point, i64)]) {
        if !held.is_empty() {
            let names = held.iter().map(|(point, number)| format!("{point}={number}"));
            let names: Vec<String> = names.collect();
            let released = Message::new("link.released");
            let names = names.iter().map(String::as_str);
            self.show_as(MessageType::WARNING, &released.with_words("devices", names, ", "));
        }
    }

    /// The line is gone: says so.
    fn lose(&mut self, error: &LinkError) {
        self.unwatch();
        self.plc = None;
        let Some(workspace) = self.workspace.upgrade() else { return };
        let reason = error.message().render(workspace.snapshot().manner.language);
        self.send(json!({ "connected": false, "reason": reason }));
    }

    fn send(&self, state: Json) {
        let Some(workspace) = self.workspace.upgrade() else { return };
        let word = |member: &str| state[member].as_str().map(str::to_string);
        let line = LineStatus { connection: word("port"), mode: word("mode") };
        // One after the other: the last one counts.
        self.tokio.block_on(async {
            workspace.client.send_notification::<StateMethod>(state).await;
            workspace.tell_line(line).await;
        });
    }

    fn tell(&self, uri: Option<&Uri>) {
        self.send(self.state(uri));
    }

    fn state(&self, uri: Option<&Uri>) -> Json {
        let Some(plc) = &self.plc else { return json!({ "connected": false }) };
        let identity = plc.host.identity();
        let mut state = json!({
            "connected": true,
            "port": plc.port,
            "model": identity.target.name,
            "title": identity.target.title,
            "version": identity.version(),
            "mode": word_of(plc.status.mode),
            "capacity": plc.status.parameters.capacity(),
            "sum": format!("{:04X}", plc.status.parameters.sum()),
            "scan_time_ms": plc.status.scan_time_ms,
            "errors": plc.status.errors,
        });
        if let Some(watching) = &plc.watching {
            state["monitoring"] = json!(watching.uri());
            let held = watching.holds.held().iter();
            let held = held.map(|(point, number)| {
                json!({ "device": point.to_string(), "value": point.value(*number).json() })
            });
            state["held"] = held.collect();
        }
        if plc.image.is_none() {
            state["match"] = "unknown".into();
        }
        if let (Some(uri), Some(workspace)) = (uri, self.workspace.upgrade()) {
            let encoded = encoded(&workspace, uri).ok();
            match (encoded, &plc.image) {
                (Some(encoded), Some(image)) => {
                    let ranges = drift(&encoded, image, &workspace, uri);
                    let is_same = encoded.words == image.program();
                    state["match"] = if is_same { "same" } else { "different" }.into();
                    state["drift"] = json!(ranges);
                }
                _ => state["match"] = "unknown".into(),
            }
        }
        state
    }

    fn obey(&mut self, order: Order, bar: &Bar) -> Reply {
        let gone = || Message::new("link.not-connected");
        if let Order::Connect { port, patience } = &order {
            let connected = self.connect(port, *patience);
            self.tell(None);
            connected.map_err(|error| told(&error))?;
            return Ok(self.state(None));
        }
        if matches!(order, Order::Disconnect) {
            self.unwatch();
            self.plc = None;
            self.send(json!({ "connected": false }));
            return Ok(json!({ "connected": false }));
        }
        let workspace = self.workspace.upgrade().ok_or_else(gone)?;
        let plc = self.plc.as_mut().ok_or_else(gone)?;
        let language = workspace.snapshot().manner.language;
        let shown = |last| Shown { bar, last, language };
        let mut answer = None;
        let mut about = None;
        match order {
            Order::Connect { .. } | Order::Disconnect => {}
            Order::State { uri } => return Ok(self.state(uri.as_ref())),
            Order::Plan { uri } => {
                let (encoded, preview) = plc.plan(&workspace, &uri, &shown(Stage::Reading))?;
                answer = Some(planned(&encoded, &preview.plan, is_drawn(&workspace, &uri), language));
                plc.shown = Some(preview);
                about = Some(uri);
            }
            Order::Download { uri, is_started, sum } => {
                // What was held was meant for the program that is replaced.
                self.release_all();
                let plc = self.plc.as_mut().ok_or_else(gone)?;
                answer = Some(plc.download(
                    &workspace,
                    &uri,
                    is_started,
                    sum.as_deref(),
                    &shown(Stage::Comparing),
                )?);
                about = Some(uri);
            }
            Order::Upload => {
                let uploaded = plc.upload(&shown(Stage::Reading))?;
                if uploaded["whole"] == false {
                    self.show_as(MessageType::WARNING, &Message::new("link.not-whole"));
                }
                answer = Some(uploaded);
            }
            Order::Start => {
                if !plc.host.start().map_err(|error| told(&error))? {
                    return Err(Message::new("link.does-not-run"));
                }
            }
            Order::Stop => {
                let stopped = plc.host.stop().map_err(|error| told(&error));
                self.release_all();
                stopped?;
            }
            Order::Monitor { uri, ranges, names } => {
                if let Err(reason) = self.monitor(&workspace, uri, ranges, names) {
                    self.tell(None);
                    return Err(reason);
                }
            }
            Order::Unmonitor => self.unwatch(),
            Order::Write { name, value, way } => plc.write(&name, &value, way)?,
            Order::Release { name: Some(name) } => plc.release(&name)?,
            Order::Release { name: None } => {
                if let Some(watching) = &mut plc.watching {
                    watching.holds.release_all();
                }
            }
            Order::Panel { more } => {
                let nothing = || Message::new("link.not-monitored");
                let watching = plc.watching.as_ref().ok_or_else(nothing)?;
                return watching.panel(&workspace, plc.host.identity().target, &more);
            }
        }
        // What was done is done.
        self.ask_status();
        self.tell(about.as_ref());
        Ok(answer.unwrap_or_else(|| self.state(None)))
    }

    /// Watches a program, in the place of another one.
    fn monitor(
        &mut self,
        workspace: &Workspace,
        uri: Uri,
        ranges: Option<Vec<Range>>,
        names: Option<Vec<String>>,
    ) -> Result<(), Message> {
        if self.plc.as_ref().and_then(|plc| plc.watching.as_ref()).is_some_and(|known| *known.uri() != uri) {
            self.unwatch();
        }
        let Some(plc) = &mut self.plc else { return Ok(()) };
        let target = plc.host.identity().target;
        let watching = plc.watching.get_or_insert_with(|| Watching::new(uri, self.recording.clone()));
        watching.watch(ranges, names);
        let followed = watching.follow(workspace, target, &plc.status);
        if followed.is_err() {
            self.unwatch();
        }
        followed
    }

    fn connect(&mut self, port: &str, patience: Duration) -> Result<(), LinkError> {
        self.unwatch();
        self.plc = None;
        let patience = Patience { answer: patience, ..Patience::default() };
        let line = Line::new(transport::open(port)?, patience, Arc::clone(&self.cancel));
        let mut host = Host::connect(line)?;
        let status = host.status()?;
        self.plc = Some(Connected {
            port: port.to_string(),
            host,
            status,
            image: None,
            shown: None,
            watching: None,
        });
        Ok(())
    }
}
