//! A PLC of a few lines, to have an answer that owes nothing to the product: it runs the text of an FX instruction list
//! with two stacks of bits, as the programming manuals describe them.

use std::collections::BTreeMap;

/// The bits of the PLC by name.
pub type Bits = BTreeMap<String, bool>;

/// One scan over `list`: OUT, SET and RST change `bits`, edges compare them with `before`. Returns what was written, in
/// order.
pub fn scan(list: &str, bits: &mut Bits, before: &Bits) -> Vec<(String, bool)> {
    let (mut results, mut kept): (Vec<bool>, Vec<bool>) = (Vec::new(), Vec::new());
    let mut written = Vec::new();
    let mut drove = true;
    for line in list.lines().map(|line| line.split(';').next().unwrap_or("").trim()) {
        let mut words = line.split_whitespace();
        let Some(mnemonic) = words.next() else { continue };
        let device = words.next().unwrap_or("");
        let value = |bits: &Bits| bits.get(device).copied().unwrap_or(false);
        let was = before.get(device).copied().unwrap_or(value(bits));
        let contact = |kind: &str, bits: &Bits| match kind {
            "I" => !value(bits),
            "P" => value(bits) && !was,
            "F" => !value(bits) && was,
            _ => value(bits),
        };
        let drives = matches!(mnemonic, "OUT" | "SET" | "RST");
        // A load behind an output begins a rung, unless so many blocks are joined that one of them is what led to it.
        if drove && kept.is_empty() && mnemonic.starts_with("LD") && begins_rung(&list[offset(list, line)..])
        {
            results.clear();
        }
        match mnemonic {
            "LD" | "LDI" | "LDP" | "LDF" => results.push(contact(&mnemonic[2..], bits)),
            "AND" | "ANI" | "ANDP" | "ANDF" => {
                let kind = match mnemonic {
                    "ANI" => "I",
                    _ => &mnemonic[3..],
                };
                let own = contact(kind, bits);
                *results.last_mut().expect("a current result") &= own;
            }
            "OR" | "ORI" | "ORP" | "ORF" => {
                let own = contact(&mnemonic[2..], bits);
                *results.last_mut().expect("a current result") |= own;
            }
            "ANB" | "ORB" => {
                let upper = results.pop().expect("a block");
                let lower = results.last_mut().expect("two blocks");
                *lower = if mnemonic == "ANB" { *lower && upper } else { *lower || upper };
            }
            "INV" => {
                let result = results.last_mut().expect("a current result");
                *result = !*result;
            }
            "MPS" => kept.push(*results.last().expect("a current result")),
            "MRD" | "MPP" => {
                *results.last_mut().expect("a current result") = *kept.last().expect("a kept result");
                if mnemonic == "MPP" {
                    kept.pop();
                }
            }
            "OUT" | "SET" | "RST" => {
                assert_eq!(results.len(), 1, "a block is open at {line}\n{list}");
                let result = results[0];
                match mnemonic {
                    "OUT" => {
                        bits.insert(device.to_string(), result);
                        written.push((device.to_string(), result));
                    }
                    _ if result => {
                        bits.insert(device.to_string(), mnemonic == "SET");
                        written.push((device.to_string(), mnemonic == "SET"));
                    }
                    _ => {}
                }
            }
            "END" => break,
            other => panic!("no {other} in this PLC"),
        }
        drove = drives;
    }
    assert!(kept.is_empty(), "a branch is open\n{list}");
    written
}

/// Where `line`, a piece of `list`, starts.
fn offset(list: &str, line: &str) -> usize {
    line.as_ptr() as usize - list.as_ptr() as usize
}

/// Whether the blocks that are loaded from here to the next output are one more than the joins.
fn begins_rung(rest: &str) -> bool {
    let mnemonics = rest.lines().filter_map(|line| line.split_whitespace().next());
    let until_output = mnemonics.take_while(|word| !matches!(*word, "OUT" | "SET" | "RST" | "MPS" | "END"));
    let mut open = 0;
    for word in until_output {
        open += i32::from(word.starts_with("LD")) - i32::from(matches!(word, "ANB" | "ORB"));
    }
    open > 0
}
