//! What bytes travel over: a serial port, a TCP connection, or whatever a test makes of them.

mod serial;
pub use serial::{PortInfo, SerialTransport, ports, pty};

mod tcp;
pub use tcp::TcpTransport;

use super::LinkError;
use std::io;
use std::time::Duration;

/// A line to a PLC, in bytes. The clock of a line belongs to it, so that a line without hardware can have its own time.
pub trait Transport: Send {
    /// Sends all bytes.
    ///
    /// # Errors
    /// If the line is gone.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Takes what has arrived, and if that is nothing waits for it; 0 bytes mean that the time is over.
    ///
    /// # Errors
    /// If the line is gone.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize>;

    /// Whether the speed of the line can be changed from here. That behind a device server is the server's.
    fn has_speed(&self) -> bool {
        true
    }

    /// Changes the speed, in bits a second; a line that has none does nothing.
    ///
    /// # Errors
    /// If the port cannot do that.
    fn set_baud(&mut self, baud: u32) -> io::Result<()>;

    /// The time since some moment.
    fn now(&self) -> Duration;
}

/// The speed of a programming port that nobody has changed, in bits a second.
pub const BAUD: u32 = 9600;

/// Opens `tcp://HOST:PORT`, or else a serial port by its name.
///
/// # Errors
/// That say why there is no such line.
pub fn open(port: &str) -> Result<Box<dyn Transport>, LinkError> {
    match port.strip_prefix("tcp://") {
        Some(address) => Ok(Box::new(TcpTransport::connect(address)?)),
        None => Ok(Box::new(SerialTransport::open(port)?)),
    }
}

impl Transport for Box<dyn Transport> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        (**self).send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        (**self).receive(buffer, wait)
    }

    fn has_speed(&self) -> bool {
        (**self).has_speed()
    }

    fn set_baud(&mut self, baud: u32) -> io::Result<()> {
        (**self).set_baud(baud)
    }

    fn now(&self) -> Duration {
        (**self).now()
    }
}

/// Whether an error only says that nothing has arrived.
fn is_nothing(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted)
}
