//! Writes a path of power as instruction list of IEC 61131-3, in as few instructions as its order of contacts and
//! outputs allows.
//!
//! The current result survives ST, S and R, so outputs that share their power need no stack. Behind a conditional path
//! the power is loaded again: a single contact that nothing changed meanwhile as it is, anything else from a helper, a
//! variable that was stored before. A contact of a rising edge is the output of a detector called before the load, a
//! coil of one that of a detector called behind it. F_TRIG is on in its first call if its input is off, which no
//! contact of a falling edge is, so two variables find these: `Was1` keeps what the bit was, `Fall1` is on where it
//! fell. A function block is called with its first input stored, and its first output is loaded. Calculations with
//! words are jumped over where power does not reach them.

mod helpers;
pub use helpers::{Helper, Helpers};

use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{
    Action, Call, Computation, Contact, Deed, Drive, Expression, Gate, Path, Storage, Term, Test,
    is_helper_name,
};
use crate::text::Message;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;
use std::borrow::Cow;

/// The lines of `path`, not yet laid out, or why it has none.
pub fn lines(path: &Path, helpers: &mut Helpers) -> Result<Vec<String>, Message> {
    let actions = path.actions();
    let leaves = |action: &&Action| matches!(action.deed, Deed::Jump | Deed::Return);
    // A drawing does first what stands beside a jump, a list does not.
    if let Some((_, before)) = actions.split_last()
        && before.iter().any(leaves)
    {
        return Err(Message::new("translate.jump-first"));
    }
    let mut writer = Writer {
        lines: Vec::new(),
        falls: 0,
        group: 0,
        driven: FxHashSet::default(),
        changed: Vec::new(),
        has_run: false,
        last: 0,
        held: 0,
        helpers,
    };
    writer.path(path, true)?;
    match writer.goes_back() {
        true => Err(Message::new("translate.fall-beside")),
        false => Ok(writer.lines),
    }
}

struct Writer<'h> {
    lines: Vec<String>,
    /// The line behind those that find falling edges, which stand first.
    falls: usize,
    /// The line of the last load outside of parentheses, before which detectors are called.
    group: usize,
    /// The keys of what was driven behind that line.
    driven: FxHashSet<SmolStr>,
    /// What may have been changed by the lines so far.
    changed: Vec<Term>,
    /// Whether they ran a unit of the program, which may change whatever others know.
    has_run: bool,
    /// The line behind the last coil of a falling edge.
    last: usize,
    /// How many powers are kept in helpers.
    held: usize,
    helpers: &'h mut Helpers,
}

/// The operators of a place.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Load,
    And,
    Or,
}

impl Writer<'_> {
    /// `is_first` if nothing is loaded yet.
    fn path(&mut self, path: &Path, is_first: bool) -> Result<(), Message> {
        let inverse =
            matches!(path.gates.last(), Some(Gate::Invert)) && path.drives.iter().all(is_invertible);
        let gates = &path.gates[..path.gates.len() - usize::from(inverse)];
        let is_whole = is_first;
        let mut is_first = is_first;
        for (number, gate) in gates.iter().enumerate() {
            match gate {
                Gate::Pass(expression) if is_first => {
                    let next = called_next(path, number);
                    if let (Some(next), Expression::Contact(contact)) = (next, expression)
                        && is_plain(contact)
                    {
                        // The call that follows has the contact as its input.
                        self.start();
                        let operand = self.operand(contact)?;
                        self.call(next, Some(operand))?;
                        return self.behind_call(path, number + 1);
                    }
                    self.start();
                    self.expression(expression, Place::Load)?;
                }
                Gate::Pass(expression) => self.expression(expression, Place::And)?,
                Gate::Invert if is_first => return Err(Message::new("translate.no-condition")),
                Gate::Invert => self.lines.push("NOT".into()),
                Gate::Through(action) => {
                    let power = is_first.then(|| "TRUE".into());
                    self.call(action, power)?;
                    self.load_output(action)?;
                }
            }
            is_first = false;
        }
        if !is_first {
            return self.drives(path, inverse, reloaded(path, gates, is_whole));
        }
        let mut is_loaded = false;
        for drive in &path.drives {
            match drive {
                Drive::Path(path) => self.path(path, true)?,
                Drive::Action(action) => self.unconditional(action, is_loaded)?,
            }
            is_loaded = !loses(drive);
        }
        Ok(())
    }

    /// What comes behind a call that was written with its input: gate `number` of `path`, or its only drive.
    fn behind_call(&mut self, path: &Path, number: usize) -> Result<(), Message> {
        let Some(Gate::Through(action)) = path.gates.get(number) else { return Ok(()) };
        self.load_output(action)?;
        let rest = Path { gates: path.gates[number + 1..].to_vec(), drives: path.drives.clone() };
        self.path(&rest, false)
    }

    /// An action at the left rail, whose power may be loaded already.
    fn unconditional(&mut self, action: &Action, is_loaded: bool) -> Result<(), Message> {
        if !is_loaded {
            self.start();
        }
        match &action.deed {
            Deed::Jump | Deed::Return => return self.leave(action, ""),
            Deed::Compute(_) => return self.computation(action),
            Deed::Call(call) if call.is_enabled() => return self.conditional_call(action, "CAL"),
            Deed::Call(call) if !call.is_input_operator() => return self.call(action, Some("TRUE".into())),
            _ if is_loaded => {}
            _ => self.lines.push("LD TRUE".into()),
        }
        self.action(action, false)
    }

    fn drives(&mut self, path: &Path, inverse: bool, reloaded: Option<String>) -> Result<(), Message> {
        let mut is_lost = false;
        let mut held: Option<SmolStr> = None;
        let mut number = 0;
        while let Some(drive) = path.drives.get(number) {
            let computed = path.drives[number..].iter().map_while(computation_of);
            let computed: Vec<&Action> = computed.collect();
            number += computed.len().max(1);
            if std::mem::take(&mut is_lost) {
                self.start();
                let held = held.as_ref().map(|name| format!("LD {name}"));
                self.lines.push(held.or_else(|| reloaded.clone()).unwrap_or_default());
            }
            let is_last = number == path.drives.len();
            if loses(drive) && !is_last {
                if held.is_none() && reloaded.is_none() {
                    let name = self.helpers.held(self.held);
                    self.held += 1;
                    self.lines.push(format!("ST {name}"));
                    held = Some(name);
                }
                is_lost = true;
            }
            // Power that was kept before a coil of a falling edge is kept anew behind it.
            if is_fall(drive) {
                self.held -= usize::from(held.take().is_some());
            }
            match drive {
                _ if !computed.is_empty() => self.computations(&computed)?,
                Drive::Action(action) => self.action(action, inverse)?,
                Drive::Path(inner) if !loses(drive) => self.inverted(inner, is_last)?,
                Drive::Path(inner) => self.path(inner, false)?,
            }
        }
        self.held -= usize::from(held.is_some());
        Ok(())
    }

    /// Outputs behind an inverter alone.
    fn inverted(&mut self, path: &Path, is_last: bool) -> Result<(), Message> {
        let actions = || {
            path.drives.iter().filter_map(|drive| match drive {
                Drive::Action(action) => Some(action),
                Drive::Path(_) => None,
            })
        };
        if path.drives.iter().all(is_invertible) {
            return actions().try_for_each(|action| self.action(action, true));
        }
        self.lines.push("NOT".into());
        actions().try_for_each(|action| self.action(action, false))?;
        if !is_last {
            self.lines.push("NOT".into());
        }
        Ok(())
    }

    /// Whether power is wanted behind a coil of a falling edge that a helper kept before it: a list goes on from the
    /// coil alone.
    fn goes_back(&self) -> bool {
        let behind = self.lines.iter().enumerate().skip(self.last);
        let mut loads = behind.filter_map(|(at, line)| Some((at, line.strip_prefix("LD ")?)));
        loads.any(|(at, name)| {
            let stores = |line: &String| line.strip_prefix("ST ") == Some(name);
            is_helper_name(name)
                && self.lines[..at].iter().rposition(stores).is_some_and(|store| store < self.last)
        })
    }

    /// A load outside of parentheses follows.
    fn start(&mut self) {
        self.group = self.lines.len();
        self.driven.clear();
    }

    fn expression(&mut self, expression: &Expression, place: Place) -> Result<(), Message> {
        match (expression, place) {
            (Expression::Contact(contact), _) => self.contact(contact, place),
            (Expression::Constant(value), _) => {
                let word = if *value { "TRUE" } else { "FALSE" };
                self.lines.push(format!("{} {word}", operator(place, false)));
                Ok(())
            }
            (Expression::And(parts), Place::And) | (Expression::Or(parts), Place::Or) => {
                parts.iter().try_for_each(|part| self.expression(part, place))
            }
            (Expression::And(parts) | Expression::Or(parts), Place::Load) => {
                let joined = if matches!(expression, Expression::And(_)) { Place::And } else { Place::Or };
                parts.iter().enumerate().try_for_each(|(number, part)| {
                    self.expression(part, if number == 0 { Place::Load } else { joined })
                })
            }
            (Expression::Not(part), _) => {
                if let Expression::Contact(contact) = &**part
                    && is_plain(contact)
                {
                    let operand = self.operand(contact)?;
                    self.lines.push(format!("{} {operand}", operator(place, true)));
                    return Ok(());
                }
                if place != Place::Load {
                    return self.parenthesis(part, operator(place, true));
                }
                self.expression(part, Place::Load)?;
                self.lines.push("NOT".into());
                Ok(())
            }
            _ => self.parenthesis(expression, operator(place, false)),
        }
    }

    /// `AND( a … )`: the operand of the first load stands behind the parenthesis.
    fn parenthesis(&mut self, inner: &Expression, word: &str) -> Result<(), Message> {
        // Calls that are put before the group shift the lines behind its start.
        let behind = self.lines.len() - self.group;
        self.expression(inner, Place::Load)?;
        let first = self.group + behind;
        if let Some(line) = self.lines.get_mut(first) {
            match line.strip_prefix("LD ") {
                Some(operand) => *line = format!("{word}( {operand}"),
                None => self.lines.insert(first, format!("{word}(")),
            }
        }
        self.lines.push(")".into());
        Ok(())
    }

    fn contact(&mut self, contact: &Contact, place: Place) -> Result<(), Message> {
        if let (Test::Compare(compared), [left, right]) = (contact.test, &contact.terms[..]) {
            let (left, right) = (&left.text, &right.text);
            let load = match place {
                Place::Load => format!("LD {left}"),
                _ => format!("{}( {left}", operator(place, false)),
            };
            self.lines.extend([load, format!("{} {right}", compared.iec_name())]);
            self.lines.extend((place != Place::Load).then(|| ")".into()));
            return Ok(());
        }
        let negated = contact.test == Test::Bit(ContactKind::NormallyClosed);
        let operand = self.operand(contact)?;
        self.lines.push(format!("{} {operand}", operator(place, negated)));
        Ok(())
    }

    /// The operand of a contact of one bit; an edge is detected by a block that is called before the load.
    fn operand(&mut self, contact: &Contact) -> Result<String, Message> {
        let [term] = &contact.terms[..] else { return Err(Message::new("translate.no-instruction")) };
        let late = || Message::new("translate.edge-of-driven").with("operand", &term.text);
        match contact.test {
            Test::Bit(ContactKind::Rising) if self.driven.contains(&term.key()) => return Err(late()),
            Test::Bit(ContactKind::Rising) => {}
            Test::Bit(ContactKind::Falling) => {
                let may_be_other = self.changed.iter().any(|changed| changed.may_cover(term))
                    || self.has_run && term.storage != Storage::Local;
                return if may_be_other { Err(late()) } else { Ok(self.fall(term)) };
            }
            _ => return Ok(term.text.to_string()),
        }
        let name = self.helpers.detector("Rise", "R_TRIG");
        let call = format!("CAL {name}(\nCLK := {}\n)", term.text);
        self.lines.insert(self.group, call);
        self.group += 1;
        Ok(format!("{name}.Q"))
    }

    /// The variable that is on at the falling edge of a bit.
    fn fall(&mut self, term: &Term) -> String {
        let [was, fall] = self.helpers.fall(true);
        let lines = [
            format!("LD {was}"),
            format!("ANDN {term}"),
            format!("ST {fall}"),
            format!("LD {term}"),
            format!("ST {was}"),
        ];
        let count = lines.len();
        self.lines.splice(self.falls..self.falls, lines);
        self.falls += count;
        self.group += count;
        fall.to_string()
    }

    /// Notes what an action may change.
    fn note(&mut self, action: &Action) {
        self.changed.extend(action.changes().into_iter().map(Cow::into_owned));
        self.has_run |= action.runs_unit();
    }

    fn action(&mut self, action: &Action, inverse: bool) -> Result<(), Message> {
        self.note(action);
        let word = match (&action.deed, inverse) {
            (Deed::Call(call), _) if call.is_enabled() && !call.tells_enable() => {
                return self.conditional_call(action, if inverse { "CALCN" } else { "CALC" });
            }
            (Deed::Call(_), _) => return self.call(action, None),
            (Deed::Coil(coil @ (CoilKind::Rising | CoilKind::Falling)), false) => {
                return self.pulse(action, *coil);
            }
            (Deed::Jump | Deed::Return, _) => return self.leave(action, if inverse { "CN" } else { "C" }),
            (Deed::Coil(CoilKind::Plain), false) | (Deed::Coil(CoilKind::Negated), true) => "ST",
            (Deed::Coil(CoilKind::Plain), true) | (Deed::Coil(CoilKind::Negated), false) => "STN",
            (Deed::Coil(CoilKind::Set), false) => "S",
            (Deed::Coil(CoilKind::Reset), false) => "R",
            _ => return Err(Message::new("translate.no-instruction")),
        };
        let [term] = &action.terms[..] else { return Err(Message::new("translate.no-instruction")) };
        self.lines.push(format!("{word} {term}"));
        self.driven.insert(term.key());
        Ok(())
    }

    /// A coil of an edge: the output of a detector, stored; or what was found of the power.
    fn pulse(&mut self, action: &Action, coil: CoilKind) -> Result<(), Message> {
        let [term] = &action.terms[..] else { return Err(Message::new("translate.no-instruction")) };
        if coil == CoilKind::Falling {
            let power = self.helpers.pulse(coil, "BOOL", &term.text);
            let [was, _] = self.helpers.fall(false);
            self.lines.extend([format!("ST {power}"), format!("LD {was}"), format!("ANDN {power}")]);
            self.lines.extend([format!("ST {term}"), format!("LD {power}"), format!("ST {was}")]);
            self.last = self.lines.len();
            return Ok(());
        }
        let name = self.helpers.pulse(coil, "R_TRIG", &term.text);
        self.lines.extend([format!("ST {name}.CLK"), format!("CAL {name}")]);
        self.start();
        self.lines.extend([format!("LD {name}.Q"), format!("ST {term}")]);
        self.driven.insert(term.key());
        Ok(())
    }

    /// Calculations that are done if the current result is on.
    fn computations(&mut self, actions: &[&Action]) -> Result<(), Message> {
        let label = self.helpers.label();
        self.lines.push(format!("JMPCN {label}"));
        actions.iter().try_for_each(|action| self.computation(action))?;
        self.lines.push(format!("{label}:"));
        Ok(())
    }

    /// `LD a`, `ADD b`, `ST c`; `LD a`, `INT_TO_WORD`, `AND( b`, `INT_TO_WORD`, `)`, `WORD_TO_INT`, `ST c`
    fn computation(&mut self, action: &Action) -> Result<(), Message> {
        self.note(action);
        let operands = match &action.deed {
            Deed::Compute(computation) => {
                computation.operands(&action.terms).map(|found| (computation, found))
            }
            _ => None,
        };
        let Some((computation, (inputs, result))) = operands else {
            return Err(Message::new("translate.no-instruction"));
        };
        match inputs {
            [] => self.lines.push(format!("{}()", computation.name())),
            [first, others @ ..] if computation.is_declared() => {
                let others: Vec<&str> = others.iter().map(|term| term.text.as_str()).collect();
                let operands = format!("{} {}", computation.name(), others.join(", "));
                self.lines.extend([format!("LD {first}"), operands.trim_end().to_string()]);
            }
            _ => self.operators(computation, inputs),
        }
        self.lines.push(format!("ST {result}"));
        self.driven.extend(computation.changes(&action.terms).into_iter().map(Term::key));
        Ok(())
    }

    /// A function of the standard on its inputs, which has an operator.
    fn operators(&mut self, computation: &Computation, inputs: &[Term]) {
        let (function, conversion) = (computation.name(), computation.conversion);
        for (number, term) in inputs.iter().enumerate() {
            match (number, conversion.of_input(term)) {
                (0, conversion) => {
                    self.lines.push(format!("LD {term}"));
                    self.lines.extend(conversion.map(str::to_string));
                }
                (_, None) => self.lines.push(format!("{function} {term}")),
                (_, Some(conversion)) => {
                    self.lines.extend([format!("{function}( {term}"), conversion.into(), ")".into()]);
                }
            }
        }
        // What has one input but copies it is an operator without an operand.
        self.lines.extend((inputs.len() == 1 && !computation.copies()).then(|| function.into()));
        self.lines.extend(conversion.of_result().map(str::to_string));
    }

    fn leave(&mut self, action: &Action, condition: &str) -> Result<(), Message> {
        let word = if action.deed == Deed::Return { "RET" } else { "JMP" };
        let label = action.terms.first().map_or(String::new(), |label| format!(" {label}"));
        self.lines.push(format!("{word}{condition}{label}"));
        Ok(())
    }

    /// A call with this operand at its first input, or with the current result.
    fn call(&mut self, action: &Action, power: Option<String>) -> Result<(), Message> {
        self.note(action);
        let (Deed::Call(call), Some(instance)) = (&action.deed, action.terms.first()) else {
            return Err(Message::new("translate.no-instruction"));
        };
        match power {
            None if call.is_input_operator() => self.lines.push(format!("{} {instance}", call.power_in())),
            None if call.tells_enable() => {
                let name = self.helpers.enable();
                self.lines.push(format!("ST {name}"));
                self.lines.push(call_text("CAL", call, Some(name.into()), &action.terms));
            }
            None => {
                self.lines.push(format!("ST {instance}.{}", call.power_in()));
                self.lines.push(call_text("CAL", call, None, &action.terms));
            }
            power => self.lines.push(call_text("CAL", call, power, &action.terms)),
        }
        self.driven.extend(call.changes(&action.terms).iter().map(Term::key));
        Ok(())
    }

    /// A call that the current result enables, or that is always done, as `word` says.
    fn conditional_call(&mut self, action: &Action, word: &str) -> Result<(), Message> {
        self.note(action);
        let Deed::Call(call) = &action.deed else { return Err(Message::new("translate.no-instruction")) };
        self.lines.push(call_text(word, call, None, &action.terms));
        self.driven.extend(call.changes(&action.terms).iter().map(Term::key));
        Ok(())
    }

    fn load_output(&mut self, action: &Action) -> Result<(), Message> {
        let output = action.power_out().ok_or_else(|| Message::new("translate.no-instruction"))?;
        self.start();
        self.lines.push(format!("LD {output}"));
        Ok(())
    }
}

fn call_text(word: &str, call: &Call, power: Option<String>, terms: &[Term]) -> String {
    let instance = terms.first().map_or("", |term| term.text.as_str());
    let arguments = call.arguments(terms).into_iter().map(|argument| {
        let sign = if argument.is_output { "=>" } else { ":=" };
        format!("{} {sign} {}", argument.name, argument.term)
    });
    let power = power.map(|operand| format!("{} := {operand}", call.power_in()));
    let list: Vec<String> = power.into_iter().chain(arguments).collect();
    match list.is_empty() {
        true => format!("{word} {instance}"),
        false => format!("{word} {instance}(\n{}\n)", list.join(",\n")),
    }
}

/// The word of an operator in a place.
fn operator(place: Place, negated: bool) -> &'static str {
    match (place, negated) {
        (Place::Load, false) => "LD",
        (Place::Load, true) => "LDN",
        (Place::And, false) => "AND",
        (Place::And, true) => "ANDN",
        (Place::Or, false) => "OR",
        (Place::Or, true) => "ORN",
    }
}

/// Whether a contact is an operand as it stands, or the output of a detector.
fn is_plain(contact: &Contact) -> bool {
    matches!(contact.test, Test::Bit(kind) if kind != ContactKind::NormallyClosed)
}

/// The call that takes the power behind gate `number` of `path`, if nothing else does.
fn called_next(path: &Path, number: usize) -> Option<&Action> {
    let next = match (path.gates.get(number + 1), &path.drives[..]) {
        (Some(Gate::Through(action)), _) | (None, [Drive::Action(action)]) => action,
        _ => return None,
    };
    let takes = |call: &Call| !call.is_input_operator() && (!call.is_enabled() || call.tells_enable());
    matches!(&next.deed, Deed::Call(call) if takes(call)).then_some(next)
}

/// The calculation that a drive is.
fn computation_of(drive: &Drive) -> Option<&Action> {
    match drive {
        Drive::Action(action) => matches!(action.deed, Deed::Compute(_)).then_some(action),
        Drive::Path(_) => None,
    }
}

/// Whether an output has an instruction that wants the inverse of its power.
fn is_invertible(drive: &Drive) -> bool {
    use CoilKind::{Negated, Plain};
    let Drive::Action(action) = drive else { return false };
    match &action.deed {
        Deed::Call(call) => call.is_enabled() && !call.tells_enable(),
        deed => matches!(deed, Deed::Coil(Plain | Negated) | Deed::Jump | Deed::Return),
    }
}

/// Whether it is a coil of a falling edge.
fn is_fall(drive: &Drive) -> bool {
    matches!(drive, Drive::Action(Action { deed: Deed::Coil(CoilKind::Falling), .. }))
}

/// Whether the current result is no longer the power behind this.
fn loses(drive: &Drive) -> bool {
    let calls = |action: &Action| {
        matches!(action.deed, Deed::Call(_) | Deed::Compute(_) | Deed::Coil(CoilKind::Rising))
    };
    match drive {
        Drive::Action(action) => calls(action),
        Drive::Path(path) => {
            let is_action = |drive: &Drive| matches!(drive, Drive::Action(action) if !calls(action));
            path.gates != [Gate::Invert] || !path.drives.iter().all(is_action)
        }
    }
}

/// The load that gives the power behind `gates` again: that of a single contact or of the output of a block, if
/// nothing in the path changes it. `is_whole` says that the gates begin at the left rail.
fn reloaded(path: &Path, gates: &[Gate], is_whole: bool) -> Option<String> {
    let (word, term) = match gates {
        [.., Gate::Through(action)] => ("LD", action.power_out()?),
        [Gate::Pass(Expression::Contact(contact))] if is_whole => match (contact.test, &contact.terms[..]) {
            (Test::Bit(ContactKind::NormallyOpen), [term]) => ("LD", term.clone()),
            (Test::Bit(ContactKind::NormallyClosed), [term]) => ("LDN", term.clone()),
            _ => return None,
        },
        _ => return None,
    };
    let mut is_changed = term.text.contains(['[', '^']);
    let mut changes = |action: &Action| {
        is_changed |= action.runs_unit() && term.storage != Storage::Local;
        is_changed |= match &action.deed {
            Deed::Call(call) => call.changes(&action.terms).iter().any(|changed| changed.may_cover(&term)),
            _ => action.terms.iter().any(|changed| changed.may_cover(&term)),
        }
    };
    for drive in &path.drives {
        match drive {
            Drive::Action(action) => changes(action),
            Drive::Path(path) => path.visit(&mut changes, &mut |_| {}),
        }
    }
    (!is_changed).then(|| format!("{word} {}", term.text))
}
