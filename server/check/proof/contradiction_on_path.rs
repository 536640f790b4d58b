//! # contradiction-on-path
//!
//! Two contacts in series of which one is off whenever the other is on: `X0` and not `X0`, or `D0` above 10 and below
//! 5. No power ever comes through. Often one of the two names a neighbour of the device that was meant, or the second
//! belongs into a branch beside the first.
//!
//! The mark is on the contact that comes second, or on the one in the branch if the other stands before or behind the
//! branches. Where other branches conduct, as in `(X0 + X1) · (NOT X0 + NOT X1)`, nothing is wrong.
//!
//! ```lad
//! |  X0    X1    X0     Y0  |
//! +--| |---| |---|/|----( )-+
//!                ^^^
//! ```
//!
//! ```lad
//! |  X0    X1    X2     Y0  |
//! +--| |---| |---|/|----( )-+
//! ```
//!
//! ```fx
//! LD X0
//! AND X1
//! ANI X0
//! ^^^^^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD> D0 K10
//! OR X0
//! LD< D0 K5
//! OR X1
//! ANB
//! OUT Y0
//! END
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Open AT %IX0.0 : BOOL;
//!     Free AT %IX0.1 : BOOL;
//!     Lift AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Open
//!     AND Free
//!     ANDN Open
//!          ^^^^
//!     ST Lift
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Open AT %IX0.0 : BOOL;
//!     Free AT %IX0.1 : BOOL;
//!     Lift AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Open
//!     ANDN Free
//!     ST Lift
//! END_PROGRAM
//! ```

use super::rung::{ProofRung, name_of, share_a_device};
use crate::check::{Rule, Run};
use crate::logic::{
    self, Action, Contact, Deed, Drive, Expression, Formula, Formulas, Gate, Path, Term, Test, is_never,
};
use crate::target::{DeviceKind, Operand};
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "contradiction-on-path",
    severity: Severity::Hint,
    run: Run::Both(super::check, super::across::check),
    source: include_str!("contradiction_on_path.rs"),
};

/// Two contacts that never conduct together and both lie on every way past the second.
pub(super) struct Contradiction<'p> {
    pub first: &'p Contact,
    pub second: &'p Contact,
    /// Whether the second stands in no branch, so that nothing behind it gets power.
    pub is_total: bool,
}

impl Contradiction<'_> {
    pub fn diagnostic(&self) -> Diagnostic {
        let (first, second) = (name_of(self.first), name_of(self.second));
        let related = Message::new("contradiction-on-path.first").with("name", &first);
        let message = Message::new("contradiction-on-path.found").with("first", first).with("second", second);
        Diagnostic::new(RULE.code, self.second.span, message).related(self.first.span, related)
    }
}

/// The diagrams of two contacts are small; those of all pairs in a rung may have so many nodes.
const EFFORT: usize = 50_000;

/// All of a rung, each second contact once.
pub(super) fn find(rung: &ProofRung) -> Vec<Contradiction<'_>> {
    let mut walk =
        Walk { formulas: Formulas::limited(EFFORT), facts: Vec::new(), floor: 0, found: Vec::new() };
    walk.path(&rung.path);
    walk.found
}

/// A way along the power, with the contacts that it has passed for certain.
struct Walk<'p> {
    formulas: Formulas,
    facts: Vec<Fact<'p>>,
    /// The facts before this one say nothing about the power here.
    floor: usize,
    found: Vec<Contradiction<'p>>,
}

struct Fact<'p> {
    contact: &'p Contact,
    formula: Formula,
    /// False once an output may have changed what the contact asks for.
    holds: bool,
}

impl<'p> Walk<'p> {
    fn path(&mut self, path: &'p Path) {
        let (start, floor) = (self.facts.len(), self.floor);
        for gate in &path.gates {
            match gate {
                Gate::Pass(expression) => self.series(std::slice::from_ref(expression), true),
                Gate::Invert => self.floor = self.facts.len(),
                Gate::Through(action) => {
                    self.pass(action);
                    self.floor = self.facts.len();
                }
            }
        }
        for drive in &path.drives {
            match drive {
                Drive::Action(action) => self.pass(action),
                Drive::Path(path) => self.path(path),
            }
        }
        self.facts.truncate(start);
        self.floor = floor;
    }

    /// Forgets what `action` may change.
    fn pass(&mut self, action: &Action) {
        let is_lone = |term: &&Term| {
            let kind = match term.operand {
                Operand::Device(device) => Some(device.kind),
                _ => None,
            };
            matches!(kind, Some(DeviceKind::Y | DeviceKind::M))
        };
        let driven = action.terms.first().filter(|_| matches!(action.deed, Deed::Coil(_))).filter(is_lone);
        // Words may be made of the bit.
        let is_kept = |fact: &Fact<'_>| {
            let is_bit = matches!(fact.contact.test, Test::Bit(_));
            driven.is_some_and(|driven| is_bit && !fact.contact.terms.contains(driven))
        };
        self.facts.iter_mut().for_each(|fact| fact.holds &= is_kept(fact));
    }

    /// Parts in series: first what lies on every way, so that branches know what stands behind them, too.
    fn series(&mut self, parts: &'p [Expression], is_total: bool) {
        let parts: Vec<&Expression> = parts
            .iter()
            .flat_map(|part| match part {
                Expression::And(inner) => inner.as_slice(),
                part => std::slice::from_ref(part),
            })
            .collect();
        for part in &parts {
            if let Expression::Contact(contact) = part {
                self.contact(contact, is_total);
            }
        }
        for part in parts {
            let (start, floor) = (self.facts.len(), self.floor);
            match part {
                Expression::Or(branches) => {
                    for branch in branches {
                        self.series(std::slice::from_ref(branch), false);
                        self.facts.truncate(start);
                    }
                }
                Expression::Not(inner) => {
                    self.floor = start;
                    self.series(std::slice::from_ref(&**inner), false);
                    self.facts.truncate(start);
                    self.floor = floor;
                }
                _ => {}
            }
        }
    }

    fn contact(&mut self, contact: &'p Contact, is_total: bool) {
        let formula = logic::Run::new().contact(contact, &mut self.formulas);
        let inverse = self.formulas.not(formula);
        let mut first = None;
        for fact in self.facts[self.floor..].iter().filter(|fact| fact.holds) {
            let is_contrary = fact.formula == inverse
                || (share_a_device(fact.contact, contact) && fact.formula != formula && {
                    let both = self.formulas.and([fact.formula, formula]);
                    is_never(&mut self.formulas, both) == Some(true)
                });
            if is_contrary {
                first = Some(fact.contact);
                break;
            }
        }
        if let Some(first) = first {
            self.found.push(Contradiction { first, second: contact, is_total });
        }
        self.facts.push(Fact { contact, formula, holds: true });
    }
}
