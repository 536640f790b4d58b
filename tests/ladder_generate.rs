//! Ladder graphs made up for tests: random rungs with elements of every kind, and all small shapes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]

use proptest::prelude::*;
use rungwise::ladder::{
    Block, CoilKind, CompareOperator, ContactKind, Element, ElementKind, Graph, Pin, PinWire, VertexId,
    VertexKind,
};
use rungwise::target::{Form, Model, Operand, Target};
use rungwise::text::{Span, Spanned};

/// A rung as it is put together, before it is a graph.
#[derive(Clone, Debug)]
pub enum Part {
    /// An element of a kind and with operands that the numbers choose.
    Leaf(Leaf),
    /// A bare wire.
    Wire,
    /// Left to right.
    Series(Vec<Part>),
    /// Top to bottom.
    Parallel(Vec<Part>),
}

/// What a leaf is; numbers choose among the kinds and operands of the target.
#[derive(Clone, Debug)]
pub enum Leaf {
    Contact(u8, u16),
    Compare(u8, u16),
    Invert,
    Coil(u8, u16),
    Timer(u16),
    Box(u8, u16),
    Jump(u16),
    Return,
    ConnectorOut(u16),
    ConnectorIn(u16),
    /// A function block with one power line through it.
    Block(u16),
}

/// A graph and the text in which its words stand.
#[derive(Clone, Debug)]
pub struct Generated {
    pub graph: Graph,
    pub words: String,
}

/// Makes the graph of `part` for `target`.
pub fn generate(part: &Part, target: &Target) -> Generated {
    let mut builder =
        Builder { made: Generated { graph: Graph::new(), words: String::new() }, model: target.model };
    builder.add(part, Some(Graph::LEFT_RAIL), Some(Graph::RIGHT_RAIL));
    builder.made
}

struct Builder {
    made: Generated,
    model: Model,
}

impl Builder {
    /// Adds a part from a vertex to another; a vertex not given is made if it is needed. Returns both.
    fn add(&mut self, part: &Part, from: Option<VertexId>, to: Option<VertexId>) -> VertexId {
        let from = from.unwrap_or_else(|| self.made.graph.add_vertex(VertexKind::Junction, &[]));
        match part {
            Part::Wire => {
                let to = to.unwrap_or_else(|| self.made.graph.add_vertex(VertexKind::Junction, &[]));
                self.made.graph.add_arc((from, 0), (to, 0), &[]);
                to
            }
            Part::Leaf(leaf) => {
                let element = self.element(leaf);
                let ends = matches!(leaf, Leaf::Jump(_) | Leaf::Return | Leaf::ConnectorOut(_));
                let starts = matches!(leaf, Leaf::ConnectorIn(_));
                let vertex = self.made.graph.add_element(element);
                if !starts {
                    self.made.graph.add_arc((from, 0), (vertex, 0), &[]);
                }
                match to {
                    Some(to) => {
                        if !ends {
                            self.made.graph.add_arc((vertex, 0), (to, 0), &[]);
                        }
                        to
                    }
                    None => vertex,
                }
            }
            Part::Series(parts) => {
                let mut at = from;
                for (number, part) in parts.iter().enumerate() {
                    let last = number + 1 == parts.len();
                    at = self.add(part, Some(at), if last { to } else { None });
                }
                at
            }
            Part::Parallel(branches) => {
                // An element has one wire on each side, so that branches start at a junction behind it.
                let open = match self.made.graph.vertex(from).kind {
                    VertexKind::Element(_) => {
                        let junction = self.made.graph.add_vertex(VertexKind::Junction, &[]);
                        self.made.graph.add_arc((from, 0), (junction, 0), &[]);
                        junction
                    }
                    _ => from,
                };
                let close = to.unwrap_or_else(|| self.made.graph.add_vertex(VertexKind::Junction, &[]));
                for branch in branches {
                    self.add(branch, Some(open), Some(close));
                }
                close
            }
        }
    }

    fn word(&mut self, word: &str) -> Span {
        let start = self.made.words.len();
        self.made.words.push_str(word);
        self.made.words.push(' ');
        Span::new(start, start + word.len())
    }

    fn operands(&mut self, words: &[String]) -> Vec<Spanned<Operand>> {
        let model = self.model;
        words.iter().map(|word| Spanned::new(Operand::read(word, model), self.word(word))).collect()
    }

    fn element(&mut self, leaf: &Leaf) -> Element {
        let (kind, operands) = match leaf {
            Leaf::Contact(kind, n) => {
                (ElementKind::Contact(CONTACTS[*kind as usize % 4]), vec![self.bit(*n)])
            }
            Leaf::Compare(kind, n) => {
                (ElementKind::Compare(compare(*kind)), vec![self.number(*n), self.number(n / 3)])
            }
            Leaf::Invert => (ElementKind::Invert, vec![]),
            Leaf::Coil(kind, n) => (ElementKind::Coil(COILS[*kind as usize % 6]), vec![self.output(*n)]),
            Leaf::Timer(n) if self.model == Model::Iec => {
                (ElementKind::Coil(CoilKind::Plain), vec![self.output(*n)])
            }
            Leaf::Timer(n) => {
                let device =
                    if n.is_multiple_of(2) { format!("T{}", n % 256) } else { format!("C{}", n % 256) };
                (ElementKind::Coil(CoilKind::Plain), vec![device, format!("K{n}")])
            }
            Leaf::Box(which, n) => return self.instruction(*which, *n),
            Leaf::Jump(n) => (ElementKind::Jump(self.word(&format!("P{n}"))), vec![]),
            Leaf::Return => (ElementKind::Return, vec![]),
            Leaf::ConnectorOut(n) => (ElementKind::ConnectorOut(self.word(&format!("LINK{n}"))), vec![]),
            Leaf::ConnectorIn(n) => (ElementKind::ConnectorIn(self.word(&format!("LINK{n}"))), vec![]),
            Leaf::Block(n) => return self.block(*n),
        };
        self.finish(kind, &operands)
    }

    fn finish(&mut self, kind: ElementKind, operands: &[String]) -> Element {
        let mut element = Element::new(kind, Span::at(0), 0, (0, 0));
        element.operands = self.operands(operands);
        element
    }

    fn instruction(&mut self, which: u8, n: u16) -> Element {
        let boxes: [(&str, Vec<String>); 5] = [
            ("MOV", vec![format!("K{n}"), format!("D{}", n % 8000)]),
            ("ADD", vec![format!("D{}", n % 100), "K-1".to_string(), format!("D{}", n % 200)]),
            ("SET", vec![format!("M{}", n % 500)]),
            ("DMOVP", vec!["H0FF".to_string(), format!("D{}", n % 100)]),
            ("ZRST", vec!["M0".to_string(), format!("M{n}")]),
        ];
        let (mnemonic, operands) = boxes[which as usize % boxes.len()].clone();
        let mnemonic_span = self.word(mnemonic);
        // IEC has no instructions; there a box of an unknown word is read as drawn.
        let form = if self.model == Model::Iec { None } else { Form::named(mnemonic) };
        self.finish(ElementKind::Instruction { form, mnemonic: mnemonic_span }, &operands)
    }

    fn block(&mut self, n: u16) -> Element {
        let pin = |builder: &mut Builder, name: &str, wire: PinWire, row: u32| Pin {
            implied: "",
            name: Some(builder.word(name)),
            negated: n.is_multiple_of(5) && wire == PinWire::Power,
            row,
            wire,
        };
        let instance = Some(self.word(&format!("timer{n}")));
        let type_name = Some(self.word(if n.is_multiple_of(2) { "TON" } else { "CTU_LONG_NAME" }));
        let inputs = vec![pin(self, "IN", PinWire::Power, 2), pin(self, "PT", PinWire::Operand(0), 3)];
        let elapsed = if n.is_multiple_of(3) { PinWire::Open } else { PinWire::Operand(1) };
        let outputs = vec![pin(self, "Q", PinWire::Power, 2), pin(self, "ET", elapsed, 3)];
        let operands = if n.is_multiple_of(3) {
            vec!["D0".to_string()]
        } else {
            vec!["D0".to_string(), "D1".to_string()]
        };
        let block = Block { instance, type_name, rows: Vec::new(), inputs, outputs, ldmicro: None };
        self.finish(ElementKind::Block(Box::new(block)), &operands)
    }

    fn bit(&self, n: u16) -> String {
        match self.model {
            Model::Iec => NAMES[n as usize % NAMES.len()].to_string(),
            _ if n.is_multiple_of(3) => format!("X{:o}", n % 128),
            _ if n % 3 == 1 => format!("M{}", n % 1024),
            _ => format!("T{}", n % 256),
        }
    }

    fn output(&self, n: u16) -> String {
        match self.model {
            Model::Iec => NAMES[n as usize % NAMES.len()].to_string(),
            _ if n.is_multiple_of(2) => format!("Y{:o}", n % 128),
            _ => format!("M{}", n % 1024),
        }
    }

    fn number(&self, n: u16) -> String {
        match self.model {
            Model::Iec if n.is_multiple_of(2) => format!("{n}"),
            Model::Iec => NAMES[n as usize % NAMES.len()].to_string(),
            _ if n.is_multiple_of(2) => format!("K{n}"),
            _ => format!("D{}", n % 8000),
        }
    }
}

const CONTACTS: [ContactKind; 4] =
    [ContactKind::NormallyOpen, ContactKind::NormallyClosed, ContactKind::Rising, ContactKind::Falling];

const COILS: [CoilKind; 6] =
    [CoilKind::Plain, CoilKind::Negated, CoilKind::Set, CoilKind::Reset, CoilKind::Rising, CoilKind::Falling];

/// Names of one cell to many, also in letters that are two cells wide.
const NAMES: [&str; 12] = [
    "a",
    "go",
    "run",
    "Lamp",
    "Motor_1",
    "StartButton",
    "EmergencyStopCircuitClosed",
    "%IX0.0",
    "%QX1.7",
    "启动按钮",
    "Ventil_Zulauf_größer",
    "T1.Q",
];

fn compare(kind: u8) -> CompareOperator {
    let wide = kind % 2 == 1;
    match kind / 2 % 6 {
        0 => CompareOperator::Equal { wide },
        1 => CompareOperator::NotEqual { wide },
        2 => CompareOperator::Greater { wide },
        3 => CompareOperator::Less { wide },
        4 => CompareOperator::GreaterOrEqual { wide },
        _ => CompareOperator::LessOrEqual { wide },
    }
}

/// A random condition of up to about `size` elements.
pub fn condition(size: u32) -> impl Strategy<Value = Part> {
    let leaf = prop_oneof![
        12 => (any::<u8>(), any::<u16>()).prop_map(|(kind, n)| Part::Leaf(Leaf::Contact(kind, n))),
        2 => (any::<u8>(), any::<u16>()).prop_map(|(kind, n)| Part::Leaf(Leaf::Compare(kind, n))),
        1 => Just(Part::Leaf(Leaf::Invert)),
        1 => any::<u16>().prop_map(|n| Part::Leaf(Leaf::Block(n))),
    ];
    leaf.prop_recursive(8, size, 6, |inner| {
        let wire = inner.clone().prop_map(|part| Part::Parallel(vec![part, Part::Wire]));
        prop_oneof![
            8 => prop::collection::vec(inner.clone(), 2..5).prop_map(Part::Series),
            8 => prop::collection::vec(inner, 2..6).prop_map(Part::Parallel),
            1 => wire,
        ]
    })
}

/// A random output, perhaps behind a condition of its own.
fn output() -> impl Strategy<Value = Part> {
    let leaf = prop_oneof![
        8 => (any::<u8>(), any::<u16>()).prop_map(|(kind, n)| Part::Leaf(Leaf::Coil(kind, n))),
        3 => any::<u16>().prop_map(|n| Part::Leaf(Leaf::Timer(n))),
        4 => (any::<u8>(), any::<u16>()).prop_map(|(kind, n)| Part::Leaf(Leaf::Box(kind, n))),
        1 => any::<u16>().prop_map(|n| Part::Leaf(Leaf::Jump(n))),
        1 => Just(Part::Leaf(Leaf::Return)),
        1 => any::<u16>().prop_map(|n| Part::Leaf(Leaf::ConnectorOut(n))),
    ];
    let coil = (any::<u8>(), any::<u16>()).prop_map(|(kind, n)| Part::Leaf(Leaf::Coil(kind, n)));
    prop_oneof![
        6 => leaf.clone(),
        2 => (condition(8), leaf.clone()).prop_map(|(condition, leaf)| Part::Series(vec![condition, leaf])),
        1 => (coil, leaf).prop_map(|(coil, leaf)| Part::Series(vec![coil, leaf])),
    ]
}

/// A random rung of up to about `size` elements: a condition, and outputs in parallel, some behind further branches.
pub fn rung(size: u32) -> impl Strategy<Value = Part> {
    let outputs = output().prop_recursive(3, size / 4 + 2, 4, |inner| {
        let branches = prop::collection::vec(inner, 2..5).prop_map(Part::Parallel);
        prop_oneof![branches.clone(), (condition(6), branches).prop_map(|(c, b)| Part::Series(vec![c, b]))]
    });
    let start = prop_oneof![
        10 => condition(size).prop_map(Some),
        1 => any::<u16>().prop_map(|n| Some(Part::Leaf(Leaf::ConnectorIn(n)))),
        1 => Just(None),
    ];
    (start, outputs).prop_map(|(start, outputs)| match start {
        Some(start) => Part::Series(vec![start, outputs]),
        None => outputs,
    })
}

/// A random rung of some eighty to 120 elements: several conditions side by side, then several in a row, then outputs.
pub fn large_rung() -> impl Strategy<Value = Part> {
    let some = || prop::collection::vec(condition(24), 4..12);
    (some(), some(), rung(24)).prop_map(|(beside, row, rest)| {
        let beside = beside.into_iter().map(|part| Part::Series(vec![part.clone(), part]));
        // A line that starts at a connector starts nowhere else.
        let mut rest = if let Part::Series(parts) = rest { parts } else { vec![rest] };
        rest.retain(|part| !matches!(part, Part::Leaf(Leaf::ConnectorIn(_))));
        Part::Series([vec![Part::Parallel(beside.collect())], row, rest].concat())
    })
}

/// All series-parallel conditions of exactly `contacts` contacts, each once, closed by a coil.
pub fn all_rungs(contacts: usize) -> Vec<Part> {
    let mut rungs = Vec::new();
    for shape in all_shapes(contacts) {
        let mut number = 0;
        let condition = numbered(&shape, &mut number);
        rungs.push(Part::Series(vec![condition, Part::Leaf(Leaf::Coil(0, 0))]));
    }
    rungs
}

fn numbered(part: &Part, number: &mut u16) -> Part {
    let mut all = |parts: &[Part]| parts.iter().map(|part| numbered(part, number)).collect();
    match part {
        Part::Series(parts) => Part::Series(all(parts)),
        Part::Parallel(parts) => Part::Parallel(all(parts)),
        _ => {
            *number += 1;
            Part::Leaf(Leaf::Contact(*number as u8 % 2, *number * 3))
        }
    }
}

/// All shapes of `leaves` leaves in which series and parallel alternate.
pub fn all_shapes(leaves: usize) -> Vec<Part> {
    if leaves == 1 {
        return vec![Part::Leaf(Leaf::Contact(0, 0))];
    }
    let mut shapes = Vec::new();
    for split in splits(leaves, leaves - 1) {
        let mut rows: Vec<Vec<Part>> = vec![Vec::new()];
        for size in split {
            let choices = all_shapes(size);
            rows = rows
                .into_iter()
                .flat_map(|row| {
                    choices.iter().map(move |choice| [row.clone(), vec![choice.clone()]].concat())
                })
                .collect();
        }
        for row in rows {
            if !row.iter().any(|part| matches!(part, Part::Series(_))) {
                shapes.push(Part::Series(row.clone()));
            }
            if !row.iter().any(|part| matches!(part, Part::Parallel(_))) {
                shapes.push(Part::Parallel(row));
            }
        }
    }
    shapes
}

/// All ways to write `total` as an ordered sum of parts from 1 to `largest`.
fn splits(total: usize, largest: usize) -> Vec<Vec<usize>> {
    if total == 0 {
        return vec![Vec::new()];
    }
    let firsts = 1..=total.min(largest);
    firsts
        .flat_map(|first| {
            splits(total - first, largest).into_iter().map(move |rest| [vec![first], rest].concat())
        })
        .collect()
}

#[test]
fn small_shapes_are_counted_as_the_large_schroeder_numbers_say() {
    // Series-parallel shapes with ordered leaves: 1, 2, 6, 22, 90 (OEIS A006318).
    let counts: Vec<usize> = (1..=5).map(|leaves| all_shapes(leaves).len()).collect();
    assert_eq!(counts, [1, 2, 6, 22, 90]);
}
