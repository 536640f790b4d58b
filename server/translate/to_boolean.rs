//! Writes a path of power as equations, one for each output.

use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{
    Action, Comparison, Contact, Conversion, Deed, Drive, Expression, Formulas, Gate, Path, Storage, Term,
    Test, compare,
};
use crate::target::{DeviceKind, Operand};
use crate::text::Message;
use rustc_hash::FxHashSet;
use smol_str::{SmolStr, format_smolstr};

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
    let writer = Writer { notation };
    let equations = parted(path)?.into_iter().map(|(power, action)| match power {
        Some(power) => Ok(format!("{} = {}", writer.left(&action), writer.sum(&power))),
        None if action.deed.stands_alone() => Ok(writer.left(&action)),
        None => Err(Message::new("translate.no-condition")),
    });
    equations.collect()
}

/// What is driven, in the order of execution, each with the whole condition.
type Parts = Vec<(Option<Expression>, Action)>;

/// The parts of `path`. In a rung the power of all outputs is that before the first of them; an equation is looked at
/// in its turn. So where an output changes what those behind it are driven by, these go on from it: `Y0 = X0*[Y0]` and
/// `Y1 = Y0`.
fn parted(path: &Path) -> Result<Parts, Message> {
    let part = |goes_on: bool| {
        let mut parts = Parter { goes_on, changed: Changed::default(), parts: Vec::new() };
        parts.path(path, None).map(|()| parts)
    };
    let plain = part(false)?;
    if !plain.reads_changed() || is_same(path, &plain.parts) {
        return Ok(plain.parts);
    }
    Ok(part(true)?.parts)
}

/// Whether parts one after the other do what the path does.
fn is_same(path: &Path, parts: &Parts) -> bool {
    let parts = parts.iter().map(|(power, action)| Path {
        gates: power.iter().cloned().map(Gate::Pass).collect(),
        drives: vec![Drive::Action(action.clone())],
    });
    let parts: Vec<Path> = parts.collect();
    let parts: Vec<&Path> = parts.iter().collect();
    matches!(compare(&[path], &parts, &mut Formulas::default()), Comparison::Same { .. })
}

struct Parter {
    /// Whether conditions that have changed are taken from an output that they drove.
    goes_on: bool,
    /// What was driven so far.
    changed: Changed,
    parts: Parts,
}

/// What outputs may have changed.
#[derive(Default)]
struct Changed {
    keys: FxHashSet<SmolStr>,
    kinds: FxHashSet<DeviceKind>,
    /// Whether something lies where other names may lead, too.
    is_shared: bool,
}

impl Changed {
    fn add(&mut self, term: &Term) {
        self.kinds.extend(term.operand.device().map(|device| device.kind));
        self.is_shared |= is_shared(term);
        self.keys.insert(term.key());
    }

    /// Whether a condition may read something of it.
    fn is_read_by(&self, condition: &Expression) -> bool {
        let is_of_kind =
            |term: &Term| term.operand.device().is_some_and(|device| self.kinds.contains(&device.kind));
        condition.contacts().into_iter().flat_map(|contact| &contact.terms).any(|term| {
            self.keys.contains(&term.key())
                || !term.is_lone() && is_of_kind(term)
                || term.is_element() && self.keys.iter().any(|key| key.contains('['))
                || self.is_shared && is_shared(term)
        })
    }
}

/// Whether a variable lies, or may lie, in a place that has other names.
fn is_shared(term: &Term) -> bool {
    !matches!((term.operand, term.storage), (Operand::Variable, Storage::Own | Storage::Local))
        && matches!(term.operand, Operand::Variable | Operand::Direct(_))
}

impl Parter {
    fn path(&mut self, path: &Path, power: Option<&Expression>) -> Result<(), Message> {
        let power = Gate::condition(&path.gates, power.cloned()).map_err(|gate| match gate {
            Gate::Through(action) if action.runs_unit() => lack_of(action),
            Gate::Through(_) => Message::new("translate.not-boolean"),
            _ => Message::new("translate.no-condition"),
        })?;
        // The output that is what the power was.
        let mut holder: Option<Contact> = None;
        for drive in &path.drives {
            let is_other = |power: &Expression| self.goes_on && self.changed.is_read_by(power);
            let now = match &holder {
                Some(contact) if power.as_ref().is_some_and(is_other) => {
                    Some(Expression::Contact(contact.clone()))
                }
                _ => power.clone(),
            };
            let mut held = None;
            match drive {
                Drive::Path(path) => self.path(path, now.as_ref())?,
                Drive::Action(action) if action.runs_unit() => return Err(lack_of(action)),
                // A word of an equation stands for itself.
                Drive::Action(action) if is_converted(action) => {
                    return Err(Message::new("translate.not-boolean"));
                }
                Drive::Action(action) => {
                    self.parts.push((now, action.clone()));
                    action.changes().iter().for_each(|term| self.changed.add(term));
                    held = holding(action);
                }
            }
            let is_gone = |contact: &Contact| drives(drive, &contact.terms);
            holder = held.or(holder.filter(|contact| !is_gone(contact)));
        }
        Ok(())
    }

    /// Whether some condition reads what any output changes.
    fn reads_changed(&self) -> bool {
        let conditions = self.parts.iter().skip(1).filter_map(|(power, _)| power.as_ref());
        conditions.into_iter().any(|power| self.changed.is_read_by(power))
    }
}

/// Whether one of `terms` is driven.
fn drives(drive: &Drive, terms: &[Term]) -> bool {
    match drive {
        Drive::Action(action) => action.changes().iter().any(|own| terms.contains(own)),
        Drive::Path(path) => path.drives.iter().any(|drive| drives(drive, terms)),
    }
}

/// The contact that conducts as the power of this output did, if it has one.
fn holding(action: &Action) -> Option<Contact> {
    let kind = match action.deed {
        Deed::Coil(CoilKind::Plain) => ContactKind::NormallyOpen,
        Deed::Coil(CoilKind::Negated) => ContactKind::NormallyClosed,
        _ => return None,
    };
    let [term] = &action.terms[..] else { return None };
    let contact = Contact { test: Test::Bit(kind), terms: vec![term.clone()], span: term.span };
    term.is_lone().then_some(contact)
}

struct Writer {
    notation: Notation,
}

impl Writer {
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

fn words(terms: &[Term]) -> String {
    terms.iter().map(|term| term.text.as_str()).collect::<Vec<_>>().join(" ")
}
