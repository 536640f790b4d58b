//! A chunk: a piece of text with what it says, shared by all snapshots that contain it.

use super::access::{self, OwnAccesses};
use super::allowance::{self, OwnAllowance};
use super::exclusion::{self, Exclusion};
use super::milestone::{self, Milestone};
use super::{Mention, Notation, Size, Token, boxes, circuit, exported, mention, tokens};
use crate::il::{fx, iec};
use crate::ladder::{self, LadderTree, NameHabit};
use crate::target::Target;
use crate::text::{Diagnostic, Span};
use std::ops::Deref;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// A piece of a document that can be read by itself. Its offsets start at 0.
///
/// What it says is read from its text when it is asked for. A drawing's tree is fifty times as large as its text, so a
/// large document keeps only what else is known of each chunk; who walks all chunks looks at them through
/// [`Chunk::reading`], whose trees go away with it.
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
    dialect: Arc<Dialect>,
    /// Whether the tree is kept once it was read.
    keeps_tree: bool,
    /// Where a drawing has its names, as far as its edges tell.
    habit: NameHabit,
    /// The lists that a drawing carries along, with their starts.
    boxes: OnceLock<Box<[(usize, Chunk)]>>,
    outline: OnceLock<Outline>,
    mentions: OnceLock<Box<[Mention]>>,
    tokens: OnceLock<Box<[Token]>>,
    found: Kept<Found>,
    proofs: Kept<Proofs>,
}

/// How the chunks of a document are read.
#[derive(Clone, Debug)]
pub(super) struct Dialect {
    pub(super) notation: Notation,
    pub(super) target: &'static Target,
    /// The target with the symbols of the project, if it has any.
    pub(super) symbols: Option<Arc<Target>>,
    /// Whether most drawings of the document have their names below the elements.
    pub(super) names_below: bool,
}

impl Dialect {
    /// The target as words of the text are read.
    pub(super) fn reader(&self) -> &Target {
        self.symbols.as_deref().unwrap_or(self.target)
    }
}

/// Which reader reads a chunk.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Ladder,
    Fx,
    Iec,
    /// The tables of an LDmicro export, which say the same as IEC declarations.
    Tables,
}

/// What the rules about the whole program need of a chunk.
#[derive(Debug)]
struct Outline {
    size: Size,
    milestones: Box<[Milestone]>,
    accesses: OwnAccesses,
    circuit: u64,
    allowances: Vec<OwnAllowance>,
    exclusions: Box<[Exclusion]>,
    is_only_comments: bool,
}

/// A chunk for reading: its own tree is kept if it has one, else it goes away with this.
pub enum Reading<'a> {
    /// The chunk itself.
    Own(&'a Chunk),
    /// Another one of the same text.
    Twin(Chunk),
}

impl Deref for Reading<'_> {
    type Target = Chunk;

    fn deref(&self) -> &Chunk {
        match self {
            Reading::Own(chunk) => chunk,
            Reading::Twin(chunk) => chunk,
        }
    }
}

/// What was found, and the key under which it holds.
pub(super) type Kept<T> = Mutex<Option<(u64, T)>>;

/// Diagnostics that are shared. Most chunks have none, and threads that look at many of those share nothing.
#[derive(Clone, Debug, Default)]
pub struct Found(Option<Arc<[Diagnostic]>>);

impl Deref for Found {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        self.0.as_deref().unwrap_or_default()
    }
}

impl From<Vec<Diagnostic>> for Found {
    fn from(found: Vec<Diagnostic>) -> Found {
        Found((!found.is_empty()).then(|| found.into()))
    }
}

/// What proofs about rungs found.
#[derive(Clone, Debug, Default)]
pub struct Proofs {
    /// The findings.
    pub found: Found,
    /// How much work they were; 0 where there was nothing to prove.
    pub effort: usize,
}

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

impl Tree {
    /// The comments in the order of the text, with offsets into the chunk.
    pub fn comments(&self) -> &[Span] {
        match self {
            Tree::Ladder(tree) => &tree.comments,
            Tree::Fx(tree) => &tree.comments,
            Tree::Iec(tree) => &tree.comments,
        }
    }
}

impl Chunk {
    /// The chunk of `text`, which must be one of the pieces that [`split`](super::split::split) makes.
    /// `keeps_tree` says whether it stands in a document so small that all trees are kept.
    pub(super) fn new(text: &str, dialect: &Arc<Dialect>, keeps_tree: bool) -> Chunk {
        let kind = match dialect.notation {
            Notation::Ladder => match ladder::kind_of(text) {
                ladder::ChunkKind::Declarations => Kind::Iec,
                ladder::ChunkKind::Ldmicro if exported::declares(text) => Kind::Tables,
                _ => Kind::Ladder,
            },
            Notation::FxIl => Kind::Fx,
            Notation::IecIl => Kind::Iec,
        };
        let known = Known {
            text: text.into(),
            kind,
            dialect: dialect.clone(),
            // Rules about whole programs look at trees of IEC 61131-3.
            habit: if kind == Kind::Ladder { ladder::habit_of(text) } else { NameHabit::default() },
            keeps_tree: keeps_tree || matches!(kind, Kind::Iec | Kind::Tables),
            boxes: OnceLock::new(),
            outline: OnceLock::new(),
            mentions: OnceLock::new(),
            tokens: OnceLock::new(),
            found: Mutex::new(None),
            proofs: Mutex::new(None),
        };
        Chunk { known: Arc::new(known), tree: OnceLock::new() }
    }

    /// The same chunk for a look at its tree.
    pub fn reading(&self) -> Reading<'_> {
        match self.tree.get().is_some() || self.known.keeps_tree {
            true => Reading::Own(self),
            false => Reading::Twin(self.lean()),
        }
    }

    /// Whether its tree is kept once it was read.
    pub(super) fn keeps_tree(&self) -> bool {
        self.known.keeps_tree
    }

    /// The same chunk without a tree.
    pub(super) fn lean(&self) -> Chunk {
        Chunk { known: self.known.clone(), tree: OnceLock::new() }
    }

    /// Where a drawing has its names, as far as its edges tell.
    pub(super) fn habit(&self) -> NameHabit {
        self.known.habit
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.known.text
    }

    /// What it says. The tree is kept with the chunk; see [`Chunk::reading`].
    pub fn tree(&self) -> &Tree {
        self.tree.get_or_init(|| {
            let target = self.known.dialect.reader();
            Box::new(match self.known.kind {
                Kind::Ladder => {
                    let document = NameHabit { above: 0, below: u32::from(self.known.dialect.names_below) };
                    let own = self.known.habit;
                    let hint = if own.decided().is_some() { own } else { document };
                    Tree::Ladder(ladder::parse_with(self.text(), target, hint))
                }
                Kind::Fx => Tree::Fx(fx::parse(self.text(), target)),
                Kind::Iec => Tree::Iec(iec::parse(self.text(), target)),
                Kind::Tables => Tree::Iec(exported::read(self.text())),
            })
        })
    }

    /// The lists in the boxes `{il … }` of a drawing in the order of the text, each with its start, as chunks of their
    /// own.
    pub fn boxes(&self) -> &[(usize, Chunk)] {
        match self.known.kind {
            Kind::Ladder => {
                self.known.boxes.get_or_init(|| boxes::of_chunk(self, &self.known.dialect).into())
            }
            Kind::Fx | Kind::Iec | Kind::Tables => &[],
        }
    }

    /// The list in the box in which a byte of a drawing stands, with its start.
    pub fn box_at(&self, offset: usize) -> Option<(usize, &Chunk)> {
        let (start, list) = self.boxes().iter().rfind(|(start, _)| *start <= offset)?;
        (offset < start + list.len()).then_some((*start, list))
    }

    /// Whether it is IEC declarations or statements, told without reading it.
    pub fn is_iec(&self) -> bool {
        matches!(self.known.kind, Kind::Iec | Kind::Tables)
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
        self.known.mentions.get_or_init(|| mention::of_chunk(&self.reading()).into_boxed_slice())
    }

    /// Every word and symbol with what it means, in order, none overlapping, none over more than one line.
    pub fn tokens(&self) -> &[Token] {
        self.known.tokens.get_or_init(|| tokens::of_chunk(&self.reading()).into_boxed_slice())
    }

    /// How much program it is.
    pub fn size(&self) -> Size {
        self.outline().size
    }

    /// Its instructions and labels as far as they matter for the structure of a program.
    pub(super) fn milestones(&self) -> &[Milestone] {
        &self.outline().milestones
    }

    /// What it reads and drives.
    pub(super) fn accesses(&self) -> &OwnAccesses {
        &self.outline().accesses
    }

    /// How its rungs are put together; differs where they may do something else.
    pub(super) fn circuit(&self) -> u64 {
        self.outline().circuit
    }

    /// The comments in it that allow something.
    pub(super) fn allowances(&self) -> &[OwnAllowance] {
        &self.outline().allowances
    }

    /// The comments in it that exclude something, offsets from its start, without the units before it.
    pub(super) fn exclusions(&self) -> &[Exclusion] {
        &self.outline().exclusions
    }

    /// Whether nothing is in it but comments and blank lines.
    pub(super) fn is_only_comments(&self) -> bool {
        self.outline().is_only_comments
    }

    fn outline(&self) -> &Outline {
        self.known.outline.get_or_init(|| {
            let reading = self.reading();
            Outline {
                size: Size::of(&reading),
                milestones: milestone::of_chunk(&reading).into_boxed_slice(),
                accesses: access::of_chunk(&reading),
                circuit: circuit::of_chunk(&reading),
                allowances: allowance::of_chunk(&reading),
                exclusions: exclusion::of_chunk(&reading),
                is_only_comments: allowance::is_only_comments(reading.tree()),
            }
        })
    }

    /// The local diagnostics under `key`, which stands for everything outside of the chunk that they depend on;
    /// made by `find` unless they are there already. What else is known of the chunk is made from the same tree, its
    /// mentions if `with_mentions` says that somebody will ask for them.
    pub fn found(
        &self,
        key: u64,
        with_mentions: bool,
        find: impl FnOnce(&Chunk) -> Vec<Diagnostic>,
    ) -> Found {
        kept_or(&self.known.found, key, || {
            let reading = self.reading();
            let found = find(&reading);
            reading.outline();
            if with_mentions {
                reading.mentions();
            }
            found
        })
    }

    /// What the proofs about its rungs found under `key`, if they were made.
    pub fn proofs(&self, key: u64) -> Option<Proofs> {
        kept(&self.known.proofs, key)
    }

    /// Keeps what the proofs found.
    pub fn keep_proofs(&self, key: u64, proofs: Proofs) {
        keep(&self.known.proofs, key, proofs);
    }
}

/// The value kept under `key`, or a new one.
pub(super) fn kept_or(slot: &Kept<Found>, key: u64, make: impl FnOnce() -> Vec<Diagnostic>) -> Found {
    kept(slot, key).unwrap_or_else(|| {
        let value = Found::from(make());
        keep(slot, key, value.clone());
        value
    })
}

/// The value kept under `key`. A panic elsewhere leaves the slot usable: it holds a whole value or none.
pub(super) fn kept<T: Clone>(slot: &Kept<T>, key: u64) -> Option<T> {
    locked(slot).as_ref().filter(|(kept_key, _)| *kept_key == key).map(|(_, value)| value.clone())
}

/// Keeps `value` under `key`.
pub(super) fn keep<T>(slot: &Kept<T>, key: u64, value: T) {
    *locked(slot) = Some((key, value));
}

/// Whether there is a value under `key`.
pub(super) fn is_kept<T>(slot: &Kept<T>, key: u64) -> bool {
    matches!(&*locked(slot), Some((kept_key, _)) if *kept_key == key)
}

fn locked<T>(slot: &Kept<T>) -> MutexGuard<'_, Option<(u64, T)>> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}
