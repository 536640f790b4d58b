//! What becomes of each row of the FX instruction table in a list of IEC 61131-3.

use crate::round_trips::around;
use rungwise::document::{Document, Notation};
use rungwise::target::{Form, Model, Target, instructions};
use rungwise::translate::{KEPT, KEPT_FORMS, Options, To, translate};
use std::collections::{BTreeMap, BTreeSet};

/// Operands that IEC 61131-3 has words for, before those that it has not.
const WORDS: [&str; 12] = ["D10", "D20", "D30", "D40", "M10", "Y0", "K2", "X0", "S0", "P0", "N0", "I001"];

/// What has words with certain operands only: a divisor that is not 0, bounds in their order, so many words.
const CERTAIN: [(&str, &str); 3] = [("DIV", "D10 K7 D30"), ("ZCP", "K2 K5 D10 M10"), ("BMOV", "D10 D20 K2")];

/// An instruction with operands that it takes, each another one where there are several.
fn line(form: Form) -> Option<String> {
    let target = Target::of(Model::Fx3u);
    if let Some((_, operands)) = CERTAIN.iter().find(|(own, _)| *own == form.instruction.mnemonic) {
        return Some(format!("{} {operands}", form.mnemonic()));
    }
    let mut words = vec![form.mnemonic()];
    for (place, _) in form.instruction.operands.iter().enumerate().filter(|(_, spec)| !spec.optional) {
        let fits = |word: &&&str| {
            !words.contains(&word.to_string()) && form.takes(place, &target.read(word), Model::Fx3u)
        };
        let word = WORDS.iter().find(fits).copied().or_else(|| {
            ["K2", "D10", "T0", "S900", "C235", "\"AB\"", "E1.5", "K8", "K4M0", "K1Y0"]
                .into_iter()
                .find(|word| form.takes(place, &target.read(word), Model::Fx3u))
        });
        words.push(word?.to_string());
    }
    Some(words.join(" "))
}

/// For each mnemonic of the table with its forms, whether it is translated with certainty.
fn translated() -> BTreeMap<String, bool> {
    let mut found = BTreeMap::new();
    for form in instructions::forms_on(Model::Fx3u) {
        let line = line(form).unwrap_or_else(|| panic!("no operands for {}", form.mnemonic()));
        let rung = around(form, &line);
        let document = Document::new(&(rung + "END\n"), Notation::FxIl, Target::of(Model::Fx3u));
        let translation = translate(&document, None, To::Iec, &Options::default());
        let is_certain = translation.rungs.iter().all(|rung| !rung.is_kept && rung.note.is_none());
        found.insert(form.mnemonic(), is_certain && translation.is_certain());
    }
    found
}

#[test]
fn what_is_kept_of_the_table_is_what_is_said() {
    let expected: BTreeSet<String> = instructions::forms_on(Model::Fx3u)
        .filter(|form| KEPT.contains(&form.instruction.mnemonic))
        .map(Form::mnemonic)
        .chain(KEPT_FORMS.iter().map(|form| form.to_string()))
        .collect();
    let found: BTreeSet<String> =
        translated().into_iter().filter(|(_, known)| !known).map(|(name, _)| name).collect();
    assert_eq!(found, expected);
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/translation.md");
    let page = std::fs::read_to_string(page).unwrap();
    let (_, listed) = page.split_once("### What an FX list keeps").expect("the list");
    let listed = listed.split_once("\n## ").map_or(listed, |(own, _)| own);
    let words: BTreeSet<&str> =
        listed.split('`').skip(1).step_by(2).filter(|word| *word != "--prove").collect();
    assert_eq!(words, KEPT.iter().chain(KEPT_FORMS).copied().collect());
}
