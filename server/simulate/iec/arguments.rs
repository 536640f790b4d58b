//! Calls in instruction lists: what is handed over, in which form ever it is written.

use super::compile::is_input;
use super::current::{Current, Given};
use super::kind::{Kind, Record, RecordKind};
use super::list::List;
use super::operand::said;
use super::parts::{Input, Lies};
use super::place::Place as Variable;
use crate::il::iec::{Condition, Direction, ListForm, ParameterValue, PouKind, Run, SectionKind};
use crate::simulate::code::Op;
use crate::simulate::{Cell, Obstacle};
use crate::target::iec::{EN, ENO, Function, Operator, OperatorRole, Parameter};
use crate::text::folded;
use smol_str::SmolStr;

type Outcome = Result<(), Obstacle>;

/// What is handed over in a call.
#[derive(Default)]
pub(super) struct Arguments {
    pub(super) inputs: Vec<(SmolStr, Given)>,
    /// Inputs with parts.
    pub(super) wholes: Vec<(SmolStr, Variable)>,
    pub(super) in_out: Vec<(SmolStr, String)>,
    /// Outputs with the variables that they are written to, and whether inverted.
    pub(super) outputs: Vec<(SmolStr, String, bool)>,
    /// The relay that EN is.
    pub(super) enable: Option<Cell>,
    /// The variable that ENO is written to, and whether inverted.
    pub(super) enabled: Option<(String, bool)>,
}

/// Whether it is EN or ENO, which are no parameters like others, whether they are declared or not.
fn is_enable(name: &str) -> bool {
    [EN.name, ENO.name].iter().any(|own| own.eq_ignore_ascii_case(name))
}

/// Inputs, then outputs, each in the order of the declaration.
fn formals(record: &Record) -> Vec<(SmolStr, SectionKind)> {
    let of = |wanted: fn(SectionKind) -> bool| {
        record
            .fields
            .iter()
            .filter(move |field| wanted(field.section) && !is_enable(&field.name))
            .map(|it| (it.name.clone(), it.section))
    };
    of(is_input).chain(of(|section| section == SectionKind::Output)).collect()
}

/// `IN3` behind `IN2`.
fn numbered(last: &str, place: usize, function: &Function) -> SmolStr {
    let stem = last.trim_end_matches(|c: char| c.is_ascii_digit());
    let number: usize = last[stem.len()..].parse().unwrap_or(0);
    smol_str::format_smolstr!("{stem}{}", number + place + 1 - function.inputs.len())
}

impl List<'_, '_> {
    /// Calls a function block with one input: `CU C10`.
    pub(super) fn input_operator(&mut self, pin: &str, word: &str) -> Outcome {
        let current = self.current.clone();
        let given = self.compiler.given_of(&current).ok_or_else(|| self.no_value())?;
        let variable = self.compiler.variable(word)?;
        let depth = self.depth();
        self.current = self.compiler.kept(current, depth);
        let power = matches!(self.current, Current::Bit).then(|| self.compiler.builder.power());
        let place = self.compiler.builder.here_place();
        let arguments = Arguments { inputs: vec![(pin.into(), given)], ..Arguments::default() };
        self.compiler.called_block(&variable, arguments, place)?;
        if let Some(power) = power {
            self.compiler.builder.set_power(power);
        }
        Ok(())
    }

    /// Parameters of a call: inputs, VAR_IN_OUT and outputs, with the value of EN if one is given.
    fn parameters(
        &mut self,
        at: usize,
        form: ListForm,
        parameters: Run,
        formals: &[(SmolStr, SectionKind)],
    ) -> Result<(Arguments, usize), Obstacle> {
        let mut arguments = Arguments::default();
        let mut lists = at + 1;
        let instruction = self.compiler.builder.instruction();
        for (position, parameter) in parameters.of(self.parameters).iter().enumerate() {
            let name: SmolStr = match (parameter.name, form) {
                (Some(name), _) => name.of(self.text).into(),
                (None, _) => {
                    formals.get(position).map(|(name, _)| name.clone()).ok_or(Obstacle::Unreadable)?
                }
            };
            let section =
                formals.iter().find(|(own, _)| folded(own) == folded(&name)).map(|(_, section)| *section);
            let is = |own: &Parameter| name.eq_ignore_ascii_case(own.name);
            let direction = match parameter.direction {
                Direction::Out { negated } => Some(negated),
                Direction::In if section == Some(SectionKind::Output) => Some(false),
                Direction::In => None,
            };
            match (parameter.value, direction) {
                (ParameterValue::Operand(id), Some(negated)) if is(&ENO) => {
                    arguments.enabled = Some((self.word(id).to_string(), negated));
                }
                (ParameterValue::Operand(id), Some(negated)) => {
                    arguments.outputs.push((name, self.word(id).to_string(), negated));
                }
                (ParameterValue::Operand(id), None) if section == Some(SectionKind::InOut) => {
                    arguments.in_out.push((name, self.word(id).to_string()));
                }
                (ParameterValue::Operand(id), None) => {
                    let word = self.word(id);
                    match is(&EN) {
                        true => arguments.enable = Some(self.compiler.relay(word)?),
                        false => match self.compiler.whole(word)? {
                            Some(variable) => arguments.wholes.push((name, variable)),
                            None => {
                                let given = self.compiler.given(word)?;
                                arguments.inputs.push((name, given));
                            }
                        },
                    }
                }
                (ParameterValue::Instructions, None) => {
                    let close = self.close_of(lists);
                    let inside = lists + 1..close;
                    lists = close + 1;
                    let saved = std::mem::replace(&mut self.current, Current::Nothing);
                    let power = matches!(saved, Current::Bit).then(|| self.compiler.builder.settle());
                    self.compiler.builder.forget_power();
                    self.depth += 1;
                    self.run(inside);
                    self.compiler.builder.again_at(instruction);
                    self.depth -= 1;
                    let value = std::mem::replace(&mut self.current, saved);
                    let given = self.compiler.given_of(&value).ok_or(Obstacle::NoCurrentResult)?;
                    match (is(&EN), &given.input) {
                        (true, Input::At(spot)) => match spot.lies {
                            Lies::Cell(cell) => arguments.enable = Some(cell),
                            _ => return Err(said("simulate.no-bit", EN.name)),
                        },
                        (true, _) => return Err(said("simulate.no-bit", EN.name)),
                        (false, _) => {
                            let given = self.compiler.set_aside(given);
                            arguments.inputs.push((name, given));
                        }
                    }
                    match power {
                        Some(power) => self.compiler.builder.set_power(power),
                        None => self.compiler.builder.forget_power(),
                    }
                }
                _ => return Err(Obstacle::Unreadable),
            }
        }
        Ok((arguments, self.behind(at)))
    }

    pub(super) fn call(
        &mut self,
        at: usize,
        condition: Condition,
        word: &str,
        form: ListForm,
        parameters: Run,
    ) -> Result<usize, Obstacle> {
        let is_function = self.compiler.declared.unit(word, PouKind::Function).is_some() || {
            Function::named(word).is_some() && self.compiler.variable(word).is_err()
        };
        if is_function && condition == Condition::Always {
            let form = if form == ListForm::None { ListForm::Formal } else { form };
            return self.function(at, word, form, parameters);
        }
        let variable = self.compiler.variable(word)?;
        let Kind::Record(record) = variable.kind.clone() else {
            return Err(said("simulate.no-block", word));
        };
        if let RecordKind::Structure = record.what {
            return Err(said("simulate.no-block", word));
        }
        let formals: Vec<(SmolStr, SectionKind)> = formals(&record);
        // What was the current result before is still it behind the call.
        let (current, depth) = (std::mem::replace(&mut self.current, Current::Nothing), self.depth());
        self.current = self.compiler.kept(current, depth);
        let power = matches!(self.current, Current::Bit).then(|| self.compiler.builder.power());
        let skip = match condition {
            Condition::Always => None,
            _ => {
                let on = self.condition(condition)?;
                let off = self.compiler.inverse(on);
                Some(self.compiler.builder.op(Op::Jump { power: off, to: 0 }))
            }
        };
        let (arguments, next) = self.parameters(at, form, parameters, &formals)?;
        let place = self.compiler.builder.here_place();
        self.compiler.called_block(&variable, arguments, place)?;
        if let Some(op) = skip {
            let here = self.compiler.builder.here();
            self.compiler.send(op, here);
        }
        match power {
            Some(power) => self.compiler.builder.set_power(power),
            None => self.compiler.builder.forget_power(),
        }
        Ok(next)
    }

    pub(super) fn function(
        &mut self,
        at: usize,
        word: &str,
        form: ListForm,
        parameters: Run,
    ) -> Result<usize, Obstacle> {
        let first = match form {
            ListForm::None => {
                let current = self.current.clone();
                let given = self.compiler.given_of(&current);
                Some(given.ok_or_else(|| self.no_value())?)
            }
            _ => {
                if self.open.is_empty() && self.depth == 0 {
                    self.compiler.builder.rung();
                }
                self.compiler.builder.forget_power();
                self.current = Current::Nothing;
                None
            }
        };
        let (expected, depth) = (self.expected(at), self.depth());
        if let Some(unit) = self.compiler.declared.unit(word, PouKind::Function) {
            let record = self.compiler.record(unit);
            let mut formals = formals(&record);
            if first.is_some() && formals.is_empty() {
                return Err(said("simulate.operands", word));
            }
            let first = first.map(|given| (formals.remove(0).0, given));
            let (mut arguments, next) = self.parameters(at, form, parameters, &formals)?;
            arguments.inputs.splice(0..0, first);
            let place = self.compiler.builder.here_place();
            let result = self.compiler.called_function(unit, arguments, depth, place)?;
            self.current = match result {
                Some(spot) => self.compiler.current_at(spot),
                None => Current::Nothing,
            };
            return Ok(next);
        }
        let function = Function::named(word).ok_or_else(|| said("simulate.no-function", word))?;
        let formals: Vec<(SmolStr, SectionKind)> = (0..parameters.len() + 1)
            .filter_map(|place| {
                let input = function.input(place)?;
                let numbered =
                    (place >= function.inputs.len()).then(|| numbered(input.name, place, function));
                Some((numbered.unwrap_or_else(|| input.name.into()), SectionKind::Input))
            })
            .collect();
        let own = if first.is_some() { formals.get(1..).unwrap_or_default() } else { &formals[..] };
        let (arguments, next) = self.parameters(at, form, parameters, own)?;
        if !arguments.outputs.is_empty() || !arguments.in_out.is_empty() || !arguments.wholes.is_empty() {
            return Err(said("simulate.operands", word));
        }
        let first = first.map(|given| (formals[0].0.clone(), given));
        let given: Vec<(SmolStr, Given)> = first.into_iter().chain(arguments.inputs).collect();
        let mut in_order = Vec::new();
        let mut rest = given;
        while !rest.is_empty() {
            let name = formals.get(in_order.len()).map(|(name, _)| folded(name));
            let place = rest.iter().position(|(own, _)| Some(folded(own)) == name);
            let (_, value) = rest.remove(place.ok_or_else(|| said("simulate.operands", word))?);
            in_order.push(value);
        }
        let result = self.compiler.applied_enabled(
            function,
            in_order,
            expected,
            depth,
            arguments.enable,
            arguments.enabled,
        )?;
        self.current = self.compiler.current_at(result);
        let operator = Operator::named(function.name).map(|operator| operator.role);
        if let Some(OperatorRole::Combine { comparison: true }) = operator {
            self.holds_now(false);
        }
        Ok(next)
    }
}
