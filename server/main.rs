//! The binary `rungwise`; everything is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    rungwise::cli::run(std::env::args_os())
}
