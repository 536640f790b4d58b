//! What applied instructions do that take many scans, or work with what is around the PLC.

use crate::simulate::{Plc, device};
use rungwise::document::{Document, Notation};
use rungwise::simulate::{ErrorKind, Outcome, Session, Value, compile};
use rungwise::target::{Fault, Flow, Form, Model, Opcode, Role, Semantics, Target, instructions};
use std::sync::Arc;

/// A PLC of a model with this program.
fn of_model(model: Model, text: &str) -> Plc {
    Plc::of(text, Notation::FxIl, model)
}

/// Scans once and says what is to be then, scan by scan, `;` between the scans. A scan that begins with `>` sets
/// devices before it, up to `:`.
#[track_caller]
fn check(text: &str, scans: &str) -> Plc {
    let mut plc = Plc::list(text);
    steps(&mut plc, scans);
    plc
}

#[track_caller]
fn steps(plc: &mut Plc, scans: &str) {
    for scan in scans.split(';') {
        let expected = match scan.trim().strip_prefix('>').and_then(|scan| scan.split_once(':')) {
            Some((settings, expected)) => {
                plc.set(settings);
                expected
            }
            None => scan,
        };
        plc.scans(1).check(expected);
    }
}

/// Scans, and finds a fault at the instruction, in the error registers, and nothing changed.
#[track_caller]
fn faults(text: &str, settings: &str, fault: Fault, code: i64, unchanged: &str) {
    let mut plc = Plc::list(text);
    plc.set(settings);
    let outcome = plc.scan();
    found(text, &outcome, fault);
    plc.check(&format!("M8067 D8067={code} {unchanged}"));
}

#[track_caller]
fn found(text: &str, outcome: &Outcome, fault: Fault) {
    let [error] = &outcome.errors[..] else { panic!("{:?}", outcome.errors) };
    assert_eq!(error.kind, ErrorKind::Fault(fault));
    let line = text.lines().find(|line| line.split(' ').count() > 2).expect("an instruction with operands");
    let span = error.place.expect("a place").span;
    assert_eq!(&text[span.start as usize..span.end as usize], line);
}

#[test]
fn every_applied_instruction_does_something() {
    for row in instructions::all().filter(|row| row.role == Role::Output && row.flow() == Flow::Straight) {
        let is_applied = matches!(row.opcode, Opcode::Function(_));
        assert!(!is_applied || !matches!(row.semantics, Semantics::Basic), "{}", row.mnemonic);
    }
    for name in ["REF", "REFF", "DI", "EI", "WDT"] {
        let row = Form::named(name).expect(name).instruction;
        assert!(!matches!(row.semantics, Semantics::Basic), "{name}");
    }
}

#[test]
fn a_bit_alternates_in_each_scan_or_at_each_press() {
    check(
        "LD X0\nALT M0\nLD X0\nALTP M1\nEND\n",
        "~M0 ~M1; >X0: M0 M1; ~M0 M1; M0 M1; >X0=0: M0; >X0: ~M0 ~M1",
    );
}

#[test]
fn search_gives_count_first_last_smallest_and_largest() {
    let table = "D100=5 D101=7 D102=5 D103=-2 D104=9 D105=9 D106=-2";
    let text = "LD X0\nSERP D100 K5 D200 K7\nEND\n";
    check(text, &format!(">X0 {table}: D200=2 D201=0 D202=2 D203=6 D204=5"));
    // 100000 is H186A0: the lower word is -31072.
    let text = "LD X0\nDSERP D100 K100000 D200 K2\nEND\n";
    check(text, ">X0 D100=1 D102=-31072 D103=1: D200=1 D201=0 D202=1 D204=1 D206=0 D208=1");
    faults("LD X0\nSER D0 K5 D200 D9\nEND\n", "X0 D9=300", Fault::Value(3), 6706, "D200=0");
    faults("LD X0\nSER D0 K5 D8510 K3\nEND\n", "X0", Fault::NoDevice(2), 6705, "D8510=0");
}

#[test]
fn cams_are_on_between_their_points_and_across_zero() {
    let text = "LD X0\nABSD D0 C0 M0 K3\nEND\n";
    let points = "D0=40 D1=140 D2=100 D3=200 D4=300 D5=20";
    check(
        text,
        &format!(
            ">X0 {points}: ~M0 ~M1 M2; >C0=20: ~M2; >C0=40: M0 ~M1; >C0=100: M0 M1; >C0=139: M0; >C0=140: ~M0 M1;
             >C0=200: ~M1; >C0=300: M2; >X0=0 C0=50: M2 ~M0"
        ),
    );
    check(
        "LD X0\nDABSD D0 C200 M0 K1\nEND\n",
        ">X0 D0=-31072 D1=1 D2=-31071 D3=1 C200=99999: ~M0; >C200=100000: M0",
    );
}

#[test]
fn a_step_switch_goes_on_when_its_counter_has_counted() {
    let text = "LD X1\nOUT C0 K9999\nLD X0\nINCD D0 C0 M0 K2\nEND\n";
    check(
        text,
        ">X0 D0=2 D1=1: M0 ~M1 C1=0; >X1: C0=1 M0; >X1=0: M0; >X1: C0=0 C1=1 ~M0 M1 ~M8029; >X1=0: M1;
         >X1: C0=0 C1=0 M0 ~M1 M8029; ~M8029; >X1=0:; >X1: C0=1; >X0=0: C0=0 C1=0 ~M0 ~M1",
    );
}

#[test]
fn a_taught_time_counts_while_the_button_is_held() {
    let text = "LD X0\nTTMR D0 K1\nLD X0\nTTMR D2 K0\nLD X0\nTTMR D4 K2\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("X0").scans(1).check("D0=0 D1=0").scans(125).check("D0=12 D1=12 D2=1 D3=12 D4=125 D5=12");
    plc.set("X0=0").scans(2).check("D0=12 D1=0 D2=1 D3=0 D4=125 D5=0");
    plc.set("X0").scans(1).check("D0=0 D1=0");
}

#[test]
fn one_timer_gives_four_functions() {
    let mut plc = Plc::list("LD X0\nSTMR T10 K2 M0\nEND\n");
    plc.scans(1).check("~M0 ~M1 ~M2 ~M3").set("X0").scans(1).check("M0 ~M1 M2 ~M3 T10=0").scans(19);
    plc.check("M2 ~M3 T10=1").scans(1).check("M0 ~M1 ~M2 M3 T10=2").scans(5).check("M0 M3");
    plc.set("X0=0")
        .scans(1)
        .check("M0 M1 ~M2 M3 T10=0")
        .scans(19)
        .check("M0 M1 M3")
        .scans(1)
        .check("~M0 ~M1 ~M2 ~M3");
    // A short press never reaches the delayed output.
    plc.set("X0").scans(2).set("X0=0").scans(1).check("M0 M1 ~M2 ~M3").scans(30).check("~M0 ~M1 ~M3 T10=0");
    faults("LD X0\nSTMR T10 D0 M0\nEND\n", "X0", Fault::Value(1), 6706, "~M0");
}

#[test]
fn a_ramp_takes_so_many_scans() {
    let text = "LD X0\nRAMP D0 D1 D2 K4\nEND\n";
    check(
        text,
        ">X0 D0=10 D1=0: D2=10 D3=0 ~M8029; D2=8 D3=1; D2=5; D2=3; D2=0 D3=4 M8029; D2=10 D3=0 ~M8029;
         >X0=0: D2=10; >X0 D1=50: D2=10; D2=20",
    );
    check(text, ">X0 M8026 D1=4: D2=0; D2=1; D2=2; D2=3; D2=4 M8029; D2=4 D3=4 M8029; >X0=0: D2=4 ~M8029");
}

#[test]
fn a_round_table_turns_the_shorter_way() {
    let text = "LD X3\nROTC D0 K10 K2 M0\nEND\n";
    let mut plc = Plc::list(text);
    // Item 4 is to come to station 1: three divisions forward, of which the last two are slow.
    plc.set("X3 D1=1 D2=4").scans(1).check("M3 ~M4 ~M5");
    for (position, expected) in [(1, "~M3 M4 ~M5"), (2, "M4"), (3, "~M4 M5")] {
        plc.set("M0").scans(1).check(expected).check(&format!("D0={position}")).set("M0=0").scans(1);
    }
    // Item 8 is four forward from here, item 0 three backward.
    plc.set("D2=8").scans(1).check("M3").set("D2=0").scans(1).check("M7 ~M5");
    plc.set("M0 M1").scans(1).check("D0=2 M7 ~M6").set("M2").scans(1).check("D0=0 M6 ~M7");
    plc.set("X3=0").scans(1).check("~M3 ~M4 ~M5 ~M6 ~M7");
    faults(text, "X3 D2=10", Fault::Value(0), 6706, "~M3");
}

#[test]
fn sorting_takes_a_scan_for_each_row() {
    let text = "LD X0\nSORT D100 K3 K2 D200 K2\nEND\n";
    let table = "D100=1 D101=2 D102=3 D103=30 D104=-10 D105=20";
    let plc = &mut check(text, &format!(">X0 {table}: ~M8029 D200=0; D200=0 ~M8029; M8029"));
    plc.check("D200=2 D201=3 D202=1 D203=-10 D204=20 D205=30 D100=1");
    steps(plc, ">D104=50: M8029 D203=-10; >X0=0: ~M8029; >X0: ~M8029;; D205=50 M8029");
    faults("LD X0\nSORT D100 K3 K2 D200 D0\nEND\n", "X0 D0=3", Fault::Value(4), 6706, "D200=0");
}

#[test]
fn switches_of_a_step_program_choose_its_mode() {
    let text = "LD M8000\nIST X0 S20 S29\nSTL S2\nLD M8041\nSET S20\nSTL S20\nLD X20\nSET S2\nRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("X0").scans(1).check("S0 M8040 ~M8041 ~M8042 M8047");
    plc.set("X0=0 X1 M8043").scans(1).check("~S0 S1 ~M8043 ~M8040").set("X5").scans(1).check("M8042 ~M8041");
    plc.scans(1).check("~M8042").set("X7").scans(1).check("M8040").set("X7=0 X5=0").scans(1).check("M8040");
    // Continuous operation goes on by itself until stop, and then ends at its initial state.
    plc.set("X1=0 X4").scans(1).check("~S1 S2 ~M8041").set("X6").scans(1).check("M8041 M8042 S20 ~S2");
    plc.set("X6=0").scans(1).check("M8041 S20").set("X7").scans(1).check("~M8041 S20 ~M8040");
    plc.set("X7=0 X20").scans(1).check("S2 ~S20").set("X20=0").scans(2).check("S2 ~S20");
    // Step by step: each press lets one transfer happen.
    plc.set("X4=0 X2").scans(1).check("M8040 S2").set("X6").scans(1).check("~M8040 M8041 S20");
    plc.set("X20").scans(1).check("M8040 S20").set("X6=0").scans(1).set("X6").scans(1).check("S2");
}

#[test]
fn changing_the_mode_away_from_home_switches_outputs_off() {
    let text = "LD M8000\nIST X0 S20 S29\nLD X10\nSET Y0\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("X0 X10").scans(1).check("Y0").set("X10=0 X0=0 X1").scans(1).check("~Y0");
    plc.set("X10").scans(1).set("X10=0 X1=0 X0 M8045").scans(1).check("Y0");
    plc.set("X0=0 X1 M8045=0 M8044").scans(1).check("Y0");
    faults("LD M8000\nIST X0 S29 S20\nEND\n", "X0", Fault::Value(1), 6706, "~S0");
}

#[test]
fn ten_keys_shift_digits_in() {
    let text = "LD X20\nTKY X0 D0 M0\nEND\n";
    let plc = &mut check(text, ">X20: D0=0 ~M10; >X1: D0=1 M1 M10; D0=1; >X1=0: ~M1 ~M10; >X2: D0=12 M2");
    // The first one counts; the second one must be pressed again.
    steps(
        plc,
        ">X3: D0=12 M2 ~M3; >X2=0: D0=12 ~M2 ~M10; >X3=0:; >X3: D0=123; >X3=0 X11:; >X11=0:; >X0: D0=2390",
    );
    plc.check("M0 M10");
    steps(plc, ">X20=0: D0=2390 ~M0 ~M10");
    let plc = &mut check("LD X20\nDTKY X0 D0 M0\nEND\n", ">X20 D0=1 D1=0:");
    for _ in 0..5 {
        steps(plc, ">X1: M1; >X1=0: ~M1");
    }
    // 111111 is 1 × 65536 + 45575, which is -19961 in a word.
    plc.check("D0=-19961 D1=1");
}

#[test]
fn sixteen_keys_are_scanned_by_rows() {
    let text = "LD X20\nHKY X0 Y0 D0 M0\nEND\n";
    let mut plc = Plc::list(text);
    let press =
        |plc: &mut Plc, key: u32, on: bool| plc.machine.outside_mut()[0].set_contact(key / 4, key % 4, on);
    plc.set("X20").scans(1).check("Y0 ~Y1").scans(2).check("~Y0 Y1 ~M8029").scans(5).check("M8029 Y3");
    press(&mut plc, 6, true);
    plc.scans(7).check("D0=0 ~M8029").scans(1).check("D0=6 M7 ~M6 M8029").scans(16).check("D0=6");
    press(&mut plc, 6, false);
    plc.scans(8).check("~M7");
    press(&mut plc, 9, true);
    plc.scans(8).check("D0=69");
    press(&mut plc, 9, false);
    press(&mut plc, 13, true);
    plc.scans(8).check("D0=69 M3 M6 ~M7 ~M0");
    press(&mut plc, 13, false);
    plc.scans(8).check("M3 ~M6").set("X20=0").scans(1).check("~Y3 ~M3 D0=69 ~M8029");
    plc.set("X20 M8167 D0=291");
    press(&mut plc, 11, true);
    // H0123 and B.
    plc.scans(8).check("D0=4667 M7 ~M6");
}

#[test]
fn digital_switches_are_read_digit_by_digit() {
    let text = "LD X20\nDSW X0 Y0 D0 K2\nEND\n";
    let mut plc = Plc::list(text);
    let turn = |plc: &mut Plc, set: u32, digit: u32, value: u32| {
        for bit in 0..4 {
            plc.machine.outside_mut()[0].set_contact(digit, 4 * set + bit, value >> bit & 1 == 1);
        }
    };
    for (digit, (first, second)) in (0..).zip([(4, 9), (3, 0), (2, 0), (1, 7)]) {
        turn(&mut plc, 0, digit, first);
        turn(&mut plc, 1, digit, second);
    }
    plc.set("X20")
        .scans(7)
        .check("D0=0 ~M8029")
        .scans(1)
        .check("D0=1234 D1=7009 M8029")
        .scans(1)
        .check("~M8029");
    turn(&mut plc, 0, 2, 12);
    plc.scans(6);
    found(text, &plc.scan(), Fault::Value(0));
    plc.check("D0=1234").set("X20=0").scans(1).check("~Y0 ~Y1 ~Y2 ~Y3");
}

#[test]
fn segments_of_a_digit() {
    let text = "LD X0\nSEGD D0 D1\nLD X0\nSEGD D0 K2Y0\nEND\n";
    let mut plc = Plc::list(text);
    let segments = [63, 6, 91, 79, 102, 109, 125, 39, 127, 111, 119, 124, 57, 94, 121, 113];
    for (digit, pattern) in segments.into_iter().enumerate() {
        plc.set(&format!("X0 D0={} D1=256", digit + 16)).scans(1).check(&format!("D1={}", 256 + pattern));
        assert_eq!(plc.on("Y6"), pattern & 64 != 0, "{digit}");
        plc.check("~Y7");
    }
}

#[test]
fn a_display_gets_digit_after_digit_with_a_strobe() {
    let text = "LD X0\nSEGL D0 Y0 K0\nEND\n";
    let plc = &mut check(
        text,
        ">X0 D0=1234: ~Y0 ~Y1 Y2 ~Y3 ~Y4; Y2 Y4; Y2 ~Y4; Y0 Y1 ~Y2 ~Y5; Y5; ~Y5; ~Y0 Y1; Y6; ~Y6; Y0 ~Y1; Y7 ~M8029; ~Y7 M8029",
    );
    steps(plc, "Y2 ~M8029; Y4; >X0=0: ~Y2 ~Y4");
    // Data and strobes turned round, two sets: 8 is on data lines without the first three, in the second set.
    let two = "LD X0\nSEGL D0 Y0 K7\nEND\n";
    check(two, ">X0 D0=1 D1=8: ~Y0 Y1 Y2 Y3 Y4 Y10 Y11 Y12 ~Y13; ~Y4 Y5; Y4");
    faults(text, "X0 D0=10000", Fault::Value(0), 6706, "~Y0");
}

#[test]
fn arrow_keys_set_a_number() {
    let text = "LD X20\nARWS X0 D0 Y0 K0\nEND\n";
    let plc = &mut check(
        text,
        ">X20 D0=1234: Y7 Y0 ~Y1; >X1: D0=2234 Y1 ~Y0; D0=2234; >X1=0:; >X2: Y6 ~Y7; >X2=0:",
    );
    steps(
        plc,
        ">X0: D0=2134; >X0=0:; >X0: D0=2034; >X0=0:; >X0: D0=2934; >X0=0 X3: Y7; >X3=0:; >X3: Y4 ~Y7 Y2",
    );
    steps(plc, ">X20=0: ~Y4 ~Y2 D0=2934");
    faults(text, "X20 D0=-1", Fault::Value(1), 6706, "~Y7");
}

#[test]
fn text_becomes_codes() {
    let text = "LD X0\nASC \"MOTOR12\" D100\nEND\n";
    check(text, ">X0: D100=20301 D101=20308 D102=12626 D103=8242");
    check(text, ">X0 M8161: D100=77 D101=79 D104=82 D105=49 D106=50 D107=32");
}

#[test]
fn text_is_printed_with_a_strobe() {
    let text = "LD X0\nPR D0 Y0\nEND\n";
    let plc = &mut check(text, ">X0 D0=16706: ~Y0 Y1 Y6 ~Y10 Y11; Y10 Y1; ~Y10 Y1; Y0 ~Y1 Y6; Y0 Y10");
    plc.scans(19).check("Y11 ~M8029").scans(1).check("~Y11 ~Y10 M8029").set("X0=0").scans(1).check("~M8029");
    // Up to a zero byte: two characters take six scans.
    let plc = &mut check(text, ">X0 M8027 D0=16706: Y11");
    plc.scans(5).check("Y11").scans(1).check("~Y11 M8029");
}

#[test]
fn special_modules_have_buffer_memories() {
    let text = "LD X0\nFROM K1 K5 D0 K2\nLD X1\nTO K0 K3 D10 K2\nLD X2\nDTO K0 K10 K100000 K2\nLD X3\n\
                DFROM K0 K10 D20 K1\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("X0 D0=7").scans(1).check("D0=0");
    assert!(plc.machine.outside_mut()[0].set_buffer(1, 6, -5));
    plc.scans(1).check("D0=0 D1=-5").set("X0=0 X1 D10=11 D11=12").scans(1);
    let buffer = |plc: &Plc, number| plc.machine.outside()[0].buffer(0, number);
    assert_eq!((buffer(&plc, 3), buffer(&plc, 4), buffer(&plc, 5)), (Some(11), Some(12), Some(0)));
    plc.set("X2 X3").scans(1).check("D20=-31072 D21=1 D22=0");
    assert_eq!((buffer(&plc, 12), buffer(&plc, 13), buffer(&plc, 14)), (Some(-31072), Some(1), Some(0)));
    plc.machine.outside_mut()[0].set_module(1, false);
    plc.set("X0 X2=0 X3=0 D0=7");
    found(text, &plc.scan(), Fault::NoModule);
    plc.check("D0=7 M8067 D8067=6708");
    faults("LD X0\nFROM D0 K5 D1 K2\nEND\n", "X0 D0=8 D1=5", Fault::Value(0), 6706, "D1=5");
}

#[test]
fn frames_are_sent_and_received() {
    let text = "LD X0\nRS D0 K3 D10 K4\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("X0 D0=16961 D1=67 D12=-1").scans(1).check("~M8123").set("M8122").scans(1).check("~M8122");
    assert_eq!(plc.machine.outside()[0].serial.sent, [b"ABC".to_vec()]);
    plc.machine.outside_mut()[0].serial.waiting.extend([b"xyz".to_vec(), b"123456".to_vec()]);
    plc.scans(1).check("M8123 D8123=3 D10=31096 D11=122").scans(2).check("D10=31096");
    plc.set("M8123=0 M8161").scans(1).check("M8123 D8123=4 D10=49 D13=52 D14=0");
    assert!(plc.machine.outside()[0].serial.waiting.is_empty());
    plc.set("X0=0 M8122").scans(1).check("M8122");
}

#[test]
fn bits_are_copied_between_octal_and_decimal_numbers() {
    let text = "LD M8000\nPRUN K4X0 K4M0\nPRUN K4M0 K4Y0\nEND\n";
    check(text, ">X7 X10 M8 M19: M7 M8 ~M9 M10 ~M17 M19 Y7 Y10 ~Y11");
}

#[test]
fn characters_and_hexadecimal_digits() {
    let text = "LD X0\nASCI D0 D10 K3\nLD X0\nHEX D20 D30 K5\nLD X0\nCCD D20 D40 K5\nEND\n";
    // 2AB of 12AB; 1F03A from "1F03A".
    let codes = "D20=17969 D21=13104 D22=65";
    let plc = &mut check(text, &format!(">X0 D0=4779 D11=256 {codes}: D10=16690 D11=322 D30=-4038 D31=1"));
    // 31h + 46h + 30h + 33h + 41h = 11Bh; the exclusive or of them is 35h.
    plc.check("D40=283 D41=53");
    check(text, ">X0 M8161 D0=4779 D20=49 D21=48 D22=48 D23=48 D24=70: D10=50 D11=65 D12=66 D30=15 D31=1");
    faults("LD X0\nHEX D0 D10 K2\nEND\n", "X0 D0=24881 D10=9", Fault::Value(0), 6706, "D10=9");
    faults("LD X0\nCCD D0 D10 D2\nEND\n", "X0 D10=9", Fault::Value(2), 6706, "D10=9");
}

#[test]
fn trimmers_are_numbers_and_switches() {
    let mut plc = Plc::list("LD M8000\nVRRD K1 D0\nVRSC K1 D1\nEND\n");
    for (position, switch) in [(0, 0), (12, 0), (13, 1), (127, 5), (242, 9), (243, 10), (255, 10)] {
        plc.machine.outside_mut()[0].trimmers[1] = position;
        plc.scans(1).check(&format!("D0={position} D1={switch}"));
    }
    faults("LD X0\nVRRD D5 D0\nEND\n", "X0 D5=8 D0=3", Fault::Value(0), 6706, "D0=3");
}

#[test]
fn inputs_and_outputs_are_refreshed_in_the_middle_of_a_scan() {
    let text = "LD M8000\nOUT Y0\nLD X3\nOUT M1\nLD X20\nREF Y0 K8\nLD X20\nREF X0 K8\nLD X3\nOUT M0\nEND\n";
    let mut plc = Plc::list(text);
    plc.machine.outside_mut()[0].set_contact(0, 3, true);
    plc.set("X20").scans(1).check("~M1 M0");
    let mut plc = Plc::list(text);
    plc.machine.outside_mut()[0].set_contact(0, 3, true);
    plc.scans(1).check("~M1 ~M0").scans(1).check("M1 M0");
    let text = "LD M8000\nOUT Y0\nLD X20\nREF Y0 K8\nLD X20\nREFF K10\nLD X3\nOUT M0\nEND\n";
    let mut plc = Plc::list(text);
    plc.machine.outside_mut()[0].set_contact(0, 3, true);
    plc.set("X20").scans(1).check("M0");
    faults("LD X0\nREF Y0 K12\nEND\n", "X0", Fault::Value(1), 6706, "");
    faults("LD X0\nREF Y4 K8\nEND\n", "X0", Fault::Value(0), 6706, "");
}

#[test]
fn a_matrix_is_read_row_by_row() {
    let mut plc = Plc::list("LD X0\nMTR X10 Y10 M0 K2\nEND\n");
    plc.machine.outside_mut()[0].set_contact(8, 11, true);
    plc.machine.outside_mut()[0].set_contact(9, 9, true);
    steps(
        &mut plc,
        ">X0: Y10 ~Y11 ~M3; M3 ~M1; ~Y10 Y11 ~M11 ~M8029; M11 ~M13 M3 M8029; Y10 ~M8029; >X0=0: ~Y10 M3",
    );
}

#[test]
fn high_speed_counters_count_pulses_while_their_coil_is_driven() {
    let text = "LD X11\nRST C235\nLD X10\nOUT C235 K5\nLD M8000\nDHSCS K3 C235 Y0\nDHSCR K4 C235 M0\n\
                LD C235\nOUT Y1\nLD X12\nOUT M8235\nLD X13\nRST Y0\nEND\n";
    let mut plc = Plc::list(text);
    let pulse = |plc: &mut Plc, name: &str, count: i32| plc.machine.pulse(device(name), count);
    pulse(&mut plc, "C235", 9);
    plc.set("M0").scans(1).check("C235=0");
    plc.set("X10").scans(1);
    pulse(&mut plc, "C235", 2);
    plc.scans(1).check("C235=2 ~Y0").set("X0").scans(1).check("C235=3 Y0 M0 ~C235");
    plc.set("X0=0 X13").scans(1).check("~Y0").set("X13=0 C235=0").scans(1).check("~Y0");
    pulse(&mut plc, "X0", 5);
    plc.scans(1).check("C235=5 C235 Y1 Y0 ~M0").set("X12").scans(1);
    pulse(&mut plc, "X0", 1);
    plc.scans(1).check("C235=4 ~C235 ~Y1");
    plc.set("X12=0 X11").scans(1).check("C235=0");
    pulse(&mut plc, "X0", 3);
    plc.scans(1).check("C235=0").set("X11=0 X10=0").scans(1);
    pulse(&mut plc, "X0", 3);
    plc.scans(1).check("C235=0").set("C235=2147483647 X10").scans(1);
    pulse(&mut plc, "C235", 1);
    plc.scans(1).check("C235=-2147483648");
    let wrong = "LD X0\nDHSCS K3 C234 Y0\nEND\n";
    faults(wrong, "X0", Fault::Value(1), 6706, "~Y0");
}

#[test]
fn a_high_speed_counter_can_reset_itself_and_ask_for_an_interrupt() {
    let text = "LD M8000\nOUT C240 K9\nDHSCR K3 C240 C240\nDHSCS K2 C240 I010\nEI\nFEND\n\
                I010\nLD M8000\nALT M0\nIRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(1);
    plc.machine.pulse(device("C240"), 1);
    plc.scans(1).check("C240=1 ~M0");
    plc.machine.pulse(device("C240"), 6);
    plc.scans(1).check("C240=1 M0").scans(1).check("M0");
    plc.machine.pulse(device("C240"), 1);
    plc.set("M8059").scans(1).check("C240=2 M0").set("M8059=0").scans(1).check("M0");
}

#[test]
fn a_count_that_was_written_beyond_its_preset_comes_back_to_it() {
    let mut plc = Plc::list("LD X0\nOUT C0 D0\nLD X1\nOUT C200 K5\nEND\n");
    plc.set("D0=5 C0=9 C200=9").scans(1).check("C0=9 ~C0 C200=9 ~C200");
    // One with 32 bits is a ring and goes on.
    plc.set("X0 X1").scans(1).check("C0=5 C0 C200=10 ~C200");
    plc.set("X0=0").scans(1).set("X0").scans(1).check("C0=5 C0");
    let mut plc = Plc::list("LD X0\nOUT C0 D0\nEND\n");
    // The preset that falls below the count.
    plc.set("D0=5 C0=3").scans(1).set("D0=2").scans(2).check("C0=3 ~C0").set("X0").scans(1).check("C0=2 C0");
}

#[test]
fn zones_are_compared_when_pulses_come() {
    let text = "LD M8000\nOUT C235 K9999\nDHSZ K10 K20 C235 M10\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(2).check("~M10 ~M11 ~M12");
    for (pulses, expected) in
        [(5, "M10 ~M11 ~M12"), (5, "~M10 M11 ~M12"), (10, "~M10 M11 ~M12"), (1, "~M10 ~M11 M12")]
    {
        plc.machine.pulse(device("X0"), pulses);
        plc.scans(1).check(expected);
    }
    faults("LD X0\nDHSZ K20 K10 C235 M10\nEND\n", "X0", Fault::Value(0), 6706, "~M10");
    faults("LD X0\nDHSZ K10 K20 C235 M8130\nEND\n", "X0", Fault::TableMode, 6706, "");
    faults("LD X0\nDHSZ K10 K20 C235 M8132\nEND\n", "X0", Fault::TableMode, 6706, "");
}

#[test]
fn inputs_of_high_speed_counters_count_start_and_reset() {
    let text = "LD M8000\nOUT C246 K9\nOUT C241 K9\nOUT C244 K9\nOUT C251 K9\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(1);
    plc.machine.pulse(device("X0"), 5);
    plc.machine.pulse(device("X1"), 2);
    plc.machine.pulse(device("C251"), -3);
    plc.scans(1).check("C246=3 ~M8246 C241=5 C244=0 C251=-3 M8251");
    plc.set("X6").machine.pulse(device("X0"), 4);
    plc.scans(1).check("C246=7 C241=9 C244=4").set("X1").scans(1).check("C246=6 M8246 C241=0 C244=0");
}

#[test]
fn two_phases_count_up_where_the_first_one_leads() {
    let text = "LD M8000\nOUT C251 K2\nOUT C253 K9\nOUT C254 K9\nLD X20\nOUT M8198\nLD C251\nOUT Y0\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(1);
    let turns =
        |plc: &mut Plc, settings: &[&str]| settings.iter().for_each(|phase| _ = plc.set(phase).scans(1));
    let up = ["X0 X3", "X1 X4", "X0=0 X3=0", "X1=0 X4=0"];
    turns(&mut plc, &up[..1]);
    plc.check("C251=0");
    turns(&mut plc, &up[1..2]);
    plc.check("C251=1 C253=1 C254=0 ~M8251 ~Y0");
    turns(&mut plc, &up[2..]);
    plc.check("C251=1");
    // C254 counts while X6 is on.
    plc.set("X6");
    turns(&mut plc, &up);
    plc.check("C251=2 C254=1 Y0");
    let down = ["X1", "X0", "X1=0", "X0=0"];
    turns(&mut plc, &down);
    plc.check("C251=1 C254=0 C253=2 M8251 ~Y0");
    plc.set("X20").scans(1);
    turns(&mut plc, &up);
    plc.check("C251=5 C254=4 C253=3");
    turns(&mut plc, &down);
    plc.check("C251=1 C254=0 C253=3");
    // Nobody knows which was first.
    plc.set("X0 X1").scans(1).set("X0=0 X1=0").scans(1).check("C251=1");
    // Held at 0 while its reset input is on.
    plc.set("X5").scans(1).check("C253=0");
}

#[test]
fn speed_is_pulses_in_a_window() {
    let text = "LD X10\nSPD X0 K20 D0\nEND\n";
    let mut plc = Plc::list(text);
    plc.machine.pulse(device("X0"), 9);
    plc.set("X10").scans(1).check("D0=0 D1=0 D2=20");
    plc.machine.pulse(device("X0"), 7);
    plc.scans(1).check("D0=0 D1=7 D2=10");
    plc.machine.pulse(device("X0"), 5);
    plc.scans(1).check("D0=12 D1=0 D2=20").scans(1).check("D0=12").scans(1).check("D0=0");
    faults("LD X10\nSPD X10 K20 D0\nEND\n", "X10 D0=4", Fault::Value(0), 6706, "D0=4");
}

#[test]
fn an_output_gives_so_many_pulses() {
    let text = "LD X0\nPLSY D0 K25 Y0\nEND\n";
    let plc = &mut check(text, ">X0 D0=1000: Y0 M8340 D8140=0; D8140=10 D8136=10 ~M8029; D8140=20 Y0");
    steps(
        plc,
        "D8140=25 M8029 ~Y0 ~M8340 D8340=0; D8140=25 M8029; >X0=0: ~M8029; >X0: Y0 D8140=25; D8140=35",
    );
    // A new frequency counts from the scan that brings it; off stops at once.
    steps(plc, ">D0=200: D8140=45; D8140=47; >X0=0: D8140=47 ~Y0 ~M8029");
    assert_eq!(
        (plc.machine.outside()[0].axes[0].pulses, plc.machine.outside()[0].axes[0].position),
        (47, 47)
    );
    let mut small = plc_of_two_outputs();
    steps(
        &mut small,
        ">X0: M8148 Y1; D8142=300 D8136=300 D8140=0; >M8146: D8142=300 ~M8148 ~Y1; >M8146=0: D8142=300",
    );
    steps(&mut small, ">X0=0:; >X0: Y1; D8142=600 ~M8029");
    faults("LD X0\nPLSY K10 K-1 Y0\nEND\n", "X0", Fault::Value(1), 6706, "~Y0");
    faults("LD X0\nPLSY K10 K1 Y4\nEND\n", "X0", Fault::Value(2), 6706, "~Y4");
}

fn plc_of_two_outputs() -> Plc {
    of_model(Model::Fx1n, "LD X0\nPLSY K30000 K0 Y1\nEND\n")
}

#[test]
fn pulses_with_ramps() {
    // 1,000 Hz are reached in 10 ms, after 5 pulses; so it slows down 5 pulses before the end.
    let text = "LD X0\nPLSR K1000 K30 K10 Y0\nEND\n";
    let plc = &mut check(text, ">X0: Y0; D8140=5; D8140=15; D8140=25 ~M8029 Y0; D8140=30 M8029 ~Y0");
    steps(plc, ">X0=0: ~M8029; >X0:; D8140=35; >X0=0: D8140=35 ~Y0");
    faults("LD X0\nPLSR K0 K30 K10 Y0\nEND\n", "X0", Fault::Value(0), 6706, "~Y0");
    faults("LD X0\nPLSR K10 K30 D0 Y0\nEND\n", "X0 D0=5001", Fault::Value(2), 6706, "~Y0");
}

#[test]
fn a_pulse_width_follows_time() {
    let text = "LD X0\nPWM K20 K40 Y0\nEND\n";
    check(text, ">X0: Y0; Y0; ~Y0; ~Y0; Y0; >X0=0: ~Y0; >X0: Y0");
    faults("LD X0\nPWM K41 K40 Y0\nEND\n", "X0", Fault::Value(0), 6706, "~Y0");
}

#[test]
fn a_drive_moves_with_ramps_and_brakes_without_power() {
    // 100,000 Hz within 100 ms: 10,000 Hz after 10 ms and 50 pulses.
    let text = "LD X0\nDDRVI K-300 K10000 Y0 Y4\nLD X1\nDDRVA K-250 K10000 Y0 Y4\nEND\n";
    let plc =
        &mut check(text, ">X0: ~Y4 Y0 M8340 D8340=0; D8340=-50 D8341=-1; D8340=-150; D8340=-250 ~M8029");
    steps(plc, "D8340=-300 M8029 ~M8340 ~Y0; >X0=0: ~M8029; >X1: Y4 M8340");
    plc.scans(20).check("D8340=-250 M8029").set("X1=0").scans(1);
    assert_eq!(plc.machine.outside()[0].axes[0].position, -250);
    steps(plc, ">X0:; D8340=-300; >X0=0: D8340=-350 ~M8029 ~M8340; D8340=-350");
    faults("LD X0\nDRVI K100 K0 Y0 Y4\nEND\n", "X0", Fault::Value(1), 6706, "~Y0");
    // The small models keep the position where others count pulses.
    let mut small = of_model(Model::Fx1n, "LD X0\nDRVI K-300 K10000 Y0 Y4\nEND\n");
    steps(&mut small, ">X0 D8148=200: M8147; D8140=-25 D8141=-1; >M8145: D8140=-25 ~M8147 ~M8029");
}

#[test]
fn a_drive_with_variable_speed_turns_with_the_sign() {
    let text = "LD X0\nPLSV D0 Y0 Y4\nEND\n";
    let plc = &mut check(
        text,
        ">X0 D0=1000: Y4 Y0; D8340=10; >D0=-500: D8340=20 ~Y4; D8340=15; >D0=0: D8340=10 ~Y0",
    );
    steps(plc, "D8340=10; >D0=100: Y0 Y4; D8340=11; >X0=0: ~Y0 ~Y4 ~M8340 D8340=11");
}

#[test]
fn a_return_to_zero_creeps_to_the_end_of_its_switch() {
    let text = "LD X0\nDZRN K1000 K100 X4 Y0\nEND\n";
    let plc = &mut check(text, ">X0: Y0; D8340=-9; >X4: D8340=-19; D8340=-20; D8340=-21 ~M8029");
    steps(plc, ">X4=0: D8340=0 M8029 ~Y0 ~M8340; D8340=0 M8029; >X0=0: ~M8029");
    assert_eq!(plc.machine.outside()[0].axes[0].position, 0);
    faults("LD X0\nZRN K100 K200 X4 Y0\nEND\n", "X0", Fault::Value(1), 6706, "~Y0");
}

#[test]
fn a_servo_amplifier_tells_its_position() {
    let mut plc = Plc::list("LD X0\nDABS X4 Y4 D0\nEND\n");
    plc.machine.outside_mut()[0].absolute = -100_000;
    plc.set("X0").scans(1).check("Y4 Y5 Y6").scans(17).check("D0=0 Y5 ~M8029");
    // -100000 is HFFFE7960.
    plc.scans(1).check("D0=31072 D1=-2 M8029 Y4 ~Y5 ~Y6").set("X0=0").scans(1).check("~Y4 ~M8029");
}

/// A controller of D0 (wanted) and D1 (measured) with output D2 and parameters from D10 on, every 100 ms.
const PID: &str = "LD X0\nPID D0 D1 D10 D2\nEND\n";

/// Sets parameters and values, then checks the output after each sampling time.
#[track_caller]
fn controls(settings: &str, samples: &[(&str, &str)]) {
    let mut plc = Plc::list(PID);
    plc.set("X0 D10=100").set(settings);
    for (number, (settings, expected)) in samples.iter().enumerate() {
        plc.set(settings);
        plc.scans(if number == 0 { 1 } else { 10 }).check(expected).check("~M8067");
    }
}

#[test]
fn a_controller_has_a_proportional_part() {
    // Reverse: 1.5 × 100, then 1.5 × 20 less; forward the other way round.
    controls("D11=1 D13=150", &[("D0=500 D1=400", "D2=150"), ("", "D2=150"), ("D1=420", "D2=120")]);
    controls("D11=0 D13=150", &[("D0=500 D1=400", "D2=-150"), ("D1=420", "D2=-120")]);
    // Nothing happens between the sampling times, and what a program writes is where it goes on from.
    let mut plc = Plc::list(PID);
    plc.set("X0 D10=100 D11=1 D13=100 D0=50").scans(1).check("D2=50").set("D1=20").scans(9).check("D2=50");
    plc.scans(1).check("D2=30").set("D2=1000 D1=10").scans(10).check("D2=1010").set("X0=0 D1=0").scans(20);
    plc.check("D2=1010");
}

#[test]
fn a_controller_has_an_integral_part() {
    // 100 and a tenth of it in each tenth of the integral time of 1 s.
    controls(
        "D11=1 D13=100 D14=10",
        &[("D0=100", "D2=110"), ("", "D2=120"), ("", "D2=130"), ("D1=100", "D2=30")],
    );
    // Parts of 1 add up: 1.1, then 0.1 each.
    let mut plc = Plc::list(PID);
    plc.set("X0 D10=100 D11=1 D13=100 D14=10 D0=1").scans(1).check("D2=1").scans(50).check("D2=2");
}

#[test]
fn a_controller_has_a_derivative_part_of_the_measured_value() {
    // 1 s / 0.1 s × 10 against the change, and 10 of proportional part.
    let samples = [("", "D2=0"), ("D1=10", "D2=-110"), ("", "D2=-10"), ("", "D2=-10")];
    controls("D11=1 D13=100 D16=100", &samples);
    // Half of the derivative time as its filter: -10 - 10 / 0.6, then + (10 - 0.5 × 16.67) / 0.6.
    let samples = [("", "D2=0"), ("D1=10", "D2=-27"), ("", "D2=-24")];
    controls("D11=1 D13=100 D15=50 D16=100", &samples);
    // The filter of the measured value: half of the way in each sampling time.
    controls("D11=1 D12=50 D13=100", &[("", "D2=0"), ("D1=100", "D2=-50"), ("", "D2=-75")]);
}

#[test]
fn a_controller_is_tuned_by_the_response_to_a_step() {
    // After a dead time of 2 s the measured value goes by 20 in each second while the output is 1000.
    let run = |measured: &dyn Fn(i64) -> i64| {
        let mut plc = Plc::list(PID);
        plc.set("X0 D0=600 D1=300 D2=1000 D10=1000 D11=16").scans(1);
        for second in 1..=7 {
            plc.set(&format!("D1={}", 300 + measured(second)))
                .scans(100)
                .check("D11=16 D13=0 D2=1000 ~M8067");
        }
        plc
    };
    let mut plc = run(&|second| 20 * (second - 2).max(0) - i64::from(second == 7));
    // 100 of 300 are gone: 1.2 × 1000 / (20 × 2 s), twice and half the dead time. What it drives up it controls in reverse.
    plc.set("D1=401").scans(100).check("D11=1 D13=3000 D14=40 D16=100 D2=1000 ~M8067");
    // From then on it controls.
    plc.set("D0=401 D1=401").scans(100).check("D11=1 D2=1000");
    // Driven down by the output, as by cooling.
    let mut plc = Plc::list(PID);
    plc.set("X0 D0=100 D1=500 D2=500 D10=1000 D11=16").scans(1);
    plc.set("D1=500").scans(100).set("D1=350").scans(100).check("D11=0 D13=400 D14=20 D16=50");
    // Too near at the start.
    faults(PID, "X0 D0=149 D1=0 D2=500 D10=1000 D11=16", Fault::Pid(6750), 6750, "D11=16");
}

#[test]
fn a_controller_has_limits_and_alarms() {
    controls(
        "D11=33 D13=100 D32=100 D33=-20",
        &[("D0=150", "D2=100"), ("D0=-150", "D2=-20"), ("D0=-140", "D2=-10")],
    );
    let input = [("D1=0", "D34=0"), ("D1=10", "D34=1"), ("D1=0", "D34=2"), ("D1=5", "D34=0")];
    controls("D11=3 D13=100 D30=5 D31=5", &input);
    controls("D11=5 D13=100 D32=50 D33=50", &[("D0=100", "D34=4"), ("D0=0", "D34=8"), ("D0=50", "D34=0")]);
}

#[test]
fn parameters_of_a_controller_have_their_own_error_codes() {
    let fine = "X0 D10=100 D11=1 D13=100 D0=5";
    for (setting, code) in
        [("D10=0", 6730), ("D12=100", 6732), ("D13=-1", 6733), ("D14=-1", 6734), ("D15=201", 6735)]
    {
        faults(PID, &format!("{fine} {setting}"), Fault::Pid(code), i64::from(code), "D2=0");
    }
    faults(PID, &format!("{fine} D16=-1"), Fault::Pid(6736), 6736, "D2=0");
    faults(PID, &format!("{fine} D11=81"), Fault::LimitCycle, 6706, "D2=0");
    faults(PID, &format!("{fine} D11=37"), Fault::Value(2), 6706, "D2=0");
    // With a sampling time below the scan it goes on, in each scan.
    let mut plc = Plc::list(PID);
    plc.set(fine)
        .set("D10=5")
        .scans(1)
        .check("D2=5 ~M8067")
        .set("D0=9")
        .scans(1)
        .check("D2=9 M8067 D8067=6740");
}

#[test]
fn interrupts_of_inputs_come_with_their_edges() {
    let text = "LD M5\nOUT M6\nEI\nLD M5\nOUT M7\nFEND\nI001\nLD M8000\nSET M5\nRAMP D0 D0 D2 K100\nIRET\n\
                I100\nLD M8000\nRAMP D0 D0 D12 K100\nIRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("D0=10 X1").scans(2).check("~M7 D2=0 D12=0").set("X0").scans(1).check("~M6 M7 D2=10 D3=0");
    plc.scans(2)
        .check("D3=0 M6")
        .set("X0=0 X1=0")
        .scans(1)
        .check("D3=0 D12=10 D13=0")
        .set("X0")
        .scans(1)
        .check("D3=1");
    plc.set("X0=0 M8050").scans(1).set("X0").scans(1).check("D3=1").set("M8050=0").scans(1).check("D3=1");
}

#[test]
fn an_interrupt_waits_until_it_is_allowed() {
    let text = "LDI X10\nCJ P1\nEI\nDI\nP1\nFEND\nI001\nLD M8000\nSET M0\nIRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(1).set("X0").scans(3).check("~M0").set("X10").scans(1).check("M0");
    // The lower number first; inside of a routine only where EI stands.
    let text = "EI\nFEND\nI001\nLD M1\nOUT M2\nEI\nLD M1\nOUT M3\nIRET\nI101\nLD M8000\nSET M1\nLD M2\nOUT M4\nIRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(1).set("X0 X1").scans(1).check("M1 ~M2 M3 ~M4");
}

#[test]
fn timer_interrupts_come_as_often_as_time_has_passed() {
    let text = "EI\nFEND\nI610\nLD M8000\nRAMP D0 D0 D2 K1000\nIRET\nI725\nLD M8000\nRAMP D0 D0 D12 K1000\nIRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.scan_ms = 35;
    plc.set("D0=10").scans(1).check("D2=0").scans(1).check("D2=10 D3=2 D13=0").scans(1).check("D3=6 D13=1");
    // A leap of time is bounded.
    plc.scan_ms = 60_000;
    plc.scans(1).scans(1).check("D3=109 D13=103");
    plc.scan_ms = 10;
    plc.scans(1).set("M8056").scans(5);
    let counted = plc.word("D3");
    plc.scans(5).check(&format!("D3={counted}"));
}

#[test]
fn the_watchdog_can_be_restarted_but_not_for_ever() {
    let long = "FOR K2000\nFOR K500\nLD M8000\nALT M0\nNEXT\nNEXT\nEND\n";
    let mut plc = Plc::list(long);
    assert_eq!(plc.scan().errors.len(), 1);
    let mut plc = Plc::list(&long.replace("NEXT\nNEXT", "NEXT\nLD M8000\nWDT\nNEXT"));
    plc.scans(1);
    let mut plc = Plc::list("P0\nLD M8000\nWDT\nCJ P0\nEND\n");
    assert_eq!(plc.scan().errors.len(), 1);
}

#[test]
fn a_copy_of_the_plc_goes_the_same_way() {
    let text = "LD M8000\nOUT C235 K5\nDHSCS K30 C235 Y7\nHKY X10 Y10 D0 M0\nPLSY K333 K0 Y0\nDDRVI K9999 K7000 Y1 Y4\nEND\n";
    let mut plc = Plc::list(text);
    plc.machine.outside_mut()[0].set_contact(9, 9, true);
    plc.scans(7);
    plc.machine.pulse(device("C235"), 20);
    let mut copy = plc.machine.clone();
    for scan in 7..40 {
        plc.scans(1);
        copy.scan(scan * 10_000_000);
    }
    assert_eq!(plc.machine.memory().words(), copy.memory().words());
    assert_eq!(plc.machine.outside(), copy.outside());
    plc.check("C235=20 D0=5");
}

#[test]
fn what_happens_around_the_plc_belongs_to_its_history() {
    let text = "LD M8000\nOUT C235 K5\nFROM K2 K7 D0 K1\nRS D20 K0 D10 K8\nVRRD K0 D1\nLD X1\nDABS X4 Y4 D2\n\
                LD M8000\nOUT Y0\nLD X3\nOUT Y1\nEND\n";
    let document = Document::new(text, Notation::FxIl, Target::of(Model::Fx3u));
    let code = Arc::new(compile(&[&document], false).expect("a program"));
    let mut session = Session::new(Arc::clone(&code));
    let happens = |name: &str, value: &str| {
        let variable = code.variable(name).unwrap_or_else(|| panic!("{name}"));
        let value = Value::read(value).unwrap_or_else(|| panic!("{value}"));
        variable.set(&code, &value).unwrap_or_else(|| panic!("{name} = {value}"))
    };
    let around = [
        happens("x0.pulses", "4"),
        happens("U2\\G7", "-3"),
        happens("RS.received", "ok"),
        happens("VR0", "77"),
        happens("ABS", "5"),
        happens("Y0.X3", "on"),
        happens("X1", "1"),
    ];
    for scan in 1..60 {
        if scan == 3 {
            around.iter().cloned().for_each(|touch| session.touch(touch));
        }
        if scan == 50 {
            session.touch(happens("U2", "0"));
        }
        session.scan(scan * 10_000_000);
    }
    let machine = session.machine();
    let words = ["C235", "D0", "D10", "D1", "D2"].map(|name| machine.word(device(name), 0));
    assert_eq!(words, [4, -3, 0x6B6F, 77, 5]);
    assert!(machine.bit(device("Y1")) != 0 && machine.word(device("D8067"), 0) == 6708);
    let again = session.at(59).expect("a scan");
    assert_eq!(again.memory().words(), session.machine().memory().words());
    assert_eq!(again.outside(), session.machine().outside());
    let before = session.at(2).expect("a scan");
    assert_eq!((before.word(device("C235"), 0), before.word(device("D8067"), 0)), (0, 0));
}
