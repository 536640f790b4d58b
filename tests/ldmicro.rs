//! Texts of LDmicro: its export as a drawing, in both generations, and its own file.

use crate::ladder_read::{chunks, dump};
use crate::rules_sense::without_sense;
use proptest::prelude::*;
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
        let drawing =
            format!("      Xa             T1             Yb    \n------] [--------{symbol:-<16}---( )-----");
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
        let drawing =
            format!("      Xa         {wave:17}     Yb      \n------] [--------{symbol:-<17}----( )-----");
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
        (
            "Ain",
            "{READ ADC}",
            "L Xa _:READ_ADC.EN\n_:READ_ADC.ENO R\nblock _:READ_ADC EN=wire =>ENO=wire =>OUT=Ain",
        ),
        ("x", "{PERSIST}", "L Xa _:PERSIST.EN\n_:PERSIST.ENO R\nblock _:PERSIST EN=wire IN=x =>ENO=wire"),
        (
            "",
            "{MASTER RLY}",
            "L Xa _:MASTER_RLY.EN\n_:MASTER_RLY.ENO R\nblock _:MASTER_RLY EN=wire =>ENO=wire",
        ),
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
        let found = check::all(&document, &without_sense());
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
        let found = check::all(&again, &without_sense());
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
        let found = check::all(&document, &without_sense());
        assert!(found.is_empty(), "{name}: {found:?}");
        let tables = document.chunks().filter(|at| matches!(at.chunk.tree(), Tree::Iec(_))).count();
        assert_eq!(tables, 1, "{name}");
    }
}

const NATIVE: &str = "\
LDmicro0.2
MICRO=Atmel AVR ATmega8 28-PDIP
CYCLE=10000 us at Timer1, YPlcCycleDuty:0
CRYSTAL=16000000 Hz
BAUD=2400 Hz
COMPILED=C:\\plc\\pump.hex

PULL-UP LIST
    B: 0xff
END

VAR LIST
  2 bytes Tdelay     ; Now not used !!!
END

IO LIST
    Xstart at 14
    Xstop at 15
    Ymotor at 16 0 0
    Ylamp at 0
END

PROGRAM
RUNG 1
    COMMENT Seal-in,\\r\\nas ever (* really *)
END
RUNG 2
    PARALLEL
        CONTACTS Xstart 0 0
        CONTACTS Ymotor 0 0
    END
    CONTACTS Xstop 1
    TON Tdelay 1500000 0
    PARALLEL
        COIL Ymotor 0 0 0
        SERIES
            CTU Ccount 5 0
            PARALLEL
                COIL Ylamp 0 0 0
                RES Ccount
            END
        END
        MOVE speed 0x1F
    END
END
RUNG 3
    EQU Ccount 3
    OSR
    ADD speed speed -2
END
";

fn imported(source: &str) -> rungwise::ladder::Import {
    rungwise::ladder::import(source, "pump", Language::English).unwrap()
}

fn notes(import: &rungwise::ladder::Import) -> Vec<String> {
    let note =
        |note: &rungwise::ladder::Note| format!("{}: {}", note.line, note.message.render(Language::English));
    import.notes.iter().map(note).collect()
}

/// The imported text has no mistakes but those of these codes.
fn check_import(import: &rungwise::ladder::Import, codes: &[&str]) {
    let document = open(&import.text);
    let found = check::all(&document, &without_sense());
    let found: Vec<_> = found.iter().map(|found| found.code).collect();
    assert_eq!(found, codes, "{}", import.text);
    let style = Style { kind: FormatStyle::Iec, width: 48 };
    let formatted = TextEdit::apply_all(&ide::format(&document, style), &import.text);
    assert_eq!(logic(&formatted), logic(&import.text));
}

#[test]
fn a_native_file_becomes_a_program() {
    let import = imported(NATIVE);
    let expected = "
        J1 /Xstop Tdelay:TON.IN
        L Xstart J1
        L Ymotor J1
        Tdelay:TON.Q J2
        J2 (Ymotor) R
        J2 Ccount:CTU.CU
        J2 _:MOVE.EN
        Ccount:CTU.Q J3
        J3 (Ylamp) R
        J3 (R Ccount) R
        _:MOVE.ENO R
        block Tdelay:TON IN=wire PT=T#1500ms =>Q=wire
        block Ccount:CTU CU=wire PV=5 =>Q=wire
        block _:MOVE EN=wire IN=16#1F =>ENO=wire =>OUT=speed
        --
        L [= Ccount.CV 3] OSR_1:R_TRIG.CLK
        OSR_1:R_TRIG.Q _:ADD.EN
        _:ADD.ENO R
        block OSR_1:R_TRIG CLK=wire =>Q=wire
        block _:ADD EN=wire IN1=speed IN2=-2 =>ENO=wire =>OUT=speed";
    let sorted = |text: &str| {
        let mut lines: Vec<String> = text.lines().map(|line| line.trim().to_string()).collect();
        lines.retain(|line| !line.is_empty());
        lines.sort();
        lines
    };
    assert_eq!(sorted(&logic(&import.text)), sorted(expected), "{}", import.text);
    assert_eq!(import.rungs, 2);
    assert_eq!(notes(&import), ["8: 1 pull-up settings of inputs belong to the chip and are left out"]);
    for line in [
        "PROGRAM pump",
        "    Xstart : BOOL; (* pin 14 *)",
        "    Ylamp  : BOOL;\n",
        "    Tdelay : TON;\n",
        "    Ccount : CTU;\n",
        "    speed  : INT;\n",
        "    OSR_1  : R_TRIG;\n",
        "(* Seal-in,\n   as ever ( * really * ) *)\n",
        "MICRO = Atmel AVR ATmega8 28-PDIP",
        "Line 8: 1 pull-up",
        "END_PROGRAM",
    ] {
        assert!(import.text.contains(line), "{line}\n{}", import.text);
    }
    check_import(&import, &[]);
}

#[test]
fn what_is_missing_is_said_once() {
    let open = imported("LDmicro0.1\nPROGRAM\nRUNG\nPARALLEL\nSERIES\nPARALLEL\nSERIES\nCONTACTS Xa 0\n");
    assert_eq!(notes(&open), ["8: a circuit has no END"]);
    let drawing = "   ||                   ||\n 1 ||-----] [----( )-----||\n";
    let nameless = imported(&format!("LDmicro export text\n\nLADDER DIAGRAM:\n\n{drawing}"));
    let named = |name: &str| nameless.text.contains(&format!("    {name} : BOOL;\n"));
    assert!(named("v_1") && named("v_2"), "{}", nameless.text);
    let said = ["6: an element has no name; it is called v_1", "6: an element has no name; it is called v_2"];
    assert!(said.iter().all(|said| notes(&nameless).contains(&said.to_string())), "{:?}", notes(&nameless));
}

#[test]
fn an_export_becomes_the_same_program_with_pins_and_types() {
    for text in [FIRST, SECOND] {
        let import = imported(text);
        assert_eq!(logic(&import.text), unindent(LAMP).replace("number 2\n", "").replace("number 3\n", ""));
        assert_eq!(notes(&import), [""; 0]);
        // The head is long, and all of it is carried over.
        assert!(import.text.contains(" ms cycle time"), "{}", import.text);
        let kind = if text == FIRST { "digital in" } else { "Entr\u{e9}e digitale" };
        assert!(import.text.contains(&format!("Xbutton : BOOL; (* {kind}, pin 17 *)")), "{}", import.text);
        assert!(
            import
                .text
                .contains("(* The lamp comes a second after the button.\n   ( * and goes at once * ) *)")
        );
        assert!(import.text.contains("    Tdelay  : TON; (* "), "{}", import.text);
    }
}

#[test]
fn what_has_no_counterpart_is_said_and_drawn() {
    let rung = |leaf: &str| {
        format!("LDmicro0.1\n\nPROGRAM\nRUNG\n    CONTACTS Xa 0\n    {leaf}\n    COIL Yb 0 0 0\nEND\n")
    };
    for (leaf, note, drawn) in [
        ("RTO Tr 10000", "RTO has no counterpart in IEC 61131-3; it is drawn as LDMICRO_RTO", "LDMICRO_RTO"),
        ("CTD Cd 2 10", "CTD has no counterpart in IEC 61131-3; it is drawn as LDMICRO_CTD", "LDMICRO_CTD"),
        ("CTU Cu 5 3", "Cu starts at 3 in LDmicro, at 0 here", "CTU"),
        ("CTU Cu 5 0 -", "Cu counts as long as it has power", "CTU"),
        ("TON Td var", "the delay var is a variable", "var--|PT"),
        ("TON Td 1000 7", "the adjustment of the delay of Td", "T#1ms"),
        ("STEPPER a b c 1 2 d", "STEPPER has no counterpart", "LDMICRO_STEPPER"),
        ("CONTACTS R__x_ 0", "R__x_ is no identifier of IEC 61131-3 or is taken; it is called R_x", "R_x"),
        ("CONTACTS TON 0", "TON is no identifier of IEC 61131-3 or is taken; it is called v_TON", "v_TON"),
        ("OPEN", "", "FALSE"),
        ("SHORT", "", "Yb"),
    ] {
        let import = imported(&rung(leaf));
        let found = notes(&import);
        match note {
            "" => assert!(found.is_empty(), "{leaf}: {found:?}"),
            note => assert!(
                found.iter().any(|found| found.starts_with(&format!("6: {note}"))),
                "{leaf}: {found:?}"
            ),
        }
        assert!(import.text.contains(drawn), "{leaf}\n{}", import.text);
        assert!(
            found.iter().all(|note| import.text.contains(note.split_once(": ").unwrap().1)),
            "{}",
            import.text
        );
    }
}

#[test]
fn names_that_differ_in_case_alone_stay_apart() {
    let source = "LDmicro0.1\nPROGRAM\nRUNG\nCONTACTS Ra 0\nCONTACTS RA 0\nCOIL Yb 0 0 0\nEND\n";
    let import = imported(source);
    assert!(import.text.contains("    Ra   : BOOL;\n    RA_2 : BOOL; (* RA *)\n"), "{}", import.text);
}

#[test]
fn jumps_and_labels() {
    let source = "LDmicro0.2\nPROGRAM\nRUNG 1\nCONTACTS Xa 0\nGOTO done\nEND\nRUNG 2\nCONTACTS Xb 0\nCOIL Yb 0 0 0\n\
                  END\nRUNG 3\nLABEL done\nEND\nRUNG 4\nCONTACTS Xc 0\nCOIL Yc 0 0 0\nEND\n";
    let import = imported(source);
    assert!(import.text.contains(">>done"), "{}", import.text);
    assert!(import.text.contains("done:\n|"), "{}", import.text);
    check_import(&import, &[]);
}

#[test]
fn broken_files_are_imported_as_far_as_they_go() {
    for (source, expected) in [
        ("LDmicro0.1\nPROGRAM\nRUNG\nCONTACTS Xa 0\nCOIL Yb 0 0 0\n", "5: a circuit has no END"),
        ("LDmicro0.1\nnonsense\nPROGRAM\nRUNG\nCOIL Yb 0 0 0\nEND\n", "2: not read: `nonsense`"),
        ("LDmicro0.1\nPROGRAM\nRUNG\nEND\n", "3: the rung is empty"),
        ("LDmicro0.1\nPROGRAM\nRUNG\nPARALLEL\nCONTACTS Xa\nRUNG\nCOIL Yb\nEND\n", "6: a circuit has no END"),
    ] {
        let import = imported(source);
        assert!(notes(&import).iter().any(|note| note == expected), "{source}\n{:?}", notes(&import));
    }
    let deep = format!("LDmicro0.1\nPROGRAM\nRUNG\n{}CONTACTS Xa\n", "PARALLEL\nSERIES\n".repeat(50_000));
    assert!(notes(&imported(&deep)).iter().any(|note| note.contains("nested more than")));
    for source in ["", "LDmicro", "LDmicro exported", "PROGRAM\nRUNG\n", "\u{0}\u{1}"] {
        let error = rungwise::ladder::import(source, "x", Language::English).unwrap_err();
        assert_eq!(error, rungwise::ladder::ImportError::Unknown, "{source}");
    }
}

/// Lines of native files, whole and broken.
const LINES: &[&str] = &[
    "RUNG",
    "END",
    "PARALLEL",
    "SERIES",
    "CONTACTS Xa 0",
    "CONTACTS Ra 1 0",
    "COIL Yb 0 0 0",
    "COIL Yb 0 0 0 1",
    "TON Ta 1000000",
    "TOF Tb 5 0",
    "RTO Tc x",
    "CTU Ca 5 0",
    "CTD Cb",
    "CTC Cc 7",
    "RES Ca",
    "MOVE a b",
    "ADD a b 3",
    "EQU a 0x10",
    "GEQ Ca",
    "OSR",
    "OSC",
    "OPEN",
    "SHORT",
    "PLACEHOLDER",
    "LABEL L",
    "GOTO L",
    "GOTO 3",
    "COMMENT x *) y",
    "COMMENT",
    "READ_ADC Ain",
    "PERSIST a",
    "MASTER_RELAY",
    "FORMATTED_STRING a 3 65 66 67",
    "IO LIST",
    "Xa at 3",
    "\u{7}|+-(",
    "PROGRAM",
    "CONTACTS",
    "CONTACTS - 0",
    "CONTACTS 3 0",
    "CONTACTS ++--| 1",
    "COIL * 0 0 0",
    "MOVE (* 5",
    "TON \u{4e2d} 5",
    "RETURN",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Nothing that is an LDmicro file by its first line makes the import fail or panic; what it prints is proven.
    #[test]
    fn any_lines_are_imported(lines in prop::collection::vec(0..LINES.len(), 0..30)) {
        let body: Vec<&str> = lines.into_iter().map(|line| LINES[line]).collect();
        let source = format!("LDmicro0.2\nPROGRAM\nRUNG\n{}\n", body.join("\n"));
        let import = rungwise::ladder::import(&source, "x", Language::English);
        prop_assert!(import.is_ok(), "{:?}\n{source}", import);
    }

    #[test]
    fn any_text_is_no_panic(text in "(LDmicro0|LDmicro export text\n)?(.|\n){0,300}") {
        let _ = rungwise::ladder::import(&text, &text, Language::English);
    }
}
