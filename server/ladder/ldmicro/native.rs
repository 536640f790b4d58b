//! Reads LDmicro's own file: settings, pins, and rungs as nested series and parallel circuits, a word a line.

use crate::text::Message;

/// Circuits nested deeper than this are not read; the program itself allows ten.
const DEEPEST: usize = 64;

/// A program as its file says it.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Program {
    /// `MICRO=`, `CYCLE=`, `CRYSTAL=` and so on, in order.
    pub settings: Vec<(String, String)>,
    /// Names with what follows `at`, as written.
    pub pins: Vec<(String, String)>,
    /// The rungs, top to bottom, each with the line on which it starts.
    pub rungs: Vec<(u32, Vec<Node>)>,
    /// What could not be read.
    pub notes: Vec<Note>,
}

/// Something to say about a line of the source, from 1.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Note {
    /// The line of the source, from 1.
    pub line: u32,
    /// What is to be said.
    pub message: Message,
}

/// A part of a series.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Node {
    /// An element: its line, and the words on it.
    Leaf(u32, Vec<String>),
    /// Branches side by side, each a series.
    Parallel(u32, Vec<Vec<Node>>),
}

/// Whether `text` starts as LDmicro's own files do.
pub(super) fn is_native(text: &str) -> bool {
    let line = text.trim_start_matches('\u{feff}').lines().next().unwrap_or("");
    let version = line.trim_end().strip_prefix("LDmicro");
    version.is_some_and(|version| version.starts_with(|c: char| c.is_ascii_digit()))
}

/// Reads a file, whatever it holds.
pub(super) fn read(text: &str) -> Program {
    let mut reader = Reader { lines: Vec::new(), at: 0, program: Program::default() };
    for (number, line) in (1..).zip(text.lines()) {
        reader.lines.push((number, line.trim()));
    }
    reader.at = 1;
    reader.head();
    reader.rungs();
    reader.program
}

struct Reader<'t> {
    lines: Vec<(u32, &'t str)>,
    at: usize,
    program: Program,
}

impl<'t> Reader<'t> {
    fn next(&mut self) -> Option<(u32, &'t str)> {
        let line = self.lines.get(self.at).copied();
        self.at += 1;
        line
    }

    fn note(&mut self, line: u32, message: Message) {
        let note = Note { line, message };
        // One line can end many circuits.
        if self.program.notes.last() != Some(&note) {
            self.program.notes.push(note);
        }
    }

    /// Everything before `PROGRAM`.
    fn head(&mut self) {
        while let Some((number, line)) = self.next() {
            match line {
                "" => {}
                "PROGRAM" => return,
                "IO LIST" => self.pins(),
                // The names in them are met in the rungs.
                "VAR LIST" | "PULL-UP LIST" => self.skip_list(line),
                "RUNG" => {
                    self.at -= 1;
                    return;
                }
                _ => match line.split_once('=') {
                    Some((key, value)) => {
                        self.program.settings.push((key.trim().to_string(), value.trim().to_string()));
                    }
                    None => self.unread(number, line),
                },
            }
        }
    }

    fn unread(&mut self, number: u32, line: &str) {
        self.note(number, Message::new("import.unread-line").with("text", shown(line)));
    }

    fn pins(&mut self) {
        while let Some((number, line)) = self.next() {
            let mut words = line.split_whitespace();
            match (words.next(), words.next()) {
                (Some("END"), None) => return,
                (None, _) => {}
                (Some(name), Some("at")) => {
                    let pin = words.next().unwrap_or("0");
                    self.program.pins.push((name.to_string(), pin.to_string()));
                }
                _ => self.unread(number, line),
            }
        }
    }

    fn skip_list(&mut self, list: &str) {
        let (first, mut names) = (self.at as u32, 0);
        while let Some((_, line)) = self.next() {
            match line {
                "END" => break,
                "" => {}
                _ => names += 1,
            }
        }
        if names > 0 && list == "PULL-UP LIST" {
            self.note(first, Message::new("import.pull-ups").with("count", names));
        }
    }

    fn rungs(&mut self) {
        while let Some((number, line)) = self.next() {
            match line.split_whitespace().next() {
                None => {}
                Some("RUNG") => {
                    let series = self.series(0);
                    self.program.rungs.push((number, series));
                }
                Some(_) => self.unread(number, line),
            }
        }
    }

    /// The elements up to `END`, the end of the file, or the next rung.
    fn series(&mut self, depth: usize) -> Vec<Node> {
        let mut nodes = Vec::new();
        while let Some((number, line)) = self.next() {
            match line.split_whitespace().next() {
                None => {}
                Some("END") => return nodes,
                Some("RUNG") => {
                    self.at -= 1;
                    self.note(number, Message::new("import.unclosed"));
                    return nodes;
                }
                Some("PARALLEL" | "SERIES") if depth >= DEEPEST => {
                    self.note(number, Message::new("import.too-deep").with("depth", DEEPEST));
                    self.skip_circuit();
                }
                Some("PARALLEL") => {
                    let branches = self.series(depth + 1).into_iter().map(|node| match node {
                        // A series inside a parallel circuit is a branch of its own.
                        Node::Parallel(0, mut series) if series.len() == 1 => series.remove(0),
                        node => vec![node],
                    });
                    nodes.push(Node::Parallel(number, branches.collect()));
                }
                // Kept as one branch, until its parallel circuit takes it.
                Some("SERIES") => {
                    let series = self.series(depth + 1);
                    nodes.push(Node::Parallel(0, vec![series]));
                }
                Some("COMMENT") => {
                    let text = line.strip_prefix("COMMENT").unwrap_or("").trim().to_string();
                    nodes.push(Node::Leaf(number, vec!["COMMENT".to_string(), text]));
                }
                Some(_) => {
                    nodes.push(Node::Leaf(number, line.split_whitespace().map(str::to_string).collect()));
                }
            }
        }
        let last = self.lines.last().map_or(1, |(number, _)| *number);
        self.note(last, Message::new("import.unclosed"));
        nodes
    }

    fn skip_circuit(&mut self) {
        let mut open = 1;
        while open > 0 {
            match self.next().map(|(_, line)| line) {
                Some("PARALLEL" | "SERIES") => open += 1,
                Some("END") => open -= 1,
                Some(_) => {}
                None => return,
            }
        }
    }
}

/// A line of a file that may be anything, short enough for a message.
pub(super) fn shown(line: &str) -> String {
    const LONGEST: usize = 60;
    let plain = line.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c });
    plain.take(LONGEST).collect()
}
