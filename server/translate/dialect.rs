//! Between the FX family and IEC 61131-3: devices become located variables and back.
//!
//! | device | variable |
//! |---|---|
//! | `X12` (octal) | `X12 AT %IX1.2 : BOOL`: byte and bit of the number |
//! | `Y12` (octal) | `Y12 AT %QX1.2 : BOOL` |
//! | `M20` | `M20 AT %MX2.4 : BOOL` |
//! | `S20` | `S20 AT %MX1102.4 : BOOL`, from byte 1,100 on, behind the auxiliary relays |
//! | `D20` | `D20 AT %MW1020 : INT`, from word 1,000 on, behind the states |
//! | `OUT T0 K50` | the instance `T0 : TON`, called with `PT := T#5s` by the unit of the timer; contact `T0.Q` |
//! | `OUT C0 K10` | the instance `C0 : CTU`, called with `PV := 10`; contact `C0.Q`, value `C0.CV` |
//! | `RST C0` | `R C0`, a call of the block with this input alone |
//! | `PLS M0`, `PLF M0` | coils of edges: `PLS_M0 : R_TRIG`, `PLF_M0 : F_TRIG`, the output stored in `M0` |
//! | `CJ P0` | `JMPC P0` |
//! | `MOV`, `ADD`, `SUB` | `LD`, `ADD`, `SUB` and `ST`, jumped over where power does not reach them |
//! | `INC D0`, `DEC D0` | the same with the operand `1`; `INT#1` stands for the `K1` of an ADD or SUB |
//! | `RST D0` | a store of `0`; `INT#0` stands for the `K0` of a MOV |
//! | `MOVP` and the like | the same behind an instance `Pulse1 : R_TRIG` |
//! | `M8000`, `M8001` | `TRUE`, `FALSE` |
//!
//! `END` is dropped and put back. What has no counterpart keeps its words in a comment: retentive timers, counters of
//! 32 bits, special relays, steps, and applied instructions for which IEC 61131-3 has no operator on an INT. The way
//! back takes variables by their addresses, and by their names where they have none and these are names of devices that
//! nothing else is.

mod lack;
mod to_devices;
mod to_variables;

use self::lack::{Lack, without};
use super::To;
use super::source::Program;
use crate::document::Document;
use crate::il::iec::PouKind;
use crate::logic::{Path, Refusal};
use crate::target::{Device, DeviceKind, DirectAddress, Location, Model, Target, Width};
use std::cell::Cell;

/// Instructions with the functions that do the same with 16 bits.
const COMPUTED: [(&str, &str); 3] = [("MOV", "MOVE"), ("ADD", "ADD"), ("SUB", "SUB")];
/// Those that do so with 1 and one register.
const STEPPED: [(&str, &str); 2] = [("INC", "ADD"), ("DEC", "SUB")];
/// What the instances begin with that detect the power of a pulse form.
const PULSE: &str = "Pulse";

/// The first byte of the states, in bits, and the first word of the data registers.
const STATES: u32 = 1100 * 8;
const REGISTERS: u32 = 1000;

/// What the result of a translation is written for: the document's target where it is of the same family. An FX list
/// can be `wanted` for another model.
pub(super) fn target(document: &Document, to: To, wanted: Option<Model>) -> &'static Target {
    let own = document.target();
    match (to, wanted.map(Target::of).filter(|wanted| wanted.is_fx())) {
        (To::Iec, _) => Target::of(Model::Iec),
        (To::Fx, Some(wanted)) => wanted,
        (To::Fx, None) if !own.is_fx() => Target::of(Model::Fx2n),
        _ => own,
    }
}

/// Puts the rungs of `program` into the words of `target`. Those that have none there are refused.
pub(super) fn convert(document: &Document, (to, target): (To, &'static Target), program: &mut Program) {
    for source in &mut program.rungs {
        let is_end = |path: &Path| to == To::Iec && to_variables::is_end(path);
        if matches!(&source.rung.path, Ok(Some(path)) if is_end(path)) {
            source.rung.path = Ok(None);
        }
    }
    if document.target().is_fx() == target.is_fx() {
        return;
    }
    let pulses = Cell::new(0);
    let names = to_devices::Names::of(program, document.scopes(), target);
    for source in &mut program.rungs {
        if target.is_fx() {
            source.rung.labels.iter_mut().for_each(|label| *label = names.of_label(label));
        }
        // The words of the other language are no list in this one.
        source.rung.is_list = false;
        let Ok(Some(path)) = &source.rung.path else { continue };
        let converted = match target.is_fx() {
            false => to_variables::path(path, document.target(), &pulses),
            // What a function or a block does it does for whoever calls it.
            true if !is_of_program(document, source.pou) => {
                let unit = source.pou.and_then(|pou| document.scopes().pous.get(pou));
                Err(unit.map_or(Lack::Unnamed, |unit| Lack::Word(unit.name.clone())))
            }
            true => to_devices::path(path, target, &names, (document.scopes(), source.pou)),
        };
        source.note = converted.as_ref().err().map(Lack::message);
        source.rung.path = converted.map(Some).map_err(|_| Refusal::NoCounterpart);
    }
}

/// Whether a rung belongs to a program, not to a function or a block.
fn is_of_program(document: &Document, pou: Option<usize>) -> bool {
    let pou = pou.and_then(|pou| document.scopes().pous.get(pou));
    pou.is_none_or(|pou| pou.kind == PouKind::Program)
}

/// The address of the variable that stands for a device, if it is located. The CPU's own relays and registers are not.
pub(super) fn address(device: Device) -> Option<DirectAddress> {
    if device.is_special() {
        return None;
    }
    let bit = |location: Location, number: u32| DirectAddress {
        location,
        width: Width::Bit,
        path: [Some(number / 8), Some(number % 8), None, None],
    };
    Some(match device.kind {
        DeviceKind::X => bit(Location::Input, device.number),
        DeviceKind::Y => bit(Location::Output, device.number),
        DeviceKind::M => bit(Location::Memory, device.number),
        DeviceKind::S => bit(Location::Memory, STATES + device.number),
        DeviceKind::D => DirectAddress {
            location: Location::Memory,
            width: Width::Word,
            path: [Some(REGISTERS + device.number), None, None, None],
        },
        _ => return None,
    })
}

/// The device at an address: the way back from [`address`].
pub(super) fn device_at(address: DirectAddress) -> Option<Device> {
    let device = match (address.width, address.path) {
        (Width::Bit, [Some(byte), Some(bit), None, None]) if bit < 8 => {
            let number = byte.checked_mul(8)?.checked_add(bit)?;
            match address.location {
                Location::Input => Device::new(DeviceKind::X, number),
                Location::Output => Device::new(DeviceKind::Y, number),
                Location::Memory if number >= STATES => Device::new(DeviceKind::S, number - STATES),
                Location::Memory => Device::new(DeviceKind::M, number),
            }
        }
        (Width::Word, [Some(word), None, None, None]) if address.location == Location::Memory => {
            Device::new(DeviceKind::D, word.checked_sub(REGISTERS)?)
        }
        _ => return None,
    };
    (self::address(device) == Some(address)).then_some(device)
}
