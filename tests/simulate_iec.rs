//! Programs in IEC 61131-3 on the simulated PLC: what operators, calls and declarations do.

use rungwise::document::{Document, Notation};
use rungwise::simulate::{Code, ErrorKind, Machine, Session, Touch, Value, compile};
use rungwise::target::{Fault, Model, Target};
use std::sync::Arc;

const MS: i64 = 1_000_000;

pub fn document(text: &str, notation: Notation) -> Document {
    Document::new(text, notation, Target::of(Model::Iec))
}

/// Code of an instruction list.
pub fn code(text: &str) -> Arc<Code> {
    match compile(&[&document(text, Notation::IecIl)], false) {
        Ok(code) => Arc::new(code),
        Err(problems) => {
            let said: Vec<String> = problems
                .iter()
                .map(|problem| {
                    let line = text[..problem.place.span.start as usize].lines().count();
                    format!("line {line}: {:?}", problem.obstacle)
                })
                .collect();
            panic!("{}", said.join("\n"))
        }
    }
}

/// A program that runs, with inputs and outputs by name.
pub struct Plc {
    pub session: Session,
    now: i64,
    pub errors: Vec<ErrorKind>,
}

impl Plc {
    pub fn new(text: &str) -> Plc {
        Plc { session: Session::new(code(text)), now: 0, errors: Vec::new() }
    }

    pub fn set(&mut self, name: &str, value: &str) -> &mut Plc {
        let code = Arc::clone(self.session.machine().code());
        let variable = code.variable(name).unwrap_or_else(|| panic!("{name} is a variable"));
        let value = Value::read(value).expect("a value");
        self.session.touch(variable.set(&code, &value).unwrap_or_else(|| panic!("{name} takes {value}")));
        self
    }

    /// Runs a scan, ten milliseconds after the one before.
    pub fn scan(&mut self) -> &mut Plc {
        self.scan_at(self.now)
    }

    pub fn scan_at(&mut self, now: i64) -> &mut Plc {
        let outcome = self.session.scan(now);
        self.errors = outcome.errors.iter().map(|error| error.kind).collect();
        self.now = now + 10 * MS;
        self
    }

    pub fn get(&self, name: &str) -> String {
        let machine = self.session.machine();
        let variable = machine.code().variable(name).unwrap_or_else(|| panic!("{name} is a variable"));
        machine.value(variable, 0).to_string()
    }
}

/// What the body makes of variables declared so, after one scan.
pub fn result(declarations: &str, body: &str, name: &str) -> String {
    let text = format!("PROGRAM Main\nVAR\n{declarations}\nEND_VAR\n{body}\nEND_PROGRAM\n");
    Plc::new(&text).scan().get(name)
}

#[test]
fn contacts_and_coils() {
    let text = "PROGRAM Main\nVAR\na AT %IX0.0 : BOOL;\nb AT %IX0.1 : BOOL;\ny AT %QX0.0 : BOOL;\nz : BOOL;\nEND_VAR\n\
                LD a\nOR y\nANDN b\nST y\nSTN z\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.set("a", "1").scan();
    assert_eq!((plc.get("y"), plc.get("z")), ("1".into(), "0".into()));
    plc.set("a", "0").scan();
    assert_eq!(plc.get("%QX0.0"), "1");
    plc.set("%IX0.1", "1").scan();
    assert_eq!((plc.get("Main.y"), plc.get("Z")), ("0".into(), "1".into()));
}

#[test]
fn operators_on_words() {
    let r = |declared: &str, body: &str| result(&format!("x : {declared};"), body, "x");
    assert_eq!(r("INT", "LD 7\nADD 3\nMUL 2\nSUB 1\nST x"), "19");
    assert_eq!(r("INT", "LD -7\nDIV 2\nST x"), "-3");
    assert_eq!(r("INT", "LD -7\nMOD 3\nST x"), "-1");
    assert_eq!(r("INT", "LD 7\nMOD 0\nST x"), "0");
    assert_eq!(r("INT", "LD 2\nADD( 3\nMUL 4\n)\nST x"), "14");
    assert_eq!(r("INT", "LD 20\nSUB( 10\nSUB( 3\nSUB 1\n)\n)\nST x"), "12");
    assert_eq!(r("REAL", "LD 1.5\nMUL 2.0\nST x"), "3.0");
    assert_eq!(r("WORD", "LD 16#0F0F\nAND 16#00FF\nOR 16#8000\nXOR 16#1\nST x"), "32782");
    assert_eq!(r("WORD", "LD WORD#16#F0F0\nNOT\nST x"), "3855");
    assert_eq!(r("TIME", "LD T#2s\nADD T#500ms\nMUL 2\nST x"), "T#5s");
    assert_eq!(r("BOOL", "LD 3\nGT( 1\nADD 1\n)\nST x"), "1");
    assert_eq!(r("BOOL", "LD T#1s\nLT T#2s\nST x"), "1");
    assert_eq!(r("BOOL", "LD TRUE\nXOR TRUE\nST x"), "0");
    assert_eq!(r("BOOL", "LD TRUE\nXORN TRUE\nST x"), "1");
    assert_eq!(r("BOOL", "LD FALSE\nORN( TRUE\nAND FALSE\n)\nST x"), "1");
    assert_eq!(r("BOOL", "LD TRUE\nEQ FALSE\nST x"), "0");
}

#[test]
fn what_goes_wrong_is_told_at_its_place() {
    let text = "PROGRAM Main\nVAR\nx : INT := 5;\ny : INT;\nEND_VAR\nLD x\nDIV y\nST x\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    let outcome = plc.session.scan(0);
    let [error] = &outcome.errors[..] else { panic!("{outcome:?}") };
    assert_eq!(error.kind, ErrorKind::Calculation(Fault::DivisionByZero));
    let span = error.place.expect("a place").span;
    assert_eq!(&text[span.start as usize..span.end as usize], "DIV y");
    assert_eq!(plc.get("x"), "0");
    let mut plc = Plc::new("PROGRAM Main\nVAR\nx : INT := 32767;\nEND_VAR\nLD x\nADD 1\nST x\nEND_PROGRAM\n");
    plc.scan();
    assert_eq!(plc.errors, [ErrorKind::Calculation(Fault::Overflow)]);
    assert_eq!(plc.get("x"), "-32768");
}

#[test]
fn jumps_take_the_current_result_along() {
    let text = "PROGRAM Main\nVAR\na : BOOL;\nx : INT;\ny : INT;\nEND_VAR\nLD 5\nJMP There\nLD 6\nThere:\nST x\n\
                LD a\nJMPC Over\nLD y\nADD 1\nST y\nOver:\nLD a\nRETC\nLD 100\nST x\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.scan();
    assert_eq!((plc.get("x"), plc.get("y")), ("100".into(), "1".into()));
    plc.set("a", "1").scan();
    assert_eq!((plc.get("x"), plc.get("y")), ("5".into(), "1".into()));
    plc = Plc::new(
        "PROGRAM Main\nVAR\nx : INT;\nEND_VAR\nAgain:\nLD x\nADD 1\nST x\nLT 5\nJMPC Again\nEND_PROGRAM\n",
    );
    assert_eq!(plc.scan().get("x"), "5");
    plc = Plc::new("PROGRAM Main\nVAR\nx : INT;\nEND_VAR\nAgain:\nLD x\nST x\nJMP Again\nEND_PROGRAM\n");
    assert_eq!(plc.scan().errors, [ErrorKind::Watchdog]);
}

const UNITS: &str = "\
FUNCTION Twice : INT
VAR_INPUT
    value : INT;
END_VAR
VAR
    factor : INT := 2;
END_VAR
    LD value
    MUL factor
    ST Twice
    LD 7
    ST factor
END_FUNCTION
FUNCTION_BLOCK Counter
VAR_INPUT
    up : BOOL R_EDGE;
    stride : INT := 1;
END_VAR
VAR_OUTPUT
    count : INT;
END_VAR
VAR_IN_OUT
    total : INT;
END_VAR
VAR_TEMP
    scratch : INT := 3;
END_VAR
    LD up
    JMPCN Done
    LD count
    ADD stride
    ST count
    LD total
    ADD stride
    ST total
    LD scratch
    ADD 1
    ST scratch
Done:
END_FUNCTION_BLOCK
PROGRAM Main
VAR
    a, b : BOOL;
    first : Counter;
    second : Counter := (stride := 10);
    sum : ARRAY[1..3] OF INT := [1, 2(5)];
    x, y : INT;
    i : INT := 2;
END_VAR
    CAL first(
        up := a,
        total := sum[1]
    )
    CAL second(
        up := b,
        total := sum[i]
    )
    LD first.count
    Twice
    ST x
    Twice(
        value := second.count
    )
    ADD 1
    ST y
END_PROGRAM
";

#[test]
fn units_of_the_program() {
    let mut plc = Plc::new(UNITS);
    plc.scan();
    assert_eq!((plc.get("x"), plc.get("y"), plc.get("sum[2]")), ("0".into(), "1".into(), "5".into()));
    plc.set("a", "1").set("b", "1").scan();
    assert_eq!((plc.get("x"), plc.get("y"), plc.get("sum[2]")), ("2".into(), "21".into(), "15".into()));
    plc.scan();
    assert_eq!(plc.get("first.count"), "1");
    plc.set("b", "0").scan();
    plc.set("b", "1").set("i", "3").scan();
    assert_eq!((plc.get("second.count"), plc.get("sum[3]")), ("20".into(), "15".into()));
    plc.set("b", "0").scan();
    plc.set("b", "1").set("i", "4").scan();
    assert!(plc.errors.contains(&ErrorKind::Calculation(Fault::Index)), "{:?}", plc.errors);
}

#[test]
fn conditional_calls_and_input_operators() {
    let text = "PROGRAM Main\nVAR\ngo : BOOL;\npulse : BOOL;\nc : CTU;\nd : CTU;\nx : BOOL;\nEND_VAR\n\
                LD go\nCALC c(\nCU := pulse,\nPV := 2\n)\nST x\nLD 3\nPV d\nLD pulse\nCU d\nLD go\nR d\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.set("pulse", "1").scan();
    assert_eq!((plc.get("c.CV"), plc.get("d.CV"), plc.get("x")), ("0".into(), "1".into(), "0".into()));
    plc.set("go", "1").scan();
    assert_eq!((plc.get("c.CV"), plc.get("d.CV"), plc.get("x")), ("1".into(), "0".into(), "1".into()));
}

#[test]
fn structures_enumerations_and_bits() {
    let text = "TYPE\nColour : (Red, Green, Blue) := Green;\nPoint : STRUCT x : INT := 4; y : INT; lit : BOOL; END_STRUCT;\n\
                END_TYPE\nPROGRAM Main\nVAR\nc : Colour;\np, q : Point := (y := 9);\nw : WORD := 16#8001;\nb : BOOL;\n\
                line : ARRAY[0..2] OF Point;\ni : INT := 1;\nn : INT;\nEND_VAR\nLD p\nST q\nLD w.15\nST b\nST line[i].lit\n\
                LD TRUE\nST w.1\nLD line[i].x\nADD q.y\nST n\nLD c\nEQ Green\nJMPCN No\nLD Colour#Blue\nST c\nNo:\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.scan();
    assert_eq!(plc.get("c"), "Blue");
    assert_eq!((plc.get("q.x"), plc.get("q.y"), plc.get("n")), ("4".into(), "9".into(), "13".into()));
    assert_eq!(
        (plc.get("b"), plc.get("line[1].lit"), plc.get("line[0].lit")),
        ("1".into(), "1".into(), "0".into())
    );
    assert_eq!(plc.get("w"), "32771");
    plc.set("c", "Colour#Red").scan();
    assert_eq!(plc.get("c"), "Red");
}

#[test]
fn texts() {
    let r = |body: &str| result("x : STRING[8] := 'A-4711'; n : INT;", body, "x");
    assert_eq!(r("LD x\nLEFT 3\nST x"), "'A-4'");
    assert_eq!(r("LD x\nCONCAT ' is long'\nST x"), "'A-4711 i'");
    assert_eq!(r("LD 12\nINT_TO_STRING\nST x"), "'12'");
    assert_eq!(result("x : STRING; b : BOOL;", "LD 'ab'\nLT 'b'\nST b", "b"), "1");
}

#[test]
fn history_forces_and_names() {
    let text = "PROGRAM Main\nVAR\nrun : BOOL;\nt : TON;\nn : INT;\ns : STRING;\nEND_VAR\nLD run\nIN t\nLD n\nADD 1\nST n\n\
                LD n\nINT_TO_STRING\nST s\nCAL t(\nPT := T#1s\n)\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.set("run", "1");
    (0..50).for_each(|_| _ = plc.scan());
    assert_eq!((plc.get("t.ET"), plc.get("s")), ("T#490ms".into(), "'50'".into()));
    let before = plc.session.at(20).expect("known");
    let value = |machine: &Machine<u8>, name: &str| {
        machine.value(machine.code().variable(name).expect("a name"), 0).to_string()
    };
    assert_eq!(
        (value(&before, "n"), value(&before, "t.et"), value(&before, "s")),
        ("20".into(), "T#190ms".into(), "'20'".into())
    );
    let code = Arc::clone(plc.session.machine().code());
    let n = code.variable("n").expect("a name");
    plc.session.touch(n.force(&code, &Value::Number(7)).expect("a number"));
    plc.scan();
    assert_eq!((plc.get("n"), plc.session.machine().forced()), ("7".into(), vec!["n".to_string()]));
    plc.session.touch(n.release());
    plc.scan();
    assert_eq!(plc.get("n"), "8");
    plc.session.touch(Touch::LetAllGo);
    assert!(plc.session.machine().forced().is_empty());
    assert!(code.named().contains(&"t.Q".to_string()), "{:?}", code.named());
    // An edit keeps what variables have.
    plc.session.adopt(self::code(&text.replace("ADD 1", "ADD 10")));
    plc.scan();
    assert_eq!((plc.get("n"), plc.get("run")), ("18".into(), "1".into()));
}
