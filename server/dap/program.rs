//! The program that is debugged: read from the disk, compiled, and its places as the protocol names them.

use super::stack::names_at;
use crate::document::{Document, Notation, Tree};
use crate::project::{
    CommentsFile, MANIFEST_NAME, Stamp, Surroundings, is_program_file, open_document, read_text,
};
use crate::simulate::{Code, Drivers, HistoryLimit, Place, Problem, Variable, compile, instruction_words};
use crate::target::{Model, Target};
use crate::text::{Encoding, LineColumn, Message, Span};
use rustc_hash::FxHashMap;
use serde_json::{Value, json};
use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A program, ready to run.
#[derive(Debug)]
pub(super) struct Program {
    pub(super) files: Vec<File>,
    /// What its project allows the way back to take.
    pub(super) history: HistoryLimit,
    /// Code that says what it sees. The same code runs without breakpoints, so that a scan that the watchdog ends is
    /// ended at the same instruction.
    pub(super) code: Arc<Code>,
    /// What drives what, once somebody has asked why.
    pub(super) drivers: OnceCell<Drivers>,
    /// Instructions at which it can stop, in the order of the text.
    stops: Vec<Stop>,
    /// Where rungs begin, in the order of the text.
    rungs: Vec<Place>,
}

/// A file of it.
#[derive(Debug)]
pub(super) struct File {
    /// As the system names it.
    pub(super) path: PathBuf,
    pub(super) document: Document,
    stamp: Option<Stamp>,
    /// Whether it was said that it has changed on the disk.
    is_outdated: bool,
}

/// Where a program can stop.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Stop {
    pub(super) place: Place,
    /// The instructions there, by their numbers: of a function block one for each instance.
    pub(super) instructions: Vec<u32>,
}

/// A place as people count: lines and columns from 1, columns in UTF-16.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Lines {
    pub(super) line: u32,
    pub(super) column: u32,
    pub(super) end_line: u32,
    pub(super) end_column: u32,
}

impl Program {
    /// Reads and compiles what is at `path`: a program file with those of its project that are one program with it, or
    /// a folder with one program.
    ///
    /// # Errors
    /// A sentence that says why it cannot be run.
    pub(super) fn open(path: &Path) -> Result<Program, Message> {
        let path = path.canonicalize().map_err(|_| no_file(path))?;
        let path = match path.file_name() {
            Some(name) if name == MANIFEST_NAME => path.parent().unwrap_or(&path).to_path_buf(),
            _ => path,
        };
        let (files, history) = files_of(&path)?;
        let documents: Vec<&Document> = files.iter().map(|file| &file.document).collect();
        let code = compile(&documents, true).map_err(|problems| refusal(&files, &problems))?;
        let mut rungs: Vec<Place> =
            (0..).zip(&documents).flat_map(|(number, document)| rungs_of(number, document)).collect();
        rungs.sort_unstable_by_key(|place| (place.document, place.span.start));
        let mut known: FxHashMap<Place, Vec<u32>> = FxHashMap::default();
        for (number, place) in code.stops() {
            let instructions = known.entry(place).or_default();
            if !instructions.contains(&number) {
                instructions.push(number);
            }
        }
        let stop = |(place, instructions)| Stop { place, instructions };
        let mut stops: Vec<Stop> = known.into_iter().map(stop).collect();
        // At one start the rung comes before its elements.
        stops.sort_unstable_by_key(|Stop { place, .. }| {
            (place.document, place.span.start, std::cmp::Reverse(place.span.end))
        });
        Ok(Program { files, history, code: Arc::new(code), drivers: OnceCell::new(), stops, rungs })
    }

    /// The number of the file at `path`.
    pub(super) fn file_at(&self, path: &Path) -> Option<u32> {
        let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        self.files.iter().position(|file| file.path == path).map(|number| number as u32)
    }

    /// The document in which a place lies.
    pub(super) fn document(&self, place: Place) -> Option<&Document> {
        self.files.get(place.document as usize).map(|file| &file.document)
    }

    /// A place in lines and columns.
    pub(super) fn lines(&self, place: Place) -> Lines {
        let Some(document) = self.document(place) else {
            return Lines { line: 1, column: 1, end_line: 1, end_column: 1 };
        };
        let at = |offset: u32| document.position(offset as usize, Encoding::Utf16);
        let (start, end) = (at(place.span.start), at(place.span.end));
        Lines {
            line: start.line + 1,
            column: start.column + 1,
            end_line: end.line + 1,
            end_column: end.column + 1,
        }
    }

    /// The source of a place, as the protocol names it.
    pub(super) fn source(&self, place: Place) -> Value {
        self.files.get(place.document as usize).map_or(Value::Null, File::source)
    }

    /// How the instruction at a place is called.
    pub(super) fn words(&self, place: Place) -> String {
        self.document(place).map(|document| instruction_words(document, place.span)).unwrap_or_default()
    }

    /// The number of a drawn rung in its file, from 1 on; nothing for what is none.
    pub(super) fn rung_at(&self, place: Place) -> Option<usize> {
        let first = self.rungs.partition_point(|rung| rung.document < place.document);
        let own = self.rungs.iter().skip(first).take_while(|rung| rung.document == place.document);
        let is_drawn = self.document(place)?.notation() == Notation::Ladder;
        own.into_iter().position(|rung| *rung == place).filter(|_| is_drawn).map(|number| number + 1)
    }

    /// `motor.il:3`
    pub(super) fn shown(&self, place: Place) -> String {
        let name = self.files.get(place.document as usize).map(File::name).unwrap_or_default();
        format!("{name}:{}", self.lines(place).line)
    }

    /// The number of the rung in which a place lies.
    pub(super) fn rung(&self, place: Place) -> usize {
        self.rungs
            .partition_point(|rung| (rung.document, rung.span.start) <= (place.document, place.span.start))
    }

    /// The instructions of the lines `first` to `last` of a file at which it can stop.
    pub(super) fn stops_in(&self, file: u32, first: u32, last: u32) -> Vec<Place> {
        let own = self.stops.iter().map(|stop| stop.place).filter(|place| place.document == file);
        own.filter(|place| (first..=last).contains(&self.lines(*place).line)).collect()
    }

    /// The instruction at which a breakpoint of a line of a file stops: the one at the column, else the first of the
    /// line, else the one of a list that goes on in this line, else the first behind it.
    pub(super) fn stop_at(&self, file: u32, line: u32, column: Option<u32>) -> Option<&Stop> {
        let document = &self.files.get(file as usize)?.document;
        let offset =
            |line: u32, column: u32| document.offset(LineColumn { line, column }, Encoding::Utf16) as u32;
        let start = offset(line.saturating_sub(1), 0);
        let own = || self.stops.iter().filter(|stop| stop.place.document == file);
        let is_on_line = |place: &Place| self.lines(*place).line == line;
        if let Some(column) = column {
            let at = offset(line.saturating_sub(1), column.saturating_sub(1));
            let around = own().filter(|stop| (stop.place.span.start..stop.place.span.end).contains(&at));
            let element = around.min_by_key(|stop| stop.place.span.end - stop.place.span.start);
            // A rung is around all of its elements, and begins in its first line.
            let element = element.filter(|stop| is_on_line(&stop.place));
            let behind = || own().find(|stop| stop.place.span.start >= at && is_on_line(&stop.place));
            let stop = element.or_else(behind);
            if stop.is_some() {
                return stop;
            }
        }
        if let Some(stop) = own().find(|stop| is_on_line(&stop.place)) {
            return Some(stop);
        }
        // A call in a list has a line for each parameter.
        let is_list = document.notation() != Notation::Ladder;
        let goes_on = |stop: &&Stop| is_list && (stop.place.span.start..stop.place.span.end).contains(&start);
        own().rfind(goes_on).or_else(|| own().find(|stop| stop.place.span.start >= start))
    }

    /// Where a routine or program unit is entered that is called `name`.
    pub(super) fn entry(&self, name: &str) -> Option<Stop> {
        let instructions = self.code.entries(name);
        let first = instructions.first()?;
        let place = self.stops.iter().find(|stop| stop.instructions.contains(first))?.place;
        Some(Stop { place, instructions })
    }

    /// The instructions that name a variable.
    pub(super) fn naming(&self, variable: Variable) -> Vec<u32> {
        let names = |place: Place, instruction: u32| {
            let names = names_at(self, place);
            names.iter().any(|name| self.code.variable_from(instruction, name) == Some(variable))
        };
        let all = self.stops.iter().flat_map(|stop| stop.instructions.iter().map(|own| (stop.place, *own)));
        all.filter(|(place, instruction)| names(*place, *instruction)).map(|(_, own)| own).collect()
    }

    /// The files that have changed on the disk since they were read and of which that was not said yet.
    pub(super) fn newly_outdated(&mut self) -> Vec<String> {
        let changed =
            self.files.iter_mut().filter(|file| !file.is_outdated && Stamp::of(&file.path) != file.stamp);
        let names = changed.map(|file| {
            file.is_outdated = true;
            file.name()
        });
        names.collect()
    }
}

impl File {
    pub(super) fn name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    pub(super) fn source(&self) -> Value {
        json!({ "name": self.name(), "path": self.path.to_string_lossy() })
    }
}

fn no_file(path: &Path) -> Message {
    Message::new("cli.no-such-file").with("path", path.display())
}

/// The files of the program at a path, in the order of execution.
fn files_of(path: &Path) -> Result<(Vec<File>, HistoryLimit), Message> {
    let unread = |path: &Path| Message::new("debug.unreadable").with("path", path.display());
    if path.is_file() && !is_program_file(path) {
        return Err(Message::new("cli.no-program-file").with("path", path.display()));
    }
    let around = Surroundings::of(path).map_err(|_| unread(path))?;
    let project = around.project.as_ref();
    if let Some(error) = project.and_then(|project| project.error.as_ref()) {
        return Err(error.message.clone());
    }
    let manifest = project.map(|project| project.manifest.clone()).unwrap_or_default();
    let comments_file = project.and_then(|project| {
        let file = project.root.join(project.manifest.comments.as_ref()?);
        Some(CommentsFile::open(&file, manifest.target().unwrap_or(Target::of(Model::Fx2n))))
    });
    let comments = manifest.said_of_devices(comments_file.as_ref());
    let mut files = Vec::new();
    for path in &around.files {
        let path = path.canonicalize().map_err(|_| unread(path))?;
        let stamp = Stamp::of(&path);
        let text = read_text(&path).ok_or_else(|| unread(&path))?;
        let document = open_document(&path.to_string_lossy(), &text, &manifest, None, None);
        let document = document.commented(&comments);
        files.push(File { path, document, stamp, is_outdated: false });
    }
    let documents: Vec<&Document> = files.iter().map(|file| &file.document).collect();
    let mut programs = around.programs(&documents);
    let numbers = match programs.len() {
        0 => return Err(Message::new("cli.no-programs")),
        1 => programs.swap_remove(0),
        _ => return Err(Message::new("debug.many-programs").with("path", path.display())),
    };
    let mut files: Vec<Option<File>> = files.into_iter().map(Some).collect();
    let files = numbers.into_iter().filter_map(|number| files.get_mut(number)?.take()).collect();
    Ok((files, manifest.history()))
}

/// Where the rungs of a document begin.
fn rungs_of(number: u32, document: &Document) -> Vec<Place> {
    let mut rungs = Vec::new();
    for at in document.chunks() {
        let reading = at.chunk.reading();
        let place = |span: Span| Place { document: number, span: span.shifted(at.start) };
        match reading.tree() {
            Tree::Ladder(tree) => rungs.extend(tree.rungs.iter().map(|rung| place(rung.span))),
            _ => rungs.push(place(Span::new(0, at.chunk.len()))),
        }
    }
    rungs
}

/// Why programs cannot be compiled, with the place of the first problem.
fn refusal(files: &[File], problems: &[Problem]) -> Message {
    let Some(first) = problems.first() else { return Message::new("simulate.not-running") };
    let file = files.get(first.place.document as usize);
    let line = file.map_or(0, |file| file.document.line_of(first.place.span.start as usize) + 1);
    Message::new("debug.refused")
        .with("file", file.map(|file| file.name()).unwrap_or_default())
        .with("line", line)
        .with_messages("reason", vec![first.obstacle.message()])
}
