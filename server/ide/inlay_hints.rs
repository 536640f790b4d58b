//! Being written.
use super::InlayHint;
pub(super) fn within(
    _: &crate::document::Document,
    _: crate::text::Span,
    _: crate::text::Language,
) -> Vec<InlayHint> {
    Vec::new()
}
