//! Expressions that people ask the debugger for: `D0`, `X0 and not X1`, `T0 >= 5 or (C0 + 1) * 2 = D3`.
//!
//! Operators from the weakest to the strongest: `or`, `xor`, `and`, `not`, comparisons, `+ -`, `* / mod`, `-`. Also the
//! signs of C (`|| ^ && ! == !=`), and `&`. In arithmetic and comparisons a bit is 0 or 1; a number by itself holds
//! where it is not 0.

use crate::simulate::{Code, Value, Variable, joined};
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
    /// Reads an expression about a program; names may be those of the variables of `owner`.
    ///
    /// # Errors
    /// A sentence that says what is wrong.
    pub(super) fn read(text: &str, code: &Code, owner: Option<&str>) -> Result<Expression, Message> {
        let mut reader = Reader { words: words(text), at: 0, code, owner, text, depth: 0 };
        let expression = reader.level(0)?;
        match reader.peek() {
            None => Ok(expression),
            Some(_) => Err(reader.wrong()),
        }
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
            Expression::Minus(part) => Operator::Minus.of(&Value::Number(0), &part.value(of)?)?,
            Expression::Both(operator, left, right) => operator.of(&left.value(of)?, &right.value(of)?)?,
        })
    }
}

/// Whether a condition holds that has this value.
pub(super) fn holds(value: &Value) -> bool {
    match value {
        Value::Bit(on) => *on,
        value => number(value).is_some_and(|number| number != 0),
    }
}

fn number(value: &Value) -> Option<i64> {
    match value {
        Value::Bit(on) => Some(i64::from(*on)),
        Value::Number(number) => Some(*number),
        _ => None,
    }
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
        if let Some(order) = order(left, right)
            && let Some(holds) = self.holds_for(order)
        {
            return Ok(Value::Bit(holds));
        }
        let result = match (left, right) {
            (Value::Real(_), _) | (_, Value::Real(_)) => {
                let both = real(left).zip(real(right));
                both.and_then(|(left, right)| self.of_reals(left, right)).map(Value::Real)
            }
            (Value::Time(left), Value::Time(right)) => self.of_numbers(*left, *right).map(Value::Time),
            // A duration turned round.
            (Value::Number(0), Value::Time(right)) => self.of_numbers(0, *right).map(Value::Time),
            _ => {
                let both = number(left).zip(number(right));
                both.and_then(|(left, right)| self.of_numbers(left, right)).map(Value::Number)
            }
        };
        result.ok_or_else(no_result)
    }

    fn of_numbers(self, left: i64, right: i64) -> Option<i64> {
        match self {
            Operator::Plus => left.checked_add(right),
            Operator::Minus => left.checked_sub(right),
            Operator::Times => left.checked_mul(right),
            Operator::Divide => left.checked_div(right),
            Operator::Modulo => left.checked_rem(right),
            _ => None,
        }
    }

    fn of_reals(self, left: f64, right: f64) -> Option<f64> {
        let result = match self {
            Operator::Plus => left + right,
            Operator::Minus => left - right,
            Operator::Times => left * right,
            Operator::Divide => left / right,
            _ => return None,
        };
        result.is_finite().then_some(result)
    }

    /// Whether a comparison holds for what is ordered so; nothing for other operators.
    fn holds_for(self, order: Ordering) -> Option<bool> {
        Some(match self {
            Operator::Equal => order.is_eq(),
            Operator::Unequal => order.is_ne(),
            Operator::Less => order.is_lt(),
            Operator::LessEqual => order.is_le(),
            Operator::Greater => order.is_gt(),
            Operator::GreaterEqual => order.is_ge(),
            _ => return None,
        })
    }
}

/// How two values compare; nothing if they do not.
fn order(left: &Value, right: &Value) -> Option<Ordering> {
    match (left, right) {
        (Value::Real(_), _) | (_, Value::Real(_)) => real(left)?.partial_cmp(&real(right)?),
        (Value::Time(left), Value::Time(right)) => Some(left.cmp(right)),
        (Value::Text(left) | Value::Name(left), Value::Text(right) | Value::Name(right)) => {
            Some(left.cmp(right))
        }
        (Value::Unsigned(left), Value::Unsigned(right)) => Some(left.cmp(right)),
        _ => Some(number(left)?.cmp(&number(right)?)),
    }
}

fn real(value: &Value) -> Option<f64> {
    match value {
        Value::Real(real) => Some(*real),
        value => number(value).map(|number| number as f64),
    }
}

struct Reader<'a> {
    words: Vec<&'a str>,
    at: usize,
    code: &'a Code,
    owner: Option<&'a str>,
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
                let own = self.owner.and_then(|owner| self.code.variable(&joined(owner, word)));
                let variable = own.or_else(|| self.code.variable(word)).map(Expression::Variable);
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
        let is_inside = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '#' | ':' | '[' | ']');
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
