//! Values that hosts read, in the structures of C.

use engine::cosimulation::{EventKind, PortKind, Totals};
use engine::geometry::{Point, polygon};
use engine::model::case::key::list;
use engine::model::tables::{BlockId, VertexEdge};
use engine::model::{BlockState, ContactState, Ledger};

use super::failure::{Failure, Outcome};
use super::model::Model;
use crate::types::*;

impl Model {
    /// The state of every block, by id.
    pub fn block_states(&self) -> Vec<enmm_block_state> {
        let failed = &self.inner.simulation().state().events.failed;
        let states = self.inner.block_states();
        states.iter().map(|state| block_state(state, failed[state.id as usize])).collect()
    }

    /// Energies and works.
    pub fn energies(&self) -> enmm_energies {
        energies(&self.inner.totals().ledger)
    }

    /// Sums and extremes.
    pub fn totals(&self) -> enmm_totals {
        totals(&self.inner.totals())
    }

    /// All contacts.
    pub fn contacts(&self) -> Vec<enmm_contact> {
        let simulation = self.inner.simulation();
        let (places, boundary) = (simulation.positions(), &simulation.model().boundary);
        let contacts = self.inner.contacts();
        let of = |contact: &VertexEdge| {
            let (history, [node_block, edge_block]) = (&contact.history, contact.blocks(boundary));
            let position = places[contact.point];
            enmm_contact {
                struct_size: size_of::<enmm_contact>(),
                state: match history.state {
                    ContactState::Open => enmm_contact_state::ENMM_CONTACT_OPEN,
                    ContactState::Slip => enmm_contact_state::ENMM_CONTACT_SLIP,
                    ContactState::Lock => enmm_contact_state::ENMM_CONTACT_LOCK,
                },
                law: contact.law.number(),
                node_block: node_block.number(),
                edge_block: edge_block.number(),
                position_x: position.x,
                position_y: position.y,
                normal_x: contact.normal.x,
                normal_y: contact.normal.y,
                length: contact.length,
                normal_stress: -history.normal_force / contact.length,
                shear_stress: history.shear_force / contact.length,
            }
        };
        contacts.iter().map(of).collect()
    }

    /// Events from the one of index `first` on.
    pub fn events(&self, first: usize) -> Vec<enmm_event> {
        let of = |event: engine::cosimulation::Event| enmm_event {
            struct_size: size_of::<enmm_event>(),
            kind: match event.kind {
                EventKind::Detached => enmm_event_kind::ENMM_EVENT_DETACHED,
                EventKind::Slipped => enmm_event_kind::ENMM_EVENT_SLIPPED,
                EventKind::Failed => enmm_event_kind::ENMM_EVENT_FAILED,
                EventKind::Overlapped => enmm_event_kind::ENMM_EVENT_OVERLAPPED,
                EventKind::Broken => enmm_event_kind::ENMM_EVENT_BROKEN,
            },
            subject: event.subject,
            time: event.time,
            other: event.other,
            reserved: 0,
            depth: event.depth,
        };
        self.inner.events().skip(first).map(of).collect()
    }

    /// Current boundary loops of a block, the outer one first.
    ///
    /// # Errors
    /// A block that does not exist or has been excavated.
    pub fn block_loops(&self, block: u32) -> Result<Vec<Vec<Point>>, Failure> {
        let state = self.inner.simulation().state();
        match state.removed.get(block as usize) {
            None => {
                let count = state.removed.len();
                let message = format!("block: is {block}, must be less than the number of blocks, {count}");
                Err(Failure::invalid(message))
            }
            Some(true) => {
                let message = format!("block {block} has been excavated; look at its flags before");
                Err(Failure::new(enmm_status::ENMM_NOT_FOUND, message))
            }
            Some(false) => {
                let mut loops = self.loops(|of| of.number() == block);
                let mut loops: Vec<_> = loops.drain(..).map(|(_, points)| points).collect();
                loops.sort_by(|a, b| polygon::area(b).total_cmp(&polygon::area(a)));
                Ok(loops)
            }
        }
    }

    /// The block whose rock covers a point now; the lowest id where blocks overlap or meet.
    ///
    /// # Errors
    /// No rock there.
    pub fn block_at(&self, p: Point) -> Result<u32, Failure> {
        if !(p.x.is_finite() && p.y.is_finite()) {
            return Err(Failure::invalid(format!("x, y: are {}, {}, must be finite numbers (m)", p.x, p.y)));
        }
        let removed = &self.inner.simulation().state().removed;
        let loops = self.loops(|block| !removed[block]);
        let mut around: Vec<BlockId> =
            loops.iter().filter(|(_, points)| polygon::contains(points, p)).map(|(block, _)| *block).collect();
        around.sort_unstable();
        // A point in a hole is inside the outer loop and the loop of the hole: rock is where the count is odd.
        let found = around.chunk_by(|a, b| a == b).find(|same| same.len() % 2 == 1);
        found.map(|same| same[0].number()).ok_or_else(|| {
            Failure::new(enmm_status::ENMM_NOT_FOUND, format!("there is no rock at ({}, {}) m now", p.x, p.y))
        })
    }

    /// Boundary loops of the `wanted` blocks at their current places.
    fn loops(&self, wanted: impl Fn(BlockId) -> bool) -> Vec<(BlockId, Vec<Point>)> {
        let simulation = self.inner.simulation();
        let places = simulation.positions();
        let loops = enmm_observe::loops(simulation).into_iter().filter(|(block, _)| wanted(*block));
        loops.map(|(block, points)| (block, places[points].to_vec())).collect()
    }

    /// Index of the port of this name.
    ///
    /// # Errors
    /// No port has the name.
    pub fn find_port(&self, name: &str) -> Result<u32, Failure> {
        let ports = self.inner.ports();
        let found = ports.iter().position(|port| port.name == name);
        found.map(|k| k as u32).ok_or_else(|| {
            let names = list(ports.iter().map(|port| port.name.as_str()));
            let message = format!("no port is named {name:?}; ports of the case: {names}");
            Failure::new(enmm_status::ENMM_NOT_FOUND, message)
        })
    }

    /// Name of a port.
    ///
    /// # Errors
    /// No such port.
    pub fn port_name(&self, port: u32) -> Result<&str, Failure> {
        self.check_port(port)?;
        Ok(&self.inner.ports()[port as usize].name)
    }

    /// Kind of a port.
    ///
    /// # Errors
    /// No such port.
    pub fn port_kind(&self, port: u32) -> Result<enmm_port_type, Failure> {
        self.check_port(port)?;
        Ok(match self.inner.ports()[port as usize].kind {
            PortKind::Block => enmm_port_type::ENMM_PORT_BLOCK,
            PortKind::Boundary => enmm_port_type::ENMM_PORT_BOUNDARY,
            PortKind::Joint => enmm_port_type::ENMM_PORT_JOINT,
        })
    }

    /// Block of a port: its own, or that of the first edge of a boundary or joint.
    ///
    /// # Errors
    /// No such port.
    pub fn port_block(&self, port: u32) -> Result<u32, Failure> {
        self.check_port(port)?;
        Ok(self.inner.ports()[port as usize].block.number())
    }

    /// State of a port.
    ///
    /// # Errors
    /// No such port.
    pub fn port_state(&self, port: u32) -> Result<enmm_port_state, Failure> {
        self.check_port(port)?;
        let state = self.inner.port_state(port as usize);
        Ok(enmm_port_state {
            struct_size: size_of::<enmm_port_state>(),
            displacement_x: state.displacement.x,
            displacement_y: state.displacement.y,
            velocity_x: state.velocity.x,
            velocity_y: state.velocity.y,
            rotation: state.rotation,
            angular_velocity: state.angular_velocity,
            contact_force_x: state.contact_force.x,
            contact_force_y: state.contact_force.y,
            stress_xx: state.stress[0],
            stress_yy: state.stress[1],
            stress_xy: state.stress[2],
            normal_force: state.normal_force,
            shear_force: state.shear_force,
            slip: state.slip,
        })
    }

    fn check_port(&self, port: u32) -> Outcome {
        let count = self.inner.ports().len();
        if (port as usize) < count {
            return Ok(());
        }
        let remedy = "name the place by `[[port]]` in the case";
        Err(Failure::invalid(format!("port: is {port}, must be less than the number of ports, {count}; {remedy}")))
    }
}

/// The table of energies as a structure.
fn energies(ledger: &Ledger) -> enmm_energies {
    enmm_energies {
        struct_size: size_of::<enmm_energies>(),
        kinetic: ledger.kinetic,
        strain: ledger.strain,
        potential: ledger.potential,
        stored: ledger.stored,
        friction: ledger.friction,
        contact_work: ledger.contact_work,
        support_work: ledger.support_work,
        damping: ledger.damping,
        external_work: ledger.external_work,
        baseline: ledger.baseline,
        contact_dissipation: ledger.contact_dissipation(),
        residual: ledger.residual(),
        yielding: ledger.yielding,
        bolt_work: ledger.bolts.work,
        radiation: ledger.radiation,
        bolt_stored: ledger.bolts.stored,
        bolt_installed: ledger.bolts.installed,
        bolt_dissipation: ledger.bolt_dissipation(),
        fracture: ledger.fracture,
    }
}

/// The table of sums and extremes as a structure.
fn totals(totals: &Totals) -> enmm_totals {
    enmm_totals {
        struct_size: size_of::<enmm_totals>(),
        displacement_max: totals.displacement_max,
        velocity_max: totals.velocity_max,
        penetration_max: totals.penetration_max,
        unbalanced: totals.unbalanced,
        critical_dt: totals.critical_dt,
        open_contacts: totals.contacts.open,
        slipping_contacts: totals.contacts.slipping,
        locked_contacts: totals.contacts.locked,
        detached_blocks: totals.detached_blocks,
        slipped_joints: totals.slipped_joints,
        failed_blocks: totals.failed_blocks,
        overlap_max: totals.overlap_max,
        overlapping_pairs: totals.overlapping_pairs,
        broken_length: totals.broken_length,
        broken_joints: totals.broken_joints,
    }
}

fn block_state(state: &BlockState, failed: bool) -> enmm_block_state {
    let flag = |holds: bool, bit: u32| if holds { bit } else { 0 };
    enmm_block_state {
        struct_size: size_of::<enmm_block_state>(),
        id: state.id,
        flags: flag(state.fixed, ENMM_BLOCK_FIXED)
            | flag(state.detached, ENMM_BLOCK_DETACHED)
            | flag(failed, ENMM_BLOCK_FAILED)
            | flag(state.removed, ENMM_BLOCK_REMOVED),
        centroid_x: state.centroid.x,
        centroid_y: state.centroid.y,
        displacement_x: state.displacement.x,
        displacement_y: state.displacement.y,
        rotation: state.rotation,
        velocity_x: state.velocity.x,
        velocity_y: state.velocity.y,
        angular_velocity: state.angular_velocity,
        mean_stress_xx: state.mean_stress[0],
        mean_stress_yy: state.mean_stress[1],
        mean_stress_xy: state.mean_stress[2],
        area: state.area,
        mass: state.mass,
        kinetic_energy: state.kinetic_energy,
        strain_energy: state.strain_energy,
        contact_count: state.contacts.count,
        reserved: 0,
        largest_penetration: state.contacts.penetration_max,
    }
}

#[cfg(test)]
mod tests {
    use engine::cosimulation::{ContactCounts, Quantity, TOTALS};
    use engine::model::{BoltEnergies, ENERGIES};

    use super::*;

    /// Fields of a structure as its `Debug` writes them, but for its size.
    fn fields(structure: &str) -> Vec<(&str, f64)> {
        let inside = structure.split_once(" { ").and_then(|(_, rest)| rest.strip_suffix(" }")).expect("fields");
        let pairs = inside.split(", ").map(|field| field.split_once(": ").expect("name: value"));
        pairs.skip(1).map(|(name, value)| (name, value.parse().expect("a number"))).collect()
    }

    /// A field for every row of the table and a row for every field, with the same value.
    fn hold<T>(structure: &str, table: &[Quantity<T>], value: &T) {
        let fields = fields(structure);
        for quantity in table {
            let found = fields.iter().find(|(name, _)| *name == quantity.name);
            assert_eq!(found.map(|field| field.1), Some((quantity.get)(value)), "{}", quantity.name);
        }
        assert_eq!(fields.len(), table.len(), "a field that is in no table: {fields:?}");
    }

    #[test]
    fn structures_hold_the_tables_of_quantities() {
        let ledger = Ledger {
            kinetic: 1.0,
            strain: 2.0,
            potential: 4.0,
            stored: 8.0,
            friction: 16.0,
            contact_work: 32.0,
            support_work: 64.0,
            damping: 128.0,
            yielding: 256.0,
            fracture: 32768.0,
            bolts: BoltEnergies { work: 512.0, stored: 1024.0, installed: 2048.0 },
            radiation: 4096.0,
            external_work: 8192.0,
            baseline: 16384.0,
        };
        hold(&format!("{:?}", energies(&ledger)), &ENERGIES, &ledger);
        let sums = Totals {
            ledger,
            displacement_max: 1.0,
            velocity_max: 2.0,
            contacts: ContactCounts { open: 3, slipping: 4, locked: 5 },
            penetration_max: 6.0,
            unbalanced: 7.0,
            critical_dt: 8.0,
            detached_blocks: 9,
            slipped_joints: 10,
            failed_blocks: 11,
            overlap_max: 12.0,
            overlapping_pairs: 13,
            broken_length: 14.0,
            broken_joints: 15,
        };
        hold(&format!("{:?}", totals(&sums)), &TOTALS, &sums);
    }
}
