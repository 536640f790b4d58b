//! The contact that keeps two outputs from being on together: it asks for the one in the rung of the other.

use super::rewrite;
use crate::check::drawing::Drawn;
use crate::check::sense::{Key, Use};
use crate::check::statements::line_before;
use crate::check::{ChunkContext, ProgramContext};
use crate::document::{Act, Chunk, Tree};
use crate::il::fx::{FxLine, LineKind};
use crate::il::iec::ItemKind;
use crate::ladder::ContactKind;
use crate::logic::{self, Contact, Drive, Expression, Gate, Path, Term, Test};
use crate::target::iec::OperatorRole;
use crate::target::{Operand, Role};
use crate::text::{Message, Span, TextEdit};

/// The edits that lead the power of one of the two names only past the other that is off, with a title. What is written
/// once, each scan, behind all that writes the other, is then never on together with it: so neither is proved anew.
pub(super) fn of(context: &ProgramContext<'_>, numbers: [u32; 2]) -> Option<(Message, Vec<TextEdit>)> {
    let [one, other] = numbers;
    let (later, earlier) = match coil_behind(context, one, other) {
        Some(coil) => (coil, other),
        None => (coil_behind(context, other, one)?, one),
    };
    let uses = context.uses();
    let first = uses.of_name(earlier).find(|one| one.access.act.writes())?;
    let is_device = matches!(uses.name(earlier)?.key, Key::Device(_));
    // The name of a variable says the same in its own unit only.
    if !is_device && (first.file, first.unit) != (later.file, later.unit) {
        return None;
    }
    let (start, chunk) = uses.chunk(&later)?;
    let at = Span { start: later.span.start - start as u32, end: later.span.end - start as u32 };
    let name = uses.words(&first);
    let edits = match chunk.reading().tree() {
        Tree::Ladder(_) => in_drawing(context, &later, chunk, at, &name)?,
        _ => vec![in_list(chunk, at, &name)?],
    };
    let title = Message::new("mutual-exclusion.interlock").with("first", uses.words(&later));
    let title = title.with("second", name).with("rung", later.rung);
    Some((title, edits.into_iter().map(|edit| edit.shifted(start)).collect()))
}

/// The only place that writes `number`, if it is a coil that every scan comes to once, behind all that write `other`.
fn coil_behind(context: &ProgramContext<'_>, number: u32, other: u32) -> Option<Use> {
    let (uses, regions) = (context.uses(), context.regions());
    let mut writes = uses.of_name(number).filter(|one| one.access.act.writes());
    let (coil, None) = (writes.next()?, writes.next()) else { return None };
    let at = coil.span.start;
    let is_steady = regions.at(at).is_plain() && !regions.may_be_skipped(at) && !regions.may_be_repeated(at);
    let is_last = uses.written_at(other).iter().all(|write| *write < at);
    let is_elsewhere = |number: u32| {
        let name = uses.name(number);
        name.is_none_or(|name| matches!(name.key, Key::Device(device) if uses.is_written_in_row(device)))
    };
    let is_sure = is_steady && is_last && !is_elsewhere(number) && !is_elsewhere(other);
    (is_sure && coil.access.act == Act::Coil && coil.is_whole()).then_some(coil)
}

/// A line before the output, behind which nothing else hangs on the same power.
fn in_list(chunk: &Chunk, at: Span, name: &str) -> Option<TextEdit> {
    let reading = chunk.reading();
    let (output, word, ends) = match reading.tree() {
        Tree::Fx(tree) => {
            let number =
                tree.lines.iter().position(|line| line.span.start <= at.start && at.end <= line.span.end)?;
            let is_free = |line: &FxLine| match line.kind {
                LineKind::Instruction(form) => matches!(form.instruction.role, Role::Load | Role::Standalone),
                _ => true,
            };
            let line = tree.lines.get(number)?;
            let is_plain = tree.problems.is_empty() && tree.lines.iter().all(|line| line.step.is_none());
            (line.span, "ANI", is_plain && tree.lines.get(number + 1).is_none_or(is_free))
        }
        Tree::Iec(tree) => {
            let is_output = |kind: &ItemKind| matches!(kind, ItemKind::Operation { .. });
            let number = tree.items.iter().position(|item| {
                is_output(&item.kind) && item.span.start <= at.start && at.end <= item.span.end
            })?;
            let begins = |kind: &ItemKind| match kind {
                ItemKind::Operation { operation, .. } => operation.operator.role == OperatorRole::Load,
                kind => matches!(kind, ItemKind::Label { .. } | ItemKind::PouEnd(_)),
            };
            let next = tree.items.get(number + 1);
            (tree.items.get(number)?.span, "ANDN", next.is_none_or(|next| begins(&next.kind)))
        }
        Tree::Ladder(_) => return None,
    };
    let text = chunk.text();
    let before = text.get(..output.start as usize)?;
    let margin = &before[before.rfind('\n').map_or(0, |newline| newline + 1)..];
    let is_alone = margin.trim().is_empty();
    (ends && is_alone).then(|| line_before(text, output, &format!("{margin}{word} {name}")))
}

/// One contact more in series before the coil.
fn in_drawing(
    context: &ProgramContext<'_>,
    coil: &Use,
    chunk: &Chunk,
    at: Span,
    name: &str,
) -> Option<Vec<TextEdit>> {
    let document = context.files().get(coil.file)?.document;
    let chunk = ChunkContext::new(chunk, document, coil.unit.checked_sub(1));
    let drawn = Drawn::of(&chunk)?;
    let mut sound = drawn.sound_numbered();
    let (number, rung) = sound.find(|(_, rung)| {
        let mut operands = rung.graph.elements.iter().flat_map(|element| &element.operands);
        operands.any(|operand| operand.span == at)
    })?;
    let mut path = logic::of_graph(drawn.text, &rung.graph, drawn.scopes).ok()?;
    let operand = Operand::read(name, context.target().model);
    let contact = Contact {
        test: Test::Bit(ContactKind::NormallyClosed),
        terms: vec![Term::new(operand, name, Span::default())],
        span: Span::default(),
    };
    is_coil(&path, at).then(|| path.gates.push(Gate::Pass(Expression::Contact(contact))))?;
    rewrite::redrawn(&chunk, number, &path)
}

/// Whether the path drives nothing but the coil at `at`.
fn is_coil(path: &Path, at: Span) -> bool {
    match path.drives.as_slice() {
        [Drive::Action(action)] => {
            action.terms.first().is_some_and(|term| term.span == at) && action.terms.len() == 1
        }
        _ => false,
    }
}
