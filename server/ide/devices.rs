//! Devices in words: their kind, range and purpose on a target, and what numbers mean to timers.

use crate::document::{Chunk, Document};
use crate::target::{Constant, Device, DeviceKind, DeviceRange, Operand, Target};
use crate::text::{Language, Message, Spanned, phrase};

/// What people call devices of `kind`.
pub(super) fn kind_name(kind: DeviceKind, language: Language) -> String {
    kind_message(kind).render(language)
}

/// The same for a message that is put into words elsewhere.
pub(super) fn kind_message(kind: DeviceKind) -> Message {
    let key = match kind {
        DeviceKind::X => "device-kind.X",
        DeviceKind::Y => "device-kind.Y",
        DeviceKind::M => "device-kind.M",
        DeviceKind::S => "device-kind.S",
        DeviceKind::T => "device-kind.T",
        DeviceKind::C => "device-kind.C",
        DeviceKind::D => "device-kind.D",
        DeviceKind::R => "device-kind.R",
        DeviceKind::V => "device-kind.V",
        DeviceKind::Z => "device-kind.Z",
        DeviceKind::P => "device-kind.P",
        DeviceKind::I => "device-kind.I",
        DeviceKind::N => "device-kind.N",
    };
    Message::new(key)
}

/// `M500–M1023`, or one device where the range has no other.
pub(super) fn range_name(range: &DeviceRange) -> String {
    let (first, last) = (Device::new(range.kind, range.first), Device::new(range.kind, range.last));
    if first == last { first.to_string() } else { format!("{first}–{last}") }
}

/// The kind and what is special about the range: `auxiliary relay, latched`.
pub(super) fn purpose(range: &DeviceRange, language: Language) -> String {
    let kind = kind_name(range.kind, language);
    if language == Language::SimplifiedChinese {
        // The Chinese words for purposes name the kind as well, but for `输入` and `输出`.
        let purpose = phrase(range.purpose, language);
        return if kind.starts_with(purpose) { kind } else { purpose.to_string() };
    }
    // Purposes end with the short word for the kind, and some consist of nothing else.
    let last_word = kind.rsplit(' ').next().unwrap_or("");
    let special = range.purpose.strip_suffix(last_word).unwrap_or(range.purpose).trim();
    if special.is_empty() || kind.starts_with(special) { kind } else { format!("{kind}, {special}") }
}

/// What `device` is on the target of a document: kind, purpose, range, and the meaning of a special one. Markdown.
pub(super) fn describe(device: Device, document: &Document, language: Language) -> String {
    let target = document.target();
    let kind = kind_name(device.kind, language);
    let Some(range) = device.range_on(target) else {
        let ranges: Vec<String> = target.ranges(device.kind).map(range_name).collect();
        let key = if ranges.is_empty() { "hover.kind-not-on-target" } else { "hover.not-on-target" };
        let message = Message::new(key).with("name", device).with("kind", kind).with("target", target.title);
        return message.with("ranges", ranges.join(", ")).render(language);
    };
    let message = Message::new("hover.device").with("name", device).with("kind", purpose(range, language));
    let mut text = message.with("range", range_name(range)).render(language);
    let more = match device.special_on(target) {
        Some(special) if special.writable => {
            Some(Message::new("hover.special-written").with_phrase("meaning", special.meaning))
        }
        Some(special) => Some(Message::new("hover.special-read").with_phrase("meaning", special.meaning)),
        None => match (document.keeps(device), range.latched) {
            (true, true) => Some(Message::new("hover.latched")),
            (true, false) => Some(Message::new("hover.latched-by-project")),
            (false, true) => Some(Message::new("hover.forgotten-by-project")),
            (false, false) => None,
        },
    };
    if let Some(more) = more {
        text += &format!("\n\n{}", more.render(language));
    }
    text
}

/// How long `count` units of the timer `device` are; nothing for other devices.
pub(super) fn timer_time(device: Device, count: i64, target: &Target) -> Option<String> {
    let unit = timer_unit(device, target)?;
    u64::try_from(count).ok().map(|count| duration(count.saturating_mul(u64::from(unit))))
}

/// The unit of the timer `device` in milliseconds; nothing for other devices.
pub(super) fn timer_unit(device: Device, target: &Target) -> Option<u32> {
    let unit = device.range_on(target)?.timer_unit_ms;
    (device.kind == DeviceKind::T && unit > 0).then_some(unit)
}

/// `500 ms`, `5 s`, `1.5 s`, `2 min 30 s`, `1 h 10 min`.
pub(super) fn duration(milliseconds: u64) -> String {
    let (seconds, rest) = (milliseconds / 1000, milliseconds % 1000);
    if seconds == 0 {
        return format!("{rest} ms");
    }
    let fraction = format!(".{rest:03}");
    let fraction = fraction.trim_end_matches('0').trim_end_matches('.');
    let with_unit =
        |count: u64, unit: &str| if count > 0 { format!("{count} {unit}") } else { String::new() };
    let tail =
        if seconds % 60 > 0 || rest > 0 { format!("{}{fraction} s", seconds % 60) } else { String::new() };
    let parts = [with_unit(seconds / 3600, "h"), with_unit(seconds / 60 % 60, "min"), tail];
    parts.iter().filter(|part| !part.is_empty()).map(String::as_str).collect::<Vec<_>>().join(" ")
}

/// The preset that `chunk` gives to the timer or counter `device`.
pub(super) fn preset_of(chunk: &Chunk, device: Device) -> Option<Spanned<Operand>> {
    chunk.operations().find_map(|operation| match operation.operands {
        [driven, preset, ..] if driven.value == Operand::Device(device) && is_preset(&operation) => {
            Some(*preset)
        }
        _ => None,
    })
}

/// Whether the second operand is the preset of the timer or counter that is the first.
pub(super) fn is_preset(operation: &crate::document::Operation<'_>) -> bool {
    let optional =
        operation.form.and_then(|form| form.instruction.operands.get(1)).is_some_and(|spec| spec.optional);
    let driven = operation.operands.first().map(|operand| operand.value);
    let counts = |device: Device| device.kind.has_preset();
    optional && matches!(driven, Some(Operand::Device(device)) if counts(device))
}

/// The number that a constant stands for; reals have none.
pub(super) fn integer(constant: Constant) -> Option<i64> {
    match constant {
        Constant::Decimal(value) => Some(value),
        Constant::Hexadecimal(bits) => i64::try_from(bits).ok(),
        Constant::Real(_) => None,
    }
}
