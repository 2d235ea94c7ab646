//! Parts of models that problems and tests share: turned corners, and text of case files.

/// Points (m) turned counter-clockwise by an angle (degrees) about the origin.
pub fn turn(points: &[[f64; 2]], degrees: f64) -> Vec<[f64; 2]> {
    turn_radians(points, degrees.to_radians())
}

/// Points (m) turned counter-clockwise by an angle (rad) about the origin.
pub fn turn_radians(points: &[[f64; 2]], angle: f64) -> Vec<[f64; 2]> {
    let (s, c) = angle.sin_cos();
    points.iter().map(|p| [c * p[0] - s * p[1], s * p[0] + c * p[1]]).collect()
}

/// A rock of plane strain with ν = 0.25 and this Young's modulus (Pa) and density (kg/m³).
pub fn rock(young: f64, density: f64) -> String {
    format!("[rock.rock]\ndensity = {density:e}\nyoung = {young:e}\npoisson = 0.25\n")
}

/// A dynamic stage of this duration (s) and damping ratio, without changes.
pub fn dynamic(name: &str, duration: f64, damping: f64) -> String {
    format!("[[stage]]\nname = \"{name}\"\nkind = \"dynamic\"\nduration = {duration:e}\ndamping = {damping:e}\n")
}
