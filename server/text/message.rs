//! Messages to people: a catalogue key with arguments, put into words of a language at the very end.

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
    arguments: Vec<(&'static str, String)>,
}

impl Message {
    /// The message `key` without arguments.
    pub fn new(key: &'static str) -> Message {
        Message { key, arguments: Vec::new() }
    }

    /// With `{name}` standing for `value`.
    pub fn with(mut self, name: &'static str, value: impl ToString) -> Message {
        self.arguments.push((name, value.to_string()));
        self
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
            let arguments: Vec<&str> = self.arguments.iter().map(|(_, value)| value.as_str()).collect();
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
                Some((_, value)) => words.push_str(value),
                None => words.push_str(&rest[..end]),
            }
            rest = &rest[end..];
        }
        words.push_str(rest);
        words
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
                include_str!(concat!("messages/", $tag, "/words.toml")),
                include_str!(concat!("messages/", $tag, "/order.toml")),
                include_str!(concat!("messages/", $tag, "/declarations.toml")),
                include_str!(concat!("messages/", $tag, "/ide.toml")),
                include_str!(concat!("messages/", $tag, "/devices.toml")),
                include_str!(concat!("messages/", $tag, "/cli.toml")),
                include_str!(concat!("messages/", $tag, "/project.toml")),
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
