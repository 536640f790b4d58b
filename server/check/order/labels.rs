//! The labels of a program and the jumps to them, once for all rules about labels.

use crate::check::statements::{Statement, StatementKind, is_fx_program};
use crate::check::{ProgramContext, ProgramFile};
use crate::document::{Symbol, Use};
use crate::il::iec::ItemKind;
use crate::target::{Device, DeviceKind, Flow, Operand};
use crate::text::{Span, TextEdit};
use rustc_hash::{FxHashMap, FxHashSet};

/// The pointer that always means END.
pub(in crate::check) const END_POINTER: Device = Device::new(DeviceKind::P, 63);

/// The labels that see each other: those of an FX program, or of one POU.
#[derive(Default)]
pub(super) struct Labels<'a> {
    /// Where labels stand, in order.
    pub declared: Vec<Label>,
    /// Where jumps and calls name them, in order.
    pub jumps: Vec<Jump>,
    /// A jump goes to a label that an index register chooses, so each may be meant.
    pub any_may_be_meant: bool,
    /// EI stands somewhere: interrupt routines are run by their inputs.
    pub interrupts_allowed: bool,
    /// Where a POU in a list ends: the text of its last chunk, the start of that in the program, and the word.
    pub end: Option<(&'a str, usize, Span)>,
}

/// A label at its place.
pub(super) struct Label {
    pub symbol: Symbol,
    /// As it is written.
    pub name: String,
    pub span: Span,
    /// Takes it out.
    pub removal: Option<TextEdit>,
}

/// A place that names a label.
pub(super) struct Jump {
    pub symbol: Symbol,
    /// The label's name as it is written; empty where it is missing.
    pub name: String,
    pub span: Span,
    /// Whether it comes back, as CALL does.
    pub is_call: bool,
}

impl<'a> Labels<'a> {
    /// The labels of the program; those of each POU apart.
    pub fn of(context: &ProgramContext<'a>) -> Vec<Labels<'a>> {
        let documents = context.files().iter().map(|file| file.document);
        match documents.into_iter().any(is_fx_program) {
            true => vec![Labels::of_fx(context)],
            false => context.files().iter().flat_map(|file| Labels::of_pous(*file)).collect(),
        }
    }

    /// Those that jumps name.
    pub fn named(&self) -> FxHashSet<&Symbol> {
        self.jumps.iter().map(|jump| &jump.symbol).collect()
    }

    /// Those that stand somewhere.
    pub fn placed(&self) -> FxHashSet<&Symbol> {
        self.declared.iter().map(|label| &label.symbol).collect()
    }

    fn of_fx(context: &ProgramContext<'a>) -> Labels<'a> {
        let mut labels = Labels::default();
        for statement in context.executed() {
            match statement.kind {
                StatementKind::Label(device) => labels.declared.push(Label {
                    symbol: Symbol::Device(device),
                    name: device.to_string(),
                    span: statement.word,
                    removal: statement.removal(),
                }),
                StatementKind::Instruction(Flow::Jump | Flow::Call) => labels.add_jump(&statement),
                StatementKind::Instruction(Flow::InterruptsAllowed) => labels.interrupts_allowed = true,
                _ => {}
            }
        }
        labels
    }

    fn add_jump(&mut self, statement: &Statement<'_>) {
        let Some(operand) = statement.first else { return };
        match operand.value {
            Operand::Device(device) if device.kind == DeviceKind::P => {
                let (symbol, name) = (Symbol::Device(device), device.to_string());
                let is_call = statement.flow() == Some(Flow::Call);
                self.jumps.push(Jump { symbol, name, span: operand.span, is_call });
            }
            Operand::Indexed { .. } => self.any_may_be_meant = true,
            _ => {}
        }
    }

    fn of_pous(file: ProgramFile<'a>) -> Vec<Labels<'a>> {
        let mut pous: FxHashMap<usize, Labels<'a>> = FxHashMap::default();
        let mut pou = 0;
        for at in file.chunks() {
            pou += at.chunk.pou_starts();
            for mention in at.chunk.mentions().iter().filter(|m| matches!(m.symbol, Symbol::Label(_))) {
                let labels = pous.entry(pou).or_default();
                let (symbol, span) = (mention.symbol.clone(), mention.span.shifted(at.start));
                let name = mention.span.of(at.chunk.text()).to_string();
                match mention.usage {
                    Use::Declare => labels.declared.push(Label { symbol, name, span, removal: None }),
                    Use::Jump => labels.jumps.push(Jump { symbol, name, span, is_call: false }),
                    Use::Read | Use::Write | Use::ReadWrite => {}
                }
            }
            let items = at.chunk.iec().map_or(&[][..], |tree| &tree.items);
            let end = items.iter().find(|item| matches!(item.kind, ItemKind::PouEnd(_)));
            if let (Some(end), Some(labels)) = (end, pous.get_mut(&pou)) {
                labels.end = Some((at.chunk.text(), at.start, end.span));
            }
        }
        let mut pous: Vec<(usize, Labels<'a>)> = pous.into_iter().collect();
        pous.sort_by_key(|(pou, _)| *pou);
        pous.into_iter().map(|(_, labels)| labels).collect()
    }
}
