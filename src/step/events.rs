//! Sees what happens for the first time: a block that loses its last contact, a joint that slips, a block that fails.

use crate::contact::{ContactState, LawId};
use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::state::{Event, EventKind, Model, PortKind, State, Workspace};

use super::Regime;

/// Slip (m) relative to the mesh size from which a joint counts as slipped.
const SLIP_MIN: f64 = 1e-6;

/// Notes what the step that ends at `time` (s) has brought; static stages bring nothing but broken bonds and the
/// slip of ports, since their path is no motion.
pub fn note(model: &Model, regime: Regime, state: &mut State, workspace: &mut Workspace, time: f64) {
    let touching = &mut workspace.motion.touching;
    touching.clear();
    touching.resize(model.covers.block_count(), false);
    for contact in &state.contacts {
        let node = model.boundary.nodes.point[contact.node];
        touching[model.boundary.block[node]] = true;
        touching[model.boundary.block[contact.edge]] = true;
    }
    note_slip_of_ports(model, state);
    if !state.bonds.is_empty() {
        note_broken(model, state, time);
    }
    if let Regime::Dynamic { .. } = regime {
        note_detached(model, state, workspace, time);
        note_slipped(model, state, time);
        note_failed(model, state, workspace, time);
    }
    state.events.touching.copy_from_slice(&workspace.motion.touching);
}

fn note_detached(model: &Model, state: &mut State, workspace: &Workspace, time: f64) {
    let events = &mut state.events;
    for block in BlockId::all(workspace.motion.touching.len()) {
        let free = !workspace.mass_matrix.fixed[block] && !state.removed[block];
        let left = events.touching[block] && !workspace.motion.touching[block];
        if left && free && !events.detached[block] {
            events.detached[block] = true;
            events.list.push(Event::of(EventKind::Detached, model.labels[block], time));
        }
    }
}

fn note_broken(model: &Model, state: &mut State, time: f64) {
    let mut held = std::mem::take(&mut state.events.bonded);
    held.resize(model.trace_law.len(), false);
    let softens = |law: LawId| state.laws[law].softening.is_some();
    let mut holds = vec![false; held.len()];
    for (contact, bond) in state.held_bonds() {
        let edges = model.boundary.edges_about(contact.node).chain([contact.edge]);
        for trace in edges.filter_map(|edge| model.boundary.trace[edge]) {
            holds[trace.index()] |= state.law_switch[model.trace_law[trace.index()]] == bond.law;
        }
    }
    for (trace, (was, is)) in held.iter().zip(&holds).enumerate() {
        let soft = softens(state.law_switch[model.trace_law[trace]]);
        if *was && !is && soft && !is_crack(model, trace) {
            state.events.list.push(Event::of(EventKind::Broken, trace as u32, time));
        }
    }
    state.events.bonded = holds;
}

/// Whether rock has broken along a trace: its event is that of the cut.
fn is_crack(model: &Model, trace: usize) -> bool {
    let rocks = model.breaking.iter().flat_map(|breaking| breaking.rocks.iter().flatten());
    rocks.into_iter().any(|rock| rock.law == model.trace_law[trace])
}

fn note_slipped(model: &Model, state: &mut State, time: f64) {
    let least = SLIP_MIN * model.covers.mesh.size;
    let events = &mut state.events;
    let none = events.slipped.len() - 1;
    for contact in state.contacts.iter().filter(|c| c.state == ContactState::Slip && c.slip > least) {
        let trace = model.boundary.trace[contact.edge];
        let joint = trace.map_or(none, |trace| trace.index());
        if !events.slipped[joint] {
            events.slipped[joint] = true;
            let subject = trace.map_or(u32::MAX, |trace| trace.number());
            events.list.push(Event::of(EventKind::Slipped, subject, time));
        }
    }
}

fn note_slip_of_ports(model: &Model, state: &mut State) {
    for (port, most) in
        model.ports.iter().zip(&mut state.events.port_slip).filter(|(port, _)| port.kind == PortKind::Joint)
    {
        // Most contacts have not slipped farther than the port already has.
        for contact in &state.contacts {
            if contact.slip > *most && port.has(contact, &model.boundary) {
                *most = contact.slip;
            }
        }
    }
}

fn note_failed(model: &Model, state: &mut State, workspace: &mut Workspace, time: f64) {
    let limit = model.failure_displacement;
    for (first, chunk) in model.chunks.iter().enumerate().filter(|(_, chunk)| !chunk.blocks.is_empty()) {
        let parts = first..first + model.chunks.parts(first).len().max(1);
        if workspace.sums[parts].iter().all(|sums| sums.is_near) {
            continue;
        }
        for block in
            BlockId::range(chunk.blocks.clone()).filter(|&b| !workspace.mass_matrix.fixed[b] && !state.removed[b])
        {
            if state.events.failed[block] {
                continue;
            }
            let covers = model.covers.covers_of(block);
            let sum: Vector = covers.map(|i| state.displacement[i] * model.mass_matrix.row_sum[i]).sum();
            if sum.norm() > limit * model.mass_matrix.total[block] {
                state.events.failed[block] = true;
                state.events.list.push(Event::of(EventKind::Failed, model.labels[block], time));
            }
        }
    }
    // An implicit step, which looks at no displacement, must not find these.
    workspace.sums.iter_mut().for_each(|sums| sums.is_near = false);
}
