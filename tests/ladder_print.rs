//! Ladder graphs: their shape, their drawing, and what drawing and reading make of them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]

use crate::ladder_generate::{Generated, Part, all_rungs, generate, large_rung, rung};
use expect_test::{Expect, expect};
use proptest::prelude::*;
use rungwise::ladder::reduce::{NotSeriesParallel, Shape, reduce};
use rungwise::ladder::{
    ContactKind, Element, ElementKind, Graph, LadderTree, Style, StyleKind, VertexId, VertexKind, format,
    parse, print,
};
use rungwise::target::{Device, DeviceKind, Operand, Target};
use rungwise::text::{Span, Spanned, cell_width};

const STYLES: [StyleKind; 3] = [StyleKind::Iec, StyleKind::Brackets, StyleKind::Unicode];

fn fx() -> &'static Target {
    Target::named("fx2n").unwrap()
}

fn iec() -> &'static Target {
    Target::named("iec").unwrap()
}

fn style(kind: StyleKind) -> Style {
    Style { kind, ..Style::default() }
}

pub(crate) fn drawn(made: &Generated, style: &Style) -> String {
    let shape = reduce(&made.graph).unwrap_or_else(|why| panic!("{why:?} for {made:?}"));
    print(&shape, &made.graph, &made.words, style).unwrap_or_else(|| panic!("no drawing of {shape:?}"))
}

/// The one rung that `text` must be.
fn read_one(text: &str, target: &Target) -> LadderTree {
    let tree = parse(text, target);
    assert!(tree.problems.is_empty(), "{:?} in\n{text}", tree.problems);
    assert_eq!(tree.rungs.len(), 1, "rungs in\n{text}");
    tree
}

/// Drawn in every style and read again, the logic is the same.
fn check_reading_back(part: &Part, target: &Target) {
    let made = generate(part, target);
    let logic = made.graph.logic_text(&made.words);
    for kind in STYLES {
        let text = drawn(&made, &style(kind));
        check_alignment(&text);
        let tree = read_one(&text, target);
        assert_eq!(tree.rungs[0].graph.logic_text(&text), logic, "{kind:?}\n{text}");
    }
}

/// Every line ends at the right rail, in one column for all, and none in a blank.
fn check_alignment(text: &str) {
    let mut rail = None;
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        assert_eq!(line.trim_end(), line, "trailing blank in\n{text}");
        assert!(line.starts_with(['|', '+', '│', '├']), "no left rail in\n{text}");
        assert!(line.ends_with(['|', '+', '│', '┤']), "no right rail in\n{text}");
        let cells: usize = line.chars().map(cell_width).sum();
        assert_eq!(*rail.get_or_insert(cells), cells, "ragged rail in\n{text}");
    }
}

// The shape.

/// A graph of contacts `X0`, `X1` … between numbered nodes: 0 is the left rail, 1 the right rail, others junctions.
/// A contact of `None` is a bare wire.
fn contacts_between(nodes: u32, edges: &[(u32, Option<u32>, u32)]) -> Graph {
    let mut graph = Graph::new();
    for node in 2..nodes {
        // Each junction is three cells high, at offsets that tell it from others.
        let cells: Vec<Span> = (0..3).map(|row| Span::at((node * 10 + row) as usize)).collect();
        graph.add_vertex(VertexKind::Junction, &cells);
    }
    for (tail, contact, head) in edges {
        let (mut tail, head) = (VertexId(*tail), VertexId(*head));
        if let Some(number) = contact {
            let mut element =
                Element::new(ElementKind::Contact(ContactKind::NormallyOpen), Span::at(0), 0, (0, 0));
            let device = Operand::Device(Device::new(DeviceKind::X, *number));
            element.operands.push(Spanned::new(device, Span::at(0)));
            let vertex = graph.add_element(element);
            graph.add_arc((tail, 0), (vertex, 0), &[]);
            tail = vertex;
        }
        graph.add_arc((tail, 0), (head, 0), &[]);
    }
    graph
}

/// The shape in short: `X0(X1|X2)` for a contact in series with two in parallel.
fn short(shape: &Shape, graph: &Graph) -> String {
    let all = |parts: &[Shape]| parts.iter().map(|part| short(part, graph)).collect::<Vec<_>>();
    match shape {
        Shape::Wire => "-".to_string(),
        Shape::Series(parts) => all(parts).join(" "),
        Shape::Parallel(parts) => format!("({})", all(parts).join("|")),
        Shape::Element(id) => {
            graph.element(*id).device().map_or("?".to_string(), |device| device.to_string())
        }
        Shape::Block(block) => format!("block {:?}", block.element),
    }
}

fn short_of(graph: &Graph) -> String {
    short(&reduce(graph).unwrap(), graph)
}

#[test]
fn series_and_parallel_are_reduced_in_drawn_order() {
    let graph = contacts_between(
        4,
        &[(0, Some(0), 2), (0, Some(1), 2), (2, Some(2), 3), (3, Some(3), 1), (3, Some(4), 1)],
    );
    assert_eq!(short_of(&graph), "(X0|X1) X2 (X3|X4)");
}

#[test]
fn junctions_joined_by_bare_wire_are_one() {
    // X0 into a chain of junctions: 2 feeds X1 and 3, and 3 feeds X2 and X3; 4 collects two and feeds 5.
    let chained = contacts_between(
        6,
        &[
            (0, Some(0), 2),
            (2, Some(1), 5),
            (2, None, 3),
            (3, Some(2), 4),
            (3, Some(3), 4),
            (4, None, 5),
            (5, Some(4), 1),
        ],
    );
    let plain = contacts_between(
        4,
        &[(0, Some(0), 2), (2, Some(1), 3), (2, Some(2), 3), (2, Some(3), 3), (3, Some(4), 1)],
    );
    assert_eq!(short_of(&chained), "X0 (X1|X2|X3) X4");
    assert_eq!(short_of(&plain), short_of(&chained));
    assert!(chained.same_logic("", &plain, ""));
}

#[test]
fn graphs_of_different_logic_are_told_apart() {
    let base = [(0, Some(0), 2), (0, Some(1), 2), (2, Some(2), 1)];
    let graph = contacts_between(3, &base);
    let changed = |at: usize, edge| {
        let mut edges = base;
        edges[at] = edge;
        contacts_between(3, &edges)
    };
    assert!(graph.same_logic("", &contacts_between(3, &base), ""));
    for other in [
        changed(0, (0, Some(7), 2)),
        changed(0, (0, None, 2)),
        changed(1, (0, Some(1), 1)),
        contacts_between(3, &[base[1], base[0], base[2]]),
        contacts_between(3, &base[1..]),
    ] {
        assert!(!graph.same_logic("", &other, ""), "{}", other.logic_text(""));
    }
}

#[test]
fn wires_beside_contacts_stay_as_short_circuits() {
    let graph = contacts_between(3, &[(0, Some(0), 2), (2, Some(1), 1), (2, None, 1)]);
    assert_eq!(short_of(&graph), "X0 (X1|-)");
    assert_eq!(short_of(&contacts_between(2, &[(0, None, 1)])), "-");
}

#[test]
fn branches_sort_by_the_drawing_not_by_the_order_of_reduction() {
    // The middle branch is a chain and is reduced after its neighbours.
    let graph = contacts_between(
        6,
        &[
            (0, Some(9), 2),
            (2, Some(0), 3),
            (2, Some(1), 4),
            (2, Some(2), 3),
            (4, Some(3), 5),
            (5, Some(4), 3),
            (3, Some(8), 1),
        ],
    );
    assert_eq!(short_of(&graph), "X11 (X0|X1 X3 X4|X2) X10");
}

#[test]
fn a_bridge_is_named_by_its_vertical_wire() {
    let bridged =
        [(0, Some(0), 2), (0, Some(1), 3), (2, Some(2), 4), (2, None, 3), (3, Some(3), 4), (4, Some(4), 1)];
    let graph = contacts_between(5, &bridged);
    let Err(NotSeriesParallel::Bridge(bridge)) = reduce(&graph) else { panic!("{:?}", reduce(&graph)) };
    assert_eq!((bridge.from, bridge.to), (Some(VertexId(2)), Some(VertexId(3))));
    assert_eq!(bridge.vertical, graph.cells(graph.vertex(VertexId(3)).cells));
    assert!(bridge.elements.is_empty());
    assert_eq!(bridge.arcs.len(), 1);
    assert_eq!(graph.arc(bridge.arcs[0]).tail, VertexId(2));
    let names: Vec<String> =
        bridge.beside.iter().map(|id| graph.element(*id).device().unwrap().to_string()).collect();
    assert_eq!(names, ["X0", "X1", "X2", "X3"]);
    let mended: Vec<_> = bridged.into_iter().filter(|(tail, _, head)| (*tail, *head) != (2, 3)).collect();
    assert_eq!(short_of(&contacts_between(5, &mended)), "(X0 X2|X1 X3) X4");
}

#[test]
fn a_bridge_with_a_contact_on_it_is_found_inside_a_large_rung() {
    // Parallel parts before, beside and behind; the bridge is X7, from junction 4 to junction 5.
    let graph = contacts_between(
        8,
        &[
            (0, Some(0), 2),
            (0, Some(1), 2),
            (2, Some(2), 3),
            (3, Some(3), 4),
            (3, Some(4), 5),
            (4, Some(5), 6),
            (4, Some(6), 6),
            (4, Some(7), 5),
            (5, Some(10), 6),
            (6, Some(11), 7),
            (6, Some(12), 7),
            (7, Some(13), 1),
        ],
    );
    let Err(NotSeriesParallel::Bridge(bridge)) = reduce(&graph) else { panic!("{:?}", reduce(&graph)) };
    assert_eq!((bridge.from, bridge.to), (Some(VertexId(4)), Some(VertexId(5))));
    assert_eq!(bridge.elements.len(), 1);
    assert_eq!(graph.element(bridge.elements[0]).device().unwrap().to_string(), "X7");
}

#[test]
fn a_bent_bridge_is_named_by_its_bend() {
    let mut graph = contacts_between(
        5,
        &[(0, Some(0), 2), (0, Some(1), 3), (2, Some(2), 4), (3, Some(3), 4), (4, Some(4), 1)],
    );
    let cells = [Span::at(500), Span::at(501), Span::at(502)];
    let bend = graph.add_vertex(VertexKind::Junction, &cells);
    graph.add_arc((VertexId(2), 0), (bend, 0), &[]);
    graph.add_arc((bend, 0), (VertexId(3), 0), &[]);
    let Err(NotSeriesParallel::Bridge(bridge)) = reduce(&graph) else { panic!("{:?}", reduce(&graph)) };
    assert_eq!(bridge.vertical, cells);
    assert_eq!(bridge.arcs.len(), 2);
}

#[test]
fn two_bridges_still_name_one_that_runs_across() {
    let graph = contacts_between(
        7,
        &[
            (0, Some(0), 2),
            (0, Some(1), 3),
            (2, Some(2), 4),
            (2, None, 3),
            (3, Some(3), 4),
            (4, Some(4), 5),
            (4, Some(5), 6),
            (5, Some(6), 1),
            (5, None, 6),
            (6, Some(7), 1),
        ],
    );
    let Err(NotSeriesParallel::Bridge(bridge)) = reduce(&graph) else { panic!("{:?}", reduce(&graph)) };
    let ends = (bridge.from.unwrap().0, bridge.to.unwrap().0);
    assert!([(2, 3), (5, 6)].contains(&ends), "{ends:?}");
}

#[test]
fn open_circuits_are_not_reduced() {
    let mut loose = contacts_between(3, &[(0, Some(0), 2), (2, Some(1), 1)]);
    let end = loose.add_vertex(VertexKind::LooseEnd, &[]);
    loose.add_arc((VertexId(2), 0), (end, 0), &[]);
    assert_eq!(reduce(&loose), Err(NotSeriesParallel::OpenCircuit(end)));
    let unfed = contacts_between(3, &[(0, Some(0), 1), (2, Some(1), 1)]);
    assert_eq!(reduce(&unfed), Err(NotSeriesParallel::OpenCircuit(VertexId(2))));
    assert_eq!(reduce(&Graph::new()), Err(NotSeriesParallel::Empty));
    assert_eq!(reduce(&Graph::default()), Err(NotSeriesParallel::Empty));
}

#[test]
fn deep_nests_are_refused_and_wide_ones_drawn() {
    // Each level: a contact beside the series of a contact and the next level.
    let nest = |depth: u32| {
        let mut edges = Vec::new();
        let end = depth + 2;
        for level in 0..depth {
            let from = if level == 0 { 0 } else { level + 1 };
            edges.push((from, Some(level), end));
            edges.push((from, Some(level), level + 2));
        }
        edges.push((depth + 1, Some(0), end));
        edges.push((end, Some(1), 1));
        contacts_between(depth + 3, &edges)
    };
    assert_eq!(reduce(&nest(10_000)), Err(NotSeriesParallel::TooDeep));
    let graph = nest(90);
    let shape = reduce(&graph).unwrap();
    assert_eq!(shape.elements().len(), 2 * 90 + 2);

    let branches: Vec<_> = (0..500).map(|branch| (0, Some(branch), 2)).collect();
    let graph = contacts_between(3, &[branches, vec![(2, Some(0), 1)]].concat());
    let Shape::Series(parts) = reduce(&graph).unwrap() else { panic!() };
    let Shape::Parallel(branches) = &parts[0] else { panic!() };
    assert_eq!(branches.len(), 500);
}

#[test]
fn long_series_and_wide_parallels_take_linear_time() {
    let long: Vec<_> = (0..50_000u32).map(|n| (if n == 0 { 0 } else { n + 1 }, Some(n % 8), n + 2)).collect();
    let graph = contacts_between(50_002, &[long, vec![(50_001, None, 1)]].concat());
    let Shape::Series(parts) = reduce(&graph).unwrap() else { panic!() };
    assert_eq!(parts.len(), 50_000);
    let wide: Vec<_> = (0..50_000u32).map(|n| (0, Some(n % 8), 2)).collect();
    let graph = contacts_between(3, &[wide, vec![(2, Some(0), 1)]].concat());
    assert!(reduce(&graph).is_ok());
    assert!(graph.same_logic("", &graph.clone(), ""));
}

// The drawing.

/// The examples of the notation page.
const CANONICAL: &str = "\
(* Start and stop with seal-in *)
|   X0        X1                         Y0  |
+---| |---+---|/|------------------------( )-+
|   Y0    |                                  |
+---| |---+                                  |

|   Y0      X2                         T0 K50|
+---| |-----| |---+----------------------( )-+
|                 |                          |
|                 +--[MOV K10 D0]------------+
";

/// The same as someone might type it.
const TYPED: &str = "\
(* Start and stop with seal-in *)
|  X0      X1         Y0
|--] [--+--]/[--------( )
|  Y0   |
|--] [--+

|  Y0   X2     
|--| |--| |--+--(T0 K50)--|
|            |
|            +--[MOV K10,D0]--|
";

const IN_BRACKETS: &str = "\
(* Start and stop with seal-in *)
+--[X0]--+--[/X1]------------------------(Y0)-+
|        |                                    |
+--[Y0]--+                                    |

+--[Y0]---[X2]--+--------------------(T0 K50)-+
|               |                             |
|               +--[MOV K10 D0]---------------+
";

const IN_UNICODE: &str = "\
(* Start and stop with seal-in *)
│   X0        X1                           Y0  │
├───┤ ├───┬───┤/├──────────────────────────( )─┤
│   Y0    │                                    │
├───┤ ├───┘                                    │

│   Y0      X2                           T0 K50│
├───┤ ├─────┤ ├───┬────────────────────────( )─┤
│                 │                            │
│                 └──[MOV K10 D0]──────────────┤
";

#[test]
fn the_examples_of_the_notation_are_canonical() {
    let as_shown = Style { kind: StyleKind::Iec, width: 46 };
    assert_eq!(format(CANONICAL, fx(), &as_shown), CANONICAL);
    assert_eq!(format(TYPED, fx(), &as_shown), CANONICAL);
    assert_eq!(format(TYPED, fx(), &Style { kind: StyleKind::Brackets, width: 47 }), IN_BRACKETS);
    assert_eq!(format(TYPED, fx(), &style(StyleKind::Unicode)), IN_UNICODE);
    for text in [CANONICAL, IN_BRACKETS, IN_UNICODE] {
        assert_eq!(format(text, fx(), &as_shown), CANONICAL);
    }
}

/// A drawing by hand in every style, and each of these formatted again in every style.
fn check_styles(typed: &str, target: &Target, expected: [Expect; 3]) {
    let formatted = STYLES.map(|kind| format(typed, target, &style(kind)));
    for (text, expected) in formatted.iter().zip(expected) {
        expected.assert_eq(text);
    }
    for text in &formatted {
        check_alignment(text);
        for (kind, other) in STYLES.into_iter().zip(&formatted) {
            assert_eq!(&format(text, target, &style(kind)), other);
        }
    }
}

#[test]
fn every_element_has_its_symbol() {
    let typed = "\
|   X0   X1   X2   X3                          Y0
+--| |--|/|--|P|--|N|--[INV]--+--[>= D0 K10]--( )
|                             |                    Y1
|                             +--[D<> D2 D4]-------(/)
|                             |  M0
|                             +--(S)
|                             |  M1
|                             +--(R)
|                             |  M2
|                             +--(P)
|                             |  M3
|                             +--(N)
|                             |
|                             +-(C200 K-123456)
|                             |
|                             +--[DMOVP D0 D2]
";
    check_styles(
        typed,
        fx(),
        [
            expect![[r#"
        |   X0      X1      X2      X3                              Y0  |
        +---| |-----|/|-----|P|-----|N|----[INV]--+--[>= D0 K10]----( )-+
        |                                         |                 Y1  |
        |                                         +--[D<> D2 D4]----(/)-+
        |                                         |                 M0  |
        |                                         +-----------------(S)-+
        |                                         |                 M1  |
        |                                         +-----------------(R)-+
        |                                         |                 M2  |
        |                                         +-----------------(P)-+
        |                                         |                 M3  |
        |                                         +-----------------(N)-+
        |                                         |        C200 K-123456|
        |                                         +-----------------( )-+
        |                                         |                     |
        |                                         +--[DMOVP D0 D2]------+
    "#]],
            expect![[r#"
        +--[X0]---[/X1]---[P X2]---[N X3]---[INV]--+--[>= D0 K10]----(Y0)-+
        |                                          |                      |
        |                                          +--[D<> D2 D4]---(/Y1)-+
        |                                          |                      |
        |                                          +---------------(S M0)-+
        |                                          |                      |
        |                                          +---------------(R M1)-+
        |                                          |                      |
        |                                          +---------------(P M2)-+
        |                                          |                      |
        |                                          +---------------(N M3)-+
        |                                          |                      |
        |                                          +------(C200 K-123456)-+
        |                                          |                      |
        |                                          +--[DMOVP D0 D2]-------+
    "#]],
            expect![[r#"
        │   X0      X1      X2      X3                              Y0  │
        ├───┤ ├─────┤/├─────┤P├─────┤N├────[INV]──┬──[>= D0 K10]────( )─┤
        │                                         │                 Y1  │
        │                                         ├──[D<> D2 D4]────(/)─┤
        │                                         │                 M0  │
        │                                         ├─────────────────(S)─┤
        │                                         │                 M1  │
        │                                         ├─────────────────(R)─┤
        │                                         │                 M2  │
        │                                         ├─────────────────(P)─┤
        │                                         │                 M3  │
        │                                         ├─────────────────(N)─┤
        │                                         │        C200 K-123456│
        │                                         ├─────────────────( )─┤
        │                                         │                     │
        │                                         └──[DMOVP D0 D2]──────┤
    "#]],
        ],
    );
}

#[test]
fn lines_start_and_end_at_connectors_and_jumps() {
    let typed = "\
|   X0
+---| |---+-->>P10
|         |
|         +--<RETURN>
|         |   X3
|         +---| |--->LINK>

|           X1        Y0
|  >LINK>---| |---+---( )-+
|   M0            |
+---| |-----------+
";
    check_styles(
        typed,
        fx(),
        [
            expect![[r#"
        |   X0                                         |
        +---| |---+------------------------------>>P10 |
        |         |                                    |
        |         +---------------------------<RETURN> |
        |         |   X3                               |
        |         +---| |----------------------->LINK> |

        |            X1                            Y0  |
        |  >LINK>----| |---+-----------------------( )-+
        |   M0             |                           |
        +---| |------------+                           |
    "#]],
            expect![[r#"
        +--[X0]--+------------------------------->>P10 |
        |        |                                     |
        |        +----------------------------<RETURN> |
        |        |                                     |
        |        +--[X3]------------------------>LINK> |

        |  >LINK>---[X1]--+-----------------------(Y0)-+
        |                 |                            |
        +--[M0]-----------+                            |
    "#]],
            expect![[r#"
        │   X0                                         │
        ├───┤ ├───┬──────────────────────────────>>P10 │
        │         │                                    │
        │         ├───────────────────────────<RETURN> │
        │         │   X3                               │
        │         └───┤ ├───────────────────────>LINK> │

        │            X1                            Y0  │
        │  >LINK>────┤ ├───┬───────────────────────( )─┤
        │   M0             │                           │
        ├───┤ ├────────────┘                           │
    "#]],
        ],
    );
}

#[test]
fn function_blocks_keep_their_pins_and_wires() {
    let typed = "\
|               T1
|             +-----+
|   a         | TON |         Lamp
+---| |-------|IN  Q|---------( )---+
|     T#5s----|PT ET|---elapsed
|             +-----+

|                 c1
|               +-------+
|   Sensor      |  CTU  |      Full
+---| |---------|CU    Q|------( )-+
|   Reset       |       |
+---| |---+-----|R    CV|--count
|   Init  |     |       |
+---|/|---+     |       |
|          10---|PV     |
|               +-------+

|            s
|          +----+
|   a      | SR |       b    Lamp
+---| |----|S1 Q|-------| |---( )-+
|   c      |    |      Horn
+---| |---O|R NQ|---+---(S)------+
|          +----+   |            |
|                   |  Other     |
|                   +--( )-------+
";
    check_styles(
        typed,
        iec(),
        [
            expect![[r#"
        |                 T1                           |
        |               +------+                       |
        |    a          | TON  |                  Lamp |
        +---| |---------|IN   Q|-------------------( )-+
        |         T#5s--|PT  ET|--elapsed              |
        |               +------+                       |

        |                 c1                           |
        |               +------+                       |
        | Sensor        | CTU  |                  Full |
        +---| |---------|CU   Q|-------------------( )-+
        |  Reset        |    CV|--count                |
        +---| |---+-----|R     |                       |
        |  Init   | 10--|PV    |                       |
        +---|/|---+     +------+                       |

        |             s                                |
        |          +------+                            |
        |    a     |  SR  |        b              Lamp |
        +---| |----|S1   Q|-------| |--------------( )-+
        |    c     |      |                       Horn |
        +---| |---O|R   NQ|---+--------------------(S)-+
        |          +------+   |                   Other|
        |                     +--------------------( )-+
    "#]],
            expect![[r#"
        |               T1                             |
        |             +------+                         |
        |             | TON  |                         |
        +--[a]--------|IN   Q|------------------(Lamp)-+
        |       T#5s--|PT  ET|--elapsed                |
        |             +------+                         |

        |                    c1                        |
        |                  +------+                    |
        |                  | CTU  |                    |
        +--[Sensor]--------|CU   Q|-------------(Full)-+
        |                  |    CV|--count             |
        +--[Reset]---+-----|R     |                    |
        |            | 10--|PV    |                    |
        +--[/Init]---+     +------+                    |

        |           s                                  |
        |        +------+                              |
        |        |  SR  |                              |
        +--[a]---|S1   Q|------[b]--------------(Lamp)-+
        |        |      |                              |
        +--[c]--O|R   NQ|---+-----------------(S Horn)-+
        |        +------+   |                          |
        |                   +------------------(Other)-+
    "#]],
            expect![[r#"
        │                 T1                           │
        │               ┌──────┐                       │
        │    a          │ TON  │                  Lamp │
        ├───┤ ├─────────│IN   Q│───────────────────( )─┤
        │         T#5s──│PT  ET│──elapsed              │
        │               └──────┘                       │

        │                 c1                           │
        │               ┌──────┐                       │
        │ Sensor        │ CTU  │                  Full │
        ├───┤ ├─────────│CU   Q│───────────────────( )─┤
        │  Reset        │    CV│──count                │
        ├───┤ ├───┬─────│R     │                       │
        │  Init   │ 10──│PV    │                       │
        ├───┤/├───┘     └──────┘                       │

        │             s                                │
        │          ┌──────┐                            │
        │    a     │  SR  │        b              Lamp │
        ├───┤ ├────│S1   Q│───────┤ ├──────────────( )─┤
        │    c     │      │                       Horn │
        ├───┤ ├───O│R   NQ│───┬────────────────────(S)─┤
        │          └──────┘   │                   Other│
        │                     └────────────────────( )─┤
    "#]],
        ],
    );
}

#[test]
fn a_parallel_of_whole_lines_is_joined_beside_the_rail() {
    let typed = "\
|       X0      Y0
+---+---| |-----( )
|   |   X1      Y1
|   +---| |-----( )
";
    check_styles(
        typed,
        fx(),
        [
            expect![[r#"
        |     X0                                   Y0  |
        +-+---| |----------------------------------( )-+
        | |   X1                                   Y1  |
        | +---| |----------------------------------( )-+
    "#]],
            expect![[r#"
        +-+--[X0]---------------------------------(Y0)-+
        | |                                            |
        | +--[X1]---------------------------------(Y1)-+
    "#]],
            expect![[r#"
        │     X0                                   Y0  │
        ├─┬───┤ ├──────────────────────────────────( )─┤
        │ │   X1                                   Y1  │
        │ └───┤ ├──────────────────────────────────( )─┤
    "#]],
        ],
    );
}

#[test]
fn wide_letters_and_long_names_keep_their_distance() {
    let typed = "\
|   启动按钮      EmergencyStop_Circuit_Closed     停
+----| |----------------|/|------------------------( )
";
    check_styles(
        typed,
        iec(),
        [
            expect![[r#"
        | 启动按钮 EmergencyStop_Circuit_Closed    停  |
        +----| |----------------|/|----------------( )-+
    "#]],
            expect![[r#"
        +--[启动按钮]---[/EmergencyStop_Circuit_Closed]---(停)-+
    "#]],
            expect![[r#"
        │ 启动按钮 EmergencyStop_Circuit_Closed    停  │
        ├────┤ ├────────────────┤/├────────────────( )─┤
    "#]],
        ],
    );
}

#[test]
fn all_small_rungs_read_back_as_drawn() {
    for contacts in 1..=5 {
        for part in all_rungs(contacts) {
            check_reading_back(&part, fx());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, max_shrink_iters: 2000, ..ProptestConfig::default() })]

    #[test]
    fn random_rungs_read_back_as_drawn(part in rung(24)) {
        check_reading_back(&part, fx());
    }

    #[test]
    fn random_rungs_with_names_read_back_as_drawn(part in rung(24)) {
        check_reading_back(&part, iec());
    }

    #[test]
    fn formatting_twice_changes_nothing(parts in prop::collection::vec(rung(12), 1..4), kinds in (0usize..3, 0usize..3)) {
        let rungs: Vec<String> = parts.iter().map(|part| drawn(&generate(part, fx()), &style(STYLES[kinds.0]))).collect();
        let text = rungs.join("\n// and then\n");
        let style = style(STYLES[kinds.1]);
        let once = format(&text, fx(), &style);
        check_alignment(&once.replace("// and then\n", ""));
        prop_assert_eq!(format(&once, fx(), &style), once);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, max_shrink_iters: 500, ..ProptestConfig::default() })]

    #[test]
    fn large_rungs_read_back_as_drawn(part in large_rung()) {
        check_reading_back(&part, fx());
    }
}

// The document.

#[test]
fn everything_but_rungs_is_kept() {
    let text = "\u{feff}(* Header   \n   of two lines *)   \r\n\r\nNETWORK 1 'Lamp'   \r\n|  X0    Y0\r\n|--| |---( )\r\n\r\n\
                // a comment\r\n; another\r\nLOOP:\r\n|  X1    Y1\r\n|--| |---( )  // at a line\r\n\r\n   \r\n|  X2    Y2\r\n|--| |---( )";
    let formatted = format(text, fx(), &Style::default());
    expect![[r#"
        ﻿(* Header
           of two lines *)␍
        ␍
        NETWORK 1 'Lamp'␍
        |   X0                                     Y0  |␍
        +---| |------------------------------------( )-+␍
        ␍
        // a comment␍
        ; another␍
        LOOP:␍
        |   X1                                     Y1  |␍
        +---| |------------------------------------( )-+  // at a line␍
        ␍
        ␍
        |   X2                                     Y2  |␍
        +---| |------------------------------------( )-+"#]]
    .assert_eq(&formatted.replace('\r', "␍"));
    assert_eq!(format(&formatted, fx(), &Style::default()), formatted);
    // A carriage return alone ends a line as well.
    let returns = |text: &str| text.replace("\r\n", "\r");
    assert_eq!(format(&returns(text), fx(), &Style::default()), returns(&formatted));
}

#[test]
fn rungs_in_doubt_stay_as_drawn() {
    for rung in [
        // A loose end.
        "|  X0    Y0\n|--| |-+-( )\n|      |\n",
        // A contact without a name.
        "|        Y0\n|--| |---( )\n",
        // A bridge.
        "|  X0        X1    Y0\n|--| |--+---| |-+--( )\n|       |       |\n|       +---+   |\n|  X2       | X3|\n|--| |------+-| |-+\n",
        // A name that is nobody's.
        "|  X0      X7    Y0\n|--| |-----------( )\n",
        // A digit that is no rung number, beside the wire.
        "0--[X0]--( )--\n          Y0\n",
        // A character that is no drawing.
        "|  X0    Y0\n|--| |-§-( )\n",
    ] {
        assert_eq!(format(rung, fx(), &Style::default()), rung);
        // Others in the document are put in order all the same.
        let other = "|  X5    Y5\n|--| |---( )\n";
        let formatted = format(&format!("{rung}\n{other}"), fx(), &Style::default());
        assert_eq!(formatted, format!("{rung}\n{}", format(other, fx(), &Style::default())));
    }
}

#[test]
fn outputs_never_change_their_order() {
    // Y1 is drawn between Y0 and Y2, which share the contact X1: put together, it would come after both.
    let text = "\
|   X0        X1        Y0   |
+---| |---+---| |---+---( )--+
|         |         |   Y1   |
|         +---------|---( )--+
|                   |   Y2   |
|                   +---( )--+
";
    let tree = parse(text, fx());
    assert!(tree.problems.is_empty(), "{:?}", tree.problems);
    assert!(reduce(&tree.rungs[0].graph).is_ok());
    assert_eq!(format(text, fx(), &Style::default()), text);
}

#[test]
fn lines_without_output_run_on_to_the_right_rail() {
    let typed = "\
|   X0                 |
+---| |---+---[INV]----+
|         |            |
|         +------------+
|         |   X1       |
|         +---|/|------+
";
    check_styles(
        typed,
        fx(),
        [
            expect![[r#"
        |   X0                                         |
        +---| |---+--[INV]-----------------------------+
        |         |                                    |
        |         +------------------------------------+
        |         |   X1                               |
        |         +---|/|------------------------------+
    "#]],
            expect![[r#"
        +--[X0]--+--[INV]------------------------------+
        |        |                                     |
        |        +-------------------------------------+
        |        |                                     |
        |        +--[/X1]------------------------------+
    "#]],
            expect![[r#"
        │   X0                                         │
        ├───┤ ├───┬──[INV]─────────────────────────────┤
        │         │                                    │
        │         ├────────────────────────────────────┤
        │         │   X1                               │
        │         └───┤/├──────────────────────────────┤
    "#]],
        ],
    );
}

#[test]
fn a_byte_order_mark_before_a_rung_stays() {
    let formatted = format("\u{feff}|--[X0]---(Y0)\n", fx(), &style(StyleKind::Brackets));
    assert_eq!(formatted, format!("\u{feff}+--[X0]{}(Y0)-+\n", "-".repeat(35)));
}

#[test]
fn comments_behind_lines_stay_behind_them() {
    let typed = "\
|  X0    Y0        (* names *)
|--| |-+-( )       // start
|      | Y1
|      +-( )       ; not a comment
";
    assert_eq!(format(typed, fx(), &Style::default()), typed);
    let typed = typed.replace("; not a comment", "(* lamp *)");
    let formatted = format(&typed, fx(), &Style::default());
    expect![[r#"
        |   X0                                     Y0  |
        +---| |---+--------------------------------( )-+  (* names *)  // start
        |         |                                Y1  |
        |         +--------------------------------( )-+  (* lamp *)
    "#]]
    .assert_eq(&formatted);
    assert_eq!(format(&formatted, fx(), &Style::default()), formatted);
    // Inside a drawing they have no place of their own.
    let inside = "|  X0    Y0\n|--| |---( )  (* a *) |\n";
    assert_eq!(format(inside, fx(), &Style::default()), inside);
}

#[test]
fn rails_between_rungs_follow_the_page_only_if_a_rung_does() {
    let typed = "|  X0   Y0  |\n|--| |--( )-|\n|           |\n|  X1   Y1  |\n|--| |--( )-|\n|           |\n";
    let formatted = format(typed, fx(), &Style::default());
    check_alignment(&formatted);
    assert_eq!(formatted.lines().count(), typed.lines().count());
    let in_doubt = "  |  X0        |\n  |--| |--     |\n  |            |\n";
    assert_eq!(format(in_doubt, fx(), &Style::default()), in_doubt);
}

#[test]
fn rung_numbers_stay_in_the_margin() {
    let typed = "  1 |--[X0]---(Y0)\n\n 12 |--[X1]---(Y1)\n\n    |--[X2]---(Y2)\n";
    let formatted = format(typed, fx(), &Style::default());
    expect![[r#"
           |   X0                                     Y0  |
         1 +---| |------------------------------------( )-+

           |   X1                                     Y1  |
        12 +---| |------------------------------------( )-+

           |   X2                                     Y2  |
           +---| |------------------------------------( )-+
    "#]]
    .assert_eq(&formatted);
    assert_eq!(format(&formatted, fx(), &Style::default()), formatted);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, max_shrink_iters: 2000, ..ProptestConfig::default() })]

    #[test]
    fn scribbles_are_formatted_without_harm(text in "([|+\\-X0Y1\\[\\]()/ │├┤┼─>名O;*\\n]|--| \\|--|--\\( \\)--|  X0 |\\(\\* |\\*\\)|\\r\\n|\\r|\\t){0,120}") {
        for kind in STYLES {
            let once = format(&text, fx(), &style(kind));
            prop_assert_eq!(format(&once, fx(), &style(kind)), once.clone());
            let letters = |text: &str| text.chars().filter(|c| c.is_alphanumeric()).count();
            prop_assert_eq!(letters(&once), letters(&text), "{}", once);
        }
    }

    #[test]
    fn damaged_rungs_are_formatted_without_harm(part in rung(10), at in any::<prop::sample::Index>(), new in "[|+\\- X(\\[]") {
        let mut text: Vec<char> = drawn(&generate(&part, fx()), &style(StyleKind::Iec)).chars().collect();
        let at = at.index(text.len());
        if text[at] != '\n' {
            text[at] = new.chars().next().unwrap();
        }
        let text: String = text.into_iter().collect();
        let once = format(&text, fx(), &style(StyleKind::Unicode));
        prop_assert_eq!(format(&once, fx(), &style(StyleKind::Unicode)), once.clone());
        prop_assert_eq!(logic_of(&text), logic_of(&once), "{}\n{}", text, once);
    }
}

/// What the rungs of a document say, read chunk by chunk as in a document.
fn logic_of(text: &str) -> Vec<String> {
    let ends = rungwise::ladder::split(text);
    let chunks =
        std::iter::once(0).chain(ends.iter().copied()).zip(&ends).map(|(start, end)| &text[start..*end]);
    let rungs = |chunk| parse(chunk, fx()).rungs.into_iter().map(move |rung| rung.graph.logic_text(chunk));
    chunks.flat_map(rungs).collect()
}

#[test]
fn formatting_takes_time_in_proportion_to_the_document() {
    let document = |rungs: usize| TYPED.repeat(rungs / 2);
    let time = |rungs: usize| {
        let text = document(rungs);
        let start = cpu_time::ThreadTime::now();
        assert!(format(&text, fx(), &Style::default()).len() > text.len());
        start.elapsed().as_secs_f64()
    };
    let (small, large) = (time(400), time(4000));
    assert!(large < 40.0 * small.max(0.005), "400 rungs {small:.3} s, 4000 rungs {large:.3} s");
}

#[test]
fn rung_numbers_beside_the_names_are_kept_as_written() {
    let typed = "\
0000 |  X0           Y0  |
     |--] [----------( )-|
     |                   |
   7 |  X1           Y1  |
     |--] [----------( )-|
";
    let expected = expect![[r#"
             |   X0                       Y0  |
        0000 +---| |----------------------( )-+
             |                                |
             |   X1                       Y1  |
           7 +---| |----------------------( )-+
    "#]];
    let narrow = Style { kind: StyleKind::Iec, width: 34 };
    let formatted = format(typed, fx(), &narrow);
    expected.assert_eq(&formatted);
    assert_eq!(format(&formatted, fx(), &narrow), formatted);
}

#[test]
fn a_drawing_with_one_reading_is_straightened() {
    let typed = "\
|   X0      X1   Y0  |
+---| |---+-| |--( )-+
|   Y0   |           |
+---| |--+           |
";
    let expected = expect![[r#"
        |   X0        X1             Y0  |
        +---| |---+---| |------------( )-+
        |   Y0    |                      |
        +---| |---+                      |
    "#]];
    expected.assert_eq(&format(typed, fx(), &Style { kind: StyleKind::Iec, width: 34 }));
    // With two readings the drawing is left to its author.
    let two = typed.replace("---+-| |", "-+-+-| |");
    assert!(parse(&two, fx()).problems.iter().any(|problem| problem.code == "ragged-drawing"));
    assert_eq!(format(&two, fx(), &Style { kind: StyleKind::Iec, width: 34 }), two);
}
