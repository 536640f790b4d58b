//! What a proof says of two programs: never equal where a PLC would tell them apart, never different where it would not,
//! and a plain answer wherever there is one.

use rungwise::document::{Document, Notation};
use rungwise::scenario::shown;
use rungwise::target::{Model, Target};
use rungwise::translate::{Options, Proof, Shown, To, prove, translate};

/// The verdict on two FX lists; instructions are separated by semicolons, END is left out.
fn verdict(left: &str, right: &str) -> &'static str {
    let document = |text: &str| {
        let text = format!("{}\nEND\n", text.replace(';', "\n"));
        Document::new(&text, Notation::FxIl, Target::of(Model::Fx3u))
    };
    let names = ["left", "right"].map(String::from);
    let [left, right] = [document(left), document(right)];
    word(&shown(prove(&left, &right), [&left, &right], &names))
}

#[test]
fn what_formulas_cannot_tell_apart_differs_where_running_shows_it() {
    check(
        &[
            ("LD X0;OUT T0 K50;LD T0;OUT Y0", "LD X0;OUT T0 K60;LD T0;OUT Y0"),
            ("LD X0;OUT C0 K2;LD C0;OUT Y0", "LD X0;OUT C0 K3;LD C0;OUT Y0"),
            ("LD X0;MOV K5 D0", "LD X0;MOV K6 D0"),
            ("LD X0;ADD D0 K1 D0", "LD X0;INCP D0"),
            ("LD X0;OUT Y0;LD X1;OUT Y1", "LD X0;OUT Y0"),
            ("LD M8000;CMP D0 D1 M0;LD M0;OUT Y0", "LD M8000;CMP D1 D0 M0;LD M0;OUT Y0"),
            ("LD X1;CALL P0;FEND;P0;LD X0;OUT Y0;SRET", "LD X1;CALL P0;FEND;P0;LDI X0;OUT Y0;SRET"),
        ],
        |verdict| verdict == "different",
    );
}

#[test]
fn special_relays_that_tell_of_the_scan_are_what_the_cpu_makes_them() {
    check(
        &[
            ("LDP M8000;OUT Y0", "LD M8002;OUT Y0"),
            ("LDP M8002;OUT Y0", "LD M8002;OUT Y0"),
            ("LDF M8002;OUT Y0", "LDP M8003;OUT Y0"),
            ("LDF M8003;OUT Y0", "LDP M8001;OUT Y0"),
            ("LDF M8001;OUT Y0", "LDF M8000;OUT Y0"),
            ("LDP M8000;OUT Y0;LD M8002;OUT Y1", "LDP M8000;OUT Y0;OUT Y1"),
        ],
        |verdict| verdict == "equal",
    );
    check(
        &[
            ("LDF M8002;OUT Y0", "LD M8002;OUT Y0"),
            ("LDP M8003;OUT Y0", "LDI M8002;OUT Y0"),
            // Who jumps over a contact for an edge may come to it in any scan.
            ("LD X0;CJ P0;LDP M8000;OUT Y0;P0;LD X1;OUT Y1", "LD X0;CJ P0;LD M8002;OUT Y0;P0;LD X1;OUT Y1"),
            ("LDP M8000;OUT Y0;LD X0;SET M8002", "LD M8002;OUT Y0;LD X0;SET M8002"),
            ("LD M8013;OUT Y0", "LDP M8013;OUT Y0"),
        ],
        |verdict| verdict == "different",
    );
}

#[test]
fn what_comes_before_a_jump_may_stand_in_its_rung() {
    check(
        &[
            (
                "LD X0;OUT Y0;CJ P0;LD X1;OUT Y1;P0;LD X2;OUT Y2",
                "LD X0;OUT Y0;LD X0;CJ P0;LD X1;OUT Y1;P0;LD X2;OUT Y2",
            ),
            (
                "LD X0;MPS;AND X1;CJ P0;MPP;OUT Y0;OUT Y1;P0;LD X2;OUT Y2",
                "LD X0;AND X1;CJ P0;LD X0;OUT Y0;OUT Y1;P0;LD X2;OUT Y2",
            ),
            ("LD X0;MOV D0 D1;CMP D0 K1 M0;LD X1;OUT Y1", "LD X0;MOV D0 D1;LD X0;CMP D0 K1 M0;LD X1;OUT Y1"),
        ],
        |verdict| verdict == "equal",
    );
    check(
        &[
            // The condition is asked again when what it asks for has changed.
            (
                "LD Y0;RST Y0;CJ P0;LD X1;OUT Y1;P0;LD X2;OUT Y2",
                "LD Y0;RST Y0;LD Y0;CJ P0;LD X1;OUT Y1;P0;LD X2;OUT Y2",
            ),
            (
                "LDP M2800;OUT Y0;CJ P0;LD X1;OUT Y1;P0;LD X2;OUT Y2",
                "LDP M2800;OUT Y0;LDP M2800;CJ P0;LD X1;OUT Y1;P0;LD X2;OUT Y2",
            ),
            ("LD X0;REF X0 K8;CMP D0 K1 M0;LD X1;OUT Y1", "LD X0;REF X0 K8;LD X0;CMP D0 K1 M0;LD X1;OUT Y1"),
            (
                "LD M0;CMP D0 K1 M0;MOV D0 K1M4;LD X1;OUT Y1",
                "LD M0;CMP D0 K1 M0;LD M0;MOV D0 K1M4;LD X1;OUT Y1",
            ),
        ],
        |verdict| verdict != "equal",
    );
}

#[test]
fn a_rung_that_cannot_be_read_is_told_at_its_place() {
    let document = |text: &str| Document::new(text, Notation::FxIl, Target::of(Model::Fx3u));
    let plain = document("LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND\n");
    let unread = document("LD X0\nOUT Y0\nLD X1\nFOO Y1\nEND\n");
    let bytes = document("\u{1}\u{fffd}%PDF ~~\n\u{2}\n");
    for (other, line) in [(&unread, "LD X1"), (&bytes, "%PDF")] {
        for (documents, side) in [([&plain, other], 1), ([other, &plain], 0)] {
            let Proof::Undecided { reason, at, .. } = prove(documents[0], documents[1]) else { panic!() };
            assert_eq!(reason.key(), "prove.unread");
            let place = at[side].map(|span| other.slice(span)).unwrap_or_default();
            assert!(place.starts_with(line), "{place:?}");
            assert_eq!(at[1 - side], None);
        }
    }
}

#[test]
fn a_register_is_what_was_written_to_it() {
    // A comparison before the write, and the same one behind it.
    let again = |write: &str, compare: &str| {
        let pair = [format!("{compare};{write};OUT Y0"), format!("{compare};{write};{compare};OUT Y0")];
        verdict(&pair[0], &pair[1])
    };
    let elsewhere = [
        ("MOV D1 D10", "LD= D0 K5"),
        ("MOV D1 D1", "LD= D0 K5"),
        ("DMOV D10 D2", "LD= D1 K5"),
        ("DMOV D10 D2", "LDD= D4 K5"),
        ("MUL D10 D11 D2", "LD= D4 K5"),
        ("FMOV K0 D1 K4", "LD= D5 K5"),
        ("BMOV D20 D1 K4", "LD= D5 K5"),
        ("ZRST D1 D4", "LD= D5 K5"),
        ("RST D1", "LD= D0 K5"),
        ("SET D1.0", "LD= D0 K5"),
        ("MOV K1 T0", "LD= D0 K5"),
        ("MOV K1 R0", "LD= D0 K5"),
    ];
    for (write, compare) in elsewhere {
        assert_eq!(again(write, compare), "equal", "{write}; {compare}");
    }
    let there = [
        ("MOV D1 D0", "LD= D0 K5"),
        ("DMOV D10 D4", "LD= D5 K5"),
        ("MOV D10 D5", "LDD= D4 K5"),
        ("MOV D10 T1", "LDD= T0 K5"),
        ("MUL D10 D11 D4", "LD= D5 K5"),
        ("DMUL D10 D12 D2", "LD= D5 K5"),
        ("FMOV K0 D1 K4", "LD= D4 K5"),
        ("DFMOV K0 D1 K4", "LD= D8 K5"),
        ("FMOV K0 D1 D9", "LD= D40 K5"),
        ("BMOV D20 D1 K4", "LD= D4 K5"),
        // M8024 may be on.
        ("BMOV D20 D1 K4", "LD= D23 K5"),
        ("FMOV K0 D0 K500", "LD= D499 K5"),
        ("ZRST D1 D4", "LD= D4 K5"),
        ("RST D5", "LD= D5 K5"),
        ("SET D5.0", "LD= D5 K5"),
        ("MOV K4M0 D5", "LD D5.3"),
        ("MOV K1 D0Z0", "LD= D5 K5"),
        ("MOV K5 D5", "LD= D0Z0 K5"),
        ("DMOV D0 Z0", "LD= V0 K5"),
        ("RST V0", "LDD= Z0 K5"),
        ("RST Z0", "LD= D0Z0 K5"),
    ];
    for (write, compare) in there {
        assert_ne!(again(write, compare), "equal", "{write}; {compare}");
    }
}

#[test]
fn a_condition_that_an_output_changes_is_not_asked_again() {
    for (contact, output) in [
        ("LD D0.3", "RST D0"),
        ("LD> D0 K5", "RST D0.3"),
        ("LDD> D0 K5", "RST D1"),
        ("LD> D0Z0 K5", "RST D5"),
        ("LD> D0Z0 K5", "RST Z0"),
        ("LD M0Z0", "RST Z0"),
        ("LD M0Z0", "RST M5"),
        ("LD> D0 K5V0", "RST V0"),
        ("LDD> Z0 K5", "RST V0"),
        ("LD> K1M0 K5", "RST M3"),
    ] {
        for last in ["MOV K5 K1Y0", "CJ P0;LD X1;OUT Y1;P0;LD X2;OUT Y2"] {
            let once = format!("{contact};{output};{last}");
            let twice = format!("{contact};{output};{contact};{last}");
            assert_ne!(verdict(&once, &twice), "equal", "{once}");
        }
    }
    for (contact, output) in [("LD D0.3", "RST D2"), ("LD> D0 K5", "RST M3"), ("LD M0", "RST M5")] {
        let once = format!("{contact};{output};MOV K5 K1Y0");
        let twice = format!("{contact};{output};{contact};MOV K5 K1Y0");
        assert_eq!(verdict(&once, &twice), "equal", "{once}");
    }
}

#[test]
fn what_a_label_is_called_makes_no_difference() {
    let list = |labels: [&str; 2], jump: &str| {
        let text = format!(
            "PROGRAM p\nVAR X0 AT %IX0.0 : BOOL; Y0 AT %QX0.0 : BOOL; Y1 AT %QX0.1 : BOOL; END_VAR\n\
             LD X0\nJMPC {jump}\nLD X0\nST Y0\n{}:\nLDN X0\nST Y1\n{}:\nLD X0\nST Y1\nEND_PROGRAM\n",
            labels[0], labels[1]
        );
        Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
    };
    let own = list(["First", "Second"], "First");
    assert_eq!(word(&prove(&own, &list(["a", "b"], "a"))), "equal");
    assert_eq!(word(&prove(&own, &list(["Second", "First"], "second"))), "equal");
    for (labels, jump) in
        [(["a", "b"], "b"), (["Second", "First"], "First"), (["a", "a"], "a"), (["a", "b"], "First")]
    {
        assert_ne!(word(&prove(&own, &list(labels, jump))), "equal", "{labels:?} {jump}");
    }
    let fx = |jump: &str| {
        let text = format!("LD X0\nCJ {jump}\nLD X0\nOUT Y0\nP4\nLDI X0\nOUT Y1\nP5\nLD X0\nOUT Y1\nEND\n");
        Document::new(&text, Notation::FxIl, Target::of(Model::Fx2n))
    };
    for (jump, expected) in [("P4", true), ("P5", false)] {
        assert_eq!(word(&prove(&own, &fx(jump))) == "equal", expected, "{jump}");
        assert_eq!(word(&prove(&fx(jump), &own)) == "equal", expected, "{jump}");
    }
}

#[test]
fn a_jump_behind_a_block_is_one_in_its_own_rung() {
    let list = |load: &str| {
        let text = format!(
            "PROGRAM p\nVAR X0 AT %IX0.0 : BOOL; Y0 AT %QX0.0 : BOOL; C1 : CTU; END_VAR\n\
             LD X0\nST C1.CU\nCAL C1(PV := 3)\n{load} C1.Q\nJMPC Over\nLD X0\nST Y0\nOver:\nLD X0\nST Y0\nEND_PROGRAM\n"
        );
        Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
    };
    let fx = "LD X0\nOUT C1 K3\nLD C1\nCJ P0\nLD X0\nOUT Y0\nP0\nLD X0\nOUT Y0\nEND\n";
    let fx = Document::new(fx, Notation::FxIl, Target::of(Model::Fx2n));
    assert_eq!(word(&prove(&fx, &list("LD"))), "equal");
    assert_eq!(word(&prove(&list("LD"), &fx)), "equal");
    assert_ne!(word(&prove(&fx, &list("LDN"))), "equal");
    for pulsed in
        ["LD X2\nINCP D0\nEND\n", "LD X1\nADD D0 K1 D1\nLD X2\nSET M2\nLD X2\nAND X3\nINCP D0\nEND\n"]
    {
        let list = Document::new(pulsed, Notation::FxIl, Target::of(Model::Fx2n));
        let text = translate(&list, None, To::Iec, &Options::default()).text;
        let written = Document::new(&text, Notation::IecIl, Target::of(Model::Iec));
        assert_eq!(word(&prove(&list, &written)), "equal", "{text}");
    }
}

#[test]
fn what_an_edge_of_a_relay_with_one_memory_tells_of_the_relay() {
    check(
        &[
            ("LDP M2800;AND M2800;OUT Y0", "LDP M2800;OUT Y0"),
            ("LDF M2800;ANI M2800;OUT Y0", "LDF M2800;OUT Y0"),
            ("LDP M2800;ANDF M2800;OUT Y0", "LDP M2800;ANDF M2800;AND X0;OUT Y0"),
        ],
        |verdict| verdict == "equal",
    );
}

#[test]
fn clocks_are_seen_on_and_off() {
    for clock in ["M8011", "M8012", "M8013", "M8014"] {
        let [left, right] = ["LD", "LDP"].map(|word| {
            Document::new(&format!("{word} {clock}\nOUT Y0\nEND\n"), Notation::FxIl, Target::of(Model::Fx3u))
        });
        let proof = shown(prove(&left, &right), [&left, &right], &["left", "right"].map(String::from));
        let Proof::Different(found) = proof else { panic!("{clock}: {}", word(&proof)) };
        assert!(matches!(found.shown, Shown::Runs(_)), "{clock}: {:?}", found.shown);
    }
}

#[test]
fn a_preset_of_0_works_as_1_does() {
    check(
        &[
            ("LD X0;OUT T0 K0;LD T0;OUT Y0", "LD X0;OUT T0 K1;LD T0;OUT Y0"),
            ("LD X0;OUT C0 K1;LD C0;OUT Y0", "LD X0;OUT C0 K0;LD C0;OUT Y0"),
        ],
        |verdict| verdict == "equal",
    );
    check(
        &[
            ("LD X0;OUT T0 K0;LD T0;OUT Y0", "LD X0;OUT T0 K2;LD T0;OUT Y0"),
            ("LD X0;OUT C200 K0;LD C200;OUT Y0", "LD X0;OUT C200 K1;LD C200;OUT Y0"),
        ],
        |verdict| verdict != "equal",
    );
}

#[test]
fn what_who_calls_may_never_do_is_no_difference() {
    check(
        &[
            ("LD X0;CALL P1;FEND;P1;LD X0;AND X1;SET Y1;SRET", "LD X0;CALL P1;FEND;P1;LD X1;SET Y1;SRET"),
            ("LD X0;OUT Y0;FEND;P1;LD X0;SET Y1;SRET", "LD X0;OUT Y0;FEND;P1;LD X1;SET Y1;SRET"),
            // Nothing looks at the coil of a counter.
            ("LD X0;OUT C0 K3;LD C0;OUT Y0", "LDP X0;OUT C0 K3;LD C0;OUT Y0"),
        ],
        |verdict| verdict == "undecided",
    );
}

#[test]
fn behind_a_branch_that_leaves_nothing_is_left_out() {
    let drawing = |contact: &str, end: &str| {
        let declared = "X0 AT %IX0.0 : BOOL; X1 AT %IX0.1 : BOOL; Y0 AT %QX0.0 : BOOL; Y1 AT %QX0.1 : BOOL;";
        let text = format!(
            "PROGRAM Main\nVAR {declared} END_VAR\n\
             |   X1                                     Y0  |\n\
             +-+-| |------------------------------------( )-+\n\
             | |                                            |\n\
             | | X0                                         |\n\
             | +-| |--------------------------{end}      |\n\
             \n\
             |   X1                                     Y1  |\n\
             +---|{contact}|------------------------------------( )-+\n\
             {}END_PROGRAM\n",
            if end == "-->>L1--" { "L1:\n\n" } else { "" }
        );
        Document::new(&text, Notation::Ladder, Target::of(Model::Iec))
    };
    for end in ["<RETURN>", "-->>L1--"] {
        assert_eq!(word(&prove(&drawing(" ", end), &drawing(" ", end))), "equal", "{end}");
        assert_ne!(word(&prove(&drawing(" ", end), &drawing("/", end))), "equal", "{end}");
    }
}

#[test]
fn what_a_master_control_leaves_out_differs_where_that_is_seen() {
    check(
        &[
            ("LD X0;MC N0 M100;LD X1;OUT Y0;MCR N0", "LD X0;MC N0 M100;LD X2;OUT Y0;MCR N0"),
            ("LD X0;MC N0 M100;LD X1;SET Y0;MCR N0", "LD X0;MC N0 M100;LD X1;OUT Y0;MCR N0"),
        ],
        |verdict| verdict == "different",
    );
}

pub(crate) fn word(proof: &Proof) -> &'static str {
    match proof {
        Proof::Equal { .. } => "equal",
        Proof::Different(_) => "different",
        Proof::Undecided { .. } => "undecided",
    }
}

/// All pairs for which the verdict, either way round, is not as `is_right` wants it.
fn check(pairs: &[(&str, &str)], is_right: impl Fn(&str) -> bool) {
    let both = pairs.iter().flat_map(|(left, right)| [(*left, *right), (*right, *left)]);
    let wrong: Vec<_> = both
        .map(|(left, right)| (verdict(left, right), left, right))
        .filter(|(verdict, ..)| !is_right(verdict))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_looks_elsewhere_is_never_equal() {
    check(
        &[
            // An index register changes what a name means.
            (
                "LD= D0Z0 K5;OUT Y0;LD X0;INC Z0;LD= D0Z0 K5;OUT Y1",
                "LD= D0Z0 K5;OUT Y0;LD X0;INC Z0;LD Y0;OUT Y1",
            ),
            (
                "LD= D0Z0 K5;OUT Y0;LD X0;RST Z0;LD= D0Z0 K5;OUT Y1",
                "LD= D0Z0 K5;OUT Y0;LD X0;RST Z0;LD Y0;OUT Y1",
            ),
            // The carry goes in, the mode says which way data go, the relay how a counter counts.
            ("LD X0;OUT M8022;LD X1;RCL D0 K1", "LD X2;OUT M8022;LD X1;RCL D0 K1"),
            (
                "LD X0;OUT M8024;LD X1;BMOV D0 D10 K5;LD X2;OUT M8024",
                "LD X3;OUT M8024;LD X1;BMOV D0 D10 K5;LD X2;OUT M8024",
            ),
            (
                "LD X0;OUT M8200;LD X1;OUT C200 K5;LD X2;OUT M8200",
                "LDI X0;OUT M8200;LD X1;OUT C200 K5;LD X2;OUT M8200",
            ),
            // Instructions that name nothing they write.
            ("LD X3;OUT Y20;LD X0;REF X0 K8;LD X3;OUT Y21", "LD X3;OUT Y20;LD X0;REF X0 K8;LD Y20;OUT Y21"),
            (
                "LD S0;OUT Y20;LD X0;IST X20 S20 S27;LD S0;OUT Y21",
                "LD S0;OUT Y20;LD X0;IST X20 S20 S27;LD Y20;OUT Y21",
            ),
            ("LD S900;OUT Y20;LD X0;ANR;LD S900;OUT Y21", "LD S900;OUT Y20;LD X0;ANR;LD Y20;OUT Y21"),
            (
                "LD= K1M8020 K1;OUT Y20;LD X0;ADD D0 D1 D2;LD= K1M8020 K1;OUT Y21",
                "LD= K1M8020 K1;OUT Y20;LD X0;ADD D0 D1 D2;LD Y20;OUT Y21",
            ),
            // The contact for an edge of these relays that is executed first takes it from the others.
            ("LDP M2800;AND X1;OUT Y0;LDP M2800;OUT Y1", "LDP M2800;OUT Y1;LDP M2800;AND X1;OUT Y0"),
            ("LDP M2800;AND X1;ORP M2800;OUT Y0", "LDP M2800;OUT Y0"),
            ("LD X0;LDP M2800;AND X0;ORB;OUT Y0;LDP M2800;OUT Y1", "LD X0;OUT Y0;LDP M2800;OUT Y1"),
            ("LDF M3071;OUT Y0;LD X0;OUT M3071", "LD X0;OUT M3071;LDF M3071;OUT Y0"),
            // A rung that cannot be read may begin a master control.
            (
                "LD X1;FOO X2;MC N0 M10;LD X0;OUT Y0;MCR N0",
                "LD X1;FOO X2;MC N0 M10;LDI X0;RST Y0;LD X0;SET Y0;MCR N0",
            ),
            // Power may be missing at the left rail.
            ("LD X7;MC N0 M100;LD X0;OUT Y0;MCR N0", "LD X7;MC N0 M100;LD X0;SET Y0;LDI X0;RST Y0;MCR N0"),
        ],
        |verdict| verdict != "equal",
    );
}

#[test]
fn what_ends_each_scan_alike_is_never_different() {
    check(
        &[
            // The order does not matter, though one stands between that looks at bits.
            ("LD X0;OUT Y0;LD X1;MOV K1Y10 D0", "LD X1;MOV K1Y10 D0;LD X0;OUT Y0"),
            ("LD X0;OUT Y0;LD X1;CMP D0 K5 M10", "LD X1;CMP D0 K5 M10;LD X0;OUT Y0"),
            // A timer without power is off, and so is what was reset; what was set is on.
            ("LD X0;OUT T0 K10;LD T0;OUT Y0", "LD X0;OUT T0 K10;LD T0;AND X0;OUT Y0"),
            ("LD X0;RST C0;LD C0;OUT Y0", "LD X0;RST C0;LD C0;ANI X0;OUT Y0"),
            ("LD X0;ZRST M0 M5;LD M2;OUT Y0", "LD X0;ZRST M0 M5;LD M2;ANI X0;OUT Y0"),
            ("LD X0;PLS M0;LD M0;OUT Y0", "LD X0;PLS M0;LD M0;AND X0;OUT Y0"),
            ("LD X0;SET S0;LD S0;OUT Y0", "LD X0;SET S0;LD S0;OR X0;OUT Y0"),
            ("LD M8000;MOV K5 D0;LD= D0 K5;OUT Y0", "LD M8000;MOV K5 D0;LD M8000;OUT Y0"),
            // Numbers are numbers.
            ("LD>= D0 D1;AND>= D1 D2;OUT Y0", "LD>= D0 D1;AND>= D1 D2;AND>= D0 D2;OUT Y0"),
            ("LD= K1X0 K0;OUT Y0", "LDI X0;ANI X1;ANI X2;ANI X3;OUT Y0"),
            ("LDD= D0 K0;OUT Y0", "LD= D0 K0;AND= D1 K0;OUT Y0"),
            // What a master control leaves out has the power that switches it on.
            ("LD X0;MC N0 M100;LD X1;AND X0;OUT Y0;MCR N0", "LD X0;MC N0 M100;LD X1;OUT Y0;MCR N0"),
            // An edge of a bit that was not changed in between is the same edge.
            ("LD M0;OUT M0;LDP M0;OUT Y0", "LDP M0;OUT Y0;LD M0;OUT M0"),
        ],
        |verdict| verdict != "different",
    );
}

#[test]
fn what_is_the_same_is_equal() {
    check(
        &[
            ("LD M8002;OUT Y0", "LDI M8003;OUT Y0"),
            ("LD M8000;AND X0;OUT Y0", "LD X0;ANI M8001;OUT Y0"),
            ("LD X0;OUT Y0;END;LD X1;OUT Y1", "LD X0;OUT Y0;END;LD X2;OUT Y1"),
            ("LD X0;OUT M0;LD M0;OUT Y0", "LD X0;OUT M0;LD X0;OUT Y0"),
            // Without power at the left rail nothing is on, whatever is inverted.
            (
                "LD X1;MC N0 M10;LD X0;OUT Y0;INV;OUT Y1;INC D1;MCR N0",
                "LD X1;MC N0 M10;LD X0;OUT Y0;LDI X0;OUT Y1;LDI X0;INC D1;MCR N0",
            ),
            ("LDP M2799;AND X1;ORP M2799;OUT Y0", "LDP M2799;OUT Y0"),
            ("LDP M2800;AND X1;OUT Y0;LDP M2800;OUT Y1", "LD X1;ANDP M2800;OUT Y0;LDP M2800;OUT Y1"),
            ("LD X0;OR X1;OUT Y0", "LDI X0;ANI X1;INV;OUT Y0"),
        ],
        |verdict| verdict == "equal",
    );
}

#[test]
fn what_differs_is_different() {
    check(
        &[
            ("LD X0;OUT Y0;LD X1;MOV K5 D0", "LDI X0;OUT Y0;LD X1;MOV K5 D0"),
            ("LD X0;OUT T0 K10;LD T0;OUT Y0", "LD X0;OUT T0 K10;LDI T0;OUT Y0"),
            ("LD T0;OUT Y0;LD X0;OUT T0 K10;LD T0;OUT Y1", "LD T0;OUT Y0;LD X0;OUT T0 K10;LD Y0;OUT Y1"),
            ("LD X1;CJ P0;LD X0;OUT M0;P0;LD M0;OUT Y0", "LD X1;CJ P0;LD X0;OUT M0;P0;LD X0;OUT Y0"),
            ("LD X0;SET Y0;LD X1;RST Y0", "LD X1;RST Y0;LD X0;SET Y0"),
            ("LD X0;OUT Y0;LD X1;OUT K1M0", "LD X0;ANI X2;OUT Y0;LD X1;OUT K1M0"),
            ("LD X0;OUT Y0;LD X1;MOV D0 K1M0", "LD X0;ANI X2;OUT Y0;LD X1;MOV D0 K1M0"),
        ],
        |verdict| verdict == "different",
    );
}

#[test]
fn what_instructions_make_of_bits_is_no_difference() {
    check(
        &[
            ("LD X0;WAND K0 D0 D0;LD X0;AND D0.1;OUT Y0", "LD X0;WAND K0 D0 D0;LDI M8000;OUT Y0"),
            ("LD X0;CMP D0 D1 M0;LD M0;AND M1;OUT Y0", "LD X0;CMP D0 D1 M0;LD M0;AND M1;ANI X0;OUT Y0"),
            ("LD M6;CML D4 D1;MOV D2 D1", "LD M6;AND X1;CML D4 D1;LD M6;MOV D2 D1"),
        ],
        |verdict| verdict == "undecided",
    );
    check(&[("LD X0;CMP D0 D1 M0;LD M0;OUT Y0", "LD X0;CMP D0 D1 M0;LDI M0;OUT Y0")], |verdict| {
        verdict == "different"
    });
}

#[test]
fn declarations_count() {
    let list = |variables: &str| {
        let text = format!("PROGRAM p\n{variables}\nEND_VAR\nLD n\nGT lim\nST y\nEND_PROGRAM\n");
        Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
    };
    let first = list("VAR lim : INT := 5; n : INT; y : BOOL;");
    for same in ["VAR lim : INT := 5; n : INT; y : BOOL;", "VAR n , LIM:int; y : bool; END_VAR VAR"] {
        let lim = same.contains(":= 5");
        assert_eq!(word(&prove(&first, &list(same))) == "equal", lim, "{same}");
    }
    for other in [
        "VAR lim : INT := 50; n : INT; y : BOOL;",
        "VAR CONSTANT lim : INT := 5; n : INT; y : BOOL;",
        "VAR RETAIN lim : INT := 5; n : INT; y : BOOL;",
        "VAR lim : UINT := 5; n : UINT; y : BOOL;",
        "VAR lim AT %MW5 : INT := 5; n : INT; y : BOOL;",
    ] {
        let proof = prove(&first, &list(other));
        let Proof::Undecided { reason, at, .. } = &proof else { panic!("{other}: {}", word(&proof)) };
        assert_eq!(reason.key(), "prove.declared", "{other}");
        let named = at[1].map(|span| list(other).slice(span).to_string());
        assert_eq!(named.as_deref(), Some("lim"), "{other}");
    }
    let text = |capital: &str| {
        let text = format!(
            "PROGRAM p\nVAR s : STRING; y : BOOL; END_VAR\nLD s\nEQ '{capital}'\nST y\nEND_PROGRAM\n"
        );
        Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
    };
    assert_eq!(word(&prove(&text("A"), &text("A"))), "equal");
    assert_ne!(word(&prove(&text("A"), &text("a"))), "equal");
}

#[test]
fn comments_before_a_unit_are_no_part_of_another() {
    let unit = "FUNCTION_BLOCK Lamp\nVAR_INPUT\na : BOOL;\nEND_VAR\nVAR_OUTPUT\nx : BOOL;\nEND_VAR\n";
    let list = format!("(* above *)\n\n{unit}LD a\nST x\nEND_FUNCTION_BLOCK\n");
    let list = Document::new(&list, Notation::IecIl, Target::of(Model::Iec));
    let drawn = translate(&list, None, To::Ladder, &Options::default()).text;
    assert!(drawn.starts_with("(* above *)\n\n"), "{drawn}");
    let drawn = Document::new(&drawn, Notation::Ladder, Target::of(Model::Iec));
    assert_eq!(word(&prove(&list, &drawn)), "equal");
    assert_eq!(word(&prove(&drawn, &list)), "equal");
}

#[test]
fn an_fx_program_is_compared_with_one_of_iec_61131_3() {
    let list = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLD Y0\nOUT T0 K50\nLD T0\nOUT Y1\nEND\n";
    let list = Document::new(list, Notation::FxIl, Target::of(Model::Fx2n));
    let iec = |timer: &str, contact: &str| {
        let variables =
            "X0 AT %IX0.0 : BOOL; Stop AT %IX0.1 : BOOL; Y0 AT %QX0.0 : BOOL; Y1 AT %QX0.1 : BOOL;";
        let text = format!(
            "PROGRAM p\nVAR\n{variables} T0 : TON;\nEND_VAR\nLD X0\nOR Y0\nANDN Stop\nST Y0\n\
             CAL T0(IN := Y0, PT := {timer})\n{contact} T0.Q\nST Y1\nEND_PROGRAM\n"
        );
        Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
    };
    for (timer, contact, expected) in
        [("T#5s", "LD", "equal"), ("T#5s", "LDN", "different"), ("T#6s", "LD", "undecided")]
    {
        let other = iec(timer, contact);
        assert_eq!(word(&prove(&list, &other)), expected, "{timer} {contact}");
        assert_eq!(word(&prove(&other, &list)), expected, "{timer} {contact}");
    }
}
