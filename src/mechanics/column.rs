//! Free-field columns: rock beside the model that moves in one dimension.

use crate::geometry::Vector;

/// Motion of a free-field column, from its foot to its head.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ColumnState {
    /// Displacement of each node (m).
    pub displacement: Vec<Vector>,
    /// Velocity of each node half a step ago (m/s).
    pub velocity: Vec<Vector>,
}
