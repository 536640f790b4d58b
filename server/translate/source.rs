//! The rungs of a document that are to be translated.

use crate::document::{Chunk, ChunkRef, Document, Milestone, Notation, Scopes, Symbol, Tree, both};
use crate::il::iec::{IecTree, ItemKind, words_of_body};
use crate::ladder;
use crate::logic::{self, Declared, Elsewhere, Path, Rung};
use crate::target::Device;
use crate::text::{Message, Span};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A rung with its chunk.
#[derive(Clone, Debug)]
pub struct Source {
    /// Where the chunk starts in the document.
    pub start: usize,
    /// The chunk, in which the spans of the rung are places.
    pub chunk: Arc<Chunk>,
    /// The rung.
    pub rung: Rung,
    /// The declarations that stand before it, as written.
    pub declarations: String,
    /// The number of the program unit that it belongs to.
    pub pou: Option<usize>,
    /// Why it has no words in the language that it is translated to.
    pub note: Option<Message>,
    /// Why it is doubtful whether it does the same with its words there.
    pub doubt: Option<Message>,
}

/// A program, or a part of one.
#[derive(Clone, Default)]
pub(super) struct Program {
    /// The rungs.
    pub rungs: Vec<Source>,
    /// The declarations behind the last rung, as written.
    pub tail: String,
    /// The presets that declarations of counters have to say once the program is one of IEC 61131-3, by their names.
    pub presets: FxHashMap<SmolStr, i64>,
}

impl Source {
    /// Where it stands in the document.
    pub fn span(&self) -> Span {
        self.rung.span.shifted(self.start)
    }

    /// What it does, if it can be read and does something.
    pub fn path(&self) -> Option<&Path> {
        self.rung.path.as_ref().ok()?.as_ref()
    }

    /// Its words in one spelling, comments aside.
    pub(super) fn words(&self) -> SmolStr {
        let (text, span) = (self.chunk.text(), self.rung.span);
        let boxed = self.chunk.box_at(span.start as usize).map(|(_, list)| list.tree());
        match boxed.unwrap_or_else(|| self.chunk.tree()) {
            Tree::Iec(_) => words_of_body(text, span),
            _ => span.of(text).split_whitespace().collect::<Vec<_>>().join(" ").into(),
        }
    }

    /// Its text without the comments before it.
    pub fn text(&self) -> &str {
        self.rung.span.of(self.chunk.text())
    }

    /// The rungs of `document` whose chunks lie in these bytes, as declarations around them have them. In a list of
    /// IEC 61131-3 rungs must begin where the bytes do and where they end.
    pub fn within(document: &Document, bytes: Span) -> Vec<Source> {
        let unit = document.unit_at(bytes.start as usize);
        let is_first = unit.span.start == bytes.start;
        let mut pous = if is_first { unit.before } else { unit.started() };
        if document.notation() == Notation::IecIl {
            let chunk = Arc::new(document.chunk_of(&document.slice(bytes)));
            return Source::of_chunk(document, bytes.start as usize, &chunk, pous);
        }
        let mut found = Vec::new();
        let mut offset = bytes.start as usize;
        while offset < bytes.end as usize
            && let Some(at) = document.chunk_at(offset)
            && at.start >= offset
        {
            found.extend(Source::of_chunk(document, at.start, at.chunk, pous));
            pous += at.chunk.pou_starts();
            offset = at.start + at.chunk.len();
        }
        found
    }

    /// The rungs of a chunk before which `pous` program units start.
    pub(super) fn of_chunk(
        document: &Document,
        start: usize,
        chunk: &Arc<Chunk>,
        pous: usize,
    ) -> Vec<Source> {
        let declared = Declared { scopes: document.scopes(), pous };
        let rungs = logic::rungs_with(&chunk.reading(), document.reader(), declared).into_iter();
        let source = |rung| Source {
            start,
            chunk: chunk.clone(),
            rung,
            declarations: String::new(),
            pou: pous.checked_sub(1),
            note: None,
            doubt: None,
        };
        rungs.map(source).collect()
    }

    /// Its comments as written.
    pub fn comments(&self) -> impl Iterator<Item = &str> {
        self.rung.comments.iter().map(|comment| comment.of(self.chunk.text()).trim_end())
    }

    /// Whether a comment stands below the rung, as behind END.
    pub fn is_behind(&self, comment: &Span) -> bool {
        if matches!(self.rung.path, Ok(None)) {
            return false;
        }
        let below = self.chunk.text().get(self.rung.span.end as usize..comment.start as usize);
        below.is_some_and(|between| between.contains('\n'))
    }

    /// Whether there is a blank line between these offsets of the chunk, and nothing else.
    pub fn has_blank_line(&self, start: u32, end: u32) -> bool {
        let between = self.chunk.text().get(start as usize..end as usize).unwrap_or_default();
        between.trim().is_empty() && between.matches('\n').count() > 1
    }

    /// Whether there is nothing of it but blank lines.
    pub fn is_blank(&self) -> bool {
        let Rung { labels, network, comments, path, .. } = &self.rung;
        labels.is_empty() && network.is_none() && comments.is_empty() && matches!(path, Ok(None))
    }
}

/// The rungs of `document`; with `part` only those that touch these bytes.
pub(super) fn rungs(document: &Document, part: Option<Span>) -> Vec<Source> {
    program(document, part).rungs
}

/// The rungs of a document without declarations, where `scopes` holds in program unit number `pou`.
pub(super) fn rungs_within(document: &Document, scopes: &Scopes, pou: Option<usize>) -> Vec<Source> {
    let pous = pou.map_or(0, |pou| pou + 1);
    read((document, scopes), None, pous).rungs
}

/// `document` in rungs and declarations; with `part` only the rungs that touch these bytes.
pub(super) fn program(document: &Document, part: Option<Span>) -> Program {
    read((document, document.scopes()), part, 0)
}

/// The rungs of a program of the FX family that name one of `devices`, and those that decide whether others are done,
/// in their order. The pages of the document know where they stand, so no others are read.
pub(super) fn deciding(document: &Document, devices: &[Device]) -> Vec<Source> {
    let symbols: Vec<Symbol> = devices.iter().copied().map(Symbol::Device).collect();
    let elsewhere = Elsewhere::default();
    let program = Program::default();
    let (scopes, part, pous) = (document.scopes(), None, 0);
    let mut reader = Reader { document, scopes, part, pous, elsewhere: &elsewhere, program };
    let mut page_start = 0;
    for page in document.pages() {
        let structure = page.milestones().iter().filter(|milestone| !milestone.kind.is_plain());
        let mut wanted: BTreeSet<usize> = structure.map(Milestone::chunk).collect();
        if symbols.iter().any(|symbol| page.names().contains(symbol)) {
            let names_one = |chunk: &Chunk| chunk.mentions().iter().any(|own| symbols.contains(&own.symbol));
            let chunks = page.chunks().iter().enumerate().filter(|(_, chunk)| names_one(chunk));
            wanted.extend(chunks.map(|(number, _)| number));
        }
        let mut start = page_start;
        for (number, chunk) in page.chunks().iter().enumerate() {
            if wanted.contains(&number) || chunk.is_iec() {
                reader.chunk(start, chunk);
            }
            start += chunk.len();
        }
        page_start += page.bytes();
    }
    reader.program.rungs
}

/// The same where `scopes` holds, and so many program units have started before.
fn read((document, scopes): (&Document, &Scopes), part: Option<Span>, pous: usize) -> Program {
    let elsewhere = Elsewhere::default();
    let new = || Reader { document, scopes, part, pous, elsewhere: &elsewhere, program: Program::default() };
    let mut reader = new();
    if document.notation() == Notation::IecIl {
        if let Some((bytes, pous, whole, elsewhere)) = part.and_then(|part| stretch(document, part)) {
            let mut reader = Reader { pous, elsewhere: &elsewhere, ..reader };
            reader.chunk(bytes.start as usize, &whole);
            return reader.program;
        }
        // A rung of instruction list may reach over several chunks: the calls before it belong to it.
        let (bytes, started) =
            part.map_or((Span::new(0, document.len()), 0), |part| units_around(document, part));
        reader.pous += started;
        let whole = Arc::new(document.chunk_of(&document.slice(bytes)));
        reader.chunk(bytes.start as usize, &whole);
        return reader.program;
    }
    let is_wanted = |at: &ChunkRef<'_>| {
        at.chunk.is_iec() || reader.touches(Span::new(at.start, at.start + at.chunk.len()))
    };
    let chunks: Vec<ChunkRef<'_>> = document.chunks().filter(is_wanted).collect();
    // Drawings and lists without declarations depend on nothing before them, so two threads can share them.
    let is_shared = chunks.len() >= WORTH_A_THREAD && !chunks.iter().any(|at| at.chunk.is_iec());
    let (first, second) = chunks.split_at(if is_shared { chunks.len() / 2 } else { chunks.len() });
    let read = |chunks: &[ChunkRef<'_>]| {
        let mut reader = new();
        chunks.iter().for_each(|at| reader.chunk(at.start, at.chunk));
        reader.program
    };
    let (mut program, rest) = both(is_shared, || read(first), || read(second));
    program.rungs.extend(rest.rungs);
    program
}

/// The bytes of a few rungs around `part` that can be read without the rest of their program unit, how many units have
/// started there, the rungs' text, and what the rest says of the names in it; nothing where only the whole unit tells.
fn stretch(document: &Document, part: Span) -> Option<(Span, usize, Arc<Chunk>, Elsewhere)> {
    let (bytes, unit) = logic::stretch::holding(document, part)?;
    let own = Arc::new(document.chunk_of(&document.slice(bytes)));
    let elsewhere = Elsewhere::of(document, unit, bytes, &own)?;
    Some((bytes, unit.started(), own, elsewhere))
}

/// The bytes of the program units around `part`, and how many units start before them. A chunk in which a unit starts
/// may begin with the end of the one before.
fn units_around(document: &Document, part: Span) -> (Span, usize) {
    let own = document.unit_at(part.start as usize);
    let starts_here =
        document.chunk_at(part.start as usize).is_some_and(|at| at.start == own.span.start as usize);
    let first = match own.span.start.checked_sub(1).filter(|_| starts_here) {
        Some(before) => document.unit_at(before as usize),
        None => own,
    };
    let last = document.unit_at(part.end as usize);
    (first.span.to(last.span), first.before)
}

/// So many chunks are worth the start of a thread that reads half of them.
const WORTH_A_THREAD: usize = 500;

struct Reader<'a> {
    document: &'a Document,
    scopes: &'a Scopes,
    part: Option<Span>,
    /// How many program units have started.
    pous: usize,
    /// What the program unit says outside of what is read.
    elsewhere: &'a Elsewhere,
    program: Program,
}

impl Reader<'_> {
    fn touches(&self, span: Span) -> bool {
        self.part.is_none_or(|part| span.start <= part.end && part.start <= span.end)
    }

    fn chunk(&mut self, start: usize, chunk: &Arc<Chunk>) {
        let reading = chunk.reading();
        let declared = match reading.tree() {
            Tree::Iec(tree) => logic::declarations(reading.text(), tree),
            _ => Vec::new(),
        };
        // The tables of an LDmicro export mean nothing without its head.
        let is_table = !declared.is_empty() && ladder::kind_of(reading.text()) == ladder::ChunkKind::Ldmicro;
        let is_kept = self.part.is_none() && !is_table;
        let mut declared = declared.into_iter().peekable();
        let context = Declared { scopes: self.scopes, pous: self.pous };
        for rung in logic::rungs_of_stretch(&reading, self.document.reader(), context, self.elsewhere) {
            while let Some(span) = declared.next_if(|span| span.start <= rung.span.start) {
                self.declare(&reading, span, is_kept);
            }
            let declarations = std::mem::take(&mut self.program.tail);
            let pou = self.pous.checked_sub(1);
            let source =
                Source { start, chunk: chunk.clone(), rung, declarations, pou, note: None, doubt: None };
            match !source.is_blank() && self.touches(source.span()) {
                true => self.program.rungs.push(source),
                false => self.program.tail = source.declarations,
            }
        }
        declared.for_each(|span| self.declare(&reading, span, is_kept));
    }

    fn declare(&mut self, chunk: &Chunk, span: Span, is_kept: bool) {
        if is_kept {
            self.program.tail += span.of(chunk.text());
        }
        if let Tree::Iec(tree) = chunk.tree() {
            self.pous += pous_within(tree, span);
        }
    }
}

fn pous_within(tree: &IecTree, span: Span) -> usize {
    // Items stand in the order of the text.
    let [first, end] =
        [span.start, span.end].map(|at| tree.items.partition_point(|item| item.span.start < at));
    let inside = tree.items.get(first..end).unwrap_or_default();
    inside.iter().filter(|item| matches!(item.kind, ItemKind::Pou { .. })).count()
}
