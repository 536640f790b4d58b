//! What a jump leaves out, a master control gates or a loop repeats. Where that is kept as a comment, so is what
//! depends on it: done in each scan, it would be something else.

use super::END_POINTER;
use crate::logic::{Action, Deed, Path};
use crate::target::Flow;
use crate::text::{Message, folded};
use crate::translate::Source;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// Something that decides whether, or how often, the rungs behind it are done.
pub(super) struct Guard {
    /// Why a rung is kept that depends on this guard, where that is kept.
    reason: Message,
    until: Until,
}

#[derive(PartialEq)]
enum Until {
    /// The rung with this folded label.
    Label(SmolStr),
    /// Behind the rung with this instruction.
    Behind(Flow),
    /// The end of the program unit.
    End,
}

/// The guards that each rung sets up. Jumps back guard nothing.
pub(super) fn all(sources: &[Source]) -> Vec<Vec<Guard>> {
    let mut last: FxHashMap<(Option<usize>, SmolStr), usize> = FxHashMap::default();
    for (number, source) in sources.iter().enumerate() {
        let labels = source.rung.labels.iter().map(|label| (source.pou, folded(label)));
        labels.for_each(|label| _ = last.insert(label, number));
    }
    let guards = |(number, source): (usize, &Source)| {
        let is_ahead = |label: &SmolStr| last.get(&(source.pou, label.clone())) > Some(&number);
        let holds = |guard: &Guard| !matches!(&guard.until, Until::Label(label) if !is_ahead(label));
        of(source).into_iter().filter(holds).collect()
    };
    sources.iter().enumerate().map(guards).collect()
}

/// Whether each rung may be left out, as a guard before it says.
pub(super) fn are(sources: &[Source]) -> Vec<bool> {
    let mut open = Open::default();
    let guarded = sources.iter().zip(all(sources)).map(|(source, own)| {
        let is_guarded = open.enter(source).is_some();
        open.set_up(own);
        is_guarded
    });
    guarded.collect()
}

/// The guards that are open on the way through the rungs of a program, from the first one on.
#[derive(Default)]
pub(super) struct Open {
    guards: Vec<Guard>,
    unit: Option<Option<usize>>,
}

impl Open {
    /// Comes to the next rung; gives why it is kept, if there is a guard that decides about it.
    pub(super) fn enter(&mut self, source: &Source) -> Option<Message> {
        if self.unit.replace(source.pou) != Some(source.pou) {
            self.guards.clear();
        }
        close_before(&mut self.guards, source);
        let reason = self.guards.last().map(|guard| guard.reason.clone());
        close_with(&mut self.guards, source);
        reason
    }

    /// Opens the guards of the rung that was entered.
    pub(super) fn set_up(&mut self, guards: Vec<Guard>) {
        self.guards.extend(guards);
    }
}

fn of(source: &Source) -> Vec<Guard> {
    match &source.rung.path {
        Ok(path) => path.iter().flat_map(Path::actions).filter_map(guard).collect(),
        // What cannot be read may jump as well.
        Err(_) => {
            let words: Vec<&str> = source.text().split_whitespace().collect();
            let jumps = words
                .windows(2)
                .filter(|pair| pair[0].get(..3).is_some_and(|word| word.eq_ignore_ascii_case("JMP")));
            jumps.map(|pair| jump("JMP", pair[1])).collect()
        }
    }
}

/// Closes the guards that end before a rung.
fn close_before(guards: &mut Vec<Guard>, source: &Source) {
    let labels: Vec<SmolStr> = source.rung.labels.iter().map(|label| folded(label)).collect();
    guards.retain(|guard| !matches!(&guard.until, Until::Label(label) if labels.contains(label)));
}

/// Closes the guards that end with a rung.
fn close_with(guards: &mut Vec<Guard>, source: &Source) {
    let flows = source.path().map(Path::actions).unwrap_or_default();
    let flows: Vec<Flow> = flows.into_iter().filter_map(flow).collect();
    guards.retain(|guard| !matches!(guard.until, Until::Behind(flow) if flows.contains(&flow)));
}

fn guard(action: &Action) -> Option<Guard> {
    let label = action.terms.first().map_or("", |term| term.text.as_str());
    let until = match &action.deed {
        Deed::Jump => return Some(jump("JMP", label)),
        Deed::Return => Until::End,
        Deed::Instruction(form) => match form.instruction.flow() {
            // P63 stands for END.
            Flow::Jump if label.eq_ignore_ascii_case(END_POINTER) => Until::End,
            Flow::Jump => return Some(jump("CJ", label)),
            Flow::SectionBegin => Until::Behind(Flow::SectionEnd),
            Flow::LoopBegin => Until::Behind(Flow::LoopEnd),
            Flow::Step => Until::Behind(Flow::StepsEnd),
            Flow::MainEnd => Until::End,
            _ => return None,
        },
        _ => return None,
    };
    let word = match &action.deed {
        Deed::Instruction(form) => form.mnemonic(),
        _ => "RET".to_string(),
    };
    // Whoever reads of a rung of a subroutine looks for its call.
    let key = match &action.deed {
        Deed::Instruction(form) if form.instruction.flow() == Flow::MainEnd => "translate.behind-main",
        _ => "translate.guarded",
    };
    Some(Guard { reason: Message::new(key).with("word", word), until })
}

fn jump(word: &str, label: &str) -> Guard {
    let reason = Message::new("translate.guarded").with("word", format_args!("{word} {label}"));
    Guard { reason, until: Until::Label(folded(label)) }
}

fn flow(action: &Action) -> Option<Flow> {
    match &action.deed {
        Deed::Instruction(form) => Some(form.instruction.flow()),
        _ => None,
    }
}
