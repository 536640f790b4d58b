//! The three places of a contact: alone at the start of a block, in series, in parallel.

use super::all;
use crate::target::{Form, Instruction, Opcode, Role};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// The rows of one contact: LD, AND, OR.
type Places = [&'static Instruction; 3];

/// The same contact in the place that `role` names, or nothing if `form` is no contact or `role` no place of one.
pub(in crate::target) fn placed(form: Form, role: Role) -> Option<Form> {
    let place = match role {
        Role::Load => 0,
        Role::Series => 1,
        Role::Parallel => 2,
        _ => return None,
    };
    let instruction = PLACES.get(form.instruction.mnemonic)?[place];
    Some(Form { instruction, ..form })
}

static PLACES: LazyLock<FxHashMap<&'static str, Places>> = LazyLock::new(|| {
    let loads = all().filter(|row| row.role == Role::Load);
    let families = loads.filter_map(|load| {
        let [series, parallel] = [Role::Series, Role::Parallel].map(|role| {
            all().find(|row| row.role == role && is_kin(load.opcode, row.opcode, role == Role::Parallel))
        });
        Some([load, series?, parallel?])
    });
    families.flat_map(|places| places.map(|row| (row.mnemonic, places))).collect()
});

/// Whether `other` is the code of the contact `load` in series or in parallel. The codes of the three places keep one
/// distance in each family: classes 2, 4, 6, codes 01CAh, 01CCh, 01CEh, functions 224, 232, 240.
fn is_kin(load: Opcode, other: Opcode, parallel: bool) -> bool {
    let steps = if parallel { 2 } else { 1 };
    match (load, other) {
        (Opcode::Contact { class: load, .. }, Opcode::Contact { class, .. }) => class == load + 2 * steps,
        (Opcode::Device(load), Opcode::Device(code)) => code == load + 2 * u16::from(steps),
        (Opcode::Function(load), Opcode::Function(number)) => number == load + 8 * u16::from(steps),
        _ => false,
    }
}
