//! The program unit around the cursor, and what is named in it.

use crate::document::{Chunk, Document, Mention, Names, ProjectView, Symbol, Use};
use crate::text::{Span, folded};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// A program unit of IEC 61131-3, or what stands before the first one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Unit {
    /// Its number; nothing before the first one.
    pub number: Option<usize>,
    /// The bytes of its chunks in the document.
    pub span: Span,
}

/// How often something is named.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Tally {
    /// Where it is used; declarations of variables left out, those of labels among them.
    pub mentions: usize,
    pub writes: usize,
}

impl Unit {
    /// The unit of the chunk at a byte of `document`. Only pages in which units start are entered.
    pub fn at(document: &Document, offset: usize) -> Unit {
        let (mut first, mut count, mut page_start) = (0, 0_usize, 0);
        for page in document.pages() {
            let mut start = page_start;
            page_start += page.bytes();
            if page.pou_starts() == 0 {
                continue;
            }
            for chunk in page.chunks() {
                if chunk.pou_starts() > 0 {
                    if start > offset {
                        return Unit { number: count.checked_sub(1), span: Span::new(first, start) };
                    }
                    count += chunk.pou_starts();
                    first = start;
                }
                start += chunk.len();
            }
        }
        Unit { number: count.checked_sub(1), span: Span::new(first, document.len()) }
    }

    /// How often `symbol` is named in it.
    pub fn tally(self, document: &Document, symbol: &Symbol) -> Tally {
        let mut tally = Tally::default();
        self.each_part(document, &|names| names.contains(symbol), &mut |_, chunk| {
            for mention in chunk.mentions().iter().filter(|mention| mention.symbol == *symbol) {
                tally.mentions += usize::from(is_use(mention));
                tally.writes += usize::from(mention.usage.writes());
            }
        });
        tally
    }

    /// All names of variables, labels, types and program units in it, folded.
    pub fn names(self, document: &Document) -> FxHashSet<SmolStr> {
        let mut names = FxHashSet::default();
        self.each_part(document, &|_| true, &mut |_, chunk| {
            for mention in chunk.mentions() {
                if let Symbol::Variable(name) | Symbol::Label(name) | Symbol::Pou(name) | Symbol::Type(name) =
                    &mention.symbol
                {
                    names.insert(name.clone());
                }
            }
        });
        names
    }

    /// Calls `see` with the chunks of the unit, and where they start, in the pages of which `wanted` says yes.
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

/// Whether something is done with what is named, or a label stands there.
pub(super) fn is_use(mention: &Mention) -> bool {
    mention.usage != Use::Declare || matches!(mention.symbol, Symbol::Label(_))
}

/// Whether somewhere in the project a part of something has this name: `pump.Relay1`. Who calls a function block may
/// ask for its variables so, and the access paths of a configuration do.
pub(super) fn is_member(view: &ProjectView<'_>, name: &str) -> bool {
    let wanted = folded(name);
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    view.members().iter().flat_map(|member| member.document.chunks()).any(|at| {
        let text = at.chunk.text();
        text.match_indices('.').any(|(dot, _)| {
            let rest = &text[dot + 1..];
            let end = rest.find(|c: char| !is_part(c)).unwrap_or(rest.len());
            end == wanted.len() && folded(&rest[..end]) == wanted
        })
    })
}
