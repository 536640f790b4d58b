//! The list of used devices: where each is read and written, as a table and as a grid like those of programming tools.

use super::names::PouWalk;
use super::{devices, uses};
use crate::document::{Chunk, ChunkRef, Mention, ProjectView, Symbol, Use};
use crate::target::{Device, Opcode, Operand, Role};
use crate::text::{Encoding, Language, Message};
use rustc_hash::FxHashSet;
use serde_json::{Value, json};
use std::collections::BTreeMap;

mod grid;

/// The devices, addresses and variables of a project.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Usage {
    /// In reading order: devices by kind and number, then addresses, then variables by unit and name.
    pub rows: Vec<UsageRow>,
}

/// A device, an address or a variable with all its uses.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct UsageRow {
    /// What it is.
    pub key: UsageKey,
    /// As people write it: `X0`, `%IX0.0`, `Motor`.
    pub name: String,
    /// The project's symbol for it; empty if it has none.
    pub symbol: String,
    /// The project's comment; empty if there is none.
    pub comment: String,
    /// Whether it keeps its value without power.
    pub is_latched: bool,
    /// The preset of a timer or counter as written, and what it amounts to: `K50 = 5 s`.
    pub preset: String,
    /// Its uses, file by file in the order of the text.
    pub uses: Vec<UsageAt>,
}

/// What a row is about. The order is that of the rows.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum UsageKey {
    /// A device of the PLC.
    Device(Device),
    /// A direct address.
    Direct(crate::target::DirectAddress),
    /// A variable: the unit that declares or uses it, empty for global ones, and its folded name.
    Variable(String, String),
}

/// One use.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct UsageAt {
    /// The number of the file in the view.
    pub file: usize,
    /// The line, from 0.
    pub line: u32,
    /// The column in characters, from 0.
    pub column: u32,
    /// The rung, from 1, if it is part of one.
    pub rung: Option<usize>,
    /// What is done.
    pub usage: Use,
    /// Whether a coil or its instruction does it: OUT, SET, RST, PLS.
    pub by_coil: bool,
    /// How many consecutive devices are meant.
    pub count: u16,
    /// The instruction, or the drawn rung in a line.
    pub text: String,
}

impl UsageAt {
    /// What is done, in the tables that programs read: `read`, `write`, `read-write`, `define`, `jump`.
    pub fn access_word(&self) -> &'static str {
        match self.usage {
            Use::Read => "read",
            Use::Write => "write",
            Use::ReadWrite => "read-write",
            Use::Declare => "define",
            Use::Jump => "jump",
        }
    }
}

impl UsageRow {
    /// The name, behind that of its unit for a variable of one.
    pub fn full_name(&self) -> String {
        match &self.key {
            UsageKey::Variable(unit, _) if !unit.is_empty() => format!("{unit}.{}", self.name),
            _ => self.name.clone(),
        }
    }

    /// The letter of a device, `address` or `variable`.
    pub fn kind_word(&self) -> String {
        match &self.key {
            UsageKey::Device(device) => device.kind.letter().to_string(),
            UsageKey::Direct(_) => "address".to_string(),
            UsageKey::Variable(..) => "variable".to_string(),
        }
    }

    /// The row for programs that read it, as the command line and the editors give it, lines and columns from 1:
    /// `{"device", "kind", "symbol", "comment", "latched", "preset", "read", "written",
    /// "uses": [{"line", "column", "rung", "access", "coil", "count", "text"}]}`.
    /// `names` are more fields of each use that say which file it is in.
    pub fn json(&self, names: impl Fn(usize) -> Vec<(&'static str, Value)>) -> Value {
        let one = |at: &UsageAt| {
            let mut fields = json!({
                "line": at.line + 1,
                "column": at.column + 1,
                "rung": at.rung,
                "access": at.access_word(),
                "coil": at.by_coil,
                "count": at.count,
                "text": at.text,
            });
            for (name, value) in names(at.file) {
                fields[name] = value;
            }
            fields
        };
        json!({
            "device": self.full_name(),
            "kind": self.kind_word(),
            "symbol": self.symbol,
            "comment": self.comment,
            "latched": self.is_latched,
            "preset": self.preset,
            "read": self.is_read(),
            "written": self.is_written(),
            "uses": self.uses.iter().map(one).collect::<Vec<_>>(),
        })
    }

    /// Whether the program reads it.
    pub fn is_read(&self) -> bool {
        self.uses.iter().any(|at| at.usage.reads())
    }

    /// Whether the program writes it.
    pub fn is_written(&self) -> bool {
        self.uses.iter().any(|at| at.usage.writes())
    }
}

/// All uses in the files of `view`.
pub(super) fn of(view: &ProjectView<'_>) -> Usage {
    let mut rows: BTreeMap<UsageKey, UsageRow> = BTreeMap::new();
    for file in 0..view.members().len() {
        collect(view, file, &mut rows);
    }
    Usage { rows: rows.into_values().collect() }
}

fn collect(view: &ProjectView<'_>, file: usize, rows: &mut BTreeMap<UsageKey, UsageRow>) {
    let document = &view.members()[file].document.lean();
    let scopes = document.scopes();
    let mut walk = PouWalk::default();
    let mut rungs = 0;
    for at in document.chunks() {
        let pou = walk.enter(at.chunk);
        let coils = coils(at.chunk);
        for mention in at.chunk.mentions() {
            let Some(key) = key_of(&mention.symbol, pou, scopes) else { continue };
            let row = rows.entry(key).or_insert_with_key(|key| new_row(document, key, mention, at));
            if row.preset.is_empty()
                && let UsageKey::Device(device) = row.key
            {
                row.preset = preset(document, at.chunk, device);
            }
            let inside = mention.span.start as usize;
            let position = document.position(at.start + inside, Encoding::Utf32);
            row.uses.push(UsageAt {
                file,
                line: position.line,
                column: position.column,
                rung: uses::rung_in(at.chunk, inside).map(|own| rungs + own),
                usage: mention.usage,
                by_coil: mention.usage.writes() && coils.contains(&mention.span.start),
                count: mention.count,
                text: uses::text_at(at, inside),
            });
        }
        rungs += at.chunk.size().rungs;
    }
}

/// Where the operands of coils start.
fn coils(chunk: &Chunk) -> FxHashSet<u32> {
    let drives = |operation: &crate::document::Operation<'_>| {
        operation.form.is_some_and(|form| {
            form.instruction.role == Role::Output && !matches!(form.instruction.opcode, Opcode::Function(_))
        })
    };
    let operands =
        chunk.operations().filter(drives).filter_map(|operation| operation.operands.first().copied());
    operands.map(|operand| operand.span.start).collect()
}

fn key_of(symbol: &Symbol, pou: Option<usize>, scopes: &crate::document::Scopes) -> Option<UsageKey> {
    match symbol {
        Symbol::Device(device) => Some(UsageKey::Device(*device)),
        Symbol::Direct(address) => Some(UsageKey::Direct(*address)),
        Symbol::Variable(name) => {
            let declared = scopes.variable(pou, name);
            let is_global = declared.is_some_and(|variable| variable.section.is_global());
            let unit = pou.filter(|_| !is_global).and_then(|number| scopes.pous.get(number));
            Some(UsageKey::Variable(
                unit.map(|unit| unit.name.to_string()).unwrap_or_default(),
                name.to_string(),
            ))
        }
        Symbol::Label(_) | Symbol::Pou(_) | Symbol::Type(_) | Symbol::Connector(_) => None,
    }
}

fn new_row(
    document: &crate::document::Document,
    key: &UsageKey,
    mention: &Mention,
    at: ChunkRef<'_>,
) -> UsageRow {
    let said = document.comments().of(&mention.symbol);
    let name = match key {
        UsageKey::Device(device) => device.to_string(),
        UsageKey::Direct(address) => address.to_string(),
        UsageKey::Variable(..) => mention.span.of(at.chunk.text()).to_string(),
    };
    let range = match key {
        UsageKey::Device(device) => device.range_on(document.target()),
        _ => None,
    };
    UsageRow {
        key: key.clone(),
        name,
        symbol: said.map(|row| row.symbol.to_string()).unwrap_or_default(),
        comment: said.map(|row| row.comment.to_string()).unwrap_or_default(),
        is_latched: range.is_some_and(|range| range.latched),
        preset: String::new(),
        uses: Vec::new(),
    }
}

/// `K50 = 5 s`
fn preset(document: &crate::document::Document, chunk: &Chunk, device: Device) -> String {
    if !device.kind.has_preset() {
        return String::new();
    }
    let Some(found) = devices::preset_of(chunk, device) else { return String::new() };
    let word = found.span.of(chunk.text());
    let time = match found.value {
        Operand::Constant { value, index: None } => {
            devices::integer(value).and_then(|count| devices::timer_time(device, count, document.target()))
        }
        _ => None,
    };
    time.map_or_else(|| word.to_string(), |time| format!("{word} = {time}"))
}

impl Usage {
    /// The grid, the presets and the list of uses, as plain text of fixed width.
    pub fn text(&self, view: &ProjectView<'_>, language: Language) -> String {
        grid::text(self, view, language)
    }
}

/// `read`, `written`, `read and written`, `defined`, `jumped to`.
fn access_words(usage: Use, language: Language) -> String {
    let message = match usage {
        Use::Read => Message::new("signature.read"),
        Use::Write => Message::new("signature.written"),
        Use::ReadWrite => Message::new("signature.read-written"),
        Use::Declare => Message::new("usage.defined"),
        Use::Jump => Message::new("usage.jumped"),
    };
    message.render(language)
}
