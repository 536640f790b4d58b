//! The variables that a translation to instruction list of IEC 61131-3 needs.

use crate::document::{DeclaredType, Variable};
use crate::il::iec::SectionKind;
use crate::ladder::CoilKind;
use crate::logic::{FALLS, HELPER, is_fall_name, is_helper_name, pulse_name};
use crate::target::iec::ElementaryType;
use crate::text::folded;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};

/// The names of a program, and the variables that its translation needs beyond them.
#[derive(Clone, Debug, Default)]
pub struct Helpers {
    /// All names, folded.
    taken: FxHashSet<SmolStr>,
    /// The helpers in order.
    pub declared: Vec<Helper>,
    /// The program unit for which helpers are made.
    pub pou: Option<usize>,
    /// The last number of the helpers whose names begin so.
    numbers: FxHashMap<&'static str, usize>,
    /// The helpers that keep power in each program unit, by depth.
    held: FxHashMap<Option<usize>, Vec<SmolStr>>,
    /// Variables that the source declares and nothing in it names, by program unit and type, in the order of their
    /// declaration: a drawing has no word for the detector of an edge contact, so that is what it is called.
    spare: FxHashMap<(Option<usize>, &'static str), Vec<SmolStr>>,
}

/// A variable that a translation needs.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Helper {
    /// Its name.
    pub name: SmolStr,
    /// `BOOL`, `R_TRIG`.
    pub type_name: &'static str,
    /// The program unit that declares it.
    pub pou: Option<usize>,
}

impl Helper {
    /// The variable that it is once it is declared.
    pub(in crate::translate) fn variable(&self) -> Variable {
        let declared = match self.type_name {
            "BOOL" => DeclaredType::Elementary(ElementaryType::Bool),
            name => DeclaredType::Named(folded(name)),
        };
        let (name, section) = (self.name.clone(), SectionKind::Local);
        Variable { name, section, constant: false, declared, address: None, words: SmolStr::default() }
    }
}

impl Helpers {
    /// Helpers with names beside these.
    pub fn beside(names: impl IntoIterator<Item = SmolStr>) -> Helpers {
        let taken = names.into_iter().map(|name| folded(&name)).collect();
        Helpers { taken, ..Helpers::default() }
    }

    /// Variables of program unit `pou` that may be taken in place of new ones.
    pub fn spare(&mut self, pou: Option<usize>, type_name: &'static str, name: SmolStr) {
        self.spare.entry((pou, type_name)).or_default().push(name);
    }

    /// The first spare variable of this type whose name will do.
    fn take(&mut self, type_name: &'static str, will_do: impl Fn(&str) -> bool) -> Option<SmolStr> {
        let spare = self.spare.get_mut(&(self.pou, type_name))?;
        let place = spare.iter().position(|name| will_do(name))?;
        Some(spare.remove(place))
    }

    /// The detector of an edge contact. Those that are named after coils are left to these.
    pub(super) fn detector(&mut self, stem: &'static str, type_name: &'static str) -> SmolStr {
        let is_of_coil = |name: &str| {
            let prefix = name.get(..4);
            prefix.is_some_and(|own| ["PLS_", "PLF_"].iter().any(|prefix| own.eq_ignore_ascii_case(prefix)))
        };
        let spare = self.take(type_name, |name| !is_of_coil(name));
        spare.unwrap_or_else(|| self.declare(stem, type_name))
    }

    /// The detector of a coil of an edge.
    pub(super) fn pulse(&mut self, coil: CoilKind, type_name: &'static str, variable: &str) -> SmolStr {
        let stem = pulse_name(coil, variable);
        let mut number = 1;
        loop {
            let name = if number == 1 { stem.clone() } else { format_smolstr!("{stem}_{number}") };
            if let Some(spare) = self.take(type_name, |spare| spare.eq_ignore_ascii_case(&name)) {
                return spare;
            }
            if self.taken.insert(folded(&name)) {
                self.declared.push(Helper { name: name.clone(), type_name, pou: self.pou });
                return name;
            }
            number += 1;
        }
    }

    /// The variables that find a falling edge, of one number: the one that keeps what a bit was, and the one that is on
    /// where it fell, which is declared only if that `is_asked`.
    pub(super) fn fall(&mut self, is_asked: bool) -> [SmolStr; 2] {
        if let Some(spare) = self.spare_fall(is_asked) {
            return spare;
        }
        loop {
            let number = self.numbers.entry(FALLS[0]).or_default();
            *number += 1;
            let names = FALLS.map(|stem| format_smolstr!("{stem}{number}"));
            if names.iter().any(|name| self.taken.contains(&folded(name))) {
                continue;
            }
            self.taken.extend(names.iter().map(|name| folded(name)));
            let declared = names.iter().take(1 + usize::from(is_asked)).cloned();
            let pou = self.pou;
            self.declared.extend(declared.map(|name| Helper { name, type_name: "BOOL", pou }));
            return names;
        }
    }

    /// The same of spare variables.
    fn spare_fall(&mut self, is_asked: bool) -> Option<[SmolStr; 2]> {
        let spare = self.spare.get_mut(&(self.pou, "BOOL"))?;
        let names = spare.iter().find_map(|was| {
            let number = was.get(FALLS[0].len()..).filter(|_| is_fall_name(was))?;
            let fall = format_smolstr!("{}{number}", FALLS[1]);
            let is_it = was.get(..FALLS[0].len())?.eq_ignore_ascii_case(FALLS[0]);
            let has_fall = spare.iter().any(|name| name.eq_ignore_ascii_case(&fall));
            (is_it && has_fall == is_asked).then(|| [was.clone(), fall])
        })?;
        spare.retain(|name| !names.iter().any(|own| own.eq_ignore_ascii_case(name)));
        Some(names)
    }

    /// A new label.
    pub(super) fn label(&mut self) -> SmolStr {
        let number = self.numbers.entry("").or_default();
        loop {
            *number += 1;
            let name = format_smolstr!("Skip{number}");
            if self.taken.insert(folded(&name)) {
                return name;
            }
        }
    }

    /// The power of a call that has it as an operand of EN.
    pub(super) fn enable(&mut self) -> SmolStr {
        self.declare("Enable", "BOOL")
    }

    /// A new variable.
    fn declare(&mut self, stem: &'static str, type_name: &'static str) -> SmolStr {
        let number = self.numbers.entry(stem).or_default();
        loop {
            *number += 1;
            let name = format_smolstr!("{stem}{number}");
            if self.taken.insert(folded(&name)) {
                self.declared.push(Helper { name: name.clone(), type_name, pou: self.pou });
                return name;
            }
        }
    }

    /// The variable that keeps the power of the path at this depth, from 0.
    pub(super) fn held(&mut self, depth: usize) -> SmolStr {
        if let Some(known) = self.held.get(&self.pou).and_then(|held| held.get(depth)) {
            return known.clone();
        }
        let name = self.take("BOOL", is_helper_name).unwrap_or_else(|| self.declare(HELPER, "BOOL"));
        self.held.entry(self.pou).or_default().push(name.clone());
        name
    }
}
