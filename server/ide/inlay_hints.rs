//! What a preset or a hexadecimal constant amounts to, behind it; in a drawing behind its line, for a hint in the line
//! would push the rest of the drawing out of its columns. There also the types of names that nothing declares.

use super::{InlayHint, devices, implicit};
use crate::document::{Chunk, Comments, Document, Notation, Symbol};
use crate::target::{Constant, Operand, Target};
use crate::text::{Encoding, Language, LineColumn, Message, Span};

/// `comments` adds what the project says about devices.
pub(super) fn within(document: &Document, span: Span, language: Language, comments: bool) -> Vec<InlayHint> {
    let mut hints = Vec::new();
    let (first, last) = (span.start as usize, span.end as usize);
    let mut page_start = 0;
    for page in document.pages() {
        let mut start = page_start;
        page_start += page.bytes();
        if page_start < first || start > last {
            continue;
        }
        for chunk in page.chunks() {
            if start <= last && start + chunk.len() >= first {
                let old = hints.len();
                of_chunk(chunk, start, document.target(), language, &mut hints);
                if comments {
                    comments_of_chunk(chunk, start, document.comments(), &mut hints);
                }
                if document.notation() == Notation::Ladder {
                    hints[old..]
                        .iter_mut()
                        .for_each(|hint| hint.offset = line_end(chunk, start, hint.offset));
                }
            }
            start += chunk.len();
        }
    }
    implicit_variables(document, (first, last), language, &mut hints);
    hints.retain(|hint| first <= hint.offset && hint.offset <= last);
    hints
}

/// Behind each line the types of the variables that a ladder without header declares by using them there first.
fn implicit_variables(
    document: &Document,
    (first, last): (usize, usize),
    language: Language,
    hints: &mut Vec<InlayHint>,
) {
    let old = hints.len();
    for (span, kind) in implicit::first_uses(document, first, last) {
        let line = document.line_of(span.start as usize) as u32;
        let offset = document.offset(LineColumn { line, column: u32::MAX }, Encoding::Utf8);
        let name = document.slice(span);
        // Names of one line and type share a hint.
        match hints[old..].last_mut().filter(|hint| hint.offset == offset) {
            Some(hint) if hint.label.ends_with(&format!(": {kind}")) => {
                let names = hint.label.len() - kind.len() - 2;
                hint.label.insert_str(names, &format!(", {name}"));
            }
            _ => {
                let tooltip = Message::new("hint.implicit").render(language);
                hints.push(InlayHint { offset, label: format!("{name}: {kind}"), tooltip });
            }
        }
    }
    hints.sort_by_key(|hint| hint.offset);
}

/// The end of the line in which `offset` stands, both counted as the chunk's `start` is.
fn line_end(chunk: &Chunk, start: usize, offset: usize) -> usize {
    let rest = chunk.text().get(offset - start..).unwrap_or("");
    offset + rest.find(['\r', '\n']).unwrap_or(rest.len())
}

/// Behind each device what its word does not say: the comment, and for a symbol the device.
fn comments_of_chunk(chunk: &Chunk, start: usize, comments: &Comments, hints: &mut Vec<InlayHint>) {
    if comments.rows().is_empty() {
        return;
    }
    let old = hints.len();
    for mention in chunk.mentions() {
        let Some(row) = comments.of(&mention.symbol) else { continue };
        let word = mention.span.of(chunk.text());
        let is_symbol = row.symbol.to_lowercase() == word.to_lowercase();
        let label = match (&row.thing, is_symbol) {
            (Symbol::Device(device), true) => format!("{device} {}", row.comment).trim().to_string(),
            (_, true) => row.comment.to_string(),
            (_, false) => row.words(),
        };
        if !label.is_empty() {
            let offset = start + mention.span.end as usize;
            hints.push(InlayHint { offset, label, tooltip: format!("{word}: {}", row.words()) });
        }
    }
    // Both kinds of hint come in the order of the text.
    if hints.len() > old {
        hints.sort_by_key(|hint| hint.offset);
    }
}

fn of_chunk(chunk: &Chunk, start: usize, target: &Target, language: Language, hints: &mut Vec<InlayHint>) {
    for operation in chunk.operations() {
        let is_preset = devices::is_preset(&operation);
        for (place, operand) in operation.operands.iter().enumerate() {
            let Operand::Constant { value, index: None } = operand.value else { continue };
            let offset = start + operand.span.end as usize;
            let driven = operation.operands[0].value.device().filter(|_| is_preset && place == 1);
            if let Some((device, unit)) = driven.and_then(|d| Some((d, devices::timer_unit(d, target)?))) {
                let count = devices::integer(value);
                if let Some(time) = count.and_then(|count| devices::timer_time(device, count, target)) {
                    let tooltip = Message::new("hint.preset").with("device", device).with("unit", unit);
                    hints.push(InlayHint {
                        offset,
                        label: format!("= {time}"),
                        tooltip: tooltip.render(language),
                    });
                }
            } else if let Constant::Hexadecimal(bits) = value
                && bits > 9
            {
                let tooltip = Message::new("hint.hexadecimal").render(language);
                hints.push(InlayHint { offset, label: format!("= {bits}"), tooltip });
            }
        }
    }
    hints.sort_by_key(|hint| hint.offset);
}
