//! Mending: rows that a paste or a deletion has pushed out of line are aligned again.
//!
//! A row is too long or too short by some cells, and the run of wire or blank where they belong is not known. So every
//! run is tried; the best are those with which vertical wires meet and names stand over their elements. What they
//! make must read without a problem and, if there are several, all as the same logic. A rung that reads in one way
//! as it is (with lines a column or two aside) is drawn again instead.

use super::assemble::Plan;
use super::cells::{self, Row, is_upright, is_wire, is_word};
use super::look::{Look, most_common};
use super::proof::keeps_words;
use super::site::{Site, byte_of_column, line_start};
use super::{Edited, prove};
use crate::ide::Style;
use crate::ide::changes;
use crate::ladder::reduce::reduce;
use crate::ladder::{LadderTree, Strokes, parse};
use crate::text::{Message, Span, TextEdit};

/// Rungs with more rows are not aligned row by row: the way back costs the square of their number.
const ROWS_MAX: usize = 200;

/// How many half-mended rungs are kept while going down the rows.
const KEPT: usize = 12;

/// Whether the rows of a rung end in different columns, or lines in it miss each other.
pub(super) fn is_ragged(site: &Site<'_>) -> bool {
    let found = site.problems().any(|problem| matches!(problem.code, "ragged-drawing" | "ragged-rail"));
    let rows: Option<Vec<Row>> =
        site.lines().of(site.text).lines().map(|line| cells::row(line.trim_end())).collect();
    let ends = rows.iter().flatten().filter_map(rail_of).collect::<Vec<_>>();
    found || ends.windows(2).any(|pair| pair[0] != pair[1])
}

/// The column of the rail at the end of a row.
fn rail_of(row: &Row) -> Option<usize> {
    let last = *row.last()?;
    (row.len() > 1 && is_upright(last)).then(|| row.len() - 1)
}

/// The block of lines around a byte of a chunk, as lines of the chunk: the rung, with rows that a break has parted
/// from it.
fn block(site: &Site<'_>, line: u32) -> (u32, u32) {
    let is_open = |number: u32| {
        let (start, end) = (site.line_start(number), site.line_start(number + 1));
        let covers = |span: &Span| (span.start as usize) < end && start < span.end as usize;
        let header = site.tree.header.as_ref().is_some_and(|header| covers(&header.span));
        !site.line(number).trim().is_empty() && !header && !site.tree.comments.iter().any(covers)
    };
    let count = site.text.lines().count() as u32;
    let first = (0..line).rev().take_while(|number| is_open(*number)).last().unwrap_or(line);
    let end = (line..count).take_while(|number| is_open(*number)).last().map_or(line + 1, |last| last + 1);
    (first, end)
}

/// The edits that align the rung at `span` again; none if it is aligned.
///
/// # Errors
/// Where it could be aligned in ways that read differently.
pub(super) fn mend(site: &Site<'_>, span: Span, style: Style) -> Result<Edited, Message> {
    let offset = (span.start as usize).saturating_sub(site.start).min(site.text.len());
    let aligned = aligned(site, site.line_of(offset), site.column(offset));
    if let Some(edits) = aligned {
        let after = TextEdit::apply_all(&edits, site.text);
        let line = site.line_of(offset);
        let from = line_start(&after, line);
        let text = after.get(from..).and_then(|rest| rest.lines().next()).unwrap_or("");
        let cursor = site.start + from + byte_of_column(text, site.column(offset));
        let edits = edits.iter().map(|edit| edit.shifted(site.start)).collect();
        return Ok(Edited { edits, selection: Span::at(cursor) });
    }
    // What else may be wrong with it is not a matter of columns.
    if !is_ragged(site) {
        return Ok(Edited { edits: Vec::new(), selection: span });
    }
    redrawn(site, span, style).ok_or_else(|| Message::new("edit.ragged"))
}

/// The rung drawn again as it reads.
fn redrawn(site: &Site<'_>, span: Span, style: Style) -> Option<Edited> {
    let lines = site.lines();
    let two = |key: &str| key == "ragged-drawing.two";
    let aside = |code: &str| matches!(code, "ragged-drawing" | "ragged-rail" | "tab-in-drawing");
    if !site.problems().all(|problem| aside(problem.code) && !two(problem.message.key())) {
        return None;
    }
    let shape = reduce(&site.rung.graph).ok()?;
    let plan = Plan { shape, elements: site.rung.graph.elements.clone() };
    let drawn = Look::of(site, style.ladder().kind).draw(&plan, site.text, site).ok()?;
    let proved = keeps_words(site, &[], &drawn)
        .then(|| prove(site, lines.shifted(site.start), &drawn, &site.rung.graph, site.text))??;
    let selection = super::same_place(site, &proved, span.start as usize);
    Some(Edited { edits: proved.edits(), selection })
}

/// The edits, in bytes of the chunk, that align the rows around a line; nothing if none do, or differing ones.
fn aligned(site: &Site<'_>, line: u32, column: u32) -> Option<Vec<TextEdit>> {
    let (first, end) = block(site, line);
    let cursor = Some((line - first, column));
    if (end - first) as usize > ROWS_MAX {
        return None;
    }
    let lines: Vec<&str> = (first..end).map(|number| site.line(number)).collect();
    let rows: Vec<Row> = lines.iter().map(|line| cells::row(line.trim_end())).collect::<Option<_>>()?;
    let rail = common_rail(&rows)?;
    if rows.iter().filter_map(rail_of).all(|own| own == rail) {
        return None;
    }
    let mut kept: Vec<(usize, Vec<Row>)> = vec![(0, Vec::new())];
    for (number, row) in rows.iter().enumerate() {
        let own_cursor =
            cursor.filter(|(line, _)| *line as usize == number).map(|(_, column)| column as usize);
        let choices = fitted(row, rail, own_cursor);
        let below = rows.get(number + 1).filter(|below| rail_of(below) == Some(rail));
        let mut grown = Vec::new();
        for (cost, done) in &kept {
            for (doubt, choice) in &choices {
                let above = done.last().map_or(0, |above| misfit(above, choice));
                let under = below.map_or(0, |below| misfit(choice, below));
                let mut rows = done.clone();
                rows.push(choice.clone());
                grown.push((cost + doubt + above + under, rows));
            }
        }
        grown.sort_by_key(|(cost, _)| *cost);
        grown.dedup_by(|left, right| left.1 == right.1);
        grown.truncate(KEPT);
        kept = grown;
    }
    let best = kept.first()?.0;
    let target = site.document.target();
    let mut found: Option<(Vec<Row>, String, LadderTree)> = None;
    for (_, rows) in kept.into_iter().filter(|(cost, _)| *cost == best) {
        let text = replaced(site, (first, end), &rows);
        let tree = parse(&text, target);
        let healthy = tree.problems.is_empty() && tree.comments.len() == site.tree.comments.len();
        if !healthy {
            continue;
        }
        match &found {
            None => found = Some((rows, text, tree)),
            Some((_, other_text, other)) if !same_logic((other_text, other), (&text, &tree)) => return None,
            Some(_) => {}
        }
    }
    let (rows, ..) = found?;
    let edits = rows.iter().zip(first..).filter_map(|(row, number)| {
        let start = site.line_start(number);
        changes::smallest(site.line(number), &cells::text(row), start)
    });
    Some(edits.collect())
}

fn same_logic((left_text, left): (&str, &LadderTree), (right_text, right): (&str, &LadderTree)) -> bool {
    left.rungs.len() == right.rungs.len()
        && left
            .rungs
            .iter()
            .zip(&right.rungs)
            .all(|(left, right)| left.graph.same_logic(left_text, &right.graph, right_text))
}

/// The chunk with other rows in the place of some lines.
fn replaced(site: &Site<'_>, (first, end): (u32, u32), rows: &[Row]) -> String {
    let text = site.text;
    let mut result = text.get(..site.line_start(first)).unwrap_or("").to_string();
    for (row, number) in rows.iter().zip(first..) {
        let line = text.get(site.line_start(number)..site.line_start(number + 1)).unwrap_or("");
        result.push_str(&cells::text(row));
        result.push_str(&line[line.trim_end_matches(['\n', '\r']).len()..]);
    }
    result.push_str(text.get(site.line_start(end)..).unwrap_or(""));
    result
}

/// The column in which most rows have their right rail; of several the rightmost, since cells are lost more often.
fn common_rail(rows: &[Row]) -> Option<usize> {
    most_common(rows.iter().filter_map(rail_of).collect())
}

/// The ways to bring a row's rail to a column, each with what speaks against it; the row as it is if it has none, or
/// has it there. Where the cursor is, in a column of this row, cells were lost or added most likely.
fn fitted(row: &Row, rail: usize, cursor: Option<usize>) -> Vec<(usize, Row)> {
    let Some(own) = rail_of(row).filter(|own| *own != rail) else { return vec![(0, row.clone())] };
    let mut ways = Vec::new();
    let fills = |cell: char| cell == ' ' || is_wire(cell);
    let mut column = 0;
    while column < row.len() {
        let end = (column..row.len()).find(|at| row[*at] != row[column]).unwrap_or(row.len());
        let mut changed = row.clone();
        let doubt = 2 * usize::from(!cursor.is_some_and(|cursor| (column..=end).contains(&cursor)));
        // What stands before the left rail can go altogether.
        let surplus = if column == 0 && row[0] == ' ' { end + 1 } else { end - column };
        if cells::is_within(row, column) {
            column = end;
            continue;
        }
        if fills(row[column]) && own < rail {
            changed.splice(column..column, std::iter::repeat_n(row[column], rail - own));
            ways.push((doubt, changed));
        } else if fills(row[column]) && surplus > own - rail {
            cells::remove(&mut changed, column, own - rail);
            ways.push((doubt, changed));
        }
        column = end.max(column + 1);
    }
    ways
}

/// How badly two rows fit under each other: lines that lead to nothing, names beside their elements.
fn misfit(above: &Row, below: &Row) -> usize {
    let at = |row: &Row, column: usize| row.get(column).copied().unwrap_or(' ');
    let mut misfit = 0;
    for column in 0..above.len().max(below.len()) {
        let (upper, lower) = (at(above, column), at(below, column));
        // A bar of a contact leads nowhere, and so costs the same wherever it stands.
        if Strokes::of(upper).down != Strokes::of(lower).up {
            misfit += 8;
        }
    }
    misfit + beside(above, below)
}

/// Four times the cells by which the words of a row stand beside the middle of what is below them. A name that cannot
/// stand over the very middle stands to its left where it is drawn anew, so the other side costs more than any doubt.
fn beside(above: &Row, below: &Row) -> usize {
    let mut cost = 0;
    let mut column = 0;
    while column < above.len() {
        if !is_word(above[column]) {
            column += 1;
            continue;
        }
        let end = (column..above.len()).find(|at| !is_word(above[*at])).unwrap_or(above.len());
        let middle = column + end - 1;
        let near = (column.saturating_sub(2)..end + 2).filter(|at| is_body(below, *at)).collect::<Vec<_>>();
        cost += match (near.first(), near.last()) {
            (Some(first), Some(last)) => {
                2 * middle.abs_diff(first + last) + 3 * usize::from(middle > first + last)
            }
            _ => 12,
        };
        column = end;
    }
    cost
}

/// Whether a cell is an edge of an element: a bracket or a bar. Rails and junctions are none, however near.
fn is_body(row: &Row, column: usize) -> bool {
    let Some(cell) = row.get(column).copied() else { return false };
    let Strokes { left, right, up, down } = Strokes::of(cell);
    let is_bar = up && down && !(left && right) && column > 0 && column + 1 < row.len();
    is_bar || matches!(cell, '(' | ')' | '[' | ']')
}
