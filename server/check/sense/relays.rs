//! What a program can know of a relay, a register or a variable: whether anything outside of it may read or write it.

use super::uses::{Key, Name, Use, Uses};
use crate::check::ProgramContext;
use crate::document::{Act, DeclaredType, Variable};
use crate::il::iec::SectionKind;
use crate::target::iec::ElementaryType;
use crate::target::{Device, DeviceKind};
use rustc_hash::FxHashSet;

/// Whether it is a relay or a register of the general range: none that the CPU knows, none that keeps its value without
/// power and may have it from another day or from a panel, and none that the model lacks, which its own rule reports.
pub fn is_general(device: Device, context: &ProgramContext<'_>) -> bool {
    let is_kind = matches!(device.kind, DeviceKind::M | DeviceKind::D) && !device.is_special();
    is_kind && device.range_on(context.target()).is_some() && !context.keeps(device)
}

/// Whether it is a variable that only its own unit sees, of an elementary type.
pub(super) fn is_private(name: &Name<'_>) -> bool {
    matches!(name.key, Key::Local(..))
        && name.variable.is_some_and(|variable| {
            matches!(variable.section, SectionKind::Local | SectionKind::Temporary)
                && matches!(variable.declared, DeclaredType::Elementary(_) | DeclaredType::Subrange(..))
                && variable.address.is_none()
        })
}

/// Which units say how they are connected. In one without addresses and parameters any variable may be a terminal, as
/// in programs whose addresses are given elsewhere.
#[derive(Default)]
pub(super) struct Wiring(FxHashSet<(usize, usize)>);

impl Wiring {
    pub fn of(context: &ProgramContext<'_>) -> Wiring {
        let mut wiring = Wiring::default();
        for (file, at) in context.files().iter().enumerate() {
            for (number, pou) in at.document.scopes().own_pous().iter().enumerate() {
                let connects =
                    |variable: &Variable| variable.address.is_some() || variable.section.is_parameter();
                if pou.variables.iter().any(connects) {
                    wiring.0.insert((file, number + 1));
                }
            }
        }
        wiring
    }

    /// Whether it is a variable that nothing but its own unit can read or write.
    pub fn is_inside(&self, name: &Name<'_>) -> bool {
        matches!(name.key, Key::Local(file, unit, _) if self.0.contains(&(file, unit))) && is_private(name)
    }
}

/// Whether it is one bit that a program switches on and off, and that no caller of the unit sees.
pub(super) fn is_latchable(name: &Name<'_>, has_steps: bool) -> bool {
    match name.key {
        // States are switched off by the transfer to another one.
        Key::Device(device) => match device.kind {
            DeviceKind::Y => true,
            DeviceKind::M => !device.is_special(),
            DeviceKind::S => !has_steps,
            _ => false,
        },
        Key::Direct(_) => true,
        Key::Global(_) | Key::Local(..) => name.variable.is_none_or(|variable| {
            let is_bit = variable.declared == DeclaredType::Elementary(ElementaryType::Bool);
            is_bit && !matches!(variable.section, SectionKind::Input | SectionKind::InOut)
        }),
    }
}

/// Whether a row of several devices that is written covers it.
pub(super) fn is_written_in_row(name: &Name<'_>, uses: &Uses<'_>) -> bool {
    matches!(name.key, Key::Device(device) if uses.is_written_in_row(device))
}

/// The first place that does `act` with all of the device or variable.
pub(super) fn first_of(mut all: impl Iterator<Item = Use>, act: Act) -> Option<Use> {
    all.find(|one| one.access.act == act && one.is_whole())
}
