//! The device comments file: encodings, separators, headers, bad lines at their places, and symbols in programs.

use proptest::prelude::*;
use rungwise::check::{self, Rule};
use rungwise::document::{Document, Notation, Symbol};
use rungwise::project::{CommentsFile, decode};
use rungwise::target::{Model, Target};
use rungwise::text::{Encoding, Language};
use std::path::Path;

fn fx2n() -> &'static Target {
    Target::of(Model::Fx2n)
}

fn read(text: &str) -> CommentsFile {
    CommentsFile::read(Path::new("devices.csv"), text, fx2n())
}

/// The rows, `X0 Start green button`, then the findings with their places.
fn shown(text: &str) -> String {
    let file = read(text);
    let mut lines: Vec<String> = Vec::new();
    for row in file.comments.rows() {
        let name = match &row.thing {
            Symbol::Device(device) => device.to_string(),
            Symbol::Direct(address) => address.to_string(),
            other => panic!("{other:?}"),
        };
        lines.push(format!("{name}|{}|{}", row.symbol, row.comment));
    }
    for found in &file.diagnostics {
        let at = file.position(found.span.start, Encoding::Utf32);
        let word = found.span.of(file.text());
        lines.push(format!("{} {}:{} `{word}`", found.message.key(), at.line + 1, at.column + 1));
    }
    lines.join("\n")
}

#[test]
fn the_three_separators_with_and_without_header() {
    let rows = "X0|Start|green button\nY0|Motor|contactor";
    assert_eq!(shown("X0,Start,green button\nY0,Motor,contactor\n"), rows);
    assert_eq!(shown("X0;Start;green button\r\nY0;Motor;contactor"), rows);
    assert_eq!(shown("X0\tStart\tgreen button\rY0\tMotor\tcontactor\r"), rows);
    assert_eq!(shown("Device,Symbol,Comment\nX000,Start,green button\nY000,Motor,contactor\n"), rows);
    assert_eq!(shown("Comment;Device;Label\ngreen button;X0;Start\ncontactor;Y0;Motor"), rows);
    assert_eq!(shown("软元件名\t注释\t符号\nX0\tgreen button\tStart\nY0\tcontactor\tMotor"), rows);
    // An export has the name of the table above its header.
    assert_eq!(shown("\"COMMENT\"\n\"Device Name\"\t\"Comment\"\n\"X0\"\t\"green\"\n"), "X0||green");
}

#[test]
fn quoted_fields_and_empty_lines() {
    assert_eq!(
        shown("\"X0\",\"Start\",\"button, \"\"green\"\"\"\n\n,,\nY0,,two\nlines,here"),
        "X0|Start|button, \"green\"\nY0||two\ndevice-comments.no-device 5:1 `lines`"
    );
    assert_eq!(shown("X0;a;one, two\nX1;b;three, four\n"), "X0|a|one, two\nX1|b|three, four");
    assert_eq!(shown("%IX0.0,Start,green"), "%IX0.0|Start|green");
    assert_eq!(shown(""), "");
}

#[test]
fn a_quote_that_nothing_closes_loses_its_line_only() {
    assert_eq!(
        shown("X0,Start,\"green\nX1,Stop,red\n"),
        "X1|Stop|red\ndevice-comments.open-quote 1:10 `\"green`"
    );
}

#[test]
fn what_cannot_be_used_is_found_at_its_place() {
    assert_eq!(
        shown(
            "X0,Start,\nX8,Eight,\nX0,Again,\nM0,start,\nM1,LD,\nM2,Y5,\nM3,two words,\nM4000,Far,\n\
             %IX0.0,,in\n%IX0.0,,out\n"
        ),
        "X0|Start|\nM0||\nM1||LD\nM2||Y5\nM3||two words\nM4000|Far|\n%IX0.0||in\n\
         device-comments.no-device 2:1 `X8`\n\
         device-comments.device-twice 3:1 `X0`\n\
         device-comments.symbol-twice 4:4 `start`\n\
         device-comments.is-instruction 5:4 `LD`\n\
         device-comments.reads-as-device 6:4 `Y5`\n\
         device-comments.no-identifier 7:4 `two words`\n\
         device-comments.not-on-target 8:1 `M4000`\n\
         device-comments.device-twice 10:1 `%IX0.0`"
    );
}

#[test]
fn every_encoding_of_the_trade() {
    let text = "X0,启动,绿色按钮\r\nY0,电机,接触器\r\n";
    let utf16 = |big: bool| -> Vec<u8> {
        let unit = |unit: u16| if big { unit.to_be_bytes() } else { unit.to_le_bytes() };
        text.encode_utf16().flat_map(unit).collect()
    };
    let with_mark = |mark: &[u8], bytes: Vec<u8>| [mark.to_vec(), bytes].concat();
    let gbk = encoding_rs::GBK.encode(text).0.into_owned();
    assert!(std::str::from_utf8(&gbk).is_err());
    for (name, bytes) in [
        ("UTF-8", text.as_bytes().to_vec()),
        ("UTF-8 with mark", with_mark(b"\xef\xbb\xbf", text.as_bytes().to_vec())),
        ("UTF-16 LE", with_mark(b"\xff\xfe", utf16(false))),
        ("UTF-16 BE", with_mark(b"\xfe\xff", utf16(true))),
        ("GBK", gbk),
    ] {
        assert_eq!(decode(&bytes), text, "{name}");
        assert_eq!(shown(&decode(&bytes)), "X0|启动|绿色按钮\nY0|电机|接触器", "{name}");
    }
    let plain = "X0\tStart\tgreen\n";
    let bytes: Vec<u8> = plain.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(decode(&bytes), plain, "UTF-16 without a mark");
    assert!(shown(&decode(b"X0,Start,\xff\xff\n")).contains("device-comments.encoding 1:10"));
}

/// The tables on the rule's page: `^^^` marks what is reported in the line above.
#[test]
fn the_page_of_the_rule_is_true() {
    let page = Rule::named("device-comments").unwrap().page();
    let tables: Vec<&str> =
        page.split("```csv\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert_eq!(tables.len(), 2);
    for table in tables {
        let is_mark = |line: &str| line.contains('^');
        let text: String =
            table.lines().filter(|line| !is_mark(line)).map(|line| format!("{line}\n")).collect();
        let mut expected = Vec::new();
        let mut line_number = 0;
        for line in table.lines() {
            match is_mark(line) {
                true => {
                    expected.push((line_number, line.find('^').unwrap() as u32, line.matches('^').count()))
                }
                false => line_number += 1,
            }
        }
        let file = read(&text);
        let found = file.diagnostics.iter().map(|found| {
            let at = file.position(found.span.start, Encoding::Utf32);
            (at.line + 1, at.column, found.span.len())
        });
        assert_eq!(found.collect::<Vec<_>>(), expected, "{table}");
    }
}

fn with_symbols(text: &str, notation: Notation) -> Document {
    let file = read("X0,Start,green button\nY0,Motor,contactor\nT0,Delay,\nX1,停止,red button\nD0,Speed,\n");
    Document::with_comments(text, notation, fx2n(), file.comments)
}

fn codes(document: &Document) -> Vec<String> {
    let found = check::all(document, &crate::rules_sense::without_sense());
    found.iter().map(|found| format!("{} {}", found.code, found.message.render(Language::English))).collect()
}

fn devices(document: &Document) -> Vec<String> {
    let mentions = document.chunks().flat_map(|at| at.chunk.mentions().iter());
    let names = mentions.map(|mention| match &mention.symbol {
        Symbol::Device(device) => device.to_string(),
        other => format!("{other:?}"),
    });
    names.collect()
}

#[test]
fn a_symbol_is_its_device_in_lists() {
    let text = "LD start\nANI 停止\nOUT Motor\nOUT Delay K50\nLD>= Speed K10\nOUT Y1\nEND\n";
    let document = with_symbols(text, Notation::FxIl);
    assert_eq!(codes(&document), Vec::<String>::new());
    assert_eq!(devices(&document), ["X0", "X1", "Y0", "T0", "D0", "Y1"]);
    // Without the table the same words mean nothing.
    let bare = document.commented(&std::sync::Arc::default());
    assert!(codes(&bare).iter().any(|code| code.starts_with("unknown-device")));
    let formatted = rungwise::ide::format(
        &document,
        rungwise::ide::Style { kind: rungwise::project::FormatStyle::Iec, width: 48 },
    );
    assert_eq!(formatted, [], "a symbol keeps its letters");
}

#[test]
fn a_symbol_is_its_device_in_drawings() {
    let text = "\
|  Start    停止                        Motor |
+--| |------|/|-----------+--------------( )--+
|  Motor                  |                   |
+--| |--------------------+                   |
|                                             |
|  Motor                          Delay K50   |
+--| |------------------------------( )-------+

+--[Start]--[停止]---------------(Delay K50)--+
";
    let document = with_symbols(text, Notation::Ladder);
    let names = devices(&document);
    for name in ["X0", "X1", "Y0", "T0"] {
        assert!(names.contains(&name.to_string()), "{name}: {names:?}");
    }
    let unknown: Vec<String> = codes(&document).into_iter().filter(|code| code.contains("unknown")).collect();
    assert_eq!(unknown, Vec::<String>::new());
}

#[test]
fn a_file_that_is_not_read_to_its_end_says_where_reading_ended() {
    let keys = |text: &str| -> Vec<(&'static str, usize)> {
        let file = CommentsFile::read(Path::new("devices.csv"), text, fx2n());
        let line = |offset: u32| text[..offset as usize].matches('\n').count();
        file.diagnostics.iter().map(|found| (found.message.key(), line(found.span.start))).collect()
    };
    let rows = "\"\",,\n".repeat(200_000);
    assert_eq!(keys(&format!("{rows}\n \n")), []);
    assert_eq!(keys(&format!("{rows}\nX0,Start,\nX1,,\n")), [("device-comments.too-many", 200_001)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// No bytes make the reader fail, and every place that it names lies in the text.
    #[test]
    fn any_bytes_are_read(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let text = decode(&bytes);
        let file = read(&text);
        for found in &file.diagnostics {
            prop_assert!(text.get(found.span.range()).is_some());
        }
        for row in file.comments.rows() {
            prop_assert!(text.get(row.thing_span.range()).is_some() && text.get(row.symbol_span.range()).is_some());
        }
    }

    #[test]
    fn any_table_is_read(text in "([XYMTDK%\"',;\t\r\n 0-9a-z启]{0,6}[,;\t\n]){0,30}") {
        let file = read(&text);
        for row in file.comments.rows() {
            prop_assert!(!row.thing_span.of(&text).is_empty());
        }
    }

    /// A document whose comments change equals the one that had them from the start.
    #[test]
    fn comments_put_in_later_are_the_same(lines in proptest::collection::vec("(LD|OUT|AND) (Start|Motor|X0|Nobody)", 1..20)) {
        let text = lines.join("\n");
        let at_once = with_symbols(&text, Notation::FxIl);
        let later = Document::new(&text, Notation::FxIl, fx2n()).commented(at_once.comments());
        prop_assert_eq!(devices(&at_once), devices(&later));
        prop_assert_eq!(codes(&at_once), codes(&later));
    }
}
