//! Labels of two programs under the same names: what a label is called makes no difference.

use crate::logic::{Deed, Drive, Path};
use crate::text::folded;
use crate::translate::source::Source;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

/// A label by the number of its program unit.
type Label = (Option<usize>, SmolStr);

/// Gives the labels of the second program the names that those at their places in the first one have, if both have as
/// many and each is one. Jumps of the FX family are instructions of their own and keep their pointers.
pub(super) fn named_alike(sources: &mut [Vec<Source>; 2]) {
    let [left, right] = sources.each_ref().map(|own| labels(own));
    let names: FxHashMap<Label, SmolStr> =
        right.iter().cloned().zip(left.iter().map(|(_, name)| name.clone())).collect();
    let named: FxHashSet<Label> = names.iter().map(|((unit, _), name)| (*unit, name.clone())).collect();
    let is_one_to_one = left.len() == right.len() && names.len() == right.len() && named.len() == left.len();
    // A jump to a label that is nowhere must not get to one.
    let mut is_missed = false;
    each_jump(&mut sources[1], &mut |label| is_missed |= !names.contains_key(label) && named.contains(label));
    if !is_one_to_one || is_missed {
        return;
    }
    for source in &mut sources[1] {
        let unit = source.pou;
        let name =
            |label: &SmolStr| names.get(&(unit, folded(label))).cloned().unwrap_or_else(|| label.clone());
        source.rung.labels.iter_mut().for_each(|label| *label = name(label));
    }
    each_jump(&mut sources[1], &mut |label| {
        if let Some(name) = names.get(label) {
            label.1 = name.clone();
        }
    });
}

fn labels(sources: &[Source]) -> Vec<Label> {
    let of = |source: &Source| {
        let labels = source.rung.labels.iter();
        labels.map(|label| (source.pou, folded(label))).collect::<Vec<_>>()
    };
    sources.iter().flat_map(of).collect()
}

/// Calls `found` with the label of each jump, which it may change.
fn each_jump(sources: &mut [Source], found: &mut impl FnMut(&mut Label)) {
    for source in sources {
        let unit = source.pou;
        if let Ok(Some(path)) = &mut source.rung.path {
            jumps_of(path, unit, found);
        }
    }
}

fn jumps_of(path: &mut Path, unit: Option<usize>, found: &mut impl FnMut(&mut Label)) {
    for drive in &mut path.drives {
        match drive {
            Drive::Path(path) => jumps_of(path, unit, found),
            Drive::Action(action) if action.deed == Deed::Jump => {
                for term in &mut action.terms {
                    let mut label = (unit, folded(&term.text));
                    let before = label.1.clone();
                    found(&mut label);
                    if label.1 != before {
                        term.text = label.1;
                    }
                }
            }
            Drive::Action(_) => {}
        }
    }
}
