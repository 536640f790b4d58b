//! # device-comments
//!
//! A line of the device comments file cannot be used as it stands: its first field is no device, a device or a symbol
//! stands twice, a symbol is the name of a device or an instruction, or the PLC has no such device.
//! Such a line says one thing to the reader of the program and another thing, or nothing, to the PLC.
//!
//! The file is named by `comments` in `rungwise.toml`. Each line has a device, a symbol and a comment, parted by
//! commas, semicolons or tabs; programs may write the symbol in place of the device:
//!
//! ```csv
//! X0,Start,green button
//! X1,Stop,red button
//! Y0,Motor,contactor K1
//! ```
//!
//! In this one the second line names X0 again, the symbol of the third is a device, and X9 is none:
//!
//! ```csv
//! X0,Start,green button
//! X0,Stop,red button
//! ^^
//! Y0,M1,contactor K1
//!    ^^
//! X9,Spare,
//! ^^
//! ```
//!
//! The program itself is not affected:
//!
//! ```fx
//! LD X0
//! OUT Y0
//! END
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "device-comments",
    severity: Severity::Warning,
    run: Run::WhileReading,
    source: include_str!("device_comments.rs"),
};
