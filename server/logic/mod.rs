//! What a rung means, whatever it was written in: conditions, paths of power, and the proof that two of them are equal.
//!
//! [`rungs`] reads a chunk as [`Rung`]s. A [`Path`] is the structure, with the words where they stand; what it does to
//! the devices is found by running it with formulas in place of bits.

mod term;
pub use term::{Storage, Term, is_within, wholes};

mod expression;
pub use expression::{Contact, Expression, Test};

mod path;
pub use path::{Action, Deed, Drive, Gate, Path};

mod rung;
pub use rung::{Network, Refusal, Rung};

mod callee;
pub use callee::{Callee, Formal};

mod call;
pub use call::{Argument, Call};

mod computation;
pub use computation::{Computation, Conversion};

mod block;

mod builder;

mod from_fx;
pub use from_fx::actions as actions_of_list;

mod from_iec;
pub use from_iec::{FALLS, HELPER, declarations, is_fall_name, is_helper_name, pulse_name};

mod elsewhere;
pub use elsewhere::Elsewhere;

pub mod stretch;

mod from_ladder;
pub use from_ladder::of_graph;

mod apart;
pub use apart::apart;

mod formula;
pub use formula::{Atom, Formula, Formulas, Kind, Moment, Step, Types};

mod number;
pub use number::real_at;

mod bounds;
pub use bounds::Bounds;

/// What the names of words of 32 bits begin with in a [`Moment`].
pub const WIDE: &str = "D ";

mod changes;

mod run;
pub use run::{Effect, Run};

mod effort;
pub use effort::Effort;

mod decide;
pub use decide::{Verdict, equal, is_never};

mod scans;
pub use scans::{Exclusion, Scans, Source};

mod minimal;
pub use minimal::{Sum, sum_of_products};

mod compare;
pub use compare::{Comparison, Place, compare, compare_but, compare_outcome, may_drive, shown, touches_bits};

mod evaluate;
pub use evaluate::{LeftBehind, Real, Scan, State, evaluate, evaluate_jumping};

use crate::document::{Chunk, Scopes, Tree};
use crate::target::Target;

/// The rungs of a chunk written for `target`, in the order of execution. Spans are offsets into the chunk.
///
/// What IEC instruction list means depends on declarations elsewhere; with them there is [`rungs_with`].
pub fn rungs(chunk: &Chunk, target: &Target) -> Vec<Rung> {
    rungs_with(chunk, target, Declared { scopes: &Scopes::default(), pous: 0 })
}

/// What is declared where a chunk stands.
#[derive(Clone, Copy)]
pub struct Declared<'a> {
    /// The declarations of the document.
    pub scopes: &'a Scopes,
    /// How many program units start before the chunk.
    pub pous: usize,
}

/// The rungs of a chunk written for `target`, as declarations around it have them.
pub fn rungs_with(chunk: &Chunk, target: &Target, declared: Declared<'_>) -> Vec<Rung> {
    match chunk.tree() {
        Tree::Fx(tree) => vec![from_fx::rung(chunk.text(), tree)],
        Tree::Ladder(tree) => from_ladder::rungs(chunk.text(), tree, target, declared),
        Tree::Iec(tree) => from_iec::rungs(chunk.text(), tree, declared, &Elsewhere::default()),
    }
}

/// The same where the chunk is a stretch of a program unit; `elsewhere` is what the rest of the unit says of its names.
pub fn rungs_of_stretch(
    chunk: &Chunk,
    target: &Target,
    declared: Declared<'_>,
    elsewhere: &Elsewhere,
) -> Vec<Rung> {
    match chunk.tree() {
        Tree::Iec(tree) => from_iec::rungs(chunk.text(), tree, declared, elsewhere),
        _ => rungs_with(chunk, target, declared),
    }
}
