//! Paths of IEC 61131-3 in the words of the FX family.

use super::super::source::Program;
use super::{COMPUTED, Lack, PULSE, STEPPED, device_at, without};
use crate::document::{DeclaredType, Scopes};
use crate::il::iec::SectionKind;
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::logic::{
    Action, Call, Computation, Contact, Deed, Drive, Expression, Gate, Path, Storage, Term, Test,
};
use crate::target::iec::{ElementaryType, LiteralValue};
use crate::target::{Device, DeviceKind, Form, Operand, Target, Width};
use crate::text::{Span, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};

/// The instance and the member that a variable such as `T0.Q` names.
fn member(term: &Term) -> Option<(&str, &str)> {
    (term.operand == Operand::Variable).then(|| term.text.split_once('.')).flatten()
}

/// What the names of a program stand for on the FX family, where each is one device.
pub(super) struct Names {
    /// The pointers for labels, by folded name.
    labels: FxHashMap<SmolStr, SmolStr>,
    /// The devices that cannot be named without an address: those at whose addresses something lies, and those whose
    /// names are variables of several program units.
    taken: FxHashSet<Device>,
}

impl Names {
    /// Labels that are names of pointers keep them, the others get the next free ones.
    pub(super) fn of(program: &Program, scopes: &Scopes, target: &Target) -> Names {
        let mut labels = FxHashMap::default();
        let names = || program.rungs.iter().flat_map(|source| &source.rung.labels);
        for name in names().filter(|name| pointer(name).is_some()) {
            labels.insert(folded(name), name.to_uppercase().into());
        }
        let taken: FxHashSet<SmolStr> = labels.values().cloned().collect();
        let mut free = (0..).map(|number| format_smolstr!("P{number}")).filter(|name| !taken.contains(name));
        for name in names() {
            if !labels.contains_key(&folded(name))
                && let Some(pointer) = free.next()
            {
                labels.insert(folded(name), pointer);
            }
        }
        Names { labels, taken: taken_devices(program, scopes, target) }
    }

    /// The pointer for a label; one that nobody has stays as it is.
    pub(super) fn of_label(&self, label: &SmolStr) -> SmolStr {
        self.labels.get(&folded(label)).unwrap_or(label).clone()
    }

    /// Whether nothing else is this device than the variable of its name.
    fn is_free(&self, device: Device) -> bool {
        !self.taken.contains(&device)
    }
}

fn taken_devices(program: &Program, scopes: &Scopes, target: &Target) -> FxHashSet<Device> {
    let mut taken = FxHashSet::default();
    let mut named = FxHashSet::default();
    for (unit, pou) in scopes.own_pous().iter().enumerate() {
        for variable in &pou.variables {
            match (variable.address, Operand::read(&variable.name, target.model)) {
                (Some(address), _) => taken.extend(device_at(address)),
                (None, Operand::Device(device)) if variable.section == SectionKind::Local => {
                    taken.extend((!named.insert(device) && unit > 0).then_some(device));
                }
                _ => {}
            }
        }
    }
    taken.extend(scopes.globals.values().filter_map(|variable| device_at(variable.address?)));
    for path in program.rungs.iter().flat_map(|source| source.rung.path.iter().flatten()) {
        path.clone().each_term(&mut |term| {
            if let Operand::Direct(address) = term.operand {
                taken.extend(device_at(address));
            }
        });
    }
    taken
}

/// Whether a model of the family has it; what the target lacks is said of the instruction.
fn is_known(device: Device) -> bool {
    Target::ALL.into_iter().any(|target| device.range_on(target).is_some())
}

/// Whether an instance detects the power of a pulse form.
fn is_pulse(name: &str) -> bool {
    let stem = name.get(..PULSE.len()).is_some_and(|stem| stem.eq_ignore_ascii_case(PULSE));
    stem && name.len() > PULSE.len() && name[PULSE.len()..].bytes().all(|byte| byte.is_ascii_digit())
}

fn pointer(name: &str) -> Option<u32> {
    name.strip_prefix(['P', 'p'])?.parse().ok()
}

/// `path` of a program unit with devices of `target` for variables.
pub(super) fn path(
    path: &Path,
    target: &Target,
    names: &Names,
    (scopes, pou): (&Scopes, Option<usize>),
) -> Result<Path, Lack> {
    Converter { target, names, scopes, pou }.whole(path)
}

struct Converter<'a> {
    target: &'a Target,
    names: &'a Names,
    scopes: &'a Scopes,
    pou: Option<usize>,
}

impl Converter<'_> {
    /// A path from the left rail. Behind a timer or counter the power is its contact, which begins a path of its own.
    fn whole(&self, path: &Path) -> Result<Path, Lack> {
        let through = path
            .gates
            .iter()
            .rposition(|gate| matches!(gate, Gate::Through(action) if self.pulsed(action, path).is_none()));
        let Some(through) = through else { return self.path(path) };
        let Gate::Through(action) = &path.gates[through] else { return Err(Lack::Unnamed) };
        let before =
            Path { gates: path.gates[..through].to_vec(), drives: vec![Drive::Action(action.clone())] };
        let output = without(action.power_out())?;
        let contact =
            Contact { test: Test::Bit(ContactKind::NormallyOpen), terms: vec![output], span: action.span };
        let mut gates = vec![Gate::Pass(Expression::Contact(contact))];
        gates.extend_from_slice(&path.gates[through + 1..]);
        let behind = Path { gates, drives: path.drives.clone() };
        let drives = vec![Drive::Path(self.whole(&before)?), Drive::Path(self.path(&behind)?)];
        Ok(Path { gates: Vec::new(), drives })
    }

    fn path(&self, path: &Path) -> Result<Path, Lack> {
        let mut converted = Path::default();
        for gate in &path.gates {
            match gate {
                Gate::Pass(expression) => converted.gates.push(Gate::Pass(self.expression(expression)?)),
                Gate::Invert => converted.gates.push(Gate::Invert),
                Gate::Through(action) => {
                    let coil = without(self.pulsed(action, path)).map_err(|lack| lack.of_action(action))?;
                    converted.drives.push(Drive::Action(coil));
                    return Ok(converted);
                }
            }
        }
        // What IEC does in each scan, a contact that is always on drives.
        let is_bare = |drive: &Drive| matches!(drive, Drive::Action(action) if !action.deed.stands_alone());
        if path.gates.is_empty() && path.drives.iter().any(is_bare) {
            converted.gates.push(Gate::Pass(Expression::Constant(true)));
        }
        for drive in &path.drives {
            converted.drives.push(match drive {
                Drive::Path(path) => match &path.gates[..] {
                    [Gate::Through(action)] => {
                        let coil = without(self.pulsed(action, path)).map_err(|lack| lack.of_action(action));
                        Drive::Action(coil?)
                    }
                    _ => Drive::Path(self.path(path)?),
                },
                Drive::Action(action) => {
                    Drive::Action(self.action(action).map_err(|lack| lack.of_action(action))?)
                }
            });
        }
        Ok(converted)
    }

    /// The pulse form that the detector at the end of the gates of `path` and the calculation behind it are.
    fn pulsed(&self, detector: &Action, path: &Path) -> Option<Action> {
        let (Deed::Call(call), [Drive::Action(driven)]) = (&detector.deed, &path.drives[..]) else {
            return None;
        };
        let Deed::Compute(computation) = &driven.deed else { return None };
        let instance = detector.terms.first()?;
        let is_last = matches!(path.gates.last(), Some(Gate::Through(last)) if last == detector);
        if !call.block.is_standard("R_TRIG") || !is_last || !is_pulse(&instance.text) {
            return None;
        }
        let action = self.calculation(computation, driven).ok()?;
        // RST has no pulse form.
        let Deed::Instruction(form) = action.deed else { return None };
        Some(Action { deed: Deed::Instruction(Form { pulse: true, ..form }), ..action })
    }

    fn expression(&self, expression: &Expression) -> Result<Expression, Lack> {
        expression.mapped(&mut |contact| self.contact(contact).map_err(|lack| lack.of_contact(contact)))
    }

    fn contact(&self, contact: &Contact) -> Result<Expression, Lack> {
        let terms = match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => {
                if let Operand::Literal(literal) = term.operand
                    && let LiteralValue::Bool(value) = literal.value
                {
                    return match kind {
                        ContactKind::NormallyOpen => Ok(Expression::Constant(value)),
                        ContactKind::NormallyClosed => Ok(Expression::Constant(!value)),
                        _ => Err(Lack::Unnamed),
                    };
                }
                vec![self.bit(term)?]
            }
            (Test::Compare(operator), [left, right]) => {
                let words = vec![self.word(left)?, self.word(right)?];
                self.compared(operator, [left, right])?;
                words
            }
            _ => return Err(Lack::Unnamed),
        };
        Ok(Expression::Contact(Contact { terms, ..contact.clone() }))
    }

    fn bit(&self, term: &Term) -> Result<Term, Lack> {
        self.own_bit(term).map_err(|lack| lack.named(&term.text))
    }

    fn own_bit(&self, term: &Term) -> Result<Term, Lack> {
        use DeviceKind::{C, M, S, T, X, Y};
        if let Some((instance, member)) = member(term) {
            let device = without(self.named(instance).filter(|device| matches!(device.kind, T | C)))?;
            return without(member.eq_ignore_ascii_case("Q").then(|| self.term(device, term.span)));
        }
        let device = without(self.device(term))?;
        without(matches!(device.kind, X | Y | M | S).then(|| self.term(device, term.span)))
    }

    /// A word of 16 bits, of which ADD and its kin make the same whether it has a sign or not.
    fn word(&self, term: &Term) -> Result<Term, Lack> {
        use ElementaryType::{Int, Uint, Word};
        if let Some(kind) = self.type_of(term)
            && !matches!(kind, Int | Uint | Word)
        {
            return Err(Lack::Type(term.text.clone(), kind.name()));
        }
        self.own_word(term).map_err(|lack| lack.named(&term.text))
    }

    /// The elementary type of a variable that is declared, or of an address.
    fn type_of(&self, term: &Term) -> Option<ElementaryType> {
        match term.operand {
            Operand::Direct(address) if address.width == Width::Word => Some(ElementaryType::Word),
            Operand::Variable => match self.scopes.type_of(self.pou, &term.text)? {
                DeclaredType::Elementary(kind) => Some(kind),
                _ => None,
            },
            _ => None,
        }
    }

    /// Whether two words compare as the FX family does it: with a sign, which counts but for equality of patterns.
    fn compared(&self, operator: CompareOperator, sides: [&Term; 2]) -> Result<(), Lack> {
        use CompareOperator::{Equal, NotEqual};
        let types = sides.map(|term| self.type_of(term));
        let unsigned = types.iter().zip(sides).find_map(|(kind, term)| {
            let kind = kind.filter(|kind| *kind != ElementaryType::Int)?;
            Some((kind, term))
        });
        let Some((kind, term)) = unsigned else { return Ok(()) };
        let is_negative = |term: &Term| match term.operand {
            Operand::Literal(literal) => matches!(literal.value, LiteralValue::Integer(..0)),
            _ => false,
        };
        let is_pattern = matches!(operator, Equal { .. } | NotEqual { .. })
            && types.iter().flatten().all(|other| *other == kind)
            && !sides.into_iter().any(is_negative);
        if is_pattern { Ok(()) } else { Err(Lack::Order(term.text.clone(), kind.name())) }
    }

    fn own_word(&self, term: &Term) -> Result<Term, Lack> {
        if let Operand::Literal(literal) = term.operand {
            let LiteralValue::Integer(value) = literal.value else { return Err(Lack::Unnamed) };
            return self.constant(without(i16::try_from(value).ok())?.into(), term.span);
        }
        if let Some((instance, member)) = member(term) {
            let device = without(self.named(instance).filter(|device| device.kind == DeviceKind::C))?;
            return without(member.eq_ignore_ascii_case("CV").then(|| self.term(device, term.span)));
        }
        let device = without(self.device(term))?;
        without((device.kind == DeviceKind::D).then(|| self.term(device, term.span)))
    }

    /// The device of this name that the target has.
    fn named(&self, name: &str) -> Option<Device> {
        match Operand::read(name, self.target.model) {
            Operand::Device(device) => is_known(device).then_some(device),
            _ => None,
        }
    }

    /// The device that a variable stands for: by its address, or if it has none by its name.
    fn device(&self, term: &Term) -> Option<Device> {
        let device = match term.storage {
            Storage::Own | Storage::Local if term.operand == Operand::Variable => {
                self.named(&term.text).filter(|device| self.names.is_free(*device))
            }
            Storage::Anywhere => None,
            _ => device_at(term.address()?),
        };
        device.filter(|device| is_known(*device))
    }

    fn term(&self, device: Device, span: Span) -> Term {
        Term::of_device(device, span)
    }

    fn constant(&self, value: i64, span: Span) -> Result<Term, Lack> {
        let text = format_smolstr!("K{value}");
        Ok(Term::new(Operand::read(&text, self.target.model), &text, span))
    }

    fn action(&self, action: &Action) -> Result<Action, Lack> {
        let (deed, terms) = match (&action.deed, &action.terms[..]) {
            (Deed::Coil(_), [term]) => (action.deed.clone(), vec![self.bit(term)?]),
            (Deed::Jump, [label]) => {
                let pointer = self.names.of_label(&label.text);
                let operand = Operand::read(&pointer, self.target.model);
                let form = without(Form::named("CJ").filter(|_| self::pointer(&pointer).is_some()))?;
                (Deed::Instruction(form), vec![Term::new(operand, &pointer, label.span)])
            }
            (Deed::Compute(computation), _) => return self.calculation(computation, action),
            (Deed::Call(call), [instance, ..]) => self.called(call, instance, &action.terms)?,
            _ => return Err(Lack::Unnamed),
        };
        Ok(Action { deed, terms, span: action.span })
    }

    /// The instruction that a calculation is.
    fn calculation(&self, computation: &Computation, action: &Action) -> Result<Action, Lack> {
        let (inputs, result) = without(computation.operands(&action.terms))?;
        let register = self.word(result)?;
        without(matches!(register.operand, Operand::Device(_)).then_some(()))?;
        let function = without((!computation.is_declared()).then(|| computation.name()))?;
        let row = |rows: &[(&'static str, &str)]| {
            rows.iter().find(|(_, own)| *own == function).and_then(|(mnemonic, _)| Form::named(mnemonic))
        };
        let span = action.span;
        match inputs {
            [zero] if zero.text == "0" => {
                let deed = Deed::Coil(CoilKind::Reset);
                return Ok(Action { deed, terms: vec![register], span });
            }
            [left, one] if left == result && one.text == "1" && row(&STEPPED).is_some() => {
                let deed = Deed::Instruction(without(row(&STEPPED))?);
                return Ok(Action { deed, terms: vec![register], span });
            }
            _ => {}
        }
        let form = without(row(&COMPUTED))?;
        let mut terms = inputs.iter().map(|term| self.word(term)).collect::<Result<Vec<_>, _>>()?;
        terms.push(register);
        Ok(Action { deed: Deed::Instruction(form), terms, span })
    }

    /// The output that the call of a timer or counter is.
    fn called(&self, call: &Call, instance: &Term, terms: &[Term]) -> Result<(Deed, Vec<Term>), Lack> {
        let device = without(self.named(&instance.text))?;
        let own = self.term(device, instance.span);
        let arguments = call.arguments(terms);
        let block = without((!call.block.is_declared()).then(|| call.block.name()))?;
        match (block, device.kind, call.power_in(), &arguments[..]) {
            ("CTU", DeviceKind::C, "R", []) if device.number < 200 => {
                Ok((Deed::Coil(CoilKind::Reset), vec![own]))
            }
            ("CTU", DeviceKind::C, "CU", [preset]) if preset.name == "PV" && device.number < 200 => {
                Ok((Deed::Coil(CoilKind::Plain), vec![own, self.word(&preset.term)?]))
            }
            ("TON", DeviceKind::T, "IN", [preset]) if preset.name == "PT" => {
                let range = without(device.range_on(self.target).filter(|range| !range.latched))?;
                let Operand::Literal(literal) = preset.term.operand else {
                    return Err(Lack::Unnamed);
                };
                let LiteralValue::Time(time) = literal.value else { return Err(Lack::Unnamed) };
                let unit = i64::from(range.timer_unit_ms) * 1_000_000;
                let steps = without((unit > 0 && time % unit == 0).then(|| time / unit))?;
                let steps = without((0..=i64::from(i16::MAX)).contains(&steps).then_some(steps))?;
                Ok((Deed::Coil(CoilKind::Plain), vec![own, self.constant(steps, preset.term.span)?]))
            }
            _ => Err(Lack::Unnamed),
        }
    }
}
