//! What an undeclared name would have to be declared as, by the ways in which it is used.

use crate::check::iec::{View, follow};
use crate::il::iec::ItemKind;
use crate::target::Operand;
use crate::target::iec::FunctionBlock;
use crate::text::folded;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

/// The blocks that a call may mean, likeliest first.
const BLOCKS: &[&str] = &["TON", "CTU", "CTD", "CTUD", "R_TRIG", "SR", "RS"];

/// The type of each of `names` that can be told, in the chunks of one POU; BOOL where a plain name is used in a way
/// that does not tell.
pub fn types_of(views: &[View<'_>], names: &FxHashSet<SmolStr>) -> FxHashMap<SmolStr, String> {
    let mut kinds: FxHashMap<SmolStr, String> = FxHashMap::default();
    let mut pins: FxHashMap<SmolStr, Vec<String>> = FxHashMap::default();
    for view in views {
        for guess in follow(*view).1 {
            let path = folded(view.word(guess.operand));
            if names.contains(&path) {
                kinds.entry(path).or_insert_with(|| guess.kind.name().to_string());
            }
        }
        members(view, names, &mut pins);
    }
    let mut types = FxHashMap::default();
    for name in names {
        match (pins.get(name), kinds.get(name)) {
            (Some(pins), _) => {
                let has = |block: &FunctionBlock, pin: &String| {
                    block.input_named(pin).is_some() || block.output_named(pin).is_some()
                };
                let block = BLOCKS.iter().find(|block| {
                    !pins.is_empty()
                        && FunctionBlock::named(block)
                            .is_some_and(|block| pins.iter().all(|pin| has(block, pin)))
                });
                types.extend(block.map(|block| (name.clone(), block.to_string())));
            }
            (None, Some(kind)) => _ = types.insert(name.clone(), kind.clone()),
            (None, None) => _ = types.insert(name.clone(), "BOOL".to_string()),
        }
    }
    types
}

/// The parameters and members of what looks like an instance.
fn members(view: &View<'_>, names: &FxHashSet<SmolStr>, pins: &mut FxHashMap<SmolStr, Vec<String>>) {
    for operand in view.tree.operands.iter().filter(|operand| operand.value == Operand::Variable) {
        let path = operand.span.of(view.text);
        let end = path.find(['.', '[', '^']).unwrap_or(path.len());
        let (root, rest) = path.split_at(end);
        let root = folded(root);
        if !rest.is_empty() && names.contains(&root) {
            // A subscript makes it an array, of which nothing more is known.
            let member =
                rest.strip_prefix('.').map_or("?", |member| member.split(['.', '[']).next().unwrap_or(""));
            pins.entry(root).or_default().push(member.to_string());
        }
    }
    for item in &view.tree.items {
        match item.kind {
            ItemKind::Call { callee: Some(id), parameters, .. } => {
                let name = folded(view.word(id));
                if names.contains(&name) {
                    let given = parameters.of(&view.tree.parameters).iter().filter_map(|one| one.name);
                    let given = given.map(|name| name.of(view.text).to_string());
                    pins.entry(name).or_default().extend(given);
                }
            }
            ItemKind::InputOperator { input, instance } => {
                let name = folded(view.word(instance));
                if names.contains(&name) {
                    pins.entry(name).or_default().push(input.of(view.text).to_string());
                }
            }
            _ => {}
        }
    }
}
