//! `rungwise completions`

use super::input::say;
use super::{Arguments as Everything, Outcome};
use clap::CommandFactory;
use clap_complete::Shell;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Everything::command(), "rungwise", &mut script);
    say(&String::from_utf8_lossy(&script));
    Outcome::Clean
}
