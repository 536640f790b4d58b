//! Reads equations: `Y0 = (X0 + Y0)*[X1]`, `Y0 = (X0 ∨ Y0) ∧ ¬X1`, and both mixed.
//!
//! Grammar, a line each; comments are those of an instruction list: `;` and `//` to the end of the line, `(* … *)`.
//!
//! ```text
//! equation = left [ "=" sum ] ;  left = [mnemonic] operand… | "[" device "]" | "¬" device | label ":"
//! sum      = product { ("+" | "∨" | "|") product }
//! product  = factor { ("*" | "∧" | "·" | "&") factor }
//! factor   = "(" sum ")" | "(" operand compare operand ")" | "[" sum "]" | ("¬" | "!") factor
//!          | ("↑" | "↓") device | ("R_EDGE" | "F_EDGE") "(" device ")" | "0" | "1" | device
//! ```

use super::to_fx;
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test};
use crate::target::{Form, Operand, Target};
use crate::text::{Diagnostic, Message, Span};

/// Equations with the comments and labels before them.
#[derive(Clone, PartialEq, Debug)]
pub struct Equation {
    /// Comments and labels on lines of their own, as they stand in an instruction list.
    pub head: Vec<String>,
    /// Where it stands.
    pub span: Span,
    /// What it says; nothing for what stands behind the last equation.
    pub path: Option<Path>,
}

/// What equations say, and what could not be read.
pub fn read(text: &str, target: &Target) -> (Vec<Equation>, Vec<Diagnostic>) {
    let mut equations = Vec::new();
    let mut problems = Vec::new();
    let mut head = Vec::new();
    let mut start = 0;
    let (alone, comments) = without_comments(text);
    let mut comments = comments.into_iter().peekable();
    for line in alone.split_inclusive('\n') {
        let content = line.trim_end();
        while let Some((at, comment)) = comments.next_if(|(at, _)| *at < start + line.len()) {
            if comment.starts_with("(*") && !comment.ends_with("*)") {
                let opener = Span::new(at, at + 2);
                let message = Message::new("fx-syntax.unclosed-comment");
                problems.push(Diagnostic::new("unclosed-comment", opener, message));
            }
            head.push(comment.to_string());
        }
        let mut reader = Reader { text: content, at: 0, start, target, depth: 0 };
        match reader.line() {
            Ok(None) => {}
            Ok(Some(Line::Label(label))) => head.push(label),
            Ok(Some(Line::Path(path))) => equations.push(Equation {
                head: std::mem::take(&mut head),
                span: Span::new(start, start + content.len()),
                path: Some(path),
            }),
            Err(problem) => problems.push(problem),
        }
        start += line.len();
    }
    if !head.is_empty() {
        equations.push(Equation { head, span: Span::at(text.len()), path: None });
    }
    (equations, problems)
}

/// The text with blanks in the place of its comments, and these with where they start.
fn without_comments(text: &str) -> (String, Vec<(usize, &str)>) {
    let (mut alone, mut comments) = (String::with_capacity(text.len()), Vec::new());
    let mut at = 0;
    while let Some(start) = next_comment(&text[at..]).map(|start| at + start) {
        let comment = &text[start..];
        let length = match comment.starts_with("(*") {
            true => comment[2..].find("*)").map_or(comment.len(), |end| 2 + end + 2),
            false => comment.find('\n').unwrap_or(comment.len()),
        };
        let comment = comment[..length].trim_end();
        comments.push((start, comment));
        alone.push_str(&text[at..start]);
        // Line ends stay, so that lines and offsets do.
        alone.extend(comment.bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
        at = start + comment.len();
    }
    alone.push_str(&text[at..]);
    (alone, comments)
}

/// Where the first comment of `text` starts.
fn next_comment(text: &str) -> Option<usize> {
    let pairs = text.bytes().zip(text.bytes().skip(1).chain([b'\n']));
    pairs
        .enumerate()
        .find_map(|(at, pair)| matches!(pair, (b';', _) | (b'/', b'/') | (b'(', b'*')).then_some(at))
}

/// The instruction list that equations stand for, or what could not be read or written of them.
pub fn list(text: &str, target: &Target) -> Result<String, Vec<Diagnostic>> {
    let (equations, mut problems) = read(text, target);
    let mut list = String::new();
    for equation in &equations {
        for line in &equation.head {
            list.push_str(line);
            list.push('\n');
        }
        let Some(path) = &equation.path else { continue };
        match to_fx::lines(path, target) {
            Ok(lines) => lines.iter().for_each(|line| list.push_str(&format!("{line}\n"))),
            Err(reason) => problems.push(Diagnostic::new("syntax-error", equation.span, reason)),
        }
    }
    if problems.is_empty() { Ok(list) } else { Err(problems) }
}

enum Line {
    Label(String),
    Path(Path),
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    /// Where the line starts.
    start: usize,
    target: &'a Target,
    depth: usize,
}

type Read<T> = Result<T, Diagnostic>;

impl<'a> Reader<'a> {
    fn line(&mut self) -> Read<Option<Line>> {
        self.blanks();
        if self.rest().is_empty() {
            return Ok(None);
        }
        if let Some(label) = self.text.trim().strip_suffix(':') {
            return Ok(Some(Line::Label(label.to_uppercase())));
        }
        let action = self.left()?;
        let mut path = Path::of_action(action);
        if self.take("=") {
            path.gates.push(Gate::Pass(self.sum()?));
            self.blanks();
            if !self.rest().is_empty() {
                return Err(self.problem("boolean.operator"));
            }
        } else if !matches!(&path.drives[..], [Drive::Action(action)] if action.deed.stands_alone()) {
            return Err(self.problem("boolean.equals"));
        }
        Ok(Some(Line::Path(path)))
    }

    /// What is driven: a device, perhaps inverted or with a preset, or an instruction with its operands.
    fn left(&mut self) -> Read<Action> {
        let start = self.at;
        let inverted = if self.take("[") { Some("]") } else { self.take("¬").then_some("") };
        let first = self.word()?;
        let form = Form::named(first).filter(|_| inverted.is_none());
        // Where a program of IEC 61131-3 goes on is no instruction of the FX family.
        let is_iec = !self.target.is_fx() && inverted.is_none();
        let leaves = match first {
            _ if !is_iec => None,
            "JMP" => Some(Deed::Jump),
            "RET" => Some(Deed::Return),
            _ => None,
        };
        let mut terms = Vec::new();
        if form.is_none() && leaves.is_none() {
            terms.push(self.term(first));
        }
        if let Some(close) = inverted {
            if !close.is_empty() && !self.take(close) {
                return Err(self.problem("boolean.bracket"));
            }
        } else {
            while !self.is_at("=") && !self.rest().trim().is_empty() {
                let word = self.word()?;
                terms.push(self.term(word));
            }
        }
        let deed = match (leaves, form) {
            (Some(leaves), _) => leaves,
            (None, Some(form)) => Deed::of_form(form),
            (None, None) if inverted.is_some() => Deed::Coil(CoilKind::Negated),
            (None, None) => Deed::Coil(CoilKind::Plain),
        };
        let span = Span::new(self.start + start, self.start + self.at);
        if let Some(term) = terms.iter().find(|term| matches!(term.operand, Operand::Invalid(_))) {
            return Err(Diagnostic::new("syntax-error", term.span, Message::new("boolean.operand")));
        }
        Ok(Action { deed, terms, span })
    }

    fn sum(&mut self) -> Read<Expression> {
        let mut sum = self.product()?;
        while self.take("+") || self.take("∨") || self.take("|") {
            sum.or_with(self.product()?);
        }
        Ok(sum)
    }

    fn product(&mut self) -> Read<Expression> {
        let mut product = self.factor()?;
        while self.take("*") || self.take("∧") || self.take("·") || self.take("&") {
            product.and_with(self.factor()?);
        }
        Ok(product)
    }

    fn factor(&mut self) -> Read<Expression> {
        self.depth += 1;
        if self.depth > Expression::DEPTH_MAX {
            return Err(self.problem("boolean.depth"));
        }
        let factor = self.factor_within();
        self.depth -= 1;
        factor
    }

    fn factor_within(&mut self) -> Read<Expression> {
        self.blanks();
        if self.take("¬") || self.take("!") {
            return Ok(inverse(self.factor()?));
        }
        if self.take("↑") {
            return self.contact(Test::Bit(ContactKind::Rising));
        }
        if self.take("↓") {
            return self.contact(Test::Bit(ContactKind::Falling));
        }
        if self.take("[") {
            let inside = self.sum()?;
            return if self.take("]") { Ok(inverse(inside)) } else { Err(self.problem("boolean.bracket")) };
        }
        if self.take("(") {
            if let Some(compare) = self.compare()? {
                return Ok(compare);
            }
            let inside = self.sum()?;
            return if self.take(")") { Ok(inside) } else { Err(self.problem("boolean.parenthesis")) };
        }
        for (word, kind) in [("R_EDGE(", ContactKind::Rising), ("F_EDGE(", ContactKind::Falling)] {
            if self.take(word) {
                let contact = self.contact(Test::Bit(kind))?;
                return if self.take(")") { Ok(contact) } else { Err(self.problem("boolean.parenthesis")) };
            }
        }
        match self.rest().split(|c: char| !c.is_alphanumeric()).next() {
            Some("0") => self.constant(false),
            Some("1") => self.constant(true),
            _ => self.contact(Test::Bit(ContactKind::NormallyOpen)),
        }
    }

    fn constant(&mut self, value: bool) -> Read<Expression> {
        self.at += 1;
        Ok(Expression::Constant(value))
    }

    fn contact(&mut self, test: Test) -> Read<Expression> {
        let word = self.word()?;
        let term = self.term(word);
        if matches!(term.operand, Operand::Invalid(_)) {
            return Err(Diagnostic::new("syntax-error", term.span, Message::new("boolean.operand")));
        }
        let span = term.span;
        Ok(Expression::Contact(Contact { test, terms: vec![term], span }))
    }

    /// `D0 >= K10)`, if that is what stands here.
    fn compare(&mut self) -> Read<Option<Expression>> {
        let before = self.at;
        let Ok(left) = self.word() else {
            self.at = before;
            return Ok(None);
        };
        self.blanks();
        let operators = CompareOperator::ALL.into_iter().map(|operator| {
            let wide = if operator.is_wide() { "D" } else { "" };
            (format!("{wide}{}", operator.sign()), operator)
        });
        // `>=` before `>`.
        let found = operators.filter(|(sign, _)| self.rest().starts_with(sign.as_str()));
        let Some((sign, operator)) = found.max_by_key(|(sign, _)| sign.len()) else {
            self.at = before;
            return Ok(None);
        };
        self.at += sign.len();
        let right = self.word()?;
        let terms = vec![self.term(left), self.term(right)];
        let span = terms[0].span.to(terms[1].span);
        if !self.take(")") {
            return Err(self.problem("boolean.parenthesis"));
        }
        Ok(Some(Expression::Contact(Contact { test: Test::Compare(operator), terms, span })))
    }

    /// A word, behind blanks.
    fn word(&mut self) -> Read<&'a str> {
        self.blanks();
        let rest = &self.text[self.at..];
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '%' | '#' | '$' | '-');
        let length = rest.find(|c: char| !is_part(c)).unwrap_or(rest.len());
        // `LD>=` and its kin never stand on the left, so a sign ends a word.
        if length == 0 {
            return Err(self.problem("boolean.operand"));
        }
        self.at += length;
        Ok(&rest[..length])
    }

    /// The operand that `word`, a piece of the line, is.
    fn term(&self, word: &str) -> Term {
        let start = self.start + (word.as_ptr() as usize - self.text.as_ptr() as usize);
        Term::new(self.target.read(word), word, Span::new(start, start + word.len()))
    }

    fn take(&mut self, sign: &str) -> bool {
        self.blanks();
        let found = self.rest().get(..sign.len()).is_some_and(|word| word.eq_ignore_ascii_case(sign));
        self.at += if found { sign.len() } else { 0 };
        found
    }

    fn is_at(&mut self, sign: &str) -> bool {
        self.blanks();
        self.rest().starts_with(sign)
    }

    fn blanks(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn problem(&self, key: &'static str) -> Diagnostic {
        let rest = self.rest();
        let length = rest.chars().next().map_or(0, char::len_utf8);
        let start = self.start + self.at;
        Diagnostic::new("syntax-error", Span::new(start, start + length), Message::new(key))
    }
}

/// What is inverted: of a contact the opposite one, so that `[X1]` is a normally closed contact.
fn inverse(expression: Expression) -> Expression {
    match expression {
        Expression::Contact(contact) if contact.test == Test::Bit(ContactKind::NormallyOpen) => {
            let test = Test::Bit(ContactKind::NormallyClosed);
            Expression::Contact(Contact { test, ..contact })
        }
        expression => Expression::Not(Box::new(expression)),
    }
}
