//! Texts that nobody writes and somebody opens: nothing overflows the stack, and time grows with the length alone.

use cpu_time::ThreadTime;
use rungwise::check::{self, Severities};
use rungwise::document::{Document, Edit, Notation};
use rungwise::ide::{self, Style};
use rungwise::project::FormatStyle;
use rungwise::target::{Model, Target};
use rungwise::text::{Language, Span};
use rungwise::translate::{Options, To, prove, translate};
use std::time::Duration;

/// Everything that an editor asks for, at both ends and in the middle, and after an edit there.
fn ask_everything(document: &mut Document) {
    let found = check::all(document, &Severities::default());
    let (middle, end) = (document.len() / 2, document.len());
    for offset in [0, middle, end] {
        ide::hover(document, offset, Language::English);
        ide::completions(document, offset, Language::English);
        ide::definition(document, offset);
        ide::references(document, offset, true);
        ide::renamable(document, offset);
        for name in ["M7", "some_name"] {
            // Most are refused, which is as good.
            let _ = ide::rename(document, offset, name);
        }
    }
    ide::symbols(document, Language::English);
    ide::folds(document);
    ide::semantic_tokens(document);
    ide::inlay_hints(document, Span::new(0, end), Language::English);
    ide::fixes(&found, Span::new(0, end));
    ide::status(document);
    for kind in [FormatStyle::Iec, FormatStyle::Brackets, FormatStyle::Unicode] {
        ide::format(document, Style { kind, width: 48 });
    }
    for (offset, text) in [(middle, "Z"), (0, "("), (end, "*)"), (middle, "(*")] {
        document.apply(&[Edit { range: Some(offset..offset), text: text.to_string() }]);
        check::all(document, &Severities::default());
    }
}

fn open(notation: Notation, text: &str) -> Document {
    let model = if notation == Notation::IecIl { Model::Iec } else { Model::Fx2n };
    Document::new(text, notation, Target::of(model))
}

fn program(body: &str) -> String {
    format!("PROGRAM p\nVAR a : BOOL; END_VAR\n{body}\nEND_PROGRAM\n")
}

/// Tests have the stack of the server's threads, 2 MiB, and larger frames.
#[test]
fn no_depth_of_nesting_overflows_the_stack() {
    let nested = |open: &str, inner: &str, close: &str| {
        format!("{}{inner}{}", open.repeat(10_000), close.repeat(10_000))
    };
    for text in [
        program(&format!("LD a\nAND ({})\nST a", nested("(", "a", ")"))),
        program(&format!("LD a\n{}ST a", "AND( a\n".repeat(3_000))),
        program(&format!("LD a{}", nested("[a", "0", "]"))),
        program(&format!("LD a{}", ".b".repeat(10_000))),
        program(&format!("CAL t({})", nested("a := (", "", ")"))),
        format!("TYPE t : {}BOOL; END_TYPE\n", "ARRAY [0..1] OF ".repeat(10_000)),
        format!("TYPE t : {} END_TYPE\n", nested("STRUCT a : ", "BOOL;", " END_STRUCT;")),
        format!("PROGRAM p VAR a : t := {}; END_VAR END_PROGRAM\n", nested("(a := ", "1", ")")),
        format!("PROGRAM p VAR a : t := {}; END_VAR END_PROGRAM\n", nested("[", "1", "]")),
        nested("(*", "", "*)"),
    ] {
        ask_everything(&mut open(Notation::IecIl, &text));
    }
    for text in [
        format!("LD X0\n{}OUT Y0\n", "LD X1\nORB\n".repeat(3_000)),
        format!("{}OUT Y0\n", nested("LD X1\n", "", "ANB\n")),
        format!("LD X0\n{}", nested("MPS\n", "OUT Y0\n", "MPP\n")),
        "FOR K2\n".repeat(3_000),
    ] {
        ask_everything(&mut open(Notation::FxIl, &text));
    }
    for text in [
        format!("+--[X0]---+--(Y0)-+\n{}", "+--[X1]---+       |\n".repeat(5_000)),
        format!("+{}-(Y0)-+\n", "-[X0]-".repeat(20_000)),
        format!("+--[X0]---+--(Y0)-+\n{}", "|         +--(Y1)-+\n".repeat(400)),
        format!("+--[X0]---+--(Y0)-+\n{}", "+--[X1]---+       |\n".repeat(400)),
    ] {
        ask_everything(&mut open(Notation::Ladder, &text));
    }
}

/// The least of three times that this thread was given, as other programs run beside.
fn time(mut event: impl FnMut()) -> Duration {
    let once = |_| {
        let started = ThreadTime::now();
        event();
        started.elapsed()
    };
    (0..3).map(once).min().unwrap()
}

/// Eight times the text may take twenty times the time; what is quadratic takes sixty-four times.
fn check_linear(what: &str, text: impl Fn(usize) -> String, event: impl Fn(&str)) {
    let (short, long) = (text(500), text(4_000));
    let (few, many) = (time(|| event(&short)), time(|| event(&long)));
    assert!(many < few * 20, "{what}: {few:?} became {many:?}");
}

#[test]
fn long_declarations_are_read_in_linear_time() {
    let lines = |line: fn(usize) -> String| move |count| (0..count).map(line).collect::<String>();
    let variables = lines(|number| format!("v{number} : BOOL;\n"));
    let unfinished = lines(|number| format!("v{number} : BOOL\n"));
    let tasks = lines(|number| format!("TASK t{number}(INTERVAL := T#1s, PRIORITY := 1);\n"));
    let read = |text: &str| drop(open(Notation::IecIl, text));
    check_linear("variables", |count| format!("PROGRAM p\nVAR\n{}END_VAR\n", variables(count)), read);
    check_linear("unfinished", |count| format!("PROGRAM p\nVAR\n{}END_VAR\n", unfinished(count)), read);
    check_linear("tasks", |count| format!("CONFIGURATION c\n{}END_CONFIGURATION\n", tasks(count)), read);
}

#[test]
fn many_undeclared_variables_are_found_in_linear_time() {
    let text = |count| {
        program(&(0..count).map(|number| format!("LD v{number}\nST w{number}\n")).collect::<String>())
    };
    let judge = |text: &str| {
        let document = open(Notation::IecIl, text);
        check::program(&document, &Severities::default());
    };
    check_linear("undeclared variables", text, judge);
}

/// Drawings in which every line is off, in doubt, crossed or full of names.
#[test]
fn large_rungs_are_judged_in_linear_time() {
    let judge = |text: &str| {
        let document = open(Notation::Ladder, text);
        check::realtime(&document, &Severities::default());
    };
    let rows = |first: &'static str, row: &'static str| {
        move |count: usize| format!("{first}{}", row.repeat(count / row.matches('\n').count()))
    };
    let branches = rows("+--[X0]---+--(Y0)-+\n", "+--[X1]---+       |\n");
    check_linear("branches", branches, judge);
    let ragged = rows("+--[X0]---+--(Y0)-+\n", "+--[X1]----+      |\n+--[X1]--+        |\n");
    check_linear("ragged branches", ragged, judge);
    let doubt = "|   X1      |                      |\n+---| |---+ +                      |\n";
    check_linear("doubts", rows("+---| |---+[ ]+----------------( )-+\n", doubt), judge);
    let words = rows("", "|  X0  X1 X2 | Y0 X3\n+--| |-| |-+-( )-\n");
    check_linear("words", words, judge);
    check_linear("names in the wire", rows("", "|- X0 -| |- Y0 -( )-|\n"), judge);
    let wide = |count: usize| format!("+{}--(Y0)\n", "[X0]--+--".repeat(count / 4));
    check_linear("wide rows", wide, judge);
}

/// Lists that are one rung each, in every form that there is for them.
#[test]
fn large_rungs_are_translated_in_linear_time() {
    let rung = |body: &'static str| move |count: usize| format!("LD X0\n{}OUT Y9\nEND\n", body.repeat(count));
    for body in
        ["AND X1\n", "OR X1\n", "LD X1\nORB\n", "OUT Y0\n", "AND X1\nOUT Y0\n", "AND X1\nOR X2\n", "INV\n"]
    {
        for to in To::ALL {
            check_linear(&format!("{body:?} as {}", to.name()), rung(body), |text| {
                translate(&open(Notation::FxIl, text), None, to, &Options::default());
            });
        }
        check_linear(&format!("{body:?} proved"), rung(body), |text| {
            prove(
                &open(Notation::FxIl, text),
                &open(Notation::FxIl, &text.replace("END", "LD X9\nOUT Y8\nEND")),
            );
        });
    }
}

/// What is larger than a drawing can be is refused at once, in one finding.
#[test]
fn drawings_that_are_too_large_are_refused() {
    for text in [
        format!("+{}--(Y0)\n", "-[X0]-".repeat(17_000)),
        format!("+--[X0]---+--(Y0)-+\n{}", "|         +--[X1]-+\n".repeat(10_000)),
    ] {
        let document = open(Notation::Ladder, &text);
        let found = check::realtime(&document, &Severities::default());
        let codes: Vec<&str> = found.iter().map(|finding| finding.code).collect();
        assert_eq!(codes, ["rung-too-large"]);
    }
}
