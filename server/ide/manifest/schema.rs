//! The schemas of `rungwise.toml` and of scenario tests, the same that editors of TOML get. Tests hold them to what the
//! readers take.

use serde_json::Value;
use std::sync::LazyLock;

static MANIFEST: LazyLock<Value> =
    LazyLock::new(|| read(include_str!("../../../vscode-extension/schemas/rungwise.schema.json")));

static SCENARIOS: LazyLock<Value> =
    LazyLock::new(|| read(include_str!("../../../vscode-extension/schemas/scenarios.schema.json")));

fn read(text: &str) -> Value {
    serde_json::from_str(text)
        .inspect_err(|reason| tracing::error!("a schema cannot be read: {reason}"))
        .unwrap_or_default()
}

/// What a file of TOML is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Schema {
    /// The manifest of a project.
    Manifest,
    /// Scenario tests.
    Scenarios,
}

impl Schema {
    /// The root of the file.
    pub(super) fn root(self) -> Node {
        Node(match self {
            Schema::Manifest => &MANIFEST,
            Schema::Scenarios => &SCENARIOS,
        })
    }

    /// What stands under the keys of `path`; nothing if a file has no such thing.
    pub(super) fn at(self, path: &[String]) -> Option<Node> {
        path.iter().try_fold(self.root(), |node, key| {
            let properties = node.element().0.get("properties")?;
            properties.get(key.as_str()).map(Node)
        })
    }
}

/// A table, a key or a value of the schema.
#[derive(Clone, Copy)]
pub(super) struct Node(&'static Value);

/// What stands under a key.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Table,
    /// Tables of the same name, each under its header.
    Tables,
    List,
    /// A table in braces.
    Inline,
    /// Tables in braces, in a list.
    Inlines,
    Number,
    /// `true` or `false`.
    Truth,
    Text,
}

/// The files that a value of a manifest may name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FileKind {
    /// Program files.
    Program,
    /// Tables, one of which may have the comments of devices.
    Table,
}

impl Node {
    pub fn kind(self) -> Kind {
        match self.0["type"].as_str() {
            Some("object") if self.0["x-inline"] == true => Kind::Inline,
            Some("object") => Kind::Table,
            Some("array") if self.0["x-inline"] == true => Kind::Inlines,
            Some("array") if self.element().0["type"] == "object" => Kind::Tables,
            Some("array") => Kind::List,
            Some("integer" | "number") => Kind::Number,
            Some("boolean") => Kind::Truth,
            _ => Kind::Text,
        }
    }

    /// One of the things in a list; other nodes are their own.
    pub fn element(self) -> Node {
        self.0.get("items").map_or(self, Node)
    }

    pub fn properties(self) -> impl Iterator<Item = (&'static str, Node)> {
        let properties = self.0["properties"].as_object().into_iter().flatten();
        properties.map(|(name, node)| (name.as_str(), Node(node)))
    }

    /// English.
    pub fn description(self) -> &'static str {
        self.0["description"].as_str().unwrap_or("")
    }

    /// The words of which the value is one; none if it may be anything.
    pub fn words(self) -> Vec<&'static str> {
        let shared = self.0["allOf"][0]["$ref"].as_str().and_then(|place| place.strip_prefix('#'));
        let node = shared.and_then(|place| MANIFEST.pointer(place)).unwrap_or(self.0);
        node["enum"].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
    }

    /// The kind of the files that it names.
    pub fn files(self) -> Option<FileKind> {
        match self.0["x-files"].as_str()? {
            "program" => Some(FileKind::Program),
            "table" => Some(FileKind::Table),
            _ => None,
        }
    }

    /// As TOML.
    pub fn default(self) -> Option<String> {
        self.0.get("default").map(Value::to_string)
    }

    /// As TOML: JSON writes strings, numbers and lists of these in the same way.
    pub fn examples(self) -> Vec<String> {
        let examples = self.0["examples"].as_array().into_iter().flatten();
        examples.filter(|example| !example.is_object()).map(Value::to_string).collect()
    }
}
