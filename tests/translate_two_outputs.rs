//! The equations of rungs with two outputs: an output may change what the next one is driven by.

use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::translate::{Certificate, Options, To, from_boolean, translate};
use std::collections::BTreeMap;

type Bits = BTreeMap<String, bool>;

/// One scan of a list of contacts, blocks and coils.
fn scan(text: &str, bits: &mut Bits) {
    let (mut stack, mut kept): (Vec<bool>, Vec<bool>) = (Vec::new(), Vec::new());
    // Behind an output the next load begins a new rung.
    let mut has_driven = false;
    for line in text.lines() {
        let (word, operand) = line.split_once(' ').unwrap_or((line, ""));
        let bit = bits.get(operand).copied().unwrap_or_else(|| operand == "M8000");
        let top = stack.last().copied().unwrap_or_default();
        let mut put = |value: bool| *stack.last_mut().expect("a block") = value;
        match word {
            "LD" | "LDI" => {
                if std::mem::take(&mut has_driven) {
                    stack.clear();
                }
                stack.push(bit == (word == "LD"));
            }
            "AND" => put(top && bit),
            "ANI" => put(top && !bit),
            "OR" => put(top || bit),
            "ORI" => put(top || !bit),
            "INV" => put(!top),
            "ANB" | "ORB" => {
                let other = stack.pop().expect("a block");
                let own = stack.last_mut().expect("a block");
                *own = if word == "ANB" { *own && other } else { *own || other };
            }
            "MPS" => kept.push(top),
            "MRD" => put(*kept.last().expect("a branch")),
            "MPP" => put(kept.pop().expect("a branch")),
            "OUT" => _ = bits.insert(operand.to_string(), top),
            "SET" if top => _ = bits.insert(operand.to_string(), true),
            "RST" if top => _ = bits.insert(operand.to_string(), false),
            "SET" | "RST" | "END" => {}
            other => panic!("{other}"),
        }
        has_driven |= matches!(word, "OUT" | "SET" | "RST");
    }
}

/// Whether two lists do the same in two scans, whatever the inputs and the state before.
fn are_alike(left: &str, right: &str) -> bool {
    const NAMES: [&str; 4] = ["X0", "X1", "Y0", "Y1"];
    (0..1u32 << 6).all(|values| {
        let start = || -> Bits {
            let bits = NAMES.iter().enumerate();
            bits.map(|(place, name)| (name.to_string(), values >> place & 1 == 1)).collect()
        };
        let sides = [left, right].map(|text| {
            let mut bits = start();
            scan(text, &mut bits);
            let first = bits.clone();
            bits.insert("X0".into(), values >> 4 & 1 == 1);
            bits.insert("X1".into(), values >> 5 & 1 == 1);
            scan(text, &mut bits);
            (first, bits)
        });
        sides[0] == sides[1]
    })
}

#[test]
fn equations_of_rungs_with_two_outputs_do_the_same() {
    let contacts = || ["X0", "Y0", "Y1"].into_iter().flat_map(|bit| [("", bit), ("I", bit)]);
    let mut kept = 0;
    let mut seconds = vec![String::new()];
    for (inverted, bit) in contacts() {
        seconds.push(format!("{} {bit}\n", if inverted.is_empty() { "AND" } else { "ANI" }));
        seconds.push(format!("OR{inverted} {bit}\n"));
    }
    for (inverted, bit) in contacts() {
        for second in &seconds {
            for between in ["", "AND X1\n", "AND Y0\n", "ANI Y0\n", "ANI Y1\n"] {
                for first in ["OUT Y0", "SET Y0", "RST Y0"] {
                    let text = format!("LD{inverted} {bit}\n{second}{first}\n{between}OUT Y1\nEND\n");
                    let document = Document::new(&text, Notation::FxIl, Target::of(Model::Fx3u));
                    let found = translate(&document, None, To::Boolean, &Options::default());
                    let is_sure =
                        found.rungs.iter().all(|rung| rung.certificate.is_some_and(Certificate::is_certain));
                    if !is_sure {
                        assert!(!first.starts_with("OUT"), "{text}\n{}", found.text);
                        kept += 1;
                        continue;
                    }
                    let back = from_boolean::list(&found.text, Target::of(Model::Fx3u)).expect("equations");
                    assert!(are_alike(&text, &back), "{text}\n{}\n{back}", found.text);
                }
            }
        }
    }
    // Of a latch nobody can go on from.
    assert!(kept > 0);
}

#[test]
fn an_output_that_locks_itself_goes_on_to_the_next() {
    let text = "LD X0\nANI Y0\nOUT Y0\nAND X1\nOUT Y1\nEND\n";
    let document = Document::new(text, Notation::FxIl, Target::of(Model::Fx3u));
    let found = translate(&document, None, To::Boolean, &Options::default());
    assert_eq!(found.text, "Y0 = X0*[Y0]\nY1 = Y0*X1\nEND\n");
    // Where nothing changes, equations stay as they are drawn.
    let text = "LD X0\nOR Y0\nANI X1\nOUT Y0\nAND X2\nOUT Y1\nEND\n";
    let document = Document::new(text, Notation::FxIl, Target::of(Model::Fx3u));
    let found = translate(&document, None, To::Boolean, &Options::default());
    assert_eq!(found.text, "Y0 = (X0 + Y0)*[X1]\nY1 = (X0 + Y0)*[X1]*X2\nEND\n");
}
