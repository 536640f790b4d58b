//! SER and SORT: looking into tables, and ordering them.

use crate::target::semantics::COMPLETE;
use crate::target::{Execution, Fault};

pub(super) fn search(execution: &mut dyn Execution) -> Result<(), Fault> {
    let wanted = execution.value(1)?;
    let count = execution.value(3)?;
    let most = if execution.is_wide() { 128 } else { 256 };
    if !(1..=most).contains(&count) {
        return Err(Fault::Value(3));
    }
    let mut table = Vec::with_capacity(count as usize);
    for place in 0..count {
        table.push((execution.value_at(0, place)?, place));
    }
    let equal = || table.iter().filter(|(value, _)| *value == wanted).map(|(_, place)| *place);
    let results = [
        equal().count() as i64,
        equal().next().unwrap_or(0),
        equal().next_back().unwrap_or(0),
        // Of several smallest or largest values the last one counts.
        table.iter().min_by_key(|(value, place)| (*value, -place)).map_or(0, |(_, place)| *place),
        table.iter().max().map_or(0, |(_, place)| *place),
    ];
    // The last one first: if it is there, all of them are.
    for (place, result) in results.into_iter().enumerate().rev() {
        execution.put_at(2, place as i64, result)?;
    }
    Ok(())
}

pub(super) fn sort(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        if execution.is_left() {
            execution.set_relay(COMPLETE, false);
        }
        return Ok(());
    }
    let rows = execution.count(1, 1, 32)?;
    let columns = execution.count(2, 1, 6)?;
    let key = execution.count(4, 1, columns)? - 1;
    let scan = execution.noted(0) + 1;
    if scan == rows {
        let mut table = Vec::with_capacity((rows * columns) as usize);
        for place in 0..rows * columns {
            table.push(execution.word(0, place)?);
        }
        let value = |row: i64, column: i64| table.get((column * rows + row) as usize).copied().unwrap_or(0);
        let mut order: Vec<i64> = (0..rows).collect();
        order.sort_by_key(|row| value(*row, key));
        execution.word(3, rows * columns - 1)?;
        for column in 0..columns {
            for (to, row) in (0..).zip(&order) {
                execution.set_word(3, column * rows + to, value(*row, column))?;
            }
        }
    }
    execution.note(0, scan.min(rows + 1));
    execution.set_relay(COMPLETE, scan >= rows);
    Ok(())
}
