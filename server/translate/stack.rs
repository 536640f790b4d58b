//! Where to keep the current result between the outputs of a path, with the fewest instructions.

use std::collections::VecDeque;
use std::sync::LazyLock;

/// What a drive wants the current result to be.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Wants {
    /// The inverse of the power behind the gates: a negated coil, or what stands behind an inverter.
    pub inverse: bool,
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
    /// Whether the path has to begin with the inverse of its power.
    pub is_turned: bool,
    /// The instructions before each drive.
    pub before: Vec<Vec<&'static str>>,
}

/// The instructions before each drive that give it what it wants; the fewest in all, with nothing kept at the end. If
/// `may_turn`, the path may begin with the inverse of its power as well.
pub(super) fn moves(wanted: &[Wants], may_turn: bool) -> Moves {
    // Mostly outputs alone, and perhaps a conditional path behind them.
    let is_plain =
        |(number, wants): (usize, &Wants)| !wants.inverse && (!wants.for_good || number + 1 == wanted.len());
    if wanted.iter().enumerate().all(is_plain) {
        return Moves { is_turned: false, before: vec![Vec::new(); wanted.len()] };
    }
    // For each drive and state behind it the least number of instructions, and the state behind the drive before.
    let start = State { current: Held::Power, kept: Held::Other }.number();
    let turned = State { current: Held::Inverse, kept: Held::Other }.number();
    let mut costs = [usize::MAX; STATES];
    costs[start] = 0;
    if may_turn {
        costs[turned] = 0;
    }
    let mut table: Vec<[usize; STATES]> = Vec::with_capacity(wanted.len());
    for wants in wanted {
        let (mut next_costs, mut origins) = ([usize::MAX; STATES], [start; STATES]);
        for from in (0..STATES).filter(|from| costs[*from] != usize::MAX) {
            for (to, way) in WAYS[from].iter().enumerate() {
                let (Some(way), Some(behind)) = (way, behind(*wants, State::of(to))) else { continue };
                let cost = costs[from] + way.len();
                if cost < next_costs[behind] {
                    next_costs[behind] = cost;
                    origins[behind] = from;
                }
            }
        }
        costs = next_costs;
        table.push(origins);
    }
    let is_end = |state: &usize| State::of(*state).kept == Held::Other;
    let mut state = (0..STATES).filter(is_end).min_by_key(|state| costs[*state]).unwrap_or(start);
    let mut before = Vec::with_capacity(wanted.len());
    for (wants, origins) in wanted.iter().zip(&table).rev() {
        let from = origins[state];
        let ways =
            WAYS[from].iter().enumerate().filter(|(to, _)| behind(*wants, State::of(*to)) == Some(state));
        let way = ways.filter_map(|(_, way)| way.as_ref()).min_by_key(|way| way.len());
        before.push(way.cloned().unwrap_or_default());
        state = from;
    }
    before.reverse();
    Moves { is_turned: state == turned, before }
}

/// The state behind a drive that starts in `state`; nothing if that is not what it wants.
fn behind(wants: Wants, state: State) -> Option<usize> {
    let wanted = if wants.inverse { Held::Inverse } else { Held::Power };
    let left = if wants.for_good { State { current: Held::Other, ..state } } else { state };
    (state.current == wanted).then(|| left.number())
}
