//! What each structural edit makes of a rung.

use super::EditKind;
use super::assemble::Plan;
use super::look::NEW_ROW;
use super::parts::{self, New, PLACEHOLDER, part_at, part_at_mut, path_to};
use super::site::{Site, Spot};
use crate::ladder::reduce::{NotSeriesParallel, Shape, reduce};
use crate::ladder::{ArcId, CoilKind, ContactKind, Element, ElementId, ElementKind, Graph};
use crate::text::{Message, Span};

/// A rung as it is to be.
#[derive(Debug)]
pub(super) struct Intended {
    pub plan: Plan,
    /// In which the words of all elements stand.
    pub source: String,
    /// The element to which the cursor goes.
    pub focus: Option<ElementId>,
    /// Elements of the old rung that are gone.
    pub removed: Vec<ElementId>,
    /// Elements of the old rung that are of another kind.
    pub changed: Vec<(ElementId, ElementKind)>,
}

/// A rung being edited.
struct Work<'s, 'd> {
    site: &'s Site<'d>,
    graph: Graph,
    source: String,
}

/// What `kind` makes of the rung at `site`, at the cursor or selection `span` of the document.
///
/// # Errors
/// Why it cannot be done there.
pub(super) fn intended(
    site: &Site<'_>,
    span: Span,
    kind: EditKind,
    operand: Option<&str>,
) -> Result<Intended, Message> {
    let work = Work { site, graph: site.rung.graph.clone(), source: site.text.to_string() };
    if let Some((new, name)) = inserted(site, kind, operand) {
        return work.insert(span, (new, &name));
    }
    let word = operand.map(str::trim).filter(|word| !word.is_empty());
    match kind {
        EditKind::InsertBranch | EditKind::WrapInBranch => work.branch(span, word),
        EditKind::MoveBranchUp => work.move_branch(span, true),
        EditKind::MoveBranchDown => work.move_branch(span, false),
        EditKind::DeleteElement => work.delete(span),
        EditKind::DeleteBranch => work.delete_branch(span),
        EditKind::Negate => work.negate(span),
        _ => Err(Message::new("edit.no-rung")),
    }
}

/// Why a graph cannot be edited by its shape.
fn not_editable(why: &NotSeriesParallel) -> Message {
    Message::new(match why {
        NotSeriesParallel::OpenCircuit(_) => "edit.open-circuit",
        NotSeriesParallel::Empty => "edit.open-circuit",
        NotSeriesParallel::Bridge(_) => "edit.bridge",
        NotSeriesParallel::SharedPin(_) => "edit.shared-pin",
        NotSeriesParallel::TooDeep => "edit.cannot-draw",
    })
}

impl Work<'_, '_> {
    fn shape(&self) -> Result<Shape, Message> {
        reduce(&self.graph).map_err(|why| not_editable(&why))
    }

    fn finish(
        self,
        shape: Shape,
        focus: Option<ElementId>,
        removed: Vec<ElementId>,
    ) -> Result<Intended, Message> {
        let mut watched: Vec<ElementId> = focus.into_iter().collect();
        let plan = Plan { shape: parts::canonical(shape), elements: self.graph.elements };
        let plan = plan.compacted(&mut watched);
        Ok(Intended {
            plan,
            source: self.source,
            focus: watched.first().copied(),
            removed,
            changed: Vec::new(),
        })
    }

    /// A new element, whose words are appended to the source.
    fn new_element(&mut self, new: New, operand: &str) -> Result<Element, Message> {
        let (element, drawing) = parts::element(new, operand, self.site.document.target())?;
        let mut element = parts::shifted(&element, self.source.len() + 1);
        element.row = NEW_ROW;
        self.source.push('\n');
        self.source.push_str(&drawing);
        Ok(element)
    }

    fn insert(mut self, span: Span, (new, operand): (New, &str)) -> Result<Intended, Message> {
        let wire = wire_at(self.site, span)?;
        let element = self.new_element(new, operand)?;
        let is_output = element.is_output();
        let id = parts::split_wire(&mut self.graph, wire, element);
        let mut shape = self.shape()?;
        let path = path_to(&shape, id).ok_or_else(|| Message::new("edit.no-place"))?;
        let plan = Plan { shape: Shape::Wire, elements: self.graph.elements.clone() };
        if is_output {
            shape = output_placed(shape, &path, &plan)?;
        } else if series_around(&shape, &path)
            .any(|(parts, at)| parts[..at].iter().any(|part| plan.has_output(part)))
        {
            return Err(Message::new("edit.behind-output"));
        }
        self.finish(shape, Some(id), Vec::new())
    }

    /// The elements of a selection, or the one at the cursor.
    fn selected(&self, span: Span) -> Result<Vec<ElementId>, Message> {
        let mut chosen = self.site.elements_in(span);
        if chosen.is_empty() {
            let offset = (span.start as usize).saturating_sub(self.site.start);
            // A cursor in a name's row or beside an element in its row means that element; one on a wire means none.
            match self.site.spot_on(offset) {
                Some(Spot::Element(id)) => chosen.push(id),
                Some(Spot::Wire(_)) => {}
                None => {
                    if let Some(Spot::Element(id)) = self.site.spot(span.start as usize) {
                        chosen.push(id);
                    }
                }
            }
        }
        if chosen.is_empty() { Err(Message::new("edit.no-element")) } else { Ok(chosen) }
    }

    /// A new branch beside the parts that hold the chosen elements.
    fn branch(mut self, span: Span, operand: Option<&str>) -> Result<Intended, Message> {
        let chosen = self.selected(span)?;
        let mut shape = self.shape()?;
        let (path, first, last) = cover(&shape, &chosen).ok_or_else(|| Message::new("edit.no-element"))?;
        let plan = Plan { shape: Shape::Wire, elements: self.graph.elements.clone() };
        let parent = part_at(&shape, &path).ok_or_else(|| Message::new("edit.no-element"))?;
        let covered: Vec<Shape> = match parent {
            Shape::Series(parts) | Shape::Parallel(parts) => parts[first..=last].to_vec(),
            other => vec![other.clone()],
        };
        let is_output = covered.last().is_some_and(|part| plan.feeds_outputs(part));
        if !is_output && covered.iter().any(|part| plan.has_output(part)) {
            return Err(Message::new("edit.mixed-selection"));
        }
        let new =
            if is_output { New::Coil(CoilKind::Plain) } else { New::Contact(ContactKind::NormallyOpen) };
        let element = self.new_element(new, operand.unwrap_or(PLACEHOLDER))?;
        let id = ElementId(self.graph.elements.len() as u32);
        self.graph.add_element(element);
        let open = Shape::Element(id);
        match part_at_mut(&mut shape, &path) {
            Some(Shape::Parallel(branches)) => branches.insert(last + 1, open),
            Some(Shape::Series(parts)) => {
                let rest = parts.drain(first..=last).collect();
                parts.insert(first, Shape::Parallel(vec![Shape::Series(rest), open]));
            }
            Some(part) => *part = Shape::Parallel(vec![part.clone(), open]),
            None => return Err(Message::new("edit.no-element")),
        }
        self.finish(shape, Some(id), Vec::new())
    }

    /// A shape in which the place of the cursor is an element, that element, and whether it is only a mark.
    fn marked(&mut self, span: Span) -> Result<(Shape, ElementId, bool), Message> {
        let marked = marked(self.site, &mut self.graph, span.start as usize);
        let (id, is_mark) = marked.ok_or_else(|| Message::new("edit.no-place"))?;
        Ok((self.shape()?, id, is_mark))
    }

    fn move_branch(mut self, span: Span, up: bool) -> Result<Intended, Message> {
        let (mut shape, id, is_mark) = self.marked(span)?;
        let (path, branch) = innermost_branch(&shape, id).ok_or_else(|| Message::new("edit.no-branch"))?;
        let Some(Shape::Parallel(branches)) = part_at_mut(&mut shape, &path) else {
            return Err(Message::new("edit.no-branch"));
        };
        let other = if up { branch.checked_sub(1) } else { Some(branch + 1) };
        let Some(other) = other.filter(|other| *other < branches.len()) else {
            return Err(Message::new(if up { "edit.first-branch" } else { "edit.last-branch" }));
        };
        branches.swap(branch, other);
        let focus = branches[other].elements().first().copied().filter(|first| !(is_mark && *first == id));
        let focus = if is_mark { focus } else { Some(id) };
        // A mark is taken out of its wire again.
        if is_mark
            && let Some(path) = path_to(&shape, id)
            && let Some(part) = part_at_mut(&mut shape, &path)
        {
            *part = Shape::Wire;
        }
        self.finish(shape, focus, Vec::new())
    }

    fn delete_branch(mut self, span: Span) -> Result<Intended, Message> {
        let (mut shape, id, is_mark) = self.marked(span)?;
        let (path, branch) = innermost_branch(&shape, id).ok_or_else(|| Message::new("edit.no-branch"))?;
        let Some(Shape::Parallel(branches)) = part_at_mut(&mut shape, &path) else {
            return Err(Message::new("edit.no-branch"));
        };
        let mut removed = branches.remove(branch).elements();
        removed.retain(|element| !(is_mark && *element == id));
        self.finish(shape, None, removed)
    }

    fn delete(self, span: Span) -> Result<Intended, Message> {
        let chosen = self.selected(span)?;
        let shape = self.shape()?;
        let with_sides = |id: &ElementId| {
            let part = path_to(&shape, *id).and_then(|path| part_at(&shape, &path).cloned());
            matches!(part, Some(Shape::Block(_)))
        };
        if chosen.iter().any(with_sides) {
            return Err(Message::new("edit.block-with-branches"));
        }
        let rest = parts::without(&shape, &chosen).unwrap_or(Shape::Wire);
        self.finish(rest, None, chosen)
    }

    fn negate(mut self, span: Span) -> Result<Intended, Message> {
        let chosen = self.selected(span)?;
        let shape = self.shape()?;
        for id in &chosen {
            let element = &mut self.graph.elements[id.0 as usize];
            // A timer counts or does not; its coil with a preset has no negated form.
            let has_preset = matches!(element.kind, ElementKind::Coil(_)) && element.operands.len() > 1;
            let negated = parts::negated(&element.kind).filter(|_| !has_preset);
            element.kind = negated.ok_or_else(|| Message::new("edit.no-negation"))?;
        }
        let kind = |id: &ElementId| (*id, self.graph.elements[id.0 as usize].kind.clone());
        let changed = chosen.iter().map(kind).collect();
        let focus = chosen.first().copied();
        Ok(Intended { changed, ..self.finish(shape, focus, Vec::new())? })
    }
}

/// What an insertion puts where, and how it is named.
pub(super) fn inserted(site: &Site<'_>, kind: EditKind, operand: Option<&str>) -> Option<(New, String)> {
    let word = operand.map(str::trim).filter(|word| !word.is_empty());
    let new = match kind {
        EditKind::InsertContact => New::Contact(ContactKind::NormallyOpen),
        EditKind::InsertNegatedContact => New::Contact(ContactKind::NormallyClosed),
        EditKind::InsertCoil => New::Coil(CoilKind::Plain),
        EditKind::InsertSetCoil => New::Coil(CoilKind::Set),
        EditKind::InsertResetCoil => New::Coil(CoilKind::Reset),
        EditKind::InsertBox => New::Box,
        _ => return None,
    };
    let name = match (word, new) {
        (Some(word), _) => word.to_string(),
        // The boxes of IEC programs are function blocks.
        (None, New::Box) if !site.document.target().is_fx() => "TON".to_string(),
        (None, New::Box) => format!("MOV {PLACEHOLDER} {PLACEHOLDER}"),
        (None, _) => PLACEHOLDER.to_string(),
    };
    Some((new, name))
}

/// The wire at the cursor into which something new goes: before the middle of an element that before it, else behind
/// it; never behind an output.
pub(super) fn wire_at(site: &Site<'_>, span: Span) -> Result<ArcId, Message> {
    let nothing = || Message::new("edit.no-place");
    let offset = span.start as usize;
    match site.spot(offset).ok_or_else(nothing)? {
        Spot::Wire(wire) => Ok(wire),
        Spot::Element(id) => {
            let element = site.element(id);
            let at = site.column(offset.saturating_sub(site.start));
            let before = element.is_output() || 2 * at < element.columns.0 + element.columns.1;
            let beside = site.wire_beside(id, before);
            beside.or_else(|| site.wire_beside(id, !before)).ok_or_else(nothing)
        }
    }
}

/// The element at a byte of the document; where a wire is, an element put into it as a mark, and `true`.
pub(super) fn marked(site: &Site<'_>, graph: &mut Graph, offset: usize) -> Option<(ElementId, bool)> {
    Some(match site.spot(offset)? {
        Spot::Element(id) => (id, false),
        Spot::Wire(wire) => {
            let mark = Element::new(ElementKind::Invert, Span::default(), NEW_ROW, (0, 0));
            (parts::split_wire(graph, wire, mark), true)
        }
    })
}

/// The graph of a rung with an element in one of its wires, where only its shape stands in the way of every other
/// edit: a bridge or an open end. Outputs go nowhere but to the right rail.
pub(super) fn in_wire(site: &Site<'_>, wire: ArcId, element: &Element) -> Option<Graph> {
    let mut graph = site.rung.graph.clone();
    let arc = graph.arc(wire);
    let is_output = |vertex| graph.element_at(vertex).is_some_and(Element::is_output);
    if is_output(arc.tail) || element.is_output() && arc.head != Graph::RIGHT_RAIL {
        return None;
    }
    parts::split_wire(&mut graph, wire, element.clone());
    Some(graph)
}

/// The series on the way down a path, outermost first, each with the number of the part on the way.
fn series_around<'s>(shape: &'s Shape, path: &'s [usize]) -> impl Iterator<Item = (&'s [Shape], usize)> {
    let steps = (0..path.len()).map(|depth| (part_at(shape, &path[..depth]), path[depth]));
    steps.filter_map(|(part, step)| match part {
        Some(Shape::Series(parts)) => Some((parts.as_slice(), step)),
        _ => None,
    })
}

/// A shape into which an output was put at the end of `path`, with the output at the end of its line: beside the
/// outputs that the line has already, as their last branch.
fn output_placed(mut shape: Shape, path: &[usize], plan: &Plan) -> Result<Shape, Message> {
    let in_middle = || Message::new("edit.coil-in-the-middle");
    // Wires to the further inputs of a block end there, not at the right rail.
    for depth in 0..path.len() {
        if let Some(Shape::Block(block)) = part_at(&shape, &path[..depth])
            && path[depth] < block.inputs.len()
        {
            return Err(in_middle());
        }
    }
    let behind = |(depth, step): (usize, &usize)| match part_at(&shape, &path[..depth]) {
        Some(Shape::Series(parts)) if step + 1 < parts.len() => Some(depth),
        _ => None,
    };
    let mut depths = path.iter().enumerate().filter_map(behind);
    let Some(depth) = depths.next() else { return Ok(shape) };
    let is_deepest = depths.next().is_none() && depth + 1 == path.len();
    let Some(Shape::Series(parts)) = part_at_mut(&mut shape, &path[..depth]) else { return Err(in_middle()) };
    let at = path[depth];
    let outputs_only = parts[at + 1..].iter().all(|part| plan.feeds_outputs(part));
    let tap = matches!(parts[at + 1], Shape::Element(_) | Shape::Parallel(_));
    if !is_deepest || !outputs_only || !tap {
        return Err(in_middle());
    }
    let rest: Vec<Shape> = parts.drain(at + 1..).collect();
    let output = parts.remove(at);
    parts.push(Shape::Parallel(vec![parts::canonical(Shape::Series(rest)), output]));
    Ok(shape)
}

/// The deepest series or parallel (or single element) that holds all chosen elements: the way to it, and the first
/// and last of its parts that hold any.
fn cover(shape: &Shape, chosen: &[ElementId]) -> Option<(Vec<usize>, usize, usize)> {
    let paths: Vec<Vec<usize>> = chosen.iter().map(|id| path_to(shape, *id)).collect::<Option<_>>()?;
    let (first, rest) = paths.split_first()?;
    let common = |length: usize, path: &Vec<usize>| {
        first[..length].iter().zip(path).take_while(|(left, right)| left == right).count()
    };
    let shared = rest.iter().fold(first.len(), common);
    // A single element is a part of what it stands in.
    let depth = if paths.iter().all(|path| path.len() > shared) { shared } else { shared.saturating_sub(1) };
    let steps: Vec<usize> = paths.iter().filter_map(|path| path.get(depth).copied()).collect();
    let parent = part_at(shape, &first[..depth])?;
    if matches!(parent, Shape::Block(_)) {
        return Some((first[..=depth.min(first.len().checked_sub(1)?)].to_vec(), 0, 0));
    }
    Some((
        first[..depth].to_vec(),
        steps.iter().copied().min().unwrap_or(0),
        steps.into_iter().max().unwrap_or(0),
    ))
}

/// The innermost parallel with an element in one of its branches: the way to it, and the branch.
pub(super) fn innermost_branch(shape: &Shape, id: ElementId) -> Option<(Vec<usize>, usize)> {
    let path = path_to(shape, id)?;
    let depth =
        (0..path.len()).rfind(|depth| matches!(part_at(shape, &path[..*depth]), Some(Shape::Parallel(_))))?;
    Some((path[..depth].to_vec(), path[depth]))
}
