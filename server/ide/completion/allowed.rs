//! The codes of rules, in a comment that allows what they report.

use super::{Place, Proposal};
use crate::check::{RULES, is_suppressible};
use crate::document::DIRECTIVE;
use crate::ide::CompletionKind;

/// Proposes codes inside of `rungwise: allow(`.
pub(super) fn complete(place: &mut Place<'_>) {
    let Some((_, directive)) = place.head.rsplit_once(DIRECTIVE) else { return };
    let inside = directive.trim_start().strip_prefix("allow").map(str::trim_start);
    let Some(codes) = inside.and_then(|inside| inside.strip_prefix('(')).filter(|codes| !codes.contains(')'))
    else {
        return;
    };
    let mut listed = codes.split(',').map(str::trim).collect::<Vec<_>>();
    let typed = codes.rsplit(',').next().unwrap_or("").trim_start();
    listed.pop();
    for rule in RULES.iter().filter(|rule| is_suppressible(rule.code) && !listed.contains(&rule.code)) {
        let summary = rule.summary(place.language);
        place.propose(typed, Proposal::new(rule.code, CompletionKind::Keyword, summary, 0));
    }
}
