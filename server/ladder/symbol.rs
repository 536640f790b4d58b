//! What is drawn for one element: its symbol on the wire row and the words above it.

use super::printer::StyleKind;
use super::{Block, CoilKind, ContactKind, Element, ElementKind, Pin, PinWire};
use crate::text::text_width;

/// The drawing of one element, before it has a place.
#[derive(Clone, Debug)]
pub(super) struct Symbol {
    /// Words above, top to bottom.
    pub above: Vec<String>,
    /// What stands on the wire row; empty for a function block.
    pub body: String,
    /// How it is set on its wire.
    pub setting: Setting,
    /// The box of a function block.
    pub figure: Option<Figure>,
}

/// How a symbol is set on its wire.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Setting {
    /// A contact, or a coil in the middle of a rung: those of a column stand under each other.
    Aligned,
    /// A coil: at the right rail if it is the last of its line, else as a contact.
    Coil,
    /// A box with its words inside: at the left of its column. The flag tells outputs, whose line ends with them.
    Boxed { output: bool },
    /// A jump, return or outgoing connector: ends its line before the right rail.
    Sink,
    /// An incoming connector: starts a line without a wire to the left rail.
    Source,
}

/// The words of a function block. Pins are numbered as in the element.
#[derive(Clone, Debug)]
pub(super) struct Figure {
    pub type_name: String,
    pub inputs: Vec<FigurePin>,
    pub outputs: Vec<FigurePin>,
}

/// The words of a pin.
#[derive(Clone, Debug)]
pub(super) struct FigurePin {
    pub name: String,
    pub negated: bool,
    /// Whether a power line is wired to it.
    pub power: bool,
    /// The operand beside it; empty if there is none.
    pub operand: String,
}

impl Symbol {
    /// The symbol of `element`, whose words stand in `source`. Nothing if a word is missing that it must have.
    pub fn of(element: &Element, source: &str, style: StyleKind) -> Option<Symbol> {
        let words: Vec<String> = (0..element.operands.len())
            .map(|index| element.operand_text(index, source).into_owned())
            .collect();
        // A word of several lines has no place in a drawing, and an empty one would be read as another element.
        if words.iter().any(|word| word.is_empty() || word.contains(['\n', '\r', '\t'])) {
            return None;
        }
        let mut symbol = match &element.kind {
            ElementKind::Contact(kind) => contact(*kind, &words, style)?,
            ElementKind::Coil(kind) => coil(*kind, &words, style)?,
            ElementKind::Compare(operator) => {
                let [left, right] = words.as_slice() else { return None };
                let wide = if operator.is_wide() { "D" } else { "" };
                boxed(format!("[{wide}{} {left} {right}]", operator.sign()), false)
            }
            ElementKind::Invert => boxed("[INV]".to_string(), false),
            ElementKind::Instruction { mnemonic, .. } => {
                let mut content = vec![word(mnemonic.of(source))?];
                content.extend(words);
                boxed(format!("[{}]", content.join(" ")), element.is_output())
            }
            ElementKind::Block(block) => return figure(block, &words, element, source),
            ElementKind::Jump(label) => set(Setting::Sink, format!(">>{}", word(label.of(source))?)),
            ElementKind::Return => set(Setting::Sink, "<RETURN>".to_string()),
            ElementKind::ConnectorOut(name) => set(Setting::Sink, format!(">{}>", word(name.of(source))?)),
            ElementKind::ConnectorIn(name) => set(Setting::Source, format!(">{}>", word(name.of(source))?)),
        };
        add_notes(&mut symbol, element, source);
        Some(symbol)
    }

    /// Displayed cells of the widest line above.
    pub fn name_width(&self) -> usize {
        self.above.iter().map(|line| text_width(line)).max().unwrap_or(0)
    }
}

fn word(text: &str) -> Option<String> {
    let readable = !text.is_empty() && !text.contains(['\n', '\r', '\t']);
    readable.then(|| text.to_string())
}

fn set(setting: Setting, body: String) -> Symbol {
    Symbol { above: Vec::new(), body, setting, figure: None }
}

fn boxed(body: String, output: bool) -> Symbol {
    set(Setting::Boxed { output }, body)
}

/// Descriptions stay where they were drawn most often: over the name.
fn add_notes(symbol: &mut Symbol, element: &Element, source: &str) {
    let notes: Vec<String> = element.notes.iter().map(|note| note.of(source).to_string()).collect();
    symbol.above.splice(0..0, notes);
}

fn contact(kind: ContactKind, words: &[String], style: StyleKind) -> Option<Symbol> {
    let [name] = words else { return None };
    let mark = kind.mark();
    let body = match (style, mark) {
        (StyleKind::Iec, _) => format!("|{mark}|"),
        (StyleKind::Unicode, _) => format!("┤{mark}├"),
        (StyleKind::Brackets, ' ') => return Some(boxed(format!("[{name}]"), false)),
        (StyleKind::Brackets, '/') => return Some(boxed(format!("[/{name}]"), false)),
        (StyleKind::Brackets, _) => return Some(boxed(format!("[{mark} {name}]"), false)),
    };
    Some(Symbol { above: vec![name.clone()], ..set(Setting::Aligned, body) })
}

fn coil(kind: CoilKind, words: &[String], style: StyleKind) -> Option<Symbol> {
    if words.is_empty() {
        return None;
    }
    let name = words.join(" ");
    let mark = kind.mark();
    Some(match (style, mark) {
        (StyleKind::Brackets, ' ') => set(Setting::Coil, format!("({name})")),
        (StyleKind::Brackets, '/') => set(Setting::Coil, format!("(/{name})")),
        (StyleKind::Brackets, _) => set(Setting::Coil, format!("({mark} {name})")),
        _ => Symbol { above: vec![name], ..set(Setting::Coil, format!("({mark})")) },
    })
}

fn figure(block: &Block, words: &[String], element: &Element, source: &str) -> Option<Symbol> {
    let pin = |pin: &Pin| {
        let operand = match pin.wire {
            PinWire::Operand(index) => words.get(index)?.clone(),
            _ => String::new(),
        };
        let name = pin.formal(source).to_string();
        Some(FigurePin { name, negated: pin.negated, power: pin.wire == PinWire::Power, operand })
    };
    let figure = Figure {
        type_name: word(block.type_text(source)?)?,
        inputs: block.inputs.iter().map(pin).collect::<Option<_>>()?,
        outputs: block.outputs.iter().map(pin).collect::<Option<_>>()?,
    };
    let above = match block.instance {
        Some(instance) => vec![word(instance.of(source))?],
        None => Vec::new(),
    };
    let mut symbol = Symbol {
        above,
        body: String::new(),
        setting: Setting::Boxed { output: false },
        figure: Some(figure),
    };
    add_notes(&mut symbol, element, source);
    Some(symbol)
}

impl Figure {
    /// The first wired pin of a side.
    pub fn main_pin(pins: &[FigurePin]) -> Option<usize> {
        pins.iter().position(|pin| pin.power)
    }

    /// Cells between the edges. The main pins face each other; other pins may, too, so any two names must fit.
    pub fn inner_width(&self) -> usize {
        let widest = |pins: &[FigurePin]| pins.iter().map(|pin| text_width(&pin.name)).max().unwrap_or(0);
        (widest(&self.inputs) + widest(&self.outputs) + 2).max(text_width(&self.type_name) + 2)
    }

    /// Cells that a side needs outside its edge for operands, circles and the wires to them.
    pub fn outer_width(pins: &[FigurePin]) -> usize {
        let one = |pin: &FigurePin| match (text_width(&pin.operand), pin.negated) {
            (0, negated) => usize::from(negated),
            (operand, negated) => operand + 2 + usize::from(negated),
        };
        pins.iter().map(one).max().unwrap_or(0)
    }
}
