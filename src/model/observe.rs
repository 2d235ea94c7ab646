//! Observation of a model at one instant, as far as hosts need it: the state of every block. The crate `enmm-observe`
//! has what else outputs show.
//!
//! All of it follows from the state alone, so that a restored model shows the same.

use crate::contact::{ContactHistory, ContactState};
use crate::cover::{BlockId, CoverId, ElementId};
use crate::geometry::{Point, Vector};
use crate::state::{Model, Quantity, State};
use crate::step;

use super::Simulation;

/// A block as hosts see it; velocities are those of half a step ago.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockState {
    /// Block id.
    pub id: u32,
    /// Whether no cover of the block can move.
    pub fixed: bool,
    /// Whether the block has been excavated.
    pub removed: bool,
    /// Whether it can move and no contact on it carries force.
    pub detached: bool,
    /// Mass centroid now (m).
    pub centroid: Point,
    /// Displacement of the mass centroid (m).
    pub displacement: Vector,
    /// Rotation that fits the covers best by mass (rad, counter-clockwise, within ±π).
    pub rotation: f64,
    /// Velocity of the mass centroid (m/s).
    pub velocity: Vector,
    /// Angular velocity (rad/s, counter-clockwise).
    pub angular_velocity: f64,
    /// Area mean of the stress xx, yy, xy (Pa, tension positive).
    pub mean_stress: [f64; 3],
    /// Area in the reference configuration (m²).
    pub area: f64,
    /// Mass (kg/m).
    pub mass: f64,
    /// Kinetic energy (J/m).
    pub kinetic_energy: f64,
    /// Strain energy (J/m).
    pub strain_energy: f64,
    /// Number and penetration of its contacts.
    pub contacts: BlockContacts,
}

/// Contacts of a block as hosts see them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockContacts {
    /// Those that carry force.
    pub count: u32,
    /// Largest penetration (m).
    pub penetration_max: f64,
}

/// Numbers of a block as outputs show them: the columns of `blocks.csv` and the structures of C and Python in this
/// order, the film and the arrays of the FMUs. The second name is that of the array, and empty where they have none.
/// New ones go to the end.
pub const BLOCK_QUANTITIES: [Quantity<BlockState>; 18] = [
    Quantity::new(["centroid_x", "block_x"], "m", "Mass centroid now, x", |block| block.centroid.x),
    Quantity::new(["centroid_y", "block_y"], "m", "Mass centroid now, y up", |block| block.centroid.y),
    Quantity::new(["displacement_x", "block_displacement_x"], "m", "Displacement of the mass centroid, x", |block| {
        block.displacement.x
    }),
    Quantity::new(
        ["displacement_y", "block_displacement_y"],
        "m",
        "Displacement of the mass centroid, y up",
        |block| block.displacement.y,
    ),
    Quantity::new(["rotation", "block_rotation"], "rad", "Rotation, counter-clockwise, within -pi and pi", |block| {
        block.rotation
    }),
    Quantity::new(["velocity_x", "block_velocity_x"], "m/s", "Velocity of the mass centroid, x", |block| {
        block.velocity.x
    }),
    Quantity::new(["velocity_y", "block_velocity_y"], "m/s", "Velocity of the mass centroid, y up", |block| {
        block.velocity.y
    }),
    Quantity::new(
        ["angular_velocity", "block_angular_velocity"],
        "rad/s",
        "Angular velocity, counter-clockwise",
        |block| block.angular_velocity,
    ),
    Quantity::new(
        ["mean_stress_xx", "block_stress_xx"],
        "Pa",
        "Area mean of the stress xx, tension positive",
        |block| block.mean_stress[0],
    ),
    Quantity::new(
        ["mean_stress_yy", "block_stress_yy"],
        "Pa",
        "Area mean of the stress yy, tension positive",
        |block| block.mean_stress[1],
    ),
    Quantity::new(["mean_stress_xy", "block_stress_xy"], "Pa", "Area mean of the stress xy", |block| {
        block.mean_stress[2]
    }),
    Quantity::new(["area", ""], "m2", "Area in the reference configuration", |block| block.area),
    Quantity::new(["mass", ""], "kg/m", "Mass", |block| block.mass),
    Quantity::new(["kinetic_energy", ""], "J/m", "Kinetic energy", |block| block.kinetic_energy),
    Quantity::new(["strain_energy", ""], "J/m", "Strain energy", |block| block.strain_energy),
    Quantity::count(["contacts", "block_contact_count"], "Contacts on the block that carry force", |block| {
        f64::from(block.contacts.count)
    }),
    Quantity::new(["penetration_max", "block_penetration"], "m", "Largest penetration", |block| {
        block.contacts.penetration_max
    }),
    Quantity::new(["speed", ""], "m/s", "Speed of the centroid", |block| block.velocity.norm()),
];

/// Displacement (m) and velocity (m/s) of a monitor.
pub type MonitorState = (Vector, Vector);

/// Numbers of a monitor as outputs show them: in `history.csv` by their second names, in the FMUs by their first.
pub const MONITOR_QUANTITIES: [Quantity<MonitorState>; 4] = [
    Quantity::new(["displacement_x", "ux"], "m", "Displacement, x", |(u, _)| u.x),
    Quantity::new(["displacement_y", "uy"], "m", "Displacement, y up", |(u, _)| u.y),
    Quantity::new(["velocity_x", "vx"], "m/s", "Velocity, x", |(_, v)| v.x),
    Quantity::new(["velocity_y", "vy"], "m/s", "Velocity, y up", |(_, v)| v.y),
];

impl Simulation {
    /// The state of every block, excavated ones included, by id.
    pub fn block_states(&self) -> Vec<BlockState> {
        let positions = positions(self.model(), self.state());
        let mut states: Vec<BlockState> = self.model().covers.blocks().map(|block| self.motion_of(block)).collect();
        let boundary = &self.model().boundary;
        for contact in &self.state().contacts {
            let node = boundary.nodes.point[contact.node];
            let depth = penetration(self.model(), &positions, contact);
            for block in [boundary.block[node], boundary.block[contact.edge]] {
                let state = &mut states[block];
                state.contacts.count += u32::from(contact.state != ContactState::Open);
                state.contacts.penetration_max = state.contacts.penetration_max.max(depth);
            }
        }
        for state in &mut states {
            state.detached = state.contacts.count == 0 && !state.fixed && !state.removed;
        }
        states
    }

    /// The state of one block without the quantities of its contacts.
    pub fn motion_of(&self, block: BlockId) -> BlockState {
        let (model, state) = (self.model(), self.state());
        let covers = &model.covers;
        let mass_matrix = &self.workspace().mass_matrix;
        let (_, velocity, spin, kinetic) = step::block_motion(model, state, mass_matrix, block);
        let displacement = self.displacement_of(block);
        let area = covers.block_area(block);
        let (mean_stress, strain_energy) = self.stress_of(block);
        let removed = state.removed[block];
        BlockState {
            id: block.number(),
            fixed: mass_matrix.fixed[block],
            removed,
            centroid: mean(model, &covers.star_position, block) + displacement,
            displacement,
            rotation: rotation(model, &state.displacement, block),
            velocity,
            angular_velocity: spin,
            mean_stress,
            area,
            mass: model.mass_matrix.total[block],
            kinetic_energy: if removed { 0.0 } else { kinetic },
            strain_energy,
            ..BlockState::default()
        }
    }
}

impl Simulation {
    /// Area mean of the stress xx, yy, xy (Pa, tension positive) and the strain energy (J/m) of a block.
    pub fn stress_of(&self, block: BlockId) -> ([f64; 3], f64) {
        let (model, state) = (self.model(), self.state());
        let covers = &model.covers;
        let area = covers.block_area(block);
        let (mut stress, mut strain_energy) = ([0.0; 3], 0.0);
        let patches = model.patch_means(state, covers.elements_of(block));
        for e in ElementId::range(covers.elements_of(block)) {
            let of_element = model.stress_under(state, e, &patches);
            (0..3).for_each(|k| stress[k] += of_element[k] * covers.element_area[e] / area);
            strain_energy += model.strain_energy(state, e, &patches) * covers.element_area[e];
        }
        (stress, strain_energy)
    }

    /// Displacement (m) of the mass centroid of a block.
    pub fn displacement_of(&self, block: BlockId) -> Vector {
        mean(self.model(), &self.state().displacement, block)
    }

    /// Rigid motion of a block: its centroid (m) and the velocity of that (m/s), its spin (rad/s) and its kinetic
    /// energy (J/m).
    pub fn rigid_motion_of(&self, block: BlockId) -> (Point, Vector, f64, f64) {
        step::block_motion(self.model(), self.state(), &self.workspace().mass_matrix, block)
    }

    /// Mass (kg/m) of blocks that are too few to decide about a slope: a thousandth of all free rock that no support
    /// holds, or of all free rock where supports hold each block.
    pub fn mass_of_few(&self) -> f64 {
        step::mass_of_few(self.model(), &self.workspace().mass_matrix)
    }

    /// Acceleration (m/s²) that acts on all rock now: gravity and body loads less that of the base.
    pub fn acceleration(&self) -> Vector {
        step::acceleration(self.model(), self.state(), self.time())
    }

    /// Forces (N/m) of all other loads on the covers now.
    pub fn load_forces(&self) -> Vec<Vector> {
        let mut forces = vec![Vector::zeros(); self.model().covers.cover_count()];
        step::push_forces(self.model(), self.state(), self.time(), 1.0, &mut forces);
        forces
    }

    /// Elements that are there and have yielded.
    pub fn yielded_elements(&self) -> usize {
        let state = self.state();
        let blocks = &self.model().covers.element_block;
        let there = state.plastic.iter().zip(blocks).filter(|(_, block)| !state.removed[**block]);
        there.filter(|(plastic, _)| **plastic != [0.0; 4]).count()
    }

    /// Current positions of the boundary points (m).
    pub fn positions(&self) -> Vec<Point> {
        positions(self.model(), self.state())
    }
}

/// Current positions of the boundary points (m).
fn positions(model: &Model, state: &State) -> Vec<Point> {
    let boundary = &model.boundary;
    let position = |i: CoverId| model.covers.star_position[i] + state.displacement[i];
    let sum = |(covers, weights): (&[CoverId; 3], &[f64; 3])| {
        covers.iter().zip(weights).map(|(&i, w)| position(i) * *w).sum()
    };
    boundary.covers.iter().zip(&boundary.weights).map(sum).collect()
}

/// Mean of a cover field over a block's mass.
pub(super) fn mean(model: &Model, field: &[Vector], block: BlockId) -> Vector {
    let sum: Vector = model.covers.covers_of(block).map(|i| field[i] * model.mass_matrix.row_sum[i]).sum();
    sum / model.mass_matrix.total[block]
}

/// Angle (rad) of the rotation that fits the displacements of the covers of a block best, weighted by mass.
pub(super) fn rotation(model: &Model, displacement: &[Vector], block: BlockId) -> f64 {
    let centre = mean(model, &model.covers.star_position, block);
    let shift = mean(model, displacement, block);
    let (mut cosine, mut sine) = (0.0, 0.0);
    for i in model.covers.covers_of(block) {
        let before = model.covers.star_position[i] - centre;
        let after = before + displacement[i] - shift;
        cosine += model.mass_matrix.row_sum[i] * before.dot(&after);
        sine += model.mass_matrix.row_sum[i] * before.perp(&after);
    }
    libm::atan2(sine, cosine)
}

/// Depth (m) of a contact's node behind its edge, 0 when it lies before it.
fn penetration(model: &Model, positions: &[Point], contact: &ContactHistory) -> f64 {
    let edge = contact.edge;
    let (a, b) = (positions[edge], positions[model.boundary.after(edge)]);
    let node = positions[model.boundary.nodes.point[contact.node]];
    ((b - a).normalize().perp(&(node - a))).max(0.0)
}
