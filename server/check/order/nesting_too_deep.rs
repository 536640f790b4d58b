//! # nesting-too-deep
//!
//! The CPU keeps what is nested in stacks of a fixed size: eight blocks that wait for `ANB` or `ORB`, eleven open
//! branches of `MPS`, five loops within each other, five subroutines that call each other. One more and the PLC
//! refuses the program, or stops when it comes there. A subroutine that calls itself never comes to an end. A drawn
//! rung runs as Instruction List, so branches within branches need blocks too.
//!
//! ```fx
//! FOR K2
//! FOR K2
//! FOR K2
//! FOR K2
//! FOR K2
//! FOR K2
//! ^^^
//! LD M8000
//! INC D0
//! NEXT
//! NEXT
//! NEXT
//! NEXT
//! NEXT
//! NEXT
//! END
//! ```
//!
//! ```fx
//! LD X0
//! CALL P1
//! FEND
//! P1
//! LD X1
//! CALL P1
//!      ^^
//! SRET
//! END
//! ```
//!
//! ```fx
//! FOR K2
//! FOR K3
//! LD M8000
//! INC D0
//! NEXT
//! NEXT
//! END
//! ```

use super::rung::Finding;
use crate::check::statements::StatementKind;
use crate::check::{ChunkContext, ProgramContext, Rule, Run};
use crate::target::{Device, Flow};
use crate::text::{Diagnostic, Message, Severity, Span};
use rustc_hash::{FxHashMap, FxHashSet};

pub(super) const RULE: Rule = Rule {
    code: "nesting-too-deep",
    severity: Severity::Error,
    run: Run::Both(check_rung, check_program),
    source: include_str!("nesting_too_deep.rs"),
};

fn check_rung(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    crate::check::drawing::nesting::find(RULE.code, context, found);
    let Some((tree, findings)) = context.rung() else { return };
    let limits = &context.target.limits;
    for finding in findings {
        let (line, key, limit) = match *finding {
            Finding::TooManyBlocks { line } => (line, "nesting-too-deep.blocks", limits.blocks),
            Finding::TooManyBranches { line } => (line, "nesting-too-deep.branches", limits.branches),
            _ => continue,
        };
        let message = Message::new(key).with("limit", limit);
        found.push(Diagnostic::new(RULE.code, tree.lines[line].mnemonic, message));
    }
}

fn check_program(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    loops(context, found);
    calls(context, found);
}

fn loops(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let limit = context.target().limits.loops;
    let mut depth = 0;
    for statement in context.executed() {
        match statement.flow() {
            Some(Flow::LoopBegin) => {
                depth += 1;
                if depth == limit + 1 {
                    let message = Message::new("nesting-too-deep.loops").with("limit", limit);
                    found.push(Diagnostic::new(RULE.code, statement.word, message));
                }
            }
            Some(Flow::LoopEnd) => depth = depth.saturating_sub(1),
            Some(Flow::MainEnd | Flow::SubroutineEnd | Flow::InterruptEnd) => depth = 0,
            _ => {}
        }
    }
}

/// A call: where it goes, and the cells of the pointer.
type Call = (Device, Span);

/// Goes down the levels of calls, from the main program on; what is called at a level calls at the next. Programs
/// have few levels, so each routine is looked at a few times at most.
fn calls(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let limit = context.target().limits.calls;
    let (main, routines) = bodies(context);
    let mut level: Vec<(Device, Vec<Device>)> = Vec::new();
    let mut seen: FxHashSet<Device> = FxHashSet::default();
    level.extend(main.iter().filter(|(to, _)| seen.insert(*to)).map(|(to, _)| (*to, vec![*to])));
    for depth in 1..=limit {
        let mut next = Vec::new();
        seen.clear();
        for (routine, path) in &level {
            for &(to, span) in routines.get(routine).map_or(&[][..], Vec::as_slice) {
                if !seen.insert(to) && depth < limit {
                    continue;
                }
                let path: Vec<Device> = path.iter().copied().chain([to]).collect();
                if depth == limit {
                    found.push(too_deep(&path, span, limit));
                } else {
                    next.push((to, path));
                }
            }
        }
        level = next;
    }
}

fn too_deep(path: &[Device], span: Span, limit: u32) -> Diagnostic {
    let cycle = first_cycle(path);
    let key = match cycle {
        None => "nesting-too-deep.calls",
        Some(_) => "nesting-too-deep.recursion",
    };
    let names: Vec<String> = cycle.unwrap_or(path).iter().map(Device::to_string).collect();
    let message = Message::new(key).with("limit", limit).with("path", names.join(" → "));
    Diagnostic::new(RULE.code, span, message)
}

/// The part of a path of calls from a routine to its next call, both ends included; `None` where none comes back.
fn first_cycle(path: &[Device]) -> Option<&[Device]> {
    path.iter().enumerate().find_map(|(to, routine)| {
        let from = path[..to].iter().position(|earlier| earlier == routine)?;
        Some(&path[from..=to])
    })
}

/// The calls outside of subroutines, and those in each subroutine that is called.
fn bodies(context: &ProgramContext<'_>) -> (Vec<Call>, FxHashMap<Device, Vec<Call>>) {
    let is_call = |flow: Option<Flow>| flow == Some(Flow::Call);
    let called: FxHashSet<Device> =
        context.executed().filter(|s| is_call(s.flow())).filter_map(|call| call.device()).collect();
    let mut main = Vec::new();
    let mut routines: FxHashMap<Device, Vec<Call>> = FxHashMap::default();
    let mut routine = None;
    for statement in context.executed() {
        match statement.kind {
            StatementKind::Label(device) if called.contains(&device) => routine = Some(device),
            StatementKind::Instruction(Flow::SubroutineEnd | Flow::InterruptEnd | Flow::MainEnd) => {
                routine = None
            }
            StatementKind::Instruction(Flow::Call) => {
                let call = statement.device().zip(statement.first).map(|(to, operand)| (to, operand.span));
                match routine {
                    Some(routine) => routines.entry(routine).or_default().extend(call),
                    None => main.extend(call),
                }
            }
            _ => {}
        }
    }
    (main, routines)
}
