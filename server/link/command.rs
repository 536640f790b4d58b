//! Requests of a host, and what they are on the line.

use super::frame::{MOST_DATA, hex, unhex};

/// Which of the PLC's memories a request is about.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Space {
    /// Devices, in the map of every FX.
    Plain,
    /// Devices, in the map of FX1N, FX2N and FX3U.
    Extended,
    /// Parameters and program, of the same.
    Program,
}

/// A request.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Command {
    /// Reads bytes.
    Read {
        /// The memory.
        space: Space,
        /// The first byte.
        address: u16,
        /// How many.
        length: u8,
    },
    /// Writes bytes.
    Write {
        /// The memory.
        space: Space,
        /// The first byte.
        address: u16,
        /// What is written.
        data: Vec<u8>,
    },
    /// Switches a bit of a device.
    Force {
        /// The memory.
        space: Space,
        /// The bit.
        bit: u16,
        /// On or off.
        on: bool,
    },
    /// Looks in the program memory for a word from an address on; extended only.
    Search {
        /// Where it begins.
        from: u16,
        /// The word, its lower byte first.
        word: [u8; 2],
    },
    /// Ends a download: the PLC takes over the program and adds it up.
    Commit,
    /// A step of clearing memory, by its number behind `E6`.
    Clear(u8),
    /// Changes the speed of the line.
    Speed(Speed),
}

/// The speeds that a line can be switched to. That of 19,200 was recorded; the others come from one client.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Speed {
    /// 19,200 bit/s.
    Baud19200,
    /// 38,400 bit/s.
    Baud38400,
    /// 57,600 bit/s.
    Baud57600,
    /// 115,200 bit/s.
    Baud115200,
}

impl Speed {
    /// All of them, slowest first, with their digits behind `A`.
    const CODES: [(Speed, u8, u32); 4] = [
        (Speed::Baud19200, b'1', 19_200),
        (Speed::Baud38400, b'2', 38_400),
        (Speed::Baud57600, b'3', 57_600),
        (Speed::Baud115200, b'5', 115_200),
    ];

    /// The speed of so many bits in a second.
    pub fn of_baud(baud: u32) -> Option<Speed> {
        Speed::CODES.iter().find(|(_, _, own)| *own == baud).map(|(speed, _, _)| *speed)
    }

    /// Bits in a second.
    pub fn baud(self) -> u32 {
        Speed::CODES.iter().find(|(speed, _, _)| *speed == self).map_or(9600, |(_, _, baud)| *baud)
    }

    fn code(self) -> u8 {
        Speed::CODES.iter().find(|(speed, _, _)| *speed == self).map_or(b'0', |(_, code, _)| *code)
    }
}

/// What a host expects for a request.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Expected {
    /// ACK alone.
    Acknowledge,
    /// So many bytes.
    Data(usize),
    /// An address, or word that there is none.
    Found,
}

/// What a PLC answers.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Reply {
    /// Done.
    Done,
    /// Bytes that were read.
    Data(Vec<u8>),
    /// Where a word was found.
    Found(Option<u16>),
}

impl Command {
    /// Whether only an FX1N, FX2N or FX3U knows it.
    pub fn is_extended(&self) -> bool {
        match self {
            Command::Read { space, .. } | Command::Write { space, .. } | Command::Force { space, .. } => {
                *space != Space::Plain
            }
            Command::Search { .. } | Command::Clear(_) => true,
            Command::Commit | Command::Speed(_) => false,
        }
    }

    /// The body of the request's frame.
    pub fn body(&self) -> Vec<u8> {
        let address = |address: &u16| hex(&address.to_be_bytes());
        match self {
            Command::Read { space, address: first, length } => {
                let verb: &[u8] = match space {
                    Space::Plain => b"0",
                    Space::Extended => b"E00",
                    Space::Program => b"E01",
                };
                [verb, &address(first), &hex(&[*length])].concat()
            }
            Command::Write { space, address: first, data } => {
                let verb: &[u8] = match space {
                    Space::Plain => b"1",
                    Space::Extended => b"E10",
                    Space::Program => b"E11",
                };
                [verb, &address(first), &hex(&[data.len() as u8]), &hex(data)].concat()
            }
            Command::Force { space, bit, on } => {
                let verb: &[u8] = match (space, on) {
                    (Space::Plain, true) => b"7",
                    (Space::Plain, false) => b"8",
                    (_, true) => b"E7",
                    (_, false) => b"E8",
                };
                [verb, &hex(&bit.to_le_bytes())].concat()
            }
            Command::Search { from, word } => [b"E41", &address(from)[..], &hex(word)].concat(),
            Command::Commit => b"B".to_vec(),
            Command::Clear(step) => vec![b'E', b'6', b'0' + step],
            Command::Speed(speed) => vec![b'A', speed.code()],
        }
    }

    /// The request of a frame's body; nothing where it is none that is known, or asks for too much.
    pub fn of_body(body: &[u8]) -> Option<Command> {
        let after = |verb: &[u8]| body.strip_prefix(verb);
        let read = |space, verb| {
            let [high, low, length] = unhex(after(verb)?)?[..] else { return None };
            let is_fit = (1..=MOST_DATA).contains(&usize::from(length));
            is_fit.then_some(Command::Read { space, address: u16::from_be_bytes([high, low]), length })
        };
        let write = |space, verb| {
            let bytes = unhex(after(verb)?)?;
            let [high, low, length, data @ ..] = &bytes[..] else { return None };
            let is_fit = (1..=MOST_DATA).contains(&data.len()) && data.len() == usize::from(*length);
            let address = u16::from_be_bytes([*high, *low]);
            is_fit.then(|| Command::Write { space, address, data: data.to_vec() })
        };
        let force = |space, verb, on| match unhex(after(verb)?)?[..] {
            [low, high] => Some(Command::Force { space, bit: u16::from_le_bytes([low, high]), on }),
            _ => None,
        };
        match body {
            b"B" => Some(Command::Commit),
            [b'E', b'6', step @ b'0'..=b'4'] => Some(Command::Clear(step - b'0')),
            [b'A', code] => {
                let known = Speed::CODES.iter().find(|(_, own, _)| own == code);
                known.map(|(speed, _, _)| Command::Speed(*speed))
            }
            [b'0', ..] => read(Space::Plain, b"0"),
            [b'1', ..] => write(Space::Plain, b"1"),
            [b'7', ..] => force(Space::Plain, b"7", true),
            [b'8', ..] => force(Space::Plain, b"8", false),
            [b'E', b'0', b'0', ..] => read(Space::Extended, b"E00"),
            [b'E', b'0', b'1', ..] => read(Space::Program, b"E01"),
            [b'E', b'1', b'0', ..] => write(Space::Extended, b"E10"),
            [b'E', b'1', b'1', ..] => write(Space::Program, b"E11"),
            [b'E', b'7', ..] => force(Space::Extended, b"E7", true),
            [b'E', b'8', ..] => force(Space::Extended, b"E8", false),
            [b'E', b'4', b'1', rest @ ..] => match unhex(rest)?[..] {
                [high, low, first, second] => {
                    Some(Command::Search { from: u16::from_be_bytes([high, low]), word: [first, second] })
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// What is expected for it.
    pub fn expected(&self) -> Expected {
        match self {
            Command::Read { length, .. } => Expected::Data(usize::from(*length)),
            Command::Search { .. } => Expected::Found,
            _ => Expected::Acknowledge,
        }
    }
}

impl Expected {
    /// The reply in a frame's body, if it is one of this kind.
    pub fn reply(self, body: &[u8]) -> Option<Reply> {
        match self {
            Expected::Acknowledge => None,
            Expected::Data(length) => unhex(body).filter(|data| data.len() == length).map(Reply::Data),
            Expected::Found => match body {
                b"" => Some(Reply::Found(None)),
                [b'1', address @ ..] => match unhex(address)?[..] {
                    [high, low] => Some(Reply::Found(Some(u16::from_be_bytes([high, low])))),
                    _ => None,
                },
                _ => None,
            },
        }
    }

    /// Bytes of the whole reply on the line.
    pub fn bytes(self) -> usize {
        match self {
            Expected::Acknowledge => 1,
            Expected::Data(length) => length * 2 + 4,
            Expected::Found => 5 + 4,
        }
    }
}

impl Reply {
    /// The body of the reply's frame; nothing for ACK.
    pub fn body(&self) -> Option<Vec<u8>> {
        match self {
            Reply::Done => None,
            Reply::Data(data) => Some(hex(data)),
            Reply::Found(None) => Some(Vec::new()),
            Reply::Found(Some(address)) => Some([b"1", &hex(&address.to_be_bytes())[..]].concat()),
        }
    }
}
