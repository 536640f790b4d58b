//! Which language the command line speaks: what `--lang` says, else that of the environment.

use crate::text::{Language, Message};
use std::ffi::OsString;
use std::sync::OnceLock;

/// The variables that say the language of messages, the first that is not empty counting (POSIX.1-2024, 8.2).
const VARIABLES: [&str; 3] = ["LC_ALL", "LC_MESSAGES", "LANG"];

static SPOKEN: OnceLock<Language> = OnceLock::new();

/// The language that [`choose`] chose, for complaints from places that have no other way to know it.
pub(super) fn spoken() -> Language {
    SPOKEN.get().copied().unwrap_or_default()
}

/// Chooses the language before the arguments are read, for what is wrong with them is said in it.
pub(super) fn choose(arguments: &[OsString]) -> Language {
    let asked = after_lang(arguments).and_then(|name| of_name(&name));
    *SPOKEN.get_or_init(|| asked.unwrap_or_else(of_environment))
}

/// The language called `name` on the command line.
///
/// # Errors
/// A sentence that says which there are.
pub(super) fn named(name: &str) -> Result<Language, String> {
    of_name(name).ok_or_else(|| {
        let names = Language::ALL.iter().map(|language| language.tag());
        Message::new("cli.no-such-language").with_words("names", names, ", ").render(spoken())
    })
}

/// `en`, `zh`, or either with a region or script.
fn of_name(name: &str) -> Option<Language> {
    let primary = name.split(['-', '_']).next()?;
    let known = primary.eq_ignore_ascii_case("en") || primary.eq_ignore_ascii_case("zh");
    known.then(|| Language::of_locale(name))
}

/// The value of the last `--lang`, as the parser of arguments takes it.
fn after_lang(arguments: &[OsString]) -> Option<String> {
    let words: Vec<&str> = arguments.iter().filter_map(|word| word.to_str()).collect();
    let values = words.iter().enumerate().filter_map(|(place, word)| match word.strip_prefix("--lang") {
        Some("") => words.get(place + 1).copied(),
        Some(rest) => rest.strip_prefix('='),
        None => None,
    });
    values.last().map(str::to_string)
}

fn of_environment() -> Language {
    let set = VARIABLES.iter().filter_map(|name| std::env::var(name).ok()).find(|value| !value.is_empty());
    // Where there are no such variables, the system knows the language of its user.
    Language::of_locale(&set.or_else(sys_locale::get_locale).unwrap_or_default())
}
