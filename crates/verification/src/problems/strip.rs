//! Columns of rock in which plane waves travel upwards: every cover moves along one axis, as in an endless layer.

use std::fmt::Write;

use enmm::model::{Simulation, StepReport};

use crate::{Setup, Trouble};

/// Kind of a plane wave that travels along y.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wave {
    /// Pressure wave: rock moves along y.
    P,
    /// Shear wave: rock moves along x.
    S,
}

impl Wave {
    pub const BOTH: [Self; 2] = [Self::P, Self::S];

    /// Axis along which rock moves: 0 is x.
    pub fn axis(self) -> usize {
        usize::from(self == Self::P)
    }

    /// Axis that is held, as a case writes it.
    fn held(self) -> &'static str {
        ["y", "x"][self.axis()]
    }
}

/// Rock by its moduli.
#[derive(Debug, Clone, Copy)]
pub struct Rock {
    pub density: f64,
    pub young: f64,
    pub poisson: f64,
}

impl Rock {
    /// λ + 2μ or μ (Pa).
    pub fn modulus(&self, wave: Wave) -> f64 {
        let mu = self.young / (2.0 * (1.0 + self.poisson));
        match wave {
            Wave::P => 2.0 * mu * (1.0 - self.poisson) / (1.0 - 2.0 * self.poisson),
            Wave::S => mu,
        }
    }

    /// Wave speed (m/s).
    pub fn speed(&self, wave: Wave) -> f64 {
        (self.modulus(wave) / self.density).sqrt()
    }

    /// ρ·c (Pa·s/m).
    pub fn impedance(&self, wave: Wave) -> f64 {
        (self.modulus(wave) * self.density).sqrt()
    }
}

/// A third of the usual step: the ledger of a wave errs by ½(ω dt)² (theory, Eq. 28).
const SOLVER: &str = "[solver]\ndt_safety = 0.3\n";

/// A strip from y = 0 upwards, two mesh sizes wide.
pub struct Strip<'a> {
    pub wave: Wave,
    pub rock: Rock,
    pub height: f64,
    /// Mesh size (m).
    pub size: f64,
    /// Shift of the lattice (m): the boundary cuts elements.
    pub origin: [f64; 2],
    /// Heights of the monitors (m).
    pub monitors: &'a [f64],
    /// Duration of the dynamic stage (s).
    pub duration: f64,
    /// Further tables of the case.
    pub extra: String,
}

impl Strip<'_> {
    /// The case as text.
    pub fn text(&self) -> String {
        let Strip { height, size, origin, rock: Rock { density, young, poisson }, .. } = *self;
        let (width, far) = (2.0 * size, 4.0 * size);
        let mut text = format!(
            "title = \"strip\"\n[domain]\n\
             outline = [[0.0, 0.0], [{width}, 0.0], [{width}, {height}], [0.0, {height}]]\n\
             [mesh]\nsize = {size}\norigin = {origin:?}\n[rock.rock]\ndensity = {density}\nyoung = {young:e}\n\
             poisson = {poisson}\n[gravity]\ny = 0.0\n[[fix]]\nbox = [-{far}, -{far}, {far}, {top}]\naxes = \"{}\"\n\
             [[stage]]\nname = \"wave\"\nkind = \"dynamic\"\nduration = {:e}\ndamping = 0.0\n{SOLVER}{}",
            self.wave.held(),
            self.duration,
            self.extra,
            top = height + far,
        );
        for (k, y) in self.monitors.iter().enumerate() {
            let _ = write!(text, "[[monitor]]\nname = \"m{k}\"\npoint = [{:e}, {y:e}]\n", 1.03 * size);
        }
        text
    }

    /// The boundary at the foot: quiet, with a wave of 1 m/s times rows of time and factor.
    pub fn foot(&self, rows: &[[f64; 2]], amplitude: f64) -> String {
        let mut wave = [0.0; 2];
        wave[self.wave.axis()] = amplitude;
        format!("[[quiet]]\nedge = [[0.0, 0.0], [{}, 0.0]]\nwave = {wave:?}\ntable = {rows:?}\n", 2.0 * self.size)
    }

    /// A quiet boundary at the head.
    pub fn quiet_head(&self) -> String {
        let Self { size, height, .. } = *self;
        format!("[[quiet]]\nedge = [[0.0, {height}], [{}, {height}]]\n", 2.0 * size)
    }
}

/// A strip of one and a half wave lengths with a joint half way, or without one, between quiet boundaries.
#[derive(Debug, Clone, Copy)]
pub struct Jointed {
    pub rock: Rock,
    pub wave: Wave,
    /// Wave length (m).
    pub length: f64,
    /// Mesh size (m).
    pub size: f64,
    /// Whether the joint runs across elements, or else along a row of the lattice.
    pub across: bool,
}

impl Jointed {
    /// Rock, wave length and mesh of the parameters that problems share.
    pub fn of(setup: &Setup, wave: Wave) -> Self {
        let [young, poisson, density, length] = ["young", "poisson", "density", "length"].map(|n| setup.get(n));
        let rock = Rock { density, young, poisson };
        Self { rock, wave, length, size: length / setup.get("elements"), across: false }
    }

    /// Runs to time `until` (s) with a joint of this stiffness (Pa/m) and strength (keys of a law), and rows of the
    /// incident wave times `amplitude` (m/s); monitors stand a quarter of the length below and above the joint.
    ///
    /// # Errors
    /// The case does not fit, or the run fails.
    pub fn run(
        &self,
        setup: &mut Setup,
        name: &str,
        joint: Option<(f64, &str)>,
        (rows, amplitude): (&[[f64; 2]], f64),
        until: f64,
    ) -> Result<Motion, Trouble> {
        let (height, size) = (1.5 * self.length, self.size);
        let (monitors, middle) = ([0.5 * self.length, self.length], 0.5 * height);
        let shift = if self.across { [0.23 * size, 0.37 * size] } else { [0.0; 2] };
        let mut strip = Strip {
            wave: self.wave,
            rock: self.rock,
            height,
            size,
            origin: [shift[0], middle + shift[1]],
            monitors: &monitors,
            duration: 2.0 * until,
            extra: String::new(),
        };
        strip.extra = strip.foot(rows, amplitude) + &strip.quiet_head();
        if let Some((k, strength)) = joint {
            strip.extra += &format!(
                "[[joint]]\npoints = [[-{size}, {middle}], [{far}, {middle}]]\n[joint_law.joint]\nfriction_deg = 0.0\n\
                 normal_stiffness = {k:e}\nshear_stiffness = {k:e}\n{strength}",
                far = 3.0 * size
            );
        }
        run(setup, name, &strip, until)
    }
}

/// Motion of the monitors over time.
#[derive(Debug, Clone, Default)]
pub struct Motion {
    /// Time of each sample (s).
    pub times: Vec<f64>,
    /// Velocity along the wave's axis (m/s), by monitor.
    pub velocity: Vec<Vec<f64>>,
    /// Energy report of the last step.
    pub last: StepReport,
}

/// Builds and runs a strip to time `until` (s); samples every step.
///
/// # Errors
/// The case does not fit, or the run fails.
pub fn run(setup: &mut Setup, name: &str, strip: &Strip, until: f64) -> Result<Motion, Trouble> {
    let mut simulation = setup.simulation(name, strip.text())?;
    follow(&mut simulation, strip.wave.axis(), strip.monitors.len(), until)
}

/// Runs a model to time `until` (s) and samples its monitors along an axis at every step. Velocities of the leapfrog
/// belong to the middle of the step.
///
/// # Errors
/// The run fails.
pub fn follow(simulation: &mut Simulation, axis: usize, monitors: usize, until: f64) -> Result<Motion, Trouble> {
    let dt = simulation.model().dt;
    let steps = (until / dt).ceil() as u64;
    let mut motion = Motion { velocity: vec![Vec::new(); monitors], ..Motion::default() };
    for step in 0..steps {
        motion.last = simulation.advance(step + 1 == steps)?;
        motion.times.push(simulation.time() - 0.5 * dt);
        for (k, samples) in motion.velocity.iter_mut().enumerate() {
            samples.push(simulation.monitor(k).1[axis]);
        }
    }
    Ok(motion)
}

impl Motion {
    /// Amplitude of the part with angular frequency `omega` (1/s) in a signal over times `from`–`to` (s), which hold
    /// whole periods: twice the modulus of its Fourier coefficient.
    pub fn amplitude(&self, signal: &[f64], omega: f64, from: f64, to: f64) -> f64 {
        let (mut cosine, mut sine, mut count) = (0.0, 0.0, 0.0);
        for (t, v) in self.times.iter().zip(signal).filter(|(t, _)| (from..to).contains(*t)) {
            cosine += v * (omega * t).cos();
            sine += v * (omega * t).sin();
            count += 1.0;
        }
        2.0 * (cosine * cosine + sine * sine).sqrt() / count
    }

    /// Mean square of a signal over times `from`–`to` (s).
    pub fn mean_square(&self, signal: &[f64], from: f64, to: f64) -> f64 {
        let squares = self.times.iter().zip(signal).filter(|(t, _)| (from..to).contains(*t)).map(|(_, v)| v * v);
        let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
        sum / count
    }

    /// Largest magnitude of a signal.
    pub fn peak(signal: &[f64]) -> f64 {
        signal.iter().map(|v| v.abs()).fold(0.0, f64::max)
    }

    /// Points of a signal for a plot, thinned to a few hundred.
    pub fn points(&self, signal: &[f64]) -> Vec<[f64; 2]> {
        let every = (self.times.len() / 300).max(1);
        self.times.iter().zip(signal).step_by(every).map(|(t, v)| [*t, *v]).collect()
    }
}

/// Value of a smooth pulse of length `period` (s) and height 1 at time `t` (s): sin²(πt/period).
pub fn pulse(t: f64, period: f64) -> f64 {
    if (0.0..period).contains(&t) { (std::f64::consts::PI * t / period).sin().powi(2) } else { 0.0 }
}

/// Rows of a function over 0–`end` (s).
pub fn rows(end: f64, count: usize, of: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    (0..=count).map(|k| end * k as f64 / count as f64).map(|t| [t, of(t)]).collect()
}
