//! # unreachable-code
//!
//! Nothing ever leads to these instructions: they stand behind a jump that is always taken, or behind the end of the
//! main program, of a subroutine or of an interrupt routine, and no label stands before them. Outputs that are driven
//! here stay off, whatever the rungs say.
//!
//! ```fx
//! LD X0
//! OUT Y0
//! FEND
//! LD X1
//! ^^
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! LD X0
//! CALL P1
//! FEND
//! P1
//! LD X1
//! OUT Y1
//! SRET
//! END
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Start
//!     ST Motor
//!     RET
//!     LD FALSE
//!     ^^^^^^^^
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Start
//!     JMPC run
//!     LD FALSE
//!     ST Motor
//!     RET
//! run:
//!     LD TRUE
//!     ST Motor
//! END_PROGRAM
//! ```

use crate::check::statements::{Statement, StatementKind};
use crate::check::{ProgramContext, ProgramFile, Rule, Run};
use crate::document::{JointKind, Tree};
use crate::il::fx::{FxTree, LineKind};
use crate::il::iec::{Condition, ItemKind};
use crate::ladder::{ContactKind, Element, ElementKind, LadderTree};
use crate::target::{Device, Flow, Operand, Role};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "unreachable-code",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("unreachable_code.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    if context.uses().is_fx {
        of_fx(context, found);
    } else {
        context.files().iter().for_each(|file| of_units(*file, found));
    }
}

/// A run of instructions that nothing leads to.
struct Dead<'a> {
    leaves: Statement<'a>,
    first: Option<Statement<'a>>,
    last: Option<Statement<'a>>,
}

fn of_fx(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut dead: Option<Dead<'_>> = None;
    for statement in context.executed() {
        let ends = match statement.kind {
            StatementKind::Label(_) => true,
            StatementKind::Instruction(flow) => is_structure(flow),
            StatementKind::Unknown => false,
        };
        match &mut dead {
            Some(run) if !ends => {
                if statement.flow() != Some(Flow::Nothing) {
                    run.first.get_or_insert(statement);
                    run.last = Some(statement);
                }
                continue;
            }
            _ => {}
        }
        found.extend(dead.take().and_then(|run| run.diagnostic()));
        let leaves = match statement.flow() {
            Some(Flow::MainEnd | Flow::SubroutineEnd | Flow::InterruptEnd) => true,
            Some(Flow::Jump) => is_always_taken(&statement),
            _ => false,
        };
        dead = leaves.then_some(Dead { leaves: statement, first: None, last: None });
    }
    found.extend(dead.and_then(|run| run.diagnostic()));
}

/// What may stand without a label where nothing leads to, as it closes something that others begin.
fn is_structure(flow: Flow) -> bool {
    use Flow::{Call, Jump, LoopBegin, Nothing, Refresh, Straight};
    !matches!(flow, Straight | Refresh | Nothing | Call | Jump | LoopBegin)
}

impl Dead<'_> {
    fn diagnostic(self) -> Option<Diagnostic> {
        let (first, last) = (self.first?, self.last?);
        let message = Message::new("unreachable-code.found").with("leaves", self.leaves.mnemonic());
        let related = Message::new("unreachable-code.leaves").with("leaves", self.leaves.mnemonic());
        let diagnostic = Diagnostic::new(RULE.code, first.word, message).related(self.leaves.span, related);
        let removal = first
            .removal()
            .zip(last.removal())
            .map(|(first, last)| TextEdit::new(Span { start: first.span.start, end: last.span.end }, ""));
        Some(match removal {
            Some(edit) => diagnostic.fix(Message::new("unreachable-code.remove"), vec![edit]),
            None => diagnostic,
        })
    }
}

/// Whether a jump has no condition, or only the relay that is always on.
fn is_always_taken(jump: &Statement<'_>) -> bool {
    let (chunk, word) = jump.in_chunk();
    let reading = chunk.reading();
    match reading.tree() {
        Tree::Fx(tree) => is_always_taken_in_list(tree, word),
        Tree::Ladder(tree) => is_always_taken_in_drawing(tree, word),
        Tree::Iec(_) => false,
    }
}

fn is_always_taken_in_list(tree: &FxTree, word: Span) -> bool {
    let Some(place) = tree.lines.iter().position(|line| line.mnemonic == word) else { return false };
    let form = |kind: LineKind| match kind {
        LineKind::Instruction(form) => Some(form),
        _ => None,
    };
    let before = tree.lines[..place].iter().filter(|line| !matches!(line.kind, LineKind::Label(_)));
    let mut before = before.map(|line| (form(line.kind), tree.operands(line).first().map(|one| one.value)));
    let loads_always_on = matches!(
        before.next(),
        Some((Some(load), Some(Operand::Device(Device::ALWAYS_ON))))
            if load.instruction.role == Role::Load && !load.instruction.is_inverse_contact()
                && !load.instruction.is_edge_contact()
    );
    let is_pulsed = form(tree.lines[place].kind).is_some_and(|form| form.pulse);
    // Outputs on the same result do not change it.
    loads_always_on
        && !is_pulsed
        && before.all(|(form, _)| form.is_some_and(|form| form.instruction.role == Role::Output))
}

fn is_always_taken_in_drawing(tree: &LadderTree, word: Span) -> bool {
    let is_jump = |element: &Element| match &element.kind {
        ElementKind::Instruction { mnemonic, .. } => *mnemonic == word,
        ElementKind::Jump(_) => element.span == word,
        _ => false,
    };
    let rung = tree.rungs.iter().find(|rung| rung.graph.elements.iter().any(is_jump));
    let Some(rung) = rung else { return false };
    let is_pulsed = |element: &Element| match &element.kind {
        ElementKind::Instruction { form, .. } => form.is_some_and(|form| form.pulse),
        _ => false,
    };
    rung.graph.elements.iter().all(|element| match element.kind {
        ElementKind::Contact(ContactKind::NormallyOpen) => element.device() == Some(Device::ALWAYS_ON),
        _ => element.is_output() && !(is_jump(element) && is_pulsed(element)),
    })
}

/// Units of IEC 61131-3. Pages without jumps are passed over.
fn of_units(file: ProgramFile<'_>, found: &mut Vec<Diagnostic>) {
    let mut start = file.start;
    let mut left: Option<Span> = None;
    for page in file.document.pages() {
        let leaves = |kind: &JointKind| matches!(kind, JointKind::Jump(_) | JointKind::Return);
        if left.is_none() && !page.accesses().joints.iter().any(|joint| leaves(&joint.kind)) {
            start += page.bytes();
            continue;
        }
        for chunk in page.chunks() {
            let items = chunk.iec().map_or(&[][..], |tree| &tree.items);
            for item in items {
                match item.kind {
                    ItemKind::Jump { word, condition: Condition::Always, .. }
                    | ItemKind::Return { word, condition: Condition::Always }
                        if left.is_none() =>
                    {
                        left = Some(word.shifted(start));
                    }
                    ItemKind::Label { .. }
                    | ItemKind::Pou { .. }
                    | ItemKind::PouEnd(_)
                    | ItemKind::End(_)
                    | ItemKind::Configuration { .. } => left = None,
                    _ => {
                        if let Some(jump) = left.take() {
                            found.push(behind(file, jump, item.span.shifted(start)));
                        }
                    }
                }
            }
            start += chunk.len();
        }
    }
}

fn behind(file: ProgramFile<'_>, jump: Span, first: Span) -> Diagnostic {
    let word = file.document.slice(back(jump, file.start));
    let message = Message::new("unreachable-code.found").with("leaves", &word);
    let related = Message::new("unreachable-code.leaves").with("leaves", &word);
    Diagnostic::new(RULE.code, first, message).related(jump, related)
}

fn back(span: Span, start: usize) -> Span {
    Span { start: span.start - start as u32, end: span.end - start as u32 }
}
