//! The outline: program units with their variables, networks, steps, labels, rungs with the outputs they drive.

use super::{SymbolKind, SymbolNode, declared};
use crate::document::{Chunk, Document, Operation, Tree};
use crate::il::fx::{FxTree, LineKind};
use crate::il::iec::{IecTree, ItemKind, Run};
use crate::ladder::LadderTree;
use crate::target::{Flow, Role};
use crate::text::{Language, Message, Span};

/// The longest comment that becomes a part of a rung's name, in characters.
const TITLE_LENGTH: usize = 60;

pub(super) fn of(
    document: &Document,
    language: Language,
    is_cancelled: impl Fn() -> bool,
) -> Vec<SymbolNode> {
    let mut outline = Outline { language, open: Vec::new(), roots: Vec::new(), rungs: 0, subroutines: false };
    for at in document.chunks().take_while(|_| !is_cancelled()) {
        let chunk = &*at.chunk.reading();
        let at = Here { start: at.start, chunk };
        match chunk.tree() {
            Tree::Fx(tree) => outline.fx(at, tree),
            Tree::Ladder(tree) => outline.ladder(at, tree),
            Tree::Iec(tree) => outline.iec(at, tree),
        }
    }
    outline.close(0);
    outline.roots
}

/// A chunk at its place in the document.
#[derive(Clone, Copy)]
struct Here<'a> {
    start: usize,
    chunk: &'a Chunk,
}

struct Outline {
    language: Language,
    /// Nodes that take what follows, outermost first.
    open: Vec<SymbolNode>,
    roots: Vec<SymbolNode>,
    rungs: usize,
    /// Whether the main program has ended, so that labels are subroutines.
    subroutines: bool,
}

/// How deep a node that others open below stands.
fn level(kind: SymbolKind) -> usize {
    match kind {
        SymbolKind::Network | SymbolKind::Label => 1,
        SymbolKind::Step => 2,
        SymbolKind::Rung | SymbolKind::Section | SymbolKind::Variable | SymbolKind::Type => 3,
        SymbolKind::Program
        | SymbolKind::FunctionBlock
        | SymbolKind::Function
        | SymbolKind::Configuration => 0,
    }
}

impl Outline {
    fn fx(&mut self, at: Here<'_>, tree: &FxTree) {
        let text = at.chunk.text();
        for line in &tree.lines {
            let span = line.mnemonic.shifted(at.start);
            let end = line.span.shifted(at.start).end;
            match line.kind {
                LineKind::Label(_) => {
                    let name = line.mnemonic.of(text).trim_end_matches(':').to_ascii_uppercase();
                    let name = match self.subroutines {
                        true => Message::new("outline.subroutine").with("name", name).render(self.language),
                        false => name,
                    };
                    self.begin(node(name, SymbolKind::Label, Span { start: span.start, end }, span));
                }
                LineKind::Instruction(form) => match form.instruction.flow() {
                    Flow::Step => {
                        let state = tree.operands(line).first().map_or("", |operand| operand.span.of(text));
                        let name = Message::new("outline.step").with("name", state.to_ascii_uppercase());
                        let name = name.render(self.language);
                        self.begin(node(name, SymbolKind::Step, Span { start: span.start, end }, span));
                    }
                    Flow::StepsEnd => self.close(level(SymbolKind::Step)),
                    Flow::MainEnd => {
                        self.close(level(SymbolKind::Label));
                        self.subroutines = true;
                    }
                    Flow::SubroutineEnd | Flow::InterruptEnd | Flow::ProgramEnd => {
                        self.close(level(SymbolKind::Label));
                    }
                    _ => {}
                },
                LineKind::Unknown => {}
            }
        }
        let drives = |form: crate::target::Form| form.instruction.role == Role::Output;
        if at.chunk.operations().any(|operation| operation.form.is_some_and(drives))
            && let (Some(first), Some(last)) = (tree.lines.first(), tree.lines.last())
        {
            let span = Span { start: first.span.start, end: last.span.end };
            let title = title(text, &tree.comments, first.span.start);
            self.rung(at, span, first.span, title.as_deref());
        }
    }

    fn ladder(&mut self, at: Here<'_>, tree: &LadderTree) {
        let text = at.chunk.text();
        if let Some(header) = &tree.header {
            let span = header.span.shifted(at.start);
            let message = match header.number {
                Some(number) => Message::new("outline.network").with("number", number.value),
                None => Message::new("outline.network-plain"),
            };
            let title = header.title.map(|title| title.of(text));
            let name = match (header.label.map(|label| label.of(text)), title) {
                (Some(label), None) if header.number.is_none() => label.to_string(),
                (_, Some(title)) => format!("{}: {title}", message.render(self.language)),
                (_, None) => message.render(self.language),
            };
            self.begin(node(name, SymbolKind::Network, span, span));
        }
        for (place, rung) in tree.rungs.iter().enumerate() {
            let title = if place == 0 { title(text, &tree.comments, rung.span.start) } else { None };
            let first_line =
                rung.span.of(text).find('\n').map_or(rung.span.end, |end| rung.span.start + end as u32);
            self.rung(at, rung.span, Span { start: rung.span.start, end: first_line }, title.as_deref());
        }
    }

    fn iec(&mut self, at: Here<'_>, tree: &IecTree) {
        let text = at.chunk.text();
        for item in &tree.items {
            let span = item.span.shifted(at.start);
            let named =
                |name: Option<Span>| name.map_or(("", span), |name| (name.of(text), name.shifted(at.start)));
            match item.kind {
                ItemKind::Pou { kind, name, result } => {
                    let (name, selection) = named(name);
                    let mut unit = node(name.to_string(), kind.into(), span, selection);
                    unit.detail = result.map_or_else(
                        || declared::pou_keyword(kind).to_string(),
                        |id| tree.type_spec(id).span.of(text).to_string(),
                    );
                    self.begin(unit);
                }
                ItemKind::Configuration { name } => {
                    let (name, selection) = named(name);
                    self.begin(node(name.to_string(), SymbolKind::Configuration, span, selection));
                }
                ItemKind::Task(index) => {
                    let task = tree.tasks.get(index as usize).and_then(|task| task.name);
                    self.leaf(named(task), "TASK", SymbolKind::Variable, span);
                }
                ItemKind::Instance(index) => {
                    let instance = tree.instances.get(index as usize).and_then(|instance| instance.name);
                    self.leaf(named(instance), "PROGRAM", SymbolKind::Variable, span);
                }
                ItemKind::PouEnd(_) => self.end(span.end),
                ItemKind::End(crate::il::iec::FileKeyword::Configuration) => self.end(span.end),
                ItemKind::Section { kind, declarations, .. } => {
                    let keyword = declared::section_keyword(kind);
                    let selection =
                        Span { start: span.start, end: (span.start + keyword.len() as u32).min(span.end) };
                    let mut section = node(keyword.to_string(), SymbolKind::Section, span, selection);
                    section.children = variables(at, tree, declarations, SymbolKind::Variable);
                    self.add(section);
                }
                ItemKind::Types { declarations } => {
                    for declared in variables(at, tree, declarations, SymbolKind::Type) {
                        self.add(declared);
                    }
                }
                ItemKind::Label { name } => {
                    let selection = name.shifted(at.start);
                    self.add(node(name.of(text).to_string(), SymbolKind::Label, selection, selection));
                }
                _ => {}
            }
        }
    }

    fn leaf(&mut self, (name, selection): (&str, Span), detail: &str, kind: SymbolKind, span: Span) {
        let mut leaf = node(name.to_string(), kind, span, selection);
        leaf.detail = detail.to_string();
        self.add(leaf);
    }

    fn rung(&mut self, at: Here<'_>, span: Span, first_line: Span, title: Option<&str>) {
        self.rungs += 1;
        let mut name = Message::new("outline.rung").with("number", self.rungs).render(self.language);
        if let Some(title) = title {
            name += &format!(": {title}");
        }
        let mut rung = node(name, SymbolKind::Rung, span.shifted(at.start), first_line.shifted(at.start));
        rung.detail = outputs(at.chunk, span);
        self.add(rung);
    }

    fn add(&mut self, node: SymbolNode) {
        for open in &mut self.open {
            open.span = open.span.to(node.span);
        }
        match self.open.last_mut() {
            Some(open) => open.children.push(node),
            None => self.roots.push(node),
        }
    }

    /// Closes what stands as deep as `node` or deeper, and puts what follows below it.
    fn begin(&mut self, node: SymbolNode) {
        self.close(level(node.kind));
        for open in &mut self.open {
            open.span = open.span.to(node.span);
        }
        self.open.push(node);
    }

    fn close(&mut self, least: usize) {
        while let Some(last) = self.open.pop() {
            if level(last.kind) < least {
                self.open.push(last);
                return;
            }
            self.add(last);
        }
    }

    /// Closes everything with a word that ends at `end`.
    fn end(&mut self, end: u32) {
        if let Some(outermost) = self.open.first_mut() {
            outermost.span.end = outermost.span.end.max(end);
        }
        self.close(0);
    }
}

fn node(name: String, kind: SymbolKind, span: Span, selection: Span) -> SymbolNode {
    // Clients refuse nodes without a name.
    let name = if name.is_empty() { "?".to_string() } else { name };
    SymbolNode { name, detail: String::new(), kind, span, selection, children: Vec::new() }
}

fn variables(at: Here<'_>, tree: &IecTree, declarations: Run, kind: SymbolKind) -> Vec<SymbolNode> {
    let text = at.chunk.text();
    let declarations = declarations.of(&tree.declarations).iter();
    let nodes = declarations.flat_map(|declaration| {
        let detail = declaration.declared.map_or("", |id| tree.type_spec(id).span.of(text));
        let detail = detail.split_whitespace().collect::<Vec<_>>().join(" ");
        declaration.names.of(&tree.names).iter().map(move |name| {
            let selection = name.shifted(at.start);
            let mut variable = node(
                name.of(text).to_string(),
                kind,
                declaration.span.shifted(at.start).to(selection),
                selection,
            );
            variable.detail = detail.clone();
            variable
        })
    });
    nodes.collect()
}

/// What the instructions or elements in `span` drive, each once: `Y0, T0`.
fn outputs(chunk: &Chunk, span: Span) -> String {
    let mut names: Vec<String> = Vec::new();
    let mentions = chunk.mentions();
    let first = mentions.partition_point(|mention| mention.span.start < span.start);
    for mention in mentions[first..].iter().take_while(|mention| mention.span.start < span.end) {
        if mention.usage.writes() {
            let name = mention.span.of(chunk.text()).to_string();
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    if names.is_empty() {
        // Calls, jumps and their like drive no device.
        let inside = |operation: &Operation<'_>| {
            span.start <= operation.symbol.start && operation.symbol.end <= span.end
        };
        let drives = |operation: &Operation<'_>| {
            operation.form.is_some_and(|form| form.instruction.role == Role::Output)
        };
        for operation in chunk.operations().filter(|operation| inside(operation) && drives(operation)) {
            let words = operation.operands.iter().fold(operation.symbol, |all, operand| all.to(operand.span));
            names.push(words.of(chunk.text()).to_string());
        }
    }
    names.join(", ")
}

/// The first line of the comment above a rung.
fn title(text: &str, comments: &[Span], rung: u32) -> Option<String> {
    let above = comments.iter().rfind(|comment| comment.end <= rung)?;
    let mut first = *above;
    for comment in comments.iter().rev().filter(|comment| comment.end <= above.start) {
        let between = text.get(comment.end as usize..first.start as usize).unwrap_or("x");
        // Between the lines of a comment of an LDmicro export are its rails and the number of the rung.
        let rails = |c: char| c.is_whitespace() || c.is_ascii_digit() || c == '|';
        if !between.trim_matches(rails).is_empty() || between.matches('\n').count() != 1 {
            break;
        }
        first = *comment;
    }
    let words =
        first.of(text).trim_start_matches(['(', '*', '/', ';', '{']).trim_end_matches([')', '*', '}']);
    let line = words.trim().lines().next()?.trim();
    (!line.is_empty()).then(|| line.chars().take(TITLE_LENGTH).collect())
}
