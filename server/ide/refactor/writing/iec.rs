//! Writes rungs as instruction list of IEC 61131-3 in the manner of the lines that stood there.

mod carrying;
mod manner;
mod wording;

use super::super::silent;
use super::{Change, Declaration, Neighbourhood, is_margin, margin_of, with_blank_lines, without_gap};
use crate::document::{DeclaredType, Symbol};
use crate::il::iec::{Item, ItemKind, SectionKind};
use crate::logic::{Path, is_fall_name, is_helper_name};
use crate::target::iec::ElementaryType;
use crate::text::{Span, folded};
use crate::translate::Source;
use crate::translate::to_iec::{self, Helpers};
use manner::Manner;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;
use wording::Wording;

/// The instructions of a path, as the translator writes them.
type Instructions = Vec<String>;

/// The instructions of the rungs of each change in bytes of the document, and what stands there instead. What the new
/// ones need joins `declarations`.
pub(super) fn lists(
    around: &Neighbourhood<'_>,
    changes: &[Change],
    keeps_forms: bool,
    declarations: &mut Vec<Declaration>,
) -> Option<Vec<(Span, String)>> {
    // XOR would be written as what it is made of, which nobody asks for.
    if changes.iter().filter_map(|change| around.replaced(change)).flatten().any(has_xor) {
        return None;
    }
    let mut helpers = Helpers::beside(None);
    helpers.pou = around.unit.number;
    spares(around, changes, &mut helpers)?;
    let mut written = instructions(changes, &mut helpers)?;
    let has_label = written.iter().flatten().flatten().any(|line| is_label(line));
    // All names of a program unit are only looked at for a new one.
    if !helpers.declared.is_empty() || has_label {
        helpers = Helpers::beside(names(around, declarations));
        helpers.pou = around.unit.number;
        spares(around, changes, &mut helpers)?;
        further_spares(around, changes, &mut helpers);
        written = instructions(changes, &mut helpers)?;
    }
    let declared = helpers.declared.iter();
    declarations.extend(declared.map(|own| Declaration { name: own.name.clone(), type_name: own.type_name }));
    let mut lists = Vec::with_capacity(changes.len());
    for (change, mut written) in changes.iter().zip(written) {
        let rungs = around.replaced(change)?;
        keep_labels(rungs, &mut written);
        lists.push(list(around, change, (&old_instructions(around, change), keeps_forms), &written)?);
    }
    Some(lists)
}

/// What the translator would write for the rungs that a change replaces.
fn old_instructions(around: &Neighbourhood<'_>, change: &Change) -> Vec<Instructions> {
    let mut helpers = Helpers::beside(None);
    helpers.pou = around.unit.number;
    if spares(around, std::slice::from_ref(change), &mut helpers).is_none() {
        return Vec::new();
    }
    let paths = around.replaced(change).into_iter().flatten().filter_map(Source::path);
    paths.filter_map(|path| to_iec::lines(path, &mut helpers).ok()).collect()
}

fn has_xor(placed: &Source) -> bool {
    let own = placed.rung.span;
    let items = placed.chunk.iec().map_or(&[][..], |tree| &tree.items);
    let inside = items.iter().filter(|item| own.start <= item.span.start && item.span.end <= own.end);
    inside.into_iter().any(|item| match item.kind {
        ItemKind::Operation { operation, .. } | ItemKind::Open { operation, .. } => {
            operation.operator.name == "XOR"
        }
        _ => false,
    })
}

fn instructions(changes: &[Change], helpers: &mut Helpers) -> Option<Vec<Vec<Instructions>>> {
    let mut lines = |path: &Path| to_iec::lines(path, helpers).ok();
    changes.iter().map(|change| change.paths.iter().map(&mut lines).collect()).collect()
}

/// The detectors and keepers of power that the old rungs had are those of the new ones.
fn spares(around: &Neighbourhood<'_>, changes: &[Change], helpers: &mut Helpers) -> Option<()> {
    for change in changes {
        for symbol in around.replaced(change)?.iter().flat_map(silent::names) {
            if let Symbol::Variable(name) = symbol {
                spare(around, &name, helpers);
            }
        }
    }
    Some(())
}

/// Keepers of power that the program unit declares already may be used by several rungs.
fn further_spares(around: &Neighbourhood<'_>, changes: &[Change], helpers: &mut Helpers) {
    let Some(number) = around.unit.number else { return };
    let known: Vec<Symbol> = changes
        .iter()
        .filter_map(|change| around.replaced(change))
        .flatten()
        .flat_map(silent::names)
        .collect();
    let pous = around.document.scopes().own_pous();
    for variable in pous.get(number).iter().flat_map(|pou| &pou.variables) {
        if is_helper_name(&variable.name) && !known.contains(&Symbol::variable(&variable.name)) {
            spare(around, &variable.name, helpers);
        }
    }
}

fn spare(around: &Neighbourhood<'_>, name: &str, helpers: &mut Helpers) {
    let unit = around.unit.number;
    let Some(variable) = around.document.scopes().variable(unit, name) else { return };
    let type_name = match &variable.declared {
        DeclaredType::Elementary(ElementaryType::Bool) if is_helper_name(name) || is_fall_name(name) => {
            "BOOL"
        }
        DeclaredType::Named(block) if block == "r_trig" => "R_TRIG",
        _ => return,
    };
    if variable.section == SectionKind::Local && variable.address.is_none() {
        helpers.spare(unit, type_name, variable.name.clone());
    }
}

/// All names that a new variable or label must not have.
fn names(around: &Neighbourhood<'_>, declarations: &[Declaration]) -> FxHashSet<SmolStr> {
    let scopes = around.document.scopes();
    let mut names = around.unit.names(around.document);
    names.extend(scopes.globals.keys().cloned());
    names.extend(scopes.pous.iter().map(|pou| folded(&pou.name)));
    names.extend(declarations.iter().map(|own| folded(&own.name)));
    names
}

fn is_label(line: &str) -> bool {
    line.ends_with(':')
}

/// Gives the labels inside of new rungs the names that those inside of the old ones had.
fn keep_labels(rungs: &[Source], written: &mut [Instructions]) {
    let mut old = rungs.iter().flat_map(|placed| {
        let own = placed.rung.span;
        let items = placed.chunk.iec().map_or(&[][..], |tree| &tree.items);
        items.iter().filter_map(move |item| match item.kind {
            ItemKind::Label { name } if own.start <= name.start && name.end <= own.end => {
                Some(name.of(placed.chunk.text()))
            }
            _ => None,
        })
    });
    for lines in written {
        let new: Vec<String> =
            lines.iter().filter_map(|line| line.strip_suffix(':').map(str::to_string)).collect();
        for (label, old) in new.iter().zip(&mut old) {
            for line in lines.iter_mut() {
                if line.strip_suffix(':') == Some(label) {
                    *line = format!("{old}:");
                } else if line.strip_prefix("JMPCN ") == Some(label) {
                    *line = format!("JMPCN {old}");
                }
            }
        }
    }
}

/// The instructions of the rungs that `change` replaces, in bytes of the document, and those `written` for its paths in
/// their place. The translator would write the old ones as `translated`; a form of theirs that is longer than the
/// translator's is only kept if that is said beside it.
fn list(
    around: &Neighbourhood<'_>,
    change: &Change,
    (translated, keeps_forms): (&[Instructions], bool),
    written: &[Instructions],
) -> Option<(Span, String)> {
    let rungs = around.replaced(change)?;
    let old = Old::of(rungs)?;
    let start = rungs.first()?.start;
    if written.is_empty() {
        return old.comments.is_empty().then(|| (removed(around, &old, start), String::new()));
    }
    let manner = Manner::of(&old);
    let mut wording = Wording::of(&old, translated, !keeps_forms);
    let mut lines: Vec<String> = Vec::new();
    for instructions in written {
        // A load behind a call would go on with its rung.
        if lines.last().is_some() && follows_call(&lines) {
            lines.push(String::new());
        }
        lines.extend(manner.lines(instructions, &mut wording));
    }
    let comments: Vec<Span> =
        old.comments.iter().copied().filter(|comment| !wording.has_kept(*comment)).collect();
    let lines = carrying::with_comments(around, (&old, &comments), &change.paths, lines)?;
    let line_end = if old.text[old.start..old.end].contains("\r\n") { "\r\n" } else { "\n" };
    let mut new = lines.join(line_end);
    if old.text[..old.end].ends_with('\n') {
        new.push_str(line_end);
    }
    // The first one stands behind what is before it on its line.
    let new = new.strip_prefix(&manner.margin).map(str::to_string).unwrap_or(new);
    Some((Span::new(old.start, old.end).shifted(start), new))
}

/// What goes where nothing is written in the place of `old`, whose chunk starts at byte `start` of the document. Blank
/// lines behind a rung at the beginning of its chunk would go to what stands before that.
fn removed(around: &Neighbourhood<'_>, old: &Old<'_>, start: usize) -> Span {
    let own = Span::new(old.start, old.end).shifted(start);
    if !is_margin(old.prefix) {
        return own;
    }
    let whole = Span::new(old.start - margin_of(old.prefix).len(), old.end).shifted(start);
    match whole.start as usize == start {
        true => with_blank_lines(around.document, whole),
        false => without_gap(around.document, whole),
    }
}

fn follows_call(lines: &[String]) -> bool {
    let last = lines.last().map_or("", |line| line.trim());
    let word = last.split_whitespace().next().unwrap_or_default();
    last.ends_with(')') || word.eq_ignore_ascii_case("CAL")
}

/// The instructions of rungs as they stand in their chunk.
struct Old<'a> {
    text: &'a str,
    /// Where the first instruction starts, and where the line of the last one ends.
    start: usize,
    end: usize,
    /// What stands before the first instruction on its line.
    prefix: &'a str,
    items: Vec<&'a Item>,
    /// Comments and pragmas from the first instruction on, in order.
    comments: Vec<Span>,
    source: &'a Source,
}

impl<'a> Old<'a> {
    /// Nothing if something would be lost: instructions of other rungs on the same lines, comments between rungs.
    fn of(rungs: &'a [Source]) -> Option<Old<'a>> {
        let (first, last) = (rungs.first()?, rungs.last()?);
        let (text, tree) = (first.chunk.text(), first.chunk.iec()?);
        let start = first.rung.span.start as usize;
        let end = line_end(text, last.rung.span.end as usize);
        let inside = |span: &Span| start <= span.start as usize && (span.start as usize) < end;
        let items: Vec<&Item> = tree.items.iter().filter(|item| inside(&item.span)).collect();
        let is_own = |item: &&Item| {
            let has = |own: Span| own.start <= item.span.start && item.span.end <= own.end;
            rungs.iter().any(|placed| has(placed.rung.span))
        };
        let mut comments: Vec<Span> =
            tree.comments.iter().chain(&tree.pragmas).copied().filter(inside).collect();
        comments.sort_unstable();
        let is_lost = |(number, placed): (usize, &Source)| number > 0 && !placed.rung.labels.is_empty();
        if !items.iter().all(is_own)
            || rungs.len() > 1 && !comments.is_empty()
            || rungs.iter().enumerate().any(is_lost)
            || has_semicolon(text, start..end, &comments)
        {
            return None;
        }
        let prefix = text.get(line_start(text, start)..start)?;
        Some(Old { text, start, end, prefix, items, comments, source: first })
    }
}

/// Semicolons behind instructions have no place in new ones.
fn has_semicolon(text: &str, range: std::ops::Range<usize>, comments: &[Span]) -> bool {
    let is_in_comment = |at: usize| comments.iter().any(|own| own.range().contains(&at));
    text[range.clone()].match_indices(';').any(|(at, _)| !is_in_comment(range.start + at))
}

fn line_start(text: &str, offset: usize) -> usize {
    text[..offset].rfind('\n').map_or(0, |end| end + 1)
}

/// Line end included.
fn line_end(text: &str, offset: usize) -> usize {
    text[offset..].find('\n').map_or(text.len(), |length| offset + length + 1)
}
