//! The standard functions (IEC 61131-3 2nd ed. 2.5.1.5, 3rd ed. 6.6.2.5); the order of inputs matters for
//! non-formal calls, in which the current result is the first input.

use super::conversions::{self, Conversion};
use super::page::Page;
use super::{ElementaryType, Formula, GenericType};
use crate::text::{Book, Language, page as translated, phrase};
use rustc_hash::FxHashMap;
use std::borrow::Cow;
use std::sync::LazyLock;

mod bits;
mod comparison;
mod numeric;
mod selection;
mod text;
mod time;

/// One standard function.
#[derive(Debug)]
pub struct Function {
    /// Upper case: `LIMIT`. Conversions have one row for each pair, made from a pattern.
    pub name: &'static str,
    /// A few words.
    pub title: &'static str,
    /// The inputs in the order of the declaration.
    pub inputs: &'static [Parameter],
    /// Whether the last input may be repeated (`ADD(IN1, IN2, IN3 …)`).
    pub extensible: bool,
    /// The result.
    pub result: ParameterType,
    /// What it makes of its inputs.
    pub formula: Formula,
    pub(super) page: FunctionPage,
}

/// Where the page of a function comes from.
#[derive(Debug)]
pub(super) enum FunctionPage {
    /// Written out.
    Own(Page),
    /// The pattern of conversions, filled with its types.
    Conversion(Conversion),
}

/// An input or output of a function or a function block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Parameter {
    /// Upper case.
    pub name: &'static str,
    /// The type.
    pub kind: ParameterType,
    /// A few words for hover and signature help.
    pub meaning: &'static str,
}

/// The input that every function and block has besides its own: while it is 0 the call does nothing. In Instruction
/// List it stands in lists of named parameters only.
pub const EN: Parameter = Parameter::of("EN", ElementaryType::Bool, "enable");

/// The output that every function and block has besides its own: 1 if the call was made and went well.
pub const ENO: Parameter = Parameter::of("ENO", ElementaryType::Bool, "enabled and without error");

/// The type of a parameter.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ParameterType {
    /// This one.
    Elementary(ElementaryType),
    /// Any of the group; all parameters of a function with the same group have the same type.
    Generic(GenericType),
}

impl Function {
    /// Every function: the written ones in the order of the standard's tables, then the conversions.
    pub fn all() -> impl Iterator<Item = &'static Function> {
        Function::families().chain(conversions::all())
    }

    /// Every function that is not a conversion from one type to another.
    pub fn families() -> impl Iterator<Item = &'static Function> {
        [numeric::ROWS, bits::ROWS, selection::ROWS, comparison::ROWS, text::ROWS, time::ROWS]
            .into_iter()
            .flatten()
    }

    /// The function called `name`, letter case aside; types in the names of conversions in their short or long form.
    ///
    /// ```
    /// use rungwise::target::iec::Function;
    /// assert_eq!(Function::named("Limit").map(|f| f.inputs.len()), Some(3));
    /// assert_eq!(Function::named("date_and_time_to_date").map(|f| f.name), Some("DT_TO_DATE"));
    /// ```
    pub fn named(name: &str) -> Option<&'static Function> {
        let family = super::folded(name, |name| BY_NAME.get(name).copied());
        family.or_else(|| conversions::named(name))
    }

    /// The input at `position` of a call, from 0; the last one again and again if the function is extensible,
    /// under the number that it then has (`IN3`).
    pub fn input(&self, position: usize) -> Option<&'static Parameter> {
        match self.inputs.get(position) {
            None if self.extensible => self.inputs.last(),
            input => input,
        }
    }

    /// The input called `name`, letter case aside; for extensible functions also `IN3`, `IN4` and so on.
    pub fn input_named(&self, name: &str) -> Option<&'static Parameter> {
        let declared = self.inputs.iter().find(|input| input.name.eq_ignore_ascii_case(name));
        if declared.is_some() || !self.extensible {
            return declared;
        }
        let last = self.inputs.last()?;
        let stem = last.name.trim_end_matches(|c: char| c.is_ascii_digit());
        let (head, number) = name.split_at_checked(stem.len())?;
        // Every number below those declared is declared itself, but for 0 where the count starts at 1.
        let counts =
            !number.is_empty() && !number.starts_with('0') && number.bytes().all(|b| b.is_ascii_digit());
        (counts && head.eq_ignore_ascii_case(stem)).then_some(last)
    }

    /// The page: Markdown, one paragraph and a complete `il` program.
    pub fn page(&self) -> String {
        self.page_in(Language::English)
    }

    /// The page in `language`; the program is the same in all of them.
    pub fn page_in(&self, language: Language) -> String {
        match &self.page {
            FunctionPage::Own(page) => {
                translated(Book::Functions, self.name, &page.markdown(), language).into_owned()
            }
            FunctionPage::Conversion(conversion) => conversion.page(self.name, language),
        }
    }

    /// The title in `language`.
    pub fn title_in(&self, language: Language) -> Cow<'static, str> {
        match &self.page {
            FunctionPage::Own(_) => Cow::Borrowed(phrase(self.title, language)),
            FunctionPage::Conversion(conversion) => Cow::Owned(conversion.title(language)),
        }
    }
}

impl Parameter {
    /// A parameter of one elementary type.
    pub(super) const fn of(name: &'static str, kind: ElementaryType, meaning: &'static str) -> Parameter {
        Parameter { name, kind: ParameterType::Elementary(kind), meaning }
    }

    /// A parameter of any type of a group.
    pub(super) const fn any(name: &'static str, group: GenericType, meaning: &'static str) -> Parameter {
        Parameter { name, kind: ParameterType::Generic(group), meaning }
    }
}

impl ParameterType {
    /// The keyword: `INT`, `ANY_NUM`.
    pub const fn name(self) -> &'static str {
        match self {
            ParameterType::Elementary(kind) => kind.name(),
            ParameterType::Generic(group) => group.name(),
        }
    }

    /// Whether a value of type `kind` may stand there without a conversion.
    pub fn takes(self, kind: ElementaryType) -> bool {
        match self {
            ParameterType::Elementary(own) => own == kind,
            ParameterType::Generic(group) => group.contains(kind),
        }
    }
}

static BY_NAME: LazyLock<FxHashMap<&'static str, &'static Function>> =
    LazyLock::new(|| Function::families().map(|function| (function.name, function)).collect());
