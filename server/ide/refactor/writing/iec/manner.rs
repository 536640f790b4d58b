//! How instructions are laid out: margins, columns, letter case.

use super::{Old, is_label, line_start};
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
    is_lower: bool,
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

impl Manner {
    pub fn of(old: &Old<'_>) -> Manner {
        let words: Vec<&str> =
            old.items.iter().filter_map(|item| word(item)).map(|own| own.of(old.text)).collect();
        let margin = match old.prefix.trim().is_empty() {
            true => old.prefix.to_string(),
            false => " ".repeat(old.prefix.chars().count()),
        };
        let calls = old.items.iter().filter(|item| matches!(item.kind, ItemKind::Call { .. }));
        let mut calls = calls.map(|item| item.span.of(old.text)).filter(|call| call.contains('('));
        Manner {
            step: step(old, &margin),
            gap: old.items.iter().find_map(|item| gap(old, item)).unwrap_or(Gap::Text(" ".into())),
            is_lower: !words.is_empty() && !words.iter().any(|word| word.contains(char::is_uppercase)),
            has_ampersand: words.iter().any(|word| word.starts_with('&')),
            breaks_calls: calls.next().is_none_or(|call| call.contains('\n')),
            margin,
        }
    }

    /// The lines of instructions that the translator wrote.
    pub fn lines(&self, instructions: &[String]) -> Vec<String> {
        let mut lines = Vec::new();
        let mut depth: usize = 0;
        for instruction in instructions {
            if instruction == ")" {
                depth = depth.saturating_sub(1);
            }
            let indent = self.margin.clone() + &self.step.repeat(depth);
            match instruction.split_once('\n') {
                None if is_label(instruction) => lines.push(instruction.clone()),
                None => lines.push(indent + &self.styled(instruction)),
                Some((head, rest)) if self.breaks_calls => {
                    let step = if self.step.is_empty() { STEP } else { &self.step };
                    lines.push(indent.clone() + &self.styled(head));
                    let inner = rest.lines().map(|line| match line {
                        ")" => format!("{indent})"),
                        line => format!("{indent}{step}{line}"),
                    });
                    lines.extend(inner);
                }
                Some((head, rest)) => {
                    let parameters = rest.trim_end_matches([')', '\n']).replace('\n', " ");
                    lines.push(format!("{indent}{}{parameters})", self.styled(head)));
                }
            }
            let word = instruction.split(' ').next().unwrap_or_default();
            depth += usize::from(word.ends_with('('));
        }
        lines
    }

    fn styled(&self, instruction: &str) -> String {
        let (word, operand) = instruction.split_once(' ').unwrap_or((instruction, ""));
        let mut word = match word.strip_prefix("AND").filter(|_| self.has_ampersand) {
            Some(rest) => format!("&{rest}"),
            None => word.to_string(),
        };
        if self.is_lower {
            word = word.to_lowercase();
        }
        if operand.is_empty() {
            return word;
        }
        let gap = match &self.gap {
            Gap::Text(text) => text.clone(),
            Gap::Column(column) => " ".repeat(column.saturating_sub(word.chars().count()).max(1)),
        };
        word + &gap + operand
    }
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
