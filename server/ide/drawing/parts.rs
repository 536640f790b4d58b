//! New elements, and operations on the parts of a shape.

use super::assemble::Plan;
use crate::ladder::parse;
use crate::ladder::reduce::{BlockShape, Shape};
use crate::ladder::{
    Arc, ArcId, CoilKind, CompareOperator, ContactKind, Element, ElementId, ElementKind, Graph,
};
use crate::target::Target;
use crate::target::iec::{FunctionBlock, Parameter};
use crate::text::{Message, Span};

/// What stands where a name is still to be given.
pub(super) const PLACEHOLDER: &str = "???";

/// What can be inserted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum New {
    Contact(ContactKind),
    Coil(CoilKind),
    Box,
}

/// An element of a kind with these operands, read from a drawing of it; with the drawing, in which its words stand.
pub(super) fn element(new: New, operand: &str, target: &Target) -> Result<(Element, String), Message> {
    let refuse = || Message::new("edit.operand").with("operand", operand);
    if operand.contains(['\n', '\r', '\t']) {
        return Err(refuse());
    }
    let length = operand.chars().count() * 2 + 8;
    let (wire, blanks) = ("-".repeat(length), " ".repeat(length));
    let drawing = match new {
        New::Contact(kind) => {
            let mark = kind.mark();
            format!("|     {operand}{blanks}|\n+----|{mark}|{wire}+\n")
        }
        New::Coil(kind) => {
            let mark = kind.mark();
            format!("|     {operand}{blanks}|\n+----({mark}){wire}+\n")
        }
        New::Box => match function_block(operand, target) {
            Some(drawing) => drawing,
            None => format!("+----[{operand}]{wire}+\n"),
        },
    };
    let tree = parse(&drawing, target);
    let [rung] = tree.rungs.as_slice() else { return Err(refuse()) };
    let [element] = rung.graph.elements.as_slice() else { return Err(refuse()) };
    let as_wanted = match (&element.kind, new) {
        (ElementKind::Contact(kind), New::Contact(wanted)) => *kind == wanted && element.operands.len() == 1,
        (ElementKind::Coil(kind), New::Coil(wanted)) => *kind == wanted && !element.operands.is_empty(),
        (_, New::Box) => true,
        _ => false,
    };
    // A name that the target does not know is the user's business and reported as any other; words that belong to
    // nothing would be lost.
    let words: usize = element.operands.iter().map(|operand| operand.span.len()).sum();
    let all =
        operand.chars().filter(|character| !character.is_whitespace()).map(char::len_utf8).sum::<usize>();
    let complete = new == New::Box || words == all;
    if !as_wanted || !complete || !tree.problems.is_empty() || !element.notes.is_empty() {
        return Err(refuse());
    }
    Ok((element.clone(), drawing))
}

/// The drawing of a standard function block, for `TON` or `Delay : TON`: power through its first input and output,
/// open places at its other inputs.
fn function_block(operand: &str, target: &Target) -> Option<String> {
    let (instance, name) = operand.split_once(':').unwrap_or((PLACEHOLDER, operand));
    let (instance, name) = (instance.trim(), name.trim());
    let block = FunctionBlock::named(name).filter(|_| !target.is_fx() && !instance.is_empty())?;
    let widest = |pins: &[Parameter]| pins.iter().map(|pin| pin.name.len()).max().unwrap_or(0);
    let (left, right) = (widest(block.inputs), widest(block.outputs));
    let inner = (left + right + 2).max(name.len());
    let margin = instance.chars().count() + 12;
    let blanks = " ".repeat(margin);
    let border = format!("{blanks}+{}+\n", "-".repeat(inner));
    let mut drawing = format!("{blanks}{instance}\n{border}{blanks}|{name:^inner$}|\n");
    for row in 0..block.inputs.len().max(block.outputs.len()) {
        let input = block.inputs.get(row).map_or("", |pin| pin.name);
        let output = block.outputs.get(row).map_or("", |pin| pin.name);
        let (before, behind) = match row {
            0 => (format!("+{}", "-".repeat(margin - 1)), "-----+".to_string()),
            _ if input.is_empty() => (blanks.clone(), String::new()),
            _ => (format!("{}{PLACEHOLDER}--", " ".repeat(margin - PLACEHOLDER.len() - 2)), String::new()),
        };
        let gap = inner - input.len() - output.len();
        drawing.push_str(&format!("{before}|{input}{}{output}|{behind}\n", " ".repeat(gap)));
    }
    drawing.push_str(&border);
    Some(drawing)
}

/// The element with all its places moved by so many bytes.
pub(super) fn shifted(element: &Element, by: usize) -> Element {
    let mut element = element.clone();
    let shift = |span: &mut Span| *span = span.shifted(by);
    shift(&mut element.span);
    element.operands.iter_mut().for_each(|operand| shift(&mut operand.span));
    element.name_lines.iter_mut().chain(&mut element.notes).for_each(shift);
    match &mut element.kind {
        ElementKind::Instruction { mnemonic: word, .. }
        | ElementKind::Jump(word)
        | ElementKind::ConnectorOut(word)
        | ElementKind::ConnectorIn(word) => shift(word),
        ElementKind::Block(block) => {
            block.instance.iter_mut().chain(&mut block.type_name).chain(&mut block.rows).for_each(shift);
            let pins = block.inputs.iter_mut().chain(&mut block.outputs);
            pins.filter_map(|pin| pin.name.as_mut()).for_each(shift);
        }
        _ => {}
    }
    element
}

/// The negation of an element, if it has one in the notation.
pub(super) fn negated(kind: &ElementKind) -> Option<ElementKind> {
    use CompareOperator::*;
    Some(match kind {
        ElementKind::Contact(ContactKind::NormallyOpen) => ElementKind::Contact(ContactKind::NormallyClosed),
        ElementKind::Contact(ContactKind::NormallyClosed) => ElementKind::Contact(ContactKind::NormallyOpen),
        ElementKind::Coil(CoilKind::Plain) => ElementKind::Coil(CoilKind::Negated),
        ElementKind::Coil(CoilKind::Negated) => ElementKind::Coil(CoilKind::Plain),
        ElementKind::Compare(operator) => ElementKind::Compare(match *operator {
            Equal { wide } => NotEqual { wide },
            NotEqual { wide } => Equal { wide },
            Greater { wide } => LessOrEqual { wide },
            LessOrEqual { wide } => Greater { wide },
            Less { wide } => GreaterOrEqual { wide },
            GreaterOrEqual { wide } => Less { wide },
        }),
        _ => return None,
    })
}

/// Puts an element into a wire. The order of branches at both ends stays.
pub(super) fn split_wire(graph: &mut Graph, wire: ArcId, element: Element) -> ElementId {
    let id = ElementId(graph.elements.len() as u32);
    let vertex = graph.add_element(element);
    let rest = ArcId(graph.arcs.len() as u32);
    let Arc { head, head_pin, next_in, .. } = graph.arcs[wire.0 as usize].clone();
    graph.arcs.push(Arc {
        tail: vertex,
        tail_pin: 0,
        head,
        head_pin,
        next_out: None,
        next_in,
        cells: (0, 0),
    });
    let first = &mut graph.arcs[wire.0 as usize];
    (first.head, first.head_pin, first.next_in) = (vertex, 0, None);
    // In the list of the head the new wire takes the place of the old one.
    for arc in &mut graph.arcs[..rest.0 as usize] {
        if arc.head == head && arc.next_in == Some(wire) {
            arc.next_in = Some(rest);
        }
    }
    let lists = &mut graph.vertices[head.0 as usize];
    for end in [&mut lists.first_in, &mut lists.last_in] {
        if *end == Some(wire) {
            *end = Some(rest);
        }
    }
    let lists = &mut graph.vertices[vertex.0 as usize];
    (lists.first_in, lists.last_in, lists.in_degree) = (Some(wire), Some(wire), 1);
    (lists.first_out, lists.last_out, lists.out_degree) = (Some(rest), Some(rest), 1);
    id
}

/// The way down to an element: the number of the child at each part.
pub(super) fn path_to(shape: &Shape, id: ElementId) -> Option<Vec<usize>> {
    match shape {
        Shape::Element(element) => (*element == id).then(Vec::new),
        Shape::Block(block) if block.element == id => Some(Vec::new()),
        Shape::Wire => None,
        _ => children(shape).into_iter().enumerate().find_map(|(number, child)| {
            let mut path = path_to(child, id)?;
            path.insert(0, number);
            Some(path)
        }),
    }
}

/// The parts of a part; those of a block are what lies at its further inputs, then at its further outputs.
pub(super) fn children(shape: &Shape) -> Vec<&Shape> {
    match shape {
        Shape::Series(parts) | Shape::Parallel(parts) => parts.iter().collect(),
        Shape::Block(block) => block.inputs.iter().chain(&block.outputs).map(|(_, shape)| shape).collect(),
        Shape::Element(_) | Shape::Wire => Vec::new(),
    }
}

/// The part at the end of a path.
pub(super) fn part_at<'s>(shape: &'s Shape, path: &[usize]) -> Option<&'s Shape> {
    path.iter().try_fold(shape, |shape, step| children(shape).get(*step).copied())
}

/// The part at the end of a path, to be changed.
pub(super) fn part_at_mut<'s>(shape: &'s mut Shape, path: &[usize]) -> Option<&'s mut Shape> {
    let Some((step, rest)) = path.split_first() else { return Some(shape) };
    let child = match shape {
        Shape::Series(parts) | Shape::Parallel(parts) => parts.get_mut(*step)?,
        Shape::Block(block) => {
            let mut sides = block.inputs.iter_mut().chain(&mut block.outputs);
            &mut sides.nth(*step)?.1
        }
        Shape::Element(_) | Shape::Wire => return None,
    };
    part_at_mut(child, rest)
}

/// The shape as [`reduce`](crate::ladder::reduce::reduce) would give it: nothing nested in its own kind, no wire in a
/// series, no series or parallel of one part.
pub(super) fn canonical(shape: Shape) -> Shape {
    match shape {
        Shape::Series(parts) => {
            let mut flat = Vec::with_capacity(parts.len());
            for part in parts.into_iter().map(canonical) {
                match part {
                    Shape::Series(inner) => flat.extend(inner),
                    Shape::Wire => {}
                    part => flat.push(part),
                }
            }
            single(flat, Shape::Series)
        }
        Shape::Parallel(branches) => {
            let mut flat = Vec::with_capacity(branches.len());
            for branch in branches.into_iter().map(canonical) {
                match branch {
                    Shape::Parallel(inner) => flat.extend(inner),
                    branch => flat.push(branch),
                }
            }
            single(flat, Shape::Parallel)
        }
        Shape::Block(block) => {
            let sides = |sides: Vec<(u16, Shape)>| {
                sides.into_iter().map(|(pin, shape)| (pin, canonical(shape))).collect()
            };
            let BlockShape { element, inputs, outputs } = *block;
            Shape::Block(Box::new(BlockShape { element, inputs: sides(inputs), outputs: sides(outputs) }))
        }
        shape => shape,
    }
}

fn single(mut parts: Vec<Shape>, many: fn(Vec<Shape>) -> Shape) -> Shape {
    match parts.len() {
        0 => Shape::Wire,
        1 => parts.remove(0),
        _ => many(parts),
    }
}

/// What is left without some elements; nothing if all of it goes. A branch of which nothing is left goes, too: as a
/// bare wire it would be a short circuit.
pub(super) fn without(shape: &Shape, gone: &[ElementId]) -> Option<Shape> {
    let rest = |parts: &[Shape]| parts.iter().filter_map(|part| without(part, gone)).collect::<Vec<_>>();
    match shape {
        Shape::Element(element) => (!gone.contains(element)).then(|| shape.clone()),
        Shape::Block(block) if gone.contains(&block.element) => None,
        Shape::Block(block) => {
            let sides = |sides: &[(u16, Shape)]| {
                sides.iter().map(|(pin, shape)| (*pin, without(shape, gone).unwrap_or(Shape::Wire))).collect()
            };
            let (inputs, outputs) = (sides(&block.inputs), sides(&block.outputs));
            Some(Shape::Block(Box::new(BlockShape { element: block.element, inputs, outputs })))
        }
        Shape::Series(parts) => {
            let rest = rest(parts);
            (!rest.is_empty()).then(|| single(rest, Shape::Series))
        }
        Shape::Parallel(branches) => {
            let rest = rest(branches);
            (!rest.is_empty()).then(|| single(rest, Shape::Parallel))
        }
        Shape::Wire => Some(Shape::Wire),
    }
}

impl Plan {
    /// Whether a part is an output, or ends in outputs on all its branches.
    pub fn feeds_outputs(&self, part: &Shape) -> bool {
        match part {
            Shape::Element(id) => self.is_output(*id),
            Shape::Series(parts) => parts.last().is_some_and(|last| self.feeds_outputs(last)),
            Shape::Parallel(branches) => branches.iter().all(|branch| self.feeds_outputs(branch)),
            Shape::Block(_) | Shape::Wire => false,
        }
    }

    /// Whether any output is in a part.
    pub fn has_output(&self, part: &Shape) -> bool {
        part.elements().iter().any(|id| self.is_output(*id))
    }

    pub fn is_output(&self, id: ElementId) -> bool {
        self.elements.get(id.0 as usize).is_some_and(Element::is_output)
    }
}
