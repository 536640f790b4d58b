//! Reads types and sections of variables.

use super::compile::Compiler;
use super::declarations::Section;
use super::kind::{Declared, Enumeration, Extent, Field, Kind, Record, RecordKind};
use crate::il::iec::{Declaration, OperandId, PouKind, SectionKind, TypeId, TypeSpec};
use crate::simulate::{Obstacle, Problem};
use crate::target::iec::semantics::NOTES;
use crate::target::iec::{ElementaryType, FunctionBlock, LiteralValue, Parameter, ParameterType};
use crate::target::{DirectAddress, Location, Operand};
use crate::text::{Message, Span, folded};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;
use std::sync::Arc;

/// Instances and structures may be nested so deep.
const NESTED_MAX: usize = 64;

impl Compiler<'_> {
    fn problem(&self, source: usize, span: Span, obstacle: Obstacle) -> Problem {
        Problem { place: self.declared.place(source, span), obstacle }
    }

    /// The type that a record of a source is.
    pub(super) fn kind(&mut self, source: usize, id: TypeId, unit: Option<usize>) -> Result<Kind, Problem> {
        let tree = self.declared.sources[source].tree;
        let written = tree.type_spec(id);
        let refused =
            |own: &Self, key| Err(own.problem(source, written.span, Obstacle::Iec(Message::new(key))));
        Ok(match written.value {
            TypeSpec::Elementary(kind) => Kind::of(kind),
            TypeSpec::Named => return self.named(source, written.span, unit),
            TypeSpec::Subrange { base, least, greatest } => {
                let base = self.kind(source, base, unit)?;
                let [least, greatest] = [least, greatest].map(|at| self.number(source, at, unit));
                match (base.elementary(), least, greatest) {
                    (Some(kind), Some(least), Some(greatest)) if least <= greatest => {
                        let range = (least, greatest);
                        let known = self.parts.ranges.iter().position(|own| *own == range);
                        let number = known.unwrap_or_else(|| {
                            self.parts.ranges.push(range);
                            self.parts.ranges.len() - 1
                        });
                        Kind::Subrange(kind, number as u32 + 1)
                    }
                    _ => return refused(self, "simulate.bounds"),
                }
            }
            TypeSpec::Reference { .. } => return refused(self, "simulate.reference"),
            TypeSpec::Text { wide, length } => {
                let kind = if wide { ElementaryType::Wstring } else { ElementaryType::String };
                match self.bound(source, length, unit).and_then(|length| usize::try_from(length).ok()) {
                    Some(length) => Kind::Elementary(kind, length.min(u32::MAX as usize)),
                    None => return refused(self, "simulate.bounds"),
                }
            }
            TypeSpec::Enumeration { values } => {
                let names =
                    values.of(&tree.names).iter().map(|name| self.declared.word(source, *name).into());
                Kind::Enumeration(Arc::new(Enumeration { values: names.collect() }))
            }
            TypeSpec::Array { bounds, element } => {
                let mut limits = Vec::new();
                for at in (bounds.start..bounds.end).step_by(2) {
                    let [least, greatest] = [at, at + 1].map(|at| self.bound(source, OperandId(at), unit));
                    match (least, greatest) {
                        (Some(least), Some(greatest)) if least <= greatest => limits.push((least, greatest)),
                        _ => return refused(self, "simulate.bounds"),
                    }
                }
                Kind::Array(limits.into(), Arc::new(self.kind(source, element, unit)?))
            }
            TypeSpec::Structure { fields } => {
                let mut parts = Vec::new();
                for index in fields.start..fields.end {
                    parts.extend(self.declaration(
                        source,
                        index as usize,
                        SectionKind::Local,
                        false,
                        unit,
                    )?);
                }
                let record = Record::new(RecordKind::Structure, parts, Extent::default());
                Kind::Record(Arc::new(record))
            }
        })
    }

    /// The type with a name.
    fn named(&mut self, source: usize, span: Span, unit: Option<usize>) -> Result<Kind, Problem> {
        let word = self.declared.word(source, span);
        let name = folded(word);
        if let Some(kind) = self.kinds.get(&name) {
            return Ok(kind.clone());
        }
        let refused = |own: &Self, message: Message| {
            Err(own.problem(source, span, Obstacle::Iec(message.with("name", word))))
        };
        if self.open.contains(&name) {
            return refused(self, Message::new("simulate.recursion"));
        }
        let too_deep = || Message::new("simulate.nested").with("most", NESTED_MAX);
        if self.open.len() >= NESTED_MAX {
            return refused(self, too_deep());
        }
        self.open.push(name.clone());
        let kind = self.unnamed(&name, word, unit);
        self.open.pop();
        let unknown =
            || self.problem(source, span, Obstacle::Iec(Message::new("simulate.no-type").with("name", word)));
        let kind = kind.unwrap_or_else(|| Err(unknown()))?;
        if kind.depth() > NESTED_MAX {
            return refused(self, too_deep());
        }
        self.kinds.insert(name, kind.clone());
        Ok(kind)
    }

    fn unnamed(&mut self, name: &SmolStr, word: &str, unit: Option<usize>) -> Option<Result<Kind, Problem>> {
        if let Some((source, index)) = self.declared.types.get(name).copied() {
            let declared = self.declared.declaration(source, index).declared?;
            return Some(self.kind(source, declared, unit));
        }
        if let Some(number) = self.declared.unit(word, PouKind::FunctionBlock) {
            return Some(Ok(Kind::Record(self.record(number))));
        }
        let block = FunctionBlock::named(word)?;
        Some(Ok(Kind::Record(Arc::new(of_block(block)))))
    }

    /// A number that is known before the program runs: a literal, or a constant.
    fn bound(&self, source: usize, id: OperandId, unit: Option<usize>) -> Option<i64> {
        self.number(source, id, unit).and_then(|number| i64::try_from(number).ok())
    }

    fn number(&self, source: usize, id: OperandId, unit: Option<usize>) -> Option<i128> {
        let operand = self.declared.sources[source].tree.operand(id);
        match operand.value {
            Operand::Literal(literal) => match literal.value {
                LiteralValue::Integer(number) => Some(number),
                _ => None,
            },
            Operand::Variable => {
                let (source, id) = self.constant(self.declared.word(source, operand.span), unit)?;
                match self.declared.sources[source].tree.operand(id).value {
                    // A constant of constants is not followed.
                    Operand::Literal(_) => self.number(source, id, unit),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Where the value of a constant with this name stands.
    pub(super) fn constant(&self, name: &str, unit: Option<usize>) -> Option<(usize, OperandId)> {
        let own = unit.map(|unit| &self.declared.units[unit].sections[..]).unwrap_or_default();
        let global = self.declared.sources.iter().enumerate().flat_map(|(source, at)| {
            at.tree.items.iter().filter_map(move |item| match item.kind {
                crate::il::iec::ItemKind::Section {
                    kind: SectionKind::Global,
                    constant: true,
                    declarations,
                    ..
                } => Some(Section { source, kind: SectionKind::Global, is_constant: true, declarations }),
                _ => None,
            })
        });
        let sections = own.iter().copied().filter(|section| section.is_constant).chain(global);
        for section in sections {
            let tree = self.declared.sources[section.source].tree;
            for declaration in section.declarations.of(&tree.declarations) {
                let is_own = |span: &Span| folded(self.declared.word(section.source, *span)) == folded(name);
                if declaration.names.of(&tree.names).iter().any(is_own) {
                    let value = self.declared.value(section.source, declaration.initial?)?;
                    return match value.kind {
                        crate::il::iec::ValueKind::Constant(id) => Some((section.source, id)),
                        _ => None,
                    };
                }
            }
        }
        None
    }

    /// The variables of a declaration.
    fn declaration(
        &mut self,
        source: usize,
        index: usize,
        section: SectionKind,
        is_constant: bool,
        unit: Option<usize>,
    ) -> Result<Vec<Field>, Problem> {
        let tree = self.declared.sources[source].tree;
        let declaration = &tree.declarations[index];
        let Some(id) = declaration.declared else {
            return Err(self.problem(source, declaration.span, Obstacle::Unreadable));
        };
        let kind = self.kind(source, id, unit)?;
        let address = match declaration.address.map(|id| tree.operand(id).value) {
            Some(Operand::Direct(address)) => Some(address),
            Some(_) => return Err(self.problem(source, declaration.span, Obstacle::Unreadable)),
            None => None,
        };
        // `%I*` is bound elsewhere, or nowhere.
        let address = address.filter(|address| address.path[0].is_some());
        let names = declaration.names.of(&tree.names).iter();
        let field = |name: &Span| Field {
            is_constant,
            address,
            edge: declaration.edge,
            declared: Some(Declared { source, index }),
            ..Field::new(self.declared.word(source, *name).into(), kind.clone(), section)
        };
        Ok(names.map(field).collect())
    }

    /// The variables of a section; what cannot be read is told and left out.
    pub(super) fn fields(&mut self, section: Section, unit: Option<usize>) -> Vec<Field> {
        let mut fields = Vec::new();
        for index in section.declarations.start..section.declarations.end {
            let read =
                self.declaration(section.source, index as usize, section.kind, section.is_constant, unit);
            match read {
                Ok(read) => fields.extend(read),
                Err(problem) => {
                    self.problems.push(problem);
                    let tree = self.declared.sources[section.source].tree;
                    let names = tree.declarations[index as usize].names.of(&tree.names).iter();
                    let names = names.map(|name| folded(self.declared.word(section.source, *name)));
                    let names: Vec<_> = names.map(|name| (unit, name)).collect();
                    self.refused.extend(names);
                }
            }
        }
        fields
    }

    /// Lets arrays at addresses lie side by side before anything else has its place there.
    pub(super) fn reserve(&mut self) {
        let globals = self.declared.globals.iter().map(|section| (*section, None));
        let own = self.declared.units.iter().enumerate();
        let own = own.flat_map(|(unit, at)| at.sections.iter().map(move |section| (*section, Some(unit))));
        let sections: Vec<(Section, Option<usize>)> = globals.chain(own).collect();
        let mut rows: Vec<(DirectAddress, (u64, u64))> = Vec::new();
        for (section, unit) in sections {
            let located = |at: &Declaration| at.address.is_some();
            let tree = self.declared.sources[section.source].tree;
            if !section.declarations.of(&tree.declarations).iter().any(located) {
                continue;
            }
            for field in self.fields(section, unit) {
                if let (Some(address), None) = (field.address, field.kind.elementary()) {
                    rows.extend(super::image::extent(address, &field.kind).map(|extent| (address, extent)));
                }
            }
        }
        let mut ground = (&mut self.builder, &mut self.parts);
        for location in [Location::Input, Location::Output, Location::Memory] {
            let own = rows.iter().filter(|(address, _)| address.location == location);
            self.image.reserve(location, own.map(|(_, extent)| *extent), &mut ground);
        }
    }

    /// The variables of a unit; behind those of a function lies its result.
    pub(super) fn record(&mut self, unit: usize) -> Arc<Record> {
        if let Some(record) = self.records.get(&unit) {
            return Arc::clone(record);
        }
        let (mut fields, mut known) = (Vec::new(), FxHashSet::default());
        for section in self.declared.units[unit].sections.clone() {
            for field in self.fields(section, Some(unit)) {
                // The first declaration of a name holds.
                if known.insert(folded(&field.name)) {
                    fields.push(field);
                }
            }
        }
        if let Some((source, id)) = self.declared.units[unit].result {
            match self.kind(source, id, Some(unit)) {
                Ok(kind) => {
                    let name = self.declared.units[unit].name.clone();
                    fields.push(Field::new(name, kind, SectionKind::Local));
                }
                Err(problem) => self.problems.push(problem),
            }
        }
        let record = Arc::new(Record::new(RecordKind::Unit(unit), fields, Extent::default()));
        self.records.insert(unit, Arc::clone(&record));
        record
    }
}

/// An instance of a standard block: its pins, and behind them what it notes.
fn of_block(block: &'static FunctionBlock) -> Record {
    let field = |section| {
        move |pin: &Parameter| {
            let kind = match pin.kind {
                ParameterType::Elementary(kind) => kind,
                ParameterType::Generic(_) => ElementaryType::Int,
            };
            Field::new(pin.name.into(), Kind::of(kind), section)
        }
    };
    let inputs = block.inputs.iter().map(field(SectionKind::Input));
    let outputs = block.outputs.iter().map(field(SectionKind::Output));
    let notes = Extent::WORD.times(NOTES as u64);
    Record::new(RecordKind::Block(block), inputs.chain(outputs).collect(), notes)
}
