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

    /// Notes what the variables are after a scan.
    pub fn note(&mut self, machine: &Machine<u8>) {
        let values = self.variables.iter().map(|variable| machine.value(*variable, 0)).collect();
        self.push(Row { scan: machine.scans().saturating_sub(1), time_ns: machine.now_ns(), values });
    }

    /// Notes values that come from elsewhere, in the order of the names.
    pub fn push(&mut self, row: Row) {
        let is_news = self.rows.last().is_none_or(|before| before.values != row.values);
        match is_news {
            true => {
                self.rows.push(row);
                self.last = None;
            }
            false => self.last = Some(row),
        }
    }

    /// Ends it: the last scan has a row.
    pub fn end(&mut self) {
        self.rows.extend(self.last.take());
    }

    /// Comma-separated values with a line for each row; times in milliseconds.
    pub fn csv(&self) -> String {
        let heads = ["scan", "time_ms"].map(String::from).into_iter();
        let mut text = csv_line(heads.chain(self.names.iter().cloned()));
        for row in &self.rows {
            let head = [row.scan.to_string(), milliseconds(row.time_ns)];
            text += &csv_line(head.into_iter().chain(row.values.iter().map(Value::to_string)));
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
            let bits = self.rows.iter().map(|row| width(&row.values[number])).max().unwrap_or(1);
            let first = self.rows.first().map(|row| &row.values[number]);
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
        for row in &self.rows {
            writer.timestamp(row.time_ns.unsigned_abs())?;
            for (number, (code, bits)) in codes.iter().enumerate() {
                let value = &row.values[number];
                if before.is_some_and(|before| before.values[number] == *value) {
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
