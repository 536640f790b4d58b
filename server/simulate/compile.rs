//! Makes code of documents: every instruction in its turn, then labels find their places.

use super::adopting::{print_of, print_of_form};
use super::builder::Builder;
use super::code::{CallCode, Code, Counter, Op, Place, Preset, Timer};
use super::row::{Cell, Row};
use super::{Layout, Obstacle, Problem, from_list, from_path, iec};
use crate::document::{Document, Tree, coil_form};
use crate::ladder::CoilKind;
use crate::logic::{Deed, Term};
use crate::target::outside::FIRST_HIGH_SPEED;
use crate::target::{
    Constant, Device, DeviceKind, Fault, Flow, Form, Latches, Model, Opcode, Operand, Role, Semantics, Target,
};
use crate::text::Span;
use rustc_hash::FxHashMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Compiles documents that are one program, in the order of execution.
///
/// With `is_watched` the code says what each instruction saw; it does the same, slower.
pub fn compile(documents: &[&Document], is_watched: bool) -> Result<Code, Vec<Problem>> {
    let code = compiled(documents, is_watched)?;
    let unread = unread(documents);
    if unread.is_empty() { Ok(code) } else { Err(unread) }
}

/// The same of what could be read of them.
fn compiled(documents: &[&Document], is_watched: bool) -> Result<Code, Vec<Problem>> {
    let target = documents.first().map_or(Target::ALL[0], |document| document.target());
    if !target.is_fx() {
        return iec::compile(documents, target, is_watched);
    }
    let latches = documents.first().map(|document| *document.comments().latches()).unwrap_or_default();
    let mut compiler = Compiler::new(target, &latches, is_watched);
    for (number, document) in (0..).zip(documents) {
        for at in document.chunks() {
            compiler.offset = (number, at.start);
            let reading = at.chunk.reading();
            match reading.tree() {
                Tree::Fx(tree) => from_list::compile(&mut compiler, reading.text(), tree),
                _ => from_path::compile(&mut compiler, &reading, target),
            }
        }
    }
    compiler.finish()
}

/// Rules whose findings leave open what the text says. Reading goes on behind them, but to run what it made of them
/// would show a program that nobody wrote.
const UNREAD: [&str; 3] = ["syntax-error", "unclosed-comment", "unclosed-parenthesis"];

/// What could not be read of some documents.
fn unread(documents: &[&Document]) -> Vec<Problem> {
    let mut unread = Vec::new();
    for (number, document) in (0..).zip(documents) {
        for at in document.chunks() {
            let reading = at.chunk.reading();
            let found = reading.problems().iter().filter(|problem| UNREAD.contains(&problem.code));
            unread.extend(found.map(|problem| Problem {
                place: Place { document: number, span: problem.span.shifted(at.start) },
                obstacle: Obstacle::Unread(problem.message.clone()),
            }));
        }
    }
    unread
}

/// Timers that go on when the scan ends, if it did not come to their coils.
const ROUTINE_TIMERS: [RangeInclusive<u32>; 2] = [192..=199, 246..=249];
/// Timers of the FX1S that M8028 makes count in 10 ms.
const FINER_TIMERS: RangeInclusive<u32> = 32..=62;
const FINER: u32 = 8028;
/// Special relays with which a program tells the CPU something that the simulator does not do: running and stopping
/// from outside, parameters of communication, checks of the bus, the parallel link, sampling traces, the ring counter,
/// caught pulses.
const IGNORED: [RangeInclusive<u32>; 7] =
    [8035..=8036, 8038..=8038, 8069..=8071, 8075..=8076, 8099..=8099, 8162..=8162, 8170..=8177];

/// A program that is being compiled.
pub(super) struct Compiler {
    pub(super) builder: Builder,
    /// The document and the place in it from which spans count.
    offset: (u32, usize),
    problems: Vec<Problem>,
    /// Ops behind labels.
    labels: FxHashMap<Device, u32>,
    /// Ops that go to labels, and where that is written.
    jumps: Vec<(u32, Device, Place)>,
    /// Rails outside of master controls, with the number of the control.
    controls: Vec<(u32, Cell)>,
    steps: Steps,
    /// FOR instructions that wait for NEXT.
    loops: Vec<u32>,
    /// Lists of states, for transfers.
    states: Vec<Vec<Cell>>,
    /// Timers that go on without their coils.
    routine_timers: Vec<Timer>,
}

/// The step in which instructions stand.
#[derive(Default)]
struct Steps {
    /// The rail outside of all steps.
    outside: Option<Cell>,
    /// Ops of STL whose end is open.
    open: Vec<u32>,
    /// Their states.
    states: Vec<Cell>,
    /// Whether nothing stands behind the last STL yet, so that another one joins it.
    is_fresh: bool,
    /// The same before the present instruction.
    was_fresh: bool,
}

impl Compiler {
    fn new(target: &'static Target, latches: &Latches, is_watched: bool) -> Compiler {
        Compiler {
            builder: Builder::new(target, Arc::new(Layout::new(target, latches)), is_watched),
            offset: (0, 0),
            problems: Vec::new(),
            labels: FxHashMap::default(),
            jumps: Vec::new(),
            controls: Vec::new(),
            steps: Steps::default(),
            loops: Vec::new(),
            states: Vec::new(),
            routine_timers: Vec::new(),
        }
    }

    /// Notes where the next instruction stands.
    pub(super) fn at(&mut self, span: Span) {
        self.steps.was_fresh = std::mem::take(&mut self.steps.is_fresh);
        let place = self.place(span);
        self.builder.at(place, 1);
    }

    /// Compiles with places in a text that begins here within the present one.
    pub(super) fn inside(&mut self, start: usize, compile: impl FnOnce(&mut Compiler)) {
        let outside = self.offset;
        self.offset.1 += start;
        compile(self);
        self.offset = outside;
    }

    fn place(&self, span: Span) -> Place {
        let (document, start) = self.offset;
        Place { document, span: span.shifted(start) }
    }

    /// Notes that what stands at `span` cannot be compiled.
    pub(super) fn refuse(&mut self, span: Span, obstacle: Obstacle) {
        let place = self.place(span);
        self.problems.push(Problem { place, obstacle });
    }

    /// Says what power the left rail of a drawn rung has.
    pub(super) fn rail_seen(&mut self, span: Span) {
        if self.builder.is_watched() {
            let place = self.place(span);
            self.builder.at(place, 0);
            let power = self.builder.rail();
            self.builder.saw(power);
        }
    }

    /// Whether outputs may stand here without contacts.
    pub(super) fn is_in_step(&self) -> bool {
        !self.steps.states.is_empty()
    }

    /// A label stands here.
    pub(super) fn label(&mut self, label: Device) {
        self.builder.is_like(print_of(&label));
        self.builder.rung();
        let here = self.builder.here();
        self.labels.entry(label).or_insert(here);
    }

    fn finish(mut self) -> Result<Code, Vec<Problem>> {
        self.close_steps();
        let end = self.builder.here();
        for (op, label, place) in std::mem::take(&mut self.jumps) {
            let to = match self.labels.get(&label) {
                Some(to) => *to,
                None if label == Device::PROGRAM_END => end,
                None => {
                    self.problems.push(Problem { place, obstacle: Obstacle::NoLabel(label) });
                    continue;
                }
            };
            if let Some(Op::Jump { to: target, .. } | Op::Call { to: target, .. }) = self.builder.op_mut(op) {
                *target = to;
            }
        }
        for op in std::mem::take(&mut self.loops) {
            let place = self.builder.place_of(op);
            self.problems.push(Problem { place, obstacle: Obstacle::Loop });
        }
        if !self.problems.is_empty() {
            return Err(self.problems);
        }
        let place = self.place(Span::at(0));
        let states = std::mem::take(&mut self.states);
        let code = self.builder.finish().map_err(|obstacle| vec![Problem { place, obstacle }])?;
        let routines = self.labels.iter().filter(|(label, _)| label.kind == DeviceKind::I);
        let mut interrupts: Vec<(u32, u32)> = routines.map(|(label, op)| (label.number, *op)).collect();
        interrupts.sort_unstable();
        let mut labels: Vec<(Device, u32)> = self.labels.into_iter().collect();
        labels.sort_unstable();
        Ok(Code { states, interrupts, labels, routine_timers: self.routine_timers, ..code })
    }

    /// What power drives here.
    pub(super) fn action(&mut self, deed: &Deed, terms: &[Term]) -> Result<(), Obstacle> {
        match deed {
            Deed::Coil(kind) => self.builder.is_like(print_of(kind)),
            Deed::Instruction(form) => self.builder.is_like(print_of_form(*form)),
            _ => {}
        }
        self.builder.names(terms);
        match deed {
            Deed::Coil(kind) => self.coil(*kind, terms),
            Deed::Instruction(form) => self.instruction(*form, terms),
            _ => Err(Obstacle::Unreadable),
        }
    }

    fn coil(&mut self, kind: CoilKind, terms: &[Term]) -> Result<(), Obstacle> {
        let operand = terms.first().ok_or(Obstacle::Unreadable)?.operand;
        let Operand::Device(device) = operand else { return self.remote_coil(kind, terms) };
        if kind == CoilKind::Reset && (device.kind.has_preset() || !device.kind.is_bit()) {
            if !self.builder.layout.has(device) {
                return Err(Obstacle::NoDevice(device));
            }
            let power = self.output();
            self.builder.op(Op::Clear { power, device });
            return Ok(());
        }
        let cell = self.builder.cell(device)?;
        if device.kind.has_preset() {
            let power = self.output();
            let op = self.counting(device, power, &terms[1..])?;
            self.builder.op(op);
            return Ok(());
        }
        if device.kind == DeviceKind::S
            && matches!(kind, CoilKind::Plain | CoilKind::Set)
            && !self.steps.states.is_empty()
        {
            let power = self.output();
            self.states.push(self.steps.states.clone());
            let list = self.states.len() as u32 - 1;
            self.builder.op(Op::Transfer { power, state: cell, list });
            return Ok(());
        }
        self.seen();
        match kind {
            CoilKind::Plain => self.builder.out(cell, false),
            CoilKind::Negated => self.builder.out(cell, true),
            CoilKind::Set => self.builder.set(cell),
            CoilKind::Reset => self.builder.reset(cell),
            CoilKind::Rising => self.builder.pulse(cell, true),
            CoilKind::Falling => self.builder.pulse(cell, false),
            CoilKind::Toggle => return Err(Obstacle::Unreadable),
        }
        if device.kind == DeviceKind::M && IGNORED.iter().any(|numbers| numbers.contains(&device.number)) {
            return self.ignored(kind, terms);
        }
        Ok(())
    }

    /// A coil of a special relay that tells the CPU something which it does not do here: that is said.
    fn ignored(&mut self, kind: CoilKind, terms: &[Term]) -> Result<(), Obstacle> {
        let form = coil_form(kind).ok_or(Obstacle::Unreadable)?;
        let code = CallCode::Deed(|execution| match execution.power() {
            true => Err(Fault::NotSimulated(0)),
            false => Ok(()),
        });
        let power = self.builder.settle();
        let call = self.builder.call(form, terms, code)?;
        self.builder.op(Op::Execute { power, call });
        Ok(())
    }

    /// A coil whose device is known only when it is driven: a bit of a word, or an indexed one.
    fn remote_coil(&mut self, kind: CoilKind, terms: &[Term]) -> Result<(), Obstacle> {
        let form = coil_form(kind).ok_or(Obstacle::Unreadable)?;
        let code = match kind {
            CoilKind::Plain => CallCode::Deed(|execution| execution.set_bit(0, 0, execution.power())),
            CoilKind::Negated => CallCode::Deed(|execution| execution.set_bit(0, 0, !execution.power())),
            CoilKind::Set => CallCode::Deed(|execution| match execution.power() {
                true => execution.set_bit(0, 0, true),
                false => Ok(()),
            }),
            CoilKind::Reset => CallCode::Deed(|execution| match execution.power() {
                true => execution.set_bit(0, 0, false),
                false => Ok(()),
            }),
            CoilKind::Rising => CallCode::Deed(|execution| execution.set_bit(0, 0, execution.is_rising())),
            CoilKind::Falling | CoilKind::Toggle => return Err(Obstacle::Unreadable),
        };
        let power = self.output();
        let call = self.builder.call(form, terms, code)?;
        self.builder.op(Op::Execute { power, call });
        Ok(())
    }

    /// The coil of a timer or counter.
    fn counting(&mut self, device: Device, power: Cell, preset: &[Term]) -> Result<Op, Obstacle> {
        let layout = Arc::clone(&self.builder.layout);
        let missing = Obstacle::NoDevice(device);
        let (Some(contact), Some(coil), Some(current)) =
            (layout.cell(device), layout.coil(device), layout.slot(device))
        else {
            return Err(missing);
        };
        let range = device.range_on(self.builder.target).ok_or(missing)?;
        let is_wide = layout.is_wide(device);
        let preset = self.preset(preset, is_wide)?;
        if device.kind == DeviceKind::T {
            let unit_ms = range.timer_unit_ms.min(100) as u16;
            let is_retentive = range.latched;
            let finer = self.finer(device);
            let timer = Timer { contact, coil, current, preset, unit_ms, is_retentive, finer };
            if ROUTINE_TIMERS.iter().any(|numbers| numbers.contains(&device.number)) {
                self.routine_timers.push(timer);
            }
            return Ok(Op::Timer { power, timer });
        }
        // M8200 to M8234 are on while C200 to C234 count down.
        let down = if is_wide { layout.cell(Device::new(DeviceKind::M, 8000 + device.number)) } else { None };
        let counter = Counter { contact, coil, current, preset, down };
        match device.number {
            FIRST_HIGH_SPEED.. => Ok(Op::HighSpeed { power, counter }),
            _ => Ok(Op::Counter { power, counter }),
        }
    }

    /// The relay that makes a timer of the FX1S count in 10 ms.
    fn finer(&self, timer: Device) -> Option<Cell> {
        let is_switched = self.builder.target.model == Model::Fx1s && FINER_TIMERS.contains(&timer.number);
        let relay = Device::new(DeviceKind::M, FINER);
        is_switched.then(|| self.builder.layout.cell(relay)).flatten()
    }

    fn preset(&mut self, terms: &[Term], is_wide: bool) -> Result<Preset, Obstacle> {
        match terms.first().map(|term| term.operand) {
            Some(Operand::Constant { value: Constant::Decimal(value), index: None }) => {
                Ok(Preset::Constant(value))
            }
            Some(Operand::Constant { value: Constant::Hexadecimal(bits), index: None }) => {
                Ok(Preset::Constant(if is_wide {
                    i64::from(bits as u32 as i32)
                } else {
                    i64::from(bits as u16 as i16)
                }))
            }
            Some(Operand::Device(device)) => {
                let layout = &self.builder.layout;
                let slot = |device| layout.slot(device).ok_or(Obstacle::NoDevice(device));
                let lower = slot(device)?;
                match is_wide {
                    true => Ok(Preset::Pair(lower, slot(Device::new(device.kind, device.number + 1))?)),
                    false => Ok(Preset::Word(lower)),
                }
            }
            Some(_) => {
                let form = Form::named("OUT").ok_or(Obstacle::Unreadable)?;
                let code = CallCode::Deed(|execution| {
                    let preset = execution.word(0, 0)?;
                    execution.note(0, preset);
                    Ok(())
                });
                let call = self.builder.call(form, &terms[..1], code)?;
                self.builder.op(Op::Execute { power: Row::RAIL, call });
                Ok(Preset::Word(self.builder.notes_of(call)))
            }
            None => Err(Obstacle::NoPreset),
        }
    }

    /// An instruction that is no coil.
    fn instruction(&mut self, form: Form, terms: &[Term]) -> Result<(), Obstacle> {
        let flow = form.instruction.flow();
        match flow {
            Flow::Straight | Flow::Refresh => self.applied(form, terms),
            Flow::Nothing if form.instruction.opcode == Opcode::Itself => Err(Obstacle::NoSimulation(form)),
            Flow::Nothing => {
                self.builder.reached();
                Ok(())
            }
            Flow::InterruptsAllowed => {
                self.applied(form, terms)?;
                self.builder.op(Op::Interrupt);
                Ok(())
            }
            Flow::Jump | Flow::Call => self.jump(form, terms),
            Flow::SubroutineEnd | Flow::InterruptEnd => {
                self.close_controls();
                self.builder.reached();
                self.builder.op(Op::Return);
                Ok(())
            }
            Flow::LoopBegin => {
                let call = self.builder.call(form, terms, CallCode::Deed(|_| Ok(())))?;
                self.builder.reached();
                let op = self.builder.op(Op::For { call, next: 0 });
                self.loops.push(op);
                Ok(())
            }
            Flow::LoopEnd => {
                let begin = self.loops.pop().ok_or(Obstacle::Loop)?;
                self.builder.reached();
                let end = self.builder.op(Op::Next { first: begin + 1 });
                if let Some(Op::For { next, .. }) = self.builder.op_mut(begin) {
                    *next = end + 1;
                }
                Ok(())
            }
            Flow::SectionBegin => self.master_control(terms),
            Flow::SectionEnd => self.master_control_end(terms),
            Flow::Step => self.step(terms),
            Flow::StepsEnd => {
                self.close_steps();
                self.builder.reached();
                Ok(())
            }
            Flow::MainEnd | Flow::ProgramEnd => {
                self.close_steps();
                self.close_controls();
                self.builder.reached();
                self.builder.op(Op::End);
                Ok(())
            }
        }
    }

    fn applied(&mut self, form: Form, terms: &[Term]) -> Result<(), Obstacle> {
        let code = match form.instruction.semantics {
            Semantics::Powered(deed) | Semantics::Always(deed) => CallCode::Deed(deed),
            Semantics::Test(_) => return Err(Obstacle::Unreadable),
            Semantics::Basic => return Err(Obstacle::NoSimulation(form)),
        };
        if form.instruction.role == Role::Standalone {
            self.builder.forget_power();
        }
        let power = self.output();
        let call = self.builder.call(form, terms, code)?;
        self.builder.op(Op::Execute { power, call });
        Ok(())
    }

    /// The cell with the power that an output gets.
    fn output(&mut self) -> Cell {
        let power = self.builder.settle();
        self.builder.seen();
        power
    }

    /// Says what power reaches a coil, which needs no cell for it otherwise.
    fn seen(&mut self) {
        if self.builder.is_watched() {
            self.output();
        }
    }

    fn jump(&mut self, form: Form, terms: &[Term]) -> Result<(), Obstacle> {
        let Some(Operand::Device(label)) = terms.first().map(|term| term.operand) else {
            return Err(Obstacle::Unreadable);
        };
        let mut power = self.output();
        if form.pulse {
            power = self.builder.edge(power, true);
        }
        let op = match form.instruction.flow() {
            Flow::Call => Op::Call { power, to: 0 },
            _ => Op::Jump { power, to: 0 },
        };
        let op = self.builder.op(op);
        let place = self.builder.place_of(op);
        self.jumps.push((op, label, place));
        Ok(())
    }

    /// MC: behind it the rail has the power that reaches it.
    fn master_control(&mut self, terms: &[Term]) -> Result<(), Obstacle> {
        let [level, relay] = terms else { return Err(Obstacle::Unreadable) };
        let level = level.operand.device().ok_or(Obstacle::Unreadable)?.number;
        self.controls.retain(|(open, _)| *open < level);
        let outside = self.builder.rail();
        self.controls.push((level, outside));
        self.coil(CoilKind::Plain, std::slice::from_ref(relay))?;
        let power = self.builder.settle();
        let rail = self.builder.kept();
        self.builder.out(rail, false);
        self.builder.set_power(power);
        self.builder.set_rail(rail);
        Ok(())
    }

    fn master_control_end(&mut self, terms: &[Term]) -> Result<(), Obstacle> {
        self.builder.reached();
        let level = terms.first().and_then(|term| term.operand.device()).ok_or(Obstacle::Unreadable)?.number;
        while let Some((_, outside)) = self.controls.pop_if(|(open, _)| *open >= level) {
            self.builder.set_rail(outside);
        }
        self.builder.forget_power();
        Ok(())
    }

    /// A master control that nothing has closed does not reach beyond the main program or its routine.
    fn close_controls(&mut self) {
        if let Some((_, outside)) = self.controls.drain(..).next() {
            self.builder.set_rail(outside);
        }
    }

    /// STL: what follows belongs to the step. Right behind another one it is the joining of both.
    fn step(&mut self, terms: &[Term]) -> Result<(), Obstacle> {
        let Some(Operand::Device(device)) = terms.first().map(|term| term.operand) else {
            return Err(Obstacle::Unreadable);
        };
        let state = self.builder.layout.cell(device).ok_or(Obstacle::NoDevice(device))?;
        if !self.steps.was_fresh {
            self.close_steps();
        }
        let above = self.builder.rail();
        self.steps.outside.get_or_insert(above);
        let (rail, was) = (self.builder.kept(), self.builder.kept());
        self.builder.forget_power();
        self.builder.reached();
        let op = self.builder.op(Op::Step { rail, was, state, above, end: 0 });
        self.steps.open.push(op);
        self.steps.states.push(state);
        self.steps.is_fresh = true;
        self.builder.set_rail(rail);
        let instruction = self.builder.instruction();
        self.builder.shown(instruction, rail);
        Ok(())
    }

    /// Ends the step in which instructions stand.
    fn close_steps(&mut self) {
        let steps = std::mem::take(&mut self.steps);
        let Some(outside) = steps.outside else { return };
        self.builder.forget_power();
        let here = self.builder.here();
        for op in steps.open {
            if let Some(Op::Step { end, .. }) = self.builder.op_mut(op) {
                *end = here;
            }
        }
        self.builder.set_rail(outside);
    }

    /// Changes the current result by itself: INV, MEP, MEF.
    pub(super) fn modify(&mut self, form: Form) {
        self.builder.is_like(print_of_form(form));
        if Form::named("INV") == Some(form) {
            self.builder.invert();
        } else {
            let power = self.builder.settle();
            let edge = self.builder.edge(power, Form::named("MEP") == Some(form));
            self.builder.set_power(edge);
        }
        self.builder.seen();
    }
}
