//! The current result of an instruction list, of whatever type, and what is done with it.

use super::compile::Compiler;
use super::initial::constant;
use super::operand::{Value, cell_spot, said};
use super::parts::{Input, Lies, Spot};
use super::place::Place as Variable;
use crate::simulate::Obstacle;
use crate::simulate::builder::Position;
use crate::target::Operand;
use crate::target::iec::{
    Datum, ElementaryType, Function, GenericType, Literal, LiteralValue, Operator, ParameterType,
};
use crate::text::Message;

/// The current result.
#[derive(Clone, Debug)]
pub(super) enum Current {
    /// There is none.
    Nothing,
    /// A BOOL, which the builder has.
    Bit,
    /// A value of another type.
    Given(Given),
    /// A value with parts.
    Whole(Variable),
}

/// A value on its way into a calculation.
#[derive(Clone, Debug)]
pub(super) struct Given {
    pub(super) input: Input,
    pub(super) kind: ElementaryType,
    /// A literal that takes on other types.
    pub(super) literal: Option<(Literal, String)>,
    /// Whether it lies at an address without a declared type: its bits are a value of whatever type is wanted.
    is_raw: bool,
}

impl Given {
    /// Whether it is a literal that names no type.
    fn is_free(&self) -> bool {
        self.literal.as_ref().is_some_and(|(literal, _)| literal.named_type.is_none())
    }

    /// The same value as one of type `kind` that has as many bits.
    fn seen_as(self, kind: ElementaryType) -> Given {
        match self.input {
            Input::At(spot) if self.is_raw && kind.bits() == self.kind.bits() => {
                Given { input: Input::At(Spot { kind, ..spot }), kind, ..self }
            }
            _ => self,
        }
    }

    /// Whether it is a literal that may be of type `kind`.
    fn takes(&self, kind: ElementaryType) -> bool {
        self.literal.as_ref().is_some_and(|(literal, word)| {
            literal.named_type.is_none_or(|named| named == kind)
                && constant(Operand::Literal(*literal), word, kind).is_some()
        })
    }

    pub(super) fn at(spot: Spot) -> Given {
        Given { input: Input::At(spot), kind: spot.kind, literal: None, is_raw: false }
    }
}

/// An obstacle: a value of one type where another one is wanted.
pub(super) fn mismatch(own: ElementaryType, wanted: impl std::fmt::Display) -> Obstacle {
    Obstacle::Iec(Message::new("simulate.mismatch").with("own", own).with("wanted", wanted))
}

/// Whether a value of one type is taken where another one is wanted: the same, a wider one, or another integer or bit
/// string, of which the value tells when the program runs whether it fits.
fn is_taken(own: ElementaryType, wanted: ElementaryType) -> bool {
    let is_number = |kind: ElementaryType| kind.integers().is_some() && kind != ElementaryType::Bool;
    own == wanted
        || own.widens_to(wanted)
        || is_number(own) && is_number(wanted)
        || own == ElementaryType::Lreal && wanted == ElementaryType::Real
}

impl Compiler<'_> {
    /// An operand as a value for a calculation.
    pub(super) fn given(&mut self, word: &str) -> Result<Given, Obstacle> {
        Ok(match self.value(word)? {
            Value::Literal(literal, text) => {
                let kind = literal.natural_type().ok_or(Obstacle::Unreadable)?;
                let value = constant(Operand::Literal(literal), &text, kind).ok_or(Obstacle::Unreadable)?;
                Given { input: Input::Constant(value), kind, literal: Some((literal, text)), is_raw: false }
            }
            Value::Named(number) => {
                let input = Input::Constant(Datum::Whole(number));
                Given { input, kind: ElementaryType::Int, literal: None, is_raw: false }
            }
            Value::Variable(variable) => {
                let given = Given::at(variable.spot().ok_or_else(|| said("simulate.not-elementary", word))?);
                Given { is_raw: word.starts_with('%'), ..given }
            }
        })
    }

    /// The value where one of type `wanted` is expected.
    pub(super) fn fitted(
        &self,
        given: Given,
        wanted: ElementaryType,
    ) -> Result<(Input, ElementaryType), Obstacle> {
        let given = given.seen_as(wanted);
        if let Some((literal, word)) = &given.literal {
            // One character in quotes is a text as well as a character.
            let is_text = matches!(literal.value, LiteralValue::Text | LiteralValue::WideText);
            let is_named = literal.named_type.is_some_and(|named| named != wanted) && !is_text;
            if let Some(value) = constant(Operand::Literal(*literal), word, wanted).filter(|_| !is_named) {
                return Ok((Input::Constant(value), wanted));
            }
        }
        match is_taken(given.kind, wanted) {
            true => Ok((given.input, given.kind)),
            false => Err(mismatch(given.kind, wanted)),
        }
    }

    /// Stores a value in a variable.
    pub(super) fn stored(&mut self, given: Given, to: Spot) -> Result<(), Obstacle> {
        let (input, kind) = self.fitted(given, to.kind)?;
        if input != Input::At(to) {
            self.copy(input, kind, to);
        }
        Ok(())
    }

    /// What the standard function `function` makes of values: its type, and where it is.
    pub(super) fn applied(
        &mut self,
        function: &'static Function,
        given: Vec<Given>,
        expected: Option<ElementaryType>,
        to: impl FnOnce(&mut Self, ElementaryType) -> Spot,
    ) -> Result<Spot, Obstacle> {
        let least = function.inputs.len();
        if given.len() < least || given.len() > least && !function.extensible {
            return Err(said("simulate.operands", function.name));
        }
        let own = |place: usize| function.input(place).map(|input| input.kind);
        let given = unraw(given, &own);
        let pair = match &given[..] {
            [left, right] => pair(function, left, right),
            _ => None,
        };
        let common: Vec<_> = (0..given.len()).map(|place| common(&given, &own, place, expected)).collect();
        let mut inputs = Vec::new();
        for (place, value) in given.into_iter().enumerate() {
            let wanted = match (pair, own(place)) {
                (Some((left, right, _)), _) => Some(if place == 0 { left } else { right }),
                (None, Some(ParameterType::Elementary(kind))) => Some(kind),
                _ => common[place],
            };
            let (input, kind) = match wanted {
                Some(wanted) => self.fitted(value, wanted)?,
                None => (value.input, value.kind),
            };
            match own(place) {
                Some(ParameterType::Generic(group)) if pair.is_none() && !group.contains(kind) => {
                    return Err(mismatch(kind, group));
                }
                _ => inputs.push((input, kind)),
            }
        }
        let result = match (pair, function.result) {
            (Some((_, _, result)), _) => result,
            (None, ParameterType::Elementary(kind)) => kind,
            (None, ParameterType::Generic(group)) => {
                let like = (0..inputs.len()).find(|place| own(*place) == Some(function.result));
                let expected = expected.filter(|kind| group.contains(*kind));
                let usual = [ElementaryType::Dint, ElementaryType::Lword, ElementaryType::Lreal];
                let usual = usual.into_iter().find(|kind| group.contains(*kind));
                like.and_then(|place| common[place]).or(expected).or(usual).ok_or(Obstacle::Unreadable)?
            }
        };
        let to = to(self, result);
        self.compute(function.formula, inputs, result, to);
        Ok(to)
    }

    /// Loads a value: what was before is no longer there.
    pub(super) fn load(&mut self, word: &str, negated: bool) -> Result<Current, Obstacle> {
        let value = self.value(word)?;
        let kind = match &value {
            Value::Variable(variable) => variable.kind.elementary(),
            Value::Literal(literal, _) => literal.natural_type(),
            Value::Named(_) => Some(ElementaryType::Int),
        };
        if kind == Some(ElementaryType::Bool) {
            self.builder.forget_power();
            let cell = self.relay(word)?;
            self.builder.connect(Position::First, cell, negated);
            return Ok(Current::Bit);
        }
        let given = match value {
            Value::Variable(variable) if kind.is_none() => {
                return match negated {
                    true => Err(said("simulate.no-bit", word)),
                    false => Ok(Current::Whole(variable)),
                };
            }
            _ => self.given(word)?,
        };
        match negated {
            true => self.complement(given, 0).map(Current::Given),
            false => Ok(Current::Given(given)),
        }
    }

    /// The complement of a bit string.
    pub(super) fn complement(&mut self, given: Given, depth: usize) -> Result<Given, Obstacle> {
        let function = Function::named("NOT").ok_or(Obstacle::Unreadable)?;
        let spot = self.applied(function, vec![given], None, |own, kind| own.temporary(kind, depth))?;
        Ok(Given::at(spot))
    }

    /// A place for a value while it is the current result, at a depth of parentheses.
    pub(super) fn temporary(&mut self, kind: ElementaryType, depth: usize) -> Spot {
        if kind == ElementaryType::Bool {
            return cell_spot(self.builder.scratch());
        }
        while self.temporaries.len() <= depth {
            let place = self.take(super::kind::Extent { cells: 0, words: 1, texts: 1 });
            self.temporaries.push(place);
        }
        let place = self.temporaries[depth];
        Spot::new(kind, super::place::lies(place, kind, u32::MAX as usize))
    }

    /// The value of the current result for a calculation; nothing if there is none, or it has parts.
    pub(super) fn given_of(&mut self, current: &Current) -> Option<Given> {
        match current {
            Current::Bit => {
                let cell = self.builder.settle();
                Some(Given::at(cell_spot(cell)))
            }
            Current::Given(given) => Some(given.clone()),
            Current::Nothing | Current::Whole(_) => None,
        }
    }

    /// The same current result in a place that nothing else writes.
    pub(super) fn kept(&mut self, current: Current, depth: usize) -> Current {
        match current {
            Current::Given(given) => match given.input {
                Input::At(spot) if self.temporary_at(depth) != Some(spot.lies) => {
                    let to = self.temporary(given.kind, depth);
                    self.copy(Input::At(spot), given.kind, to);
                    Current::Given(Given::at(to))
                }
                _ => Current::Given(given),
            },
            Current::Bit => {
                let cell = self.builder.settle();
                self.builder.set_power(cell);
                Current::Bit
            }
            other => other,
        }
    }

    fn temporary_at(&self, depth: usize) -> Option<Lies> {
        self.temporaries.get(depth).map(|place| Lies::Word(place.words))
    }

    /// The current result that a place has.
    pub(super) fn current_at(&mut self, spot: Spot) -> Current {
        match (spot.kind, spot.lies) {
            (ElementaryType::Bool, Lies::Cell(cell)) if spot.index == 0 => {
                self.builder.forget_power();
                self.builder.connect(Position::First, cell, false);
                Current::Bit
            }
            (ElementaryType::Bool, _) => {
                self.builder.forget_power();
                let to = self.builder.scratch();
                self.copy(Input::At(spot), spot.kind, cell_spot(to));
                self.builder.connect(Position::First, to, false);
                Current::Bit
            }
            _ => Current::Given(Given::at(spot)),
        }
    }

    /// Joins a current result that is a BOOL with a relay. `before` is the cell of what was before.
    pub(super) fn exclusive(&mut self, cell: crate::simulate::Cell, is_inverse: bool) {
        let before = self.builder.settle();
        let once = self.builder.scratch();
        self.builder.forget_power();
        self.builder.connect(Position::First, before, false);
        self.builder.connect(Position::Series, cell, !is_inverse);
        self.builder.out(once, false);
        self.builder.forget_power();
        self.builder.connect(Position::First, before, true);
        self.builder.connect(Position::Series, cell, is_inverse);
        self.builder.connect(Position::Parallel, once, false);
    }
}

/// The values with those at addresses as what the others are, or as integers where bit strings are not taken.
fn unraw(given: Vec<Given>, own: &impl Fn(usize) -> Option<ParameterType>) -> Vec<Given> {
    let typed = given.iter().find(|given| !given.is_raw && given.literal.is_none()).map(|given| given.kind);
    let has_real = given.iter().any(|given| given.kind.belongs_to(GenericType::AnyReal));
    let seen = |(place, given): (usize, Given)| {
        let Some(ParameterType::Generic(group)) = own(place) else { return given };
        let is_number = !group.contains(given.kind) || group == GenericType::AnyElementary;
        let numbers = if has_real { GenericType::AnyReal } else { GenericType::AnySigned };
        let signed = numbers.members().find(|kind| kind.bits() == given.kind.bits());
        match typed.or(signed.filter(|_| is_number)) {
            Some(kind) if given.is_raw => given.seen_as(kind),
            _ => given,
        }
    };
    given.into_iter().enumerate().map(seen).collect()
}

/// The types of both sides and of the result of what is an operator as well.
fn pair(
    function: &Function,
    left: &Given,
    right: &Given,
) -> Option<(ElementaryType, ElementaryType, ElementaryType)> {
    let operator = Operator::named(function.name)?;
    let (mut left_kind, mut right_kind) = (left.kind, right.kind);
    if right.takes(left_kind) && !left.is_free() {
        right_kind = left_kind;
    } else if left.takes(right_kind) {
        left_kind = right_kind;
    }
    let is_number = |kind: ElementaryType| kind.integers().is_some() && kind != ElementaryType::Bool;
    if let Some(result) = operator.combine(left_kind, right_kind, true) {
        return Some((left_kind, right_kind, result));
    }
    // Signed and unsigned integers are compared as they are, and else the wider type holds the result.
    let is_comparison = matches!(function.result, ParameterType::Elementary(_));
    let wide = if left_kind.bits() >= right_kind.bits() { left_kind } else { right_kind };
    let result = if is_comparison { ElementaryType::Bool } else { wide };
    let is_mixed = is_number(left_kind) && is_number(right_kind) && operator.operand?.contains(wide);
    is_mixed.then_some((left_kind, right_kind, result))
}

/// The one type of all inputs of a group: the widest of those that have one; of literals alone the type of the variable
/// that the result goes to, or the one that they have by themselves.
fn common(
    given: &[Given],
    own: &impl Fn(usize) -> Option<ParameterType>,
    place: usize,
    expected: Option<ElementaryType>,
) -> Option<ElementaryType> {
    let Some(ParameterType::Generic(group)) = own(place) else { return None };
    let same =
        given.iter().enumerate().filter(|(other, _)| own(*other) == own(place)).map(|(_, given)| given);
    let (literals, typed): (Vec<&Given>, Vec<&Given>) = same.partition(|given| given.is_free());
    let widest = |all: &[&Given]| {
        let wider = |one: ElementaryType, other| if one.widens_to(other) { other } else { one };
        all.iter().map(|given| given.kind).reduce(wider)
    };
    let holds =
        |kind: &ElementaryType| group.contains(*kind) && literals.iter().all(|given| given.takes(*kind));
    widest(&typed)
        .or_else(|| expected.filter(holds))
        .or_else(|| widest(&literals).filter(holds))
        .or_else(|| group.members().find(holds))
}
