//! Slopes and continua of any size: the text of a case from how many blocks and elements are wanted.
//!
//! Counts follow from integral geometry. A convex region of area A and perimeter P that a set of parallel lines at
//! distance s crosses has w/s chords in it, w its width normal to them; n chords with m crossings make 1 + n + m faces.
//! The mesh is three such sets at distance h·√3/2, whose crossings are its stars, three lines through each, and the
//! width of a region is P/π in the mean over directions.

use std::f64::consts::PI;
use std::fmt::Write as _;

/// Height of the slope (m).
const HEIGHT: f64 = 100.0;
/// Dip of the base and of the bedding (°), out of the slope.
const DIP_DEG: f64 = 30.0;
/// Dip of the face (°).
const FACE_DEG: f64 = 60.0;
/// Friction of all joints (°).
const FRICTION_DEG: f64 = 20.0;
/// Length (m) of the base beyond the toe.
const RUN_OUT: f64 = 20.0;
/// Standard deviation of the spacing over its mean.
const SCATTER: f64 = 0.15;
/// Side (m) of the square continuum.
const SIDE: f64 = 100.0;

/// Rock of blocks and continua.
const ROCK: &str = "[rock.rock]\ndensity = 2650\nyoung = 5e9\npoisson = 0.25\n";
/// Motion without end.
const MOTION: &str = "[[stage]]\nname = \"motion\"\nkind = \"dynamic\"\nduration = 1e6\ndamping = 0.1\n";

/// A slope of 100 m on a base that dips 30° out of it: bedding along the base, cross joints normal to it, friction of
/// 20° everywhere, so that all its blocks slide.
///
/// About `blocks` blocks, each cut into about `elements_a_block` elements by the mesh, lie on a thin slab of held rock.
pub fn slope_case(blocks: usize, elements_a_block: usize) -> String {
    let (sin, cos) = libm::sincos(DIP_DEG.to_radians());
    let length = HEIGHT / sin;
    let crest = [HEIGHT / libm::tan(FACE_DEG.to_radians()), HEIGHT];
    let thickness = crest[1] * cos - crest[0] * sin;
    let area = 0.5 * length * thickness;
    let spacing = root(area, length + thickness, blocks as f64 - 1.0);
    let perimeter = length + (length * cos - crest[0]) + HEIGHT / libm::sin(FACE_DEG.to_radians());
    let faces = 2.0 * (2.0 * area / spacing) + perimeter;
    let size = mesh_size(area / blocks as f64, faces / blocks as f64, elements_a_block as f64);
    let along = |position: f64, depth: f64| {
        format!("[{:.6}, {:.6}]", position * cos + depth * sin, position * sin - depth * cos)
    };
    let (toe, top, rim) = (along(0.0, 0.0), along(length, 0.0), format!("[{:.6}, {HEIGHT:.1}]", crest[0]));
    let corners =
        [along(-RUN_OUT, size), along(length, size), top.clone(), rim.clone(), toe.clone(), along(-RUN_OUT, 0.0)];
    let mut text = format!(
        "title = \"slope of {blocks} blocks, {elements_a_block} elements a block\"\n\
        [domain]\noutline = [{}]\njoint_law = \"joint\"\nextend_ends = 0\n\
        [mesh]\nsize = {size:.6}\nangle_deg = 7\nleast_block = 0\n[[joint]]\npoints = [{toe}, {top}]\n",
        corners.join(", "),
    );
    for (seed, dip) in [(11, DIP_DEG), (12, DIP_DEG + 90.0)] {
        let deviation = SCATTER * spacing;
        let _ = write!(
            text,
            "[[joint_set]]\nangle_deg = {dip}\nspacing = {spacing:.6}\nspacing_sd = {deviation:.6}\nseed = {seed}\n\
            region = [{toe}, {top}, {rim}]\n"
        );
    }
    let _ = write!(text, "{ROCK}[joint_law.joint]\nfriction_deg = {FRICTION_DEG}\n");
    let _ = write!(text, "[[fix]]\nblock = {}\n{MOTION}", along(0.5 * length, 0.5 * size));
    text
}

/// A block of about `elements` elements that shakes on a held base, without any contact.
pub fn continuum_case(elements: usize) -> String {
    let size = mesh_size(SIDE * SIDE, 4.0 * SIDE, elements as f64);
    format!(
        "title = \"continuum of {elements} elements\"\n\
        [domain]\noutline = [[0, 0], [{SIDE}, 0], [{SIDE}, {SIDE}], [0, {SIDE}]]\n\
        [mesh]\nsize = {size:.6}\nangle_deg = 7\n{ROCK}[[fix]]\nedge = [[0, 0], [{SIDE}, 0]]\n{MOTION}"
    )
}

/// Mesh size (m) at which regions of this area (m²) and perimeter (m) are cut into so many elements in the mean:
/// 1 + 3P/(π h √3/2) + A/(h² √3/4).
fn mesh_size(area: f64, perimeter: f64, elements: f64) -> f64 {
    let root_3 = 3f64.sqrt();
    root(4.0 * area / root_3, 2.0 * root_3 * perimeter / PI, elements - 1.0)
}

/// The s > 0 for which a/s² + b/s = c.
fn root(a: f64, b: f64, c: f64) -> f64 {
    2.0 * a / ((b * b + 4.0 * a * c).sqrt() - b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn root_solves_its_equation() {
        let s = root(7.0, 3.0, 11.0);
        assert!((7.0 / (s * s) + 3.0 / s - 11.0).abs() < 1e-12);
    }
}
