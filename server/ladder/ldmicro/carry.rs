//! Carries elements of LDmicro over to IEC 61131-3, one by one, and says what gets lost.

use super::meaning::{BoxKind, Form, duration, time_literal};
use super::names::{Names, number};
use super::native::Note;
use crate::ladder::{
    Block, CoilKind, CompareOperator, ContactKind, Element, ElementKind, Graph, OperandPlace, Pin, PinWire,
};
use crate::target::{Model, Operand};
use crate::text::{Message, Span, Spanned};

/// What all elements of a program share.
#[derive(Debug, Default)]
pub(super) struct Carrier {
    /// The words of the elements, which their spans name.
    pub words: String,
    pub names: Names,
    pub notes: Vec<Note>,
    /// The line of the source that is carried over.
    pub line: u32,
    /// How many elements there are: the place of each in the order of the program.
    count: u32,
}

impl Carrier {
    pub fn note(&mut self, message: Message) {
        let note = Note { line: self.line, message };
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    pub fn contact(&mut self, kind: ContactKind, name: &str) -> Element {
        let name = self.name(name);
        self.element(ElementKind::Contact(kind), &[name])
    }

    /// A contact that is never on.
    pub fn never(&mut self) -> Element {
        self.element(ElementKind::Contact(ContactKind::NormallyOpen), &["FALSE".to_string()])
    }

    pub fn coil(&mut self, kind: CoilKind, name: &str) -> Element {
        if kind == CoilKind::Toggle {
            self.note(Message::new("import.toggle").with("name", name));
        }
        let name = self.name(name);
        self.element(ElementKind::Coil(kind), &[name])
    }

    pub fn compare(&mut self, operator: CompareOperator, left: &str, right: &str) -> Element {
        let operands = [self.value(left), self.value(right)];
        self.element(ElementKind::Compare(operator), &operands)
    }

    pub fn jump(&mut self, label: &str) -> Element {
        let label = self.label(label);
        let kind = ElementKind::Jump(self.word(&label));
        self.element(kind, &[])
    }

    pub fn leave(&mut self) -> Element {
        self.element(ElementKind::Return, &[])
    }

    /// A label as an identifier; LDmicro also counts rungs to jump to.
    pub fn label(&mut self, label: &str) -> String {
        if number(label).is_some() {
            self.note(Message::new("import.label-number").with("label", label));
            return format!("Rung_{}", label.trim_start_matches(['+', '-']));
        }
        let number = self.names.label(label);
        self.names.get(number).identifier.clone()
    }

    /// `{RES}`: sets a timer or counter back, and any other variable to 0.
    pub fn reset(&mut self, name: &str) -> Element {
        self.coil(CoilKind::Reset, name)
    }

    /// A block or function. `reads` are its values in the order of the pins of `kind`.
    pub fn block(
        &mut self,
        kind: &'static BoxKind,
        instance: &str,
        reads: &[String],
        writes: Option<&str>,
        falling: bool,
    ) -> Element {
        let type_name = if kind.standard { kind.type_name.to_string() } else { own_type(kind.type_name) };
        if !kind.standard {
            self.note(Message::new("import.no-counterpart").with("word", kind.word).with("type", &type_name));
        }
        let instance = kind.has_instance().then(|| {
            let number = match instance {
                "" => self.names.instance(kind.word, &type_name),
                name => self.names.of(name),
            };
            let name = self.names.get_mut(number);
            name.declared = type_name.clone();
            name.identifier.clone()
        });
        let mut inputs = vec![(kind.power_in, String::new())];
        for (pin, value) in kind.reads.iter().zip(reads) {
            match *pin {
                // The standard's counters start at 0, as most do here.
                "INIT" if kind.standard => {
                    if value != "0" {
                        let message = Message::new("import.start-value").with("value", value);
                        self.note(message.with("name", instance.as_deref().unwrap_or("")));
                    }
                }
                "PT" => inputs.push((pin, self.time(value))),
                _ => inputs.push((pin, self.value(value))),
            }
        }
        let mut outputs = vec![(kind.power_out, String::new())];
        outputs.extend(writes.map(|name| ("OUT", self.value(name))));
        let element = self.figure(&type_name, instance, &inputs, &outputs);
        self.with_signs(element, falling, kind.negated)
    }

    /// A word that the table does not have: a box of that name with its values.
    pub fn unknown(&mut self, word: &str, values: &[String]) -> Element {
        let type_name = own_type(word);
        self.note(Message::new("import.no-counterpart").with("word", word).with("type", &type_name));
        let mut inputs = vec![("EN", String::new())];
        const PINS: [&str; 10] = ["IN1", "IN2", "IN3", "IN4", "IN5", "IN6", "IN7", "IN8", "IN9", "IN10"];
        let values: Vec<String> = values.iter().map(|value| self.value(value)).collect();
        inputs.extend(PINS.into_iter().zip(values));
        self.figure(&type_name, None, &inputs, &[("ENO", String::new())])
    }

    /// The element as an export drew it. Words stand in `chunk`.
    pub fn drawn(&mut self, element: &Element, chunk: &str) -> Element {
        let word = |index: usize| element.operand_text(index, chunk).into_owned();
        match &element.kind {
            ElementKind::Contact(_) if word(0) == "FALSE" => self.never(),
            ElementKind::Contact(kind) => self.contact(*kind, &word(0)),
            ElementKind::Coil(kind) => self.coil(*kind, &word(0)),
            ElementKind::Compare(operator) => self.compare(*operator, &word(0), &word(1)),
            ElementKind::Jump(label) => self.jump(label.of(chunk)),
            ElementKind::Return => self.leave(),
            ElementKind::Invert => self.element(ElementKind::Invert, &[]),
            ElementKind::Block(block) => {
                let values = |pins: &[Pin]| {
                    let value = |pin: &Pin| match pin.wire {
                        PinWire::Operand(index) => Some(word(index)),
                        _ => None,
                    };
                    pins.iter().filter_map(value).collect::<Vec<String>>()
                };
                let (reads, writes) = (values(&block.inputs), values(&block.outputs));
                let instance = block.instance.map_or("", |name| name.of(chunk));
                let falling = block.inputs.first().is_some_and(|pin| pin.negated);
                match block.ldmicro {
                    Some(kind) => {
                        self.block(kind, instance, &reads, writes.first().map(String::as_str), falling)
                    }
                    None => self.unknown(block.type_text(chunk).unwrap_or("BOX"), &reads),
                }
            }
            ElementKind::Instruction { mnemonic, .. } => {
                let values: Vec<String> = (0..element.operands.len()).map(word).collect();
                self.unknown(mnemonic.of(chunk), &values)
            }
            ElementKind::ConnectorOut(name) | ElementKind::ConnectorIn(name) => {
                self.unknown(name.of(chunk), &[])
            }
        }
    }

    fn name(&mut self, original: &str) -> String {
        if original.is_empty() {
            // Elements without a name are not the same variable.
            let number = self.names.instance("v", "BOOL");
            let identifier = self.names.get(number).identifier.clone();
            self.note(Message::new("import.unnamed").with("new", &identifier));
            return identifier;
        }
        let number = self.names.of(original);
        let name = self.names.get(number);
        let identifier = name.identifier.clone();
        if original != identifier {
            self.note(Message::new("import.renamed").with("name", original).with("new", &identifier));
        }
        identifier
    }

    /// A number or a variable; the name of a counter stands for its count, which is found later.
    fn value(&mut self, word: &str) -> String {
        number(word).unwrap_or_else(|| self.name(word))
    }

    /// A literal, or a number of microseconds, or the name of a variable, which LDmicro takes for a delay as well.
    fn time(&mut self, word: &str) -> String {
        if word.starts_with("T#") {
            return word.to_string();
        }
        if let Some(literal) = time_literal(word) {
            return literal;
        }
        if let Some(microseconds) = number(word).and_then(|digits| digits.parse().ok()) {
            return duration(microseconds);
        }
        self.note(Message::new("import.variable-delay").with("name", word));
        self.name(word)
    }

    fn figure(
        &mut self,
        type_name: &str,
        instance: Option<String>,
        inputs: &[(&str, String)],
        outputs: &[(&str, String)],
    ) -> Element {
        let instance = instance.map(|name| self.word(&name));
        let type_name = Some(self.word(type_name));
        let mut operands = Vec::new();
        let mut pins = |side: &[(&str, String)], carrier: &mut Carrier| {
            let pin = |(pin, value): &(&str, String)| {
                let wire = match value.is_empty() {
                    true => PinWire::Power,
                    false => {
                        operands.push(value.clone());
                        PinWire::Operand(operands.len() - 1)
                    }
                };
                let name = Some(carrier.word(pin));
                Pin { name, implied: "", negated: false, row: 0, wire }
            };
            side.iter().map(pin).collect::<Vec<Pin>>()
        };
        let (inputs, outputs) = (pins(inputs, self), pins(outputs, self));
        let block = Block { instance, type_name, rows: Vec::new(), inputs, outputs, ldmicro: None };
        self.element(ElementKind::Block(Box::new(block)), &operands)
    }

    fn with_signs(&self, mut element: Element, falling: bool, negated: bool) -> Element {
        if let ElementKind::Block(block) = &mut element.kind {
            if let Some(pin) = block.inputs.first_mut() {
                pin.negated = falling;
            }
            if let Some(pin) = block.outputs.first_mut() {
                pin.negated = negated;
            }
        }
        element
    }

    fn element(&mut self, kind: ElementKind, operands: &[String]) -> Element {
        self.count += 1;
        let mut element = Element::new(kind, Span::at(0), self.count, (0, 1));
        element.place = OperandPlace::Beside;
        for operand in operands {
            let span = self.word(operand);
            element.operands.push(Spanned::new(Operand::read(operand, Model::Iec), span));
        }
        element
    }

    fn word(&mut self, word: &str) -> Span {
        let start = self.words.len();
        self.words.push_str(word);
        let span = Span::new(start, self.words.len());
        self.words.push(' ');
        span
    }
}

/// The name of the block that a user has to write: `LDMICRO_RTO`.
fn own_type(word: &str) -> String {
    let mut name = "LDMICRO".to_string();
    for part in word.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty()) {
        name.push('_');
        name.push_str(&part.to_ascii_uppercase());
    }
    name
}

/// `C1` where it stands for the count of the counter `C1`: `C1.CV`.
pub(super) fn name_counts(graph: &mut Graph, carrier: &mut Carrier) {
    for element in &mut graph.elements {
        if !matches!(element.kind, ElementKind::Compare(_) | ElementKind::Block(_)) {
            continue;
        }
        for operand in &mut element.operands {
            let word = operand.span.of(&carrier.words).to_string();
            let declared = carrier.names.all().find(|name| name.identifier == word);
            let member = match declared.map(|name| name.declared.as_str()) {
                Some("INT" | "BOOL" | "") | None => continue,
                Some("TON" | "TOF") => "ET",
                Some(_) => "CV",
            };
            if member == "ET" {
                carrier.note(Message::new("import.elapsed").with("name", &word));
            }
            let word = format!("{word}.{member}");
            operand.span = carrier.word(&word);
            operand.value = Operand::read(&word, Model::Iec);
        }
    }
}

/// Whether a kind with this form is drawn as an end of the rung's power line.
pub(super) fn leaf(carrier: &mut Carrier, words: &[String]) -> Option<Element> {
    let word = |index: usize| words.get(index).map_or("", String::as_str);
    let flag = |index: usize| word(index) == "1";
    let compare = |operator| (operator, word(1).to_string(), word(2).to_string());
    let compared = match word(0) {
        "EQU" => Some(compare(CompareOperator::Equal { wide: false })),
        "NEQ" => Some(compare(CompareOperator::NotEqual { wide: false })),
        "GRT" => Some(compare(CompareOperator::Greater { wide: false })),
        "GEQ" => Some(compare(CompareOperator::GreaterOrEqual { wide: false })),
        "LES" => Some(compare(CompareOperator::Less { wide: false })),
        "LEQ" => Some(compare(CompareOperator::LessOrEqual { wide: false })),
        _ => None,
    };
    if let Some((operator, left, right)) =
        compared.filter(|(_, left, right)| !left.is_empty() && !right.is_empty())
    {
        return Some(carrier.compare(operator, &left, &right));
    }
    match (word(0), words.len()) {
        ("CONTACTS", 2..) => {
            let kind = if flag(2) { ContactKind::NormallyClosed } else { ContactKind::NormallyOpen };
            return Some(carrier.contact(kind, word(1)));
        }
        ("COIL", 2..) => {
            let kind = match (flag(2), flag(3), flag(4), flag(5)) {
                (true, ..) => CoilKind::Negated,
                (_, true, ..) => CoilKind::Set,
                (_, _, true, _) => CoilKind::Reset,
                (_, _, _, true) => CoilKind::Toggle,
                _ => CoilKind::Plain,
            };
            return Some(carrier.coil(kind, word(1)));
        }
        ("RES", 2..) => return Some(carrier.reset(word(1))),
        ("GOTO", 2..) => return Some(carrier.jump(word(1))),
        ("RETURN", _) => return Some(carrier.leave()),
        ("OPEN", _) => return Some(carrier.never()),
        ("SHORT" | "PLACEHOLDER", _) => return None,
        _ => {}
    }
    Some(block_of_leaf(carrier, words))
}

fn block_of_leaf(carrier: &mut Carrier, words: &[String]) -> Element {
    let word = words.first().map_or("", String::as_str);
    let spelled = match word {
        "MOVE" => "MOV".to_string(),
        "RANDOM" => "RAND".to_string(),
        "SHIFT_REGISTER" => "SHIFT REG".to_string(),
        "SET_PWM" => "PWM".to_string(),
        "MASTER_RELAY" => "MASTER RLY".to_string(),
        word => word.replace('_', " "),
    };
    let values = words.get(1..).unwrap_or(&[]);
    let Some(kind) = BoxKind::named(&spelled) else { return carrier.unknown(word, values) };
    let instance = values.first().map_or("", String::as_str);
    let rest = values.get(1..).unwrap_or(&[]);
    match kind.form {
        Form::Timer if !rest.is_empty() => {
            if rest.get(1).is_some_and(|adjust| adjust != "0" && adjust != "-1") {
                carrier.note(Message::new("import.adjust").with("name", instance));
            }
            carrier.block(kind, instance, &rest[..1], None, false)
        }
        Form::Counter if !rest.is_empty() => {
            let falling = rest.get(2).is_some_and(|edge| edge == "\\");
            if rest.get(2).is_some_and(|edge| edge != "\\" && edge != "/") {
                carrier.note(Message::new("import.level-counter").with("name", instance));
            }
            carrier.block(kind, instance, rest.get(..2).unwrap_or(&rest[..1]), None, falling)
        }
        Form::Wave => carrier.block(kind, "", &[], None, false),
        Form::Assignment if rest.len() >= kind.reads.len() => {
            carrier.block(kind, "", &rest[..kind.reads.len()], Some(instance), false)
        }
        Form::Command if kind.writes.is_empty() => carrier.block(kind, "", values, None, false),
        Form::Command if !instance.is_empty() => carrier.block(kind, "", &[], Some(instance), false),
        _ => carrier.unknown(word, values),
    }
}
