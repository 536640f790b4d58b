//! Every rule through its page: each fence is a program, `^^^` marks what the rule must report in the line above.
//! A fence with marks gives exactly these places under the rule's code; a fence without is clean of everything but
//! hints. A page has at least one of each, but for rules whose finding cannot be shown in a few lines.

use rungwise::check::{self, RULES, Rule, Severities};
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Fix, Language, Severity, Span, TextEdit, catalogue_keys};
use std::collections::HashSet;

/// Rules whose failing example would not fit on a page, or would not be seen on it.
const WITHOUT_FAILING_EXAMPLE: &[&str] =
    &["text-too-large", "tab-in-drawing", "device-comments", "program-too-large"];

/// Rules behind whose fixes the rest of the line has to be mended, or the same rule has something else to say.
const NEXT_TOLD: &[&str] = &["unknown-instruction", "unused-suppression"];

/// Programs with a fix of rules whose pages have none.
const FIXED_ELSEWHERE: &[(&str, Notation, &str)] = &[
    (
        "contact-after-coil",
        Notation::Ladder,
        "|   X0              X1             Y0  |\n+---| |-----------+-|/|------------( )-+\n\
         |   X2      Y1    |\n+---| |-----( )---+\n",
    ),
    ("unreadable-cell", Notation::Ladder, "|  X0      Y0  |\n+--| |--?--( )-+\n"),
    ("tab-in-drawing", Notation::Ladder, "|  X0\tY0  |\n+--| |--( )-+\n"),
    ("unknown-device", Notation::FxIl, "LD XO\nOUT Y0\nEND\n"),
    ("lenient-form", Notation::IecIl, "PROGRAM Main\nVAR a : BOOL; END_VAR\nLD a;\nST a\nEND_PROGRAM\n"),
    ("read-never-written", Notation::FxIl, "LD X0\nOUT M21\nLD M20\nOUT Y0\nEND\n"),
    (
        "unknown-function-block",
        Notation::IecIl,
        "PROGRAM Main\nVAR T1 : TON; a : BOOL; END_VAR\nCAL TON(IN := a)\nLD T1.Q\nST a\nEND_PROGRAM\n",
    ),
];

/// A fenced example: its program without the marks, and where the marks point.
struct Example {
    notation: Notation,
    target: &'static Target,
    text: String,
    marks: Vec<Span>,
    line: usize,
}

#[test]
fn every_page_is_true() {
    let mut wrong = Vec::new();
    for rule in RULES.iter() {
        let examples = examples(&rule.page());
        if !examples.iter().any(|example| example.marks.is_empty()) {
            wrong.push(format!("{}: no clean example", rule.code));
        }
        let shown = examples.iter().any(|example| !example.marks.is_empty());
        if !shown && !WITHOUT_FAILING_EXAMPLE.contains(&rule.code) {
            wrong.push(format!("{}: no failing example", rule.code));
        }
        wrong.extend(examples.iter().filter_map(|example| check_example(rule, example)));
    }
    assert!(wrong.is_empty(), "{} examples are wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_rule_has_a_fix_or_a_reason() {
    let page = include_str!("../docs/quick-fixes.md");
    let reasons = page.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` | "));
    let without: HashSet<&str> = reasons.filter(|(_, why)| why.len() > 20).map(|(code, _)| code).collect();
    let mut wrong = Vec::new();
    for code in without.iter().filter(|code| Rule::named(code).is_none()) {
        wrong.push(format!("{code}: no rule"));
    }
    for rule in RULES.iter() {
        let mut all = examples(&rule.page());
        all.extend(FIXED_ELSEWHERE.iter().filter(|(code, ..)| *code == rule.code).map(
            |&(_, notation, text)| {
                let model = if notation == Notation::IecIl { Model::Iec } else { Model::Fx2n };
                let (target, text) = (Target::of(model), text.to_string());
                Example { notation, target, text, marks: Vec::new(), line: 0 }
            },
        ));
        let mut fixes = 0;
        for example in &all {
            let document = Document::new(&example.text, example.notation, example.target);
            let found = check::all(&document, &Severities::default());
            let own = found.iter().filter(|found| found.code == rule.code);
            for fix in own.flat_map(|found| &found.fixes) {
                fixes += 1;
                wrong.extend(complaint_of(fix, rule, example, &found));
            }
        }
        match (fixes, without.contains(rule.code)) {
            (0, false) => wrong.push(format!("{}: no fix, and no reason why", rule.code)),
            (1.., true) => wrong.push(format!("{}: has a fix and a reason why not", rule.code)),
            _ => {}
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What is wrong with a fix: behind it there are as many findings of its rule, or more errors.
fn complaint_of(fix: &Fix, rule: &Rule, example: &Example, before: &[Diagnostic]) -> Option<String> {
    let text = TextEdit::apply_all(&fix.edits, &example.text);
    let after = check::all(&Document::new(&text, example.notation, example.target), &Severities::default());
    let own = |found: &[Diagnostic]| found.iter().filter(|found| found.code == rule.code).count();
    let errors =
        |found: &[Diagnostic]| found.iter().filter(|found| found.severity == Severity::Error).count();
    let title = fix.title.render(Language::English);
    let is_better =
        NEXT_TOLD.contains(&rule.code) || own(&after) < own(before) && errors(&after) <= errors(before);
    let codes: Vec<&str> = after.iter().map(|found| found.code).collect();
    (!is_better).then(|| format!("{}: “{title}” leaves {codes:?}:\n{text}", rule.code))
}

#[test]
fn codes_are_unique_and_pages_start_with_them() {
    let mut seen = HashSet::new();
    for rule in RULES.iter() {
        assert!(seen.insert(rule.code), "{} twice", rule.code);
        assert!(rule.page().starts_with(&format!("# {}\n", rule.code)), "{}: the page's title", rule.code);
        assert!(rule.summary(Language::English).len() > 20, "{}: the page's first sentence", rule.code);
    }
    assert!(!RULES.is_empty());
}

#[test]
fn every_message_in_the_sources_is_in_the_catalogue() {
    let keys: HashSet<&str> = catalogue_keys(Language::English).map(|(key, _)| key).collect();
    let mut used = 0;
    let mut missing = Vec::new();
    for file in crate::tidy::source_files() {
        let text = std::fs::read_to_string(&file).unwrap();
        for part in text.split("Message::new(").skip(1) {
            let Some(key) = part.trim_start().strip_prefix('"').and_then(|rest| rest.split('"').next())
            else {
                continue;
            };
            used += 1;
            if !keys.contains(key) {
                missing.push(format!("{}: {key}", file.display()));
            }
        }
    }
    assert!(missing.is_empty(), "not in the catalogue:\n{}", missing.join("\n"));
    assert!(used > 5, "the scan found only {used} keys");
}

fn check_example(rule: &Rule, example: &Example) -> Option<String> {
    let document = Document::new(&example.text, example.notation, example.target);
    let found = check::all(&document, &Severities::default());
    let at = |span: Span| {
        let position = document.position(span.start as usize, rungwise::text::Encoding::Utf32);
        format!("{}:{}+{}", position.line + 1, position.column + 1, span.len())
    };
    let complaint = if example.marks.is_empty() {
        let unclean = found
            .iter()
            .filter(|diagnostic| diagnostic.severity != Severity::Hint || diagnostic.code == rule.code);
        let unclean: Vec<String> = unclean
            .map(|diagnostic| {
                format!(
                    "{} at {}: {}",
                    diagnostic.code,
                    at(diagnostic.span),
                    diagnostic.message.render(Language::English)
                )
            })
            .collect();
        (!unclean.is_empty()).then(|| format!("should be clean, but: {}", unclean.join("; ")))
    } else {
        let mut places: Vec<Span> = found
            .iter()
            .filter(|diagnostic| diagnostic.code == rule.code)
            .map(|diagnostic| diagnostic.span)
            .collect();
        places.sort();
        (places != example.marks).then(|| {
            let list = |spans: &[Span]| spans.iter().map(|&span| at(span)).collect::<Vec<_>>().join(", ");
            let others: Vec<&str> = found.iter().map(|diagnostic| diagnostic.code).collect();
            format!("marked [{}], reported [{}]; all codes: {others:?}", list(&example.marks), list(&places))
        })
    };
    complaint
        .map(|complaint| format!("{} (page line {}): {complaint}\n{}", rule.code, example.line, example.text))
}

/// The examples of a page. A line of blanks and `^` is a mark; it leaves the program.
fn examples(page: &str) -> Vec<Example> {
    let mut examples = Vec::new();
    let mut lines = page.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let Some(words) = line.strip_prefix("```").filter(|words| !words.is_empty()) else { continue };
        let mut words = words.split_whitespace();
        let notation = match words.next() {
            Some("lad") => Notation::Ladder,
            Some("fx") => Notation::FxIl,
            Some("iec") => Notation::IecIl,
            // Tables are tried by the tests of the comments file.
            Some("csv") => {
                lines.by_ref().take_while(|(_, line)| *line != "```").for_each(drop);
                continue;
            }
            other => panic!("line {number}: a fence of {other:?}"),
        };
        let default = if notation == Notation::IecIl { Model::Iec } else { Model::Fx2n };
        let target = words.next().map_or(Target::of(default), |name| Target::named(name).expect("a target"));
        let mut example =
            Example { notation, target, text: String::new(), marks: Vec::new(), line: number + 1 };
        let mut last_start = 0;
        for (_, line) in lines.by_ref().take_while(|(_, line)| *line != "```") {
            let is_mark = line.contains('^') && line.chars().all(|c| c == ' ' || c == '^');
            if is_mark {
                let above = example.text[last_start..].trim_end_matches('\n').to_string();
                example.marks.extend(marks(&above, line, last_start));
            } else {
                last_start = example.text.len();
                example.text.push_str(line);
                example.text.push('\n');
            }
        }
        example.marks.sort();
        examples.push(example);
    }
    examples
}

/// The spans of `above` under which `line` has carets, as displayed cells.
fn marks(above: &str, line: &str, start: usize) -> Vec<Span> {
    let mut cells = Vec::new();
    for (offset, character) in above.char_indices() {
        cells.extend(std::iter::repeat_n(offset, rungwise::text::cell_width(character)));
    }
    cells.push(above.len());
    let mut spans = Vec::new();
    let mut column = 0;
    for run in line.split_inclusive(' ') {
        let carets = run.trim_end().len();
        if carets > 0 {
            let byte = |cell: usize| start + cells.get(cell).copied().unwrap_or(above.len());
            spans.push(Span::new(byte(column), byte(column + carets)));
        }
        column += run.len();
    }
    spans
}
