//! The help of the command line in the user's language.
//!
//! The English text stands at the arguments, as `clap` wants it; other languages translate it as a phrase of the
//! tables. What `clap` says by itself about wrong usage stays English.

use super::Arguments;
use crate::text::{Language, Message, phrase};
use clap::builder::{PossibleValue, PossibleValuesParser, StyledStr};
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, Command, CommandFactory, Error};
use std::ffi::OsString;

/// The same help as `error` shows, in `language`; errors of other kinds as they are.
pub(super) fn translated(error: Error, words: &[OsString], language: Language) -> Error {
    let helps =
        matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand);
    if language == Language::English || !helps {
        return error;
    }
    command(Arguments::command(), language).try_get_matches_from(words).err().unwrap_or(error)
}

/// `command` and all below it with every text in `language`. It serves to show help; what it parses is of no use.
fn command(command: Command, language: Language) -> Command {
    let words = |key: &'static str| Message::new(key).render(language);
    let about = command.get_about().map(|about| text(about, language));
    let template = format!("{{about-with-newline}}\n{} {{usage}}\n\n{{all-args}}", words("help.usage"));
    let mut command = command
        .help_template(template)
        .subcommand_help_heading(words("help.commands"))
        .disable_help_subcommand(true)
        .disable_help_flag(true)
        .disable_version_flag(true)
        .mut_args(|argument| self::argument(argument, language))
        .mut_subcommands(|below| self::command(below, language))
        .arg(flag("help", 'h', ArgAction::Help, words("help.print-help"), words("help.options")));
    if command.get_version().is_some() {
        let (help, heading) = (words("help.print-version"), words("help.options"));
        command = command.arg(flag("version", 'V', ArgAction::Version, help, heading));
    }
    match about {
        Some(about) => command.about(about),
        None => command,
    }
}

fn flag(name: &'static str, short: char, action: ArgAction, help: String, heading: String) -> Arg {
    Arg::new(name).long(name).short(short).action(action).help(help).help_heading(heading)
}

fn argument(argument: Arg, language: Language) -> Arg {
    let heading = if argument.is_positional() { "help.arguments" } else { "help.options" };
    let mut help = argument.get_help().map(|help| text(help, language)).unwrap_or_default();
    let values: Vec<PossibleValue> = argument.get_possible_values();
    let is_listed = argument.get_action().takes_values() && !values.is_empty();
    if is_listed {
        let described = values.iter().map(|value| match value.get_help() {
            Some(help) => Message::new("help.value")
                .with("name", value.get_name())
                .with("help", text(help, language))
                .render(language),
            None => value.get_name().to_string(),
        });
        help += &Message::new("help.possible-values").with_words("values", described, ", ").render(language);
    }
    let defaults: Vec<&str> =
        argument.get_default_values().iter().filter_map(|value| value.to_str()).collect();
    if let [default] = defaults[..]
        && is_listed
    {
        help += &Message::new("help.default").with("value", default).render(language);
    }
    let argument = argument.help(help).help_heading(Message::new(heading).render(language));
    match is_listed {
        // Values with a help of their own would be listed a second time, in English.
        true => argument
            .value_parser(PossibleValuesParser::new(values.iter().map(|value| value.get_name().to_string())))
            .hide_possible_values(true)
            .hide_default_value(true),
        false => argument,
    }
}

fn text(words: &StyledStr, language: Language) -> String {
    phrase(&words.to_string(), language).to_string()
}

#[cfg(test)]
mod tests {
    use super::{Arguments, Command, CommandFactory};
    use crate::text::{Language, has_phrase};

    /// Every text of a command and of those below it.
    fn texts(command: &Command, found: &mut Vec<String>) {
        found.extend(command.get_about().map(ToString::to_string));
        for argument in command.get_arguments() {
            found.extend(argument.get_help().map(ToString::to_string));
            for value in argument.get_possible_values() {
                found.extend(value.get_help().map(ToString::to_string));
            }
        }
        command.get_subcommands().for_each(|below| texts(below, found));
    }

    #[test]
    fn every_text_of_the_help_is_translated() {
        let mut found = Vec::new();
        texts(&Arguments::command(), &mut found);
        assert!(found.len() > 12, "{found:?}");
        let lacking: Vec<&String> =
            found.iter().filter(|text| !has_phrase(text, Language::SimplifiedChinese)).collect();
        assert!(lacking.is_empty(), "{lacking:#?}");
    }
}
