//! Observation of a model at one instant, as far as hosts need it: the state of every block. The crate `enmm-observe`
//! has what else outputs show.
//!
//! All of it follows from the state alone, so that a restored model shows the same.

use crate::contact::{ContactHistory, ContactState, EdgeId, LawId, VertexEdge};
use crate::cover::{BlockId, CoverId};
use crate::geometry::{Point, Vector};
use crate::state::{Model, Quantity};
use crate::step;

use super::Simulation;

/// A block as hosts see it; velocities are those of half a step ago.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockState {
    /// Number of the block ([`Model::labels`](crate::state::Model::labels)).
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
    /// Share of its strength that the section of the block has which is nearest to breaking; 0 of rock that does not
    /// break.
    pub strength_share: f64,
}

/// A contact as hosts see it, with the forces of the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactView {
    /// Open, slip or lock.
    pub state: ContactState,
    /// Joint law.
    pub law: LawId,
    /// Numbers of the blocks of the node and of the edge.
    pub blocks: [u32; 2],
    /// Node now (m).
    pub position: Point,
    /// Outward unit normal of the edge now.
    pub normal: Vector,
    /// Length of boundary that the node stands for (m).
    pub length: f64,
    /// Force on the node along the normal (N/m, compression positive).
    pub normal_force: f64,
    /// Force on the node along the normal turned by 90° counter-clockwise (N/m).
    pub shear_force: f64,
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

/// Numbers of a block of rock that can break. Files show them behind those of [`BLOCK_QUANTITIES`] where the case has
/// such rock, so that those of all others stay as they are; hosts, which refuse such cases, have none.
pub const STRENGTH_QUANTITIES: [Quantity<BlockState>; 1] =
    [Quantity::new(["strength_share", ""], "", "Share of strength, worst section", |block| block.strength_share)];

/// Shares of strength above this are shown as it.
const SHARE_MAX: f64 = 1e6;

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
    /// The numbers of blocks that files of this model show.
    pub fn block_quantities(&self) -> impl Iterator<Item = &'static Quantity<BlockState>> {
        let of_strength = self.model().breaking.iter().flat_map(|_| &STRENGTH_QUANTITIES);
        BLOCK_QUANTITIES.iter().chain(of_strength)
    }

    /// The share of its strength that the worst section of a block has.
    pub fn strength_share(&self, block: BlockId) -> f64 {
        let of = self.state().worst_sections.get(block.index()).filter(|_| !self.state().removed[block]);
        of.map_or(0.0, |worst| worst.share.min(SHARE_MAX))
    }

    /// The state of every block, excavated ones included, by id.
    pub fn block_states(&self) -> Vec<BlockState> {
        self.blocks().to_vec()
    }

    /// The same, worked out at the first look after a step.
    pub fn blocks(&self) -> &[BlockState] {
        self.looks.blocks.get_or_init(|| {
            let mut states: Vec<BlockState> = self.model().covers.blocks().map(|block| self.motion_of(block)).collect();
            self.add_stresses(&mut states);
            for contact in &self.state().contacts {
                let depth = self.penetration(contact);
                for block in self.blocks_of(contact) {
                    let state = &mut states[block];
                    state.contacts.count += u32::from(contact.state != ContactState::Open);
                    state.contacts.penetration_max = state.contacts.penetration_max.max(depth);
                }
            }
            for state in &mut states {
                state.detached = state.contacts.count == 0 && !state.fixed && !state.removed;
            }
            states
        })
    }

    /// The same by the numbers that hosts and files show.
    pub fn blocks_by_number(&self) -> Vec<&BlockState> {
        let mut states: Vec<&BlockState> = self.blocks().iter().collect();
        states.sort_unstable_by_key(|state| state.id);
        states
    }

    /// Adds the area means of stress, and the strain energies of all blocks.
    fn add_stresses(&self, states: &mut [BlockState]) {
        let covers = &self.model().covers;
        self.model().each_stressed(
            self.state(),
            &self.state().displacement,
            0..covers.element_count(),
            |e, stress, energy| {
                let state = &mut states[covers.element_block[e]];
                (0..3).for_each(|k| state.mean_stress[k] += stress[k] * covers.element_area[e] / state.area);
                state.strain_energy += energy * covers.element_area[e];
            },
        );
    }

    /// Blocks of node and edge of a contact.
    pub fn blocks_of(&self, contact: &ContactHistory) -> [BlockId; 2] {
        let boundary = &self.model().boundary;
        [boundary.block[boundary.nodes.point[contact.node]], boundary.block[contact.edge]]
    }

    /// Number of [`Simulation::contact_views`]; with `serial` on the calling thread alone.
    pub fn contact_count(&self, serial: bool) -> usize {
        if self.knows_contacts() { self.state().contacts.len() } else { self.contact_views(serial).len() }
    }

    /// The block with a number that hosts see, if there is one now.
    pub fn block_labelled(&self, label: u32) -> Option<BlockId> {
        self.model().block_labelled(label)
    }

    /// The contacts of the last step at their places now, worked out at the first look after a step. Before the first
    /// step of a stage they are those that this step will find. With `serial` on the calling thread alone.
    pub fn contact_views(&self, serial: bool) -> &[ContactView] {
        self.looks.contacts.get_or_init(|| {
            if self.knows_contacts() {
                let state = self.state();
                state.contacts.iter().enumerate().map(|(k, contact)| self.view_of_last(k, contact)).collect()
            } else {
                let ahead = self.look_ahead_on(serial).1.contacts;
                ahead.iter().map(|contact| self.view_of_next(contact)).collect()
            }
        })
    }

    /// Whether the state has the contacts of a step of this stage with their lengths.
    fn knows_contacts(&self) -> bool {
        let state = self.state();
        let count = state.contacts.len();
        let has_stepped = state.stage_step > 0 || state.part > 0.0;
        has_stepped && (state.bonds.len() == count || state.found.contacts.len() == count)
    }

    /// A contact of the last step, at its place among them.
    fn view_of_last(&self, k: usize, contact: &ContactHistory) -> ContactView {
        let (model, state) = (self.model(), self.state());
        let (law, length) = match (state.bonds.get(k), state.found.contacts.get(k)) {
            (Some(bond), _) => (bond.law, bond.lengths[0]),
            (None, found) => {
                let trace = model.boundary.trace[contact.edge].or_else(|| model.boundary.node_trace(contact.node));
                let law = trace.map_or(model.default_law, |trace| state.law_switch[model.trace_law[trace]]);
                (law, found.map_or(0.0, |found| found.length))
            }
        };
        ContactView {
            state: contact.state,
            law,
            blocks: self.blocks_of(contact).map(|block| model.labels[block]),
            position: self.position(model.boundary.nodes.point[contact.node]),
            normal: self.normal_of(contact.edge),
            length,
            normal_force: contact.normal_force,
            shear_force: contact.shear_force,
        }
    }

    /// A contact that the next step will find.
    fn view_of_next(&self, contact: &VertexEdge) -> ContactView {
        ContactView {
            state: contact.history.state,
            law: contact.law,
            blocks: contact.blocks(&self.model().boundary).map(|block| self.model().labels[block]),
            position: self.position(contact.point),
            normal: contact.normal,
            length: contact.length,
            normal_force: contact.history.normal_force,
            shear_force: contact.history.shear_force,
        }
    }

    /// Outward unit normal of an edge now.
    pub fn normal_of(&self, edge: EdgeId) -> Vector {
        let along = (self.position(self.model().boundary.after(edge)) - self.position(edge)).normalize();
        Vector::new(along.y, -along.x)
    }

    /// Depth (m) of a contact's node behind its edge, 0 when it lies before it.
    fn penetration(&self, contact: &ContactHistory) -> f64 {
        let edge = contact.edge;
        let [a, b] = [edge, self.model().boundary.after(edge)].map(|point| self.position(point));
        let node = self.position(self.model().boundary.nodes.point[contact.node]);
        ((b - a).normalize().perp(&(node - a))).max(0.0)
    }

    /// Current position (m) of a point of the boundary.
    fn position(&self, point: EdgeId) -> Point {
        let model = self.model();
        let position = |i: CoverId| model.covers.star_position[i] + self.state().displacement[i];
        let boundary = &model.boundary;
        boundary.covers[point].iter().zip(&boundary.weights[point]).map(|(&i, w)| position(i) * *w).sum()
    }

    /// The state of one block without the quantities of its contacts, stress and strain energy.
    pub fn motion_of(&self, block: BlockId) -> BlockState {
        let (model, state) = (self.model(), self.state());
        let covers = &model.covers;
        let mass_matrix = &self.workspace().mass_matrix;
        let (_, velocity, spin, kinetic) = step::block_motion(model, state, mass_matrix, block);
        let (start, displacement) = (mean(model, &covers.star_position, block), self.displacement_of(block));
        let area = covers.block_area(block);
        let removed = state.removed[block];
        BlockState {
            id: model.labels[block],
            fixed: mass_matrix.fixed[block],
            removed,
            centroid: start + displacement,
            displacement,
            rotation: rotation_about(model, &state.displacement, block, [start, displacement]),
            velocity,
            angular_velocity: spin,
            area,
            mass: model.mass_matrix.total[block],
            kinetic_energy: if removed { 0.0 } else { kinetic },
            strength_share: self.strength_share(block),
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
        model.each_stressed(state, &state.displacement, covers.elements_of(block), |e, of_element, energy| {
            (0..3).for_each(|k| stress[k] += of_element[k] * covers.element_area[e] / area);
            strain_energy += energy * covers.element_area[e];
        });
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
        step::push_forces(self.model(), self.state(), step::Regime::AT_REST, self.time(), &mut forces[..]);
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
        self.model().boundary.edges().map(|point| self.position(point)).collect()
    }
}

/// Mean of a cover field over a block's mass.
pub(super) fn mean(model: &Model, field: &[Vector], block: BlockId) -> Vector {
    let sum: Vector = model.covers.covers_of(block).map(|i| field[i] * model.mass_matrix.row_sum[i]).sum();
    sum / model.mass_matrix.total[block]
}

/// Angle (rad) of the rotation that fits the displacements of the covers of a block best, weighted by mass.
pub(super) fn rotation(model: &Model, displacement: &[Vector], block: BlockId) -> f64 {
    let centre = mean(model, &model.covers.star_position, block);
    rotation_about(model, displacement, block, [centre, mean(model, displacement, block)])
}

/// The same, given the mass centroid (m) and its displacement (m).
fn rotation_about(model: &Model, displacement: &[Vector], block: BlockId, [centre, shift]: [Vector; 2]) -> f64 {
    let (mut cosine, mut sine) = (0.0, 0.0);
    for i in model.covers.covers_of(block) {
        let before = model.covers.star_position[i] - centre;
        let after = before + displacement[i] - shift;
        cosine += model.mass_matrix.row_sum[i] * before.dot(&after);
        sine += model.mass_matrix.row_sum[i] * before.perp(&after);
    }
    libm::atan2(sine, cosine)
}
