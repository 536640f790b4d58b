//! The words that the editors' grammars colour are those of the tables.
//!
//! `RUNGWISE_UPDATE=1 cargo test grammar` writes them; without it the test says which file is behind the tables.

use rungwise::target::iec::{ElementaryType, Function, FunctionBlock, KEYWORDS, Operator, is_keyword};
use rungwise::target::instructions;
use std::collections::BTreeSet;
use std::path::Path;

/// Conversions are hundreds of words of one form, so TextMate gets the form.
const CONVERSIONS: &str = r"(?:[A-Z]+(?:_[A-Z]+)*_)?TO_[A-Z]+(?:_[A-Z]+)*";

/// A group of words: its key in the TextMate grammar, its group in Vim, its words, and a pattern for more of them.
struct Group {
    key: &'static str,
    vim: &'static str,
    words: BTreeSet<String>,
    pattern: Option<&'static str>,
}

fn groups() -> Vec<Group> {
    let types: BTreeSet<String> = ElementaryType::ALL
        .iter()
        .flat_map(|kind| [Some(kind.name()), kind.long_name()].into_iter().flatten())
        .map(str::to_string)
        .collect();
    let keywords =
        KEYWORDS.iter().map(|word| word.to_string()).filter(|word| !types.contains(word)).collect();
    let mnemonics =
        instructions::all().flat_map(instructions::forms_of).map(|form| form.mnemonic()).collect();
    let operators: BTreeSet<String> = Operator::all_written().map(|written| written.word()).collect();
    let functions = Function::families().map(|function| function.name.to_string());
    let functions = functions.filter(|name| !operators.contains(name)).collect();
    let blocks = FunctionBlock::all().map(|block| block.name.to_string()).collect();
    let group = |key, vim, words, pattern| Group { key, vim, words, pattern };
    vec![
        group("fx-mnemonics", "rungwiseMnemonic", mnemonics, None),
        group("iec-operators", "rungwiseOperator", operators, None),
        group("iec-functions", "rungwiseFunction", functions, Some(CONVERSIONS)),
        group("iec-blocks", "rungwiseBlock", blocks, None),
        group("iec-keywords", "rungwiseKeyword", keywords, None),
        group("iec-types", "rungwiseType", types, None),
    ]
}

impl Group {
    /// Longest first, so that a word is not taken for its beginning.
    fn sorted(&self) -> Vec<&str> {
        let mut words: Vec<&str> = self.words.iter().map(String::as_str).collect();
        words.sort_by_key(|word| (std::cmp::Reverse(word.len()), *word));
        words
    }

    fn textmate(&self) -> String {
        let words = self.sorted().into_iter().map(str::to_string).chain(self.pattern.map(str::to_string));
        format!(r"(?i)(?<![\w.%#])(?:{})(?![\w#])", words.collect::<Vec<_>>().join("|"))
    }

    /// Vim takes only words as keywords; spellings with signs are patterns of `plc-il.vim`.
    fn vim(&self) -> String {
        let words =
            self.sorted().into_iter().filter(|word| word.chars().all(|c| c.is_alphanumeric() || c == '_'));
        let conversions = Function::all().map(|function| function.name).filter(|name| name.contains("TO_"));
        let conversions: BTreeSet<&str> = conversions.filter(|_| self.pattern.is_some()).collect();
        let words: Vec<&str> = words.chain(conversions).collect();
        format!("syntax keyword {} {}", self.vim, words.join(" "))
    }
}

#[test]
fn textmate_words_are_those_of_the_tables() {
    check("syntaxes/rungwise-il.tmLanguage.json", |text| {
        groups().iter().fold(text.to_string(), |text, group| {
            let start = text.find(&format!("\"{}\": {{", group.key)).expect(group.key);
            let start = start + text[start..].find("\"match\": ").expect("a match") + "\"match\": ".len();
            let end = start + text[start..].find('\n').expect("a line");
            let value = serde_json::to_string(&group.textmate()).unwrap();
            format!("{}{value}{}", &text[..start], text[end..].trim_start_matches(','))
        })
    });
}

#[test]
fn vim_words_are_those_of_the_tables() {
    check("neovim/syntax/rungwise_keywords.vim", |text| {
        let lines = text.lines().map(|line| {
            let group = groups()
                .into_iter()
                .find(|group| line.starts_with(&format!("syntax keyword {} ", group.vim)));
            group.map_or(line.to_string(), |group| group.vim())
        });
        lines.map(|line| line + "\n").collect()
    });
}

#[test]
fn groups_are_whole() {
    let groups = groups();
    let has =
        |key: &str, word: &str| groups.iter().any(|group| group.key == key && group.words.contains(word));
    for (key, word) in [
        ("fx-mnemonics", "DMOVP"),
        ("fx-mnemonics", "ANDD>="),
        ("iec-operators", "JMPCN"),
        ("iec-functions", "LIMIT"),
        ("iec-blocks", "CTUD_DINT"),
        ("iec-keywords", "END_PROGRAM"),
        ("iec-types", "TIME_OF_DAY"),
    ] {
        assert!(has(key, word), "{word} is not in {key}");
    }
    assert!(is_keyword("VAR_INPUT"));
}

/// The file as it is equals what `renew` makes of it.
fn check(name: &str, renew: impl Fn(&str) -> String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    let renewed = renew(&text);
    if std::env::var_os("RUNGWISE_UPDATE").is_some() {
        std::fs::write(&path, &renewed).unwrap();
    }
    assert!(
        renewed == text,
        "{name} is behind the tables; write it by: RUNGWISE_UPDATE=1 cargo test grammar"
    );
}
