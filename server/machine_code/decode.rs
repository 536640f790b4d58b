//! From words to instruction list.

use super::codes::{Code, Codes, Shape};
use super::encode::instruction;
use super::{bits, guesses, operands};
use crate::target::instructions::UNREAD;
use crate::target::{Accepts, Constant, Device, DeviceKind, Model, Operand, Target};
use crate::text::Span;
use std::fmt::Write;

/// A program that was read from words.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Listing {
    /// Instruction list in canonical form, a line for each of `lines`.
    pub text: String,
    /// What the lines stand for, in order.
    pub lines: Vec<Listed>,
}

/// A line of a listing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Listed {
    /// The first of its words.
    pub step: u32,
    /// How many there are.
    pub steps: u8,
    /// Where it stands in the text, its line end left out.
    pub span: Span,
    /// Whether it is an instruction or a label, and not a word that is none.
    pub is_read: bool,
}

/// Lists the words of a program for `model`. Never fails: what is no instruction there is a line `NOP? H1234`, and all
/// lines encoded again are the same words.
///
/// ```
/// use rungwise::machine_code::decode;
/// use rungwise::target::Model;
/// assert_eq!(decode(&[0x2400, 0x01FF, 0x000F], Model::Fx2n).text, "LD X0\nNOP? H01FF\nEND\n");
/// ```
pub fn decode(words: &[u16], model: Model) -> Listing {
    let target = Target::of(if model == Model::Iec { Model::Fx2n } else { model });
    let mut decoder = Decoder { target, operands: Vec::new(), text: String::new(), again: Vec::new() };
    let mut listing =
        Listing { text: String::with_capacity(words.len() * 8), lines: Vec::with_capacity(words.len()) };
    let mut step = 0;
    while let Some(rest) = words.get(step..).filter(|rest| !rest.is_empty()) {
        let start = listing.text.len();
        let steps = decoder.instruction(rest, &mut listing.text);
        if steps.is_none() {
            // Writing to a string does not fail.
            let _ = write!(listing.text, "{} H{:04X}", UNREAD.mnemonic, rest[0]);
        }
        let span = Span::new(start, listing.text.len());
        listing.text.push('\n');
        let (is_read, steps) = (steps.is_some(), steps.unwrap_or(1));
        listing.lines.push(Listed { step: step as u32, steps: steps as u8, span, is_read });
        step += steps;
    }
    listing
}

struct Decoder {
    target: &'static Target,
    operands: Vec<Operand>,
    /// The text among the operands.
    text: String,
    /// The words that are made of what was read.
    again: Vec<u16>,
}

impl Decoder {
    /// Writes the instruction at the beginning of `words`; how many of them it takes.
    fn instruction(&mut self, words: &[u16], to: &mut String) -> Option<usize> {
        let code = Codes::of(words[0])?;
        self.read(code, words)?;
        self.again.clear();
        instruction(code.form, &self.operands, &self.text, self.target, &mut self.again).ok()?;
        words.starts_with(&self.again).then(|| self.write(code, to))?;
        Some(self.again.len())
    }

    /// Reads the operands, which need not be right yet.
    fn read(&mut self, code: &Code, words: &[u16]) -> Option<()> {
        self.operands.clear();
        self.text.clear();
        let first = words[0];
        let specs = code.form.instruction.operands;
        match code.shape {
            Shape::Alone => {}
            Shape::Inside => self.operands.push(Operand::Device(bits::device(first & 0xFFF)?)),
            Shape::Label => {
                let (kind, number) = match first.checked_sub(guesses::INTERRUPT_LABEL) {
                    Some(number) => (DeviceKind::I, number),
                    None => (DeviceKind::P, first & 0xFFF),
                };
                self.operands.push(Operand::Device(Device::new(kind, u32::from(number))));
            }
            Shape::Words => {
                // OUT has a second operand that is never a word.
                for (spec, word) in specs.iter().filter(|spec| !spec.optional).zip(words.get(1..)?) {
                    let number = word.checked_sub(0x8000)?;
                    let device = match spec.accepts == Accepts::N {
                        true => Device::new(DeviceKind::N, u32::from(number)),
                        false => bits::device(number)?,
                    };
                    self.operands.push(Operand::Device(device));
                }
            }
            Shape::Preset => {
                let device = bits::device(first)?;
                let is_wide = device.range_on(self.target)?.bits == 32;
                self.operands.push(Operand::Device(device));
                self.operands.push(operands::read(words.get(1..)?, is_wide)?);
            }
            Shape::Operands => {
                let mut place = 1;
                for spec in specs {
                    let rest = words.get(place..)?;
                    if spec.accepts == Accepts::TEXT {
                        place += guesses::TEXT_WORDS;
                        let characters = rest.get(..guesses::TEXT_WORDS)?;
                        self.text.extend(characters.iter().map(|word| char::from(*word as u8)));
                        self.operands.push(Operand::Text);
                        // It is written in these.
                        self.text.find('"').is_none().then_some(())?;
                    } else {
                        place += if code.form.wide { 4 } else { 2 };
                        self.operands.push(operands::read(rest, code.form.wide)?);
                    }
                }
            }
        }
        Some(())
    }

    fn write(&self, code: &Code, to: &mut String) {
        let is_label = code.shape == Shape::Label;
        if !is_label {
            to.push_str(&code.mnemonic);
        }
        for (place, operand) in self.operands.iter().enumerate() {
            if place > 0 || !is_label {
                to.push(' ');
            }
            // Writing to a string does not fail.
            let _ = match *operand {
                Operand::Device(device) => write!(to, "{device}"),
                Operand::Indexed { device, index } => write!(to, "{device}{index}"),
                Operand::Nibbles { digits, first, index: None } => write!(to, "K{digits}{first}"),
                Operand::Nibbles { digits, first, index: Some(index) } => {
                    write!(to, "K{digits}{first}{index}")
                }
                Operand::Constant { value: Constant::Decimal(value), .. } => write!(to, "K{value}"),
                Operand::Constant { value: Constant::Hexadecimal(value), .. } => write!(to, "H{value:X}"),
                _ => write!(to, "\"{}\"", self.text),
            };
        }
    }
}
