//! Refactorings: what is offered where, what it makes of the text, and that it never changes what a program does.

use proptest::prelude::*;
use rungwise::document::{Document, Edit, Notation, ProjectView};
use rungwise::ide::{self, Refactoring, Style};
use rungwise::project::FormatStyle;
use rungwise::target::Target;
use rungwise::text::{Language, Span};
use rungwise::translate::{Options, To, translate};

pub(crate) const STYLE: Style = Style { kind: FormatStyle::Iec, width: 48 };

fn fx2n() -> &'static Target {
    Target::named("fx2n").expect("a model")
}

fn list(text: &str) -> Document {
    Document::new(text, Notation::FxIl, fx2n())
}

fn drawing(text: &str) -> Document {
    Document::new(text, Notation::Ladder, fx2n())
}

pub(crate) fn offered(document: &Document, span: Span) -> Vec<Refactoring> {
    ide::refactorings(&ProjectView::alone(document), span, STYLE)
}

/// The refactorings at the first place of `word`.
fn at(document: &Document, word: &str) -> Vec<Refactoring> {
    let place = document.text().find(word).unwrap_or_else(|| panic!("no {word}"));
    offered(document, Span::at(place))
}

pub(crate) fn titles(refactorings: &[Refactoring]) -> Vec<String> {
    refactorings.iter().map(|refactoring| refactoring.title.render(Language::English)).collect()
}

pub(crate) fn applied(document: &Document, refactoring: &Refactoring) -> String {
    let mut after = document.clone();
    let edits = refactoring.edits.iter().rev();
    let edits = edits.map(|edit| Edit { range: Some(edit.span.range()), text: edit.text.clone() });
    after.apply(&edits.collect::<Vec<_>>());
    after.text()
}

/// The text after the refactoring of this kind at a word.
fn after(document: &Document, word: &str, kind: &str) -> (String, String) {
    let offered = at(document, word);
    let found = offered.iter().find(|refactoring| refactoring.kind.ends_with(kind));
    let found = found.unwrap_or_else(|| panic!("no {kind} among {:?}", titles(&offered)));
    (found.title.render(Language::English), applied(document, found))
}

fn is_offered(document: &Document, word: &str, kind: &str) -> bool {
    at(document, word).iter().any(|refactoring| refactoring.kind.ends_with(kind))
}

/// A drawing of a list, as the translator draws it.
fn drawn(text: &str) -> Document {
    drawing(&translate(&list(text), None, To::Ladder, &Options::default()).text)
}

/// The list of a drawing.
fn listed(text: &str) -> String {
    let options = Options { is_whole: false, ..Options::default() };
    translate(&drawing(text), None, To::Fx, &options).text
}

#[test]
fn a_list_is_written_in_fewer_steps() {
    let document = list("LD X0\nLD X1\nANB\nOUT Y0\nEND\n");
    let (title, text) = after(&document, "X1", "rung.shorten");
    assert_eq!(title, "Write rung in fewer steps (saves 1 step)");
    assert_eq!(text, "LD X0\nAND X1\nOUT Y0\nEND\n");
    assert!(!is_offered(&list(&text), "X1", "rung.shorten"));
    assert!(!is_offered(&drawn("LD X0\nAND X1\nOUT Y0\n"), "X1", "rung.shorten"));
}

#[test]
fn comments_stay_with_their_operands() {
    let document = list("; head\n  LD X0 ; door\n  ; above\n  LD X1 ; key\n  ANB\n  OUT Y0\nEND\n");
    let (_, text) = after(&document, "X1", "rung.shorten");
    assert_eq!(text, "; head\n  LD X0 ; door\n  ; above\n  AND X1 ; key\n  OUT Y0\nEND\n");
    let homeless = list("LD X0\nLD X1\nANB ; joins\nOUT Y0\nEND\n");
    assert!(!is_offered(&homeless, "X1", "rung.shorten"), "the comment would be lost");
    let numbered = list("0 LD X0\n1 LD X1\n2 ANB\n3 OUT Y0\n4 END\n");
    assert!(!is_offered(&numbered, "X1", "rung.shorten"), "step numbers would be wrong");
}

#[test]
fn a_wide_branch_moves_first() {
    let text = "LD X0\nLD X1\nOR X2\nANB\nOUT Y0\n";
    let (title, moved) = after(&list(text), "X0", "rung.wideFirst");
    assert_eq!(title, "Move wide branch first (saves 1 step)");
    assert_eq!(moved, "LD X1\nOR X2\nAND X0\nOUT Y0\n");
    let (title, moved) = after(&drawn(text), "X0", "rung.wideFirst");
    assert_eq!(title, "Move wide branch first (saves 1 step)");
    assert_eq!(listed(&moved), "LD X1\nOR X2\nAND X0\nOUT Y0\n");
    assert!(!is_offered(&list("LD X0\nAND X1\nOUT Y0\n"), "X0", "rung.wideFirst"));
}

#[test]
fn common_contacts_are_factored_out() {
    let text = "LD X0\nAND X1\nLD X0\nAND X2\nORB\nOUT Y0\n";
    let (title, factored) = after(&list(text), "X1", "rung.factor");
    assert_eq!(title, "Factor out common contacts (saves 1 step)");
    assert_eq!(factored, "LD X0\nLD X1\nOR X2\nANB\nOUT Y0\n");
    let ends = "LD X1\nAND X0\nLD X2\nAND X0\nORB\nOUT Y0\n";
    assert_eq!(after(&list(ends), "X1", "rung.factor").1, "LD X1\nOR X2\nAND X0\nOUT Y0\n");
    let sums = "LD X0\nOR X1\nLD X0\nOR X2\nANB\nOUT Y0\n";
    assert_eq!(after(&list(sums), "X1", "rung.factor").1, "LD X0\nLD X1\nAND X2\nORB\nOUT Y0\n");
    let absorbed = "LD X0\nLD X0\nAND X1\nORB\nOUT Y0\n";
    assert_eq!(after(&list(absorbed), "X1", "rung.factor").1, "LD X0\nOUT Y0\n");
    let drawn = drawn(ends);
    assert_eq!(listed(&after(&drawn, "X1", "rung.factor").1), "LD X1\nOR X2\nAND X0\nOUT Y0\n");
}

#[test]
fn branches_of_a_stack_become_rungs_and_come_back() {
    let branched = "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nAND X2\nOUT Y1\nMPP\nAND X3\nOUT Y2\nEND\n";
    let (title, split) = after(&list(branched), "X0", "rung.split");
    assert_eq!(title, "Replace MPS, MRD and MPP by a rung for each output (saves 1 step)");
    assert_eq!(split, "LD X0\nAND X1\nOUT Y0\nLD X0\nAND X2\nOUT Y1\nLD X0\nAND X3\nOUT Y2\nEND\n");
    let (title, two) = after(&list(&split), "X0", "rung.merge");
    assert_eq!(title, "Merge with the rung below by MPS, MRD and MPP (1 step more)");
    let (title, three) = after(&list(&two), "X0", "rung.merge");
    assert_eq!((title.as_str(), three.as_str()), ("Merge with the rung below by MPS, MRD and MPP", branched));
    // The condition that all share may be a block of its own.
    let block = "LD X0\nOR X4\nMPS\nAND X1\nOUT Y0\nMPP\nAND X2\nOUT Y1\nEND\n";
    let (title, split) = after(&list(block), "X0", "rung.split");
    assert_eq!(title, "Replace MPS, MRD and MPP by a rung for each output");
    assert_eq!(split, "LD X0\nOR X4\nAND X1\nOUT Y0\nLD X0\nOR X4\nAND X2\nOUT Y1\nEND\n");
    assert_eq!(after(&list(&split), "X0", "rung.merge").1, block);
    // What the first branch drives the second would ask for once more.
    let asked = "LD X0\nOR M4\nMPS\nAND X1\nOUT M4\nMPP\nAND X2\nOUT Y1\nEND\n";
    assert!(!is_offered(&list(asked), "X0", "rung.split"));
}

#[test]
fn a_rung_is_split_where_nothing_between_changes_what_is_read() {
    let text = "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nAND X2\nOUT Y1\n";
    let (title, split) = after(&list(text), "X0", "rung.split");
    assert_eq!(title, "Replace MPS, MRD and MPP by a rung for each output (saves 1 step)");
    assert_eq!(split, "LD X0\nAND X1\nOUT Y0\nLD X0\nAND X2\nOUT Y1\n");
    let (title, _) = after(&list("LD X0\nAND X1\nOUT Y0\nOUT Y1\n"), "X0", "rung.split");
    assert_eq!(title, "Split rung: one for each output (2 steps more)");
    let latch = list("LD X0\nOR Y0\nOUT Y0\nOUT Y1\n");
    assert!(is_offered(&latch, "X0", "rung.split"), "Y0 is the condition already");
    let toggle = list("LDI Y0\nOUT Y0\nOUT Y1\n");
    assert!(!is_offered(&toggle, "Y0", "rung.split"), "Y1 would read the new Y0");
    let drawn = drawn(text);
    let (title, split) = after(&drawn, "X1", "rung.split");
    assert!(title.starts_with("Split rung"), "{title}");
    assert_eq!(listed(&split), "LD X0\nAND X1\nOUT Y0\nLD X0\nAND X2\nOUT Y1\n");
}

#[test]
fn neighbouring_rungs_with_a_common_condition_are_merged() {
    let text = "LD X0\nAND X1\nOUT Y0\nLD X0\nAND X2\nOUT Y1\nEND\n";
    let (title, merged) = after(&list(text), "X1", "rung.merge");
    assert_eq!(title, "Merge with the rung below by MPS, MRD and MPP (1 step more)");
    assert_eq!(merged, "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nAND X2\nOUT Y1\nEND\n");
    let equal = "LD X0\nAND X1\nOUT Y0\nLD X0\nAND X1\nOUT Y1\n";
    let (title, merged) = after(&list(equal), "X1", "rung.merge");
    assert_eq!(title, "Merge with the rung below (saves 2 steps)");
    assert_eq!(merged, "LD X0\nAND X1\nOUT Y0\nOUT Y1\n");
    assert_eq!(listed(&after(&drawn(equal), "X1", "rung.merge").1), merged);
    assert!(!is_offered(&list("LD X0\nOUT M0\nLD X0\nP0\nOUT Y1\n"), "M0", "rung.merge"));
    assert!(!is_offered(&list("LDI M0\nOUT M0\nLDI M0\nOUT Y1\n"), "M0", "rung.merge"), "M0 has changed");
    let commented = list("LD X0\nOUT Y0\n; why\nLD X0\nOUT Y1\n");
    assert!(!is_offered(&commented, "Y0", "rung.merge"), "the comment would have no place");
}

#[test]
fn an_inversion_has_two_forms() {
    let text = "LD X0\nOR X1\nINV\nOUT Y0\n";
    let (title, spread) = after(&list(text), "X0", "rung.invertContacts");
    assert_eq!(title, "De Morgan: invert the contacts instead of the whole (saves 1 step)");
    assert_eq!(spread, "LDI X0\nANI X1\nOUT Y0\n");
    // A list is written in the fewest steps; a drawing shows the inverter.
    assert!(!is_offered(&list(&spread), "X0", "rung.invertWhole"));
    let open = drawn(&spread);
    let (title, whole) = after(&open, "X0", "rung.invertWhole");
    assert_eq!(title, "De Morgan: invert the whole instead of its contacts");
    assert_ne!(whole, open.text());
    assert_eq!(listed(&whole), spread);
    let (_, contacts) = after(&drawn(text), "X0", "rung.invertContacts");
    assert_eq!(contacts, open.text());
    assert!(!is_offered(&list("LDP X0\nOR X1\nINV\nOUT Y0\n"), "X0", "rung.invertContacts"));
    assert!(!is_offered(&list("LDI X0\nAND X1\nOUT Y0\n"), "X0", "rung.invertWhole"));
}

#[test]
fn a_block_goes_to_the_next_free_relay() {
    let text = "LD X0\nOR M0\nAND X1\nOUT Y0\n";
    let (title, extracted) = after(&list(text), "M0", "extract.relay");
    assert_eq!(title, "Extract to internal relay M1 (2 steps more)");
    assert_eq!(extracted, "LD X0\nOR M0\nOUT M1\nLD M1\nAND X1\nOUT Y0\n");
    let drawn = drawn(text);
    assert_eq!(listed(&after(&drawn, "M0", "extract.relay").1), extracted);
    assert!(!is_offered(&list(text), "X1", "extract.relay"), "all of it is no part");
    let document = list("LD X0\nAND X1\nAND X2\nOUT Y0\nMOV K4M0 D0\n");
    let selected = Span::new(document.text().find("AND X1").unwrap(), document.text().find("OUT").unwrap());
    let offered = offered(&document, selected);
    let found = offered.iter().find(|one| one.kind == "refactor.extract.relay").expect("a selection");
    assert_eq!(found.title.render(Language::English), "Extract to internal relay M16 (2 steps more)");
    let text = applied(&document, found);
    assert!(text.starts_with("LD X1\nAND X2\nOUT M16\nLD X0\nAND M16\nOUT Y0\n"), "{text}");
}

#[test]
fn a_label_stays_before_the_rung_that_is_put_above() {
    let text = "CJ P0\nP0\nLD X0\nOR X2\nAND X1\nOUT Y0\nEND\n";
    let document = list(&format!("LD X5\n{text}"));
    let (_, extracted) = after(&document, "X2", "extract.relay");
    assert!(extracted.contains("P0\nLD X0\nOR X2\nOUT M0\nLD M0\n"), "{extracted}");
}

#[test]
fn a_relay_that_is_written_once_and_read_later_is_inlined() {
    let text = "LD X0\nOR X1\nOUT M0\nLD X2\nOUT Y1\nLD M0\nAND X3\nOUT Y0\nEND\n";
    let (title, inlined) = after(&list(text), "M0", "inline.relay");
    assert_eq!(title, "Inline internal relay M0 (saves 2 steps)");
    assert_eq!(inlined, "LD X2\nOUT Y1\nLD X0\nOR X1\nAND X3\nOUT Y0\nEND\n");
    let drawn = drawn(text);
    let (_, redrawn) = after(&drawn, "M0", "inline.relay");
    assert_eq!(listed(&redrawn), "LD X2\nOUT Y1\nLD X0\nOR X1\nAND X3\nOUT Y0\nEND\n");
    let is = |text: &str| is_offered(&list(text), "M0", "inline.relay");
    assert!(is("LD X0\nOUT M0\nLDI M0\nOUT Y0\n"), "inverted");
    assert!(!is("LD X0\nOUT M0\nLDP M0\nOUT Y0\n"), "an edge remembers");
    assert!(!is("LD X0\nOUT M0\nLD X1\nOUT X0\nLD M0\nOUT Y0\n"), "X0 has changed");
    assert!(!is("LD X0\nOUT M0\nLD X1\nOUT M0\nLD M0\nOUT Y0\n"), "written twice");
    assert!(!is("LD X0\nOUT M0\nLD M0\nOUT Y0\nMOV K4M0 D0\n"), "read as a word");
    assert!(!is("LD X0\nOUT M0\n"), "never read");
    assert!(!is("LD X0\nOUT M0\nLD X1\nCJ P0\nLD M0\nOUT Y0\nP0\nEND\n"), "jumped over");
    assert!(!is("LD X0\nOR M0\nOUT M0\nLD M0\nOUT Y0\n"), "holds itself");
    assert!(!is_offered(&list("LD X0\nOUT M500\nLD M500\nOUT Y0\n"), "M500", "inline.relay"), "latched");
    assert!(!is_offered(&list("LD M0\nOUT Y0\nLD X0\nOUT M0\n"), "X0", "inline.relay"), "read before");
}

#[test]
fn nothing_is_offered_for_what_cannot_be_read() {
    for text in ["LD X0\nOUTT Y0\n", "LD X0\nORB\nOUT Y0\n", "END\n", "", "; only words\n"] {
        let document = list(text);
        for place in 0..=text.len() {
            assert_eq!(offered(&document, Span::at(place)), Vec::new(), "{text:?} at {place}");
        }
    }
}

#[test]
fn line_ends_and_the_rest_of_the_file_stay() {
    let document = list("LD X9\r\nOUT Y9\r\nLD X0\r\nLD X1\r\nANB\r\nOUT Y0");
    let (_, text) = after(&document, "X1", "rung.shorten");
    assert_eq!(text, "LD X9\r\nOUT Y9\r\nLD X0\r\nAND X1\r\nOUT Y0");
}

/// A condition of a generated rung.
#[derive(Clone, Debug)]
enum Condition {
    Contact(&'static str, bool),
    And(Vec<Condition>),
    Or(Vec<Condition>),
    Inverse(Box<Condition>),
}

/// An output, behind a condition of its own or not.
type Output = (Option<Condition>, &'static str, &'static str);

const BITS: [&str; 8] = ["X0", "X1", "X2", "X3", "M0", "M1", "Y0", "Y1"];

fn condition() -> impl Strategy<Value = Condition> {
    let contact = (prop::sample::select(&BITS[..]), any::<bool>())
        .prop_map(|(bit, is_open)| Condition::Contact(bit, is_open));
    contact.prop_recursive(3, 10, 3, |inner| {
        prop_oneof![
            3 => prop::collection::vec(inner.clone(), 2..4).prop_map(Condition::And),
            3 => prop::collection::vec(inner.clone(), 2..4).prop_map(Condition::Or),
            1 => inner.prop_map(|inner| Condition::Inverse(Box::new(inner))),
        ]
    })
}

fn rung() -> impl Strategy<Value = (Condition, Vec<Output>)> {
    let deed = prop_oneof![4 => Just("OUT"), 1 => Just("SET"), 1 => Just("RST")];
    let bit = prop::sample::select(&["Y0", "Y1", "M0", "M1"][..]);
    let output = (prop::option::weighted(0.4, condition()), deed, bit);
    (condition(), prop::collection::vec(output, 1..4))
}

fn write(condition: &Condition, lines: &mut Vec<String>) {
    match condition {
        Condition::Contact(bit, true) => lines.push(format!("LD {bit}")),
        Condition::Contact(bit, false) => lines.push(format!("LDI {bit}")),
        Condition::Inverse(inner) => {
            write(inner, lines);
            lines.push("INV".to_string());
        }
        Condition::And(parts) | Condition::Or(parts) => {
            let join = if matches!(condition, Condition::And(_)) { "ANB" } else { "ORB" };
            for (number, part) in parts.iter().enumerate() {
                write(part, lines);
                lines.extend((number > 0).then(|| join.to_string()));
            }
        }
    }
}

fn program(rungs: &[(Condition, Vec<Output>)]) -> String {
    let mut lines = Vec::new();
    for (condition, outputs) in rungs {
        write(condition, &mut lines);
        for (number, (own, deed, bit)) in outputs.iter().enumerate() {
            let stack = match (number, number + 1 == outputs.len()) {
                (_, _) if outputs.len() == 1 => None,
                (0, _) => Some("MPS"),
                (_, true) => Some("MPP"),
                _ => Some("MRD"),
            };
            lines.extend(stack.map(str::to_string));
            if let Some(own) = own {
                write(own, &mut lines);
                lines.push("ANB".to_string());
            }
            lines.push(format!("{deed} {bit}"));
        }
    }
    lines.join("\n") + "\n"
}

/// An instruction and the number of its bit.
type Step<'t> = (&'t str, usize);

/// The instructions of a list. A bit that is none of [`BITS`] is the relay that is nobody's business.
fn steps(text: &str) -> Vec<Step<'_>> {
    let number = |bit: &str| BITS.iter().position(|known| *known == bit).unwrap_or(BITS.len());
    let lines = text.lines().map(|line| line.split_once(' ').unwrap_or((line, "")));
    lines.map(|(mnemonic, bit)| (mnemonic, number(bit.trim()))).collect()
}

/// A scan of a list of bits, as a PLC does it: nothing of it is the translator's.
fn scan(steps: &[Step<'_>], state: &mut [bool; BITS.len() + 1]) {
    let (mut blocks, mut kept): (Vec<bool>, Vec<bool>) = (Vec::new(), Vec::new());
    for (mnemonic, bit) in steps {
        let value = state[*bit];
        let top = blocks.last().copied();
        match *mnemonic {
            "LD" => blocks.push(value),
            "LDI" => blocks.push(!value),
            "AND" => *blocks.last_mut().expect("a block") &= value,
            "ANI" => *blocks.last_mut().expect("a block") &= !value,
            "OR" => *blocks.last_mut().expect("a block") |= value,
            "ORI" => *blocks.last_mut().expect("a block") |= !value,
            "INV" => *blocks.last_mut().expect("a block") ^= true,
            "ANB" | "ORB" => {
                let (right, left) = (blocks.pop().expect("a block"), blocks.pop().expect("a block"));
                blocks.push(if *mnemonic == "ANB" { left & right } else { left | right });
            }
            "MPS" => kept.push(top.expect("a result")),
            "MRD" => *blocks.last_mut().expect("a result") = *kept.last().expect("kept"),
            "MPP" => *blocks.last_mut().expect("a result") = kept.pop().expect("kept"),
            "OUT" => state[*bit] = top.expect("a result"),
            "SET" | "RST" if top.expect("a result") => state[*bit] = *mnemonic == "SET",
            "SET" | "RST" => {}
            other => panic!("{other}"),
        }
    }
}

/// Whether two lists leave the same in every bit, from every state, over two scans. `relay` is the number of the bit
/// that does not count.
fn do_the_same(left: &str, right: &str, relay: usize) -> Result<(), String> {
    let (left, right) = (steps(left), steps(right));
    for number in 0..1u32 << BITS.len() {
        let state = std::array::from_fn(|place| number >> place & 1 == 1);
        let run = |steps: &[Step<'_>]| {
            let mut after = state;
            scan(steps, &mut after);
            scan(steps, &mut after);
            after[relay] = false;
            after
        };
        if run(&left) != run(&right) {
            return Err(format!("{state:?}: {:?} and {:?}", run(&left), run(&right)));
        }
    }
    Ok(())
}

/// The number of the relay that a refactoring makes or removes.
fn relay_of(refactoring: &Refactoring) -> usize {
    let title = refactoring.title.render(Language::English);
    let name = title.split_once("internal relay ").map_or("", |(_, rest)| rest);
    let name = name.split_whitespace().next().unwrap_or("");
    BITS.iter().position(|bit| *bit == name).unwrap_or(BITS.len())
}

/// Checks every refactoring at every line of `document` by what `same` says of the text that it makes; how many there
/// were.
pub(crate) fn check_all(
    document: &Document,
    same: impl Fn(&Refactoring, &str) -> Result<(), String>,
) -> Result<usize, TestCaseError> {
    let mut places: Vec<Span> = vec![];
    let whole = document.text();
    let starts: Vec<usize> = whole.match_indices('\n').map(|(end, _)| end + 1).collect();
    for (number, start) in [0].iter().chain(&starts).enumerate() {
        places.push(Span::at((*start + 3).min(whole.len())));
        places.extend(starts.get(number + 2).map(|end| Span::new(*start, *end)));
    }
    let mut seen: Vec<String> = Vec::new();
    for place in places {
        for refactoring in offered(document, place) {
            let after = applied(document, &refactoring);
            if seen.contains(&after) {
                continue;
            }
            let result = same(&refactoring, &after);
            prop_assert!(result.is_ok(), "{}\n{whole}\n{after}\n{result:?}", refactoring.kind);
            seen.push(after);
        }
    }
    Ok(seen.len())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_offered_in_a_list_changes_nothing(rungs in prop::collection::vec(rung(), 1..3)) {
        let text = program(&rungs);
        check_all(&list(&text), |refactoring, after| do_the_same(&text, after, relay_of(refactoring)))?;
    }

    #[test]
    fn what_is_offered_in_a_drawing_changes_nothing(rungs in prop::collection::vec(rung(), 1..3)) {
        let text = program(&rungs);
        let translation = translate(&list(&text), None, To::Ladder, &Options { is_whole: false, ..Options::default() });
        prop_assume!(translation.is_certain());
        let document = drawing(&translation.text);
        check_all(&document, |refactoring, after| do_the_same(&text, &listed(after), relay_of(refactoring)))?;
    }
}
