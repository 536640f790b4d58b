//! What is checked without an error can be simulated.

use crate::rules_sense::without_sense;
use crate::simulate_iec::document;
use rungwise::check;
use rungwise::document::Notation;
use rungwise::simulate::{Session, compile};
use rungwise::target::iec::{ElementaryType, Function, FunctionBlock, Operator};
use rungwise::text::{Language, Severity};
use std::sync::Arc;

/// Why a program that is checked without an error cannot be simulated; nothing if it can, or has errors.
fn disagreement(text: &str) -> Option<String> {
    let document = document(text, Notation::IecIl);
    let found = check::all(&document, &without_sense());
    if found.iter().any(|one| one.severity == Severity::Error) {
        return None;
    }
    match compile(&[&document], false) {
        Ok(code) => {
            let mut session = Session::new(Arc::new(code));
            (0..3).for_each(|scan| _ = session.scan(scan * 10_000_000));
            None
        }
        Err(problems) => {
            let problem = &problems[0];
            let start = problem.place.span.start as usize;
            let line = text[start..].lines().next().unwrap_or_default();
            Some(format!("{text} {line}: {}", problem.obstacle.message().render(Language::English)))
        }
    }
}

/// So many programs of each kind are run, spread over all; `RUNGWISE_CASES` says how many.
fn cases() -> usize {
    std::env::var("RUNGWISE_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(1000)
}

fn assert_agree(programs: impl IntoIterator<Item = String>) {
    let all: Vec<String> = programs.into_iter().collect();
    let step = all.len().checked_div(cases()).unwrap_or(1).max(1);
    // A step that shares no factor with the numbers of types and literals comes to all of them.
    let step = (step..).find(|step| [2, 3, 5, 7].iter().all(|factor| step % factor != 0)).unwrap_or(1);
    let some = all.into_iter().step_by(step);
    let mut wrong: Vec<String> = some.filter_map(|text| disagreement(&text)).collect();
    wrong.dedup();
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

fn unit(declared: &str, body: &str) -> String {
    format!("PROGRAM Main\nVAR\n{declared}\nEND_VAR\n{body}\nEND_PROGRAM\n")
}

#[test]
fn the_programs_of_all_pages_run() {
    let operators = Operator::all().map(|row| row.page());
    let functions = Function::all().map(|row| row.page());
    let blocks = FunctionBlock::all().map(|row| row.page());
    let program = |page: String| {
        page.split("```il\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap_or("").to_string()
    };
    assert_agree(operators.chain(functions).chain(blocks).map(program));
}

const LITERALS: &[&str] = &[
    "0",
    "1",
    "2",
    "-1",
    "255",
    "256",
    "-128",
    "32767",
    "65535",
    "70000",
    "16#FF",
    "2#1",
    "16#FFFF_FFFF",
    "1.5",
    "-0.5",
    "1.0E3",
    "TRUE",
    "FALSE",
    "BOOL#1",
    "BOOL#TRUE",
    "BYTE#1",
    "BYTE#16#FF",
    "WORD#3",
    "DWORD#3",
    "LWORD#3",
    "SINT#3",
    "INT#3",
    "DINT#3",
    "LINT#3",
    "USINT#3",
    "UINT#3",
    "UDINT#3",
    "ULINT#3",
    "REAL#3.0",
    "REAL#3",
    "LREAL#3.0",
    "T#1s",
    "TIME#1ms",
    "LTIME#1us",
    "D#2024-01-31",
    "TOD#12:00:00",
    "DT#2024-01-31-12:00:00",
    "'a'",
    "'abc'",
    "\"a\"",
    "STRING#'a'",
    "WSTRING#\"a\"",
    "CHAR#'a'",
];

#[test]
fn initial_values_agree() {
    let kinds = ElementaryType::ALL.into_iter();
    assert_agree(kinds.flat_map(|kind| {
        LITERALS
            .iter()
            .map(move |literal| unit(&format!("v : {kind} := {literal};\nb : BOOL;"), "LD b\nST b"))
    }));
}

#[test]
fn literals_and_variables_are_stored_alike() {
    let kinds = ElementaryType::ALL.into_iter();
    assert_agree(kinds.clone().flat_map(|kind| {
        LITERALS.iter().map(move |literal| unit(&format!("v : {kind};"), &format!("LD {literal}\nST v")))
    }));
    assert_agree(kinds.clone().flat_map(|kind| {
        let other = ElementaryType::ALL.into_iter();
        other.map(move |other| unit(&format!("v : {kind}; w : {other};"), "LD v\nST w"))
    }));
}

/// Types of every group.
const KINDS: [ElementaryType; 9] = [
    ElementaryType::Bool,
    ElementaryType::Byte,
    ElementaryType::Dword,
    ElementaryType::Sint,
    ElementaryType::Int,
    ElementaryType::Udint,
    ElementaryType::Real,
    ElementaryType::Time,
    ElementaryType::String,
];

#[test]
fn operators_agree() {
    let mut programs = Vec::new();
    for operator in ["ANDN", "XOR", "ADD", "MUL", "GT", "SUB("] {
        let close = if operator.ends_with('(') { ")\n" } else { "" };
        let mut pairs = Vec::new();
        for kind in KINDS {
            pairs.extend(LITERALS.iter().map(|literal| (kind, ElementaryType::Bool, *literal)));
            pairs.extend(KINDS.map(|other| (kind, other, "w")));
        }
        for (kind, other, operand) in pairs {
            let declared = format!("v : {kind}; w : {other}; o : BOOL;");
            let results = ["v", "o"].into_iter();
            programs.extend(
                results.map(|to| unit(&declared, &format!("LD v\n{operator} {operand}\n{close}ST {to}"))),
            );
        }
    }
    assert_agree(programs);
}

#[test]
fn functions_agree() {
    let mut programs = Vec::new();
    for function in Function::families() {
        let count = function.inputs.len() - 1;
        // What a function makes of literals alone that any type has is not looked at.
        let own = if matches!(function.name, "SEL" | "MUX") { &["w"][..] } else { &["w", "1"] };
        for (kind, other) in
            KINDS.into_iter().flat_map(|kind| [kind, ElementaryType::Int].map(|other| (kind, other)))
        {
            for operand in own {
                let operands = vec![*operand; count].join(", ");
                let declared = format!("v : {kind}; w : {other}; i : INT; o : BOOL;");
                let call = format!("LD v\n{} {operands}", function.name);
                programs.extend(["v", "o"].map(|to| unit(&declared, &format!("{call}\nST {to}"))));
            }
        }
    }
    assert_agree(programs);
}
