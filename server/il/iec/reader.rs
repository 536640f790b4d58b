//! What all parts of the parser share: the tokens of the chunk, the tree as it grows, and the problems found.

use super::grammar::Mismatch;
use super::scan::Scanner;
use super::token::{Region, Token, TokenKind};
use super::{IecTree, Item, ItemKind, OperandId};
use crate::target::{Model, Operand, iec};
use crate::text::{Diagnostic, Message, Severity, Span, Spanned, TextEdit};

/// The tokens of a chunk and the tree that they become.
pub struct Reader<'a> {
    pub text: &'a str,
    /// All tokens but comments and pragmas.
    pub tokens: Vec<Token>,
    /// Index of the next token.
    pub at: usize,
    pub tree: IecTree,
}

impl<'a> Reader<'a> {
    /// Comments and pragmas go straight into the tree, and so do those that do not end.
    pub fn new(text: &'a str) -> Reader<'a> {
        let mut reader = Reader { text, tokens: Vec::new(), at: 0, tree: IecTree::default() };
        for token in Scanner::new(text) {
            match token.kind {
                TokenKind::Comment => reader.tree.comments.push(token.span),
                TokenKind::Pragma => reader.tree.pragmas.push(token.span),
                TokenKind::SemicolonComment => {
                    reader.tree.comments.push(token.span);
                    let start = Span::new(token.span.start as usize, token.span.start as usize + 1);
                    reader.hint(start, "lenient-form.semicolon-comment");
                }
                TokenKind::UnclosedComment => {
                    reader.tree.comments.push(token.span);
                    reader.unclosed_comment(token.span);
                }
                TokenKind::UnclosedPragma => {
                    reader.tree.pragmas.push(token.span);
                    let open = Span::new(token.span.start as usize, token.span.start as usize + 1);
                    reader.problem("unclosed-comment", open, Message::new("unclosed-comment.pragma"));
                }
                _ => reader.tokens.push(token),
            }
        }
        reader
    }

    pub fn peek(&self) -> Option<Token> {
        self.tokens.get(self.at).copied()
    }

    /// The kind of the token `ahead` of the next one, of any region.
    pub fn kind(&self, ahead: usize) -> Option<TokenKind> {
        self.tokens.get(self.at + ahead).map(|token| token.kind)
    }

    /// The next token if it is in a body and of this kind; it is then consumed.
    pub fn take(&mut self, kind: TokenKind) -> Option<Token> {
        let token = self.peek().filter(|token| token.kind == kind && token.region == Region::Body)?;
        self.at += 1;
        Some(token)
    }

    /// Whether the token at `index` is the first one of its line.
    pub fn starts_line(&self, index: usize) -> bool {
        index == 0 || self.tokens.get(index - 1).is_none_or(|token| token.kind == TokenKind::Newline)
    }

    /// The tokens from the next one to the end of its line.
    pub fn rest_of_line(&self) -> &[Token] {
        let rest = self.tokens.get(self.at..).unwrap_or(&[]);
        // No decision looks further than this, and a line may be long.
        let near = rest.get(..8).unwrap_or(rest);
        let end = near.iter().position(|token| token.kind == TokenKind::Newline).unwrap_or(near.len());
        &near[..end]
    }

    pub fn word(&self, span: Span) -> &'a str {
        span.of(self.text)
    }

    /// Whether the token at `index` is the word `NOT`, which is no keyword.
    pub fn is_not(&self, index: usize) -> bool {
        self.tokens.get(index).is_some_and(|token| {
            token.kind == TokenKind::Word && self.word(token.span).eq_ignore_ascii_case("NOT")
        })
    }

    pub fn push_item(&mut self, span: Span, depth: usize, kind: ItemKind) -> usize {
        self.tree.items.push(Item { span, depth: depth as u32, kind });
        self.tree.items.len() - 1
    }

    pub fn push_operand(&mut self, span: Span, operand: Operand) -> OperandId {
        self.tree.operands.push(Spanned::new(operand, span));
        OperandId(self.tree.operands.len() as u32 - 1)
    }

    /// Reads `span` as one operand word.
    pub fn read_operand(&mut self, span: Span) -> OperandId {
        let operand = Operand::read(self.word(span), Model::Iec);
        self.push_operand(span, operand)
    }

    pub fn problem(&mut self, code: &'static str, span: Span, message: Message) {
        self.tree.problems.push(Diagnostic::new(code, span, message));
    }

    /// Something is read although the standard's grammar does not allow it.
    pub fn hint(&mut self, span: Span, key: &'static str) {
        self.hint_with(span, Message::new(key));
    }

    /// A semicolon where none is wanted.
    pub fn stray_semicolon(&mut self, span: Span) {
        let hint = Diagnostic::new("lenient-form", span, Message::new("lenient-form.stray-semicolon"));
        let hint = hint.fix(Message::new("lenient-form.remove-semicolon"), vec![TextEdit::new(span, "")]);
        self.tree.problems.push(Diagnostic { severity: Severity::Hint, ..hint });
    }

    pub fn hint_with(&mut self, span: Span, message: Message) {
        let hint = Diagnostic::new("lenient-form", span, message);
        self.tree.problems.push(Diagnostic { severity: Severity::Hint, ..hint });
    }

    /// At `token` stands something else than what is expected; without a token, at the end of what was read.
    pub fn expected(&mut self, token: Option<Token>, expected: &str) {
        let Some(found) = token.filter(|token| token.kind != TokenKind::Newline) else {
            // The end of a line is shown at the word before it, where the missing one belongs.
            let before = self.end_of_word_before(token);
            return self.expected_at_end(before, expected);
        };
        let word = self.word(found.span);
        if expected.split(", ").any(|one| one == "identifier") && iec::is_keyword(word) {
            return self.check_name(found.span);
        }
        let message = Message::new("syntax-error.expected")
            .with_alternatives("expected", expected.split(", "))
            .with("found", shortened(word));
        self.problem("syntax-error", found.span, message);
    }

    fn end_of_word_before(&self, token: Option<Token>) -> Span {
        let limit = token.map_or(u32::MAX, |token| token.span.start);
        let index = self.tokens.partition_point(|token| token.span.start < limit);
        let before = self.tokens.get(..index).unwrap_or(&[]);
        let word = before.iter().rev().find(|token| token.kind != TokenKind::Newline);
        word.map_or(Span::at(0), |token| Span::at(token.span.end as usize))
    }

    /// What the grammar of declarations says about `tokens`, one of which it could not take.
    pub fn mismatch(&mut self, tokens: &[Token], mismatch: &Mismatch) {
        self.expected_in(tokens, mismatch.at, &list_of(mismatch.expected()));
    }

    /// At index `at` of `tokens`, a piece of a declaration, stands something else than what is expected. If it is
    /// the first word of a line, what is missing is missed at the end of the line before.
    pub fn expected_in(&mut self, tokens: &[Token], at: usize, expected: &str) {
        let token = tokens.get(at).copied();
        let index =
            token.map(|token| self.tokens.partition_point(|other| other.span.start < token.span.start));
        let before =
            at.checked_sub(1).and_then(|before| tokens.get(before.min(tokens.len().saturating_sub(1))));
        match (token, before) {
            (Some(_), Some(before)) if index.is_some_and(|index| self.starts_line(index)) => {
                self.expected_at_end(before.span, expected);
            }
            (Some(token), _) => self.expected(Some(token), expected),
            (None, before) => self.expected_at_end(before.map_or(Span::at(0), |token| token.span), expected),
        }
    }

    /// Something is expected behind `before`, where a line or a text ends.
    pub fn expected_at_end(&mut self, before: Span, expected: &str) {
        let message =
            Message::new("syntax-error.expected-at-end").with_alternatives("expected", expected.split(", "));
        self.problem("syntax-error", Span::at(before.end as usize), message);
    }

    /// Reports a declared name that breaks the rules for names: keywords, and underscores in wrong places.
    pub fn check_name(&mut self, span: Span) {
        let word = self.word(span);
        if iec::is_keyword(word) {
            let message =
                Message::new("syntax-error.keyword-as-name").with("name", word.to_ascii_uppercase());
            self.problem("syntax-error", span, message);
        } else if !iec::is_identifier(word) {
            let message = Message::new("syntax-error.name-form").with("name", word);
            self.problem("syntax-error", span, message);
        }
    }

    fn unclosed_comment(&mut self, span: Span) {
        let start = span.start as usize;
        let open = Span::new(start, start + 2);
        let inner = span.of(self.text).get(2..).and_then(|rest| rest.find(open.of(self.text)));
        let mut diagnostic =
            Diagnostic::new("unclosed-comment", open, Message::new("unclosed-comment.comment"));
        if let Some(inner) = inner {
            // Often the comment does end, but for another one inside it that does not.
            let inner = Span::new(start + 2 + inner, start + 4 + inner);
            diagnostic = diagnostic.related(inner, Message::new("unclosed-comment.nested"));
        }
        self.tree.problems.push(diagnostic);
    }
}

/// What begins with any of many words, so that a message names that and not each of them: the words by which it is
/// known, and those which it takes along.
const BEGINNINGS: &[(&str, &[&str], &[&str])] = &[
    ("type", &["identifier", "`ARRAY`", "`STRING`"], &["`(`", "`STRUCT`", "`REF_TO`", "`WSTRING`"]),
    ("value", &["identifier", "constant"], &["`(`", "`[`"]),
];

/// The names of kinds of tokens for a message, each once.
pub fn list_of(kinds: impl IntoIterator<Item = TokenKind>) -> String {
    let mut names: Vec<String> = Vec::new();
    for kind in kinds {
        let name = kind.quoted();
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let has = |name: &&str| names.iter().any(|own| own == name);
    if let Some((whole, known, along)) = BEGINNINGS.iter().find(|(_, known, _)| known.iter().all(has)) {
        names.retain(|name| ![known, along].iter().any(|words| words.contains(&name.as_str())));
        names.push(whole.to_string());
    }
    names.join(", ")
}

/// A word for a message; texts and runs of strange characters can be long.
fn shortened(word: &str) -> String {
    const MOST: usize = 24;
    let line = word.lines().next().unwrap_or("");
    if line.chars().count() <= MOST {
        return line.to_string();
    }
    line.chars().take(MOST).chain(['…']).collect()
}
