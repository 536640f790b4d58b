//! Comments of old lines beside the new ones: each stays with the operand that it stands beside or above.

use super::super::super::neighbourhood::Neighbourhood;
use super::{Old, line_end, line_start};
use crate::logic::{self, Contact, Declared, Path, Term};
use crate::text::Span;
use smol_str::SmolStr;
use std::cell::RefCell;

/// The comments of a written line.
#[derive(Clone, Default)]
struct Carried<'a> {
    above: Vec<&'a str>,
    /// With the column in which it stood, if that was no matter of a single blank.
    behind: Option<(&'a str, Option<usize>)>,
}

/// `lines`, which are those of `paths`, with `comments` of the old ones; nothing if one has no place.
pub(super) fn with_comments(
    around: &Neighbourhood<'_>,
    (old, comments): (&Old<'_>, &[Span]),
    paths: &[Path],
    lines: Vec<String>,
) -> Option<Vec<String>> {
    if comments.is_empty() {
        return Some(lines);
    }
    let places = places(around, paths, &lines);
    let mut carried = vec![Carried::default(); lines.len()];
    for comment in comments {
        let words = comment.of(old.text).trim_end();
        if words.contains('\n') {
            return None;
        }
        let line = |offset: u32| line_start(old.text, offset as usize)..line_end(old.text, offset as usize);
        let own = line(comment.start);
        let is_beside = old.items.iter().any(|item| {
            let (start, end) = (item.span.start as usize, item.span.end as usize);
            start < own.end && own.start < end
        });
        let named = match is_beside {
            true => own.clone(),
            false => line(old.items.iter().find(|item| comment.start < item.span.start)?.span.start),
        };
        let (_, place) = places.iter().find(|(span, _)| named.contains(&(span.start as usize)))?;
        let place = carried.get_mut(*place)?;
        match is_beside {
            true if place.behind.is_some() => return None,
            true => place.behind = Some((words, column(&old.text[own.start..comment.start as usize]))),
            false => place.above.push(words),
        }
    }
    let mut all = Vec::with_capacity(lines.len() + comments.len());
    for (line, Carried { above, behind }) in lines.into_iter().zip(carried) {
        let indent = &line[..line.len() - line.trim_start().len()];
        all.extend(above.iter().map(|words| format!("{indent}{words}")));
        all.push(match behind {
            None => line,
            Some((words, column)) => {
                let used = line.chars().count();
                let blanks = column.map_or(1, |column| column.saturating_sub(used).max(1));
                format!("{line}{}{words}", " ".repeat(blanks))
            }
        });
    }
    Some(all)
}

/// The column behind this beginning of a line, unless a single blank ends it.
fn column(before: &str) -> Option<usize> {
    let blanks = before.len() - before.trim_end().len();
    (blanks > 1).then(|| before.chars().count())
}

/// The places of the operands of `paths` in the old chunk, each with the number of the line that has it now. The lines
/// are read for that, for only the reader knows what a word in them is an operand of.
fn places(around: &Neighbourhood<'_>, paths: &[Path], lines: &[String]) -> Vec<(Span, usize)> {
    let text = lines.join("\n") + "\n";
    let chunk = around.document.chunk_of(&text);
    let declared = Declared { scopes: around.document.scopes(), pous: around.unit.started() };
    let rungs = logic::rungs_with(&chunk, around.document.reader(), declared);
    let new = rungs.iter().filter_map(|rung| rung.path.as_ref().ok()?.as_ref());
    let new: Vec<(SmolStr, Span)> = new.flat_map(words).collect();
    let mut places = Vec::new();
    let mut next = 0;
    for (key, old) in paths.iter().flat_map(words) {
        // What a helper does stands between.
        if let Some(ahead) = new[next..].iter().position(|(new, _)| *new == key) {
            let line = text[..new[next + ahead].1.start as usize].matches('\n').count();
            places.push((old, line));
            next += ahead + 1;
        }
    }
    places.retain(|(old, _)| !old.is_empty());
    places
}

/// The operands of a path in the order in which it is read. The contact of an edge has two places: the load and the
/// call of its detector.
fn words(path: &Path) -> Vec<(SmolStr, Span)> {
    let found: RefCell<Vec<(SmolStr, Span)>> = RefCell::default();
    let term = |term: &Term| found.borrow_mut().push((term.key(), term.span));
    let contact = |contact: &Contact| {
        let key = contact.terms.first().map(Term::key).unwrap_or_default();
        found.borrow_mut().push((key, contact.span));
        contact.terms.iter().for_each(&term);
    };
    path.visit(&mut |action| action.terms.iter().for_each(&term), &mut |part| {
        part.visit(&mut |own| contact(own));
    });
    found.into_inner()
}
