//! Alarms: conditions about the values in a PLC, real or simulated, of which is told when they begin to hold and when
//! they no longer do.

use super::expression::{Expression, Names};
use super::{Layout, Value, Variable};
use crate::target::iec::is_identifier;
use crate::target::{Latches, Symbols, Target};
use crate::text::{Message, Severity};
use serde_json::{Value as Json, json};

/// What a project wants to be told of.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Alarm {
    /// The condition, as [`Expression`] reads it.
    pub when: String,
    /// What people are told when it holds.
    pub message: String,
    /// How long it must have held, in nanoseconds.
    pub hold_ns: i64,
    /// How bad that is.
    pub severity: Severity,
}

impl Alarm {
    /// Sees whether its condition can be read; on a target of the FX family also whether there are such devices. Where
    /// the project `has_symbols`, what may be one counts as such.
    ///
    /// # Errors
    /// A sentence that says what is wrong.
    pub fn check(&self, target: Option<&Target>, has_symbols: bool) -> Result<(), Message> {
        match target.filter(|target| target.is_fx()) {
            Some(target) => {
                let names =
                    NamesOfTarget { target, layout: Layout::new(target, &Latches::default()), has_symbols };
                Expression::read(&self.when, &names).map(|_| ())
            }
            None => Expression::read(&self.when, &AnyNames).map(|_| ()),
        }
    }
}

/// The devices of a target, whatever its program.
struct NamesOfTarget<'a> {
    target: &'a Target,
    layout: Layout,
    has_symbols: bool,
}

impl Names for NamesOfTarget<'_> {
    type Variable = ();

    fn variable(&self, name: &str) -> Option<()> {
        let may_be_symbol = || self.has_symbols && Symbols::problem(name, self.target).is_none();
        (self.layout.variable(name, self.target).is_some() || may_be_symbol()).then_some(())
    }

    fn meant(&self, (): (), value: &Value) -> Option<Value> {
        value.of_device()
    }
}

/// Whatever a program may have that is not known.
struct AnyNames;

impl Names for AnyNames {
    type Variable = ();

    fn variable(&self, name: &str) -> Option<()> {
        match Value::read(name) {
            Some(Value::Name(name)) => is_identifier(&name).then_some(()),
            Some(_) => None,
            None => name.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '%').then_some(()),
        }
    }

    fn meant(&self, (): (), value: &Value) -> Option<Value> {
        Some(value.clone())
    }
}

/// The alarms of a project, and which of them are raised.
#[derive(Clone, Debug)]
pub struct Alarms<V = Variable> {
    watched: Vec<Watched<V>>,
}

/// An alarm whose condition could be read.
#[derive(Clone, Debug)]
struct Watched<V> {
    alarm: Alarm,
    condition: Expression<V>,
    /// Since when the condition holds, in nanoseconds.
    since_ns: Option<i64>,
    is_raised: bool,
}

/// An alarm that is raised, or gone.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct AlarmChange {
    /// Which one.
    pub alarm: Alarm,
    /// Whether its condition holds now.
    pub is_raised: bool,
    /// When that was seen, in nanoseconds.
    pub time_ns: i64,
}

impl AlarmChange {
    /// As programs that read results want it.
    pub fn json(&self) -> Json {
        json!({
            "when": self.alarm.when,
            "message": self.alarm.message,
            "severity": self.alarm.severity.word(),
            "raised": self.is_raised,
        })
    }

    /// As people read it.
    pub fn told(&self) -> Message {
        Message::new(if self.is_raised { "simulate.alarm-raised" } else { "simulate.alarm-gone" })
            .with("time", self.time_ns / 1_000_000)
            .with("message", &self.alarm.message)
            .with("when", &self.alarm.when)
    }
}

impl<V> Default for Alarms<V> {
    fn default() -> Alarms<V> {
        Alarms { watched: Vec::new() }
    }
}

impl<V: Copy> Alarms<V> {
    /// Watches these alarms. Gives also those that cannot be, and why: what they name is not there.
    pub fn new(alarms: &[Alarm], names: &impl Names<Variable = V>) -> (Alarms<V>, Vec<(Alarm, Message)>) {
        let mut watched = Vec::new();
        let mut refused = Vec::new();
        for alarm in alarms {
            match Expression::read(&alarm.when, names) {
                Ok(condition) => {
                    let alarm = alarm.clone();
                    watched.push(Watched { alarm, condition, since_ns: None, is_raised: false });
                }
                Err(reason) => refused.push((alarm.clone(), reason)),
            }
        }
        (Alarms { watched }, refused)
    }

    /// Whether there is nothing to look at.
    pub fn is_empty(&self) -> bool {
        self.watched.is_empty()
    }

    /// What the conditions read.
    pub fn variables(&self) -> Vec<V> {
        self.watched.iter().flat_map(|watched| watched.condition.variables()).collect()
    }

    /// Goes on where others were: what is raised, and which conditions have held for how long.
    pub fn take_over(&mut self, before: &Alarms<V>) {
        for own in &mut self.watched {
            if let Some(same) = before.watched.iter().find(|other| other.alarm == own.alarm) {
                (own.since_ns, own.is_raised) = (same.since_ns, same.is_raised);
            }
        }
    }

    /// Looks at the values at a moment; gives what is raised by them, and what is gone. Time may have gone back.
    pub fn look(&mut self, time_ns: i64, of: &impl Fn(V) -> Value) -> Vec<AlarmChange> {
        let mut changes = Vec::new();
        for Watched { alarm, condition, since_ns, is_raised } in &mut self.watched {
            *since_ns = match condition.holds(of) {
                true => Some(since_ns.map_or(time_ns, |since| since.min(time_ns))),
                false => None,
            };
            let is_now = match *since_ns {
                Some(since) => *is_raised || time_ns - since >= alarm.hold_ns,
                None => false,
            };
            if is_now != *is_raised {
                *is_raised = is_now;
                changes.push(AlarmChange { alarm: alarm.clone(), is_raised: is_now, time_ns });
            }
        }
        changes
    }

    /// Nobody looks any more: gives what was raised as gone.
    pub fn end(&mut self, time_ns: i64) -> Vec<AlarmChange> {
        let raised = self.watched.iter_mut().filter(|watched| watched.is_raised);
        let gone = raised.map(|watched| {
            (watched.is_raised, watched.since_ns) = (false, None);
            AlarmChange { alarm: watched.alarm.clone(), is_raised: false, time_ns }
        });
        gone.collect()
    }
}
