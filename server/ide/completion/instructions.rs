//! FX instructions at the start of a line, operands behind a mnemonic.

use super::{Place, Proposal, escaped, is_abbreviation, operands};
use crate::ide::{CompletionKind, instruction_page};
use crate::target::{Form, Opcode, Operand, instructions};
use std::sync::LazyLock;

/// With more proposals than this, pages would make the answer heavy; the hover has them too.
const PAGES: usize = 60;

/// What people write most, in this order.
const COMMON: &[&str] = &[
    "LD", "LDI", "OUT", "AND", "ANI", "OR", "ORI", "SET", "RST", "MOV", "LDP", "LDF", "ANB", "ORB", "MPS",
    "MRD", "MPP", "END", "STL", "RET", "INC", "ADD", "SUB", "MUL", "DIV", "LD=", "LD>=", "LD<=", "CMP",
    "ZRST", "CJ", "CALL", "PLS", "PLF", "MC", "MCR", "INV", "DMOV", "MOVP", "INCP",
];

/// A form with what its proposal shows.
struct Known {
    form: Form,
    mnemonic: String,
    snippet: String,
    usage: String,
    rank: u16,
}

/// Every form of the table, made once.
static KNOWN: LazyLock<Vec<Known>> = LazyLock::new(|| {
    let forms = instructions::all().flat_map(instructions::forms_of);
    forms.enumerate().map(|(place, form)| Known::new(place, form)).collect()
});

impl Known {
    fn new(place: usize, form: Form) -> Known {
        let mnemonic = form.mnemonic();
        let required = form.instruction.operands.iter().filter(|spec| !spec.optional);
        let places =
            required.enumerate().map(|(number, spec)| format!(" ${{{}:{}}}", number + 1, escaped(spec.name)));
        let names: String = form.instruction.operands.iter().map(|spec| format!(" {}", spec.name)).collect();
        let common = COMMON.iter().position(|common| *common == mnemonic);
        let rank = common.unwrap_or(100 + place) as u16;
        let snippet = format!("{mnemonic}{}", places.collect::<String>());
        Known { form, usage: format!("`{mnemonic}{names}`"), snippet, mnemonic, rank }
    }
}

pub(super) fn complete(place: &mut Place<'_>) {
    let typed = place.typed(|c| !c.is_whitespace() && c != ',');
    let before = &place.head[..place.head.len() - typed.len()];
    let mut words =
        before.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty()).peekable();
    if words.peek().is_some_and(|word| word.bytes().all(|byte| byte.is_ascii_digit())) {
        words.next();
    }
    let model = place.document.target().model;
    let is_label = |word: &&str| {
        let kind =
            Operand::read(word.trim_end_matches(':'), model).device().map(|device| device.kind.letter());
        matches!(kind, Some('P' | 'I')) && Form::named(word).is_none()
    };
    words.next_if(is_label);
    match words.next() {
        None => {
            operands::propose_missing_labels(place, typed);
            propose_forms(place, typed, |_| true);
        }
        Some(word) => {
            let Some(form) = Form::named(word) else { return };
            let given: Vec<Operand> = words.map(|word| place.document.reader().read(word)).collect();
            operands::propose(place, typed, form, &given);
        }
    }
}

/// Proposes the forms of the target that `wanted` lets pass.
pub(super) fn propose_forms(place: &mut Place<'_>, typed: &str, wanted: impl Fn(Form) -> bool) {
    let model = place.document.target().model;
    let fits = |known: &&Known| {
        known.form.is_on(model) && wanted(known.form) && is_abbreviation(typed, &known.mnemonic)
    };
    let known: Vec<&Known> = KNOWN.iter().filter(fits).collect();
    let with_pages = known.len() <= PAGES;
    for known in known {
        let kind = CompletionKind::Instruction;
        let mut proposal =
            Proposal::new(&known.mnemonic, kind, known.form.instruction.title_in(place.language), known.rank);
        proposal.documentation =
            if with_pages { instruction_page(known.form, place.language) } else { known.usage.clone() };
        if known.snippet != known.mnemonic {
            proposal.snippet = Some(known.snippet.clone());
        }
        place.propose(typed, proposal);
    }
}

/// Whether an instruction is drawn as a box: the applied ones, and MC, MCR and their like.
pub(super) fn is_box(form: Form) -> bool {
    use crate::target::Role;
    matches!(form.instruction.opcode, Opcode::Function(_))
        && matches!(form.instruction.role, Role::Output | Role::Standalone)
        || matches!(
            form.instruction.mnemonic,
            "MC" | "MCR" | "STL" | "RET" | "END" | "SET" | "RST" | "PLS" | "PLF"
        )
}
