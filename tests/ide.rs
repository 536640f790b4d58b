//! Editor features: a program with `$0` for the cursor, and the answer drawn as text.

use expect_test::{Expect, expect};
use proptest::prelude::*;
use rungwise::document::{Document, Notation, Tree};
use rungwise::ide::{self, Style, SymbolNode};
use rungwise::project::{FormatStyle, Manifest, open_document, program_files};
use rungwise::target::{Form, Model, Target};
use rungwise::text::{Encoding, Language, Span, TextEdit};
use std::path::Path;

const EN: Language = Language::English;
const STYLE: Style = Style { kind: FormatStyle::Iec, width: 48 };

const MOTOR: &str = "\
(* Start and stop *)
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |

|   Y0                                           |
+---| |---+------------------------------(T0 K50)-+
|         |                                      |
|         +----------------------[MOV K10 D0]----+
";

const DELAY: &str = "\
PROGRAM Main
VAR
    Start AT %IX0.0 : BOOL;
    Motor AT %QX0.0 : BOOL;
    Delay : TON;
    Valve : Gate;
END_VAR
    LD Start
    ST Valve.Open
    CAL Delay(IN := Start, PT := T#1m30s)
    LD Delay.Q
    JMPC Finish
    ST Motor
Finish:
    LD Motor
    AND 16#FF
    CAL Valve(Open := Motor)
END_PROGRAM
FUNCTION_BLOCK Gate
VAR_INPUT
    Open : BOOL;
END_VAR
VAR
    Start : BOOL;
END_VAR
    LD Open
    ST Start
END_FUNCTION_BLOCK
";

fn fx(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::of(Model::Fx2n))
}

fn ladder(text: &str) -> Document {
    Document::new(text, Notation::Ladder, Target::of(Model::Fx2n))
}

fn iec(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

/// The document of `text` without its `$0`, and where that stood.
fn at_cursor(text: &str, read: fn(&str) -> Document) -> (Document, usize) {
    let offset = text.find("$0").expect("a cursor");
    (read(&text.replacen("$0", "", 1)), offset)
}

/// `text` with a cursor before the first `word`, or where `$0` stands in it.
fn marked(text: &str, word: &str) -> String {
    let plain = word.replace("$0", "");
    let marked = if word.contains("$0") { word.to_string() } else { format!("$0{word}") };
    assert!(text.contains(&plain), "{plain}");
    text.replacen(&plain, &marked, 1)
}

/// `line:column` from 1, and the text of the span.
fn place(document: &Document, span: Span) -> String {
    let at = document.position(span.start as usize, Encoding::Utf32);
    format!("{}:{} `{}`", at.line + 1, at.column + 1, document.slice(span))
}

fn check_hover(text: &str, read: fn(&str) -> Document, expected: &Expect) {
    let (document, offset) = at_cursor(text, read);
    let answer = match ide::hover(&document, offset, EN) {
        Some(hover) => format!("{}\n{}\n", place(&document, hover.span), hover.markdown),
        None => "nothing\n".to_string(),
    };
    expected.assert_eq(&answer);
}

fn check_completions(text: &str, read: fn(&str) -> Document, shown: usize, expected: &Expect) {
    let (document, offset) = at_cursor(text, read);
    let mut found = ide::completions(&document, offset, EN);
    found.sort_by_key(|proposal| proposal.rank);
    let mut answer = String::new();
    for proposal in found.iter().take(shown) {
        let text = document.text();
        let edited = TextEdit::apply_all(std::slice::from_ref(&proposal.edit), &text);
        let line = edited[..proposal.edit.span.start as usize].rfind('\n').map_or(0, |end| end + 1);
        let line = edited[line..].lines().next().unwrap_or("").trim_end();
        answer += &format!("{} | {} | {line}\n", proposal.label, proposal.detail);
    }
    if found.len() > shown {
        answer += "…\n";
    }
    expected.assert_eq(&answer);
}

fn check_places(text: &str, read: fn(&str) -> Document, find: fn(&Document, usize) -> Vec<Span>, expected: &Expect) {
    let (document, offset) = at_cursor(text, read);
    let places: Vec<String> = find(&document, offset).into_iter().map(|span| place(&document, span)).collect();
    expected.assert_eq(&(places.join("\n") + "\n"));
}

fn check_rename(text: &str, read: fn(&str) -> Document, new: &str, expected: &Expect) {
    let (document, offset) = at_cursor(text, read);
    let answer = match ide::rename(&document, offset, new) {
        Ok(edits) => TextEdit::apply_all(&edits, &document.text()),
        Err(message) => format!("refused: {}\n", message.render(EN)),
    };
    expected.assert_eq(&answer);
}

fn check_outline(document: &Document, expected: &Expect) {
    fn draw(document: &Document, nodes: &[SymbolNode], depth: usize, answer: &mut String) {
        for node in nodes {
            let line = |offset: u32| document.position(offset as usize, Encoding::Utf8).line + 1;
            let inside = node.span.start <= node.selection.start && node.selection.end <= node.span.end;
            assert!(inside, "{}: the selection lies outside", node.name);
            let lines = format!("{}-{}", line(node.span.start), line(node.span.end));
            let indent = "  ".repeat(depth);
            *answer += &format!("{indent}{:?} {} [{}] {lines}\n", node.kind, node.name, node.detail);
            draw(document, &node.children, depth + 1, answer);
        }
    }
    let mut answer = String::new();
    draw(document, &ide::symbols(document, EN), 0, &mut answer);
    expected.assert_eq(&answer);
}

fn check_folds(document: &Document, expected: &Expect) {
    let line = |offset: u32| document.position(offset as usize, Encoding::Utf8).line + 1;
    let folds = ide::folds(document);
    let folds: Vec<String> =
        folds.iter().map(|fold| format!("{}-{} {:?}\n", line(fold.span.start), line(fold.span.end), fold.kind)).collect();
    expected.assert_eq(&folds.concat());
}

fn check_tokens(document: &Document, expected: &Expect) {
    let mut answer = String::new();
    for token in ide::semantic_tokens(document) {
        let mark = if token.modification { "!" } else { "" };
        answer += &format!("{} {:?}{mark}\n", place(document, token.span), token.kind);
    }
    expected.assert_eq(&answer);
}

#[test]
fn hover_on_an_instruction_is_its_page() {
    let page = ide::instruction_page(Form::named("DMOVP").unwrap());
    for part in ["DMOVP", "32 bit", "`MOV`", "`DMOV`", "| S |", "9 steps", "FX2N", "```il"] {
        assert!(page.contains(part), "{part} in {page}");
    }
    let (document, offset) = at_cursor("LD X0\ndm$0ovp D0 D10\n", fx);
    let hover = ide::hover(&document, offset, EN).unwrap();
    assert_eq!((document.slice(hover.span), hover.markdown), ("dmovp".to_string(), page));
    check_hover("LD X0\nXYZ$0 D0\n", fx, &expect![[""]]);
}

#[test]
fn hover_on_devices() {
    check_hover("LD X0\nOUT M50$00\nLD M500\nOR M500\nANI M500\nMOV K4M496 D0\nEND\n", fx, &expect![[""]]);
    check_hover("LD $0T0\nOUT Y0\nLD X0\nOUT T0 K50\nEND\n", fx, &expect![[""]]);
    check_hover("LD $0M8013\nOUT Y0\n", fx, &expect![[""]]);
    check_hover("LD M9$0000\nOUT Y0\n", fx, &expect![[""]]);
    check_hover("LD X0\nMOV $0K4M0Z1 D0\n", fx, &expect![[""]]);
    let many = format!("{}LD $0X0\nOUT Y0\n", "LD X0\nOUT Y0\n".repeat(12));
    check_hover(&many, fx, &expect![[""]]);
}

#[test]
fn hover_on_constants_and_labels() {
    check_hover("LD X0\nOUT T0 $0K50\n", fx, &expect![[""]]);
    check_hover("LD X0\nOUT T200 $0K50\n", fx, &expect![[""]]);
    check_hover("LD X0\nMOV $0HFF D0\n", fx, &expect![[""]]);
    check_hover("LD X0\nMOV $0K-1 D0\n", fx, &expect![[""]]);
    check_hover("LD X0\nCJ $0P0\nLD X1\nOUT Y0\nP0\nEND\n", fx, &expect![[""]]);
    check_hover("LD X0 ; $0X0 is it\n", fx, &expect![[""]]);
}

#[test]
fn hover_in_ladder() {
    check_hover(&marked(MOTOR, "|$0/|"), ladder, &expect![[""]]);
    check_hover(&marked(MOTOR, "(T0$0 K50"), ladder, &expect![[""]]);
    check_hover(&marked(MOTOR, "K50"), ladder, &expect![[""]]);
    let (document, offset) = at_cursor(&marked(MOTOR, "MO$0V"), ladder);
    let hover = ide::hover(&document, offset, EN).unwrap();
    assert!(hover.markdown.starts_with("### MOV"), "{}", hover.markdown);
}

#[test]
fn hover_in_iec() {
    check_hover(&marked(DELAY, "LD St$0art"), iec, &expect![[""]]);
    check_hover(&marked(DELAY, "Delay.$0Q"), iec, &expect![[""]]);
    check_hover(&marked(DELAY, "T#1m$030s"), iec, &expect![[""]]);
    check_hover(&marked(DELAY, "16#$0FF"), iec, &expect![[""]]);
    check_hover(&marked(DELAY, "JMPC Fin$0ish"), iec, &expect![[""]]);
    check_hover(&marked(DELAY, ": Ga$0te"), iec, &expect![[""]]);
    check_hover(&marked(DELAY, "Valve.Op$0en"), iec, &expect![[""]]);
    for (word, heading) in [("JM$0PC", "### JMP"), ("T$0ON", "### TON"), ("CA$0L", "### CAL"), ("S$0T", "### ST")] {
        let (document, offset) = at_cursor(&marked(DELAY, word), iec);
        let hover = ide::hover(&document, offset, EN).unwrap();
        assert!(hover.markdown.starts_with(heading), "{word}: {}", hover.markdown);
    }
}

#[test]
fn completion_of_fx_instructions() {
    check_completions("LD X0\n$0", fx, 4, &expect![[""]]);
    check_completions("LD X0\nmo$0", fx, 6, &expect![[""]]);
    check_completions("  12 L$0", fx, 3, &expect![[""]]);
    check_completions("LD X0 ; $0", fx, 3, &expect![[""]]);
}

#[test]
fn completion_of_fx_operands() {
    let program = "LD M0\nAND X0\nOR M0\nOUT Y0\nLD X1\nCALL P1\nFEND\nP1\nLD M1\nOUT T0 K10\nSRET\nEND\n";
    check_completions(&format!("{program}LD $0"), fx, 6, &expect![[""]]);
    check_completions(&format!("{program}OUT $0"), fx, 6, &expect![[""]]);
    check_completions(&format!("{program}OUT T$0"), fx, 6, &expect![[""]]);
    check_completions(&format!("{program}OUT T200 $0"), fx, 6, &expect![[""]]);
    check_completions(&format!("{program}OUT Y0 $0"), fx, 6, &expect![[""]]);
    check_completions(&format!("{program}LD M801$0"), fx, 12, &expect![[""]]);
    check_completions(&format!("{program}OUT M801$0"), fx, 12, &expect![[""]]);
    check_completions(&format!("{program}CJ $0"), fx, 4, &expect![[""]]);
    check_completions(&format!("{program}MOV K1 $0"), fx, 40, &expect![[""]]);
}

#[test]
fn completion_in_ladder() {
    check_completions("$0", ladder, 3, &expect![[""]]);
    check_completions(&marked(MOTOR, "|   Y0    |$0"), ladder, 4, &expect![[""]]);
    check_completions("|   X0\n+---| |--$0--------( )-+\n", ladder, 8, &expect![[""]]);
    check_completions("|   X0\n+---| |----[MO$0\n", ladder, 3, &expect![[""]]);
    check_completions("|   X0  D7\n+---| |----[MOV K1 $0\n", ladder, 3, &expect![[""]]);
    check_completions("|   X0\n+---| |----(T0 $0)\n", ladder, 3, &expect![[""]]);
}

#[test]
fn completion_in_iec() {
    check_completions(&marked(DELAY, "LD $0Start"), iec, 12, &expect![[""]]);
    check_completions(&marked(DELAY, "    ST Motor").replace("$0    ST Motor", "    ST $0"), iec, 12, &expect![[""]]);
    check_completions(&marked(DELAY, "Delay.$0Q"), iec, 12, &expect![[""]]);
    check_completions(&marked(DELAY, "Valve.$0Open"), iec, 12, &expect![[""]]);
    check_completions(&marked(DELAY, "JMPC $0Finish"), iec, 12, &expect![[""]]);
    check_completions(&marked(DELAY, "CAL $0Delay"), iec, 12, &expect![[""]]);
    check_completions(&marked(DELAY, "Delay($0"), iec, 12, &expect![[""]]);
    check_completions(&marked(DELAY, "Delay : $0TON").replace("TON;", ";"), iec, 3, &expect![[""]]);
    check_completions(&marked(DELAY, "IN := $0"), iec, 3, &expect![[""]]);
    check_completions(&marked(DELAY, "    LD Motor\n").replace("$0    LD Motor", "    LI$0"), iec, 12, &expect![[""]]);
    check_completions("$0", iec, 60, &expect![[""]]);
}

#[test]
fn definitions() {
    check_places("LD Y0\nOUT Y1\nLD X0\nOUT $0Y0\nLD X1\nSET Y0\n", fx, ide::definition, &expect![[""]]);
    check_places("LD $0X0\nOUT Y1\nLD X0\nOUT Y0\n", fx, ide::definition, &expect![[""]]);
    check_places("LD M3\nOUT Y1\nLD X0\nMOV K1 K1M0\nLD $0M3\nOUT Y2\n", fx, ide::definition, &expect![[""]]);
    check_places("LD X0\nCJ $0P0\nLD X1\nOUT Y0\nP0\nEND\n", fx, ide::definition, &expect![[""]]);
    check_places(&marked(MOTOR, "$0Y0    |"), ladder, ide::definition, &expect![[""]]);
    check_places(&marked(DELAY, "LD $0Start"), iec, ide::definition, &expect![[""]]);
    check_places(&marked(DELAY, "ST $0Start"), iec, ide::definition, &expect![[""]]);
    check_places(&marked(DELAY, "Valve : $0Gate"), iec, ide::definition, &expect![[""]]);
    check_places(&marked(DELAY, "Valve.$0Open"), iec, ide::definition, &expect![[""]]);
    check_places(&marked(DELAY, "JMPC $0Finish"), iec, ide::definition, &expect![[""]]);
}

#[test]
fn all_references() {
    let all = |document: &Document, offset: usize| ide::references(document, offset, true);
    let uses = |document: &Document, offset: usize| ide::references(document, offset, false);
    check_places("LD M3\nOUT Y1\nLD X0\nMOV K1 K1M0\nLD $0M3\nMOV D0Z1 Z1\n", fx, all, &expect![[""]]);
    check_places("LD X0\nMOV D0$0Z1 D1\nMOV K0 Z1\n", fx, all, &expect![[""]]);
    check_places(&marked(MOTOR, "X0"), ladder, all, &expect![[""]]);
    check_places(&marked(MOTOR, "Y0"), ladder, all, &expect![[""]]);
    check_places(&marked(DELAY, "Start"), iec, all, &expect![[""]]);
    check_places(&marked(DELAY, "Start"), iec, uses, &expect![[""]]);
    check_places(&marked(DELAY, "$0Open : BOOL"), iec, all, &expect![[""]]);
    check_places(&marked(DELAY, "$0%QX0.0"), iec, all, &expect![[""]]);
}

#[test]
fn rename_in_lists() {
    check_rename("LD $0M0\nOUT Y0\nLD M0\nOUT M1\n", fx, "m7", &expect![[""]]);
    check_rename("LD $0M0\nOUT M1\n", fx, "M1", &expect![[""]]);
    check_rename("LD $0M0\nOUT M1\n", fx, "Y1", &expect![[""]]);
    check_rename("LD $0M0\nOUT M1\n", fx, "M9999", &expect![[""]]);
    check_rename("LD $0M0\nOUT M1\n", fx, "Motor", &expect![[""]]);
    check_rename("LD $0M8002\nOUT M1\n", fx, "M3", &expect![[""]]);
    check_rename("LD $0M1\nOUT Y1\nMOV K1 K1M0\n", fx, "M9", &expect![[""]]);
    check_rename("LD X0\nMOV K1 K2$0M0\nMOV K0 K2M0Z0\n", fx, "M16", &expect![[""]]);
    check_rename("LD $0T0\nOUT Y0\n", fx, "T200", &expect![[""]]);
    check_rename("LD X0\nCJ P$00\nP0\nEND\n", fx, "P5", &expect![[""]]);
    check_rename(&marked(DELAY, "LD $0Motor"), iec, "Pump", &expect![[""]]);
    check_rename(&marked(DELAY, "LD $0Motor"), iec, "start", &expect![[""]]);
    check_rename(&marked(DELAY, "LD $0Motor"), iec, "VAR", &expect![[""]]);
    check_rename(&marked(DELAY, ": $0TON"), iec, "Other", &expect![[""]]);
    check_rename(&marked(DELAY, "$0Open : BOOL"), iec, "Lift", &expect![[""]]);
    check_rename(&marked(DELAY, ": $0Gate"), iec, "Door", &expect![[""]]);
    check_rename(&marked(DELAY, "$0Finish:"), iec, "Done", &expect![[""]]);
}

#[test]
fn rename_keeps_the_drawing() {
    check_rename(&marked(MOTOR, "Y0"), ladder, "Y17", &expect![[""]]);
    check_rename(&marked(MOTOR, "T0"), ladder, "T100", &expect![[""]]);
    check_rename(&marked(MOTOR, "D0"), ladder, "D1000", &expect![[""]]);
    check_rename("|  X100                 Y0 |\n+---| |-----------------( )+\n", ladder, "X1", &expect![[""]]);
    check_rename("+--[X0]-------------(Y0)-+\n".replace("X0", "$0X0").as_str(), ladder, "X10", &expect![[""]]);
    check_rename("+--[X10]------------(Y0)-+\n".replace("X10", "$0X10").as_str(), ladder, "X1", &expect![[""]]);
}

#[test]
fn renaming_a_drawing_keeps_its_logic() {
    for (old, new) in [("Y0", "Y17"), ("X1", "X177"), ("T0", "T100"), ("D0", "D1000"), ("X0", "X5")] {
        let document = ladder(MOTOR);
        let offset = MOTOR.find(old).unwrap();
        let edits = ide::rename(&document, offset, new).unwrap();
        let renamed = ladder(&TextEdit::apply_all(&edits, MOTOR));
        let shape = |document: &Document| -> Vec<Vec<String>> {
            let mut lines = Vec::new();
            for at in document.chunks() {
                let Tree::Ladder(tree) = at.chunk.tree() else { continue };
                assert_eq!(tree.problems, [], "{}", document.text());
                for element in tree.rungs.iter().flat_map(|rung| &rung.graph.elements) {
                    let operands = element.operands.iter().map(|operand| operand.span.of(at.chunk.text()));
                    lines.push(operands.map(|word| word.replace(new, old)).collect());
                }
            }
            lines
        };
        assert_eq!(shape(&renamed), shape(&document), "{old} to {new}:\n{}", renamed.text());
    }
}

#[test]
fn outlines() {
    let program = "; Start\n; and stop\nLD X0\nOUT Y0\nSTL S20\nOUT Y1\nLD X1\nSET S21\nSTL S21\nOUT Y2\nRET\nLD X2\nCALL P1\nFEND\nP1\nLD X3\nOUT Y3\nSRET\nEND\n";
    check_outline(&fx(program), &expect![[""]]);
    check_outline(&ladder(&format!("NETWORK 3 'Drive'\n{MOTOR}\nL1:\n| X5   Y5|\n+-| |--( )-+\n")), &expect![[""]]);
    check_outline(&iec(DELAY), &expect![[""]]);
}

#[test]
fn folding() {
    let program = "; a\n; b\nLD X0\nOUT Y0\nLD X1\nMC N0 M0\nLD X2\nOUT Y1\nMCR N0\nFOR K3\nLD X1\nINC D0\nNEXT\nSTL S20\nOUT Y1\nSTL S21\nOUT Y2\nRET\n(* c\nd *)\nEND\n";
    check_folds(&fx(program), &expect![[""]]);
    check_folds(&ladder(&format!("NETWORK 3 'Drive'\n{MOTOR}\nL1:\n| X5   Y5|\n+-| |--( )-+\n")), &expect![[""]]);
    check_folds(&iec(DELAY), &expect![[""]]);
}

#[test]
fn highlighting() {
    check_tokens(&fx("0 LD X0 ; in\nOUT T0 K50\nMOV K4M0 D0Z1\nP0\nASC \"AB\" D0\nXYZ D0\n(* a\n b *)\n"), &expect![[""]]);
    check_tokens(&ladder("NETWORK 1 'x'\n|   X0      |\n+---| |--(Y0)+\n"), &expect![[""]]);
    check_tokens(&iec("PROGRAM p\nVAR a : BOOL; t : TON; END_VAR\nLD a (* c *)\nCAL t(IN := TRUE)\nl: JMP l\nEND_PROGRAM\n"), &expect![[""]]);
}

#[test]
fn hints_behind_presets() {
    let text = "LD X0\nOUT T0 K50\nOUT T200 K50\nOUT C0 K50\nOUT T246 K65\nMOV H0F D0\nMOV H1 D0\nOUT T1 K12345\nOUT T2 D0\n";
    let document = fx(text);
    let hints = ide::inlay_hints(&document, Span::new(0, text.len()), EN);
    let drawn: Vec<String> = hints
        .iter()
        .map(|hint| {
            let line = document.position(hint.offset, Encoding::Utf8).line as usize;
            let start = text.lines().take(line).map(|line| line.len() + 1).sum::<usize>();
            format!("{} {}", &text[start..hint.offset], hint.label)
        })
        .collect();
    expect![[""]].assert_eq(&drawn.join("\n"));
    let second = text.find("K50\nOUT C0").unwrap();
    assert_eq!(ide::inlay_hints(&document, Span::new(second, second + 5), EN).len(), 1);
}

#[test]
fn status_counts_what_the_program_is() {
    let status = ide::status(&fx("LD X0\nOUT T0 K50\nLD T0\nOUT Y0\nEND\n"));
    assert_eq!((status.target, status.dialect), ("fx2n", "fx"));
    assert_eq!((status.rungs, status.steps, status.capacity), (2, Some(7), 8000));
    assert_eq!(ide::status(&ladder(MOTOR)).rungs, 2);
    let status = ide::status(&iec(DELAY));
    assert_eq!((status.target, status.dialect, status.steps, status.capacity), ("iec", "iec", None, 0));
}

#[test]
fn status_follows_edits() {
    let mut document = fx("LD X0\nOUT Y0\nEND\n");
    assert_eq!(ide::status(&document).steps, Some(3));
    let edit = rungwise::document::Edit { range: Some(6..6), text: "AND X1\nMOV K1 D0\n".to_string() };
    document.apply(&[edit]);
    assert_eq!(ide::status(&document).steps, Some(9));
}

#[test]
fn formatting_changes_what_is_not_canonical_and_nothing_else() {
    for (document, expected) in [
        (fx("ld x0\nOUT  Y0\nEND\n"), "LD X0\nOUT Y0\nEND\n"),
        (iec("PROGRAM p\nVAR\na:BOOL;\nEND_VAR\nLD a\nEND_PROGRAM\n"), "PROGRAM p\nVAR\n    a : BOOL;\nEND_VAR\n    LD a\nEND_PROGRAM\n"),
    ] {
        let edits = ide::format(&document, STYLE);
        assert_eq!(TextEdit::apply_all(&edits, &document.text()), expected);
        let again = Document::new(expected, document.notation(), document.target());
        assert_eq!(ide::format(&again, STYLE), []);
    }
    let mut lines = String::new();
    for number in 0..50 {
        lines += &format!("LD X0\nOUT M{number}\n");
    }
    let document = fx(&(lines + "ld X1\nOUT Y0\n"));
    let touched: usize = ide::format(&document, STYLE).iter().map(|edit| edit.span.len()).sum();
    assert!(0 < touched && touched < 20, "{touched} bytes are replaced");
    let document = ladder("|X0   Y0|\n+-| |--( )+\n");
    let formatted = TextEdit::apply_all(&ide::format(&document, STYLE), &document.text());
    assert!(formatted.lines().all(|line| line.len() == 48), "{formatted}");
}

#[test]
fn fixes_of_the_diagnostics_under_the_cursor() {
    let document = fx("LD X8\nOUT Y0\nLD X9\nOUT Y1\nEND\n");
    let diagnostics = rungwise::check::all(&document, &Default::default());
    let titles = |span| -> Vec<String> {
        ide::fixes(&diagnostics, span).iter().map(|found| found.fix.title.render(EN)).collect()
    };
    expect![[""]].assert_eq(&titles(Span::at(4)).join("\n"));
    assert!(titles(Span::at(9)).is_empty());
    assert!(titles(Span::new(0, document.len())).len() > titles(Span::at(4)).len());
}

#[test]
fn snippets_of_every_instruction_fill_its_operands() {
    for target in Target::ALL.into_iter().filter(|target| target.is_fx()) {
        let document = Document::new("", Notation::FxIl, target);
        let found = ide::completions(&document, 0, EN);
        assert!(found.iter().any(|proposal| proposal.label == "LD"));
        for proposal in found {
            let form = Form::named(&proposal.label).expect("an instruction");
            assert!(form.is_on(target.model), "{} on {}", proposal.label, target.name);
            let needed = form.instruction.operands.iter().filter(|spec| !spec.optional).count();
            assert_eq!(proposal.edit.text.matches("${").count(), needed, "{}", proposal.edit.text);
        }
    }
}

/// Asks everything everywhere; the answers themselves are other tests' matter.
fn ask_everything(document: &Document) {
    let length = document.len();
    for offset in 0..=length + 1 {
        if let Some(hover) = ide::hover(document, offset, EN) {
            assert!(hover.span.start <= hover.span.end && hover.span.end as usize <= length);
        }
        for proposal in ide::completions(document, offset, EN) {
            assert!(proposal.edit.span.end as usize <= length);
        }
        ide::definition(document, offset);
        ide::references(document, offset, true);
        if ide::renamable(document, offset).is_some() {
            for new in ["X1", "M77", "Name_1", "P9", "%IX5.5"] {
                if let Ok(edits) = ide::rename(document, offset, new) {
                    TextEdit::apply_all(&edits, &document.text());
                }
            }
        }
    }
    ask_about_all(document);
}

fn ask_about_all(document: &Document) {
    let text = document.text();
    let mut end = 0;
    for token in ide::semantic_tokens(document) {
        assert!(token.span.start >= end && !token.span.is_empty(), "tokens overlap at {:?}", token.span);
        assert!(!token.span.of(&text).contains('\n'), "a token over lines at {:?}", token.span);
        end = token.span.end;
    }
    assert!(end as usize <= text.len());
    for fold in ide::folds(document) {
        assert!(fold.span.of(&text).contains('\n'), "a fold of one line at {:?}", fold.span);
    }
    ide::symbols(document, EN);
    ide::inlay_hints(document, Span::new(0, text.len()), EN);
    ide::status(document);
    let formatted = TextEdit::apply_all(&ide::format(document, STYLE), &text);
    let again = Document::new(&formatted, document.notation(), document.target());
    assert_eq!(TextEdit::apply_all(&ide::format(&again, STYLE), &formatted), formatted, "of {text}");
}

#[test]
fn nothing_panics_in_the_examples() {
    let examples = program_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")).unwrap();
    assert!(examples.len() > 6);
    for path in examples {
        let text = std::fs::read_to_string(&path).unwrap();
        ask_everything(&open_document(&path.to_string_lossy(), &text, &Manifest::default(), None, None));
    }
    ask_everything(&iec(DELAY));
    ask_everything(&ladder(MOTOR));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn nothing_panics_in_random_text(
        pieces in proptest::collection::vec(proptest::sample::select(PIECES), 0..14),
        notation in 0usize..4,
    ) {
        let text = pieces.concat();
        let (notation, model) = [
            (Notation::FxIl, Model::Fx3u),
            (Notation::IecIl, Model::Iec),
            (Notation::Ladder, Model::Fx2n),
            (Notation::Ladder, Model::Iec),
        ][notation];
        ask_everything(&Document::new(&text, notation, Target::of(model)));
    }
}

/// What programs are made of, whole and broken.
const PIECES: &[&str] = &[
    "\n", "\n\n", " ", "(*", "*)", "; x\n", "// 电机\n", "LD X0\n", "LD X9", "OUT T0 K50\n", "MOV K4M0Z1 D0\n", "P0", "FEND\n",
    "STL S20\n", "RET\n", "ß", "电机", "K", "D", "M80", "CJ ", ",", "VAR\n", "END_VAR\n", "a : BOOL;\n", "t : TON;\n", "f : F;\n",
    "PROGRAM P\n", "END_PROGRAM\n", "FUNCTION_BLOCK F\nVAR_INPUT i : INT; END_VAR\n", "END_FUNCTION_BLOCK\n", "LD a\n",
    "ST f.i\n", "CAL t(", "IN := ", "a)\n", "t.", "JMP l\n", "l:", "|   X0   Y0 |\n", "+---| |--( )-+\n", "|\n", "+--[MOV K1 D0]-+\n",
    "(T0 K5)", "[", "(", "-->>l\n", "NETWORK 1 'x'\n", "\t", "\r\n", "%IX0.0", "16#FF", "T#5s", "'", "\u{feff}",
];
