//! Why something with a PLC did not work, and what helps.

use crate::text::Message;
use std::io;

/// Why something with a PLC did not work.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum LinkError {
    /// There is no such port.
    NoPort {
        /// Its name.
        port: String,
    },
    /// The user may not open it.
    Forbidden {
        /// Its name.
        port: String,
    },
    /// Somebody else has it.
    InUse {
        /// Its name.
        port: String,
    },
    /// It cannot be opened or reached.
    Unreachable {
        /// Its name.
        port: String,
        /// What the system says.
        reason: String,
    },
    /// Nothing arrives.
    NoAnswer,
    /// Something arrives, but no answers that can be read.
    Noise,
    /// The line was there and is gone.
    Gone {
        /// What the system says.
        reason: String,
    },
    /// The PLC says no to a request, again and again.
    Refused {
        /// The request, as it is on the line.
        request: String,
    },
    /// Another host has the virtual PLC.
    Occupied,
    /// The user has ended it.
    Cancelled,
    /// What answers is no PLC that is known.
    UnknownType {
        /// What D8001 has.
        code: u16,
    },
    /// The PLC is another one than the program is for.
    WrongModel {
        /// That of the program.
        wanted: &'static str,
        /// That of the PLC.
        found: &'static str,
    },
    /// The program does not fit.
    TooLarge {
        /// Steps of the program.
        steps: usize,
        /// Steps that fit.
        capacity: usize,
    },
    /// The PLC is protected by a keyword.
    Keyword,
    /// The PLC does not stop.
    StillRunning,
    /// The PLC runs, and is not stopped for what is asked.
    Running,
    /// What was written reads otherwise.
    Mismatch {
        /// The first step that differs; parameters are before step 0.
        step: Option<usize>,
    },
    /// The PLC's sum of the program is another.
    Sum {
        /// That of the program that was meant.
        wanted: u16,
        /// That of the PLC.
        found: u16,
    },
    /// This model cannot do that, or nobody knows how.
    NotOnThisModel,
    /// A program without END.
    NoEnd,
    /// The PLC keeps file registers or comments in its program memory; where they lie there is not certain.
    FileRegisters,
    /// The parameters of the PLC are none that this model can have.
    Parameters {
        /// Steps of memory that they say.
        capacity: u32,
    },
    /// What runs and stops a PLC, or lets it be written, is no relay to be switched by the way.
    IsOrder {
        /// Its name.
        device: String,
    },
    /// A line has no such speed.
    NoSpeed {
        /// Bits a second.
        baud: u32,
    },
    /// The serial port is that of a device server, which keeps its speed.
    SpeedElsewhere,
    /// What is in the PLC is not what was there when the download was planned.
    Changed,
    /// The PLC has no such device, or none that the port reaches.
    NoDevice {
        /// Its name.
        device: String,
    },
}

impl LinkError {
    /// What a failure of the system means on a line that was open.
    pub fn of_io(error: &io::Error) -> LinkError {
        LinkError::Gone { reason: error.to_string() }
    }

    /// Whether the line, or what is at its other end, has failed, and not what the user wants of a PLC that answers.
    pub fn is_of_line(&self) -> bool {
        !matches!(
            self,
            LinkError::Cancelled
                | LinkError::NotOnThisModel
                | LinkError::NoSpeed { .. }
                | LinkError::SpeedElsewhere
                | LinkError::Changed
                | LinkError::NoEnd
                | LinkError::IsOrder { .. }
                | LinkError::NoDevice { .. }
                | LinkError::StillRunning
                | LinkError::Running
        )
    }

    /// The word by which scripts know it.
    pub fn code(&self) -> &'static str {
        match self {
            LinkError::NoPort { .. } => "no-port",
            LinkError::Forbidden { .. } => "port-forbidden",
            LinkError::InUse { .. } => "port-in-use",
            LinkError::Unreachable { .. } => "unreachable",
            LinkError::NoAnswer => "no-answer",
            LinkError::Noise => "line-noise",
            LinkError::Gone { .. } => "line-gone",
            LinkError::Refused { .. } => "refused",
            LinkError::Occupied => "plc-occupied",
            LinkError::Cancelled => "cancelled",
            LinkError::UnknownType { .. } => "unknown-plc",
            LinkError::WrongModel { .. } => "wrong-model",
            LinkError::TooLarge { .. } => "too-large",
            LinkError::Keyword => "keyword",
            LinkError::StillRunning => "still-running",
            LinkError::Running => "running",
            LinkError::Mismatch { .. } => "mismatch",
            LinkError::Sum { .. } => "sum",
            LinkError::NotOnThisModel => "not-on-this-model",
            LinkError::NoEnd => "no-end",
            LinkError::FileRegisters => "file-registers",
            LinkError::Parameters { .. } => "bad-parameters",
            LinkError::IsOrder { .. } => "is-order",
            LinkError::NoSpeed { .. } => "no-speed",
            LinkError::SpeedElsewhere => "speed-elsewhere",
            LinkError::Changed => "plc-changed",
            LinkError::NoDevice { .. } => "no-device",
        }
    }

    /// The sentence that says it.
    pub fn message(&self) -> Message {
        match self {
            LinkError::NoPort { port } => Message::new("link.no-port").with("port", port),
            LinkError::Forbidden { port } => Message::new("link.forbidden").with("port", port),
            LinkError::InUse { port } => Message::new("link.in-use").with("port", port),
            LinkError::Unreachable { port, reason } => {
                Message::new("link.unreachable").with("port", port).with("reason", reason)
            }
            LinkError::NoAnswer => Message::new("link.no-answer"),
            LinkError::Noise => Message::new("link.noise"),
            LinkError::Gone { reason } => Message::new("link.gone").with("reason", reason),
            LinkError::Refused { request } => Message::new("link.refused").with("request", request),
            LinkError::Occupied => Message::new("link.occupied"),
            LinkError::Cancelled => Message::new("link.cancelled"),
            LinkError::UnknownType { code } => Message::new("link.unknown-type").with("code", code),
            LinkError::WrongModel { wanted, found } => {
                Message::new("link.wrong-model").with("wanted", wanted).with("found", found)
            }
            LinkError::TooLarge { steps, capacity } => {
                Message::new("link.too-large").with("steps", steps).with("capacity", capacity)
            }
            LinkError::Keyword => Message::new("link.keyword"),
            LinkError::StillRunning => Message::new("link.still-running"),
            LinkError::Running => Message::new("link.running"),
            LinkError::Mismatch { step: Some(step) } => Message::new("link.mismatch").with("step", step),
            LinkError::Mismatch { step: None } => Message::new("link.mismatch-parameters"),
            LinkError::Sum { wanted, found } => Message::new("link.sum")
                .with("wanted", format!("{wanted:04X}"))
                .with("found", format!("{found:04X}")),
            LinkError::NotOnThisModel => Message::new("link.not-on-this-model"),
            LinkError::NoEnd => Message::new("link.no-end"),
            LinkError::FileRegisters => Message::new("link.file-registers"),
            LinkError::Parameters { capacity } => Message::new("link.parameters").with("capacity", capacity),
            LinkError::IsOrder { device } => Message::new("link.is-order").with("device", device),
            LinkError::SpeedElsewhere => Message::new("link.speed-elsewhere"),
            LinkError::Changed => Message::new("link.changed"),
            LinkError::NoSpeed { baud } => Message::new("link.no-speed").with("baud", baud),
            LinkError::NoDevice { device } => Message::new("link.no-device").with("device", device),
        }
    }

    /// What helps.
    pub fn help(&self) -> Message {
        Message::new(match self {
            LinkError::NoPort { .. } => "link.help-no-port",
            LinkError::Forbidden { .. } => "link.help-forbidden",
            LinkError::InUse { .. } => "link.help-in-use",
            LinkError::Unreachable { .. } => "link.help-unreachable",
            LinkError::NoAnswer => "link.help-no-answer",
            LinkError::Noise => "link.help-noise",
            LinkError::Gone { .. } => "link.help-gone",
            LinkError::Refused { .. } => "link.help-refused",
            LinkError::Occupied => "link.help-occupied",
            LinkError::Cancelled => "link.help-cancelled",
            LinkError::UnknownType { .. } => "link.help-unknown-type",
            LinkError::WrongModel { .. } => "link.help-wrong-model",
            LinkError::TooLarge { .. } => "link.help-too-large",
            LinkError::Keyword => "link.help-keyword",
            LinkError::StillRunning => "link.help-still-running",
            LinkError::Running => "link.help-running",
            LinkError::Mismatch { .. } | LinkError::Sum { .. } => "link.help-mismatch",
            LinkError::NotOnThisModel => "link.help-not-on-this-model",
            LinkError::NoEnd => "link.help-no-end",
            LinkError::FileRegisters => "link.help-file-registers",
            LinkError::Parameters { .. } => "link.help-parameters",
            LinkError::IsOrder { .. } => "link.help-is-order",
            LinkError::NoSpeed { .. } => "link.help-no-speed",
            LinkError::SpeedElsewhere => "link.help-speed-elsewhere",
            LinkError::Changed => "link.help-changed",
            LinkError::NoDevice { .. } => "link.help-no-device",
        })
    }
}
