//! The PLC's end of a line: bytes in, bytes out.

use super::Plc;
use crate::link::command::{Command, Reply};
use crate::link::frame::{ACK, Arrival, Frames, NAK, framed};

/// The PLC's end of a line.
#[derive(Debug)]
pub struct Server {
    plc: Plc,
    frames: Frames,
    clock: Clock,
}

/// What makes time pass for the program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Clock {
    /// The time of the caller.
    Real,
    /// Each request that is answered is a scan, of so many nanoseconds; the time so far.
    Requests { step_ns: i64, now_ns: i64 },
}

/// What goes back to the host.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Answer {
    /// The bytes.
    pub bytes: Vec<u8>,
    /// The speed of the line from then on, in bits a second, if it changes.
    pub baud: Option<u32>,
}

impl Server {
    /// A server of this PLC, whose scans follow the time of [`Server::advance`].
    pub fn new(plc: Plc) -> Server {
        Server { plc, frames: Frames::default(), clock: Clock::Real }
    }

    /// A server of this PLC that runs one scan for each request, before it answers: what a host sees then depends on
    /// nothing but what it asked.
    pub fn stepped(plc: Plc, step_ns: i64) -> Server {
        Server { plc, frames: Frames::default(), clock: Clock::Requests { step_ns, now_ns: 0 } }
    }

    /// The PLC.
    pub fn plc(&self) -> &Plc {
        &self.plc
    }

    /// The same, for the person in front of it.
    pub fn plc_mut(&mut self) -> &mut Plc {
        &mut self.plc
    }

    /// Runs the scans that are due; gives when the next one is, in nanoseconds of the same clock.
    pub fn advance(&mut self, now_ns: i64) -> Option<i64> {
        match self.clock {
            Clock::Real => self.plc.advance(now_ns),
            Clock::Requests { .. } => None,
        }
    }

    /// Another host has come: what the last one had begun is forgotten.
    pub fn greet(&mut self) {
        self.frames.clear();
    }

    /// Takes a byte that has arrived.
    pub fn take(&mut self, byte: u8, now_ns: i64) -> Option<Answer> {
        let arrival = self.frames.take(byte)?;
        let refusal = Answer { bytes: vec![NAK], baud: None };
        let body = match arrival {
            Arrival::Enquiry => return Some(Answer { bytes: vec![ACK], baud: None }),
            // Those are for hosts.
            Arrival::Acknowledge | Arrival::Refusal => return None,
            Arrival::Damaged => return Some(refusal),
            Arrival::Body(body) => body,
        };
        let Some(command) = Command::of_body(&body) else { return Some(refusal) };
        let now_ns = self.step(now_ns);
        let Some(reply) = self.plc.obey_host(&command, now_ns) else { return Some(refusal) };
        let baud = match command {
            Command::Speed(speed) => Some(speed.baud()),
            _ => None,
        };
        Some(Answer { bytes: bytes_of(&reply), baud })
    }

    /// Lets the time of a request pass; gives what time it is.
    fn step(&mut self, real_ns: i64) -> i64 {
        let Clock::Requests { step_ns, now_ns } = &mut self.clock else { return real_ns };
        self.plc.advance(*now_ns);
        *now_ns += *step_ns;
        *now_ns
    }
}

fn bytes_of(reply: &Reply) -> Vec<u8> {
    reply.body().map_or_else(|| vec![ACK], |body| framed(&body))
}
