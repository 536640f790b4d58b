//! IEC programs: operators, variables in scope, functions, members, parameters, types, labels, keywords.

use super::{Place, Proposal};
use crate::document::{DeclaredType, Symbol, Tree, Use, Variable};
use crate::ide::bookkeeping::{self, Book};
use crate::ide::names;
use crate::ide::{CompletionKind, declared};
use crate::il::iec::{ItemKind, PouKind, SectionKind};
use crate::target::iec::{ElementaryType, Function, FunctionBlock, Operator, OperatorRole};
use crate::target::{DirectAddress, Location, Width};
use crate::text::{Encoding, Message, phrase};
use rustc_hash::FxHashSet;

/// How far back an open parenthesis is looked for, in bytes.
const CALL_REACH: usize = 4000;

pub(super) fn complete(place: &mut Place<'_>) {
    let address = place.typed(|c| c.is_alphanumeric() || "%._".contains(c));
    if address.starts_with('%') {
        return addresses(place, address);
    }
    let typed = place.typed(|c| c.is_alphanumeric() || c == '_');
    let before = &place.head[..place.head.len() - typed.len()];
    if in_section(place) {
        return match before.rsplit_once(':') {
            Some((_, behind)) if !behind.contains([';', '=']) => types(place, typed),
            Some(_) => {}
            None if before.trim().is_empty() => section_keywords(place, typed),
            None => {}
        };
    }
    if let Some(owner) = before.strip_suffix('.') {
        let start = owner.trim_end_matches(|c: char| c.is_alphanumeric() || "_.[]".contains(c)).len();
        return members(place, typed, &owner[start..]);
    }
    if let Some(callee) = open_call(place) {
        let last = before.rsplit([',', '(']).next().unwrap_or("");
        if !last.contains("=") {
            parameters(place, typed, &callee);
        } else {
            propose_variables(place, typed, last.contains("=>"));
        }
        return;
    }
    // A label may stand before the instruction.
    let statement = before.rsplit_once(':').map_or(before, |(_, statement)| statement);
    let mut words =
        statement.split(|c: char| c.is_whitespace() || c == '(' || c == ',').filter(|word| !word.is_empty());
    match words.next() {
        None => statement_words(place, typed),
        Some(word) => operands(place, typed, word),
    }
}

/// Whether the cursor stands between the keywords of a section of variables or types.
fn in_section(place: &Place<'_>) -> bool {
    let Some(Tree::Iec(tree)) = place.chunk.map(|chunk| chunk.tree()) else { return false };
    let inside = place.offset - place.chunk_start;
    let text = place.chunk.map_or("", |chunk| chunk.text());
    tree.items.iter().any(|item| {
        let declares = matches!(item.kind, ItemKind::Section { .. } | ItemKind::Types { .. });
        let word = item.span.of(text);
        let is_closed = word.trim_end_matches(';').to_ascii_uppercase().ends_with(match item.kind {
            ItemKind::Types { .. } => "END_TYPE",
            _ => "END_VAR",
        });
        let first_word = word.find(char::is_whitespace).unwrap_or(word.len());
        let starts = item.span.start as usize + first_word < inside;
        declares && starts && (inside < item.span.end as usize || !is_closed)
    })
}

/// The callee of the parenthesis that is open at the cursor: `T1` in `CAL T1(IN := a, `.
fn open_call(place: &Place<'_>) -> Option<String> {
    let text = place.chunk?.text().get(..place.offset - place.chunk_start)?;
    let mut depth = 0usize;
    for (back, byte) in text.bytes().rev().take(CALL_REACH).enumerate() {
        match byte {
            b')' => depth += 1,
            b'(' if depth > 0 => depth -= 1,
            b'(' => {
                let head = text.get(..text.len() - back - 1)?.trim_end();
                let start = head.trim_end_matches(|c: char| c.is_alphanumeric() || "_.".contains(c)).len();
                let callee = &head[start..];
                // `AND(` opens an expression, not a call.
                let is_operator = Operator::written(callee).is_some() && Function::named(callee).is_none();
                return (!callee.is_empty() && !is_operator).then(|| callee.to_string());
            }
            _ => {}
        }
    }
    None
}

fn pou(place: &Place<'_>) -> Option<usize> {
    names::pou_at(place.document, place.chunk_start)
}

/// The first word of a statement, or a keyword outside of program units.
fn statement_words(place: &mut Place<'_>, typed: &str) {
    let language = place.language;
    if pou(place).is_some() || place.document.scopes().own_pous().is_empty() {
        for (rank, written) in Operator::all_written().enumerate() {
            let word = written.word();
            let takes_operand =
                written.operator.operand.is_some() && written.operator.role != OperatorRole::Complement;
            let calls = matches!(written.operator.role, OperatorRole::Jump | OperatorRole::Call);
            let mut proposal = Proposal::new(
                &word,
                CompletionKind::Instruction,
                written.operator.title_in(language),
                rank as u16,
            );
            if takes_operand || calls {
                proposal.snippet = Some(format!("{word} $1"));
            }
            place.propose(typed, proposal);
        }
        let mut seen: Vec<&str> = Vec::new();
        for (operator, block) in blocks_in_scope(place) {
            if !seen.contains(&operator) && Operator::written(operator).is_none() {
                seen.push(operator);
                let detail = Message::new("complete.input-operator").with("block", block).render(language);
                let proposal = Proposal::new(operator, CompletionKind::Instruction, detail, 150);
                place.propose(typed, proposal.snippet(format!("{operator} $1")));
            }
        }
        if !typed.is_empty() {
            functions(place, typed, 200);
        }
    }
    unit_keywords(place, typed);
}

/// The input operators of the function block instances in scope, with the names of their types.
fn blocks_in_scope(place: &Place<'_>) -> Vec<(&'static str, &'static str)> {
    let mut blocks: Vec<&'static FunctionBlock> = Vec::new();
    for variable in variables(place) {
        if let DeclaredType::Named(name) = &variable.declared
            && let Some(block) = FunctionBlock::named(name)
            && !blocks.iter().any(|known| known.name == block.name)
        {
            blocks.push(block);
        }
    }
    blocks
        .iter()
        .flat_map(|block| block.input_operators.iter().map(|operator| (*operator, block.name)))
        .collect()
}

fn operands(place: &mut Place<'_>, typed: &str, word: &str) {
    let Some(written) = Operator::written(word) else {
        if FunctionBlock::with_input_operator(word).next().is_some() {
            return instances(place, typed, false, |block| block.has_input_operator(word));
        }
        return propose_variables(place, typed, false);
    };
    match written.operator.role {
        OperatorRole::Jump => labels(place, typed),
        OperatorRole::Call => instances(place, typed, true, |_| true),
        OperatorRole::Return | OperatorRole::Complement => {}
        OperatorRole::Store | OperatorRole::Latch { .. } => propose_variables(place, typed, true),
        OperatorRole::Load | OperatorRole::Combine { .. } => {
            propose_variables(place, typed, false);
            for word in ["TRUE", "FALSE"] {
                place.propose(typed, Proposal::new(word, CompletionKind::Constant, "BOOL", 300));
            }
        }
    }
}

/// The variables that can be named here: those of the program unit, then the global ones.
fn variables<'d>(place: &Place<'d>) -> Vec<&'d Variable> {
    let scopes = place.document.scopes();
    let own = pou(place).and_then(|number| scopes.pous.get(number));
    let mut variables: Vec<&Variable> = own.into_iter().flat_map(|pou| &pou.variables).collect();
    let mut globals: Vec<&Variable> = scopes.globals.values().collect();
    globals.sort_by(|left, right| left.name.cmp(&right.name));
    globals.retain(|global| !variables.iter().any(|own| own.name.eq_ignore_ascii_case(&global.name)));
    variables.extend(globals);
    variables
}

/// Proposes variables in scope, and names in use that nothing declares; only those that can be written if `written`.
pub(super) fn propose_variables(place: &mut Place<'_>, typed: &str, written: bool) {
    let scopes = place.document.scopes().clone();
    let comments = place.document.comments().clone();
    let variables = variables(place);
    let exported = declared::table_rows_of(place.document);
    for (rank, variable) in variables.iter().enumerate() {
        if written && (variable.constant || variable.section == SectionKind::Input) {
            continue;
        }
        let message =
            Message::new("complete.variable").with("section", declared::section_keyword(variable.section));
        let detail = match exported.get(variable.name.as_str()) {
            Some(row) => row.clone(),
            None => {
                message.with("kind", declared::type_name(&variable.declared, &scopes)).render(place.language)
            }
        };
        let comment = variable.address.and_then(|address| comments.of(&Symbol::Direct(address)));
        let words = comment.map(|row| row.words()).unwrap_or_default();
        let detail = if words.is_empty() { detail } else { format!("{detail}, {words}") };
        let rank = 10 + (rank as u16).min(1000);
        let mut proposal = Proposal::new(variable.name.as_str(), CompletionKind::Variable, detail, rank);
        proposal.search = words;
        place.propose(typed, proposal);
    }
    undeclared(place, typed, &variables);
}

/// Names and addresses that the document uses without declaring them, as drawings do.
fn undeclared(place: &mut Place<'_>, typed: &str, variables: &[&Variable]) {
    let document = place.document;
    let has_units = !document.scopes().own_pous().is_empty();
    let declared: FxHashSet<String> = variables.iter().map(|variable| variable.name.to_lowercase()).collect();
    let is_undeclared = |symbol: &Symbol| match symbol {
        Symbol::Variable(name) => !has_units && !declared.contains(name.as_str()),
        Symbol::Direct(_) => true,
        _ => false,
    };
    let mut names: FxHashSet<&str> = FxHashSet::default();
    for page in document.pages() {
        if !page.names().symbols().iter().any(|(symbol, _)| is_undeclared(symbol)) {
            continue;
        }
        for chunk in page.chunks() {
            let mentions = chunk.mentions().iter().filter(|mention| is_undeclared(&mention.symbol));
            names.extend(
                mentions.map(|mention| mention.span.of(chunk.text())).filter(|word| !word.is_empty()),
            );
        }
    }
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_unstable();
    // The word that is being typed is no proposal for itself.
    for name in names.into_iter().filter(|name| *name != typed) {
        place.propose(typed, Proposal::new(name, CompletionKind::Variable, "", 1500));
    }
}

/// Direct addresses: those in use, then the next free one of each area and size.
fn addresses(place: &mut Place<'_>, typed: &str) {
    let book = Book::of(place.view);
    let comments = place.document.comments().clone();
    let mut used: Vec<_> = book.addresses.iter().collect();
    used.sort_unstable_by_key(|(address, _)| **address);
    for (rank, (address, tally)) in used.into_iter().take(200).enumerate() {
        let row = comments.of(&Symbol::Direct(*address));
        let words = row.map(|row| row.words()).unwrap_or_default();
        let detail = [words.clone(), tally.words(place.language)];
        let detail: Vec<String> = detail.into_iter().filter(|part| !part.is_empty()).collect();
        let kind = CompletionKind::Variable;
        let mut proposal = Proposal::new(address.to_string(), kind, detail.join(", "), 10 + rank as u16);
        proposal.search = words;
        place.propose(typed, proposal);
    }
    let bit = |location| DirectAddress { location, width: Width::Bit, path: [Some(0), Some(0), None, None] };
    let word = |location| DirectAddress { location, width: Width::Word, path: [Some(0), None, None, None] };
    let locations = [Location::Input, Location::Output, Location::Memory];
    for (rank, first) in locations.into_iter().flat_map(|at| [bit(at), word(at)]).enumerate() {
        let free = bookkeeping::next_address(&book, first);
        let kind = match first.location {
            Location::Input => Message::new("address.input"),
            Location::Output => Message::new("address.output"),
            Location::Memory => Message::new("address.memory"),
        };
        let detail = Message::new("complete.free").with("kind", kind.render(place.language));
        let detail = detail.render(place.language);
        let proposal = Proposal::new(free.to_string(), CompletionKind::Variable, detail, 300 + rank as u16);
        place.propose(typed, proposal);
    }
}

/// Function block instances; with their parameters if they are called.
fn instances(place: &mut Place<'_>, typed: &str, calls: bool, wanted: impl Fn(&FunctionBlock) -> bool) {
    let scopes = place.document.scopes().clone();
    for (rank, variable) in variables(place).into_iter().enumerate() {
        let DeclaredType::Named(name) = &variable.declared else { continue };
        let inputs: Vec<String> = match (FunctionBlock::named(name), scopes.pou_named(name)) {
            (_, Some(pou)) if pou.kind == PouKind::FunctionBlock => {
                let inputs = pou.variables.iter().filter(|variable| variable.section == SectionKind::Input);
                inputs.map(|variable| variable.name.to_string()).collect()
            }
            (Some(block), None) if wanted(block) => {
                block.inputs.iter().map(|input| input.name.to_string()).collect()
            }
            _ => continue,
        };
        let detail = declared::type_name(&variable.declared, &scopes);
        let rank = 10 + (rank as u16).min(1000);
        let mut proposal = Proposal::new(variable.name.as_str(), CompletionKind::FunctionBlock, detail, rank);
        if calls {
            let inputs = inputs.iter().enumerate().map(|(place, name)| format!("{name} := ${}", place + 1));
            let inputs: Vec<String> = inputs.collect();
            proposal.snippet = Some(format!("{}({})", variable.name, inputs.join(", ")));
        }
        place.propose(typed, proposal);
    }
}

/// What can stand behind the point of `owner`.
fn members(place: &mut Place<'_>, typed: &str, owner: &str) {
    let scopes = place.document.scopes().clone();
    match scopes.type_of(pou(place), owner) {
        Some(DeclaredType::Structure(fields)) => {
            for (name, declared) in fields {
                let detail = declared::type_name(&declared, &scopes);
                place.propose(typed, Proposal::new(name.as_str(), CompletionKind::Variable, detail, 10));
            }
        }
        Some(DeclaredType::Named(block)) => {
            for (name, detail, _) in pins(place, &block) {
                place.propose(typed, Proposal::new(name, CompletionKind::Variable, detail, 10));
            }
        }
        _ => {}
    }
}

/// The inputs and outputs of a block: name, detail, and whether it is an output.
fn pins(place: &Place<'_>, block: &str) -> Vec<(String, String, bool)> {
    let scopes = place.document.scopes();
    let words = |output: bool, kind: String| {
        let message = if output { Message::new("complete.output") } else { Message::new("complete.input") };
        message.with("kind", kind).render(place.language)
    };
    if let Some(pou) = scopes.pou_named(block) {
        let pins = pou.variables.iter().filter(|variable| variable.section.is_parameter());
        let pins = pins.map(|pin| {
            let output = pin.section == SectionKind::Output;
            (pin.name.to_string(), words(output, declared::type_name(&pin.declared, scopes)), output)
        });
        return pins.collect();
    }
    let Some(block) = FunctionBlock::named(block) else { return Vec::new() };
    let inputs = block.inputs.iter().map(|pin| (pin, false));
    let pins = inputs.chain(block.outputs.iter().map(|pin| (pin, true)));
    pins.map(|(pin, output)| {
        let kind = format!("{}: {}", pin.kind.name(), phrase(pin.meaning, place.language));
        (pin.name.to_string(), words(output, kind), output)
    })
    .collect()
}

/// The names of the parameters of `callee`, an instance or a function.
fn parameters(place: &mut Place<'_>, typed: &str, callee: &str) {
    let scopes = place.document.scopes().clone();
    let block = match scopes.type_of(pou(place), callee) {
        Some(DeclaredType::Named(name)) => name.to_string(),
        _ => callee.to_string(),
    };
    for (rank, (name, detail, output)) in pins(place, &block).into_iter().enumerate() {
        let arrow = if output { "=>" } else { ":=" };
        let proposal = Proposal::new(&name, CompletionKind::Variable, detail, rank as u16);
        place.propose(typed, proposal.snippet(format!("{name} {arrow} $1")));
    }
    if let Some(function) = Function::named(callee) {
        for (rank, input) in function.inputs.iter().enumerate() {
            let detail = format!("{}: {}", input.kind.name(), phrase(input.meaning, place.language));
            let proposal = Proposal::new(input.name, CompletionKind::Variable, detail, rank as u16);
            place.propose(typed, proposal.snippet(format!("{} := $1", input.name)));
        }
    }
    propose_variables(place, typed, false);
}

/// The labels of the program unit.
fn labels(place: &mut Place<'_>, typed: &str) {
    let document = place.document;
    let own = pou(place);
    let mut walk = names::PouWalk::default();
    for at in document.chunks() {
        if walk.enter(at.chunk) != own {
            continue;
        }
        for mention in at.chunk.mentions() {
            if let (Symbol::Label(_), Use::Declare) = (&mention.symbol, mention.usage) {
                let line = document.position(at.start + mention.span.start as usize, Encoding::Utf8).line + 1;
                let detail = Message::new("complete.label").with("line", line).render(place.language);
                let label = mention.span.of(at.chunk.text());
                place.propose(typed, Proposal::new(label, CompletionKind::Label, detail, 5));
            }
        }
    }
}

fn functions(place: &mut Place<'_>, typed: &str, rank: u16) {
    for (number, function) in Function::families().enumerate() {
        // ADD, GT and their like are operators as well, and proposed as such.
        if Operator::written(function.name).is_none() {
            let rank = rank + number as u16;
            place.propose(
                typed,
                Proposal::new(
                    function.name,
                    CompletionKind::Function,
                    function.title_in(place.language),
                    rank,
                ),
            );
        }
    }
    let scopes = place.document.scopes().clone();
    for pou in scopes.pous.iter().filter(|pou| pou.kind == PouKind::Function) {
        let detail = Message::new("complete.function").render(place.language);
        place.propose(typed, Proposal::new(pou.name.as_str(), CompletionKind::Function, detail, rank));
    }
}

/// Elementary types, standard blocks, and what the document declares.
fn types(place: &mut Place<'_>, typed: &str) {
    let kind = Message::new("complete.type").render(place.language);
    for (rank, elementary) in ElementaryType::ALL.into_iter().enumerate() {
        place
            .propose(typed, Proposal::new(elementary.name(), CompletionKind::Type, &kind, 100 + rank as u16));
    }
    for (rank, block) in FunctionBlock::all().enumerate() {
        let proposal = Proposal::new(
            block.name,
            CompletionKind::FunctionBlock,
            block.title_in(place.language),
            200 + rank as u16,
        );
        place.propose(typed, proposal);
    }
    let scopes = place.document.scopes().clone();
    let block = Message::new("complete.function-block").render(place.language);
    for pou in scopes.pous.iter().filter(|pou| pou.kind == PouKind::FunctionBlock) {
        place.propose(typed, Proposal::new(pou.name.as_str(), CompletionKind::FunctionBlock, &block, 50));
    }
    let mut names: Vec<_> = scopes.types.keys().collect();
    names.sort();
    for name in names {
        place.propose(typed, Proposal::new(name.as_str(), CompletionKind::Type, &kind, 60));
    }
    for (word, snippet) in [("ARRAY", "ARRAY[${1:0..9}] OF ${2:INT}"), ("STRUCT", "STRUCT\n\t$0\nEND_STRUCT")]
    {
        let detail = Message::new("complete.keyword").render(place.language);
        place.propose(typed, Proposal::new(word, CompletionKind::Keyword, detail, 300).snippet(snippet));
    }
}

fn section_keywords(place: &mut Place<'_>, typed: &str) {
    let detail = Message::new("complete.keyword").render(place.language);
    place.propose(typed, Proposal::new("END_VAR", CompletionKind::Keyword, detail, 10));
}

/// Keywords that start or end program units and sections.
fn unit_keywords(place: &mut Place<'_>, typed: &str) {
    let detail = Message::new("complete.keyword").render(place.language);
    let scopes = place.document.scopes();
    let own = pou(place).and_then(|number| scopes.pous.get(number)).map(|pou| pou.kind);
    let units: &[(&str, &str)] = &[
        ("PROGRAM", "PROGRAM ${1:Main}\nVAR\n\t$2\nEND_VAR\n$0\nEND_PROGRAM"),
        (
            "FUNCTION_BLOCK",
            "FUNCTION_BLOCK ${1:Name}\nVAR_INPUT\n\t$2\nEND_VAR\nVAR_OUTPUT\n\t$3\nEND_VAR\n$0\nEND_FUNCTION_BLOCK",
        ),
        ("FUNCTION", "FUNCTION ${1:Name} : ${2:INT}\nVAR_INPUT\n\t$3\nEND_VAR\n$0\nEND_FUNCTION"),
        ("CONFIGURATION", "CONFIGURATION ${1:Name}\n\t$0\nEND_CONFIGURATION"),
        ("TYPE", "TYPE\n\t${1:Name} : ${2:INT};\nEND_TYPE"),
    ];
    let sections = ["VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR_EXTERNAL", "VAR_TEMP"];
    match own {
        None => {
            for (rank, (word, snippet)) in units.iter().enumerate() {
                let proposal = Proposal::new(*word, CompletionKind::Keyword, &detail, 400 + rank as u16);
                place.propose(typed, proposal.snippet(*snippet));
            }
        }
        Some(kind) => {
            let end = format!("END_{}", declared::pou_keyword(kind));
            place.propose(typed, Proposal::new(end, CompletionKind::Keyword, &detail, 400));
            for (rank, word) in sections.into_iter().enumerate() {
                let proposal = Proposal::new(word, CompletionKind::Keyword, &detail, 410 + rank as u16);
                place.propose(typed, proposal.snippet(format!("{word}\n\t$0\nEND_VAR")));
            }
        }
    }
}
