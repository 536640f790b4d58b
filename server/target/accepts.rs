//! Sets of operand kinds.

use super::{Constant, DeviceKind, Model, Operand};

/// The kinds of operand that a place in an instruction takes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Accepts(u32);

impl Accepts {
    /// Nothing.
    pub const NONE: Accepts = Accepts(0);
    /// Input relays.
    pub const X: Accepts = Accepts(1);
    /// Output relays.
    pub const Y: Accepts = Accepts(1 << 1);
    /// Auxiliary relays.
    pub const M: Accepts = Accepts(1 << 2);
    /// States.
    pub const S: Accepts = Accepts(1 << 3);
    /// Timers.
    pub const T: Accepts = Accepts(1 << 4);
    /// Counters.
    pub const C: Accepts = Accepts(1 << 5);
    /// Data registers.
    pub const D: Accepts = Accepts(1 << 6);
    /// Extension registers.
    pub const R: Accepts = Accepts(1 << 7);
    /// Index registers V.
    pub const V: Accepts = Accepts(1 << 8);
    /// Index registers Z.
    pub const Z: Accepts = Accepts(1 << 9);
    /// Pointers P.
    pub const P: Accepts = Accepts(1 << 10);
    /// Interrupt pointers.
    pub const I: Accepts = Accepts(1 << 11);
    /// Nesting levels.
    pub const N: Accepts = Accepts(1 << 12);
    /// KnX.
    pub const KNX: Accepts = Accepts(1 << 13);
    /// KnY.
    pub const KNY: Accepts = Accepts(1 << 14);
    /// KnM.
    pub const KNM: Accepts = Accepts(1 << 15);
    /// KnS.
    pub const KNS: Accepts = Accepts(1 << 16);
    /// Integer constants, K and H.
    pub const K: Accepts = Accepts(1 << 17);
    /// Real constants.
    pub const E: Accepts = Accepts(1 << 18);
    /// Text.
    pub const TEXT: Accepts = Accepts(1 << 19);
    /// Bits of words, `D0.3`.
    pub const WORD_BIT: Accepts = Accepts(1 << 20);

    /// What contacts read: X Y M S T C, and bits of words.
    pub const CONTACT: Accepts =
        Self::X.or(Self::Y).or(Self::M).or(Self::S).or(Self::T).or(Self::C).or(Self::WORD_BIT);
    /// KnY KnM KnS T C D R V Z: word destinations.
    pub const WORD_DESTINATION: Accepts = Self::KNY
        .or(Self::KNM)
        .or(Self::KNS)
        .or(Self::T)
        .or(Self::C)
        .or(Self::D)
        .or(Self::R)
        .or(Self::V)
        .or(Self::Z);
    /// K H and every word: word sources.
    pub const WORD_SOURCE: Accepts = Self::WORD_DESTINATION.or(Self::KNX).or(Self::K);

    /// X Y M S, and bits of words: bits that applied instructions read.
    pub const BIT_SOURCE: Accepts = Self::X.or(Self::Y).or(Self::M).or(Self::S).or(Self::WORD_BIT);
    /// Y M S, and bits of words: bits that applied instructions write.
    pub const BIT_DESTINATION: Accepts = Self::Y.or(Self::M).or(Self::S).or(Self::WORD_BIT);

    /// Both.
    pub const fn or(self, other: Accepts) -> Accepts {
        Accepts(self.0 | other.0)
    }

    /// This without `other`.
    pub const fn without(self, other: Accepts) -> Accepts {
        Accepts(self.0 & !other.0)
    }

    /// What of it exists on `model`: extension registers, bits of words and real constants came with the FX3U.
    pub const fn on(self, model: Model) -> Accepts {
        match model {
            Model::Fx3u => self,
            _ => self.without(Self::R.or(Self::WORD_BIT).or(Self::E)),
        }
    }

    /// Whether every kind of `other` is in it.
    pub const fn contains(self, other: Accepts) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether it takes `operand`. Words that could not be read are other rules' matter and pass.
    pub fn takes(self, operand: &Operand) -> bool {
        Accepts::of(operand).is_none_or(|kind| self.contains(kind))
    }

    /// The kind of an FX operand; nothing for unreadable words and IEC operands.
    pub fn of(operand: &Operand) -> Option<Accepts> {
        Some(match operand {
            Operand::Device(device) | Operand::Indexed { device, .. } => Accepts::of_kind(device.kind),
            Operand::Nibbles { first, .. } => match first.kind {
                DeviceKind::X => Accepts::KNX,
                DeviceKind::Y => Accepts::KNY,
                DeviceKind::M => Accepts::KNM,
                DeviceKind::S => Accepts::KNS,
                _ => return None,
            },
            Operand::WordBit { .. } => Accepts::WORD_BIT,
            Operand::Constant { value: Constant::Real(_), .. } => Accepts::E,
            Operand::Constant { .. } => Accepts::K,
            Operand::Text => Accepts::TEXT,
            Operand::Direct(_) | Operand::Literal(_) | Operand::Variable | Operand::Invalid(_) => {
                return None;
            }
        })
    }

    /// Its kinds as the manuals write them, in reading order: `K`, `H`, `KnX`, `X`, `D` …
    pub fn names(self) -> Vec<&'static str> {
        let named = NAMES.iter().filter(|(kind, _)| self.contains(*kind));
        named.flat_map(|(_, names)| names.iter().copied()).collect()
    }

    /// The set of this one device kind.
    pub const fn of_kind(kind: DeviceKind) -> Accepts {
        match kind {
            DeviceKind::X => Accepts::X,
            DeviceKind::Y => Accepts::Y,
            DeviceKind::M => Accepts::M,
            DeviceKind::S => Accepts::S,
            DeviceKind::T => Accepts::T,
            DeviceKind::C => Accepts::C,
            DeviceKind::D => Accepts::D,
            DeviceKind::R => Accepts::R,
            DeviceKind::V => Accepts::V,
            DeviceKind::Z => Accepts::Z,
            DeviceKind::P => Accepts::P,
            DeviceKind::I => Accepts::I,
            DeviceKind::N => Accepts::N,
        }
    }
}

/// Each kind with its names; integer constants have two.
const NAMES: &[(Accepts, &[&str])] = &[
    (Accepts::K, &["K", "H"]),
    (Accepts::E, &["E"]),
    (Accepts::TEXT, &["text"]),
    (Accepts::X, &["X"]),
    (Accepts::Y, &["Y"]),
    (Accepts::M, &["M"]),
    (Accepts::S, &["S"]),
    (Accepts::KNX, &["KnX"]),
    (Accepts::KNY, &["KnY"]),
    (Accepts::KNM, &["KnM"]),
    (Accepts::KNS, &["KnS"]),
    (Accepts::T, &["T"]),
    (Accepts::C, &["C"]),
    (Accepts::D, &["D"]),
    (Accepts::R, &["R"]),
    (Accepts::V, &["V"]),
    (Accepts::Z, &["Z"]),
    (Accepts::WORD_BIT, &["D.b"]),
    (Accepts::P, &["P"]),
    (Accepts::I, &["I"]),
    (Accepts::N, &["N"]),
];
