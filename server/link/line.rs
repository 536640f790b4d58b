//! The host's end of a line: one request, one answer, whatever happens to the bytes between.
//!
//! The protocol has no numbers in its answers, so one that comes late could pass for the answer to the next request.
//! After anything that was not as it should be, the line is therefore made sure before the next request: by reads of
//! lengths that nobody else uses, one after the other, until the answer to the last one has come. What was sent before
//! has then come too, for a line does not change the order of bytes.

use super::command::{Command, Expected, Reply};
use super::frame::{Arrival, BITS_PER_BYTE, ENQ, Frames, framed};
use super::transport::{BAUD, Transport};
use super::{
    LinkError,
    address::{Address, Plain},
};
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How patient a host is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Patience {
    /// Time for an answer to begin, beyond what the bytes take on the line. A PLC answers once a scan; the maker's
    /// tools wait 5 s.
    pub answer: Duration,
    /// How often a request is sent before it has failed.
    pub tries: u32,
}

impl Default for Patience {
    fn default() -> Patience {
        Patience { answer: Duration::from_secs(1), tries: 3 }
    }
}

/// The host's end of a line to a PLC.
pub struct Line<T> {
    transport: T,
    patience: Patience,
    baud: u32,
    /// What has arrived and is not looked at yet.
    pending: VecDeque<u8>,
    /// Whether no answer can be on its way.
    is_sure: bool,
    /// The number of the next read that makes sure.
    barrier: usize,
    troubles: u32,
    exchanges: u64,
    cancel: Arc<AtomicBool>,
}

/// What came instead of a reply.
enum Nothing {
    Refusal,
    /// Something that is no answer to this request.
    Other,
    Silence,
}

/// Where reads that make sure begin: D8001, which all have.
const BARRIER: Address<Plain> = Address::new(0x0E02);
/// So many lengths, all odd: 3, 5, … 63. Other reads of more than two bytes are of even lengths.
const BARRIERS: usize = 31;
/// How long answers to earlier requests may come before the one to such a read, in times of the patience for one.
const EARLIER_ANSWERS: u32 = 4;

impl<T: Transport> Line<T> {
    /// A line that nobody has spoken on; `cancel` ends what goes on at the next request.
    pub fn new(transport: T, patience: Patience, cancel: Arc<AtomicBool>) -> Line<T> {
        let pending = VecDeque::new();
        Line {
            transport,
            patience,
            baud: BAUD,
            pending,
            is_sure: false,
            barrier: 0,
            troubles: 0,
            exchanges: 0,
            cancel,
        }
    }

    /// Asks whether somebody is there. A PLC that is inside of a frame, whose sender has gone, takes that for a part of
    /// it: so a whole frame is sent before the second try, whatever is answered to it.
    ///
    /// # Errors
    /// If nobody answers, or somebody who serves another host.
    pub fn greet(&mut self) -> Result<(), LinkError> {
        let mut is_refused = false;
        for attempt in 0..self.patience.tries.max(1) {
            self.check_cancelled()?;
            self.purge()?;
            if attempt == 1 {
                let whole = BARRIER.read(2);
                self.send(&framed(&whole.body()))?;
                let _ = self.answer(whole.expected())?;
            }
            self.send(&[ENQ])?;
            match self.answer(Expected::Acknowledge)? {
                Ok(_) => return Ok(()),
                Err(nothing) => is_refused |= matches!(nothing, Nothing::Refusal),
            }
            self.is_sure = false;
        }
        Err(if is_refused { LinkError::Occupied } else { LinkError::NoAnswer })
    }

    /// Sends a request until there is an answer to it.
    ///
    /// # Errors
    /// If there is none after some tries, or the PLC refuses it each time.
    pub fn ask(&mut self, command: &Command) -> Result<Reply, LinkError> {
        let frame = framed(&command.body());
        let mut refusals = 0;
        let mut is_silent = true;
        for _ in 0..self.patience.tries.max(1) {
            self.check_cancelled()?;
            if self.purge()? {
                self.is_sure = false;
            }
            if !self.is_sure {
                self.make_sure()?;
            }
            self.send(&frame)?;
            match self.answer(command.expected())? {
                Ok(reply) => {
                    self.exchanges += 1;
                    return Ok(reply);
                }
                Err(Nothing::Refusal) => refusals += 1,
                Err(nothing) => {
                    is_silent &= matches!(nothing, Nothing::Silence);
                    self.is_sure = false;
                }
            }
            self.troubles += 1;
        }
        Err(match refusals {
            0 if is_silent => LinkError::NoAnswer,
            0 => LinkError::Noise,
            _ => LinkError::Refused { request: String::from_utf8_lossy(&command.body()).into_owned() },
        })
    }

    /// The same for a request that is answered with bytes.
    ///
    /// # Errors
    /// See [`Line::ask`].
    pub fn read(&mut self, command: &Command) -> Result<Vec<u8>, LinkError> {
        match self.ask(command)? {
            Reply::Data(data) => Ok(data),
            _ => Err(LinkError::Noise),
        }
    }

    /// Sees whether the speed can be changed at this end.
    ///
    /// # Errors
    /// If somebody else has the serial port.
    pub fn check_speed(&self) -> Result<(), LinkError> {
        if self.transport.has_speed() { Ok(()) } else { Err(LinkError::SpeedElsewhere) }
    }

    /// Changes the speed at this end; the PLC has changed its own.
    ///
    /// # Errors
    /// If the port cannot do that.
    pub fn set_baud(&mut self, baud: u32) -> Result<(), LinkError> {
        self.transport.set_baud(baud).map_err(|error| LinkError::of_io(&error))?;
        self.baud = baud;
        self.is_sure = false;
        Ok(())
    }

    /// From now on this ends what goes on; gives what did before.
    pub fn set_cancel(&mut self, cancel: Arc<AtomicBool>) -> Arc<AtomicBool> {
        std::mem::replace(&mut self.cancel, cancel)
    }

    /// Its speed in bits a second.
    pub fn baud(&self) -> u32 {
        self.baud
    }

    /// How often something was not as it should be.
    pub fn troubles(&self) -> u32 {
        self.troubles
    }

    /// How many requests were answered.
    pub fn exchanges(&self) -> u64 {
        self.exchanges
    }

    /// The time on this line.
    pub fn now(&self) -> Duration {
        self.transport.now()
    }

    /// Whether what goes on is to end.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    fn check_cancelled(&self) -> Result<(), LinkError> {
        if self.is_cancelled() { Err(LinkError::Cancelled) } else { Ok(()) }
    }

    /// Reads with lengths of their own until the answer to the last one has come.
    fn make_sure(&mut self) -> Result<(), LinkError> {
        let mut has_heard = false;
        for _ in 0..self.patience.tries.max(1) {
            self.check_cancelled()?;
            has_heard |= self.purge()?;
            self.barrier = (self.barrier + 1) % BARRIERS;
            let command = BARRIER.read(3 + 2 * self.barrier);
            self.send(&framed(&command.body()))?;
            let end = self.transport.now() + EARLIER_ANSWERS * self.patience.answer;
            loop {
                match self.answer(command.expected())? {
                    Ok(_) => {
                        self.is_sure = true;
                        return Ok(());
                    }
                    Err(Nothing::Silence) => break,
                    // Something that was asked for earlier, or somebody who never stops talking.
                    Err(_) => has_heard = true,
                }
                if self.transport.now() >= end {
                    break;
                }
            }
            self.troubles += 1;
        }
        Err(if has_heard { LinkError::Noise } else { LinkError::NoAnswer })
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.transport.send(bytes).map_err(|error| LinkError::of_io(&error))
    }

    /// Takes what has arrived unasked; whether that was anything.
    fn purge(&mut self) -> Result<bool, LinkError> {
        let mut has_arrived = false;
        // A line that never stops sending is not emptied.
        for _ in 0..16 {
            self.receive(Duration::ZERO)?;
            if self.pending.is_empty() {
                break;
            }
            has_arrived = true;
            self.pending.clear();
        }
        Ok(has_arrived)
    }

    /// Waits for bytes, if none is pending.
    fn receive(&mut self, wait: Duration) -> Result<(), LinkError> {
        if self.pending.is_empty() {
            let mut buffer = [0; 256];
            let count = self.transport.receive(&mut buffer, wait);
            let count = count.map_err(|error| LinkError::of_io(&error))?;
            self.pending.extend(buffer.iter().take(count));
        }
        Ok(())
    }

    /// Waits for the answer to what was sent last.
    fn answer(&mut self, expected: Expected) -> Result<Result<Reply, Nothing>, LinkError> {
        let longest = super::frame::LONGEST_BODY + 4 + expected.bytes();
        let on_the_line = Duration::from_secs(1) * (longest as u32 * BITS_PER_BYTE as u32) / self.baud;
        let end = self.transport.now() + self.patience.answer + on_the_line;
        let mut frames = Frames::default();
        loop {
            let left = end.saturating_sub(self.transport.now());
            if left.is_zero() {
                return Ok(Err(if frames.is_outside() { Nothing::Silence } else { Nothing::Other }));
            }
            self.receive(left)?;
            let Some(arrival) = self.pending.pop_front().and_then(|byte| frames.take(byte)) else { continue };
            return Ok(match (arrival, expected) {
                (Arrival::Acknowledge, Expected::Acknowledge) => Ok(Reply::Done),
                (Arrival::Body(body), _) => expected.reply(&body).ok_or(Nothing::Other),
                (Arrival::Refusal, _) => Err(Nothing::Refusal),
                _ => Err(Nothing::Other),
            });
        }
    }
}
