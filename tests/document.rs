//! The incremental document against the one read from scratch, and positions in all encodings.

use proptest::prelude::*;
use rungwise::check::{self, Severities};
use rungwise::document::{Document, Edit, Notation};
use rungwise::project::{Manifest, open_document, program_files};
use rungwise::text::{Encoding, LineColumn};
use std::path::Path;

/// Pieces that open, close, join and break things.
const PIECES: &[&str] = &[
    "",
    "\n",
    "\n\n",
    " ",
    "(*",
    "*)",
    "// x\n",
    ";",
    "X0",
    "LD X1\n",
    "ANB\n",
    "ORB\n",
    "OUT Y0\n",
    "MPS\n",
    "MPP\n",
    "END\n",
    "P0\n",
    "STL S0\n",
    "LD ",
    "(",
    ")",
    "VAR\n",
    "END_VAR\n",
    "a : BOOL;\n",
    "PROGRAM P\n",
    "END_PROGRAM\n",
    "LD a\n",
    "ST b\n",
    "CAL t(\n",
    "IN := a,\n",
    "|",
    "-",
    "+",
    "| |",
    "---",
    "|   X0  \n+---| |---( )-+\n",
    "|      |\n",
    "NETWORK 2 'x'\n",
    "L1:\n",
    "{",
    "}",
    "\r\n",
    "\t",
    "电机",
    "ü",
    "\u{feff}",
    "'",
    "\"",
    "FEND\n",
    "]",
    "[",
];

/// All shipped examples, with the mistakes, as documents.
fn samples() -> Vec<Document> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let files = program_files(&folder).unwrap();
    assert!(files.len() > 15, "only {} examples", files.len());
    let read = |path: &std::path::PathBuf| {
        let text = std::fs::read_to_string(path).unwrap();
        open_document(&path.to_string_lossy(), &text, &Manifest::default(), None, None)
    };
    files.iter().map(read).collect()
}

/// The examples once more as other systems write them, and programs in which the two notations meet.
fn nasty_samples() -> Vec<Document> {
    let mut nasty = Vec::new();
    for sample in samples() {
        let (text, notation, target) = (sample.text(), sample.notation(), sample.target());
        nasty.push(Document::new(&text.replace('\n', "\r\n"), notation, target));
        nasty.push(Document::new(&format!("\u{feff}{text}"), notation, target));
    }
    for text in MIXED {
        nasty.push(open_document("mixed.lad", text, &Manifest::default(), None, None));
        nasty.push(open_document("mixed.il", text, &Manifest::default(), None, None));
    }
    nasty
}

/// Drawings below, between and above declarations, comments around all of them.
const MIXED: &[&str] = &[
    "PROGRAM lamp\nVAR\n  a : BOOL; (* x *)\n  b AT %QX0.0 : BOOL;\nEND_VAR\n\nNETWORK 1 'first'\n(* why *)\n\
     |   a        b  |\n+--| |------( )-+\n\nL1:\n|   b        a  |\n+--|/|--+---( )-+\n|   a   |       |\n\
     +--| |--+       |\n\nEND_PROGRAM\nFUNCTION_BLOCK f\nVAR_INPUT x : BOOL; END_VAR\n+--[x]--(y)--+\n\
     END_FUNCTION_BLOCK\n",
    "+--[X0]--(Y0)--+\n(* open\n\nPROGRAM p\n*)\n+--[X1]--(Y1)--+\n\n\n// end\n[END]\n",
    "电机 := 1\r\n+--[😀]--(Y0)--+\r\n\u{2028}\u{85}|\u{b} X0 |\u{c}\r\r\n\r+--[X0]--(Y0)--+\r",
    "LD X0\rOUT Y0\r\nLD X1 // 😀\n\nP0\nLD '\nOUT Y1\n(* (* *)\nEND\n",
    "TYPE t : STRUCT a : BOOL; END_STRUCT; END_TYPE\nPROGRAM p VAR x : t; END_VAR\nLD x.a\nAND( x.a\nOR x.a\n)\n\
     ST x.a\nCAL f(\n a := 1,\n b => c)\nl: JMP l\nEND_PROGRAM\nVAR_GLOBAL g : INT; END_VAR\n",
];

/// What a document says, whatever way it came to be.
fn check_same(incremental: &Document, edits: &str) {
    let scratch = Document::new(&incremental.text(), incremental.notation(), incremental.target());
    let pieces = |document: &Document| -> Vec<(usize, String)> {
        document.chunks().map(|at| (at.start, at.chunk.text().to_string())).collect()
    };
    assert_eq!(pieces(incremental), pieces(&scratch), "chunks differ after {edits}");
    for (left, right) in incremental.chunks().zip(scratch.chunks()) {
        assert_eq!(left.chunk.tree(), right.chunk.tree(), "trees differ after {edits}");
    }
    let severities = Severities::default();
    assert_eq!(
        check::all(incremental, &severities),
        check::all(&scratch, &severities),
        "diagnostics differ after {edits}"
    );
}

/// Where to edit, in thousandths of the text, how many bytes go, and which piece comes.
fn edits() -> impl Strategy<Value = Vec<(usize, usize, usize)>> {
    prop::collection::vec(
        (0..1000usize, prop_oneof![Just(0usize), 1..4usize, 4..80usize], 0..PIECES.len()),
        1..12,
    )
}

/// Where an edit hurts.
#[derive(Clone, Copy, Debug)]
enum Sore {
    Start,
    End,
    /// So many bytes before or behind the start of a chunk, chunks in thousandths.
    Boundary(usize, isize),
    /// Between the two bytes of a line end, lines in thousandths.
    InLineEnd(usize),
    /// From a chunk's start to the end of the text.
    Rest(usize),
    Everything,
}

impl Sore {
    /// The bytes to replace, on character boundaries.
    fn range_in(self, document: &Document, removed: usize) -> std::ops::Range<usize> {
        let text = document.text();
        let starts: Vec<usize> = document.chunks().map(|at| at.start).collect();
        let boundary = |place: usize| starts.get(starts.len() * place / 1000).copied().unwrap_or(0);
        let (start, removed) = match self {
            Sore::Start => (0, removed),
            Sore::End => (text.len().saturating_sub(removed), removed),
            Sore::Boundary(place, by) => (boundary(place).saturating_add_signed(by), removed),
            Sore::InLineEnd(place) => {
                let from = boundary(place);
                (text[from..].find("\r\n").map_or(from, |at| from + at + 1), removed)
            }
            Sore::Rest(place) => (boundary(place), text.len()),
            Sore::Everything => (0, text.len()),
        };
        let inside = |offset: usize| {
            let mut offset = offset.min(text.len());
            while !text.is_char_boundary(offset) {
                offset -= 1;
            }
            offset
        };
        let start = inside(start);
        start..inside(start + removed).max(start)
    }
}

fn nasty_edits() -> impl Strategy<Value = Vec<(Sore, usize, usize)>> {
    let place = prop_oneof![
        1 => Just(Sore::Start),
        1 => Just(Sore::End),
        8 => (0..1000usize, -2..3isize).prop_map(|(place, by)| Sore::Boundary(place, by)),
        2 => (0..1000usize).prop_map(Sore::InLineEnd),
        1 => (0..1000usize).prop_map(Sore::Rest),
        1 => Just(Sore::Everything),
    ];
    let removed = prop_oneof![3 => Just(0usize), 3 => Just(1usize), 1 => 2..5usize, 1 => 5..200usize];
    prop::collection::vec((place, removed, 0..NASTY_PIECES.len()), 1..4)
}

/// Pieces that change what stands far away, and line ends of every kind.
const NASTY_PIECES: &[&str] = &[
    "",
    "\n",
    "\r",
    "\r\n",
    "\n\n\n",
    "(*",
    "*)",
    "(* x *)\n",
    "{",
    "}",
    "'",
    "😀",
    "\u{feff}",
    "\u{2028}",
    "|",
    "+",
    "-",
    "|      |\n",
    "+--[X0]--(Y0)--+\n",
    "|   a        b  |\n+--| |------( )-+\n",
    "NETWORK 3 'x'\n",
    "L2:\n",
    "PROGRAM q\n",
    "END_PROGRAM\n",
    "VAR\n",
    "VAR_GLOBAL\n",
    "END_VAR\n",
    "  c : INT;\n",
    "TYPE\n",
    "END_TYPE\n",
    "CONFIGURATION c\n",
    "LD X0\nOUT Y0\n",
    "AND(\n",
    ")\n",
    "ORB\n",
    "MPP\n",
    "P1\n",
    "LADDER DIAGRAM:\n",
    "LDmicro0.1\n",
    "PROGRAM\n",
    "END\n",
];

fn apply(document: &mut Document, (place, removed, piece): (usize, usize, usize)) {
    let start = document.len() * place / 1000;
    let edit = Edit { range: Some(start..start + removed), text: PIECES[piece].to_string() };
    document.apply(&[edit]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn incremental_equals_from_scratch(sample in 0..1000usize, edits in edits()) {
        let samples = SAMPLES.with(|samples| samples.clone());
        let mut document = samples[sample % samples.len()].clone();
        // Diagnostics kept with chunks must not outlive what they depend on, so they are made before the edits.
        check::all(&document, &Severities::default());
        for edit in &edits {
            apply(&mut document, *edit);
            check_same(&document, &format!("{edits:?}"));
        }
    }

    #[test]
    fn edits_where_it_hurts(sample in 0..1000usize, groups in prop::collection::vec(nasty_edits(), 1..6)) {
        let samples = NASTY_SAMPLES.with(|samples| samples.clone());
        let mut document = samples[sample % samples.len()].clone();
        let mut model = document.text();
        check::all(&document, &Severities::default());
        for group in &groups {
            // All edits of a group are placed in the text as it is when each comes, as a client does.
            let mut edits = Vec::new();
            let mut trial = document.clone();
            for (place, removed, piece) in group {
                let range = place.range_in(&trial, *removed);
                let edit = Edit { range: Some(range.clone()), text: NASTY_PIECES[*piece].to_string() };
                model.replace_range(range, NASTY_PIECES[*piece]);
                trial.apply(std::slice::from_ref(&edit));
                edits.push(edit);
            }
            document.apply(&edits);
            prop_assert_eq!(document.text(), model.clone());
            check_same(&document, &format!("{edits:?}"));
        }
    }

    #[test]
    fn offsets_and_positions_agree(sample in 0..1000usize, place in 0..=1000usize) {
        let samples = SAMPLES.with(|samples| samples.clone());
        let document = &samples[sample % samples.len()];
        let text = document.text();
        let mut offset = text.len() * place / 1000;
        while !text.is_char_boundary(offset) || text[..offset].ends_with('\r') {
            offset -= 1;
        }
        for encoding in [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32] {
            let position = document.position(offset, encoding);
            prop_assert_eq!(document.offset(position, encoding), offset);
        }
    }
}

thread_local! {
    static NASTY_SAMPLES: std::rc::Rc<Vec<Document>> = std::rc::Rc::new(nasty_samples());
    static SAMPLES: std::rc::Rc<Vec<Document>> = std::rc::Rc::new(samples());
}

#[test]
fn positions_outside_of_the_text_are_moved_inside() {
    let document = Document::new("LD X0 // 电机\r\nOUT Y0", Notation::FxIl, rungwise::target::Target::ALL[2]);
    let offset = |line, column, encoding| document.offset(LineColumn { line, column }, encoding);
    assert_eq!(offset(0, 1000, Encoding::Utf16), "LD X0 // 电机".len());
    assert_eq!(offset(9, 0, Encoding::Utf16), document.len());
    assert_eq!(offset(0, 10, Encoding::Utf16), "LD X0 // 电".len());
    assert_eq!(offset(0, 10, Encoding::Utf8), "LD X0 // ".len(), "inside of a character counts as its start");
    assert_eq!(offset(1, 3, Encoding::Utf32), "LD X0 // 电机\r\nOUT".len());
}

#[test]
fn lines_end_as_in_the_protocol() {
    let text = "a\u{2028}b\u{2029}c\u{85}d\u{b}e\u{c}f\rg\r\nh\ni";
    let document = Document::new(text, Notation::FxIl, rungwise::target::Target::ALL[2]);
    let line = |word: &str| document.position(text.find(word).unwrap(), Encoding::Utf16).line;
    assert_eq!([line("f"), line("g"), line("h"), line("i")], [0, 1, 2, 3]);
    assert_eq!(document.line_count(), 4);
}

#[test]
fn a_snapshot_keeps_its_text() {
    let mut document =
        Document::new("LD X0\nOUT Y0\nEND\n", Notation::FxIl, rungwise::target::Target::ALL[2]);
    let snapshot = document.clone();
    document.apply(&[Edit { range: Some(3..5), text: "M1".to_string() }]);
    assert_eq!(snapshot.text(), "LD X0\nOUT Y0\nEND\n");
    assert_eq!(document.text(), "LD M1\nOUT Y0\nEND\n");
}

#[test]
fn an_edit_reads_only_the_chunks_around_it() {
    let rung = "LD X0\nAND X1\nOUT M5\n\n";
    let mut document = Document::new(&rung.repeat(2000), Notation::FxIl, rungwise::target::Target::ALL[2]);
    let before = document.clone();
    let middle = rung.len() * 1000 + 4;
    document.apply(&[Edit { range: Some(middle..middle + 1), text: "7".to_string() }]);
    let kept: std::collections::HashSet<_> =
        before.chunks().map(|at| std::sync::Arc::as_ptr(at.chunk)).collect();
    let read = document.chunks().filter(|at| !kept.contains(&std::sync::Arc::as_ptr(at.chunk))).count();
    assert!((1..=2).contains(&read), "{read} chunks were read anew");
}

#[test]
fn an_unclosed_comment_and_its_end_reach_far() {
    let mut document =
        Document::new(&"LD X0\nOUT M5\n".repeat(3000), Notation::FxIl, rungwise::target::Target::ALL[2]);
    document.apply(&[Edit { range: Some(13..13), text: "(*".to_string() }]);
    check_same(&document, "opening a comment");
    assert_eq!(document.chunks().count(), 1);
    let end = document.len();
    document.apply(&[Edit { range: Some(end..end), text: "*)".to_string() }]);
    check_same(&document, "closing it at the end");
    document.apply(&[Edit { range: Some(13..15), text: String::new() }]);
    check_same(&document, "removing the opening");
    assert!(document.chunks().count() >= 3000);
}

#[test]
fn edits_of_an_empty_text_and_to_an_empty_text() {
    for notation in [Notation::Ladder, Notation::FxIl, Notation::IecIl] {
        let mut document = Document::new("", notation, rungwise::target::Target::ALL[2]);
        document.apply(&[Edit { range: Some(5..9), text: "LD X0\n".to_string() }]);
        check_same(&document, "filling an empty text");
        document.apply(&[Edit { range: Some(0..6), text: String::new() }]);
        check_same(&document, "emptying it");
        document.apply(&[Edit { range: None, text: "OUT Y0\n".to_string() }]);
        check_same(&document, "replacing everything");
        assert_eq!(document.text(), "OUT Y0\n");
    }
}

#[test]
fn the_target_of_a_lone_ladder() {
    use rungwise::document::detect_ladder_target;
    let target = |drawing: &str| detect_ladder_target(drawing).name;
    let fx = target("--[X0]--(Y0)--");
    let iec = target("--[start]--(motor)--");
    assert_ne!(fx, iec);
    // Single letters are names where no symbol is around them.
    assert_eq!(target("  a    b   \n--|P|--(S)--"), iec);
    assert_eq!(target("  X0   Y0  \n--|P|--(S)--"), fx);
    assert_eq!(target("--[P X0]--(S Y0)--[MOV K1 D0]--"), fx);
    assert_eq!(target("--[P X0]--(S motor)--"), iec);
    assert_eq!(target("--[a]--[/b]--(c)--"), iec);
    // Slips in devices and mnemonics are no names.
    for slip in ["[X8]", "[XO]", "[M1O]", "[Y19]", "[MOVX K1 D0]"] {
        assert_eq!(target(&format!("--[X0]--{slip}--(Y0)--")), fx, "{slip}");
    }
    assert_eq!(target("--[X0]--(Y0)--  // a remark"), fx);
    // One odd name is no other language, while it is typed or for good.
    assert_eq!(target("--[X0]--[X7X0]--[M1]--(Y0)--"), fx);
    assert_eq!(target("--[X0]--[Door]--[M1]--(Y0)--"), fx);
    assert_eq!(target("--[X0]--[Door]--(Y0)--"), iec);
}
