//! How far something long with a PLC is, where the client shows that.

use super::super::progress::Progress as Bar;
use crate::link::{Progress, Stage};
use crate::text::Language;

/// A bar that shows stages up to the last one, one behind the other.
#[derive(Clone, Copy)]
pub(super) struct Shown<'a> {
    /// The bar.
    pub bar: &'a Bar,
    /// The stage that ends it.
    pub last: Stage,
    /// Of its words.
    pub language: Language,
}

impl Shown<'_> {
    /// All stages in percent; the bytes of this one in words, and how long it will take.
    pub(super) fn report(&self, progress: Progress) {
        let done = progress.done * 100 / progress.total.max(1);
        let (before, all) = (progress.stage as usize, self.last as usize + 1);
        let words = || Some(progress.message().render(self.language));
        self.bar.report_in_words(before * 100 + done, all * 100, words);
    }
}
