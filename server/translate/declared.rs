//! What two programs declare under the same name, in other words.

use super::paired::Paired;
use super::source::Source;
use crate::document::{DeclaredType, Document, Pou, Scopes, Tree, Variable};
use crate::il::iec::{self, ItemKind, SectionKind, words_of_body};
use crate::ladder::CompareOperator;
use crate::logic::{Deed, Path, Term, Test};
use crate::target::{Operand, Width};
use crate::text::{Message, Span, folded};
use smol_str::{SmolStr, format_smolstr};
use std::collections::{BTreeMap, BTreeSet};

/// A variable by the number of its program unit and its folded name.
type Key = (Option<usize>, SmolStr);

/// Why programs are not compared that declare something in another way, and where.
type Difference = (Message, [Option<Span>; 2]);

/// The first variable that both programs know under one name, and not alike: in another section, at another address, of
/// another type, or with another value at first. What other files of a project declare counts like the rest.
pub(super) fn difference(
    documents: [&Document; 2],
    sources: [&[Source]; 2],
    paired: &Paired,
) -> Option<Difference> {
    let scopes = documents.map(Document::scopes);
    let used = [0, 1].map(|side| used(documents[side], sources[side]));
    let found = |units: [Option<usize>; 2], name: &SmolStr| {
        let at = [0, 1].map(|side| place(documents[side], units[side], name));
        (Message::new("prove.declared").with("name", name), at)
    };
    for (left, right) in paired.units() {
        let units = [Some(left), Some(right)];
        let pous = [0, 1].map(|side| &scopes[side].pous[units[side].unwrap_or_default()]);
        if pous[0].result != pous[1].result {
            return Some(found(units, &folded(&pous[0].name)));
        }
        let own = pous.into_iter().flat_map(|pou| pou.variables.iter().map(|one| folded(&one.name)));
        let names: BTreeSet<SmolStr> = own.chain(in_unit(&used[0], left)).collect();
        let is_unlike = |name: &&SmolStr| {
            let said = [0, 1]
                .map(|side| scopes[side].variable(units[side], name).map(|one| said(scopes[side], one)));
            let is_used = || (0..2).all(|side| used[side].contains(&(units[side], (*name).clone())));
            match &said {
                [Some(left), Some(right)] => left != right,
                [None, None] => false,
                _ => is_used(),
            }
        };
        if let Some(name) = names.iter().find(is_unlike) {
            return Some(found(units, name));
        }
    }
    let globals = scopes[0].own_globals().chain(scopes[1].own_globals());
    let globals: BTreeSet<&SmolStr> = globals.collect();
    let is_unlike = |name: &&&SmolStr| {
        let sides = scopes.map(|scopes| scopes.globals.get(**name).map(|one| said(scopes, one)));
        matches!(&sides, [Some(left), Some(right)] if left != right)
    };
    if let Some(name) = globals.iter().find(is_unlike) {
        return Some(found([None, None], name));
    }
    if documents.iter().any(|document| document.target().is_fx()) {
        return None;
    }
    let [left, right] = scopes.map(|scopes| &scopes.configured);
    if let Some(path) = left.keys().chain(right.keys()).find(|path| left.get(*path) != right.get(*path)) {
        let name: String = path.split(' ').collect();
        return Some((Message::new("prove.declared").with("name", name), [None, None]));
    }
    // Which programs run, how often, in which order, and what their variables are connected to.
    let [left, right] = documents.map(configurations);
    (left != right).then(|| (Message::new("prove.declared").with("name", "CONFIGURATION"), [None, None]))
}

/// The words of the configurations in a document.
pub(super) fn configurations(document: &Document) -> Vec<SmolStr> {
    if !document.scopes().has_configuration {
        return Vec::new();
    }
    let configured = document.chunks().filter_map(|at| {
        let reading = at.chunk.reading();
        let Tree::Iec(tree) = reading.tree() else { return None };
        let is_one = |kind: &ItemKind| matches!(kind, ItemKind::Configuration { .. });
        let text = reading.text();
        tree.items.iter().any(|item| is_one(&item.kind)).then(|| iec::words(text, Span::new(0, text.len())))
    });
    configured.collect()
}

/// All that is said of a variable: the section in which it stands, its declaration, and what its words mean.
fn said(scopes: &Scopes, variable: &Variable) -> String {
    let mut said = format!("{:?} {} {}", variable.section, variable.constant, variable.words);
    let mut types = BTreeMap::new();
    meaning(scopes, &variable.words, &mut types);
    if variable.section == SectionKind::External
        && let Some(global) = scopes.globals.get(&folded(&variable.name))
    {
        said += &format!("; {:?} {} {}", global.section, global.constant, global.words);
        meaning(scopes, &global.words, &mut types);
    }
    types.into_iter().fold(said, |said, (name, words)| format!("{said}; {name}: {words}"))
}

/// The types that words name, and the blocks of other files, by what is said of them.
fn meaning(scopes: &Scopes, words: &str, types: &mut BTreeMap<SmolStr, String>) {
    let mut waiting = vec![SmolStr::from(words)];
    while let Some(words) = waiting.pop() {
        for word in words.split(' ').filter(|word| !types.contains_key(*word)).collect::<Vec<_>>() {
            let is_own = |number: usize| number < scopes.own_pous().len();
            let block = scopes.pou_number(word).filter(|number| !is_own(*number));
            let said = match (scopes.type_words.get(word), block) {
                (Some(words), _) => words.to_string(),
                (None, Some(number)) => parameters(&scopes.pous[number]),
                (None, None) => continue,
            };
            types.insert(word.into(), said.clone());
            waiting.push(said.into());
        }
    }
}

/// What who calls a block of another file knows of it.
fn parameters(pou: &Pou) -> String {
    let one = |one: &Variable| format!("{:?} {} {} ", one.section, folded(&one.name), one.words);
    pou.variables.iter().filter(|variable| variable.section.is_parameter()).map(one).collect()
}

/// The names that rungs have, with their units.
fn used(document: &Document, sources: &[Source]) -> BTreeSet<Key> {
    let mut found = BTreeSet::new();
    if document.target().is_fx() {
        return found;
    }
    let root = |path: &str| folded(path.split(['.', '[', '^']).next().unwrap_or(path));
    for source in sources {
        match &source.rung.path {
            Ok(path) => {
                let terms = path.iter().flat_map(Path::terms);
                let named = terms.filter(|term| term.operand == Operand::Variable);
                found.extend(named.map(|term| (source.pou, root(&term.text))));
            }
            Err(_) => {
                let words = words_of_body(source.chunk.text(), source.rung.span);
                found.extend(words.split(' ').map(|word| (source.pou, root(word))));
            }
        }
    }
    found
}

fn in_unit(used: &BTreeSet<Key>, unit: usize) -> impl Iterator<Item = SmolStr> {
    used.iter().filter(move |(own, _)| *own == Some(unit)).map(|(_, name)| name.clone())
}

/// Where a unit declares a variable, or where the global variable is declared, if it is in this file.
fn place(document: &Document, unit: Option<usize>, name: &str) -> Option<Span> {
    let (mut started, mut global) = (0, None);
    for (at, _) in document.iec_chunks() {
        let text = at.chunk.text();
        let Some(tree) = at.chunk.iec() else { continue };
        for item in &tree.items {
            match &item.kind {
                ItemKind::Pou { .. } => started += 1,
                ItemKind::Section { kind, declarations, .. } => {
                    let declarations = declarations.of(&tree.declarations).iter();
                    let mut names = declarations.flat_map(|one| one.names.of(&tree.names));
                    let Some(own) = names.find(|own| folded(own.of(text)) == name) else { continue };
                    let own = own.shifted(at.start);
                    match kind {
                        SectionKind::Global => global = global.or(Some(own)),
                        _ if unit.is_some_and(|unit| unit + 1 == started) => return Some(own),
                        _ => {}
                    }
                }
                _ => {}
            }
        }
    }
    global
}

/// The first word that both programs calculate with or compare, and that is a number of another type in each.
pub(super) fn other_type(documents: [&Document; 2], sources: [&[Source]; 2]) -> Option<Difference> {
    let [left, right] = documents.map(Document::target);
    if left.is_fx() && right.is_fx() {
        return None;
    }
    // The FX family has one type for each size, and some of what it does is the same for all of that size.
    let is_mixed = !left.is_kin_of(right);
    let [left, right] = [0, 1].map(|side| words(documents[side], sources[side], is_mixed));
    let (name, types) = left.into_iter().find_map(|(key, left)| {
        let right = right.get(&key)?;
        (left.types != right.types).then(|| (left.name.clone(), [left, right.clone()]))
    })?;
    let [left, right] = types;
    let list = |types: BTreeSet<SmolStr>| types.into_iter().collect::<Vec<_>>().join(", ");
    let at = [Some(left.at), Some(right.at)];
    let message = Message::new("prove.types").with("name", name);
    Some((message.with("left", list(left.types)).with("right", list(right.types)), at))
}

/// The words of a program by their keys.
type Words = BTreeMap<SmolStr, Word>;

#[derive(Clone)]
struct Word {
    /// As it is written first.
    name: SmolStr,
    /// The names of its types, as its places have them.
    types: BTreeSet<SmolStr>,
    /// The first rung that has it.
    at: Span,
}

fn words(document: &Document, sources: &[Source], is_mixed: bool) -> Words {
    let mut found = Words::new();
    for source in sources {
        let Some(path) = source.path() else { continue };
        let is_named = |term: &&Term| matches!(term.operand, Operand::Variable | Operand::Direct(_));
        for term in numbers(path, is_mixed).into_iter().filter(is_named) {
            let new = || Word { name: term.text.clone(), types: BTreeSet::new(), at: source.span() };
            let word = found.entry(term.key()).or_insert_with(new);
            word.types.insert(type_name(document, source.pou, term, is_mixed));
        }
    }
    found
}

/// The operands that are compared or calculated with; with `sign_counts` only where it makes a difference whether they
/// have a sign.
fn numbers(path: &Path, sign_counts: bool) -> Vec<&Term> {
    let mut terms: Vec<&Term> = Vec::new();
    let mut actions = Vec::new();
    path.visit(&mut |action| actions.push(action), &mut |condition| {
        for contact in condition.contacts() {
            let is_order = match contact.test {
                Test::Bit(_) => continue,
                Test::Compare(CompareOperator::Equal { .. } | CompareOperator::NotEqual { .. }) => false,
                Test::Compare(_) => true,
            };
            terms.extend(contact.terms.iter().filter(|_| is_order || !sign_counts));
        }
    });
    for action in actions {
        let Deed::Compute(computation) = &action.deed else { continue };
        let is_alike = computation.copies() || computation.is_bitwise();
        terms.extend(action.terms.iter().filter(|_| !is_alike || !sign_counts));
    }
    terms
}

/// The type of a word, with the limits of a subrange.
fn type_name(document: &Document, unit: Option<usize>, term: &Term, is_mixed: bool) -> SmolStr {
    let scopes = document.scopes();
    if document.target().is_fx() {
        let is_wide = term.address().is_some_and(|address| address.width == Width::Double);
        return if is_wide { "DINT" } else { "INT" }.into();
    }
    match scopes.type_of(unit, &term.text) {
        Some(DeclaredType::Elementary(kind)) => match scopes.limits_of(unit, &term.text) {
            None => kind.name().into(),
            Some((least, greatest)) => format_smolstr!("{kind}({least}..{greatest})"),
        },
        Some(DeclaredType::Named(name)) => name.to_uppercase().into(),
        // What lies at an address is the same wherever nothing is declared of it.
        None if !is_mixed && matches!(term.operand, Operand::Direct(_)) => "%".into(),
        // Rungs without declarations mean plain numbers.
        None if scopes.own_pous().is_empty() && scopes.globals.is_empty() => "INT".into(),
        _ => "?".into(),
    }
}
