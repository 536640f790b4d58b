//! Tokens of a chunk. Words are not looked into here: whether `X0` is a device is a matter of the tables.

use logos::{Lexer, Logos};

/// A token; blanks and byte order marks leave none. What is no token at all comes as an error of the lexer.
#[derive(Logos, Clone, Copy, PartialEq, Eq, Debug)]
#[logos(skip "[ \t\u{feff}]+")]
pub(super) enum Token {
    /// CR LF, LF, or CR alone, which editors count as a line end too.
    #[regex("\r\n|\r|\n")]
    Newline,
    #[token(",")]
    Comma,
    #[token(":")]
    Colon,
    /// A mnemonic without its comparison sign, an operand, a label, a step number.
    #[regex(r"[A-Za-z0-9_$%#@.+\\-]+")]
    #[regex(r"[A-Za-z]+\?")]
    Word,
    /// The sign of a comparing contact: `=`, `<>`, `>=` …
    #[regex("[=<>]+")]
    Compare,
    #[regex(r#""[^"\r\n]*""#)]
    #[regex(r"'[^'\r\n]*'")]
    Text,
    /// A text whose closing quote is missing; it ends with the line.
    #[regex(r#""[^"\r\n]*"#)]
    #[regex(r"'[^'\r\n]*")]
    OpenText,
    #[regex(r";[^\r\n]*", allow_greedy = true)]
    #[regex(r"//[^\r\n]*", allow_greedy = true)]
    LineComment,
    /// `(* … *)`, not nested; the value says whether it was closed before the end of the chunk.
    #[token("(*", block_comment)]
    BlockComment(bool),
}

fn block_comment(lexer: &mut Lexer<'_, Token>) -> bool {
    let rest = lexer.remainder();
    let close = rest.find("*)");
    lexer.bump(close.map_or(rest.len(), |offset| offset + 2));
    close.is_some()
}
