//! What a translation to instruction list of IEC 61131-3 declares: a program around the rungs where the source has
//! none, and the helpers that it needs.

use super::dialect;
use super::source::{Program, Source};
use super::to_iec::{Helper, Helpers};
use crate::document::{DeclaredType, Document, Scopes, Tree};
use crate::il::iec::{self, SectionKind};
use crate::logic::{Action, Deed, Expression, Path, Term, Test, is_fall_name, is_helper_name};
use crate::target::iec::{ENO, ElementaryType, LiteralValue};
use crate::target::{DeviceKind, DirectAddress, Model, Operand, Target, Width};
use crate::text::folded;
use rustc_hash::FxHashSet;
use smol_str::{SmolStr, format_smolstr};

/// The name of a program that has none.
const PROGRAM: &str = "Main";

/// All names that a program uses or declares.
pub(super) fn names<'s>(document: &Document, sources: impl Iterator<Item = &'s Source>) -> Vec<SmolStr> {
    let scopes = document.scopes();
    let mut names: Vec<SmolStr> = vec![PROGRAM.into()];
    for pou in &scopes.pous {
        names.push(pou.name.clone());
        names.extend(pou.variables.iter().map(|variable| variable.name.clone()));
    }
    names.extend(scopes.globals.values().map(|variable| variable.name.clone()));
    for source in sources {
        names.extend(source.rung.labels.iter().cloned());
        for path in source.rung.path.iter().flatten() {
            visit(path, &mut |term, _| names.push(root(term).into()));
        }
    }
    names
}

/// `helpers` with the variables of each program unit that may be taken in place of new ones: detectors of edges and
/// keepers of power that nothing in the rungs names.
pub(super) fn with_spare(mut helpers: Helpers, document: &Document, sources: &[Source]) -> Helpers {
    let mut named: FxHashSet<(Option<usize>, SmolStr)> = FxHashSet::default();
    for source in sources {
        match &source.rung.path {
            Ok(path) => path.iter().for_each(|path| {
                visit(path, &mut |term, _| _ = named.insert((source.pou, folded(root(term)))));
            }),
            Err(_) => {
                let text = source.rung.span.of(source.chunk.text());
                let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
                named.extend(words.map(|word| (source.pou, folded(word))));
            }
        }
    }
    let keeps = |name: &str| is_helper_name(name) || is_fall_name(name);
    for (unit, pou) in document.scopes().own_pous().iter().enumerate() {
        for variable in &pou.variables {
            let is_plain =
                variable.section == SectionKind::Local && variable.address.is_none() && !variable.has_value();
            if !is_plain || named.contains(&(Some(unit), folded(&variable.name))) {
                continue;
            }
            let type_name = match &variable.declared {
                DeclaredType::Elementary(ElementaryType::Bool) if keeps(&variable.name) => "BOOL",
                DeclaredType::Named(name) if name.eq_ignore_ascii_case("R_TRIG") => "R_TRIG",
                _ => continue,
            };
            helpers.spare(Some(unit), type_name, variable.name.clone());
        }
    }
    helpers
}

/// What the use of a variable says about its type.
#[derive(Clone)]
enum Use {
    Bit,
    /// Compared with this.
    Beside(Term),
    /// An instance of this block, or a value of this type.
    Type(SmolStr),
    /// A number of this type.
    Of(&'static str),
    Label,
}

/// Calls `found` with each operand of a path and what it is used for.
fn visit<'p>(path: &'p Path, found: &mut impl FnMut(&'p Term, Use)) {
    let found = std::cell::RefCell::new(found);
    let action = |action: &'p Action| match &action.deed {
        Deed::Call(call) => {
            let arguments = call.arguments(&action.terms);
            let formals = [call.block.inputs(), call.block.outputs()].concat();
            for (number, term) in action.terms.iter().enumerate() {
                let kind = match number.checked_sub(1).and_then(|number| arguments.get(number)) {
                    None => call.block.name().into(),
                    Some(argument) if argument.name == ENO.name => ElementaryType::Bool.name().into(),
                    Some(argument) => {
                        let formal = formals.iter().find(|formal| formal.name == argument.name);
                        formal.and_then(|formal| formal.type_name.clone()).unwrap_or("INT".into())
                    }
                };
                found.borrow_mut()(term, Use::Type(kind));
            }
        }
        Deed::Compute(computation) if computation.is_declared() => {
            let inputs = computation.inputs().into_iter().map(|formal| formal.type_name);
            let kinds = inputs.chain([computation.function.result_type()]);
            for (term, kind) in action.terms.iter().zip(kinds) {
                found.borrow_mut()(term, Use::Type(kind.unwrap_or("INT".into())));
            }
        }
        Deed::Compute(computation) if let Some([input, result]) = computation.conversion.types() => {
            for (place, term) in action.terms.iter().enumerate() {
                let is_result = place + 1 == action.terms.len();
                found.borrow_mut()(term, Use::Of(if is_result { result } else { input }));
            }
        }
        Deed::Compute(_) => {
            for term in &action.terms {
                let other = action.terms.iter().find(|other| matches!(other.operand, Operand::Literal(_)));
                found.borrow_mut()(term, Use::Beside(other.unwrap_or(term).clone()));
            }
        }
        Deed::Jump => action.terms.iter().for_each(|term| found.borrow_mut()(term, Use::Label)),
        _ => action.terms.iter().for_each(|term| found.borrow_mut()(term, Use::Bit)),
    };
    let condition = |expression: &'p Expression| {
        expression.visit(&mut |contact| match (contact.test, &contact.terms[..]) {
            (Test::Compare(_), [left, right]) => {
                found.borrow_mut()(left, Use::Beside(right.clone()));
                found.borrow_mut()(right, Use::Beside(left.clone()));
            }
            _ => contact.terms.iter().for_each(|term| found.borrow_mut()(term, Use::Bit)),
        });
    };
    path.visit(&mut { action }, &mut { condition });
}

fn root(term: &Term) -> &str {
    let end = term.text.find(['.', '[', '^']).unwrap_or(term.text.len());
    &term.text[..end]
}

/// The header of a program without one: its variables, typed by the declarations of the source if there are any, else
/// by their use, and the helpers. Those that stand for latched devices are RETAIN. Global variables of other files stay
/// where they are.
pub(super) fn header(document: &Document, program: &Program, helpers: &[Helper]) -> String {
    let sources = &program.rungs;
    let is_kept = |term: &Term| match (term.address(), Operand::read(root(term), document.target().model)) {
        _ if !document.target().is_fx() => false,
        (Some(address), _) => dialect::is_kept(address, document),
        (None, Operand::Device(device)) => document.keeps(device),
        _ => false,
    };
    let scopes = document.scopes();
    let mut known: FxHashSet<SmolStr> = FxHashSet::default();
    let mut variables: Vec<(SmolStr, SmolStr)> = Vec::new();
    let mut kept = Vec::new();
    let paths = || sources.iter().filter_map(|source| source.rung.path.as_ref().ok()?.as_ref());
    // Instances first, for a member of one says nothing of its type.
    for is_instance in [true, false] {
        for path in paths() {
            visit(path, &mut |term, usage| {
                let name = root(term);
                let is_whole = name.len() == term.text.len();
                let own = declared_type(scopes, name).or_else(|| block_of(document, name));
                let address = term.address().filter(|_| document.target().is_fx());
                let declared = own.or_else(|| address.and_then(type_at));
                let by_use = type_by_use(&usage).filter(|_| is_whole);
                let calls = matches!(usage, Use::Type(_));
                let type_name = if calls { by_use.or(declared) } else { declared.or(by_use) };
                let Some(mut type_name) = type_name else { return };
                if let Some(preset) = program.presets.get(name).filter(|_| type_name == "CTU") {
                    type_name = format_smolstr!("{type_name} := (PV := {preset})");
                }
                if term.operand == Operand::Variable && calls == is_instance && known.insert(folded(name)) {
                    let name = match address {
                        Some(address) => format_smolstr!("{name} AT {address}"),
                        None => name.into(),
                    };
                    if is_kept(term) { &mut kept } else { &mut variables }.push((name, type_name));
                }
            });
        }
    }
    let is_elsewhere = |name: &str| document.outer().is_some() && scopes.is_global_elsewhere(name);
    let (external, mut variables): (Vec<_>, Vec<_>) =
        variables.into_iter().partition(|(name, _)| is_elsewhere(name));
    variables.extend(helpers.iter().map(|helper| (helper.name.clone(), helper.type_name.into())));
    let sections = [("VAR_EXTERNAL", &external), ("VAR RETAIN", &kept), ("VAR", &variables)]
        .map(|(keyword, own)| section(keyword, own));
    format!("PROGRAM {PROGRAM}\n{}\n", sections.concat())
}

/// The declarations of the helpers of a program unit; empty if it has none.
pub(super) fn helpers_of(helpers: &[Helper], pou: Option<usize>) -> String {
    let own = helpers.iter().filter(|helper| helper.pou == pou);
    section("VAR", &own.map(|helper| (helper.name.clone(), helper.type_name.into())).collect::<Vec<_>>())
}

fn section(keyword: &str, variables: &[(SmolStr, SmolStr)]) -> String {
    if variables.is_empty() {
        return String::new();
    }
    let lines: String = variables.iter().map(|(name, kind)| format!("{name} : {kind};\n")).collect();
    format!("{keyword}\n{lines}END_VAR\n")
}

/// The type with which tables of the source declare a variable.
fn declared_type(scopes: &Scopes, name: &str) -> Option<SmolStr> {
    match scopes.type_of(None, name)? {
        DeclaredType::Elementary(kind) => Some(kind.name().into()),
        DeclaredType::Named(name) => Some(name.to_uppercase().into()),
        _ => None,
    }
}

/// The block that stands for a timer or a counter of the FX family, also where nothing drives it.
fn block_of(document: &Document, name: &str) -> Option<SmolStr> {
    let model = document.target().model;
    match Operand::read(name, model) {
        Operand::Device(device) if device.kind.has_preset() && model != Model::Iec => {
            Some(if device.kind == DeviceKind::T { "TON" } else { "CTU" }.into())
        }
        _ => None,
    }
}

/// The type of the variable that stands for a device at this address.
fn type_at(address: DirectAddress) -> Option<SmolStr> {
    match address.width {
        Width::Bit => Some("BOOL".into()),
        Width::Word => Some("INT".into()),
        Width::Double => Some("DINT".into()),
        _ => None,
    }
}

fn type_by_use(usage: &Use) -> Option<SmolStr> {
    match usage {
        Use::Bit => Some("BOOL".into()),
        Use::Type(name) => Some(name.clone()),
        Use::Of(name) => Some((*name).into()),
        Use::Beside(other) => Some(match other.operand {
            Operand::Literal(literal) => match literal.value {
                LiteralValue::Time(_) => "TIME".into(),
                LiteralValue::Real(_) => "REAL".into(),
                _ => literal.named_type.map_or("INT".into(), |kind| kind.name().into()),
            },
            _ => "INT".into(),
        }),
        Use::Label => None,
    }
}

/// The comments of declarations.
pub(super) fn comments(text: &str) -> Vec<String> {
    let tree = iec::parse(text, Target::of(Model::Iec));
    tree.comments.iter().map(|comment| comment.of(text).trim_end().to_string()).collect()
}

/// The canonical layout of a piece of instruction list, as the formatter has it.
pub(super) fn laid_out(text: &str) -> String {
    let target = Target::of(Model::Iec);
    let options = iec::FormatOptions::default();
    let mut start = 0;
    let mut laid_out = String::with_capacity(text.len());
    for end in iec::split(text) {
        let piece = &text[std::mem::replace(&mut start, end)..end];
        let tree = iec::parse(piece, target);
        laid_out += &iec::format_chunk(piece, &tree, &options);
    }
    laid_out
}

/// Whether a document declares program units of its own, around its rungs.
pub(super) fn has_units(document: &Document) -> bool {
    document.chunks().any(|at| {
        let Some(tree) = at.chunk.is_iec().then(|| at.chunk.tree()) else { return false };
        matches!(tree, Tree::Iec(tree) if tree.items.iter().any(|item| matches!(item.kind, iec::ItemKind::Pou { .. })))
    })
}

/// A comment as instruction list of IEC 61131-3 has it.
pub(super) fn comment(comment: &str) -> String {
    if comment.starts_with('{') {
        // Braces may nest in a drawing.
        return format!("(* {} *)", comment.replace("(*", "( *").replace("*)", "* )"));
    }
    let line = comment.strip_prefix("//").or_else(|| comment.strip_prefix(';'));
    match line {
        Some(text) if !text.contains("*)") && !text.contains("(*") => format!("(* {} *)", text.trim()),
        Some(text) => format!("(* {} *)", text.replace("(*", "( *").replace("*)", "* )").trim()),
        None => comment.to_string(),
    }
}
