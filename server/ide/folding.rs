//! Being written.
use super::Fold;
pub(super) fn of(_: &crate::document::Document) -> Vec<Fold> {
    Vec::new()
}
