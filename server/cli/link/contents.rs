//! Programs for a PLC: from files of every kind, and from what was kept of it before a download.

use crate::cli::Outcome;
use crate::cli::encode::encoded;
use crate::cli::input::complain;
use crate::machine_code::executed;
use crate::project::Backup;
use crate::target::Target;
use crate::text::{Language, Message};
use std::path::Path;

/// The words of the program, or the backup, at `path` up to END, and the model that they are for.
///
/// # Errors
/// With the outcome, after complaints.
pub(super) fn words_at(path: &Path, language: Language) -> Result<(Vec<u16>, &'static Target), Outcome> {
    if !Backup::is_named_so(path) {
        let encoded = encoded(path, None, language)?;
        return Ok((executed(&encoded.words()).to_vec(), encoded.target));
    }
    let fault = Backup::fault(path);
    let backup = Backup::read(path).filter(|_| fault.is_none());
    let backup = backup.and_then(|backup| Some((backup.words, Target::named(&backup.model)?)));
    backup.ok_or_else(|| {
        let reason = Message::new("link.no-backup-file").with("path", path.display());
        let reason = reason.with("fault", fault.unwrap_or_default()).render(language);
        complain("bad-backup", &reason, &Message::new("link.help-backup").render(language), language);
        Outcome::Unusable
    })
}

/// Whether a file is a drawing, by its name.
pub(super) fn is_drawn(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("lad"))
}
