//! Points, loops, planar arrangement and the shapes that cut it. Knows nothing of rock.

/// A place in the plane (m).
pub type Point = nalgebra::Vector2<f64>;
/// A direction, a displacement, a velocity or a force in the plane.
pub type Vector = nalgebra::Vector2<f64>;
