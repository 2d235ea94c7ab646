//! Claim: where a search begins, and from which slope at rest a trial goes on, decides about its time and not about the
//! factor.

use crate::common::case;
use enmm::model::case::Case;
use enmm_stability::strength_reduction::{Reduction, ReductionOptions, factor_of_safety};

use crate::common::extent::by_extent;
use crate::common::random::Random;

/// A face of 10 m at 60° with two planes that daylight in it, cut by a joint behind the crest, all at random.
fn slope(random: &mut Random) -> Case {
    let mut plane = |foot: f64| {
        let (dip, height) = (random.between(28f64, 42.0).to_radians(), foot * random.between(0.9, 1.1));
        let start = height / 60f64.to_radians().tan();
        let reach = (10.0 - height) / dip.tan();
        format!("[[joint]]\npoints = [[{start:?}, {height:?}], [{:?}, 10.0]]\n", start + reach)
    };
    let joints = plane(1.0) + &plane(4.0);
    let (friction, cohesion) = (random.between(25.0, 40.0), random.between(2e3, 3e4));
    let behind = random.between(8.0, 10.0);
    let text = format!(
        "title = \"slope\"\n[domain]\noutline = [[-8, -6], [28, -6], [28, 10], [{:?}, 10], [0, 0], [-8, 0]]\n\
         joint_law = \"joint\"\n[mesh]\nsize = 1.5\n[rock.rock]\ndensity = 2600\nyoung = 20e9\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = {friction:?}\ncohesion = {cohesion:?}\n{joints}\
         [[joint]]\npoints = [[{behind:?}, 10.0], [{behind:?}, 6.0]]\n[[fix]]\nedge = [[-8, -6], [28, -6]]\n\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration_max = 20.0\n",
        10.0 / 60f64.to_radians().tan()
    );
    case(&text)
}

fn search(case: &Case, low: Option<f64>, high: Option<f64>) -> Reduction {
    let options = ReductionOptions { low, high, ..ReductionOptions::default() };
    factor_of_safety(case, &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"))
}

/// From what limit analysis foretells, and from far off on both sides. Trials that begin with the slope at rest, and do
/// not go on from another, give the same within the tolerance of the search.
#[test]
fn every_search_finds_the_same_factor() {
    let mut random = Random::new(72);
    for k in 0..by_extent([1, 6, 20]) {
        let case = slope(&mut random);
        let found = search(&case, None, None);
        let factor = found.factor().unwrap_or_else(|| panic!("slope {k}: {:?}", found.end));
        for (low, high) in [(0.4, 1.9), (0.9, 6.0)] {
            let other = search(&case, Some(low * factor), Some(high * factor));
            let ratio = other.factor().expect("a factor") / factor;
            println!("slope {k}: {factor}, {ratio} of it from {low} and {high}");
            assert!((ratio - 1.0).abs() < 7e-3, "slope {k}: {factor}, {ratio} of it from {low} and {high}");
            assert!(other.trials.len() > found.trials.len(), "slope {k}");
        }
        let begun = |at: f64| search(&case, Some(at * factor), Some(at * factor)).low.is_some();
        assert!(begun(0.99) && !begun(1.01), "slope {k}: {factor}");
    }
}
