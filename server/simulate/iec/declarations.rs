//! What the documents of a program declare: units with their bodies, types, global variables, tasks.

use crate::document::{ChunkRef, Document, Scopes, Tree};
use crate::il::iec::{
    Declaration, IecTree, InitialValue, ItemKind, OperandId, PouKind, Run, SectionKind, TypeId,
};
use crate::simulate::Place;
use crate::text::{Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::ops::Range;

/// A chunk of declarations and instructions.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) document: u32,
    pub(super) start: usize,
    pub(super) text: &'a str,
    pub(super) tree: &'a IecTree,
}

/// A program unit; one without a name is what stands outside of any.
#[derive(Default)]
pub(super) struct Unit<'a> {
    pub(super) name: SmolStr,
    pub(super) kind: Option<PouKind>,
    /// The type of a function's result.
    pub(super) result: Option<(usize, TypeId)>,
    pub(super) sections: Vec<Section>,
    pub(super) body: Vec<Part<'a>>,
    /// Where it begins.
    pub(super) place: Option<Place>,
}

/// A section of variables.
#[derive(Clone, Copy)]
pub(super) struct Section {
    pub(super) source: usize,
    pub(super) kind: SectionKind,
    pub(super) is_constant: bool,
    pub(super) declarations: Run,
}

/// A piece of a body.
#[derive(Clone)]
pub(super) enum Part<'a> {
    /// Instructions of a source.
    List { source: usize, items: Range<usize> },
    /// A drawing; `pous` units have started before it in its document.
    /// `lists` are the sources of its boxes `{il … }`, in their order.
    Drawing { document: u32, chunk: ChunkRef<'a>, scopes: &'a Scopes, pous: usize, lists: Range<usize> },
}

/// A TASK, or a PROGRAM of a configuration, by its place in the tree of its source.
#[derive(Clone)]
pub(super) struct Configured {
    pub(super) source: usize,
    pub(super) index: u32,
    /// The names around it: of the resource, if it stands in one.
    pub(super) resource: Option<SmolStr>,
    pub(super) span: Span,
}

/// All that is declared.
#[derive(Default)]
pub(super) struct Declarations<'a> {
    pub(super) sources: Vec<Source<'a>>,
    pub(super) units: Vec<Unit<'a>>,
    pub(super) types: FxHashMap<SmolStr, (usize, usize)>,
    pub(super) globals: Vec<Section>,
    pub(super) tasks: Vec<Configured>,
    pub(super) instances: Vec<Configured>,
    /// What VAR_CONFIG says: sources, and the records in them.
    pub(super) configs: Vec<(usize, usize)>,
    numbers: FxHashMap<SmolStr, usize>,
}

impl<'a> Declarations<'a> {
    pub(super) fn of(documents: &[&'a Document]) -> Declarations<'a> {
        let mut found = Declarations::default();
        for (number, document) in (0..).zip(documents) {
            let mut reader = Reader { found: &mut found, unit: None, resource: None, pous: 0 };
            for at in document.chunks() {
                match at.chunk.iec() {
                    Some(tree) => {
                        let source =
                            Source { document: number, start: at.start, text: at.chunk.text(), tree };
                        reader.chunk(source);
                    }
                    None if matches!(at.chunk.reading().tree(), Tree::Ladder(_)) => {
                        let (scopes, pous) = (&**document.scopes(), reader.pous);
                        let first = reader.found.sources.len();
                        reader.found.sources.extend(at.chunk.boxes().iter().filter_map(|(start, list)| {
                            let (start, text, tree) = (at.start + start, list.text(), list.iec()?);
                            Some(Source { document: number, start, text, tree })
                        }));
                        let lists = first..reader.found.sources.len();
                        let part = Part::Drawing { document: number, chunk: at, scopes, pous, lists };
                        if drawn(&at) {
                            reader.unit().body.push(part);
                        }
                    }
                    None => {}
                }
            }
        }
        for (number, unit) in found.units.iter().enumerate() {
            found.numbers.entry(folded(&unit.name)).or_insert(number);
        }
        found
    }

    /// The unit of this kind called `name`, letter case aside.
    pub(super) fn unit(&self, name: &str, kind: PouKind) -> Option<usize> {
        let number = *self.numbers.get(&folded(name))?;
        (self.units[number].kind == Some(kind)).then_some(number)
    }

    /// The numbers of all items of a source.
    pub(super) fn items(&self, source: usize) -> Range<usize> {
        0..self.sources[source].tree.items.len()
    }

    /// The one of some sources in which something begins.
    pub(super) fn source_at(&self, mut some: Range<usize>, place: Place) -> Option<usize> {
        some.find(|source| {
            let Source { start, text, .. } = self.sources[*source];
            (start..start + text.len()).contains(&(place.span.start as usize))
        })
    }

    pub(super) fn place(&self, source: usize, span: Span) -> Place {
        let source = &self.sources[source];
        Place { document: source.document, span: span.shifted(source.start) }
    }

    /// The text at a place of a source.
    pub(super) fn word(&self, source: usize, span: Span) -> &'a str {
        span.of(self.sources[source].text)
    }

    pub(super) fn operand(&self, source: usize, id: OperandId) -> &'a str {
        let source = &self.sources[source];
        source.tree.operand(id).span.of(source.text)
    }

    pub(super) fn declaration(&self, source: usize, index: usize) -> &'a Declaration {
        &self.sources[source].tree.declarations[index]
    }

    pub(super) fn value(&self, source: usize, index: u32) -> Option<&'a InitialValue> {
        self.sources[source].tree.values.get(index as usize)
    }
}

/// Whether a chunk of a drawing has rungs, or lists that it carries along.
fn drawn(at: &ChunkRef<'_>) -> bool {
    let reading = at.chunk.reading();
    match reading.tree() {
        Tree::Ladder(tree) => {
            !tree.rungs.is_empty()
                || !tree.problems.is_empty()
                || !tree.comments.is_empty()
                || tree.header.is_some()
        }
        _ => false,
    }
}

struct Reader<'r, 'a> {
    found: &'r mut Declarations<'a>,
    /// The unit that is open.
    unit: Option<usize>,
    resource: Option<SmolStr>,
    /// Units that have started in the document.
    pous: usize,
}

impl<'a> Reader<'_, 'a> {
    fn chunk(&mut self, source: Source<'a>) {
        let number = self.found.sources.len();
        self.found.sources.push(source);
        let place = |span: Span| Place { document: source.document, span: span.shifted(source.start) };
        for (index, item) in source.tree.items.iter().enumerate() {
            match item.kind {
                ItemKind::Pou { kind, name, result } => {
                    self.pous += 1;
                    self.unit = Some(self.found.units.len());
                    self.found.units.push(Unit {
                        name: name.map_or(SmolStr::default(), |name| name.of(source.text).into()),
                        kind: Some(kind),
                        result: result.map(|id| (number, id)),
                        place: Some(place(item.span)),
                        ..Unit::default()
                    });
                }
                ItemKind::PouEnd(_) => self.unit = None,
                ItemKind::Section { kind, constant, declarations, .. } => {
                    let section = Section { source: number, kind, is_constant: constant, declarations };
                    match kind {
                        SectionKind::Global => self.found.globals.push(section),
                        SectionKind::Config => {
                            let all = declarations.start..declarations.end;
                            self.found.configs.extend(all.map(|index| (number, index as usize)));
                        }
                        SectionKind::Access => {}
                        _ => self.unit().sections.push(section),
                    }
                }
                ItemKind::Types { declarations } => {
                    for at in declarations.start..declarations.end {
                        let declaration = &source.tree.declarations[at as usize];
                        if let Some(name) = declaration.names.of(&source.tree.names).first() {
                            let name = folded(name.of(source.text));
                            self.found.types.entry(name).or_insert((number, at as usize));
                        }
                    }
                }
                ItemKind::Resource { name, .. } => {
                    self.resource = name.map(|name| name.of(source.text).into());
                }
                ItemKind::Configuration { .. } | ItemKind::End(_) => self.resource = None,
                ItemKind::Task(at) | ItemKind::Instance(at) => {
                    let resource = self.resource.clone();
                    let one = Configured { source: number, index: at, resource, span: item.span };
                    match item.kind {
                        ItemKind::Task(_) => self.found.tasks.push(one),
                        _ => self.found.instances.push(one),
                    }
                }
                _ => {
                    let body = &mut self.unit().body;
                    match body.last_mut() {
                        Some(Part::List { source, items }) if *source == number && items.end == index => {
                            items.end = index + 1;
                        }
                        _ => body.push(Part::List { source: number, items: index..index + 1 }),
                    }
                }
            }
        }
    }

    /// The unit that is open, or the one without a name.
    fn unit(&mut self) -> &mut Unit<'a> {
        let number = match self.unit {
            Some(number) => number,
            None => {
                let number = self.found.units.len();
                self.found.units.push(Unit::default());
                self.unit = Some(number);
                number
            }
        };
        &mut self.found.units[number]
    }
}
