//! Markdown documents: between the client and the server stands a translator that makes a document of every fence.
//!
//! A fence's document has the lines of the fence at their places and nothing before them, so positions need no
//! translation; only the documents' names do. What a client asks about a place goes to the fence at that place, what
//! it asks about the whole document to all of them, and the answers become one. Everything behind the translator
//! knows nothing of Markdown; as long as no such document is open, messages pass unread.

use crate::document::{Fence, fences};
use crate::text::{Encoding, offset_of_column};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Between the name of a Markdown document and the number of a fence.
pub(super) const MARK: &str = ".fence-";

/// Requests about a whole document, whose answers are lists or can be joined as such.
const WHOLE: &[&str] = &[
    "textDocument/documentSymbol",
    "textDocument/foldingRange",
    "textDocument/semanticTokens/full",
    "textDocument/semanticTokens/full/delta",
    "textDocument/semanticTokens/range",
    "textDocument/formatting",
    "textDocument/rangeFormatting",
    "textDocument/codeLens",
    "textDocument/documentLink",
    "textDocument/inlayHint",
    "textDocument/diagnostic",
];

/// The translator; its clones are one.
#[derive(Clone, Default)]
pub(super) struct Translator {
    state: Arc<Mutex<State>>,
}

#[derive(Default)]
struct State {
    encoding: Encoding,
    documents: HashMap<String, Markdown>,
    /// Requests under way, by the JSON of the id that the server knows.
    pending: HashMap<String, Pending>,
    gatherings: HashMap<u64, Gathering>,
    last: u64,
}

/// An open Markdown document.
struct Markdown {
    text: String,
    version: Value,
    fences: Vec<Open>,
}

/// A fence that the server has open.
struct Open {
    uri: String,
    fence: Fence,
    text: String,
    diagnostics: Vec<Value>,
}

enum Pending {
    /// The answer of one fence is the answer.
    One,
    /// It is one part of several.
    Part { gathering: u64, place: usize },
}

/// Answers of several fences to one request.
struct Gathering {
    id: Value,
    method: String,
    /// First line of each fence, and the line behind its last.
    lines: Vec<(u64, u64)>,
    answers: Vec<Option<Value>>,
}

impl Translator {
    /// What the server gets for a message of the client. `encoding` is asked only if it matters.
    pub(super) fn incoming(&self, body: Vec<u8>, encoding: impl FnOnce() -> Encoding) -> Vec<Vec<u8>> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.documents.is_empty() && !(contains(&body, "didOpen") && contains(&body, "arkdown")) {
            return vec![body];
        }
        let Ok(message) = serde_json::from_slice::<Value>(&body) else { return vec![body] };
        state.encoding = encoding();
        match state.translate(&message) {
            Some(messages) => messages.iter().map(|message| message.to_string().into_bytes()).collect(),
            None => vec![body],
        }
    }

    /// What the client gets for a message of the server.
    pub(super) fn outgoing(&self, body: Vec<u8>) -> Vec<Vec<u8>> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.pending.is_empty() && !contains(&body, MARK) {
            return vec![body];
        }
        let Ok(mut message) = serde_json::from_slice::<Value>(&body) else { return vec![body] };
        match state.translate_back(&mut message) {
            Passage::Same => vec![body],
            Passage::Changed => vec![message.to_string().into_bytes()],
            Passage::Kept => Vec::new(),
        }
    }
}

/// What becomes of a message.
enum Passage {
    Same,
    Changed,
    Kept,
}

impl State {
    /// The messages in the place of one of the client's; nothing if it passes as it is.
    fn translate(&mut self, message: &Value) -> Option<Vec<Value>> {
        let method = message["method"].as_str()?;
        let params = &message["params"];
        let uri = params["textDocument"]["uri"].as_str().or_else(|| named_by_command(params))?.to_string();
        if method == "textDocument/didOpen" {
            let item = &params["textDocument"];
            if item["languageId"] != "markdown" {
                return None;
            }
            let text = item["text"].as_str().unwrap_or("").to_string();
            let document = Markdown { text, version: item["version"].clone(), fences: Vec::new() };
            self.documents.insert(uri.clone(), document);
            return Some(self.refresh(&uri));
        }
        let encoding = self.encoding;
        let document = self.documents.get_mut(&uri)?;
        match method {
            "textDocument/didChange" => {
                document.version = params["textDocument"]["version"].clone();
                for change in params["contentChanges"].as_array().map_or(&[][..], |changes| changes) {
                    apply(&mut document.text, change, encoding);
                }
                Some(self.refresh(&uri))
            }
            "textDocument/didClose" => {
                let document = self.documents.remove(&uri)?;
                Some(document.fences.iter().map(|open| notice(method, &open.uri)).collect())
            }
            "textDocument/didSave" => {
                Some(document.fences.iter().map(|open| notice(method, &open.uri)).collect())
            }
            _ => {
                let id = message.get("id")?.clone();
                self.ask(message, method, &uri, id)
            }
        }
    }

    /// A request about a Markdown document.
    fn ask(&mut self, message: &Value, method: &str, uri: &str, id: Value) -> Option<Vec<Value>> {
        let document = self.documents.get(uri)?;
        if !WHOLE.contains(&method) {
            let params = &message["params"];
            let argument = &params["arguments"][0];
            let places = [
                &params["position"],
                &params["positions"][0],
                &params["range"]["start"],
                &argument["position"],
                &argument["range"]["start"],
            ];
            let line = places.iter().find_map(|place| place["line"].as_u64());
            let mut opens = document.fences.iter();
            // A command without a place is for the first program.
            let open = match line {
                Some(line) => opens.find(|open| within(&open.fence, line)),
                None => opens.next(),
            }?;
            let asked = renamed(message, uri, &open.uri);
            self.pending.insert(id.to_string(), Pending::One);
            return Some(vec![asked]);
        }
        if document.fences.is_empty() {
            return None;
        }
        self.last += 1;
        let gathering = self.last;
        let mut asked = Vec::new();
        for (place, open) in document.fences.iter().enumerate() {
            let part = json!(format!("fence-{gathering}-{place}"));
            let mut question = renamed(message, uri, &open.uri);
            question["id"] = part.clone();
            asked.push(question);
            self.pending.insert(part.to_string(), Pending::Part { gathering, place });
        }
        // The canonical form would lose the indentation that a list needs, so such fences stay as they are.
        let formats = method.ends_with("ormatting");
        let lines = document.fences.iter().map(|open| match formats && open.fence.is_indented {
            true => (u64::MAX, 0),
            false => lines_of(&open.fence),
        });
        let lines = lines.collect();
        let answers = vec![None; asked.len()];
        self.gatherings.insert(gathering, Gathering { id, method: method.to_string(), lines, answers });
        Some(asked)
    }

    /// Opens, changes and closes documents, so that they are the fences of the text.
    fn refresh(&mut self, uri: &str) -> Vec<Value> {
        let Some(document) = self.documents.get_mut(uri) else { return Vec::new() };
        let mut before: HashMap<String, Open> =
            document.fences.drain(..).map(|open| (open.uri.clone(), open)).collect();
        let mut messages = Vec::new();
        for (number, fence) in fences(&document.text).into_iter().enumerate() {
            let fence_uri = format!("{uri}{MARK}{number}{}", fence.ending());
            let text = fence.isolated(&document.text);
            let version = &document.version;
            let diagnostics = match before.remove(&fence_uri) {
                Some(open) => {
                    if open.text != text {
                        let item = json!({"uri": fence_uri, "version": version});
                        let params = json!({"textDocument": item, "contentChanges": [{"text": text}]});
                        messages.push(
                            json!({"jsonrpc": "2.0", "method": "textDocument/didChange", "params": params}),
                        );
                    }
                    open.diagnostics
                }
                None => {
                    let language = if fence.is_ladder { "ladder" } else { "plc-il" };
                    let item =
                        json!({"uri": fence_uri, "languageId": language, "version": version, "text": text});
                    let params = json!({"textDocument": item});
                    messages
                        .push(json!({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": params}));
                    Vec::new()
                }
            };
            document.fences.push(Open { uri: fence_uri, fence, text, diagnostics });
        }
        let mut gone: Vec<String> = before.into_keys().collect();
        gone.sort_unstable();
        messages.extend(gone.iter().map(|uri| notice("textDocument/didClose", uri)));
        messages
    }

    fn translate_back(&mut self, message: &mut Value) -> Passage {
        if message["method"] == "textDocument/publishDiagnostics" {
            return self.publish(message);
        }
        let is_answer = message.get("method").is_none();
        let pending = if is_answer { self.pending.remove(&message["id"].to_string()) } else { None };
        let Some(Pending::Part { gathering, place }) = pending else {
            let found = real_names(message);
            return if found || pending.is_some() { Passage::Changed } else { Passage::Same };
        };
        real_names(message);
        let Some(waiting) = self.gatherings.get_mut(&gathering) else { return Passage::Kept };
        waiting.answers[place] = Some(message.take());
        if waiting.answers.iter().any(Option::is_none) {
            return Passage::Kept;
        }
        match self.gatherings.remove(&gathering) {
            Some(whole) => {
                *message = whole.answer();
                Passage::Changed
            }
            None => Passage::Kept,
        }
    }

    /// The diagnostics of all fences of a document are published as its own.
    fn publish(&mut self, message: &mut Value) -> Passage {
        let Some(uri) = message["params"]["uri"].as_str().map(str::to_string) else { return Passage::Same };
        let Some((real, _)) = uri.split_once(MARK) else { return Passage::Same };
        let published = message["params"]["diagnostics"].as_array().cloned().unwrap_or_default();
        let mut all = Vec::new();
        let mut version = Value::Null;
        if let Some(document) = self.documents.get_mut(real) {
            version = document.version.clone();
            if let Some(open) = document.fences.iter_mut().find(|open| open.uri == uri) {
                open.diagnostics = published;
            }
            all.extend(document.fences.iter().flat_map(|open| open.diagnostics.iter().cloned()));
        }
        let mut params = json!({"uri": real, "diagnostics": all});
        if !version.is_null() {
            params["version"] = version;
        }
        real_names(&mut params);
        message["params"] = params;
        Passage::Changed
    }
}

impl Gathering {
    fn answer(self) -> Value {
        let answers: Vec<Value> = self.answers.into_iter().flatten().collect();
        if let Some(error) = answers.iter().find_map(|answer| answer.get("error")) {
            return json!({"jsonrpc": "2.0", "id": self.id, "error": error});
        }
        let results = || answers.iter().zip(&self.lines).map(|(answer, lines)| (&answer["result"], *lines));
        let result = match self.method.as_str() {
            method if method.starts_with("textDocument/semanticTokens") => {
                json!({"data": tokens(results().map(|(result, _)| &result["data"]))})
            }
            "textDocument/diagnostic" => {
                let items = results().filter_map(|(result, _)| result["items"].as_array()).flatten();
                json!({"kind": "full", "items": items.collect::<Vec<_>>()})
            }
            method => {
                let edits = method.ends_with("ormatting");
                let inside = |value: &&Value, (first, end): (u64, u64)| {
                    let line = |side: &str| value["range"][side]["line"].as_u64();
                    let column = value["range"]["end"]["character"].as_u64();
                    // The line that closes the fence is no part of it.
                    let ends =
                        line("end").is_some_and(|line| line < end || (line == end && column == Some(0)));
                    !edits || (line("start").is_some_and(|line| line >= first) && ends)
                };
                let lists = results().filter_map(|(result, lines)| Some((result.as_array()?, lines)));
                let items =
                    lists.flat_map(|(list, lines)| list.iter().filter(move |value| inside(value, lines)));
                json!(items.collect::<Vec<_>>())
            }
        };
        json!({"jsonrpc": "2.0", "id": self.id, "result": result})
    }
}

/// Token lists one after the other: each starts with the line counted from 0, in the whole with that from the last
/// token before.
fn tokens<'v>(lists: impl Iterator<Item = &'v Value>) -> Vec<u64> {
    let mut data = Vec::new();
    let mut last_line = 0;
    for list in lists {
        let numbers: Vec<u64> = list.as_array().into_iter().flatten().filter_map(Value::as_u64).collect();
        let mut line = 0;
        for (number, token) in numbers.chunks_exact(5).enumerate() {
            line += token[0];
            let step = if number == 0 { line.saturating_sub(last_line) } else { token[0] };
            data.extend([step, token[1], token[2], token[3], token[4]]);
        }
        last_line = last_line.max(line);
    }
    data
}

/// The document that the first argument of a command is, or names.
fn named_by_command(params: &Value) -> Option<&str> {
    let argument = &params["arguments"][0];
    argument.as_str().or_else(|| argument["uri"].as_str())
}

fn lines_of(fence: &Fence) -> (u64, u64) {
    (fence.lines_before as u64, (fence.lines_before + fence.lines) as u64)
}

fn within(fence: &Fence, line: u64) -> bool {
    let (first, end) = lines_of(fence);
    (first..end.max(first + 1)).contains(&line)
}

fn notice(method: &str, uri: &str) -> Value {
    json!({"jsonrpc": "2.0", "method": method, "params": {"textDocument": {"uri": uri}}})
}

/// `message` about the document `new` instead of `old`.
fn renamed(message: &Value, old: &str, new: &str) -> Value {
    let mut message = message.clone();
    let places = [
        &["params", "textDocument", "uri"][..],
        &["params", "arguments", "0"],
        &["params", "arguments", "0", "uri"],
    ];
    for place in places {
        let pointer = format!("/{}", place.join("/"));
        if let Some(value) = message.pointer_mut(&pointer).filter(|value| **value == old) {
            *value = json!(new);
        }
    }
    message
}

/// Gives fences the name of their document, wherever one is named; whether there was any.
fn real_names(value: &mut Value) -> bool {
    match value {
        Value::String(text) => match text.split_once(MARK) {
            Some((real, _)) => {
                *text = real.to_string();
                true
            }
            None => false,
        },
        Value::Array(values) => values.iter_mut().fold(false, |found, value| real_names(value) | found),
        Value::Object(map) => {
            // What the server keeps with a lens or an action comes back to it as it was.
            let shown = map.iter_mut().filter(|(key, _)| *key != "data");
            let mut found = shown.fold(false, |found, (_, value)| real_names(value) | found);
            // The changes of a workspace edit have documents for keys.
            let named: Vec<String> = map.keys().filter(|key| key.contains(MARK)).cloned().collect();
            for key in named {
                if let (Some(value), Some((real, _))) = (map.remove(&key), key.split_once(MARK)) {
                    map.insert(real.to_string(), value);
                    found = true;
                }
            }
            found
        }
        _ => false,
    }
}

fn apply(text: &mut String, change: &Value, encoding: Encoding) {
    let new = change["text"].as_str().unwrap_or("");
    let range = &change["range"];
    if range.is_null() {
        *text = new.to_string();
        return;
    }
    let start = offset(text, &range["start"], encoding);
    let end = offset(text, &range["end"], encoding).max(start);
    text.replace_range(start..end, new);
}

/// The byte of a position; past the end of a line or of the text that end.
fn offset(text: &str, position: &Value, encoding: Encoding) -> usize {
    let line = position["line"].as_u64().unwrap_or(0) as usize;
    let column = position["character"].as_u64().unwrap_or(0).min(u64::from(u32::MAX)) as u32;
    let mut start = 0;
    for (number, content) in text.split_inclusive('\n').enumerate() {
        if number == line {
            let content = content.trim_end_matches('\n').trim_end_matches('\r');
            return start + offset_of_column(content, column, encoding);
        }
        start += content.len();
    }
    text.len()
}

fn contains(body: &[u8], part: &str) -> bool {
    // The search in texts looks at many bytes at a time.
    str::from_utf8(body).is_ok_and(|body| body.contains(part))
}
