//! Programs in the fences of a Markdown text: each is a document of its own.

use super::Notation;
use std::ops::Range;

/// A fence with a program in it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fence {
    /// Ladder, or Instruction List of a dialect that its content tells.
    pub is_ladder: bool,
    /// The bytes between the line that opens it and the line that closes it.
    pub content: Range<usize>,
    /// Lines before its content.
    pub lines_before: usize,
    /// Lines of its content.
    pub lines: usize,
    /// Whether the fence is indented, as in a list: its lines begin with blanks that belong to the list.
    pub is_indented: bool,
}

impl Fence {
    /// The content at its place: a line end for every line before it, so that lines and columns are those of `text`,
    /// from which the fence was read.
    pub fn isolated(&self, text: &str) -> String {
        let line_end = if text.contains("\r\n") { "\r\n" } else { "\n" };
        let mut isolated = line_end.repeat(self.lines_before);
        isolated.push_str(text.get(self.content.clone()).unwrap_or(""));
        isolated
    }

    /// The name's ending that a file of this content would have, by which its notation is decided.
    pub fn ending(&self) -> &'static str {
        if self.is_ladder { ".lad" } else { ".il" }
    }

    /// The notation, as far as the fence says it.
    pub fn notation(&self) -> Option<Notation> {
        self.is_ladder.then_some(Notation::Ladder)
    }
}

/// The fences of `text` whose info string starts with `ladder`, `lad`, `plc-ladder`, `il` or `plc-il`, top to bottom.
///
/// A fence is three backticks or tildes or more, at any indentation, for a list indents what belongs to an item. It
/// ends at a line of as many of the same or more, or at the end of the text (CommonMark 0.31, 4.5).
pub fn fences(text: &str) -> Vec<Fence> {
    let mut found = Vec::new();
    // The character and length of the open fence, and the program in it, if it is one.
    let mut open: Option<(char, usize, Option<Fence>)> = None;
    let mut offset = 0;
    for (number, line) in text.split_inclusive('\n').enumerate() {
        let start = offset;
        offset += line.len();
        let words = line.trim();
        let (sign, length) = rule_of(words);
        match &mut open {
            None if length >= 3 => {
                let info = words[length..].trim();
                let program = is_ladder(info).filter(|_| sign == '~' || !info.contains('`'));
                let fence = program.map(|is_ladder| Fence {
                    is_ladder,
                    content: offset..offset,
                    lines_before: number + 1,
                    lines: 0,
                    is_indented: line.starts_with([' ', '\t']),
                });
                open = Some((sign, length, fence));
            }
            Some((own, least, fence)) if sign == *own && length >= *least && words.len() == length => {
                found
                    .extend(fence.take().map(|fence| Fence { content: fence.content.start..start, ..fence }));
                open = None;
            }
            Some((_, _, Some(fence))) => fence.lines += 1,
            _ => {}
        }
    }
    if let Some((_, _, Some(fence))) = open {
        found.push(Fence { content: fence.content.start..text.len(), ..fence });
    }
    found
}

/// The run of backticks or tildes at the start of a line.
fn rule_of(words: &str) -> (char, usize) {
    match words.chars().next() {
        Some(sign @ ('`' | '~')) => (sign, words.len() - words.trim_start_matches(sign).len()),
        _ => (' ', 0),
    }
}

fn is_ladder(info: &str) -> Option<bool> {
    let word = info.split([' ', '\t', ',', '{']).next().unwrap_or("").to_ascii_lowercase();
    match word.as_str() {
        "ladder" | "lad" | "plc-ladder" => Some(true),
        "il" | "plc-il" => Some(false),
        _ => None,
    }
}
