//! The command line as scripts meet it: the real binary, its exit codes, its streams and its JSON.

use crate::binary::{command, folder};
use serde_json::{Value, json};
use std::process::{Output, Stdio};
use tempfile::TempDir;

const CLEAN: &str = "LD X0\nOUT Y0\nEND\n";
const WRONG: &str = "LD X8\nOUT Y0\nEND\n";
const HINTED: &str = "P0\nLD X0\nOUT Y0\nEND\n";

fn rungwise(folder: &TempDir, arguments: &[&str]) -> Output {
    command(folder.path(), arguments).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The exit code and both streams, which no failure may leave a panic in.
fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let output = rungwise(folder, arguments);
    let (out, err) = (stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(code), "{arguments:?}\n{out}\n{err}");
    assert!(!err.contains("panicked") && !err.contains("RUST_BACKTRACE"), "{err}");
    if code == 2 {
        assert!(out.is_empty() && err.starts_with("error"), "{arguments:?}: {out}{err}");
    }
    (out, err)
}

#[test]
fn exit_codes_of_check() {
    let files = folder(&[("clean.il", CLEAN), ("wrong.il", WRONG)]);
    let (out, err) = check(&files, &["check", "clean.il"], 0);
    assert_eq!((out.as_str(), err.as_str()), ("check passed: 1 rung, 3 of 8000 steps\n", ""));
    let (out, err) = check(&files, &["check", "wrong.il"], 1);
    assert!(out.starts_with("wrong.il:1:4: error[octal-digit]: "), "{out}");
    assert!(out.contains("1 | LD X8\n") && out.contains("   ^^\n"), "{out}");
    assert!(out.ends_with("check failed: 1 error, 0 warnings, 0 hints; 1 rung, 3 of 8000 steps\n"), "{out}");
    assert_eq!(err, "");
    check(&files, &["check"], 1);
    check(&files, &["check", "clean.il", "wrong.il"], 1);
}

#[test]
fn unusable_input_is_told_on_standard_error_with_help() {
    let files = folder(&[("notes.txt", ""), ("empty/readme.md", ""), ("clean.il", CLEAN)]);
    for arguments in [
        &["check", "missing.il"][..],
        &["check", "notes.txt"],
        &["check", "empty"],
        &["check", "clean.il", "missing.il"],
        &["fmt", "missing.il"],
        &["fmt", "empty"],
        &["explain", "no-such-rule"],
    ] {
        let (_, err) = check(&files, arguments, 2);
        assert!(err.starts_with("error[") && err.contains("\n  help: "), "{arguments:?}: {err}");
    }
    for arguments in [
        &[][..],
        &["chekc"],
        &["check", "--deny", "everything"],
        &["check", "--target", "s7"],
        &["check", "--format", "xml"],
        &["fmt", "--check", "--stdout"],
        &["fmt", "--style", "round"],
        &["--lang", "tlh", "check"],
    ] {
        let output = rungwise(&files, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{arguments:?}");
    }
}

#[test]
fn deny_says_what_fails() {
    let warning = "LD X0\nOUT Y0\nEND\nLD X1\nOUT Y1\n";
    let files = folder(&[("wrong.il", WRONG), ("warning.il", warning), ("hint.il", HINTED)]);
    let severity = |file: &str| {
        let output = rungwise(&files, &["check", "--format", "json", file]);
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        found["files"][0]["diagnostics"][0]["severity"].as_str().unwrap_or("none").to_string()
    };
    for (file, word, codes) in [
        ("wrong.il", "error", [1, 1, 1]),
        ("warning.il", "warning", [0, 1, 1]),
        ("hint.il", "hint", [0, 0, 1]),
    ] {
        assert_eq!(severity(file), word, "{file}");
        for (deny, code) in ["error", "warning", "hint"].into_iter().zip(codes) {
            check(&files, &["check", "--deny", deny, file], code);
        }
        check(&files, &["check", file], codes[1]);
    }
}

#[test]
fn json_of_check_has_exactly_its_shape() {
    let files = folder(&[("wrong.il", "(* 电机😀 *) LD X8\nOUT Y0\nEND\n")]);
    let output = rungwise(&files, &["check", "--format", "json", "wrong.il"]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(1), ""));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(keys(&found), ["files", "summary"]);
    let file = &found["files"][0];
    assert_eq!((&file["path"], &file["rungs"], &file["steps"]), (&json!("wrong.il"), &json!(1), &json!(3)));
    let diagnostic = &file["diagnostics"][0];
    assert_eq!(keys(diagnostic), ["code", "fixes", "message", "range", "related", "severity"]);
    // Columns count characters from 1: an astral character is one.
    let range = json!({"start": {"line": 1, "column": 14}, "end": {"line": 1, "column": 16}});
    assert_eq!((&diagnostic["range"], &diagnostic["code"]), (&range, &json!("octal-digit")));
    let edit = json!({"path": "wrong.il", "range": range, "text": "X10"});
    assert_eq!(diagnostic["fixes"][0]["edits"], json!([edit]));
    assert_eq!(keys(&diagnostic["fixes"][0]), ["edits", "title"]);
    let summary = &found["summary"];
    assert_eq!(
        (&summary["errors"], &summary["warnings"], &summary["hints"]),
        (&json!(1), &json!(0), &json!(0))
    );
    assert_eq!((&summary["steps"], &summary["capacity"]), (&json!(3), &json!(8000)));
}

#[test]
fn the_target_of_the_command_line_counts_before_the_project() {
    let files = folder(&[("rungwise.toml", "target = \"fx3u\"\n"), ("a.il", "LD M5000\nOUT Y0\nEND\n")]);
    check(&files, &["check"], 0);
    let (out, _) = check(&files, &["check", "--target", "fx1s"], 1);
    assert!(out.contains("error[device-out-of-range]"), "{out}");
}

#[test]
fn folders_projects_and_their_mistakes() {
    let files = folder(&[
        ("one/rungwise.toml", "target = \"fx1s\"\n[rules]\nmissing-end = \"off\"\n"),
        ("one/b.il", "LD X0\nOUT Y0\n"),
        ("one/.hidden.il", "@@@"),
        ("one/.cache.il/x.il", "@@@"),
        ("two/rungwise.toml", "name = \"电\"\ntarget = \"fx9\"\n"),
        ("two/c.il", CLEAN),
        ("three/rungwise.toml", "files = [\"gone.il\"]\n"),
        ("four/rungwise.toml", "[format]\nwidth = 4000000000\n"),
        ("four/d.lad", "+--[X0]--(Y0)--+\n"),
    ]);
    for path in ["one", "one/rungwise.toml", "one/b.il"] {
        check(&files, &["check", path], 0);
    }
    for path in ["two", "two/c.il", "two/rungwise.toml"] {
        let (_, err) = check(&files, &["check", path], 2);
        assert!(err.contains("rungwise.toml:2:11: ") && err.contains("fx9"), "{err}");
    }
    check(&files, &["check", "three"], 2);
    let (_, err) = check(&files, &["fmt", "four"], 2);
    assert!(err.contains("rungwise.toml:2:9: "), "{err}");
    std::fs::write(files.path().join("two/rungwise.toml"), b"name = \"\xff\"").unwrap();
    let (_, err) = check(&files, &["check", "two/c.il"], 2);
    assert!(err.contains("cannot be read"), "{err}");
}

#[test]
fn what_is_not_utf8_is_checked_with_a_word_and_never_written() {
    let files = folder(&[]);
    let path = files.path().join("torn.il");
    let bytes = b"ld x0 // \xff\xb5\xff\nout y0\nend\n";
    std::fs::write(&path, bytes).unwrap();
    let (_, err) = check(&files, &["check", "torn.il"], 0);
    assert!(err.starts_with("warning[not-utf-8]: torn.il") && err.contains("help: "), "{err}");
    for arguments in
        [&["fmt", "torn.il"][..], &["fmt", "--check", "torn.il"], &["fmt", "--stdout", "torn.il"]]
    {
        check(&files, arguments, 2);
    }
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
}

#[test]
fn garbage_is_found_fault_with_and_nothing_worse() {
    let files = folder(&[]);
    let mut bytes: Vec<u8> =
        (0..6_000u32).map(|number| (number.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    for name in ["a.il", "b.lad"] {
        std::fs::write(files.path().join(name), &bytes).unwrap();
        check(&files, &["check", name], 1);
    }
    bytes.retain(|byte| *byte != b'\n');
    std::fs::write(files.path().join("c.lad"), &bytes).unwrap();
    check(&files, &["check", "c.lad"], 1);
}

#[test]
fn only_the_first_findings_of_a_file_are_drawn() {
    let files = folder(&[("a.il", &"LD X8\nOUT Y0\n".repeat(1000))]);
    let (out, _) = check(&files, &["check", "a.il"], 1);
    assert_eq!(out.matches("error[octal-digit]").count(), 1000);
    assert_eq!(out.matches(" ^^\n").count(), 200);
}

#[test]
fn formatting_checks_shows_and_writes() {
    let files = folder(&[("a.il", "ld x0\nout   y0\nend\n"), ("b.il", CLEAN)]);
    let read = |name: &str| std::fs::read_to_string(files.path().join(name)).unwrap();
    let before = read("a.il");
    let (out, _) = check(&files, &["fmt", "--check", "."], 1);
    assert!(out.starts_with("--- ./a.il\n+++ ./a.il\n") && !out.contains("b.il"), "{out}");
    let (shown, _) = check(&files, &["fmt", "--stdout", "a.il"], 0);
    assert_ne!(shown, before);
    assert_eq!(read("a.il"), before);
    let (out, _) = check(&files, &["fmt", "a.il", "b.il"], 0);
    assert_eq!((out.as_str(), read("a.il")), ("a.il\n", shown));
    check(&files, &["fmt", "--check"], 0);
    assert_eq!(check(&files, &["fmt"], 0).0, "");
    assert_eq!(std::fs::read_dir(files.path()).unwrap().count(), 2, "nothing is left over");
}

#[test]
fn ladder_is_drawn_in_the_style_asked_for() {
    let files = folder(&[("a.lad", "+--[X0]--(Y0)--+\n")]);
    for (style, sign) in [("iec", "| |"), ("brackets", "[X0]"), ("unicode", "┤ ├")] {
        let (out, _) = check(&files, &["fmt", "--stdout", "--style", style, "a.lad"], 0);
        assert!(out.contains(sign), "{style}:\n{out}");
    }
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_read_only_files_left_alone() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let files = folder(&[("real.il", "ld x0\nout y0\nend\n"), ("fixed.il", "ld x0\nout y0\nend\n")]);
    let path = |name: &str| files.path().join(name);
    symlink("real.il", path("link.il")).unwrap();
    symlink("nowhere.il", path("dangling.txt")).unwrap();
    check(&files, &["fmt", "link.il"], 0);
    assert!(path("link.il").is_symlink());
    assert!(std::fs::read_to_string(path("real.il")).unwrap().starts_with("LD"));
    std::fs::set_permissions(path("fixed.il"), PermissionsExt::from_mode(0o444)).unwrap();
    let (_, err) = check(&files, &["fmt", "fixed.il"], 2);
    assert!(err.starts_with("error[unwritable]: fixed.il: "), "{err}");
    assert!(std::fs::read_to_string(path("fixed.il")).unwrap().starts_with("ld"));
    // A link to a folder is not walked into, which would not end in a circle.
    symlink(".", path("circle")).unwrap();
    symlink(".", path("circle.il")).unwrap();
    check(&files, &["check"], 0);
}

#[cfg(unix)]
#[test]
fn a_reader_that_went_away_is_no_failure_and_a_full_disk_is() {
    let files = folder(&[("a.il", &"LD X8\nOUT Y0\n".repeat(3000))]);
    let mut child =
        command(files.path(), &["check"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(1), ""));
    let Ok(full) = std::fs::File::options().write(true).open("/dev/full") else { return };
    let output = command(files.path(), &["check"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).starts_with("error[unwritable-output]: "), "{}", stderr(&output));
}

#[test]
fn no_colours_in_a_pipe() {
    let files = folder(&[("a.il", WRONG)]);
    for value in ["", "1"] {
        let output = command(files.path(), &["check"]).env("NO_COLOR", value).output().unwrap();
        assert!(!stdout(&output).contains('\x1b'));
    }
}

#[test]
fn explain_knows_rules_and_the_words_of_both_dialects() {
    let files = folder(&[]);
    for (word, title) in [
        ("open-circuit", "# open-circuit"),
        ("MOV", "MOV"),
        ("dmovp", "MOV"),
        ("LDN", "LD"),
        ("TON", "TON"),
        ("LIMIT", "LIMIT"),
    ] {
        let (out, err) = check(&files, &["explain", word], 0);
        assert!(out.contains(title) && err.is_empty(), "{word}:\n{out}");
    }
    let (out, _) = check(&files, &["explain"], 0);
    assert!(out.lines().count() == rungwise::check::RULES.len(), "{out}");
    let (_, err) = check(&files, &["explain", "circuit"], 2);
    assert!(err.contains("open-circuit") && err.contains("short-circuit"), "{err}");
}

#[test]
fn version_help_and_language() {
    let files = folder(&[("a.il", CLEAN)]);
    assert_eq!(check(&files, &["--version"], 0).0, format!("rungwise {}\n", env!("CARGO_PKG_VERSION")));
    let (help, _) = check(&files, &["--help"], 0);
    for verb in ["lsp", "check", "fmt", "explain"] {
        assert!(help.contains(&format!("  {verb} ")), "{help}");
    }
    for arguments in
        [&["--lang", "en", "check"][..], &["check", "--lang", "en"], &["explain", "MOV", "--lang", "en"]]
    {
        check(&files, arguments, 0);
    }
    let output = rungwise(&files, &["check", "--lang", "fr"]);
    let refusal = stderr(&output);
    assert!(refusal.contains("'fr'") && refusal.contains("messages are in en, zh-CN"), "{refusal}");
}

#[test]
fn a_rung_that_stays_as_it_was_drawn_is_told_with_its_reason() {
    let bridge = crate::drawing_redrawn::BRIDGES[0];
    let framed = "\
┌──────────────────────────────────────────┐
│   X0          X1                Y0       │
│ ──┤ ├────┬────┤/├────────────────( )──── │
│   X2     │                               │
│ ──┤ ├────┘                               │
└──────────────────────────────────────────┘
";
    let files = folder(&[
        ("bridge.lad", &format!("|   X7      Y7  |\n+---| |-----( )-+\n\n{bridge}")),
        ("framed.lad", framed),
        ("comment.lad", "|   X0           Y0 |\n+---| |-(* c *)--( )-+\n"),
        ("open.lad", "|   X0      Y0  |\n+---| |--   ( )-+\n"),
        ("plain.lad", "|  X0     Y0  |\n+--| |----( )-+\n"),
        ("note.md", &format!("# Notes\n\n```ladder\n{bridge}```\n")),
    ]);
    for (name, line, reason) in [
        ("bridge.lad", 4, "it is neither series nor parallel"),
        ("framed.lad", 2, "such as a frame"),
        ("comment.lad", 1, "a comment stands in its midst"),
        ("open.lad", 1, "`rungwise check` shows it"),
        ("note.md", 4, "it is neither series nor parallel"),
    ] {
        let (_, err) = check(&files, &["fmt", "--stdout", name], 0);
        assert!(
            err.starts_with(&format!("{name}:{line}: this rung stays as it was drawn: ")),
            "{name}: {err}"
        );
        assert!(err.contains(reason) && err.lines().count() == 1, "{name}: {err}");
    }
    assert_eq!(check(&files, &["fmt", "--stdout", "plain.lad"], 0).1, "");
}
