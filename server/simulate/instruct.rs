//! Instructions that are executed: those whose rows in `target` have code, and what the FX family has besides contacts.

use super::code::{Call, CallCode, Code};
use super::execution::Executing;
use super::layout::RESET;
use super::orders::CpuError;
use super::run::Run;
use super::{Cell, ErrorKind, Lanes, Machine, timing};
use crate::target::{Device, DeviceKind, Execution, Fault};

impl<L: Lanes> Machine<L> {
    /// RST of what is no relay.
    pub(super) fn clear(&mut self, code: &Code, power: L, device: Device) {
        let (cell, slot) = (code.layout.cell(device), code.layout.slot(device));
        if let Some(cell) = cell {
            let contact = self.memory.cell(cell);
            self.memory.set_cell(cell, contact & !power);
            self.memory.set_cell(cell + RESET, power);
        }
        for lane in (0..L::COUNT).filter(|lane| power.lane(*lane)) {
            if let Some(slot) = slot {
                timing::store(&mut self.memory, &code.layout, (slot, device), lane, 0);
            }
        }
    }

    /// SET or OUT of a state in a step: the step is left for it, unless M8040 forbids transfers.
    pub(super) fn transfer(&mut self, code: &Code, power: L, state: Cell, list: u32) {
        let forbidden =
            code.layout.cell(Device::new(DeviceKind::M, 8040)).map_or(L::NONE, |cell| self.memory.cell(cell));
        let done = power & !forbidden;
        for source in code.states.get(list as usize).into_iter().flatten() {
            let source_state = self.memory.cell(*source);
            self.memory.set_cell(*source, source_state & !done);
        }
        let entered = self.memory.cell(state) | done;
        self.memory.set_cell(state, entered);
    }

    pub(super) fn execute(&mut self, code: &Code, at: usize, power: Cell, call: u32, run: &mut Run) {
        let Some(called) = code.calls.get(call as usize) else { return };
        let CallCode::Deed(deed) = called.code else { return };
        let power = self.memory.cell(power);
        let before = self.memory.cell(called.was);
        self.memory.set_cell(called.was, power);
        let executed = match (called.is_always, called.form.pulse) {
            (true, _) => L::ALL,
            (false, true) => power & !before,
            (false, false) => power,
        };
        if executed == L::NONE {
            return;
        }
        for lane in (0..L::COUNT).filter(|lane| executed.lane(*lane)) {
            let is_rising = power.lane(lane) && !before.lane(lane);
            let done = deed(&mut self.executing(code, called, lane, power.lane(lane), is_rising));
            if let Err(fault) = done {
                self.fault(code, at, fault, lane, run);
            }
        }
    }

    pub(super) fn test(&mut self, code: &Code, at: usize, to: Cell, call: u32, run: &mut Run) {
        let Some(called) = code.calls.get(call as usize) else { return };
        let CallCode::Test(holds) = called.code else { return };
        let mut conducts = L::NONE;
        for lane in 0..L::COUNT {
            match holds(&mut self.executing(code, called, lane, true, false)) {
                Ok(on) => conducts = conducts.with(lane, on),
                Err(fault) => self.fault(code, at, fault, lane, run),
            }
        }
        self.memory.set_cell(to, conducts);
    }

    /// How many rounds FOR makes: one at least, unless nobody can say.
    pub(super) fn rounds(&mut self, code: &Code, at: usize, call: u32, run: &mut Run) -> i64 {
        let Some(called) = code.calls.get(call as usize) else { return 0 };
        match self.executing(code, called, 0, true, false).word(0, 0) {
            Ok(rounds) => rounds.max(1),
            Err(fault) => {
                self.fault(code, at, fault, 0, run);
                0
            }
        }
    }

    fn executing<'m>(
        &'m mut self,
        code: &'m Code,
        call: &'m Call,
        lane: usize,
        power: bool,
        is_rising: bool,
    ) -> Executing<'m, L> {
        Executing {
            memory: &mut self.memory,
            terminals: &mut self.terminals,
            outside: &mut self.outside[lane],
            interrupts: &mut self.interrupts,
            model: code.target.model,
            layout: &code.layout,
            call,
            lane,
            power,
            is_rising,
            now_ns: self.now_ns,
            scan_ns: self.scan_ns,
            is_first_scan: self.scans == 1,
        }
    }

    /// Tells the program and the caller that an instruction was not executed.
    fn fault(&mut self, code: &Code, at: usize, fault: Fault, lane: usize, run: &mut Run) {
        self.tell(code, L::NONE.with(lane, true), CpuError::OPERATION, fault.code());
        run.error(code, at, ErrorKind::Fault(fault), lane);
    }
}
