//! The pages of instructions, operators, functions and function blocks, as Markdown with everything that the row of
//! the table says.

use crate::target::iec::{Function, FunctionBlock, Operator, Parameter, Written};
use crate::target::{
    Accepts, Access, Form, Instruction, Model, OperandSpec, Steps, Target, Wide, instructions,
};
use crate::text::{Language, Message, phrase};

/// The page of an instruction: heading, forms, operands, steps and models, then the text with its example.
pub fn instruction_page(form: Form, language: Language) -> String {
    let row = form.instruction;
    let title =
        joined([row.title_in(language).to_string()].into_iter().chain(variant(form, language)), language);
    let mut page = heading(&form.mnemonic(), &title, language);
    page += &usage_line(form);
    page += &forms_line(instructions::forms_of(row).map(Form::mnemonic), language);
    if !row.operands.is_empty() {
        page += &table_head(Message::new("page.operand-columns"), 3, language);
        for (place, spec) in row.operands.iter().enumerate() {
            page += &operand_row(form, place, spec, language);
        }
        page.push('\n');
    }
    page += &format!("{} · {}\n\n", steps_words(form, language), models_words(row));
    page + &row.page_in(language)
}

/// The page of an operator of IEC Instruction List: heading, spellings with modifiers, then the text.
pub fn operator_page(operator: &Operator, language: Language) -> String {
    let mut page = heading(operator.name, operator.title_in(language), language);
    let written = Operator::all_written().filter(|written| written.operator.name == operator.name);
    let mut forms: Vec<String> = written.map(Written::word).collect();
    if operator.modifiers.defer {
        forms.push(format!("{}(", operator.name));
    }
    page += &forms_line(forms.into_iter(), language);
    if let Some(group) = operator.operand {
        page += &paragraph(Message::new("page.operand-group").with("group", group.name()), language);
    }
    page + &operator.page_in(language)
}

/// The page of a standard function: heading, declaration, inputs, then the text.
pub fn function_page(function: &Function, language: Language) -> String {
    let mut page = heading(function.name, &function.title_in(language), language);
    let more = if function.extensible { ", …" } else { "" };
    let inputs: Vec<String> =
        function.inputs.iter().map(|input| format!("{} : {}", input.name, input.kind.name())).collect();
    page += &format!("`{}({}{more}) : {}`\n\n", function.name, inputs.join(", "), function.result.name());
    page += &parameter_table(&[(Message::new("page.input"), function.inputs)], language);
    page + &function.page_in(language)
}

/// The page of a standard function block: heading, inputs and outputs, then the text.
pub fn block_page(block: &FunctionBlock, language: Language) -> String {
    let mut page = heading(block.name, block.title_in(language), language);
    let groups = [(Message::new("page.input"), block.inputs), (Message::new("page.output"), block.outputs)];
    page += &parameter_table(&groups, language);
    if !block.input_operators.is_empty() {
        let operators: Vec<String> = block.input_operators.iter().map(|word| format!("`{word}`")).collect();
        let message = Message::new("page.input-operators").with_words("operators", operators, ", ");
        page += &paragraph(message, language);
    }
    page + &block.page_in(language)
}

/// The kinds of operand in `accepts`, as the manuals abbreviate them: `X Y M S T C`.
pub(super) fn kinds(accepts: Accepts) -> String {
    const NAMES: &[(Accepts, &str)] = &[
        (Accepts::K, "K H"),
        (Accepts::E, "E"),
        (Accepts::TEXT, "\"text\""),
        (Accepts::X, "X"),
        (Accepts::Y, "Y"),
        (Accepts::M, "M"),
        (Accepts::S, "S"),
        (Accepts::WORD_BIT, "D.b"),
        (Accepts::KNX, "KnX"),
        (Accepts::KNY, "KnY"),
        (Accepts::KNM, "KnM"),
        (Accepts::KNS, "KnS"),
        (Accepts::T, "T"),
        (Accepts::C, "C"),
        (Accepts::D, "D"),
        (Accepts::R, "R"),
        (Accepts::V, "V"),
        (Accepts::Z, "Z"),
        (Accepts::P, "P"),
        (Accepts::I, "I"),
        (Accepts::N, "N"),
    ];
    let names: Vec<&str> =
        NAMES.iter().filter(|(kind, _)| accepts.contains(*kind)).map(|(_, name)| *name).collect();
    names.join(" ")
}

fn heading(name: &str, title: &str, language: Language) -> String {
    paragraph(Message::new("page.heading").with("name", name).with("title", title), language)
}

fn paragraph(message: Message, language: Language) -> String {
    message.render(language) + "\n\n"
}

/// `parts` as one phrase: `move, 32 bit`.
fn joined(parts: impl IntoIterator<Item = String>, language: Language) -> String {
    let join = |first: String, second: String| {
        Message::new("page.joined").with("first", first).with("second", second).render(language)
    };
    parts.into_iter().reduce(join).unwrap_or_default()
}

/// The spellings, if there is more than one.
fn forms_line(forms: impl Iterator<Item = String>, language: Language) -> String {
    let forms: Vec<String> = forms.map(|form| format!("`{form}`")).collect();
    if forms.len() < 2 {
        return String::new();
    }
    paragraph(Message::new("page.forms").with_words("forms", forms, ", "), language)
}

fn table_head(columns: Message, count: usize, language: Language) -> String {
    format!("{}\n|{}\n", columns.render(language), "---|".repeat(count))
}

/// `32 bit`, `once when power arrives`, for the forms with D and P.
fn variant(form: Form, language: Language) -> impl Iterator<Item = String> {
    let wide = form.wide && form.instruction.wide != Wide::Only;
    let wide = wide.then(|| Message::new("page.wide"));
    let pulse = form.pulse.then(|| Message::new("page.pulse"));
    wide.into_iter().chain(pulse).map(move |message| message.render(language))
}

/// `MOV S D` in a code span; nothing for instructions without operands.
fn usage_line(form: Form) -> String {
    if form.instruction.operands.is_empty() {
        return String::new();
    }
    let operands = form.instruction.operands.iter().map(|spec| match spec.optional {
        true => format!("[{}]", spec.name),
        false => spec.name.to_string(),
    });
    format!("`{} {}`\n\n", form.mnemonic(), operands.collect::<Vec<_>>().join(" "))
}

fn operand_row(form: Form, place: usize, spec: &OperandSpec, language: Language) -> String {
    let access = match spec.access {
        Access::Read => None,
        Access::Write => Some(Message::new("page.written")),
        Access::ReadWrite => Some(Message::new("page.read-and-written")),
    };
    let count = (spec.count > 1).then(|| Message::new("page.devices").with("count", spec.count));
    let optional = spec.optional.then(|| Message::new("page.optional"));
    let notes = access.into_iter().chain(count).chain(optional).map(|note| note.render(language));
    let meaning = phrase(spec.meaning, language).to_string();
    let meaning = joined([meaning].into_iter().chain(notes), language);
    let mut takes = kinds(spec.accepts);
    if spec.range.is_some() || spec.wide_range.is_some() {
        let (least, greatest) = form.constant_limits(place, &[]);
        let limited = Message::new("page.limits").with("kinds", takes);
        takes = limited.with("least", least).with("greatest", greatest).render(language);
    }
    format!("| {} | {meaning} | {takes} |\n", spec.name)
}

fn steps_words(form: Form, language: Language) -> String {
    let message = match form.instruction.steps {
        Steps::Fixed(1) => Message::new("page.one-step"),
        Steps::Fixed(steps) => Message::new("page.steps").with("steps", steps),
        Steps::ByOperands => Message::new("page.steps").with("steps", form.steps(&[])),
        Steps::ByDevice => Message::new("page.steps-by-device"),
    };
    message.render(language)
}

fn models_words(row: &Instruction) -> String {
    let titles: Vec<&str> = row.models.iter().map(|&model: &Model| Target::of(model).title).collect();
    titles.join(", ")
}

fn parameter_table(groups: &[(Message, &[Parameter])], language: Language) -> String {
    if groups.iter().all(|(_, parameters)| parameters.is_empty()) {
        return String::new();
    }
    let mut table = table_head(Message::new("page.parameter-columns"), 4, language);
    for (group, parameters) in groups {
        let group = group.render(language);
        for parameter in *parameters {
            let Parameter { name, kind, meaning } = parameter;
            let meaning = phrase(meaning, language);
            table += &format!("| {group} | {name} | {} | {meaning} |\n", kind.name());
        }
    }
    table.push('\n');
    table
}
