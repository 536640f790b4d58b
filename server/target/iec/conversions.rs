//! Conversions between types (IEC 61131-3 2nd ed. table 22, 3rd ed. tables 22 to 27), made from the table of types.
//!
//! `*_TO_**` exists for pairs with a meaning: among numbers and bit strings, between those and times or dates,
//! from a date and time to its parts, between the short and long times, and from or to text.

use super::functions::FunctionPage;
use super::{ElementaryType, Function, GenericType, Parameter, ParameterType, page};
use crate::text::Language;
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

mod formulas;

mod words;

/// A conversion, by how it is named.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Conversion {
    /// `INT_TO_REAL`.
    Value(ElementaryType, ElementaryType),
    /// `TO_REAL`, whatever the input is.
    ToValue(ElementaryType),
    /// `REAL_TRUNC_INT`.
    Truncate(ElementaryType, ElementaryType),
    /// `TRUNC_INT`, from either real type.
    ToTruncated(ElementaryType),
    /// `TRUNC`, from either real type to any integer.
    AnyTruncate,
    /// `WORD_BCD_TO_UINT`.
    FromBcd(ElementaryType, ElementaryType),
    /// `BCD_TO_UINT`, from any bit string.
    FromAnyBcd(ElementaryType),
    /// `UINT_TO_BCD_WORD`.
    ToBcd(ElementaryType, ElementaryType),
    /// `TO_BCD_WORD`, from any integer.
    AnyToBcd(ElementaryType),
    /// `UINT_TO_BCD`, to any bit string.
    ToAnyBcd(ElementaryType),
}

use Conversion::*;

/// Every conversion, type by type.
pub fn all() -> impl Iterator<Item = &'static Function> {
    TABLE.rows.iter()
}

/// The conversion called `name`, letter case aside, with types in their short or long form.
pub fn named(name: &str) -> Option<&'static Function> {
    let conversion = parse(name)?;
    TABLE.rows.get(*TABLE.by_conversion.get(&conversion)?)
}

/// What `name` would convert; whether there is such a conversion is for the table to say.
fn parse(name: &str) -> Option<Conversion> {
    type Short = fn(ElementaryType) -> Conversion;
    type Long = fn(ElementaryType, ElementaryType) -> Conversion;
    let kind = ElementaryType::named;
    // The longest name of a conversion has 34 bytes, so `folded` has no room for it.
    let mut buffer = [0u8; 48];
    let upper = buffer.get_mut(..name.len())?;
    upper.copy_from_slice(name.as_bytes());
    upper.make_ascii_uppercase();
    let name = std::str::from_utf8(upper).ok()?;
    if name == "TRUNC" {
        return Some(AnyTruncate);
    }
    let forms: [(&str, Short); 4] =
        [("TO_BCD_", AnyToBcd), ("TRUNC_", ToTruncated), ("BCD_TO_", FromAnyBcd), ("TO_", ToValue)];
    for (prefix, form) in forms {
        if let Some(rest) = name.strip_prefix(prefix) {
            return kind(rest).map(form);
        }
    }
    if let Some(from) = name.strip_suffix("_TO_BCD") {
        return kind(from).map(ToAnyBcd);
    }
    let forms: [(&str, Long); 4] =
        [("_TO_BCD_", ToBcd), ("_BCD_TO_", FromBcd), ("_TRUNC_", Truncate), ("_TO_", Value)];
    for (middle, form) in forms {
        if let Some((from, to)) = name.split_once(middle) {
            return Some(form(kind(from)?, kind(to)?));
        }
    }
    None
}

impl Conversion {
    fn name(self) -> String {
        match self {
            Value(from, to) => format!("{from}_TO_{to}"),
            ToValue(to) => format!("TO_{to}"),
            Truncate(from, to) => format!("{from}_TRUNC_{to}"),
            ToTruncated(to) => format!("TRUNC_{to}"),
            AnyTruncate => "TRUNC".to_string(),
            FromBcd(from, to) => format!("{from}_BCD_TO_{to}"),
            FromAnyBcd(to) => format!("BCD_TO_{to}"),
            ToBcd(from, to) => format!("{from}_TO_BCD_{to}"),
            AnyToBcd(to) => format!("TO_BCD_{to}"),
            ToAnyBcd(from) => format!("{from}_TO_BCD"),
        }
    }

    /// A few words in `language`.
    pub fn title(self, language: Language) -> String {
        words::title(self).render(language)
    }

    fn input(self) -> ParameterType {
        match self {
            Value(from, _) | Truncate(from, _) | FromBcd(from, _) | ToBcd(from, _) | ToAnyBcd(from) => {
                ParameterType::Elementary(from)
            }
            ToValue(_) => ParameterType::Generic(GenericType::AnyElementary),
            ToTruncated(_) | AnyTruncate => ParameterType::Generic(GenericType::AnyReal),
            FromAnyBcd(_) => ParameterType::Generic(GenericType::AnyBit),
            AnyToBcd(_) => ParameterType::Generic(GenericType::AnyInt),
        }
    }

    fn result(self) -> ParameterType {
        match self {
            Value(_, to) | ToValue(to) | Truncate(_, to) | ToTruncated(to) => ParameterType::Elementary(to),
            FromBcd(_, to) | FromAnyBcd(to) | ToBcd(_, to) | AnyToBcd(to) => ParameterType::Elementary(to),
            AnyTruncate => ParameterType::Generic(GenericType::AnyInt),
            ToAnyBcd(_) => ParameterType::Generic(GenericType::AnyBit),
        }
    }

    /// The page of the conversion called `name`, from the pattern that all of them share.
    pub fn page(self, name: &str, language: Language) -> String {
        let input = words::example_input(self);
        let result = words::example_result(self);
        let variables = [
            format!("Source : {input} := {}", words::example_value(self, input)),
            format!("Result : {result}"),
        ];
        let body = ["LD Source".to_string(), name.to_string(), "ST Result".to_string()];
        page::markdown(&words::about(self, language), &variables, &body)
    }

    fn row(self) -> Function {
        // The table lives as long as the process, so its strings may live as long.
        let input = Parameter { name: "IN", kind: self.input(), meaning: "value to be converted" };
        Function {
            name: self.name().leak(),
            title: self.title(Language::English).leak(),
            inputs: Box::leak(Box::new([input])),
            extensible: false,
            result: self.result(),
            formula: self.formula(),
            page: FunctionPage::Conversion(self),
        }
    }
}

/// Whether `from_TO_to` exists.
fn converts(from: ElementaryType, to: ElementaryType) -> bool {
    use ElementaryType::*;
    let is_plain =
        |kind: ElementaryType| kind.belongs_to(GenericType::AnyNum) || kind.belongs_to(GenericType::AnyBit);
    let is_time = |kind: ElementaryType| {
        kind.belongs_to(GenericType::AnyDuration) || kind.belongs_to(GenericType::AnyDate)
    };
    let is_text = |kind: ElementaryType| kind.belongs_to(GenericType::AnyString);
    let is_character = |kind: ElementaryType| kind.belongs_to(GenericType::AnyChar);
    if from == to {
        return false;
    }
    match (from, to) {
        _ if is_text(from) || is_text(to) => true,
        _ if is_character(from) && is_character(to) => true,
        // Characters go to and from bit strings of their own width and wider ones.
        _ if is_character(from) => to.belongs_to(GenericType::AnyBit) && to.bits() >= from.bits(),
        _ if is_character(to) => from.belongs_to(GenericType::AnyBit) && from != Bool,
        _ if is_plain(from) && (is_plain(to) || is_time(to)) => true,
        _ if is_time(from) && is_plain(to) => true,
        (DateAndTime | LdateAndTime, to) => to.belongs_to(GenericType::AnyDate),
        (Time, Ltime) | (Ltime, Time) => true,
        (Date, Ldate) | (Ldate, Date) => true,
        (TimeOfDay, LtimeOfDay) | (LtimeOfDay, TimeOfDay) => true,
        _ => false,
    }
}

/// All conversions that exist.
fn conversions() -> Vec<Conversion> {
    let mut found = Vec::new();
    for from in ElementaryType::ALL {
        found.extend(
            ElementaryType::ALL.into_iter().filter(|to| converts(from, *to)).map(|to| Value(from, to)),
        );
    }
    found.extend(ElementaryType::ALL.map(ToValue));
    found.push(AnyTruncate);
    for to in GenericType::AnyInt.members() {
        found.extend(GenericType::AnyReal.members().map(|from| Truncate(from, to)));
        found.extend([ToTruncated(to), FromAnyBcd(to), ToAnyBcd(to)]);
    }
    // A BOOL has no room for a digit.
    for digits in GenericType::AnyBit.members().filter(|kind| *kind != ElementaryType::Bool) {
        for number in GenericType::AnyUnsigned.members() {
            found.extend([FromBcd(digits, number), ToBcd(number, digits)]);
        }
        found.push(AnyToBcd(digits));
    }
    found
}

struct Table {
    rows: Vec<Function>,
    by_conversion: FxHashMap<Conversion, usize>,
}

static TABLE: LazyLock<Table> = LazyLock::new(|| {
    let conversions = conversions();
    Table {
        rows: conversions.iter().map(|conversion| conversion.row()).collect(),
        by_conversion: conversions.iter().enumerate().map(|(row, conversion)| (*conversion, row)).collect(),
    }
});
