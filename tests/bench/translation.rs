//! Translations with and without proof, and the batch check, of programs of a thousand and ten thousand rungs.

use super::figures::{Figures, Table};
use super::programs;
use rungwise::check::{self, Severities};
use rungwise::document::{Document, Edit, Notation};
use rungwise::target::{Model, Target};
use rungwise::translate::{Options, To, Translation, prove, translate};
use std::time::{Duration, Instant};

pub fn measure(table: &Table) {
    for rungs in [1_000, 10_000] {
        let list = Document::new(&programs::rungs(rungs), Notation::FxIl, Target::of(Model::Fx3u));
        let iec_list = Document::new(&programs::iec(rungs * 5), Notation::IecIl, Target::of(Model::Iec));
        let (drawing, iec_drawing) = (drawn(&list), drawn(&iec_list));
        let targets = |full: &'static str| if rungs == 10_000 { full } else { "" };
        for (proves, by, limits) in [(false, "", ["< 150 ms", "< 300 ms"]), (true, ", proved", ["< 2 s"; 2])]
        {
            let [to_list, to_ladder] = limits.map(targets);
            for (what, document, to, target) in [
                ("ladder to FX list", &drawing, To::Fx, to_list),
                ("FX list to ladder", &list, To::Ladder, to_ladder),
                ("ladder to IEC list", &iec_drawing, To::Iec, ""),
                ("IEC list to ladder", &iec_list, To::Ladder, ""),
            ] {
                translation(table, &format!("{rungs} rungs, {what}{by}"), target, document, to, proves);
            }
        }
        for (what, list, drawing) in [("", &list, &drawing), ("IEC ", &iec_list, &iec_drawing)] {
            let of = |check: &str| format!("{rungs} rungs, {check}");
            let name = of(&format!("proof of {what}list and ladder, from the text on"));
            timed(table, &name, "", || _ = prove(&again(list), &again(drawing)));
            check_of(table, &of(&format!("check, {what}list")), targets("< 1 s"), list);
            check_of(table, &of(&format!("check, {what}ladder")), targets("< 1 s"), drawing);
        }
    }
    table.judge_growth("1000 rungs, ", "10000 rungs, ", &["from the text on", "cold"], 12.0);
}

fn drawn(list: &Document) -> Document {
    let drawing = translate(list, None, To::Ladder, &without_proof()).text;
    Document::new(&drawing, Notation::Ladder, list.target())
}

/// The document as the command line has it: nothing of it is known yet but its text.
fn again(document: &Document) -> Document {
    Document::new(&document.text(), document.notation(), document.target())
}

fn without_proof() -> Options {
    Options { proves: false, ..Options::default() }
}

/// Of an open document, and from the text on: an open one of a thousand rungs keeps its trees, one of ten thousand does
/// not.
fn translation(table: &Table, name: &str, target: &str, document: &Document, to: To, proves: bool) {
    let options = Options { proves, ..Options::default() };
    let translated = |document: &Document| {
        let Translation { rungs, .. } = translate(document, None, to, &options);
        assert!(rungs.iter().all(|rung| rung.note.is_none()), "everything can be translated");
    };
    timed(table, name, target, || translated(document));
    timed(table, &format!("{name}, from the text on"), target, || translated(&again(document)));
}

/// Both tiers from the text on, and again after an edit of one rung.
fn check_of(table: &Table, name: &str, target: &str, document: &Document) {
    let severities = Severities::default();
    timed(table, &format!("{name}, cold"), target, || _ = check::all(&again(document), &severities));
    let name = format!("{name}, after an edit");
    if !table.wants(&name) {
        return;
    }
    let mut edited = document.clone();
    let text = document.text();
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
