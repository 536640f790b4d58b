//! Writes a path of power as equations, one for each output.

use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Conversion, Deed, Drive, Expression, Gate, Path, Test};
use crate::text::Message;
use smol_str::format_smolstr;

/// How equations are written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Notation {
    /// `Y0 = (X0 + Y0)*[X1]`: sums, products, and brackets around what is inverted.
    #[default]
    Algebra,
    /// `Y0 = (X0 ∨ Y0) ∧ ¬X1`
    Symbols,
}

/// The equations of `path` in the order of execution, one a line, or why it has none.
pub fn equations(path: &Path, notation: Notation) -> Result<Vec<String>, Message> {
    let mut equations = Vec::new();
    let writer = Writer { notation };
    writer.path(path, None, &mut equations)?;
    Ok(equations)
}

struct Writer {
    notation: Notation,
}

impl Writer {
    fn path(
        &self,
        path: &Path,
        power: Option<&Expression>,
        equations: &mut Vec<String>,
    ) -> Result<(), Message> {
        let power = Gate::condition(&path.gates, power.cloned()).map_err(|gate| match gate {
            Gate::Through(action) if action.runs_unit() => lack_of(action),
            Gate::Through(_) => Message::new("translate.not-boolean"),
            _ => Message::new("translate.no-condition"),
        })?;
        for drive in &path.drives {
            match drive {
                Drive::Path(path) => self.path(path, power.as_ref(), equations)?,
                Drive::Action(action) if action.runs_unit() => return Err(lack_of(action)),
                // A word of an equation stands for itself.
                Drive::Action(action) if is_converted(action) => {
                    return Err(Message::new("translate.not-boolean"));
                }
                Drive::Action(action) => equations.push(match &power {
                    Some(power) => format!("{} = {}", self.left(action), self.sum(power)),
                    None if action.deed.stands_alone() => self.left(action),
                    None => return Err(Message::new("translate.no-condition")),
                }),
            }
        }
        Ok(())
    }

    /// What is driven.
    fn left(&self, action: &Action) -> String {
        let mnemonic = match &action.deed {
            Deed::Coil(CoilKind::Plain) => String::new(),
            Deed::Coil(CoilKind::Negated) => {
                let device = words(&action.terms);
                return match self.notation {
                    Notation::Algebra => format!("[{device}]"),
                    Notation::Symbols => format!("¬{device}"),
                };
            }
            Deed::Coil(kind) => {
                crate::document::coil_form(*kind).map(|form| form.mnemonic()).unwrap_or_default()
            }
            Deed::Instruction(form) => form.mnemonic(),
            Deed::Call(call) => call.block.name().to_string(),
            Deed::Compute(computation) => computation.name().to_string(),
            Deed::Jump => "JMP".to_string(),
            Deed::Return => "RET".to_string(),
        };
        let words = words(&action.terms);
        if mnemonic.is_empty() || words.is_empty() {
            mnemonic + &words
        } else {
            format!("{mnemonic} {words}")
        }
    }

    fn sum(&self, expression: &Expression) -> String {
        match expression {
            Expression::Or(parts) => {
                let parts: Vec<String> = parts.iter().map(|part| self.product(part)).collect();
                parts.join(if self.notation == Notation::Algebra { " + " } else { " ∨ " })
            }
            _ => self.product(expression),
        }
    }

    fn product(&self, expression: &Expression) -> String {
        match expression {
            Expression::And(parts) => {
                let parts: Vec<String> = parts.iter().map(|part| self.factor(part)).collect();
                parts.join(if self.notation == Notation::Algebra { "*" } else { " ∧ " })
            }
            _ => self.factor(expression),
        }
    }

    fn factor(&self, expression: &Expression) -> String {
        match expression {
            Expression::Constant(value) => u8::from(*value).to_string(),
            Expression::Contact(contact) => self.contact(contact),
            Expression::And(_) | Expression::Or(_) => format!("({})", self.sum(expression)),
            Expression::Not(part) => match self.notation {
                Notation::Algebra => format!("[{}]", self.sum(part)),
                Notation::Symbols => format!("¬{}", self.factor(part)),
            },
        }
    }

    fn contact(&self, contact: &Contact) -> String {
        let words = words(&contact.terms);
        match (contact.test, self.notation) {
            (Test::Bit(ContactKind::NormallyOpen), _) => words,
            (Test::Bit(ContactKind::NormallyClosed), Notation::Algebra) => format!("[{words}]"),
            (Test::Bit(ContactKind::NormallyClosed), Notation::Symbols) => format!("¬{words}"),
            (Test::Bit(ContactKind::Rising), Notation::Algebra) => format!("R_EDGE({words})"),
            (Test::Bit(ContactKind::Rising), Notation::Symbols) => format!("↑{words}"),
            (Test::Bit(ContactKind::Falling), Notation::Algebra) => format!("F_EDGE({words})"),
            (Test::Bit(ContactKind::Falling), Notation::Symbols) => format!("↓{words}"),
            (Test::Compare(operator), _) => {
                let wide = if operator.is_wide() { "D" } else { "" };
                let [left, right] = [0, 1].map(|side| contact.terms.get(side).map_or("", |term| &term.text));
                format!("({left} {wide}{} {right})", operator.sign())
            }
        }
    }
}

/// Whether it calculates with other types than its operands have.
fn is_converted(action: &Action) -> bool {
    matches!(&action.deed, Deed::Compute(computation) if computation.conversion != Conversion::None)
}

/// Equations know no function block and no function of the program.
fn lack_of(action: &Action) -> Message {
    let word = match (&action.deed, action.terms.first()) {
        (Deed::Call(call), Some(instance)) => format_smolstr!("{instance} : {}", call.block.name()),
        (Deed::Compute(computation), _) => computation.name().into(),
        _ => return Message::new("translate.not-boolean"),
    };
    Message::new("translate.no-counterpart").with("word", word)
}

fn words(terms: &[crate::logic::Term]) -> String {
    terms.iter().map(|term| term.text.as_str()).collect::<Vec<_>>().join(" ")
}
