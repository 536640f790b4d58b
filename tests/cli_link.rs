//! The verbs of the programming port, through the binary, with a virtual PLC in a process of its own.

use crate::binary::{command, folder, run};
use crate::loopback::Overheard;
use crate::virtual_plc::VirtualPlc;
use rungwise::link::{Host, Line, Map, Mode, Part, Patience, Plain, Point, Watch, transport};
use rungwise::target::{Device, DeviceKind, Target};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tempfile::TempDir;

/// Both streams of a command that must end with `code`.
fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    assert!(!err.contains("panicked"), "{err}");
    (out, err)
}

/// An example in a folder of its own.
struct Example {
    name: String,
    folder: TempDir,
    target: &'static Target,
}

/// Copies the files of a folder.
pub(crate) fn copied(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().flatten().filter(|entry| entry.path().is_file()) {
        std::fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
    }
}

/// The examples that have an FX list.
fn examples() -> Vec<Example> {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(&all).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let example = |path: PathBuf| {
        let name = path.file_name()?.to_str()?.to_string();
        let folder = tempfile::tempdir().unwrap();
        copied(&path, &folder.path().join(&name));
        let (code, out, _) = run(&folder, &["encode", &name, "--format", "json"]);
        let code = (code == 0).then(|| serde_json::from_str::<Value>(&out).unwrap())?;
        let target = Target::named(code["model"].as_str()?)?;
        Some(Example { name, folder, target })
    };
    folders.into_iter().filter_map(example).collect()
}

/// What a PLC showed: the scan, the device, and its value.
type Seen = Vec<(usize, String, i64)>;

impl Example {
    fn words(&self, path: &str) -> Value {
        let arguments = ["encode", path, "--format", "json", "--target", self.target.name];
        let (out, _) = check(&self.folder, &arguments, 0);
        serde_json::from_str::<Value>(&out).unwrap()["words"].clone()
    }

    /// Into the PLC, and back.
    fn goes_there_and_back(&self, port: &str) {
        let name = self.name.as_str();
        let verb =
            |arguments: &[&str], code| check(&self.folder, &[arguments, &["--port", port]].concat(), code);
        verb(&["verify", name], 1);
        let (_, err) = verb(&["download", name, "--yes"], 0);
        assert!(err.contains("read back and compared") && err.contains("the PLC stands still"), "{err}");
        verb(&["verify", name], 0);
        for form in ["il", "lad"] {
            // A file says nothing of its model; its project does.
            let project = self.folder.path().join(form);
            std::fs::create_dir_all(&project).unwrap();
            let manifest = format!("target = \"{}\"\n", self.target.name);
            std::fs::write(project.join("rungwise.toml"), manifest).unwrap();
            let file = format!("{form}/uploaded.{form}");
            verb(&["upload", "-o", &file], 0);
            assert_eq!(self.words(&file), self.words(name), "{name}: {form}");
            check(&self.folder, &["prove", name, &file], 0);
            verb(&["verify", &file], 0);
        }
    }

    /// Drives the inputs of a stepped PLC that stands still with this program for so many scans, and compares all that
    /// it shows with the simulator under the same inputs.
    fn does_as_the_simulator(&self, port: &str, scans: usize) {
        let requests = Arc::<AtomicUsize>::default();
        // Each request is a scan of a stepped PLC.
        let counted = Arc::clone(&requests);
        let hear = move |_: &[u8]| _ = counted.fetch_add(1, Ordering::Relaxed);
        let line = Overheard { line: transport::open(port).unwrap(), hear };
        // A machine with much to do may be slow, and a request that is sent anew would be a scan too many.
        let patience = Patience { answer: Duration::from_secs(60), tries: 1 };
        let mut host = Host::connect(Line::new(line, patience, Arc::default())).unwrap();
        let point = |name: &str| Point::named(name, self.target).unwrap();
        assert_eq!(host.mode().unwrap(), Mode::Stop);
        let stop = Plain::bit(Device::new(DeviceKind::M, 8037), Part::Contact).unwrap();
        host.line().ask(&stop.force(false)).unwrap();
        let started = requests.load(Ordering::Relaxed);
        let scan = || requests.load(Ordering::Relaxed) - started - 1;
        let outputs = ["Y0", "Y1", "Y2", "Y3", "Y4", "Y5"];
        let watched = ["Y0", "M0", "T0", "T1", "C0", "D0", "S0"];
        let mut watch = Watch::new(watched.map(point).to_vec());
        let mut random = fastrand::Rng::with_seed(7);
        let mut inputs = BTreeMap::new();
        let (mut sets, mut seen) = (Vec::new(), Seen::new());
        let mut note = |scan: usize, names: &[&str], values: Vec<i64>| {
            seen.extend(names.iter().zip(values).map(|(name, value)| (scan, name.to_string(), value)));
        };
        let mut round = 0;
        while requests.load(Ordering::Relaxed) - started < scans {
            round += 1;
            if round % 15 == 1 {
                let (name, value) = match random.usize(0..6) {
                    5 => ("D0".to_string(), random.i64(0..1000)),
                    input => {
                        let on = inputs.entry(input).or_insert(0);
                        *on = 1 - *on;
                        (format!("X{input}"), *on)
                    }
                };
                host.write(point(&name), value).unwrap();
                // What was switched behind a scan is seen by the next one.
                sets.push(format!("{name}={value}@{}ms", (scan() + 1) * 10));
            } else if round % 15 == 8 && self.target.name != "fx1s" {
                let values = host.poll(&mut watch).unwrap();
                note(scan(), &watched, values);
            } else {
                let before = scan();
                let values = host.read(&outputs.map(point)).unwrap();
                assert_eq!(scan(), before + 1, "one request shows all outputs");
                note(scan(), &outputs, values);
            }
        }
        let last = scan();
        host.stop().unwrap();
        drop(host);
        let names = [&outputs[..], &watched].concat().join(",");
        let count = (last + 1).to_string();
        let mut arguments = vec![
            "run",
            &self.name,
            "--scans",
            &count,
            "--scan-time",
            "10ms",
            "--format",
            "json",
            "--watch",
            &names,
        ];
        arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
        let (out, _) = check(&self.folder, &arguments, 0);
        let rows = serde_json::from_str::<Value>(&out).unwrap();
        let mut changes = std::collections::BTreeSet::new();
        for (scan, device, value) in seen {
            let until = |row: &&Value| row["scan"].as_u64().unwrap() as usize <= scan;
            let row = rows["scans"].as_array().unwrap().iter().rev().find(until).unwrap();
            let expected = match &row["values"][&device] {
                Value::Bool(on) => i64::from(*on),
                number => number.as_i64().unwrap(),
            };
            assert_eq!(value, expected, "{}: {device} in scan {scan}; {sets:?}", self.name);
            changes.insert((device, value));
        }
        assert!(changes.len() > outputs.len() + 1, "{}: nothing has moved: {changes:?}", self.name);
    }
}

#[test]
fn examples_do_in_the_virtual_plc_what_they_do_in_the_simulator() {
    let examples = examples();
    let names: Vec<&str> = examples.iter().map(|example| example.name.as_str()).collect();
    assert!(names.len() >= 8, "{names:?}");
    for model in ["fx1s", "fx1n", "fx2n"] {
        assert!(examples.iter().any(|example| example.target.name == model), "{model}");
    }
    for example in &examples {
        println!("{}", example.name);
        let arguments = ["--stepped", "--scan-time", "10ms", "--model", example.target.name];
        let plc = VirtualPlc::start(example.folder.path(), &arguments);
        example.goes_there_and_back(&plc.port);
        example.does_as_the_simulator(&plc.port, 600);
        assert_eq!(plc.quit(), Some(0));
    }
}

#[cfg(unix)]
#[test]
fn a_pseudo_terminal_does_the_same() {
    for example in examples() {
        let arguments = ["--pty", "--stepped", "--scan-time", "10ms", "--model", example.target.name];
        let plc = VirtualPlc::listening(example.folder.path(), &arguments);
        assert!(plc.port.starts_with("/dev/"), "{}", plc.port);
        example.goes_there_and_back(&plc.port);
        example.does_as_the_simulator(&plc.port, 600);
        assert_eq!(plc.quit(), Some(0));
    }
}

const MOTOR: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLD X2\nOUT C100 K10\nEND\n";
const OTHER: &str = "LDI X0\nOUT Y1\nEND\n";

/// A folder with two programs, and a virtual PLC.
fn programs_and_plc(arguments: &[&str]) -> (TempDir, VirtualPlc) {
    let third = "LD X7\nOUT Y7\nEND\n";
    let folder = folder(&[("motor.il", MOTOR), ("other.il", OTHER), ("third.il", third)]);
    let plc = VirtualPlc::start(folder.path(), arguments);
    (folder, plc)
}

#[test]
fn a_download_starts_the_plc_if_asked_and_status_tells_of_it() {
    let (folder, plc) = programs_and_plc(&[]);
    let port = plc.port.as_str();
    let (_, err) = check(&folder, &["download", "motor.il", "--yes", "--start", "--port", port], 0);
    assert!(err.contains("the PLC runs"), "{err}");
    // Right behind the start the first scan is not over, and on a machine at work one comes late.
    let statuses = std::iter::repeat_with(|| {
        let (out, _) = check(&folder, &["status", "motor.il", "--port", port, "--format", "json"], 0);
        (serde_json::from_str::<Value>(&out).unwrap(), out)
    });
    let has_scanned = |status: &Value| status["scan_time_ms"].as_f64().is_some_and(|scan| scan >= 10.0);
    let (status, out) = statuses.take(100).find(|(status, _)| has_scanned(status)).expect("a scan");
    for (key, value) in [
        ("model", json!("fx2n")),
        ("version", json!("3.10")),
        ("mode", json!("RUN")),
        ("capacity", json!(8000)),
        ("title", json!("")),
        ("keyword", json!(false)),
        ("errors", json!([])),
        ("same", json!(true)),
    ] {
        assert_eq!(status[key], value, "{key}: {out}");
    }
    check(&folder, &["status", "other.il", "--port", port], 1);
    let (out, _) = check(&folder, &["status", "--port", port], 0);
    assert!(out.contains("FX2N 3.10, RUN"), "{out}");
    check(&folder, &["stop", "--port", port], 0);
    assert!(check(&folder, &["status", "--port", port], 0).0.contains("STOP"));
    check(&folder, &["start", "--yes", "--port", port], 0);
    check(&folder, &["stop", "--port", port], 0);
    check(&folder, &["clear", "--yes", "--port", port], 0);
    check(&folder, &["verify", "motor.il", "--port", port], 1);
}

#[test]
fn a_monitor_tells_what_changes_and_keeps_it() {
    let (folder, plc) = programs_and_plc(&["--stepped", "--program", "motor.il"]);
    let port = plc.port.as_str();
    check(&folder, &["force", "X0=on", "--port", port], 0);
    check(&folder, &["write", "D5=-3", "D6:32=100000", "--port", port], 0);
    let devices = ["Y0", "X1", "D5", "D6:32", "C100", "CS100"];
    let monitor = [&["monitor"], &devices[..], &["--port", port, "--count", "3"]].concat();
    let trace = ["--format", "json", "--trace", "trace.csv"];
    let (out, _) = check(&folder, &[&monitor[..], &trace].concat(), 0);
    let rows: Vec<Value> = out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let values = json!({"Y0": true, "X1": false, "D5": -3, "D6:32": 100_000, "C100": 0, "CS100": false});
    assert_eq!(rows[0]["values"], values, "{out}");
    assert!(rows[0]["time_ms"].is_u64());
    assert!(std::fs::read_to_string(folder.path().join("trace.csv")).unwrap().contains("Y0"));
    let (out, _) = check(&folder, &[&monitor[..], &["--trace", "trace.vcd"]].concat(), 0);
    assert!(out.contains("Y0=1") || out.contains("Y0=TRUE") || out.contains("Y0=on"), "{out}");
    assert!(std::fs::read_to_string(folder.path().join("trace.vcd")).unwrap().contains("$var"));
}

#[test]
fn somebody_stands_in_front_of_the_plc() {
    let (_folder, mut plc) = programs_and_plc(&["--program", "motor.il", "--scan-time", "1ms"]);
    // Scans come by themselves.
    fn comes_to(plc: &mut VirtualPlc, device: &str, wanted: &str) {
        let wanted = format!("{device} = {wanted}");
        assert!((0..1000).any(|_| plc.ask(device) == wanted), "{wanted}");
    }
    let [off, on] = ["Y0", "X0"].map(|device| plc.ask(device).split_once(" = ").unwrap().1.to_string());
    assert_eq!(off, on, "both are off");
    plc.tell("X0=1");
    let on = plc.ask("X0").split_once(" = ").unwrap().1.to_string();
    assert_ne!(on, off);
    comes_to(&mut plc, "Y0", &on);
    plc.tell("X0=0");
    comes_to(&mut plc, "X0", &off);
    comes_to(&mut plc, "Y0", &on);
    plc.tell("stop");
    comes_to(&mut plc, "Y0", &off);
    comes_to(&mut plc, "M8001", &on);
    plc.tell("run");
    comes_to(&mut plc, "M8000", &on);
    plc.tell("D0=5");
    comes_to(&mut plc, "D0", "5");
    let answer = plc.ask("what?");
    assert!(answer.contains("`what?`") && answer.contains("quit"), "{answer}");
    assert_eq!(plc.quit(), Some(0));
}

#[test]
fn a_plc_whose_switch_is_at_stop_takes_programs_and_orders() {
    let (folder, mut plc) = programs_and_plc(&["--switch", "stop"]);
    let port = plc.port.clone();
    check(&folder, &["download", "motor.il", "--yes", "--port", &port], 0);
    assert!(check(&folder, &["status", "--port", &port], 0).0.contains("STOP"));
    check(&folder, &["start", "--yes", "--port", &port], 0);
    assert!(check(&folder, &["status", "--port", &port], 0).0.contains("RUN"));
    plc.tell("stop");
    let is_stopped = |_| check(&folder, &["status", "--port", &port], 0).0.contains("STOP");
    assert!((0..100).any(is_stopped));
}

#[test]
fn a_dry_run_changes_nothing() {
    let (folder, plc) = programs_and_plc(&["--program", "motor.il"]);
    let port = plc.port.as_str();
    let (out, _) = check(&folder, &["download", "other.il", "--dry-run", "--port", port], 1);
    assert!(out.contains("-OUT Y0\n") && out.contains("+OUT Y1\n"), "{out}");
    assert!(out.starts_with("--- program in the PLC\n+++ program of the file\n"), "{out}");
    assert!(!folder.path().join(".rungwise").exists(), "nothing is kept");
    check(&folder, &["verify", "motor.il", "--port", port], 0);
    let (out, _) = check(&folder, &["download", "motor.il", "--dry-run", "--port", port], 0);
    assert_eq!(out, "");
}

#[test]
fn what_was_in_the_plc_is_kept_for_its_owner_and_comes_back() {
    let (folder, plc) = programs_and_plc(&[]);
    let port = plc.port.as_str();
    let (_, err) = check(&folder, &["download", "--rollback", "--port", port], 2);
    assert!(err.contains("no-backup") && err.contains("help:"), "{err}");
    check(&folder, &["download", "motor.il", "--yes", "--port", port], 0);
    check(&folder, &["download", "other.il", "--yes", "--port", port], 0);
    check(&folder, &["verify", "other.il", "--port", port], 0);
    // Another PLC answers at the port: that is said before anything is written.
    let other = VirtualPlc::start(folder.path(), &["--program", "third.il"]);
    let (_, err) = check(&folder, &["download", "--rollback", "--dry-run", "--port", &other.port], 1);
    assert!(err.contains("warning[other-plc]") && err.contains("its program has the sum"), "{err}");
    let (_, err) = check(&folder, &["download", "--rollback", "--yes", "--port", port], 0);
    assert!(!err.contains("other-plc"), "{err}");
    check(&folder, &["verify", "motor.il", "--port", port], 0);
    let backups = folder.path().join(".rungwise/backup");
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(&backups).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert_eq!(files.len(), 3, "{files:?}");
    let [_, motor, other] = &files[..] else { panic!("three") };
    check(&folder, &["verify", motor.to_str().unwrap(), "--port", port], 0);
    check(&folder, &["verify", other.to_str().unwrap(), "--port", port], 1);
    let backup: Value = serde_json::from_str(&std::fs::read_to_string(motor).unwrap()).unwrap();
    assert_eq!((&backup["model"], &backup["steps"]), (&json!("fx2n"), &json!(9)), "{backup}");
    assert_eq!(check(&folder, &["decode", motor.to_str().unwrap()], 0).0, MOTOR);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&backups), 0o700);
        assert!(files.iter().all(|file| mode(file) == 0o600));
    }
}

#[test]
fn program_and_latched_devices_outlast_the_process() {
    let (folder, plc) = programs_and_plc(&["--state", "memory.json"]);
    let port = plc.port.clone();
    check(&folder, &["download", "motor.il", "--yes", "--start", "--port", &port], 0);
    check(&folder, &["write", "D300=7", "D5=8", "C100=4", "--port", &port], 0);
    assert_eq!(plc.quit(), Some(0));
    let mut plc = VirtualPlc::start(folder.path(), &["--state", "memory.json"]);
    let port = plc.port.clone();
    check(&folder, &["verify", "motor.il", "--port", &port], 0);
    assert!(check(&folder, &["status", "--port", &port], 0).0.contains("RUN"));
    assert_eq!(plc.ask("D300"), "D300 = 7");
    assert_eq!(plc.ask("C100"), "C100 = 4");
    assert_eq!(plc.ask("D5"), "D5 = 0", "D5 is not latched");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(folder.path().join("memory.json")).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
    }
    assert_eq!(plc.quit(), Some(0));
    for broken in
        ["", "{}", "[1]", "{\"model\":\"fx9\",\"program\":\"\",\"is_open\":false,\"on\":[],\"words\":{}}"]
    {
        std::fs::write(folder.path().join("memory.json"), broken).unwrap();
        let arguments = ["plc", "--listen", "127.0.0.1:0", "--state", "memory.json"];
        let (_, err) = check(&folder, &arguments, 2);
        assert!(err.contains("bad-state") && err.contains("memory.json") && err.contains("help:"), "{err}");
    }
}

#[cfg(unix)]
#[test]
fn a_faster_line_is_found_again() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let plc = VirtualPlc::listening(folder.path(), &["--pty", "--baud", "9600"]);
    let port = plc.port.as_str();
    for _ in 0..2 {
        check(&folder, &["download", "motor.il", "--yes", "--baud", "115200", "--port", port], 0);
    }
    check(&folder, &["verify", "motor.il", "--port", port], 0);
}

#[test]
fn the_verbs_speak_chinese() {
    let (folder, plc) = programs_and_plc(&[]);
    let port = plc.port.as_str();
    let (_, err) = check(&folder, &["--lang", "zh-CN", "download", "motor.il", "--yes", "--port", port], 0);
    assert!(
        err.contains("PLC") && !err.contains("read back") && err.chars().any(|c| c > '\u{4E00}'),
        "{err}"
    );
    let (_, err) = check(&folder, &["--lang", "zh-CN", "status", "--port", "tcp://127.0.0.1:1"], 3);
    assert!(err.chars().filter(|c| *c > '\u{4E00}').count() > 10, "{err}");
    let mut chinese = command(folder.path(), &["plc", "--listen", "127.0.0.1:0", "--faults", "flood=1"]);
    let refused = chinese.args(["--lang", "zh-CN"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    let err = String::from_utf8(refused.stderr).unwrap();
    assert!(err.contains("flood=1") && err.chars().any(|c| c > '\u{4E00}'), "{err}");
}

#[test]
fn monitor_holds_what_the_program_writes_and_keeps_the_latest_looks() {
    let list = "LD M8000\nINCP D0\nMOV K3 D1\nINC D2\nEND\n";
    let folder = folder(&[("count.il", list)]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "count.il", "--stepped"]);
    let port = plc.port.clone();
    let arguments = ["monitor", "D1", "--hold", "D1=9", "--count", "6", "--port", &port];
    let (out, err) = check(&folder, &arguments, 0);
    // The program writes 3 in the next scan, and the host 9 behind it.
    assert!(out.contains("D1=3"), "{out}");
    assert!(err.contains("no longer held") && err.contains("D1=9"), "{err}");
    let requests = |hold: &[&str]| {
        let before: i64 = read(&folder, &port, "D2");
        check(&folder, &[&["monitor", "D1", "--count", "6", "--port", &port], hold].concat(), 0);
        read(&folder, &port, "D2") - before
    };
    // One exchange more for each look, and for the first value.
    let held = requests(&["--hold", "D1=9"]);
    assert_eq!(held - requests(&[]), 7, "{held}");
    let arguments = ["monitor", "D2", "--count", "40", "--keep", "4", "--trace", "kept.csv", "--port", &port];
    check(&folder, &arguments, 0);
    let kept = std::fs::read_to_string(folder.path().join("kept.csv")).unwrap();
    assert!((5..=6).contains(&kept.lines().count()), "{kept}");
    assert!(kept.lines().last().unwrap().starts_with("39,"), "{kept}");
    check(&folder, &["monitor", "D2", "--for", "1ms", "--port", &port], 0);
    for hold in ["D1=70000", "Q1=1", "D1", "M8037=1"] {
        let (code, _, err) =
            run(&folder, &["monitor", "D1", "--hold", hold, "--count", "1", "--port", &port]);
        assert!(code != 0 && err.contains("error["), "{hold}: {err}");
    }
}

/// What a register is, by a look at it.
fn read(folder: &TempDir, port: &str, device: &str) -> i64 {
    let (out, _) = check(folder, &["monitor", device, "--count", "1", "--port", port], 0);
    out.trim().rsplit('=').next().unwrap().parse().unwrap()
}
