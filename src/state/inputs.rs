//! Inputs that a host gives a model while it runs, and their course through a communication step.

use serde::{Deserialize, Serialize};

use crate::cover::BlockId;
use crate::geometry::Vector;

use super::{Model, PortKind};

/// One of the inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Input {
    /// Gravity.
    Gravity,
    /// Acceleration of the base.
    BaseAcceleration,
    /// Height of the water.
    WaterLevel,
    /// Factor on the strength of joints.
    StrengthFactor,
    /// Force and moment of a block.
    Block(u32),
    /// Traction, pressure or velocity of a port.
    Port(u32),
    /// Level of a head.
    Head(u32),
    /// Rate of rain.
    Rain(u32),
    /// Whether a drain acts.
    Drain(u32),
}

/// Values that a host sets; each holds until it is set again.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Acceleration of gravity (m/s²).
    pub gravity: Vector,
    /// Acceleration of the base (m/s²); the model lives in the frame of the base, so rock feels the opposite.
    pub base_acceleration: Vector,
    /// Height y of the free water surface (m).
    pub water_level: f64,
    /// Factor on cohesion, tan φ and tensile strength of all joints.
    pub strength_factor: f64,
    /// Force through the centroid of each block (N/m).
    pub block_force: Vec<Vector>,
    /// Moment about the centroid of each block (N·m/m, counter-clockwise).
    pub block_moment: Vec<f64>,
    /// Traction on the boundary of each port (Pa, global axes, per reference length).
    pub port_traction: Vec<Vector>,
    /// Fluid pressure on the faces of each port (Pa), pushing into the rock.
    pub port_pressure: Vec<f64>,
    /// Particle velocity (m/s) of the wave that comes in through each quiet boundary, or velocity of each fixity that
    /// is moved.
    pub port_velocity: Vec<Vector>,
    /// Level (m) of each head of water in joints.
    pub head: Vec<f64>,
    /// Rate (m/s) of each rain.
    pub rain: Vec<f64>,
    /// Whether each drain acts; a switch that goes over at once.
    pub drain: Vec<bool>,
}

clone_without_allocating! {
    Inputs {
        gravity base_acceleration water_level strength_factor block_force block_moment port_traction port_pressure
        port_velocity head rain drain
    }
}

impl Inputs {
    /// Takes over one input of others.
    pub fn take_over(&mut self, input: Input, others: &Inputs) {
        match input {
            Input::Gravity => self.gravity = others.gravity,
            Input::BaseAcceleration => self.base_acceleration = others.base_acceleration,
            Input::WaterLevel => self.water_level = others.water_level,
            Input::StrengthFactor => self.strength_factor = others.strength_factor,
            Input::Block(block) => {
                let block = block as usize;
                self.block_force[block] = others.block_force[block];
                self.block_moment[block] = others.block_moment[block];
            }
            Input::Port(port) => {
                let port = port as usize;
                self.port_traction[port] = others.port_traction[port];
                self.port_pressure[port] = others.port_pressure[port];
                self.port_velocity[port] = others.port_velocity[port];
            }
            Input::Head(head) => self.head[head as usize] = others.head[head as usize],
            Input::Rain(rain) => self.rain[rain as usize] = others.rain[rain as usize],
            Input::Drain(drain) => self.drain[drain as usize] = others.drain[drain as usize],
        }
    }

    /// The values that the case starts with.
    pub fn of(model: &Model) -> Self {
        let (blocks, ports) = (model.covers.block_count(), model.ports.len());
        let flow = model.flow.as_ref();
        let mut inputs = Self {
            gravity: model.gravity,
            base_acceleration: Vector::zeros(),
            water_level: model.water.as_ref().map_or(0.0, |water| water.surfaces[0].level),
            strength_factor: 1.0,
            block_force: vec![Vector::zeros(); blocks],
            block_moment: vec![0.0; blocks],
            port_traction: vec![Vector::zeros(); ports],
            port_pressure: vec![0.0; ports],
            port_velocity: vec![Vector::zeros(); ports],
            head: flow.iter().flat_map(|net| &net.heads).map(|head| head.levels[0]).collect(),
            rain: flow.iter().flat_map(|net| &net.rains).map(|rain| rain.rates[0]).collect(),
            drain: flow.iter().flat_map(|net| &net.drains).map(|drain| drain.active[0]).collect(),
        };
        for (k, port) in model.ports.iter().enumerate() {
            match port.kind {
                PortKind::Block => {
                    inputs.block_force[port.block] += port.force;
                    inputs.block_moment[port.block] += port.scalar;
                }
                PortKind::Boundary | PortKind::Joint => {
                    (inputs.port_traction[k], inputs.port_pressure[k]) = (port.force, port.scalar);
                }
                PortKind::Quiet | PortKind::Fix => {}
            }
        }
        inputs
    }
}

/// Inputs over one communication step: from one set of values to the next, linear in between.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Values at `since`.
    pub from: Inputs,
    /// Values at and after `until`.
    pub to: Inputs,
    /// Start of the change (s).
    pub since: f64,
    /// End of the change (s); at or before `since` for a jump.
    pub until: f64,
    /// The course of the velocities of ports before `since`.
    pub before: Course,
    /// Displacement (m) by which a host has moved the fixity of each port.
    pub moved: Vec<Vector>,
}

clone_without_allocating!(Drive { from to since until before moved });

/// The last way of the velocities of ports: forces act for a kick that begins before a change of the inputs.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// When it ended (s).
    pub end: f64,
    /// Rate (m/s²) of each velocity until then.
    pub rate: Vec<Vector>,
}

clone_without_allocating!(Course { end rate });

impl Drive {
    /// Inputs that hold for ever.
    pub fn hold(inputs: Inputs) -> Self {
        let ports = vec![Vector::zeros(); inputs.port_velocity.len()];
        let before = Course { end: 0.0, rate: ports.clone() };
        Self { from: inputs.clone(), to: inputs, since: 0.0, until: 0.0, before, moved: ports }
    }

    /// Share of the way at time `t` (s).
    pub fn share(&self, t: f64) -> f64 {
        if t >= self.until { 1.0 } else { ((t - self.since) / (self.until - self.since)).max(0.0) }
    }

    /// Whether the values change in time.
    pub fn is_moving(&self) -> bool {
        self.until > self.since
    }

    /// Ends the change at once: the values are those of `to`.
    pub fn arrive(&mut self) {
        self.end_way(self.until);
        self.from.clone_from(&self.to);
        self.until = self.since;
    }

    /// Makes the values those of `to` as if they had always been so.
    pub fn jump(&mut self) {
        self.from.clone_from(&self.to);
        self.until = self.since;
        self.before.rate.fill(Vector::zeros());
    }

    /// Makes one of the values that of `to` as if it had always been so.
    pub fn jump_of(&mut self, input: Input) {
        self.from.take_over(input, &self.to);
        if let Input::Port(port) = input {
            self.before.rate[port as usize] = Vector::zeros();
        }
    }

    /// Notes the rates of velocities on a way that ends at a time (s).
    fn end_way(&mut self, end: f64) {
        if self.is_moving() {
            let over = 1.0 / (self.until - self.since);
            let ways = self.to.port_velocity.iter().zip(&self.from.port_velocity);
            self.before.rate.iter_mut().zip(ways).for_each(|(rate, (to, from))| *rate = (to - from) * over);
            self.before.end = end;
        }
    }

    /// Takes back a jump that has not acted yet.
    pub fn hold_last(&mut self) {
        if !self.is_moving() {
            self.to.clone_from(&self.from);
        }
    }

    /// Makes the values at time `t` (s) the start of what is left of the way.
    pub fn pass(&mut self, t: f64) {
        let share = self.share(t);
        self.end_way(t);
        let (from, to) = (&mut self.from, &self.to);
        from.gravity = mix(from.gravity, to.gravity, share);
        from.base_acceleration = mix(from.base_acceleration, to.base_acceleration, share);
        from.water_level = mix(from.water_level, to.water_level, share);
        from.strength_factor = mix(from.strength_factor, to.strength_factor, share);
        mix_all(&mut from.block_force, &to.block_force, share);
        mix_all(&mut from.block_moment, &to.block_moment, share);
        mix_all(&mut from.port_traction, &to.port_traction, share);
        mix_all(&mut from.port_pressure, &to.port_pressure, share);
        mix_all(&mut from.port_velocity, &to.port_velocity, share);
        mix_all(&mut from.head, &to.head, share);
        mix_all(&mut from.rain, &to.rain, share);
        from.drain.clone_from(&to.drain);
        self.since = t;
    }

    /// Gravity at a share of the way (m/s²).
    pub fn gravity(&self, share: f64) -> Vector {
        mix(self.from.gravity, self.to.gravity, share)
    }

    /// Gravity (m/s²) that acts at time `t` (s); a jump that has not acted yet is left out.
    pub fn gravity_now(&self, t: f64) -> Vector {
        if self.is_moving() { self.gravity(self.share(t)) } else { self.from.gravity }
    }

    /// Acceleration of the base at a share of the way (m/s²).
    pub fn base_acceleration(&self, share: f64) -> Vector {
        mix(self.from.base_acceleration, self.to.base_acceleration, share)
    }

    /// Water level at a share of the way (m).
    pub fn water_level(&self, share: f64) -> f64 {
        mix(self.from.water_level, self.to.water_level, share)
    }

    /// Level (m) of a head at a share of the way.
    pub fn head(&self, head: usize, share: f64) -> f64 {
        mix(self.from.head[head], self.to.head[head], share)
    }

    /// Rate (m/s) of a rain at a share of the way.
    pub fn rain(&self, rain: usize, share: f64) -> f64 {
        mix(self.from.rain[rain], self.to.rain[rain], share)
    }

    /// Strength factor at a share of the way.
    pub fn strength_factor(&self, share: f64) -> f64 {
        mix(self.from.strength_factor, self.to.strength_factor, share)
    }

    /// Strength factor that acts at time `t` (s); a jump that has not acted yet is left out.
    pub fn strength_factor_now(&self, t: f64) -> f64 {
        if self.is_moving() { self.strength_factor(self.share(t)) } else { self.from.strength_factor }
    }

    /// Force (N/m) and moment (N·m/m) on a block at a share of the way.
    pub fn block(&self, block: BlockId, share: f64) -> (Vector, f64) {
        let force = mix(self.from.block_force[block], self.to.block_force[block], share);
        (force, mix(self.from.block_moment[block], self.to.block_moment[block], share))
    }

    /// Velocity (m/s) of a port at a share of the way.
    pub fn velocity(&self, port: usize, share: f64) -> Vector {
        mix(self.from.port_velocity[port], self.to.port_velocity[port], share)
    }

    /// Velocity (m/s) of a port, its mean over a time from `a` to `b` (s).
    pub fn mean_velocity(&self, port: usize, a: f64, b: f64) -> Vector {
        let start = self.from.port_velocity[port];
        let at = |t: f64| match t {
            t if t < self.before.end => start + self.before.rate[port] * (t - self.before.end),
            t if t < self.since => start,
            t => self.velocity(port, self.share(t)),
        };
        let bends = [self.before.end, self.since, self.until].map(|t| t.clamp(a, b));
        let [p, q, r] = if bends[1] <= bends[2] { bends } else { [bends[0], bends[1], bends[1]] };
        let pieces = [[a, p], [p, q.max(p)], [q.max(p), r.max(p)], [r.max(p), b]];
        let of_piece = |[from, to]: [f64; 2]| at(0.5 * (from + to)) * (to - from).max(0.0);
        pieces.map(of_piece).iter().sum::<Vector>() / (b - a)
    }

    /// Traction and pressure (Pa) of a port at a share of the way.
    pub fn port(&self, port: usize, share: f64) -> (Vector, f64) {
        let traction = mix(self.from.port_traction[port], self.to.port_traction[port], share);
        (traction, mix(self.from.port_pressure[port], self.to.port_pressure[port], share))
    }
}

/// A number or a vector.
trait Mix: Copy + std::ops::Add<Output = Self> + std::ops::Sub<Output = Self> + std::ops::Mul<f64, Output = Self> {}

impl Mix for f64 {}
impl Mix for Vector {}

/// Linear between two values, exact at the end.
fn mix<T: Mix>(from: T, to: T, share: f64) -> T {
    if share >= 1.0 { to } else { from + (to - from) * share }
}

fn mix_all<T: Mix>(from: &mut [T], to: &[T], share: f64) {
    from.iter_mut().zip(to).for_each(|(from, to)| *from = mix(*from, *to, share));
}
