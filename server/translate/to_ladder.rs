//! Draws a path of power: its shape with elements, for the printer of drawings.

mod block;

use crate::ladder::reduce::Shape;
use crate::ladder::{ContactKind, Element, ElementId, ElementKind, Graph};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test};
use crate::target::{Model, Operand};
use crate::text::{Message, Span, Spanned};

/// What is to be drawn of a rung: a shape of elements whose words stand in a text of its own.
#[derive(Debug)]
pub struct Plan {
    /// How the elements are connected.
    pub shape: Shape,
    /// The elements; the wires are in the shape.
    pub graph: Graph,
    /// The words of the elements.
    pub source: String,
}

/// The drawing of `path`, or why there is none.
pub fn plan(path: &Path, model: Model) -> Result<Plan, Message> {
    let mut planner = Planner { graph: Graph::new(), source: String::new(), model };
    let parts = planner.path(path, true)?;
    let Planner { graph, source, .. } = planner;
    Ok(Plan { shape: series(parts), graph, source })
}

/// Parts from left to right.
type Parts = Vec<Shape>;

struct Planner {
    graph: Graph,
    source: String,
    model: Model,
}

impl Planner {
    /// `is_first` if the path begins at the left rail.
    fn path(&mut self, path: &Path, is_first: bool) -> Result<Parts, Message> {
        let mut parts = Vec::new();
        for gate in &path.gates {
            match gate {
                Gate::Pass(expression) => {
                    let starts = is_first && parts.is_empty();
                    parts.extend(self.condition(expression, starts)?);
                }
                Gate::Invert => parts.push(self.invert()),
                Gate::Through(action) => parts.push(self.action(action, true)?),
            }
        }
        let mut branches = Vec::with_capacity(path.drives.len());
        for drive in &path.drives {
            branches.push(match drive {
                Drive::Action(action) => vec![self.action(action, false)?],
                Drive::Path(path) => self.path(path, is_first && parts.is_empty())?,
            });
        }
        match branches.len() {
            1 => parts.extend(branches.remove(0)),
            _ => parts.push(parallel(branches)),
        }
        Ok(parts)
    }

    /// An expression in a row. An inverter inverts the whole row before it, so there can be one only where the row
    /// starts; elsewhere the negation goes into the contacts.
    fn condition(&mut self, expression: &Expression, starts: bool) -> Result<Parts, Message> {
        match expression {
            Expression::Contact(contact) => Ok(vec![self.contact(contact)]),
            Expression::Constant(value) => {
                let mut contact = super::to_fx::always(*value);
                if self.model == Model::Iec {
                    let word = if *value { "TRUE" } else { "FALSE" };
                    let operand = Operand::read(word, Model::Iec);
                    contact.test = Test::Bit(ContactKind::NormallyOpen);
                    contact.terms = vec![Term::new(operand, word, Span::default())];
                }
                Ok(vec![self.contact(&contact)])
            }
            Expression::Or(branches) => {
                let branches: Result<Vec<Parts>, _> =
                    branches.iter().map(|branch| self.condition(branch, true)).collect();
                Ok(vec![parallel(branches?)])
            }
            Expression::And(parts) => {
                let is_inverted = |part: &Expression| match part {
                    Expression::Not(part) => matches!(part.negated(), Expression::Not(_)),
                    _ => false,
                };
                let first = parts.iter().position(is_inverted).filter(|_| starts).unwrap_or(0);
                let mut row = self.condition(&parts[first], starts)?;
                for part in parts[..first].iter().chain(&parts[first + 1..]) {
                    row.extend(self.condition(part, false)?);
                }
                Ok(row)
            }
            Expression::Not(part) if starts => {
                let mut row = self.condition(part, true)?;
                row.push(self.invert());
                Ok(row)
            }
            Expression::Not(part) => match part.negated() {
                Expression::Not(_) => Err(Message::new("translate.inverted-edge")),
                negated => self.condition(&negated, false),
            },
        }
    }

    fn contact(&mut self, contact: &Contact) -> Shape {
        let kind = match contact.test {
            Test::Bit(kind) => ElementKind::Contact(kind),
            Test::Compare(operator) => ElementKind::Compare(operator),
        };
        self.element(kind, &contact.terms)
    }

    fn invert(&mut self) -> Shape {
        self.element(ElementKind::Invert, &[])
    }

    /// `goes_on` if there is more behind it on its line.
    fn action(&mut self, action: &Action, goes_on: bool) -> Result<Shape, Message> {
        let kind = match &action.deed {
            Deed::Coil(kind) => ElementKind::Coil(*kind),
            Deed::Instruction(form) => {
                let mnemonic = self.word(&form.mnemonic());
                ElementKind::Instruction { form: Some(*form), mnemonic }
            }
            Deed::Call(call) => return self.block(action, call, goes_on),
            Deed::Compute(computation) => return self.computation(action, computation),
            Deed::Jump => {
                let label = action.terms.first().ok_or_else(|| Message::new("translate.no-instruction"))?;
                let label = self.word(&label.text);
                return Ok(self.element(ElementKind::Jump(label), &[]));
            }
            Deed::Return => ElementKind::Return,
        };
        Ok(self.element(kind, &action.terms))
    }

    fn element(&mut self, kind: ElementKind, terms: &[Term]) -> Shape {
        let mut element = Element::new(kind, Span::default(), 0, (0, 0));
        for term in terms {
            let span = self.word(&term.text);
            element.operands.push(Spanned::new(term.operand, span));
        }
        self.add(element)
    }

    fn add(&mut self, element: Element) -> Shape {
        self.graph.elements.push(element);
        Shape::Element(ElementId(self.graph.elements.len() as u32 - 1))
    }

    fn word(&mut self, word: &str) -> Span {
        let start = self.source.len();
        self.source.push_str(word);
        self.source.push(' ');
        Span::new(start, start + word.len())
    }
}

fn series(mut parts: Parts) -> Shape {
    if parts.len() == 1 { parts.remove(0) } else { Shape::Series(parts) }
}

/// Branches, of which those that are parallel again are branches of the whole.
fn parallel(branches: Vec<Parts>) -> Shape {
    let mut flat = Vec::with_capacity(branches.len());
    for branch in branches {
        match series(branch) {
            Shape::Parallel(inner) => flat.extend(inner),
            shape => flat.push(shape),
        }
    }
    Shape::Parallel(flat)
}
