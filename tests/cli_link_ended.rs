//! How the verbs of the programming port end: by Ctrl-C, by the system, by what cannot be written; and that nothing is
//! done by halves.

use crate::binary::{command, folder, run};
use crate::virtual_plc::VirtualPlc;
use std::io::{BufRead, BufReader};
use std::process::{Child, Stdio};
use tempfile::TempDir;

/// Both streams of a command that must end with `code`.
fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    assert!(!err.contains("panicked"), "{err}");
    (out, err)
}

const MOTOR: &str = "LD X0\nOUT Y0\nEND\n";

fn register(folder: &TempDir, port: &str, device: &str) -> i64 {
    let (out, _) = check(folder, &["monitor", device, "--count", "1", "--port", port], 0);
    out.trim().rsplit('=').next().unwrap().parse().unwrap()
}

#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    let process = child.id().to_string();
    assert!(std::process::Command::new("kill").args([name, &process]).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn whoever_watches_is_told_what_is_no_longer_held_however_that_ends() {
    let folder = folder(&[]);
    let plc = VirtualPlc::start(folder.path(), &[]);
    for (name, interval) in [("-INT", "1h"), ("-TERM", "1ms"), ("-HUP", "1h")] {
        let arguments = [
            "monitor",
            "D0",
            "--hold",
            "D0=4",
            "--interval",
            interval,
            "--trace",
            "seen.csv",
            "--port",
            &plc.port,
        ];
        let mut watching = command(folder.path(), &arguments);
        let mut watching = watching.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // The first look has been.
        let mut first = String::new();
        BufReader::new(watching.stdout.take().unwrap()).read_line(&mut first).unwrap();
        signal(&watching, name);
        let ended = watching.wait_with_output().unwrap();
        let err = String::from_utf8(ended.stderr).unwrap();
        assert_eq!(ended.status.code(), Some(0), "{name}: {err}");
        assert!(err.contains("no longer held") && err.contains("D0=4"), "{name}: {err}");
        let seen = std::fs::read_to_string(folder.path().join("seen.csv")).unwrap();
        assert!(seen.lines().nth(1).is_some_and(|line| line.ends_with(",4")), "{name}: {seen}");
        std::fs::remove_file(folder.path().join("seen.csv")).unwrap();
    }
}

#[test]
fn of_several_values_all_are_written_or_none() {
    let folder = folder(&[]);
    let plc = VirtualPlc::start(folder.path(), &[]);
    let port = plc.port.as_str();
    for wrong in ["M8037=1", "D8300=1", "D1=5@1h", "D1=70000", "Y0=maybe"] {
        let (code, _, err) = run(&folder, &["write", "D0=7", wrong, "--port", port]);
        assert!((1..=2).contains(&code) && err.contains("error["), "{wrong}: {err}");
        let hold = ["monitor", "D0", "--count", "1", "--hold", "D0=7", "--hold", wrong, "--port", port];
        let (code, _, err) = run(&folder, &hold);
        assert!((1..=2).contains(&code) && err.contains("error["), "{wrong}: {err}");
        assert_eq!(register(&folder, port, "D0"), 0, "{wrong}");
    }
}

#[test]
fn a_file_that_cannot_be_written_is_told_before_anything_is_watched() {
    let folder = folder(&[("kept.csv", "as it was")]);
    let plc = VirtualPlc::start(folder.path(), &[]);
    let monitor = ["monitor", "D0", "--count", "1", "--hold", "D0=3", "--port", &plc.port, "--trace"];
    let (out, err) = check(&folder, &[&monitor[..], &["none/seen.csv"]].concat(), 2);
    assert!(out.is_empty() && err.contains("error[unwritable]"), "{out}{err}");
    assert_eq!(register(&folder, &plc.port, "D0"), 0, "nothing was held");
    // What there was is lost only when there is something in its place.
    let (_, err) = check(&folder, &["monitor", "Q1", "--trace", "kept.csv", "--port", &plc.port], 2);
    assert!(err.contains("no-device"), "{err}");
    assert_eq!(std::fs::read_to_string(folder.path().join("kept.csv")).unwrap(), "as it was");
}

#[test]
fn what_stands_behind_end_makes_no_other_program() {
    let folder = folder(&[("more.il", &format!("{MOTOR}LD X1\nOUT Y1\nEND\n"))]);
    let plc = VirtualPlc::start(folder.path(), &[]);
    let (_, err) = check(&folder, &["download", "more.il", "--yes", "--port", &plc.port], 0);
    assert!(err.contains("3 steps: "), "{err}");
    check(&folder, &["verify", "more.il", "--port", &plc.port], 0);
    let (out, _) = check(&folder, &["status", "more.il", "--port", &plc.port], 0);
    assert!(out.contains("is the same"), "{out}");
}

#[cfg(unix)]
#[test]
fn a_plc_that_is_ended_keeps_what_it_was_told_last() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let start = || VirtualPlc::start(folder.path(), &["--state", "memory.json"]);
    for (number, name) in [(1, "-INT"), (2, "-TERM")] {
        let mut plc = start();
        let port = plc.port.clone();
        check(&folder, &["write", &format!("D300={number}"), "--port", &port], 0);
        signal(plc.process(), name);
        assert_eq!(plc.ended(), Some(0), "{name}");
        let plc = start();
        assert_eq!(register(&folder, &plc.port, "D300"), number, "{name}");
    }
    // A program that was found to be right is there even if the process is killed.
    let mut plc = start();
    check(&folder, &["download", "motor.il", "--yes", "--port", &plc.port], 0);
    signal(plc.process(), "-KILL");
    plc.ended();
    let plc = start();
    check(&folder, &["verify", "motor.il", "--port", &plc.port], 0);
}

#[test]
fn the_memory_of_a_plc_is_not_lost_to_another_one_or_to_a_folder_that_is_gone() {
    let folder = folder(&[("motor.il", MOTOR), ("small/rungwise.toml", "target = \"fx1s\"\n")]);
    std::fs::copy(folder.path().join("motor.il"), folder.path().join("small/motor.il")).unwrap();
    let state = ["--state", "kept/memory.json"];
    let plc = ["plc", "--listen", "127.0.0.1:0"];
    let (_, err) = check(&folder, &[&plc[..], &state].concat(), 2);
    assert!(err.contains("error[unwritable]") && err.contains("kept"), "{err}");
    std::fs::create_dir(folder.path().join("kept")).unwrap();
    assert_eq!(VirtualPlc::start(folder.path(), &state).quit(), Some(0));
    let memory = || std::fs::read_to_string(folder.path().join("kept/memory.json")).unwrap();
    let before = memory();
    for other in [["--model", "fx1n"], ["--program", "small"]] {
        let (_, err) = check(&folder, &[&plc[..], &state, &other].concat(), 2);
        assert!(err.contains("error[bad-state]") && err.contains("FX2N"), "{err}");
        assert_eq!(memory(), before);
    }
    // What cannot be kept for a while is kept later.
    let plc = VirtualPlc::start(folder.path(), &[&state[..], &["--switch", "stop"]].concat());
    std::fs::remove_dir_all(folder.path().join("kept")).unwrap();
    check(&folder, &["download", "motor.il", "--yes", "--port", &plc.port], 0);
    std::fs::create_dir(folder.path().join("kept")).unwrap();
    assert_eq!(plc.quit(), Some(0));
    assert_ne!(memory(), before);
    let plc = VirtualPlc::start(folder.path(), &state);
    check(&folder, &["verify", "motor.il", "--port", &plc.port], 0);
}

#[test]
fn the_longest_delay_is_none_that_stops_the_plc() {
    let folder = folder(&[]);
    let mut plc = VirtualPlc::start(folder.path(), &["--faults", "delay=1:9223372036.85s"]);
    let (_, err) = check(&folder, &["status", "--timeout", "50ms", "--port", &plc.port], 3);
    assert!(err.contains("no-answer"), "{err}");
    assert_eq!(plc.ask("M8000"), "M8000 = 1");
}
