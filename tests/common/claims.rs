//! What the claim tests share beyond runs: case text, exact polygons, ledgers.

use enmm::cover::BlockId;
use enmm::geometry::{Point, Vector};
use enmm::mechanics::Deformation;
use enmm::model::Simulation;
use enmm::state::State;
use enmm::step::{StepReport, block_motion};

/// A corner list as a case writes it.
pub type Corners = Vec<[f64; 2]>;

/// A rock of plane strain with ν = 0.25 and this Young's modulus (Pa) and density (kg/m³).
pub fn rock(young: f64, density: f64) -> String {
    format!("[rock.rock]\ndensity = {density:e}\nyoung = {young:e}\npoisson = 0.25\n")
}

/// A dynamic stage without changes.
pub fn dynamic(name: &str, duration: f64, damping: f64) -> String {
    format!("[[stage]]\nname = \"{name}\"\nkind = \"dynamic\"\nduration = {duration:e}\ndamping = {damping:e}\n")
}

/// Points turned by an angle (degrees) about the origin.
pub fn turn(points: &[[f64; 2]], degrees: f64) -> Corners {
    let (s, c) = degrees.to_radians().sin_cos();
    points.iter().map(|p| [c * p[0] - s * p[1], s * p[0] + c * p[1]]).collect()
}

/// Area, centroid and polar moment of area about the centroid of a polygon, by Green's theorem, independent of the
/// engine.
pub fn polygon_moments(points: &[[f64; 2]]) -> (f64, [f64; 2], f64) {
    let n = points.len();
    let (mut a, mut x, mut y, mut j) = (0.0, 0.0, 0.0, 0.0);
    let o = points[0];
    for k in 0..n {
        let p = [points[k][0] - o[0], points[k][1] - o[1]];
        let q = [points[(k + 1) % n][0] - o[0], points[(k + 1) % n][1] - o[1]];
        let c = p[0] * q[1] - p[1] * q[0];
        a += c / 2.0;
        x += c * (p[0] + q[0]) / 6.0;
        y += c * (p[1] + q[1]) / 6.0;
        j += c * (p[0] * p[0] + p[0] * q[0] + q[0] * q[0] + p[1] * p[1] + p[1] * q[1] + q[1] * q[1]) / 12.0;
    }
    (a, [o[0] + x / a, o[1] + y / a], j - (x * x + y * y) / a)
}

/// Small reproducible numbers in 0..1.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Claim A4: the energy ledger closes to 1e-3 of its largest term.
///
/// The residual of a swinging mode is ½(ω dt)² of its energy (theory Eq. 28), hence small against 1e-3 of the largest
/// term in slides, falls and damped motion.
pub fn assert_ledger(report: &StepReport) {
    let ledger = &report.ledger;
    assert!(
        ledger.residual().abs() <= 1e-3 * ledger.largest(),
        "residual {:e} of {:e}: {ledger:?}",
        ledger.residual(),
        ledger.largest()
    );
}

/// Stress xx, yy, xy of every element under the displacements of a state.
pub fn stresses(simulation: &Simulation, state: &State) -> Vec<[f64; 3]> {
    let slope = simulation.model();
    let covers = &slope.covers;
    (0..covers.element_count())
        .map(|e| {
            let u = covers.element_covers[e].map(|i| state.displacement[i]);
            let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
            let rock = &slope.rocks[slope.element_rock[e] as usize];
            Deformation::new(u, gradients).stress(rock, &[0.0; 3])
        })
        .collect()
}

/// Centroid (m), its velocity (m/s), spin (rad/s) and kinetic energy (J/m) of the block that holds a reference point.
pub fn motion(simulation: &Simulation, point: [f64; 2]) -> (Point, Vector, f64, f64) {
    let block = block_at(simulation, point);
    block_motion(simulation.model(), simulation.state(), &simulation.workspace().mass_matrix, block)
}

/// The block that holds a reference point.
pub fn block_at(simulation: &Simulation, point: [f64; 2]) -> BlockId {
    let covers = &simulation.model().covers;
    let element = covers.element_at(Point::from(point)).expect("rock at the point");
    covers.element_block[element]
}

/// Advances the stage in progress by a number of steps; returns the report of the last one.
pub fn advance(simulation: &mut Simulation, steps: u64) -> StepReport {
    for _ in 1..steps {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
    }
    simulation.advance(true).unwrap_or_else(|e| panic!("{e}"))
}
