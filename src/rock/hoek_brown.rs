//! The curved part of the yield surface of Hoek–Brown rock and the return to it (Eqs. 56a, 57a, 57b).

use enmm_case::{Envelope, Tangent};

use super::Elasticity;

/// Points of the table of an envelope: neighbouring circles differ by a sixth in their size, so that chords between
/// them hold all but a few thousandths of the strength.
const POINTS: usize = 65;
/// Sizes of the first and the last circle in the table, relative to the uniaxial compressive strength and to the
/// strength under a pressure of σci.
const ENDS: [f64; 2] = [0.02, 2.0];
/// Most circles that a search looks at by interpolation, of which it needs three, and in all: halving ends earlier.
const INTERPOLATED: usize = 20;
const TRIED_MAX: usize = 1200;
/// Rest of an equation, relative to the largest trial stress, at which it counts as solved: rounding, so that a stress
/// that is a small part of the trial stress is on the surface too.
const SOLVED: f64 = 1e-14;

/// Hoek–Brown strength of a rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoekBrown {
    envelope: Envelope,
    /// Sine of the dilation angle; one for associated flow.
    sin_dilation: f64,
    /// Tensile strength (Pa); `None` for the end of the envelope.
    tension: Option<f64>,
    /// v of some points of the envelope, and its tangents there.
    table: [(f64, Tangent); POINTS],
}

/// The largest circle of Mohr at its centre: it touches the envelope.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Circle {
    /// v of the envelope.
    v: f64,
    /// Mean of the largest and the smallest stress (Pa), compression positive.
    pub centre: f64,
    /// Half of their difference (Pa).
    pub radius: f64,
    /// Sine of the friction angle where it touches.
    pub sin_friction: f64,
}

/// The envelope with its shear strength times a factor (Eq. 57a).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    envelope: Envelope,
    factor: f64,
    sin_dilation: f64,
    /// Tensile strength (Pa).
    pub tension: f64,
    /// The circle whose largest stress is the tensile strength.
    pub first: Circle,
    table: [Circle; POINTS],
}

/// The return of a trial stress, in principal stresses with the largest first, to a curve.
pub struct Onto<'a> {
    /// The curve.
    pub curve: &'a Curve,
    /// Elastic constants in plane strain.
    pub rock: &'a Elasticity,
    /// The trial stress (Pa).
    pub trial: [f64; 3],
    /// Stress (Pa) beyond the curve that still counts as on it.
    pub tolerance: f64,
    /// Whether the largest stress exceeds the tensile strength.
    pub is_pulled: bool,
}

/// Result of a return.
pub enum Returned {
    /// The trial stress lies inside the curve.
    Inside,
    /// Plastic strain along the sorted axes that brings it to the curve.
    Flows([f64; 3]),
    /// It returns to the tensile strength.
    ToTension,
}

/// Where a return to the face leaves the middle stress.
enum Order {
    Kept,
    MiddleBelow,
    MiddleAbove,
}

impl HoekBrown {
    /// Strength with a tangent of the dilation angle, infinite for associated flow, and a tensile strength (Pa).
    pub fn new(envelope: Envelope, dilation: f64, tension: Option<f64>) -> Self {
        let sin_dilation = if dilation.is_finite() { dilation / (1.0 + dilation * dilation).sqrt() } else { 1.0 };
        let [low, high] = [ENDS[0] * envelope.place(0.0), ENDS[1] * envelope.place(envelope.sigma_ci)];
        let ratio = libm::pow(high / low, 1.0 / (POINTS - 2) as f64);
        let mut v = 0.0;
        let table = std::array::from_fn(|k| {
            v = if k == 1 { low } else { v * ratio };
            (v, envelope.tangent(v))
        });
        Self { envelope, sin_dilation, tension, table }
    }

    /// The envelope with its shear strength and the given tensile strength times a factor.
    pub fn curve(&self, factor: f64) -> Curve {
        let end = self.envelope.tension();
        let mut curve = Curve {
            envelope: self.envelope,
            factor,
            sin_dilation: self.sin_dilation,
            tension: self.tension.map_or(end, |tension| (tension * factor).min(end)),
            first: Circle::default(),
            table: self.table.map(|(v, tangent)| Circle::touching(v, &tangent, factor)),
        };
        curve.first = curve.table[0];
        if curve.tension < end {
            curve.first = curve.root(SOLVED * end, |at| at.ends()[0] - curve.tension).unwrap_or(curve.first);
        }
        curve
    }

    /// Uniaxial compressive strength of the rock mass (Pa).
    pub fn compression(&self) -> f64 {
        self.envelope.compression()
    }
}

impl Circle {
    /// The circle that touches the envelope with its shear strength times a factor.
    fn touching(v: f64, tangent: &Tangent, factor: f64) -> Self {
        let (shear, friction) = (factor * tangent.shear, factor * tangent.friction);
        if !friction.is_finite() {
            return Self { v, centre: tangent.normal, radius: 0.0, sin_friction: 1.0 };
        }
        let secant = (1.0 + friction * friction).sqrt();
        Self { v, centre: tangent.normal + shear * friction, radius: shear * secant, sin_friction: friction / secant }
    }

    /// Largest and smallest stress (Pa), tension positive.
    pub fn ends(&self) -> [f64; 2] {
        [self.radius - self.centre, -self.radius - self.centre]
    }
}

impl Curve {
    /// Sine of the dilation angle on a circle: at most that of its friction angle.
    pub fn sin_dilation(&self, at: &Circle) -> f64 {
        self.sin_dilation.min(at.sin_friction)
    }

    fn circle(&self, v: f64) -> Circle {
        Circle::touching(v, &self.envelope.tangent(v), self.factor)
    }

    /// How far (Pa) principal stresses lie beyond the curve, measured as |s₁ − s₃|; of stresses on the side of the
    /// tensile strength, a bound of it.
    pub fn beyond(&self, [largest, smallest]: [f64; 2]) -> f64 {
        let enough = SOLVED * largest.abs().max(smallest.abs());
        let at = self.root(enough, |at| -0.5 * (largest + smallest) - at.centre);
        largest - smallest - 2.0 * at.unwrap_or(self.first).radius
    }

    /// The most that it can be: beyond the chords of the table.
    pub fn beyond_at_most(&self, [largest, smallest]: [f64; 2]) -> f64 {
        let centre = -0.5 * (largest + smallest);
        let after = self.table.partition_point(|at| at.centre <= centre);
        let radius = match (after.checked_sub(1).map(|k| &self.table[k]), self.table.get(after)) {
            (None, _) => self.first.radius,
            (Some(below), None) => below.radius,
            (Some(below), Some(above)) => {
                let share = (centre - below.centre) / (above.centre - below.centre);
                below.radius + (above.radius - below.radius) * share
            }
        };
        largest - smallest - 2.0 * radius
    }

    /// The circle at which a quantity that falls from circle to circle is zero; none when it is not positive at the
    /// first one. A rest of `enough` (Pa) is none.
    fn root(&self, enough: f64, value: impl Fn(&Circle) -> f64) -> Option<Circle> {
        let first = self.table.partition_point(|at| at.v <= self.first.v);
        if value(&self.first).is_nan() || value(&self.first) <= 0.0 {
            return None;
        }
        let after = first + self.table[first..].partition_point(|at| value(at) > 0.0);
        let low = if after > first { self.table[after - 1] } else { self.first };
        let mut ends = match self.table.get(after) {
            Some(high) => [low, *high],
            None => self.above(low, &value)?,
        };
        let mut known = Known::default();
        let beside = self.table.iter().skip(after.saturating_sub(2).max(first)).take_while(|at| at.v < ends[0].v);
        beside.chain(self.table.get(after + 1)).chain(&ends).for_each(|at| known.add(at.v, value(at)));
        for tried in 0..TRIED_MAX {
            let half = 0.5 * (ends[0].v + ends[1].v);
            let crossing = if tried < INTERPOLATED { known.crossing() } else { half };
            let v = if ends[0].v < crossing && crossing < ends[1].v { crossing } else { half };
            let at = self.circle(v);
            let now = value(&at);
            if now.abs() <= enough || v <= ends[0].v || v >= ends[1].v {
                return Some(at);
            }
            ends[usize::from(now <= 0.0)] = at;
            known.add(v, now);
        }
        Some(ends[0])
    }

    /// Two circles beyond the table, one after the other, between which a quantity ceases to be positive.
    fn above(&self, mut low: Circle, value: &impl Fn(&Circle) -> f64) -> Option<[Circle; 2]> {
        for _ in 0..TRIED_MAX {
            let at = self.circle(2.0 * low.v);
            let now = value(&at);
            if !now.is_finite() {
                return None;
            }
            if now <= 0.0 {
                return Some([low, at]);
            }
            low = at;
        }
        None
    }
}

/// The last four circles that a search has looked at: v and value of each.
#[derive(Default)]
struct Known {
    circles: [(f64, f64); 4],
    count: usize,
}

impl Known {
    fn add(&mut self, v: f64, value: f64) {
        self.circles[self.count % self.circles.len()] = (v, value);
        self.count += 1;
    }

    /// v where the value is zero, by the polynomial v(value) through the circles.
    fn crossing(&self) -> f64 {
        let known = &self.circles[..self.count.min(self.circles.len())];
        let weight = |k: usize| {
            let others = known.iter().enumerate().filter(|other| other.0 != k);
            others.map(|(_, (_, value))| value / (value - known[k].1)).product::<f64>()
        };
        known.iter().enumerate().map(|(k, (v, _))| v * weight(k)).sum()
    }
}

impl Onto<'_> {
    /// The return to the face of the curve, or to an edge where the middle stress equals another.
    pub fn flow(&self) -> Returned {
        let (ends, least) = ([self.trial[0], self.trial[2]], 0.25 * self.tolerance / self.rock.mu);
        let edge = match self.face() {
            Some((_, rate, _)) if rate <= least && !self.is_pulled => return Returned::Inside,
            Some((strain, rate, order)) if rate >= -least => match order {
                Order::Kept => return Returned::Flows(strain),
                Order::MiddleBelow => self.edge(false),
                Order::MiddleAbove => self.edge(true),
            },
            None if !self.is_pulled && self.curve.beyond(ends) <= self.tolerance => return Returned::Inside,
            _ => self.edge(false).or_else(|| self.edge(true)),
        };
        edge.map_or(Returned::ToTension, Returned::Flows)
    }

    /// Return to the face, where the middle stress's axis does not flow, how much flows, and where that leaves the
    /// middle stress; none on the side of the tensile strength.
    fn face(&self) -> Option<([f64; 3], f64, Order)> {
        let [s1, s2, s3] = self.trial;
        let Elasticity { lambda, mu, .. } = *self.rock;
        let rate = |at: &Circle| (s1 - s3 - 2.0 * at.radius) / (4.0 * mu);
        let swells = |at: &Circle| 4.0 * (lambda + mu) * rate(at) * self.curve.sin_dilation(at);
        let at = self.root(|at| swells(at) - 2.0 * at.centre - (s1 + s3))?;
        let (rate, sine) = (rate(&at), self.curve.sin_dilation(&at));
        let middle = s2 - 2.0 * lambda * sine * rate;
        let [largest, smallest] = at.ends();
        let order = match () {
            () if middle < smallest - self.tolerance => Order::MiddleBelow,
            () if middle > largest + self.tolerance => Order::MiddleAbove,
            () => Order::Kept,
        };
        Some(([(1.0 + sine) * rate, 0.0, (sine - 1.0) * rate], rate, order))
    }

    /// Return to the edge where the middle stress equals the largest one (`upper`) or the smallest one.
    fn edge(&self, upper: bool) -> Option<[f64; 3]> {
        let [s1, s2, s3] = self.trial;
        let Elasticity { lambda, mu, .. } = *self.rock;
        let [largest, smallest] = if upper { [0.5 * (s1 + s2), s3] } else { [s1, 0.5 * (s2 + s3)] };
        let sine = |at: &Circle| self.curve.sin_dilation(at);
        let rate = |at: &Circle| {
            let shared = if upper { 3.0 - sine(at) } else { 3.0 + sine(at) };
            (largest - smallest - 2.0 * at.radius) / (mu * shared)
        };
        let alone = if upper { mu } else { 2.0 * mu };
        let relief = |at: &Circle| rate(at) * (alone * (1.0 + sine(at)) + 2.0 * lambda * sine(at));
        let at = self.root(|at| at.ends()[0] - largest + relief(at))?;
        let (rate, sine) = (rate(&at), sine(&at));
        let grows = [(1.0 + sine) * rate, (sine - 1.0) * rate];
        let (strain, against) = if upper {
            let apart = (s1 - s2) / (2.0 * mu);
            let middle = 0.5 * (grows[0] - apart);
            ([0.5 * (grows[0] + apart), middle, grows[1]], -middle)
        } else {
            let apart = (s2 - s3) / (2.0 * mu);
            let middle = 0.5 * (grows[1] + apart);
            ([grows[0], middle, 0.5 * (grows[1] - apart)], middle)
        };
        (rate >= -self.tolerance / mu && against <= self.tolerance / mu).then_some(strain)
    }

    fn root(&self, value: impl Fn(&Circle) -> f64) -> Option<Circle> {
        let largest = self.trial[0].abs().max(self.trial[2].abs());
        self.curve.root(SOLVED * largest, value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half and twice the rest at which an equation counts as solved find the same circle, to that rest.
    #[test]
    fn no_circle_depends_on_the_rest_that_counts_as_none() {
        for (gsi, mi) in [(5.0, 2.0), (45.0, 10.0), (100.0, 25.0)] {
            let envelope = enmm_case::HoekBrown { sigma_ci: 30e6, mi, gsi, d: 0.0, associated: false }.envelope();
            let curve = HoekBrown::new(envelope, 0.0, None).curve(0.8);
            for k in 0..60 {
                let centre = 1e3 * 1.3f64.powi(k);
                let radius = |rest: f64| curve.root(rest * centre, |at| centre - at.centre).map(|at| at.radius);
                let [half, own, double] = [0.5, 1.0, 2.0].map(|share| radius(share * SOLVED));
                for other in [half, double] {
                    let apart = own.zip(other).map(|(own, other)| (own - other).abs() / centre);
                    assert!(apart.is_some_and(|apart| apart <= 8.0 * SOLVED), "{gsi} {centre}: {own:?} {other:?}");
                }
            }
        }
    }
}
