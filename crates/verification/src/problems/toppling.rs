//! The slope of columns of Goodman and Bray: geometry and limit equilibrium from its parameters.

use super::block::G;
use crate::parts::{rock, turn};

/// A corner list as a case writes it.
type Corners = Vec<[f64; 2]>;

/// Columns on a stepped base, counted from the toe.
#[derive(Debug, Clone, Copy)]
pub struct Columns {
    /// Number of columns.
    pub count: usize,
    /// The column at the crest.
    pub crest: usize,
    /// Width of a column (m).
    pub width: f64,
    /// Height of a step of the base (m).
    pub step: f64,
    /// Difference of the heads of neighbours below the crest (m).
    pub below: f64,
    /// Difference of the heads of neighbours above the crest (m).
    pub above: f64,
    /// Dip of the base (rad); the columns stand normal to it.
    pub base: f64,
    /// Unit weight (N/m³).
    pub unit_weight: f64,
    /// Young's modulus (Pa).
    pub young: f64,
    /// Mesh size (m).
    pub size: f64,
}

/// Mode of a column at the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// It stands by itself.
    Stable,
    /// It turns about its lower corner.
    Topples,
    /// It slides on its base.
    Slides,
}

/// Limit equilibrium for one friction.
pub struct Equilibrium {
    /// Horizontal force (N/m) that must hold the lowest column.
    pub force: f64,
    /// Modes of the columns from the toe.
    pub modes: Vec<Mode>,
}

impl Columns {
    /// Height of column n (1 at the toe, m).
    pub fn height(&self, n: usize) -> f64 {
        let crest = (self.below - self.step) * self.crest.min(n) as f64;
        crest - (self.above + self.step) * n.saturating_sub(self.crest) as f64
    }

    /// Whether every column has a height.
    pub fn is_sound(&self) -> bool {
        (1..=self.count).all(|n| self.height(n) > 0.0) && self.crest <= self.count
    }

    /// Weight of column n (N/m).
    fn weight(&self, n: usize) -> f64 {
        self.unit_weight * self.width * self.height(n)
    }

    /// Goodman and Bray's equations from the crest down.
    ///
    /// P(n−1) = max(0, [P_n(M − Δx·tan φ) + ½W(y·sin β − Δx·cos β)]/L, P_n − W(cos β·tan φ − sin β)/(1 − tan²φ)).
    /// The force P₀ that one more column would carry along the base, by P₀(1 − tan²φ)/(tan φ·sin β + cos β).
    pub fn equilibrium(&self, tangent: f64) -> Equilibrium {
        let (s, c) = self.base.sin_cos();
        let (mut force, mut modes) = (0.0f64, vec![Mode::Stable; self.count]);
        for n in (1..=self.count).rev() {
            let (y, weight) = (self.height(n), self.weight(n));
            let m = if n < self.crest { y } else { y - self.above };
            let l = if n <= self.crest { y - self.below } else { y };
            let topple = (force * (m - self.width * tangent) + 0.5 * weight * (y * s - self.width * c)) / l;
            let slide = force - weight * (c * tangent - s) / (1.0 - tangent * tangent);
            // A column lower than a step has no neighbour to lean on: it can only slide.
            let topple = if l > 0.0 { topple } else { f64::NEG_INFINITY };
            modes[n - 1] = match topple.max(slide) {
                _ if force == 0.0 && topple <= 0.0 && slide <= 0.0 => Mode::Stable,
                _ if slide > topple => Mode::Slides,
                _ => Mode::Topples,
            };
            force = topple.max(slide).max(0.0);
        }
        Equilibrium { force: force * (1.0 - tangent * tangent) / (tangent * s + c), modes }
    }

    /// The friction (tan φ) below which a holding force is needed, to 1e-9.
    pub fn limit(&self) -> f64 {
        let (mut low, mut high) = (0.01, 0.999);
        while high - low > 1e-9 {
            let middle = 0.5 * (low + high);
            if self.equilibrium(middle).force > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Lower left corner of column n in axes along the base (downhill positive) and along the columns.
    fn foot(&self, n: usize) -> [f64; 2] {
        [-self.width * n as f64, self.step * (n - 1) as f64]
    }

    /// A point in the middle of each column, in the slope's axes.
    pub fn middles(&self) -> Corners {
        let middle = |n: usize| {
            let [x, y] = self.foot(n);
            [x + 0.52 * self.width, y + 0.49 * self.height(n)]
        };
        turn(&(1..=self.count).map(middle).collect::<Vec<_>>(), -self.base.to_degrees())
    }

    /// Outline and joints.
    fn geometry(&self) -> (Corners, Vec<Corners>) {
        let high = self.height(self.crest);
        let (far, deep) = (self.width * (self.count as f64 + 1.0), -0.3 * self.width);
        let mut outline = vec![[-far, deep], [0.5 * high, deep], [0.5 * high, 0.0]];
        let mut joints = Vec::new();
        for n in 1..=self.count {
            let ([x, y], height) = (self.foot(n), self.height(n));
            let right = x + self.width;
            // From the right: up to the head of this column, along it, and at the end down to the bench.
            if n == 1 {
                outline.push([right, y]);
            }
            outline.extend([[right, y + height], [x, y + height]]);
            joints.push(vec![[x, y], [right, y]]);
            if n < self.count {
                joints.push(vec![[x, y], [x, (y + height).min(self.foot(n + 1)[1] + self.height(n + 1))]]);
            } else {
                outline.extend([[x, y], [-far, y]]);
            }
        }
        let dip = -self.base.to_degrees();
        (turn(&outline, dip), joints.iter().map(|j| turn(j, dip)).collect())
    }

    /// The case without stages; all joints have `friction_deg`.
    pub fn text(&self, friction_deg: f64) -> String {
        let (outline, joints) = self.geometry();
        let joints: String = joints.iter().map(|j| format!("[[joint]]\npoints = {j:?}\n")).collect();
        let base = turn(&[[0.0, -0.15 * self.width]], -self.base.to_degrees())[0];
        format!(
            "title = \"Toppling columns of Goodman and Bray\"\n[domain]\noutline = {outline:?}\n[mesh]\nsize = {:e}\n\
             origin = [0.3, 0.2]\n{joints}[joint_law.joint]\nfriction_deg = {friction_deg:?}\n[[fix]]\n\
             block = {base:?}\n{}",
            self.size,
            rock(self.young, self.unit_weight / G)
        )
    }
}

/// The published example.
#[cfg(test)]
mod tests {
    use super::*;

    const PUBLISHED: Columns = Columns {
        count: 16,
        crest: 10,
        width: 10.0,
        step: 1.0,
        below: 5.0,
        above: 5.0,
        base: std::f64::consts::FRAC_PI_6,
        unit_weight: 25e3,
        young: 20e9,
        size: 6.0,
    };

    #[test]
    fn the_formulas_give_the_published_numbers() {
        for (tangent, published) in [(0.65, 2012.87e3), (0.70, 1114.02e3), (0.75, 400.68e3)] {
            let force = PUBLISHED.equilibrium(tangent).force;
            assert!((force / published - 1.0).abs() < 1e-5, "{force}");
        }
        assert_eq!(PUBLISHED.equilibrium(0.80).force, 0.0);
        assert!((PUBLISHED.equilibrium(0.7855).force - 470.0).abs() < 10.0);
        assert!((PUBLISHED.limit() - 0.785544).abs() < 1e-6);
        let count =
            |tangent: f64, mode: Mode| PUBLISHED.equilibrium(tangent).modes.iter().filter(|m| **m == mode).count();
        assert_eq!([Mode::Stable, Mode::Topples, Mode::Slides].map(|m| count(0.7855, m)), [3, 10, 3]);
        assert_eq!(count(0.65, Mode::Slides), 4);
    }
}
