//! Reading character ladders: every spelling of every element, wiring, names, problems at their cells.

use rungwise::ladder::{
    Block, CoilKind, CompareOperator, ContactKind, Element, ElementKind, Graph, LadderTree, PinWire, Rung,
    VertexId, VertexKind, parse,
};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Span, column_of_offset};
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
fn dump(tree: &LadderTree, text: &str) -> String {
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
    Some(pins[pin as usize].name.map_or(format!("#{pin}"), |name| name.of(text).to_string()))
}

fn dump_block(block: &Block, element: &Element, text: &str, out: &mut String) {
    let mut line = format!("block {}", element_words(element, text));
    for (arrow, pins) in [("", &block.inputs), ("=>", &block.outputs)] {
        for pin in pins {
            let name = pin.name.map_or("_", |name| name.of(text));
            let wire = match pin.wire {
                PinWire::Power => "wire",
                PinWire::Open => "open",
                PinWire::Operand(index) => element.operands[index].span.of(text),
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
            format!("{instance}:{}", block.type_name.map_or("_", |name| name.of(text)))
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

#[test]
fn debug_corpus() {
    let dir = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/corpus/ladder");
    let mut files: Vec<_> = std::fs::read_dir(dir).unwrap().map(|f| f.unwrap().path()).collect();
    files.sort();
    for f in files {
        let text = std::fs::read_to_string(&f).unwrap();
        let text = &text[text.find('\n').unwrap() + 1..];
        println!("=== {}", f.display());
        let mut start = 0;
        for end in rungwise::ladder::split(text) {
            let chunk = &text[start..end];
            start = end;
            let kind = rungwise::ladder::kind_of(chunk);
            println!("--- {kind:?}\n{}", chunk.trim_end());
            let tree = parse(chunk, iec());
            println!("{}", dump(&tree, chunk));
        }
    }
}
#[test]
fn debug_mistakes() {
    for dir in ["examples/mistakes", "examples/tank-level", "examples/traffic-lights", "examples/motor"] {
        let mut files: Vec<_> = std::fs::read_dir(dir).unwrap().map(|f| f.unwrap().path()).collect();
        files.sort();
        for f in files {
            if f.extension().unwrap() != "lad" {
                continue;
            }
            let text = std::fs::read_to_string(&f).unwrap();
            println!("=== {}", f.display());
            let mut start = 0;
            for end in rungwise::ladder::split(&text) {
                let chunk = &text[start..end];
                start = end;
                let tree = parse(chunk, fx());
                println!("{}", dump(&tree, chunk));
            }
        }
    }
}
