//! Cuts a document into chunks, so that an edit re-reads only what it touched.

use super::glyph::{Arms, is_operator};
use super::ldmicro::is_row;
use super::lines::{LDMICRO_DRAWING, Line, LineKind, Lines, has_word, is_blank};
use crate::text::Span;

/// What a chunk holds.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ChunkKind {
    /// Drawing lines, or the header of a network.
    Drawing,
    /// IEC declarations: `PROGRAM x`, `VAR … END_VAR`, `END_PROGRAM`.
    Declarations,
    /// Comments, pragmas, blank lines and rails without anything between.
    Comments,
    /// The header or the tables of an LDmicro text export.
    Ldmicro,
}

/// The ends of the chunks of `text`: increasing byte offsets, the last one `text.len()`; nothing for an empty text.
///
/// `text` must start where a chunk starts. A chunk is a run of comments and a network header, one block of drawing
/// lines, and the blank and rail-only lines after it; or declarations with the blank lines after them; or comments
/// with the blank lines after them. Comments and pragmas are never cut.
pub fn split(text: &str) -> Vec<usize> {
    chunk_ends(text).collect()
}

/// As [`split`], one end at a time.
///
/// Whether a chunk ends at an offset depends only on the text from the start of that chunk up to the end of the line
/// after that offset. After an edit it is therefore enough to start at the last boundary before the chunk *before*
/// the one that was touched (a changed first line may join the chunk above it), and to stop at the first end
/// behind the edit that was an end before: from there on everything stays as it was. Stopping before the last line
/// of a window is safe; the end of the window itself is an end only if it is the end of the document.
pub fn chunk_ends(text: &str) -> impl Iterator<Item = usize> {
    let mut lines = Lines::new(text);
    let mut chunk = Chunk::default();
    let mut finished = text.is_empty();
    std::iter::from_fn(move || {
        for line in lines.by_ref() {
            if !chunk.takes(&line, text) {
                let end = line.span.start as usize;
                chunk = Chunk::default();
                chunk.takes(&line, text);
                return Some(end);
            }
        }
        let end = (!finished).then_some(text.len());
        finished = true;
        end
    })
}

/// What kind of chunk `chunk` is.
pub fn kind_of(chunk: &str) -> ChunkKind {
    let mut state = Chunk::default();
    for line in Lines::new(chunk) {
        state.takes(&line, chunk);
        match state.phase {
            Phase::Declarations(_) => return ChunkKind::Declarations,
            Phase::Ldmicro { .. } | Phase::Table => return ChunkKind::Ldmicro,
            Phase::Header { .. } | Phase::Drawing => return ChunkKind::Drawing,
            Phase::Start | Phase::Comments | Phase::After => {}
        }
    }
    ChunkKind::Comments
}

/// How far a chunk has come.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
enum Phase {
    /// Nothing but blank and rail-only lines.
    #[default]
    Start,
    /// Comments, directly above what is to come.
    Comments,
    /// A network header, perhaps with comments; `complete` once it has a label.
    Header { complete: bool },
    /// The block of drawing lines.
    Drawing,
    /// Declarations, with the keyword that ends the open section.
    Declarations(Option<&'static str>),
    /// The head of an LDmicro export; `open` until the line that ends it.
    Ldmicro { open: bool },
    /// A table of an LDmicro export.
    Table,
    /// Blank lines at the end.
    After,
}

/// A chunk as far as it has been seen.
#[derive(Debug, Default)]
struct Chunk {
    phase: Phase,
    block: BlockSoFar,
}

/// Columns of the block of drawing lines, by which a rail-only line is told from a line of vertical wires.
#[derive(Debug, Default)]
struct BlockSoFar {
    /// Whether there is any drawing line.
    started: bool,
    /// Drawing lines that were not measured yet. Most blocks end without a line that asks for their columns.
    waiting: Vec<Line>,
    /// The leftmost column of the drawing.
    left: Option<u32>,
    /// The rightmost column.
    right: u32,
    /// The last line with a wire or an element in it, the column of its last bar or corner if it ends in one, and
    /// whether that stands behind a contact, once this is asked for.
    wires: Option<(Line, Option<u32>, Option<bool>)>,
}

impl Chunk {
    /// Takes the next line into the chunk, or refuses it, because a new chunk starts there.
    fn takes(&mut self, line: &Line, text: &str) -> bool {
        if let Phase::Declarations(Some(last)) = self.phase {
            return self.takes_declaration(line, last, text);
        }
        let words = || line.span.of(text).trim_matches(is_blank);
        if self.phase == (Phase::Ldmicro { open: true }) {
            let words = words();
            // Without its last line the head ends where the drawing starts.
            self.phase = Phase::Ldmicro { open: !words.starts_with(LDMICRO_DRAWING) };
            return line.continues || !words.starts_with('|');
        }
        if self.phase == Phase::Table {
            let words = words();
            return line.continues || words.is_empty() || is_row(words);
        }
        let kind = line.kind(text);
        let next = match (self.phase, &kind) {
            (Phase::Start, LineKind::Blank | LineKind::Bars(_)) => Phase::Start,
            (Phase::Comments, LineKind::Bars(_)) => Phase::Comments,
            (Phase::Drawing, LineKind::Bars(bars)) if self.block.is_crossed(bars, text) => Phase::Drawing,
            (Phase::Drawing | Phase::After, LineKind::Bars(_)) if self.block.started => Phase::After,
            (Phase::Header { complete }, LineKind::Blank | LineKind::Bars(_) | LineKind::Comment) => {
                Phase::Header { complete }
            }
            (Phase::Drawing | Phase::Comments | Phase::After, LineKind::Blank) => Phase::After,
            (Phase::Declarations(_) | Phase::Ldmicro { .. }, LineKind::Blank) => Phase::After,
            (Phase::Start | Phase::Comments, LineKind::Comment) => Phase::Comments,
            (Phase::Start | Phase::Comments, LineKind::Header(header)) => {
                Phase::Header { complete: header.label.is_some() }
            }
            (Phase::Header { complete: false }, LineKind::Header(header)) if header.label.is_some() => {
                Phase::Header { complete: true }
            }
            (Phase::Start | Phase::Comments | Phase::Declarations(_), LineKind::Declaration(section)) => {
                Phase::Declarations(*section)
            }
            (Phase::Start | Phase::Comments, LineKind::Ldmicro) => Phase::Ldmicro { open: true },
            (Phase::Start | Phase::Comments, LineKind::Table) => Phase::Table,
            (Phase::Start | Phase::Comments | Phase::Header { .. } | Phase::Drawing, LineKind::Drawing) => {
                Phase::Drawing
            }
            // The inside of a comment belongs where its first line belongs.
            _ => return line.continues,
        };
        if kind == LineKind::Drawing {
            self.block.add(line);
        }
        self.phase = next;
        true
    }

    fn takes_declaration(&mut self, line: &Line, last: &'static str, text: &str) -> bool {
        let content = line.content(text).map_or("", |content| content.of(text));
        // A section that was never closed ends where the drawing starts.
        if Arms::of(content.chars().next().unwrap_or(' ')).is_upright() {
            return false;
        }
        if has_word(content, last) {
            self.phase = Phase::Declarations(None);
        }
        true
    }
}

impl BlockSoFar {
    fn add(&mut self, line: &Line) {
        self.started = true;
        self.waiting.push(line.clone());
    }

    fn measure(&mut self, line: Line, text: &str) {
        let mut margin = true;
        let mut has_wires = false;
        let mut last = None;
        for (column, _, character) in line.cells(text) {
            if is_blank(character) {
                continue;
            }
            let arms = Arms::of(character);
            last = arms.is_upright().then_some(column);
            let draws = arms.is_line() || matches!(character, '[' | ']' | '(' | ')');
            // A rung number may stand left of the rail.
            if draws && margin {
                self.left = Some(self.left.map_or(column, |left| left.min(column)));
            }
            margin &= character.is_ascii_digit();
            has_wires |= draws && !arms.is_vertical() && character != '_';
            if draws {
                self.right = self.right.max(column);
            }
        }
        if has_wires {
            self.wires = Some((line, last, None));
        }
    }

    /// Whether one of `bars` on a line without anything else is a vertical wire, not a rail.
    fn is_crossed(&mut self, bars: &[u32], text: &str) -> bool {
        for line in std::mem::take(&mut self.waiting) {
            self.measure(line, text);
        }
        let inner: &[u32] = match (bars, self.left) {
            ([first, rest @ ..], Some(left)) if *first <= left + 1 => rest,
            _ => bars,
        };
        match inner {
            [] => false,
            [bar] => {
                // The bar may be one of a double rail, or of a rail that is not straight.
                match &mut self.wires {
                    Some((line, Some(last), condition)) if last.abs_diff(*bar) <= 2 => {
                        *condition.get_or_insert_with(|| ends_in_condition(line, text))
                    }
                    _ => *bar < self.right,
                }
            }
            _ => true,
        }
    }
}

/// Whether the last element of `line` is a contact, so that the corner after it is a branch and no rail.
fn ends_in_condition(line: &Line, text: &str) -> bool {
    let content = line.content(text).unwrap_or(Span::at(0)).of(text);
    let is_wire = |c: char| is_blank(c) || (Arms::of(c).is_line() && !Arms::of(c).is_vertical());
    let content = content.trim_end_matches(|c| Arms::of(c).is_vertical()).trim_end_matches(is_wire);
    // Only the left rail is left: the line is the border of a function block.
    if content.trim_start_matches(|c: char| is_blank(c) || c.is_ascii_digit()).chars().count() < 2 {
        return false;
    }
    match content.chars().next_back() {
        Some(']') => {
            let inside = content[..content.len() - 1].rsplit(['[', ']']).next().unwrap_or("");
            // A comparison has operands, and is a condition nevertheless.
            inside.split_whitespace().count() < 2
                || inside.split_whitespace().any(|word| word.ends_with(is_operator))
        }
        Some('[' | '!' | '|' | '│' | '┃' | '├') => true,
        _ => false,
    }
}
