//! Flow in the joints that takes a time, between two static stages.

use enmm_seepage::{Failure, Storage, law};

use crate::state::{FlowBalance, Seepage, StageWater};

use super::Simulation;
use super::case::{FlowTime, StageKind};
use super::seepage::Seen;

/// Bulk modulus of water (Pa).
const BULK: f64 = 2.2e9;
/// Share of the flow that joints may give at the end of a stage without a warning.
const DRAINED: f64 = 0.05;

impl Simulation {
    /// A doubt about the stage in progress: its joints still drain or fill when its time of flow has passed, and no
    /// later stage goes on with it.
    pub fn unfinished_drainage(&self) -> Option<String> {
        let (stage, seepage) = (self.state().stage as usize, self.state().seepage.as_ref()?);
        let balance = seepage.balances.last().filter(|balance| balance.stage as usize == stage)?;
        let StageWater { time, drains, .. } = balance.water.as_ref()?;
        let mut later = self.case().stages[stage + 1..].iter();
        if later.any(|next| next.kind == StageKind::Static && next.flow_time().is_some()) {
            return None;
        }
        let [enters, leaves] = [0, 1].map(|side| balance.sums.iter().map(|sum| sum[side]).sum::<f64>());
        let (does, share) = if *drains > 0.0 { ("drain", drains / leaves) } else { ("fill", -drains / enters) };
        (share > DRAINED).then(|| {
            format!(
                "the joints still {does} when its time of flow, {time:.4e} s, has passed: {:.3e} m²/s, {:.1} % of what \
                 flows; pressures are those of that time, give a longer `flow.time` or further stages for later ones",
                drains.abs(),
                100.0 * share
            )
        })
    }
}

impl Seen<'_> {
    /// Flow that goes on from one of before, in implicit steps, while levels, heads and rain go evenly to those of the
    /// stage. Apertures stay as they are at its start.
    pub(super) fn over(&self, of_stage: &FlowTime, before: &Seepage) -> Result<Seepage, Failure> {
        let net = &self.net.net;
        let conductance = self.conductance();
        let (volume, compliance) = self.room(&conductance);
        let storage = Storage { volume: &volume, compliance: &compliance };
        let held = |u: &[f64]| net.stored(storage, u).map(|waters| waters.iter().fold(0.0, |sum, water| sum + water));
        let step = of_stage.time / f64::from(of_stage.steps);
        let (mut unknowns, mut flooded) = (before.unknowns.clone(), Vec::new());
        let (mut last, mut totals) = (Vec::new(), vec![[0.0; 3]; self.net.inlet_count()]);
        let (start, mut holds, mut drains, mut residual) = (held(&unknowns)?, held(&unknowns)?, 0.0, 0.0_f64);
        for k in 1..=of_stage.steps {
            let share = f64::from(k) / f64::from(of_stage.steps);
            flooded = self.flooded(share);
            let conditions = self.conditions(&flooded, &conductance, share);
            let at_nodes: Vec<_> = conditions.iter().map(|condition| condition.0).collect();
            let flow = net.advance(&conductance, &at_nodes, storage, &unknowns, step)?;
            last = self.net.sums(&conditions, &flow);
            for (total, sum) in totals.as_flattened_mut().iter_mut().zip(last.as_flattened()) {
                *total += sum * step;
            }
            let now = held(&flow.u)?;
            (drains, holds) = ((holds - now) / step, now);
            residual = residual.max(flow.residual);
            unknowns = flow.u;
        }
        let water = StageWater { time: of_stage.time, sums: totals, stored: holds - start, drains };
        let mut balances = before.balances.clone();
        balances.push(FlowBalance { stage: self.stage as u32, sums: last, residual, water: Some(water) });
        let conducts = conductance.iter().map(|g| *g > 0.0).collect();
        Ok(Seepage { unknowns, conducts, flooded, balances, time: before.time + of_stage.time })
    }

    /// Volume (m²) and compliance (m² per m of head) of each piece that conducts, with the rock beside it.
    fn room(&self, conductance: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let weight = self.unit_weight();
        let of_piece = |(piece, conducts): (&crate::flow::FlowPiece, &f64)| {
            if *conducts <= 0.0 {
                return (0.0, 0.0);
            }
            let [e0, e1] = self.apertures(piece);
            let law = self.law_of(piece);
            let parts = if law.penalty[0] { 0.0 } else { 1.0 / law.normal_stiffness };
            let volume = law::volume(e0, e1, piece.length, self.net.storage);
            (volume, piece.length * weight * (parts + 0.5 * (e0 + e1) / BULK))
        };
        self.net.pieces.iter().zip(conductance).map(of_piece).unzip()
    }
}
