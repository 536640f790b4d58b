//! Typing in drawings, with a client that applies what the server answers after each key.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::ide_structure::{marked, with_cursor};
use expect_test::{Expect, expect};
use rungwise::document::{Document, Edit, Notation, Tree};
use rungwise::ide::{self, Style};
use rungwise::project::FormatStyle;
use rungwise::target::{Model, Target};
use rungwise::text::{Encoding, LineColumn};

const STYLE: Style = Style { kind: FormatStyle::Iec, width: 48 };

/// An editor with on-type formatting.
struct Typist {
    document: Document,
    cursor: usize,
}

impl Typist {
    fn at(text: &str, cursor: usize) -> Typist {
        Typist { document: Document::new(text, Notation::Ladder, Target::of(Model::Fx2n)), cursor }
    }

    /// Types a key and applies the answer from the end to the start, as editors do.
    fn key(&mut self, key: char) {
        let (cursor, text) = (self.cursor, key.to_string());
        self.document.apply(&[Edit { range: Some(cursor..cursor), text: text.clone() }]);
        self.cursor += text.len();
        let edits = ide::typed(&self.document, self.cursor, &text, STYLE);
        for edit in edits.iter().rev() {
            self.document.apply(&[Edit { range: Some(edit.span.range()), text: edit.text.clone() }]);
            if (edit.span.end as usize) <= self.cursor
                && !(edit.span.is_empty() && edit.span.end as usize == self.cursor)
            {
                self.cursor = self.cursor + edit.text.len() - edit.span.len();
            }
        }
    }

    fn keys(&mut self, keys: &str) {
        keys.chars().for_each(|key| self.key(key));
    }

    fn go(&mut self, line: u32, column: u32) {
        self.cursor = self.document.offset(LineColumn { line, column }, Encoding::Utf32);
    }

    fn shown(&self) -> String {
        let mut text = self.document.text();
        text.insert(self.cursor, '^');
        text
    }
}

fn check(text: &str, keys: &str, expected: Expect) {
    let (text, span) = marked(text);
    let mut typist = Typist::at(&text, span.start as usize);
    typist.keys(keys);
    expected.assert_eq(&typist.shown());
}

const MOTOR: &str = "\
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |
";

fn motor(line: usize, column: usize) -> String {
    with_cursor(MOTOR, line, column)
}

#[test]
fn what_is_typed_into_a_wire_replaces_wire() {
    check(
        &motor(1, 24),
        "| |",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|-------| |^------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(1, 24),
        "[X7]",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|-------[X7]^-----------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(1, 24),
        "----",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|-----------^-----------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
}

#[test]
fn a_name_takes_blanks() {
    check(
        &motor(0, 24),
        "M100",
        expect![[r#"
        |   X0        X1        M100^                 Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    // In front of a name and inside it.
    check(
        &motor(0, 14),
        "M",
        expect![[r#"
        |   X0        M^X1                            Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(0, 15),
        "234",
        expect![[r#"
        |   X0        X234^1                          Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(0, 47),
        "abc",
        expect![[r#"
        |   X0        X1                             Y0abc^|
        +---| |---+---|/|----------------------------( )--+
        |   Y0    |                                       |
        +---| |---+                                       |
    "#]],
    );
    check(
        &motor(1, 15),
        "P",
        expect![[r#"
            |   X0        X1                             Y0  |
            +---| |---+---|P^|----------------------------( )-+
            |   Y0    |                                      |
            +---| |---+                                      |
        "#]],
    );
}

#[test]
fn where_there_is_no_room_all_rows_get_a_cell() {
    check(
        &motor(1, 4),
        "--",
        expect![[r#"
        |     X0      X1                             Y0  |
        +-----^| |-+---|/|----------------------------( )-+
        |     Y0  |                                      |
        +-----| |-+                                      |
    "#]],
    );
    check(
        &motor(1, 10),
        "-",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |----^+--|/|----------------------------( )-+
        |   Y0     |                                     |
        +---| |----+                                     |
    "#]],
    );
    check(
        &motor(1, 14),
        "| |--",
        expect![[r#"
            |   X0        X1                             Y0  |
            +---| |---+---| |--^--------------------------( )-+
            |   Y0    |                                      |
            +---| |---+                                      |
        "#]],
    );
    let tight = "|  X0 X1 Y0 |\n+-| |-| |-( )-+\n".replace("Y0 |", "Y0  |");
    check(
        &tight.replacen("| |-( )", "| |-^( )", 1),
        "/",
        expect![[r#"
        |  X0 X1  Y0  |
        +-| |-| |-/^( )-+
    "#]],
    );
}

#[test]
fn closing_signs_are_typed_over() {
    check(
        &motor(1, 16),
        "|-",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|-^---------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        "+--[X0^]----( )-+\n",
        "]",
        expect![[r#"
        +--[X0]^----( )-+
    "#]],
    );
    check(
        "+--[X^]----( )-+\n",
        "12",
        expect![[r#"
        +--[X12^]--( )-+
    "#]],
    );
}

#[test]
fn three_cells_of_wire_run_on_to_the_next_junction() {
    let open = "\
|   X0        X1                             Y0  |
+---| |---+---|/|--+-------------------------( )-+
|   Y0    |        |                             |
+---| |---+^        |                             |
";
    check(
        open,
        "---",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|--+-------------------------( )-+
        |   Y0    |        |                             |
        +---| |---+---^-----+                             |
    "#]],
    );
    check(
        open,
        "--| |",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|--+-------------------------( )-+
        |   Y0    |        |                             |
        +---| |---+--| |^   |                             |
    "#]],
    );
}

#[test]
fn enter_opens_a_branch_or_a_rung() {
    check(
        &motor(1, 15),
        "\n",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        ^|   Y0    |   ???   |                            |
        +---| |---+---| |---+                            |
    "#]],
    );
    check(
        &motor(1, 10),
        "\n",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        ^|   ???   |                                      |
        +---| |---+                                      |
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(1, 46),
        "\n",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        ^|   Y0    |         |                        ??? |
        +---| |---+         +------------------------( )-+
    "#]],
    );
    check(
        &motor(3, 50),
        "\n",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
        ^
        |                                                |
        +------------------------------------------------+
    "#]],
    );
    check(
        &motor(1, 24),
        "\n",
        expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|-------
        ^---------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(0, 0),
        "\n",
        expect![[r#"

            ^|   X0        X1                             Y0  |
            +---| |---+---|/|----------------------------( )-+
            |   Y0    |                                      |
            +---| |---+                                      |
        "#]],
    );
}

#[test]
fn comments_and_headers_are_left_alone() {
    for text in [
        "(* Sto^p -- now *)\n+--[X0]--(Y0)-+\n",
        "NETWORK 1 'a^ -- b'\n+--[X0]--(Y0)-+\n",
        "+--[X0]--(Y0)-+ // a^ - b\n",
    ] {
        let (plain, span) = marked(text);
        let mut typist = Typist::at(&plain, span.start as usize);
        typist.key('x');
        assert_eq!(typist.shown(), text.replace('^', "x^"));
    }
}

/// Whether the drawing reads without a problem as so many rungs.
fn reads_well(document: &Document, rungs: usize) -> bool {
    let trees = document.chunks().filter_map(|at| match at.chunk.tree() {
        Tree::Ladder(tree) => Some((tree.rungs.len(), tree.problems.len())),
        _ => None,
    });
    trees.fold((0, 0), |sum, tree| (sum.0 + tree.0, sum.1 + tree.1)) == (rungs, 0)
}

#[test]
fn a_contact_typed_anywhere_in_a_wire_is_read_and_nothing_else_moves() {
    let lines: Vec<&str> = MOTOR.lines().collect();
    let mut places = 0;
    for column in 1..45 {
        let wire = |at: usize| lines[1].as_bytes()[at] == b'-';
        // A wire on both sides is what makes two bars a contact.
        if !(column - 1..column + 4).all(wire) {
            continue;
        }
        places += 1;
        let mut typist = Typist::at(MOTOR, 0);
        typist.go(1, column as u32);
        typist.keys("| |");
        typist.go(0, column as u32 + 1);
        typist.keys("M8");
        let text = typist.document.text();
        assert!(reads_well(&typist.document, 1), "{text}");
        assert!(text.contains("M8"), "{text}");
        let after: Vec<&str> = text.lines().collect();
        assert_eq!(after[2..], lines[2..], "other rows move:\n{text}");
        for (line, before) in after[..2].iter().zip(&lines) {
            assert_eq!(line.len(), before.len(), "a rail moves:\n{text}");
        }
    }
    assert!(places > 20, "{places}");
}

#[test]
fn a_whole_rung_is_typed_from_nothing() {
    let mut typist = Typist::at("", 0);
    typist.keys("|   X0                  Y0 |\n+---| |---------------( )--+");
    assert!(reads_well(&typist.document, 1), "{}", typist.shown());
    typist.key('\n');
    expect![[r#"
        |   X0                  Y0 |
        +---| |---------------( )--+
        ^
        |                          |
        +--------------------------+"#]]
    .assert_eq(&typist.shown());
}

#[test]
fn any_key_anywhere_keeps_what_stands_behind_in_its_row() {
    // Whatever is typed into whatever cell: every other character of the rung is still there but for one wire or blank.
    for key in "|-+[](X/ P".chars() {
        for offset in 0..MOTOR.len() {
            // Two slashes begin a comment, which reaches to the end of the line.
            if key == '/' && MOTOR[..offset].ends_with('/') {
                continue;
            }
            let mut typist = Typist::at(MOTOR, offset);
            typist.key(key);
            let text = typist.document.text();
            let solid = |text: &str| text.chars().filter(|c| c.is_alphanumeric()).count();
            assert_eq!(solid(&text), solid(MOTOR) + usize::from(key.is_alphanumeric()), "{key:?}\n{text}");
            let widths: Vec<usize> = text.lines().map(str::len).collect();
            let at_line_end = MOTOR[offset..].starts_with('\n');
            assert!(
                at_line_end || widths.iter().all(|width| *width == widths[0]),
                "{key:?} at {offset}\n{text}"
            );
        }
    }
}

const GARBAGE: &[&str] = &[
    "",
    "\n",
    "|",
    "+",
    "[",
    "\u{1}",
    "\u{feff}|",
    "|\t|\n",
    "+--[X0\n",
    "| |\n| |",
    "日本 | |--( )",
    "(*",
    "é̂--|",
    "??",
    "PROGRAM a\nVAR\n",
    "NETWORK\n",
    "+-+\n| |\n+-+",
    "│ ├──┤\n",
    "\r\n+--+\r\n",
    "X0\nY0\n",
];

#[test]
fn no_key_anywhere_in_any_text_harms() {
    for text in GARBAGE {
        let document = Document::new(text, Notation::Ladder, Target::of(Model::Fx2n));
        for offset in (0..=text.len() + 2).chain([usize::MAX / 2]) {
            for key in ["\n", "|", "-", "X", "日", "", "ab", "\u{301}"] {
                let edits = ide::typed(&document, offset, key, STYLE);
                assert!(edits.iter().all(|edit| edit.span.end as usize <= text.len()));
            }
            ide::selection_ranges(&document, offset);
            ide::linked_places(&document, offset);
        }
    }
}

#[test]
fn enter_in_an_aligned_list_aligns_the_line_left() {
    let after = |text: &str| {
        let (text, span) = marked(text);
        let mut document = Document::new(&text, Notation::FxIl, Target::of(Model::Fx2n));
        let at = span.start as usize;
        document.apply(&[Edit { range: Some(at..at), text: "\n".to_string() }]);
        let mut edits = ide::typed(&document, at + 1, "\n", STYLE);
        edits.reverse();
        let edits = edits.into_iter().map(|edit| Edit { range: Some(edit.span.range()), text: edit.text });
        document.apply(&edits.collect::<Vec<_>>());
        document.text()
    };
    assert_eq!(after("LD X0\nand  x1^\nOUT Y0\n"), "LD X0\nAND X1\n\nOUT Y0\n");
    // Others are written otherwise, so the user has a style of his own.
    assert_eq!(after("ld  X0\nand  x1^\nOUT Y0\n"), "ld  X0\nand  x1\n\nOUT Y0\n");
    assert_eq!(after("(* a  b^ *)\nLD X0\n"), "(* a  b\n *)\nLD X0\n");
}

#[test]
fn wide_characters_take_two_cells() {
    let text = "|                      Y0  |\n+---[/X0]--------------( )-+\n";
    let mut typist = Typist::at(text, 0);
    typist.go(0, 6);
    typist.keys("启动");
    assert_eq!(typist.document.text().lines().next(), Some("|     启动             Y0  |"));
}
