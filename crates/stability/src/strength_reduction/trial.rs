//! One trial: the strength falls from that of the slope at rest to 1/F of its own, and the motion is judged.

use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use nalgebra::Vector3;

use super::judge::{self, Sample, Scales, Verdict};
use super::setting::{Geometry, Setting};
use super::slip::{ELASTIC, height_and_gravity, largest_slip};
use super::{End, FailingBlock, Trial};
use enmm::geometry::Vector;
use enmm::model::tables::{BlockId, Model};
use enmm::model::{BoltCondition, BoltState, Ledger, Mechanism, Simulation, StepError, StepReport};

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

/// How many times its displacement at rest a slope has moved that has moved far.
const FAR_AT_REST: f64 = 10.0;
/// The same over the height of the model.
const FAR: f64 = 0.01;
/// Way of a push over the height of the model, at most: columns of soft rock that lean farther fall by that, and not
/// because friction took another path.
const LEAN: f64 = 1e-4;

/// Displacement over that of the slope at rest up to which its real geometry is that of the drawing.
const AS_DRAWN: f64 = 2.0;

/// A slope at rest at the end of a stable trial.
#[derive(Debug, Clone)]
pub struct Rest {
    /// F.
    pub factor: f64,
    /// The model.
    pub simulation: Simulation,
}

/// A trial with the model at its end, or the end of the search where it gave no verdict.
pub type Outcome = Result<(Trial, Ended), End>;

/// A model at the end of a trial.
#[derive(Debug, Clone)]
pub struct Ended {
    /// The model.
    pub simulation: Simulation,
    /// How its motion began; none where it was not followed.
    pub begun: Option<Begun>,
}

/// A model as the motion of a trial begins, from which it can be made again.
#[derive(Debug, Clone)]
pub struct Begun {
    /// The model.
    pub simulation: Simulation,
    fall: Option<Fall>,
    /// Steps to the end of the trial.
    steps: u64,
}

impl Begun {
    /// Duration of the motion (s).
    pub fn duration(&self) -> f64 {
        self.steps as f64 * self.simulation.model().dt
    }

    /// Makes the motion again, step by step, and shows the model as it begins and after each of so many equal parts.
    ///
    /// # Errors
    /// The first error of `show`; the motion ends early where the trial ended by a numerical failure.
    pub fn replay<E>(&self, parts: u64, mut show: impl FnMut(&Simulation) -> Result<(), E>) -> Result<(), E> {
        let mut simulation = self.simulation.clone();
        let start = simulation.time();
        show(&simulation)?;
        for part in 1..=parts {
            let wanted = self.simulation.state().step + self.steps * part / parts;
            while simulation.state().step < wanted {
                let since = simulation.time() - start;
                self.fall.iter().for_each(|fall| fall.act(&mut simulation, since));
                if simulation.advance(false).is_err() {
                    return Ok(());
                }
            }
            show(&simulation)?;
        }
        Ok(())
    }
}

/// A fall of strength to that of a trial, by equal ratios in equal times, so that joints take up their load one after
/// the other and nothing is thrown (Eq. 60a).
#[derive(Debug, Clone)]
struct Fall {
    /// Strength factor at its end.
    end: f64,
    /// The one at its beginning over that.
    depth: f64,
    /// Duration (s).
    time: f64,
}

impl Fall {
    /// Strength at the beginning over that at the end, where a slope comes from its rest at [`super::HELD`] times the
    /// strength.
    const DEPTH: f64 = 10.0;

    /// Sets the strength of the next step of a model, `since` (s) after the beginning.
    fn act(&self, simulation: &mut Simulation, since: f64) {
        if since >= self.time {
            return;
        }
        let (now, dt) = (simulation.time(), simulation.model().dt);
        let strength = |since: f64| self.end * libm::pow(self.depth, 1.0 - (since / self.time).clamp(0.0, 1.0));
        let drive = simulation.drive();
        (drive.from.strength_factor, drive.to.strength_factor) = (strength(since), strength(since + dt));
        (drive.since, drive.until) = (now, now + dt);
    }
}

/// Common start of all trials.
#[derive(Clone)]
pub struct Base {
    /// The slope at rest.
    pub simulation: Simulation,
    /// Times, speeds and lengths of its motion.
    pub scales: Scales,
    /// Whether each block can move.
    free: Vec<bool>,
    /// Whether rock yields: what it flows is no slip of joints.
    pub yields: bool,
    /// Displacement (m) beyond which a slope that rests has moved far.
    far: f64,
    /// Displacement (m) at which a push ends.
    pushed: f64,
}

impl Base {
    /// Takes a slope at rest at the start of its dynamic stage.
    pub fn new(simulation: Simulation, tolerance: f64) -> Self {
        let scales = scales(&simulation, tolerance);
        let free = free(&simulation);
        let yields = simulation.case().yields();
        let (height, _) = height_and_gravity(&simulation);
        let far = (FAR_AT_REST * given_way(&simulation)).min(FAR * height);
        Self { simulation, scales, free, yields, far, pushed: far.min(LEAN * height) }
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

    /// Whether a slope has hardly moved in a trial: so little that its real geometry is that of the drawing.
    pub fn is_near(&self, trial: &Trial) -> bool {
        trial.displacement <= AS_DRAWN * self.given_way()
    }

    /// Largest displacement (m) in which the slope has come to rest.
    fn given_way(&self) -> f64 {
        given_way(&self.simulation)
    }

    /// Blocks that can move.
    fn moving(&self) -> impl Iterator<Item = BlockId> {
        BlockId::all(self.free.len()).filter(|&b| self.free[b])
    }

    /// This start with the sections cut that have broken in a trial since, so that both have the same blocks.
    fn with_breaks_of(&self, trial: &Simulation) -> Cow<'_, Self> {
        if self.simulation.cuts().len() == trial.cuts().len() {
            return Cow::Borrowed(self);
        }
        let simulation = self.simulation.with_breaks_of(trial);
        Cow::Owned(Self { free: free(&simulation), simulation, ..*self })
    }

    /// Displacements (m) of all free blocks: along x, along y, and by turning at their own radius.
    fn positions(&self, simulation: &Simulation) -> Positions {
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

    /// Makes one trial in a setting; returns the model at its end as well. It goes on from a slope that `rests` at a
    /// lower factor with the same contacts left out, where there is one.
    pub fn run(&self, factor: f64, setting: &Setting, rests: Option<&Rest>, interrupt: Option<&AtomicBool>) -> Outcome {
        let rests = rests.filter(|rest| rest.factor < factor);
        let depth = rests.map_or(Fall::DEPTH, |rest| factor / rest.factor);
        let mut simulation = rests.map_or(&self.simulation, |rest| &rest.simulation).clone();
        setting.act(&mut simulation);
        simulation.drive().arrive();
        let blank = Trial { factor, geometry: setting.geometry, ..Trial::default() };
        let time = (self.scales.ramp * libm::log10(depth)).max(self.scales.window);
        self.follow(blank, simulation, Some(Fall { end: 1.0 / factor, depth, time }), interrupt)
    }

    /// Pushes a slope that has come to rest in a trial, until it has moved some way or moves no more, but for a `time`
    /// (s) at most; lets it go from there, and follows it until it rests again.
    pub fn push(
        &self,
        (trial, mut simulation): (Trial, Simulation),
        push: Vector,
        time: f64,
        interrupt: Option<&AtomicBool>,
    ) -> Outcome {
        let (clock, begun) = (Instant::now(), (simulation.time(), simulation.state().step));
        let (from, gravity) = (simulation.clone(), simulation.model().gravity);
        let act = |simulation: &mut Simulation, gravity| {
            let drive = simulation.drive();
            (drive.from.gravity, drive.to.gravity) = (gravity, gravity);
        };
        simulation.drive().arrive();
        act(&mut simulation, gravity + push);
        let (mut left, steps) = (simulation.steps_in(time), simulation.steps_in(self.scales.window));
        let mut before = simulation.clone();
        while left > 0 && self.farthest([&from, &simulation]) < self.pushed {
            window(&mut simulation, 1, |_| (), interrupt)?.map_err(End::Failed)?;
            left -= 1;
            if left % steps == 0 {
                if self.farthest([&before, &simulation]) <= self.scales.still_speed * self.scales.window {
                    break;
                }
                before = simulation.clone();
            }
        }
        act(&mut simulation, gravity);
        simulation.arrest();
        let trial = Trial {
            time: trial.time + simulation.time() - begun.0,
            steps: trial.steps + simulation.state().step - begun.1,
            wall: trial.wall + clock.elapsed().as_secs_f64(),
            ..trial
        };
        self.follow(trial, simulation, None, interrupt)
    }

    /// Follows the motion of a model, through a fall of its strength if there is one, and judges it.
    fn follow(
        &self,
        begun_as: Trial,
        mut simulation: Simulation,
        fall: Option<Fall>,
        interrupt: Option<&AtomicBool>,
    ) -> Outcome {
        let clock = Instant::now();
        let scales = self.scales.of(fall.as_ref().map_or(0.0, |fall| fall.time), begun_as.geometry);
        let start_of_motion = simulation.clone();
        let (start, begun) = (simulation.time(), simulation.state().step);
        let mut samples = Vec::new();
        let mut blocks = Blocks::of(self, &simulation);
        let steps = simulation.steps_in(scales.window);
        let (mut first, mut residual) = (None, 0.0);
        let mut judged = None;
        while judged.is_none() {
            let act = |model: &mut Simulation| fall.iter().for_each(|fall| fall.act(model, model.time() - start));
            let last = match window(&mut simulation, steps, act, interrupt)? {
                Ok(report) => report,
                Err(error) => {
                    judged = Some(given_up(&samples, &scales, begun_as.geometry).ok_or(End::Failed(error))?);
                    break;
                }
            };
            let first = *first.get_or_insert(last.ledger);
            let (way, few) = blocks.follow(&simulation);
            let sample = blocks.base.sample(&simulation, &last, &first, way, &few);
            residual = open_since(fall.is_none().then_some(&first), &last.ledger);
            samples.push(Sample { time: simulation.time() - start, ..sample });
            judged = judge::judge(&samples, &scales);
        }
        let (verdict, reason) = judged.unwrap_or((Verdict::Unstable, judge::Reason::Runaway));
        let end = samples.last().copied().unwrap_or_default();
        let (yields, has_bars) = (yields(&simulation), simulation.state().bolts.iter().any(|bolt| bolt.active));
        let trial = Trial {
            verdict,
            reason,
            time: begun_as.time + end.time,
            displacement: end.displacement,
            slip: end.slip,
            speed: end.speed,
            kinetic: end.kinetic,
            released: end.released,
            acceleration: judge::acceleration(&samples),
            failing: blocks.base.failing(&simulation, verdict),
            loose: blocks.base.loose(&simulation),
            // Slip that stretches bars of which none has yielded is elastic.
            is_far: end.displacement > self.far && (yields || !has_bars),
            bars_yield: yields,
            steps: begun_as.steps + simulation.state().step - begun,
            ledger_residual: worse(residual, begun_as.ledger_residual),
            wall: begun_as.wall + clock.elapsed().as_secs_f64(),
            ..begun_as
        };
        let steps = simulation.state().step - begun;
        let begun = Some(Begun { simulation: start_of_motion, fall, steps });
        Ok((trial, Ended { simulation, begun }))
    }

    /// The way in which blocks have moved since the trial began; none where nothing fails.
    pub fn mechanism(&self, simulation: &Simulation, failing: &[FailingBlock]) -> Option<Mechanism> {
        let blocks: Vec<BlockId> = failing.iter().filter_map(|block| simulation.block_labelled(block.block)).collect();
        let begun = &self.simulation;
        simulation.mechanism_since(&simulation.after_breaks(begun.cuts().len(), &begun.state().displacement), &blocks)
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
            displacement: far,
            slip: if self.yields { far } else { largest_slip(simulation, &self.simulation.state().contacts, few) },
            speed: way / self.scales.window,
            kinetic: (report.ledger.kinetic - kinetic_of_few).max(0.0),
            released: energy(first) - energy(&report.ledger),
            ..Sample::default()
        }
    }

    /// Largest displacement (m) of a block between two states.
    fn farthest(&self, states: [&Simulation; 2]) -> f64 {
        self.moving().map(|b| moved_between(states, b)).fold(0.0, f64::max)
    }

    /// Largest displacement (m) of a block's covers since the trial began.
    fn moved(&self, simulation: &Simulation, block: BlockId) -> f64 {
        moved_between([&self.simulation, simulation], block)
    }

    /// Motion of all free blocks since the trial began.
    fn motions(&self, simulation: &Simulation) -> Vec<FailingBlock> {
        let model = simulation.model();
        self.moving()
            .map(|b| {
                let (_, velocity, spin, _) = simulation.rigid_motion_of(b);
                let radius = (model.covers.block_area(b) / std::f64::consts::PI).sqrt();
                FailingBlock {
                    block: model.labels[b],
                    position: model.covers.block_centroid(b),
                    area: model.covers.block_area(b),
                    mass: model.mass_matrix.total[b],
                    displacement: self.moved(simulation, b),
                    way: simulation.displacement_of(b) - self.simulation.displacement_of(b),
                    rotation: simulation.motion_of(b).rotation - self.simulation.motion_of(b).rotation,
                    speed: libm::hypot(velocity.norm(), spin * radius),
                }
            })
            .collect()
    }

    /// Blocks that are too few to decide about the slope and have gone farther than elasticity explains.
    fn loose(&self, simulation: &Simulation) -> Vec<FailingBlock> {
        let labels = &simulation.model().labels;
        let few: Vec<u32> = self.few(simulation).into_iter().map(|block| labels[block]).collect();
        let is_loose = |m: &FailingBlock| m.displacement > self.scales.elastic && few.contains(&m.block);
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

/// Displacements (m) of blocks.
type Positions = Vec<(BlockId, Vector3<f64>)>;

/// Blocks of a trial from window to window, beside the same blocks of its start.
struct Blocks<'a> {
    /// The start as the trial began.
    start: &'a Base,
    /// The start with what has broken in the trial since.
    base: Cow<'a, Base>,
    /// Where the blocks have come to at the end of the last window.
    positions: Positions,
}

impl<'a> Blocks<'a> {
    fn of(start: &'a Base, trial: &Simulation) -> Self {
        let base = start.with_breaks_of(trial);
        Self { positions: base.positions(trial), start, base }
    }

    /// Takes up a window; the way (m) of the fastest block in it, without those too few to decide, and these.
    fn follow(&mut self, trial: &Simulation) -> (f64, Vec<BlockId>) {
        if self.base.simulation.cuts().len() != trial.cuts().len() {
            self.positions = parts_of(&self.positions, self.base.simulation.model(), trial);
            self.base = self.start.with_breaks_of(trial);
        }
        let before = std::mem::replace(&mut self.positions, self.base.positions(trial));
        let few = self.base.few(trial);
        let both = self.positions.iter().zip(&before).filter(|((b, _), _)| few.binary_search(b).is_err());
        (both.map(|((_, now), (_, before))| (now - before).norm()).fold(0.0, f64::max), few)
    }
}

/// Displacements of blocks of a model as those of their parts in a trial whose rock has broken since.
fn parts_of(positions: &[(BlockId, Vector3<f64>)], model: &Model, trial: &Simulation) -> Positions {
    let of = |label: u32| positions.iter().find(|(block, _)| model.labels[*block] == label).map(|(_, moved)| *moved);
    let parent = |label: u32| trial.cuts().iter().find(|cut| cut.part == label).map(|cut| cut.block);
    let free = free(trial);
    let blocks = BlockId::all(free.len()).filter(|&block| free[block]);
    let whole = |block: BlockId| {
        let line = std::iter::successors(Some(trial.model().labels[block]), |&label| parent(label));
        line.into_iter().find_map(of).unwrap_or_default()
    };
    blocks.map(|block| (block, whole(block))).collect()
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
    act: impl Fn(&mut Simulation),
    interrupt: Option<&AtomicBool>,
) -> Result<Result<StepReport, StepError>, End> {
    let mut report = StepReport::default();
    for step in 1..=steps {
        if interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return Err(End::Interrupted);
        }
        act(simulation);
        match simulation.advance(step == steps) {
            Ok(made) => report = made,
            Err(error) => return Ok(Err(error)),
        }
    }
    Ok(Ok(report))
}

/// A slope that was running away when the numbers gave up has failed. So has one that gave up far from where it is
/// drawn: its contacts are deep in each other there, and nothing real stops it.
fn given_up(samples: &[Sample], scales: &Scales, geometry: Geometry) -> Option<(Verdict, judge::Reason)> {
    let [.., before, last] = samples else { return None };
    let runs = last.kinetic > before.kinetic || geometry == Geometry::Drawn;
    (runs && last.displacement > scales.elastic).then_some((Verdict::Unstable, judge::Reason::Runaway))
}

/// Whether a bar has yielded or broken since the case began.
fn yields(simulation: &Simulation) -> bool {
    let yields = |bolt: &BoltState| matches!(bolt.condition(), BoltCondition::Yielded | BoltCondition::Broken);
    simulation.state().bolts.iter().any(yields)
}

/// Largest displacement (m) of a block's covers between two states of a model.
fn moved_between(states: [&Simulation; 2], block: BlockId) -> f64 {
    let [begin, now] = states.map(|simulation| &simulation.state().displacement);
    states[1].model().covers.covers_of(block).map(|i| (now[i] - begin[i]).norm()).fold(0.0, f64::max)
}

/// Share of the largest term that a ledger leaves open, since the `first` one of a slope that was let go from a push:
/// works are half a step ahead of displacements, and that half step is lost then.
fn open_since(first: Option<&Ledger>, ledger: &Ledger) -> f64 {
    (ledger.residual() - first.map_or(0.0, Ledger::residual)) / ledger.largest().max(f64::MIN_POSITIVE)
}

/// The number with the greater magnitude.
fn worse(a: f64, b: f64) -> f64 {
    if a.abs() > b.abs() { a } else { b }
}

/// Largest displacement (m) in which a slope has come to rest.
fn given_way(simulation: &Simulation) -> f64 {
    simulation.state().displacement.iter().map(Vector::norm).fold(0.0, f64::max)
}

/// Times, speeds and lengths of a model's motion (Eqs. 61, 63).
fn scales(simulation: &Simulation, tolerance: f64) -> Scales {
    let model = simulation.model();
    let (height, gravity) = height_and_gravity(simulation);
    let wave = height / model.rocks.iter().map(|r| r.shear_wave_speed()).fold(f64::INFINITY, f64::min);
    let fall = (height / gravity).sqrt();
    let window = (fall / WINDOWS_PER_FALL).max(WAVES * wave);
    let still_speed = STILL * tolerance * gravity * window;
    let free = (0..model.covers.block_count()).filter(|&b| !simulation.workspace().mass_matrix.fixed[b]);
    let mass: f64 = free.map(|b| model.mass_matrix.total[b]).sum();
    let given_way = given_way(simulation);
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
        catches: simulation.case().yields(),
        runs: 1,
    }
}
