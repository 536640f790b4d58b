//! Names of variables, and what they lead to.

use super::image::Image;
use super::kind::{Enumeration, Extent, Kind, RecordKind};
use super::parts::{Lies, Spot};
use super::place::{At, Place as Variable};
use super::scopes::{Around, Scope};
use crate::il::iec::SectionKind;
use crate::target::iec::ElementaryType;
use crate::target::iec::semantics::NOTES;
use crate::target::{Model, Operand};
use crate::text::folded;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::sync::Arc;

/// The variables of a program by name.
#[derive(Debug, Default)]
pub(in crate::simulate) struct Names {
    pub(super) roots: Vec<Root>,
    /// The variables of functions, which are found where nothing else is called so.
    pub(super) functions: Vec<Root>,
    pub(super) scopes: Vec<Scope>,
    pub(super) around: Around,
    enumerations: Vec<Enumerated>,
    pub(in crate::simulate) image: Image,
    /// Variables of instances that lie at addresses, by where they would lie.
    rebound: FxHashMap<Extent, Variable>,
}

/// An enumerated type, with the folded names that it is declared by.
#[derive(Debug)]
struct Enumerated {
    values: Arc<Enumeration>,
    names: Vec<SmolStr>,
}

/// A global variable, a program, or a variable that lies at an address.
#[derive(Debug)]
pub(super) struct Root {
    /// As declared, with what stands around it: `Resource`, `Main`.
    pub(super) path: Vec<SmolStr>,
    pub(super) variable: Variable,
    /// Whether these are the variables of a program or function.
    pub(super) is_unit: bool,
}

/// An elementary value with a name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::simulate) struct Leaf {
    pub(in crate::simulate) spot: Spot,
    /// The number of its enumerated type, if it is of one.
    pub(in crate::simulate) enumeration: Option<u32>,
}

/// A step of a path.
#[derive(PartialEq, Debug)]
pub(super) enum Step {
    Member(SmolStr),
    Element(Vec<i64>),
}

/// More elements of an array are not watched of themselves.
const WATCHED_ELEMENTS: u64 = 16;
/// More elements of an array are not found one by one.
const MOST_ELEMENTS: u64 = 1 << 16;

impl Names {
    pub(super) fn add(&mut self, path: Vec<SmolStr>, variable: &Variable) {
        self.roots.push(Root { path, variable: variable.clone(), is_unit: false });
    }

    /// The variables of a program.
    pub(super) fn add_program(&mut self, path: Vec<SmolStr>, variable: &Variable) {
        self.roots.push(Root { path, variable: variable.clone(), is_unit: true });
    }

    /// The variables of a function.
    pub(super) fn add_function(&mut self, name: SmolStr, variable: &Variable) {
        self.functions.push(Root { path: vec![name], variable: variable.clone(), is_unit: true });
    }

    /// Takes in where addresses lie, and what types are called; names are folded.
    pub(super) fn finish(
        &mut self,
        image: Image,
        kinds: &FxHashMap<SmolStr, Kind>,
        rebound: FxHashMap<Extent, Variable>,
    ) {
        (self.image, self.rebound) = (image, rebound);
        let mut found = Vec::new();
        let roots = self.roots.iter().chain(&self.functions);
        roots.for_each(|root| enumerations(&root.variable.kind, &mut found));
        let named = |values: Arc<Enumeration>| {
            let is_own = |kind: &Kind| matches!(kind, Kind::Enumeration(own) if Arc::ptr_eq(own, &values));
            let names = kinds.iter().filter(|(_, kind)| is_own(kind)).map(|(name, _)| name.clone()).collect();
            Enumerated { values, names }
        };
        self.enumerations = found.into_iter().map(named).collect();
    }

    /// What a name leads to, letter case aside. What stands around a program may be left out, and the program, too,
    /// where the rest is the name of one variable only.
    pub(in crate::simulate) fn find(&self, name: &str) -> Option<Leaf> {
        if let Operand::Direct(address) = Operand::read(name, Model::Iec) {
            return self.image.find(address).map(|spot| Leaf { spot, enumeration: None });
        }
        let steps = steps(name)?;
        self.find_among(&self.roots, &steps).or_else(|| self.find_among(&self.functions, &steps))
    }

    fn find_among(&self, roots: &[Root], steps: &[Step]) -> Option<Leaf> {
        let mut best: Option<(usize, Leaf)> = None;
        let mut is_unique = true;
        for root in roots {
            for skipped in 0..=root.path.len() {
                let suffix = &root.path[skipped..];
                let is_here = suffix.len() <= steps.len()
                    && suffix.iter().zip(steps).all(|(own, step)| *step == Step::Member(folded(own)));
                let leaf = is_here.then(|| self.leaf(&root.variable, &steps[suffix.len()..])).flatten();
                let Some(leaf) = leaf else { continue };
                match best {
                    Some((length, known)) if length == suffix.len() => is_unique &= known == leaf,
                    Some((length, _)) if length > suffix.len() => {}
                    _ => (best, is_unique) = (Some((suffix.len(), leaf)), true),
                }
            }
        }
        best.filter(|_| is_unique).map(|(_, leaf)| leaf)
    }

    pub(super) fn leaf(&self, variable: &Variable, steps: &[Step]) -> Option<Leaf> {
        let Some((step, rest)) = steps.split_first() else {
            let enumeration = match &variable.kind {
                Kind::Enumeration(own) => {
                    let is_own = |other: &Enumerated| Arc::ptr_eq(own, &other.values);
                    self.enumerations.iter().position(is_own).map(|at| at as u32)
                }
                _ => None,
            };
            return Some(Leaf { spot: self.spot(variable)?, enumeration });
        };
        let part = match (step, &variable.kind) {
            (Step::Member(name), Kind::Record(record)) => {
                let field = record.field(name)?;
                field.has_place().then(|| variable.part(field.kind.clone(), field.at))??
            }
            (Step::Element(subscripts), Kind::Array(bounds, element)) if subscripts.len() == bounds.len() => {
                let mut number = 0;
                for (subscript, (least, greatest)) in subscripts.iter().zip(bounds.iter()) {
                    if !(least..=greatest).contains(&subscript) {
                        return None;
                    }
                    number = number * (greatest - least + 1) as u64 + (subscript - least) as u64;
                }
                variable.part((**element).clone(), variable.size_of(element).times(number))?
            }
            _ => return None,
        };
        self.leaf(&part, rest)
    }

    /// The value that a variable is, wherever it lies.
    fn spot(&self, variable: &Variable) -> Option<Spot> {
        let bound = match variable.at {
            At::Memory(at) if variable.kind.elementary().is_some() => self.rebound.get(&at),
            _ => None,
        };
        bound.unwrap_or(variable).spot()
    }

    /// The name of a value of an enumerated type.
    pub(in crate::simulate) fn name_of(&self, enumeration: u32, value: i128) -> Option<&SmolStr> {
        let values = &self.enumerations.get(enumeration as usize)?.values.values;
        values.get(usize::try_from(value).ok()?)
    }

    /// The value of an enumerated type with a name, before which that of the type may stand: `Red`, `Colour#Red`.
    pub(in crate::simulate) fn value_of(&self, enumeration: u32, name: &str) -> Option<i128> {
        let Enumerated { values, names } = self.enumerations.get(enumeration as usize)?;
        let (kind, name) = name.split_once('#').map_or((None, name), |(kind, name)| (Some(kind), name));
        if kind.is_some_and(|kind| !names.contains(&folded(kind))) {
            return None;
        }
        let name = folded(name);
        values.values.iter().position(|own| folded(own) == name).map(|place| place as i128)
    }

    /// The names of variables that are worth watching, as short as they lead to one.
    pub(in crate::simulate) fn watched(&self) -> Vec<String> {
        let mut names = Vec::new();
        for root in &self.roots {
            let mut leaves = Vec::new();
            self.walk(&root.variable, String::new(), &mut leaves, true);
            for (name, spot) in leaves {
                names.push(self.shortest(root, &name, spot));
            }
        }
        names.extend(self.direct());
        names.sort();
        names.dedup();
        names
    }

    /// The addresses at which no variable is declared.
    pub(super) fn direct(&self) -> impl Iterator<Item = String> {
        let is_free = |spot| self.named_at(spot).is_none();
        let named = self.image.named.iter();
        named.filter(move |address| self.image.find(**address).is_some_and(is_free)).map(ToString::to_string)
    }

    /// A variable that is declared at an address, or anywhere else.
    fn named_at(&self, spot: Spot) -> Option<&Root> {
        self.roots.iter().find(|root| root.variable.spot().is_some_and(|own| own.lies == spot.lies))
    }

    fn shortest(&self, root: &Root, name: &str, spot: Spot) -> String {
        let path = |from: usize| {
            let around = root.path[from..].join(".");
            match (around.is_empty(), name.is_empty() || name.starts_with('[')) {
                (true, _) => name.to_string(),
                (false, true) => format!("{around}{name}"),
                (false, false) => format!("{around}.{name}"),
            }
        };
        let least = root.path.len() - usize::from(name.is_empty() && !root.path.is_empty());
        let leads = |name: &String| self.find(name).is_some_and(|leaf| leaf.spot == spot);
        (0..=least).rev().map(path).find(leads).unwrap_or_else(|| path(0))
    }

    /// Finds the elementary parts of a variable. Those that are worth watching are its own, what blocks give, and the
    /// first elements of arrays.
    fn walk(&self, variable: &Variable, name: String, found: &mut Vec<(String, Spot)>, is_watched: bool) {
        match &variable.kind {
            Kind::Elementary(..) | Kind::Subrange(..) | Kind::Enumeration(_) => {
                if let (Some(spot), false) = (self.spot(variable), is_watched && variable.is_constant) {
                    found.push((name, spot));
                }
            }
            Kind::Array(bounds, element) => {
                let most = if is_watched { WATCHED_ELEMENTS } else { MOST_ELEMENTS };
                for number in 0..super::kind::count(bounds).min(most) {
                    let Some(part) =
                        variable.part((**element).clone(), variable.size_of(element).times(number))
                    else {
                        return;
                    };
                    self.walk(&part, name.clone() + &subscripts(bounds, number), found, is_watched);
                }
            }
            Kind::Record(record) => {
                let is_block = matches!(record.what, RecordKind::Block(_));
                for field in &record.fields {
                    let is_shown = !is_watched
                        || !field.is_constant && (!is_block || field.section == SectionKind::Output);
                    if !is_shown || !field.has_place() {
                        continue;
                    }
                    let Some(part) = variable.part(field.kind.clone(), field.at) else { continue };
                    let own = &field.name;
                    let name = if name.is_empty() { own.to_string() } else { format!("{name}.{own}") };
                    self.walk(&part, name, found, is_watched);
                }
                if let (At::Memory(at), true, false) = (variable.at, is_block, is_watched) {
                    let first = at.plus(record.size).words - NOTES as u32;
                    for note in 0..NOTES as u32 {
                        let lies = Lies::Word(first + note);
                        found.push((format!("{name}.#{note}"), Spot::new(ElementaryType::Lint, lies)));
                    }
                }
            }
        }
    }

    /// The name of what lies at a place.
    pub(in crate::simulate) fn name_at(&self, wanted: Spot) -> Option<String> {
        for root in &self.roots {
            let mut leaves = Vec::new();
            self.walk(&root.variable, String::new(), &mut leaves, false);
            if let Some((name, spot)) = leaves.into_iter().find(|(_, spot)| *spot == wanted) {
                return Some(self.shortest(root, &name, spot));
            }
        }
        let direct = self.image.named.iter();
        direct.filter(|address| self.image.find(**address) == Some(wanted)).map(ToString::to_string).next()
    }

    /// All values with their whole names, folded, also what instances of blocks note.
    pub(in crate::simulate) fn all(&self) -> Vec<(String, Spot)> {
        let mut all = Vec::new();
        for root in &self.roots {
            self.walk(&root.variable, root.path.join("."), &mut all, false);
        }
        all.iter_mut().for_each(|(name, _)| *name = folded(name).to_string());
        all
    }
}

/// How the element of an array with a number is called: `[2,3]`.
pub(super) fn subscripts(bounds: &[(i64, i64)], number: u64) -> String {
    let mut rest = number;
    let mut subscripts: Vec<String> = Vec::new();
    for (least, greatest) in bounds.iter().rev() {
        let length = (greatest - least + 1) as u64;
        subscripts.insert(0, (least + (rest % length) as i64).to_string());
        rest /= length;
    }
    format!("[{}]", subscripts.join(","))
}

/// The steps of a name: members, and subscripts that are numbers.
pub(super) fn steps(name: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    for part in name.trim().split('.') {
        let (member, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
        if member.is_empty() {
            return None;
        }
        steps.push(Step::Member(folded(member)));
        while let Some(inside) = rest.strip_prefix('[') {
            let (subscripts, after) = inside.split_once(']')?;
            let numbers: Result<Vec<i64>, _> =
                subscripts.split(',').map(|number| number.trim().parse()).collect();
            steps.push(Step::Element(numbers.ok()?));
            rest = after;
        }
        if !rest.is_empty() {
            return None;
        }
    }
    Some(steps)
}

fn enumerations(kind: &Kind, found: &mut Vec<Arc<Enumeration>>) {
    match kind {
        Kind::Elementary(..) | Kind::Subrange(..) => {}
        Kind::Enumeration(own) => {
            if !found.iter().any(|other| Arc::ptr_eq(own, other)) {
                found.push(Arc::clone(own));
            }
        }
        Kind::Array(_, element) => enumerations(element, found),
        Kind::Record(record) => record.fields.iter().for_each(|field| enumerations(&field.kind, found)),
    }
}
