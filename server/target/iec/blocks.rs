//! The standard function blocks (IEC 61131-3 2nd ed. tables 34 to 37; RTC and SEMA are the first edition's).

use super::page::Page;
use super::{Parameter, Working};
use crate::text::{self, Book, Language};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

mod bistable;
mod counter;
mod timer;

/// One standard function block.
#[derive(Debug)]
pub struct FunctionBlock {
    /// Upper case: `TON`.
    pub name: &'static str,
    /// A few words.
    pub title: &'static str,
    /// The inputs in the order of the declaration.
    pub inputs: &'static [Parameter],
    /// The outputs in the order of the declaration.
    pub outputs: &'static [Parameter],
    /// The inputs that are also operators of Instruction List (`CU C10`), table 54.
    pub input_operators: &'static [&'static str],
    /// What a call does to the instance.
    pub working: Working,
    pub(super) page: Page,
}

impl FunctionBlock {
    /// Every block: bistables, edge detection, counters with their typed variants, timers.
    pub fn all() -> impl Iterator<Item = &'static FunctionBlock> {
        [bistable::ROWS, counter::ROWS, timer::ROWS].into_iter().flatten()
    }

    /// The block called `name`, letter case aside.
    ///
    /// ```
    /// use rungwise::target::iec::FunctionBlock;
    /// assert_eq!(FunctionBlock::named("ctu_dint").map(|block| block.outputs.len()), Some(2));
    /// ```
    pub fn named(name: &str) -> Option<&'static FunctionBlock> {
        super::folded(name, |name| BY_NAME.get(name).copied())
    }

    /// The blocks that are called by `word` as an input operator (`CU C10`), letter case aside; S and R are
    /// operators of their own as well, and the type of the operand decides.
    pub fn with_input_operator(word: &str) -> impl Iterator<Item = &'static FunctionBlock> {
        FunctionBlock::all().filter(move |block| block.has_input_operator(word))
    }

    /// Whether `word` is an input operator of this block, letter case aside.
    pub fn has_input_operator(&self, word: &str) -> bool {
        self.input_operators.iter().any(|operator| operator.eq_ignore_ascii_case(word))
    }

    /// The words that are an input operator of any block, each once.
    pub fn all_input_operators() -> &'static [&'static str] {
        &["S1", "R", "S", "R1", "CLK", "CU", "PV", "CD", "IN", "PT"]
    }

    /// The input called `name`, letter case aside.
    pub fn input_named(&self, name: &str) -> Option<&'static Parameter> {
        self.inputs.iter().find(|input| input.name.eq_ignore_ascii_case(name))
    }

    /// The output called `name`, letter case aside.
    pub fn output_named(&self, name: &str) -> Option<&'static Parameter> {
        self.outputs.iter().find(|output| output.name.eq_ignore_ascii_case(name))
    }

    /// The page: Markdown, one paragraph and a complete `il` program.
    pub fn page(&self) -> String {
        self.page_in(Language::English)
    }

    /// The page in `language`; the program is the same in all of them.
    pub fn page_in(&self, language: Language) -> String {
        text::page(Book::Blocks, self.name, &self.page.markdown(), language).into_owned()
    }

    /// The title in `language`.
    pub fn title_in(&self, language: Language) -> &'static str {
        text::phrase(self.title, language)
    }
}

static BY_NAME: LazyLock<FxHashMap<&'static str, &'static FunctionBlock>> =
    LazyLock::new(|| FunctionBlock::all().map(|block| (block.name, block)).collect());
