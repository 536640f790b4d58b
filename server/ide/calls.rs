//! Who calls whom: POUs, subroutines and labels with the calls and jumps between them, across the files of a project.

use super::names::{self, PouWalk, Thing};
use super::{SymbolKind, declared};
use crate::check::program_around;
use crate::document::{ChunkRef, DeclaredType, Document, Mention, ProjectView, Scopes, Symbol, Tree, Use};
use crate::il::iec::PouKind;
use crate::target::Flow;
use crate::text::Span;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// A node of the hierarchy.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CallItem {
    /// The number of its file.
    pub file: usize,
    /// `Motor`, `P1`; for a main program without a name that of its file.
    pub name: String,
    /// `FUNCTION_BLOCK`, or the POU of a label.
    pub detail: String,
    /// What it is.
    pub kind: SymbolKind,
    /// All of it.
    pub span: Span,
    /// The name, or the start of a main program.
    pub selection: Span,
    /// Whether it is a main program, which no name stands for.
    pub is_main: bool,
}

/// What can be called, with its calls.
struct Body {
    item: CallItem,
    /// By what others name it; nothing for a main program.
    callee: Option<Callee>,
    /// Whether calls stand in it and in nothing smaller: a POU, a main program, a subroutine.
    is_unit: bool,
    /// The places in its file that call something.
    sites: Vec<(Callee, Span)>,
}

/// What a call or jump names.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
enum Callee {
    Pou(SmolStr),
    /// A pointer of the PLC, known in the whole program.
    Pointer(Symbol),
    /// A label of one POU of one file.
    Label {
        file: usize,
        pou: Option<usize>,
        symbol: Symbol,
    },
}

/// The node named at `offset`, else the one in which it stands.
pub(super) fn prepare(view: &ProjectView<'_>, offset: usize) -> Option<CallItem> {
    let here = view.here_number();
    let bodies = bodies(view);
    let named = names::at(view.here(), offset).and_then(|named| callee_of(&named.thing, here, view.here()));
    if let Some(body) =
        named.and_then(|callee| bodies.iter().find(|body| body.callee.as_ref() == Some(&callee)))
    {
        return Some(body.item.clone());
    }
    let around = bodies.iter().filter(|body| body.item.file == here && body.is_unit);
    let around = around.filter(|body| body.item.span.touches(offset));
    around.min_by_key(|body| body.item.span.end - body.item.span.start).map(|body| body.item.clone())
}

/// The main program of the file that is looked at.
pub(super) fn main_of(view: &ProjectView<'_>) -> Option<CallItem> {
    let here = view.here_number();
    bodies(view).into_iter().map(|body| body.item).find(|item| item.is_main && item.file == here)
}

/// Who calls `item`, each with the places.
pub(super) fn incoming(view: &ProjectView<'_>, item: &CallItem) -> Vec<(CallItem, Vec<Span>)> {
    let bodies = bodies(view);
    let Some(callee) = bodies.iter().find(|body| body.item == *item).and_then(|body| body.callee.clone())
    else {
        return Vec::new();
    };
    let callers = bodies.iter().filter(|body| body.is_unit).filter_map(|body| {
        let sites = body.sites.iter().filter(|(called, _)| *called == callee).map(|(_, span)| *span);
        let sites: Vec<Span> = sites.collect();
        (!sites.is_empty()).then(|| (body.item.clone(), sites))
    });
    callers.collect()
}

/// What `item` calls, each with the places in the file of `item`.
pub(super) fn outgoing(view: &ProjectView<'_>, item: &CallItem) -> Vec<(CallItem, Vec<Span>)> {
    let bodies = bodies(view);
    let Some(body) = bodies.iter().find(|body| body.item == *item) else { return Vec::new() };
    let mut targets: FxHashMap<&Callee, &CallItem> = FxHashMap::default();
    for body in &bodies {
        if let Some(callee) = &body.callee {
            targets.entry(callee).or_insert(&body.item);
        }
    }
    let mut called: Vec<(CallItem, Vec<Span>)> = Vec::new();
    let mut places: FxHashMap<&Callee, usize> = FxHashMap::default();
    for (callee, span) in &body.sites {
        let Some(target) = targets.get(callee) else { continue };
        let place = *places.entry(callee).or_insert_with(|| {
            called.push(((*target).clone(), Vec::new()));
            called.len() - 1
        });
        called[place].1.push(*span);
    }
    called
}

fn callee_of(thing: &Thing, file: usize, document: &Document) -> Option<Callee> {
    match thing {
        Thing::Pou(name) => Some(Callee::Pou(name.clone())),
        Thing::Variable { pou, name } => match document.scopes().type_of(*pou, name)? {
            DeclaredType::Named(block) => Some(Callee::Pou(block)),
            _ => None,
        },
        Thing::Devices(device, _) if device.kind.is_pointer() => {
            Some(Callee::Pointer(Symbol::Device(*device)))
        }
        Thing::Label { pou, name } => {
            Some(Callee::Label { file, pou: *pou, symbol: Symbol::Label(name.clone()) })
        }
        _ => None,
    }
}

/// Everything that can be called in the program of the file that is looked at.
fn bodies(view: &ProjectView<'_>) -> Vec<Body> {
    let mut walk = Walk { bodies: Vec::new(), unit: 0, label: None, behind_main: false, file: 0 };
    for number in program_around(view) {
        if view.is_cancelled() {
            break;
        }
        walk.file(number, view.members()[number]);
    }
    walk.bodies
}

struct Walk {
    bodies: Vec<Body>,
    /// The numbers of the bodies to which a call belongs now.
    unit: usize,
    label: Option<usize>,
    /// FEND has been passed, perhaps in a file before: labels are subroutines.
    behind_main: bool,
    file: usize,
}

/// Something that counts for the hierarchy, in the order of the text.
enum Event<'a> {
    Mention(&'a Mention),
    MainEnd,
    RoutineEnd,
    ProgramEnd,
}

impl Walk {
    fn file(&mut self, number: usize, member: crate::document::Member<'_>) {
        // Trees that are read here are not kept.
        let document = &member.document.lean();
        self.file = number;
        let main = self.add(CallItem {
            file: number,
            name: member.name.to_string(),
            detail: String::new(),
            kind: SymbolKind::Program,
            span: Span::new(0, document.len()),
            selection: Span::at(0),
            is_main: true,
        });
        self.bodies[main].is_unit = true;
        self.label = None;
        self.unit = main;
        let mut pous = PouWalk::default();
        for at in document.chunks() {
            let pou = pous.enter(at.chunk);
            if pou.is_none() && matches!(at.chunk.tree(), Tree::Iec(_)) {
                self.unit = main;
            }
            for (span, event) in events(at) {
                self.event(span.shifted(at.start), event, pou, document, main);
            }
            if let Some(body) = pou.and(self.bodies.get_mut(self.unit)).filter(|body| !body.item.is_main) {
                body.item.span.end =
                    body.item.span.end.max((at.start + at.chunk.text().trim_end().len()) as u32);
            }
        }
    }

    fn event(&mut self, span: Span, event: Event<'_>, pou: Option<usize>, document: &Document, main: usize) {
        if !matches!(event, Event::Mention(_)) {
            self.extend(span.end);
        }
        match event {
            Event::MainEnd => {
                self.behind_main = true;
                (self.unit, self.label) = (main, None);
            }
            Event::RoutineEnd => (self.unit, self.label) = (main, None),
            Event::ProgramEnd => {
                self.behind_main = false;
                (self.unit, self.label) = (main, None);
            }
            Event::Mention(mention) => {
                self.mention(span, mention, pou, document);
                self.extend(span.end);
            }
        }
    }

    /// The bodies to which what ends at `end` belongs reach to there.
    fn extend(&mut self, end: u32) {
        for number in [Some(self.unit), self.label].into_iter().flatten() {
            if let Some(body) = self.bodies.get_mut(number).filter(|body| body.item.file == self.file) {
                body.item.span.end = body.item.span.end.max(end);
            }
        }
    }

    fn mention(&mut self, span: Span, mention: &Mention, pou: Option<usize>, document: &Document) {
        let scopes = document.scopes();
        let own = pou.and_then(|number| scopes.pous.get(number));
        match (&mention.symbol, mention.usage) {
            (Symbol::Pou(name), Use::Declare) => {
                let kind = own.map_or(PouKind::Program, |pou| pou.kind);
                let name_written = own.map_or(name.to_string(), |pou| pou.name.to_string());
                let mut item = self.item(name_written, span);
                item.detail = declared::pou_keyword(kind).to_string();
                item.kind = kind.into();
                let number = self.add(item);
                self.bodies[number].callee = Some(Callee::Pou(name.clone()));
                self.bodies[number].is_unit = true;
                (self.unit, self.label) = (number, None);
            }
            (symbol @ (Symbol::Label(_) | Symbol::Device(_)), Use::Declare) => {
                let Some(callee) = self.label_called(symbol, pou) else { return };
                let mut item = self.item(document.slice(span).trim_end_matches(':').to_string(), span);
                item.detail = own.map_or(String::new(), |pou| pou.name.to_string());
                let number = self.add(item);
                self.bodies[number].callee = Some(callee);
                self.bodies[number].is_unit = self.behind_main;
                self.label = Some(number);
                if self.behind_main {
                    self.unit = number;
                }
            }
            (symbol, Use::Jump) => {
                if let Some(callee) = self.label_called(symbol, pou) {
                    self.site(callee, span);
                }
            }
            _ => {
                if let Some(name) = pou_called(mention, pou, scopes) {
                    self.site(Callee::Pou(name), span);
                }
            }
        }
    }

    fn label_called(&self, symbol: &Symbol, pou: Option<usize>) -> Option<Callee> {
        match symbol {
            Symbol::Device(device) => device.kind.is_pointer().then(|| Callee::Pointer(symbol.clone())),
            Symbol::Label(_) => Some(Callee::Label { file: self.file, pou, symbol: symbol.clone() }),
            _ => None,
        }
    }

    fn site(&mut self, callee: Callee, span: Span) {
        for number in [Some(self.unit), self.label.filter(|label| *label != self.unit)].into_iter().flatten()
        {
            if let Some(body) = self.bodies.get_mut(number) {
                body.sites.push((callee.clone(), span));
            }
        }
    }

    fn item(&self, name: String, span: Span) -> CallItem {
        let kind = SymbolKind::Label;
        CallItem { file: self.file, name, detail: String::new(), kind, span, selection: span, is_main: false }
    }

    fn add(&mut self, item: CallItem) -> usize {
        self.bodies.push(Body { item, callee: None, is_unit: false, sites: Vec::new() });
        self.bodies.len() - 1
    }
}

/// The POU that `mention` calls: a function, or the function block of an instance.
fn pou_called(mention: &Mention, pou: Option<usize>, scopes: &Scopes) -> Option<SmolStr> {
    let name = match (&mention.symbol, mention.usage) {
        (Symbol::Pou(name), Use::Read) => name.clone(),
        (Symbol::Variable(name), Use::ReadWrite) => match scopes.type_of(pou, name) {
            Some(DeclaredType::Named(block)) => block,
            _ => name.clone(),
        },
        _ => return None,
    };
    scopes.pou_named(&name).is_some().then_some(name)
}

/// What counts in a chunk, in the order in which it is executed. Offsets are those of the chunk.
fn events(at: ChunkRef<'_>) -> Vec<(Span, Event<'_>)> {
    // The box of an instance names its block and its instance; the block is enough.
    let is_drawn = matches!(at.chunk.tree(), Tree::Ladder(_));
    let counts = |mention: &&Mention| match (&mention.symbol, mention.usage) {
        (Symbol::Variable(_), Use::ReadWrite) => !is_drawn,
        (Symbol::Pou(_) | Symbol::Label(_), _) => true,
        (Symbol::Device(device), Use::Declare | Use::Jump) => device.kind.is_pointer(),
        _ => false,
    };
    let mentions = at.chunk.mentions().iter().filter(counts);
    let mut events: Vec<(Span, Event<'_>)> =
        mentions.map(|mention| (mention.span, Event::Mention(mention))).collect();
    for operation in at.chunk.operations() {
        let event = match operation.form.map(|form| form.instruction.flow()) {
            Some(Flow::MainEnd) => Event::MainEnd,
            Some(Flow::SubroutineEnd | Flow::InterruptEnd) => Event::RoutineEnd,
            Some(Flow::ProgramEnd) => Event::ProgramEnd,
            _ => continue,
        };
        events.push((operation.symbol, event));
    }
    events.sort_by_key(|(span, _)| *span);
    events
}
