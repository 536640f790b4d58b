//! The virtual PLC: answers on a line as an FX does, and runs in the simulator what it was sent.
//!
//! Time is an argument here too. `serve` has the clock, and what bytes travel over.

mod cpu;
pub use cpu::Plc;

mod memory;

mod saved;
pub use saved::Saved;

mod server;
pub use server::{Answer, Server};

mod faults;
pub use faults::{Faults, Wire};

mod serve;
pub use serve::{Listener, Service};
