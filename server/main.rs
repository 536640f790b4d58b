//! The binary `rungwise`; everything is in the library.

use std::process::ExitCode;

/// Reading is many small pieces of memory, got and given back by several threads, and an editor's server must give
/// back to the system what it does not need for long. This allocator does both better than the systems' own.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    rungwise::cli::run(std::env::args_os())
}
