//! Errors of a geometry. Every line names the item, its place, the value, the limit and the remedy.

/// A geometry that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A coordinate is infinite or not a number.
    #[error("{what} {index} has a coordinate that is not finite ({x}, {y})")]
    NotFinite {
        /// Item that the point belongs to.
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
    /// The plane falls into more pieces than there is room for.
    #[error("traces, outlines and mesh cut each other into more than {limit} pieces, many of them near ({x}, {y})")]
    TooManyPieces {
        /// Pieces allowed.
        limit: usize,
        /// Abscissa of one of them (m).
        x: f64,
        /// Ordinate of one of them (m).
        y: f64,
    },
    /// Lines lie so close together that comparing them would take far too long.
    #[error(
        "lines near ({x}, {y}) lie so close together that more than {limit} comparisons are needed: take out traces \
         there, or raise the snap tolerance above their distance"
    )]
    TooDense {
        /// Comparisons allowed.
        limit: u64,
        /// Abscissa of one of the places (m).
        x: f64,
        /// Ordinate of one of the places (m).
        y: f64,
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
    /// A loop has no inside.
    #[error("{name} has {found} distinct points, at least 3 are needed: add the missing ones")]
    TooFewPoints {
        /// Loop.
        name: String,
        /// Distinct points.
        found: usize,
    },
    /// A loop is flat.
    #[error("{name} has an area of {area} m², not above {limit} m²: give it a width or leave it out")]
    NoArea {
        /// Loop.
        name: String,
        /// Signed area (m²).
        area: f64,
        /// Smallest area that counts (m²).
        limit: f64,
    },
    /// A loop crosses or touches itself.
    #[error(
        "{name} meets itself at ({x}, {y}), sides {first} and {second} counted from 0: a loop may not; part it there"
    )]
    SelfIntersection {
        /// Loop.
        name: String,
        /// One side.
        first: usize,
        /// The other side.
        second: usize,
        /// Abscissa (m).
        x: f64,
        /// Ordinate (m).
        y: f64,
    },
    /// A hole crosses or touches the outline or another hole.
    #[error("{first} and {second} meet at ({x}, {y}): move them apart or join them into one loop")]
    LoopsMeet {
        /// One loop.
        first: String,
        /// The other loop.
        second: String,
        /// Abscissa (m).
        x: f64,
        /// Ordinate (m).
        y: f64,
    },
    /// A hole is not cut out of rock.
    #[error("hole {hole} at ({x}, {y}) lies {place}: holes lie in the rock of the outline; move it or leave it out")]
    HoleMisplaced {
        /// Index of the hole.
        hole: usize,
        /// Where it lies instead.
        place: String,
        /// Abscissa of its first point (m).
        x: f64,
        /// Ordinate of its first point (m).
        y: f64,
    },
    /// An island lies on other rock.
    #[error(
        "island {island} at ({x}, {y}) overlaps the rock of {other} by {overlap} m² (limit {limit} m²): move it into a \
         hole or beside the outline"
    )]
    IslandOnRock {
        /// Index of the island.
        island: usize,
        /// The loop whose rock it overlaps.
        other: String,
        /// Overlap (m²).
        overlap: f64,
        /// Overlap that counts as contact (m²).
        limit: f64,
        /// Abscissa of its first point (m).
        x: f64,
        /// Ordinate of its first point (m).
        y: f64,
    },
    /// A parameter of a joint set is out of range.
    #[error("joint set: {parameter} is {value}, must be {rule}: correct it")]
    JointSet {
        /// Parameter.
        parameter: &'static str,
        /// Value given (SI, rad).
        value: f64,
        /// Rule for the value.
        rule: &'static str,
    },
    /// A joint set fills its region with too many traces.
    #[error("joint set with spacing {spacing} m has more than {limit} traces: raise spacing, length or gap")]
    TooManyTraces {
        /// Spacing given (m).
        spacing: f64,
        /// Traces allowed.
        limit: usize,
    },
}
