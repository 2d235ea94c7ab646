//! Memory of the three heaps, counted: lengths of arrays times the size of an entry.

use crate::contact::Boundary;
use crate::cover::Covers;
use crate::flow::FlowNet;
use crate::mechanics::MassMatrix;

use super::workspace::{SelectionBuffers, YieldBuffers};
use super::{Drive, Events, Inputs, Model, Seepage, State, Surroundings, Workspace};

/// Name of a part of a heap, and its bytes.
pub type Part = (&'static str, usize);

/// An array, whatever it holds.
trait Array {
    fn bytes(&self) -> usize;
}

impl<T> Array for Vec<T> {
    fn bytes(&self) -> usize {
        size_of_val(self.as_slice())
    }
}

fn sum(arrays: &[&dyn Array]) -> usize {
    arrays.iter().map(|array| array.bytes()).sum()
}

fn total(parts: &[Part]) -> usize {
    parts.iter().map(|part| part.1).sum()
}

impl Model {
    /// Bytes of what is fixed.
    pub fn bytes(&self) -> usize {
        total(&self.memory())
    }

    /// Bytes of what is fixed, by part.
    pub fn memory(&self) -> Vec<Part> {
        let held = self.fixities.iter().map(|fixity| fixity.covers.bytes()).sum::<usize>();
        let ports = self.ports.iter().map(|port| port.edges.bytes()).sum::<usize>();
        vec![
            ("elements", elements(&self.covers) + self.element_rock.bytes()),
            ("polygons of elements", sum(&[&self.covers.polygons.start, &self.covers.polygons.points])),
            ("patches", self.chunks.bytes()),
            ("covers", covers(&self.covers)),
            ("boundary", boundary(&self.boundary)),
            ("masses", mass_matrix(&self.mass_matrix) + shared_masses(&self.mass_matrix)),
            ("yielding", self.averaging.bytes()),
            ("in-situ stress", sum(&[&self.pre_stress, &self.pre_stress_out])),
            ("flow in joints", self.flow.as_ref().map_or(0, net)),
            ("supports and ports", sum(&[&self.supports, &self.free_field, &self.bolts]) + held + ports),
        ]
    }
}

fn net(flow: &FlowNet) -> usize {
    sum(&[&flow.pieces, &flow.places, &flow.outcrops, &flow.apertures])
}

impl State {
    /// Bytes of what changes in time.
    pub fn bytes(&self) -> usize {
        total(&self.memory())
    }

    /// Bytes of what changes in time, by part.
    pub fn memory(&self) -> Vec<Part> {
        let Self {
            displacement,
            velocity,
            acceleration,
            since,
            stage_displacement,
            stage_force,
            contacts,
            bonds,
            sections,
            found,
            neighbours,
            plastic,
            columns,
            support_force,
            support_rest,
            worst_sections,
            cuts,
            fix_active,
            bolts,
            drive: Drive { from, to, since: _, until: _, before, moved },
            events: happened,
            removed,
            // A few entries for every law and stage of the case, or numbers.
            laws: _,
            law_switch: _,
            damping: _,
            water_density: _,
            seepage,
            stage_starts: _,
            most_rest: _,
            stage: _,
            stage_start: _,
            stage_step: _,
            step: _,
            part: _,
            dt_last: _,
            static_stretch: _,
            ledger: _,
            friction_delay: _,
            counters: _,
        } = self;
        let of_columns = columns.iter().map(|column| sum(&[&column.displacement, &column.velocity])).sum::<usize>();
        vec![
            (
                "motion",
                sum(&[displacement, velocity, acceleration, since, stage_displacement, stage_force]) + of_columns,
            ),
            ("contacts", contacts.bytes() + bonds.bytes() + sections.bytes() + found.bytes()),
            ("near pairs", neighbours.bytes()),
            ("plastic strain", plastic.bytes()),
            ("supports and bolts", sum(&[support_force, support_rest, fix_active, bolts])),
            ("inputs", inputs(from) + inputs(to) + sum(&[&before.rate, moved])),
            ("events", events(happened) + removed.bytes()),
            ("sections", worst_sections.bytes() + cuts.bytes()),
            ("flow in joints", seepage.as_ref().map_or(0, flowing)),
        ]
    }
}

fn flowing(seepage: &Seepage) -> usize {
    let Seepage {
        unknowns,
        conducts,
        apertures,
        flooded,
        surroundings,
        balances,
        rounds,
        passed: _,
        stored: _,
        time: _,
    } = seepage;
    let Surroundings { level: _, weight: _, heads, rains, drains } = surroundings;
    let of_rounds: usize = rounds.iter().map(|round| sum(&[&round.logs, &round.asked])).sum();
    of_rounds + sum(&[unknowns, conducts, apertures, flooded, balances, heads, rains, drains])
}

impl Workspace {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        total(&self.memory())
    }

    /// Bytes of the buffers, by part.
    pub fn memory(&self) -> Vec<Part> {
        let Self { motion, selection, supports, sweep, .. } = self;
        let fields: [&dyn Array; 5] =
            [&self.load_force, &motion.predicted, &motion.damped, &sweep.increment, &motion.exposed];
        let SelectionBuffers { accepted, cache, penetrating, faces, .. } = selection;
        vec![
            ("fields on covers", sum(&fields)),
            ("masses", mass_matrix(&self.mass_matrix)),
            ("blocks", sum(&[&motion.blocks, &motion.start, &self.sums, &sweep.push, &motion.turns, &motion.touching])),
            ("places", self.frames.bytes()),
            ("near sides", selection.near_sides.bytes()),
            ("accepted pairs", accepted.bytes() + cache.bytes() + penetrating.bytes() + faces.of_side.bytes()),
            ("search", selection.grid.bytes()),
            ("contacts", sum(&[&self.contacts, &self.outcomes])),
            ("open–close iteration", sweep.open_close.bytes()),
            ("supports and bolts", sum(&[&supports.rows, &supports.bolts])),
            ("yielding", yielding(&self.yielding)),
            ("overlaps", self.suspects.bytes()),
            ("implicit", self.of_integrator.as_ref().map_or(0, |buffers| buffers.bytes())),
        ]
    }
}

fn elements(covers: &Covers) -> usize {
    let Covers { element_covers, element_triangle, element_area, element_centroid, element_polar, .. } = covers;
    let Covers { element_block, block_ranges, host, .. } = covers;
    sum(&[element_covers, element_triangle, element_area, element_centroid, element_polar])
        + sum(&[element_block, &block_ranges.elements, host])
        + covers.index_bytes()
}

fn covers(covers: &Covers) -> usize {
    sum(&[&covers.star, &covers.star_position, &covers.cover_block, &covers.block_ranges.covers])
}

fn boundary(boundary: &Boundary) -> usize {
    let Boundary { covers, beyond, weights, reference, next, block, side, node_before, trace, partial, .. } = boundary;
    let Boundary { nodes, sides, slivers, block_thickness, .. } = boundary;
    sum(&[covers, beyond, slivers, weights, reference, next, block, side, node_before, trace, partial])
        + sum(&[&nodes.point, &nodes.convex, &nodes.edge_before, &nodes.previous, &nodes.next])
        + sum(&[&sides.previous, &sides.next, &sides.ends, block_thickness])
}

/// Bytes that the buffers share with the model.
fn shared_masses(MassMatrix { mass, row_sum, .. }: &MassMatrix) -> usize {
    size_of_val(&**mass) + size_of_val(&**row_sum)
}

fn mass_matrix(mass_matrix: &MassMatrix) -> usize {
    let MassMatrix { inertial, inverse, total, inverse_total, square, polar, .. } = mass_matrix;
    let MassMatrix { polar_lumped, spin, fixed, .. } = mass_matrix;
    sum(&[inertial, inverse, total, inverse_total, square, polar, polar_lumped, spin, fixed])
}

fn yielding(YieldBuffers { surfaces: _, flows, averages }: &YieldBuffers) -> usize {
    let grown: usize = flows.iter().map(|flow| sum(&[&flow.grown])).sum();
    sum(&[flows, &averages.volume, &averages.mean, &averages.patch_volume, &averages.patch_mean]) + grown
}

fn inputs(inputs: &Inputs) -> usize {
    let Inputs {
        block_force,
        block_moment,
        port_traction,
        port_pressure,
        port_velocity,
        head,
        rain,
        drain,
        gravity: _,
        base_acceleration: _,
        water_level: _,
        strength_factor: _,
    } = inputs;
    sum(&[block_force, block_moment, port_traction, port_pressure, port_velocity, head, rain, drain])
}

fn events(events: &Events) -> usize {
    let Events { list, touching, detached, slipped, failed, bonded, overlapped, overlap_max: _, port_slip } = events;
    sum(&[list, touching, detached, slipped, failed, bonded, overlapped, port_slip])
}
