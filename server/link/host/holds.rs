//! Holding devices at values, as well as this protocol can: it has no hold, so what a device should be is written again
//! with each look at it. The program may write something else in between.

use super::{Host, Point};
use crate::link::{LinkError, Transport};

/// What is held, in the order in which that began.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Holds(Vec<(Point, i64)>);

impl Holds {
    /// What is held at which numbers.
    pub fn held(&self) -> &[(Point, i64)] {
        &self.0
    }

    /// The number that a point is held at.
    pub fn of(&self, point: Point) -> Option<i64> {
        self.0.iter().find(|(held, _)| *held == point).map(|(_, number)| *number)
    }

    /// Holds a point from now on, which it writes first.
    ///
    /// # Errors
    /// See [`Host::write`]; then it is not held.
    pub fn hold<T: Transport>(
        &mut self,
        host: &mut Host<T>,
        point: Point,
        number: i64,
    ) -> Result<(), LinkError> {
        host.write(point, number)?;
        match self.0.iter_mut().find(|(held, _)| *held == point) {
            Some((_, held)) => *held = number,
            None => self.0.push((point, number)),
        }
        Ok(())
    }

    /// Lets a point go, which keeps its value until somebody writes another one; whether it was held.
    pub fn release(&mut self, point: Point) -> bool {
        let count = self.0.len();
        self.0.retain(|(held, _)| *held != point);
        self.0.len() < count
    }

    /// Lets all go, and gives what was held.
    pub fn release_all(&mut self) -> Vec<(Point, i64)> {
        std::mem::take(&mut self.0)
    }

    /// Writes again what is no longer what it should be, as `read` says.
    ///
    /// # Errors
    /// If the line fails.
    pub fn rewrite<T: Transport>(
        &self,
        host: &mut Host<T>,
        read: &impl Fn(Point) -> Option<i64>,
    ) -> Result<(), LinkError> {
        for (point, number) in &self.0 {
            if read(*point) != Some(*number) {
                host.write(*point, *number)?;
            }
        }
        Ok(())
    }
}
