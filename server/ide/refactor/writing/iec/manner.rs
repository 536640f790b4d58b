//! How instructions are laid out: margins, columns, letter case.

use super::super::{is_margin, margin_of};
use super::wording::key;
use super::{Old, Wording, is_label, line_start};
use crate::il::iec::{Item, ItemKind};
use crate::text::Span;

/// The columns of a step of indentation where no line shows it, as the formatter has it.
const STEP: &str = "    ";

/// The manner of the lines of a rung.
pub(super) struct Manner {
    /// What stands before instructions outside of parentheses.
    pub margin: String,
    /// What stands before those inside, for each parenthesis.
    step: String,
    gap: Gap,
    letters: Letters,
    /// Whether `&` stands for AND.
    has_ampersand: bool,
    /// Whether the parameters of calls stand on lines of their own.
    breaks_calls: bool,
}

/// What stands between an operator and its operand.
enum Gap {
    Text(String),
    /// Blanks up to this column, counted from the operator.
    Column(usize),
}

/// The letters of operators.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Letters {
    Upper,
    Lower,
    /// `Ld`: a capital before others.
    Title,
}

impl Manner {
    pub fn of(old: &Old<'_>) -> Manner {
        let words: Vec<&str> =
            old.items.iter().filter_map(|item| word(item)).map(|own| own.of(old.text)).collect();
        // Calls alone say little of other instructions; their neighbours do.
        let is_call = |item: &&Item| matches!(item.kind, ItemKind::Call { .. });
        let around = old.source.chunk.iec().filter(|_| old.items.iter().all(&is_call));
        let around = around.into_iter().flat_map(|tree| &tree.items).filter_map(word);
        let all: Vec<&str> = words.iter().copied().chain(around.map(|own| own.of(old.text))).collect();
        let margin = margin(old);
        let mut calls = old
            .items
            .iter()
            .copied()
            .filter(is_call)
            .map(|item| item.span.of(old.text))
            .filter(|call| call.contains('('));
        Manner {
            step: step(old, &margin),
            gap: old.items.iter().find_map(|item| gap(old, item)).unwrap_or(Gap::Text(" ".into())),
            letters: letters(&all),
            has_ampersand: words.iter().any(|word| word.starts_with('&')),
            breaks_calls: calls.next().is_none_or(|call| call.contains('\n')),
            margin,
        }
    }

    /// The lines of instructions that the translator wrote, in the author's words where these fit.
    pub fn lines(&self, instructions: &[String], wording: &mut Wording<'_>) -> Vec<String> {
        let mut lines = Vec::new();
        let mut depth: usize = 0;
        for instruction in instructions {
            if instruction == ")" {
                depth = depth.saturating_sub(1);
            }
            let indent = |inner: usize| self.margin.clone() + &self.step.repeat(depth + inner);
            match (wording.kept(instruction), instruction.split_once('\n')) {
                (Some(kept), _) => {
                    for (inner, text) in kept {
                        let before = if is_label(text) { String::new() } else { indent(inner) };
                        let mut own = text.lines();
                        lines.extend(own.next().map(|first| before + first));
                        lines.extend(own.map(str::to_string));
                    }
                }
                (None, Some((head, rest))) => lines.extend(self.call(&indent(0), head, rest, wording)),
                (None, None) if is_label(instruction) => lines.push(instruction.clone()),
                (None, None) => lines.push(indent(0) + &self.styled(instruction, wording)),
            }
            let word = instruction.split(' ').next().unwrap_or_default();
            depth += usize::from(word.ends_with('('));
        }
        lines
    }

    /// The lines of a call of which the translator wrote `head`, and `rest` on further lines.
    fn call(&self, indent: &str, head: &str, rest: &str, wording: &Wording<'_>) -> Vec<String> {
        let instance = head.trim_end_matches('(').split_once(' ').map_or("", |(_, instance)| instance);
        let parameters: Vec<&str> =
            rest.lines().filter(|line| *line != ")").map(|line| line.trim_end_matches(',')).collect();
        let parameters = wording.parameters(instance, &parameters);
        let head = head.trim_end_matches('(');
        let own = wording.call_of(instance);
        let written = own.and_then(|call| call.split('(').next()).filter(|own| key(own) == key(head));
        let head = written.map_or_else(|| self.styled(head, wording), str::to_string);
        let head = format!("{indent}{head}(");
        let breaks = own.filter(|call| call.contains('('));
        if !breaks.map_or(self.breaks_calls, |call| call.contains('\n')) {
            return vec![format!("{head}{})", parameters.join(", "))];
        }
        let blanks = |line: &'_ str| line[..line.len() - line.trim_start().len()].to_string();
        let inner = own.and_then(|call| call.lines().nth(1)).map(blanks);
        let inner = inner.as_deref().and_then(|blanks| blanks.strip_prefix(indent));
        let step = [inner.unwrap_or_default(), &self.step].into_iter().find(|step| !step.is_empty());
        let step = step.unwrap_or(STEP);
        let last = parameters.len().saturating_sub(1);
        let inner = parameters.iter().enumerate().map(|(number, parameter)| {
            format!("{indent}{step}{parameter}{}", if number < last { "," } else { "" })
        });
        std::iter::once(head).chain(inner).chain([format!("{indent})")]).collect()
    }

    fn styled(&self, instruction: &str, wording: &Wording<'_>) -> String {
        let (word, operand) = instruction.split_once(' ').unwrap_or((instruction, ""));
        let word = match word.strip_prefix("AND").filter(|_| self.has_ampersand) {
            Some(rest) => format!("&{rest}"),
            None => word.to_string(),
        };
        let word = match self.letters {
            Letters::Upper => word,
            Letters::Lower => word.to_lowercase(),
            Letters::Title => word.chars().take(1).chain(word.to_lowercase().chars().skip(1)).collect(),
        };
        if operand.is_empty() {
            return word;
        }
        let gap = match &self.gap {
            Gap::Text(text) => text.clone(),
            Gap::Column(column) => " ".repeat(column.saturating_sub(word.chars().count()).max(1)),
        };
        word + &gap + wording.spelled(operand)
    }
}

/// The letters of most operators.
fn letters(words: &[&str]) -> Letters {
    let of_word = |word: &&str| {
        let mut letters = word.chars().filter(|c| c.is_alphabetic());
        let is_capital = letters.next()?.is_uppercase();
        let (has_capitals, has_others) = letters.fold((false, false), |(capitals, others), letter| {
            (capitals || letter.is_uppercase(), others || letter.is_lowercase())
        });
        Some(match (is_capital, has_capitals, has_others) {
            (false, ..) => Letters::Lower,
            (true, false, true) => Letters::Title,
            (true, ..) => Letters::Upper,
        })
    };
    let all: Vec<Letters> = words.iter().filter_map(of_word).collect();
    let count = |letters: Letters| all.iter().filter(|own| **own == letters).count();
    // Of several the last one.
    let order = [Letters::Title, Letters::Lower, Letters::Upper];
    order.into_iter().max_by_key(|letters| count(*letters)).unwrap_or(Letters::Upper)
}

/// What stands before the first instruction that begins a line. Before one behind a label or a comment on its line that
/// is no margin, but those of the other lines are.
fn margin(old: &Old<'_>) -> String {
    let before = |item: &&Item| {
        let start = item.span.start as usize;
        &old.text[line_start(old.text, start)..start]
    };
    let outside = old.items.iter().copied().filter(|item| item.depth == 0);
    let outside = outside.filter(|item| !matches!(item.kind, ItemKind::Label { .. } | ItemKind::Close));
    let found = outside.map(|item| before(&item)).find(|before| is_margin(before));
    let blanks = |text: &str| text.len() - text.trim_start().len();
    let own = || &old.prefix[..blanks(old.prefix)];
    margin_of(found.unwrap_or_else(own)).to_string()
}

/// The word of an operator.
fn word(item: &Item) -> Option<Span> {
    match item.kind {
        ItemKind::Operation { operation, .. } | ItemKind::Open { operation, .. } => Some(operation.word),
        ItemKind::Jump { word, .. } | ItemKind::Return { word, .. } | ItemKind::Call { word, .. } => {
            Some(word)
        }
        _ => None,
    }
}

fn gap(old: &Old<'_>, item: &Item) -> Option<Gap> {
    let ItemKind::Operation { operation, operand: Some(id) } = item.kind else { return None };
    let operand = old.source.chunk.iec()?.operand(id).span;
    let between = old.text.get(operation.word.end as usize..operand.start as usize)?;
    let is_column = between.len() > 1 && between.bytes().all(|byte| byte == b' ');
    Some(match is_column {
        true => Gap::Column((operand.start - operation.word.start) as usize),
        false if between.trim().is_empty() && !between.is_empty() => Gap::Text(between.to_string()),
        false => Gap::Text(" ".to_string()),
    })
}

/// What the first line inside of parentheses has more than the margin.
fn step(old: &Old<'_>, margin: &str) -> String {
    for item in old.items.iter().filter(|item| item.depth > 0 && !matches!(item.kind, ItemKind::Close)) {
        let start = item.span.start as usize;
        let indent = &old.text[line_start(old.text, start)..start];
        if indent.trim().is_empty()
            && let Some(more) = indent.strip_prefix(margin)
        {
            let columns = more.chars().count() / item.depth.max(1) as usize;
            return more.chars().take(columns).collect();
        }
    }
    match margin.chars().next() {
        None => String::new(),
        Some('\t') => "\t".to_string(),
        Some(_) => STEP.to_string(),
    }
}
