//! Names in drawings: a longer name takes blanks or wire beside it, a shorter one leaves some, so that everything else
//! of its line stays in its column.

use crate::document::{Chunk, Document, Mention, Symbol, Tree};
use crate::ide::changes;
use crate::ide::names::Named;
use crate::text::{Message, Span, TextEdit, text_width};

/// What may be shortened and lengthened.
const WIRES: &[char] = &['-', '─', '━', '═', '_'];

/// A name is parted at one of so many `_`.
const MOST_CUTS: usize = 12;

/// A place of a drawing and what is to stand there.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(in crate::ide) struct Place {
    pub span: Span,
    pub text: String,
}

/// Why a new name cannot be drawn, with the place.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(in crate::ide) enum Misfit {
    /// There is no room: it would run into this.
    NoRoom(Span, String),
    /// With it the drawing would not say the same any more.
    Misread(Span),
    /// The old name stands over so many lines, and the new one has no `_` to part it there.
    Lines(Span, usize),
}

impl Misfit {
    pub(in crate::ide) fn place(&self) -> Span {
        match self {
            Misfit::NoRoom(span, _) | Misfit::Misread(span) | Misfit::Lines(span, _) => *span,
        }
    }

    /// The keys of its message for a place in the file that is looked at, and in another one.
    pub(in crate::ide) fn keys(&self) -> [&'static str; 2] {
        match self {
            Misfit::NoRoom(..) => ["rename.drawing", "rename.drawing-elsewhere"],
            Misfit::Misread(_) => ["rename.misread", "rename.misread-elsewhere"],
            Misfit::Lines(..) => ["rename.lines", "rename.lines-elsewhere"],
        }
    }

    /// `message` of one of the keys with what it has to say besides the place.
    pub(in crate::ide) fn fill(&self, message: Message) -> Message {
        match self {
            Misfit::NoRoom(_, other) => message.with("other", other),
            Misfit::Misread(_) => message,
            Misfit::Lines(_, count) => message.with("count", count),
        }
    }
}

/// What is to stand where `named` is drawn, so that its name becomes `new`: one that is written over several lines is
/// parted at the `_` by which the lines fit best.
///
/// # Errors
/// If the new name cannot be parted.
pub(in crate::ide) fn place(named: &Named<'_>, new: &str) -> Result<Place, Misfit> {
    let (span, inside) = (named.span, named.inside());
    let Some(lines) = name_lines(named.chunk, inside) else {
        return Ok(Place { span, text: new.to_string() });
    };
    let old: Vec<&str> = lines.iter().map(|line| line.of(named.chunk.text())).collect();
    let number = lines.iter().position(|line| *line == inside);
    let text = number.and_then(|number| parted(new, &old)?.into_iter().nth(number));
    text.map(|text| Place { span, text }).ok_or(Misfit::Lines(span, lines.len()))
}

/// The lines of the name of which `span` is one, if it is written over several.
fn name_lines(chunk: &Chunk, span: Span) -> Option<&[Span]> {
    let Tree::Ladder(tree) = chunk.tree() else { return None };
    let rungs = tree.rungs.iter().filter(|rung| rung.span.start <= span.start && span.end <= rung.span.end);
    let mut elements = rungs.flat_map(|rung| &rung.graph.elements);
    let is_own = |line: &Span| line.start <= span.start && span.end <= line.end;
    let element =
        elements.find(|element| element.name_lines.len() > 1 && element.name_lines.iter().any(is_own))?;
    Some(&element.name_lines)
}

/// `new` in as many parts as `old` has, so that they need the fewest cells beyond those of the old ones.
fn parted(new: &str, old: &[&str]) -> Option<Vec<String>> {
    let Some((first, rest)) = old.split_first() else { return new.is_empty().then(Vec::new) };
    if rest.is_empty() {
        return (!new.is_empty()).then(|| vec![new.to_string()]);
    }
    let excess = |parts: &[String]| -> usize {
        parts.iter().zip(old).map(|(part, old)| text_width(part).saturating_sub(text_width(old))).sum()
    };
    let cuts = new.match_indices('_').take(MOST_CUTS);
    let ways = cuts.filter(|(at, _)| *at > 0).filter_map(|(at, _)| {
        // Where the old line ends with the `_` of the name, so does the new one.
        let head = if first.ends_with('_') { new.get(..=at)? } else { new.get(..at)? };
        let tail = parted(new.get(at + 1..)?, rest)?;
        Some(std::iter::once(head.to_string()).chain(tail).collect::<Vec<_>>())
    });
    ways.min_by_key(|parts| excess(parts))
}

/// The edits that write at all of `places`, which are sorted, what belongs there, one edit for each line.
///
/// # Errors
/// With the place for which there is no room.
fn edits(document: &Document, places: &[Place]) -> Result<Vec<TextEdit>, Misfit> {
    let line_of = |place: &Place| document.line_of(place.span.start as usize);
    let mut edits = Vec::new();
    for run in places.chunk_by(|left, right| line_of(left) == line_of(right)) {
        let (_, start, line) = document.line_at(run[0].span.start as usize);
        let old = line.trim_end_matches(['\n', '\r']);
        // From right to left, so that offsets stay valid.
        let mut redrawn = old.to_string();
        for place in run.iter().rev() {
            let inside = Span::new(place.span.start as usize - start, place.span.end as usize - start);
            let wider = replaced(&redrawn, inside, &place.text);
            redrawn = wider.ok_or_else(|| Misfit::NoRoom(place.span, neighbour(&redrawn, inside)))?;
        }
        edits.extend(changes::smallest(old, &redrawn, start));
    }
    Ok(edits)
}

/// The edits that write `new` at the places `plain` and what belongs there at those of `drawn`; read as `reader` reads,
/// the drawings say the same as before.
///
/// # Errors
/// With the first place where that cannot be.
pub(in crate::ide) fn written(
    document: &Document,
    reader: &Document,
    (mut plain, mut drawn): (Vec<Span>, Vec<Place>),
    new: &str,
) -> Result<Vec<TextEdit>, Misfit> {
    plain.sort_unstable();
    plain.dedup();
    drawn.sort_unstable();
    drawn.dedup();
    let mut all: Vec<TextEdit> = plain.into_iter().map(|span| TextEdit::new(span, new)).collect();
    all.extend(edits(document, &drawn)?);
    all.sort_by_key(|edit| edit.span);
    still_say_the_same(document, reader, &all, &drawn, new)?;
    Ok(all)
}

/// What stands nearest to the right of `place` in `line`, wire aside; to its left if there is nothing.
fn neighbour(line: &str, place: Span) -> String {
    let is_gap = |c: char| c.is_whitespace() || WIRES.contains(&c);
    let tail = line.get(place.end as usize..).unwrap_or("");
    let tail = tail.trim_start_matches([')', ']']).trim_start_matches(is_gap);
    let right = tail.split(is_gap).next().unwrap_or("");
    let head = line.get(..place.start as usize).unwrap_or("").trim_end_matches(is_gap);
    let left = || head.rsplit(is_gap).next().unwrap_or("");
    if right.is_empty() { left() } else { right }.to_string()
}

/// Whether the drawings touched by `edits`, read as those of `reader` are, say the same but for the renamed places.
/// Names belong to elements by their columns, so only reading them again can tell. A variable must have become `new`.
fn still_say_the_same(
    document: &Document,
    reader: &Document,
    edits: &[TextEdit],
    places: &[Place],
    new: &str,
) -> Result<(), Misfit> {
    let renamed = Symbol::variable(new);
    let is_new = |symbol: &Symbol| !matches!(symbol, Symbol::Variable(_)) || *symbol == renamed;
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
        let is_renamed = |mention: &Mention| {
            let span = mention.span.shifted(at.start);
            places.binary_search_by_key(&span, |place| place.span).is_ok()
        };
        let pairs = at.chunk.mentions().iter().zip(redrawn.mentions());
        let same = |(old, new): (&Mention, &Mention)| {
            (old.usage, old.count) == (new.usage, new.count)
                && (old.symbol == new.symbol || is_renamed(old) && is_new(&new.symbol))
        };
        let counts = |chunk: &Chunk| (chunk.mentions().len(), chunk.problems().len(), chunk.size().rungs);
        if counts(at.chunk) != counts(&redrawn) || !pairs.into_iter().all(same) {
            return Err(Misfit::Misread(first));
        }
    }
    Ok(())
}

/// `line` with `new` at `place`; nothing if there is no room.
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
