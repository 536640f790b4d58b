//! The program unit around the cursor, and what is named in it.

use crate::document::{Document, Mention, ProjectView, Symbol, Unit, Use};
use crate::text::folded;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// How often something is named.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Tally {
    /// Where it is used; declarations of variables left out, those of labels among them.
    pub mentions: usize,
    pub writes: usize,
}

impl Unit {
    /// How often `symbol` is named in it.
    pub(super) fn tally(self, document: &Document, symbol: &Symbol) -> Tally {
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
    pub(super) fn names(self, document: &Document) -> FxHashSet<SmolStr> {
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
