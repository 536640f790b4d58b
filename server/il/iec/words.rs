//! Words of the language in one spelling, to tell whether two texts say the same.

use super::scan::Scanner;
use super::token::{Region, TokenKind};
use crate::target::iec::Literal;
use crate::text::{Span, folded};
use smol_str::SmolStr;

/// The words of a declaration, or of a part of one: letter case, blanks and comments aside, and literals by what they
/// are: `T#1s` is `t#1000ms`.
pub fn words(text: &str, span: Span) -> SmolStr {
    joined(text, span, Region::Section)
}

/// The same for instructions.
pub fn words_of_body(text: &str, span: Span) -> SmolStr {
    joined(text, span, Region::Body)
}

fn joined(text: &str, span: Span, region: Region) -> SmolStr {
    let text = span.of(text);
    let mut words = String::with_capacity(text.len());
    for token in Scanner::inside(text, region) {
        if token.kind == TokenKind::Newline || token.kind.is_trivia() {
            continue;
        }
        if !words.is_empty() {
            words.push(' ');
        }
        let word = token.span.of(text);
        match Literal::read(word) {
            Ok(literal) => words += &literal.spelled(word),
            Err(_) if token.kind == TokenKind::Text => words += word,
            Err(_) => words += &folded(word),
        }
    }
    words.into()
}
