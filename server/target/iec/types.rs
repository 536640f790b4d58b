//! Elementary and generic data types (IEC 61131-3 2nd ed. table 10 and 2.3.2, 3rd ed. table 10 and figure 5).

use rustc_hash::FxHashMap;
use std::fmt;
use std::ops::RangeInclusive;
use std::sync::LazyLock;

/// An elementary type.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
#[allow(missing_docs, reason = "the names are the standard's keywords")]
pub enum ElementaryType {
    Bool,
    Byte,
    Word,
    Dword,
    Lword,
    Sint,
    Int,
    Dint,
    Lint,
    Usint,
    Uint,
    Udint,
    Ulint,
    Real,
    Lreal,
    Time,
    Date,
    TimeOfDay,
    DateAndTime,
    String,
    Wstring,
    // The third edition's additions.
    Ltime,
    Ldate,
    LtimeOfDay,
    LdateAndTime,
    Char,
    Wchar,
}

/// A generic type of the standard's hierarchy, with the third edition's finer groups.
///
/// ```text
/// ANY ─┬─ ANY_DERIVED
///      └─ ANY_ELEMENTARY ─┬─ ANY_MAGNITUDE ─┬─ ANY_NUM ─┬─ ANY_REAL: REAL LREAL
///                         │                 │           └─ ANY_INT ─┬─ ANY_SIGNED: SINT INT DINT LINT
///                         │                 │                       └─ ANY_UNSIGNED: USINT UINT UDINT ULINT
///                         │                 └─ ANY_DURATION: TIME LTIME
///                         ├─ ANY_BIT: BOOL BYTE WORD DWORD LWORD
///                         ├─ ANY_CHARS ─┬─ ANY_STRING: STRING WSTRING
///                         │             └─ ANY_CHAR: CHAR WCHAR
///                         └─ ANY_DATE: DATE TOD DT LDATE LTOD LDT
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs, reason = "the names are the standard's keywords")]
pub enum GenericType {
    Any,
    AnyDerived,
    AnyElementary,
    AnyMagnitude,
    AnyNum,
    AnyReal,
    AnyInt,
    AnySigned,
    AnyUnsigned,
    AnyDuration,
    AnyBit,
    AnyChars,
    AnyString,
    AnyChar,
    AnyDate,
}

use ElementaryType::*;

impl ElementaryType {
    /// All of them, the second edition's first.
    pub const ALL: [ElementaryType; 27] = [
        Bool,
        Byte,
        Word,
        Dword,
        Lword,
        Sint,
        Int,
        Dint,
        Lint,
        Usint,
        Uint,
        Udint,
        Ulint,
        Real,
        Lreal,
        Time,
        Date,
        TimeOfDay,
        DateAndTime,
        String,
        Wstring,
        Ltime,
        Ldate,
        LtimeOfDay,
        LdateAndTime,
        Char,
        Wchar,
    ];

    /// The keyword, in the short form where there are two: `INT`, `TOD`, `DT`.
    pub const fn name(self) -> &'static str {
        match self {
            Bool => "BOOL",
            Byte => "BYTE",
            Word => "WORD",
            Dword => "DWORD",
            Lword => "LWORD",
            Sint => "SINT",
            Int => "INT",
            Dint => "DINT",
            Lint => "LINT",
            Usint => "USINT",
            Uint => "UINT",
            Udint => "UDINT",
            Ulint => "ULINT",
            Real => "REAL",
            Lreal => "LREAL",
            Time => "TIME",
            Date => "DATE",
            TimeOfDay => "TOD",
            DateAndTime => "DT",
            String => "STRING",
            Wstring => "WSTRING",
            Ltime => "LTIME",
            Ldate => "LDATE",
            LtimeOfDay => "LTOD",
            LdateAndTime => "LDT",
            Char => "CHAR",
            Wchar => "WCHAR",
        }
    }

    /// The long keyword of the types that have two: `TIME_OF_DAY` for `TOD`.
    pub const fn long_name(self) -> Option<&'static str> {
        match self {
            TimeOfDay => Some("TIME_OF_DAY"),
            DateAndTime => Some("DATE_AND_TIME"),
            LtimeOfDay => Some("LTIME_OF_DAY"),
            LdateAndTime => Some("LDATE_AND_TIME"),
            _ => None,
        }
    }

    /// The type called `name` in its short or long form, letter case aside.
    ///
    /// ```
    /// use rungwise::target::iec::ElementaryType;
    /// assert_eq!(ElementaryType::named("time_of_day"), Some(ElementaryType::TimeOfDay));
    /// assert_eq!(ElementaryType::named("Tod"), Some(ElementaryType::TimeOfDay));
    /// ```
    pub fn named(name: &str) -> Option<ElementaryType> {
        super::folded(name, |name| BY_NAME.get(name).copied())
    }

    /// The size of a value in bits. Texts, and those types whose size the standard leaves to the implementer
    /// (TIME, DATE, TOD, DT), have none.
    pub const fn bits(self) -> Option<u32> {
        match self {
            Bool => Some(1),
            Byte | Sint | Usint | Char => Some(8),
            Word | Int | Uint | Wchar => Some(16),
            Dword | Dint | Udint | Real => Some(32),
            Lword | Lint | Ulint | Lreal | Ltime | Ldate | LtimeOfDay | LdateAndTime => Some(64),
            Time | Date | TimeOfDay | DateAndTime | String | Wstring => None,
        }
    }

    /// The integers that integer and bit string types hold; nothing for all others.
    pub const fn integers(self) -> Option<RangeInclusive<i128>> {
        let Some(bits) = self.bits() else { return None };
        match self {
            Sint | Int | Dint | Lint => Some(-(1 << (bits - 1))..=(1 << (bits - 1)) - 1),
            Bool | Byte | Word | Dword | Lword | Usint | Uint | Udint | Ulint => Some(0..=(1 << bits) - 1),
            _ => None,
        }
    }

    /// The literal that a variable holds when its declaration gives no initial value.
    ///
    /// The standard gives D#0001-01-01 in its second edition and leaves the third edition's types to the
    /// implementer, who takes 1970-01-01; the character types start at zero.
    pub const fn default_value(self) -> &'static str {
        match self {
            Bool => "FALSE",
            Byte | Word | Dword | Lword => "16#0",
            Sint | Int | Dint | Lint | Usint | Uint | Udint | Ulint => "0",
            Real | Lreal => "0.0",
            Time => "T#0s",
            Ltime => "LT#0s",
            Date => "D#0001-01-01",
            Ldate => "LD#1970-01-01",
            TimeOfDay => "TOD#00:00:00",
            LtimeOfDay => "LTOD#00:00:00",
            DateAndTime => "DT#0001-01-01-00:00:00",
            LdateAndTime => "LDT#1970-01-01-00:00:00",
            String => "''",
            Wstring => "\"\"",
            Char => "'$00'",
            Wchar => "\"$0000\"",
        }
    }

    /// Whether a value of this type may stand where `target` is expected without a conversion function: the same
    /// type, or a widening of the third edition (its figure 11), which keeps the value exactly. The second edition
    /// has no implicit conversion at all.
    pub fn widens_to(self, target: ElementaryType) -> bool {
        if self == target {
            return true;
        }
        match (self, target) {
            (Bool | Byte | Word | Dword, Byte | Word | Dword | Lword) => self.bits() < target.bits(),
            // A mantissa of 24 bits holds 16-bit integers, one of 53 bits those of 32 bits.
            (_, Real) if self.belongs_to(GenericType::AnyInt) => self.bits() <= Some(16),
            (_, Lreal) if self.belongs_to(GenericType::AnyInt) => self.bits() <= Some(32),
            (Real, Lreal) => true,
            (Time, Ltime) | (Date, Ldate) | (TimeOfDay, LtimeOfDay) | (DateAndTime, LdateAndTime) => true,
            (Char, String) | (Wchar, Wstring) => true,
            _ => match (self.integers(), target.integers()) {
                (Some(from), Some(to)) => {
                    self.belongs_to(GenericType::AnyInt)
                        && target.belongs_to(GenericType::AnyInt)
                        && to.contains(from.start())
                        && to.contains(from.end())
                }
                _ => false,
            },
        }
    }

    /// Whether it is a member of `group`.
    pub fn belongs_to(self, group: GenericType) -> bool {
        group.contains(self)
    }
}

impl fmt::Display for ElementaryType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl GenericType {
    /// All of them, wide before narrow.
    pub const ALL: [GenericType; 15] = {
        use GenericType::*;
        [
            Any,
            AnyDerived,
            AnyElementary,
            AnyMagnitude,
            AnyNum,
            AnyReal,
            AnyInt,
            AnySigned,
            AnyUnsigned,
            AnyDuration,
            AnyBit,
            AnyChars,
            AnyString,
            AnyChar,
            AnyDate,
        ]
    };

    /// The keyword: `ANY_NUM`.
    pub const fn name(self) -> &'static str {
        match self {
            GenericType::Any => "ANY",
            GenericType::AnyDerived => "ANY_DERIVED",
            GenericType::AnyElementary => "ANY_ELEMENTARY",
            GenericType::AnyMagnitude => "ANY_MAGNITUDE",
            GenericType::AnyNum => "ANY_NUM",
            GenericType::AnyReal => "ANY_REAL",
            GenericType::AnyInt => "ANY_INT",
            GenericType::AnySigned => "ANY_SIGNED",
            GenericType::AnyUnsigned => "ANY_UNSIGNED",
            GenericType::AnyDuration => "ANY_DURATION",
            GenericType::AnyBit => "ANY_BIT",
            GenericType::AnyChars => "ANY_CHARS",
            GenericType::AnyString => "ANY_STRING",
            GenericType::AnyChar => "ANY_CHAR",
            GenericType::AnyDate => "ANY_DATE",
        }
    }

    /// The group called `name`, letter case aside.
    pub fn named(name: &str) -> Option<GenericType> {
        GenericType::ALL.into_iter().find(|group| group.name().eq_ignore_ascii_case(name))
    }

    /// The group directly above; nothing above ANY.
    pub const fn parent(self) -> Option<GenericType> {
        use GenericType::*;
        match self {
            Any => None,
            AnyDerived | AnyElementary => Some(Any),
            AnyMagnitude | AnyBit | AnyChars | AnyDate => Some(AnyElementary),
            AnyNum | AnyDuration => Some(AnyMagnitude),
            AnyReal | AnyInt => Some(AnyNum),
            AnySigned | AnyUnsigned => Some(AnyInt),
            AnyString | AnyChar => Some(AnyChars),
        }
    }

    /// The narrowest group with `kind` in it.
    pub const fn of(kind: ElementaryType) -> GenericType {
        match kind {
            Bool | Byte | Word | Dword | Lword => GenericType::AnyBit,
            Sint | Int | Dint | Lint => GenericType::AnySigned,
            Usint | Uint | Udint | Ulint => GenericType::AnyUnsigned,
            Real | Lreal => GenericType::AnyReal,
            Time | Ltime => GenericType::AnyDuration,
            Date | TimeOfDay | DateAndTime | Ldate | LtimeOfDay | LdateAndTime => GenericType::AnyDate,
            String | Wstring => GenericType::AnyString,
            Char | Wchar => GenericType::AnyChar,
        }
    }

    /// Whether `kind` is a member, directly or of a group inside.
    pub fn contains(self, kind: ElementaryType) -> bool {
        let mut group = Some(GenericType::of(kind));
        while let Some(inner) = group {
            if inner == self {
                return true;
            }
            group = inner.parent();
        }
        false
    }

    /// The elementary types in it, in the order of [`ElementaryType::ALL`].
    pub fn members(self) -> impl Iterator<Item = ElementaryType> {
        ElementaryType::ALL.into_iter().filter(move |kind| self.contains(*kind))
    }
}

impl fmt::Display for GenericType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

static BY_NAME: LazyLock<FxHashMap<&'static str, ElementaryType>> = LazyLock::new(|| {
    ElementaryType::ALL
        .into_iter()
        .flat_map(|kind| [Some(kind.name()), kind.long_name()].into_iter().flatten().map(move |n| (n, kind)))
        .collect()
});
