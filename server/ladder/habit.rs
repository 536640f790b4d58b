//! What a chunk tells of its document's habit of placing names, told without reading it.

use super::NameHabit;
use super::glyph::Arms;
use super::lines::{LineKind, Lines, is_blank, may_begin_comment};

/// One for names above if the drawing begins with a line of words, one for names below if it ends with one. Both or
/// none leave the chunk in doubt: it is read as most others of its document are.
pub fn habit_of(chunk: &str) -> NameHabit {
    let mut lines = Lines::new(chunk);
    let first = lines.find(|line| line.kind(chunk) == LineKind::Drawing);
    let Some(first) = first else { return NameHabit::default() };
    let bars = |line: &str| line.chars().all(|c| is_blank(c) || Arms::of(c).is_vertical());
    let rest = &chunk[first.next..];
    let last = match lines.open.is_none() && !may_begin_comment(rest.as_bytes()) {
        // Without comments the last line is found from the end.
        true => rest.rsplit(['\n', '\r']).find(|line| !bars(line)),
        false => {
            let drawn = lines.filter(|line| line.comments.is_empty()).map(|line| line.span.of(chunk));
            drawn.filter(|line| !bars(line)).last()
        }
    };
    NameHabit {
        above: u32::from(is_words(first.span.of(chunk))),
        below: u32::from(last.is_some_and(is_words)),
    }
}

/// Whether nothing but words and rails stand in a line.
fn is_words(line: &str) -> bool {
    let mut words = false;
    for character in line.chars() {
        let arms = Arms::of(character);
        let drawn = arms.is_horizontal() && character != '_';
        if drawn || arms.is_junction() || matches!(character, '[' | ']' | '(' | ')' | '{' | '}') {
            return false;
        }
        words |= character.is_alphanumeric();
    }
    words
}
