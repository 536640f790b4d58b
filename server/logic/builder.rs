//! Puts a path together from what is met on the way, as a list writes it and as a drawing shows it.

use super::{Action, Drive, Expression, Gate, Path};

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
