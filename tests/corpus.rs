//! Programs by other people, which are read where they stand beside the project and are no part of it. What each of
//! them means was found by reading it; three of them say themselves what their outputs do scan by scan.

use crate::ladder_read::dump;
use rungwise::document::{Document, Notation};
use rungwise::ladder::{
    CoilKind, ContactKind, Element, ElementKind, Graph, LadderTree, Rung, VertexId, VertexKind, parse, split,
};
use rungwise::simulate::{Machine, Value, compile};
use rungwise::target::{Model, Target};
use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Says that a test had nothing to read. It writes past the runner, which hides what passing tests print.
pub fn say_skipped(reason: &str) {
    let _ = writeln!(std::io::stderr(), "skipped: {reason}");
}

/// The folder of the ladders, if there is one.
fn folder() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let places = ["../shared/corpus/ladder", "../../shared/corpus/ladder"];
    let found = places.iter().map(|place| root.join(place)).find(|folder| folder.exists());
    if found.is_none() {
        say_skipped(&format!("no folder {}", root.join(places[0]).display()));
    }
    found
}

/// A file without its first line, which says where it comes from.
fn read(folder: &Path, name: &str) -> String {
    let text = std::fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    text[text.find('\n').unwrap() + 1..].to_string()
}

/// The chunks of a program with what they say.
fn chunks(text: &str) -> Vec<(&str, LadderTree)> {
    let mut start = 0;
    let ends = split(text).into_iter();
    let pieces = ends.map(|end| &text[std::mem::replace(&mut start, end)..end]);
    pieces.map(|piece| (piece, parse(piece, Target::of(Model::Iec)))).collect()
}

/// Each file with its rungs as [`dump`] writes them, and what is to be said about the drawing.
const MEANINGS: &[(&str, &[&str])] = &[
    ("ironplc-branches-0.txt", &["L input_a J1", "L input_b J1", "J1 (output) R", "! ragged-drawing: |"]),
    (
        "ironplc-rungs-0.txt",
        &[
            "L start_button J1",
            "L hold J1",
            "J1 (motor_output) R",
            "! ragged-drawing: start_button",
            "! ragged-drawing: motor_output",
            "! ragged-drawing: |",
            "! ragged-drawing: |",
        ],
    ),
    ("vdorr-negative-test01.txt", &["L IX0 ?", "? (QX0) R"]),
    (
        "vdorr-readme.txt",
        &[
            "! unreadable-cell: parser of iec-style plain-text ladder logic diagrams & simple interpreter",
            "! unreadable-cell: ```",
            "! unreadable-cell: Program                           Execution trace",
            "L J1",
            "J1 Start J2",
            "J1 Run J2",
            "J2 /Stop (Run) R",
            "! stray-operand: Start|__▆_____",
            "! unreadable-cell: ```",
            "! unreadable-cell: taken from https",
            "! unreadable-cell: :",
        ],
    ),
    ("vdorr-test00.txt", &[]),
    ("vdorr-test01.txt", &["L IX0 (QX0) R"]),
    (
        "vdorr-test04.txt",
        &[
            "L /%MX0 /%MX1 (S %MX1) R",
            "--",
            "L /%MX0 %MX1 (S %MX0) (R %MX1) R",
            "--",
            "L %MX0 /%MX1 (S %MX1) R",
            "--",
            "L %MX0 %MX1 (R %MX0) (R %MX1) R",
        ],
    ),
    ("vdorr-test05.txt", &["L %MX0 >>MAIN R", "--", "L (S %QX0) (S %MX0) R", "MAIN:", "L %IX0 (%QX0) R"]),
    ("vdorr-test06.txt", &["L J1", "L %I1 J2", "J1 %I0 J2", "J2 (%Q0) R", "J2 (%Q1) R"]),
    ("vdorr-test07.txt", &["L a J1", "L c J1", "J1 (b) R"]),
    ("vdorr-test09.txt", &["L J1", "J1 Start J2", "J1 Run J2", "J2 /Stop (Run) R"]),
    ("vdorr-test10.txt", &["L [> %IW0 300] (%QX0) R"]),
    ("vdorr-test12.txt", &["L a J1", "L (b) R", "J1 /b (c) R"]),
    ("vdorr-test14.txt", &["L a >>main R", "--", "L (a) (b) R", "main:", "L b (/ b) R"]),
    (
        "vdorr-test16.txt",
        &[
            "L [> temp upper_h] (S cool) R",
            "--",
            "L [< temp upper_l] (R cool) R",
            "--",
            "L [> temp lower_h] (R heat) R",
            "--",
            "L [< temp lower_l] (S heat) R",
        ],
    ),
];

#[test]
fn every_ladder_is_read_as_its_author_meant() {
    let Some(folder) = folder() else { return };
    for (name, meaning) in MEANINGS {
        let text = read(&folder, name);
        let mut found = Vec::new();
        for (chunk, tree) in chunks(&text) {
            if let Some(label) = tree.header.as_ref().and_then(|header| header.label) {
                found.push(format!("{}:", label.of(chunk)));
            }
            found.extend(dump(&tree, chunk).lines().map(str::to_string));
        }
        assert_eq!(found, *meaning, "{name}\n{text}");
    }
    // Those of LDmicro's exports are read with their tables, elsewhere.
    let others = std::fs::read_dir(folder).unwrap().filter(|file| {
        let name = file.as_ref().unwrap().file_name().to_string_lossy().into_owned();
        !name.starts_with("ldmicrowebsim") && !MEANINGS.iter().any(|(known, _)| *known == name)
    });
    assert_eq!(others.count(), 0, "files without a meaning here");
}

/// Scans a program: contacts see the values at the start of their rung, outputs act from top to bottom, a jump takes
/// effect at the end of its rung.
fn scan(program: &[(&str, LadderTree)], values: &mut HashMap<String, bool>) {
    let mut wanted: Option<String> = None;
    for (chunk, tree) in program {
        let label = tree.header.as_ref().and_then(|header| header.label).map(|label| label.of(chunk));
        if wanted.is_some() && wanted.as_deref() == label {
            wanted = None;
        }
        for rung in &tree.rungs {
            if wanted.is_none() {
                wanted = run(rung, chunk, values);
            }
        }
    }
}

fn run(rung: &Rung, chunk: &str, values: &mut HashMap<String, bool>) -> Option<String> {
    let graph = &rung.graph;
    let before = values.clone();
    let mut jump = None;
    for id in graph.vertex_ids() {
        let Some(element) = graph.element_at(id).filter(|element| element.is_output()) else { continue };
        let power = graph.incoming(id).any(|arc| power(graph, graph.arc(arc).tail, chunk, &before));
        match &element.kind {
            ElementKind::Coil(kind) => {
                let value = match kind {
                    CoilKind::Plain => power,
                    CoilKind::Negated => !power,
                    other => panic!("{other:?}"),
                };
                values.insert(name(element, chunk), value);
            }
            ElementKind::Jump(label) if power => jump = Some(label.of(chunk).to_string()),
            ElementKind::Jump(_) => {}
            other => panic!("{other:?}"),
        }
    }
    jump
}

/// Whether power leaves a vertex to its right.
fn power(graph: &Graph, id: VertexId, chunk: &str, values: &HashMap<String, bool>) -> bool {
    let before = || graph.incoming(id).any(|arc| power(graph, graph.arc(arc).tail, chunk, values));
    match graph.vertex(id).kind {
        VertexKind::LeftRail => true,
        VertexKind::LooseEnd => false,
        VertexKind::Junction | VertexKind::RightRail => before(),
        VertexKind::Element(element) => {
            let element = graph.element(element);
            let closed = match element.kind {
                ElementKind::Contact(ContactKind::NormallyOpen) => values[&name(element, chunk)],
                ElementKind::Contact(ContactKind::NormallyClosed) => !values[&name(element, chunk)],
                _ => true,
            };
            closed && before()
        }
    }
}

fn name(element: &Element, chunk: &str) -> String {
    element.operand_text(0, chunk).into_owned()
}

/// How many scans with which inputs.
type Steps = &'static [(usize, &'static [(&'static str, bool)])];

/// The test vectors that stand in the files: how many scans with which inputs, and what is watched after each scan.
#[test]
fn programs_do_what_their_authors_expected() {
    let Some(folder) = folder() else { return };
    let vectors: [(&str, Steps, &str, &[u8]); 3] = [
        (
            "vdorr-test01.txt",
            &[(1, &[("IX0", false), ("QX0", false)]), (1, &[("IX0", true)]), (1, &[("IX0", false)])],
            "QX0",
            &[0, 1, 0],
        ),
        (
            "vdorr-test09.txt",
            &[
                (2, &[("Start", false), ("Stop", false), ("Run", false)]),
                (1, &[("Start", true)]),
                (2, &[("Start", false)]),
                (1, &[("Stop", true)]),
                (2, &[("Stop", false)]),
            ],
            "Run",
            &[0, 0, 1, 1, 1, 0, 0, 0],
        ),
        ("vdorr-test14.txt", &[(1, &[("a", false), ("b", false)]), (3, &[])], "b", &[0, 1, 0, 1]),
    ];
    for (file, steps, watched, expected) in vectors {
        let text = read(&folder, file);
        let program = chunks(&text);
        let mut values = HashMap::new();
        let mut seen = Vec::new();
        for (scans, inputs) in steps {
            values.extend(inputs.iter().map(|(name, value)| (name.to_string(), *value)));
            for _ in 0..*scans {
                scan(&program, &mut values);
                seen.push(u8::from(values[watched]));
            }
        }
        assert_eq!(seen, expected, "{file}");
        assert_eq!(simulated(&text, steps, watched), expected, "{file}, simulated");
    }
}

/// What is watched of a program after each scan of the simulated PLC. The vectors themselves stand in braces above the
/// drawing.
fn simulated(text: &str, steps: Steps, watched: &str) -> Vec<u8> {
    let (_, drawn) = text.split_once("\n}\n").expect("vectors before the drawing");
    let document = Document::new(drawn, Notation::Ladder, Target::of(Model::Iec));
    let code = Arc::new(compile(&[&document], false).unwrap_or_else(|problems| panic!("{problems:?}")));
    let variable = |name: &str| code.variable(name).unwrap_or_else(|| panic!("no {name}"));
    let mut machine = Machine::<u8>::new(Arc::clone(&code));
    let mut seen = Vec::new();
    for (scans, inputs) in steps {
        for (name, on) in *inputs {
            machine.write(variable(name), &Value::Bit(*on));
        }
        for _ in 0..*scans {
            machine.scan(seen.len() as i64 * 10_000_000);
            seen.push(u8::from(machine.value(variable(watched), 0) == Value::Bit(true)));
        }
    }
    seen
}
