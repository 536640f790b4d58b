//! The variables of a program as a debugger shows them: unit by unit, instances and arrays with what is in them.

use super::kind::{Field, Kind, count};
use super::names::{Names, subscripts};
use super::place::Place as Variable;
use super::scopes::Scope;
use smol_str::SmolStr;

/// The variables of a program or of a function, or those that are global.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct UnitVariables {
    /// The program with what stands around it, or the function; empty for what is global.
    pub name: String,
    /// Its variables.
    pub members: Vec<Member>,
}

/// What is handed over to the body of a unit as VAR_IN_OUT.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct HandedOver {
    /// The body, by its number.
    pub scope: usize,
    /// The program, the instance or the function that it is of.
    pub owner: String,
    /// What it is called there, with the name that it has elsewhere.
    pub names: Vec<(SmolStr, String)>,
}

/// A variable, or a part of one.
#[derive(Clone, PartialEq, Debug)]
pub struct Member {
    /// As a name goes on with it: `ET`, `[3]`.
    pub name: SmolStr,
    /// Its parts; none of an elementary value.
    pub members: Vec<Member>,
}

/// Further elements of an array are not shown.
const SHOWN_ELEMENTS: u64 = 256;
/// Parts of parts of a variable are shown so deep.
const MOST_DEPTH: usize = 16;

impl Names {
    /// The variables by the units that declare them, global ones first.
    pub(in crate::simulate) fn by_unit(&self) -> Vec<UnitVariables> {
        let mut units = vec![UnitVariables::default()];
        for root in self.roots.iter().chain(&self.functions) {
            let members = members(&root.variable, MOST_DEPTH);
            let (unit, members) = match root.path.split_last() {
                // Not the unit is shown, but its variables.
                Some((name, around)) if !root.is_unit => {
                    (around.join("."), vec![Member { name: name.clone(), members }])
                }
                _ => (root.path.join("."), members),
            };
            match units.iter_mut().find(|known| known.name == unit) {
                Some(known) => known.members.extend(members),
                None => units.push(UnitVariables { name: unit, members }),
            }
        }
        let direct = self.direct().map(|name| Member { name: name.into(), members: Vec::new() });
        units[0].members.extend(direct);
        units.retain(|unit| !unit.members.is_empty());
        units
    }
}

impl Names {
    /// What is handed over to bodies, as far as it has a name of its own: elements whose subscripts are known at run
    /// time only have none.
    pub(in crate::simulate) fn handed_over(&self) -> Vec<HandedOver> {
        let of = |(scope, body): (usize, &Scope)| {
            let named = |(name, variable): &(SmolStr, Variable)| {
                let field = body.record.field(name).map_or(name, |field| &field.name);
                Some((field.clone(), self.path_to(variable)?))
            };
            let names: Vec<_> = body.aliases.iter().filter_map(named).collect();
            let owner = self.owner_of(scope)?;
            (!names.is_empty()).then_some(HandedOver { scope, owner, names })
        };
        self.scopes.iter().enumerate().filter_map(of).collect()
    }

    fn path_to(&self, wanted: &Variable) -> Option<String> {
        fn within(here: &Variable, wanted: &Variable, path: String) -> Option<String> {
            if here.at == wanted.at && here.kind.is_same(&wanted.kind) {
                return Some(path);
            }
            parts(here).into_iter().find_map(|(name, part)| within(&part, wanted, joined(&path, &name)))
        }
        if wanted.index != 0 {
            return None;
        }
        let roots = self.roots.iter().chain(&self.functions);
        roots.into_iter().find_map(|root| within(&root.variable, wanted, root.path.join(".")))
    }
}

/// The parts of a variable and theirs, down to a depth.
fn members(variable: &Variable, depth: usize) -> Vec<Member> {
    if depth == 0 {
        return Vec::new();
    }
    let parts = parts(variable).into_iter();
    parts.map(|(name, part)| Member { name, members: members(&part, depth - 1) }).collect()
}

/// The parts of a variable that have a place of their own.
pub(super) fn parts(variable: &Variable) -> Vec<(SmolStr, Variable)> {
    match &variable.kind {
        Kind::Elementary(..) | Kind::Subrange(..) | Kind::Enumeration(_) => Vec::new(),
        Kind::Array(bounds, element) => {
            let count = count(bounds).min(SHOWN_ELEMENTS);
            let part = |number| {
                let part = variable.part((**element).clone(), variable.size_of(element).times(number))?;
                Some((subscripts(bounds, number).into(), part))
            };
            (0..count).filter_map(part).collect()
        }
        Kind::Record(record) => {
            let fields = record.fields.iter().filter(|field| field.has_place());
            let part =
                |field: &Field| Some((field.name.clone(), variable.part(field.kind.clone(), field.at)?));
            fields.filter_map(part).collect()
        }
    }
}

/// A name that goes on with a part.
pub fn joined(path: &str, part: &str) -> String {
    match path.is_empty() || part.starts_with('[') {
        true => format!("{path}{part}"),
        false => format!("{path}.{part}"),
    }
}
