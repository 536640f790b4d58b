//! Messages to people: a catalogue key with arguments, put into words of a language at the very end.

use super::translation::phrase;
use std::collections::HashMap;
use std::sync::LazyLock;

/// A language of the catalogue.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// Simplified Chinese.
    SimplifiedChinese,
}

impl Language {
    /// Every language of the catalogue; the first is the one that has every key.
    pub const ALL: &'static [Language] = &[Language::English, Language::SimplifiedChinese];

    /// As a language tag (BCP 47): also the folder of its catalogue.
    pub fn tag(self) -> &'static str {
        match self {
            Language::English => "en",
            Language::SimplifiedChinese => "zh-CN",
        }
    }

    /// The language for a locale such as `zh-CN`, `zh_CN.UTF-8`, `zh-hans`, `de`. Chinese of any script is better
    /// served by the simplified one than by English.
    pub fn of_locale(locale: &str) -> Language {
        let primary = locale.split(['-', '_', '.', '@']).next().unwrap_or_default();
        if primary.eq_ignore_ascii_case("zh") { Language::SimplifiedChinese } else { Language::English }
    }
}

/// A message that can be rendered in any language of the catalogue.
///
/// The key is `section.name` of `server/text/messages/<language>/*.toml`; arguments fill `{name}` in its template.
/// A test holds every key in the sources to an entry of the catalogue.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Message {
    key: &'static str,
    arguments: Vec<(&'static str, Argument)>,
}

/// What fills a place of a template. Words that differ from language to language are kept as what they say.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
enum Argument {
    /// A name, a number, a piece of program.
    Word(String),
    /// English words of a table, such as the meaning of an operand.
    Phrase(&'static str),
    /// English words of a table and pieces of program, with what stands between them.
    Words(Vec<String>, &'static str),
    /// The same, of which one is meant.
    Alternatives(Vec<String>),
    /// Messages, joined as a list.
    Messages(Vec<Message>),
}

impl Message {
    /// The message `key` without arguments.
    pub fn new(key: &'static str) -> Message {
        Message { key, arguments: Vec::new() }
    }

    /// With `{name}` standing for `value`.
    pub fn with(mut self, name: &'static str, value: impl ToString) -> Message {
        self.arguments.push((name, Argument::Word(value.to_string())));
        self
    }

    /// With `{name}` standing for English words of the tables of instructions, functions and devices.
    pub fn with_phrase(mut self, name: &'static str, words: &'static str) -> Message {
        self.arguments.push((name, Argument::Phrase(words)));
        self
    }

    /// With `{name}` standing for words of the tables and pieces of program in one row, `separator` between them.
    pub fn with_words<W: Into<String>>(
        mut self,
        name: &'static str,
        words: impl IntoIterator<Item = W>,
        separator: &'static str,
    ) -> Message {
        self.arguments.push((name, Argument::Words(words.into_iter().map(W::into).collect(), separator)));
        self
    }

    /// With `{name}` standing for one of `words`: words of the tables and pieces of program, as a list with `or`.
    pub fn with_alternatives<W: Into<String>>(
        mut self,
        name: &'static str,
        words: impl IntoIterator<Item = W>,
    ) -> Message {
        self.arguments.push((name, Argument::Alternatives(words.into_iter().map(W::into).collect())));
        self
    }

    /// With `{name}` standing for `messages`, as a list in the way of the language.
    pub fn with_messages(mut self, name: &'static str, messages: Vec<Message>) -> Message {
        self.arguments.push((name, Argument::Messages(messages)));
        self
    }

    /// The same arguments in another sentence.
    pub fn under(self, key: &'static str) -> Message {
        Message { key, ..self }
    }

    /// The catalogue key.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// The words in `language`, else in English. A key without any entry shows itself and its arguments, so nothing
    /// is lost.
    pub fn render(&self, language: Language) -> String {
        let entry = catalogue(language).get(self.key).or_else(|| catalogue(Language::English).get(self.key));
        let Some(template) = entry else {
            let arguments: Vec<String> =
                self.arguments.iter().map(|(_, value)| value.render(language)).collect();
            return format!("{} {}", self.key, arguments.join(", ")).trim_end().to_string();
        };
        let mut words = String::with_capacity(template.len() + 32);
        let mut rest = template.as_str();
        while let Some(open) = rest.find('{') {
            words.push_str(&rest[..open]);
            rest = &rest[open..];
            let end = rest.find('}').map_or(rest.len(), |close| close + 1);
            let name = rest[..end].trim_matches(['{', '}']);
            match self.arguments.iter().find(|(argument, _)| *argument == name) {
                Some((_, Argument::Word(word))) => words.push_str(word),
                Some((_, value)) => words.push_str(&value.render(language)),
                None => words.push_str(&rest[..end]),
            }
            rest = &rest[end..];
        }
        words.push_str(rest);
        words
    }
}

impl Argument {
    fn render(&self, language: Language) -> String {
        match self {
            Argument::Word(word) => word.clone(),
            Argument::Phrase(words) => phrase(words, language).to_string(),
            Argument::Words(words, separator) => {
                let separator = if *separator == ", " { list_separator(language) } else { separator };
                let words: Vec<&str> = words.iter().map(|word| phrase(word, language)).collect();
                words.join(separator)
            }
            Argument::Alternatives(words) => {
                let words: Vec<&str> = words.iter().map(|word| phrase(word, language)).collect();
                match words.split_last() {
                    Some((last, others)) if !others.is_empty() => {
                        format!("{}{}{last}", others.join(list_separator(language)), last_separator(language))
                    }
                    _ => words.concat(),
                }
            }
            Argument::Messages(messages) => {
                let words: Vec<String> = messages.iter().map(|message| message.render(language)).collect();
                words.join(list_separator(language))
            }
        }
    }
}

/// What stands between the items of a list of words.
pub fn list_separator(language: Language) -> &'static str {
    match language {
        Language::English => ", ",
        Language::SimplifiedChinese => "、",
    }
}

/// What stands before the last of several possible words.
fn last_separator(language: Language) -> &'static str {
    match language {
        Language::English => " or ",
        Language::SimplifiedChinese => " 或 ",
    }
}

/// All keys of `language`, with their templates.
pub fn catalogue_keys(language: Language) -> impl Iterator<Item = (&'static str, &'static str)> {
    catalogue(language).iter().map(|(key, template)| (key.as_str(), template.as_str()))
}

fn catalogue(language: Language) -> &'static HashMap<String, String> {
    match language {
        Language::English => &ENGLISH,
        Language::SimplifiedChinese => &SIMPLIFIED_CHINESE,
    }
}

/// The catalogue of the language in the folder `$tag`: the same area files in every language.
macro_rules! catalogue_in {
    ($tag:literal) => {
        LazyLock::new(|| {
            read_catalogue(&[
                include_str!(concat!("messages/", $tag, "/drawing.toml")),
                include_str!(concat!("messages/", $tag, "/hand.toml")),
                include_str!(concat!("messages/", $tag, "/words.toml")),
                include_str!(concat!("messages/", $tag, "/machine-code.toml")),
                include_str!(concat!("messages/", $tag, "/order.toml")),
                include_str!(concat!("messages/", $tag, "/declarations.toml")),
                include_str!(concat!("messages/", $tag, "/sense.toml")),
                include_str!(concat!("messages/", $tag, "/proof.toml")),
                include_str!(concat!("messages/", $tag, "/simulate.toml")),
                include_str!(concat!("messages/", $tag, "/scenario.toml")),
                include_str!(concat!("messages/", $tag, "/link.toml")),
                include_str!(concat!("messages/", $tag, "/debug.toml")),
                include_str!(concat!("messages/", $tag, "/ide.toml")),
                include_str!(concat!("messages/", $tag, "/devices.toml")),
                include_str!(concat!("messages/", $tag, "/cli.toml")),
                include_str!(concat!("messages/", $tag, "/project.toml")),
                include_str!(concat!("messages/", $tag, "/pages.toml")),
                include_str!(concat!("messages/", $tag, "/conversions.toml")),
                include_str!(concat!("messages/", $tag, "/ldmicro.toml")),
                include_str!(concat!("messages/", $tag, "/editing.toml")),
                include_str!(concat!("messages/", $tag, "/translate.toml")),
                include_str!(concat!("messages/", $tag, "/refactor.toml")),
            ])
        })
    };
}

static ENGLISH: LazyLock<HashMap<String, String>> = catalogue_in!("en");

static SIMPLIFIED_CHINESE: LazyLock<HashMap<String, String>> = catalogue_in!("zh-CN");

/// Flattens tables `[section]` with `name = "template"` to `section.name`.
/// A file that is not TOML yields nothing; the test of the catalogue fails on it.
fn read_catalogue(files: &[&str]) -> HashMap<String, String> {
    let mut templates = HashMap::new();
    for file in files {
        let sections: HashMap<String, HashMap<String, String>> = toml::from_str(file).unwrap_or_default();
        for (section, entries) in sections {
            for (name, template) in entries {
                templates.insert(format!("{section}.{name}"), template);
            }
        }
    }
    templates
}
