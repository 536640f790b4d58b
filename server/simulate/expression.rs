//! Expressions about the values in a PLC, as people write them for breakpoints, the console of the debugger and alarms:
//! `D0`, `X0 and not X1`, `T0 >= 5 or (C0 + 1) * 2 = D3`.
//!
//! Operators from the weakest to the strongest: `or`, `xor`, `and`, `not`, comparisons, `+ -`, `* / mod`, `-`. Also the
//! signs of C (`|| ^ && ! == !=`), and `&`. In arithmetic and comparisons a bit is 0 or 1; a number by itself holds
//! where it is not 0.

use super::{Code, Value, Variable};
use crate::target::Symbols;
use crate::target::iec::is_identifier;
use crate::text::Message;
use std::cmp::Ordering;

/// Where the names of an expression are looked for.
pub trait Names {
    /// What a name is found to be.
    type Variable: Copy;

    /// What is called so; nothing if nothing is.
    fn variable(&self, name: &str) -> Option<Self::Variable>;

    /// What a word means beside a variable that it is compared with; nothing for a name that says no value of it.
    fn meant(&self, variable: Self::Variable, value: &Value) -> Option<Value>;
}

/// The names of a program, as they are known at one of its instructions, or anywhere.
#[derive(Clone, Copy)]
pub struct NamesOfCode<'a> {
    /// The program.
    pub code: &'a Code,
    /// The number of an instruction, to whose instance or function names may belong.
    pub instruction: Option<u32>,
}

impl Names for NamesOfCode<'_> {
    type Variable = Variable;

    fn variable(&self, name: &str) -> Option<Variable> {
        match self.instruction {
            Some(instruction) => self.code.variable_from(instruction, name),
            None => self.code.variable(name),
        }
    }

    fn meant(&self, variable: Variable, value: &Value) -> Option<Value> {
        variable.meant(self.code, value)
    }
}

/// Names, and what a project calls the devices among them.
#[derive(Clone, Copy)]
pub struct WithSymbols<'a, N> {
    /// Those of devices and variables, which come first.
    pub names: &'a N,
    /// Those that the project gives to devices.
    pub symbols: &'a Symbols,
}

impl<N: Names> Names for WithSymbols<'_, N> {
    type Variable = N::Variable;

    fn variable(&self, name: &str) -> Option<N::Variable> {
        let device = || self.symbols.device(name).map(|device| device.to_string());
        self.names.variable(name).or_else(|| self.names.variable(&device()?))
    }

    fn meant(&self, variable: N::Variable, value: &Value) -> Option<Value> {
        self.names.meant(variable, value)
    }
}

/// Something that has a value.
#[derive(Clone, Debug)]
pub struct Expression<V = Variable>(Node<V>);

#[derive(Clone, Debug)]
enum Node<V> {
    Value(Value),
    Variable(V),
    Not(Box<Node<V>>),
    Minus(Box<Node<V>>),
    Both(Operator, Box<Node<V>>, Box<Node<V>>),
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Operator {
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
/// Operators in a row nest too: each has what stands before it as its left side.
const MOST_OPERATORS: usize = 500;

impl<V: Copy> Expression<V> {
    /// Reads an expression.
    ///
    /// # Errors
    /// A sentence that says what is wrong.
    pub fn read(text: &str, names: &impl Names<Variable = V>) -> Result<Expression<V>, Message> {
        let mut reader = Reader { words: words(text), at: 0, names, text, depth: 0, operators: 0 };
        let node = reader.level(0)?;
        match reader.peek() {
            None => node.meant(names).map(Expression),
            Some(_) => Err(reader.wrong()),
        }
    }

    /// Its value, where `of` has those of variables.
    ///
    /// # Errors
    /// Where it divides by zero, or its numbers grow beyond 64 bits.
    pub fn value(&self, of: &impl Fn(V) -> Value) -> Result<Value, Message> {
        self.0.value(of)
    }

    /// Whether it holds: it is on, or a number other than 0. What has no value does not.
    pub fn holds(&self, of: &impl Fn(V) -> Value) -> bool {
        self.value(of).is_ok_and(|value| holds(&value))
    }

    /// What it reads, in the order in which that stands in it.
    pub fn variables(&self) -> Vec<V> {
        let mut found = Vec::new();
        self.0.collect(&mut found);
        found
    }
}

impl<V: Copy> Node<V> {
    /// The same, where words are what they mean beside the variables that they are compared with.
    fn meant(self, names: &impl Names<Variable = V>) -> Result<Node<V>, Message> {
        let beside = |variable: V, value: &Value| {
            let meant = names.meant(variable, value).map(|value| Box::new(Node::Value(value)));
            meant.ok_or_else(|| Message::new("cli.run-unknown").with("name", value))
        };
        Ok(match self {
            Node::Both(operator, left, right) => match (&*left, &*right) {
                (Node::Variable(variable), Node::Value(value)) => {
                    let right = beside(*variable, value)?;
                    Node::Both(operator, left, right)
                }
                (Node::Value(value), Node::Variable(variable)) => {
                    let left = beside(*variable, value)?;
                    Node::Both(operator, left, right)
                }
                _ => Node::Both(operator, Box::new(left.meant(names)?), Box::new(right.meant(names)?)),
            },
            Node::Not(part) => Node::Not(Box::new(part.meant(names)?)),
            Node::Minus(part) => Node::Minus(Box::new(part.meant(names)?)),
            Node::Value(Value::Word(_, meant)) => Node::Value(*meant),
            Node::Value(Value::Name(name)) if is_identifier(&name) => {
                return Err(Message::new("cli.run-unknown").with("name", name));
            }
            other => other,
        })
    }

    fn value(&self, of: &impl Fn(V) -> Value) -> Result<Value, Message> {
        Ok(match self {
            Node::Value(value) => value.clone(),
            Node::Variable(variable) => of(*variable),
            Node::Not(part) => Value::Bit(!holds(&part.value(of)?)),
            Node::Minus(part) => {
                let part = part.value(of)?;
                let result = match (number(&part), &part) {
                    (Some(number), _) => number.checked_neg().and_then(whole),
                    (None, Value::Real(number)) => Some(Value::Real(-number)),
                    (None, Value::Time(time)) => time.checked_neg().map(Value::Time),
                    _ => None,
                };
                result.ok_or_else(no_result)?
            }
            Node::Both(operator, left, right) => operator.of(&left.value(of)?, &right.value(of)?)?,
        })
    }

    fn collect(&self, found: &mut Vec<V>) {
        match self {
            Node::Value(_) => {}
            Node::Variable(variable) => found.push(*variable),
            Node::Not(part) | Node::Minus(part) => part.collect(found),
            Node::Both(_, left, right) => {
                left.collect(found);
                right.collect(found);
            }
        }
    }
}

/// Whether a condition holds that has this value.
fn holds(value: &Value) -> bool {
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
        if let Some(holds) = self.compared(left, right) {
            return Ok(Value::Bit(holds));
        }
        let result = match (number(left), number(right), left, right) {
            (Some(left), Some(right), ..) => self.of_numbers(left, right).and_then(whole),
            (_, _, Value::Time(left), Value::Time(right)) => self.of_times(*left, *right).map(Value::Time),
            (_, _, Value::Time(_), _) | (_, _, _, Value::Time(_)) => None,
            _ => {
                let both = left.as_number().zip(right.as_number());
                both.and_then(|(left, right)| self.of_reals(left, right)).map(Value::Real)
            }
        };
        result.ok_or_else(no_result)
    }

    /// What a comparison says of two values; nothing for other operators, and where they do not compare.
    fn compared(self, left: &Value, right: &Value) -> Option<bool> {
        let is_equality = matches!(self, Operator::Equal | Operator::Unequal);
        let order = match (number(left), number(right), left, right) {
            (Some(left), Some(right), ..) => Some(left.cmp(&right)),
            (_, _, Value::Time(left), Value::Time(right)) => Some(left.cmp(right)),
            (_, _, Value::Text(left), Value::Text(right)) => Some(left.cmp(right)),
            // Dates and times of day follow each other; values of an enumerated type are the same or not.
            (_, _, Value::Name(left), Value::Name(right)) if is_equality || left.contains('#') => {
                Some(left.cmp(right))
            }
            // What is no number is neither more nor less than anything.
            _ => left.as_number()?.partial_cmp(&right.as_number()?),
        };
        Some(match self {
            Operator::Equal => order.is_some_and(Ordering::is_eq),
            Operator::Unequal => order.is_none_or(Ordering::is_ne),
            Operator::Less => order.is_some_and(Ordering::is_lt),
            Operator::LessEqual => order.is_some_and(Ordering::is_le),
            Operator::Greater => order.is_some_and(Ordering::is_gt),
            Operator::GreaterEqual => order.is_some_and(Ordering::is_ge),
            _ => return None,
        })
    }

    fn of_numbers(self, left: i128, right: i128) -> Option<i128> {
        match self {
            Operator::Plus => left.checked_add(right),
            Operator::Minus => left.checked_sub(right),
            Operator::Times => left.checked_mul(right),
            Operator::Divide => left.checked_div(right),
            Operator::Modulo => left.checked_rem(right),
            _ => None,
        }
    }

    fn of_times(self, left: i64, right: i64) -> Option<i64> {
        match self {
            Operator::Plus => left.checked_add(right),
            Operator::Minus => left.checked_sub(right),
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
}

struct Reader<'a, N> {
    words: Vec<&'a str>,
    at: usize,
    names: &'a N,
    text: &'a str,
    depth: usize,
    operators: usize,
}

impl<'a, N: Names> Reader<'a, N> {
    fn peek(&self) -> Option<&'a str> {
        self.words.get(self.at).copied()
    }

    fn wrong(&self) -> Message {
        Message::new("debug.expression").with("text", self.text.trim())
    }

    fn level(&mut self, level: usize) -> Result<Node<N::Variable>, Message> {
        let Some(operators) = LEVELS.get(level) else { return self.part() };
        if level == NOT_AT && self.peek().is_some_and(|word| word == "!" || word.eq_ignore_ascii_case("not"))
        {
            self.at += 1;
            return self.nested(|reader| Ok(Node::Not(Box::new(reader.level(NOT_AT)?))));
        }
        let mut left = self.level(level + 1)?;
        loop {
            let here = self.peek();
            let operator =
                operators.iter().find(|(word, _)| here.is_some_and(|here| here.eq_ignore_ascii_case(word)));
            let Some((_, operator)) = operator else { return Ok(left) };
            self.at += 1;
            self.operators += 1;
            if self.operators > MOST_OPERATORS {
                return Err(self.wrong());
            }
            let right = self.level(level + 1)?;
            left = Node::Both(*operator, Box::new(left), Box::new(right));
        }
    }

    fn nested(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<Node<N::Variable>, Message>,
    ) -> Result<Node<N::Variable>, Message> {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return Err(self.wrong());
        }
        let expression = read(self);
        self.depth -= 1;
        expression
    }

    fn part(&mut self) -> Result<Node<N::Variable>, Message> {
        let word = self.peek().ok_or_else(|| self.wrong())?;
        self.at += 1;
        match word {
            "(" => {
                let inner = self.nested(|reader| reader.level(0))?;
                let is_closed = self.peek() == Some(")");
                self.at += 1;
                if is_closed { Ok(inner) } else { Err(self.wrong()) }
            }
            "-" => self.nested(|reader| Ok(Node::Minus(Box::new(reader.part()?)))),
            word => {
                // A name before a number: `H1` may be a variable of a program.
                let variable = self.names.variable(word).map(Node::Variable);
                let known = variable.or_else(|| Value::read(word).map(Node::Value));
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
            |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '#' | ':' | '[' | ']' | '\'' | '\\');
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
