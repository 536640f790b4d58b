//! Where to keep the current result between the outputs of a path, with the fewest instructions.

use std::collections::VecDeque;
use std::sync::LazyLock;

/// What cannot be; so small that it can be added to.
pub(super) const NEVER: usize = usize::MAX / 8;

/// What a drive wants the current result to be.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Wants {
    /// The instructions that it takes if it gets the power behind the gates, and if it gets the inverse of that.
    pub costs: [usize; 2],
    /// It loses the current result: a conditional path. Outputs leave it there.
    pub for_good: bool,
}

/// What the current result, or the top of the branch stack, is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Held {
    Power,
    Inverse,
    /// Something else, or nothing.
    Other,
}

/// The current result, and what is kept of it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct State {
    current: Held,
    kept: Held,
}

const HELD: [Held; 3] = [Held::Power, Held::Inverse, Held::Other];
/// All pairs of two.
const STATES: usize = 9;

impl State {
    fn number(self) -> usize {
        self.current as usize * HELD.len() + self.kept as usize
    }

    fn of(number: usize) -> State {
        State { current: HELD[number / HELD.len()], kept: HELD[number % HELD.len()] }
    }

    /// What one instruction makes of it.
    fn after(self, mnemonic: &str) -> Option<State> {
        let State { current, kept } = self;
        let is_free = kept == Held::Other;
        match (mnemonic, current) {
            ("INV", Held::Power) => Some(State { current: Held::Inverse, kept }),
            ("INV", Held::Inverse) => Some(State { current: Held::Power, kept }),
            ("MPS", Held::Power | Held::Inverse) if is_free => Some(State { current, kept: current }),
            ("MRD", _) if !is_free => Some(State { current: kept, kept }),
            ("MPP", _) if !is_free => Some(State { current: kept, kept: Held::Other }),
            _ => None,
        }
    }
}

/// Instructions from one state to another, the fewest; nothing where there is no way.
type Ways = [[Option<Vec<&'static str>>; STATES]; STATES];

static WAYS: LazyLock<Ways> = LazyLock::new(|| {
    std::array::from_fn(|from| {
        let mut ways: [Option<Vec<&'static str>>; STATES] = Default::default();
        ways[from] = Some(Vec::new());
        let mut waiting = VecDeque::from([from]);
        while let Some(at) = waiting.pop_front() {
            for mnemonic in ["INV", "MPS", "MRD", "MPP"] {
                let Some(next) = State::of(at).after(mnemonic).map(State::number) else { continue };
                if ways[next].is_none() {
                    ways[next] = ways[at].clone().map(|way| [way, vec![mnemonic]].concat());
                    waiting.push_back(next);
                }
            }
        }
        ways
    })
});

/// What is done between the drives of a path.
pub(super) struct Moves {
    /// What all of it costs, with the path before it.
    pub cost: usize,
    /// Whether the path has to begin with the inverse of its power.
    pub is_turned: bool,
    /// The instructions before each drive, and whether it gets the inverse of the power.
    pub before: Vec<(&'static [&'static str], bool)>,
}

/// The instructions before each drive that give it what it wants; the fewest in all, with nothing kept at the end,
/// where it costs so much that the path begins with its power, and with the inverse of that.
pub(super) fn moves(wanted: &[Wants], begins: [usize; 2]) -> Moves {
    // Mostly outputs alone, and perhaps a conditional path behind them.
    let is_plain = |(number, wants): (usize, &Wants)| {
        wants.costs[1] >= NEVER && (!wants.for_good || number + 1 == wanted.len())
    };
    if begins[1] >= NEVER && wanted.iter().enumerate().all(is_plain) {
        let cost = begins[0] + wanted.iter().map(|wants| wants.costs[0]).sum::<usize>();
        return Moves { cost, is_turned: false, before: vec![(&[], false); wanted.len()] };
    }
    // For each drive and state behind it the least number of instructions, and the states behind the drive before, and
    // before this one.
    let start = State { current: Held::Power, kept: Held::Other }.number();
    let turned = State { current: Held::Inverse, kept: Held::Other }.number();
    let mut costs = [NEVER; STATES];
    costs[start] = begins[0];
    costs[turned] = begins[1];
    let mut table: Vec<[(usize, usize); STATES]> = Vec::with_capacity(wanted.len());
    for wants in wanted {
        let (mut next_costs, mut origins) = ([NEVER; STATES], [(start, start); STATES]);
        for from in (0..STATES).filter(|from| costs[*from] < NEVER) {
            for (to, way) in WAYS[from].iter().enumerate() {
                let (Some(way), Some((behind, own))) = (way, behind(*wants, State::of(to))) else { continue };
                let cost = costs[from] + way.len() + own;
                if cost < next_costs[behind] {
                    next_costs[behind] = cost;
                    origins[behind] = (from, to);
                }
            }
        }
        costs = next_costs;
        table.push(origins);
    }
    let is_end = |state: &usize| State::of(*state).kept == Held::Other;
    let mut state = (0..STATES).filter(is_end).min_by_key(|state| costs[*state]).unwrap_or(start);
    let cost = costs[state];
    let mut before = Vec::with_capacity(wanted.len());
    for origins in table.iter().rev() {
        let (from, to) = origins[state];
        let way = WAYS[from][to].as_deref().unwrap_or_default();
        before.push((way, State::of(to).current == Held::Inverse));
        state = from;
    }
    before.reverse();
    Moves { cost, is_turned: state == turned, before }
}

/// The state behind a drive that starts in `state`, and what the drive costs; nothing if it cannot start there.
fn behind(wants: Wants, state: State) -> Option<(usize, usize)> {
    let cost = match state.current {
        Held::Power => wants.costs[0],
        Held::Inverse => wants.costs[1],
        Held::Other => NEVER,
    };
    let left = if wants.for_good { State { current: Held::Other, ..state } } else { state };
    (cost < NEVER).then(|| (left.number(), cost))
}
