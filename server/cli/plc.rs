//! `rungwise plc`: the virtual PLC.

use super::Outcome;
use super::check::target_named;
use super::encode::encoded;
use super::input::{caution, complain, remark, say};
use super::progress::interruption;
use super::run::distance;
use crate::link::Switch;
use crate::link::plc::{Faults, Listener, Plc, Saved, Server, Service};
use crate::link::transport::pty;
use crate::simulate::Setting;
use crate::target::{Model, Target};
use crate::text::{Language, Message};
use clap::ValueEnum;
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The address to listen on; port 0 is any that is free.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:5551", conflicts_with = "pty")]
    listen: String,
    /// Listen on a pseudo terminal, which hosts open as a serial port.
    #[arg(long)]
    pty: bool,
    /// The model [default: that of the program, else fx2n].
    #[arg(long, value_name = "MODEL", value_parser = target_named)]
    model: Option<&'static Target>,
    /// Thousands of steps of its memory [default: as the model comes].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=16))]
    memory: Option<u16>,
    /// A program that is in the memory from the beginning.
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Where program and latched devices are kept from one run to the next.
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// The switch on the PLC.
    #[arg(long, value_enum, default_value = "run")]
    switch: SwitchWord,
    /// Time from one scan to the next.
    #[arg(long, value_name = "TIME", value_parser = distance, default_value = "10ms")]
    scan_time: i64,
    /// Run one scan for each request, so that what a host sees depends on nothing but what it asked.
    #[arg(long)]
    stepped: bool,
    /// The speed of the line in bits a second; as fast as can be if left out.
    #[arg(long, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(300..=1_000_000))]
    baud: Option<u32>,
    /// Faults on the line: drop=0.01,flip=0.001,duplicate=0.01,delay=0.1:200ms,disconnect=0.001,nak=0.05,seed=7.
    #[arg(long, value_name = "FAULTS", default_value = "")]
    faults: String,
}

/// The switch on the PLC.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SwitchWord {
    /// The PLC runs.
    Run,
    /// The PLC waits for orders.
    Stop,
}

impl From<SwitchWord> for Switch {
    fn from(word: SwitchWord) -> Switch {
        match word {
            SwitchWord::Run => Switch::Run,
            SwitchWord::Stop => Switch::Stop,
        }
    }
}

/// How often the memory is kept while the program changes it.
const KEEPING_NS: i64 = 1_000_000_000;

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let faults = match Faults::read(&arguments.faults) {
        Ok(faults) => faults,
        Err(reason) => return unusable("bad-faults", &reason, "link.help-faults", language),
    };
    let Some(mut plc) = plc_of(arguments, language) else { return Outcome::Unusable };
    plc.power_on(arguments.switch.into(), 0);
    let model = plc.target().title;
    let server = match arguments.stepped {
        true => Server::stepped(plc, arguments.scan_time),
        false => Server::new(plc),
    };
    let mut person = Person {
        words: words_from_input(),
        end: interruption(),
        kept_ns: 0,
        state: arguments.state.clone(),
        is_unkept: false,
        language,
    };
    let mut attend = |server: &mut Server, now_ns: i64| person.attend(server, now_ns);
    let service = Service::new(server, faults, arguments.baud, &mut attend);
    let ready = |port: &str| {
        say(&Message::new("link.listening").with("model", model).with("port", port).render(language));
        say("\n");
    };
    if arguments.pty {
        let (mut transport, name, _other_end) = match pty() {
            Ok(ends) => ends,
            Err(error) => {
                let reason = Message::new("link.no-pty").with("reason", error);
                return unusable("no-pty", &reason, "link.help-no-pty", language);
            }
        };
        ready(&name);
        service.on_line(&mut transport);
        return Outcome::Clean;
    }
    let bound = Listener::bind(&arguments.listen).and_then(|listener| Ok((listener.address()?, listener)));
    let (address, listener) = match bound {
        Ok(bound) => bound,
        Err(error) => {
            let reason =
                Message::new("link.cannot-listen").with("address", &arguments.listen).with("reason", error);
            return unusable("cannot-listen", &reason, "link.help-cannot-listen", language);
        }
    };
    if !address.ip().is_loopback() {
        let reason = Message::new("link.open-to-all").with("address", address).render(language);
        caution("open-to-all", &reason, &Message::new("link.help-open-to-all").render(language), language);
    }
    ready(&format!("tcp://{address}"));
    match service.on_tcp(&listener) {
        Ok(()) => Outcome::Clean,
        Err(error) => {
            let reason = Message::new("link.gone").with("reason", error);
            unusable("line-gone", &reason, "link.help-gone", language)
        }
    }
}

fn unusable(code: &str, reason: &Message, help: &'static str, language: Language) -> Outcome {
    complain(code, &reason.render(language), &Message::new(help).render(language), language);
    Outcome::Unusable
}

/// The PLC as it was left, or a new one, with the program that it is to have; nothing after complaints.
fn plc_of(arguments: &Arguments, language: Language) -> Option<Plc> {
    let program = match &arguments.program {
        Some(path) => Some(encoded(path, arguments.model, language).ok()?),
        None => None,
    };
    let saved = match arguments.state.as_deref().filter(|path| path.exists()) {
        Some(path) => Some(restored(path, arguments.scan_time, language)?),
        None => None,
    };
    let of_program = program.as_ref().map(|program| program.target);
    let target = arguments.model.or(of_program).unwrap_or(Target::of(Model::Fx2n));
    if !target.is_fx() {
        let reason = Message::new("link.no-model").with("target", target.name);
        unusable("target-refused", &reason, "link.help-unknown-type", language);
        return None;
    }
    // Of a PLC that was left nothing is lost because another model is asked for.
    let asked = arguments.model.or(of_program);
    if let (Some(path), Some(plc), Some(asked)) = (&arguments.state, &saved, asked)
        && asked.model != plc.target().model
    {
        let reason = Message::new("link.state-of-other");
        let reason = reason.with("kept", plc.target().title).with("model", asked.title);
        bad_state(path, &reason, language);
        return None;
    }
    let most = target.limits.steps_at_most / 1000;
    if let Some(thousands) = arguments.memory.filter(|thousands| u32::from(*thousands) > most) {
        let reason = Message::new("link.memory-too-large").with("model", target.title);
        let reason = reason.with("asked", thousands).with("most", most);
        unusable("memory-too-large", &reason, "link.help-memory", language);
        return None;
    }
    let is_kept = saved.is_some();
    let mut plc = saved.unwrap_or_else(|| {
        let plc = Plc::new(target, arguments.scan_time);
        match arguments.memory {
            Some(thousands) => plc.with_memory(thousands),
            None => plc,
        }
    });
    if let Some(program) = program {
        let words = program.words();
        if let Some(path) = arguments.state.as_deref().filter(|_| is_kept && !plc.words().starts_with(&words))
        {
            remark(&Message::new("link.program-not-kept").with("path", path.display()).render(language));
        }
        plc.load(&words);
    }
    // What cannot be kept is said before somebody relies on it.
    if let Some(path) = &arguments.state {
        plc.forget_saving();
        let kept = plc.save().map_or(Ok(()), |saved| written(path, &saved, true));
        if let Err(error) = kept {
            let reason = format!("{}: {error}", path.display());
            complain("unwritable", &reason, &Message::new("cli.make-room").render(language), language);
            return None;
        }
    }
    Some(plc)
}

fn bad_state(path: &Path, reason: &Message, language: Language) {
    let reason = format!("{}: {}", path.display(), reason.render(language));
    complain("bad-state", &reason, &Message::new("link.help-state").render(language), language);
}

fn restored(path: &Path, scan_ns: i64, language: Language) -> Option<Plc> {
    let read = || -> Result<Plc, Message> {
        let wrong = |reason: String| Message::new("link.state-unreadable").with("reason", reason);
        let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
        let saved: Saved = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        Plc::restored(&saved, scan_ns)
    };
    match read() {
        Ok(plc) => Some(plc),
        Err(reason) => {
            bad_state(path, &reason, language);
            None
        }
    }
}

/// The person in front of the PLC: switches inputs, turns its switch, looks at it.
struct Person {
    words: Receiver<String>,
    /// Whether the process is told to end.
    end: Arc<AtomicBool>,
    kept_ns: i64,
    state: Option<PathBuf>,
    /// Whether the last try to keep it failed, which is told once.
    is_unkept: bool,
    language: Language,
}

/// The lines of standard input.
fn words_from_input() -> Receiver<String> {
    let (sender, words) = channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    words
}

impl Person {
    /// Does what was typed; whether to go on.
    fn attend(&mut self, server: &mut Server, now_ns: i64) -> bool {
        loop {
            match self.words.try_recv() {
                Ok(line) if matches!(line.trim(), "quit" | "exit") => {
                    self.keep(server);
                    return false;
                }
                Ok(line) => {
                    let answer = self.obey(server, line.trim(), now_ns);
                    say(&answer.map_or(String::new(), |answer| format!("{answer}\n")));
                }
                // A PLC without anybody in front of it goes on.
                Err(TryRecvError::Empty | TryRecvError::Disconnected) => break,
            }
        }
        let is_ended = self.end.load(Ordering::Relaxed);
        // A host that was told that its program is there may rely on it.
        if is_ended || server.plc().is_taken_over() || now_ns - self.kept_ns >= KEEPING_NS {
            self.kept_ns = now_ns;
            self.keep(server);
        }
        !is_ended
    }

    /// Does what a line says; gives what is answered.
    fn obey(&self, server: &mut Server, line: &str, now_ns: i64) -> Option<String> {
        let code = Arc::clone(server.plc().machine().code());
        match line {
            "" => return None,
            "run" => server.plc_mut().turn(Switch::Run, now_ns),
            "stop" => server.plc_mut().turn(Switch::Stop, now_ns),
            _ => {
                let set = Setting::read(line).ok().and_then(|setting| {
                    let variable = code.variable(&setting.name)?;
                    server.plc_mut().put(variable, &setting.value);
                    Some(String::new())
                });
                let shown = set.or_else(|| Some(format!("{line} = {}", server.plc().shown(line)?)));
                let unknown = || Message::new("link.plc-words").with("line", line).render(self.language);
                return Some(shown.unwrap_or_else(unknown)).filter(|answer| !answer.is_empty());
            }
        }
        None
    }

    fn keep(&mut self, server: &mut Server) {
        let Some(path) = &self.state else { return };
        // A program that was taken over outlasts the loss of power as well.
        let is_synced = server.plc().is_taken_over() || self.end.load(Ordering::Relaxed);
        let Some(saved) = server.plc_mut().save() else { return };
        let kept = written(path, &saved, is_synced);
        if let Err(error) = &kept {
            server.plc_mut().forget_saving();
            if !self.is_unkept {
                remark(&format!("{}: {error}", path.display()));
            }
        }
        self.is_unkept = kept.is_err();
    }
}

/// Puts the memory into a file that is whole at any time, for nobody else to read; on the disk itself if `is_synced`.
fn written(path: &Path, saved: &Saved, is_synced: bool) -> std::io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    serde_json::to_writer(&mut file, saved)?;
    file.flush()?;
    if is_synced {
        file.as_file().sync_all()?;
    }
    file.persist(path)?;
    Ok(())
}
