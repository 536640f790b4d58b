//! What belongs on the panel of a program: what it uses, with what a person says of it.

use crate::document::ProjectView;
use crate::ide::{self, UsageKey, UsageOf, UsageRow, UsageWish};
use crate::il::iec::SectionKind;
use crate::simulate::{Code, CountedPreset, Machine, Value, Variable};
use crate::target::{Device, DeviceKind, Location, Operand};
use rustc_hash::{FxHashMap, FxHashSet};
use serde_json::{Value as Json, json};

/// A run of devices that an instruction means, such as the table of a SORT, takes no more rows.
const MOST_OF_A_RUN: u16 = 64;
/// More rows nobody operates.
const MOST_ROWS: usize = 5_000;

/// The rows of what the program uses and of `more` devices or variables, group by group in reading order; see the head
/// of [`simulation`](super) for their JSON.
pub(in crate::lsp) fn rows(view: &ProjectView<'_>, machine: &Machine<u8>, more: &[String]) -> Vec<Json> {
    let usage = ide::usage_of(view, &UsageWish { places: false, of: UsageOf::All });
    let code = machine.code();
    let mut panel =
        Panel { view, machine, presets: presets(code), rows: Vec::new(), known: FxHashSet::default() };
    // A variable that is declared at an address is called by its name.
    let is_direct = |row: &&UsageRow| matches!(row.key, UsageKey::Direct(_));
    let (direct, named): (Vec<&UsageRow>, Vec<&UsageRow>) = usage.rows.iter().partition(is_direct);
    for row in named.into_iter().chain(direct) {
        panel.add(row);
    }
    // What the code has and nobody mentions by this name.
    for name in code.named() {
        panel.variable(&name, "variables", Said::default());
    }
    for name in more {
        panel.chosen(name);
    }
    panel.rows.truncate(MOST_ROWS);
    panel.rows.sort_by_key(|(group, _)| GROUPS.iter().position(|known| known == group));
    let grouped = |(group, mut row): (&str, Json)| {
        row["group"] = group.into();
        row
    };
    panel.rows.into_iter().map(grouped).collect()
}

/// In the order in which a panel shows them.
const GROUPS: [&str; 8] =
    ["inputs", "outputs", "timers", "counters", "states", "relays", "registers", "variables"];

fn group_of(location: Location) -> &'static str {
    match location {
        Location::Input => "inputs",
        Location::Output => "outputs",
        Location::Memory => "variables",
    }
}

struct Panel<'a> {
    view: &'a ProjectView<'a>,
    machine: &'a Machine<u8>,
    presets: FxHashMap<Device, (Option<CountedPreset>, Option<u32>)>,
    rows: Vec<(&'static str, Json)>,
    known: FxHashSet<Variable>,
}

/// What a person says of a device, and how often the program reads and writes it.
#[derive(Clone, Copy, Default)]
struct Said<'a> {
    symbol: &'a str,
    comment: &'a str,
    reads: usize,
    writes: usize,
}

fn presets(code: &Code) -> FxHashMap<Device, (Option<CountedPreset>, Option<u32>)> {
    let mut presets = FxHashMap::default();
    for counted in code.counted() {
        presets.entry(counted.device).or_insert((counted.preset, counted.unit_ms));
    }
    presets
}

impl Panel<'_> {
    fn add(&mut self, row: &UsageRow) {
        let said = Said { symbol: &row.symbol, comment: &row.comment, reads: row.reads, writes: row.writes };
        match &row.key {
            UsageKey::Device(device) if !device.is_special() => {
                self.device(*device, said);
                let comments = self.view.here().comments();
                for further in 1..u32::from(row.length.min(MOST_OF_A_RUN)) {
                    let device = Device::new(device.kind, device.number + further);
                    let own = comments.of_device(device);
                    let symbol = own.map_or("", |own| own.symbol.as_str());
                    let comment = own.map_or("", |own| own.comment.as_str());
                    self.device(device, Said { symbol, comment, ..said });
                }
            }
            UsageKey::Device(_) => {}
            UsageKey::Direct(address) => self.variable(&row.name, group_of(address.location), said),
            UsageKey::Variable(unit, name) => {
                let group = self.declared_group(unit, name);
                self.variable(&row.full_name(), group, said);
            }
        }
    }

    fn device(&mut self, device: Device, said: Said<'_>) {
        let (name, is_bit) = (device.to_string(), device.kind.is_bit());
        let group = match device.kind {
            DeviceKind::X => "inputs",
            DeviceKind::Y => "outputs",
            DeviceKind::T => "timers",
            DeviceKind::C => "counters",
            DeviceKind::S => "states",
            _ if is_bit => "relays",
            _ => "registers",
        };
        let Some(variable) = self.machine.code().variable(&name) else { return };
        let Some(mut row) = self.row(&name, variable, said) else { return };
        if !is_bit || device.kind.has_preset() {
            let is_wide = self.machine.code().layout.is_wide(device);
            let (least, greatest) = match is_wide {
                true => (i64::from(i32::MIN), i64::from(i32::MAX)),
                false => (i64::from(i16::MIN), i64::from(i16::MAX)),
            };
            (row["least"], row["greatest"]) = (least.into(), greatest.into());
        }
        if device.kind.has_preset() {
            let contact = format!("{}S{}", device.kind.letter(), device.number);
            self.known.extend(self.machine.code().variable(&contact));
            row["contact"] = contact.into();
            if let Some((preset, unit_ms)) = self.presets.get(&device) {
                match preset {
                    Some(CountedPreset::Constant(preset)) => row["preset"] = (*preset).into(),
                    Some(CountedPreset::Register(register)) => row["preset_of"] = register.to_string().into(),
                    None => {}
                }
                row["unit_ms"] = (*unit_ms).into();
            }
        }
        self.rows.push((group, row));
    }

    /// What somebody wants to see, whether the program uses it or not.
    fn chosen(&mut self, name: &str) {
        let code = self.machine.code();
        match Operand::read(name.trim(), code.target.model) {
            Operand::Device(device) if code.target.is_fx() => {
                let own = self.view.here().comments().of_device(device);
                let symbol = own.map_or("", |own| own.symbol.as_str());
                let comment = own.map_or("", |own| own.comment.as_str());
                self.device(device, Said { symbol, comment, reads: 0, writes: 0 });
            }
            _ => self.variable(name, "variables", Said::default()),
        }
    }

    /// Where a variable lies, or what of a program it is.
    fn declared_group(&self, unit: &str, name: &str) -> &'static str {
        let declared = self.view.members().iter().find_map(|member| {
            let scopes = member.document.scopes();
            match unit.is_empty() {
                true => scopes.globals.get(name),
                false => scopes.pou_named(unit).and_then(|pou| pou.variable(name)),
            }
        });
        let Some(declared) = declared else { return "variables" };
        match (declared.address, declared.section) {
            (Some(address), _) => group_of(address.location),
            (None, SectionKind::Input) => "inputs",
            (None, SectionKind::Output) => "outputs",
            _ => "variables",
        }
    }

    /// A variable of IEC 61131-3, or an instance of a block that has a current value, a preset and an output.
    fn variable(&mut self, name: &str, group: &'static str, said: Said<'_>) {
        let find = |name: &str| self.machine.code().variable(name);
        if let Some(variable) = find(name) {
            let row = self.row(name, variable, said);
            self.rows.extend(row.map(|row| (group, row)));
            return;
        }
        for (current, preset, group, unit_ms) in
            [("ET", "PT", "timers", Some(1)), ("CV", "PV", "counters", None)]
        {
            let current = format!("{name}.{current}");
            let Some(variable) = find(&current) else { continue };
            let (contact, preset) = (format!("{name}.Q"), format!("{name}.{preset}"));
            let parts = [find(&contact), find(&preset)];
            let Some(mut row) = self.row(&current, variable, said) else { continue };
            self.known.extend(parts.into_iter().flatten());
            row["label"] = name.into();
            if parts[0].is_some() {
                row["contact"] = contact.into();
            }
            if parts[1].is_some() {
                row["preset_of"] = preset.into();
            }
            row["unit_ms"] = unit_ms.into();
            self.rows.push((group, row));
        }
    }

    /// A row, unless there is one of this variable already.
    fn row(&mut self, name: &str, variable: Variable, said: Said<'_>) -> Option<Json> {
        if !self.known.insert(variable) {
            return None;
        }
        let is_bit = matches!(self.machine.value(variable, 0), Value::Bit(_));
        Some(json!({
            "name": name,
            "label": name,
            "type": if is_bit { "bit" } else { "word" },
            "symbol": said.symbol,
            "comment": said.comment,
            "reads": said.reads,
            "writes": said.writes,
        }))
    }
}
