//! Every word and symbol with what it means, for highlighting.

use super::{Chunk, Tree, Use};
use crate::il::fx::{FxTree, LineKind, WordKind};
use crate::il::iec::{IecTree, ItemKind, MentionRole};
use crate::ladder::{Element, ElementKind, LadderTree};
use crate::target::iec::{ElementaryType, is_keyword};
use crate::target::{Access, Operand};
use crate::text::{Span, Spanned};
use rustc_hash::FxHashSet;

/// A token for highlighting.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Token {
    /// Where.
    pub span: Span,
    /// What.
    pub kind: TokenKind,
    /// Where a value is written or a name declared.
    pub modification: bool,
}

/// What a token is. The order is that of the legend that the protocol announces.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum TokenKind {
    Comment,
    Keyword,
    Instruction,
    Device,
    Variable,
    Label,
    Number,
    Text,
    Function,
    FunctionBlock,
    Type,
    Wire,
    Element,
}

/// The tokens of a chunk in order, none overlapping, none over more than one line. Offsets are those of the chunk.
pub(super) fn of_chunk(chunk: &Chunk) -> Vec<Token> {
    let mut found = Vec::new();
    match chunk.tree() {
        Tree::Fx(tree) => of_fx(tree, &mut found),
        Tree::Ladder(tree) => of_ladder(chunk, tree, &mut found),
        Tree::Iec(tree) => of_iec(chunk, tree, &mut found),
    }
    let mut tokens = Vec::with_capacity(found.len());
    flatten(&mut found, chunk.text(), &mut tokens);
    tokens
}

fn token(span: Span, kind: TokenKind) -> Token {
    Token { span, kind, modification: false }
}

fn of_fx(tree: &FxTree, tokens: &mut Vec<Token>) {
    tokens.extend(tree.comments.iter().map(|comment| token(*comment, TokenKind::Comment)));
    for word in tree.words() {
        let kind = match word.value {
            WordKind::Step => TokenKind::Number,
            WordKind::Mnemonic(LineKind::Instruction(_)) => TokenKind::Instruction,
            WordKind::Mnemonic(LineKind::Label(_)) => TokenKind::Label,
            WordKind::Mnemonic(LineKind::Unknown) | WordKind::Operand(_) | WordKind::Comment => continue,
        };
        let modification = kind == TokenKind::Label;
        tokens.push(Token { span: word.span, kind, modification });
    }
    for line in &tree.lines {
        let LineKind::Instruction(form) = line.kind else {
            tokens.extend(tree.operands(line).iter().filter_map(|found| operand(found, false)));
            continue;
        };
        for (place, found) in tree.operands(line).iter().enumerate() {
            let spec = form.instruction.operands.get(place);
            tokens.extend(operand(found, spec.is_some_and(|spec| spec.access != Access::Read)));
        }
    }
}

fn operand(operand: &Spanned<Operand>, modification: bool) -> Option<Token> {
    let kind = match operand.value {
        Operand::Device(device) if device.kind.is_pointer() => TokenKind::Label,
        Operand::Device(_) | Operand::Indexed { .. } | Operand::Nibbles { .. } | Operand::WordBit { .. } => {
            TokenKind::Device
        }
        Operand::Direct(_) => TokenKind::Device,
        Operand::Constant { .. } => TokenKind::Number,
        Operand::Literal(literal) => match literal.value {
            crate::target::iec::LiteralValue::Text | crate::target::iec::LiteralValue::WideText => {
                TokenKind::Text
            }
            _ => TokenKind::Number,
        },
        Operand::Text => TokenKind::Text,
        Operand::Variable => TokenKind::Variable,
        Operand::Invalid(_) => return None,
    };
    Some(Token { span: operand.span, kind, modification })
}

fn of_ladder(chunk: &Chunk, tree: &LadderTree, tokens: &mut Vec<Token>) {
    tokens.extend(tree.comments.iter().map(|comment| token(*comment, TokenKind::Comment)));
    if let Some(header) = &tree.header {
        tokens.push(token(header.span, TokenKind::Keyword));
        tokens.extend(header.number.map(|number| token(number.span, TokenKind::Number)));
        tokens.extend(header.title.map(|title| token(quoted(title, chunk.text()), TokenKind::Text)));
        tokens
            .extend(header.label.map(|label| Token { modification: true, ..token(label, TokenKind::Label) }));
    }
    for rung in &tree.rungs {
        tokens.extend(rung.number.map(|number| token(number.span, TokenKind::Number)));
        tokens.extend(rung.graph.cells.iter().map(|cells| token(*cells, TokenKind::Wire)));
        for element in &rung.graph.elements {
            of_element(element, tokens);
        }
    }
    mark_changes(chunk, tokens);
}

/// `title` with the quotes around it.
fn quoted(title: Span, text: &str) -> Span {
    let is_quote = |byte: Option<&u8>| matches!(byte, Some(b'\'' | b'"'));
    let bytes = text.as_bytes();
    let starts = title.start > 0 && is_quote(bytes.get(title.start as usize - 1));
    let ends = is_quote(bytes.get(title.end as usize));
    Span { start: title.start - u32::from(starts), end: title.end + u32::from(ends) }
}

/// The operands say what they are, the mentions whether they are written or declared.
fn mark_changes(chunk: &Chunk, tokens: &mut [Token]) {
    let changes = |usage: Use| usage.writes() || usage == Use::Declare;
    let changed =
        chunk.mentions().iter().filter(|mention| changes(mention.usage)).map(|mention| mention.span);
    let changed: FxHashSet<Span> = changed.collect();
    for token in tokens.iter_mut() {
        token.modification |= changed.contains(&token.span);
    }
}

fn of_element(element: &Element, tokens: &mut Vec<Token>) {
    tokens.push(token(element.span, TokenKind::Element));
    tokens.extend(element.operands.iter().filter_map(|found| operand(found, false)));
    tokens.extend(element.name_lines.iter().map(|line| token(*line, TokenKind::Variable)));
    tokens.extend(element.notes.iter().map(|note| token(*note, TokenKind::Comment)));
    match &element.kind {
        ElementKind::Instruction { form: Some(_), mnemonic } => {
            tokens.push(token(*mnemonic, TokenKind::Instruction))
        }
        ElementKind::Jump(label) => tokens.push(token(*label, TokenKind::Label)),
        ElementKind::ConnectorIn(name) | ElementKind::ConnectorOut(name) => {
            tokens.push(token(*name, TokenKind::Label));
        }
        ElementKind::Block(block) => {
            tokens.extend(block.rows.iter().map(|row| token(*row, TokenKind::Element)));
            tokens.extend(block.instance.map(|name| token(name, TokenKind::Variable)));
            tokens.extend(block.type_name.map(|name| token(name, TokenKind::FunctionBlock)));
            let pins = block.inputs.iter().chain(&block.outputs);
            tokens.extend(pins.filter_map(|pin| pin.name).map(|name| token(name, TokenKind::Variable)));
        }
        _ => {}
    }
}

fn of_iec(chunk: &Chunk, tree: &IecTree, tokens: &mut Vec<Token>) {
    let text = chunk.text();
    let comments = tree.comments.iter().chain(&tree.pragmas);
    tokens.extend(comments.map(|comment| token(*comment, TokenKind::Comment)));
    for item in &tree.items {
        let word = match item.kind {
            ItemKind::Operation { operation, .. } | ItemKind::Open { operation, .. } => operation.word,
            ItemKind::Jump { word, .. } | ItemKind::Return { word, .. } | ItemKind::Call { word, .. } => word,
            ItemKind::InputOperator { input, .. } => input,
            _ => continue,
        };
        tokens.push(token(word, TokenKind::Instruction));
    }
    let values = tree.operands.iter().filter(|operand| operand.value != Operand::Variable);
    tokens.extend(values.filter_map(|value| operand(value, false)));
    for mention in tree.mentions(text) {
        let kind = match mention.role {
            MentionRole::DeclaresLabel | MentionRole::Jumps => TokenKind::Label,
            MentionRole::CallsFunction => TokenKind::Function,
            MentionRole::DeclaresPou(_) => TokenKind::FunctionBlock,
            MentionRole::DeclaresType => TokenKind::Type,
            MentionRole::NamesType
                if crate::target::iec::FunctionBlock::named(mention.span.of(text)).is_some() =>
            {
                TokenKind::FunctionBlock
            }
            MentionRole::NamesType => TokenKind::Type,
            _ => TokenKind::Variable,
        };
        tokens.push(token(mention.span, kind));
    }
    mark_changes(chunk, tokens);
    keywords(text, tokens);
}

/// Keywords and names of elementary types in what no token covers yet.
fn keywords(text: &str, tokens: &mut Vec<Token>) {
    tokens.sort_by_key(|token| token.span);
    let mut gaps = Vec::new();
    let mut end = 0;
    for token in tokens.iter() {
        if token.span.start > end {
            gaps.push(Span { start: end, end: token.span.start });
        }
        end = end.max(token.span.end);
    }
    gaps.push(Span { start: end.min(text.len() as u32), end: text.len() as u32 });
    for gap in gaps {
        let mut offset = gap.start as usize;
        for piece in gap.of(text).split_inclusive(|c: char| !(c.is_alphanumeric() || c == '_')) {
            let word = piece.trim_end_matches(|c: char| !(c.is_alphanumeric() || c == '_'));
            let span = Span::new(offset, offset + word.len());
            if ElementaryType::named(word).is_some() {
                tokens.push(token(span, TokenKind::Type));
            } else if is_keyword(word) {
                tokens.push(token(span, TokenKind::Keyword));
            }
            offset += piece.len();
        }
    }
}

/// Cuts outer tokens around inner ones, and all at the ends of lines.
fn flatten(found: &mut [Token], text: &str, tokens: &mut Vec<Token>) {
    found.sort_by_key(|token| (token.span.start, std::cmp::Reverse(token.span.end)));
    let mut open: Vec<Token> = Vec::new();
    let mut at = 0;
    let mut emit = |token: Token, from: u32, to: u32, at: &mut u32| {
        let from = from.max(*at).max(token.span.start);
        if from < to {
            lines(Token { span: Span { start: from, end: to }, ..token }, text, tokens);
            *at = to;
        }
    };
    for &token in found.iter() {
        while let Some(&top) = open.last().filter(|top| top.span.end <= token.span.start) {
            emit(top, top.span.start, top.span.end, &mut at);
            open.pop();
        }
        if let Some(&top) = open.last() {
            emit(top, top.span.start, token.span.start, &mut at);
        }
        open.push(token);
    }
    while let Some(top) = open.pop() {
        emit(top, top.span.start, top.span.end, &mut at);
    }
}

/// The pieces of `token` on each of its lines, blanks at their ends left out.
fn lines(token: Token, text: &str, tokens: &mut Vec<Token>) {
    let mut offset = token.span.start as usize;
    for line in token.span.of(text).split_inclusive(['\n', '\r']) {
        let content = line.trim();
        let indent = line.len() - line.trim_start().len();
        if !content.is_empty() {
            let span = Span::new(offset + indent, offset + indent + content.len());
            tokens.push(Token { span, ..token });
        }
        offset += line.len();
    }
}
