//! Which parts of a program can run in one scan together: steps, routines, and what jumps pass over.

use super::uses::{Use, Uses};
use crate::check::ProgramContext;
use crate::check::order::END_POINTER;
use crate::check::statements::{Statement, StatementKind};
use crate::document::JointKind;
use crate::target::{Device, DeviceKind, Flow};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// The parts of a program.
#[derive(Default)]
pub struct Regions {
    /// What holds from each offset on, in order.
    regions: Vec<(u32, Region)>,
    /// What jumps forward pass over: from the jump to its label.
    skips: Vec<(u32, u32)>,
    /// From each offset on, the last start and the first end of the skips that cover it.
    covers: Vec<(u32, Option<(u32, u32)>)>,
    /// What may be executed several times in a scan: from a label to the last jump back to it, from FOR to NEXT.
    loops: Vec<(u32, u32)>,
    /// Whether there are steps.
    pub has_steps: bool,
    is_fx: bool,
}

/// What holds at a place of an FX program.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Region {
    /// Programs behind each other, parted by FEND, SRET and IRET, are numbered.
    section: u32,
    /// The label of the routine.
    routine: Option<Device>,
    /// The step.
    pub step: Option<Device>,
    /// How many master controls are open.
    pub controls: u32,
}

impl Region {
    /// Whether the place is executed in every scan: in no step and no routine.
    pub fn is_plain(self) -> bool {
        self == Region::default()
    }

    /// Whether its place in the text is its place in the scan, if it is executed at all.
    pub fn is_in_order(self) -> bool {
        self.routine.is_none() && self.step.is_none() && self.section == 0
    }

    fn is_interrupt(self) -> bool {
        self.routine.is_some_and(|label| label.kind == DeviceKind::I)
    }
}

impl Regions {
    /// The parts of the program whose accesses are `uses`.
    pub fn of(context: &ProgramContext<'_>, uses: &Uses<'_>) -> Regions {
        let mut regions = if uses.is_fx { Regions::of_fx(context) } else { Regions::of_units(context) };
        regions.is_fx = uses.is_fx;
        regions.settle();
        regions
    }

    fn of_fx(context: &ProgramContext<'_>) -> Regions {
        let called: FxHashSet<Device> = context
            .executed()
            .filter(|statement| statement.flow() == Some(Flow::Call))
            .filter_map(|call| call.device())
            .collect();
        let mut regions = Regions::default();
        let mut region = Region::default();
        let mut labels: FxHashMap<Device, u32> = FxHashMap::default();
        let mut jumps: Vec<(u32, Device)> = Vec::new();
        let mut opened: Vec<u32> = Vec::new();
        for statement in context.executed() {
            let before = region;
            match statement.kind {
                StatementKind::Label(label) => {
                    labels.entry(label).or_insert(statement.span.start);
                    if region.section > 0 && (label.kind == DeviceKind::I || called.contains(&label)) {
                        region.routine = Some(label);
                    }
                }
                StatementKind::Instruction(flow) => {
                    region.pass(flow, &statement);
                    regions.has_steps |= flow == Flow::Step;
                    match flow {
                        Flow::LoopBegin => opened.push(statement.span.start),
                        Flow::LoopEnd => {
                            regions.loops.extend(opened.pop().map(|start| (start, statement.span.end)));
                        }
                        _ => {}
                    }
                    if flow == Flow::Jump {
                        jumps.extend(statement.device().map(|label| (statement.span.end, label)));
                    }
                }
                StatementKind::Unknown => {}
            }
            if region != before {
                regions.regions.push((statement.span.start, region));
            }
        }
        // A loop that is left open reaches to the end.
        regions.loops.extend(opened.into_iter().map(|start| (start, u32::MAX)));
        let back = |(end, label): &(u32, Device)| {
            let start = labels.get(label).copied().filter(|_| *label != END_POINTER)?;
            (start < *end).then_some((start, *end))
        };
        regions.loops.extend(jumps.iter().filter_map(back));
        let behind = |(start, label): (u32, Device)| {
            // END needs no label; what stands behind the main program is another part anyway.
            let end = if label == END_POINTER { u32::MAX } else { *labels.get(&label)? };
            (start < end).then_some((start, end))
        };
        regions.skips = jumps.into_iter().filter_map(behind).collect();
        regions
    }

    /// The jumps of units of IEC 61131-3; leaving a unit passes over the rest of it.
    fn of_units(context: &ProgramContext<'_>) -> Regions {
        let mut regions = Regions::default();
        for file in context.files() {
            let mut units: BTreeMap<usize, Unit<'_>> = BTreeMap::new();
            let (mut start, mut pous) = (file.start, 0);
            for page in file.document.pages() {
                for joint in &page.accesses().joints {
                    let unit = units.entry(pous + joint.pou as usize).or_default();
                    let at = joint.span.shifted(start);
                    match &joint.kind {
                        JointKind::Label(name) => _ = unit.labels.entry(name).or_insert(at.start),
                        JointKind::Jump(name) => unit.jumps.push((at.end, Some(name))),
                        JointKind::Return => unit.jumps.push((at.end, None)),
                    }
                }
                start += page.bytes();
                pous += page.pou_starts();
            }
            let end = start as u32;
            for unit in units.into_values() {
                for (start, label) in unit.jumps {
                    // Accesses of other units have other names, so the end of the file will do for that of the unit.
                    let label = label.map_or(Some(end), |label| unit.labels.get(label.as_str()).copied());
                    regions.loops.extend(label.filter(|label| *label <= start).map(|label| (label, start)));
                    regions.skips.extend(label.filter(|label| start < *label).map(|label| (start, label)));
                }
            }
        }
        regions
    }

    /// Finds what covers each place, once for all questions.
    fn settle(&mut self) {
        let mut events: Vec<(u32, bool, (u32, u32))> = Vec::with_capacity(self.skips.len() * 2);
        for skip in &self.skips {
            events.push((skip.0, true, *skip));
            events.push((skip.1, false, *skip));
        }
        events.sort_unstable();
        let (mut starts, mut ends) = (BTreeMap::new(), BTreeMap::new());
        for (offset, opens, (start, end)) in events {
            for (open, key) in [(&mut starts, start), (&mut ends, end)] {
                if opens {
                    *open.entry(key).or_insert(0) += 1;
                } else if let Some(count) = open.get_mut(&key) {
                    *count -= 1;
                    if *count == 0 {
                        open.remove(&key);
                    }
                }
            }
            let cover = starts.keys().next_back().copied().zip(ends.keys().next().copied());
            self.covers.push((offset, cover));
        }
    }

    /// What holds at an offset.
    pub fn at(&self, offset: u32) -> Region {
        let behind = self.regions.partition_point(|(start, _)| *start <= offset);
        behind
            .checked_sub(1)
            .and_then(|last| self.regions.get(last))
            .map_or_else(Region::default, |one| one.1)
    }

    /// The innermost start and the nearest end of what may be passed over at an offset.
    fn cover(&self, offset: u32) -> Option<(u32, u32)> {
        let behind = self.covers.partition_point(|(start, _)| *start <= offset);
        self.covers.get(behind.checked_sub(1)?)?.1
    }

    /// Whether there is anything that a jump passes over or a master control switches off.
    pub fn has_parts(&self) -> bool {
        !self.skips.is_empty() || self.regions.iter().any(|(_, region)| region.controls > 0)
    }

    /// Whether a jump may pass over the place at an offset.
    pub fn may_be_skipped(&self, offset: u32) -> bool {
        self.cover(offset).is_some()
    }

    /// Whether a scan may come to the place at an offset more than once.
    pub fn may_be_repeated(&self, offset: u32) -> bool {
        self.loops.iter().any(|(start, end)| *start <= offset && offset < *end)
    }

    /// Whether a jump may pass over `one` in a scan in which `other` is executed.
    pub fn may_skip(&self, one: &Use, other: &Use) -> bool {
        let (one, other) = (one.span.start, other.span.start);
        self.cover(one).is_some_and(|(start, end)| if other < one { start > other } else { end <= other })
    }

    /// Whether the two places belong to parts of which, as far as can be told, one runs at a time.
    pub fn are_apart(&self, one: &Use, other: &Use) -> bool {
        let in_two_units = !self.is_fx && (one.file, one.unit) != (other.file, other.unit);
        if in_two_units {
            return true;
        }
        let (left, right) = (self.at(one.span.start), self.at(other.span.start));
        let in_two_steps = left.step.is_some() && right.step.is_some() && left.step != right.step;
        let in_two_routines = match (left.routine, right.routine) {
            (Some(left), Some(right)) => left != right,
            // A subroutine runs within the main program, an interrupt routine beside it.
            (None, None) => left.section != right.section,
            _ => left.is_interrupt() || right.is_interrupt(),
        };
        in_two_steps || in_two_routines || (self.may_skip(one, other) && self.may_skip(other, one))
    }
}

#[derive(Default)]
struct Unit<'a> {
    labels: FxHashMap<&'a str, u32>,
    jumps: Vec<(u32, Option<&'a smol_str::SmolStr>)>,
}

impl Region {
    fn pass(&mut self, flow: Flow, statement: &Statement<'_>) {
        match flow {
            Flow::Step => self.step = statement.device(),
            Flow::StepsEnd => self.step = None,
            Flow::SectionBegin => self.controls += 1,
            Flow::SectionEnd => self.controls = self.controls.saturating_sub(1),
            Flow::MainEnd | Flow::SubroutineEnd | Flow::InterruptEnd => {
                *self = Region { section: self.section + 1, ..Region::default() };
            }
            _ => {}
        }
    }
}
