//! The checker: two tiers of rules over a document, one file for each rule.
//!
//! The real-time tier judges chunk by chunk and keeps what it found with the chunk, so that an edit costs the touched
//! chunks only. The batch tier looks at the whole program. Both give plain diagnostics with offsets into the document.

mod rule;
pub use rule::{Rule, Run};

mod context;
pub use context::{ChunkContext, ProgramContext, ProgramFile};

mod programs;
pub use programs::{program_around, programs};

mod surface;
pub use surface::surface;

mod engine;
pub use engine::{Severities, all, batch, once, program, project, realtime, sorted, within_project};

mod proofs;

mod suppression;
pub use suppression::is_suppressible;

mod statements;

mod iec;

mod declarations;
mod drawing;
mod order;
mod proof;
mod sense;
mod words;

/// All rules, in the order of the catalogue.
pub static RULES: std::sync::LazyLock<Vec<&'static Rule>> = std::sync::LazyLock::new(|| {
    [drawing::RULES, words::RULES, order::RULES, declarations::RULES, sense::RULES, proof::RULES].concat()
});
