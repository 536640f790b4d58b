//! Text to tree.

use super::IecTree;
use crate::target::Target;

/// Reads one chunk for `target`. Never fails: what cannot be read is in [`IecTree::problems`].
pub fn parse(chunk: &str, target: &Target) -> IecTree {
    let _ = (chunk, target);
    IecTree::default()
}
