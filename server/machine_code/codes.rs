//! The first words of instructions, for looking them up.

use crate::target::instructions::{self, LABEL};
use crate::target::{Counting, Form, Opcode};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// An instruction that a first word stands for.
#[derive(Clone, Debug)]
pub struct Code {
    /// Its row and form.
    pub form: Form,
    /// As it is written, for that costs more than to look it up.
    pub mnemonic: String,
    /// Where its operands are.
    pub shape: Shape,
}

/// Where the operands of an instruction are in its words.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shape {
    /// There are none.
    Alone,
    /// A bit device in the lower twelve bits of the first word.
    Inside,
    /// Nesting levels and bit devices in a word each.
    Words,
    /// In two words each, or in four in the 32-bit form.
    Operands,
    /// The first word is a timer or a counter, and the words of the preset follow.
    Preset,
    /// A pointer in the lower twelve bits.
    Label,
}

/// All first words.
pub struct Codes {
    whole: FxHashMap<u16, Code>,
    /// By the upper four bits, for words that are not in `whole`.
    classes: [Option<Code>; 16],
}

impl Codes {
    /// The instruction that begins with `word`, on whatever model.
    pub fn of(word: u16) -> Option<&'static Code> {
        CODES.whole.get(&word).or_else(|| CODES.classes.get(usize::from(word >> 12))?.as_ref())
    }

    fn add(&mut self, form: Form, word: u16, shape: Shape) {
        self.whole.insert(word, Code { form, mnemonic: form.mnemonic(), shape });
    }

    fn add_class(&mut self, form: Form, class: u8, shape: Shape) {
        if let Some(place) = self.classes.get_mut(usize::from(class)) {
            *place = Some(Code { form, mnemonic: form.mnemonic(), shape });
        }
    }

    fn add_form(&mut self, form: Form) {
        match form.instruction.opcode {
            Opcode::Word(word) => self.add(form, word, Shape::Alone),
            Opcode::Contact { class, extended } => {
                self.add_class(form, class, Shape::Inside);
                if extended != 0 {
                    self.add(form, extended, Shape::Words);
                }
            }
            Opcode::Device(word) => self.add(form, word, Shape::Words),
            Opcode::ByDevice(codes) => {
                self.add_class(form, codes.class, Shape::Inside);
                self.add(form, codes.relay, Shape::Words);
                self.add(form, codes.state, Shape::Words);
                match codes.counting {
                    Counting::Never => {}
                    Counting::Preset => self.add_class(form, 0, Shape::Preset),
                    Counting::Reset(word) => self.add(form, word, Shape::Words),
                }
                if let Some(word) = codes.register {
                    self.add(form, word, Shape::Operands);
                }
            }
            Opcode::Function(_) => {
                if let Some(word) = function(form) {
                    self.add(form, word, Shape::Operands);
                }
            }
            Opcode::Label => self.add_class(form, 0xB, Shape::Label),
            Opcode::Itself | Opcode::Unknown => {}
        }
    }
}

/// The opcode of an applied instruction: twice its function number from 8 on, then a bit for 32 bits and one for the
/// pulse form.
pub fn function(form: Form) -> Option<u16> {
    let Opcode::Function(number) = form.instruction.opcode else { return None };
    Some((number + 8) * 2 + u16::from(form.wide) + if form.pulse { 0x1000 } else { 0 })
}

/// As a form, for rows that are not found by a name.
pub fn plain(instruction: &'static crate::target::Instruction) -> Form {
    Form { instruction, wide: false, pulse: false }
}

static CODES: LazyLock<Codes> = LazyLock::new(|| {
    let mut codes = Codes { whole: FxHashMap::default(), classes: Default::default() };
    for form in instructions::all().flat_map(instructions::forms_of).chain([plain(&LABEL)]) {
        codes.add_form(form);
    }
    codes
});
