//! Names in drawings: a longer name takes blanks or wire beside it, a shorter one leaves some, so that everything else
//! of its line stays in its column.

use crate::document::{Chunk, Document, Mention, Tree};
use crate::ide::changes;
use crate::text::{Span, TextEdit, text_width};

/// What may be shortened and lengthened.
const WIRES: &[char] = &['-', '─', '━', '═', '_'];

/// The edits that put `new` at all of `places`, which are sorted, one edit for each line.
///
/// # Errors
/// With the place for which there is no room.
fn edits(document: &Document, places: &[Span], new: &str) -> Result<Vec<TextEdit>, Span> {
    let line_of = |span: &Span| document.line_of(span.start as usize);
    let mut edits = Vec::new();
    for run in places.chunk_by(|left, right| line_of(left) == line_of(right)) {
        let (_, start, line) = document.line_at(run[0].start as usize);
        let old = line.trim_end_matches(['\n', '\r']);
        let inside: Vec<Span> = run
            .iter()
            .map(|span| Span::new(span.start as usize - start, span.end as usize - start))
            .collect();
        let Some(redrawn) = redrawn(old, &inside, new) else {
            return Err(run[0]);
        };
        edits.extend(changes::smallest(old, &redrawn, start));
    }
    Ok(edits)
}

/// The edits that write `new` at `places`, each with whether it stands in a drawing; read as `reader` reads, the
/// drawings say the same as before.
///
/// # Errors
/// With the first place that has no room, or after whose edit a drawing would say something else.
pub(in crate::ide) fn written(
    document: &Document,
    reader: &Document,
    mut places: Vec<(Span, bool)>,
    new: &str,
) -> Result<Vec<TextEdit>, Span> {
    places.sort_unstable();
    places.dedup();
    let of_kind = |drawn: bool| {
        let chosen = places.iter().filter(move |(_, is_drawn)| *is_drawn == drawn);
        chosen.map(|(span, _)| *span).collect::<Vec<_>>()
    };
    let drawn = of_kind(true);
    let mut all: Vec<TextEdit> = of_kind(false).into_iter().map(|span| TextEdit::new(span, new)).collect();
    all.extend(edits(document, &drawn, new)?);
    all.sort_by_key(|edit| edit.span);
    still_say_the_same(document, reader, &all, &drawn)?;
    Ok(all)
}

/// Whether the drawings touched by `edits`, read as those of `reader` are, say the same but for the renamed places.
/// Names belong to elements by their columns, so only reading them again can tell.
fn still_say_the_same(
    document: &Document,
    reader: &Document,
    edits: &[TextEdit],
    places: &[Span],
) -> Result<(), Span> {
    let mut next = 0;
    while let Some(at) = edits.get(next).and_then(|edit| document.chunk_at(edit.span.start as usize)) {
        let end = at.start + at.chunk.len();
        let inside: Vec<TextEdit> = edits[next..]
            .iter()
            .take_while(|edit| (edit.span.start as usize) < end)
            .map(|edit| {
                let (start, end) = (edit.span.start as usize - at.start, edit.span.end as usize - at.start);
                TextEdit::new(Span::new(start, end), edit.text.as_str())
            })
            .collect();
        let first = edits[next].span;
        next += inside.len().max(1);
        if !matches!(at.chunk.tree(), Tree::Ladder(_)) {
            continue;
        }
        let redrawn = TextEdit::apply_all(&inside, at.chunk.text());
        let redrawn = reader.chunk_of(&redrawn);
        let is_renamed = |mention: &Mention| places.binary_search(&mention.span.shifted(at.start)).is_ok();
        let pairs = at.chunk.mentions().iter().zip(redrawn.mentions());
        let same = |(old, new): (&Mention, &Mention)| {
            (old.usage, old.count) == (new.usage, new.count) && (old.symbol == new.symbol || is_renamed(old))
        };
        let counts = |chunk: &Chunk| (chunk.mentions().len(), chunk.problems().len(), chunk.size().rungs);
        if counts(at.chunk) != counts(&redrawn) || !pairs.into_iter().all(same) {
            return Err(first);
        }
    }
    Ok(())
}

/// `line` with `new` at `places`; nothing if there is no room. From right to left, so that offsets stay valid.
fn redrawn(line: &str, places: &[Span], new: &str) -> Option<String> {
    let mut result = line.to_string();
    for place in places.iter().rev() {
        result = replaced(&result, *place, new)?;
    }
    Some(result)
}

fn replaced(line: &str, place: Span, new: &str) -> Option<String> {
    let (head, old, tail) =
        (line.get(..place.start as usize)?, line.get(place.range())?, line.get(place.end as usize..)?);
    let (old_width, new_width) = (text_width(old), text_width(new));
    // A label before its colon, and a name with nothing drawn behind it, move nothing.
    let is_free = tail.trim().is_empty() || (head.trim().is_empty() && tail.trim_start().starts_with(':'));
    if is_free || old_width == new_width {
        let tail = if tail.trim().is_empty() { "" } else { tail };
        return Some(format!("{head}{new}{tail}"));
    }
    let closing = closing_length(head, tail);
    let (closed, behind) = tail.split_at(closing);
    if new_width < old_width {
        return Some(padded(head, new, (closed, behind), old_width - new_width));
    }
    let missing = new_width - old_width;
    if let Some(behind) = shortened_start(behind, missing) {
        return Some(format!("{head}{new}{closed}{behind}"));
    }
    let opening = opening_length(head, tail);
    let (before, open) = head.split_at(head.len() - opening);
    let before = shortened_end(before, missing)?;
    Some(format!("{before}{open}{new}{tail}"))
}

/// How much of `tail` belongs to the bracket or arrow in which the name stands.
fn closing_length(head: &str, tail: &str) -> usize {
    let Some(open) = last_open(head) else {
        return if head.ends_with('>') && tail.starts_with('>') { 1 } else { 0 };
    };
    let close = if open == '[' { ']' } else { ')' };
    tail.find(close).map_or(0, |end| end + 1)
}

/// How much of the end of `head` belongs to the bracket or arrow in which the name stands.
fn opening_length(head: &str, tail: &str) -> usize {
    match last_open(head) {
        Some(open) => head.rfind(open).map_or(0, |start| head.len() - start),
        None if head.ends_with('>') && tail.starts_with('>') => 1,
        None => head.len() - head.trim_end_matches('>').len(),
    }
}

/// The bracket in which the end of `head` stands.
fn last_open(head: &str) -> Option<char> {
    let last = head.rfind(['[', '(', ']', ')', '|', '+', '-'])?;
    head[last..].chars().next().filter(|c| matches!(c, '[' | '('))
}

/// A name with `room` cells left over: wire goes on where it follows, else blanks.
fn padded(head: &str, new: &str, (closed, behind): (&str, &str), room: usize) -> String {
    let fill = |fill: char, count: usize| std::iter::repeat_n(fill, count).collect::<String>();
    match behind.chars().next().filter(|first| WIRES.contains(first)) {
        Some(wire) => format!("{head}{new}{closed}{}{behind}", fill(wire, room)),
        // Without wire behind the bracket the blanks go inside of it.
        None if !closed.is_empty() => format!("{head}{new}{}{closed}{behind}", fill(' ', room)),
        // Above an element the middle stays where it was, since columns decide whose name it is.
        None => format!("{head}{}{new}{}{behind}", fill(' ', room / 2), fill(' ', room - room / 2)),
    }
}

/// `text` with `count` cells less at its start, all of them blanks or wire of which at least one is left.
fn shortened_start(text: &str, count: usize) -> Option<&str> {
    let fill = text.chars().next().filter(|first| *first == ' ' || WIRES.contains(first))?;
    let run = text.chars().take_while(|character| *character == fill).count();
    // At the end of a line no blank need be left.
    let needed = if text.trim().is_empty() { count } else { count + 1 };
    (run >= needed).then(|| text.get(count * fill.len_utf8()..)).flatten()
}

/// The same at the end of `text`.
fn shortened_end(text: &str, count: usize) -> Option<&str> {
    let fill = text.chars().next_back().filter(|last| *last == ' ' || WIRES.contains(last))?;
    let run = text.chars().rev().take_while(|character| *character == fill).count();
    (run > count).then(|| text.get(..text.len() - count * fill.len_utf8())).flatten()
}
