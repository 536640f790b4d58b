//! Editor features: a program with `$0` for the cursor, and the answer drawn as text.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use expect_test::{Expect, expect};
use proptest::prelude::*;
use rungwise::document::{Document, Notation, Tree};
use rungwise::ide::{self, Style, SymbolNode};
use rungwise::ladder::{CoilKind, ContactKind, ElementKind, coil_words};
use rungwise::project::{FormatStyle, Manifest, open_document, program_files};
use rungwise::target::{Form, Model, Operand, Target};
use rungwise::text::{Encoding, Language, Span, TextEdit};
use std::path::Path;

const EN: Language = Language::English;
const STYLE: Style = Style { kind: FormatStyle::Iec, width: 48 };

const MOTOR: &str = "\
(* Start and stop *)
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |

|   Y0                                           |
+---| |---+------------------------------(T0 K50)-+
|         |                                      |
|         +----------------------[MOV K10 D0]----+
";

const DELAY: &str = "\
PROGRAM Main
VAR
    Start AT %IX0.0 : BOOL;
    Motor AT %QX0.0 : BOOL;
    Delay : TON;
    Valve : Gate;
END_VAR
    LD Start
    ST Valve.Open
    CAL Delay(IN := Start, PT := T#1m30s)
    LD Delay.Q
    JMPC Finish
    ST Motor
Finish:
    LD Motor
    AND 16#FF
    CAL Valve(Open := Motor)
END_PROGRAM
FUNCTION_BLOCK Gate
VAR_INPUT
    Open : BOOL;
END_VAR
VAR
    Start : BOOL;
END_VAR
    LD Open
    ST Start
END_FUNCTION_BLOCK
";

fn fx(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::of(Model::Fx2n))
}

fn ladder(text: &str) -> Document {
    Document::new(text, Notation::Ladder, Target::of(Model::Fx2n))
}

fn iec(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

/// The document of `text` without its `$0`, and where that stood.
fn at_cursor(text: &str, read: fn(&str) -> Document) -> (Document, usize) {
    let offset = text.find("$0").expect("a cursor");
    (read(&text.replacen("$0", "", 1)), offset)
}

/// `text` with a cursor before the first `word`, or where `$0` stands in it.
fn marked(text: &str, word: &str) -> String {
    let plain = word.replace("$0", "");
    let marked = if word.contains("$0") { word.to_string() } else { format!("$0{word}") };
    assert!(text.contains(&plain), "{plain}");
    text.replacen(&plain, &marked, 1)
}

/// `line:column` from 1, and the text of the span.
fn place(document: &Document, span: Span) -> String {
    let at = document.position(span.start as usize, Encoding::Utf32);
    format!("{}:{} `{}`", at.line + 1, at.column + 1, document.slice(span))
}

fn check_hover(text: &str, read: fn(&str) -> Document, expected: &Expect) {
    let (document, offset) = at_cursor(text, read);
    let answer = match ide::hover(&document, offset, EN) {
        Some(hover) => format!("{}\n{}\n", place(&document, hover.span), hover.markdown),
        None => "nothing\n".to_string(),
    };
    expected.assert_eq(&answer);
}

fn check_completions(text: &str, read: fn(&str) -> Document, shown: usize, expected: &Expect) {
    let (document, offset) = at_cursor(text, read);
    let mut found = ide::completions(&document, offset, EN);
    found.sort_by_key(|proposal| proposal.rank);
    let mut answer = String::new();
    for proposal in found.iter().take(shown) {
        let text = document.text();
        let edited = TextEdit::apply_all(std::slice::from_ref(&proposal.edit), &text);
        let line = edited[..proposal.edit.span.start as usize].rfind('\n').map_or(0, |end| end + 1);
        let line = edited[line..].lines().next().unwrap_or("").trim_end();
        answer += &format!("{} | {} | {line}\n", proposal.label, proposal.detail);
    }
    if found.len() > shown {
        answer += "…\n";
    }
    expected.assert_eq(&answer);
}

fn check_places(
    text: &str,
    read: fn(&str) -> Document,
    find: fn(&Document, usize) -> Vec<Span>,
    expected: &Expect,
) {
    let (document, offset) = at_cursor(text, read);
    let places: Vec<String> =
        find(&document, offset).into_iter().map(|span| place(&document, span)).collect();
    expected.assert_eq(&(places.join("\n") + "\n"));
}

fn check_rename(text: &str, read: fn(&str) -> Document, new: &str, expected: &Expect) {
    let (document, offset) = at_cursor(text, read);
    let answer = match ide::rename(&document, offset, new) {
        Ok(edits) => TextEdit::apply_all(&edits, &document.text()),
        Err(message) => format!("refused: {}\n", message.render(EN)),
    };
    expected.assert_eq(&answer);
}

fn check_outline(document: &Document, expected: &Expect) {
    fn draw(document: &Document, nodes: &[SymbolNode], depth: usize, answer: &mut String) {
        for node in nodes {
            let line = |offset: u32| document.position(offset as usize, Encoding::Utf8).line + 1;
            let inside = node.span.start <= node.selection.start && node.selection.end <= node.span.end;
            assert!(inside, "{}: the selection lies outside", node.name);
            let lines = format!("{}-{}", line(node.span.start), line(node.span.end));
            let indent = "  ".repeat(depth);
            *answer += &format!("{indent}{:?} {} [{}] {lines}\n", node.kind, node.name, node.detail);
            draw(document, &node.children, depth + 1, answer);
        }
    }
    let mut answer = String::new();
    draw(document, &ide::symbols(document, EN), 0, &mut answer);
    expected.assert_eq(&answer);
}

fn check_folds(document: &Document, expected: &Expect) {
    let line = |offset: u32| document.position(offset as usize, Encoding::Utf8).line + 1;
    let folds = ide::folds(document);
    let folds: Vec<String> = folds
        .iter()
        .map(|fold| format!("{}-{} {:?}\n", line(fold.span.start), line(fold.span.end), fold.kind))
        .collect();
    expected.assert_eq(&folds.concat());
}

fn check_tokens(document: &Document, expected: &Expect) {
    let mut answer = String::new();
    for token in ide::semantic_tokens(document) {
        let mark = if token.modification { "!" } else { "" };
        answer += &format!("{} {:?}{mark}\n", place(document, token.span), token.kind);
    }
    expected.assert_eq(&answer);
}

#[test]
fn hover_on_an_instruction_is_its_page() {
    let page = ide::instruction_page(Form::named("DMOVP").unwrap(), Language::English);
    for part in ["DMOVP", "32 bit", "`MOV`", "`DMOV`", "| S |", "9 steps", "FX2N", "```il"] {
        assert!(page.contains(part), "{part} in {page}");
    }
    let (document, offset) = at_cursor("LD X0\ndm$0ovp D0 D10\n", fx);
    let hover = ide::hover(&document, offset, EN).unwrap();
    assert_eq!((document.slice(hover.span), hover.markdown), ("dmovp".to_string(), page));
    check_hover(
        "LD X0\nXYZ$0 D0\n",
        fx,
        &expect![[r#"
        nothing
    "#]],
    );
}

#[test]
fn hover_on_devices() {
    check_hover(
        "LD X0\nOUT M50$00\nLD M500\nOR M500\nANI M500\nMOV K4M496 D0\nEND\n",
        fx,
        &expect![[r#"
            2:5 `M500`
            `M500 = X0`

            **M500** auxiliary relay, latched (M500–M1023)

            Keeps its value without power.

            Written:
            - rung 1, line 2: `OUT M500`

            Read:
            - rung 2, line 3: `LD M500`
            - rung 2, line 4: `OR M500`
            - rung 2, line 5: `ANI M500`
            - rung 2, line 6: `MOV K4M496 D0`
        "#]],
    );
    check_hover(
        "LD $0T0\nOUT Y0\nLD X0\nOUT T0 K50\nEND\n",
        fx,
        &expect![[r#"
            1:4 `T0`
            **T0** timer, 100 ms (T0–T191)

            Preset `K50` = 5 s

            Written:
            - rung 2, line 4: `OUT T0 K50`

            Read:
            - rung 1, line 1: `LD T0`
        "#]],
    );
    check_hover(
        "LD $0M8013\nOUT Y0\n",
        fx,
        &expect![[r#"
            1:4 `M8013`
            **M8013** auxiliary relay, special (M8000–M8255)

            Clock of 1 s: 0.5 s on, 0.5 s off. A program only reads it.

            Read:
            - rung 1, line 1: `LD M8013`
        "#]],
    );
    check_hover(
        "LD M9$0000\nOUT Y0\n",
        fx,
        &expect![[r#"
            1:4 `M9000`
            **M9000** auxiliary relay: FX2N has none of this number; it has M0–M499, M500–M1023, M1024–M3071, M8000–M8255

            Read:
            - rung 1, line 1: `LD M9000`
        "#]],
    );
    check_hover(
        "LD X0\nMOV $0K4M0Z1 D0\n",
        fx,
        &expect![[r#"
            2:7 `M0`
            **M0** auxiliary relay, general (M0–M499)

            `M0 × 16` covers M0 to M15.

            Read:
            - rung 1, line 2: `MOV K4M0Z1 D0`
        "#]],
    );
    let many = format!("{}LD $0X0\nOUT Y0\n", "LD X0\nOUT Y0\n".repeat(12));
    check_hover(
        &many,
        fx,
        &expect![[r#"
            25:4 `X0`
            **X0** input relay (X0–X377)

            Read:
            - rung 1, line 1: `LD X0`
            - rung 2, line 3: `LD X0`
            - rung 3, line 5: `LD X0`
            - rung 4, line 7: `LD X0`
            - rung 5, line 9: `LD X0`
            - rung 6, line 11: `LD X0`
            - rung 7, line 13: `LD X0`
            - rung 8, line 15: `LD X0`
            - and 5 more
        "#]],
    );
}

#[test]
fn hover_on_constants_and_labels() {
    check_hover(
        "LD X0\nOUT T0 $0K50\n",
        fx,
        &expect![[r#"
        2:8 `K50`
        `K50` × 100 ms = 5 s
    "#]],
    );
    check_hover(
        "LD X0\nOUT T200 $0K50\n",
        fx,
        &expect![[r#"
        2:10 `K50`
        `K50` × 10 ms = 500 ms
    "#]],
    );
    check_hover(
        "LD X0\nMOV $0HFF D0\n",
        fx,
        &expect![[r#"
        2:5 `HFF`
        `HFF` = K255
    "#]],
    );
    check_hover(
        "LD X0\nMOV $0K-1 D0\n",
        fx,
        &expect![[r#"
        2:5 `K-1`
        `K-1` = HFFFF
    "#]],
    );
    check_hover(
        "LD X0\nCJ $0P0\nLD X1\nOUT Y0\nP0\nEND\n",
        fx,
        &expect![[r#"
            2:4 `P0`
            **P0** pointer (P0–P62)

            Defined:
            - line 5: `P0`

            Jumps and calls:
            - rung 1, line 2: `CJ P0`
        "#]],
    );
    check_hover(
        "LD X0 ; $0X0 is it\n",
        fx,
        &expect![[r#"
        nothing
    "#]],
    );
}

#[test]
fn hover_in_ladder() {
    check_hover(
        &marked(MOTOR, "|$0/|"),
        ladder,
        &expect![[r#"
            3:15 `|/|`
            Normally closed contact: passes power while `X1` is off.

            **X1** input relay (X0–X377)

            Read:
            - rung 1, line 2: `X0 /X1 Y0 → Y0`
        "#]],
    );
    check_hover(
        &marked(MOTOR, "(T0$0 K50"),
        ladder,
        &expect![[r#"
            8:43 `T0`
            `T0 K50 = Y0`

            **T0** timer, 100 ms (T0–T191)

            Preset `K50` = 5 s

            Written:
            - rung 2, line 8: `Y0 → T0 K50, MOV K10 D0`
        "#]],
    );
    check_hover(
        &marked(MOTOR, "K50"),
        ladder,
        &expect![[r#"
        8:46 `K50`
        `K50` × 100 ms = 5 s
    "#]],
    );
    let (document, offset) = at_cursor(&marked(MOTOR, "MO$0V"), ladder);
    let hover = ide::hover(&document, offset, EN).unwrap();
    assert!(hover.markdown.starts_with("### MOV"), "{}", hover.markdown);
}

#[test]
fn hover_in_iec() {
    check_hover(
        &marked(DELAY, "LD St$0art"),
        iec,
        &expect![[r#"
            8:8 `Start`
            ```iec
            VAR Start AT %IX0.0 : BOOL
            ```

            Declared:
            - line 3: `Start AT %IX0.0 : BOOL;`

            Read:
            - rung 1, line 8: `LD Start`
            - rung 1, line 10: `CAL Delay(IN := Start, PT := T#1m30s)`
        "#]],
    );
    check_hover(
        &marked(DELAY, "Delay.$0Q"),
        iec,
        &expect![[r#"
        11:8 `Delay.Q`
        `Delay.Q : BOOL`

        output
    "#]],
    );
    check_hover(
        &marked(DELAY, "T#1m$030s"),
        iec,
        &expect![[r#"
        10:34 `T#1m30s`
        `T#1m30s` = 1 min 30 s
    "#]],
    );
    check_hover(
        &marked(DELAY, "16#$0FF"),
        iec,
        &expect![[r#"
        16:9 `16#FF`
        `16#FF` = 255
    "#]],
    );
    check_hover(
        &marked(DELAY, "JMPC Fin$0ish"),
        iec,
        &expect![[r#"
            12:10 `Finish`
            **Finish** label

            Defined:
            - rung 3, line 14: `Finish:`

            Jumps and calls:
            - rung 2, line 12: `JMPC Finish`
        "#]],
    );
    check_hover(
        &marked(DELAY, ": Ga$0te"),
        iec,
        &expect![[r#"
            6:13 `Gate`
            ```iec
            FUNCTION_BLOCK Gate
            VAR_INPUT Open : BOOL
            ```

            Declared:
            - line 19: `FUNCTION_BLOCK Gate`

            Read:
            - line 6: `Valve : Gate;`
        "#]],
    );
    check_hover(
        &marked(DELAY, "Valve.Op$0en"),
        iec,
        &expect![[r#"
            9:14 `Open`
            `Valve.Open = Start`

            ```iec
            VAR_INPUT Open : BOOL
            ```

            Declared:
            - line 21: `Open : BOOL;`

            Written:
            - rung 1, line 9: `ST Valve.Open`
            - rung 3, line 17: `CAL Valve(Open := Motor)`

            Read:
            - rung 4, line 26: `LD Open`
        "#]],
    );
    for (word, heading) in
        [("JM$0PC", "### JMP"), ("T$0ON", "### TON"), ("CA$0L", "### CAL"), ("S$0T", "### ST")]
    {
        let (document, offset) = at_cursor(&marked(DELAY, word), iec);
        let hover = ide::hover(&document, offset, EN).unwrap();
        assert!(hover.markdown.contains(heading), "{word}: {}", hover.markdown);
    }
}

#[test]
fn completion_of_fx_instructions() {
    check_completions(
        "LD X0\n$0",
        fx,
        4,
        &expect![[r#"
        LD | load | LD ${1:S}
        LDI | load inverse | LDI ${1:S}
        OUT | coil | OUT ${1:D}
        AND | contact in series | AND ${1:S}
        …
    "#]],
    );
    check_completions(
        "LD X0\nmo$0",
        fx,
        6,
        &expect![[r#"
        MOV | move | MOV ${1:S} ${2:D}
        MOVP | move | MOVP ${1:S} ${2:D}
    "#]],
    );
    check_completions(
        "  12 L$0",
        fx,
        3,
        &expect![[r#"
        LD | load |   12 LD ${1:S}
        LDI | load inverse |   12 LDI ${1:S}
        LDP | load rising edge |   12 LDP ${1:S}
        …
    "#]],
    );
    check_completions("LD X0 ; $0", fx, 3, &expect![[""]]);
}

#[test]
fn completion_of_fx_operands() {
    let program = "LD M0\nAND X0\nOR M0\nOUT Y0\nLD X1\nCALL P1\nFEND\nP1\nLD M1\nOUT T0 K10\nSRET\nEND\n";
    check_completions(
        &format!("{program}LD $0"),
        fx,
        6,
        &expect![[r#"
            M0 | auxiliary relay, read in 2 places | LD M0
            X0 | input relay, read in 1 place | LD X0
            X1 | input relay, read in 1 place | LD X1
            Y0 | output relay, written in rung 1 | LD Y0
            M1 | auxiliary relay, read in 1 place | LD M1
            T0 | timer, written in rung 3 | LD T0
            …
        "#]],
    );
    check_completions(
        &format!("{program}OUT $0"),
        fx,
        6,
        &expect![[r#"
            Y1 | output relay, free | OUT Y1
            M2 | auxiliary relay, general, free | OUT M2
            M500 | auxiliary relay, latched, free | OUT M500
            S0 | state, initial, free | OUT S0
            S10 | state, state for returning home, free | OUT S10
            S20 | state, general, free | OUT S20
            …
        "#]],
    );
    check_completions(
        &format!("{program}OUT T$0"),
        fx,
        6,
        &expect![[r#"
            T1 | timer, 100 ms, free | OUT T1
            T192 | timer, 100 ms timer for subroutines and interrupts, free | OUT T192
            T200 | timer, 10 ms, free | OUT T200
            T246 | timer, 1 ms retentive, free | OUT T246
            T250 | timer, 100 ms retentive, free | OUT T250
            T0 | timer, written in rung 3 | OUT T0
        "#]],
    );
    check_completions(
        &format!("{program}OUT T200 $0"),
        fx,
        6,
        &expect![[r#"
            K | decimal constant, 1–32767, × 10 ms | OUT T200 K${1:1}
            D0 | data register, general, free | OUT T200 D0
            D200 | data register, latched, free | OUT T200 D200
            D1000 | data register, latched register, may hold file registers, free | OUT T200 D1000
            H | hexadecimal constant | OUT T200 H${1:0}
        "#]],
    );
    check_completions(&format!("{program}OUT Y0 $0"), fx, 6, &expect![[""]]);
    check_completions(
        &format!("{program}LD M801$0"),
        fx,
        12,
        &expect![[r#"
            M8011 | Clock of 10 ms: 5 ms on, 5 ms off | LD M8011
            M8012 | Clock of 100 ms: 50 ms on, 50 ms off | LD M8012
            M8013 | Clock of 1 s: 0.5 s on, 0.5 s off | LD M8013
            M8014 | Clock of 1 min: 30 s on, 30 s off | LD M8014
            M8015 | Stops the clock; it starts with what D8013 to D8019 hold when this goes off | LD M8015
            M8016 | Freezes D8013 to D8019 for reading; the clock itself goes on | LD M8016
            M8017 | On a rising edge rounds the clock to the nearest minute | LD M8017
            M8018 | On while a real-time clock is fitted | LD M8018
            M8019 | The clock was set to an impossible date or time | LD M8019
        "#]],
    );
    check_completions(
        &format!("{program}OUT M801$0"),
        fx,
        12,
        &expect![[r#"
            M8015 | Stops the clock; it starts with what D8013 to D8019 hold when this goes off | OUT M8015
            M8016 | Freezes D8013 to D8019 for reading; the clock itself goes on | OUT M8016
            M8017 | On a rising edge rounds the clock to the nearest minute | OUT M8017
        "#]],
    );
    check_completions(
        &format!("{program}CJ $0"),
        fx,
        4,
        &expect![[r#"
            P1 | label, rung 3, line 8, jumped to 1 × | CJ P1
            P0 | free label | CJ P0
        "#]],
    );
    check_completions(
        &format!("{program}MOV K1 $0"),
        fx,
        40,
        &expect![[r#"
            T0 | timer, written in rung 3 | MOV K1 T0
            D0 | data register, general, free | MOV K1 D0
            D200 | data register, latched, free | MOV K1 D200
            D1000 | data register, latched register, may hold file registers, free | MOV K1 D1000
            T1 | timer, 100 ms, free | MOV K1 T1
            T192 | timer, 100 ms timer for subroutines and interrupts, free | MOV K1 T192
            T200 | timer, 10 ms, free | MOV K1 T200
            T246 | timer, 1 ms retentive, free | MOV K1 T246
            T250 | timer, 100 ms retentive, free | MOV K1 T250
            C0 | counter, 16-bit up, free | MOV K1 C0
            C100 | counter, latched 16-bit up, free | MOV K1 C100
            C200 | counter, 32-bit up/down, free | MOV K1 C200
            C220 | counter, latched 32-bit up/down, free | MOV K1 C220
            V0 | index register, free | MOV K1 V0
            Z0 | index register, free | MOV K1 Z0
            K4Y0 | 16 × output relay | MOV K1 K${1:4}Y${2:0}
            K4M0 | 16 × auxiliary relay | MOV K1 K${1:4}M${2:0}
            K4S0 | 16 × state | MOV K1 K${1:4}S${2:0}
        "#]],
    );
}

#[test]
fn completion_in_ladder() {
    check_completions(
        "$0",
        ladder,
        3,
        &expect![[r#"
        rung | a rung with a contact and a coil | |  ${1:X0}                                  ${2:Y0}  |
        seal-in | start and stop with seal-in | |  ${1:X0}       ${2:X1}                       ${3:Y0}  |
        X0 | input relay, free | X0
        …
    "#]],
    );
    check_completions(
        &marked(MOTOR, "|   Y0    |$0"),
        ladder,
        4,
        &expect![[r#"
            Y0 | output relay, written in rung 1, read in 2 places | |   Y0    |Y0                                      |
            X0 | input relay, read in 1 place | |   Y0    |X0                                      |
            X1 | input relay, read in 1 place | |   Y0    |X1                                      |
            T0 | timer, written in rung 2 | |   Y0    |T0                                      |
            …
        "#]],
    );
    check_completions(
        "|   X0\n+---| |--$0--------( )-+\n",
        ladder,
        12,
        &expect![[r#"
        | | | normally open contact | +---| |--| |-----( )-+
        |/| | normally closed contact | +---| |--|/|-----( )-+
        |P| | rising edge contact | +---| |--|P|-----( )-+
        |N| | falling edge contact | +---| |--|N|-----( )-+
        ( ) | coil | +---| |--( )-----( )-+
        (/) | negated coil | +---| |--(/)-----( )-+
        (S) | set coil | +---| |--(S)-----( )-+
        (R) | reset coil | +---| |--(R)-----( )-+
        (P) | rising edge coil | +---| |--(P)-----( )-+
        (N) | falling edge coil | +---| |--(N)-----( )-+
        (T) | toggling coil | +---| |--(T)-----( )-+
        MOV | move | +---| |--[MOV ${1:S} ${2:D}]--------( )-+
        …
    "#]],
    );
    check_completions(
        "|   X0\n+---| |----[MO$0\n",
        ladder,
        3,
        &expect![[r#"
        MOV | move | +---| |----[MOV ${1:S} ${2:D}
        MOVP | move | +---| |----[MOVP ${1:S} ${2:D}
    "#]],
    );
    check_completions(
        "|   X0  D7\n+---| |----[MOV K1 $0\n",
        ladder,
        3,
        &expect![[r#"
            D0 | data register, general, free | +---| |----[MOV K1 D0
            D200 | data register, latched, free | +---| |----[MOV K1 D200
            D1000 | data register, latched register, may hold file registers, free | +---| |----[MOV K1 D1000
            …
        "#]],
    );
    check_completions(
        "|   X0\n+---| |----(T0 $0)\n",
        ladder,
        3,
        &expect![[r#"
        K | decimal constant, 1–32767, × 100 ms | +---| |----(T0 K${1:1})
        D0 | data register, general, free | +---| |----(T0 D0)
        D200 | data register, latched, free | +---| |----(T0 D200)
        …
    "#]],
    );
}

#[test]
fn every_mark_that_a_drawing_may_have_is_offered_and_understood() {
    let fx2n = Target::of(Model::Fx2n);
    let proposed = |head: &str| -> Vec<String> {
        let text = format!("|   X0                  Y0\n+---| |--{head}");
        let document = Document::new(&text, Notation::Ladder, fx2n);
        let found = ide::completions(&document, text.len(), Language::English);
        found.into_iter().map(|proposal| proposal.edit.text).collect()
    };
    let symbols: Vec<String> = proposed("--").into_iter().filter(|text| text.len() == 3).collect();
    // Each symbol is read as another kind, and all kinds that the reader has words for are there.
    let mut read: Vec<ElementKind> = Vec::new();
    for symbol in &symbols {
        let text = format!("|   X0     M0\n+---| |----{symbol}----( )-+\n");
        let tree = rungwise::ladder::parse(&text, fx2n);
        let kind = tree.rungs[0].graph.elements[1].kind.clone();
        assert!(!read.contains(&kind), "{symbol}");
        read.push(kind);
    }
    for kind in
        coil_words().map(|(_, kind)| ElementKind::Coil(kind)).chain([ElementKind::Coil(CoilKind::Plain)])
    {
        assert!(read.contains(&kind), "{kind:?} in {symbols:?}");
    }
    assert_eq!(
        read.iter().filter(|kind| matches!(kind, ElementKind::Contact(_))).count(),
        ContactKind::ALL.len()
    );
    // Behind each word the names follow that a coil can have.
    let names = proposed("(S ");
    assert!(names.iter().any(|name| name == "Y0"), "{names:?}");
    for (word, _) in coil_words() {
        assert_eq!(proposed(&format!("({word} ")), names, "({word}");
    }
}

#[test]
fn completion_in_iec() {
    check_completions(
        &marked(DELAY, "LD $0Start"),
        iec,
        12,
        &expect![[r#"
        Start | VAR BOOL |     LD StartStart
        Motor | VAR BOOL |     LD MotorStart
        Delay | VAR TON |     LD DelayStart
        Valve | VAR Gate |     LD ValveStart
        TRUE | BOOL |     LD TRUEStart
        FALSE | BOOL |     LD FALSEStart
        %IX0.0 |  |     LD %IX0.0Start
        %QX0.0 |  |     LD %QX0.0Start
    "#]],
    );
    check_completions(
        &marked(DELAY, "    ST Motor").replace("$0    ST Motor", "    ST $0"),
        iec,
        12,
        &expect![[r#"
        Start | VAR BOOL |     ST Start
        Motor | VAR BOOL |     ST Motor
        Delay | VAR TON |     ST Delay
        Valve | VAR Gate |     ST Valve
        %IX0.0 |  |     ST %IX0.0
        %QX0.0 |  |     ST %QX0.0
    "#]],
    );
    check_completions(
        &marked(DELAY, "Delay.$0Q"),
        iec,
        12,
        &expect![[r#"
        IN | input, BOOL: start |     LD Delay.INQ
        PT | input, TIME: preset time |     LD Delay.PTQ
        Q | output, BOOL: output |     LD Delay.QQ
        ET | output, TIME: elapsed time |     LD Delay.ETQ
    "#]],
    );
    check_completions(
        &marked(DELAY, "Valve.$0Open"),
        iec,
        12,
        &expect![[r#"
        Open | input, BOOL |     ST Valve.OpenOpen
    "#]],
    );
    check_completions(
        &marked(DELAY, "JMPC $0Finish"),
        iec,
        12,
        &expect![[r#"
            Finish | label, line 14 |     JMPC FinishFinish
        "#]],
    );
    check_completions(
        &marked(DELAY, "CAL $0Delay"),
        iec,
        12,
        &expect![[r#"
        Delay | TON |     CAL Delay(IN := $1, PT := $2)Delay(IN := Start, PT := T#1m30s)
        Valve | Gate |     CAL Valve(Open := $1)Delay(IN := Start, PT := T#1m30s)
    "#]],
    );
    check_completions(
        &marked(DELAY, "Delay($0"),
        iec,
        12,
        &expect![[r#"
        IN | input, BOOL: start |     CAL Delay(IN := $1IN := Start, PT := T#1m30s)
        PT | input, TIME: preset time |     CAL Delay(PT := $1IN := Start, PT := T#1m30s)
        Q | output, BOOL: output |     CAL Delay(Q => $1IN := Start, PT := T#1m30s)
        ET | output, TIME: elapsed time |     CAL Delay(ET => $1IN := Start, PT := T#1m30s)
        Start | VAR BOOL |     CAL Delay(StartIN := Start, PT := T#1m30s)
        Motor | VAR BOOL |     CAL Delay(MotorIN := Start, PT := T#1m30s)
        Delay | VAR TON |     CAL Delay(DelayIN := Start, PT := T#1m30s)
        Valve | VAR Gate |     CAL Delay(ValveIN := Start, PT := T#1m30s)
        %IX0.0 |  |     CAL Delay(%IX0.0IN := Start, PT := T#1m30s)
        %QX0.0 |  |     CAL Delay(%QX0.0IN := Start, PT := T#1m30s)
    "#]],
    );
    check_completions(
        &marked(DELAY, "Delay : $0TON").replace("TON;", ";"),
        iec,
        3,
        &expect![[r#"
        Gate | function block |     Delay : Gate;
        BOOL | data type |     Delay : BOOL;
        BYTE | data type |     Delay : BYTE;
        …
    "#]],
    );
    check_completions(
        &marked(DELAY, "IN := $0"),
        iec,
        3,
        &expect![[r#"
        Start | VAR BOOL |     CAL Delay(IN := StartStart, PT := T#1m30s)
        Motor | VAR BOOL |     CAL Delay(IN := MotorStart, PT := T#1m30s)
        Delay | VAR TON |     CAL Delay(IN := DelayStart, PT := T#1m30s)
        …
    "#]],
    );
    check_completions(
        &marked(DELAY, "    LD Motor\n").replace("$0    LD Motor", "    LI$0"),
        iec,
        12,
        &expect![[r#"
        LIMIT | limiter |     LIMIT
    "#]],
    );
    check_completions(
        "$0",
        iec,
        60,
        &expect![[r#"
        LD | load | LD $1
        LDN | load | LDN $1
        ST | store | ST $1
        STN | store | STN $1
        S | set | S $1
        R | reset | R $1
        AND | and | AND $1
        ANDN | and | ANDN $1
        & | and | & $1
        &N | and | &N $1
        OR | or | OR $1
        ORN | or | ORN $1
        XOR | exclusive or | XOR $1
        XORN | exclusive or | XORN $1
        NOT | complement | NOT
        ADD | add | ADD $1
        SUB | subtract | SUB $1
        MUL | multiply | MUL $1
        DIV | divide | DIV $1
        MOD | remainder | MOD $1
        GT | greater than | GT $1
        GE | greater than or equal | GE $1
        EQ | equal | EQ $1
        NE | not equal | NE $1
        LE | less than or equal | LE $1
        LT | less than | LT $1
        JMP | jump | JMP $1
        JMPC | jump | JMPC $1
        JMPCN | jump | JMPCN $1
        CAL | call | CAL $1
        CALC | call | CALC $1
        CALCN | call | CALCN $1
        RET | return | RET
        RETC | return | RETC
        RETCN | return | RETCN
        PROGRAM | keyword | PROGRAM ${1:Main}
        FUNCTION_BLOCK | keyword | FUNCTION_BLOCK ${1:Name}
        FUNCTION | keyword | FUNCTION ${1:Name} : ${2:INT}
        CONFIGURATION | keyword | CONFIGURATION ${1:Name}
        TYPE | keyword | TYPE
    "#]],
    );
}

#[test]
fn definitions() {
    check_places(
        "LD Y0\nOUT Y1\nLD X0\nOUT $0Y0\nLD X1\nSET Y0\n",
        fx,
        ide::definition,
        &expect![[r#"
        4:5 `Y0`
        6:5 `Y0`
    "#]],
    );
    check_places(
        "LD $0X0\nOUT Y1\nLD X0\nOUT Y0\n",
        fx,
        ide::definition,
        &expect![[r#"
        1:4 `X0`
    "#]],
    );
    check_places(
        "LD M3\nOUT Y1\nLD X0\nMOV K1 K1M0\nLD $0M3\nOUT Y2\n",
        fx,
        ide::definition,
        &expect![[r#"
        4:10 `M0`
    "#]],
    );
    check_places(
        "LD X0\nCJ $0P0\nLD X1\nOUT Y0\nP0\nEND\n",
        fx,
        ide::definition,
        &expect![[r#"
        5:1 `P0`
    "#]],
    );
    check_places(
        &marked(MOTOR, "$0Y0    |"),
        ladder,
        ide::definition,
        &expect![[r#"
        2:46 `Y0`
    "#]],
    );
    check_places(
        &marked(DELAY, "LD $0Start"),
        iec,
        ide::definition,
        &expect![[r#"
        3:5 `Start`
    "#]],
    );
    check_places(
        &marked(DELAY, "ST $0Start"),
        iec,
        ide::definition,
        &expect![[r#"
        24:5 `Start`
    "#]],
    );
    check_places(
        &marked(DELAY, "Valve : $0Gate"),
        iec,
        ide::definition,
        &expect![[r#"
        19:16 `Gate`
    "#]],
    );
    check_places(
        &marked(DELAY, "Valve.$0Open"),
        iec,
        ide::definition,
        &expect![[r#"
        21:5 `Open`
    "#]],
    );
    check_places(
        &marked(DELAY, "JMPC $0Finish"),
        iec,
        ide::definition,
        &expect![[r#"
        14:1 `Finish`
    "#]],
    );
}

#[test]
fn all_references() {
    let all = |document: &Document, offset: usize| ide::references(document, offset, true);
    let uses = |document: &Document, offset: usize| ide::references(document, offset, false);
    check_places(
        "LD M3\nOUT Y1\nLD X0\nMOV K1 K1M0\nLD $0M3\nMOV D0Z1 Z1\n",
        fx,
        all,
        &expect![[r#"
        1:4 `M3`
        4:10 `M0`
        5:4 `M3`
    "#]],
    );
    check_places(
        "LD X0\nMOV D0$0Z1 D1\nMOV K0 Z1\n",
        fx,
        all,
        &expect![[r#"
        2:7 `Z1`
        3:8 `Z1`
    "#]],
    );
    check_places(
        &marked(MOTOR, "X0"),
        ladder,
        all,
        &expect![[r#"
        2:5 `X0`
    "#]],
    );
    check_places(
        &marked(MOTOR, "Y0"),
        ladder,
        all,
        &expect![[r#"
        2:46 `Y0`
        4:5 `Y0`
        7:5 `Y0`
    "#]],
    );
    check_places(
        &marked(DELAY, "Start"),
        iec,
        all,
        &expect![[r#"
        3:5 `Start`
        8:8 `Start`
        10:21 `Start`
    "#]],
    );
    check_places(
        &marked(DELAY, "Start"),
        iec,
        uses,
        &expect![[r#"
        8:8 `Start`
        10:21 `Start`
    "#]],
    );
    check_places(
        &marked(DELAY, "$0Open : BOOL"),
        iec,
        all,
        &expect![[r#"
        9:14 `Open`
        17:15 `Open`
        21:5 `Open`
        26:8 `Open`
    "#]],
    );
    check_places(
        &marked(DELAY, "$0%QX0.0"),
        iec,
        all,
        &expect![[r#"
        4:14 `%QX0.0`
    "#]],
    );
}

#[test]
fn rename_in_lists() {
    check_rename(
        "LD $0M0\nOUT Y0\nLD M0\nOUT M1\n",
        fx,
        "m7",
        &expect![[r#"
        LD M7
        OUT Y0
        LD M7
        OUT M1
    "#]],
    );
    check_rename(
        "LD $0M0\nOUT M1\n",
        fx,
        "M1",
        &expect![[r#"
        refused: M1 is already used in line 2
    "#]],
    );
    check_rename(
        "LD $0M0\nOUT M1\n",
        fx,
        "Y1",
        &expect![[r#"
        refused: M0 is of the kind auxiliary relay; Y1 is of another
    "#]],
    );
    check_rename(
        "LD $0M0\nOUT M1\n",
        fx,
        "M9999",
        &expect![[r#"
        refused: FX2N has no M9999
    "#]],
    );
    check_rename(
        "LD $0M0\nOUT M1\n",
        fx,
        "Motor",
        &expect![[r#"
        refused: `Motor` is no device
    "#]],
    );
    check_rename(
        "LD $0M8002\nOUT M1\n",
        fx,
        "M3",
        &expect![[r#"
        refused: M8002 has a fixed meaning and cannot be renamed
    "#]],
    );
    check_rename(
        "LD $0M1\nOUT Y1\nMOV K1 K1M0\n",
        fx,
        "M9",
        &expect![[r#"
        refused: M1 is also a part of the devices from M0 on, which line 3 uses together
    "#]],
    );
    check_rename(
        "LD X0\nMOV K1 K2$0M0\nMOV K0 K2M0Z0\n",
        fx,
        "M16",
        &expect![[r#"
        LD X0
        MOV K1 K2M16
        MOV K0 K2M16Z0
    "#]],
    );
    check_rename(
        "LD $0T0\nOUT Y0\n",
        fx,
        "T200",
        &expect![[r#"
        refused: T0 is a 100 ms timer; T200 is not, so the program would behave differently
    "#]],
    );
    check_rename(
        "LD X0\nCJ P$00\nP0\nEND\n",
        fx,
        "P5",
        &expect![[r#"
        LD X0
        CJ P5
        P5
        END
    "#]],
    );
    check_rename(
        &marked(DELAY, "LD $0Motor"),
        iec,
        "Pump",
        &expect![[r#"
        PROGRAM Main
        VAR
            Start AT %IX0.0 : BOOL;
            Pump AT %QX0.0 : BOOL;
            Delay : TON;
            Valve : Gate;
        END_VAR
            LD Start
            ST Valve.Open
            CAL Delay(IN := Start, PT := T#1m30s)
            LD Delay.Q
            JMPC Finish
            ST Pump
        Finish:
            LD Pump
            AND 16#FF
            CAL Valve(Open := Pump)
        END_PROGRAM
        FUNCTION_BLOCK Gate
        VAR_INPUT
            Open : BOOL;
        END_VAR
        VAR
            Start : BOOL;
        END_VAR
            LD Open
            ST Start
        END_FUNCTION_BLOCK
    "#]],
    );
    check_rename(
        &marked(DELAY, "LD $0Motor"),
        iec,
        "start",
        &expect![[r#"
        refused: start is already used in line 3
    "#]],
    );
    check_rename(
        &marked(DELAY, "LD $0Motor"),
        iec,
        "VAR",
        &expect![[r#"
        refused: `VAR` is a reserved word
    "#]],
    );
    check_rename(
        &marked(DELAY, ": $0TON"),
        iec,
        "Other",
        &expect![[r#"
        refused: TON is part of the language and cannot be renamed
    "#]],
    );
    check_rename(
        &marked(DELAY, "$0Open : BOOL"),
        iec,
        "Lift",
        &expect![[r#"
        PROGRAM Main
        VAR
            Start AT %IX0.0 : BOOL;
            Motor AT %QX0.0 : BOOL;
            Delay : TON;
            Valve : Gate;
        END_VAR
            LD Start
            ST Valve.Lift
            CAL Delay(IN := Start, PT := T#1m30s)
            LD Delay.Q
            JMPC Finish
            ST Motor
        Finish:
            LD Motor
            AND 16#FF
            CAL Valve(Lift := Motor)
        END_PROGRAM
        FUNCTION_BLOCK Gate
        VAR_INPUT
            Lift : BOOL;
        END_VAR
        VAR
            Start : BOOL;
        END_VAR
            LD Lift
            ST Start
        END_FUNCTION_BLOCK
    "#]],
    );
    check_rename(
        &marked(DELAY, ": $0Gate"),
        iec,
        "Door",
        &expect![[r#"
        PROGRAM Main
        VAR
            Start AT %IX0.0 : BOOL;
            Motor AT %QX0.0 : BOOL;
            Delay : TON;
            Valve : Door;
        END_VAR
            LD Start
            ST Valve.Open
            CAL Delay(IN := Start, PT := T#1m30s)
            LD Delay.Q
            JMPC Finish
            ST Motor
        Finish:
            LD Motor
            AND 16#FF
            CAL Valve(Open := Motor)
        END_PROGRAM
        FUNCTION_BLOCK Door
        VAR_INPUT
            Open : BOOL;
        END_VAR
        VAR
            Start : BOOL;
        END_VAR
            LD Open
            ST Start
        END_FUNCTION_BLOCK
    "#]],
    );
    check_rename(
        &marked(DELAY, "$0Finish:"),
        iec,
        "Done",
        &expect![[r#"
        PROGRAM Main
        VAR
            Start AT %IX0.0 : BOOL;
            Motor AT %QX0.0 : BOOL;
            Delay : TON;
            Valve : Gate;
        END_VAR
            LD Start
            ST Valve.Open
            CAL Delay(IN := Start, PT := T#1m30s)
            LD Delay.Q
            JMPC Done
            ST Motor
        Done:
            LD Motor
            AND 16#FF
            CAL Valve(Open := Motor)
        END_PROGRAM
        FUNCTION_BLOCK Gate
        VAR_INPUT
            Open : BOOL;
        END_VAR
        VAR
            Start : BOOL;
        END_VAR
            LD Open
            ST Start
        END_FUNCTION_BLOCK
    "#]],
    );
}

#[test]
fn rename_keeps_the_drawing() {
    check_rename(
        &marked(MOTOR, "Y0"),
        ladder,
        "Y17",
        &expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y17 |
        +---| |---+---|/|----------------------------( )-+
        |   Y17   |                                      |
        +---| |---+                                      |

        |   Y17                                          |
        +---| |---+------------------------------(T0 K50)-+
        |         |                                      |
        |         +----------------------[MOV K10 D0]----+
    "#]],
    );
    check_rename(
        &marked(MOTOR, "T0"),
        ladder,
        "T100",
        &expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |

        |   Y0                                           |
        +---| |---+----------------------------(T100 K50)-+
        |         |                                      |
        |         +----------------------[MOV K10 D0]----+
    "#]],
    );
    check_rename(
        &marked(MOTOR, "D0"),
        ladder,
        "D1000",
        &expect![[r#"
        (* Start and stop *)
        |   X0        X1                             Y0  |
        +---| |---+---|/|----------------------------( )-+
        |   Y0    |                                      |
        +---| |---+                                      |

        |   Y0                                           |
        +---| |---+------------------------------(T0 K50)-+
        |         |                                      |
        |         +----------------------[MOV K10 D1000]-+
    "#]],
    );
    check_rename(
        "|  $0X100                 Y0 |\n+---| |-----------------( )+\n",
        ladder,
        "X1",
        &expect![[r#"
            |   X1                  Y0 |
            +---| |-----------------( )+
        "#]],
    );
    check_rename(
        "+--[X0]-------------(Y0)-+\n".replace("X0", "$0X0").as_str(),
        ladder,
        "X10",
        &expect![[r#"
        +--[X10]------------(Y0)-+
    "#]],
    );
    check_rename(
        "+--[X10]------------(Y0)-+\n".replace("X10", "$0X10").as_str(),
        ladder,
        "X1",
        &expect![[r#"
        +--[X1]-------------(Y0)-+
    "#]],
    );
}

#[test]
fn a_short_name_stays_over_its_element() {
    let text = "\
PROGRAM p
|  $0A_rather_long_name             B  |
+--------| |---------------------( )-+
END_PROGRAM
";
    check_rename(
        text,
        tank,
        "A",
        &expect![[r#"
        PROGRAM p
        |          A                      B  |
        +--------| |---------------------( )-+
        END_PROGRAM
    "#]],
    );
    check_rename(
        &text.replace("---| |-", "-| |---"),
        tank,
        "A",
        &expect![[r#"
            refused: with `A` in line 2 the drawing would be read otherwise: the name would stand over another element, or over two; redraw the rung with more room there first
        "#]],
    );
}

#[test]
fn renaming_a_drawing_keeps_its_logic() {
    for (old, new) in [("Y0", "Y17"), ("X1", "X177"), ("T0", "T100"), ("D0", "D1000"), ("X0", "X5")] {
        let document = ladder(MOTOR);
        let offset = MOTOR.find(old).unwrap();
        let edits = ide::rename(&document, offset, new).unwrap();
        let renamed = ladder(&TextEdit::apply_all(&edits, MOTOR));
        let logic = |document: &Document| -> String {
            let mut rungs = String::new();
            for at in document.chunks() {
                let Tree::Ladder(tree) = at.chunk.tree() else { continue };
                assert_eq!(tree.problems, [], "{}", document.text());
                tree.rungs.iter().for_each(|rung| rungs += &rung.graph.logic_text(at.chunk.text()));
            }
            rungs
        };
        let [from, to] = [old, new].map(|word| format!("{:?}", Operand::read(word, Model::Fx2n)));
        assert!(logic(&document).contains(&from), "{}", logic(&document));
        let expected = logic(&document).replace(&from, &to);
        assert_eq!(logic(&renamed), expected, "{old} to {new}:\n{}", renamed.text());
    }
}

const TANK: &str = "\
PROGRAM Tank
VAR
    Level_low AT %IX0.0 : BOOL;
    Pump AT %QX0.0 : BOOL;
    Run_on : TON;
END_VAR
NETWORK 1 'Pump'
               Run_on
              +-------+
   Level_low  |  TON  |   Pump
+----| |------|IN    Q|---( )---+
        T#5s--|PT   ET|         |
              +-------+
END_PROGRAM
";

fn tank(text: &str) -> Document {
    Document::new(text, Notation::Ladder, Target::of(Model::Iec))
}

#[test]
fn ladder_of_iec_variables() {
    check_hover(
        &marked(TANK, "$0Level_low  |"),
        tank,
        &expect![[r#"
            10:4 `Level_low`
            ```iec
            VAR Level_low AT %IX0.0 : BOOL
            ```

            Declared:
            - line 3: `Level_low AT %IX0.0 : BOOL;`

            Read:
            - rung 1, line 10: `Level_low T#5s → Pump`
        "#]],
    );
    check_hover(
        &marked(TANK, "T#$05s"),
        tank,
        &expect![[r#"
        12:9 `T#5s`
        `T#5s` = 5 s
    "#]],
    );
    check_places(
        &marked(TANK, "$0Pump\n+"),
        tank,
        ide::definition,
        &expect![[r#"
        4:5 `Pump`
    "#]],
    );
    let (document, offset) = at_cursor(&marked(TANK, "T$0ON  |"), tank);
    assert!(ide::hover(&document, offset, EN).unwrap().markdown.starts_with("### TON"));
    check_rename(
        &marked(TANK, "$0Run_on"),
        tank,
        "Delay_1",
        &expect![[r#"
        PROGRAM Tank
        VAR
            Level_low AT %IX0.0 : BOOL;
            Pump AT %QX0.0 : BOOL;
            Delay_1 : TON;
        END_VAR
        NETWORK 1 'Pump'
                       Delay_1
                      +-------+
           Level_low  |  TON  |   Pump
        +----| |------|IN    Q|---( )---+
                T#5s--|PT   ET|         |
                      +-------+
        END_PROGRAM
    "#]],
    );
    check_rename(
        &marked(TANK, "$0Level_low"),
        tank,
        "Level",
        &expect![[r#"
            PROGRAM Tank
            VAR
                Level AT %IX0.0 : BOOL;
                Pump AT %QX0.0 : BOOL;
                Run_on : TON;
            END_VAR
            NETWORK 1 'Pump'
                           Run_on
                          +-------+
                 Level    |  TON  |   Pump
            +----| |------|IN    Q|---( )---+
                    T#5s--|PT   ET|         |
                          +-------+
            END_PROGRAM
        "#]],
    );
    check_rename(
        &marked(TANK, "$0Level_low"),
        tank,
        "Level_of_the_tank_is_low",
        &expect![[r#"
            refused: `Level_of_the_tank_is_low` does not fit into the drawing of line 10: it would run into `|`; redraw the rung with more room there first
        "#]],
    );
    check_completions(
        &marked(TANK, "$0Pump\n+"),
        tank,
        5,
        &expect![[r#"
        Level_low | VAR BOOL |    Level_low  |  TON  |   Level_lowPump
        Pump | VAR BOOL |    Level_low  |  TON  |   PumpPump
        Run_on | VAR TON |    Level_low  |  TON  |   Run_onPump
        %IX0.0 |  |    Level_low  |  TON  |   %IX0.0Pump
        %QX0.0 |  |    Level_low  |  TON  |   %QX0.0Pump
    "#]],
    );
    check_completions(
        &marked(TANK, "Run_on : $0"),
        tank,
        2,
        &expect![[r#"
        BOOL | data type |     Run_on : BOOLTON;
        BYTE | data type |     Run_on : BYTETON;
        …
    "#]],
    );
    check_outline(
        &tank(TANK),
        &expect![[r#"
        Program Tank [PROGRAM] 1-14
          Section VAR [] 2-6
            Variable Level_low [BOOL] 3-3
            Variable Pump [BOOL] 4-4
            Variable Run_on [TON] 5-5
          Network Network 1: Pump [] 7-13
            Rung Rung 1 [Run_on, Pump] 8-13
    "#]],
    );
}

#[test]
fn outlines() {
    let program = "; Start\n; and stop\nLD X0\nOUT Y0\nSTL S20\nOUT Y1\nLD X1\nSET S21\nSTL S21\nOUT Y2\nRET\nLD X2\nCALL P1\nFEND\nP1\nLD X3\nOUT Y3\nSRET\nEND\n";
    check_outline(
        &fx(program),
        &expect![[r#"
            Rung Rung 1: Start [Y0] 3-4
            Step Step S20 [] 5-8
              Rung Rung 2 [Y1] 5-6
              Rung Rung 3 [S21] 7-8
            Step Step S21 [] 9-10
              Rung Rung 4 [Y2] 9-10
            Rung Rung 5 [CALL P1] 12-13
            Label Subroutine P1 [] 15-17
              Rung Rung 6 [Y3] 15-17
        "#]],
    );
    check_outline(
        &ladder(&format!("NETWORK 3 'Drive'\n{MOTOR}\nL1:\n| X5   Y5|\n+-| |--( )-+\n")),
        &expect![[r#"
        Network Network 3: Drive [] 1-11
          Rung Rung 1: Start and stop [Y0] 3-6
          Rung Rung 2 [T0, D0] 8-11
        Network L1 [] 13-15
          Rung Rung 3 [Y5] 14-15
    "#]],
    );
    check_outline(
        &iec(DELAY),
        &expect![[r#"
        Program Main [PROGRAM] 1-18
          Section VAR [] 2-7
            Variable Start [BOOL] 3-3
            Variable Motor [BOOL] 4-4
            Variable Delay [TON] 5-5
            Variable Valve [Gate] 6-6
          Label Finish [] 14-14
        FunctionBlock Gate [FUNCTION_BLOCK] 19-28
          Section VAR_INPUT [] 20-22
            Variable Open [BOOL] 21-21
          Section VAR [] 23-25
            Variable Start [BOOL] 24-24
    "#]],
    );
}

#[test]
fn folding() {
    let program = "; a\n; b\nLD X0\nOUT Y0\nLD X1\nMC N0 M0\nLD X2\nOUT Y1\nMCR N0\nFOR K3\nLD X1\nINC D0\nNEXT\nSTL S20\nOUT Y1\nSTL S21\nOUT Y2\nRET\n(* c\nd *)\nEND\n";
    check_folds(
        &fx(program),
        &expect![[r#"
            1-2 Comment
            3-4 Region
            5-6 Region
            6-9 Region
            7-8 Region
            10-13 Region
            11-12 Region
            14-15 Region
            16-18 Region
            16-17 Region
            19-20 Comment
        "#]],
    );
    check_folds(
        &ladder(&format!("NETWORK 3 'Drive'\n{MOTOR}\nL1:\n| X5   Y5|\n+-| |--( )-+\n")),
        &expect![[r#"
        1-11 Region
        3-6 Region
        8-11 Region
        13-15 Region
        14-15 Region
    "#]],
    );
    check_folds(
        &iec(DELAY),
        &expect![[r#"
        1-18 Region
        2-7 Region
        8-10 Region
        11-13 Region
        14-17 Region
        19-28 Region
        20-22 Region
        23-25 Region
        26-27 Region
    "#]],
    );
}

#[test]
fn highlighting() {
    check_tokens(
        &fx("0 LD X0 ; in\nOUT T0 K50\nMOV K4M0 D0Z1\nP0\nASC \"AB\" D0\nXYZ D0\n(* a\n b *)\n"),
        &expect![[r#"
        1:1 `0` Number
        1:3 `LD` Instruction
        1:6 `X0` Device
        1:9 `; in` Comment
        2:1 `OUT` Instruction
        2:5 `T0` Device!
        2:8 `K50` Number
        3:1 `MOV` Instruction
        3:5 `K4M0` Device
        3:10 `D0Z1` Device!
        4:1 `P0` Label!
        5:1 `ASC` Instruction
        5:5 `"AB"` Text
        5:10 `D0` Device!
        6:5 `D0` Device
        7:1 `(* a` Comment
        8:2 `b *)` Comment
    "#]],
    );
    check_tokens(
        &ladder("NETWORK 1 'x'\n|   X0      |\n+---| |--(Y0)+\n"),
        &expect![[r#"
            1:1 `NETWORK` Keyword
            1:9 `1` Number
            1:11 `'x'` Text
            2:5 `X0` Device
            3:2 `---` Wire
            3:5 `| |` Element
            3:8 `--` Wire
            3:10 `(` Element
            3:11 `Y0` Device!
            3:13 `)` Element
        "#]],
    );
    check_tokens(
        &iec(
            "PROGRAM p\nVAR a : BOOL; t : TON; END_VAR\nLD a (* c *)\nCAL t(IN := TRUE)\nl: JMP l\nEND_PROGRAM\n",
        ),
        &expect![[r#"
        1:1 `PROGRAM` Keyword
        1:9 `p` FunctionBlock!
        2:1 `VAR` Keyword
        2:5 `a` Variable!
        2:9 `BOOL` Type
        2:15 `t` Variable!
        2:19 `TON` FunctionBlock
        2:24 `END_VAR` Keyword
        3:1 `LD` Instruction
        3:4 `a` Variable
        3:6 `(* c *)` Comment
        4:1 `CAL` Instruction
        4:5 `t` Variable!
        4:7 `IN` Variable
        4:13 `TRUE` Number
        5:1 `l` Label!
        5:4 `JMP` Instruction
        5:8 `l` Label
        6:1 `END_PROGRAM` Keyword
    "#]],
    );
}

#[test]
fn hints_behind_presets() {
    let text = "LD X0\nOUT T0 K50\nOUT T200 K50\nOUT C0 K50\nOUT T246 K65\nMOV H0F D0\nMOV H1 D0\nOUT T1 K12345\nOUT T2 D0\n";
    let document = fx(text);
    let hints = ide::inlay_hints(&document, Span::new(0, text.len()), EN);
    let drawn: Vec<String> = hints
        .iter()
        .map(|hint| {
            let line = document.position(hint.offset, Encoding::Utf8).line as usize;
            let start = text.lines().take(line).map(|line| line.len() + 1).sum::<usize>();
            format!("{} {}", &text[start..hint.offset], hint.label)
        })
        .collect();
    expect![[r#"
        OUT T0 K50 = 5 s
        OUT T200 K50 = 500 ms
        OUT T246 K65 = 65 ms
        MOV H0F = 15
        OUT T1 K12345 = 20 min 34.5 s"#]]
    .assert_eq(&drawn.join("\n"));
    let second = text.find("K50\nOUT C0").unwrap();
    assert_eq!(ide::inlay_hints(&document, Span::new(second, second + 5), EN).len(), 1);
}

#[test]
fn hints_of_a_drawing_stand_behind_its_lines() {
    // In the line a hint would push the right rail away.
    let text = "|   X0    T0 K50 |\r\n+---| |----( )--+\r\n|   X1    T1 K7  |   \n+---| |----( )--+\n--[X2]--(T2 K8)";
    let document = ladder(text);
    let hints = ide::inlay_hints(&document, Span::new(0, text.len()), EN);
    let drawn: Vec<(&str, &str)> =
        hints.iter().map(|hint| (text[..hint.offset].lines().last().unwrap(), hint.label.as_str())).collect();
    let expected = [
        ("|   X0    T0 K50 |", "= 5 s"),
        ("|   X1    T1 K7  |   ", "= 700 ms"),
        ("--[X2]--(T2 K8)", "= 800 ms"),
    ];
    assert_eq!(drawn, expected);
    for hint in &hints {
        assert!(text[hint.offset..].is_empty() || text[hint.offset..].starts_with(['\r', '\n']));
    }
}

#[test]
fn status_counts_what_the_program_is() {
    let status = ide::status(&fx("LD X0\nOUT T0 K50\nLD T0\nOUT Y0\nEND\n"));
    assert_eq!((status.target, status.dialect), ("fx2n", "fx"));
    assert_eq!((status.rungs, status.steps, status.capacity), (2, Some(7), 8000));
    assert_eq!(ide::status(&ladder(MOTOR)).rungs, 2);
    let status = ide::status(&iec(DELAY));
    assert_eq!((status.target, status.dialect, status.steps, status.capacity), ("iec", "iec", None, 0));
}

#[test]
fn status_follows_edits() {
    let mut document = fx("LD X0\nOUT Y0\nEND\n");
    assert_eq!(ide::status(&document).steps, Some(3));
    let edit = rungwise::document::Edit { range: Some(6..6), text: "AND X1\nMOV K1 D0\n".to_string() };
    document.apply(&[edit]);
    assert_eq!(ide::status(&document).steps, Some(9));
}

#[test]
fn formatting_changes_what_is_not_canonical_and_nothing_else() {
    for (document, expected) in [
        (fx("ld x0\nOUT  Y0\nEND\n"), "LD X0\nOUT Y0\nEND\n"),
        (
            iec("PROGRAM p\nVAR\na:BOOL;\nEND_VAR\nLD a\nEND_PROGRAM\n"),
            "PROGRAM p\nVAR\n    a : BOOL;\nEND_VAR\n    LD      a\nEND_PROGRAM\n",
        ),
    ] {
        let edits = ide::format(&document, STYLE);
        assert_eq!(TextEdit::apply_all(&edits, &document.text()), expected);
        let again = Document::new(expected, document.notation(), document.target());
        assert_eq!(ide::format(&again, STYLE), []);
    }
    let mut lines = String::new();
    for number in 0..50 {
        lines += &format!("LD X0\nOUT M{number}\n");
    }
    let document = fx(&(lines + "ld X1\nOUT Y0\n"));
    let touched: usize = ide::format(&document, STYLE).iter().map(|edit| edit.span.len()).sum();
    assert!(0 < touched && touched < 20, "{touched} bytes are replaced");
    let document = ladder("|X0   Y0  |\n+-| |--( )+\n");
    let formatted = TextEdit::apply_all(&ide::format(&document, STYLE), &document.text());
    assert!(formatted.lines().all(|line| line.len() == 48), "{formatted}");
}

#[test]
fn fixes_of_the_diagnostics_under_the_cursor() {
    let document = fx("LD X8\nOUT Y0\nLD X9\nOUT Y1\nEND\n");
    let diagnostics = rungwise::check::all(&document, &Default::default());
    let titles = |span| -> Vec<String> {
        ide::fixes(&diagnostics, span).iter().map(|found| found.fix.title.render(EN)).collect()
    };
    expect![[r#"
        Counted in decimal: X8 is X10
        Mistyped: X8 was meant to be X7"#]]
    .assert_eq(&titles(Span::at(4)).join("\n"));
    assert!(titles(Span::at(9)).is_empty());
    assert!(titles(Span::new(0, document.len())).len() > titles(Span::at(4)).len());
}

#[test]
fn snippets_of_every_instruction_fill_its_operands() {
    for target in Target::ALL.into_iter().filter(|target| target.is_fx()) {
        let document = Document::new("", Notation::FxIl, target);
        let found = ide::completions(&document, 0, EN);
        assert!(found.iter().any(|proposal| proposal.label == "LD"));
        for proposal in found {
            let form = Form::named(&proposal.label).expect("an instruction");
            assert!(form.is_on(target.model), "{} on {}", proposal.label, target.name);
            let needed = form.instruction.operands.iter().filter(|spec| !spec.optional).count();
            assert_eq!(proposal.edit.text.matches("${").count(), needed, "{}", proposal.edit.text);
        }
    }
}

/// Asks everything everywhere; the answers themselves are other tests' matter.
fn ask_everything(document: &Document) {
    let length = document.len();
    for offset in 0..=length + 1 {
        if let Some(hover) = ide::hover(document, offset, EN) {
            assert!(hover.span.start <= hover.span.end && hover.span.end as usize <= length);
        }
        for proposal in ide::completions(document, offset, EN) {
            assert!(proposal.edit.span.end as usize <= length);
        }
        ide::definition(document, offset);
        ide::references(document, offset, true);
        if ide::renamable(document, offset).is_some() {
            for new in ["X1", "M77", "Name_1", "P9", "%IX5.5"] {
                if let Ok(edits) = ide::rename(document, offset, new) {
                    TextEdit::apply_all(&edits, &document.text());
                }
            }
        }
    }
    ask_about_all(document);
}

fn ask_about_all(document: &Document) {
    let text = document.text();
    let mut end = 0;
    for token in ide::semantic_tokens(document) {
        assert!(token.span.start >= end && !token.span.is_empty(), "tokens overlap at {:?}", token.span);
        assert!(!token.span.of(&text).contains('\n'), "a token over lines at {:?}", token.span);
        end = token.span.end;
    }
    assert!(end as usize <= text.len());
    for fold in ide::folds(document) {
        assert!(fold.span.of(&text).contains('\n'), "a fold of one line at {:?}", fold.span);
    }
    ide::symbols(document, EN);
    ide::inlay_hints(document, Span::new(0, text.len()), EN);
    ide::status(document);
    let formatted = TextEdit::apply_all(&ide::format(document, STYLE), &text);
    let again = Document::new(&formatted, document.notation(), document.target());
    assert_eq!(TextEdit::apply_all(&ide::format(&again, STYLE), &formatted), formatted, "of {text}");
}

#[test]
fn nothing_panics_in_the_examples() {
    let examples = program_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")).unwrap();
    assert!(examples.len() > 6);
    for path in examples {
        let text = std::fs::read_to_string(&path).unwrap();
        ask_everything(&open_document(&path.to_string_lossy(), &text, &Manifest::default(), None, None));
    }
    ask_everything(&iec(DELAY));
    ask_everything(&ladder(MOTOR));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn nothing_panics_in_random_text(
        pieces in proptest::collection::vec(proptest::sample::select(PIECES), 0..14),
        notation in 0usize..4,
    ) {
        let text = pieces.concat();
        let (notation, model) = [
            (Notation::FxIl, Model::Fx3u),
            (Notation::IecIl, Model::Iec),
            (Notation::Ladder, Model::Fx2n),
            (Notation::Ladder, Model::Iec),
        ][notation];
        ask_everything(&Document::new(&text, notation, Target::of(model)));
    }
}

/// What programs are made of, whole and broken.
const PIECES: &[&str] = &[
    "\n",
    "\n\n",
    " ",
    "(*",
    "*)",
    "; x\n",
    "// 电机\n",
    "LD X0\n",
    "LD X9",
    "OUT T0 K50\n",
    "MOV K4M0Z1 D0\n",
    "P0",
    "FEND\n",
    "STL S20\n",
    "RET\n",
    "ß",
    "电机",
    "K",
    "D",
    "M80",
    "CJ ",
    ",",
    "VAR\n",
    "END_VAR\n",
    "a : BOOL;\n",
    "t : TON;\n",
    "f : F;\n",
    "PROGRAM P\n",
    "END_PROGRAM\n",
    "FUNCTION_BLOCK F\nVAR_INPUT i : INT; END_VAR\n",
    "END_FUNCTION_BLOCK\n",
    "LD a\n",
    "ST f.i\n",
    "CAL t(",
    "IN := ",
    "a)\n",
    "t.",
    "JMP l\n",
    "l:",
    "|   X0   Y0 |\n",
    "+---| |--( )-+\n",
    "|\n",
    "+--[MOV K1 D0]-+\n",
    "(T0 K5)",
    "[",
    "(",
    "-->>l\n",
    "NETWORK 1 'x'\n",
    "\t",
    "\r\n",
    "%IX0.0",
    "16#FF",
    "T#5s",
    "'",
    "\u{feff}",
];
