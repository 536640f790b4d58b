//! Being written.
use crate::document::Document;
use crate::text::{Message, Span, TextEdit};
pub(super) fn renamable(_: &Document, _: usize) -> Option<Span> {
    None
}
pub(super) fn rename(_: &Document, _: usize, _: &str) -> Result<Vec<TextEdit>, Message> {
    Ok(Vec::new())
}
