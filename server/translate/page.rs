//! Puts translated rungs together to a text, with their comments and labels.

use super::header;
use super::source::{Program, Source};
use super::to_fx::Line;
use super::to_iec::{self, Helper, Helpers};
use super::{Options, To, Translated, Translation, to_boolean, to_fx, to_ladder};
use crate::document::{Document, Notation};
use crate::ladder::{Drawing, Style};
use crate::logic::{Drive, Network, Path};
use crate::target::Target;
use crate::text::Message;

/// A rung in its new form.
enum Body {
    /// Comments and labels only.
    Nothing,
    /// Instructions.
    Lines(Vec<Line>),
    /// Instructions of IEC 61131-3 as they are laid out.
    Text(String),
    /// Drawings that have no right rail yet, one below the other.
    Drawings(Vec<Drawing>),
    /// Equations.
    Equations(Vec<String>),
    /// What had no other form, as it stands in the source, with the reason.
    Kept(String, Message),
}

/// The text of `program` in another form, without certificates, and the variables that it needs beyond those of the
/// source; nothing if it was cancelled on the way. A whole one
/// gets the declarations that it lacks.
pub(super) fn write(
    document: &Document,
    program: &Program,
    (to, target): (To, &'static Target),
    options: &Options,
    is_whole: bool,
    is_cancelled: &dyn Fn() -> bool,
) -> Option<(Translation, Vec<Helper>)> {
    let sources = &program.rungs;
    let mut helpers = match to {
        To::Iec => {
            let helpers = Helpers::beside(header::names(document, sources.iter()));
            if is_whole { header::with_spare(helpers, document, sources) } else { helpers }
        }
        _ => Helpers::default(),
    };
    let is_moved = document.target().model != target.model;
    let mut unless_cancelled =
        |source| (!is_cancelled()).then(|| body(source, (to, target), is_moved, options, &mut helpers));
    let bodies: Vec<Body> = sources.iter().map(&mut unless_cancelled).collect::<Option<_>>()?;
    let drawings = bodies.iter().flat_map(|body| match body {
        Body::Drawings(drawings) => &drawings[..],
        _ => &[],
    });
    let rail = drawings
        .map(Drawing::rail_column_min)
        .max()
        .unwrap_or(0)
        .max(options.style.width.clamp(1, Style::WIDTH_MAX) - 1);
    let mut page = Page { text: String::new(), to, rail };
    let needs_header = to == To::Iec && is_whole && !sources.is_empty() && !header::has_units(document);
    if needs_header {
        page.declare(&header::header(document, program, &helpers.declared));
    }
    let mut rungs = Vec::with_capacity(sources.len());
    for (source, body) in sources.iter().zip(bodies) {
        if !source.declarations.is_empty() {
            page.declare(&source.declarations);
            page.declare(&header::helpers_of(&helpers.declared, source.pou));
        }
        page.head(source);
        let start = page.text.len();
        let note = page.body(body, source);
        let end = page.text.len();
        page.comments(source, true);
        let is_kept = note.is_some();
        let result = start..end;
        rungs.push(Translated { span: source.span(), result, certificate: None, note, is_kept });
    }
    page.declare(&program.tail);
    if needs_header {
        page.declare("END_PROGRAM\n");
    }
    // Declarations are parted from what follows; nothing follows.
    while page.text.ends_with("\n\n") {
        page.text.pop();
    }
    let length = page.text.len();
    for rung in &mut rungs {
        rung.result = rung.result.start.min(length)..rung.result.end.min(length);
    }
    if to == To::Fx && options.is_whole && !sources.iter().any(ends_program) {
        page.text.push_str("END\n");
    }
    if to == To::Iec {
        page.lay_out(&mut rungs);
    }
    let names = helpers.declared.iter().map(|helper| helper.name.clone()).collect();
    Some((Translation { text: page.text, rungs, helpers: names }, helpers.declared))
}

fn body(
    source: &Source,
    (to, target): (To, &Target),
    is_moved: bool,
    options: &Options,
    helpers: &mut Helpers,
) -> Body {
    let kept = |reason: Message| Body::Kept(source.rung.span.of(source.chunk.text()).to_string(), reason);
    let path = match &source.rung.path {
        Ok(None) => return Body::Nothing,
        Ok(Some(path)) => path,
        Err(refusal) => return kept(source.note.clone().unwrap_or_else(|| refusal.message())),
    };
    let written = match to {
        To::Fx => {
            let lines = to_fx::lines(path, target);
            // What a document has for its own model is not for the translation to judge.
            let fit =
                lines.and_then(|lines| if is_moved { to_fx::on_model(lines, target) } else { Ok(lines) });
            fit.map(Body::Lines)
        }
        To::Iec => {
            helpers.pou = source.pou;
            to_iec::lines(path, helpers).map(|lines| Body::Text(header::laid_out(&(lines.join("\n") + "\n"))))
        }
        To::Boolean => to_boolean::equations(path, options.notation).map(Body::Equations),
        To::Ladder => rungs_of(path, source.rung.is_list)
            .into_iter()
            .map(|path| drawing(path, target, options))
            .collect::<Result<_, _>>()
            .map(Body::Drawings),
    };
    written.unwrap_or_else(kept)
}

/// What is drawn as a rung of its own: of a list each path that begins at the left rail.
fn rungs_of(path: &Path, is_list: bool) -> Vec<&Path> {
    let at_rail = path.drives.iter().map(|drive| match drive {
        Drive::Path(path) => Some(path),
        Drive::Action(_) => None,
    });
    let parts: Option<Vec<&Path>> = at_rail.collect();
    parts.filter(|_| is_list && path.gates.is_empty()).unwrap_or_else(|| vec![path])
}

fn drawing(path: &Path, target: &Target, options: &Options) -> Result<Drawing, Message> {
    let plan = to_ladder::plan(path, target.model)?;
    let drawing = Drawing::new(&plan.shape, &plan.graph, &plan.source, options.style.kind);
    drawing.ok_or_else(|| Message::new("translate.no-drawing"))
}

/// Whether the program ends with this rung.
fn ends_program(source: &Source) -> bool {
    let Ok(Some(path)) = &source.rung.path else { return false };
    path.actions().iter().any(|action| action.deed.ends_program())
}

struct Page {
    text: String,
    to: To,
    /// The column of the right rail.
    rail: u32,
}

impl Page {
    /// What stands above a rung: a blank line, comments, the network's name, labels.
    fn head(&mut self, source: &Source) {
        let rung = &source.rung;
        let has_comments = rung.comments.iter().any(|comment| !source.is_behind(comment));
        let has_head = has_comments || rung.network.is_some();
        // Rungs that are drawn need a blank line between them; lists breathe only where there is something to say.
        // The load behind a call would go on with its rung.
        let is_called = self.to == To::Iec && self.text.ends_with(")\n");
        let parts = self.to == To::Ladder || has_head || is_called;
        if !self.text.is_empty() && parts && !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
        if let Some(network) = &rung.network {
            self.network(&network_text(network));
        }
        self.comments(source, false);
        for label in &rung.labels {
            match self.to {
                To::Fx => self.line(label),
                _ => self.line(&format!("{label}:")),
            }
        }
    }

    /// The comments of a rung: those above and beside it, or those `behind` it at the end of the program.
    fn comments(&mut self, source: &Source, behind: bool) {
        let mut end = behind.then_some(source.rung.span.end);
        for (comment, span) in source.comments().zip(&source.rung.comments) {
            if source.is_behind(span) != behind {
                continue;
            }
            // Directly below a drawing it would be a part of it.
            let is_below_drawing = self.to == To::Ladder && self.text.ends_with("+\n");
            if is_below_drawing || end.is_some_and(|end| source.has_blank_line(end, span.start)) {
                self.line("");
            }
            end = Some(span.end);
            match self.to {
                _ if is_network(comment) => self.network(comment.trim_start_matches([';', ' '])),
                To::Iec => self.line(&header::comment(comment)),
                _ => self.line(comment),
            }
        }
    }

    /// The line that begins a network: one of its own in a drawing, a comment in lists and among equations.
    fn network(&mut self, text: &str) {
        match self.to {
            To::Ladder => self.line(text),
            To::Iec => self.line(&format!("(* {text} *)")),
            _ => self.line(&format!("; {text}")),
        }
    }

    /// Writes the rung; the note says why it could not be written.
    fn body(&mut self, body: Body, source: &Source) -> Option<Message> {
        match body {
            Body::Nothing => {}
            Body::Lines(lines) => lines.iter().for_each(|line| self.line(&line.to_string())),
            Body::Text(text) => self.text.push_str(&text),
            Body::Equations(equations) => equations.iter().for_each(|equation| self.line(equation)),
            Body::Drawings(drawings) => {
                let painted = drawings.iter().map(|drawing| drawing.paint(self.rail));
                let Some(painted) = painted.collect::<Option<Vec<_>>>() else {
                    let text = source.rung.span.of(source.chunk.text());
                    return self.kept(text, source.rung.is_list, Message::new("translate.no-drawing"));
                };
                for (number, lines) in painted.iter().enumerate() {
                    if number > 0 {
                        self.text.push('\n');
                    }
                    lines.iter().for_each(|line| self.line(line));
                }
            }
            Body::Kept(text, reason) => return self.kept(&text, source.rung.is_list, reason),
        }
        None
    }

    /// What cannot be translated is carried along as it is: a list in a box that the drawing does not look into, a
    /// drawing as comments.
    fn kept(&mut self, text: &str, is_list: bool, reason: Message) -> Option<Message> {
        match self.to {
            To::Fx if is_list => text.lines().for_each(|line| self.line(line.trim())),
            To::Ladder if is_list => {
                self.line("{il");
                flush(text).for_each(|line| self.line(line));
                self.line("}");
            }
            To::Iec if is_list => {
                let laid_out = header::laid_out(&format!("{}\n", text.trim_end()));
                self.text += &laid_out;
            }
            To::Iec => flush(text).for_each(|line| self.line(&header::comment(&format!("; {line}")))),
            _ => flush(text).for_each(|line| self.line(format!("; {line}").trim_end())),
        }
        Some(reason)
    }

    /// Comments are indented like what they stand above.
    fn lay_out(&mut self, rungs: &mut [Translated]) {
        let laid_out = header::laid_out(&self.text);
        let starts = |text: &str| -> Vec<usize> {
            let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1);
            std::iter::once(0).chain(ends).collect()
        };
        let (before, after) = (starts(&self.text), starts(&laid_out));
        if before.len() != after.len() {
            return;
        }
        for rung in rungs {
            let place = |at: usize| before.binary_search(&at).map(|line| after[line]);
            if let (Ok(start), Ok(end)) = (place(rung.result.start), place(rung.result.end)) {
                rung.result = start..end;
            }
        }
        self.text = laid_out;
    }

    /// Declarations, which stand in instruction list as in drawings.
    fn declare(&mut self, text: &str) {
        let text = text.trim_matches(['\r', '\n']);
        if text.is_empty() {
            return;
        }
        if !matches!(self.to, To::Iec | To::Ladder) {
            // Devices need no declarations, but what is said of them stays.
            return header::comments(text).iter().for_each(|comment| self.line(comment));
        }
        if !self.text.is_empty() && !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
        match self.to {
            To::Iec => self.text += &header::laid_out(&format!("{text}\n")),
            _ => text.lines().for_each(|line| self.line(line.trim_end())),
        }
        if !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }
}

/// The lines of a rung, whose first one was taken without its margin, without the margin of the others.
fn flush(text: &str) -> impl Iterator<Item = &str> {
    let margin = |line: &str| line.len() - line.trim_start_matches([' ', '\t']).len();
    let others = text.lines().skip(1).filter(|line| !line.trim().is_empty());
    let common = others.map(margin).min().unwrap_or(0);
    text.lines().enumerate().map(move |(number, line)| {
        let line = if number == 0 { line } else { line.get(common..).unwrap_or_default() };
        line.trim_end()
    })
}

/// `; NETWORK 3 'title'`: the name of a network where only comments can have it.
fn is_network(comment: &str) -> bool {
    let Some(text) = comment.strip_prefix(';') else { return false };
    let text = text.trim_start();
    let is_word = text.get(..7).is_some_and(|word| word.eq_ignore_ascii_case("NETWORK"));
    is_word && text.get(7..).is_some_and(|rest| rest.trim_end().is_empty() || rest.starts_with(' '))
}

fn network_text(network: &Network) -> String {
    let mut text = "NETWORK".to_string();
    if let Some(number) = network.number {
        text += &format!(" {number}");
    }
    if !network.title.is_empty() {
        text += &format!(" '{}'", network.title);
    }
    text
}

/// The notation of the document that a translation is; equations are none.
pub(super) fn notation(to: To) -> Option<Notation> {
    match to {
        To::Ladder => Some(Notation::Ladder),
        To::Fx => Some(Notation::FxIl),
        To::Iec => Some(Notation::IecIl),
        To::Boolean => None,
    }
}
