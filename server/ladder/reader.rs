//! Reads a chunk: lines, grid, tokens, wires, names, and from these the graph of each rung.

use super::beside::take_beside;
use super::blocks::find_blocks;
use super::chunks::{ChunkKind, kind_of};
use super::frame::take_frame;
use super::glyph::Arms;
use super::grid::{Grid, MOST_COLUMNS, MOST_ROWS};
use super::inline::{give_inline, take_inline};
use super::ldmicro::find_boxes;
use super::lines::{HeaderLine, LineKind, Lines, OpenComment};
use super::names::{Named, Naming};
use super::rungs::build_rungs;
use super::scan::{Scanner, Token, Tokens, What};
use super::uprights::Uprights;
use super::wires::Tracer;
use super::{LadderTree, NameHabit, NetworkHeader};
use crate::target::Target;
use crate::text::{Diagnostic, Message, Span, Spanned, TextEdit};
use std::cell::OnceCell;

/// Reads one chunk as [`split`](super::split) cuts it. Never fails: what cannot be read is in
/// [`LadderTree::problems`], all spans are offsets into `chunk`. Declarations have no rungs.
///
/// The time is linear in the displayed cells. Blocks with more than 5,000 lines, or with a line of more than 10,000
/// cells, are reported as `rung-too-large` and not read.
pub fn parse(chunk: &str, target: &Target) -> LadderTree {
    parse_with(chunk, target, NameHabit::default())
}

/// As [`parse`], with the document's habit of placing names above or below, which decides in a drawing that shows
/// none of its own.
pub fn parse_with(chunk: &str, target: &Target, habit: NameHabit) -> LadderTree {
    read(chunk, target, habit, None)
}

/// Which of two readings is meant, see [`TWO_READINGS`](super::TWO_READINGS).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Choice {
    /// The end that can be joined in two ways: where the problem was reported.
    pub end: Span,
    /// What it is to be joined with: one of the problem's related places.
    pub joint: Span,
}

/// As [`parse_with`], with one doubt decided.
pub fn parse_choosing(chunk: &str, target: &Target, habit: NameHabit, choice: Choice) -> LadderTree {
    read(chunk, target, habit, Some(choice))
}

fn read(chunk: &str, target: &Target, habit: NameHabit, choice: Option<Choice>) -> LadderTree {
    let mut tree = LadderTree::default();
    let is_drawing = !matches!(kind_of(chunk), ChunkKind::Declarations | ChunkKind::Ldmicro);
    let mut grid = Grid::default();
    let mut drawing: Option<Span> = None;
    let mut too_large = false;
    let mut lines = Lines::new(chunk);
    for (number, line) in lines.by_ref().enumerate() {
        add_comments(&mut tree.comments, &line.comments, line.continues);
        if is_drawing {
            match line.kind(chunk) {
                LineKind::Header(header) => add_header(&mut tree.header, &header, chunk),
                LineKind::Blank | LineKind::Comment => {}
                _ => drawing = Some(drawing.map_or(line.span, |drawing| drawing.to(line.span))),
            }
            too_large |= grid.height() >= MOST_ROWS || line.span.len() > MOST_COLUMNS * 4;
            if drawing.is_some() && !too_large && !line.railed {
                grid.push(&line, number as u32, chunk);
                too_large |= grid.width(grid.height() - 1) > MOST_COLUMNS;
            }
        }
    }
    report_unclosed(lines.open, chunk, &mut tree.problems);
    match drawing {
        Some(span) if too_large => {
            let message =
                Message::new("rung-too-large.grid").with("rows", MOST_ROWS).with("columns", MOST_COLUMNS);
            tree.problems.push(Diagnostic::new("rung-too-large", span, message));
        }
        Some(_) => read_drawing(grid, chunk, target, (habit, choice), &mut tree),
        None => {}
    }
    tree.problems.sort_by_key(|problem| problem.span);
    tree
}

fn read_drawing(
    mut grid: Grid,
    text: &str,
    target: &Target,
    (habit, choice): (NameHabit, Option<Choice>),
    tree: &mut LadderTree,
) {
    take_beside(&mut grid, &mut tree.problems);
    let captions = take_frame(&mut grid);
    for row in captions {
        grid.clear(row, 0..usize::MAX);
    }
    let left = left_column(&grid);
    let (mut symbols, mut blocks) = find_blocks(&mut grid, text, target);
    find_boxes(&mut grid, text, target, &mut symbols, &mut blocks);
    let inline = take_inline(&mut grid);
    let problems = &mut tree.problems;
    let right = OnceCell::new();
    let scanner = Scanner { grid: &grid, text, target, left, right, symbols, problems };
    let mut tokens = scanner.scan(&blocks);
    give_inline(&inline, &mut tokens, target, text);
    let wired = |what| matches!(what, What::Wire | What::Symbol(_));
    if !tokens.rows.iter().flatten().any(|token| wired(token.what)) {
        report_text(&grid, &tokens, problems);
        return;
    }
    let uprights = Uprights::find(&grid, &tokens, left, choice, problems);
    uprights.report(&grid, &tokens, problems);
    let wiring = Tracer::new(&grid, &tokens, &uprights, problems).trace();
    let naming = Naming { grid: &grid, text, target, tokens: &mut tokens, left, problems };
    let Named { habit, rows } = naming.run(habit);
    tree.names = habit;
    tree.rungs = build_rungs(&grid, text, tokens, &uprights, &wiring, &rows, left);
}

/// The leftmost column in which a line or an element is drawn; a number in the margin is passed over.
fn left_column(grid: &Grid) -> usize {
    let first = |row: usize| {
        let column = grid.find(row, 0, |character| character != ' ' && !character.is_ascii_digit())?;
        let character = grid.at(row, column);
        let drawn = Arms::of(character).is_line() || matches!(character, '[' | ']' | '(' | ')');
        drawn.then_some(column)
    };
    (0..grid.height()).filter_map(first).min().unwrap_or(0)
}

/// Lines of text without any drawing.
fn report_text(grid: &Grid, tokens: &Tokens, problems: &mut Vec<Diagnostic>) {
    let has_word = |line: &[Token]| line.iter().any(|token| token.what == What::Word);
    let rows = (0..grid.height()).filter(|row| has_word(&tokens.rows[*row]));
    let lines: Vec<Span> = rows.filter_map(|row| grid.content(row)).collect();
    // One finding for a line, not one more for each of its characters.
    problems.retain(|problem| {
        let line = lines.partition_point(|line| line.end <= problem.span.start);
        lines.get(line).is_none_or(|line| problem.span.end <= line.start)
    });
    let text = |span: &Span| Diagnostic::new("unreadable-cell", *span, Message::new("unreadable-cell.text"));
    problems.extend(lines.iter().map(text));
}

fn report_unclosed(open: Option<OpenComment>, text: &str, problems: &mut Vec<Diagnostic>) {
    let Some(open) = open else { return };
    let start = open.start();
    let (length, close) = match open {
        OpenComment::Comment(_) => (2, " *)"),
        OpenComment::Pragma(_) => (1, " }"),
    };
    let line_end = text[start..].find(['\n', '\r']).map_or(text.len(), |end| start + end);
    let message = Message::new("unclosed-comment.comment").with("close", close.trim());
    let fix = Message::new("unclosed-comment.close").with("close", close.trim());
    let problem = Diagnostic::new("unclosed-comment", Span::new(start, start + length), message);
    problems.push(problem.fix(fix, vec![TextEdit::new(Span::at(line_end), close)]));
}

/// Adds the comments of a line; a comment that goes on from the line above is one with its beginning.
fn add_comments(comments: &mut Vec<Span>, line: &[Span], continues: bool) {
    let mut line = line.iter();
    if continues && let (Some(open), Some(rest)) = (comments.last_mut(), line.next()) {
        open.end = rest.end;
    }
    comments.extend(line);
}

fn add_header(header: &mut Option<NetworkHeader>, line: &HeaderLine, text: &str) {
    let number =
        line.number.and_then(|span| span.of(text).parse().ok().map(|value| Spanned::new(value, span)));
    let header =
        header.get_or_insert(NetworkHeader { span: line.span, number: None, title: None, label: None });
    header.span = header.span.to(line.span);
    header.number = header.number.or(number);
    header.title = header.title.or(line.title);
    header.label = header.label.or(line.label);
}
