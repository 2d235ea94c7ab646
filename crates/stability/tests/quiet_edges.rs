//! Claim: where a case has quiet boundaries and free fields, both searches hold these edges as its static stages do, as
//! they hold the same edges as fixities, with the factor of a slide on a plane.

use crate::common::case;
use enmm_stability::limit_analysis::bound;
use enmm_stability::strength_reduction::{Reduction, ReductionOptions, factor_of_safety};

const FRICTION: f64 = 40.0;

/// A wedge of rock on a plane that falls by 6 m over 9 m, on rock that these keys hold, before an earthquake.
fn slope(held: &str) -> String {
    format!(
        "title = \"wedge\"\n[domain]\noutline = [[0, 0], [20, 0], [20, 12], [8, 12], [4, 4], [0, 4]]\n[mesh]\n\
         size = 1.7\norigin = [0.131, 0.077]\n[[joint]]\npoints = [[5, 6], [14, 12]]\n[rock.rock]\n\
         density = 2600\nyoung = 2e10\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = {FRICTION}\n{held}\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\n[[stage]]\nname = \"earthquake\"\n\
         kind = \"dynamic\"\nduration = 1.0\n"
    )
}

const QUIET: &str = "[[quiet]]\nedge = [[0, 0], [20, 0]]\nwave = [0.1, 0.0]\ntable = [[0, 0], [0.5, 1], [1, 0]]\n\
                     [[free_field]]\nedge = [[0, 0], [0, 4]]\n[[free_field]]\nedge = [[20, 0], [20, 12]]\n\
                     [[port]]\nname = \"base\"\nquiet = [[0, 0], [20, 0]]\n";
const FIXED: &str = "[[fix]]\nedge = [[0, 0], [20, 0]]\n[[fix]]\nedge = [[0, 0], [0, 4]]\naxes = \"x\"\n\
                     [[fix]]\nedge = [[20, 0], [20, 12]]\naxes = \"x\"\n";

/// tan φ / tan ψ.
fn exact() -> f64 {
    FRICTION.to_radians().tan() * 9.0 / 6.0
}

#[test]
fn limit_analysis_holds_them() {
    let [quiet, fixed] = [QUIET, FIXED].map(|held| bound(&case(&slope(held))).unwrap_or_else(|e| panic!("{e}")));
    assert_eq!(quiet.associated.factor, fixed.associated.factor);
    assert_eq!(quiet.level_tops.factor, fixed.level_tops.factor);
    let factor = quiet.level_tops.factor.value();
    assert!((factor / exact() - 1.0).abs() < 1e-4, "{factor} {}", exact());
    let told = |bound: &enmm_stability::limit_analysis::Bound| {
        bound.warnings.iter().filter(|warning| warning.contains("waves are left out")).count()
    };
    assert_eq!((told(&quiet), told(&fixed)), (1, 0));
}

#[test]
fn strength_reduction_holds_them() {
    let found = |held: &str| -> Reduction {
        let options = ReductionOptions { tolerance: 0.02, ..ReductionOptions::default() };
        factor_of_safety(&case(&slope(held)), &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"))
    };
    let [quiet, fixed] = [QUIET, FIXED].map(found);
    let trials = |found: &Reduction| {
        let of = |trial: &enmm_stability::strength_reduction::Trial| (trial.factor, trial.verdict, trial.displacement);
        found.trials.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(trials(&quiet), trials(&fixed));
    let factor = quiet.factor().expect("a factor");
    assert!((factor / exact() - 1.0).abs() < 0.02, "{factor} {}", exact());
    assert!(quiet.warnings.iter().any(|warning| warning.contains("waves are left out")), "{:?}", quiet.warnings);
}
