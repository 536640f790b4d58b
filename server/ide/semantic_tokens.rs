//! Being written.
use super::Token;
pub(super) fn of(_: &crate::document::Document) -> Vec<Token> {
    Vec::new()
}
