//! The simulated PLC with programs of IEC 61131-3: nanoseconds for each operator.

use super::figures::{Figures, Table};
use rungwise::document::{Document, Notation};
use rungwise::simulate::{Machine, Value, compile};
use rungwise::target::{Model, Target};
use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

const MS: i64 = 1_000_000;
const RUNGS: usize = 10_000;

pub fn measure(table: &Table) {
    let rows = [
        ("simulated IEC 61131-3, 10,000 rungs of BOOLs", "< 1.5 ns", Every::Bit),
        ("simulated IEC 61131-3, one rung in five calls a TON", "< 5 ns", Every::Timer),
        ("simulated IEC 61131-3, one rung in five calculates with INTs", "< 10 ns", Every::Word),
        (
            "simulated IEC 61131-3, 10,000 lines of three INT operators and a store",
            "< 30 ns",
            Every::Calculation,
        ),
    ];
    for (name, target, every) in rows.into_iter().filter(|(name, ..)| table.wants(name)) {
        per_operator(table, name, target, &program(every));
    }
    first_scan(table);
}

/// What besides contacts and coils a program has.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Every {
    Bit,
    /// A timer in every fifth rung.
    Timer,
    /// A calculation in every fifth rung.
    Word,
    /// Nothing but calculations.
    Calculation,
}

/// Instruction list of [`RUNGS`] rungs with six operators each, of calculations four.
fn program(every: Every) -> String {
    const BITS: u64 = 7_000;
    const WORDS: u64 = 1_000;
    const TIMERS: u64 = 500;
    // Numbers that look as if thrown, the same in every run.
    let mut state = 88_172_645_463_325_252u64;
    let mut random = move |below: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state % below
    };
    let mut text = String::from("PROGRAM Main\nVAR\n");
    (0..20).for_each(|number| _ = writeln!(text, "i{number} AT %IX{}.{} : BOOL;", number / 8, number % 8));
    (0..BITS).for_each(|number| _ = writeln!(text, "b{number} : BOOL;"));
    (0..WORDS).for_each(|number| _ = writeln!(text, "n{number} : INT := {number};"));
    (0..TIMERS).for_each(|number| _ = writeln!(text, "t{number} : TON;"));
    text += "END_VAR\n";
    for rung in 0..RUNGS {
        let mut relay = || match random(4) {
            0 => format!("i{}", random(20)),
            _ => format!("b{}", random(BITS)),
        };
        let [a, b, c, d, e] = [relay(), relay(), relay(), relay(), relay()];
        let [m, n, to] = [random(WORDS), random(WORDS), random(WORDS)];
        let is_special = rung % 5 == 0;
        let _ = match every {
            Every::Calculation => writeln!(text, "LD n{m}\nADD n{n}\nDIV 3\nST n{to}"),
            Every::Word if is_special => {
                writeln!(text, "LD n{m}\nADD n{n}\nDIV 3\nST n{to}\nGT 100\nST b{}", random(BITS))
            }
            Every::Timer if is_special => {
                let timer = random(TIMERS);
                writeln!(
                    text,
                    "LD {a}\nANDN {b}\nST t{timer}.IN\nCAL t{timer}(PT := T#200ms)\nLD t{timer}.Q\nST {c}"
                )
            }
            _ => {
                let orders = [
                    format!("LD {a}\nAND {b}\nOR {c}\nANDN {d}\nAND {e}\n"),
                    format!("LDN {a}\nAND {b}\nOR( {c}\nAND {d}\n)\n"),
                    format!("LD {a}\nORN {b}\nAND {c}\nOR {d}\nANDN {e}\n"),
                    format!("LD {a}\nAND( {b}\nOR {c}\n)\nAND {d}\n"),
                ];
                writeln!(text, "{}ST b{}", orders[random(4) as usize], rung as u64 % BITS)
            }
        };
    }
    text + "END_PROGRAM\n"
}

fn document(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

fn machine(document: &Document) -> Machine<u8> {
    match compile(&[document], false) {
        Ok(code) => Machine::new(Arc::new(code)),
        Err(problems) => panic!("{:?}", problems.first()),
    }
}

fn per_operator(table: &Table, name: &str, target: &str, text: &str) {
    let mut machine = machine(&document(text));
    let code = Arc::clone(machine.code());
    let inputs: Vec<_> = (0..20).filter_map(|number| code.variable(&format!("i{number}"))).collect();
    let figures = Figures::of(500, |scan| {
        for (number, input) in inputs.iter().enumerate() {
            machine.write(*input, &Value::Bit((scan >> (number % 5)) & 1 == 1));
        }
        let started = Instant::now();
        machine.scan(scan as i64 * 10 * MS);
        started.elapsed()
    });
    let [median, p95] =
        [50, 95].map(|percent| figures.percentile(percent).as_secs_f64() * 1e9 / code.instructions() as f64);
    table.value(name, target, &format!("{median:.3} ns an operator, p95 {p95:.3}"));
}

/// From the document, as an editor has it, to the end of the first scan.
fn first_scan(table: &Table) {
    let name = "simulated IEC 61131-3, from pressing start to the end of the first scan";
    if !table.wants(name) {
        return;
    }
    let document = document(&program(Every::Timer));
    let figures = Figures::of(20, |_| {
        let started = Instant::now();
        machine(&document).scan(0);
        started.elapsed()
    });
    table.row(
        "simulated IEC 61131-3, from pressing start to the end of the first scan",
        "< 200 ms",
        &figures,
    );
}
