//! Texts of LDmicro: its export as a drawing, in both generations, and its own file.

use crate::ladder_read::{chunks, dump};
use rungwise::document::{DeclaredType, Document, Notation, Tree, detect_ladder_target};
use rungwise::ide::{self, Style};
use rungwise::ladder::{TableRow, parse, table_rows, time_literal};
use rungwise::project::FormatStyle;
use rungwise::target::iec::ElementaryType;
use rungwise::target::{Model, Target};
use rungwise::text::{Language, TextEdit};
use rungwise::{check, project};
use std::path::Path;

fn iec() -> &'static Target {
    Target::of(Model::Iec)
}

/// The logic of all rungs of a document, `[END]` left out.
fn logic(text: &str) -> String {
    let trees = chunks(text).into_iter().map(|chunk| (chunk, parse(chunk, iec())));
    let dumped: Vec<String> = trees.map(|(chunk, tree)| dump(&tree, chunk)).collect();
    let rungs = dumped.iter().flat_map(|text| text.split("--\n")).filter(|rung| !rung.is_empty());
    rungs.filter(|rung| !rung.contains("[END]")).collect::<Vec<_>>().join("--\n")
}

/// The drawing between its rails, in a grid of the second generation, reads as `expected`.
fn check_rung(drawing: &str, expected: &str) {
    let width = drawing.lines().map(|line| line.chars().count()).max().unwrap();
    let last = drawing.lines().count() - 1;
    let row = |(number, line): (usize, &str)| match number == last {
        true => format!("    ||{line:-<width$}||\n"),
        false => format!("    ||{line:width$}||\n"),
    };
    let text: String = drawing.lines().enumerate().map(row).collect();
    assert_eq!(logic(&text), unindent(expected), "\n{text}");
}

fn unindent(text: &str) -> String {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.map(|line| format!("{line}\n")).collect()
}

#[test]
fn timers_are_blocks_with_their_preset() {
    for (symbol, block) in [
        ("[TON 1.000 s]", "T1:TON IN=wire PT=T#1s =>Q=wire"),
        ("[TON 40 ms]", "T1:TON IN=wire PT=T#40ms =>Q=wire"),
        ("[TOF 1.5 s]", "T1:TOF IN=wire PT=T#1500ms =>Q=wire"),
        ("[RTO 500 us]", "T1:RTO IN=wire PT=T#0.5ms =>Q=wire"),
        ("[TCY 2 s]", "T1:TCY IN=wire PT=T#2s =>Q=wire"),
        ("[THI 2 s]", "T1:THI IN=wire PT=T#2s =>Q=wire"),
        ("o[TLO 2 s]", "T1:TLO IN=wire PT=T#2s =>Q=wire"),
        ("o[RTL 2 s]", "T1:RTL IN=wire PT=T#2s =>Q=wire"),
        ("[TON delay]", "T1:TON IN=wire PT=delay =>Q=wire"),
    ] {
        let drawing = format!("      Xa             T1             Yb    \n------] [--------{symbol:-<16}---( )-----");
        let name = block.split(' ').next().unwrap();
        check_rung(&drawing, &format!("L Xa {name}.IN\n{name}.Q (Yb) R\nblock {block}"));
    }
}

#[test]
fn counters_are_blocks_with_limit_and_start_value() {
    for (name, symbol, block) in [
        ("C2", "[CTU >=5]", "C2:CTU CU=wire PV=5 =>Q=wire"),
        ("C2", "[CTU>=limit]", "C2:CTU CU=wire PV=limit =>Q=wire"),
        ("C2:0", "/[CTU>=5]", "C2:CTU CU=wire PV=5 INIT=0 =>Q=wire"),
        ("C2:-3", "/[CTD>-5]", "C2:CTD CD=wire PV=-5 INIT=-3 =>Q=wire"),
        ("C2", "\\[CTU>=5]", "C2:CTU CU=not wire PV=5 =>Q=wire"),
        ("C2", "[CTC 0:7]", "C2:CTC CU=wire PV=7 INIT=0 =>Q=wire"),
        ("C2", "/[CTR 0:-7]", "C2:CTR CD=wire PV=-7 INIT=0 =>Q=wire"),
    ] {
        let drawing =
            format!("      Xa             {name:15}Yb    \n------] [--------{symbol:-<16}---( )-----");
        let words = block.split(' ').next().unwrap();
        let pin = block.split([' ', '=']).nth(1).unwrap();
        check_rung(&drawing, &format!("L Xa {words}.{pin}\n{words}.Q (Yb) R\nblock {block}"));
    }
    // The first generation draws it as an output.
    check_rung(
        "      Xa                   C2         \n------] [--------------{CTC 0:7}------",
        "L Xa C2:CTC.CU
         C2:CTC.Q R
         block C2:CTC CU=wire PV=7 INIT=0 =>Q=wire",
    );
}

#[test]
fn waves_are_edges() {
    for (wave, symbol, block) in [
        ("    _     _    ", "[_/ OSR_/ \\_]", "_:R_TRIG CLK=wire =>Q=wire"),
        ("  _       _    ", "[ \\_OSF_/ \\_]", "_:F_TRIG CLK=wire =>Q=wire"),
        ("  _     _   _ ", "[ \\_OSL \\_/ ]", "_:F_TRIG CLK=wire =>Q=not wire"),
        ("    _     _  ", "[_/ ODR \\_/ ]", "_:R_TRIG CLK=wire =>Q=not wire"),
        ("   _     _   _  ", "[_/ OSC_/ \\_/ \\]", "_:OSC IN=wire =>Q=wire"),
        ("", "[_/ OSR_/ \\_]", "_:R_TRIG CLK=wire =>Q=wire"),
    ] {
        let drawing = format!("      Xa         {wave:17}     Yb      \n------] [--------{symbol:-<17}----( )-----");
        let name = block.split(' ').next().unwrap();
        let pin = block.split([' ', '=']).nth(1).unwrap();
        check_rung(&drawing, &format!("L Xa {name}.{pin}\n{name}.Q (Yb) R\nblock {block}"));
    }
}

#[test]
fn boxes_of_two_rows() {
    for (upper, lower, expected) in [
        ("{MOV    speed:=}", "{      100     }", "_:MOVE EN=wire IN=100 =>ENO=wire =>OUT=speed"),
        ("{MOV  speed:=}", "{  100  }", "_:MOVE EN=wire IN=100 =>ENO=wire =>OUT=speed"),
        ("{ADD      a:=}", "{a     +     1}", "_:ADD EN=wire IN1=a IN2=1 =>ENO=wire =>OUT=a"),
        ("{ADD  a  :=}", "{ a + 1 }", "_:ADD EN=wire IN1=a IN2=1 =>ENO=wire =>OUT=a"),
        ("{SUB      a:=}", "{-1    -    -2}", "_:SUB EN=wire IN1=-1 IN2=-2 =>ENO=wire =>OUT=a"),
        ("{MUL      a:=}", "{a     *     b}", "_:MUL EN=wire IN1=a IN2=b =>ENO=wire =>OUT=a"),
        ("{DIV      a:=}", "{a     /     b}", "_:DIV EN=wire IN1=a IN2=b =>ENO=wire =>OUT=a"),
        ("{MOD      a:=}", "{a     %     b}", "_:MOD EN=wire IN1=a IN2=b =>ENO=wire =>OUT=a"),
        ("{AND      a:=}", "{a     &     b}", "_:AND EN=wire IN1=a IN2=b =>ENO=wire =>OUT=a"),
        ("{OR       a:=}", "{a     |     b}", "_:OR EN=wire IN1=a IN2=b =>ENO=wire =>OUT=a"),
        ("{NOT      a:=}", "{     ~b      }", "_:NOT EN=wire IN=b =>ENO=wire =>OUT=a"),
        ("{SHL      a:=}", "{a    <<    2}", "_:SHL EN=wire IN=a N=2 =>ENO=wire =>OUT=a"),
        ("{       a:=}", "{SWAP      b}", "_:SWAP EN=wire IN=b =>ENO=wire =>OUT=a"),
    ] {
        let drawing = format!("      Xa         {upper:17}\n------] [--------{lower:-<17}");
        let name = expected.split(' ').next().unwrap();
        check_rung(&drawing, &format!("L Xa {name}.EN\n{name}.ENO R\nblock {expected}"));
    }
    for (upper, lower, expected) in [
        ("[C1 ==]", "[ 0   ]", "[= C1 0]"),
        ("[C1 !=]", "[    0]", "[<> C1 0]"),
        ("[C1 /=]", "[ 0   ]", "[<> C1 0]"),
        ("[a >]", "[ -12 ]", "[> a -12]"),
        ("[a  >=]", "[  b  ]", "[>= a b]"),
        ("[a <]", "[ b ]", "[< a b]"),
        ("[a <=]", "[ b  ]", "[<= a b]"),
    ] {
        let drawing = format!("     {upper:13}   Yb    \n-----{lower:-<13}--( )----");
        check_rung(&drawing, &format!("L {expected} (Yb) R"));
    }
}

#[test]
fn commands_take_the_name_above() {
    for (name, symbol, expected) in [
        ("C2", "{RES}", "L Xa (R C2) R"),
        ("Ra", "(T)", "L Xa (T Ra) R"),
        ("done", "{GOTO}", "L Xa >>done R"),
        ("", "{RETURN}", "L Xa <RETURN> R"),
        ("Ain", "{READ ADC}", "L Xa _:READ_ADC.EN\n_:READ_ADC.ENO R\nblock _:READ_ADC EN=wire =>ENO=wire =>OUT=Ain"),
        ("x", "{PERSIST}", "L Xa _:PERSIST.EN\n_:PERSIST.ENO R\nblock _:PERSIST EN=wire IN=x =>ENO=wire"),
        ("", "{MASTER RLY}", "L Xa _:MASTER_RLY.EN\n_:MASTER_RLY.ENO R\nblock _:MASTER_RLY EN=wire =>ENO=wire"),
        ("50", "{PWM Pout}", "L Xa _:PWM.EN\n_:PWM.ENO R\nblock _:PWM EN=wire IN1=50 IN2=Pout =>ENO=wire"),
    ] {
        let blank = " ".repeat((symbol.len() - name.len().min(symbol.len())) / 2);
        let drawing = format!("      Xa         {blank}{name:16}\n------] [--------{symbol:-<16}");
        check_rung(&drawing, expected);
    }
}

#[test]
fn wires_that_are_open_or_closed_on_purpose() {
    check_rung(
        "      Xa                           Yb    \n------] [--------+------+---------( )----",
        "L Xa (Yb) R",
    );
    check_rung(
        "      Xa                           Yb    \n------] [--------+      +---------( )----",
        "L Xa FALSE (Yb) R",
    );
    check_rung("      Xa                      Yb    \n-----^] [--------------------( )----", "L Xa (Yb) R");
    // Between single rails the same gap is a mistake.
    let single = "|   Xa                      Yb   |\n+---] [------+      +------( )---+\n";
    assert!(logic(single).contains('?'), "{}", logic(single));
}

/// Both generations of one program: a lamp with delay, and a counter that a button resets.
const FIRST: &str = "\
LDmicro export text
for 'Microchip PIC16F628 18-PDIP', 4.000000 MHz crystal, 10.0 ms cycle time

LADDER DIAGRAM:


   ||                                                                         ||
   || ; The lamp comes a second after the button.                             ||
 1 || ; (* and goes at once *)                                                ||
   ||                                                                         ||
   ||                                                                         ||
   ||                                                                         ||
   ||                                                                         ||
   ||      Xbutton           Tdelay                            Ylamp          ||
 2 ||-------] [---------[TON 1.000 s]---+-----------------------( )-----------||
   ||                                   |                                     ||
   ||                                   |     Rlast             Rlast         ||
   ||                                   +------]/[--------------(S)-----------||
   ||                                                                         ||
   ||                                                                         ||
   ||                                                                         ||
   ||      Xreset                                              Ccount         ||
 3 ||-------] [----------------------------------------------{RES}------------||
   ||                                                                         ||
   ||                                                                         ||
   ||                                                                         ||
   ||------[END]--------------------------------------------------------------||
   ||                                                                         ||
   ||                                                                         ||


I/O ASSIGNMENT:

  Name                       | Type               | Pin
 ----------------------------+--------------------+------
  Xbutton                    | digital in         | 17
  Xreset                     | digital in         | 18
  Ylamp                      | digital out        | 1
  Rlast                      | int. relay         |
  Tdelay                     | turn-on delay      |
  Ccount                     | counter            |
";

const SECOND: &str = "\
LDmicro export text.
Source file: C:\\plc\\lamp.ld from 01/02/2021 10:11:12
for 'Microchip PIC16F628 18-PDIP or 18-SOIC', 4 MHz crystal, 10.000 ms cycle time

LADDER DIAGRAM:
    ||                                                                         ||
    || ; The lamp comes a second after the button.                             ||
0001|| ; (* and goes at once *)                                                ||
    ||                                                                         ||
    ||                                                                         ||
    ||      Xbutton           Tdelay                            Ylamp          ||
0002||-------] [-----------[TON 1 s]----+-----------------------( )------------||
  12||                                  |                                      ||
  40||                                  |     Rlast             Rlast          ||
    ||                                  +------]/[--------------(S)------------||
    ||                                                                         ||
    ||                                                                         ||
    ||      Xreset                                              Ccount         ||
0003||-------] [----------------------------------------------{RES}------------||
   4||                                                                         ||
  12||                                                                         ||
    ||------[END]--------------------------------------------------------------||
   3||                                                                         ||
  40||                                                                         ||
    ||                                                                         ||

AFFECTATIONS E/S:
  Nom                        | Type               | Pin | Port | Pin name
 ----------------------------+--------------------+-----+------+-----------
  Xbutton                    | Entr\u{e9}e digitale    |  17 | RA0   | RA0
  Xreset                     | Entr\u{e9}e digitale    |  18 | RA1   | RA1
  Ylamp                      | Sortie digitale    |   1 | RA2   | RA2
  Rlast                      | Relais interne     |     |       | 
  Tdelay                     | Tempo travail      |     |       | 
  Ccount                     | Compteur           |     |       | 

VAR LIST:
  2 bytes Tdelay
  2 bytes Ccount     ; Now not used !!!
END
";

const LAMP: &str = "
    number 2
    L Xbutton Tdelay:TON.IN
    Tdelay:TON.Q J1
    J1 (Ylamp) R
    J1 /Rlast (S Rlast) R
    block Tdelay:TON IN=wire PT=T#1s =>Q=wire
    --
    number 3
    L Xreset (R Ccount) R";

fn open(text: &str) -> Document {
    Document::new(text, Notation::Ladder, detect_ladder_target(text))
}

#[test]
fn both_generations_say_the_same() {
    for text in [FIRST.to_string(), SECOND.to_string(), FIRST.replace('\n', "\r\n")] {
        assert_eq!(logic(&text), unindent(LAMP), "{text}");
        let document = open(&text);
        assert_eq!(document.target().model, Model::Iec);
        let found = check::all(&document, &check::Severities::default());
        assert!(found.is_empty(), "{found:?}");
    }
}

#[test]
fn a_comment_between_the_rails_belongs_to_the_rung_below() {
    for text in [FIRST, SECOND] {
        let document = open(text);
        let outline = ide::symbols(&document, Language::English);
        let first = outline.iter().find(|node| node.name.contains("Rung 1")).unwrap();
        assert_eq!(first.name, "Rung 1: The lamp comes a second after the button.");
    }
}

#[test]
fn tables_declare_names_with_type_and_pin() {
    for (text, kind) in [(FIRST, "digital in"), (SECOND, "Entr\u{e9}e digitale")] {
        let document = open(text);
        let scopes = document.scopes();
        let declared = |name: &str| scopes.variable(None, name).map(|variable| variable.declared.clone());
        assert_eq!(declared("xbutton"), Some(DeclaredType::Elementary(ElementaryType::Bool)));
        assert_eq!(declared("Ccount"), Some(DeclaredType::Elementary(ElementaryType::Int)));
        assert_eq!(scopes.globals.len(), 6);
        let at = text.find("Xbutton").unwrap() + 2;
        let hover = ide::hover(&document, at, Language::English).unwrap();
        assert!(hover.markdown.contains(&format!("Xbutton AT 17 : {kind}")), "{}", hover.markdown);
        let table = text.rfind("  Xbutton").unwrap() + 2;
        assert_eq!(ide::definition(&document, at)[0].start as usize, table);
        assert_eq!(ide::references(&document, at, true).len(), 2);
        let renamed = TextEdit::apply_all(&ide::rename(&document, at, "Xstart").unwrap(), text);
        assert!(renamed.contains("  Xstart  ") && !renamed.contains("Xbutton"), "{renamed}");
    }
}

#[test]
fn completion_shows_type_and_pin() {
    let text = FIRST.replacen("Xreset   ", "Xr       ", 1);
    let document = open(&text);
    let at = text.find("Xr ").unwrap() + 2;
    let proposals = ide::completions(&document, at, Language::English);
    let detail = proposals.iter().find(|proposal| proposal.label == "Xreset").map(|found| &found.detail);
    assert_eq!(detail.map(String::as_str), Some("Xreset AT 18 : digital in"));
}

#[test]
fn rows_of_tables() {
    let words = |text: &'static str| {
        let row = |row: TableRow| {
            let word = |span: Option<rungwise::text::Span>| span.map_or("", |span| span.of(text));
            [row.name.of(text), word(row.kind), word(row.pin)]
        };
        table_rows(text).into_iter().map(row).collect::<Vec<_>>()
    };
    let table = "I/O ASSIGNMENT:\n\n Name | Type | Pin\n---+----+--\n  Xa | in | 2\n  b | general var |\n\nVAR LIST:\n  2 bytes b\n  1 byte c ; no\nEND\n";
    assert_eq!(words(table), [["Xa", "in", "2"], ["b", "general var", ""], ["c", "", ""]]);
    assert!(table_rows("LDmicro export text\nfor 'x' | y\n").is_empty());
}

#[test]
fn a_title_without_a_table_swallows_nothing() {
    for title in ["I/O ASSIGNMENT:", "VAR LIST:", "Pump on/off:"] {
        let text = format!("{title}\n|   X0        Y0  |\n+---| |-------( )-+\n");
        assert_eq!(logic(&text), "L X0 (Y0) R\n", "{title}");
    }
}

#[test]
fn a_head_without_its_last_line_ends_at_the_drawing() {
    let text = "LDmicro export text\n\n   ||   Xa         Yb  ||\n 1 ||--] [--------( )--||\n";
    assert_eq!(logic(text), "number 1\nL Xa (Yb) R\n");
}

#[test]
fn the_canonical_form_has_the_same_logic() {
    for text in [FIRST, SECOND] {
        let document = open(text);
        let style = Style { kind: FormatStyle::Iec, width: 48 };
        let formatted = TextEdit::apply_all(&ide::format(&document, style), text);
        // Counts of a translation beside a rung of several rows have no place in the canonical form.
        assert_eq!(formatted.contains("| TON |"), text == FIRST, "{formatted}");
        assert_eq!(logic(&formatted), logic(text), "{formatted}");
        let table = |text: &str| text[text.find(" | Type").unwrap()..].to_string();
        assert_eq!(table(&formatted), table(text));
        let again = open(&formatted);
        assert!(ide::format(&again, style).is_empty(), "{formatted}");
        let found = check::all(&again, &check::Severities::default());
        assert!(found.is_empty(), "{formatted}\n{found:?}");
    }
}

#[test]
fn times_as_literals() {
    for (text, literal) in [
        ("1.000 s", Some("T#1s")),
        ("1.5 s", Some("T#1500ms")),
        ("40 ms", Some("T#40ms")),
        ("0.25 ms", Some("T#0.25ms")),
        ("500 us", Some("T#0.5ms")),
        ("2 ks", Some("T#2000s")),
        ("0 s", Some("T#0ms")),
        ("40ms", Some("T#40ms")),
        ("s", None),
        ("1.2.3 s", None),
        ("99999999999999 s", None),
        ("12", None),
        ("delay", None),
        ("1 h", None),
    ] {
        assert_eq!(time_literal(text).as_deref(), literal, "{text}");
    }
}

/// What the two exports of another author say, read by eye.
const OTHERS: &[(&str, &str)] = &[
    (
        "ldmicrowebsim-readme-0.txt",
        "number 1
         L XS1 /XS2 (YH1) R
         --
         number 2
         L XS2 /XS3 (YH2) R
         --
         number 3
         L XS3 /XS1 (YH3) R",
    ),
    (
        "ldmicrowebsim-test-0.txt",
        "number 1
         L XPIR J1
         J1 (R1) R
         J1 (R C2) R
         --
         number 2
         L R2 J1
         J1 [= C1 0] (YFAN1) R
         J1 [= C1 1] (YFAN2) R
         J1 [= C1 2] (YFAN3) R
         --
         number 3
         L R3 C2:CTU.CU
         C2:CTU.Q J1
         J1 (R4) R
         J1 (R5) R
         block C2:CTU CU=wire PV=4 =>Q=wire",
    ),
];

#[test]
fn programs_by_other_people() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let places = ["../shared/corpus/ladder", "../../shared/corpus/ladder"];
    let Some(folder) = places.iter().map(|place| root.join(place)).find(|folder| folder.exists()) else {
        crate::corpus::say_skipped(&format!("no folder {}", root.join(places[0]).display()));
        return;
    };
    for (name, expected) in OTHERS {
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        // The first line says where the file comes from.
        let text = &text[text.find('\n').unwrap() + 1..];
        assert_eq!(logic(text), unindent(expected), "{name}");
        let document = project::open_document("x.lad", text, &project::Manifest::default(), None, None);
        let found = check::all(&document, &check::Severities::default());
        assert!(found.is_empty(), "{name}: {found:?}");
        let tables = document.chunks().filter(|at| matches!(at.chunk.tree(), Tree::Iec(_))).count();
        assert_eq!(tables, 1, "{name}");
    }
}
