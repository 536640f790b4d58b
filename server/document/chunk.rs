//! A chunk: a piece of text with what it says, shared by all snapshots that contain it.

use super::milestone::{self, Milestone};
use super::{Mention, Notation, Size, mention};
use crate::il::{fx, iec};
use crate::ladder::{self, LadderTree};
use crate::target::Target;
use crate::text::Diagnostic;
use std::ops::Deref;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, OnceLock, PoisonError};

/// A piece of a document that can be read by itself. Its offsets start at 0.
///
/// What it says is read from its text when it is asked for. A drawing's tree is fifty times as large as its text, so a
/// document keeps only what is [known](Known) of each chunk; who walks all chunks looks at them through
/// [`Chunk::reader`], whose trees go away with it.
#[derive(Debug)]
pub struct Chunk {
    known: Arc<Known>,
    tree: OnceLock<Box<Tree>>,
}

/// What stays of a chunk.
#[derive(Debug)]
struct Known {
    text: Box<str>,
    kind: Kind,
    target: &'static Target,
    summary: OnceLock<Summary>,
    found: Kept,
}

/// Which reader reads a chunk.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Ladder,
    Fx,
    Iec,
}

/// What all readers of the whole document need of a chunk.
#[derive(Debug)]
struct Summary {
    mentions: Box<[Mention]>,
    size: Size,
    milestones: Box<[Milestone]>,
}

/// A chunk for reading: its own tree is kept if it has one, else it goes away with this.
pub enum Reader<'a> {
    /// The chunk itself.
    Own(&'a Chunk),
    /// Another one of the same text.
    Twin(Chunk),
}

impl Deref for Reader<'_> {
    type Target = Chunk;

    fn deref(&self) -> &Chunk {
        match self {
            Reader::Own(chunk) => chunk,
            Reader::Twin(chunk) => chunk,
        }
    }
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
    /// The chunk of `text`, which must be one of the pieces that [`split`] makes.
    pub fn new(text: &str, notation: Notation, target: &'static Target) -> Chunk {
        let kind = match notation {
            Notation::Ladder if ladder::kind_of(text) == ladder::ChunkKind::Declarations => Kind::Iec,
            Notation::Ladder => Kind::Ladder,
            Notation::FxIl => Kind::Fx,
            Notation::IecIl => Kind::Iec,
        };
        let (summary, found) = (OnceLock::new(), Mutex::new(None));
        let known = Known { text: text.into(), kind, target, summary, found };
        Chunk { known: Arc::new(known), tree: OnceLock::new() }
    }

    /// The same chunk for a look at its tree. Trees of IEC 61131-3 are kept: rules about whole programs look at them.
    pub fn reader(&self) -> Reader<'_> {
        match self.tree.get().is_some() || self.known.kind == Kind::Iec {
            true => Reader::Own(self),
            false => Reader::Twin(self.lean()),
        }
    }

    /// The same chunk without a tree.
    pub(super) fn lean(&self) -> Chunk {
        Chunk { known: self.known.clone(), tree: OnceLock::new() }
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.known.text
    }

    /// What it says. The tree is kept with the chunk; see [`Chunk::reader`].
    pub fn tree(&self) -> &Tree {
        self.tree.get_or_init(|| {
            Box::new(match self.known.kind {
                Kind::Ladder => Tree::Ladder(ladder::parse(self.text(), self.known.target)),
                Kind::Fx => Tree::Fx(fx::parse(self.text(), self.known.target)),
                Kind::Iec => Tree::Iec(iec::parse(self.text(), self.known.target)),
            })
        })
    }

    /// Whether it is IEC declarations or statements, told without reading it.
    pub(super) fn is_iec(&self) -> bool {
        self.known.kind == Kind::Iec
    }

    /// What it says if it is IEC declarations or statements; others are not read for the answer.
    pub fn iec(&self) -> Option<&iec::IecTree> {
        match self.is_iec().then(|| self.tree()) {
            Some(Tree::Iec(tree)) => Some(tree),
            _ => None,
        }
    }

    /// Length in bytes.
    pub fn len(&self) -> usize {
        self.known.text.len()
    }

    /// Whether it has no text; no document contains such a chunk.
    pub fn is_empty(&self) -> bool {
        self.known.text.is_empty()
    }

    /// What the reader could not read.
    pub fn problems(&self) -> &[Diagnostic] {
        match self.tree() {
            Tree::Ladder(tree) => &tree.problems,
            Tree::Fx(tree) => &tree.problems,
            Tree::Iec(tree) => &tree.problems,
        }
    }

    /// Every device, variable and label that it names, in the order of the text.
    pub fn mentions(&self) -> &[Mention] {
        &self.summary().mentions
    }

    /// How much program it is.
    pub fn size(&self) -> Size {
        self.summary().size
    }

    /// Its instructions and labels as far as they matter for the structure of a program.
    pub(super) fn milestones(&self) -> &[Milestone] {
        &self.summary().milestones
    }

    fn summary(&self) -> &Summary {
        self.known.summary.get_or_init(|| {
            let reader = self.reader();
            Summary {
                mentions: mention::of_chunk(&reader).into_boxed_slice(),
                size: Size::of(&reader),
                milestones: milestone::of_chunk(&reader).into_boxed_slice(),
            }
        })
    }

    /// The local diagnostics under `key`, which stands for everything outside of the chunk that they depend on;
    /// made by `find` unless they are there already. What else is known of the chunk is made from the same tree.
    pub fn found(&self, key: u64, find: impl FnOnce(&Chunk) -> Vec<Diagnostic>) -> Arc<[Diagnostic]> {
        kept(&self.known.found, key, || {
            let reader = self.reader();
            let found = find(&reader);
            reader.summary();
            found
        })
    }
}

/// The value kept under `key`, or a new one. A panic elsewhere leaves the slot usable: it holds a whole value or none.
pub(super) fn kept(slot: &Kept, key: u64, make: impl FnOnce() -> Vec<Diagnostic>) -> Arc<[Diagnostic]> {
    if let Some((kept_key, value)) = &*locked(slot)
        && *kept_key == key
    {
        return value.clone();
    }
    let value: Arc<[Diagnostic]> = match make() {
        found if found.is_empty() => NOTHING.clone(),
        found => found.into(),
    };
    *locked(slot) = Some((key, value.clone()));
    value
}

/// Whether there is a value under `key`.
pub(super) fn is_kept(slot: &Kept, key: u64) -> bool {
    matches!(&*locked(slot), Some((kept_key, _)) if *kept_key == key)
}

fn locked(slot: &Kept) -> MutexGuard<'_, Option<(u64, Arc<[Diagnostic]>)>> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Most chunks have no diagnostics, and share that.
static NOTHING: LazyLock<Arc<[Diagnostic]>> = LazyLock::new(|| Arc::new([]));

/// Ends of the chunks of `text`, which starts at a chunk boundary.
pub(super) fn split(text: &str, notation: Notation) -> Vec<usize> {
    match notation {
        Notation::Ladder => ladder::split(text),
        Notation::FxIl => fx::split(text),
        Notation::IecIl => iec::split(text),
    }
}
