//! `rungwise explain`

use super::Outcome;
use super::input::{complain, say};
use crate::check::{RULES, Rule};
use crate::ide;
use crate::target::iec::{Function, FunctionBlock, Operator};
use crate::target::instructions::suggestions;
use crate::target::{Form, Model};
use crate::text::{Language, Message};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The code of a rule (`open-circuit`) or a mnemonic (`MOV`, `LDN`, `TON`); all rules if left out.
    word: Option<String>,
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let Some(word) = &arguments.word else {
        for rule in RULES.iter() {
            say(&format!("{:<26} {}\n", rule.code, rule.summary(language)));
        }
        return Outcome::Clean;
    };
    let pages = pages(word, language);
    if pages.is_empty() {
        let reason = Message::new("cli.unknown-word").with("word", word).render(language);
        complain("unknown-word", &reason, &nearest(word).render(language), language);
        return Outcome::Unusable;
    }
    say(&pages.join("\n"));
    Outcome::Clean
}

/// Every page under `word`: a rule; an FX instruction and an IEC operator, function or block of the same name.
fn pages(word: &str, language: Language) -> Vec<String> {
    let rule = Rule::named(&word.to_ascii_lowercase()).map(|rule| rule.page_in(language));
    let instruction = Form::named(word).map(|form| ide::instruction_page(form, language));
    let operator = Operator::written(word).map(|written| ide::operator_page(written.operator, language));
    let function = Function::named(word).map(|function| ide::function_page(function, language));
    let block = FunctionBlock::named(word).map(|block| ide::block_page(block, language));
    [rule, instruction, operator, function, block].into_iter().flatten().collect()
}

/// Names that are spelled nearly so, or where to find all.
fn nearest(word: &str) -> Message {
    let codes = RULES.iter().map(|rule| rule.code).filter(|code| code.contains(&word.to_ascii_lowercase()));
    let near: Vec<String> = codes.map(str::to_string).chain(suggestions(word, Model::Fx3u)).collect();
    if near.is_empty() {
        return Message::new("cli.all-rules");
    }
    Message::new("cli.near").with_words("near", near, ", ")
}
