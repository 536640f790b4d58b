//! Durations of one kind of event, and the rows of the table.

use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

/// Durations of one kind of event, sorted.
pub struct Figures {
    durations: Vec<Duration>,
    /// The server's processor time for each event, where it was asked for.
    pub processor: Option<Duration>,
}

impl Figures {
    /// `rounds` events; some more come first, which warm caches and are not counted.
    pub fn of(rounds: usize, mut event: impl FnMut(usize) -> Duration) -> Figures {
        let warming = rounds / 10 + 1;
        (0..warming).for_each(|round| _ = event(round));
        let mut durations: Vec<Duration> = (warming..warming + rounds).map(event).collect();
        durations.sort();
        Figures { durations, processor: None }
    }

    /// The value below which `percent` of the durations lie.
    pub fn percentile(&self, percent: usize) -> Duration {
        self.durations[(self.durations.len() - 1) * percent / 100]
    }
}

/// The table, printed row by row.
pub struct Table {
    /// The duration of a fixed piece of arithmetic, to which the figures are set in relation.
    pub calibration: Duration,
    /// Only rows that contain one of these words are measured; all if there are none.
    pub wanted: Vec<String>,
    /// The shortest durations of the rows so far.
    pub shortest: RefCell<Vec<(String, Duration)>>,
    /// Whether something has grown more than it may.
    pub missed: Cell<bool>,
}

impl Table {
    pub fn head(&self) {
        println!(
            "calibration: {} (2,000,000 steps of a pseudo-random generator)\n",
            milliseconds(self.calibration)
        );
        println!("| what | median | 95th percentile | median / calibration | server's processor | target |");
        println!("|---|---|---|---|---|---|");
    }

    /// Whether a row of this name is asked for.
    pub fn wants(&self, what: &str) -> bool {
        self.wanted.is_empty() || self.wanted.iter().any(|word| what.contains(word.as_str()))
    }

    pub fn row(&self, what: &str, target: &str, figures: &Figures) {
        let (median, p95) = (figures.percentile(50), figures.percentile(95));
        self.shortest.borrow_mut().push((what.to_string(), figures.percentile(0)));
        let ratio = median.as_secs_f64() / self.calibration.as_secs_f64();
        let processor = figures.processor.map_or(String::new(), milliseconds);
        let (median, p95) = (milliseconds(median), milliseconds(p95));
        println!("| {what} | {median} | {p95} | {ratio:.3} | {processor} | {target} |");
    }

    /// Rows that judge whether what ends in one of `kinds` takes no more than `most` times as long with `large` as the
    /// first word as with `small`. The shortest durations are compared: other work on the machine can only lengthen some.
    pub fn judge_growth(&self, small: &str, large: &str, kinds: &[&str], most: f64) {
        let shortest = self.shortest.borrow();
        for (name, short) in shortest.iter() {
            let Some(what) = name.strip_prefix(small) else { continue };
            let grown = shortest.iter().find(|(other, _)| other.strip_prefix(large) == Some(what));
            let Some((name, grown)) = grown else { continue };
            if !kinds.iter().any(|kind| what.ends_with(kind)) {
                continue;
            }
            let ratio = grown.as_secs_f64() / short.as_secs_f64();
            let judged = if ratio <= most { "holds" } else { "TOO MUCH" };
            self.missed.set(self.missed.get() || ratio > most);
            let value = format!("{ratio:.1} times: {judged}");
            self.value(
                &format!("{name}, to {}", small.trim_end_matches(", ")),
                &format!("<= {most} times"),
                &value,
            );
        }
    }

    /// A row with a value that is no duration.
    pub fn value(&self, what: &str, target: &str, value: &str) {
        println!("| {what} | {value} | | | | {target} |");
    }
}

pub fn milliseconds(duration: Duration) -> String {
    format!("{:.3} ms", duration.as_secs_f64() * 1e3)
}

/// The median duration of 2,000,000 steps of a pseudo-random generator.
pub fn calibrate() -> Duration {
    let figures = Figures::of(20, |round| {
        let started = Instant::now();
        let mut state = round as u64 + 88_172_645_463_325_252;
        for _ in 0..2_000_000 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
        }
        std::hint::black_box(state);
        started.elapsed()
    });
    figures.percentile(50)
}
