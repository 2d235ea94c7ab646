//! D6: a wedge in the roof of an opening, held by the horizontal stress.

use enmm::model::StepReport;

use super::shear_box::{Drive, share};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "D6",
    title: "Roof wedge",
    source: "Two-stage relaxation of rigid blocks on elastic joints: P = 2·H0·(ks·cos²a + kn·sin²a)·sin(φ − a)/(ks·cos \
             a·cos φ + kn·sin a·sin φ); catches wrong coupling of joint stiffness, in-situ stress and friction",
    parameters: &[
        Parameter::new("a_deg", "°", 20.0, [8.0, 45.0], "half of the apex angle"),
        Parameter::new("phi_deg", "°", 40.0, [10.0, 60.0], "friction, above a_deg"),
        Parameter::new("ratio", "", 2.0, [0.2, 20.0], "kn over ks, besides 1"),
        Parameter::new("ks", "Pa/m", 1e9, [1e7, 1e11], "shear stiffness"),
        Parameter::new("h0", "N/m", 1e6, [1e3, 1e8], "initial horizontal force"),
        Parameter::new("height", "m", 2.0, [0.5, 20.0], "height of the wedge"),
        Parameter::new("rows", "", 5.0, [2.0, 20.0], "mesh triangles over the height"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Points of the curve up to the collapse, and steps between two of them: slow enough for no wave to matter.
const POINTS: usize = 200;
const STEPS: u64 = 100;

/// Force at collapse over the initial horizontal force, angles in radians.
fn collapse(a: f64, phi: f64, ratio: f64) -> f64 {
    2.0 * (a.cos().powi(2) + ratio * a.sin().powi(2)) * (phi - a).sin()
        / (a.cos() * phi.cos() + ratio * a.sin() * phi.sin())
}

/// A wedge in held rock under a horizontal stress that gives H0 over its height, carried by supports at its base.
fn case(setup: &Setup, ratio: f64) -> String {
    let [ks, h0, height] = ["ks", "h0", "height"].map(|name| setup.get(name));
    let half = height * setup.get("a_deg").to_radians().tan();
    let (side, top) = (2.5 * half + 0.5 * height, 1.5 * height);
    // The wedge hangs out a little, so that its corner does not meet that of the rock, where tributary lengths jump;
    // and the roof rises from that corner, which is then acute: an obtuse one would lend the roof's length to the
    // joint.
    let (away, rise) = (half + 0.25 * height, 0.3 * height * setup.get("a_deg").to_radians().tan());
    let lip = 0.1 * height;
    let foot = half + lip * setup.get("a_deg").to_radians().tan();
    let stiff = 1e3 * ks * ratio.max(1.0) * height;
    format!(
        "title = \"Roof wedge\"\n[domain]\n\
         outline = [[-{side:?}, {rise:?}], [-{away:?}, {rise:?}], [-{half:?}, 0.0], [-{foot:?}, -{lip:?}], [{foot:?}, \
         -{lip:?}], [{half:?}, 0.0], [{away:?}, {rise:?}], [{side:?}, {rise:?}], [{side:?}, {top:?}], [-{side:?}, \
         {top:?}]]\n[mesh]\nsize = {:?}\norigin = [0.013, 0.007]\n[gravity]\ny = 0.0\n[[joint]]\n\
         points = [[-{half:?}, 0.0], [0.0, {height:?}], [{half:?}, 0.0]]\n[joint_law.joint]\nfriction_deg = {:?}\n\
         normal_stiffness = {:?}\nshear_stiffness = {ks:?}\n[rock.stiff]\ndensity = 1e5\nyoung = {stiff:?}\n\
         poisson = 0.2\n[[fix]]\nblock = [0.0, {:?}]\n[[fix]]\nedge = [[-{foot:?}, -{lip:?}], [{foot:?}, -{lip:?}]]\n\
         axes = \"y\"\n[in_situ]\nsxx = {:?}\nsyy = 0.0\n[[stage]]\nname = \"lower\"\nkind = \"dynamic\"\n\
         duration = 1e6\ndamping = 0.5\n[solver]\ncontact_theta = 1.0\ncontact_tolerance = 1e-6\n",
        height / setup.get("rows"),
        setup.get("phi_deg"),
        ks * ratio,
        1.2 * height,
        -h0 / height,
    )
}

/// Curve of force over way, forces at the start, and the last report.
type Lowering = (Vec<[f64; 2]>, [f64; 2], StepReport);

/// Lowers the wedge past its collapse: displacement and force of the supports, the initial horizontal force and their
/// greatest force, the last report.
fn lower(setup: &mut Setup, ratio: f64) -> Result<Lowering, Trouble> {
    let [a, ks, h0] = [setup.get("a_deg").to_radians(), setup.get("ks"), setup.get("h0")];
    let force = collapse(a, setup.get("phi_deg").to_radians(), ratio) * h0;
    let way = force / (2.0 * ks * (a.cos().powi(2) + ratio * a.sin().powi(2)));
    let text = case(setup, ratio);
    let mut simulation = setup.simulation(&format!("d6 kn/ks = {ratio}"), text)?;
    simulation.advance(false)?;
    let thrust = |c: &enmm::model::tables::VertexEdge| {
        (c.normal.x * c.history.normal_force + c.tangent().x * c.history.shear_force).abs()
    };
    let initial = 0.5 * simulation.workspace().contacts.iter().map(thrust).sum::<f64>();
    let mut drive = Drive::along(&simulation, 1);
    let (mut curve, mut report, mut greatest) = (vec![[0.0, 0.0]], StepReport::default(), 0.0f64);
    let steps = POINTS * 5 / 4;
    for step in 1..=steps {
        let down = 1.25 * way * share(step, steps);
        report = drive.advance(&mut simulation, 1.25 * way * share(step - 1, steps) - down, STEPS)?;
        greatest = greatest.max(drive.greatest);
        curve.push([down, -drive.force(&simulation)]);
    }
    Ok((curve, [initial, greatest], report))
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi] = ["a_deg", "phi_deg"].map(|name| setup.get(name).to_radians());
    if phi <= a {
        return Err(Trouble("phi_deg must be above a_deg: the wedge falls under any horizontal force".into()));
    }
    let (h0, own) = (setup.get("h0"), setup.get("ratio"));
    let mut rows = Vec::new();
    let mut plot = Plot::new("Force that carries the wedge against its way", ["way (mm)", "force over H0"]);
    for ratio in [1.0, own] {
        let (curve, [initial, greatest], report) = lower(setup, ratio)?;
        let found = greatest / initial;
        let exact = collapse(a, phi, ratio);
        let reason = "the wedge is 10000 times stiffer than its joints, which gives way by some per mille; its way \
                      grows by 1/200 of that at collapse at a time";
        let corners = "in-situ stress times tributary lengths, which at the apex and the two ends of the joints are \
                       those of their nodes and not quite those of the faces: 2 % of five elements";
        let row = Row::new(format!("initial horizontal force, kn/ks = {ratio}"), "N/m", initial, h0);
        rows.push(row.relative(2e-2, corners));
        let name = format!("greatest force over H0, kn/ks = {ratio}");
        rows.push(Row::new(name, "", found, exact).relative(5e-3, reason));
        rows.push(Row::ledger(&report));
        let stiffness = 2.0 * setup.get("ks") * (a.cos().powi(2) + ratio * a.sin().powi(2));
        let line = vec![[0.0, 0.0], [exact * h0 / stiffness * 1e3, exact]];
        let points = curve.iter().step_by(5).map(|p| [p[0] * 1e3, p[1] / h0]).collect();
        plot = plot.line(format!("exact, kn/ks = {ratio}"), line).marks(format!("computed, kn/ks = {ratio}"), points);
        if own == 1.0 {
            break;
        }
    }
    Ok(Outcome { rows, plots: vec![plot] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_numbers_come_from_the_formula() {
        let [a, phi] = [20.0, 40.0].map(f64::to_radians);
        assert!((collapse(a, phi, 1.0) - 0.727940).abs() < 1e-6);
        assert!((collapse(a, phi, 2.0) - 0.658932).abs() < 1e-6);
    }
}
