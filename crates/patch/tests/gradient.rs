//! The force of contact is minus the gradient of its energy: by central differences, at random places.

use enmm_patch::chain::Loads;
use enmm_patch::{Body, Contacts, Covers, Hardening, Outline, Rule, Vector};

use super::parts::{Random, area_and_centre, points, rectangle, turned_about};

const STEP: f64 = 1e-7;
/// Greatest difference of a force from the gradient, over the force.
const LIMIT: f64 = 1e-7;

struct Place {
    rule: Rule,
    hardening: Hardening,
    bodies: [Body; 2],
    shape: Vec<Vector>,
    centre: Vector,
    turn: f64,
}

impl Place {
    fn put(&mut self) -> Contacts {
        let (_, own) = area_and_centre(&self.shape);
        let moved = turned_about(&self.shape, self.turn.to_degrees(), own);
        let centre = self.centre;
        self.bodies[1].move_rigidly(moved.into_iter().map(|point| point - own + centre));
        let mut contacts = Contacts::default();
        contacts.find(&self.bodies, &self.rule, self.hardening);
        contacts
    }

    /// Force and moment on the upper body, over the stiffness.
    fn force(&mut self) -> [f64; 3] {
        let contacts = self.put();
        let mut sum = [0.0; 3];
        for row in &contacts.rows {
            let sign = if row.key.viewer == 1 { 1.0 } else { -1.0 };
            let force = row.normal * (sign * row.weight * row.closure);
            let moment = (row.point - self.centre).cross(force);
            sum = [sum[0] + force.x, sum[1] + force.y, sum[2] + moment];
        }
        sum
    }

    fn gradient(&mut self) -> [f64; 3] {
        let mut change = |x: f64, y: f64, turn: f64| {
            let (centre, old) = (self.centre, self.turn);
            (self.centre, self.turn) = (centre + Vector::new(x, y), old + turn);
            let energy = self.put().energy;
            (self.centre, self.turn) = (centre, old);
            energy
        };
        let axes = [[STEP, 0.0, 0.0], [0.0, STEP, 0.0], [0.0, 0.0, STEP]];
        axes.map(|[x, y, turn]| (change(-x, -y, -turn) - change(x, y, turn)) / (2.0 * STEP))
    }
}

/// Worst differences over the force at random places of two shapes, and the number of places.
fn worst_of(shapes: [&[Vector]; 2], rule: Rule, hardening: Hardening, seed: u64, places: usize) -> (f64, usize) {
    let mut random = Random::new(seed);
    let (mut worst, mut count) = (0.0f64, 0);
    for _ in 0..places {
        let bodies = shapes.map(|shape| Body::new(Outline::new(shape.to_vec()), false, &rule));
        let (centre, turn) = (Vector::new(random.between(-1.7, 1.7), 2.0), random.between(-0.8, 0.8));
        let mut place = Place { rule, hardening, bodies, shape: shapes[1].to_vec(), centre, turn };
        while place.put().energy < 1e-12 && place.centre.y > -1.0 {
            place.centre.y -= 0.002;
        }
        place.centre.y -= random.between(0.0, 0.004);
        if place.put().energy == 0.0 {
            continue;
        }
        let (force, gradient) = (place.force(), place.gradient());
        let size = force[0].hypot(force[1]).max(1e-6);
        worst = (0..3).map(|k| (force[k] - gradient[k]).abs() / size).fold(worst, f64::max);
        count += 1;
    }
    (worst, count)
}

/// Flat faces, tips on flanks, corners on corners, short faces at blunted corners and notches.
#[test]
fn forces_of_rigid_bodies_are_the_gradient_of_the_energy() {
    let [floor, square] = [rectangle([-2.0, -1.0], [2.0, 0.0]), rectangle([-0.5, 0.0], [0.5, 1.0])];
    let [low, kite] = [
        points(&[[-1.0, -1.0], [1.2, -0.9], [0.6, 0.0], [-0.7, 0.05]]),
        points(&[[-0.4, 0.1], [0.1, -0.1], [0.6, 0.2], [0.1, 0.9]]),
    ];
    let blunted = points(&[[-2.0, -1.0], [2.0, -1.0], [2.0, -0.004], [1.997, -0.001], [1.99, 0.0], [-2.0, 0.0]]);
    let notched = points(&[
        [-1.8, -1.0],
        [1.8, -1.0],
        [1.8, 0.0],
        [0.6, 0.02],
        [0.3, -0.3],
        [-0.2, -0.32],
        [-0.5, 0.0],
        [-1.8, 0.03],
    ]);
    let mut total = 0;
    for (k, shapes) in [[&floor, &square], [&low, &kite], [&blunted, &square], [&notched, &kite]].iter().enumerate() {
        for (j, (corner, depth)) in
            [(0.0, f64::INFINITY), (0.3, f64::INFINITY), (0.0, 0.003), (0.3, 0.003)].iter().enumerate()
        {
            let rule = Rule { corner: *corner, ..Rule::default() };
            let seed = (10 * k + j) as u64 + 1;
            let shapes = shapes.map(|shape| shape.as_slice());
            let (worst, count) = worst_of(shapes, rule, Hardening { depth: *depth }, seed, 30);
            println!("shapes {k}, corner {corner}, hardens {depth}: {count} places, worst {worst:.1e}");
            assert!(worst < LIMIT, "{worst:e}");
            total += count;
        }
    }
    assert!(total >= 300, "{total} places");
}

/// A chain along x with points that lie off the line, as a body below it or above it.
fn rough(random: &mut Random, faces: usize, height: f64, is_above: bool) -> Vec<Vector> {
    let mut along: Vec<f64> = (1..faces).map(|k| (k as f64 + random.between(-0.3, 0.3)) / faces as f64).collect();
    along.insert(0, 0.0);
    along.push(1.0);
    let mut chain: Vec<Vector> = along.iter().map(|x| Vector::new(*x, random.between(-height, height))).collect();
    let far = if is_above { 0.7 } else { -0.7 };
    if !is_above {
        chain.reverse();
    }
    let (last, first) = (chain[chain.len() - 1], chain[0]);
    chain.extend([Vector::new(last.x, far), Vector::new(first.x, far)]);
    chain
}

/// Chains with kinks to both sides: the force on every one of their points.
#[test]
fn forces_on_the_points_of_chains_are_the_gradient_of_the_energy() {
    let mut random = Random::new(77);
    let (mut places, mut worst, mut reflex) = (0, 0.0f64, 0);
    while places < 300 {
        let rule = Rule { corner: if places % 2 == 0 { 0.0 } else { 0.1 }, corner_turn: 0.3, ..Rule::default() };
        let hardening = if places % 3 == 2 { Hardening { depth: 0.004 } } else { Hardening::NONE };
        let faces = 3 + (random.share() * 9.0) as usize;
        let shift = Vector::new(random.between(-0.3, 0.3), random.between(-0.004, 0.002));
        let mut chains = [rough(&mut random, faces, 0.004, false), rough(&mut random, faces + 1, 0.004, true)];
        chains[1].iter_mut().for_each(|point| *point += shift);
        let loads = |chains: &[Vec<Vector>; 2]| {
            let bodies: Vec<Body> =
                chains.iter().map(|points| Body::new(Outline::new(points.clone()), false, &rule)).collect();
            let mut covers = Covers::default();
            covers.find(&bodies, &rule);
            reflex += (0..bodies[0].outline.len()).filter(|&k| bodies[0].turn(k) < -1e-3).count();
            Loads::of(&bodies, &covers, &rule, hardening)
        };
        let mut loads = loads;
        let Loads { energy, forces } = loads(&chains);
        if energy < 1e-9 {
            continue;
        }
        let size: f64 = forces[0].iter().map(|force| force.norm()).sum();
        for body in 0..2 {
            let point = (random.share() * chains[body].len() as f64) as usize;
            for axis in [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)] {
                let mut at = |way: f64| {
                    let old = chains[body][point];
                    chains[body][point] = old + axis * way;
                    let energy = loads(&chains).energy;
                    chains[body][point] = old;
                    energy
                };
                let gradient = (at(-STEP) - at(STEP)) / (2.0 * STEP);
                worst = worst.max((forces[body][point].dot(axis) - gradient).abs() / size);
            }
        }
        places += 1;
    }
    println!("chains: {places} places, {reflex} reflex kinks seen, worst {worst:.1e}");
    assert!(worst < LIMIT, "{worst:e}");
    assert!(reflex > 1000);
}
