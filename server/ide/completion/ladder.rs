//! Drawings: names above elements, contents of brackets, elements on a wire, whole rungs on an empty line.

use super::{Place, Proposal, iec, instructions, operands};
use crate::ide::CompletionKind;
use crate::ladder::{CoilKind, ContactKind, coil_words};
use crate::target::{Accepts, Access, Form, Operand};
use crate::text::{Message, Span};

pub(super) fn complete(place: &mut Place<'_>) {
    if let Some((bracket, content)) = open_bracket(place.head) {
        return inside(place, bracket, content);
    }
    let typed = place.typed(|c| c.is_alphanumeric() || "_.%".contains(c));
    let before = &place.head[..place.head.len() - typed.len()];
    if typed.is_empty() && before.trim_matches(|c: char| c.is_whitespace() || c == '\u{feff}').is_empty() {
        rungs(place);
    }
    if before.ends_with(['-', '+', '─', '┬', '├', '┼']) {
        return elements(place, typed);
    }
    names(place, typed, Accepts::CONTACT, Access::Read);
}

/// The last bracket that is open at the end of `head`, with what stands in it.
fn open_bracket(head: &str) -> Option<(char, &str)> {
    let start = head.rfind(['[', '('])?;
    let content = &head[start + 1..];
    let bracket = head[start..].chars().next()?;
    // A contact may be drawn `] [`; then what stands between is no content.
    let closed = content.contains([']', ')', '-', '|', '+']);
    (!closed).then_some((bracket, content))
}

/// Inside of `[ ]` or `( )`.
fn inside(place: &mut Place<'_>, bracket: char, content: &str) {
    let typed = place.typed(|c| !c.is_whitespace() && !",[(".contains(c));
    let before = &content[..content.len().saturating_sub(typed.len())];
    let model = place.document.target().model;
    let mut words = before.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
    let first = words.next();
    let given: Vec<Operand> = words.map(|word| place.document.reader().read(word)).collect();
    match (bracket, first) {
        ('[', None) => {
            if place.document.target().is_fx() {
                instructions::propose_forms(place, typed, instructions::is_box);
            }
            names(place, typed, Accepts::CONTACT, Access::Read);
        }
        ('[', Some(word)) => {
            // `[>= D0 K10]`: the operator alone stands for its contact.
            let form = Form::named(word).or_else(|| Form::named(&format!("LD{word}")));
            if let Some(form) = form.filter(|form| form.is_on(model)) {
                operands::propose(place, typed, form, &given);
            } else if !place.document.target().is_fx() {
                iec::propose_variables(place, typed, false);
            }
        }
        (_, None) => names(place, typed, COIL, Access::Write),
        (_, Some(word)) => {
            let device = place.document.reader().read(word);
            let is_word = coil_words().any(|(name, _)| name.eq_ignore_ascii_case(word));
            match device.device().map(|device| device.kind) {
                Some(kind) if kind.has_preset() && given.is_empty() => {
                    if let Some(form) = Form::named("OUT") {
                        operands::propose(place, typed, form, &[device]);
                    }
                }
                _ if is_word && given.is_empty() => names(place, typed, COIL, Access::Write),
                _ => {}
            }
        }
    }
}

/// What a coil drives.
const COIL: Accepts = Accepts::BIT_DESTINATION.or(Accepts::T).or(Accepts::C);

/// The names that an element can have.
fn names(place: &mut Place<'_>, typed: &str, accepts: Accepts, access: Access) {
    let target = place.document.target();
    if target.is_fx() {
        let is_fresh = access == Access::Write;
        let wanted = operands::Wanted { accepts: accepts.on(target.model), access, count: 1, is_fresh };
        operands::propose_devices(place, typed, &wanted);
    } else {
        iec::propose_variables(place, typed, access != Access::Read);
    }
}

/// Elements to stand on the wire; each takes the place of as much wire behind the cursor as it is long.
fn elements(place: &mut Place<'_>, typed: &str) {
    let language = place.language;
    let contacts =
        ContactKind::ALL.into_iter().map(|kind| (format!("|{}|", kind.mark()), contact_title(kind)));
    let coils = CoilKind::ALL.into_iter().map(|kind| (format!("({})", kind.mark()), coil_title(kind)));
    let behind = place.line.get(place.head.len()..).unwrap_or("");
    let wire = behind.chars().take_while(|c| *c == '-').count();
    for (rank, (symbol, detail)) in contacts.chain(coils).enumerate() {
        let detail = detail.render(language);
        place.propose(typed, Proposal::new(&symbol, CompletionKind::Snippet, detail, rank as u16));
        if let Some(last) = place.found.last_mut().filter(|last| last.label == symbol) {
            last.edit.span = Span::new(place.offset - typed.len(), place.offset + wire.min(symbol.len()));
        }
    }
    if place.document.target().is_fx() {
        let forms =
            |form: Form| instructions::is_box(form) && !matches!(form.instruction.mnemonic, "SET" | "RST");
        let from = place.found.len();
        instructions::propose_forms(place, typed, forms);
        for proposal in &mut place.found[from..] {
            proposal.edit.text = format!("[{}]", proposal.edit.text);
            proposal.rank = proposal.rank.saturating_add(20);
        }
    }
}

fn contact_title(kind: ContactKind) -> Message {
    Message::new(match kind {
        ContactKind::NormallyOpen => "complete.contact-normally-open",
        ContactKind::NormallyClosed => "complete.contact-normally-closed",
        ContactKind::Rising => "complete.contact-rising",
        ContactKind::Falling => "complete.contact-falling",
    })
}

fn coil_title(kind: CoilKind) -> Message {
    Message::new(match kind {
        CoilKind::Plain => "complete.coil",
        CoilKind::Negated => "complete.coil-negated",
        CoilKind::Set => "complete.coil-set",
        CoilKind::Reset => "complete.coil-reset",
        CoilKind::Rising => "complete.coil-rising",
        CoilKind::Falling => "complete.coil-falling",
        CoilKind::Toggle => "complete.coil-toggle",
    })
}

/// Whole rungs, for an empty line.
fn rungs(place: &mut Place<'_>) {
    let fx = place.document.target().is_fx();
    let (start, stop, out) = if fx { ("X0", "X1", "Y0") } else { ("Start", "Stop", "Motor") };
    let name = |place: u8, name: &str| format!("${{{place}:{name}}}");
    let plain = format!(
        "|  {}                                  {}  |\n+---| |----------------------------------( )-+\n",
        name(1, start),
        name(2, out)
    );
    let seal_in = format!(
        "|  {}       {}                       {}  |\n\
         +---| |---+---|/|------------------------( )-+\n\
         |  {}    |                                  |\n\
         +---| |---+                                  |\n",
        name(1, start),
        name(2, stop),
        name(3, out),
        name(4, out)
    );
    let templates = [
        ("rung", Message::new("complete.rung"), plain),
        ("seal-in", Message::new("complete.seal-in"), seal_in),
    ];
    for (rank, (label, detail, snippet)) in templates.into_iter().enumerate() {
        let detail = detail.render(place.language);
        let proposal = Proposal::new(label, CompletionKind::Snippet, detail, rank as u16);
        place.propose("", proposal.snippet(snippet));
    }
}
