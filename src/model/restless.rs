//! Blocks that go on moving in a slope at rest: they rattle, slide off or fall.

use std::fmt;

use crate::contact::VertexEdge;
use crate::cover::BlockId;
use crate::geometry::Point;
use crate::step::{StepReport, block_motion, mass_of_few};

use super::Simulation;

/// Speed over that of the fastest block from which a block moves.
const MOVES: f64 = 0.1;

/// A block that cannot rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Restless {
    /// The block.
    pub block: BlockId,
    /// Its number, as hosts see it.
    pub label: u32,
    /// Its area (m²).
    pub area: f64,
    /// Its centroid now (m).
    pub place: Point,
    /// Its speed, with that of its rim by its spin (m/s).
    pub speed: f64,
    /// Law of the joint that bears most of it; none where it touches nothing.
    pub law: Option<String>,
}

impl fmt::Display for Restless {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { label, area, place, speed, law, .. } = self;
        write!(f, "block {label} of {area:.3} m² at ({:.3}, {:.3}) m, {speed:.2e} m/s, ", place.x, place.y)?;
        match law {
            Some(law) => write!(f, "on a joint of law {law:?}"),
            None => write!(f, "in free flight"),
        }
    }
}

impl Simulation {
    /// Blocks that still move in a static stage in which all else is at rest by this report, the fastest first; none
    /// where all is at rest, or more than a few move ([`Simulation::mass_of_few`]).
    pub fn restless(&self, report: &StepReport) -> Vec<Restless> {
        if self.all_rests(report) || !self.most_rests(report) {
            return Vec::new();
        }
        let mass = &self.workspace().mass_matrix.total;
        let blocks = self.moving();
        let mut room = mass_of_few(self.model(), &self.workspace().mass_matrix);
        let fits = |block: &Restless| {
            room -= mass[block.block];
            room >= 0.0
        };
        blocks.into_iter().take_while(fits).collect()
    }

    /// The fastest block and those that are about as fast, the fastest first.
    pub fn moving(&self) -> Vec<Restless> {
        let mut blocks: Vec<Restless> = self.free_blocks().map(|b| self.motion_at_rest(b)).collect();
        blocks.sort_by(|a, b| b.speed.total_cmp(&a.speed).then(a.block.cmp(&b.block)));
        let fastest = blocks.first().map_or(0.0, |block| block.speed);
        blocks.into_iter().take_while(|block| block.speed >= MOVES * fastest).collect()
    }

    fn free_blocks(&self) -> impl Iterator<Item = BlockId> {
        let mass_matrix = &self.workspace().mass_matrix;
        self.model().covers.blocks().filter(|&b| mass_matrix.is_free(b))
    }

    fn motion_at_rest(&self, block: BlockId) -> Restless {
        let (model, boundary) = (self.model(), &self.model().boundary);
        let (place, velocity, spin, _) = block_motion(model, self.state(), &self.workspace().mass_matrix, block);
        let area = model.covers.block_area(block);
        let touches = |contact: &&VertexEdge| {
            [boundary.nodes.point[contact.history.node], contact.history.edge]
                .iter()
                .any(|&point| boundary.block[point] == block)
        };
        let contacts = self.workspace().contacts.iter().filter(touches);
        let bearing = contacts.max_by(|a, b| a.history.normal_force.total_cmp(&b.history.normal_force));
        let law = bearing.filter(|contact| contact.history.normal_force > 0.0);
        Restless {
            block,
            label: model.labels[block],
            area,
            place,
            speed: libm::hypot(velocity.norm(), spin * (area / std::f64::consts::PI).sqrt()),
            law: law.and_then(|contact| self.case().joint_laws.keys().nth(contact.law.index()).cloned()),
        }
    }
}
