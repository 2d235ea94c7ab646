//! Masses of a block on its covers: how much each has of each element, and where.

use std::ops::AddAssign;

use crate::cover::{BlockId, ElementId};
use crate::geometry::{Point, Vector, polygon};
use crate::state::Model;

/// The mass of rock that a cover has.
#[derive(Debug, Clone, Copy, Default)]
pub struct CoverMass {
    /// Amount (kg/m).
    pub amount: f64,
    /// First moment (kg) about the star of the cover.
    pub moment: Vector,
}

/// The masses of a block.
#[derive(Debug, Clone)]
pub struct Masses {
    /// Those of each element on its three covers.
    pub elements: Vec<[CoverMass; 3]>,
    /// Mass of each cover (kg/m).
    pub amounts: Vec<f64>,
    /// Way (m) from the star of each cover to the centroid of its mass, in the reference configuration.
    pub arms: Vec<Vector>,
}

impl AddAssign for CoverMass {
    fn add_assign(&mut self, other: Self) {
        self.amount += other.amount;
        self.moment += other.moment;
    }
}

impl Masses {
    /// Those of a block of a model.
    pub fn of(model: &Model, block: BlockId) -> Self {
        let covers = &model.covers;
        let range = covers.covers_of(block);
        let whole =
            |e: ElementId| of_part(model, e, covers.polygon(e), covers.element_area[e], covers.element_centroid[e]);
        let elements: Vec<_> = ElementId::range(covers.elements_of(block)).map(whole).collect();
        let mut moments = vec![Vector::zeros(); range.len()];
        for (e, masses) in ElementId::range(covers.elements_of(block)).zip(&elements) {
            for (cover, mass) in covers.element_covers[e].iter().zip(masses) {
                moments[cover.index() - range.start] += mass.moment;
            }
        }
        let amounts = model.mass_matrix.row_sum[range].to_vec();
        let arms = moments.iter().zip(&amounts).map(|(moment, amount)| moment / *amount).collect();
        Self { elements, amounts, arms }
    }
}

/// The masses on the covers of an element of a part of it with an area (m²) and a centroid (m): with the weights
/// $w_i(x)=w_i(c)+g_i\cdot(x-c)$ they are $\rho Aw_i(c)$, and their moments $\rho(Aw_i(c)(c-x_i)+Sg_i)$ with the second
/// moments $S$ about the centroid.
pub fn of_part(model: &Model, e: ElementId, part: &[Point], area: f64, centroid: Point) -> [CoverMass; 3] {
    let (covers, density) = (&model.covers, model.rock_of(e).density);
    let [xx, yy, xy] = polygon::Moments::of(part, centroid).second;
    let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
    let weights = covers.weights(e, centroid);
    [0, 1, 2].map(|k| {
        let (g, amount) = (gradients[k], density * area * weights[k]);
        let spread = Vector::new(xx * g.x + xy * g.y, xy * g.x + yy * g.y) * density;
        CoverMass { amount, moment: (centroid - covers.star_position[covers.element_covers[e][k]]) * amount + spread }
    })
}
