//! Who reads and who drives what: the ground for the rules about coils, relays and registers of a whole program.
//!
//! A chunk keeps its accesses beside its milestones, and a page puts those of its chunks in one row with a table of
//! what they name, so that a rule about the whole program goes through numbers and reads no tree.

use super::{Chunk, Operation, Symbol, Tree};
use crate::il::iec::{Direction, IecTree, Item, ItemKind, MentionRole, OperandId, ParameterValue, Run};
use crate::ladder::{Element, ElementKind, PinWire};
use crate::target::iec::OperatorRole;
use crate::target::{Access as Written, Device, DeviceKind, Drive, Flow, Operand, OperandSpec, Wide};
use crate::text::{Span, Spanned, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::sync::Arc;

/// What is done with a device or a variable.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Act {
    /// Its value is read.
    Read,
    /// Its value is read by a contact that conducts while it is off: LDI, `|/|`.
    ReadOff,
    /// An edge of it is read: LDP, `|P|`.
    ReadEdge,
    /// It gets the current result each time that the place is executed: OUT, ST, a drawn coil.
    Coil,
    /// The same for one scan at an edge: PLS, `(P)`.
    Pulse,
    /// SET, S.
    Set,
    /// RST, R, ZRST.
    Reset,
    /// It gets a value: MOV, an output of a block.
    Write,
    /// It is read and gets a value: INC.
    Change,
    /// It is given to something that may read and write it.
    Pass,
    /// A block instance is called.
    Call,
    /// One input of a block instance is set by its operator, `CU C10`, which calls it too.
    CallInput,
    /// It is declared; with an initial value or kept without power, it need not be written.
    Declare,
    /// It is declared with a value of its own.
    DeclareValue,
}

impl Act {
    /// Those that read or may read the value.
    pub const READS: &[Act] =
        &[Act::Read, Act::ReadOff, Act::ReadEdge, Act::Change, Act::Pass, Act::Call, Act::CallInput];

    /// Those that write or may write it.
    pub const WRITES: &[Act] = &[
        Act::Coil,
        Act::Pulse,
        Act::Set,
        Act::Reset,
        Act::Write,
        Act::Change,
        Act::Pass,
        Act::Call,
        Act::CallInput,
    ];

    /// Whether the value is or may be read.
    pub fn reads(self) -> bool {
        Act::READS.contains(&self)
    }

    /// Whether the value is or may be written.
    pub fn writes(self) -> bool {
        Act::WRITES.contains(&self)
    }

    /// Whether the place writes in each scan in which it is executed, on or off.
    pub fn is_coil(self) -> bool {
        matches!(self, Act::Coil | Act::Pulse)
    }
}

/// One place where something is read or driven.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Access {
    /// The number of what is named, in the table of its page.
    pub name: u32,
    /// What is done with it.
    pub act: Act,
    /// What of it is meant.
    pub part: Part,
    /// How many consecutive devices are meant; [`Access::OPEN`] where nobody can tell.
    pub count: u16,
    /// The number of the rung in the page, from 0, counted as [`Size`](super::Size) counts them.
    pub rung: u32,
    /// The number of the chunk in the page.
    pub chunk: u32,
    /// The cells of the name alone, from the start of the page.
    pub span: Span,
}

/// What of a device or variable is meant.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Part {
    /// All of it.
    Whole,
    /// A register and the next as one number of 32 bits.
    Pair,
    /// A bit, a member or an element.
    Inside,
    /// The device that an index register chooses, any of its kind.
    Indexed,
}

impl Access {
    /// The count of what reaches further than can be told.
    pub const OPEN: u16 = u16::MAX;
}

/// The accesses of a page.
#[derive(Debug, Default)]
pub struct Accesses {
    /// What is named: the number of units that started before in the page, 0 for devices, and the name.
    pub names: Box<[(u32, Symbol)]>,
    /// In the order of the text.
    pub all: Box<[Access]>,
    /// Jumps and labels outside of FX programs, in the order of the text.
    pub joints: Box<[Joint]>,
}

/// A place where execution leaves its order, or may come in. FX programs have milestones for it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Joint {
    /// The jump or the label.
    pub span: Span,
    /// How many units have started before it in the page.
    pub pou: u32,
    /// What it is.
    pub kind: JointKind,
}

/// What a joint is.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum JointKind {
    /// A label, folded.
    Label(SmolStr),
    /// A jump to a label.
    Jump(SmolStr),
    /// The unit is left.
    Return,
}

/// What a chunk has of them. Offsets are those of the chunk.
#[derive(Debug, Default)]
pub(super) struct OwnAccesses {
    all: Box<[OwnAccess]>,
    joints: Box<[Joint]>,
}

#[derive(Clone, Debug)]
struct OwnAccess {
    subject: Subject,
    act: Act,
    part: Part,
    count: u16,
    rung: u16,
    span: Span,
}

/// What is named; nearly always it is a device, and a symbol is three times as large.
#[derive(Clone, Debug)]
enum Subject {
    Device(Device),
    Other(Box<Symbol>),
}

impl Subject {
    fn symbol(&self) -> Symbol {
        match self {
            Subject::Device(device) => Symbol::Device(*device),
            Subject::Other(symbol) => Symbol::clone(symbol),
        }
    }
}

/// Offsets are those of the page.
pub(super) fn of_page(chunks: &[Arc<Chunk>]) -> Accesses {
    let mut names: Vec<(u32, Symbol)> = Vec::new();
    // Nearly all names are devices, which are quick to look up.
    let mut devices: FxHashMap<Device, u32> = FxHashMap::default();
    let mut others: FxHashMap<(u32, Symbol), u32> = FxHashMap::default();
    let mut all = Vec::with_capacity(chunks.iter().map(|chunk| chunk.accesses().all.len()).sum());
    let mut joints = Vec::new();
    let (mut start, mut rungs, mut pous) = (0, 0, 0);
    for (number, chunk) in chunks.iter().enumerate() {
        pous += chunk.pou_starts() as u32;
        let own = chunk.accesses();
        for access in &own.all {
            let next = names.len() as u32;
            let name = match &access.subject {
                Subject::Device(device) => *devices.entry(*device).or_insert(next),
                Subject::Other(symbol) => *others.entry((pous, Symbol::clone(symbol))).or_insert(next),
            };
            if name == next {
                let is_device = matches!(access.subject, Subject::Device(_));
                names.push((if is_device { 0 } else { pous }, access.subject.symbol()));
            }
            all.push(Access {
                name,
                act: access.act,
                part: access.part,
                count: access.count,
                rung: rungs + u32::from(access.rung),
                chunk: number as u32,
                span: access.span.shifted(start),
            });
        }
        let moved = |joint: &Joint| Joint { span: joint.span.shifted(start), pou: pous, ..joint.clone() };
        joints.extend(own.joints.iter().map(moved));
        start += chunk.len();
        rungs += chunk.size().rungs as u32;
    }
    Accesses { names: names.into(), all: all.into(), joints: joints.into() }
}

/// Offsets are those of the chunk.
pub(super) fn of_chunk(chunk: &Chunk) -> OwnAccesses {
    let mut own = Collector { text: chunk.text(), all: Vec::new(), joints: Vec::new() };
    match chunk.tree() {
        Tree::Fx(_) => chunk.operations().for_each(|operation| own.operation(&operation, 0)),
        Tree::Ladder(tree) => {
            let label = tree.header.as_ref().and_then(|header| header.label);
            own.joint(label, JointKind::Label);
            let mut boxes = chunk.boxes().iter().peekable();
            let mut number = 0;
            for rung in &tree.rungs {
                while let Some((start, list)) = boxes.next_if(|(start, _)| *start < rung.span.start as usize)
                {
                    own.boxed(*start, list, &mut number);
                }
                rung.graph.elements.iter().for_each(|element| own.element(element, number));
                number = number.saturating_add(1);
            }
            boxes.for_each(|(start, list)| own.boxed(*start, list, &mut number));
        }
        Tree::Iec(tree) => own.iec(tree),
    }
    OwnAccesses { all: own.all.into(), joints: own.joints.into() }
}

struct Collector<'a> {
    text: &'a str,
    all: Vec<OwnAccess>,
    joints: Vec<Joint>,
}

impl Collector<'_> {
    fn joint(&mut self, name: Option<Span>, kind: impl FnOnce(SmolStr) -> JointKind) {
        let Some(span) = name else { return };
        self.joints.push(Joint { span, pou: 0, kind: kind(folded(span.of(self.text))) });
    }

    /// A list in a box, which is a rung of its own.
    fn boxed(&mut self, start: usize, list: &Chunk, rung: &mut u16) {
        let own = list.accesses();
        let moved = |access: &OwnAccess| OwnAccess {
            span: access.span.shifted(start),
            rung: *rung,
            ..access.clone()
        };
        self.all.extend(own.all.iter().map(moved));
        let joints = own.joints.iter();
        self.joints.extend(joints.map(|joint| Joint { span: joint.span.shifted(start), ..joint.clone() }));
        *rung = rung.saturating_add(list.size().rungs as u16);
    }

    fn element(&mut self, element: &Element, rung: u16) {
        match &element.kind {
            ElementKind::Jump(label) => self.joint(Some(*label), JointKind::Jump),
            ElementKind::Return => {
                self.joints.push(Joint { span: element.span, pou: 0, kind: JointKind::Return });
            }
            ElementKind::Block(block) => {
                if let Some(instance) = block.instance {
                    self.variable(instance, instance.of(self.text), Act::Call, rung);
                }
                for (place, operand) in element.operands.iter().enumerate() {
                    let gives = block.outputs.iter().any(|pin| pin.wire == PinWire::Operand(place));
                    self.operand(operand, None, if gives { Act::Write } else { Act::Pass }, 1, rung);
                }
            }
            _ => {
                if let Some(operation) = Operation::of_element(element) {
                    self.operation(&operation, rung);
                }
            }
        }
    }

    fn operation(&mut self, operation: &Operation<'_>, rung: u16) {
        let specs = operation.form.map_or(&[][..], |form| form.instruction.operands);
        let values: Vec<Operand> = operation.operands.iter().map(|operand| operand.value).collect();
        for (place, operand) in operation.operands.iter().enumerate() {
            let Some(spec) = specs.get(place) else {
                self.operand(operand, operation.element, Act::Pass, 1, rung);
                continue;
            };
            let is_edge = operation.form.is_some_and(|form| form.instruction.is_edge_contact());
            let is_inverse = operation.form.is_some_and(|form| form.instruction.is_inverse_contact());
            let act = match act_of(spec) {
                _ if is_edge => Act::ReadEdge,
                Act::Read if is_inverse => Act::ReadOff,
                act => act,
            };
            let gates = operation.form.is_some_and(|form| form.instruction.flow() == Flow::SectionBegin);
            if gates && act.writes() {
                // The relay of a master control is there to be read by what it gates.
                self.operand(operand, None, Act::Read, 1, rung);
            }
            let covered = operation.form.and_then(|form| form.covered(place, &values));
            let count = covered.unwrap_or(Access::OPEN);
            self.operand(operand, operation.element.filter(|_| place == 0), act, count, rung);
            let pair = operation.form.is_some_and(|form| match form.instruction.wide {
                Wide::Only => spec.count == 2,
                _ => form.wide && spec.count == 1,
            });
            if pair && let Some(last) = self.all.last_mut().filter(|last| last.part == Part::Whole) {
                let is_word = matches!(&last.subject, Subject::Device(device) if is_register(*device));
                if is_word && operand.value.device().is_some() {
                    last.part = Part::Pair;
                }
            }
        }
    }

    /// One operand; `count` is how many devices from its own on are meant, or groups of bits.
    fn operand(
        &mut self,
        operand: &Spanned<Operand>,
        element: Option<&Element>,
        act: Act,
        count: u16,
        rung: u16,
    ) {
        let span = operand.span;
        let mut add = |device: Device, act: Act, part: Part, count: u16| {
            self.all.push(OwnAccess { subject: Subject::Device(device), act, part, count, rung, span });
        };
        match operand.value {
            Operand::Device(device) if device.kind.is_pointer() || device.kind == DeviceKind::N => {}
            Operand::Device(device) => add(device, act, Part::Whole, count),
            Operand::Indexed { device, index } => {
                add(index, Act::Read, Part::Whole, 1);
                if !device.kind.is_pointer() {
                    add(device, act, Part::Indexed, Access::OPEN);
                }
            }
            Operand::Nibbles { digits, first, index } => {
                if let Some(index) = index {
                    add(index, Act::Read, Part::Whole, 1);
                    add(first, act, Part::Indexed, Access::OPEN);
                } else {
                    add(first, act, Part::Whole, count.saturating_mul(u16::from(digits) * 4));
                }
            }
            Operand::WordBit { word, .. } => add(word, act, Part::Inside, 1),
            Operand::Constant { index: Some(index), .. } => add(index, Act::Read, Part::Whole, 1),
            Operand::Direct(address) => {
                let subject = Subject::Other(Box::new(Symbol::Direct(address)));
                self.all.push(OwnAccess { subject, act, part: Part::Whole, count: 1, rung, span });
            }
            Operand::Variable => match element {
                Some(element) => self.variable(span, &element.operand_text(0, self.text), act, rung),
                None => self.variable(span, span.of(self.text), act, rung),
            },
            Operand::Constant { index: None, .. }
            | Operand::Literal(_)
            | Operand::Text
            | Operand::Invalid(_) => {}
        }
    }

    fn variable(&mut self, span: Span, path: &str, act: Act, rung: u16) {
        let root = path.split(['.', '[', '^']).next().unwrap_or(path);
        let part = if root.len() == path.len() { Part::Whole } else { Part::Inside };
        let subject = Subject::Other(Box::new(Symbol::variable(root)));
        self.all.push(OwnAccess { subject, act, part, count: 1, rung, span });
    }

    fn iec(&mut self, tree: &IecTree) {
        let mut acts = Vec::with_capacity(tree.operands.len());
        for item in &tree.items {
            self.iec_joint(item);
            iec_acts(tree, item, &mut acts);
        }
        acts.sort_unstable_by_key(|(span, _): &(Span, Act)| *span);
        let act_at = |start: u32| {
            let at = acts.binary_search_by_key(&start, |(span, _)| span.start).ok()?;
            acts.get(at).copied()
        };
        for operand in tree.operands.iter().filter(|operand| matches!(operand.value, Operand::Direct(_))) {
            if let Some((_, act)) = act_at(operand.span.start) {
                self.operand(operand, None, act, 1, 0);
            }
        }
        for mention in tree.mentions(self.text) {
            let own = act_at(mention.span.start);
            let act = match (mention.role, own) {
                (MentionRole::Reads | MentionRole::Writes | MentionRole::Calls, Some((_, act))) => act,
                (MentionRole::DeclaresVariable, own) => own.map_or(Act::Declare, |(_, act)| act),
                (MentionRole::Reads, None) => Act::Read,
                (MentionRole::Writes, None) => Act::Write,
                (MentionRole::Calls, None) => Act::Call,
                _ => continue,
            };
            // The name alone is shown; whether a member is meant, the whole operand tells.
            let path = own.map_or(mention.span, |(span, _)| span).of(self.text);
            self.variable(mention.span, path, act, 0);
        }
        self.all.sort_by_key(|access| access.span);
    }

    fn iec_joint(&mut self, item: &Item) {
        match item.kind {
            ItemKind::Label { name } => self.joint(Some(name), JointKind::Label),
            ItemKind::Jump { label, .. } => self.joint(label, JointKind::Jump),
            ItemKind::Return { word, .. } => {
                self.joints.push(Joint { span: word, pou: 0, kind: JointKind::Return });
            }
            _ => {}
        }
    }
}

/// What an item does with its operands, where that is more than the reader of names tells: the whole of each operand.
fn iec_acts(tree: &IecTree, item: &Item, acts: &mut Vec<(Span, Act)>) {
    let mut add = |id: OperandId, act: Act| acts.push((tree.operand(id).span, act));
    match item.kind {
        ItemKind::Operation { operation, operand: Some(id) } => add(
            id,
            match operation.operator.role {
                OperatorRole::Store => Act::Coil,
                OperatorRole::Latch { on } => {
                    if on {
                        Act::Set
                    } else {
                        Act::Reset
                    }
                }
                _ => Act::Read,
            },
        ),
        ItemKind::Open { operand: Some(id), .. } => add(id, Act::Read),
        ItemKind::InputOperator { instance, .. } => add(instance, Act::CallInput),
        ItemKind::Call { callee, parameters, .. } => {
            if let Some(callee) = callee {
                add(callee, Act::Call);
            }
            self::parameters(tree, parameters, &mut add);
        }
        ItemKind::Function { parameters, .. } => self::parameters(tree, parameters, &mut add),
        ItemKind::Section { declarations, retain, .. } => {
            for declaration in declarations.of(&tree.declarations) {
                let has_value = declaration.initial.is_some() || retain == Some(true);
                let act = if has_value { Act::DeclareValue } else { Act::Declare };
                acts.extend(declaration.names.of(&tree.names).iter().map(|name| (*name, act)));
            }
        }
        _ => {}
    }
}

/// An input may be one that the block writes back to, and in a list without names some are outputs.
fn parameters(tree: &IecTree, parameters: Run, add: &mut impl FnMut(OperandId, Act)) {
    for parameter in parameters.of(&tree.parameters) {
        if let ParameterValue::Operand(id) = parameter.value {
            let gives = matches!(parameter.direction, Direction::Out { .. });
            add(id, if gives { Act::Write } else { Act::Pass });
        }
    }
}

fn act_of(spec: &OperandSpec) -> Act {
    match (spec.access, spec.drive) {
        (Written::Read, _) => Act::Read,
        (Written::ReadWrite, _) => Act::Change,
        (Written::Write, Drive::Coil) => Act::Coil,
        (Written::Write, Drive::Pulse) => Act::Pulse,
        (Written::Write, Drive::Set) => Act::Set,
        (Written::Write, Drive::Reset) => Act::Reset,
        (Written::Write, Drive::Value) => Act::Write,
    }
}

fn is_register(device: Device) -> bool {
    matches!(device.kind, DeviceKind::D | DeviceKind::R)
}
