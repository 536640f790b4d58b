//! What the virtual PLC keeps without power: its program, and latched devices.

use super::cpu::{MOST_STEPS, Plc};
use crate::link::{Mode, Switch};
use crate::simulate::{Value, Variable};
use crate::target::{Device, DeviceKind, Target};
use crate::text::Message;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The memory of a PLC without power.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Saved {
    /// The name of the model, as in `rungwise.toml`.
    model: String,
    /// Parameters and program, in hexadecimal digits; unused words at the end are left out.
    program: String,
    /// Whether a download had begun that did not end.
    is_open: bool,
    /// Latched relays that are on, and contacts of timers and counters.
    on: Vec<String>,
    /// Latched registers and current values that are not 0.
    words: BTreeMap<String, i64>,
}

impl Plc {
    /// What it keeps without power, if that has changed since it was asked last. While it runs, that is assumed.
    pub fn save(&mut self) -> Option<Saved> {
        let is_running = self.mode() == Mode::Run;
        self.is_taken_over = false;
        (std::mem::take(&mut self.is_changed) || is_running).then(|| self.saved())
    }

    /// What it gave to be kept last could not be.
    pub fn forget_saving(&mut self) {
        self.is_changed = true;
    }

    /// Whether a program was taken over since it was asked for what it keeps.
    pub fn is_taken_over(&self) -> bool {
        self.is_taken_over
    }

    fn saved(&self) -> Saved {
        let code = self.machine.code();
        let latches = self.latches();
        let is_kept = |device: &Device| {
            !device.is_special() && device.kind != DeviceKind::X && latches.keep(*device, self.target)
        };
        let own: Vec<Device> = code.layout.devices().filter(is_kept).collect();
        let is_on = |device: &&Device| device.kind.is_bit() && self.machine.bit(**device) != 0;
        let number = |device: &Device| Some((device.to_string(), self.machine.word(*device, 0)));
        let words = own.iter().filter(|device| device.kind.is_word()).filter_map(number);
        let used = self.program.iter().rposition(|byte| *byte != 0xFF).map_or(0, |last| last + 1);
        let program = crate::link::frame::hex(&self.program[..used]);
        Saved {
            model: self.target.name.into(),
            program: String::from_utf8_lossy(&program).into_owned(),
            is_open: self.is_open,
            on: own.iter().filter(is_on).map(Device::to_string).collect(),
            words: words.filter(|(_, value)| *value != 0).collect(),
        }
    }

    /// A PLC that gets power again, in STOP.
    ///
    /// # Errors
    /// If what was kept is not that of a PLC of this program's making.
    pub fn restored(saved: &Saved, scan_ns: i64) -> Result<Plc, Message> {
        let wrong = |what: &str| Message::new("link.saved-wrong").with("what", what);
        let target = Target::named(&saved.model).filter(|target| target.is_fx());
        let target = target.ok_or_else(|| wrong(&saved.model))?;
        let bytes = crate::link::frame::unhex(saved.program.as_bytes()).ok_or_else(|| wrong("program"))?;
        // The first of the parameters says how much memory it has.
        let mut plc = Plc::new(target, scan_ns);
        let thousands = bytes.first_chunk().map(|word| u16::from_le_bytes(*word));
        let most = target.limits.steps_at_most.min(MOST_STEPS as u32) / 1000;
        if let Some(thousands) = thousands.filter(|thousands| (1..=most).contains(&u32::from(*thousands))) {
            plc = plc.with_memory(thousands);
        }
        plc.program.get_mut(..bytes.len()).ok_or_else(|| wrong("program"))?.copy_from_slice(&bytes);
        if let Some(rest) = plc.program.get_mut(bytes.len()..) {
            rest.fill(0xFF);
        }
        plc.is_open = saved.is_open;
        let code = std::sync::Arc::clone(plc.machine.code());
        let written = saved.on.iter().map(|name| (name, Value::Bit(true)));
        let words = saved.words.iter().map(|(name, value)| (name, Value::Number(*value)));
        for (name, value) in written.chain(words) {
            let is_contact = value == Value::Bit(true);
            let variable = match code.variable(name) {
                Some(Variable::Word(_)) if is_contact => {
                    let (letter, number) = name.split_at(1);
                    code.variable(&format!("{letter}S{number}"))
                }
                other => other,
            };
            plc.machine.write(variable.ok_or_else(|| wrong(name))?, &value);
        }
        Ok(plc)
    }

    /// Gives it power: it comes to RUN if its switch says so.
    pub fn power_on(&mut self, switch: Switch, now_ns: i64) {
        self.turn(switch, now_ns);
    }
}
