//! The ways of power through a rung, one by one: by them two drawings are proved to say the same, and a rung that is
//! neither series nor parallel is drawn as one that is.

use super::reduce::Shape;
use super::{ContactKind, ElementId, ElementKind, Graph, VertexId, VertexKind};
use std::collections::BTreeSet;

/// A rung with more ways is not drawn apart: nobody could read it.
const MOST_PATHS: usize = 12;
/// Vertices on one way.
const LONGEST: usize = 200;
/// Junctions and elements that are looked at in all.
const MOST_STEPS: usize = 4_000;

/// The elements on each way from the left rail to the right one, top to bottom. Nothing if there are many, or if
/// anything but contacts, comparisons and outputs is on one: what an inverter, an edge or a block does is no matter of
/// single ways.
fn paths(graph: &Graph) -> Option<Vec<Vec<ElementId>>> {
    let mut found = Vec::new();
    let mut steps = 0;
    walk(graph, Graph::LEFT_RAIL, &mut Vec::new(), (0, &mut steps), &mut found)?;
    (!found.is_empty()).then_some(found)
}

fn walk(
    graph: &Graph,
    at: VertexId,
    way: &mut Vec<ElementId>,
    (depth, steps): (usize, &mut usize),
    found: &mut Vec<Vec<ElementId>>,
) -> Option<()> {
    *steps += 1;
    if *steps > MOST_STEPS || depth > LONGEST {
        return None;
    }
    let before = way.len();
    match graph.vertex(at).kind {
        VertexKind::RightRail => {
            found.push(way.clone());
            return (found.len() <= MOST_PATHS).then_some(());
        }
        VertexKind::Element(id) if is_plain(&graph.element(id).kind) => way.push(id),
        VertexKind::Element(_) | VertexKind::LooseEnd => return None,
        VertexKind::LeftRail | VertexKind::Junction => {}
    }
    for arc in graph.outgoing(at) {
        walk(graph, graph.arc(arc).head, way, (depth + 1, steps), found)?;
    }
    way.truncate(before);
    Some(())
}

fn is_plain(kind: &ElementKind) -> bool {
    match kind {
        ElementKind::Contact(kind) => matches!(kind, ContactKind::NormallyOpen | ContactKind::NormallyClosed),
        ElementKind::Compare(_) | ElementKind::Coil(_) | ElementKind::Instruction { .. } => true,
        _ => false,
    }
}

/// Whether power takes the same ways through both graphs, whose words stand in their texts, and reaches the outputs in
/// the same order. Contacts in another order on a way, or drawn once more, make no difference.
pub(super) fn same_ways((left, left_text): (&Graph, &str), (right, right_text): (&Graph, &str)) -> bool {
    let ways = |graph: &Graph, text: &str| -> Option<BTreeSet<BTreeSet<String>>> {
        let words = |way: Vec<ElementId>| way.into_iter().map(|id| words(graph, id, text)).collect();
        Some(paths(graph)?.into_iter().map(words).collect())
    };
    let same = ways(left, left_text).is_some_and(|ways_left| ways(right, right_text) == Some(ways_left));
    same && outputs(left, left_text) == outputs(right, right_text)
}

/// What an element is and what its operands are.
fn words(graph: &Graph, id: ElementId, text: &str) -> String {
    let element = graph.element(id);
    let kind = match &element.kind {
        ElementKind::Instruction { mnemonic, .. } => mnemonic.of(text).to_uppercase(),
        kind => format!("{kind:?}"),
    };
    let operands =
        (0..element.operands.len()).map(|number| element.operand_text(number, text).to_uppercase());
    std::iter::once(kind).chain(operands).collect::<Vec<_>>().join(" ")
}

/// The outputs in the order in which they are evaluated.
fn outputs(graph: &Graph, text: &str) -> Vec<String> {
    let all = (0..graph.elements.len() as u32).map(ElementId);
    let mut outputs: Vec<ElementId> = all.filter(|id| graph.element(*id).is_output()).collect();
    outputs.sort_by_key(|id| (graph.element(*id).row, graph.element(*id).columns));
    outputs.into_iter().map(|id| words(graph, id, text)).collect()
}

/// The series-parallel shape with the same ways as a graph that has none: contacts that ways share are drawn for each.
/// All ways must lead to the same outputs.
pub fn drawn_apart(graph: &Graph) -> Option<Shape> {
    let mut conditions: Vec<Vec<ElementId>> = Vec::new();
    let mut tails: Vec<Vec<Vec<ElementId>>> = Vec::new();
    for way in paths(graph)? {
        let output = way.iter().position(|id| graph.element(*id).is_output())?;
        let (before, behind) = way.split_at(output);
        // A contact behind an output is not evaluated as one before it.
        if before.is_empty() || !behind.iter().all(|id| graph.element(*id).is_output()) {
            return None;
        }
        match conditions.iter().position(|known| known == before) {
            Some(number) => tails[number].push(behind.to_vec()),
            None => {
                conditions.push(before.to_vec());
                tails.push(vec![behind.to_vec()]);
            }
        }
    }
    let (first, others) = tails.split_first()?;
    if others.iter().any(|tails| tails != first) {
        return None;
    }
    let shape = series([factored(conditions)?, factored(first.clone())?]);
    // Each output is driven in one place.
    let drawn = shape.elements();
    let once = |id: &ElementId| drawn.iter().filter(|other| *other == id).count() == 1;
    drawn.iter().filter(|id| graph.element(**id).is_output()).all(once).then_some(shape)
}

/// Ways in parallel, of which those that begin alike have their beginning in common, and all of them their end.
fn factored(mut ways: Vec<Vec<ElementId>>) -> Option<Shape> {
    let mut end = Vec::new();
    while ways.len() > 1
        && let Some(last) = ways[0].last().copied()
        && ways.iter().all(|way| way.len() > 1 && way.last() == Some(&last))
    {
        ways.iter_mut().for_each(|way| way.truncate(way.len() - 1));
        end.insert(0, Shape::Element(last));
    }
    let mut groups: Vec<(ElementId, Vec<Vec<ElementId>>)> = Vec::new();
    for way in ways {
        let (first, rest) = way.split_first()?;
        match groups.iter_mut().find(|(own, _)| own == first) {
            Some((_, rests)) => rests.push(rest.to_vec()),
            None => groups.push((*first, vec![rest.to_vec()])),
        }
    }
    let mut branches = Vec::new();
    for (first, rests) in groups {
        branches.push(match &rests[..] {
            [rest] => series(std::iter::once(&first).chain(rest).map(|id| Shape::Element(*id))),
            _ => series([Shape::Element(first), factored(rests)?]),
        });
    }
    let branches = if branches.len() == 1 { branches.remove(0) } else { Shape::Parallel(branches) };
    Some(series(std::iter::once(branches).chain(end)))
}

/// Parts in series, in one row.
fn series(parts: impl IntoIterator<Item = Shape>) -> Shape {
    let mut row = Vec::new();
    for part in parts {
        match part {
            Shape::Series(parts) => row.extend(parts),
            part => row.push(part),
        }
    }
    if row.len() == 1 { row.remove(0) } else { Shape::Series(row) }
}
