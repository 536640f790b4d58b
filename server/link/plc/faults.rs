//! Faults on the way, as they happen on real lines: for tests, and for learning what a tool says of them.

use crate::text::Message;
use std::collections::VecDeque;

/// How often which fault happens, for each byte or each answer.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Faults {
    /// A byte gets lost.
    pub drop: f64,
    /// A bit of a byte turns over.
    pub flip: f64,
    /// A byte comes twice.
    pub duplicate: f64,
    /// Bytes come later by [`Faults::delay_ms`], and those behind them too.
    pub delay: f64,
    /// How much later, in milliseconds.
    pub delay_ms: u64,
    /// The line goes dead.
    pub disconnect: f64,
    /// The PLC says no instead of its answer.
    pub nak: f64,
    /// The same seed gives the same faults.
    pub seed: u64,
}

impl Faults {
    /// Reads `drop=0.01,flip=0.001,delay=0.1:200ms,disconnect=0.001,nak=0.05,duplicate=0.01,seed=7`.
    ///
    /// # Errors
    /// With the part that is not understood.
    pub fn read(words: &str) -> Result<Faults, Message> {
        let mut faults = Faults { delay_ms: 100, ..Faults::default() };
        for word in words.split(',').map(str::trim).filter(|word| !word.is_empty()) {
            let wrong = || Message::new("link.faults-wrong").with("word", word);
            let (name, value) = word.split_once('=').ok_or_else(wrong)?;
            let share = |text: &str| {
                let share = text.trim().parse::<f64>().ok().filter(|share| (0.0..=1.0).contains(share));
                share.ok_or_else(wrong)
            };
            match name.trim() {
                "drop" => faults.drop = share(value)?,
                "flip" => faults.flip = share(value)?,
                "duplicate" => faults.duplicate = share(value)?,
                "disconnect" => faults.disconnect = share(value)?,
                "nak" => faults.nak = share(value)?,
                "seed" => faults.seed = value.trim().parse().map_err(|_| wrong())?,
                "delay" => {
                    let (often, long) = value.split_once(':').unwrap_or((value, "100ms"));
                    faults.delay = share(often)?;
                    let time_ns = crate::simulate::duration(long.trim()).ok_or_else(wrong)?;
                    faults.delay_ms = u64::try_from(time_ns / 1_000_000).map_err(|_| wrong())?;
                }
                _ => return Err(wrong()),
            }
        }
        Ok(faults)
    }
}

/// Bytes that may be on the way: no host sends so many before it has heard of the first. More get lost, as where a
/// receiver is overrun.
const MOST_ON_THE_WAY: usize = 64 * 1024;

/// One direction of a line with faults. Bytes keep their order.
#[derive(Clone, Debug)]
pub struct Wire {
    faults: Faults,
    random: fastrand::Rng,
    /// When each byte arrives, in nanoseconds.
    on_the_way: VecDeque<(i64, u8)>,
    is_dead: bool,
}

impl Wire {
    /// A wire; `direction` makes two wires of one line differ.
    pub fn new(faults: Faults, direction: u64) -> Wire {
        let random = fastrand::Rng::with_seed(faults.seed.wrapping_mul(2).wrapping_add(direction));
        Wire { faults, random, on_the_way: VecDeque::new(), is_dead: false }
    }

    /// Whether the line is gone.
    pub fn is_dead(&self) -> bool {
        self.is_dead
    }

    /// The line is put together again.
    pub fn reconnect(&mut self) {
        self.is_dead = false;
        self.on_the_way.clear();
    }

    /// From now on there are other faults.
    pub fn set_faults(&mut self, faults: Faults) {
        self.faults = faults;
    }

    /// Whether an answer becomes a refusal.
    pub fn is_refused(&mut self) -> bool {
        self.happens(self.faults.nak)
    }

    /// Sends a byte that would arrive at `due_ns`; gives when it does arrive, or the one before it if it gets lost.
    pub fn send(&mut self, byte: u8, due_ns: i64) {
        if self.is_dead || self.happens(self.faults.disconnect) {
            self.is_dead = true;
            return;
        }
        if self.happens(self.faults.drop) || self.on_the_way.len() >= MOST_ON_THE_WAY {
            return;
        }
        let mut byte = byte;
        if self.happens(self.faults.flip) {
            byte ^= 1 << self.random.u32(0..7);
        }
        let delay_ns = i64::try_from(self.faults.delay_ms).unwrap_or(i64::MAX).saturating_mul(1_000_000);
        let late = if self.happens(self.faults.delay) { delay_ns } else { 0 };
        let before = self.on_the_way.back().map_or(i64::MIN, |(due, _)| *due);
        let due_ns = due_ns.saturating_add(late).max(before);
        self.on_the_way.push_back((due_ns, byte));
        if self.happens(self.faults.duplicate) {
            self.on_the_way.push_back((due_ns, byte));
        }
    }

    /// The next byte that has arrived.
    pub fn receive(&mut self, now_ns: i64) -> Option<u8> {
        let (due, byte) = *self.on_the_way.front()?;
        (due <= now_ns).then(|| {
            self.on_the_way.pop_front();
            byte
        })
    }

    /// When the next byte arrives.
    pub fn next_ns(&self) -> Option<i64> {
        self.on_the_way.front().map(|(due, _)| *due)
    }

    fn happens(&mut self, share: f64) -> bool {
        share > 0.0 && self.random.f64() < share
    }
}
