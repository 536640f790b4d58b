//! What a CPU does.

/// What a CPU does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Mode {
    /// It waits.
    Stop,
    /// It runs the program.
    Run,
}

/// The switch on the PLC.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Switch {
    /// Only orders over the line let it run.
    Stop,
    /// It runs unless an order over the line has stopped it.
    Run,
}
