//! Runs the rules and puts their findings together.

use super::proof::always_energised;
use super::rule::ChunkJudge;
use super::sense::unused;
use super::suppression::Suppression;
use super::{ChunkContext, ProgramContext, RULES, Rule, Run, program_around, programs, proofs};
use crate::document::{Chunk, Document, Found, LIMIT_BYTES, Page, ProjectView, Proofs};
use crate::text::{Diagnostic, Message, Severity, Span};
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::{Hash, Hasher};
use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

/// So many pages are worth the start of threads: a page takes longer to judge than a thread to start.
const WORTH_THREADS: usize = 4;

/// What a project makes of the rules.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Severities {
    /// A code maps to its severity here, or to `None` if it is off.
    pub grades: FxHashMap<String, Option<Severity>>,
    /// Names of which no two may be on together, list by list.
    pub never: Vec<Vec<String>>,
}

impl Severities {
    /// The severity of `code`; `None` if it is switched off.
    pub fn of(&self, code: &str) -> Option<Severity> {
        match self.grades.get(code) {
            Some(severity) => *severity,
            None => Some(DEFAULTS.get(code).copied().unwrap_or(Severity::Error)),
        }
    }
}

static DEFAULTS: LazyLock<FxHashMap<&'static str, Severity>> =
    LazyLock::new(|| RULES.iter().map(|rule| (rule.code, rule.severity)).collect());

/// What both tiers find, sorted by place.
pub fn all(document: &Document, severities: &Severities) -> Vec<Diagnostic> {
    let mut diagnostics = realtime(document, severities);
    diagnostics.extend(program(document, severities));
    sorted(diagnostics)
}

/// What the real-time tier finds. Chunks that kept their text and surroundings are not judged again.
pub fn realtime(document: &Document, severities: &Severities) -> Vec<Diagnostic> {
    allowed(document, judged(document, true), severities)
}

/// What no comment allows, graded.
fn allowed(document: &Document, found: Vec<Diagnostic>, severities: &Severities) -> Vec<Diagnostic> {
    let suppression = Suppression::of(document);
    with_severities(
        match suppression {
            Some(suppression) => suppression.filtered(found),
            None => found,
        },
        severities,
    )
}

/// What the batch tier found in `document`, without what comments allow and with the comments that allow nothing.
fn finished(document: &Document, found: Vec<Diagnostic>, severities: &Severities) -> Vec<Diagnostic> {
    let Some(suppression) = Suppression::of(document) else {
        return with_severities(found, severities);
    };
    // Each chunk has kept what was found in it.
    let realtime = judged(document, true);
    let unused = unused(document, &suppression, realtime.iter().chain(&found));
    let mut kept = suppression.filtered(found);
    kept.extend(unused);
    with_severities(kept, severities)
}

/// What both tiers find in a document about which nothing else will be asked, sorted by place.
pub fn once(document: &Document, severities: &Severities) -> Vec<Diagnostic> {
    let mut diagnostics = realtime_once(document, severities);
    diagnostics.extend(program(document, severities));
    sorted(diagnostics)
}

/// What the real-time tier finds in a document about which nothing else will be asked. Rules about declared names look
/// at the mentions of all chunks.
fn realtime_once(document: &Document, severities: &Severities) -> Vec<Diagnostic> {
    let scopes = document.scopes();
    let with_mentions = !scopes.pous.is_empty() || !scopes.globals.is_empty();
    allowed(document, judged(document, with_mentions), severities)
}

/// All that the real-time tier finds; `with_mentions` says whether those of the chunks will be needed afterwards.
fn judged(document: &Document, with_mentions: bool) -> Vec<Diagnostic> {
    if document.len() > LIMIT_BYTES {
        let message = Message::new("text-too-large.found").with("limit", LIMIT_BYTES >> 20);
        return vec![Diagnostic::new("text-too-large", Span::at(0), message)];
    }
    let judged = judged_pages(document, with_mentions);
    let mut start = 0;
    let mut diagnostics = Vec::new();
    for (page, found) in document.pages().iter().zip(judged) {
        diagnostics.extend(found.iter().map(|diagnostic| diagnostic.shifted(start)));
        start += page.bytes();
    }
    diagnostics
}

/// The findings in each page, from the page's start. Many pages are judged by several threads.
fn judged_pages(document: &Document, with_mentions: bool) -> Vec<Found> {
    let mut pou_number = 0;
    let mut tasks = Vec::with_capacity(document.pages().len());
    for page in document.pages() {
        tasks.push((page, pou_number));
        pou_number += page.pou_starts();
    }
    let judge = |(page, pou_number): (&Arc<Page>, usize)| {
        page.found(key(document, pou_number), || judge_page(document, page, pou_number, with_mentions))
    };
    let is_new = |(page, pou_number): &(&Arc<Page>, usize)| !page.has_found(key(document, *pou_number));
    let new: Vec<_> = tasks.iter().copied().filter(is_new).collect();
    if new.len() >= WORTH_THREADS {
        let threads = std::thread::available_parallelism().map_or(1, NonZero::get).min(new.len());
        let next = AtomicUsize::new(0);
        let work = || {
            while let Some(task) = new.get(next.fetch_add(1, Ordering::Relaxed)) {
                judge(*task);
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..threads {
                scope.spawn(work);
            }
            work();
        });
    }
    tasks.into_iter().map(judge).collect()
}

/// What the batch tier finds in a document that stands alone.
pub fn program(document: &Document, severities: &Severities) -> Vec<Diagnostic> {
    within_project(&ProjectView::alone(document), severities)
}

/// What the batch tier finds in the file of the project that is looked at. Other files are seen, and named by their
/// numbers where they have to do with a finding.
pub fn within_project(view: &ProjectView<'_>, severities: &Severities) -> Vec<Diagnostic> {
    batch(view, severities, &mut |_| {}).unwrap_or_default()
}

/// The same, told on the way: `tell` gets what the rules about programs find, and then what proofs find, as they find
/// it; at the end comments that allow nothing are found, too. Nothing if the view is cancelled before.
pub fn batch(
    view: &ProjectView<'_>,
    severities: &Severities,
    tell: &mut dyn FnMut(Vec<Diagnostic>),
) -> Option<Vec<Diagnostic>> {
    let files = program_around(view).into_iter().map(|number| (number, view.members()[number].document));
    let is_all = files.len() == view.members().len();
    let context = ProgramContext::new(files, Some(view.here_number()))
        .cancellable(view.cancelled())
        .with_never(&severities.never, is_all);
    let here = view.here();
    let suppression = Suppression::of(here);
    let mut told = |found: &[Diagnostic]| {
        let found = found.to_vec();
        let allowed = match &suppression {
            Some(suppression) => suppression.filtered(found),
            None => found,
        };
        tell(with_severities(allowed, severities));
    };
    let found = judge_program(&context)?.into_iter();
    let mut found: Vec<Diagnostic> = found.map(|(_, diagnostic)| diagnostic).collect();
    told(&found);
    found.extend(proved(&context, view.here_number(), &|| view.is_cancelled(), &mut told)?);
    Some(finished(here, found, severities))
}

/// What both tiers find in each file of a project, in their order, sorted by place.
pub fn project(view: &ProjectView<'_>, severities: &Severities) -> Vec<Vec<Diagnostic>> {
    let document = |number: usize| view.members()[number].document;
    let mut by_file: Vec<Vec<Diagnostic>> =
        (0..view.members().len()).map(|number| realtime_once(document(number), severities)).collect();
    let mut of_programs: Vec<Vec<Diagnostic>> = vec![Vec::new(); by_file.len()];
    for program in programs(view).into_iter().take_while(|_| !view.is_cancelled()) {
        let is_all = program.len() == view.members().len();
        let files = program.into_iter().map(|number| (number, document(number)));
        let context = ProgramContext::new(files, None)
            .cancellable(view.cancelled())
            .with_never(&severities.never, is_all);
        for (number, diagnostic) in judge_program(&context).unwrap_or_default() {
            of_programs[number].push(diagnostic);
        }
        for file in context.files() {
            let proved = proved(&context, file.number, &|| view.is_cancelled(), &mut |_| {});
            of_programs[file.number].extend(proved.unwrap_or_default());
        }
    }
    for (number, found) in of_programs.into_iter().enumerate() {
        by_file[number].extend(finished(document(number), found, severities));
    }
    by_file.into_iter().map(sorted).collect()
}

/// What the rules about whole programs find, with the number of the file; nothing if nobody waits for it any more.
fn judge_program(context: &ProgramContext<'_>) -> Option<Vec<(usize, Diagnostic)>> {
    let mut found = Vec::new();
    for rule in RULES.iter() {
        if context.is_cancelled() {
            return None;
        }
        if let Rule { run: Run::Program(judge) | Run::Both(_, judge), .. } = rule {
            judge(context, &mut found);
        }
    }
    Some(context.distributed(found).collect())
}

/// What proofs find in the file with this number, as it holds at its place in the program; nothing if nobody waits for
/// it any more.
fn proved(
    context: &ProgramContext<'_>,
    number: usize,
    is_cancelled: &dyn Fn() -> bool,
    tell: &mut dyn FnMut(&[Diagnostic]),
) -> Option<Vec<Diagnostic>> {
    let Some(file) = context.files().iter().find(|file| file.number == number) else {
        return Some(Vec::new());
    };
    let placed = |found: &[Diagnostic]| -> Vec<Diagnostic> {
        let region = |span: Span| context.regions().at(span.shifted(file.start).start);
        found.iter().cloned().map(|found| always_energised::within(found, region)).collect()
    };
    let found = proofs::of(file.document, is_cancelled, &mut |found| tell(&placed(found)))?;
    Some(placed(&found))
}

/// By place, then gravity, then code.
pub fn sorted(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.sort_by_key(|diagnostic| (diagnostic.span, diagnostic.severity, diagnostic.code));
    diagnostics
}

/// What the rules of the real-time tier do with a chunk, in the order of the catalogue.
static CHUNK_JUDGES: LazyLock<Vec<ChunkJudge>> = LazyLock::new(|| {
    let judges = RULES.iter().filter_map(|rule| match rule.run {
        Run::Chunk(judge) | Run::Both(judge, _) => Some(judge),
        _ => None,
    });
    judges.collect()
});

/// The findings in a page whose first chunk comes after `pou_number` starts of a POU, from the page's start.
fn judge_page(
    document: &Document,
    page: &Page,
    mut pou_number: usize,
    with_mentions: bool,
) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    let mut start = 0;
    for chunk in page.chunks() {
        pou_number += chunk.pou_starts();
        let key = key(document, pou_number);
        let found = chunk.found(key, with_mentions, |chunk| {
            let mut found = chunk.problems().to_vec();
            let context = ChunkContext::new(chunk, document, pou_number.checked_sub(1));
            CHUNK_JUDGES.iter().for_each(|judge| judge(&context, &mut found));
            let boxes = chunk.boxes();
            if !context.is_worth_a_proof.get() && boxes.is_empty() {
                chunk.keep_proofs(key, Proofs::default());
            }
            for (start, list) in boxes {
                let own = judge_box(list, document, pou_number.checked_sub(1));
                found.extend(own.iter().map(|diagnostic| diagnostic.shifted(*start)));
            }
            found
        });
        diagnostics.extend(found.iter().map(|diagnostic| diagnostic.shifted(start)));
        start += chunk.len();
    }
    // What the whole program is judged and counted by, while the chunks are at hand.
    page.milestones();
    page.accesses();
    page.size();
    diagnostics
}

/// The findings in a list that a drawing carries along, from its start.
fn judge_box(list: &Chunk, document: &Document, pou: Option<usize>) -> Vec<Diagnostic> {
    let mut found = list.problems().to_vec();
    let context = ChunkContext::of_box(list, document, pou);
    CHUNK_JUDGES.iter().for_each(|judge| judge(&context, &mut found));
    found
}

/// Messages that are graver or milder than the rest of their rule's.
const OWN_SEVERITIES: &[(&str, Severity)] = &[
    // Nothing was read there.
    (crate::ladder::TWO_READINGS, Severity::Warning),
    (super::drawing::CONTACT_AFTER_COIL_ALLOWED, Severity::Hint),
    // It runs once the cassette is there.
    (super::sense::WITH_CASSETTE, Severity::Warning),
];

fn with_severities(diagnostics: Vec<Diagnostic>, severities: &Severities) -> Vec<Diagnostic> {
    let graded = diagnostics.into_iter().filter_map(|mut diagnostic| {
        let severity = severities.of(diagnostic.code)?;
        // A project that grades the rule itself has the last word.
        let key = diagnostic.message.key();
        let not_proved = super::proof::NOT_PROVED.iter().map(|key| (*key, Severity::Warning));
        let own = OWN_SEVERITIES.iter().copied().chain(not_proved).find(|(own, _)| *own == key);
        let own = own.filter(|_| !severities.grades.contains_key(diagnostic.code));
        diagnostic.severity = own.map_or(severity, |(_, severity)| severity);
        Some(diagnostic)
    });
    graded.collect()
}

/// Stands for all outside of a page or a chunk that its findings depend on, behind so many starts of a POU.
pub(super) fn key(document: &Document, pou_number: usize) -> u64 {
    let mut hasher = FxHasher::default();
    (document.scopes().key, pou_number).hash(&mut hasher);
    hasher.finish()
}
