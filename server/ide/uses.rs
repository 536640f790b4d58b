//! Where a thing is used: its writers and readers with the rung, the line and what stands there.

use super::names::{self, Named, Thing};
use super::{across, devices};
use crate::document::{Chunk, ChunkRef, Document, Names, ProjectView, Symbol, Tree, Use};
use crate::ladder::{CoilKind, ContactKind, ElementKind, Rung};
use crate::target::Operand;
use crate::text::{Language, Message};

/// The longest line that is shown, in characters.
const TEXT_LENGTH: usize = 60;

/// So many conditions of a drawn rung are shown.
const CONDITIONS: usize = 6;

/// A place where a thing is used.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Place {
    /// The number of the file in the view.
    pub file: usize,
    /// The line, from 0.
    pub line: u32,
    /// The number of the rung in its file, from 1, if it is part of one.
    pub rung: Option<usize>,
    /// The instruction, or the conditions and outputs of a drawn rung.
    pub text: String,
}

/// The first places of one kind of use, and how many there are.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Group {
    pub places: Vec<Place>,
    /// How many mentions the places stand for.
    pub shown: usize,
    /// All mentions.
    pub total: usize,
}

/// All uses of a thing.
#[derive(Clone, PartialEq, Debug, Default)]
pub(super) struct Uses {
    pub declared: Group,
    pub jumps: Group,
    pub writes: Group,
    pub reads: Group,
    /// The preset of a timer or counter, and how it is written.
    pub preset: Option<(Operand, String)>,
}

/// The uses of `thing` in all files of `view`, at most `most` places of each kind.
///
/// A page whose uses are only counted is not entered, so a device that is used in thousands of rungs costs no more
/// than one look at each page's table of names.
pub(super) fn collect(view: &ProjectView<'_>, thing: &Thing, most: usize) -> Uses {
    let mut uses = Uses::default();
    let mut files = across::files(view, thing);
    // The file that is looked at comes first: its uses are the ones that one most likely asks about.
    files.sort_by_key(|file| (file.file != view.here_number(), file.file));
    for file in files {
        let mut search = Search { document: file.document, file: file.file, most, uses: &mut uses };
        search.run(&file.thing);
    }
    uses
}

struct Search<'v, 'u> {
    document: &'v Document,
    file: usize,
    most: usize,
    uses: &'u mut Uses,
}

impl Search<'_, '_> {
    fn run(&mut self, thing: &Thing) {
        let (document, file, most) = (self.document, self.file, self.most);
        let symbol = match thing {
            Thing::Devices(device, 1) if !thing.is_label() => Some(Symbol::Device(*device)),
            Thing::Direct(address) => Some(Symbol::Direct(*address)),
            _ => None,
        };
        // Both closures look at the same groups, one after the other.
        let uses = std::cell::RefCell::new(&mut *self.uses);
        let enter = |names: &Names| {
            let mut uses = uses.borrow_mut();
            let Some(symbol) = &symbol else { return true };
            if let Symbol::Device(device) = symbol
                && names.in_run(*device)
            {
                return true;
            }
            let (reads, writes) = names.accesses(symbol);
            let enough = (reads == 0 || uses.reads.places.len() >= most)
                && (writes == 0 || uses.writes.places.len() >= most)
                && names.contains(symbol)
                && reads + writes > 0;
            if enough {
                uses.reads.total += reads as usize;
                uses.writes.total += writes as usize;
            }
            !enough
        };
        names::visit_where(document, thing, enter, |place| {
            let mut uses = uses.borrow_mut();
            if uses.preset.is_none() {
                uses.preset = preset_at(thing, &place);
            }
            let add = |group: &mut Group| group.add(document, file, &place, most);
            match place.usage {
                Use::Declare => add(&mut uses.declared),
                Use::Jump => add(&mut uses.jumps),
                usage => {
                    if usage.writes() {
                        add(&mut uses.writes);
                    }
                    if usage.reads() {
                        add(&mut uses.reads);
                    }
                }
            }
        });
    }
}

impl Group {
    fn add(&mut self, document: &Document, file: usize, named: &Named<'_>, most: usize) {
        self.total += 1;
        let line = document.line_of(named.span.start as usize);
        if self.places.last().is_some_and(|last| last.file == file && last.line == line) {
            self.shown += 1;
            return;
        }
        if self.places.len() < most {
            self.shown += 1;
            let at = ChunkRef { start: named.chunk_start, chunk: named.chunk };
            let inside = named.inside().start as usize;
            let rung = rung_number(document, at, inside);
            self.places.push(Place { file, line, rung, text: text_at(at, inside) });
        }
    }
}

fn preset_at(thing: &Thing, place: &Named<'_>) -> Option<(Operand, String)> {
    let Thing::Devices(device, 1) = thing else { return None };
    if !place.usage.writes() || !device.kind.has_preset() {
        return None;
    }
    let found = devices::preset_of(place.chunk, *device)?;
    Some((found.value, found.span.of(place.chunk.text()).to_string()))
}

/// The number of the rung at byte `inside` of the chunk `at`, from 1 in its document; nothing outside of rungs.
pub(super) fn rung_number(document: &Document, at: ChunkRef<'_>, inside: usize) -> Option<usize> {
    let own = rung_in(at.chunk, inside)?;
    let (mut before, mut start) = (0, 0);
    for page in document.pages() {
        if start + page.bytes() <= at.start {
            before += page.size().rungs;
            start += page.bytes();
            continue;
        }
        for chunk in page.chunks() {
            if start >= at.start {
                return Some(before + own);
            }
            before += chunk.size().rungs;
            start += chunk.len();
        }
    }
    Some(before + own)
}

/// The number of the rung at byte `inside` of `chunk`, from 1 in the chunk.
pub(super) fn rung_in(chunk: &Chunk, inside: usize) -> Option<usize> {
    match chunk.tree() {
        Tree::Ladder(tree) => tree.rungs.iter().position(|rung| rung.span.touches(inside)).map(|own| own + 1),
        _ => (chunk.size().rungs > 0).then_some(1),
    }
}

/// What stands at byte `inside` of a chunk, on one line.
pub(super) fn text_at(at: ChunkRef<'_>, inside: usize) -> String {
    let text = at.chunk.text();
    if let Tree::Ladder(tree) = at.chunk.tree()
        && let Some(rung) = tree.rungs.iter().find(|rung| rung.span.touches(inside))
    {
        return drawn(rung, text);
    }
    let start = text.get(..inside).and_then(|head| head.rfind(['\n', '\r'])).map_or(0, |end| end + 1);
    let line = text.get(start..).and_then(|rest| rest.split(['\n', '\r']).next()).unwrap_or("");
    let line = line.split_whitespace().collect::<Vec<_>>().join(" ").replace('`', "'");
    match line.char_indices().nth(TEXT_LENGTH) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line,
    }
}

/// A drawn rung in a line: `X0 /X1 Y0 → Y0`.
fn drawn(rung: &Rung, text: &str) -> String {
    let mut conditions = Vec::new();
    let mut outputs = Vec::new();
    for element in &rung.graph.elements {
        let names = (0..element.operands.len()).map(|index| element.operand_text(index, text).into_owned());
        let names: Vec<String> = names.collect();
        let mark = match &element.kind {
            ElementKind::Contact(ContactKind::NormallyClosed) | ElementKind::Coil(CoilKind::Negated) => "/",
            ElementKind::Contact(ContactKind::Rising) | ElementKind::Coil(CoilKind::Rising) => "↑",
            ElementKind::Contact(ContactKind::Falling) | ElementKind::Coil(CoilKind::Falling) => "↓",
            ElementKind::Coil(CoilKind::Set) => "S ",
            ElementKind::Coil(CoilKind::Reset) => "R ",
            ElementKind::Instruction { mnemonic, .. } => &format!("{} ", mnemonic.of(text)),
            ElementKind::Jump(label) => &format!(">>{}", label.of(text)),
            _ => "",
        };
        let words = format!("{mark}{}", names.join(" ")).trim().replace('`', "'");
        if words.is_empty() {
            continue;
        }
        if element.is_output() { outputs.push(words) } else { conditions.push(words) }
    }
    if conditions.len() > CONDITIONS {
        conditions.truncate(CONDITIONS);
        conditions.push("…".to_string());
    }
    format!("{} → {}", conditions.join(" "), outputs.join(", ")).trim().to_string()
}

/// `rung 3, line 12`; `line` counts from 0.
pub(super) fn place_words(rung: Option<usize>, line: u32, language: Language) -> String {
    let message = match rung {
        Some(rung) => Message::new("uses.rung-line").with("rung", rung),
        None => Message::new("uses.line"),
    };
    message.with("line", line + 1).render(language)
}

/// How places are named and linked.
pub(super) struct Style<'a> {
    pub view: &'a ProjectView<'a>,
    pub language: Language,
    /// The address of a line of a file, if there is one that the reader can follow.
    pub link: &'a dyn Fn(usize, u32) -> Option<String>,
}

impl Uses {
    /// The groups as Markdown lists.
    pub(super) fn markdown(&self, thing: &Thing, style: &Style<'_>) -> String {
        let declared_key = if thing.is_label() { "uses.defined" } else { "uses.declared" };
        let groups = [
            (Message::new(declared_key), &self.declared),
            (Message::new("uses.writes"), &self.writes),
            (Message::new("uses.reads"), &self.reads),
            (Message::new("uses.jumps"), &self.jumps),
        ];
        let groups = groups.into_iter().filter(|(_, group)| group.total > 0);
        let parts: Vec<String> = groups
            .map(|(title, group)| format!("{}\n{}", title.render(style.language), group.markdown(style)))
            .collect();
        parts.join("\n\n")
    }
}

impl Group {
    fn markdown(&self, style: &Style<'_>) -> String {
        let mut rows: Vec<String> = self.places.iter().map(|place| style.row(place)).collect();
        if self.total > self.shown {
            let message = Message::new("uses.more").with("count", self.total - self.shown);
            rows.push(format!("- {}", message.render(style.language)));
        }
        rows.join("\n")
    }
}

impl Style<'_> {
    fn row(&self, place: &Place) -> String {
        let words = self.words(place);
        let words = match (self.link)(place.file, place.line) {
            Some(address) => format!("[{words}]({address})"),
            None => words,
        };
        if place.text.is_empty() { format!("- {words}") } else { format!("- {words}: `{}`", place.text) }
    }

    /// `rung 3, line 12`, with the name of the file if it is another one.
    pub(super) fn words(&self, place: &Place) -> String {
        let words = place_words(place.rung, place.line, self.language);
        match self.view.members().get(place.file) {
            Some(member) if place.file != self.view.here_number() => format!("{}, {words}", member.name),
            _ => words,
        }
    }
}
