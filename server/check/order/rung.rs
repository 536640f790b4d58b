//! Walks the lines of an FX rung as the CPU would, with the current result, the stack of blocks and the stack of
//! branches. Five rules read what it finds, so that one mistake is reported by one of them.

use crate::il::fx::{FxTree, LineKind};
use crate::target::{Flow, Form, Limits, Role};

/// Something out of order in a rung. Numbers are indices into [`FxTree::lines`].
#[derive(Clone, PartialEq, Eq, Debug)]
pub(in crate::check) enum Finding {
    /// An instruction that needs a current result has none.
    NoResult { line: usize, after: After },
    /// ANB or ORB with fewer than two blocks begun.
    TooFewBlocks { line: usize, blocks: usize },
    /// Blocks that are not joined when an output comes; the lines that began them, the lowest first.
    OpenBlocks { begun: Vec<usize>, output: usize },
    /// MRD or MPP without MPS.
    NoBranch { line: usize },
    /// MPS without MPP, and the last MRD behind it.
    OpenBranch { line: usize, last_read: Option<usize> },
    /// One block more than may wait.
    TooManyBlocks { line: usize },
    /// One branch more than may be open.
    TooManyBranches { line: usize },
    /// Contacts from `first` to `last` that drive nothing; `before` is what ends the rung.
    NoOutput { first: usize, last: usize, before: Option<usize> },
}

/// Why there is no current result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::check) enum After {
    /// The rung begins here.
    Start,
    /// A master control stands before: rungs behind it begin anew.
    Section(usize),
    /// A step stands before: it drives outputs directly, contacts begin with LD.
    Step(usize),
}

/// What is out of order in the rungs of a chunk, in the order of its lines.
pub(in crate::check) fn findings(tree: &FxTree, limits: Limits) -> Vec<Finding> {
    let mut walk = Walk::new(limits);
    for (line, record) in tree.lines.iter().enumerate() {
        match record.kind {
            LineKind::Label(_) => walk.restart(line, State::Empty(After::Start)),
            LineKind::Instruction(form) => walk.instruction(line, form),
            LineKind::Unknown => walk.lose_track(),
        }
    }
    walk.finish(tree.lines.len(), None);
    walk.found
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    /// There is no current result.
    Empty(After),
    /// STL: outputs follow directly.
    Step(usize),
    /// There is one.
    Result,
    /// Something was reported or unknown: nothing is judged until a new rung begins.
    Unknown,
}

struct Branch {
    line: usize,
    /// Blocks that were begun at the MPS.
    blocks: usize,
    last_read: Option<usize>,
}

struct Walk {
    limits: Limits,
    state: State,
    /// The lines that began the blocks, the lowest first.
    blocks: Vec<usize>,
    branches: Vec<Branch>,
    /// The first contact since the last output or branch.
    loose: Option<usize>,
    found: Vec<Finding>,
}

impl Walk {
    fn new(limits: Limits) -> Walk {
        let state = State::Empty(After::Start);
        Walk { limits, state, blocks: Vec::new(), branches: Vec::new(), loose: None, found: Vec::new() }
    }

    fn instruction(&mut self, line: usize, form: Form) {
        let role = form.instruction.role;
        match (role, form.instruction.flow()) {
            (_, Flow::Nothing) => {}
            (Role::Standalone, Flow::ProgramEnd) => self.restart(line, State::Unknown),
            (Role::Standalone, _) => self.restart(line, State::Empty(After::Start)),
            (Role::StepLoad, _) => self.restart(line, State::Step(line)),
            _ if self.state == State::Unknown => {}
            (Role::Load, _) => self.load(line),
            (Role::Series | Role::Parallel | Role::Modify, _) => self.contact(line),
            (Role::BlockSeries | Role::BlockParallel, _) => self.join(line),
            (Role::BranchPush, _) => self.push(line),
            (Role::BranchRead | Role::BranchPop, _) => self.recall(line, role == Role::BranchPop),
            (Role::Output, flow) => self.output(line, flow),
        }
    }

    fn load(&mut self, line: usize) {
        self.state = State::Result;
        self.blocks.push(line);
        self.loose.get_or_insert(line);
        if self.blocks.len() == self.limits.blocks as usize + 1 {
            self.found.push(Finding::TooManyBlocks { line });
        }
    }

    fn contact(&mut self, line: usize) {
        if self.needs_result(line) {
            self.loose.get_or_insert(line);
        }
    }

    /// Whether there is a result that a contact or a branch can go on from; if not, that is reported.
    fn needs_result(&mut self, line: usize) -> bool {
        let after = match self.state {
            State::Empty(after) => after,
            State::Step(step) => After::Step(step),
            State::Result | State::Unknown => return true,
        };
        self.report(Finding::NoResult { line, after });
        false
    }

    fn join(&mut self, line: usize) {
        if self.blocks.len() < 2 {
            return self.report(Finding::TooFewBlocks { line, blocks: self.blocks.len() });
        }
        self.blocks.pop();
        self.loose.get_or_insert(line);
    }

    fn push(&mut self, line: usize) {
        if !self.needs_result(line) {
            return;
        }
        self.branches.push(Branch { line, blocks: self.blocks.len(), last_read: None });
        self.loose = None;
        if self.branches.len() == self.limits.branches as usize + 1 {
            self.found.push(Finding::TooManyBranches { line });
        }
    }

    fn recall(&mut self, line: usize, forgets: bool) {
        let Some(branch) = self.branches.last_mut() else {
            return self.report(Finding::NoBranch { line });
        };
        branch.last_read = Some(line);
        self.blocks.truncate(branch.blocks);
        if forgets {
            self.branches.pop();
        }
        if let Some(first) = self.loose.replace(line) {
            self.found.push(Finding::NoOutput { first, last: line - 1, before: Some(line) });
        }
    }

    fn output(&mut self, line: usize, flow: Flow) {
        if let State::Empty(after) = self.state {
            return self.report(Finding::NoResult { line, after });
        }
        if self.blocks.len() > 1 {
            let begun = std::mem::take(&mut self.blocks);
            return self.report(Finding::OpenBlocks { begun, output: line });
        }
        self.loose = None;
        if flow == Flow::SectionBegin {
            self.finish(line, None);
            self.state = State::Empty(After::Section(line));
        }
    }

    /// Keeps `finding` and is silent about the rest of the rung.
    fn report(&mut self, finding: Finding) {
        self.found.push(finding);
        self.lose_track();
    }

    fn lose_track(&mut self) {
        self.state = State::Unknown;
        self.blocks.clear();
        self.branches.clear();
        self.loose = None;
    }

    fn restart(&mut self, line: usize, state: State) {
        self.finish(line, Some(line));
        self.state = state;
    }

    /// The rung ends before `line`.
    fn finish(&mut self, line: usize, before: Option<usize>) {
        let loose = self.loose.take();
        let branch = self.branches.pop();
        self.branches.clear();
        self.blocks.clear();
        if let Some(first) = loose {
            self.found.push(Finding::NoOutput { first, last: line - 1, before });
        } else if let Some(branch) = branch {
            self.found.push(Finding::OpenBranch { line: branch.line, last_read: branch.last_read });
        }
    }
}
