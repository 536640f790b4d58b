//! The condition of a relay in the place of its contacts, and the relay gone.

use super::neighbourhood::Neighbourhood;
use super::unit::is_member;
use super::{Change, Proposal};
use crate::document::{DeclaredType, Symbol};
use crate::ide::bookkeeping::Book;
use crate::il::iec::SectionKind;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test};
use crate::target::iec::ElementaryType;
use crate::target::{Device, DeviceKind, Flow, Operand};
use crate::text::{Message, Span};
use crate::translate::Source;
use smol_str::{SmolStr, ToSmolStr};

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    let relays = driven_relays(around);
    relays.into_iter().find_map(|(place, relay)| proposed(around, place, relay))
}

fn proposed(around: &Neighbourhood<'_>, place: usize, relay: Relay) -> Option<Proposal> {
    let path = around.path();
    let head = &around.rung().rung;
    if !head.labels.is_empty() || head.network.is_some() {
        return None;
    }
    let condition = Gate::condition(&path.gates, None).ok()??;
    let (mentions, writes) = relay.uses(around)?;
    let others = around.rungs.get(around.here + 1..)?;
    // Every other place that names it reads it further down, as far as one can see.
    let mut left = mentions.checked_sub(1).filter(|reads| *reads > 0 && writes == 1)?;
    if relay.mentions(around.rung()) != 1 {
        return None;
    }
    let mut rest = path.clone();
    rest.drives.remove(place);
    let paths = if rest.drives.is_empty() { Vec::new() } else { vec![rest] };
    // The comment of a rung that goes away would stand above another.
    if paths.is_empty() && !head.comments.is_empty() {
        return None;
    }
    let mut changes = vec![Change { first: around.here, count: 1, paths }];
    for (number, placed) in (around.here + 1..).zip(others) {
        if left == 0 {
            break;
        }
        if !runs_straight(placed) || placed.pou != around.rung().pou {
            return None;
        }
        let found = relay.mentions(placed);
        if found > 0 {
            let path = placed.path().and_then(|path| relay.replaced(path, &condition))?;
            changes.push(Change { first: number, count: 1, paths: vec![path] });
            left = left.checked_sub(found)?;
        }
    }
    let title = Message::new("refactor.inline").with("relay", &relay.name);
    // All files are looked through for who asks for it by an instance, so that comes last.
    let is_seen = || matches!(relay.symbol, Symbol::Variable(_)) && is_member(around.view, &relay.name);
    (left == 0 && !is_seen())
        .then(|| Proposal { relay: Some(relay.key), ..Proposal::of("refactor.inline.relay", title, changes) })
}

struct Relay {
    /// A device, or a variable.
    symbol: Symbol,
    /// As it is shown.
    name: SmolStr,
    key: SmolStr,
    /// Its coil, in the chunk of the rung.
    span: Span,
}

/// The plain coils of relays that the rung drives itself, with their places among its drives; one at the cursor first.
fn driven_relays(around: &Neighbourhood<'_>) -> Vec<(usize, Relay)> {
    let drives = around.path().drives.iter().enumerate();
    let relays = drives.filter_map(|(place, drive)| {
        let Drive::Action(action) = drive else { return None };
        let (Deed::Coil(CoilKind::Plain), [term]) = (&action.deed, &action.terms[..]) else { return None };
        let relay = |symbol, name| Some((place, Relay { symbol, name, key: term.key(), span: action.span }));
        match term.operand {
            Operand::Device(device) if is_plain_relay(around, device) => {
                relay(Symbol::Device(device), device.to_smolstr())
            }
            Operand::Variable if is_local(around, term) => {
                relay(Symbol::variable(&term.text), term.text.clone())
            }
            _ => None,
        }
    });
    let mut relays: Vec<(usize, Relay)> = relays.collect();
    relays.sort_by_key(|(_, relay)| !around.is_at_cursor(relay.span));
    relays
}

/// Whether neither the PLC itself reads or writes a device, nor keeps it while it is off.
fn is_plain_relay(around: &Neighbourhood<'_>, device: Device) -> bool {
    let target = around.document.target();
    let is_general = device.range_on(target).is_some() && !around.document.keeps(device);
    device.kind == DeviceKind::M && is_general && device.special_on(target).is_none()
}

/// Whether a bit is a variable that nobody outside of its program unit knows, in a place of its own. What is nowhere
/// declared may be an output.
fn is_local(around: &Neighbourhood<'_>, term: &Term) -> bool {
    let variable = around.document.scopes().variable(around.unit.number, &term.text);
    variable.is_some_and(|variable| {
        variable.section == SectionKind::Local
            && variable.declared == DeclaredType::Elementary(ElementaryType::Bool)
            && variable.address.is_none()
            && !variable.constant
    })
}

/// Whether each scan comes through the rung, and nothing jumps to it.
fn runs_straight(placed: &Source) -> bool {
    let Some(path) = placed.path() else { return matches!(placed.rung.path, Ok(None)) };
    let is_straight = |action: &&Action| match action.deed {
        Deed::Coil(_) => true,
        Deed::Instruction(form) => form.instruction.flow() == Flow::Straight,
        Deed::Call(_) | Deed::Compute(_) => true,
        Deed::Jump | Deed::Return => false,
    };
    placed.rung.labels.is_empty() && path.actions().iter().all(is_straight)
}

impl Relay {
    /// How often it is named, and how often written; nothing if it is also a part of something else.
    fn uses(&self, around: &Neighbourhood<'_>) -> Option<(u32, u32)> {
        let Symbol::Device(device) = self.symbol else {
            let tally = around.unit.tally(around.document, &self.symbol);
            return Some((u32::try_from(tally.mentions).ok()?, u32::try_from(tally.writes).ok()?));
        };
        let book = Book::of(around.view);
        let tally = book.devices.get(&device).filter(|_| !book.is_in_run(device))?;
        Some((tally.mentions, tally.writes))
    }

    /// How often the rung names it.
    fn mentions(&self, placed: &Source) -> u32 {
        let own = placed.rung.span;
        let mentions = placed.chunk.mentions().iter().filter(|mention| {
            mention.symbol == self.symbol && own.start <= mention.span.start && mention.span.end <= own.end
        });
        mentions.count() as u32
    }

    /// `path` with the condition in the place of its contacts; nothing if it asks for an edge of the relay, which
    /// remembers the last scan.
    fn replaced(&self, path: &Path, condition: &Expression) -> Option<Path> {
        let mut replaced = Path::default();
        for gate in &path.gates {
            replaced.gates.push(match gate {
                Gate::Pass(expression) => Gate::Pass(self.within(expression, condition)?),
                other => other.clone(),
            });
        }
        for drive in &path.drives {
            replaced.drives.push(match drive {
                Drive::Path(inner) => Drive::Path(self.replaced(inner, condition)?),
                Drive::Action(action) if action.terms.iter().any(|term| term.key() == self.key) => {
                    return None;
                }
                other => other.clone(),
            });
        }
        Some(replaced)
    }

    fn within(&self, expression: &Expression, condition: &Expression) -> Option<Expression> {
        let instead = |contact: &Contact| match contact.test {
            _ if !self.is_of(contact) => Ok(Expression::Contact(contact.clone())),
            Test::Bit(ContactKind::NormallyOpen) => Ok(condition.clone()),
            Test::Bit(ContactKind::NormallyClosed) => Ok(condition.negated()),
            _ => Err(()),
        };
        expression.mapped(&mut { instead }).ok()
    }

    fn is_of(&self, contact: &Contact) -> bool {
        contact.terms.iter().any(|term| term.key() == self.key)
    }
}
