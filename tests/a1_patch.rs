//! Claim A1: on covers cut by any joints, rigid motion strains nothing and a uniform strain is uniform everywhere.

mod common;

use common::claims::{Random, stresses};
use common::simulation;
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::state::State;

const YOUNG: f64 = 3e10;
const POISSON: f64 = 0.25;

/// A seven-sided rock cut by two joint sets of finite traces (dead ends and partial cuts included) and loose traces.
fn cut_rock(seed: u64) -> Simulation {
    let mut random = Random(seed);
    let mut number = |low, high| random.between(low, high);
    let mut text = format!(
        "title = \"patch\"\n[domain]\noutline = [[0.0, 0.0], [10.0, 1.0], [11.0, 6.0], [8.0, 9.0], [6.5, 7.0], \
         [4.0, 9.5], [-1.0, 5.0]]\n[mesh]\nsize = {}\nangle_deg = {}\norigin = [{}, {}]\n\
         [rock.rock]\ndensity = 2600.0\nyoung = {YOUNG:e}\npoisson = {POISSON}\n[joint_law.joint]\nfriction_deg \
         = 30.0\n",
        number(0.6, 1.4),
        number(0.0, 60.0),
        number(-5.0, 5.0),
        number(-5.0, 5.0)
    );
    for set in 0..2u64 {
        text += &format!(
            "[[joint_set]]\ndip_deg = {}\ndip_sd_deg = 8.0\nspacing = {}\nspacing_sd = 0.2\ntrace_length = {}\n\
             trace_length_sd = 1.0\ngap = 0.4\nseed = {}\n",
            number(-80.0, 80.0),
            number(0.7, 2.0),
            number(2.0, 6.0),
            seed + 100 * set
        );
    }
    for _ in 0..4 {
        let ends = [number(-1.0, 11.0), number(0.0, 9.0), number(-1.0, 11.0), number(0.0, 9.0)];
        text += &format!("[[joint]]\npoints = [[{}, {}], [{}, {}]]\n", ends[0], ends[1], ends[2], ends[3]);
    }
    text += "[[stage]]\nname = \"none\"\nkind = \"dynamic\"\nduration = 1.0\n";
    simulation(&text)
}

/// The state in which every star has moved by `field` of its place.
fn moved(simulation: &Simulation, field: impl Fn(Vector) -> Vector) -> State {
    let mut state = simulation.state().clone();
    let stars = &simulation.model().covers.star_position;
    state.displacement = stars.iter().map(|x| field(*x)).collect();
    state
}

/// Largest difference of the stress of any element from an expected one.
fn worst(simulation: &Simulation, state: &State, expected: [f64; 3]) -> f64 {
    let of = |s: [f64; 3]| (0..3).map(|k| (s[k] - expected[k]).abs()).fold(0.0, f64::max);
    let all = stresses(simulation, state);
    assert!(all.len() > 50, "{} elements", all.len());
    all.into_iter().map(of).fold(0.0, f64::max)
}

/// Plane-strain stress of a strain xx, yy, xy.
fn hooke([xx, yy, xy]: [f64; 3]) -> [f64; 3] {
    let mu = YOUNG / (2.0 * (1.0 + POISSON));
    let lambda = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    [2.0 * mu * xx + lambda * (xx + yy), 2.0 * mu * yy + lambda * (xx + yy), 2.0 * mu * xy]
}

/// A displacement U has the rounding error εU and stress one of some εEU/h (theory §11): with U of 12 m and h of 0.6 m
/// some 1e-14·E, against which 1e-12·E is the claim.
#[test]
fn rigid_motion_leaves_no_stress() {
    for seed in 1..=12 {
        let simulation = cut_rock(seed);
        let shifted = moved(&simulation, |_| Vector::new(3.7, -8.1));
        assert!(worst(&simulation, &shifted, [0.0; 3]) <= 1e-12 * YOUNG);
        for degrees in [30.0f64, -75.0, 179.0] {
            let (s, c) = degrees.to_radians().sin_cos();
            let turned = moved(&simulation, |x| Vector::new(c * x.x - s * x.y, s * x.x + c * x.y) - x);
            let found = worst(&simulation, &turned, [0.0; 3]);
            assert!(found <= 1e-12 * YOUNG, "seed {seed}, {degrees}°: {found:e} Pa");
        }
    }
}

/// x = (I + ε)X has the stress of Hooke's law for any symmetric ε, and x = Rx of it has that stress turned by R.
#[test]
fn a_uniform_strain_is_uniform_in_every_element() {
    for seed in 21..=32 {
        let simulation = cut_rock(seed);
        let mut random = Random(seed);
        let strain = [0.0; 3].map(|_: f64| random.between(-2e-3, 2e-3));
        let [xx, yy, xy] = strain;
        let stretched = |x: Vector| Vector::new(xx * x.x + xy * x.y, xy * x.x + yy * x.y);
        let plain = worst(&simulation, &moved(&simulation, stretched), hooke(strain));
        assert!(plain <= 1e-12 * YOUNG, "seed {seed}: {plain:e} Pa");
        let (s, c) = random.between(-3.0, 3.0).sin_cos();
        let turned = |x: Vector| {
            let y = x + stretched(x);
            Vector::new(c * y.x - s * y.y, s * y.x + c * y.y) - x
        };
        let [a, b, t] = hooke(strain);
        let carried = [
            c * c * a + s * s * b - 2.0 * s * c * t,
            s * s * a + c * c * b + 2.0 * s * c * t,
            s * c * (a - b) + (c * c - s * s) * t,
        ];
        let both = worst(&simulation, &moved(&simulation, turned), carried);
        assert!(both <= 1e-12 * YOUNG, "seed {seed}: {both:e} Pa");
    }
}

/// The covers are truly cut: many stars have several physical covers, some block keeps a partial cut, and the areas
/// of the elements make up the polygon.
#[test]
fn the_patches_are_cut() {
    let (mut several, mut partial) = (0, 0);
    for seed in 1..=12 {
        let simulation = cut_rock(seed);
        let covers = &simulation.model().covers;
        several += covers.covers_by_star().iter().filter(|(_, n)| *n > 1).count();
        partial += simulation.model().boundary.partial.iter().filter(|partial| **partial).count();
        // Shoelace area of the outline: 78.25 m²; element areas are sums of as many products, each with error ε·100.
        let area: f64 = covers.element_area.iter().sum();
        let outline = [[0.0, 0.0], [10.0, 1.0], [11.0, 6.0], [8.0, 9.0], [6.5, 7.0], [4.0, 9.5], [-1.0, 5.0]];
        let exact = common::claims::polygon_moments(&outline).0;
        // Snapping moves points by up to 1.5e-5 m (the default tolerance) along 40 m of outline: 1e-3 m² at the very
        // worst.
        assert!((area - exact).abs() < 1e-3, "{area} {exact}");
    }
    assert!(several > 100 && partial > 10, "{several} {partial}");
}
