//! What stands under the pointer.

use super::names::{self, Named, Thing};
use super::{Hover, declared, devices, implicit, pages, uses};
use crate::document::{Chunk, Document, Operation, ProjectView, Symbol, Tree};
use crate::il::fx::{FxTree, LineKind};
use crate::il::iec::{IecTree, ItemKind};
use crate::ladder::{Element, ElementKind, LadderTree};
use crate::target::iec::{Function, FunctionBlock, LiteralValue, Operator};
use crate::target::{Constant, Device, DirectAddress, Location, Operand, Width};
use crate::text::{Language, Message, Span, Spanned, phrase};

mod boolean;

mod element;

/// So many writers and readers are listed.
const SHOWN: usize = 8;

/// `link` gives the address of a line (from 0) of a file, for readers that can follow one.
pub(super) fn at(
    around: &ProjectView<'_>,
    offset: usize,
    language: Language,
    link: &dyn Fn(usize, u32) -> Option<String>,
) -> Option<Hover> {
    let document = around.here();
    let found = document.chunk_at(offset)?;
    let chunk = found.chunk;
    let view = View { around, document, chunk, start: found.start, offset, language, link };
    let inside = offset.checked_sub(found.start)?;
    let (span, markdown) = match found.chunk.tree() {
        Tree::Fx(tree) => view.fx(tree, inside),
        Tree::Ladder(tree) => view.ladder(tree, inside),
        Tree::Iec(tree) => view.iec(tree, inside),
    }?;
    let equation = boolean::of_output(chunk, inside, document.target(), language);
    let markdown = equation.into_iter().chain([markdown]).collect::<Vec<_>>().join("\n\n");
    Some(Hover { span: span.shifted(found.start), markdown })
}

/// The place of which one asks; spans that it answers are those of the chunk.
struct View<'d> {
    around: &'d ProjectView<'d>,
    document: &'d Document,
    chunk: &'d Chunk,
    start: usize,
    offset: usize,
    language: Language,
    link: &'d dyn Fn(usize, u32) -> Option<String>,
}

type Answer = Option<(Span, String)>;

impl View<'_> {
    fn fx(&self, tree: &FxTree, inside: usize) -> Answer {
        let line = tree.line_at(inside)?;
        if line.mnemonic.touches(inside) {
            return match line.kind {
                LineKind::Instruction(form) => {
                    Some((line.mnemonic, pages::instruction_page(form, self.language)))
                }
                LineKind::Label(_) => self.name(line.mnemonic),
                LineKind::Unknown => None,
            };
        }
        let (_, index) = tree.operand_at(inside)?;
        let operand = tree.operands.get(index)?;
        let operation = self.chunk.operations().find(|operation| operation.symbol == line.mnemonic);
        self.operand(operand, operation.as_ref())
    }

    fn ladder(&self, tree: &LadderTree, inside: usize) -> Answer {
        let rungs = tree.rungs.iter().filter(|rung| rung.span.touches(inside));
        for element in rungs.flat_map(|rung| &rung.graph.elements) {
            if let Some(operand) = element.operands.iter().find(|operand| operand.span.touches(inside)) {
                let operation = self
                    .chunk
                    .operations()
                    .find(|operation| std::ptr::eq(operation.operands.as_ptr(), element.operands.as_ptr()));
                return self.operand(operand, operation.as_ref());
            }
            if let Some(answer) = self.element(element, inside) {
                return Some(answer);
            }
        }
        self.name(Span::at(inside))
    }

    /// The symbol of an element, or a word that belongs to it.
    fn element(&self, element: &Element, inside: usize) -> Answer {
        match &element.kind {
            ElementKind::Instruction { form, mnemonic } if element.span.touches(inside) => {
                let span = if mnemonic.touches(inside) { *mnemonic } else { element.span };
                form.map(|form| (span, pages::instruction_page(form, self.language)))
            }
            ElementKind::Block(block) => {
                let named = [block.instance, block.type_name].into_iter().flatten();
                if let Some(span) = named.into_iter().find(|span| span.touches(inside)) {
                    return self.name(span);
                }
                let row = *block.rows.iter().find(|row| row.touches(inside))?;
                let page = self.pou_page(block.type_text(self.chunk.text())?)?;
                Some((row, page))
            }
            _ if element.span.touches(inside) => {
                let mut text = element::describe(element, self.chunk.text(), self.language)?;
                if let Some(operand) = element.operands.first()
                    && let Some(named) = names::at(self.document, self.start + operand.span.start as usize)
                {
                    text += &format!("\n\n{}", self.thing(&named));
                }
                Some((element.span, text))
            }
            _ => None,
        }
    }

    fn iec(&self, tree: &IecTree, inside: usize) -> Answer {
        for item in tree.items.iter().filter(|item| item.span.touches(inside)) {
            let (word, page) = match item.kind {
                ItemKind::Operation { operation, .. } | ItemKind::Open { operation, .. } => {
                    (operation.word, Some(pages::operator_page(operation.operator, self.language)))
                }
                ItemKind::Jump { word, .. } => (word, operator_page("JMP", self.language)),
                ItemKind::Return { word, .. } => (word, operator_page("RET", self.language)),
                ItemKind::Call { word, .. } => (word, operator_page("CAL", self.language)),
                ItemKind::Function { name, .. } => (name, self.pou_page(name.of(self.chunk.text()))),
                ItemKind::InputOperator { input, instance } => {
                    (input, self.input_operator(input.of(self.chunk.text()), tree.operand(instance).span))
                }
                _ => continue,
            };
            if let (true, Some(page)) = (word.touches(inside), page) {
                return Some((word, page));
            }
        }
        if let Some(answer) = self.name(Span::at(inside)) {
            return Some(answer);
        }
        let operand = tree.operands.iter().find(|operand| operand.span.touches(inside))?;
        self.operand(operand, None)
    }

    /// The page of the block whose input is set by an input operator.
    fn input_operator(&self, input: &str, instance: Span) -> Option<String> {
        let pou = names::pou_at(self.document, self.start);
        let declared = self.document.scopes().type_of(pou, instance.of(self.chunk.text()));
        let blocks = FunctionBlock::with_input_operator(input);
        let block = match declared {
            Some(crate::document::DeclaredType::Named(name)) => FunctionBlock::named(&name),
            _ => blocks.into_iter().next(),
        }?;
        Some(pages::block_page(block, self.language))
    }

    fn operand(&self, operand: &Spanned<Operand>, operation: Option<&Operation<'_>>) -> Answer {
        let word = operand.span.of(self.chunk.text());
        match operand.value {
            Operand::Constant { value, .. } => {
                let driven = operation.filter(|operation| devices::is_preset(operation));
                let driven = driven.and_then(|operation| operation.operands.first()?.value.device());
                Some((operand.span, self.constant(word, value, driven)))
            }
            Operand::Literal(literal) => Some((operand.span, self.literal(word, literal.value)?)),
            Operand::Variable => self.member(operand.span).or_else(|| self.name(operand.span)),
            Operand::Text | Operand::Invalid(_) => None,
            _ => {
                let (span, mut text) = self.name(operand.span)?;
                if let Operand::WordBit { word, bit } = operand.value {
                    let message = Message::new("hover.word-bit").with("word", word).with("bit", bit);
                    text = format!("{}\n\n{text}", message.render(self.language));
                }
                if let Operand::Indexed { device, index } = operand.value {
                    let message = Message::new("hover.indexed").with("device", device).with("index", index);
                    text = format!("{}\n\n{text}", message.render(self.language));
                }
                Some((span, text))
            }
        }
    }

    /// A constant in both notations, and in seconds where it is the preset of a timer.
    fn constant(&self, word: &str, value: Constant, driven: Option<Device>) -> String {
        let target = self.document.target();
        let count = devices::integer(value);
        let timed = driven.zip(count).and_then(|(device, count)| {
            let time = devices::timer_time(device, count, target)?;
            let unit = devices::timer_unit(device, target)?;
            Some(Message::new("hover.constant-time").with("unit", unit).with("time", time))
        });
        let message = match (timed, value, count) {
            (Some(message), _, _) => message,
            (None, Constant::Real(value), _) => {
                return format!("`{word}` = {value}");
            }
            (None, Constant::Hexadecimal(_), Some(count)) => {
                Message::new("hover.constant").with("value", format!("K{count}"))
            }
            (None, _, Some(count)) => Message::new("hover.constant").with("value", hexadecimal(count)),
            (None, _, None) => return format!("`{word}`"),
        };
        message.with("word", word).render(self.language)
    }

    fn literal(&self, word: &str, value: LiteralValue) -> Option<String> {
        let message = match value {
            LiteralValue::Integer(value) => {
                let is_decimal =
                    word.rsplit_once('#').is_none_or(|(prefix, _)| !prefix.ends_with(['2', '8', '6']));
                let sign = if value < 0 { "-" } else { "" };
                let hexadecimal = format!("{sign}16#{:X}", value.unsigned_abs());
                let other = if is_decimal { hexadecimal } else { value.to_string() };
                Message::new("hover.constant").with("value", other)
            }
            LiteralValue::Time(nanoseconds) => {
                let milliseconds = nanoseconds.unsigned_abs() / 1_000_000;
                let sign = if nanoseconds < 0 { "-" } else { "" };
                Message::new("hover.literal-time")
                    .with("time", format!("{sign}{}", devices::duration(milliseconds)))
            }
            _ => return None,
        };
        Some(message.with("word", word).render(self.language))
    }

    /// `T1.Q` under the pointer on `Q`.
    fn member(&self, path: Span) -> Answer {
        let text = path.of(self.chunk.text());
        let inside = self.offset.checked_sub(self.start + path.start as usize)?;
        let first = text.find('.')?;
        if inside <= first {
            return None;
        }
        let end = text.get(inside..)?.find(['.', '[']).map_or(text.len(), |end| inside + end);
        let prefix = text.get(..end)?;
        let pou = names::pou_at(self.document, self.start);
        let scopes = self.document.scopes();
        let declared = scopes.type_of(pou, prefix)?;
        let message = Message::new("hover.member").with("path", prefix);
        let mut words = message.with("kind", declared::type_name(&declared, scopes)).render(self.language);
        let (owner, member) = prefix.rsplit_once('.')?;
        if let Some(crate::document::DeclaredType::Named(name)) = scopes.type_of(pou, owner)
            && let Some(block) = FunctionBlock::named(&name)
            && let Some(pin) = block.input_named(member).or_else(|| block.output_named(member))
        {
            words += &format!("\n\n{}", phrase(pin.meaning, self.language));
        }
        Some((Span::new(path.start as usize, path.start as usize + end), words))
    }

    /// The name at the pointer; `around` is its operand, which is asked where the pointer misses the name (`K4` of
    /// `K4M0`).
    fn name(&self, around: Span) -> Answer {
        let named = names::at(self.document, self.offset).or_else(|| {
            let mentions = self.chunk.mentions().iter();
            let inner =
                mentions.filter(|mention| around.start <= mention.span.start && !mention.span.is_empty());
            let mention =
                inner.filter(|mention| mention.span.end <= around.end).min_by_key(|mention| mention.span)?;
            names::at(self.document, self.start + mention.span.start as usize)
        })?;
        let start = self.start as u32;
        let span = Span { start: named.span.start - start, end: named.span.end - start };
        Some((span, self.thing(&named)))
    }

    fn thing(&self, named: &Named<'_>) -> String {
        let word = self.document.slice(named.span);
        let language = self.language;
        let head = match &named.thing {
            Thing::Devices(device, count) => self.device(*device, *count),
            Thing::Direct(address) => direct(&word, *address, language),
            Thing::Label { .. } => Message::new("hover.label").with("name", &word).render(language),
            Thing::Connector { .. } => Message::new("hover.connector").with("name", &word).render(language),
            Thing::Variable { .. } => match declared::source(self.document, &named.thing) {
                Some(source) => format!("```iec\n{source}\n```"),
                None => self.undeclared(&named.thing, &word),
            },
            Thing::Pou(name) => self.pou_page(name).unwrap_or_else(|| format!("**{word}**")),
            Thing::Type(_) => match declared::source(self.document, &named.thing) {
                Some(source) => format!("```iec\n{source}\n```"),
                None => Message::new("hover.type-plain").with("name", &word).render(language),
            },
        };
        let uses = uses::collect(self.around, &named.thing, SHOWN);
        let preset = match (&named.thing, &uses.preset) {
            (Thing::Devices(device, _), Some((value, word))) => self.preset(*device, *value, word),
            _ => String::new(),
        };
        let style = uses::Style { view: self.around, language, link: self.link };
        let parts = [head, self.comment(&named.thing, &word), preset, uses.markdown(&named.thing, &style)];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n\n")
    }

    fn undeclared(&self, thing: &Thing, word: &str) -> String {
        let message = match implicit::type_of(self.document, thing) {
            Some(Some(kind)) => Message::new("hover.implicit").with("kind", kind),
            Some(None) => Message::new("hover.implicit-open"),
            None => Message::new("hover.undeclared"),
        };
        message.with("name", word).render(self.language)
    }

    /// The project's comment on a device or address, also on that of a variable, and its symbol; `word` is what the
    /// program writes.
    fn comment(&self, thing: &Thing, word: &str) -> String {
        let comments = self.document.comments();
        let row = match thing {
            Thing::Devices(device, _) => comments.of_device(*device),
            Thing::Direct(address) => comments.of(&Symbol::Direct(*address)),
            Thing::Variable { pou, name } => {
                let declared = self.document.scopes().variable(*pou, name);
                declared.and_then(|variable| variable.address).and_then(|at| comments.of(&Symbol::Direct(at)))
            }
            _ => None,
        };
        let Some(row) = row else { return String::new() };
        let symbol = match (&row.thing, row.symbol.as_str()) {
            (_, "") => String::new(),
            (Symbol::Device(device), symbol) if symbol.eq_ignore_ascii_case(word) => {
                Message::new("uses.symbol-of")
                    .with("symbol", symbol)
                    .with("device", device)
                    .render(self.language)
            }
            (_, symbol) => Message::new("uses.symbol").with("symbol", symbol).render(self.language),
        };
        let parts = [symbol.as_str(), row.comment.as_str()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" — ")
    }

    fn device(&self, device: Device, count: u16) -> String {
        let mut text = devices::describe(device, self.document, self.language);
        if count > 1 {
            let last = Device::new(device.kind, device.number.saturating_add(u32::from(count) - 1));
            let word = format!("{device} × {count}");
            let message =
                Message::new("hover.covers").with("word", word).with("first", device).with("last", last);
            text += &format!("\n\n{}", message.render(self.language));
        }
        text
    }

    fn preset(&self, device: Device, operand: Operand, word: &str) -> String {
        let target = self.document.target();
        let message = match (operand, devices::timer_unit(device, target)) {
            (Operand::Constant { value, index: None }, Some(_)) => {
                let time =
                    devices::integer(value).and_then(|count| devices::timer_time(device, count, target));
                Message::new("hover.preset").with("time", time.unwrap_or_else(|| "?".to_string()))
            }
            (_, Some(unit)) => Message::new("hover.preset-register").with("unit", unit),
            (_, None) => Message::new("hover.preset-count"),
        };
        message.with("preset", word).render(self.language)
    }

    /// The page of a function or function block, or the parameters of a declared one.
    fn pou_page(&self, name: &str) -> Option<String> {
        let scopes = self.document.scopes();
        if let Some(pou) = scopes.pou_named(name) {
            let mut text = format!("{} {}", declared::pou_keyword(pou.kind), pou.name);
            if let Some(result) = &pou.result {
                text += &format!(" : {}", declared::type_name(result, scopes));
            }
            for variable in pou.variables.iter().filter(|variable| variable.section.is_parameter()) {
                let kind = declared::type_name(&variable.declared, scopes);
                let section = declared::section_keyword(variable.section);
                text += &format!("\n{section} {} : {kind}", variable.name);
            }
            return Some(format!("```iec\n{text}\n```"));
        }
        let function = Function::named(name).map(|function| pages::function_page(function, self.language));
        function
            .or_else(|| FunctionBlock::named(name).map(|block| pages::block_page(block, self.language)))
            .or_else(|| operator_page(name, self.language))
    }
}

fn operator_page(name: &str, language: Language) -> Option<String> {
    Operator::named(name).map(|operator| pages::operator_page(operator, language))
}

/// In the width in which an FX register holds it.
fn hexadecimal(value: i64) -> String {
    match (i16::try_from(value), i32::try_from(value)) {
        (Ok(word), _) => format!("H{:X}", word as u16),
        (_, Ok(double)) => format!("H{:X}", double as u32),
        _ => format!("H{value:X}"),
    }
}

fn direct(word: &str, address: DirectAddress, language: Language) -> String {
    let message = match address.location {
        Location::Input => Message::new("hover.direct-input"),
        Location::Output => Message::new("hover.direct-output"),
        Location::Memory => Message::new("hover.direct-memory"),
    };
    let bits = match address.width {
        Width::Bit => 1,
        Width::Byte => 8,
        Width::Word => 16,
        Width::Double => 32,
        Width::Long => 64,
    };
    message.with("name", word).with("bits", bits).render(language)
}
