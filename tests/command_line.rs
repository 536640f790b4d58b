//! The command line beyond check and fmt: SARIF, diffs, colours, completions, recordings, imports, Markdown.

use crate::binary::{command, folder, run};
use serde_json::{Value, json};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// Both streams of a command that must end with `code`.
fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    assert!(!err.contains("panicked"), "{err}");
    (out, err)
}

#[test]
fn sarif_has_the_form_of_the_standard() {
    let files =
        folder(&[("wrong file.il", "LD X8\nOUT Y0\nEND\n"), ("open.lad", "|  X0     |\n+--| |-   |\n")]);
    let (out, _) = check(&files, &["check", "--format", "sarif", "."], 1);
    // These types are generated from the schema of OASIS.
    let log: serde_sarif::sarif::Sarif = serde_json::from_str(&out).unwrap();
    let run = &log.runs[0];
    let results = run.results.as_ref().unwrap();
    assert!(results.len() >= 2, "{out}");
    let rules = run.tool.driver.rules.as_ref().unwrap();
    for result in results {
        let index = usize::try_from(result.rule_index.unwrap()).unwrap();
        assert_eq!(Some(&rules[index].id), result.rule_id.as_ref());
        assert!(rules[index].help.as_ref().unwrap().text.len() > 40);
    }
    let log: Value = serde_json::from_str(&out).unwrap();
    let octal = log["runs"][0]["results"].as_array().unwrap();
    let octal = octal.iter().find(|result| result["ruleId"] == "octal-digit").unwrap();
    let place = &octal["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "wrong%20file.il");
    assert_eq!(place["region"], json!({"startLine": 1, "startColumn": 4, "endLine": 1, "endColumn": 6}));
    let change = &octal["fixes"][0]["artifactChanges"][0];
    assert_eq!(change["replacements"][0]["insertedContent"]["text"], "X10");
    assert_eq!(log["version"], "2.1.0");
    let related = log["runs"][0]["results"].as_array().unwrap().iter();
    assert!(related.clone().all(|result| result["level"] == "error" || result["level"] == "warning"));
    let clean = folder(&[("a.il", "LD X0\nOUT Y0\nEND\n")]);
    let (out, _) = check(&clean, &["check", "--format", "sarif"], 0);
    serde_json::from_str::<serde_sarif::sarif::Sarif>(&out).unwrap();
}

#[test]
fn sarif_names_the_file_of_a_related_place() {
    let unit = |name: &str| format!("PROGRAM {name}\nVAR\n a : BOOL;\nEND_VAR\nLD a\nST a\nEND_PROGRAM\n");
    let files = folder(&[
        ("rungwise.toml", "name = \"line\"\n"),
        ("a.il", &unit("same")),
        ("b.il", &format!("\n\n{}", unit("same"))),
    ]);
    let (out, _) = check(&files, &["check", "--format", "sarif", "."], 1);
    let log: Value = serde_json::from_str(&out).unwrap();
    let [found] = log["runs"][0]["results"].as_array().unwrap().as_slice() else { panic!("{out}") };
    let (place, related) = (&found["locations"][0], &found["relatedLocations"][0]);
    assert_eq!(place["physicalLocation"]["artifactLocation"]["uri"], "b.il");
    assert_eq!(place["physicalLocation"]["region"]["startLine"], 3);
    assert_eq!(related["physicalLocation"]["artifactLocation"]["uri"], "a.il");
    assert_eq!(
        related["physicalLocation"]["region"],
        json!({"startLine": 1, "startColumn": 9, "endLine": 1, "endColumn": 13})
    );
}

#[test]
fn fmt_check_shows_a_diff_that_patch_applies() {
    let files = folder(&[("a.il", "ld x0\nout y0\nend"), ("b.il", "LD X0\nOUT Y0\nEND\n")]);
    let (out, _) = check(&files, &["fmt", "--check"], 1);
    let expected = "--- a.il\n+++ a.il\n@@ -1,3 +1,3 @@\n-ld x0\n-out y0\n-end\n\\ No newline at end of file\n\
                    +LD X0\n+OUT Y0\n+END\n";
    let out = out.replace("./a.il", "a.il");
    assert_eq!(out, expected);
    assert_eq!(std::fs::read_to_string(files.path().join("a.il")).unwrap(), "ld x0\nout y0\nend");
}

#[test]
fn colours_follow_the_option_and_a_pipe_has_none() {
    let files = folder(&[("a.il", "ld x8\nout y0\nend\n")]);
    for verb in [&["check", "a.il"][..], &["fmt", "--check", "a.il"]] {
        let with = |option: &str| check(&files, &[verb, &["--color", option]].concat(), 1).0;
        assert!(with("always").contains("\x1b["), "{verb:?}");
        for option in ["never", "auto"] {
            assert!(!with(option).contains('\x1b'), "{verb:?} {option}");
        }
    }
    check(&files, &["check", "--color", "sometimes"], 2);
}

/// The tool `script` of Linux runs a command on a terminal.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_has_colours_unless_no_color_says_otherwise() {
    let files = folder(&[("a.il", "ld x8\nout y0\nend\n")]);
    let shown = |no_color: Option<&str>| {
        let mut command = Command::new("script");
        let line = format!("{} check a.il", env!("CARGO_BIN_EXE_rungwise"));
        command.current_dir(files.path()).args(["-qec", &line, "/dev/null"]).stdin(Stdio::null());
        command.env_remove("NO_COLOR").envs(no_color.map(|value| ("NO_COLOR", value)));
        command.output().ok().map(|output| String::from_utf8_lossy(&output.stdout).into_owned())
    };
    for (no_color, coloured) in [(None, true), (Some(""), true), (Some("1"), false)] {
        let Some(shown) = shown(no_color) else {
            return crate::corpus::say_skipped("no tool `script`");
        };
        assert!(shown.contains("octal-digit"), "{shown}");
        assert_eq!(shown.contains('\x1b'), coloured, "{no_color:?}: {shown}");
    }
}

#[test]
fn completions_of_every_shell() {
    let files = folder(&[]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let (out, _) = check(&files, &["completions", shell], 0);
        assert!(out.contains("import") && out.contains("rungwise"), "{shell}: {out}");
    }
    check(&files, &["completions", "csh"], 2);
}

#[test]
fn a_file_that_is_named_twice_is_checked_once() {
    let files = folder(&[("a.il", "LD X8\nOUT Y0\nEND\n")]);
    let (out, _) = check(&files, &["check", "--format", "json", "a.il", "./a.il", "."], 1);
    let found: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(found["files"].as_array().unwrap().len(), 1, "{out}");
}

#[test]
fn a_target_of_another_dialect_is_refused() {
    let files = folder(&[("a.il", "LD X0\nOUT Y0\nEND\n")]);
    let (out, err) = check(&files, &["check", "--target", "iec", "a.il"], 2);
    assert_eq!(out, "");
    assert!(err.starts_with("error[target-refused]: a.il: written in the words of fx, which iec"), "{err}");
    assert!(err.contains("\n  help: "), "{err}");
    check(&files, &["check", "--target", "fx3u", "a.il"], 0);
}

const NATIVE: &str =
    "LDmicro0.1\nIO LIST\n    Xa at 3\nEND\nPROGRAM\nRUNG\n    CONTACTS Xa 0\n    COIL Yb 0 0 0\nEND\n";

#[test]
fn imports_are_written_and_what_is_lost_is_said() {
    let files = folder(&[("lamp.ld", NATIVE), ("rto.ld", &NATIVE.replace("COIL", "RTO Tr 5\n    COIL"))]);
    let (out, err) = check(&files, &["import", "lamp.ld", "-o", "lamp.lad"], 0);
    assert_eq!((out.as_str(), err.as_str()), ("lamp.lad: 1 rungs\n", ""));
    let text = std::fs::read_to_string(files.path().join("lamp.lad")).unwrap();
    assert!(text.contains("PROGRAM lamp\nVAR\n    Xa : BOOL; (* pin 3 *)\n"), "{text}");
    check(&files, &["check", "lamp.lad"], 0);
    let (out, err) = check(&files, &["import", "rto.ld"], 1);
    assert!(out.contains("LDMICRO_RTO"), "{out}");
    assert!(err.starts_with("warning[import-note]: rto.ld:8: RTO has no counterpart"), "{err}");
    let garbage = folder(&[("x.ld", "\u{0}\u{1}|+-")]);
    let (out, err) = check(&garbage, &["import", "x.ld"], 2);
    assert!(out.is_empty() && err.starts_with("error[unknown-format]: x.ld: "), "{err}");
    check(&garbage, &["import", "nowhere.ld"], 2);
    check(&files, &["import", "lamp.ld", "-o", "no/such/folder.lad"], 2);
}

const PUMP: &str = "# Pump\n\nText | here.\n\n```ladder\n+--[X0]--(Y0)--+\n```\n\n- item\n  ```il\n  ld x0\n  out y8\n  end\n  ```\n\n\
                    ```c\n+--[X0]\n```\n\n~~~il\r\nld x0\r\nout y0\r\nend\r\n~~~\n";

#[test]
fn programs_in_markdown_are_checked_and_formatted_each_by_itself() {
    let files = folder(&[("pump.md", PUMP), ("prose.md", "# Nothing\n\n```c\nx\n```\n")]);
    let (out, _) = check(&files, &["check", "pump.md"], 1);
    assert!(out.starts_with("pump.md:12:7: error[octal-digit]: "), "{out}");
    assert_eq!(out.matches("error[").count(), 1, "{out}");
    check(&files, &["fmt", "pump.md"], 0);
    let text = std::fs::read_to_string(files.path().join("pump.md")).unwrap();
    let (before, rest) = text.split_once("```ladder\n").unwrap();
    assert_eq!(before, "# Pump\n\nText | here.\n\n");
    assert!(
        rest.starts_with("|   X0  ") && rest.contains("( )-+\n```\n\n- item\n  ```il\n  ld x0\n"),
        "{text}"
    );
    assert!(text.contains("```c\n+--[X0]\n```\n\n~~~il\r\nLD X0\r\nOUT Y0\r\nEND\r\n~~~\n"), "{text}");
    assert_eq!(check(&files, &["fmt", "--check", "pump.md"], 0).0, "");
    // Only a text that is named is looked into.
    check(&files, &["check", "prose.md"], 2);
}

#[test]
fn a_session_is_recorded_and_played_again() {
    let files = folder(&[]);
    let path = files.path().join("log.jsonl");
    let mut client = crate::lsp_client::Client::spawn_with(&["--mirror", path.to_str().unwrap()]);
    client.request("initialize", json!({"processId": null, "rootUri": null, "capabilities": {}}));
    client.notify("initialized", json!({}));
    let item =
        json!({"uri": "file:///a.il", "languageId": "plc-il", "version": 1, "text": "LD X8\nOUT Y0\nEND\n"});
    client.notify("textDocument/didOpen", json!({"textDocument": item}));
    let place = json!({"textDocument": {"uri": "file:///a.il"}, "position": {"line": 1, "character": 1}});
    let hover = client.request("textDocument/hover", place)["result"].clone();
    drop(client);
    let recording = std::fs::read_to_string(&path).unwrap();
    let entries: Vec<Value> = recording.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(entries.iter().all(|entry| entry["ms"].is_u64()), "{recording}");
    let methods: Vec<&str> = entries.iter().filter_map(|entry| entry["message"]["method"].as_str()).collect();
    assert_eq!(methods[..4], ["initialize", "initialized", "textDocument/didOpen", "textDocument/hover"]);
    let (out, _) = check(&files, &["lsp", "--replay", "log.jsonl"], 0);
    let bodies: Vec<Value> = out
        .split("Content-Length: ")
        .skip(1)
        .map(|frame| serde_json::from_str(frame.split_once("\r\n\r\n").unwrap().1).unwrap())
        .collect();
    assert!(bodies.iter().any(|body| body["result"] == hover), "{out}");
    let published = bodies.iter().any(|body| body["method"] == "textDocument/publishDiagnostics");
    assert!(published && bodies.iter().any(|body| body["result"]["capabilities"].is_object()), "{out}");
    std::fs::write(&path, "no json\n").unwrap();
    let (_, err) = check(&files, &["lsp", "--replay", "log.jsonl"], 2);
    assert!(err.starts_with("error[unreadable-input]: line 1 of the recording"), "{err}");
    check(&files, &["lsp", "--replay", "nowhere"], 2);
    check(&files, &["lsp", "--mirror", "no/such/folder"], 2);
}

#[test]
fn files_keep_their_encoding_mark_and_line_ends() {
    let text = "ld x0 // 电机\r\nout y0\r\nend\r\n";
    let utf16 = |little: bool| -> Vec<u8> {
        let units = std::iter::once(0xfeff).chain(text.encode_utf16());
        units.flat_map(|unit: u16| if little { unit.to_le_bytes() } else { unit.to_be_bytes() }).collect()
    };
    let gbk = b"ld x0 // \xb5\xe7\xbb\xfa\r\nout y0\r\nend\r\n".to_vec();
    let decoded = |bytes: &[u8]| match bytes {
        [0xff, 0xfe, rest @ ..] => encoding_rs::UTF_16LE.decode_without_bom_handling(rest).0.into_owned(),
        [0xfe, 0xff, rest @ ..] => encoding_rs::UTF_16BE.decode_without_bom_handling(rest).0.into_owned(),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8(rest.to_vec()).unwrap(),
        bytes => encoding_rs::GBK.decode_without_bom_handling(bytes).0.into_owned(),
    };
    let marked = format!("\u{feff}{text}").into_bytes();
    for (name, bytes) in
        [("le.il", utf16(true)), ("be.il", utf16(false)), ("gbk.il", gbk), ("mark.il", marked)]
    {
        let files = folder(&[]);
        let path = files.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let (_, err) = check(&files, &["check", name], 0);
        assert_eq!(err, "", "{name}");
        check(&files, &["fmt", name], 0);
        let written = std::fs::read(&path).unwrap();
        assert_eq!(written[..2] == bytes[..2], name != "gbk.il", "{name}");
        let formatted = decoded(&written);
        assert!(
            formatted.starts_with("LD X0") && formatted.contains("电机\r\nOUT Y0\r\n"),
            "{name}: {formatted}"
        );
        let stdout = command(files.path(), &["fmt", "--stdout", name]).output().unwrap().stdout;
        assert_eq!(stdout, written, "{name}");
    }
}

/// A mistake in the manifest is one of the manifest, told at the value with what belongs there.
#[test]
fn a_mistake_in_the_manifest_is_told_at_its_value() {
    let folder = folder(&[
        ("rungwise.toml", "target = \"iec\"\n\n[translate]\ntarget = \"fx9\"\n"),
        ("a.il", "LD a\nST b\n"),
    ]);
    for verb in [&["check", "."][..], &["translate", "a.il", "--to", "fx"], &["usage", "a.il"]] {
        let (code, _, err) = run(&folder, verb);
        assert_eq!(code, 2, "{err}");
        assert!(err.starts_with("error[manifest]: "), "{err}");
        let place = "rungwise.toml:4:11: `fx9` is no model of the FX family; fx1s, fx1n, fx2n and fx3u are\n";
        assert!(err.contains(place) && err.contains("help: mend the manifest"), "{err}");
    }
    let (_, _, err) = run(&folder, &["check", ".", "--lang", "zh-CN"]);
    assert!(err.contains("请改正清单文件"), "{err}");
}
