//! Refactorings of rungs, in drawings and in lists: other words for what the program does already.
//!
//! Each looks at the paths of power around the cursor and proposes others. What is proposed is written, applied to a
//! copy of the document, read again and compared with what stood there; only what is proved equal is offered. So the
//! refactorings themselves need not know what depends on the order of reading and writing.

mod unit;

mod measure;

mod neighbourhood;

mod declaration;

mod silent;

mod writing;

mod proof;

mod algebra;

mod shorten;

mod wide_first;

mod factor;

mod split;

mod merge;

mod de_morgan;

mod extract;

mod inline;

use super::Style;
use crate::document::{Notation, ProjectView};
use crate::logic::{Expression, Path};
use crate::text::{Message, Span, TextEdit};
use declaration::Declaration;
use neighbourhood::Neighbourhood;
use smol_str::SmolStr;

/// A change of rungs that keeps what the program does.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Refactoring {
    /// Its name in the protocol, with its group: `refactor.rewrite.rung.factor`.
    pub kind: &'static str,
    /// What it does, and what it costs or saves.
    pub title: Message,
    /// In order, none overlapping.
    pub edits: Vec<TextEdit>,
}

/// Rungs in the place of others.
struct Change {
    /// The first rung that is replaced, by its number in the neighbourhood.
    first: usize,
    /// How many are.
    count: usize,
    /// What comes instead.
    paths: Vec<Path>,
}

/// A refactoring that is not written yet.
struct Proposal {
    kind: &'static str,
    title: Message,
    /// In order of their rungs.
    changes: Vec<Change>,
    /// The key of the relay that only one side has; nothing else reads it.
    relay: Option<SmolStr>,
    /// The variables that it needs.
    declarations: Vec<Declaration>,
    /// Whether it is of use only if rungs become shorter.
    must_save: bool,
    /// Whether instructions stay in a form that has shorter ones, such as a call behind the stores of its inputs.
    keeps_forms: bool,
}

impl Proposal {
    /// `paths` for the rung at the cursor.
    fn here(
        kind: &'static str,
        title: &'static str,
        around: &Neighbourhood<'_>,
        paths: Vec<Path>,
    ) -> Proposal {
        let change = Change { first: around.here, count: 1, paths };
        Proposal::of(kind, Message::new(title), vec![change])
    }

    fn of(kind: &'static str, title: Message, changes: Vec<Change>) -> Proposal {
        let (relay, declarations) = (None, Vec::new());
        Proposal { kind, title, changes, relay, declarations, must_save: false, keeps_forms: true }
    }

    fn if_it_saves(self) -> Proposal {
        Proposal { must_save: true, ..self }
    }
}

/// Rungs with more contacts and actions are left alone: a menu that opens late helps nobody.
const PARTS_MAX: usize = 400;

/// The refactorings of the rung at the cursor, or of what is selected of it, that are proved.
pub(super) fn at(view: &ProjectView<'_>, span: Span, style: Style) -> Vec<Refactoring> {
    let Some(around) = Neighbourhood::at(view, span) else { return Vec::new() };
    if !is_bearable(around.path()) {
        return Vec::new();
    }
    let proposals = [
        shorten::propose(&around),
        wide_first::propose(&around),
        factor::propose(&around),
        split::propose(&around),
        merge::propose(&around),
        extract::propose(&around, span),
        inline::propose(&around),
    ];
    // De Morgan's form says more than that it is shorter.
    let proposals = de_morgan::propose(&around).into_iter().chain(proposals.into_iter().flatten());
    let mut refactorings: Vec<Refactoring> = Vec::new();
    for proposal in proposals {
        let Some(refactoring) = finished(&around, proposal, style) else { continue };
        if refactorings.iter().all(|other| other.edits != refactoring.edits) {
            refactorings.push(refactoring);
        }
    }
    refactorings
}

fn finished(around: &Neighbourhood<'_>, proposal: Proposal, style: Style) -> Option<Refactoring> {
    let saved = saved(around, &proposal);
    if proposal.must_save && saved.is_some_and(|saved| saved <= 0) {
        return None;
    }
    let written = writing::edits(around, &proposal, style)?;
    let is_proved = !written.edits.is_empty() && proof::holds(around, &proposal, &written);
    let has_steps = around.document.target().is_fx();
    let title = || match saved.filter(|saved| has_steps && *saved != 0) {
        None => proposal.title.clone(),
        Some(saved) => Message::new("translating.detailed")
            .with_messages("title", vec![proposal.title.clone()])
            .with_messages("details", vec![saving(saved)]),
    };
    is_proved.then(|| Refactoring { kind: proposal.kind, title: title(), edits: written.edits })
}

fn saving(saved: i64) -> Message {
    let message = Message::new(match saved {
        1 => "refactor.saves-step",
        -1 => "refactor.costs-step",
        2.. => "refactor.saves-steps",
        _ => "refactor.costs-steps",
    });
    message.with("steps", saved.abs())
}

/// The program steps that a proposal saves, in IEC 61131-3 the instructions; nothing where that is not known.
fn saved(around: &Neighbourhood<'_>, proposal: &Proposal) -> Option<i64> {
    let mut saved = 0;
    for change in &proposal.changes {
        for number in change.first..change.first + change.count {
            // Forms that stay make no difference.
            let is_written = !proposal.keeps_forms || around.document.notation() != Notation::IecIl;
            let length = if is_written { around.length(number) } else { around.shortest(number) };
            saved += i64::from(length?);
        }
        for path in &change.paths {
            saved -= i64::from(measure::of_path(path, around.document)?);
        }
    }
    Some(saved)
}

fn is_bearable(path: &Path) -> bool {
    let mut conditions: Vec<&Expression> = Vec::new();
    let mut actions = 0;
    path.visit(&mut |_| actions += 1, &mut |condition| conditions.push(condition));
    let mut contacts = 0;
    conditions.iter().for_each(|condition| condition.visit(&mut |_| contacts += 1));
    actions + contacts <= PARTS_MAX
}
