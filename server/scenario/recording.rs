//! Writes scenario tests: of what was done to a running program, and of counterexamples.

use super::driver::is_output;
use super::suite::{Input, InputKind, Named};
use super::witness::{USUAL_SCAN_NS, is_first_scan};
use super::{Bench, SUITE_ENDING, Scenario};
use crate::simulate::{Code, Value, milliseconds};
use crate::target::Port;
use crate::text::{Language, Message, Span};
use crate::translate::{Counterexample, Value as Held};
use std::collections::BTreeMap;
use std::fmt::Write;

/// What was done to a program while it ran, scan by scan.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Recording {
    /// Before which scan, from 0 on, which variable was set, forced or let go.
    touches: Vec<(u64, String, InputKind)>,
}

/// A scenario test that was written of a recording.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Recorded {
    /// The text of the file.
    pub text: String,
    /// What the file could be called.
    pub name: String,
}

/// More lines of expectations are not recorded.
const MOST_STEPS: usize = 1000;

impl Recording {
    /// Something is done before scan number `scan`, from 0 on.
    pub fn note(&mut self, scan: u64, name: &str, kind: InputKind) {
        self.touches.push((scan, name.to_string(), kind));
    }

    /// All that is forced is let go before scan number `scan`.
    pub fn release_all(&mut self, scan: u64) {
        let mut forced: Vec<&str> = Vec::new();
        for (_, name, kind) in &self.touches {
            forced.retain(|known| !known.eq_ignore_ascii_case(name));
            if matches!(kind, InputKind::Force(_)) {
                forced.push(name);
            }
        }
        let released = forced.into_iter().map(|name| (scan, name.to_string(), InputKind::Release));
        self.touches.extend(released.collect::<Vec<_>>());
    }

    /// Only the first `scans` scans did happen.
    pub fn back_to(&mut self, scans: u64) {
        self.touches.retain(|(own, ..)| *own < scans);
    }

    /// Whether nothing was done.
    pub fn is_empty(&self) -> bool {
        self.touches.is_empty()
    }

    /// The scenario test of what was done in the scans before number `scans`, each `scan_ns` after the other, with the
    /// program called `program`. What is expected are the changes of `names`, of the outputs where there are no names:
    /// as the program makes them from its start.
    pub fn written(
        &self,
        (program, bench): (&str, &Bench),
        (scans, scan_ns): (u64, i64),
        names: &[String],
        language: Language,
    ) -> Recorded {
        let code = bench.code();
        let named = |name: &str| Named { name: name.to_string(), span: Span::default() };
        let inputs = self.touches.iter().filter(|(scan, ..)| *scan < scans).map(|(scan, name, kind)| Input {
            scan: *scan,
            name: named(name),
            kind: kind.clone(),
        });
        let inputs: Vec<Input> = inputs.collect();
        let outputs = self.outputs(code, names);
        let sent = code.target.is_fx().then(|| Port::Sent.to_string());
        let stem = program.rsplit_once('.').map_or(program, |(stem, _)| stem);
        let scenario = Scenario {
            name: String::new(),
            span: Span::default(),
            scan_ns,
            last: Some(scans.saturating_sub(1)),
            checks: Vec::new(),
            watch: outputs.iter().chain(&sent).map(|name| named(name)).collect(),
            golden: None,
            tolerance: 0,
            deviation: 0.0,
            allows_errors: true,
            inputs: inputs.clone(),
        };
        let mut steps: BTreeMap<u64, Vec<Step>> = BTreeMap::new();
        for input in inputs {
            let own = steps.entry(input.scan).or_default();
            match own.last_mut().filter(|step| step.takes(&input)) {
                Some(step) => step.add(input),
                None => {
                    let mut step = Step::default();
                    step.add(input);
                    own.push(step);
                }
            }
        }
        let (mut is_truncated, mut has_errors) = (false, false);
        if let Ok(report) = bench.run(&scenario, None, None) {
            has_errors = report.has_errors;
            let trace = report.trace;
            let mut before: Option<&[Value]> = None;
            let sent = trace.names.iter().position(|name| Some(name) == sent.as_ref());
            for row in &trace.rows {
                if let Some(Value::Text(frame)) = sent.map(|sent| &row.values[sent])
                    && !frame.is_empty()
                {
                    let own = steps.entry(row.scan).or_default();
                    let mut last = own.pop().unwrap_or_default();
                    last.sent = Some(frame_told(frame));
                    own.push(last);
                }
                for (number, name) in
                    trace.names.iter().enumerate().filter(|(_, name)| outputs.contains(name))
                {
                    let value = &row.values[number];
                    if before.is_some_and(|before| before[number] == *value) {
                        continue;
                    }
                    if steps.len() > MOST_STEPS && !steps.contains_key(&row.scan) {
                        is_truncated = true;
                        continue;
                    }
                    let own = steps.entry(row.scan).or_default();
                    let mut last = own.pop().unwrap_or_default();
                    last.expect.push((name.clone(), value.clone()));
                    own.push(last);
                }
                before = Some(&row.values);
            }
        }
        let mut text = format!("program = {}\n", quoted(program));
        let _ = writeln!(text, "scan-time = \"{}ms\"\n", milliseconds(scan_ns));
        let _ = writeln!(text, "[[scenario]]\nname = {}", quoted(stem));
        let last_ns = (scans.saturating_sub(1) as i64).saturating_mul(scan_ns);
        if has_errors {
            text.push_str("allow-errors = true\n");
        }
        let _ = writeln!(text, "time = \"{}ms\"\nsteps = [", milliseconds(last_ns));
        for (scan, step) in steps.iter().flat_map(|(scan, own)| own.iter().map(move |step| (scan, step))) {
            let at_ns = (*scan as i64).saturating_mul(scan_ns);
            let _ = writeln!(text, "  {{ at = \"{}ms\"{} }},", milliseconds(at_ns), step.told());
        }
        if is_truncated {
            let _ = writeln!(text, "  # {}", Message::new("scenario.recorded-truncated").render(language));
        }
        text.push_str("]\n");
        Recorded { text, name: format!("{stem}{SUITE_ENDING}") }
    }

    /// The variables whose changes are expected: `names`, else the outputs, else all bits that nobody set.
    fn outputs(&self, code: &Code, names: &[String]) -> Vec<String> {
        let is_touched =
            |name: &String| self.touches.iter().any(|(_, own, _)| own.eq_ignore_ascii_case(name));
        let named: Vec<String> = names.iter().filter(|name| code.variable(name).is_some()).cloned().collect();
        let all = code.named();
        let is_free = |name: &&String| !is_touched(name);
        if !named.is_empty() {
            return named;
        }
        let outputs: Vec<String> = all.iter().filter(|name| is_output(name)).cloned().collect();
        if outputs.is_empty() { all.iter().filter(is_free).cloned().collect() } else { outputs }
    }
}

/// What is done and expected at one time. A scenario sets before it forces, and forces before it lets go.
#[derive(Default)]
struct Step {
    set: Vec<(String, Value)>,
    /// Frames that the serial port receives, as TOML.
    receive: Vec<String>,
    force: Vec<(String, Value)>,
    release: Vec<String>,
    /// Frames that it sends, of which a step has one.
    sent: Option<String>,
    expect: Vec<(String, Value)>,
}

impl Step {
    /// Whether something may be done in this step behind what is done already: to one name in the order of the step.
    fn takes(&self, input: &Input) -> bool {
        let is_own = |name: &String| name.eq_ignore_ascii_case(&input.name.name);
        let is_in = |all: &[(String, Value)]| all.iter().any(|(name, _)| is_own(name));
        let is_released = self.release.iter().any(is_own);
        match input.kind {
            // Pulses add up, and a table has one value of a name.
            InputKind::Set(_) if is_in(&self.set) && input.name.name.ends_with(PULSES) => false,
            InputKind::Set(_) => !is_released && !is_in(&self.force),
            InputKind::Force(_) => !is_released,
            InputKind::Release => true,
        }
    }

    /// Of several values of one name the last one counts.
    fn add(&mut self, input: Input) {
        let name = input.name.name;
        let (all, value) = match input.kind {
            InputKind::Set(Value::Text(frame) | Value::Name(frame) | Value::Word(frame, _))
                if name.eq_ignore_ascii_case(&Port::Received.to_string()) =>
            {
                return self.receive.push(frame_told(&frame));
            }
            InputKind::Set(value) => (&mut self.set, value),
            InputKind::Force(value) => (&mut self.force, value),
            InputKind::Release => return self.release.push(name),
        };
        all.retain(|(known, _)| !known.eq_ignore_ascii_case(&name));
        all.push((name, value));
    }

    fn told(&self) -> String {
        let mut text = String::new();
        let lists = [("set", &self.set), ("force", &self.force), ("expect", &self.expect)];
        for (key, values) in lists.into_iter().filter(|(_, values)| !values.is_empty()) {
            let _ = write!(
                text,
                ", {key} = {{ {} }}",
                pairs(values.iter().map(|(name, value)| (name, word(value))))
            );
        }
        match self.receive.as_slice() {
            [] => {}
            [frame] => _ = write!(text, ", receive = {frame}"),
            frames => _ = write!(text, ", receive = [{}]", frames.join(", ")),
        }
        if let Some(frame) = &self.sent {
            let _ = write!(text, ", sent = {frame}");
        }
        if !self.release.is_empty() {
            let names: Vec<String> = self.release.iter().map(|name| quoted(name)).collect();
            let _ = write!(text, ", release = [{}]", names.join(", "));
        }
        text
    }
}

/// What the names of pulses end in.
const PULSES: &str = ".pulses";

/// A frame as TOML: a text where all of it can be seen, else its bytes.
fn frame_told(frame: &str) -> String {
    if frame.chars().all(|character| character.is_ascii() && !character.is_ascii_control()) {
        return quoted(frame);
    }
    let bytes: Vec<String> = frame.chars().map(|byte| format!("0x{:02X}", byte as u32)).collect();
    format!("[{}]", bytes.join(", "))
}

/// A value as TOML.
fn word(value: &Value) -> String {
    match value.json() {
        serde_json::Value::Bool(on) => u8::from(on).to_string(),
        serde_json::Value::Number(number) if number.is_i64() => number.to_string(),
        _ => quoted(&value.to_string()),
    }
}

/// `X0 = 1, "%QX0.0" = 0`. Of several values of one name the last one counts.
fn pairs<'n>(values: impl Iterator<Item = (&'n String, String)>) -> String {
    let mut told: Vec<(&String, String)> = Vec::new();
    for (name, value) in values {
        match told.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => *known = value,
            None => told.push((name, value)),
        }
    }
    told.iter().map(|(name, value)| format!("{} = {value}", key(name))).collect::<Vec<_>>().join(", ")
}

/// A name as a key of TOML: quoted where it is no bare word.
fn key(name: &str) -> String {
    let is_bare = !name.is_empty()
        && name.chars().all(|letter| letter.is_ascii_alphanumeric() || "_-".contains(letter));
    if is_bare { name.to_string() } else { quoted(name) }
}

/// A word in quotes, as TOML and JSON write it.
fn quoted(word: &str) -> String {
    serde_json::Value::from(word).to_string()
}

/// A scenario test that the first of two programs passes and the second fails, if the simulated PLC shows how; `names`
/// are those of their files.
pub fn of_counterexample(found: &Counterexample, names: &[String; 2], language: Language) -> Option<String> {
    let run = found.run()?;
    let held = |value: &Held| match value {
        Held::Bit(value) => u8::from(*value).to_string(),
        Held::Time(_) | Held::Named(_) => quoted(&value.to_string()),
        Held::Word(_) | Held::Real(_) => value.to_string(),
    };
    let told = Message::new("scenario.counterexample")
        .with("what", &found.what)
        .with("left", &found.sides[0])
        .with("right", &found.sides[1])
        .with("first", &names[0])
        .with("second", &names[1]);
    let first = run.lead + u64::from(!found.before.is_empty());
    let mut steps: BTreeMap<u64, Vec<String>> = BTreeMap::new();
    let mut add = |scan: u64, key: &str, values: String| {
        if !values.is_empty() {
            steps.entry(scan).or_default().push(format!("{key} = {{ {values} }}"));
        }
    };
    let before = found.before.iter().map(|(name, value)| (name, held(value)));
    add(run.lead, "set", pairs(before));
    let inputs = found.inputs.iter().filter(|(name, _)| is_first_scan(name).is_none());
    add(first, "set", pairs(inputs.map(|(name, value)| (name, held(value)))));
    add(first + run.hold, "expect", pairs(std::iter::once((&found.what, held(&found.sides[0])))));
    let mut text = format!("# {}\n", told.render(language));
    let _ = writeln!(text, "program = {}", quoted(&names[0].replace('\\', "/")));
    if run.scan_ns != USUAL_SCAN_NS {
        let _ = writeln!(text, "scan-time = \"{}ms\"", milliseconds(run.scan_ns));
    }
    let _ = writeln!(text, "\n[[scenario]]\nname = {}\nsteps = [", quoted(&found.what));
    for (scan, parts) in steps {
        let at = if scan == 1 { "1 scan".to_string() } else { format!("{scan} scans") };
        let _ = writeln!(text, "  {{ at = \"{at}\", {} }},", parts.join(", "));
    }
    text.push_str("]\n");
    Some(text)
}
