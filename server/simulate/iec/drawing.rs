//! Compiles drawn rungs of IEC 61131-3 programs.

use super::arguments::Arguments;
use super::compile::Compiler;
use super::current::{Current, Given};
use super::operand::{cell_spot, said};
use super::place::Place as Variable;
use crate::document::{ChunkRef, Scopes};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{self, Action, Call, Computation, Contact, Declared, Deed, Term, Test};
use crate::simulate::builder::{Builder, Position};
use crate::simulate::code::{Op, Place};
use crate::simulate::from_path::{Circuit, Dialect};
use crate::simulate::row::Row;
use crate::simulate::{Cell, Obstacle};
use crate::target::Target;
use crate::target::iec::{ENO, ElementaryType, Formula, Function};
use crate::text::Span;
use std::ops::Range;
use std::sync::Arc;

impl Compiler<'_> {
    /// Compiles a chunk of a drawing that stands in the body that is being compiled; `lists` are the sources of the
    /// lists that it carries along.
    pub(super) fn drawing(
        &mut self,
        document: u32,
        at: ChunkRef<'_>,
        (scopes, pous): (&Scopes, usize),
        lists: Range<usize>,
    ) {
        let reading = at.chunk.reading();
        let target: &'static Target = self.builder.target;
        for rung in logic::rungs_with(&reading, target, Declared { scopes, pous }) {
            self.builder.rung();
            for label in &rung.labels {
                self.label(label);
            }
            let place = |span: Span| Place { document, span: span.shifted(at.start) };
            // What a drawing carries along runs as the list that it is.
            if rung.is_list
                && let Some(source) = self.declared.source_at(lists.clone(), place(rung.span))
            {
                self.list(source, self.declared.items(source), Current::Nothing);
                self.builder.forget_power();
                continue;
            }
            match rung.path {
                Ok(Some(path)) => {
                    if self.builder.is_watched() {
                        self.builder.at(place(rung.span), 0);
                        self.builder.saw(Row::RAIL);
                    }
                    let mut drawing = Drawing {
                        compiler: self,
                        document,
                        start: at.start,
                        jumps: Vec::new(),
                        returns: Vec::new(),
                    };
                    let done = Circuit { dialect: &mut drawing }.path(&path);
                    drawing.leave();
                    if let Err((span, obstacle)) = done {
                        self.refuse(place(span), obstacle);
                    }
                }
                Ok(None) => {}
                Err(refusal) => self.refuse(place(rung.span), Obstacle::Refusal(refusal)),
            }
        }
    }
}

/// A rung that is being compiled.
struct Drawing<'c, 'a> {
    compiler: &'c mut Compiler<'a>,
    document: u32,
    start: usize,
    /// Jumps take effect when the whole rung is done: their power, labels and places.
    jumps: Vec<(Cell, String, Span)>,
    returns: Vec<Cell>,
}

impl Dialect for Drawing<'_, '_> {
    fn builder(&mut self) -> &mut Builder {
        &mut self.compiler.builder
    }

    fn at(&mut self, span: Span) -> Span {
        let place = self.place(span);
        self.compiler.builder.at(place, 1);
        span
    }

    fn contact(&mut self, position: Position, contact: &Contact) -> Result<(), Obstacle> {
        let (cell, is_inverse) = match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => {
                let cell = self.compiler.relay(&term.text)?;
                match kind {
                    ContactKind::NormallyOpen => (cell, false),
                    ContactKind::NormallyClosed => (cell, true),
                    ContactKind::Rising => (self.compiler.builder.edge(cell, true), false),
                    ContactKind::Falling => (self.compiler.builder.edge(cell, false), false),
                }
            }
            (Test::Compare(operator), [left, right]) => {
                let function = Function::named(operator.iec_name()).ok_or(Obstacle::Unreadable)?;
                let given = vec![self.compiler.given(&left.text)?, self.compiler.given(&right.text)?];
                let to = self.compiler.builder.scratch();
                self.compiler.applied(function, given, None, |_, _| cell_spot(to))?;
                (to, false)
            }
            _ => return Err(Obstacle::Unreadable),
        };
        self.compiler.builder.connect(position, cell, is_inverse);
        self.compiler.builder.saw_contact(cell, is_inverse);
        Ok(())
    }

    fn action(&mut self, action: &Action) -> Result<(), Obstacle> {
        match &action.deed {
            Deed::Coil(kind) => self.coil(*kind, &action.terms),
            Deed::Call(call) => self.call(call, &action.terms, action.span),
            Deed::Compute(computation) => self.compute(computation, &action.terms, action.span),
            Deed::Jump | Deed::Return => {
                let power = self.compiler.builder.settle();
                self.compiler.builder.seen();
                let kept = self.compiler.builder.scratch();
                self.compiler.builder.out(kept, false);
                self.compiler.builder.set_power(power);
                match (&action.deed, action.terms.first()) {
                    (Deed::Return, _) => self.returns.push(kept),
                    (_, Some(label)) => self.jumps.push((kept, label.text.to_string(), action.span)),
                    _ => return Err(Obstacle::Unreadable),
                }
                Ok(())
            }
            Deed::Instruction(_) => Err(Obstacle::Unreadable),
        }
    }

    fn through(&mut self, action: &Action) -> Result<(), Obstacle> {
        self.action(action)
    }
}

impl Drawing<'_, '_> {
    fn place(&self, span: Span) -> Place {
        Place { document: self.document, span: span.shifted(self.start) }
    }

    /// Does the jumps of the rung.
    fn leave(&mut self) {
        for (power, label, span) in std::mem::take(&mut self.jumps) {
            let place = self.place(span);
            self.compiler.builder.at(place, 0);
            self.compiler.jump(power, &label, place);
        }
        for power in std::mem::take(&mut self.returns) {
            let op = self.compiler.builder.op(Op::Jump { power, to: 0 });
            self.compiler.jumps.returns.push(op);
        }
    }

    fn coil(&mut self, kind: CoilKind, terms: &[Term]) -> Result<(), Obstacle> {
        let [term] = terms else { return Err(Obstacle::Unreadable) };
        let variable = self.compiler.written(&term.text)?;
        let wrong = || said("simulate.no-bit", &term.text);
        let is_bit = variable.kind.elementary() == Some(ElementaryType::Bool);
        if !is_bit {
            return Err(wrong());
        }
        if self.compiler.builder.is_watched() {
            self.compiler.builder.settle();
            self.compiler.builder.seen();
        }
        let Some(cell) = variable.cell() else { return self.remote_coil(kind, &variable) };
        let builder = &mut self.compiler.builder;
        match kind {
            CoilKind::Plain => builder.out(cell, false),
            CoilKind::Negated => builder.out(cell, true),
            CoilKind::Set => builder.set(cell),
            CoilKind::Reset => builder.reset(cell),
            CoilKind::Rising => builder.pulse(cell, true),
            CoilKind::Falling => builder.pulse(cell, false),
            CoilKind::Toggle => {
                let power = builder.settle();
                let edge = builder.edge(power, true);
                builder.set_power(cell);
                self.compiler.exclusive(edge, false);
                self.compiler.builder.out(cell, false);
                self.compiler.builder.set_power(power);
            }
        }
        Ok(())
    }

    /// A coil whose place is known when it is driven, or that is a bit of a word.
    fn remote_coil(&mut self, kind: CoilKind, to: &Variable) -> Result<(), Obstacle> {
        let power = self.compiler.builder.settle();
        let done = match kind {
            CoilKind::Plain => self.compiler.drive(power, to, false),
            CoilKind::Negated => self.compiler.drive(power, to, true),
            CoilKind::Rising | CoilKind::Falling => {
                let edge = self.compiler.builder.edge(power, kind == CoilKind::Rising);
                self.compiler.drive(edge, to, false)
            }
            CoilKind::Set | CoilKind::Reset => {
                let spot = to.spot().ok_or(Obstacle::Unreadable)?;
                let value = super::parts::Input::Constant((kind == CoilKind::Set).into());
                let inputs = vec![(value, spot.kind)];
                self.compiler.compute_with(Formula::COPY, inputs, spot.kind, spot, power, None);
                Ok(())
            }
            CoilKind::Toggle => Err(Obstacle::Unreadable),
        };
        self.compiler.builder.set_power(power);
        done
    }

    /// A function block: power goes to an input or enables the call, and goes on from an output.
    fn call(&mut self, call: &Arc<Call>, terms: &[Term], span: Span) -> Result<(), Obstacle> {
        let instance = terms.first().ok_or(Obstacle::Unreadable)?;
        let power = self.compiler.builder.settle();
        let instruction = self.compiler.builder.instruction();
        self.compiler.builder.reached();
        let variable = self.compiler.variable(&instance.text)?;
        let mut arguments = Arguments::default();
        match call.is_enabled() {
            true => arguments.enable = Some(power),
            false => arguments.inputs.push((call.power_in().into(), Given::at(cell_spot(power)))),
        }
        for argument in call.arguments(terms) {
            let (name, word) = (argument.name.into(), argument.term.text.to_string());
            match (argument.is_output, argument.is_changed) {
                (true, _) if argument.name == ENO.name => arguments.enabled = Some((word, false)),
                (true, _) => arguments.outputs.push((name, word, false)),
                (false, true) => arguments.in_out.push((name, word)),
                (false, false) => match self.compiler.whole(&word)? {
                    Some(variable) => arguments.wholes.push((name, variable)),
                    None => {
                        let given = self.compiler.given(&word)?;
                        arguments.inputs.push((name, given));
                    }
                },
            }
        }
        let place = self.place(span);
        self.compiler.called_block(&variable, arguments, place)?;
        self.compiler.builder.set_power(power);
        if let Some(output) = call.output(terms) {
            let cell = self.compiler.relay(&output.text)?;
            self.compiler.builder.forget_power();
            self.compiler.builder.connect(Position::First, cell, false);
            self.compiler.builder.settle();
        }
        if self.compiler.builder.is_watched() {
            let power = self.compiler.builder.power();
            self.compiler.builder.shown(instruction, power);
        }
        Ok(())
    }

    /// A function that power enables; its result goes to a variable.
    fn compute(&mut self, computation: &Computation, terms: &[Term], span: Span) -> Result<(), Obstacle> {
        let power = self.compiler.builder.settle();
        self.compiler.builder.seen();
        let (inputs, result) = computation.operands(terms).ok_or(Obstacle::Unreadable)?;
        let to = self.compiler.written(&result.text)?;
        if computation.is_declared() {
            self.run_function(computation, inputs, &to, power, span)?;
        } else if let (true, [source]) = (computation.copies(), inputs)
            && let Some(whole) = self.compiler.whole(&source.text)?
        {
            let off = self.compiler.inverse(power);
            let skip = self.compiler.builder.op(Op::Jump { power: off, to: 0 });
            self.compiler.copy_whole(&whole, &to, &result.text)?;
            let here = self.compiler.builder.here();
            self.compiler.send(skip, here);
        } else {
            let name = computation.standard().ok_or(Obstacle::Unreadable)?;
            let function = Function::named(name).ok_or(Obstacle::Unreadable)?;
            let spot = to.spot().ok_or_else(|| said("simulate.not-elementary", &result.text))?;
            let mut given = Vec::new();
            for term in inputs {
                given.push(self.compiler.given(&term.text)?);
            }
            let [inputs_are, _] =
                computation.conversion.types().map_or([None; 2], |types| types.map(ElementaryType::named));
            self.compiler.applied_to(function, given, spot, inputs_are, power)?;
        }
        self.compiler.builder.set_power(power);
        Ok(())
    }

    fn run_function(
        &mut self,
        computation: &Computation,
        inputs: &[Term],
        to: &Variable,
        power: Cell,
        span: Span,
    ) -> Result<(), Obstacle> {
        let name = computation.name();
        let unit = self.compiler.declared.unit(name, crate::il::iec::PouKind::Function);
        let unit = unit.ok_or_else(|| said("simulate.no-function", name))?;
        let mut arguments = Arguments::default();
        for (formal, term) in computation.inputs().iter().zip(inputs) {
            match formal.is_in_out {
                true => arguments.in_out.push((formal.name.into(), term.text.to_string())),
                false => match self.compiler.whole(&term.text)? {
                    Some(variable) => arguments.wholes.push((formal.name.into(), variable)),
                    None => {
                        let given = self.compiler.given(&term.text)?;
                        arguments.inputs.push((formal.name.into(), given));
                    }
                },
            }
        }
        let place = self.place(span);
        let off = self.compiler.inverse(power);
        let skip = self.compiler.builder.op(Op::Jump { power: off, to: 0 });
        let made = self.compiler.called_function(unit, arguments, 0, place)?;
        let (made, spot) = (made.ok_or(Obstacle::Unreadable)?, to.spot().ok_or(Obstacle::Unreadable)?);
        self.compiler.stored(Given::at(made), spot)?;
        let here = self.compiler.builder.here();
        self.compiler.send(skip, here);
        Ok(())
    }
}
