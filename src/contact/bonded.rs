//! Bars that grout ties to the rock along their length: bar points between which the bar stretches, each held to a
//! point of the rock by a spring that slips. The bar has no mass, so that it is in balance at the end of every step
//! (Eqs. 44a–44c).

use crate::geometry::{Point, Vector};

use super::bolt::{BoltSegment, BoltState};
use super::grout::{Grout, SOFT, potential};

/// Rest of the balance of a point, relative to the largest force of the bar, that counts as none.
const BALANCED: f64 = 1e-11;
/// Most rounds of Newton's method, and most halvings of one of them.
const ROUNDS_MAX: usize = 80;
const HALVINGS_MAX: usize = 40;
/// Fall of the energy, relative to its slope, with which a round is taken.
const FALLS: f64 = 1e-4;

/// Buffers of the balance of a bar.
#[derive(Debug, Clone, Default)]
pub struct GroutBuffers {
    /// Lengths of rock (m) between the points of the bar.
    length: Vec<f64>,
    /// Slip (m) of the bar at each point, towards its far end.
    slip: Vec<f64>,
    tried: Vec<f64>,
    /// Force (N/m) that is not in balance at each point.
    rest: Vec<f64>,
    change: Vec<f64>,
    diagonal: Vec<f64>,
    tangent: Vec<f64>,
}

impl GroutBuffers {
    /// Brings all grouted bars into balance at the displacements (m) of the covers.
    pub fn settle(&mut self, segments: &[BoltSegment], bars: &mut [BoltState], star: &[Point], moved: &[Vector]) {
        let mut first = 0;
        while first < segments.len() {
            let count = 1 + segments[first + 1..].iter().take_while(|segment| segment.follows).count();
            let own = first..first + count;
            if segments[first].grout.is_some() && bars[own.clone()].iter().any(|bar| bar.active) {
                self.settle_one(&segments[own.clone()], &mut bars[own], star, moved);
            }
            first += count;
        }
    }

    fn settle_one(&mut self, segments: &[BoltSegment], bars: &mut [BoltState], star: &[Point], moved: &[Vector]) {
        self.length.clear();
        self.length.extend(segments.iter().map(|segment| segment.span(star, moved).norm()));
        self.slip.clear();
        self.slip.extend(bars.iter().map(|bar| bar.slip[0]));
        self.slip.extend(bars.last().map(|bar| bar.slip[1]));
        let chain = Chain { segments, bars, length: &self.length };
        for _ in 0..ROUNDS_MAX {
            let largest = chain.balance(&self.slip, &mut self.rest);
            if greatest(&self.rest) <= BALANCED * largest {
                break;
            }
            chain.newton(&self.slip, &self.rest, [&mut self.change, &mut self.diagonal, &mut self.tangent]);
            let before = (chain.potential(&self.slip), greatest(&self.rest));
            let slope: f64 = self.rest.iter().zip(&self.change).map(|(rest, change)| rest * change).sum();
            let mut share = 1.0;
            for _ in 0..HALVINGS_MAX {
                self.tried.clear();
                self.tried.extend(self.slip.iter().zip(&self.change).map(|(slip, change)| slip + share * change));
                let falls = chain.potential(&self.tried) <= before.0 - FALLS * share * slope;
                chain.balance(&self.tried, &mut self.rest);
                // Near the balance the energy changes by less than its rounding.
                if falls || greatest(&self.rest) <= 0.5 * before.1 {
                    break;
                }
                share *= 0.5;
            }
            std::mem::swap(&mut self.slip, &mut self.tried);
        }
        for (k, (segment, bar)) in segments.iter().zip(bars.iter_mut()).enumerate() {
            *bar = segment.after_slip(bar, self.length[k], [self.slip[k], self.slip[k + 1]]);
        }
    }
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// The segments of one bar, from its head on.
struct Chain<'a> {
    segments: &'a [BoltSegment],
    bars: &'a [BoltState],
    length: &'a [f64],
}

impl Chain<'_> {
    /// Stretch (m) of a segment.
    fn stretch(&self, k: usize, slip: &[f64]) -> f64 {
        self.length[k] + slip[k + 1] - slip[k] - self.bars[k].rest
    }

    fn bears(&self, k: usize) -> bool {
        self.bars[k].active && !self.bars[k].broken
    }

    /// Tension (N/m) of a segment.
    fn tension(&self, k: usize, slip: &[f64]) -> f64 {
        let segment = &self.segments[k];
        let tension = (segment.stiffness * self.stretch(k, slip)).clamp(0.0, segment.yield_force);
        if self.bears(k) { tension } else { 0.0 }
    }

    /// The tie of a point to the rock, and its slip without force (m).
    fn grout(&self, point: usize) -> (Grout, f64) {
        let (segment, end) = if point < self.segments.len() { (point, 0) } else { (point - 1, 1) };
        (self.segments[segment].grout.map_or_else(Grout::default, |grout| grout[end]), self.bars[segment].slid[end])
    }

    /// Forces that are not in balance at each point (Eq. 44b); returns the largest force.
    fn balance(&self, slip: &[f64], rest: &mut Vec<f64>) -> f64 {
        let (mut before, mut largest) = (0.0, f64::MIN_POSITIVE);
        rest.clear();
        for (point, &own) in slip.iter().enumerate() {
            let after = if point < self.segments.len() { self.tension(point, slip) } else { 0.0 };
            let (grout, slid) = self.grout(point);
            let held = grout.force(own - slid);
            rest.push(after - before - held);
            largest = largest.max(after).max(held.abs());
            before = after;
        }
        largest
    }

    /// Energy (J/m) whose slope over the slips is the balance.
    fn potential(&self, slip: &[f64]) -> f64 {
        let bar = |(k, segment): (usize, &BoltSegment)| {
            let stretch = self.stretch(k, slip).max(0.0);
            if self.bears(k) { potential(segment.stiffness, segment.yield_force, stretch) } else { 0.0 }
        };
        let tie = |(point, &own): (usize, &f64)| {
            let (grout, slid) = self.grout(point);
            if grout.stiffness > 0.0 { grout.potential(own - slid) } else { 0.0 }
        };
        self.segments.iter().enumerate().map(bar).sum::<f64>() + slip.iter().enumerate().map(tie).sum::<f64>()
    }

    /// A round of Newton's method: the change of slip that balances the rest, by elimination from the head on.
    fn newton(&self, slip: &[f64], rest: &[f64], [change, diagonal, tangent]: [&mut Vec<f64>; 3]) {
        tangent.clear();
        tangent.extend(self.segments.iter().enumerate().map(|(k, segment)| {
            let force = segment.stiffness * self.stretch(k, slip);
            let is_elastic = self.bears(k) && force > 0.0 && force < segment.yield_force;
            segment.stiffness * if is_elastic { 1.0 } else { SOFT }
        }));
        let count = slip.len();
        change.clear();
        diagonal.clear();
        for point in 0..count {
            let (grout, slid) = self.grout(point);
            let after = tangent.get(point).copied().unwrap_or_default();
            let before = if point > 0 { tangent[point - 1] } else { 0.0 };
            let own = grout.tangent(slip[point] - slid) + before + after;
            let share = if point > 0 { before / diagonal[point - 1] } else { 0.0 };
            diagonal.push(own - share * before);
            change.push(rest[point] + if point > 0 { share * change[point - 1] } else { 0.0 });
        }
        for point in (0..count).rev() {
            let next = if point + 1 < count { tangent[point] * change[point + 1] } else { 0.0 };
            change[point] = (change[point] + next) / diagonal[point];
        }
    }
}

impl BoltSegment {
    /// The state of a segment of a grouted bar between points of rock that are `length` (m) apart, along which the bar
    /// has slipped (m): bar and grout give way by that (Eqs. 44a, 44c).
    fn after_slip(&self, state: &BoltState, length: f64, slip: [f64; 2]) -> BoltState {
        let grout = self.grout.unwrap_or_default();
        let slid = [0, 1].map(|k| grout[k].slid(slip[k], state.slid[k]));
        let between = length + slip[1] - slip[0];
        let force = (self.stiffness * (between - state.rest)).clamp(0.0, self.yield_force);
        let now = if state.active { self.after(state, between, force) } else { *state };
        BoltState { slip, slid, force: if now.active && !now.broken { now.force } else { 0.0 }, ..now }
    }
}
