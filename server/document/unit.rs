//! Program units of IEC 61131-3 in a document: which one holds a byte, and what stands in it.

use super::{Chunk, Document, Names};
use crate::text::Span;

/// A program unit of IEC 61131-3, or what stands before the first one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Unit {
    /// Its number; nothing before the first one.
    pub number: Option<usize>,
    /// How many units start before its first chunk.
    pub before: usize,
    /// The bytes of its chunks in the document.
    pub span: Span,
}

impl Document {
    /// The unit of the chunk at a byte. Only pages in which units start are entered.
    pub fn unit_at(&self, offset: usize) -> Unit {
        let (mut first, mut before, mut count) = (0, 0, 0_usize);
        let mut page_start = 0;
        let unit = |first, before, count: usize, end| {
            let number = count.checked_sub(1);
            Unit { number, before, span: Span::new(first, end) }
        };
        for page in self.pages() {
            let mut start = page_start;
            page_start += page.bytes();
            if page.pou_starts() == 0 {
                continue;
            }
            for chunk in page.chunks() {
                if chunk.pou_starts() > 0 {
                    if start > offset {
                        return unit(first, before, count, start);
                    }
                    (first, before) = (start, count);
                    count += chunk.pou_starts();
                }
                start += chunk.len();
            }
        }
        unit(first, before, count, self.len())
    }
}

impl Unit {
    /// How many units have started where its instructions stand.
    pub fn started(self) -> usize {
        self.number.map_or(0, |number| number + 1)
    }

    /// Calls `see` with its chunks, and where they start, in the pages of which `wanted` says yes.
    pub fn each_part<'d>(
        self,
        document: &'d Document,
        wanted: &dyn Fn(&Names) -> bool,
        see: &mut dyn FnMut(usize, &'d Chunk),
    ) {
        let mut page_start = 0;
        for page in document.pages() {
            let mut start = page_start;
            page_start += page.bytes();
            if start >= self.span.end as usize {
                break;
            }
            if page_start <= self.span.start as usize || !wanted(page.names()) {
                continue;
            }
            for chunk in page.chunks() {
                if self.span.start as usize <= start && start < self.span.end as usize {
                    see(start, chunk);
                }
                start += chunk.len();
            }
        }
    }
}
