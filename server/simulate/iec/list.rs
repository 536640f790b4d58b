//! Compiles instruction list of IEC 61131-3, item by item.

use super::compile::Compiler;
use super::current::{Current, Given};
use super::declarations::Source;
use super::kind::Kind;
use super::operand::{Value, cell_spot, said};
use super::parts::{Input, Lies, Spot};
use crate::il::iec::{Condition, Item, ItemKind, ListForm, OperandId, Operation, Parameter};
use crate::simulate::builder::Position;
use crate::simulate::code::Op;
use crate::simulate::row::Row;
use crate::simulate::{Cell, Obstacle};
use crate::target::iec::{ElementaryType, Formula, Function, GenericType, OperatorRole};
use crate::target::{Model, Operand as TargetOperand};
use crate::text::{Message, Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::ops::Range;

/// What a body knows of its labels and jumps.
#[derive(Default)]
pub(super) struct Jumps {
    /// Ops behind labels.
    labels: FxHashMap<SmolStr, u32>,
    /// Labels behind which the current result is used, with the type that it has there.
    results: FxHashMap<SmolStr, Option<ElementaryType>>,
    /// Ops that go to labels, and where that is written.
    jumps: Vec<(u32, SmolStr, crate::simulate::Place)>,
    /// Ops that leave the unit.
    pub(super) returns: Vec<u32>,
}

/// Instructions of a source.
pub(super) struct List<'c, 'a> {
    pub(super) compiler: &'c mut Compiler<'a>,
    pub(super) source: usize,
    pub(super) text: &'a str,
    pub(super) items: &'a [Item],
    pub(super) parameters: &'a [Parameter],
    pub(super) current: Current,
    /// What waits for closing parentheses.
    pub(super) open: Vec<Open>,
    pub(super) depth: usize,
    /// Whether the current result is missing because an instruction before was refused.
    is_lost: bool,
    /// The relay that tells whether the condition holds that the present instruction is, and whether that inverts it.
    condition: Option<(Cell, bool)>,
}

/// An operator whose operand is in parentheses.
pub(super) struct Open {
    operation: Operation,
    before: Current,
}

type Outcome = Result<(), Obstacle>;

impl<'a> Compiler<'a> {
    /// Compiles instructions of the body that is being compiled; `current` is the result before them.
    pub(super) fn list(&mut self, source: usize, items: Range<usize>, current: Current) -> Current {
        let Source { text, tree, .. } = self.declared.sources[source];
        let mut list = List {
            compiler: self,
            source,
            text,
            items: &tree.items[..],
            parameters: &tree.parameters,
            current,
            open: Vec::new(),
            depth: 0,
            is_lost: false,
            condition: None,
        };
        list.run(items);
        list.current
    }

    /// Finds the labels of a list behind which the current result is used.
    pub(super) fn find_labels(&mut self, source: usize, items: Range<usize>) {
        let Source { text, tree, .. } = self.declared.sources[source];
        for at in items {
            let ItemKind::Label { name } = tree.items[at].kind else { continue };
            let next = tree.items[at..].iter().find(|item| !matches!(item.kind, ItemKind::Label { .. }));
            if next.is_some_and(|next| uses_result(&next.kind)) {
                self.jumps.results.insert(folded(name.of(text)), None);
            }
        }
    }

    /// Goes to a label while a cell is on.
    pub(super) fn jump(&mut self, power: Cell, label: &str, place: crate::simulate::Place) {
        let op = self.builder.op(Op::Jump { power, to: 0 });
        self.jumps.jumps.push((op, folded(label), place));
    }

    /// A label stands here.
    pub(super) fn label(&mut self, label: &str) {
        let here = self.builder.here();
        self.jumps.labels.entry(folded(label)).or_insert(here);
    }

    /// Tells jumps where they go, at the end of a body.
    pub(super) fn land(&mut self) {
        let jumps = std::mem::take(&mut self.jumps);
        let end = self.builder.here();
        for (op, label, place) in jumps.jumps {
            match jumps.labels.get(&label) {
                Some(to) => self.send(op, *to),
                None => self.refuse(place, said("simulate.no-label-named", &label)),
            }
        }
        for op in jumps.returns {
            self.send(op, end);
        }
    }

    pub(super) fn send(&mut self, op: u32, target: u32) {
        if let Some(Op::Jump { to, .. }) = self.builder.op_mut(op) {
            *to = target;
        }
    }

    /// A cell that is on while another one is off.
    pub(super) fn inverse(&mut self, cell: Cell) -> Cell {
        let power = self.builder.has_power().then(|| self.builder.power());
        let to = self.builder.scratch();
        self.builder.forget_power();
        self.builder.connect(Position::First, cell, true);
        self.builder.out(to, false);
        match power {
            Some(power) => self.builder.set_power(power),
            None => self.builder.forget_power(),
        }
        to
    }
}

/// What an instruction tells of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sees {
    /// What it sees before it acts on something else than the current result.
    First,
    /// What has become of the current result.
    Result,
    Nothing,
}

fn sees(kind: &ItemKind) -> Sees {
    match kind {
        ItemKind::Operation { operation, .. } => match operation.operator.role {
            OperatorRole::Store | OperatorRole::Latch { .. } => Sees::First,
            _ => Sees::Result,
        },
        ItemKind::Call { .. }
        | ItemKind::InputOperator { .. }
        | ItemKind::Jump { .. }
        | ItemKind::Return { .. } => Sees::First,
        ItemKind::Label { .. } => Sees::Nothing,
        _ => Sees::Result,
    }
}

/// Whether an instruction goes on with the current result.
fn uses_result(kind: &ItemKind) -> bool {
    match kind {
        ItemKind::Operation { operation, .. } => operation.operator.role != OperatorRole::Load,
        ItemKind::Call { condition, .. }
        | ItemKind::Jump { condition, .. }
        | ItemKind::Return { condition, .. } => *condition != Condition::Always,
        ItemKind::Function { form, .. } => *form == ListForm::None,
        ItemKind::Open { .. } | ItemKind::InputOperator { .. } => true,
        _ => false,
    }
}

impl<'a> List<'_, 'a> {
    pub(super) fn word(&self, id: OperandId) -> &'a str {
        self.compiler.declared.operand(self.source, id)
    }

    pub(super) fn run(&mut self, items: Range<usize>) {
        let mut at = items.start;
        while at < items.end {
            let item = self.items[at];
            self.at(item.span);
            let instruction = self.compiler.builder.instruction();
            self.reached(item, instruction);
            let sees = sees(&item.kind);
            self.condition = None;
            if sees == Sees::First {
                self.goes_on(item.kind);
                self.saw(instruction);
            }
            let next = self.item(at, item);
            at = match next {
                Ok(next) => {
                    self.is_lost &= matches!(self.current, Current::Nothing);
                    next
                }
                Err(obstacle) => {
                    let follows = self.is_lost && obstacle == Obstacle::NoCurrentResult;
                    self.refuse(item.span, if follows { Obstacle::Follows } else { obstacle });
                    self.is_lost = true;
                    self.current = Current::Nothing;
                    self.compiler.builder.forget_power();
                    self.behind(at)
                }
            };
            if sees == Sees::Result {
                self.saw(instruction);
            }
        }
    }

    /// Lets a debugger stop before an instruction, and know the current result there.
    fn reached(&mut self, item: Item, instruction: u32) {
        if matches!(item.kind, ItemKind::Label { .. }) || !self.compiler.builder.is_watched() {
            return;
        }
        self.compiler.builder.reached();
        let result = match &self.current {
            Current::Nothing | Current::Whole(_) => return,
            Current::Bit => {
                let power = self.compiler.builder.settle();
                Given::at(cell_spot(power))
            }
            Current::Given(given) => given.clone(),
        };
        self.compiler.parts.results.insert(instruction, (result.input, result.kind));
    }

    /// Says that an instruction is executed, with the current result if that is a BOOL.
    fn saw(&mut self, instruction: u32) {
        if self.compiler.builder.is_watched() {
            let power = match self.current {
                Current::Bit => self.compiler.builder.settle(),
                _ => Row::RAIL,
            };
            match self.condition.take() {
                Some(condition) => self.compiler.builder.shown_condition(instruction, condition, power),
                None => self.compiler.builder.shown(instruction, power),
            }
        }
    }

    /// What an instruction that is done under a condition has for one.
    fn goes_on(&mut self, kind: ItemKind) {
        let condition = match kind {
            ItemKind::Jump { condition, .. }
            | ItemKind::Call { condition, .. }
            | ItemKind::Return { condition, .. } => condition,
            _ => return,
        };
        if condition != Condition::Always && matches!(self.current, Current::Bit) {
            self.holds_now(condition == Condition::IfFalse);
        }
    }

    /// The current result is the condition that the present instruction is, or the opposite of it.
    pub(super) fn holds_now(&mut self, is_inverse: bool) {
        if self.compiler.builder.is_watched() && matches!(self.current, Current::Bit) {
            self.condition = Some((self.compiler.builder.settle(), is_inverse));
        }
    }

    pub(super) fn at(&mut self, span: Span) {
        let place = self.compiler.declared.place(self.source, span);
        self.compiler.builder.at(place, 1);
    }

    fn refuse(&mut self, span: Span, obstacle: Obstacle) {
        let place = self.compiler.declared.place(self.source, span);
        self.compiler.refuse(place, obstacle);
    }

    /// Compiles an item, and gives the number of the next one.
    fn item(&mut self, at: usize, item: Item) -> Result<usize, Obstacle> {
        match item.kind {
            ItemKind::Label { name } => self.label(name.of(self.text))?,
            ItemKind::Operation { operation, operand } => self.operation(at, operation, operand)?,
            ItemKind::Open { operation, operand } => self.open(operation, operand)?,
            ItemKind::Close => self.close(at)?,
            ItemKind::Jump { condition, label, .. } => {
                let label = label.ok_or(Obstacle::Unreadable)?.of(self.text);
                let place = self.compiler.declared.place(self.source, item.span);
                self.park(label)?;
                let power = self.condition(condition)?;
                self.compiler.jump(power, label, place);
                self.leave(condition);
            }
            ItemKind::Return { condition, .. } => {
                let power = self.condition(condition)?;
                let op = self.compiler.builder.op(Op::Jump { power, to: 0 });
                self.compiler.jumps.returns.push(op);
                self.leave(condition);
            }
            ItemKind::Call { condition, callee, form, parameters, .. } => {
                let word = self.word(callee.ok_or(Obstacle::Unreadable)?);
                return self.call(at, condition, word, form, parameters);
            }
            ItemKind::Function { name, form, parameters } => {
                return self.function(at, name.of(self.text), form, parameters);
            }
            ItemKind::InputOperator { input, instance } => {
                let (pin, word) = (input.of(self.text), self.word(instance));
                self.input_operator(pin, word)?;
            }
            _ => return Err(Obstacle::Unreadable),
        }
        Ok(at + 1)
    }

    /// The item behind an item and the parameters that belong to it.
    pub(super) fn behind(&self, at: usize) -> usize {
        let mut next = at + 1;
        while matches!(self.items.get(next).map(|item| item.kind), Some(ItemKind::ParameterOpen { .. })) {
            next = self.close_of(next) + 1;
        }
        next
    }

    /// The item that closes an open parenthesis.
    pub(super) fn close_of(&self, open: usize) -> usize {
        let depth = self.items[open].depth;
        let is_close = |item: &Item| item.kind == ItemKind::Close && item.depth == depth;
        self.items[open..].iter().position(is_close).map_or(self.items.len() - 1, |close| open + close)
    }

    /// The relay that is on while something under a condition is done.
    pub(super) fn condition(&mut self, condition: Condition) -> Result<Cell, Obstacle> {
        if condition == Condition::Always {
            return Ok(Row::RAIL);
        }
        if !matches!(self.current, Current::Bit) {
            return Err(self.no_bit());
        }
        let cell = self.compiler.builder.settle();
        self.compiler.builder.set_power(cell);
        Ok(if condition == Condition::IfTrue { cell } else { self.compiler.inverse(cell) })
    }

    fn no_bit(&self) -> Obstacle {
        match self.current {
            Current::Nothing => Obstacle::NoCurrentResult,
            _ => Obstacle::Iec(Message::new("simulate.result-no-bit")),
        }
    }

    /// What an unconditional jump leaves behind.
    fn leave(&mut self, condition: Condition) {
        if condition == Condition::Always {
            self.current = Current::Nothing;
            self.compiler.builder.forget_power();
        }
    }

    /// Brings the current result to where the label `name` expects it, if it does.
    fn park(&mut self, name: &str) -> Outcome {
        let name = folded(name);
        let Some(known) = self.compiler.jumps.results.get(&name).copied() else { return Ok(()) };
        let Some(given) = self.compiler.given_of(&self.current) else { return Ok(()) };
        let kind = given.kind;
        if known.is_some_and(|known| known != kind) {
            return Err(super::current::mismatch(kind, known.unwrap_or(kind)));
        }
        self.compiler.jumps.results.insert(name, Some(kind));
        let to = self.compiler.parking(kind);
        self.compiler.copy(given.input, kind, to);
        if matches!(self.current, Current::Bit) {
            let power = self.compiler.builder.power();
            self.compiler.builder.set_power(power);
        }
        Ok(())
    }

    fn label(&mut self, name: &'a str) -> Outcome {
        self.park(name)?;
        let is_used = self.compiler.jumps.results.get(&folded(name)).copied();
        self.compiler.label(name);
        self.compiler.builder.rung();
        self.current = match is_used {
            Some(Some(kind)) => {
                let spot = self.compiler.parking(kind);
                self.compiler.current_at(spot)
            }
            _ => Current::Nothing,
        };
        Ok(())
    }

    fn operation(&mut self, at: usize, operation: Operation, operand: Option<OperandId>) -> Outcome {
        let word = operand.map(|id| self.word(id));
        match operation.operator.role {
            OperatorRole::Load => {
                if self.open.is_empty() && self.depth == 0 {
                    self.compiler.builder.rung();
                }
                let word = word.ok_or(Obstacle::Unreadable)?;
                self.current = self.compiler.load(word, operation.negated)?;
                self.loaded(word);
                Ok(())
            }
            OperatorRole::Store => self.store(word.ok_or(Obstacle::Unreadable)?, operation.negated),
            OperatorRole::Latch { on } => self.latch(on, word.ok_or(Obstacle::Unreadable)?),
            OperatorRole::Complement => match (word, &self.current) {
                (Some(_), _) => Err(Obstacle::Unreadable),
                (None, Current::Bit) => {
                    self.compiler.builder.invert();
                    Ok(())
                }
                (None, current) => {
                    let current = current.clone();
                    let given = self.compiler.given_of(&current).ok_or(Obstacle::NoCurrentResult)?;
                    let depth = self.depth();
                    self.current = Current::Given(self.compiler.complement(given, depth)?);
                    Ok(())
                }
            },
            OperatorRole::Combine { .. } => {
                let word = word.ok_or(Obstacle::Unreadable)?;
                self.combine(at, operation, word)
            }
            _ => Err(Obstacle::Unreadable),
        }
    }

    /// How deep temporary values stand.
    pub(super) fn depth(&self) -> usize {
        self.depth + self.open.len()
    }

    fn combine(&mut self, at: usize, operation: Operation, word: &str) -> Outcome {
        let is_logic = matches!(operation.operator.operand, Some(GenericType::AnyBit));
        let (is_bit, is_literal) = match self.compiler.value(word)? {
            Value::Variable(variable) => (variable.kind.elementary() == Some(ElementaryType::Bool), false),
            // A literal is what the current result is.
            _ => (true, true),
        };
        if let (Current::Bit, true) = (&self.current, is_logic && is_bit) {
            let cell = self.compiler.relay(word)?;
            self.logic(operation, cell);
            if !is_literal {
                self.condition = Some((cell, operation.negated));
            }
            return Ok(());
        }
        let mut right = self.compiler.given(word)?;
        if operation.negated {
            right = self.compiler.complement(right, self.depth() + 1)?;
        }
        self.calculate(at, operation, right)
    }

    /// Combines the current result, a BOOL, with a relay.
    fn logic(&mut self, operation: Operation, cell: Cell) {
        let builder = &mut self.compiler.builder;
        match operation.operator.name {
            "AND" | "&" => builder.connect(Position::Series, cell, operation.negated),
            "OR" => builder.connect(Position::Parallel, cell, operation.negated),
            _ => self.compiler.exclusive(cell, operation.negated),
        }
    }

    fn calculate(&mut self, at: usize, operation: Operation, right: Given) -> Outcome {
        let name = if operation.operator.name == "&" { "AND" } else { operation.operator.name };
        let function = Function::named(name).ok_or(Obstacle::Unreadable)?;
        let current = self.current.clone();
        let left = self.compiler.given_of(&current).ok_or_else(|| self.no_value())?;
        let (expected, depth) = (self.expected(at), self.depth());
        let result = self
            .compiler
            .applied(function, vec![left, right], expected, |own, kind| own.temporary(kind, depth))?;
        self.current = self.compiler.current_at(result);
        if let OperatorRole::Combine { comparison: true } = operation.operator.role {
            self.holds_now(false);
        }
        Ok(())
    }

    /// A BOOL variable that is loaded is a condition.
    fn loaded(&mut self, word: &str) {
        if !matches!(TargetOperand::read(word, Model::Iec), TargetOperand::Literal(_)) {
            self.holds_now(false);
        }
    }

    pub(super) fn no_value(&self) -> Obstacle {
        match self.current {
            Current::Nothing => Obstacle::NoCurrentResult,
            _ => Obstacle::Iec(Message::new("simulate.result-with-parts")),
        }
    }

    /// The type of the variable to which the result of an item is stored in the end, if that is told soon.
    pub(super) fn expected(&mut self, at: usize) -> Option<ElementaryType> {
        for next in self.items.get(self.behind(at)..)? {
            match next.kind {
                ItemKind::Operation { operation, operand } => match (operation.operator.role, operand) {
                    (OperatorRole::Store, Some(id)) => {
                        return match self.compiler.value(self.word(id)) {
                            Ok(Value::Variable(variable)) => variable.kind.elementary(),
                            _ => None,
                        };
                    }
                    (OperatorRole::Combine { comparison: false } | OperatorRole::Complement, _) => {}
                    _ => return None,
                },
                ItemKind::Close => {}
                _ => return None,
            }
        }
        None
    }

    fn open(&mut self, operation: Operation, operand: Option<OperandId>) -> Outcome {
        if matches!(self.current, Current::Nothing) {
            return Err(Obstacle::NoCurrentResult);
        }
        let (current, depth) = (std::mem::replace(&mut self.current, Current::Nothing), self.depth());
        let before = match self.compiler.kept(current, depth) {
            Current::Bit => {
                let cell = self.compiler.builder.power();
                Current::Given(Given::at(cell_spot(cell)))
            }
            other => other,
        };
        self.open.push(Open { operation, before });
        self.compiler.builder.forget_power();
        if let Some(id) = operand {
            let word = self.word(id);
            self.current = self.compiler.load(word, false)?;
            self.loaded(word);
        }
        Ok(())
    }

    fn close(&mut self, at: usize) -> Outcome {
        let Open { operation, before } = self.open.pop().ok_or(Obstacle::Unreadable)?;
        let is_logic = matches!(operation.operator.operand, Some(GenericType::AnyBit));
        let before_cell = match &before {
            Current::Given(Given { input: Input::At(spot), kind: ElementaryType::Bool, .. }) => {
                match spot.lies {
                    Lies::Cell(cell) => Some(cell),
                    _ => None,
                }
            }
            _ => None,
        };
        match (&self.current, before_cell) {
            (Current::Bit, Some(cell)) if is_logic => {
                let inner = self.compiler.builder.settle();
                self.compiler.builder.set_power(cell);
                self.logic(operation, inner);
                return Ok(());
            }
            _ => {}
        }
        let current = self.current.clone();
        let mut right = self.compiler.given_of(&current).ok_or_else(|| self.no_value())?;
        if operation.negated {
            right = self.compiler.complement(right, self.depth() + 1)?;
        }
        self.current = before;
        self.calculate(at, operation, right)
    }

    fn store(&mut self, word: &str, negated: bool) -> Outcome {
        let target = match self.compiler.value(word)? {
            Value::Variable(variable) if !variable.is_constant => variable,
            _ => return Err(said("simulate.not-written", word)),
        };
        if let (Current::Bit, Some(cell)) = (&self.current, target.cell()) {
            self.compiler.builder.out(cell, negated);
            return Ok(());
        }
        if let Current::Whole(source) = &self.current {
            if negated {
                return Err(said("simulate.other-type", word));
            }
            let source = source.clone();
            return self.compiler.copy_whole(&source, &target, word);
        }
        let spot = target.spot().ok_or_else(|| said("simulate.not-elementary", word))?;
        let depth = self.depth();
        // A store to a place that is found at run time, or among bits, might change what was loaded.
        let is_plain = |spot: &Spot| {
            spot.index == 0 && matches!(spot.lies, Lies::Cell(_) | Lies::Word(_) | Lies::Text(..))
        };
        if let Current::Given(Given { input: Input::At(own), .. }) = &self.current
            && !(is_plain(own) && is_plain(&spot))
        {
            let current = std::mem::replace(&mut self.current, Current::Nothing);
            self.current = self.compiler.kept(current, depth);
        }
        let current = self.current.clone();
        let mut given = self.compiler.given_of(&current).ok_or_else(|| self.no_value())?;
        if negated {
            given = match given.kind {
                ElementaryType::Bool => {
                    let power = self.compiler.builder.settle();
                    Given::at(cell_spot(self.compiler.inverse(power)))
                }
                _ => self.compiler.complement(given, depth + 1)?,
            };
        }
        // At an address without a declared type lies whatever is stored there.
        let is_raw = word.starts_with('%') && given.kind.bits() == spot.kind.bits();
        let spot = if is_raw { Spot { kind: given.kind, ..spot } } else { spot };
        self.compiler.stored(given, spot)
    }

    fn latch(&mut self, on: bool, word: &str) -> Outcome {
        let Value::Variable(variable) = self.compiler.value(word)? else {
            return Err(said("simulate.not-written", word));
        };
        if let Kind::Record(_) = variable.kind {
            return self.input_operator(if on { "S" } else { "R" }, word);
        }
        if !matches!(self.current, Current::Bit) {
            return Err(self.no_bit());
        }
        let spot = variable.spot().filter(|spot| spot.kind == ElementaryType::Bool && !variable.is_constant);
        let spot = spot.ok_or_else(|| said("simulate.no-bit", word))?;
        match variable.cell() {
            Some(cell) if on => self.compiler.builder.set(cell),
            Some(cell) => self.compiler.builder.reset(cell),
            None => {
                let power = self.compiler.builder.settle();
                let value = Input::Constant(on.into());
                let inputs = vec![(value, ElementaryType::Bool)];
                self.compiler.compute_with(Formula::COPY, inputs, ElementaryType::Bool, spot, power, None);
            }
        }
        Ok(())
    }
}
