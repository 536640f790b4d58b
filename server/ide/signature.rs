//! Signature help: the operands of the instruction, or the parameters of the call, in which the cursor stands.

use super::{declared, names, pages};
use crate::document::{DeclaredType, Document, Notation, Tree};
use crate::il::iec::{PouKind, SectionKind};
use crate::target::iec::{Function, FunctionBlock, Operator, Parameter};
use crate::target::{Accepts, Access, Form, Opcode, Operand};
use crate::text::{Language, Message, Span, phrase};

/// The shape of an instruction or a call.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Signature {
    /// `MOV S D`, `LIMIT(MN : ANY, IN : ANY, MX : ANY) : ANY`.
    pub label: String,
    /// What it does.
    pub documentation: String,
    /// Its operands in order.
    pub parameters: Vec<SignatureParameter>,
    /// The number of the operand in which the cursor stands; `None` behind the last one.
    pub active: Option<usize>,
}

/// One operand of a signature.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SignatureParameter {
    /// Bytes of the label.
    pub span: Span,
    /// What it means and takes.
    pub documentation: String,
}

/// Behind a name; longer lists of parameters are not searched.
const REACH: usize = 16_000;

pub(super) fn at(document: &Document, offset: usize, language: Language) -> Option<Signature> {
    let offset = offset.min(document.len());
    let chunk = document.chunk_at(offset)?;
    let is_declared = matches!(chunk.chunk.tree(), Tree::Iec(_));
    match document.notation() {
        Notation::FxIl => instruction(document, offset, language),
        Notation::Ladder if !is_declared => drawn(document, offset, language),
        Notation::Ladder | Notation::IecIl => call(document, offset, language),
    }
}

/// The text of the line up to `offset`, comments excluded.
fn head_of(document: &Document, offset: usize) -> Option<String> {
    let (_, start, mut line) = document.line_at(offset);
    line.truncate(offset - start);
    let found = document.chunk_at(offset)?;
    let comments = found.chunk.tree().comments();
    let inside = (offset - found.start) as u32;
    let in_comment = comments.iter().any(|comment| comment.start < inside && inside <= comment.end);
    (!in_comment).then_some(line)
}

fn instruction(document: &Document, offset: usize, language: Language) -> Option<Signature> {
    let head = head_of(document, offset)?;
    let mut words: Vec<&str> = head.split([' ', '\t', ',', '\u{feff}']).collect();
    // The last word is the one that is being written, be it empty.
    words.retain(|word| !word.is_empty());
    if head.ends_with([' ', '\t', ',']) {
        words.push("");
    }
    let is_number = |word: &&&str| !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
    let skipped = words.first().filter(is_number).is_some() as usize;
    let is_label = |word: &&&str| {
        let read = Operand::read(word.trim_end_matches(':'), document.target().model);
        matches!(read, Operand::Device(device) if device.kind.is_pointer())
    };
    let skipped = skipped + words.get(skipped).filter(is_label).is_some() as usize;
    let (mnemonic, operands) = words.get(skipped..)?.split_first()?;
    of_form(document, Form::named(mnemonic)?, operands, language)
}

/// Inside of `[ ]` and `( )` of a drawing.
fn drawn(document: &Document, offset: usize, language: Language) -> Option<Signature> {
    let head = head_of(document, offset)?;
    let start = head.rfind(['[', '('])?;
    let content = &head[start + 1..];
    if content.contains([']', ')', '-', '|', '+', '─']) {
        return None;
    }
    let mut words: Vec<&str> = content.split([' ', '\t', ',']).filter(|word| !word.is_empty()).collect();
    if content.ends_with([' ', '\t', ',']) {
        words.push("");
    }
    let (first, operands) = words.split_first()?;
    if let Some(form) = Form::named(first).or_else(|| Form::named(&format!("LD{first}"))) {
        return of_form(document, form, operands, language);
    }
    let device = document.reader().read(first).device()?;
    let counts = device.kind.has_preset();
    if head[start..].starts_with('(') && counts {
        return of_form(document, Form::named("OUT")?, &words, language);
    }
    None
}

/// `operands` are the words behind the mnemonic, the last one being that of the cursor.
fn of_form(document: &Document, form: Form, operands: &[&str], language: Language) -> Option<Signature> {
    let specs = form.instruction.operands;
    // Whoever writes a contact or a coil needs no reminder that it has a device.
    let is_applied = matches!(form.instruction.opcode, Opcode::Function(_));
    let driven = operands.first().and_then(|word| document.reader().read(word).device());
    let counts = driven.is_some_and(|device| device.kind.has_preset());
    let with_preset = specs.iter().any(|spec| spec.optional) && counts && operands.len() > 1;
    let is_told = is_applied || with_preset || specs.len() > 1 && !specs.iter().any(|spec| spec.optional);
    if specs.is_empty() || operands.is_empty() || !is_told {
        return None;
    }
    let given: Vec<Operand> = operands.iter().map(|word| document.reader().read(word)).collect();
    let mut label = form.mnemonic();
    let mut parameters = Vec::new();
    for (place, spec) in specs.iter().enumerate() {
        label.push(' ');
        let start = label.len();
        label.push_str(spec.name);
        let (least, greatest) = form.constant_limits(place, &given);
        let accepts = spec.accepts.on(document.target().model);
        let kinds = pages::kinds(accepts);
        let limits =
            if accepts.contains(Accepts::K) { format!(", K {least}–{greatest}") } else { String::new() };
        let access = match spec.access {
            Access::Read => Message::new("signature.read"),
            Access::Write => Message::new("signature.written"),
            Access::ReadWrite => Message::new("signature.read-written"),
        };
        let message = Message::new("signature.operand").with("number", place + 1).with("count", specs.len());
        let message = message.with("name", spec.name).with("meaning", phrase(spec.meaning, language));
        let message = message.with("access", access.render(language)).with("kinds", kinds + &limits);
        let documentation = message.render(language);
        parameters.push(SignatureParameter { span: Span::new(start, label.len()), documentation });
    }
    let active = operands.len() - 1;
    Some(Signature {
        label,
        documentation: phrase(form.instruction.title, language).to_string(),
        parameters,
        active: (active < specs.len()).then_some(active),
    })
}

/// A parameter of a call.
struct Formal {
    name: String,
    kind: String,
    meaning: &'static str,
    is_output: bool,
}

/// An open parenthesis, or the operands of a function without one.
struct OpenCall {
    callee: String,
    /// How many parameters stand before the one of the cursor.
    before: usize,
    /// The name of the parameter of the cursor, if it has one.
    name: Option<String>,
    /// Whether the current result is the first parameter.
    takes_result: bool,
}

fn call(document: &Document, offset: usize, language: Language) -> Option<Signature> {
    let found = document.chunk_at(offset)?;
    let inside = offset - found.start;
    let text = found.chunk.text().get(..inside)?;
    head_of(document, offset)?;
    let mut from = inside.saturating_sub(REACH);
    while !text.is_char_boundary(from) {
        from += 1;
    }
    let call = open_call(&text[from..]).or_else(|| without_parentheses(&text[from..]))?;
    let (label, documentation, formals, extensible) = formals(document, found.start, &call.callee)?;
    let active = match &call.name {
        Some(name) => formals.iter().position(|formal| formal.name.eq_ignore_ascii_case(name)),
        None => {
            let number = call.before + usize::from(call.takes_result);
            let last = formals.len().checked_sub(1)?;
            if number <= last { Some(number) } else { extensible.then_some(last) }
        }
    };
    Some(signature((label, phrase(&documentation, language)), &formals, extensible, active, language))
}

fn signature(
    ((name, result), title): ((String, String), &str),
    formals: &[Formal],
    extensible: bool,
    active: Option<usize>,
    language: Language,
) -> Signature {
    let mut label = format!("{name}(");
    let mut parameters = Vec::new();
    for (place, formal) in formals.iter().enumerate() {
        if place > 0 {
            label.push_str(", ");
        }
        let start = label.len();
        let arrow = if formal.is_output { " => " } else { " : " };
        label.push_str(&format!("{}{arrow}{}", formal.name, formal.kind));
        let span = Span::new(start, label.len());
        parameters
            .push(SignatureParameter { span, documentation: phrase(formal.meaning, language).to_string() });
    }
    label.push_str(if extensible { ", …)" } else { ")" });
    if !result.is_empty() {
        label.push_str(&format!(" : {result}"));
    }
    Signature { label, documentation: title.to_string(), parameters, active }
}

/// The innermost call whose parenthesis is open at the end of `text`.
fn open_call(text: &str) -> Option<OpenCall> {
    struct Open {
        at: usize,
        commas: usize,
        last: usize,
    }
    let mut open: Vec<Open> = Vec::new();
    let bytes = text.as_bytes();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'(' if bytes.get(at + 1) == Some(&b'*') => {
                at += text[at..].find("*)")? + 1;
            }
            b'\'' | b'"' => {
                let rest = &text[at + 1..];
                at += 1 + rest.find([char::from(byte), '\n']).unwrap_or(rest.len());
            }
            b'/' if bytes.get(at + 1) == Some(&b'/') => {
                at += text[at..].find('\n').unwrap_or(text.len() - at);
            }
            b'(' => open.push(Open { at, commas: 0, last: at + 1 }),
            b')' => _ = open.pop(),
            b',' => {
                if let Some(innermost) = open.last_mut() {
                    innermost.commas += 1;
                    innermost.last = at + 1;
                }
            }
            _ => {}
        }
        at += 1;
    }
    // Parentheses of operators and of parameters open expressions, not calls: the call is around them.
    open.iter().rev().find_map(|open| {
        let head = text[..open.at].trim_end();
        let start = head.trim_end_matches(|c: char| c.is_alphanumeric() || "_.".contains(c)).len();
        let callee = &head[start..];
        let name = text[open.last..].split_once(":=").or_else(|| text[open.last..].split_once("=>"));
        let name = name.map(|(name, _)| name.split_whitespace().last().unwrap_or("").to_string());
        // `ADD(` is an operator, but with named parameters the function of that name.
        let is_operator = Operator::written(callee).is_some() && name.is_none();
        if callee.is_empty() || is_operator {
            return None;
        }
        Some(OpenCall { callee: callee.to_string(), before: open.commas, name, takes_result: false })
    })
}

/// `LIMIT B, ` on a line of its own: the current result is the first parameter.
fn without_parentheses(text: &str) -> Option<OpenCall> {
    let line = text.rsplit(['\n', '\r']).next()?;
    let line = line.split_once(':').filter(|(_, rest)| !rest.starts_with('=')).map_or(line, |(_, rest)| rest);
    let line = line.trim_start();
    let (callee, operands) = line.split_once([' ', '\t'])?;
    let is_function = Function::named(callee).is_some() && Operator::written(callee).is_none();
    let before = operands.matches(',').count();
    is_function.then(|| OpenCall { callee: callee.to_string(), before, name: None, takes_result: true })
}

type Callee = ((String, String), String, Vec<Formal>, bool);

/// The name and result, the title, and the parameters of `callee`, an instance or a function.
fn formals(document: &Document, chunk_start: usize, callee: &str) -> Option<Callee> {
    let scopes = document.scopes();
    let pou = names::pou_at(document, chunk_start);
    let unit = match scopes.type_of(pou, callee) {
        Some(DeclaredType::Named(name)) => name.to_string(),
        _ => callee.to_string(),
    };
    let own = |parameter: &Parameter, is_output| Formal {
        name: parameter.name.to_string(),
        kind: parameter.kind.name().to_string(),
        meaning: parameter.meaning,
        is_output,
    };
    if let Some(declared_unit) = scopes.pou_named(&unit) {
        let parameters = declared_unit.variables.iter().filter(|variable| variable.section.is_parameter());
        let formals = parameters.map(|variable| Formal {
            name: variable.name.to_string(),
            kind: declared::type_name(&variable.declared, scopes),
            meaning: declared::section_keyword(variable.section),
            is_output: variable.section == SectionKind::Output,
        });
        let result = match (&declared_unit.result, declared_unit.kind) {
            (Some(result), PouKind::Function) => declared::type_name(result, scopes),
            _ => String::new(),
        };
        let title = declared::pou_keyword(declared_unit.kind).to_string();
        return Some(((callee.to_string(), result), title, formals.collect(), false));
    }
    if let Some(block) = FunctionBlock::named(&unit) {
        let inputs = block.inputs.iter().map(|input| own(input, false));
        let formals = inputs.chain(block.outputs.iter().map(|output| own(output, true)));
        let title = block.title.to_string();
        return Some(((callee.to_string(), String::new()), title, formals.collect(), false));
    }
    let function = Function::named(&unit)?;
    let formals = function.inputs.iter().map(|input| own(input, false)).collect();
    let result = function.result.name().to_string();
    Some(((function.name.to_string(), result), function.title.to_string(), formals, function.extensible))
}
