//! Refactorings in instruction lists of IEC 61131-3 and in drawings with declarations: the same as in FX programs, in
//! the words, margins and declarations of these.

use crate::ide_refactor::{applied, check_all, offered, titles};
use crate::translate_iec::{State, body, drawing, list, scan};
use proptest::prelude::*;
use rungwise::document::{Document, Notation};
use rungwise::ide::Refactoring;
use rungwise::target::Target;
use rungwise::text::{Language, Span};
use rungwise::translate::{Options, Proof, To, Translated, prove, translate};

pub(crate) fn program(variables: &str, body: &str) -> String {
    format!("PROGRAM Test\nVAR\n    {variables}\nEND_VAR\n{body}END_PROGRAM\n")
}

pub(crate) const BITS: &str = "a, b, c, d, e, m : BOOL; x, y, z : BOOL;";

/// Another form of a document.
fn form(document: &Document, to: To) -> String {
    let translation = translate(document, None, to, &Options::default());
    assert!(translation.is_certain(), "{}", translation.text);
    translation.text
}

/// The refactorings at the first place of `word` behind the declarations.
fn at(document: &Document, word: &str) -> Vec<Refactoring> {
    let text = document.text();
    let from = text.find("END_VAR").unwrap_or(0);
    let place = text[from..].find(word).unwrap_or_else(|| panic!("no {word} in {text}")) + from;
    offered(document, Span::at(place))
}

pub(crate) fn found(document: &Document, word: &str, kind: &str) -> Option<(String, String)> {
    let offered = at(document, word);
    let found = offered.iter().find(|refactoring| refactoring.kind.ends_with(kind))?;
    Some((found.title.render(Language::English), applied(document, found)))
}

/// The title of a refactoring at a word, and the text after it.
pub(crate) fn after(document: &Document, word: &str, kind: &str) -> (String, String) {
    found(document, word, kind)
        .unwrap_or_else(|| panic!("no {kind} among {:?}\n{}", titles(&at(document, word)), document.text()))
}

/// What the body of a list becomes; the declarations are those of [`BITS`] and stay.
pub(crate) fn body_after(own: &str, word: &str, kind: &str) -> String {
    let before = program(BITS, own);
    let (_, text) = after(&list(&before), word, kind);
    let frame = program(BITS, "");
    let head = frame.strip_suffix("END_PROGRAM\n").expect("a frame");
    let rest = text.strip_prefix(head).unwrap_or_else(|| panic!("{text}"));
    rest.strip_suffix("END_PROGRAM\n").unwrap_or_else(|| panic!("{text}")).to_string()
}

fn is_offered(own: &str, word: &str, kind: &str) -> bool {
    found(&list(&program(BITS, own)), word, kind).is_some()
}

/// Refactorings by what they make of a program of the FX family, in equations.
const EVERYWHERE: &[(&str, &str, &str, &str)] = &[
    ("rung.wideFirst", "X0", "LD X0\nLD X1\nOR X2\nANB\nOUT Y0\n", "Y0 = (X1 + X2)*X0"),
    ("rung.wideFirst", "X0", "LD X0\nLD X1\nAND X2\nORB\nOUT Y0\n", "Y0 = X1*X2 + X0"),
    ("rung.factor", "X1", "LD X0\nAND X1\nLD X0\nAND X2\nORB\nOUT Y0\n", "Y0 = X0*(X1 + X2)"),
    ("rung.factor", "X1", "LD X1\nAND X0\nLD X2\nAND X0\nORB\nOUT Y0\n", "Y0 = (X1 + X2)*X0"),
    ("rung.factor", "X1", "LD X0\nOR X1\nLD X0\nOR X2\nANB\nOUT Y0\n", "Y0 = X0 + X1*X2"),
    ("rung.split", "X0", "LD X0\nAND X1\nOUT Y0\nOUT Y1\n", "Y0 = X0*X1\nY1 = X0*X1"),
    (
        "rung.split",
        "X0",
        "LD X0\nOR X3\nMPS\nAND X1\nOUT Y0\nMPP\nAND X2\nOUT Y1\n",
        "Y0 = (X0 + X3)*X1\nY1 = (X0 + X3)*X2",
    ),
    ("rung.merge", "X1", "LD X0\nAND X1\nOUT Y0\nLD X0\nAND X1\nSET Y1\n", "Y0 = X0*X1\nSET Y1 = X0*X1"),
    (
        "rung.merge",
        "X1",
        "LDI X0\nAND X3\nAND X1\nOUT Y0\nLDI X0\nAND X3\nAND X2\nOUT Y1\n",
        "Y0 = [X0]*X3*X1\nY1 = [X0]*X3*X2",
    ),
    ("rung.invertContacts", "X0", "LD X0\nOR X1\nINV\nOUT Y0\n", "Y0 = [X0]*[X1]"),
];

#[test]
fn refactorings_are_the_same_in_every_notation() {
    let equations = |document: &Document| {
        let text = form(document, To::Boolean);
        let lines = text.lines().filter(|line| line.contains('=') && !line.starts_with(';'));
        lines.collect::<Vec<_>>().join("\n")
    };
    for (kind, word, fx, expected) in EVERYWHERE {
        let fx2n = Target::named("fx2n").expect("a model");
        let source = Document::new(fx, Notation::FxIl, fx2n);
        let options = Options { is_whole: false, ..Options::default() };
        let drawn =
            Document::new(&translate(&source, None, To::Ladder, &options).text, Notation::Ladder, fx2n);
        let iec = list(&form(&source, To::Iec));
        let iec_drawn = drawing(&form(&iec, To::Ladder));
        for document in [source, drawn, iec, iec_drawn] {
            let (title, text) = after(&document, word, kind);
            let after = Document::new(&text, document.notation(), document.target());
            assert_eq!(equations(&after), *expected, "{title}\n{}\n{text}", document.text());
            let has_steps = title.contains("step");
            assert!(!has_steps || document.target().is_fx(), "{title}");
            assert!(text.contains("VAR") == document.text().contains("VAR"), "{text}");
        }
    }
}

#[test]
fn a_list_keeps_its_margins_columns_letters_and_line_ends() {
    let wide = |own| body_after(own, "a", "rung.wideFirst");
    assert_eq!(wide("LD a\nAND( b\nOR c\n)\nST x\n"), "LD b\nOR c\nAND a\nST x\n");
    let columns = "    LD      a\n    AND(    b\n        OR      c\n    )\n    ST      x\n";
    assert_eq!(wide(columns), "    LD      b\n    OR      c\n    AND     a\n    ST      x\n");
    assert_eq!(wide("\tld a\n\tand( b\n\tor c\n\t)\n\tst x\n"), "\tld b\n\tor c\n\tand a\n\tst x\n");
    assert_eq!(wide("  LD a\n  &( B\n  OR c\n  )\n  ST x\n"), "  LD B\n  OR c\n  & a\n  ST x\n");
    let factored = body_after(
        "    LD   a\n    AND  b\n    OR(  a\n      AND  c\n    )\n    ST   x\n",
        "b",
        "rung.factor",
    );
    assert_eq!(factored, "    LD   a\n    AND( b\n      OR   c\n    )\n    ST   x\n");
    let text = program(BITS, "LD a\nAND( b\nOR c\n)\nST x\n").replace('\n', "\r\n");
    let (_, text) = after(&list(&text), "a", "rung.wideFirst");
    assert_eq!(text, program(BITS, "LD b\nOR c\nAND a\nST x\n").replace('\n', "\r\n"));
    let labelled = "    LD a\n    JMPC Go\nGo: LD a\n    AND( b\n    OR c\n    )\n    ST x\n";
    let moved = body_after(labelled, "b", "rung.wideFirst");
    assert_eq!(moved, "    LD a\n    JMPC Go\nGo: LD b\n    OR c\n    AND a\n    ST x\n");
}

#[test]
fn comments_stay_with_their_operands() {
    let own = "(* head *)\n  LD a (* door *)\n  (* above *)\n  AND( b   (* key *)\n  OR c\n  )\n  ST x (* lamp *)\n";
    let moved =
        "(* head *)\n  (* above *)\n  LD b     (* key *)\n  OR c\n  AND a (* door *)\n  ST x (* lamp *)\n";
    assert_eq!(body_after(own, "LD a", "rung.wideFirst"), moved);
    let twice = "LD a (* 1 *)\nAND( b\nOR a (* 2 *)\n)\nST x\n";
    assert_eq!(body_after(twice, "a", "rung.wideFirst"), "LD b\nOR a (* 2 *)\nAND a (* 1 *)\nST x\n");
    assert!(!is_offered("LD a\nAND( b\nOR c\n) (* or *)\nST x\n", "a", "rung.wideFirst"), "it would be lost");
    assert!(!is_offered("LD a\nST x\n(* why *)\nLD a\nST y\n", "x", "rung.merge"), "it has no place");
    assert!(is_offered("LD a\nST x\n\nLD a\nST y\n", "x", "rung.merge"));
}

#[test]
fn a_list_is_written_in_fewer_instructions() {
    let (title, text) =
        after(&list(&program(BITS, "LD a\nAND(\nLD b\nAND c\n)\nST x\n")), "b", "rung.shorten");
    assert_eq!(title, "Write rung in fewer instructions");
    assert_eq!(text, program(BITS, "LD a\nAND b\nAND c\nST x\n"));
    assert!(found(&list(&text), "b", "rung.shorten").is_none());
}

/// Wherever one refactoring that only rewrites a rung leads, the way ends.
#[test]
fn what_makes_rungs_shorter_does_not_go_round() {
    for own in [
        "LD a\nAND( b\nOR( c\nAND d\n)\n)\nOR( e\nAND a\n)\nST x\n",
        "LD a\nAND b\nOR( a\nAND c\n)\nOR( d\nAND( b\nOR e\n)\n)\nST x\nST y\n",
    ] {
        let mut text = program(BITS, own);
        for _ in 0..10 {
            let shorter = ["shorten", "wideFirst", "factor"];
            let next = shorter.iter().find_map(|kind| found(&list(&text), "a", kind));
            let Some((_, next)) = next else { break };
            assert!(next.lines().count() < text.lines().count(), "{text}\n{next}");
            text = next;
        }
    }
}

#[test]
fn branches_are_kept_in_declared_helpers() {
    let own = "LD a\nOR d\nAND b\nST x\nLD a\nOR d\nAND c\nST y\nLD e\nST z\n";
    let (title, merged) = after(&list(&program(BITS, own)), "b", "rung.merge");
    assert_eq!(title, "Merge with the rung below");
    let declared = format!("{BITS}\n    Held1            : BOOL;");
    let held = "LD a\nOR d\nST Held1\nAND b\nST x\nLD Held1\nAND c\nST y\nLD e\nST z\n";
    assert_eq!(merged, program(&declared, held));
    // The way back leaves the declaration, and the way there takes it again.
    let (_, split) = after(&list(&merged), "LD a", "rung.split");
    assert_eq!(split, program(&declared, own));
    assert_eq!(after(&list(&split), "b", "rung.merge").1, merged);
    // Where nothing is declared, a variable would be one of the program's.
    assert!(found(&list(own), "b", "rung.merge").is_none());
    // A single contact needs none: it is loaded again, as it is already.
    assert!(!is_offered("LD a\nAND b\nST x\nLD a\nAND c\nST y\n", "b", "rung.merge"));
}

#[test]
fn a_helper_may_serve_several_rungs_but_nobody_else() {
    let declared = format!("{BITS}\n    Held1 : BOOL;");
    let branch = "LD a\nOR d\nST Held1\nAND b\nST x\nLD Held1\nAND c\nST y\n";
    let filler: String = (0..200).map(|_| "LD e\nOR a\nST z\n").collect();
    let split =
        |rest: &str| found(&list(&program(&declared, &format!("{branch}{filler}{rest}"))), "b", "rung.split");
    assert!(split("").is_some());
    assert!(split(branch).is_some(), "each rung stores it before");
    assert!(split("LD Held1\nST z\n").is_none(), "it is read");
    assert!(split("LD a\nAND Held1\nST z\n").is_none(), "it is read");
    assert!(split("LD a\nOR d\nST Held1\nAND b\nST x\nGo:\nLD Held1\nAND c\nST y\n").is_none(), "jumped to");
}

#[test]
fn edges_keep_their_detectors() {
    let declared = format!("{BITS}\n    Start : R_TRIG;");
    let own = "CAL Start(CLK := a)\nLD b\nAND( Start.Q\nOR c\n)\nST x\n";
    let moved = "CAL Start(CLK := a)\nLD Start.Q\nOR c\nAND b\nST x\n";
    let text = |own: &str| program(&declared, own);
    assert_eq!(after(&list(&text(own)), "LD b", "rung.wideFirst").1, text(moved));
    let filler = "LD e\nOR a\nST z\n".repeat(200);
    let asked = text(&format!("{own}{filler}LD Start.Q\nST y\n"));
    assert!(found(&list(&asked), "LD b", "rung.wideFirst").is_none(), "others ask for the detector");
    // Two rungs with one edge need two detectors.
    let (_, split) =
        after(&list(&text("CAL Start(CLK := a)\nLD Start.Q\nAND b\nST x\nST y\n")), "LD Start", "rung.split");
    let two = "CAL Start(CLK := a)\nLD Start.Q\nAND b\nST x\nCAL Rise1(CLK := a)\nLD Rise1.Q\nAND b\nST y\n";
    assert_eq!(split, program(&format!("{declared}\n    Rise1 : R_TRIG;"), two));
}

#[test]
fn a_part_goes_to_a_declared_variable() {
    let own = "LD a\nOR m\nAND b\nST x\n";
    let (title, text) = after(&list(&program(BITS, own)), "OR m", "extract.relay");
    assert_eq!(title, "Extract to internal relay Relay1");
    // The colon stands below the one above.
    let declared = format!("{BITS}\n    Relay1           : BOOL;");
    assert_eq!(text, program(&declared, "LD a\nOR m\nST Relay1\nLD Relay1\nAND b\nST x\n"));
    assert!(!is_offered(own, "b", "extract.relay"), "all of it is no part");
    // The other name that means something there.
    let taken = program(&format!("{BITS}\n    relay1      : BOOL;"), own);
    let (_, text) = after(&list(&taken), "OR m", "extract.relay");
    assert!(text.contains("    relay1      : BOOL;\n    Relay2      : BOOL;\nEND_VAR"), "{text}");
    let drawn = drawing(&form(&list(&program(BITS, own)), To::Ladder));
    let (_, text) = after(&drawn, "m", "extract.relay");
    assert!(text.contains("    Relay1           : BOOL;\nEND_VAR"), "{text}");
    assert_eq!(
        body(&form(&drawing(&text), To::Iec)),
        body("LD a\nOR m\nST Relay1\nLD Relay1\nAND b\nST x\n")
    );
}

#[test]
fn a_unit_without_local_variables_gets_a_section() {
    let unit = |section: &str, own: &str| {
        format!(
            "FUNCTION_BLOCK Motor (* drive *)\nVAR_INPUT\n    a, b, c : BOOL;\nEND_VAR\nVAR_OUTPUT x : BOOL; END_VAR\n{section}{own}END_FUNCTION_BLOCK\n"
        )
    };
    let own = "    LD a\n    OR b\n    AND c\n    ST x\n";
    let (_, text) = after(&list(&unit("", own)), "OR b", "extract.relay");
    let extracted = "    LD a\n    OR b\n    ST Relay1\n    LD Relay1\n    AND c\n    ST x\n";
    assert_eq!(text, unit("VAR\n    Relay1 : BOOL;\nEND_VAR\n", extracted));
    // A drawing without declarations has none; one that a line of its own closes is gone on with.
    let (_, text) = after(&list(&unit("VAR k : INT; END_VAR\n", own)), "OR b", "extract.relay");
    assert_eq!(text, unit("VAR k : INT; Relay1 : BOOL; END_VAR\n", extracted));
    let bare = "LD a\nOR b\nAND c\nST x\n";
    let (_, text) = after(&list(bare), "OR b", "extract.relay");
    assert_eq!(text, "LD a\nOR b\nST Relay1\nLD Relay1\nAND c\nST x\n");
}

#[test]
fn a_variable_that_is_written_once_and_read_later_is_inlined() {
    let own = "LD a\nOR b\nST m\nLD c\nST y\nLD m\nAND d\nST x\n";
    let (title, text) = after(&list(&program(BITS, own)), "LD a", "inline.relay");
    assert_eq!(title, "Inline internal relay m");
    assert_eq!(text, program(BITS, "LD c\nST y\nLD a\nOR b\nAND d\nST x\n"));
    let drawn = drawing(&form(&list(&program(BITS, own)), To::Ladder));
    let (_, text) = after(&drawn, "m", "inline.relay");
    assert_eq!(body(&form(&drawing(&text), To::Iec)), body("LD c\nST y\nLD a\nOR b\nAND d\nST x\n"));
    let is = |own: &str| is_offered(own, "m", "inline.relay");
    assert!(is("LD a\nST m\nLDN m\nST x\n"), "inverted");
    assert!(!is("LD a\nST m\nLD c\nST a\nLD m\nST x\n"), "a has changed");
    assert!(!is("LD a\nST m\nLD c\nS m\nLD m\nST x\n"), "written twice");
    assert!(!is("LD a\nST m\n"), "never read");
    assert!(!is("LD a\nST m\nLD b\nJMPC Go\nLD m\nST x\nGo:\nLD c\nST y\n"), "jumped over");
    assert!(!is("LD a\nOR m\nST m\nLD m\nST x\n"), "holds itself");
    let kept = |section: &str, own: &str| {
        let text = format!(
            "PROGRAM P\n{section}\n    m : BOOL;\nEND_VAR\nVAR\n    a, x : BOOL;\nEND_VAR\n{own}END_PROGRAM\n"
        );
        found(&list(&text), "ST m", "inline.relay").is_some()
    };
    let plain = "LD a\nST m\nLD m\nST x\n";
    assert!(kept("VAR", plain));
    assert!(!kept("VAR_OUTPUT", plain), "others read it");
    assert!(!kept("VAR_IN_OUT", plain), "it is not its own");
    assert!(!is_offered("LD a\nST q\nLD q\nST x\n", "q", "inline.relay"), "nobody knows what it is");
}

#[test]
fn a_variable_of_the_same_name_in_another_unit_is_another_one() {
    let unit = |name: &str, own: &str| {
        format!("PROGRAM {name}\nVAR\n    a, b, c, m, x : BOOL;\nEND_VAR\n{own}END_PROGRAM\n")
    };
    let text = unit("One", "LD b\nST x\n")
        + &unit("Two", "LD a\nST m\nLD m\nST x\n")
        + &unit("Three", "LD m\nST x\nLD x\nST a\n");
    let document = list(&text);
    let place = text.find("LD a").expect("a rung");
    let offered = offered(&document, Span::at(place));
    let inlined = offered.iter().find(|one| one.kind == "refactor.inline.relay").expect("an inlining");
    let expected = unit("One", "LD b\nST x\n")
        + &unit("Two", "LD a\nST x\n")
        + &unit("Three", "LD m\nST x\nLD x\nST a\n");
    assert_eq!(applied(&document, inlined), expected);
    // The last rung of a unit is not merged with the first one of the next.
    let text = unit("One", "LD a\nST x\n") + &unit("Two", "LD a\nST m\n");
    assert!(found(&list(&text), "LD a", "rung.merge").is_none());
    let (_, text) = after(
        &list(&unit("One", "LD a\nOR b\nAND c\nST x\n").repeat(2).replacen("One", "Two", 1)),
        "OR b",
        "extract.relay",
    );
    let declarations: Vec<&str> = text.split("PROGRAM ").filter(|unit| unit.contains("Relay1 ")).collect();
    assert!(declarations.len() == 1 && declarations[0].starts_with("Two"), "{text}");
}

/// A condition of a generated rung.
#[derive(Clone, Debug)]
pub(crate) enum Condition {
    Contact(&'static str, bool),
    /// A rising edge.
    Edge(&'static str),
    Join(bool, Vec<Condition>),
    Inverse(Box<Condition>),
}

/// What is done with the result: an operator and a bit, or one more contact in series.
pub(crate) type Output = (&'static str, &'static str);

pub(crate) fn condition() -> impl Strategy<Value = Condition> {
    let bit = prop::sample::select(&["a", "b", "c", "m", "x"][..]);
    let contact = (bit, any::<bool>()).prop_map(|(bit, is_open)| Condition::Contact(bit, is_open));
    let edge = prop::sample::select(&["a", "m", "x"][..]).prop_map(Condition::Edge);
    prop_oneof![9 => contact, 1 => edge].prop_recursive(3, 9, 3, |inner| {
        prop_oneof![
            6 => (any::<bool>(), prop::collection::vec(inner.clone(), 2..4))
                .prop_map(|(in_series, parts)| Condition::Join(in_series, parts)),
            1 => inner.prop_map(|inner| Condition::Inverse(Box::new(inner))),
        ]
    })
}

pub(crate) fn outputs() -> impl Strategy<Value = Vec<Output>> {
    let word =
        prop_oneof![5 => Just("ST"), 1 => Just("STN"), 1 => Just("S"), 1 => Just("R"), 2 => Just("AND")];
    let output = (word, prop::sample::select(&["m", "x", "y"][..]));
    prop::collection::vec(output, 0..3)
}

/// The instructions of a condition; calls of detectors, whose names are numbered, join `calls`.
fn write(condition: &Condition, lines: &mut Vec<String>, calls: &mut Vec<String>, number: &mut usize) {
    let negation = |is_open: &bool| if *is_open { "" } else { "N" };
    match condition {
        Condition::Contact(bit, is_open) => lines.push(format!("LD{} {bit}", negation(is_open))),
        Condition::Edge(bit) => {
            *number += 1;
            calls.push(format!("CAL Rise{number}(\nCLK := {bit}\n)"));
            lines.push(format!("LD Rise{number}.Q"));
        }
        Condition::Inverse(inner) => {
            write(inner, lines, calls, number);
            lines.push("NOT".to_string());
        }
        Condition::Join(in_series, parts) => {
            let word = if *in_series { "AND" } else { "OR" };
            for (place, part) in parts.iter().enumerate() {
                match part {
                    Condition::Contact(bit, is_open) if place > 0 => {
                        lines.push(format!("{word}{} {bit}", negation(is_open)));
                    }
                    part => {
                        lines.extend((place > 0).then(|| format!("{word}(")));
                        write(part, lines, calls, number);
                        lines.extend((place > 0).then(|| ")".to_string()));
                    }
                }
            }
        }
    }
}

pub(crate) fn written(rungs: &[(Condition, Vec<Output>, &'static str)]) -> String {
    let mut lines = Vec::new();
    let mut detectors = 0;
    for (condition, outputs, last) in rungs {
        let (mut own, mut calls) = (Vec::new(), Vec::new());
        write(condition, &mut own, &mut calls, &mut detectors);
        lines.extend(calls);
        lines.extend(own);
        lines.extend(outputs.iter().map(|(word, bit)| format!("{word} {bit}")));
        lines.push(format!("ST {last}"));
    }
    let declared: String = (1..=detectors).map(|number| format!("\n    Rise{number} : R_TRIG;")).collect();
    program(&format!("a, b, c, m, n, x, y, z : BOOL;{declared}"), &(lines.join("\n") + "\n"))
}

/// Whether two lists leave the same in every bit but one, from some states, over two scans.
pub(crate) fn do_the_same(left: &str, right: &str, relay: &str) -> Result<(), String> {
    const NAMES: [&str; 7] = ["a", "b", "c", "m", "n", "x", "y"];
    // One state in three of all.
    for number in (0..1_u32 << NAMES.len()).step_by(3) {
        let run = |text: &str| {
            let bits = NAMES.iter().enumerate();
            let mut state: State =
                bits.map(|(place, name)| (name.to_string(), i64::from(number >> place & 1))).collect();
            scan(text, &mut state);
            scan(text, &mut state);
            let counts = |name: &str| name != relay && (NAMES.contains(&name) || name == "z");
            let mut bits: Vec<_> = state.into_iter().filter(|(name, _)| counts(name)).collect();
            bits.sort();
            bits
        };
        if run(left) != run(right) {
            return Err(format!("{number:b}: {:?} and {:?}", run(left), run(right)));
        }
    }
    Ok(())
}

/// The name of the relay that a refactoring makes or removes.
pub(crate) fn relay_of(refactoring: &Refactoring) -> String {
    let title = refactoring.title.render(Language::English);
    title.split_once("internal relay ").map_or("", |(_, name)| name).to_lowercase()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_offered_in_a_list_changes_nothing(
        rungs in prop::collection::vec((condition(), outputs(), prop::sample::select(&["n", "y", "z"][..])), 1..4)
    ) {
        let text = written(&rungs);
        check_all(&list(&text), |refactoring, after| {
            let relay = relay_of(refactoring);
            // What was proved of a stretch holds for the whole.
            let proof = prove(&list(&text), &list(after));
            if relay.is_empty() && !matches!(proof, Proof::Equal { .. }) {
                return Err(format!("{proof:?}"));
            }
            do_the_same(&text, after, &relay)
        })?;
    }

    #[test]
    fn what_is_offered_in_a_drawing_changes_nothing(
        rungs in prop::collection::vec((condition(), outputs(), prop::sample::select(&["n", "y", "z"][..])), 1..4)
    ) {
        let text = written(&rungs);
        let drawn = translate(&list(&text), None, To::Ladder, &Options::default());
        prop_assume!(drawn.is_certain());
        check_all(&drawing(&drawn.text), |refactoring, after| {
            let list = translate(&drawing(after), None, To::Iec, &Options::default());
            // The edge of what the same rung drives has no list.
            let no_list = |rung: &Translated| {
                rung.note.as_ref().is_some_and(|note| note.key() == "translate.edge-of-driven")
            };
            if list.rungs.iter().any(no_list) {
                return Ok(());
            }
            if !list.is_certain() {
                return Err(list.text);
            }
            do_the_same(&text, &list.text, &relay_of(refactoring))
        })?;
    }
}

#[test]
fn there_is_much_to_offer_in_a_list() {
    let text = program(BITS, "LD a\nAND( b\nOR c\n)\nST m\nST y\nLD m\nAND d\nST x\nLD m\nAND d\nST z\n");
    let count = check_all(&list(&text), |_, _| Ok(())).expect("no check");
    assert!(count >= 6, "{count}");
}

#[test]
fn names_of_one_address_are_one_bit() {
    let program = |address: &str| {
        format!(
            "PROGRAM P\nVAR\n    p{address} : BOOL;\n    q{address} : BOOL;\n    x : BOOL;\nEND_VAR\nLDN p\nST q\nST x\nEND_PROGRAM\n"
        )
    };
    for (address, splits) in [("", true), (" AT %QX0.0", false)] {
        let source = list(&program(address));
        let drawn = drawing(&form(&source, To::Ladder));
        for document in [source, drawn] {
            assert_eq!(found(&document, "p", "rung.split").is_some(), splits, "{}", document.text());
        }
    }
}

#[test]
fn a_rung_deep_in_a_long_unit_needs_what_stands_before_it_only_where_it_begins() {
    let before: String = (0..300).map(|_| "LD e\nOR a\nST z\n").collect();
    let own = "LD a\nAND( b\nOR c\n)\nST x\n";
    let moved = "LD b\nOR c\nAND a\nST x\n";
    for (head, tail) in [
        ("LD e\nOR a\nST z\n", "LD e\nOR d\nST z\n"),
        ("CAL T1(IN := e)\n", "LD e\nST z\n"),
        ("LD e\nJMPCN Go\nLD k\nADD 1\nST k\nGo:\nLD e\nST z\n", "LD e\nST z\n"),
    ] {
        let declared = format!("{BITS}\n    k : INT;\n    T1 : TON;");
        let text = |own: &str| program(&declared, &format!("{before}{head}{own}{tail}{before}"));
        assert_eq!(after(&list(&text(own)), "b\nOR c", "rung.wideFirst").1, text(moved), "{head}");
    }
}

/// What is no bit stays in its lines: calls with their parameters, comparisons, calculations with the label behind them.
#[test]
fn what_a_rung_drives_besides_bits_is_carried_along() {
    let wide = "LD a\nAND( b\nOR c\n)\n";
    let moved = "LD b\nOR c\nAND a\n";
    let variables = format!("{BITS}\n    T1   : TON;\n    n, k : INT;");
    for own in [
        "{}ST T1.IN\nCAL T1(PT := T#1s)\nLD T1.Q\nST x\n",
        "{}ST T1.IN\nCAL T1(\n    PT := T#1s,\n    ET => t\n)\nLD T1.Q\nST x\n",
        "{}AND( n\nGT 5\n)\nST x\n",
        "{}JMPCN Done\nLD n\nADD 1\nST n\nDone:\nLD d\nST y\n",
        "{}RETC\n",
        "{}CALC T1(PT := T#1s)\n",
    ] {
        let text = |condition: &str| program(&variables, &own.replace("{}", condition));
        assert_eq!(after(&list(&text(wide)), "LD a", "rung.wideFirst").1, text(moved));
    }
}

/// Where so much would be read again at each step of the cursor, a selection says that it is meant.
#[test]
fn a_long_section_of_variables_is_added_to_for_who_selects() {
    let variables: String = (0..3000).map(|number| format!("\n    v{number} : BOOL;")).collect();
    let document = list(&program(&format!("{BITS}{variables}"), "LD a\nOR b\nAND c\nST x\n"));
    assert!(found(&document, "OR b", "extract.relay").is_none());
    let text = document.text();
    let selected = Span::new(text.find("LD a").expect("a rung"), text.find("AND c").expect("a rung"));
    let offered = offered(&document, selected);
    let extracted = offered.iter().find(|one| one.kind == "refactor.extract.relay").expect("an extraction");
    // One edit for the declaration, and one for the rung: what is open between two reaches to the end of the unit.
    assert_eq!(extracted.edits.len(), 2);
    assert!(applied(&document, extracted).contains("    v2999 : BOOL;\n    Relay1 : BOOL;\nEND_VAR"));
}

#[test]
fn who_else_asks_for_a_variable_by_its_instance_keeps_it() {
    let unit = "FUNCTION_BLOCK Motor\nVAR\n    a, m, x : BOOL;\nEND_VAR\nLD a\nST m\nLD m\nST x\nEND_FUNCTION_BLOCK\n";
    let caller = |read: &str| {
        format!(
            "{unit}PROGRAM P\nVAR\n    drive : Motor; z : BOOL;\nEND_VAR\nCAL drive\nLD drive.{read}\nST z\nEND_PROGRAM\n"
        )
    };
    assert!(found(&list(&caller("x")), "LD a", "inline.relay").is_some());
    assert!(found(&list(&caller("M")), "LD a", "inline.relay").is_none());
}

#[test]
fn what_nobody_wants_written_so_is_not_offered() {
    for (own, at, kind) in [
        // XOR would be written as what it is made of.
        ("LD a\nXOR b\nST x\nST y\n", "a", "rung.split"),
        ("LD a\nXOR b\nST x\nLD a\nXOR b\nST y\n", "a", "rung.merge"),
        // The comment of a rung that goes away would stand above another.
        ("LD c\nST y\n\n(* drive *)\nLD a\nST m\n\n(* lamp *)\nLD m\nST x\n", "ST m", "inline.relay"),
    ] {
        assert_eq!(found(&list(&program(BITS, own)), at, kind), None, "{own}");
    }
    // What a jump leaves out would stand in one network with it.
    let drawn = |output: &str| {
        let head = program(BITS, "").replace("END_PROGRAM\n", "");
        format!(
            "{head}\n|   a     b          |\n+--| |---| |---{output}+\n\n|   a           x    |\n+--| |---------( )---+\n\nL1:\n|   b           y    |\n+--| |---------( )---+\n\nEND_PROGRAM\n"
        )
    };
    for (output, is_offered) in [("(z)--", true), (">>L1 ", false)] {
        let document = drawing(&drawn(output));
        assert_eq!(found(&document, "| |", "rung.merge").is_some(), is_offered, "{}", document.text());
    }
}

#[test]
fn the_relay_at_the_cursor_is_inlined_else_any_that_can_be() {
    let own = "LD a\nST m\nST c\nLD m\nAND b\nST x\nLD c\nAND d\nST y\n";
    assert!(after(&list(&program(BITS, own)), "ST c", "inline.relay").0.ends_with("relay c"));
    assert!(after(&list(&program(BITS, own)), "ST m", "inline.relay").0.ends_with("relay m"));
    let unread = "LD a\nST z\nST m\nLD m\nST y\n";
    assert!(after(&list(&program(BITS, unread)), "ST z", "inline.relay").0.ends_with("relay m"));
}
