//! `rungwise explain`

use super::Outcome;
use super::input::{complain, say};
use crate::check::{RULES, Rule};
use crate::target::iec::{Function, FunctionBlock, Operator};
use crate::target::instructions::suggestions;
use crate::target::{Form, Model};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The code of a rule (`open-circuit`) or a mnemonic (`MOV`, `LDN`, `TON`); all rules if left out.
    word: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(word) = &arguments.word else {
        for rule in RULES.iter() {
            say(&format!("{:<26} {}\n", rule.code, rule.summary()));
        }
        return Outcome::Clean;
    };
    let pages = pages(word);
    if pages.is_empty() {
        let near = nearest(word);
        let help = if near.is_empty() { "`rungwise explain` lists all rules".to_string() } else { near };
        complain("unknown-word", &format!("`{word}` is neither a rule nor an instruction"), &help);
        return Outcome::Unusable;
    }
    say(&pages.join("\n"));
    Outcome::Clean
}

/// Every page under `word`: a rule; an FX instruction and an IEC operator, function or block of the same name.
fn pages(word: &str) -> Vec<String> {
    let rule = Rule::named(&word.to_ascii_lowercase()).map(Rule::page);
    let instruction = Form::named(word).map(crate::ide::instruction_page);
    let operator = Operator::written(word).map(|written| crate::ide::operator_page(written.operator));
    let function = Function::named(word).map(crate::ide::function_page);
    let block = FunctionBlock::named(word).map(crate::ide::block_page);
    [rule, instruction, operator, function, block].into_iter().flatten().collect()
}

fn nearest(word: &str) -> String {
    let codes = RULES.iter().map(|rule| rule.code).filter(|code| code.contains(&word.to_ascii_lowercase()));
    let near: Vec<String> = codes.map(str::to_string).chain(suggestions(word, Model::Fx3u)).collect();
    if near.is_empty() { String::new() } else { format!("near it are: {}", near.join(", ")) }
}
