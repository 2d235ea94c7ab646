//! Values that hosts read, in the structures of C.

use engine::cosimulation::{EventKind, PortKind, SectionFailure};
use engine::geometry::{Point, polygon};
use engine::model::tables::BlockId;
use engine::model::{ContactState, ContactView};

use super::failure::Failure;
use super::model::Model;
use crate::numbers::*;
use crate::types::*;

impl Model {
    /// The state of every block, by id.
    pub fn block_states(&self) -> impl Iterator<Item = enmm_block_state> + '_ {
        let simulation = self.inner.simulation();
        let failed = &simulation.state().events.failed;
        let has_failed = move |id: u32| simulation.block_labelled(id).is_some_and(|block| failed[block]);
        self.inner.blocks().into_iter().map(move |state| enmm_block_state::new(state, has_failed(state.id)))
    }

    /// Number of blocks.
    pub fn block_count(&self) -> usize {
        self.inner.simulation().state().removed.len()
    }

    /// The states of the blocks in memory of the model, until the next call.
    pub fn view_block_states(&mut self) -> &[enmm_block_state] {
        let mut viewed = std::mem::take(&mut self.viewed);
        viewed.clear();
        viewed.extend(self.block_states());
        self.viewed = viewed;
        &self.viewed
    }

    /// Energies and works.
    pub fn energies(&self) -> enmm_energies {
        enmm_energies::from(&self.inner.energies())
    }

    /// Sums and extremes.
    pub fn totals(&self) -> enmm_totals {
        enmm_totals::from(&self.inner.totals())
    }

    /// All contacts.
    pub fn contacts(&self) -> impl Iterator<Item = enmm_contact> + '_ {
        let of = |contact: &ContactView| enmm_contact {
            struct_size: size_of::<enmm_contact>(),
            state: match contact.state {
                ContactState::Open => enmm_contact_state::ENMM_CONTACT_OPEN,
                ContactState::Slip => enmm_contact_state::ENMM_CONTACT_SLIP,
                ContactState::Lock => enmm_contact_state::ENMM_CONTACT_LOCK,
            },
            law: contact.law.number(),
            node_block: contact.blocks[0],
            edge_block: contact.blocks[1],
            position_x: contact.position.x,
            position_y: contact.position.y,
            normal_x: contact.normal.x,
            normal_y: contact.normal.y,
            length: contact.length,
            normal_stress: -contact.normal_force / contact.length,
            shear_stress: contact.shear_force / contact.length,
        };
        self.inner.contact_views().iter().map(of)
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
                EventKind::Cut => enmm_event_kind::ENMM_EVENT_CUT,
            },
            subject: event.subject,
            time: event.time,
            other: event.other,
            reserved: 0,
            depth: event.depth,
        };
        self.inner.events().skip(first).map(of).collect()
    }

    /// Sections of rock that have broken, in order.
    pub fn cuts(&self) -> impl ExactSizeIterator<Item = enmm_cut> + '_ {
        self.inner.cuts().map(|cut| enmm_cut {
            struct_size: size_of::<enmm_cut>(),
            block: cut.block,
            part: cut.part,
            failure: match cut.failure {
                SectionFailure::Opens => enmm_section_failure::ENMM_SECTION_OPENED,
                SectionFailure::Slides => enmm_section_failure::ENMM_SECTION_SLID,
                SectionFailure::Bends => enmm_section_failure::ENMM_SECTION_BENT,
                SectionFailure::Splits => enmm_section_failure::ENMM_SECTION_SPLIT,
            },
            reserved: 0,
            time: cut.time,
            first_x: cut.ends[0].x,
            first_y: cut.ends[0].y,
            second_x: cut.ends[1].x,
            second_y: cut.ends[1].y,
            share: cut.share,
            normal_force: cut.carried.normal,
            shear_force: cut.carried.shear,
            moment: cut.carried.moment,
        })
    }

    /// Current boundary loops of a block, the outer one first.
    ///
    /// # Errors
    /// A block that does not exist or has been excavated.
    pub fn block_loops(&self, block: u32) -> Result<Vec<Vec<Point>>, Failure> {
        let own = self.inner.own_block(block)?;
        if self.inner.simulation().state().removed[own] {
            let message = format!("block {block} has been excavated; look at its flags before");
            return Err(Failure::new(enmm_status::ENMM_NOT_FOUND, message));
        }
        let mut loops: Vec<_> = self.loops(|of| of == own).into_iter().map(|(_, points)| points).collect();
        loops.sort_by(|a, b| polygon::area(b).total_cmp(&polygon::area(a)));
        Ok(loops)
    }

    /// The block whose rock covers a point now; the lowest id where blocks overlap or meet.
    ///
    /// # Errors
    /// No rock there.
    pub fn block_at(&self, p: Point) -> Result<u32, Failure> {
        if !(p.x.is_finite() && p.y.is_finite()) {
            return Err(Failure::invalid(format!("x, y: are {}, {}, must be finite numbers (m)", p.x, p.y)));
        }
        let simulation = self.inner.simulation();
        let (removed, labels) = (&simulation.state().removed, &simulation.model().labels);
        let loops = self.loops(|block| !removed[block]);
        let mut around: Vec<u32> =
            loops.iter().filter(|(_, points)| polygon::contains(points, p)).map(|(block, _)| labels[*block]).collect();
        around.sort_unstable();
        // A point in a hole is inside the outer loop and the loop of the hole: rock is where the count is odd.
        let found = around.chunk_by(|a, b| a == b).find(|same| same.len() % 2 == 1);
        found.map(|same| same[0]).ok_or_else(|| {
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
        Ok(self.inner.find_port(name)? as u32)
    }

    /// Name of a port.
    ///
    /// # Errors
    /// No such port.
    pub fn port_name(&self, port: u32) -> Result<&str, Failure> {
        Ok(&self.inner.port(port as usize)?.name)
    }

    /// Kind of a port.
    ///
    /// # Errors
    /// No such port.
    pub fn port_kind(&self, port: u32) -> Result<enmm_port_type, Failure> {
        Ok(match self.inner.port(port as usize)?.kind {
            PortKind::Block => enmm_port_type::ENMM_PORT_BLOCK,
            PortKind::Boundary => enmm_port_type::ENMM_PORT_BOUNDARY,
            PortKind::Joint => enmm_port_type::ENMM_PORT_JOINT,
            PortKind::Quiet => enmm_port_type::ENMM_PORT_QUIET,
            PortKind::Fix => enmm_port_type::ENMM_PORT_FIX,
        })
    }

    /// Block of a port: its own, or that of the first edge of a boundary or joint.
    ///
    /// # Errors
    /// No such port.
    pub fn port_block(&self, port: u32) -> Result<u32, Failure> {
        Ok(self.inner.port_block(port as usize)?)
    }

    /// State of a port.
    ///
    /// # Errors
    /// No such port.
    pub fn port_state(&self, port: u32) -> Result<enmm_port_state, Failure> {
        let port = port as usize;
        self.inner.port(port)?;
        Ok(enmm_port_state::from(&self.inner.port_state(port)))
    }
}
