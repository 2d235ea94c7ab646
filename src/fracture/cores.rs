//! Cores of blocks: rock far from all faces, which splits from within where it has the tensile strength.

use std::sync::OnceLock;

use crate::cover::ElementId;
use crate::geometry::{Point, Vector, segment};
use crate::state::{Model, State};

use super::chord::{Chord, met};
use super::outline::Outline;

/// Reach over the mesh size of the mean of a core, and the distance of its middle from all faces.
const REACH: f64 = 1.5;
/// Extent of a block over the mesh size below which it has no core.
const ACROSS: f64 = 8.0;

/// The cores of a block, found once.
#[derive(Debug, Clone, Default)]
pub struct Cores(OnceLock<Vec<Core>>);

/// Rock about the centroid of an element.
#[derive(Debug, Clone)]
struct Core {
    middle: Point,
    /// Elements whose centroids lie within reach.
    elements: Vec<ElementId>,
}

impl Cores {
    fn of(&self, model: &Model, outline: &Outline) -> &[Core] {
        self.0.get_or_init(|| {
            let (covers, reach) = (&model.covers, REACH * model.covers.mesh.size);
            if outline.least_extent() < ACROSS * covers.mesh.size {
                return Vec::new();
            }
            let is_inside = |p: Point| {
                (0..outline.points.len()).all(|k| {
                    let [a, b] = outline.edge(k);
                    segment::distance(p, a, b) >= reach
                })
            };
            let elements = ElementId::range(covers.elements_of(outline.block));
            let middles = elements.map(|e| covers.element_centroid[e]).filter(|&p| is_inside(p));
            let about = |p: Point| {
                let near = covers.around(p, reach).filter(|&e| covers.element_block[e] == outline.block);
                let mut near: Vec<ElementId> =
                    near.filter(|&e| (covers.element_centroid[e] - p).norm() <= reach).collect();
                near.sort_unstable();
                Core { middle: p, elements: near }
            };
            middles.map(about).collect()
        })
    }

    /// The greatest mean tension (Pa) of a core, and the section through it across that; none of a block without one,
    /// or where no section can break there.
    pub fn worst(&self, model: &Model, state: &State, outline: &Outline, turn: f64) -> Option<(f64, Chord)> {
        let cores = self.of(model, outline);
        if cores.is_empty() {
            return None;
        }
        let first = model.covers.elements_of(outline.block).start;
        let mut stress = Vec::with_capacity(model.covers.elements_of(outline.block).len());
        let elements = model.covers.elements_of(outline.block);
        model.each_stressed(state, &state.displacement, elements, |_, of_element, _| stress.push(of_element));
        let mean = |core: &Core| {
            let area = |e: &ElementId| model.covers.element_area[*e];
            let all: f64 = core.elements.iter().map(area).sum();
            let part = |k: usize| core.elements.iter().map(|e| area(e) * stress[e.index() - first][k]).sum::<f64>();
            principal([0, 1, 2].map(|k| part(k) / all))
        };
        let tensions = cores.iter().map(|core| (core, mean(core)));
        let (core, (tension, angle)) = tensions.max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
        let across = angle - turn;
        let way = Vector::new(-libm::sin(across), libm::cos(across));
        let ends = [met(outline, None, core.middle, -way)?, met(outline, None, core.middle, way)?];
        Some((tension, Chord::between(model, outline, ends)?))
    }
}

/// The greatest of the principal stresses of xx, yy, xy, and the angle (rad) of its axis.
pub fn principal([xx, yy, xy]: [f64; 3]) -> (f64, f64) {
    let half = 0.5 * (xx - yy);
    (0.5 * (xx + yy) + libm::hypot(half, xy), 0.5 * libm::atan2(xy, half))
}
