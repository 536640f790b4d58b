//! What a preset or a hexadecimal constant amounts to, behind it; in a drawing behind its line, for a hint in the line
//! would push the rest of the drawing out of its columns.

use super::{InlayHint, devices};
use crate::document::{Chunk, Document, Notation};
use crate::target::{Constant, Operand, Target};
use crate::text::{Language, Message, Span};

pub(super) fn within(document: &Document, span: Span, language: Language) -> Vec<InlayHint> {
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
                if document.notation() == Notation::Ladder {
                    hints[old..]
                        .iter_mut()
                        .for_each(|hint| hint.offset = line_end(chunk, start, hint.offset));
                }
            }
            start += chunk.len();
        }
    }
    hints.retain(|hint| first <= hint.offset && hint.offset <= last);
    hints
}

/// The end of the line in which `offset` stands, both counted as the chunk's `start` is.
fn line_end(chunk: &Chunk, start: usize, offset: usize) -> usize {
    let rest = chunk.text().get(offset - start..).unwrap_or("");
    offset + rest.find(['\r', '\n']).unwrap_or(rest.len())
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
