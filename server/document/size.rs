//! How much program a chunk is, counted once and summed up page by page.

use super::{Chunk, Tree};
use crate::il::fx::{self, FxLine, LineKind};
use crate::il::iec::ItemKind;
use crate::target::Role;
use std::iter::Sum;

/// How much program a piece of a document is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Size {
    /// Rungs; in IEC Instruction List, blocks of statements that start with a load.
    pub rungs: usize,
    /// Program steps of the FX instructions in it. In ladder those that stand for elements; the ones that join
    /// branches are known only once the rung is translated.
    pub steps: u32,
}

impl Size {
    pub(super) fn of(chunk: &Chunk) -> Size {
        match chunk.tree() {
            Tree::Fx(tree) => {
                let drives = |line: &FxLine| match line.kind {
                    LineKind::Instruction(form) => form.instruction.role == Role::Output,
                    _ => false,
                };
                Size { rungs: usize::from(tree.lines.iter().any(drives)), steps: fx::steps(tree) }
            }
            Tree::Ladder(tree) => {
                let steps = chunk.operations().map(|operation| operation.steps());
                let drawn = Size { rungs: tree.rungs.len(), steps: steps.fold(0, u32::saturating_add) };
                chunk.boxes().iter().map(|(_, list)| list.size()).chain([drawn]).sum()
            }
            Tree::Iec(tree) => {
                let acts = tree.items.iter().any(|item| {
                    matches!(
                        item.kind,
                        ItemKind::Operation { .. }
                            | ItemKind::Jump { .. }
                            | ItemKind::Call { .. }
                            | ItemKind::Function { .. }
                            | ItemKind::InputOperator { .. }
                    )
                });
                Size { rungs: usize::from(acts), steps: 0 }
            }
        }
    }
}

impl Sum for Size {
    fn sum<I: Iterator<Item = Size>>(sizes: I) -> Size {
        sizes.fold(Size::default(), |sum, size| Size {
            rungs: sum.rungs + size.rungs,
            steps: sum.steps.saturating_add(size.steps),
        })
    }
}
