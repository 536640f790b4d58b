//! IEC 61131-3 as data: types, literals, operands, operators, functions, blocks and their pages.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use proptest::prelude::*;
use rungwise::target::iec::{
    ElementaryType, Function, FunctionBlock, GenericType, KEYWORDS, Literal, LiteralProblem, LiteralValue,
    Operator, OperatorRole, ParameterType, is_identifier, is_keyword,
};
use rungwise::target::{DirectAddress, Location, Model, Operand, OperandProblem, Width};
use std::collections::HashSet;

const SECOND: i64 = 1_000_000_000;

fn value(word: &str) -> LiteralValue {
    Literal::read(word).unwrap_or_else(|problem| panic!("{word}: {problem:?}")).value
}

fn problem(word: &str) -> LiteralProblem {
    Literal::read(word).expect_err(word)
}

/// The word in lower, upper and mixed case.
fn cases(word: &str) -> [String; 3] {
    let mixed = word.chars().enumerate();
    let mixed = mixed.map(|(i, c)| if i % 2 == 0 { c.to_ascii_uppercase() } else { c.to_ascii_lowercase() });
    [word.to_lowercase(), word.to_uppercase(), mixed.collect()]
}

// Types

#[test]
fn types_are_found_by_every_name_in_every_case() {
    let mut names = HashSet::new();
    for kind in ElementaryType::ALL {
        for name in [Some(kind.name()), kind.long_name()].into_iter().flatten() {
            assert!(names.insert(name), "{name} twice");
            assert!(is_keyword(name), "{name}");
            for written in cases(name) {
                assert_eq!(ElementaryType::named(&written), Some(kind), "{written}");
            }
        }
    }
    assert_eq!(names.len(), 27 + 4);
    for group in GenericType::ALL {
        assert_eq!(GenericType::named(&group.name().to_lowercase()), Some(group));
    }
    assert_eq!(ElementaryType::named("INTEGER"), None);
    assert_eq!(ElementaryType::named(&"I".repeat(500)), None);
}

#[test]
fn the_hierarchy_is_the_standards() {
    use GenericType::*;
    let members =
        |group: GenericType| group.members().map(ElementaryType::name).collect::<Vec<_>>().join(" ");
    assert_eq!(members(AnyReal), "REAL LREAL");
    assert_eq!(members(AnyInt), "SINT INT DINT LINT USINT UINT UDINT ULINT");
    assert_eq!(members(AnySigned), "SINT INT DINT LINT");
    assert_eq!(members(AnyUnsigned), "USINT UINT UDINT ULINT");
    assert_eq!(members(AnyNum), "SINT INT DINT LINT USINT UINT UDINT ULINT REAL LREAL");
    assert_eq!(members(AnyDuration), "TIME LTIME");
    assert_eq!(members(AnyMagnitude), "SINT INT DINT LINT USINT UINT UDINT ULINT REAL LREAL TIME LTIME");
    assert_eq!(members(AnyBit), "BOOL BYTE WORD DWORD LWORD");
    assert_eq!(members(AnyString), "STRING WSTRING");
    assert_eq!(members(AnyDate), "DATE TOD DT LDATE LTOD LDT");
    assert_eq!(members(AnyDerived), "");
    assert_eq!(Any.members().count(), 27);
    assert_eq!(AnyElementary.members().count(), 27);
    // The four large groups share no member and leave none out.
    for kind in ElementaryType::ALL {
        let groups = [AnyMagnitude, AnyBit, AnyChars, AnyDate];
        assert_eq!(groups.into_iter().filter(|group| kind.belongs_to(*group)).count(), 1, "{kind}");
    }
}

#[test]
fn integers_have_the_range_of_their_width() {
    let range = |name: &str| ElementaryType::named(name).and_then(ElementaryType::integers);
    assert_eq!(range("SINT"), Some(i8::MIN.into()..=i8::MAX.into()));
    assert_eq!(range("INT"), Some(i16::MIN.into()..=i16::MAX.into()));
    assert_eq!(range("DINT"), Some(i32::MIN.into()..=i32::MAX.into()));
    assert_eq!(range("LINT"), Some(i64::MIN.into()..=i64::MAX.into()));
    assert_eq!(range("USINT"), Some(0..=u8::MAX.into()));
    assert_eq!(range("UINT"), Some(0..=u16::MAX.into()));
    assert_eq!(range("UDINT"), Some(0..=u32::MAX.into()));
    assert_eq!(range("ULINT"), Some(0..=u64::MAX.into()));
    assert_eq!(range("LWORD"), Some(0..=u64::MAX.into()));
    assert_eq!(range("BOOL"), Some(0..=1));
    assert_eq!(range("REAL"), None);
    assert_eq!(range("TIME"), None);
}

#[test]
fn default_values_are_literals_of_their_type() {
    for kind in ElementaryType::ALL {
        let written = kind.default_value();
        let literal =
            Literal::read(written).unwrap_or_else(|problem| panic!("{kind} {written}: {problem:?}"));
        let is_character = kind.belongs_to(GenericType::AnyChar);
        assert!(literal.fits(kind) || is_character, "{kind} {written}");
    }
}

#[test]
fn widening_keeps_every_value() {
    let widens = |from: &str, to: &str| {
        ElementaryType::named(from).unwrap().widens_to(ElementaryType::named(to).unwrap())
    };
    for (from, to) in [
        ("SINT", "INT"),
        ("USINT", "INT"),
        ("UINT", "DINT"),
        ("INT", "REAL"),
        ("DINT", "LREAL"),
        ("REAL", "LREAL"),
        ("BYTE", "WORD"),
        ("BOOL", "LWORD"),
        ("TIME", "LTIME"),
        ("CHAR", "STRING"),
    ] {
        assert!(widens(from, to), "{from} to {to}");
        assert!(!widens(to, from), "{to} to {from}");
    }
    for (from, to) in
        [("INT", "UINT"), ("UINT", "INT"), ("DINT", "REAL"), ("LINT", "LREAL"), ("WORD", "UINT")]
    {
        assert!(!widens(from, to), "{from} to {to}");
    }
    for from in ElementaryType::ALL {
        for to in ElementaryType::ALL.into_iter().filter(|to| from != *to && from.widens_to(*to)) {
            assert!(!to.widens_to(from), "{from} and {to} widen to each other");
            if let (Some(from), Some(to)) = (from.integers(), to.integers()) {
                assert!(to.contains(from.start()) && to.contains(from.end()));
            }
            for third in ElementaryType::ALL.into_iter().filter(|third| to.widens_to(*third)) {
                assert!(from.widens_to(third), "{from} to {to} to {third}");
            }
        }
    }
}

// Names

#[test]
fn identifiers_follow_the_underscore_rule() {
    for good in ["a", "_a", "Motor_1", "A_B_C", "_1", "阀门", "Größe", "x9"] {
        assert!(is_identifier(good), "{good}");
    }
    for bad in ["", "_", "a__b", "__a", "a_", "1a", "a b", "a-b", "a.b", "a$", "%a"] {
        assert!(!is_identifier(bad), "{bad}");
    }
}

#[test]
fn keywords_are_found_in_every_case_once() {
    assert_eq!(KEYWORDS.iter().collect::<HashSet<_>>().len(), KEYWORDS.len());
    for keyword in KEYWORDS {
        assert!(is_identifier(keyword), "{keyword}");
        assert!(cases(keyword).iter().all(|written| is_keyword(written)), "{keyword}");
    }
    for free in ["S", "IN", "LD", "TON", "Motor", "", "PRIORITY", "Interval"] {
        assert!(!is_keyword(free), "{free}");
    }
}

// Numbers

#[test]
fn integers() {
    use LiteralValue::Integer;
    for (word, expected) in [
        ("0", 0),
        ("12", 12),
        ("-12", -12),
        ("+986", 986),
        ("1_000", 1000),
        ("123_456_789", 123_456_789),
        ("2#1111_0000", 0xF0),
        ("8#377", 255),
        ("16#FF", 255),
        ("16#ff", 255),
        ("16#DEAD_beef", 0xDEAD_BEEF),
        ("INT#5", 5),
        ("int#-5", -5),
        ("DINT#+5", 5),
        ("WORD#16#FF", 255),
        ("UINT#2#101", 5),
        ("18446744073709551615", u64::MAX.into()),
    ] {
        assert_eq!(value(word), Integer(expected), "{word}");
    }
    use LiteralProblem::*;
    for (word, expected) in [
        ("2#12", Digit),
        ("8#8", Digit),
        ("16#G", Digit),
        ("12a", Digit),
        ("2#", Digit),
        ("0x1F", Digit),
        ("3#12", Base),
        ("10#12", Base),
        ("02#1", Base),
        ("1__0", Underscore),
        ("1_", Underscore),
        ("16#_F", Underscore),
        ("INT#_5", Underscore),
        ("-16#FF", Sign),
        ("16#-F", Sign),
        ("WORD#-1", Sign),
        ("BOOL#-1", Sign),
        ("-", Form),
        ("", Form),
        ("INT#", Form),
        ("Motor", Form),
        ("#5", Type),
        ("FOO#5", Type),
        ("INT#TRUE", Type),
        ("INT#abc", Type),
        ("INT#1.5", Type),
        ("INT#32768", Range),
        ("INT#-32769", Range),
        ("INT#16#FFFF", Range),
        ("USINT#-1", Range),
        ("BYTE#256", Range),
        ("BOOL#2", Range),
        ("9999999999999999999999999999999999999999999", Range),
    ] {
        assert_eq!(problem(word), expected, "{word}");
    }
}

#[test]
fn every_integer_type_holds_its_ends_and_not_more() {
    for kind in ElementaryType::ALL {
        let Some(range) = kind.integers() else { continue };
        let written = |number: i128| format!("{}#{number}", kind.name().to_lowercase());
        assert!(Literal::read(&written(*range.end())).is_ok(), "{kind}");
        assert!(*range.start() == 0 || Literal::read(&written(*range.start())).is_ok(), "{kind}");
        assert_eq!(problem(&written(range.end() + 1)), LiteralProblem::Range, "{kind}");
        let below = problem(&written(range.start() - 1));
        let bits = kind.belongs_to(GenericType::AnyBit);
        assert_eq!(below, if bits { LiteralProblem::Sign } else { LiteralProblem::Range }, "{kind}");
    }
}

#[test]
fn truth_values() {
    for (word, expected) in [
        ("TRUE", true),
        ("False", false),
        ("BOOL#TRUE", true),
        ("bool#false", false),
        ("BOOL#1", true),
        ("BOOL#0", false),
        ("BOOL#2#1", true),
    ] {
        let literal = Literal::read(word).unwrap();
        assert_eq!(literal.value, LiteralValue::Bool(expected), "{word}");
        assert_eq!(literal.named_type, Some(ElementaryType::Bool), "{word}");
    }
}

#[test]
fn reals() {
    for (word, expected) in [
        ("1.0", 1.0),
        ("-12.0", -12.0),
        ("0.4560", 0.456),
        ("12.345_6", 12.3456),
        ("1.5E-3", 0.0015),
        ("-1.34E-12", -1.34e-12),
        ("1.0e+6", 1e6),
        ("1_000.5", 1000.5),
        ("REAL#2.5", 2.5),
        ("lreal#1.0E300", 1e300),
    ] {
        assert_eq!(value(word), LiteralValue::Real(expected), "{word}");
    }
    use LiteralProblem::*;
    for (word, expected) in [
        ("1e3", RealForm),
        (".5", RealForm),
        ("5.", RealForm),
        ("-.5", RealForm),
        ("1.5E", RealForm),
        ("1.2.3", RealForm),
        ("1.5E1.5", RealForm),
        ("REAL#5", RealForm),
        ("1._5", Underscore),
        ("1.5_", Underscore),
        ("1.x", Digit),
        ("1.5Ex", Digit),
        ("1.0E999", Range),
        ("REAL#1.0E39", Range),
    ] {
        assert_eq!(problem(word), expected, "{word}");
    }
}

#[test]
fn literals_fit_the_types_of_the_second_edition() {
    let fits = |word: &str, kind: ElementaryType| Literal::read(word).unwrap().fits(kind);
    use ElementaryType::*;
    assert!(fits("1", Bool) && fits("0", Bool) && !fits("2", Bool));
    assert!(fits("255", Usint) && !fits("256", Usint) && !fits("-1", Usint) && fits("16#FFFF", Word));
    assert!(fits("1.5", Real) && fits("1.5", Lreal) && !fits("1.5", Int) && !fits("1.0E39", Real));
    assert!(fits("INT#5", Int) && !fits("INT#5", Dint));
    assert!(fits("T#1s", Time) && !fits("T#1s", Ltime) && fits("'a'", String) && !fits("'a'", Wstring));
    let natural = |word: &str| Literal::read(word).unwrap().natural_type();
    assert_eq!(natural("1"), Some(Int));
    assert_eq!(natural("32768"), Some(Dint));
    assert_eq!(natural("3000000000"), Some(Lint));
    assert_eq!(natural("18446744073709551615"), Some(Ulint));
    assert_eq!(natural("99999999999999999999"), None);
    assert_eq!(natural("1.5"), Some(Lreal));
    assert_eq!(natural("WORD#1"), Some(Word));
    assert_eq!(natural("Colour#Red"), None);
}

// Times and dates

#[test]
fn durations() {
    for (word, expected) in [
        ("T#14ms", 14_000_000),
        ("T#-14ms", -14_000_000),
        ("T#+2s", 2 * SECOND),
        ("T#14.7s", 14_700_000_000),
        ("T#14.7m", 882 * SECOND),
        ("T#14.7h", 52_920 * SECOND),
        ("t#14.7d", 1_270_080 * SECOND),
        ("t#25h15m", 90_900 * SECOND),
        ("t#5d14h12m18s3.5ms", 483_138_003_500_000),
        ("TIME#25h_15m", 90_900 * SECOND),
        ("time#5d_14h_12m_18s_3.5ms", 483_138_003_500_000),
        ("T#100s", 100 * SECOND),
        ("T#1d30s", 86_430 * SECOND),
        ("T#1_000ms", SECOND),
        ("LT#1us", 1000),
        ("LTIME#1s1ms1us1ns", 1_001_001_001),
        ("T#0.9ns", 0),
        ("T#0s", 0),
        ("LT#-9223372036854775808ns", i64::MIN),
        ("LT#9223372036854775807ns", i64::MAX),
    ] {
        assert_eq!(value(word), LiteralValue::Time(expected), "{word}");
    }
    use LiteralProblem::*;
    for (word, expected) in [
        ("T#1h90m", DurationOverflow),
        ("T#1d24h", DurationOverflow),
        ("T#1m60s", DurationOverflow),
        ("T#1s1000ms", DurationOverflow),
        ("T#1h60.5m", DurationOverflow),
        ("T#1d90s", DurationOverflow),
        ("T#1m1h", DurationForm),
        ("T#1s1s", DurationForm),
        ("T#1.5h30m", DurationForm),
        ("T#5", DurationForm),
        ("T#", DurationForm),
        ("T#-", DurationForm),
        ("T#s", DurationForm),
        ("T#5x", DurationForm),
        ("T#.5s", DurationForm),
        ("T#5.s", DurationForm),
        ("T#1.2.3s", DurationForm),
        ("T#1h 5m", DurationForm),
        ("T#--1s", DurationForm),
        ("T#1h_", Underscore),
        ("T#1h__5m", Underscore),
        ("T#_1h", Underscore),
        ("T#1_h", Underscore),
        ("T#1._5h", Underscore),
        ("LT#9223372036854775808ns", Range),
        ("T#999999999999999999999999999999999999999999d", Range),
        ("T#99999999999999999999999999999999d", Range),
    ] {
        assert_eq!(problem(word), expected, "{word}");
    }
    assert_eq!(Literal::read("LT#1s").unwrap().named_type, Some(ElementaryType::Ltime));
}

#[test]
fn dates_and_times_of_day() {
    use LiteralValue::{Date, DateAndTime, TimeOfDay};
    assert_eq!(value("D#1970-01-01"), Date(0));
    assert_eq!(value("DATE#1984-06-25"), Date(5289));
    assert_eq!(value("d#2024-02-29"), Date(19_782));
    assert_eq!(value("D#2024-2-9"), value("D#2024-02-09"));
    assert_eq!(value("LD#1969-12-31"), Date(-1));
    assert_eq!(value("LDATE#2000-02-29"), Date(11_016));
    assert_eq!(value("TOD#00:00:00"), TimeOfDay(0));
    assert_eq!(value("TIME_OF_DAY#15:36:55.36"), TimeOfDay(56_215_360_000_000));
    assert_eq!(value("tod#23:59:59.999"), TimeOfDay(86_399_999_000_000));
    assert_eq!(value("LTOD#0:0:0.000_1".replace('_', "").as_str()), TimeOfDay(100_000));
    assert_eq!(value("DT#1970-01-01-00:00:01"), DateAndTime(SECOND.into()));
    assert_eq!(value("DATE_AND_TIME#1984-06-25-15:36:55.36"), DateAndTime(457_025_815_360_000_000));
    assert_eq!(value("LDT#1969-12-31-23:59:59"), DateAndTime((-SECOND).into()));
    assert_eq!(value("DT#0001-01-01-00:00:00"), DateAndTime(-62_135_596_800 * i128::from(SECOND)));
    use LiteralProblem::*;
    for (word, expected) in [
        ("D#2024-02-30", NoSuchDate),
        ("D#2023-02-29", NoSuchDate),
        ("D#1900-02-29", NoSuchDate),
        ("D#2024-13-01", NoSuchDate),
        ("D#2024-00-01", NoSuchDate),
        ("D#2024-04-31", NoSuchDate),
        ("D#2024-01-00", NoSuchDate),
        ("D#0000-01-01", NoSuchDate),
        ("TOD#24:00:00", NoSuchDate),
        ("TOD#23:60:00", NoSuchDate),
        ("TOD#23:59:60", NoSuchDate),
        ("DT#2024-02-30-12:00:00", NoSuchDate),
        ("DT#2024-02-28-25:00:00", NoSuchDate),
        ("D#24-01-01", DateForm),
        ("D#2024/01/01", DateForm),
        ("D#2024-01", DateForm),
        ("D#2024-01-01-01", DateForm),
        ("D#", DateForm),
        ("D#2024-+1-01", DateForm),
        ("TOD#12:00", DateForm),
        ("TOD#12:00:00.", DateForm),
        ("TOD#12:00:00.x", DateForm),
        ("TOD#12:00:-1", DateForm),
        ("DT#2024-01-01", DateForm),
        ("DT#12:00:00", DateForm),
    ] {
        assert_eq!(problem(word), expected, "{word}");
    }
}

#[test]
fn the_calendar_agrees_with_counting_days_one_by_one() {
    // From the first day of the calendar to the end of 2400, a cycle of 400 years and six times over.
    let days_to_1970 = 719_162;
    let mut count = -days_to_1970;
    for year in 1..=2400 {
        let leap = year % 400 == 0 || (year % 4 == 0 && year % 100 != 0);
        let lengths = [31, if leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
        for (month, length) in (1..).zip(lengths) {
            for day in 1..=length {
                if !(2..=27).contains(&day) {
                    let word = format!("D#{year:04}-{month:02}-{day:02}");
                    assert_eq!(value(&word), LiteralValue::Date(count), "{word}");
                }
                count += 1;
            }
            assert_eq!(problem(&format!("D#{year:04}-{month}-{}", length + 1)), LiteralProblem::NoSuchDate);
        }
    }
}

// Texts

#[test]
fn texts() {
    for word in [
        "''",
        "'A'",
        "' '",
        "'$''",
        "'\"'",
        "'$R$L'",
        "'$n$p$t'",
        "'$$1.00'",
        "'$C4$CB'",
        "'Grüße'",
        "STRING#'OK'",
        "string#''",
        "CHAR#'a'",
        "CHAR#'$41'",
    ] {
        assert_eq!(value(word), LiteralValue::Text, "{word}");
    }
    for word in [
        "\"\"",
        "\"A\"",
        "\"'\"",
        "\"$\"\"",
        "\"$R$L\"",
        "\"$$1.00\"",
        "\"$00C4\"",
        "WSTRING#\"OK\"",
        "WCHAR#\"a\"",
    ] {
        assert_eq!(value(word), LiteralValue::WideText, "{word}");
    }
    use LiteralProblem::*;
    for (word, expected) in [
        ("'", Text),
        ("'abc", Text),
        ("'$'", Text),
        ("'$", Text),
        ("'$x'", Text),
        ("'$4'", Text),
        ("'$4G'", Text),
        ("'it's'", Text),
        ("'a\nb'", Text),
        ("\"abc'", Text),
        ("\"$00C\"", Text),
        ("'$\"'", Text),
        ("STRING#\"a\"", Type),
        ("WSTRING#'a'", Type),
        ("STRING#5", Type),
        ("STRING#", Form),
        ("CHAR#'ab'", Range),
        ("CHAR#''", Range),
    ] {
        assert_eq!(problem(word), expected, "{word}");
    }
    assert_eq!(Literal::read("''").unwrap().named_type, Some(ElementaryType::String));
}

#[test]
fn values_of_enumerations() {
    for word in ["Colour#Red", "colour#red", "Ampel#Grün"] {
        assert_eq!(
            Literal::read(word).unwrap(),
            Literal { named_type: None, value: LiteralValue::Enumerated }
        );
    }
    assert_eq!(problem("Colour#"), LiteralProblem::Form);
    assert_eq!(problem("Colour#Red#Blue"), LiteralProblem::Type);
    assert_eq!(problem("Co__lour#Red"), LiteralProblem::Type);
}

// Operands

fn read(word: &str) -> Operand {
    Operand::read(word, Model::Iec)
}

#[test]
fn direct_addresses() {
    use Location::*;
    let address = |location, width, numbers: &[u32]| {
        let mut path = [None; 4];
        for (level, number) in path.iter_mut().zip(numbers) {
            *level = Some(*number);
        }
        Operand::Direct(DirectAddress { location, width, path })
    };
    for (word, expected) in [
        ("%IX0.0", address(Input, Width::Bit, &[0, 0])),
        ("%ix0.3", address(Input, Width::Bit, &[0, 3])),
        ("%I1", address(Input, Width::Bit, &[1])),
        ("%QW3", address(Output, Width::Word, &[3])),
        ("%M1", address(Memory, Width::Bit, &[1])),
        ("%MB12", address(Memory, Width::Byte, &[12])),
        ("%MD48", address(Memory, Width::Double, &[48])),
        ("%ml7", address(Memory, Width::Long, &[7])),
        ("%IW2.5.7.1", address(Input, Width::Word, &[2, 5, 7, 1])),
        ("%I*", address(Input, Width::Bit, &[])),
        ("%QW*", address(Output, Width::Word, &[])),
    ] {
        assert_eq!(read(word), expected, "{word}");
    }
    for word in [
        "%",
        "%I",
        "%IX",
        "%X0",
        "%IX0.",
        "%IX.0",
        "%IX0..0",
        "%IW1.2.3.4.5",
        "%IX-1",
        "%IX+1",
        "%IX99999999999",
        "%IX0.0 ",
        "%I**",
        "%I0.*",
        "%阀",
        "%IXa",
    ] {
        assert_eq!(read(word), Operand::Invalid(OperandProblem::MalformedAddress), "{word}");
    }
}

#[test]
fn variables() {
    for word in [
        "Motor",
        "_m",
        "阀门",
        "T1.Q",
        "Line.Station.Motor.Run",
        "a[3]",
        "a[3].b",
        "a[i,2]",
        "a[ i , 2 ]",
        "a[i+1]",
        "a[(i+1)*2, -3]",
        "a[b[c[1]]].d[2]",
        "a[INT#3]",
        "a[16#F]",
        "a[%MW3]",
        "a[Colour#Red]",
        "Status.3",
        "Status.15",
        "Status.%X3",
        "Status.%b1",
        "p^",
        "p^.x",
        "IN",
        "S",
        "LIMIT",
    ] {
        assert_eq!(read(word), Operand::Variable, "{word}");
    }
    for word in [
        "a__b", "a_", "a.", "a..b", "a.b__c", "a[", "a[]", "a[1", "a[1]]", "a[1,]", "a[,1]", "a[1 2]",
        "a['x']", "a[1.5]", "a[i+]", "a[(i]", "a]", "a b", "a-b", "a+b", "a.123", "a.%X", "a.%Q3", "a.%X123",
        "a.'x'", "a,b",
    ] {
        assert_eq!(read(word), Operand::Invalid(OperandProblem::MalformedName), "{word}");
    }
    for word in ["PROGRAM", "end_var", "Int", "INT.x"] {
        assert_eq!(read(word), Operand::Invalid(OperandProblem::Keyword), "{word}");
    }
    for word in ["", "(", "!", "=", " a", "-"] {
        assert_eq!(read(word), Operand::Invalid(OperandProblem::Unreadable), "{word}");
    }
}

#[test]
fn operands_that_are_literals() {
    for word in ["TRUE", "false", "12", "-1.5", "16#FF", "T#1s", "'a b'", "\"x\"", "Colour#Red", "INT#5"] {
        assert_eq!(read(word), Operand::Literal(Literal::read(word).unwrap()), "{word}");
    }
    for (word, expected) in [
        ("1e3", LiteralProblem::RealForm),
        (".5", LiteralProblem::RealForm),
        ("T#1h90m", LiteralProblem::DurationOverflow),
        ("'abc", LiteralProblem::Text),
        ("FOO#5", LiteralProblem::Type),
    ] {
        assert_eq!(read(word), Operand::Invalid(OperandProblem::MalformedLiteral(expected)), "{word}");
    }
}

#[test]
fn deep_nesting_is_refused_and_not_followed() {
    let nested = |depth: usize| format!("{}1{}", "a[".repeat(depth), "]".repeat(depth));
    assert_eq!(read(&nested(16)), Operand::Variable);
    assert_eq!(read(&nested(17)), Operand::Invalid(OperandProblem::MalformedName));
    assert_eq!(read(&nested(100_000)), Operand::Invalid(OperandProblem::MalformedName));
    let parentheses = format!("a[{}1{}]", "(".repeat(100_000), ")".repeat(100_000));
    assert_eq!(read(&parentheses), Operand::Invalid(OperandProblem::MalformedName));
}

// Operators

#[test]
fn operators_are_found_with_their_modifiers() {
    let words: Vec<String> = Operator::all_written().map(|written| written.word()).collect();
    assert_eq!(
        words.join(" "),
        "LD LDN ST STN S R AND ANDN & &N OR ORN XOR XORN NOT ADD SUB MUL DIV MOD GT GE EQ NE LE LT \
         JMP JMPC JMPCN CAL CALC CALCN RET RETC RETCN"
    );
    for expected in Operator::all_written() {
        for word in cases(&expected.word()) {
            let found = Operator::written(&word).unwrap_or_else(|| panic!("{word}"));
            assert_eq!(found.word(), expected.word());
            assert_eq!((found.negate, found.condition), (expected.negate, expected.condition), "{word}");
        }
    }
    for word in ["", "LDC", "STC", "SN", "RN", "ADDN", "NOTN", "JMPN", "AND(", "LDNN", "CALN", "MOVE", "Ⅼ"]
    {
        assert!(Operator::written(word).is_none(), "{word}");
    }
    assert_eq!(Operator::named("and").map(|operator| operator.name), Some("AND"));
    assert!(Operator::named("ANDN").is_none());
}

#[test]
fn modifiers_go_with_roles() {
    for operator in Operator::all() {
        let modifiers = operator.modifiers;
        let flow = matches!(operator.role, OperatorRole::Jump | OperatorRole::Call | OperatorRole::Return);
        assert_eq!(modifiers.condition, flow, "{}", operator.name);
        assert_eq!(
            modifiers.defer,
            matches!(operator.role, OperatorRole::Combine { .. }),
            "{}",
            operator.name
        );
        assert_eq!(operator.operand.is_none(), flow, "{}", operator.name);
        let comparison = ["GT", "GE", "EQ", "NE", "LE", "LT"].contains(&operator.name);
        assert_eq!(
            operator.role == OperatorRole::Combine { comparison: true },
            comparison,
            "{}",
            operator.name
        );
    }
}

#[test]
fn results_of_operators() {
    let strict = |name: &str, current: &str, operand: &str| {
        let kind = |name| ElementaryType::named(name).unwrap();
        Operator::named(name).unwrap().combine(kind(current), kind(operand), false).map(ElementaryType::name)
    };
    assert_eq!(strict("AND", "WORD", "WORD"), Some("WORD"));
    assert_eq!(strict("AND", "WORD", "BYTE"), None);
    assert_eq!(strict("AND", "INT", "INT"), None);
    assert_eq!(strict("ADD", "INT", "INT"), Some("INT"));
    assert_eq!(strict("ADD", "INT", "DINT"), None);
    assert_eq!(strict("ADD", "BOOL", "BOOL"), None);
    assert_eq!(strict("ADD", "TIME", "TIME"), Some("TIME"));
    assert_eq!(strict("ADD", "TOD", "TIME"), Some("TOD"));
    assert_eq!(strict("ADD", "TIME", "TOD"), None);
    assert_eq!(strict("SUB", "DT", "DT"), Some("TIME"));
    assert_eq!(strict("SUB", "DT", "TIME"), Some("DT"));
    assert_eq!(strict("SUB", "DATE", "DATE"), Some("TIME"));
    assert_eq!(strict("SUB", "DATE", "TIME"), None);
    assert_eq!(strict("MUL", "TIME", "INT"), Some("TIME"));
    assert_eq!(strict("MUL", "TIME", "TIME"), None);
    assert_eq!(strict("DIV", "LTIME", "REAL"), Some("LTIME"));
    assert_eq!(strict("MOD", "REAL", "REAL"), None);
    assert_eq!(strict("GT", "STRING", "STRING"), Some("BOOL"));
    assert_eq!(strict("EQ", "INT", "REAL"), None);
    assert_eq!(strict("LD", "INT", "INT"), None);
    let wide = |name: &str, current, operand| Operator::named(name).unwrap().combine(current, operand, true);
    assert_eq!(wide("ADD", ElementaryType::Int, ElementaryType::Dint), Some(ElementaryType::Dint));
    assert_eq!(wide("ADD", ElementaryType::Dint, ElementaryType::Int), Some(ElementaryType::Dint));
    assert_eq!(wide("LT", ElementaryType::Int, ElementaryType::Real), Some(ElementaryType::Bool));
    assert_eq!(wide("ADD", ElementaryType::Int, ElementaryType::Uint), None);
}

// Functions and blocks

#[test]
fn functions_are_found_by_name_in_every_case() {
    let mut names = HashSet::new();
    for function in Function::all() {
        assert!(names.insert(function.name), "{} twice", function.name);
        assert!(is_identifier(function.name), "{}", function.name);
        for written in cases(function.name) {
            let found = Function::named(&written).unwrap_or_else(|| panic!("{written}"));
            assert!(std::ptr::eq(found, function), "{written} finds {}", found.name);
        }
        assert!(!function.inputs.is_empty(), "{}", function.name);
        let inputs: HashSet<_> = function.inputs.iter().map(|input| input.name).collect();
        assert_eq!(inputs.len(), function.inputs.len(), "{}", function.name);
    }
    for name in "ABS SQRT LN LOG EXP SIN COS TAN ASIN ACOS ATAN ATAN2 ADD MUL SUB DIV MOD EXPT MOVE SHL SHR ROL ROR \
                 AND OR XOR NOT SEL MAX MIN LIMIT MUX GT GE EQ LE LT NE LEN LEFT RIGHT MID CONCAT INSERT DELETE \
                 REPLACE FIND TRUNC ADD_TIME CONCAT_DATE_TOD"
        .split_whitespace()
    {
        assert!(names.contains(name), "{name}");
    }
    for name in
        ["", "INT_TO_INT", "INT_TO", "_TO_INT", "INT_TO_FOO", "TIME_TO_DATE", "TO_", "BCD_TO_REAL", "TON"]
    {
        assert!(Function::named(name).is_none(), "{name}");
    }
    assert!(Function::named(&"A".repeat(1000)).is_none());
    assert!(Function::named("İNT_TO_REAL").is_none());
}

#[test]
fn conversions_name_their_types() {
    use ElementaryType::*;
    let types = |name: &str| {
        let function = Function::named(name).unwrap_or_else(|| panic!("{name}"));
        (function.inputs[0].kind, function.result)
    };
    let one = ParameterType::Elementary;
    let any = ParameterType::Generic;
    for (name, input, result) in [
        ("INT_TO_REAL", one(Int), one(Real)),
        ("REAL_TO_INT", one(Real), one(Int)),
        ("BOOL_TO_WORD", one(Bool), one(Word)),
        ("TIME_TO_DINT", one(Time), one(Dint)),
        ("STRING_TO_TIME", one(String), one(Time)),
        ("DATE_AND_TIME_TO_TIME_OF_DAY", one(DateAndTime), one(TimeOfDay)),
        ("LDATE_AND_TIME_TO_LTIME_OF_DAY", one(LdateAndTime), one(LtimeOfDay)),
        ("DT_TO_DATE", one(DateAndTime), one(Date)),
        ("TO_INT", any(GenericType::AnyElementary), one(Int)),
        ("TRUNC", any(GenericType::AnyReal), any(GenericType::AnyInt)),
        ("TRUNC_DINT", any(GenericType::AnyReal), one(Dint)),
        ("REAL_TRUNC_INT", one(Real), one(Int)),
        ("WORD_BCD_TO_UINT", one(Word), one(Uint)),
        ("UINT_TO_BCD_WORD", one(Uint), one(Word)),
        ("BCD_TO_INT", any(GenericType::AnyBit), one(Int)),
        ("INT_TO_BCD", one(Int), any(GenericType::AnyBit)),
        ("TO_BCD_WORD", any(GenericType::AnyInt), one(Word)),
    ] {
        assert_eq!(types(name), (input, result), "{name}");
    }
    let numbers = "BOOL BYTE WORD DWORD LWORD SINT INT DINT LINT USINT UINT UDINT ULINT REAL LREAL STRING";
    for from in numbers.split_whitespace() {
        for to in numbers.split_whitespace().filter(|to| *to != from) {
            types(&format!("{from}_TO_{to}"));
        }
    }
}

#[test]
fn enable_pins_are_no_ones_own() {
    use rungwise::target::iec::{EN, ENO};
    for pin in [EN, ENO] {
        assert_eq!(pin.kind, ParameterType::Elementary(ElementaryType::Bool));
        assert!(Function::all().all(|function| function.input_named(pin.name).is_none()));
        let mut blocks = FunctionBlock::all();
        assert!(blocks.all(|block| {
            block.input_named(pin.name).is_none() && block.output_named(pin.name).is_none()
        }));
    }
}

#[test]
fn inputs_of_extensible_functions_go_on() {
    let add = Function::named("ADD").unwrap();
    assert_eq!(add.input(0).map(|input| input.name), Some("IN1"));
    assert_eq!(add.input(7).map(|input| input.name), Some("IN2"));
    for name in ["in1", "IN2", "in3", "IN17"] {
        assert!(add.input_named(name).is_some(), "{name}");
    }
    for name in ["IN0", "IN", "IN03", "IN+3", "IN3x", "X3", "", "ïN3"] {
        assert!(add.input_named(name).is_none(), "{name}");
    }
    let mux = Function::named("MUX").unwrap();
    assert!(
        mux.input_named("IN0").is_some()
            && mux.input_named("IN2").is_some()
            && mux.input_named("K2").is_none()
    );
    let limit = Function::named("LIMIT").unwrap();
    assert_eq!(limit.inputs.iter().map(|input| input.name).collect::<Vec<_>>(), ["MN", "IN", "MX"]);
    assert!(limit.input(3).is_none() && limit.input_named("IN3").is_none());
}

#[test]
fn blocks_are_found_by_name_in_every_case() {
    let mut names = HashSet::new();
    for block in FunctionBlock::all() {
        assert!(names.insert(block.name), "{} twice", block.name);
        for written in cases(block.name) {
            assert_eq!(FunctionBlock::named(&written).map(|found| found.name), Some(block.name));
        }
        for operator in block.input_operators {
            assert!(block.input_named(operator).is_some(), "{} {operator}", block.name);
            assert!(FunctionBlock::all_input_operators().contains(operator), "{operator}");
        }
        let pins: HashSet<_> = block.inputs.iter().chain(block.outputs).map(|pin| pin.name).collect();
        assert_eq!(pins.len(), block.inputs.len() + block.outputs.len(), "{}", block.name);
    }
    let signature = |name: &str| {
        let block = FunctionBlock::named(name).unwrap_or_else(|| panic!("{name}"));
        let pin = |pin: &rungwise::target::iec::Parameter| format!("{}:{}", pin.name, pin.kind.name());
        let pins = |pins: &[_]| pins.iter().map(pin).collect::<Vec<_>>().join(" ");
        format!("{} -> {}", pins(block.inputs), pins(block.outputs))
    };
    assert_eq!(signature("SR"), "S1:BOOL R:BOOL -> Q1:BOOL");
    assert_eq!(signature("RS"), "S:BOOL R1:BOOL -> Q1:BOOL");
    assert_eq!(signature("R_TRIG"), "CLK:BOOL -> Q:BOOL");
    assert_eq!(signature("F_TRIG"), "CLK:BOOL -> Q:BOOL");
    assert_eq!(signature("CTU"), "CU:BOOL R:BOOL PV:INT -> Q:BOOL CV:INT");
    assert_eq!(signature("CTD"), "CD:BOOL LD:BOOL PV:INT -> Q:BOOL CV:INT");
    assert_eq!(
        signature("CTUD_ULINT"),
        "CU:BOOL CD:BOOL R:BOOL LD:BOOL PV:ULINT -> QU:BOOL QD:BOOL CV:ULINT"
    );
    for timer in ["TP", "TON", "TOF"] {
        assert_eq!(signature(timer), "IN:BOOL PT:TIME -> Q:BOOL ET:TIME");
    }
    assert_eq!(signature("RTC"), "IN:BOOL PDT:DT -> Q:BOOL CDT:DT");
    assert_eq!(signature("SEMA"), "CLAIM:BOOL RELEASE:BOOL -> BUSY:BOOL");
    assert_eq!(names.len(), 5 + 15 + 4);
}

#[test]
fn input_operators_are_those_of_table_54() {
    let blocks = |word: &str| {
        FunctionBlock::with_input_operator(word)
            .map(|block| block.name)
            .filter(|name| !name.starts_with("CT") || !name.contains('_'))
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert_eq!(blocks("s1"), "SR");
    assert_eq!(blocks("S"), "RS");
    assert_eq!(blocks("R"), "SR CTU CTUD");
    assert_eq!(blocks("R1"), "RS");
    assert_eq!(blocks("CLK"), "R_TRIG F_TRIG");
    assert_eq!(blocks("cu"), "CTU CTUD");
    assert_eq!(blocks("CD"), "CTD CTUD");
    assert_eq!(blocks("PV"), "CTU CTD CTUD");
    assert_eq!(blocks("IN"), "TP TON TOF");
    assert_eq!(blocks("PT"), "TP TON TOF");
    assert_eq!(blocks("LD"), "");
}

// Pages

fn pages() -> Vec<(String, String)> {
    let operators = Operator::all().map(|row| (format!("operator {}", row.name), row.page()));
    let functions = Function::all().map(|row| (format!("function {}", row.name), row.page()));
    let blocks = FunctionBlock::all().map(|row| (format!("block {}", row.name), row.page()));
    operators.chain(functions).chain(blocks).collect()
}

/// The instructions of a page's example, without blanks around them.
fn body(page: &str) -> Vec<&str> {
    let (_, after) = page.split_once("END_VAR\n").unwrap();
    after.split_once("END_PROGRAM").unwrap().0.lines().map(str::trim).collect()
}

#[test]
fn every_page_is_one_paragraph_and_one_program() {
    for (name, page) in pages() {
        let (paragraph, example) = page.split_once("\n\n").unwrap_or_else(|| panic!("{name}"));
        assert!(paragraph.len() > 60 && paragraph.ends_with('.'), "{name}: {paragraph}");
        assert!(!paragraph.contains('\n') && !paragraph.contains("  "), "{name}: {paragraph}");
        assert!(example.starts_with("```il\nPROGRAM Example\nVAR\n"), "{name}");
        assert!(example.ends_with("END_PROGRAM\n```\n"), "{name}");
        assert_eq!(page.matches("```").count(), 2, "{name}");
        assert!(!page.contains('\t') && !page.lines().any(|line| line.ends_with(' ')), "{name}");
    }
}

/// A small strict reader of the examples: declarations, one instruction a line, parameters one a line.
#[test]
fn examples_declare_and_use_what_they_name() {
    for (name, page) in pages() {
        let declared_section = page.split_once("VAR\n").unwrap().1.split_once("END_VAR").unwrap().0;
        let mut variables = HashSet::new();
        for declaration in declared_section.lines() {
            let declaration =
                declaration.strip_prefix("    ").and_then(|line| line.strip_suffix(';')).unwrap();
            let (variable, kind) = declaration.split_once(" : ").unwrap();
            let (variable, address) = match variable.split_once(" AT ") {
                Some((variable, address)) => (variable, Some(address)),
                None => (variable, None),
            };
            assert!(address.is_none_or(|address| matches!(read(address), Operand::Direct(_))), "{name}");
            let (kind, initial) = match kind.split_once(" := ") {
                Some((kind, initial)) => (kind, Some(initial)),
                None => (kind, None),
            };
            let elementary = ElementaryType::named(kind);
            assert!(elementary.is_some() || FunctionBlock::named(kind).is_some(), "{name}: {kind}");
            if let (Some(initial), Some(kind)) = (initial, elementary) {
                let literal = Literal::read(initial).unwrap_or_else(|p| panic!("{name}: {initial} {p:?}"));
                assert!(literal.fits(kind) || kind.belongs_to(GenericType::AnyChar), "{name}: {initial}");
            }
            assert!(is_identifier(variable) && !is_keyword(variable), "{name}: {variable}");
            let taken = Operator::written(variable).is_some() || Function::named(variable).is_some();
            assert!(!taken && FunctionBlock::named(variable).is_none(), "{name}: {variable}");
            assert!(variables.insert(variable), "{name}: {variable} twice");
        }
        let mut used = HashSet::new();
        let mut labels = HashSet::new();
        let mut jumps = HashSet::new();
        let mut stores = 0;
        for line in body(&page) {
            if let Some(label) = line.strip_suffix(':') {
                labels.insert(label);
                continue;
            }
            let line = line.trim_end_matches(['(', ',']);
            let (word, operands) = match line.split_once(" := ") {
                Some((_, value)) => ("", value),
                None => line.split_once(' ').unwrap_or((line, "")),
            };
            let known = Operator::written(word).is_some() || Function::named(word).is_some();
            assert!(word.is_empty() || word == ")" || known, "{name}: {line}");
            stores += usize::from(matches!(word, "ST" | "STN" | "S" | "R"));
            if word.starts_with("JMP") {
                jumps.insert(operands);
                continue;
            }
            // A comma inside quotes would need more than this reader; the pages have none.
            for operand in operands.split(", ").filter(|operand| !operand.is_empty()) {
                match read(operand) {
                    Operand::Literal(_) => {}
                    Operand::Variable => {
                        let head = operand.split('.').next().unwrap();
                        assert!(variables.contains(head), "{name}: {operand}");
                        used.insert(head);
                    }
                    other => panic!("{name}: {operand} {other:?}"),
                }
            }
        }
        assert_eq!(used, variables, "{name}");
        assert_eq!(labels, jumps, "{name}");
        assert!(stores > 0, "{name}");
    }
}

#[test]
fn every_example_uses_what_its_page_is_about() {
    for operator in Operator::all() {
        let page = operator.page();
        let used = body(&page).iter().any(|line| {
            let word = line.split([' ', '(']).next().unwrap_or("");
            Operator::written(word).is_some_and(|written| written.operator.name == operator.name)
        });
        assert!(used, "{}", operator.name);
    }
    for function in Function::all() {
        let page = function.page();
        let used = body(&page).iter().any(|line| line.split([' ', '(']).next() == Some(function.name));
        assert!(used, "{}", function.name);
    }
    for block in FunctionBlock::all() {
        assert!(block.page().contains(&format!(" : {};\n", block.name)), "{}", block.name);
        for input in block.inputs {
            assert!(block.page().contains(&format!(" {} := ", input.name)), "{} {}", block.name, input.name);
        }
    }
}

#[test]
fn deferred_and_formal_lists_are_laid_out_one_a_line() {
    let page = Function::named("LIMIT").unwrap().page();
    assert!(page.ends_with(
        "END_VAR\n    LIMIT(\n        MN := 0,\n        IN := Request,\n        MX := 1500\n    )\n    ST Speed\n\
         END_PROGRAM\n```\n"
    ));
    for (name, page) in pages() {
        let mut open = 0;
        for line in body(&page) {
            open += line.matches('(').count() as i32 - line.matches(')').count() as i32;
            assert!(!line.contains('(') || line.ends_with('('), "{name}: {line}");
            assert!(!line.contains(')') || line == ")", "{name}: {line}");
        }
        assert_eq!(open, 0, "{name}");
    }
}

proptest! {
    #[test]
    fn reading_an_operand_never_panics(word in ".{0,40}") {
        let _ = Operand::read(&word, Model::Iec);
        let _ = Literal::read(&word);
        let _ = (Operator::written(&word).is_some(), Function::named(&word).is_some());
        let _ = (FunctionBlock::named(&word).is_some(), ElementaryType::named(&word), is_keyword(&word));
    }

    #[test]
    fn reading_what_looks_like_an_operand_never_panics(
        word in "(%|T#|LT#|D#|DT#|TOD#|INT#|16#|'|\"|a|é)?[-+%#$.:_'\"\\[\\]()a-zA-Z0-9 ,*é]{0,24}",
    ) {
        let _ = Operand::read(&word, Model::Iec);
    }

    #[test]
    fn durations_agree_with_a_sum_of_units(
        first in 0usize..7,
        counts in prop::array::uniform7(0i64..1000),
        present in prop::array::uniform7(any::<bool>()),
        negative in any::<bool>(),
        underscores in any::<bool>(),
    ) {
        let units: [(&str, i64, i64); 7] = [
            ("d", 86_400 * SECOND, 1000),
            ("h", 3600 * SECOND, 24),
            ("m", 60 * SECOND, 60),
            ("s", SECOND, 60),
            ("ms", 1_000_000, 1000),
            ("us", 1000, 1000),
            ("ns", 1, 1000),
        ];
        let mut parts = Vec::new();
        let mut sum = 0;
        for (index, (unit, size, limit)) in units.iter().enumerate().skip(first) {
            if index == first || present[index] {
                let count = if index == first { counts[index] } else { counts[index] % limit };
                parts.push(format!("{count}{unit}"));
                sum += count * size;
            }
        }
        let separator = if underscores { "_" } else { "" };
        let word = format!("t#{}{}", if negative { "-" } else { "" }, parts.join(separator));
        prop_assert_eq!(value(&word), LiteralValue::Time(if negative { -sum } else { sum }), "{}", word);
        prop_assert_eq!(value(&word.to_uppercase()), value(&word));
    }

    #[test]
    fn integers_read_back(number in any::<i64>(), base in prop::sample::select(vec![2, 8, 16])) {
        prop_assert_eq!(value(&number.to_string()), LiteralValue::Integer(number.into()));
        let magnitude = number.unsigned_abs();
        let word = match base {
            2 => format!("2#{magnitude:b}"),
            8 => format!("8#{magnitude:o}"),
            _ => format!("16#{magnitude:X}"),
        };
        prop_assert_eq!(value(&word), LiteralValue::Integer(magnitude.into()));
    }
}
