//! Puts a path together from what is met on the way, as a list writes it and as a drawing shows it.

use super::{Action, Contact, Deed, Drive, Expression, Gate, Path, Test, touches_bits};
use crate::ladder::ContactKind;
use crate::target::Operand;

/// A path in the making: the path from the left rail, and those that leave one another up to where power stands.
#[derive(Debug)]
pub(super) struct Builder {
    /// From the left rail on. Each but the last is left by the next.
    open: Vec<Open>,
}

/// A path of which more is to come.
#[derive(Debug, Default)]
struct Open {
    path: Path,
    /// How often its power is wanted once more behind it; a further gate then belongs to a path that leaves it.
    kept: u32,
}

impl Builder {
    /// Paths may leave one another to this depth, which no PLC takes; it keeps recursion safe.
    const DEPTH_MAX: usize = 64;

    pub(super) fn new() -> Builder {
        Builder { open: vec![Open::default()] }
    }

    /// How many paths leave one another up to here; the place to come back to with [`Builder::back_to`].
    pub(super) fn place(&self) -> usize {
        self.open.len()
    }

    /// Whether nothing was put in yet.
    pub(super) fn is_empty(&self) -> bool {
        let [only] = &self.open[..] else { return false };
        only.path.gates.is_empty() && only.path.drives.is_empty()
    }

    /// Whether all the power of the left rail is here.
    pub(super) fn is_at_rail(&self) -> bool {
        self.open.iter().all(|open| open.path.gates.is_empty())
    }

    /// Power must pass `expression`.
    pub(super) fn pass(&mut self, expression: Expression) -> Option<()> {
        let path = self.ready()?;
        match path.gates.last_mut() {
            Some(Gate::Pass(before)) => before.and_with(expression),
            _ => path.gates.push(Gate::Pass(expression)),
        }
        Some(())
    }

    /// Power is inverted, or goes through something.
    pub(super) fn gate(&mut self, gate: Gate) -> Option<()> {
        self.ready()?.gates.push(gate);
        Some(())
    }

    /// Power is inverted. Where it was inverted just before the last outputs, it is as it was before them.
    pub(super) fn invert(&mut self) -> Option<()> {
        let is_inverse = |open: &Open| open.path.gates == [Gate::Invert] && open.kept == 0;
        if self.open.len() > 1 && self.open.last().is_some_and(is_inverse) {
            return self.close_last();
        }
        self.gate(Gate::Invert)
    }

    /// Power goes on where there is some or `condition` holds. What led here is asked once more on a path of its own
    /// from the left rail. Nothing where the power is kept, or the outputs so far may have changed what led here.
    pub(super) fn in_parallel(&mut self, condition: Expression) -> Option<()> {
        let power = self.power()?;
        if self.open.iter().any(|open| open.kept > 0) || power.size() > Builder::REPEATED_MAX {
            return None;
        }
        let outputs = || self.open.iter().flat_map(|open| open.path.actions());
        if !power.contacts().into_iter().all(|contact| outputs().all(|output| leaves(output, contact))) {
            return None;
        }
        self.back_to(1, true)?;
        let root = self.open.first_mut()?;
        if !root.path.gates.is_empty() {
            let first = std::mem::take(&mut root.path);
            root.path.drives.push(Drive::Path(first));
        }
        let gates = vec![Gate::Pass(Expression::or([power, condition]))];
        self.open.push(Open { path: Path { gates, drives: Vec::new() }, kept: 0 });
        Some(())
    }

    /// What must hold for power to be here; nothing where that is not for contacts alone to say.
    fn power(&self) -> Option<Expression> {
        let mut power = Expression::Constant(true);
        for gate in self.open.iter().flat_map(|open| &open.path.gates) {
            match gate {
                Gate::Pass(condition) => power.and_with(condition.clone()),
                Gate::Invert => power = power.negated(),
                Gate::Through(_) => return None,
            }
        }
        Some(power)
    }

    /// So many contacts and connections are asked once more, so that a path does not grow with the square of its list.
    const REPEATED_MAX: usize = 48;

    /// Power drives `action`.
    pub(super) fn drive(&mut self, action: Action) {
        if let Some(open) = self.open.last_mut() {
            open.path.drives.push(Drive::Action(action));
        }
    }

    /// The power here will be wanted once more.
    pub(super) fn keep(&mut self) {
        if let Some(open) = self.open.last_mut() {
            open.kept += 1;
        }
    }

    /// Goes back to the power at a place to which it was kept; `for_good` if it is not wanted again. Nothing if
    /// contacts on the way led to no output.
    pub(super) fn back_to(&mut self, place: usize, for_good: bool) -> Option<()> {
        while self.open.len() > place {
            self.close_last()?;
        }
        if for_good && let Some(open) = self.open.last_mut() {
            open.kept = open.kept.saturating_sub(1);
        }
        Some(())
    }

    /// The finished path. Nothing if contacts led to no output.
    pub(super) fn finish(mut self) -> Option<Path> {
        self.back_to(1, true)?;
        let path = self.open.pop()?.path;
        (!path.drives.is_empty()).then_some(path)
    }

    fn close_last(&mut self) -> Option<()> {
        let path = self.open.pop()?.path;
        if path.drives.is_empty() {
            return None;
        }
        self.open.last_mut()?.path.drives.push(Drive::Path(path));
        Some(())
    }

    /// The path to which a gate can be added: a new one if the last has driven something, or its power is kept.
    fn ready(&mut self) -> Option<&mut Path> {
        let last = self.open.last()?;
        if last.kept > 0 || !last.path.drives.is_empty() {
            if self.open.len() >= Builder::DEPTH_MAX {
                return None;
            }
            self.open.push(Open::default());
        }
        Some(&mut self.open.last_mut()?.path)
    }
}

/// Whether `contact` is the same when it is asked again behind `output`.
fn leaves(output: &Action, contact: &Contact) -> bool {
    let ([read], Test::Bit(kind)) = (&contact.terms[..], contact.test) else { return false };
    let is_steady = match (kind, read.operand) {
        (ContactKind::NormallyOpen | ContactKind::NormallyClosed, _) => true,
        (_, Operand::Device(device)) => !device.has_single_edge(),
        _ => false,
    };
    let is_coil = matches!(output.deed, Deed::Coil(_)) && !touches_bits(output);
    let Some(driven) = output.terms.first() else { return false };
    let has_preset = matches!(driven.operand, Operand::Device(device) if device.kind.has_preset());
    let is_other = !driven.may_cover(read) && !read.may_cover(driven);
    is_steady && is_coil && (driven.is_lone() || has_preset) && is_other
}
