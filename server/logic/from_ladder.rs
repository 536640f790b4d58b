//! Reads a drawn rung: its series-parallel shape with words for cells.

mod block;

use super::builder::Builder;
use super::from_fx;
use super::from_iec;
use super::{
    Action, Contact, Declared, Deed, Elsewhere, Expression, Gate, Network, Path, Refusal, Rung, Term, Test,
};
use crate::document::{Scopes, boxed};
use crate::il::{fx, iec};
use crate::ladder::reduce::{NotSeriesParallel, Shape, reduce};
use crate::ladder::{self, Element, ElementKind, Graph, LadderTree};
use crate::target::{Model, Operand, Target};
use crate::text::{Diagnostic, Span, Spanned};

/// The rungs of a chunk of a drawing.
pub(super) fn rungs(text: &str, tree: &LadderTree, target: &Target, declared: Declared<'_>) -> Vec<Rung> {
    let header = tree.header.as_ref();
    let label = header.and_then(|header| header.label).map(|label| label.of(text).into());
    let network = header.filter(|header| header.label.is_none()).map(|header| Network {
        number: header.number.map(|number| number.value),
        title: header.title.map(|title| title.of(text).into()).unwrap_or_default(),
    });
    let mut rungs: Vec<Rung> = Vec::with_capacity(tree.rungs.len().max(1));
    let mut comments = Vec::new();
    let mut drawn = tree.rungs.iter().peekable();
    let mut above = tree.comments.iter().copied().peekable();
    loop {
        let end = drawn.peek().map_or(u32::MAX, |rung| rung.span.end);
        match above.next_if(|comment| comment.start < end) {
            Some(comment) => match boxed(comment.of(text)) {
                Some(list) => {
                    rungs.push(list_rung(list, comment, std::mem::take(&mut comments), target, declared))
                }
                None => comments.push(comment),
            },
            None => {
                let Some(rung) = drawn.next() else { break };
                rungs.push(Rung {
                    labels: Vec::new(),
                    network: None,
                    comments: std::mem::take(&mut comments),
                    span: rung.span,
                    is_list: false,
                    path: path(text, tree, rung, declared.scopes)
                        .map(|path| Some(path.located(declared.scopes, declared.pous.checked_sub(1)))),
                });
            }
        }
    }
    if rungs.is_empty() {
        let path = if tree.problems.is_empty() { Ok(None) } else { Err(Refusal::Unreadable) };
        let span = header.map_or(Span::at(text.len()), |header| header.span);
        rungs.push(Rung {
            labels: Vec::new(),
            network: None,
            comments: Vec::new(),
            span,
            is_list: false,
            path,
        });
    }
    if let Some(last) = rungs.last_mut() {
        last.comments.append(&mut comments);
    }
    if let Some(first) = rungs.first_mut() {
        first.labels.extend(label);
        first.network = network;
    }
    rungs
}

/// The rung that such a list is.
fn list_rung(
    (list, start): (&str, usize),
    comment: Span,
    comments: Vec<Span>,
    target: &Target,
    declared: Declared<'_>,
) -> Rung {
    let rung = match target.model {
        Model::Iec => iec_rung(list, target, declared),
        _ => from_fx::rung(list, &fx::parse(list, target)),
    };
    let start = comment.start as usize + start;
    let path = rung.path.map(|path| path.map(|path| path.shifted(start)));
    // Its own comments are part of the box.
    Rung { comments, span: rung.span.shifted(start), path, ..rung }
}

/// The rung that a list of IEC 61131-3 is as a whole.
fn iec_rung(list: &str, target: &Target, declared: Declared<'_>) -> Rung {
    let mut rungs = from_iec::rungs(list, &iec::parse(list, target), declared, &Elsewhere::default());
    match rungs.pop() {
        Some(rung) if rungs.is_empty() => rung,
        _ => Rung {
            labels: Vec::new(),
            network: None,
            comments: Vec::new(),
            span: Span::new(0, list.len()),
            is_list: true,
            path: Err(Refusal::NotBoolean),
        },
    }
}

fn path(text: &str, tree: &LadderTree, rung: &ladder::Rung, scopes: &Scopes) -> Result<Path, Refusal> {
    if tree.problems.iter().any(|problem| is_grave(problem, rung.span)) {
        return Err(Refusal::Unreadable);
    }
    of_graph(text, &rung.graph, scopes)
}

/// The path of a drawn rung whose words stand in `text`. Of `scopes` it knows the function blocks and functions; where
/// its variables lie, [`Path::located`] tells.
pub fn of_graph(text: &str, graph: &Graph, scopes: &Scopes) -> Result<Path, Refusal> {
    let shape = reduce(graph).map_err(|reason| match reason {
        NotSeriesParallel::OpenCircuit(_) | NotSeriesParallel::Empty => Refusal::OpenCircuit,
        NotSeriesParallel::Bridge(_) | NotSeriesParallel::SharedPin(_) => Refusal::Bridge,
        NotSeriesParallel::TooDeep => Refusal::TooDeep,
    })?;
    let mut reader = Reader { text, graph, scopes, builder: Builder::new() };
    reader.shape(&shape, true)?;
    reader.builder.finish().ok_or(Refusal::WithoutOutput)
}

/// Whether the rung may not say what its author meant.
fn is_grave(problem: &Diagnostic, rung: Span) -> bool {
    let is_inside = problem.span.start < rung.end && rung.start <= problem.span.end;
    let is_mild = matches!(problem.code, "ragged-rail" | "ragged-drawing" | "tab-in-drawing")
        && problem.message.key() != ladder::TWO_READINGS;
    is_inside && !is_mild
}

struct Reader<'a> {
    text: &'a str,
    graph: &'a Graph,
    scopes: &'a Scopes,
    builder: Builder,
}

impl Reader<'_> {
    /// Goes through `shape`; behind the last one of the rung nothing follows but the right rail.
    fn shape(&mut self, shape: &Shape, is_last: bool) -> Result<(), Refusal> {
        let is_at_rail = self.builder.is_at_rail();
        if self.is_invert(shape) && !is_at_rail {
            return self.builder.invert().ok_or(Refusal::TooDeep);
        }
        if !self.acts(shape) {
            let condition = self.condition(shape, is_at_rail)?;
            return self.builder.pass(condition).ok_or(Refusal::TooDeep);
        }
        match shape {
            Shape::Series(parts) => {
                for (number, part) in parts.iter().enumerate() {
                    self.shape(part, is_last && number + 1 == parts.len())?;
                }
                Ok(())
            }
            Shape::Parallel(_) if !is_last => Err(Refusal::BehindOutput),
            Shape::Parallel(branches) => {
                let place = self.builder.place();
                self.builder.keep();
                for (number, branch) in branches.iter().enumerate() {
                    self.shape(branch, true)?;
                    let is_end = number + 1 == branches.len();
                    self.builder.back_to(place, is_end).ok_or(Refusal::WithoutOutput)?;
                }
                Ok(())
            }
            Shape::Element(id) => self.element(self.graph.element(*id), is_last),
            Shape::Block(_) => Err(Refusal::Element),
            Shape::Wire => Err(Refusal::ShortCircuit),
        }
    }

    /// Whether it does anything beyond letting power pass or not.
    fn acts(&self, shape: &Shape) -> bool {
        match shape {
            Shape::Series(parts) | Shape::Parallel(parts) => parts.iter().any(|part| self.acts(part)),
            Shape::Element(id) => !self.is_invert(shape) && !self.graph.element(*id).is_contact(),
            Shape::Block(_) => true,
            Shape::Wire => false,
        }
    }

    fn is_invert(&self, shape: &Shape) -> bool {
        matches!(shape, Shape::Element(id) if self.graph.element(*id).kind == ElementKind::Invert)
    }

    /// What must hold for power to pass `shape`, which begins at the left rail or behind something. An inverter in it
    /// inverts what stands before it in its own branch, as INV does with the block that it belongs to; at the left rail
    /// that is the power of the rail itself, and none is behind it.
    fn condition(&self, shape: &Shape, is_at_rail: bool) -> Result<Expression, Refusal> {
        match shape {
            Shape::Series(parts) => {
                let mut series = Expression::Constant(true);
                for (number, part) in parts.iter().enumerate() {
                    match self.is_invert(part) {
                        true if number > 0 => series = Expression::Not(Box::new(series)),
                        _ => series.and_with(self.condition(part, is_at_rail && number == 0)?),
                    }
                }
                Ok(series)
            }
            Shape::Parallel(parts) => {
                let branch = |part| self.condition(part, is_at_rail);
                parts.iter().map(branch).collect::<Result<Vec<_>, _>>().map(Expression::or)
            }
            Shape::Element(_) if self.is_invert(shape) => match is_at_rail {
                true => Ok(Expression::Constant(false)),
                false => Err(Refusal::NoCurrentResult),
            },
            Shape::Element(id) => contact(self.text, self.graph.element(*id)).map(Expression::Contact),
            Shape::Block(_) => Err(Refusal::Element),
            Shape::Wire => Err(Refusal::ShortCircuit),
        }
    }

    fn element(&mut self, element: &Element, is_last: bool) -> Result<(), Refusal> {
        if let ElementKind::Block(block) = &element.kind {
            let (action, goes_on) = block::call(self.text, element, block, self.scopes)?;
            match goes_on && !is_last {
                true => return self.builder.gate(Gate::Through(action)).ok_or(Refusal::TooDeep),
                false => self.builder.drive(action),
            }
            return Ok(());
        }
        let action = action(self.text, element)?;
        match element.is_output() {
            true => self.builder.drive(action),
            false => self.builder.gate(Gate::Through(action)).ok_or(Refusal::TooDeep)?,
        }
        Ok(())
    }
}

/// The contact or comparison that an element is.
pub(super) fn contact(text: &str, element: &Element) -> Result<Contact, Refusal> {
    let test = match &element.kind {
        ElementKind::Contact(kind) => Test::Bit(*kind),
        ElementKind::Compare(operator) => Test::Compare(*operator),
        _ => return Err(Refusal::Element),
    };
    Ok(Contact { test, terms: terms(text, element), span: element.span })
}

/// What an element does that is no contact.
pub(super) fn action(text: &str, element: &Element) -> Result<Action, Refusal> {
    let deed = match &element.kind {
        ElementKind::Coil(kind) => Deed::of_coil(*kind),
        ElementKind::Instruction { form: Some(form), .. } => Deed::of_form(*form),
        ElementKind::Instruction { form: None, .. } => return Err(Refusal::Unreadable),
        ElementKind::Jump(_) => Deed::Jump,
        ElementKind::Return => Deed::Return,
        _ => return Err(Refusal::Element),
    };
    let mut action = Action { deed, terms: terms(text, element), span: element.span };
    if let ElementKind::Jump(label) = &element.kind {
        action.terms.push(Term::new(Operand::Variable, label.of(text), *label));
    }
    Ok(action)
}

fn terms(text: &str, element: &Element) -> Vec<Term> {
    let operands = element.operands.iter().enumerate();
    let term = |(index, operand): (usize, &Spanned<Operand>)| {
        Term::new(operand.value, &element.operand_text(index, text), operand.span)
    };
    operands.map(term).collect()
}
