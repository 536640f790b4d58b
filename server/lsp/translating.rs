//! Translation over the protocol.
//!
//! # `rungwise.translate`
//!
//! A command (`workspace/executeCommand`) with one argument:
//!
//! ```text
//! {
//!   uri: string,
//!   position?: Position,     // the rung there; on a comment the rung below, on the header of a network all of it
//!   range?: Range,           // the rungs that it touches; without either all of the document
//!   to: "ladder" | "fx" | "iec" | "boolean" | "all",
//!   target?: "fx1s" | "fx1n" | "fx2n" | "fx3u"   // the model that an FX list is for
//! }
//! ```
//!
//! Without a `target` a program of the FX family stays for its own model, and one of IEC 61131-3 is for that of
//! `rungwise.toml`: `target` under `[translate]`, else the target of the project, else an FX2N.
//!
//! It answers `{ forms: [{ to, text, certificate, notes: string[] }] }`, with `"all"` every form, the shortest first.
//! The `certificate` is that of the rung of which least is known: `"proved"` (the same bits are driven under equal
//! conditions), `"construction"` (instructions with the same operands under equal conditions) or `"undecided"`. A note
//! says, with the line, why a rung was kept as it is or not proved. Where there is no rung there are no forms. What is
//! asked for wrongly is an error whose message says what is wrong.
//!
//! # `rungwise.translateBeside`
//!
//! The same argument with one form. The client is asked to make a new file beside the document with the text, and to
//! show it; the answer is `{ uri }`. Existing files are left alone: the new one gets a number.
//!
//! # Code actions
//!
//! `refactor.rewrite.translate.<form>` for the rungs at the range and, for those who ask for `source`,
//! `source.translate.<form>` for all of them. A client that says
//! `{"experimental": {"commands": {"commands": ["rungwise.openTranslation", "rungwise.copyTranslation"]}}}` gets them
//! as these commands of its own, with the argument of `rungwise.translate`: it opens the text as a new document, or
//! puts it on the clipboard (`….<form>.copy`). Others get `rungwise.translateBeside` if they can make files.

use super::editing::is_wanted;
use super::fences;
use super::projects::{Around, file_path};
use super::settings::Settings;
use super::to_proto::Place;
use crate::ide::{self, ProgramPart, TranslatedForm};
use crate::target::{Model, Target};
use crate::text::{Language, Message, Span};
use crate::translate::{Certificate, To};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tower_lsp::ls_types::*;

/// The command that answers with texts.
pub(super) const TRANSLATE: &str = "rungwise.translate";
/// The command that makes a file.
pub(super) const BESIDE: &str = "rungwise.translateBeside";
/// Commands of the client, see above.
pub(super) const OPEN: &str = "rungwise.openTranslation";
pub(super) const COPY: &str = "rungwise.copyTranslation";

/// A longer part is translated only when the action is chosen; its title tells less.
const TOLD_MAX: u32 = 16 * 1024;

/// The argument of the commands.
#[derive(Clone, Serialize, Deserialize, Debug)]
pub(super) struct Asked {
    pub uri: Uri,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    position: Option<Position>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    range: Option<Range>,
    to: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    target: Option<String>,
}

impl Asked {
    /// The whole of a file.
    fn of(uri: &Uri, to: To) -> Asked {
        Asked { uri: uri.clone(), position: None, range: None, to: to.name().into(), target: None }
    }
}

/// What is wanted of a translation.
pub(super) struct Wanted {
    pub asked: Asked,
    forms: Vec<To>,
    target: Option<&'static Target>,
}

impl Wanted {
    /// Reads the argument of a command.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn of(command: &str, argument: Option<&Value>) -> Result<Wanted, Message> {
        let wrong = |reason: String| {
            Message::new("translating.argument").with("command", command).with("reason", reason)
        };
        let argument = argument.ok_or_else(|| wrong("arguments[0]".to_string()))?;
        let asked = Asked::deserialize(argument).map_err(|reason| wrong(reason.to_string()))?;
        let forms = match (asked.to.as_str(), To::named(&asked.to)) {
            ("all", _) if command == TRANSLATE => vec![To::Boolean, To::Ladder, To::Fx, To::Iec],
            (_, Some(to)) => vec![to],
            _ => {
                let message = Message::new("translating.form").with("form", &asked.to);
                return Err(message.with("forms", To::ALL.map(To::name).join(", ")));
            }
        };
        let target = match asked.target.as_deref() {
            None => None,
            Some(name) => {
                let found = Target::named(name).filter(|target| target.is_fx());
                Some(found.ok_or_else(|| Message::new("manifest.fx-target").with("word", name))?)
            }
        };
        Ok(Wanted { asked, forms, target })
    }

    /// The forms; nothing if it was cancelled on the way.
    fn translated(
        &self,
        around: &Around,
        place: Place<'_>,
        settings: &Settings,
    ) -> Option<Vec<TranslatedForm>> {
        let chosen = match (self.asked.range, self.asked.position) {
            (Some(range), _) => Some(place.span(range)),
            (None, Some(position)) => Some(Span::at(place.offset(position))),
            (None, None) => None,
        };
        let part = match chosen.map(|span| ide::part_at(place.document, span)) {
            None => None,
            Some(None) => return Some(Vec::new()),
            Some(Some(part)) => Some(part.span()),
        };
        let style = settings.style(&around.here().manifest);
        let model = self.target.map(|target| target.model).or_else(|| model_of_project(around, place));
        ide::forms(place.document, part, &self.forms, (style, model), &|| around.is_cancelled())
    }

    /// The answer of `rungwise.translate`.
    pub(super) fn answer(&self, around: &Around, place: Place<'_>, settings: &Settings) -> Option<Value> {
        let forms = self.translated(around, place, settings)?;
        let forms: Vec<Value> = forms.iter().map(|form| to_json(form, place)).collect();
        Some(json!({"forms": forms}))
    }

    /// The edit of `rungwise.translateBeside` and the file that it makes.
    ///
    /// # Errors
    /// Where there is no rung, or the document has no place on the disk.
    pub(super) fn beside(
        &self,
        around: &Around,
        place: Place<'_>,
        settings: &Settings,
    ) -> Option<Result<(WorkspaceEdit, Uri), Message>> {
        let form = self.translated(around, place, settings)?.pop();
        Some(form.ok_or_else(|| Message::new("translating.no-rung")).and_then(|form| {
            let uri =
                free_file(&self.asked.uri, form.to).ok_or_else(|| Message::new("translating.no-folder"))?;
            Ok((new_file(&uri, form.text), uri))
        }))
    }
}

/// The model that an FX list is for which a program of IEC 61131-3 becomes, as the project has it.
fn model_of_project(around: &Around, place: Place<'_>) -> Option<Model> {
    let manifest = &around.here().manifest;
    manifest.fx_target().filter(|_| !place.document.target().is_fx()).map(|target| target.model)
}

fn to_json(form: &TranslatedForm, place: Place<'_>) -> Value {
    let notes = form.notes.iter().map(|(span, reason)| {
        let line = place.position(span.start as usize).line + 1;
        let note = Message::new("translating.note").with("line", line);
        note.with_messages("reason", vec![reason.clone()]).render(place.language)
    });
    json!({
        "to": form.to.name(),
        "text": form.text,
        "certificate": form.certificate.map(Certificate::word),
        "notes": notes.collect::<Vec<_>>(),
    })
}

/// A file that is not there yet: `motor-fx.il` beside `motor.lad`. A program in a fence is a part of its document.
fn free_file(uri: &Uri, to: To) -> Option<Uri> {
    let path = file_path(uri)?;
    let name = path.file_name()?.to_string_lossy();
    let name = name.split(fences::MARK).next()?;
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let ending = match to.name() {
        "ladder" => "lad",
        "boolean" => "txt",
        _ => "il",
    };
    let name = |number: u32| match number {
        1 => format!("{stem}-{}.{ending}", to.name()),
        number => format!("{stem}-{}-{number}.{ending}", to.name()),
    };
    let free = (1..1000).map(|number| path.with_file_name(name(number))).find(|path| !path.exists())?;
    Uri::from_file_path(free)
}

fn new_file(uri: &Uri, text: String) -> WorkspaceEdit {
    let make = CreateFile { uri: uri.clone(), options: None, annotation_id: None };
    let write = TextDocumentEdit {
        text_document: OptionalVersionedTextDocumentIdentifier { uri: uri.clone(), version: None },
        edits: vec![OneOf::Left(TextEdit::new(Range::default(), text))],
    };
    let operations =
        vec![DocumentChangeOperation::Op(ResourceOp::Create(make)), DocumentChangeOperation::Edit(write)];
    WorkspaceEdit {
        document_changes: Some(DocumentChanges::Operations(operations)),
        ..WorkspaceEdit::default()
    }
}

/// The translations of the rungs at a range, or of the document, as code actions.
pub(super) fn actions(
    around: &Around,
    place: Place<'_>,
    params: &CodeActionParams,
    settings: &Settings,
) -> Vec<CodeAction> {
    let abilities = place.abilities;
    if !abilities.opens_translations && !abilities.copies_translations && !abilities.makes_files {
        return Vec::new();
    }
    let only = params.context.only.as_deref();
    let own = ide::form_of(place.document);
    let forms = || To::ALL.into_iter().filter(|to| Some(*to) != own);
    let mut actions = Vec::new();
    // What concerns the whole file is a matter of the menu of the file, not of every line in it.
    if only.is_some() {
        for to in forms() {
            let kind = format!("source.translate.{}", to.name());
            let asked = Asked::of(&around.here().uri, to);
            let title = title("translating.translate", "translating.file", to, Vec::new(), place.language);
            let title_copy =
                self::title("translating.copy", "translating.file", to, Vec::new(), place.language);
            actions.extend(both(place, &kind, &asked, title, title_copy));
        }
    }
    let kinds = forms().flat_map(|to| [rung_kind(to), format!("{}.copy", rung_kind(to))]);
    let wants_rungs = kinds.into_iter().any(|kind| is_wanted(&kind.into(), only));
    let span = place.span(params.range);
    if wants_rungs && let Some(part) = ide::part_at(place.document, span) {
        let told = told(around, place, part, &forms().collect::<Vec<_>>(), settings);
        for to in forms() {
            actions.extend(of_part(around, place, params.range, (part, &told), to));
        }
    }
    let wanted = |action: &CodeAction| action.kind.as_ref().is_some_and(|kind| is_wanted(kind, only));
    actions.into_iter().filter(wanted).collect()
}

fn rung_kind(to: To) -> String {
    format!("refactor.rewrite.translate.{}", to.name())
}

/// The forms of a part, of which titles tell; nothing if it is too long for that.
fn told(
    around: &Around,
    place: Place<'_>,
    part: ProgramPart,
    forms: &[To],
    settings: &Settings,
) -> Option<Vec<TranslatedForm>> {
    let span = part.span();
    if span.end - span.start > TOLD_MAX {
        return None;
    }
    let style = settings.style(&around.here().manifest);
    let model = model_of_project(around, place);
    let is_cancelled = || around.is_cancelled();
    ide::forms_at_once(place.document, (span, TOLD_MAX), forms, (style, model), &is_cancelled)
}

/// The actions for rungs; none if nothing of them has this form.
fn of_part(
    around: &Around,
    place: Place<'_>,
    range: Range,
    (part, told): (ProgramPart, &Option<Vec<TranslatedForm>>),
    to: To,
) -> Vec<CodeAction> {
    let what = match part {
        ProgramPart::Rung(_) => "translating.rung",
        ProgramPart::Network(_) => "translating.network",
        ProgramPart::Rungs(_) => "translating.rungs",
    };
    let mut details = Vec::new();
    let mut copied = Vec::new();
    if let Some(told) = told {
        let Some(form) = told.iter().find(|form| form.to == to && form.notes.len() < form.rungs) else {
            return Vec::new();
        };
        let steps = ide::form_steps(form, place.document);
        copied.extend(steps.map(|steps| Message::new("translating.steps").with("steps", steps)));
        details.clone_from(&copied);
        details.extend(form.certificate.map(certificate));
    }
    let asked = Asked::of(&around.here().uri, to);
    let asked = match range.start == range.end {
        true => Asked { position: Some(range.start), ..asked },
        false => Asked { range: Some(range), ..asked },
    };
    let open = title("translating.translate", what, to, details, place.language);
    let copy = title("translating.copy", what, to, copied, place.language);
    both(place, &rung_kind(to), &asked, open, copy)
}

/// The action that shows a translation, and the one that copies it, as far as the client can.
fn both(place: Place<'_>, kind: &str, asked: &Asked, open: String, copy: String) -> Vec<CodeAction> {
    let action = |title: String, kind: String, command: &str| CodeAction {
        kind: Some(kind.into()),
        command: Some(Command {
            title: title.clone(),
            command: command.to_string(),
            arguments: Some(vec![json!(asked)]),
        }),
        title,
        ..CodeAction::default()
    };
    let shows = if place.abilities.opens_translations {
        Some(OPEN)
    } else {
        place.abilities.makes_files.then_some(BESIDE)
    };
    let shown = shows.map(|command| action(open, kind.to_string(), command));
    let copied = place.abilities.copies_translations.then(|| action(copy, format!("{kind}.copy"), COPY));
    shown.into_iter().chain(copied).collect()
}

fn certificate(certificate: Certificate) -> Message {
    Message::new(match certificate {
        Certificate::Proved => "translating.proved",
        Certificate::Construction => "translating.construction",
        Certificate::Undecided => "translating.undecided",
    })
}

fn title(
    sentence: &'static str,
    what: &'static str,
    to: To,
    details: Vec<Message>,
    language: Language,
) -> String {
    let form = Message::new(match to.name() {
        "ladder" => "translating.to-ladder",
        "fx" => "translating.to-fx",
        "iec" => "translating.to-iec",
        _ => "translating.to-boolean",
    });
    let sentence = Message::new(sentence);
    let title = sentence.with_messages("what", vec![Message::new(what)]).with_messages("form", vec![form]);
    match details.is_empty() {
        true => title.render(language),
        false => Message::new("translating.detailed")
            .with_messages("title", vec![title])
            .with_messages("details", details)
            .render(language),
    }
}
