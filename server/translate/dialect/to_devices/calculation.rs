//! Calculations in the instructions of the FX family.

use super::super::Work;
use super::{Converter, Lack, width_of, without};
use crate::ladder::CoilKind;
use crate::logic::{Action, Computation, Conversion, Deed, Drive, Term};
use crate::target::iec::LiteralValue;
use crate::target::{Device, DeviceKind, Form, Operand, Width};
use smol_str::format_smolstr;

impl Converter<'_> {
    /// The instruction that a calculation is.
    pub(super) fn calculation(&self, computation: &Computation, action: &Action) -> Result<Action, Lack> {
        let function = without(computation.standard())?;
        let (inputs, result) = without(computation.operands(&action.terms))?;
        if computation.widens() {
            return self.product(inputs, result, action);
        }
        let width = self.types.width(&action.terms);
        let wide = width == Width::Double;
        let register = self.number(result, width)?;
        without(matches!(register.operand, Operand::Device(_)).then_some(()))?;
        if computation.is_bitwise() {
            self.patterns_fit(computation, inputs, width)?;
        }
        let instruction = |work: Work, terms: Vec<Term>| {
            let form = without(work.form(wide))?;
            Ok(Action { deed: Deed::Instruction(form), terms, span: action.span })
        };
        match (function, inputs) {
            ("MOVE", [zero]) if zero.text == "0" && !wide => {
                let deed = Deed::Coil(CoilKind::Reset);
                return Ok(Action { deed, terms: vec![register], span: action.span });
            }
            ("ADD", [left, one]) if left == result && one.text == "1" => {
                return instruction(Work::Step("ADD"), vec![register]);
            }
            ("SUB", [left, one]) if left == result && one.text == "1" => {
                return instruction(Work::Step("SUB"), vec![register]);
            }
            ("SUB", [zero, right]) if right == result && zero.text == "0" => {
                return instruction(Work::Negate, vec![register]);
            }
            ("MUL", _) => return Err(Lack::Reason("translate.product", function.into())),
            ("DIV" | "MOD", _) => return Err(Lack::Reason("translate.quotient", function.into())),
            _ => {}
        }
        let terms = inputs.iter().map(|term| match computation.is_bitwise() {
            true => self.pattern(term, width),
            false => self.number(term, width),
        });
        let mut terms = terms.collect::<Result<Vec<_>, _>>()?;
        terms.push(register);
        let work = if computation.is_bitwise() { Work::Bits(function) } else { Work::Function(function) };
        instruction(work, terms)
    }

    /// MUL of two words, which makes 32 bits.
    fn product(&self, inputs: &[Term], result: &Term, action: &Action) -> Result<Action, Lack> {
        let product = self.number(result, Width::Double)?;
        without(matches!(product.operand, Operand::Device(_)).then_some(()))?;
        let unsigned = [inputs, std::slice::from_ref(result)].concat();
        if let Some(term) = unsigned.iter().find(|term| !self.types.signed(term)) {
            let kind = self.types.of(term).map_or("", |kind| kind.name());
            return Err(Lack::Order(term.text.clone(), kind));
        }
        let numbers = inputs.iter().map(|term| self.number(term, Width::Word));
        let terms = numbers.chain([Ok(product)]).collect::<Result<Vec<_>, _>>()?;
        let form = without(Work::Multiply.form(false))?;
        Ok(Action { deed: Deed::Instruction(form), terms, span: action.span })
    }

    /// Whether patterns have as many bits as the result: NOT of fewer leaves those before them off.
    fn patterns_fit(&self, computation: &Computation, inputs: &[Term], width: Width) -> Result<(), Lack> {
        if let Conversion::Patterns { wide } = computation.conversion
            && wide != (width == Width::Double)
        {
            return Err(Lack::Unnamed);
        }
        let is_not = inputs.len() == 1;
        let fits = |term: &&Term| match term.operand {
            Operand::Literal(literal) => match literal.named_type {
                Some(kind) => width_of(kind) == Some(width),
                None => !is_not,
            },
            _ => true,
        };
        match inputs.iter().find(|term| !fits(term)) {
            Some(term) => Err(Lack::Word(term.text.clone())),
            None => Ok(()),
        }
    }

    /// A constant as a pattern of bits, or a number.
    fn pattern(&self, term: &Term, width: Width) -> Result<Term, Lack> {
        let most = if width == Width::Double { i128::from(u32::MAX) } else { i128::from(u16::MAX) };
        match term.operand {
            Operand::Literal(literal)
                if let LiteralValue::Integer(value) = literal.value
                    && value >= 0 =>
            {
                without((value <= most).then_some(())).map_err(|lack| lack.named(&term.text))?;
                let text = format_smolstr!("H{value:X}");
                Ok(Term::new(Operand::read(&text, self.target.model), &text, term.span))
            }
            _ => self.number(term, width),
        }
    }

    /// The DIV that a quotient and the remainder behind it are, one done directly after the other: the remainder lies
    /// behind the quotient, and what is done first leaves alone what the other divides.
    pub(super) fn division(&self, drive: &Drive, behind: &[Drive]) -> Option<Action> {
        let (Drive::Action(one), Drive::Action(other)) = (drive, behind.first()?) else { return None };
        let (quotient, remainder) = match (name(one)?, name(other)?) {
            ("DIV", "MOD") => (one, other),
            ("MOD", "DIV") => (other, one),
            _ => return None,
        };
        let ([inputs @ .., quotient], [others @ .., remainder]) = (&quotient.terms[..], &remainder.terms[..])
        else {
            return None;
        };
        let [dividend, divisor] = inputs else { return None };
        let is_safe = match divisor.operand {
            Operand::Literal(literal) => !matches!(literal.value, LiteralValue::Integer(-1 | 0)),
            _ => false,
        };
        let is_signed = inputs.iter().all(|term| self.types.signed(term));
        if inputs != others || !is_safe || !is_signed || inputs.contains(one.terms.last()?) {
            return None;
        }
        let width = self.types.width(&one.terms);
        let number = |term: &Term| self.number(term, width).ok();
        let [first, second] = [number(quotient)?, number(remainder)?];
        let (Operand::Device(own), Operand::Device(next)) = (first.operand, second.operand) else {
            return None;
        };
        let more = if width == Width::Double { 2 } else { 1 };
        if own.kind != DeviceKind::D || next != Device::new(own.kind, own.number + more) {
            return None;
        }
        let terms = vec![number(dividend)?, number(divisor)?, first];
        let form: Form = Work::Divide.form(width == Width::Double)?;
        Some(Action { deed: Deed::Instruction(form), terms, span: one.span.to(other.span) })
    }
}

/// The function of a plain calculation.
fn name(action: &Action) -> Option<&'static str> {
    match &action.deed {
        Deed::Compute(computation) => computation.standard(),
        _ => None,
    }
}
