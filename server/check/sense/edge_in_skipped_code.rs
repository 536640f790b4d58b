//! # edge-in-skipped-code
//!
//! A contact or a coil for an edge stands in a part of the program that a jump passes over or that a master control
//! switches off. It compares its device with what it was when the instruction was last executed, not a scan ago: an
//! edge that comes meanwhile is missed, or seen late, in the first scan in which the part runs again, as a start that
//! nobody has given.
//!
//! Take the edge before the jump, into a relay, and use that in the part that is passed over.
//!
//! ```fx
//! LD X10
//! CJ P1
//! LDP X0
//!     ^^
//! SET Y0
//! LD X1
//! RST Y0
//! P1
//! LD X2
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! LD X0
//! PLS M0
//! LD X10
//! CJ P1
//! LD M0
//! SET Y0
//! LD X1
//! RST Y0
//! P1
//! LD X2
//! OUT Y1
//! END
//! ```

use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "edge-in-skipped-code",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("edge_in_skipped_code.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let (uses, regions) = (context.uses(), context.regions());
    if !uses.is_fx || !regions.has_parts() {
        return;
    }
    for (number, _) in uses.names() {
        if !uses.acts(number).has(&[Act::ReadEdge, Act::Pulse]) {
            continue;
        }
        let is_edge = |act: Act| matches!(act, Act::ReadEdge | Act::Pulse);
        for one in uses.of_name(number).filter(|one| is_edge(one.access.act)) {
            let key = match () {
                () if regions.may_be_skipped(one.span.start) => "edge-in-skipped-code.jump",
                () if regions.at(one.span.start).controls > 0 => "edge-in-skipped-code.control",
                () => continue,
            };
            let message = Message::new(key).with("name", uses.words(&one));
            found.push(Diagnostic::new(RULE.code, one.span, message));
        }
    }
}
