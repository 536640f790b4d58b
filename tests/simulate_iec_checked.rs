//! What is checked without an error can be simulated.

use crate::rules_sense::without_sense;
use crate::simulate_iec::document;
use rungwise::check;
use rungwise::document::{Document, Notation};
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
            Some(format!("{line}: {}", problem.obstacle.message().render(Language::English)))
        }
    }
}

fn assert_agree(programs: impl IntoIterator<Item = String>) {
    let mut wrong: Vec<String> = programs.into_iter().filter_map(|text| disagreement(&text)).collect();
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
    "0", "1", "2", "-1", "255", "256", "-128", "32767", "65535", "70000", "16#FF", "2#1", "16#FFFF_FFFF", "1.5",
    "-0.5", "1.0E3", "TRUE", "FALSE", "BOOL#1", "BOOL#TRUE", "BYTE#1", "BYTE#16#FF", "WORD#3", "DWORD#3", "LWORD#3",
    "SINT#3", "INT#3", "DINT#3", "LINT#3", "USINT#3", "UINT#3", "UDINT#3", "ULINT#3", "REAL#3.0", "REAL#3",
    "LREAL#3.0", "T#1s", "TIME#1ms", "LTIME#1us", "D#2024-01-31", "TOD#12:00:00", "DT#2024-01-31-12:00:00", "'a'",
    "'abc'", "\"a\"", "STRING#'a'", "WSTRING#\"a\"", "CHAR#'a'",
];

#[test]
fn initial_values_agree() {
    let kinds = ElementaryType::ALL.into_iter();
    assert_agree(kinds.flat_map(|kind| {
        LITERALS.iter().map(move |literal| unit(&format!("v : {kind} := {literal};\nb : BOOL;"), "LD b\nST b"))
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

#[test]
fn operators_agree() {
    let operators = ["AND", "ANDN", "OR", "XOR", "ADD", "SUB", "MUL", "DIV", "MOD", "GT", "EQ", "NE", "ADD("];
    let kinds = ElementaryType::ALL.into_iter();
    assert_agree(kinds.clone().flat_map(|kind| {
        operators.into_iter().flat_map(move |operator| {
            let operands = LITERALS.iter().map(|literal| literal.to_string());
            operands.chain(ElementaryType::ALL.into_iter().map(|_| "w".to_string())).zip(0..).flat_map(
                move |(operand, number): (String, usize)| {
                    let other = ElementaryType::ALL[number % ElementaryType::ALL.len()];
                    let close = if operator.ends_with('(') { ")\n" } else { "" };
                    ["v", "o", "x"].map(|result| {
                        unit(
                            &format!("v : {kind}; w : {other}; o : BOOL; x : {other};"),
                            &format!("LD v\n{operator} {operand}\n{close}ST {result}"),
                        )
                    })
                },
            )
        })
    }));
}

#[test]
fn functions_agree() {
    let kinds = [
        ElementaryType::Bool, ElementaryType::Byte, ElementaryType::Int, ElementaryType::Udint, ElementaryType::Real,
        ElementaryType::Time, ElementaryType::String, ElementaryType::Word, ElementaryType::Lreal,
    ];
    assert_agree(Function::families().flat_map(|function| {
        kinds.into_iter().flat_map(move |kind| {
            kinds.into_iter().flat_map(move |other| {
                let count = function.inputs.len();
                let others: Vec<&str> = ["w", "w", "w", "w"][..count - 1].to_vec();
                let literals: Vec<&str> = ["2", "1", "1", "1"][..count - 1].to_vec();
                let declared = format!("v : {kind}; w : {other}; i : INT; o : BOOL;");
                [others, literals].into_iter().flat_map(move |operands| {
                    let call = format!("LD v\n{} {}", function.name, operands.join(", "));
                    ["v", "w", "i", "o"].map(|result| unit(&declared, &format!("{call}\nST {result}")))
                }).collect::<Vec<_>>()
            })
        })
    }));
}
