//! Joint sets from statistics: parallel lines of traces and rock bridges across a region.
//!
//! Knows angles, lengths and a seed. The same parameters and region give the same traces, bit for bit, on one platform.

use super::loops::validate_loop;
use super::polygon::{bounds, contains};
use super::trace::crossings;
use super::{GeometryError, Point, Vector};

/// Upper limit on the traces of one set, so that a slip in the spacing cannot fill the memory.
const TRACES_MAX: usize = 1_000_000;
/// Spacings and lengths are drawn again when they lie further than this part of their mean from it.
const SCATTER_RATIO_MAX: f64 = 0.9;
/// Directions are drawn again when they lie further than this many standard deviations from the mean.
const DIP_DEVIATIONS_MAX: f64 = 3.0;
/// Pieces shorter than this part of the size of the region are dropped.
const PIECE_RATIO_MIN: f64 = 1e-9;

/// Greatest turn of a trace whose pole follows Fisher's distribution (rad) (theory, section 13).
const FISHER_TURN_MAX: f64 = std::f64::consts::FRAC_PI_3;
/// Ratio of the greatest lognormal or exponential length that is looked for outside the region to the mean (theory,
/// section 13).
const REACH_RATIO: f64 = 10.0;
/// Where tails of distributions are cut off.
const CUTOFFS: Cutoffs = Cutoffs { turn: FISHER_TURN_MAX, reach: REACH_RATIO };

/// Where tails of distributions are cut off: [`FISHER_TURN_MAX`] and [`REACH_RATIO`], or others to compare with.
#[derive(Clone, Copy)]
struct Cutoffs {
    turn: f64,
    reach: f64,
}

/// How spacings and lengths scatter about their mean.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Spread {
    /// Normal, cut off at 0.1 and 1.9 of the mean.
    #[default]
    Normal,
    /// Lognormal by its own mean and standard deviation.
    Lognormal,
    /// Exponential by its mean; the standard deviation is the mean.
    Exponential,
    /// Uniform up to √3 standard deviations to both sides.
    Uniform,
}

/// How directions scatter about their mean.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub enum Turn {
    /// Normal by `dip_sd`, cut off at three of them.
    #[default]
    Normal,
    /// Uniform by `dip_sd`, up to √3 of them to both sides.
    Uniform,
    /// Traces of joints whose poles in space follow Fisher's distribution, at most π/3 from the mean.
    Fisher {
        /// Concentration, at least 5.
        concentration: f64,
        /// Angle of the mean pole out of the plane of the traces (rad).
        out_of_plane: f64,
    },
}

/// Statistics of a joint set.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct JointSetParameters {
    /// Mean direction of the traces, counter-clockwise from the x axis (rad).
    pub dip: f64,
    /// Standard deviation of the direction of each trace (rad), cut off at three of them; at most π/6.
    pub dip_sd: f64,
    /// How directions scatter.
    pub turn: Turn,
    /// Mean distance between neighbouring lines, normal to them (m).
    pub spacing: f64,
    /// Standard deviation of the spacing (m), cut off at 0.1 and 1.9 of the mean; at most the mean.
    pub spacing_sd: f64,
    /// How spacings scatter.
    pub spacing_spread: Spread,
    /// Mean length of a trace (m); none for traces through the whole region.
    pub trace_length: Option<f64>,
    /// Standard deviation of the trace length (m), cut off at 0.1 and 1.9 of the mean; at most the mean.
    pub trace_length_sd: f64,
    /// How trace lengths scatter.
    pub length_spread: Spread,
    /// Rock bridge between traces on one line (m).
    pub gap: f64,
    /// Seed of the generator.
    pub seed: u64,
    /// A position (m) through which one of the lines passes; none for chance.
    pub origin: Option<Point>,
}

/// Generates the traces of a joint set inside a polygon (m), line by line from one side of the region to the other.
///
/// Lines follow each other at spacings drawn from their distribution, the first one at a random part of a spacing; with
/// an origin they follow each other from there to both sides. A line of finite traces starts at a random phase; each
/// trace turns about its own middle by the scatter of the direction. What lies outside the region, which need not be
/// convex, is cut away.
///
/// # Errors
/// A parameter out of its range, a region that is no loop, or more than a million traces.
///
/// # Examples
/// ```
/// use enmm::geometry::{Point, joint_set::{JointSetParameters, generate}};
/// let set = JointSetParameters {
///     spacing: 1.0, seed: 7, ..JointSetParameters::default()
/// };
/// let region = [[0.0, 0.0], [4.0, 0.0], [4.0, 10.0], [0.0, 10.0]].map(|p| Point::new(p[0], p[1]));
/// let traces = generate(&set, &region).unwrap();
/// assert_eq!(traces.len(), 10); // horizontal lines, one per metre of height
/// ```
pub fn generate(set: &JointSetParameters, region: &[Point]) -> Result<Vec<[Point; 2]>, GeometryError> {
    Ok(generate_within(set, region, CUTOFFS)?.traces)
}

/// Traces of a joint set and the rock bridges between those of one line.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct BridgedSet {
    /// Traces, as [`generate`] gives them.
    pub traces: Vec<[Point; 2]>,
    /// Bridges from the end of a trace to the start of the next one on its line, inside the region.
    pub bridges: Vec<[Point; 2]>,
}

/// As [`generate`], with the rock bridges.
///
/// # Errors
/// As [`generate`].
pub fn generate_bridged(set: &JointSetParameters, region: &[Point]) -> Result<BridgedSet, GeometryError> {
    generate_within(set, region, CUTOFFS)
}

/// As [`generate`], with other cutoffs.
fn generate_within(set: &JointSetParameters, region: &[Point], cutoffs: Cutoffs) -> Result<BridgedSet, GeometryError> {
    check(set)?;
    let region = validate_loop(region, "region of a joint set")?;
    let (low, high) = bounds(&region);
    let (sin, cos) = libm::sincos(set.dip);
    let (along, normal) = (Vector::new(cos, sin), Vector::new(-sin, cos));
    let range = |axis: Vector| {
        let positions = region.iter().map(|p| p.dot(&axis));
        positions
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), position| (low.min(position), high.max(position)))
    };
    let (start, end) = range(along);
    let (bottom, top) = range(normal);
    let mut random = Random::new(set.seed);
    let piece_min = PIECE_RATIO_MIN * (high - low).norm();
    let mut made = BridgedSet::default();
    let mut tried = 0;
    // A turned trace reaches across its line, so that lines just outside the region matter too.
    let half = 0.5 * set.trace_length.map_or(end - start, |length| length * set.reach(cutoffs));
    let margin = half * libm::sin(set.turn_max(cutoffs));
    let mut waiting = match set.origin {
        None => vec![bottom - margin + set.spacing * random.uniform()],
        Some(origin) => lines_below(set, origin.dot(&normal), [bottom - margin, top + margin], &mut random)?,
    };
    let mut line = waiting.pop().unwrap_or(top);
    while line < top + margin {
        let mut position = first_start(set, start, &mut random);
        let mut end_before = None;
        while position < end {
            tried += 1;
            if tried > TRACES_MAX {
                return Err(GeometryError::TooManyTraces { spacing: set.spacing, limit: TRACES_MAX });
            }
            let length = set
                .trace_length
                .map_or(end - start, |mean| random.spread(set.length_spread, mean, set.trace_length_sd));
            let middle = normal * line + along * (position + 0.5 * length);
            let turn = random.turn(set, cutoffs);
            let stretch = if set.trace_length.is_none() { 1.0 / turn.x } else { 1.0 };
            let half = (along * turn.x + normal * turn.y) * (0.5 * length * stretch);
            clip_to(&region, middle - half, middle + half, piece_min, &mut made.traces);
            if let Some(from) = end_before.replace(middle + half).filter(|_| set.gap > 0.0) {
                clip_to(&region, from, middle - half, piece_min, &mut made.bridges);
            }
            position += length + set.gap;
        }
        line = match waiting.pop() {
            Some(line) => line,
            None => line + random.spread(set.spacing_spread, set.spacing, set.spacing_sd),
        };
    }
    Ok(made)
}

impl JointSetParameters {
    /// Greatest length of a trace over the mean that is looked for outside the region.
    fn reach(&self, cutoffs: Cutoffs) -> f64 {
        match self.length_spread {
            Spread::Normal | Spread::Uniform => 1.0 + SCATTER_RATIO_MAX,
            Spread::Lognormal | Spread::Exponential => cutoffs.reach,
        }
    }

    /// Greatest turn of a trace (rad).
    fn turn_max(&self, cutoffs: Cutoffs) -> f64 {
        match self.turn {
            Turn::Normal => DIP_DEVIATIONS_MAX * self.dip_sd,
            Turn::Uniform => 3f64.sqrt() * self.dip_sd,
            Turn::Fisher { .. } => cutoffs.turn,
        }
    }
}

/// Lines above `low` that go down from `origin` at drawn spacings, and the one through `origin` first.
fn lines_below(
    set: &JointSetParameters,
    origin: f64,
    [low, high]: [f64; 2],
    random: &mut Random,
) -> Result<Vec<f64>, GeometryError> {
    if !(low..=high).contains(&origin) {
        let rule = "such that a line through it meets the region";
        return Err(GeometryError::JointSet { parameter: "origin", value: origin, rule });
    }
    let mut lines = vec![origin];
    let mut line = origin;
    while lines.len() <= TRACES_MAX {
        line -= random.spread(set.spacing_spread, set.spacing, set.spacing_sd);
        if line <= low {
            return Ok(lines);
        }
        lines.push(line);
    }
    Err(GeometryError::TooManyTraces { spacing: set.spacing, limit: TRACES_MAX })
}

/// Where the first trace of a line starts: at the rim when traces run through, else up to a trace and a gap before it.
fn first_start(set: &JointSetParameters, start: f64, random: &mut Random) -> f64 {
    set.trace_length.map_or(start, |length| start - random.uniform() * (length + set.gap))
}

/// Appends the parts of a trace inside a polygon, from its start to its end.
fn clip_to(region: &[Point], a: Point, b: Point, piece_min: f64, traces: &mut Vec<[Point; 2]>) {
    let along = b - a;
    let cuts = crossings(region, a, b);
    let piece_min = piece_min / along.norm();
    let mut open: Option<(f64, f64)> = None;
    for pair in cuts.windows(2) {
        let inside = contains(region, a + along * (0.5 * (pair[0] + pair[1])));
        if inside {
            open = Some((open.map_or(pair[0], |(from, _)| from), pair[1]));
        } else if let Some((from, to)) = open.filter(|_| pair[1] - pair[0] > piece_min) {
            push_piece(a, along, from, to, piece_min, traces);
            open = None;
        }
    }
    if let Some((from, to)) = open {
        push_piece(a, along, from, to, piece_min, traces);
    }
}

fn push_piece(a: Point, along: Vector, from: f64, to: f64, piece_min: f64, traces: &mut Vec<[Point; 2]>) {
    if to - from > piece_min {
        traces.push([a + along * from, a + along * to]);
    }
}

/// Refuses parameters out of range.
fn check(set: &JointSetParameters) -> Result<(), GeometryError> {
    let scatter = |mean: f64, sd: f64| (0.0..=mean).contains(&sd);
    // A lognormal distribution may scatter more than its mean.
    let spread = |kind: Spread, mean: f64, sd: f64| scatter(mean, sd) || kind == Spread::Lognormal && sd.is_finite();
    let positive = |value: f64| value > 0.0 && value.is_finite();
    let length = set.trace_length.unwrap_or(f64::MAX);
    let concentration = if let Turn::Fisher { concentration, .. } = set.turn { concentration } else { f64::MAX };
    let rules = [
        ("dip", set.dip, set.dip.is_finite(), "finite"),
        ("dip_sd", set.dip_sd, scatter(std::f64::consts::FRAC_PI_6, set.dip_sd), "between 0 and π/6"),
        ("spacing", set.spacing, positive(set.spacing), "positive"),
        (
            "spacing_sd",
            set.spacing_sd,
            spread(set.spacing_spread, set.spacing, set.spacing_sd),
            "between 0 and the spacing",
        ),
        ("trace_length", length, positive(length), "positive, or left out"),
        (
            "trace_length_sd",
            set.trace_length_sd,
            spread(set.length_spread, length, set.trace_length_sd),
            "between 0 and the length",
        ),
        ("concentration", concentration, concentration >= 5.0 && concentration.is_finite(), "at least 5"),
        ("gap", set.gap, set.gap >= 0.0 && set.gap.is_finite(), "0 or positive"),
    ];
    match rules.into_iter().find(|(_, _, holds, _)| !holds) {
        None => Ok(()),
        Some((parameter, value, _, rule)) => Err(GeometryError::JointSet { parameter, value, rule }),
    }
}

/// SplitMix64 of Steele, Lea and Flood (2014), with the constants of the published algorithm.
struct Random {
    state: u64,
}

impl Random {
    const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Draws from [0, 1).
    fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Draws from the standard normal distribution (Box and Muller).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// Draws from a normal distribution cut off at 0.1 and 1.9 of its mean; with `sd` ≤ mean two of three draws count.
    fn near(&mut self, mean: f64, sd: f64) -> f64 {
        loop {
            let off = sd * self.normal();
            if off.abs() <= SCATTER_RATIO_MAX * mean {
                return mean + off;
            }
        }
    }

    /// Draws from a distribution of positive numbers.
    fn spread(&mut self, kind: Spread, mean: f64, sd: f64) -> f64 {
        match kind {
            Spread::Normal => self.near(mean, sd),
            Spread::Exponential => -mean * libm::log(1.0 - self.uniform()),
            Spread::Uniform => mean + 3f64.sqrt() * sd * (2.0 * self.uniform() - 1.0),
            Spread::Lognormal => {
                let variance = libm::log1p((sd / mean).powi(2));
                mean * libm::exp(variance.sqrt() * self.normal() - 0.5 * variance)
            }
        }
    }

    /// Draws cosine and sine of the turn of a trace.
    fn turn(&mut self, set: &JointSetParameters, cutoffs: Cutoffs) -> Vector {
        match set.turn {
            Turn::Normal => self.direction(set.dip_sd),
            Turn::Uniform => {
                let angle = 3f64.sqrt() * set.dip_sd * (2.0 * self.uniform() - 1.0);
                Vector::new(libm::cos(angle), libm::sin(angle))
            }
            Turn::Fisher { concentration, out_of_plane } => self.fisher(concentration, out_of_plane, cutoffs.turn),
        }
    }

    /// Draws the turn of the trace of a joint whose pole follows Fisher's distribution about a mean pole that lies
    /// `out_of_plane` out of the plane of the traces. The angle θ off the mean has, by its inverse distribution
    /// function, cos θ = 1 + ln(u + (1 − u)·exp(−2κ))/κ (Fisher, Lewis and Embleton 1987, section 3.6.2).
    fn fisher(&mut self, concentration: f64, out_of_plane: f64, turn_max: f64) -> Vector {
        let (out, within) = libm::sincos(out_of_plane);
        loop {
            let u = 1.0 - self.uniform();
            let cos = 1.0 + libm::log(u + (1.0 - u) * libm::exp(-2.0 * concentration)) / concentration;
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            let (around_sin, around_cos) = libm::sincos(std::f64::consts::TAU * self.uniform());
            // The pole in the plane of the traces: along the mean trace and normal to it; joints have no sign.
            let (along, normal) = (sin * around_cos, cos * within - sin * around_sin * out);
            let turn = libm::atan(-along / normal);
            if turn.abs() <= turn_max {
                return Vector::new(libm::cos(turn), libm::sin(turn));
            }
        }
    }

    /// Draws cosine and sine of a normal angle cut off at three standard deviations.
    fn direction(&mut self, sd: f64) -> Vector {
        loop {
            let off = self.normal();
            if off.abs() <= DIP_DEVIATIONS_MAX {
                return Vector::new(libm::cos(sd * off), libm::sin(sd * off));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generator_gives_the_published_numbers() {
        // The test values for seed 1234567 that go round with the reference implementation (splitmix64.c).
        let mut random = Random::new(1234567);
        assert_eq!([random.bits(), random.bits()], [6457827717110365317, 3203168211198807973]);
    }
    /// Share of the draws from Fisher's distribution that the limit of 60° leaves and `other` (rad) would not, or the
    /// other way round.
    fn share_beyond(concentration: f64, other: f64) -> f64 {
        let draws = 100_000;
        let mut random = Random::new(5);
        let [low, high] = [FISHER_TURN_MAX.min(other), FISHER_TURN_MAX.max(other)];
        let turns = (0..draws).map(|_| random.fisher(concentration, 0.0, high));
        turns.filter(|turn| turn.y.atan2(turn.x).abs() > low).count() as f64 / f64::from(draws)
    }

    /// A joint that turns by more than 60° belongs to another set. A limit of 120°, which is none, draws the same
    /// traces unless the set scatters widely; one of 30° would cut off what belongs to it.
    #[test]
    fn the_limit_of_fishers_turns_cuts_off_little() {
        use std::f64::consts::PI;
        assert!(share_beyond(20.0, 2.0 * PI / 3.0) < 1e-4);
        assert!(share_beyond(8.0, 2.0 * PI / 3.0) < 0.03);
        assert!(share_beyond(5.0, 2.0 * PI / 3.0) < 0.08);
        assert!(share_beyond(8.0, PI / 6.0) > 0.1);
    }

    /// Mean length of joints per area (1/m) of sets with many seeds, and its standard error.
    fn density(length_spread: Spread, reach: f64) -> [f64; 2] {
        let side = 20.0;
        let region = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]].map(Point::from);
        let seeds = 1600;
        let of_seed = |seed| {
            let set = JointSetParameters {
                turn: Turn::Fisher { concentration: 5.0, out_of_plane: 0.0 },
                spacing: 1.0,
                trace_length: Some(3.0),
                trace_length_sd: 3.0,
                length_spread,
                gap: 3.0,
                seed,
                ..JointSetParameters::default()
            };
            let traces = generate_within(&set, &region, Cutoffs { reach, ..CUTOFFS }).expect("a set").traces;
            traces.iter().map(|[a, b]| (b - a).norm()).sum::<f64>() / (side * side)
        };
        let all: Vec<f64> = (0..seeds).map(of_seed).collect();
        let mean = all.iter().sum::<f64>() / seeds as f64;
        let variance = all.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (seeds - 1) as f64;
        [mean, (variance / seeds as f64).sqrt()]
    }

    /// Lines so far outside that half a trace of ten mean lengths does not reach the region are left out: with half or
    /// twice that reach the density of joints is the same within 4 standard errors; without any it falls.
    #[test]
    fn the_reach_beyond_the_region_loses_no_joints() {
        for spread in [Spread::Exponential, Spread::Lognormal] {
            let [usual, error] = density(spread, REACH_RATIO);
            for other in [0.5 * REACH_RATIO, 2.0 * REACH_RATIO] {
                let [found, other_error] = density(spread, other);
                assert!((found - usual).abs() < 4.0 * error.hypot(other_error), "{spread:?} {other}: {found} {usual}");
            }
            let [none, other_error] = density(spread, 0.0);
            assert!(none < usual - 4.0 * error.hypot(other_error), "{spread:?}: {none} {usual} {error}");
        }
    }
}
