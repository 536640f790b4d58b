//! What a name stands for, and every place where it stands: the ground of hover, definition, references and rename.

use super::members;
use crate::document::{Chunk, Document, Mention, Names, Scopes, Symbol, Use};
use crate::il::iec::PouKind;
use crate::target::iec::FunctionBlock;
use crate::target::{Device, DirectAddress};
use crate::text::Span;
use smol_str::SmolStr;
use std::sync::Arc;

/// What a name stands for, with the POU in which it is known; names are folded.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Thing {
    /// So many devices from this one on.
    Devices(Device, u16),
    /// `%IX0.0`
    Direct(DirectAddress),
    /// A variable; outside of any POU if it is global.
    Variable { pou: Option<usize>, name: SmolStr },
    /// A label that is no pointer of the PLC.
    Label { pou: Option<usize>, name: SmolStr },
    /// A connector between rungs.
    Connector { pou: Option<usize>, name: SmolStr },
    /// A program, function block or function, declared or standard.
    Pou(SmolStr),
    /// A data type.
    Type(SmolStr),
}

/// A place of a thing.
#[derive(Clone, Debug)]
pub(super) struct Named<'d> {
    pub thing: Thing,
    /// In the document.
    pub span: Span,
    pub usage: Use,
    /// The chunk in which it stands, and where that starts.
    pub chunk: &'d Arc<Chunk>,
    pub chunk_start: usize,
}

impl Named<'_> {
    /// Its place in its chunk.
    pub(super) fn inside(&self) -> Span {
        Span::new(self.span.start as usize - self.chunk_start, self.span.end as usize - self.chunk_start)
    }
}

impl Thing {
    /// What `mention` means in POU number `pou`.
    pub(super) fn of(mention: &Mention, pou: Option<usize>, scopes: &Scopes) -> Thing {
        let is_pou = |name: &SmolStr| scopes.pou_named(name).is_some();
        match &mention.symbol {
            Symbol::Device(device) => Thing::Devices(*device, mention.count),
            Symbol::Direct(address) => Thing::Direct(*address),
            Symbol::Label(name) => Thing::Label { pou, name: name.clone() },
            Symbol::Connector(name) => Thing::Connector { pou, name: name.clone() },
            Symbol::Pou(name) => Thing::Pou(name.clone()),
            Symbol::Type(name) if is_pou(name) || FunctionBlock::named(name).is_some() => {
                Thing::Pou(name.clone())
            }
            Symbol::Type(name) => Thing::Type(name.clone()),
            Symbol::Variable(name) => {
                let pou = match scopes.variable(pou, name) {
                    Some(variable) if variable.section.is_global() => None,
                    Some(_) => pou,
                    // The result of a function has the function's name.
                    None if is_pou(name) => return Thing::Pou(name.clone()),
                    None => pou,
                };
                Thing::Variable { pou, name: name.clone() }
            }
        }
    }

    /// Whether both are the same thing, or have a device in common.
    pub(super) fn meets(&self, other: &Thing) -> bool {
        match (self, other) {
            (Thing::Devices(left, left_count), Thing::Devices(right, right_count)) => {
                let end = |device: &Device, count: u16| device.number.saturating_add(u32::from(count));
                left.kind == right.kind
                    && left.number < end(right, *right_count)
                    && right.number < end(left, *left_count)
            }
            _ => self == other,
        }
    }

    /// Whether a page with these names may name it.
    fn may_be_in(&self, names: &Names) -> bool {
        match self {
            Thing::Devices(device, count) => names.touches(*device, *count),
            Thing::Direct(address) => names.contains(&Symbol::Direct(*address)),
            Thing::Variable { name, .. } => names.contains(&Symbol::Variable(name.clone())),
            Thing::Label { name, .. } => names.contains(&Symbol::Label(name.clone())),
            Thing::Connector { name, .. } => names.contains(&Symbol::Connector(name.clone())),
            Thing::Type(name) => names.contains(&Symbol::Type(name.clone())),
            Thing::Pou(name) => [Symbol::Pou, Symbol::Type, Symbol::Variable]
                .into_iter()
                .any(|symbol| names.contains(&symbol(name.clone()))),
        }
    }

    /// Whether `symbol` can mean it, wherever it stands.
    fn may_be(&self, symbol: &Symbol) -> bool {
        match (self, symbol) {
            (Thing::Devices(device, _), Symbol::Device(other)) => device.kind == other.kind,
            (Thing::Direct(address), Symbol::Direct(other)) => address == other,
            (Thing::Variable { name, .. }, Symbol::Variable(other))
            | (Thing::Label { name, .. }, Symbol::Label(other))
            | (Thing::Connector { name, .. }, Symbol::Connector(other))
            | (Thing::Type(name), Symbol::Type(other))
            | (Thing::Pou(name), Symbol::Pou(other) | Symbol::Type(other) | Symbol::Variable(other)) => {
                name == other
            }
            _ => false,
        }
    }

    /// The program unit and the name, if it is a variable that other units see as a parameter or a member.
    pub(super) fn parameter_of(&self, scopes: &Scopes) -> Option<(usize, &SmolStr)> {
        let Thing::Variable { pou: Some(unit), name } = self else { return None };
        let section = scopes.variable(Some(*unit), name)?.section;
        let has_callers = scopes.pous.get(*unit).is_some_and(|pou| pou.kind != PouKind::Program);
        (has_callers && section.is_parameter()).then_some((*unit, name))
    }

    /// Whether it is a place in the program: a pointer or a label.
    pub(super) fn is_label(&self) -> bool {
        match self {
            Thing::Devices(device, _) => device.kind.is_pointer(),
            Thing::Label { .. } => true,
            _ => false,
        }
    }
}

/// The thing named at `offset`. Where two names touch, it is the one that begins there.
pub(super) fn at(document: &Document, offset: usize) -> Option<Named<'_>> {
    let found = document.chunk_at(offset)?;
    let inside = offset.checked_sub(found.start)?;
    let touched = found.chunk.mentions().iter().filter(|mention| mention.span.touches(inside));
    let mention = touched.filter(|mention| !mention.span.is_empty()).max_by_key(|mention| mention.span.start);
    let pou = pou_at(document, found.start);
    let (thing, span, usage) = match mention {
        Some(mention) => (Thing::of(mention, pou, document.scopes()), mention.span, mention.usage),
        None => {
            let members = members::of(found.chunk, pou, document.scopes());
            let member = members.into_iter().find(|member| member.span.touches(inside))?;
            let thing = Thing::Variable { pou: Some(member.pou), name: member.name };
            (thing, member.span, member.usage)
        }
    };
    Some(Named {
        thing,
        span: span.shifted(found.start),
        usage,
        chunk: found.chunk,
        chunk_start: found.start,
    })
}

/// Calls `see` for every place of `thing`, in the order of the text. Pages that do not name it cost one look-up.
pub(super) fn visit<'d>(document: &'d Document, thing: &Thing, see: impl FnMut(Named<'d>)) {
    visit_where(document, thing, |_| true, see);
}

/// The same, passing over pages that `enter` refuses; it is asked about each page that may name `thing`.
pub(super) fn visit_where<'d>(
    document: &'d Document,
    thing: &Thing,
    mut enter: impl FnMut(&Names) -> bool,
    mut see: impl FnMut(Named<'d>),
) {
    let scopes = document.scopes();
    let from_outside = thing.parameter_of(scopes);
    let mut walk = PouWalk::default();
    let mut page_start = 0;
    for page in document.pages() {
        let names = page.names();
        if from_outside.is_some() || thing.may_be_in(names) && enter(names) {
            let (mut walk, mut start) = (walk, page_start);
            for chunk in page.chunks() {
                let pou = walk.enter(chunk);
                if let Some((unit, name)) = from_outside {
                    let members = members::of(chunk, pou, scopes).into_iter();
                    for member in members.filter(|member| member.pou == unit && member.name == *name) {
                        let (span, usage) = (member.span.shifted(start), member.usage);
                        see(Named { thing: thing.clone(), span, usage, chunk, chunk_start: start });
                    }
                }
                for mention in chunk.mentions().iter().filter(|mention| thing.may_be(&mention.symbol)) {
                    let found = Thing::of(mention, pou, scopes);
                    if found.meets(thing) {
                        let (span, usage) = (mention.span.shifted(start), mention.usage);
                        see(Named { thing: found, span, usage, chunk, chunk_start: start });
                    }
                }
                start += chunk.len();
            }
        }
        walk.pass(names);
        page_start += page.bytes();
    }
}

/// The number of the POU to which the chunk that starts at `start` belongs.
pub fn pou_at(document: &Document, start: usize) -> Option<usize> {
    let mut walk = PouWalk::default();
    let mut at = 0;
    for page in document.pages() {
        if at + page.bytes() <= start {
            walk.pass(page.names());
            at += page.bytes();
            continue;
        }
        for chunk in page.chunks() {
            let pou = walk.enter(chunk);
            if at == start {
                return pou;
            }
            at += chunk.len();
        }
    }
    None
}

/// Counts the POUs on the way through a document.
#[derive(Clone, Copy, Default)]
pub(super) struct PouWalk {
    started: usize,
    inside: bool,
}

impl PouWalk {
    /// The number of the POU to which the next chunk belongs.
    pub(super) fn enter(&mut self, chunk: &Chunk) -> Option<usize> {
        let starts = chunk.pou_starts();
        self.started += starts;
        let pou = if self.inside || starts > 0 { self.started.checked_sub(1) } else { None };
        self.inside = chunk.ends_inside_pou().unwrap_or(self.inside);
        pou
    }

    /// Passes over a whole page.
    fn pass(&mut self, names: &Names) {
        self.started += names.pou_starts();
        self.inside = names.inside_at_end().unwrap_or(self.inside);
    }
}
