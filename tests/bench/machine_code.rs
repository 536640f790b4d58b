//! Machine code of a program that fills the memory of an FX2N, both ways.

use super::figures::{Figures, Table};
use rungwise::machine_code::{decode, encode};
use rungwise::target::{Model, Target};
use std::time::Instant;

pub fn measure(table: &Table) {
    let target = Target::of(Model::Fx2n);
    let list = program(8_000);
    let words = encode(&list, target).expect("the program has machine code").words;
    let of = |what: &str| format!("machine code, {} steps, {what}", words.len());
    timed(table, &of("encode, from the text on"), || _ = encode(&list, target));
    timed(table, &of("decode to text"), || _ = decode(&words, Model::Fx2n));
    // Words that are no program are the slowest to read: each is tried anew.
    let odd: Vec<u16> = words.iter().map(|word| word ^ 0x0155).collect();
    timed(table, &of("decode of a damaged program"), || _ = decode(&odd, Model::Fx2n));
}

fn timed(table: &Table, name: &str, mut event: impl FnMut()) {
    if !table.wants(name) {
        return;
    }
    let figures = Figures::of(200, |_| {
        let started = Instant::now();
        event();
        started.elapsed()
    });
    table.row(name, "< 2 ms", &figures);
}

/// Instruction list that fills so many steps, contacts and coils mostly, with timers and instructions of 16 and 32 bits.
fn program(steps: usize) -> String {
    const RUNG_STEPS: usize = 4 + 4 + 5 + 5 + 2 + 13;
    let rung = |number: usize| {
        let (x, m, d) = (number % 128, number % 1500, number % 7000);
        format!(
            "LD X{x:o}\nOR M{m}\nANI X{:o}\nOUT M{m}\nLD M{m}\nOUT T{} K{d}\nLD> D{d} K100\nMOV K4M{m} D{d}\n\
             LDP M{m}\nDADD D{d} K70000 D{}\n",
            number % 64,
            number % 200,
            d + 2,
        )
    };
    (0..(steps - 1) / RUNG_STEPS).map(rung).collect::<String>() + "END\n"
}
