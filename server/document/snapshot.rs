//! The document itself: text, chunks, and how an edit changes both.

use super::both::both;
use super::chunk::Dialect;
use super::pages::{self, Cursor, Page, Pages};
use super::split::split;
use super::{Chunk, Comments, Notation, Outer, Scopes, Size};
use crate::ladder::NameHabit;
use crate::target::{Device, Target};
use crate::text::{Encoding, LineColumn, Span, column_of_offset, offset_of_column};
use ropey::Rope;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Larger texts are kept and edited, but not read; the check says so.
pub const LIMIT_BYTES: usize = 64 << 20;

/// In documents up to this size, some five thousand lines, all trees are kept; larger ones would take too much memory.
const KEPT_TREES_BYTES: usize = 256 << 10;

/// The characters of such a text are counted beside the reading of it, by another thread.
const LONG: usize = 1 << 20;

/// So many chunks are worth the start of a thread that makes half of them.
const WORTH_A_THREAD: usize = 1_000;

/// A document at one moment. Cloning copies a pointer for each page of chunks and shares the text.
#[derive(Clone, Debug)]
pub struct Document {
    rope: Rope,
    dialect: Arc<Dialect>,
    comments: Arc<Comments>,
    pages: Pages,
    scopes: OnceLock<Arc<Scopes>>,
    /// What the files of its project declare, and which of them it is.
    outer: Option<(Arc<Outer>, usize)>,
    /// Whether drawings are read anew each time that they are looked at, as in large documents.
    is_frugal: bool,
}

/// A replacement of bytes; `None` replaces everything.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Edit {
    /// The bytes replaced.
    pub range: Option<Range<usize>>,
    /// What stands there afterwards.
    pub text: String,
}

/// A chunk at its place in a document.
#[derive(Clone, Copy, Debug)]
pub struct ChunkRef<'a> {
    /// Byte offset of its start in the document.
    pub start: usize,
    /// The chunk.
    pub chunk: &'a Arc<Chunk>,
}

impl Document {
    /// Reads `text`.
    pub fn new(text: &str, notation: Notation, target: &'static Target) -> Document {
        Document::with_comments(text, notation, target, Arc::default())
    }

    /// Reads `text`, in which the symbols of `comments` stand for devices.
    pub fn with_comments(
        text: &str,
        notation: Notation,
        target: &'static Target,
        comments: Arc<Comments>,
    ) -> Document {
        let symbols = comments.symbols();
        let symbols = (!symbols.is_empty()).then(|| Arc::new(target.with_symbols(symbols.clone())));
        let dialect = Arc::new(Dialect { notation, target, symbols, names_below: false });
        let mut document = Document { comments, dialect, ..Document::unread("", notation, target) };
        let ((), rope) = both(text.len() >= LONG, || document.read_all(text, &[]), || Rope::from_str(text));
        Document { rope, ..document }
    }

    /// Keeps `text` without reading it: the last resort after a failure of a reader.
    pub fn unread(text: &str, notation: Notation, target: &'static Target) -> Document {
        Document {
            rope: Rope::from_str(text),
            dialect: Arc::new(Dialect { notation, target, symbols: None, names_below: false }),
            comments: Arc::default(),
            pages: Pages::default(),
            scopes: OnceLock::new(),
            outer: None,
            is_frugal: false,
        }
    }

    /// Reads `text` for a document that is rarely looked at and of which there are many: no tree of a drawing is kept.
    pub fn frugal(text: &str, notation: Notation, target: &'static Target) -> Document {
        let mut document = Document { is_frugal: true, ..Document::unread(text, notation, target) };
        document.read_all(text, &[]);
        document
    }

    /// The same document for a walk through all its chunks: trees that are read on the way and not kept go away with
    /// it.
    pub fn lean(&self) -> Document {
        Document { pages: self.pages.lean(), ..self.clone() }
    }

    /// The bytes of `old` that were replaced and those of `self` that replaced them, to whole chunks;
    /// `None` if nothing changed.
    pub fn changed_since(&self, old: &Document) -> Option<(Range<usize>, Range<usize>)> {
        let same = |(left, right): &(&Arc<Page>, &Arc<Page>)| Arc::ptr_eq(left, right);
        let (new_pages, old_pages) = (self.pages.pages(), old.pages.pages());
        let head = new_pages.iter().zip(old_pages).take_while(same).count();
        if head == new_pages.len() && head == old_pages.len() {
            return None;
        }
        let tail =
            new_pages[head..].iter().rev().zip(old_pages[head..].iter().rev()).take_while(same).count();
        let bytes = |pages: &[Arc<Page>]| pages.iter().map(|page| page.bytes()).sum::<usize>();
        let start = bytes(&new_pages[..head]);
        let end = bytes(&new_pages[new_pages.len() - tail..]);
        Some((start..old.len() - end, start..self.len() - end))
    }

    /// In which language it is written.
    pub fn notation(&self) -> Notation {
        self.dialect.notation
    }

    /// What it is written for.
    pub fn target(&self) -> &'static Target {
        self.dialect.target
    }

    /// What the project says about its devices.
    pub fn comments(&self) -> &Arc<Comments> {
        &self.comments
    }

    /// Whether the PLC keeps the device without power.
    pub fn keeps(&self, device: Device) -> bool {
        self.comments.latches().keep(device, self.target())
    }

    /// The target as words of the text are read: with the project's symbols.
    pub fn reader(&self) -> &Target {
        self.dialect.reader()
    }

    /// A chunk of this document's language that stands nowhere in it.
    pub fn chunk_of(&self, text: &str) -> Chunk {
        Chunk::new(text, &self.dialect, true)
    }

    /// The same text with other comments; it is read anew only if the symbols differ.
    pub fn commented(&self, comments: &Arc<Comments>) -> Document {
        if self.comments.symbols() != comments.symbols() {
            let read =
                Document::with_comments(&self.text(), self.notation(), self.target(), comments.clone());
            return Document { outer: self.outer.clone(), ..read };
        }
        Document { comments: comments.clone(), ..self.clone() }
    }

    /// Applies `edits` one after another, each to the result of the one before.
    /// Ranges that leave the text or cut a character are moved to the nearest place inside.
    pub fn apply(&mut self, edits: &[Edit]) {
        for edit in edits {
            match &edit.range {
                Some(range) => self.replace(range.clone(), &edit.text),
                None => {
                    let old: Vec<Arc<Chunk>> = self.chunks().map(|at| at.chunk.clone()).collect();
                    self.rope = Rope::from_str(&edit.text);
                    self.read_all(&edit.text, &old);
                }
            }
        }
    }

    /// The whole text.
    pub fn text(&self) -> String {
        self.rope.to_string()
    }

    /// Whether it is the same text of the same document, unchanged since one of the two was cloned.
    pub fn is_instance(&self, other: &Document) -> bool {
        self.rope.is_instance(&other.rope)
    }

    /// Length in bytes.
    pub fn len(&self) -> usize {
        self.rope.len_bytes()
    }

    /// Whether there is no text.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of lines; a text that ends with a line feed has an empty last line.
    pub fn line_count(&self) -> usize {
        self.rope.len_lines()
    }

    /// The text of `span`.
    pub fn slice(&self, span: Span) -> String {
        let end = (span.end as usize).min(self.len());
        let start = (span.start as usize).min(end);
        self.rope.get_byte_slice(start..end).map(|slice| slice.to_string()).unwrap_or_default()
    }

    /// The pages of chunks, in order.
    pub fn pages(&self) -> &[Arc<Page>] {
        self.pages.pages()
    }

    /// The chunks, in order.
    pub fn chunks(&self) -> impl Iterator<Item = ChunkRef<'_>> {
        let mut start = 0;
        self.pages.pages().iter().flat_map(|page| page.chunks()).map(move |chunk| {
            let at = ChunkRef { start, chunk };
            start += chunk.len();
            at
        })
    }

    /// The chunks of IEC declarations and statements, in order, each with how many POUs have started up to its end.
    /// Pages without any are passed over.
    pub fn iec_chunks(&self) -> impl Iterator<Item = (ChunkRef<'_>, usize)> {
        let (mut end, mut pous) = (0, 0);
        self.pages.pages().iter().flat_map(move |page| {
            let mut start = end;
            end += page.bytes();
            let chunks = if page.has_iec() { page.chunks() } else { &[] };
            let mut started = pous;
            pous += page.pou_starts();
            chunks.iter().filter_map(move |chunk| {
                let at = ChunkRef { start, chunk };
                start += chunk.len();
                started += chunk.pou_starts();
                chunk.is_iec().then_some((at, started))
            })
        })
    }

    /// How much program it is. Only pages that an edit touched are counted anew.
    pub fn size(&self) -> Size {
        self.pages.pages().iter().map(|page| page.size()).sum()
    }

    /// The chunk in which `offset` lies; at the very end the last one. `None` if there is no text.
    pub fn chunk_at(&self, offset: usize) -> Option<ChunkRef<'_>> {
        let (cursor, start) = self.pages.locate(offset)?;
        Some(ChunkRef { start, chunk: self.pages.get(cursor)? })
    }

    /// The chunk that ends where the one containing `offset` starts.
    pub fn chunk_before(&self, offset: usize) -> Option<ChunkRef<'_>> {
        let (cursor, start) = self.pages.locate(offset)?;
        let chunk = self.pages.get(self.pages.previous(cursor)?)?;
        Some(ChunkRef { start: start - chunk.len(), chunk })
    }

    /// The same document as file number `own` of a project in which `outer` is declared.
    pub fn linked(&self, outer: Arc<Outer>, own: usize) -> Document {
        Document { scopes: OnceLock::new(), outer: Some((outer, own)), ..self.clone() }
    }

    /// The same document standing alone, without a project's comments.
    pub fn unlinked(&self) -> Document {
        let bare = self.commented(&Arc::default());
        Document { scopes: OnceLock::new(), outer: None, ..bare }
    }

    /// The same document in the place of `other` in its project.
    pub fn linked_as(self, other: &Document) -> Document {
        let commented = self.commented(&other.comments);
        Document { scopes: OnceLock::new(), outer: other.outer.clone(), ..commented }
    }

    /// What the files of its project declare, and which of them it is.
    pub fn outer(&self) -> Option<(&Arc<Outer>, usize)> {
        self.outer.as_ref().map(|(outer, own)| (outer, *own))
    }

    /// The POUs and variables declared in it, and those of the other files of its project.
    pub fn scopes(&self) -> &Arc<Scopes> {
        self.scopes.get_or_init(|| Arc::new(Scopes::of(self)))
    }

    /// The position of byte `offset`.
    pub fn position(&self, offset: usize, encoding: Encoding) -> LineColumn {
        let offset = offset.min(self.len());
        let line = self.rope.byte_to_line(offset);
        let start = self.rope.line_to_byte(line);
        let column = self.with_line(line, |text| column_of_offset(text, offset - start, encoding));
        LineColumn { line: line as u32, column }
    }

    /// The line, from 0, in which `offset` lies; the way to it does not read the line.
    pub fn line_of(&self, offset: usize) -> u32 {
        self.rope.byte_to_line(offset.min(self.len())) as u32
    }

    /// The line, from 0, in which `offset` lies, with the offset of its start and its text, line end included.
    pub fn line_at(&self, offset: usize) -> (usize, usize, String) {
        let line = self.rope.byte_to_line(offset.min(self.len()));
        (line, self.rope.line_to_byte(line), self.rope.line(line).to_string())
    }

    /// The byte offset of a position; positions past the end of a line or of the text are moved there.
    pub fn offset(&self, position: LineColumn, encoding: Encoding) -> usize {
        let line = position.line as usize;
        if line >= self.rope.len_lines() {
            return self.len();
        }
        self.rope.line_to_byte(line)
            + self.with_line(line, |text| {
                let text = text.trim_end_matches('\n').trim_end_matches('\r');
                offset_of_column(text, position.column, encoding)
            })
    }

    fn with_line<T>(&self, line: usize, read: impl FnOnce(&str) -> T) -> T {
        let slice = self.rope.line(line);
        match slice.as_str() {
            Some(text) => read(text),
            None => read(&slice.to_string()),
        }
    }

    fn read_all(&mut self, text: &str, old: &[Arc<Chunk>]) {
        self.pages = match text.len() > LIMIT_BYTES {
            true => Pages::default(),
            false => Pages::of(self.read_pieces(text, old, text.len(), pages::paginate)),
        };
        self.scopes = OnceLock::new();
        self.settle_names();
    }

    /// Reads the drawings that do not show where they have their names as most others of the document do. That costs
    /// a look at each page, and those drawings when the habit changes.
    fn settle_names(&mut self) {
        let mut habit = NameHabit::default();
        self.pages.pages().iter().for_each(|page| habit += page.habit());
        let names_below = habit.decided() == Some(true);
        if names_below == self.dialect.names_below {
            return;
        }
        let Dialect { notation, target, ref symbols, .. } = *self.dialect;
        self.dialect = Arc::new(Dialect { notation, target, symbols: symbols.clone(), names_below });
        let keeps_trees = self.keeps_trees(self.pages.pages().iter().map(|page| page.bytes()).sum());
        let settled = |chunk: &Arc<Chunk>| match chunk.habit().decided() {
            None if !chunk.is_iec() => Arc::new(Chunk::new(chunk.text(), &self.dialect, keeps_trees)),
            _ => Arc::clone(chunk),
        };
        self.pages =
            Pages::new(self.pages.pages().iter().flat_map(|page| page.chunks()).map(settled).collect());
    }

    /// Whether the trees of a document of so many bytes are kept.
    fn keeps_trees(&self, bytes: usize) -> bool {
        !self.is_frugal && bytes <= KEPT_TREES_BYTES
    }

    fn replace(&mut self, range: Range<usize>, text: &str) {
        let start = self.rope.byte_to_char(range.start.min(self.len()));
        let end = self.rope.byte_to_char(range.end.min(self.len())).max(start);
        let range = self.rope.char_to_byte(start)..self.rope.char_to_byte(end);
        self.rope.remove(start..end);
        self.rope.insert(start, text);
        let too_large = self.len() > LIMIT_BYTES || self.pages.pages().is_empty();
        match self.pages.locate(range.start) {
            Some((first, start)) if !too_large => self.read_window(first, start, range, text.len()),
            _ => {
                let text = self.text();
                self.read_all(&text, &[]);
            }
        }
    }

    /// Splits and reads anew the chunks around an edit that put `inserted` bytes in the place of `range`.
    ///
    /// A boundary depends on the text from the boundary before it to the end of the chunk after it. So the window
    /// starts one chunk before the first touched one and ends with one untouched chunk; it grows until it starts with
    /// a chunk that kept its extent and ends with the two boundaries of the untouched chunk.
    fn read_window(&mut self, first: Cursor, first_start: usize, range: Range<usize>, inserted: usize) {
        let (mut first, mut window_start) = (first, first_start);
        let (mut last, _) = self.pages.locate(range.end).unwrap_or((first, first_start));
        let touches_start = range.start == first_start;
        for _ in 0..if touches_start { 2 } else { 1 } {
            self.step_back(&mut first, &mut window_start);
        }
        let mut reach = 1;
        loop {
            for _ in 0..reach {
                last = self.pages.next(last).unwrap_or(last);
            }
            let old = self.pages.between(first, last);
            let old_length: usize = old.iter().map(|chunk| chunk.len()).sum();
            let window_end = window_start + old_length + inserted - range.len();
            let text = self.slice(Span::new(window_start, window_end));
            let ends = split(&text, self.notation());
            let at_text_end = self.pages.next(last).is_none();
            let sentinel = old.last().map_or(0, |chunk| chunk.len());
            let head = old.first().map_or(0, |chunk| chunk.len());
            let end_holds = at_text_end || (old.len() > 1 && ends_with(&ends, text.len(), sentinel));
            let start_holds =
                window_start == 0 || (ends.first() == Some(&head) && window_start + head <= range.start);
            if end_holds && start_holds {
                let new = self.read_pieces(&text, &old, self.len(), |chunks| chunks);
                let declares = |chunks: &[Arc<Chunk>]| chunks.iter().any(|chunk| chunk.declares());
                if declares(&old) || declares(&new) {
                    self.scopes = OnceLock::new();
                }
                self.pages.replace(first, last, new);
                self.settle_names();
                return;
            }
            if !start_holds {
                for _ in 0..reach {
                    self.step_back(&mut first, &mut window_start);
                }
            }
            reach *= 2;
        }
    }

    fn step_back(&self, first: &mut Cursor, start: &mut usize) {
        if let Some(previous) = self.pages.previous(*first) {
            *start -= self.pages.get(previous).map_or(0, |chunk| chunk.len());
            *first = previous;
        }
    }

    /// Splits and reads `text` and makes `gather` of its chunks; pieces that stood among `old` are taken over with all
    /// that is known of them. `whole` is the length of the document. Two threads share many pieces, so `gather` may see
    /// the chunks in two portions.
    fn read_pieces<T: Send>(
        &self,
        text: &str,
        old: &[Arc<Chunk>],
        whole: usize,
        gather: impl Fn(Vec<Arc<Chunk>>) -> Vec<T> + Sync,
    ) -> Vec<T> {
        let known: rustc_hash::FxHashMap<&str, &Arc<Chunk>> =
            old.iter().map(|chunk| (chunk.text(), chunk)).collect();
        let ends = split(text, self.notation());
        let keeps_trees = self.keeps_trees(whole);
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let pieces: Vec<&str> = starts.zip(&ends).map(|(start, end)| &text[start..*end]).collect();
        let read = |pieces: &[&str]| {
            // Threads that count the users of one and the same thing wait for each other.
            let dialect = Arc::new(Dialect::clone(&self.dialect));
            let chunk = |piece: &&str| match known.get(piece) {
                Some(chunk) => Arc::clone(chunk),
                None => Arc::new(Chunk::new(piece, &dialect, keeps_trees)),
            };
            gather(pieces.iter().map(chunk).collect())
        };
        if pieces.len() < WORTH_A_THREAD {
            return read(&pieces);
        }
        let (first, second) = pieces.split_at(pieces.len() / 2);
        let (mut gathered, second) = both(true, || read(first), || read(second));
        gathered.extend(second);
        gathered
    }
}

/// Whether the last chunk of a text of `length` bytes starts `sentinel` bytes before its end.
fn ends_with(ends: &[usize], length: usize, sentinel: usize) -> bool {
    ends.last() == Some(&length) && ends.len() >= 2 && ends[ends.len() - 2] == length - sentinel
}
