//! The pages of instructions, operators, functions and function blocks, as Markdown with everything that the row of
//! the table says.

use crate::target::iec::{Function, FunctionBlock, Operator, Parameter};
use crate::target::{
    Accepts, Access, Form, Instruction, Model, OperandSpec, Steps, Target, Wide, instructions,
};

/// The page of an instruction: heading, forms, operands, steps and models, then the text with its example.
pub fn instruction_page(form: Form) -> String {
    let row = form.instruction;
    let mut page = format!("### {}: {}{}\n\n", form.mnemonic(), row.title, variant(form));
    page += &usage_line(form);
    let forms: Vec<String> =
        instructions::forms_of(row).map(|form| format!("`{}`", form.mnemonic())).collect();
    if forms.len() > 1 {
        page += &format!("Forms: {}\n\n", forms.join(", "));
    }
    if !row.operands.is_empty() {
        page += "| operand | meaning | takes |\n|---|---|---|\n";
        for (place, spec) in row.operands.iter().enumerate() {
            page += &operand_row(form, place, spec);
        }
        page.push('\n');
    }
    page += &format!("{} · {}\n\n", steps_words(form), models_words(row));
    page + row.page
}

/// The page of an operator of IEC Instruction List: heading, spellings with modifiers, then the text.
pub fn operator_page(operator: &Operator) -> String {
    let mut page = format!("### {}: {}\n\n", operator.name, operator.title);
    let written = Operator::all_written().filter(|written| written.operator.name == operator.name);
    let mut forms: Vec<String> = written.map(|written| format!("`{}`", written.word())).collect();
    if operator.modifiers.defer {
        forms.push(format!("`{}(`", operator.name));
    }
    if forms.len() > 1 {
        page += &format!("Forms: {}\n\n", forms.join(", "));
    }
    if let Some(group) = operator.operand {
        page += &format!("Operand: {}\n\n", group.name());
    }
    page + &operator.page()
}

/// The page of a standard function: heading, declaration, inputs, then the text.
pub fn function_page(function: &Function) -> String {
    let mut page = format!("### {}: {}\n\n", function.name, function.title);
    let more = if function.extensible { ", …" } else { "" };
    let inputs: Vec<String> =
        function.inputs.iter().map(|input| format!("{} : {}", input.name, input.kind.name())).collect();
    page += &format!("`{}({}{more}) : {}`\n\n", function.name, inputs.join(", "), function.result.name());
    page += &parameter_table(&[("input", function.inputs)]);
    page + &function.page()
}

/// The page of a standard function block: heading, inputs and outputs, then the text.
pub fn block_page(block: &FunctionBlock) -> String {
    let mut page = format!("### {}: {}\n\n", block.name, block.title);
    page += &parameter_table(&[("input", block.inputs), ("output", block.outputs)]);
    if !block.input_operators.is_empty() {
        let operators: Vec<String> = block.input_operators.iter().map(|word| format!("`{word}`")).collect();
        page += &format!("Input operators: {}\n\n", operators.join(", "));
    }
    page + &block.page()
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

/// `, 32 bit, once for each rising edge`, for the forms with D and P.
fn variant(form: Form) -> String {
    let wide = if form.wide && form.instruction.wide != Wide::Only { ", 32 bit" } else { "" };
    let pulse = if form.pulse { ", once when power arrives" } else { "" };
    format!("{wide}{pulse}")
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

fn operand_row(form: Form, place: usize, spec: &OperandSpec) -> String {
    let access = match spec.access {
        Access::Read => "",
        Access::Write => ", written",
        Access::ReadWrite => ", read and written",
    };
    let optional = if spec.optional { ", may be left out" } else { "" };
    let count = if spec.count > 1 { format!(", {} devices", spec.count) } else { String::new() };
    let limits = match spec.range.is_some() || spec.wide_range.is_some() {
        true => {
            let (least, greatest) = form.constant_limits(place, &[]);
            format!(" ({least} to {greatest})")
        }
        false => String::new(),
    };
    format!(
        "| {} | {}{access}{count}{optional} | {}{limits} |\n",
        spec.name,
        spec.meaning,
        kinds(spec.accepts)
    )
}

fn steps_words(form: Form) -> String {
    match form.instruction.steps {
        Steps::Fixed(1) => "1 step".to_string(),
        Steps::Fixed(steps) => format!("{steps} steps"),
        Steps::ByOperands => format!("{} steps", form.steps(&[])),
        Steps::ByDevice => "1 to 5 steps, by the device".to_string(),
    }
}

fn models_words(row: &Instruction) -> String {
    let titles: Vec<&str> = row.models.iter().map(|&model: &Model| Target::of(model).title).collect();
    titles.join(", ")
}

fn parameter_table(groups: &[(&str, &[Parameter])]) -> String {
    if groups.iter().all(|(_, parameters)| parameters.is_empty()) {
        return String::new();
    }
    let mut table = "| | name | type | meaning |\n|---|---|---|---|\n".to_string();
    for (group, parameters) in groups {
        for parameter in *parameters {
            let Parameter { name, kind, meaning } = parameter;
            table += &format!("| {group} | {name} | {} | {meaning} |\n", kind.name());
        }
    }
    table.push('\n');
    table
}
