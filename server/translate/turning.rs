//! Where a condition on its way is inverted, with the fewest instructions.
//!
//! A list runs through a condition from left to right: a first part is loaded, and each further one joined with what
//! there is so far. What there is may as well be the inverse of what is meant, which an INV at any place turns over: it
//! is then joined by the dual connection with the inverse of the part, and the inverse of a contact costs nothing, but
//! for edges, which have none. The fewest instructions are found part by part, for both senses of what there is so far.

use super::stack::NEVER;
use crate::logic::{Contact, Expression, Gate};
use std::borrow::Cow;

/// Whether something is the inverse of what is meant: the index of costs for both senses.
pub(super) type Sense = usize;

/// A condition as a list runs through it, in the order in which it is drawn.
#[derive(Default)]
pub(super) struct Chain<'e> {
    links: Vec<Link<'e>>,
    /// The condition is the inverse of what the links are.
    is_inverse: bool,
}

struct Link<'e> {
    /// In series with the links before it; else in parallel.
    in_series: bool,
    part: Part<'e>,
}

enum Part<'e> {
    /// A contact, or its opposite.
    Contact {
        contact: Cow<'e, Contact>,
        is_inverse: bool,
    },
    Block(Turns<'e>),
}

/// A chain with the fewest instructions for it, in both senses.
pub(super) struct Turns<'e> {
    chain: Chain<'e>,
    /// The cheapest way to each state behind each link.
    table: Vec<[Behind; STATES]>,
    /// What connections and inverters cost in all.
    pub costs: [usize; 2],
}

/// What is done with a chain, in order.
pub(super) trait Writes {
    /// What can go wrong.
    type Error;
    /// A contact, or its opposite, is loaded; or joined in series, or in parallel.
    fn contact(&mut self, contact: &Contact, is_opposite: bool, joins: Joins) -> Result<(), Self::Error>;
    /// The two blocks on top are joined in series, or in parallel.
    fn join(&mut self, in_series: bool) -> Result<(), Self::Error>;
    /// What there is becomes its inverse.
    fn invert(&mut self) -> Result<(), Self::Error>;
}

/// How a contact comes to what there is.
#[derive(Clone, Copy)]
pub(super) enum Joins {
    Loaded,
    InSeries,
    InParallel,
}

/// The state behind a link: the sense of what there is so far and, if a block of parts with one connection is still
/// open, the sense of that block.
#[derive(Clone, Copy, PartialEq, Eq)]
struct State {
    so_far: Sense,
    block: Option<Sense>,
}

const STATES: usize = 6;
const ALL: [State; STATES] = [
    State { so_far: 0, block: None },
    State { so_far: 1, block: None },
    State { so_far: 0, block: Some(0) },
    State { so_far: 0, block: Some(1) },
    State { so_far: 1, block: Some(0) },
    State { so_far: 1, block: Some(1) },
];

/// The cheapest way to a state behind a link.
#[derive(Clone, Copy)]
struct Behind {
    cost: usize,
    /// The state behind the link before it, and the one right behind the part of this link.
    from: usize,
    entered: usize,
}

impl<'e> Chain<'e> {
    /// What `gates` ask, all of which are conditions and inverters. What is there before them, if anything, is the
    /// first link of all, and is not among the links.
    pub(super) fn of(gates: &'e [Gate], is_first: bool) -> Chain<'e> {
        let mut chain = Chain::default();
        for gate in gates {
            match gate {
                Gate::Pass(expression) if is_first && chain.links.is_empty() => {
                    chain.begin(expression, chain.is_inverse);
                }
                Gate::Pass(expression) => chain.join(expression, !chain.is_inverse, chain.is_inverse),
                Gate::Invert => chain.is_inverse = !chain.is_inverse,
                Gate::Through(_) => {}
            }
        }
        chain
    }

    /// The links of `expression`, or of its inverse: those of its first part come first.
    fn begin(&mut self, expression: &'e Expression, is_inverse: bool) {
        match expression {
            Expression::Not(part) => self.begin(part, !is_inverse),
            Expression::And(parts) | Expression::Or(parts) => {
                let in_series = matches!(expression, Expression::And(_)) != is_inverse;
                for (number, part) in parts.iter().enumerate() {
                    match number {
                        0 => self.begin(part, is_inverse),
                        _ => self.join(part, in_series, is_inverse),
                    }
                }
            }
            leaf => {
                self.links.extend(Part::of_leaf(leaf, is_inverse).map(|part| Link { in_series: true, part }))
            }
        }
    }

    /// Joins `expression`, or its inverse, with the links so far.
    fn join(&mut self, expression: &'e Expression, in_series: bool, is_inverse: bool) {
        match expression {
            Expression::Not(part) => self.join(part, in_series, !is_inverse),
            Expression::And(parts) | Expression::Or(parts) => {
                let is_series = matches!(expression, Expression::And(_)) != is_inverse;
                if is_series == in_series {
                    return parts.iter().for_each(|part| self.join(part, in_series, is_inverse));
                }
                let mut block = Chain::default();
                block.begin(expression, is_inverse);
                self.links.push(Link { in_series, part: Part::Block(Turns::of(block, None)) });
            }
            leaf => self.links.extend(Part::of_leaf(leaf, is_inverse).map(|part| Link { in_series, part })),
        }
    }
}

impl<'e> Part<'e> {
    fn of_leaf(leaf: &'e Expression, is_inverse: bool) -> Option<Part<'e>> {
        let contact = match leaf {
            Expression::Contact(contact) => Cow::Borrowed(contact),
            Expression::Constant(value) => Cow::Owned(super::to_fx::always(*value)),
            _ => return None,
        };
        Some(Part::Contact { contact, is_inverse })
    }

    /// Whether one instruction asks for the part in this sense.
    fn is_direct(&self, sense: Sense) -> bool {
        match self {
            Part::Contact { contact, is_inverse } => {
                *is_inverse == (sense == 1) || contact.test.opposite().is_some()
            }
            Part::Block(_) => false,
        }
    }

    /// What it costs, but for the contacts, to load the part in this sense.
    fn load(&self, sense: Sense) -> usize {
        match self {
            Part::Contact { .. } => usize::from(!self.is_direct(sense)),
            Part::Block(turns) => turns.costs[sense],
        }
    }

    /// What it costs to join it with what there is.
    fn join(&self, sense: Sense) -> usize {
        if self.is_direct(sense) { 0 } else { self.load(sense) + 1 }
    }
}

impl<'e> Turns<'e> {
    /// The fewest instructions for `chain`; behind what is there already, if anything, which costs so much in each
    /// sense.
    pub(super) fn of(chain: Chain<'e>, before: Option<[usize; 2]>) -> Turns<'e> {
        let mut costs = [NEVER; STATES];
        if let Some(before) = before {
            costs[..2].copy_from_slice(&[0, 1].map(|sense| before[sense].min(before[1 - sense] + 1)));
        }
        let mut table = Vec::with_capacity(chain.links.len());
        let mut last = None;
        for link in &chain.links {
            let is_loaded = before.is_none() && last.is_none();
            let goes_on = last == Some(link.in_series);
            // Contacts in parallel begin at the left rail: nothing is in parallel with what was driven or kept already.
            let may_join = |so_far: Sense| before.is_none() || link.in_series != (so_far == 1);
            let (mut entered, mut origins) = ([NEVER; STATES], [0; STATES]);
            for (to, state) in ALL.iter().enumerate() {
                let mut enter = |from: usize, cost: usize| {
                    if cost < entered[to] {
                        (entered[to], origins[to]) = (cost, from);
                    }
                };
                match state.block {
                    None if is_loaded => enter(to, link.part.load(state.so_far)),
                    Some(_) if is_loaded => {}
                    None if may_join(state.so_far) => enter(to, costs[to] + link.part.join(state.so_far)),
                    Some(_) if !may_join(state.so_far) => {}
                    None => {}
                    Some(block) => {
                        if goes_on {
                            enter(to, costs[to] + link.part.join(block));
                        }
                        enter(state.so_far, costs[state.so_far] + link.part.load(block));
                    }
                }
            }
            let row: [Behind; STATES] = std::array::from_fn(|to| {
                let mut best = Behind { cost: NEVER, from: 0, entered: to };
                // Where there is a choice, nothing is inverted that need not be.
                let others = (0..STATES).filter(|other| *other != to);
                for raw in std::iter::once(to).chain(others) {
                    let cost = entered[raw] + settling(ALL[raw], ALL[to]).map_or(NEVER, |way| way.len());
                    if cost < best.cost {
                        best = Behind { cost, from: origins[raw], entered: raw };
                    }
                }
                best
            });
            costs = row.map(|behind| behind.cost);
            table.push(row);
            last = Some(link.in_series);
        }
        let inverse = usize::from(chain.is_inverse);
        Turns { chain, table, costs: [costs[inverse], costs[1 - inverse]] }
    }

    /// Writes the chain so that it ends in this sense, behind what is there in the sense `before`, if anything.
    pub(super) fn write<W: Writes>(
        &self,
        sense: Sense,
        before: Option<Sense>,
        writer: &mut W,
    ) -> Result<(), W::Error> {
        let mut state = sense ^ usize::from(self.chain.is_inverse);
        let mut ways = Vec::with_capacity(self.table.len());
        for row in self.table.iter().rev() {
            ways.push((row[state].from, row[state].entered, state));
            state = row[state].from;
        }
        if before.is_some_and(|before| before != state) {
            writer.invert()?;
        }
        let mut is_loaded = before.is_none();
        for (link, (from, entered, settled)) in self.chain.links.iter().zip(ways.into_iter().rev()) {
            let State { so_far, block } = ALL[entered];
            let sense = block.unwrap_or(so_far);
            let opens = block.is_some() && ALL[from].block.is_none();
            if is_loaded || opens {
                link.part.write_loaded(sense, writer)?;
            } else {
                link.part.write_joined(sense, link.in_series != (sense == 1), writer)?;
            }
            is_loaded = false;
            for settles in settling(ALL[entered], ALL[settled]).into_iter().flatten() {
                match settles {
                    Settles::Inverts => writer.invert()?,
                    Settles::Joins => writer.join(link.in_series != (so_far == 1))?,
                }
            }
        }
        Ok(())
    }
}

impl Part<'_> {
    fn write_loaded<W: Writes>(&self, sense: Sense, writer: &mut W) -> Result<(), W::Error> {
        match self {
            Part::Contact { contact, is_inverse } => {
                let is_opposite = *is_inverse != (sense == 1);
                if self.is_direct(sense) {
                    return writer.contact(contact, is_opposite, Joins::Loaded);
                }
                writer.contact(contact, false, Joins::Loaded)?;
                writer.invert()
            }
            Part::Block(turns) => turns.write(sense, None, writer),
        }
    }

    fn write_joined<W: Writes>(&self, sense: Sense, in_series: bool, writer: &mut W) -> Result<(), W::Error> {
        if let (Part::Contact { contact, is_inverse }, true) = (self, self.is_direct(sense)) {
            let joins = if in_series { Joins::InSeries } else { Joins::InParallel };
            return writer.contact(contact, *is_inverse != (sense == 1), joins);
        }
        self.write_loaded(sense, writer)?;
        writer.join(in_series)
    }
}

/// What is done behind a part.
#[derive(Clone, Copy)]
enum Settles {
    Inverts,
    /// The open block is joined with what was there before it.
    Joins,
}

/// What leads from one state to another behind the same link, if anything does.
fn settling(from: State, to: State) -> Option<&'static [Settles]> {
    use Settles::{Inverts, Joins};
    Some(match (from.block, to.block) {
        _ if from == to => &[],
        (None, None) => &[Inverts],
        (Some(_), Some(_)) if from.so_far == to.so_far => &[Inverts],
        (Some(block), None) => match (block == from.so_far, from.so_far == to.so_far) {
            (true, true) => &[Joins],
            (true, false) => &[Joins, Inverts],
            (false, true) => &[Inverts, Joins],
            (false, false) => &[Inverts, Joins, Inverts],
        },
        _ => return None,
    })
}
