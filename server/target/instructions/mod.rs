//! The instruction table of the FX family, one file for each family of instructions.

use super::{Form, Instruction, Model, Wide};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

pub mod specs;

mod steps;
pub(super) use steps::steps;

mod places;
pub(super) use places::placed;

mod suggest;
pub use suggest::suggestions;
pub(super) use suggest::{MOST_LETTERS, distance_within};

mod contacts;

mod blocks;

mod outputs;

mod control;

mod program;
pub use program::{LABEL, UNREAD};

mod flow;

mod compare;

mod moves;

mod arithmetic;

mod shift;

mod data;

mod motion;

mod high_speed;

mod handy;

mod external;

mod serial;

mod floats;

mod positioning;

mod clock;

mod gray_and_analog;

mod contact_compare;

/// The families in the order of the manual.
static FAMILIES: &[&[Instruction]] = &[
    contacts::ROWS,
    blocks::ROWS,
    outputs::ROWS,
    control::ROWS,
    program::ROWS,
    flow::ROWS,
    compare::ROWS,
    moves::ROWS,
    arithmetic::ROWS,
    shift::ROWS,
    data::ROWS,
    high_speed::ROWS,
    handy::ROWS,
    external::ROWS,
    serial::ROWS,
    floats::ROWS,
    positioning::ROWS,
    clock::ROWS,
    gray_and_analog::ROWS,
    contact_compare::ROWS,
];

/// Every row, in the order of the manual.
pub fn all() -> impl Iterator<Item = &'static Instruction> {
    FAMILIES.iter().copied().flatten()
}

/// Every form that `model` has, for completion and keyword lists, in the order of the table.
pub fn forms_on(model: Model) -> impl Iterator<Item = Form> {
    all().flat_map(forms_of).filter(move |form| form.is_on(model))
}

/// The forms in which `instruction` is written: plain, `D`, `P`, `D` and `P`, as far as it has them.
pub fn forms_of(instruction: &'static Instruction) -> impl Iterator<Item = Form> {
    let widths: &[bool] = match instruction.wide {
        Wide::No => &[false],
        Wide::Yes => &[false, true],
        Wide::Only => &[true],
    };
    let pulses: &[bool] = if instruction.pulse { &[false, true] } else { &[false] };
    widths.iter().flat_map(move |&wide| pulses.iter().map(move |&pulse| Form { instruction, wide, pulse }))
}

pub(super) fn form_named(mnemonic: &str) -> Option<Form> {
    FORMS.get(&key(mnemonic)?).copied()
}

/// The letters of a mnemonic in upper case, one a byte; nothing for words that are longer than any. Every line of a
/// program asks, and a number is quicker to look up than a text.
fn key(mnemonic: &str) -> Option<u64> {
    let folded = |key: u64, byte: u8| key << 8 | u64::from(byte.to_ascii_uppercase());
    (mnemonic.len() <= size_of::<u64>()).then(|| mnemonic.bytes().fold(0, folded))
}

/// `D` goes before the name, but between `LD`, `AND`, `OR` and the comparison; `P` goes to the end.
pub(super) fn spelling(instruction: &Instruction, wide: bool, pulse: bool) -> String {
    let pulse = if pulse { "P" } else { "" };
    let irregular = WITHOUT_W.iter().find(|(name, _)| wide && *name == instruction.mnemonic);
    if let Some((_, name)) = irregular {
        return format!("{name}{pulse}");
    }
    let comparison = instruction.mnemonic.find(['=', '<', '>']);
    let (head, tail) = instruction.mnemonic.split_at(comparison.unwrap_or(0));
    format!("{head}{}{tail}{pulse}", if wide { "D" } else { "" })
}

/// The W of these says "word", so the maker's tools drop it where `D` says "double word".
const WITHOUT_W: &[(&str, &str)] = &[("WAND", "DAND"), ("WOR", "DOR"), ("WXOR", "DXOR")];

/// Written names and their forms. The regular names of the irregular forms, such as `DWAND`, are understood as well.
static FORMS: LazyLock<FxHashMap<u64, Form>> = LazyLock::new(|| {
    let mut forms = FxHashMap::default();
    for form in all().chain([&UNREAD]).flat_map(forms_of) {
        forms.extend(key(&form.mnemonic()).map(|key| (key, form)));
        if form.wide && WITHOUT_W.iter().any(|(name, _)| *name == form.instruction.mnemonic) {
            let pulse = if form.pulse { "P" } else { "" };
            let regular = format!("D{}{pulse}", form.instruction.mnemonic);
            forms.extend(key(&regular).map(|key| (key, form)));
        }
    }
    forms
});
