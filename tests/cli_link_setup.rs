//! Setting up a line to a PLC, through the binary: what each cause is called, that its exit code is 3, and what helps.

use crate::binary::{command, folder, run};
use crate::virtual_plc::VirtualPlc;
use rungwise::link::frame::{ACK, Arrival, Frames, framed};
use rungwise::link::transport::ports;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::process::Output;
use tempfile::TempDir;

/// Standard error of a command that must end with exit code 3, this word, and this in what helps.
fn check_failed((code, out, err): (i32, String, String), word: &str, help: &str) -> String {
    assert_eq!(code, 3, "{out}\n{err}");
    assert!(err.contains(&format!("error[{word}]: ")), "{err}");
    let told = err.lines().find_map(|line| line.trim_start().strip_prefix("help: ")).unwrap();
    assert!(told.contains(help), "{err}");
    assert!(!err.contains("panicked"), "{err}");
    err
}

fn programs() -> TempDir {
    let long: String = (0..60).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    folder(&[("motor.il", "LD X0\nOUT Y0\nEND\n"), ("long.il", &format!("{long}END\n"))])
}

/// The verbs that call a PLC.
const VERBS: [&[&str]; 9] = [
    &["status"],
    &["download", "motor.il", "--yes"],
    &["verify", "motor.il"],
    &["upload"],
    &["monitor", "Y0"],
    &["start", "--yes"],
    &["stop"],
    &["write", "D0=1"],
    &["force", "M0=on"],
];

#[test]
fn something_that_answers_and_is_no_fx() {
    let folder = programs();
    for verb in VERBS {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = format!("tcp://{}", listener.local_addr().unwrap());
        let answering = std::thread::spawn(move || {
            let (mut host, _) = listener.accept().unwrap();
            let (mut frames, mut byte) = (Frames::default(), [0]);
            while let Ok(1) = host.read(&mut byte) {
                let answer = match frames.take(byte[0]) {
                    Some(Arrival::Enquiry) => vec![ACK],
                    Some(Arrival::Body(body)) => {
                        // Whatever is read: D8001 is 40100, as no FX says.
                        let length =
                            usize::from_str_radix(std::str::from_utf8(&body[5..]).unwrap(), 16).unwrap();
                        framed("A49C".repeat(length).get(..2 * length).unwrap().as_bytes())
                    }
                    _ => continue,
                };
                host.write_all(&answer).unwrap();
            }
        });
        let err = check_failed(run(&folder, &[verb, &["--port", &port]].concat()), "unknown-plc", "FX2N");
        assert!(err.contains("40100"), "{err}");
        answering.join().unwrap();
    }
}

#[cfg(unix)]
mod on_a_terminal {
    use super::*;
    use rungwise::link::transport::{SerialTransport, pty};
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    use std::os::unix::process::CommandExt;
    use std::path::Path;

    #[test]
    fn a_port_that_somebody_else_has_open() {
        let folder = programs();
        let (_own, name, other) = pty().unwrap();
        drop(other);
        let _somebody = SerialTransport::open(&name).unwrap();
        for verb in VERBS {
            let ended = run(&folder, &[verb, &["--port", &name]].concat());
            let err = check_failed(ended, "port-in-use", "close the other program");
            assert!(err.contains(&name), "{err}");
        }
    }

    #[test]
    fn a_port_that_the_user_may_not_open() {
        let folder = programs();
        let allow =
            |path: &Path, mode| std::fs::set_permissions(path, PermissionsExt::from_mode(mode)).unwrap();
        allow(folder.path(), 0o755);
        let port = folder.path().join("ttyUSB0");
        std::fs::write(&port, "").unwrap();
        allow(&port, 0o000);
        for verb in VERBS {
            let mut asked = command(folder.path(), &[verb, &["--port", port.to_str().unwrap()]].concat());
            // Nothing is forbidden to the superuser.
            if std::fs::metadata(&port).unwrap().uid() == 0 {
                asked.uid(65_534).gid(65_534);
            }
            let Output { status, stdout, stderr } = asked.output().unwrap();
            let [out, err] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
            let err = check_failed((status.code().unwrap(), out, err), "port-forbidden", "dialout");
            assert!(err.contains("ttyUSB0"), "{err}");
        }
    }

    /// What the system says of a terminal.
    fn settings(name: &str) -> String {
        let flag = if cfg!(target_os = "linux") { "-F" } else { "-f" };
        let said = std::process::Command::new("stty").args([flag, name, "-a"]).output().unwrap();
        String::from_utf8(said.stdout).unwrap()
    }

    /// Of what is set a pseudo terminal keeps the check of parity, the stop bit and what makes it transparent; it has
    /// always eight bits, no parity and a speed of its own, so those are looked at where they are asked for.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_serial_port_is_set_as_a_programming_port() {
        let (_own, name, _other) = pty().unwrap();
        let _opened = SerialTransport::open(&name).unwrap();
        let said = settings(&name);
        for word in [" inpck", "-ignpar", "-cstopb", " cread", "-crtscts", "-ixon", "-icanon", "-echo "] {
            assert!(said.contains(word), "{word}: {said}");
        }
        let asked = SerialTransport::settings(&name);
        let wanted = serialport::new(&name, 9600)
            .data_bits(serialport::DataBits::Seven)
            .parity(serialport::Parity::Even)
            .stop_bits(serialport::StopBits::One)
            .flow_control(serialport::FlowControl::None);
        assert_eq!(asked.timeout(std::time::Duration::ZERO), wanted);
    }
}

#[test]
fn the_ports_of_this_computer_are_listed() {
    let folder = programs();
    let (code, out, err) = run(&folder, &["ports"]);
    assert_eq!(code, 0, "{err}");
    let listed: Vec<&str> = out.lines().map(|line| line.split('\t').next().unwrap()).collect();
    let known = ports();
    assert_eq!(listed, known.iter().map(|port| port.name.as_str()).collect::<Vec<_>>());
    assert!(known.is_sorted_by_key(|port| &port.name));
    assert_eq!(err.contains("no serial port"), known.is_empty(), "{err}");
}

/// Faults that are certain: what each of them looks like from the other end.
#[test]
fn each_kind_of_fault_is_told() {
    let folder = programs();
    for (faults, words) in [
        ("flip=1", &["line-noise", "no-answer"][..]),
        ("drop=1", &["no-answer"]),
        ("nak=1", &["plc-occupied"]),
        ("delay=1:30s", &["no-answer"]),
        ("disconnect=1", &["line-gone"]),
    ] {
        let plc = VirtualPlc::start(folder.path(), &["--faults", faults]);
        let (code, out, err) = run(&folder, &["status", "--port", &plc.port, "--timeout", "100ms"]);
        assert_eq!(code, 3, "{faults}: {out}{err}");
        assert!(words.iter().any(|word| err.contains(&format!("error[{word}]"))), "{faults}: {err}");
        assert!(err.contains("help: "), "{faults}: {err}");
    }
}

/// Faults that come and go: the job is done beside them, and what is in the PLC is right.
#[test]
fn what_is_downloaded_beside_faults_is_right() {
    let folder = programs();
    for faults in ["flip=0.001,seed=1", "nak=0.2,seed=2", "duplicate=0.002,seed=3", "delay=0.001:50ms,seed=4"]
    {
        let plc = VirtualPlc::start(folder.path(), &["--faults", faults]);
        let verb = |arguments: &[&str]| {
            let line = ["--port", &plc.port, "--timeout", "300ms"];
            // Whoever fails says so, and may try again.
            let tries = (0..50).map(|_| run(&folder, &[arguments, &line].concat()));
            let ended =
                tries.inspect(|(code, out, err)| assert!([0, 1, 3].contains(code), "{faults}: {out}{err}"));
            ended.into_iter().find(|(code, _, _)| *code != 3).expect(faults)
        };
        for program in ["long.il", "motor.il"] {
            let (code, _, err) = verb(&["download", program, "--yes"]);
            assert!(code == 0 && err.contains("read back and compared"), "{faults}: {err}");
            assert_eq!(verb(&["verify", program]).0, 0, "{faults}");
        }
        assert_eq!(verb(&["verify", "long.il"]).0, 1, "{faults}");
    }
}
