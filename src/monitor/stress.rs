//! Stress at a point: a plane through the stresses of the elements about it.

use crate::cover::{Covers, ElementId};
use crate::geometry::{Point, Vector};
use crate::state::{Model, Quantity, State};

/// Stress xx, yy, xy (Pa, tension positive).
pub type Stress = [f64; 3];

/// Least ratio of the two moments of inertia of the centroids about a point: below it they lie on a line, and no plane
/// goes through their stresses.
const FLAT: f64 = 1e-3;

/// Numbers of the stress at a monitor as outputs show them.
pub const MONITOR_STRESS_QUANTITIES: [Quantity<Stress>; 6] = [
    Quantity::plain("stress_xx", "Pa", "Stress xx, tension positive", |&[xx, _, _]| xx),
    Quantity::plain("stress_yy", "Pa", "Stress yy, tension positive", |&[_, yy, _]| yy),
    Quantity::plain("stress_xy", "Pa", "Stress xy", |&[_, _, xy]| xy),
    Quantity::plain("principal_max", "Pa", "Greatest principal stress in the plane", |stress| principal(stress)[0]),
    Quantity::plain("principal_min", "Pa", "Least principal stress in the plane: the greatest compression", |stress| {
        principal(stress)[1]
    }),
    Quantity::plain(
        "principal_angle",
        "rad",
        "Direction of the greatest compression from the x axis, counter-clockwise",
        principal_angle,
    ),
];

/// Mean of the stresses xx and yy (Pa).
pub fn mean(&[xx, yy, _]: &Stress) -> f64 {
    0.5 * (xx + yy)
}

/// Greatest shear stress in the plane (Pa): √(((xx − yy)/2)² + xy²).
pub fn max_shear(&[xx, yy, xy]: &Stress) -> f64 {
    libm::hypot(0.5 * (xx - yy), xy)
}

/// The greatest and the least principal stress in the plane (Pa).
pub fn principal(stress: &Stress) -> [f64; 2] {
    let (mean, radius) = (mean(stress), max_shear(stress));
    [mean + radius, mean - radius]
}

/// Direction (rad, above −π/2 and at most π/2) of the least principal stress in the plane, the greatest compression,
/// from the x axis; 0 where all directions are alike.
pub fn principal_angle(&[xx, yy, xy]: &Stress) -> f64 {
    // Negative zeros would turn a vertical compression upside down.
    let [across, along] = [-2.0 * xy, yy - xx].map(|part| part + 0.0);
    0.5 * libm::atan2(across, along)
}

/// The stress at a point as a sum over elements: the value there of the plane that fits, by least squares weighted by
/// area, the stresses at the centroids of those elements of its block and rock that share a cover with its own. Stress
/// that varies linearly over them is read without error.
#[derive(Debug, Clone)]
pub struct StressFit {
    /// Elements with their shares, which sum up to 1.
    shares: Vec<(ElementId, f64)>,
}

impl StressFit {
    /// That of a reference point (m) in an element.
    pub fn new(covers: &Covers, element_rock: &[u16], element: ElementId, point: Point) -> Self {
        let own = covers.element_covers[element];
        let shares_cover = |e: ElementId| covers.element_covers[e].iter().any(|cover| own.contains(cover));
        let is_like = |e: ElementId| element_rock[e.index()] == element_rock[element.index()];
        // A sliver has the strain of its host, which is there.
        let is_whole = |e: ElementId| covers.host[e] == e;
        let near = covers.around(point, 2.0 * covers.mesh.size);
        let mut elements: Vec<ElementId> = near.filter(|&e| shares_cover(e) && is_like(e) && is_whole(e)).collect();
        elements.sort_unstable();
        if elements.is_empty() {
            elements.push(element);
        }
        Self { shares: plane(covers, &elements, point) }
    }

    /// The stress now (Pa), NaN where the rock has been excavated.
    pub fn read(&self, model: &Model, state: &State) -> Stress {
        let block = model.covers.element_block[self.shares[0].0];
        if state.removed[block] {
            return [f64::NAN; 3];
        }
        let patches = model.patch_means(state, model.covers.elements_of(block));
        self.shares.iter().fold([0.0; 3], |sum, &(element, share)| {
            let stress = model.stress_under(state, element, &patches);
            [0, 1, 2].map(|k| sum[k] + share * stress[k])
        })
    }
}

/// Shares of elements in the value at a point of the plane through their values; those of their mean by area where
/// their centroids lie on a line.
fn plane(covers: &Covers, elements: &[ElementId], point: Point) -> Vec<(ElementId, f64)> {
    let area: f64 = elements.iter().map(|&e| covers.element_area[e]).sum();
    let mean = |value: &dyn Fn(ElementId) -> f64| -> f64 {
        elements.iter().map(|&e| covers.element_area[e] * value(e)).sum::<f64>() / area
    };
    let middle = Point::new(mean(&|e| covers.element_centroid[e].x), mean(&|e| covers.element_centroid[e].y));
    let arm = |e: ElementId| covers.element_centroid[e] - middle;
    let [xx, yy, xy] = [mean(&|e| arm(e).x * arm(e).x), mean(&|e| arm(e).y * arm(e).y), mean(&|e| arm(e).x * arm(e).y)];
    let [most, least] = principal(&[xx, yy, xy]);
    let to = point - middle;
    let determinant = xx * yy - xy * xy;
    let slope = if least > FLAT * most {
        Vector::new(yy * to.x - xy * to.y, xx * to.y - xy * to.x) / determinant
    } else {
        Vector::zeros()
    };
    elements.iter().map(|&e| (e, covers.element_area[e] / area * (1.0 + slope.dot(&arm(e))))).collect()
}
