//! Frames of the programming port: how bytes on the line become requests and replies.
//!
//! A frame is `STX body ETX sum`: the body is ASCII, the sum the low eight bits of the sum of all bytes behind STX up
//! to and with ETX, in two hexadecimal digits. Sources: recordings of the maker's tools with FX1S, FX1N and FX2N, and
//! four independent clients and firmwares that agree.

/// Start of a frame.
pub const STX: u8 = 0x02;
/// End of a frame's body.
pub const ETX: u8 = 0x03;
/// The host asks whether somebody is there.
pub const ENQ: u8 = 0x05;
/// Yes, or done.
pub const ACK: u8 = 0x06;
/// No, without a reason.
pub const NAK: u8 = 0x15;

/// The longest body that is sent: a write of [`MOST_DATA`] bytes by an extended command.
pub const LONGEST_BODY: usize = 3 + 4 + 2 + 2 * MOST_DATA;

/// Bytes of memory that one request reads or writes at most.
pub const MOST_DATA: usize = 0x40;

/// Bits that a byte takes on the line: start, seven of data, parity, stop.
pub const BITS_PER_BYTE: u64 = 10;

/// Something whole that arrived.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Arrival {
    /// [`ENQ`] outside a frame.
    Enquiry,
    /// [`ACK`] outside a frame.
    Acknowledge,
    /// [`NAK`] outside a frame.
    Refusal,
    /// The body of a frame whose sum is right.
    Body(Vec<u8>),
    /// A frame whose sum is wrong, or which is longer than any.
    Damaged,
}

/// The frame around a body.
pub fn framed(body: &[u8]) -> Vec<u8> {
    let mut frame = Vec::with_capacity(body.len() + 4);
    frame.push(STX);
    frame.extend_from_slice(body);
    frame.push(ETX);
    let sum = sum(&frame[1..]);
    frame.extend_from_slice(&hex(&[sum]));
    frame
}

/// The low eight bits of the sum of all bytes.
pub fn sum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum.wrapping_add(*byte))
}

/// Two upper-case digits for each byte.
pub fn hex(bytes: &[u8]) -> Vec<u8> {
    const DIGITS: &[u8; 16] = b"0123456789ABCDEF";
    let mut text = Vec::with_capacity(bytes.len() * 2);
    for byte in bytes {
        text.extend([DIGITS[usize::from(byte >> 4)], DIGITS[usize::from(byte & 0xF)]]);
    }
    text
}

/// The bytes that upper-case digits stand for; nothing where they are none, or one is left over.
pub fn unhex(digits: &[u8]) -> Option<Vec<u8>> {
    let value = |digit: u8| match digit {
        b'0'..=b'9' => Some(digit - b'0'),
        b'A'..=b'F' => Some(digit - b'A' + 10),
        _ => None,
    };
    let (pairs, rest) = digits.as_chunks::<2>();
    let mut bytes = Vec::with_capacity(pairs.len());
    for [high, low] in pairs {
        bytes.push(value(*high)? << 4 | value(*low)?);
    }
    rest.is_empty().then_some(bytes)
}

/// Puts the bytes of a line together.
///
/// It keeps no more than one frame, whatever arrives, and takes a new STX as a new start, as the firmwares do.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    state: State,
}

#[derive(Clone, Debug, Default)]
enum State {
    /// Between frames.
    #[default]
    Outside,
    /// Behind STX.
    Body(Vec<u8>),
    /// Behind ETX, with the first digit of the sum if that is there.
    Sum(Vec<u8>, Option<u8>),
}

impl Frames {
    /// Takes a byte. Bytes outside frames that mean nothing are passed over.
    pub fn take(&mut self, byte: u8) -> Option<Arrival> {
        // The line has seven bits of data; some adapters deliver the parity bit too.
        let byte = byte & 0x7F;
        let state = std::mem::take(&mut self.state);
        if byte == STX {
            self.state = State::Body(Vec::new());
            return None;
        }
        match state {
            State::Outside => match byte {
                ENQ => Some(Arrival::Enquiry),
                ACK => Some(Arrival::Acknowledge),
                NAK => Some(Arrival::Refusal),
                _ => None,
            },
            State::Body(body) if byte == ETX => {
                self.state = State::Sum(body, None);
                None
            }
            State::Body(body) if body.len() >= LONGEST_BODY => Some(Arrival::Damaged),
            State::Body(mut body) => {
                body.push(byte);
                self.state = State::Body(body);
                None
            }
            State::Sum(body, None) => {
                self.state = State::Sum(body, Some(byte));
                None
            }
            State::Sum(body, Some(first)) => {
                let wanted = sum(&body).wrapping_add(ETX);
                let is_right = unhex(&[first, byte]) == Some(vec![wanted]);
                Some(if is_right { Arrival::Body(body) } else { Arrival::Damaged })
            }
        }
    }

    /// Whether nothing has begun that is not over.
    pub fn is_outside(&self) -> bool {
        matches!(self.state, State::Outside)
    }

    /// Forgets what has begun.
    pub fn clear(&mut self) {
        self.state = State::Outside;
    }
}
