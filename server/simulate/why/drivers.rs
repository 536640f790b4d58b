//! Which instructions drive a device, under which rails.

use crate::document::{Chunk, ChunkRef, Document, Tree};
use crate::il::iec::ItemKind;
use crate::logic::{self, Action, Declared, Deed, Drive, Expression, Gate, Path, Rung};
use crate::simulate::{Code, Place, Variable};
use crate::target::{Device, DeviceKind, Flow, Operand};
use crate::text::{Span, folded};
use rustc_hash::FxHashMap;
use smol_str::{SmolStr, ToSmolStr};
use std::cell::OnceCell;

/// What drives each device of a program, in the order of execution.
#[derive(Debug, Default)]
pub struct Drivers {
    by_name: FxHashMap<SmolStr, Vec<Driver>>,
    /// Master controls and steps by their places.
    rails: FxHashMap<Place, Driver>,
    /// Jumps, calls and returns by where they end.
    leaving: FxHashMap<Place, Driver>,
    /// Those of IEC 61131-3, and what each drives: of which body, and the number of the driver.
    all: Vec<Driver>,
    by_variable: OnceCell<FxHashMap<Variable, Vec<(usize, usize)>>>,
    /// Calculations that stand in several lines, by their ends.
    lines: FxHashMap<Place, Place>,
}

/// An instruction that drives something.
#[derive(Clone, Debug)]
pub(super) struct Driver {
    /// Where it stands.
    pub(super) place: Place,
    pub(super) action: Action,
    /// The condition of its power from the rail to it; nothing if that is not known.
    pub(super) wire: Option<Wire>,
    /// The innermost master control or step in which it stands.
    pub(super) rail: Option<Place>,
    /// Whether it takes a step away that it hands on.
    pub(super) leaves: bool,
    /// The folded name of the IEC 61131-3 unit in which it stands.
    pub(super) unit: SmolStr,
    /// The body of that unit which is meant.
    pub(super) frame: Option<usize>,
}

/// The condition of power at an instruction.
#[derive(Clone, Debug)]
pub(super) enum Wire {
    Pass(Expression),
    Not(Box<Wire>),
    Series(Vec<Wire>),
    /// What decides by itself whether power goes on behind it.
    Through(Box<Action>),
}

/// More devices are not written at once.
const MOST_AT_ONCE: u32 = 512;

impl Drivers {
    /// Reads documents that are one program, in the order of execution.
    pub fn of(documents: &[&Document]) -> Drivers {
        let mut reader = Reader {
            drivers: Drivers::default(),
            unit: SmolStr::default(),
            is_fx: true,
            sections: Vec::new(),
            step: None,
            document: 0,
            start: 0,
            is_list: false,
        };
        for (number, document) in (0..).zip(documents) {
            (reader.document, reader.is_fx) = (number, document.target().is_fx());
            reader.unit = SmolStr::default();
            for (at, pous) in with_pous(document) {
                reader.start = at.start;
                let is_open = reader.enter(document, at, pous);
                let declared = Declared { scopes: document.scopes(), pous };
                let reading = at.chunk.reading();
                for rung in logic::rungs_with(&reading, document.target(), declared) {
                    reader.rung(&rung, &reading);
                }
                if !is_open {
                    reader.unit = SmolStr::default();
                }
            }
        }
        reader.drivers
    }

    /// What drives a device or variable.
    pub(super) fn named(&self, name: &str) -> &[Driver] {
        self.by_name.get(name).map_or(&[], Vec::as_slice)
    }

    /// What drives a variable of an IEC 61131-3 program, each with the body that does it.
    pub(super) fn of_variable(&self, variable: Variable, code: &Code) -> Vec<Driver> {
        let by_variable = self.by_variable.get_or_init(|| self.resolved(code));
        let own = by_variable.get(&variable).into_iter().flatten();
        own.map(|(frame, number)| Driver { frame: Some(*frame), ..self.all[*number].clone() }).collect()
    }

    /// What drives something in a unit of IEC 61131-3 with this folded name.
    pub(super) fn of_unit<'d>(&'d self, unit: &'d str) -> impl Iterator<Item = &'d Driver> {
        self.all.iter().filter(move |driver| driver.unit == unit)
    }

    fn resolved(&self, code: &Code) -> FxHashMap<Variable, Vec<(usize, usize)>> {
        let mut found: FxHashMap<Variable, Vec<(usize, usize)>> = FxHashMap::default();
        for frame in 0..code.iec.names().scope_count() {
            let unit = code.iec.names().unit_of(frame);
            let own = self.all.iter().enumerate().filter(|(_, driver)| driver.unit == unit);
            for (number, driver) in own {
                for term in driver.action.changes() {
                    if let Some(variable) = code.variable_in(frame, &term.text) {
                        let drivers = found.entry(variable).or_default();
                        if drivers.last() != Some(&(frame, number)) {
                            drivers.push((frame, number));
                        }
                    }
                }
            }
        }
        found
    }

    /// The whole of a calculation that stands in several lines, at its place or at that of its last line.
    pub(super) fn several_lines(&self, place: Place) -> Option<Place> {
        self.lines
            .get(&ending(place))
            .copied()
            .filter(|own| own.span.start <= place.span.start && *own == place)
    }

    /// The jump, call or return at a place.
    pub(super) fn leaving(&self, place: Place) -> Option<&Driver> {
        self.leaving.get(&ending(place))
    }

    /// Whether a routine of an FX program ends between two places.
    pub(super) fn ends_between(&self, first: Place, last: Place) -> bool {
        let ends = |driver: &Driver| {
            let is_end = matches!(flow(&driver.action), Flow::SubroutineEnd | Flow::InterruptEnd);
            is_end && (first..last).contains(&driver.place)
        };
        self.leaving.values().any(ends)
    }

    /// The calls of a routine of an FX program, in the order of the text.
    pub(super) fn calls_of(&self, label: Device) -> Vec<Driver> {
        let is_call = |driver: &&Driver| {
            let first = driver.action.terms.first().and_then(|term| term.operand.device());
            first == Some(label) && flow(&driver.action) == Flow::Call
        };
        let mut calls: Vec<Driver> = self.leaving.values().filter(is_call).cloned().collect();
        calls.sort_unstable_by_key(|call| call.place);
        calls
    }

    /// The master control or the step at a place.
    pub(super) fn rail(&self, place: Place) -> Option<&Driver> {
        self.rails.get(&place)
    }
}

fn with_pous(document: &Document) -> Vec<(ChunkRef<'_>, usize)> {
    let numbers: FxHashMap<usize, usize> = document.iec_chunks().map(|(at, pous)| (at.start, pous)).collect();
    let mut pous = 0;
    let all = document.chunks().map(|at| {
        // A drawing belongs to the unit that is open where it stands.
        pous = numbers.get(&at.start).copied().unwrap_or(pous);
        (at, pous)
    });
    all.collect()
}

struct Reader {
    drivers: Drivers,
    /// The folded name of the unit that is open.
    unit: SmolStr,
    is_fx: bool,
    /// Master controls that are open, with their levels.
    sections: Vec<(u32, Place)>,
    step: Option<(Place, Device)>,
    document: u32,
    start: usize,
    /// Whether the present rung is written as a list.
    is_list: bool,
}

impl Reader {
    /// Comes to a chunk. Gives whether the unit goes on behind it.
    fn enter(&mut self, document: &Document, at: ChunkRef<'_>, pous: usize) -> bool {
        let Some(tree) = at.chunk.iec() else { return true };
        let mut is_open = true;
        for item in &tree.items {
            match item.kind {
                ItemKind::Pou { .. } => {
                    let unit = document.scopes().pous.get(pous.wrapping_sub(1));
                    self.unit = unit.map(|unit| folded(&unit.name)).unwrap_or_default();
                    is_open = true;
                }
                ItemKind::PouEnd(_) => is_open = false,
                _ => {}
            }
        }
        is_open
    }

    fn rung(&mut self, rung: &Rung, chunk: &Chunk) {
        match &rung.path {
            Ok(Some(path)) => {
                self.is_list = rung.is_list;
                self.path(path, Some(Vec::new()));
            }
            Ok(None) => {}
            Err(_) => {
                let (start, list) = chunk.box_at(rung.span.start as usize).unwrap_or((0, chunk));
                let Tree::Fx(tree) = list.tree() else { return };
                for action in logic::actions_of_list(list.text(), tree) {
                    let span = action.span.shifted(start);
                    self.action(&Action { span, ..action }, None);
                }
            }
        }
    }

    fn place(&self, span: Span) -> Place {
        Place { document: self.document, span: span.shifted(self.start) }
    }

    fn path(&mut self, path: &Path, mut wires: Option<Vec<Wire>>) {
        for gate in &path.gates {
            match gate {
                Gate::Pass(expression) => {
                    wires.as_mut().into_iter().for_each(|wires| wires.push(Wire::Pass(expression.clone())));
                }
                Gate::Invert => {
                    wires = wires.map(|wires| vec![Wire::Not(Box::new(Wire::Series(wires)))]);
                }
                Gate::Through(action) => {
                    self.action(action, wires.clone());
                    wires = wires.map(|_| vec![Wire::Through(Box::new(action.clone()))]);
                }
            }
        }
        for drive in &path.drives {
            match drive {
                Drive::Action(action) => self.action(action, wires.clone()),
                Drive::Path(path) => self.path(path, wires.clone()),
            }
        }
    }

    fn action(&mut self, action: &Action, wires: Option<Vec<Wire>>) {
        let place = self.place(action.span);
        let step = self.step.map(|(place, _)| place);
        let rail = step.or_else(|| self.sections.last().map(|(_, place)| *place));
        let driver = Driver {
            place,
            action: action.clone(),
            wire: wires.map(Wire::Series),
            rail,
            leaves: false,
            unit: self.unit.clone(),
            frame: None,
        };
        let flow = flow(action);
        let leaves = matches!(flow, Flow::Jump | Flow::Call | Flow::SubroutineEnd | Flow::InterruptEnd);
        if leaves || matches!(action.deed, Deed::Jump | Deed::Return) {
            self.drivers.leaving.insert(ending(place), driver.clone());
        }
        if !self.is_fx {
            if self.is_list && matches!(action.deed, Deed::Compute(_)) {
                self.drivers.lines.insert(ending(place), place);
            }
            return self.drivers.all.push(driver);
        }
        let first = action.terms.first().and_then(|term| term.operand.device());
        match (flow, first) {
            (Flow::SectionBegin, Some(level)) => {
                self.sections.retain(|(open, _)| *open < level.number);
                self.sections.push((level.number, place));
                self.drivers.rails.insert(place, driver.clone());
            }
            (Flow::SectionEnd, Some(level)) => self.sections.retain(|(open, _)| *open < level.number),
            (Flow::Step, Some(state)) => {
                self.step = Some((place, state));
                self.drivers.rails.insert(place, driver.clone());
            }
            (Flow::StepsEnd | Flow::MainEnd | Flow::ProgramEnd, _) => self.step = None,
            _ => {}
        }
        let hands_on = matches!(action.deed, Deed::Coil(_)) && first.is_some_and(|d| d.kind == DeviceKind::S);
        if let (Some((_, state)), true) = (self.step, hands_on) {
            let leaving = Driver { leaves: true, ..driver.clone() };
            self.drivers.by_name.entry(state.to_smolstr()).or_default().push(leaving);
        }
        for name in written(action) {
            self.drivers.by_name.entry(name).or_default().push(driver.clone());
        }
    }
}

/// What an instruction of an FX program does to the order of execution.
fn flow(action: &Action) -> Flow {
    match &action.deed {
        Deed::Instruction(form) => form.instruction.flow(),
        _ => Flow::Straight,
    }
}

fn ending(place: Place) -> Place {
    Place { span: Span { start: place.span.end, ..place.span }, ..place }
}

/// The names of what an action may write.
fn written(action: &Action) -> Vec<SmolStr> {
    let changes = action.changes();
    let mut names: Vec<SmolStr> = Vec::new();
    for term in &changes {
        match term.operand {
            Operand::Nibbles { digits, first, index: None } => {
                let count = u32::from(digits) * 4;
                names
                    .extend((0..count).map(|more| Device::new(first.kind, first.number + more).to_smolstr()));
            }
            _ => names.push(term.key()),
        }
    }
    // A range from one device to another.
    let devices: Vec<Device> = changes.iter().filter_map(|term| term.operand.device()).collect();
    if let ([first, last], true) = (&devices[..], changes.len() == action.terms.len())
        && first.kind == last.kind
        && first.number < last.number
    {
        let last = last.number.min(first.number + MOST_AT_ONCE);
        names.extend((first.number + 1..last).map(|number| Device::new(first.kind, number).to_smolstr()));
    }
    names
}
