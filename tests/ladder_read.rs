//! Reading character ladders: every spelling of every element, wiring, names, problems at their cells.

#![allow(clippy::unwrap_used, clippy::panic)]

use proptest::prelude::*;
use rungwise::ladder::{
    Block, ChunkKind, CoilKind, CompareOperator, ContactKind, Element, ElementKind, Graph, LadderTree,
    PinWire, Rung, VertexId, VertexKind, kind_of, parse, split,
};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Span, TextEdit, column_of_offset};
use std::collections::HashMap;
use std::fmt::Write;

fn fx() -> &'static Target {
    Target::of(Model::Fx3u)
}

fn iec() -> &'static Target {
    Target::of(Model::Iec)
}

/// A tree as text: one line for each chain of elements between rails (`L`, `R`), junctions (`J1` …), loose ends (`?`)
/// and function blocks, rungs separated by `--`, then problems as `! code: words`.
pub fn dump(tree: &LadderTree, text: &str) -> String {
    let mut out = String::new();
    for (number, rung) in tree.rungs.iter().enumerate() {
        if number > 0 {
            out.push_str("--\n");
        }
        dump_rung(rung, text, &mut out);
    }
    for problem in &tree.problems {
        writeln!(out, "! {}: {}", problem.code, problem.span.of(text)).unwrap();
    }
    out
}

fn dump_rung(rung: &Rung, text: &str, out: &mut String) {
    let graph = &rung.graph;
    if let Some(number) = rung.number {
        writeln!(out, "number {}", number.value).unwrap();
    }
    let mut names = HashMap::new();
    let mut junctions = 0;
    for id in graph.vertex_ids() {
        let name = match graph.vertex(id).kind {
            VertexKind::LeftRail => "L".to_string(),
            VertexKind::RightRail => "R".to_string(),
            VertexKind::LooseEnd => "?".to_string(),
            VertexKind::Junction => {
                junctions += 1;
                format!("J{junctions}")
            }
            VertexKind::Element(element) => element_words(graph.element(element), text),
        };
        names.insert(id, name);
    }
    let passes = |id: VertexId| graph.element_at(id).is_some_and(|element| element.block().is_none());
    for start in graph.vertex_ids().filter(|id| !passes(*id)) {
        for first in graph.outgoing(start) {
            let mut line = names[&start].clone();
            if let Some(pin) = pin_name(graph, start, graph.arc(first).tail_pin, false, text) {
                write!(line, ".{pin}").unwrap();
            }
            let mut arc = Some(first);
            while let Some(id) = arc {
                let head = graph.arc(id).head;
                write!(line, " {}", names[&head]).unwrap();
                if let Some(pin) = pin_name(graph, head, graph.arc(id).head_pin, true, text) {
                    write!(line, ".{pin}").unwrap();
                }
                arc = if passes(head) { graph.outgoing(head).next() } else { None };
            }
            writeln!(out, "{line}").unwrap();
        }
    }
    for element in &graph.elements {
        if let Some(block) = element.block() {
            dump_block(block, element, text, out);
        }
    }
}

fn pin_name(graph: &Graph, vertex: VertexId, pin: u16, input: bool, text: &str) -> Option<String> {
    let block = graph.element_at(vertex)?.block()?;
    let pins = if input { &block.inputs } else { &block.outputs };
    let name = pins[pin as usize].formal(text);
    Some(if name.is_empty() { format!("#{pin}") } else { name.to_string() })
}

fn dump_block(block: &Block, element: &Element, text: &str, out: &mut String) {
    let mut line = format!("block {}", element_words(element, text));
    for (arrow, pins) in [("", &block.inputs), ("=>", &block.outputs)] {
        for pin in pins {
            let name = Some(pin.formal(text)).filter(|name| !name.is_empty()).unwrap_or("_");
            let wire = match pin.wire {
                PinWire::Power => "wire".into(),
                PinWire::Open => "open".into(),
                PinWire::Operand(index) => element.operand_text(index, text),
            };
            let negated = if pin.negated { "not " } else { "" };
            write!(line, " {arrow}{name}={negated}{wire}").unwrap();
        }
    }
    writeln!(out, "{line}").unwrap();
}

fn element_words(element: &Element, text: &str) -> String {
    let operands: Vec<_> = (0..element.operands.len()).map(|n| element.operand_text(n, text)).collect();
    let operands = operands.join(" ");
    match &element.kind {
        ElementKind::Contact(kind) => {
            let mark = match kind {
                ContactKind::NormallyOpen => "",
                ContactKind::NormallyClosed => "/",
                ContactKind::Rising => "^",
                ContactKind::Falling => "v",
            };
            format!("{mark}{}", if operands.is_empty() { "_" } else { &operands })
        }
        ElementKind::Coil(kind) => {
            let mark = match kind {
                CoilKind::Plain => "",
                CoilKind::Negated => "/ ",
                CoilKind::Set => "S ",
                CoilKind::Reset => "R ",
                CoilKind::Rising => "P ",
                CoilKind::Falling => "N ",
                CoilKind::Toggle => "T ",
            };
            format!("({mark}{operands})")
        }
        ElementKind::Compare(operator) => format!("[{} {operands}]", operator_words(*operator)),
        ElementKind::Invert => "INV".to_string(),
        ElementKind::Instruction { form, mnemonic } => {
            let known = if form.is_some() { "" } else { "?" };
            format!("[{known}{} {operands}]", mnemonic.of(text)).replace(" ]", "]")
        }
        ElementKind::Block(block) => {
            let instance = block.instance.map_or("_", |name| name.of(text));
            format!("{instance}:{}", block.type_text(text).unwrap_or("_"))
        }
        ElementKind::Jump(label) => format!(">>{}", label.of(text)),
        ElementKind::Return => "<RETURN>".to_string(),
        ElementKind::ConnectorOut(name) => format!("-->{}>", name.of(text)),
        ElementKind::ConnectorIn(name) => format!(">{}>--", name.of(text)),
    }
}

fn operator_words(operator: CompareOperator) -> String {
    let (sign, wide) = match operator {
        CompareOperator::Equal { wide } => ("=", wide),
        CompareOperator::NotEqual { wide } => ("<>", wide),
        CompareOperator::Greater { wide } => (">", wide),
        CompareOperator::Less { wide } => ("<", wide),
        CompareOperator::GreaterOrEqual { wide } => (">=", wide),
        CompareOperator::LessOrEqual { wide } => ("<=", wide),
    };
    format!("{}{sign}", if wide { "D" } else { "" })
}

/// Reads `drawing` and compares the dump of its tree with `expected`, leading and trailing line breaks aside.
#[track_caller]
fn check_on(target: &Target, drawing: &str, expected: &str) {
    let drawing = drawing.trim_start_matches('\n');
    let found = dump(&parse(drawing, target), drawing);
    assert_eq!(found.trim(), unindent(expected).trim(), "\n{drawing}");
}

#[track_caller]
fn check(drawing: &str, expected: &str) {
    check_on(fx(), drawing, expected);
}

fn unindent(text: &str) -> String {
    text.lines().map(str::trim).collect::<Vec<_>>().join("\n")
}

/// Each symbol stands in the middle of a rung below its operand, if it has one outside.
#[track_caller]
fn check_symbols(target: &Target, symbols: &[(&str, &str, &str)]) {
    for (operand, symbol, expected) in symbols {
        let drawing = format!("|    {operand}\n+----{symbol}------\n");
        let found = dump(&parse(&drawing, target), &drawing);
        let output = expected.starts_with(['(', '>', '<', '-']);
        let output = output || (expected.starts_with('[') && !expected.contains(['<', '=', '>']));
        let mut wanted = format!("L {expected} {}\n", if output { "R" } else { "?" });
        if expected.starts_with(">") && expected.ends_with("--") {
            wanted = format!("L ?\nL {expected} ?\n");
        }
        assert_eq!(found, wanted, "\n{drawing}");
    }
}

#[test]
fn every_contact() {
    check_symbols(
        fx(),
        &[
            ("X0", "| |", "X0"),
            ("X0", "|/|", "/X0"),
            ("X0", "|P|", "^X0"),
            ("X0", "|N|", "vX0"),
            ("X0", "|↑|", "^X0"),
            ("X0", "|↓|", "vX0"),
            ("X0", "] [", "X0"),
            ("X0", "]/[", "/X0"),
            ("X0", "]\\[", "/X0"),
            ("X0", "]P[", "^X0"),
            ("X0", "]N[", "vX0"),
            ("X0", "[ ]", "X0"),
            ("X0", "[/]", "/X0"),
            ("X0", "[P]", "^X0"),
            ("X0", "[N]", "vX0"),
            ("X0", "! !", "X0"),
            ("X0", "!/!", "/X0"),
            ("X0", "┤ ├", "X0"),
            ("X0", "┤/├", "/X0"),
            ("X0", "┤P├", "^X0"),
            ("X0", "┤↓├", "vX0"),
            ("X0", "│ │", "X0"),
            ("", "[X0]", "X0"),
            ("", "[/X0]", "/X0"),
            ("", "[/ X0 ]", "/X0"),
            ("", "]X0[", "X0"),
            ("", "]/X0[", "/X0"),
            ("", "[P X0]", "^X0"),
            ("", "[↓X0]", "vX0"),
            ("", "[ M8002 ]", "M8002"),
        ],
    );
}

/// Its right rail may stand under anything of the rung above, also under a bar of a contact.
#[test]
fn narrower_rungs_directly_below_a_wider_one_are_rungs_of_their_own() {
    let wide = "|   X0        X1                           Y0  |\n+---| |-------|/|--------------------------( )-+\n";
    for cells in 6..38 {
        let pad = |cell: &str| cell.repeat(cells - 6);
        let narrow = |contact: &str, coil: &str| {
            format!("|   {contact}  {}  {coil}  |\n+---| |---{}( )-+\n", pad(" "), pad("-"))
        };
        let text = format!("{wide}{}{}", narrow("X2", "Y1"), narrow("X3", "Y2"));
        let tree = parse(&text, fx());
        let errors: Vec<_> = tree.problems.iter().filter(|problem| problem.code != "ragged-rail").collect();
        assert_eq!(errors, [] as [&Diagnostic; 0], "{text}");
        let words: Vec<String> = tree
            .rungs
            .iter()
            .map(|rung| {
                let words = rung.graph.elements.iter().map(|element| element_words(element, &text));
                words.collect::<Vec<_>>().join(" ")
            })
            .collect();
        assert_eq!(words, ["X0 /X1 (Y0)", "X2 (Y1)", "X3 (Y2)"], "{text}");
    }
    // A branch whose line meets the contact is no rung: nobody can tell where it was meant to end.
    let branch = "|   X0        X1                           Y0  |\n+---| |-------|/|--------------------------( )-+\n\
        |   Y0        |\n+---| |-------+\n";
    let tree = parse(branch, fx());
    assert!(tree.problems.iter().any(|problem| problem.code != "ragged-rail"), "{branch}");
}

#[test]
fn every_coil() {
    check_symbols(
        fx(),
        &[
            ("Y0", "( )", "(Y0)"),
            ("Y0", "()", "(Y0)"),
            ("Y0", "(  )", "(Y0)"),
            ("Y0", "(/)", "(/ Y0)"),
            ("Y0", "(S)", "(S Y0)"),
            ("Y0", "(R)", "(R Y0)"),
            ("Y0", "(P)", "(P Y0)"),
            ("Y0", "(N)", "(N Y0)"),
            ("Y0", "(L)", "(S Y0)"),
            ("Y0", "(U)", "(R Y0)"),
            ("", "(Y0)", "(Y0)"),
            ("", "( Y0 )", "(Y0)"),
            ("", "(/Y0)", "(/ Y0)"),
            ("", "(S Y0)", "(S Y0)"),
            ("", "(R Y0)", "(R Y0)"),
            ("", "(L Y0)", "(S Y0)"),
            ("", "(U Y0)", "(R Y0)"),
            ("", "(SET Y0)", "(S Y0)"),
            ("", "(RST Y0)", "(R Y0)"),
            ("", "(PLS M0)", "(P M0)"),
            ("", "(PLF M0)", "(N M0)"),
            ("", "(T0 K50)", "(T0 K50)"),
            ("", "(C0 D10)", "(C0 D10)"),
            ("T0 K50", "( )", "(T0 K50)"),
            ("C0 K3", "( )", "(C0 K3)"),
        ],
    );
}

#[test]
fn every_comparison() {
    check_symbols(
        fx(),
        &[
            ("", "[>= D0 K10]", "[>= D0 K10]"),
            ("", "[= D0 K10]", "[= D0 K10]"),
            ("", "[<> D0 D1]", "[<> D0 D1]"),
            ("", "[< D0 K-10]", "[< D0 K-10]"),
            ("", "[> D0,K10]", "[> D0 K10]"),
            ("", "[<=D0 K10]", "[<= D0 K10]"),
            ("", "[D0 >= K10]", "[>= D0 K10]"),
            ("", "[D0>=K10]", "[>= D0 K10]"),
            ("", "[D>= D0 K10]", "[D>= D0 K10]"),
            ("", "[LD>= D0 K10]", "[>= D0 K10]"),
            ("", "[LDD= D0 K10]", "[D= D0 K10]"),
            ("", "[AND< D0 K10]", "[< D0 K10]"),
            ("", "[ORD<> D0 K10]", "[D<> D0 K10]"),
            ("D0 D1", "[>=]", "[>= D0 D1]"),
        ],
    );
    check_symbols(iec(), &[("", "[D >= x]", "[>= D x]"), ("", "[level<>16#FF]", "[<> level 16#FF]")]);
    check_on(
        iec(),
        "
|    temp             cool
+---|>= INT|----------( )--
|    300
",
        "L [>= temp 300] (cool) R",
    );
}

#[test]
fn every_other_element() {
    check_symbols(
        fx(),
        &[
            ("", "/", "INV"),
            ("", "[INV]", "INV"),
            ("", "[MOV K10 D0]", "[MOV K10 D0]"),
            ("", "[ MOV  K10,D0 ]", "[MOV K10 D0]"),
            ("", "[DMOVP K10 D0]", "[DMOVP K10 D0]"),
            ("", "[SET S20]", "[SET S20]"),
            ("", "[END]", "[END]"),
            ("", "(MOV K10 D0)", "[MOV K10 D0]"),
            ("", "[MVO K10 D0]", "[?MVO K10 D0]"),
            ("C2", "{RES}", "(R C2)"),
        ],
    );
    check("+--[X0]-->>P5", "L X0 >>P5 R");
    check("+--[X0]--->>P5", "L X0 >>P5 R");
    check("+--[X0]--[JMP P5]--", "L X0 >>P5 R");
    check("+--[X0]--<RETURN>", "L X0 <RETURN> R");
    check("+--[X0]-->K1>", "L X0 -->K1> R");
    check("| >K1>--(Y0)", "L >K1>-- (Y0) R");
    check_on(iec(), "+--[go]-->>Schritt_über", "L go >>Schritt_über R");
}

#[test]
fn canonical_examples() {
    check(
        "
(* Start and stop with seal-in *)
|   X0        X1                         Y0  |
+---| |---+---|/|------------------------( )-+
|   Y0    |                                  |
+---| |---+                                  |
",
        "L X0 J1
        L Y0 J1
        J1 /X1 (Y0) R",
    );
    check(
        "
|   Y0      X2                         T0 K50|
+---| |-----| |---+----------------------( )-+
|                 |                          |
|                 +--[MOV K10 D0]------------+
",
        "L Y0 X2 J1
        J1 (T0 K50) R
        J1 [MOV K10 D0] R",
    );
}

#[test]
fn other_hands() {
    // Brackets, no right rail, operands inside.
    check(
        "
|--[X0]--+--[/X1]--( Y0 )
|--[Y0]--+
",
        "L X0 J1
        L Y0 J1
        J1 /X1 (Y0) R",
    );
    // No rail at all.
    check(
        "
    X0      X1      Y0
  --| |--+--|/|-----( )--
    Y0   |
  --| |--+
",
        "L X0 J1
        L Y0 J1
        J1 /X1 (Y0) R",
    );
    // Unicode.
    check(
        "
│   X0        X1          Y0  │
├───┤ ├───┬───┤/├─────────( )─┤
│   Y0    │                   │
├───┤ ├───┘                   │
",
        "L X0 J1
        L Y0 J1
        J1 /X1 (Y0) R",
    );
    // Heavy and double lines, ASCII mixed in.
    check(
        "┃  X0      Y0 ┃\n┣━━] [━━╋━━( )━┫\n┃       ┃  Y1 ┃\n┃       ┗━━(S)━┫\n",
        "L X0 J1\nJ1 (Y0) R\nJ1 (S Y1) R",
    );
    // `!` for bars, `*` for junctions, `=` and `_` for wires.
    check(
        "
!   X0           Y0 !
!===! !===*======( )!
!   X1    !         !
!___! !___*         !
",
        "L X0 J1
        L X1 J1
        J1 (Y0) R",
    );
    // Double rails and rung numbers.
    check(
        "
     ||     X0       Y0    ||
  12 ||----] [------( )----||
     ||                    ||
",
        "number 12
        L X0 (Y0) R",
    );
    // Corners without `+`.
    check(
        "
|--[X0]--------
|             |
|             --(Y1)--|
",
        "L X0 J1
        J1 (Y1) R",
    );
}

#[test]
fn several_rungs_in_one_block() {
    check(
        "
|  X0      Y0  |
+--| |-----( )-+
|  X1      Y1  |
+--| |-----( )-+
|  X2  |   Y2  |
",
        "L X0 (Y0) R
        --
        L X1 (Y1) R
        ! stray-operand: X2
        ! unreadable-cell: |
        ! stray-operand: Y2",
    );
}

#[test]
fn nested_branches_and_outputs() {
    check(
        "
|   X0        X1        X2         Y0  |
+---| |---+---| |---+---| |---+----( )-+
|         |   X3    |         |    Y1  |
|         +---| |---+         +----(S)-+
|         |   X4              |        |
|         +---|/|-------------+        |
|   X5                        |        |
+---| |-----------------------+        |
",
        "L X0 J1
        L X5 J3
        J1 X1 J2
        J1 X3 J2
        J1 /X4 J3
        J2 X2 J3
        J3 (Y0) R
        J3 (S Y1) R",
    );
}

#[test]
fn crossing_without_junction() {
    check(
        "
|   X0                  Y0  |
+---| |---+-------------( )-+
|   X1    |             Y1  |
+---| |---|---+---------( )-+
|         |   |         Y2  |
|         +---|---------( )-+
|             |         Y3  |
|             +---------( )-+
",
        "L X0 J1
        L X1 J2
        J1 (Y0) R
        J1 (Y2) R
        J2 (Y1) R
        J2 (Y3) R",
    );
}

#[test]
fn a_contact_stays_a_contact_over_another() {
    // No line for names between: bars stand over bars, but each has its own wires.
    check(
        "
+--| |--( )--
+--| |--( )--
",
        "L _ () R
        --
        L _ () R
        ! missing-operand: | |
        ! missing-operand: ( )
        ! missing-operand: | |
        ! missing-operand: ( )",
    );
}

#[test]
fn names_above_below_and_over_several_lines() {
    check(
        "
+--| |----|/|----( )--
|  X0     X1     Y0
+--| |----|/|----( )--
|  X2     X3     Y1
",
        "L X0 /X1 (Y0) R
        --
        L X2 /X3 (Y1) R",
    );
    check_on(
        iec(),
        "
|  START     MOTOR_
|  BUTTON    RUN
+---| |------( )--
",
        "L START_BUTTON (MOTOR_RUN) R",
    );
    // A description over a device is no name.
    check(
        "
|  start     motor
|   X0        Y0
+---| |------( )--
",
        "L X0 (Y0) R",
    );
    check_on(iec(), "|  电机启动    电机\n+---| |------( )--\n", "L 电机启动 (电机) R");
    check_on(
        iec(),
        "
|  %IX0.0    a[3].b   T1.Q     out
+---| |-------| |-----|/|------( )--
",
        "L %IX0.0 a[3].b /T1.Q (out) R",
    );
    // One above and one below a comparison, though the next rung has names above.
    check_on(
        iec(),
        "
| temp   cool
+--[>]----(S)-
| upper
| temp   cool
+--[<]----(R)-
| lower
",
        "L [> temp upper] (S cool) R
        --
        L [< temp lower] (R cool) R",
    );
}

#[test]
fn habit_of_the_document_decides_where_the_chunk_does_not() {
    let drawing = "+--| |----( )--\n|  X0      Y0\n+--[X2]---(Y1)--\n";
    let tree = parse(drawing, fx());
    assert_eq!(tree.names.decided(), None, "{:?}", tree.names);
    let between = "|  X1      Y1\n+--| |----( )--\n|  X2      Y2\n+--| |----( )--\n|  X3      Y3\n";
    let tree = parse(between, fx());
    assert_eq!((tree.names.above, tree.names.below), (2, 2));
    assert!(dump(&tree, between).starts_with("L X1 (Y1) R\n--\nL X2 (Y2) R\n"), "above, by default");
    let hint = rungwise::ladder::NameHabit { above: 1, below: 5 };
    let tree = rungwise::ladder::parse_with(between, fx(), hint);
    assert!(dump(&tree, between).starts_with("L X2 (Y2) R\n--\nL X3 (Y3) R\n"));
}

#[test]
fn function_blocks() {
    check_on(
        iec(),
        "
|             T1
|          +-------+
|   start  |  TON  |    lamp  |
+---| |----|IN    Q|----( )---+
|    T#5s--|PT   ET|--elapsed |
|          +-------+          |
",
        "L start T1:TON.IN
        T1:TON.Q (lamp) R
        block T1:TON IN=wire PT=T#5s =>Q=wire =>ET=elapsed",
    );
    check_on(
        iec(),
        "
|               C1
|            +--------+
|   pulse    |  CTU   |   full
+---| |------|CU     Q|---( )--
|   clear    |        |
+---| |-----O|R     CV|
|        K-5-|PV      |
|            +--------+
",
        "L pulse C1:CTU.CU
        L clear C1:CTU.R
        C1:CTU.Q (full) R
        block C1:CTU CU=wire R=not wire PV=K-5 =>Q=wire =>CV=open",
    );
    // Subscripts belong to the operands.
    check_on(
        iec(),
        "
|              +-------+             |
|   start      | MOVE  |       lamp  |
+---| |--------|EN  ENO|-------( )---+
|   h[1,-2].a--|IN  OUT|--g[n].x[2]  |
|              +-------+             |
",
        "L start _:MOVE.EN
        _:MOVE.ENO (lamp) R
        block _:MOVE EN=wire IN=h[1,-2].a =>ENO=wire =>OUT=g[n].x[2]",
    );
    // Unicode frame, no names at the pins.
    check_on(
        iec(),
        "
        ┌─────┐
├──[a]──┤ AND ├──(c)──┤
├──[b]──┤     │       │
        └─────┘
",
        "L a _:AND.#0
        L b _:AND.#1
        _:AND.#0 (c) R
        block _:AND _=wire _=wire =>_=wire",
    );
}

#[test]
fn loose_ends_stay_where_they_are() {
    let drawing = "|   X0      X1      Y0 |\n+---| |---  | |-----( )+\n";
    let tree = parse(drawing, fx());
    check(drawing, "L X0 ?\n? X1 (Y0) R");
    let graph = &tree.rungs[0].graph;
    let ends: Vec<_> = graph
        .vertex_ids()
        .filter(|id| graph.vertex(*id).kind == VertexKind::LooseEnd)
        .map(|id| graph.cells(graph.vertex(id).cells)[0])
        .collect();
    let row = drawing.find('+').unwrap();
    assert_eq!(ends, [Span::new(row + 9, row + 10), Span::new(row + 12, row + 13)]);
}

/// Renders each problem as carets under its cells with the code behind them, problems of one line below each other.
fn annotate(text: &str, problems: &[Diagnostic]) -> String {
    let mut out = String::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        out.push_str(line.trim_end());
        out.push('\n');
        let range = start..start + line.len();
        start += line.len();
        for problem in problems.iter().filter(|problem| range.contains(&(problem.span.start as usize))) {
            let column = |offset: u32| {
                let at = (offset as usize - range.start).min(line.trim_end().len());
                column_of_offset(line, at, rungwise::text::Encoding::Utf32) as usize
            };
            let (first, last) = (column(problem.span.start), column(problem.span.end));
            writeln!(out, "{}{} {}", " ".repeat(first), "^".repeat((last - first).max(1)), problem.code)
                .unwrap();
        }
    }
    out
}

/// Reads a drawing without its lines of carets and compares the carets of the problems found.
#[track_caller]
fn check_problems(marked: &str) {
    let marked = marked.trim_start_matches('\n');
    let is_mark = |line: &&str| line.trim_start().starts_with('^');
    let drawing: String =
        marked.lines().filter(|line| !is_mark(line)).map(|line| format!("{line}\n")).collect();
    for target in [fx(), iec()] {
        let problems = parse(&drawing, target).problems;
        assert_eq!(annotate(&drawing, &problems), marked, "on {}", target.name);
        for problem in &problems {
            let words = problem.message.render(Default::default());
            assert!(!words.starts_with(problem.code), "no words for {words}");
            for fix in &problem.fixes {
                let title = fix.title.render(Default::default());
                assert!(!title.starts_with(problem.code) && !title.contains("stray-operand."), "{title}");
            }
        }
    }
}

#[test]
fn problems_at_their_cells() {
    check_problems(
        "
|   X0                         Y0  |
+---| |------?%----------------( )-+
             ^^ unreadable-cell
",
    );
    check_problems(
        "
|   X0      |    X1            Y0  |
            ^ unreadable-cell
+---| |----------[ ------------( )-+
                 ^ unreadable-cell
",
    );
    check_problems(
        "
|   X0                         Y0  |
+---| |--------| |-------------( )-+
               ^^^ missing-operand
|                                  |
+--[>=]------( )-------------------+
   ^^^^ missing-operand
             ^^^ missing-operand
",
    );
    check_problems(
        "
|   X0          X1             Y0  |
                ^^ stray-operand
+---| |------------------------( )-+
",
    );
    check_problems(
        "
|   X0X1X2X3X4                 Y0  |
    ^^^^^^^^^^ stray-operand
+---| |--| |-------------------( )-+
",
    );
    check_problems(
        "
|   X0                         Y0  |
+---| |---+--------------------( )-+
|         |                        |
|        | | X1                    |
         ^^^ contact-on-vertical
|         |                    Y1  |
|         +--------------------( )-+
",
    );
    check_problems(
        "
|   X0                         Y0  |
+---| |---+--------------------( )-+
|         |                        |
|       [X1]                       |
        ^^^^ contact-on-vertical
|         |                    Y1  |
|         +--------------------( )-+
",
    );
    check_problems(
        "
+--[X0]-------(Y0)--
(* never closed
^^ unclosed-comment
",
    );
    check_problems(
        "
This is prose and no ladder.
^^^^^^^^^^^^^^^^^^^^^^^^^^^^ unreadable-cell
",
    );
    check("+--[X0 X1]----(Y0)--", "L X0 (Y0) R\n! stray-operand: X1");
}

#[test]
fn ragged_drawings_are_read_and_reported() {
    // One column beside the junction.
    let drawing = "
|   X0                         Y0  |
+---| |---+--------------------( )-+
|   X1     |                       |
           ^ ragged-drawing
+---| |----+                       |
";
    check_problems(drawing);
    check(
        &drawing.replace("           ^ ragged-drawing\n", ""),
        "L X0 J1
        L X1 J1
        J1 (Y0) R
        ! ragged-drawing: |",
    );
    // A name written over the wire.
    check_on(
        iec(),
        "
|   X0                         Y0  |
+---| |---+--------------------( )-+
|         |                        |
|   a_long_name                    |
+---| |---+                        |
",
        "L X0 J1
        L a_long_name J1
        J1 (Y0) R
        ! ragged-drawing: |",
    );
    // Two junctions are as near: no guess.
    check_problems(
        "
|   X0                         Y0  |
+---| |---+-+------------------( )-+
|   X1     |                       |
           ^ ragged-drawing
+---| |----+                       |
",
    );
    // A name beside its contact, with the edit that moves it.
    let drawing = "|X0                    Y0  |\n+--| |-----------------( )-+\n";
    let tree = parse(drawing, fx());
    assert_eq!(dump(&tree, drawing), "L X0 (Y0) R\n! ragged-drawing: X0\n");
    let mended = TextEdit::apply_all(&tree.problems[0].fixes[0].edits, drawing);
    assert_eq!(mended, "|  X0                  Y0  |\n+--| |-----------------( )-+\n");
    assert!(parse(&mended, fx()).problems.is_empty());
}

#[test]
fn unclosed_comments_are_closed_at_the_end_of_their_line() {
    let text = "(* note\n+--[X0]--(Y0)--\n";
    let problems = parse(text, fx()).problems;
    let mended = TextEdit::apply_all(&problems[0].fixes[0].edits, text);
    assert_eq!(mended, "(* note *)\n+--[X0]--(Y0)--\n");
    check(&mended, "L X0 (Y0) R");
}

#[test]
fn tabs_line_ends_byte_order_marks_and_wide_letters() {
    let plain = "|       X0      Y0      |\n+-------| |-----( )-----+\n";
    let expected = "L X0 (Y0) R";
    check(plain, expected);
    check("|\tX0\tY0\t|\n+-------| |-----( )-----+\n", expected);
    check(&plain.replace('\n', "\r\n"), expected);
    check(&plain.replace('\n', "\r"), expected);
    check(&format!("\u{feff}{plain}"), expected);
    check(plain.trim_end(), expected);
    check(&plain.replace('\n', "   \t\n"), expected);
    // Two cells for each of these letters: `出口` ends above the coil, by letters it would not.
    check_on(iec(), "|    入口一        出口\n+----| |----------( )--\n", "L 入口一 (出口) R");
    // Spans count bytes.
    let text = "(* 电 *)\n|   é      Y0\n+--| |----( )--\n";
    let tree = parse(text, iec());
    assert_eq!(tree.rungs[0].graph.elements[0].operands[0].span.of(text), "é");
    assert_eq!(tree.rungs[0].graph.elements[0].span.of(text), "| |");
    assert_eq!(tree.comments[0].of(text), "(* 电 *)");
    assert_eq!(tree.rungs[0].lines, (1, 3));
}

#[test]
fn headers_comments_and_places() {
    let text = "(* one
   two *)
NETWORK 3 'fill the tank'
{ note }
|  X0      Y0  | // first
+--| |-----( )-+

";
    let tree = parse(text, fx());
    let header = tree.header.clone().unwrap();
    assert_eq!(header.span.of(text), "NETWORK 3 'fill the tank'");
    assert_eq!(header.number.unwrap().value, 3);
    assert_eq!(header.title.unwrap().of(text), "fill the tank");
    assert_eq!(header.label, None);
    let comments: Vec<_> = tree.comments.iter().map(|span| span.of(text)).collect();
    assert_eq!(comments, ["(* one\n   two *)", "{ note }", "// first"]);
    let rung = &tree.rungs[0];
    assert_eq!(rung.span.of(text), "|  X0      Y0  | // first\n+--| |-----( )-+");
    assert_eq!(rung.lines, (4, 6));
    assert_eq!(rung.right_rail.iter().map(|rail| rail.value).collect::<Vec<_>>(), [15]);
    assert_eq!(rung.graph.elements[1].columns, (11, 14));
    assert_eq!(rung.graph.elements[1].row, 5);
    let mentions: Vec<_> = tree.mentions().map(|m| m.operand.span.of(text)).collect();
    assert_eq!(mentions, ["X0", "Y0"]);

    let tree = parse("NETWORK\nL1:\n+--[X0]--(Y0)--\n", fx());
    let header = tree.header.unwrap();
    assert_eq!(header.label.unwrap().of("NETWORK\nL1:\n"), "L1");
    assert!(tree.problems.is_empty());
}

#[test]
fn a_huge_drawing_is_refused_in_few_words() {
    let wide = format!("+--[X0]-{}-(Y0)--\n", "-".repeat(20_000));
    let tall = "|   |  |\n".repeat(6_000) + "+---+--+\n";
    for text in [wide, tall] {
        let tree = parse(&text, fx());
        assert_eq!(tree.problems.iter().map(|p| p.code).collect::<Vec<_>>(), ["rung-too-large"]);
        assert!(tree.rungs.is_empty());
    }
}

/// The chunks of a text, line breaks at their ends aside.
pub fn chunks(text: &str) -> Vec<&str> {
    let mut start = 0;
    let ends = split(text).into_iter();
    let pieces = ends.map(|end| &text[std::mem::replace(&mut start, end)..end]);
    pieces.map(|piece| piece.trim_end_matches('\n')).collect()
}

#[test]
fn documents_are_cut_between_networks() {
    assert!(split("").is_empty());
    let text = "(* file *)

PROGRAM p
VAR
  a : BOOL;

  b : BOOL;
END_VAR

(* first *)
|  a    b  |
+--| |--( )-+
|           |
|  b    a  |
+--| |--( )-+
// second
+--[a]--(b)--

NETWORK 3

+--[b]--(a)--
L1:
(* with (

   a blank line *)
+--[a]--(b)--
END_PROGRAM
";
    assert_eq!(
        chunks(text),
        [
            "(* file *)",
            "PROGRAM p\nVAR\n  a : BOOL;\n\n  b : BOOL;\nEND_VAR",
            "(* first *)\n|  a    b  |\n+--| |--( )-+\n|           |",
            "|  b    a  |\n+--| |--( )-+",
            "// second\n+--[a]--(b)--",
            "NETWORK 3\n\n+--[b]--(a)--",
            "L1:\n(* with (\n\n   a blank line *)\n+--[a]--(b)--",
            "END_PROGRAM",
        ]
    );
    let kinds: Vec<ChunkKind> = chunks(text).into_iter().map(kind_of).collect();
    use ChunkKind::*;
    assert_eq!(kinds, [Comments, Declarations, Drawing, Drawing, Drawing, Drawing, Drawing, Declarations]);
}

#[test]
fn lines_of_vertical_wires_do_not_cut() {
    for text in [
        // Two inner wires, no rails.
        "   +--[a]--+--(b)\n   |       |\n   +--[b]--+\n",
        // Left rail and one wire.
        "|--[a]--+--(b)\n|       |\n|--[b]--+\n",
        // The branch comes before its continuation.
        "+-[a]-+\n|     |\n+-[b]-+--(c)--\n",
        // Both rails and one wire.
        "+--[a]--+--(b)--+\n|       |       |\n+--[b]--+       |\n",
    ] {
        assert_eq!(chunks(text).len(), 1, "{text}");
    }
    for text in [
        "+--[a]--(b)--+\n|            |\n+--[b]--(a)--+\n",
        "+--[a]--(b)--\n|\n+--[b]--(a)--\n",
        " 1 ||--[a]--(b)--||\n   ||           ||\n 2 ||--[b]--(a)--||\n",
        "+--[a]--(b)--\n\n+--[b]--(a)--\n",
    ] {
        assert_eq!(chunks(text).len(), 2, "{text}");
    }
}

/// Pieces of documents that open, close, join and break things.
const PIECES: &[&str] = &[
    "(* first *)\n",
    "// note\n",
    "; note\n",
    "(* two\n\nlines *)\n",
    "{ pragma\n }\n",
    "\n",
    "\r\n",
    "  \n",
    "|      |\n",
    "|\n",
    "||      ||\n",
    "|   X0        Y0  |\n+---| |-------( )-+\n",
    "|   X0    |\n+---| |---+--(Y0)--\n",
    "+--[X0]--+--(Y0)--+\n|        |        |\n+--[X1]--+        |\n",
    "NETWORK 1 'x'\n",
    "NETWORK\n",
    "L1:\n",
    "PROGRAM p\n",
    "VAR\n  a : BOOL;\n\nEND_VAR\n",
    "VAR\n",
    "END_VAR\n",
    "END_PROGRAM\n",
    "(*\n",
    "*)\n",
    "{\n",
    "}\n",
    "prose here\n",
    "  3 ||--[X0]--( )--||\n",
    "I/O ASSIGNMENT:\n",
    "LDmicro export text\n",
    "LADDER DIAGRAM:\n",
    "x",
    "|",
    "+-",
    "     |\n",
    "+--[a]--+\n",
    "   |     |\n",
    "     +-----+\n-----|IN  Q|--\n     | TON |\n     +-----+\n",
];

fn document() -> impl Strategy<Value = String> {
    prop::collection::vec(0..PIECES.len(), 0..24)
        .prop_map(|pieces| pieces.into_iter().map(|piece| PIECES[piece]).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whether a chunk ends at an offset is decided by the text from its start to the end of the chunk after it.
    #[test]
    fn chunk_boundaries_are_local(text in document()) {
        let ends = split(&text);
        prop_assert_eq!(ends.last().copied(), (!text.is_empty()).then_some(text.len()));
        prop_assert!(ends.windows(2).all(|pair| pair[0] < pair[1]));
        let mut start = 0;
        for (number, end) in ends.iter().enumerate() {
            // From any boundary on, the rest is the same.
            let rest: Vec<usize> = split(&text[start..]).into_iter().map(|end| end + start).collect();
            prop_assert_eq!(&rest[..], &ends[number..]);
            // A window that ends with the chunk after it has the same boundary.
            if let Some(next) = ends.get(number + 1) {
                prop_assert_eq!(split(&text[start..*next]).first().copied(), Some(end - start));
            }
            start = *end;
        }
    }

    /// A window from an old boundary to the end of an untouched chunk: if the boundary before that chunk is found
    /// again, all boundaries in the window are those of the whole.
    #[test]
    fn a_window_around_an_edit_is_enough(
        text in document(),
        place in 0..1000usize,
        removed in 0..9usize,
        piece in 0..PIECES.len(),
    ) {
        let old = split(&text);
        let start = floor(&text, text.len() * place / 1000);
        let end = floor(&text, (start + removed).min(text.len())).max(start);
        let new = format!("{}{}{}", &text[..start], PIECES[piece], &text[end..]);
        let shift = |old: usize| old + PIECES[piece].len() - (end - start);
        // One chunk before the touched ones, since a changed first line may join the chunk above.
        let touched = old.partition_point(|b| *b < start);
        let from = touched.checked_sub(2).map_or(0, |before| old[before]);
        let Some(last) = old.iter().position(|b| *b > end) else { return Ok(()) };
        let Some(after) = old.get(last + 1) else { return Ok(()) };
        let window: Vec<usize> = split(&new[from..shift(*after)]).into_iter().map(|b| b + from).collect();
        if window.contains(&shift(old[last])) {
            let inside = |b: &usize| from < *b && *b <= shift(*after);
            let whole: Vec<usize> = split(&new).into_iter().filter(inside).collect();
            prop_assert_eq!(window, whole);
        }
    }

    #[test]
    fn any_text_is_read(text in ".{0,200}") {
        read_all(&text);
    }

    #[test]
    fn any_soup_of_ladder_characters_is_read(text in SOUP) {
        read_all(&text);
    }

    #[test]
    fn any_grid_is_read(rows in prop::collection::vec("[-+| X0)(\\[/\\]]{20}", 1..14)) {
        read_all(&rows.join("\n"));
    }

    #[test]
    fn documents_are_read(text in document()) {
        read_all(&text);
    }
}

const SOUP: &str = "[-+|!/PNXYT01K=_*\\\\\\[\\](){}<>:;,'%.# \t\r\n─│┼├┤┬┴┌┐└┘电é\u{301}]{0,400}";

fn floor(text: &str, mut offset: usize) -> usize {
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// Reads a text as one chunk and chunk by chunk, and holds the trees to what their types promise.
fn read_all(text: &str) {
    let mut start = 0;
    for end in split(text) {
        let chunk = &text[start..end];
        start = end;
        kind_of(chunk);
        for target in [fx(), iec()] {
            check_tree(&parse(chunk, target), chunk);
        }
    }
    assert_eq!(start, text.len(), "chunks are all of the text");
    check_tree(&parse(text, fx()), text);
}

fn check_tree(tree: &LadderTree, text: &str) {
    let inside = |span: Span| assert!(text.get(span.range()).is_some(), "{span:?} in {text:?}");
    let mut line = 0;
    for rung in &tree.rungs {
        inside(rung.span);
        assert!(line <= rung.lines.0 && rung.lines.0 < rung.lines.1, "{:?} after {line}", rung.lines);
        line = rung.lines.1;
        let graph = &rung.graph;
        for id in graph.vertex_ids() {
            let vertex = graph.vertex(id);
            assert_eq!(graph.outgoing(id).count(), vertex.out_degree as usize);
            assert_eq!(graph.incoming(id).count(), vertex.in_degree as usize);
            assert_eq!(graph.outgoing(id).last(), vertex.last_out);
            assert_eq!(graph.incoming(id).last(), vertex.last_in);
            if let Some(element) = graph.element_at(id)
                && element.block().is_none()
            {
                assert_eq!((vertex.in_degree, vertex.out_degree), (1, 1), "a wire on each side");
            }
        }
        graph.cells.iter().copied().for_each(inside);
        for element in &graph.elements {
            inside(element.span);
            element.operands.iter().map(|operand| operand.span).for_each(inside);
            element.notes.iter().chain(&element.name_lines).copied().for_each(inside);
        }
    }
    for problem in &tree.problems {
        inside(problem.span);
        problem.related.iter().map(|related| related.span).for_each(inside);
        problem.fixes.iter().flat_map(|fix| &fix.edits).map(|edit| edit.span).for_each(inside);
    }
}

#[test]
fn the_rail_beside_the_names_may_be_left_of_the_rail_beside_the_wires() {
    check(
        "
|   X0             |
+---| |---[MOV K1 D0]-+
|   X1          |
+---| |--(PLS M0)-+
",
        "L X0 [MOV K1 D0] R
        --
        L X1 (P M0) R",
    );
}

#[test]
fn operands_of_a_block_may_stand_a_blank_beside_their_wire() {
    check_on(
        iec(),
        "
|               C1
|            +--------+
|   pulse    |  CTU   |   full
+---| |------|CU     Q|---( )--
|      10 ---|PV    CV|-- count
|            +--------+
",
        "L pulse C1:CTU.CU
        C1:CTU.Q (full) R
        block C1:CTU CU=wire PV=10 =>Q=wire =>CV=count",
    );
}

#[test]
fn presets_above_below_and_beside() {
    let coil = "L X0 (T0 K50) R";
    check("|   X0      K50  |\n|---| |----(T0)--|\n", coil);
    check("|   X0      T0  |\n|---| |-----( )-|\n|           K50 |\n", coil);
    check("|   X0      T0     |\n|---| |-----( ) K50|\n", coil);
    check("|   X0           |\n|---| |-----(T0)K50\n", coil);
    check("|   X0      T0   |\n|           K50  |\n|---| |-----( )--|\n", coil);
    // A coil that counts nothing takes none.
    check("|   X0      K50  |\n|---| |----(M0)--|\n", "L X0 (M0) R\n! stray-operand: K50");
}

#[test]
fn one_slip_is_one_problem() {
    // A box, a contact and a coil without their end.
    check_problems(
        "
|   X0
+---| |--[MOV K1
         ^ unreadable-cell
",
    );
    check_problems(
        "
|   X0                         Y0  |
+---| |--[X1 ------------------( )-+
         ^ unreadable-cell
",
    );
    // A name in the wire, where an element belongs.
    check_problems(
        "
|   X0                         Y0  |
+---| |---X1-------------------( )-+
          ^^ stray-operand
",
    );
    check_problems(
        "
|   X0     X1                  Y0  |
+---| |----X1------------------( )-+
           ^^ stray-operand
",
    );
    let drawing = "+---X1----[X0]--(Y0)--\n";
    let problems = parse(drawing, fx()).problems;
    let mended = TextEdit::apply_all(&problems[0].fixes[0].edits, drawing);
    assert_eq!(mended, "+--[X1]---[X0]--(Y0)--\n");
    check(&mended, "L X1 X0 (Y0) R");
    // Remarks behind the rail.
    let drawing = "|   X0      Y0  |   starts it\n+---| |-----( )-+ see  page 3\n";
    let tree = parse(drawing, fx());
    let expected = "L X0 (Y0) R\n! stray-operand: starts it\n! stray-operand: see  page 3\n";
    assert_eq!(dump(&tree, drawing), expected);
    let edits: Vec<TextEdit> =
        tree.problems.iter().flat_map(|problem| problem.fixes[0].edits.clone()).collect();
    let mended = TextEdit::apply_all(&edits, drawing);
    assert_eq!(mended, "|   X0      Y0  |   // starts it\n+---| |-----( )-+ // see  page 3\n");
    check(&mended, "L X0 (Y0) R");
    // A wire that misses its junctions at both ends.
    check_problems(
        "
|   X0                         Y0  |
+---| |----+-------------------( )-+
|   X1    |                        |
          ^ ragged-drawing
+---| |----+                       |
",
    );
}

#[test]
fn contacts_by_their_mnemonics() {
    check("--[LD X0]--[ANI X1]--[ANDP X2]--[ LDF X3 ]--(Y0)--", "L X0 /X1 ^X2 vX3 (Y0) R");
    // An unknown mnemonic is no device.
    check("--[X0]--(OTX Y0)--", "L X0 [?OTX Y0] R");
    // Those of Allen-Bradley are known.
    check("--[XIC X0]--[XIO X1]--(OTE Y0)--", "L X0 /X1 (Y0) R");
    check("--[X0]--(OTL M0)--", "L X0 (S M0) R");
    check("--[X0]--(OTU M0)--", "L X0 (R M0) R");
}
