//! Drawings by hand: lines and names that miss each other by a column or two are read as everybody reads them, or
//! both readings are shown; and the dialects in which people draw.

use crate::ladder_read::dump;
use rungwise::check::{self, Severities};
use rungwise::document::{Document, Edit, Notation, Symbol, Tree};
use rungwise::ladder::{TWO_READINGS, parse, split};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, Severity, TextEdit};

fn fx() -> &'static Target {
    Target::of(Model::Fx3u)
}

fn logic(drawing: &str) -> String {
    let tree = parse(drawing, fx());
    tree.rungs.iter().map(|rung| rung.graph.logic_text(drawing)).collect::<Vec<_>>().join("--\n")
}

fn found(drawing: &str) -> Vec<Diagnostic> {
    let document = Document::new(drawing, Notation::Ladder, fx());
    check::realtime(&document, &Severities::default())
}

/// Sound drawings with two blank columns in front, so that everything can move to the left.
const STRAIGHT: &[&str] = &[
    "
  |   X0        X1                     Y0  |
  +---| |---+---|/|--------------------( )-+
  |   Y0    |                              |
  +---| |---+                              |
",
    "
  |   X0        X1          X3         Y0  |
  +---| |---+---| |---+-----| |---+----( )-+
  |         |   X2    |           |    Y1  |
  |         +---| |---+           +----( )-+
  |         |   X4    |                    |
  |         +---| |---+                    |
",
    "
  |   X0       X1       Y0
  +---[ ]--+---[ ]------( )--
  |   X2   |
  +---[ ]--+
  |   X3   |
  +---[ ]--+
",
    "
  +---[X0]----+----[X1]----+----(Y0)----+
  +---[X2]----+----[X3]----+            |
  +---[X4]----+                         |
",
    "
  ┌   X0        X1                     Y0  ┐
  ├───┤ ├───┬───┤/├──────────────┬─────( )─┤
  │   Y0    │                    │     Y1  │
  ├───┤ ├───┘                    └─────( )─┤
",
    "
  |   X0        X1                     Y0  |
  +---| |---+---| |---+----------------( )-+
  |         |   X2    |                    |
  |         +---| |---+                    |
  |   X3    |         |                    |
  +---| |---+         |                    |
  |   X4              |                    |
  +---| |-------------+                    |
",
];

/// A drawing with one thing out of place.
struct Moved {
    what: String,
    drawing: String,
}

fn is_bar(c: char) -> bool {
    matches!(c, '|' | '│')
}

fn is_wire(c: char) -> bool {
    matches!(c, '-' | '─')
}

fn is_junction(c: char) -> bool {
    matches!(c, '+' | '├' | '┤' | '┬' | '┴' | '┘' | '└' | '┐' | '┌')
}

fn grid(drawing: &str) -> Vec<Vec<char>> {
    drawing.lines().map(|line| line.chars().collect()).collect()
}

fn text(grid: &[Vec<char>]) -> String {
    let line = |line: &Vec<char>| format!("{}\n", line.iter().collect::<String>().trim_end());
    grid.iter().map(line).collect()
}

/// Moves the character in `from` to `to` along its row; wires follow it. Nothing if something is in the way.
fn shifted(row: &[char], from: usize, to: usize) -> Option<Vec<char>> {
    let mut row = row.to_vec();
    row.resize(row.len() + 3, ' ');
    let own = row[from];
    let (before, after) = (row.get(from.wrapping_sub(1)).copied().unwrap_or(' '), row[from + 1]);
    let way = if to > from { from + 1..to + 1 } else { to..from };
    // What is left behind, and what may be overwritten.
    let (behind, ahead) = if to > from { (before, after) } else { (after, before) };
    let blank_or_wire = |c: char| c == ' ' || is_wire(c);
    if !blank_or_wire(behind) || way.clone().any(|at| row[at] != ahead) || !blank_or_wire(ahead) {
        return None;
    }
    way.for_each(|at| row[at] = behind);
    row[from] = behind;
    row[to] = own;
    Some(row)
}

/// Every bar, junction and rail of the drawing, each row and each left rail, moved by -2 to 2 columns; rails left out.
fn moved(drawing: &str) -> Vec<Moved> {
    let straight = grid(drawing);
    let mut all = Vec::new();
    let mut add = |what: String, line: usize, row: Option<Vec<char>>| {
        let Some(row) = row else { return };
        let mut grid = straight.clone();
        grid[line] = row;
        all.push(Moved { what, drawing: text(&grid) });
    };
    for (line, row) in straight.iter().enumerate() {
        let last = row.iter().rposition(|c| *c != ' ').unwrap_or(0);
        for by in [-2isize, -1, 1, 2] {
            for (column, c) in row.iter().enumerate() {
                let beside = |c: Option<&char>| c.is_none_or(|c| *c == ' ');
                let bare = beside(row.get(column.wrapping_sub(1))) && beside(row.get(column + 1));
                let contact_bar = |c: Option<&char>| c.is_some_and(|c| is_bar(*c) || matches!(c, '┤' | '├'));
                let contact = contact_bar(row.get(column + 2)) && row[column + 1..][..2] != ['─', '┤']
                    || column >= 2 && contact_bar(row.get(column - 2));
                let upright = !contact && (is_junction(*c) || (is_bar(*c) && bare));
                if let Some(to) = column.checked_add_signed(by).filter(|_| upright) {
                    let what = format!("`{c}` in line {line}, column {column} by {by}");
                    add(what, line, shifted(row, column, to));
                }
            }
            let row_shifted = match by {
                0.. => Some([vec![' '; by.unsigned_abs()], row.clone()].concat()),
                _ => Some(row[by.unsigned_abs()..].to_vec()),
            };
            add(format!("line {line} by {by}"), line, row_shifted);
        }
        let mut no_left = row.clone();
        no_left[2] = ' ';
        add(format!("line {line} without left rail"), line, Some(no_left));
        if last > 35 {
            let mut no_right = row.clone();
            no_right.truncate(last);
            add(format!("line {line} without right rail"), line, Some(no_right));
        }
    }
    all
}

#[test]
fn what_is_off_by_two_columns_is_read_as_the_straight_drawing() {
    let mut failures = Vec::new();
    let mut count = 0;
    for straight in STRAIGHT.iter().map(|drawing| drawing.trim_start_matches('\n')) {
        let wanted = logic(straight);
        assert!(!wanted.contains("loose"), "{straight}{wanted}");
        assert!(parse(straight, fx()).problems.is_empty(), "{straight}");
        for moved in moved(straight) {
            count += 1;
            let found = found(&moved.drawing);
            // Asking which of two readings is meant is for what leaves a reader in doubt, too.
            let mild = |finding: &Diagnostic| {
                finding.code.starts_with("ragged") && finding.message.key() != TWO_READINGS
            };
            if logic(&moved.drawing) != wanted || !found.iter().all(mild) {
                let codes: Vec<String> =
                    found.iter().map(|f| format!("{} {}", f.code, f.message.key())).collect();
                failures.push(format!(
                    "{}\n{}{}\n{codes:?}\n",
                    moved.what,
                    moved.drawing,
                    logic(&moved.drawing)
                ));
            }
        }
    }
    assert!(failures.is_empty(), "{} of {count}\n{}", failures.len(), failures.join("\n"));
    assert!(count > 500, "{count}");
}

/// The drawing of each fix of a finding.
fn fixed(drawing: &str, finding: &Diagnostic) -> Vec<String> {
    finding.fixes.iter().map(|fix| TextEdit::apply_all(&fix.edits, drawing)).collect()
}

#[test]
fn what_was_read_is_redrawn() {
    for straight in STRAIGHT.iter().map(|drawing| drawing.trim_start_matches('\n')) {
        let wanted = logic(straight);
        let mut redrawn = 0;
        for moved in moved(straight) {
            let found = found(&moved.drawing);
            for finding in found.iter().filter(|finding| finding.code == "ragged-drawing") {
                if finding.message.key() == TWO_READINGS {
                    continue;
                }
                let fixed = fixed(&moved.drawing, finding);
                let drawing = fixed.last().unwrap_or_else(|| panic!("{}\n{}", moved.what, moved.drawing));
                assert_eq!(logic(drawing), wanted, "{}\n{}{drawing}", moved.what, moved.drawing);
                assert!(parse(drawing, fx()).problems.is_empty(), "{drawing}");
                redrawn += 1;
            }
        }
        assert!(redrawn > 20, "{straight}");
    }
}

#[test]
fn two_readings_are_shown_and_neither_is_taken() {
    let drawing = "\
|   X0       X2                Y0  |
+---| |---+[ ]+----------------( )-+
|   X1      |                      |
+---| |-----+                      |
";
    let found = found(drawing);
    assert_eq!(
        found.iter().map(|f| (f.code, f.severity)).collect::<Vec<_>>(),
        [("ragged-drawing", Severity::Warning)]
    );
    let words = found[0].message.render(Language::English);
    assert!(words.contains("column 11") && words.contains("column 15"), "{words}");
    let related: Vec<&str> = found[0].related.iter().map(|related| related.span.of(drawing)).collect();
    assert_eq!(related, ["+", "+"]);
    let readings = fixed(drawing, &found[0]);
    let expected = [
        "\
|   X0        X2                           Y0  |
+---| |---+---| |--------------------------( )-+
|   X1    |                                    |
+---| |---+                                    |
",
        "\
|   X0      X2                             Y0  |
+---| |-----| |---+------------------------( )-+
|   X1            |                            |
+---| |-----------+                            |
",
    ];
    assert_eq!(readings, expected);
}

/// Reads a drawing for a target and compares what it stands for, as `ladder_read` writes it.
#[track_caller]
fn check_dialect(model: Model, drawing: &str, expected: &[&str]) {
    let drawing = drawing.trim_start_matches('\n');
    let mut start = 0;
    let mut found = Vec::new();
    for end in split(drawing) {
        let chunk = &drawing[start..end];
        start = end;
        let tree = parse(chunk, Target::of(model));
        found.extend(dump(&tree, chunk).lines().map(str::to_string));
    }
    assert_eq!(found, expected, "\n{drawing}");
}

/// Start, stop and seal-in, as most examples in this file.
const SEALED: &[&str] = &["L start J1", "L motor J1", "J1 /stop (motor) R"];

#[test]
fn dialect_of_bars() {
    let drawing = "
|  start      stop              motor  |
|--| |---+----|/|----------------( )---|
|        |                             |
|  motor |                             |
|--| |---+                             |
";
    check_dialect(Model::Iec, drawing, SEALED);
}

#[test]
fn dialect_of_brackets_that_open_outwards() {
    let drawing = "
||    start           stop           motor      ||
||-----] [-----+------]/[------------( )-------||
||             |                                ||
||    motor    |                                ||
||-----] [-----+                                ||
";
    check_dialect(Model::Iec, drawing, SEALED);
}

#[test]
fn dialect_of_brackets_that_open_inwards() {
    let drawing = "
   start    stop     motor
---[ ]--+---[/]-------( )---
  motor |
---[ ]--+
";
    check_dialect(Model::Iec, drawing, SEALED);
}

#[test]
fn dialect_of_names_in_brackets() {
    let drawing = "
|--[start]--+--[/stop]--------( motor )--|
|           |                            |
|--[motor]--+                            |
";
    check_dialect(Model::Iec, drawing, SEALED);
}

#[test]
fn dialect_of_allen_bradley() {
    let drawing = "
|  start    stop          motor |
|---||---+---|/|---------(OTE)--|
|  motor |                      |
|---||---+                      |
|  jam                    alarm |
|---||-------------------(OTL)--|
|  ack                    alarm |
|---||--------------------(U)---|
";
    let latch: &[&str] = &["--", "L jam (S alarm) R", "--", "L ack (R alarm) R"];
    check_dialect(Model::Iec, drawing, &[SEALED, latch].concat());
    // A timer that is enabled and done, with its parameters inside.
    let drawing = "
|  part                +-----------+
|---||-----------------| TON       |--(EN)
|                      | Timer T4  |
|                      | Preset 30 |--(DN)
|                      +-----------+
";
    let expected = [
        "L part T4:TON.#0",
        "T4:TON.#0 (EN) R",
        "T4:TON.#1 (DN) R",
        "block T4:TON _=wire Preset=30 =>_=wire =>_=wire",
    ];
    check_dialect(Model::Iec, drawing, &expected);
}

#[test]
fn dialect_of_box_drawing_and_frames() {
    let drawing = "
┌──────────────────────────────────────────┐
│   start       stop              motor    │
│ ──┤ ├────┬────┤/├────────────────( )──── │
│   motor  │                               │
│ ──┤ ├────┘                               │
└──────────────────────────────────────────┘
";
    check_dialect(Model::Iec, drawing, SEALED);
    // A caption, a divider, rails of their own inside, cut by a blank line in the frame.
    let drawing = "
┌─────────────────────────────────────────────┐
│ Network 1: start and stop                   │
├─────────────────────────────────────────────┤
│                                             │
│ |   start     stop               motor |    │
│ |---| |---+---|/|-----------------( )--|    │
│ |   motor |                            |    │
│ |---| |---+                            |    │
└─────────────────────────────────────────────┘
";
    check_dialect(Model::Iec, drawing, SEALED);
    // Of ASCII characters.
    let drawing = "
+------------------------------------------+
|   start       stop              motor    |
| --| |----+----|/|----------------( )---- |
|   motor  |                               |
| --| |----+                               |
+------------------------------------------+
";
    check_dialect(Model::Iec, drawing, SEALED);
    // Sides to which wires lead are rails, and the line above them is a cap.
    let drawing = "
┌──────────────────────────────────────────┐
│   start       stop              motor    │
├───┤ ├────┬────┤/├────────────────( )─────┤
│   motor  │                               │
├───┤ ├────┘                               │
└──────────────────────────────────────────┘
";
    check_dialect(Model::Iec, drawing, SEALED);
    // Mixed with ASCII.
    let drawing = "
│ start   stop       motor
├──┤ ├─+──┤/├────────( S )──┤
│ jog  |
├──┤ ├─+
│ end
├──┤ ├────────────(RET)
";
    let expected = ["L start J1", "L jog J1", "J1 /stop (S motor) R", "--", "L end (RET) R"];
    check_dialect(Model::Iec, drawing, &expected);
    // A single line from rail to rail is a rung without an element, not a frame.
    check_dialect(Model::Iec, "+------------------+\n", &["L R"]);
}

#[test]
fn dialect_of_names_below_over_two_lines_and_in_the_wire() {
    let drawing = "
|--| |---+---|/|----------------( )--|
|  start |   stop              motor |
|        |                           |
|--| |---+                           |
|  motor                             |
";
    check_dialect(Model::Iec, drawing, SEALED);
    let drawing = "
|  START     EMERG             CONV_      |
|  BUTTON    STOP              MOTOR      |
|---| |---+---|/|---------------( )-------|
|  CONV_  |                               |
|  MOTOR  |                               |
|---| |---+                               |
";
    let expected = ["L START_BUTTON J1", "L CONV_MOTOR J1", "J1 /EMERG_STOP (CONV_MOTOR) R"];
    check_dialect(Model::Iec, drawing, &expected);
    let drawing = "
|-- start --| |---+--- stop --|/|-------( ) motor --|
|                 |                                 |
|-- motor --| |---+                                 |
";
    check_dialect(Model::Iec, drawing, SEALED);
    let drawing = "
|---| | start ---+---|/| stop -----------( ) motor ---|
|---| | motor ---+
";
    check_dialect(Model::Iec, drawing, SEALED);
    let drawing = "
|  启动        停止               电机  |
|--| |---+----|/|----------------( )----|
|  电机  |                              |
|--| |---+                              |
";
    check_dialect(Model::Iec, drawing, &["L 启动 J1", "L 电机 J1", "J1 /停止 (电机) R"]);
}

#[test]
fn dialect_of_exclamation_marks() {
    let drawing = "
!  start    stop            motor !
!--] [--!---]/[--------------( )--!
!  motor!                         !
!--] [--!                         !
";
    check_dialect(Model::Iec, drawing, SEALED);
}

#[test]
fn dialects_of_rails() {
    let plain: &[&str] = &["L a /b (y) R"];
    check_dialect(Model::Iec, "    a      b        y\n ---] [----]/[-----( )\n", plain);
    check_dialect(Model::Iec, "    a      b        y    |\n ---] [----]/[-----( )---|\n", plain);
    check_dialect(Model::Iec, "|   a      b        y\n|---] [----]/[-----( )\n", plain);
    check_dialect(Model::Iec, "||   a      b        y   ||\n||--] [----]/[-----( )---||\n", plain);
    // A rail between conditions and outputs.
    let drawing = "
|   start      stop    |    motor   |
|----| |---+----|/|----|----( )-----|
|   motor  |           |            |
|----| |---+           |            |
";
    check_dialect(Model::Iec, drawing, SEALED);
}

#[test]
fn dialect_of_branches_that_join_behind_the_coil() {
    let drawing = "
|  start       stop       motor    |
|---| |--+-----|/|-----+---( )---+-|
|        |             |         | |
|  motor |             |   lamp  | |
|---| |--+             +---( )---+ |
";
    let expected = ["L start J1", "L motor J1", "J1 /stop J2", "J2 (motor) J3", "J2 (lamp) J3", "J3 R"];
    check_dialect(Model::Iec, drawing, &expected);
}

#[test]
fn dialect_of_boxes_as_outputs() {
    let drawing = "
|   X0                             |
|---| |-------------------[ T1 K10 ]
|   T1                             |
|---| |---------------------( Y0 )-|
";
    check_dialect(Model::Fx3u, drawing, &["L X0 (T1 K10) R", "--", "L T1 (Y0) R"]);
    let drawing = "
|   part                                 |
|---| |-------------------[CTU C1, PV:5]-|
";
    let expected = ["L part C1:CTU.CU", "C1:CTU.Q R", "block C1:CTU CU=wire PV=5 =>Q=wire"];
    check_dialect(Model::Iec, drawing, &expected);
    let drawing = "
|                    T1                    |
|   start     +-------------+        run   |
|---| |-------|IN   TON    Q|--------( )---|
|             | PT = 500 ms |              |
|             +-------------+              |
";
    let expected = ["L start T1:TON.IN", "T1:TON.Q (run) R", "block T1:TON IN=wire PT=T#500ms =>Q=wire"];
    check_dialect(Model::Iec, drawing, &expected);
}

/// The first operand of each element of the first drawing that has `mark` in it.
fn names_of(document: &Document, mark: &str) -> Vec<String> {
    let chunk = document.chunks().map(|at| at.chunk).find(|chunk| chunk.text().contains(mark)).unwrap();
    let Tree::Ladder(tree) = chunk.tree() else { panic!("{mark}") };
    let elements = tree.rungs.iter().flat_map(|rung| &rung.graph.elements);
    elements.map(|element| element.operand_text(0, chunk.text()).into_owned()).collect()
}

#[test]
fn a_drawing_in_doubt_follows_the_others_of_its_document() {
    // Names stand between the rows, so either could be meant.
    let doubt = "|--| |-----( )--|\n|  X7     Y7    |\n|--| |-----( )--|\n";
    let above = "|  X0     Y0    |\n|--| |-----( )--|\n\n";
    let below = "|--| |-----( )--|\n|  X0     Y0    |\n\n";
    let mut document = Document::new(&format!("{below}{below}{doubt}"), Notation::Ladder, fx());
    assert_eq!(names_of(&document, "X7"), ["X7", "Y7", "", ""]);
    // The habit turns while the drawing in doubt stays.
    let edit = Edit { range: Some(0..2 * below.len()), text: above.repeat(2) };
    document.apply(&[edit]);
    assert_eq!(names_of(&document, "X7"), ["", "", "X7", "Y7"]);
    let edit = Edit { range: Some(0..0), text: below.repeat(5) };
    document.apply(&[edit]);
    assert_eq!(names_of(&document, "X7"), ["X7", "Y7", "", ""]);
    assert_eq!(names_of(&document, "X0")[..2], ["X0", "Y0"]);
}

#[test]
fn a_name_over_several_lines_is_one_name() {
    let text = "|  CONV_     EMERG             LAMP       |
|  MOTOR     STOP                         |
|---| |-------|/|---------------( )-------|
";
    let document = Document::new(text, Notation::Ladder, Target::of(Model::Iec));
    let chunk = document.chunk_at(0).unwrap().chunk;
    let mentions: Vec<(&str, &Symbol)> =
        chunk.mentions().iter().map(|mention| (mention.span.of(text), &mention.symbol)).collect();
    let (motor, stop) = (Symbol::variable("CONV_MOTOR"), Symbol::variable("EMERG_STOP"));
    let lamp = Symbol::variable("LAMP");
    let expected = [("CONV_", &motor), ("EMERG", &stop), ("LAMP", &lamp), ("MOTOR", &motor), ("STOP", &stop)];
    assert_eq!(mentions, expected);
    let at = |word: &str| text.find(word).unwrap();
    let places = |word: &str| rungwise::ide::references(&document, at(word), true);
    assert_eq!(places("CONV_"), places("MOTOR"));
    assert_eq!(places("CONV_").len(), 2);
}

#[test]
fn names_of_a_ladder_without_header_are_variables_by_use() {
    let text = "\
|   start     stop                     motor   |
+---| |---+---|/|-----------------------( )----+
|  moter  |                                    |
+---| |---+                                    |

|   motor     pump_1                   lamp    |
+---| |---+---| |-----------------------( )----+
|  pump_2 |                                    |
+---| |---+                                    |
";
    let document = Document::new(text, Notation::Ladder, Target::of(Model::Iec));
    let found = check::all(&document, &Severities::default());
    let similar: Vec<&str> =
        found.iter().filter(|f| f.code == "similar-names").map(|f| f.span.of(text)).collect();
    assert_eq!(similar, ["moter"]);
    assert!(found.iter().all(|finding| finding.code != "undeclared-variable"), "{found:?}");
    // With declarations the rule about them speaks.
    let text = format!("PROGRAM p\nVAR\n  start : BOOL;\nEND_VAR\n\n{text}\nEND_PROGRAM\n");
    let found =
        check::all(&Document::new(&text, Notation::Ladder, Target::of(Model::Iec)), &Severities::default());
    assert!(found.iter().any(|finding| finding.code == "undeclared-variable"));
    assert!(found.iter().all(|finding| finding.code != "similar-names"));
}

#[test]
fn a_name_in_the_wire_before_the_right_rail_becomes_a_coil() {
    let cases = [
        ("|--X0--+--Y0--|\n|--X1--+      |\n", "|-[X0]-+-(Y0)-|\n|-[X1]-+      |\n"),
        ("|--X0----M0---|\n", "|-[X0]--(M0)--|\n"),
        ("|--X0----Y0|\n", "|-[X0]-(Y0)|\n"),
        ("||--X0----Y0---||\n", "||-[X0]--(Y0)--||\n"),
        // What nothing can drive is a contact wherever it stands, and so is what does not stand at the rail.
        ("|--Y0----X0---|\n", "|-[Y0]--[X0]--|\n"),
        ("|--Y0--+--Y1--|\n|--M0--+      |\n", "|-[Y0]-+-(Y1)-|\n|-[M0]-+      |\n"),
        ("|--T0----D0---|\n", "|-[T0]--[D0]--|\n"),
    ];
    for (drawing, expected) in cases {
        let found = parse(drawing, fx()).problems;
        let mut edits: Vec<TextEdit> = Vec::new();
        for problem in found.iter().filter(|problem| problem.code == "stray-operand") {
            assert_eq!(problem.fixes.len(), 1, "{drawing}{problem:?}");
            edits.extend(problem.fixes[0].edits.clone());
        }
        let redrawn = TextEdit::apply_all(&edits, drawing);
        assert_eq!(redrawn, expected);
        let again = parse(&redrawn, fx()).problems;
        assert!(again.is_empty(), "{redrawn}{again:?}");
    }
    let titles: Vec<String> = parse("|--%QX0.0----%IX0.1---|\n|--a----b---|\n", Target::of(Model::Iec))
        .problems
        .iter()
        .flat_map(|problem| &problem.fixes)
        .map(|fix| fix.title.render(Language::English))
        .collect();
    let expected = ["contact `[%QX0.0]`", "contact `[%IX0.1]`", "contact `[a]`", "contact `[b]`"];
    assert_eq!(titles, expected.map(|words| format!("Draw the {words}")));
}

#[test]
fn a_bar_behind_names_is_the_right_rail_in_any_column() {
    let straight = "|   X0          Y0      |\n+---| |---------( )-----+\n";
    for names in ["|   X0          Y0 |", "|   X0         Y0 |", "|   X0          Y0             |"] {
        let drawing = format!("{names}\n+---| |---------( )-----+\n");
        assert_eq!(logic(&drawing), logic(straight), "{drawing}");
        assert!(parse(&drawing, fx()).problems.is_empty(), "{drawing}");
    }
    // Between the elements it could be anything, were there no names before it.
    let drawing = "\
|   X0    Y0 |
+---| |---------( )-----+
|   X1 |
+---| |---------(Y1)----+
";
    let bars = |drawing: &str| -> Vec<(&'static str, u32)> {
        let found = parse(drawing, fx()).problems;
        let bars = found.iter().filter(|found| found.span.of(drawing) == "|");
        bars.map(|found| (found.message.key(), found.span.start)).collect()
    };
    assert_eq!(bars(drawing), [("ragged-drawing.right-rail", 13), ("ragged-drawing.right-rail", 48)]);
    assert!(logic(drawing).contains("kind: Y, number: 0"), "{}", logic(drawing));
    for finding in found(drawing).iter().filter(|finding| finding.code == "ragged-drawing") {
        let redrawn = fixed(drawing, finding).pop().expect("a fix");
        assert_eq!(logic(&redrawn), logic(drawing));
    }
    // Two bars, a bar before a name, no rail beside the names, or no names: these have no reading.
    for drawing in [
        "|   X0     |   |\n+---| |---------(Y0)----+\n",
        "|   X0     |   Z\n+---| |---------(Y0)----+\n",
        "|   X0     |\n+---| |---------(Y0)----\n",
        "|          |\n+---[X0]--------(Y0)----+\n",
    ] {
        assert!(bars(drawing).iter().all(|(key, _)| *key != "ragged-drawing.right-rail"), "{drawing}");
    }
}

#[test]
fn the_vertical_wire_below_a_comparison_in_parallel_ends_no_rung() {
    let drawing = "\
+--[<> K0 K0]------+---->>P10
|                  |
+--[D0 = K0]-------+
|                  |
+--[>= D1 K0]------+
";
    assert_eq!(split(drawing), [drawing.len()]);
    let tree = parse(drawing, fx());
    assert!(tree.problems.is_empty(), "{:?}", tree.problems);
    assert_eq!(tree.rungs.len(), 1);
    // Behind an instruction the corner is the rail.
    let two = "\
+--[X0]--[MOV K0 D0]------+
|                         |
+--[X1]--[MOV K0 D1]------+
";
    assert_eq!(split(two).len(), 2);
}
