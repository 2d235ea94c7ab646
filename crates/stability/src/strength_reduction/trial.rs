//! One trial: the strength falls from that of the slope at rest to 1/F of its own, and the motion is judged.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use nalgebra::Vector3;

use super::judge::{self, Sample, Scales, Verdict};
use super::slip::{ELASTIC, height_and_gravity, largest_slip};
use super::{FailingBlock, Trial};
use enmm::geometry::Vector;
use enmm::model::tables::BlockId;
use enmm::model::{Ledger, Simulation, StepError, StepReport};

/// Samples while a wave of gravity's own time √(H/g) passes.
const WINDOWS_PER_FALL: f64 = 10.0;
/// Ways of a shear wave through the height of the model in a window.
const WAVES: f64 = 2.0;
/// Windows in which the strength falls.
const FALLING: f64 = 10.0;
/// Times √(H/g) after which a trial ends undecided.
const FALLS_MAX: f64 = 12.0;
/// Speed, relative to that of a block which the tolerance lets fail for a window, below which nothing moves.
const STILL: f64 = 0.01;
/// How many times its settlement rock that yields moves before it fails: a slope in soil reaches its limit after 1.5 to
/// 1.8 times, whatever its stiffness.
const FLOW: f64 = 5.0;
/// Share of the largest displacement and of the largest speed from which a block takes part in a failure.
const TAKES_PART: f64 = 0.1;

/// Why a trial gave no verdict.
pub enum Stop {
    /// The caller stopped it.
    Interrupted,
    /// A numerical failure before anything had failed.
    Failed(StepError),
}

/// The fall of the strength in a trial: from [`Fall::DEPTH`] times its end down to that, by equal ratios in equal
/// times, so that joints take up their load one after the other and nothing is thrown (Eq. 60a).
struct Fall {
    /// When it begins (s).
    start: f64,
    /// How long it takes (s).
    time: f64,
    /// Strength factor at its end.
    end: f64,
}

impl Fall {
    /// Strength at its beginning over that at its end.
    const DEPTH: f64 = 10.0;

    /// Strength factor at a time (s).
    fn strength(&self, time: f64) -> f64 {
        let left = 1.0 - ((time - self.start) / self.time).clamp(0.0, 1.0);
        self.end * libm::pow(Self::DEPTH, left)
    }

    /// Gives the next step of a model its strength.
    fn act(&self, simulation: &mut Simulation) {
        let (time, dt) = (simulation.time(), simulation.model().dt);
        if time >= self.start + self.time {
            return;
        }
        let drive = simulation.drive();
        (drive.from.strength_factor, drive.to.strength_factor) = (self.strength(time), self.strength(time + dt));
        (drive.since, drive.until) = (time, time + dt);
    }
}

/// Common start of all trials.
pub struct Base {
    /// The slope at rest.
    pub simulation: Simulation,
    scales: Scales,
    /// Whether each block can move.
    free: Vec<bool>,
    /// Whether rock yields: what it flows is no slip of joints.
    yields: bool,
}

impl Base {
    /// Takes a slope at rest at the start of its dynamic stage.
    pub fn new(simulation: Simulation, tolerance: f64) -> Self {
        let scales = scales(&simulation, tolerance);
        let free = free(&simulation);
        let yields = simulation.case().yields();
        Self { simulation, scales, free, yields }
    }

    /// Area (m²) of all blocks without a support; where each has one, of all that can move.
    pub fn free_area(&self) -> f64 {
        let model = self.simulation.model();
        let mut held = vec![false; model.covers.block_count()];
        model.supports.iter().for_each(|support| held[support.block] = true);
        let area = |is_in: &dyn Fn(BlockId) -> bool| -> f64 {
            self.moving().filter(|&b| is_in(b)).map(|b| model.covers.block_area(b)).sum()
        };
        let free = area(&|b| !held[b]);
        if free > 0.0 { free } else { area(&|_| true) }
    }

    /// Blocks that can move.
    fn moving(&self) -> impl Iterator<Item = BlockId> {
        BlockId::all(self.free.len()).filter(|&b| self.free[b])
    }

    /// Displacements (m) of all free blocks: along x, along y, and by turning at their own radius.
    fn positions(&self, simulation: &Simulation) -> Vec<(BlockId, Vector3<f64>)> {
        let position = |b: BlockId| {
            let motion = simulation.motion_of(b);
            let turn = motion.rotation * (motion.area / std::f64::consts::PI).sqrt();
            (b, Vector3::new(motion.displacement.x, motion.displacement.y, turn))
        };
        self.moving().map(position).collect()
    }

    /// The blocks that have gone farthest, as many as are too few to decide about the slope (see
    /// [`Simulation::mass_of_few`]).
    fn few(&self, simulation: &Simulation) -> Vec<BlockId> {
        let mass = &simulation.model().mass_matrix.total;
        let mut room = simulation.mass_of_few();
        let mut small: Vec<(BlockId, f64)> =
            self.moving().filter(|&b| mass[b] <= room).map(|b| (b, self.moved(simulation, b))).collect();
        small.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        small.retain(|&(b, _)| {
            let fits = mass[b] <= room;
            room -= if fits { mass[b] } else { 0.0 };
            fits
        });
        let mut few: Vec<BlockId> = small.into_iter().map(|(b, _)| b).collect();
        few.sort_unstable();
        few
    }

    /// Makes one trial; returns the model at its end as well. A slope that is caught is tried again in small
    /// displacements: if it comes to rest there, too, no change of its geometry holds it.
    pub fn run(&self, factor: f64, interrupt: Option<&AtomicBool>) -> Result<(Trial, Simulation), Stop> {
        let (mut trial, simulation) = self.follow(factor, self.simulation.clone(), interrupt)?;
        if trial.verdict != Verdict::Caught || self.yields {
            return Ok((trial, simulation));
        }
        let mut small = self.simulation.clone();
        small.assume_small_displacements();
        let again = match self.follow(factor, small, interrupt) {
            Ok((again, _)) => again,
            Err(Stop::Failed(_)) => return Ok((trial, simulation)),
            Err(stop) => return Err(stop),
        };
        (trial.steps, trial.wall) = (trial.steps + again.steps, trial.wall + again.wall);
        if again.reason == judge::Reason::Rest {
            (trial.verdict, trial.reason) = (Verdict::Stable, judge::Reason::Hardening);
            trial.failing.clear();
        }
        Ok((trial, simulation))
    }

    /// Follows the motion of a model at rest while its strength falls.
    fn follow(
        &self,
        factor: f64,
        mut simulation: Simulation,
        interrupt: Option<&AtomicBool>,
    ) -> Result<(Trial, Simulation), Stop> {
        let clock = Instant::now();
        let fall = Fall { start: simulation.time(), time: self.scales.ramp, end: 1.0 / factor };
        simulation.drive().arrive();
        let mut samples = Vec::new();
        let mut positions = self.positions(&simulation);
        let steps = simulation.steps_in(self.scales.window);
        let mut first = None;
        let (mut judged, mut last) = (None, StepReport::default());
        while judged.is_none() {
            match window(&mut simulation, steps, &fall, interrupt)? {
                Ok(report) => last = report,
                Err(error) => {
                    judged = Some(given_up(&samples, &self.scales).ok_or(Stop::Failed(error))?);
                    break;
                }
            }
            let first = *first.get_or_insert(last.ledger);
            let before = std::mem::replace(&mut positions, self.positions(&simulation));
            let few = self.few(&simulation);
            let both = positions.iter().zip(&before).filter(|((b, _), _)| few.binary_search(b).is_err());
            let way = both.map(|((_, now), (_, before))| (now - before).norm()).fold(0.0, f64::max);
            samples.push(self.sample(&simulation, &last, &first, way, &few));
            judged = judge::judge(&samples, &self.scales);
        }
        let (verdict, reason) = judged.unwrap_or((Verdict::Unstable, judge::Reason::Runaway));
        let end = samples.last().copied().unwrap_or_default();
        let trial = Trial {
            factor,
            verdict,
            reason,
            time: end.time,
            displacement: end.displacement,
            slip: end.slip,
            speed: end.speed,
            kinetic: end.kinetic,
            released: end.released,
            acceleration: judge::acceleration(&samples),
            failing: self.failing(&simulation, verdict),
            loose: self.loose(&simulation),
            steps: simulation.state().step - self.simulation.state().step,
            ledger_residual: last.ledger.residual_relative(),
            wall: clock.elapsed().as_secs_f64(),
        };
        Ok((trial, simulation))
    }

    /// The motion at the end of a window in which the fastest block has gone a way (m), without that of a few.
    fn sample(
        &self,
        simulation: &Simulation,
        report: &StepReport,
        first: &Ledger,
        way: f64,
        few: &[BlockId],
    ) -> Sample {
        let most = self.moving().filter(|b| few.binary_search(b).is_err());
        let far = most.map(|b| self.moved(simulation, b)).fold(0.0, f64::max);
        let kinetic_of_few: f64 = few.iter().map(|&b| simulation.rigid_motion_of(b).3).sum();
        let energy = |l: &Ledger| l.potential + l.strain + l.stored - l.external_work;
        Sample {
            time: simulation.time() - self.simulation.time(),
            displacement: far,
            slip: if self.yields { far } else { largest_slip(simulation, &self.simulation.state().contacts, few) },
            speed: way / self.scales.window,
            kinetic: (report.ledger.kinetic - kinetic_of_few).max(0.0),
            released: energy(first) - energy(&report.ledger),
        }
    }

    /// Largest displacement (m) of a block's covers since the trial began.
    fn moved(&self, simulation: &Simulation, block: BlockId) -> f64 {
        let [begin, now] = [&self.simulation, simulation].map(|simulation| &simulation.state().displacement);
        simulation.model().covers.covers_of(block).map(|i| (now[i] - begin[i]).norm()).fold(0.0, f64::max)
    }

    /// Motion of all free blocks since the trial began.
    fn motions(&self, simulation: &Simulation) -> Vec<FailingBlock> {
        let model = simulation.model();
        self.moving()
            .map(|b| {
                let (_, velocity, spin, _) = simulation.rigid_motion_of(b);
                let radius = (model.covers.block_area(b) / std::f64::consts::PI).sqrt();
                FailingBlock {
                    block: b.number(),
                    position: model.covers.block_centroid(b),
                    area: model.covers.block_area(b),
                    mass: model.mass_matrix.total[b],
                    displacement: self.moved(simulation, b),
                    rotation: simulation.motion_of(b).rotation - self.simulation.motion_of(b).rotation,
                    speed: libm::hypot(velocity.norm(), spin * radius),
                }
            })
            .collect()
    }

    /// Blocks that are too few to decide about the slope and have gone farther than elasticity explains.
    fn loose(&self, simulation: &Simulation) -> Vec<FailingBlock> {
        let few = self.few(simulation);
        let is_loose =
            |m: &FailingBlock| m.displacement > self.scales.elastic && few.iter().any(|b| b.number() == m.block);
        self.motions(simulation).into_iter().filter(is_loose).collect()
    }

    /// Blocks that move with the failure, fastest first, or that were caught after they had gone too far.
    fn failing(&self, simulation: &Simulation, verdict: Verdict) -> Vec<FailingBlock> {
        let mut motions = self.motions(simulation);
        let most = |of: fn(&FailingBlock) -> f64| motions.iter().map(of).fold(0.0, f64::max);
        let (far, fast) = (most(|m| m.displacement), most(|m| m.speed));
        match verdict {
            Verdict::Stable => motions.clear(),
            Verdict::Caught => motions.retain(|m| m.displacement >= TAKES_PART * far),
            Verdict::Unstable => {
                motions.retain(|m| m.displacement >= TAKES_PART * far && m.speed >= TAKES_PART * fast);
            }
        }
        motions.sort_by(|a, b| b.speed.total_cmp(&a.speed).then(a.block.cmp(&b.block)));
        motions
    }
}

/// Which blocks can move.
fn free(simulation: &Simulation) -> Vec<bool> {
    let (fixed, removed) = (&simulation.workspace().mass_matrix.fixed, &simulation.state().removed);
    fixed.iter().zip(removed).map(|(fixed, removed)| !fixed && !removed).collect()
}

/// Advances a window; the report of its last step, or the numerical failure.
fn window(
    simulation: &mut Simulation,
    steps: u64,
    fall: &Fall,
    interrupt: Option<&AtomicBool>,
) -> Result<Result<StepReport, StepError>, Stop> {
    let mut report = StepReport::default();
    for step in 1..=steps {
        if interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return Err(Stop::Interrupted);
        }
        fall.act(simulation);
        match simulation.advance(step == steps) {
            Ok(made) => report = made,
            Err(error) => return Ok(Err(error)),
        }
    }
    Ok(Ok(report))
}

/// A slope that was running away when the numbers gave up has failed.
fn given_up(samples: &[Sample], scales: &Scales) -> Option<(Verdict, judge::Reason)> {
    let [.., before, last] = samples else { return None };
    let running = last.displacement > scales.elastic && last.kinetic > before.kinetic;
    running.then_some((Verdict::Unstable, judge::Reason::Runaway))
}

/// Times, speeds and lengths of a model's motion (Eqs. 61, 63).
fn scales(simulation: &Simulation, tolerance: f64) -> Scales {
    let (model, state) = (simulation.model(), simulation.state());
    let (height, gravity) = height_and_gravity(simulation);
    let wave = height / model.rocks.iter().map(|r| r.shear_wave_speed()).fold(f64::INFINITY, f64::min);
    let fall = (height / gravity).sqrt();
    let window = (fall / WINDOWS_PER_FALL).max(WAVES * wave);
    let still_speed = STILL * tolerance * gravity * window;
    let free = (0..model.covers.block_count()).filter(|&b| !simulation.workspace().mass_matrix.fixed[b]);
    let mass: f64 = free.map(|b| model.mass_matrix.total[b]).sum();
    let given_way = state.displacement.iter().map(Vector::norm).fold(0.0, f64::max);
    let flow = if simulation.case().yields() { FLOW } else { 1.0 };
    let elastic = (ELASTIC * height).max(flow * given_way);
    Scales {
        window,
        ramp: FALLING * window,
        time_max: FALLS_MAX * fall + FALLING * window,
        still_speed,
        still_kinetic: 0.5 * mass * still_speed * still_speed,
        elastic,
        limit: model.failure_displacement.max(elastic),
    }
}
