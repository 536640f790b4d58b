//! Calculations with words between the FX family and IEC 61131-3: what each instruction becomes, that it comes back, and
//! that two small machines do the same with both.

use crate::translate_iec::{certain, fx, list, to};
use crate::word_machines::{Fx, Iec, types};
use proptest::prelude::*;
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::text::Language;
use rungwise::translate::{Certificate, Options, Proof, To, Translation, prove, translate};
use std::collections::BTreeMap;

/// The instructions of the body of a list, separated by bars.
fn body(text: &str) -> String {
    let from = text.rfind("END_VAR").map_or(0, |at| at + "END_VAR".len());
    let end = text.find("END_PROGRAM").unwrap_or(text.len());
    let lines = text[from..end].lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" | ")
}

/// The note of the first rung, in English.
fn note(translation: &Translation) -> String {
    translation.rungs[0].note.as_ref().map(|note| note.render(Language::English)).unwrap_or_default()
}

fn is_equal(left: &Document, right: &Document) -> bool {
    matches!(prove(left, right), Proof::Equal { .. })
}

/// An FX list and one of IEC 61131-3 are equal, or at least not taken for different: where a rung of the one is several
/// of the other, that is not always found.
fn never_different(text: &str, written: &str) {
    for proof in [prove(&fx(text), &list(written)), prove(&list(written), &fx(text))] {
        assert!(!matches!(proof, Proof::Different(_)), "{proof:?}\n{text}\n{written}");
    }
}

/// What the check has against a list.
fn problems(text: &str) -> Vec<String> {
    let folder = crate::binary::folder(&[("program.il", text)]);
    let (_, out, _) = crate::binary::run(&folder, &["check", "program.il"]);
    out.lines()
        .filter(|line| line.contains("error") || line.contains("warning"))
        .map(str::to_string)
        .collect()
}

/// What an FX list without END becomes; it comes back as it is, and both ways prove equal.
fn there_and_back(instructions: &str) -> String {
    let text = format!("{}\nEND\n", instructions.replace("; ", "\n"));
    let written = certain(&fx(&text), To::Iec);
    assert!(problems(&written).is_empty(), "{:?}\n{written}", problems(&written));
    let back = certain(&list(&written), To::Fx);
    // What stands behind a calculation has a rung of its own there.
    let driven = |text: &str| text.lines().filter(|line| *line != "LD X0").collect::<Vec<_>>().join("; ");
    assert_eq!(driven(&back), driven(&text), "{written}");
    assert!(is_equal(&fx(&text), &fx(&back)), "{back}");
    never_different(&text, &written);
    written
}

#[test]
fn two_registers_are_a_variable_of_32_bits() {
    let written = there_and_back(
        "LD X0; DMOV K100000 D10; DADD D10 K1 D12; DSUB D12 D10 D14; DINC D10; DDEC D12; DMOV K0 D14; DNEG D10; \
         LDD>= D10 K70000; ANDD<> D12 D14; OUT Y0",
    );
    let expected = "LD X0 | JMPCN Skip1 | LD 100000 | ST D10 | LD D10 | ADD 1 | ST D12 | LD D12 | SUB D10 | ST D14 | \
                    LD D10 | ADD 1 | ST D10 | LD D12 | SUB 1 | ST D12 | LD 0 | ST D14 | LD 0 | SUB D10 | ST D10 | \
                    Skip1: | LD D10 | GE 70000 | AND( D12 | NE D14 | ) | ST Y0";
    assert_eq!(body(&written), expected);
    let declared: BTreeMap<String, String> = types(&written);
    assert_eq!(declared["D10"], "DINT", "{written}");
    assert!(written.contains("D10 AT %MD505"), "{written}");
    // No double word lies over a pair that begins with an odd number.
    let written = there_and_back("LD X0; DMOVP D11 D13; LDD> D11 K-1; OUT Y0");
    assert!(written.contains("D11 AT %MD10011") && written.contains("D13 AT %MD10013"), "{written}");
    // What an instruction of its own stands for is told from the plain one.
    there_and_back("LD X0; DADD D0 K1 D0; DSUB D2 K1 D2; DSUB K0 D0 D0; SUB K0 D4 D4; NEG D4; DNEG D0");
}

#[test]
fn halves_of_32_bits_are_no_words() {
    let torn = |word: &str| {
        format!(
            "`{word}` is used as one half of 32 bits and in another way, too, and IEC 61131-3 leaves open which half \
             is where"
        )
    };
    for other in [
        "MOV D10 D20",
        "MOV K1 D11",
        "RST D11",
        "DMOV D11 D20",
        "DMOV D9 D20",
        "OUT T0 D11",
        "ADD D20 D10 D21",
        "MUL D11 K2 D20",
        "DIV D20 K3 D9",
        "FMOV K0 D8 K4",
        "BMOV D9 D20 K3",
        "BMOV D20 D9 K3",
        "ZRST D11 D12",
    ] {
        let text = format!("LD X0\nDMOV K5 D10\nLD X1\n{other}\nEND\n");
        let translation = to(&fx(&text), To::Iec);
        let is_cleared = other.starts_with("ZRST");
        let rung = usize::from(is_cleared);
        let found = translation.rungs[rung].note.as_ref().map(|note| note.render(Language::English));
        assert_eq!(
            found,
            Some(torn(if is_cleared { "D11" } else { "D10" })),
            "{other}\n{}",
            translation.text
        );
        assert_eq!(translation.rungs[rung].certificate, Some(Certificate::Undecided), "{other}");
    }
    // That a part of a program is translated changes nothing of what the whole does.
    let text = "LD X0\nDMOV K5 D10\nLD X1\nMOV D10 D20\nEND\n";
    let part = rungwise::text::Span::new(0, 5);
    let translation = translate(&fx(text), Some(part), To::Iec, &Options::default());
    assert_eq!((translation.rungs.len(), note(&translation)), (1, torn("D10")));
    let alone = translate(&fx("LD X0\nDMOV K5 D10\nEND\n"), Some(part), To::Iec, &Options::default());
    assert_eq!((alone.rungs[0].certificate, note(&alone)), (Some(Certificate::Construction), String::new()));
    // Nor are they in a list of IEC 61131-3.
    let variables = "d AT %MD505 : DINT; n AT %MW1011 : INT; X0 AT %IX0.0 : BOOL;";
    let text = format!("PROGRAM p\nVAR\n{variables}\nEND_VAR\nLD d\nADD 5\nST d\nLD n\nST n\nEND_PROGRAM\n");
    assert_eq!(note(&to(&list(&text), To::Fx)), torn("d"));
    assert_eq!(note(&to(&list(&text.replace("%MW1011", "%MW1012")), To::Fx)), "");
    for odd in ["%MD10009", "%MD10011"] {
        assert_eq!(
            note(&to(&list(&text.replace("%MW1011 : INT", &format!("{odd} : DINT"))), To::Fx)),
            torn("d")
        );
    }
}

#[test]
fn variables_of_32_bits_are_two_registers() {
    let program = |body: &str| {
        let variables = "d AT %MD505 : DINT; e AT %MD506 : DINT; u AT %MD507 : UDINT; n AT %MW1000 : INT; D30 : DINT; \
                         y AT %QX0.0 : BOOL;";
        list(&format!("PROGRAM p\nVAR\n{variables}\nEND_VAR\n{}\nEND_PROGRAM\n", body.replace("; ", "\n")))
    };
    for (body, expected) in [
        ("LD d; ADD e; ST d", "LD M8000\nDADD D10 D12 D10\n"),
        ("LD d; GT e; ST y", "LDD> D10 D12\nOUT Y0\n"),
        ("LD d; LE -100000; ST y", "LDD<= D10 K-100000\nOUT Y0\n"),
        ("LD u; EQ u; ST y", "LDD= D14 D14\nOUT Y0\n"),
        ("LD D30; ADD 1; ST D30", "LD M8000\nDINC D30\n"),
    ] {
        assert_eq!(certain(&program(body), To::Fx), format!("{expected}END\n"), "{body}");
    }
    for (body, reason) in [
        ("LD d; ADD n; ST d", "`n` is of type INT, with which no instruction of 32 bits calculates"),
        ("LD d; GT n; ST y", "`n` is of type INT, with which no instruction of 32 bits calculates"),
        ("LD u; GT 5; ST y", "`u` is of type UDINT, and the FX family compares words with a sign"),
        ("LD %MD505; GT 5; ST y", "`%MD505` is of type DWORD, and the FX family compares words with a sign"),
        (
            "LD d; GT 3000000000; ST y",
            "`3000000000` does not fit in 32 bits, with which the instruction calculates",
        ),
    ] {
        let translation = to(&program(body), To::Fx);
        assert_eq!(note(&translation), reason, "{body}\n{}", translation.text);
    }
}

#[test]
fn products_and_quotients() {
    let written = there_and_back(
        "LD X0; MUL D0 D1 D10; MULP D0 K-7 D12; DIV D2 K7 D4; DDIV D14 K1000 D16; DIV D6 K2 D6",
    );
    for part in [
        "LD D0 | INT_TO_DINT | MUL( D1 | INT_TO_DINT | ) | ST D10",
        "LD D0 | INT_TO_DINT | MUL -7 | ST D12",
        "LD D2 | DIV 7 | ST D4 | LD D2 | MOD 7 | ST D5",
        "LD D14 | DIV 1000 | ST D16 | LD D14 | MOD 1000 | ST D18",
        // What is divided is written over last.
        "LD D6 | MOD 2 | ST D7 | LD D6 | DIV 2 | ST D6",
    ] {
        assert!(body(&written).contains(part), "{part}\n{written}");
    }
    let divisor = |word: &str| {
        format!("`{word}` divides, and what comes of a division by 0 or -1 the languages do not say alike")
    };
    for (instruction, reason) in [
        ("DIV D0 D1 D2", divisor("D1")),
        ("DIV D0 K0 D2", divisor("K0")),
        ("DIV D0 K-1 D2", divisor("K-1")),
        ("DIV D0 HFFFF D2", divisor("HFFFF")),
        ("DDIV D0 D2 D4", divisor("D2")),
        ("DMUL D0 D2 D4", "`DMUL` makes 64 bits, and no variable stands for four registers".into()),
    ] {
        let translation = to(&fx(&format!("LD X0\n{instruction}\nEND\n")), To::Iec);
        assert_eq!(note(&translation), reason, "{instruction}\n{}", translation.text);
    }
    let program = |body: &str| {
        let variables = "n AT %MW1000 : INT; k AT %MW1001 : INT; q AT %MW1002 : INT; r AT %MW1003 : INT; \
                         u AT %MW1004 : UINT; d AT %MD505 : DINT; v AT %MW1006 : UINT; w AT %MW1007 : UINT;";
        list(&format!("PROGRAM p\nVAR\n{variables}\nEND_VAR\n{}\nEND_PROGRAM\n", body.replace("; ", "\n")))
    };
    assert_eq!(
        certain(&program("LD n; INT_TO_DINT; MUL 10; ST d"), To::Fx),
        "LD M8000\nMUL D0 K10 D10\nEND\n"
    );
    for body in ["LD n; DIV 7; ST q; LD n; MOD 7; ST r", "LD n; MOD 7; ST r; LD n; DIV 7; ST q"] {
        assert_eq!(certain(&program(body), To::Fx), "LD M8000\nDIV D0 K7 D2\nEND\n", "{body}");
    }
    // Where both are kept after all, nothing of them is lost.
    let unit = "FUNCTION_BLOCK f\nVAR\nD5 AT %MW1005 : INT; D6 AT %MW1006 : INT; D7 AT %MW1007 : INT;\nEND_VAR\n\
                LD D7\nDIV 7\nST D5\nLD D7\nMOD 7\nST D6\nEND_FUNCTION_BLOCK\n";
    let kept = to(&list(unit), To::Fx).text;
    assert_eq!((kept.matches("DIV").count(), kept.matches("MOD").count()), (1, 1), "{kept}");
    let quotient = |word: &str| {
        format!(
            "`{word}` of an FX writes the quotient and behind it the remainder: DIV and MOD of the same two by a \
             constant other than 0 and -1, into registers in a row, are one"
        )
    };
    for (body, reason) in [
        (
            "LD n; MUL k; ST q",
            "`MUL` of an FX writes a product of twice as many bits: `INT_TO_DINT` before it and a DINT for it say so"
                .to_string(),
        ),
        ("LD n; DIV 7; ST q", quotient("DIV")),
        ("LD n; MOD 7; ST q", quotient("MOD")),
        ("LD n; DIV k; ST q", quotient("DIV")),
        // What is divided was written over, or another divisor, or other places.
        ("LD q; DIV 7; ST q; LD q; MOD 7; ST r", quotient("DIV")),
        ("LD n; DIV 7; ST q; LD n; MOD 8; ST r", quotient("DIV")),
        ("LD n; DIV 7; ST r; LD n; MOD 7; ST q", quotient("DIV")),
        ("LD n; DIV -1; ST q; LD n; MOD -1; ST r", quotient("DIV")),
        ("LD u; DIV 7; ST v; LD u; MOD 7; ST w", quotient("DIV")),
        ("LD u; INT_TO_DINT; MUL 7; ST d", "`u` is of type UINT, and the FX family compares words with a sign".into()),
    ] {
        let text = body.replace("LD M8000", "");
        let translation = to(&program(&text), To::Fx);
        assert_eq!(note(&translation), reason, "{body}\n{}", translation.text);
    }
}

#[test]
fn patterns_of_bits() {
    let written = there_and_back(
        "LD X0; WAND D0 D1 D2; WOR D2 HF0 D2; WXORP HFF00 D3 D3; CML D4 D5; DAND D10 D12 D14; DORP D10 HFFFF0000 D10; \
         DCML D10 D12; CML H5 D6",
    );
    for part in [
        "LD D0 | INT_TO_WORD | AND( D1 | INT_TO_WORD | ) | WORD_TO_INT | ST D2",
        "LD D2 | INT_TO_WORD | OR WORD#16#F0 | WORD_TO_INT | ST D2",
        "LD WORD#16#FF00 | XOR( D3 | INT_TO_WORD | ) | WORD_TO_INT | ST D3",
        "LD D4 | INT_TO_WORD | NOT | WORD_TO_INT | ST D5",
        "LD D10 | DINT_TO_DWORD | AND( D12 | DINT_TO_DWORD | ) | DWORD_TO_DINT | ST D14",
        "OR DWORD#16#FFFF0000",
    ] {
        assert!(body(&written).contains(part), "{part}\n{written}");
    }
    // Variables that are patterns need no conversion.
    let text = "PROGRAM p\nVAR\na AT %MW1000 : WORD; b AT %MW1001 : WORD; c AT %MD505 : DWORD;\nEND_VAR\n\
                LD a\nAND WORD#16#FF\nST b\nLD b\nNOT\nST a\nLD c\nXOR c\nST c\nEND_PROGRAM\n";
    let expected = "LD M8000\nWAND D0 HFF D1\nLD M8000\nCML D1 D0\nLD M8000\nDXOR D10 D10 D10\nEND\n";
    assert_eq!(certain(&list(text), To::Fx), expected);
    assert!(is_equal(&list(text), &fx(expected)));
    assert!(!is_equal(&list(text), &fx(&expected.replace("HFF", "HFE"))));
    // What is inverted has as many bits as what it is stored in.
    for (body, lack) in [
        ("LD WORD#16#FFFF\nNOT\nST c", "WORD#16#FFFF"),
        ("LD 16#FF\nNOT\nST a", "16#FF"),
        ("LD WORD#16#FF\nNOT\nWORD_TO_INT\nST c", "NOT"),
        ("LD c\nAND WORD#16#FF\nST c", "WORD#16#FF"),
    ] {
        let text = format!(
            "PROGRAM p\nVAR\na AT %MW1000 : WORD; c AT %MD505 : DWORD;\nEND_VAR\n{body}\nEND_PROGRAM\n"
        );
        let translation = to(&list(&text), To::Fx);
        assert_eq!(
            note(&translation),
            format!("`{lack}` has no counterpart in the other language"),
            "{body}"
        );
    }
    // A list that has conversions stays a list in a drawing, and comes back.
    let drawn = to(&list(&written), To::Ladder).text;
    assert!(drawn.contains("{il\n"), "{drawn}");
    let back = to(&Document::new(&drawn, Notation::Ladder, Target::of(Model::Iec)), To::Iec).text;
    let calculated = |text: &str| {
        let lines =
            text.lines().map(str::trim).filter(|line| !line.contains("Pulse") && !line.contains("X0"));
        lines.filter(|line| line.contains("_TO_") || line.contains("ST ")).collect::<Vec<_>>().join("; ")
    };
    assert_eq!(calculated(&back), calculated(&written));
    assert!(to(&list(&written), To::Boolean).text.contains("; "), "{written}");
}

/// What an FX list without END becomes.
fn there(instructions: &str) -> String {
    let written = certain(&fx(&format!("{}\nEND\n", instructions.replace("; ", "\n"))), To::Iec);
    assert!(problems(&written).is_empty(), "{:?}\n{written}", problems(&written));
    written
}

#[test]
fn rows_of_devices_are_written_one_by_one() {
    for (instructions, expected) in [
        (
            "LD X0; CMP D0 K5 M0",
            "LD X0 | AND( D0 | GT 5 | ) | S M0 | LD X0 | AND( D0 | LE 5 | ) | R M0 | LD X0 | AND( D0 | EQ 5 | ) | S M1 | \
             LD X0 | AND( D0 | NE 5 | ) | R M1 | LD X0 | AND( D0 | LT 5 | ) | S M2 | LD X0 | AND( D0 | GE 5 | ) | R M2",
        ),
        ("LD M8000; DCMP D10 D12 Y6", "LD D10 | GT D12 | S Y6 | LD D10 | LE D12 | R Y6 | "),
        (
            "LD X0; ZRST M3 M5; ZRST D0 D2",
            "LD X0 | R M3 | R M4 | R M5 | JMPCN Skip1 | LD 0 | ST D0 | LD 0 | ST D1 | ",
        ),
        ("LD X0; DINC D2; ZRST D0 D4", "LD 0 | ST D0 | LD 0 | ST D1 | LD 0 | ST D2 | LD 0 | ST D4"),
        (
            "LD X0; FMOV K0 D0 K2; DFMOV D4 D6 K2",
            "LD INT#0 | ST D0 | LD INT#0 | ST D1 | LD D4 | ST D6 | LD D4 | ST D8",
        ),
        ("LD X0; BMOVP D5 D0 K2", "LD D5 | ST D0 | LD D6 | ST D1"),
        ("LD X0; BMOV D0 D1 K2", "LD D1 | ST D2 | LD D0 | ST D1"),
    ] {
        let written = there(instructions);
        assert!(body(&written).contains(expected), "{instructions}\n{}", body(&written));
    }
    let written = there("LD X0; ZCP K-5 K5 D0 M3");
    for part in ["LT -5 | ) | S M3", "GE -5 | ) | AND( D0 | LE 5 | ) | S M4", "GT 5 | ) | S M5"] {
        assert!(body(&written).contains(part), "{part}\n{}", body(&written));
    }
    // The end of a row belongs to it in octal numbers, too.
    assert!(body(&there("LD X0; CMP D0 K5 Y6")).contains("S Y10"));
    for (instruction, reason) in [
        (
            "ZCP D1 D2 D0 M3",
            "the zone from `D1` on is known only where two constants say it, the lower one first",
        ),
        (
            "ZCP K5 K-5 D0 M3",
            "the zone from `K5` on is known only where two constants say it, the lower one first",
        ),
        ("ZRST C0 C1", "`ZRST` has no counterpart in the other language"),
        ("ZRST M0 M16", "17 devices in a row are more than are written one by one"),
        ("FMOV K0 D0 K17", "17 devices in a row are more than are written one by one"),
        ("ZRST T0 T1", "`T0` is reset, and TON has no input that does it"),
        ("RST T0", "`T0` is reset, and TON has no input that does it"),
        ("ZRST M5 M0", "`ZRST` has no counterpart in the other language"),
        (
            "ZRST C199 C200",
            "`C200` counts up and down in 32 bits, as a special relay says, and no block of IEC 61131-3 does",
        ),
        ("BMOV K2M0 K2Y0 K1", "`BMOV` has no counterpart in the other language"),
        ("CMP D0 K4M0 M20", "`K4M0` makes a number of single bits, and IEC 61131-3 has no operand for that"),
        (
            "CMP D0 T0 M20",
            "`T0` as a number counts the steps of its timer, and the time of a block is of type TIME",
        ),
    ] {
        let translation = to(&fx(&format!("LD X0\n{instruction}\nEND\n")), To::Iec);
        assert_eq!(note(&translation), reason, "{instruction}\n{}", translation.text);
    }
    let turned = to(&fx("LD X0\nBMOV D0 D10 K2\nLD X1\nOUT M8024\nEND\n"), To::Iec);
    assert_eq!(note(&turned), "`M8024` is driven, which turns the direction of BMOV");
}

#[test]
fn types_are_a_part_of_what_is_compared() {
    let iec = |variables: &str, body: &str| {
        let variables = format!("{variables} Y0 AT %QX0.0 : BOOL; X0 AT %IX0.0 : BOOL;");
        list(&format!("PROGRAM p\nVAR\n{variables}\nEND_VAR\n{}\nEND_PROGRAM\n", body.replace("; ", "\n")))
    };
    let own = |instructions: &str| fx(&format!("{}\nEND\n", instructions.replace("; ", "\n")));
    for (instructions, variables, body, is_same) in [
        ("LD>= D0 K5; OUT Y0", "n AT %MW1000 : INT;", "LD n; GE 5; ST Y0", true),
        ("LD>= D0 K5; OUT Y0", "n AT %MW1000 : UINT;", "LD n; GE 5; ST Y0", false),
        ("LD>= D0 K5; OUT Y0", "n AT %MW1000 : REAL;", "LD n; GE 5; ST Y0", false),
        ("LDD>= D0 K5; OUT Y0", "n AT %MD500 : DINT;", "LD n; GE 5; ST Y0", true),
        ("LDD>= D0 K5; OUT Y0", "n AT %MD500 : UDINT;", "LD n; GE 5; ST Y0", false),
        ("LDD>= D0 K5; OUT Y0", "n AT %MD500 : REAL;", "LD n; GE 5; ST Y0", false),
        ("LDD>= D0 K5; OUT Y0", "n AT %MW1000 : INT;", "LD n; GE 5; ST Y0", false),
        ("LD>= D0 K5; OUT Y0", "n AT %MD500 : DINT;", "LD n; GE 5; ST Y0", false),
        ("LD M8000; DADD D0 K5 D0", "n AT %MD500 : DINT;", "LD n; ADD 5; ST n", true),
        // The sum of one has room where that of the other has none.
        ("LD M8000; DADD D0 K5 D0", "n AT %MD500 : UDINT;", "LD n; ADD 5; ST n", false),
        ("LD M8000; DADD D0 K5 D0", "n AT %MD500 : REAL;", "LD n; ADD 5; ST n", false),
        (
            "LD M8000; DIV D0 K5 D2",
            "n AT %MW1000 : INT; q AT %MW1002 : INT; r AT %MW1003 : INT;",
            "LD n; DIV 5; ST q; LD n; MOD 5; ST r",
            true,
        ),
        (
            "LD M8000; DIV D0 K5 D2",
            "n AT %MW1000 : UINT; q AT %MW1002 : UINT; r AT %MW1003 : UINT;",
            "LD n; DIV 5; ST q; LD n; MOD 5; ST r",
            false,
        ),
        (
            "LD M8000; MUL D0 K5 D2",
            "n AT %MW1000 : INT; d AT %MD501 : DINT;",
            "LD n; INT_TO_DINT; MUL 5; ST d",
            true,
        ),
        ("LD M8000; MUL D0 K5 D2", "n AT %MW1000 : INT; d AT %MD501 : DINT;", "LD n; MUL 5; ST d", false),
        ("LD M8000; MUL D0 K5 D2", "n AT %MW1000 : INT; d AT %MW1002 : INT;", "LD n; MUL 5; ST d", false),
        (
            "LD M8000; WAND D0 K5 D2",
            "n AT %MW1000 : INT; d AT %MW1002 : INT;",
            "LD n; INT_TO_WORD; AND 5; WORD_TO_INT; ST d",
            false,
        ),
        (
            "LD M8000; WAND D0 K5 D2",
            "n AT %MW1000 : INT; d AT %MW1002 : INT;",
            "LD n; INT_TO_WORD; AND WORD#16#5; WORD_TO_INT; ST d",
            true,
        ),
        (
            "LD M8000; CML D0 D2",
            "n AT %MW1000 : INT; d AT %MW1002 : INT;",
            "LD n; INT_TO_WORD; NOT; WORD_TO_INT; ST d",
            true,
        ),
        (
            "LD M8000; MOV D0 D2",
            "n AT %MW1000 : INT; d AT %MW1002 : INT;",
            "LD n; INT_TO_WORD; NOT; WORD_TO_INT; ST d",
            false,
        ),
    ] {
        let [left, right] = [own(instructions), iec(variables, body)];
        assert_eq!(is_equal(&left, &right), is_same, "{instructions}\n{variables}\n{body}");
        assert_eq!(is_equal(&right, &left), is_same, "{instructions}\n{variables}\n{body}");
    }
}

/// Instructions on words that have a counterpart. D0 to D5 are words, the pairs begin at D10, D12 and D15.
fn outputs() -> impl Strategy<Value = String> {
    let word = || prop::sample::select(vec!["D0", "D1", "D2", "D3", "D4", "D5"]);
    let pair = || prop::sample::select(vec!["D10", "D12", "D15"]);
    let number = || prop_oneof![Just(0_i64), Just(1), Just(-1), Just(32767), Just(-32768), -300..300_i64];
    let value = move || {
        prop_oneof![word().prop_map(str::to_string), number().prop_map(|number| format!("K{number}"))]
    };
    let wide = move || {
        let constant =
            prop_oneof![number(), -5_000_000..5_000_000_i64].prop_map(|number| format!("K{number}"));
        prop_oneof![pair().prop_map(str::to_string), constant]
    };
    let mask = || prop::sample::select(vec!["HF0F", "HFF00", "D1", "K7", "D4"]).prop_map(str::to_string);
    let divisor = || prop::sample::select(vec!["K2", "K7", "K-3", "K1000"]);
    let function = || prop::sample::select(vec!["ADD", "SUB"]);
    let bits = || prop::sample::select(vec!["WAND", "WOR", "WXOR"]);
    let step = || prop::sample::select(vec!["INC", "DEC", "NEG"]);
    let pulse = || prop::sample::select(vec!["", "", "P"]);
    prop_oneof![
        (function(), pulse(), value(), value(), word())
            .prop_map(|(f, p, a, b, c)| format!("{f}{p} {a} {b} {c}")),
        (function(), pulse(), wide(), wide(), pair())
            .prop_map(|(f, p, a, b, c)| format!("D{f}{p} {a} {b} {c}")),
        (step(), pulse(), word()).prop_map(|(f, p, a)| format!("{f}{p} {a}")),
        (step(), pulse(), pair()).prop_map(|(f, p, a)| format!("D{f}{p} {a}")),
        (pulse(), value(), word()).prop_map(|(p, a, b)| format!("MOV{p} {a} {b}")),
        (pulse(), wide(), pair()).prop_map(|(p, a, b)| format!("DMOV{p} {a} {b}")),
        (bits(), pulse(), mask(), mask(), word()).prop_map(|(f, p, a, b, c)| format!("{f}{p} {a} {b} {c}")),
        (bits(), pair(), pair(), pair()).prop_map(|(f, a, b, c)| format!("D{} {a} {b} {c}", &f[1..])),
        (value(), word()).prop_map(|(a, b)| format!("CML {a} {b}")),
        (pulse(), word(), value(), pair()).prop_map(|(p, a, b, c)| format!("MUL{p} {a} {b} {c}")),
        (pulse(), word(), divisor(), 0..5_u32).prop_map(|(p, a, b, c)| format!("DIV{p} {a} {b} D{c}")),
        (pair(), divisor()).prop_map(|(a, b)| format!("DDIV {a} {b} D20")),
        (value(), value()).prop_map(|(a, b)| format!("CMP {a} {b} M0")),
        (pulse(), wide(), wide()).prop_map(|(p, a, b)| format!("DCMP{p} {a} {b} Y0")),
        (word(), -50..50_i64, 0..50_i64)
            .prop_map(|(a, low, more)| format!("ZCP K{low} K{} {a} M3", low + more)),
        prop::sample::select(vec![
            "ZRST M1 M4",
            "ZRST D2 D5",
            "ZRST D0 D1",
            "ZRST D10 D13",
            "RST D3",
            "FMOV D2 D0 K5",
            "FMOVP K0 D1 K3",
            "BMOV D0 D2 K4",
            "BMOV D2 D0 K4",
            "BMOVP D1 D0 K5",
            "OUT Y5",
            "SET M7",
            "RST M7",
        ])
        .prop_map(str::to_string),
    ]
}

fn programs() -> impl Strategy<Value = String> {
    let bit = prop::sample::select(vec!["X0", "X1", "X2", "M0", "M3", "Y1", "M7"]);
    let contact =
        (prop::sample::select(vec!["LD", "LDI"]), bit).prop_map(|(word, bit)| format!("{word} {bit}"));
    let compare = prop::sample::select(vec![
        "LD>= D0 K5",
        "LDD< D10 D12",
        "LDD>= D15 K40000",
        "LD<> D2 D1",
        "LD M8000",
    ]);
    let load = prop_oneof![3 => contact, 2 => compare.prop_map(str::to_string)];
    let join = prop::sample::select(vec!["ANB", "ORB"]);
    let outputs = prop::collection::vec(outputs(), 1..4);
    let rung = (load.clone(), prop::option::of((load, join)), outputs).prop_map(|(first, more, outputs)| {
        let more = more.map_or(String::new(), |(load, join)| format!("{load}\n{join}\n"));
        format!("{first}\n{more}{}\n", outputs.join("\n"))
    });
    prop::collection::vec(rung, 1..5).prop_map(|rungs| rungs.concat() + "END\n")
}

/// Some scans of all machines with the same inputs and the same words at first; the lists are FX lists, but for
/// the one of IEC 61131-3.
fn run_alike(lists: &[&str], iec: &str, words: &[i16], inputs: &[u8]) -> Result<(), TestCaseError> {
    let declared = types(iec);
    let mut machines = vec![Fx::default(); lists.len()];
    let mut other = Iec::default();
    for machine in &mut machines {
        machine.words = (0..).zip(words.iter().copied()).collect();
    }
    for (number, low) in (0_u32..).zip(words) {
        let high = words.get(number as usize + 1).copied().unwrap_or(0);
        let value = match declared.get(&format!("D{number}")).map(String::as_str) {
            Some("INT") => i64::from(*low),
            Some("DINT") => i64::from(i32::from(high) << 16 | i32::from(*low as u16)),
            _ => continue,
        };
        other.values.insert(format!("D{number}"), value);
    }
    for pattern in inputs {
        for bit in 0..3 {
            let name = format!("X{bit}");
            let is_on = pattern >> bit & 1 == 1;
            machines.iter_mut().for_each(|machine| _ = machine.bits.insert(name.clone(), is_on));
            other.values.insert(name, i64::from(is_on));
        }
        machines.iter_mut().zip(lists).for_each(|(machine, list)| machine.scan(list));
        other.scan(iec);
        for machine in &machines {
            prop_assert_eq!(&machine.bits, &machines[0].bits);
            prop_assert_eq!(&machine.words, &machines[0].words);
        }
        for (name, kind) in &declared {
            let number = || name[1..].parse::<u32>().unwrap();
            let word = |number| machines[0].words.get(&number).copied().unwrap_or(0);
            let own = match kind.as_str() {
                "INT" => i64::from(word(number())),
                "DINT" => i64::from(i32::from(word(number() + 1)) << 16 | i32::from(word(number()) as u16)),
                "BOOL" if !name.starts_with("Held") => i64::from(machines[0].bits.get(name) == Some(&true)),
                _ => continue,
            };
            let value = other.values.get(name).copied().unwrap_or(0);
            prop_assert_eq!(value, own, "{}\n{}\n{}", name, lists[0], iec);
        }
    }
    Ok(())
}

/// The same program with one line changed or left out.
fn mutant(text: &str, line: usize, with: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let drives: Vec<usize> = (0..lines.len() - 1).filter(|at| !is_contact(lines[*at])).collect();
    let at = drives[line % drives.len()];
    lines[at] = with;
    lines.join("\n") + "\n"
}

fn is_contact(line: &str) -> bool {
    ["LD", "AN", "OR"].iter().any(|word| line.starts_with(word)) && !line.starts_with("DOR")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(250))]

    #[test]
    fn what_differs_is_not_equal(
        text in programs(),
        line in 0..20_usize,
        with in outputs(),
        words in prop::collection::vec(any::<i16>(), 24),
        inputs in prop::collection::vec(0..8_u8, 6),
    ) {
        let other = mutant(&text, line, &with);
        let translation = to(&fx(&text), To::Iec);
        prop_assert!(translation.is_certain());
        let is_same = [list(&translation.text), fx(&text)].map(|one| is_equal(&fx(&other), &one));
        if is_same.contains(&true) {
            run_alike(&[&other, &text], &translation.text, &words, &inputs)?;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn both_machines_do_the_same(
        text in programs(),
        words in prop::collection::vec(prop_oneof![Just(0_i16), Just(-1), Just(32767), Just(-32768), any::<i16>()], 24),
        inputs in prop::collection::vec(0..8_u8, 6),
    ) {
        let written = certain(&fx(&text), To::Iec);
        run_alike(&[&text], &written, &words, &inputs)?;
        never_different(&text, &written);
        // What comes back does the same, too, as far as it comes back.
        let back = to(&list(&written), To::Fx);
        if back.rungs.iter().all(|rung| rung.note.is_none()) {
            run_alike(&[&text, &back.text], &written, &words, &inputs)?;
        }
    }
}
