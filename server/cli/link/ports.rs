//! `rungwise ports`

use crate::cli::Outcome;
use crate::cli::input::{remark, say};
use crate::link::transport::ports;
use crate::text::{Language, Message};

/// Lists the serial ports of this computer.
pub(in crate::cli) fn run(language: Language) -> Outcome {
    let ports = ports();
    for port in &ports {
        say(format!("{}\t{}", port.name, port.description).trim_end());
        say("\n");
    }
    if ports.is_empty() {
        remark(&Message::new("link.no-ports").render(language));
    }
    Outcome::Clean
}
