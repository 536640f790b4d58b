//! Being written.
use super::SymbolNode;
pub(super) fn of(_: &crate::document::Document, _: crate::text::Language) -> Vec<SymbolNode> {
    Vec::new()
}
