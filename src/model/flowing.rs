//! Water that flows in joints as it is seen: flow in each piece, and where water enters and leaves.

use enmm_seepage::{Condition, law};

use crate::flow::{FlowPiece, Inlet, Wet};

use super::Simulation;
use super::seepage::Seen;

/// A piece of joint that conducts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowingPiece {
    /// The piece.
    pub piece: FlowPiece,
    /// Apertures (m) at its nodes.
    pub apertures: [f64; 2],
    /// Unknowns (m) of its nodes: the pressure head above 0, the filling of the film below.
    pub unknowns: [f64; 2],
    /// Share of its capacity of the film that falls in it where it has no pressure: 0 dry, 1 full.
    pub filling: f64,
    /// Flow (m²/s) from its first to its second node.
    pub flow: f64,
}

/// A node at which water can enter or leave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowingInlet {
    /// Node.
    pub node: u32,
    /// Which of the inlets.
    pub inlet: Inlet,
    /// Whether it is open to the air, and not below water or a head.
    pub is_open: bool,
    /// Water (m²/s) that enters the joints there; negative where it leaves them.
    pub inflow: f64,
}

/// Water that flows in the joints as the last static stage found it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Flowing {
    /// Pieces that conduct.
    pub pieces: Vec<FlowingPiece>,
    /// Nodes at which water can enter or leave.
    pub inlets: Vec<FlowingInlet>,
    /// Whether each drain acts.
    pub drains: Vec<bool>,
}

impl Simulation {
    /// The flow in the joints as it was found last, if water flows in them.
    pub fn flowing(&self) -> Option<Flowing> {
        let (model, state) = (&self.built.model, &self.state);
        let (net, seepage) = (model.flow.as_ref()?, state.seepage.as_ref()?);
        let weight = seepage.surroundings.weight;
        let mut conductance = vec![0.0; net.pieces.len()];
        let mut inflow = vec![0.0; net.places.len()];
        let mut pieces = Vec::new();
        for (k, piece) in net.pieces.iter().enumerate().filter(|(k, _)| seepage.conducts[*k]) {
            let apertures = seepage.apertures[k];
            conductance[k] = net.conductance(piece, apertures, weight);
            let ends = piece.nodes.map(|node| (net.places[node as usize].y, seepage.unknowns[node as usize]));
            let (flow, filling) = flow_in(conductance[k], ends);
            inflow[piece.nodes[0] as usize] += flow;
            inflow[piece.nodes[1] as usize] -= flow;
            pieces.push(FlowingPiece { piece: *piece, apertures, unknowns: ends.map(|end| end.1), filling, flow });
        }
        let conducts = net.conducting(&conductance);
        let seen = Seen { model, state, net, stage: state.stage as usize, start: self.time(), way: None };
        let conditions = seen.conditions(&seepage.flooded, &conductance);
        let at = |(node, (condition, inlet)): (usize, &(Condition, Option<Inlet>))| {
            let inlet = inlet.filter(|_| conducts[node])?;
            let is_open = matches!(condition, Condition::Air | Condition::Rain { .. });
            Some(FlowingInlet { node: node as u32, inlet, is_open, inflow: inflow[node] })
        };
        let inlets = conditions.iter().enumerate().filter_map(at).collect();
        Some(Flowing { pieces, inlets, drains: seepage.surroundings.drains.clone() })
    }
}

impl Simulation {
    /// Sum over all joints (N/m) of the pressure of the water that flows in them; none where none flows.
    pub fn pressure_in_joints(&self) -> Option<f64> {
        let seepage = self.state.seepage.as_ref().filter(|_| self.model().flow.is_some())?;
        let pressed = |(piece, Wet { span, heads }, _): (&FlowPiece, Wet, bool)| {
            (span[1] - span[0]) * piece.length * 0.5 * (heads[0] + heads[1])
        };
        let pushing = self.wet_pieces().filter(|(.., has_parted)| !has_parted);
        Some(pushing.map(pressed).fold(0.0, |sum, part| sum + part) * seepage.surroundings.weight)
    }
}

/// Flow (m²/s) from the first to the second of two ends, height and unknown (m) each, and the filling of the film that
/// falls from the upper one.
fn flow_in(conductance: f64, [a, b]: [(f64, f64); 2]) -> (f64, f64) {
    let down = |upper: (f64, f64), lower: (f64, f64)| law::flow(conductance, upper.0 - lower.0, upper.1, lower.1);
    if a.0 >= b.0 { (down(a, b), law::filling(a.1)) } else { (-down(b, a), law::filling(b.1)) }
}
