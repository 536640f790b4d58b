//! Operands: one word of a program read as a device, a constant, an address or a name.

use super::{Device, Model, fx, iec};
use std::fmt;

/// What an operand word says. The word itself stays in the text; its span is kept beside this value.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Operand {
    /// `X0`, `D10`, `T5`.
    Device(Device),
    /// `D0Z1`: the device number plus the content of the index register.
    Indexed {
        /// The base.
        device: Device,
        /// A V or Z register.
        index: Device,
    },
    /// `K4M0`: `digits` groups of four bit devices from `first` on, perhaps indexed (`K4M0Z0`).
    Nibbles {
        /// 1 to 8.
        digits: u8,
        /// First bit device.
        first: Device,
        /// A V or Z register.
        index: Option<Device>,
    },
    /// `D0.3`: one bit of a word (FX3U).
    WordBit {
        /// The register.
        word: Device,
        /// 0 to 15.
        bit: u8,
    },
    /// `K100`, `H0F`, `E1.5`, perhaps indexed (`K10Z0`).
    Constant {
        /// The value as written.
        value: Constant,
        /// A V or Z register.
        index: Option<Device>,
    },
    /// An IEC direct address, `%IX0.3`.
    Direct(DirectAddress),
    /// An IEC literal, `T#2s`, `16#FF`, `TRUE`, `'text'`.
    Literal(iec::Literal),
    /// An IEC variable, perhaps with members and subscripts: `Motor`, `T1.Q`, `a[3].b`.
    Variable,
    /// Text operand of an FX instruction (ASC, `"ABCDEFGH"`).
    Text,
    /// Not an operand; the rules say why.
    Invalid(OperandProblem),
}

/// An FX constant.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Constant {
    /// `K` and a decimal number.
    Decimal(i64),
    /// `H` and a hexadecimal number.
    Hexadecimal(u64),
    /// `E` and a real number, `E1.5` or `E1.5+3` (1.5 × 10³).
    Real(f64),
}

/// Why a word is no operand.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum OperandProblem {
    /// A letter that names no device, or no number after it.
    UnknownDevice,
    /// An 8 or a 9 in the number of an input or an output.
    OctalDigit,
    /// A `K`, `H` or `E` whose number cannot be read or has more than 64 bits, or a group of bits that is none
    /// (`K9M0`).
    MalformedConstant,
    /// An IEC literal that cannot be read, with the reason.
    MalformedLiteral(iec::LiteralProblem),
    /// `%` without a readable address.
    MalformedAddress,
    /// An IEC keyword where a name or a value belongs.
    Keyword,
    /// An IEC name that breaks the rules of identifiers, or a path with a broken member, subscript or bit.
    MalformedName,
    /// The symbol of this device in a form that the device does not have, such as `K4Level` for a register.
    SymbolForm(Device),
    /// A word that can be put together of symbols in several ways.
    SymbolTwice,
    /// Nothing of the above.
    Unreadable,
}

/// The memory area of a direct address.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Location {
    /// `%I`
    Input,
    /// `%Q`
    Output,
    /// `%M`
    Memory,
}

/// The size of a direct address.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Width {
    /// `X` or no letter: one bit.
    Bit,
    /// `B`: 8 bits.
    Byte,
    /// `W`: 16 bits.
    Word,
    /// `D`: 32 bits.
    Double,
    /// `L`: 64 bits.
    Long,
}

/// An IEC direct address such as `%IX0.3`; up to four levels of hierarchy.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct DirectAddress {
    /// The area.
    pub location: Location,
    /// The size.
    pub width: Width,
    /// The numbers; `None` marks `%I*`, an address to be bound later.
    pub path: [Option<u32>; 4],
}

impl Operand {
    /// Reads one operand word as `model` spells it. Never fails; see [`Operand::Invalid`].
    ///
    /// ```
    /// use rungwise::target::{Device, DeviceKind, Model, Operand};
    /// assert_eq!(Operand::read("x010", Model::Fx2n), Operand::Device(Device::new(DeviceKind::X, 8)));
    /// ```
    pub fn read(word: &str, model: Model) -> Operand {
        match model {
            Model::Iec => iec::read_operand(word),
            _ => fx::read(word),
        }
    }

    /// The device that it names or starts from, index and bit aside.
    pub fn device(&self) -> Option<Device> {
        match *self {
            Operand::Device(device) | Operand::Indexed { device, .. } => Some(device),
            Operand::Nibbles { first, .. } => Some(first),
            Operand::WordBit { word, .. } => Some(word),
            _ => None,
        }
    }
}

impl fmt::Display for DirectAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let area = match self.location {
            Location::Input => 'I',
            Location::Output => 'Q',
            Location::Memory => 'M',
        };
        let width = match self.width {
            Width::Bit => 'X',
            Width::Byte => 'B',
            Width::Word => 'W',
            Width::Double => 'D',
            Width::Long => 'L',
        };
        let numbers: Vec<String> = self.path.iter().flatten().map(u32::to_string).collect();
        match numbers.is_empty() {
            true => write!(f, "%{area}*"),
            false => write!(f, "%{area}{width}{}", numbers.join(".")),
        }
    }
}
