//! A block on a plane that gravity begins to pull on: what C6 and C7 share.
//!
//! Gravity grows from nothing within a short time, so that no wave shakes the block when it is let go. All forces
//! grow together: the ratio of shear to normal force, hence the kind of motion, is that of full gravity from the start.

use enmm::geometry::Vector;
use enmm::model::{Simulation, StepReport};

use crate::parts::turn_radians as turn;
use crate::{Setup, Trouble};

/// Acceleration of gravity (m/s²).
pub const G: f64 = 9.81;

/// Density of the blocks (kg/m³).
pub const DENSITY: f64 = 2500.0;

/// A block on a plane.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Width of the base (m).
    pub base: f64,
    /// Height (m).
    pub height: f64,
    /// Dip of the plane (rad), downhill to the right.
    pub dip: f64,
    /// Angle (rad) by which the block is turned downhill about its lower right corner at the start.
    pub tilt: f64,
    /// Friction angle (degrees).
    pub friction_deg: f64,
    /// Young's modulus (Pa); ν is 0.25 and the density [`DENSITY`].
    pub young: f64,
    /// Side of the mesh (m).
    pub mesh: f64,
    /// Horizontal acceleration (m/s²) that the rock feels, to the right.
    pub horizontal: f64,
    /// Time (s) over which gravity grows.
    pub ramp: f64,
}

/// Motion of a block on an incline.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fate {
    /// Time (s).
    pub time: f64,
    /// Turn downhill since the start (rad).
    pub turned: f64,
    /// Angular velocity downhill (rad/s).
    pub spin: f64,
    /// Velocity of the lower right corner down the plane (m/s).
    pub slides: f64,
}

impl Block {
    /// An upright block of these sides (m) on a level plane without friction, of the stiffness and mesh that problems
    /// share; gravity grows within `ramp` (in √(h/g)).
    pub fn level(setup: &Setup, [base, height]: [f64; 2], ramp: f64) -> Self {
        Self {
            base,
            height,
            dip: 0.0,
            tilt: 0.0,
            friction_deg: 0.0,
            young: setup.get("stiffness") * DENSITY * G * height,
            mesh: setup.get("mesh") * height,
            horizontal: 0.0,
            ramp: ramp * (height / G).sqrt(),
        }
    }

    /// The case of the block on its plane.
    pub fn case(&self, duration: f64) -> String {
        let Self { base: b, height: h, dip, .. } = *self;
        let plane = [[-3.0 * h, -0.6 * h], [4.0 * h + b, -0.6 * h], [4.0 * h + b, 0.0], [-3.0 * h, 0.0]];
        let about_toe: Vec<[f64; 2]> = turn(&self.corners(), -self.tilt).iter().map(|p| [p[0] + b, p[1]]).collect();
        let [toe, head] = [2, 3].map(|k| turn(&about_toe, -dip)[k]);
        let middle = turn(&[[-0.5 * h, -0.3 * h]], -dip)[0];
        // A point of the block, not of the plane below it.
        let inside = [0, 1].map(|k| toe[k] + 1e-4 * (turn(&about_toe, -dip)[0][k] - toe[k]));
        let pull = [self.horizontal, -G];
        // Gravity grows in a time in which delayed friction would lag.
        format!(
            "title = \"Block on a plane\"\n[domain]\noutline = {:?}\nislands = [{:?}]\n[mesh]\nsize = {}\n\
             origin = [{}, {}]\n[joint_law.joint]\nfriction_deg = {}\n[rock.rock]\n\
             density = {DENSITY:?}\nyoung = {:e}\n\
             poisson = 0.25\n[gravity]\ny = 0.0\n[[load]]\nkind = \"body\"\nacceleration = {pull:?}\n\
             table = [[0.0, 0.0], [{:e}, 1.0]]\n[[fix]]\nblock = {middle:?}\n[[stage]]\nname = \"free\"\n\
             kind = \"dynamic\"\nduration = {duration:e}\ndamping = 0.1\n[[monitor]]\nname = \"toe\"\n\
             point = {inside:?}\n[[monitor]]\nname = \"head\"\npoint = {head:?}\n\
             [solver]\nfriction_delay = 0.0\n",
            turn(&plane, -dip),
            turn(&about_toe, -dip),
            self.mesh,
            0.031 * h,
            0.017 * h,
            self.friction_deg,
            self.young,
            self.ramp,
        )
    }

    /// Corners about the lower right one, counter-clockwise from the upper left: head left, foot left, toe, head right.
    fn corners(&self) -> [[f64; 2]; 4] {
        [[-self.base, self.height], [-self.base, 0.0], [0.0, 0.0], [0.0, self.height]]
    }

    /// Builds the model of the block.
    ///
    /// # Errors
    /// A case that cannot be built.
    pub fn build(&self, setup: &mut Setup, name: &str, duration: f64) -> Result<Simulation, Trouble> {
        setup.simulation(name, self.case(duration))
    }

    /// Motion of the block until now.
    pub fn fate(&self, simulation: &Simulation) -> Fate {
        let (s, c) = self.dip.sin_cos();
        let down = Vector::new(c, -s);
        let upright = Vector::new((self.dip + self.tilt).sin(), (self.dip + self.tilt).cos()) * self.height;
        let across = Vector::new(upright.y, -upright.x) / self.height;
        let [toe, head] = [0, 1].map(|k| simulation.monitor(k));
        let side = upright + head.0 - toe.0;
        let turned = side.dot(&across).atan2(side.dot(&upright) / self.height);
        let (slope, element) = (simulation.model(), simulation.built().monitors.points[1].0);
        let block = slope.covers.element_block[element];
        // Counter-clockwise is uphill.
        let spin = -simulation.rigid_motion_of(block).2;
        Fate { time: simulation.time(), turned, spin, slides: toe.1.dot(&down) }
    }
}

/// Advances to a time (s) or until `over` says so; returns the last report.
///
/// # Errors
/// A numerical failure.
pub fn advance(
    simulation: &mut Simulation,
    time: f64,
    mut over: impl FnMut(&Simulation) -> bool,
) -> Result<StepReport, Trouble> {
    while simulation.time() + 0.5 * simulation.model().dt < time {
        simulation.advance(false)?;
        if over(simulation) {
            break;
        }
    }
    Ok(simulation.report())
}

/// The place between `low`, where `below` holds, and `high`, where it does not, to `width`.
///
/// # Errors
/// That of `below`, or that one of the ends is on the wrong side.
pub fn bisect(
    [mut low, mut high]: [f64; 2],
    width: f64,
    mut below: impl FnMut(f64) -> Result<bool, Trouble>,
) -> Result<f64, Trouble> {
    for (end, expected) in [(low, true), (high, false)] {
        if below(end)? != expected {
            return Err(Trouble(format!("no limit between {low} and {high}: both are on one side")));
        }
    }
    while high - low > width {
        let middle = 0.5 * (low + high);
        if below(middle)? { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bisection_finds_a_limit_and_says_when_there_is_none() {
        let found = bisect([0.0, 1.0], 1e-6, |x| Ok(x < 0.3)).expect("a limit");
        assert!((found - 0.3).abs() < 1e-6);
        assert!(bisect([0.4, 1.0], 1e-6, |x| Ok(x < 0.3)).is_err());
    }
}
