//! The list of used devices: where each is read and written, as a table and as a grid like those of programming tools.

use super::names::{self, PouWalk, Thing};
use super::{devices, uses};
use crate::document::{Chunk, ChunkRef, Document, Mention, Operation, ProjectView, Scopes, Symbol, Use};
use crate::target::{Device, DirectAddress, Opcode, Operand, Role};
use crate::text::{Encoding, Language, Message, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use serde_json::{Value, json};
use smol_str::SmolStr;
use std::collections::BTreeMap;

mod gaps;
pub use gaps::{UsageKind, UsedKind};

mod grid;

/// What of the uses is wanted. Programs may have a hundred thousand of them.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct UsageWish {
    /// Whether each use is told with its place and text; else the uses are counted.
    pub places: bool,
    /// Of which devices.
    pub of: UsageOf,
}

/// The devices whose uses are wanted.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum UsageOf {
    /// All of them, with the kinds and what is unused.
    All,
    /// Those of these names, as [`UsageRow::full_name`] has them, letter case aside.
    Named(Vec<String>),
    /// The one at this byte of the file that is looked at.
    At(usize),
}

/// The devices, addresses and variables of a project.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Usage {
    /// In reading order: devices by kind and number, then addresses, then variables by unit and name.
    pub rows: Vec<UsageRow>,
    /// The kinds of the rows, in the order of the rows; empty if only some devices were wanted.
    pub kinds: Vec<UsedKind>,
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
    /// How many uses read it.
    pub reads: usize,
    /// How many uses write it. Some do both, and some neither, such as declarations.
    pub writes: usize,
    /// How many consecutive devices from it on the longest use means: 16 for the M0 of `K4M0`.
    pub length: u16,
    /// The first and last of each run of free devices between it and the next one in use: those that no use means and
    /// that the project says nothing of.
    pub gaps: Vec<(Device, Device)>,
    /// Its uses, file by file in the order of the text; none if they were only counted.
    pub uses: Vec<UsageAt>,
}

/// What a row is about. The order is that of the rows.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum UsageKey {
    /// A device of the PLC.
    Device(Device),
    /// A direct address.
    Direct(DirectAddress),
    /// A variable: the unit that declares or uses it, empty for global ones, and its folded name.
    Variable(String, String),
}

impl UsageKey {
    /// The kind.
    pub fn kind(&self) -> UsageKind {
        match self {
            UsageKey::Device(device) => UsageKind::Device(device.kind),
            UsageKey::Direct(_) => UsageKind::Address,
            UsageKey::Variable(..) => UsageKind::Variable,
        }
    }

    /// The name, behind that of its unit for a variable of one, which has the folded name here.
    fn full_name(&self) -> String {
        match self {
            UsageKey::Device(device) => device.to_string(),
            UsageKey::Direct(address) => address.to_string(),
            UsageKey::Variable(unit, name) if unit.is_empty() => name.clone(),
            UsageKey::Variable(unit, name) => format!("{unit}.{name}"),
        }
    }
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

    /// The row for programs that read it, as the command line and the editors give it, lines and columns from 1:
    /// `{"device", "kind", "symbol", "comment", "latched", "preset", "read", "written", "reads", "writes",
    /// "gaps": [{"first", "last", "count"}],
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
        let gap = |(first, last): &(Device, Device)| {
            json!({
                "first": first.to_string(),
                "last": last.to_string(),
                "count": last.number - first.number + 1,
            })
        };
        json!({
            "device": self.full_name(),
            "kind": self.key.kind().word(),
            "symbol": self.symbol,
            "comment": self.comment,
            "latched": self.is_latched,
            "preset": self.preset,
            "read": self.is_read(),
            "written": self.is_written(),
            "reads": self.reads,
            "writes": self.writes,
            "gaps": self.gaps.iter().map(gap).collect::<Vec<_>>(),
            "uses": self.uses.iter().map(one).collect::<Vec<_>>(),
        })
    }

    /// Whether the program reads it.
    pub fn is_read(&self) -> bool {
        self.reads > 0
    }

    /// Whether the program writes it.
    pub fn is_written(&self) -> bool {
        self.writes > 0
    }
}

/// The uses in the files of `view`.
pub(super) fn of(view: &ProjectView<'_>, wish: &UsageWish) -> Usage {
    let mut collector =
        Collector { rows: BTreeMap::new(), places: wish.places, wanted: wanted(view, &wish.of) };
    for file in 0..view.members().len() {
        collector.file(view, file);
    }
    let mut usage = Usage { rows: collector.rows.into_values().collect(), kinds: Vec::new() };
    if wish.of == UsageOf::All {
        gaps::find(&mut usage, view);
    }
    usage
}

/// Which devices are wanted.
enum Wanted {
    All,
    /// Those of these folded names, and what is known of the keys that were asked about.
    Named(FxHashSet<SmolStr>, FxHashMap<UsageKey, bool>),
    Key(Option<UsageKey>),
}

fn wanted(view: &ProjectView<'_>, of: &UsageOf) -> Wanted {
    match of {
        UsageOf::All => Wanted::All,
        UsageOf::Named(names) => {
            Wanted::Named(names.iter().map(|name| folded(name)).collect(), FxHashMap::default())
        }
        UsageOf::At(offset) => Wanted::Key(key_at(view.here(), *offset)),
    }
}

/// What stands at `offset`, if it is something of which uses are told.
fn key_at(document: &Document, offset: usize) -> Option<UsageKey> {
    match names::at(document, offset)?.thing {
        Thing::Devices(device, _) => Some(UsageKey::Device(device)),
        Thing::Direct(address) => Some(UsageKey::Direct(address)),
        Thing::Variable { pou, name } => key_of(&Symbol::Variable(name), pou, document.scopes()),
        Thing::Label { .. } | Thing::Connector { .. } | Thing::Pou(_) | Thing::Type(_) => None,
    }
}

impl Wanted {
    fn has(&mut self, key: &UsageKey) -> bool {
        match self {
            Wanted::All => true,
            Wanted::Key(wanted) => wanted.as_ref() == Some(key),
            Wanted::Named(names, known) => match known.get(key) {
                Some(known) => *known,
                None => {
                    let is_named = names.contains(&folded(&key.full_name()));
                    known.insert(key.clone(), is_named);
                    is_named
                }
            },
        }
    }
}

struct Collector {
    rows: BTreeMap<UsageKey, UsageRow>,
    places: bool,
    wanted: Wanted,
}

impl Collector {
    fn file(&mut self, view: &ProjectView<'_>, file: usize) {
        let document = &view.members()[file].document.lean();
        let scopes = document.scopes();
        let mut walk = PouWalk::default();
        let mut rungs = 0;
        for at in document.chunks() {
            if view.is_cancelled() {
                return;
            }
            let pou = walk.enter(at.chunk);
            let mut driven = None;
            for mention in at.chunk.mentions() {
                let key = key_of(&mention.symbol, pou, scopes).filter(|key| self.wanted.has(key));
                let Some(key) = key else { continue };
                let row = self.rows.entry(key).or_insert_with_key(|key| new_row(document, key, mention, at));
                row.reads += usize::from(mention.usage.reads());
                row.writes += usize::from(mention.usage.writes());
                row.length = row.length.max(mention.count);
                if row.preset.is_empty()
                    && mention.usage.writes()
                    && let UsageKey::Device(device) = row.key
                {
                    row.preset = preset(document, at.chunk, device);
                }
                if self.places {
                    let driven = driven.get_or_insert_with(|| coils(at.chunk));
                    row.uses.push(use_at(document, file, at, mention, (rungs, driven)));
                }
            }
            rungs += at.chunk.size().rungs;
        }
    }
}

/// The use that is `mention`, in a chunk with `rungs` before it and the operands of coils at `driven`.
fn use_at(
    document: &Document,
    file: usize,
    at: ChunkRef<'_>,
    mention: &Mention,
    (rungs, driven): (usize, &FxHashSet<u32>),
) -> UsageAt {
    let inside = mention.span.start as usize;
    let position = document.position(at.start + inside, Encoding::Utf32);
    UsageAt {
        file,
        line: position.line,
        column: position.column,
        rung: uses::rung_in(at.chunk, inside).map(|own| rungs + own),
        usage: mention.usage,
        by_coil: mention.usage.writes() && driven.contains(&mention.span.start),
        count: mention.count,
        text: uses::text_at(at, inside),
    }
}

/// Where the operands of coils start.
fn coils(chunk: &Chunk) -> FxHashSet<u32> {
    let drives = |operation: &Operation<'_>| {
        operation.form.is_some_and(|form| {
            form.instruction.role == Role::Output && !matches!(form.instruction.opcode, Opcode::Function(_))
        })
    };
    let operands =
        chunk.operations().filter(drives).filter_map(|operation| operation.operands.first().copied());
    operands.map(|operand| operand.span.start).collect()
}

fn key_of(symbol: &Symbol, pou: Option<usize>, scopes: &Scopes) -> Option<UsageKey> {
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

fn new_row(document: &Document, key: &UsageKey, mention: &Mention, at: ChunkRef<'_>) -> UsageRow {
    let said = document.comments().of(&mention.symbol);
    let name = match key {
        UsageKey::Device(device) => device.to_string(),
        UsageKey::Direct(address) => address.to_string(),
        UsageKey::Variable(..) => mention.span.of(at.chunk.text()).to_string(),
    };
    UsageRow {
        key: key.clone(),
        name,
        symbol: said.map(|row| row.symbol.to_string()).unwrap_or_default(),
        comment: said.map(|row| row.comment.to_string()).unwrap_or_default(),
        is_latched: matches!(key, UsageKey::Device(device) if document.keeps(*device)),
        preset: String::new(),
        reads: 0,
        writes: 0,
        length: 1,
        gaps: Vec::new(),
        uses: Vec::new(),
    }
}

/// `K50 = 5 s`
fn preset(document: &Document, chunk: &Chunk, device: Device) -> String {
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
