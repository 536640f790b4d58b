//! The simulated PLC: nanoseconds for each instruction, and what it takes to start and to look back.

use super::figures::{Figures, Table, milliseconds};
use rungwise::document::{Document, Notation};
use rungwise::simulate::{Code, Lanes, Machine, Session, Touch, Value, Variable, compile, power_flow};
use rungwise::target::{Device, DeviceKind, Model, Target};
use std::fmt::Write;
use std::sync::Arc;
use std::time::{Duration, Instant};

const MS: i64 = 1_000_000;

pub fn measure(table: &Table) {
    if !["simulated", "simulation"].iter().any(|word| table.wants(word)) {
        return;
    }
    let mixed = code(&program(10_000, Shapes::Mixed));
    let uniform = code(&program(10_000, Shapes::Uniform));
    let words = code(&program(10_000, Shapes::Words));
    let scans = |name: &str, target: &str, code: &Arc<Code>| per_instruction(table, name, target, code);
    let one = scans("simulated, 10,000 rungs of mixed shapes", "< 1.5 ns", &mixed);
    let other = scans("simulated, 10,000 rungs of one shape", "", &uniform);
    table.value("simulated, mixed over uniform", "< 1.3", &format!("{:.2}", one / other));
    scans("simulated, one rung in five ends in a timer, counter, MOV, ADD, SUB or CMP", "< 2.5 ns", &words);
    side_by_side(table, "simulated, 64 scenarios at once, mixed shapes", "< 0.03 ns", &mixed);
    side_by_side(table, "simulated, 64 scenarios at once, timers and words", "", &words);
    first_scan(table);
    with_history(table, one, &mixed);
    a_day(table);
    a_screen(table);
}

/// What rungs a program has.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Shapes {
    /// Six instructions in ten different orders.
    Mixed,
    /// Six instructions, always the same.
    Uniform,
    /// As mixed, but every fifth rung ends in a timer, a counter, a move, a calculation or a comparison.
    Words,
}

/// Instruction list of so many rungs with six instructions each.
pub fn program(rungs: usize, shapes: Shapes) -> String {
    // Numbers that look as if thrown, the same in every run.
    let mut state = 88_172_645_463_325_252u64;
    let mut random = move |below: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state % below
    };
    let mut text = String::new();
    for rung in 0..rungs {
        let mut relay = || match random(4) {
            0 => format!("X{:o}", random(64)),
            _ => format!("M{}", random(7_000)),
        };
        let [a, b, c, d, e] = [relay(), relay(), relay(), relay(), relay()];
        let shape = if shapes == Shapes::Uniform { 0 } else { random(10) };
        text += &match shape {
            0 => format!("LD {a}\nAND {b}\nOR {c}\nANI {d}\nAND {e}\n"),
            1 => format!("LD {a}\nOR {b}\nOR {c}\nANI {d}\nANI {e}\n"),
            2 => format!("LDI {a}\nAND {b}\nLD {c}\nAND {d}\nORB\n"),
            3 => format!("LD {a}\nLD {b}\nOR {c}\nANB\nAND {d}\n"),
            4 => format!("LD {a}\nAND {b}\nAND {c}\nAND {d}\nAND {e}\n"),
            5 => format!("LD {a}\nORI {b}\nAND {c}\nOR {d}\nANI {e}\n"),
            6 => format!("LD {a}\nOR {b}\nLDI {c}\nOR {d}\nANB\n"),
            7 => format!("LD {a}\nAND {b}\nINV\nAND {c}\nOR {d}\n"),
            8 => format!("LDI {a}\nORI {b}\nAND {c}\nAND {d}\nOR {e}\n"),
            _ => format!("LD {a}\nANI {b}\nOR {c}\nANI {d}\nOR {e}\n"),
        };
        let (turn, from, to) = (rung / 40, rung % 400, 400 + rung % 600);
        let _ = match (shapes, rung % 40) {
            (Shapes::Words, 0) => writeln!(text, "OUT T{} K20", turn % 200),
            (Shapes::Words, 5) => writeln!(text, "MOV D{from} D{to}"),
            (Shapes::Words, 10) => writeln!(text, "OUT C{} K20", turn % 200),
            (Shapes::Words, 15) => writeln!(text, "ADD D{from} K3 D{to}"),
            (Shapes::Words, 20) => writeln!(text, "OUT T{} D{}", 200 + turn % 40, rung % 100),
            (Shapes::Words, 25) => writeln!(text, "CMP D{to} K100 M{}", 7_000 + turn % 200 * 3),
            (Shapes::Words, 30) => writeln!(text, "MOV K{} D{from}", turn % 3000),
            (Shapes::Words, 35) => writeln!(text, "SUB D{to} D{from} D{to}"),
            _ => writeln!(text, "OUT M{}", rung % 7_000),
        };
    }
    text + "END\n"
}

fn open(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::of(Model::Fx3u))
}

fn code(text: &str) -> Arc<Code> {
    match compile(&[&open(text)], false) {
        Ok(code) => Arc::new(code),
        Err(problems) => panic!("{:?}", problems.first()),
    }
}

fn input(number: u32) -> Device {
    Device::new(DeviceKind::X, number)
}

/// The first sixty inputs as variables of a program.
fn inputs(code: &Code) -> Vec<Variable> {
    let variable = |number| code.variable(&input(number).to_string()).expect("an input");
    (0..60).map(variable).collect()
}

/// Twenty inputs change in each scan.
fn flip<L: Lanes>(machine: &mut Machine<L>, scan: usize) {
    for number in 0..20 {
        machine.set(input(number * 3), L::all((scan >> (number % 5)) & 1 == 1));
    }
}

/// Prints and gives the nanoseconds for each instruction.
fn per_instruction(table: &Table, name: &str, target: &str, code: &Arc<Code>) -> f64 {
    let mut machine: Machine<u8> = Machine::new(Arc::clone(code));
    let figures = Figures::of(2_000, |scan| {
        flip(&mut machine, scan);
        let started = Instant::now();
        machine.scan(scan as i64 * 10 * MS);
        started.elapsed()
    });
    let [median, p95] = [50, 95].map(|percent| nanoseconds(figures.percentile(percent), code.instructions()));
    let shown = format!("{median:.3} ns an instruction, p95 {p95:.3}");
    table.value(name, target, &shown);
    median
}

fn nanoseconds(duration: Duration, parts: usize) -> f64 {
    duration.as_secs_f64() * 1e9 / parts as f64
}

fn side_by_side(table: &Table, name: &str, target: &str, code: &Arc<Code>) {
    let mut machine: Machine<u64> = Machine::new(Arc::clone(code));
    let figures = Figures::of(500, |scan| {
        for number in 0..20u32 {
            machine.set(
                input(number * 3),
                (scan as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(number),
            );
        }
        let started = Instant::now();
        machine.scan(scan as i64 * 10 * MS);
        started.elapsed()
    });
    let each = nanoseconds(figures.percentile(50), code.instructions() * 64);
    table.value(name, target, &format!("{each:.4} ns an instruction and scenario"));
}

/// From the document, as an editor has it, to the end of the first scan.
fn first_scan(table: &Table) {
    let document = open(&program(10_000, Shapes::Words));
    let figures = Figures::of(20, |_| {
        let started = Instant::now();
        let code = compile(&[&document], false).unwrap_or_else(|_| panic!("a program"));
        let mut machine: Machine<u8> = Machine::new(Arc::new(code));
        machine.scan(0);
        started.elapsed()
    });
    table.row("simulated, from pressing start to the end of the first scan", "< 20 ms", &figures);
}

fn with_history(table: &Table, without: f64, code: &Arc<Code>) {
    let mut session = Session::new(Arc::clone(code));
    let inputs = inputs(code);
    let started = Instant::now();
    let scans = 4_000;
    for scan in 0..scans {
        for number in 0..20 {
            let on = (scan >> (number % 5)) & 1 == 1;
            session.touch(Touch::Write(inputs[number * 3], Value::Bit(on)));
        }
        session.scan(scan as i64 * 10 * MS);
    }
    let each = nanoseconds(started.elapsed(), code.instructions() * scans);
    table.value("simulated, with history over without", "< 2", &format!("{:.2}", each / without));
    let figures = Figures::of(20, |round| {
        let started = Instant::now();
        std::hint::black_box(session.at(4_000 - 100 * (round as u64 % 30) - 1));
        started.elapsed()
    });
    table.row("simulated, back to a scan of the last thousands", "", &figures);
}

/// A day of a program of a hundred rungs with timers, at 10 ms a scan.
fn a_day(table: &Table) {
    let code = code(&program(100, Shapes::Words));
    let inputs = inputs(&code);
    let mut session = Session::new(code);
    let scans = 24 * 60 * 60 * 100;
    let (started, used) = (Instant::now(), cpu_time::ThreadTime::now());
    for scan in 0..scans {
        if scan % 500 == 0 {
            session.touch(Touch::Write(inputs[scan / 500 % 60], Value::Bit(scan / 500 % 2 == 0)));
        }
        session.scan(scan as i64 * 10 * MS);
    }
    table.value(
        "simulated, a day of 100 rungs at 10 ms, with history",
        "< 10 s",
        &format!("{}, processor {}", milliseconds(started.elapsed()), milliseconds(used.elapsed())),
    );
}

/// What painting a screen of 200 rows takes of a core, at 30 pictures a second.
fn a_screen(table: &Table) {
    let document = open(&program(10_000, Shapes::Words));
    let make =
        |is_watched| Arc::new(compile(&[&document], is_watched).unwrap_or_else(|_| panic!("a program")));
    let watched = make(true);
    let mut session = Session::new(make(false));
    let window = 300_000..302_400;
    let shown = watched.instructions_in(0, window.clone());
    let mut scan = 0;
    let figures = Figures::of(300, |_| {
        let mut now = || {
            scan += 1;
            scan * 10 * MS
        };
        session.scan(now());
        session.scan(now());
        let started = Instant::now();
        session.scan(now());
        let plain = started.elapsed();
        let started = Instant::now();
        let mut sights = Vec::new();
        session.scan_seen(now(), &watched, |sight| {
            if shown.contains(&sight.instruction) {
                sights.push(sight);
            }
        });
        std::hint::black_box(power_flow(&document, 0, &watched, &sights, window.clone()));
        // The scan itself had to be run anyway.
        started.elapsed().saturating_sub(plain)
    });
    table.row("simulation, a picture of 200 rows of 10,000 rungs", "< 3.3 ms", &figures);
}
