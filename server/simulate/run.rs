//! One scan of the program, op by op.

use super::code::{Code, Op};
use super::interrupts::{self, Interrupts};
use super::machine::{Error, Outcome};
use super::orders::CpuError;
use super::row::{self, Row};
use super::writes::Watch;
use super::{ErrorKind, Glimpse, Lanes, Machine, Sight, iec, timing};
use crate::target::Fault;
use crate::target::iec::Datum;

/// A scan that runs.
#[derive(Default)]
pub(super) struct Run {
    pub(super) outcome: Outcome,
    /// Where calls go back to.
    calls: Vec<usize>,
    /// Behind which calls the routines of interrupts run.
    routines: Vec<usize>,
    /// Where loops begin, and how many rounds are left.
    loops: Vec<(usize, i64)>,
    ops: u64,
    /// How often WDT has given the scan more time.
    renewals: u32,
    /// What calculations of IEC 61131-3 are made with, kept from one to the next so that none has to ask for memory.
    values: Vec<Datum>,
}

/// A jump, call or loop that is not executed.
struct Refused {
    kind: ErrorKind,
    /// The error code of the CPU.
    code: i64,
    /// Where the program goes on.
    next: usize,
}

/// The error codes of the CPU for this. Source: the error code list of the FX programming manuals, after which the CPU
/// goes on with all but the watchdog.
const CALLS_CODE: i64 = 6702;
const LOOPS_CODE: i64 = 6704;
const OTHER_CODE: i64 = 6709;
const WATCHDOG_CODE: i64 = 6105;

/// More often WDT does not help: a loop without end is stopped all the same.
const MOST_RENEWALS: u32 = 8;

impl Run {
    /// Whether the watchdog begins again, as WDT has been executed.
    fn renew(&mut self, interrupts: &mut Interrupts) -> bool {
        let is_renewed = interrupts.is_watchdog_restarted && self.renewals < MOST_RENEWALS;
        if is_renewed {
            interrupts.is_watchdog_restarted = false;
            self.renewals += 1;
            self.ops = 0;
        }
        is_renewed
    }

    /// What is to be seen at an op that shows something.
    fn glimpse<'m, L: Lanes>(&'m self, machine: &'m Machine<L>, op: Op) -> Option<Glimpse<'m, L>> {
        let cell = |cell| machine.memory.cell(cell);
        let (instruction, is_stop, seen) = match op {
            Op::Seen { place, power, rail } => (place, true, Some((None, cell(power) & cell(rail)))),
            Op::SeenContact { place, src, invert, power, rail } => {
                (place, true, Some((Some(cell(src) ^ L::all(invert)), cell(power) & cell(rail))))
            }
            Op::Shown { place, power } => (place, false, Some((None, cell(power)))),
            Op::ShownCondition { place, src, invert, power } => {
                (place, false, Some((Some(cell(src) ^ L::all(invert)), cell(power))))
            }
            Op::Reached { place } => (place, true, None),
            _ => return None,
        };
        let sight = seen.map(|(conducts, power)| Sight { instruction, conducts, power });
        let (calls, routines) = (&self.calls, &self.routines);
        Some(Glimpse { machine, instruction, sight, is_stop, calls, routines })
    }

    /// The loop that begins at an op, if it runs. A jump may have left loops within it, which are done with.
    fn inner_loop(&mut self, begin: usize) -> Option<&mut (usize, i64)> {
        let own = self.loops.iter().rposition(|(op, _)| *op == begin)?;
        self.loops.truncate(own + 1);
        self.loops.last_mut()
    }

    /// A loop that begins again was left by a jump, if it runs.
    fn leave_loop(&mut self, begin: usize) {
        if self.inner_loop(begin).is_some() {
            self.loops.pop();
        }
    }

    pub(super) fn error(&mut self, code: &Code, at: usize, kind: ErrorKind, lane: usize) {
        if self.outcome.errors.len() < Outcome::MOST_ERRORS {
            self.outcome.errors.push(Error { place: code.place(at), kind, lane });
        }
    }
}

impl<L: Lanes> Machine<L> {
    pub(super) fn run<W: Watch<L>>(&mut self, code: &Code, rows: &[Row], run: &mut Run, watch: &mut W) {
        let (mut at, most_ops) = (0, self.most_ops());
        while let Some(op) = code.ops.get(at) {
            if W::EACH_OP {
                watch.comes(self, at);
            }
            run.ops += 1;
            if run.ops > most_ops && !run.renew(&mut self.interrupts) {
                self.tell(code, L::ALL, CpuError::HARDWARE, WATCHDOG_CODE);
                return run.error(code, at, ErrorKind::Watchdog, 0);
            }
            let next = match *op {
                Op::Rows(from, to) => {
                    row::run(&rows[from as usize..to as usize], &mut self.memory.cells);
                    // The watchdog counts instructions, whatever they became.
                    run.ops += u64::from(to - from);
                    at += 1;
                    continue;
                }
                Op::Seen { .. }
                | Op::SeenContact { .. }
                | Op::Reached { .. }
                | Op::Shown { .. }
                | Op::ShownCondition { .. } => {
                    if !run.glimpse(self, *op).is_none_or(|glimpse| watch.sees(glimpse)) {
                        run.outcome.is_broken_off = true;
                        return;
                    }
                    at += 1;
                    continue;
                }
                Op::End => return,
                op if op.leads_elsewhere() => match self.flow(code, at, op, run) {
                    Ok(next) => next,
                    Err(refused) => {
                        run.error(code, at, refused.kind, 0);
                        if !code.target.is_fx() {
                            return;
                        }
                        self.tell(code, L::ALL, CpuError::OPERATION, refused.code);
                        refused.next
                    }
                },
                op => {
                    self.change(code, at, op, run);
                    at + 1
                }
            };
            if !self.forces.is_empty() {
                self.hold();
            }
            at = next;
        }
    }

    /// Does what an op does to the memory.
    fn change(&mut self, code: &Code, at: usize, op: Op, run: &mut Run) {
        match op {
            Op::Timer { power, timer } => {
                let power = self.memory.cell(power);
                let moment = self.moment();
                timing::timer(&mut self.memory, timer, power, moment);
            }
            Op::Counter { power, counter } => {
                let power = self.memory.cell(power);
                timing::counter(&mut self.memory, counter, power);
            }
            Op::HighSpeed { power, counter } => {
                let power = self.memory.cell(power);
                timing::high_speed(&mut self.memory, counter, power);
            }
            Op::Clear { power, device } => self.clear(code, self.memory.cell(power), device),
            Op::Execute { power, call } => self.execute(code, at, power, call, run),
            Op::Test { to, call } => self.test(code, at, to, call, run),
            Op::Transfer { power, state, list } => self.transfer(code, self.memory.cell(power), state, list),
            Op::Compute { power, number } => {
                let power = self.memory.cell(power);
                let mut values = std::mem::take(&mut run.values);
                iec::compute(&mut self.memory, &code.iec, number, power, &mut values, |fault, lane| {
                    run.error(code, at, ErrorKind::Calculation(fault), lane);
                });
                run.values = values;
            }
            Op::Copy { power, number } => {
                let power = self.memory.cell(power);
                if !iec::copy(&mut self.memory, &code.iec, number, power) {
                    run.error(code, at, ErrorKind::Calculation(Fault::Index), 0);
                }
            }
            Op::Block { power, number } => {
                let power = self.memory.cell(power);
                if !iec::call_block(&mut self.memory, &code.iec, number, power, self.now_ns) {
                    run.error(code, at, ErrorKind::Calculation(Fault::Index), 0);
                }
            }
            Op::Initialise(list) => iec::initialise(&mut self.memory, &code.iec, list),
            Op::Task(number) => iec::schedule(&mut self.memory, &code.iec, number, self.now_ns),
            _ => {}
        }
    }

    /// Finds where the program goes on behind an op that may lead elsewhere.
    fn flow(&mut self, code: &Code, at: usize, op: Op, run: &mut Run) -> Result<usize, Refused> {
        let next = at + 1;
        let refused = |kind, code, next| Refused { kind, code, next };
        Ok(match op {
            Op::Step { rail, was, state, above, end } => {
                let active = self.memory.cell(state) & self.memory.cell(above);
                let is_left = active == L::NONE && self.memory.cell(was) == L::NONE;
                self.memory.set_cell(rail, active);
                self.memory.set_cell(was, active);
                if is_left { end as usize } else { next }
            }
            Op::Jump { power, to } if self.memory.bit(power, 0) => to as usize,
            Op::Call { power, to } if self.memory.bit(power, 0) => {
                if run.calls.len() >= code.most_calls() + run.routines.len() {
                    return Err(refused(ErrorKind::TooDeep, CALLS_CODE, next));
                }
                run.calls.push(next);
                to as usize
            }
            Op::Interrupt => self.interrupt(code, run, next),
            Op::Return => {
                let back = run.calls.pop();
                let back = back.ok_or(refused(ErrorKind::NothingToReturnTo, OTHER_CODE, next))?;
                match run.routines.pop_if(|depth| *depth > run.calls.len()) {
                    Some(_) => {
                        self.interrupts.are_allowed = true;
                        self.interrupt(code, run, back)
                    }
                    None => back,
                }
            }
            Op::For { call, next: behind } => {
                let rounds = self.rounds(code, at, call, run);
                run.leave_loop(next);
                if rounds < 1 {
                    behind as usize
                } else if run.loops.len() >= code.target.limits.loops as usize {
                    return Err(refused(ErrorKind::TooDeep, LOOPS_CODE, behind as usize));
                } else {
                    run.loops.push((next, rounds));
                    next
                }
            }
            Op::Next { first } => {
                let nothing = refused(ErrorKind::NothingToReturnTo, OTHER_CODE, next);
                let (begin, rounds) = run.inner_loop(first as usize).ok_or(nothing)?;
                *rounds -= 1;
                if *rounds > 0 {
                    *begin
                } else {
                    run.loops.pop();
                    next
                }
            }
            _ => next,
        })
    }

    /// Where the program goes on if an interrupt may run here: at its routine, and behind that at `back`.
    fn interrupt(&mut self, code: &Code, run: &mut Run, back: usize) -> usize {
        if run.routines.len() >= interrupts::MOST_NESTED {
            return back;
        }
        let (layout, memory) = (&code.layout, &self.memory);
        let is_on = |device| layout.cell(device).is_some_and(|cell| memory.bit(cell, 0));
        let Some(routine) = self.interrupts.take(code, is_on) else { return back };
        run.calls.push(back);
        run.routines.push(run.calls.len());
        routine
    }
}
