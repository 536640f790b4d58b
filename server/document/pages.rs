//! The sequence of chunks: pages of some dozens each, so that a snapshot copies one pointer a page and an edit
//! rebuilds one page.

use super::allowance::{self, OwnAllowance};
use super::exclusion::{self, Exclusion};
use super::{Accesses, Chunk, Found, Milestone, Names, Proofs, Size, access, chunk, milestone};
use crate::ladder::NameHabit;
use crate::text::Diagnostic;
use std::sync::{Arc, Mutex, OnceLock};

/// A page is split when it would hold more chunks than this.
const PAGE_LIMIT: usize = 96;

/// A run of chunks with what is found in them.
#[derive(Debug)]
pub struct Page {
    chunks: Box<[Arc<Chunk>]>,
    bytes: usize,
    has_iec: bool,
    habit: NameHabit,
    size: OnceLock<Size>,
    names: OnceLock<Arc<Names>>,
    pou_starts: OnceLock<usize>,
    milestones: OnceLock<Arc<[Milestone]>>,
    accesses: OnceLock<Arc<Accesses>>,
    allowances: OnceLock<Arc<[(usize, OwnAllowance)]>>,
    exclusions: OnceLock<Arc<[Exclusion]>>,
    found: chunk::Kept<Found>,
    proofs: chunk::Kept<Proofs>,
}

impl Page {
    fn new(chunks: Box<[Arc<Chunk>]>) -> Arc<Page> {
        let bytes = chunks.iter().map(|chunk| chunk.len()).sum();
        let has_iec = chunks.iter().any(|chunk| chunk.is_iec());
        let mut habit = NameHabit::default();
        chunks.iter().for_each(|chunk| habit += chunk.habit());
        Arc::new(Page {
            chunks,
            bytes,
            has_iec,
            habit,
            size: OnceLock::new(),
            names: OnceLock::new(),
            pou_starts: OnceLock::new(),
            milestones: OnceLock::new(),
            accesses: OnceLock::new(),
            allowances: OnceLock::new(),
            exclusions: OnceLock::new(),
            found: Mutex::new(None),
            proofs: Mutex::new(None),
        })
    }

    /// Its chunks.
    pub fn chunks(&self) -> &[Arc<Chunk>] {
        &self.chunks
    }

    /// Length in bytes.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Whether any of it is IEC declarations or statements.
    pub(super) fn has_iec(&self) -> bool {
        self.has_iec
    }

    /// Where its drawings have their names, as far as their edges tell.
    pub(super) fn habit(&self) -> NameHabit {
        self.habit
    }

    /// How much program it is.
    pub fn size(&self) -> Size {
        *self.size.get_or_init(|| self.chunks.iter().map(|chunk| chunk.size()).sum())
    }

    /// What its chunks name.
    pub fn names(&self) -> &Names {
        self.names.get_or_init(|| Arc::new(Names::of(&self.chunks)))
    }

    /// How many POUs start in it.
    pub fn pou_starts(&self) -> usize {
        let count = || self.chunks.iter().map(|chunk| chunk.pou_starts()).sum();
        if self.has_iec { *self.pou_starts.get_or_init(count) } else { 0 }
    }

    /// Its instructions and labels as far as they matter for the structure of a program, offsets from its start.
    pub fn milestones(&self) -> &[Milestone] {
        self.milestones.get_or_init(|| milestone::of_page(&self.chunks).into())
    }

    /// What its chunks read and drive, offsets from its start.
    pub fn accesses(&self) -> &Accesses {
        self.accesses.get_or_init(|| Arc::new(access::of_page(&self.chunks)))
    }

    /// How the rungs of each of its chunks are put together, with the chunk's number: differs where they may do
    /// something else. Chunks of comments alone have nothing.
    pub fn circuits(&self) -> impl Iterator<Item = (u32, u64)> {
        let chunks = (0..).zip(self.chunks.iter()).filter(|(_, chunk)| !chunk.is_only_comments());
        chunks.map(|(number, chunk)| (number, chunk.circuit()))
    }

    /// The comments that allow something, each with the number of its chunk.
    pub(super) fn allowances(&self) -> &[(usize, OwnAllowance)] {
        self.allowances.get_or_init(|| allowance::of_page(&self.chunks).into())
    }

    /// The comments that exclude something, offsets from its start.
    pub(super) fn exclusions(&self) -> &[Exclusion] {
        self.exclusions.get_or_init(|| exclusion::of_page(&self.chunks).into())
    }

    /// Whether there are diagnostics under `key`.
    pub fn has_found(&self, key: u64) -> bool {
        chunk::is_kept(&self.found, key)
    }

    /// The diagnostics of all its chunks, offsets from the page's start, kept under `key` as those of a chunk are.
    pub fn found(&self, key: u64, find: impl FnOnce() -> Vec<Diagnostic>) -> Found {
        chunk::kept_or(&self.found, key, find)
    }

    /// What the proofs about all its rungs found, offsets from the page's start, if they were made under `key`.
    pub fn proofs(&self, key: u64) -> Option<Proofs> {
        chunk::kept(&self.proofs, key)
    }

    /// Keeps what the proofs found.
    pub fn keep_proofs(&self, key: u64, proofs: Proofs) {
        chunk::keep(&self.proofs, key, proofs);
    }
}

/// The chunks of a document, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Pages {
    pages: Vec<Arc<Page>>,
}

/// A place in the sequence: page, and chunk in the page.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Cursor {
    page: usize,
    chunk: usize,
}

impl Pages {
    pub(super) fn new(chunks: Vec<Arc<Chunk>>) -> Pages {
        Pages::of(paginate(chunks))
    }

    pub(super) fn of(pages: Vec<Arc<Page>>) -> Pages {
        Pages { pages }
    }

    pub(super) fn pages(&self) -> &[Arc<Page>] {
        &self.pages
    }

    /// The same chunks without trees that are not kept.
    pub(super) fn lean(&self) -> Pages {
        let lean = |chunk: &Arc<Chunk>| match chunk.keeps_tree() {
            true => chunk.clone(),
            false => Arc::new(chunk.lean()),
        };
        let lean_page = |page: &Arc<Page>| match page.chunks.iter().all(|chunk| chunk.keeps_tree()) {
            true => page.clone(),
            false => Arc::new(Page {
                chunks: page.chunks.iter().map(lean).collect(),
                bytes: page.bytes,
                has_iec: page.has_iec,
                habit: page.habit,
                size: page.size.clone(),
                names: page.names.clone(),
                pou_starts: page.pou_starts.clone(),
                milestones: page.milestones.clone(),
                accesses: page.accesses.clone(),
                allowances: page.allowances.clone(),
                exclusions: page.exclusions.clone(),
                found: Mutex::new(None),
                proofs: Mutex::new(None),
            }),
        };
        Pages { pages: self.pages.iter().map(lean_page).collect() }
    }

    pub(super) fn get(&self, at: Cursor) -> Option<&Arc<Chunk>> {
        self.pages.get(at.page)?.chunks.get(at.chunk)
    }

    /// The chunk that contains `offset`, or the last one for the end of the text, with its start.
    pub(super) fn locate(&self, offset: usize) -> Option<(Cursor, usize)> {
        let mut start = 0;
        for (page_number, page) in self.pages.iter().enumerate() {
            let last_page = page_number + 1 == self.pages.len();
            if offset >= start + page.bytes && !last_page {
                start += page.bytes;
                continue;
            }
            for (chunk_number, chunk) in page.chunks.iter().enumerate() {
                let last = last_page && chunk_number + 1 == page.chunks.len();
                if offset < start + chunk.len() || last {
                    return Some((Cursor { page: page_number, chunk: chunk_number }, start));
                }
                start += chunk.len();
            }
        }
        None
    }

    pub(super) fn next(&self, at: Cursor) -> Option<Cursor> {
        if at.chunk + 1 < self.pages.get(at.page)?.chunks.len() {
            return Some(Cursor { chunk: at.chunk + 1, ..at });
        }
        (at.page + 1 < self.pages.len()).then_some(Cursor { page: at.page + 1, chunk: 0 })
    }

    pub(super) fn previous(&self, at: Cursor) -> Option<Cursor> {
        if at.chunk > 0 {
            return Some(Cursor { chunk: at.chunk - 1, ..at });
        }
        let page = at.page.checked_sub(1)?;
        Some(Cursor { page, chunk: self.pages[page].chunks.len() - 1 })
    }

    /// The chunks from `first` to `last`, both included.
    pub(super) fn between(&self, first: Cursor, last: Cursor) -> Vec<Arc<Chunk>> {
        let mut chunks = Vec::new();
        let mut at = Some(first);
        while let Some(cursor) = at.filter(|cursor| *cursor <= last) {
            chunks.extend(self.get(cursor).cloned());
            at = self.next(cursor);
        }
        chunks
    }

    /// Puts `new` in the place of the chunks from `first` to `last`, both included.
    pub(super) fn replace(&mut self, first: Cursor, last: Cursor, new: Vec<Arc<Chunk>>) {
        let head = &self.pages[first.page].chunks[..first.chunk];
        let tail = &self.pages[last.page].chunks[last.chunk + 1..];
        let mut chunks = Vec::with_capacity(head.len() + new.len() + tail.len());
        chunks.extend_from_slice(head);
        chunks.extend(new);
        chunks.extend_from_slice(tail);
        // A page that shrank to a few chunks joins its neighbour, lest many deletions leave many small pages.
        let mut pages = first.page..last.page + 1;
        if chunks.len() < PAGE_LIMIT / 8 && pages.end < self.pages.len() {
            chunks.extend_from_slice(&self.pages[pages.end].chunks);
            pages.end += 1;
        }
        self.pages.splice(pages, paginate(chunks));
    }
}

/// The pages of `chunks`, in order.
pub(super) fn paginate(chunks: Vec<Arc<Chunk>>) -> Vec<Arc<Page>> {
    let mut pages = Vec::with_capacity(chunks.len() / (PAGE_LIMIT / 2) + 1);
    let mut rest = chunks.len();
    let mut chunks = chunks.into_iter();
    while rest > 0 {
        let count = if rest > PAGE_LIMIT { PAGE_LIMIT * 2 / 3 } else { rest };
        pages.push(Page::new(chunks.by_ref().take(count).collect()));
        rest -= count;
    }
    pages
}
