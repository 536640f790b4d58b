//! The forms of a part of a program: which rungs are meant by a place, and what they are in other forms.

use super::Style;
use crate::document::{Document, Notation, Tree};
use crate::logic;
use crate::target::Model;
use crate::text::{Message, Span};
use crate::translate::{Certificate, Options, Original, To};

/// A part of a program in one form.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct TranslatedForm {
    /// Which form.
    pub to: To,
    /// The text, lines ended by line feeds.
    pub text: String,
    /// How many rungs it has.
    pub rungs: usize,
    /// The weakest certificate of its rungs; nothing if there is no proof for this form.
    pub certificate: Option<Certificate>,
    /// Why a rung was not translated, or is not proved, with its place in the document.
    pub notes: Vec<(Span, Message)>,
}

/// What a place in a program is a place of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ProgramPart {
    /// One rung.
    Rung(Span),
    /// The rungs of a network, named by its header.
    Network(Span),
    /// The rungs of a selection.
    Rungs(Span),
}

impl ProgramPart {
    /// The bytes of the document that its rungs touch, and no others.
    pub fn span(self) -> Span {
        match self {
            ProgramPart::Rung(span) | ProgramPart::Network(span) | ProgramPart::Rungs(span) => span,
        }
    }
}

/// The form in which a document is written.
pub fn form_of(document: &Document) -> Option<To> {
    let name = match document.notation() {
        Notation::Ladder => "ladder",
        Notation::FxIl => "fx",
        Notation::IecIl => "iec",
    };
    To::named(name)
}

/// The rung at the cursor, or those that a selection touches. On a comment that is the rung below, on the header of a
/// network all of it.
pub fn part_at(document: &Document, span: Span) -> Option<ProgramPart> {
    if !span.is_empty() {
        // What ends before the first character of a line does not touch it.
        return Some(ProgramPart::Rungs(Span { start: span.start, end: span.end - 1 }));
    }
    let at = document.chunk_at(span.start as usize)?;
    let inside = (span.start as usize).saturating_sub(at.start);
    let reading = at.chunk.reading();
    let rungs = logic::rungs(&reading, document.reader());
    let shifted = |span: Span| span.shifted(at.start);
    if network_of(reading.tree()).is_some_and(|header| header.touches(inside))
        && let Some(first) = rungs.first()
    {
        let end = end_of_network(document, at.start + at.chunk.len());
        return Some(ProgramPart::Network(Span { start: shifted(first.span).start, end: end as u32 }));
    }
    let found = rungs.iter().find(|rung| rung.span.touches(inside));
    let below = || rungs.iter().find(|rung| inside <= rung.span.start as usize);
    let rung = found.or_else(below).or(rungs.last())?;
    Some(ProgramPart::Rung(shifted(rung.span)))
}

/// The header of the network that begins with a chunk, if one does.
fn network_of(tree: &Tree) -> Option<Span> {
    let Tree::Ladder(tree) = tree else { return None };
    tree.header.as_ref().filter(|header| header.label.is_none()).map(|header| header.span)
}

/// The end of the network whose first chunk ends at a byte: where the next one begins, or what is no drawing.
fn end_of_network(document: &Document, first: usize) -> usize {
    let mut end = first;
    while let Some(next) = document.chunk_at(end).filter(|next| next.start == end && !next.chunk.is_empty()) {
        let reading = next.chunk.reading();
        if !matches!(reading.tree(), Tree::Ladder(_)) || network_of(reading.tree()).is_some() {
            break;
        }
        end += next.chunk.len();
    }
    end.saturating_sub(1)
}

/// `document` in the forms `to`, with `part` only its rungs; nothing if `is_cancelled` says on the way that nobody
/// waits for it any more. A part without a rung has no form. An FX list is for the `model`, see [`Options::model`].
pub fn forms(
    document: &Document,
    part: Option<Span>,
    to: &[To],
    settings: (Style, Option<Model>),
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Vec<TranslatedForm>> {
    forms_of(&Original::of(document, part), part.is_none(), to, settings, is_cancelled)
}

/// The same of a part, for a menu: nothing if its rungs have more bytes than `longest`, too.
pub fn forms_at_once(
    document: &Document,
    (part, longest): (Span, u32),
    to: &[To],
    settings: (Style, Option<Model>),
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Vec<TranslatedForm>> {
    let source = Original::of(document, Some(part));
    if source.length() > longest as usize {
        return None;
    }
    forms_of(&source, false, to, settings, is_cancelled)
}

fn forms_of(
    source: &Original<'_>,
    is_whole: bool,
    to: &[To],
    (style, model): (Style, Option<Model>),
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Vec<TranslatedForm>> {
    let options = Options { style: style.ladder(), is_whole, model, ..Options::default() };
    let mut forms = Vec::with_capacity(to.len());
    for to in to {
        let translation = source.translated(*to, &options, is_cancelled)?;
        if translation.rungs.is_empty() {
            continue;
        }
        let noted = translation.rungs.iter().filter_map(|rung| Some((rung.span, rung.note.clone()?)));
        forms.push(TranslatedForm {
            to: *to,
            rungs: translation.rungs.len(),
            certificate: weakest(translation.rungs.iter().map(|rung| rung.certificate)),
            notes: noted.collect(),
            text: translation.text,
        });
    }
    Some(forms)
}

/// The certificate of which least is known; nothing if one of them is missing.
fn weakest(certificates: impl Iterator<Item = Option<Certificate>>) -> Option<Certificate> {
    let strength = |certificate: &Certificate| match certificate {
        Certificate::Undecided => 0,
        Certificate::Construction => 1,
        Certificate::Proved => 2,
    };
    certificates.collect::<Option<Vec<_>>>()?.into_iter().min_by_key(strength)
}

/// The program steps of a part in this form; nothing where steps have no meaning.
pub fn form_steps(form: &TranslatedForm, document: &Document) -> Option<u32> {
    let is_list = form.to == To::Fx && document.target().is_fx();
    is_list.then(|| {
        let list = Document::frugal(&form.text, Notation::FxIl, document.target());
        list.chunks().map(|at| at.chunk.size().steps).fold(0, u32::saturating_add)
    })
}
