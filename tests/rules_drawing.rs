//! Rules about drawings where a page is too small to show them.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::ladder::{self, Style};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, Severity, TextEdit};

fn found_for(text: &str, model: Model) -> Vec<Diagnostic> {
    let document = Document::new(text, Notation::Ladder, Target::of(model));
    check::realtime(&document, &Severities::default())
}

fn found(text: &str) -> Vec<Diagnostic> {
    found_for(text, Model::Fx2n)
}

/// `code at line:column` of each finding above a hint, or of all.
fn places(text: &str, found: &[Diagnostic]) -> Vec<String> {
    let place = |diagnostic: &Diagnostic| {
        let before = &text[..diagnostic.span.start as usize];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        format!("{} {line}:{column}", diagnostic.code)
    };
    found.iter().filter(|diagnostic| diagnostic.severity != Severity::Hint).map(place).collect()
}

#[test]
fn scratch() {
    let Ok(path) = std::env::var("LAD") else { return };
    let text = std::fs::read_to_string(path).unwrap();
    let tree = ladder::parse(&text, Target::of(Model::Fx2n));
    for rung in &tree.rungs {
        println!("rung lines {:?}", rung.lines);
        let g = &rung.graph;
        for id in g.vertex_ids() {
            let v = g.vertex(id);
            println!("  {:?} {:?} {:?}", id, v.kind, g.element_at(id).map(|e| (e.span.of(&text), e.operands.len())));
        }
        for arc in &g.arcs {
            println!("  {:?} -> {:?} {:?}", arc.tail, arc.head, g.cells(arc.cells));
        }
    }
    println!("problems {:#?}", tree.problems);
    for d in found(&text) {
        println!("{} {:?} {:?}", places(&text, &[d.clone()]).join(""), d.severity, d.message.render(Language::English));
        for r in &d.related { println!("   related {:?} {}", r.span.of(&text), r.message.render(Language::English)); }
        for f in &d.fixes { println!("   fix {}\n{}", f.title.render(Language::English), TextEdit::apply_all(&f.edits, &text)); }
    }
    println!("{}", ladder::format(&text, Target::of(Model::Fx2n), &Style::default()));
}
