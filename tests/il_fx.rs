//! FX instruction list: split, parse, format.

// Clippy takes functions beside tests for production code.
#![allow(clippy::unwrap_used, clippy::panic)]

use proptest::prelude::*;
use rungwise::il::fx::{FxTree, LineKind, WordKind, format, format_chunk, parse, split, steps};
use rungwise::target::{Constant, Model, Operand, Target};
use rungwise::text::{Language, Span, TextEdit};
use std::fmt::Write;

fn fx3u() -> &'static Target {
    Target::of(Model::Fx3u)
}

/// Parses `text` as one chunk and compares the dump, a line for each record, comment and problem in that order.
#[track_caller]
fn check(text: &str, expected: &str) {
    let tree = parse(text, fx3u());
    well_formed(text, &tree);
    let expected: Vec<&str> = expected.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let dump = dump(text, &tree, true);
    let dump: Vec<&str> = dump.iter().map(|line| line.trim_end()).collect();
    assert_eq!(dump, expected, "of {text:?}");
}

fn dump(text: &str, tree: &FxTree, with_steps: bool) -> Vec<String> {
    let mut lines = Vec::new();
    for line in &tree.lines {
        let mut row = String::new();
        if let Some(step) = line.step.filter(|_| with_steps) {
            write!(row, "#{} ", step.value).unwrap();
        }
        match line.kind {
            LineKind::Instruction(form) => row += &form.mnemonic(),
            LineKind::Label(device) => write!(row, "{device}:").unwrap(),
            LineKind::Unknown => write!(row, "?{}", line.mnemonic.of(text)).unwrap(),
        }
        for operand in tree.operands(line) {
            row += " ";
            row += &operand_dump(&operand.value, operand.span.of(text));
        }
        lines.push(row);
    }
    lines.extend(tree.comments.iter().map(|comment| format!("comment {}", comment.of(text).trim_end())));
    lines.extend(
        tree.problems.iter().map(|problem| {
            format!("{} {} at {}", problem.code, problem.message.key(), problem.span.of(text))
        }),
    );
    lines
}

fn operand_dump(operand: &Operand, word: &str) -> String {
    let index = |index: &Option<_>| {
        index.map_or(String::new(), |index: rungwise::target::Device| format!("+{index}"))
    };
    match operand {
        Operand::Device(device) => device.to_string(),
        Operand::Indexed { device, index } => format!("{device}+{index}"),
        Operand::Nibbles { digits, first, index: by } => format!("{digits}x4({first}){}", index(by)),
        Operand::WordBit { word, bit } => format!("{word}.bit{bit}"),
        Operand::Constant { value: Constant::Decimal(value), index: by } => format!("{value}{}", index(by)),
        Operand::Constant { value: Constant::Hexadecimal(value), index: by } => {
            format!("{value:#x}{}", index(by))
        }
        Operand::Constant { value: Constant::Real(value), index: by } => format!("{value:?}{}", index(by)),
        Operand::Text => format!("text({word})"),
        Operand::Invalid(_) => format!("invalid({word})"),
        other => panic!("not an FX operand: {other:?}"),
    }
}

/// What holds for every text: spans within it, on character boundaries, records in order, no operand of nobody.
#[track_caller]
fn well_formed(text: &str, tree: &FxTree) {
    let inside = |span: Span| {
        assert!(span.start <= span.end && text.get(span.range()).is_some(), "{span:?} of {text:?}");
    };
    let mut end = 0;
    let mut operand_end = 0;
    for line in &tree.lines {
        for span in [line.span, line.mnemonic].into_iter().chain(line.step.map(|step| step.span)) {
            inside(span);
        }
        assert!(!line.mnemonic.is_empty(), "{text:?}");
        assert!(end <= line.step.map_or(line.span.start, |step| step.span.start), "{text:?}");
        assert_eq!(line.operands.0, operand_end, "{text:?}");
        operand_end = line.operands.1;
        end = line.mnemonic.end;
        for operand in tree.operands(line) {
            inside(operand.span);
            assert!(end <= operand.span.start && !operand.span.is_empty(), "{text:?}");
            end = operand.span.end;
        }
        assert_eq!((line.span.start, line.span.end), (line.mnemonic.start, end), "{text:?}");
    }
    assert_eq!(operand_end as usize, tree.operands.len());
    tree.comments.iter().for_each(|comment| inside(*comment));
    assert!(tree.comments.is_sorted_by(|a, b| a.end <= b.start));
    for problem in &tree.problems {
        inside(problem.span);
        let words = problem.message.render(Language::English);
        assert!(!words.contains(problem.message.key()) && !words.contains("{word}"), "{words}");
        problem.fixes.iter().flat_map(|fix| &fix.edits).for_each(|edit| inside(edit.span));
    }
    let words: Vec<Span> = tree.words().map(|word| word.span).collect();
    assert!(words.is_sorted_by(|a, b| a.end <= b.start), "{words:?} of {text:?}");
    for (line, operand) in
        tree.lines.iter().flat_map(|line| tree.operands(line).iter().map(move |o| (line, o)))
    {
        let (at, place) = tree.operand_at(operand.span.start as usize).unwrap();
        assert_eq!((at, tree.operands[place].span), (line, operand.span));
    }
}

mod reading {
    use super::*;

    #[test]
    fn blanks_commas_and_letter_case() {
        check("LD X0\nOUT Y0", "LD X0\nOUT Y0");
        check("ld x0\r\nout y0\r\n", "LD X0\nOUT Y0");
        check("\tMOV\tk10\t d0  \n", "MOV 10 D0");
        check("MOV K10,D0", "MOV 10 D0");
        check("MOV K10 , D0 ", "MOV 10 D0");
        check("LD X001\rOUT Y017", "LD X1\nOUT Y17");
        check("\u{feff}LD X0", "LD X0");
        check("", "");
        check(" \t\r\n\n", "");
    }

    #[test]
    fn every_kind_of_operand() {
        check("MOV H0F D0Z1", "MOV 0xf D0+Z1");
        check("MOV K-5 K4M0", "MOV -5 4x4(M0)");
        check("DMOV K4M0Z2 D10", "DMOV 4x4(M0)+Z2 D10");
        check("LD D0.3", "LD D0.bit3");
        check("DEADD E47.82 E1.5+3 D5", "DEADD 47.82 1500.0 D5");
        check("MC N0 M100", "MC N0 M100");
        check("CJ P5", "CJ P5");
    }

    #[test]
    fn text_operands() {
        check("ASC \"ABCD; (*\" D300", "ASC text(\"ABCD; (*\") D300");
        check("ASC 'AB' D300", "ASC text('AB') D300");
        check("ASC X0 D300", "ASC text(X0) D300");
        check(
            "ASC \"AB D300\nEND",
            "ASC text(\"AB D300)\nEND\nsyntax-error fx-syntax.open-text at \"AB D300",
        );
    }

    #[test]
    fn comparing_contacts() {
        for text in ["LD= D0 K5", "LD=D0 K5", "LD =D0,K5", "ld = D0 K5", "LD=\tD0 K5"] {
            check(text, "LD= D0 5");
        }
        check("LDD= D0 K5", "LDD= D0 5");
        check("ANDD>=D0 K5", "ANDD>= D0 5");
        check("OR<> D0 K5", "OR<> D0 5");
        check("AND < D0 K5", "AND< D0 5");
        check("LD=< D0 K5", "?LD=< D0 5");
        check("MOV = D0", "MOV D0\nsyntax-error fx-syntax.unexpected at =");
        check("LD D0=K5", "LD D0 5\nsyntax-error fx-syntax.unexpected at =");
    }

    #[test]
    fn comments() {
        check(
            "; all\nLD X0 ; a // b\nOUT Y0// c",
            "LD X0\nOUT Y0\ncomment ; all\ncomment ; a // b\ncomment // c",
        );
        check("(* a *) LD (* b *) X0 (*c*)", "LD X0\ncomment (* a *)\ncomment (* b *)\ncomment (*c*)");
        check("(**)LD X0", "LD X0\ncomment (**)");
        check("; (* no comment\nLD X0", "LD X0\ncomment ; (* no comment");
        let text = "LD X0 (* two\nlines *) OUT Y0\n";
        assert_eq!(
            dump(text, &parse(text, fx3u()), true),
            ["LD X0", "OUT Y0", "comment (* two\nlines *)"],
            "a comment over lines ends the line"
        );
    }

    #[test]
    fn a_comment_that_is_never_closed() {
        let text = "LD X0 (* why\nOUT Y0";
        let tree = parse(text, fx3u());
        let problem = &tree.problems[0];
        assert_eq!((problem.code, problem.span), ("unclosed-comment", Span::new(6, 8)));
        let mended = TextEdit::apply_all(&problem.fixes[0].edits, text);
        check(&mended, "LD X0\nOUT Y0\ncomment (* why *)");
    }

    #[test]
    fn labels() {
        check("P0\nLD X0", "P0:\nLD X0");
        check("P0:\nLD X0", "P0:\nLD X0");
        check("p1: LD X0", "P1:\nLD X0");
        check("I001 LD X0", "I001:\nLD X0");
        check("P0", "P0:");
        check("P0 : :", "P0:\nsyntax-error fx-syntax.instruction-expected at :");
        check("PX", "?PX");
    }

    #[test]
    fn step_numbers() {
        check("0 LD X0\n0001\tOUT Y0\n 2 P0\n3 P1 4 LD X0", "#0 LD X0\n#1 OUT Y0\n#2 P0:\n#3 P1:\n#4 LD X0");
        check("12", "syntax-error fx-syntax.step-alone at 12");
        check("99999999999 LD X0", "LD X0\nsyntax-error fx-syntax.step-too-large at 99999999999");
        check("1 2 LD X0", "#1 ?2\nLD X0\nsyntax-error fx-syntax.second-instruction at LD");
    }

    #[test]
    fn unknown_words_stay_records() {
        check("LDX0\nFOO X0 é", "?LDX0\n?FOO X0 invalid(é)");
        check("LD Q7", "LD invalid(Q7)");
        check("LD X8", "LD invalid(X8)");
    }

    #[test]
    fn two_instructions_on_a_line() {
        let text = "LD X0 OUT Y0";
        check(text, "LD X0\nOUT Y0\nsyntax-error fx-syntax.second-instruction at OUT");
        let problem = &parse(text, fx3u()).problems[0];
        assert_eq!(TextEdit::apply_all(&problem.fixes[0].edits, text), "LD X0\nOUT Y0");
        check("LD X0, AND= D0 K1\r\n", "LD X0\nAND= D0 1\nsyntax-error fx-syntax.second-instruction at AND");
    }

    #[test]
    fn commas_out_of_place() {
        check("MOV K1,,D0", "MOV 1 D0\nsyntax-error fx-syntax.nothing-before-comma at ,");
        check("MOV,K1 D0", "MOV 1 D0\nsyntax-error fx-syntax.nothing-before-comma at ,");
        check("LD X0,\nOUT Y0", "LD X0\nOUT Y0\nsyntax-error fx-syntax.nothing-after-comma at ,");
        check(", LD X0", "LD X0\nsyntax-error fx-syntax.instruction-expected at ,");
        check("= D0 K5\nEND", "END\nsyntax-error fx-syntax.instruction-expected at =");
    }

    #[test]
    fn characters_that_no_word_contains() {
        check("LD X(0)", "LD invalid(X(0))");
        check("LDé X0", "?LDé X0");
        check("\0\0 LD X0", "LD X0\nsyntax-error fx-syntax.stray at \0\0");
        check("LD\u{3000}X0", "LD X0\nsyntax-error fx-syntax.wide-blank at \u{3000}");
        let nulls = "\0".repeat(100);
        let problems = parse(&nulls, fx3u()).problems;
        assert_eq!((problems.len(), problems[0].span), (1, Span::new(0, 100)));
        let words = problems[0].message.render(Language::English);
        assert!(words.starts_with("`U+0000U+0000") && words.len() < 200, "{words}");
        let text = "MOV K1，D0";
        let problem = &parse(text, fx3u()).problems[0];
        assert_eq!(problem.message.key(), "fx-syntax.wide-character");
        check(&TextEdit::apply_all(&problem.fixes[0].edits, text), "MOV 1 D0");
    }

    #[test]
    fn positions() {
        let text = "0 P0: LD X0 ; a\nMOV K1 D0";
        let tree = parse(text, fx3u());
        let words: Vec<(&str, &str)> = tree
            .words()
            .map(|word| {
                let kind = match word.value {
                    WordKind::Step => "step",
                    WordKind::Mnemonic(LineKind::Label(_)) => "label",
                    WordKind::Mnemonic(_) => "mnemonic",
                    WordKind::Operand(_) => "operand",
                    WordKind::Comment => "comment",
                };
                (kind, word.span.of(text))
            })
            .collect();
        let expected = [
            ("step", "0"),
            ("label", "P0"),
            ("mnemonic", "LD"),
            ("operand", "X0"),
            ("comment", "; a"),
            ("mnemonic", "MOV"),
            ("operand", "K1"),
            ("operand", "D0"),
        ];
        assert_eq!(words, expected);
        assert_eq!(tree.line_at(6).unwrap().mnemonic.of(text), "LD");
        assert_eq!(tree.line_at(9).unwrap().mnemonic.of(text), "LD");
        assert_eq!(tree.line_at(11).unwrap().mnemonic.of(text), "LD");
        assert_eq!(tree.line_at(13), None);
        assert_eq!(tree.line_before(13).unwrap().mnemonic.of(text), "LD");
        assert_eq!(tree.comment_at(13).unwrap().of(text), "; a");
        assert_eq!(tree.comment_at(12).unwrap().of(text), "; a");
        assert_eq!(tree.comment_at(11), None);
        assert_eq!(tree.operand_at(21).unwrap().1, 1);
        assert_eq!(tree.line_before(0), None);
    }

    #[test]
    fn program_steps() {
        let tree = parse("P0\nLD X0\nMOV K1 D0\nOUT T0 K5\nFOO\nEND", fx3u());
        assert_eq!(steps(&tree), 1 + 1 + 5 + 3 + 1);
    }

    #[test]
    fn programs_of_other_people_read_without_problems() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/corpus/fx");
        let Ok(files) = std::fs::read_dir(folder) else {
            crate::corpus::say_skipped(&format!("no {folder}"));
            return;
        };
        for file in files {
            let path = file.unwrap().path();
            let text = std::fs::read_to_string(&path).unwrap();
            let tree = parse(&text, fx3u());
            well_formed(&text, &tree);
            assert_eq!(tree.problems, [], "{}", path.display());
            let dump = dump(&text, &tree, true);
            assert!(!dump.iter().any(|line| line.starts_with('?') || line.contains("invalid(")), "{dump:#?}");
            let code = text.lines().filter(|line| !line.starts_with(';')).count();
            assert_eq!(tree.lines.len(), code, "{}", path.display());
            formats_well(&text);
            splits_well(&text);
        }
    }
}

mod rungs {
    use super::*;

    /// `text` has a line `--` where a boundary must be, and nowhere else.
    #[track_caller]
    fn check_split(text: &str) {
        let parts: Vec<&str> = text.split("--\n").collect();
        let whole = parts.concat();
        let mut start = 0;
        let chunks: Vec<&str> =
            split(&whole).into_iter().map(|end| &whole[std::mem::replace(&mut start, end)..end]).collect();
        assert_eq!(chunks, parts);
        splits_well(&whole);
    }

    #[test]
    fn a_load_behind_an_output() {
        check_split("LD X0\nOR Y0\nANI X1\nOUT Y0\n--\nLD X1\nOUT Y1\nOUT Y2\n--\nEND\n");
        check_split("ld x0\nout y0\n--\nld= d0 k1\nout y1\n--\nLD <> D0 K1\nOUT Y2\n--\nLDD>= D0 K1\nSET M0");
        assert_eq!(split(""), Vec::<usize>::new());
        assert_eq!(split("\n"), [1]);
    }

    #[test]
    fn comments_and_blank_lines_go_with_the_rung_behind() {
        check_split("; head\n\nLD X0\nOUT Y0 ; a\n--\n\n; b\n(* c\nLD X9\n*)\nLD X1\nOUT Y1\n; tail\n");
        check_split("LD X0\r\nOUT Y0\r\n--\nLD X1\rOUT Y1\r--\nLD X2\rOUT Y2");
    }

    #[test]
    fn contacts_and_branches_continue() {
        check_split(
            "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nLD X2\nOR X3\nANB\nOUT Y1\nMPP\nOUT Y2\n--\nLD X4\nOUT Y3\n",
        );
        check_split("LD X0\nLD X1\nORB\nLDI X2\nOR X3\nANB\nOUT Y0\n");
        check_split("LD X0\nOUT Y0\nAND X1\nOUT Y1\n--\nLD X0\nOUT Y2\n");
        check_split("LD X0\nNOP\nOUT Y0\n--\nNOP\nLD X1\nOUT Y1\n");
    }

    #[test]
    fn a_block_that_the_rung_before_loaded() {
        check_split("LD X0\nOUT Y0\nLD X5\nOR X6\nANB\nOUT Y1\n--\nLD X7\nOUT Y7\n");
        check_split("LD X0\nOUT Y0\n--\nLD X1\nLD X2\nORB\nOUT Y1\n");
        check_split("LD X0\nOUT Y0\n--\nLD X1\nOUT Y1\nLD X2\nORB\nOUT Y2\n");
    }

    #[test]
    fn labels_steps_and_instructions_without_contacts() {
        check_split(
            "LD X0\nCALL P0\n--\nFEND\n--\nP0\nLD X1\nOUT Y0\n--\nP1: LD X2\nOUT Y1\n--\nSRET\n--\nEND\n",
        );
        check_split(
            "LD M8002\nSET S0\n--\nSTL S0\nOUT Y0\n--\nLD X0\nSET S20\n--\nSTL S20\nLD X1\nOUT Y1\n--\nRET\n",
        );
        check_split("FOR K5\n--\nLD X0\nINC D0\n--\nNEXT\n--\nMCR N0\n--\nMCR N1\n");
        check_split("0 LD X0\n1 OUT Y0\n--\n2 P0\n3 LD X0\n4 OUT Y1\n--\n5 END\n");
    }

    #[test]
    fn what_cannot_be_read() {
        check_split("LD X0\nFOO\n--\nLD X1\nOUT Y1\n");
        check_split("LD X0\nOUT Y0 (* open\nLD X1\nOUT Y1\n");
        check_split("LD X0\nASC \"a(*\" D0\n--\nLD X1\nOUT Y1 ; (*\n--\nLD X2\nOUT Y2\n");
        check_split("LD X0\nOUT Y0\n--\n\u{feff}LD X1\n");
        check_split("LD X0\nOUT Y0\n--\n= D0\nLD X1\n");
    }
}

mod printing {
    use super::*;

    #[track_caller]
    fn check_format(text: &str, expected: &str) {
        assert_eq!(TextEdit::apply_all(&format(text, fx3u()), text), expected);
        formats_well(text);
    }

    #[test]
    fn words() {
        check_format("  ld   x0\n\tmov k10 , d0\n", "LD X0\nMOV K10 D0\n");
        check_format("ld =d0,k5\nASC \"abc\" d0", "LD= D0 K5\nASC \"abc\" D0\n");
        check_format("LD X0\nOUT Y0\n", "LD X0\nOUT Y0\n");
        assert_eq!(format("LD X0\nOUT Y0\n", fx3u()), []);
        check_format("", "");
    }

    #[test]
    fn comments_in_one_column_for_each_rung() {
        check_format(
            "   ; head  \nLD X0 ; a\nMOV K100 D0 // b \nOUT Y0\n  LD X1;c\nOUT Y1 (* d *) ;e\n",
            "; head\nLD X0       ; a\nMOV K100 D0 // b\nOUT Y0\nLD X1  ;c\nOUT Y1 (* d *) ;e\n",
        );
        check_format("ASC \"电机\" D0 ; a\nOUT Y0 ; b\n", "ASC \"电机\" D0 ; a\nOUT Y0        ; b\n");
    }

    #[test]
    fn labels_and_blank_lines() {
        check_format(
            "\n\n\nLD X0\nOUT Y0\n \n\n  p1: ld x1\nOUT Y1\n\n\n",
            "\nLD X0\nOUT Y0\n\nP1\nLD X1\nOUT Y1\n",
        );
        check_format(" \n ", "");
    }

    #[test]
    fn line_ends_stay() {
        check_format("ld x0\r\nout y0", "LD X0\r\nOUT Y0\r\n");
        check_format("\u{feff}ld x0\nout y0\r\n", "\u{feff}LD X0\nOUT Y0\r\n");
    }

    #[test]
    fn lines_that_it_does_not_understand_stay() {
        check_format("  foo  x0\nld q7  \n", "  foo  x0\nld q7  \n");
        check_format(" ld x0  out y0\n", " ld x0  out y0\n");
        check_format(" (* a *) ld x0\nld (* b *)  x0\n", " (* a *) ld x0\nld (* b *)  x0\n");
        check_format("ld x0 (* a\n b *)\n", "ld x0 (* a\n b *)\n");
        check_format("ld x0\n  (* open", "LD X0\n  (* open");
    }

    #[test]
    fn step_numbers() {
        check_format("0 ld x0\nOUT Y0\n12 end\n", " 0 LD X0\nOUT Y0\n12 END\n");
        let listing = "0 LD X0\n1 MOV K1 D0\n2 LD X1\n9 OUT T0 K5\n7 P0\n8 END\n";
        check_format(listing, " 0 LD X0\n 1 MOV K1 D0\n 6 LD X1\n 7 OUT T0 K5\n10 P0\n11 END\n");
    }

    #[test]
    fn one_chunk() {
        let text = "ld x0\nout y0";
        assert_eq!(format_chunk(text, &parse(text, fx3u()), &Default::default()), "LD X0\nOUT Y0\n");
    }
}

/// Formatting keeps the tree (step numbers of a listing aside) and is done after one time.
#[track_caller]
fn formats_well(text: &str) {
    let formatted = TextEdit::apply_all(&format(text, fx3u()), text);
    let (before, after) = (parse(text, fx3u()), parse(&formatted, fx3u()));
    assert_eq!(dump(&formatted, &after, false), dump(text, &before, false), "{text:?} became {formatted:?}");
    let again = TextEdit::apply_all(&format(&formatted, fx3u()), &formatted);
    assert_eq!(again, formatted, "formatting twice {text:?}");
}

/// The text behind a boundary splits as it does in the whole.
#[track_caller]
fn splits_well(text: &str) {
    let ends = split(text);
    assert!(ends.is_sorted_by(|a, b| a < b), "{text:?}");
    assert_eq!(ends.last().copied().unwrap_or(0), text.len(), "{text:?}");
    let mut start = 0;
    for (place, &end) in ends.iter().enumerate() {
        assert_eq!(split(&text[start..end]), [end - start], "{text:?}");
        if place < 20 {
            let rest: Vec<usize> = split(&text[start..]).into_iter().map(|end| end + start).collect();
            assert_eq!(rest, ends[place..], "behind {start} of {text:?}");
        }
        start = end;
    }
}

/// The boundaries of `new`, made from those of the text before by splitting a window, and the number of windows.
fn split_again(old: &[usize], edit: Span, new: &str, inserted: usize) -> (Vec<usize>, usize) {
    let moved = |offset: usize| offset + inserted - edit.len();
    let edited_end = edit.start as usize + inserted;
    let first_touched = old.partition_point(|end| *end < edit.start as usize);
    let last_touched = old.iter().rposition(|end| *end <= edit.end as usize).map_or(0, |last| last + 1);
    let first = first_touched.saturating_sub(1);
    let start = first.checked_sub(1).map_or(0, |before| old[before]);
    for (tries, reach) in (0..).map(|power| (power + 1, 1 << power)) {
        let last = last_touched + reach;
        let to_the_end = last + 1 >= old.len();
        let end = if to_the_end { new.len() } else { moved(old[last]) };
        let window: Vec<usize> = split(&new[start..end]).into_iter().map(|end| end + start).collect();
        let is_old = |&&x: &&usize| {
            // The position that it had before; the text from there on is the same.
            let before = (x + edit.len()).checked_sub(inserted);
            x >= edited_end && x < end && before.is_some_and(|before| old.binary_search(&before).is_ok())
        };
        let same_from = if to_the_end { None } else { window.iter().find(is_old).copied() };
        if to_the_end || same_from.is_some() {
            let mut ends = old[..first].to_vec();
            ends.extend(window.iter().filter(|end| same_from.is_none_or(|same| **end <= same)));
            if let Some(same) = same_from {
                let behind = old.iter().filter(|end| **end >= edit.end as usize);
                ends.extend(behind.map(|end| moved(*end)).filter(|end| *end > same));
            }
            return (ends, tries);
        }
    }
    unreachable!()
}

#[test]
fn a_usual_edit_needs_one_window() {
    let text = "LD X0\nOR Y0\nOUT Y0\n".repeat(50);
    let old = split(&text);
    assert_eq!(old.len(), 50);
    for (edit, by) in
        [(Span::new(500, 501), "1"), (Span::new(513, 513), "AND X5\n"), (Span::new(513, 513), "; a\n")]
    {
        let new = TextEdit::apply_all(&[TextEdit::new(edit, by)], &text);
        let (ends, windows) = split_again(&old, edit, &new, by.len());
        assert_eq!((ends, windows), (split(&new), 1), "{by}");
    }
}

/// Pieces from which half-sensible texts are made.
fn piece() -> impl Strategy<Value = &'static str> {
    let words = prop::sample::select(vec![
        "LD X0",
        "ld x1",
        "LDI M0",
        "LD=",
        "LD = D0 K1",
        "AND X2",
        "OR Y0",
        "ANI T0",
        "ANB",
        "ORB",
        "MPS",
        "MRD",
        "MPP",
        "INV",
        "OUT Y0",
        "OUT T0 K50",
        "SET S20",
        "STL S20",
        "RET",
        "END",
        "FEND",
        "NOP",
        "P0",
        "P1:",
        "I001",
        "MOV K10,D0",
        "MOV K4M0 D0Z1",
        "ASC \"a;(*b\" D0",
        "ASC abc D0",
        "MC N0 M1",
        "MCR N0",
        "FOR K2",
        "NEXT",
        "FOO",
        "X0",
        "K5",
        "D0.3",
        "E1.5",
        "X8",
        "12",
    ]);
    let signs = prop::sample::select(vec![
        " ",
        "\t",
        ",",
        ":",
        "=",
        "<>",
        ";",
        "//",
        "(*",
        "*)",
        "(",
        ")",
        "/",
        "*",
        "\"",
        "'",
        "\0",
        "é",
        "\u{3000}",
        "，",
        "\u{feff}",
        "; c",
        "// d  ",
        "(* e *)",
        "(* f\n g *)",
        "\r",
    ]);
    let line_ends = prop::sample::select(vec!["\n", "\n", "\n", "\n\n", "\r\n"]);
    prop_oneof![4 => words, 2 => signs, 4 => line_ends]
}

fn rough_text() -> impl Strategy<Value = String> {
    prop::collection::vec(piece(), 0..60).prop_map(|pieces| pieces.concat())
}

/// Rungs as people write them, with a comment or a blank line here and there.
fn program() -> impl Strategy<Value = String> {
    let rung = prop::sample::select(vec![
        "LD X0\nOR Y0\nANI X1\nOUT Y0 ; motor\n",
        "\n; lamp\nLD X2\nOUT Y1\nOUT Y2\n",
        "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nANI X1\nOUT Y1\n",
        "LD X0\nLD X1\nORB\nLD X2\nOR X3\nANB\nOUT M0\n",
        "LD X0\nOUT Y0\nLD X5\nOR X6\nANB\nOUT Y1\n",
        "(* two\n lines *)\nLD> D0 K10\nMOV K1 D0\n",
        "STL S20\nOUT Y5\nLD X1\nSET S21\n",
        "P0\nLD X1\nOUT Y7\nSRET\n",
        "LD M8000\nNOP\nOUT M5\r\n\r\n",
        "FEND\n",
    ]);
    prop::collection::vec(rung, 1..25).prop_map(|rungs| rungs.concat())
}

fn at_boundary(text: &str, part: prop::sample::Index) -> usize {
    let mut offset = part.index(text.len() + 1);
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_read(text in any::<String>()) {
        well_formed(&text, &parse(&text, fx3u()));
        splits_well(&text);
        formats_well(&text);
    }

    #[test]
    fn any_rough_text_is_read(text in rough_text()) {
        well_formed(&text, &parse(&text, fx3u()));
        splits_well(&text);
        formats_well(&text);
    }

    #[test]
    fn chunks_are_read_as_the_whole(text in rough_text()) {
        let mut start = 0;
        let mut parts = Vec::new();
        for end in split(&text) {
            let chunk = &text[start..end];
            let tree = parse(chunk, fx3u());
            parts.extend(tree.lines.iter().map(|line| line.span.of(chunk).to_string()));
            start = end;
        }
        let tree = parse(&text, fx3u());
        let whole: Vec<String> = tree.lines.iter().map(|line| line.span.of(&text).to_string()).collect();
        prop_assert_eq!(parts, whole);
    }

    #[test]
    fn a_window_splits_as_the_whole(
        start in prop_oneof![program(), rough_text()],
        edits in prop::collection::vec(
            (any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..12usize, piece(), piece()), 1..8),
    ) {
        let mut text = start;
        let mut ends = split(&text);
        for (from, to, length, first, second) in edits {
            let from = at_boundary(&text, from);
            let to = if length == 0 { at_boundary(&text, to).max(from) } else { from };
            let mut until = (to + length - 1.min(length)).min(text.len());
            while !text.is_char_boundary(until) {
                until += 1;
            }
            let edit = Span::new(from, until);
            let by = [first, second].concat();
            let new = TextEdit::apply_all(&[TextEdit::new(edit, by.clone())], &text);
            ends = split_again(&ends, edit, &new, by.len()).0;
            prop_assert_eq!(&ends, &split(&new), "{:?} became {:?}", text, new);
            text = new;
        }
    }
}
