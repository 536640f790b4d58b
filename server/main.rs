//! The binary `rungwise`; everything is in the library.

use std::process::ExitCode;

/// Parsing makes many small things on two threads, and what an answer used should go back to the system: the system's
/// allocator grows the memory of a second thread page by page and keeps what it once had.
#[cfg(not(windows))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    rungwise::cli::run(std::env::args_os())
}
