//! Rules about the sense of programs, where a page is too small.

use rungwise::check::{RULES, Severities};

/// The settings of a project that looks at fragments: what is read in them is written elsewhere.
pub fn without_sense() -> Severities {
    let first = RULES.iter().position(|rule| rule.code == "double-coil").expect("the first of its group");
    Severities(RULES[first..].iter().map(|rule| (rule.code.to_string(), None)).collect())
}
