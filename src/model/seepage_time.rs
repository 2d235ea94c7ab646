//! Flow in the joints that takes a time, between two static stages.

use enmm_seepage::{Failure, Storage, law};

use crate::flow::FlowPiece;
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

impl<'a> Seen<'a> {
    /// Flow that goes on from one of before, in implicit steps, while levels, heads and rain go evenly to those of the
    /// stage. Apertures stay as they are at its start.
    pub(super) fn over(&self, of_stage: &FlowTime, before: &'a Seepage) -> Result<Seepage, Failure> {
        let net = &self.net.net;
        let apertures = self.opened();
        let conductance = self.conductance(&apertures);
        let (volume, compliance) = self.room(&apertures);
        let storage = Storage { volume: &volume, compliance: &compliance };
        let held = |u: &[f64]| net.stored(storage, u).map(|waters| waters.iter().fold(0.0, |sum, water| sum + water));
        let step = of_stage.time / f64::from(of_stage.steps);
        let start = held(&before.unknowns)?;
        let (mut unknowns, mut flooded, mut holds) = (before.unknowns.clone(), Vec::new(), start);
        let mut own = FlowBalance {
            stage: self.stage as u32,
            sums: Vec::new(),
            residual: 0.0,
            seeps: None,
            water: None,
            rounds: None,
        };
        let mut water =
            StageWater { time: of_stage.time, sums: vec![[0.0; 3]; self.net.inlet_count()], stored: 0.0, drains: 0.0 };
        for k in 1..=of_stage.steps {
            let here = Self { way: Some((before, f64::from(k) / f64::from(of_stage.steps))), ..*self };
            flooded = here.flooded();
            let conditions = here.conditions(&flooded, &conductance);
            let at_nodes: Vec<_> = conditions.iter().map(|condition| condition.0).collect();
            let flow = net.advance(&conductance, &at_nodes, storage, &unknowns, step)?;
            (own.sums, own.seeps) = (self.net.sums(&conditions, &flow), self.net.seeps(&conditions, &flow));
            own.residual = own.residual.max(flow.residual);
            let sums = water.sums.as_flattened_mut().iter_mut().zip(own.sums.as_flattened());
            sums.for_each(|(total, rate)| *total += rate * step);
            let now = held(&flow.u)?;
            (water.drains, holds, unknowns) = ((holds - now) / step, now, flow.u);
        }
        water.stored = holds - start;
        own.water = Some(water);
        Ok(Seepage {
            unknowns,
            conducts: conductance.iter().map(|g| *g > 0.0).collect(),
            apertures,
            flooded,
            surroundings: self.surroundings(),
            balances: before.balances.iter().cloned().chain([own]).collect(),
            passed: before.passed,
            time: before.time + of_stage.time,
            rounds: Vec::new(),
        })
    }

    /// Volume (m²) and compliance (m² per m of head) of each piece with apertures (m) at its nodes, with the rock
    /// beside it.
    fn room(&self, apertures: &[[f64; 2]]) -> (Vec<f64>, Vec<f64>) {
        let weight = self.weight();
        let of_piece = |(piece, &[e0, e1]): (&FlowPiece, &[f64; 2])| {
            if e0 <= 0.0 {
                return (0.0, 0.0);
            }
            let law = &self.state.laws[self.state.law_switch[piece.law]];
            let parts = if law.penalty[0] { 0.0 } else { 1.0 / law.normal_stiffness };
            let volume = law::volume(e0, e1, piece.length, self.net.storage);
            (volume, piece.length * weight * (parts + 0.5 * (e0 + e1) / BULK))
        };
        self.net.pieces.iter().zip(apertures).map(of_piece).unzip()
    }
}
