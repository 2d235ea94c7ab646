//! The strength at which equilibrium ends, and the choice of facets between corners that face each other.

use super::contact::Contact;
use super::corner::Corner;
use super::program::{Program, Solution, Unsolved};
use super::{Factor, RANGE};

/// Share of its weight by which a block may be out of balance in what counts as equilibrium.
const BALANCED: f64 = 2e-7;
/// Width of the bracket of a factor relative to it.
const WIDTH: f64 = 2e-5;
/// Difference of two factors, relative to them, that counts as none.
const SAME: f64 = 1e-4;
/// Speed of a corner into another, relative to the fastest block, that counts as none.
pub const STILL: f64 = 1e-5;
/// Ratio of strengths of the first trials, and of those of limits that lie close to a known one.
const STRIDES: [f64; 2] = [4.0, 1.02];
/// Relative distance over which the slope of the unbalanced share holds.
const NEAR: f64 = 0.02;
/// Part of the way to a strength that is farther away.
const STEP: f64 = 0.85;
/// Programs of a factor after which the bracket is taken as it is, and the width up to which it will do.
const PROGRAMS: usize = 60;
const WIDE: f64 = 1e-4;
/// Rows of all programs together that a choice of facets may cost before the best so far is taken.
const ROWS: usize = 200_000;

/// The end of equilibrium for one set of contacts: strengths are 1/F.
#[derive(Debug, Clone)]
pub struct Limit {
    /// Greatest strength without equilibrium; none when there is equilibrium throughout.
    pub low: Option<f64>,
    /// Least strength with equilibrium; none when there is none throughout.
    pub high: Option<f64>,
    /// Solution of the program at `low`.
    pub mechanism: Option<Solution>,
}

impl Limit {
    /// The factor of safety.
    pub fn factor(&self) -> Factor {
        match (self.low, self.high) {
            (Some(low), Some(high)) => {
                Factor::Found(1.0 / newton(low, self.mechanism.as_ref()).unwrap_or(low).min(high))
            }
            (None, _) => Factor::AtLeast(RANGE[1]),
            (Some(_), None) => Factor::AtMost(RANGE[0]),
        }
    }
}

/// Result of a choice of facets.
pub struct Choice {
    /// The limit of the best choice.
    pub limit: Limit,
    /// No choice gives less than this.
    pub least: Factor,
}

/// Searches in one model.
#[derive(Debug)]
pub struct Search<'a> {
    /// Blocks and contacts.
    pub program: &'a Program,
    /// Programs solved so far.
    pub programs: usize,
}

impl Search<'_> {
    /// The limit of `contacts` more, near a limit that is known or anywhere.
    pub fn limit_near(&mut self, more: &[Contact], known: Option<&Limit>) -> Result<Limit, Unsolved> {
        match known.and_then(|limit| limit.low) {
            Some(low) => self.limit(more, low, STRIDES[1]),
            None => self.limit(more, 1.0, STRIDES[0]),
        }
    }

    /// Solves the program of one strength with `more` contacts.
    pub fn solve(&mut self, strength: f64, more: &[Contact]) -> Result<Solution, Unsolved> {
        self.programs += 1;
        self.program.solve(strength, more)
    }

    /// Finds the limit with `more` contacts: trials from `start` on, each `stride` times weaker than the last until
    /// there is no equilibrium, then Newton's rule from that side.
    fn limit(&mut self, more: &[Contact], start: f64, mut stride: f64) -> Result<Limit, Unsolved> {
        let [least, most] = [1.0 / RANGE[1], 1.0 / RANGE[0]];
        let mut limit = Limit { low: None, high: None, mechanism: None };
        let mut next = start.clamp(least, most);
        let mut is_closing = false;
        for _ in 0..PROGRAMS {
            let solution = self.solve(next, more)?;
            if solution.unbalanced > BALANCED {
                (limit.low, limit.mechanism) = (Some(next), Some(solution));
            } else {
                limit.high = Some(next);
            }
            next = match (limit.low, limit.high) {
                (None, Some(high)) if high <= least => break,
                (None, _) => (next / stride).max(least),
                (Some(low), None) if low >= most => break,
                (Some(low), Some(high)) if high <= low * (1.0 + WIDTH) => break,
                (Some(low), high) => {
                    let newton = newton(low, limit.mechanism.as_ref()).unwrap_or(most) * (1.0 + 0.4 * WIDTH);
                    let newton = newton.min(most);
                    is_closing =
                        !is_closing && high.is_some_and(|high| newton * (1.0 + WIDTH) >= high && near(low, high));
                    within(low, high, newton, is_closing)
                }
            };
            stride *= stride;
        }
        match (limit.low, limit.high) {
            (Some(low), Some(high)) if high > low * (1.0 + WIDE) => Err(Unsolved::MaxIterations),
            _ => Ok(limit),
        }
    }

    /// The least factor over all choices of one facet for each pair of facing corners (Eq. 80): best first, with a
    /// choice that is made all at once as the first to beat.
    pub fn facets(&mut self, corners: &[Corner], free: Limit) -> Result<Choice, Unsolved> {
        let mut best = self.dive(corners, &free)?;
        let mut open = vec![(Vec::new(), free)];
        let budget = ROWS / (6 * self.program.bodies.len() + 5 * self.program.contacts.len()).max(1);
        while let Some((chosen, limit)) = pop_least(&mut open).filter(|(_, limit)| beats(limit, &best)) {
            let Some(&(worst, _)) = self.entered(corners, &limit, &chosen).first() else {
                best = limit;
                break;
            };
            if self.programs > budget {
                let least = limit.factor();
                return Ok(Choice { limit: best, least });
            }
            for facet in 0..2 {
                let mut chosen = chosen.clone();
                chosen.push((worst, facet));
                let more = contacts_of(corners, &chosen);
                if self.is_worth(&more, &best)? {
                    let limit = self.limit_near(&more, Some(&limit))?;
                    open.push((chosen, limit));
                }
            }
        }
        let least = best.factor();
        Ok(Choice { limit: best, least })
    }

    /// Whether there is equilibrium at a strength.
    ///
    /// # Errors
    /// A program that is not solved.
    pub fn holds(&mut self, strength: f64, more: &[Contact]) -> Result<bool, Unsolved> {
        Ok(self.solve(strength, more)?.unbalanced <= BALANCED)
    }

    /// Whether a choice can still give less than the best: it has no equilibrium at the best one's strength.
    fn is_worth(&mut self, more: &[Contact], best: &Limit) -> Result<bool, Unsolved> {
        let Some(low) = best.low else { return Ok(true) };
        Ok(!self.holds(low * (1.0 + SAME), more)?)
    }

    /// Chooses for every corner that is entered the facet that it enters less, until none is.
    fn dive(&mut self, corners: &[Corner], free: &Limit) -> Result<Limit, Unsolved> {
        let (mut chosen, mut limit) = (Vec::new(), free.clone());
        loop {
            let entered = self.entered(corners, &limit, &chosen);
            if entered.is_empty() {
                return Ok(limit);
            }
            chosen.extend(entered);
            limit = self.limit_near(&contacts_of(corners, &chosen), Some(&limit))?;
        }
    }

    /// Corners of which the mechanism enters both facets, the deepest first, with the facet that is entered less.
    fn entered(&self, corners: &[Corner], limit: &Limit, chosen: &[(usize, usize)]) -> Vec<(usize, usize)> {
        let (Some(solution), Some(strength)) = (&limit.mechanism, limit.low) else { return Vec::new() };
        let fastest = self.program.fastest(&solution.motions);
        let into = |contact: &Contact| {
            -contact.opening(&self.program.partings(&solution.motions, contact), strength * contact.friction).1[0]
        };
        let mut entered = Vec::new();
        for (k, corner) in corners.iter().enumerate().filter(|(k, _)| chosen.iter().all(|(c, _)| c != k)) {
            let depth = corner.facets.each_ref().map(into);
            let facet = usize::from(depth[1] < depth[0]);
            if depth[facet] > STILL * fastest {
                entered.push((depth[facet], k, facet));
            }
        }
        entered.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        entered.into_iter().map(|(_, k, facet)| (k, facet)).collect()
    }
}

/// The strength at which the unbalanced share would vanish by its slope.
fn newton(low: f64, solution: Option<&Solution>) -> Option<f64> {
    let solution = solution.filter(|s| s.slope < 0.0)?;
    Some(low - solution.unbalanced / solution.slope)
}

/// Whether a step from `low` is short enough for the slope to hold.
fn near(low: f64, high: f64) -> bool {
    high <= low * (1.0 + NEAR)
}

/// The next trial above `low` and below `high`: the slope's, most of the way there when it is far, or, to close the
/// bracket, one just below its upper end.
fn within(low: f64, high: Option<f64>, newton: f64, is_closing: bool) -> f64 {
    let part = |to: f64| low + STEP * (to - low);
    match high {
        Some(high) if is_closing => high / (1.0 + 0.9 * WIDTH),
        Some(high) if newton >= high => part(high),
        _ if near(low, newton) => newton,
        _ => part(newton),
    }
}

/// Corners with the facet that each has got.
type Chosen = Vec<(usize, usize)>;

fn contacts_of(corners: &[Corner], chosen: &[(usize, usize)]) -> Vec<Contact> {
    chosen.iter().map(|&(corner, facet)| corners[corner].facets[facet]).collect()
}

/// Takes out the choice with the smallest factor.
fn pop_least(open: &mut Vec<(Chosen, Limit)>) -> Option<(Chosen, Limit)> {
    let value = |k: usize| open[k].1.factor().value();
    let least = (0..open.len()).min_by(|&a, &b| value(a).total_cmp(&value(b)))?;
    Some(open.swap_remove(least))
}

/// Whether a factor is clearly less than another.
fn beats(limit: &Limit, best: &Limit) -> bool {
    limit.factor().value() * (1.0 + SAME) < best.factor().value()
}
