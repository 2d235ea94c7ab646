//! Keys of `[solver]` that the integrator of a case does not use are named.

use std::collections::BTreeSet;

use enmm::model::case::Solver;

use crate::simulation;

/// A block of 10 m by 6 m on its base, with nothing unusual.
const CASE: &str = "title = \"t\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 6], [0, 6]]\n[mesh]\nsize = 1.5\n\
                    [rock.granite]\ndensity = 2650\nyoung = 50e9\npoisson = 0.25\n[joint_law.j]\nfriction_deg = 30\n\
                    [[fix]]\nedge = [[0, 0], [10, 0]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 0.5\n";

fn warnings(text: &str) -> Vec<String> {
    simulation(text).built().warnings.clone()
}

/// `solver.mass_scaling` once passed in silence beside the implicit integrator. Every key of `[solver]` is set here, so
/// that a new one is put on one of the lists: those without effect, and those that both integrators use.
#[test]
fn keys_of_the_other_integrator_are_told() {
    let both = "communication_step = 0.01\ndt_max = 1e-3\ncontact_stiffness = 0.7\nshear_ratio = 0.4\n\
                penetration_limit = 0.1\n\
                friction_delay = 0.01\nfailure_displacement = 1.0\nmemory_limit = 1000000000\n";
    let explicit = [
        "contact_theta = 3.0\n",
        "contact_tolerance = 1e-3\n",
        "sweeps_max = 90\n",
        "mass_scaling = 2.0\n",
        "dt_safety = 0.5\n",
    ];
    let implicit = [
        "newmark = \"trapezoidal\"\n",
        "implicit_step = 1e-3\n",
        "iterations_max = 9\n",
        "displacement_ratio = 0.02\n",
    ];
    let keys: BTreeSet<&str> =
        both.lines().chain(explicit).chain(implicit).filter_map(|line| Some(line.split_once(" =")?.0)).collect();
    let all = serde_json::to_value(Solver::default()).expect("an object");
    let all = all.as_object().expect("an object").keys().map(String::as_str).filter(|key| *key != "integrator");
    assert_eq!(keys, all.collect());
    let solver = [both, &explicit.concat(), &implicit.concat()].concat();
    for (integrator, others) in [("implicit", explicit.as_slice()), ("explicit", &implicit)] {
        let told = warnings(&format!("{CASE}[solver]\nintegrator = \"{integrator}\"\n{solver}"));
        let tell = |line: &&str| {
            let key = line.split(' ').next().expect("a key");
            format!(
                "solver.{key}: has no effect with solver.integrator = \"{integrator}\"; remove it, or use the other \
                 integrator"
            )
        };
        assert_eq!(told, others.iter().map(tell).collect::<Vec<_>>());
    }
    // The default step of the implicit integrator is twenty explicit ones, of which that key sets the length.
    let told = warnings(&format!("{CASE}[solver]\nintegrator = \"implicit\"\ndt_safety = 0.5\n"));
    assert_eq!(told, [""; 0]);
}
