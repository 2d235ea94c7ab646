//! Axes in space, their planes, and the principal axis of several.

/// A unit vector east, north and down; an axis has no sense.
pub type Axis = [f64; 3];

/// Sweeps of Jacobi's method at most; each squares what is off the diagonal.
const SWEEPS: usize = 32;

/// The pole of a plane by its dip and dip direction (degrees): the normal that points down.
pub fn pole_of(dip: f64, direction: f64) -> Axis {
    let (sin, cos) = libm::sincos(dip.to_radians());
    let (east, north) = libm::sincos(direction.to_radians());
    [-sin * east, -sin * north, cos]
}

/// Dip and dip direction (degrees) of the plane of a pole; a level plane has the dip direction 0.
pub fn plane_of(pole: &Axis) -> [f64; 2] {
    let [east, north, down] = if pole[2] < 0.0 { pole.map(|part| -part) } else { *pole };
    let flat = libm::hypot(east, north);
    let dip = libm::atan2(flat, down).to_degrees();
    let direction = if flat > 0.0 { libm::atan2(-east, -north).to_degrees().rem_euclid(360.0) } else { 0.0 };
    // A remainder may round up to the whole.
    [dip, if direction >= 360.0 { 0.0 } else { direction }]
}

/// A line by its plunge and trend (degrees).
pub fn line_of(plunge: f64, trend: f64) -> Axis {
    let (sin, cos) = libm::sincos(plunge.to_radians());
    let (east, north) = libm::sincos(trend.to_radians());
    [cos * east, cos * north, sin]
}

/// Cosine of the angle between two directions.
pub fn cosine(a: &Axis, b: &Axis) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The axis about which weighted axes lie: the eigenvector of the greatest eigenvalue of Σ w·x·xᵀ.
pub fn principal<'a>(axes: impl Iterator<Item = (&'a Axis, f64)>) -> Axis {
    let mut tensor = [[0.0; 3]; 3];
    for (axis, weight) in axes {
        for row in 0..3 {
            (0..3).for_each(|column| tensor[row][column] += weight * axis[row] * axis[column]);
        }
    }
    let (values, vectors) = eigen(tensor);
    let most = (0..3).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or_default();
    [0, 1, 2].map(|row| vectors[row][most])
}

/// Eigenvalues of a symmetric tensor and its eigenvectors, in columns, by Jacobi's rotations.
fn eigen(mut tensor: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        for [p, q] in [[0, 1], [0, 2], [1, 2]] {
            if tensor[p][q] == 0.0 {
                continue;
            }
            let half = 0.5 * (tensor[q][q] - tensor[p][p]) / tensor[p][q];
            let tangent = half.signum() / (half.abs() + libm::hypot(half, 1.0));
            let cos = 1.0 / libm::hypot(tangent, 1.0);
            let sin = tangent * cos;
            for row in &mut tensor {
                (row[p], row[q]) = (cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]);
            }
            let [a, b] = [tensor[p], tensor[q]];
            tensor[p] = [0, 1, 2].map(|k| cos * a[k] - sin * b[k]);
            tensor[q] = [0, 1, 2].map(|k| sin * a[k] + cos * b[k]);
            for row in &mut vectors {
                (row[p], row[q]) = (cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]);
            }
        }
    }
    ([0, 1, 2].map(|k| tensor[k][k]), vectors)
}
