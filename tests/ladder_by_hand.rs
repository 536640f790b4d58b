//! Drawings by hand: lines and names that miss each other by a column or two are read as everybody reads them, or
//! both readings are shown; and the dialects in which people draw.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::ladder::{TWO_READINGS, parse};
use rungwise::target::{Model, Target};
use rungwise::text::Diagnostic;

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
    line: usize,
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
        all.push(Moved { what, drawing: text(&grid), line });
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
fn what_is_off_by_two_columns_is_read_as_the_straight_drawing_or_in_two_ways() {
    let mut failures = Vec::new();
    let (mut same, mut asked) = (0, 0);
    for straight in STRAIGHT.iter().map(|drawing| drawing.trim_start_matches('\n')) {
        let wanted = logic(straight);
        assert!(!wanted.contains("loose"), "{straight}{wanted}");
        assert!(parse(straight, fx()).problems.is_empty(), "{straight}");
        for moved in moved(straight) {
            let found = found(&moved.drawing);
            let codes: Vec<String> =
                found.iter().map(|f| format!("{} {}", f.code, f.message.key())).collect();
            let two = found.iter().find(|finding| finding.message.key() == TWO_READINGS);
            let ok = match two {
                Some(two) => {
                    asked += 1;
                    let line = moved.drawing[..two.span.start as usize].matches('\n').count();
                    two.related.len() >= 2 && line.abs_diff(moved.line) <= 1
                }
                None => {
                    same += 1;
                    let mild = |finding: &Diagnostic| finding.code.starts_with("ragged");
                    logic(&moved.drawing) == wanted && found.iter().all(mild)
                }
            };
            if !ok {
                failures.push(format!(
                    "{}\n{}{}\n{codes:?}\n",
                    moved.what,
                    moved.drawing,
                    logic(&moved.drawing)
                ));
            }
        }
    }
    assert!(failures.is_empty(), "{} of {}\n{}", failures.len(), same + asked, failures.join("\n"));
}
