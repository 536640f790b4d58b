//! What the rules about the structure of an FX program see of it: jumps, loops, sections, steps, labels and ends one
//! by one, and of the instructions between them the first and the last.
//!
//! Lines of instruction list and elements of ladders come alike. Structure is rare, so a page of a thousand lines is a
//! few milestones, and a rule passes over a program without looking at its lines.

use super::{Chunk, Operation, Tree};
use crate::il::fx::{FxLine, LineKind};
use crate::ladder::{Element, ElementKind};
use crate::target::{Device, Flow, Model, Operand};
use crate::text::{Span, Spanned};
use std::sync::Arc;

/// An instruction or a label, or a run of equal ones between milestones.
#[derive(Clone, PartialEq, Debug)]
pub struct Milestone {
    /// What it is.
    pub kind: MilestoneKind,
    /// How many statements it stands for: of a run of equal ones that have no part in the structure the first stands
    /// for itself and the last for all behind the first.
    pub count: u32,
    /// The mnemonic, the label, or the cells of a drawn element.
    pub word: Span,
    /// From the mnemonic to the last operand.
    pub span: Span,
    /// The number of its chunk in the page.
    chunk: u32,
    /// Where its chunk starts in the page.
    chunk_start: u32,
    /// The first operand of what has a part in the structure.
    first: Option<Box<Spanned<Operand>>>,
}

/// What a statement is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MilestoneKind {
    /// A label.
    Label(Device),
    /// An instruction, by its part in the structure of the program.
    Instruction(Flow),
    /// A word that the table does not have.
    Unknown,
}

impl Milestone {
    /// The first operand of a statement that has a part in the structure.
    pub fn first(&self) -> Option<Spanned<Operand>> {
        self.first.as_deref().copied()
    }

    /// The number of its chunk in the page.
    pub fn chunk(&self) -> usize {
        self.chunk as usize
    }

    /// Where its chunk starts in the page.
    pub fn chunk_start(&self) -> usize {
        self.chunk_start as usize
    }
}

impl MilestoneKind {
    /// Whether it has no part in the structure, so that of a run of such only the ends are of interest.
    pub fn is_plain(self) -> bool {
        matches!(self, MilestoneKind::Unknown | MilestoneKind::Instruction(Flow::Straight | Flow::Nothing))
    }
}

/// Offsets are those of the chunk.
pub(super) fn of_chunk(chunk: &Chunk) -> Vec<Milestone> {
    // Most chunks have nothing but a first and a last instruction of interest.
    let mut milestones = Vec::with_capacity(2);
    match chunk.tree() {
        Tree::Fx(tree) => {
            for line in &tree.lines {
                add(&mut milestones, kind_of(line), line.mnemonic, line.span, tree.operands(line).first());
            }
        }
        Tree::Ladder(tree) => {
            let label = tree.header.as_ref().and_then(|header| header.label);
            if let Some((label, device)) =
                label.and_then(|label| Some((label, pointer(label.of(chunk.text()))?)))
            {
                add(&mut milestones, MilestoneKind::Label(device), label, label, None);
            }
            let mut boxes = chunk.boxes().iter().peekable();
            for rung in &tree.rungs {
                while let Some((start, list)) = boxes.next_if(|(start, _)| *start < rung.span.start as usize)
                {
                    add_box(&mut milestones, *start, list);
                }
                rung.graph
                    .elements
                    .iter()
                    .for_each(|element| add_drawn(&mut milestones, element, chunk.text()));
            }
            boxes.for_each(|(start, list)| add_box(&mut milestones, *start, list));
        }
        Tree::Iec(_) => {}
    }
    milestones
}

/// The lines of a list in a box.
fn add_box(milestones: &mut Vec<Milestone>, start: usize, list: &Chunk) {
    let Tree::Fx(tree) = list.tree() else { return };
    for line in &tree.lines {
        let first =
            tree.operands(line).first().map(|first| Spanned::new(first.value, first.span.shifted(start)));
        let (word, span) = (line.mnemonic.shifted(start), line.span.shifted(start));
        add(milestones, kind_of(line), word, span, first.as_ref());
    }
}

fn kind_of(line: &FxLine) -> MilestoneKind {
    match line.kind {
        LineKind::Label(device) => MilestoneKind::Label(device),
        LineKind::Instruction(form) => MilestoneKind::Instruction(form.instruction.flow()),
        LineKind::Unknown => MilestoneKind::Unknown,
    }
}

fn add_drawn(milestones: &mut Vec<Milestone>, element: &Element, text: &str) {
    if let ElementKind::Jump(label) = element.kind {
        let Some(device) = pointer(label.of(text)) else { return };
        let first = Spanned::new(Operand::Device(device), label);
        let kind = MilestoneKind::Instruction(Flow::Jump);
        add(milestones, kind, element.span, element.span.to(label), Some(&first));
    } else if let Some(operation) = Operation::of_element(element) {
        add_element(milestones, &operation);
    }
}

fn add_element(milestones: &mut Vec<Milestone>, operation: &Operation<'_>) {
    let kind = match operation.form {
        Some(form) => MilestoneKind::Instruction(form.instruction.flow()),
        None => MilestoneKind::Unknown,
    };
    let last = operation.operands.last().filter(|_| operation.is_word);
    let span = last.map_or(operation.symbol, |operand| operation.symbol.to(operand.span));
    add(milestones, kind, operation.symbol, span, operation.operands.first());
}

fn add(
    milestones: &mut Vec<Milestone>,
    kind: MilestoneKind,
    word: Span,
    span: Span,
    first: Option<&Spanned<Operand>>,
) {
    if let Some(last) = run_end(milestones, kind) {
        (last.count, last.word, last.span) = (last.count + 1, word, span);
        return;
    }
    let first = first.filter(|_| !kind.is_plain()).map(|first| Box::new(*first));
    milestones.push(Milestone { kind, count: 1, word, span, chunk: 0, chunk_start: 0, first });
}

/// Offsets are those of the page.
pub(super) fn of_page(chunks: &[Arc<Chunk>]) -> Box<[Milestone]> {
    let mut milestones = Vec::new();
    let mut start = 0;
    for (number, chunk) in chunks.iter().enumerate() {
        for milestone in chunk.milestones() {
            let first = milestone.first.as_deref();
            let shifted = first.map(|first| Box::new(Spanned::new(first.value, first.span.shifted(start))));
            let (word, span) = (milestone.word.shifted(start), milestone.span.shifted(start));
            let (chunk, chunk_start) = (number as u32, start as u32);
            let moved = Milestone { word, span, chunk, chunk_start, first: shifted, ..*milestone };
            match run_end(&mut milestones, moved.kind) {
                Some(last) => *last = Milestone { count: last.count + moved.count, ..moved },
                None => milestones.push(moved),
            }
        }
        start += chunk.len();
    }
    milestones.into_boxed_slice()
}

/// The end of a run of statements of `kind` that have no part in the structure: the next one takes its place.
fn run_end(milestones: &mut [Milestone], kind: MilestoneKind) -> Option<&mut Milestone> {
    match milestones {
        [.., first, last] if kind.is_plain() && first.kind == kind && last.kind == kind => Some(last),
        _ => None,
    }
}

/// The pointer of the PLC that a label names.
fn pointer(name: &str) -> Option<Device> {
    let device = Operand::read(name, Model::Fx3u).device()?;
    device.kind.is_pointer().then_some(device)
}
