//! Reads configurations: resources, tasks, program instances and the sections of variables between them.

use super::declare::{Block, read_section, unclosed};
use super::grammar::{self, Kinds, Mismatch};
use super::lower::Lowering;
use super::reader::{Reader, list_of};
use super::token::TokenKind;
use super::{FileKeyword, ItemKind};
use crate::text::Span;
use chumsky::extra;
use chumsky::prelude::*;

/// What stands in a configuration.
const STATEMENTS: [TokenKind; 7] = [
    TokenKind::VarGlobal,
    TokenKind::Resource,
    TokenKind::Task,
    TokenKind::Program,
    TokenKind::VarAccess,
    TokenKind::VarConfig,
    TokenKind::EndConfiguration,
];

/// Reads a block from CONFIGURATION to END_CONFIGURATION.
pub fn read_configuration(reader: &mut Reader, block: &Block) {
    let name = name_at(reader, block, 1);
    let mut at = 1 + usize::from(name.is_some());
    reader.push_item(block.span((0..at).into()), 0, ItemKind::Configuration { name });
    let mut resource = None;
    while let Some(kind) = block.kinds.get(at) {
        at = match kind {
            TokenKind::EndConfiguration => end(reader, block, at, FileKeyword::Configuration),
            TokenKind::EndResource => {
                resource = None;
                end(reader, block, at, FileKeyword::Resource)
            }
            TokenKind::Resource => {
                resource = Some(at);
                read_resource(reader, block, at)
            }
            TokenKind::Task => read_task(reader, block, at),
            TokenKind::Program => read_instance(reader, block, at),
            TokenKind::Semicolon => {
                reader.stray_semicolon(block.token_span(at));
                at + 1
            }
            kind if kind.opens_section() => read_section(reader, block, at),
            _ => {
                reader.expected(block.tokens.get(at).copied(), &list_of(STATEMENTS));
                block.next_start(at, block.kinds.len()).max(at + 1)
            }
        };
    }
    if let Some(resource) = resource {
        unclosed(reader, block.token_span(resource), "END_RESOURCE");
    }
    if block.kinds.last() != Some(&TokenKind::EndConfiguration) {
        unclosed(reader, block.token_span(0), "END_CONFIGURATION");
    }
}

fn end(reader: &mut Reader, block: &Block, at: usize, keyword: FileKeyword) -> usize {
    reader.push_item(block.token_span(at), 0, ItemKind::End(keyword));
    at + 1
}

/// The name at index `at`, which is reported if it is missing.
fn name_at(reader: &mut Reader, block: &Block, at: usize) -> Option<Span> {
    if block.kinds.get(at) == Some(&TokenKind::Word) {
        let span = block.token_span(at);
        reader.check_name(span);
        return Some(span);
    }
    reader.expected_in(&block.tokens, at, TokenKind::Word.name());
    None
}

fn read_resource(reader: &mut Reader, block: &Block, start: usize) -> usize {
    let name = name_at(reader, block, start + 1);
    let mut at = start + 1 + usize::from(name.is_some());
    let mut on = None;
    if block.kinds.get(at) == Some(&TokenKind::On) {
        at += 1;
        on = name_at(reader, block, at);
        at += usize::from(on.is_some());
    } else {
        reader.expected_in(&block.tokens, at, &TokenKind::On.quoted());
    }
    reader.push_item(block.span((start..at).into()), 0, ItemKind::Resource { name, on });
    at
}

fn read_task(reader: &mut Reader, block: &Block, start: usize) -> usize {
    let Some((node, next)) = read_statement(reader, block, start, grammar::task()) else {
        return block.next_start(start, block.kinds.len()).max(start + 1);
    };
    let task = Lowering { reader, tokens: &block.tokens[start..] }.task(&node);
    let index = reader.tree.tasks.len() as u32;
    reader.tree.tasks.push(task);
    reader.push_item(block.span((start..next).into()), 0, ItemKind::Task(index));
    next
}

fn read_instance(reader: &mut Reader, block: &Block, start: usize) -> usize {
    let Some((node, next)) = read_statement(reader, block, start, grammar::instance()) else {
        return block.next_start(start, block.kinds.len()).max(start + 1);
    };
    let instance = Lowering { reader, tokens: &block.tokens[start..] }.instance(&node);
    let index = reader.tree.instances.len() as u32;
    reader.tree.instances.push(instance);
    reader.push_item(block.span((start..next).into()), 0, ItemKind::Instance(index));
    next
}

/// Runs a grammar and looks for the semicolon behind; gives the node and the index behind the semicolon.
fn read_statement<'b, T: Clone>(
    reader: &mut Reader,
    block: &'b Block,
    start: usize,
    grammar: impl Parser<'b, Kinds<'b>, T, extra::Err<Mismatch>> + Clone,
) -> Option<(T, usize)> {
    let counted = grammar.map_with(|node, extra| {
        let tokens: SimpleSpan<usize> = extra.span();
        (node, tokens.end)
    });
    let kinds = &block.kinds[start..block.reach(start, block.kinds.len())];
    let (found, errors) =
        counted.clone().then_ignore(just(TokenKind::Semicolon)).lazy().parse(kinds).into_output_errors();
    if let Some((node, length)) = found {
        return Some((node, start + length + 1));
    }
    for error in &errors {
        reader.mismatch(&block.tokens[start..], error);
    }
    // Without its semicolon a statement still says what it says.
    let (node, length) = counted.lazy().parse(kinds).into_output()?;
    let behind = start + length;
    let resumed = block.starts_line.get(behind).is_none_or(|starts_line| *starts_line);
    Some((node, if resumed { behind } else { block.next_start(behind, block.kinds.len()) }))
}
