//! Value change dumps, read by the library that the waveform viewer Surfer reads them with: its signals, times and
//! values are those of the simulated PLC.

use crate::binary::{folder, run};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use wellen::{FileFormat, SignalValue, TimescaleUnit, simple::Waveform};

/// What a dump says of a signal: its type as viewers show it, its width, and its changes with their times in
/// nanoseconds.
#[derive(Debug, PartialEq)]
struct Told {
    kind: String,
    bits: Option<u32>,
    changes: Vec<(u64, Value)>,
}

/// A number in so many bits with a sign.
fn signed(bits: &str) -> i64 {
    let number = bits.chars().fold(0u64, |number, bit| number << 1 | u64::from(bit == '1'));
    let unused = 64 - bits.len() as u32;
    (number << unused) as i64 >> unused
}

/// All signals of a dump by their names.
fn read(path: &std::path::Path) -> BTreeMap<String, Told> {
    let mut waves: Waveform = wellen::simple::read(path).expect("a dump that can be read");
    let timescale = waves.hierarchy().timescale().expect("a time scale");
    assert_eq!((timescale.factor, timescale.unit), (1, TimescaleUnit::NanoSeconds));
    assert_eq!(waves.hierarchy().file_format(), FileFormat::Vcd);
    let variables: Vec<_> = waves.hierarchy().iter_vars().cloned().collect();
    waves.load_signals(&variables.iter().map(|variable| variable.signal_ref()).collect::<Vec<_>>());
    let told = variables.iter().map(|variable| {
        let name = variable.full_name(waves.hierarchy());
        let name = name.strip_prefix("plc.").expect("all signals are those of the PLC").to_string();
        let signal = waves.get_signal(variable.signal_ref()).expect("a signal");
        let changes = signal.iter_changes().map(|(at, value)| {
            let value = match value {
                SignalValue::Real(number) => json!(number),
                SignalValue::String(text) => json!(text),
                bits if variable.is_1bit() => json!(bits.to_bit_string().as_deref() == Some("1")),
                bits => json!(signed(&bits.to_bit_string().expect("bits"))),
            };
            (waves.time_table()[at as usize], value)
        });
        let kind = format!("{:?}", variable.var_type());
        (name, Told { kind, bits: variable.length(), changes: changes.collect() })
    });
    told.collect()
}

/// The changes of a variable in the answer of `rungwise run --format json`.
fn changes(answer: &Value, name: &str) -> Vec<(u64, Value)> {
    let mut changes: Vec<(u64, Value)> = Vec::new();
    for row in answer["scans"].as_array().expect("scans") {
        let (time_ms, value) = (row["time_ms"].as_f64().expect("a time"), &row["values"][name]);
        if changes.last().is_none_or(|(_, before)| before != value) {
            changes.push(((time_ms * 1e6).round() as u64, value.clone()));
        }
    }
    changes
}

/// Runs a program, and gives what it said and its dump.
fn dumped(name: &str, text: &str, arguments: &[&str]) -> (Value, BTreeMap<String, Told>) {
    let files = folder(&[(name, text)]);
    let mut all = vec!["run", name, "--format", "json", "--trace", "waves.vcd"];
    all.extend(arguments);
    let (code, out, err) = run(&files, &all);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    (serde_json::from_str(&out).unwrap(), read(&files.path().join("waves.vcd")))
}

#[test]
fn bits_words_timers_and_counters_are_those_of_the_run() {
    let text = "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T0 K3\nLD T0\nOUT Y1\nLDP X0\nSUB D0 K7 D0\nMUL D0 K10000 D10\n\
                LD M8012\nOUT C0 K5\nEND\n";
    let watched = ["X0", "X1", "Y0", "Y1", "T0", "TS0", "D0", "D10:32", "C0", "CS0"];
    let list = watched.join(",");
    let settings = ["X0=1@100ms", "X0=0@150ms", "X0=1@300ms", "X1=1@702.5ms"];
    let mut arguments = vec!["--scan-time", "2.5ms", "--time", "1s", "--watch", &list];
    settings.iter().for_each(|setting| arguments.extend(["--set", setting]));
    let (answer, waves) = dumped("motor.il", text, &arguments);
    assert_eq!(waves.len(), watched.len(), "{:?}", waves.keys());
    for name in watched {
        let told = &waves[name];
        assert_eq!(told.changes, changes(&answer, name), "{name}");
        let (kind, bits) = match name {
            "T0" | "D0" | "C0" => ("Integer", 16),
            "D10:32" => ("Integer", 32),
            _ => ("Wire", 1),
        };
        assert_eq!((told.kind.as_str(), told.bits), (kind, Some(bits)), "{name}");
    }
    // The times of a scan are kept where they are no whole milliseconds, and so is what is below 0.
    assert_eq!(waves["X1"].changes, [(0, json!(false)), (702_500_000, json!(true))]);
    assert_eq!(waves["D0"].changes, [(0, json!(0)), (100_000_000, json!(-7)), (300_000_000, json!(-14))]);
    assert_eq!(waves["D10:32"].changes.last(), Some(&(300_000_000, json!(-140_000))));
    assert!(waves["T0"].changes.len() >= 4 && waves["CS0"].changes.len() == 2, "{waves:?}");
}

#[test]
fn variables_of_iec_keep_their_types() {
    let text = "TYPE Phase : (Idle, Run); END_TYPE\nPROGRAM Main\nVAR\ngo : BOOL; n : INT; big : DINT; r : REAL;\n\
                t : TIME; s : STRING; p : Phase; delay : TON;\nEND_VAR\n\
                CAL delay(IN := go, PT := T#30ms)\nLD delay.ET\nST t\nLD n\nSUB 100\nST n\nINT_TO_DINT\nMUL 1000\nST big\n\
                LD n\nINT_TO_REAL\nDIV 8.0\nST r\nLD go\nJMPCN off\nLD 'two words'\nST s\nLD Run\nST p\noff:\nEND_PROGRAM\n";
    let names = ["go", "n", "big", "r", "t", "s", "p", "delay.Q"];
    let list = names.join(",");
    let (answer, waves) =
        dumped("main.il", text, &["--time", "100ms", "--set", "go=1@20ms", "--watch", &list]);
    assert_eq!(waves.len(), names.len());
    for name in ["go", "n", "big", "r", "delay.Q"] {
        assert_eq!(waves[name].changes, changes(&answer, name), "{name}");
    }
    assert_eq!(waves["n"].changes.last(), Some(&(100_000_000, json!(-1100))));
    assert_eq!((waves["big"].kind.as_str(), waves["big"].bits), ("Integer", Some(32)));
    assert_eq!(waves["r"].changes[0], (0, json!(-12.5)));
    // A duration is a number of milliseconds, and blanks of texts are no ends of values.
    let times: Vec<(u64, Value)> =
        [(0, 0.0), (30, 10.0), (40, 20.0), (50, 30.0)].map(|(ms, time)| (ms * 1_000_000, json!(time))).into();
    assert_eq!(waves["t"].changes, times);
    assert_eq!(waves["s"].changes.last(), Some(&(20_000_000, json!("two_words"))));
    assert_eq!(waves["p"].changes, [(0, json!("Idle")), (20_000_000, json!("Run"))]);
}
