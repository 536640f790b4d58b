//! Expressions that people ask the debugger for: `D0`, `X0 and not X1`, `T0 >= 5 or (C0 + 1) * 2 = D3`.
//!
//! Operators from the weakest to the strongest: `or`, `xor`, `and`, `not`, comparisons, `+ -`, `* / mod`, `-`. Also the
//! signs of C (`|| ^ && ! == !=`), and `&`. In arithmetic and comparisons a bit is 0 or 1; a number by itself holds
//! where it is not 0.

use crate::simulate::{Code, Value, Variable};
use crate::target::iec::is_identifier;
use crate::text::Message;
use std::cmp::Ordering;

/// Something that has a value.
#[derive(Clone, Debug)]
pub(super) enum Expression {
    Value(Value),
    Variable(Variable),
    Not(Box<Expression>),
    Minus(Box<Expression>),
    Both(Operator, Box<Expression>, Box<Expression>),
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Operator {
    Or,
    Xor,
    And,
    Equal,
    Unequal,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Plus,
    Minus,
    Times,
    Divide,
    Modulo,
}

/// From the weakest to the strongest; from `NOT_AT` on they bind stronger than `not`.
const LEVELS: &[&[(&str, Operator)]] = &[
    &[("or", Operator::Or), ("||", Operator::Or), ("|", Operator::Or)],
    &[("xor", Operator::Xor), ("^", Operator::Xor)],
    &[("and", Operator::And), ("&&", Operator::And), ("&", Operator::And)],
    &[
        ("==", Operator::Equal),
        ("=", Operator::Equal),
        ("<>", Operator::Unequal),
        ("!=", Operator::Unequal),
        ("<=", Operator::LessEqual),
        (">=", Operator::GreaterEqual),
        ("<", Operator::Less),
        (">", Operator::Greater),
    ],
    &[("+", Operator::Plus), ("-", Operator::Minus)],
    &[("*", Operator::Times), ("/", Operator::Divide), ("mod", Operator::Modulo), ("%", Operator::Modulo)],
];
const NOT_AT: usize = 3;
/// Parentheses do not nest deeper.
const MOST_DEPTH: usize = 64;

impl Expression {
    /// Reads an expression about a program.
    ///
    /// # Errors
    /// A sentence that says what is wrong.
    pub(super) fn read(text: &str, code: &Code) -> Result<Expression, Message> {
        let mut reader = Reader { words: words(text), at: 0, code, text, depth: 0 };
        let expression = reader.level(0)?;
        match reader.peek() {
            None => expression.meant(code),
            Some(_) => Err(reader.wrong()),
        }
    }

    /// The same, where words are what they mean beside the variables that they are compared with.
    fn meant(self, code: &Code) -> Result<Expression, Message> {
        let beside = |variable: Variable, value: &Value| {
            let meant = variable.meant(code, value).map(|value| Box::new(Expression::Value(value)));
            meant.ok_or_else(|| Message::new("cli.run-unknown").with("name", value))
        };
        Ok(match self {
            Expression::Both(operator, left, right) => match (&*left, &*right) {
                (Expression::Variable(variable), Expression::Value(value)) => {
                    let right = beside(*variable, value)?;
                    Expression::Both(operator, left, right)
                }
                (Expression::Value(value), Expression::Variable(variable)) => {
                    let left = beside(*variable, value)?;
                    Expression::Both(operator, left, right)
                }
                _ => Expression::Both(operator, Box::new(left.meant(code)?), Box::new(right.meant(code)?)),
            },
            Expression::Not(part) => Expression::Not(Box::new(part.meant(code)?)),
            Expression::Minus(part) => Expression::Minus(Box::new(part.meant(code)?)),
            Expression::Value(Value::Word(_, meant)) => Expression::Value(*meant),
            Expression::Value(Value::Name(name)) if is_identifier(&name) => {
                return Err(Message::new("cli.run-unknown").with("name", name));
            }
            other => other,
        })
    }

    /// Its value, where `of` has those of variables.
    ///
    /// # Errors
    /// Where it divides by zero, or its numbers grow beyond 64 bits.
    pub(super) fn value(&self, of: &impl Fn(Variable) -> Value) -> Result<Value, Message> {
        Ok(match self {
            Expression::Value(value) => value.clone(),
            Expression::Variable(variable) => of(*variable),
            Expression::Not(part) => Value::Bit(!holds(&part.value(of)?)),
            Expression::Minus(part) => {
                let part = part.value(of)?;
                match (number(&part), &part) {
                    (Some(number), _) => number.checked_neg().and_then(whole).ok_or_else(no_result)?,
                    (None, Value::Real(number)) => Value::Real(-number),
                    (None, Value::Time(time)) => Value::Time(-time),
                    _ => return Err(no_result()),
                }
            }
            Expression::Both(operator, left, right) => operator.of(&left.value(of)?, &right.value(of)?)?,
        })
    }
}

/// Whether a condition holds that has this value.
pub(super) fn holds(value: &Value) -> bool {
    match value {
        Value::Bit(on) => *on,
        value => value.as_number().is_some_and(|number| number != 0.0),
    }
}

/// A bit or a whole number.
fn number(value: &Value) -> Option<i128> {
    match value {
        Value::Bit(on) => Some(i128::from(*on)),
        Value::Number(number) => Some(i128::from(*number)),
        Value::Unsigned(number) => Some(i128::from(*number)),
        _ => None,
    }
}

/// A whole number as a value; nothing beyond 64 bits.
fn whole(number: i128) -> Option<Value> {
    let signed = i64::try_from(number).map(Value::Number);
    signed.or_else(|_| u64::try_from(number).map(Value::Unsigned)).ok()
}

fn no_result() -> Message {
    Message::new("debug.no-result")
}

impl Operator {
    fn of(self, left: &Value, right: &Value) -> Result<Value, Message> {
        if let Operator::Or | Operator::Xor | Operator::And = self {
            let (left, right) = (holds(left), holds(right));
            return Ok(Value::Bit(match self {
                Operator::Or => left || right,
                Operator::And => left && right,
                _ => left != right,
            }));
        }
        if self.is_comparison() {
            let order = match (number(left), number(right)) {
                (Some(left), Some(right)) => Some(left.cmp(&right)),
                _ => match (left.as_number(), right.as_number()) {
                    (Some(left), Some(right)) => left.partial_cmp(&right),
                    // Names and texts are the same or not.
                    (None, None) if matches!(self, Operator::Equal | Operator::Unequal) => {
                        return Ok(Value::Bit((left == right) == (self == Operator::Equal)));
                    }
                    _ => return Err(no_result()),
                },
            };
            return Ok(Value::Bit(match self {
                Operator::Equal => order == Some(Ordering::Equal),
                Operator::Unequal => order != Some(Ordering::Equal),
                Operator::Less => order == Some(Ordering::Less),
                Operator::LessEqual => matches!(order, Some(Ordering::Less | Ordering::Equal)),
                Operator::Greater => order == Some(Ordering::Greater),
                _ => matches!(order, Some(Ordering::Greater | Ordering::Equal)),
            }));
        }
        let result = match (number(left), number(right)) {
            (Some(left), Some(right)) => match self {
                Operator::Plus => left.checked_add(right),
                Operator::Minus => left.checked_sub(right),
                Operator::Times => left.checked_mul(right),
                Operator::Divide => left.checked_div(right),
                _ => left.checked_rem(right),
            }
            .and_then(whole),
            _ => self.of_reals(left, right),
        };
        result.ok_or_else(no_result)
    }

    fn is_comparison(self) -> bool {
        use Operator::*;
        matches!(self, Equal | Unequal | Less | LessEqual | Greater | GreaterEqual)
    }

    /// What arithmetic makes of numbers of which one is real.
    fn of_reals(self, left: &Value, right: &Value) -> Option<Value> {
        if matches!(left, Value::Time(_)) || matches!(right, Value::Time(_)) {
            return None;
        }
        let (left, right) = (left.as_number()?, right.as_number()?);
        Some(Value::Real(match self {
            Operator::Plus => left + right,
            Operator::Minus => left - right,
            Operator::Times => left * right,
            Operator::Divide if right != 0.0 => left / right,
            _ => return None,
        }))
    }
}

struct Reader<'a> {
    words: Vec<&'a str>,
    at: usize,
    code: &'a Code,
    text: &'a str,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Option<&'a str> {
        self.words.get(self.at).copied()
    }

    fn wrong(&self) -> Message {
        Message::new("debug.expression").with("text", self.text.trim())
    }

    fn level(&mut self, level: usize) -> Result<Expression, Message> {
        let Some(operators) = LEVELS.get(level) else { return self.part() };
        if level == NOT_AT && self.peek().is_some_and(|word| word == "!" || word.eq_ignore_ascii_case("not"))
        {
            self.at += 1;
            return self.nested(|reader| Ok(Expression::Not(Box::new(reader.level(NOT_AT)?))));
        }
        let mut left = self.level(level + 1)?;
        loop {
            let here = self.peek();
            let operator =
                operators.iter().find(|(word, _)| here.is_some_and(|here| here.eq_ignore_ascii_case(word)));
            let Some((_, operator)) = operator else { return Ok(left) };
            self.at += 1;
            let right = self.level(level + 1)?;
            left = Expression::Both(*operator, Box::new(left), Box::new(right));
        }
    }

    fn nested(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<Expression, Message>,
    ) -> Result<Expression, Message> {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return Err(self.wrong());
        }
        let expression = read(self);
        self.depth -= 1;
        expression
    }

    fn part(&mut self) -> Result<Expression, Message> {
        let word = self.peek().ok_or_else(|| self.wrong())?;
        self.at += 1;
        match word {
            "(" => {
                let inner = self.nested(|reader| reader.level(0))?;
                let is_closed = self.peek() == Some(")");
                self.at += 1;
                if is_closed { Ok(inner) } else { Err(self.wrong()) }
            }
            "-" => self.nested(|reader| Ok(Expression::Minus(Box::new(reader.part()?)))),
            word => {
                // A name before a number: `H1` may be a variable of a program.
                let variable = self.code.variable(word).map(Expression::Variable);
                let known = variable.or_else(|| Value::read(word).map(Expression::Value));
                let is_name = word.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '%');
                known.ok_or_else(|| match is_name {
                    true => Message::new("cli.run-unknown").with("name", word),
                    false => self.wrong(),
                })
            }
        }
    }
}

/// Names, numbers and signs.
fn words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let is_inside =
            |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '#' | ':' | '[' | ']' | '\'');
        let length = match first {
            c if is_inside(c) || c == '%' && rest[1..].starts_with(|c: char| c.is_alphabetic()) => {
                let behind = first.len_utf8();
                behind + rest[behind..].find(|c| !is_inside(c)).unwrap_or(rest.len() - behind)
            }
            _ if ["==", "<>", "!=", "<=", ">=", "&&", "||"].iter().any(|sign| rest.starts_with(sign)) => 2,
            c => c.len_utf8(),
        };
        words.push(&rest[..length]);
        rest = rest[length..].trim_start();
    }
    words
}
