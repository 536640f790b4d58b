//! The parameters of calls against what is called; and the words for what does not fit.

use super::current_result::{Guess, Value, Walk};
use super::{Callee, Expected, Fit, Flow, Pin, ValueType, View, fit};
use crate::il::iec::{Direction, ListForm, OperandId, Operation, Parameter, ParameterValue, Run};
use crate::target::Operand;
use crate::target::iec::{ElementaryType, Function, GenericType};
use crate::text::{Diagnostic, Message, Span, TextEdit};

/// The one type of all parameters of a group in a call.
#[derive(Default)]
struct Groups(Vec<(GenericType, ElementaryType)>);

impl Walk<'_> {
    /// Judges the parameters of a call; gives the type of the result. `first` is the current result where it is the
    /// first input.
    pub(super) fn arguments(
        &mut self,
        callee: Callee<'_>,
        parameters: Run,
        form: ListForm,
        first: Option<Value>,
    ) -> ValueType {
        let view = self.view;
        let mut groups = Groups::default();
        let mut constants: Vec<(Value, GenericType)> = Vec::new();
        let offset = usize::from(first.is_some());
        if let Some(current) = &first
            && let Some(pin) = callee.pin_at(&view, 0)
        {
            match pin.flow {
                Flow::InOut if !self.is_variable(current.source) => self.not_writable(current, pin),
                _ => self.input(current, pin, &mut groups, &mut constants),
            }
        }
        for (position, parameter) in parameters.of(&view.tree.parameters).iter().enumerate() {
            let pin = match (parameter.name, form) {
                (Some(name), _) => callee.pin_named(&view, name.of(view.text)),
                (None, ListForm::Formal) => None,
                (None, _) => callee.pin_at(&view, position + offset),
            };
            let Some(pin) = pin else { continue };
            match parameter.value {
                ParameterValue::Operand(id) => {
                    self.parameter(parameter, pin, id, &mut groups, &mut constants);
                }
                ParameterValue::Instructions if pin.flow == Flow::InOut => {
                    self.found.push(expression_written(parameter.name.unwrap_or(parameter.span), pin.name));
                }
                ParameterValue::Instructions => {
                    _ = self.awaited.insert(parameters.start + position as u32, pin.expected);
                }
                ParameterValue::Missing => {}
            }
        }
        groups.of_constants(&constants);
        for (value, group) in constants {
            if let Some(kind) = groups.of(group) {
                self.judge_value(&value, Expected::Elementary(kind));
                self.guess(value.source, kind, &value.kind);
            }
        }
        match callee.result(&view) {
            Expected::Group(group) => groups.of(group).map_or(ValueType::Unknown, ValueType::Elementary),
            result => result.value(),
        }
    }

    fn parameter(
        &mut self,
        parameter: &Parameter,
        pin: Pin<'_>,
        id: OperandId,
        groups: &mut Groups,
        constants: &mut Vec<(Value, GenericType)>,
    ) {
        let span = self.view.tree.operand(id).span;
        let value = Value { kind: self.view.value(id), at: span, source: Some(id) };
        let positional = parameter.name.is_none();
        let is_output = matches!(parameter.direction, Direction::Out { .. });
        if !positional && is_output != (pin.flow == Flow::Out) {
            return;
        }
        let is_constant = matches!(self.view.tree.operand(id).value, Operand::Literal(_));
        if pin.flow != Flow::In && is_constant {
            return self.found.push(constant_written(span, span.of(self.view.text), pin.name));
        }
        if let Expected::Elementary(kind) = pin.expected {
            self.guess(Some(id), kind, &value.kind);
        }
        if pin.flow != Flow::Out {
            return self.input(&value, pin, groups, constants);
        }
        if let (Expected::Elementary(from), ValueType::Elementary(to)) = (pin.expected, &value.kind)
            && !from.widens_to(*to)
        {
            let message = Message::new("result-type-mismatch.output")
                .with("pin", pin.name)
                .with("expected", from)
                .with("word", span.of(self.view.text))
                .with("found", to);
            self.found.push(Diagnostic::new("result-type-mismatch", span, message));
        }
    }

    fn input(
        &mut self,
        value: &Value,
        pin: Pin<'_>,
        groups: &mut Groups,
        constants: &mut Vec<(Value, GenericType)>,
    ) {
        let fits = match (&value.kind, pin.expected) {
            (ValueType::Instance(_), _) => false,
            (kind, expected) => fit(kind, expected) == Fit::Fits,
        };
        if !fits {
            return self.judge_input(value, pin);
        }
        let Expected::Group(group) = pin.expected else { return };
        match value.kind {
            ValueType::Literal(_) | ValueType::Unknown => constants.push((value.clone(), group)),
            ValueType::Elementary(kind) => {
                if let Some(common) = groups.join(group, kind) {
                    self.judge_value(value, Expected::Elementary(common));
                }
            }
            _ => {}
        }
    }

    /// Whether a value is a variable as it stands: what is handed over to be changed.
    fn is_variable(&self, source: Option<OperandId>) -> bool {
        source.is_some_and(|id| !matches!(self.view.tree.operand(id).value, Operand::Literal(_)))
    }

    /// The current result, which the callee is to change and which is no variable.
    fn not_writable(&mut self, current: &Value, pin: Pin<'_>) {
        let diagnostic = match current.source {
            Some(id) => {
                let span = self.view.tree.operand(id).span;
                constant_written(span, span.of(self.view.text), pin.name)
            }
            // Where nothing is known of the current result, that is told already.
            None if current.kind == ValueType::Unknown => return,
            None => expression_written(current.at, pin.name),
        };
        self.found.push(diagnostic);
    }

    fn judge_input(&mut self, value: &Value, pin: Pin<'_>) {
        if let Fit::OutOfRange(kind) = fit(&value.kind, pin.expected) {
            return self.out_of_range(value, kind);
        }
        let message = Message::new("result-type-mismatch.input")
            .with("pin", pin.name)
            .with("expected", pin.expected.name())
            .with("word", value.at.of(self.view.text))
            .with("found", value.kind.title(value.at.of(self.view.text)));
        self.found.push(Diagnostic::new("result-type-mismatch", value.at, message));
    }

    /// An operand that is none of what is expected.
    fn judge_value(&mut self, value: &Value, expected: Expected) {
        match fit(&value.kind, expected) {
            Fit::Fits => {}
            Fit::OutOfRange(kind) => self.out_of_range(value, kind),
            Fit::Mismatch => {
                let word = value.at.of(self.view.text);
                let message = Message::new("result-type-mismatch.value")
                    .with("word", word)
                    .with("found", value.kind.title(word))
                    .with("expected", expected.name());
                self.found.push(Diagnostic::new("result-type-mismatch", value.at, message));
            }
        }
    }

    /// The current result, which goes to a place at `span` by the instruction `word`.
    pub(super) fn judge_result(&mut self, word: Span, span: Span, current: &Value, expected: Expected) {
        match fit(&current.kind, expected) {
            Fit::Fits => {}
            Fit::OutOfRange(kind) => self.out_of_range(current, kind),
            Fit::Mismatch => {
                let key =
                    if word == span { "result-type-mismatch.current" } else { "result-type-mismatch.store" };
                let message = Message::new(key)
                    .with("operator", word.of(self.view.text).to_ascii_uppercase())
                    .with("word", span.of(self.view.text))
                    .with("expected", expected.name())
                    .with("found", current.kind.title(current.at.of(self.view.text)));
                let mut diagnostic = Diagnostic::new("result-type-mismatch", span, message);
                // A closing parenthesis is no place before which a conversion could stand on its own line.
                if let (Expected::Elementary(kind), false) = (expected, word.of(self.view.text) == ")") {
                    let wanted = ValueType::Elementary(kind);
                    diagnostic = self.with_conversion(diagnostic, word, current, &wanted);
                }
                let diagnostic = self.with_origin(diagnostic, current);
                self.found.push(diagnostic);
            }
        }
    }

    /// The operator does not take the current result.
    pub(super) fn wrong_result(&mut self, word: Span, current: &Value, expected: Expected) {
        let message = Message::new("result-type-mismatch.current")
            .with("operator", word.of(self.view.text).to_ascii_uppercase())
            .with("expected", expected.name())
            .with("found", current.kind.title(current.at.of(self.view.text)));
        let diagnostic = Diagnostic::new("result-type-mismatch", word, message);
        let diagnostic = self.with_origin(diagnostic, current);
        self.found.push(diagnostic);
    }

    /// The operator does not take the operand, whatever the current result is.
    pub(super) fn wrong_operand(
        &mut self,
        operation: Operation,
        id: OperandId,
        kind: &ValueType,
        takes: Expected,
    ) {
        let at = self.view.tree.operand(id).span;
        let value = Value { kind: kind.clone(), at, source: Some(id) };
        self.wrong_value(operation, &value, takes);
    }

    pub(super) fn wrong_value(&mut self, operation: Operation, value: &Value, takes: Expected) {
        let word = value.at.of(self.view.text);
        let is_instance = matches!(value.kind, ValueType::Instance(_));
        let key = if is_instance { "operand-kind.whole-block" } else { "operand-kind.type" };
        let message = Message::new(key)
            .with("operator", self.view.operator(operation))
            .with("takes", takes.name())
            .with("word", word)
            .with("found", value.kind.title(word));
        self.found.push(Diagnostic::new("operand-kind", value.at, message));
    }

    /// Whether something can be written there; reports a constant.
    pub(super) fn is_writable(&mut self, operation: Operation, id: OperandId) -> bool {
        let operand = self.view.tree.operand(id);
        match operand.value {
            Operand::Literal(_) => {
                let message = Message::new("operand-kind.constant-written")
                    .with("operator", self.view.operator(operation))
                    .with("word", operand.span.of(self.view.text));
                self.found.push(Diagnostic::new("operand-kind", operand.span, message));
                false
            }
            Operand::Invalid(_) => false,
            _ => true,
        }
    }

    pub(super) fn out_of_range(&mut self, value: &Value, kind: ElementaryType) {
        let at = match value.source {
            Some(id) => self.view.tree.operand(id).span,
            None => value.at,
        };
        self.found.push(out_of_range(at, at.of(self.view.text), kind));
    }

    pub(super) fn with_origin(&self, diagnostic: Diagnostic, current: &Value) -> Diagnostic {
        if current.at == diagnostic.span {
            return diagnostic;
        }
        let title = current.kind.title(current.at.of(self.view.text));
        diagnostic.related(current.at, Message::new("result-type-mismatch.made").with("found", title))
    }

    /// Offers the conversion of the current result to the type of `wanted`, in front of the instruction `word`.
    pub(super) fn with_conversion(
        &self,
        diagnostic: Diagnostic,
        word: Span,
        current: &Value,
        wanted: &ValueType,
    ) -> Diagnostic {
        let (ValueType::Elementary(from), ValueType::Elementary(to)) = (&current.kind, wanted) else {
            return diagnostic;
        };
        let is_number = from.belongs_to(GenericType::AnyNum);
        let conversion = match to {
            ElementaryType::Bool if is_number => "NE 0".to_string(),
            _ => match Function::named(&format!("{from}_TO_{to}")) {
                Some(function) => function.name.to_string(),
                None => return diagnostic,
            },
        };
        let indent = self.view.indentation(word.start);
        let title = Message::new("result-type-mismatch.convert").with("conversion", &conversion);
        let edit = TextEdit::new(Span::at(word.start as usize), format!("{conversion}\n{indent}"));
        diagnostic.fix(title, vec![edit])
    }

    /// `kind` is what variable `id` should be, if its own type `known` is not known.
    pub(super) fn guess(&mut self, id: Option<OperandId>, kind: ElementaryType, known: &ValueType) {
        if let (Some(operand), ValueType::Unknown) = (id, known) {
            self.guesses.push(Guess { operand, kind });
        }
    }

    /// The variable `id` meets a value of a type.
    pub(super) fn guess_from(&mut self, id: Option<OperandId>, value: &ValueType) {
        if let Some(kind) = value.elementary() {
            self.guess(id, kind, &ValueType::Unknown);
        }
    }

    /// The variable `id` gets a value, and its own type is not known.
    pub(super) fn guess_like(&mut self, id: OperandId, value: &ValueType) {
        self.guess_from(Some(id), value);
    }
}

impl Groups {
    /// The type of the parameters of `group`.
    fn of(&self, group: GenericType) -> Option<ElementaryType> {
        self.0.iter().find(|(own, _)| *own == group).map(|(_, kind)| *kind)
    }

    /// Constants that are alone in a group must have a type in common: one of their own, which says it where it is BOOL
    /// or none is; a number may still be of several.
    fn of_constants(&mut self, constants: &[(Value, GenericType)]) {
        for (_, group) in constants {
            let own = || constants.iter().filter(|(_, other)| other == group).map(|(value, _)| &value.kind);
            let is_common = |kind: &ElementaryType| {
                own().all(|value| fit(value, Expected::Elementary(*kind)) != Fit::Mismatch)
            };
            let mut kinds = own().filter_map(ValueType::elementary);
            let Some(first) = kinds.clone().next().filter(|_| self.of(*group).is_none()) else { continue };
            let common = kinds.find(is_common).unwrap_or(first);
            if common == ElementaryType::Bool || !is_common(&common) {
                self.0.push((*group, common));
            }
        }
    }

    /// Adds a parameter; gives the type of the others if it cannot go together with them.
    fn join(&mut self, group: GenericType, kind: ElementaryType) -> Option<ElementaryType> {
        match self.0.iter_mut().find(|(own, _)| *own == group) {
            None => self.0.push((group, kind)),
            Some((_, common)) if common.widens_to(kind) => *common = kind,
            Some((_, common)) if kind.widens_to(*common) => {}
            Some((_, common)) => return Some(*common),
        }
        None
    }
}

impl View<'_> {
    /// An operator as messages name it.
    pub fn operator(&self, operation: Operation) -> String {
        operation.word.of(self.text).to_ascii_uppercase()
    }
}

impl ValueType {
    /// Its type, for a constant the one that it has by itself.
    pub fn elementary(&self) -> Option<ElementaryType> {
        match self {
            ValueType::Elementary(kind) => Some(*kind),
            ValueType::Literal(literal) => literal.natural_type(),
            _ => None,
        }
    }
}

impl Expected {
    /// A value of this type.
    pub fn value(self) -> ValueType {
        match self {
            Expected::Elementary(kind) => ValueType::Elementary(kind),
            _ => ValueType::Unknown,
        }
    }
}

/// The constant `word` at a pin that writes to its operand.
pub fn constant_written(span: Span, word: &str, pin: &str) -> Diagnostic {
    let message = Message::new("operand-kind.output-constant").with("word", word).with("pin", pin);
    Diagnostic::new("operand-kind", span, message)
}

/// A value that is no variable at a pin that writes to its operand.
pub fn expression_written(span: Span, pin: &str) -> Diagnostic {
    Diagnostic::new("operand-kind", span, Message::new("operand-kind.output-expression").with("pin", pin))
}

/// A constant that a type cannot hold.
pub fn out_of_range(span: Span, word: &str, kind: ElementaryType) -> Diagnostic {
    let message = match kind.integers() {
        Some(range) => Message::new("constant-out-of-range.type")
            .with("least", range.start())
            .with("greatest", range.end()),
        None => Message::new("constant-out-of-range.real-type"),
    };
    Diagnostic::new("constant-out-of-range", span, message.with("word", word).with("type", kind))
}
