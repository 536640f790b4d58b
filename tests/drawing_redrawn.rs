//! Fixes that draw a rung in another way: bridges drawn apart, and ways turned round that ran backwards. What they say
//! is evaluated here for each state of the inputs, apart from how they were made.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::ladder::{ContactKind, ElementKind, Graph, VertexId, VertexKind, parse};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, TextEdit};
use std::collections::{BTreeMap, BTreeSet};

fn fx() -> &'static Target {
    Target::of(Model::Fx3u)
}

fn found(drawing: &str, code: &str) -> Vec<Diagnostic> {
    let document = Document::new(drawing, Notation::Ladder, fx());
    let found = check::realtime(&document, &Severities::default());
    found.into_iter().filter(|finding| finding.code == code).collect()
}

/// The drawing after the only fix of the only finding with this code, and the fix's title.
#[track_caller]
fn fixed(drawing: &str, code: &str) -> (String, String) {
    let found = found(drawing, code);
    assert_eq!(found.len(), 1, "{drawing}{found:?}");
    assert_eq!(found[0].fixes.len(), 1, "{drawing}{found:?}");
    let fix = &found[0].fixes[0];
    (TextEdit::apply_all(&fix.edits, drawing), fix.title.render(Language::English))
}

fn names(graph: &Graph, text: &str, wanted: fn(&ElementKind) -> bool) -> BTreeSet<String> {
    let elements = graph.elements.iter().filter(|element| wanted(&element.kind));
    elements.map(|element| element.operand_text(0, text).into_owned()).collect()
}

/// Which coils have power while the contacts of the devices in `on` are actuated.
fn powered(graph: &Graph, text: &str, on: &BTreeSet<&String>) -> BTreeSet<String> {
    let mut powered = BTreeSet::new();
    let mut seen = BTreeSet::new();
    let mut stack: Vec<VertexId> = vec![Graph::LEFT_RAIL];
    while let Some(at) = stack.pop() {
        if !seen.insert(at) {
            continue;
        }
        if let VertexKind::Element(id) = graph.vertex(at).kind {
            let element = graph.element(id);
            let name = element.operand_text(0, text).into_owned();
            match element.kind {
                ElementKind::Contact(kind) if on.contains(&name) != (kind == ContactKind::NormallyOpen) => {
                    continue;
                }
                ElementKind::Coil(_) => _ = powered.insert(name),
                _ => {}
            }
        }
        stack.extend(graph.outgoing(at).map(|arc| graph.arc(arc).head));
    }
    powered
}

/// For each state of the contacts, the coils with power, rung by rung.
fn table(drawing: &str) -> Vec<BTreeMap<Vec<String>, BTreeSet<String>>> {
    let mut start = 0;
    let mut tables = Vec::new();
    for end in rungwise::ladder::split(drawing) {
        let chunk = &drawing[start..end];
        start = end;
        for rung in parse(chunk, fx()).rungs {
            let inputs: Vec<String> =
                names(&rung.graph, chunk, |kind| matches!(kind, ElementKind::Contact(_)))
                    .into_iter()
                    .collect();
            let states = (0..1u32 << inputs.len()).map(|state| {
                let on = inputs.iter().enumerate().filter(|(bit, _)| state >> bit & 1 == 1);
                let on: BTreeSet<&String> = on.map(|(_, name)| name).collect();
                let key: Vec<String> = on.iter().map(|name| name.to_string()).collect();
                (key, powered(&rung.graph, chunk, &on))
            });
            tables.push(states.collect());
        }
    }
    tables
}

pub const BRIDGES: &[&str] = &[
    "\
|   X0                    X1                       Y0  |
+---| |---+---------------| |-----+----------------( )-+
|         |   X2                  |                    |
|         +---| |---+             |                    |
|                   |             |                    |
|   X3              |     X4      |                    |
+---| |-------------+-----| |-----+                    |
",
    // With normally closed contacts, and two outputs that all ways reach.
    "\
|   X0                    X1                       Y0  |
+---|/|---+---------------| |-----+----------------( )-+
|         |   X2                  |                Y1  |
|         +---| |---+             +----------------( )-+
|                   |             |                    |
|   X3              |     X4      |                    |
+---| |-------------+-----|/|-----+                    |
",
];

#[test]
fn a_bridge_is_drawn_apart_and_says_the_same() {
    for bridge in BRIDGES {
        let (drawing, title) = fixed(bridge, "mixed-connection");
        assert_eq!(table(&drawing), table(bridge), "{drawing}");
        assert!(table(bridge).iter().flat_map(BTreeMap::values).any(|coils| !coils.is_empty()));
        assert!(parse(&drawing, fx()).problems.is_empty(), "{drawing}");
        let document = Document::new(&drawing, Notation::Ladder, fx());
        let again = check::realtime(&document, &Severities::default());
        assert!(again.is_empty(), "{drawing}{again:?}");
        assert_eq!(title, "Redraw as branches in parallel; X4 drawn more than once");
    }
}

#[test]
fn ways_to_several_outputs_are_drawn_apart_each() {
    let bridge = [
        BRIDGES[0],
        "\
|                   |                              Y1  |
|                   +------------------------------( )-+
",
    ]
    .concat();
    let (drawing, _) = fixed(&bridge, "mixed-connection");
    assert_eq!(table(&drawing), table(&bridge), "{drawing}");
    // An edge is a contact as any other, asked once in a scan wherever it is drawn.
    let edge = BRIDGES[0].replacen("| |---+---", "|P|---+---", 1);
    let (drawing, _) = fixed(&edge, "mixed-connection");
    assert_eq!(table(&drawing), table(&edge), "{drawing}");
}

#[test]
fn what_cannot_be_proved_is_not_drawn_apart() {
    // An inverter, and an output that changes what the other is driven by.
    let inverter = BRIDGES[0].replace("-| |-----+----------------( )-+", "-| |-----+-[INV]----------( )-+");
    let outputs = [
        &BRIDGES[0].replace("X4", "Y1"),
        "\
|                   |                              Y1  |
|                   +------------------------------( )-+
",
    ]
    .concat();
    let outputs = outputs.replacen("  Y0  |", "  X3  |", 1);
    for drawing in [inverter.as_str(), outputs.as_str()] {
        let found = found(drawing, "mixed-connection");
        assert_eq!(found.len(), 1, "{drawing}");
        assert!(found[0].fixes.is_empty(), "{drawing}{:?}", found[0].fixes);
    }
}

#[test]
fn the_other_rungs_of_a_block_stay_as_they_are() {
    let upper = "|   X7                                             Y7  |\n\
                 +---| |--------------------------------------------( )-+\n";
    let block = format!("{upper}{}", BRIDGES[0]);
    let (drawing, _) = fixed(&block, "mixed-connection");
    assert!(drawing.starts_with(upper), "{drawing}");
    assert_eq!(table(&drawing), table(&block));
}

#[test]
fn a_way_that_runs_backwards_is_turned_round() {
    let backwards = "\
|   X0                                     Y0  |
+---| |-------------+----------------------( )-+
|             X1    |                          |
|         +---| |---+                          |
|         |                                Y1  |
|         +--------------------------------( )-+
";
    let (drawing, title) = fixed(backwards, "reverse-flow");
    let turned = "\
|   X0                                     Y0  |
+---| |---+--------------------------------( )-+
|         |   X1                           Y1  |
|         +---| |--------------------------( )-+
";
    assert_eq!(drawing, turned);
    assert!(title.contains("X1") && title.contains("gets power"), "{title}");
    // What had power has it as before, and the dead coil follows the contacts.
    for (state, coils) in &table(turned)[0] {
        let before = &table(backwards)[0][state];
        assert_eq!(before.contains("Y0"), coils.contains("Y0"));
        assert!(!before.contains("Y1"));
        assert_eq!(coils.contains("Y1"), state.iter().any(|x| x == "X0") && state.iter().any(|x| x == "X1"));
    }
    let wire = "\
|   X0                                     Y0  |
+---| |-------------+----------------------( )-+
|         +---------+                          |
|         |                                Y1  |
|         +--------------------------------( )-+
";
    let (drawing, _) = fixed(wire, "reverse-flow");
    let coils: BTreeSet<String> = ["Y0", "Y1"].map(str::to_string).into();
    assert_eq!(table(&drawing)[0][&vec!["X0".to_string()]], coils);
}

#[test]
fn of_two_ways_backwards_none_is_turned() {
    let two = "\
|   X0                                     Y0  |
+---| |-------------+----------------------( )-+
|             X1    |                          |
|         +---| |---+                          |
|   X2    |                                Y2  |
+---| |---|---------+----------------------( )-+
|         |   X3    |                          |
|         +---| |---+                          |
|         |                                Y1  |
|         +--------------------------------( )-+
";
    for finding in found(two, "reverse-flow") {
        assert!(finding.fixes.is_empty(), "{:?}", finding.fixes);
    }
    assert!(!found(two, "reverse-flow").is_empty());
}
