//! What formatting would change, as a unified diff.

use super::colour::Colour;
use similar::{ChangeTag, TextDiff};
use std::fmt::Write;

/// What stands behind a line without a line feed, in every language.
const NO_LINE_FEED: &str = "\\ No newline at end of file\n";

/// The diff from `old` to `new`, both named, which `patch` understands, with three lines of context. A line that ends
/// without a line feed is followed by the remark that says so.
pub(super) fn unified([from, to]: [&str; 2], old: &str, new: &str, colour: Colour) -> String {
    let paint = |code: &'static str| if colour.on() { code } else { "" };
    let (bold, cyan, red, green, off) =
        (paint("\x1b[1m"), paint("\x1b[36m"), paint("\x1b[31m"), paint("\x1b[32m"), paint("\x1b[0m"));
    let diff = TextDiff::from_lines(old, new);
    let mut text = format!("{bold}--- {from}{off}\n{bold}+++ {to}{off}\n");
    for hunk in diff.unified_diff().context_radius(3).iter_hunks() {
        let _ = writeln!(text, "{cyan}{}{off}", hunk.header());
        for change in hunk.iter_changes() {
            let (sign, begin, end) = match change.tag() {
                ChangeTag::Delete => ('-', red, off),
                ChangeTag::Insert => ('+', green, off),
                ChangeTag::Equal => (' ', "", ""),
            };
            let line = change.value();
            let content = line.strip_suffix('\n').unwrap_or(line);
            let _ = writeln!(text, "{begin}{sign}{content}{end}");
            if change.missing_newline() {
                text.push_str(NO_LINE_FEED);
            }
        }
    }
    text
}
