//! Reads sections of variables and TYPE blocks: runs the grammar over one declaration after the other, goes on behind
//! each mistake, and flattens what the grammar gives into the tree.

use super::grammar::{self, DeclarationNode, Kinds, MOST_NESTING, Mismatch, Tokens};
use super::lower::{Lowering, append, span_of};
use super::reader::Reader;
use super::token::{Token, TokenKind};
use super::{ItemKind, Run, SectionKind, TypeId};
use crate::text::{Message, Span};
use chumsky::extra;
use chumsky::prelude::*;

/// The tokens of a section, a TYPE block or a configuration, without ends of lines.
#[derive(Default)]
pub struct Block {
    pub tokens: Vec<Token>,
    /// The kinds of `tokens`, which is all that the grammar sees.
    pub kinds: Vec<TokenKind>,
    /// Whether each token is the first of its line.
    pub starts_line: Vec<bool>,
    /// Index of the last semicolon.
    last_semicolon: Option<usize>,
}

/// How many tokens the grammar is shown where no semicolon follows any more.
const MOST_UNFINISHED: usize = 1024;

type Grammar<'s> = Boxed<'s, 's, Kinds<'s>, DeclarationNode, extra::Err<Mismatch>>;

impl Block {
    /// All tokens from the next one on that stand in the same region; they are consumed.
    pub fn take(reader: &mut Reader) -> Block {
        let mut block = Block::default();
        let Some(first) = reader.peek() else { return block };
        while let Some(token) = reader.peek().filter(|token| token.region == first.region) {
            let starts_line = reader.starts_line(reader.at);
            // A region that lacks its end may be followed by one of the same kind.
            let again = token.kind.opens_section() && first.kind.opens_section() || token.kind == first.kind;
            if !block.kinds.is_empty() && again && starts_line {
                break;
            }
            reader.at += 1;
            if token.kind != TokenKind::Newline {
                block.tokens.push(token);
                block.kinds.push(token.kind);
                block.starts_line.push(starts_line);
                if token.kind == closing(first.kind) {
                    break;
                }
            }
        }
        block.last_semicolon = block.kinds.iter().rposition(|kind| *kind == TokenKind::Semicolon);
        block
    }

    pub fn span(&self, tokens: Tokens) -> Span {
        span_of(&self.tokens, tokens)
    }

    pub fn token_span(&self, index: usize) -> Span {
        self.span((index..index + 1).into())
    }

    /// Index behind the semicolon that ends the declaration or statement starting at `from`. The grammar walks through
    /// all that it is shown, so it is shown no more than this, lest a long section take a time that is quadratic.
    pub fn reach(&self, from: usize, end: usize) -> usize {
        let finished = self.last_semicolon.is_some_and(|last| from <= last && last < end);
        let most = if finished { end } else { end.min(from + MOST_UNFINISHED) };
        let mut structures = 0usize;
        for index in from..most {
            match self.kinds[index] {
                TokenKind::Struct => structures += 1,
                TokenKind::EndStruct => structures = structures.saturating_sub(1),
                TokenKind::Semicolon if structures == 0 => return index + 1,
                _ => {}
            }
        }
        most
    }

    /// Index of the first token at or after `from` with which a declaration can start over, which is behind the
    /// next semicolon, or at the next line that looks like a declaration.
    pub fn next_start(&self, from: usize, end: usize) -> usize {
        let mut structures = 0usize;
        for index in from..end {
            match self.kinds[index] {
                TokenKind::Struct => structures += 1,
                TokenKind::EndStruct => structures = structures.saturating_sub(1),
                TokenKind::Semicolon if structures == 0 => return index + 1,
                TokenKind::Word if index > from && self.starts_line[index] && structures == 0 => {
                    let next = self.kinds.get(index + 1);
                    if matches!(next, Some(TokenKind::Colon | TokenKind::Comma | TokenKind::At)) {
                        return index;
                    }
                }
                TokenKind::Task | TokenKind::Program | TokenKind::Resource if index > from => return index,
                kind if index > from && (kind.opens_section() || kind.closes()) => return index,
                _ => {}
            }
        }
        end
    }

    /// Whether the declaration that starts at `from` nests deeper than the grammar may follow.
    pub fn nests_too_deep(&self, from: usize, end: usize) -> bool {
        let (mut open, mut chained) = (0usize, 0usize);
        for kind in &self.kinds[from..end] {
            match kind {
                TokenKind::LeftParenthesis | TokenKind::LeftBracket | TokenKind::Struct => open += 1,
                TokenKind::RightParenthesis | TokenKind::RightBracket | TokenKind::EndStruct => {
                    open = open.saturating_sub(1);
                }
                TokenKind::Of | TokenKind::RefTo => chained += 1,
                TokenKind::Semicolon if open == 0 => return false,
                TokenKind::Semicolon => chained = 0,
                _ => {}
            }
            if open + chained > MOST_NESTING {
                return true;
            }
        }
        false
    }
}

fn closing(opening: TokenKind) -> TokenKind {
    match opening {
        TokenKind::Type => TokenKind::EndType,
        TokenKind::Configuration => TokenKind::EndConfiguration,
        _ => TokenKind::EndVar,
    }
}

/// Reads the section that starts the block at `start`; returns the index behind it.
pub fn read_section(reader: &mut Reader, block: &Block, start: usize) -> usize {
    let kind = section_kind(block.kinds[start]);
    let (mut constant, mut retain) = (false, None);
    let mut at = start + 1;
    while let Some(word) = block.kinds.get(at) {
        match word {
            TokenKind::Constant => constant = true,
            TokenKind::Retain => retain = Some(true),
            TokenKind::NonRetain => retain = Some(false),
            _ => break,
        }
        at += 1;
    }
    let configuration = block.kinds.first() == Some(&TokenKind::Configuration);
    let stop = |kind: &TokenKind| match kind {
        TokenKind::EndVar => true,
        TokenKind::Resource | TokenKind::Task | TokenKind::Program => configuration,
        kind => kind.opens_section() || configuration && kind.closes(),
    };
    let end = block.kinds[at..].iter().position(stop).map_or(block.kinds.len(), |length| at + length);
    let grammar: Grammar = match kind {
        SectionKind::Access => grammar::access_path().boxed(),
        SectionKind::Config => grammar::instance_setting().boxed(),
        _ => grammar::variables().boxed(),
    };
    let declarations = read_declarations(reader, block, at, end, &grammar);
    let closed = block.kinds.get(end) == Some(&TokenKind::EndVar);
    let end = if closed { end + 1 } else { end };
    if !closed {
        unclosed(reader, block.token_span(start), "END_VAR");
    }
    let item = ItemKind::Section { kind, constant, retain, declarations };
    reader.push_item(block.span((start..end).into()), 0, item);
    end
}

/// Reads a TYPE block.
pub fn read_types(reader: &mut Reader, block: &Block) {
    let closed = block.kinds.last() == Some(&TokenKind::EndType);
    let end = block.kinds.len() - usize::from(closed);
    let declarations = read_declarations(reader, block, 1, end, &grammar::type_definition().boxed());
    if !closed {
        unclosed(reader, block.token_span(0), "END_TYPE");
    }
    reader.push_item(block.span((0..block.kinds.len()).into()), 0, ItemKind::Types { declarations });
}

/// Reads `: type` behind the name of a function, the next token; both are consumed if they are there.
pub fn read_result(reader: &mut Reader) -> Option<TypeId> {
    let mut block = Block::default();
    // `NAME : STRING [ 80 ]` is as long as it gets.
    for token in reader.tokens[reader.at..].iter().take(8) {
        if token.kind == TokenKind::Newline {
            break;
        }
        block.tokens.push(*token);
        block.kinds.push(token.kind);
        block.starts_line.push(false);
    }
    let parsed = grammar::type_definition().lazy().parse(&block.kinds[..]);
    let (node, errors) = parsed.into_output_errors();
    reader.at += 1;
    match node {
        Some(node) => {
            reader.at += node.tokens.end - 1;
            node.spec.as_ref().map(|spec| Lowering { reader, tokens: &block.tokens }.spec(spec))
        }
        None => {
            for error in errors {
                reader.mismatch(&block.tokens, &error);
            }
            reader.at += block.tokens.len() - 1;
            None
        }
    }
}

pub fn unclosed(reader: &mut Reader, opening: Span, closing: &'static str) {
    let message = Message::new("syntax-error.unclosed-region")
        .with("opening", reader.word(opening).to_ascii_uppercase())
        .with("closing", closing);
    reader.problem("syntax-error", opening, message);
}

fn read_declarations<'b>(
    reader: &mut Reader,
    block: &'b Block,
    from: usize,
    end: usize,
    grammar: &Grammar<'b>,
) -> Run {
    let mut found = Vec::new();
    let mut at = from;
    let terminated = grammar.clone().then_ignore(just(TokenKind::Semicolon)).lazy();
    while at < end {
        if block.kinds[at] == TokenKind::Semicolon {
            reader.stray_semicolon(block.token_span(at));
            at += 1;
            continue;
        }
        let reach = block.reach(at, end);
        if block.nests_too_deep(at, reach) {
            reader.problem("syntax-error", block.token_span(at), Message::new("syntax-error.too-deep"));
            at = block.next_start(at, end);
            continue;
        }
        let (node, errors) = terminated.parse(&block.kinds[at..reach]).into_output_errors();
        let (node, next) = match node {
            Some(node) => {
                for error in &errors {
                    reader.mismatch(&block.tokens[at..end], error);
                }
                let next = at + node.tokens.end + 1;
                (Some(node), next)
            }
            None => recover(reader, block, at, end, &errors, grammar),
        };
        if let Some(node) = node {
            found.push(Lowering { reader, tokens: &block.tokens[at..end] }.declaration(&node));
        }
        at = next;
    }
    append(&mut reader.tree.declarations, found)
}

/// What can still be said about the declaration at `at`, and where the next one starts.
fn recover<'b>(
    reader: &mut Reader,
    block: &'b Block,
    at: usize,
    end: usize,
    errors: &[Mismatch],
    grammar: &Grammar<'b>,
) -> (Option<DeclarationNode>, usize) {
    let tokens = &block.tokens[at..end];
    let last = errors.last().copied();
    let missing = last.filter(|error| {
        let next = at + error.at;
        error.expects(TokenKind::Semicolon) && error.at > 0 && (next >= end || block.starts_line[next])
    });
    if let Some(error) = missing {
        let node = grammar.parse(&block.kinds[at..at + error.at]).into_output();
        if let Some(node) = node {
            let before = block.token_span(at + error.at - 1);
            reader.expected_at_end(before, &TokenKind::Semicolon.quoted());
            return (Some(node), at + error.at);
        }
    }
    for error in errors {
        reader.mismatch(tokens, error);
    }
    let from = at + last.map_or(0, |error| error.at.min(tokens.len().saturating_sub(1)));
    // An error behind the end of a structure must not be mistaken for one inside it.
    let next = block.next_start(from, end).max(at + 1);
    (salvage(&block.kinds[at..next]), next)
}

/// The names of a declaration whose type or value cannot be read, so that their uses are not reported as well.
fn salvage(kinds: &[TokenKind]) -> Option<DeclarationNode> {
    let mut names = Vec::new();
    let mut pairs = kinds.iter().enumerate().step_by(2);
    while let Some((index, TokenKind::Word)) = pairs.next() {
        names.push(index);
        if kinds.get(index + 1) != Some(&TokenKind::Comma) {
            break;
        }
    }
    let tokens = (0..names.last()? + 1).into();
    Some(DeclarationNode::of(tokens, names, None))
}

fn section_kind(opening: TokenKind) -> SectionKind {
    match opening {
        TokenKind::VarInput => SectionKind::Input,
        TokenKind::VarOutput => SectionKind::Output,
        TokenKind::VarInOut => SectionKind::InOut,
        TokenKind::VarExternal => SectionKind::External,
        TokenKind::VarTemp => SectionKind::Temporary,
        TokenKind::VarGlobal => SectionKind::Global,
        TokenKind::VarAccess => SectionKind::Access,
        TokenKind::VarConfig => SectionKind::Config,
        _ => SectionKind::Local,
    }
}
