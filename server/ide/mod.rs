//! Editor features, one file each: offsets of a document in, plain structs out. No protocol, no files, no threads.

use crate::document::{ChunkRef, Document};
pub use crate::document::{Token, TokenKind};
use crate::text::{Diagnostic, Fix, Language, Message, Span, TextEdit};

mod answer;
pub use answer::{
    Completion, CompletionKind, Fold, FoldKind, Hover, InlayHint, Status, SymbolKind, SymbolNode,
};

pub use crate::document::{At, Member, ProjectView};

mod names;
pub use names::pou_at;

mod members;

mod pages;
pub use pages::{block_page, function_page, instruction_page, operator_page};

mod devices;

mod declared;

mod implicit;

mod uses;

mod bookkeeping;

mod hover;

mod completion;

mod signature;
pub use signature::{Signature, SignatureParameter};

mod highlight;
pub use highlight::{Highlight, HighlightKind};

mod usage;
pub use usage::{Usage, UsageAt, UsageKey, UsageKind, UsageOf, UsageRow, UsageWish, UsedKind};

mod lens;
pub use lens::{Lens, LensKind, LensSettings};

mod aliases;
pub use aliases::{Rewrite, SymbolRename};

mod across;

mod calls;
pub use calls::CallItem;

mod search;
pub use search::FoundSymbol;

mod links;

mod rename;

mod symbols;

mod folding;

mod inlay_hints;

mod changes;

mod format;
pub use format::Style;

mod fixes;
pub use fixes::FixOf;

mod allowing;

mod status;

mod summary;
pub use summary::{Summary, rungs_counted};

mod drawing;
pub use drawing::{EditKind, Edited, Object, ObjectKind, applicable_edits, edit};

mod selection_range;

mod typing;

mod linked_editing;

mod forms;
pub use forms::{ProgramPart, TranslatedForm, form_of, form_steps, forms, forms_at_once, part_at};

mod refactor;
pub use refactor::Refactoring;

mod manifest;
pub use manifest::{FileKind, Schema, manifest_completions, manifest_hover};

/// What stands at `offset`: the page of an instruction, the meaning and range of a device, where it is used.
pub fn hover(document: &Document, offset: usize, language: Language) -> Option<Hover> {
    hover::at(&ProjectView::alone(document), offset, language, &|_, _| None)
}

/// The same among the files of a project; `link` gives the address of a line (from 0) of the file with a number.
pub fn hover_in(
    view: &ProjectView<'_>,
    offset: usize,
    language: Language,
    link: &dyn Fn(usize, u32) -> Option<String>,
) -> Option<Hover> {
    hover::at(view, offset, language, link)
}

/// What could be written at `offset`.
pub fn completions(document: &Document, offset: usize, language: Language) -> Vec<Completion> {
    completion::at(&ProjectView::alone(document), offset, language)
}

/// The same among the files of a project: devices that another file uses are not free.
pub fn completions_in(view: &ProjectView<'_>, offset: usize, language: Language) -> Vec<Completion> {
    completion::at(view, offset, language)
}

/// The instruction or call in which `offset` stands, and which of its operands is being written.
pub fn signature(document: &Document, offset: usize, language: Language) -> Option<Signature> {
    signature::at(document, offset, language)
}

/// What belongs to the word at `offset`: all uses of a name, the partners of FOR, MC, MPS, a parenthesis.
pub fn highlights(document: &Document, offset: usize) -> Vec<Highlight> {
    highlight::at(document, offset)
}

/// The list of used devices of a project.
pub fn usage(view: &ProjectView<'_>) -> Usage {
    usage_of(view, &UsageWish { places: true, of: UsageOf::All })
}

/// A part of it.
pub fn usage_of(view: &ProjectView<'_>, wish: &UsageWish) -> Usage {
    usage::of(view, wish)
}

/// The lenses above rungs, without their words.
pub fn lenses(document: &Document, wanted: LensSettings) -> Vec<Lens> {
    lens::of(document, wanted)
}

/// The words of a lens that stands at `offset`.
pub fn lens_title(
    view: &ProjectView<'_>,
    offset: usize,
    kind: &LensKind,
    language: Language,
) -> Option<String> {
    lens::title(view, offset, kind, language)
}

/// Where the name at `offset` is declared or, for a device, driven.
pub fn definition(document: &Document, offset: usize) -> Vec<Span> {
    definition_in(&ProjectView::alone(document), offset).into_iter().map(|at| at.value).collect()
}

/// The same among the files of a project.
pub fn definition_in(view: &ProjectView<'_>, offset: usize) -> Vec<At<Span>> {
    across::definition(view, offset)
}

/// Every place of the name at `offset`, in order.
pub fn references(document: &Document, offset: usize, with_declaration: bool) -> Vec<Span> {
    let found = references_in(&ProjectView::alone(document), offset, with_declaration);
    found.into_iter().map(|at| at.value).collect()
}

/// The same among the files of a project.
pub fn references_in(view: &ProjectView<'_>, offset: usize, with_declaration: bool) -> Vec<At<Span>> {
    across::references(view, offset, with_declaration)
}

/// The name at `offset`, if it can be renamed.
pub fn renamable(document: &Document, offset: usize) -> Option<Span> {
    aliases::span_at(document, offset).or_else(|| rename::renamable(document, offset))
}

/// The edits that give the name at `offset` the name `new`.
///
/// # Errors
/// Where there is no name, where `new` is none of its kind, or where it is taken.
pub fn rename(document: &Document, offset: usize, new: &str) -> Result<Vec<TextEdit>, Message> {
    let edits = rename::rename(&ProjectView::alone(document), offset, new)?;
    Ok(edits.into_iter().flat_map(|at| at.value).collect())
}

/// The same among the files of a project: the edits of each file that has any.
///
/// # Errors
/// The same, in any of the files.
pub fn rename_in(
    view: &ProjectView<'_>,
    offset: usize,
    new: &str,
) -> Result<Vec<At<Vec<TextEdit>>>, Message> {
    rename::rename(view, offset, new)
}

/// The names in the files of a project that have the letters of `query`, best first.
pub fn workspace_symbols(view: &ProjectView<'_>, query: &str) -> Vec<FoundSymbol> {
    search::symbols(view, query)
}

/// The POU, subroutine or label named at `offset`, else the one in which it stands.
pub fn call_item(view: &ProjectView<'_>, offset: usize) -> Option<CallItem> {
    calls::prepare(view, offset)
}

/// The main program of the file that is looked at.
pub fn main_item(view: &ProjectView<'_>) -> Option<CallItem> {
    calls::main_of(view)
}

/// Who calls `item` or jumps to it, each with the places in its file.
pub fn incoming_calls(view: &ProjectView<'_>, item: &CallItem) -> Vec<(CallItem, Vec<Span>)> {
    calls::incoming(view, item)
}

/// What `item` calls or jumps to, each with the places in the file of `item`.
pub fn outgoing_calls(view: &ProjectView<'_>, item: &CallItem) -> Vec<(CallItem, Vec<Span>)> {
    calls::outgoing(view, item)
}

/// The names of files in the comments of `document`; whether there are such files is not known here.
pub fn links(document: &Document) -> Vec<(Span, String)> {
    links::of(document)
}

/// The names of files in any text, such as a manifest.
pub fn links_in_text(text: &str) -> Vec<(Span, String)> {
    links::in_text(text)
}

/// Renames the symbol of a device at `offset` in all files and in the comments file; nothing if no symbol stands there.
pub fn rename_symbol(
    view: &ProjectView<'_>,
    offset: usize,
    new: &str,
) -> Option<Result<SymbolRename, Message>> {
    aliases::rename(view, offset, new)
}

/// The edit of the comments file that goes with the renaming of the device at `offset`.
///
/// # Errors
/// If the file has a line for the new device already.
pub fn rename_in_comments(
    document: &Document,
    offset: usize,
    new: &str,
) -> Result<Option<TextEdit>, Message> {
    aliases::table_edit(document, offset, new)
}

/// What may be written instead at `offset`: a symbol for a device, a device for a symbol.
pub fn rewrites(document: &Document, offset: usize) -> Vec<Rewrite> {
    aliases::rewrites(document, offset)
}

/// The outline.
pub fn symbols(document: &Document, language: Language) -> Vec<SymbolNode> {
    symbols::of(document, language, || false)
}

/// The outline, or its beginning if `is_cancelled` says on the way that nobody waits for it any more.
pub fn symbols_unless(
    document: &Document,
    language: Language,
    is_cancelled: impl Fn() -> bool,
) -> Vec<SymbolNode> {
    symbols::of(document, language, is_cancelled)
}

/// What can be folded.
pub fn folds(document: &Document) -> Vec<Fold> {
    folding::of(document)
}

/// All tokens that mean something, in order, none overlapping, none over more than one line.
pub fn semantic_tokens(document: &Document) -> Vec<Token> {
    let shifted = |at: ChunkRef<'_>| {
        let tokens = at.chunk.tokens().iter();
        tokens.map(|token| Token { span: token.span.shifted(at.start), ..*token }).collect::<Vec<_>>()
    };
    document.chunks().flat_map(shifted).collect()
}

/// What the editor may show between the words of `span`.
pub fn inlay_hints(document: &Document, span: Span, language: Language) -> Vec<InlayHint> {
    inlay_hints::within(document, span, language, true)
}

/// The same without the comments of devices.
pub fn value_hints(document: &Document, span: Span, language: Language) -> Vec<InlayHint> {
    inlay_hints::within(document, span, language, false)
}

/// The edits that make the document canonical; none if it is.
pub fn format(document: &Document, style: Style) -> Vec<TextEdit> {
    format::edits(document, style)
}

/// The rungs that [`format()`] leaves as they were drawn, each with the reason.
pub fn kept_rungs(document: &Document, style: Style) -> Vec<(Span, Message)> {
    format::kept(document, style)
}

/// The edits that make the rungs and lines canonical that `spans` touch.
pub fn format_ranges(document: &Document, style: Style, spans: &[Span]) -> Vec<TextEdit> {
    format::edits_within(document, style, spans)
}

/// The edits that keep the text whole after `typed`, one character or a line end, with the cursor now at `offset`.
pub fn typed(document: &Document, offset: usize, typed: &str, style: Style) -> Vec<TextEdit> {
    typing::after(document, offset, typed, style)
}

/// The element, branch, rung or network at `offset` of a ladder document, `around` it with what belongs to it.
pub fn object(document: &Document, offset: usize, kind: ObjectKind, around: bool) -> Option<Object> {
    drawing::object::at(document, offset, kind, around)
}

/// What grows around `offset`, smallest first, each range inside the next.
pub fn selection_ranges(document: &Document, offset: usize) -> Vec<Span> {
    selection_range::around(document, offset)
}

/// The places of the name at `offset` in its rung that can be typed at once; none if it is alone.
pub fn linked_places(document: &Document, offset: usize) -> Vec<Span> {
    linked_editing::of(document, offset)
}

/// The refactorings of the rung at the cursor or selection `span` that are proved to keep what the program does.
pub fn refactorings(view: &ProjectView<'_>, span: Span, style: Style) -> Vec<Refactoring> {
    refactor::at(view, span, style)
}

/// The fixes of `diagnostics` that touch `span`.
pub fn fixes(diagnostics: &[Diagnostic], span: Span) -> Vec<FixOf<'_>> {
    fixes::within(diagnostics, span)
}

/// For each of `diagnostics` that touches `span` and that comments may allow, the fixes that write such a comment:
/// above its rung, and at the top of the file.
pub fn allowing<'d>(
    document: &Document,
    diagnostics: &'d [Diagnostic],
    span: Span,
) -> Vec<(&'d Diagnostic, Fix)> {
    allowing::within(document, diagnostics, span)
}

/// What the status bar shows.
pub fn status(document: &Document) -> Status {
    status::of(document)
}
