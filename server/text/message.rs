//! Messages to people: a catalogue key with arguments, put into words of a language at the very end.

use std::collections::HashMap;
use std::sync::LazyLock;

/// A language of the catalogue.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Language {
    /// English.
    #[default]
    English,
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

    /// The words in `language`. A key without an entry shows itself and its arguments, so nothing is lost.
    pub fn render(&self, language: Language) -> String {
        let Some(template) = catalogue(language).get(self.key) else {
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
    }
}

static ENGLISH: LazyLock<HashMap<String, String>> = LazyLock::new(|| {
    read_catalogue(&[
        include_str!("messages/en/drawing.toml"),
        include_str!("messages/en/words.toml"),
        include_str!("messages/en/order.toml"),
        include_str!("messages/en/declarations.toml"),
        include_str!("messages/en/ide.toml"),
        include_str!("messages/en/cli.toml"),
    ])
});

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
