//! A block on a plane, both of rock, whose base is shaken: the engine's side of Newmark's problems.

use std::fmt::Write;

use enmm::geometry::{Point, Vector};
use enmm::model::StepReport;

use crate::{Setup, Trouble};

/// Friction (degrees above the dip) under which the block settles.
const SETTLE: f64 = 10.0;

/// Block of 2 m × 1 m on a plane that falls to the right.
pub struct Slider<'a> {
    /// Dip (degrees).
    pub dip: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Acceleration of gravity (m/s²).
    pub gravity: f64,
    /// Young's modulus of the rock (Pa).
    pub young: f64,
    /// Acceleration of the base (m/s²), positive to the right, over time (s).
    pub base: &'a [[f64; 2]],
    /// Time of sliding (s).
    pub duration: f64,
    /// Room (m) that the block may need on either side.
    pub reach: f64,
}

/// Record of a slide.
pub struct Slide {
    /// Time (s) and way down the plane (m) of the block's centroid relative to the base.
    pub path: Vec<[f64; 2]>,
    /// Velocity down the plane (m/s) at the same times.
    pub speed: Vec<f64>,
    /// Last report.
    pub last: StepReport,
}

impl Slider<'_> {
    fn text(&self) -> String {
        let (sin, cos) = self.dip.to_radians().sin_cos();
        let turned = |[x, y]: [f64; 2]| [cos * x + sin * y, cos * y - sin * x];
        let reach = self.reach + 0.5;
        let outline = [
            [-reach, -0.8],
            [2.0 + reach, -0.8],
            [2.0 + reach, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [0.0, 1.0],
            [0.0, 0.0],
            [-reach, 0.0],
        ]
        .map(turned);
        let joint = [[0.0, 0.0], [2.0, 0.0]].map(turned);
        let base = turned([-0.2, -0.4]);
        let mut text = format!(
            "title = \"slider\"\n[domain]\noutline = {outline:?}\n[mesh]\nsize = 0.6\norigin = [0.031, 0.017]\n\
             [rock.rock]\ndensity = 2650.0\nyoung = {:e}\npoisson = 0.25\n[gravity]\ny = {}\n[[joint]]\n\
             points = {joint:?}\n[joint_law.joint]\nfriction_deg = {}\n[[fix]]\nblock = {base:?}\n[[stage]]\n\
             name = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-7\n[[stage]]\nname = \"shake\"\n\
             kind = \"dynamic\"\nduration = {}\ndamping = 0.1\n[[stage.law]]\nlaw = \"joint\"\nfriction_deg = {}\n",
            self.young,
            -self.gravity,
            (self.dip + SETTLE).max(self.friction.atan().to_degrees()),
            self.duration,
            self.friction.atan().to_degrees(),
        );
        let _ = write!(text, "[[base_motion]]\naxis = \"x\"\ntable = {:?}\n", self.base);
        text
    }

    /// Settles the block and shakes its base.
    ///
    /// # Errors
    /// The case does not fit, or the run fails.
    pub fn slide(&self, setup: &mut Setup, name: &str) -> Result<Slide, Trouble> {
        let mut simulation = setup.simulation(name, self.text())?;
        simulation.run_stage()?;
        simulation.next_stage()?;
        let (sin, cos) = self.dip.to_radians().sin_cos();
        let down = Vector::new(cos, -sin);
        let middle = Point::new(cos * 1.02 + sin * 0.48, cos * 0.48 - sin * 1.02);
        let covers = &simulation.model().covers;
        let element = covers.element_near(middle, 1e-6).ok_or_else(|| Trouble("there is no block".into()))?;
        let block = covers.element_block[element];
        let motion = |simulation: &enmm::model::Simulation| {
            let (centre, velocity, ..) = simulation.rigid_motion_of(block);
            [centre.dot(&down), velocity.dot(&down)]
        };
        let start = motion(&simulation)[0];
        let steps = simulation.steps_in(self.duration);
        let begin = simulation.time();
        let mut slide = Slide { path: vec![[0.0, 0.0]], speed: vec![0.0], last: StepReport::default() };
        for step in 0..steps {
            slide.last = simulation.advance(step + 1 == steps)?;
            let [way, speed] = motion(&simulation);
            slide.path.push([simulation.time() - begin, way - start]);
            slide.speed.push(speed);
        }
        Ok(slide)
    }
}

impl Slide {
    /// Way (m) at time `t` (s).
    pub fn way_at(&self, t: f64) -> f64 {
        let after = self.path.partition_point(|p| p[0] < t).clamp(1, self.path.len() - 1);
        let ([t0, s0], [t1, s1]) = (self.path[after - 1], self.path[after]);
        s0 + (s1 - s0) * (t - t0) / (t1 - t0)
    }

    /// Time (s) from which on the way keeps within `most` (m) of its last value.
    pub fn stop(&self, most: f64) -> f64 {
        let last = self.path.last().map_or(0.0, |p| p[1]);
        self.path.iter().rev().find(|p| (p[1] - last).abs() > most).map_or(0.0, |p| p[0])
    }

    /// Points for a plot.
    pub fn points(&self) -> Vec<[f64; 2]> {
        self.path.iter().step_by((self.path.len() / 200).max(1)).copied().collect()
    }
}
