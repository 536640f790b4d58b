//! What is debugged, as `launch` asks for it.

use super::back::BackSearch;
use super::debuggee::Debuggee;
use super::going::Going;
use super::program::Program;
use super::variables::Variables;
use crate::simulate::{Error, Setting, Touch, Value, duration};
use crate::text::Message;
use serde::Deserialize;
use serde_json::Value as Json;
use std::path::PathBuf;
use std::time::Instant;

/// The arguments of `launch`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Launch {
    program: Option<PathBuf>,
    cwd: Option<PathBuf>,
    scan_time: Json,
    pub(super) speed: Option<f64>,
    pub(super) stop_on_entry: bool,
    set: Json,
    pub(super) no_debug: bool,
}

/// A program that is debugged.
pub(super) struct Debugged {
    pub(super) launch: Launch,
    pub(super) program: Program,
    pub(super) variables: Variables,
    pub(super) debuggee: Debuggee,
    /// How it goes on; nothing while it is stopped.
    pub(super) going: Option<Going>,
    /// What it looks for on the way back.
    pub(super) search: Option<BackSearch>,
    /// A moment of real time and of simulated time that are the same.
    pub(super) since: (Instant, i64),
    /// The instruction at which it stopped because it is about to fail.
    pub(super) failing: Option<Error>,
    /// What went wrong and was said.
    pub(super) told: Vec<Error>,
    /// Whether it goes on from where it stopped, so that values may be others than breakpoints have seen.
    pub(super) is_fresh: bool,
}

impl Launch {
    /// Reads the program and prepares the PLC.
    ///
    /// # Errors
    /// A sentence that says why it cannot be run.
    pub(super) fn start(&self) -> Result<Debugged, Message> {
        let given = self.program.clone().or_else(|| self.cwd.clone());
        let given = given.ok_or_else(|| Message::new("debug.no-program"))?;
        let path = self.cwd.as_ref().map_or_else(|| given.clone(), |cwd| cwd.join(&given));
        let program = Program::open(&path)?;
        let scan_ns = self.scan_ns()?;
        let settings = self.settings(&program, scan_ns)?;
        Ok(Debugged {
            launch: self.clone(),
            variables: Variables::of(&program),
            debuggee: Debuggee::new(program.code.clone(), program.history, scan_ns, settings),
            program,
            going: None,
            search: None,
            since: (Instant::now(), 0),
            failing: None,
            told: Vec::new(),
            is_fresh: true,
        })
    }

    /// Simulated time for each unit of real time; 0 for as fast as can be.
    pub(super) fn speed(&self) -> f64 {
        self.speed.filter(|speed| speed.is_finite() && *speed >= 0.0).unwrap_or(1.0).min(1e6)
    }

    fn scan_ns(&self) -> Result<i64, Message> {
        let wrong = || Message::new("debug.scan-time");
        let scan_ns = match &self.scan_time {
            Json::Null => 10_000_000,
            Json::Number(ms) => (ms.as_f64().ok_or_else(wrong)? * 1e6) as i64,
            Json::String(word) => duration(word).ok_or_else(wrong)?,
            _ => return Err(wrong()),
        };
        match scan_ns {
            1_000..=60_000_000_000 => Ok(scan_ns),
            _ => Err(wrong()),
        }
    }

    /// What is set before which scan.
    fn settings(&self, program: &Program, scan_ns: i64) -> Result<Vec<(u64, Touch)>, Message> {
        let wrong = |word: &str| Message::new("debug.setting").with("word", word);
        let settings: Vec<Setting> = match &self.set {
            Json::Null => Vec::new(),
            Json::Object(members) => {
                let setting = |(name, value): (&String, &Json)| {
                    let value = Value::of_json(value).ok_or_else(|| wrong(name))?;
                    Ok(Setting { name: name.clone(), value, from_ns: 0 })
                };
                members.iter().map(setting).collect::<Result<_, Message>>()?
            }
            Json::Array(words) => {
                let setting = |word: &Json| {
                    let word = word.as_str().unwrap_or_default();
                    Setting::read(word).map_err(|_| wrong(word))
                };
                words.iter().map(setting).collect::<Result<_, Message>>()?
            }
            _ => return Err(wrong("set")),
        };
        let touch = |setting: Setting| {
            let variable = program.code.variable(&setting.name);
            let variable =
                variable.ok_or_else(|| Message::new("cli.run-unknown").with("name", &setting.name))?;
            let touch = variable.set(&program.code, &setting.value);
            let touch = touch.ok_or_else(|| Message::new("cli.run-no-value").with("name", &setting.name))?;
            // The first scan, which is number 1, begins at time 0.
            let scan = (setting.from_ns as u64).div_ceil(scan_ns as u64) + 1;
            Ok((scan, touch))
        };
        settings.into_iter().map(touch).collect()
    }
}
