//! The instruction table of the FX family, one file for each family of instructions.

use super::{Form, Instruction, Operand, Wide};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

pub mod specs;

mod clock;
mod contact_compare;
mod contacts;
mod external;
mod floats;
mod gray_and_analog;
mod handy;
mod high_speed;
mod positioning;
mod serial;

/// The families in the order of the manual.
static FAMILIES: &[&[Instruction]] = &[
    contacts::ROWS,
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

pub(super) fn form_named(mnemonic: &str) -> Option<Form> {
    let mut folded = [0u8; 16];
    let folded = folded.get_mut(..mnemonic.len())?;
    folded.copy_from_slice(mnemonic.as_bytes());
    folded.make_ascii_uppercase();
    FORMS.get(&*folded).copied()
}

/// `D` goes before the name, but between `LD`, `AND`, `OR` and the comparison; `P` goes to the end.
pub(super) fn spelling(instruction: &Instruction, wide: bool, pulse: bool) -> String {
    let comparison = instruction.mnemonic.find(['=', '<', '>']);
    let (head, tail) = instruction.mnemonic.split_at(comparison.unwrap_or(0));
    format!("{head}{}{tail}{}", if wide { "D" } else { "" }, if pulse { "P" } else { "" })
}

pub(super) fn steps(form: Form, operands: &[Operand]) -> u32 {
    let _ = (form, operands);
    1
}

static FORMS: LazyLock<FxHashMap<Box<[u8]>, Form>> = LazyLock::new(|| {
    let mut forms = FxHashMap::default();
    for instruction in all() {
        for wide in [false, true] {
            for pulse in [false, true] {
                let written = match instruction.wide {
                    Wide::No => !wide,
                    Wide::Yes => true,
                    Wide::Only => wide,
                };
                if written && (instruction.pulse || !pulse) {
                    let name = spelling(instruction, wide, pulse).into_bytes().into_boxed_slice();
                    forms.insert(name, Form { instruction, wide, pulse });
                }
            }
        }
    }
    forms
});
