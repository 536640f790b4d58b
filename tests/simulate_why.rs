//! Why a device is on or off.

use crate::binary::{folder, run};
use crate::simulate::switch;
use rungwise::document::{Document, Notation};
use rungwise::simulate::{Condition, Drivers, Inquiry, Session, Value as Held, compile};
use rungwise::target::{Model, Target};
use rungwise::text::Language;
use serde_json::{Value, json};
use std::sync::Arc;

const MS: i64 = 1_000_000;

/// All conditions of so many contacts in a row over three literals, both series and parallel at every place, and with
/// each part inverted or not.
fn conditions(leaves: usize) -> Vec<Condition> {
    if leaves == 1 {
        let plain = (0..3).map(Condition::Literal);
        return plain.clone().chain(plain.map(|part| Condition::Not(Box::new(part)))).collect();
    }
    let mut all = Vec::new();
    for left in 1..leaves {
        for a in &conditions(left) {
            for b in &conditions(leaves - left) {
                let both = || vec![a.clone(), b.clone()];
                all.push(Condition::And(both()));
                all.push(Condition::Or(both()));
                if leaves < 4 {
                    all.push(Condition::Not(Box::new(Condition::Or(both()))));
                }
            }
        }
    }
    all
}

/// Whether these literals decide, by trying all values of the others.
fn decides(condition: &Condition, values: [bool; 3], known: &[usize]) -> bool {
    let holds = condition.holds(&values);
    (0..8).all(|other| {
        let tried: [bool; 3] = std::array::from_fn(|at| match known.contains(&at) {
            true => values[at],
            false => other >> at & 1 == 1,
        });
        condition.holds(&tried) == holds
    })
}

#[test]
fn no_fewer_contacts_decide_in_any_small_rung() {
    let mut tried = 0;
    for leaves in 1..=4 {
        // Of those with four contacts some.
        let step = if leaves == 4 { 41 } else { 1 };
        for condition in conditions(leaves).into_iter().step_by(step) {
            for assignment in 0..8 {
                let values: [bool; 3] = std::array::from_fn(|at| assignment >> at & 1 == 1);
                let found = condition.decisive(&values, &[0; 3]);
                assert!(decides(&condition, values, &found), "{condition:?} {values:?} {found:?}");
                let set = |set: usize| (0..3).filter(move |at| set >> at & 1 == 1).collect::<Vec<_>>();
                let least =
                    (0..8).map(set).filter(|set| decides(&condition, values, set)).map(|set| set.len());
                assert_eq!(Some(found.len()), least.min(), "{condition:?} {values:?} {found:?}");
                tried += 1;
            }
        }
    }
    assert!(tried > 50_000, "{tried}");
}

#[test]
fn a_large_rung_needs_no_trying_and_dear_contacts_are_left_out() {
    // Eleven pairs in series, one literal in two places.
    let pair = |at: usize| Condition::Or(vec![Condition::Literal(2 * at), Condition::Literal(2 * at + 1)]);
    let mut parts: Vec<Condition> = (0..11).map(pair).collect();
    parts.push(Condition::Or(vec![Condition::Literal(0), Condition::Literal(22)]));
    let series = Condition::And(parts);
    let mut values = vec![true; 23];
    assert_eq!(series.decisive(&values, &[0; 23]).len(), 11, "one of each pair, the first for two");
    let mut costs = [0; 23];
    costs[4] = 1;
    assert!(series.decisive(&values, &costs).contains(&5));
    (values[6], values[7]) = (false, false);
    assert_eq!(series.decisive(&values, &costs), [6, 7]);
}

struct Plc {
    documents: Vec<Document>,
    session: Session,
    now_ns: i64,
}

impl Plc {
    fn of(text: &str, notation: Notation) -> Plc {
        let documents = vec![Document::new(text, notation, Target::of(Model::Fx3u))];
        let all: Vec<&Document> = documents.iter().collect();
        let code = Arc::new(compile(&all, false).unwrap_or_else(|problems| panic!("{problems:?}")));
        Plc { documents, session: Session::new(code), now_ns: 0 }
    }

    fn list(text: &str) -> Plc {
        Plc::of(text, Notation::FxIl)
    }

    /// Switches a relay or input, and runs so many scans.
    fn run(&mut self, settings: &str, scans: usize) -> &mut Plc {
        for setting in settings.split_whitespace() {
            let (name, value) = setting.split_once('=').unwrap_or((setting, "1"));
            switch(&mut self.session, name, value == "1");
        }
        for _ in 0..scans {
            self.session.scan(self.now_ns);
            self.now_ns += 10 * MS;
        }
        self
    }

    fn why(&self, name: &str, scan: Option<u64>) -> String {
        self.why_while(name, scan, &|| true)
    }

    fn why_while(&self, name: &str, scan: Option<u64>, goes_on: &dyn Fn() -> bool) -> String {
        let documents: Vec<&Document> = self.documents.iter().collect();
        let watched = Arc::new(compile(&documents, true).unwrap());
        let drivers = Drivers::of(&documents);
        let inquiry = Inquiry::new(&self.session, &watched, &documents, &drivers).patient(goes_on);
        let reason = inquiry.why(name, scan);
        let place = |place: rungwise::simulate::Place| {
            (documents[0].line_of(place.span.start as usize) + 1).to_string()
        };
        reason.map(|reason| reason.told(Language::English, place)).unwrap_or_default()
    }

    #[track_caller]
    fn check(&mut self, name: &str, expected: &str) -> &mut Plc {
        let told = self.why(name, None);
        let trimmed: String = expected.lines().map(|line| format!("{}\n", line.trim_end())).collect();
        assert_eq!(told, trimmed);
        self
    }
}

#[test]
fn who_has_no_patience_for_a_long_history_is_told_how_far_it_was_looked_through() {
    let mut plc = Plc::list("LD X0\nSET M0\nLD X1\nRST M0\nEND\n");
    plc.run("X0", 1).run("X0=0", 5_000);
    plc.check(
        "M0",
        "M0 is on since scan 0 (0 ms): SET M0 has power  [2]\n  X0 is on: an input, since scan 0 (0 ms)  [1]",
    );
    let left = std::cell::Cell::new(100);
    let goes_on = || left.replace(left.get() - 1) > 1;
    let told = plc.why_while("M0", None, &goes_on);
    let mut words = told.strip_prefix("M0 is on: it has been so at least since scan ").expect("so far");
    words = words.split_once(' ').expect("a number").0;
    assert!((4_000..5_000).contains(&words.parse().expect("a number")), "{told}");
    assert_eq!(left.get(), 0, "nothing more was looked at");
}

#[test]
fn a_seal_in_is_followed_to_the_button() {
    let mut plc = Plc::list("LD X0\nOR Y0\nANI X1\nANI X2\nOUT Y0\nEND\n");
    plc.run("", 3).check(
        "Y0",
        "\
Y0 is off: OUT Y0 has no power  [5]
  X0 is off: an input  [1]
  Y0 is off: so from the start on  [2]",
    );
    plc.run("X0", 2).run("X0=0", 40).check(
        "Y0",
        "\
Y0 is on: OUT Y0 has power  [5]
  Y0 is on since scan 3 (30 ms): OUT Y0 has power  [2]
    X0 is on: an input, since scan 3 (30 ms)  [1]
    X1 is off: an input  [3]
    X2 is off: an input  [4]
  X1 is off: an input  [3]
  X2 is off: an input  [4]",
    );
    plc.run("X1 X2", 1).check(
        "Y0",
        "\
Y0 is off: OUT Y0 has no power  [5]
  X1 is on: an input, since scan 45 (450 ms)  [3]",
    );
    plc.run("X1=0 X2=0", 5).check(
        "y0",
        "\
Y0 is off: OUT Y0 has no power  [5]
  X0 is off: an input, since scan 5 (50 ms)  [1]
  Y0 is off since scan 45 (450 ms): OUT Y0 has no power  [2]
    X1 is on: an input, since scan 45 (450 ms)  [3]",
    );
    // A scan long ago, as it was then.
    assert!(plc.why("Y0", Some(4)).starts_with("Y0 is on: OUT Y0 has power  [5]\n  X0 is on"));
    assert_eq!((plc.why("Y0", Some(999)), plc.why("Q1", None)), (String::new(), String::new()));
}

#[test]
fn timers_and_counters_say_how_far_they_are() {
    let mut plc = Plc::list("LD X0\nOUT T0 K10\nLD T0\nOUT Y0\nLD X1\nOUT C0 K3\nLD C0\nOUT Y1\nEND\n");
    plc.run("X0", 51).check(
        "Y0",
        "\
Y0 is off: OUT Y0 has no power  [4]
  the contact of T0 is off: 0.5 s of 1 s have passed  [3]
    OUT T0 K10 has power  [2]
      X0 is on: an input, since scan 0 (0 ms)  [1]",
    );
    plc.run("", 50).check(
        "Y0",
        "\
Y0 is on: OUT Y0 has power  [4]
  the contact of T0 is on: its 1 s have passed  [3]
    OUT T0 K10 has power  [2]
      X0 is on: an input, since scan 0 (0 ms)  [1]",
    );
    plc.run("X1", 1).run("X1=0", 1).run("X1", 1).run("X1=0", 1).check(
        "Y1",
        "\
Y1 is off: OUT Y1 has no power  [8]
  the contact of C0 is off: 2 of 3 are counted  [7]
    OUT C0 K3 has no power  [6]
      X1 is off: an input, since scan 104 (1040 ms)  [5]",
    );
    plc.run("X1", 1).check(
        "TS0",
        "\
the contact of T0 is on: its 1 s have passed  [2]
  OUT T0 K10 has power  [2]
    X0 is on: an input, since scan 0 (0 ms)  [1]",
    );
}

#[test]
fn what_is_set_is_followed_to_the_scan_in_which_it_was_set() {
    let mut plc =
        Plc::list("LD X0\nSET M0\nLD X1\nRST M0\nLD M0\nOUT Y0\nLD X2\nPLS M1\nLD M1\nMOV K4 D0\nEND\n");
    plc.run("", 2).check(
        "M0",
        "\
M0 is off: nothing that drives it has done so yet
  SET M0 has no power  [2]
    X0 is off: an input  [1]
  RST M0 has no power  [4]
    X1 is off: an input  [3]",
    );
    plc.run("X0", 1).run("X0=0", 9).check(
        "Y0",
        "\
Y0 is on: OUT Y0 has power  [6]
  M0 is on since scan 2 (20 ms): SET M0 has power  [5]
    X0 is on: an input, since scan 2 (20 ms)  [1]",
    );
    plc.run("X1", 1).run("X1=0", 9).check(
        "Y0",
        "\
Y0 is off: OUT Y0 has no power  [6]
  M0 is off since scan 12 (120 ms): RST M0 has power  [5]
    X1 is on: an input, since scan 12 (120 ms)  [3]",
    );
    plc.run("X2", 3).check(
        "M1",
        "\
M1 is off: power came in an earlier scan, and a pulse lasts one scan  [8]
  X2 is on: an input, since scan 22 (220 ms)  [7]",
    );
    plc.check(
        "D0",
        "\
D0 is 4 since scan 22 (220 ms): MOV K4 D0 has power  [10]
  M1 is on: PLS M1 has power  [9]
    X2 is on: an input, since scan 22 (220 ms)  [7]",
    );
    plc.run("M0", 1).check("M0", "M0 is on: it was set by hand\n");
}

#[test]
fn rails_are_reasons_too() {
    let text = "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nMCR N0\nLD M8002\nSET S0\nSTL S0\nOUT Y1\nLD X2\nSET S20\n\
                STL S20\nLD X3\nOUT Y2\nRET\nLD X4\nCJ P0\nLD X5\nOUT Y3\nP0\nEND\n";
    let mut plc = Plc::list(text);
    plc.run("X1 X3 X4 X5", 3).check(
        "Y0",
        "\
Y0 is off: OUT Y0 has no power  [4]
  MC N0 M100 has no power  [2]
    X0 is off: an input  [1]",
    );
    plc.check(
        "Y1",
        "\
Y1 is on: OUT Y1 has power  [9]
  S0 is on since scan 0 (0 ms): SET S0 has power  [8]
    M8002 is on: the PLC itself drives it  [6]",
    );
    plc.check(
        "Y2",
        "\
Y2 is off: nothing that drives it has done so yet
  OUT Y2 is not executed  [14]
    S20 is off: nothing that drives it has done so yet  [12]
      SET S20 has no power  [11]
        X2 is off: an input  [10]",
    );
    plc.check(
        "Y3",
        "\
Y3 is off: nothing that drives it has done so yet
  OUT Y3 is not executed  [19]
    CJ P0 led past it  [17]
      X4 is on: an input, since scan 0 (0 ms)  [16]",
    );
    plc.run("X2", 1).run("X2=0", 3).check(
        "Y1",
        "\
Y1 is off since scan 4 (40 ms): OUT Y1 has no power  [9]
  S0 is off since scan 3 (30 ms): SET S20 has power  [8]
    S0 is on since scan 0 (0 ms): SET S0 has power  [8]
      M8002 is on: the PLC itself drives it  [6]
    X2 is on: an input, since scan 3 (30 ms)  [10]",
    );
}

#[test]
fn a_drawing_is_explained_by_its_contacts() {
    let text = "|  X0        X1     Y0  |\n+--| |---+---|/|----( )-+\n|  Y0    |              |\n+--| |---+              |\n\n\
                |  X0     Y0            |\n+--| |----|P|--[MOV K1 D0]-+\n";
    let mut plc = Plc::of(&text[..text.find("\n\n").unwrap() + 1], Notation::Ladder);
    plc.run("X0 Y0", 2).check(
        "Y0",
        "\
Y0 is on: ( ) Y0 has power  [2]
  X0 is on: an input, since scan 0 (0 ms)  [2]
  X1 is off: an input  [2]",
    );
    let code = plc.session.machine().code();
    let held = code.variable("Y0").and_then(|variable| variable.force(code, &Held::Bit(false)));
    plc.session.touch(held.unwrap());
    plc.run("", 1).check("Y0", "Y0 is off: it is forced\n");
    let mut plc = Plc::list("LDP X0\nAND= D0 K0\nOUT Y0\nEND\n");
    plc.run("X0", 2).check(
        "Y0",
        "\
Y0 is off: OUT Y0 has no power  [3]
  LDP X0 does not conduct  [1]",
    );
}

#[test]
fn the_command_line_says_why() {
    let folder = folder(&[
        ("rungwise.toml", "target = \"fx2n\"\ncomments = \"devices.csv\"\n"),
        ("motor.il", "LD X0\nOR Y0\nANI X1\nOUT Y0\nEND\n"),
        ("devices.csv", "Device,Symbol,Comment\nX0,START,Start button\n"),
    ]);
    let set = ["run", "motor.il", "--set", "X0=1@100ms", "--set", "X1=1@500ms", "--watch", "Y0"];
    let (code, out, err) = run(&folder, &[&set[..], &["--why", "Y0", "--why", "Y0@200ms"]].concat());
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    let told = "\nY0 is off: OUT Y0 has no power  [motor.il:4]\n  X1 is on: an input, since scan 50 (500 ms)  [motor.il:3]\n\
                \nY0 is on: OUT Y0 has power  [motor.il:4]\n\
                \x20 X0 (Start button) is on: an input, since scan 10 (100 ms)  [motor.il:1]\n\
                \x20 X1 is off: an input  [motor.il:3]\n";
    assert!(out.ends_with(told), "{out}");
    let (_, out, _) = run(&folder, &[&set[..], &["--why", "Y0", "--format", "json"]].concat());
    let answer: Value = serde_json::from_str(&out).unwrap();
    let because = &answer["why"][0]["because"][0];
    assert_eq!((&because["line"], &because["column"]), (&json!(3), &json!(1)), "{answer}");
    let (code, _, err) = run(&folder, &[&set[..], &["--why", "Q9"]].concat());
    assert!(code == 2 && err.contains("Q9"), "{err}");
    let (_, out, _) = run(&folder, &[&set[..], &["--why", "Y0", "--lang", "zh-CN"]].concat());
    assert!(out.contains("Y0 断开：OUT Y0 没有能流"), "{out}");
}

#[test]
fn what_was_jumped_over_or_not_called_names_the_jump_and_the_call() {
    let text = "LD X0\nCJ P1\nLD X1\nOUT Y0\nP1\nLD X2\nCALL P2\nFEND\nP2\nLD X3\nCALL P3\nLD X4\nOUT Y1\nSRET\n\
        P3\nLD X4\nOUT Y2\nSRET\nI001\nLD X5\nOUT Y3\nIRET\nP4\nLD X5\nOUT Y4\nSRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.run("X0 X1", 2).check(
        "Y0",
        "\
Y0 is off: nothing that drives it has done so yet
  OUT Y0 is not executed  [4]
    CJ P1 led past it  [2]
      X0 is on: an input, since scan 0 (0 ms)  [1]",
    );
    plc.check(
        "Y2",
        "\
Y2 is off: nothing that drives it has done so yet
  OUT Y2 is not executed  [17]
    CALL P3 is not executed  [11]
      CALL P2 has no power  [7]
        X2 is off: an input  [6]",
    );
    plc.check("Y3", "Y3 is off: nothing that drives it has done so yet\n  OUT Y3 is not executed  [21]\n    the interrupt I001 did not come\n");
    plc.check("Y4", "Y4 is off: nothing that drives it has done so yet\n  OUT Y4 is not executed  [25]\n");
    plc.run("X2", 1).check(
        "Y2",
        "\
Y2 is off: nothing that drives it has done so yet
  OUT Y2 is not executed  [17]
    CALL P3 has no power  [11]
      X3 is off: an input  [10]",
    );
    // A coil that is left behind keeps what it had.
    plc.run("X0=0 X4", 1).run("X0 X1=0 X2=0", 2).check(
        "Y0",
        "\
Y0 is on since scan 3 (30 ms): OUT Y0 has power  [4]
  X1 is on: an input, since scan 0 (0 ms)  [3]
  OUT Y0 is not executed  [4]
    CJ P1 led past it  [2]
      X0 is on: an input, since scan 4 (40 ms)  [1]",
    );
    plc.check(
        "Y1",
        "\
Y1 is on since scan 3 (30 ms): OUT Y1 has power  [13]
  X4 is on: an input, since scan 3 (30 ms)  [12]
  OUT Y1 is not executed  [13]
    CALL P2 has no power  [7]
      X2 is off: an input, since scan 4 (40 ms)  [6]",
    );
}

#[test]
fn a_step_that_is_jumped_over_is_not_called_inactive() {
    let text = "LD M8002\nSET S20\nLD X0\nCJ P1\nSTL S20\nLD X1\nOUT Y0\nRET\nP1\nEND\n";
    Plc::list(text).run("X0 X1", 3).check(
        "Y0",
        "\
Y0 is off: nothing that drives it has done so yet
  OUT Y0 is not executed  [7]
    CJ P1 led past it  [4]
      X0 is on: an input, since scan 0 (0 ms)  [3]",
    );
}

#[test]
fn an_input_is_known_by_when_it_was_switched() {
    let mut plc = Plc::list("LD X0\nAND X1\nOUT Y0\nEND\n");
    let on = |since: u64| format!("X0 is on: an input, since scan {since} ({}0 ms)\n", since);
    // Switched to what it was it has not changed.
    plc.run("X0", 2).run("X0=0", 3).run("X1", 2).run("X0", 2).run("X0", 4).run("X1=0", 3).check("X0", &on(7));
    let code = plc.session.machine().code();
    let variable = code.variable("X0").unwrap();
    let held = variable.force(code, &Held::Bit(false)).unwrap();
    plc.session.touch(held);
    plc.run("", 2);
    plc.session.touch(variable.release());
    plc.run("", 3).check("X0", &on(18));
    plc.run("X0=0", 1).check("X0", "X0 is off: an input, since scan 21 (210 ms)\n");
    // Nobody has touched it.
    plc.check("X7", "X7 is off: an input\n");
    assert!(plc.session.back_to(10));
    plc.check("X0", &on(7));
}
