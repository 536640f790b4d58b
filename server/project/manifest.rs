//! The manifest `rungwise.toml`.

use super::{CommentsFile, PlcSettings};
use crate::check::Severities;
use crate::document::{Comments, Notation, exclusive_names};
use crate::simulate::{Alarm, HistoryLimit, duration};
use crate::target::Target;
use crate::text::{Message, Severity, Span};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};
use std::sync::Arc;
use toml::Spanned;
use toml::de::DeTable;

/// A project's settings. Every one has a default, so an empty manifest is one.
#[derive(Clone, PartialEq, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Manifest {
    /// Shown to people; the folder's name where it is left out.
    pub name: Option<String>,
    /// `fx1s`, `fx1n`, `fx2n`, `fx3u`, `iec`.
    pub target: Option<String>,
    /// `fx` or `iec`, for `.il` files.
    pub dialect: Option<String>,
    /// The program files in order of execution, relative to the manifest; all files of the folder where left out.
    pub files: Option<Vec<String>>,
    /// The device comments file.
    pub comments: Option<String>,
    /// Severity of rules: a code maps to `error`, `warning`, `hint` or `off`.
    pub rules: BTreeMap<String, String>,
    /// What the checker is to prove.
    pub check: CheckSettings,
    /// What the formatter writes.
    pub format: FormatSettings,
    /// What translations are for.
    pub translate: TranslateSettings,
    /// Tasks of the program.
    #[serde(rename = "task")]
    pub tasks: Vec<TaskSettings>,
    /// The serial port of the PLC.
    pub port: Option<String>,
    /// What a download writes into the parameters of the PLC.
    pub plc: PlcSettings,
    /// What is kept while a program is watched in a PLC.
    pub monitor: MonitorSettings,
    /// How programs are simulated.
    pub simulate: SimulateSettings,
    /// What people are told of while the program is watched in a PLC, or runs in the simulator.
    #[serde(rename = "alarm")]
    pub alarms: Vec<AlarmSettings>,
}

/// What is kept while a program is watched in a PLC.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MonitorSettings {
    /// So many changes of values, the latest.
    pub record: Option<usize>,
}

/// How programs are simulated.
#[derive(Clone, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SimulateSettings {
    /// The memory that the way back may take: `64 MiB`.
    pub history: Option<String>,
}

/// An alarm.
#[derive(Clone, PartialEq, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlarmSettings {
    /// The condition, as `D10 > 100 and not X3`.
    pub when: Spanned<String>,
    /// What people are told.
    pub message: String,
    /// How long the condition must have held: `2s`.
    #[serde(rename = "for")]
    pub hold: Option<Spanned<String>>,
    /// How bad that is.
    #[serde(default)]
    pub severity: AlarmSeverity,
}

/// How bad it is that an alarm is raised.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AlarmSeverity {
    /// Somebody must do something.
    Error,
    /// Somebody should look.
    #[default]
    Warning,
    /// Somebody may want to know.
    Hint,
}

impl AlarmSettings {
    /// The alarm; one whose time cannot be read counts at once.
    fn alarm(&self) -> Alarm {
        Alarm {
            when: self.when.get_ref().clone(),
            message: self.message.clone(),
            hold_ns: self.hold.as_ref().and_then(|time| duration(time.get_ref())).unwrap_or(0),
            severity: match self.severity {
                AlarmSeverity::Error => Severity::Error,
                AlarmSeverity::Warning => Severity::Warning,
                AlarmSeverity::Hint => Severity::Hint,
            },
        }
    }
}

/// What the checker is to prove of the programs.
#[derive(Clone, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CheckSettings {
    /// Outputs, relays or variables of which no two may be on together, as `Y0 & Y1`.
    pub never: Vec<String>,
}

/// What translations are for.
#[derive(Clone, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TranslateSettings {
    /// The model of the FX family that FX lists are for which programs of IEC 61131-3 become: `fx1s`, `fx1n`, `fx2n`,
    /// `fx3u`. That of the project where it is left out.
    pub target: Option<String>,
}

/// Nobody reads wider ladder; a width beyond it is a slip of the finger that would fill the memory.
pub const MOST_WIDTH: u32 = 1000;

/// Changes of values that a recording may keep; each takes some forty bytes of memory.
pub const RECORD: RangeInclusive<usize> = 100..=10_000_000;

/// What the formatter writes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FormatSettings {
    /// The look of ladder.
    pub style: FormatStyle,
    /// The least width of ladder, in cells.
    pub width: u32,
}

impl Default for FormatSettings {
    fn default() -> FormatSettings {
        FormatSettings { style: FormatStyle::Iec, width: 48 }
    }
}

/// The look of ladder.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FormatStyle {
    /// `| |`, names above.
    #[default]
    Iec,
    /// `[X0]`, names inside.
    Brackets,
    /// `┤ ├`, box drawing.
    Unicode,
}

/// A task.
#[derive(Clone, PartialEq, Eq, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TaskSettings {
    /// Its name.
    pub name: String,
    /// Its interval, `10ms`; left out it runs in every scan.
    pub interval: Option<String>,
    /// Its priority, 0 is the highest.
    #[serde(default)]
    pub priority: u32,
    /// The program files that it runs, in order.
    pub programs: Vec<String>,
}

/// Why a manifest cannot be used, with the place in it.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{}", message.render(crate::text::Language::English))]
pub struct ManifestError {
    /// What is wrong.
    pub message: Message,
    /// Where.
    pub span: Span,
}

/// What the TOML library says, in words of the catalogue where it is about keys and kinds of values.
fn message_of(reason: &str) -> Message {
    let quoted: Vec<&str> = reason.split('`').skip(1).step_by(2).collect();
    let wanted = reason.rsplit_once("expected ").map_or("", |(_, wanted)| wanted);
    let is_about = |beginning: &str| reason.starts_with(beginning);
    match quoted[..] {
        [word, ref words @ ..] if is_about("unknown field") || is_about("unknown variant") => {
            let key =
                if is_about("unknown field") { "manifest.unknown-key" } else { "manifest.unknown-word" };
            Message::new(key).with("word", word).with_words("words", words.iter().copied(), ", ")
        }
        [word] if is_about("missing field") => Message::new("manifest.missing-key").with("word", word),
        _ if is_about("invalid type") || is_about("invalid value") => match wanted {
            "a string" => Message::new("manifest.text"),
            "a sequence" => Message::new("manifest.list"),
            "a map" => Message::new("manifest.table"),
            _ if wanted.starts_with("struct ") => Message::new("manifest.table"),
            _ => Message::new("manifest.number"),
        },
        _ => Message::new("manifest.toml").with("reason", reason),
    }
}

impl Manifest {
    /// Reads a manifest.
    ///
    /// # Errors
    /// With the place, where it is not TOML, has an unknown key or a value that a key does not take.
    pub fn read(text: &str) -> Result<Manifest, ManifestError> {
        let manifest: Manifest = toml::from_str(text).map_err(|error| {
            let span = error.span().map_or(Span::default(), |range| {
                Span::new(at_character(text, range.start), at_character(text, range.end))
            });
            ManifestError { message: message_of(error.message()), span }
        })?;
        manifest.validated(text)
    }

    /// The target, if the manifest names one.
    pub fn target(&self) -> Option<&'static Target> {
        self.target.as_deref().and_then(Target::named)
    }

    /// The model of the FX family for which a program of IEC 61131-3 is translated, if the manifest names one.
    pub fn fx_target(&self) -> Option<&'static Target> {
        let own = self.translate.target.as_deref().and_then(Target::named);
        own.or_else(|| self.target()).filter(|target| target.is_fx())
    }

    /// The language of `.il` files, if the manifest names one.
    pub fn notation(&self) -> Option<Notation> {
        self.dialect.as_deref().and_then(dialect_named)
    }

    /// What the project says about its devices: in its comments file, and of the latches of its PLC.
    pub fn said_of_devices(&self, file: Option<&CommentsFile>) -> Arc<Comments> {
        let comments = file.map(|file| file.comments.clone()).unwrap_or_default();
        match self.plc.latches() {
            latches if latches == *comments.latches() => comments,
            latches => Arc::new(Comments::clone(&comments).with_latches(latches)),
        }
    }

    /// The alarms.
    pub fn alarms(&self) -> Vec<Alarm> {
        self.alarms.iter().map(AlarmSettings::alarm).collect()
    }

    /// The memory that the way back of a simulation may take.
    pub fn history(&self) -> HistoryLimit {
        self.simulate.history.as_deref().and_then(HistoryLimit::read).unwrap_or_default()
    }

    /// The rules' severities.
    pub fn severities(&self) -> Severities {
        let pairs = self.rules.iter().filter_map(|(code, word)| Some((code.clone(), severity_named(word)?)));
        let names = |line: &String| {
            let (names, _) = exclusive_names(line);
            names.iter().map(|name| name.of(line).to_string()).collect()
        };
        Severities { grades: pairs.collect(), never: self.check.never.iter().map(names).collect() }
    }

    fn validated(self, text: &str) -> Result<Manifest, ManifestError> {
        let fail = |message: &'static str, word: &str, part: Part, keys: &[&str]| {
            let message = Message::new(message).with("word", word);
            Err(ManifestError { message, span: place(text, keys, part) })
        };
        if let Some(word) = self.target.as_deref().filter(|word| Target::named(word).is_none()) {
            return fail("manifest.target", word, Part::Value, &["target"]);
        }
        let is_fx = |word: &&str| Target::named(word).is_some_and(Target::is_fx);
        if let Some(word) = self.translate.target.as_deref().filter(|word| !is_fx(word)) {
            return fail("manifest.fx-target", word, Part::Value, &["translate", "target"]);
        }
        if self.format.width > MOST_WIDTH {
            let width = self.format.width.to_string();
            return fail("manifest.width", &width, Part::Value, &["format", "width"]);
        }
        if let Some(record) = self.monitor.record.filter(|record| !RECORD.contains(record)) {
            return fail("manifest.record", &record.to_string(), Part::Value, &["monitor", "record"]);
        }
        let history = self.simulate.history.as_deref();
        if let Some(word) = history.filter(|word| HistoryLimit::read(word).is_none()) {
            return fail("manifest.history", word, Part::Value, &["simulate", "history"]);
        }
        if let Some(word) = self.dialect.as_deref().filter(|word| dialect_named(word).is_none()) {
            return fail("manifest.dialect", word, Part::Value, &["dialect"]);
        }
        for (number, line) in self.check.never.iter().enumerate() {
            if let Err((message, within)) = exclusion(line) {
                let start = item(text, &["check", "never"], number).start as usize;
                return Err(ManifestError { message, span: within.shifted(start) });
            }
        }
        if let Some((message, span)) = self.plc.problem(self.target().map(|target| target.model)) {
            return Err(ManifestError { message, span: within_quotes(text, span) });
        }
        for alarm in &self.alarms {
            let fail = |message, span| Err(ManifestError { message, span: within_quotes(text, span) });
            if let Some(time) = alarm.hold.as_ref().filter(|time| duration(time.get_ref()).is_none()) {
                return fail(Message::new("debug.time").with("text", time.get_ref()), time.span());
            }
            if let Err(reason) = alarm.alarm().check(self.target(), self.comments.is_some()) {
                return fail(reason, alarm.when.span());
            }
        }
        for (code, word) in &self.rules {
            if crate::check::Rule::named(code).is_none() {
                return fail("manifest.rule", code, Part::Key, &["rules", code]);
            }
            if severity_named(word).is_none() {
                return fail("manifest.severity", word, Part::Value, &["rules", code]);
            }
        }
        Ok(self)
    }
}

/// What is wrong with a line such as `Y0 & Y1`, and where in it.
fn exclusion(line: &str) -> Result<(), (Message, Span)> {
    let (names, end) = exclusive_names(line);
    let behind = line[end..].trim();
    if !behind.is_empty() || names.len() < 2 {
        let message = Message::new("manifest.never").with("line", line);
        return Err((message, Span::new(0, line.len())));
    }
    for (number, name) in names.iter().enumerate() {
        let is_again = |other: &Span| other.of(line).eq_ignore_ascii_case(name.of(line));
        if names[..number].iter().any(is_again) {
            return Err((Message::new("manifest.never-twice").with("name", name.of(line)), *name));
        }
    }
    Ok(())
}

/// Where the item of this number stands in the list under `keys`, without its quotes.
fn item(text: &str, keys: &[&str], number: usize) -> Span {
    let Ok(table) = DeTable::parse(text) else { return Span::default() };
    let mut table = Some(table.get_ref());
    let mut found = None;
    for key in keys {
        let value = table.and_then(|table| table.get(*key));
        found = value.and_then(|value| value.get_ref().as_array()).and_then(|list| list.get(number));
        table = value.and_then(|value| value.get_ref().as_table());
    }
    found.map_or(Span::default(), |value| within_quotes(text, value.span()))
}

/// What of an entry is meant.
#[derive(Clone, Copy)]
enum Part {
    Key,
    Value,
}

/// Where the entry under `keys`, table by table, stands in a manifest that could be read.
fn place(text: &str, keys: &[&str], part: Part) -> Span {
    let Ok(table) = DeTable::parse(text) else { return Span::default() };
    let mut table = Some(table.get_ref());
    let mut span = 0..0;
    for key in keys {
        let Some((written, value)) = table.and_then(|table| table.get_key_value(*key)) else { break };
        span = match part {
            Part::Key => written.span(),
            Part::Value => value.span(),
        };
        table = value.get_ref().as_table();
    }
    within_quotes(text, span)
}

/// A word is meant without its quotes.
fn within_quotes(text: &str, span: Range<usize>) -> Span {
    let (start, end) = (at_character(text, span.start), at_character(text, span.end));
    let quotes = text
        .get(start..end)
        .and_then(|entry| entry.chars().next())
        .filter(|first| matches!(first, '"' | '\''));
    let inside = usize::from(quotes.is_some() && end - start >= 2);
    Span::new(start + inside, end - inside)
}

/// The start of the character that holds the byte `offset`: the reader of TOML may mean a byte inside one.
fn at_character(text: &str, offset: usize) -> usize {
    (0..=offset.min(text.len())).rev().find(|offset| text.is_char_boundary(*offset)).unwrap_or(0)
}

fn dialect_named(word: &str) -> Option<Notation> {
    match word {
        "fx" => Some(Notation::FxIl),
        "iec" => Some(Notation::IecIl),
        _ => None,
    }
}

/// `Some(None)` is `off`.
fn severity_named(word: &str) -> Option<Option<Severity>> {
    let all = [Severity::Error, Severity::Warning, Severity::Hint];
    match word {
        "off" => Some(None),
        _ => all.into_iter().find(|severity| severity.word() == word).map(Some),
    }
}
