//! Claim C1: a block on an incline slides by s = ½g(sin a − cos a·tan φ)t², sticks where it must and stops where it
//! must.

mod common;

use common::claims::{advance, assert_ledger, dynamic, motion, rock, turn};
use common::{run_stage, simulation};
use enmm::geometry::Vector;
use enmm::model::Simulation;

const G: f64 = 9.81;

/// A block 1 m high and 1 m long (2 m on planes of 44° and more, where a square topples) on a plane that falls to the
/// right at `slope` (degrees); it settles under a friction 5° above the slope, and then has `friction` (degrees).
struct Incline {
    slope: f64,
    friction: f64,
    young: f64,
    size: f64,
    length: f64,
    seconds: f64,
    extra: &'static str,
}

/// Middle of the block before and after turning: coordinates are turned in floating point, so that they lie on a line.
fn middle(slope: f64) -> [f64; 2] {
    turn(&[[0.52, 0.48]], -slope)[0]
}

impl Incline {
    fn build(&self) -> Simulation {
        let (end, long) = (self.length, if self.slope < 44.0 { 1.0 } else { 2.0 });
        let outline = turn(
            &[[-1.0, -0.8], [end, -0.8], [end, 0.0], [long, 0.0], [long, 1.0], [0.0, 1.0], [0.0, 0.0], [-1.0, 0.0]],
            -self.slope,
        );
        let joint = turn(&[[0.0, 0.0], [long, 0.0]], -self.slope);
        let base = turn(&[[-0.5, -0.4]], -self.slope)[0];
        let hold = self.slope + 5.0;
        simulation(&format!(
            "title = \"incline\"\n[domain]\noutline = {outline:?}\n[mesh]\nsize = {}\norigin = [0.031, 0.017]\n\
             [[joint]]\npoints = {joint:?}\n[joint_law.joint]\nfriction_deg = {hold}\n[[fix]]\nblock = {base:?}\n{}\
             [[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-7\n{}\
             [[stage.law]]\nlaw = \"joint\"\nfriction_deg = {}\n{}",
            self.size,
            rock(self.young, 2650.0),
            dynamic("slide", self.seconds, 0.1),
            self.friction,
            self.extra
        ))
    }

    /// Settles the block, drops the friction, and gives the block a velocity (m/s) down the plane.
    fn release(&self, speed: f64) -> Simulation {
        let mut simulation = self.build();
        run_stage(&mut simulation);
        assert!(simulation.next_stage().expect("a stage"));
        if speed != 0.0 {
            let mut state = simulation.state().clone();
            let block = common::claims::block_at(&simulation, middle(self.slope));
            let kick = self.down() * speed;
            simulation.model().covers.covers_of(block).for_each(|i| state.velocity[i] += kick);
            let mass = simulation.model().mass_matrix.total[block];
            state.ledger.baseline += 0.5 * mass * speed * speed;
            simulation.restore(state);
        }
        simulation
    }

    fn down(&self) -> Vector {
        let (s, c) = self.slope.to_radians().sin_cos();
        Vector::new(c, -s)
    }

    fn acceleration(&self) -> f64 {
        let (s, c) = self.slope.to_radians().sin_cos();
        G * (s - c * self.friction.to_radians().tan()).max(0.0)
    }

    fn along(&self, simulation: &Simulation) -> f64 {
        let (centre, ..) = motion(simulation, middle(self.slope));
        let out = Vector::new(-self.down().y, self.down().x);
        assert!(centre.dot(&out) > 0.0 && centre.dot(&out) < 0.6, "the block has left the plane");
        centre.dot(&self.down())
    }
}

/// The published values at t = 1 s, recomputed: a = 30° and 45°.
///
/// Coulomb's limit holds at the end of each step, so that friction is exactly N·tan φ and the impulse of N is the
/// weight's (theory §11): the acceleration errs by 1e-5 (the block turns a little as its shear is set free). What
/// remains is the elastic answer to the drop of strength, during which N swings: an offset of velocity of some σ/√(Eρ)
/// with σ = 20 kPa, 2e-3 times a few per cent = 6e-5 m/s as measured. Against way in 1 s that is below 1e-4 for φ up
/// to 25° at a = 30°, and 3e-4 at 28°, where only 0.19 m are covered.
#[test]
fn a_stiff_block_slides_by_half_a_t_squared() {
    let mut rows = vec![(30.0, 28.0, 0.193876), (23.7, 11.3, f64::NAN), (52.0, 18.0, f64::NAN)];
    rows.extend([(30.0, 0.0, 2.4525), (30.0, 10.0, 1.703489), (30.0, 15.0, 1.314291), (30.0, 20.0, 0.906407)]);
    rows.extend([(30.0, 25.0, 0.471693), (45.0, 10.0, 2.856794), (45.0, 20.0, 2.205979), (45.0, 30.0, 1.465901)]);
    for (slope, friction, published) in rows {
        let incline = Incline { slope, friction, young: 50e9, size: 0.6, length: 6.0, seconds: 1.0, extra: "" };
        let exact = 0.5 * incline.acceleration();
        assert!(published.is_nan() || (exact - published).abs() < 1e-6, "{exact}");
        let mut simulation = incline.release(0.0);
        let start = incline.along(&simulation);
        let steps = simulation.steps_in(1.0);
        let report = advance(&mut simulation, steps);
        let t = steps as f64 * simulation.model().dt;
        let error = (incline.along(&simulation) - start) / (exact * t * t) - 1.0;
        println!("a {slope} phi {friction}: {error:e}");
        let tolerance = if slope - friction < 3.0 { 5e-4 } else { 1e-4 };
        assert!(error.abs() < tolerance, "a = {slope}, φ = {friction}: relative error {error:e}");
        assert_ledger(&report);
    }
}

/// In a soft rock (1 GPa) the ringing of the drop offsets the velocity, but not the acceleration: ½a(t₂−t₁)² is what
/// the second difference of three places 0.4 s apart gives.
#[test]
fn a_soft_block_has_the_right_acceleration() {
    for (slope, friction) in [(30.0, 10.0), (30.0, 20.0), (37.0, 24.0)] {
        let incline = Incline { slope, friction, young: 1e9, size: 0.5, length: 6.0, seconds: 1.0, extra: "" };
        let mut simulation = incline.release(0.0);
        let mut places = Vec::new();
        let mut span = 0.0;
        for seconds in [0.2, 0.4, 0.4] {
            let steps = simulation.steps_in(seconds);
            span = steps as f64 * simulation.model().dt;
            advance(&mut simulation, steps);
            places.push(incline.along(&simulation));
        }
        let acceleration = (places[2] - 2.0 * places[1] + places[0]) / (span * span);
        let error = acceleration / incline.acceleration() - 1.0;
        println!("a {slope} phi {friction}: {error:e}");
        assert!(error.abs() < 1e-4, "a = {slope}, φ = {friction}: relative error {error:e}");
    }
}

/// s(2 s) = 4·s(1 s) for constant acceleration from rest; same tolerance as above.
#[test]
fn the_way_grows_with_the_square_of_time() {
    let incline = Incline { slope: 30.0, friction: 15.0, young: 50e9, size: 0.6, length: 9.0, seconds: 2.0, extra: "" };
    let mut simulation = incline.release(0.0);
    let start = incline.along(&simulation);
    let steps = simulation.steps_in(1.0);
    advance(&mut simulation, steps);
    let first = incline.along(&simulation) - start;
    advance(&mut simulation, steps);
    let second = incline.along(&simulation) - start;
    assert!((second / first / 4.0 - 1.0).abs() < 1e-4, "{first} {second}");
}

/// A block that must stick moves by the elastic take-up τ/k_t once (theory §11: with k_t = ¼E_c/h and 1.2 E for E_c,
/// some 13 kPa/0.3·h/E), and then not at all: 1e-8 m of creep in 60 s is the claim, 1e-9 of the block's size.
#[test]
fn a_block_below_the_limit_stays_for_60_seconds() {
    for (slope, friction, young) in [(30.0, 31.0, 50e6), (30.0, 35.0, 1e9), (20.0, 20.5, 200e6), (45.0, 46.0, 50e6)] {
        let incline = Incline { slope, friction, young, size: 1.0, length: 3.0, seconds: 60.0, extra: "" };
        let mut simulation = incline.release(0.0);
        let start = incline.along(&simulation);
        let steps = simulation.steps_in(1.0);
        advance(&mut simulation, steps);
        let first = incline.along(&simulation);
        let report = advance(&mut simulation, steps * 59);
        let creep = incline.along(&simulation) - first;
        println!("a {slope} phi {friction}: take-up {:e}, creep {creep:e}", first - start);
        // The settled block already bears its shear under the higher friction: no take-up beyond that of a few kPa.
        assert!((first - start).abs() < 26e3 / (0.3 * young), "take-up {:e}", first - start);
        assert!(creep.abs() < 1e-8, "a = {slope}, φ = {friction}: creep {creep:e} m");
        assert_ledger(&report);
    }
}

/// v0 = 2 m/s on a = 20° with φ = 30° stops after v0/|a| = 1.016767 s and v0²/2|a| = 1.016767 m, and stays; other
/// speeds and angles likewise. The start excites the block by the friction that sets in: an offset as above.
#[test]
fn a_block_that_is_pushed_stops_where_it_must() {
    for (slope, friction, speed) in [(20.0, 30.0, 2.0), (10.0, 25.0, 1.5), (0.0, 20.0, 2.5)] {
        let incline = Incline { slope, friction, young: 50e9, size: 0.6, length: 6.0, seconds: 3.0, extra: "" };
        let (s, c) = f64::to_radians(slope).sin_cos();
        let brake = G * (c * f64::to_radians(friction).tan() - s);
        let (stop, way) = (speed / brake, 0.5 * speed * speed / brake);
        assert!(slope != 20.0 || ((stop - 1.016767).abs() < 1e-6 && (way - 1.016767).abs() < 1e-6));
        let mut simulation = incline.release(speed);
        let start = incline.along(&simulation);
        let mut stopped = None;
        let steps = simulation.steps_in(stop + 1.0);
        for _ in 0..steps / 20 {
            let report = advance(&mut simulation, 20);
            if stopped.is_none() && report.locked > 0 && report.slipping == 0 {
                stopped = Some(report.time - simulation.state().stage_start);
            }
        }
        let found = incline.along(&simulation) - start;
        let at = stopped.expect("it stops");
        println!("a {slope} phi {friction}: {at} of {stop}, {found} of {way}");
        assert!((found / way - 1.0).abs() < 2e-4, "{found} of {way} m");
        assert!((at / stop - 1.0).abs() < 1e-2, "{at} of {stop} s");
        let report = advance(&mut simulation, 2000);
        assert!((incline.along(&simulation) - start - found).abs() < 1e-8, "it stays");
        assert_ledger(&report);
    }
}
