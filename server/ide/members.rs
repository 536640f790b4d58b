//! Parameters and members of declared function blocks and functions, where callers name them: `Valve.Open`,
//! `CAL Valve(Open := a)`, `Open Valve`, and the pins of boxes.

use crate::document::{Chunk, DeclaredType, Scopes, Tree, Use};
use crate::il::iec::{Direction, IecTree, ItemKind, OperandId, ParameterValue, Run};
use crate::ladder::{ElementKind, LadderTree};
use crate::target::Operand;
use crate::target::iec::OperatorRole;
use crate::text::{Span, folded};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// A parameter named from outside of its program unit.
pub(super) struct Member {
    /// The name's cells in the chunk.
    pub span: Span,
    /// The number of the unit that declares it.
    pub pou: usize,
    /// Its folded name.
    pub name: SmolStr,
    pub usage: Use,
}

/// All of `chunk`, which stands in POU number `pou`.
pub(super) fn of(chunk: &Chunk, pou: Option<usize>, scopes: &Scopes) -> Vec<Member> {
    // Without a declared unit nothing can be its parameter, which is the case in most documents.
    if scopes.pous.is_empty() {
        return Vec::new();
    }
    let mut search = Search { text: chunk.text(), pou, scopes, found: Vec::new() };
    match chunk.tree() {
        Tree::Iec(tree) => search.iec(tree),
        Tree::Ladder(tree) => search.ladder(tree),
        Tree::Fx(_) => {}
    }
    search.found.sort_by_key(|member| member.span);
    search.found
}

struct Search<'a> {
    text: &'a str,
    pou: Option<usize>,
    scopes: &'a Scopes,
    found: Vec<Member>,
}

impl Search<'_> {
    fn iec(&mut self, tree: &IecTree) {
        let mut written: FxHashSet<OperandId> = FxHashSet::default();
        for parameter in &tree.parameters {
            if let (Direction::Out { .. }, ParameterValue::Operand(id)) =
                (parameter.direction, parameter.value)
            {
                written.insert(id);
            }
        }
        for item in &tree.items {
            match item.kind {
                ItemKind::Operation { operation, operand: Some(id) }
                    if matches!(
                        operation.operator.role,
                        OperatorRole::Store | OperatorRole::Latch { .. }
                    ) =>
                {
                    written.insert(id);
                }
                ItemKind::Call { callee: Some(callee), parameters, .. } => {
                    self.parameters(tree, tree.operand(callee).span, parameters);
                }
                ItemKind::Function { name, parameters, .. } => self.parameters(tree, name, parameters),
                ItemKind::InputOperator { input, instance } => {
                    if let Some(unit) = self.unit_of(tree.operand(instance).span.of(self.text)) {
                        self.add(unit, input, Use::Write);
                    }
                }
                _ => {}
            }
        }
        for (index, operand) in tree.operands.iter().enumerate() {
            let usage = if written.contains(&OperandId(index as u32)) { Use::Write } else { Use::Read };
            if operand.value == Operand::Variable {
                self.path(operand.span, usage);
            }
        }
    }

    fn ladder(&mut self, tree: &LadderTree) {
        for element in tree.rungs.iter().flat_map(|rung| &rung.graph.elements) {
            for operand in element.operands.iter().filter(|operand| operand.value == Operand::Variable) {
                let usage = if matches!(element.kind, ElementKind::Coil(_)) { Use::Write } else { Use::Read };
                self.path(operand.span, usage);
            }
            let ElementKind::Block(block) = &element.kind else { continue };
            let Some(unit) = block.type_name.and_then(|name| self.unit_named(name.of(self.text))) else {
                continue;
            };
            for pin in block.inputs.iter().filter_map(|pin| pin.name) {
                self.add(unit, pin, Use::Write);
            }
            for pin in block.outputs.iter().filter_map(|pin| pin.name) {
                self.add(unit, pin, Use::Read);
            }
        }
    }

    /// The members in a path such as `Valve.Open`; `usage` is that of its end.
    fn path(&mut self, span: Span, usage: Use) {
        let text = span.of(self.text);
        let mut from = 0;
        while let Some(point) = text.get(from..).and_then(|rest| rest.find('.')).map(|point| from + point) {
            let rest = &text[point + 1..];
            let end = point + 1 + rest.find(['.', '[', '^']).unwrap_or(rest.len());
            if let Some(unit) = self.unit_of(&text[..point]) {
                let start = span.start as usize;
                let usage = if end == text.len() { usage } else { Use::Read };
                self.add(unit, Span::new(start + point + 1, start + end), usage);
            }
            from = end.max(point + 1);
        }
    }

    fn parameters(&mut self, tree: &IecTree, callee: Span, parameters: Run) {
        let callee = callee.of(self.text);
        let Some(unit) = self.unit_of(callee).or_else(|| self.unit_named(callee)) else { return };
        for parameter in parameters.of(&tree.parameters) {
            let usage = match parameter.direction {
                Direction::In => Use::Write,
                Direction::Out { .. } => Use::Read,
            };
            if let Some(name) = parameter.name {
                self.add(unit, name, usage);
            }
        }
    }

    /// The number of the unit that is the type of the variable at `path`.
    fn unit_of(&self, path: &str) -> Option<usize> {
        match self.scopes.type_of(self.pou, path)? {
            DeclaredType::Named(name) => self.unit_named(&name),
            _ => None,
        }
    }

    fn unit_named(&self, name: &str) -> Option<usize> {
        self.scopes.pou_number(name)
    }

    fn add(&mut self, pou: usize, span: Span, usage: Use) {
        let name = span.of(self.text);
        if let Some(variable) = self.scopes.variable(Some(pou), name) {
            let name = folded(&variable.name);
            self.found.push(Member { span, pou, name, usage });
        }
    }
}
