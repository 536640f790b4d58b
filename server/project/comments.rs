//! The device comments file: rows of device, symbol and comment, as programming tools export them and as spreadsheets
//! write them.
//!
//! Commas, semicolons or tabs part the fields, quotes may surround them. A header line names the columns in any order;
//! without one they are device, symbol, comment. No file is refused: what cannot be used is reported at its place.

mod decode;
pub use decode::decode;

mod fields;

use crate::check::Severities;
use crate::document::{Comments, DeviceComment, Symbol};
use crate::target::{Model, Operand, Symbols, Target};
use crate::text::{Diagnostic, Encoding, LineColumn, Message, Span, position_of};
use fields::{Field, Record};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The code of everything that is wrong in such a file.
const CODE: &str = "device-comments";

/// A comments file as it was read.
#[derive(Clone, Debug)]
pub struct CommentsFile {
    /// Where it is.
    pub path: PathBuf,
    /// What it says.
    pub comments: Arc<Comments>,
    /// What cannot be used, with offsets into the text; graded by the rule's default.
    pub diagnostics: Vec<Diagnostic>,
    /// The separator of its fields.
    pub separator: char,
    text: String,
}

impl CommentsFile {
    /// Reads the file at `path` for programs on `target`. A file that cannot be read has no rows and one diagnostic.
    pub fn open(path: &Path, target: &Target) -> CommentsFile {
        match std::fs::read(path) {
            Ok(bytes) => CommentsFile::read(path, &decode(&bytes), target),
            Err(reason) => {
                let mut file = CommentsFile::read(path, "", target);
                let message = Message::new("device-comments.unreadable").with("reason", reason);
                file.diagnostics.push(Diagnostic::new(CODE, Span::at(0), message));
                file
            }
        }
    }

    /// Reads `text`, the content of the file at `path`, for programs on `target`.
    pub fn read(path: &Path, text: &str, target: &Target) -> CommentsFile {
        let separator = fields::separator_of(text);
        let mut reader =
            Reader { target, rows: Vec::new(), diagnostics: Vec::new(), columns: Columns::default() };
        if let Some(place) = text.find('\u{fffd}') {
            let message = Message::new("device-comments.encoding");
            reader.diagnostics.push(Diagnostic::new(CODE, Span::new(place, place + 3), message));
        }
        let (records, problems) = fields::records(text, separator);
        reader.diagnostics.extend(problems);
        reader.read(&records);
        let mut diagnostics = reader.diagnostics;
        diagnostics.sort_by_key(|diagnostic| diagnostic.span);
        let comments = Arc::new(Comments::new(reader.rows));
        CommentsFile {
            path: path.to_path_buf(),
            comments,
            diagnostics,
            separator: separator.into(),
            text: text.into(),
        }
    }

    /// What is wrong in it, as the rules of a project are graded.
    pub fn graded(&self, severities: &Severities) -> Vec<Diagnostic> {
        let grade =
            |found: &Diagnostic| Some(Diagnostic { severity: severities.of(found.code)?, ..found.clone() });
        self.diagnostics.iter().filter_map(grade).collect()
    }

    /// The text of which the spans count the bytes.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The position of byte `offset`.
    pub fn position(&self, offset: u32, encoding: Encoding) -> LineColumn {
        position_of(&self.text, offset as usize, encoding)
    }
}

/// Which field of a record is what.
#[derive(Clone, Copy)]
struct Columns {
    thing: usize,
    symbol: Option<usize>,
    comment: Option<usize>,
}

impl Default for Columns {
    fn default() -> Columns {
        Columns { thing: 0, symbol: Some(1), comment: Some(2) }
    }
}

/// The names of columns in the languages of programming tools.
const THINGS: &[&str] = &["device", "device name", "address", "软元件", "软元件名", "元件", "地址"];
const SYMBOLS: &[&str] = &["symbol", "label", "alias", "name", "符号", "标签", "别名", "标号", "名称"];
const COMMENTS: &[&str] = &["comment", "comments", "remark", "description", "注释", "说明", "备注"];

/// A header stands in one of the first lines; exports put the name of the table above it.
const HEADER_LINES: usize = 3;

struct Reader<'a> {
    target: &'a Target,
    rows: Vec<DeviceComment>,
    diagnostics: Vec<Diagnostic>,
    columns: Columns,
}

impl Reader<'_> {
    fn read(&mut self, records: &[Record]) {
        let mut first = 0;
        for (number, record) in records.iter().enumerate().take(HEADER_LINES) {
            if let Some(columns) = columns_of(record) {
                (self.columns, first) = (columns, number + 1);
            }
        }
        let mut things: FxHashMap<Symbol, Span> = FxHashMap::default();
        let mut names: FxHashMap<String, Span> = FxHashMap::default();
        for record in &records[first..] {
            let Some(mut row) = self.row(record) else { continue };
            if let Some(first) = things.get(&row.thing) {
                let device = record.get(self.columns.thing).map_or("", |field| field.text.as_str());
                let message = Message::new("device-comments.device-twice").with("device", device);
                let related = Message::new("device-comments.first");
                self.diagnostics
                    .push(Diagnostic::new(CODE, row.thing_span, message).related(*first, related));
                continue;
            }
            things.insert(row.thing.clone(), row.thing_span);
            if !row.symbol.is_empty() {
                let folded = row.symbol.to_lowercase();
                if let Some(first) = names.get(&folded) {
                    let message = Message::new("device-comments.symbol-twice").with("symbol", &row.symbol);
                    let related = Message::new("device-comments.first");
                    self.diagnostics
                        .push(Diagnostic::new(CODE, row.symbol_span, message).related(*first, related));
                    row.symbol = SmolStr::default();
                } else {
                    names.insert(folded, row.symbol_span);
                }
            }
            self.rows.push(row);
        }
    }

    fn row(&mut self, record: &Record) -> Option<DeviceComment> {
        let field = |column: Option<usize>| column.and_then(|column| record.get(column));
        let empty = Field::default();
        let device = record.get(self.columns.thing).unwrap_or(&empty);
        if record.iter().all(|field| field.text.is_empty()) {
            return None;
        }
        let Some(thing) = thing(&device.text) else {
            let message = Message::new("device-comments.no-device").with("word", &device.text);
            self.diagnostics.push(Diagnostic::new(CODE, device.span, message));
            return None;
        };
        if let Symbol::Device(device_named) = thing
            && self.target.is_fx()
            && device_named.range_on(self.target).is_none()
        {
            let message = Message::new("device-comments.not-on-target").with("device", device_named);
            let message = message.with("target", self.target.title);
            self.diagnostics.push(Diagnostic::new(CODE, device.span, message));
        }
        let symbol = field(self.columns.symbol).unwrap_or(&empty);
        let comment = field(self.columns.comment).unwrap_or(&empty);
        let problem = if symbol.text.is_empty() { None } else { Symbols::problem(&symbol.text, self.target) };
        if let Some(problem) = problem {
            let message = problem.message().with("symbol", &symbol.text);
            self.diagnostics.push(Diagnostic::new(CODE, symbol.span, message));
        }
        let usable = if problem.is_some() { "" } else { symbol.text.as_str() };
        // A name that no program can write still says something to people.
        let comment = match (problem, comment.text.as_str()) {
            (Some(_), "") => symbol.text.as_str(),
            (_, comment) => comment,
        };
        Some(DeviceComment {
            thing,
            symbol: usable.into(),
            comment: comment.into(),
            thing_span: device.span,
            symbol_span: symbol.span,
        })
    }
}

/// The columns that a header names; nothing if the record is none.
fn columns_of(record: &Record) -> Option<Columns> {
    let column = |names: &[&str]| {
        record.iter().position(|field| names.contains(&field.text.trim().to_lowercase().as_str()))
    };
    let columns = Columns { thing: column(THINGS)?, symbol: column(SYMBOLS), comment: column(COMMENTS) };
    (columns.symbol.is_some() || columns.comment.is_some()).then_some(columns)
}

/// What a first field names.
fn thing(word: &str) -> Option<Symbol> {
    match Operand::read(word, Model::Fx3u) {
        Operand::Device(device) => return Some(Symbol::Device(device)),
        _ if !word.starts_with('%') => return None,
        _ => {}
    }
    match Operand::read(word, Model::Iec) {
        Operand::Direct(address) => Some(Symbol::Direct(address)),
        _ => None,
    }
}
