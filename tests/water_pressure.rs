//! Claims: pressures of water on edges are exact, and rock that weighs as much as the water in which it lies has no
//! effective stress.

use enmm::geometry::{Point, Vector};
use enmm::internals::mechanics::pressure::{hydrostatic, inward, part, surface, under_table};

use crate::common::simulation;

#[test]
fn water_on_a_submerged_square_is_its_weight_of_water_and_turns_nothing() {
    let corners = [Point::new(1.0, 1.0), Point::new(3.0, 1.5), Point::new(2.5, 3.5), Point::new(0.5, 3.0)];
    let (mut force, mut moment) = (Vector::zeros(), 0.0);
    for k in 0..4 {
        let (a, b) = (corners[k], corners[(k + 1) % 4]);
        let [fa, fb] = hydrostatic(a, b, 10.0, 9810.0);
        force += fa + fb;
        moment += a.perp(&fa) + b.perp(&fb);
    }
    let area = 4.25;
    let centre = Point::new(1.75, 2.25);
    assert!((force - Vector::new(0.0, 9810.0 * area)).norm() < 1e-9, "{force}");
    assert!((moment - centre.x * 9810.0 * area).abs() < 1e-8, "{moment}");
}

#[test]
fn under_a_broken_line_forces_and_moments_are_those_of_a_fine_sum() {
    let table = [Point::new(-1.0, 3.0), Point::new(0.5, 2.0), Point::new(2.0, 2.5), Point::new(4.0, 0.0)];
    let edges =
        [[[-3.0, 1.0], [5.0, 1.5]], [[5.0, 0.3], [-2.0, 2.6]], [[1.0, -1.0], [1.0, 4.0]], [[0.6, 9.0], [0.7, 8.0]]];
    for [a, b] in edges.map(|ends| ends.map(Point::from)) {
        let found = under_table(a, b, &table, 0.25, 10.0);
        let (mut sum, n) = ([Vector::zeros(); 2], 200_000);
        for k in 0..n {
            let s = (f64::from(k) + 0.5) / f64::from(n);
            let p = a + (b - a) * s;
            let pressure = 10.0 * (surface(&table, p.x) + 0.25 - p.y).max(0.0) / f64::from(n);
            sum = [sum[0] + inward(a, b) * (pressure * (1.0 - s)), sum[1] + inward(a, b) * (pressure * s)];
        }
        for end in 0..2 {
            assert!((found[end] - sum[end]).norm() < 1e-7, "{a} {b}: {} of {}", found[end], sum[end]);
        }
    }
}

#[test]
fn a_level_table_and_a_level_agree() {
    let level = [Point::new(0.0, 3.0), Point::new(1.0, 3.0)];
    for [a, b] in [[[0.0, 0.0], [0.5, 5.0]], [[2.0, 4.0], [-1.0, 1.0]], [[0.0, 1.0], [3.0, 2.0]]] {
        let (a, b) = (Point::from(a), Point::from(b));
        let difference = under_table(a, b, &level, 0.5, 10.0)[0] - hydrostatic(a, b, 3.5, 10.0)[0];
        assert!(difference.norm() < 1e-12);
    }
    let normal = inward(Point::new(0.0, 0.0), Point::new(2.0, 0.0));
    assert_eq!(part(normal, [0.0, 1.0], [3.0, 9.0]).map(|f| f.y), [5.0, 7.0]);
    assert_eq!(part(normal, [0.5, 1.0], [4.0, 4.0]).map(|f| f.y), [1.0, 3.0]);
}

#[test]
fn water_on_a_wall_that_rises_above_it_acts_a_third_of_the_depth_from_the_bottom() {
    // The rock lies to the left of the way up, hence the water to the right.
    let (foot, top) = (Point::new(0.0, 0.0), Point::new(0.0, 5.0));
    let [at_foot, at_top] = hydrostatic(foot, top, 3.0, 10.0);
    assert!((at_foot.x + at_top.x + 0.5 * 10.0 * 9.0).abs() < 1e-12);
    assert!((at_top.x * 5.0 + 45.0 * 1.0).abs() < 1e-12);
    let [down_top, down_foot] = hydrostatic(top, foot, 3.0, 10.0);
    assert!((down_foot + at_foot).norm() + (down_top + at_top).norm() < 1e-12);
    assert_eq!(hydrostatic(foot, top, -1.0, 10.0), [Vector::zeros(); 2]);
}

/// A slope in soil of the density of water, below a level or the same surface as a table: what water presses on its
/// faces with, its pores take up: in the mean to a thousandth of the largest pressure, beside slivers to 3 %.
#[test]
fn soil_as_heavy_as_water_rests_below_it_without_effective_stress() {
    for (water, cohesion) in [("level = 12", 1e6), ("table = [[-5, 12], [40, 12]]", 1e6), ("level = 12", 1e4)] {
        let mut simulation = simulation(&format!(
            "title = \"afloat\"\n[domain]\noutline = [[0, 0], [32, 0], [12, 10], [0, 10]]\n[mesh]\nsize = 1.0\n\
             angle_deg = 20\n[rock.soil]\ndensity = 1000\nyoung = 100e6\npoisson = 0.3\nfriction_deg = 20\n\
             dilation_deg = 0\ncohesion = {cohesion:e}\n[water]\n{water}\n[[fix]]\nedge = [[0, 0], [32, 0]]\n\
             [[fix]]\nedge = [[0, 0], [0, 10]]\naxes = \"x\"\n[[stage]]\nname = \"settle\"\nkind = \"static\"\n\
             duration = 20\n"
        ));
        simulation.run_stage().unwrap_or_else(|e| panic!("{e}"));
        let (model, state) = (simulation.model(), simulation.state());
        let pressure = 12.0 * 1000.0 * 9.81;
        let (mut sum, mut area) = (0.0, 0.0);
        for e in model.covers.elements() {
            let stress = model.stress(state, e);
            let most = stress.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
            assert!(most < 0.03 * pressure, "{stress:?} at {}", model.covers.element_centroid[e]);
            sum += model.covers.element_area[e] * most;
            area += model.covers.element_area[e];
        }
        println!("{water}: mean {} Pa of {pressure}", sum / area);
        assert!(sum / area < 1e-3 * pressure, "{} Pa", sum / area);
        assert_eq!(simulation.yielded_elements(), 0);
    }
}
