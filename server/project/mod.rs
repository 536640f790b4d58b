//! Projects: the manifest `rungwise.toml` and the files that belong to it.

mod manifest;
pub use manifest::{FormatSettings, FormatStyle, MOST_WIDTH, Manifest, ManifestError, TaskSettings};

mod plc;
pub use plc::PlcSettings;

mod comments;
pub use comments::{CommentsFile, decode};

mod files;
pub use files::{
    MANIFEST_NAME, MOST_FILE_BYTES, MOST_FILES, MOST_PROJECT_BYTES, Project, decide, is_program_file,
    is_suite_file, is_table_file, names_in, open_document, program_files, projects_in, suite_files,
    suites_in,
};

mod around;
pub use around::Surroundings;

pub mod encoding;

mod backup;
pub use backup::{Backup, Origin};

mod disk;
pub use disk::{Stamp, read_text};
