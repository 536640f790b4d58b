//! Texts in single and double quotes, and their `$` sequences.

use super::{ElementaryType, LiteralProblem, LiteralValue};

/// A single-byte text, `'…'`, with `$hh` for a character by its code.
pub fn single(word: &str) -> Result<(), LiteralProblem> {
    characters(word, '\'', 2).map(|_| ())
}

/// A double-byte text, `"…"`, with `$hhhh` for a character by its code.
pub fn double(word: &str) -> Result<(), LiteralProblem> {
    characters(word, '"', 4).map(|_| ())
}

/// What stands after `STRING#`, `WSTRING#`, `CHAR#` or `WCHAR#`. A character type takes exactly one character.
pub fn typed(kind: ElementaryType, rest: &str) -> Result<LiteralValue, LiteralProblem> {
    let wide = matches!(kind, ElementaryType::Wstring | ElementaryType::Wchar);
    let quote = if wide { '"' } else { '\'' };
    if !rest.starts_with(quote) {
        // The other quote is a text of the other width, anything else no text.
        return Err(if rest.is_empty() { LiteralProblem::Form } else { LiteralProblem::Type });
    }
    let count = characters(rest, quote, if wide { 4 } else { 2 })?;
    if matches!(kind, ElementaryType::Char | ElementaryType::Wchar) && count != 1 {
        return Err(LiteralProblem::Range);
    }
    Ok(if wide { LiteralValue::WideText } else { LiteralValue::Text })
}

/// How many characters stand between the quotes; `$` sequences count one. They are `$$`, `$` with the quote, the
/// letters L N P R T in either case, and as many hexadecimal digits as a character code has.
fn characters(word: &str, quote: char, code_digits: usize) -> Result<usize, LiteralProblem> {
    let mut rest = word.chars();
    let mut count = 0;
    if rest.next() != Some(quote) {
        return Err(LiteralProblem::Text);
    }
    loop {
        match rest.next() {
            Some('$') => {
                let escaped = rest.next().ok_or(LiteralProblem::Text)?;
                let letter =
                    escaped == '$' || escaped == quote || "LNPRT".contains(escaped.to_ascii_uppercase());
                // The first digit is consumed already.
                let code = escaped.is_ascii_hexdigit()
                    && (1..code_digits).all(|_| rest.next().is_some_and(|digit| digit.is_ascii_hexdigit()));
                if !letter && !code {
                    return Err(LiteralProblem::Text);
                }
            }
            Some('\n' | '\r') | None => return Err(LiteralProblem::Text),
            Some(character) if character == quote => break,
            Some(_) => {}
        }
        count += 1;
    }
    if rest.as_str().is_empty() { Ok(count) } else { Err(LiteralProblem::Text) }
}
