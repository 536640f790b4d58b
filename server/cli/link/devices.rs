//! `rungwise write` and `rungwise force`

use super::Connection;
use super::connection::failed;
use crate::cli::Outcome;
use crate::cli::input::complain;
use crate::link::Point;
use crate::simulate::Setting;
use crate::target::Target;
use crate::text::{Language, Message};
use std::path::Path;

#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// What gets which value: D0=5, D2:32=100000, T0=0, M5=on.
    #[arg(required = true, value_name = "DEVICE=VALUE")]
    settings: Vec<String>,
    #[command(flatten)]
    connection: Connection,
}

/// Writes registers, current values and relays.
pub(in crate::cli) fn write(arguments: &Arguments, language: Language) -> Outcome {
    carry_out(arguments, false, language).unwrap_or_else(|outcome| outcome)
}

/// Switches relays.
pub(in crate::cli) fn force(arguments: &Arguments, language: Language) -> Outcome {
    carry_out(arguments, true, language).unwrap_or_else(|outcome| outcome)
}

fn carry_out(arguments: &Arguments, is_forced: bool, language: Language) -> Result<Outcome, Outcome> {
    // What cannot be read is said before somebody is called.
    read(&arguments.settings, language)?;
    let mut host = arguments.connection.open(Path::new("."), language)?;
    let target = host.identity().target;
    // All are looked at before one is written.
    for (point, value) in settings_of(&arguments.settings, is_forced, target, language)? {
        host.write(point, value).map_err(|error| failed(&error, language))?;
    }
    Ok(Outcome::Clean)
}

fn refused(reason: &Message, language: Language) -> Outcome {
    let help = Message::new("link.help-values").render(language);
    complain("bad-value", &reason.render(language), &help, language);
    Outcome::Unusable
}

fn read(words: &[String], language: Language) -> Result<Vec<Setting>, Outcome> {
    let read = words.iter().map(|word| match Setting::read(word) {
        Ok(setting) if setting.name.is_empty() => Err(Message::new("link.nameless")),
        read => read,
    });
    read.collect::<Result<_, _>>().map_err(|reason| refused(&reason, language))
}

/// Which points get which numbers, of words such as `D0=5`.
///
/// # Errors
/// With the outcome, after a complaint about the first that this PLC cannot have, or that nobody may write.
pub(super) fn settings_of(
    words: &[String],
    is_forced: bool,
    target: &Target,
    language: Language,
) -> Result<Vec<(Point, i64)>, Outcome> {
    let settings = read(words, language)?;
    let written = settings.iter().map(|setting| {
        let (point, value) =
            written(setting, is_forced, target).map_err(|reason| refused(&reason, language))?;
        point.check_written(target).map_err(|error| failed(&error, language))?;
        Ok((point, value))
    });
    written.collect()
}

/// Which point gets which number.
fn written(setting: &Setting, is_forced: bool, target: &Target) -> Result<(Point, i64), Message> {
    let name = &setting.name;
    let unknown = || Message::new("link.no-device").with("device", name);
    let point = Point::named(name, target).ok_or_else(unknown)?;
    if is_forced && !point.is_bit() {
        return Err(Message::new("link.no-relay").with("device", name));
    }
    if setting.from_ns > 0 {
        return Err(Message::new("link.no-moment").with("device", name));
    }
    let wrong = || Message::new("link.no-value").with("device", name).with("value", &setting.value);
    point.number(&setting.value).map(|value| (point, value)).ok_or_else(wrong)
}
