//! Text to tree.

use super::IecTree;
use super::body::BodyReader;
use super::reader::Reader;
use crate::target::Target;

/// Reads one chunk for `target`. Never fails: what cannot be read is in [`IecTree::problems`], in the order of the
/// text.
///
/// The language is the same on every target; what a target does not have is the rules' matter.
pub fn parse(chunk: &str, _target: &Target) -> IecTree {
    let mut tree = BodyReader::new(Reader::new(chunk)).read().tree;
    tree.problems.sort_by_key(|problem| problem.span);
    tree
}
