//! The machine code of a document in any form: what is no FX list is translated to one before.

use super::{Certificate, Options, To, Translation, translate};
use crate::document::{Document, Notation, Tree};
use crate::il::fx;
use crate::machine_code::{Encoder, NO_MACHINE_CODE, Program};
use crate::target::Target;
use crate::text::{Diagnostic, Message, Span};

/// Encodes `document` for `target`. Of another form than FX list, what stands for a rung has the place of the rung, and
/// the program gets the END that it lacks if `is_last` says that no other file follows.
///
/// # Errors
/// What has no machine code, at its place in the document: instructions, and rungs whose translation is not proved.
pub fn encode(document: &Document, target: &Target, is_last: bool) -> Result<Program, Vec<Diagnostic>> {
    let mut encoder = Encoder::new(target);
    if document.notation() == Notation::FxIl {
        for at in document.chunks() {
            let reading = at.chunk.reading();
            if let Tree::Fx(tree) = reading.tree() {
                encoder.chunk(reading.text(), tree, at.start);
            }
        }
        return encoder.finish();
    }
    let options = Options { is_whole: is_last, model: Some(target.model), ..Options::default() };
    let translation = translate(document, None, To::Fx, &options);
    let refused = refused(&translation);
    if !refused.is_empty() {
        return Err(refused);
    }
    // Drawings of the FX family have the names that the project gives to devices, and so has what is made of them.
    let reader = if document.target().is_fx() { document.reader() } else { target };
    let mut start = 0;
    for end in fx::split(&translation.text) {
        let chunk = translation.text.get(start..end).unwrap_or_default();
        encoder.chunk(chunk, &fx::parse(chunk, reader), start);
        start = end;
    }
    match encoder.finish() {
        Ok(mut program) => {
            program.lines.iter_mut().for_each(|line| line.span = origin(&translation, line.span));
            Ok(program)
        }
        Err(found) => Err(found
            .into_iter()
            .map(|found| Diagnostic::new(found.code, origin(&translation, found.span), found.message))
            .collect()),
    }
}

/// The rungs that have no list, or none that is proved.
fn refused(translation: &Translation) -> Vec<Diagnostic> {
    let rungs = translation.rungs.iter();
    let refused = rungs.filter(|rung| !rung.certificate.is_some_and(Certificate::is_certain));
    let problem = |rung: &super::Translated| {
        let reasons = rung.note.iter().cloned().collect();
        let message = Message::new("machine-code.not-translated").with_messages("reason", reasons);
        Diagnostic::new(NO_MACHINE_CODE, rung.span, message)
    };
    refused.map(problem).collect()
}

/// The rung in the document for which `span` of the translation stands; a label belongs to the rung behind it, the END
/// that was added to the last one.
fn origin(translation: &Translation, span: Span) -> Span {
    let after = translation.rungs.partition_point(|rung| rung.result.end <= span.start as usize);
    let rung = translation.rungs.get(after).or(translation.rungs.last());
    rung.map_or(Span::at(0), |rung| rung.span)
}
