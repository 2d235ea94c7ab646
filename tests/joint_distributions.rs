//! Claim: spacings, lengths and directions of joint sets follow the distributions that the case names.

use std::f64::consts::PI;

use enmm::geometry::Point;
use enmm::geometry::joint_set::{JointSetParameters, Spread, Turn, generate};

/// Horizontal joints through a strip of 1 m width.
const MEAN: f64 = 0.5;

fn rectangle(width: f64, height: f64) -> Vec<Point> {
    [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]].map(Point::from).to_vec()
}

/// Asserts that the share of `samples` below each value is its probability, within 4.5 standard deviations of a share:
/// a false alarm of 7e-6 each, for seeds that are fixed.
fn assert_shares(name: &str, samples: &[f64], expected: &[(f64, f64)]) {
    let count = samples.len() as f64;
    for &(value, probability) in expected {
        let share = samples.iter().filter(|sample| **sample < value).count() as f64 / count;
        let allowed = 4.5 * (probability * (1.0 - probability) / count).sqrt();
        assert!((share - probability).abs() <= allowed, "{name} below {value}: {share}, not {probability}");
    }
}

/// Probabilities of the standard normal distribution at -1, 0, 1 and 2 (Abramowitz and Stegun, table 26.1).
const NORMAL: [(f64, f64); 4] = [(-1.0, 0.158_655), (0.0, 0.5), (1.0, 0.841_345), (2.0, 0.977_250)];

/// Values below which a distribution of this mean and standard deviation has the probability beside them.
fn quantiles(spread: Spread, mean: f64, sd: f64) -> Vec<(f64, f64)> {
    match spread {
        Spread::Exponential => [0.1, 0.5, 0.9, 0.99].map(|p: f64| (-mean * (1.0 - p).ln(), p)).to_vec(),
        Spread::Uniform => {
            let half = 3f64.sqrt() * sd;
            [0.0, 0.1, 0.5, 0.9, 1.0].map(|p| (mean - half + 2.0 * half * p + 1e-9, p)).to_vec()
        }
        Spread::Lognormal => {
            let variance = (1.0 + (sd / mean).powi(2)).ln();
            let middle = mean.ln() - 0.5 * variance;
            NORMAL.map(|(z, p)| ((middle + z * variance.sqrt()).exp(), p)).to_vec()
        }
        Spread::Normal => NORMAL.map(|(z, p)| (mean + z * sd, p)).to_vec(),
    }
}

#[test]
fn spacings_follow_their_distribution() {
    for (spread, sd) in [
        (Spread::Exponential, 0.0),
        (Spread::Uniform, 0.2),
        (Spread::Lognormal, 0.25),
        (Spread::Lognormal, 0.7),
        (Spread::Normal, 0.1),
    ] {
        let set =
            JointSetParameters { spacing: MEAN, spacing_sd: sd, spacing_spread: spread, seed: 5, ..Default::default() };
        let traces = generate(&set, &rectangle(1.0, 5000.0)).unwrap();
        let heights: Vec<f64> = traces.iter().map(|trace| trace[0].y).collect();
        let spacings: Vec<f64> = heights.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(spacings.len() > 9000, "{spread:?}: {}", spacings.len());
        assert_shares(&format!("spacing, {spread:?} {sd}"), &spacings, &quantiles(spread, MEAN, sd));
    }
}

#[test]
fn trace_lengths_follow_their_distribution() {
    for (spread, sd) in [(Spread::Exponential, 0.0), (Spread::Uniform, 0.8), (Spread::Lognormal, 1.0)] {
        let set = JointSetParameters {
            spacing: 10.0,
            trace_length: Some(2.0),
            trace_length_sd: sd,
            length_spread: spread,
            gap: 1.0,
            seed: 9,
            ..Default::default()
        };
        // The first and last of each of the ten lines may be cut by the region.
        let width = 3000.0;
        let traces = generate(&set, &rectangle(width, 100.0)).unwrap();
        let whole = traces.iter().filter(|trace| trace[0].x > 0.0 && trace[1].x < width);
        let lengths: Vec<f64> = whole.map(|trace| (trace[1] - trace[0]).norm()).collect();
        assert!(lengths.len() > 9000, "{}", lengths.len());
        assert_shares(&format!("length, {spread:?}"), &lengths, &quantiles(spread, 2.0, sd));
    }
}

/// Turns (rad) of traces of a set from the x axis.
fn turns(turn: Turn, dip_sd: f64) -> Vec<f64> {
    let set = JointSetParameters {
        dip_sd,
        turn,
        spacing: 1.0,
        trace_length: Some(0.5),
        gap: 0.5,
        seed: 3,
        ..Default::default()
    };
    let region = rectangle(100.0, 100.0);
    let whole = |p: &Point| p.x > 0.0 && p.x < 100.0 && p.y > 0.0 && p.y < 100.0;
    let traces = generate(&set, &region).unwrap().into_iter().filter(|trace| trace.iter().all(whole));
    traces.map(|[a, b]| (b.y - a.y).atan2(b.x - a.x)).collect()
}

/// Poles that scatter little are normal about their mean with the variance 1/κ in both directions of their sphere; a
/// mean pole that leaves the plane by τ widens the traces to 1/(κ·cos²τ). Terms of order 1/κ are left out: 4e-4 of the
/// standard deviation here.
#[test]
fn directions_follow_their_distribution() {
    let sd = 0.1;
    let half = 3f64.sqrt() * sd;
    let uniform = turns(Turn::Uniform, sd);
    let shares = [0.0, 0.1, 0.5, 0.9, 1.0].map(|p| (half * (2.0 * p - 1.0) + 1e-9, p));
    assert_shares("turn, uniform", &uniform, &shares);
    for out_of_plane in [0.0, PI / 3.0] {
        let concentration = 2500.0;
        let fisher = turns(Turn::Fisher { concentration, out_of_plane }, 0.0);
        let sd = 1.0 / (f64::sqrt(concentration) * f64::cos(out_of_plane));
        assert!(fisher.len() > 9000);
        assert_shares(&format!("turn, Fisher, {out_of_plane}"), &fisher, &NORMAL.map(|(z, p)| (z * sd, p)));
    }
}

/// In the plane of the mean pole the density of the turn δ of Fisher's distribution comes from its definition: poles
/// within 60° of the mean, by numerical integration over the sphere.
#[test]
fn wide_scatter_follows_fisher_on_the_sphere() {
    let concentration: f64 = 8.0;
    let mut weights = vec![0.0; 60];
    let (thetas, turns_around) = (2000, 720);
    for i in 0..thetas {
        let theta = (f64::from(i) + 0.5) / f64::from(thetas) * PI;
        let weight = (concentration * (theta.cos() - 1.0)).exp() * theta.sin();
        for j in 0..turns_around {
            let around = (f64::from(j) + 0.5) / f64::from(turns_around) * 2.0 * PI;
            let turn = (-theta.sin() * around.cos() / theta.cos()).atan().to_degrees();
            if turn.abs() < 60.0 {
                weights[((turn + 60.0) / 2.0) as usize] += weight;
            }
        }
    }
    let total: f64 = weights.iter().sum();
    let mut below = 0.0;
    let mut expected = Vec::new();
    for (k, weight) in weights.iter().enumerate().take(59) {
        below += weight / total;
        expected.push(((2.0 * (k as f64 + 1.0) - 60.0).to_radians(), below));
    }
    let fisher = turns(Turn::Fisher { concentration, out_of_plane: 0.0 }, 0.0);
    assert_shares("turn, Fisher, wide", &fisher, &expected);
}

#[test]
fn a_line_passes_through_the_origin() {
    for (spacing_spread, spacing_sd) in [(Spread::Normal, 0.0), (Spread::Exponential, 0.0), (Spread::Normal, 0.3)] {
        let origin = Point::new(3.0, 7.123);
        let set = JointSetParameters {
            dip: 0.4,
            spacing: 1.5,
            spacing_sd,
            spacing_spread,
            origin: Some(origin),
            seed: 2,
            ..Default::default()
        };
        let traces = generate(&set, &rectangle(10.0, 20.0)).unwrap();
        let off = |trace: &[Point; 2]| (trace[1] - trace[0]).normalize().perp(&(origin - trace[0])).abs();
        let through = traces.iter().filter(|trace| off(trace) < 1e-12).count();
        assert_eq!(through, 1, "{spacing_spread:?}");
        let (above, below) = (0.4f64.cos() * 20.0, 0.4f64.sin() * 10.0);
        assert!(traces.len() as f64 > 0.4 * (above + below) / 1.5, "{}", traces.len());
        assert!(
            generate(&JointSetParameters { origin: Some(Point::new(0.0, 99.0)), ..set }, &rectangle(10.0, 20.0))
                .is_err()
        );
    }
}
