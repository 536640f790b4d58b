//! Structural edits of ladder drawings: what each makes of a rung, that nothing else changes, and that what cannot be
//! done is refused.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::ladder_generate::{Leaf, Part, all_rungs, generate, rung};
use expect_test::{Expect, expect};
use proptest::prelude::*;
use rungwise::document::{Document, Notation, Tree};
use rungwise::ide::{self, EditKind, ObjectKind, Style};
use rungwise::ladder::reduce::reduce;
use rungwise::ladder::{StyleKind, print};
use rungwise::project::FormatStyle;
use rungwise::target::{Model, Target};
use rungwise::text::{Encoding, Language, Span, TextEdit};

const STYLE: Style = Style { kind: FormatStyle::Iec, width: 48 };

fn ladder(text: &str) -> Document {
    Document::new(text, Notation::Ladder, Target::of(Model::Fx2n))
}

/// `text` without its cursor `^` or selection `«…»`, and where that was.
pub fn marked(text: &str) -> (String, Span) {
    if let Some(at) = text.find('^') {
        return (text.replacen('^', "", 1), Span::at(at));
    }
    let start = text.find('«').expect("a cursor");
    let text = text.replacen('«', "", 1);
    let end = text.find('»').expect("the end of the selection");
    (text.replacen('»', "", 1), Span::new(start, end))
}

/// The text after an edit, with the selection marked; or the reason why not.
fn edited(text: &str, kind: EditKind, operand: Option<&str>) -> String {
    let (text, span) = marked(text);
    match ide::edit(&ladder(&text), span, kind, operand, STYLE) {
        Ok(answer) => {
            let mut after = TextEdit::apply_all(&answer.edits, &text);
            if answer.selection.is_empty() {
                after.insert(answer.selection.start as usize, '^');
            } else {
                after.insert(answer.selection.end as usize, '»');
                after.insert(answer.selection.start as usize, '«');
            }
            after
        }
        Err(message) => message.render(Language::English),
    }
}

fn check(text: &str, kind: EditKind, operand: Option<&str>, expected: Expect) {
    expected.assert_eq(&edited(text, kind, operand));
}

const MOTOR: &str = "\
(* Start and stop *)
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |
";

/// `drawing` with the mark of the cursor before a cell of a line, both from 0.
pub fn with_cursor(drawing: &str, line: usize, column: usize) -> String {
    let start: usize = drawing.split_inclusive('\n').take(line).map(str::len).sum();
    let mut text = drawing.to_string();
    text.insert(start + column, '^');
    text
}

fn motor(line: usize, column: usize) -> String {
    with_cursor(MOTOR, line, column)
}

#[test]
fn a_contact_goes_into_the_wire_at_the_cursor() {
    check(
        &motor(2, 24),
        EditKind::InsertContact,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1      «???»                    Y0  |
        +---| |---+---|/|-----| |--------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(2, 24),
        EditKind::InsertNegatedContact,
        Some("M100"),
        expect![[r#"
        (* Start and stop *)
        |   X0        X1     M100                    Y0  |
        +---| |---+---|/|-----|/|^--------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(4, 8),
        EditKind::InsertContact,
        Some("T0"),
        expect![[r#"
        (* Start and stop *)
        |   X0                X1                     Y0  |
        +---| |-----------+---|/|--------------------( )-+
        |   Y0      T0    |                              |
        +---| |-----| |^---+                              |
    "#]],
    );
    // A byte order mark and other line ends stay.
    let foreign = format!("\u{feff}{}", MOTOR.split_once('\n').unwrap().1.replace('\n', "\r\n"));
    let after = edited(&foreign.replacen("X1", "X^1", 1), EditKind::InsertContact, Some("M3"));
    assert!(after.starts_with("\u{feff}|   X0        M3      X1 "), "{after}");
    assert_eq!(after.matches("\r\n").count(), 4, "{after}");
    // Before and behind an element.
    check(
        &motor(2, 14),
        EditKind::InsertContact,
        Some("T0"),
        expect![[r#"
        (* Start and stop *)
        |   X0        T0      X1                     Y0  |
        +---| |---+---| |^-----|/|--------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(2, 17),
        EditKind::InsertContact,
        Some("T0"),
        expect![[r#"
        (* Start and stop *)
        |   X0        X1      T0                     Y0  |
        +---| |---+---|/|-----| |^--------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
}

#[test]
fn an_output_goes_to_the_end_of_its_line() {
    check(
        &motor(2, 24),
        EditKind::InsertCoil,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |         |                        «???» |
        +---| |---+         +------------------------( )-+
    "#]],
    );
    check(
        &motor(2, 24),
        EditKind::InsertCoil,
        Some("T0 K50"),
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |         |                      T0 K50|
        +---| |---+         +------------------------( )^-+
    "#]],
    );
    check(
        &motor(2, 46),
        EditKind::InsertSetCoil,
        Some("M0"),
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |         |                        M0  |
        +---| |---+         +------------------------(S)^-+
    "#]],
    );
    check(
        &motor(2, 24),
        EditKind::InsertBox,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |         |                            |
        +---| |---+         +--[MOV «??? ???»]-------------+
    "#]],
    );
    check(
        &motor(2, 24),
        EditKind::InsertBox,
        Some("INC D0"),
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |         |                            |
        +---| |---+         +--[INC D0]^------------------+
    "#]],
    );
    check(
        &motor(2, 12),
        EditKind::InsertCoil,
        None,
        expect!["Contacts follow to the right: a coil stands at the end of its line."],
    );
    check(
        &motor(4, 8),
        EditKind::InsertCoil,
        None,
        expect!["Contacts follow to the right: a coil stands at the end of its line."],
    );
}

#[test]
fn a_branch_is_parallel_to_what_is_chosen() {
    check(
        &motor(2, 16),
        EditKind::InsertBranch,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |   «???»   |                            |
        +---| |---+---| |---+                            |
    "#]],
    );
    check(
        &motor(4, 6),
        EditKind::InsertBranch,
        Some("M8"),
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
        |   M8    |                                      |
        +---| |^---+                                      |
    "#]],
    );
    check(
        &motor(2, 46),
        EditKind::InsertBranch,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |         |                        «???» |
        +---| |---+         +------------------------( )-+
    "#]],
    );
    let all = MOTOR.replacen("| |---+---|/|", "«| |---+---|/|»", 1);
    check(
        &all,
        EditKind::WrapInBranch,
        Some("M1"),
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---+------------------------( )-+
        |   Y0    |         |                            |
        +---| |---+         |                            |
        |   M1              |                            |
        +---| |^-------------+                            |
    "#]],
    );
    check(
        &motor(2, 24),
        EditKind::InsertBranch,
        None,
        expect!["Put the cursor on an element, or select some."],
    );
}

#[test]
fn a_box_of_an_iec_program_is_a_function_block() {
    let program = [
        "PROGRAM a\nVAR\n    s : BOOL;\nEND_VAR\n",
        "|   s             q  |",
        "+---| |-----------( )-+",
        "\nEND_PROGRAM\n",
    ]
    .join("\n");
    let edited = |column: usize, kind, operand| {
        let at = program.find("+---").unwrap() + column;
        let document = Document::new(&program, Notation::Ladder, Target::of(Model::Iec));
        let answer = ide::edit(&document, Span::at(at), kind, operand, STYLE);
        let answer = answer.map_err(|why| why.render(Language::English)).unwrap();
        let after = TextEdit::apply_all(&answer.edits, &program);
        format!("{}{}", after.split_once("END_VAR").unwrap().1, answer.selection.of(&after))
    };
    expect![[r#"


        |                ???            |
        |              +------+         |
        |    s         | TON  |      q  |
        +---| |--------|IN   Q|-----( )-+
        |         ???--|PT  ET|         |
        |              +------+         |

        END_PROGRAM
        ???"#]]
    .assert_eq(&edited(12, EditKind::InsertBox, None));
    expect![[r#"


        |               Parts           |
        |              +------+         |
        |    s         | CTUD |      q  |
        +---| |--------|CU  QU|-----( )-+
        |         ???--|CD  QD|         |
        |         ???--|R   CV|         |
        |         ???--|LD    |         |
        |         ???--|PV    |         |
        |              +------+         |

        END_PROGRAM
    "#]]
    .assert_eq(&edited(12, EditKind::InsertBox, Some("Parts : CTUD")));
    expect![[r#"


        |    s                 q  |
        +---| |----[> a b]----( )-+

        END_PROGRAM
    "#]]
    .assert_eq(&edited(12, EditKind::InsertBox, Some("> a b")));
    let end = program.find("END_PROGRAM").unwrap() - program.find("+---").unwrap();
    expect![[r#"


        |   s             q  |
        +---| |-----------( )-+

        |                     |
        +---------------------+

        END_PROGRAM
    "#]]
    .assert_eq(&edited(end, EditKind::InsertRung, None));
}

#[test]
fn branches_move_and_go() {
    check(
        &motor(4, 5),
        EditKind::MoveBranchUp,
        None,
        expect![[r#"
        (* Start and stop *)
        |   Y0        X1                             Y0  |
        +---| |^---+---|/|----------------------------( )-+
        |   X0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(&motor(4, 5), EditKind::MoveBranchDown, None, expect!["This is the last branch already."]);
    check(
        &motor(2, 16),
        EditKind::MoveBranchDown,
        None,
        expect!["There is no branch here: nothing is parallel to it."],
    );
    check(
        &motor(4, 5),
        EditKind::DeleteBranch,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0      X1                               Y0  |
        +---| |-----|/|------------------------------( )-+^
    "#]],
    );
    check(
        &motor(2, 8),
        EditKind::DeleteBranch,
        None,
        expect![[r#"
        (* Start and stop *)
        |   Y0      X1                               Y0  |
        +---| |-^----|/|------------------------------( )-+
    "#]],
    );
}

#[test]
fn elements_go_and_are_negated() {
    check(
        &motor(2, 5),
        EditKind::DeleteElement,
        None,
        expect![[r#"
        (* Start and stop *)
        |   Y0      X1                               Y0  |
        +---|^ |-----|/|------------------------------( )-+
    "#]],
    );
    check(
        &motor(2, 15),
        EditKind::DeleteElement,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0                                       Y0  |
        +---| |---+----^------------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(1, 45),
        EditKind::DeleteElement,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             ^    |
        +---| |---+---|/|--------------------------------+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(2, 15),
        EditKind::Negate,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---| |^----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(1, 5),
        EditKind::Negate,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---|/|^---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
}

#[test]
fn a_rung_comes_beside_the_one_at_the_cursor() {
    check(
        &motor(2, 15),
        EditKind::InsertRung,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |

        |                                                |
        +---^---------------------------------------------+
    "#]],
    );
    check(
        &motor(2, 15),
        EditKind::InsertRungAbove,
        None,
        expect![[r#"
        |                                                |
        +---^---------------------------------------------+

        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    check(
        "^",
        EditKind::InsertRung,
        None,
        expect![[r#"
        |                                              |
        +---^-------------------------------------------+
    "#]],
    );
}

#[test]
fn a_drawing_by_hand_stays_as_its_author_laid_it_out() {
    let drawn = [
        "1 ||    X0       X1                    Y0   ||",
        "  ||----| |--+---|/|-------------------( )--||",
        "  ||    Y0   |                              ||",
        "  ||----| |--+                              ||",
        "",
    ]
    .join("\n");
    let at = |line: usize, column: usize| {
        let start: usize = drawn.split_inclusive('\n').take(line).map(str::len).sum();
        let mut text = drawn.clone();
        text.insert(start + column, '^');
        text
    };
    check(
        &at(1, 27),
        EditKind::InsertContact,
        Some("M10"),
        expect![[r#"
               1 ||    X0       X1        M10         Y0   ||
                 ||----| |--+---|/|-------| |^---------( )--||
                 ||    Y0   |                              ||
                 ||----| |--+                              ||
        "#]],
    );
    check(
        &at(1, 11),
        EditKind::InsertContact,
        None,
        expect![[r#"
               1 ||    X0  «???»     X1                 Y0   ||
                 ||----| |-| |-+---|/|----------------( )--||
                 ||    Y0      |                           ||
                 ||----| |-----+                           ||
        "#]],
    );
    check(
        &at(1, 18),
        EditKind::Negate,
        None,
        expect![[r#"
               1 ||    X0       X1                    Y0   ||
                 ||----| |--+---|^ |-------------------( )--||
                 ||    Y0   |                              ||
                 ||----| |--+                              ||
        "#]],
    );
    check(
        &at(1, 18),
        EditKind::DeleteElement,
        None,
        expect![[r#"
               1 ||    X0                             Y0   ||
                 ||----| |--+----^---------------------( )--||
                 ||    Y0   |                              ||
                 ||----| |--+                              ||
        "#]],
    );
    check(
        &at(1, 18),
        EditKind::InsertBranch,
        None,
        expect![[r#"
                 ||   X0        X1                     Y0  ||
               1 ||---| |---+---|/|---+----------------( )-||
                 ||   Y0    |   «???»   |                    ||
                 ||---| |---+---| |---+                    ||
        "#]],
    );
    check(
        &at(3, 9),
        EditKind::MoveBranchUp,
        None,
        expect![[r#"
                 ||   Y0        X1                     Y0  ||
               1 ||---| |^---+---|/|--------------------( )-||
                 ||   X0    |                              ||
                 ||---| |---+                              ||
        "#]],
    );
    check(
        &at(1, 30),
        EditKind::InsertCoil,
        None,
        expect![[r#"
                 ||   X0        X1                     Y0  ||
               1 ||---| |---+---|/|---+----------------( )-||
                 ||   Y0    |         |                «???» ||
                 ||---| |---+         +----------------( )-||
        "#]],
    );
    check(
        &at(1, 30),
        EditKind::InsertRung,
        None,
        expect![[r#"
               1 ||    X0       X1                    Y0   ||
                 ||----| |--+---|/|-------------------( )--||
                 ||    Y0   |                              ||
                 ||----| |--+                              ||

                 ||                                        ||
                 ||---^-------------------------------------||
        "#]],
    );
    let below = "\
|--] [--+--]/[-------( )
|  X0   |  X1        Y0
|--] [--+
|  Y0
"
    .replacen("]/[---", "]/[--^-", 1);
    check(
        &below,
        EditKind::InsertContact,
        None,
        expect![[r#"
            |--] [--+--]/[--] [--( )
            |  X0   |  X1   «???»  Y0
            |--] [--+
            |  Y0
        "#]],
    );
    let unicode = "\
│   X0       X1      Y0  │
├───┤ ├──^────┤/├─────( )─┤
";
    check(unicode, EditKind::InsertBranch, None, expect!["Put the cursor on an element, or select some."]);
    check(
        unicode,
        EditKind::InsertContact,
        None,
        expect![[r#"
        │   X0   «???» X1      Y0  │
        ├───┤ ├──┤ ├─┤/├─────( )─┤
    "#]],
    );
    check(
        "+--[X0]--^--[/X1]----(Y0)-+\n",
        EditKind::InsertNegatedContact,
        None,
        expect![[r#"
        +--[X0]-[/«???»]-[/X1]----(Y0)-+
    "#]],
    );
    check(
        "+--[^X0]-----[/X1]----(Y0)-+\n",
        EditKind::Negate,
        None,
        expect![[r#"
        +--[^/X0]----[/X1]----(Y0)-+
    "#]],
    );
    check(
        "+--[X0]-----[/^X1]----(Y0)-+ // stop\n",
        EditKind::Negate,
        None,
        expect![[r#"
        +--[X0]-----[X^1]-----(Y0)-+ // stop
    "#]],
    );
    check(
        "+--[X0]-----[/^X1]----(Y0)-+ // stop\n",
        EditKind::InsertBranch,
        None,
        expect![[r#"
        +--[X0]--+--[/X1]--+--(Y0)-+  // stop
        |        |         |       |
        |        +--[«???»]--+       |
    "#]],
    );
}

#[test]
fn a_bridge_takes_elements_into_its_wires_and_refuses_the_rest() {
    let open = "\
|   X0      X1          |
+---| |-----| |----^-    |
";
    check(
        open,
        EditKind::InsertContact,
        Some("X2"),
        expect![[r#"
        |   X0      X1  X2      |
        +---| |-----| |-| |^-    |
    "#]],
    );
    check(open, EditKind::DeleteElement, None, expect!["Put the cursor on an element, or select some."]);
    let bridge = "\
|   X0        X1                    Y0  |
+---| |---+---| |---------------+---( )-+
|         |   X2        X5      |       |
|         +---| |---+---| |-----+       |
|   X3              |                   |
+---| |-------------+                   |
";
    let in_wire = bridge.replacen("+---| |-------------+", "+---| |-----^--------+", 1);
    check(
        &in_wire,
        EditKind::InsertContact,
        Some("M1"),
        expect![[r#"
        |   X0        X1                    Y0  |
        +---| |---+---| |---------------+---( )-+
        |         |   X2        X5      |       |
        |         +---| |---+---| |-----+       |
        |   X3      M1      |                   |
        +---| |-----| |^-----+                   |
    "#]],
    );
    check(
        &in_wire,
        EditKind::DeleteBranch,
        None,
        expect![
            "The rung has a bridge: its paths share parts of their ways, so it cannot be changed as a whole."
        ],
    );
    check(
        &bridge.replacen("X1", "^X1", 1),
        EditKind::InsertBranch,
        None,
        expect![
            "The rung has a bridge: its paths share parts of their ways, so it cannot be changed as a whole."
        ],
    );
}

#[test]
fn rows_out_of_line_are_aligned_again() {
    let lines: Vec<&str> = MOTOR.lines().collect();
    // A cell lost in front of the second contact, and one too many behind the branch.
    let lost = MOTOR.replacen("|---+---|/|", "|---+-^-|/|", 1);
    check(
        &lost,
        EditKind::Mend,
        None,
        expect![[r#"
            (* Start and stop *)
            |   X0        X1                             Y0  |
            +---| |---+-^--|/|----------------------------( )-+
            |   Y0    |                                      |
            +---| |---+                                      |
        "#]],
    );
    let surplus = MOTOR.replacen("Y0    |     ", "Y0    |  ^      ", 1);
    check(
        &surplus,
        EditKind::Mend,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |  ^                                    |
        +---| |---+                                      |
    "#]],
    );
    check(
        &motor(2, 20),
        EditKind::Mend,
        None,
        expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|---^-------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]],
    );
    let shifted = [lines[0], lines[1], lines[2], lines[3], &format!("  ^{}", lines[4])].join("\n") + "\n";
    check(
        &shifted,
        EditKind::Mend,
        None,
        expect![[r#"
            (* Start and stop *)
            |   X0        X1                             Y0  |
            +---| |---+---|/|----------------------------( )-+
            |   Y0    |                                      |
            +-^--| |---+                                      |
        "#]],
    );
}

// What the edits are to do, written on the parts of which test rungs are made.

/// Nothing nested in its own kind, no wire in a series.
fn normal(part: &Part) -> Part {
    let flat = |parts: &[Part], own: fn(&Part) -> Option<&Vec<Part>>| -> Vec<Part> {
        let all = parts.iter().map(normal);
        all.flat_map(|part| own(&part).cloned().unwrap_or_else(|| vec![part])).collect()
    };
    match part {
        Part::Series(parts) => {
            let mut parts =
                flat(parts, |part| if let Part::Series(inner) = part { Some(inner) } else { None });
            parts.retain(|part| !matches!(part, Part::Wire));
            joined(parts, Part::Series)
        }
        Part::Parallel(parts) => {
            let parts = flat(parts, |part| if let Part::Parallel(inner) = part { Some(inner) } else { None });
            joined(parts, Part::Parallel)
        }
        part => part.clone(),
    }
}

fn joined(mut parts: Vec<Part>, many: fn(Vec<Part>) -> Part) -> Part {
    match parts.len() {
        0 => Part::Wire,
        1 => parts.remove(0),
        _ => many(parts),
    }
}

/// The part with leaf number `number`, in the order of drawing, replaced by what `make` makes of it.
fn with_leaf(part: &Part, number: &mut i32, make: &mut impl FnMut(&Leaf) -> Option<Part>) -> Option<Part> {
    match part {
        Part::Leaf(leaf) => {
            *number -= 1;
            if *number == -1 { make(leaf) } else { Some(part.clone()) }
        }
        Part::Wire => Some(Part::Wire),
        Part::Series(parts) | Part::Parallel(parts) => {
            let rest: Vec<Part> = parts.iter().filter_map(|part| with_leaf(part, number, make)).collect();
            let many = if matches!(part, Part::Series(_)) { Part::Series } else { Part::Parallel };
            (!rest.is_empty()).then(|| joined(rest, many))
        }
    }
}

fn leaves(part: &Part) -> Vec<Leaf> {
    match part {
        Part::Leaf(leaf) => vec![leaf.clone()],
        Part::Wire => Vec::new(),
        Part::Series(parts) | Part::Parallel(parts) => parts.iter().flat_map(leaves).collect(),
    }
}

/// The part with the branches changed of the innermost parallel that has leaf `number` in a branch; nothing without
/// one, and nothing inside if the change is refused.
fn with_branches(
    part: &Part,
    number: usize,
    change: &mut impl FnMut(&mut Vec<Part>, usize) -> bool,
) -> Option<Option<Part>> {
    let (Part::Series(parts) | Part::Parallel(parts)) = part else { return None };
    let mut first = 0;
    for (place, inner) in parts.iter().enumerate() {
        let count = leaves(inner).len();
        if (first..first + count).contains(&number) {
            let mut parts = parts.clone();
            match (with_branches(inner, number - first, change), part) {
                (Some(changed), _) => match changed {
                    Some(changed) => parts[place] = changed,
                    None => return Some(None),
                },
                (None, Part::Parallel(_)) => {
                    if !change(&mut parts, place) {
                        return Some(None);
                    }
                }
                (None, _) => return None,
            }
            let many = if matches!(part, Part::Series(_)) { Part::Series } else { Part::Parallel };
            return Some(Some(many(parts)));
        }
        first += count;
    }
    None
}

fn is_output(leaf: &Leaf) -> bool {
    !matches!(
        leaf,
        Leaf::Contact(..) | Leaf::Compare(..) | Leaf::Invert | Leaf::Block(_) | Leaf::ConnectorIn(_)
    )
}

/// What an edit with the cursor on leaf `number` (at its first cell) makes of a rung; nothing if it is to be refused.
fn model(part: &Part, number: usize, kind: EditKind) -> Option<Part> {
    let leaf = leaves(part)[number].clone();
    let new = Part::Leaf(if is_output(&leaf) { Leaf::Coil(0, NEW) } else { Leaf::Contact(0, NEW) });
    let mut at = number as i32;
    let changed = match kind {
        EditKind::InsertContact => {
            let new = Part::Leaf(Leaf::Contact(0, NEW));
            with_leaf(part, &mut at, &mut |leaf| {
                Some(Part::Series(vec![new.clone(), Part::Leaf(leaf.clone())]))
            })
        }
        EditKind::InsertBranch => with_leaf(part, &mut at, &mut |leaf| {
            Some(Part::Parallel(vec![Part::Leaf(leaf.clone()), new.clone()]))
        }),
        EditKind::DeleteElement => Some(with_leaf(part, &mut at, &mut |_| None).unwrap_or(Part::Wire)),
        EditKind::Negate => with_leaf(part, &mut at, &mut |leaf| {
            let negated = match leaf {
                Leaf::Contact(kind, n) if kind % 4 < 2 => Leaf::Contact((kind % 4) ^ 1, *n),
                Leaf::Coil(kind, n) if kind % 6 < 2 => Leaf::Coil((kind % 6) ^ 1, *n),
                _ => return None,
            };
            Some(Part::Leaf(negated))
        })
        .filter(|_| {
            matches!(leaf, Leaf::Contact(kind, _) if kind % 4 < 2)
                || matches!(leaf, Leaf::Coil(kind, _) if kind % 6 < 2)
        }),
        EditKind::MoveBranchUp => with_branches(part, number, &mut |branches, at| {
            if at > 0 {
                branches.swap(at, at - 1)
            }
            at > 0
        })
        .flatten(),
        EditKind::MoveBranchDown => with_branches(part, number, &mut |branches, at| {
            let moves = at + 1 < branches.len();
            if moves {
                branches.swap(at, at + 1)
            }
            moves
        })
        .flatten(),
        EditKind::DeleteBranch => with_branches(part, number, &mut |branches, at| {
            branches.remove(at);
            true
        })
        .flatten(),
        _ => None,
    };
    changed.map(|part| normal(&part))
}

/// The number of the new element's device.
const NEW: u16 = 3;

const MODELLED: [EditKind; 7] = [
    EditKind::InsertContact,
    EditKind::InsertBranch,
    EditKind::DeleteElement,
    EditKind::Negate,
    EditKind::MoveBranchUp,
    EditKind::MoveBranchDown,
    EditKind::DeleteBranch,
];

/// A rung drawn between two others.
struct Drawn {
    text: String,
    document: Document,
    head: usize,
    tail: usize,
    /// The first cells of the rung's elements, in the order of its parts.
    cursors: Vec<usize>,
}

fn fx() -> &'static Target {
    Target::of(Model::Fx2n)
}

fn drawn(part: &Part, kind: StyleKind) -> Option<Drawn> {
    let made = generate(part, fx());
    let shape = reduce(&made.graph).ok()?;
    let style = rungwise::ladder::Style { kind, width: 40 };
    let rung = print(&shape, &made.graph, &made.words, &style)?;
    let head = "+--[X0]--(Y7)-+\n\n(* this *)\n";
    let tail = "\n+--[X0]--(Y7)-+\n";
    let text = [head, rung.as_str(), tail].concat();
    let document = ladder(&text);
    let at = document.chunk_at(head.len())?;
    let Tree::Ladder(tree) = at.chunk.tree() else { return None };
    // Some drawings are read with a finding, and are not the matter here.
    if !tree.problems.is_empty() || tree.rungs.len() != 1 {
        return None;
    }
    let graph = &tree.rungs[0].graph;
    let order = reduce(graph).ok()?.elements();
    let cursors =
        order.iter().map(|id| at.start + graph.elements[id.0 as usize].span.start as usize).collect();
    Some(Drawn { document: document.clone(), cursors, head: head.len(), tail: tail.len(), text })
}

/// The logic of the rung at a byte of a document.
fn logic(document: &Document, offset: usize) -> String {
    let at = document.chunk_at(offset).unwrap();
    let Tree::Ladder(tree) = at.chunk.tree() else { panic!("no drawing") };
    assert_eq!(tree.rungs.len(), 1, "{}", document.text());
    tree.rungs[0].graph.logic_text(at.chunk.text())
}

fn device_of_new(part: &Part) -> String {
    let made = generate(part, fx());
    made.words.trim().to_string()
}

/// Checks one edit at the first cell of one element; whether it was done.
fn check_edit(part: &Part, drawing: &Drawn, number: usize, kind: EditKind, style: Style) -> bool {
    let Drawn { text, document, head, tail, cursors } = drawing;
    let cursor = cursors[number];
    let leaf = &leaves(part)[number];
    let as_output = is_output(leaf) && kind == EditKind::InsertBranch;
    let new = Part::Leaf(if as_output { Leaf::Coil(0, NEW) } else { Leaf::Contact(0, NEW) });
    let operand = device_of_new(&new);
    let expected = model(part, number, kind);
    let answer = match ide::edit(document, Span::at(cursor), kind, Some(&operand), style) {
        Ok(answer) => answer,
        Err(message) => {
            let edge = ["edit.first-branch", "edit.last-branch", "edit.no-branch", "edit.no-negation"];
            assert!(
                expected.is_some() || edge.contains(&message.key()),
                "{kind:?} {}\n{text}",
                message.key()
            );
            return expected.is_none();
        }
    };
    let after = TextEdit::apply_all(&answer.edits, text);
    assert_eq!(after[..*head], text[..*head], "{kind:?} changes what stands above");
    assert_eq!(after[after.len() - tail..], text[text.len() - tail..], "{kind:?} changes what stands below");
    assert!(answer.selection.end as usize <= after.len());
    let Some(expected) = expected else { return check_comparison(leaf, kind, &after) };
    let made = generate(&expected, fx());
    assert_eq!(
        logic(&ladder(&after), *head),
        made.graph.logic_text(&made.words),
        "{kind:?} at {number} of\n{text}\n{after}"
    );
    true
}

/// Comparisons have a negation, too, which the parts of test rungs cannot name.
fn check_comparison(leaf: &Leaf, kind: EditKind, after: &str) -> bool {
    assert!(
        kind == EditKind::Negate && matches!(leaf, Leaf::Compare(..)),
        "{kind:?} should be refused\n{after}"
    );
    true
}

#[test]
fn every_edit_at_every_element_of_every_small_rung() {
    for contacts in 1..=4 {
        // Four contacts make all the shapes that matter; three show that styles make no difference.
        let styles = if contacts < 4 { 3 } else { 1 };
        for part in all_rungs(contacts) {
            let part = normal(&part);
            for (style, kind) in [
                (STYLE, StyleKind::Iec),
                (Style { kind: FormatStyle::Brackets, ..STYLE }, StyleKind::Brackets),
                (Style { kind: FormatStyle::Unicode, ..STYLE }, StyleKind::Unicode),
            ]
            .into_iter()
            .take(styles)
            {
                let drawing = drawn(&part, kind).expect("a small rung is drawn");
                for number in 0..leaves(&part).len() {
                    for edit in MODELLED {
                        assert!(
                            check_edit(&part, &drawing, number, edit, style),
                            "{edit:?}\n{}",
                            drawing.text
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn deleting_what_was_inserted_and_moving_there_and_back_change_nothing() {
    let mut moves = 0;
    for part in all_rungs(4).iter().map(normal) {
        let drawing = drawn(&part, StyleKind::Iec).unwrap();
        for cursor in &drawing.cursors {
            let cursor = Span::at(*cursor);
            let apply = |text: &str, cursor: Span, kind: EditKind| {
                let answer = ide::edit(&ladder(text), cursor, kind, Some("M3"), STYLE).ok()?;
                Some((TextEdit::apply_all(&answer.edits, text), answer.selection))
            };
            for kind in [EditKind::InsertContact, EditKind::InsertBranch] {
                let (inserted, behind) = apply(&drawing.text, cursor, kind).unwrap();
                let on = Span::at(behind.start as usize - 1);
                let (deleted, _) = apply(&inserted, on, EditKind::DeleteElement).unwrap();
                assert_eq!(
                    logic(&ladder(&deleted), drawing.head),
                    logic(&drawing.document, drawing.head),
                    "{inserted}"
                );
            }
            for (there, back) in [
                (EditKind::MoveBranchUp, EditKind::MoveBranchDown),
                (EditKind::MoveBranchDown, EditKind::MoveBranchUp),
            ] {
                if let Some((moved, behind)) = apply(&drawing.text, cursor, there) {
                    moves += 1;
                    assert_ne!(moved, drawing.text);
                    let on = Span::at(behind.start as usize - 1);
                    assert_eq!(apply(&moved, on, back).unwrap().0, drawing.text, "{moved}");
                }
            }
        }
    }
    assert!(moves > 50, "{moves}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn every_edit_of_random_rungs_does_what_it_should_or_is_refused(part in rung(12)) {
        let part = normal(&part);
        let drawing = drawn(&part, StyleKind::Iec);
        // Were none of them drawn, too many cases would be refused.
        prop_assume!(drawing.is_some());
        let drawing = drawing.unwrap();
        let (mut done, mut asked) = (0, 0);
        for number in 0..leaves(&part).len() {
            for edit in MODELLED {
                asked += 1;
                done += i32::from(check_edit(&part, &drawing, number, edit, STYLE));
            }
        }
        prop_assert!(done * 2 >= asked, "{done} of {asked} edits of\n{}", drawing.text);
    }
}

#[test]
fn a_rail_that_no_wire_reaches_stays() {
    check(
        "\
|     timer0                           |
|     +------+                         |
|     | TON  |      T237               |
+----O|IN   Q|O--+---|P|------->>P5751 |
| D0--|PT  ET|   |                     |
|     +------+   |                     |
|                |                     |
+--[= K^0 K0]-----+                     |
",
        EditKind::Negate,
        None,
        expect![[r#"
            |     timer0                           |
            |     +------+                         |
            |     | TON  |      T237               |
            +----O|IN   Q|O--+---|P|------->>P5751 |
            | D0--|PT  ET|   |                     |
            |     +------+   |                     |
            |                |                     |
            +--[<> K0 K0]^----+                     |
        "#]],
    );
}

#[test]
fn no_edit_anywhere_in_any_text_harms() {
    let mut texts: Vec<String> = (0..MOTOR.len()).step_by(23).map(|end| MOTOR[..end].to_string()).collect();
    texts.extend((0..MOTOR.len()).step_by(31).map(|at| [&MOTOR[..at], "|\t日本\n+", &MOTOR[at..]].concat()));
    texts.extend(
        ["", "\n", "|", "+-+", "\u{feff}+--+", "é̂--|", "(*", "NETWORK 1\n+--[X0", "PROGRAM a\nVAR\n"]
            .map(String::from),
    );
    for text in texts {
        let document = ladder(&text);
        for offset in (0..=text.len() + 1).step_by(13) {
            for kind in EditKind::all() {
                for span in [Span::at(offset), Span::new(offset, offset + 9)] {
                    if let Ok(answer) = ide::edit(&document, span, kind, None, STYLE) {
                        let after = TextEdit::apply_all(&answer.edits, &text);
                        assert!(
                            answer.selection.end as usize <= after.len(),
                            "{kind:?} at {offset} of {text:?}"
                        );
                    }
                }
            }
            ide::applicable_edits(&document, Span::at(offset));
        }
    }
}

/// The text of an object, with `|` at the ends of its rows if it is a rectangle.
fn object(text: &str, kind: ObjectKind, around: bool) -> String {
    let (text, span) = marked(text);
    let document = ladder(&text);
    let Some(object) = ide::object(&document, span.start as usize, kind, around) else {
        return "none".to_string();
    };
    if !object.blockwise {
        return object.span.of(&text).to_string();
    }
    let [from, to] =
        [object.span.start, object.span.end].map(|at| document.position(at as usize, Encoding::Utf32));
    let rows = text.lines().skip(from.line as usize).take((to.line - from.line) as usize + 1);
    let cells = |line: &str| -> String {
        line.chars().skip(from.column as usize).take((to.column - from.column) as usize).collect()
    };
    rows.map(|line| format!("<{}>\n", cells(line))).collect()
}

#[test]
fn objects_are_element_branch_rung_and_network() {
    let at = |kind, around, line, column| object(&motor(line, column), kind, around);
    expect!["|/|"].assert_eq(&at(ObjectKind::Element, false, 2, 15));
    expect![[r#"
        <X1 >
        <|/|>
    "#]]
    .assert_eq(&at(ObjectKind::Element, true, 2, 15));
    expect!["( )"].assert_eq(&at(ObjectKind::Element, false, 2, 20));
    expect![[r#"
        <Y0 >
        <| |>
    "#]]
    .assert_eq(&at(ObjectKind::Branch, false, 4, 2));
    expect![[r#"
        <   Y0    >
        <---| |--->
    "#]]
    .assert_eq(&at(ObjectKind::Branch, true, 4, 5));
    expect!["none"].assert_eq(&at(ObjectKind::Branch, true, 2, 15));
    expect![[r#"
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]]
    .assert_eq(&at(ObjectKind::Rung, false, 4, 5));
    expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |
    "#]]
    .assert_eq(&at(ObjectKind::Rung, true, 4, 5));
    expect!["none"].assert_eq(&at(ObjectKind::Rung, false, 0, 5));
    let networks = format!(
        "{MOTOR}\nNETWORK 2 'two'\n+--[X^0]--(Y1)-+\n\n+--[X1]--(Y2)-+\n\nNETWORK 3\n+--[X0]--(Y3)-+\n"
    );
    expect![[r#"
        +--[X0]--(Y1)-+

        +--[X1]--(Y2)-+

    "#]]
    .assert_eq(&object(&networks, ObjectKind::Network, false));
    expect![[r#"
        NETWORK 2 'two'
        +--[X0]--(Y1)-+

        +--[X1]--(Y2)-+

    "#]]
    .assert_eq(&object(&networks, ObjectKind::Network, true));
}

/// What grows around the cursor, each range on a line of its own.
fn ranges(text: &str, notation: Notation, model: Model) -> String {
    let (text, span) = marked(text);
    let document = Document::new(&text, notation, Target::of(model));
    let ranges = ide::selection_ranges(&document, span.start as usize);
    assert!(ranges.windows(2).all(|pair| pair[1].to(pair[0]) == pair[1] && pair[0] != pair[1]), "{ranges:?}");
    ranges.iter().map(|range| format!("{:?}\n", range.of(&text))).collect()
}

#[test]
fn selection_grows_from_the_name_to_the_document() {
    let text = format!("{}\nNETWORK 2\n+--[X0]--(Y1)-+\n", motor(3, 5));
    expect![[r#"
        "Y0"
        "Y0    |                                      |\n+---| |"
        "|   X0        X1                             Y0  |\n+---| |---+---|/|----------------------------( )-+\n|   Y0    |                                      |\n+---| |---+                                      |"
        "(* Start and stop *)\n|   X0        X1                             Y0  |\n+---| |---+---|/|----------------------------( )-+\n|   Y0    |                                      |\n+---| |---+                                      |\n\n"
        "(* Start and stop *)\n|   X0        X1                             Y0  |\n+---| |---+---|/|----------------------------( )-+\n|   Y0    |                                      |\n+---| |---+                                      |\n\nNETWORK 2\n+--[X0]--(Y1)-+\n"
    "#]].assert_eq(&ranges(&text, Notation::Ladder, Model::Fx2n));
    expect![[r#"
        "T0"
        "OUT T0 K50"
        "LD X0\nOUT T0 K50"
        "LD X0\nOUT T0 K50\nLD X1\nOUT Y1\n"
    "#]]
    .assert_eq(&ranges("LD X0\nOUT T^0 K50\nLD X1\nOUT Y1\n", Notation::FxIl, Model::Fx2n));
    let program =
        "PROGRAM a\nVAR\n  x : BOOL;\nEND_VAR\n  LD x\n  ST %QX^0.0\nEND_PROGRAM\nPROGRAM b\nEND_PROGRAM\n";
    expect![[r#"
        "%QX0.0"
        "ST %QX0.0"
        "LD x\n  ST %QX0.0\nEND_PROGRAM"
        "PROGRAM a\nVAR\n  x : BOOL;\nEND_VAR\n  LD x\n  ST %QX0.0\nEND_PROGRAM"
        "PROGRAM a\nVAR\n  x : BOOL;\nEND_VAR\n  LD x\n  ST %QX0.0\nEND_PROGRAM\nPROGRAM b\nEND_PROGRAM\n"
    "#]]
    .assert_eq(&ranges(program, Notation::IecIl, Model::Iec));
}

#[test]
fn linked_names_are_those_whose_rows_have_nothing_behind_them() {
    let places = |text: &str, notation| {
        let (text, span) = marked(text);
        let document = Document::new(&text, notation, fx());
        let spans = ide::linked_places(&document, span.start as usize);
        spans.iter().map(|span| (span.start, span.of(&text).to_string())).collect::<Vec<_>>()
    };
    let x0 = |at| (at, "X0".to_string());
    assert_eq!(places("LD X^0\nOR X1\nAND X0\nOUT Y0\n", Notation::FxIl), [x0(3), x0(16)]);
    assert!(places("LD X^1\nOUT Y0\n", Notation::FxIl).is_empty());
    // In front of a rail a longer name would push it aside.
    assert!(places(&motor(3, 5), Notation::Ladder).is_empty());
    let open = "+--[X1]--+-----( )\n         |     Y^0\n         +-----( )\n               Y0\n";
    assert_eq!(places(open, Notation::Ladder).len(), 2);
}

/// The drawing after mending it at a line; nothing if that is refused.
fn mended(text: &str, line: usize) -> Option<String> {
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let answer = ide::edit(&ladder(text), Span::at(start + 1), EditKind::Mend, None, STYLE).ok()?;
    Some(TextEdit::apply_all(&answer.edits, text))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// A drawing in order stays, and one that was mended is in order.
    #[test]
    fn mending_changes_nothing_twice(part in rung(10), seed in any::<u64>()) {
        let part = normal(&part);
        let drawing = drawn(&part, StyleKind::Iec);
        // Were none of them drawn, too many cases would be refused.
        prop_assume!(drawing.is_some());
        let drawing = drawing.unwrap();
        let lines: Vec<&str> = drawing.text.lines().collect();
        // The rung stands behind a rung and a comment, and before another rung.
        let (first, end) = (3, lines.len() - 2);
        for line in first..end {
            let same = mended(&drawing.text, line);
            prop_assert_eq!(same.as_deref(), Some(drawing.text.as_str()));
        }
        // A cell more or less somewhere in a row.
        let line = first + seed as usize % (end - first);
        let cells: Vec<char> = lines[line].chars().collect();
        let at = (seed >> 16) as usize % cells.len();
        let mut row = cells.clone();
        if matches!(row[at], ' ' | '-') {
            if seed >> 60 & 1 == 0 { row.insert(at, cells[at]) } else { _ = row.remove(at) }
        }
        let row: String = row.into_iter().collect();
        let torn: String =
            lines.iter().enumerate().map(|(n, own)| format!("{}\n", if n == line { &row } else { *own })).collect();
        if let Some(once) = mended(&torn, line) {
            let twice = mended(&once, line);
            prop_assert_eq!(twice.as_deref(), Some(once.as_str()), "from\n{}", torn);
        }
    }
}

#[test]
fn a_name_stays_over_its_element_when_its_row_is_mended() {
    let drawing = "\
|  T157                                |
+---|/|---+--[MOV K11193 D3193]--------+
|  T122   |                            |
+---|P|---+                            |
";
    for torn in [
        drawing.replacen("T157 ", "T157", 1),
        drawing.replacen("T157 ", "T157  ", 1),
        drawing.replacen("T122   |  ", "T122   | ", 1),
    ] {
        let line = if torn.contains("T157                                |") { 2 } else { 0 };
        assert_eq!(mended(&torn, line).as_deref(), Some(drawing), "from\n{torn}");
    }
}
