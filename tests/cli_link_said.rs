//! What the verbs of the programming port say by the way: questions, backups, what is shown of a program, and of a look.

use crate::binary::{command, folder, run};
use crate::virtual_plc::{Pass, VirtualPlc, proxy};
use rungwise::link::frame::framed;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::mpsc::channel;
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
fn a_rollback_leads_behind_what_a_download_left_though_the_sums_are_equal() {
    let fill: String = (0..60).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    let list = |[first, second]: [&str; 2], last: &str| {
        format!("LD {first}\nOUT Y0\nLD {second}\nOUT Y1\n{fill}LD {last}\nOUT Y5\nEND\n")
    };
    let (old, new) = (list(["X0", "X2"], "X5"), list(["X2", "X0"], "X6"));
    let folder = folder(&[("old.il", &old), ("new.il", &new)]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "old.il"]);
    let mut writes = 0;
    let cut = proxy(plc.address(), move |body| {
        writes += usize::from(body.starts_with("E11"));
        if writes > 1 { Pass::Cut } else { Pass::On }
    });
    check(&folder, &["download", "new.il", "--yes", "--port", &cut], 3);
    check(&folder, &["download", "new.il", "--yes", "--port", &plc.port], 0);
    check(&folder, &["download", "--rollback", "--yes", "--port", &plc.port], 0);
    check(&folder, &["verify", "old.il", "--port", &plc.port], 0);
    // All downloads have ended, so what is in the PLC is whole, whoever has written it.
    let kept = std::fs::read_dir(folder.path().join(".rungwise/backup")).unwrap().flatten();
    let kept: Vec<String> = kept.map(|file| std::fs::read_to_string(file.path()).unwrap()).collect();
    let count = |word: &str| kept.iter().filter(|kept| kept.contains(word)).count();
    assert_eq!((kept.len(), count("\"ended\": true")), (3, 3), "{kept:?}");
    assert_eq!(count("\"whole\": false"), 1, "{kept:?}");
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

/// What a PLC answers to a request for its parameters.
fn asked(address: &str, body: &str, digits: usize) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.write_all(&framed(body.as_bytes())).unwrap();
    let mut answer = vec![0; digits + 4];
    stream.read_exact(&mut answer).unwrap();
    String::from_utf8(answer[1..=digits].to_vec()).unwrap()
}

#[test]
fn title_and_latched_ranges_are_those_of_the_project() {
    let manifest =
        "files = [\"motor.il\"]\n[plc]\ntitle = \"PRESS 3\"\nlatch = [\"M0-M1023\", \"D100-D511\"]\n";
    let folder = folder(&[("motor.il", MOTOR), ("rungwise.toml", manifest)]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let (sender, written) = channel();
    let port = proxy(plc.address(), move |body| {
        if body.starts_with("E11") {
            sender.send(body.to_string()).unwrap();
        }
        Pass::On
    });
    let (_, err) = check(&folder, &["download", "--yes", "--port", &port], 0);
    assert!(err.contains("the title of the PLC becomes \"PRESS 3\"; it is \"\""), "{err}");
    assert!(err.contains("M0–M1023 are latched then; M500–M1023 are"), "{err}");
    // All of the parameters in two pieces, with a sum of 0, as the maker's tool writes them; nothing of the program.
    let title = "5052455353203320".to_string() + &"20".repeat(24);
    let first = "E118000400800000000000000".to_string() + &"20".repeat(8) + &title;
    let first = first + "0008FF0BF401E703640EC70EDC0EFF0E";
    let second = "E1180401CC800FE03".to_string() + &"0000".repeat(12);
    assert_eq!(written.try_iter().collect::<Vec<_>>(), [first, second]);
    let title = |port: &str| {
        let (out, _) = check(&folder, &["status", "--port", port, "--format", "json"], 0);
        serde_json::from_str::<serde_json::Value>(&out).unwrap()["title"].as_str().unwrap().to_string()
    };
    assert_eq!(title(&plc.port), "PRESS 3");
    assert_eq!(asked(plc.address(), "E01803004", 8), "0008FF0B");
    assert_eq!(asked(plc.address(), "E01804004", 8), "C800FE03");
    // There is nothing to do a second time; and all of it comes back.
    let (_, err) = check(&folder, &["download", "--dry-run", "--port", &plc.port], 0);
    assert!(err.contains("is the same") && !err.contains("latched"), "{err}");
    check(&folder, &["download", "--rollback", "--yes", "--port", &plc.port], 0);
    assert_eq!(title(&plc.port), "");
    assert_eq!(asked(plc.address(), "E01803004", 8), "F409FF0B");
}

#[test]
fn what_cannot_be_a_parameter_is_refused_in_the_manifest() {
    let plc = "port = \"tcp://127.0.0.1:1\"\nfiles = [\"motor.il\"]\n";
    for (target, own, word) in [
        ("fx2n", "title = \"a title that is longer than a PLC has place for\"", "at most 32 characters"),
        ("fx2n", "title = \"冲压\"", "at most 32 characters"),
        ("fx2n", "latch = [\"M0-M3071\"]", "no range that can be latched"),
        ("fx2n", "latch = [\"M9-M3\"]", "no range that can be latched"),
        ("fx2n", "latch = [\"C100-C220\"]", "no range that can be latched"),
        ("fx2n", "latch = [\"M0-M9\", \"M20-M30\"]", "a second range"),
        ("fx1n", "latch = [\"M0-M9\"]", "in an FX2N only"),
    ] {
        let manifest = format!("target = \"{target}\"\n{plc}[plc]\n{own}\n");
        let folder = folder(&[("motor.il", MOTOR), ("rungwise.toml", &manifest)]);
        let (_, err) = check(&folder, &["download", "--yes"], 2);
        assert!(err.contains(word) && err.contains("rungwise.toml:5:"), "{own}: {err}");
    }
}
