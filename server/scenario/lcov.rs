//! Coverage in the form of `lcov`, which editors and build servers read: a contact is a condition with two branches.

use super::Coverage;
use crate::document::Document;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A tracefile of `geninfo` (see its manual page, "TRACEFILE FORMAT"). `files` are the documents of the program with
/// the paths by which they are found.
///
/// `DA` counts how often what stands in a line was evaluated. The branches of a line are those of its contacts from
/// left to right, first off, then on.
pub fn lcov(coverage: &Coverage, files: &[(String, &Document)]) -> String {
    let mut text = String::new();
    for (number, (path, document)) in (0..).zip(files) {
        let line = |offset: u32| document.line_of(offset as usize) + 1;
        let mut lines: BTreeMap<u32, u64> = BTreeMap::new();
        let mut branches: BTreeMap<u32, Vec<(u64, u64)>> = BTreeMap::new();
        for rung in coverage.rungs().filter(|rung| rung.document == number) {
            lines.entry(line(rung.span.start)).or_insert(rung.evaluated);
            for contact in &rung.contacts {
                let count = contact.on + contact.off;
                let own = lines.entry(line(contact.span.start)).or_insert(count);
                *own = (*own).max(count);
                branches.entry(line(contact.span.start)).or_default().push((contact.off, contact.on));
            }
        }
        let _ = writeln!(text, "TN:\nSF:{path}");
        for (line, contacts) in &branches {
            for (block, (off, on)) in contacts.iter().enumerate() {
                for (branch, count) in [off, on].into_iter().enumerate() {
                    // Of what was never evaluated nothing is known.
                    let taken = if off + on == 0 { "-".to_string() } else { count.to_string() };
                    let _ = writeln!(text, "BRDA:{line},{block},{branch},{taken}");
                }
            }
        }
        let all = branches.values().flatten().flat_map(|(off, on)| [off, on]);
        let hit = all.clone().filter(|count| **count > 0).count();
        let _ = writeln!(text, "BRF:{}\nBRH:{hit}", all.count());
        for (line, count) in &lines {
            let _ = writeln!(text, "DA:{line},{count}");
        }
        let hit = lines.values().filter(|count| **count > 0).count();
        let _ = writeln!(text, "LF:{}\nLH:{hit}\nend_of_record", lines.len());
    }
    text
}
