//! The virtual PLC at work: real time, and hosts that come and go over TCP or a pseudo terminal.

use super::{Faults, Server, Wire};
use crate::link::Transport;
use crate::link::frame::{BITS_PER_BYTE, NAK};
use crate::link::transport::TcpTransport;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A virtual PLC that serves one host after the other.
pub struct Service<'a> {
    server: Server,
    to_plc: Wire,
    to_host: Wire,
    /// What a byte takes on the line, in nanoseconds; 0 on a line that is as fast as it can be.
    byte_ns: i64,
    /// When the last byte in each direction has arrived.
    busy_ns: [i64; 2],
    /// Looked after between any two requests, with the time in nanoseconds: says whether to go on.
    attend: &'a mut dyn FnMut(&mut Server, i64) -> bool,
    since: Instant,
    refused: Arc<AtomicUsize>,
}

/// Where hosts connect.
#[derive(Debug)]
pub struct Listener(TcpListener);

impl Listener {
    /// Listens on an address, `127.0.0.1:5551`; port 0 is any that is free.
    ///
    /// # Errors
    /// If there is no such address, or somebody else listens there.
    pub fn bind(address: &str) -> io::Result<Listener> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Listener(listener))
    }

    /// The address.
    ///
    /// # Errors
    /// If the system does not say.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.0.local_addr()
    }

    fn accepted(&self) -> io::Result<Option<TcpStream>> {
        match self.0.accept() {
            Ok((stream, _)) => Ok(Some(stream)),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(None),
            // The host has gone before it was served.
            Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => Ok(None),
            Err(error) => Err(error),
        }
    }
}

/// Why a connection is over.
enum End {
    /// The host has gone; perhaps the next one is there.
    Gone(Option<TcpStream>),
    Quit,
}

/// Who looks after the PLC is asked at least so often.
const ATTENTION: Duration = Duration::from_millis(20);
/// How long after the beginning of a connection the end of the one before may arrive.
const OVERTAKEN: Duration = Duration::from_millis(5);
/// Hosts at a time that are told to go away; more are left without a word.
const MOST_REFUSED: usize = 8;
/// How long such a host is told so.
const REFUSAL: Duration = Duration::from_secs(3);

impl<'a> Service<'a> {
    /// A service with these faults, on a line of `baud` bits a second if it has a speed.
    pub fn new(
        server: Server,
        faults: Faults,
        baud: Option<u32>,
        attend: &'a mut dyn FnMut(&mut Server, i64) -> bool,
    ) -> Service<'a> {
        Service {
            server,
            to_plc: Wire::new(faults, 0),
            to_host: Wire::new(faults, 1),
            byte_ns: baud.map_or(0, byte_ns),
            busy_ns: [0; 2],
            attend,
            since: Instant::now(),
            refused: Arc::default(),
        }
    }

    /// Serves hosts that connect, one at a time, until it is told to stop.
    ///
    /// # Errors
    /// If the system takes the listener away.
    pub fn on_tcp(mut self, listener: &Listener) -> io::Result<()> {
        let mut next = None;
        loop {
            let stream = if next.is_some() { next.take() } else { listener.accepted()? };
            // One that cannot be served has gone meanwhile.
            let transport = stream.and_then(|stream| {
                stream.set_nonblocking(false).ok()?;
                // Scans do not wait for a host that does not read its answers.
                TcpTransport::over(stream).and_then(|line| line.with_patience(ATTENTION)).ok()
            });
            if let Some(mut transport) = transport {
                match self.host(&mut transport, &mut || listener.accepted().ok().flatten()) {
                    End::Gone(another) => next = another,
                    End::Quit => return Ok(()),
                }
                continue;
            }
            match self.between() {
                Some(wait) => std::thread::sleep(wait.min(Duration::from_millis(5))),
                None => return Ok(()),
            }
        }
    }

    /// Serves whoever opens the other end, until it is told to stop.
    pub fn on_line(mut self, transport: &mut dyn Transport) {
        while let End::Gone(_) = self.host(transport, &mut || None) {
            // A pseudo terminal whose other end nobody has says so at once.
            match self.between() {
                Some(wait) => std::thread::sleep(wait.min(ATTENTION)),
                None => return,
            }
        }
    }

    /// Runs what is due and looks after the PLC; gives how long there is nothing to do, or nothing to stop.
    fn between(&mut self) -> Option<Duration> {
        let now_ns = self.now_ns();
        let due_ns = self.server.advance(now_ns);
        if !(self.attend)(&mut self.server, now_ns) {
            return None;
        }
        let next = [due_ns, self.to_plc.next_ns(), self.to_host.next_ns()].into_iter().flatten().min();
        let wait_ns = next.map_or(i64::MAX, |next| next - self.now_ns()).max(0);
        Some(Duration::from_nanos(wait_ns as u64).min(ATTENTION))
    }

    /// Serves a host until it goes; `others` gives who comes meanwhile, and is refused.
    fn host(&mut self, transport: &mut dyn Transport, others: &mut dyn FnMut() -> Option<TcpStream>) -> End {
        self.server.greet();
        self.to_plc.reconnect();
        self.to_host.reconnect();
        let mut buffer = [0; 512];
        loop {
            let Some(wait) = self.between() else { return End::Quit };
            let other = others();
            // The other one may be who has just ended this connection: then it is served. On a machine at work its
            // end may arrive a little after the beginning of the next one.
            let wait = if other.is_some() { OVERTAKEN } else { wait };
            let Ok(count) = transport.receive(&mut buffer, wait) else { return End::Gone(other) };
            if let Some(other) = other {
                self.refuse_other(other);
            }
            for byte in buffer.iter().take(count) {
                let due_ns = self.arrival(0);
                self.to_plc.send(*byte, due_ns);
            }
            self.answer();
            let now_ns = self.now_ns();
            let ready: Vec<u8> = std::iter::from_fn(|| self.to_host.receive(now_ns)).collect();
            let is_sent = ready.is_empty() || transport.send(&ready).is_ok();
            if !is_sent || self.to_plc.is_dead() || self.to_host.is_dead() {
                return End::Gone(None);
            }
        }
    }

    /// Gives the PLC what has arrived, and puts its answers on the way.
    fn answer(&mut self) {
        while let Some(byte) = self.to_plc.receive(self.now_ns()) {
            let Some(answer) = self.server.take(byte, self.now_ns()) else { continue };
            let bytes = if self.to_host.is_refused() { vec![NAK] } else { answer.bytes };
            for byte in bytes {
                let due_ns = self.arrival(1);
                self.to_host.send(byte, due_ns);
            }
            if let Some(baud) = answer.baud.filter(|_| self.byte_ns > 0) {
                self.byte_ns = byte_ns(baud);
            }
        }
    }

    /// When a byte that is sent now will have arrived: after those before it.
    fn arrival(&mut self, direction: usize) -> i64 {
        let start_ns = self.now_ns().max(self.busy_ns[direction]);
        self.busy_ns[direction] = start_ns + self.byte_ns;
        self.busy_ns[direction]
    }

    fn refuse_other(&self, stream: TcpStream) {
        if self.refused.load(Ordering::Relaxed) >= MOST_REFUSED {
            return;
        }
        let refused = Arc::clone(&self.refused);
        refused.fetch_add(1, Ordering::Relaxed);
        std::thread::spawn(move || {
            // Whatever becomes of it, it is over.
            let _ = refuse(stream);
            refused.fetch_sub(1, Ordering::Relaxed);
        });
    }

    fn now_ns(&self) -> i64 {
        self.since.elapsed().as_nanos() as i64
    }
}

/// Says no to whatever a second host asks, for a while.
fn refuse(mut stream: TcpStream) -> io::Result<()> {
    let end = Instant::now() + REFUSAL;
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(REFUSAL))?;
    let mut buffer = [0; 256];
    while Instant::now() < end && stream.read(&mut buffer)? > 0 {
        stream.write_all(&[NAK])?;
    }
    Ok(())
}

fn byte_ns(baud: u32) -> i64 {
    (BITS_PER_BYTE * 1_000_000_000 / u64::from(baud.max(1))) as i64
}
