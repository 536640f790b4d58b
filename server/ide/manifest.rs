//! Help in `rungwise.toml` and in scenario tests: what their keys mean, and what could be written. All that it knows is
//! in the schemas.

use super::completion::is_abbreviation;
use super::{Completion, CompletionKind, Hover};
use crate::check::Rule;
use crate::text::{Language, Message, Span, TextEdit, phrase};

mod schema;
pub use schema::{FileKind, Schema};
use schema::{Kind, Node};

mod site;
use site::{Reading, Site};

/// The table in which the severities of rules are: their descriptions are those of the rules.
const RULES: &str = "rules";

/// What the key, the table or the value at `offset` means.
pub fn manifest_hover(schema: Schema, text: &str, offset: usize, language: Language) -> Option<Hover> {
    let (path, span) = match Reading::of(text, offset).site {
        Site::Header { path, word, .. } => (path, word),
        Site::Key { table, before, word, .. } => {
            ([&table[..], &before[..], &[word.of(text).to_string()]].concat(), word)
        }
        Site::Value { path, word, .. } => (path, word),
        Site::Nowhere => return None,
    };
    let node = schema.at(&path)?;
    let name = path.last().filter(|_| span.start < span.end)?;
    let mut markdown = format!("`{name}`\n\n{}", description(&path, node, language));
    let mut say = |message: Message| {
        markdown.push_str("\n\n");
        markdown.push_str(&message.render(language));
    };
    let words = node.words();
    if !words.is_empty() {
        let words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        say(Message::new("manifest-help.values").with_words("values", words, ", "));
    }
    if let Some(default) = node.default() {
        say(Message::new("manifest-help.default").with("value", format!("`{default}`")));
    } else if let Some(rule) = rule_at(&path) {
        let severity = format!("`{}`", rule.severity.word());
        say(Message::new("manifest-help.default").with("value", severity));
    }
    if let Some(example) = node.examples().first().filter(|_| node.words().is_empty()) {
        say(Message::new("manifest-help.example").with("value", format!("`{example}`")));
    }
    Some(Hover { span, markdown })
}

/// What could be written at `offset`: tables, keys that are not there yet, values. `files` is asked where a value names
/// one: for the names of the files of a kind, from the manifest's folder, with `/`.
pub fn manifest_completions(
    schema: Schema,
    text: &str,
    offset: usize,
    files: &dyn Fn(FileKind) -> Vec<String>,
    language: Language,
) -> Vec<Completion> {
    let reading = Reading::of(text, offset);
    let mut found = List { schema, text, offset, language, found: Vec::new() };
    match &reading.site {
        Site::Header { span, .. } => found.tables(&reading, *span),
        Site::Key { table, before, word, has_value, starts_line } => {
            let path = [&table[..], &before[..]].concat();
            found.keys(&reading, &path, *word, *has_value);
            if *starts_line && before.is_empty() {
                found.tables(&reading, *word);
            }
        }
        Site::Value { path, word, is_quoted, in_list } => {
            if let Some(node) = schema.at(path) {
                found.values(&reading, path, node, (*word, *is_quoted, *in_list), files);
            }
        }
        Site::Nowhere => {}
    }
    found.found
}

fn rule_at(path: &[String]) -> Option<&'static Rule> {
    match path {
        [table, code] if table == RULES => Rule::named(code),
        _ => None,
    }
}

/// What a key is for; of a rule the first sentence of its page.
fn description(path: &[String], node: Node, language: Language) -> String {
    match rule_at(path) {
        Some(rule) => rule.summary(language),
        None => phrase(node.description(), language).to_string(),
    }
}

/// The proposals so far.
struct List<'t> {
    schema: Schema,
    text: &'t str,
    offset: usize,
    language: Language,
    found: Vec<Completion>,
}

impl List<'_> {
    /// Proposes to write `text` at `span` unless what is typed there says otherwise. `name` is what people type for it.
    fn propose(&mut self, name: &str, span: Span, kind: CompletionKind, documentation: String, text: String) {
        let typed = self.text.get(span.start as usize..self.offset).unwrap_or("");
        if !is_abbreviation(typed.trim_start_matches('['), name.trim_start_matches('[')) {
            return;
        }
        let is_table = kind == CompletionKind::Type;
        let rank = u16::try_from(self.found.len()).unwrap_or(u16::MAX);
        self.found.push(Completion {
            label: name.to_string(),
            // With the bracket typed it is a part of what is compared.
            filter: if is_table && !typed.starts_with('[') {
                name.trim_matches(['[', ']']).to_string()
            } else {
                String::new()
            },
            kind,
            detail: String::new(),
            documentation,
            is_snippet: kind == CompletionKind::Keyword,
            edit: TextEdit::new(span, text),
            rank: rank.saturating_add(if is_table { 1000 } else { 0 }),
        });
    }

    /// The tables that may begin on a line of their own.
    fn tables(&mut self, reading: &Reading, span: Span) {
        for (name, node) in self.schema.root().properties() {
            let label = match node.kind() {
                Kind::Table if !reading.has_table(name) => format!("[{name}]"),
                Kind::Tables => format!("[[{name}]]"),
                _ => continue,
            };
            let path = [name.to_string()];
            let documentation = description(&path, node, self.language);
            self.propose(&label, span, CompletionKind::Type, documentation, label.clone());
        }
    }

    /// The keys of the table at `path`. A table of the root is written under a header of its own.
    fn keys(&mut self, reading: &Reading, path: &[String], word: Span, has_value: bool) {
        let Some(table) = self.schema.at(path) else { return };
        for (name, node) in table.element().properties() {
            let own = [path, &[name.to_string()]].concat();
            if matches!(node.kind(), Kind::Table | Kind::Tables) || reading.has_key(&own) {
                continue;
            }
            let documentation = description(&own, node, self.language);
            let is_quoted = self.text[..word.start as usize].ends_with(['"', '\'']);
            let is_whole = has_value || is_quoted;
            let text = if is_whole { name.to_string() } else { format!("{name} = {}", template(node)) };
            self.propose(name, word, CompletionKind::Keyword, documentation, text);
        }
    }

    fn values(
        &mut self,
        reading: &Reading,
        path: &[String],
        node: Node,
        (word, is_quoted, in_list): (Span, bool, bool),
        files: &dyn Fn(FileKind) -> Vec<String>,
    ) {
        let is_list = node.kind() == Kind::List;
        let element = if is_list { node.element() } else { node };
        let names = element.files().map(files).unwrap_or_default();
        let listed = reading.listed(path);
        let names = names.iter().map(String::as_str).filter(|name| !listed.contains(name));
        let words: Vec<&str> = element.words().into_iter().chain(names).collect();
        for value in &words {
            let text = match (is_quoted, is_list && !in_list) {
                (true, _) => value.to_string(),
                (false, false) => quoted(value),
                (false, true) => format!("[{}]", quoted(value)),
            };
            self.propose(value, word, CompletionKind::Constant, String::new(), text);
        }
        // Without words to choose from, what others write is a start.
        if words.is_empty() && !is_quoted && !in_list {
            for value in node.default().into_iter().chain(node.examples()) {
                self.propose(&value, word, CompletionKind::Constant, String::new(), value.clone());
            }
        }
    }
}

/// What stands behind the `=` of a new key, as a snippet.
fn template(node: Node) -> String {
    let words = node.words();
    match node.kind() {
        _ if !words.is_empty() => format!("\"${{1|{}|}}\"", words.join(",")),
        Kind::List => "[\"$1\"]".to_string(),
        Kind::Inline => "{ $1 }".to_string(),
        Kind::Inlines => "[\n  { $1 },\n]".to_string(),
        Kind::Truth => "${1|true,false|}".to_string(),
        Kind::Number => format!("${{1:{}}}", node.default().unwrap_or_else(|| "0".to_string())),
        _ => "\"$1\"".to_string(),
    }
}

fn quoted(value: &str) -> String {
    // A backslash would begin an escape, which a literal string does not know.
    if value.contains(['\\', '"']) { format!("'{value}'") } else { format!("\"{value}\"") }
}
