//! Forces and moments of both distributions: along the faces that are viewed, and as a pressure on those that come in.

use enmm_patch::chain::Loads;
use enmm_patch::{Body, Contacts, Covers, Hardening, Outline, Rule, Vector};

use super::parts::{Random, points, rectangle, turned_about};

fn bodies(random: &mut Random, rule: &Rule) -> Vec<Body> {
    let upper = if random.share() < 0.5 {
        rectangle([-0.5, 0.0], [0.5, 1.0])
    } else {
        points(&[[-0.4, 0.1], [0.1, -0.1], [0.6, 0.2], [0.1, 0.9]])
    };
    let upper = turned_about(&upper, random.between(-60.0, 60.0), Vector::new(0.0, 0.5));
    let low = upper.iter().map(|point| point.y).fold(f64::INFINITY, f64::min);
    let shift = Vector::new(random.between(-2.2, 2.2), -low - random.between(0.0, 0.02));
    let upper = upper.into_iter().map(|point| point + shift).collect();
    let lower = points(&[[-2.0, -1.0], [2.0, -1.1], [2.0, 0.0], [0.4, 0.003], [0.1, -0.002], [-2.0, 0.0]]);
    [lower, upper].map(|outline| Body::new(Outline::new(outline), false, rule)).into()
}

/// Both bodies of a pair take the same force and the same moment, to round-off, and rows carry just that.
#[test]
fn action_is_reaction_and_rows_carry_all() {
    let mut random = Random::new(31);
    let mut count = 0;
    while count < 300 {
        let rule = Rule { corner: if count % 2 == 0 { 0.0 } else { 0.25 }, ..Rule::default() };
        let hardening = if count % 3 == 0 { Hardening { depth: 0.003 } } else { Hardening::NONE };
        let bodies = bodies(&mut random, &rule);
        let mut contacts = Contacts::default();
        contacts.find(&bodies, &rule, hardening);
        if contacts.energy == 0.0 {
            continue;
        }
        count += 1;
        let mut covers = Covers::default();
        covers.find(&bodies, &rule);
        let loads = Loads::of(&bodies, &covers, &rule, hardening);
        let mut sums = [[0.0; 3]; 3];
        let add = |sum: &mut [f64; 3], point: Vector, force: Vector| {
            *sum = [sum[0] + force.x, sum[1] + force.y, sum[2] + point.cross(force)];
        };
        for (body, sum) in sums.iter_mut().take(2).enumerate() {
            for (&point, &force) in bodies[body].outline.points.iter().zip(&loads.forces[body]) {
                add(sum, point, force);
            }
        }
        for row in &contacts.rows {
            assert!(row.closure >= 0.0 && row.weight > 0.0);
            let sign = if row.key.viewer == 1 { 1.0 } else { -1.0 };
            add(&mut sums[2], row.point, row.normal * (sign * row.weight * row.closure));
        }
        let size = contacts.rows.iter().map(|row| row.weight * row.closure).sum::<f64>();
        for (k, rows) in sums[2].iter().enumerate() {
            assert!((sums[0][k] + sums[1][k]).abs() < 1e-13 * size.max(0.1), "{sums:?}");
            assert!((sums[1][k] - rows).abs() < 1e-13 * size.max(0.1), "{sums:?}");
        }
        assert!((loads.energy - contacts.energy).abs() <= 1e-13 * contacts.energy.max(0.01));
    }
}

/// The energy of flat faces by hand: a block of 1 m, some depth d in a wider floor, has the area between the depths 0
/// and d, by both views: d²/2 for each; hardened, that and d⁴/(4h²). Corners have that over their length.
#[test]
fn energies_of_flat_faces_are_those_by_hand() {
    for (corner, hard) in [(0.0, f64::INFINITY), (0.0, 0.002), (0.25, 0.002)] {
        let rule = Rule { corner, ..Rule::default() };
        for depth in [1e-5, 1e-3, 5e-3] {
            let shapes = [rectangle([-9.0, -3.0], [9.0, 0.0]), rectangle([0.0, -depth], [1.0, 1.0])];
            let bodies = shapes.map(|shape| Body::new(Outline::new(shape), false, &rule));
            let mut contacts = Contacts::default();
            contacts.find(&bodies, &rule, Hardening { depth: hard });
            let column = 0.5 * depth * depth + 0.25 * depth.powi(4) / (hard * hard);
            // In the view of the block the floor lies less deep under the sides at both ends.
            let at_end = depth.powi(3) / 6.0 + 0.15 * depth.powi(5) / (hard * hard);
            let expected = 0.5 * column + 0.5 * (column - 2.0 * at_end) + 2.0 * corner * column;
            let error = (contacts.energy / expected - 1.0).abs();
            assert!(error < 1e-9, "{corner} {hard} {depth}: {error:e}");
        }
    }
}
