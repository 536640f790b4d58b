//! The variables of a program as a debugger shows them: unit by unit, instances and arrays with what is in them.

use super::kind::{Extent, Kind, RecordKind};
use super::names::{Body, Names, Root};
use super::place::{At, Place as Variable};
use smol_str::SmolStr;

/// The variables of a program or of a function, or those that are global.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Scope {
    /// The program with what stands around it, or the function; empty for what is global.
    pub name: String,
    /// Its variables.
    pub members: Vec<Member>,
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
    pub(super) fn scopes(&self) -> Vec<Scope> {
        let mut scopes = vec![Scope::default()];
        for root in self.roots.iter().chain(&self.functions) {
            let (scope, name) = match (&root.variable.kind, root.path.split_last()) {
                // The variables of a unit itself.
                (Kind::Record(record), _) if matches!(record.what, RecordKind::Unit(_)) && root.is_unit => {
                    (root.path.join("."), None)
                }
                (_, Some((name, around))) => (around.join("."), Some(name.clone())),
                (_, None) => (String::new(), None),
            };
            let members = members(&root.variable, MOST_DEPTH);
            let members = match name {
                Some(name) => vec![Member { name, members }],
                None => members,
            };
            match scopes.iter_mut().find(|known| known.name == scope) {
                Some(known) => known.members.extend(members),
                None => scopes.push(Scope { name: scope, members }),
            }
        }
        let direct = self.direct().map(|name| Member { name: name.into(), members: Vec::new() });
        scopes[0].members.extend(direct);
        scopes.retain(|scope| !scope.members.is_empty());
        scopes
    }

    /// The instance or function whose body an instruction belongs to, by the number of that.
    pub(super) fn owner(&self, instruction: u32) -> Option<String> {
        let after = self.bodies.partition_point(|body| body.first <= instruction);
        let Body { unit, base, .. } = *self.bodies.get(after.checked_sub(1)?)?;
        let mut roots = self.roots.iter().chain(&self.functions);
        roots.find_map(|root| instance(&root.variable, root.path.join("."), unit, base))
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
fn parts(variable: &Variable) -> Vec<(SmolStr, Variable)> {
    match &variable.kind {
        Kind::Elementary(..) | Kind::Enumeration(_) => Vec::new(),
        Kind::Array(bounds, element) => {
            let count = super::kind::count(bounds).min(SHOWN_ELEMENTS);
            let part = |number| {
                let part = variable.part((**element).clone(), element.size().times(number))?;
                Some((super::names::subscripts(bounds, number).into(), part))
            };
            (0..count).filter_map(part).collect()
        }
        Kind::Record(record) => {
            let fields = record.fields.iter().filter(|field| field.has_place());
            let part = |field: &super::kind::Field| {
                Some((field.name.clone(), variable.part(field.kind.clone(), field.at)?))
            };
            fields.filter_map(part).collect()
        }
    }
}

/// The path to the variables of a unit that lie at `base`.
fn instance(variable: &Variable, path: String, unit: usize, base: Extent) -> Option<String> {
    if let Kind::Record(record) = &variable.kind
        && matches!(record.what, RecordKind::Unit(own) if own == unit)
        && variable.at == At::Memory(base)
    {
        return Some(path);
    }
    let inside = |(name, part): (SmolStr, Variable)| {
        // An elementary value has no body.
        part.kind.elementary().is_none().then(|| instance(&part, joined(&path, &name), unit, base))?
    };
    parts(variable).into_iter().find_map(inside)
}

/// A name that goes on with a part.
pub fn joined(path: &str, part: &str) -> String {
    match path.is_empty() || part.starts_with('[') {
        true => format!("{path}{part}"),
        false => format!("{path}.{part}"),
    }
}

impl Root {
    /// A program or a function with its own variables, or a variable.
    pub(super) fn new(path: Vec<SmolStr>, variable: &Variable, is_unit: bool) -> Root {
        Root { path, variable: variable.clone(), is_unit }
    }
}
