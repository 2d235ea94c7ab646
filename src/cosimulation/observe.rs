//! Outputs for a host: ports and totals. All of them follow from the state alone.

use crate::contact::{ContactHistory, ContactState, Support, VertexEdge};
use crate::cover::{self, BlockId};
use crate::geometry::Vector;
use crate::model::{ContactView, InletState, JointFlow, JointWater, Simulation};
use crate::state::{Event, EventKind, Ledger, Port, PortKind, Quantity};

use super::{Cosimulation, CosimulationError, Forces, Named};

/// A port as hosts see it. A block fills all up to the stress; a boundary displacement, velocity and stress; joints
/// normal and shear force, slip and the water that flows in them; a quiet boundary displacement, velocity and traction;
/// a fixity displacement, velocity and reaction.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PortState {
    /// Displacement of the block's mass centroid, or the mean along the boundary (m).
    pub displacement: Vector,
    /// Velocity of the same (m/s).
    pub velocity: Vector,
    /// Rotation of the block (rad, counter-clockwise).
    pub rotation: f64,
    /// Angular velocity of the block (rad/s).
    pub angular_velocity: f64,
    /// Sum of the contact forces on the block (N/m).
    pub contact_force: Vector,
    /// Mean stress xx, yy, xy in the block (Pa, tension positive), or in the blocks along the boundary.
    pub stress: [f64; 3],
    /// Sum of the normal forces across the joints (N/m, compression positive).
    pub normal_force: f64,
    /// Sum of the magnitudes of the shear forces along the joints (N/m).
    pub shear_force: f64,
    /// Largest slip that a contact has summed up so far (m).
    pub slip: f64,
    /// Mean traction of a quiet boundary on the rock (Pa).
    pub traction: Vector,
    /// Force of the supports of a fixity on the rock (N/m).
    pub reaction: Vector,
    /// Water that flows in the joints.
    pub water: JointWater,
}

/// Numbers of a port as outputs show them: the structures of C and Python in this order, and the FMUs.
pub const PORT_QUANTITIES: [Quantity<PortState>; 21] = [
    Quantity::plain("displacement_x", "m", "Displacement, x", |port| port.displacement.x),
    Quantity::plain("displacement_y", "m", "Displacement, y up", |port| port.displacement.y),
    Quantity::plain("velocity_x", "m/s", "Velocity, x", |port| port.velocity.x),
    Quantity::plain("velocity_y", "m/s", "Velocity, y up", |port| port.velocity.y),
    Quantity::plain("rotation", "rad", "Rotation, counter-clockwise", |port| port.rotation),
    Quantity::plain("angular_velocity", "rad/s", "Angular velocity, counter-clockwise", |port| port.angular_velocity),
    Quantity::plain("contact_force_x", "N/m", "Sum of the contact forces on the block per metre, x", |port| {
        port.contact_force.x
    }),
    Quantity::plain("contact_force_y", "N/m", "Sum of the contact forces on the block per metre, y", |port| {
        port.contact_force.y
    }),
    Quantity::plain("stress_xx", "Pa", "Mean stress xx, tension positive", |port| port.stress[0]),
    Quantity::plain("stress_yy", "Pa", "Mean stress yy, tension positive", |port| port.stress[1]),
    Quantity::plain("stress_xy", "Pa", "Mean stress xy", |port| port.stress[2]),
    Quantity::plain(
        "normal_force",
        "N/m",
        "Sum of the normal forces across the joints, compression positive",
        |port| port.normal_force,
    ),
    Quantity::plain("shear_force", "N/m", "Sum of the magnitudes of the shear forces along the joints", |port| {
        port.shear_force
    }),
    Quantity::plain("slip", "m", "Largest accumulated slip along the joints", |port| port.slip),
    Quantity::plain("traction_x", "Pa", "Mean traction of the quiet boundary on the rock, x", |port| port.traction.x),
    Quantity::plain("traction_y", "Pa", "Mean traction of the quiet boundary on the rock, y", |port| port.traction.y),
    Quantity::plain("reaction_x", "N/m", "Force of the moved supports on the rock per metre, x", |port| {
        port.reaction.x
    }),
    Quantity::plain("reaction_y", "N/m", "Force of the moved supports on the rock per metre, y", |port| {
        port.reaction.y
    }),
    Quantity::plain("water_pressure", "Pa", "Mean pressure of the water that flows in the joints", |port| {
        port.water.pressure
    }),
    Quantity::plain("water_pressure_max", "Pa", "Largest pressure of the water that flows in the joints", |port| {
        port.water.pressure_max
    }),
    Quantity::plain(
        "uplift",
        "N/m",
        "Force of the water that flows in the joints on each of their faces, which pushes them apart",
        |port| port.water.uplift,
    ),
];

/// Sums and extremes over the whole model.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Totals {
    /// Energies and works (J/m).
    pub ledger: Ledger,
    /// Largest displacement of a cover (m).
    pub displacement_max: f64,
    /// Largest velocity of a cover (m/s).
    pub velocity_max: f64,
    /// Contacts by their state.
    pub contacts: ContactCounts,
    /// Largest penetration of the run so far (m).
    pub penetration_max: f64,
    /// Net over applied force.
    pub unbalanced: f64,
    /// Critical internal step (s).
    pub critical_dt: f64,
    /// Blocks that have detached.
    pub detached_blocks: u32,
    /// Joints that have slipped.
    pub slipped_joints: u32,
    /// Blocks that have failed.
    pub failed_blocks: u32,
    /// Greatest depth of overlaps so far (m).
    pub overlap_max: f64,
    /// Pairs of blocks that have overlapped.
    pub overlapping_pairs: u64,
    /// Bonded length that has broken, of joints that soften (m).
    pub broken_length: f64,
    /// Joints whose last bond has broken.
    pub broken_joints: u64,
    /// Water that flows in joints.
    pub flow: JointFlow,
}

/// Contacts by their state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ContactCounts {
    /// Without force.
    pub open: u32,
    /// At their shear limit.
    pub slipping: u32,
    /// Below their shear limit.
    pub locked: u32,
}

/// Sums and extremes as outputs show them, but for the energies: the structures of C and Python in this order, and the
/// FMUs. New ones go to the end.
pub const TOTALS: [Quantity<Totals>; 22] = [
    Quantity::plain("displacement_max", "m", "Largest displacement of a cover", |totals| totals.displacement_max),
    Quantity::plain("velocity_max", "m/s", "Largest velocity of a cover", |totals| totals.velocity_max),
    Quantity::plain("penetration_max", "m", "Largest penetration so far", |totals| totals.penetration_max),
    Quantity::new(
        ["unbalanced", "unbalanced_ratio"],
        "",
        "Net over applied force, near 0 at rest; where nothing is applied 1, or 0 when all is balanced",
        |totals| totals.unbalanced,
    ),
    Quantity::plain("critical_dt", "s", "Stability limit of the internal step", |totals| totals.critical_dt),
    Quantity::count(["open_contacts"; 2], "Contacts without force", |totals| f64::from(totals.contacts.open)),
    Quantity::count(["slipping_contacts"; 2], "Contacts at their shear limit", |totals| {
        f64::from(totals.contacts.slipping)
    }),
    Quantity::count(["locked_contacts"; 2], "Contacts below their shear limit", |totals| {
        f64::from(totals.contacts.locked)
    }),
    Quantity::count(["detached_blocks"; 2], "Blocks that have lost their last contact at least once", |totals| {
        f64::from(totals.detached_blocks)
    }),
    Quantity::count(["slipped_joints"; 2], "Joints that have slipped", |totals| f64::from(totals.slipped_joints)),
    Quantity::count(["failed_blocks"; 2], "Blocks that have failed", |totals| f64::from(totals.failed_blocks)),
    Quantity::plain("overlap_max", "m", "Greatest depth of overlaps of blocks so far, 0 for none", |totals| {
        totals.overlap_max
    }),
    Quantity::count(["overlapping_pairs"; 2], "Pairs of blocks that have overlapped", |totals| {
        totals.overlapping_pairs as f64
    }),
    Quantity::plain("broken_length", "m", "Bonded length of rock bridges and joints that has broken", |totals| {
        totals.broken_length
    }),
    Quantity::count(["broken_joints"; 2], "Joints whose last bond has broken", |totals| totals.broken_joints as f64),
    Quantity::plain("water_entered", "m2", "Water that has entered joints in dynamic stages, m3 per metre", |totals| {
        totals.flow.passed[0]
    }),
    Quantity::plain("water_left", "m2", "Water that has left joints in dynamic stages, m3 per metre", |totals| {
        totals.flow.passed[1]
    }),
    Quantity::plain("flow_residual", "m2/s", "Largest imbalance of the flow at a node of the joints", |totals| {
        totals.flow.residual
    }),
    Quantity::plain(
        "seepage_height",
        "m",
        "Height of the highest outcrop from which water seeps, of the lowest joint where none does",
        |totals| totals.flow.seepage_height,
    ),
    Quantity::plain("water_stored", "m2", "Water that joints have taken in dynamic stages, m3 per metre", |totals| {
        totals.flow.stored
    }),
    Quantity::plain(
        "flow_parted",
        "m",
        "Length of wet joints that have parted, whose water pushes no more",
        |totals| totals.flow.parted.length,
    ),
    Quantity::count(["flow_parted_pieces"; 2], "Pieces of wet joints that have parted", |totals| {
        f64::from(totals.flow.parted.pieces)
    }),
];

impl Cosimulation {
    /// State of a port; see [`Cosimulation::ports`] for their number.
    ///
    /// # Panics
    /// When there is no such port.
    pub fn port_state(&self, port: usize) -> PortState {
        PortState { stress: self.stress_at(&self.ports()[port]), ..self.port_motion(port) }
    }

    /// State of a port without its stress, which costs more than all else.
    ///
    /// # Panics
    /// When there is no such port.
    pub fn port_motion(&self, index: usize) -> PortState {
        let port = &self.ports()[index];
        match port.kind {
            PortKind::Block => self.block_port(port.block),
            PortKind::Boundary => self.boundary_port(port),
            PortKind::Joint => self.joint_port(index),
            PortKind::Quiet => {
                let reaction = self.reaction(port);
                let length: f64 =
                    port.edges.iter().map(|&edge| self.simulation.model().boundary.reference_length(edge)).sum();
                PortState { traction: reaction / length, ..self.boundary_port(port) }
            }
            PortKind::Fix => {
                let motion = if port.edges.is_empty() { self.held_point(port) } else { self.boundary_port(port) };
                PortState { reaction: self.reaction(port), ..motion }
            }
        }
    }

    /// Supports of a port that hold, with their indices.
    fn supports(&self, port: &Port) -> impl Iterator<Item = (usize, &Support)> {
        let supports = self.simulation.model().supports.iter().enumerate();
        supports.filter(|(_, support)| port.fixities.contains(&support.fix))
    }

    /// Force (N/m) of the supports of a port on the rock in the last internal step.
    fn reaction(&self, port: &Port) -> Vector {
        let state = self.simulation.state();
        let is_frozen = port.kind == PortKind::Quiet;
        let bears = |support: &Support| is_frozen || state.fix_active[support.fix as usize];
        let own = self.supports(port).filter(|(_, support)| bears(support) && !state.removed[support.block]);
        own.map(|(k, support)| support.direction * state.support_force[k]).sum()
    }

    /// Motion of the point that a port holds.
    fn held_point(&self, port: &Port) -> PortState {
        let state = self.simulation.state();
        let Some((_, support)) = self.supports(port).next() else { return PortState::default() };
        let sample = |field: &[Vector]| cover::sample(&support.covers, &support.weights, field);
        PortState {
            displacement: sample(&state.displacement),
            velocity: sample(&state.velocity),
            ..PortState::default()
        }
    }

    /// Energies and works (J/m) half an internal step ago, as the velocities are; what contacts, supports and bolts
    /// store is that of the start of the last internal step.
    pub fn energies(&self) -> Ledger {
        let mut ledger = self.simulation.energies_at_velocities();
        let forces = self.forces();
        (ledger.stored, ledger.bolts.stored) = (forces.stored, forces.in_bolts);
        ledger
    }

    /// Results of the forces of the last internal step, or will follow from those of the next one when the last
    /// one was not looked at: before the start, and where a communication step was left before its end.
    fn forces(&self) -> Forces {
        self.progress.forces.unwrap_or_else(|| Forces::of(&self.look(Simulation::report_on)))
    }

    /// Sums and extremes now; the unbalanced ratio is that of the start of the last internal step.
    pub fn totals(&self) -> Totals {
        let state = self.simulation.state();
        let most = |field: &[Vector]| field.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let contacts = |which| state.contacts.iter().filter(|contact| contact.state == which).count() as u32;
        let of_kind = |event: &&Event, which| event.kind == which && event.subject != u32::MAX;
        let events = |which| state.events.list.iter().filter(|event| of_kind(event, which)).count() as u32;
        Totals {
            ledger: self.energies(),
            displacement_max: most(&state.displacement),
            velocity_max: most(&state.velocity),
            contacts: ContactCounts {
                open: contacts(ContactState::Open),
                slipping: contacts(ContactState::Slip),
                locked: contacts(ContactState::Lock),
            },
            penetration_max: state.counters.penetration_max,
            unbalanced: self.forces().unbalanced,
            critical_dt: self.simulation.model().critical_dt,
            detached_blocks: events(EventKind::Detached),
            slipped_joints: events(EventKind::Slipped),
            failed_blocks: events(EventKind::Failed),
            broken_length: state.counters.broken,
            broken_joints: u64::from(events(EventKind::Broken)),
            overlap_max: state.events.overlap_max,
            overlapping_pairs: state.events.overlapped.len() as u64,
            flow: self.simulation.joint_flow(),
        }
    }

    /// Water at a head, in rain or at a drain, by kind and place in the case, as the flow was found last.
    ///
    /// # Errors
    /// There is none of that number, or water does not enter or leave at things of that kind.
    pub fn inlet(&self, kind: Named, index: usize) -> Result<InletState, CosimulationError> {
        self.check_named(kind, index)?;
        let (heads, rains) = (self.name_count(Named::Head), self.name_count(Named::Rain));
        let before = match kind {
            Named::Head => 0,
            Named::Rain => heads,
            Named::Drain => heads + rains,
            _ => return Err(CosimulationError::value("kind", kind.plural(), "heads, rains or drains", "name one")),
        };
        Ok(self.simulation.inlet(before + index))
    }

    /// See [`Simulation::contact_views`].
    pub fn contact_views(&self) -> &[ContactView] {
        self.look(|simulation, serial| _ = simulation.contact_views(serial));
        self.simulation.contact_views(true)
    }

    /// Number of [`Cosimulation::contact_views`].
    pub fn contact_count(&self) -> usize {
        self.look(Simulation::contact_count)
    }

    /// The contacts that the next step will find, with the forces of the last one; a look costs as much as a step.
    pub fn contacts(&self) -> Vec<VertexEdge> {
        self.look(|simulation, serial| simulation.look_ahead_on(serial).1.contacts)
    }

    /// Mean stress xx, yy, xy (Pa) in the block of a port, or in the blocks along its boundary; 0 of joints.
    fn stress_at(&self, port: &Port) -> [f64; 3] {
        let mut lengths: Vec<(BlockId, f64)> = match port.kind {
            PortKind::Block => vec![(port.block, 1.0)],
            PortKind::Boundary => Vec::new(),
            PortKind::Joint | PortKind::Quiet | PortKind::Fix => return [0.0; 3],
        };
        let boundary = &self.simulation.model().boundary;
        for &edge in &port.edges {
            let (block, length) = (boundary.block[edge], boundary.reference_length(edge));
            match lengths.iter_mut().find(|of| of.0 == block) {
                Some(of) => of.1 += length,
                None => lengths.push((block, length)),
            }
        }
        let total: f64 = lengths.iter().map(|of| of.1).sum();
        let mut mean = [0.0; 3];
        for (block, length) in lengths {
            let (stress, _) = self.simulation.stress_of(block);
            (0..3).for_each(|k| mean[k] += stress[k] * length);
        }
        mean.map(|stress| stress / total)
    }

    fn block_port(&self, block: BlockId) -> PortState {
        let motion = self.simulation.motion_of(block);
        let mut contact_force = Vector::zeros();
        for contact in &self.simulation.state().contacts {
            let [of_node, of_edge] = self.simulation.blocks_of(contact);
            let sign = f64::from(i8::from(of_node == block) - i8::from(of_edge == block));
            if sign != 0.0 {
                contact_force += self.force_on_node(contact) * sign;
            }
        }
        PortState {
            displacement: motion.displacement,
            velocity: motion.velocity,
            rotation: motion.rotation,
            angular_velocity: motion.angular_velocity,
            contact_force,
            ..PortState::default()
        }
    }

    fn boundary_port(&self, port: &Port) -> PortState {
        let (model, state) = (self.simulation.model(), self.simulation.state());
        let boundary = &model.boundary;
        let mut mean = PortState::default();
        let mut total = 0.0;
        for &edge in &port.edges {
            let ends = [edge, boundary.after(edge)];
            let length = boundary.reference_length(edge);
            let sample = |field: &[Vector]| ends.map(|k| boundary.sample(k, field)).iter().sum::<Vector>() * 0.5;
            mean.displacement += sample(&state.displacement) * length;
            mean.velocity += sample(&state.velocity) * length;
            total += length;
        }
        mean.displacement /= total;
        mean.velocity /= total;
        mean
    }

    fn joint_port(&self, index: usize) -> PortState {
        let (port, state) = (&self.ports()[index], self.simulation.state());
        let boundary = &self.simulation.model().boundary;
        let water = self.simulation.joint_water(&port.edges);
        let mut sum = PortState { slip: state.events.port_slip[index], water, ..PortState::default() };
        for contact in state.contacts.iter().filter(|contact| port.has(contact, boundary)) {
            sum.normal_force += contact.normal_force;
            sum.shear_force += contact.shear_force.abs();
        }
        sum
    }

    /// Force of a contact on its node (N/m); its edge feels the opposite.
    fn force_on_node(&self, contact: &ContactHistory) -> Vector {
        let normal = self.simulation.normal_of(contact.edge);
        normal * contact.normal_force + Vector::new(-normal.y, normal.x) * contact.shear_force
    }
}
