//! The shape of a row of the FX instruction table, and the forms in which an instruction is written.

use super::{Accepts, Constant, Device, DeviceKind, Model, Operand, Semantics, instructions};
use crate::text::{self, Book, Language};
use std::borrow::Cow;
use std::fmt;

/// One instruction of the FX family: everything that any room needs to know about it.
#[derive(Clone, Copy, Debug)]
pub struct Instruction {
    /// The plain mnemonic, upper case: `MOV`, `LD=`.
    pub mnemonic: &'static str,
    /// A few words: `move`, `load compare equal`.
    pub title: &'static str,
    /// What it does to the current result and the stacks.
    pub role: Role,
    /// Whether there is a 32-bit form (`DMOV`, `LDD=`).
    pub wide: Wide,
    /// Whether there is a pulse form (`MOVP`), executed only when power arrives.
    pub pulse: bool,
    /// The operands in order.
    pub operands: &'static [OperandSpec],
    /// How many program steps it takes.
    pub steps: Steps,
    /// How it is coded.
    pub opcode: Opcode,
    /// What it does in a scan.
    pub semantics: Semantics,
    /// The models that have it.
    pub models: &'static [Model],
    /// The page: Markdown, one paragraph and a fenced `il` example that checks clean on each of `models`.
    pub page: &'static str,
}

impl Instruction {
    /// The page in `language`; the example is the same in all of them.
    pub fn page_in(&self, language: Language) -> Cow<'static, str> {
        text::page(Book::Instructions, self.mnemonic, self.page, language)
    }

    /// The title in `language`.
    pub fn title_in(&self, language: Language) -> &'static str {
        text::phrase(self.title, language)
    }
}

/// What an instruction does to the current result, the block stack and the branch stack.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Role {
    /// LD family: pushes a new block.
    Load,
    /// AND family: contact in series.
    Series,
    /// OR family: contact in parallel.
    Parallel,
    /// ANB: joins the two upper blocks in series.
    BlockSeries,
    /// ORB: joins the two upper blocks in parallel.
    BlockParallel,
    /// MPS: remembers the current result.
    BranchPush,
    /// MRD: recalls it.
    BranchRead,
    /// MPP: recalls and forgets it.
    BranchPop,
    /// INV, MEP, MEF: changes the current result.
    Modify,
    /// STL: a step contact, which also ends the step before it.
    StepLoad,
    /// Uses the current result and keeps it: OUT, SET, MC, every applied instruction that is driven by contacts.
    Output,
    /// Stands without a current result: END, FEND, NEXT, MCR, RET, EI, NOP …
    Standalone,
}

/// Whether an instruction has a 32-bit form.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Wide {
    /// 16 bit only.
    No,
    /// 16 bit, and 32 bit with `D`.
    Yes,
    /// 32 bit only: the `D` must be written (`DEADD`, `DHSCS`).
    Only,
}

/// How an operand is used.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Access {
    /// Read.
    Read,
    /// Written.
    Write,
    /// Read and written (INC, XCH).
    ReadWrite,
}

/// How an operand that is written gets its value.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Drive {
    /// While the result is on, from the instruction (MOV, INC, CMP); else it keeps what it has.
    Value,
    /// In every scan, the current result itself: OUT, the relay of MC.
    Coil,
    /// In every scan, on for the scan of an edge and else off: PLS, PLF.
    Pulse,
    /// While the result is on it goes on, else it stays: SET.
    Set,
    /// While the result is on it goes off or to 0, else it stays: RST, ZRST.
    Reset,
}

/// How many devices from its own on an operand covers.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Extent {
    /// [`OperandSpec::count`].
    Fixed,
    /// So many times that as the operand at this place says, from 0.
    Counted(u8),
    /// Up to the device that stands at this place, from 0.
    Through(u8),
    /// What follows from several operands or from settings; nobody counts it.
    Onwards,
}

/// One operand of an instruction.
#[derive(Clone, Copy, Debug)]
pub struct OperandSpec {
    /// The manual's name: `S`, `S1`, `D`, `m`, `n`.
    pub name: &'static str,
    /// A few words for signature help: `source`, `number of points`.
    pub meaning: &'static str,
    /// How it is used.
    pub access: Access,
    /// What it takes.
    pub accepts: Accepts,
    /// The limits of an integer constant here, where they are narrower than the register's.
    pub range: Option<(i64, i64)>,
    /// The same for the 32-bit form where it differs from `range` (the bits of a rotation).
    pub wide_range: Option<(i64, i64)>,
    /// How many consecutive devices it covers (`2` for a pair …), where that is fixed and not 1; else 1.
    pub count: u8,
    /// How far it reaches where its own operand does not tell.
    pub extent: Extent,
    /// What becomes of a device that is written here.
    pub drive: Drive,
    /// Whether it may be left out (the preset of OUT, which only timers and counters take).
    pub optional: bool,
}

/// How many steps an instruction takes in program memory; a step is one 16-bit word.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Steps {
    /// Always the same.
    Fixed(u8),
    /// One for the opcode, and for each operand 2 in the 16-bit form and 4 in the 32-bit form.
    ByOperands,
    /// Depends on the device: OUT, SET, RST, contacts of extended relays.
    ByDevice,
}

/// How an instruction is coded; the words are built by the assembler.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Opcode {
    /// A whole word, no operand inside: ANB `FFF8`, END `000F`.
    Word(u16),
    /// The upper four bits of a word whose lower twelve name the bit device: LD `2`.
    /// `extended` is the two-word form's opcode for devices outside those twelve bits, 0 where there is none.
    Contact {
        /// Upper four bits.
        class: u8,
        /// Opcode of the two-word form.
        extended: u16,
    },
    /// The opcode in a word of its own, then a word `8000h` + bits for each operand: LDP `01CA`, PLS `0008`, MC `000A`.
    Device(u16),
    /// One of several codes, by the device: OUT, SET, RST.
    ByDevice(DeviceCodes),
    /// Applied instruction by its function number: `(number + 8) * 2`, +1 for 32 bit, +1000h for pulse.
    Function(u16),
    /// A label, `B000h` + number.
    Label,
    /// The operand is the word itself: a word of program memory that is no instruction.
    Itself,
    /// No source tells; a program with it cannot be assembled.
    Unknown,
}

/// The codes of an instruction that has one for each kind of device.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct DeviceCodes {
    /// Upper four bits of the one-word form, whose lower twelve name an output or one of M0 to M1535.
    pub class: u8,
    /// Before the word of any other auxiliary relay.
    pub relay: u16,
    /// Before the word of a state.
    pub state: u16,
    /// Timers and counters.
    pub counting: Counting,
    /// Before the words of a register, if it takes one.
    pub register: Option<u16>,
}

/// How a timer or a counter is coded behind OUT, SET and RST.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Counting {
    /// Not at all.
    Never,
    /// It is the first word itself, the class being 0, and the words of its preset follow.
    Preset,
    /// By this word and one for the device.
    Reset(u16),
}

/// An instruction in one of its written forms.
#[derive(Clone, Copy)]
pub struct Form {
    /// The row.
    pub instruction: &'static Instruction,
    /// The 32-bit form.
    pub wide: bool,
    /// The pulse form.
    pub pulse: bool,
}

impl Form {
    /// The form written as `mnemonic`, letter case aside. Linear work is done once; a look-up is a hash.
    ///
    /// ```
    /// # use rungwise::target::Form;
    /// assert_eq!(Form::named("ldi").map(|form| form.instruction.mnemonic), Some("LDI"));
    /// ```
    pub fn named(mnemonic: &str) -> Option<Form> {
        instructions::form_named(mnemonic)
    }

    /// As it is written: `DMOVP`, `LDD=`.
    pub fn mnemonic(self) -> String {
        instructions::spelling(self.instruction, self.wide, self.pulse)
    }

    /// Program steps with these operands, of which only the first makes a difference; missing ones count as written.
    pub fn steps(self, operands: &[Operand]) -> u32 {
        instructions::steps(self, operands)
    }

    /// The same contact alone, in series or in parallel: the AND of an LD, the LD of an ORP. Nothing if it is no
    /// contact, or `role` is none of [`Role::Load`], [`Role::Series`], [`Role::Parallel`].
    pub fn placed(self, role: Role) -> Option<Form> {
        instructions::placed(self, role)
    }

    /// Whether operand number `place`, from 0, may be `operand` on `model`. Words that could not be read pass, and a
    /// place that the instruction does not have takes nothing.
    pub fn takes(self, place: usize, operand: &Operand, model: Model) -> bool {
        let Some(spec) = self.instruction.operands.get(place) else {
            return false;
        };
        // Applied instructions can be indexed on every model, basic ones only on the FX3U.
        let indexed = matches!(operand, Operand::Indexed { .. });
        let may_be_indexed = matches!(self.instruction.opcode, Opcode::Function(_)) || model == Model::Fx3u;
        spec.accepts.on(model).takes(operand) && (may_be_indexed || !indexed)
    }

    /// The least and the greatest integer constant that operand number `place` takes; of `operands` the first makes a
    /// difference, since the preset of OUT depends on its device.
    pub fn constant_limits(self, place: usize, operands: &[Operand]) -> (i64, i64) {
        const WORD: (i64, i64) = (i16::MIN as i64, i16::MAX as i64);
        const DOUBLE: (i64, i64) = (i32::MIN as i64, i32::MAX as i64);
        let Some(spec) = self.instruction.operands.get(place) else {
            return WORD;
        };
        if spec.optional {
            let driven = operands.first().and_then(Operand::device);
            let counts_wide = driven.is_some_and(|d| d.kind == DeviceKind::C && d.number >= 200);
            // A preset of 0 is taken for 1, which is not what is written.
            return if counts_wide { DOUBLE } else { (1, WORD.1) };
        }
        let range = if self.wide { spec.wide_range.or(spec.range) } else { spec.range };
        range.unwrap_or(if self.wide { DOUBLE } else { WORD })
    }

    /// Whether `constant` lies within the limits at `place`. A hexadecimal one is a pattern of 16 or 32 bits: `HFFFF`
    /// is -1 in the 16-bit form. Real constants are no matter of limits and fit.
    pub fn constant_fits(self, place: usize, constant: Constant, operands: &[Operand]) -> bool {
        let (least, greatest) = self.constant_limits(place, operands);
        let wide = greatest > i64::from(i16::MAX) || (self.wide && least < 0);
        let value = match constant {
            Constant::Decimal(value) => value,
            Constant::Hexadecimal(bits) => match (u32::try_from(bits), u16::try_from(bits)) {
                (_, Ok(word)) if !wide && least < 0 => i64::from(word as i16),
                (Ok(double), _) if wide && least < 0 => i64::from(double as i32),
                (Ok(double), _) => i64::from(double),
                _ => return false,
            },
            Constant::Real(_) => return true,
        };
        (least..=greatest).contains(&value)
    }

    /// How many devices, or groups of bits, operand number `place` covers from its own on, where `operands` are those
    /// of the instruction; nothing where nobody counts them, or where there is no such operand.
    pub fn covered(self, place: usize, operands: &[Operand]) -> Option<u16> {
        let spec = self.instruction.operands.get(place)?;
        let operand = operands.get(place)?;
        let doubled = self.wide && self.instruction.wide == Wide::Yes;
        let is_register =
            matches!(operand, Operand::Device(Device { kind: DeviceKind::D | DeviceKind::R, .. }));
        let one = u16::from(spec.count).saturating_mul(if doubled && is_register { 2 } else { 1 });
        let at = |place: u8| operands.get(usize::from(place));
        match spec.extent {
            Extent::Fixed => Some(one),
            Extent::Onwards => None,
            Extent::Counted(place) => match at(place)? {
                Operand::Constant { value: Constant::Decimal(times), index: None } => {
                    one.checked_mul(u16::try_from((*times).max(1)).ok()?)
                }
                Operand::Constant { value: Constant::Hexadecimal(times), index: None } => {
                    one.checked_mul(u16::try_from((*times).max(1)).ok()?)
                }
                _ => None,
            },
            Extent::Through(place) => match (operand, at(place)?) {
                (Operand::Device(first), Operand::Device(last)) if first.kind == last.kind => {
                    u16::try_from(last.number.saturating_sub(first.number)).ok()?.checked_add(1)
                }
                _ => None,
            },
        }
    }

    /// Whether `model` has it.
    pub fn is_on(self, model: Model) -> bool {
        self.instruction.models.contains(&model)
    }
}

impl PartialEq for Form {
    fn eq(&self, other: &Form) -> bool {
        self.instruction.mnemonic == other.instruction.mnemonic
            && self.wide == other.wide
            && self.pulse == other.pulse
    }
}

impl fmt::Debug for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.mnemonic())
    }
}
