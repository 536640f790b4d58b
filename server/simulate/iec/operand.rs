//! Finds what operands name: variables with members and subscripts, addresses, literals.

use super::compile::Compiler;
use super::initial::constant;
use super::kind::{Extent, Kind};
use super::parts::{Index, Input, Lies, Spot};
use super::place::{At, Place as Variable};
use crate::il::iec::{Edge, SectionKind};
use crate::simulate::row::{Cell, Row};
use crate::simulate::{Obstacle, Slot};
use crate::target::iec::{Datum, ElementaryType, Function, GenericType, Literal, LiteralValue};
use crate::target::{Model, Operand};
use crate::text::{Message, folded};

/// What an operand is.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// A literal that takes on the type that is wanted where it stands.
    Literal(Literal, String),
    /// A value of an enumeration.
    Named(i128),
    Variable(Variable),
}

/// A subscript.
enum Subscript {
    Known(i64),
    /// In this word when the program runs.
    Word(Slot),
}

/// An error with a word in it.
pub(super) fn said(key: &'static str, word: &str) -> Obstacle {
    Obstacle::Iec(Message::new(key).with("name", word))
}

impl Compiler<'_> {
    /// What an operand is, seen from the body that is being compiled.
    pub(super) fn value(&mut self, word: &str) -> Result<Value, Obstacle> {
        match Operand::read(word, Model::Iec) {
            Operand::Literal(literal) if literal.value == LiteralValue::Enumerated => {
                let (of, name) = word.split_once('#').unwrap_or(("", word));
                self.enumerated(name, Some(of))
                    .map(Value::Named)
                    .ok_or_else(|| said("simulate.undeclared", word))
            }
            Operand::Literal(literal) => Ok(Value::Literal(literal, word.to_string())),
            Operand::Direct(address) => {
                self.image.named.insert(address);
                let kind = Kind::of(super::image::kind_of(address.width));
                self.located(address, &kind).map(Value::Variable)
            }
            Operand::Variable => match self.variable(word) {
                Err(obstacle) => self.enumerated(word, None).map(Value::Named).ok_or(obstacle),
                Ok(variable) => Ok(Value::Variable(variable)),
            },
            _ => Err(Obstacle::Unreadable),
        }
    }

    /// The number of a value of an enumerated type.
    fn enumerated(&mut self, name: &str, of: Option<&str>) -> Option<i128> {
        let name = folded(name);
        if let Some(of) = of {
            self.kind_named(of);
        } else {
            let types: Vec<_> = self.declared.types.keys().cloned().collect();
            types.iter().for_each(|name| self.kind_named(name));
        }
        let place = |kind: &Kind| match kind {
            Kind::Enumeration(names) => names.values.iter().position(|own| folded(own) == name),
            _ => None,
        };
        let own = self.records.values().flat_map(|record| &record.fields).map(|field| &field.kind);
        let found = match of {
            Some(of) => self.kinds.get(&folded(of)).and_then(place),
            None => self.kinds.values().chain(own).find_map(place),
        };
        found.map(|place| place as i128)
    }

    /// Reads a type by its name; what is wrong with it is told where it is used.
    fn kind_named(&mut self, name: &str) {
        let name = folded(name);
        let Some((source, index)) = self.declared.types.get(&name).copied() else { return };
        let Some(declared) = self.declared.declaration(source, index).declared else { return };
        if !self.kinds.contains_key(&name)
            && let Ok(kind) = self.kind(source, declared, None)
        {
            self.kinds.insert(name, kind);
        }
    }

    /// The variable that a path leads to.
    pub(super) fn variable(&mut self, path: &str) -> Result<Variable, Obstacle> {
        let end = path.find(|c: char| ".[^".contains(c) || c.is_whitespace()).unwrap_or(path.len());
        let (root, rest) = path.split_at(end);
        let root = self.root(root)?;
        self.within(root, rest)
    }

    /// The part of a variable to which `rest` of its path leads: `.Arms[2].Speed`.
    pub(super) fn within(&mut self, variable: Variable, rest: &str) -> Result<Variable, Obstacle> {
        let (mut variable, mut rest) = (variable, rest);
        loop {
            rest = rest.trim_start();
            let Some(mark) = rest.chars().next() else { return Ok(variable) };
            rest = &rest[mark.len_utf8()..];
            variable = match mark {
                '[' => {
                    let close = closing(rest).ok_or(Obstacle::Unreadable)?;
                    let (inside, after) = rest.split_at(close);
                    rest = &after[1..];
                    self.element(&variable, inside)?
                }
                '.' => {
                    let end =
                        rest.find(|c: char| ".[^".contains(c) || c.is_whitespace()).unwrap_or(rest.len());
                    let (name, after) = rest.split_at(end);
                    rest = after;
                    match &variable.kind {
                        Kind::Record(_) => self.member(&variable, name)?,
                        _ => partial(&variable, name).ok_or_else(|| said("simulate.no-member", name))?,
                    }
                }
                _ => return Err(Obstacle::Iec(Message::new("simulate.reference"))),
            };
        }
    }

    /// The variable that a name stands for.
    fn root(&mut self, name: &str) -> Result<Variable, Obstacle> {
        let key = folded(name);
        let is_refused = self.refused.contains(&(None, key.clone()));
        let unknown = || if is_refused { Obstacle::Follows } else { said("simulate.undeclared", name) };
        let Some(body) = self.bodies.get(self.now) else {
            return self.globals.get(&key).cloned().ok_or_else(unknown);
        };
        let (unit, base) = (body.unit, body.base);
        if let Some((_, variable)) = body.aliases.iter().find(|(own, _)| *own == key) {
            return Ok(variable.clone());
        }
        let record = self.record(unit);
        if self.refused.contains(&(Some(unit), key.clone())) {
            return Err(Obstacle::Follows);
        }
        if let Some(field) = record.field(name).filter(|field| field.section != SectionKind::External) {
            if field.section == SectionKind::InOut {
                return Err(unknown());
            }
            let mut variable = match field.address {
                Some(address) => self.located(address, &field.kind)?,
                None => {
                    // The unit sees the edge of such an input, which lies two cells behind it.
                    let behind = if field.edge.is_some() { Extent::BIT.times(2) } else { Extent::default() };
                    self.bound_to(Variable::new(field.kind.clone(), base.plus(field.at).plus(behind)))
                }
            };
            variable.is_constant =
                field.is_constant || field.section == SectionKind::Input && field.edge.is_some();
            return Ok(variable);
        }
        if let Some(global) = self.globals.get(&key) {
            return Ok(global.clone());
        }
        if ["REF", "NULL"].iter().any(|word| word.eq_ignore_ascii_case(name)) {
            return Err(Obstacle::Iec(Message::new("simulate.reference")));
        }
        if self.declared.units[unit].kind.is_some() || self.enumerated(name, None).is_some() {
            return Err(unknown());
        }
        // Outside of all units nothing can be declared, and names are those of relays.
        let cell = match self.undeclared.get(&key) {
            Some(cell) => *cell,
            None => {
                let cell = self.builder.kept();
                self.undeclared.insert(key, cell);
                self.parts.names.add(
                    vec![name.into()],
                    &Variable {
                        kind: Kind::of(ElementaryType::Bool),
                        at: At::Other(Lies::Cell(cell)),
                        index: 0,
                        is_constant: false,
                    },
                );
                cell
            }
        };
        let (kind, at) = (Kind::of(ElementaryType::Bool), At::Other(Lies::Cell(cell)));
        Ok(Variable { kind, at, index: 0, is_constant: false })
    }

    /// The part of a structure or an instance with a name.
    pub(super) fn member(&mut self, variable: &Variable, name: &str) -> Result<Variable, Obstacle> {
        let unknown = || said("simulate.no-member", name);
        let Kind::Record(record) = variable.kind.clone() else { return Err(unknown()) };
        let field = record.field(name).ok_or_else(unknown)?;
        if let Some(address) = field.address {
            return self.located(address, &field.kind);
        }
        if !field.has_place() {
            return Err(unknown());
        }
        variable.part(field.kind.clone(), field.at).map(|part| self.bound_to(part)).ok_or_else(unknown)
    }

    /// The element with these subscripts.
    fn element(&mut self, variable: &Variable, subscripts: &str) -> Result<Variable, Obstacle> {
        let Kind::Array(bounds, element) = variable.kind.clone() else {
            return Err(Obstacle::Iec(Message::new("simulate.no-array")));
        };
        let words = split(subscripts);
        if words.len() != bounds.len() {
            return Err(Obstacle::Iec(Message::new("simulate.no-array")));
        }
        let mut behind = Extent::default();
        let mut open = Vec::new();
        let mut stride = variable.size_of(&element);
        for (word, (least, greatest)) in words.iter().zip(bounds.iter()).rev() {
            match self.subscript(word)? {
                Subscript::Known(number) if (*least..=*greatest).contains(&number) => {
                    behind = behind.plus(stride.times((number - least) as u64));
                }
                Subscript::Known(number) => {
                    let message = Message::new("simulate.index-known").with("index", number);
                    return Err(Obstacle::Iec(message));
                }
                Subscript::Word(word) => {
                    open.push(Index { word, least: *least, greatest: *greatest, stride });
                }
            }
            stride = stride.times((greatest - least + 1) as u64);
        }
        let mut part = variable.part((*element).clone(), behind).ok_or(Obstacle::Unreadable)?;
        if !open.is_empty() {
            if let Some(number) = part.index.checked_sub(1) {
                open.extend(self.parts.indices[number as usize].iter().copied());
            }
            self.parts.indices.push(open);
            part.index = self.parts.indices.len() as u32;
        }
        Ok(part)
    }

    /// A sum of products.
    fn subscript(&mut self, text: &str) -> Result<Subscript, Obstacle> {
        let mut rest = text.trim();
        let result = self.sum(&mut rest)?;
        if rest.is_empty() { Ok(result) } else { Err(Obstacle::Unreadable) }
    }

    fn sum(&mut self, rest: &mut &str) -> Result<Subscript, Obstacle> {
        let mut left = self.product(rest)?;
        while let Some(operator) = next_of(rest, "+-") {
            let right = self.product(rest)?;
            left = self.calculated(if operator == '+' { "ADD" } else { "SUB" }, left, right)?;
        }
        Ok(left)
    }

    fn product(&mut self, rest: &mut &str) -> Result<Subscript, Obstacle> {
        let mut left = self.primary(rest)?;
        while let Some(operator) = next_of(rest, "*/") {
            let right = self.primary(rest)?;
            left = self.calculated(if operator == '*' { "MUL" } else { "DIV" }, left, right)?;
        }
        Ok(left)
    }

    fn primary(&mut self, rest: &mut &str) -> Result<Subscript, Obstacle> {
        match next_of(rest, "+-(") {
            Some('+') => return self.primary(rest),
            Some('-') => {
                let right = self.primary(rest)?;
                return self.calculated("SUB", Subscript::Known(0), right);
            }
            Some(_) => {
                let inside = self.sum(rest)?;
                return next_of(rest, ")").map(|_| inside).ok_or(Obstacle::Unreadable);
            }
            None => {}
        }
        let (mut open, mut end) = (0_u32, rest.len());
        for (at, character) in rest.char_indices() {
            match character {
                '[' => open += 1,
                ']' => open = open.saturating_sub(1),
                _ if open > 0 || character.is_alphanumeric() || "_.#%^".contains(character) => {}
                _ => {
                    end = at;
                    break;
                }
            }
        }
        let (word, after) = rest.split_at(end);
        *rest = after.trim_start();
        match self.value(word)? {
            Value::Literal(literal, _) => match literal.value {
                LiteralValue::Integer(number) => {
                    i64::try_from(number).map(Subscript::Known).map_err(|_| Obstacle::Unreadable)
                }
                _ => Err(Obstacle::Unreadable),
            },
            Value::Named(number) => Ok(Subscript::Known(number as i64)),
            Value::Variable(variable) => {
                let spot = variable.spot().filter(|spot| spot.kind.integers().is_some());
                match spot.ok_or_else(|| said("simulate.no-number", word))? {
                    Spot { lies: Lies::Word(slot), index: 0, .. } => Ok(Subscript::Word(slot)),
                    spot => {
                        let to = self.number_word();
                        self.copy(Input::At(spot), spot.kind, word_spot(to));
                        Ok(Subscript::Word(to))
                    }
                }
            }
        }
    }

    fn calculated(&mut self, name: &str, left: Subscript, right: Subscript) -> Result<Subscript, Obstacle> {
        if let (Subscript::Known(left), Subscript::Known(right)) = (&left, &right) {
            let result = match name {
                "ADD" => left.checked_add(*right),
                "SUB" => left.checked_sub(*right),
                "MUL" => left.checked_mul(*right),
                _ => left.checked_div(*right),
            };
            return result.map(Subscript::Known).ok_or(Obstacle::Unreadable);
        }
        let function = Function::named(name).ok_or(Obstacle::Unreadable)?;
        let input = |subscript| match subscript {
            Subscript::Known(number) => Input::Constant(Datum::Whole(i128::from(number))),
            Subscript::Word(word) => Input::At(word_spot(word)),
        };
        let to = self.number_word();
        let inputs = [left, right].map(|side| (input(side), ElementaryType::Lint)).to_vec();
        self.compute(function.formula, inputs, ElementaryType::Lint, word_spot(to));
        Ok(Subscript::Word(to))
    }

    fn number_word(&mut self) -> Slot {
        self.builder.words(1)
    }

    /// The same variable whose subscripts stay what they are now.
    pub(super) fn frozen(&mut self, variable: Variable) -> Variable {
        let Some(number) = variable.index.checked_sub(1) else { return variable };
        let mut indices = self.parts.indices[number as usize].clone();
        for index in &mut indices {
            let to = self.number_word();
            self.copy(Input::At(word_spot(index.word)), ElementaryType::Lint, word_spot(to));
            index.word = to;
        }
        self.parts.indices.push(indices);
        Variable { index: self.parts.indices.len() as u32, ..variable }
    }

    /// The relay that a BOOL operand is; of one that is found at run time only a copy.
    pub(super) fn relay(&mut self, word: &str) -> Result<Cell, Obstacle> {
        let wrong = || said("simulate.no-bit", word);
        match self.value(word)? {
            Value::Literal(literal, _) => {
                let value =
                    constant(Operand::Literal(literal), word, ElementaryType::Bool).ok_or_else(wrong)?;
                Ok(if value.whole() != 0 { Row::RAIL } else { Row::OFF })
            }
            Value::Named(_) => Err(wrong()),
            Value::Variable(variable) => match (variable.cell(), variable.spot()) {
                (Some(cell), _) => Ok(cell),
                (None, Some(spot)) if spot.kind == ElementaryType::Bool => {
                    let to = self.builder.scratch();
                    self.copy(Input::At(spot), ElementaryType::Bool, cell_spot(to));
                    Ok(to)
                }
                _ => Err(wrong()),
            },
        }
    }

    /// Finds the edges of inputs that are declared with R_EDGE or F_EDGE, where a body begins.
    pub(super) fn edges(&mut self) {
        let Some(body) = self.bodies.get(self.now) else { return };
        let (unit, base) = (body.unit, body.base);
        for field in &self.record(unit).fields {
            let Some(edge) = field.edge else { continue };
            let input = base.plus(field.at).cells as Cell;
            self.builder.edge_of_input(input, edge == Edge::Rising);
        }
    }
}

/// A BOOL in a cell.
pub(super) fn cell_spot(cell: Cell) -> Spot {
    Spot::of_cell(cell)
}

pub(super) fn word_spot(slot: Slot) -> Spot {
    Spot::new(ElementaryType::Lint, Lies::Word(slot))
}

/// A part of a bit string: `.3`, `.%X3`, `.%B1`.
fn partial(variable: &Variable, name: &str) -> Option<Variable> {
    let spot = variable.spot()?;
    let bits = spot.kind.bits().filter(|_| !spot.kind.belongs_to(GenericType::AnyReal))?;
    let part = name.strip_prefix('%').unwrap_or(name);
    let digits = part.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let kind = match part[..part.len() - digits.len()].to_ascii_uppercase().as_str() {
        "" | "X" => ElementaryType::Bool,
        "B" => ElementaryType::Byte,
        "W" => ElementaryType::Word,
        "D" => ElementaryType::Dword,
        _ => return None,
    };
    let width = kind.bits()?;
    let shift = digits.parse::<u32>().ok()?.checked_mul(width)?;
    if shift + width > bits || bits == 1 {
        return None;
    }
    let lies = match spot.lies {
        Lies::Word(slot) => Lies::Part(slot, shift as u8, width as u8),
        Lies::Bits(first, _) if width == 1 => Lies::Cell(first + shift as Cell),
        Lies::Bits(first, _) => Lies::Bits(first + shift as Cell, width as u8),
        Lies::Part(slot, from, _) => Lies::Part(slot, from + shift as u8, width as u8),
        _ => return None,
    };
    Some(Variable { kind: Kind::of(kind), at: At::Other(lies), ..variable.clone() })
}

/// Where the bracket closes that is open.
fn closing(text: &str) -> Option<usize> {
    let mut open = 0_u32;
    text.char_indices().find_map(|(at, character)| match character {
        '[' => {
            open += 1;
            None
        }
        ']' if open == 0 => Some(at),
        ']' => {
            open -= 1;
            None
        }
        _ => None,
    })
}

/// The subscripts between commas.
fn split(text: &str) -> Vec<&str> {
    let (mut open, mut start, mut parts) = (0_i32, 0, Vec::new());
    for (at, character) in text.char_indices() {
        match character {
            '[' | '(' => open += 1,
            ']' | ')' => open -= 1,
            ',' if open == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

fn next_of(rest: &mut &str, wanted: &str) -> Option<char> {
    let text = rest.trim_start();
    let first = text.chars().next().filter(|first| wanted.contains(*first))?;
    *rest = text[first.len_utf8()..].trim_start();
    Some(first)
}
