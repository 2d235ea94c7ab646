//! The strength at which cohesion begins to be missing.

use clarabel::solver::SolverStatus;

use super::conic::Solved;
use crate::limit_analysis::{Factor, RANGE};

/// Distance of a factor from the limit of its program, relative to it.
const WIDTH: f64 = 2e-4;
/// Missing cohesion, in the unit of stress, that counts as none: what the solver may be wrong by.
const NONE: f64 = 5e-8;
/// Spare cohesion from which its slope tells where it ends: a joint without any strength leaves none to spare.
const SPARE: f64 = 1e-6;
/// Most by which one trial is stronger or weaker than the last.
const STRIDE: f64 = 4.0;
/// Part of the way to a limit that a slope has overshot.
const PART: f64 = 0.9;
/// Programs of a factor after which the search gives up.
const PROGRAMS: usize = 40;

/// From which side of the limit a factor is a bound.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Proof {
    /// There is equilibrium: nothing collapses.
    #[default]
    Equilibrium,
    /// There is none: a mechanism moves.
    Mechanism,
}

/// A factor that one solution proves.
#[derive(Debug, Clone)]
pub struct Proven {
    /// The factor.
    pub factor: Factor,
    /// The solution; none outside of the range.
    pub solution: Option<Solved>,
    /// Programs solved.
    pub programs: usize,
}

/// Finds the factor at which `solve` finds no more missing cohesion, and a solution on the side that proves it.
///
/// # Errors
/// The status with which the solver gave up, or that of too many trials.
pub fn prove(
    solve: impl Fn(f64) -> Result<Solved, SolverStatus>,
    start: f64,
    proof: Proof,
) -> Result<Proven, SolverStatus> {
    let [least, most] = [1.0 / RANGE[1], 1.0 / RANGE[0]];
    let mut bracket = Bracket { proof, ..Bracket::default() };
    let mut next = start.clamp(least, most);
    for programs in 1..=PROGRAMS {
        let solved = solve(next)?;
        let is_missing = bracket.note(next, &solved);
        if !is_missing && next <= least {
            return Ok(Proven { factor: Factor::AtLeast(RANGE[1]), solution: None, programs });
        }
        if is_missing && next >= most {
            return Ok(Proven { factor: Factor::AtMost(RANGE[0]), solution: None, programs });
        }
        let proves = is_missing == (proof == Proof::Mechanism);
        if proves && bracket.is_near(next) {
            return Ok(Proven { factor: Factor::Found(1.0 / next), solution: Some(solved), programs });
        }
        next = bracket.next().clamp(least, most);
    }
    Err(SolverStatus::MaxIterations)
}

/// Strengths on both sides of the limit.
#[derive(Debug, Default)]
struct Bracket {
    proof: Proof,
    /// Greatest strength at which cohesion is missing.
    low: Option<f64>,
    /// Least strength at which none is.
    high: Option<f64>,
    /// Where the slope of the last trial that has one puts the limit.
    aim: Option<f64>,
    /// Ratio of both ends before the last trial.
    width: f64,
}

impl Bracket {
    /// Takes note of a trial; whether cohesion is missing there.
    fn note(&mut self, x: f64, solved: &Solved) -> bool {
        let is_missing = solved.least > NONE;
        if is_missing {
            self.low = Some(x);
        } else {
            self.high = Some(x);
        }
        if (is_missing || solved.least < -SPARE) && solved.slope < 0.0 {
            self.aim = Some((x - solved.least / solved.slope).clamp(x / STRIDE, x * STRIDE));
        }
        is_missing
    }

    /// Whether the limit lies within the width of the last trial.
    fn is_near(&self, x: f64) -> bool {
        let other = if self.proof == Proof::Mechanism { self.high } else { self.low };
        let closed = other.is_some_and(|other| (other - x).abs() <= WIDTH * x);
        closed || self.aim.is_some_and(|aim| (aim - x).abs() <= WIDTH * x)
    }

    /// The next trial: just on that side of where the slope leads which proves the bound, or inside of the bracket.
    fn next(&mut self) -> f64 {
        let shift = if self.proof == Proof::Mechanism { -0.4 } else { 0.4 };
        let aim = self.aim.map(|aim| aim * (1.0 + shift * WIDTH));
        match (self.low, self.high, aim) {
            (Some(low), Some(high), aim) => {
                // A trial that leaves most of the bracket is followed by one in its middle.
                let is_slow = high / low > self.width.sqrt() && self.width > 0.0;
                self.width = if is_slow { 0.0 } else { high / low };
                let inside = aim.filter(|aim| *aim > low && *aim < high && !is_slow);
                let part = low + PART * (aim.map_or(high, |aim| aim.min(high)).max(low) - low);
                inside.unwrap_or(if is_slow && part > low { part } else { (low * high).sqrt() })
            }
            (Some(low), None, aim) => aim.unwrap_or(low * STRIDE).max(low * (1.0 + 0.4 * WIDTH)),
            (None, Some(high), aim) => aim.unwrap_or(high / STRIDE).min(high / (1.0 + 0.4 * WIDTH)),
            (None, None, _) => 1.0,
        }
    }
}
