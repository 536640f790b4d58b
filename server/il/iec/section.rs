//! The place for one more declaration at the end of a section of variables.

use crate::text::Span;

/// What stands before the END_VAR of a section.
pub enum SectionEnd<'t> {
    /// It stands alone in its line, which starts at this byte, behind this line that is not blank.
    Alone(usize, &'t str),
    /// It starts at this byte, behind something else in its line.
    Behind(usize),
}

/// Where the section at `section` of `text` ends; nothing if its END_VAR is missing.
pub fn section_end(text: &str, section: Span) -> Option<SectionEnd<'_>> {
    let end = (section.end as usize).checked_sub("END_VAR".len())?;
    if !text.get(end..)?.get(.."END_VAR".len())?.eq_ignore_ascii_case("END_VAR") {
        return None;
    }
    let line = text.get(..end)?.rfind('\n').map_or(0, |newline| newline + 1);
    if !text.get(line..end)?.trim().is_empty() {
        return Some(SectionEnd::Behind(end));
    }
    let before = text.get(..line)?.trim_end().rsplit('\n').next().unwrap_or("");
    Some(SectionEnd::Alone(line, before))
}

impl SectionEnd<'_> {
    /// The margin of declarations that end in the line `before` END_VAR.
    pub fn margin(before: &str) -> &str {
        match &before[..before.len() - before.trim_start().len()] {
            "" => "    ",
            margin => margin,
        }
    }
}
