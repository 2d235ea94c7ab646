//! Coordinates of models on inclined planes.

/// Points given along and normal to a plane that falls to the right by `slope` (degrees), in x and y (m).
pub fn turned(points: &[[f64; 2]], slope: f64) -> Vec<[f64; 2]> {
    let (s, c) = (-slope).to_radians().sin_cos();
    points.iter().map(|p| [c * p[0] - s * p[1], s * p[0] + c * p[1]]).collect()
}

/// Points as a case file writes them.
pub fn written(points: &[[f64; 2]]) -> String {
    format!("{points:?}")
}
