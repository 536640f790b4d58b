//! What the status bar shows.

use super::Status;
use crate::document::{Document, Notation};

pub(super) fn of(document: &Document) -> Status {
    let target = document.target();
    let size = document.size();
    // An FX program in IEC words is counted in steps only once it is translated.
    let has_steps = target.is_fx() && document.notation() != Notation::IecIl;
    Status {
        target: target.name,
        dialect: match document.notation() {
            Notation::Ladder => "ladder",
            Notation::FxIl => "fx",
            Notation::IecIl => "iec",
        },
        rungs: size.rungs,
        steps: has_steps.then_some(size.steps),
        capacity: if has_steps { target.limits.steps } else { 0 },
    }
}
