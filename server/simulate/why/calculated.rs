//! Why instructions write what they do behind calculations, of which no power is known that could be followed.

use super::subject::Subject;
use super::{Inquiry, Moment, Reason};
use crate::il::iec::{Direction, IecTree, Item, ItemKind, ListForm, Parameter, ParameterValue};
use crate::simulate::Place;
use crate::target::iec::OperatorRole;
use crate::text::{Message, Span};

/// The tree of a chunk, with the text of that and where it begins.
struct Reading<'a> {
    tree: &'a IecTree,
    text: &'a str,
    start: usize,
}

impl Inquiry<'_> {
    /// Why an instruction with a number gave a value, or would give it: what stands before it, and what that has read.
    pub(super) fn calculated(
        &self,
        subject: &Subject,
        instruction: u32,
        at: Moment,
        told: &dyn Fn(Message) -> Message,
        asked: &mut Vec<Subject>,
    ) -> Reason {
        let place = self.place_of(instruction);
        let words = self.words(place);
        let words = Message::new(self.how(instruction, at)).with("instruction", words.trim_end_matches(';'));
        let because = match self.watched.iec.names().scope_at(instruction) {
            Some(frame) => self.read_before(instruction, frame, at, asked),
            None => self.connected(subject, place, at, asked),
        };
        self.reason(told(words), Some(place), at.scan, because)
    }

    /// One that might have written something and did not.
    pub(super) fn idly_calculated(
        &self,
        subject: &Subject,
        instruction: u32,
        moment: Moment,
        asked: &mut Vec<Subject>,
    ) -> Reason {
        let seen = self.seen(moment.scan);
        let is_own = |number: &usize| {
            let sight = seen.as_ref().and_then(|seen| seen.at(*number));
            sight.is_some_and(|sight| sight.instruction == instruction)
        };
        match (0..moment.before).rev().find(is_own) {
            Some(number) => {
                self.calculated(subject, instruction, Moment { before: number, ..moment }, &|how| how, asked)
            }
            None => {
                let place = self.place_of(instruction);
                let frame = self.watched.iec.names().scope_at(instruction);
                let because = frame.and_then(|frame| self.skipped(place, Some(frame), moment, asked));
                if let (None, Some(earlier)) = (&because, self.scan_before(moment)) {
                    return self.idly_calculated(subject, instruction, earlier, asked);
                }
                let message = Message::new("why.not-executed").with("instruction", self.words(place));
                self.reason(message, Some(place), moment.scan, because.into_iter().collect())
            }
        }
    }

    /// Whether an instruction stands in the text: what variables are at first does not.
    pub(super) fn stands(&self, instruction: u32) -> bool {
        let names = self.watched.iec.names();
        names.scope_at(instruction).is_none_or(|frame| names.instructions_of(frame).start != instruction)
    }

    /// Whether something stands in an instruction list of IEC 61131-3.
    pub(super) fn is_in_list(&self, place: Place) -> bool {
        self.reading(place).is_some()
    }

    fn how(&self, instruction: u32, at: Moment) -> &'static str {
        if !self.stands(instruction) {
            return "why.begins";
        }
        let place = self.place_of(instruction);
        let item = self.reading(place).and_then(|reading| Some(reading.tree.items[reading.item(place)?]));
        let role = match item.map(|item| item.kind) {
            Some(ItemKind::Operation { operation, .. }) => operation.operator.role,
            _ => return "why.executed",
        };
        let sight = self.seen(at.scan).and_then(|seen| seen.at(at.before));
        match (role, sight) {
            (OperatorRole::Latch { .. }, Some(sight)) if sight.power == 0 => "why.unpowered",
            (OperatorRole::Latch { .. }, Some(_)) => "why.powered",
            _ => "why.executed",
        }
    }

    fn reading(&self, place: Place) -> Option<Reading<'_>> {
        let at = self.documents.get(place.document as usize)?.chunk_at(place.span.start as usize)?;
        let boxed = at.chunk.box_at((place.span.start as usize).checked_sub(at.start)?);
        let (start, chunk) = boxed.map_or((at.start, &**at.chunk), |(start, list)| (at.start + start, list));
        Some(Reading { tree: chunk.iec()?, text: chunk.text(), start })
    }

    /// What the instructions before one have read for it, since the current result began.
    fn read_before(
        &self,
        instruction: u32,
        frame: usize,
        at: Moment,
        asked: &mut Vec<Subject>,
    ) -> Vec<Reason> {
        let place = self.place_of(instruction);
        let Some(reading) = self.reading(place) else { return Vec::new() };
        let Some(own) = reading.item(place) else { return Vec::new() };
        let range = self.watched.iec.names().instructions_of(frame);
        let Some(seen) = self.seen(at.scan) else { return Vec::new() };
        let mut reasons = Vec::new();
        let first = reading.begin(own);
        for item in &reading.tree.items[first..reading.behind(own)] {
            let place = Place { span: item.span.shifted(reading.start), ..place };
            let sight = seen.last(self.watched, place, Some(range.clone()), at.before + 1);
            let at = Moment { before: sight.map_or(at.before, |(number, _)| number), ..at };
            let subjects: Vec<Subject> = reading
                .reads(item)
                .iter()
                .filter_map(|span| self.subject_in(frame, span.of(reading.text)))
                .collect();
            for reason in self.values_of(&subjects, at, asked) {
                if !reasons.iter().any(|known: &Reason| known.message == reason.message) {
                    reasons.push(Reason { place: reason.place.or(Some(place)), ..reason });
                }
            }
        }
        let before = &reading.tree.items[first..own];
        let is_plain = matches!(before, [] | [Item { kind: ItemKind::Operation { .. }, .. }]);
        if is_plain || reasons.is_empty() {
            return reasons;
        }
        let lines = before.iter().map(|item| item.span.of(reading.text).split_whitespace());
        let lines: Vec<String> = lines.map(|words| words.collect::<Vec<_>>().join(" ")).collect();
        let message = Message::new("why.calculated").with("instruction", lines.join(", "));
        let place = Place { span: before[0].span.shifted(reading.start), ..place };
        vec![self.reason(message, Some(place), at.scan, reasons)]
    }

    /// What a configuration connects with an input of a program, or with what an output of it is written to.
    fn connected(
        &self,
        subject: &Subject,
        place: Place,
        at: Moment,
        asked: &mut Vec<Subject>,
    ) -> Vec<Reason> {
        let Some(reading) = self.reading(place) else { return Vec::new() };
        let Some(own) = reading.item(place) else { return Vec::new() };
        let ItemKind::Instance(number) = reading.tree.items[own].kind else { return Vec::new() };
        let instance = reading.tree.instances[number as usize];
        let resources = reading.tree.items[..own].iter().rev();
        let resource = resources.filter_map(|item| match item.kind {
            ItemKind::Resource { name, .. } => name,
            _ => None,
        });
        let program: Vec<&str> =
            resource.take(1).chain(instance.name).map(|name| name.of(reading.text)).collect();
        for parameter in instance.parameters.of(&reading.tree.parameters) {
            let (Some(name), ParameterValue::Operand(id)) = (parameter.name, parameter.value) else {
                continue;
            };
            let pin = self.subject(&format!("{}.{}", program.join("."), name.of(reading.text)));
            let other = self.subject(reading.tree.operand(id).span.of(reading.text));
            let (to, from) = match parameter.direction {
                Direction::Out { .. } => (other, pin),
                Direction::In => (pin, other),
            };
            if to.is_some_and(|to| to == *subject) {
                return self.values_of(&from.into_iter().collect::<Vec<_>>(), at, asked);
            }
        }
        Vec::new()
    }

    fn subject_in(&self, frame: usize, name: &str) -> Option<Subject> {
        self.watched.variable_in(frame, name).map(|variable| self.variable_subject(variable, name))
    }
}

impl Reading<'_> {
    /// The number of the item at a place.
    fn item(&self, place: Place) -> Option<usize> {
        self.tree.items.iter().position(|item| item.span.shifted(self.start) == place.span)
    }

    /// The item with which the current result began that an item sees.
    fn begin(&self, own: usize) -> usize {
        let depth = self.tree.items[own].depth;
        let begins = |item: &Item| match item.kind {
            ItemKind::Operation { operation, .. } => operation.operator.role == OperatorRole::Load,
            ItemKind::Function { form, .. } => form != ListForm::None,
            _ => false,
        };
        let mut first = own;
        while !(begins(&self.tree.items[first]) && self.tree.items[first].depth == depth) {
            let before = first.checked_sub(1).map(|before| (before, self.tree.items[before].kind));
            match before {
                Some((before, kind)) if is_instruction(kind) => first = before,
                _ => return first,
            }
        }
        first
    }

    /// The one behind an item and the lists that are handed over in it.
    fn behind(&self, own: usize) -> usize {
        let items = &self.tree.items;
        let mut next = own + 1;
        while matches!(items.get(next).map(|item| item.kind), Some(ItemKind::ParameterOpen { .. })) {
            let depth = items[next].depth;
            let is_close = |item: &Item| item.kind == ItemKind::Close && item.depth == depth;
            next += items[next..].iter().position(is_close).map_or(items.len() - next, |close| close + 1);
        }
        next
    }

    /// Where operands stand that an item reads.
    fn reads(&self, item: &Item) -> Vec<Span> {
        let read = |parameter: &Parameter| match (parameter.direction, parameter.value) {
            (Direction::In, ParameterValue::Operand(id)) => Some(self.tree.operand(id).span),
            _ => None,
        };
        match item.kind {
            ItemKind::Operation { operation, operand } => match operation.operator.role {
                OperatorRole::Store | OperatorRole::Latch { .. } => Vec::new(),
                _ => operand.map(|id| self.tree.operand(id).span).into_iter().collect(),
            },
            ItemKind::Open { operand, .. } => {
                operand.map(|id| self.tree.operand(id).span).into_iter().collect()
            }
            ItemKind::Function { parameters, .. } | ItemKind::Call { parameters, .. } => {
                parameters.of(&self.tree.parameters).iter().filter_map(read).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Whether the current result may come through it from above.
fn is_instruction(kind: ItemKind) -> bool {
    matches!(
        kind,
        ItemKind::Operation { .. }
            | ItemKind::Open { .. }
            | ItemKind::Close
            | ItemKind::Function { .. }
            | ItemKind::Call { .. }
            | ItemKind::InputOperator { .. }
            | ItemKind::ParameterOpen { .. }
    )
}
