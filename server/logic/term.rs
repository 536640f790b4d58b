//! Words of a program as the logic compares them.

use crate::document::{DeclaredType, Scopes, Variable};
use crate::il::iec::SectionKind;
use crate::target::{Constant, Device, DeviceKind, DirectAddress, Operand, Width};
use crate::text::{Span, folded};
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::fmt;
use std::ops::Range;

/// An operand: what it says, how it was written, and where. Two terms are equal if they mean the same, however written.
#[derive(Clone, Debug)]
pub struct Term {
    /// As read.
    pub operand: Operand,
    /// As written.
    pub text: SmolStr,
    /// Where it stands in the chunk that it was read from; empty if it was not read.
    pub span: Span,
    /// Where the variable that it names, or is a part of, lies in memory.
    pub storage: Storage,
}

/// Where a variable of IEC 61131-3 lies in memory, so that two names of one place are one bit.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Storage {
    /// In a place of its own.
    #[default]
    Own,
    /// The same, of a plain variable that only its program unit knows: nothing that is called changes it.
    Local,
    /// At an address, which other variables may have, too.
    At(DirectAddress),
    /// Where somebody else says, so that any other variable may lie there: VAR_IN_OUT, `AT %Q*`, `reference^`.
    Anywhere,
}

impl Storage {
    /// Where the variable `name`, or the one that `name` is a part of, lies as declared in program unit number `pou`.
    pub fn declared(scopes: &Scopes, pou: Option<usize>, name: &str) -> Storage {
        // What a reference leads to, nobody knows.
        if name.contains('^') {
            return Storage::Anywhere;
        }
        let root = &name[..name.find(['.', '[', '^']).unwrap_or(name.len())];
        let Some(variable) = scopes.variable(pou, root) else { return Storage::Own };
        let variable = match variable.section {
            SectionKind::InOut => return Storage::Anywhere,
            SectionKind::External => scopes.variable(None, root).unwrap_or(variable),
            _ => variable,
        };
        match variable.address {
            Some(address) if address.path[0].is_none() => Storage::Anywhere,
            Some(address) => Storage::At(address),
            None if root.len() == name.len() && is_plain(scopes, variable) => Storage::Local,
            None => Storage::Own,
        }
    }
}

impl Term {
    /// `text`, which reads as `operand`.
    pub fn new(operand: Operand, text: &str, span: Span) -> Term {
        Term { operand, text: text.into(), span, storage: Storage::Own }
    }

    /// The device itself; `span` is empty if it was not read.
    pub fn of_device(device: Device, span: Span) -> Term {
        Term::new(Operand::Device(device), &device.to_smolstr(), span)
    }

    /// The same where it lies as declared in program unit number `pou`.
    pub fn located(self, scopes: &Scopes, pou: Option<usize>) -> Term {
        let storage = match self.operand {
            Operand::Variable => Storage::declared(scopes, pou, &self.text),
            _ => self.storage,
        };
        Term { storage, ..self }
    }

    /// The address that it is a name of, or is; nothing for a part of what lies at one.
    pub fn address(&self) -> Option<DirectAddress> {
        match (self.operand, self.storage) {
            (Operand::Direct(address), _) => Some(address),
            (Operand::Variable, Storage::At(address)) if !self.text.contains(['.', '[', '^']) => {
                Some(address)
            }
            _ => None,
        }
    }

    /// Whether it is a bit by itself, so that writing to it changes nothing else but words that are made of bits.
    /// Setting a state resets others, and the contact of a timer is no bit that a coil writes.
    pub fn is_lone(&self) -> bool {
        match &self.operand {
            Operand::Device(device) => matches!(device.kind, DeviceKind::X | DeviceKind::Y | DeviceKind::M),
            Operand::Direct(address) => address.width == Width::Bit,
            // `T1.Q` and `Bits[2]` are bits by themselves, `Word.3` and `Bits[i]` are not, nor are parts of what lies
            // at an address.
            Operand::Variable => match self.storage {
                Storage::Own | Storage::Local => {
                    let is_part =
                        |(_, last): (&str, &str)| last.starts_with(|c: char| c.is_ascii_digit() || c == '%');
                    let is_part = self.text.rsplit_once('.').is_some_and(is_part);
                    !is_part && !self.text.contains('^') && self.is_fixed()
                }
                Storage::At(_) => self.address().is_some_and(|address| address.width == Width::Bit),
                Storage::Anywhere => false,
            },
            _ => false,
        }
    }

    /// Whether nothing changes it but who writes to it, to what it is a part of, or to something that may be anywhere
    /// in a variable: `Word.3` of a variable in a place of its own.
    pub fn is_own_part(&self) -> bool {
        let is_own = matches!(self.storage, Storage::Own | Storage::Local);
        self.operand == Operand::Variable && is_own && !self.text.contains('^') && self.is_fixed()
    }

    /// Whether it is an element of an array.
    pub fn is_element(&self) -> bool {
        self.operand == Operand::Variable && self.text.contains('[')
    }

    /// Whether all its subscripts are numbers in the one spelling that [`Term::key`] keeps, so that no other key is the
    /// same element.
    pub fn is_fixed(&self) -> bool {
        let subscripts =
            self.text.split('[').skip(1).map(|part| part.split_once(']').map(|(inside, _)| inside));
        let is_plain = |number: &str| number.parse::<i64>().is_ok_and(|value| value.to_string() == number);
        subscripts.into_iter().all(|inside| inside.is_some_and(|inside| inside.split(',').all(is_plain)))
    }

    /// Whether who writes to it may change `other`: the same, or what may lie in the same place, or leads there.
    pub fn may_cover(&self, other: &Term) -> bool {
        let area = |term: &Term| match (term.operand, term.storage) {
            (Operand::Direct(address), _) | (Operand::Variable, Storage::At(address)) => {
                Some(address.location)
            }
            _ => None,
        };
        let is_variable = |term: &Term| matches!(term.operand, Operand::Variable | Operand::Direct(_));
        let is_anywhere = [self, other].iter().any(|term| term.storage == Storage::Anywhere);
        let is_apart = self.is_lone() && other.is_lone();
        let keys = [self.key(), other.key()];
        keys[0] == keys[1]
            || is_variable(self)
                && is_variable(other)
                && (is_within(&keys[0], &keys[1]) || is_within(&keys[1], &keys[0]))
            || is_anywhere && is_variable(self) && is_variable(other)
            || !is_apart && area(self).is_some() && area(self) == area(other)
            || self.devices().iter().any(|(kind, own)| {
                let meets = |(other, theirs): &(DeviceKind, Range<u32>)| {
                    kind == other && own.start < theirs.end && theirs.start < own.end
                };
                other.devices().iter().any(meets)
            })
    }

    /// The devices of the FX family that its value of 16 bits may depend on, by kind and number. One state resets
    /// others, and what an index register leads to may be anything of its kind.
    fn devices(&self) -> Vec<(DeviceKind, Range<u32>)> {
        let all = |kind: DeviceKind| (kind, 0..u32::MAX);
        let indices = || [DeviceKind::V, DeviceKind::Z].map(all).to_vec();
        let with_index = |device: Device| [vec![all(device.kind)], indices()].concat();
        let row =
            |first: Device, count: u32| vec![(first.kind, first.number..first.number.saturating_add(count))];
        match self.operand {
            Operand::Device(device) => match device.kind {
                DeviceKind::V | DeviceKind::Z => indices(),
                DeviceKind::S => vec![all(device.kind)],
                _ => row(device, 1),
            },
            Operand::WordBit { word, .. } => row(word, 1),
            Operand::Nibbles { digits, first, index: None } => row(first, 4 * u32::from(digits)),
            Operand::Indexed { device: first, .. } | Operand::Nibbles { first, .. } => with_index(first),
            Operand::Constant { index: Some(_), .. } => indices(),
            _ => Vec::new(),
        }
    }

    /// The register that it is, or is a bit of: a word that nothing changes but who writes to it, or to a row of
    /// registers that it stands in.
    pub fn register(&self) -> Option<Device> {
        let is_register = |device: &Device| matches!(device.kind, DeviceKind::D | DeviceKind::R);
        match self.operand {
            Operand::Device(device) | Operand::WordBit { word: device, .. } => {
                Some(device).filter(is_register)
            }
            _ => None,
        }
    }

    /// Its value in every scan, if it is a device that has only one.
    pub fn always(&self) -> Option<bool> {
        match self.operand {
            Operand::Device(device) => device.always(),
            _ => None,
        }
    }

    /// What it means, in one spelling: `X10` for `x010`, `K16` for `H10`, names in lower case.
    ///
    /// Names of one address have its spelling.
    pub fn key(&self) -> SmolStr {
        if let Some(address) = self.address() {
            return address.to_smolstr();
        }
        match &self.operand {
            Operand::Device(device) => device.to_smolstr(),
            Operand::Indexed { device, index } => format_smolstr!("{device}{index}"),
            Operand::Nibbles { digits, first, index: None } => {
                format_smolstr!("K{digits}{first}")
            }
            Operand::Nibbles { digits, first, index: Some(index) } => {
                format_smolstr!("K{digits}{first}{index}")
            }
            Operand::WordBit { word, bit } => format_smolstr!("{word}.{bit:x}"),
            Operand::Constant { value: Constant::Decimal(value), index: None } => {
                format_smolstr!("K{value}")
            }
            // A larger pattern is another number in 16 bits than in 32.
            Operand::Constant { value: Constant::Hexadecimal(value), index: None } if *value <= 0x7FFF => {
                format_smolstr!("K{value}")
            }
            Operand::Text => self.text.clone(),
            Operand::Literal(literal) => literal.spelled(&self.text),
            _ => folded(&self.text),
        }
    }
}

/// The keys of what the variable with this key is a part of: `line` and `line[2]` of `line[2].ready`.
pub fn wholes(key: &str) -> impl Iterator<Item = &str> {
    let is_device = key.starts_with(|letter: char| letter.is_ascii_uppercase() || letter == '%');
    key.match_indices(['.', '[']).filter(move |_| !is_device).map(|(at, _)| &key[..at])
}

/// Whether the variable with the key `part` is a part of the one with the key `whole`.
pub fn is_within(part: &str, whole: &str) -> bool {
    wholes(part).any(|own| own == whole)
}

/// Whether a variable is one value that no other program unit has a name for.
fn is_plain(scopes: &Scopes, variable: &Variable) -> bool {
    let is_own = matches!(variable.section, SectionKind::Local | SectionKind::Temporary);
    let is_elementary = match &variable.declared {
        DeclaredType::Elementary(_) => true,
        DeclaredType::Named(_) | DeclaredType::Subrange(..) => {
            matches!(scopes.resolved(variable.declared.clone()), Some(DeclaredType::Elementary(_)))
        }
        _ => false,
    };
    is_own && is_elementary
}

impl PartialEq for Term {
    fn eq(&self, other: &Term) -> bool {
        self.key() == other.key()
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
