//! What can be wrong with a geometry. Every line says what, where, the value, the limit and the remedy.

/// A geometry that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A coordinate is infinite or not a number.
    #[error("{what} {index} has a coordinate that is not finite ({x}, {y}): correct it in the input")]
    NotFinite {
        /// What the point belongs to.
        what: String,
        /// Index of the point or segment.
        index: usize,
        /// Abscissa (m).
        x: f64,
        /// Ordinate (m).
        y: f64,
    },
    /// The snap tolerance drowns in round-off, or is no positive number.
    #[error(
        "snap tolerance {value} m is not above {limit} m, the round-off of coordinates up to {extent} m: raise the \
         tolerance or move the origin to the model"
    )]
    Tolerance {
        /// Tolerance given (m).
        value: f64,
        /// Smallest tolerance that works (m).
        limit: f64,
        /// Largest coordinate (m).
        extent: f64,
    },
    /// The noder is still moving edges when its passes are used up.
    #[error(
        "edges near ({x}, {y}) still move after {passes} passes of the noder (limit {limit}) at snap tolerance \
         {tolerance} m: change the tolerance or clean the traces there"
    )]
    Unsettled {
        /// Passes done.
        passes: usize,
        /// Passes allowed.
        limit: usize,
        /// Abscissa of one unsettled place (m).
        x: f64,
        /// Ordinate of one unsettled place (m).
        y: f64,
        /// Snap tolerance (m).
        tolerance: f64,
    },
    /// Outline edges do not close, so that inside and outside are undefined.
    #[error(
        "outline edges do not close at ({x}, {y}): {found} windings meet where {expected} belong: close the outline"
    )]
    OpenOutline {
        /// Abscissa (m).
        x: f64,
        /// Ordinate (m).
        y: f64,
        /// Change of winding across the edge as flooded.
        found: i32,
        /// Change of winding that the edge carries.
        expected: i32,
    },
}
