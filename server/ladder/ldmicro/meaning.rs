//! What the boxes of LDmicro stand for: the function block or function, and the formal names of its pins.

/// A box, one row of the table.
#[derive(PartialEq, Eq, Debug)]
pub struct BoxKind {
    /// The word in the box.
    pub word: &'static str,
    /// The name of the block or function that it is.
    pub type_name: &'static str,
    /// Whether that is one of IEC 61131-3 with the same meaning.
    pub standard: bool,
    /// The pin on which power enters.
    pub power_in: &'static str,
    /// The pin on which it leaves.
    pub power_out: &'static str,
    /// Whether what leaves is the opposite of what the block puts out.
    pub negated: bool,
    /// The pins of its values: those that it reads, in order.
    pub reads: &'static [&'static str],
    /// The pin of the value that it writes; empty if there is none.
    pub writes: &'static str,
    /// Where its words stand.
    pub form: Form,
}

/// Where the words of a box stand.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Form {
    /// `[TON 1.000 s]`, the instance above.
    Timer,
    /// `[CTU >=5]`, `{CTC 0:7}`, the instance above, perhaps with its start value: `C1:0`.
    Counter,
    /// `[_/ OSR_/ \_]`, perhaps with the upper half of the wave above.
    Wave,
    /// `{MOV  d:=}` above `{  s  }`, `{ADD d:=}` above `{a + b}`, `{d:=}` above `{SWAP s}`.
    Assignment,
    /// `{READ ADC}`, the variable above, if there is one.
    Command,
}

const fn timer(word: &'static str, standard: bool) -> BoxKind {
    BoxKind {
        word,
        type_name: word,
        standard,
        power_in: "IN",
        power_out: "Q",
        negated: false,
        reads: &["PT"],
        writes: "",
        form: Form::Timer,
    }
}

const fn counter(word: &'static str, power_in: &'static str, reads: &'static [&'static str]) -> BoxKind {
    BoxKind { standard: false, power_in, reads, form: Form::Counter, ..timer(word, false) }
}

const fn wave(word: &'static str, type_name: &'static str, negated: bool) -> BoxKind {
    let standard = type_name.len() == "R_TRIG".len();
    BoxKind {
        type_name,
        standard,
        power_in: "CLK",
        negated,
        reads: &[],
        form: Form::Wave,
        ..timer(word, false)
    }
}

const fn assignment(word: &'static str, type_name: &'static str, reads: &'static [&'static str]) -> BoxKind {
    BoxKind {
        type_name,
        standard: true,
        power_in: "EN",
        power_out: "ENO",
        reads,
        writes: "OUT",
        form: Form::Assignment,
        ..timer(word, false)
    }
}

const fn own_assignment(word: &'static str, reads: &'static [&'static str]) -> BoxKind {
    BoxKind { standard: false, ..assignment(word, word, reads) }
}

const fn command(word: &'static str, type_name: &'static str, reads: &'static [&'static str]) -> BoxKind {
    BoxKind { standard: false, writes: "", form: Form::Command, ..assignment(word, type_name, reads) }
}

const fn source(word: &'static str, type_name: &'static str) -> BoxKind {
    BoxKind { writes: "OUT", ..command(word, type_name, &[]) }
}

/// All boxes; those that are no block but a reset, a jump or a comparison are told by the reader.
const KINDS: &[BoxKind] = &[
    timer("TON", true),
    timer("TOF", true),
    timer("RTO", false),
    timer("RTL", false),
    timer("TCY", false),
    timer("THI", false),
    timer("TLO", false),
    // Counts up and is on from the preset on, as the standard's; its count goes on past the preset.
    BoxKind { standard: true, ..counter("CTU", "CU", &["PV", "INIT"]) },
    // Counts down from its start value and is on above the limit, which the standard's is not.
    counter("CTD", "CD", &["PV", "INIT"]),
    counter("CTC", "CU", &["PV", "INIT"]),
    counter("CTR", "CD", &["PV", "INIT"]),
    wave("OSR", "R_TRIG", false),
    wave("OSF", "F_TRIG", false),
    wave("ODR", "R_TRIG", true),
    wave("ODF", "F_TRIG", true),
    wave("OSL", "F_TRIG", true),
    BoxKind { power_in: "IN", ..wave("OSC", "OSC", false) },
    assignment("MOV", "MOVE", &["IN"]),
    assignment("ADD", "ADD", &["IN1", "IN2"]),
    assignment("SUB", "SUB", &["IN1", "IN2"]),
    assignment("MUL", "MUL", &["IN1", "IN2"]),
    assignment("DIV", "DIV", &["IN1", "IN2"]),
    assignment("MOD", "MOD", &["IN1", "IN2"]),
    assignment("AND", "AND", &["IN1", "IN2"]),
    assignment("OR", "OR", &["IN1", "IN2"]),
    assignment("XOR", "XOR", &["IN1", "IN2"]),
    assignment("NOT", "NOT", &["IN"]),
    assignment("SHL", "SHL", &["IN", "N"]),
    assignment("SHR", "SHR", &["IN", "N"]),
    assignment("ROL", "ROL", &["IN", "N"]),
    assignment("ROR", "ROR", &["IN", "N"]),
    own_assignment("SR0", &["IN", "N"]),
    own_assignment("NEG", &["IN"]),
    own_assignment("BIN2BCD", &["IN"]),
    own_assignment("BCD2BIN", &["IN"]),
    own_assignment("SWAP", &["IN"]),
    own_assignment("OPPOSITE", &["IN"]),
    own_assignment("BUS", &["IN"]),
    source("READ ADC", "READ_ADC"),
    source("RAND", "RAND"),
    source("UART RECV", "UART_RECV"),
    command("UART SEND", "UART_SEND", &["IN"]),
    command("PERSIST", "PERSIST", &["IN"]),
    command("PWM", "PWM", &["IN1", "IN2"]),
    command("SHIFT REG", "SHIFT_REG", &["IN1", "IN2"]),
    command("MASTER RLY", "MASTER_RLY", &[]),
    command("NPULSE OFF", "NPULSE_OFF", &[]),
    command("SLEEP", "SLEEP", &[]),
    command("CLRWDT", "CLRWDT", &[]),
    command("LOCK", "LOCK", &[]),
    command("DELAY", "DELAY", &["IN"]),
    command("GOSUB", "GOSUB", &["IN"]),
    command("LABEL", "LABEL", &["IN"]),
    command("SUBPROG", "SUBPROG", &["IN"]),
    command("ENDSUB", "ENDSUB", &["IN"]),
];

impl BoxKind {
    /// The box with this word, letter case counting.
    pub fn named(word: &str) -> Option<&'static BoxKind> {
        KINDS.iter().find(|kind| kind.word == word)
    }

    /// Whether a variable of its type stands behind it, which keeps its state from scan to scan.
    pub fn has_instance(&self) -> bool {
        matches!(self.form, Form::Timer | Form::Counter | Form::Wave)
    }
}

/// The duration `text`, such as `1.000 s`, `40 ms` or `500 us`, as a literal of IEC 61131-3: `T#1s`, `T#40ms`.
/// Nothing if it is none. Microseconds have no unit in the second edition and become a fraction of milliseconds.
pub fn time_literal(text: &str) -> Option<String> {
    let text = text.trim();
    let digits = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).filter(|end| *end > 0)?;
    let (number, unit) = text.split_at(digits);
    let exponent = match unit.trim() {
        "us" | "µs" => 0,
        "ms" => 3,
        "s" => 6,
        "ks" => 9,
        _ => return None,
    };
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    if fraction.contains('.') || whole.len() + fraction.len() > 12 {
        return None;
    }
    let value: u64 = format!("0{whole}{fraction}").parse().ok()?;
    let shift = exponent - fraction.len() as i32;
    let microseconds = match shift {
        0.. => value.checked_mul(10u64.checked_pow(shift as u32)?)?,
        // Digits below a microsecond have no meaning to the program.
        _ => value / 10u64.checked_pow(shift.unsigned_abs())?,
    };
    Some(duration(microseconds))
}

/// The literal of so many microseconds.
pub(super) fn duration(microseconds: u64) -> String {
    let fraction = |value: u64, unit: u64, digits: usize| match value % unit {
        0 => format!("{}", value / unit),
        rest => {
            let rest = format!("{rest:0digits$}");
            format!("{}.{}", value / unit, rest.trim_end_matches('0'))
        }
    };
    if microseconds.is_multiple_of(1_000_000) && microseconds > 0 {
        format!("T#{}s", microseconds / 1_000_000)
    } else {
        format!("T#{}ms", fraction(microseconds, 1000, 3))
    }
}
