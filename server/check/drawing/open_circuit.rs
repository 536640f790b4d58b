//! # open-circuit
//!
//! A wire, a contact, an output or a branch has a loose end: no power gets in there, or none gets out. The mark is
//! on the exact cell at which the connection is lacking.
//!
//! On a machine the branch is dead: the seal-in that does not hold, the stop that is not asked. Mostly a wire is one
//! cell too short, or a vertical wire misses its corner. Draw the wire on to the nearest junction or rail, or remove
//! the stub.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |---+--------------------------------( )-+
//! |   Y0    |                                    |
//! +---| |-- |                                    |
//!         ^
//! ```
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |---+--------------------------------( )-+
//! |   Y0    |                                    |
//! +---| |---+                                    |
//! ```
//!
//! A part of the drawing that no rail reaches is one mistake, marked at its first loose end.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |------------------------------------( )-+
//!
//! |             X1                           Y1  |
//! |           --| |--------------------------( )-+
//!             ^
//! ```

use super::Drawn;
use super::loose_end::{End, EndKind, mistakes};
use super::picture::{Picture, Place, Side, is_bar, is_box_drawing, is_junction, is_wire};
use super::prune::Prune;
use crate::check::{Rule, Run};
use crate::ladder::{Element, VertexKind};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};
use rustc_hash::FxHashSet;

pub(super) const RULE: Rule = Rule {
    code: "open-circuit",
    severity: Severity::Error,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("open_circuit.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    let rungs = &drawn.tree.rungs;
    let lacks = |kind: &VertexKind, degree: u32| match kind {
        VertexKind::LooseEnd => true,
        VertexKind::Junction => degree == 0,
        _ => false,
    };
    let open = rungs.iter().flat_map(|rung| &rung.graph.vertices);
    if !open.into_iter().any(|vertex| lacks(&vertex.kind, vertex.in_degree.min(vertex.out_degree))) {
        return;
    }
    let picture = Picture::new(drawn.text);
    let broken = drawn.breaking().into_iter().chain(drawn.in_doubt());
    let broken: FxHashSet<Place> = broken.flat_map(|span| around(&picture, span)).collect();
    for mistake in mistakes(rungs, &picture) {
        // What ends at a cell that could not be read is no mistake of its own.
        if mistake.iter().any(|end| broken.contains(&end.place)) {
            continue;
        }
        let Some((first, others)) = mistake.split_first() else { continue };
        let mut diagnostic = Diagnostic::new(RULE.code, first.span, message(drawn, first));
        const SHOWN: usize = 8;
        for other in others.iter().filter(|other| other.span != first.span).take(SHOWN) {
            diagnostic = diagnostic.related(other.span, Message::new("open-circuit.other-end"));
        }
        if drawn.can_try() {
            offer_fixes(drawn, &picture, &mistake, &mut diagnostic);
        }
        found.push(diagnostic);
    }
}

/// The cells of a span and those around them; for a bracket without partner also what stands behind it, up to the
/// wire.
fn around(picture: &Picture, span: Span) -> Vec<Place> {
    let cells: Vec<Place> = picture.places(span).collect();
    let row = cells.first().map_or(0, |cell| cell.0);
    let first = cells.first().map_or(0, |cell| cell.1.saturating_sub(1));
    let mut last = cells.last().map_or(0, |cell| cell.1 + 1);
    if let [bracket] = cells[..]
        && matches!(picture.at(bracket), '[' | '(' | '{')
    {
        const SHOWN: usize = 80;
        let ends = |column: &usize| {
            let character = picture.at((row, *column));
            is_wire(character) || is_bar(character) || is_junction(character)
        };
        last = (last..last + SHOWN).find(ends).unwrap_or(last);
    }
    (row.saturating_sub(1)..=row + 1)
        .flat_map(|row| (first..=last).map(move |column| (row, column)))
        .collect()
}

fn message(drawn: &Drawn<'_>, end: &End) -> Message {
    let element: Option<&Element> =
        end.element.and_then(|id| drawn.tree.rungs.get(end.rung).map(|rung| rung.graph.element(id)));
    let message = match (end.kind, element) {
        (EndKind::WireRight, Some(_)) => Message::new("open-circuit.wire-right-of"),
        (EndKind::WireRight, None) => Message::new("open-circuit.wire-right"),
        (EndKind::WireLeft, Some(_)) => Message::new("open-circuit.wire-left-of"),
        (EndKind::WireLeft, None) => Message::new("open-circuit.wire-left"),
        (EndKind::ElementRight, _) => Message::new("open-circuit.element-right"),
        (EndKind::ElementLeft, _) => Message::new("open-circuit.element-left"),
        (EndKind::Vertical, _) if end.sides.first() == Some(&Side::Up) => {
            Message::new("open-circuit.vertical-top")
        }
        (EndKind::Vertical, _) => Message::new("open-circuit.vertical-bottom"),
        (EndKind::Corner, _) => Message::new("open-circuit.corner"),
        (EndKind::JunctionLeft, _) => Message::new("open-circuit.junction-left"),
        (EndKind::JunctionRight, _) => Message::new("open-circuit.junction-right"),
    };
    match element {
        Some(element) => message.with("element", drawn.name(element)),
        None => message,
    }
}

/// Offers to close the gap, to draw on to what is nearest, to remove the stub: whichever makes the drawing better.
fn offer_fixes(drawn: &Drawn<'_>, picture: &Picture, mistake: &[End], diagnostic: &mut Diagnostic) {
    let mut reaches: Vec<(usize, Vec<(Place, char)>)> = Vec::new();
    if let Some(marks) = common_cell(picture, mistake) {
        reaches.push((0, marks));
    }
    for end in mistake.iter().take(2) {
        for side in &end.sides {
            reaches.extend(extension(picture, end, *side));
        }
    }
    reaches.sort_by_key(|(distance, _)| *distance);
    for (_, marks) in reaches {
        let title = Message::new("open-circuit.extend");
        if drawn.try_fix(diagnostic, title, picture.draw(&marks)) {
            break;
        }
    }
    let [end, ..] = mistake else { return };
    if end.element.is_none() {
        drawn.try_fix(diagnostic, Message::new("open-circuit.remove"), stub(drawn, picture, end));
    }
}

/// The junction in the one cell that several ends lack.
fn common_cell(picture: &Picture, mistake: &[End]) -> Option<Vec<(Place, char)>> {
    let [first, second, ..] = mistake else { return None };
    let missing = |end: &End| end.sides.iter().filter_map(|side| side.of(end.place)).collect::<Vec<_>>();
    let others = missing(second);
    let common =
        missing(first).into_iter().find(|place| others.contains(place) && picture.at(*place) == ' ')?;
    let upright = |end: &End| end.place.1 == common.1;
    let mark = match (upright(first), upright(second), mistake.len()) {
        (true, true, 2) => '|',
        (false, false, 2) => '-',
        _ => '+',
    };
    Some(vec![(common, like(picture.at(first.place), mark))])
}

/// The marks that lead from an end to the first thing on one side, with the number of cells between.
fn extension(picture: &Picture, end: &End, side: Side) -> Option<(usize, Vec<(Place, char)>)> {
    let (target, blanks) = picture.look(end.place, side)?;
    let (own, met) = (picture.at(end.place), picture.at(target));
    let line = like(own, if side.is_horizontal() { '-' } else { '|' });
    let mut marks: Vec<(Place, char)> = blanks.iter().map(|place| (*place, line)).collect();
    let joint = match side {
        Side::Left | Side::Right if is_bar(met) => Some(if is_box_drawing(met) { tee(side) } else { '+' }),
        Side::Up | Side::Down if is_wire(met) => Some(if is_box_drawing(met) { tee(side) } else { '+' }),
        _ if is_wire(met) || is_bar(met) || is_junction(met) => None,
        Side::Left | Side::Right if matches!(met, '(' | ')' | '[' | ']' | '{' | '}' | '<' | '>') => None,
        _ => return None,
    };
    marks.extend(joint.map(|joint| (target, joint)));
    // A bar that gets a wire at its side is a corner.
    if side.is_horizontal() && is_bar(own) {
        marks.push((end.place, '+'));
    }
    Some((blanks.len(), marks))
}

/// The box drawing character for a line that meets another one from its `side`'s opposite.
fn tee(side: Side) -> char {
    match side {
        Side::Left => '├',
        Side::Right => '┤',
        Side::Up => '┬',
        Side::Down => '┴',
    }
}

/// `plain`, or the box drawing character for it where `neighbour` is one.
fn like(neighbour: char, plain: char) -> char {
    match (is_box_drawing(neighbour), plain) {
        (true, '-') => '─',
        (true, '|') => '│',
        (true, '+') => '┼',
        _ => plain,
    }
}

/// The edits that take out a wire which leads nowhere.
fn stub(drawn: &Drawn<'_>, picture: &Picture, end: &End) -> Option<Vec<TextEdit>> {
    let graph = &drawn.tree.rungs.get(end.rung)?.graph;
    let mut prune = Prune::new(picture, graph);
    prune.wire(end.arc?);
    prune.edits()
}
