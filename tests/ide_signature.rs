//! Signature help: a program with `$0` for the cursor, and the signature with its active operand in brackets.

use rungwise::document::{Document, Notation};
use rungwise::ide;
use rungwise::target::{Model, Target};
use rungwise::text::Language;

fn signature(text: &str, notation: Notation, model: Model) -> Option<ide::Signature> {
    let offset = text.find("$0").expect("a cursor");
    let document = Document::new(&text.replace("$0", ""), notation, Target::of(model));
    ide::signature(&document, offset, Language::English)
}

/// `MOV S [D]`, or `-` where there is none.
fn drawn(text: &str, notation: Notation) -> String {
    let model = if notation == Notation::IecIl { Model::Iec } else { Model::Fx2n };
    let Some(signature) = signature(text, notation, model) else { return "-".to_string() };
    for parameter in &signature.parameters {
        assert!(!parameter.span.of(&signature.label).is_empty(), "{}", signature.label);
        assert!(!parameter.documentation.is_empty(), "{}", signature.label);
    }
    match signature.active.map(|active| signature.parameters[active].span.range()) {
        Some(span) => {
            let (head, tail) = (&signature.label[..span.start], &signature.label[span.end..]);
            format!("{head}[{}]{tail}", &signature.label[span])
        }
        None => signature.label,
    }
}

fn fx(text: &str) -> String {
    drawn(text, Notation::FxIl)
}

#[test]
fn operands_of_fx_instructions() {
    assert_eq!(fx("LD X0\nMOV $0"), "MOV [S] D");
    assert_eq!(fx("LD X0\nMOV K1$0 D0"), "MOV [S] D");
    assert_eq!(fx("LD X0\nMOV K10, $0"), "MOV S [D]");
    assert_eq!(fx("LD X0\n  12 DMOVP K10 D$0"), "DMOVP S [D]");
    assert_eq!(fx("LD X0\nMOV K10 D0 $0"), "MOV S D", "behind the last operand nothing is active");
    assert_eq!(fx("P1 LD>= D0 $0"), "LD>= S1 [S2]");
    assert_eq!(fx("OUT T0 $0"), "OUT D [n]".replace("D", &fx_name(0)).replace('n', &fx_name(1)));
    for text in ["LD $0", "OUT $0", "OUT Y0 $0", "MOV$0", "$0", "LD X0 ; MOV $0", "NOP $0", "FOO $0"] {
        assert_eq!(fx(text), "-", "{text}");
    }
}

/// The names that the table gives to the operands of OUT.
fn fx_name(place: usize) -> String {
    rungwise::target::Form::named("OUT").unwrap().instruction.operands[place].name.to_string()
}

#[test]
fn an_operand_says_what_it_takes() {
    let signature = signature("MOV K1 $0", Notation::FxIl, Model::Fx2n).unwrap();
    let [source, destination] = &signature.parameters[..] else { panic!("{signature:?}") };
    assert!(source.documentation.starts_with("Operand 1 of 2, S: value, read. Takes K H"), "{source:?}");
    assert!(source.documentation.contains("K -32768–32767"), "{source:?}");
    assert!(destination.documentation.contains("written") && !destination.documentation.contains("K H"));
    let text = "MOV K1 $0";
    let offset = text.find("$0").unwrap();
    let document = Document::new("MOV K1 ", Notation::FxIl, Target::of(Model::Fx2n));
    let chinese = ide::signature(&document, offset, Language::SimplifiedChinese).unwrap();
    assert!(chinese.parameters[1].documentation.starts_with("操作数 2/2"), "{chinese:?}");
}

#[test]
fn boxes_and_coils_of_drawings() {
    let ladder = |text: &str| drawn(text, Notation::Ladder);
    assert_eq!(ladder("+--| |--[MOV K10 $0"), "MOV S [D]");
    assert_eq!(ladder("+--| |--[MOV $0K10 D0]--+"), "MOV [S] D");
    assert_eq!(ladder("+--[>= D0 $0"), "LD>= S1 [S2]");
    assert_eq!(ladder("+--| |--(T0 $0"), fx("OUT T0 $0"));
    assert_eq!(ladder("+--| |--(Y0 $0"), "-");
    assert_eq!(ladder("+--[MOV K10 D0]--$0"), "-");
    assert_eq!(ladder("|  X0 $0"), "-");
}

const UNIT: &str = "\
FUNCTION_BLOCK Gate
VAR_INPUT
    Open : BOOL;
    Speed : INT;
END_VAR
VAR_OUTPUT
    Done : BOOL;
END_VAR
    LD Open
    ST Done
END_FUNCTION_BLOCK
PROGRAM Main
VAR
    Valve : Gate;
    Delay : TON;
    a : BOOL;
END_VAR
";

fn iec(statement: &str) -> String {
    drawn(&format!("{UNIT}{statement}\nEND_PROGRAM\n"), Notation::IecIl)
}

#[test]
fn calls_of_blocks_and_functions() {
    let gate = "Valve(Open : BOOL, Speed : INT, Done => BOOL)";
    assert_eq!(iec("    CAL Valve($0"), gate.replace("Open : BOOL", "[Open : BOOL]"));
    assert_eq!(iec("    CAL Valve(a, $0)"), gate.replace("Speed : INT", "[Speed : INT]"));
    assert_eq!(iec("    CAL Valve(Speed := $0"), gate.replace("Speed : INT", "[Speed : INT]"));
    assert_eq!(
        iec("    CAL Valve(\n    Open := a,\n    Done => $0"),
        gate.replace("Done => BOOL", "[Done => BOOL]")
    );
    assert_eq!(
        iec("    CAL Delay(IN := a, PT := $0"),
        "Delay(IN : BOOL, [PT : TIME], Q => BOOL, ET => TIME)"
    );
    // A comma in a comment or a text parts nothing.
    assert_eq!(iec("    CAL Valve((* a, b *) $0"), gate.replace("Open : BOOL", "[Open : BOOL]"));
}

#[test]
fn the_innermost_call_counts() {
    let gate = "Valve(Open : BOOL, Speed : INT, Done => BOOL)";
    // An expression in parentheses is no call; what is around it is.
    assert_eq!(iec("    CAL Valve(Open := (\n LD a\n AND( $0"), gate.replace("Open : BOOL", "[Open : BOOL]"));
    assert_eq!(iec("    CAL Valve(Open := a) $0"), "-");
    assert_eq!(iec("    LD a\n    AND( $0"), "-");
}

#[test]
fn the_current_result_is_the_first_parameter() {
    let active = iec("    LD 1\n    LIMIT 2, $0");
    assert!(active.starts_with("LIMIT(MN : ") && active.contains("[MX : "), "{active}");
    let active = iec("    LIMIT(MN := 0, IN := $0");
    assert!(active.contains("[IN : "), "{active}");
    // A repeatable input stays active however many are written.
    let active = iec("    LD 1\n    MAX 2, 3, 4, $0");
    assert!(active.contains('[') && active.contains('…'), "{active}");
}
