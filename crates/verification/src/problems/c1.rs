//! C1: a block on an incline.

use super::block::G;
use crate::parts::{rock, turn};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble, wider_open};
use enmm::geometry::{Point, Vector};
use enmm::model::tables::BlockId;
use enmm::model::{Simulation, StepReport};

pub const PROBLEM: Problem = Problem {
    id: "C1",
    title: "Block on an incline",
    source: "s = ½·g·(sin a − cos a·tan φ)·t² for blocks so low that they slide upright: one that is b long and h high \
             tips over its lower edge where tan φ > b/h; catches wrong friction, creep and numerical damping of rigid \
             motion",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 42.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 20.0, [0.0, 40.0], "friction of the block"),
        Parameter::new("a_steep_deg", "°", 45.0, [5.0, 60.0], "dip of a steeper plane"),
        Parameter::new("phi_steep_deg", "°", 30.0, [0.0, 55.0], "friction there"),
        Parameter::new("t", "s", 1.0, [0.2, 2.0], "time of sliding; twice that for the square"),
        Parameter::new("a_rest_deg", "°", 30.0, [5.0, 60.0], "dip where a block stays"),
        Parameter::new("phi_rest_deg", "°", 31.0, [5.0, 60.0], "friction there"),
        Parameter::new("t_rest", "s", 60.0, [2.0, 300.0], "time of rest"),
        Parameter::new("a_brake_deg", "°", 20.0, [0.0, 40.0], "dip where a block stops"),
        Parameter::new(
            "phi_brake_deg",
            "°",
            30.0,
            [5.0, 40.0],
            "friction there; a block as high as long tips over from 45° on",
        ),
        Parameter::new("v0", "m/s", 2.0, [0.2, 5.0], "speed at the start there"),
        Parameter::new("young", "Pa", 5e10, [1e9, 2e11], "Young's modulus"),
        Parameter::new("young_rest", "Pa", 2e8, [1e7, 1e11], "Young's modulus at rest"),
        Parameter::new(
            "young_soft",
            "Pa",
            1e9,
            [1e8, 1e11],
            "Young's modulus of the block whose acceleration is taken",
        ),
        Parameter::new("mesh", "m", 0.6, [0.2, 1.5], "mesh size"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Density of the rock (kg/m³) times g.
const UNIT_WEIGHT: f64 = 2650.0 * G;

/// A block 1 m high and long, or 2 m long on planes of 44° and more, on a plane that falls to the right.
struct Incline {
    slope: f64,
    friction: f64,
    young: f64,
    /// Way (m) that it must have.
    way: f64,
    seconds: f64,
}

impl Incline {
    /// Acceleration down the plane (m/s²) of a block that slides.
    fn acceleration(&self) -> f64 {
        let (s, c) = self.slope.to_radians().sin_cos();
        G * (s - c * self.friction.to_radians().tan())
    }

    fn long(&self) -> f64 {
        if self.slope < 44.0 { 1.0 } else { 2.0 }
    }

    fn down(&self) -> Vector {
        let (s, c) = self.slope.to_radians().sin_cos();
        Vector::new(c, -s)
    }

    fn text(&self, size: f64) -> String {
        let (end, long) = (self.long() + self.way + 1.0, self.long());
        let corners =
            [[-1.0, -0.8], [end, -0.8], [end, 0.0], [long, 0.0], [long, 1.0], [0.0, 1.0], [0.0, 0.0], [-1.0, 0.0]];
        format!(
            "title = \"Block on an incline\"\n[domain]\noutline = {:?}\n[mesh]\nsize = {size:e}\n\
             origin = [0.031, 0.017]\n[[joint]]\npoints = {:?}\n[joint_law.joint]\nfriction_deg = {:?}\n[[fix]]\n\
             block = {:?}\n{}[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-7\n\
             [[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = {:e}\ndamping = 0.1\n[[stage.law]]\n\
             law = \"joint\"\nfriction_deg = {:?}\n",
            turn(&corners, -self.slope),
            turn(&[[0.0, 0.0], [long, 0.0]], -self.slope),
            self.slope + 5.0,
            turn(&[[-0.5, -0.4]], -self.slope)[0],
            rock(self.young, UNIT_WEIGHT / G),
            self.seconds,
            self.friction,
        )
    }

    /// Settles the block under a friction 5° above the slope, drops the friction and kicks the block down the plane.
    fn release(&self, setup: &mut Setup, name: &str, speed: f64) -> Result<Slide, Trouble> {
        let mut simulation = setup.simulation(name, self.text(setup.get("mesh")))?;
        simulation.run_stage()?;
        simulation.next_stage()?;
        let covers = &simulation.model().covers;
        let middle = turn(&[[0.52 * self.long(), 0.48]], -self.slope)[0];
        let element = covers.element_at(Point::from(middle)).ok_or(Trouble("the block is not there".to_owned()))?;
        let block = covers.element_block[element];
        if speed != 0.0 {
            let mut state = simulation.state().clone();
            let kick = self.down() * speed;
            covers.covers_of(block).for_each(|i| state.velocity[i] += kick);
            state.ledger.baseline += 0.5 * simulation.model().mass_matrix.total[block] * speed * speed;
            simulation.restore(state);
        }
        let mut slide = Slide { simulation, block, down: self.down(), start: 0.0, report: StepReport::default() };
        slide.start = slide.place();
        Ok(slide)
    }
}

/// A block under way.
struct Slide {
    simulation: Simulation,
    block: BlockId,
    down: Vector,
    start: f64,
    report: StepReport,
}

impl Slide {
    fn place(&self) -> f64 {
        self.simulation.rigid_motion_of(self.block).0.dot(&self.down)
    }

    /// Way since the start (m).
    fn way(&self) -> f64 {
        self.place() - self.start
    }

    /// Time since the start (s).
    fn time(&self) -> f64 {
        self.simulation.time() - self.simulation.state().stage_start
    }

    /// Advances some seconds in whole steps.
    fn advance(&mut self, seconds: f64) -> Result<(), Trouble> {
        let steps = self.simulation.steps_in(seconds);
        for step in 1..=steps {
            let report = self.simulation.advance(step == steps)?;
            if step == steps {
                self.report = report;
            }
        }
        Ok(())
    }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi, t] = ["a_deg", "phi_deg", "t"].map(|name| setup.get(name));
    let [steep, phi_steep] = ["a_steep_deg", "phi_steep_deg"].map(|name| setup.get(name));
    if phi >= a || phi_steep >= steep {
        return Err(Trouble(
            "the blocks must slide: choose phi_deg below a_deg and phi_steep_deg below a_steep_deg".into(),
        ));
    }
    let mut outcome = Outcome::default();
    let mut worst = StepReport::default();
    let shares: &[f64] = if setup.quick { &[] } else { &[0.0, 1.0 / 3.0, 0.5, 5.0 / 6.0, 14.0 / 15.0] };
    let mut variants: Vec<[f64; 2]> = shares.iter().map(|share| [a, share * a]).collect();
    variants.extend(if setup.quick { vec![] } else { vec![[steep, phi_steep / 3.0], [steep, phi_steep / 1.5]] });
    variants.extend([[steep, phi_steep]]);
    for [slope, friction] in variants {
        let incline = slider(setup, slope, friction, t);
        let mut slide = incline.release(setup, &format!("slide_{slope}_{friction:.3}"), 0.0)?;
        slide.advance(t)?;
        outcome.rows.push(way_row(&incline, &slide));
        worst = wider_open(worst, slide.report);
    }
    square(setup, &mut outcome, slider(setup, a, phi, 2.0 * t), t)?;
    worst = wider_open(worst, soft(setup, &mut outcome, t)?);
    worst = wider_open(worst, rest(setup, &mut outcome)?);
    worst = wider_open(worst, stop(setup, &mut outcome)?);
    outcome.rows.push(Row::ledger(&worst));
    Ok(outcome)
}

fn slider(setup: &Setup, slope: f64, friction: f64, seconds: f64) -> Incline {
    let mut incline = Incline { slope, friction, young: setup.get("young"), way: 0.0, seconds };
    incline.way = 0.5 * incline.acceleration() * seconds * seconds;
    incline
}

/// Why slips may differ: Coulomb's limit holds at the end of each step, but the drop of strength sets the block
/// swinging, which offsets its velocity by some σ/√(Eρ) times a few per cent.
const SWING: &str = "the drop of friction sets the block swinging: its speed is offset by some 0.03·σ/√(Eρ), 7e-5 m/s \
                     in rock of 50 GPa; 1e-4 of ways of a metre in a second, 5e-4 within 3° of the dip, where they are \
                     short";

/// Relative tolerance of the way of a time (s).
fn swing(incline: &Incline, t: f64) -> f64 {
    let share = if (incline.slope - incline.friction).abs() < 3.0 { 5e-4 } else { 1e-4 };
    share * (5e10 / incline.young).sqrt().max(1.0) / t.min(1.0)
}

fn way_row(incline: &Incline, slide: &Slide) -> Row {
    let t = slide.time();
    let exact = 0.5 * incline.acceleration() * t * t;
    let name = format!("slip, a = {}°, φ = {:.2}°, t = {t:.4} s", incline.slope, incline.friction);
    Row::new(name, "m", slide.way(), exact).relative(swing(incline, t), SWING)
}

/// The acceleration of a block of soft rock, by the second difference of three places, in which an offset of the speed
/// has no share.
fn soft(setup: &mut Setup, outcome: &mut Outcome, t: f64) -> Result<StepReport, Trouble> {
    let [slope, friction, young] = ["a_deg", "phi_deg", "young_soft"].map(|name| setup.get(name));
    let incline = Incline { young, ..slider(setup, slope, friction, t) };
    let mut slide = incline.release(setup, "soft", 0.0)?;
    let mut places = Vec::new();
    for share in [0.2, 0.4, 0.4] {
        slide.advance(share * t)?;
        places.push([slide.time(), slide.way()]);
    }
    let [speed, later] = [0, 1].map(|k| (places[k + 1][1] - places[k][1]) / (places[k + 1][0] - places[k][0]));
    let found = (later - speed) / (0.5 * (places[2][0] - places[0][0]));
    let name = format!("acceleration in rock of {young:e} Pa, a = {slope}°, φ = {friction}°");
    let exact = incline.acceleration();
    // Near the dip the acceleration is small, and the places still swing by some 0.4 of the sag ρg/E of the block.
    let swings = if slope - friction < 3.0 { 4.0 * 0.4 * UNIT_WEIGHT / (young * (0.4 * t).powi(2)) } else { 0.0 };
    let most = swings.max(1e-4 * exact * (4e9 / young).max(1.0) / t.min(1.0));
    let reason = "friction is tan φ times the normal force at the end of each step, and the impulse of that force the \
                  weight's; the second difference of places is free of the offset of the start; within 3° of the dip \
                  by the swing of the block, and in soft rock by friction that follows it late";
    outcome.rows.push(Row::new(name, "m/s²", found, exact).absolute(most, reason));
    Ok(slide.report)
}

/// s(2t) = 4·s(t), and the plot of the way.
fn square(setup: &mut Setup, outcome: &mut Outcome, incline: Incline, t: f64) -> Result<(), Trouble> {
    let mut slide = incline.release(setup, "square", 0.0)?;
    let mut points = vec![[0.0, 0.0]];
    for k in 1..=40 {
        slide.advance(t / 20.0)?;
        points.push([slide.time(), slide.way()]);
        if k == 20 {
            outcome.rows.push(way_row(&incline, &slide));
        }
    }
    let [half, whole] = [points[20], points[40]];
    let ratio = whole[1] / half[1] / (whole[0] / half[0]).powi(2) * 4.0;
    let row = Row::new("s(2t) over s(t)", "", ratio, 4.0);
    outcome.rows.push(row.relative(swing(&incline, t), SWING));
    outcome.rows.push(way_row(&incline, &slide));
    outcome.rows.push(Row::ledger(&slide.report));
    let exact = points.iter().map(|p| [p[0], 0.5 * incline.acceleration() * p[0] * p[0]]).collect();
    let plot = Plot::new(format!("Slip, a = {}°, φ = {}°", incline.slope, incline.friction), ["t (s)", "slip (m)"]);
    outcome.plots.push(plot.line("exact", exact).marks("computed", points));
    Ok(())
}

/// φ ≥ a: the elastic shear take-up at first, then nothing.
fn rest(setup: &mut Setup, outcome: &mut Outcome) -> Result<StepReport, Trouble> {
    let [slope, friction, young] = ["a_rest_deg", "phi_rest_deg", "young_rest"].map(|name| setup.get(name));
    if friction <= slope {
        return Err(Trouble("the block must hold: choose phi_rest_deg above a_rest_deg".to_owned()));
    }
    let seconds = if setup.quick { 4.0 } else { setup.get("t_rest") };
    let incline = Incline { slope, friction, young, way: 0.0, seconds };
    let mut slide = incline.release(setup, "rest", 0.0)?;
    slide.advance(1.0)?;
    let first = slide.way();
    let most = UNIT_WEIGHT / (0.3 * young);
    let row = Row::new("way in the first second of rest over ρg/0.3E", "", first / most, 0.0);
    let reason = "the shear of a block 1 m high over the stiffness of its joint; at most all of it is taken up anew";
    outcome.rows.push(row.at_most(1.0, reason));
    slide.advance(seconds - 1.0)?;
    let reason = "1e-8 of the block's size; the take-up is over in the first second";
    let name = format!("creep from 1 s to {seconds} s, φ = {friction}° on {slope}°");
    outcome.rows.push(Row::new(name, "m", slide.way() - first, 0.0).at_most(1e-8, reason));
    Ok(slide.report)
}

/// A block that is pushed stops after v0/|acceleration| and stays.
fn stop(setup: &mut Setup, outcome: &mut Outcome) -> Result<StepReport, Trouble> {
    let [slope, friction, speed] = ["a_brake_deg", "phi_brake_deg", "v0"].map(|name| setup.get(name));
    let mut incline = Incline { slope, friction, young: setup.get("young"), way: 0.0, seconds: 1.0 };
    let brake = -incline.acceleration();
    if brake <= 0.0 {
        return Err(Trouble("the block must stop: choose phi_brake_deg above a_brake_deg".to_owned()));
    }
    (incline.way, incline.seconds) = (0.5 * speed * speed / brake, speed / brake + 1.0);
    let mut slide = incline.release(setup, "stop", speed)?;
    let mut stopped = None;
    while slide.time() < incline.seconds {
        slide.advance(0.002 * incline.seconds)?;
        if stopped.is_none() && slide.report.locked > 0 && slide.report.slipping == 0 {
            stopped = Some(slide.time());
        }
    }
    let way = slide.way();
    outcome.rows.push(
        Row::new(format!("way until rest, v0 = {speed} m/s, a = {slope}°, φ = {friction}°"), "m", way, incline.way)
            .relative(2.0 * swing(&incline, 1.0), SWING),
    );
    let reason = "asked every 0.2 % of the run, and by whole steps; the shear of the last slip swings for some \
                  milliseconds, and friction follows the normal force as late";
    let time = Row::new("time until rest", "s", stopped.unwrap_or(f64::NAN), speed / brake);
    let most = 0.015 * speed / brake + 2.0 * slide.simulation.model().dt;
    outcome.rows.push(time.absolute(most, reason));
    slide.advance(0.2)?;
    let row = Row::new("creep after that", "m", slide.way() - way, 0.0);
    outcome.rows.push(row.at_most(1e-8, "1e-8 of the block's size"));
    Ok(slide.report)
}
