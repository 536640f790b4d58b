//! Calculations with words: `LD a / ADD b / ST c`, with operands converted `LD a / INT_TO_WORD / AND 16#FF /
//! WORD_TO_INT / ST c`, calls of functions that the program declares, `LD a / Scale b / ST c`, and those that a jump
//! over them makes conditional:
//!
//! ```text
//!     LD      Start
//!     JMPCN   Skip1
//!     LD      a
//!     ADD     b
//!     ST      c
//! Skip1:
//! ```

use super::{Source, ValueKind, declares};
use crate::document::DeclaredType;
use crate::il::iec::{Condition, Direction, ItemKind, ListForm, OperandId, Operation, ParameterValue};
use crate::logic::{Computation, Conversion, Elsewhere};
use crate::target::Operand;
use crate::target::iec::OperatorRole;
use crate::text::folded;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

/// A calculation in a list.
pub(super) struct Found {
    pub computation: Computation,
    /// Its inputs, then its result.
    pub operands: Vec<OperandId>,
    /// How many instructions it takes.
    pub items: usize,
}

/// Jumps over calculations alone.
#[derive(Default)]
pub(super) struct Skips {
    /// The item of the label for that of the jump.
    labels: FxHashMap<usize, usize>,
    /// The items behind the jump up to the label.
    inside: FxHashSet<usize>,
}

impl Skips {
    /// The label of the jump that item `index` is, if it only skips calculations.
    pub fn label(&self, index: usize) -> Option<usize> {
        self.labels.get(&index).copied()
    }

    /// Whether item `index` is skipped, or is the label behind.
    pub fn covers(&self, index: usize) -> bool {
        self.inside.contains(&index)
    }
}

/// A second operand, with the conversion that it goes through.
type Second = (OperandId, Option<Conversion>);

impl Source<'_> {
    /// The jumps that only skip calculations, to labels of their program unit that nobody else jumps to.
    pub(super) fn find_skips(&self, pous: usize, elsewhere: &Elsewhere) -> Skips {
        let outside = elsewhere.labels.iter().map(|(name, count)| ((pous, name.clone()), *count));
        let mut mentions: FxHashMap<(usize, SmolStr), usize> = outside.collect();
        let mut units = pous;
        for item in &self.tree.items {
            match item.kind {
                ItemKind::Pou { .. } => units += 1,
                ItemKind::Label { name } | ItemKind::Jump { label: Some(name), .. } => {
                    *mentions.entry((units, folded(name.of(self.text)))).or_default() += 1;
                }
                _ => {}
            }
        }
        let mut skips = Skips::default();
        let mut units = pous;
        for (index, item) in self.tree.items.iter().enumerate() {
            match item.kind {
                ItemKind::Pou { .. } => units += 1,
                ItemKind::Jump { condition: Condition::IfFalse, label: Some(label), .. }
                    if item.depth == 0 =>
                {
                    let name = folded(label.of(self.text));
                    let end = self.end_of_calculations(units.checked_sub(1), index + 1);
                    let is_end = end > index + 1
                        && matches!(self.tree.items.get(end).map(|item| item.kind),
                            Some(ItemKind::Label { name: end }) if folded(end.of(self.text)) == name);
                    if is_end && mentions.get(&(units, name)) == Some(&2) && !self.needs_result(end) {
                        skips.labels.insert(index, end);
                        skips.inside.extend(index + 1..=end);
                    }
                }
                _ => {}
            }
        }
        skips
    }

    fn end_of_calculations(&self, pou: Option<usize>, start: usize) -> usize {
        let mut at = start;
        while let Some(found) = self.calculation(pou, at) {
            at += found.items;
        }
        at
    }

    /// The calculation that begins at item `index`, if one does whose result nothing else uses.
    pub(super) fn calculation(&self, pou: Option<usize>, index: usize) -> Option<Found> {
        if let Some(found) = self.called_function(pou, index) {
            return Some(found);
        }
        let (load, first) = self.operation(index)?;
        if load.operator.role != OperatorRole::Load {
            return None;
        }
        let mut at = index + 1;
        let before = self.conversion(&mut at);
        let (computation, second) = self.combination(&mut at)?;
        let converted = match (before, &second) {
            (Some(before), _) => Some(before),
            (None, Some((_, conversion))) => *conversion,
            (None, None) => None,
        };
        let is_constant = self.is_literal(first) && second.is_none_or(|(second, _)| self.is_literal(second));
        let converted = match is_constant {
            true => self.function(at).and_then(Conversion::of_result_named),
            false => converted,
        };
        let computation = computation.converted(converted.unwrap_or_default())?;
        // Whatever is no literal is converted, and alike.
        let fits = |id: OperandId, own: Option<Conversion>| match self.is_literal(id) {
            true => own.is_none(),
            false => own == converted,
        };
        let is_alike = fits(first, before) && second.is_none_or(|(second, own)| fits(second, own));
        if let Some(name) = computation.conversion.of_result() {
            at += self.function(at).filter(|function| function.eq_ignore_ascii_case(name)).map(|_| 1)?;
        }
        let result = self.stored(pou, at)?;
        let operands: Vec<OperandId> =
            [Some(first), second.map(|(second, _)| second), Some(result)].into_iter().flatten().collect();
        let fits = is_alike && self.are_words(pou, &computation, &operands);
        fits.then_some(Found { computation, operands, items: at + 1 - index })
    }

    /// The call of a function of the program that begins at item `index`, if its result is stored and each input has an
    /// operand: `LD a / Scale b, c / ST d`, where the first input is loaded, or `Scale(IN := a, …) / ST d`.
    fn called_function(&self, pou: Option<usize>, index: usize) -> Option<Found> {
        let loaded = self.operation(index).filter(|(load, _)| load.operator.role == OperatorRole::Load);
        let call_at = index + usize::from(loaded.is_some());
        let call = self.tree.items.get(call_at).filter(|item| item.depth == 0)?;
        let ItemKind::Function { name, form, parameters } = call.kind else { return None };
        if loaded.is_some() != (form == ListForm::None) {
            return None;
        }
        let computation = Computation::declared(name.of(self.text), self.scopes)?;
        let inputs = computation.inputs();
        let mut operands: Vec<Option<OperandId>> = vec![None; inputs.len()];
        let mut next = 0;
        if let Some((_, first)) = loaded {
            *operands.first_mut()? = Some(first);
            next = 1;
        }
        for parameter in parameters.of(&self.tree.parameters) {
            let (Direction::In, ParameterValue::Operand(id)) = (parameter.direction, parameter.value) else {
                return None;
            };
            let place = match parameter.name {
                Some(name) => inputs.iter().position(|formal| formal.is_called(name.of(self.text)))?,
                None => next,
            };
            next = place + 1;
            if operands.get_mut(place)?.replace(id).is_some() {
                return None;
            }
        }
        let mut operands: Vec<OperandId> = operands.into_iter().collect::<Option<_>>()?;
        operands.push(self.stored(pou, call_at + 1)?);
        Some(Found { computation, operands, items: call_at + 2 - index })
    }

    /// The variable to which item `index` stores the current result, if nothing uses it behind that.
    fn stored(&self, pou: Option<usize>, index: usize) -> Option<OperandId> {
        let (store, result) = self.operation(index)?;
        let is_store = store.operator.role == OperatorRole::Store && !store.word.of(self.text).ends_with('?');
        let is_last = self.tree.items.get(index + 1).is_none_or(|next| match next.kind {
            ItemKind::Label { .. } => !self.needs_result(index + 1),
            kind => declares(&kind) || self.starts_afresh(&kind),
        });
        (is_store && is_last && !self.feeds(pou, index)).then_some(result)
    }

    /// What is done at item `at` with the current result: the function, and its second operand with the conversion
    /// that it goes through. Nothing stands there before a store, which copies.
    fn combination(&self, at: &mut usize) -> Option<(Computation, Option<Second>)> {
        let item = self.tree.items.get(*at)?;
        let named = |operation: Operation| {
            let combines = operation.operator.role == (OperatorRole::Combine { comparison: false });
            let name = if operation.operator.name == "&" { "AND" } else { operation.operator.name };
            Computation::named(name).filter(|_| combines && !operation.negated)
        };
        match item.kind {
            ItemKind::Operation { operation, operand: None }
                if operation.operator.role == OperatorRole::Complement && item.depth == 0 =>
            {
                *at += 1;
                Some((Computation::named("NOT")?, None))
            }
            ItemKind::Operation { operation, operand: Some(id) }
                if operation.operator.role != OperatorRole::Store && item.depth == 0 =>
            {
                *at += 1;
                Some((named(operation)?, Some((id, None))))
            }
            ItemKind::Open { operation, operand: Some(id) } if item.depth == 0 => {
                *at += 1;
                let conversion = self.conversion(at)?;
                let close = self.tree.items.get(*at)?;
                *at += 1;
                let computation = named(operation).filter(|_| close.kind == ItemKind::Close)?;
                Some((computation, Some((id, Some(conversion)))))
            }
            _ => Some((Computation::named("MOVE")?, None)),
        }
    }

    /// The conversion whose function stands at item `at`, which is then passed.
    fn conversion(&self, at: &mut usize) -> Option<Conversion> {
        let found = self.function(*at).and_then(Conversion::named);
        *at += usize::from(found.is_some());
        found
    }

    /// The function of the current result alone at item `at`.
    fn function(&self, at: usize) -> Option<&str> {
        match self.tree.items.get(at)?.kind {
            ItemKind::Function { name, form: ListForm::None, parameters }
                if parameters.start == parameters.end =>
            {
                Some(name.of(self.text))
            }
            _ => None,
        }
    }

    fn is_literal(&self, id: OperandId) -> bool {
        matches!(self.tree.operand(id).value, Operand::Literal(_))
    }

    /// An operation outside of parentheses, without a negation.
    fn operation(&self, index: usize) -> Option<(Operation, OperandId)> {
        let item = self.tree.items.get(index)?;
        match item.kind {
            ItemKind::Operation { operation, operand: Some(id) } if item.depth == 0 && !operation.negated => {
                Some((operation, id))
            }
            _ => None,
        }
    }

    /// Whether operands are words, as far as they are declared. What can be done with bits as well must be told by one.
    fn are_words(&self, pou: Option<usize>, computation: &Computation, operands: &[OperandId]) -> bool {
        let kinds = operands.iter().map(|id| {
            let operand = self.tree.operand(*id);
            let word = operand.span.of(self.text);
            let kind = self.value_kind(pou, &operand.value, word);
            // A structure has parts with names of their own.
            let is_plain = operand.value != Operand::Variable
                || matches!(self.scopes.type_of(pou, word), None | Some(DeclaredType::Elementary(_)));
            (kind, is_plain)
        });
        let kinds: Vec<_> = kinds.collect();
        let is_numeric = !computation.copies() && !computation.is_bitwise();
        kinds.iter().all(|(kind, is_plain)| *is_plain && matches!(kind, ValueKind::Word | ValueKind::Unknown))
            && (is_numeric || kinds.iter().any(|(kind, _)| *kind == ValueKind::Word))
    }
}
