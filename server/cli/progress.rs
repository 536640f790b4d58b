//! How far long work has come: a bar on a terminal, nothing in a pipe; and whether its user has ended it.

use crate::text::{Language, Message};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Shorter work shows no bar.
const PATIENCE: Duration = Duration::from_millis(300);
/// So often the bar is drawn anew.
const PICTURE: Duration = Duration::from_millis(100);
/// The process has ended by Ctrl-C, as shells say it.
const INTERRUPTED: i32 = 130;

/// What Ctrl-C sets from now on, so that work ends in good order; a second one ends it at once.
pub(super) fn interruption() -> Arc<AtomicBool> {
    let is_ended = Arc::new(AtomicBool::new(false));
    let ended = Arc::clone(&is_ended);
    // Where signals cannot be caught the process ends by them, as any other does.
    let _ = ctrlc::set_handler(move || {
        if ended.swap(true, Ordering::Relaxed) {
            process::exit(INTERRUPTED);
        }
    });
    is_ended
}

/// Work that may take long.
pub(super) struct Progress {
    bar: ProgressBar,
    /// When the bar is to be looked at next.
    due: Instant,
    is_ended: Arc<AtomicBool>,
}

impl Progress {
    /// Work in so many parts, which [`interruption`] ends.
    pub(super) fn new(parts: u64) -> Progress {
        let is_ended = interruption();
        let bar = ProgressBar::with_draw_target(Some(parts), ProgressDrawTarget::hidden());
        Progress { bar, due: Instant::now() + PATIENCE, is_ended }
    }

    /// So many parts are done. Gives whether the user wants it to go on.
    pub(super) fn goes_on(&mut self, done: u64, language: Language) -> bool {
        let now = Instant::now();
        if now >= self.due {
            self.due = now + PICTURE;
            if self.bar.is_hidden() {
                self.show(language);
            }
            self.bar.set_position(done);
        }
        !self.is_ended.load(Ordering::Relaxed)
    }

    /// Shows the bar on standard error if that is a terminal.
    fn show(&mut self, language: Language) {
        let words = Message::new("cli.run-progress").with("done", "{pos}").with("all", "{len}");
        let template = format!("{{bar:40}} {{percent:>3}} % · {}", words.render(language));
        if let Ok(style) = ProgressStyle::with_template(&template) {
            self.bar.set_style(style);
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    /// Does what writes to the terminal while the bar is out of the way.
    pub(super) fn aside<T>(&self, write: impl FnOnce() -> T) -> T {
        self.bar.suspend(write)
    }

    /// Takes the bar away.
    pub(super) fn end(&self) {
        self.bar.finish_and_clear();
    }
}
