//! Which PLC it is.

use crate::link::address::{Map, Plain};
use crate::link::{Line, LinkError, Transport};
use crate::target::{Device, DeviceKind, Model, Target};

/// What a PLC says of itself.
#[derive(Clone, Copy, Debug)]
pub struct Identity {
    /// The model.
    pub target: &'static Target,
    /// The version in hundredths: 310 is 3.10.
    pub version: u16,
}

/// Registers with type and version: 1000 times the type, and the version in hundredths. An FX3U says in the first that
/// it is an FX2N, and in the second what it is.
const TYPES: [Device; 2] = [Device::new(DeviceKind::D, 8001), Device::new(DeviceKind::D, 8101)];

impl Identity {
    pub(super) fn ask<T: Transport>(line: &mut Line<T>) -> Result<Identity, LinkError> {
        let mut codes = [0; 2];
        for (code, register) in codes.iter_mut().zip(TYPES) {
            let Some((address, _)) = Plain::word(register) else { continue };
            if let [low, high] = line.read(&address.read(2))?[..] {
                *code = u16::from_le_bytes([low, high]);
            }
        }
        Identity::of(codes).ok_or(LinkError::UnknownType { code: codes[0] })
    }

    /// Who has these in D8001 and D8101.
    fn of(codes: [u16; 2]) -> Option<Identity> {
        let model = match (codes[0] / 1000, codes[1] / 1000) {
            (24, 16) => Model::Fx3u,
            // Others say the same twice, or nothing the second time; an FX3G or FX3S says something else.
            _ if codes[1] != codes[0] && codes[1] != 0 => return None,
            (24, _) => Model::Fx2n,
            (26, _) => Model::Fx1n,
            (22, _) => Model::Fx1s,
            _ => return None,
        };
        let own = if model == Model::Fx3u { codes[1] } else { codes[0] };
        Some(Identity { target: Target::of(model), version: own % 1000 })
    }

    /// The version as people write it.
    pub fn version(&self) -> String {
        format!("{}.{:02}", self.version / 100, self.version % 100)
    }
}
