//! Columns of a line: bytes, UTF-16 units, scalar values, displayed cells.

use unicode_width::UnicodeWidthChar;

/// How a client counts columns (LSP `positionEncodings`).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 code units, the protocol's default.
    #[default]
    Utf16,
    /// Unicode scalar values; also what the command line shows, from 1.
    Utf32,
}

/// A position, both parts from 0, the column counted in some `Encoding`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
pub struct LineColumn {
    /// Line from 0.
    pub line: u32,
    /// Column from 0.
    pub column: u32,
}

/// The column of byte `offset` in `line`; an offset inside a character counts as the character's start.
pub fn column_of_offset(line: &str, offset: usize, encoding: Encoding) -> u32 {
    let mut offset = offset.min(line.len());
    while !line.is_char_boundary(offset) {
        offset -= 1;
    }
    let head = &line[..offset];
    let column = match encoding {
        Encoding::Utf8 => head.len(),
        _ if head.is_ascii() => head.len(),
        Encoding::Utf16 => head.chars().map(char::len_utf16).sum(),
        Encoding::Utf32 => head.chars().count(),
    };
    column as u32
}

/// The line and column of byte `offset` of `text`; lines end with LF, CR LF or CR.
pub fn position_of(text: &str, offset: usize, encoding: Encoding) -> LineColumn {
    let before = text.get(..offset).unwrap_or(text);
    let start = before.rfind(['\n', '\r']).map_or(0, |end| end + 1);
    // A carriage return before a line feed is a part of that line end.
    let ends = before.bytes().zip(before.bytes().skip(1).chain([0]));
    let line = ends.filter(|pair| pair.0 == b'\n' || pair.0 == b'\r' && pair.1 != b'\n').count();
    LineColumn { line: line as u32, column: column_of_offset(&before[start..], usize::MAX, encoding) }
}

/// The byte offset of `column` in `line`; a column past the end is the end, one inside a character is its start.
pub fn offset_of_column(line: &str, column: u32, encoding: Encoding) -> usize {
    let column = column as usize;
    if line.is_ascii() {
        return column.min(line.len());
    }
    let mut counted = 0;
    for (offset, character) in line.char_indices() {
        let width = match encoding {
            Encoding::Utf8 => character.len_utf8(),
            Encoding::Utf16 => character.len_utf16(),
            Encoding::Utf32 => 1,
        };
        if counted + width > column {
            return offset;
        }
        counted += width;
    }
    line.len()
}

/// What some editors write before a text; it shows nothing.
pub const BYTE_ORDER_MARK: char = '\u{feff}';

/// How many cells of an editor's grid a character fills: 2 for CJK, 0 for combining marks, else 1.
///
/// Box drawing and other East Asian *ambiguous* characters count 1, as in editors with a western setting.
/// Tabs depend on their column and are the caller's matter.
pub fn cell_width(character: char) -> usize {
    if character.is_ascii() { 1 } else { character.width().unwrap_or(1) }
}

/// How many cells a text without tabs fills.
pub fn text_width(text: &str) -> usize {
    if text.is_ascii() { text.len() } else { text.chars().map(cell_width).sum() }
}
