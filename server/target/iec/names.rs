//! Identifiers and keywords (IEC 61131-3 2nd ed. 2.1.2 and annex C).

use rustc_hash::FxHashSet;
use std::sync::LazyLock;
use unicode_ident::{is_xid_continue, is_xid_start};

/// Whether `word` is an identifier: a letter or `_`, then letters, digits and `_`, no two `_` in a row, none at
/// the end, and something besides `_`.
///
/// Letters of all scripts count, although the standard has those of Latin only: names of ladder elements do.
///
/// ```
/// use rungwise::target::iec::is_identifier;
/// assert!(is_identifier("_Motor_1") && is_identifier("阀门"));
/// assert!(!is_identifier("Motor__1") && !is_identifier("Motor_") && !is_identifier("1st"));
/// ```
pub fn is_identifier(word: &str) -> bool {
    let mut characters = word.chars();
    let starts = characters.next().is_some_and(|first| first == '_' || is_xid_start(first));
    starts && characters.all(is_xid_continue) && !word.contains("__") && !word.ends_with('_')
}

/// Whether `word` is one of [`KEYWORDS`], letter case aside.
pub fn is_keyword(word: &str) -> bool {
    super::folded(word, |word| Some(SET.contains(word))).unwrap_or(false)
}

/// The reserved words: sections of programs, declarations, names of types, TRUE and FALSE.
///
/// Operators and the names of standard functions and blocks are left out: a variable may be called `S` or `IN`.
/// So are the words of tasks (PRIORITY, SINGLE, INTERVAL), which only mean something there.
pub const KEYWORDS: &[&str] = &[
    "PROGRAM",
    "END_PROGRAM",
    "FUNCTION",
    "END_FUNCTION",
    "FUNCTION_BLOCK",
    "END_FUNCTION_BLOCK",
    "CONFIGURATION",
    "END_CONFIGURATION",
    "RESOURCE",
    "END_RESOURCE",
    "TASK",
    "ON",
    "WITH",
    "TYPE",
    "END_TYPE",
    "STRUCT",
    "END_STRUCT",
    "ARRAY",
    "OF",
    "VAR",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_IN_OUT",
    "VAR_EXTERNAL",
    "VAR_GLOBAL",
    "VAR_TEMP",
    "VAR_ACCESS",
    "VAR_CONFIG",
    "END_VAR",
    "CONSTANT",
    "RETAIN",
    "NON_RETAIN",
    "AT",
    "R_EDGE",
    "F_EDGE",
    "READ_ONLY",
    "READ_WRITE",
    "STEP",
    "INITIAL_STEP",
    "END_STEP",
    "TRANSITION",
    "END_TRANSITION",
    "FROM",
    "TO",
    "ACTION",
    "END_ACTION",
    "TRUE",
    "FALSE",
    "BOOL",
    "BYTE",
    "WORD",
    "DWORD",
    "LWORD",
    "SINT",
    "INT",
    "DINT",
    "LINT",
    "USINT",
    "UINT",
    "UDINT",
    "ULINT",
    "REAL",
    "LREAL",
    "TIME",
    "LTIME",
    "DATE",
    "LDATE",
    "TOD",
    "LTOD",
    "TIME_OF_DAY",
    "LTIME_OF_DAY",
    "DT",
    "LDT",
    "DATE_AND_TIME",
    "LDATE_AND_TIME",
    "STRING",
    "WSTRING",
    "CHAR",
    "WCHAR",
    "ANY",
    "ANY_DERIVED",
    "ANY_ELEMENTARY",
    "ANY_MAGNITUDE",
    "ANY_NUM",
    "ANY_REAL",
    "ANY_INT",
    "ANY_BIT",
    "ANY_STRING",
    "ANY_DATE",
];

static SET: LazyLock<FxHashSet<&'static str>> = LazyLock::new(|| KEYWORDS.iter().copied().collect());
