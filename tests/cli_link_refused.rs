//! What the verbs of the programming port say when something is not as it should be: the exit code, the word for
//! scripts, what helps, and in which state the PLC is.

use crate::binary::{command, folder, run};
use crate::virtual_plc::{Pass, VirtualPlc, proxy};
use rungwise::link::frame::{ACK, ENQ, framed};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::Stdio;
use tempfile::TempDir;

/// Standard error of a command that must end with `code` and say this word, with help.
fn refused(folder: &TempDir, arguments: &[&str], code: i32, word: &str) -> String {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    assert!(err.contains(&format!("error[{word}]: ")) && err.contains("help: "), "{arguments:?}\n{err}");
    assert!(!err.contains("panicked"), "{err}");
    err
}

fn check(folder: &TempDir, arguments: &[&str], code: i32) -> String {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    err
}

const MOTOR: &str = "LD X0\nOUT Y0\nEND\n";

fn programs() -> TempDir {
    let long: String = (0..200).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    let too_long: String = (0..4500).map(|n| format!("LD M{0}\nOUT M{0}\n", n % 1000)).collect();
    folder(&[
        ("motor.il", MOTOR),
        ("long.il", &format!("{long}END\n")),
        ("large.il", &format!("{too_long}END\n")),
        ("small/rungwise.toml", "target = \"fx1s\"\nfiles = [\"motor.il\"]\n"),
        ("small/motor.il", MOTOR),
        ("small-long/rungwise.toml", "target = \"fx1s\"\nfiles = [\"long.il\"]\n"),
        ("small-long/long.il", &format!("{long}END\n")),
    ])
}

/// Asks as a host does, without a library of hosts.
fn asked(stream: &mut TcpStream, bytes: &[u8]) -> u8 {
    stream.write_all(bytes).unwrap();
    let mut answer = [0];
    stream.read_exact(&mut answer).unwrap();
    answer[0]
}

#[test]
fn a_line_that_is_none() {
    let folder = programs();
    let verbs: [&[&str]; 5] = [
        &["status"],
        &["download", "motor.il", "--yes"],
        &["verify", "motor.il"],
        &["upload"],
        &["monitor", "Y0"],
    ];
    for verb in verbs {
        let err = refused(&folder, &[verb, &["--port", "/dev/none-of-this-name"]].concat(), 3, "no-port");
        assert!(err.contains("/dev/none-of-this-name") && err.contains("rungwise ports"), "{err}");
        let free = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let port = format!("tcp://{free}");
        refused(&folder, &[verb, &["--port", &port]].concat(), 3, "unreachable");
        refused(&folder, &[verb, &["--port", "tcp://no port"]].concat(), 3, "unreachable");
        // Nobody who listens reads or answers.
        let deaf = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = format!("tcp://{}", deaf.local_addr().unwrap());
        refused(&folder, &[verb, &["--port", &port, "--timeout", "100ms"]].concat(), 3, "no-answer");
        let (port, _) = noisy();
        let err = check(&folder, &[verb, &["--port", &port, "--timeout", "100ms"]].concat(), 3);
        assert!(["line-noise", "no-answer"].iter().any(|word| err.contains(word)), "{err}");
    }
}

/// Somebody who never stops sending.
fn noisy() -> (String, std::thread::JoinHandle<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("tcp://{}", listener.local_addr().unwrap());
    let sending = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let noise: Vec<u8> = (0..=255).cycle().take(4096).collect();
        while stream.write_all(&noise).is_ok() {}
    });
    (port, sending)
}

#[test]
fn a_second_host() {
    let folder = programs();
    let plc = VirtualPlc::start(folder.path(), &[]);
    let mut first = TcpStream::connect(plc.address()).unwrap();
    assert_eq!(asked(&mut first, &[ENQ]), ACK);
    refused(&folder, &["status", "--port", &plc.port], 3, "plc-occupied");
    assert_eq!(asked(&mut first, &[ENQ]), ACK, "the first one is served on");
    drop(first);
    check(&folder, &["status", "--port", &plc.port], 0);
}

#[test]
fn whoever_connects_again_at_once_is_served() {
    let folder = programs();
    let plc =
        VirtualPlc::start(folder.path(), &["--program", "large.il", "--memory", "16", "--scan-time", "1ms"]);
    for number in 0..300 {
        let mut host = TcpStream::connect(plc.address()).unwrap();
        assert_eq!(asked(&mut host, &[ENQ]), ACK, "{number}");
    }
}

#[test]
fn another_plc_than_the_program_is_for() {
    let folder = programs();
    let plc = VirtualPlc::start(folder.path(), &[]);
    let err = refused(&folder, &["download", "small", "--yes", "--port", &plc.port], 3, "wrong-model");
    assert!(err.contains("FX1S") && err.contains("FX2N"), "{err}");
    refused(&folder, &["verify", "small", "--port", &plc.port], 3, "wrong-model");
    let err = refused(&folder, &["download", "large.il", "--yes", "--port", &plc.port], 3, "too-large");
    assert!(err.contains("9001") && err.contains("8000"), "{err}");
    assert!(!folder.path().join(".rungwise").exists(), "nothing has begun");
}

#[test]
fn a_backup_of_a_plc_with_another_memory() {
    let folder = programs();
    let large = VirtualPlc::start(folder.path(), &["--program", "large.il", "--memory", "16"]);
    check(&folder, &["download", "motor.il", "--yes", "--port", &large.port], 0);
    let capacity = |port: &str| {
        let (_, out, _) = run(&folder, &["status", "--port", port, "--format", "json"]);
        serde_json::from_str::<serde_json::Value>(&out).unwrap()["capacity"].as_u64().unwrap()
    };
    // What it held does not fit elsewhere: nothing has begun then.
    let small = VirtualPlc::start(folder.path(), &["--program", "motor.il", "--memory", "4"]);
    let err = refused(&folder, &["download", "--rollback", "--yes", "--port", &small.port], 3, "too-large");
    assert!(err.contains("9001") && err.contains("4000"), "{err}");
    check(&folder, &["verify", "motor.il", "--port", &small.port], 0);
    assert!(run(&folder, &["status", "--port", &small.port]).1.contains("RUN"));
    // Back in its PLC it goes. What fits goes anywhere, and the memory stays what it is.
    check(&folder, &["download", "--rollback", "--yes", "--port", &large.port], 0);
    check(&folder, &["verify", "large.il", "--port", &large.port], 0);
    check(&folder, &["download", "--rollback", "--yes", "--port", &small.port], 0);
    check(&folder, &["verify", "motor.il", "--port", &small.port], 0);
    assert_eq!([capacity(&large.port), capacity(&small.port)], [16_000, 4_000]);
}

#[test]
fn a_keyword() {
    let folder = programs();
    let plc = VirtualPlc::start(folder.path(), &["--switch", "stop"]);
    let mut host = TcpStream::connect(plc.address()).unwrap();
    assert_eq!(asked(&mut host, &framed(b"E118008083132333435363738")), ACK);
    assert_eq!(asked(&mut host, &framed(b"B")), ACK);
    drop(host);
    let err = refused(&folder, &["download", "motor.il", "--yes", "--port", &plc.port], 3, "keyword");
    assert!(err.contains("does not break it"), "{err}");
}

#[test]
fn nobody_has_said_yes() {
    let folder = programs();
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il", "--switch", "stop"]);
    let port = plc.port.as_str();
    let err = refused(&folder, &["download", "long.il", "--start", "--port", port], 1, "not-confirmed");
    assert!(err.contains("--yes") && err.contains("may move"), "{err}");
    refused(&folder, &["start", "--port", port], 1, "not-confirmed");
    let err = refused(&folder, &["clear", "--port", port], 1, "not-confirmed");
    assert!(err.contains("FX2N (8000 steps of memory, sum ") && err.contains("comments"), "{err}");
    let err = refused(&folder, &["clear", "--devices", "--port", port], 1, "not-confirmed");
    assert!(err.contains("latched"), "{err}");
    check(&folder, &["verify", "motor.il", "--port", port], 0);
    assert!(run(&folder, &["status", "--port", port]).1.contains("STOP"));
}

#[test]
fn a_plc_that_runs_is_not_cleared() {
    let folder = programs();
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let port = plc.port.as_str();
    for devices in [&[][..], &["--devices"]] {
        let asked = [&["clear", "--yes", "--port", port], devices].concat();
        let err = refused(&folder, &asked, 1, "running");
        assert!(err.contains("`rungwise stop`"), "{err}");
    }
    check(&folder, &["verify", "motor.il", "--port", port], 0);
    check(&folder, &["stop", "--port", port], 0);
    check(&folder, &["clear", "--yes", "--port", port], 0);
}

#[test]
fn wrong_usage() {
    let folder = programs();
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let port = plc.port.as_str();
    refused(&folder, &["status"], 2, "no-port");
    refused(&folder, &["force", "D0=1", "--port", port], 2, "bad-value");
    refused(&folder, &["write", "D0=70000", "--port", port], 2, "bad-value");
    refused(&folder, &["write", "Q0=1", "--port", port], 2, "bad-value");
    refused(&folder, &["monitor", "Q0", "--port", port], 2, "no-device");
    refused(&folder, &["plc", "--faults", "drop=2"], 2, "bad-faults");
    refused(&folder, &["plc", "--model", "iec"], 2, "target-refused");
    refused(&folder, &["plc", "--listen", plc.address()], 2, "cannot-listen");
    std::fs::write(folder.path().join("there.il"), "").unwrap();
    refused(&folder, &["upload", "-o", "there.il", "--port", port], 2, "file-exists");
    std::fs::write(folder.path().join("no.json"), "{}").unwrap();
    refused(&folder, &["download", "no.json", "--yes", "--port", port], 2, "bad-backup");
    for wrong in [
        &["download", "motor.il", "--rollback", "--port", port][..],
        &["monitor", "--port", port],
        &["verify", "--port", port],
        &["status", "--port", port, "--timeout", "soon"],
        &["status", "--port", port, "--baud", "12345"],
        &["plc", "--pty", "--listen", "127.0.0.1:0"],
    ] {
        check(&folder, wrong, 2);
    }
    // The line behind a device server keeps its speed, so a PLC that changes its own would be lost.
    let err = refused(&folder, &["status", "--port", port, "--baud", "19200"], 1, "speed-elsewhere");
    assert!(err.contains("tcp://"), "{err}");
    check(&folder, &["status", "--port", port], 0);
    // A mistake in a program is a finding, and nothing is sent.
    std::fs::write(folder.path().join("wrong.il"), "LD X8\nOUT Y0\nEND\n").unwrap();
    let err = check(&folder, &["download", "wrong.il", "--yes", "--port", "tcp://127.0.0.1:1"], 1);
    assert!(err.contains("X8"), "{err}");
}

#[test]
fn whoever_lets_the_network_in_is_told_so() {
    let folder = programs();
    let mut plc = command(folder.path(), &["plc", "--listen", "0.0.0.0:0"]);
    let mut plc = plc.stdin(Stdio::piped()).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    plc.stdin.take().unwrap().write_all(b"quit\n").unwrap();
    let err = String::from_utf8(plc.wait_with_output().unwrap().stderr).unwrap();
    assert!(err.contains("open-to-all") && err.contains("127.0.0.1"), "{err}");
}

#[test]
fn a_plc_that_dies_under_a_download() {
    let folder = programs();
    // Before the first, the third and the last piece that is written.
    for pieces in [0, 2, 12] {
        let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
        let address = plc.address().to_string();
        let (mut plc, mut seen) = (Some(plc), 0);
        let port = proxy(&address, move |body| {
            seen += usize::from(body.starts_with("E11"));
            if seen <= pieces {
                return Pass::On;
            }
            // Killed, not switched off.
            drop(plc.take());
            Pass::Cut
        });
        let err = refused(&folder, &["download", "long.il", "--yes", "--port", &port], 3, "line-gone");
        let told =
            if pieces == 0 { "whether the PLC has written it is not known" } else { "written in part" };
        assert!(err.contains(told) && err.contains("runs or stands still is not known"), "{err}");
    }
    // The line only, so that the PLC keeps what it got; the second try finishes the job.
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let mut seen = 0;
    let port = proxy(plc.address(), move |body| {
        seen += usize::from(body.starts_with("E11"));
        if seen > 3 { Pass::Cut } else { Pass::On }
    });
    let err = refused(&folder, &["download", "long.il", "--yes", "--port", &port], 3, "line-gone");
    assert!(err.contains("written in part"), "{err}");
    check(&folder, &["start", "--yes", "--port", &plc.port], 1);
    // The way back leads to the same PLC, whatever of its program is there.
    let err = check(&folder, &["download", "--rollback", "--dry-run", "--port", &plc.port], 1);
    assert!(err.contains("back to") && !err.contains("other-plc"), "{err}");
    let err = check(&folder, &["download", "long.il", "--yes", "--start", "--port", &plc.port], 0);
    assert!(err.contains("the PLC runs"), "{err}");
    check(&folder, &["verify", "long.il", "--port", &plc.port], 0);
}

#[test]
fn a_line_with_faults_is_used_until_it_does() {
    let folder = programs();
    let faults = "disconnect=0.0002,drop=0.0003,seed=3";
    let plc = VirtualPlc::start(folder.path(), &["--model", "fx1s", "--faults", faults]);
    let (mut done, mut failures) = (0, 0);
    while done == 0 || failures == 0 {
        // One in the place of the other, so that there is always something to do.
        let program = ["small-long", "small"][done % 2];
        let arguments = ["download", program, "--yes", "--timeout", "300ms", "--port", &plc.port];
        match run(&folder, &arguments) {
            (0, _, err) => {
                assert!(err.contains("read back and compared"), "{err}");
                done += 1;
            }
            (3, _, err) => {
                assert!(err.contains("error[") && err.contains("help: "), "{err}");
                failures += 1;
            }
            (code, out, err) => panic!("{code}: {out}{err}"),
        }
        assert!(done + failures < 200, "{done} {failures}");
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_download_with_the_truth() {
    let folder = programs();
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let (tell, process) = std::sync::mpsc::channel::<u32>();
    let mut seen = 0;
    let port = proxy(plc.address(), move |body| {
        seen += usize::from(body.starts_with("E11"));
        if seen == 3 {
            seen += 1;
            // Before the request is answered; the download goes on for many requests more.
            let process = process.recv().unwrap().to_string();
            assert!(std::process::Command::new("kill").args(["-INT", &process]).status().unwrap().success());
        }
        Pass::On
    });
    let arguments = ["download", "long.il", "--yes", "--port", &port];
    let mut download = command(folder.path(), &arguments);
    let download = download.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    tell.send(download.id()).unwrap();
    let ended = download.wait_with_output().unwrap();
    let err = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(ended.status.code(), Some(1), "{err}");
    assert!(err.contains("cancelled") && err.contains("written in part"), "{err}");
    check(&folder, &["download", "long.il", "--yes", "--port", &plc.port], 0);
    check(&folder, &["verify", "long.il", "--port", &plc.port], 0);
}
