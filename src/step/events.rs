//! Sees what happens for the first time: a block that loses its last contact, a joint that slips, a block that fails.

use crate::contact::ContactState;
use crate::geometry::Vector;
use crate::state::{Event, EventKind, Scratch, Slope, State};

use super::Regime;

/// Slip (m) relative to the mesh size from which a joint counts as slipped.
const SLIP_MIN: f64 = 1e-6;

/// Notes what the step that ends at `time` (s) has brought; static stages bring nothing, since their path is no motion.
pub fn note(slope: &Slope, regime: Regime, state: &mut State, scratch: &mut Scratch, time: f64) {
    let touching = &mut scratch.touching;
    touching.clear();
    touching.resize(slope.covers.block_count(), false);
    for contact in &state.contacts {
        let node = slope.boundary.node_point[contact.node as usize] as usize;
        touching[slope.boundary.block[node] as usize] = true;
        touching[slope.boundary.block[contact.edge as usize] as usize] = true;
    }
    if let Regime::Dynamic { .. } = regime {
        note_detached(state, scratch, time);
        note_slipped(slope, state, time);
        note_failed(slope, state, scratch, time);
    }
    state.events.touching.copy_from_slice(&scratch.touching);
}

fn note_detached(state: &mut State, scratch: &Scratch, time: f64) {
    let events = &mut state.events;
    for block in 0..scratch.touching.len() {
        let free = !scratch.mass_matrix.fixed[block] && !state.removed[block];
        let left = events.touching[block] && !scratch.touching[block];
        if left && free && !events.detached[block] {
            events.detached[block] = true;
            events.list.push(Event { kind: EventKind::Detached, subject: block as u32, time });
        }
    }
}

fn note_slipped(slope: &Slope, state: &mut State, time: f64) {
    let least = SLIP_MIN * slope.covers.mesh.size;
    let events = &mut state.events;
    let none = events.slipped.len() - 1;
    for contact in state.contacts.iter().filter(|c| c.state == ContactState::Slip && c.slip > least) {
        let trace = slope.boundary.trace[contact.edge as usize];
        let joint = (trace as usize).min(none);
        if !events.slipped[joint] {
            events.slipped[joint] = true;
            let subject = if joint == none { u32::MAX } else { trace };
            events.list.push(Event { kind: EventKind::Slipped, subject, time });
        }
    }
}

fn note_failed(slope: &Slope, state: &mut State, scratch: &mut Scratch, time: f64) {
    let limit = slope.failure_displacement;
    for (first, chunk) in slope.chunks.iter().enumerate().filter(|(_, chunk)| !chunk.blocks.is_empty()) {
        let parts = first..first + slope.chunks.parts(first).len().max(1);
        if scratch.sums[parts].iter().all(|sums| sums.is_near) {
            continue;
        }
        for block in chunk.blocks.clone().filter(|&b| !scratch.mass_matrix.fixed[b] && !state.removed[b]) {
            if state.events.failed[block] {
                continue;
            }
            let covers = slope.covers.covers_of(block);
            let sum: Vector = covers.map(|i| state.displacement[i] * slope.mass_matrix.row_sum[i]).sum();
            if sum.norm() > limit * slope.mass_matrix.total[block] {
                state.events.failed[block] = true;
                state.events.list.push(Event { kind: EventKind::Failed, subject: block as u32, time });
            }
        }
    }
    // An implicit step, which looks at no displacement, must not find these.
    scratch.sums.iter_mut().for_each(|sums| sums.is_near = false);
}
