//! From instruction list to words.

use super::codes::{function, plain};
use super::obstacle::Obstacle;
use super::operands::{self, Uncoded};
use super::{bits, guesses};
use crate::il::fx::{self, FxLine, FxTree, LineKind};
use crate::target::instructions::LABEL;
use crate::target::{
    Accepts, Constant, Counting, Device, DeviceCodes, DeviceKind, Form, Model, Opcode, Operand, Target,
};
use crate::text::{Diagnostic, Message, Span};

/// The code of findings about what has no machine code.
pub const NO_MACHINE_CODE: &str = "no-machine-code";

/// A program as it lies in the memory of a PLC; word n is step n.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Program {
    /// The words.
    pub words: Vec<u16>,
    /// Which words each instruction of the source became, in order.
    pub lines: Vec<Line>,
}

/// The words of an instruction or a label.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Line {
    /// The first of its steps.
    pub step: u32,
    /// How many there are.
    pub steps: u8,
    /// Where it stands in the source.
    pub span: Span,
}

impl Program {
    /// The words of one of its lines.
    pub fn words_of(&self, line: &Line) -> &[u16] {
        let start = line.step as usize;
        self.words.get(start..start + usize::from(line.steps)).unwrap_or_default()
    }

    /// The line to which a step belongs.
    pub fn line_of_step(&self, step: u32) -> Option<&Line> {
        let after = self.lines.partition_point(|line| line.step <= step);
        let line = self.lines.get(after.checked_sub(1)?)?;
        (step < line.step + u32::from(line.steps)).then_some(line)
    }

    /// Puts `other` behind it; its lines keep the places in their own source.
    pub fn append(&mut self, other: &Program) {
        let steps = self.words.len() as u32;
        self.words.extend_from_slice(&other.words);
        self.lines.extend(other.lines.iter().map(|line| Line { step: line.step + steps, ..*line }));
    }
}

/// Encodes an instruction list of the FX family.
///
/// ```
/// use rungwise::machine_code::encode;
/// use rungwise::target::{Model, Target};
/// let program = encode("LD X0\nOUT T1 K15\nEND\n", Target::of(Model::Fx2n)).unwrap();
/// assert_eq!(program.words, [0x2400, 0x0601, 0x800F, 0x8000, 0x000F]);
/// ```
///
/// # Errors
/// Everything that has no machine code on this model, or cannot be read, at its place.
pub fn encode(list: &str, target: &Target) -> Result<Program, Vec<Diagnostic>> {
    let mut encoder = Encoder::new(target);
    let mut start = 0;
    for end in fx::split(list) {
        let chunk = list.get(start..end).unwrap_or_default();
        encoder.chunk(chunk, &fx::parse(chunk, target), start);
        start = end;
    }
    encoder.finish()
}

/// Encodes a program chunk by chunk.
pub struct Encoder<'t> {
    target: &'t Target,
    program: Program,
    problems: Vec<Diagnostic>,
    operands: Vec<Operand>,
}

impl<'t> Encoder<'t> {
    /// For this model and with the names of its project; an FX2N where it is none of the family.
    pub fn new(target: &'t Target) -> Encoder<'t> {
        let target = if target.is_fx() { target } else { Target::of(Model::Fx2n) };
        Encoder { target, program: Program::default(), problems: Vec::new(), operands: Vec::new() }
    }

    /// Encodes a chunk that begins at `start` of the source.
    pub fn chunk(&mut self, text: &str, tree: &FxTree, start: usize) {
        self.problems.extend(tree.problems.iter().map(|problem| problem.shifted(start)));
        for line in &tree.lines {
            if let Err(problem) = self.line(text, tree, line, start) {
                self.problems.push(problem.shifted(start));
            }
        }
    }

    /// The program.
    ///
    /// # Errors
    /// With what could not be encoded, in the order of the source.
    pub fn finish(mut self) -> Result<Program, Vec<Diagnostic>> {
        let most = self.target.limits.steps_at_most;
        let first_over = self.program.lines.iter().find(|line| line.step + u32::from(line.steps) > most);
        if let Some(line) = first_over.filter(|_| self.problems.is_empty()) {
            let message = Message::new("machine-code.too-many-steps")
                .with("steps", self.program.words.len())
                .with("target", self.target.title)
                .with("most", most);
            self.problems.push(Diagnostic::new(NO_MACHINE_CODE, line.span, message));
        }
        self.problems.sort_by_key(|problem| problem.span);
        if self.problems.is_empty() { Ok(self.program) } else { Err(self.problems) }
    }

    fn line(&mut self, text: &str, tree: &FxTree, line: &FxLine, start: usize) -> Result<(), Diagnostic> {
        let operands = tree.operands(line);
        self.operands.clear();
        let form = match line.kind {
            LineKind::Instruction(form) => form,
            LineKind::Label(label) => {
                self.operands.push(Operand::Device(label));
                plain(&LABEL)
            }
            LineKind::Unknown => {
                let word = line.mnemonic.of(text);
                let message = Message::new("machine-code.unknown-instruction").with("word", word);
                return Err(Diagnostic::new(NO_MACHINE_CODE, line.mnemonic, message));
            }
        };
        self.operands.extend(operands.iter().map(|operand| operand.value));
        let quoted = operands.iter().find(|operand| operand.value == Operand::Text);
        let quoted = quoted.map_or("", |operand| operand.span.of(text));
        let step = self.program.words.len();
        if let Err(obstacle) =
            instruction(form, &self.operands, unquoted(quoted), self.target, &mut self.program.words)
        {
            self.program.words.truncate(step);
            let (span, word) = match obstacle {
                // The operand of a label is the label itself.
                Obstacle::Operand(place, _) => {
                    let span = operands.get(place).map_or(line.mnemonic, |operand| operand.span);
                    (span, span.of(text))
                }
                Obstacle::NotOnModel | Obstacle::Unknown => (line.mnemonic, line.mnemonic.of(text)),
                Obstacle::OperandCount => (line.span, line.span.of(text)),
            };
            let message = obstacle.message(form, word, self.target);
            return Err(Diagnostic::new(NO_MACHINE_CODE, span, message));
        }
        let steps = (self.program.words.len() - step) as u8;
        self.program.lines.push(Line { step: step as u32, steps, span: line.span.shifted(start) });
        Ok(())
    }
}

/// A text without its quotes, if it has any.
fn unquoted(word: &str) -> &str {
    ['"', '\''].iter().find_map(|quote| word.strip_prefix(*quote)?.strip_suffix(*quote)).unwrap_or(word)
}

/// Appends the words of an instruction with these operands; `text` is what stands for a text among them.
///
/// # Errors
/// With the reason why there are none; some may have been appended then.
pub(super) fn instruction(
    form: Form,
    operands: &[Operand],
    text: &str,
    target: &Target,
    words: &mut Vec<u16>,
) -> Result<(), Obstacle> {
    if !form.is_on(target.model) {
        return Err(Obstacle::NotOnModel);
    }
    let specs = form.instruction.operands;
    let least = specs.iter().filter(|spec| !spec.optional).count();
    if operands.len() < least || operands.len() > specs.len() {
        return Err(Obstacle::OperandCount);
    }
    let is_basic = !matches!(form.instruction.opcode, Opcode::Function(_));
    for (place, operand) in operands.iter().enumerate().filter(|_| is_basic) {
        // Basic instructions have no room for other operands; what the applied ones take is a matter of the rules.
        if !form.takes(place, operand, target.model) {
            return Err(Obstacle::Operand(place, Uncoded::NotTaken));
        }
    }
    let first = || operands.first().ok_or(Obstacle::OperandCount);
    match form.instruction.opcode {
        Opcode::Word(word) => words.push(word),
        Opcode::Contact { class, extended } => {
            let number = bit(first()?, target).map_err(at(0))?;
            match bits::is_short(number) {
                true => words.push(u16::from(class) << 12 | number),
                false if extended != 0 => words.extend([extended, 0x8000 | number]),
                false => return Err(Obstacle::Operand(0, Uncoded::Unknown)),
            }
        }
        Opcode::Device(word) => {
            words.push(word);
            for (place, operand) in operands.iter().enumerate() {
                words.push(0x8000 | level_or_bit(operand, target).map_err(at(place))?);
            }
        }
        Opcode::ByDevice(codes) => output(codes, operands, target, words)?,
        Opcode::Function(_) => {
            words.extend(function(form));
            for (place, (operand, spec)) in operands.iter().zip(specs).enumerate() {
                match spec.accepts == Accepts::TEXT {
                    true => characters(operand, text, words).map_err(at(place))?,
                    false => operands::write(operand, form.wide, target, words).map_err(at(place))?,
                }
            }
        }
        Opcode::Label => words.push(label(first()?, target).map_err(at(0))?),
        Opcode::Itself => words.push(itself(first()?).ok_or(Obstacle::Operand(0, Uncoded::TooLarge(16)))?),
        Opcode::Unknown => return Err(Obstacle::Unknown),
    }
    Ok(())
}

fn at(place: usize) -> impl Fn(Uncoded) -> Obstacle {
    move |uncoded| Obstacle::Operand(place, uncoded)
}

/// OUT, SET and RST, which have a code for each kind of device.
fn output(
    codes: DeviceCodes,
    operands: &[Operand],
    target: &Target,
    words: &mut Vec<u16>,
) -> Result<(), Obstacle> {
    let (operand, preset) = match operands {
        [operand] => (operand, None),
        [operand, preset] => (operand, Some(preset)),
        _ => return Err(Obstacle::OperandCount),
    };
    let device = device(operand, target).map_err(at(0))?;
    let counts = device.kind.has_preset() && codes.counting == Counting::Preset;
    if counts != preset.is_some() {
        return Err(Obstacle::OperandCount);
    }
    if let (Some(word), true) = (codes.register, is_register(device)) {
        words.push(word);
        return operands::write(operand, false, target, words).map_err(at(0));
    }
    let number = bits::number(device).ok_or(Obstacle::Operand(0, Uncoded::Unknown))?;
    let code = match (device.kind, codes.counting) {
        (DeviceKind::T | DeviceKind::C, Counting::Preset) => {
            words.push(number);
            let is_wide = device.range_on(target).is_some_and(|range| range.bits == 32);
            let preset = preset.ok_or(Obstacle::OperandCount)?;
            return operands::write(preset, is_wide, target, words).map_err(at(1));
        }
        (DeviceKind::T | DeviceKind::C, Counting::Reset(word)) => word,
        (DeviceKind::S, _) => codes.state,
        (DeviceKind::M, _) if device.is_special() || !bits::is_short(number) => codes.relay,
        (DeviceKind::Y | DeviceKind::M, _) => {
            words.push(u16::from(codes.class) << 12 | number);
            return Ok(());
        }
        _ => return Err(Obstacle::Operand(0, Uncoded::NotTaken)),
    };
    words.extend([code, 0x8000 | number]);
    Ok(())
}

fn is_register(device: Device) -> bool {
    device.kind.is_word() && !device.kind.is_bit()
}

/// A device of the model, without an index register.
fn device(operand: &Operand, target: &Target) -> Result<Device, Uncoded> {
    match operand {
        Operand::Device(device) if device.range_on(target).is_some() => Ok(*device),
        Operand::Device(_) => Err(Uncoded::NoDevice),
        // An FX3U takes both in basic instructions.
        Operand::Indexed { .. } | Operand::WordBit { .. } => Err(Uncoded::Unknown),
        _ => Err(Uncoded::Unreadable),
    }
}

fn bit(operand: &Operand, target: &Target) -> Result<u16, Uncoded> {
    bits::number(device(operand, target)?).ok_or(Uncoded::Unknown)
}

fn level_or_bit(operand: &Operand, target: &Target) -> Result<u16, Uncoded> {
    match device(operand, target)? {
        Device { kind: DeviceKind::N, number } => Ok(number as u16),
        _ => bit(operand, target),
    }
}

fn label(operand: &Operand, target: &Target) -> Result<u16, Uncoded> {
    const FIRST: u16 = 0xB000;
    match device(operand, target)? {
        Device { kind: DeviceKind::P, number: number @ 0..=operands::LAST_POINTER } => {
            Ok(FIRST + number as u16)
        }
        Device { kind: DeviceKind::I, number } => Ok(guesses::INTERRUPT_LABEL + number as u16),
        _ => Err(Uncoded::Unknown),
    }
}

/// The word that `NOP?` has as its operand.
fn itself(operand: &Operand) -> Option<u16> {
    match operand {
        Operand::Constant { value: Constant::Hexadecimal(value), index: None } => u16::try_from(*value).ok(),
        Operand::Constant { value: Constant::Decimal(value), index: None } => u16::try_from(*value).ok(),
        _ => None,
    }
}

fn characters(operand: &Operand, text: &str, words: &mut Vec<u16>) -> Result<(), Uncoded> {
    if *operand != Operand::Text {
        return Err(Uncoded::NotTaken);
    }
    if text.len() > guesses::TEXT_WORDS || !text.bytes().all(|byte| (b' '..=b'~').contains(&byte)) {
        return Err(Uncoded::Text);
    }
    let filled = text.bytes().chain(std::iter::repeat(guesses::FILL)).take(guesses::TEXT_WORDS);
    words.extend(filled.map(|byte| guesses::CHARACTER | u16::from(byte)));
    Ok(())
}
