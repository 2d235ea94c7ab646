//! Flow in the joints that takes a time: between two static stages, and as a dynamic stage goes on.

use enmm_seepage::{Failure, Storage, law};

use crate::flow::FlowPiece;
use crate::state::{FlowBalance, Seepage, StageWater};

use super::Simulation;
use super::case::{FlowTime, Stage, StageKind};
use super::seepage::Seen;

/// Bulk modulus of water (Pa).
const BULK: f64 = 2.2e9;
/// Share of the flow that joints may give at the end of a stage without a warning.
const DRAINED: f64 = 0.05;

impl Simulation {
    /// A doubt about the static stage in progress: its joints still drain or fill when its time of flow has passed, and
    /// no later stage goes on with it.
    pub fn unfinished_drainage(&self) -> Option<String> {
        let (stage, seepage) = (self.state().stage as usize, self.state().seepage.as_ref()?);
        let balance = seepage.balances.last().filter(|balance| balance.stage as usize == stage)?;
        let StageWater { time, drains, .. } = balance.water.as_ref()?;
        let goes_on =
            |next: &Stage| next.kind == StageKind::Static && next.flow_time().is_some() || next.is_transient();
        if self.stage().kind == StageKind::Dynamic || self.case().stages[stage + 1..].iter().any(goes_on) {
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

/// A flow that goes on in time through apertures that stay.
struct Course {
    apertures: Vec<[f64; 2]>,
    conductance: Vec<f64>,
    /// Volume (m²) and compliance (m² per m of head) of each piece.
    room: (Vec<f64>, Vec<f64>),
    unknowns: Vec<f64>,
    flooded: Vec<bool>,
    /// Water (m²) in the joints now.
    holds: f64,
    /// Means of the last step.
    sums: Vec<[f64; 3]>,
    seeps: Option<f64>,
    /// Greatest imbalance of a node so far (m²/s).
    residual: f64,
    water: StageWater,
}

impl Course {
    /// A course from unknowns (m) through apertures (m), on with the water that the stage has had so far.
    fn begin(
        seen: &Seen,
        apertures: Vec<[f64; 2]>,
        unknowns: &[f64],
        so_far: Option<&StageWater>,
    ) -> Result<Self, Failure> {
        let none = || StageWater { time: 0.0, sums: vec![[0.0; 3]; seen.net.inlet_count()], stored: 0.0, drains: 0.0 };
        let mut course = Self {
            conductance: seen.conductance(&apertures),
            room: seen.room(&apertures),
            apertures,
            unknowns: unknowns.to_vec(),
            flooded: Vec::new(),
            holds: 0.0,
            sums: Vec::new(),
            seeps: None,
            residual: 0.0,
            water: so_far.cloned().unwrap_or_else(none),
        };
        course.holds = course.held(seen)?;
        Ok(course)
    }

    fn storage(&self) -> Storage<'_> {
        Storage { volume: &self.room.0, compliance: &self.room.1 }
    }

    fn held(&self, seen: &Seen) -> Result<f64, Failure> {
        let waters = seen.net.net.stored(self.storage(), &self.unknowns)?;
        Ok(waters.iter().fold(0.0, |sum, water| sum + water))
    }

    /// Goes on by an implicit step (s).
    fn go(&mut self, seen: &Seen, step: f64) -> Result<(), Failure> {
        self.flooded = seen.flooded();
        let conditions = seen.conditions(&self.flooded, &self.conductance);
        let at_nodes: Vec<_> = conditions.iter().map(|condition| condition.0).collect();
        let flow = seen.net.net.advance(&self.conductance, &at_nodes, self.storage(), &self.unknowns, step)?;
        (self.sums, self.seeps) = (seen.net.sums(&conditions, &flow), seen.net.seeps(&conditions, &flow));
        self.residual = self.residual.max(flow.residual);
        let sums = self.water.sums.as_flattened_mut().iter_mut().zip(self.sums.as_flattened());
        sums.for_each(|(total, rate)| *total += rate * step);
        self.unknowns = flow.u;
        let now = self.held(seen)?;
        (self.water.drains, self.holds) = ((self.holds - now) / step, now);
        Ok(())
    }

    /// The flow to which it has come from one of before.
    fn end(self, seen: &Seen, before: &Seepage, time: f64) -> Seepage {
        let stage = seen.stage as u32;
        let Self { sums, seeps, residual, water, .. } = self;
        let own = FlowBalance { stage, sums, residual, seeps, water: Some(water), rounds: None };
        let earlier = before.balances.iter().filter(|balance| balance.stage != stage);
        Seepage {
            unknowns: self.unknowns,
            conducts: self.conductance.iter().map(|g| *g > 0.0).collect(),
            apertures: self.apertures,
            flooded: self.flooded,
            surroundings: seen.surroundings(),
            balances: earlier.cloned().chain([own]).collect(),
            passed: before.passed,
            stored: before.stored,
            time: before.time + time,
            rounds: Vec::new(),
        }
    }
}

impl<'a> Seen<'a> {
    /// Flow that goes on from one of before, in implicit steps, while levels, heads and rain go evenly to those of the
    /// stage. Apertures stay as they are at its start.
    pub(super) fn over(&self, of_stage: &FlowTime, before: &'a Seepage) -> Result<Seepage, Failure> {
        let mut course = Course::begin(self, self.opened(), &before.unknowns, None)?;
        let (step, start) = (of_stage.time / f64::from(of_stage.steps), course.holds);
        for k in 1..=of_stage.steps {
            let here = Self { way: Some((before, f64::from(k) / f64::from(of_stage.steps))), ..*self };
            course.go(&here, step)?;
        }
        (course.water.time, course.water.stored) = (of_stage.time, course.holds - start);
        Ok(course.end(self, before, of_stage.time))
    }

    /// Flow that goes on from one of before by an implicit step (s), in a dynamic stage, with levels, heads and rain of
    /// now and the apertures of before.
    pub(super) fn further(&self, step: f64, before: &Seepage) -> Result<Seepage, Failure> {
        let apertures = self.net.pieces.iter().zip(self.kept(before));
        let apertures = apertures.map(|(piece, own)| if self.is_there(piece) { own } else { [0.0; 2] }).collect();
        let last = before.balances.last().filter(|balance| balance.stage as usize == self.stage);
        let mut course = Course::begin(self, apertures, &before.unknowns, last.and_then(|own| own.water.as_ref()))?;
        let start = course.holds;
        course.go(self, step)?;
        let taken = course.holds - start;
        (course.water.time, course.water.stored) = (course.water.time + step, course.water.stored + taken);
        let mut after = course.end(self, before, step);
        let rates = after.rates();
        after.passed.iter_mut().zip(rates).for_each(|(passed, rate)| *passed += rate * step);
        after.stored += taken;
        Ok(after)
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
