//! The line that a verb speaks on, and how its failures are told.

use crate::cli::Outcome;
use crate::cli::input::{complain, remark};
use crate::cli::progress::interruption;
use crate::cli::run::duration;
use crate::link::{Host, Line, LinkError, Patience, Progress, Speed, Stage, Transport, transport};
use crate::project::Project;
use crate::text::{Language, Message};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

#[derive(clap::Args)]
pub(in crate::cli) struct Connection {
    /// The port: /dev/ttyUSB0, COM3, or tcp://HOST:PORT [default: `port` in rungwise.toml].
    #[arg(long, value_name = "PORT")]
    port: Option<String>,
    /// Time for an answer to begin.
    #[arg(long, value_name = "TIME", value_parser = duration, default_value = "1s")]
    timeout: i64,
    /// The speed to which the line is switched: 19200, 38400, 57600 or 115200 [default: 9600, as it is].
    #[arg(long, value_name = "BAUD", value_parser = speed)]
    baud: Option<u32>,
}

/// A speed to which a line can be switched, in bits a second.
fn speed(word: &str) -> Result<u32, String> {
    let baud = word.parse().ok().filter(|baud| Speed::of_baud(*baud).is_some());
    baud.ok_or_else(|| word.to_string())
}

/// A host on whatever line the user has named.
pub(super) type AnyHost = Host<Box<dyn Transport>>;

impl Connection {
    /// The port that the user or the project of `beside` names.
    pub(super) fn port(&self, beside: &Path) -> Option<String> {
        let of_project = || Project::of(beside).and_then(|project| project.manifest.port);
        self.port.clone().or_else(of_project)
    }

    /// Connects to the PLC that the user or the project of `beside` names.
    ///
    /// # Errors
    /// With the outcome, after a complaint.
    pub(super) fn open(&self, beside: &Path, language: Language) -> Result<AnyHost, Outcome> {
        let Some(port) = self.port(beside) else {
            let reason = Message::new("link.which-port").render(language);
            complain("no-port", &reason, &Message::new("link.help-which-port").render(language), language);
            return Err(Outcome::Unusable);
        };
        self.connect(&port).map_err(|error| failed(&error, language))
    }

    fn connect(&self, port: &str) -> Result<AnyHost, LinkError> {
        let patience =
            Patience { answer: Duration::from_nanos(self.timeout.max(1) as u64), ..Patience::default() };
        let mut line = Line::new(transport::open(port)?, patience, interruption());
        let Some(baud) = self.baud else { return Host::connect(line) };
        line.check_speed()?;
        match line.greet() {
            Ok(()) => {
                let mut host = Host::connect(line)?;
                host.set_speed(baud)?;
                Ok(host)
            }
            // It may still have the speed of the last session.
            Err(LinkError::NoAnswer) => {
                line.set_baud(baud)?;
                Host::connect(line)
            }
            Err(error) => Err(error),
        }
    }
}

/// Complains about a failure of the line.
pub(super) fn failed(error: &LinkError, language: Language) -> Outcome {
    complain(error.code(), &error.message().render(language), &error.help().render(language), language);
    if error.is_of_line() { Outcome::LinkFailed } else { Outcome::Findings }
}

/// Whether the user has ended something is looked at so often.
pub(super) const ATTENTION: Duration = Duration::from_millis(50);

/// A bar on a terminal, nothing elsewhere.
pub(super) struct Bar {
    bar: Option<(Stage, ProgressBar)>,
    language: Language,
}

impl Bar {
    pub(super) fn new(language: Language) -> Bar {
        Bar { bar: None, language }
    }

    /// Shows how far something is.
    pub(super) fn show(&mut self, progress: Progress) {
        let is_same = self.bar.as_ref().is_some_and(|(stage, _)| *stage == progress.stage);
        if !is_same {
            self.clear();
            let bar = ProgressBar::new(progress.total as u64);
            let word = progress.stage.message().render(self.language);
            let template = "{msg} {bar:30} {percent:>3} %  {bytes}/{total_bytes}  {prefix}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar.set_message(word);
            self.bar = Some((progress.stage, bar));
        }
        let Some((_, bar)) = &self.bar else { return };
        bar.set_length(progress.total as u64);
        bar.set_prefix(format!("{} s", progress.remaining.as_secs_f64().ceil()));
        bar.set_position(progress.done as u64);
    }

    /// Takes it away.
    pub(super) fn clear(&mut self) {
        if let Some((_, bar)) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

/// Asks on the terminal whether to go on; without one, only if the user has said yes before.
pub(super) fn confirmed(question: &Message, is_yes: bool, host: &mut AnyHost, language: Language) -> bool {
    use std::io::{IsTerminal, Write};
    if is_yes {
        return true;
    }
    if !std::io::stdin().is_terminal() {
        let reason = question.render(language);
        complain("not-confirmed", &reason, &Message::new("link.help-yes").render(language), language);
        return false;
    }
    let _ = write!(std::io::stderr(), "{} [y/N] ", question.render(language));
    let answer = typed(host).unwrap_or_default();
    let is_confirmed = matches!(answer.trim().to_lowercase().as_str(), "y" | "yes" | "是");
    if !is_confirmed {
        remark(&Message::new("link.cancelled").render(language));
    }
    is_confirmed
}

/// A line that somebody types; nothing if Ctrl-C comes in its place. Reading goes on behind a signal, so it is left to
/// a thread, which ends with the process.
fn typed(host: &mut AnyHost) -> Option<String> {
    let (sender, line) = channel();
    std::thread::spawn(move || {
        let mut answer = String::new();
        if std::io::stdin().read_line(&mut answer).is_ok() {
            // Nobody waits any more if it comes too late.
            let _ = sender.send(answer);
        }
    });
    loop {
        match line.recv_timeout(ATTENTION) {
            Ok(answer) => return Some(answer),
            Err(RecvTimeoutError::Timeout) if !host.line().is_cancelled() => {}
            Err(_) => return None,
        }
    }
}
