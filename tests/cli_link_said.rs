//! What the verbs of the programming port say by the way: questions, backups, what is shown of a program, and of a look.

use crate::binary::{command, folder, run};
use crate::virtual_plc::VirtualPlc;
use tempfile::TempDir;

const MOTOR: &str = "LD X0\nOUT Y0\nEND\n";
const OTHER: &str = "LDI X0\nOUT Y1\nEND\n";
const DRAWN: &str = "     X0          Y0\n|----| |---------( )---|\n\n|--------------[END]---|\n";

fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    (out, err)
}

#[test]
fn what_has_no_name_is_said_so() {
    let folder = folder(&[]);
    let plc = VirtualPlc::start(folder.path(), &[]);
    for arguments in [["force", "=1"], ["write", " =5"]] {
        let (_, err) = check(&folder, &[&arguments[..], &["--port", &plc.port]].concat(), 2);
        assert!(err.contains("no device is named before the `=`"), "{err}");
    }
}

#[test]
fn a_newer_backup_that_cannot_be_read_is_not_passed_over_in_silence() {
    let folder = folder(&[("motor.il", MOTOR), ("other.il", OTHER)]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    check(&folder, &["download", "other.il", "--yes", "--port", &plc.port], 0);
    let (_, err) = check(&folder, &["download", "--rollback", "--dry-run", "--port", &plc.port], 1);
    assert!(!err.contains("unreadable-backup"), "{err}");
    std::fs::write(folder.path().join(".rungwise/backup/29990101T000000.000Z-fx2n.json"), "{ torn").unwrap();
    let (_, err) = check(&folder, &["download", "--rollback", "--dry-run", "--port", &plc.port], 1);
    assert!(
        err.contains("warning[unreadable-backup]") && err.contains("29990101T000000.000Z-fx2n.json"),
        "{err}"
    );
    assert!(err.contains("help: ") && err.contains("back to"), "{err}");
}

#[test]
fn what_changes_is_drawn_for_a_drawing() {
    let folder = folder(&[("motor.lad", DRAWN), ("other.il", OTHER), ("motor.il", MOTOR)]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "other.il"]);
    let (out, _) = check(&folder, &["download", "motor.lad", "--dry-run", "--port", &plc.port], 1);
    let has = |sign: char, word: &str| out.lines().any(|line| line.starts_with(sign) && line.contains(word));
    assert!(has('-', "|/|") && has('-', "Y1") && has('+', "| |") && has('+', "Y0"), "{out}");
    assert!(!out.contains("LDI"), "{out}");
    let (drawn, _) = check(&folder, &["verify", "motor.lad", "--port", &plc.port], 1);
    assert_eq!(drawn, out);
    let (list, _) = check(&folder, &["verify", "motor.il", "--port", &plc.port], 1);
    assert!(list.contains("-LDI X0") && list.contains("+OUT Y0"), "{list}");
}

#[test]
fn a_look_of_several_exchanges_says_so() {
    let folder = folder(&[]);
    let plc = VirtualPlc::start(folder.path(), &["--baud", "115200"]);
    let devices = |count: usize| (0..count).map(|number| format!("D{number}")).collect::<Vec<_>>();
    let monitor = |count| {
        let devices = devices(count);
        let names = devices.iter().map(String::as_str);
        let arguments: Vec<&str> =
            ["monitor"].into_iter().chain(names).chain(["--count", "1", "--port", &plc.port]).collect();
        check(&folder, &arguments, 0)
    };
    let (out, err) = monitor(32);
    assert!(!err.contains("exchanges"), "{err}");
    // Tenths of a millisecond.
    let time = out.split(" ms").next().unwrap();
    assert!(time.split_once('.').is_some_and(|(_, digits)| digits.len() == 1), "{out}");
    let (_, err) = monitor(65);
    assert!(err.contains("come in 3 exchanges, so they may be of 3 scans"), "{err}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_question() {
    use rungwise::link::transport::pty;
    use std::io::{BufRead, BufReader, Read};
    use std::process::Stdio;
    let folder = folder(&[("motor.il", MOTOR), ("other.il", OTHER)]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    for arguments in [["download", "other.il"], ["start", "--timeout=1s"]] {
        let (_own, name, _other) = pty().unwrap();
        let terminal = std::fs::OpenOptions::new().read(true).write(true).open(&name).unwrap();
        let mut asked = command(folder.path(), &[&arguments[..], &["--port", &plc.port]].concat());
        let asked = asked.stdin(terminal).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut asked = asked.spawn().unwrap();
        let mut err = BufReader::new(asked.stderr.take().unwrap());
        let mut question = Vec::new();
        err.read_until(b'?', &mut question).unwrap();
        let process = asked.id().to_string();
        assert!(std::process::Command::new("kill").args(["-INT", &process]).status().unwrap().success());
        let mut rest = String::new();
        err.read_to_string(&mut rest).unwrap();
        assert_eq!(asked.wait().unwrap().code(), Some(1), "{rest}");
        assert!(rest.contains("cancelled"), "{rest}");
    }
    check(&folder, &["verify", "motor.il", "--port", &plc.port], 0);
}
