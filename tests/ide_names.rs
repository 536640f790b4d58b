//! Names in programs: symbols inside operands, variables that nothing declares, names over several lines.

use rungwise::check::{self, Severities};
use rungwise::document::{Comments, Document, Notation, ProjectView};
use rungwise::ide;
use rungwise::ide::Style;
use rungwise::project::{CommentsFile, FormatStyle};
use rungwise::target::{Device, DeviceKind, Model, Operand, OperandProblem, Target};
use rungwise::text::{Language, Span, TextEdit};
use std::path::Path;
use std::sync::Arc;

const EN: Language = Language::English;
const ZH: Language = Language::SimplifiedChinese;

const TABLE: &str = "M0,Lamps,\nD0,Level,tank\nX0,Start,\nZ0,Index,\nM64,K4Lamp,\nM80,LampZ0,\n\
                     M96,Lamp,\nM112,电机,\nP1,Routine,\n";

fn fx3u() -> &'static Target {
    Target::of(Model::Fx3u)
}

fn table() -> Arc<Comments> {
    let file = CommentsFile::read(Path::new("devices.csv"), TABLE, fx3u());
    assert!(file.diagnostics.is_empty(), "{:?}", file.diagnostics);
    file.comments
}

fn known(text: &str, notation: Notation) -> Document {
    Document::with_comments(text, notation, fx3u(), table())
}

fn ladder(text: &str) -> Document {
    Document::new(text, Notation::Ladder, Target::of(Model::Iec))
}

fn hover(document: &Document, word: &str, language: Language) -> String {
    let offset = document.text().find(word).expect("the word");
    ide::hover(document, offset, language).expect("a hover").markdown
}

fn problems(document: &Document, code: &str) -> Vec<String> {
    let found = check::realtime(document, &Severities::default());
    found.iter().filter(|f| f.code == code).map(|f| f.message.render(EN)).collect()
}

#[test]
fn a_symbol_may_stand_inside_an_operand() {
    let target = fx3u().with_symbols(table().symbols().clone());
    let device = |kind, number| Device::new(kind, number);
    let nibbles =
        |digits, number, index| Operand::Nibbles { digits, first: device(DeviceKind::M, number), index };
    let z = |number| Some(device(DeviceKind::Z, number));
    let level = device(DeviceKind::D, 0);
    let problem = Operand::Invalid;
    for (word, operand) in [
        ("K4Lamps", nibbles(4, 0, None)),
        ("k2lamps", nibbles(2, 0, None)),
        ("K4LampsZ1", nibbles(4, 0, z(1))),
        ("K1电机", nibbles(1, 112, None)),
        ("LevelZ1", Operand::Indexed { device: level, index: device(DeviceKind::Z, 1) }),
        ("levelv0", Operand::Indexed { device: level, index: device(DeviceKind::V, 0) }),
        ("Level.F", Operand::WordBit { word: level, bit: 15 }),
        // What is a symbol as a whole is that symbol.
        ("K4Lamp", Operand::Device(device(DeviceKind::M, 64))),
        ("LampZ0", Operand::Device(device(DeviceKind::M, 80))),
        // The longest symbol of one reading: only `Lamp` takes a K2.
        ("K2Lamp", nibbles(2, 96, None)),
        ("K4LampZ0", problem(OperandProblem::SymbolTwice)),
        ("K4Level", problem(OperandProblem::SymbolForm(level))),
        ("K9Lamps", problem(OperandProblem::SymbolForm(device(DeviceKind::M, 0)))),
        ("Lamps.3", problem(OperandProblem::SymbolForm(device(DeviceKind::M, 0)))),
        ("IndexZ1", problem(OperandProblem::SymbolForm(device(DeviceKind::Z, 0)))),
        ("Level.G", problem(OperandProblem::SymbolForm(level))),
        // No number, no index register; nobody, no symbol.
        ("LevelZ", problem(OperandProblem::UnknownDevice)),
        ("Nobody.3", problem(OperandProblem::UnknownDevice)),
    ] {
        assert_eq!(target.read(word), operand, "{word}");
    }
    // Devices mean what they always mean.
    assert_eq!(target.read("K4M0"), nibbles(4, 0, None));
}

#[test]
fn a_symbol_inside_an_operand_has_its_hover_its_places_and_its_name() {
    let text = "LD Start\nMOV K4Lamps LevelZ1\nLD Level.3\nOUT Lamps\nMOV K2Lamps D5\nEND\n";
    let drawing = "|  Start                              |\n+---| |---------[MOV K4Lamps LevelZ1]-+\n";
    for (text, notation) in [(text, Notation::FxIl), (drawing, Notation::Ladder)] {
        let document = known(text, notation);
        for word in ["K4Lamps", "Lamps"] {
            let words = hover(&document, word, EN);
            assert!(words.contains("**M0** auxiliary relay") && words.contains("M15"), "{words}");
            assert!(words.contains("`Lamps` is the symbol of M0"), "{words}");
        }
        let words = hover(&document, "LevelZ1", EN);
        assert!(words.contains("The number of D0 plus the content of Z1"), "{words}");
        assert!(words.contains("tank"), "{words}");
        assert_eq!(problems(&document, "unknown-device"), Vec::<String>::new());
        let place = text.find("Lamps").unwrap();
        let named: Vec<&str> =
            ide::references(&document, place, true).into_iter().map(|span| span.of(text)).collect();
        assert!(!named.is_empty() && named.iter().all(|word| *word == "Lamps"), "{named:?}");
        // Its symbol is renamed inside of the operands, too.
        let view = ProjectView::alone(&document);
        let renamed = ide::rename_symbol(&view, place, "Leds").unwrap().unwrap();
        let edited = TextEdit::apply_all(&renamed.files[0].value, text);
        assert!(edited.contains("MOV K4Leds LevelZ1") && !edited.contains("Lamps"), "{edited}");
    }
    let document = known(text, Notation::FxIl);
    let style = Style { kind: FormatStyle::Iec, width: 48 };
    let formatted = TextEdit::apply_all(&ide::format(&document, style), text);
    assert!(formatted.contains("K4Lamps LevelZ1") && formatted.contains("Level.3"), "{formatted}");
}

#[test]
fn what_a_symbol_cannot_be_is_said() {
    let document =
        known("LD Start\nMOV K4Level D9\nMOV K4LampZ0 D9\nLD Lamps.3\nOUT IndexZ1\nEND\n", Notation::FxIl);
    let found = problems(&document, "unknown-device");
    assert_eq!(found.len(), 4, "{found:?}");
    assert!(found[0].contains("stands for D0") && found[0].contains("X, Y, M or S"), "{found:?}");
    assert!(found[1].contains("in two ways"), "{found:?}");
    assert!(found[2].contains("only a D has bits"), "{found:?}");
    assert!(found[3].contains("takes no index register"), "{found:?}");
}

#[test]
fn devices_inside_operands_are_exchanged_for_symbols_where_they_stay_the_same() {
    let text = "LD Start\nAND D0.3\nMOV D0Z1 D1\nOUT Y0\nEND\n";
    let document = known(text, Notation::FxIl);
    let rewrites = ide::rewrites(&document, text.find("D0.3").unwrap());
    let all = rewrites.last().expect("a rewrite");
    let edited = TextEdit::apply_all(&all.edits, text);
    assert_eq!(edited, "LD Start\nAND Level.3\nMOV LevelZ1 D1\nOUT Y0\nEND\n");
    // M96 has the symbol `Lamp`, but `K4Lamp` is the symbol of another device.
    let text = "LD Start\nMOV K4M96 D0\nAND M96\nOUT M96\nEND\n";
    let document = known(text, Notation::FxIl);
    let rewrites = ide::rewrites(&document, text.find("M96\nOUT").unwrap());
    let edited = TextEdit::apply_all(&rewrites.last().expect("a rewrite").edits, text);
    assert_eq!(edited, "LD Start\nMOV K4M96 D0\nAND Lamp\nOUT Lamp\nEND\n");
}

const IMPLICIT: &str = "\
|   start     stop                     motor   |
+---| |---+---|/|-----------------------( )----+
|   motor |                                    |
+---| |---+                                    |

|   motor         T1                           |
|              +-------+               lamp    |
+---| |--------|IN TON Q|--------------( )-----+
";

#[test]
fn a_variable_of_a_ladder_without_header_has_the_type_of_its_first_use() {
    let text = "\
|   start     stop                     motor   |
+---| |---+---|/|-----------------------( )----+
|   motor |                                    |
+---| |---+                                    |

|                 T1                           |
|   motor      +------+                lamp    |
|              |TON   |                        |
+---| |--------|IN   Q|----------------( )-----+
|        delay-|PT  ET|-elapsed                |
|              +------+                        |

|  level > 5                           full    |
+--[> level 5]--------------------------( )----+
";
    let document = ladder(text);
    for (word, kind) in [
        ("start", "BOOL"),
        ("motor", "BOOL"),
        ("T1", "TON"),
        ("delay", "TIME"),
        ("elapsed", "TIME"),
        ("level 5", "INT"),
    ] {
        let words = hover(&document, word, EN);
        assert!(words.contains(&format!("implicit `{kind}`")), "{word}: {words}");
    }
    assert!(hover(&document, "start", ZH).contains("隐式 `BOOL`"));
    let all = Span::new(0, text.len());
    let hints: Vec<(u32, String)> = ide::inlay_hints(&document, all, EN)
        .into_iter()
        .map(|hint| (document.line_of(hint.offset) as u32, hint.label))
        .collect();
    let expected = [
        (0, "start, stop, motor: BOOL"),
        (5, "T1: TON"),
        (6, "lamp: BOOL"),
        (9, "delay, elapsed: TIME"),
        (12, "full: BOOL"),
    ];
    let expected = expected.map(|(line, label)| (line, label.to_string()));
    assert_eq!(hints.iter().filter(|hint| !hint.1.contains("INT")).cloned().collect::<Vec<_>>(), expected);
    assert!(hints.iter().any(|hint| hint.1 == "level: INT"), "{hints:?}");
    // In the second rung `motor` is an old acquaintance, also where only that rung is asked about.
    let second = text.find("T1").unwrap();
    let labels: Vec<String> = ide::inlay_hints(&document, Span::new(second, second + 90), EN)
        .into_iter()
        .map(|hint| hint.label)
        .collect();
    assert_eq!(labels, ["T1: TON", "lamp: BOOL"]);
}

#[test]
fn with_a_header_nothing_is_implicit() {
    let text = format!("PROGRAM p\nVAR\n  start : BOOL;\nEND_VAR\n\n{IMPLICIT}\nEND_PROGRAM\n");
    let document = ladder(&text);
    assert!(hover(&document, "lamp", EN).contains("without declaration"));
    assert_eq!(ide::inlay_hints(&document, Span::new(0, text.len()), EN), []);
    let document = Document::new("|  X0      Y0  |\n+--| |-----( )-+\n", Notation::Ladder, fx3u());
    assert_eq!(ide::inlay_hints(&document, Span::new(0, 30), EN), []);
}

const OVER_LINES: &str = "\
|  CONV_     EMERG             LAMP       |
|  MOTOR     STOP                         |
+---| |-------|/|---------------( )-------+

|  CONV_MOTOR                  HORN       |
+---| |-------------------------( )-------+
";

#[track_caller]
fn renamed(text: &str, word: &str, new: &str) -> Result<String, String> {
    let document = ladder(text);
    let edits = ide::rename(&document, text.find(word).unwrap(), new);
    edits.map(|edits| TextEdit::apply_all(&edits, text)).map_err(|message| message.render(EN))
}

#[test]
fn a_name_over_several_lines_is_renamed_in_its_lines() {
    let lines = |text: String| text.lines().map(str::to_string).collect::<Vec<_>>();
    for word in ["CONV_", "MOTOR"] {
        let text = lines(renamed(OVER_LINES, word, "BELT_DRIVE").unwrap());
        assert_eq!(text[0], "|  BELT_     EMERG             LAMP       |");
        assert_eq!(text[1], "|  DRIVE     STOP                         |");
        assert_eq!(text[4], "|  BELT_DRIVE                  HORN       |");
    }
    // Where the old name is joined without being written so, the new one is, too; the lines fit as well as they can.
    let text = lines(renamed(OVER_LINES, "EMERG", "E_STOP_OK").unwrap());
    assert_eq!(text[0], "|  CONV_     E_STOP            LAMP       |");
    assert_eq!(text[1].trim_end_matches(['|', ' ']), "|  MOTOR      OK");
    let again = ladder(&renamed(OVER_LINES, "EMERG", "E_STOP_OK").unwrap());
    assert!(again.chunk_at(0).unwrap().chunk.mentions().iter().any(|m| m.span.of(&again.text()) == "OK"));
}

#[test]
fn a_name_that_cannot_be_parted_is_refused_with_its_reason() {
    let reason = renamed(OVER_LINES, "CONV_", "BELT").unwrap_err();
    assert!(reason.contains("over 2 lines") && reason.contains("`BELT` needs a `_`"), "{reason}");
    assert!(reason.contains("line 1") || reason.contains("line 2"), "{reason}");
}

#[test]
fn a_rename_that_collides_says_with_what() {
    let reason = renamed(OVER_LINES, "LAMP", "horn").unwrap_err();
    assert!(reason.contains("horn is already used in line 5"), "{reason}");
    let near = "|  a   b         c |\n+--| |-| |------( )+\n";
    let reason = renamed(near, "a ", "temperature").unwrap_err();
    assert!(reason.contains("line 1") && reason.contains("run into `b`"), "{reason}");
    let document = known("LD Start\nOUT Lamps\nEND\n", Notation::FxIl);
    let reason = ide::rename_symbol(&ProjectView::alone(&document), 4, "lamps").unwrap().unwrap_err();
    assert_eq!(reason.render(EN), "`lamps` is already the symbol of M0");
}
