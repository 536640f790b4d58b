//! The fewest conditions that decide: contacts that alone, whatever the others do, let power through or keep it off.

/// A condition over literals, which are named by their numbers.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Condition {
    /// A wire, or no connection at all.
    Constant(bool),
    /// A contact.
    Literal(usize),
    /// The part inverted.
    Not(Box<Condition>),
    /// Parts in series.
    And(Vec<Condition>),
    /// Branches.
    Or(Vec<Condition>),
}

/// Up to so many literals that stand in more than one place, all sets of them are tried.
const MOST_TRIED: usize = 10;

impl Condition {
    /// Whether it holds where the literals have these values.
    pub fn holds(&self, values: &[bool]) -> bool {
        match self {
            Condition::Constant(value) => *value,
            Condition::Literal(number) => values.get(*number).copied().unwrap_or(false),
            Condition::Not(part) => !part.holds(values),
            Condition::And(parts) => parts.iter().all(|part| part.holds(values)),
            Condition::Or(parts) => parts.iter().any(|part| part.holds(values)),
        }
    }

    /// The fewest literals that decide whether it holds, in increasing order: while these have their `values` it is as
    /// it is, whatever values the others have. Among as few the cheapest, then the first. `costs` are of the literals;
    /// each counts 1 besides.
    ///
    /// The fewest where every literal stands in one place, or where there are at most ten; else a set of which none
    /// can be left out as far as that is seen without trying all values.
    pub fn decisive(&self, values: &[bool], costs: &[u32]) -> Vec<usize> {
        let mut count = vec![0_usize; values.len()];
        self.count(&mut count);
        let used: Vec<usize> = (0..values.len()).filter(|number| count[*number] > 0).collect();
        let cost = |number: usize| u64::from(costs.get(number).copied().unwrap_or(0)) + DEAR;
        let holds = self.holds(values);
        if count.iter().any(|count| *count > 1) && used.len() <= MOST_TRIED {
            return self.tried(&used, values, holds, &cost);
        }
        let mut found = self.path(values, holds, &cost).1;
        found.sort_unstable();
        found.dedup();
        // What stands in several places may be needed in none of them.
        for number in found.clone().into_iter().rev() {
            let without: Vec<usize> = found.iter().copied().filter(|other| *other != number).collect();
            if self.forced(values, &without) == Some(holds) {
                found = without;
            }
        }
        found
    }

    fn count(&self, count: &mut [usize]) {
        match self {
            Condition::Constant(_) => {}
            Condition::Literal(number) => {
                if let Some(count) = count.get_mut(*number) {
                    *count += 1;
                }
            }
            Condition::Not(part) => part.count(count),
            Condition::And(parts) | Condition::Or(parts) => parts.iter().for_each(|part| part.count(count)),
        }
    }

    /// The cheapest literals that make it hold, or not, as it does: the whole of a series that conducts and one branch
    /// of a parallel connection, and the other way round where no power comes through.
    fn path(&self, values: &[bool], holds: bool, cost: &impl Fn(usize) -> u64) -> (u64, Vec<usize>) {
        let (parts, is_all) = match self {
            Condition::Constant(_) => return (0, Vec::new()),
            Condition::Literal(number) => return (cost(*number), vec![*number]),
            Condition::Not(part) => return part.path(values, !holds, cost),
            Condition::And(parts) => (parts, holds),
            Condition::Or(parts) => (parts, !holds),
        };
        let deciding = parts.iter().filter(|part| part.holds(values) == holds);
        let paths = deciding.map(|part| part.path(values, holds, cost));
        match is_all {
            true => paths.fold((0, Vec::new()), |(sum, mut all), (cost, path)| {
                all.extend(path);
                (sum + cost, all)
            }),
            false => paths.min_by_key(|(cost, _)| *cost).unwrap_or_default(),
        }
    }

    /// Whether it holds, or not, by the literals of `known` alone; nothing if that is not seen.
    fn forced(&self, values: &[bool], known: &[usize]) -> Option<bool> {
        let all = |parts: &[Condition], absorbing: bool| {
            let mut result = Some(!absorbing);
            for part in parts {
                match part.forced(values, known) {
                    Some(value) if value == absorbing => return Some(absorbing),
                    Some(_) => {}
                    None => result = None,
                }
            }
            result
        };
        match self {
            Condition::Constant(value) => Some(*value),
            Condition::Literal(number) => known.contains(number).then(|| values[*number]),
            Condition::Not(part) => part.forced(values, known).map(|value| !value),
            Condition::And(parts) => all(parts, false),
            Condition::Or(parts) => all(parts, true),
        }
    }

    /// The cheapest of all sets of literals that decide.
    fn tried(
        &self,
        used: &[usize],
        values: &[bool],
        holds: bool,
        cost: &impl Fn(usize) -> u64,
    ) -> Vec<usize> {
        let own = |set: usize| (0..used.len()).filter(move |at| set >> at & 1 == 1);
        // What it is for each set of literals that have other values than theirs.
        let table: Vec<bool> = (0..1_usize << used.len())
            .map(|turned| {
                let mut values = values.to_vec();
                own(turned).for_each(|at| values[used[at]] ^= true);
                self.holds(&values)
            })
            .collect();
        let decides = |set: &usize| {
            (0..table.len()).filter(|turned| turned & set == 0).all(|turned| table[turned] == holds)
        };
        let mut sets: Vec<usize> = (0..table.len()).collect();
        sets.sort_by_cached_key(|set| {
            (own(*set).map(|at| cost(used[at])).sum::<u64>(), own(*set).collect::<Vec<_>>())
        });
        let found = sets.into_iter().find(decides).unwrap_or_default();
        own(found).map(|at| used[at]).collect()
    }
}

/// A literal more is dearer than all that costs may say.
const DEAR: u64 = 1 << 32;
