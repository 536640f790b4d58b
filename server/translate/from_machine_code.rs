//! Programs of a PLC as drawings.

use super::{Options, To, translate};
use crate::document::{Document, Notation};
use crate::machine_code::decode;
use crate::target::{Model, Target};

/// The ladder diagram of a program in words.
pub fn drawn(words: &[u16], model: Model) -> String {
    let document = Document::new(&decode(words, model).text, Notation::FxIl, Target::of(model));
    translate(&document, None, To::Ladder, &Options::default()).text
}
