//! The bytes that the fuzzer kept, and every example, hold what the fuzz targets say.

use std::path::{Path, PathBuf};

#[path = "../fuzz/bodies.rs"]
mod bodies;

fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|reason| panic!("{}: {reason}", folder.display()));
    entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_file()).collect()
}

#[test]
fn the_kept_bytes_hold() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus");
    for (name, holds) in bodies::TARGETS {
        let files = files_in(&corpus.join(name));
        assert!(files.len() > 3, "{name}: only {} files", files.len());
        for file in files {
            let bytes = std::fs::read(&file).unwrap();
            println!("{}", file.display());
            holds(&bytes);
        }
    }
}
