//! Consistent mass and corotated stiffness of one element, for the implicit integrator (Eqs. 68, 69).

use enmm::geometry::{Vector, polygon};
use enmm::internals::cover::CoverId;

use enmm::internals::mechanics::Elasticity;

/// The six pairs of an element's three covers, in the order in which element matrices are stored.
pub const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// ∫ρ w_a w_b (kg/m) over an element's polygon for the six pairs of its covers, exact since the weights are affine
/// (Eq. 68): A·w_a·w_b at the centroid plus the second moments of area about it.
pub fn element_mass(density: f64, weights: [f64; 3], g: &[Vector; 3], about_centroid: &polygon::Moments) -> [f64; 6] {
    let [xx, yy, xy] = about_centroid.second;
    PAIRS.map(|[a, b]| {
        let (ga, gb) = (g[a], g[b]);
        let turned = ga.x * (xx * gb.x + xy * gb.y) + ga.y * (xy * gb.x + yy * gb.y);
        density * (about_centroid.area * weights[a] * weights[b] + turned)
    })
}

/// Adds an element's mass times a cover field to `out`.
pub fn push_mass(mass: &[f64; 6], ids: [CoverId; 3], field: &[Vector], out: &mut [Vector]) {
    for (value, [a, b]) in mass.iter().zip(PAIRS) {
        out[ids[a]] += field[ids[b]] * *value;
        if a != b {
            out[ids[b]] += field[ids[a]] * *value;
        }
    }
}

/// Stiffness (N/m per metre) between two covers of an element with turned gradients R·G, row by row (Eq. 69).
pub fn stiffness_block(area: f64, rock: &Elasticity, ga: Vector, gb: Vector) -> [f64; 4] {
    let (lambda, mu) = (area * rock.lambda, area * rock.mu);
    let common = mu * ga.dot(&gb);
    [
        (lambda + mu) * ga.x * gb.x + common,
        lambda * ga.x * gb.y + mu * gb.x * ga.y,
        lambda * ga.y * gb.x + mu * gb.y * ga.x,
        (lambda + mu) * ga.y * gb.y + common,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use enmm::geometry::Point;
    use enmm::internals::mechanics::Deformation;

    const UP: [Vector; 3] = [Vector::new(-1.0, -1.0), Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];

    #[test]
    fn the_mass_of_a_whole_triangle_is_a_twelfth_and_a_sixth_of_its_own() {
        let corners = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.0, 1.0)];
        let centroid = polygon::centroid(&corners);
        let mass = element_mass(2.0, [1.0 / 3.0; 3], &UP, &polygon::Moments::of(&corners, centroid));
        for (k, value) in mass.into_iter().enumerate() {
            let exact = 2.0 * 0.5 / if k < 3 { 6.0 } else { 12.0 };
            assert!((value - exact).abs() < 1e-15, "{k}: {value} of {exact}");
        }
    }

    #[test]
    fn stiffness_is_minus_the_derivative_of_the_forces_at_rest() {
        let rock = Elasticity { lambda: 0.7, mu: 0.4, density: 1.0 };
        let forces = |u| Deformation::new(u, &UP).forces(&UP, 0.5, &rock, &[0.0; 3]);
        for (b, axis) in [(0, 0), (0, 1), (1, 0), (2, 1)] {
            let mut u = [Vector::zeros(); 3];
            u[b][axis] = 1e-7;
            let forward = forces(u);
            u[b][axis] = -1e-7;
            let backward = forces(u);
            for a in 0..3 {
                let block = stiffness_block(0.5, &rock, UP[a], UP[b]);
                let model = (backward[a] - forward[a]) / 2e-7;
                assert!((model - Vector::new(block[axis], block[2 + axis])).norm() < 1e-6, "{a} {b} {axis}");
            }
        }
    }
}
