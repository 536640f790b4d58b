//! Simplified Chinese beside English: nothing lacks a translation, nothing bypasses the catalogue, and the language is
//! chosen as the user says, through the doors of the user.

use crate::lsp_client::{Client, at};
use rungwise::check::RULES;
use rungwise::target::iec::{EN, ENO, Function, FunctionBlock, Operator};
use rungwise::target::{Form, Target, instructions};
use rungwise::text::{Book, Language, Message, catalogue_keys, has_phrase, page, phrases, prose, sections};
use rungwise::{ide, text};
use serde_json::{Value, json};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::process::{Command, Stdio};

const CHINESE: Language = Language::SimplifiedChinese;

/// Entries without words.
const WORDLESS: &[&str] = &[
    "hover.constant",
    "hover.constant-time",
    "hover.literal-time",
    "hover.member",
    "complete.variable",
    "conversion.noun",
    "conversion.noun-vowel",
];

fn is_chinese(text: &str) -> bool {
    text.chars().any(|c| ('\u{4e00}'..='\u{9fff}').contains(&c) || "，。：（）［］".contains(c))
}

/// The names in braces.
fn placeholders(template: &str) -> BTreeSet<&str> {
    template.split('{').skip(1).filter_map(|rest| rest.split('}').next()).collect()
}

// The catalogue

#[test]
fn every_language_has_every_message_with_the_same_places() {
    let english: HashMap<&str, &str> = catalogue_keys(Language::English).collect();
    assert!(english.len() > 400, "{}", english.len());
    let mut wrong = Vec::new();
    for &language in Language::ALL.iter().filter(|language| **language != Language::English) {
        let own: HashMap<&str, &str> = catalogue_keys(language).collect();
        for (key, template) in &english {
            match own.get(key) {
                None => wrong.push(format!("{key}: not in {}", language.tag())),
                Some(other) if placeholders(other) != placeholders(template) => {
                    wrong.push(format!("{key}: other places in {}: {other}", language.tag()));
                }
                Some(other) if other == template && !WORDLESS.contains(key) => {
                    wrong.push(format!("{key}: English in {}", language.tag()));
                }
                Some(_) => {}
            }
        }
        wrong.extend(
            own.keys().filter(|key| !english.contains_key(*key)).map(|key| format!("{key}: not in en")),
        );
    }
    wrong.sort();
    assert!(wrong.is_empty(), "{} messages:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_chinese_message_is_chinese() {
    let plain: Vec<&str> = catalogue_keys(CHINESE)
        .filter(|(key, words)| !is_chinese(words) && !WORDLESS.contains(key))
        .map(|(key, _)| key)
        .collect();
    assert!(plain.is_empty(), "{plain:?}");
}

#[test]
fn arguments_that_are_words_follow_the_language() {
    let place = |name: &'static str, meaning: &'static str| {
        Message::new("operand-count.place").with("name", name).with_phrase("meaning", meaning)
    };
    let missing = vec![place("S", "source"), place("D", "destination")];
    let message =
        Message::new("operand-count.too-few").with("instruction", "MOV").with_messages("missing", missing);
    assert_eq!(message.render(Language::English), "MOV lacks S (source), D (destination)");
    assert_eq!(message.render(CHINESE), "MOV 缺少操作数：S（源）、D（目标）");
    let message = Message::new("syntax-error.expected-at-end")
        .with_alternatives("expected", ["operand", "`:`", "type"]);
    assert_eq!(message.render(CHINESE), "此处应为 操作数、`:` 或 类型");
    assert_eq!(message.render(Language::English), "expected operand, `:` or type");
    let message = Message::new("syntax-error.expected-at-end").with_alternatives("expected", ["label"]);
    assert_eq!(message.render(Language::English), "expected label");
}

// The tables

/// The English words of all tables.
fn table_phrases() -> BTreeSet<&'static str> {
    let mut words: BTreeSet<&str> = BTreeSet::new();
    for row in instructions::all().chain([&instructions::UNREAD]) {
        words.insert(row.title);
        words.extend(row.operands.iter().map(|operand| operand.meaning));
    }
    words.extend(Operator::all().map(|operator| operator.title));
    for function in Function::families() {
        words.insert(function.title);
        words.extend(function.inputs.iter().map(|input| input.meaning));
    }
    for block in FunctionBlock::all() {
        words.insert(block.title);
        words.extend(block.inputs.iter().chain(block.outputs).map(|pin| pin.meaning));
    }
    words.extend([EN.meaning, ENO.meaning]);
    words.extend(Function::all().flat_map(|function| function.inputs).map(|input| input.meaning));
    for target in Target::ALL {
        words.extend(target.special.iter().map(|special| special.meaning));
        words.extend(target.devices.iter().map(|range| range.purpose));
    }
    add_descriptions(&crate::manifest_help::SCHEMA, &mut words);
    add_descriptions(&crate::scenario_schema::SCHEMA, &mut words);
    words
}

/// The descriptions of the keys of a table in the schema of the manifest. Those of rules are on their pages.
fn add_descriptions(table: &'static Value, words: &mut BTreeSet<&'static str>) {
    for (_, node) in table["properties"].as_object().into_iter().flatten() {
        words.extend(node["description"].as_str().filter(|_| node["allOf"].is_null()));
        add_descriptions(node, words);
        add_descriptions(&node["items"], words);
    }
}

#[test]
fn every_title_and_meaning_is_translated() {
    let lacking: Vec<&str> =
        table_phrases().into_iter().filter(|words| !has_phrase(words, CHINESE)).collect();
    assert!(lacking.is_empty(), "not in phrases.toml: {lacking:#?}");
    let plain: Vec<_> = phrases(CHINESE).filter(|(_, chinese)| !is_chinese(chinese)).collect();
    assert!(plain.is_empty(), "{plain:?}");
}

#[test]
fn the_words_of_the_grammar_are_translated() {
    let sources: Vec<String> = crate::tidy::source_files()
        .iter()
        .filter(|path| path.to_string_lossy().contains("/il/iec/"))
        .map(|path| std::fs::read_to_string(path).unwrap())
        .collect();
    let mut words = Vec::new();
    for source in &sources {
        for line in source.lines().filter(|line| line.contains(".expected")) {
            let literals = line.split('"').skip(1).step_by(2);
            words.extend(literals.flat_map(|list| list.split(", ")).filter(|word| is_words(word)));
        }
    }
    assert!(words.len() > 5, "{words:?}");
    words.extend([
        "end of line",
        "identifier",
        "type",
        "value",
        "constant",
        "%address",
        "comment",
        "pragma",
        "character",
    ]);
    let lacking: Vec<&&str> = words.iter().filter(|word| !has_phrase(word, CHINESE)).collect();
    assert!(lacking.is_empty(), "not in phrases.toml: {lacking:?}");
}

/// Whether an item of a list of what is expected is words and not a piece of program or a key of the catalogue.
fn is_words(item: &str) -> bool {
    item != "expected" && !item.is_empty() && item.chars().all(|c| c.is_ascii_lowercase() || " %".contains(c))
}

#[test]
fn no_phrase_is_left_over() {
    let sources: String =
        crate::tidy::source_files().iter().map(|path| std::fs::read_to_string(path).unwrap()).collect();
    let package = concat!(env!("CARGO_PKG_DESCRIPTION"), "\n");
    let tables = table_phrases();
    let stale: Vec<&str> = phrases(CHINESE)
        .map(|(english, _)| english)
        .filter(|english| {
            !tables.contains(english) && !sources.contains(english) && !package.contains(english)
        })
        .collect();
    assert!(stale.is_empty(), "in phrases.toml, but nowhere else: {stale:#?}");
}

// The pages

fn english_pages() -> Vec<(Book, &'static str, String)> {
    let rules = RULES.iter().map(|rule| (Book::Rules, rule.code, rule.page()));
    let rows = instructions::all().chain([&instructions::UNREAD]);
    let rows = rows.map(|row| (Book::Instructions, row.mnemonic, row.page.to_string()));
    let operators = Operator::all().map(|row| (Book::Operators, row.name, row.page()));
    let functions = Function::families().map(|row| (Book::Functions, row.name, row.page()));
    let blocks = FunctionBlock::all().map(|row| (Book::Blocks, row.name, row.page()));
    rules.chain(rows).chain(operators).chain(functions).chain(blocks).collect()
}

/// What stands in backticks outside of code blocks.
fn quoted(page: &str) -> BTreeSet<String> {
    let prose = page.split("```").step_by(2).collect::<String>();
    let joined = prose.replace('\n', " ");
    joined.split('`').skip(1).step_by(2).map(str::to_string).collect()
}

/// How many paragraphs there are beside the examples and the title.
fn paragraphs(page: &str) -> usize {
    let prose = page.split("```").step_by(2).flat_map(|part| part.split("\n\n"));
    prose.filter(|part| !part.trim().is_empty() && !part.starts_with("# ")).count()
}

fn blocks(page: &str) -> Vec<&str> {
    page.split("```").skip(1).step_by(2).collect()
}

#[test]
fn every_page_has_its_translation_and_no_translation_lacks_its_page() {
    let pages = english_pages();
    assert!(pages.len() > 300, "{}", pages.len());
    let lacking: Vec<_> = pages
        .iter()
        .filter(|(book, name, _)| prose(*book, name, CHINESE).is_none())
        .map(|(book, name, _)| (*book, *name))
        .collect();
    assert!(lacking.is_empty(), "no page in Chinese: {lacking:?}");
    let known: HashSet<(Book, &str)> = pages.iter().map(|(book, name, _)| (*book, *name)).collect();
    for book in Book::ALL {
        let stale: Vec<_> =
            sections(book, CHINESE).into_iter().filter(|name| !known.contains(&(book, *name))).collect();
        assert!(stale.is_empty(), "{book:?}: no such thing: {stale:?}");
    }
}

#[test]
fn translated_pages_keep_the_examples_and_name_the_same_code() {
    let mut wrong = Vec::new();
    for (book, name, english) in english_pages() {
        let chinese = page(book, name, &english, CHINESE);
        if blocks(&chinese) != blocks(&english) {
            wrong.push(format!("{book:?} {name}: the examples differ"));
        }
        if chinese.contains(text::EXAMPLE) || !is_chinese(&chinese) {
            wrong.push(format!("{book:?} {name}: not filled in"));
        }
        if paragraphs(&chinese) != paragraphs(&english) {
            wrong.push(format!("{book:?} {name}: another number of paragraphs"));
        }
        let (own, other) = (quoted(&english), quoted(&chinese));
        if own != other {
            let differing: Vec<_> = own.symmetric_difference(&other).collect();
            wrong.push(format!("{book:?} {name}: other code in the text: {differing:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn pages_of_conversions_are_chinese_too() {
    let conversions = Function::all().skip(Function::families().count());
    let mut seen = 0;
    for function in conversions {
        let (title, page) = (function.title_in(CHINESE), function.page_in(CHINESE));
        assert!(is_chinese(&title) && title != function.title, "{}: {title}", function.name);
        assert_eq!(blocks(&page), blocks(&function.page()), "{}", function.name);
        let prose = page.split("```").next().unwrap();
        let words: Vec<&str> = prose.split([' ', '`', '。', '，', '：', '（']).collect();
        let is_english = |word: &&str| word.len() > 1 && word.chars().all(|c| c.is_ascii_lowercase());
        let english = words.windows(2).any(|pair| pair.iter().all(is_english));
        assert!(is_chinese(prose) && !english, "{}: {prose}", function.name);
        seen += 1;
    }
    assert!(seen > 400, "{seen}");
}

#[test]
fn no_english_frame_is_left_on_a_chinese_page() {
    let words =
        ["operand", "meaning", "takes", "written", "input", "output", "step", "Forms", "Operand", "bit,"];
    let mut pages: Vec<(String, String)> = Vec::new();
    for row in instructions::all() {
        pages.extend(
            instructions::forms_of(row).map(|form| (form.mnemonic(), ide::instruction_page(form, CHINESE))),
        );
    }
    pages.extend(Operator::all().map(|row| (row.name.to_string(), ide::operator_page(row, CHINESE))));
    pages.extend(Function::all().map(|row| (row.name.to_string(), ide::function_page(row, CHINESE))));
    pages.extend(FunctionBlock::all().map(|row| (row.name.to_string(), ide::block_page(row, CHINESE))));
    for (name, page) in pages {
        let prose: String = page.split("```").step_by(2).collect();
        let found: Vec<_> = prose
            .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == ','))
            .filter(|word| words.contains(word))
            .collect();
        assert!(found.is_empty(), "{name}: {found:?} in\n{prose}");
    }
    let page = ide::instruction_page(Form::named("DMOVP").unwrap(), CHINESE);
    assert!(page.starts_with("### DMOVP：传送，32 位，能流到达时执行一次\n"), "{page}");
}

#[test]
fn a_rule_has_a_summary_in_both_languages() {
    for rule in RULES.iter() {
        let (english, chinese) = (rule.summary(Language::English), rule.summary(CHINESE));
        assert!(is_chinese(&chinese) && !chinese.contains('\n'), "{}: {chinese}", rule.code);
        assert!(chinese.ends_with(['。', '：', '；']) && chinese != english, "{}: {chinese}", rule.code);
        assert!(rule.page_in(CHINESE).starts_with(&format!("# {}\n\n", rule.code)), "{}", rule.code);
    }
}

// The sources

/// Literals with words that no user reads, by a part of their line.
const NOT_FOR_USERS: &[&str] = &[
    "tracing::",
    "reason = ",
    "debug_assert",
    // The first line of a text of LDmicro.
    "LDmicro export text",
    // A line of a diff, as every tool reads it.
    "No newline at end of file",
    // The names of columns in files of other tools.
    "const THINGS",
    // What the TOML library says.
    "is_about(",
];

#[test]
fn no_sentence_bypasses_the_catalogue() {
    let mut found = Vec::new();
    for path in crate::tidy::source_files() {
        // The folder that holds the project may be called anything.
        let name = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap().to_string_lossy().into_owned();
        let speaks = ["/ide/", "/cli/", "/lsp/", "/check/", "/project/", "/document/", "/il/", "/ladder/"];
        if !speaks.iter().any(|room| name.contains(room)) {
            continue;
        }
        let source = std::fs::read_to_string(&path).unwrap();
        let code = source.split("#[cfg(test)]").next().unwrap_or("");
        for (number, line) in code.lines().enumerate() {
            let line = line.trim_start();
            if line.starts_with("//") || NOT_FOR_USERS.iter().any(|part| line.contains(part)) {
                continue;
            }
            let line = line.split(" // ").next().unwrap_or("").replace("'\"'", "");
            let literals = line.split('"').skip(1).step_by(2);
            for literal in literals.filter(|literal| is_sentence(literal) && !has_phrase_of_list(literal)) {
                found.push(format!("{name}:{}: {literal}", number + 1));
            }
        }
    }
    assert!(found.is_empty(), "words that are in no catalogue:\n{}", found.join("\n"));
}

/// Two words of lower-case letters side by side.
fn is_sentence(literal: &str) -> bool {
    let is_word = |word: &str| word.len() > 1 && word.chars().all(|c| c.is_ascii_lowercase() || c == '\'');
    let words: Vec<&str> =
        literal.split(' ').map(|word| word.trim_end_matches([',', '.', ':', ';'])).collect();
    words.windows(2).any(|pair| is_word(pair[0]) && is_word(pair[1]))
}

fn has_phrase_of_list(literal: &str) -> bool {
    literal.split(", ").all(|part| part.starts_with('`') || has_phrase(part, CHINESE))
}

#[test]
fn a_sentence_is_told_from_code() {
    assert!(is_sentence("there is nothing") && is_sentence("{name}: check the path"));
    assert!(!is_sentence("open-circuit.found") && !is_sentence("MOV K10 D0") && !is_sentence("{} s"));
}

// The server

const URI: &str = "file:///somewhere/a.il";
const WRONG: &str = "LD X8\nOUT T0 K50\nMOV K1 D0\nEND\n";

/// A server whose client says this locale.
fn server_with(locale: Value, options: Value) -> Client {
    let mut client = Client::spawn();
    let params = json!({"processId": null, "rootUri": null, "capabilities": {}, "locale": locale,
        "initializationOptions": options});
    client.request("initialize", params);
    client.notify("initialized", json!({}));
    client.open(URI, "plc-il", WRONG);
    client
}

fn first_message(client: &mut Client, version: i64) -> String {
    client.diagnostics(URI, version)[0]["message"].as_str().unwrap().to_string()
}

#[test]
fn the_locale_of_the_client_decides() {
    for (locale, chinese) in
        [("zh-CN", true), ("zh", true), ("zh-Hans", true), ("zh-tw", true), ("de", false)]
    {
        let mut client = server_with(json!(locale), Value::Null);
        let message = first_message(&mut client, 1);
        assert_eq!(message.contains("八进制"), chinese, "{locale}: {message}");
    }
    let mut client = server_with(Value::Null, Value::Null);
    assert!(first_message(&mut client, 1).contains("octal"));
}

#[test]
fn the_setting_goes_before_the_locale_and_takes_effect_at_once() {
    let mut client = server_with(json!("zh-CN"), json!({"language": "en"}));
    assert!(first_message(&mut client, 1).contains("octal"));
    for (language, word) in [("zh-CN", "八进制"), ("en", "octal"), ("auto", "八进制")] {
        client.notify(
            "workspace/didChangeConfiguration",
            json!({"settings": {"rungwise": {"language": language}}}),
        );
        // Where checking takes its time, what was asked for before comes in two parts.
        client.wait_for(&format!("diagnostics for {language}"), |message| {
            let first = &message["params"]["diagnostics"][0];
            first["message"].as_str().is_some_and(|message| message.contains(word))
        });
        // Nothing in the language of before is to be taken for what comes next.
        while client.take(|_| true).is_some() {}
    }
}

#[test]
fn every_answer_is_in_the_language() {
    let mut client = server_with(json!("zh-CN"), Value::Null);
    let diagnostics = client.diagnostics(URI, 1);
    let hover = |client: &mut Client, line, column| {
        let answer = client.request("textDocument/hover", at(URI, line, column));
        answer["result"]["contents"]["value"].as_str().unwrap().to_string()
    };
    assert!(hover(&mut client, 2, 1).starts_with("### MOV：传送\n"));
    let timer = hover(&mut client, 1, 5);
    assert!(
        timer.contains("**T0** 100 ms 定时器（T0–T191）") && timer.contains("设定值 `K50` = 5 s"),
        "{timer}"
    );
    let span = diagnostics[0]["range"].clone();
    let params = json!({"textDocument": {"uri": URI}, "range": span, "context": {"diagnostics": []}});
    let actions = client.request("textDocument/codeAction", params);
    assert!(actions["result"][0]["title"].as_str().is_some_and(is_chinese), "{actions}");
    let symbols = client.request("textDocument/documentSymbol", json!({"textDocument": {"uri": URI}}));
    assert!(symbols["result"][0]["name"].as_str().is_some_and(is_chinese), "{symbols}");
    let summary =
        client.request("workspace/executeCommand", json!({"command": "rungwise.check", "arguments": [URI]}));
    assert!(summary["result"]["message"].as_str().is_some_and(is_chinese), "{summary}");
    let rename =
        json!({"textDocument": {"uri": URI}, "position": {"line": 1, "character": 5}, "newName": "C0"});
    let refusal = client.request("textDocument/rename", rename);
    assert!(refusal["error"]["message"].as_str().is_some_and(|words| words.contains("定时器")), "{refusal}");
    let completions = client.request("textDocument/completion", at(URI, 2, 0));
    let items = completions["result"].as_array().unwrap();
    let detail =
        |label: &str| items.iter().find(|item| item["label"] == json!(label)).unwrap()["detail"].clone();
    assert_eq!(detail("OUT"), json!("线圈驱动"), "{completions}");
}

// The command line

fn run(arguments: &[&str], locale: &str, program: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.lad"), program).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_rungwise"));
    command.current_dir(folder.path()).args(arguments).stdin(Stdio::null());
    command.env_remove("LC_ALL").env_remove("LC_MESSAGES").env("LANG", locale);
    let output = command.output().unwrap();
    String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
}

#[test]
fn the_command_line_speaks_the_language_of_the_environment_or_the_one_asked_for() {
    assert!(run(&["explain", "MOV"], "zh_CN.UTF-8", "").starts_with("### MOV：传送\n"));
    assert!(run(&["explain", "MOV", "--lang", "en"], "zh_CN.UTF-8", "").starts_with("### MOV: move\n"));
    assert!(run(&["--lang=zh-CN", "explain", "open-circuit"], "C", "").contains("有一端悬空"));
    assert!(run(&["explain", "MOV"], "de_DE.UTF-8", "").starts_with("### MOV: move\n"));
    assert!(run(&["--lang", "zh", "explain", "nonsense"], "C", "").contains("既不是规则也不是指令"));
    assert!(run(&["--lang", "xx", "explain"], "C", "").contains("messages are in en, zh-CN"));
    assert!(
        run(&["--lang", "zh-CN", "check", "--target", "fx9"], "C", "").contains("没有此目标；可用 fx1s、")
    );
}

#[test]
fn help_is_in_the_language() {
    let help = run(&["check", "--help"], "zh_CN.UTF-8", "");
    assert!(help.starts_with("用全部规则检查文件、文件夹或项目\n"), "{help}");
    for words in ["用法：", "参数:", "选项:", "［默认值：warning］", "text（供人阅读）", "显示帮助"]
    {
        assert!(help.contains(words), "{words} in {help}");
    }
    assert_eq!(run(&["help", "check"], "zh_CN.UTF-8", ""), help);
    assert!(run(&[], "zh_CN.UTF-8", "").contains("命令:"), "without a verb");
    assert!(run(&["check", "--help"], "C", "").contains("Usage: rungwise check [OPTIONS] [PATHS]..."));
    assert!(run(&["--version"], "zh_CN.UTF-8", "").starts_with("rungwise 0."));
}

#[test]
fn carets_stand_under_their_cells_below_chinese_text() {
    let check = |program| run(&["check", "--lang", "zh-CN", "--target", "fx2n", "a.lad"], "C", program);
    // A Chinese character is as wide as two of the others.
    let found = check("|  启动    X8           Y0   |\n+--| |----|/|----------( )--+\n");
    let line = "1 | |  启动    X8           Y0   |\n";
    assert!(found.starts_with("a.lad:1:4: error[unknown-device]: "), "{found}");
    assert!(found.contains(&format!("{line}  |    ^^^^\n")), "{found}");
    assert!(found.contains("a.lad:1:10: error[octal-digit]: X8："), "{found}");
    assert!(found.contains(&format!("{line}  |            ^^\n")), "{found}");
    let found = check("(* 启动 *)\n|  X0      X1           Y0   |\n+--| |----|/|--  ------( )--+\n");
    assert!(found.starts_with("a.lad:3:15: error[open-circuit]: 断路："), "{found}");
    assert!(found.contains("3 | +--| |----|/|--  ------( )--+\n  |               ^  ~\n"), "{found}");
    assert!(found.contains("  说明：a.lad:3:18：") && found.contains("  修复："), "{found}");
    assert!(found.contains("检查未通过：1 个错误、0 个警告"), "{found}");
}
