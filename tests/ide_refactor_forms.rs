//! Refactorings keep the form in which the author wrote what they do not touch: margins, blank lines, calls, letters.

use crate::ide_refactor::{applied, check_all, offered};
use crate::ide_refactor_iec::{
    BITS, after, body_after, condition, do_the_same, found, outputs, program, relay_of, written,
};
use crate::translate_iec::{drawing, list};
use proptest::prelude::*;
use rungwise::document::{Document, Notation};
use rungwise::target::Target;
use rungwise::text::{Language, Span};
use rungwise::translate::{Proof, prove};

fn fx(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::named("fx2n").expect("a model"))
}

/// The titles and texts of the extractions where `text` has a `$`, or from one to another.
fn extractions(open: impl Fn(&str) -> Document, text: &str) -> Vec<(String, String)> {
    let start = text.find('$').expect("a cursor");
    let text = text.replacen('$', "", 1);
    let end = text.find('$').unwrap_or(start);
    let document = open(&text.replacen('$', "", 1));
    let offered = offered(&document, Span::new(start, end));
    let found = offered.iter().filter(|one| one.kind == "refactor.extract.relay");
    found.map(|one| (one.title.render(Language::English), applied(&document, one))).collect()
}

#[test]
fn a_rung_that_goes_leaves_no_gap() {
    for (before, inlined) in [
        ("LD a\nST m\n\nLD m\nAND b\nST x\n", "LD a\nAND b\nST x\n"),
        ("\nLD a\nST m\n\nLD m\nAND b\nST x\n", "\nLD a\nAND b\nST x\n"),
        ("\nLD a\nST m\n\n\nLD c\nST y\nLD m\nST x\n\n", "\nLD c\nST y\nLD a\nST x\n\n"),
        ("LD b\nST y\n\nLD a\nST m\n\nLD m\nST x\n", "LD b\nST y\n\nLD a\nST x\n"),
        // The last one of a group.
        ("LD b\nST y\nLD a\nST m\n\nLD m\nST x\n", "LD b\nST y\n\nLD a\nST x\n"),
        ("LD a\nST m\n\n(* lamp *)\nLD m\nST x\n", "(* lamp *)\nLD a\nST x\n"),
    ] {
        for line_end in ["\n", "\r\n"] {
            let text = |own: &str| program(BITS, own).replace('\n', line_end);
            assert_eq!(after(&list(&text(before)), "ST m", "inline.relay").1, text(inlined));
        }
    }
    let in_line = "PROGRAM P VAR a, m, x : BOOL; END_VAR LD a\nST m\n\nLD m\nST x\nEND_PROGRAM\n";
    let inlined = "PROGRAM P VAR a, m, x : BOOL; END_VAR \nLD a\nST x\nEND_PROGRAM\n";
    assert_eq!(after(&list(in_line), "ST m", "inline.relay").1, inlined);
    let text = "\nLD X0\nOUT M0\n\nLD M0\nOUT Y0\nEND\n";
    assert_eq!(after(&fx(text), "M0", "inline.relay").1, "\nLD X0\nOUT Y0\nEND\n");
}

#[test]
fn what_stands_before_a_rung_on_its_line_is_no_margin() {
    let bom = '\u{feff}';
    let head = "  LD a\n  JMPC Rather_long\n  LD c\n  ST y\n";
    for (before, moved) in [
        (
            format!("{head}Rather_long: LD a\n  AND( b\n    OR c\n  )\n  ST x\n"),
            format!("{head}Rather_long: LD b\n  OR c\n  AND a\n  ST x\n"),
        ),
        (
            "LD c\nST y\n(* words *) LD a\n    AND( b\n    OR c\n    )\n    ST x\n".to_string(),
            "LD c\nST y\n(* words *) LD b\n    OR c\n    AND a\n    ST x\n".to_string(),
        ),
        (
            "Go:\tLD\ta\n\tAND(\tb\n\tOR\tc\n\t)\n\tST\tx\n".to_string(),
            "Go:\tLD\tb\n\tOR\tc\n\tAND\ta\n\tST\tx\n".to_string(),
        ),
        (
            "LD a (* door *)\n  AND( b\n  OR c\n  )\n  ST x\n".to_string(),
            "LD b\nOR c\nAND a (* door *)\nST x\n".to_string(),
        ),
    ] {
        let text = |own: &str| program(BITS, own);
        let (_, became) = after(&list(&text(&before)), "AND(", "rung.wideFirst");
        assert_eq!(became, text(&moved));
    }
    let marked = list(&format!("{bom}LD a\nAND( b\nOR c\n)\nST x\n"));
    assert_eq!(after(&marked, "a", "rung.wideFirst").1, format!("{bom}LD b\nOR c\nAND a\nST x\n"));
    let marked = list(&format!("{bom}  LD a\n  AND( b\n  OR c\n  )\n  ST x\n"));
    assert_eq!(after(&marked, "a", "rung.wideFirst").1, format!("{bom}  LD b\n  OR c\n  AND a\n  ST x\n"));
    let marked = fx(&format!("{bom}  LD X0\n  LD X1\n  OR X2\n  ANB\n  OUT Y0\n"));
    assert_eq!(
        after(&marked, "X0", "rung.wideFirst").1,
        format!("{bom}  LD X1\n  OR X2\n  AND X0\n  OUT Y0\n")
    );
}

/// What is extracted at a cursor or a selection, and what nobody wants extracted.
#[test]
fn a_relay_is_offered_for_what_is_worth_one() {
    let no: &[&str] = &[
        // All of a rung, inverted or not, at a cursor; and as a selection where a coil has it already.
        "LD a\nOR $b\nST x\n",
        "LD a\nOR $b\nNOT\nST x\n",
        "LD a\nOR b\n$NOT\nST x\n",
        "$LD a\nOR b\n$ST x\n",
        "$LD a\nOR b\n$NOT\nST x\n",
        "$LD a\nOR b\n$STN x\n",
        "$LD a\nOR b\nAND TRUE\n$ST x\n",
        // One contact, and what is always on or off.
        "LD a\nAND $b\nST x\n",
        "$LD a\n$AND b\nST x\n",
        "LD a\nOR $TRUE\nAND b\nST x\n",
        "LD $a\nOR TRUE\nAND b\nST x\n",
        "LD a\n$AND TRUE\nAND FALSE\n$AND b\nST x\n",
        "LD a\n$AND( 1\nGT 2\n)\nAND b\n$ST x\n",
    ];
    for own in no {
        assert_eq!(extractions(list, own), [], "{own}");
    }
    let yes: &[(&str, &str)] = &[
        ("LD a\nOR $b\nAND c\nST x\n", "LD a\nOR b\nST Relay1\nLD Relay1\nAND c\nST x\n"),
        ("$LD a\nOR b\n$S x\n", "LD a\nOR b\nST Relay1\nLD Relay1\nS x\n"),
        ("$LD a\nOR b\n$ST x\nST y\n", "LD a\nOR b\nST Relay1\nLD Relay1\nST x\nST y\n"),
        ("LD a\n$AND b\nAND c\n$ST x\n", "LD b\nAND c\nST Relay1\nLD a\nAND Relay1\nST x\n"),
        ("LD a\nORN( b\nAND $c\n)\nAND d\nST x\n", "LD b\nAND c\nST Relay1\nLD a\nORN Relay1\nAND d\nST x\n"),
        // Where a part is not worth a relay, the part around it is.
        (
            "LD d\nAND( c\nOR( TRUE\nAND $a\n)\n)\nST x\n",
            "LD c\nOR( TRUE\nAND a\n)\nST Relay1\nLD d\nAND Relay1\nST x\n",
        ),
    ];
    for (own, extracted) in yes {
        let found = extractions(list, own);
        assert_eq!(found.first().map(|(_, text)| text.as_str()), Some(*extracted), "{own}");
    }
    assert_eq!(extractions(fx, "LD X0\nOR $X1\nINV\nOUT Y0\n"), []);
    assert_eq!(extractions(fx, "LD M8000\nOR $X1\nAND X2\nOUT Y0\n"), []);
    assert_eq!(extractions(fx, "$LD X0\nOR X1\n$OUT Y0\n"), []);
    let timer = extractions(fx, "$LD X0\nOR X1\n$OUT T0 K10\n");
    assert_eq!(timer[0].1, "LD X0\nOR X1\nOUT M0\nLD M0\nOUT T0 K10\n");
    assert_eq!(extractions(fx, "$LD X0\nOR X1\n$SET Y0\n")[0].1, "LD X0\nOR X1\nOUT M0\nLD M0\nSET Y0\n");
}

#[test]
fn a_split_rung_has_one_output_in_each() {
    for (before, split) in [
        (
            "LD X0\nMPS\nAND X1\nOUT Y0\nOUT Y1\nMPP\nAND X2\nOUT Y2\n",
            "LD X0\nAND X1\nOUT Y0\nLD X0\nAND X1\nOUT Y1\nLD X0\nAND X2\nOUT Y2\n",
        ),
        (
            "LD X0\nMPS\nAND X1\nMPS\nAND X3\nOUT Y0\nMPP\nOUT Y1\nMPP\nAND X2\nSET Y2\nSET Y3\n",
            "LD X0\nAND X1\nAND X3\nOUT Y0\nLD X0\nAND X1\nOUT Y1\nLD X0\nAND X2\nSET Y2\nLD X0\nAND X2\nSET Y3\n",
        ),
        (
            "LD X0\nOUT Y0\nAND X1\nOUT Y1\nOUT Y2\n",
            "LD X0\nOUT Y0\nLD X0\nAND X1\nOUT Y1\nLD X0\nAND X1\nOUT Y2\n",
        ),
    ] {
        assert_eq!(after(&fx(before), "X0", "rung.split").1, split);
        assert_eq!(found(&fx(split), "X0", "rung.split"), None);
    }
    let own = "LD a\nST x\nAND b\nST y\nST z\n";
    assert_eq!(body_after(own, "a", "rung.split"), "LD a\nST x\nLD a\nAND b\nST y\nLD a\nAND b\nST z\n");
    let drawn = "\
|   a       b           x    |
+--| |--+--| |--+------( )---+
|       |       |       y    |
|       |       +------( )---+
|       |   c           z    |
|       +--| |---------( )---+
";
    let (_, split) = after(&drawing(drawn), "a", "rung.split");
    assert_eq!(split.matches("( )").count(), 3);
    assert_eq!(split.split("\n\n").filter(|rung| rung.matches("( )").count() == 1).count(), 3, "{split}");
    // The last output of a branch would read what the one before it has changed.
    assert!(found(&fx("LD X0\nMPS\nANI Y0\nOUT Y0\nOUT Y1\nMPP\nOUT Y2\n"), "X0", "rung.split").is_none());
}

#[test]
fn what_is_offered_once_more_is_something_else() {
    let text = program(BITS, "\nLD a\nOR b\nST m\nST y\n\nLD m\nAND( c\nOR d\n)\nST x\n");
    check_all(&list(&text), |refactoring, after| {
        let start = refactoring.edits.last().map_or(0, |edit| edit.span.start as usize);
        let document = list(after);
        let again = offered(&document, Span::at(start.min(after.len())));
        match again.iter().find(|one| applied(&document, one) == *after) {
            Some(same) => Err(format!("{} changes nothing", same.kind)),
            None => Ok(()),
        }
    })
    .expect("something to do");
}

#[test]
fn what_is_not_touched_keeps_its_form() {
    let declared =
        format!("{BITS}\n    T1 : TON;\n    C1 : CTU;\n    R1 : R_TRIG;\n    n, k : INT;\n    t : TIME;");
    let wide = "LD a\nAND( b\nOR c\n)\n";
    let moved = "LD b\nOR c\nAND a\n";
    for own in [
        "{}ST t1.in\ncal t1(pt := t#5S, et => T)\nld t1.q\nst x\n",
        "{}ST t1.in\nCal  T1(\n   PT := T#5s, (* five *)\n   // out\n   ET=>t\n)\nLD T1.Q\nST x\n",
        "{}CALC T1(IN := a,\n        PT := T#5s)\n",
        "{}CALC T1(a, T#5s)\n",
        "{}R C1\n",
        "{}and( n\ngt 5\n)\nStn x\n",
        "{}AND(\nLD d\nOR e\n)\nST x\n",
        "{}JMPCN weiter\nLd n\nadd 1\nST  k\n  Weiter :\n",
        // What was called or stored once stays so.
        "LD d\nST T1.IN\nCAL T1(PT := T#5s)\nLD T1.Q\nST y\n{}ST x\n",
    ] {
        let text = |condition: &str| program(&declared, &own.replace("{}", condition));
        assert_eq!(after(&list(&text(wide)), "AND( b", "rung.wideFirst").1, text(moved), "{own}");
    }
    // Behind a call the condition goes on, and the call stays in its form.
    for call in [
        "LD d\nST T1.IN\nCAL T1(PT := T#5s)\n",
        "cal t1(pt:=T#5s, in:=d)\n",
        "CAL T1(d, T#5s)\n",
        "CAL T1(\n  IN := d,\n  PT := T#5s\n)\n",
    ] {
        let text = |rest: &str| program(&declared, &format!("{call}LD T1.q\n{rest}ST x\n"));
        let before = text("AND( b\nOR( c\nAND a\n)\n)\n");
        let expected = text("AND( c\nAND a\nOR b\n)\n");
        assert_eq!(after(&list(&before), "AND( b", "rung.wideFirst").1, expected, "{call}");
    }
    let detected = "cal r1(clk:=a)\nLD b\nAND( R1.q\nOR c\n)\nST x\n";
    let (_, text) = after(&list(&program(&declared, detected)), "LD b", "rung.wideFirst");
    assert_eq!(text, program(&declared, "cal r1(clk:=a)\nLD R1.q\nOR c\nAND b\nST x\n"));
}

#[test]
fn what_is_touched_is_written_in_the_words_around_it() {
    let declared = format!("{BITS}\n    T1 : TON;");
    let text = |own: &str| program(&declared, own);
    for (before, inlined) in [
        ("LD a\nST m\ncal T1(pt:=t#5s, in:=m)\n", "cal T1(pt:=t#5s, in:=a)\n"),
        ("LD a\nST m\nCAL T1(\n  PT := T#5s,\n  IN := m\n)\n", "CAL T1(\n  PT := T#5s,\n  IN := a\n)\n"),
        ("LD a\nOR b\nST m\ncal T1(pt:=t#5s, in:=m)\n", "LD a\nOR b\nST T1.IN\ncal T1(pt:=t#5s)\n"),
        ("ld a\nor b\nst m\nld m\nAnd c\nst x\n", "ld a\nor b\nAnd c\nst x\n"),
    ] {
        assert_eq!(after(&list(&text(before)), "m\n", "inline.relay").1, text(inlined), "{before}");
    }
    let (_, extracted) =
        after(&list(&program(BITS, "Ld a\nAnd( b\nOr c\n)\nSt x\n")), "Or c", "extract.relay");
    assert!(
        extracted.ends_with("Ld b\nOr c\nSt Relay1\nLd a\nAnd Relay1\nSt x\nEND_PROGRAM\n"),
        "{extracted}"
    );
    // A list that is to be short has the shortest forms.
    let long = "LD a\nST T1.IN\nCAL T1(PT := T#5s)\nLD T1.Q\nAND(\nLD b\nOR c\n)\nST x\n";
    let short = "CAL T1(IN := a, PT := T#5s)\nLD T1.Q\nAND( b\nOR c\n)\nST x\n";
    let (_, shortened) = after(&list(&text(long)), "b\n", "rung.shorten");
    assert_eq!(shortened, text(short));
    assert_eq!(found(&list(&text(short)), "b\n", "rung.shorten"), None);
    // What else a list could do without does not make another order a saving.
    let other = "LD a\nAND(\nLD b\nAND c\n)\nST x\n";
    assert_eq!(found(&list(&program(BITS, other)), "b\n", "rung.wideFirst"), None);
}

#[test]
fn letters_count_between_quotes() {
    let declared = format!("{BITS}\n    s : STRING;");
    let own = "LD s\nEQ 'Go'\nAND( b\nOR( s\nEQ 'go'\n)\n)\nST x\n";
    let text = program(&declared, own);
    check_all(&list(&text), |_, after| {
        let kept = ["'Go'", "'go'"].iter().all(|word| after.matches(word).count() == 1);
        if kept { Ok(()) } else { Err(after.to_string()) }
    })
    .expect("all quotes");
}

/// The body of a list in the letters and forms of several authors.
fn in_many_hands(text: &str, seed: u32) -> String {
    let (head, own) = text.split_once("END_VAR\n").expect("declarations");
    let mut state = seed | 1;
    let mut draw = |ways: u32| {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state % ways
    };
    let own = own.strip_suffix("END_PROGRAM\n").expect("an end");
    // A call stands in one line.
    let lines = own.replace("(\nCLK := ", "(CLK:=");
    let mut restyled = String::new();
    let mut rest = lines.lines().peekable();
    while let Some(line) = rest.next() {
        let mut line = line.to_string();
        if line.contains(":=") {
            line += rest.next().unwrap_or_default();
        }
        let (word, operand) = line.split_once(' ').unwrap_or((&line, ""));
        let word = match draw(4) {
            0 => word.to_lowercase(),
            1 => word[..1].to_string() + &word[1..].to_lowercase(),
            _ => word.to_string(),
        };
        let operand = if draw(4) == 0 { operand.to_uppercase() } else { operand.to_string() };
        let gap = if draw(5) == 0 { "   " } else { " " };
        let line = if operand.is_empty() { word } else { word + gap + &operand };
        // Not each rung is parted from the next, and not by one blank line.
        let is_store = line.to_lowercase().starts_with("st ");
        let blanks = if is_store { ["", "", "\n", "\n\n"][draw(4) as usize] } else { "" };
        let margin = if draw(6) == 0 { "  " } else { "" };
        restyled += &format!("{margin}{line}\n{blanks}");
    }
    format!("{head}END_VAR\n{restyled}END_PROGRAM\n")
}

/// The same in the letters and forms that the machine of the tests reads.
fn in_one_hand(text: &str) -> String {
    let (head, own) = text.split_once("END_VAR\n").expect("declarations");
    let line = |line: &str| {
        let words = line.split_whitespace().collect::<Vec<_>>().join(" ");
        let (word, operand) = words.split_once(' ').unwrap_or((&words, ""));
        let (word, operand) = (word.to_uppercase(), operand.to_lowercase());
        match (word.as_str(), operand.split_once('(')) {
            ("CAL", Some((instance, input))) if !input.is_empty() => {
                let input = input.trim_end_matches(')').split_once(":=").expect("a parameter").1;
                format!("CAL {instance}(\nCLK := {}\n)\n", input.trim())
            }
            ("CLK", _) => format!("CLK {operand}\n"),
            _ => format!("{word} {operand}").trim_end().to_string() + "\n",
        }
    };
    format!("{head}END_VAR\n{}", own.lines().map(line).collect::<String>())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whoever_wrote_a_list_it_does_the_same(
        rungs in prop::collection::vec((condition(), outputs(), prop::sample::select(&["n", "y", "z"][..])), 1..4),
        seed in any::<u32>(),
    ) {
        let text = in_many_hands(&written(&rungs), seed);
        let plain = in_one_hand(&text);
        check_all(&list(&text), |refactoring, after| {
            let relay = relay_of(refactoring);
            let proof = prove(&list(&text), &list(after));
            if relay.is_empty() && !matches!(proof, Proof::Equal { .. }) {
                return Err(format!("{proof:?}"));
            }
            // The same once more changes nothing.
            let start = refactoring.edits.last().map_or(0, |edit| edit.span.start as usize);
            let document = list(after);
            let again = offered(&document, Span::at(start.min(after.len())));
            if let Some(same) = again.iter().find(|one| applied(&document, one) == *after) {
                return Err(format!("{} makes no difference", same.kind));
            }
            do_the_same(&plain, &in_one_hand(after), &relay)
        })?;
    }
}
