//! The list of used devices: the command `rungwise.usage` and the virtual document.
//!
//! `rungwise.usage` takes a document's URI and, if not everything is wanted, an object
//! `{"text": false, "uses": false, "devices": ["M0", "Main.Start"], "position": {"line": 0, "character": 3}}`, of which
//! each field may be left out: `text` is whether the list is wanted as a page, `uses` whether each use is, `devices`
//! are the only ones wanted, `position` (as the protocol counts) is that of the only one. It answers
//! `{"text", "target", "files": ["main.il", …], "kinds": [{"kind", "name", "used", "next"}],
//! "devices": [{"device", "kind", "symbol", "comment", "latched", "preset", "read", "written", "reads", "writes",
//! "gaps": [{"first", "last", "count"}],
//! "uses": [{"file", "uri", "line", "column", "rung", "access", "coil", "count", "text"}]}]}`.
//!
//! `kind` is the device's letter, `address` or `variable`, and `name` the kind in words; `used` counts its devices in
//! use, and `next` is the first free one or `null`. `reads` and `writes` count uses; `gaps` are the free devices
//! between the device and the next one in use. `file` is the name in `files`; `line` and `column` count from 1, columns
//! in Unicode scalar values; `rung` counts from 1 in its file or is `null`; `access` is `read`, `write`, `read-write`,
//! `define` or `jump`; the `text` of a use is the instruction or the drawn rung in a line. The page has a grid for each
//! kind of device. With `devices` or `position` there is no page, and `kinds` and `gaps` are empty.
//!
//! The page alone is also the content of the virtual document `rungwise-usage:` + the path of the document, which
//! clients of LSP 3.18 ask for with `workspace/textDocumentContent` (`{"uri"}` → `{"text"}`).

use super::projects::Around;
use super::to_proto::Place;
use crate::ide::{self, UsageOf, UsageWish};
use crate::text::Language;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tower_lsp::ls_types::{Position, Uri};

/// The scheme of the virtual document with the list of used devices.
pub(super) const SCHEME: &str = "rungwise-usage";

/// What of the list is wanted.
#[derive(Deserialize)]
#[serde(default)]
pub(super) struct Asked {
    text: bool,
    uses: bool,
    devices: Option<Vec<String>>,
    position: Option<Position>,
}

impl Default for Asked {
    fn default() -> Asked {
        Asked { text: true, uses: true, devices: None, position: None }
    }
}

impl Asked {
    /// Reads the second argument of the command, which may be missing; nothing if it cannot be read.
    pub(super) fn of(argument: Option<&Value>) -> Option<Asked> {
        match argument {
            None | Some(Value::Null) => Some(Asked::default()),
            Some(value) => Asked::deserialize(value).ok(),
        }
    }
}

/// The parameters of `workspace/textDocumentContent`.
#[derive(Deserialize)]
pub(super) struct ContentParams {
    pub uri: Uri,
}

/// Its answer.
#[derive(Serialize)]
pub(super) struct Content {
    pub text: String,
}

/// The document of which a virtual one tells.
pub(super) fn told_document(uri: &Uri) -> Option<Uri> {
    let rest = uri.as_str().strip_prefix(SCHEME)?.strip_prefix(':')?;
    format!("file:{rest}").parse().ok()
}

/// The page.
pub(super) fn page(around: &Around, language: Language) -> String {
    let view = around.view();
    ide::usage(&view).text(&view, language)
}

/// The answer of the command.
pub(super) fn answer(around: &Around, place: Place<'_>, asked: Asked) -> Value {
    let view = around.view();
    let of = match (asked.position, asked.devices) {
        (Some(position), _) => UsageOf::At(place.offset(position)),
        (None, Some(names)) => UsageOf::Named(names),
        (None, None) => UsageOf::All,
    };
    let has_page = asked.text && of == UsageOf::All;
    let usage = ide::usage_of(&view, &UsageWish { places: asked.uses || has_page, of });
    let file = |number: usize| {
        let name = view.members().get(number).map_or("", |member| member.name);
        let uri = around.file(number).map(|file| file.uri.to_string());
        vec![("file", json!(name)), ("uri", json!(uri))]
    };
    let files: Vec<&str> = view.members().iter().map(|member| member.name).collect();
    let mut answer = json!({
        "target": view.here().target().name,
        "files": files,
        "kinds": usage.kinds.iter().map(|kind| kind.json(place.language)).collect::<Vec<_>>(),
        "devices": usage.rows.iter().map(|row| row.json(file)).collect::<Vec<_>>(),
    });
    if has_page {
        answer["text"] = json!(usage.text(&view, place.language));
    }
    if !asked.uses {
        let rows = answer["devices"].as_array_mut().into_iter().flatten();
        rows.filter_map(Value::as_object_mut).for_each(|row| drop(row.remove("uses")));
    }
    answer
}
