//! Cost of a step of each method on a continuum, at given ratios of their steps, with the errors of both.
//!
//! Rock of height H on a fixed base, between smooth walls, feels its weight at once and vibrates: a column whose exact
//! motion is u = −g/c²·(H·y − y²/2) + Σ 2g/(c²·H·k³)·sin k·y·cos k·c·t, with k = (2n+1)π/2H and c² = (λ+2μ)/ρ.

use std::f64::consts::PI;
use std::fmt::Write;

use enmm::model::Simulation;
use enmm::model::case::{Integrator, Newmark};
use enmm::model::tables::Seconds;

use super::cpu_seconds;
use crate::{Setup, Trouble, Values};

/// Explicit steps in one implicit one.
const RATIOS: [u32; 2] = [50, 200];
/// Side of the rock (m).
const SIDE: f64 = 10.0;
/// Mesh size (m) of some ten thousand elements; a third of it makes ten times as many.
const SIZE: f64 = 0.152;
/// Terms of the series.
const TERMS: usize = 400;
/// Elements, one in so many, at which motion is compared.
const STRIDE: usize = 101;
/// Factorisations and solutions of the step that the project's goal is about.
const SOLVES: f64 = 3.0;
/// Repetitions of a factorisation that is timed alone.
const ROUNDS: usize = 3;

/// One method on one model.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// Method and, of an implicit one, Newmark's rule.
    pub method: String,
    /// Explicit steps in one of its steps.
    pub ratio: u32,
    /// Elements of the model.
    pub elements: usize,
    /// Step (s).
    pub dt: f64,
    /// Processor time of a step (s).
    pub step: f64,
    /// Processor time (s) of one assembly, one numeric factorisation and one solution; none of the explicit method.
    pub parts: [f64; 3],
    /// Factorisations and solutions of a step as it ran.
    pub counts: [f64; 2],
    /// Root mean square of the error of displacements over that of the exact ones, over the whole run.
    pub error: f64,
}

impl Cost {
    /// Processor time (s) of a step with [`SOLVES`] factorisations and solutions.
    fn full_step(&self) -> f64 {
        let [assembly, factor, solve] = self.parts;
        self.step + (SOLVES - self.counts[0]) * (assembly + factor) + (SOLVES - self.counts[1]) * solve
    }
}

/// All methods in turn on models of some 10 000 and, unless `quick`, 100 000 elements, explicit first in each.
///
/// # Errors
/// A case that does not build, or a run that fails.
pub fn ratios(quick: bool) -> Result<Vec<Cost>, Trouble> {
    let sizes: &[f64] = if quick { &[SIZE] } else { &[SIZE, SIZE / 10f64.sqrt()] };
    let mut costs = Vec::new();
    for &size in sizes {
        costs.extend(on_mesh(size)?);
    }
    Ok(costs)
}

fn on_mesh(size: f64) -> Result<Vec<Cost>, Trouble> {
    let explicit = Runner::new("explicit", size, 1, None)?;
    let dt = explicit.simulation.model().dt;
    let mut runners = vec![explicit];
    for ratio in RATIOS {
        for (name, rule) in [("implicit, constant", Newmark::Constant), ("implicit, mean", Newmark::Trapezoidal)] {
            runners.push(Runner::new(name, size, ratio, Some((rule, dt)))?);
        }
    }
    let longest = RATIOS[1];
    let column = Column::of(&runners[0].simulation);
    let half_period = 2.0 * SIDE / column.speed;
    let rounds = (half_period / (f64::from(longest) * dt)).ceil() as u32;
    for _ in 0..rounds {
        for runner in &mut runners {
            runner.advance(longest)?;
            runner.compare(&column);
        }
    }
    Ok(runners.iter_mut().map(Runner::cost).collect())
}

/// The exact motion.
struct Column {
    gravity: f64,
    speed: f64,
}

impl Column {
    fn of(simulation: &Simulation) -> Self {
        let (slope, rock) = (simulation.model(), &simulation.model().rocks[0]);
        Self { gravity: slope.gravity.norm(), speed: (rock.confined_modulus() / rock.density).sqrt() }
    }

    /// Vertical displacement (m) at height `y` (m) and time `t` (s).
    fn displacement(&self, y: f64, t: f64) -> f64 {
        let share = self.gravity / (self.speed * self.speed);
        let waves = (0..TERMS).map(|n| {
            let k = (2 * n + 1) as f64 * PI / (2.0 * SIDE);
            2.0 / (SIDE * k.powi(3)) * (k * y).sin() * (k * self.speed * t).cos()
        });
        share * (waves.sum::<f64>() - (SIDE * y - 0.5 * y * y))
    }
}

/// A model that runs by one method.
struct Runner {
    method: String,
    simulation: Simulation,
    ratio: u32,
    cpu: f64,
    /// Wall times by part of the first step.
    laid_out: Seconds,
    /// Sums of squares of error and exact displacement (m²).
    squares: [f64; 2],
}

impl Runner {
    fn new(method: &str, size: f64, ratio: u32, implicit: Option<(Newmark, f64)>) -> Result<Self, Trouble> {
        let rule = implicit.map_or_else(String::new, |(rule, dt)| {
            let rule = if rule == Newmark::Constant { "constant" } else { "trapezoidal" };
            format!("[solver]\nnewmark = \"{rule}\"\nimplicit_step = {:e}\n", f64::from(ratio) * dt)
        });
        let integrator = if implicit.is_some() { Integrator::Implicit } else { Integrator::Explicit };
        let mut setup = Setup { values: Values::none(), integrator, quick: false, cases: Vec::new() };
        let mut simulation = setup.simulation("ratio", text(size, &rule))?;
        simulation.set_serial(true);
        Ok(Self { method: method.into(), simulation, ratio, cpu: 0.0, laid_out: Seconds::default(), squares: [0.0; 2] })
    }

    /// Covers so many explicit steps. The first step, which lays out the matrix, is not timed.
    fn advance(&mut self, explicit_steps: u32) -> Result<(), Trouble> {
        let mut steps = explicit_steps / self.ratio;
        if self.simulation.state().step == 0 {
            self.simulation.advance(false)?;
            self.laid_out = self.simulation.workspace().seconds;
            steps -= 1;
        }
        let clock = cpu_seconds();
        for _ in 0..steps {
            self.simulation.advance(false)?;
        }
        self.cpu += cpu_seconds() - clock;
        Ok(())
    }

    fn compare(&mut self, column: &Column) {
        let (slope, state, time) = (self.simulation.model(), self.simulation.state(), self.simulation.time());
        for element in slope.covers.elements().step_by(STRIDE) {
            let place = slope.covers.element_centroid[element];
            let found = slope.sample(element, place, &state.displacement);
            let exact = column.displacement(place.y, time);
            self.squares[0] += found.x.powi(2) + (found.y - exact).powi(2);
            self.squares[1] += exact * exact;
        }
    }

    fn cost(&mut self) -> Cost {
        let (slope, counters) = (self.simulation.model(), self.simulation.state().counters);
        let steps = self.simulation.state().step as f64;
        let counts = [counters.factorisations, counters.sweeps].map(|n| n as f64 / steps);
        let [factor, solve] = self.kernels();
        let step = self.cpu / (steps - 1.0);
        let (now, first) = (&self.simulation.workspace().seconds, &self.laid_out);
        let sum = |s: &Seconds| s.elements + s.search + s.entrance + s.sweep + s.commit;
        let matrix = (now.sweep - first.sweep) / (sum(now) - sum(first));
        let assembly = (step * matrix - counts[1] * solve) / counts[0] - factor;
        Cost {
            method: self.method.clone(),
            ratio: self.ratio,
            elements: slope.covers.element_count(),
            dt: slope.dt,
            step,
            parts: if slope.integrator.is_some() { [assembly.max(0.0), factor, solve] } else { [0.0; 3] },
            counts: if slope.integrator.is_some() { counts } else { [0.0; 2] },
            error: (self.squares[0] / self.squares[1]).sqrt(),
        }
    }

    /// Processor time (s) of a numeric factorisation and of a solution, least of several.
    fn kernels(&self) -> [f64; 2] {
        let Some(buffers) = enmm_implicit::buffers(self.simulation.workspace()) else { return [0.0; 2] };
        let (mut matrix, mut unknowns) = (buffers.matrix.clone(), buffers.unknowns.clone());
        if matrix.is_empty() {
            return [0.0; 2];
        }
        let mut least = [f64::INFINITY; 2];
        for _ in 0..ROUNDS {
            let start = cpu_seconds();
            let done = matrix.factorise();
            let factored = cpu_seconds();
            matrix.solve(&mut unknowns);
            if done.is_ok() {
                least[0] = least[0].min(factored - start);
                least[1] = least[1].min(cpu_seconds() - factored);
            }
        }
        least
    }
}

fn text(size: f64, solver: &str) -> String {
    format!(
        "title = \"Rock that feels its weight at once\"\n[domain]\noutline = [[0, 0], [{SIDE}, 0], [{SIDE}, {SIDE}], \
         [0, {SIDE}]]\n[mesh]\nsize = {size:e}\nangle_deg = 7\n[rock.rock]\ndensity = 2600\nyoung = 5e9\npoisson = \
         0.25\n[[fix]]\nedge = [[0, 0], [{SIDE}, 0]]\n[[fix]]\nedge = [[0, 0], [0, {SIDE}]]\naxes = \"x\"\n[[fix]]\n\
         edge = [[{SIDE}, 0], [{SIDE}, {SIDE}]]\naxes = \"x\"\n[[stage]]\nname = \"weight\"\nkind = \"dynamic\"\n\
         duration = 1e6\ndamping = 0.0\n{solver}"
    )
}

/// The costs as a section.
pub fn markdown(costs: &[Cost]) -> String {
    let mut text = format!("{SECTION}{HEAD}{}\n{TABLE}", super::origin());
    let mut explicit = None;
    for cost in costs {
        let milliseconds = |seconds: f64| format!("{:.3}", 1e3 * seconds);
        let is_explicit = cost.counts[0] == 0.0;
        if is_explicit {
            explicit = Some(cost);
        }
        let covered = explicit.map_or(f64::NAN, |e| f64::from(cost.ratio) * e.step);
        let parts = cost.parts.map(|part| if is_explicit { "–".to_owned() } else { milliseconds(part) });
        let times = |step: f64| if is_explicit { "–".to_owned() } else { format!("{:.1}", step / covered) };
        let counts = if is_explicit { "–".into() } else { format!("{:.1} / {:.1}", cost.counts[0], cost.counts[1]) };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.2e} | {} | {} | {} | {:.2e} | {} | {} |",
            cost.elements,
            cost.method,
            cost.ratio,
            cost.dt,
            milliseconds(cost.step),
            parts.join(" / "),
            counts,
            cost.error,
            times(cost.step),
            times(cost.full_step()),
        );
    }
    text
}

/// Heading of the section, the last of the document of the comparison.
pub const SECTION: &str = "\n## Cost of a step on a continuum\n";
const HEAD: &str = "\n\
Written by `cargo xtask ratio` (`--quick`: the small model alone); all methods in turn in one run, each on one \
thread,\nprocessor time. Rock of 10 m by 10 m on a fixed base between smooth walls feels its weight at once; the error \
is that of\nthe displacements against the exact motion, root mean square over rock and half a period. *Constant* is \
Newmark's\nrule with β = ½, γ = 1, as in discontinuous deformation analysis; *mean* the trapezoidal rule. The last two \
columns\ndivide the cost of an implicit step by that of the explicit steps that cover the same time: the step as it \
ran, and\nwith three factorisations and solutions, as contacts that open and close ask for.\n\n";

const TABLE: &str = "| elements | method | ratio of steps | dt [s] | step [ms] | assembly / factor / solve [ms] | \
factors / solves | error | times dearer | … with 3 solves |\n|---:|---|---:|---:|---:|---|---|---:|---:|---:|\n";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_motion_starts_at_rest_and_swings_to_twice_the_settlement() {
        let column = Column { gravity: 9.81, speed: 1500.0 };
        let settlement = 9.81 / (1500.0f64 * 1500.0) * 0.5 * SIDE * SIDE;
        let [start, end] = [0.0, 2.0 * SIDE / column.speed].map(|t| column.displacement(SIDE, t));
        assert!(start.abs() < 1e-5 * settlement, "{start}");
        assert!((end + 2.0 * settlement).abs() < 1e-5 * settlement, "{end}");
    }
}
