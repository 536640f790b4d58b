//! Serial ports, and pseudo terminals in their place.

use super::{BAUD, Transport};
use crate::link::LinkError;
use serialport::{DataBits, ErrorKind, Parity, SerialPort, SerialPortBuilder, SerialPortType, StopBits};
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// A serial port of this computer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct PortInfo {
    /// Its name: `/dev/ttyUSB0`, `COM3`.
    pub name: String,
    /// What it says of itself; empty if it says nothing.
    pub description: String,
}

/// The serial ports of this computer, by name.
pub fn ports() -> Vec<PortInfo> {
    let mut ports: Vec<PortInfo> = serialport::available_ports()
        .unwrap_or_default()
        .into_iter()
        .map(|port| PortInfo { name: port.port_name, description: described(port.port_type) })
        .collect();
    ports.sort_by(|a, b| a.name.cmp(&b.name));
    ports
}

fn described(kind: SerialPortType) -> String {
    match kind {
        SerialPortType::UsbPort(usb) => {
            let known = [usb.manufacturer, usb.product, usb.serial_number];
            let words: Vec<String> = known.into_iter().flatten().collect();
            if words.is_empty() { format!("USB {:04x}:{:04x}", usb.vid, usb.pid) } else { words.join(" ") }
        }
        SerialPortType::BluetoothPort => "Bluetooth".into(),
        SerialPortType::PciPort => "PCI".into(),
        SerialPortType::Unknown => String::new(),
    }
}

/// A serial port with seven bits of data, even parity and one stop bit.
pub struct SerialTransport {
    port: Box<dyn SerialPort>,
    since: Instant,
}

impl SerialTransport {
    /// Opens a port for nobody else.
    ///
    /// # Errors
    /// If there is none of this name, if it may not be opened, or if somebody has it.
    pub fn open(name: &str) -> Result<SerialTransport, LinkError> {
        match SerialTransport::settings(name).open() {
            Ok(port) => Ok(SerialTransport { port, since: Instant::now() }),
            Err(error) => Err(refusal(name, &error)),
        }
    }

    /// What is asked of the system for a programming port: 9600 bit/s, seven bits, even parity, one stop bit. A pseudo
    /// terminal does as if.
    pub fn settings(name: &str) -> SerialPortBuilder {
        serialport::new(name, BAUD)
            .data_bits(DataBits::Seven)
            .parity(Parity::Even)
            .stop_bits(StopBits::One)
            .timeout(Duration::from_secs(1))
    }
}

fn refusal(name: &str, error: &serialport::Error) -> LinkError {
    let port = name.to_string();
    match error.kind() {
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => LinkError::Forbidden { port },
        ErrorKind::Io(io::ErrorKind::NotFound) => LinkError::NoPort { port },
        ErrorKind::Io(io::ErrorKind::WouldBlock | io::ErrorKind::ResourceBusy) => LinkError::InUse { port },
        // Systems say so of a port that is open elsewhere, too.
        ErrorKind::NoDevice if is_there(name) => LinkError::InUse { port },
        ErrorKind::NoDevice => LinkError::NoPort { port },
        _ => LinkError::Unreachable { port, reason: error.to_string() },
    }
}

/// Whether there is such a port, be it open elsewhere; pseudo terminals are on no list.
fn is_there(name: &str) -> bool {
    Path::new(name).exists() || ports().iter().any(|port| port.name == name)
}

impl Transport for SerialTransport {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.port.set_timeout(wait)?;
        match self.port.read(buffer) {
            Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => Ok(count),
            Err(error) if super::is_nothing(&error) => Ok(0),
            Err(error) => Err(error),
        }
    }

    fn set_baud(&mut self, baud: u32) -> io::Result<()> {
        self.port.set_baud_rate(baud).map_err(io::Error::from)
    }

    fn now(&self) -> Duration {
        self.since.elapsed()
    }
}

/// A pseudo terminal: the end of the virtual PLC, and the name under which others open it. The third part keeps the
/// other end open while nobody has it.
///
/// # Errors
/// If the system has none.
#[cfg(unix)]
pub fn pty() -> io::Result<(SerialTransport, String, Box<dyn Send>)> {
    let (own, other) = serialport::TTYPort::pair()?;
    let name = other.name().unwrap_or_default();
    Ok((SerialTransport { port: Box::new(own), since: Instant::now() }, name, Box::new(other)))
}

/// Pseudo terminals belong to Unix.
///
/// # Errors
/// Always.
#[cfg(not(unix))]
pub fn pty() -> io::Result<(SerialTransport, String, Box<dyn Send>)> {
    Err(io::ErrorKind::Unsupported.into())
}
