//! TCP: serial device servers, and the virtual PLC.

use super::Transport;
use crate::link::LinkError;
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

/// How long somebody may take to accept a connection.
const PATIENCE: Duration = Duration::from_secs(5);

/// A TCP connection.
#[derive(Debug)]
pub struct TcpTransport {
    stream: TcpStream,
    since: Instant,
}

impl TcpTransport {
    /// Connects to `HOST:PORT`.
    ///
    /// # Errors
    /// If the address is none, or nobody accepts there.
    pub fn connect(address: &str) -> Result<TcpTransport, LinkError> {
        let fail =
            |error: io::Error| LinkError::Unreachable { port: address.into(), reason: error.to_string() };
        let mut last = io::Error::from(io::ErrorKind::AddrNotAvailable);
        for address in address.to_socket_addrs().map_err(fail)? {
            match TcpStream::connect_timeout(&address, PATIENCE) {
                Ok(stream) => return TcpTransport::over(stream).map_err(fail),
                Err(error) => last = error,
            }
        }
        Err(fail(last))
    }

    /// The line over a connection that there is.
    ///
    /// # Errors
    /// If it is gone.
    pub fn over(stream: TcpStream) -> io::Result<TcpTransport> {
        // Frames are short and each waits for an answer.
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(PATIENCE))?;
        Ok(TcpTransport { stream, since: Instant::now() })
    }
}

impl TcpTransport {
    /// With another time that the other end may take to make room for what is sent to it; then it counts as gone.
    ///
    /// # Errors
    /// If the system does not know such a time.
    pub fn with_patience(self, patience: Duration) -> io::Result<TcpTransport> {
        self.stream.set_write_timeout(Some(patience))?;
        Ok(self)
    }
}

impl Transport for TcpTransport {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        // A time-out of 0 would mean to wait for ever, and systems round a short one up to some milliseconds.
        let read = if wait.is_zero() {
            self.stream.set_nonblocking(true)?;
            let read = self.stream.read(buffer);
            self.stream.set_nonblocking(false)?;
            read
        } else {
            self.stream.set_read_timeout(Some(wait.max(Duration::from_micros(1))))?;
            self.stream.read(buffer)
        };
        match read {
            Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => Ok(count),
            Err(error) if super::is_nothing(&error) => Ok(0),
            Err(error) => Err(error),
        }
    }

    fn has_speed(&self) -> bool {
        false
    }

    fn set_baud(&mut self, _baud: u32) -> io::Result<()> {
        Ok(())
    }

    fn now(&self) -> Duration {
        self.since.elapsed()
    }
}
