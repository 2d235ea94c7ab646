//! D7: rock bridges on a plane (Jennings 1970).

use enmm_stability::strength_reduction::Reduction;

use super::incline::{G, ledger_row, reduce, trial_plot};
use super::limit::bound_of;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "D7",
    title: "Rock bridges on a plane",
    source: "a block on a plane of which the share k is rock: with the same friction angle in rock and joint F = \
             (W·cos a·tan φ + k·c·A)/(W·sin a), Jennings' sum of strengths by length (J. E. Jennings, A mathematical \
             theory for the calculation of the stability of slopes in open cast mines, 1970), exact while bridges are \
             ductile: normal forces may lie where they will. With different angles that sum is a trap: it needs the \
             same normal stress on rock and joint, and stiffer rock carries more; where equilibrium lets the bridge \
             carry all of the weight, friction is that of rock throughout. Brittle bridges break one after the other, \
             and F is no higher. Catches bridges that count with a wrong length, and contacts beside a bridge that \
             take its strength",
    parameters: &[
        Parameter::new("a_deg", "°", 40.0, [35.0, 50.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 30.0, [10.0, 34.0], "friction of joint and rock"),
        Parameter::new("phi_rock_deg", "°", 45.0, [35.0, 60.0], "the other rock's"),
        Parameter::new("c", "Pa", 1e6, [2e5, 5e6], "cohesion of rock"),
        Parameter::new("k", "", 0.06, [0.03, 0.2], "share of rock"),
        Parameter::new("weight", "N/m", 1e6, [2e5, 1.5e6], "weight of the block"),
        Parameter::new("mesh", "m", 1.4, [0.6, 1.6], "mesh size"),
        Parameter::new("turn_deg", "°", 8.0, [0.0, 60.0], "angle of the mesh"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Length (m) of the plane.
const LENGTH: f64 = 10.0;
const DENSITY: f64 = 2600.0;
/// Energies of fracture that let all of a bridge have its strength at once, and that let it break at once.
const DUCTILE: &str = "tension_energy = 1000.0\nshear_energy = 20e3\n";
const BRITTLE: &str = "shear_energy = 1.0\n";

/// Jennings' factor with friction angles (degrees) of rock and joint.
fn jennings(setup: &Setup, k: f64, [rock, joint]: [f64; 2]) -> f64 {
    let [a, c, weight] = ["a_deg", "c", "weight"].map(|name| setup.get(name));
    let (sin, cos) = a.to_radians().sin_cos();
    let tan = |degrees: f64| degrees.to_radians().tan();
    let friction = weight * cos * (k * tan(rock) + (1.0 - k) * tan(joint));
    (friction + k * c * LENGTH) / (weight * sin)
}

/// A block on a plane with one bridge about `middle` (m), drawn along the plane: gravity is turned.
fn text(setup: &Setup, k: f64, middle: f64, rock: f64, energies: &str) -> String {
    let [a, phi, c, weight] = ["a_deg", "phi_deg", "c", "weight"].map(|name| setup.get(name));
    let (sin, cos) = a.to_radians().sin_cos();
    let height = weight / (LENGTH * DENSITY * G);
    let [from, to] = [-0.5, 0.5].map(|share| middle + share * k * LENGTH);
    format!(
        "title = \"Rock bridge on a plane\"\n[domain]\noutline = [[-4.0, -2.0], [14.0, -2.0], [14.0, 0.0], \
         [{LENGTH:?}, 0.0], [{LENGTH:?}, {height:?}], [0.0, {height:?}], [0.0, 0.0], [-4.0, 0.0]]\n\
         joint_law = \"joint\"\n[mesh]\nsize = {:?}\nangle_deg = {:?}\n[[joint]]\n\
         points = [[0.0, 0.0], [{from:?}, 0.0]]\n[[joint]]\npoints = [[{to:?}, 0.0], [{LENGTH:?}, 0.0]]\n\
         [[bridge]]\npoints = [[{from:?}, 0.0], [{to:?}, 0.0]]\nlaw = \"rock\"\n\
         [rock.rock]\ndensity = {DENSITY:?}\nyoung = 30e9\npoisson = 0.25\n[joint_law.joint]\n\
         friction_deg = {phi:?}\n[joint_law.rock]\nfriction_deg = {rock:?}\ncohesion = {c:?}\nresidual_cohesion = 0.0\n\
         tension = {:?}\n{energies}[gravity]\nx = {:?}\ny = {:?}\n[[fix]]\nblock = [5.0, -1.0]\n[[stage]]\n\
         name = \"rest\"\nkind = \"static\"\nduration = 5.0\n",
        setup.get("mesh"),
        setup.get("turn_deg"),
        0.5 * c,
        G * sin,
        -G * cos,
    )
}

fn factor(reduction: &Reduction) -> f64 {
    reduction.factor().unwrap_or(f64::NAN)
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi, rock, k, weight] = ["a_deg", "phi_deg", "phi_rock_deg", "k", "weight"].map(|name| setup.get(name));
    let equal = jennings(setup, k, [phi; 2]);
    let ductile = text(setup, k, 0.5 * LENGTH, phi, DUCTILE);
    let bound = bound_of(setup, "ductile", ductile.clone())?.level_tops.factor.value();
    let reason = "the bracket of limit analysis is 2e-5 wide";
    let mut rows = vec![Row::new("equal friction: limit analysis", "", bound, equal).relative(1e-4, reason)];
    // Under the resultant of the weight, so that the bridge can carry all of it.
    let under = 0.5 * LENGTH + 0.5 * weight / (LENGTH * DENSITY * G) * a.to_radians().tan();
    let other = text(setup, k, under, rock, DUCTILE);
    let all = jennings(setup, k, [rock; 2]);
    let found = bound_of(setup, "other_friction", other)?.level_tops.factor.value();
    let row = Row::new("rock with more friction, under the resultant: limit analysis", "", found, all);
    rows.push(row.relative(1e-3, "a bridge of some width lets the load lie within it"));
    let sum = jennings(setup, k, [rock, phi]);
    rows.push(Row::new("the same: Jennings' sum, no exact factor", "", sum, all));
    let found = reduce(setup, "ductile", ductile)?;
    let reason = "half of the bracket, and nodes beside the ends of the bridge that have a part of it by length";
    rows.push(Row::new("equal friction: strength reduction", "", factor(&found), equal).relative(5e-3, reason));
    let mut reductions = vec![found];
    if !setup.quick {
        let brittle = text(setup, k, 0.5 * LENGTH, phi, BRITTLE);
        let brittle = reduce(setup, "brittle", brittle)?;
        let above = (factor(&brittle) / factor(&reductions[0]) - 1.0).max(0.0);
        let row = Row::new("brittle over ductile factor, less 1, if above 0", "", above, 0.0);
        rows.push(row.at_most(2e-3, "the brackets are 0.2 % wide"));
        reductions.push(brittle);
    }
    rows.push(ledger_row(&reductions.iter().collect::<Vec<_>>()));
    let plots = vec![trial_plot("Trials with a ductile bridge", &reductions[0], equal), shares(setup)];
    Ok(Outcome { rows, plots })
}

/// Jennings' factor over the share of rock, with equal and with different friction.
fn shares(setup: &Setup) -> Plot {
    let [phi, rock] = ["phi_deg", "phi_rock_deg"].map(|name| setup.get(name));
    let factors = |angles: [f64; 2]| -> Vec<[f64; 2]> {
        (0..=20).map(|k| 0.005 * f64::from(k)).map(|k| [k, jennings(setup, k, angles)]).collect()
    };
    Plot::new("Factor over the share of rock", ["k", "factor of safety"])
        .line("equal friction: exact", factors([phi; 2]))
        .line("friction of rock on all: where the bridge carries the weight", factors([rock; 2]))
        .line("Jennings' sum with both angles", factors([rock, phi]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// F = 0.688059 + 15.5572·k, so that k = 2.00512 % holds the block.
    #[test]
    fn jennings_factor_is_that_of_numbers_worked_out_twice() {
        let setup = Setup::of(&PROBLEM, true);
        let factor = |k| jennings(&setup, k, [30.0; 2]);
        assert!((factor(0.0) - 0.688059).abs() < 1e-6);
        assert!((factor(1.0) - factor(0.0) - 15.5572).abs() < 1e-4);
        assert!((factor(0.0200512) - 1.0).abs() < 1e-6);
    }
}
