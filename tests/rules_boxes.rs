//! Lists that a drawing carries along in boxes `{il … }` are checked like the rest of the program.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation, Symbol};
use rungwise::target::{Device, DeviceKind, Model, Target};
use rungwise::text::TextEdit;

const DRAWN: &str = "|  M0    X1    Y0  |\n+--| |---| |---( )-+\n";

fn document(text: &str, model: Model) -> Document {
    Document::new(text, Notation::Ladder, Target::of(model))
}

/// `code words` of each finding but those about the end of the program.
fn told(text: &str, model: Model) -> Vec<String> {
    let found = check::all(&document(text, model), &Severities::default());
    let own = found.iter().filter(|one| one.code != "missing-end");
    own.map(|one| format!("{} {}", one.code, one.span.of(text))).collect()
}

#[test]
fn mistakes_in_a_box_are_told_at_its_lines() {
    let text = |list: &str| format!("{DRAWN}\n{{il\n{list}\n}}\n\n{DRAWN}").replacen("Y0", "Y7", 1);
    for (list, expected) in [
        ("LD X0\nOUT M0", vec![]),
        ("LD X0\nOUTT M0", vec!["unknown-instruction OUTT"]),
        ("LD X8\nOUT M0", vec!["octal-digit X8"]),
        ("LD X0\nANB\nOUT M0", vec!["block-stack ANB"]),
        ("LD X0\nANI X0\nOUT M0", vec!["contradiction-on-path ANI X0", "never-energised M0"]),
        ("LD X0\nOUT M0\nCJ P7", vec!["undefined-label P7"]),
        // What the box drives is driven twice, and what it alone drives is written.
        ("LD X0\nOUT M0\nOUT Y0", vec!["double-coil Y0"]),
        ("LD X0\nOUT M0\nOUT M9", vec!["written-never-read M9"]),
    ] {
        let text = text(list);
        let all = told(&text, Model::Fx2n);
        let own: Vec<&str> = all
            .iter()
            .map(String::as_str)
            .filter(|one| !one.starts_with("read-before-write") && !one.ends_with(" Y7"))
            .collect();
        let is_chain = |one: &&str| *one == "never-energised Y0";
        let own: Vec<&str> = own.into_iter().filter(|one| !is_chain(one)).collect();
        assert_eq!(own, expected, "{text}");
    }
    // Without the box the relay has no coil.
    let unread = told(&format!("{DRAWN}\n|  X0    Y1  |\n+--| |---( )-+\n"), Model::Fx2n);
    assert_eq!(unread, ["read-never-written M0"]);
}

#[test]
fn fixes_mend_the_list_in_its_box() {
    let text = format!("{DRAWN}\n{{il\nLD X0\nOUTT M0\n}}\n");
    let found = check::all(&document(&text, Model::Fx2n), &Severities::default());
    let one = found.iter().find(|one| one.code == "unknown-instruction").expect("a finding");
    let mended = TextEdit::apply_all(&one.fixes[0].edits, &text);
    assert_eq!(mended, text.replace("OUTT", "OUT"));
}

#[test]
fn names_in_a_box_are_mentioned() {
    let text = format!("{DRAWN}\n{{il\nLD X5\nOUT M0\n}}\n");
    let document = document(&text, Model::Fx2n);
    let wanted = Symbol::Device(Device::new(DeviceKind::X, 5));
    let mut places = Vec::new();
    for at in document.chunks() {
        let own = at.chunk.mentions().iter().filter(|one| one.symbol == wanted);
        places.extend(own.map(|one| one.span.shifted(at.start)));
    }
    assert_eq!(places.iter().map(|span| span.of(&text)).collect::<Vec<_>>(), ["X5"]);
}

#[test]
fn boxes_with_lists_of_iec_are_read_with_the_declarations_around() {
    let text = |list: &str| {
        format!(
            "PROGRAM P\nVAR\n  A AT %IX0.0 : BOOL;\n  N : INT;\n  L AT %QX0.0 : BOOL;\nEND_VAR\n\n\
             |   A          L   |\n+--| |--------( )--+\n\n{{il\n{list}\n}}\n\nEND_PROGRAM\n"
        )
    };
    assert_eq!(told(&text("LD N\nADD 1\nST N"), Model::Iec), Vec::<String>::new());
    let missing = told(&text("LD N\nADD 1\nST Missing"), Model::Iec);
    assert_eq!(missing, ["read-never-written N", "undeclared-variable Missing"]);
    assert_eq!(told(&text("LD A\nST L"), Model::Iec), ["unused-variable N", "double-coil L"]);
}
