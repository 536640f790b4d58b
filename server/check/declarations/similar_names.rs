//! # similar-names
//!
//! In a ladder without declarations every name is a variable by being used. This one is used once, and is one letter
//! away from another that is used more often.
//!
//! A contact that misses its variable by a letter reads a variable of its own, which nothing ever writes: the contact
//! stays open, or closed, for good. Declare the variables (`VAR … END_VAR`) and such a slip becomes an error.
//!
//! ```lad iec
//! |   start     stop                     motor   |
//! +---| |---+---|/|-----------------------( )----+
//! |  moter  |                                    |
//!    ^^^^^
//! +---| |---+                                    |
//!
//! |   motor                              lamp    |
//! +---| |---------------------------------( )----+
//! ```
//!
//! ```lad iec
//! |   start     stop                     motor   |
//! +---| |---+---|/|-----------------------( )----+
//! |  motor  |                                    |
//! +---| |---+                                    |
//!
//! |   motor                              lamp    |
//! +---| |---------------------------------( )----+
//! ```

use crate::check::{ProgramContext, Rule, Run};
use crate::document::{Document, Notation, Symbol, Use};
use crate::target::iec::nearest;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

pub(super) const RULE: Rule = Rule {
    code: "similar-names",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("similar_names.rs"),
};

/// So many names are compared with all others; who has more names that are used once has another habit.
const MOST_COMPARED: usize = 100;

/// Shorter names differ in one letter because they have no more.
const LEAST_CHARACTERS: usize = 4;

/// The uses of a name.
#[derive(Default)]
struct Uses {
    count: usize,
    first: Span,
    written: bool,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    context.each_file(found, check_file);
}

fn check_file(document: &Document, found: &mut Vec<Diagnostic>) {
    if document.notation() != Notation::Ladder || !document.scopes().own_pous().is_empty() {
        return;
    }
    let mut names: FxHashMap<&SmolStr, Uses> = FxHashMap::default();
    for at in document.chunks() {
        for mention in at.chunk.mentions().iter().filter(|mention| mention.usage != Use::Declare) {
            let Symbol::Variable(name) = &mention.symbol else { continue };
            let uses = names.entry(name).or_default();
            if uses.count == 0 {
                uses.first = mention.span.shifted(at.start);
            }
            uses.count += 1;
            uses.written |= mention.usage.writes();
        }
    }
    let mut single: Vec<(&SmolStr, Span)> = names
        .iter()
        .filter(|(name, uses)| uses.count == 1 && !uses.written && name.chars().count() >= LEAST_CHARACTERS)
        .map(|(name, uses)| (*name, uses.first))
        .collect();
    single.sort_unstable_by_key(|(_, span)| *span);
    for (name, span) in single.into_iter().take(MOST_COMPARED) {
        let others = names.iter().filter(|(_, uses)| uses.count > 1).map(|(other, _)| other.as_str());
        // `pump_1` and `pump_2` are two things.
        let digits = |name: &str| name.chars().filter(char::is_ascii_digit).collect::<String>();
        let near = nearest(name, others);
        let Some(other) = near.into_iter().find(|other| digits(other) == digits(name)) else { continue };
        let first = names.get(&SmolStr::from(other.as_str())).map_or(span, |uses| uses.first);
        let (word, other) = (document.slice(span), document.slice(first));
        let message = Message::new("similar-names.found").with("name", &word).with("other", &other);
        let related = Message::new("similar-names.other").with("other", &other);
        let mut diagnostic = Diagnostic::new(RULE.code, span, message).related(first, related);
        // Of another length it could come to stand over another element.
        if word.chars().count() == other.chars().count() {
            let title = Message::new("similar-names.rename").with("other", &other);
            diagnostic = diagnostic.fix(title, vec![TextEdit::new(span, other)]);
        }
        found.push(diagnostic);
    }
}
