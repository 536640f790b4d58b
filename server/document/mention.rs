//! What a chunk names: the ground for references, rename, hover, usage and the rules about whole programs.

use super::{Chunk, Operation, Tree};
use crate::il::fx::LineKind;
use crate::ladder::{Element, ElementKind, LadderTree};
use crate::target::{Access, Device, DeviceKind, DirectAddress, Model, Operand};
use crate::text::{Span, folded};
use smol_str::SmolStr;

/// A name at a place.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Mention {
    /// What is named.
    pub symbol: Symbol,
    /// The cells of the name alone, without member, subscript or index. Offsets are those of the chunk.
    pub span: Span,
    /// What is done with it.
    pub usage: Use,
    /// How many consecutive devices are meant: 16 for `K4M0`, 2 for a 32-bit register, else 1.
    pub count: u16,
}

/// Something that has a name. Names are folded to lower case, as case has no meaning in either language.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Symbol {
    /// A device of the PLC; pointers P and I too, which are labels.
    Device(Device),
    /// `%IX0.0`
    Direct(DirectAddress),
    /// An IEC variable or instance.
    Variable(SmolStr),
    /// An IEC label, or the label of a ladder network.
    Label(SmolStr),
    /// A program, function block or function, declared or standard.
    Pou(SmolStr),
    /// A data type.
    Type(SmolStr),
    /// A connector between ladder rungs.
    Connector(SmolStr),
}

/// What is done with a symbol.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Use {
    /// Its value is read.
    Read,
    /// Its value is written.
    Write,
    /// Its value is read and written.
    ReadWrite,
    /// It is declared, or this is where a label stands.
    Declare,
    /// A jump or call goes there.
    Jump,
}

impl Use {
    /// Whether the value is read.
    pub fn reads(self) -> bool {
        matches!(self, Use::Read | Use::ReadWrite)
    }

    /// Whether the value is written.
    pub fn writes(self) -> bool {
        matches!(self, Use::Write | Use::ReadWrite)
    }
}

impl Symbol {
    /// The variable called `name`.
    pub fn variable(name: &str) -> Symbol {
        Symbol::Variable(folded(name))
    }

    /// The label called `name`: a pointer of the PLC where it reads as one, as in FX programs, else an IEC label.
    pub fn label(name: &str) -> Symbol {
        match Operand::read(name, Model::Fx3u) {
            Operand::Device(device) if device.kind.is_pointer() => Symbol::Device(device),
            _ => Symbol::Label(folded(name)),
        }
    }
}

pub(super) fn of_chunk(chunk: &Chunk) -> Vec<Mention> {
    let mut mentions = Vec::new();
    match chunk.tree() {
        Tree::Fx(tree) => {
            for line in &tree.lines {
                if let LineKind::Label(device) = line.kind {
                    mentions.push(one(Symbol::Device(device), line.mnemonic, Use::Declare));
                }
            }
        }
        Tree::Ladder(tree) => {
            of_ladder(chunk.text(), tree, &mut mentions);
            for (start, list) in chunk.boxes() {
                let moved = |own: &Mention| Mention { span: own.span.shifted(*start), ..own.clone() };
                mentions.extend(list.mentions().iter().map(moved));
            }
        }
        Tree::Iec(tree) => super::scope::mentions(chunk.text(), tree, &mut mentions),
    }
    for operation in chunk.operations() {
        of_operation(chunk.text(), &operation, &mut mentions);
    }
    mentions.sort_by_key(|mention| mention.span);
    mentions
}

fn one(symbol: Symbol, span: Span, usage: Use) -> Mention {
    Mention { symbol, span, usage, count: 1 }
}

fn of_operation(text: &str, operation: &Operation<'_>, mentions: &mut Vec<Mention>) {
    let specs = operation.form.map_or(&[][..], |form| form.instruction.operands);
    let wide = operation.form.is_some_and(|form| form.wide);
    for (position, operand) in operation.operands.iter().enumerate() {
        let spec = specs.get(position);
        let usage = match spec.map_or(Access::Read, |spec| spec.access) {
            Access::Read => Use::Read,
            Access::Write => Use::Write,
            Access::ReadWrite => Use::ReadWrite,
        };
        of_operand(text, &operand.value, operand.span, usage, mentions);
        let fixed = spec.map_or(1, |spec| u16::from(spec.count));
        if let (Some(mention), Operand::Device(device)) = (mentions.last_mut(), operand.value) {
            let pair = wide && matches!(device.kind, DeviceKind::D | DeviceKind::R);
            mention.count = mention.count.max(fixed).max(if pair { 2 } else { 1 });
        }
    }
    if let Some(element) = operation.element.filter(|element| element.name_lines.len() > 1) {
        of_name_lines(text, element, mentions);
    }
}

/// A name over several lines is one name, which each of its lines mentions.
fn of_name_lines(text: &str, element: &Element, mentions: &mut Vec<Mention>) {
    let name = element.operand_text(0, text);
    let root = name.split(['.', '[', '^']).next().unwrap_or_default();
    let own =
        |mention: &&mut Mention| Some(&mention.span.end) == element.name_lines.last().map(|line| &line.end);
    let Some(mention) = mentions.iter_mut().rev().find(own) else { return };
    mention.symbol = Symbol::variable(root);
    let (symbol, usage) = (mention.symbol.clone(), mention.usage);
    let upper = element.name_lines.iter().rev().skip(1);
    mentions.extend(upper.map(|line| one(symbol.clone(), *line, usage)));
}

/// The mentions in one operand; `usage` is that of its base, index registers are read.
pub(super) fn of_operand(text: &str, operand: &Operand, span: Span, usage: Use, mentions: &mut Vec<Mention>) {
    let usage_of = |device: Device| match device.kind {
        DeviceKind::P | DeviceKind::I => Use::Jump,
        _ => usage,
    };
    let (base, index_span) = device_spans(text, operand, span);
    let index_read = |index: Device| one(Symbol::Device(index), index_span, Use::Read);
    match *operand {
        Operand::Device(device) => mentions.push(one(Symbol::Device(device), base, usage_of(device))),
        Operand::Indexed { device, index } => {
            mentions.push(index_read(index));
            mentions.push(one(Symbol::Device(device), base, usage_of(device)));
        }
        Operand::Nibbles { digits, first, index } => {
            mentions.extend(index.map(index_read));
            mentions
                .push(Mention { count: u16::from(digits) * 4, ..one(Symbol::Device(first), base, usage) });
        }
        Operand::WordBit { word, .. } => mentions.push(one(Symbol::Device(word), base, usage)),
        Operand::Direct(address) => mentions.push(one(Symbol::Direct(address), span, usage)),
        Operand::Variable => {
            let root = root_of(text, span);
            mentions.push(one(Symbol::variable(root.of(text)), root, usage));
        }
        Operand::Constant { index, .. } => mentions.extend(index.map(index_read)),
        Operand::Literal(_) | Operand::Text | Operand::Invalid(_) => {}
    }
}

/// The cells of the device itself (`M0` in `K4M0Z1`, `D0` in `D0.3`), and those of its index register.
fn device_spans(text: &str, operand: &Operand, span: Span) -> (Span, Span) {
    let word = span.of(text);
    let at = |start: usize, end: usize| Span::new(span.start as usize + start, span.start as usize + end);
    let index = match operand {
        Operand::Indexed { .. }
        | Operand::Nibbles { index: Some(_), .. }
        | Operand::Constant { index: Some(_), .. } => word.rfind(['V', 'v', 'Z', 'z']),
        Operand::WordBit { .. } => word.find('.'),
        _ => None,
    };
    let end = index.unwrap_or(word.len());
    let start = match operand {
        // Behind `K4` stands a device or its symbol.
        Operand::Nibbles { .. } => {
            let digits = word.bytes().skip(1).take_while(u8::is_ascii_digit).count();
            (1 + digits).min(end)
        }
        _ => 0,
    };
    (at(start, end), at(end, word.len()))
}

/// The first identifier of a path such as `T1.Q` or `a[3].b`.
fn root_of(text: &str, span: Span) -> Span {
    let path = span.of(text);
    let end = path.find(['.', '[', '^']).unwrap_or(path.len());
    Span { start: span.start, end: span.start + end as u32 }
}

fn of_ladder(text: &str, tree: &LadderTree, mentions: &mut Vec<Mention>) {
    if let Some(label) = tree.header.as_ref().and_then(|header| header.label) {
        mentions.push(one(Symbol::label(label.of(text)), label, Use::Declare));
    }
    for element in tree.rungs.iter().flat_map(|rung| &rung.graph.elements) {
        match &element.kind {
            ElementKind::Jump(label) => mentions.push(one(Symbol::label(label.of(text)), *label, Use::Jump)),
            ElementKind::ConnectorOut(name) => {
                mentions.push(one(Symbol::Connector(folded(name.of(text))), *name, Use::Write));
            }
            ElementKind::ConnectorIn(name) => {
                mentions.push(one(Symbol::Connector(folded(name.of(text))), *name, Use::Read));
            }
            ElementKind::Block(block) => {
                if let Some(instance) = block.instance {
                    // An element of an array of instances is a use of the array.
                    let root = root_of(text, instance);
                    mentions.push(one(Symbol::variable(root.of(text)), root, Use::ReadWrite));
                }
                if let Some(name) = block.type_name {
                    mentions.push(one(
                        Symbol::Pou(folded(block.type_text(text).unwrap_or(""))),
                        name,
                        Use::Read,
                    ));
                }
                let outputs = block.outputs.iter().filter_map(|pin| match pin.wire {
                    crate::ladder::PinWire::Operand(index) => Some(index),
                    _ => None,
                });
                let outputs: Vec<usize> = outputs.collect();
                for (index, operand) in element.operands.iter().enumerate() {
                    let usage = if outputs.contains(&index) { Use::Write } else { Use::Read };
                    of_operand(text, &operand.value, operand.span, usage, mentions);
                }
            }
            _ => {}
        }
    }
}
