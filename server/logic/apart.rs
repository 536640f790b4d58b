//! A mixed connection drawn apart: the equal path of series and parallel connections, with few contacts, proved.

use super::decide::{Verdict, equal};
use super::from_ladder::{action, contact};
use super::{Contact, Drive, Expression, Formula, Formulas, Gate, Path, Run};
use crate::ladder::{ElementId, Graph, VertexId, VertexKind};
use rustc_hash::FxHashMap;

/// More ways through a rung are not drawn: nobody could read it.
const WAYS_MAX: usize = 64;
/// Vertices that are looked at in all.
const STEPS_MAX: usize = 20_000;

/// The path that does what the rung of `graph` does, whose words stand in `text`, however its wires are connected.
///
/// Each output gets all ways from the left rail to it, of which those that others cover are left out and common
/// contacts are drawn once; outputs that the same ways reach share them. Nothing if there are very many ways, if
/// anything but contacts, comparisons and outputs is on one, if an output changes what a later one is driven by, or if
/// the result cannot be proved.
pub fn apart(text: &str, graph: &Graph) -> Option<Path> {
    let mut outputs: Vec<(VertexId, ElementId)> = Vec::new();
    for id in graph.vertex_ids() {
        match graph.vertex(id).kind {
            VertexKind::Element(element) if graph.element(element).is_output() => outputs.push((id, element)),
            VertexKind::Element(element) if !graph.element(element).is_contact() => return None,
            VertexKind::LooseEnd => return None,
            _ => {}
        }
    }
    outputs.sort_by_key(|(_, id)| (graph.element(*id).row, graph.element(*id).columns));
    let mut finder = Finder { graph, text, steps: 0, contacts: FxHashMap::default() };
    let mut paths: Vec<Path> = Vec::new();
    for (vertex, element) in &outputs {
        let ways = finder.ways_to(*vertex)?;
        let condition = factored(uncovered(finder.literals(ways)?));
        let drive = Drive::Action(action(text, graph.element(*element)).ok()?);
        match paths.last_mut() {
            Some(last) if matches!(&last.gates[..], [Gate::Pass(own)] if *own == condition) => {
                last.drives.push(drive);
            }
            _ => paths.push(Path { gates: vec![Gate::Pass(condition)], drives: vec![drive] }),
        }
    }
    let path = match paths.len() {
        0 => return None,
        1 => paths.remove(0),
        _ => Path { gates: Vec::new(), drives: paths.into_iter().map(Drive::Path).collect() },
    };
    is_proved(text, graph, &outputs, &path).then_some(path)
}

/// Whether each output is driven under the condition under which power reaches it along the wires, sampled before the
/// first output.
fn is_proved(text: &str, graph: &Graph, outputs: &[(VertexId, ElementId)], path: &Path) -> bool {
    let mut formulas = Formulas::default();
    let mut start = Run::new();
    let mut powers: FxHashMap<VertexId, Formula> = FxHashMap::default();
    let mut run = Run::new();
    run.path(path, &mut formulas);
    run.effects.len() == outputs.len()
        && outputs.iter().zip(&run.effects).all(|((vertex, _), effect)| {
            let power = power_before(*vertex, text, graph, &mut start, &mut powers, &mut formulas);
            power.is_some_and(|power| equal(&mut formulas, power, effect.guard) == Verdict::Equal)
        })
}

/// Whether power reaches a vertex, found along the wires without counting ways.
fn power_before(
    at: VertexId,
    text: &str,
    graph: &Graph,
    start: &mut Run<'_>,
    powers: &mut FxHashMap<VertexId, Formula>,
    formulas: &mut Formulas,
) -> Option<Formula> {
    // Tails before heads, without recursion.
    let mut waiting = vec![(at, false)];
    while let Some((vertex, is_open)) = waiting.pop() {
        if powers.contains_key(&vertex) {
            continue;
        }
        let tails: Vec<VertexId> = graph.incoming(vertex).map(|arc| graph.arc(arc).tail).collect();
        if !is_open {
            if waiting.len() > STEPS_MAX {
                return None;
            }
            waiting.push((vertex, true));
            waiting.extend(tails.iter().map(|tail| (*tail, false)));
            continue;
        }
        let mut ways = Vec::with_capacity(tails.len());
        for tail in tails {
            let reached = powers.get(&tail).copied()?;
            ways.push(match graph.vertex(tail).kind {
                VertexKind::Element(id) if graph.element(id).is_contact() => {
                    let contact = contact(text, graph.element(id)).ok()?;
                    let own = start.contact(&contact, formulas);
                    formulas.and([reached, own])
                }
                _ => reached,
            });
        }
        let power = match graph.vertex(vertex).kind {
            VertexKind::LeftRail => Formulas::TRUE,
            _ => formulas.or(ways),
        };
        powers.insert(vertex, power);
    }
    powers.get(&at).copied()
}

/// A contact with a name of its own: contacts that ask the same have the same.
#[derive(Clone, Debug)]
struct Literal {
    name: String,
    contact: Contact,
}

struct Finder<'a> {
    graph: &'a Graph,
    text: &'a str,
    steps: usize,
    contacts: FxHashMap<ElementId, Literal>,
}

impl Finder<'_> {
    /// The contacts on each way from the left rail to `vertex`, left to right.
    fn ways_to(&mut self, vertex: VertexId) -> Option<Vec<Vec<ElementId>>> {
        let mut ways = Vec::new();
        let mut waiting = vec![(vertex, Vec::new())];
        while let Some((at, behind)) = waiting.pop() {
            self.steps += 1;
            if self.steps > STEPS_MAX || ways.len() > WAYS_MAX {
                return None;
            }
            if self.graph.vertex(at).kind == VertexKind::LeftRail {
                ways.push(behind.into_iter().rev().collect());
                continue;
            }
            for arc in self.graph.incoming(at) {
                let tail = self.graph.arc(arc).tail;
                let mut behind = behind.clone();
                if let VertexKind::Element(id) = self.graph.vertex(tail).kind
                    && self.graph.element(id).is_contact()
                {
                    behind.push(id);
                }
                waiting.push((tail, behind));
            }
        }
        // The stack turned them upside down.
        ways.reverse();
        Some(ways)
    }

    fn literals(&mut self, ways: Vec<Vec<ElementId>>) -> Option<Vec<Vec<Literal>>> {
        ways.into_iter().map(|way| way.into_iter().map(|id| self.literal(id)).collect()).collect()
    }

    fn literal(&mut self, id: ElementId) -> Option<Literal> {
        if let Some(known) = self.contacts.get(&id) {
            return Some(known.clone());
        }
        let element = self.graph.element(id);
        let contact = contact(self.text, element).ok()?;
        let words: Vec<String> = contact.terms.iter().map(|term| term.key().to_string()).collect();
        let literal = Literal { name: format!("{:?} {}", contact.test, words.join(" ")), contact };
        self.contacts.insert(id, literal.clone());
        Some(literal)
    }
}

/// The ways without contacts that were passed before, and without ways that have all contacts of another one.
fn uncovered(ways: Vec<Vec<Literal>>) -> Vec<Vec<Literal>> {
    let mut short: Vec<Vec<Literal>> = Vec::new();
    for way in ways {
        let mut once: Vec<Literal> = Vec::with_capacity(way.len());
        for literal in way {
            if !once.iter().any(|other| other.name == literal.name) {
                once.push(literal);
            }
        }
        short.push(once);
    }
    let has = |way: &[Literal], name: &str| way.iter().any(|literal| literal.name == name);
    let covers = |one: usize, other: usize| {
        let (covering, covered) = (&short[one], &short[other]);
        covering.iter().all(|literal| has(covered, &literal.name))
            && (covering.len() < covered.len() || one < other)
    };
    let numbers = 0..short.len();
    let kept =
        numbers.clone().filter(|other| !numbers.clone().any(|one| one != *other && covers(one, *other)));
    kept.map(|number| short[number].clone()).collect()
}

/// Ways in parallel, with contacts that several have drawn once: first those at the ends of all, then the contact that
/// most ways have in common.
fn factored(mut ways: Vec<Vec<Literal>>) -> Expression {
    if ways.iter().any(Vec::is_empty) {
        return Expression::Constant(true);
    }
    if let [way] = &ways[..] {
        return Expression::and(way.iter().map(|literal| Expression::Contact(literal.contact.clone())));
    }
    let count = |name: &str| ways.iter().filter(|way| way.iter().any(|literal| literal.name == name)).count();
    let all = ways.iter().flatten();
    // Of equals the one that is drawn first.
    let common = all.rev().max_by_key(|literal| count(&literal.name)).cloned();
    let Some(common) = common.filter(|literal| count(&literal.name) > 1) else {
        return Expression::or(ways.into_iter().map(|way| factored(vec![way])));
    };
    let is_common = |literal: &Literal| literal.name == common.name;
    // A contact at the end of its ways is drawn behind them, so that the drawing stays like the old one.
    let stands_last = ways.iter().filter(|way| way.last().is_some_and(is_common)).count()
        > ways.iter().filter(|way| way.first().is_some_and(is_common)).count();
    let first_place = ways.iter().position(|way| way.iter().any(is_common)).unwrap_or(0);
    let mut with = Vec::new();
    let mut without = Vec::new();
    for way in ways.drain(..) {
        match way.iter().any(is_common) {
            true => with.push(way.into_iter().filter(|literal| !is_common(literal)).collect()),
            false => without.push(way),
        }
    }
    let contact = Expression::Contact(common.contact);
    let rest = factored(uncovered(with));
    let product =
        if stands_last { Expression::and([rest, contact]) } else { Expression::and([contact, rest]) };
    match (without.is_empty(), first_place) {
        (true, _) => product,
        (false, 0) => Expression::or([product, factored(without)]),
        (false, _) => Expression::or([factored(without), product]),
    }
}
