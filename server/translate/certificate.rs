//! The proof that comes with a translation: the result is read again, as a file would be, and compared rung by rung.

use super::source::{self, Source};
use super::to_iec::Helper;
use super::{To, Translation, from_boolean, page};
use crate::document::{Document, Scopes};
use crate::logic::{Comparison, Effort, Path, Storage, compare_but};
use crate::target::{Operand, Target};
use crate::text::{Message, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;
use std::borrow::Cow;
use std::cell::LazyCell;

/// What is known of a translated rung.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Certificate {
    /// The same bits are driven in the same order under equal conditions.
    Proved,
    /// The same actions in the same order under equal conditions, some of them instructions of which only the words
    /// were compared.
    Construction,
    /// Nothing is proved; the note says why.
    Undecided,
}

impl Certificate {
    /// Whether the translation can be relied upon.
    pub fn is_certain(self) -> bool {
        self != Certificate::Undecided
    }

    /// The word in requests and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Certificate::Proved => "proved",
            Certificate::Construction => "construction",
            Certificate::Undecided => "undecided",
        }
    }
}

/// Certifies each rung of `translation`, which was made of `sources` for `target` with the helpers `declared`; nothing
/// if it was cancelled on the way.
pub(super) fn add(
    (document, target): (&Document, &'static Target),
    (sources, declared): (&[Source], &[Helper]),
    to: To,
    translation: &mut Translation,
    is_cancelled: &dyn Fn() -> bool,
) -> Option<()> {
    let unit = sources.first().and_then(|source| source.pou);
    let around = || match declared {
        [] => Cow::Borrowed(&**document.scopes()),
        _ => Cow::Owned(document.scopes().declaring(unit, declared.iter().map(Helper::variable))),
    };
    let (written, is_declared) = read_again((document, target), to, &translation.text, (&around, unit));
    let mut written = written.into_iter().peekable();
    let mut effort = Effort::of_program();
    let helpers: FxHashSet<SmolStr> = translation.helpers.iter().map(|name| folded(name)).collect();
    for (source, translated) in sources.iter().zip(&mut translation.rungs) {
        if is_cancelled() {
            return None;
        }
        // One rung may become thousands of equations.
        let places = LazyCell::new(|| places(source));
        let own = std::iter::from_fn(|| written.next_if(|rung| rung.start < translated.result.end));
        let paths: Option<Vec<Path>> = own
            .filter_map(|rung| match rung.path {
                Some(None) => None,
                path => Some(path.flatten()),
            })
            .map(
                |path| {
                    if is_declared {
                        path
                    } else {
                        path.map(|path| located(path, document, (source, &places)))
                    }
                },
            )
            .collect();
        if translated.note.is_some() {
            // A list is carried along word by word; a drawing in a list is but a comment.
            let carried = source.rung.is_list && to != To::Boolean;
            let certificate = if carried { Certificate::Construction } else { Certificate::Undecided };
            translated.certificate = Some(certificate);
            continue;
        }
        let sources: Vec<&Path> = source.rung.path.iter().flatten().collect();
        let (certificate, note) = match paths {
            Some(paths) => judge(&sources, &paths.iter().collect::<Vec<_>>(), &helpers, &mut effort),
            None => (Certificate::Undecided, Some("translate.unreadable")),
        };
        translated.certificate = Some(certificate);
        translated.note = note.map(Message::new);
    }
    Some(())
}

/// A rung of the result.
struct Written {
    /// Where it starts.
    start: usize,
    /// What it does; nothing inside if it does nothing, nothing at all if it cannot be read.
    path: Option<Option<Path>>,
}

/// Where the operands of a rung lie, by their words.
fn places(source: &Source) -> FxHashMap<SmolStr, Storage> {
    let terms = source.rung.path.iter().flatten().flat_map(Path::terms);
    terms.map(|term| (folded(&term.text), term.storage)).collect()
}

/// The path of a result without declarations, where its variables lie as the source says: by its declarations, or as
/// the variables do that stand for its devices.
fn located(
    mut path: Path,
    document: &Document,
    (source, places): (&Source, &FxHashMap<SmolStr, Storage>),
) -> Path {
    if !document.target().is_fx() {
        return path.located(document.scopes(), source.pou);
    }
    path.each_term(&mut |term| {
        if term.operand == Operand::Variable
            && let Some(storage) = places.get(&folded(&term.text))
        {
            term.storage = *storage;
        }
    });
    path
}

/// The rungs of the result, and whether it has declarations of its own. A part of a program has none, so it is read
/// with those `around` it in a program unit.
fn read_again<'d>(
    (document, target): (&'d Document, &'static Target),
    to: To,
    text: &str,
    (around, unit): (&dyn Fn() -> Cow<'d, Scopes>, Option<usize>),
) -> (Vec<Written>, bool) {
    let Some(notation) = page::notation(to) else {
        let (equations, problems) = from_boolean::read(text, document.reader());
        let equations = equations.into_iter();
        let read = equations.map(|equation| (equation.span, Some(equation.path)));
        let mut written: Vec<_> =
            read.chain(problems.into_iter().map(|problem| (problem.span, None))).collect();
        written.sort_by_key(|(span, _)| *span);
        let written = written.into_iter().map(|(span, path)| Written { start: span.start as usize, path });
        return (written.collect(), false);
    };
    // The symbols of the project stand for devices there, too, and its other files declare what they did.
    let again = Document::with_comments(text, notation, target, document.comments().clone());
    let again = again.linked_as(document);
    let is_declared = !again.scopes().own_pous().is_empty();
    let rungs = match is_declared || target.is_fx() {
        true => source::rungs(&again, None),
        false => source::rungs_within(&again, &around(), unit),
    };
    let rungs = rungs.into_iter();
    let written = rungs.map(|rung| Written { start: rung.span().start as usize, path: rung.rung.path.ok() });
    (written.collect(), is_declared)
}

fn judge(
    own: &[&Path],
    written: &[&Path],
    helpers: &FxHashSet<SmolStr>,
    effort: &mut Effort,
) -> (Certificate, Option<&'static str>) {
    match effort.ask(|formulas| compare_but(own, written, helpers, formulas)) {
        Comparison::Same { is_boolean: true } => (Certificate::Proved, None),
        Comparison::Same { is_boolean: false } => (Certificate::Construction, None),
        Comparison::Different { .. } | Comparison::Unlike(_) => {
            (Certificate::Undecided, Some("translate.different"))
        }
        Comparison::Undecided | Comparison::Doubtful | Comparison::Open(_) | Comparison::AsksOtherwise(_) => {
            (Certificate::Undecided, Some("translate.undecided"))
        }
    }
}
