//! Translations with and without proof, and the batch check, of programs of a thousand and ten thousand rungs.

use super::figures::{Figures, Table};
use super::programs;
use rungwise::check::{self, Severities};
use rungwise::document::{Document, Edit, Notation};
use rungwise::target::{Model, Target};
use rungwise::translate::{Options, To, Translation, prove, translate};
use std::time::{Duration, Instant};

pub fn measure(table: &Table) {
    for (rungs, kept) in [(1_000, true), (1_000, false), (10_000, true)] {
        // Behind a comment as long as that, a program of a thousand rungs keeps no trees either.
        let head = if kept { String::new() } else { format!("(* {} *)\n", "- ".repeat(150_000)) };
        let list = open(&(head + &programs::rungs(rungs)), Notation::FxIl);
        let drawing = open(&translate(&list, None, To::Ladder, &without_proof()).text, Notation::Ladder);
        let targets = |full: &'static str| if rungs == 10_000 { full } else { "" };
        let trees = if kept { "" } else { " without trees" };
        let of = |what: &str| format!("{rungs} rungs{trees}, {what}");
        translation(table, &of("ladder to FX list"), targets("< 150 ms"), &drawing, To::Fx, false);
        from_text(table, &of("ladder to FX list, from the text on"), targets("< 150 ms"), &drawing, To::Fx);
        from_text(table, &of("FX list to ladder, from the text on"), targets("< 300 ms"), &list, To::Ladder);
        translation(table, &of("FX list to ladder"), targets("< 300 ms"), &list, To::Ladder, false);
        translation(table, &of("ladder to FX list, proved"), targets("< 2 s"), &drawing, To::Fx, true);
        translation(table, &of("FX list to ladder, proved"), targets("< 2 s"), &list, To::Ladder, true);
        timed(table, &of("proof of list and ladder"), "", || _ = prove(&list, &drawing));
        check_of(table, &of("check, list"), targets("< 1 s"), &list);
        check_of(table, &of("check, ladder"), targets("< 1 s"), &drawing);
    }
    // Ten times the rungs, and the same work for each of them.
    table.judge_growth("1000 rungs without trees, ", "10000 rungs, ", 12.0);
}

fn open(text: &str, notation: Notation) -> Document {
    Document::new(text, notation, Target::of(Model::Fx3u))
}

fn without_proof() -> Options {
    Options { proves: false, ..Options::default() }
}

fn translation(table: &Table, name: &str, target: &str, document: &Document, to: To, proves: bool) {
    let options = Options { proves, ..Options::default() };
    timed(table, name, target, || {
        let Translation { rungs, .. } = translate(document, None, to, &options);
        assert!(rungs.iter().all(|rung| rung.note.is_none()), "everything can be translated");
    });
}

/// As on the command line: nothing is known of the document yet. An open one of a thousand rungs keeps its trees, one
/// of ten thousand does not.
fn from_text(table: &Table, name: &str, target: &str, document: &Document, to: To) {
    let text = document.text();
    timed(table, name, target, || {
        _ = translate(&open(&text, document.notation()), None, to, &without_proof());
    });
}

/// Both tiers from the text on, and again after an edit of one rung.
fn check_of(table: &Table, name: &str, target: &str, document: &Document) {
    let severities = Severities::default();
    let text = document.text();
    timed(table, &format!("{name}, cold"), target, || {
        _ = check::all(&open(&text, document.notation()), &severities);
    });
    let name = format!("{name}, after an edit");
    if !table.wants(&name) {
        return;
    }
    let mut edited = document.clone();
    check::all(&edited, &severities);
    let place = text.len() / 2 + text[text.len() / 2..].find("X1").unwrap_or(0) + 1;
    let figures = Figures::of(20, |round| {
        let digit = if round % 2 == 0 { "2" } else { "1" };
        let started = Instant::now();
        edited.apply(&[Edit { range: Some(place..place + 1), text: digit.to_string() }]);
        check::all(&edited, &severities);
        started.elapsed()
    });
    table.row(&name, if target.is_empty() { "" } else { "< 20 ms" }, &figures);
}

fn timed(table: &Table, name: &str, target: &str, mut event: impl FnMut()) {
    if !table.wants(name) {
        return;
    }
    let figures = Figures::of(7, |_| -> Duration {
        let started = Instant::now();
        event();
        started.elapsed()
    });
    table.row(name, target, &figures);
}
