//! D3: direct shear of a joint, Mohr–Coulomb with softening and Barton–Bandis, and its closure.

use enmm::model::{Simulation, StepReport};

use super::shear_box::{Drive, JointState, joint_state, share};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "D3",
    title: "Direct shear of a joint",
    source: "Mohr–Coulomb: peak τ = c + σn·tan φ at τ/ks, then the residual strength; Barton–Bandis: τ = σn·tan(φr + \
             JRC·log10(JCS/σn)) and σn = kn·v/(1 − v/vmax); catches wrong strength, stiffness, softening and closure",
    parameters: &[
        Parameter::new("sn", "Pa", 1e6, [1e4, 1e7], "normal stress"),
        Parameter::new("c", "Pa", 0.5e6, [0.0, 1e7], "cohesion, peak"),
        Parameter::new("phi_deg", "°", 30.0, [1.0, 60.0], "friction angle, peak"),
        Parameter::new("phi_residual_deg", "°", 25.0, [1.0, 60.0], "residual friction"),
        Parameter::new("ks", "Pa/m", 1e10, [1e8, 1e11], "shear stiffness"),
        Parameter::new("jrc", "", 10.0, [0.0, 20.0], "joint roughness coefficient"),
        Parameter::new("jcs", "Pa", 1e8, [1e6, 1e9], "joint wall strength"),
        Parameter::new("phi_r_deg", "°", 28.0, [5.0, 45.0], "Barton–Bandis angle φr"),
        Parameter::new("kn", "Pa/m", 2e10, [1e9, 1e11], "initial normal stiffness"),
        Parameter::new("vmax", "m", 2e-4, [1e-5, 1e-2], "greatest closure"),
        Parameter::new("mesh", "m", 0.5, [0.2, 1.0], "mesh size"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Length and height (m) of the upper block.
const BOX: [f64; 2] = [2.0, 1.0];
/// Points of a curve up to the peak, and steps between two of them: slow enough for no wave to matter.
const POINTS: usize = 200;
const STEPS: u64 = 50;

/// Mohr–Coulomb strength (Pa).
fn coulomb(stress: f64, cohesion: f64, friction: f64) -> f64 {
    cohesion + stress * friction.tan()
}

/// Barton–Bandis strength (Pa), angles in degrees.
fn barton(stress: f64, jrc: f64, jcs: f64, residual: f64) -> f64 {
    stress * (residual + (jrc * (jcs / stress).log10()).max(0.0)).min(70.0).to_radians().tan()
}

/// A shear box: a very stiff and heavy block (so that the joint alone gives) on a held one, guided along its left side
/// and under its pressure from the start.
fn case(setup: &Setup, law: &str, stress: f64, guided: bool) -> String {
    let [length, height] = BOX;
    let reach = length + 1.0;
    let [ks, kn, vmax, sn] = ["ks", "kn", "vmax", "sn"].map(|name| setup.get(name));
    // The joint at its stiffest: closed by ten times the normal stress.
    let stiffest = if guided { ks.max(kn) } else { kn * (1.0 + 10.0 * sn / (kn * vmax)).powi(2) };
    let settle = 60.0 * (1e6 * height / ks.min(kn)).sqrt();
    let guide = format!(
        "[[fix]]\nedge = [[0.0, 0.0], [0.0, {height}]]\naxes = \"x\"\n\
         [in_situ]\nsxx = 0.0\nsyy = {:?}\n",
        -stress
    );
    format!(
        "title = \"Direct shear\"\n[domain]\noutline = [[-1.0, -1.0], [{reach}, -1.0], [{reach}, 0.0], [{length}, \
        0.0], \
         [{length}, {height}], [0.0, {height}], [0.0, 0.0], [-1.0, 0.0]]\n[mesh]\nsize = {:?}\norigin = [0.03, 0.02]\n\
         [gravity]\ny = 0.0\n[[joint]]\npoints = [[0.0, 0.0], [{length}, 0.0]]\n[joint_law.joint]\n{law}[rock.stiff]\n\
         density = 1e6\nyoung = {:e}\npoisson = 0.0\n[[fix]]\nblock = [-0.5, -0.5]\n{}[[load]]\nkind = \"pressure\"\n\
         edge = [[0.0, {height}], [{length}, {height}]]\npressure = {stress:?}\n[[stage]]\nname = \"press\"\n\
         kind = \"static\"\nduration = {settle:e}\nconvergence = 1e-6\nramp = 0.0\n[[stage]]\nname = \"shear\"\n\
         kind = \"dynamic\"\nduration = 1e4\ndamping = 0.5\n[solver]\ncontact_theta = 1.0\ncontact_tolerance = 1e-6\n",
        setup.get("mesh"),
        stiffest * if guided { 5e3 } else { 5e2 },
        if guided { guide } else { String::new() },
    )
}

/// Shears a box by `distance` (m); returns the states of the joint, the greatest shear stress that its
/// guides carried (Pa) and the last report.
fn shear(
    simulation: &mut Simulation,
    distance: f64,
    steps: usize,
) -> Result<(Vec<JointState>, f64, StepReport), Trouble> {
    simulation.run_stage()?;
    simulation.next_stage()?;
    let mut drive = Drive::along(simulation, 0);
    let (mut states, mut report, mut greatest) = (Vec::new(), StepReport::default(), 0.0f64);
    for point in 0..steps {
        let way = distance * (share(point + 1, steps) - share(point, steps));
        report = drive.advance(simulation, way, STEPS)?;
        states.push(joint_state(simulation));
        greatest = greatest.max(drive.greatest / BOX[0]);
    }
    Ok((states, greatest, report))
}

/// Mohr–Coulomb: peak, place of the peak, residual.
fn soften(setup: &mut Setup, rows: &mut Vec<Row>) -> Result<Plot, Trouble> {
    let [stress, cohesion, ks] = ["sn", "c", "ks"].map(|name| setup.get(name));
    let [phi, residual] = ["phi_deg", "phi_residual_deg"].map(|name| setup.get(name));
    let law = format!(
        "friction_deg = {phi:?}\ncohesion = {cohesion:?}\nresidual_friction_deg = {residual:?}\n\
         residual_cohesion = 0.0\nnormal_stiffness = {ks:e}\nshear_stiffness = {ks:e}\n"
    );
    let (peak, last) = (coulomb(stress, cohesion, phi.to_radians()), coulomb(stress, 0.0, residual.to_radians()));
    let text = case(setup, &law, stress, true);
    let mut simulation = setup.simulation("d3 mohr-coulomb", text)?;
    let (states, greatest, report) = shear(&mut simulation, 2.0 * peak / ks, 2 * POINTS)?;
    let top = states.iter().copied().fold(JointState::default(), |a, b| if b.shear > a.shear { b } else { a });
    let end = states.last().copied().unwrap_or_default();
    let even = "stresses of a block 5000 times stiffer than the joint are even to some per mille; the displacement \
                grows by 1/200 of the peak's at a time";
    rows.push(Row::new("Mohr–Coulomb: peak shear stress", "Pa", greatest, peak).relative(5e-3, even));
    rows.push(Row::new("its displacement", "m", top.slip, peak / ks).relative(8e-3, even));
    let row = Row::new("residual shear stress", "Pa", end.shear, last);
    rows.push(row.relative(1e-3, "Coulomb's limit holds at the end of each step; the block is at rest"));
    rows.push(Row::ledger(&report));
    let curve = states.iter().map(|s| [s.slip * 1e3, s.shear / 1e6]).collect();
    let exact = [[0.0, 0.0], [peak / ks, peak], [peak / ks, last], [2.0 * peak / ks, last]];
    Ok(Plot::new("Shear stress against shear displacement", ["displacement (mm)", "shear stress (MPa)"])
        .line("exact", exact.map(|[u, t]| [u * 1e3, t / 1e6]).to_vec())
        .marks("computed", curve))
}

/// The law of the rough joint.
fn rough(setup: &Setup) -> String {
    let [jrc, jcs, residual, ks, kn, vmax] = ["jrc", "jcs", "phi_r_deg", "ks", "kn", "vmax"].map(|n| setup.get(n));
    format!(
        "kind = \"barton_bandis\"\nfriction_deg = {residual:?}\njrc = {jrc:?}\njcs = {jcs:?}\n\
         normal_stiffness = {kn:e}\nshear_stiffness = {ks:e}\nclosure_max = {vmax:e}\n"
    )
}

/// Barton–Bandis strength under several normal stresses.
fn roughness(setup: &mut Setup, rows: &mut Vec<Row>) -> Result<(), Trouble> {
    let [base, jrc, jcs, residual, ks] = ["sn", "jrc", "jcs", "phi_r_deg", "ks"].map(|name| setup.get(name));
    let factors: &[f64] = if setup.quick { &[1.0, 0.1] } else { &[1.0, 0.1, 0.01, 4.0] };
    for factor in factors {
        let stress = base * factor;
        let exact = barton(stress, jrc, jcs, residual);
        let law = rough(setup);
        let text = case(setup, &law, stress, true);
        let mut simulation = setup.simulation(&format!("d3 barton-bandis {stress:.3e} Pa"), text)?;
        let (states, _, report) = shear(&mut simulation, 2.0 * exact / ks, POINTS)?;
        let found = states.last().copied().unwrap_or_default().shear;
        let reason = "all of the joint slips; the law bends little over the spread of the normal stress";
        let name = format!("Barton–Bandis: shear stress under {:.4} MPa", stress / 1e6);
        rows.push(Row::new(name, "Pa", found, exact).relative(1e-3, reason));
        rows.push(Row::ledger(&report));
    }
    Ok(())
}

/// Closure under a pressure that grows and falls again, one static stage for each value.
fn close(setup: &mut Setup, rows: &mut Vec<Row>) -> Result<Plot, Trouble> {
    let [stress, kn, vmax] = ["sn", "kn", "vmax"].map(|name| setup.get(name));
    let exact = |stress: f64| stress / (kn + stress / vmax);
    let shares = [0.1, 0.3, 1.0, 3.0, 10.0, 1.0, 0.3];
    let [length, height] = BOX;
    let (mut loading, mut unloading) = (Vec::new(), Vec::new());
    let port = format!("[[port]]\nname = \"top\"\nboundary = [[0.0, {height}], [{length}, {height}]]\n");
    let stage = |k: usize| {
        let duration = 60.0 * (1e6 * height / kn).sqrt();
        format!(
            "[[stage]]\nname = \"level {k}\"\nkind = \"static\"\nduration = {duration:e}\nconvergence = 1e-6\nramp = \
            0.0\n"
        )
    };
    let stages: String = (1..shares.len()).map(stage).collect();
    let law = rough(setup);
    let text = case(setup, &law, 0.0, false)
        .replace("[[stage]]\nname = \"press\"", &format!("{port}[[stage]]\nname = \"press\""));
    let (head, solver) = text.split_once("[[stage]]\nname = \"shear\"").unwrap_or((&text, ""));
    let solver = solver.split_once("[solver]").map_or("", |(_, rest)| rest);
    let mut simulation = setup.simulation("d3 closure", format!("{head}{stages}[solver]{solver}"))?;
    let mut report = StepReport::default();
    for (k, share) in shares.into_iter().enumerate() {
        simulation.drive().to.port_pressure[0] = share * stress;
        simulation.drive().arrive();
        report = simulation.run_stage()?;
        let state = joint_state(&simulation);
        let way = if k < 5 { "loading" } else { "unloading" };
        let reason = "at rest after each change of the pressure; the block closes the joint evenly to 1e-3";
        let name = format!("closure under {:.4} MPa, {way}", share * stress / 1e6);
        rows.push(Row::new(name, "m", state.closure, exact(share * stress)).relative(2e-3, reason));
        let list = if k < 5 { &mut loading } else { &mut unloading };
        list.push([state.closure * 1e3, state.normal / 1e6]);
        simulation.next_stage()?;
    }
    rows.push(Row::ledger(&report));
    let curve = (0..=200).map(|k| f64::from(k) * 0.05 * stress).map(|s| [exact(s) * 1e3, s / 1e6]).collect();
    Ok(Plot::new("Normal stress against closure", ["closure (mm)", "normal stress (MPa)"])
        .line("exact", curve)
        .marks("computed, loading", loading)
        .marks("computed, unloading", unloading))
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let mut rows = Vec::new();
    let shear = soften(setup, &mut rows)?;
    roughness(setup, &mut rows)?;
    let closure = close(setup, &mut rows)?;
    Ok(Outcome { rows, plots: vec![shear, closure] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_numbers_come_from_the_formulas() {
        let peak = coulomb(1e6, 0.5e6, 30f64.to_radians());
        assert!((peak - 1.077350e6).abs() < 1.0 && (peak / 1e10 - 0.107735e-3).abs() < 1e-9);
        assert!((coulomb(1e6, 0.0, 25f64.to_radians()) - 0.466308e6).abs() < 1.0);
        assert!((barton(1e6, 10.0, 1e8, 28.0) - 1.110613e6).abs() < 1.0);
        assert!((barton(0.1e6, 10.0, 1e8, 28.0) - 0.160033e6).abs() < 1.0);
    }
}
