//! What the author wrote for instructions that stay: their letters and blanks, the form of calls, names as spelled.
//!
//! One block is called in several ways: `CAL T1(IN := a)`, `CAL T1(a)`, or `LD a`, `ST T1.IN`, `CAL T1`. The translator
//! writes one of them, so a call of its own is looked up among those that it would have written for the old rungs.

use super::super::is_margin;
use super::{Instructions, Old, line_start};
use crate::il::iec::{Condition, Item, ItemKind, Parameter, ParameterValue};
use crate::target::iec::OperatorRole;
use crate::text::{Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::ops::Range;

/// An instruction of the translator, and the author's in its place.
struct Piece {
    /// The translator's, in one spelling.
    key: String,
    /// The author's, by their numbers among those of the old rungs.
    items: Range<usize>,
}

/// The words of old rungs, each of which may be used once.
pub(super) struct Wording<'a> {
    old: &'a Old<'a>,
    pieces: Vec<Piece>,
    used: Vec<bool>,
    /// The item behind those used last.
    next: usize,
    /// The operands as written, by their folded text.
    spellings: FxHashMap<SmolStr, Vec<&'a str>>,
}

impl<'a> Wording<'a> {
    /// The words of `old`, for which the translator would write `translated`. If the new rungs must be `shorter`, no
    /// longer form of an instruction is one of them.
    pub fn of(old: &'a Old<'a>, translated: &[Instructions], shorter: bool) -> Wording<'a> {
        let mut pieces: Vec<Piece> = (0..old.items.len()).filter_map(|number| single(old, number)).collect();
        pieces.extend((1..old.items.len()).filter_map(|number| opened(old, number)));
        pieces.extend(calls(old, translated));
        pieces.retain(|piece| !shorter || piece.items.len() == 1);
        let mut spellings: FxHashMap<SmolStr, Vec<&'a str>> = FxHashMap::default();
        let operands = old.source.chunk.iec().map_or(&[][..], |tree| &tree.operands);
        let inside = |span: &Span| old.start <= span.start as usize && span.end as usize <= old.end;
        for operand in operands.iter().map(|operand| operand.span).filter(inside) {
            let word = operand.of(old.text);
            spellings.entry(folded(word)).or_default().push(word);
        }
        Wording { old, pieces, used: vec![false; old.items.len()], next: 0, spellings }
    }

    /// What the author wrote for an instruction of the translator: one instruction or several, each behind the number
    /// of the parentheses that they open around it.
    pub fn kept(&mut self, instruction: &str) -> Option<Vec<(usize, &'a str)>> {
        let wanted = key(instruction);
        let fits = |piece: &&Piece| piece.key == wanted && !self.used[piece.items.clone()].contains(&true);
        // Of several the next one, as most of a rung stays in its order.
        let order = |piece: &&Piece| (piece.items.start < self.next, piece.items.start);
        let piece = self.pieces.iter().filter(fits).min_by_key(order)?;
        self.used[piece.items.clone()].fill(true);
        self.next = piece.items.end;
        let items = &self.old.items[piece.items.clone()];
        let depth = items.first()?.depth;
        let text = |item: &&'a Item| {
            let own = item.span.start as usize;
            let line = line_start(self.old.text, own);
            // A label has a margin of its own.
            let has_margin =
                matches!(item.kind, ItemKind::Label { .. }) && is_margin(&self.old.text[line..own]);
            let start = if has_margin { line } else { own };
            (item.depth.saturating_sub(depth) as usize, &self.old.text[start..item.span.end as usize])
        };
        Some(items.iter().map(text).collect())
    }

    /// Whether a comment stands inside of what was kept, and stays there.
    pub fn has_kept(&self, comment: Span) -> bool {
        let is_inside = |item: &Item| item.span.start <= comment.start && comment.end <= item.span.end;
        self.old.items.iter().zip(&self.used).any(|(item, is_used)| *is_used && is_inside(item))
    }

    /// An operand as the author spells it, if it is written in other letters only.
    pub fn spelled<'s>(&self, operand: &'s str) -> &'s str
    where
        'a: 's,
    {
        // Letters count between quotes.
        let known = self.spellings.get(&folded(operand)).filter(|_| !operand.contains(['\'', '"']));
        match known {
            Some(known) if !known.contains(&operand) => known.first().copied().unwrap_or(operand),
            _ => operand,
        }
    }

    /// The author's first call of an instance.
    pub fn call_of(&self, instance: &str) -> Option<&'a str> {
        self.called(instance).map(|item| item.span.of(self.old.text))
    }

    fn called(&self, instance: &str) -> Option<&'a Item> {
        let is_meant =
            |item: &&Item| self.old.callee(item).is_some_and(|own| folded(own) == folded(instance));
        self.old.items.iter().copied().find(is_meant)
    }

    /// The parameters of a call of `instance` as the author wrote them as far as he did, and in his order.
    pub fn parameters(&self, instance: &str, parameters: &[&str]) -> Vec<String> {
        let text = self.old.text;
        let own = self.called(instance).map_or(&[][..], |item| self.old.parameters(item));
        let place = |parameter: &str| {
            let (name, _) = parameter.split_once([' ', ':', '='])?;
            own.iter().position(|own| own.name.is_some_and(|own| folded(own.of(text)) == folded(name)))
        };
        let worded = |parameter: &str| {
            let known = place(parameter).map(|place| &own[place])?;
            let ParameterValue::Operand(id) = known.value else { return None };
            let value = self.old.source.chunk.iec()?.operand(id).span;
            let (_, new) = parameter.split_once(' ')?.1.split_once(' ')?;
            let written = known.span.of(text);
            let before = text.get(known.span.start as usize..value.start as usize)?;
            let is_plain = ["\n", "(*", "//", "{"].iter().all(|other| !before.contains(other));
            let is_same = key(written) == key(parameter);
            is_plain
                .then(|| if is_same { written.to_string() } else { format!("{before}{}", self.spelled(new)) })
        };
        let mut worded: Vec<(Option<usize>, String)> = parameters
            .iter()
            .map(|parameter| (place(parameter), worded(parameter).unwrap_or_else(|| parameter.to_string())))
            .collect();
        worded.sort_by_key(|(place, _)| *place);
        worded.into_iter().map(|(_, text)| text).collect()
    }
}

impl<'a> Old<'a> {
    /// The instance that an item calls.
    fn callee(&self, item: &Item) -> Option<&'a str> {
        let ItemKind::Call { callee: Some(callee), .. } = item.kind else { return None };
        Some(self.source.chunk.iec()?.operand(callee).span.of(self.text))
    }

    fn parameters(&self, item: &Item) -> &'a [Parameter] {
        match (item.kind, self.source.chunk.iec()) {
            (ItemKind::Call { parameters, .. }, Some(tree)) => parameters.of(&tree.parameters),
            _ => &[],
        }
    }

    /// The operand of an operation of this kind that is not negated.
    fn operand_of(&self, number: usize, role: OperatorRole) -> Option<&'a str> {
        let ItemKind::Operation { operation, operand: Some(id) } = self.items.get(number)?.kind else {
            return None;
        };
        let is_meant = operation.operator.role == role && !operation.negated;
        is_meant.then_some(self.source.chunk.iec()?.operand(id).span.of(self.text))
    }

    /// The key of one item.
    fn key_of(&self, item: &Item) -> String {
        let own = item.span.of(self.text);
        let word = match item.kind {
            ItemKind::Operation { operation, .. } | ItemKind::Open { operation, .. } => {
                operation.word.of(self.text)
            }
            _ => "",
        };
        match word.strip_prefix('&').and_then(|rest| Some((rest, own.strip_prefix(word)?))) {
            Some((negation, operand)) => key(&format!("AND{negation} {operand}")),
            None => key(own),
        }
    }
}

/// An instruction for which the translator writes the same one.
fn single(old: &Old<'_>, number: usize) -> Option<Piece> {
    let item = old.items.get(number)?;
    let is_simple = !matches!(item.kind, ItemKind::ParameterOpen { .. });
    is_simple.then(|| Piece { key: old.key_of(item), items: number..number + 1 })
}

/// A load behind a parenthesis, for which the translator writes both in one.
fn opened(old: &Old<'_>, number: usize) -> Option<Piece> {
    let operand = old.operand_of(number, OperatorRole::Load)?;
    let before = old.items[number - 1];
    let is_open = matches!(before.kind, ItemKind::Open { operand: None, .. });
    is_open.then(|| Piece {
        key: key(&format!("{} {operand}", old.key_of(before))),
        items: number - 1..number + 1,
    })
}

/// The calls of the old rungs beside what the translator writes for them.
fn calls(old: &Old<'_>, translated: &[Instructions]) -> Vec<Piece> {
    let instructions = translated.iter().flatten().filter(|instruction| instruction.starts_with("CAL"));
    let mut seen: FxHashMap<SmolStr, usize> = FxHashMap::default();
    let piece = |instruction: &String| {
        let called = instruction.split_once(' ')?.1;
        let instance = folded(called.split('(').next()?);
        let times = seen.entry(instance.clone()).or_default();
        *times += 1;
        let is_meant =
            |number: &usize| old.callee(old.items[*number]).is_some_and(|own| folded(own) == instance);
        let number = (0..old.items.len()).filter(is_meant).nth(*times - 1)?;
        let items = called_with(old, number, instruction)?;
        Some(Piece { key: key(instruction), items })
    };
    instructions.filter_map(piece).collect()
}

/// The call with this number, if it has as many parameters as the translator writes; or with a load and a store before
/// it, if these are the one that it lacks.
fn called_with(old: &Old<'_>, number: usize, instruction: &str) -> Option<Range<usize>> {
    let item = old.items.get(number)?;
    let count = instruction.lines().count().saturating_sub(2);
    let own = old.parameters(item).len();
    if own == count {
        return Some(number..number + 1);
    }
    let ItemKind::Call { condition: Condition::Always, .. } = item.kind else { return None };
    let loaded = old.operand_of(number.checked_sub(2)?, OperatorRole::Load)?;
    let stored = old.operand_of(number - 1, OperatorRole::Store)?;
    let (instance, input) = stored.rsplit_once('.')?;
    let is_input =
        instruction.lines().any(|line| key(line.trim_end_matches(',')) == key(&format!("{input}:={loaded}")));
    let is_own = folded(instance) == folded(old.callee(item)?);
    (own + 1 == count && is_input && is_own).then_some(number - 2..number + 1)
}

/// Instructions in one spelling: letters folded but between quotes, blanks only where they part words.
pub(super) fn key(instruction: &str) -> String {
    let is_word = |c: char| c.is_alphanumeric() || "_%#.".contains(c);
    let mut key = String::with_capacity(instruction.len());
    let mut quote = None;
    let mut is_parted = false;
    for c in instruction.chars() {
        if quote.is_none() && c.is_whitespace() {
            is_parted = true;
            continue;
        }
        if std::mem::take(&mut is_parted) && is_word(c) && key.ends_with(is_word) {
            key.push(' ');
        }
        match quote {
            None => key.extend(c.to_lowercase()),
            Some(_) => key.push(c),
        }
        match quote {
            Some(open) if open == c => quote = None,
            None if matches!(c, '\'' | '"') => quote = Some(c),
            _ => {}
        }
    }
    key
}
