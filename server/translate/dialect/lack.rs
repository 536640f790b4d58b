//! Why something has no words in the other language.

use crate::ladder::ContactKind;
use crate::logic::{Action, Contact, Deed, Refusal, Term, Test};
use crate::target::Operand;
use crate::text::Message;
use smol_str::{SmolStr, format_smolstr};

/// What has nothing that stands for it in the other language.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Lack {
    /// Something within the word that is looked at.
    Unnamed,
    /// A device, a variable, an instruction.
    Word(SmolStr),
    /// Something of which the message with this key says why.
    Reason(&'static str, SmolStr),
    /// A variable of a type that the other language does not calculate with in so many bits.
    Type(SmolStr, &'static str, u32),
    /// A constant that does not fit in so many bits.
    Range(SmolStr, u32),
    /// A variable of a type that the other language compares otherwise.
    Order(SmolStr, &'static str),
}

impl Lack {
    /// The sentence that says it.
    pub(super) fn message(&self) -> Message {
        match self {
            Lack::Unnamed => Refusal::NoCounterpart.message(),
            Lack::Word(word) => Message::new("translate.no-counterpart").with("word", word),
            Lack::Reason(key, word) => Message::new(key).with("word", word),
            Lack::Type(word, kind, bits) => {
                let message = Message::new("translate.type").with("word", word).with("type", *kind);
                message.with("bits", *bits)
            }
            Lack::Range(word, bits) => Message::new("translate.range").with("word", word).with("bits", *bits),
            Lack::Order(word, kind) => Message::new("translate.order").with("word", word).with("type", *kind),
        }
    }

    /// The same, said of `word` if it has no name so far.
    pub(super) fn named(self, word: impl AsRef<str>) -> Lack {
        match self {
            Lack::Unnamed if !word.as_ref().is_empty() => Lack::Word(word.as_ref().into()),
            lack => lack,
        }
    }

    /// The same, said of what an action is called if it has no name so far: its instruction, else its operands.
    pub(super) fn of_action(self, action: &Action) -> Lack {
        match &action.deed {
            Deed::Instruction(form) => self.named(form.mnemonic()),
            Deed::Compute(computation) => self.named(computation.name()),
            Deed::Call(call) => {
                let instance = action.terms.first().map_or("", |term| term.text.as_str());
                self.named(format_smolstr!("{instance} : {}", call.block.name()))
            }
            Deed::Return => self.named("RET"),
            Deed::Coil(_) | Deed::Jump => {
                self.named(action.terms.first().map_or("", |term| term.text.as_str()))
            }
        }
    }

    /// The same, said of a contact if it has no name so far.
    pub(super) fn of_contact(self, contact: &Contact) -> Lack {
        let words: Vec<&str> = contact.terms.iter().map(|term| term.text.as_str()).collect();
        match contact.test {
            Test::Compare(operator) => {
                let wide = if operator.is_wide() { "D" } else { "" };
                self.named(format_smolstr!("{wide}{} {}", operator.sign(), words.join(" ")))
            }
            Test::Bit(_) => self.named(words.join(" ")),
        }
    }
}

/// A lack where nothing stands for it in the other language.
pub(super) fn without<T>(counterpart: Option<T>) -> Result<T, Lack> {
    counterpart.ok_or(Lack::Unnamed)
}

/// Whether a contact of this kind has a counterpart for `term`, a device: edges that go to one contact alone have none.
pub(super) fn single_edge(kind: ContactKind, term: &Term) -> Result<(), Lack> {
    let is_edge = matches!(kind, ContactKind::Rising | ContactKind::Falling);
    match term.operand {
        Operand::Device(device) if is_edge && device.has_single_edge() => {
            Err(Lack::Reason("translate.single-edge", term.text.clone()))
        }
        _ => Ok(()),
    }
}
