//! Claim: over slopes of many kinds the factor of safety is no higher than limit analysis of rigid blocks allows, a
//! method that shares no code with the dynamics but the cutting of blocks; where it is clearly lower, dilation explains
//! that: with joints that dilate by their friction angle both agree.

use crate::common::case;
use crate::common::extent::by_extent;
use crate::common::parts::rock;
use crate::common::random::Random;
use enmm::model::Case;
use enmm_stability::limit_analysis::{Factor, bound};
use enmm_stability::strength_reduction::{
    End, MechanismOptions, Reduction, ReductionOptions, Verdict, factor_of_safety, mechanisms,
};
use std::fmt::Write;

/// Width of the brackets.
const TOLERANCE: f64 = 5e-3;
/// Area of a grain over the square of the mesh size.
const GRAIN: f64 = 0.01;
/// Spacings of joints and mesh sizes of the second and the third six slopes, over those of all others: the finer ones
/// have up to 170 blocks, and take ten times as long.
const FINE: [f64; 2] = [0.7, 0.5];

/// Numbers of 24 bits from 0 to 1, which a seed gives.
struct Dice(Random);

impl Dice {
    fn roll(&mut self) -> f64 {
        (self.0.word() >> 40) as f64 / (1u64 << 24) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }
}

/// A point that lies `length` farther in a direction (degrees).
fn on(from: [f64; 2], angle_deg: f64, length: f64) -> [f64; 2] {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    [from[0] + length * cos, from[1] + length * sin]
}

/// The face of a slope from (14, 5) to a level at 20 m, and what is cut into it.
struct Slope {
    dice: Dice,
    face_deg: f64,
    /// Spacings and mesh size over those of the coarsest slopes.
    scale: f64,
    joints: String,
}

impl Slope {
    fn new(seed: u64) -> Self {
        let mut dice = Dice(Random::from_word(977 * seed + 13));
        (0..8).for_each(|_| _ = dice.roll());
        let face_deg = dice.between(50.0, 70.0);
        let scale = (seed / 6).checked_sub(1).and_then(|row| FINE.get(row as usize)).copied().unwrap_or(1.0);
        Self { dice, face_deg, scale, joints: String::new() }
    }

    fn mesh_size(&self) -> f64 {
        2.0 * self.scale
    }

    fn grain(&self) -> f64 {
        GRAIN * self.mesh_size().powi(2)
    }

    fn crest(&self) -> f64 {
        14.0 + 15.0 / self.face_deg.to_radians().tan()
    }

    fn joint(&mut self, points: &[[f64; 2]]) {
        write!(self.joints, "[[joint]]\npoints = {points:?}\n").expect("text");
    }

    fn set(&mut self, dip_deg: f64, spacing: f64, seed: u64) {
        let (top, spacing) = (self.crest(), spacing * self.scale);
        write!(
            self.joints,
            "[[joint_set]]\nangle_deg = {dip_deg:.2}\ndip_sd_deg = 1.0\nspacing = {spacing:.3}\nspacing_sd = {:.3}\n\
             seed = {seed}\nregion = [[13.0, 4.0], [{top:.3}, 20.5], [{:.3}, 20.5]]\n",
            0.15 * spacing,
            top + 16.0
        )
        .expect("text");
    }

    /// Two sets: one dips out of the slope, one into it.
    fn two_sets(&mut self, seed: u64, dips: [[f64; 2]; 2], spacings: [f64; 2]) {
        for (k, [low, high]) in dips.into_iter().enumerate() {
            let dip = self.dice.between(low, high);
            let spacing = spacings[k] * self.dice.between(0.7, 1.3);
            self.set(dip, spacing, 100 * (k as u64 + 1) + seed);
        }
    }

    /// A base of straight pieces from the face to the level above, with a joint up from each of its bends.
    fn based(&mut self, pieces: &[(f64, f64)], up_deg: [f64; 2]) {
        let mut p = [14.0 + 1.5 / self.face_deg.to_radians().tan(), 6.5];
        let mut base = vec![on(p, 180.0 + pieces[0].0, 1.0), p];
        let mut bends = Vec::new();
        for &(dip_deg, length) in pieces.iter().cycle() {
            p = on(p, dip_deg, length * self.scale);
            base.push(p);
            if p[1] > 20.5 {
                break;
            }
            bends.push(p);
        }
        self.joint(&base);
        for bend in bends {
            let up = self.dice.between(up_deg[0], up_deg[1]);
            self.joint(&[bend, on(bend, up, 21.0 - bend[1] + 4.0)]);
        }
    }

    /// Bricks over a base that dips out of the slope, each course half a brick farther.
    fn masonry(&mut self) {
        let dip = self.dice.between(22.0, 34.0);
        let (height, width) = (self.dice.between(1.6, 2.4) * self.scale, 3.0 * self.scale);
        let foot = [14.0 + 1.5 / self.face_deg.to_radians().tan(), 6.5];
        for course in 0..(7.0 / self.scale) as i32 {
            let start = on(foot, dip + 90.0, height * f64::from(course));
            self.joint(&[on(start, dip, -12.0), on(start, dip, 40.0)]);
            for brick in -3..(9.0 / self.scale) as i32 {
                let along = width * (f64::from(brick) + 0.5 * f64::from(course % 2) + 0.13);
                let bottom = on(start, dip, along);
                self.joint(&[bottom, on(bottom, dip + 90.0, height)]);
            }
        }
    }

    /// The case; where joints dilate by an angle the rock is ten times as stiff: limit analysis is exact for rigid
    /// blocks, and slender columns of soft rock lean, slip and fail some per cent earlier.
    fn case(&self, friction_deg: f64, dilation_deg: Option<f64>) -> Case {
        let dilation =
            dilation_deg.map_or(String::new(), |angle| format!("dilation_deg = {angle:?}\ndilation_slip = 1e3\n"));
        let young = if dilation_deg.is_some() { 5e10 } else { 5e9 };
        let text = format!(
            "title = \"slope\"\n[domain]\noutline = [[0.0, 0.0], [48.0, 0.0], [48.0, 20.0], [{:.3}, 20.0], \
             [14.0, 5.0], [0.0, 5.0]]\n[mesh]\nsize = {:?}\nangle_deg = 7.0\n{}[joint_law.joint]\n\
             friction_deg = {friction_deg:?}\n{dilation}[[fix]]\nedge = [[0.0, 0.0], [48.0, 0.0]]\n{}\
             [[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration = 10.0\n",
            self.crest(),
            self.mesh_size(),
            self.joints,
            rock(young, 2650.0)
        );
        case(&text)
    }
}

/// Slope `seed` of its kind, and the friction of its joints.
fn slope(seed: u64) -> (&'static str, Slope, f64) {
    let mut slope = Slope::new(seed);
    let kind = match seed % 6 {
        0 => {
            slope.two_sets(seed, [[34.0, 48.0], [115.0, 145.0]], [1.7, 1.9]);
            "two sets"
        }
        1 => {
            slope.two_sets(seed, [[18.0, 30.0], [105.0, 120.0]], [3.0, 1.4]);
            "columns"
        }
        2 => {
            slope.masonry();
            "masonry"
        }
        3 => {
            let tread = slope.dice.between(24.0, 34.0);
            slope.based(&[(tread, 3.0), (82.0, 0.8)], [85.0, 95.0]);
            slope.set(tread + 2.0, 2.5, 500 + seed);
            "step path"
        }
        4 => {
            let [low, high] = [slope.dice.between(10.0, 25.0), slope.dice.between(48.0, 62.0)];
            slope.based(&[(low, 9.0), (high, 30.0)], [80.0, 110.0]);
            slope.two_sets(seed, [[low - 5.0, low], [80.0, 110.0]], [3.0, 3.0]);
            "wedges"
        }
        _ => {
            let dips = [[10.0, 20.0], [28.0, 38.0], [50.0, 62.0]].map(|[low, high]| slope.dice.between(low, high));
            slope.based(&[(dips[0], 6.0), (dips[1], 6.0), (dips[2], 30.0)], [85.0, 110.0]);
            slope.set(dips[1] + 4.0, 2.5, 700 + seed);
            "kinked plane"
        }
    };
    let friction_deg = slope.dice.between(30.0, 42.0);
    (kind, slope, friction_deg)
}

fn reduce(case: &Case) -> Reduction {
    let options = ReductionOptions { tolerance: TOLERANCE, ..Default::default() };
    factor_of_safety(case, &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{}: {e}", case.title))
}

/// The same without the mechanisms that are grains, which squeezed joints pop out.
fn reduce_rock(case: &Case, grain: f64) -> Reduction {
    let options = ReductionOptions { tolerance: TOLERANCE, ..Default::default() };
    let found = mechanisms(case, MechanismOptions { least_area: Some(grain), count: 1 }, &options, &mut |_, _| {});
    found.unwrap_or_else(|e| panic!("{}: {e}", case.title)).pop().expect("a search")
}

/// Whether no stable trial stands above one that is not.
fn is_monotone(reduction: &Reduction) -> bool {
    reduction.trials.windows(2).all(|t| t[0].verdict == Verdict::Stable || t[1].verdict != Verdict::Stable)
}

/// Compares one slope; returns its line of the table and what is wrong with it.
fn compare(seed: u64) -> (String, Option<String>) {
    let (kind, slope, friction_deg) = slope(seed);
    let grain = slope.grain();
    let mut own = reduce(&slope.case(friction_deg, None));
    if own.end == End::UnstableThroughout && own.first_unstable().is_some_and(|t| t.failing_area() < grain) {
        // A grain that joints squeeze pops out at any strength.
        own = reduce_rock(&slope.case(friction_deg, None), grain);
    }
    let bound = own.bound.as_ref().unwrap_or_else(|e| panic!("slope {seed}, {kind}: {e}"));
    let (level, associated) = (bound.level_tops.factor, bound.associated.factor);
    let mut line = format!("{seed:>3} {kind:<13} {:>3} blocks, φ {friction_deg:.1}°: bound {level}", bound.blocks[1]);
    let (Some(factor), Factor::Found(limit)) = (own.factor(), level) else {
        let agrees = own.end == End::StableThroughout && own.at_least().is_some_and(|f| f <= 1.02 * level.value());
        write!(line, ", own {:?} {:?}", own.end, own.at_least()).expect("text");
        return (line.clone(), (!agrees).then_some(line));
    };
    write!(line, ", own {factor:.4} ({:+.1} %)", 100.0 * (factor / limit - 1.0)).expect("text");
    let mut wrong = !is_monotone(&own);
    wrong |= own.low.is_some_and(|low| low > 1.02 * limit);
    let rock = own.first_unstable().is_some_and(|trial| trial.failing_area() >= grain);
    if factor < 0.95 * limit && !rock {
        line.push_str(", a grain");
    } else if factor < 0.95 * limit {
        // The friction at which the associated slope fails, and dilation as large.
        let angle = (friction_deg.to_radians().tan() / associated.value()).atan().to_degrees();
        let dilating = reduce_rock(&slope.case(angle, Some(angle)), grain);
        let ratio = dilating.factor().unwrap_or(f64::NAN);
        write!(line, ", dilating {:+.1} %", 100.0 * (ratio - 1.0)).expect("text");
        wrong |= ratio.is_nan() || (ratio - 1.0).abs() > 0.02;
    }
    (line.clone(), wrong.then_some(line))
}

fn compare_all(seeds: std::ops::Range<u64>) {
    let mut wrong = Vec::new();
    for seed in seeds {
        let (line, fault) = compare(seed);
        println!("{line}");
        wrong.extend(fault);
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Two sets at 40° and 130°. A grain of 4 cm² creeps on the crest at any strength: it once was judged failing at half
/// the factor of the slope, between trials that stood.
#[test]
fn a_grain_that_creeps_makes_no_verdict_alternate() {
    let mut slope = Slope { dice: Dice(Random::from_word(1)), face_deg: 60.0, scale: 1.0, joints: String::new() };
    slope.set(40.0, 2.0, 100);
    slope.set(130.0, 2.2, 200);
    let reduction = reduce(&slope.case(40.0, None));
    let bound = reduction.bound.as_ref().expect("a bound").level_tops.factor.value();
    let factor = reduction.factor().expect("a factor");
    assert!(is_monotone(&reduction), "{:?}", reduction.trials);
    assert!((0.95..1.02).contains(&(factor / bound)), "{factor} of {bound}");
}

/// What stands beside the associated bound is never above it, over slopes of all kinds. Forces need not agree: of
/// the first 20, 17 have an estimate, which is no promise, but most must. The quick form has eight.
#[test]
fn estimates_and_bare_bounds_are_below_the_associated_bound() {
    let mut without = 0;
    let seeds = by_extent([0..8, 0..20, 0..66]);
    for seed in seeds.clone() {
        let (kind, slope, friction_deg) = slope(seed);
        let found = bound(&slope.case(friction_deg, None)).unwrap_or_else(|e| panic!("slope {seed}, {kind}: {e}"));
        let associated = found.associated.factor.value();
        let [bare, estimate] = [found.bare.as_ref().map(|bare| &bare.collapse), found.estimate.as_ref()]
            .map(|collapse| collapse.map_or(0.0, |collapse| collapse.factor.value()));
        println!("{seed:>3} {kind:<13} associated {associated:.4}, bare {bare:.4}, estimate {estimate:.4}");
        assert!(bare <= associated && estimate <= bare, "slope {seed}: {estimate} {bare} {associated}");
        without += usize::from(found.estimate.is_none());
    }
    assert!(2 * without < seeds.count(), "{without} without an estimate");
}

/// A slope of each of six kinds in turn; the quick form has the first, the full one three kinds.
#[test]
fn long_slopes_are_no_safer_than_limit_analysis_allows() {
    compare_all(by_extent([0..1, 0..3, 0..66]));
}
