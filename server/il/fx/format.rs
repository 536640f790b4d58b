//! The canonical print of a program.
//!
//! One instruction a line, mnemonic and operands in upper case with one blank between, labels on their own line,
//! everything flush left, comments behind instructions in one column for each rung, no two blank lines in a row and
//! none at the end. A comment on its own line loses its indentation. Line ends stay what they are.
//!
//! Lines with something unreadable stay as they are, and so do lines with a comment before or inside the
//! instruction: any other place for it would be a guess.
//!
//! Step numbers stay as written, in one column, unless every instruction of the program has one: then they come
//! from a listing, and are counted anew, because the ones behind an edit no longer fit.

use super::{FxLine, FxTree, LineKind, parse, split, steps};
use crate::target::{Model, Operand, Target};
use crate::text::{Span, TextEdit, text_width};
use std::ops::Range;

/// How one chunk is printed; these depend on the program that it is part of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FormatOptions {
    /// The chunk's first program step if step numbers are counted anew; `None` leaves them as they are.
    pub first_step: Option<u32>,
    /// Columns of the longest step number, to which the others are aligned; 0 without step numbers.
    pub step_width: usize,
    /// The line end where the chunk itself has none.
    pub newline: &'static str,
}

impl Default for FormatOptions {
    fn default() -> FormatOptions {
        FormatOptions { first_step: None, step_width: 0, newline: "\n" }
    }
}

/// The edits that print `text` canonically; none if it is so already. Formatting the result changes nothing.
pub fn format(text: &str, target: &Target) -> Vec<TextEdit> {
    let mut start = 0;
    let chunks: Vec<(&str, FxTree)> = split(text)
        .into_iter()
        .map(|end| {
            let chunk = &text[start..end];
            start = end;
            (chunk, parse(chunk, target))
        })
        .collect();
    let chunks: Vec<(&str, &FxTree)> = chunks.iter().map(|(chunk, tree)| (*chunk, tree)).collect();
    format_chunks(&chunks)
}

/// As [`format`](format()), for a program that has been split and parsed; the spans count from the first chunk.
pub fn format_chunks(chunks: &[(&str, &FxTree)]) -> Vec<TextEdit> {
    let mut options = program_options(chunks);
    let mut edits = Vec::new();
    let mut start = 0;
    for (chunk, tree) in chunks {
        edits.extend(chunk_edits(chunk, tree, &options).iter().map(|edit| edit.shifted(start)));
        options.first_step = options.first_step.map(|step| step.saturating_add(steps(tree)));
        start += chunk.len();
    }
    edits
}

/// One chunk in canonical print.
pub fn format_chunk(chunk: &str, tree: &FxTree, options: &FormatOptions) -> String {
    TextEdit::apply_all(&chunk_edits(chunk, tree, options), chunk)
}

fn program_options(chunks: &[(&str, &FxTree)]) -> FormatOptions {
    let mut options = FormatOptions::default();
    let lines = || chunks.iter().flat_map(|(_, tree)| tree.lines.iter().map(move |line| (*tree, line)));
    let is_listing = chunks.iter().all(|(_, tree)| tree.problems.is_empty())
        && lines().all(|(tree, line)| line.step.is_some() && is_readable(tree, line));
    let largest = if is_listing {
        options.first_step = Some(0);
        chunks.iter().map(|(_, tree)| steps(tree)).sum()
    } else {
        lines().filter_map(|(_, line)| line.step).map(|step| step.value).max().unwrap_or(0)
    };
    if lines().any(|(_, line)| line.step.is_some()) {
        options.step_width = largest.to_string().len();
    }
    if chunks.iter().any(|(chunk, _)| chunk.contains("\r\n")) {
        options.newline = "\r\n";
    }
    options
}

fn is_readable(tree: &FxTree, line: &FxLine) -> bool {
    let is_invalid = |operand: &Operand| matches!(operand, Operand::Invalid(_));
    line.kind != LineKind::Unknown && !tree.operands(line).iter().any(|operand| is_invalid(&operand.value))
}

/// A line of the text; one that a comment continues is one line.
struct Segment {
    /// Without the line end.
    content: Span,
    /// The line end; empty at the end of the text.
    newline: Span,
    /// Indices into [`FxTree::lines`].
    lines: Range<usize>,
    /// Indices into [`FxTree::comments`].
    comments: Range<usize>,
    print: Print,
}

/// How a segment is printed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Print {
    Blank,
    Verbatim,
    Comments,
    Instruction,
}

fn chunk_edits(chunk: &str, tree: &FxTree, options: &FormatOptions) -> Vec<TextEdit> {
    let segments = segments(chunk, tree);
    let used = segments.iter().rposition(|segment| segment.print != Print::Blank).map_or(0, |last| last + 1);
    let chunk_newline = segments.first().map_or("", |segment| segment.newline.of(chunk));
    let default_newline = if chunk_newline.is_empty() { options.newline } else { chunk_newline };
    let mut printer = Printer { chunk, tree, options, next_step: options.first_step, column: 0 };
    printer.column = printer.comment_column(&segments);
    let mut edits = Vec::new();
    let mut was_blank = false;
    for (place, segment) in segments.iter().enumerate() {
        let newline = match segment.newline.of(chunk) {
            "" => default_newline,
            newline => newline,
        };
        let printed = match segment.print {
            Print::Blank if place >= used || was_blank => String::new(),
            Print::Blank => newline.to_string(),
            Print::Verbatim => segment.content.to(segment.newline).of(chunk).to_string(),
            Print::Comments => format!("{}{newline}", printer.comments(segment)),
            Print::Instruction => printer.instruction(segment, newline),
        };
        printer.count(segment);
        was_blank = segment.print == Print::Blank;
        // A byte order mark is the first character of a file and stays there.
        let whole = segment.content.to(segment.newline);
        let mark = if place == 0 && whole.of(chunk).starts_with('\u{feff}') { "\u{feff}" } else { "" };
        let body = Span::new(whole.start as usize + mark.len(), whole.end as usize);
        let printed = printed.strip_prefix(mark).unwrap_or(&printed);
        if printed != body.of(chunk) {
            edits.push(TextEdit::new(body, printed));
        }
    }
    edits
}

fn segments(chunk: &str, tree: &FxTree) -> Vec<Segment> {
    let mut problems: Vec<usize> = tree.problems.iter().map(|problem| problem.span.start as usize).collect();
    problems.sort_unstable();
    let mut segments = Vec::new();
    let (mut start, mut line, mut comment, mut problem) = (0, 0, 0, 0);
    while start < chunk.len() {
        let (first_line, first_comment, first_problem) = (line, comment, problem);
        let mut end = start;
        loop {
            end += chunk[end..].find(['\n', '\r']).unwrap_or(chunk.len() - end);
            while tree.comments.get(comment).is_some_and(|comment| (comment.start as usize) < end) {
                comment += 1;
            }
            // A line end inside of a comment does not count: go on behind it.
            match tree.comments[..comment].last() {
                Some(last) if last.end as usize > end => end = last.end as usize,
                _ => break,
            }
        }
        let newline = match &chunk.as_bytes()[end..] {
            [b'\r', b'\n', ..] => 2,
            [] => 0,
            _ => 1,
        };
        while tree.lines.get(line).is_some_and(|line| (line.span.start as usize) < end) {
            line += 1;
        }
        while problems.get(problem).is_some_and(|start| *start < end) {
            problem += 1;
        }
        let mut segment = Segment {
            content: Span::new(start, end),
            newline: Span::new(end, end + newline),
            lines: first_line..line,
            comments: first_comment..comment,
            print: Print::Verbatim,
        };
        if first_problem == problem {
            segment.print = print_of(&segment, chunk, tree);
        }
        segments.push(segment);
        start = end + newline;
    }
    segments
}

/// How a segment without problems is printed.
fn print_of(segment: &Segment, chunk: &str, tree: &FxTree) -> Print {
    let lines = &tree.lines[segment.lines.clone()];
    let comments = &tree.comments[segment.comments.clone()];
    let Some(last) = lines.last() else {
        let is_blank = segment.content.of(chunk).chars().all(|c| matches!(c, ' ' | '\t' | '\u{feff}'));
        return match comments {
            [] if is_blank => Print::Blank,
            [] => Print::Verbatim,
            _ => Print::Comments,
        };
    };
    let is_behind =
        |comment: &Span| comment.start >= last.span.end && !comment.of(chunk).contains(['\n', '\r']);
    if lines.iter().all(|line| is_readable(tree, line)) && comments.iter().all(is_behind) {
        Print::Instruction
    } else {
        Print::Verbatim
    }
}

struct Printer<'a> {
    chunk: &'a str,
    tree: &'a FxTree,
    options: &'a FormatOptions,
    /// The step of the next instruction if they are counted anew.
    next_step: Option<u32>,
    /// The column of comments behind instructions.
    column: usize,
}

impl Printer<'_> {
    /// One column behind the widest instruction that a comment follows.
    fn comment_column(&self, segments: &[Segment]) -> usize {
        let commented = segments
            .iter()
            .filter(|segment| segment.print == Print::Instruction && !segment.comments.is_empty())
            .filter_map(|segment| self.tree.lines[segment.lines.clone()].last());
        commented.map(|line| text_width(&self.row(line, self.next_step)) + 1).max().unwrap_or(0)
    }

    /// Goes on by the steps of a segment.
    fn count(&mut self, segment: &Segment) {
        for line in &self.tree.lines[segment.lines.clone()] {
            self.next_step = self.next_step.map(|step| step.saturating_add(self.tree.steps_of(line)));
        }
    }

    fn instruction(&self, segment: &Segment, newline: &str) -> String {
        let mut printed = String::new();
        let mut step = self.next_step;
        let lines = &self.tree.lines[segment.lines.clone()];
        for (place, line) in lines.iter().enumerate() {
            let row = self.row(line, step);
            step = step.map(|step| step.saturating_add(self.tree.steps_of(line)));
            printed.push_str(&row);
            if place + 1 == lines.len() && !segment.comments.is_empty() {
                let gap = self.column.saturating_sub(text_width(&row)).max(1);
                printed.extend(std::iter::repeat_n(' ', gap));
                printed.push_str(&self.comments(segment));
            }
            printed.push_str(newline);
        }
        printed
    }

    /// The instruction or label without comments.
    fn row(&self, line: &FxLine, counted: Option<u32>) -> String {
        let mut row = String::new();
        if let Some(step) = line.step {
            let number = counted.unwrap_or(step.value);
            row = format!("{number:>width$} ", width = self.options.step_width);
        }
        let mnemonic = line.mnemonic.of(self.chunk).chars().filter(|c| !matches!(c, ' ' | '\t' | '\u{feff}'));
        row.extend(mnemonic.map(|character| character.to_ascii_uppercase()));
        for operand in self.tree.operands(line) {
            row.push(' ');
            let word = operand.span.of(self.chunk);
            match operand.value {
                Operand::Text => row.push_str(word),
                // A symbol keeps the letters that the project gave it.
                operand if operand != Operand::read(word, Model::Fx3u) => row.push_str(word),
                _ => row.push_str(&word.to_ascii_uppercase()),
            }
        }
        row
    }

    fn comments(&self, segment: &Segment) -> String {
        let comments = &self.tree.comments[segment.comments.clone()];
        let texts: Vec<&str> = comments.iter().map(|comment| comment.of(self.chunk).trim_end()).collect();
        texts.join(" ")
    }
}
