//! A text of LDmicro as a program of IEC 61131-3: declarations, and rungs in the canonical form.
//!
//! Each rung is carried over as a graph, printed, and read again; it counts only if what was read has the same logic.

use super::carry::{Carrier, leaf, name_counts};
use super::native::{self, Node, Note, Program, shown};
use super::table::{TableRow, table_rows};
use crate::ladder::reduce::reduce;
use crate::ladder::{
    ChunkKind, Element, ElementKind, Graph, LadderTree, Style, VertexId, VertexKind, kind_of, parse, print,
    split,
};
use crate::target::{Model, Target};
use crate::text::{Language, Message};
use std::fmt::Write;

/// A program of IEC 61131-3, and what of the source is not in it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Import {
    /// The text of a `.lad` file.
    pub text: String,
    /// What could not be carried over, or only in another form, by line of the source.
    pub notes: Vec<Note>,
    /// How many rungs there are.
    pub rungs: usize,
}

/// Why nothing was imported.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ImportError {
    /// It is neither a file of LDmicro nor an export.
    Unknown,
    /// What was printed does not read back as what was to be printed.
    Unproven,
}

/// A rung on its way.
struct Rung {
    line: u32,
    comments: Vec<String>,
    label: Option<String>,
    graph: Option<Graph>,
}

/// Carries `source`, a `.ld` file or a text export, over as a program called `name`. The comments that the program
/// gets from this are in `language`.
///
/// # Errors
/// Where `source` is neither, or where the result cannot be proven to say the same.
pub fn import(source: &str, name: &str, language: Language) -> Result<Import, ImportError> {
    let mut carrier = Carrier::default();
    let program = carrier.names.instance_named(name);
    let mut head = Vec::new();
    let mut rungs = if native::is_native(source) {
        let Program { settings, pins, rungs, notes } = native::read(source);
        carrier.notes = notes;
        head.extend(
            settings
                .into_iter()
                .filter(|(key, _)| key != "COMPILED")
                .map(|(key, value)| format!("{key} = {value}")),
        );
        for (name, pin) in &pins {
            let number = carrier.names.of(name);
            carrier.names.get_mut(number).pin = if pin == "0" { String::new() } else { shown(pin) };
        }
        of_native(&mut carrier, rungs)
    } else if is_export(source) {
        let lines = source.lines().skip(1).take_while(|line| !line.starts_with("LADDER"));
        head.extend(lines.filter(|line| !line.trim().is_empty()).map(str::to_string));
        of_export(&mut carrier, source)
    } else {
        return Err(ImportError::Unknown);
    };
    for rung in &mut rungs {
        carrier.line = rung.line;
        if let Some(graph) = &mut rung.graph {
            name_counts(graph, &mut carrier);
        }
    }
    let printer = Printer { carrier, language, head, name: program };
    printer.finish(rungs)
}

fn is_export(source: &str) -> bool {
    let mut first = source.trim_start_matches('\u{feff}').lines().take(3);
    first.any(|line| line.starts_with("LDmicro export "))
}

fn of_native(carrier: &mut Carrier, source: Vec<(u32, Vec<Node>)>) -> Vec<Rung> {
    let mut rungs = Vec::new();
    let mut comments = Vec::new();
    let mut label = None;
    for (line, mut series) in source {
        carrier.line = line;
        series.retain(|node| match node {
            Node::Leaf(_, words) if words[0] == "COMMENT" => {
                comments.extend(words[1].split("\\r\\n").map(shown_comment));
                false
            }
            Node::Leaf(_, words) if words[0] == "LABEL" && words.len() > 1 => {
                label = Some(carrier.label(&words[1]));
                false
            }
            _ => true,
        });
        let mut graph = Graph::new();
        let ends = add_series(&mut graph, carrier, series, vec![(Graph::LEFT_RAIL, 0)], true);
        let comments = std::mem::take(&mut comments);
        if graph.elements.is_empty() {
            // A comment or a label alone belongs to what follows.
            if comments.is_empty() && label.is_none() {
                carrier.line = line;
                carrier.note(Message::new("import.empty-rung"));
            }
            rungs.push(Rung { line, comments, label: label.take(), graph: None });
            continue;
        }
        for end in ends {
            graph.add_arc(end, (Graph::RIGHT_RAIL, 0), &[]);
        }
        rungs.push(Rung { line, comments, label: label.take(), graph: Some(graph) });
    }
    rungs
}

type End = (VertexId, u16);

/// Adds a series behind the wires `tails`; returns the wires at its right.
fn add_series(
    graph: &mut Graph,
    carrier: &mut Carrier,
    series: Vec<Node>,
    mut tails: Vec<End>,
    last: bool,
) -> Vec<End> {
    let count = series.len();
    for (place, node) in series.into_iter().enumerate() {
        let is_last = last && place + 1 == count;
        match node {
            Node::Leaf(line, words) => {
                carrier.line = line;
                let Some(element) = leaf(carrier, &words) else { continue };
                let vertex = graph.add_element(element);
                let tail = joined(graph, tails);
                graph.add_arc(tail, (vertex, 0), &[]);
                tails = vec![(vertex, 0)];
            }
            Node::Parallel(_, mut branches) if branches.len() == 1 => {
                let inner = branches.pop().unwrap_or_default();
                tails = add_series(graph, carrier, inner, tails, is_last);
            }
            Node::Parallel(_, branches) => {
                let tail = forked(graph, tails);
                let mut ends = Vec::new();
                for branch in branches {
                    ends.extend(add_series(graph, carrier, branch, vec![tail], is_last));
                }
                tails = if is_last { ends } else { vec![joined(graph, ends)] };
            }
        }
    }
    tails
}

/// One wire out of several.
fn joined(graph: &mut Graph, tails: Vec<End>) -> End {
    match tails[..] {
        [tail] => tail,
        _ => {
            let junction = graph.add_vertex(VertexKind::Junction, &[]);
            for tail in tails {
                graph.add_arc(tail, (junction, 0), &[]);
            }
            (junction, 0)
        }
    }
}

/// A place at which the wire can part.
fn forked(graph: &mut Graph, tails: Vec<End>) -> End {
    let tail = joined(graph, tails);
    if tail.0 == Graph::LEFT_RAIL || graph.vertex(tail.0).kind == VertexKind::Junction {
        return tail;
    }
    let junction = graph.add_vertex(VertexKind::Junction, &[]);
    graph.add_arc(tail, (junction, 0), &[]);
    (junction, 0)
}

fn of_export(carrier: &mut Carrier, source: &str) -> Vec<Rung> {
    let target = Target::of(Model::Iec);
    let mut rungs = Vec::new();
    let (mut start, mut line) = (0, 1);
    let mut label = None;
    for end in split(source) {
        let chunk = source.get(start..end).unwrap_or("");
        if kind_of(chunk) == ChunkKind::Ldmicro {
            table_rows(chunk).iter().for_each(|row| declare(carrier, chunk, row));
        } else {
            of_chunk(carrier, chunk, &parse(chunk, target), line, &mut label, &mut rungs);
        }
        line += chunk.lines().count() as u32;
        start = end;
    }
    rungs
}

fn declare(carrier: &mut Carrier, chunk: &str, row: &TableRow) {
    let number = carrier.names.of(row.name.of(chunk));
    let name = carrier.names.get_mut(number);
    name.kind = row.kind.map_or(String::new(), |kind| kind.of(chunk).to_string());
    name.pin = row.pin.map_or(String::new(), |pin| pin.of(chunk).to_string());
}

fn of_chunk(
    carrier: &mut Carrier,
    chunk: &str,
    tree: &LadderTree,
    first_line: u32,
    label: &mut Option<String>,
    rungs: &mut Vec<Rung>,
) {
    let line_of = |offset: u32| {
        let before = chunk.get(..offset as usize).unwrap_or("");
        first_line + before.matches('\n').count() as u32
    };
    for problem in &tree.problems {
        carrier.line = line_of(problem.span.start);
        carrier.note(problem.message.clone());
    }
    let comments = tree.comments.iter().map(|comment| shown_comment(comment.of(chunk)));
    let mut comments: Vec<String> = comments.collect();
    for rung in &tree.rungs {
        let line = first_line + rung.lines.0;
        let first = rung.graph.elements.first();
        let is_end = |element: &Element| match element.kind {
            ElementKind::Instruction { mnemonic, .. } => mnemonic.of(chunk) == "END",
            _ => false,
        };
        if rung.graph.elements.len() == 1 && first.is_some_and(is_end) {
            continue;
        }
        let graph = rehomed(carrier, &rung.graph, chunk, first_line, label);
        let comments = std::mem::take(&mut comments);
        rungs.push(Rung { line, comments, label: label.take(), graph });
    }
    if !comments.is_empty() {
        rungs.push(Rung { line: first_line, comments, label: None, graph: None });
    }
}

/// The graph of an export with the elements of the standard; nothing if it has none.
fn rehomed(
    carrier: &mut Carrier,
    drawn: &Graph,
    chunk: &str,
    first_line: u32,
    label: &mut Option<String>,
) -> Option<Graph> {
    if let [only] = &drawn.elements[..]
        && let Some(block) = only.block().filter(|block| block.type_text(chunk) == Some("LABEL"))
        && !block.inputs.is_empty()
    {
        *label = Some(carrier.label(&only.operand_text(0, chunk)));
        return None;
    }
    let mut graph = drawn.clone();
    for element in &mut graph.elements {
        carrier.line = first_line + element.row;
        *element = carrier.drawn(element, chunk);
    }
    (!graph.elements.is_empty()).then_some(graph)
}

/// A line of a comment without what could end it.
fn shown_comment(line: &str) -> String {
    let line = line.trim().trim_start_matches(';').trim();
    line.replace("(*", "( *")
        .replace("*)", "* )")
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

struct Printer {
    carrier: Carrier,
    language: Language,
    head: Vec<String>,
    name: String,
}

impl Printer {
    fn finish(mut self, rungs: Vec<Rung>) -> Result<Import, ImportError> {
        let mut body = String::new();
        let mut graphs = Vec::new();
        let mut waiting: Vec<String> = Vec::new();
        for rung in rungs {
            self.carrier.line = rung.line;
            waiting.extend(rung.comments);
            if let Some(label) = &rung.label {
                push_comment(&mut body, &std::mem::take(&mut waiting));
                let _ = writeln!(body, "{label}:");
            }
            let Some(graph) = rung.graph else { continue };
            let drawing = self.drawing(&graph);
            if drawing.is_none() {
                let message = Message::new("import.undrawable").with("line", rung.line);
                waiting.push(message.render(self.language));
                self.carrier.note(Message::new("import.undrawable").with("line", rung.line));
            }
            push_comment(&mut body, &std::mem::take(&mut waiting));
            if let Some(drawing) = drawing {
                body.push_str(&drawing);
                graphs.push(graph);
            }
            body.push('\n');
        }
        push_comment(&mut body, &waiting);
        let text = self.text(&body);
        let proven = same_rungs(&text, &graphs, &self.carrier.words);
        let mut notes = self.carrier.notes;
        notes.sort_by_key(|note| note.line);
        let rungs = graphs.len();
        proven.then_some(Import { text, notes, rungs }).ok_or(ImportError::Unproven)
    }

    /// The canonical drawing of a rung, if it has one that reads back as the rung.
    fn drawing(&self, graph: &Graph) -> Option<String> {
        let shape = reduce(graph).ok()?;
        let drawing = print(&shape, graph, &self.carrier.words, &Style::default())?;
        let tree = parse(&drawing, Target::of(Model::Iec));
        let [rung] = &tree.rungs[..] else { return None };
        let same = rung.graph.same_logic(&drawing, graph, &self.carrier.words);
        let ordered = order(graph, &self.carrier.words) == order(&rung.graph, &drawing);
        (same && tree.problems.is_empty() && ordered).then_some(drawing)
    }

    fn text(&self, body: &str) -> String {
        let mut text = String::new();
        let mut head = vec![Message::new("import.head").render(self.language)];
        head.extend(self.head.iter().map(|line| shown_comment(line)));
        let mut notes: Vec<&Note> = self.carrier.notes.iter().collect();
        notes.sort_by_key(|note| note.line);
        for note in notes {
            let message = Message::new("import.note").with("line", note.line);
            head.push(shown_comment(
                &message.with("text", note.message.render(self.language)).render(self.language),
            ));
        }
        push_comment(&mut text, &head);
        let _ = writeln!(text, "PROGRAM {}", self.name);
        let declared = |name: &&super::names::Name| !name.declared.is_empty();
        let names: Vec<_> = self.carrier.names.all().filter(declared).collect();
        if !names.is_empty() {
            text.push_str("VAR\n");
            let widest = names.iter().map(|name| name.identifier.chars().count()).max().unwrap_or(0);
            for name in names {
                let _ = write!(text, "    {:widest$} : {};", name.identifier, name.declared);
                let about = self.about(name);
                let _ = if about.is_empty() { writeln!(text) } else { writeln!(text, " (* {about} *)") };
            }
            text.push_str("END_VAR\n");
        }
        let _ = write!(text, "\n{body}\nEND_PROGRAM\n");
        text
    }

    /// What the source says of a name: its spelling there, its type and its pin.
    fn about(&self, name: &super::names::Name) -> String {
        let mut about = Vec::new();
        if !name.original.is_empty() && name.original != name.identifier {
            about.push(name.original.clone());
        }
        if !name.kind.is_empty() {
            about.push(name.kind.clone());
        }
        if !name.pin.is_empty() {
            about.push(Message::new("import.pin").with("pin", &name.pin).render(self.language));
        }
        shown_comment(&about.join(", "))
    }
}

fn push_comment(text: &mut String, lines: &[String]) {
    match lines {
        [] => {}
        [line] => _ = writeln!(text, "(* {line} *)"),
        lines => _ = writeln!(text, "(* {} *)", lines.join("\n   ")),
    }
}

/// What acts, in the order in which it does: an earlier output is seen by a later one.
fn order<'t>(graph: &Graph, words: &'t str) -> Vec<std::borrow::Cow<'t, str>> {
    let acts = |element: &&Element| element.is_output() || element.block().is_some();
    let mut acting: Vec<&Element> = graph.elements.iter().filter(acts).collect();
    acting.sort_by_key(|element| (element.row, element.columns));
    acting.iter().map(|element| element.operand_text(0, words)).collect()
}

/// Whether the whole text has exactly these rungs.
fn same_rungs(text: &str, graphs: &[Graph], words: &str) -> bool {
    let target = Target::of(Model::Iec);
    let mut expected = graphs.iter();
    let mut start = 0;
    for end in split(text) {
        let chunk = text.get(start..end).unwrap_or("");
        start = end;
        let tree = parse(chunk, target);
        let declares = kind_of(chunk) == ChunkKind::Declarations;
        if !tree.problems.is_empty() && !declares {
            return false;
        }
        for rung in &tree.rungs {
            if !expected.next().is_some_and(|graph| rung.graph.same_logic(chunk, graph, words)) {
                return false;
            }
        }
    }
    expected.next().is_none()
}
