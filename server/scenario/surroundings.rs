//! What steps say of the surroundings of the CPU in words of their own: frames of the serial port, trains of pulses.

use super::steps::Clock;
use super::table::{Entry, Reading};
use crate::simulate::duration;
use crate::text::Message;
use smol_str::SmolStr;
use toml::de::DeValue;

/// A frame: a text whose characters are its bytes, or a list of these.
pub(super) fn frame(reading: &mut Reading<'_>, entry: Entry<'_>) -> Option<SmolStr> {
    let frame = match entry.value {
        DeValue::String(text) => {
            text.chars().all(|letter| u8::try_from(letter).is_ok()).then(|| text.as_ref().into())
        }
        DeValue::Array(_) => {
            let bytes = reading.list_of(entry);
            bytes
                .into_iter()
                .map(|byte| number(byte.value).and_then(|byte| u8::try_from(byte).ok()))
                .map(|byte| byte.map(char::from))
                .collect()
        }
        _ => None,
    };
    if frame.is_none() {
        reading.flaw(entry.span, Message::new("scenario.frame"));
    }
    frame
}

/// A frame, or a list of them.
pub(super) fn frames(reading: &mut Reading<'_>, entry: Entry<'_>) -> Vec<SmolStr> {
    let is_list =
        entry.value.as_array().is_some_and(|list| list.iter().any(|item| number(item.get_ref()).is_none()));
    match is_list {
        true => reading.list_of(entry).into_iter().filter_map(|item| frame(reading, item)).collect(),
        false => frame(reading, entry).into_iter().collect(),
    }
}

/// Pulses that arrive: so many at once, or so many in a second for a time.
pub(super) enum Train {
    Count(i64),
    Frequency { hertz: f64, lasts_ns: i64 },
}

impl Train {
    /// What stands behind the name of an input: `40`, `"2kHz for 500ms"`.
    pub(super) fn read(reading: &mut Reading<'_>, entry: Entry<'_>, clock: Clock) -> Option<Train> {
        let train = match entry.value {
            DeValue::String(word) => Train::written(word),
            value => number(value).map(Train::Count),
        };
        let Some(train) = train else {
            reading.flaw(entry.span, Message::new("scenario.pulses"));
            return None;
        };
        let is_short = match train {
            Train::Frequency { lasts_ns, .. } => clock.is_within_reach(reading, entry.span, lasts_ns),
            Train::Count(_) => true,
        };
        is_short.then_some(train)
    }

    fn written(word: &str) -> Option<Train> {
        let (frequency, lasts) = word.split_once("for")?;
        let frequency = frequency.trim().to_ascii_lowercase();
        let (number, factor) = match frequency.strip_suffix("khz") {
            Some(number) => (number, 1e3),
            None => (frequency.strip_suffix("hz")?, 1.0),
        };
        let hertz = number.trim().parse::<f64>().ok()? * factor;
        let is_possible = hertz.abs() <= MOST_HERTZ;
        is_possible.then_some(Train::Frequency { hertz, lasts_ns: duration(lasts)? })
    }

    /// The pulses before each scan, beginning with the first.
    pub(super) fn counts(&self, clock: Clock) -> Vec<i64> {
        match *self {
            Train::Count(count) => vec![count],
            Train::Frequency { hertz, lasts_ns } => {
                let scan_ns = clock.scan_ns;
                let until = |time_ns: i64| (hertz * time_ns.min(lasts_ns) as f64 / 1e9).trunc() as i64;
                // What arrives in the time before a scan is counted in it.
                let scans = 1..=clock.first(lasts_ns) as i64;
                let counts = scans.map(|scan| until(scan * scan_ns) - until((scan - 1) * scan_ns));
                std::iter::once(0).chain(counts).collect()
            }
        }
    }
}

/// No input takes faster pulses: those of the high-speed adapters of an FX3U take 200 kHz.
const MOST_HERTZ: f64 = 200_000.0;

fn number(value: &DeValue<'_>) -> Option<i64> {
    match value {
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix()).ok(),
        _ => None,
    }
}
