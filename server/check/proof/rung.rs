//! The rungs of a chunk that are worth a proof, and how their conditions are named.

use crate::check::ChunkContext;
use crate::check::drawing::Drawn;
use crate::document::Tree;
use crate::il::fx::{FxLine, FxTree, LineKind};
use crate::ladder::{ContactKind, Element, Graph};
use crate::logic::{
    self, Action, Contact, Declared, Drive, Expression, Formulas, Gate, Path, Run, Term, Test,
};
use crate::target::{DeviceKind, Operand, Role};
use crate::text::Span;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// A rung, and where it stands.
pub(super) struct ProofRung {
    pub path: Path,
    /// Its number in the drawing; nothing in a list.
    pub drawn: Option<usize>,
    /// Whether each contact stands for one place of the text: an exclusive or of a list is read as several.
    pub is_as_written: bool,
}

/// Rungs with more contacts are not proved, so that a keystroke in them stays cheap.
const CONTACTS_MAX: usize = 500;

/// The rungs of a chunk of which proofs may tell something.
pub(super) fn rungs(context: &ChunkContext<'_>) -> Vec<ProofRung> {
    let chunk = context.chunk;
    let mut rungs = Vec::new();
    let mut add = |path: Path, drawn: Option<usize>| {
        if let Some(is_as_written) = is_worth_it(&path) {
            rungs.push(ProofRung { path, drawn, is_as_written });
        }
    };
    match chunk.tree() {
        Tree::Ladder(_) => {
            let Some(drawn) = Drawn::of(context) else { return rungs };
            for (number, rung) in drawn.sound_numbered() {
                if names_twice(&rung.graph, drawn.text)
                    && let Ok(path) = logic::of_graph(drawn.text, &rung.graph, drawn.scopes)
                {
                    add(path, Some(number));
                }
            }
        }
        Tree::Fx(tree) if !asks_twice(tree) => {}
        Tree::Fx(_) | Tree::Iec(_) => {
            let pous = context.pou.map_or(0, |pou| pou + 1).saturating_sub(chunk.pou_starts());
            let declared = Declared { scopes: context.scopes, pous };
            for rung in logic::rungs_with(chunk, context.target, declared) {
                if let Ok(Some(path)) = rung.path {
                    add(path, None);
                }
            }
        }
    }
    rungs
}

/// Whether an element names something that another one of the rung names, too, or compares something: a look that costs
/// less than reading the rung.
fn names_twice(graph: &Graph, text: &str) -> bool {
    let mut seen: FxHashSet<String> = FxHashSet::default();
    let named = |element: &&Element| !element.operands.is_empty();
    graph.elements.iter().filter(named).any(|element| {
        element.operands.len() > 1 || !seen.insert(element.operand_text(0, text).to_lowercase())
    })
}

/// Lists with more lines are read without a look.
const LINES_MAX: usize = 64;

/// Whether a contact of a list names something that stands before it, too, or compares something.
fn asks_twice(tree: &FxTree) -> bool {
    let is_contact = |line: &FxLine| match line.kind {
        LineKind::Instruction(form) => {
            matches!(form.instruction.role, Role::Load | Role::Series | Role::Parallel)
        }
        _ => false,
    };
    let asks_again = |line: &FxLine| {
        let before = tree.operands.get(..line.operands.0 as usize).unwrap_or(&[]);
        let own = tree.operands(line);
        own.len() > 1 || own.iter().any(|one| before.iter().any(|other| other.value == one.value))
    };
    tree.lines.len() > LINES_MAX || tree.lines.iter().any(|line| is_contact(line) && asks_again(line))
}

/// Whether a contact asks for something that the rung asks for or drives before it, or a comparison is decided by its
/// number alone; nothing if not, or if what never changes is part of the conditions: that was meant. With it whether
/// each contact stands in one place.
fn is_worth_it(path: &Path) -> Option<bool> {
    let mut look =
        Look { contacts: 0, seen: FxHashSet::default(), spans: FxHashSet::default(), found: false };
    look.path(path)?;
    look.found.then_some(look.spans.len() == look.contacts)
}

struct Look {
    contacts: usize,
    seen: FxHashSet<SmolStr>,
    spans: FxHashSet<Span>,
    found: bool,
}

impl Look {
    fn path(&mut self, path: &Path) -> Option<()> {
        for gate in &path.gates {
            match gate {
                Gate::Pass(expression) => self.expression(expression)?,
                Gate::Invert => {}
                Gate::Through(action) => self.action(action),
            }
        }
        path.drives.iter().try_for_each(|drive| match drive {
            Drive::Action(action) => {
                self.action(action);
                Some(())
            }
            Drive::Path(path) => self.path(path),
        })
    }

    fn action(&mut self, action: &Action) {
        self.seen.extend(action.terms.first().map(Term::key));
    }

    fn expression(&mut self, expression: &Expression) -> Option<()> {
        let contact = match expression {
            Expression::Constant(_) => return None,
            Expression::Contact(contact) => contact,
            _ => return expression.parts().iter().try_for_each(|part| self.expression(part)),
        };
        self.contacts += 1;
        if contact.terms.iter().all(is_constant) || self.contacts > CONTACTS_MAX {
            return None;
        }
        self.spans.insert(contact.span);
        for term in contact.terms.iter().filter(|term| !is_constant(term)) {
            self.found |= !self.seen.insert(term.key());
        }
        self.found |= decided(contact).is_some();
        Some(())
    }
}

/// Whether part of the conditions never changes, which was meant so.
pub(super) fn has_constant(path: &Path) -> bool {
    let mut found = false;
    path.visit(&mut |_| {}, &mut |condition| {
        condition.visit(&mut |contact| found |= contact.terms.iter().all(is_constant));
        found |= matches!(condition, Expression::Constant(_));
    });
    found
}

/// Whether it has one value in each scan, as M8000 has.
fn is_constant(term: &Term) -> bool {
    match term.operand {
        Operand::Device(device) => device.kind == DeviceKind::M && matches!(device.number, 8000 | 8001),
        Operand::Constant { .. } | Operand::Literal(_) => true,
        _ => false,
    }
}

/// The answer of a comparison that has the same for all values of its words.
pub(super) fn decided(contact: &Contact) -> Option<bool> {
    let Test::Compare(_) = contact.test else { return None };
    match Run::new().contact(contact, &mut Formulas::default()) {
        Formulas::TRUE => Some(true),
        Formulas::FALSE => Some(false),
        _ => None,
    }
}

/// Whether two contacts ask for the same device.
pub(super) fn share_a_device(one: &Contact, other: &Contact) -> bool {
    one.terms.iter().any(|term| !is_constant(term) && other.terms.contains(term))
}

/// What a contact asks, in a form that needs no language: `X0`, `NOT X0`, `D0 >= K5`.
pub(super) fn name_of(contact: &Contact) -> String {
    let words = |side: usize| contact.terms.get(side).map_or("", |term| term.text.as_str());
    match contact.test {
        Test::Bit(ContactKind::NormallyOpen) => words(0).to_string(),
        Test::Bit(ContactKind::NormallyClosed) => format!("NOT {}", words(0)),
        Test::Bit(ContactKind::Rising) => format!("{}↑", words(0)),
        Test::Bit(ContactKind::Falling) => format!("{}↓", words(0)),
        Test::Compare(operator) => format!("{} {} {}", words(0), operator.sign(), words(1)),
    }
}

/// So many names are told.
const NAMES_MAX: usize = 5;

/// The devices that `conditions` ask for, each once, as they are written.
pub(super) fn devices_of<'e>(conditions: impl IntoIterator<Item = &'e Expression>) -> String {
    let mut seen = FxHashSet::default();
    let mut names: Vec<&str> = Vec::new();
    for condition in conditions {
        condition.visit(&mut |contact| {
            let new = contact.terms.iter().filter(|term| !is_constant(term) && seen.insert(term.key()));
            names.extend(new.map(|term| term.text.as_str()));
        });
    }
    let shown: Vec<String> = names.iter().take(NAMES_MAX).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > NAMES_MAX { ", …" } else { "" };
    shown.join(", ") + more
}
