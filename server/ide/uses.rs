//! Where a thing is used, in words: `Written: lines 3, 7`.

use super::names::{self, Named, Thing};
use crate::document::{Document, Use};
use crate::text::{Language, Message};

/// So many lines are named, the rest is counted.
const SHOWN: usize = 8;

/// Lines of one kind of use.
#[derive(Default)]
struct Lines {
    shown: Vec<u32>,
    more: usize,
}

/// The uses of `thing` as a Markdown list; `see` is called for every place.
pub(super) fn of(
    document: &Document,
    thing: &Thing,
    language: Language,
    mut see: impl FnMut(&Named<'_>),
) -> String {
    let [mut declared, mut jumps, mut writes, mut reads] = <[Lines; 4]>::default();
    names::visit(document, thing, |place| {
        see(&place);
        let offset = place.span.start as usize;
        match place.usage {
            Use::Declare => declared.add(document, offset),
            Use::Jump => jumps.add(document, offset),
            usage => {
                if usage.writes() {
                    writes.add(document, offset);
                }
                if usage.reads() {
                    reads.add(document, offset);
                }
            }
        }
    });
    let declared_key = if thing.is_label() { "hover.defined" } else { "hover.declared" };
    let parts = [
        (Message::new(declared_key), declared),
        (Message::new("hover.writes"), writes),
        (Message::new("hover.reads"), reads),
        (Message::new("hover.jumps"), jumps),
    ];
    let rows = parts.into_iter().filter(|(_, lines)| !lines.shown.is_empty());
    let rows: Vec<String> = rows
        .map(|(title, lines)| format!("- {}", title.with("lines", lines.words(language)).render(language)))
        .collect();
    rows.join("\n")
}

impl Lines {
    fn add(&mut self, document: &Document, offset: usize) {
        if self.shown.len() >= SHOWN {
            self.more += 1;
            return;
        }
        let line = document.line_of(offset) + 1;
        if self.shown.last() != Some(&line) {
            self.shown.push(line);
        }
    }

    fn words(&self, language: Language) -> String {
        let numbers: Vec<String> = self.shown.iter().map(u32::to_string).collect();
        let message = match (numbers.len(), self.more) {
            (1, 0) => Message::new("hover.line"),
            (_, 0) => Message::new("hover.lines"),
            _ => Message::new("hover.lines-more").with("count", self.more),
        };
        message.with("numbers", numbers.join(", ")).render(language)
    }
}
