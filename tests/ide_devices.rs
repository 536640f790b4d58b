//! What editors show about devices: uses, comments, free numbers, lenses, marks, the list of used devices.

use rungwise::check::{self, Severities};
use rungwise::document::{Comments, Document, Member, Notation, ProjectView};
use rungwise::ide::{self, HighlightKind, LensKind, LensSettings, Style};
use rungwise::project::{CommentsFile, FormatStyle};
use rungwise::target::{Model, Target};
use rungwise::text::{Language, Span, TextEdit};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const EN: Language = Language::English;
const TABLE: &str =
    "X0,Start,green button\nY0,Motor,\"contactor, main\"\nM7,,reserve\nT0,Delay,\nX3,Spare,spare sensor\n";

fn fx2n() -> &'static Target {
    Target::of(Model::Fx2n)
}

fn table() -> Arc<Comments> {
    CommentsFile::read(Path::new("devices.csv"), TABLE, fx2n()).comments
}

fn fx(text: &str) -> Document {
    Document::new(text, Notation::FxIl, fx2n())
}

/// With the table of symbols and comments.
fn known(text: &str, notation: Notation) -> Document {
    Document::with_comments(text, notation, fx2n(), table())
}

/// The hover on the first `word` of `document`.
fn hover(document: &Document, word: &str) -> String {
    let offset = document.text().find(word).expect("the word");
    ide::hover(document, offset, EN).expect("a hover").markdown
}

fn labels(document: &Document, offset: usize) -> Vec<String> {
    let mut found = ide::completions(document, offset, EN);
    found.sort_by_key(|proposal| proposal.rank);
    found.into_iter().map(|proposal| proposal.label).collect()
}

/// The proposals at `$0`, in the order of the list.
fn proposed(text: &str) -> Vec<String> {
    let document = fx(&text.replace("$0", ""));
    labels(&document, text.find("$0").unwrap())
}

#[test]
fn a_hover_says_symbol_comment_and_who_writes_and_reads() {
    let document = known("LD Start\nOUT Y0\nLD Y0\nOUT Delay K50\nLD T0\nOUT Y1\nEND\n", Notation::FxIl);
    let text = hover(&document, "Start");
    assert!(text.contains("**X0** input relay"), "{text}");
    assert!(text.contains("`Start` is the symbol of X0 — green button"), "{text}");
    let text = hover(&document, "Y0");
    assert!(text.contains("Symbol `Motor` — contactor, main"), "{text}");
    assert!(text.contains("Written:\n- rung 1, line 2: `OUT Y0`"), "{text}");
    assert!(text.contains("Read:\n- rung 2, line 3: `LD Y0`"), "{text}");
    let text = hover(&document, "T0");
    assert!(text.contains("Preset `K50` = 5 s"), "{text}");
}

#[test]
fn a_hover_counts_what_it_does_not_list() {
    let rung = "LD X0\nOUT M1\n";
    // So many rungs that most pages are only counted.
    let document = fx(&format!("{}LD X0\nANI X0\nOUT M2\nEND\n", rung.repeat(2000)));
    let text = hover(&document, "X0");
    assert_eq!(text.matches("`LD X0`").count(), 8, "{text}");
    assert!(text.ends_with("- and 1994 more"), "{text}");
    let text = hover(&document, "M2");
    assert!(text.contains("rung 2001, line 4003"), "{text}");
    // As a part of a run a device is used, too.
    let document = fx(&format!("{}LD X1\nMOV K2X0 D0\nEND\n", rung.repeat(200)));
    assert!(hover(&document, "X0").ends_with("- and 193 more"), "{}", hover(&document, "X0"));
}

#[test]
fn files_of_a_project_are_looked_through_and_linked() {
    let (main, pump) = (fx("LD X0\nOUT M5\nEND\n"), fx("LD M5\nOUT Y1\n"));
    let members =
        vec![Member { name: "main.il", document: &main }, Member { name: "pump.il", document: &pump }];
    let view = ProjectView::new(members, 0, true).unwrap();
    let link = |file: usize, line: u32| Some(format!("file:///{file}#L{}", line + 1));
    let text = ide::hover_in(&view, main.text().find("M5").unwrap(), EN, &link).unwrap().markdown;
    assert!(text.contains("[rung 1, line 2](file:///0#L2): `OUT M5`"), "{text}");
    assert!(text.contains("[pump.il, rung 1, line 1](file:///1#L1): `LD M5`"), "{text}");
    // What the other file uses is not free.
    let offset = main.text().find("M5").unwrap();
    let main = fx("LD X0\nOUT Y\nEND\n");
    let members =
        vec![Member { name: "main.il", document: &main }, Member { name: "pump.il", document: &pump }];
    let view = ProjectView::new(members, 0, true).unwrap();
    let found = ide::completions_in(&view, offset + 1, EN);
    let free: Vec<&str> =
        found.iter().filter(|one| one.detail.ends_with("free")).map(|one| one.label.as_str()).collect();
    assert_eq!(free, ["Y0"]);
}

#[test]
fn a_drawn_rung_is_told_in_a_line() {
    let text = "\
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |
";
    let document = Document::new(text, Notation::Ladder, fx2n());
    let text = hover(&document, "Y0");
    assert!(text.contains("Written:\n- rung 1, line 1: `X0 /X1 Y0 → Y0`"), "{text}");
}

#[test]
fn free_numbers_come_first_where_something_new_is_written() {
    assert_eq!(proposed("LD X0\nOUT M0\nOUT Y0\nLD M0\nOUT M$0")[..3], ["M1", "M500", "M0"]);
    assert_eq!(proposed("LD X0\nOUT Y0\nLD X0\nOUT Y$0")[..2], ["Y1", "Y0"]);
    // A reset is for what something else sets, a contact for what something drives.
    assert_eq!(proposed("LD X0\nSET M3\nLD X0\nRST M$0")[0], "M3");
    assert_eq!(proposed("LD X0\nOUT M3\nLD M$0")[0], "M3");
    // By the time base of timers and the width of counters, and not in the middle of a run.
    assert_eq!(proposed("LD X0\nOUT T$0"), ["T0", "T192", "T200", "T246", "T250"]);
    assert_eq!(proposed("LD X0\nOUT C$0"), ["C0", "C100", "C200", "C220"]);
    assert_eq!(proposed("LD X0\nMOV K4M0 D0\nOUT M$0")[0], "M16");
    assert_eq!(proposed("LD X0\nDMOV K1 D0\nMOV K1 D$0")[..2], ["D0", "D2"]);
    // What is being typed is not in use yet.
    assert_eq!(proposed("LD X0\nOUT M0$0")[0], "M0");
    assert_eq!(proposed("LD X0\nCJ P5\nP$0")[0], "P5");
}

#[test]
fn symbols_and_comments_find_the_device() {
    let at_end = |text: &str| labels(&known(text, Notation::FxIl), text.len());
    assert!(at_end("LD sta").contains(&"X0".to_string()) && at_end("LD sta").contains(&"Start".to_string()));
    assert!(at_end("LD green").contains(&"X0".to_string()));
    assert!(!at_end("LD green").contains(&"X3".to_string()));
    assert!(at_end("LD spare").contains(&"X3".to_string()), "a device that nothing uses yet");
    // A device with a comment is reserved.
    let used = "LD X0\nOUT M0\nOUT M1\nOUT M2\nOUT M3\nOUT M4\nOUT M5\nOUT M6\nOUT M";
    assert_eq!(at_end(used)[0], "M8");
    let text = "LD Y0\nOUT Y1\nLD Y";
    let document = known(text, Notation::FxIl);
    let found = ide::completions(&document, text.len(), EN);
    let motor = found.iter().find(|proposal| proposal.label == "Y0").unwrap();
    assert_eq!(motor.detail, "Motor: contactor, main, output relay, read in 1 place");
    assert!(motor.filter.starts_with("Y0 Motor"), "{}", motor.filter);
}

#[test]
fn addresses_of_iec_are_proposed() {
    let text = "PROGRAM P\nVAR\n a AT %IX0.6 : BOOL;\n b AT %IX0.7 : BOOL;\n c AT %I : BOOL;\nEND_VAR\nLD a\nST b\nEND_PROGRAM\n";
    let document = Document::new(text, Notation::IecIl, Target::of(Model::Iec));
    let found = labels(&document, text.find("%I ").unwrap() + 2);
    assert_eq!(found[..3], ["%IX0.6", "%IX0.7", "%IX1.0"]);
    assert!(found.contains(&"%IW0".to_string()) && !found.contains(&"%QX0.0".to_string()), "{found:?}");
}

#[test]
fn comments_stand_behind_devices() {
    let document = known("LD Start\nAND X3\nOUT M9\n", Notation::FxIl);
    let all = Span::new(0, document.len());
    let hints: Vec<(usize, String)> =
        ide::inlay_hints(&document, all, EN).into_iter().map(|hint| (hint.offset, hint.label)).collect();
    assert_eq!(hints, [(8, "X0 green button".to_string()), (15, "Spare: spare sensor".to_string())]);
    assert_eq!(ide::value_hints(&document, all, EN), []);
}

#[test]
fn a_symbol_is_renamed_everywhere_and_in_its_table() {
    let main = known("LD Start\nOR X0\nOUT Motor\nEND\n", Notation::FxIl);
    let drawing =
        known("|  Start                Motor  |\n+--| |-----------------( )----+\n", Notation::Ladder);
    let members =
        vec![Member { name: "main.il", document: &main }, Member { name: "a.lad", document: &drawing }];
    let view = ProjectView::new(members, 0, true).unwrap();
    let renamed = ide::rename_symbol(&view, 4, "Begin").unwrap().unwrap();
    let texts: Vec<String> = renamed
        .files
        .iter()
        .map(|at| TextEdit::apply_all(&at.value, &view.members()[at.file].document.text()))
        .collect();
    assert_eq!(texts[0], "LD Begin\nOR X0\nOUT Motor\nEND\n");
    assert!(texts[1].starts_with("|  Begin                Motor  |\n"), "{}", texts[1]);
    let edit = renamed.table.unwrap();
    assert!(TextEdit::apply_all(&[edit], TABLE).starts_with("X0,Begin,green button\n"));
    for (new, key) in [
        ("M5", "device-comments.reads-as-device"),
        ("OUT", "device-comments.is-instruction"),
        ("motor", "alias.taken"),
        ("two words", "device-comments.no-identifier"),
    ] {
        assert_eq!(ide::rename_symbol(&view, 4, new).unwrap().unwrap_err().key(), key, "{new}");
    }
    assert!(ide::rename_symbol(&view, main.text().find("X0").unwrap(), "Begin").is_none());
}

#[test]
fn a_renamed_device_keeps_its_symbol() {
    let document = known("LD Start\nOR X0\nOUT Y5\nEND\n", Notation::FxIl);
    let offset = document.text().find("X0").unwrap();
    let edits = ide::rename(&document, offset, "X7").unwrap();
    assert_eq!(TextEdit::apply_all(&edits, &document.text()), "LD Start\nOR X7\nOUT Y5\nEND\n");
    let edit = ide::rename_in_comments(&document, offset, "X7").unwrap().unwrap();
    assert!(TextEdit::apply_all(&[edit], TABLE).starts_with("X7,Start,green button\n"));
    let taken = ide::rename_in_comments(&document, offset, "X3").unwrap_err();
    assert_eq!(taken.key(), "device-comments.device-twice");
}

#[test]
fn symbols_and_devices_are_exchanged() {
    let document = known("LD Start\nOR X0\nAND X0\nMOV K4X0 D0\nOUT Motor\n", Notation::FxIl);
    let results = |offset: usize| -> Vec<String> {
        let rewrites = ide::rewrites(&document, offset);
        rewrites.iter().map(|one| TextEdit::apply_all(&one.edits, &document.text())).collect()
    };
    assert_eq!(results(4), ["LD X0\nOR X0\nAND X0\nMOV K4X0 D0\nOUT Motor\n"]);
    assert_eq!(
        results(document.text().find("X0").unwrap()),
        [
            "LD Start\nOR Start\nAND X0\nMOV K4X0 D0\nOUT Motor\n",
            "LD Start\nOR Start\nAND Start\nMOV K4Start D0\nOUT Motor\n"
        ]
    );
    assert_eq!(results(0), Vec::<String>::new());
}

/// The marked words with their kind: `w` written, `r` read, `t` text.
fn marks(text: &str, word: &str, notation: Notation) -> String {
    let model = if notation == Notation::IecIl { Model::Iec } else { Model::Fx3u };
    let document = Document::new(text, notation, Target::of(model));
    let found = ide::highlights(&document, text.find(word).unwrap());
    let shown = found.iter().map(|mark| {
        let kind = match mark.kind {
            HighlightKind::Text => 't',
            HighlightKind::Read => 'r',
            HighlightKind::Write => 'w',
        };
        let line = document.line_of(mark.span.start as usize) + 1;
        format!("{kind}{line}:{}", document.slice(mark.span))
    });
    shown.collect::<Vec<_>>().join(" ")
}

#[test]
fn uses_are_marked_by_kind() {
    let list = |text, word| marks(text, word, Notation::FxIl);
    assert_eq!(list("LD M0\nOUT Y0\nLD X0\nOUT M0\nINC D0\n", "M0"), "r1:M0 w4:M0");
    assert_eq!(list("LD X0\nINC D0\n", "D0"), "w2:D0");
    assert_eq!(list("LD X0\nCJ P1\nLD X1\nOUT Y0\nP1\nEND\n", "P1"), "t2:P1 t5:P1");
    let drawing = "|   X0                Y0  |\n+---| |---+-----------( )-+\n|   Y0    |               |\n+---| |---+               |\n";
    assert_eq!(marks(drawing, "Y0", Notation::Ladder), "w1:Y0 r3:Y0");
}

#[test]
fn partners_of_structures_are_marked() {
    let list = |text, word| marks(text, word, Notation::FxIl);
    let nested = "FOR K2\nFOR K3\nLD X0\nOUT Y0\nNEXT\nNEXT\nFOR K4\nNEXT\n";
    assert_eq!(list(nested, "FOR K2"), "t1:FOR t6:NEXT");
    assert_eq!(list(nested, "FOR K3"), "t2:FOR t5:NEXT");
    assert_eq!(list(nested, "FOR K4"), "t7:FOR t8:NEXT");
    let sections = "LD X0\nMC N0 M0\nLD X1\nMC N1 M1\nLD X2\nOUT Y0\nMCR N1\nMCR N0\n";
    assert_eq!(list(sections, "MC N0"), "t2:MC t8:MCR");
    assert_eq!(list(sections, "MCR N1"), "t4:MC t7:MCR");
    let branches = "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nAND X2\nOUT Y1\nMPP\nOUT Y2\n";
    assert_eq!(list(branches, "MRD"), "t2:MPS t5:MRD t8:MPP");
    assert_eq!(list("NEXT\nEND\n", "NEXT"), "t1:NEXT");
    let iec = "LD a\nAND( b\nOR c\n)\nST d\n";
    assert_eq!(marks(iec, "AND(", Notation::IecIl), "t2:AND( t4:)".replace("AND(", "AND"));
    assert_eq!(marks(iec, ")\n", Notation::IecIl), "t2:AND t4:)");
}

#[test]
fn lenses_tell_steps_references_and_free_devices() {
    let all = LensSettings { steps: true, references: true, next_free: true };
    let document = known("LD X0\nOUT Y0\nOUT M0\nLD Y0\nOR Y0\nOUT T0 K10\nEND\n", Notation::FxIl);
    let view = ProjectView::alone(&document);
    let titles: Vec<String> = ide::lenses(&document, all)
        .iter()
        .map(|lens| {
            let title = ide::lens_title(&view, lens.span.start as usize, &lens.kind, EN).unwrap();
            format!("{} {title}", document.line_of(lens.span.start as usize) + 1)
        })
        .collect();
    assert_eq!(
        titles,
        [
            "1 next free: M1, T1",
            "1 3 steps",
            "1 Y0 Motor: 2 references",
            "1 M0: 0 references",
            "4 5 steps",
            "4 T0 Delay: 0 references"
        ]
    );
    let some = LensSettings { steps: true, references: false, next_free: false };
    assert!(ide::lenses(&document, some).iter().all(|lens| lens.kind == LensKind::Steps));
    let none = LensSettings { steps: false, references: false, next_free: false };
    assert_eq!(ide::lenses(&document, none), []);
    let iec = Document::new("LD a\nST b\n", Notation::IecIl, Target::of(Model::Iec));
    assert_eq!(ide::lenses(&iec, all), []);
}

#[test]
fn a_file_with_too_many_rungs_says_where_its_lenses_end() {
    let all = LensSettings { steps: true, references: true, next_free: true };
    let document = fx(&"LD X0\nOUT Y0\n".repeat(2000));
    let lenses = ide::lenses(&document, all);
    let (last, others) = lenses.split_last().unwrap();
    assert_eq!(last.kind, LensKind::More);
    assert!(others.len() > 2900 && lenses.len() <= 3000, "{}", lenses.len());
    assert!(others.iter().all(|lens| lens.kind != LensKind::More && lens.span.start < last.span.start));
    // Two lenses above each rung of two lines, and one above the first.
    assert_eq!(document.line_of(last.span.start as usize) as usize, others.len() - 1);
    let view = ProjectView::alone(&document);
    let title = ide::lens_title(&view, last.span.start as usize, &last.kind, EN).unwrap();
    assert_eq!(title, "no lenses from here on: a file has 3000 at most");
    let few = fx(&"LD X0\nOUT Y0\n".repeat(1000));
    assert!(ide::lenses(&few, all).iter().all(|lens| lens.kind != LensKind::More));
}

#[test]
fn ranges_are_formatted_by_whole_rungs() {
    let style = Style { kind: FormatStyle::Iec, width: 48 };
    let text = "ld x0\nout y0\nld x1\nout y1\nld x2\nout y2\n";
    let document = fx(text);
    let inside = text.find("y1").unwrap();
    let edits = ide::format_ranges(&document, style, &[Span::new(inside, inside + 1)]);
    assert_eq!(TextEdit::apply_all(&edits, text), "ld x0\nout y0\nLD X1\nOUT Y1\nld x2\nout y2\n");
    let both = [Span::at(0), Span::at(text.len() - 1)];
    let edits = ide::format_ranges(&document, style, &both);
    assert_eq!(TextEdit::apply_all(&edits, text), "LD X0\nOUT Y0\nld x1\nout y1\nLD X2\nOUT Y2\n");
    let all = ide::format_ranges(&document, style, &[Span::new(0, text.len())]);
    assert_eq!(all, ide::format(&document, style));
}

#[test]
fn the_list_of_used_devices() {
    let text = "LD Start\nOUT Y0\nLD Y0\nOUT T0 K50\nMOV K1M8 D3\nCJ P0\nP0\nEND\n";
    let document = known(text, Notation::FxIl);
    let view = ProjectView::alone(&document);
    let usage = ide::usage(&view);
    let names: Vec<&str> = usage.rows.iter().map(|row| row.name.as_str()).collect();
    assert_eq!(names, ["X0", "Y0", "M8", "T0", "D3", "P0"]);
    let motor = &usage.rows[1];
    assert_eq!((motor.symbol.as_str(), motor.is_read(), motor.is_written()), ("Motor", true, true));
    assert!(motor.uses[0].by_coil && !motor.uses[1].by_coil);
    assert_eq!((motor.uses[1].line, motor.uses[1].rung), (2, Some(2)));
    assert_eq!(usage.rows[3].preset, "K50 = 5 s");
    let text = usage.text(&view, EN);
    for line in [
        "Y output relay",
        "          0   1   2   3   4   5   6   7",
        "Y0       ro   .   .   .   .   .   .   .",
        // K1M8 reads M8 to M11, in two rows of ten.
        "M0        .   .   .   .   .   .   .   .  r-  r-",
        "M10      r-  r-   .   .   .   .   .   .   .   .",
        "D0        .   .   .  -w   .   .   .   .   .   .",
        "T0       -o   .   .   .   .   .   .   .   .   .",
        "P0       -*   .   .   .   .   .   .   .   .   .",
        "X0       Start: green button",
        "    rung 1, line 1: read — LD Start",
        "T0       Delay  K50 = 5 s",
    ] {
        assert!(text.lines().any(|own| own == line), "`{line}` is missing in\n{text}");
    }
    let empty = fx("END\n");
    let view = ProjectView::alone(&empty);
    assert!(ide::usage(&view).text(&view, EN).contains("uses no device"));
}

#[test]
fn variables_are_listed_by_unit() {
    let text = "PROGRAM Main\nVAR\n a AT %IX0.0 : BOOL;\nEND_VAR\nLD a\nST b\nEND_PROGRAM\nPROGRAM Two\nVAR\n a : BOOL;\nEND_VAR\nLD a\nEND_PROGRAM\n";
    let document = Document::new(text, Notation::IecIl, Target::of(Model::Iec));
    let usage = ide::usage(&ProjectView::alone(&document));
    let names: Vec<String> =
        usage.rows.iter().map(|row| format!("{} {}", row.full_name(), row.uses.len())).collect();
    assert_eq!(names, ["%IX0.0 1", "Main.a 2", "Main.b 1", "Two.a 2"]);
}

/// Hover and completion look at tables of pages, not at the text: time grows far slower than the document.
#[test]
fn large_documents_are_answered_at_once() {
    let rung = |number: usize| format!("LD X{:o}\nAND M8000\nOUT M{}\n", number % 128, number % 3000);
    let text: String = (0..16_000).map(rung).collect();
    let document = fx(&text);
    let offset = text.rfind("M8000").unwrap();
    // The first question makes the tables.
    let first = ide::hover(&document, offset, EN).unwrap();
    assert!(first.markdown.contains("and 15992 more"), "{}", first.markdown);
    ide::completions(&document, offset + 1, EN);
    let fastest = |ask: &dyn Fn()| {
        let times = (0..5).map(|_| {
            let started = Instant::now();
            ask();
            started.elapsed()
        });
        times.min().unwrap()
    };
    // Anything that looks at each chunk takes a good part of the time of reading them.
    let reading = fastest(&|| drop(check::all(&fx(&text), &Severities::default())));
    let hover = fastest(&|| drop(ide::hover(&document, offset, EN)));
    assert!(hover * 10 < reading, "{hover:?} of {reading:?}");
    let completion = fastest(&|| drop(ide::completions(&document, offset + 1, EN)));
    assert!(completion * 3 < reading, "{completion:?} of {reading:?}");
    eprintln!("{reading:?} {hover:?} {completion:?}");
}
