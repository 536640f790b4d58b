//! Types of a program, and where the parts of a value of such a type lie.

use crate::il::iec::{Edge, SectionKind};
use crate::target::DirectAddress;
use crate::target::iec::{ElementaryType, FunctionBlock};
use crate::text::folded;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::sync::Arc;

/// The type of a variable.
#[derive(Clone, Debug)]
pub(in crate::simulate) enum Kind {
    /// One value; of a text how many characters it holds.
    Elementary(ElementaryType, usize),
    /// The numbers of a type from one to another, see [`Spot::range`](super::parts::Spot).
    Subrange(ElementaryType, u32),
    /// One of these names, counted from 0.
    Enumeration(Arc<Enumeration>),
    /// Elements, each dimension with its least and greatest index.
    Array(Arc<[(i64, i64)]>, Arc<Kind>),
    /// Fields side by side: a structure, the variables of a program unit, the pins of a standard block.
    Record(Arc<Record>),
}

/// An enumerated type.
#[derive(PartialEq, Eq, Debug)]
pub(in crate::simulate) struct Enumeration {
    pub(in crate::simulate) values: Vec<SmolStr>,
}

/// Fields one behind the other.
#[derive(Debug)]
pub(in crate::simulate) struct Record {
    pub(in crate::simulate) what: RecordKind,
    pub(in crate::simulate) fields: Vec<Field>,
    pub(in crate::simulate) size: Extent,
    /// How deep records are nested: 1 if there is none inside.
    pub(in crate::simulate) depth: usize,
    /// Where the fields are, by their folded names.
    places: FxHashMap<SmolStr, usize>,
}

/// What a record is.
#[derive(Clone, Copy, Debug)]
pub(in crate::simulate) enum RecordKind {
    /// A structure.
    Structure,
    /// An instance of a standard function block; behind its pins lies what it notes.
    Block(&'static FunctionBlock),
    /// The variables of the program unit with this number.
    Unit(usize),
}

/// A field of a record.
#[derive(Debug)]
pub(in crate::simulate) struct Field {
    /// As declared; upper case in the standard.
    pub(in crate::simulate) name: SmolStr,
    pub(in crate::simulate) kind: Kind,
    /// From the start of the record on.
    pub(in crate::simulate) at: Extent,
    /// Of a program unit the section in which it is declared.
    pub(in crate::simulate) section: SectionKind,
    pub(in crate::simulate) is_constant: bool,
    /// Its place in the declarations, for initial values.
    pub(in crate::simulate) declared: Option<Declared>,
    /// The edge that the unit sees instead of the input; behind the input lie what it was and the edge.
    pub(in crate::simulate) edge: Option<Edge>,
    /// Where it lies, if it is located.
    pub(in crate::simulate) address: Option<DirectAddress>,
}

/// Where a declaration is read: which source, and the record in it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::simulate) struct Declared {
    pub(in crate::simulate) source: usize,
    pub(in crate::simulate) index: usize,
}

/// A number of cells, words and texts: a size, or a place.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Debug)]
pub(in crate::simulate) struct Extent {
    pub(in crate::simulate) cells: u32,
    pub(in crate::simulate) words: u32,
    pub(in crate::simulate) texts: u32,
}

impl Extent {
    pub(in crate::simulate) const BIT: Extent = Extent { cells: 1, words: 0, texts: 0 };
    pub(in crate::simulate) const WORD: Extent = Extent { cells: 0, words: 1, texts: 0 };
    pub(in crate::simulate) const TEXT: Extent = Extent { cells: 0, words: 0, texts: 1 };

    /// Both together; more than any memory has stays more.
    pub(in crate::simulate) fn plus(self, other: Extent) -> Extent {
        Extent {
            cells: self.cells.saturating_add(other.cells),
            words: self.words.saturating_add(other.words),
            texts: self.texts.saturating_add(other.texts),
        }
    }

    /// So many of them.
    pub(in crate::simulate) fn times(self, count: u64) -> Extent {
        let times = |size: u32| u32::try_from(u64::from(size).saturating_mul(count)).unwrap_or(u32::MAX);
        Extent { cells: times(self.cells), words: times(self.words), texts: times(self.texts) }
    }
}

/// How many characters a text holds that is declared without a length. The standard leaves it to the implementer.
pub(in crate::simulate) const TEXT_LENGTH: usize = 254;

impl Kind {
    /// A variable of an elementary type.
    pub(in crate::simulate) fn of(kind: ElementaryType) -> Kind {
        Kind::Elementary(kind, TEXT_LENGTH)
    }

    /// What it takes of memory.
    pub(in crate::simulate) fn size(&self) -> Extent {
        match self {
            Kind::Elementary(ElementaryType::Bool, _) => Extent::BIT,
            Kind::Elementary(ElementaryType::String | ElementaryType::Wstring, _) => Extent::TEXT,
            Kind::Elementary(..) | Kind::Subrange(..) | Kind::Enumeration(_) => Extent::WORD,
            Kind::Array(bounds, element) => element.size().times(count(bounds)),
            Kind::Record(record) => record.size,
        }
    }

    /// The bits that it takes at an address; nothing for what does not lie there, as structures do not.
    pub(in crate::simulate) fn bits(&self) -> Option<u64> {
        match self {
            Kind::Array(bounds, element) => element.bits()?.checked_mul(count(bounds)),
            _ => self.elementary()?.bits().map(u64::from),
        }
    }

    /// How deep records are nested in it; 0 if it has none.
    pub(in crate::simulate) fn depth(&self) -> usize {
        match self {
            Kind::Array(_, element) => element.depth() + 1,
            Kind::Record(record) => record.depth,
            _ => 0,
        }
    }

    /// The elementary type that its values are: of an enumeration that of the numbers of its names.
    pub(in crate::simulate) fn elementary(&self) -> Option<ElementaryType> {
        match self {
            Kind::Elementary(kind, _) | Kind::Subrange(kind, _) => Some(*kind),
            Kind::Enumeration(_) => Some(ElementaryType::Int),
            _ => None,
        }
    }

    /// Whether a variable of the one kind may be handed over as one of the other: it may have a narrower range.
    pub(in crate::simulate) fn is_like(&self, other: &Kind) -> bool {
        let whole = |kind: &Kind| match kind {
            Kind::Subrange(kind, _) => Kind::of(*kind),
            other => other.clone(),
        };
        whole(self).is_same(&whole(other))
    }

    /// Whether values of both are the same: what one has may be copied to the other.
    pub(in crate::simulate) fn is_same(&self, other: &Kind) -> bool {
        match (self, other) {
            (Kind::Elementary(own, _), Kind::Elementary(other, _)) => own == other,
            (Kind::Subrange(own, range), Kind::Subrange(other, other_range)) => {
                (own, range) == (other, other_range)
            }
            (Kind::Enumeration(own), Kind::Enumeration(other)) => own == other,
            (Kind::Array(own, element), Kind::Array(other, other_element)) => {
                own == other && element.is_same(other_element)
            }
            (Kind::Record(own), Kind::Record(other)) => {
                own.fields.len() == other.fields.len()
                    && own.fields.iter().zip(&other.fields).all(|(own, other)| {
                        own.name.eq_ignore_ascii_case(&other.name) && own.kind.is_same(&other.kind)
                    })
            }
            _ => false,
        }
    }
}

/// How many elements an array has.
pub(in crate::simulate) fn count(bounds: &[(i64, i64)]) -> u64 {
    let lengths =
        bounds.iter().map(|(least, greatest)| greatest.saturating_sub(*least).saturating_add(1).max(0));
    lengths.fold(1, |all, length| all.saturating_mul(length as u64))
}

impl Record {
    /// A record of these fields, which get their places here.
    pub(in crate::simulate) fn new(what: RecordKind, fields: Vec<Field>, behind: Extent) -> Record {
        let depth = fields.iter().map(|field| field.kind.depth()).max().unwrap_or(0) + 1;
        let mut places = FxHashMap::default();
        for (place, field) in fields.iter().enumerate() {
            places.entry(folded(&field.name)).or_insert(place);
        }
        let mut record = Record { what, fields, size: Extent::default(), depth, places };
        for field in &mut record.fields {
            field.at = record.size;
            let memory = match field.edge {
                Some(_) => Extent::BIT.times(2),
                None => Extent::default(),
            };
            let own = if field.has_place() { field.kind.size() } else { Extent::default() };
            record.size = record.size.plus(own).plus(memory);
        }
        record.size = record.size.plus(behind);
        record
    }

    /// The field called `name`, letter case aside.
    pub(in crate::simulate) fn field(&self, name: &str) -> Option<&Field> {
        self.fields.get(*self.places.get(&folded(name))?)
    }
}

impl Field {
    /// A field of a structure, or a pin.
    pub(in crate::simulate) fn new(name: SmolStr, kind: Kind, section: SectionKind) -> Field {
        let at = Extent::default();
        Field { name, kind, at, section, is_constant: false, declared: None, edge: None, address: None }
    }

    /// Whether the record has its value; else it lies elsewhere.
    pub(in crate::simulate) fn has_place(&self) -> bool {
        self.address.is_none() && !matches!(self.section, SectionKind::InOut | SectionKind::External)
    }
}
