//! Names without letter case.

use smol_str::{SmolStr, StrExt};

/// `name` as programs compare names: in lower case. Short names, which most are, take no memory of their own.
pub fn folded(name: &str) -> SmolStr {
    if name.is_ascii() { name.to_ascii_lowercase_smolstr() } else { SmolStr::from(name.to_lowercase()) }
}
