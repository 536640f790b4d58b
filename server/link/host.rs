//! What a host does with a PLC, each in many requests: who it is, what it has, what it is to do.

mod identity;
pub use identity::Identity;

mod point;
pub use point::{NamesOfPlc, Point};

mod devices;

mod watch;
pub use watch::Watch;

mod holds;
pub use holds::Holds;

mod control;

mod status;
pub use status::{Status, StatusError};

mod program;
pub use program::Uploaded;

mod comparison;
pub use comparison::Comparison;

mod drift;
pub use drift::{Drift, DriftNews};

mod download;
pub use download::{DownloadFailure, Fate, Plan, Progress, Report, Stage};

use super::{Line, LinkError, Transport};
use crate::target::{Model, Target};

/// A host that knows which PLC is at the other end of its line.
pub struct Host<T> {
    line: Line<T>,
    identity: Identity,
}

/// Which commands a PLC knows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Dialect {
    /// Those of every FX alone.
    Plain,
    /// The extended ones too.
    Extended,
}

impl Dialect {
    fn of(target: &Target) -> Dialect {
        match target.model {
            Model::Fx1s => Dialect::Plain,
            _ => Dialect::Extended,
        }
    }
}

impl<T: Transport> Host<T> {
    /// Greets the PLC and asks who it is.
    ///
    /// # Errors
    /// If nobody answers, or somebody who is no FX.
    pub fn connect(mut line: Line<T>) -> Result<Host<T>, LinkError> {
        line.greet()?;
        let identity = Identity::ask(&mut line)?;
        Ok(Host { line, identity })
    }

    /// Who it is.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// The line.
    pub fn line(&mut self) -> &mut Line<T> {
        &mut self.line
    }

    fn dialect(&self) -> Dialect {
        Dialect::of(self.identity.target)
    }
}
