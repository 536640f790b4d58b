//! What names mean inside of program units: each instance of a unit has a body of its own.

use super::kind::{Extent, Kind, Record};
use super::members::{joined, parts};
use super::names::{Leaf, Names, Step, steps};
use super::place::{At, Place as Variable};
use crate::il::iec::{PouKind, SectionKind};
use crate::simulate::Place;
use crate::target::{DirectAddress, Model, Operand};
use crate::text::folded;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::ops::Range;
use std::sync::Arc;

/// A body of a unit with the variables that it works on. They are in the order of their instructions.
#[derive(Debug)]
pub(super) struct Scope {
    /// The folded name of the unit; empty for what stands outside of all.
    pub(super) unit: SmolStr,
    pub(super) kind: Option<PouKind>,
    pub(super) record: Arc<Record>,
    pub(super) base: Extent,
    /// What is handed over as VAR_IN_OUT, by folded name.
    pub(super) aliases: Vec<(SmolStr, Variable)>,
    /// Its instructions, by their numbers among the places of the code.
    pub(super) instructions: Range<u32>,
    /// The bodies that call it, by their numbers, and where.
    pub(super) callers: Vec<(usize, Place)>,
}

/// What bodies see besides their own variables.
#[derive(Debug, Default)]
pub(super) struct Around {
    pub(super) globals: FxHashMap<SmolStr, Variable>,
    /// Variables that lie at addresses.
    pub(super) located: FxHashMap<DirectAddress, Vec<Variable>>,
}

impl Scope {
    /// The path to its variables, where they lie in a variable to which a path leads.
    fn path_from(&self, variable: &Variable, path: String) -> Option<String> {
        if let Kind::Record(record) = &variable.kind
            && Arc::ptr_eq(record, &self.record)
            && variable.at == At::Memory(self.base)
        {
            return Some(path);
        }
        let inside = |(name, part): (SmolStr, Variable)| {
            // An elementary value has no body.
            part.kind.elementary().is_none().then(|| self.path_from(&part, joined(&path, &name)))?
        };
        parts(variable).into_iter().find_map(inside)
    }
}

impl Names {
    /// The bodies of a unit, letter case aside.
    pub(in crate::simulate) fn scopes_of(&self, unit: &str) -> impl Iterator<Item = usize> {
        let unit = folded(unit);
        let own = self.scopes.iter().enumerate();
        own.filter(move |(_, scope)| scope.unit == unit).map(|(number, _)| number)
    }

    /// How many bodies there are.
    pub(in crate::simulate) fn scope_count(&self) -> usize {
        self.scopes.len()
    }

    /// The folded name of the unit that a body is of.
    pub(in crate::simulate) fn unit_of(&self, scope: usize) -> &str {
        self.scopes.get(scope).map_or("", |scope| &scope.unit)
    }

    /// The bodies that call a body, and where they do.
    pub(in crate::simulate) fn callers_of(&self, scope: usize) -> &[(usize, Place)] {
        self.scopes.get(scope).map_or(&[], |scope| &scope.callers)
    }

    /// The instructions of a body, by their numbers.
    pub(in crate::simulate) fn instructions_of(&self, scope: usize) -> Range<u32> {
        self.scopes.get(scope).map_or(0..0, |scope| scope.instructions.clone())
    }

    /// The body that an instruction with a number belongs to.
    pub(in crate::simulate) fn scope_at(&self, instruction: u32) -> Option<usize> {
        let after = self.scopes.partition_point(|scope| scope.instructions.start <= instruction);
        let own = after.checked_sub(1)?;
        self.scopes[own].instructions.contains(&instruction).then_some(own)
    }

    /// The name of the program, the instance or the function that a body is of, with what stands around it.
    pub(in crate::simulate) fn owner_of(&self, scope: usize) -> Option<String> {
        let scope = self.scopes.get(scope)?;
        let mut roots = self.roots.iter().chain(&self.functions);
        roots.find_map(|root| scope.path_from(&root.variable, root.path.join(".")))
    }

    /// What a name leads to in a body; nothing if it has parts, or subscripts that are no numbers.
    pub(in crate::simulate) fn find_in(&self, scope: usize, name: &str) -> Option<Leaf> {
        if let Operand::Direct(_) = Operand::read(name, Model::Iec) {
            return self.find(name);
        }
        let steps = steps(name)?;
        let (Step::Member(root), rest) = steps.split_first()? else { return None };
        let variable = self.root_in(self.scopes.get(scope)?, root)?;
        self.leaf(&variable, rest)
    }

    /// What a name means wherever a unit is executed: in a program that has several instances in the first of them, in
    /// any other unit if it is the same in all.
    pub(in crate::simulate) fn find_at(&self, unit: &str, name: &str) -> Option<Leaf> {
        let mut scopes = self.scopes_of(unit);
        let first = scopes.next()?;
        let found = self.find_in(first, name)?;
        let is_program = matches!(self.scopes.get(first)?.kind, Some(PouKind::Program) | None);
        let is_one = is_program || scopes.all(|scope| self.find_in(scope, name) == Some(found));
        is_one.then_some(found)
    }

    fn root_in(&self, scope: &Scope, name: &SmolStr) -> Option<Variable> {
        if let Some((_, variable)) = scope.aliases.iter().find(|(own, _)| own == name) {
            return Some(variable.clone());
        }
        match scope.record.field(name) {
            Some(field) if field.section == SectionKind::InOut => None,
            Some(field) if field.section != SectionKind::External => match field.address {
                Some(address) => {
                    let here = self.around.located.get(&address)?;
                    here.iter().find(|variable| variable.kind.is_same(&field.kind)).cloned()
                }
                None => {
                    let behind = if field.edge.is_some() { Extent::BIT.times(2) } else { Extent::default() };
                    let at = scope.base.plus(field.at).plus(behind);
                    Some(Variable::new(field.kind.clone(), at))
                }
            },
            _ => self.around.globals.get(name).cloned().or_else(|| self.undeclared(name)),
        }
    }

    /// A variable that nothing declares, of what stands outside of all units.
    fn undeclared(&self, name: &SmolStr) -> Option<Variable> {
        let is_own = |path: &[SmolStr]| matches!(path, [own] if folded(own) == *name);
        let mut own = self.roots.iter().filter(|root| is_own(&root.path));
        own.find(|root| !matches!(root.variable.kind, Kind::Record(_))).map(|root| root.variable.clone())
    }
}
