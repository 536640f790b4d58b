//! Operand words of the FX family.
//!
//! | word | what |
//! |---|---|
//! | `X0` `x010` `Y17` | inputs and outputs, octal |
//! | `M100` `D0` `T5` `S20` `C235` `R0` `P63` `I001` `N0` | devices, decimal, leading zeros allowed |
//! | `V` `Z` `V3` | index registers; a letter alone is number 0 |
//! | `D0Z1` `M10V` `K10Z0` `P5Z0` | with an index register |
//! | `K4M0` `K2X10Z0` | 1 to 8 groups of four bits |
//! | `D0.3` `D0.F` | a bit of a register, hexadecimal digit |
//! | `K100` `K-5` `H0F` | integers |
//! | `E10` `E-1.5` `E1.5+3` `E1.5E3` | real numbers; `+3` and `E3` are powers of ten |
//! | `"AB"` | text |

use crate::target::{Constant, Device, DeviceKind, Operand, OperandProblem};

const MALFORMED: Operand = Operand::Invalid(OperandProblem::MalformedConstant);
const UNKNOWN: Operand = Operand::Invalid(OperandProblem::UnknownDevice);

/// Reads one word. A device number too large for 32 bits is read as the largest one, which no model has.
pub fn read(word: &str) -> Operand {
    let Some(first) = word.chars().next() else {
        return Operand::Invalid(OperandProblem::Unreadable);
    };
    // The letter of every operand is one byte, so the rest of the word starts at 1.
    let rest = word.as_bytes().get(1..).unwrap_or_default();
    match first.to_ascii_uppercase() {
        'K' => decimal(rest),
        'H' => hexadecimal(rest),
        'E' => real(word.get(1..).unwrap_or_default()),
        '"' if rest.last() == Some(&b'"') => Operand::Text,
        letter => match DeviceKind::of_letter(letter) {
            Some(kind) => device(kind, rest),
            None if letter.is_alphabetic() => UNKNOWN,
            None => Operand::Invalid(OperandProblem::Unreadable),
        },
    }
}

/// A device, and after its number an index register or the bit of a register.
fn device(kind: DeviceKind, text: &[u8]) -> Operand {
    if text.is_empty() && matches!(kind, DeviceKind::V | DeviceKind::Z) {
        return Operand::Device(Device::new(kind, 0));
    }
    let (device, rest) = match numbered(kind, text) {
        Ok(found) => found,
        Err(problem) => return Operand::Invalid(problem),
    };
    match rest {
        [] => Operand::Device(device),
        [b'.', digit] if kind == DeviceKind::D => match (*digit as char).to_digit(16) {
            Some(bit) => Operand::WordBit { word: device, bit: bit as u8 },
            None => UNKNOWN,
        },
        _ if matches!(kind, DeviceKind::V | DeviceKind::Z | DeviceKind::I | DeviceKind::N) => UNKNOWN,
        _ => index(rest).map_or(UNKNOWN, |index| Operand::Indexed { device, index }),
    }
}

/// The number of a device of `kind` at the start of `text`, and what follows it.
fn numbered(kind: DeviceKind, text: &[u8]) -> Result<(Device, &[u8]), OperandProblem> {
    let (digits, rest) = split_digits(text);
    if digits.is_empty() {
        return Err(OperandProblem::UnknownDevice);
    }
    let base = kind.number_base();
    let mut number = 0u32;
    for digit in digits {
        let digit = u32::from(digit - b'0');
        if digit >= base {
            return Err(OperandProblem::OctalDigit);
        }
        number = number.saturating_mul(base).saturating_add(digit);
    }
    Ok((Device::new(kind, number), rest))
}

/// `V`, `Z` or one of them with a number, and nothing after it.
fn index(text: &[u8]) -> Option<Device> {
    let (letter, digits) = text.split_first()?;
    let kind = match letter.to_ascii_uppercase() {
        b'V' => DeviceKind::V,
        b'Z' => DeviceKind::Z,
        _ => return None,
    };
    if digits.is_empty() {
        return Some(Device::new(kind, 0));
    }
    let (device, rest) = numbered(kind, digits).ok()?;
    rest.is_empty().then_some(device)
}

/// What may follow a constant or a group of bits: nothing, or an index register.
fn index_or_end(text: &[u8]) -> Option<Option<Device>> {
    if text.is_empty() { Some(None) } else { index(text).map(Some) }
}

/// After `K`: a decimal number, or groups of bits.
fn decimal(text: &[u8]) -> Operand {
    let (negative, unsigned) = match text {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, text),
    };
    let (digits, rest) = split_digits(unsigned);
    if digits.is_empty() {
        return MALFORMED;
    }
    let mut value = 0i64;
    for digit in digits {
        let next = value.checked_mul(10).and_then(|value| value.checked_add(i64::from(digit - b'0')));
        let Some(next) = next else {
            return MALFORMED;
        };
        value = next;
    }
    let group_of = rest.first().and_then(|letter| match letter.to_ascii_uppercase() {
        b'X' => Some(DeviceKind::X),
        b'Y' => Some(DeviceKind::Y),
        b'M' => Some(DeviceKind::M),
        b'S' => Some(DeviceKind::S),
        _ => None,
    });
    if let Some(kind) = group_of {
        let signed = unsigned.len() != text.len();
        return if signed { MALFORMED } else { nibbles(value, kind, rest.get(1..).unwrap_or_default()) };
    }
    let value = Constant::Decimal(if negative { -value } else { value });
    index_or_end(rest).map_or(MALFORMED, |index| Operand::Constant { value, index })
}

/// `digits` groups of four devices of `kind`; `text` is the number of the first one and perhaps an index.
fn nibbles(digits: i64, kind: DeviceKind, text: &[u8]) -> Operand {
    let (1..=8, Ok(digits)) = (digits, u8::try_from(digits)) else {
        return MALFORMED;
    };
    match numbered(kind, text) {
        Ok((first, rest)) => {
            index_or_end(rest).map_or(MALFORMED, |index| Operand::Nibbles { digits, first, index })
        }
        Err(OperandProblem::OctalDigit) => Operand::Invalid(OperandProblem::OctalDigit),
        Err(_) => MALFORMED,
    }
}

/// After `H`: hexadecimal digits. None of them is a V or a Z, so an index register is unmistakable.
fn hexadecimal(text: &[u8]) -> Operand {
    let length = text.iter().take_while(|byte| byte.is_ascii_hexdigit()).count();
    let (digits, rest) = text.split_at(length);
    if digits.is_empty() {
        return MALFORMED;
    }
    let mut value = 0u64;
    for digit in digits {
        let Some(shifted) = value.checked_mul(16) else {
            return MALFORMED;
        };
        value = shifted | u64::from((*digit as char).to_digit(16).unwrap_or(0));
    }
    let value = Constant::Hexadecimal(value);
    index_or_end(rest).map_or(MALFORMED, |index| Operand::Constant { value, index })
}

/// After `E`: a sign, digits with or without a point, and a power of ten written `+3`, `-3`, `E3`, `E+3` or `E-3`.
fn real(text: &str) -> Operand {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let mantissa_end = unsigned
        .find(|letter: char| !letter.is_ascii_digit() && letter != '.')
        .map_or(text.len(), |end| end + text.len() - unsigned.len());
    let (mantissa, power) = text.split_at(mantissa_end);
    // Rust's own reader also knows `inf` and `nan`; only digits and one point get as far as it.
    let Ok(mantissa_value) = mantissa.parse::<f64>() else {
        return MALFORMED;
    };
    let value = if power.is_empty() {
        Some(mantissa_value)
    } else {
        let exponent = power.strip_prefix(['E', 'e']).unwrap_or(power);
        exponent.parse::<i16>().ok().and_then(|exponent| format!("{mantissa}e{exponent}").parse().ok())
    };
    match value {
        Some(value) if value.is_finite() => Operand::Constant { value: Constant::Real(value), index: None },
        _ => MALFORMED,
    }
}

fn split_digits(text: &[u8]) -> (&[u8], &[u8]) {
    text.split_at(text.iter().take_while(|byte| byte.is_ascii_digit()).count())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::DeviceKind::*;

    fn at(kind: DeviceKind, number: u32) -> Device {
        Device::new(kind, number)
    }

    fn decimal(value: i64) -> Operand {
        Operand::Constant { value: Constant::Decimal(value), index: None }
    }

    #[test]
    fn devices() {
        for (word, device) in [
            ("X0", at(X, 0)),
            ("x010", at(X, 8)),
            ("Y377", at(Y, 255)),
            ("m8000", at(M, 8000)),
            ("D0007", at(D, 7)),
            ("P63", at(P, 63)),
            ("I001", at(I, 1)),
            ("N7", at(N, 7)),
            ("V", at(V, 0)),
            ("z", at(Z, 0)),
            ("Z7", at(Z, 7)),
            ("R32767", at(R, 32767)),
            ("D99999999999999999999", at(D, u32::MAX)),
            ("X77777777777777777777", at(X, u32::MAX)),
        ] {
            assert_eq!(read(word), Operand::Device(device), "{word}");
        }
    }

    #[test]
    fn compound_words() {
        let indexed = |device, index| Operand::Indexed { device, index };
        let nibbles = |digits, first, index| Operand::Nibbles { digits, first, index };
        for (word, operand) in [
            ("D0Z1", indexed(at(D, 0), at(Z, 1))),
            ("d0v", indexed(at(D, 0), at(V, 0))),
            ("X10Z0", indexed(at(X, 8), at(Z, 0))),
            ("P5Z0", indexed(at(P, 5), at(Z, 0))),
            ("K4M0", nibbles(4, at(M, 0), None)),
            ("k2x010", nibbles(2, at(X, 8), None)),
            ("K4M0Z1", nibbles(4, at(M, 0), Some(at(Z, 1)))),
            ("D0.3", Operand::WordBit { word: at(D, 0), bit: 3 }),
            ("D100.f", Operand::WordBit { word: at(D, 100), bit: 15 }),
            ("\"AB C\"", Operand::Text),
        ] {
            assert_eq!(read(word), operand, "{word}");
        }
    }

    #[test]
    fn constants() {
        let index = Some(at(Z, 0));
        let hexadecimal = |value| Operand::Constant { value: Constant::Hexadecimal(value), index: None };
        let real = |value| Operand::Constant { value: Constant::Real(value), index: None };
        for (word, operand) in [
            ("K100", decimal(100)),
            ("k-5", decimal(-5)),
            ("K+5", decimal(5)),
            ("K007", decimal(7)),
            ("K9223372036854775807", decimal(i64::MAX)),
            ("K10Z0", Operand::Constant { value: Constant::Decimal(10), index }),
            ("H0F", hexadecimal(15)),
            ("hffff", hexadecimal(0xFFFF)),
            ("HFZ", Operand::Constant { value: Constant::Hexadecimal(15), index }),
            ("E10", real(10.0)),
            ("E1.5", real(1.5)),
            ("E-1.5", real(-1.5)),
            ("E1.5+3", real(1500.0)),
            ("E1.5-3", real(0.0015)),
            ("E1.5E3", real(1500.0)),
            ("e-1.5e-3", real(-0.0015)),
            ("E.5", real(0.5)),
        ] {
            assert_eq!(read(word), operand, "{word}");
        }
    }

    #[test]
    fn problems() {
        use OperandProblem::*;
        for (problem, words) in [
            (OctalDigit, &["X8", "Y19", "x008", "K1X8", "X9Z0"][..]),
            (
                MalformedConstant,
                &[
                    "K",
                    "H",
                    "E",
                    "K-",
                    "KZ0",
                    "K1.5",
                    "K9M0",
                    "K0M0",
                    "K-4M0",
                    "K4D0",
                    "K4M",
                    "HG",
                    "H-1",
                    "E.",
                    "E1.2.3",
                    "Einf",
                    "ENaN",
                    "E-inf",
                    "E1E",
                    "E1+",
                    "E1Z0",
                    "E1E9999",
                    "K4M0Z1Z1",
                    "K99999999999999999999",
                    "H10000000000000000",
                    "E1+-3",
                ],
            ),
            (
                UnknownDevice,
                &[
                    "X", "M", "Q5", "Motor", "X1A", "D0Z1Z2", "D0.", "D0.G", "D0.10", "M0.1", "V0Z0", "N0Z0",
                    "D0X1", "D-1", "電", "Xä", "é1",
                ],
            ),
            (Unreadable, &["", "?", "\"", "\"AB", "1", "-5", "%IX0.0"]),
        ] {
            for word in words {
                assert_eq!(read(word), Operand::Invalid(problem), "{word}");
            }
        }
    }
}
