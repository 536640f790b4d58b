//! Rules about drawings where a page is too small to show them.

use proptest::prelude::*;
use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::ladder;
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, Severity, TextEdit};

fn found_for(text: &str, model: Model) -> Vec<Diagnostic> {
    let document = Document::new(text, Notation::Ladder, Target::of(model));
    check::realtime(&document, &Severities::default())
}

fn found(text: &str) -> Vec<Diagnostic> {
    found_for(text, Model::Fx2n)
}

/// `code at line:column` of each finding above a hint, or of all.
fn places(text: &str, found: &[Diagnostic]) -> Vec<String> {
    let place = |diagnostic: &Diagnostic| {
        let before = &text[..diagnostic.span.start as usize];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        format!("{} {line}:{column}", diagnostic.code)
    };
    found.iter().filter(|diagnostic| diagnostic.severity != Severity::Hint).map(place).collect()
}

/// Sound drawings of every structure that the rules look at.
const SOUND: &[&str] = &[
    "\
|   X0        X1                           Y0  |
+---| |---+---|/|--------------------------( )-+
|   Y0    |                                    |
+---| |---+                                    |
",
    "\
|   X0        X1        X3                 Y0  |
+---| |---+---| |---+---| |---+------------( )-+
|         |   X2    |         |            Y1  |
|         +---| |---+         +------------( )-+
|         |   X4    |         |                |
|         +---| |---+         +--[MOV K1 D0]---+
",
    "\
|   X0                                     T0 K50|
+---| |---+--------------------------------( )---+
|         |   X1                             Y0  |
|         +---| |---+------------------------( )-+
|                   |                        Y1  |
|                   +------------------------( )-+
",
    "\
┌   X0        X1                           Y0  ┐
├───┤ ├───┬───┤/├──────────────────────────( )─┤
│   Y0    │                                    │
├───┤ ├───┘                                    │
",
];

/// Every mark of `text` that is wire: not a bar of a contact, not a rail in a row of names.
fn wire_cells(text: &str) -> Vec<(usize, char)> {
    let characters: Vec<(usize, char)> = text.char_indices().collect();
    let wire = |at: usize| matches!(characters[at].1, '-' | '+' | '─' | '┬' | '┘');
    let vertical = |at: usize| {
        let near = |at: Option<usize>| at.and_then(|at| characters.get(at)).is_none_or(|c| c.1 == ' ');
        characters[at].1 == '|' && near(at.checked_sub(1)) && near(Some(at + 1)) && near(Some(at + 2))
    };
    (0..characters.len()).filter(|at| wire(*at) || vertical(*at)).map(|at| characters[at]).collect()
}

fn same_logic(one: &str, other: &str) -> bool {
    let read = |text: &str| ladder::parse(text, Target::of(Model::Fx2n));
    let (a, b) = (read(one), read(other));
    a.rungs.len() == b.rungs.len()
        && a.rungs.iter().zip(&b.rungs).all(|(a, b)| a.graph.same_logic(one, &b.graph, other))
}

#[test]
fn a_missing_wire_cell_is_found_and_mended() {
    let mut several = Vec::new();
    let (mut silent, mut worse, mut mended, mut cuts) = (Vec::new(), Vec::new(), 0, 0);
    for text in SOUND {
        assert_eq!(places(text, &found(text)), [""; 0], "{text}");
        for (offset, wire) in wire_cells(text) {
            let mut cut = text.to_string();
            cut.replace_range(offset..offset + wire.len_utf8(), " ");
            cuts += 1;
            let findings = found(&cut);
            let graver =
                |found: &[Diagnostic]| found.iter().filter(|d| d.severity == Severity::Error).count();
            if graver(&findings) == 0 && !same_logic(text, &cut) {
                silent.push(cut.clone());
            }
            if graver(&findings) > 1 {
                several.push(format!("{cut}{:?}", places(&cut, &findings)));
            }
            for fix in findings.iter().flat_map(|diagnostic| &diagnostic.fixes) {
                let fixed = TextEdit::apply_all(&fix.edits, &cut);
                if graver(&found(&fixed)) >= graver(&findings) && graver(&findings) > 0 {
                    worse.push(format!("{cut}{}\n{fixed}", fix.title.render(Language::English)));
                }
                mended += usize::from(same_logic(text, &fixed));
            }
        }
    }
    assert!(silent.is_empty(), "{} cuts are not found:\n{}", silent.len(), silent.join("\n"));
    assert!(worse.is_empty(), "{} fixes do not mend:\n{}", worse.len(), worse.join("\n"));
    assert!(several.is_empty(), "{} cuts are found more than once:\n{}", several.len(), several.join("\n"));
    assert!(mended * 10 > cuts * 9, "{mended} of {cuts} cuts are mended by a fix");
}

/// Drawings with what must be reported in them, in order.
const MISTAKEN: &[(&str, &[&str])] = &[
    // A contact that hangs in the air is one mistake.
    (
        "\
|   X0                                     Y0  |
+---| |------------------------------------( )-+
|                 X1                           |
|              ---| |---                       |
",
        &["open-circuit 4:24"],
    ),
    // Two ends that are far apart are two.
    (
        "\
|   X0                                     Y0  |
+---| |---+--------------------------------( )-+
|   X1    |                                Y1  |
+---| |   +-----------------            ---( )-+
|                  X2                      Y2  |
+------------      | |---------------------( )-+
",
        &["open-circuit 4:7", "open-circuit 4:28", "open-circuit 6:13"],
    ),
    // A stub on a vertical wire, beside a sound branch.
    (
        "\
|   X0                                     Y0  |
+---| |---+--------------------------------( )-+
|         |                                Y1  |
|         +--------------------------------( )-+
|         |                                    |
|         +----                                |
",
        &["open-circuit 6:15"],
    ),
    // Power from the lower line could reach Y0 only backwards through X1, whose right side leads nowhere else.
    (
        "\
|   X0                                     Y0  |
+---| |---+--------------------------------( )-+
|         |   X1                               |
|         +---| |---+                          |
|   X2              |                          |
+---| |-------------+                          |
",
        &["reverse-flow 4:15"],
    ),
    // Both ways out of the dead part lead to the same place: nothing could flow back, a connection is lacking.
    (
        "\
|   X0                                     Y0  |
+---| |-----------------+------------------( )-+
|             X1        |                      |
|         +---| |-------+                      |
|         |   X2        |                      |
|         +---| |-------+                      |
",
        &["open-circuit 4:11"],
    ),
    // A wire past the outputs is a short circuit and nothing else.
    (
        "\
|   X0        X1                           Y0  |
+---| |---+---| |--------------------------( )-+
|         |                                    |
|         +------------------------------------+
",
        &["short-circuit 4:12"],
    ),
    // From rail to rail.
    ("+----------------------------------------------+\n", &["short-circuit 1:2"]),
    // A wire past two branches, the lower of them with a bend.
    (
        "\
|   X0        X1        X3                 Y0  |
+---| |---+---| |---+---| |---+------------( )-+
|         |   X2    |         |                |
|         +---| |---+         |                |
|         |                   |                |
|         +-------------------+                |
",
        &["short-circuit 6:12"],
    ),
    // A branch without an output beside one that has it.
    (
        "\
|   X0        X1                           Y0  |
+---| |---+---| |--------------------------( )-+
|         |   X2                               |
|         +---| |------------------------------+
",
        &["rung-without-output 4:15"],
    ),
    // Instructions that need no condition.
    (
        "+--[FEND]--------------------------------------+\n\n+--[END]---------------------------------------+\n",
        &[],
    ),
    // An output with a condition only in one of its feeds is fed by the rail: the contact is bypassed.
    (
        "\
|   X0                                     Y0  |
+---| |---+--------------------------------( )-+
|         |                                    |
+---------+                                    |
",
        &["short-circuit 4:2"],
    ),
    // A join above the line.
    (
        "\
|   X1                                         |
+---| |---+                                    |
|   X0    |                                Y0  |
+---| |---+--------------------------------( )-+
",
        &["upper-parallel 2:11"],
    ),
    // A bend is no branch.
    (
        "\
|   X0                                         |
+---| |---+                                    |
|         |                                Y0  |
|         +--------------------------------( )-+
",
        &[],
    ),
    // Contacts after an output in two branches are one mistake of that output.
    (
        "\
|   X0        Y0        X1                 Y1  |
+---| |-------( )---+---| |----------------( )-+
|                   |   X2                 Y2  |
|                   +---| |----------------( )-+
",
        &["contact-after-coil 2:25"],
    ),
    // What touches an unreadable cell is not reported as a loose end as well; the rest of the rung is.
    (
        "\
|   X0                                     Y0  |
+---| |-&----+-----------------------------( )-+
|   X1       |                                 |
+---| |--    +---                              |
",
        &["unreadable-cell 2:9", "open-circuit 4:9", "open-circuit 4:17"],
    ),
];

#[test]
fn each_mistake_is_found_once_at_its_cell() {
    let mut wrong = Vec::new();
    for (text, expected) in MISTAKEN {
        let found = places(text, &found(text));
        if found != *expected {
            wrong.push(format!("{text}expected {expected:?}\nfound    {found:?}\n"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn iec_allows_unconditional_outputs_and_contacts_behind_them() {
    let text = "\
|                                          Y0  |
+------------------------------------------( )-+

|   X0        Y1        X1                 Y2  |
+---| |-------( )-------| |----------------( )-+
";
    let errors = |model| places(text, &found_for(text, model));
    assert_eq!(errors(Model::Fx2n), ["coil-at-left-rail 2:44", "contact-after-coil 5:25"]);
    assert!(!errors(Model::Iec).iter().any(|place| place.contains("coil")), "{:?}", errors(Model::Iec));
}

#[test]
fn an_end_needs_nothing_on_any_target() {
    let text = "||------[END]----------------------------------||\n";
    for model in [Model::Fx2n, Model::Iec] {
        assert_eq!(places(text, &found_for(text, model)), [""; 0]);
    }
}

#[test]
fn findings_name_devices_and_point_at_what_belongs_to_them() {
    let text = SOUND[1]
        .replacen("+---| |---+         +--[MOV", "+---------+         +--[MOV", 1)
        .replacen("X4", "  ", 1);
    let findings = found(&text);
    assert_eq!(places(&text, &findings), ["short-circuit 6:12"]);
    let message = findings[0].message.render(Language::English);
    assert_eq!(message, "short circuit: this wire bypasses X1, X2");
    let related: Vec<String> =
        findings[0].related.iter().map(|related| related.message.render(Language::English)).collect();
    assert_eq!(related, ["X1 has no effect", "X2 has no effect"]);
    let [fix] = &findings[0].fixes[..] else { panic!("{:?}", findings[0].fixes) };
    let fixed = TextEdit::apply_all(&fix.edits, &text);
    assert_eq!(places(&fixed, &found(&fixed)), [""; 0], "{fixed}");
}

#[test]
fn rungs_whose_rail_meets_a_corner_above_are_parted_by_a_blank_line() {
    let text = "\
|   X0              X1                       Y0  |
+---| |-----------+-|/|----------------------( )-+
|   X2      Y1    |
+---| |-----( )---+
|   X3      Y2    |
+---| |-----( )---+
";
    for text in [text.to_string(), text.replace('\n', "\r\n")] {
        let findings = found(&text);
        let finding = findings.iter().find(|finding| finding.code == "contact-after-coil").unwrap();
        let [fix] = &finding.fixes[..] else { panic!("{:?}", finding.fixes) };
        assert_eq!(
            fix.title.render(Language::English),
            "Put a blank line between, so that Y1 is in a rung of its own"
        );
        let fixed = TextEdit::apply_all(&fix.edits, &text);
        assert_eq!(fixed.lines().position(str::is_empty), Some(2), "{fixed}");
        assert_eq!(fixed.matches("\r\n").count(), if text.contains('\r') { 7 } else { 0 });
        assert_eq!(places(&fixed, &found(&fixed)), [""; 0], "{fixed}");
    }
    // A contact that is really behind its output stays so, whatever is put between.
    let behind = "|   X0        Y0        X1                     |\n+---| |-------( )-------| |--------------------+\n";
    assert!(found(behind).iter().all(|finding| finding.fixes.is_empty()));
}

/// A rung of `rows` branches with `contacts` contacts each; in `open` ones the lower branches end a cell too early.
fn large(rows: usize, contacts: usize, open: bool) -> String {
    let mut text = String::new();
    for row in 0..rows {
        let names: String = (0..contacts).map(|number| format!("   M{:<4}", (row + number) % 1000)).collect();
        let wires = "---| |--".repeat(contacts);
        let last = if open && row > 0 { ' ' } else { '-' };
        let (bar, name, output) = match row {
            0 => (' ', "Y0", "------------( )-+"),
            _ => ('|', "  ", "                |"),
        };
        text += &format!("|{names} {bar}           {name}   |\n");
        text += &format!("+{wires}{last}+{output}\n");
    }
    text
}

#[test]
fn large_rungs_are_judged_whole() {
    let tall = large(500, 2, false);
    assert_eq!(places(&tall, &found(&tall)), ["rung-too-large 50:5"]);
    let many = large(1000, 10, false);
    assert_eq!(places(&many, &found(&many)), ["rung-too-large 50:5"]);
    let open = large(500, 2, true);
    let findings = found(&open);
    let open = places(&open, &findings);
    let ends = (open.len(), open[0].as_str(), open[498].as_str());
    assert_eq!(ends, (499, "open-circuit 4:17", "open-circuit 1000:17"));
    let wide = large(1, 1200, false);
    assert_eq!(places(&wide, &found(&wide)), ["rung-too-large 2:93"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever is typed: no panic, and all spans and fixes lie within the text.
    #[test]
    fn any_drawing_is_judged(rows in proptest::collection::vec("[-+|/ ()XY0S\\[\\]&─│┼]{0,24}", 0..9)) {
        let text: String = rows.iter().map(|row| format!("|{row}\n")).collect();
        let findings = found(&text);
        for diagnostic in &findings {
            let related = diagnostic.related.iter().map(|related| related.span);
            let edits = diagnostic.fixes.iter().flat_map(|fix| &fix.edits).map(|edit| edit.span);
            for span in std::iter::once(diagnostic.span).chain(related).chain(edits) {
                prop_assert!(text.get(span.range()).is_some(), "{span:?} in {text:?}");
            }
            for fix in &diagnostic.fixes {
                found(&TextEdit::apply_all(&fix.edits, &text));
            }
        }
    }
}

#[test]
fn tabs_are_reported_once_and_all_expanded() {
    let text = "(* a\tcomment *)\n|\tX0\t\tY0\t|\r\n+-------| |-------------( )-----+\r\n\r\n|\t名\tY1\t|\t\n+-------[X1]------------( )-----+";
    let document = Document::new(text, Notation::Ladder, Target::of(Model::Fx2n));
    let all = check::all(&document, &Severities::default());
    let tabs: Vec<&Diagnostic> = all.iter().filter(|found| found.code == "tab-in-drawing").collect();
    let [tab] = tabs[..] else { panic!("{tabs:?}") };
    assert_eq!((tab.severity, tab.span.of(text), tab.span.start), (Severity::Hint, "\t", 17));
    let mended = TextEdit::apply_all(&tab.fixes[0].edits, text);
    let expected = "(* a    comment *)\n|       X0              Y0      |\r\n+-------| |-------------( )-----+\r\n\r\n\
        |       名      Y1      |       \n+-------[X1]------------( )-----+";
    assert_eq!(mended, expected);
    // The same is read from it.
    let codes = |text: &str| {
        let document = Document::new(text, Notation::Ladder, Target::of(Model::Fx2n));
        let all = check::all(&document, &Severities::default());
        all.iter().map(|found| found.code).filter(|code| *code != "tab-in-drawing").collect::<Vec<_>>()
    };
    assert_eq!(codes(&mended), codes(text));
    // In comments, declarations and behind everything else a tab moves nothing.
    for quiet in [
        "(*\ta *)\n--[X0]--(Y0)--\n",
        "--[X0]--(Y0)--\t\n",
        "PROGRAM p\nVAR\n\ta : BOOL;\nEND_VAR\n--[a]--(a)--\nEND_PROGRAM\n",
    ] {
        assert!(!found_in_all(quiet).contains(&"tab-in-drawing"), "{quiet}");
    }
    let list = Document::new("LD\tX0\nOUT\tY0\nEND\n", Notation::FxIl, Target::of(Model::Fx2n));
    assert!(check::all(&list, &Severities::default()).is_empty());
}

fn found_in_all(text: &str) -> Vec<&'static str> {
    let document = Document::new(text, Notation::Ladder, Target::of(Model::Iec));
    check::all(&document, &Severities::default()).iter().map(|found| found.code).collect()
}

#[test]
fn a_name_in_the_wire_is_one_mistake() {
    // The contact that is meant there is a condition.
    let text = "|                          |\n+---X0-----X1-------(Y0)---+\n";
    assert_eq!(places(text, &found(text)), ["stray-operand 2:5", "stray-operand 2:12"]);
}

#[test]
fn every_stray_operand_has_fixes() {
    // The drawing, and what each fix makes of it.
    let cases: &[(&str, &[&str])] = &[
        // Over a wire: a contact, or no name.
        (
            "|   X0      X1         Y0  |\n+---| |----------------( )-+\n",
            &[
                "|   X0      X1         Y0  |\n+---| |-----| |--------( )-+\n",
                "|   X0                 Y0  |\n+---| |----------------( )-+\n",
            ],
        ),
        (
            "│   X0      X1         Y0  │\n├───┤ ├────────────────( )─┤\n",
            &[
                "│   X0      X1         Y0  │\n├───┤ ├─────┤ ├────────( )─┤\n",
                "│   X0                 Y0  │\n├───┤ ├────────────────( )─┤\n",
            ],
        ),
        // Names below their elements.
        (
            "+---| |----------------( )-+\n|   X0      X1         Y0  |\n",
            &[
                "+---| |-----| |--------( )-+\n|   X0      X1         Y0  |\n",
                "+---| |----------------( )-+\n|   X0                 Y0  |\n",
            ],
        ),
        // Far from the one element without a name.
        (
            "|                X1    Y0  |\n+---| |----------------( )-+\n",
            &[
                "|   X1                 Y0  |\n+---| |----------------( )-+\n",
                "|                      Y0  |\n+---| |----------------( )-+\n",
            ],
        ),
        // Over two.
        (
            "|   LONGNAME           Y0  |\n+---| |-| |------------( )-+\n",
            &[
                "|    LONGNAME          Y0  |\n+---| |-| |------------( )-+\n",
                "|                      Y0  |\n+---| |-| |------------( )-+\n",
            ],
        ),
        // What is no device draws no contact.
        (
            "|   X0      K5         Y0  |\n+---| |----------------( )-+\n",
            &["|   X0                 Y0  |\n+---| |----------------( )-+\n"],
        ),
        ("|   X0      K50  |\n+---| |----(M0)--+\n", &["|   X0           |\n+---| |----(M0)--+\n"]),
        ("+--[X0 X1]----(Y0)--+\n", &["+--[X0   ]----(Y0)--+\n"]),
    ];
    for (text, expected) in cases {
        let found = found(text);
        let stray: Vec<_> = found.iter().filter(|problem| problem.code == "stray-operand").collect();
        let made: Vec<String> = stray
            .iter()
            .flat_map(|problem| &problem.fixes)
            .map(|fix| TextEdit::apply_all(&fix.edits, text))
            .collect();
        assert_eq!(made, *expected, "{text}");
        for fix in stray.iter().flat_map(|problem| &problem.fixes) {
            let titles =
                [Language::English, Language::SimplifiedChinese].map(|language| fix.title.render(language));
            assert!(titles[0] != titles[1] && titles.iter().all(|title| !title.contains("stray-operand")));
        }
    }
}

#[test]
fn a_torn_bracket_is_one_mistake() {
    for (text, place) in [
        ("|   X0      Y0\n+---| |-----( -\n", "unreadable-cell 2:13"),
        ("|   X0\n+---| |--[MOV K1 ---------+\n", "unreadable-cell 2:10"),
        ("+---[ ----- [X0]-------(Y0)-+\n", "unreadable-cell 1:5"),
    ] {
        assert_eq!(places(text, &found(text)), [place], "{text}");
    }
}

#[test]
fn mnemonics_of_other_makers_are_one_mistake_each() {
    let text = "|--[XOC X0]---[XIA X1]---(OTX Y0)---|\n";
    let expected = ["unknown-instruction 1:5", "unknown-instruction 1:16", "unknown-instruction 1:27"];
    assert_eq!(places(text, &found(text)), expected);
}

/// A rung in which each of `levels` branches begins behind the one around it: as many blocks wait, and two more.
fn branches_in_branches(levels: usize) -> String {
    let mut row = String::from("+");
    let mut starts = Vec::new();
    for level in 0..=levels {
        row += &format!("-----[X{}]-----", level % 8);
        if level < levels {
            starts.push(row.len());
            row.push('+');
        }
    }
    let mut ends = Vec::new();
    for _ in 0..levels {
        ends.insert(0, row.len());
        row += "+--";
    }
    row += "--(Y0)--";
    let mut lines = vec![row.clone()];
    for level in (0..levels).rev() {
        let (start, end) = (starts[level], ends[level]);
        let mut line = vec![' '; row.len()];
        (0..level).for_each(|outer| (line[starts[outer]], line[ends[outer]]) = ('|', '|'));
        line[start..=end].fill('-');
        (line[start], line[end]) = ('+', '+');
        "--[M0]--[M1]".chars().enumerate().for_each(|(at, c)| line[start + 1 + at] = c);
        lines.push(line.into_iter().collect::<String>().trim_end().to_string());
    }
    lines.join("\n") + "\n"
}

#[test]
fn branches_in_branches_are_counted_as_the_blocks_that_they_become() {
    let codes = |levels| {
        let text = branches_in_branches(levels);
        let found: Vec<String> = found(&text).iter().map(|finding| finding.code.to_string()).collect();
        // The branches repeat each other, which is another matter.
        let others = ["rung-too-large", "redundant-branch"];
        found.into_iter().filter(|code| !others.contains(&code.as_str())).collect::<Vec<_>>()
    };
    assert_eq!(codes(6), Vec::<String>::new());
    assert_eq!(codes(7), ["nesting-too-deep"]);
    let iec = found_for(&branches_in_branches(7), Model::Iec);
    assert!(iec.iter().all(|finding| finding.code != "nesting-too-deep"), "{iec:?}");
}

#[test]
fn outputs_in_branches_are_counted_as_the_mps_that_they_become() {
    // Each branch with a contact of its own but the last keeps the result before it.
    let rung = |levels: usize| {
        let mut text = String::from("+-[X0]-+");
        (0..levels).for_each(|_| text += "-[X1]-+");
        text += "-[X2]--(Y0)\n";
        for level in (0..=levels).rev() {
            let bars: String = (0..level).map(|_| "|      ").collect();
            text += &format!("       {bars}+-[X3]--(Y{})\n", level % 8);
        }
        text
    };
    let deep = |levels| found(&rung(levels)).iter().any(|finding| finding.code == "nesting-too-deep");
    assert!(!deep(10), "{}", rung(10));
    assert!(deep(11), "{}", rung(11));
}

#[test]
fn a_contact_behind_a_coil_is_a_hint_where_the_language_allows_it() {
    let text = "|   a         y         b         z  |\n+---| |-------( )-------| |-------( )-+\n";
    let severity = |model| {
        let found = found_for(text, model);
        found.iter().find(|finding| finding.code == "contact-after-coil").map(|finding| finding.severity)
    };
    assert_eq!(severity(Model::Iec), Some(Severity::Hint));
    assert_eq!(severity(Model::Fx3u), Some(Severity::Error));
}
