//! A line to a virtual PLC without a computer between: its time is that of its bytes.

use rungwise::link::frame::{BITS_PER_BYTE, STX};
use rungwise::link::plc::{Faults, Plc, Server, Wire};
use rungwise::link::{Host, Line, LinkError, Mode, Patience, Transport};
use rungwise::machine_code::encode;
use rungwise::target::{Model, Target};
use std::io;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

/// Both ends of a line, shared by the host and the test.
#[derive(Clone)]
pub struct Loopback(Arc<Mutex<Ends>>);

pub struct Ends {
    pub server: Server,
    to_plc: Wire,
    to_host: Wire,
    pub now_ns: i64,
    byte_ns: i64,
    busy_ns: [i64; 2],
    /// When the PLC has something to do next, whatever arrives.
    due_ns: i64,
    /// Called whenever the PLC has come to RUN.
    pub at_start: Option<AtStart>,
    pub sent: Vec<u8>,
    pub received: Vec<u8>,
}

/// Looks at a PLC.
pub type AtStart = Box<dyn FnMut(&Plc) + Send>;

/// From one scan to the next.
pub const SCAN_NS: i64 = 10_000_000;

impl Loopback {
    pub fn new(model: Model) -> Loopback {
        Loopback::with(Server::new(Plc::new(Target::of(model), SCAN_NS)), Faults::default())
    }

    pub fn with(server: Server, faults: Faults) -> Loopback {
        let byte_ns = (BITS_PER_BYTE * 1_000_000_000 / 9600) as i64;
        Loopback(Arc::new(Mutex::new(Ends {
            server,
            to_plc: Wire::new(faults, 0),
            to_host: Wire::new(faults, 1),
            now_ns: 0,
            byte_ns,
            busy_ns: [0; 2],
            due_ns: 0,
            at_start: None,
            sent: Vec::new(),
            received: Vec::new(),
        })))
    }

    pub fn ends(&self) -> MutexGuard<'_, Ends> {
        self.0.lock().unwrap()
    }

    /// A host at the other end.
    pub fn host(&self) -> Result<Host<Loopback>, LinkError> {
        Host::connect(Line::new(self.clone(), Patience::default(), Arc::default()))
    }

    /// From the next byte on one direction is dead: that to the PLC, or that of its answers.
    pub fn cut(&self, is_answer: bool) {
        self.spoil(is_answer, Faults { disconnect: 1.0, ..Faults::default() });
    }

    /// From the next byte on one direction has these faults: that to the PLC, or that of its answers.
    pub fn spoil(&self, is_answer: bool, faults: Faults) {
        let mut ends = self.ends();
        if is_answer { ends.to_host.set_faults(faults) } else { ends.to_plc.set_faults(faults) }
    }

    /// The line is put together again, and goes on with these faults. The PLC does not learn of that, as on a serial
    /// line: it may be inside of a frame.
    pub fn reconnect(&self, faults: Faults) {
        let mut ends = self.ends();
        ends.due_ns = 0;
        for wire in 0..2 {
            let wire = if wire == 0 { &mut ends.to_plc } else { &mut ends.to_host };
            wire.reconnect();
            wire.set_faults(faults);
        }
    }
}

impl Ends {
    fn arrival(&mut self, direction: usize) -> i64 {
        self.busy_ns[direction] = self.now_ns.max(self.busy_ns[direction]) + self.byte_ns;
        self.busy_ns[direction]
    }

    /// Lets everything happen that does so up to now.
    fn settle(&mut self) {
        let is_quiet = self.to_plc.next_ns().is_none_or(|next| next > self.now_ns);
        if is_quiet && self.due_ns > self.now_ns {
            return;
        }
        while let Some(byte) = self.to_plc.receive(self.now_ns) {
            self.server.advance(self.now_ns);
            let before = self.server.plc().mode();
            let answer = self.server.take(byte, self.now_ns);
            let is_started = before == Mode::Stop && self.server.plc().mode() == Mode::Run;
            if let Some(look) = self.at_start.as_mut().filter(|_| is_started) {
                look(self.server.plc());
            }
            let Some(answer) = answer else { continue };
            let bytes = if self.to_host.is_refused() { vec![0x15] } else { answer.bytes };
            for byte in bytes {
                let due = self.arrival(1);
                self.to_host.send(byte, due);
            }
            if let Some(baud) = answer.baud {
                self.byte_ns = (BITS_PER_BYTE * 1_000_000_000 / u64::from(baud)) as i64;
            }
        }
        self.due_ns = self.server.advance(self.now_ns).unwrap_or(i64::MAX);
    }

    fn is_dead(&self) -> bool {
        self.to_plc.is_dead() || self.to_host.is_dead()
    }
}

impl Transport for Loopback {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut ends = self.ends();
        for byte in bytes {
            ends.sent.push(*byte);
            let due = ends.arrival(0);
            ends.to_plc.send(*byte, due);
        }
        if ends.is_dead() { Err(io::ErrorKind::BrokenPipe.into()) } else { Ok(()) }
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let mut ends = self.ends();
        let end = ends.now_ns + wait.as_nanos() as i64;
        let mut count = 0;
        loop {
            ends.settle();
            let now = ends.now_ns;
            while let Some(place) = buffer.get_mut(count)
                && let Some(byte) = ends.to_host.receive(now)
            {
                *place = byte;
                ends.received.push(byte);
                count += 1;
            }
            // Bytes that follow each other at once are one piece, as a serial port delivers them.
            let is_next = |next: i64| next <= end && next <= now + ends.byte_ns;
            match ends.to_host.next_ns().filter(|next| count < buffer.len() && is_next(*next)) {
                Some(next) if count > 0 => {
                    ends.now_ns = next.max(now);
                    continue;
                }
                _ if count > 0 => return Ok(count),
                _ => {}
            }
            if ends.is_dead() {
                return Err(io::ErrorKind::BrokenPipe.into());
            }
            let next = [ends.to_plc.next_ns(), ends.to_host.next_ns()].into_iter().flatten().min();
            match next {
                Some(next) if next <= end => ends.now_ns = next.max(now),
                _ => {
                    ends.now_ns = end;
                    ends.settle();
                    return Ok(0);
                }
            }
        }
    }

    fn set_baud(&mut self, _baud: u32) -> io::Result<()> {
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.ends().now_ns as u64)
    }
}

/// A line on which somebody hears the requests, each before it is sent.
pub struct Overheard<T, F> {
    pub line: T,
    pub hear: F,
}

impl<T: Transport, F: FnMut(&[u8]) + Send> Transport for Overheard<T, F> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        if bytes.first() == Some(&STX) {
            (self.hear)(bytes);
        }
        self.line.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.line.receive(buffer, wait)
    }

    fn set_baud(&mut self, baud: u32) -> io::Result<()> {
        self.line.set_baud(baud)
    }

    fn now(&self) -> Duration {
        self.line.now()
    }
}

/// The words of an instruction list.
pub fn words(list: &str, model: Model) -> Vec<u16> {
    encode(list, Target::of(model)).unwrap_or_else(|found| panic!("{list}: {found:?}")).words
}
