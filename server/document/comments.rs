//! What a project says about its devices: a symbol and a comment for each, and which keep their values without power.

use super::Symbol;
use crate::target::{Device, Latches, Symbols};
use crate::text::Span;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::sync::Arc;

/// The device comments of a project. Programs may write a device's symbol in its place.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Comments {
    rows: Vec<DeviceComment>,
    index: FxHashMap<Symbol, usize>,
    symbols: Arc<Symbols>,
    latches: Latches,
}

/// What is said about one device or direct address. The spans are places in the comments file, empty where it has
/// no such field.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DeviceComment {
    /// [`Symbol::Device`] or [`Symbol::Direct`].
    pub thing: Symbol,
    /// Its name; empty if it has none that a program can write.
    pub symbol: SmolStr,
    /// What people say of it; may be empty.
    pub comment: SmolStr,
    /// The field with the device.
    pub thing_span: Span,
    /// The field with the symbol.
    pub symbol_span: Span,
}

impl Comments {
    /// Of rows; of a device or symbol that stands twice the first row counts.
    pub fn new(rows: Vec<DeviceComment>) -> Comments {
        let mut index = FxHashMap::default();
        for (number, row) in rows.iter().enumerate() {
            index.entry(row.thing.clone()).or_insert(number);
        }
        let symbols = rows.iter().enumerate().filter_map(|(number, row)| match row.thing {
            Symbol::Device(device) if !row.symbol.is_empty() && index.get(&row.thing) == Some(&number) => {
                Some((row.symbol.clone(), device))
            }
            _ => None,
        });
        let symbols = Arc::new(Symbols::new(symbols));
        Comments { rows, index, symbols, latches: Latches::default() }
    }

    /// The same for a PLC whose parameters set these latches.
    pub fn with_latches(self, latches: Latches) -> Comments {
        Comments { latches, ..self }
    }

    /// What is said about `thing`.
    pub fn of(&self, thing: &Symbol) -> Option<&DeviceComment> {
        self.rows.get(*self.index.get(thing)?)
    }

    /// What is said about a device.
    pub fn of_device(&self, device: Device) -> Option<&DeviceComment> {
        self.of(&Symbol::Device(device))
    }

    /// All rows in the order of the file.
    pub fn rows(&self) -> &[DeviceComment] {
        &self.rows
    }

    /// Which devices keep their values without power.
    pub fn latches(&self) -> &Latches {
        &self.latches
    }

    /// The names that programs may write.
    pub fn symbols(&self) -> &Arc<Symbols> {
        &self.symbols
    }
}

impl DeviceComment {
    /// `Start: the green button`, or the part of it that there is.
    pub fn words(&self) -> String {
        match (self.symbol.is_empty(), self.comment.is_empty()) {
            (false, false) => format!("{}: {}", self.symbol, self.comment),
            (false, true) => self.symbol.to_string(),
            (true, _) => self.comment.to_string(),
        }
    }
}
