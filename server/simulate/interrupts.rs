//! Interrupts: when they are asked for, and when their routines run.
//!
//! Inputs, time and high-speed counters are looked at when a scan begins, so a routine runs at the first EI of that
//! scan, or not before one comes. Sources: the FX programming manuals on interrupts; that the lower pointer goes first,
//! that routines are not interrupted unless EI stands in them, and then one deep, is theirs as well.

use super::code::Code;
use crate::target::{Device, DeviceKind};

/// The interrupts of a PLC at work.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Interrupts {
    /// Whether they are allowed at present.
    pub(super) are_allowed: bool,
    /// The numbers of pointers whose routines wait, in the order in which they will run.
    waiting: Vec<u32>,
    /// Whether WDT has been executed since the watchdog was started.
    pub(super) is_watchdog_restarted: bool,
}

/// Routines that run one within the other.
pub(super) const MOST_NESTED: usize = 2;

/// Executions of a timer interrupt in one scan; if time makes a leap, the rest of it is lost.
const MOST_TIMES: i64 = 100;

impl Interrupts {
    /// Interrupts are off when a scan begins.
    pub(super) fn begin_scan(&mut self) {
        self.are_allowed = false;
        self.is_watchdog_restarted = false;
    }

    /// Asks for the interrupt with this number, once.
    pub(super) fn ask(&mut self, number: u32) {
        if let Err(place) = self.waiting.binary_search(&number) {
            self.waiting.insert(place, number);
        }
    }

    /// Asks for the interrupts of inputs that went on or off, from X0 to X5.
    pub(super) fn ask_for_edges(&mut self, code: &Code, was: [bool; 8], is: [bool; 8]) {
        for (number, _) in &code.interrupts {
            let (input, is_rising) = ((number / 100) as usize, number % 100 == 1);
            if number % 100 <= 1 && input < 6 && is[input] == is_rising && was[input] != is_rising {
                self.ask(*number);
            }
        }
    }

    /// Asks for timer interrupts: I610 every 10 ms.
    pub(super) fn ask_for_time(&mut self, code: &Code, before_ns: i64, now_ns: i64) {
        for (number, _) in code.interrupts.iter().filter(|(number, _)| (600..900).contains(number)) {
            let every_ns = i64::from(number % 100) * 1_000_000;
            if every_ns == 0 {
                continue;
            }
            // Those that nothing has allowed yet count for one.
            let waited = i64::from(self.waiting.contains(number));
            self.waiting.retain(|waiting| waiting != number);
            let times = (now_ns / every_ns - before_ns / every_ns).clamp(waited, MOST_TIMES) as usize;
            let place = self.waiting.partition_point(|waiting| waiting < number);
            self.waiting.splice(place..place, std::iter::repeat_n(*number, times));
        }
    }

    /// The op at which the next routine begins, if interrupts are allowed; they are not until it ends. `is_on` tells
    /// of special relays.
    pub(super) fn take(&mut self, code: &Code, is_on: impl Fn(Device) -> bool) -> Option<usize> {
        while self.are_allowed && !self.waiting.is_empty() {
            let number = self.waiting.remove(0);
            let block = Device::new(DeviceKind::M, blocking_relay(number));
            let routine = code.interrupts.iter().find(|(of, _)| *of == number);
            if let Some((_, op)) = routine.filter(|_| !is_on(block)) {
                self.are_allowed = false;
                return Some(*op as usize);
            }
        }
        None
    }
}

/// The special relay that blocks an interrupt.
fn blocking_relay(number: u32) -> u32 {
    match number {
        10..100 => 8059,
        _ => 8050 + number / 100,
    }
}
