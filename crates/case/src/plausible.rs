//! Sizes that slopes have: what lies beyond mostly has the wrong unit.

/// Shortest and longest greater side (m) of the box of a slope.
pub const MODEL_SIZE: [f64; 2] = [1.0, 1e4];

/// What is odd about the width and height (m) of a model.
pub fn odd_size([width, height]: [f64; 2]) -> Option<String> {
    let (size, [least, most]) = (width.max(height), MODEL_SIZE);
    let remedy = if size > most {
        "coordinates are in metres, so divide those in millimetres by 1000"
    } else if size < least {
        "coordinates are in metres: a drawing in metres whose header says millimetres or inches needs \
         `transform.scale = 1`, and degrees must be projected first"
    } else {
        return None;
    };
    Some(format!(
        "the rock is {width:.6} m by {height:.6} m, and slopes are {least} m to {:.0} km long; {remedy}",
        1e-3 * most
    ))
}
