//! From one form of a program to another: drawing, instruction list, equations.
//!
//! Every way goes through the [`Path`](crate::logic::Path) of a rung, and what was written is read again and compared
//! with what it was made of.

mod source;
pub use source::Source;

mod page;

mod certificate;
pub use certificate::Certificate;

mod stack;

mod counterexample;
pub use counterexample::{Counterexample, Run, Shown, Value};

mod declared;

mod helpers;

mod block_coils;

mod paired;

mod reached;

mod units;

mod turning;
mod types;

mod prove;
pub use prove::{Proof, prove};

pub mod told;

mod dialect;
use dialect::Purpose;
pub use dialect::{KEPT, KEPT_FORMS, device_called, variable_called};

mod header;

pub mod to_fx;

pub mod to_iec;

pub mod to_ladder;

pub mod to_boolean;

pub mod to_machine_code;

pub mod from_boolean;

pub mod from_machine_code;

use crate::document::{Document, Notation};
use crate::ladder::Style;
use crate::logic::{Path, Rung};
use crate::target::Model;
use crate::text::{Message, Span};
use smol_str::SmolStr;
use std::ops::Range;

/// A form of a program.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum To {
    /// A ladder diagram.
    Ladder,
    /// FX instruction list.
    Fx,
    /// Instruction list of IEC 61131-3.
    Iec,
    /// Equations, one for each output.
    Boolean,
}

impl To {
    /// All of them.
    pub const ALL: [To; 4] = [To::Ladder, To::Fx, To::Iec, To::Boolean];

    /// The name on the command line and in requests.
    pub fn name(self) -> &'static str {
        match self {
            To::Ladder => "ladder",
            To::Fx => "fx",
            To::Iec => "iec",
            To::Boolean => "boolean",
        }
    }

    /// The form of this name.
    pub fn named(name: &str) -> Option<To> {
        To::ALL.into_iter().find(|to| to.name() == name)
    }
}

/// How a translation is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Options {
    /// The look of drawings.
    pub style: Style,
    /// The look of equations.
    pub notation: to_boolean::Notation,
    /// Whether the result is read again and compared with the source.
    pub proves: bool,
    /// Whether it is a whole program, which in instruction list ends with END.
    pub is_whole: bool,
    /// The model of the FX family that an FX list is for; without one that of the document, or else an FX2N.
    pub model: Option<Model>,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            style: Style::default(),
            notation: Default::default(),
            proves: true,
            is_whole: true,
            model: None,
        }
    }
}

/// A program in another form.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Translation {
    /// The text, lines ended by line feeds.
    pub text: String,
    /// What became of each rung of the source, in order.
    pub rungs: Vec<Translated>,
    /// The variables that the result declares beyond those of the source.
    pub helpers: Vec<SmolStr>,
}

/// What became of a rung.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Translated {
    /// Where it stands in the source.
    pub span: Span,
    /// The bytes of the result that stand for it, comments left out.
    pub result: Range<usize>,
    /// The proof; nothing if none was asked for.
    pub certificate: Option<Certificate>,
    /// Why it was not translated but kept as it is, or why nothing is proved.
    pub note: Option<Message>,
    /// Whether it is kept as it is.
    pub is_kept: bool,
}

impl Translation {
    /// Whether every rung is proved.
    pub fn is_certain(&self) -> bool {
        self.rungs.iter().all(|rung| rung.certificate.is_some_and(Certificate::is_certain))
    }
}

/// `document` in another form; with `part` only the rungs that touch these bytes.
pub fn translate(document: &Document, part: Option<Span>, to: To, options: &Options) -> Translation {
    translate_unless(document, part, to, options, &|| false).unwrap_or_default()
}

/// The same; nothing if `is_cancelled` says on the way that nobody waits for it any more.
pub fn translate_unless(
    document: &Document,
    part: Option<Span>,
    to: To,
    options: &Options,
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Translation> {
    written((document, part.is_none()), source::program(document, part), to, options, is_cancelled)
}

/// The rungs of a document or a part of one, read once for several translations.
pub struct Original<'d> {
    document: &'d Document,
    is_whole: bool,
    program: source::Program,
}

impl<'d> Original<'d> {
    /// Reads `document`; with `part` only the rungs that touch these bytes.
    pub fn of(document: &'d Document, part: Option<Span>) -> Original<'d> {
        Original { document, is_whole: part.is_none(), program: source::program(document, part) }
    }

    /// How many bytes its rungs have. Those of a part may reach far beyond it.
    pub fn length(&self) -> usize {
        self.program.rungs.iter().map(|source| source.text().len()).sum()
    }

    /// In another form; nothing if `is_cancelled` says on the way that nobody waits for it any more.
    pub fn translated(
        &self,
        to: To,
        options: &Options,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Option<Translation> {
        written((self.document, self.is_whole), self.program.clone(), to, options, is_cancelled)
    }
}

/// A rung in the form of its document.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Rewritten {
    /// The rung.
    pub text: String,
    /// A section with the variables that it needs beyond those that are declared; empty if it needs none.
    pub declarations: String,
}

/// A rung of a document as it is written there if it does what `path` says; its comments and labels are left out.
///
/// # Errors
/// With the reason why the form of the document has no words for it.
pub fn rewritten(document: &Document, source: &Source, path: Path) -> Result<Rewritten, Message> {
    let to = match document.notation() {
        Notation::Ladder => To::Ladder,
        Notation::FxIl => To::Fx,
        Notation::IecIl => To::Iec,
    };
    let rung = Rung {
        labels: Vec::new(),
        network: None,
        comments: Vec::new(),
        path: Ok(Some(path)),
        ..source.rung.clone()
    };
    let rungs = vec![Source { rung, declarations: String::new(), ..source.clone() }];
    let program = source::Program { rungs, ..source::Program::default() };
    let options = Options { is_whole: false, ..Options::default() };
    let written = page::write(document, &program, (to, document.target()), &options, false, &|| false);
    let no_words = || Message::new("translate.no-drawing");
    let (translation, helpers) = written.ok_or_else(no_words)?;
    let rung = translation.rungs.into_iter().next().ok_or_else(no_words)?;
    match rung.note {
        Some(reason) => Err(reason),
        None => Ok(Rewritten {
            text: translation.text.get(rung.result).unwrap_or_default().to_string(),
            declarations: header::helpers_of(&helpers, source.pou),
        }),
    }
}

fn written(
    (document, is_whole): (&Document, bool),
    mut program: source::Program,
    to: To,
    options: &Options,
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Translation> {
    let target = dialect::target(document, to, options.model);
    dialect::convert(document, (to, target), &mut program, Purpose::Text { is_whole });
    if to == To::Iec && !document.target().is_fx() {
        block_coils::doubt(&mut program.rungs);
    }
    let write = |program: &source::Program| {
        page::write(document, program, (to, target), options, is_whole, is_cancelled)
    };
    let (mut translation, mut helpers) = write(&program)?;
    // A drawing has a box for what it has no symbols for; elsewhere that is but a comment.
    let is_mixed = !document.target().is_kin_of(target);
    if (to != To::Ladder || is_mixed) && dialect::keep_guarded(&mut program.rungs, &translation.rungs) {
        (translation, helpers) = write(&program)?;
    }
    if options.proves {
        let sources = (&program.rungs[..], &helpers[..]);
        certificate::add((document, target), sources, to, &mut translation, is_cancelled)?;
    }
    for (source, rung) in program.rungs.iter().zip(&mut translation.rungs) {
        if let Some(doubt) = source.doubt.as_ref().filter(|_| !rung.is_kept) {
            rung.note = Some(doubt.clone());
            rung.certificate = rung.certificate.map(|_| Certificate::Undecided);
        }
    }
    Some(translation)
}
