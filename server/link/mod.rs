//! The programming port of the FX family: what a host and a PLC say to each other on a serial line.
//!
//! `frame` makes requests and replies of bytes, `command` says which there are, `address` where devices lie. `Line` is
//! the host's end, over a `Transport`; `procedure` has what a host does with many requests. `plc` is the other end: a
//! PLC without hardware, which runs in the simulator what was downloaded into it.

pub mod frame;

mod address;
pub use address::{Address, Addressed, BitAddress, Extended, Lying, Map, Part, Plain, Program};

mod command;
pub use command::{Command, Expected, Reply, Space, Speed};

mod error;
pub use error::LinkError;

pub mod transport;
pub use transport::Transport;

mod line;
pub use line::{Line, Patience};

mod mode;
pub use mode::{Mode, Switch};

mod host;
pub use host::{
    Comparison, DownloadFailure, Drift, DriftNews, Fate, Holds, Host, Identity, NamesOfPlc, Plan, Point,
    Progress, Report, Stage, Status, StatusError, Uploaded, Watch,
};

mod logbook;
pub use logbook::{Logbook, USUAL_CHANGES};

pub mod plc;
