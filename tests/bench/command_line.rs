//! `rungwise check`, and the size of the program.

use super::figures::{Figures, Table};
use super::programs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How much is checked, in bytes.
const BYTES: usize = 10_000_000;

pub fn measure(table: &Table) {
    let folder = std::env::temp_dir().join(format!("rungwise-bench-{}", std::process::id()));
    for name in ["one", "many"] {
        std::fs::create_dir_all(folder.join(name)).expect("a folder for programs");
        // No model has the memory for so much.
        let manifest = "target = \"fx3u\"\n[rules]\nprogram-too-large = \"off\"\n";
        std::fs::write(folder.join(name).join("rungwise.toml"), manifest).expect("a manifest is written");
    }
    let text = programs::program_of_bytes(BYTES);
    std::fs::write(folder.join("one/one.il"), &text).expect("a program is written");
    let share = programs::program_of_bytes(BYTES / 20);
    for number in 0..20 {
        std::fs::write(folder.join(format!("many/{number}.il")), &share).expect("a program is written");
    }
    check(table, "check of 10 MB of il in one file", &folder.join("one/one.il"));
    check(table, "check of 10 MB of il in 20 files", &folder.join("many"));
    std::fs::remove_dir_all(&folder).expect("the folder is removed");
    let name = "size of the program";
    if table.wants(name) {
        let bytes = std::fs::metadata(super::server()).expect("the program is there").len();
        table.value(name, "< 15 MB", &format!("{:.1} MB", bytes as f64 / 1e6));
    }
}

fn check(table: &Table, name: &str, path: &Path) {
    if !table.wants(name) {
        return;
    }
    let figures = Figures::of(7, |_| {
        let started = Instant::now();
        let status = Command::new(super::server())
            .arg("check")
            .arg(path)
            .stdout(Stdio::null())
            .status()
            .expect("the program starts");
        assert!(status.success(), "the programs have no mistakes");
        started.elapsed()
    });
    table.row(name, "", &figures);
    let rate = |duration: Duration| BYTES as f64 / 1e6 / duration.as_secs_f64();
    table.value(&format!("{name}, rate"), "> 50 MB/s", &format!("{:.0} MB/s", rate(figures.percentile(50))));
}
