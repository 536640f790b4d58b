//! A chunk: a piece of text with what it says, shared by all snapshots that contain it.

use super::{Mention, Notation, Size, exported, mention};
use crate::il::{fx, iec};
use crate::ladder::{self, LadderTree};
use crate::target::Target;
use crate::text::Diagnostic;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A piece of a document that can be read by itself. Its offsets start at 0.
#[derive(Debug)]
pub struct Chunk {
    text: Box<str>,
    tree: Tree,
    mentions: OnceLock<Box<[Mention]>>,
    size: OnceLock<Size>,
    found: Kept,
}

/// Diagnostics and the key under which they hold.
pub(super) type Kept = Mutex<Option<(u64, Arc<[Diagnostic]>)>>;

/// What a chunk says.
#[derive(Clone, PartialEq, Debug)]
pub enum Tree {
    /// A block of a ladder document.
    Ladder(LadderTree),
    /// A rung of FX instruction list.
    Fx(fx::FxTree),
    /// Declarations or statements of IEC 61131-3.
    Iec(iec::IecTree),
}

impl Chunk {
    /// Reads `text`, which must be one of the pieces that [`split`] makes.
    pub fn read(text: &str, notation: Notation, target: &Target) -> Chunk {
        let tree = match notation {
            Notation::Ladder => match ladder::kind_of(text) {
                ladder::ChunkKind::Declarations => Tree::Iec(iec::parse(text, target)),
                ladder::ChunkKind::Ldmicro if exported::declares(text) => Tree::Iec(exported::read(text)),
                _ => Tree::Ladder(ladder::parse(text, target)),
            },
            Notation::FxIl => Tree::Fx(fx::parse(text, target)),
            Notation::IecIl => Tree::Iec(iec::parse(text, target)),
        };
        Chunk {
            text: text.into(),
            tree,
            mentions: OnceLock::new(),
            size: OnceLock::new(),
            found: Mutex::new(None),
        }
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What it says.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Length in bytes.
    pub fn len(&self) -> usize {
        self.text.len()
    }

    /// Whether it has no text; no document contains such a chunk.
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// What the reader could not read.
    pub fn problems(&self) -> &[Diagnostic] {
        match &self.tree {
            Tree::Ladder(tree) => &tree.problems,
            Tree::Fx(tree) => &tree.problems,
            Tree::Iec(tree) => &tree.problems,
        }
    }

    /// Every device, variable and label that it names, in the order of the text.
    pub fn mentions(&self) -> &[Mention] {
        self.mentions.get_or_init(|| mention::of_chunk(self).into_boxed_slice())
    }

    /// How much program it is.
    pub fn size(&self) -> Size {
        *self.size.get_or_init(|| Size::of(self))
    }

    /// The local diagnostics under `key`, which stands for everything outside of the chunk that they depend on;
    /// made by `find` unless they are there already.
    pub fn found(&self, key: u64, find: impl FnOnce() -> Vec<Diagnostic>) -> Arc<[Diagnostic]> {
        kept(&self.found, key, find)
    }
}

/// The value kept under `key`, or a new one. A panic elsewhere leaves the slot usable: it holds a whole value or none.
pub(super) fn kept(slot: &Kept, key: u64, make: impl FnOnce() -> Vec<Diagnostic>) -> Arc<[Diagnostic]> {
    let lock = || slot.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((kept_key, value)) = &*lock()
        && *kept_key == key
    {
        return value.clone();
    }
    let value: Arc<[Diagnostic]> = make().into();
    *lock() = Some((key, value.clone()));
    value
}

/// Ends of the chunks of `text`, which starts at a chunk boundary.
pub(super) fn split(text: &str, notation: Notation) -> Vec<usize> {
    match notation {
        Notation::Ladder => ladder::split(text),
        Notation::FxIl => fx::split(text),
        Notation::IecIl => iec::split(text),
    }
}
