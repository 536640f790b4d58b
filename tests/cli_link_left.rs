//! What the verbs of the programming port leave as it is, and what they refuse or say of what was left to them.

use crate::binary::{command, folder, run};
use crate::virtual_plc::{Pass, VirtualPlc, proxy, shared};
use tempfile::TempDir;

const MOTOR: &str = "LD X0\nOUT Y0\nEND\n";

fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    (out, err)
}

#[test]
fn a_plc_that_has_the_program_goes_on() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let mut plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    // Whatever is running is not asked for, and nothing is kept of it.
    let (_, err) = check(&folder, &["download", "motor.il", "--port", &plc.port], 0);
    assert!(
        err.contains("is the same") && err.contains("0 bytes written") && err.contains("the PLC runs"),
        "{err}"
    );
    assert!(!folder.path().join(".rungwise").exists());
    assert_eq!(plc.ask("M8000"), "M8000 = 1");
    // Where it stands still it is started if that is asked, and stays as it is if not.
    check(&folder, &["stop", "--port", &plc.port], 0);
    let (_, err) = check(&folder, &["download", "motor.il", "--yes", "--port", &plc.port], 0);
    assert!(err.contains("the PLC stands still"), "{err}");
    let (_, err) = check(&folder, &["download", "motor.il", "--start", "--port", &plc.port], 1);
    assert!(err.contains("not-confirmed") && err.contains("Start the PLC?"), "{err}");
    let (_, err) = check(&folder, &["download", "motor.il", "--yes", "--start", "--port", &plc.port], 0);
    assert!(err.contains("the PLC runs"), "{err}");
}

#[test]
fn the_sum_of_an_upload_that_is_wrong_is_told() {
    let long: String = (0..60).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    let folder = folder(&[("motor.il", MOTOR), ("long.il", &format!("{long}END\n"))]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let (_, err) = check(&folder, &["upload", "--port", &plc.port], 0);
    assert!(!err.contains("warning"), "{err}");
    let mut writes = 0;
    let cut = proxy(plc.address(), move |body| {
        writes += usize::from(body.starts_with("E11"));
        if writes > 1 { Pass::Cut } else { Pass::On }
    });
    check(&folder, &["download", "long.il", "--yes", "--port", &cut], 3);
    let (out, err) = check(&folder, &["upload", "--port", &plc.port], 1);
    assert!(out.contains("LD") && err.contains("warning[sum]"), "{out}{err}");
}

#[test]
fn a_backup_that_makes_no_sense_is_refused_with_the_place() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let plc = VirtualPlc::start(folder.path(), &[]);
    check(&folder, &["download", "motor.il", "--yes", "--port", &plc.port], 0);
    let kept = std::fs::read_dir(folder.path().join(".rungwise/backup")).unwrap().next().unwrap().unwrap();
    let kept = std::fs::read_to_string(kept.path()).unwrap();
    let backup: serde_json::Value = serde_json::from_str(&kept).unwrap();
    let changed = |member: &str, value: serde_json::Value| {
        let mut backup = backup.clone();
        backup[member] = value;
        backup.to_string()
    };
    let download = ["download", "wrong.json", "--dry-run", "--port", &plc.port];
    for (text, place) in [
        (changed("model", "fx9".into()), "`model`"),
        (changed("parameters", vec![8; 3].into()), "`parameters`"),
        (changed("parameters", vec![0; 46].into()), "`parameters`"),
        (changed("words", vec![0; 9000].into()), "`words`"),
        (changed("steps", 7.into()), "`steps`"),
        (kept.replace("\"steps\"", "\"paces\""), "steps"),
        ("{\n torn".to_string(), "line 2"),
    ] {
        std::fs::write(folder.path().join("wrong.json"), text).unwrap();
        let (_, err) = check(&folder, &download, 2);
        assert!(err.contains("error[bad-backup]") && err.contains(place), "{place}: {err}");
    }
}

#[test]
fn what_a_virtual_plc_is_told_to_be_is_possible_and_stays_so() {
    let folder = folder(&[("motor.il", MOTOR), ("other.il", "LD X1\nOUT Y0\nEND\n")]);
    let (_, err) = check(&folder, &["plc", "--model", "fx1s", "--memory", "16"], 2);
    assert!(err.contains("error[memory-too-large]") && err.contains("at most 2 "), "{err}");
    let state = ["--state", "memory.json", "--program"];
    let plc = VirtualPlc::start(folder.path(), &[&state[..], &["motor.il"]].concat());
    // What it is nobody writes.
    check(&folder, &["write", "D8001=5", "--port", &plc.port], 0);
    let (out, _) = check(&folder, &["status", "--port", &plc.port], 0);
    assert!(out.contains("FX2N"), "{out}");
    assert_eq!(plc.quit(), Some(0));
    for (program, is_told) in [("motor.il", false), ("other.il", true)] {
        let arguments = ["plc", "--listen", "127.0.0.1:0", "--state", "memory.json", "--program", program];
        let mut plc = command(folder.path(), &arguments);
        let mut plc =
            plc.stdin(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
        std::io::Write::write_all(&mut plc.stdin.take().unwrap(), b"quit\n").unwrap();
        let err = String::from_utf8(plc.wait_with_output().unwrap().stderr).unwrap();
        assert_eq!(err.contains("memory.json gives way"), is_told, "{program}: {err}");
    }
}

#[test]
fn devices_of_a_plc_that_lets_nobody_read_its_parameters_are_watched() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let plc = VirtualPlc::start(folder.path(), &["--program", "motor.il"]);
    let port = shared(plc.address(), |body| body.starts_with("E018"));
    let arguments = ["monitor", "Y0", "--program", "motor.il", "--count", "2", "--port", &port];
    let (out, err) = check(&folder, &arguments, 0);
    assert!(out.contains("Y0=") && out.contains("does not let its program be read"), "{out}{err}");
}
