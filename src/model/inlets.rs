//! Water that flows in joints as hosts see it: at heads, rain and drains, and in the joints of ports.

use crate::contact::EdgeId;
use crate::flow::FlowPiece;
use crate::state::Quantity;
use crate::step;

use super::Simulation;
use super::parted::Parted;

/// Water at a head, in rain or at a drain, as the flow was found last.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct InletState {
    /// Water that enters joints there, less what leaves them (m²/s).
    pub inflow: f64,
    /// Water that leaves joints there, less what enters them (m²/s).
    pub outflow: f64,
    /// Rain that joints do not take (m²/s).
    pub run_off: f64,
}

/// Numbers of heads, rain and drains as outputs show them.
pub const INLET_QUANTITIES: [Quantity<InletState>; 3] = [
    Quantity::plain("inflow", "m2/s", "Water that enters joints there, less what leaves them", |inlet| inlet.inflow),
    Quantity::plain("outflow", "m2/s", "Water that leaves joints there, less what enters them", |inlet| inlet.outflow),
    Quantity::plain("run_off", "m2/s", "Rain that joints do not take, 0 at heads and drains", |inlet| inlet.run_off),
];

/// Water that flows in some joints.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointWater {
    /// Mean pressure along them (Pa).
    pub pressure: f64,
    /// Greatest pressure (Pa).
    pub pressure_max: f64,
    /// Force that pushes their faces apart (N/m).
    pub uplift: f64,
}

/// Water that flows through all joints.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointFlow {
    /// Water that has entered and left in dynamic stages (m², that is m³ per metre of depth).
    pub passed: [f64; 2],
    /// Water that joints have taken in dynamic stages (m²).
    pub stored: f64,
    /// Greatest imbalance of a node (m²/s).
    pub residual: f64,
    /// Height of the highest outcrop from which water seeps, that of the lowest joint where none does (m).
    pub seepage_height: f64,
    /// Wet joints that have parted.
    pub parted: Parted,
}

impl Simulation {
    /// Water at one of the heads, rains and drains, by its place among them in this order.
    pub fn inlet(&self, place: usize) -> InletState {
        let balance = self.state.seepage.as_ref().and_then(|seepage| seepage.balances.last());
        let sums = balance.and_then(|balance| balance.sums.get(place)).copied().unwrap_or_default();
        let [enters, leaves, run_off] = sums;
        InletState { inflow: enters - leaves, outflow: leaves - enters, run_off }
    }

    /// Water that flows through all joints; zeros where none does.
    pub fn joint_flow(&self) -> JointFlow {
        let (Some(net), Some(seepage)) = (&self.model().flow, &self.state.seepage) else { return JointFlow::default() };
        let balance = seepage.balances.last();
        let lowest = || net.places.iter().map(|place| place.y).fold(f64::INFINITY, f64::min);
        JointFlow {
            passed: seepage.passed,
            stored: seepage.stored,
            residual: balance.map_or(0.0, |balance| balance.residual),
            seepage_height: balance.and_then(|balance| balance.seeps).unwrap_or_else(lowest),
            parted: self.parted(),
        }
    }

    /// Water that flows in the joints of some edges of the boundary, in their order; by the length of joints before
    /// they deform. Joints that have parted have no pressure.
    pub fn joint_water(&self, edges: &[EdgeId]) -> JointWater {
        let Some(net) = &self.model().flow else { return JointWater::default() };
        let is_own = |piece: &FlowPiece| piece.edges.iter().any(|edge| edges.binary_search(edge).is_ok());
        let length: f64 = net.pieces.iter().filter(|piece| is_own(piece)).map(|piece| piece.length).sum();
        let (mut sum, mut most) = (0.0, 0.0_f64);
        for (piece, part, _) in self.wet_pieces().filter(|(piece, _, has_parted)| is_own(piece) && !has_parted) {
            sum += 0.5 * (part.heads[0] + part.heads[1]) * (part.span[1] - part.span[0]).abs() * piece.length;
            most = part.heads.into_iter().fold(most, f64::max);
        }
        let weight = self.water_weight();
        JointWater {
            pressure: if length > 0.0 { weight * sum / length } else { 0.0 },
            pressure_max: weight * most,
            uplift: weight * sum,
        }
    }

    /// Unit weight (N/m³) of the water, as far as it acts now.
    fn water_weight(&self) -> f64 {
        let (state, time) = (&self.state, self.time());
        let ramp = step::ramp(self.regime, time - state.stage_start);
        state.water_density * state.drive.gravity_now(time).norm() * ramp
    }
}
