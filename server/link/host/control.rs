//! Orders to the CPU: run, stop, forget.

use super::{Dialect, Host, Point};
use crate::link::command::Speed;
use crate::link::{Command, LinkError, Mode, Part, Transport};
use crate::target::{Device, DeviceKind};
use std::time::Duration;

/// On while the CPU runs, and while it does not.
const RUNNING: u32 = 8000;
const STANDING: u32 = 8001;
/// Orders to run whatever the switch says, and to stop.
const FORCED_MODE: u32 = 8035;
const FORCED_RUN: u32 = 8036;
const FORCED_STOP: u32 = 8037;
/// A CPU ends its scan before it obeys: at most so long.
const LONGEST_SCAN: Duration = Duration::from_secs(2);
/// The steps in which a host clears the program, and the devices; as they were recorded.
const CLEAR_PROGRAM: [u8; 4] = [1, 0, 3, 2];
const CLEAR_DEVICES: [u8; 2] = [4, 3];

impl<T: Transport> Host<T> {
    /// What the CPU does.
    ///
    /// # Errors
    /// If the line fails.
    pub fn mode(&mut self) -> Result<Mode, LinkError> {
        let relay = |number| Point::Bit(Device::new(DeviceKind::M, number), Part::Contact);
        match self.read(&[relay(RUNNING), relay(STANDING)])?[..] {
            [0, 1] => Ok(Mode::Stop),
            _ => Ok(Mode::Run),
        }
    }

    /// Lets the CPU stop, and waits until it has.
    ///
    /// # Errors
    /// If it does not, or the line fails.
    pub fn stop(&mut self) -> Result<(), LinkError> {
        if self.mode()? == Mode::Stop { Ok(()) } else { self.halt() }
    }

    /// Orders a CPU that runs to stop, and waits until it has.
    pub(super) fn halt(&mut self) -> Result<(), LinkError> {
        self.order(FORCED_STOP, true)?;
        if self.comes_to(Mode::Stop)? { Ok(()) } else { Err(LinkError::StillRunning) }
    }

    /// Lets the CPU run, whatever its switch says; gives whether it does. It does not where it finds an error in its
    /// program.
    ///
    /// # Errors
    /// If the line fails.
    pub fn start(&mut self) -> Result<bool, LinkError> {
        if self.mode()? == Mode::Run {
            return Ok(true);
        }
        self.order(FORCED_STOP, false)?;
        if self.comes_to(Mode::Run)? {
            return Ok(true);
        }
        self.order(FORCED_MODE, true)?;
        self.order(FORCED_RUN, true)?;
        if self.comes_to(Mode::Run)? {
            return Ok(true);
        }
        // These orders stand: the next program would start by itself.
        self.order(FORCED_RUN, false)?;
        self.order(FORCED_MODE, false)?;
        self.order(FORCED_STOP, true)?;
        Ok(false)
    }

    /// Clears the program, or all devices, of a CPU that stands still.
    ///
    /// # Errors
    /// If it runs, if it is an FX1S, of which nobody knows how it is done, or if the line fails.
    pub fn clear(&mut self, is_program: bool) -> Result<(), LinkError> {
        if self.mode()? == Mode::Run {
            return Err(LinkError::Running);
        }
        if self.dialect() == Dialect::Plain {
            return Err(LinkError::NotOnThisModel);
        }
        if self.raw_parameters()?.has_keyword() {
            return Err(LinkError::Keyword);
        }
        let steps: &[u8] = if is_program { &CLEAR_PROGRAM } else { &CLEAR_DEVICES };
        for step in steps {
            self.line.ask(&Command::Clear(*step))?;
        }
        Ok(())
    }

    /// Switches the line to another speed, in bits a second: 19200, 38400, 57600 or 115200. If the PLC does not answer
    /// there, the line is left as it was.
    ///
    /// # Errors
    /// If there is no such speed, the PLC does not know it, or the line fails.
    pub fn set_speed(&mut self, baud: u32) -> Result<(), LinkError> {
        let speed = Speed::of_baud(baud).ok_or(LinkError::NoSpeed { baud })?;
        self.line.check_speed()?;
        let before = self.line.baud();
        self.line.ask(&Command::Speed(speed))?;
        self.line.set_baud(baud)?;
        if let Err(error) = self.mode() {
            self.line.set_baud(before)?;
            return Err(error);
        }
        Ok(())
    }

    pub(super) fn comes_to(&mut self, mode: Mode) -> Result<bool, LinkError> {
        let end = self.line.now() + LONGEST_SCAN;
        loop {
            if self.mode()? == mode {
                return Ok(true);
            }
            if self.line.now() > end {
                return Ok(false);
            }
        }
    }
}
