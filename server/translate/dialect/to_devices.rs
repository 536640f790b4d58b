//! Paths of IEC 61131-3 in the words of the FX family.

use super::super::source::Program;
mod calculation;

use super::counted::{Instances, constant, is_alike, turned};
use super::first_scan::bit_of;
use super::{END_POINTER, Lack, PULSE, Registers, device_at, devices_at, pair_at, single_edge, without};
use crate::document::{DeclaredType, Scopes};
use crate::il::iec::SectionKind;
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::logic::{Action, Call, Contact, Deed, Drive, Expression, Gate, Path, Storage, Term, Test};
use crate::target::iec::{ElementaryType, LiteralValue};
use crate::target::{Device, DeviceKind, DirectAddress, Form, Operand, Target, Width};
use crate::text::{Message, Span, folded};
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
        let is_pointer = |name: &&SmolStr| pointer(name).is_some() && !name.eq_ignore_ascii_case(END_POINTER);
        for name in names().filter(is_pointer) {
            labels.insert(folded(name), name.to_uppercase().into());
        }
        let taken: FxHashSet<SmolStr> = labels.values().cloned().collect();
        let mut free = (0..)
            .map(|number| format_smolstr!("P{number}"))
            .filter(|name| !taken.contains(name) && name != END_POINTER);
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
                (Some(address), _) => taken.extend(devices_at(address)),
                (None, Operand::Device(device)) if variable.section == SectionKind::Local => {
                    taken.extend((!named.insert(device) && unit > 0).then_some(device));
                }
                _ => {}
            }
        }
    }
    let located: Vec<DirectAddress> =
        scopes.globals.values().filter_map(|variable| variable.address).collect();
    taken.extend(located.into_iter().flat_map(devices_at));
    for term in program.rungs.iter().filter_map(|source| source.path()).flat_map(Path::terms) {
        if let Operand::Direct(address) = term.operand {
            taken.extend(devices_at(address));
        }
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
    (names, registers, instances): (&Names, &Registers, &Instances),
    (scopes, pou): (&Scopes, Option<usize>),
) -> Result<Path, Lack> {
    let converter = Converter { target, names, registers, instances, types: Types { scopes, pou } };
    converter.whole(&with_first_scan(path, instances))
}

/// `path` with contacts for an F_TRIG that is called in each scan with the bit that was loaded before it: the falling
/// edge of that bit, or the first scan if the bit is off in it.
pub(super) fn with_first_scan(path: &Path, instances: &Instances) -> Path {
    let [Gate::Pass(Expression::Contact(clock)), Gate::Through(detector), rest @ ..] = &path.gates[..] else {
        return path.clone();
    };
    let is_falling = match (&detector.deed, detector.terms.first()) {
        (Deed::Call(call), Some(instance)) => {
            let is_plain = call.block.is_standard("F_TRIG") && call.power_in() == "CLK";
            is_plain && detector.terms.len() == 1 && instances.is_called_once(&instance.text, true)
        }
        _ => false,
    };
    let ([term], Test::Bit(ContactKind::NormallyOpen), true) = (&clock.terms[..], clock.test, is_falling)
    else {
        return path.clone();
    };
    if matches!(term.operand, Operand::Literal(_)) {
        return path.clone();
    }
    let contact = |kind, term: &Term| {
        Expression::Contact(Contact { test: Test::Bit(kind), terms: vec![term.clone()], span: clock.span })
    };
    let first = Term::of_device(Device::FIRST_SCAN, clock.span);
    let at_first = Expression::and([
        contact(ContactKind::NormallyOpen, &first),
        contact(ContactKind::NormallyClosed, term),
    ]);
    let edge = Expression::or([contact(ContactKind::Falling, term), at_first]);
    let gates = std::iter::once(Gate::Pass(edge)).chain(rest.iter().cloned()).collect();
    Path { gates, drives: path.drives.clone() }
}

/// Why a timer or a counter that a path calls does not do what one of the FX family does.
pub(super) fn counted(path: &Path, instances: &Instances) -> Option<Message> {
    let calls = path.actions().into_iter().filter_map(|action| match &action.deed {
        Deed::Call(call) => Some((call, action.terms.first()?)),
        _ => None,
    });
    let mut lacks = calls.filter_map(|(call, instance)| match () {
        () if call.block.is_standard("CTU") => instances.preset(&instance.text).err(),
        () if call.block.is_standard("TON") => instances.one(&instance.text).err(),
        () => None,
    });
    lacks.next().map(|lack| lack.message())
}

/// Whether two actions without a condition, one directly behind the other, are one DIV.
pub(super) fn is_division(
    [first, next]: [&Drive; 2],
    target: &Target,
    (names, registers, instances): (&Names, &Registers, &Instances),
    (scopes, pou): (&Scopes, Option<usize>),
) -> bool {
    let converter = Converter { target, names, registers, instances, types: Types { scopes, pou } };
    converter.division(first, std::slice::from_ref(next)).is_some()
}

/// Whether the numbers of a path compare and divide as those of the FX family do.
pub(super) fn is_of_family(path: &Path, scopes: &Scopes, pou: Option<usize>) -> bool {
    let types = Types { scopes, pou };
    let (mut acts, mut asks) = (true, true);
    path.visit(&mut |action| acts &= types.calculates(action), &mut |expression| {
        expression.visit(&mut |contact| {
            asks &= match (contact.test, &contact.terms[..]) {
                (Test::Compare(operator), [left, right]) => {
                    types.fit(&contact.terms) && types.compared(operator, [left, right]).is_ok()
                }
                _ => true,
            };
        });
    });
    acts && asks
}

struct Converter<'a> {
    target: &'a Target,
    names: &'a Names,
    registers: &'a Registers,
    instances: &'a Instances,
    types: Types<'a>,
}

/// What is declared of the variables of a program unit.
struct Types<'a> {
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
                    let pulsed = without(self.pulsed(action, path)).map_err(|lack| lack.of_action(action))?;
                    converted.drives.extend(pulsed.into_iter().map(Drive::Action));
                    return Ok(converted);
                }
            }
        }
        // What IEC does in each scan, a contact that is always on drives.
        let is_bare = |drive: &Drive| matches!(drive, Drive::Action(action) if !action.deed.stands_alone());
        if path.gates.is_empty() && path.drives.iter().any(is_bare) {
            converted.gates.push(Gate::Pass(Expression::Constant(true)));
        }
        let mut rest = &path.drives[..];
        while let Some((drive, behind)) = rest.split_first() {
            rest = behind;
            match drive {
                Drive::Path(path) => match &path.gates[..] {
                    [Gate::Through(action)] => {
                        let pulsed =
                            without(self.pulsed(action, path)).map_err(|lack| lack.of_action(action))?;
                        converted.drives.extend(pulsed.into_iter().map(Drive::Action));
                    }
                    _ => converted.drives.push(Drive::Path(self.path(path)?)),
                },
                Drive::Action(action) => {
                    let action = match self.division(drive, behind) {
                        Some(division) => {
                            rest = &behind[1..];
                            Ok(division)
                        }
                        None => self.action(action).map_err(|lack| lack.of_action(action)),
                    };
                    converted.drives.push(Drive::Action(action?));
                }
            }
        }
        Ok(converted)
    }

    /// The pulse forms that the detector at the end of the gates of `path` and the calculations behind it are.
    fn pulsed(&self, detector: &Action, path: &Path) -> Option<Vec<Action>> {
        let Deed::Call(call) = &detector.deed else { return None };
        let instance = detector.terms.first()?;
        let is_last = matches!(path.gates.last(), Some(Gate::Through(last)) if last == detector);
        let is_once = self.instances.is_called_once(&instance.text, false);
        if !call.block.is_standard("R_TRIG") || !is_last || !is_pulse(&instance.text) || !is_once {
            return None;
        }
        let mut pulsed = Vec::new();
        let mut rest = &path.drives[..];
        while let Some((drive, behind)) = rest.split_first() {
            let Drive::Action(driven) = drive else { return None };
            let division = self.division(drive, behind);
            rest = if division.is_some() { &behind[1..] } else { behind };
            let action = match (division, &driven.deed) {
                (Some(division), _) => division,
                (None, Deed::Compute(computation)) => self.calculation(computation, driven).ok()?,
                _ => return None,
            };
            // RST has no pulse form.
            let Deed::Instruction(form) = action.deed else { return None };
            pulsed.push(Action { deed: Deed::Instruction(Form { pulse: true, ..form }), ..action });
        }
        Some(pulsed)
    }

    fn expression(&self, expression: &Expression) -> Result<Expression, Lack> {
        expression.mapped(&mut |contact| self.contact(contact).map_err(|lack| lack.of_contact(contact)))
    }

    fn contact(&self, contact: &Contact) -> Result<Expression, Lack> {
        let (test, terms) = match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => {
                if let Some(value) = bit_of(term) {
                    return match kind {
                        ContactKind::NormallyOpen => Ok(Expression::Constant(value)),
                        ContactKind::NormallyClosed => Ok(Expression::Constant(!value)),
                        _ => Err(Lack::Unnamed),
                    };
                }
                let term = self.bit(term)?;
                single_edge(kind, &term)?;
                (contact.test, vec![term])
            }
            (Test::Compare(operator), [left, right]) => {
                self.counts(operator, [left, right])?;
                let width = self.types.width(&contact.terms);
                let number = |term: &Term| match self.count(term) {
                    Some(count) => Ok(count),
                    None => self.number(term, width),
                };
                let numbers = vec![number(left)?, number(right)?];
                self.types.compared(operator, [left, right])?;
                (Test::Compare(operator.in_width(width == Width::Double)), numbers)
            }
            _ => return Err(Lack::Unnamed),
        };
        Ok(Expression::Contact(Contact { test, terms, span: contact.span }))
    }

    fn bit(&self, term: &Term) -> Result<Term, Lack> {
        self.own_bit(term).map_err(|lack| lack.named(&term.text))
    }

    fn own_bit(&self, term: &Term) -> Result<Term, Lack> {
        use DeviceKind::{C, M, S, T, X, Y};
        if term.operand == Operand::Device(Device::FIRST_SCAN) {
            return Ok(term.clone());
        }
        if let Some((instance, member)) = member(term) {
            let device = without(self.counting(instance).filter(|device| matches!(device.kind, T | C)))?;
            if self.instances.is_called(instance) {
                match device.kind {
                    C => _ = self.instances.preset(instance)?,
                    _ => self.instances.one(instance)?,
                }
            }
            return without(member.eq_ignore_ascii_case("Q").then(|| self.term(device, term.span)));
        }
        let device = without(self.device(term))?;
        without(matches!(device.kind, X | Y | M | S).then(|| self.term(device, term.span)))
    }

    /// A number of 16 or 32 bits, of which ADD and its kin make the same whether it has a sign or not.
    fn number(&self, term: &Term, width: Width) -> Result<Term, Lack> {
        match self.types.of(term) {
            Some(kind) if width_of(kind) != Some(width) => {
                let bits = if width == Width::Double { 32 } else { 16 };
                Err(Lack::Type(term.text.clone(), kind.name(), bits))
            }
            _ => self.own_number(term, width).map_err(|lack| lack.named(&term.text)),
        }
    }

    fn own_number(&self, term: &Term, width: Width) -> Result<Term, Lack> {
        if let Operand::Literal(literal) = term.operand {
            let LiteralValue::Integer(value) = literal.value else { return Err(Lack::Unnamed) };
            let (fits, bits) = match width {
                Width::Double => (i32::try_from(value).map(i64::from), 32),
                _ => (i16::try_from(value).map(i64::from), 16),
            };
            let value = fits.map_err(|_| Lack::Range(term.text.clone(), bits))?;
            return self.constant(value, term.span);
        }
        if width == Width::Double {
            let first = without(self.pair(term))?;
            return match self.registers.is_pair(first.number) {
                true => Ok(self.term(first, term.span)),
                false => Err(Lack::Reason("translate.torn", term.text.clone())),
            };
        }
        if self.count(term).is_some() {
            return Err(Lack::Reason("translate.beyond-preset", term.text.clone()));
        }
        let device = without(self.device(term))?;
        without((device.kind == DeviceKind::D).then(|| self.term(device, term.span)))
    }

    /// The first register of the two that a variable of 32 bits stands for: by its address, or if it has none by its
    /// name.
    fn pair(&self, term: &Term) -> Option<Device> {
        let next = |first: &Device| Device::new(first.kind, first.number + 1);
        let first = match term.storage {
            Storage::Own | Storage::Local if term.operand == Operand::Variable => {
                self.named(&term.text).filter(|first| {
                    first.kind == DeviceKind::D
                        && [*first, next(first)].iter().all(|half| self.names.is_free(*half))
                })
            }
            Storage::Anywhere => None,
            _ => pair_at(term.address()?),
        };
        first.filter(|first| {
            [*first, next(first)].into_iter().all(|half| is_known(half) && !half.is_special())
        })
    }

    /// The device of this name that the target has.
    fn named(&self, name: &str) -> Option<Device> {
        match Operand::read(name, self.target.model) {
            Operand::Device(device) => is_known(device).then_some(device),
            _ => None,
        }
    }

    /// The timer or counter that an instance of this name is, if no other has the name.
    fn counting(&self, instance: &str) -> Option<Device> {
        self.named(instance).filter(|device| self.names.is_free(*device))
    }

    /// The counter whose count a variable is.
    fn count(&self, term: &Term) -> Option<Term> {
        let (instance, member) = member(term)?;
        let device = self.counting(instance).filter(|device| device.kind == DeviceKind::C)?;
        member.eq_ignore_ascii_case("CV").then(|| self.term(device, term.span))
    }

    /// Whether a comparison is the same of a count that stops at its preset, if one of these is a count.
    fn counts(&self, operator: CompareOperator, sides: [&Term; 2]) -> Result<(), Lack> {
        for (operator, count, other) in
            [(operator, sides[0], sides[1]), (turned(operator), sides[1], sides[0])]
        {
            let Some((instance, "cv" | "CV" | "Cv" | "cV")) = member(count) else { continue };
            let preset = self.instances.preset(instance)?;
            match constant(other).filter(|number| is_alike(operator, *number, preset)) {
                Some(_) => {}
                None => return Err(Lack::Reason("translate.beyond-preset", count.text.clone())),
            }
        }
        Ok(())
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

    /// The output that the call of a timer or counter is.
    fn called(&self, call: &Call, instance: &Term, terms: &[Term]) -> Result<(Deed, Vec<Term>), Lack> {
        let device = without(self.counting(&instance.text))?;
        let own = self.term(device, instance.span);
        let arguments = call.arguments(terms);
        let block = without((!call.block.is_declared()).then(|| call.block.name()))?;
        match (block, device.kind, call.power_in(), &arguments[..]) {
            ("CTU", DeviceKind::C, "R", []) if device.number < 200 => {
                self.instances.preset(&instance.text)?;
                Ok((Deed::Coil(CoilKind::Reset), vec![own]))
            }
            ("CTU", DeviceKind::C, "CU", [preset]) if preset.name == "PV" && device.number < 200 => {
                let number = self.instances.preset(&instance.text)?;
                Ok((Deed::Coil(CoilKind::Plain), vec![own, self.constant(number, preset.term.span)?]))
            }
            ("TON", DeviceKind::T, "IN", [preset]) if preset.name == "PT" => {
                self.instances.one(&instance.text)?;
                let range = without(device.range_on(self.target).filter(|range| !range.latched))?;
                let Operand::Literal(literal) = preset.term.operand else {
                    return Err(Lack::Unnamed);
                };
                let LiteralValue::Time(time) = literal.value else { return Err(Lack::Unnamed) };
                if time == 0 {
                    return Err(Lack::Reason("translate.zero-time", instance.text.clone()));
                }
                let unit = i64::from(range.timer_unit_ms) * 1_000_000;
                let steps = without((unit > 0 && time % unit == 0).then(|| time / unit))?;
                let steps = without((1..=i64::from(i16::MAX)).contains(&steps).then_some(steps))?;
                Ok((Deed::Coil(CoilKind::Plain), vec![own, self.constant(steps, preset.term.span)?]))
            }
            _ => Err(Lack::Unnamed),
        }
    }
}

impl Types<'_> {
    /// The elementary type of a variable that is declared, or of an address.
    fn of(&self, term: &Term) -> Option<ElementaryType> {
        match term.operand {
            Operand::Direct(address) => match address.width {
                Width::Word => Some(ElementaryType::Word),
                Width::Double => Some(ElementaryType::Dword),
                _ => None,
            },
            Operand::Variable => match self.scopes.type_of(self.pou, &term.text)? {
                DeclaredType::Elementary(kind) => Some(kind),
                _ => None,
            },
            _ => None,
        }
    }

    /// In how many bits these are calculated with or compared.
    fn width(&self, terms: &[Term]) -> Width {
        let is_wide = |term: &Term| self.of(term).and_then(width_of) == Some(Width::Double);
        if terms.iter().any(is_wide) { Width::Double } else { Width::Word }
    }

    /// Whether numbers are of the types that lie at their addresses on the FX family.
    fn fit(&self, terms: &[Term]) -> bool {
        terms.iter().all(|term| match (term.address(), self.of(term)) {
            (Some(address), Some(kind)) => width_of(kind) == Some(address.width),
            _ => true,
        })
    }

    /// Whether a calculation makes of numbers what an instruction makes of them, however they are declared.
    fn calculates(&self, action: &Action) -> bool {
        let Deed::Compute(computation) = &action.deed else { return true };
        let Some((inputs, result)) = computation.operands(&action.terms) else { return false };
        let is_signed = || inputs.iter().all(|term| self.signed(term));
        match computation.standard() {
            Some("MUL") if computation.widens() => is_signed() && self.fit(std::slice::from_ref(result)),
            Some("DIV" | "MOD") => is_signed() && self.fit(&action.terms),
            _ => self.fit(&action.terms),
        }
    }

    /// Whether a number has a sign, as far as it is declared.
    fn signed(&self, term: &Term) -> bool {
        use ElementaryType::{Dint, Int};
        self.of(term).is_none_or(|kind| matches!(kind, Int | Dint))
    }

    /// Whether two words compare as the FX family does it: with a sign, which counts but for equality of patterns.
    fn compared(&self, operator: CompareOperator, sides: [&Term; 2]) -> Result<(), Lack> {
        use CompareOperator::{Equal, NotEqual};
        let types = sides.map(|term| self.of(term));
        let unsigned = types.iter().zip(sides).find_map(|(kind, term)| {
            let kind = kind.filter(|_| !self.signed(term))?;
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
}

/// The size of the whole numbers and patterns that the FX family calculates with.
fn width_of(kind: ElementaryType) -> Option<Width> {
    use ElementaryType::{Dint, Dword, Int, Udint, Uint, Word};
    match kind {
        Int | Uint | Word => Some(Width::Word),
        Dint | Udint | Dword => Some(Width::Double),
        _ => None,
    }
}
