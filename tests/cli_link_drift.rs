//! `rungwise monitor` tells whether the program in the PLC is the one that should be there, and when it changes.

use crate::binary::{command, folder, run};
use crate::virtual_plc::{VirtualPlc, shared};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Lines};
use std::process::{Child, ChildStdout, Stdio};
use tempfile::TempDir;

/// The second has the words of the first in another order, so that their sums are the same.
const FILES: &[(&str, &str)] = &[
    ("motor.il", "LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND\n"),
    ("crossed.il", "LD X1\nOUT Y0\nLD X0\nOUT Y1\nEND\n"),
    ("other.il", "LDI X0\nOUT Y5\nEND\n"),
];

/// The request for the sum of the program.
#[cfg(unix)]
const SUM: &str = "E01800202";

fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    (out, err)
}

/// A `rungwise monitor` that goes on.
struct Monitor {
    child: Child,
    lines: Lines<BufReader<ChildStdout>>,
}

impl Monitor {
    fn start(folder: &TempDir, arguments: &[&str]) -> Monitor {
        // Should nothing be told, it ends.
        let mut command = command(folder.path(), &[&["monitor", "--for", "60s"], arguments].concat());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        Monitor { child, lines }
    }

    /// The next line that is about the program.
    fn told(&mut self) -> String {
        let is_told = |line: &String| line.contains("program");
        self.lines.by_ref().map_while(Result::ok).find(is_told).expect("it goes on")
    }

    #[cfg(unix)]
    fn ended(mut self) -> Option<i32> {
        let process = self.child.id().to_string();
        assert!(std::process::Command::new("kill").args(["-INT", &process]).status().unwrap().success());
        self.child.wait().unwrap().code()
    }
}

impl Drop for Monitor {
    fn drop(&mut self) {
        // It may be over already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn download(folder: &TempDir, file: &str, port: &str) {
    check(folder, &["download", file, "--yes", "--start", "--port", port], 0);
}

#[cfg(unix)]
#[test]
fn a_program_that_somebody_replaces_is_told_while_it_is_watched() {
    let folder = folder(FILES);
    let plc = VirtualPlc::start(folder.path(), &["--program", "other.il"]);
    let port = shared(plc.address(), |_| false);
    let mut monitor = Monitor::start(&folder, &["Y0", "--program", "motor.il", "--port", &port]);
    let told = monitor.told();
    assert!(told.contains("is not that of motor.il") && told.contains("verify motor.il"), "{told}");
    download(&folder, "motor.il", &port);
    assert!(monitor.told().contains("is that of motor.il"));
    // Its sum is the same when it is written, so something else is there in between.
    check(&folder, &["stop", "--port", &port], 0);
    check(&folder, &["clear", "--yes", "--port", &port], 0);
    assert!(monitor.told().contains("is not that of motor.il"));
    download(&folder, "crossed.il", &port);
    assert!(monitor.told().contains("is not that of motor.il"));
    assert_eq!(monitor.ended(), Some(1));
}

#[cfg(unix)]
#[test]
fn without_a_file_a_change_is_told() {
    let folder = folder(FILES);
    let plc = VirtualPlc::start(folder.path(), &["--program", "other.il"]);
    let (sender, seen) = std::sync::mpsc::channel();
    let port = shared(plc.address(), move |body| {
        if body == SUM {
            let _ = sender.send(());
        }
        false
    });
    let mut monitor = Monitor::start(&folder, &["Y0", "--format", "json", "--port", &port]);
    let first: Value = serde_json::from_str(&monitor.lines.next().unwrap().unwrap()).unwrap();
    assert_eq!(first["values"], json!({"Y0": false}));
    seen.recv().unwrap();
    let mut second =
        Monitor::start(&folder, &["Y0", "--program", "other.il", "--format", "json", "--port", &port]);
    let told: Value = serde_json::from_str(&second.told()).unwrap();
    assert_eq!(told["program"]["same"], json!(true), "{told}");
    download(&folder, "motor.il", &port);
    let (status, _) = check(&folder, &["status", "--format", "json", "--port", &port], 0);
    let status: Value = serde_json::from_str(&status).unwrap();
    let told: Value = serde_json::from_str(&monitor.told()).unwrap();
    assert!(told["time_ms"].is_u64(), "{told}");
    assert_eq!(told["program"], json!({"same": null, "sum": status["sum"]}));
    let told: Value = serde_json::from_str(&second.told()).unwrap();
    assert_eq!(told["program"], json!({"same": false, "sum": status["sum"]}));
    assert_eq!(monitor.ended(), Some(0));
    assert_eq!(second.ended(), Some(1));
}

#[test]
fn what_is_in_the_plc_is_compared_word_for_word() {
    let folder = folder(FILES);
    let plc = VirtualPlc::start(folder.path(), &["--program", "crossed.il"]);
    let look = |file: &str, count: &str, code| {
        let arguments = ["monitor", "Y0", "--program", file, "--count", count, "--port", &plc.port];
        check(&folder, &arguments, code)
    };
    let (out, err) = look("motor.il", "9", 1);
    assert!(out.contains("is not that of motor.il") && !err.contains("ended before"), "{out}{err}");
    let (out, err) = look("crossed.il", "9", 0);
    assert!(out.contains("is that of crossed.il") && !err.contains("ended before"), "{out}{err}");
    let (out, err) = look("crossed.il", "1", 0);
    assert!(!out.contains("program") && err.contains("ended before"), "{out}{err}");
    // Nothing but the program.
    let arguments = ["monitor", "--program", "crossed.il", "--count", "4", "--port", &plc.port];
    let (out, _) = check(&folder, &arguments, 0);
    assert!(out.contains("is that of crossed.il") && out.lines().count() == 1, "{out}");
}

#[test]
fn a_program_that_cannot_be_there_is_refused_before_anything_is_watched() {
    let folder = folder(FILES);
    let plc = VirtualPlc::start(folder.path(), &["--model", "fx1n"]);
    let arguments = ["monitor", "Y0", "--program", "motor.il", "--count", "1", "--port", &plc.port];
    let (out, err) = check(&folder, &arguments, 3);
    assert!(out.is_empty() && err.contains("error[wrong-model]"), "{out}{err}");
    let arguments = ["monitor", "Y0", "--program", "nowhere.il", "--port", &plc.port];
    let (_, err) = check(&folder, &arguments, 2);
    assert!(err.contains("nowhere.il"), "{err}");
}

#[test]
fn a_program_that_nobody_may_read_hinders_no_look_at_devices() {
    let folder = folder(FILES);
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let port = shared(plc.address(), |body| body.starts_with("E01805C"));
    let arguments = ["monitor", "Y0", "--program", "motor.il", "--count", "5", "--port", &port];
    let (out, err) = check(&folder, &arguments, 0);
    assert!(out.contains("Y0=") && out.contains("does not let its program be read"), "{out}{err}");
}
