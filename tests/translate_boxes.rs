//! What a list puts in parallel with a result that has driven something already is a rung of its own where that is
//! the same, and a box `{il … }` where it is not. A box has nothing in it that could stand outside.

use crate::stack_machine::{self, Bits};
use crate::translate::{certain, drawing, list};
use crate::translate_iec;
use rungwise::translate::{Certificate, Options, Proof, To, prove, translate};

/// What a list does, told by the stack machine: for all bits, and what they were one scan before.
fn same(left: &str, right: &str) {
    const NAMES: [&str; 6] = ["X0", "X1", "X2", "M0", "Y0", "Y1"];
    let bits = |state: u32| -> Bits {
        NAMES.iter().enumerate().map(|(at, name)| (name.to_string(), state >> at & 1 == 1)).collect()
    };
    for state in 0..1 << 12 {
        let before = bits(state >> 6);
        let ends = [left, right].map(|text| {
            let mut now = bits(state);
            stack_machine::scan(text, &mut now, &before);
            now
        });
        assert_eq!(ends[0], ends[1], "{state:012b}\n{left}\n{right}");
    }
}

#[test]
fn what_goes_on_in_parallel_behind_an_output_is_a_rung() {
    for (text, expected) in [
        ("LD X0\nOUT Y0\nOR X1\nOUT Y1\n", "LD X0\nOUT Y0\nLD X0\nOR X1\nOUT Y1\n"),
        // Behind it the list goes on: contacts, inverters, branches, and once more in parallel.
        (
            "LD X0\nANI X1\nSET Y0\nORI X2\nOUT Y1\nAND M0\nRST Y0\n",
            "LD X0\nANI X1\nSET Y0\nLD X0\nANI X1\nORI X2\nOUT Y1\nAND M0\nRST Y0\n",
        ),
        (
            "LD X0\nOUT Y0\nOR X1\nOUT Y1\nOR X2\nINV\nOUT M0\n",
            "LD X0\nOUT Y0\nLD X0\nOR X1\nOUT Y1\nLDI X0\nANI X1\nANI X2\nOUT M0\n",
        ),
        (
            "LDP X0\nMPS\nAND X1\nOUT Y0\nMPP\nORF X2\nOUT Y1\n",
            "LDP X0\nMPS\nAND X1\nOUT Y0\nMPP\nLDP X0\nORF X2\nOUT Y1\n",
        ),
        ("LD X0\nOUT Y0\nLD X1\nAND X2\nORB\nOUT Y1\n", "LD X0\nOUT Y0\nLD X0\nLD X1\nAND X2\nORB\nOUT Y1\n"),
        // What stands in parallel may well read what was driven before.
        ("LD X0\nOUT Y0\nOR Y0\nOUT Y1\n", "LD X0\nOUT Y0\nLD X0\nOR Y0\nOUT Y1\n"),
    ] {
        let drawn = certain(&list(text), To::Ladder);
        assert!(!drawn.contains("{il"), "{drawn}");
        let again = certain(&drawing(&drawn), To::Fx);
        same(text, &again);
        assert_eq!(prove(&list(text), &drawing(&drawn)), Proof::Equal { is_reordered: false });
        let listed = certain(&list(text), To::Fx);
        assert_eq!(listed.replace("MPS\n", "").replace("MPP\n", ""), {
            let expected = format!("{expected}END\n");
            expected.replace("MPS\n", "").replace("MPP\n", "")
        });
        same(text, &listed);
    }
    let drawn = certain(&list("LD X0\nOUT Y0\nOR X1\nOUT Y1\n"), To::Ladder);
    let expected = "\
|   X0                                     Y0  |
+---| |------------------------------------( )-+

|   X0                                     Y1  |
+---| |---+------------------------------( )-+";
    assert_eq!(drawn.lines().take(4).collect::<Vec<_>>(), expected.lines().take(4).collect::<Vec<_>>());
}

#[test]
fn lists_of_iec_do_so_too() {
    let head = "PROGRAM Main\nVAR\na, b, c, x, y : BOOL;\nEND_VAR\n";
    let source = translate_iec::list(&format!("{head}LD a\nAND c\nST x\nOR b\nST y\nEND_PROGRAM\n"));
    let drawn = translate_iec::certain(&source, To::Ladder);
    assert!(!drawn.contains("{il"), "{drawn}");
    let again = translate_iec::certain(&translate_iec::drawing(&drawn), To::Iec);
    assert_eq!(translate_iec::body(&again), ["LD a", "AND c", "ST x", "LD a", "AND c", "OR b", "ST y"]);
    // Two names of one address are one bit.
    let alike = "PROGRAM Main\nVAR\na AT %QX0.0 : BOOL; x AT %QX0.0 : BOOL; b, y : BOOL;\nEND_VAR\n";
    let boxed = translate_iec::list(&format!("{alike}LDN a\nST x\nOR b\nST y\nEND_PROGRAM\n"));
    assert!(translate_iec::to(&boxed, To::Ladder).text.contains("{il"));
}

#[test]
fn a_box_is_the_smallest_possible() {
    for part in [
        // Whoever asks once more finds another answer.
        "LD X0\nOR Y0\nOUT Y0\nOR X1\nOUT Y1\n",
        "LD Y1\nINV\nOUT Y0\nSET Y1\nOR X1\nOUT M0\n",
        "LD T0\nOUT T0 K5\nOR X1\nOUT M0\n",
        // An index register may lead to what is driven.
        "LDI M0Z0\nOUT M5\nOR X1\nOUT Y1\n",
        "LDI T5\nOUT T0Z0 K1\nOR X1\nOUT Y1\n",
        // The relay tells its edge to one contact.
        "LDP M2800\nOUT Y0\nOR X1\nOUT Y1\n",
        // The power before it is wanted once more.
        "LD X0\nMPS\nAND X1\nOUT Y0\nOR X2\nOUT Y1\nMPP\nOUT M0\n",
        // An instruction may change more than its operands say.
        "LD M0\nMOV K0 K1M0\nOR X1\nOUT Y1\n",
    ] {
        let [before, behind] = ["LD X5\nOUT Y5\nLD X6\nMPS\nOUT Y6\n", "LD X7\nOR Y7\nOUT Y7\n"];
        let before = before.replace("MPS\n", "");
        let text = format!("{before}{part}{behind}END\n");
        let translation = translate(&list(&text), None, To::Ladder, &Options::default());
        assert_eq!(translation.text.matches("{il\n").count(), 1, "{}", translation.text);
        assert!(translation.text.contains(&format!("{{il\n{part}}}\n")), "{}", translation.text);
        let kept: Vec<_> = translation.rungs.iter().filter(|rung| rung.is_kept).collect();
        let [rung] = &kept[..] else { panic!("{kept:?}") };
        assert_eq!(rung.note.as_ref().map(|note| note.key()), Some("logic.parallel-to-branch"));
        assert_eq!(rung.certificate, Some(Certificate::Construction));
        assert_eq!(translate(&drawing(&translation.text), None, To::Fx, &Options::default()).text, text);
    }
}
