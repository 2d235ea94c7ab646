//! The work of searches among points and edges, which lines that lie close together can raise without bound.

use std::cell::Cell;

use super::{GeometryError, Point};

/// Comparisons allowed however few lines there are: less than a second.
const WORK_MIN: u64 = 120_000_000;
/// Comparisons allowed for each line; models and maps of joints take 10 to 100.
const WORK_PER_LINE: u64 = 300;

/// Comparisons of points and edges that a search may still make.
pub(super) struct Work {
    left: Cell<u64>,
    limit: u64,
}

impl Work {
    /// The work allowed for so many lines.
    pub fn for_lines(lines: usize) -> Self {
        let limit = WORK_PER_LINE.saturating_mul(lines as u64).max(WORK_MIN);
        Self { left: Cell::new(limit), limit }
    }

    /// Takes comparisons made near a place.
    ///
    /// # Errors
    /// They are more than are left.
    pub fn take(&self, comparisons: usize, at: Point) -> Result<(), GeometryError> {
        let left = self.left.get().checked_sub(comparisons as u64);
        self.left.set(left.ok_or(GeometryError::TooDense { limit: self.limit, x: at.x, y: at.y })?);
        Ok(())
    }
}
