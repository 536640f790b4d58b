//! Replacements of text.

use super::Span;

/// Replace the bytes of `span` by `text`.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct TextEdit {
    /// What is replaced; empty for an insertion.
    pub span: Span,
    /// What stands there afterwards.
    pub text: String,
}

impl TextEdit {
    /// Replace `span` by `text`.
    pub fn new(span: Span, text: impl Into<String>) -> TextEdit {
        TextEdit { span, text: text.into() }
    }

    /// The same edit in a text in which `by` bytes stand before this one's text.
    pub fn shifted(&self, by: usize) -> TextEdit {
        TextEdit { span: self.span.shifted(by), text: self.text.clone() }
    }

    /// `text` after all `edits`, which must not overlap; they may come in any order.
    pub fn apply_all(edits: &[TextEdit], text: &str) -> String {
        let mut edits: Vec<&TextEdit> = edits.iter().collect();
        edits.sort_by_key(|edit| edit.span);
        let mut result = String::with_capacity(text.len());
        let mut copied = 0;
        for edit in edits {
            result.push_str(text.get(copied..edit.span.start as usize).unwrap_or(""));
            result.push_str(&edit.text);
            copied = edit.span.end as usize;
        }
        result.push_str(text.get(copied..).unwrap_or(""));
        result
    }
}
