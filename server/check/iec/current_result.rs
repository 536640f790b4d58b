//! Follows the current result through a chunk: where there is none, and where its type does not fit.
//!
//! A chunk other than the first of a body starts with a load, so no chunk needs to know what the one before it left.
//! The widening conversions of the third edition are allowed without a word, narrowing is not. Where the type of
//! something is not known, nothing is said.

use super::{Callee, Expected, Fit, Flow, ValueType, View, fit};
use crate::il::iec::{
    Condition, Item, ItemKind, ListForm, OperandId, Operation, ParameterValue, PouKind, Run,
};
use crate::target::Operand;
use crate::target::iec::{ElementaryType, FunctionBlock, GenericType, Operator, OperatorRole};
use crate::text::{Diagnostic, Message, Span, TextEdit, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// The type that the use of an undeclared variable hints at.
#[derive(Clone, Copy, Debug)]
pub struct Guess {
    /// Where it is used.
    pub operand: OperandId,
    /// What is expected there.
    pub kind: ElementaryType,
}

/// The findings of four rules, `no-current-result`, `result-type-mismatch`, `operand-kind` and
/// `constant-out-of-range`, in the bodies of a chunk; and what undeclared variables are used as.
pub fn follow(view: View<'_>) -> (Vec<Diagnostic>, Vec<Guess>) {
    let start = Current::Nothing(Reason::Start);
    let mut walk = Walk {
        view,
        current: start,
        stack: Vec::new(),
        jumps: FxHashMap::default(),
        awaited: FxHashMap::default(),
        found: Vec::new(),
        guesses: Vec::new(),
    };
    for item in &view.tree.items {
        walk.item(item);
    }
    (walk.found, walk.guesses)
}

pub(super) struct Walk<'a> {
    pub(super) view: View<'a>,
    current: Current,
    stack: Vec<Frame>,
    /// What the jumps of this chunk bring to each label.
    jumps: FxHashMap<SmolStr, Current>,
    /// The types of parameters whose values are instruction lists that are still to come.
    pub(super) awaited: FxHashMap<u32, Expected>,
    pub(super) found: Vec<Diagnostic>,
    pub(super) guesses: Vec<Guess>,
}

/// The current result at a point.
#[derive(Clone, Debug)]
enum Current {
    Nothing(Reason),
    Value(Value),
}

/// A value with its origin.
#[derive(Clone, Debug)]
pub(super) struct Value {
    pub kind: ValueType,
    /// What made it.
    pub at: Span,
    /// The variable that it was loaded from.
    pub source: Option<OperandId>,
}

/// Why there is no current result.
#[derive(Clone, Copy, Debug)]
enum Reason {
    /// The body starts here.
    Start,
    /// A parenthesis starts here.
    Parenthesis(Span),
    /// An unconditional jump or return is before this.
    Left(Span),
}

/// An open parenthesis.
struct Frame {
    outer: Current,
    kind: FrameKind,
}

enum FrameKind {
    Expression(Operation),
    /// The value of a parameter of this type.
    Parameter(Expected),
}

impl<'a> Walk<'a> {
    fn item(&mut self, item: &Item) {
        match item.kind {
            ItemKind::Label { name } => self.label(name),
            ItemKind::Operation { operation, operand } => self.operation(item, operation, operand),
            ItemKind::Open { operation, operand } => self.open(operation, operand),
            ItemKind::Close => self.close(item.span),
            ItemKind::Jump { word, condition, label } => {
                self.condition(word, condition);
                if let Some(label) = label {
                    self.jump(label);
                }
                self.leave(word, condition);
            }
            ItemKind::Return { word, condition } => {
                self.condition(word, condition);
                self.leave(word, condition);
            }
            ItemKind::Call { word, condition, callee, form, parameters } => {
                self.condition(word, condition);
                self.call(item, callee, form, parameters);
            }
            ItemKind::Function { name, form, parameters } => self.function(item, name, form, parameters),
            ItemKind::InputOperator { input, instance } => self.input_operator(input, instance),
            ItemKind::ParameterOpen { parameter } => {
                let expected = self.awaited.remove(&parameter).unwrap_or(Expected::Unknown);
                self.push(FrameKind::Parameter(expected), item.span);
            }
            _ => {
                self.stack.clear();
                self.current = Current::Nothing(Reason::Start);
            }
        }
    }

    fn operation(&mut self, item: &Item, operation: Operation, operand: Option<OperandId>) {
        match operation.operator.role {
            OperatorRole::Load => {
                let kind = operand.map_or(ValueType::Unknown, |id| self.read(operation, id));
                self.current = Current::Value(Value { kind, at: item.span, source: operand });
            }
            OperatorRole::Store => self.store(operation, operand),
            OperatorRole::Latch { .. } => self.latch(operation, operand),
            OperatorRole::Complement => {
                let Some(current) = self.needed(operation.word, None) else { return };
                let wrong = matches!(fit(&current.kind, Expected::Group(GenericType::AnyBit)), Fit::Mismatch);
                if wrong {
                    self.wrong_result(operation.word, &current, Expected::Group(GenericType::AnyBit));
                    self.set(ValueType::Unknown, item.span);
                }
            }
            OperatorRole::Combine { .. } => {
                let Some(current) = self.needed(operation.word, operand) else { return };
                let Some(id) = operand else { return };
                let kind = self.read(operation, id);
                let right = Value { kind, at: self.view.tree.operand(id).span, source: Some(id) };
                let kind = self.combine(operation, &current, &right);
                self.set(kind, item.span);
            }
            OperatorRole::Jump | OperatorRole::Call | OperatorRole::Return => {}
        }
    }

    /// The type of an operand that an operator reads; reports what is no value at all.
    fn read(&mut self, operation: Operation, id: OperandId) -> ValueType {
        let kind = self.view.value(id);
        let word = self.view.word(id);
        let span = self.view.tree.operand(id).span;
        if let ValueType::Instance(block) = &kind {
            let message = Message::new("operand-kind.instance")
                .with("word", word)
                .with("block", block.to_ascii_uppercase())
                .with("operator", self.view.operator(operation));
            let mut diagnostic = Diagnostic::new("operand-kind", span, message);
            if let Some(output) = FunctionBlock::named(block).and_then(|row| row.outputs.first()) {
                let path = format!("{word}.{}", output.name);
                let title = Message::new("operand-kind.read-output").with("path", &path);
                diagnostic = diagnostic.fix(title, vec![TextEdit::new(span, path)]);
            }
            self.found.push(diagnostic);
            return ValueType::Unknown;
        }
        let bits = Expected::Group(GenericType::AnyBit);
        if operation.negated && operation.operator.role == OperatorRole::Load {
            if fit(&kind, bits) == Fit::Mismatch {
                self.wrong_operand(operation, id, &kind, bits);
                return ValueType::Unknown;
            }
            self.guess(Some(id), ElementaryType::Bool, &kind);
        }
        kind
    }

    fn store(&mut self, operation: Operation, operand: Option<OperandId>) {
        let current = self.needed(operation.word, None);
        let Some(id) = operand else { return };
        if !self.is_writable(operation, id) {
            return;
        }
        let kind = self.view.value(id);
        let bits = Expected::Group(GenericType::AnyBit);
        match kind {
            ValueType::Instance(_) => return self.wrong_operand(operation, id, &kind, Expected::Unknown),
            _ if operation.negated && fit(&kind, bits) == Fit::Mismatch => {
                return self.wrong_operand(operation, id, &kind, bits);
            }
            _ => {}
        }
        let Some(current) = current else { return };
        let expected = match kind {
            ValueType::Elementary(kind) => {
                self.guess(current.source, kind, &current.kind);
                Expected::Elementary(kind)
            }
            _ => {
                self.guess_like(id, &current.kind);
                Expected::Unknown
            }
        };
        let span = self.view.tree.operand(id).span;
        self.judge_result(operation.word, span, &current, expected);
    }

    /// S and R: on a BOOL, or a call of a block with such an input.
    fn latch(&mut self, operation: Operation, operand: Option<OperandId>) {
        let current = self.needed(operation.word, None);
        let boolean = Expected::Elementary(ElementaryType::Bool);
        if let Some(current) = &current {
            self.judge_result(operation.word, operation.word, current, boolean);
        }
        let Some(id) = operand else { return };
        if !self.is_writable(operation, id) {
            return;
        }
        let kind = self.view.value(id);
        let has_input = match &kind {
            ValueType::Instance(block) => {
                let block = Callee::block(&self.view, block);
                let pin = block.and_then(|block| block.pin_named(&self.view, operation.operator.name));
                pin.is_some_and(|pin| pin.flow == Flow::In)
            }
            _ => fit(&kind, boolean) == Fit::Fits,
        };
        if !has_input {
            self.wrong_operand(operation, id, &kind, boolean);
        }
        self.guess(Some(id), ElementaryType::Bool, &kind);
    }

    fn open(&mut self, operation: Operation, operand: Option<OperandId>) {
        // A parenthesis that the operator cannot have is reported by the reader.
        if matches!(operation.operator.role, OperatorRole::Combine { .. }) {
            self.needed(operation.word, None);
        }
        self.push(FrameKind::Expression(operation), operation.word);
        if let Some(id) = operand {
            let kind = self.read(operation, id);
            let at = self.view.tree.operand(id).span;
            self.current = Current::Value(Value { kind, at, source: Some(id) });
        }
    }

    fn push(&mut self, kind: FrameKind, span: Span) {
        let inside = Current::Nothing(Reason::Parenthesis(span));
        let outer = std::mem::replace(&mut self.current, inside);
        self.stack.push(Frame { outer, kind });
    }

    fn close(&mut self, span: Span) {
        let Some(frame) = self.stack.pop() else { return };
        let inner = self.needed(span, None);
        self.current = frame.outer;
        let Some(inner) = inner else { return };
        match frame.kind {
            FrameKind::Parameter(expected) => self.judge_result(span, span, &inner, expected),
            FrameKind::Expression(operation) => {
                let Current::Value(outer) = self.current.clone() else { return };
                let inner = Value { at: operation.word, ..inner };
                let kind = self.combine(operation, &outer, &inner);
                self.set(kind, operation.word.to(span));
            }
        }
    }

    /// The type of `current operator right`.
    fn combine(&mut self, operation: Operation, current: &Value, right: &Value) -> ValueType {
        let OperatorRole::Combine { comparison } = operation.operator.role else { return ValueType::Unknown };
        let (result, fault) = combined(operation.operator, &current.kind, &right.kind);
        match (&current.kind, &right.kind) {
            (ValueType::Unknown, known) => self.guess_from(current.source, known),
            (known, ValueType::Unknown) => self.guess_from(right.source, known),
            _ => {}
        }
        let group = operation.operator.operand.map_or(Expected::Unknown, Expected::Group);
        match fault {
            Fault::None => {}
            Fault::Current => self.wrong_result(operation.word, current, group),
            Fault::Operand => self.wrong_value(operation, right, group),
            Fault::Different => {
                let span = right.at;
                let word = self.view.text.get(span.range()).unwrap_or("");
                let message = Message::new("result-type-mismatch.operand")
                    .with("operator", self.view.operator(operation))
                    .with("word", right.kind.title(word))
                    .with("found", current.kind.title(current.at.of(self.view.text)));
                let diagnostic = Diagnostic::new("result-type-mismatch", span, message);
                let diagnostic = self.with_conversion(diagnostic, operation.word, current, &right.kind);
                self.found.push(self.with_origin(diagnostic, current));
            }
            Fault::CurrentRange(kind) => self.out_of_range(current, kind),
            Fault::RightRange(kind) => self.out_of_range(right, kind),
        }
        match (fault, comparison) {
            (_, true) => ValueType::Elementary(ElementaryType::Bool),
            (Fault::None, false) => result,
            _ => ValueType::Unknown,
        }
    }

    fn condition(&mut self, word: Span, condition: Condition) {
        if condition == Condition::Always {
            return;
        }
        if let Some(current) = self.needed(word, None) {
            self.guess(current.source, ElementaryType::Bool, &current.kind);
            self.judge_result(word, word, &current, Expected::Elementary(ElementaryType::Bool));
        }
    }

    fn jump(&mut self, label: Span) {
        let brings = self.current.clone();
        let entry = self.jumps.entry(folded(label.of(self.view.text)));
        let merged = entry.or_insert_with(|| brings.clone());
        if let (Current::Value(one), Current::Value(other)) = (&mut *merged, &brings)
            && one.kind != other.kind
        {
            one.kind = ValueType::Unknown;
        }
        if matches!(brings, Current::Nothing(_)) {
            *merged = brings;
        }
    }

    fn leave(&mut self, word: Span, condition: Condition) {
        if condition == Condition::Always {
            self.current = Current::Nothing(Reason::Left(word));
        }
    }

    /// What falls through goes on; after a jump only what other jumps bring is there, perhaps from other chunks.
    fn label(&mut self, name: Span) {
        if let Current::Nothing(Reason::Left(_)) = self.current {
            let unknown = Current::Value(Value { kind: ValueType::Unknown, at: name, source: None });
            self.current = self.jumps.remove(&folded(name.of(self.view.text))).unwrap_or(unknown);
        }
    }

    fn call(&mut self, item: &Item, callee: Option<OperandId>, form: ListForm, parameters: Run) {
        let Some(id) = callee else { return };
        let called = match self.view.value(id) {
            ValueType::Instance(block) => Callee::block(&self.view, &block),
            _ => Callee::function(&self.view, self.view.word(id)),
        };
        let Some(called) = called else { return };
        let result = self.arguments(called, parameters, form, None);
        let is_function = match called {
            Callee::Function(_) => true,
            Callee::Declared(pou) => pou.kind == PouKind::Function,
            Callee::Block(_) => false,
        };
        if is_function {
            self.set(result, item.span);
        }
    }

    fn function(&mut self, item: &Item, name: Span, form: ListForm, parameters: Run) {
        let Some(callee) = Callee::function(&self.view, name.of(self.view.text)) else {
            // What an unknown word does is not known; it is reported once and leaves something behind.
            return self.set(ValueType::Unknown, item.span);
        };
        let (inputs, extensible) = callee.inputs();
        let takes_current = form == ListForm::None && inputs > 0;
        let given = parameters.len() + usize::from(takes_current);
        if given > inputs && !extensible || form != ListForm::Formal && given < inputs {
            let result = callee.result(&self.view);
            return self.set(result.value(), item.span);
        }
        let first = if takes_current {
            let operands: Vec<OperandId> = parameters
                .of(&self.view.tree.parameters)
                .iter()
                .filter_map(|parameter| match parameter.value {
                    ParameterValue::Operand(id) => Some(id),
                    _ => None,
                })
                .collect();
            match self.needed_by_function(item.span, name, &operands) {
                Some(current) => Some(current),
                None => Some(Value { kind: ValueType::Unknown, at: name, source: None }),
            }
        } else {
            None
        };
        let result = self.arguments(callee, parameters, form, first);
        self.set(result, item.span);
    }

    /// `CU C10`: the current result goes to one input.
    fn input_operator(&mut self, input: Span, instance: OperandId) {
        let Some(current) = self.needed(input, None) else { return };
        let ValueType::Instance(block) = self.view.value(instance) else { return };
        let Some(block) = Callee::block(&self.view, &block) else { return };
        let Some(pin) = block.pin_named(&self.view, input.of(self.view.text)) else { return };
        self.judge_result(input, input, &current, pin.expected);
    }

    /// The current result; where there is none, that is reported and supposed to be mended.
    fn needed(&mut self, word: Span, operand: Option<OperandId>) -> Option<Value> {
        let reason = match &self.current {
            Current::Value(value) => return Some(value.clone()),
            Current::Nothing(reason) => *reason,
        };
        let mut diagnostic = self.no_result(word, reason);
        let loads = |id: &OperandId| !matches!(self.view.tree.operand(*id).value, Operand::Invalid(_));
        if let Some(id) = operand.filter(loads) {
            let negated = word.of(self.view.text).to_ascii_uppercase().ends_with('N');
            let is_logic =
                matches!(fit(&self.view.value(id), Expected::Group(GenericType::AnyBit)), Fit::Fits);
            let load = if negated && is_logic { "LDN" } else { "LD" };
            let title = Message::new("no-current-result.iec-load")
                .with("load", load)
                .with("word", self.view.word(id));
            diagnostic = diagnostic.fix(title, vec![TextEdit::new(word, load)]);
        }
        self.found.push(diagnostic);
        self.set(ValueType::Unknown, word);
        None
    }

    /// The same for a function without parentheses, whose first operand was perhaps meant to be loaded.
    fn needed_by_function(&mut self, span: Span, name: Span, operands: &[OperandId]) -> Option<Value> {
        let reason = match &self.current {
            Current::Value(value) => return Some(value.clone()),
            Current::Nothing(reason) => *reason,
        };
        let mut diagnostic = self.no_result(name, reason);
        if let Some((first, others)) = operands.split_first() {
            let others: Vec<&str> = others.iter().map(|id| self.view.word(*id)).collect();
            let (first, function) = (self.view.word(*first), name.of(self.view.text));
            let blank = if others.is_empty() { "" } else { " " };
            let indent = self.view.indentation(name.start);
            let mended = format!("LD {first}\n{indent}{function}{blank}{}", others.join(", "));
            let title = Message::new("no-current-result.iec-load").with("load", "LD").with("word", first);
            diagnostic = diagnostic.fix(title, vec![TextEdit::new(span, mended)]);
        }
        self.found.push(diagnostic);
        None
    }

    fn no_result(&self, word: Span, reason: Reason) -> Diagnostic {
        let key = match reason {
            Reason::Start => "no-current-result.iec-start",
            Reason::Parenthesis(_) => "no-current-result.iec-parenthesis",
            Reason::Left(_) => "no-current-result.iec-left",
        };
        let name = word.of(self.view.text).to_ascii_uppercase();
        let name = if name == ")" { "`)`".to_string() } else { name };
        let diagnostic = Diagnostic::new("no-current-result", word, Message::new(key).with("word", name));
        match reason {
            Reason::Start => diagnostic,
            Reason::Parenthesis(at) => diagnostic.related(at, Message::new("no-current-result.iec-opened")),
            Reason::Left(at) => diagnostic.related(at, Message::new("no-current-result.iec-left-here")),
        }
    }

    fn set(&mut self, kind: ValueType, at: Span) {
        self.current = Current::Value(Value { kind, at, source: None });
    }
}

/// Which side of an operator is wrong.
#[derive(Clone, Copy)]
enum Fault {
    None,
    /// The operator does not take the type of the current result.
    Current,
    /// It does not take the type of the operand.
    Operand,
    /// It takes both, but not together.
    Different,
    /// The current result is a constant that does not fit the operand's type.
    CurrentRange(ElementaryType),
    /// The operand is a constant that does not fit the current result's type.
    RightRange(ElementaryType),
}

/// The result of `left operator right`, and what is wrong with it.
fn combined(operator: &Operator, left: &ValueType, right: &ValueType) -> (ValueType, Fault) {
    use ValueType::{Elementary, Literal};
    let Some(group) = operator.operand else { return (ValueType::Unknown, Fault::None) };
    // A constant that names its type is like a variable of that type to one that does not.
    if let (Literal(one), Literal(other)) = (left, right) {
        match (one.named_type, other.named_type) {
            (Some(kind), None) => return combined(operator, &Elementary(kind), right),
            (None, Some(kind)) => return combined(operator, left, &Elementary(kind)),
            _ => {}
        }
    }
    let is_logic = group == GenericType::AnyBit;
    let (left_kind, right_kind) = match (left, right) {
        (Elementary(left), Elementary(right)) => (*left, *right),
        (Elementary(kind), Literal(literal)) | (Literal(literal), Elementary(kind)) => {
            let on_left = matches!(left, Literal(_));
            match fit(&Literal(*literal), Expected::Elementary(*kind)) {
                Fit::Fits if group.contains(*kind) => (*kind, *kind),
                Fit::OutOfRange(kind) if group.contains(kind) => {
                    let fault = if on_left { Fault::CurrentRange(kind) } else { Fault::RightRange(kind) };
                    return (ValueType::Unknown, fault);
                }
                _ => match (literal.natural_type(), on_left) {
                    (Some(natural), true) => (natural, *kind),
                    (Some(natural), false) => (*kind, natural),
                    (None, _) => return (ValueType::Unknown, Fault::None),
                },
            }
        }
        (Literal(left), Literal(right)) => match (left.named_type, right.named_type) {
            (Some(left), Some(right)) => (left, right),
            // Numbers alone: the place where the result goes will tell the type.
            _ => return (ValueType::Unknown, Fault::None),
        },
        // The result of a logic operator has the type of the side that is known.
        (Elementary(kind), ValueType::Unknown) | (ValueType::Unknown, Elementary(kind)) => {
            let known = is_logic && group.contains(*kind);
            return (if known { Elementary(*kind) } else { ValueType::Unknown }, Fault::None);
        }
        _ => return (ValueType::Unknown, Fault::None),
    };
    match operator.combine(left_kind, right_kind, true) {
        Some(kind) => (Elementary(kind), Fault::None),
        None if !group.contains(right_kind) => (ValueType::Unknown, Fault::Operand),
        None if !group.contains(left_kind) => (ValueType::Unknown, Fault::Current),
        None => (ValueType::Unknown, Fault::Different),
    }
}
