//! Runs the rules that need proofs, rung by rung, so that what is found is told soon and work ends soon that nobody
//! waits for any more.

use super::engine::key;
use super::proof::{Prover, Thrift};
use super::{ChunkContext, RULES, Run};
use crate::document::{Chunk, Document, LIMIT_BYTES, Page, Proofs};
use crate::text::Diagnostic;

/// The proofs about all rungs of a program may be so much work, counted as proofs count it: about a second. Of the
/// rungs behind, only what little work proves is found.
const PROGRAM: usize = 4_000_000;

/// What proofs find in `document`, by place; `tell` gets it page by page. Nothing if `is_cancelled` says on the way
/// that nobody waits for it any more.
pub(super) fn of(
    document: &Document,
    is_cancelled: &dyn Fn() -> bool,
    tell: &mut dyn FnMut(&[Diagnostic]),
) -> Option<Vec<Diagnostic>> {
    let mut all = Vec::new();
    if document.len() > LIMIT_BYTES {
        return Some(all);
    }
    let mut walk = Walk { document, is_cancelled, left: PROGRAM };
    let (mut start, mut pou_number) = (0, 0);
    for page in document.pages() {
        let found = walk.page(page, pou_number)?.found;
        let known = all.len();
        all.extend(found.iter().map(|diagnostic| diagnostic.shifted(start)));
        if all.len() > known {
            tell(&all[known..]);
        }
        start += page.bytes();
        pou_number += page.pou_starts();
    }
    Some(all)
}

struct Walk<'a> {
    document: &'a Document,
    is_cancelled: &'a dyn Fn() -> bool,
    /// The work that may still be done. What is known already counts as if it were found anew, so that the findings
    /// depend on the text alone and not on the edits that led to it.
    left: usize,
}

impl Walk<'_> {
    /// The findings in a page, offsets from its start.
    fn page(&mut self, page: &Page, mut pou_number: usize) -> Option<Proofs> {
        let page_key = key(self.document, pou_number);
        if let Some(known) = page.proofs(page_key).filter(|known| known.effort <= self.left) {
            self.left -= known.effort;
            return Some(known);
        }
        let (mut found, mut effort, mut is_whole) = (Vec::new(), 0, true);
        let mut start = 0;
        for chunk in page.chunks() {
            pou_number += chunk.pou_starts();
            let is_ample = self.left > 0;
            let proofs = self.chunk(chunk, pou_number)?;
            is_whole &= is_ample || proofs.effort == 0;
            self.left = self.left.saturating_sub(proofs.effort);
            effort += proofs.effort;
            found.extend(proofs.found.iter().map(|diagnostic| diagnostic.shifted(start)));
            start += chunk.len();
        }
        let proofs = Proofs { found: found.into(), effort };
        if is_whole {
            page.keep_proofs(page_key, proofs.clone());
        }
        Some(proofs)
    }

    /// The findings in a chunk.
    fn chunk(&self, chunk: &Chunk, pou_number: usize) -> Option<Proofs> {
        if (self.is_cancelled)() {
            return None;
        }
        let key = key(self.document, pou_number);
        let thrift = if self.left > 0 { Thrift::Ample } else { Thrift::Scarce };
        let is_of_use = |known: &Proofs| known.effort == 0 || thrift == Thrift::Ample;
        if let Some(known) = chunk.proofs(key).filter(is_of_use) {
            return Some(known);
        }
        let key = key.wrapping_add(thrift as u64);
        if let Some(known) = chunk.proofs(key) {
            return Some(known);
        }
        let reading = chunk.reading();
        let pou = pou_number.checked_sub(1);
        let mut prover = Prover::new(thrift, self.is_cancelled);
        judge(&ChunkContext::new(&reading, self.document, pou), &mut prover);
        for (start, list) in chunk.boxes() {
            let context = ChunkContext::of_box(list, self.document, pou);
            prover.inside(*start, |prover| judge(&context, prover));
        }
        let proofs = prover.finished()?;
        chunk.keep_proofs(key, proofs.clone());
        Some(proofs)
    }
}

fn judge(context: &ChunkContext<'_>, prover: &mut Prover<'_>) {
    for rule in RULES.iter() {
        if let Run::Proof(judge) = rule.run {
            judge(context, prover);
        }
    }
}
