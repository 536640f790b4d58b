//! Structural edits of ladder drawings: what each makes of a rung, that nothing else changes, and that what cannot be
//! done is refused.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use expect_test::{Expect, expect};
use rungwise::document::{Document, Notation};
use rungwise::ide::{self, EditKind, Style};
use rungwise::project::FormatStyle;
use rungwise::target::{Model, Target};
use rungwise::text::{Language, Span, TextEdit};

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

fn motor(line: usize, column: usize) -> String {
    let start: usize = MOTOR.split_inclusive('\n').take(line).map(str::len).sum();
    let mut text = MOTOR.to_string();
    text.insert(start + column, '^');
    text
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
