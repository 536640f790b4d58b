//! The walls of the house: which room may use which, how files are named, how long they grow.

use std::path::{Path, PathBuf};

/// Rooms by floor. A room uses rooms on floors below its own, and nothing beside it.
const FLOORS: &[(&str, u8)] = &[
    ("text", 0),
    ("target", 1),
    ("il", 2),
    ("ladder", 2),
    ("machine_code", 3),
    ("document", 3),
    ("logic", 4),
    ("translate", 5),
    ("check", 6),
    ("simulate", 6),
    ("scenario", 7),
    ("project", 7),
    ("link", 7),
    ("ide", 8),
    ("lsp", 9),
    ("dap", 9),
    ("cli", 10),
];

/// Words that only some rooms may know.
const RESERVED: &[(&str, &[&str])] = &[
    ("tower_lsp::", &["lsp"]),
    ("std::time::Instant", &["lsp", "dap", "cli", "link"]),
    ("std::time::SystemTime", &["lsp", "cli"]),
    ("std::fs", &["project", "cli"]),
    ("std::net", &["link"]),
    ("serialport", &["link"]),
    ("std::env", &["cli"]),
    ("tokio", &["lsp", "cli"]),
];

/// Guides, not gates, say 500 lines; this is the gate.
const FILE_LINES: usize = 700;

/// All Rust files of the server.
pub fn source_files() -> Vec<PathBuf> {
    files_below(&root().join("server"), "rs")
}

#[test]
fn rooms_look_downwards_only() {
    let broken: Vec<String> =
        source_files().iter().flat_map(|path| walls_broken(&room_of(path), &read(path))).collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn the_wall_test_sees_a_broken_wall() {
    for (room, text) in [
        ("il", "use crate::ladder::Graph;"),
        ("text", "fn f(x: crate::target::Device) {}"),
        ("check", "use crate::{ide, text};"),
        ("ide", "use tower_lsp::ls_types::Uri;"),
        ("document", "let now = std::time::Instant::now();"),
        ("check", "use std::fs;"),
        ("ladder", "use super::super::il::fx;"),
    ] {
        assert!(!walls_broken(room, text).is_empty(), "`{text}` in {room} passes");
    }
    assert!(walls_broken("lsp", "use crate::ide; use tower_lsp::Client; // crate::cli is above").is_empty());
}

#[test]
fn files_are_named_after_rules_and_of_bearable_length() {
    let mut wrong = Vec::new();
    for path in source_files() {
        let text = read(&path);
        let code = text.split("tests {").next().unwrap_or("");
        let lines = code.lines().filter(|line| !line.trim_start().starts_with("//!")).count();
        if lines > FILE_LINES {
            wrong.push(format!("{}: {lines} lines", path.display()));
        }
        for (number, line) in text.lines().enumerate().filter(|(_, line)| line.chars().count() > 120) {
            wrong.push(format!("{}:{}: {} columns", path.display(), number + 1, line.chars().count()));
        }
        if let Some(code) = text.split("code: \"").nth(1).and_then(|rest| rest.split('"').next())
            && text.contains("const RULE: Rule")
            && path.file_stem().is_none_or(|stem| stem.to_string_lossy().replace('_', "-") != code)
        {
            wrong.push(format!("{}: holds the rule {code}", path.display()));
        }
        if !text.starts_with("//!") {
            wrong.push(format!("{}: does not say what it is for", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The room of a file: its folder below `server`, or its own name.
fn room_of(path: &Path) -> String {
    let below = path.strip_prefix(root().join("server")).unwrap();
    below.components().next().unwrap().as_os_str().to_string_lossy().trim_end_matches(".rs").to_string()
}

fn walls_broken(room: &str, text: &str) -> Vec<String> {
    let floor = |name: &str| FLOORS.iter().find(|(room, _)| *room == name).map(|(_, floor)| *floor);
    let code: String = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .map(|line| line.split(" // ").next().unwrap_or(""))
        .collect::<Vec<_>>()
        .join("\n");
    let mut broken = Vec::new();
    for rest in code.split("crate::").skip(1) {
        let names = match rest.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap_or("").split(',').map(first_name).collect(),
            None => vec![first_name(rest)],
        };
        for name in names {
            if let (Some(own), Some(other)) = (floor(room), floor(name))
                && name != room
                && other >= own
            {
                broken.push(format!("{room} uses {name}"));
            }
        }
    }
    for (word, rooms) in RESERVED {
        if floor(room).is_some() && code.contains(word) && !rooms.contains(&room) {
            broken.push(format!("{room} uses {word}"));
        }
    }
    for (other, _) in FLOORS.iter().filter(|(other, _)| *other != room) {
        if code.contains(&format!("super::super::{other}::")) || code.contains(&format!("super::{other}::")) {
            // A module of the same name inside the room is no wall.
            let own = root().join("server").join(room).join(other);
            if !own.exists() && !own.with_extension("rs").exists() {
                broken.push(format!("{room} reaches {other} through super"));
            }
        }
    }
    broken
}

fn first_name(path: &str) -> &str {
    let path = path.trim();
    path.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or("")
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn files_below(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path, ending));
        } else if path.extension().is_some_and(|end| end == ending) {
            files.push(path);
        }
    }
    files.sort();
    files
}
