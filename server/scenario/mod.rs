//! Scenario tests: what a program is given over time, and what is expected of it.
//!
//! A file `*.test.toml` beside a program has scenarios. Each runs on a simulated PLC of its own that was just switched
//! on, so their order means nothing and the same file says the same on every machine.

mod suite;
pub use suite::{
    Check, CheckKind, Comparison, Expected, Flaw, Input, InputKind, Named, Scenario, Suite, Want,
};

mod table;

mod read;

mod steps;

mod surroundings;

mod bench;
pub use bench::{Bench, Failure, Report};

mod golden;
pub use golden::Golden;

mod picture;
pub use picture::{Mark, around, picture};

mod driver;
pub use driver::driver;

mod coverage;
pub use coverage::{ConditionKind, ContactCoverage, Counts, Coverage, RungCoverage};

mod lcov;
pub use lcov::lcov;

mod mutant;
pub use mutant::{Change, Fate, Mutant, Mutants};

mod witness;
pub use witness::shown;

mod recording;
pub use recording::{Recorded, Recording, of_counterexample};

/// What the names of files with scenario tests end in.
pub const SUITE_ENDING: &str = ".test.toml";

/// The programs that a file with scenario tests is about if it names none: those beside it of the same name.
pub fn programs_beside(name: &str) -> [String; 2] {
    let stem = name.strip_suffix(SUITE_ENDING).unwrap_or(name);
    ["lad", "il"].map(|ending| format!("{stem}.{ending}"))
}
