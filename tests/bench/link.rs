//! The programming port: how much longer things take than the bytes that must travel, and what the computer has to do.

use super::figures::{Figures, Table, milliseconds};
use super::line_time::{LineTime, download, look, program, stretches, three_changed};
use cpu_time::ProcessTime;

pub fn measure(table: &Table) {
    if !table.wants("programming port") {
        return;
    }
    let [before, after] = [0, 1].map(program);
    let changed = three_changed(&before);
    let blank = [0x000F];
    table_row(table, "first download of 4,000 steps", &download(&blank, &before, &[before.len()]));
    table_row(table, "4,000 steps for 4,000 others", &download(&before, &after, &stretches(&before, &after)));
    table_row(table, "3 words of 4,000 steps changed", &download(&before, &changed, &[1, 1, 1]));
    table_row(table, "a look at 50 relays and 50 registers", &look());
    let processor = Figures::of(9, |_| {
        let started = ProcessTime::now();
        download(&before, &after, &[]);
        started.elapsed()
    });
    table.row("programming port, processor time of both ends for 4,000 steps", "", &processor);
}

fn table_row(table: &Table, what: &str, time: &LineTime) {
    let took = milliseconds(time.took);
    let value = format!("{took} on the line, {:.3} of {}", time.ratio(), milliseconds(time.least));
    table.value(&format!("programming port, {what}"), "≤ 1.1", &value);
}
