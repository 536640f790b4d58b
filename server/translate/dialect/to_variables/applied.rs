//! Applied instructions in the words of IEC 61131-3.

use super::super::Work;
use super::super::registers::is_wide_counter;
use super::{Converter, Lack, constant, literal, without};
use crate::ladder::{CoilKind, CompareOperator};
use crate::logic::{
    Action, Computation, Contact, Conversion, Deed, Drive, Expression, Gate, Path, Term, Test,
};
use crate::target::{Constant, Device, DeviceKind, Form, Operand, Width};
use crate::text::Span;
use smol_str::{ToSmolStr, format_smolstr};

/// So many devices in a row are written one by one.
const ROW_MAX: u32 = 16;

impl Converter<'_> {
    /// What an instruction does while it has power.
    pub(super) fn applied(&self, form: Form, terms: &[Term], span: Span) -> Result<Vec<Drive>, Lack> {
        let work = without(Work::of(form))?;
        let width = if form.wide { Width::Double } else { Width::Word };
        match (work, terms) {
            (Work::Function(function), _) => self.function(function, terms, width, span).map(alone),
            (Work::Step(function), [register]) => {
                let register = self.number(register, width)?;
                let terms = vec![register.clone(), literal("1", span), register];
                self.computed(function, terms, span).map(alone)
            }
            (Work::Negate, [register]) => {
                let register = self.number(register, width)?;
                self.computed("SUB", vec![literal("0", span), register.clone(), register], span).map(alone)
            }
            (Work::Bits(function), _) => self.bits(function, terms, width, span).map(alone),
            (Work::Multiply, [left, right, product]) => {
                if form.wide {
                    return Err(Lack::Reason("translate.wide-product", form.mnemonic().into()));
                }
                let computation =
                    Computation::named("MUL").and_then(|own| own.converted(Conversion::Widened));
                let inputs = [self.number(left, width)?, self.number(right, width)?];
                // Nothing would say of the product of two literals that it has 32 bits.
                let is_literal = |term: &Term| matches!(term.operand, Operand::Literal(_));
                if inputs.iter().all(is_literal) {
                    return Err(Lack::Reason("translate.constant-product", form.mnemonic().into()));
                }
                let terms = inputs.into_iter().chain([self.number(product, Width::Double)?]).collect();
                self.compute(without(computation)?, terms, span).map(alone)
            }
            (Work::Divide, [dividend, divisor, quotient]) => {
                self.division([dividend, divisor, quotient], width, span)
            }
            (Work::Compare, [left, right, relay]) => {
                let [left, right] = [self.number(left, width)?, self.number(right, width)?];
                let test =
                    |operator: fn(bool) -> CompareOperator| compared(&left, operator(false), &right, span);
                let tests = [
                    test(|wide| CompareOperator::Greater { wide }),
                    test(|wide| CompareOperator::Equal { wide }),
                    test(|wide| CompareOperator::Less { wide }),
                ];
                self.told(tests, relay, span)
            }
            (Work::Zone, [lower, upper, number, relay]) => {
                self.zone([lower, upper, number], relay, width, span)
            }
            (Work::Clear, [first, last]) => self.cleared(first, last, span),
            (Work::Fill, [value, first, count]) => self.filled([value, first, count], width, span),
            (Work::Block, [from, to, count]) => self.moved([from, to, count], span),
            _ => Err(Lack::Unnamed),
        }
    }

    /// MOV, ADD, SUB.
    fn function(&self, function: &str, terms: &[Term], width: Width, span: Span) -> Result<Action, Lack> {
        let terms = terms.iter().map(|term| self.number(term, width)).collect::<Result<Vec<_>, _>>();
        let mut terms = terms?;
        let typed = if width == Width::Double { "DINT" } else { "INT" };
        // Plain ones stand for RST, NEG, INC and DEC.
        let is_plain = match &terms[..] {
            [zero, _] => zero.text == "0" && width == Width::Word,
            [zero, right, result] if zero.text == "0" => right == result && function == "SUB",
            [left, one, result] => left == result && one.text == "1",
            _ => false,
        };
        if is_plain {
            let literals = terms.iter_mut().filter(|term| matches!(term.operand, Operand::Literal(_)));
            literals.for_each(|term| *term = literal(&format_smolstr!("{typed}#{}", term.text), term.span));
        }
        self.computed(function, terms, span)
    }

    /// WAND and its kin, of which constants are patterns.
    fn bits(&self, function: &str, terms: &[Term], width: Width, span: Span) -> Result<Action, Lack> {
        let wide = width == Width::Double;
        let conversion = Conversion::Patterns { wide };
        let computation = Computation::named(function).and_then(|own| own.converted(conversion));
        let pattern = |term: &Term| match term.operand {
            Operand::Constant { value, index: None } => {
                let number = constant(value, width).map_err(|lack| lack.named(&term.text))?;
                let text = match wide {
                    true => format_smolstr!("DWORD#16#{:X}", number as u32),
                    false => format_smolstr!("WORD#16#{:X}", number as u16),
                };
                Ok(literal(&text, term.span))
            }
            _ => self.number(term, width),
        };
        let terms = terms.iter().map(pattern).collect::<Result<Vec<_>, _>>()?;
        self.compute(without(computation)?, terms, span)
    }

    /// DIV: the quotient, and behind it the remainder. By what is no number but 0 and -1 both languages divide alike;
    /// else it is an error or leaves the range, and nobody says that they do so alike.
    fn division(&self, terms: [&Term; 3], width: Width, span: Span) -> Result<Vec<Drive>, Lack> {
        let [dividend, divisor, quotient] = terms;
        let is_safe = match divisor.operand {
            Operand::Constant { value, index: None } => !matches!(constant(value, width)?, -1 | 0),
            _ => false,
        };
        let Operand::Device(first) = quotient.operand else {
            return Err(Lack::Unnamed.named(&quotient.text));
        };
        if !is_safe {
            return Err(Lack::Reason("translate.divisor", divisor.text.clone()));
        }
        let inputs = [self.number(dividend, width)?, self.number(divisor, width)?];
        let results = [0, 1].map(|number| self.behind(first, number, width, span));
        let [quotient, remainder] = results;
        let [quotient, remainder] = [quotient?, remainder?];
        // What is written first must not be read again.
        let mut parts = [("DIV", quotient), ("MOD", remainder)];
        if inputs.contains(&parts[0].1) {
            parts.reverse();
        }
        if inputs.contains(&parts[0].1) {
            return Err(Lack::Unnamed);
        }
        let computed = parts.map(|(function, result)| {
            let [dividend, divisor] = inputs.clone();
            self.computed(function, vec![dividend, divisor, result], span).map(Drive::Action)
        });
        computed.into_iter().collect()
    }

    /// The register that is `number` numbers of this width behind the first one.
    fn behind(&self, first: Device, number: u32, width: Width, span: Span) -> Result<Term, Lack> {
        let more = if width == Width::Double { 2 * number } else { number };
        let device = Device::new(first.kind, first.number.saturating_add(more));
        match first.kind {
            DeviceKind::D => self.number(&Term::of_device(device, span), width),
            _ => Err(Lack::Unnamed),
        }
    }

    /// Three relays from the given one on that are on while these hold, and keep what they are without power.
    fn told(&self, tests: [Expression; 3], relay: &Term, span: Span) -> Result<Vec<Drive>, Lack> {
        let Operand::Device(first) = relay.operand else { return Err(Lack::Unnamed.named(&relay.text)) };
        let mut drives = Vec::with_capacity(2 * tests.len());
        for (more, test) in (0..).zip(tests) {
            let device = Device::new(first.kind, first.number.saturating_add(more));
            without(matches!(first.kind, DeviceKind::Y | DeviceKind::M | DeviceKind::S).then_some(()))?;
            let relay = self.bit(&Term::of_device(device, span))?;
            for (kind, test) in [(CoilKind::Set, test.clone()), (CoilKind::Reset, test.negated())] {
                let coil = Action { deed: Deed::Coil(kind), terms: vec![relay.clone()], span };
                let gates = vec![Gate::Pass(test)];
                drives.push(Drive::Path(Path { gates, drives: vec![Drive::Action(coil)] }));
            }
        }
        Ok(drives)
    }

    /// ZCP: below, within, above. Where the lower limit is above the upper one, they are not what they say.
    fn zone(&self, terms: [&Term; 3], relay: &Term, width: Width, span: Span) -> Result<Vec<Drive>, Lack> {
        let limits = [terms[0], terms[1]].map(|limit| match limit.operand {
            Operand::Constant { value, index: None } => constant(value, width).ok(),
            _ => None,
        });
        if !matches!(limits, [Some(lower), Some(upper)] if lower <= upper) {
            return Err(Lack::Reason("translate.zone", terms[0].text.clone()));
        }
        let numbers = terms.map(|term| self.number(term, width));
        let [lower, upper, number] = numbers;
        let [lower, upper, number] = [lower?, upper?, number?];
        let wide = false;
        let test = |operator, limit| compared(&number, operator, limit, span);
        let tests = [
            test(CompareOperator::Less { wide }, &lower),
            Expression::and([
                test(CompareOperator::GreaterOrEqual { wide }, &lower),
                test(CompareOperator::LessOrEqual { wide }, &upper),
            ]),
            test(CompareOperator::Greater { wide }, &upper),
        ];
        self.told(tests, relay, span)
    }

    /// ZRST of a few devices.
    fn cleared(&self, first: &Term, last: &Term, span: Span) -> Result<Vec<Drive>, Lack> {
        let (Operand::Device(first), Operand::Device(last)) = (first.operand, last.operand) else {
            return Err(Lack::Unnamed);
        };
        // RST holds a counter back for as long as it has power, ZRST does not.
        if first.kind == DeviceKind::C {
            let wide = || Lack::Reason("translate.wide-counter", last.to_smolstr());
            return Err(if is_wide_counter(last) { wide() } else { Lack::Unnamed });
        }
        let count = last.number.checked_sub(first.number).map(|more| more + 1);
        let count = without(count.filter(|_| first.kind == last.kind))?;
        few(count)?;
        let mut drives = Vec::new();
        let mut number = first.number;
        while number <= last.number {
            let device = Device::new(first.kind, number);
            let term = Term::of_device(device, span);
            let is_pair =
                first.kind == DeviceKind::D && self.registers.is_pair(number) && number < last.number;
            drives.push(Drive::Action(match is_pair {
                true => {
                    let pair = self.number(&term, Width::Double)?;
                    self.computed("MOVE", vec![literal("0", span), pair], span)?
                }
                false if first.kind == DeviceKind::D && self.registers.is_half(number) => {
                    return Err(Lack::Reason("translate.torn", device.to_smolstr()));
                }
                false => {
                    self.action(&Action { deed: Deed::Coil(CoilKind::Reset), terms: vec![term], span })?
                }
            }));
            number += if is_pair { 2 } else { 1 };
        }
        Ok(drives)
    }

    /// FMOV to a few registers.
    fn filled(&self, terms: [&Term; 3], width: Width, span: Span) -> Result<Vec<Drive>, Lack> {
        let [value, first, count] = terms;
        let Operand::Device(first) = first.operand else { return Err(Lack::Unnamed.named(&first.text)) };
        let results = (0..counted(count)?).map(|number| self.behind(first, number, width, span));
        let results = results.collect::<Result<Vec<_>, _>>()?;
        let mut value = self.number(value, width)?;
        if value.text == "0" && width == Width::Word {
            value = literal("INT#0", value.span);
        }
        let moves =
            results.into_iter().map(|result| self.computed("MOVE", vec![value.clone(), result], span));
        moves.map(|action| action.map(Drive::Action)).collect()
    }

    /// BMOV of a few registers, those first that would be written over.
    fn moved(&self, terms: [&Term; 3], span: Span) -> Result<Vec<Drive>, Lack> {
        let [from, to, count] = terms;
        let (Operand::Device(from), Operand::Device(to)) = (from.operand, to.operand) else {
            return Err(Lack::Unnamed);
        };
        if self.registers.turns_blocks {
            return Err(Lack::Reason("translate.direction", "M8024".into()));
        }
        let mut numbers: Vec<u32> = (0..counted(count)?).collect();
        if to.number > from.number {
            numbers.reverse();
        }
        let word = |first, number| self.behind(first, number, Width::Word, span);
        let moves = numbers.into_iter().map(|number| {
            let terms = vec![word(from, number)?, word(to, number)?];
            self.computed("MOVE", terms, span).map(Drive::Action)
        });
        moves.collect()
    }
}

fn alone(action: Action) -> Vec<Drive> {
    vec![Drive::Action(action)]
}

/// The contact that compares two numbers.
fn compared(left: &Term, operator: CompareOperator, right: &Term, span: Span) -> Expression {
    let terms = vec![left.clone(), right.clone()];
    Expression::Contact(Contact { test: Test::Compare(operator), terms, span })
}

/// The count that a constant says, if it is small.
fn counted(count: &Term) -> Result<u32, Lack> {
    match count.operand {
        Operand::Constant { value: Constant::Decimal(value), index: None } if value > 0 => {
            few(u32::try_from(value).unwrap_or(u32::MAX))
        }
        _ => Err(Lack::Unnamed.named(&count.text)),
    }
}

fn few(count: u32) -> Result<u32, Lack> {
    match count <= ROW_MAX {
        true => Ok(count),
        false => Err(Lack::Reason("translate.row", count.to_smolstr())),
    }
}
