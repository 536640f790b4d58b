//! What a rule may look at.

use super::order::rung;
use super::sense::{Regions, Uses};
use super::words::plain::is_plain;
use crate::document::{Chunk, ChunkRef, Document, Notation, Operation, Pou, Scopes, Tree};
use crate::il::fx::FxTree;
use crate::target::{Device, Model, Target};
use crate::text::{Diagnostic, Span};
use std::cell::{Cell, OnceCell};
use std::sync::atomic::{AtomicBool, Ordering};

/// A chunk and what it depends on. Offsets are those of the chunk.
pub struct ChunkContext<'a> {
    /// The chunk.
    pub chunk: &'a Chunk,
    /// The language of its document.
    pub notation: Notation,
    /// What it is written for.
    pub target: &'static Target,
    /// The POU in which it stands, and all others of the document.
    pub scopes: &'a Scopes,
    /// The number of that POU in `scopes`; `None` outside of any.
    pub pou: Option<usize>,
    /// Its FX instructions that are not right at one look, in the order of the text: what the rules about words judge.
    pub doubtful: Vec<Operation<'a>>,
    /// Whether a rung of it is worth a proof when typing stops.
    pub(super) is_worth_a_proof: Cell<bool>,
    rung: OnceCell<Vec<rung::Finding>>,
}

impl<'a> ChunkContext<'a> {
    /// `chunk` of `document`; `pou` is the number of the POU in which it stands.
    pub fn new(chunk: &'a Chunk, document: &'a Document, pou: Option<usize>) -> ChunkContext<'a> {
        let target = document.target();
        ChunkContext {
            chunk,
            notation: document.notation(),
            target,
            scopes: document.scopes(),
            pou,
            doubtful: chunk.operations().filter(|operation| !is_plain(operation, target)).collect(),
            is_worth_a_proof: Cell::new(false),
            rung: OnceCell::new(),
        }
    }

    /// A list that a drawing carries along, as a chunk of its own.
    pub fn of_box(list: &'a Chunk, document: &'a Document, pou: Option<usize>) -> ChunkContext<'a> {
        let own = ChunkContext::new(list, document, pou);
        let notation = if document.target().is_fx() { Notation::FxIl } else { own.notation };
        ChunkContext { notation, ..own }
    }

    /// What is out of order in a chunk of FX instruction list. One with something unreadable is not judged: the missing
    /// words would be missed here once more.
    pub(super) fn rung(&self) -> Option<(&'a FxTree, &[rung::Finding])> {
        let Tree::Fx(tree) = self.chunk.tree() else { return None };
        let found = || rung::findings(tree, self.target.limits);
        tree.problems.is_empty().then(|| (tree, self.rung.get_or_init(found).as_slice()))
    }

    /// The POU in which the chunk stands.
    pub fn pou(&self) -> Option<&Pou> {
        self.scopes.pous.get(self.pou?).map(|pou| &**pou)
    }
}

/// A whole program: the files that run as one. Its offsets are those of the files put one behind the other in the order
/// of execution; the engine brings what is found back to the files.
pub struct ProgramContext<'a> {
    files: Vec<ProgramFile<'a>>,
    /// The only file about which the findings are wanted, if not all.
    wanted: Option<usize>,
    cancelled: Option<&'a AtomicBool>,
    /// Names of which the project says that no two may be on together.
    never: &'a [Vec<String>],
    /// Whether there is no other program in the project.
    is_all: bool,
    uses: OnceCell<Uses<'a>>,
    regions: OnceCell<Regions>,
}

/// A file of a program.
#[derive(Clone, Copy)]
pub struct ProgramFile<'a> {
    /// Its number in the project.
    pub number: usize,
    /// Its text.
    pub document: &'a Document,
    /// Where it starts among the others.
    pub start: usize,
}

impl<'a> ProgramFile<'a> {
    /// Its chunks in order, at their places in the program.
    pub fn chunks(self) -> impl Iterator<Item = ChunkRef<'a>> + use<'a> {
        self.document.chunks().map(move |at| ChunkRef { start: at.start + self.start, ..at })
    }
}

/// All files of a program together have fewer bytes than this, as offsets have 32 bits.
const MOST_BYTES: usize = u32::MAX as usize - 1;

impl<'a> ProgramContext<'a> {
    /// The program of these files, given with their numbers. A program that is too long for its offsets is cut off
    /// behind a file.
    pub fn new(files: impl IntoIterator<Item = (usize, &'a Document)>, wanted: Option<usize>) -> Self {
        let mut start = 0usize;
        let files = files.into_iter().map(|(number, document)| {
            let file = ProgramFile { number, document, start };
            // The end of a file and the start of the next are not the same place.
            start = start.saturating_add(document.len() + 1);
            file
        });
        let files = files.take_while(|file| file.start.saturating_add(file.document.len()) < MOST_BYTES);
        ProgramContext {
            files: files.collect(),
            wanted,
            cancelled: None,
            never: &[],
            is_all: true,
            uses: OnceCell::new(),
            regions: OnceCell::new(),
        }
    }

    /// The same program for work that nobody waits for any more once `flag` is set.
    pub fn cancellable(self, flag: Option<&'a AtomicBool>) -> ProgramContext<'a> {
        ProgramContext { cancelled: flag, ..self }
    }

    /// Whether nobody waits for the findings any more. Rules that take long ask now and then, and end.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// The same where the project says that no two of some names may be on together; `is_all` says whether it has no
    /// other program that they may be about.
    pub fn with_never(self, never: &'a [Vec<String>], is_all: bool) -> Self {
        ProgramContext { never, is_all, ..self }
    }

    /// Names of which no two may be on together, as the project says.
    pub(super) fn never(&self) -> &'a [Vec<String>] {
        self.never
    }

    /// Whether there is no other program in the project.
    pub(super) fn is_all(&self) -> bool {
        self.is_all
    }

    /// The files in order.
    pub fn files(&self) -> &[ProgramFile<'a>] {
        &self.files
    }

    /// Who reads and who drives what.
    pub(super) fn uses(&self) -> &Uses<'a> {
        self.uses.get_or_init(|| Uses::of(self))
    }

    /// Which parts of the program can run together.
    pub(super) fn regions(&self) -> &Regions {
        self.regions.get_or_init(|| Regions::of(self, self.uses()))
    }

    /// The last file; nothing if there is none.
    pub fn last(&self) -> Option<ProgramFile<'a>> {
        self.files.last().copied()
    }

    /// The number of the line of its file in which something stands, from 1.
    pub(super) fn line_at(&self, span: Span) -> usize {
        self.file_at(span).map_or(1, |file| {
            let at = span.start as usize - file.start;
            file.document.line_at(at).0 + 1
        })
    }

    /// What the program is written for.
    pub fn target(&self) -> &'static Target {
        self.files.first().map_or(Target::of(Model::Fx2n), |file| file.document.target())
    }

    /// Whether the PLC keeps the device without power.
    pub(super) fn keeps(&self, device: Device) -> bool {
        self.files.first().is_some_and(|file| file.document.keeps(device))
    }

    /// The chunks of all files, in order.
    pub fn chunks(&self) -> impl Iterator<Item = ChunkRef<'a>> + use<'a> {
        self.files.clone().into_iter().flat_map(|file| file.chunks())
    }

    /// Calls `judge` for each file about which the findings are wanted, with offsets of that file.
    pub fn each_file(
        &self,
        found: &mut Vec<Diagnostic>,
        mut judge: impl FnMut(&'a Document, &mut Vec<Diagnostic>),
    ) {
        for file in self.files.iter().filter(|file| self.wanted.is_none_or(|wanted| wanted == file.number)) {
            let mut own = Vec::new();
            judge(file.document, &mut own);
            found.extend(own.iter().map(|diagnostic| diagnostic.shifted(file.start)));
        }
    }

    /// Gives what was found to the files: each finding with the number of its file and that file's offsets.
    pub fn distributed(&self, found: Vec<Diagnostic>) -> impl Iterator<Item = (usize, Diagnostic)> + '_ {
        found.into_iter().filter_map(|diagnostic| {
            let file = self.file_at(diagnostic.span)?;
            if self.wanted.is_some_and(|wanted| wanted != file.number) {
                return None;
            }
            Some((file.number, self.in_file(diagnostic, file)))
        })
    }

    fn file_at(&self, span: Span) -> Option<ProgramFile<'a>> {
        let behind = self.files.partition_point(|file| file.start <= span.start as usize);
        self.files.get(behind.checked_sub(1)?).copied()
    }

    fn in_file(&self, mut diagnostic: Diagnostic, file: ProgramFile<'a>) -> Diagnostic {
        let is_alone = self.files.len() == 1;
        if is_alone {
            return diagnostic;
        }
        diagnostic.span = back(diagnostic.span, file.start);
        for related in &mut diagnostic.related {
            let Some(other) = self.file_at(related.span) else { continue };
            related.file = (other.number != file.number).then_some(other.number);
            related.span = back(related.span, other.start);
        }
        // A fix mends the file in which the finding stands; one that reaches beyond is none of it.
        let end = file.start + file.document.len();
        let is_inside = |span: Span| span.start as usize >= file.start && span.end as usize <= end;
        diagnostic.fixes.retain(|fix| fix.edits.iter().all(|edit| is_inside(edit.span)));
        for edit in diagnostic.fixes.iter_mut().flat_map(|fix| &mut fix.edits) {
            edit.span = back(edit.span, file.start);
        }
        diagnostic
    }
}

fn back(span: Span, start: usize) -> Span {
    Span::new(span.start as usize - start, span.end as usize - start)
}
