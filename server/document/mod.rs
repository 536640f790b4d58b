//! The incremental document: a rope, and the chunks (rung, network, statement block, declaration) it is made of.
//!
//! An edit reads anew only the chunks that it touches; all others keep their tree, mentions and local diagnostics.
//! A [`Document`] is a value: cloning it is cheap and gives the immutable snapshot on which requests work.
//! Property: after any sequence of edits a document equals the one made from its text at once.

mod notation;
pub use notation::{Notation, detect_ladder_target, detect_notation, dialect_comment};

mod snapshot;
pub use snapshot::{ChunkRef, Document, Edit, LIMIT_BYTES};

mod unit;
pub use unit::Unit;

mod both;
pub use both::both;

mod split;

mod chunk;
pub use chunk::{Chunk, Found, Proofs, Reading, Tree};

mod exported;

mod fences;
pub use fences::{Fence, fences};

mod pages;
pub use pages::Page;

mod size;
pub use size::Size;

mod names;
pub use names::Names;

mod milestone;
pub use milestone::{Milestone, MilestoneKind};

mod access;
pub use access::{Access, Accesses, Act, Joint, JointKind, Part};

mod circuit;

mod allowance;
pub use allowance::{Allowance, DIRECTIVE};

mod boxes;
pub use boxes::boxed;

mod exclusion;
pub use exclusion::{Exclusion, exclusive_names};

mod tokens;
pub use tokens::{Token, TokenKind};

mod operation;
pub use operation::{Operation, coil_form, compare_form, contact_form};

mod mention;
pub use mention::{Mention, Symbol, Use};

mod comments;
pub use comments::{Comments, DeviceComment};

mod scope;
pub use scope::{DeclaredType, Limits, Pou, Scopes, Variable};

mod project_view;
pub use project_view::{At, Member, ProjectView};

mod exports;
pub use exports::{Exports, Outer};
