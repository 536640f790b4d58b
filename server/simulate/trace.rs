//! What variables were, scan by scan, and the forms in which that is handed on.

use super::{Machine, Value, Variable};
use crate::text::csv_line;
use std::io;
use vcd::{IdCode, TimescaleUnit, VarType, Writer};

/// The values of some variables over time: a row for each scan in which one of them changed, for the first and the
/// last.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Trace {
    /// What is traced, as people call it.
    pub names: Vec<String>,
    /// In the order of scans.
    pub rows: Vec<Row>,
    variables: Vec<Variable>,
    /// The row of the last scan, if nothing changed in it.
    last: Option<Row>,
    /// The first row in which each name has a value; all have one from the first row on where this is empty.
    known_from: Vec<usize>,
    /// No more rows than about these are kept, the latest, if there is a limit.
    most: Option<usize>,
}

/// The values after a scan.
#[derive(Clone, PartialEq, Debug)]
pub struct Row {
    /// The number of the scan, from 0 on.
    pub scan: u64,
    /// When it began, in nanoseconds.
    pub time_ns: i64,
    /// In the order of the names.
    pub values: Vec<Value>,
}

impl Trace {
    /// A trace of these variables.
    pub fn new(watched: Vec<(String, Variable)>) -> Trace {
        let (names, variables) = watched.into_iter().unzip();
        Trace { names, variables, ..Trace::default() }
    }

    /// A trace of what is noted by [`Trace::push`] alone.
    pub fn of_names(names: Vec<String>) -> Trace {
        Trace { names, ..Trace::default() }
    }

    /// The same with no more than about `most` rows, the latest.
    pub fn bounded(names: Vec<String>, most: usize) -> Trace {
        Trace { names, most: Some(most.max(1)), ..Trace::default() }
    }

    /// Notes what the variables are after a scan.
    pub fn note(&mut self, machine: &Machine<u8>) {
        let values = self.variables.iter().map(|variable| machine.value(*variable, 0)).collect();
        self.push(Row { scan: machine.scans().saturating_sub(1), time_ns: machine.now_ns(), values });
    }

    /// Notes values that come from elsewhere, in the order of the names; whether they are others than before.
    pub fn push(&mut self, row: Row) -> bool {
        let is_news = self.rows.last().is_none_or(|before| before.values != row.values);
        match is_news {
            true => {
                self.rows.push(row);
                self.last = None;
            }
            false => self.last = Some(row),
        }
        // Many go at once, so that each costs little.
        if let Some(most) = self.most.filter(|most| self.rows.len() > most + most / 4) {
            self.rows.drain(..self.rows.len() - most);
        }
        is_news
    }

    /// Notes values of which some are not known yet; once one is, it stays so.
    pub fn push_known(&mut self, scan: u64, time_ns: i64, values: Vec<Option<Value>>) {
        let row = self.rows.len();
        self.known_from.resize(self.names.len(), row + 1);
        for (known_from, value) in self.known_from.iter_mut().zip(&values) {
            // What was not known before this row may be from the next one on.
            *known_from = match value {
                Some(_) => (*known_from).min(row),
                None => row + 1,
            };
        }
        // Like no value, so that the first one is news.
        let unknown = || Value::Name("?".into());
        let values = values.into_iter().map(|value| value.unwrap_or_else(unknown)).collect();
        self.push(Row { scan, time_ns, values });
    }

    /// Whether a name has a value in a row.
    fn is_known(&self, name: usize, row: usize) -> bool {
        self.known_from.get(name).is_none_or(|known_from| *known_from <= row)
    }

    /// Ends it: the last scan has a row.
    pub fn end(&mut self) {
        self.rows.extend(self.last.take());
    }

    /// Comma-separated values with a line for each row; times in milliseconds.
    pub fn csv(&self) -> String {
        let heads = ["scan", "time_ms"].map(String::from).into_iter();
        let mut text = csv_line(heads.chain(self.names.iter().cloned()));
        for (at, row) in self.rows.iter().enumerate() {
            let head = [row.scan.to_string(), milliseconds(row.time_ns)];
            let value = |(name, value): (usize, &Value)| match self.is_known(name, at) {
                true => value.to_string(),
                false => String::new(),
            };
            text += &csv_line(head.into_iter().chain(row.values.iter().enumerate().map(value)));
        }
        text
    }

    /// A value change dump, which waveform viewers open.
    pub fn vcd(&self) -> io::Result<Vec<u8>> {
        let mut writer = Writer::new(Vec::new());
        writer.version("Rungwise")?;
        writer.timescale(1, TimescaleUnit::NS)?;
        writer.add_module("plc")?;
        let mut codes = Vec::new();
        for (number, name) in self.names.iter().enumerate() {
            let known_from = self.known_from.get(number).copied().unwrap_or(0);
            let known = self.rows.get(known_from..).unwrap_or_default();
            let bits = known.iter().map(|row| width(&row.values[number])).max().unwrap_or(1);
            let first = known.first().map(|row| &row.values[number]);
            let kind = match first {
                Some(Value::Bit(_)) | None => VarType::Wire,
                Some(Value::Number(_) | Value::Unsigned(_)) => VarType::Integer,
                Some(Value::Real(_) | Value::Time(_)) => VarType::Real,
                Some(Value::Text(_) | Value::Name(_) | Value::Word(..)) => VarType::String,
            };
            let code = IdCode::from(number as u32);
            // Blanks would end a name.
            writer.var_def(kind, bits, code, &name.replace(char::is_whitespace, "_"), None)?;
            codes.push((code, bits));
        }
        writer.upscope()?;
        writer.enddefinitions()?;
        let mut before: Option<&Row> = None;
        for (at, row) in self.rows.iter().enumerate() {
            writer.timestamp(row.time_ns.unsigned_abs())?;
            for (number, (code, bits)) in codes.iter().enumerate() {
                let value = &row.values[number];
                let is_first = at > 0 && !self.is_known(number, at - 1);
                let is_same = before.is_some_and(|before| before.values[number] == *value) && !is_first;
                // A viewer shows nothing, or that it is not known, before the first value.
                if is_same || !self.is_known(number, at) {
                    continue;
                }
                let vector = |value: u64| {
                    let bit = move |bit: u32| vcd::Value::from(value >> bit & 1 == 1);
                    (0..*bits).rev().map(bit).collect::<Vec<_>>()
                };
                match value {
                    Value::Bit(on) => writer.change_scalar(*code, *on)?,
                    Value::Number(number) => writer.change_vector(*code, vector(*number as u64))?,
                    Value::Unsigned(number) => writer.change_vector(*code, vector(*number))?,
                    Value::Real(number) => writer.change_real(*code, *number)?,
                    Value::Time(time) => writer.change_real(*code, *time as f64 / 1e6)?,
                    Value::Text(text) | Value::Name(text) | Value::Word(text, _) => {
                        writer.change_string(*code, &text.replace(char::is_whitespace, "_"))?
                    }
                }
            }
            before = Some(row);
        }
        writer.flush()?;
        Ok(std::mem::take(writer.writer()))
    }
}

/// How many bits a value takes.
fn width(value: &Value) -> u32 {
    match value {
        Value::Bit(_) => 1,
        Value::Number(value) if i16::try_from(*value).is_ok() => 16,
        Value::Number(value) if i32::try_from(*value).is_ok() => 32,
        Value::Number(_) | Value::Unsigned(_) | Value::Real(_) | Value::Time(_) => 64,
        Value::Text(_) | Value::Name(_) | Value::Word(..) => 8,
    }
}

/// A time as milliseconds, without zeros that say nothing: `12.5`.
pub fn milliseconds(time_ns: i64) -> String {
    (time_ns as f64 / 1e6).to_string()
}
