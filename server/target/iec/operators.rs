//! The operators of Instruction List (IEC 61131-3 2nd ed. table 52, 3rd ed. table 68).

use super::page::Page;
use super::{ElementaryType, GenericType};
use crate::text::{self, Book, Language};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

mod calculation;
mod flow;
mod logic;

/// One operator.
#[derive(Debug)]
pub struct Operator {
    /// Upper case: `LD`, `AND`, `&`.
    pub name: &'static str,
    /// A few words.
    pub title: &'static str,
    /// Which modifiers it takes.
    pub modifiers: Modifiers,
    /// What it does to the current result.
    pub role: OperatorRole,
    /// What its operand and the current result may be; nothing for those without a value (NOT has no operand, but
    /// a current result; JMP, CAL and RET name something else).
    pub operand: Option<GenericType>,
    pub(super) page: Page,
}

/// An operator as it is written in one word: `ANDN`, `JMPCN`, `&`. The `(` is a token of its own.
#[derive(Clone, Copy, Debug)]
pub struct Written {
    /// The row.
    pub operator: &'static Operator,
    /// With `N` as a negation: `LDN`, `ORN`.
    pub negate: bool,
    /// With `C`: `Some(true)`, with `CN`: `Some(false)`; the value that the current result must have.
    pub condition: Option<bool>,
}

/// The modifiers that an operator takes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Modifiers {
    /// `N`, negation of the operand (`LDN`).
    pub negate: bool,
    /// `(`, evaluation deferred to `)`.
    pub defer: bool,
    /// `C` and `CN`, execution if the current result is 1 or 0.
    pub condition: bool,
}

/// What an operator does to the current result.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum OperatorRole {
    /// LD: makes a current result.
    Load,
    /// ST: stores it.
    Store,
    /// S, R: set and reset, driven by it.
    Latch {
        /// S.
        on: bool,
    },
    /// AND, ADD, GT …: combines it with the operand; `comparison` makes it BOOL.
    Combine {
        /// GT GE EQ NE LE LT.
        comparison: bool,
    },
    /// NOT: changes it.
    Complement,
    /// JMP.
    Jump,
    /// CAL.
    Call,
    /// RET.
    Return,
}

impl Operator {
    /// Every operator, in the order of the standard's table.
    pub fn all() -> impl Iterator<Item = &'static Operator> {
        [logic::ROWS, calculation::ROWS, flow::ROWS].into_iter().flatten()
    }

    /// The operator called `name` without modifiers, letter case aside.
    pub fn named(name: &str) -> Option<&'static Operator> {
        Operator::written(name)
            .filter(|written| !written.negate && written.condition.is_none())
            .map(|written| written.operator)
    }

    /// The operator that `word` is, with its modifiers, letter case aside.
    ///
    /// ```
    /// use rungwise::target::iec::Operator;
    /// let written = Operator::written("jmpcn").unwrap();
    /// assert_eq!((written.operator.name, written.condition), ("JMP", Some(false)));
    /// assert!(Operator::written("STC").is_none());
    /// ```
    pub fn written(word: &str) -> Option<Written> {
        super::folded(word, |word| WRITTEN.get(word).copied())
    }

    /// Every operator with every modifier that is a part of its word: `LD`, `LDN`, `ST` …
    pub fn all_written() -> impl Iterator<Item = Written> {
        Operator::all().flat_map(|operator| {
            let Modifiers { negate, condition, .. } = operator.modifiers;
            let plain = Written { operator, negate: false, condition: None };
            [
                Some(plain),
                negate.then_some(Written { negate: true, ..plain }),
                condition.then_some(Written { condition: Some(true), ..plain }),
                condition.then_some(Written { condition: Some(false), ..plain }),
            ]
            .into_iter()
            .flatten()
        })
    }

    /// The words of [`Operator::all_written`], in no order.
    pub fn all_words() -> impl Iterator<Item = &'static str> {
        WRITTEN.keys().map(String::as_str)
    }

    /// The type of the current result after this operator met a current result of type `current` and an operand of
    /// type `operand`; nothing if it takes no such pair.
    ///
    /// The types must be the same, except for the arithmetic of times (2nd ed. table 30, 3rd ed. table 35). With
    /// `widening` the third edition's implicit conversions apply and the wider type wins.
    pub fn combine(
        &self,
        current: ElementaryType,
        operand: ElementaryType,
        widening: bool,
    ) -> Option<ElementaryType> {
        let OperatorRole::Combine { comparison } = self.role else { return None };
        let group = self.operand?;
        let common = match () {
            () if current == operand => Some(current),
            () if widening && current.widens_to(operand) => Some(operand),
            () if widening && operand.widens_to(current) => Some(current),
            () => None,
        };
        match common.filter(|kind| group.contains(*kind)) {
            Some(_) if comparison => Some(ElementaryType::Bool),
            // A product of two times is no time.
            Some(kind) if !matches!(self.name, "MUL" | "DIV") || kind.belongs_to(GenericType::AnyNum) => {
                Some(kind)
            }
            _ => calculation::time_arithmetic(self.name, current, operand),
        }
    }

    /// The page: Markdown, one paragraph and a complete `il` program.
    pub fn page(&self) -> String {
        self.page_in(Language::English)
    }

    /// The page in `language`; the program is the same in all of them.
    pub fn page_in(&self, language: Language) -> String {
        text::page(Book::Operators, self.name, &self.page.markdown(), language).into_owned()
    }

    /// The title in `language`.
    pub fn title_in(&self, language: Language) -> &'static str {
        text::phrase(self.title, language)
    }
}

impl Written {
    /// As it is written: `LDN`, `JMPCN`.
    pub fn word(self) -> String {
        let condition = match self.condition {
            Some(true) => "C",
            Some(false) => "CN",
            None => "",
        };
        format!("{}{}{condition}", self.operator.name, if self.negate { "N" } else { "" })
    }
}

static WRITTEN: LazyLock<FxHashMap<String, Written>> =
    LazyLock::new(|| Operator::all_written().map(|written| (written.word(), written)).collect());
