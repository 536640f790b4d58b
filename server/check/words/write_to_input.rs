//! # write-to-input
//!
//! An instruction writes to an input. Inputs show the terminals: the PLC copies them into memory before each scan,
//! so a program cannot hold them, and the maker's tools refuse OUT, SET or MOV to an X.
//!
//! Where an input is to be simulated on the bench, force it from the programming tool instead; where a relay was
//! meant, use M.
//!
//! ```fx
//! LD X0
//! OUT X1
//!     ^^
//! MOV K5 K2X10
//!          ^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT Y1
//! MOV K5 K2Y10
//! END
//! ```
//!
//! ```lad
//! |  X0            X1  |
//!                  ^^
//! +--| |-----------( )-+
//! |                    |
//! ```
//!
//! In IEC programs the same goes for `%I` addresses:
//!
//! ```iec
//! PROGRAM Main
//! LD %IX0.0
//! ST %IX0.1
//!    ^^^^^^
//! END_PROGRAM
//! ```
//!
//! and for variables that lie there:
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Start AT %IX0.0 : BOOL;
//! END_VAR
//!     LD TRUE
//!     S Start
//!       ^^^^^
//! END_PROGRAM
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::document::{Operation, Symbol, Tree};
use crate::target::{Access, Device, DeviceKind, Location, Operand};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "write-to-input",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("write_to_input.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if matches!(context.chunk.tree(), Tree::Fx(_)) && !context.doubtful.iter().any(writes_input) {
        return;
    }
    for mention in context.chunk.mentions().iter().filter(|mention| mention.usage.writes()) {
        let word = mention.span.of(context.chunk.text());
        let diagnostic = |key| Diagnostic::new(RULE.code, mention.span, Message::new(key).with("word", word));
        match &mention.symbol {
            Symbol::Device(device) if device.kind == DeviceKind::X => {
                let diagnostic = diagnostic("write-to-input.found");
                found.push(match word.starts_with(['X', 'x']) {
                    true => with_output(diagnostic, *device, word),
                    false => diagnostic,
                });
            }
            Symbol::Direct(address) if address.location == Location::Input => {
                found.push(diagnostic("write-to-input.address"));
            }
            Symbol::Variable(name) => {
                let variable = context.scopes.variable(context.pou, name);
                let address = variable.and_then(|variable| variable.address);
                if address.is_some_and(|address| address.location == Location::Input) {
                    found.push(diagnostic("write-to-input.located"));
                }
            }
            _ => {}
        }
    }
}

/// Whether an instruction of a list writes to an input, told without its mentions.
fn writes_input(operation: &Operation<'_>) -> bool {
    let specs = operation.form.map_or(&[][..], |form| form.instruction.operands);
    let is_input = |operand: &Operand| operand.device().is_some_and(|device| device.kind == DeviceKind::X);
    let mut written = specs.iter().zip(operation.operands).filter(|(spec, _)| spec.access != Access::Read);
    written.any(|(_, operand)| is_input(&operand.value))
}

/// Adds the output of the same number, index register and all.
fn with_output(diagnostic: Diagnostic, device: Device, word: &str) -> Diagnostic {
    let digits = word.get(1..).unwrap_or("");
    let title =
        Message::new("write-to-input.output").with("device", Device::new(DeviceKind::Y, device.number));
    let span = diagnostic.span;
    diagnostic.fix(title, vec![TextEdit::new(span, format!("Y{digits}"))])
}
