//! A simulation on a thread of its own: it runs scans when they are due, and does what it is told between two of them.

mod program;

mod telling;

use super::super::alarms::Watchman;
use super::super::workspace::Workspace;
use super::chart::Wanted;
use super::monitor::MonitorMethod;
use super::screens::{File, Screens};
use crate::scenario::{InputKind, Recording};
use crate::simulate::{
    ChangeSearch, Code, Drivers, Error, HistoryLimit, NamesOfCode, Recorder, Session, Sight, Touch, Value,
    Variable,
};
use crate::text::Message;
use program::{around, files};
pub(in crate::lsp) use program::{compiled, files_around};
use serde_json::Value as Json;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, PoisonError, RwLock, Weak};
use std::time::{Duration, Instant};
use tokio::sync::oneshot;
use tower_lsp::ls_types::{Position, Range, Uri};

/// What a simulation is told.
#[derive(Clone, Debug)]
pub(super) enum Order {
    Start { scan_ms: Option<f64>, speed: Option<f64>, is_paused: bool },
    Do(Deed),
    Ask(Question),
}

/// What changes the course of a program that runs. What takes long ends where it is.
#[derive(Clone, Debug)]
pub(super) enum Deed {
    Stop,
    Pause,
    Run { speed: Option<f64> },
    Step { count: u64 },
    StepBack { count: u64, change_of: Option<String> },
    Reset,
    Set { name: String, value: Json, is_force: bool },
    Release { name: Option<String> },
}

/// What leaves its course alone, so that what takes long goes on meanwhile.
#[derive(Clone, Debug)]
pub(super) enum Question {
    Watch { ranges: Option<Vec<Range>>, names: Option<Vec<String>> },
    State { names: Option<Vec<String>> },
    Panel { more: Vec<String> },
    Trace { wanted: Wanted },
    Export { wanted: Wanted, format: String },
    Record { names: Option<Vec<String>> },
    Why { about: About, scan: Option<u64>, is_brief: bool },
}

/// What is asked about: a name, or what stands at a position.
#[derive(Clone, Debug)]
pub(super) enum About {
    Name(String),
    At(Position),
}

type Reply = Result<Json, Message>;

/// Says when dropped, also by a panic, that a thread has ended.
struct Mark(Arc<AtomicBool>);

impl Drop for Mark {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

/// What takes more than one slice of time.
#[derive(Debug)]
enum Task {
    /// So many scans.
    Steps(u64),
    /// To before the last change of a variable.
    BackTo(Box<ChangeSearch<Value>>),
}

/// The other end of a simulation's thread.
#[derive(Clone)]
pub(super) struct Runner {
    sender: Sender<Asked>,
    is_alive: Arc<AtomicBool>,
    files: Arc<RwLock<Vec<Uri>>>,
}

/// What somebody who looks at a file of the program orders, and where the answer goes.
struct Asked {
    uri: Uri,
    order: Order,
    reply: oneshot::Sender<Reply>,
}

impl Runner {
    /// A simulation that was not started yet, of the program that consists of these files.
    pub(super) fn new(files: Vec<Uri>, workspace: &Arc<Workspace>) -> Runner {
        let (sender, receiver) = channel();
        let is_alive = Arc::new(AtomicBool::new(true));
        let (alive, workspace) = (Arc::clone(&is_alive), Arc::downgrade(workspace));
        let files = Arc::new(RwLock::new(files));
        let shared = Arc::clone(&files);
        let tokio = tokio::runtime::Handle::current();
        std::thread::spawn(move || {
            let mut thread = Thread { files: shared, workspace, tokio, running: None, waiting: None };
            let _mark = Mark(alive);
            thread.run(&receiver);
        });
        Runner { sender, is_alive, files }
    }

    /// Whether it still listens.
    pub(super) fn is_alive(&self) -> bool {
        self.is_alive.load(Ordering::Acquire)
    }

    /// Whether a file is one of those of its program.
    pub(super) fn runs(&self, uri: &Uri) -> bool {
        self.files.read().unwrap_or_else(PoisonError::into_inner).contains(uri)
    }

    /// Tells it something for who looks at the file at `uri`, and gives its answer.
    pub(super) async fn ask(&self, uri: Uri, order: Order) -> Reply {
        let (reply, answer) = oneshot::channel();
        let gone = || Message::new("simulate.not-running");
        self.sender.send(Asked { uri, order, reply }).map_err(|_| gone())?;
        answer.await.map_err(|_| gone())?
    }
}

struct Thread {
    /// The files of the program that runs, for who looks for it.
    files: Arc<RwLock<Vec<Uri>>>,
    workspace: Weak<Workspace>,
    tokio: tokio::runtime::Handle,
    running: Option<Running>,
    /// Who waits until the task is done, looking at which file.
    waiting: Option<(Uri, oneshot::Sender<Reply>)>,
}

/// A program that runs, or pauses.
struct Running {
    session: Session,
    /// Code that says what it sees, once somebody has looked: it takes as long to make as the code that runs.
    watched: Option<Arc<Code>>,
    /// The files that were compiled.
    files: Vec<File>,
    /// One of them that the editor has, through which the program is found.
    uri: Uri,
    /// Whether the text is no longer what runs.
    is_outdated: bool,
    is_paused: bool,
    /// Whether nothing follows.
    is_over: bool,
    task: Option<Task>,
    /// Simulated time for each unit of real time; 0 for as fast as can be.
    speed: f64,
    scan_ns: i64,
    /// A moment of real time and of simulated time that are the same.
    since: (Instant, i64),
    /// What was done since the program began, for a scenario test.
    recording: Recording,
    screens: Screens,
    recorder: Recorder,
    alarms: Watchman<Variable>,
    /// How often the program was made into code.
    edition: u64,
    /// How often scans were taken back.
    branch: u64,
    errors: Vec<Error>,
    sights: Vec<Sight<u8>>,
    /// What drives what, once somebody has asked why.
    drivers: Option<Drivers>,
    /// When the client was told last.
    shown: Option<Instant>,
    is_news: bool,
}

/// How often the client is told something.
const PICTURE: Duration = Duration::from_millis(33);
/// So long scans are run before the next order is looked for.
const SLICE: Duration = Duration::from_millis(10);
/// A simulation that is so far behind does not catch up.
const TOO_LATE: Duration = Duration::from_millis(500);
/// How often a simulation that pauses looks for edits.
const IDLE: Duration = Duration::from_millis(100);

impl Thread {
    fn run(&mut self, receiver: &Receiver<Asked>) {
        loop {
            let wait = self.running.as_ref().map_or(Duration::from_secs(60), Running::wait);
            match receiver.recv_timeout(wait) {
                Ok(Asked { uri, order, reply }) => {
                    if !matches!(order, Order::Ask(_)) {
                        // What takes long ends where it is when something else is wanted.
                        self.end_task();
                    }
                    let answer = self.obey(order, &uri);
                    // The last picture comes before the answer, behind which another simulation may begin.
                    self.show();
                    let has_task = self.running.as_ref().is_some_and(|running| running.task.is_some());
                    if has_task && self.waiting.is_none() && answer.is_ok() {
                        self.waiting = Some((uri, reply));
                    } else {
                        // Who asked may have gone.
                        let _ = reply.send(answer);
                    }
                    if self.running.is_none() {
                        return;
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            let Some(workspace) = self.workspace.upgrade() else { return };
            self.follow(&workspace);
            if let Some(running) = &mut self.running {
                running.advance();
                if running.task.is_none() {
                    self.end_task();
                }
            }
            self.show();
            if self.running.as_ref().is_some_and(|running| running.is_over) {
                return;
            }
        }
    }

    /// Takes over what edits made of the program, and lets others know which files it has.
    fn follow(&mut self, workspace: &Workspace) {
        let Some(running) = &mut self.running else { return };
        running.follow(workspace);
        let is_known = {
            let known = self.files.read().unwrap_or_else(PoisonError::into_inner);
            known.iter().eq(running.files.iter().map(|(uri, ..)| uri))
        };
        if !is_known {
            let files = running.files.iter().map(|(uri, ..)| uri.clone()).collect();
            *self.files.write().unwrap_or_else(PoisonError::into_inner) = files;
        }
    }

    /// Tells the client what it shows, if it is time for that.
    fn show(&mut self) {
        let (Some(running), Some(workspace)) = (&mut self.running, self.workspace.upgrade()) else { return };
        if running.is_over {
            running.alarms.end(running.session.machine().now_ns());
        }
        running.alarms.tell(&self.tokio, &workspace, &running.uri);
        let pictures = running.pictures(&workspace);
        if pictures.is_empty() {
            return;
        }
        let client = workspace.client.clone();
        let is_last = running.is_over;
        let sent = async move {
            for picture in pictures {
                client.send_notification::<MonitorMethod>(picture).await;
            }
        };
        if is_last {
            self.tokio.block_on(sent);
        } else {
            self.tokio.spawn(sent);
        }
    }

    /// Ends what takes long, done or not, and tells who waits for it.
    fn end_task(&mut self) {
        let (Some(running), Some(workspace)) = (&mut self.running, self.workspace.upgrade()) else { return };
        running.task = None;
        if let Some((uri, waiting)) = self.waiting.take() {
            let _ = waiting.send(Ok(running.state(&workspace, &uri, None)));
        }
    }

    fn obey(&mut self, order: Order, uri: &Uri) -> Reply {
        let gone = || Message::new("simulate.not-running");
        let workspace = self.workspace.upgrade().ok_or_else(gone)?;
        if let Order::Start { scan_ms, speed, is_paused } = order {
            // The files that belong to the program are to be known.
            self.tokio.block_on(workspace.settled());
            self.start(&workspace, uri, scan_ms, speed, is_paused)?;
        }
        // Who has just opened a file of the program is to be known.
        self.follow(&workspace);
        let running = self.running.as_mut().ok_or_else(gone)?;
        match order {
            Order::Ask(question) => return running.answer(question, &workspace, uri),
            Order::Do(deed) => running.obey(deed)?,
            Order::Start { .. } => {}
        }
        running.locate(&workspace);
        Ok(running.state(&workspace, uri, None))
    }

    /// Begins to run the program as it is now, in the place of the one that ran before.
    fn start(
        &mut self,
        workspace: &Workspace,
        uri: &Uri,
        scan_ms: Option<f64>,
        speed: Option<f64>,
        is_paused: bool,
    ) -> Result<(), Message> {
        let mut running = Running::start(workspace, uri)?;
        if let Some(scan_ms) = scan_ms {
            if !SCAN_MS.contains(&scan_ms) {
                return Err(Message::new("simulate.scan-time").with("value", scan_ms));
            }
            running.scan_ns = (scan_ms * 1e6) as i64;
        }
        running.set_speed(speed)?;
        running.is_paused = is_paused;
        if let Some(before) = self.running.take() {
            running.session.take_over(before.session.machine());
            (running.screens, running.alarms) = (before.screens, before.alarms);
            (running.edition, running.branch) = (before.edition + 1, before.branch + 1);
        }
        running.watch_alarms(workspace);
        // The first scan is there as soon as it is asked for.
        running.scan();
        running.resume();
        self.running = Some(running);
        Ok(())
    }
}

impl Running {
    /// Compiles the program that the document at `uri` is a part of.
    fn start(workspace: &Workspace, uri: &Uri) -> Result<Running, Message> {
        let around = around(workspace, uri).ok_or_else(|| Message::new("simulate.not-running"))?;
        let files = files(&around);
        let code = compiled(&files, false)?;
        Ok(Running {
            session: Session::new(code).with_limit(history_limit(workspace, uri)),
            watched: None,
            files,
            is_outdated: false,
            is_paused: false,
            is_over: false,
            uri: uri.clone(),
            task: None,
            speed: 1.0,
            scan_ns: 10_000_000,
            since: (Instant::now(), 0),
            recording: Recording::default(),
            screens: Screens::default(),
            recorder: Recorder::default(),
            alarms: Watchman::new("simulator"),
            edition: 0,
            branch: 0,
            errors: Vec::new(),
            sights: Vec::new(),
            drivers: None,
            shown: None,
            is_news: true,
        })
    }

    /// How long ago the client was told something.
    fn since_picture(&self) -> Duration {
        self.shown.map_or(Duration::MAX, |shown| shown.elapsed())
    }

    /// How long there is nothing to do.
    fn wait(&self) -> Duration {
        let until_picture = PICTURE.saturating_sub(self.since_picture());
        if self.task.is_some() {
            return Duration::ZERO;
        }
        match (self.is_paused, self.is_news) {
            (true, true) => until_picture,
            (true, false) => IDLE,
            (false, _) if self.speed == 0.0 => Duration::ZERO,
            (false, _) => {
                let behind_ns = self.due_ns() - self.next_ns();
                let ahead = Duration::from_nanos(((-behind_ns).max(0) as f64 / self.speed) as u64);
                ahead.min(IDLE)
            }
        }
    }

    /// The simulated time that it should be.
    fn due_ns(&self) -> i64 {
        let (real, simulated) = self.since;
        simulated + (real.elapsed().as_nanos() as f64 * self.speed) as i64
    }

    /// When the next scan begins.
    fn next_ns(&self) -> i64 {
        let machine = self.session.machine();
        if machine.scans() == 0 { 0 } else { machine.now_ns() + self.scan_ns.max(machine.least_scan_ns()) }
    }

    /// Simulated time goes on from here.
    fn resume(&mut self) {
        self.since = (Instant::now(), self.next_ns());
    }

    fn set_speed(&mut self, speed: Option<f64>) -> Result<(), Message> {
        if let Some(speed) = speed {
            if !(speed.is_finite() && speed >= 0.0) {
                return Err(Message::new("simulate.speed").with("value", speed));
            }
            self.speed = speed.min(1e6);
        }
        self.resume();
        Ok(())
    }

    /// Runs the scans that are due.
    fn advance(&mut self) {
        let started = Instant::now();
        if let Some(task) = self.task.take() {
            self.task = self.go_on(task, || started.elapsed() < SLICE);
        }
        if self.is_paused || self.is_over {
            return;
        }
        while self.speed == 0.0 || self.next_ns() <= self.due_ns() {
            self.scan();
            if started.elapsed() >= SLICE {
                break;
            }
        }
        let late_ns = self.due_ns() - self.next_ns();
        if self.speed > 0.0 && late_ns > (TOO_LATE.as_nanos() as f64 * self.speed) as i64 {
            self.resume();
        }
    }

    /// Goes on with what takes long while there is time; gives what is left of it.
    fn go_on(&mut self, task: Task, has_time: impl Fn() -> bool) -> Option<Task> {
        match task {
            Task::Steps(mut left) => {
                while left > 0 {
                    self.scan();
                    left -= 1;
                    if !has_time() {
                        break;
                    }
                }
                (left > 0).then_some(Task::Steps(left))
            }
            Task::BackTo(mut search) => match search.look(&self.session, has_time) {
                None => Some(Task::BackTo(search)),
                Some(changed) => {
                    // To before the change, so that the next step shows it.
                    self.go_back(changed.map_or(self.session.first_scan(), |scan| scan - 1));
                    None
                }
            },
        }
    }

    fn scan(&mut self) {
        let next = self.next_ns();
        let is_picture = !self.is_outdated && self.screens.has_text() && self.since_picture() >= PICTURE;
        let outcome = match self.watched.as_ref().filter(|_| is_picture) {
            Some(watched) => {
                let sights = &mut self.sights;
                let shown = self.screens.instructions(watched);
                sights.clear();
                self.session.scan_seen(next, watched, |sight| {
                    if shown.iter().any(|part| part.contains(&sight.instruction)) {
                        sights.push(sight);
                    }
                })
            }
            None => {
                self.sights.clear();
                self.session.scan(next)
            }
        };
        self.is_news = true;
        let machine = self.session.machine();
        self.recorder.note(machine);
        self.alarms.look(machine.now_ns(), &|variable| machine.value(variable, 0));
        self.note(outcome.errors);
    }

    fn note(&mut self, errors: Vec<Error>) {
        for error in errors {
            let is_same = |known: &Error| known.place == error.place && known.kind == error.kind;
            if !self.errors.iter().any(is_same) {
                self.errors.push(error);
            }
        }
    }

    /// Does what it is told.
    fn obey(&mut self, deed: Deed) -> Result<(), Message> {
        // What was seen in the last scan stays true until another one is run, or taken back.
        self.is_news = true;
        match deed {
            Deed::Stop => self.is_over = true,
            Deed::Pause => self.is_paused = true,
            Deed::Run { speed } => {
                self.set_speed(speed)?;
                self.is_paused = false;
            }
            Deed::Step { count } => {
                self.is_paused = true;
                self.task = Some(Task::Steps(count));
            }
            Deed::StepBack { count, change_of } => self.step_back(count, change_of)?,
            Deed::Reset => {
                let code = Arc::clone(self.session.machine().code());
                let mut session = Session::new(code).with_limit(self.session.limit());
                session.take_over(self.session.machine());
                self.session = session;
                self.errors.clear();
                self.recorder.clear();
                self.branch += 1;
                self.recording = Recording::default();
                self.scan();
                self.resume();
            }
            Deed::Set { name, value, is_force } => self.set(&name, &value, is_force)?,
            Deed::Release { name: Some(name) } => {
                self.session.touch(self.variable(&name)?.release());
                self.recording.note(self.session.machine().scans(), &name, InputKind::Release);
            }
            Deed::Release { name: None } => {
                self.recording.release_all(self.session.machine().scans());
                self.session.touch(Touch::LetAllGo);
            }
        }
        Ok(())
    }

    fn step_back(&mut self, count: u64, change_of: Option<String>) -> Result<(), Message> {
        match change_of {
            None => {
                let scans = self.session.machine().scans();
                if self.session.is_cut() && scans == self.session.first_scan() {
                    let begins = Message::new("simulate.history-begins");
                    return Err(begins.with("limit", self.session.limit()));
                }
                self.go_back(scans.saturating_sub(count));
            }
            Some(name) => {
                let variable = self.variable(&name)?;
                let now = self.session.machine().scans();
                let search = ChangeSearch::new(now, move |machine| machine.value(variable, 0));
                self.task = Some(Task::BackTo(Box::new(search)));
            }
        }
        self.is_paused = true;
        Ok(())
    }

    /// Goes back to the PLC as it was after a scan.
    fn go_back(&mut self, to: u64) {
        self.sights.clear();
        self.is_news = true;
        // Something of the first scan remains to be seen.
        self.session.back_to(to.max(self.session.first_scan()).max(1));
        self.recorder.cut(self.session.machine());
        self.branch += 1;
        self.recording.back_to(self.session.machine().scans());
        self.errors.clear();
        self.resume();
    }

    fn variable(&self, name: &str) -> Result<Variable, Message> {
        let found = self.session.machine().code().variable(name);
        found.ok_or_else(|| Message::new("cli.run-unknown").with("name", name))
    }

    fn set(&mut self, name: &str, value: &Json, is_force: bool) -> Result<(), Message> {
        let variable = self.variable(name)?;
        let code = self.session.machine().code();
        let value =
            Value::of_json(value).ok_or_else(|| Message::new("cli.run-no-value").with("name", name))?;
        let touch = match is_force {
            true => variable.force(code, &value),
            false => variable.set(code, &value),
        };
        let touch = touch.ok_or_else(|| variable.refusal(code, name, &value))?;
        let kind = if is_force { InputKind::Force } else { InputKind::Set };
        self.recording.note(self.session.machine().scans(), name, kind(value));
        self.session.touch(touch);
        Ok(())
    }

    /// Takes over what edits made of the program, if that can be run.
    fn follow(&mut self, workspace: &Workspace) {
        let snapshot = workspace.snapshot();
        if snapshot.open(&self.uri).is_none() {
            let mut others = self.files.iter().map(|(uri, ..)| uri);
            match others.find(|uri| snapshot.open(uri).is_some()) {
                Some(other) => self.uri = other.clone(),
                // Nobody sees any more what a program does of which no document is open.
                None => (self.is_over, self.is_news) = (true, true),
            }
        }
        let uri = &self.uri.clone();
        self.session.set_limit(history_limit(workspace, uri));
        let Some(around) = around(workspace, uri) else { return };
        let is_same = |(uri, version, document): &File| {
            around.files().iter().any(|open| {
                // Whoever closes a document and opens it again may count its versions from the same number.
                open.uri == *uri && open.version == *version && open.document.is_instance(document)
            })
        };
        if self.files.iter().all(is_same) {
            if self.alarms.is_outdated(workspace, uri) {
                self.watch_alarms(workspace);
            }
            return;
        }
        let files = files(&around);
        self.is_news = true;
        match compiled(&files, false) {
            Ok(code) => {
                self.task = None;
                if !self.session.adopt(code) {
                    self.recorder.adopt(self.session.machine());
                }
                self.edition += 1;
                (self.watched, self.is_outdated) = (None, false);
                self.sights.clear();
                self.watch_alarms(workspace);
            }
            Err(_) => self.is_outdated = true,
        }
        (self.files, self.drivers) = (files, None);
        self.locate(workspace);
    }

    /// Code that says what it sees; what could be compiled without that can be with it.
    fn watched(&mut self) -> Arc<Code> {
        if self.watched.is_none() {
            self.watched = compiled(&self.files, true).ok();
        }
        self.watched.clone().unwrap_or_else(|| Arc::clone(self.session.machine().code()))
    }

    /// Watches the alarms of the project in the program as it is now.
    fn watch_alarms(&mut self, workspace: &Workspace) {
        let names = NamesOfCode { code: self.session.machine().code(), instruction: None };
        self.alarms.follow(workspace, &self.uri, &names);
    }

    /// Finds what the client shows in the text as it is now.
    pub(super) fn locate(&mut self, workspace: &Workspace) {
        self.screens.place(&self.files, workspace.snapshot().manner);
    }
}

/// What the project around `uri` allows the history of a simulation to take.
fn history_limit(workspace: &Workspace, uri: &Uri) -> HistoryLimit {
    workspace.snapshot().program(uri).map(|open| open.manifest.history()).unwrap_or_default()
}

/// Times from one scan to the next, in milliseconds.
const SCAN_MS: std::ops::RangeInclusive<f64> = 0.001..=60_000.0;
