//! # operand-kind
//!
//! The place takes another kind of operand: a contact cannot read a register, MOV cannot write a constant, and a
//! single relay is no number. The message says what the place takes; `KnM` stands for groups of relays (`K4M0` are
//! M0 to M15 as one 16-bit number), `H` for hexadecimal constants.
//!
//! ```fx
//! LD D0
//!    ^^
//! MOV X0 D1
//!     ^^
//! END
//! ```
//!
//! ```fx
//! LD M0
//! MOV K4X0 D1
//! END
//! ```
//!
//! The width counts too: a 16-bit instruction has room for four groups of relays, and the current values of C200 to
//! C255 have 32 bits.
//!
//! ```fx
//! LD M0
//! MOV K8M0 D0
//!     ^^^^
//! MOV C200 D2
//!     ^^^^
//! END
//! ```
//!
//! ```fx
//! LD M0
//! DMOV K8M0 D0
//! DMOV C200 D2
//! END
//! ```
//!
//! ```lad
//! |  D0                Y0   |
//!    ^^
//! +--| |---------------( )--+
//! ```
//!
//! In IEC programs operators work with groups of types, logic with `ANY_BIT` and arithmetic with `ANY_NUM` and times;
//! the instance of a block is no value, and only variables can be written.
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Level : INT;
//!     Ready : BOOL;
//!     Delay : TON;
//! END_VAR
//!     LD Ready
//!     AND Level
//!         ^^^^^
//!     LD Delay
//!        ^^^^^
//!     ST TRUE
//!        ^^^^
//!     LDN Level
//!         ^^^^^
//!     S Level
//!       ^^^^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Level : INT;
//!     Ready : BOOL;
//!     Delay : TON;
//! END_VAR
//!     LD Level
//!     GT 5
//!     AND Ready
//!     AND Delay.Q
//!     S Ready
//! END_PROGRAM
//! ```
//!
//! A value of an enumeration is one of those that its type lists.
//!
//! ```iec
//! TYPE Mode : (Idle, Running); END_TYPE
//! PROGRAM Main
//! VAR
//!     Now : Mode;
//! END_VAR
//!     LD Mode#Runing
//!        ^^^^^^^^^^^
//!     ST Now
//! END_PROGRAM
//! ```
//!
//! ```iec
//! TYPE Mode : (Idle, Running); END_TYPE
//! PROGRAM Main
//! VAR
//!     Now : Mode;
//! END_VAR
//!     LD Mode#Running
//!     ST Now
//! END_PROGRAM
//! ```

use crate::check::declarations::boxes;
use crate::check::iec::{View, initial_values, misplaced_words, unknown_values};
use crate::check::{ChunkContext, Rule, Run};
use crate::document::Operation;
use crate::target::{Accepts, Access, Constant, DeviceKind, Form, Opcode, Operand, Target, Wide};
use crate::text::{Diagnostic, Message, Severity, Spanned, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "operand-kind",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("operand_kind.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if let Some(view) = View::of(context) {
        // What the operators take is judged on the way of the current result, by `no-current-result`.
        initial_values(&view, found);
        unknown_values(&view, found);
        return misplaced_words(&view, found);
    }
    if !context.target.is_fx() {
        return boxes::values(context, found);
    }
    for operation in &context.doubtful {
        let Some(form) = operation.form.filter(|form| form.is_on(context.target.model)) else { continue };
        for (place, operand) in operation.operands.iter().enumerate() {
            if place >= expected(form, operation)
                || is_other_rules_matter(form, place, operand, context.target)
            {
                continue;
            }
            let judged = Judged { context, form, operation, place, operand };
            found.extend(judged.kind().or_else(|| judged.width()));
        }
    }
}

/// How many operands the instruction takes here; those beyond are reported by `operand-count`.
fn expected(form: Form, operation: &Operation<'_>) -> usize {
    let specs = form.instruction.operands;
    let driven = operation.operands.first().and_then(|operand| operand.value.device());
    let has_preset = driven.is_none_or(|device| device.kind.has_preset());
    specs.iter().filter(|spec| has_preset || !spec.optional).count()
}

/// Devices that the model does not have, and inputs where something is written, have rules of their own.
fn is_other_rules_matter(form: Form, place: usize, operand: &Spanned<Operand>, target: &Target) -> bool {
    let Some(device) = operand.value.device() else { return false };
    let is_written = form.instruction.operands[place].access != Access::Read;
    target.ranges(device.kind).next().is_none() || device.kind == DeviceKind::X && is_written
}

/// One operand in its place.
struct Judged<'a> {
    context: &'a ChunkContext<'a>,
    form: Form,
    operation: &'a Operation<'a>,
    place: usize,
    operand: &'a Spanned<Operand>,
}

impl Judged<'_> {
    /// The wrong kind of operand.
    fn kind(&self) -> Option<Diagnostic> {
        let target = self.context.target;
        let value = &self.operand.value;
        let accepts = self.form.instruction.operands[self.place].accepts.on(target.model);
        if !accepts.takes(value) {
            let diagnostic = self.diagnostic(key_of(value), &accepts.names());
            return Some(self.with_group(diagnostic, accepts));
        }
        if !self.form.takes(self.place, value, target.model) {
            return Some(self.diagnostic("operand-kind.indexed", &[]));
        }
        // PLS, PLF and MC take the relays of the program, not those of the CPU.
        let is_special =
            value.device().is_some_and(|device| device.kind == DeviceKind::M && device.number >= 8000);
        let writes = self.form.instruction.operands[self.place].access == Access::Write;
        let takes_no_special = writes && matches!(self.form.instruction.opcode, Opcode::Device(_));
        (is_special && takes_no_special).then(|| self.diagnostic("operand-kind.special", &[]))
    }

    /// More bits than the form works with.
    fn width(&self) -> Option<Diagnostic> {
        let takes_relays = self.form.instruction.operands[self.place].accepts.contains(Accepts::Y);
        let key = match self.operand.value {
            _ if self.form.wide => return None,
            Operand::Nibbles { digits: 5.., .. } => "operand-kind.too-many-groups",
            Operand::Device(device) | Operand::Indexed { device, .. }
                if device.kind == DeviceKind::C
                    && device.number >= 200
                    && matches!(self.form.instruction.opcode, Opcode::Function(_))
                    && !takes_relays =>
            {
                "operand-kind.wide-counter"
            }
            _ => return None,
        };
        let diagnostic = self.diagnostic(key, &[]);
        if self.form.instruction.wide != Wide::Yes || !self.operation.is_word {
            return Some(diagnostic);
        }
        let wide = Form { wide: true, ..self.form }.mnemonic();
        let title = Message::new("operand-kind.use-wide").with("instruction", &wide);
        Some(diagnostic.fix(title, vec![TextEdit::new(self.operation.symbol, wide)]))
    }

    fn diagnostic(&self, key: &'static str, names: &[&str]) -> Diagnostic {
        let spec = &self.form.instruction.operands[self.place];
        let message = Message::new(key)
            .with("place", spec.name)
            .with("instruction", self.form.mnemonic())
            .with_words("takes", names.iter().copied(), " ")
            .with("word", self.operand.span.of(self.context.chunk.text()))
            .with("target", self.context.target.title);
        Diagnostic::new(RULE.code, self.operand.span, message)
    }

    /// Offers the group of relays that begins with a relay where a number is expected.
    fn with_group(&self, diagnostic: Diagnostic, accepts: Accepts) -> Diagnostic {
        let Operand::Device(first) = self.operand.value else { return diagnostic };
        let digits = if self.form.wide { 8 } else { 4 };
        let group = Operand::Nibbles { digits, first, index: None };
        if !first.kind.is_bit() || Accepts::of(&group).is_none_or(|group| !accepts.contains(group)) {
            return diagnostic;
        }
        let written = format!("K{digits}{first}");
        let title = Message::new("operand-kind.group").with("group", &written).with("first", first);
        diagnostic.fix(title, vec![TextEdit::new(self.operand.span, written)])
    }
}

/// The message for an operand of the wrong kind, which names the kind.
fn key_of(operand: &Operand) -> &'static str {
    match operand {
        Operand::Indexed { .. } => "operand-kind.indexed-device",
        Operand::Nibbles { .. } => "operand-kind.relays",
        Operand::WordBit { .. } => "operand-kind.word-bit",
        Operand::Constant { value: Constant::Real(_), .. } => "operand-kind.real",
        Operand::Constant { .. } => "operand-kind.constant",
        Operand::Text => "operand-kind.text",
        Operand::Device(device) => match device.kind {
            DeviceKind::X => "operand-kind.input",
            DeviceKind::Y => "operand-kind.output",
            DeviceKind::M => "operand-kind.relay",
            DeviceKind::S => "operand-kind.state",
            DeviceKind::T => "operand-kind.timer",
            DeviceKind::C => "operand-kind.counter",
            DeviceKind::D | DeviceKind::R => "operand-kind.register",
            DeviceKind::V | DeviceKind::Z => "operand-kind.index",
            DeviceKind::P | DeviceKind::I => "operand-kind.pointer",
            DeviceKind::N => "operand-kind.level",
        },
        Operand::Direct(_) | Operand::Literal(_) | Operand::Variable | Operand::Invalid(_) => {
            "operand-kind.other"
        }
    }
}
