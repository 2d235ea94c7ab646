//! C6: a block on an incline stands, slides or topples.

use enmm::model::Simulation;

use super::block::{Block, Fate, G, advance, bisect};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble, text};

pub const PROBLEM: Problem = Problem {
    id: "C6",
    title: "Block on an incline: stands, slides or topples",
    source: "Block b × h on a plane of dip a, k = b/h. It stands for φ > a and k > tan a; slides without turning for \
             φ < a and k > tan φ; topples about its toe without slip for k < tan a and φ ≥ φc, tan φc = [tan a·(1 + \
             4k²) + 3k]/[4 + k² + 3k·tan a] (the ratio of shear to normal force at the toe of a block that begins to \
             turn); slides and topples between. Its angular acceleration is at first 1.5·g·(h·sin a − b·cos a)/(b² + \
             h²). Gravity grows within a short time, so that no wave shakes the block; all forces grow together, \
             which changes none of the limits. Catches wrong friction at a corner, corners that slip or stick falsely, \
             and wrong inertia of small blocks.",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 50.0], "dip of the plane"),
        Parameter::new(
            "k",
            "",
            0.3,
            [0.05, 1.0],
            "width over height of the block whose angular acceleration is taken; at most 0.95·tan a",
        ),
        Parameter::new("k_low", "", 0.2, [0.05, 1.0], "least width over height of the blocks whose limit is sought"),
        Parameter::new("k_high", "", 0.5, [0.05, 1.1], "greatest such; at most 0.95·tan a"),
        Parameter::new("k_count", "", 4.0, [1.0, 12.0], "number of such blocks"),
        Parameter::new("h", "m", 1.0, [0.1, 50.0], "height of the block"),
        Parameter::new(
            "stiffness",
            "",
            1e7,
            [3e6, 1e9],
            "Young's modulus over ρ·g·h; the formulas are those of rigid blocks",
        ),
        Parameter::new("mesh", "", 0.45, [0.15, 1.5], "side of the mesh over the height of the block"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Time (in √(h/g)) over which gravity grows, and the share of it after which the kind of motion is judged.
const RAMP: f64 = 0.06;
const JUDGED: f64 = 1.5;
/// Gain of friction work over that of kinetic energy, after gravity has grown, above which the toe slips; what slips
/// while the base lifts and the toe is pressed in is left out.
const SLIPS: f64 = 2e-3;
/// Speed of sliding or of the head over g·t above which a block slides or turns.
const MOVES: f64 = 5e-3;
/// Distance from a limit (rad of φ, k) within which no kind of motion is judged.
const BESIDE: f64 = 0.015;

/// Least friction angle (rad) at which the toe of a toppling block does not slip.
fn critical_friction(k: f64, dip: f64) -> f64 {
    let a = dip.tan();
    ((a * (1.0 + 4.0 * k * k) + 3.0 * k) / (4.0 + k * k + 3.0 * k * a)).atan()
}

/// Angular acceleration (rad/s²) about the toe of a block b × h that has turned by `angle` (rad).
fn angular_acceleration(b: f64, h: f64, lean: f64) -> f64 {
    1.5 * G * (h * lean.sin() - b * lean.cos()) / (b * b + h * h)
}

/// How a block moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Stands,
    Slides,
    Topples,
    Both,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Stands, Self::Slides, Self::Topples, Self::Both];

    fn of(k: f64, friction: f64, dip: f64) -> Self {
        match () {
            () if friction >= dip && k >= dip.tan() => Self::Stands,
            () if friction < dip && k >= friction.tan() => Self::Slides,
            () if friction >= critical_friction(k, dip) => Self::Topples,
            () => Self::Both,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Stands => "stands",
            Self::Slides => "slides",
            Self::Topples => "topples",
            Self::Both => "slides and topples",
        }
    }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let ks = ratios(setup)?;
    let dip = setup.get("a_deg").to_radians();
    let (mut rows, mut found) = (Vec::new(), Vec::new());
    for &k in &ks {
        let computed = limit(setup, k)?.to_degrees();
        found.push([k, computed]);
        let row = Row::new(
            format!("critical friction angle, k = {k:.3}"),
            "°",
            computed,
            critical_friction(k, dip).to_degrees(),
        );
        rows.push(row.absolute(
            0.1,
            "slip is seen from 2e-3 of the kinetic energy on, 0.01° below the limit where the block is slender; the \
             tilt of 1e-3 rad at the time of judgement moves the limit by as much; the rest is the elastic toe",
        ));
    }
    let (row, region) = region(setup, &found)?;
    rows.push(row);
    let (turning, plot) = turning(setup)?;
    rows.extend(turning);
    Ok(Outcome { rows, plots: vec![region, plot] })
}

/// The ratios k whose limit is sought.
fn ratios(setup: &Setup) -> Result<Vec<f64>, Trouble> {
    let most = setup.get("a_deg").to_radians().tan();
    let count = setup.get("k_count").round() as usize;
    let count = if setup.quick { count.min(2) } else { count };
    let [low, high] = ["k_low", "k_high"].map(|name| setup.get(name));
    for (name, value) in [("k", setup.get("k")), ("k_low", low), ("k_high", high)] {
        if value > 0.95 * most {
            let limit = 0.95 * most;
            return Err(Trouble(format!(
                "C6: {name} is {value}, must be at most 0.95·tan a = {limit:.4}, to topple soon"
            )));
        }
    }
    if low > high {
        return Err(Trouble(format!("C6: k_low is {low}, must not be above k_high = {high}")));
    }
    Ok((0..count).map(|i| low + (high - low) * i as f64 / (count.max(2) - 1) as f64).collect())
}

fn block(setup: &Setup, k: f64, friction: f64) -> Block {
    let (h, dip) = (setup.get("h"), setup.get("a_deg").to_radians());
    Block { dip, friction_deg: friction.to_degrees(), ..Block::level(setup, [k * h, h], RAMP) }
}

/// The friction angle (rad) from which on the toe does not slip, by bisection.
fn limit(setup: &mut Setup, k: f64) -> Result<f64, Trouble> {
    bisect([1f64.to_radians(), 80f64.to_radians()], 1e-4, |friction| {
        let block = block(setup, k, friction);
        let mut simulation = block.build(setup, &format!("limit_k{k:.3}_phi{:.3}", friction.to_degrees()), 1.0)?;
        slips(&mut simulation, block.ramp, JUDGED * block.ramp)
    })
}

/// Whether the toe slips between two times (s).
fn slips(simulation: &mut Simulation, from: f64, to: f64) -> Result<bool, Trouble> {
    let before = advance(simulation, from, |_| false)?.ledger;
    let after = advance(simulation, to, |_| false)?.ledger;
    Ok(after.friction - before.friction > SLIPS * (after.kinetic - before.kinetic))
}

/// How a block of ratio k moves.
fn kind(setup: &mut Setup, k: f64, friction: f64) -> Result<Kind, Trouble> {
    let block = block(setup, k, friction);
    let mut simulation = block.build(setup, &format!("region_k{k:.3}_phi{:.2}", friction.to_degrees()), 1.0)?;
    let slips = slips(&mut simulation, block.ramp, 2.0 * JUDGED * block.ramp)?;
    let Fate { time, spin, slides, .. } = block.fate(&simulation);
    let turns = spin * block.height > MOVES * G * time;
    // The toe of a block that turns moves a little in any case: whether it slips, the friction work shows.
    let slides = if turns { slips } else { slides > MOVES * G * time };
    Ok(match (turns, slides) {
        (false, false) => Kind::Stands,
        (false, true) => Kind::Slides,
        (true, false) => Kind::Topples,
        (true, true) => Kind::Both,
    })
}

/// Blocks of many ratios and friction angles: those that move otherwise than they should, and the diagram.
fn region(setup: &mut Setup, limits: &[[f64; 2]]) -> Result<(Row, Plot), Trouble> {
    let dip = setup.get("a_deg").to_radians();
    let (side, mut wrong) = (if setup.quick { 4 } else { 9 }, 0);
    let [k_most, friction_most] = [1.4 * dip.tan(), 1.4 * dip];
    let mut points: Vec<(Kind, [f64; 2])> = Vec::new();
    for i in 1..=side {
        for j in 1..=side {
            let [k, friction] =
                [(k_most, i), (friction_most, j)].map(|(most, n)| most * (n as f64 - 0.3) / side as f64);
            let kinds = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
                .map(|(x, y)| Kind::of(k + x * BESIDE, friction + y * BESIDE, dip));
            if kinds.iter().any(|other| *other != kinds[0]) || k < 0.05 {
                continue;
            }
            let found = kind(setup, k, friction)?;
            wrong += usize::from(found != kinds[0]);
            points.push((found, [k, friction.to_degrees()]));
        }
    }
    let row = Row::new(format!("blocks of {} that move otherwise", points.len()), "", wrong as f64, 0.0);
    let row = row.at_most(0.0, "all are more than 0.015 in k and 0.86° in φ away from a limit");
    Ok((row, diagram(dip, k_most, friction_most, &points, limits)))
}

fn diagram(dip: f64, k_most: f64, friction_most: f64, points: &[(Kind, [f64; 2])], limits: &[[f64; 2]]) -> Plot {
    let ks = |from: f64, to: f64| (0..=60).map(move |i| from + (to - from) * f64::from(i) / 60.0);
    let steep = ks(0.0, dip.tan()).map(|k| [k, critical_friction(k, dip).to_degrees()]).collect();
    let flat = ks(0.0, dip.tan()).map(|k| [k, k.atan().to_degrees()]).collect();
    let (a, t) = (dip.to_degrees(), dip.tan());
    let stand = vec![[k_most, a], [t, a], [t, friction_most.to_degrees()]];
    let title = format!("Stands, slides, topples on a plane of {}°", text::number(a, 4));
    let mut plot = Plot::new(title, ["k = b/h", "friction angle φ [°]"]);
    plot = plot.line("φ = φc(k)", steep).line("k = tan φ", flat).line("limits of standing", stand);
    for kind in Kind::ALL {
        let places = points.iter().filter(|p| p.0 == kind).map(|p| p.1).collect();
        plot = plot.marks(format!("computed: {}", kind.name()), places);
    }
    plot.marks("computed: φc by bisection", limits.to_vec())
}

/// The angular acceleration of a block that does not slip, from its spin over four windows, taken back to no turn.
fn turning(setup: &mut Setup) -> Result<(Vec<Row>, Plot), Trouble> {
    let (k, h, dip) = (setup.get("k"), setup.get("h"), setup.get("a_deg").to_radians());
    let block = block(setup, k, 1.2f64.min(critical_friction(k, dip) + 0.4));
    let mut simulation = block.build(setup, &format!("turning_k{k:.3}"), 1.0)?;
    let (mut fates, mut report) = (vec![Fate::default()], simulation.report());
    for i in 1..=12 {
        report = advance(&mut simulation, f64::from(i) * block.ramp, |_| false)?;
        fates.push(block.fate(&simulation));
    }
    let windows = fates[1..6].windows(2).map(|w| {
        let rate = (w[1].spin - w[0].spin) / (w[1].time - w[0].time);
        [(w[0].turned + w[1].turned) / 2.0, rate]
    });
    let start = intercept(&windows.collect::<Vec<_>>());
    let exact = motion(&block, fates.last().map_or(0.0, |fate| fate.time));
    let last = fates.last().copied().unwrap_or_default();
    let end = exact.last().map_or(0.0, |p| p[1]);
    let reason = "waves of the elastic block in the windows of spin, some 1e-3 of it; they fall with √E";
    let rows = vec![
        Row::new(
            format!("initial angular acceleration, k = {k}"),
            "rad/s²",
            start,
            angular_acceleration(k * h, h, dip),
        )
        .relative(5e-3, reason),
        Row::new(format!("angle after {:.3} s, k = {k}", last.time), "rad", last.turned, end).relative(
            3e-3,
            "the elastic toe, which makes the block lean and roll a little; the exact angle is \
             that of the rigid block under growing gravity",
        ),
        Row::ledger(&report),
    ];
    let plot = Plot::new(format!("Angle of a toppling block, k = {k}"), ["time [s]", "angle [rad]"])
        .line("rigid block", exact)
        .marks("computed", fates.iter().map(|f| [f.time, f.turned]).collect());
    Ok((rows, plot))
}

/// Value at zero of the line that fits the points best.
fn intercept(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let [x, y] = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let slope = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>();
    y - slope * x
}

/// Time and angle of the rigid block that turns about its toe while gravity grows, by the midpoint rule.
fn motion(block: &Block, end: f64) -> Vec<[f64; 2]> {
    let steps = 6000;
    let dt = end / f64::from(steps);
    let rate = |time: f64, angle: f64| {
        (time / block.ramp).min(1.0) * angular_acceleration(block.base, block.height, block.dip + angle)
    };
    let (mut angle, mut spin, mut points) = (0.0, 0.0, vec![[0.0; 2]]);
    for step in 0..steps {
        let time = f64::from(step) * dt;
        let middle = angle + 0.5 * dt * spin;
        let push = rate(time + 0.5 * dt, middle);
        angle += dt * (spin + 0.5 * dt * push);
        spin += dt * push;
        if step % 60 == 59 {
            points.push([time + dt, angle]);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_give_the_published_numbers() {
        let dip = 30f64.to_radians();
        for (k, degrees) in [(0.2, 16.1440), (0.3, 20.0815), (0.4, 23.8643), (0.5, 27.4248)] {
            assert!((critical_friction(k, dip).to_degrees() - degrees).abs() < 1e-4, "k = {k}");
        }
        assert!((angular_acceleration(0.3, 1.0, dip) - 3.242_597).abs() < 1e-6);
    }

    #[test]
    fn the_four_kinds_meet_where_they_should() {
        let dip = 30f64.to_radians();
        let kind = |k: f64, degrees: f64| Kind::of(k, degrees.to_radians(), dip);
        assert_eq!(kind(0.6, 31.0), Kind::Stands);
        assert_eq!(kind(0.5, 25.0), Kind::Slides);
        assert_eq!(kind(0.3, 21.0), Kind::Topples);
        assert_eq!(kind(0.3, 19.0), Kind::Both);
    }
}
