//! Being written.
use super::Hover;
pub(super) fn at(_: &crate::document::Document, _: usize, _: crate::text::Language) -> Option<Hover> {
    None
}
